"""Selection lists and bit masks of a device: one enum and one module of masks for all that share them."""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from generator.emit import names
from generator.emit.rust import facts, words
from generator.emit.rust.syntax import (
    array,
    constant_name,
    declaration,
    doc,
    hexadecimal,
    markdown,
    string,
    type_name,
)
from generator.emit.rust.views import Constant, Masks, Selection, Variant
from generator.model import Bit, BitField, Code, DataType, Device, DictionaryObject, Option, Where
from generator.naming import Scope, safe, snake

View = TypeVar("View")
Key = tuple[str, int | None]
"""Designation of a code or object and the subcode or sub-index; ``None`` for the code as a whole."""


@dataclass(frozen=True, slots=True)
class Place:
    """A code, subcode or sub-index that has a selection list or bits.

    ``owner`` is the same for twins in both slots.  ``whole`` names the code or object, ``part`` the subcode or
    sub-index within it; ``title`` is the name as printed.
    """

    key: Key
    owner: str
    whole: str
    part: str
    title: str
    data_type: DataType
    options: tuple[Option, ...]
    bits: tuple[Bit, ...]
    fields: tuple[BitField, ...]
    where: Where


def places(device: Device) -> list[Place]:
    """All places of a device that have one; codes of the first slot come before those of the second."""
    owners = {code.number: code.designation for code in device.codes}
    found: list[Place] = []
    for code in device.codes:
        found += _code_places(code, owners.get(code.twin_of, code.designation))
    for entry in device.objects:
        found += _object_places(entry)
    return found


def selections(found: Sequence[Place], scope: Scope) -> dict[Key, Selection]:
    """The enum for each place that has a selection list; ``scope`` holds the names of the enums."""

    def build(name: str, title: str, place: Place) -> Selection:
        return _selection(scope.add(type_name(name), place.where), title, place)

    def content(place: Place) -> tuple[object, ...]:
        return (place.data_type, *place.options) if place.options else ()

    return _shared(found, content, build)


def masks(found: Sequence[Place], scope: Scope) -> dict[Key, Masks]:
    """The module of masks for each place that has bits; ``scope`` holds the names of the modules."""

    def build(name: str, title: str, place: Place) -> Masks:
        return _masks(scope.add(safe(name, "rust"), place.where), title, place)

    def content(place: Place) -> tuple[object, ...]:
        return (place.data_type, *place.bits, *place.fields) if place.bits or place.fields else ()

    return _shared(found, content, build)


def variants(options: Sequence[Option], enum: str, where: Where) -> tuple[str, ...]:
    """Names of the variants of an enum.

    Raises:
        EmitError: Two entries get one name.
    """
    scope = Scope(f"variants of {enum}")
    return tuple(scope.add(type_name(name), where) for name in names.option_names(options))


def _code_places(code: Code, owner: str) -> Iterable[Place]:
    whole = names.code_name(code)

    def place(part: int | None, name: str, label: str, options: tuple[Option, ...]) -> Place:
        own = code if part is None else None
        return Place(
            key=(code.designation, part),
            owner=owner,
            whole=whole,
            part=name,
            title=label,
            data_type=code.data_type,
            options=options,
            bits=own.bits if own else (),
            fields=own.fields if own else (),
            where=code.where,
        )

    if code.options or code.bits or code.fields:
        yield place(None, whole, f"{code.designation} {code.name}", code.options)
    for sub in code.subcodes:
        if sub.options:
            name = sub.name or code.name
            part = snake(code.designation, str(sub.number), name)
            yield place(sub.number, part, f"{code.designation}/{sub.number} {name}", sub.options)


def _object_places(entry: DictionaryObject) -> Iterable[Place]:
    whole = names.object_name(entry)
    for sub in entry.subindexes:
        if sub.options or sub.bits or sub.fields:
            yield Place(
                key=(entry.designation, sub.number),
                owner=entry.designation,
                whole=whole,
                part=names.subindex_name(entry, sub),
                title=f"{entry.designation}/{sub.number} {sub.name}",
                data_type=sub.data_type,
                options=sub.options,
                bits=sub.bits,
                fields=sub.fields,
                where=sub.where,
            )


def _shared(
    found: Sequence[Place], content: Callable[[Place], tuple[object, ...]], build: Callable[[str, str, Place], View]
) -> dict[Key, View]:
    """One view for all places of an owner with the same content.

    It is named after the whole where there are several parts and the owner has no other content, else after the first.
    """
    groups: dict[tuple[str, tuple[object, ...]], list[Place]] = {}
    for place in found:
        if key := content(place):
            groups.setdefault((place.owner, key), []).append(place)
    contents = Counter(owner for owner, _ in groups)
    views: dict[Key, View] = {}
    for (owner, _), members in groups.items():
        first = members[0]
        several = len({place.key[1] for place in members}) > 1
        name = first.whole if several and contents[owner] == 1 else first.part
        title = first.title + (" and others" if several else "")
        views.update(dict.fromkeys((place.key for place in members), build(name, title, first)))
    return views


def _selection(name: str, title: str, place: Place) -> Selection:
    entries = zip(variants(place.options, name, place.where), place.options, strict=True)
    return Selection(
        name,
        doc([words.headline(title)], indent=4),
        facts.integer(place.data_type, place.data_type.signed),
        tuple(
            Variant(doc([words.headline(f"{option.value}: {option.label}")], indent=8), variant, *_literals(option))
            for variant, option in entries
        ),
    )


def _literals(option: Option) -> tuple[str, str]:
    return str(option.value), string(option.label)


def _masks(name: str, title: str, place: Place) -> Masks:
    kind = facts.integer(place.data_type, False)
    digits = place.data_type.bits // 4
    constants = [
        Constant(
            doc([words.headline(f"Bit {bit.number}: {bit.label}")], indent=4),
            constant_name(label),
            kind,
            hexadecimal(1 << bit.number, digits),
        )
        for bit, label in zip(place.bits, names.bit_names(place.bits), strict=True)
    ]
    for field, label in zip(place.fields, names.field_names(place.fields), strict=True):
        run = f"bits {field.low} ... {field.high}" if field.high > field.low else f"bit {field.low}"
        head = f"{markdown(field.label)}, {run}"
        mask, shift = f"{constant_name(label)}_MASK", f"{constant_name(label)}_SHIFT"
        constants += [
            Constant(doc([f"{head}: mask."], indent=4), mask, kind, hexadecimal(field.mask, digits)),
            Constant(doc([f"{head}: number of the lowest bit."], indent=4), shift, "u32", str(field.low)),
        ]
    scope = Scope(f"constants of the bits of {name}")
    for claimed in ("BITS", "FIELDS", *(constant.name for constant in constants)):
        scope.add(claimed, place.where)
    return Masks(
        name,
        doc([words.headline(f"Bits of {title}")]),
        tuple(constants),
        declaration("BITS", "&[Bit]", array(map(facts.bit, place.bits)), 4) if place.bits else "",
        declaration("FIELDS", "&[BitField]", array(map(facts.bit_field, place.fields)), 4) if place.fields else "",
    )
