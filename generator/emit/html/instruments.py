"""What the instruments for telegrams, error numbers and codes read: the facts of a device as JSON inside the page."""

import json
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from generator.emit.html.blocks import Fact
from generator.emit.html.errors import kind_title
from generator.emit.html.links import Links
from generator.emit.html.lists import counts_on, runs
from generator.emit.html.places import code_id, error_id, error_text, named_id, object_id
from generator.emit.html.services import layout_names
from generator.emit.html.text import between, decimal, hexadecimal
from generator.emit.html.wire import Bus, Strip, Target, code_target, object_target
from generator.emit.json import message as message_facts
from generator.model import (
    CodeRef,
    DataType,
    Default,
    Device,
    Drive,
    ErrorEntry,
    Field,
    Filler,
    Layout,
    Message,
    Model,
    NodeRelative,
    Option,
    Range,
    Service,
    Sizes,
    Slot,
    SubIndex,
    What,
)

SCRIPT = "wire.js"
"""The script of these instruments."""

_INDEX_BITS = 16
_Json = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Choice:
    """An entry of a list to choose from."""

    value: str
    text: str


@dataclass(frozen=True, slots=True)
class First:
    """The telegram that the builder shows to begin with.

    ``known`` says which parameter it reads; ``free``: fields that the sender may choose, by name and title.
    """

    code: str
    sub: int
    node: str
    known: str
    free: tuple[Choice, ...]
    identifier: str
    octets: str
    strip: Strip


@dataclass(frozen=True, slots=True)
class Instruments:
    """The instruments of a page; ``kind`` is the part of the reference.

    ``services`` and ``layouts`` can be chosen, as can the ``types`` of values.  ``first``: what the builder shows to
    begin with, ``None`` where nothing can be read.  ``example``: a number to begin with.  ``nodes``: whether the bus
    has node addresses.  ``log``: a worked telegram as a line of a bus log, "" where none has an identifier.
    ``rule``: how an index is made; ``slots``: the codes of each slot.  ``data`` is JSON that can stand inside an
    element.
    """

    kind: str
    data: str
    services: tuple[Choice, ...] = ()
    layouts: tuple[Choice, ...] = ()
    types: tuple[Choice, ...] = ()
    first: First | None = None
    example: str = ""
    nodes: bool = False
    log: str = ""
    rule: str = ""
    slots: tuple[Fact, ...] = ()


def instruments(model: Model, links: Links, part: str) -> Instruments | None:
    """The instruments of a part of the reference of a device, ``None`` where it has none."""
    device = links.device
    match part:
        case "telegrams" if device.layouts and device.services:
            return _telegrams(model, links)
        case "errors" if device.errors:
            first = next((e for e in device.errors if e.kind == "device"), device.errors[0])
            data = _error_data(links) | {"errors": list(_errors(links, {error.kind for error in device.errors}))}
            return Instruments("errors", _inline(data), example=error_text(first.kind, first.number))
        case "codes" if device.codes and device.drive:
            return _converter(links, device.drive)
        case _:
            return None


def _inline(data: _Json) -> str:
    """JSON without characters that could end the element around it."""
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _without_none(data: _Json) -> _Json:
    """What is said; absent keys keep the page light."""
    return {key: value for key, value in data.items() if value not in (None, "", [], {}, False)}


def _telegrams(model: Model, links: Links) -> Instruments:
    device = links.device
    bus = Bus(model, device)
    lists = _Lists()
    nodes = any(message.identifier for service in device.services for message in service.messages)
    kinds = {service.errors for service in device.services}
    kinds |= {kind for layout in device.layouts for kind in _error_kinds(layout.fields)}
    data = _error_data(links) | {
        "layouts": {layout.id: _layout(links, layout) for layout in device.layouts},
        "services": [_service(links, service) for service in device.services],
        "connections": list(_connections(model, device)) if nodes else [],
        "nodes": [model.node_addresses.start, model.node_addresses.stop - 1],
        "node": bus.node,
        "types": {kind.canopen_name: [kind.bits, int(kind.signed)] for kind in DataType},
        "base": device.drive.index_base if device.drive else None,
        "parameters": [*_codes(links, lists), *_objects(links, lists)],
        "lists": lists.found,
        "errors": list(_errors(links, kinds)),
    }
    asked = [service for service in device.services if service.request is not None]
    return Instruments(
        kind="telegrams",
        data=_inline(data),
        services=tuple(Choice(service.id, service.name) for service in asked),
        layouts=tuple(Choice(layout.id, layout.name) for layout in device.layouts),
        types=tuple(Choice(kind.canopen_name, kind.canopen_name) for kind in DataType if kind is not DataType.DOMAIN),
        first=_first(bus, asked[0]) if asked else None,
        nodes=nodes,
        log=next(_log_lines(device), ""),
    )


def _error_kinds(fields: Sequence[Field]) -> Iterator[str]:
    """Kinds of the error numbers that fields hold."""
    for field in fields:
        if field.errors:
            yield field.errors
        yield from _error_kinds(field.fields)


def _connections(model: Model, device: Device) -> Iterator[_Json]:
    """The predefined connection set, with the layouts of the telegrams that each identifier has."""
    named = [(message.identifier, layout_names(message)) for service in device.services for message in service.messages]
    for entry in model.cob_ids:
        sent = {layout for identifier, layouts in named if identifier == entry.name for layout in layouts}
        yield {
            "name": entry.name,
            "title": entry.title,
            "base": entry.base,
            "broadcast": entry.broadcast,
            "layouts": [one.id for one in device.layouts if one.id in sent or entry.name in one.identifiers],
        }


def _log_lines(device: Device) -> Iterator[str]:
    """Worked telegrams with identifier whose bytes are all known, as "identifier#bytes" in hexadecimal."""
    for example in device.examples:
        if example.identifier is not None and None not in example.data:
            octets = "".join(f"{octet:02X}" for octet in example.data if octet is not None)
            yield f"{example.identifier:X}#{octets}"


def _first(bus: Bus, service: Service) -> First | None:
    """The first telegram of a service for a code that is set by hand, else for the first object."""
    for name, text, target in _usual(bus.device):
        if service.request is None or not target.fits(service):
            continue
        strip = bus.strip(service, service.request, target, target.call, None)
        call = target.call
        index = call.index or 0
        return First(
            code=name,
            sub=call.subindex or 0,
            node="" if bus.node is None else str(bus.node),
            known=f"{text}; {target.type_name}, index {index} = {hexadecimal(index, _INDEX_BITS)}",
            free=tuple(_free(bus, service.request)),
            identifier=strip.identifier,
            octets=" ".join(chunk.octets for chunk in strip.chunks),
            strip=strip,
        )
    return None


def _usual(device: Device) -> Iterator[tuple[str, str, Target]]:
    """Parameters to begin with: what they are called, with their name, and as a service sees them."""
    for code in device.codes:
        if code.slot and code.access.write and not code.subcodes:
            yield code.designation, f"{code.designation} {code.name}", code_target(code, 0)
    for entry in device.objects:
        if len(entry.subindexes) == 1:
            yield entry.designation, f"{entry.designation} {entry.name}", object_target(entry, entry.subindexes[0])


def _free(bus: Bus, message: Message) -> Iterator[Choice]:
    titles = {field.name: field.title for field in bus.layouts[layout_names(message)[0]].fields}
    for name, filling in message.values:
        if isinstance(filling, Filler) and filling.what is What.FREE:
            whole, _, part = name.partition(".")
            yield Choice(name, part or titles[whole])


class _Lists:
    """Selection lists, each once."""

    def __init__(self) -> None:
        """Begin without any."""
        self.found: list[list[tuple[int, str]]] = []

    def place(self, options: Sequence[Option]) -> int | None:
        """Place of a list among those found, ``None`` for an empty one."""
        pairs = [(option.value, option.label) for option in options]
        if pairs and pairs not in self.found:
            self.found.append(pairs)
        return self.found.index(pairs) if pairs else None


def _layout(links: Links, layout: Layout) -> _Json:
    href = links.href(named_id("layout", layout.id))
    return {"name": layout.name, "href": href, "fields": list(map(_field, layout.fields))}


def _field(field: Field) -> _Json:
    sizes = field.sizes
    return {
        "name": field.name,
        "title": field.title,
        "type": field.type.value,
        "big": field.big,
        "length": field.length,
        "count": field.count,
    } | _without_none(
        {
            "sizes": _sizes(sizes) if sizes else None,
            "fields": list(map(_field, field.fields)),
            "constant": None if field.constant is None else [field.constant],
            "values": _options(field.values),
            "bits": [[part.low, part.high, part.label] for part in field.bits],
            "parts": {name: _options(options) for name, options in field.bit_values},
            "errors": field.errors,
        }
    )


def _sizes(sizes: Sizes) -> _Json:
    return {"by": sizes.by, "of": dict(sizes.sizes), "times": sizes.times, "fills": sizes.fills}


def _options(options: Sequence[Option]) -> list[tuple[int, str]]:
    return [(option.value, option.label) for option in options]


def _service(links: Links, service: Service) -> _Json:
    return {
        "id": service.id,
        "name": service.name,
        "does": service.does.value,
        "reaches": list(service.reaches),
        "errors": service.errors,
        "limit": service.limit,
        "request": _message(service.request),
        "answer": _message(service.answer),
        "href": links.href(named_id("service", service.id)),
    }


def _message(message: Message | None) -> Mapping[str, object] | None:
    return message_facts(message) if message else None


def _codes(links: Links, lists: _Lists) -> Iterator[_Json]:
    for code in links.device.codes:
        facts = {
            "key": code.designation,
            "name": code.name,
            "href": links.href(code_id(code.number)),
            "reached": "codes",
            "index": code.index,
            "code": code.number,
            "spelled": code.type_name,
            "access": ("r" if code.access.read else "") + ("w" if code.access.write else ""),
        }
        limits = _limits(code.range, code.data_type, code.scaling or 1)
        yield facts | _without_none(
            {
                "type": code.data_type.canopen_name,
                "scaling": code.scaling if code.scaling != 1 else None,
                **limits,
                "list": _one(lists.place(code.options)),
                "default": _default(code.default),
                "subs": _parts(
                    (
                        sub.number,
                        sub.name,
                        {"default": _default(sub.default), "list": _one(lists.place(sub.options))},
                    )
                    for sub in code.subcodes
                ),
            }
        )


def _one(place: int | None) -> list[int] | None:
    """A number that may be 0, so that it is not taken for an absent one."""
    return None if place is None else [place]


def _limits(limits: Range | None, data_type: DataType, scaling: int) -> _Json:
    """Limits in the unit, exact; those that the data type sets anyway are left out."""
    if limits is None:
        return {}
    unit = {"unit": limits.unit}
    if limits.low * scaling == data_type.lowest and limits.high * scaling == data_type.highest:
        return unit
    return {"low": decimal(Fraction(limits.low)), "high": decimal(Fraction(limits.high))} | unit


def _default(default: Default | None) -> list[int | str] | None:
    match default:
        case None:
            return None
        case NodeRelative(base):
            return [base, "node"]
        case _:
            return [default]


def _objects(links: Links, lists: _Lists) -> Iterator[_Json]:
    for entry in links.device.objects:
        named = len(entry.subindexes) > 1
        yield {
            "key": entry.designation.replace(" ", "-"),
            "name": entry.name,
            "href": links.href(object_id(entry)),
            "reached": "objects",
            "index": entry.index,
            "subs": _parts(
                (sub.number, sub.name if named else "", _subindex(sub, lists))
                for sub in entry.subindexes
                if sub.abort is None
            ),
        }


def _subindex(sub: SubIndex, lists: _Lists) -> _Json:
    return {
        "type": sub.data_type.canopen_name,
        "access": ("" if sub.access == "wo" else "r") + ("" if sub.access in ("ro", "const") else "w"),
        **_limits(sub.range, sub.data_type, 1),
        "list": _one(lists.place(sub.options)),
        "default": _default(sub.default),
        "signature": sub.signature,
    }


_Part = tuple[int, str, _Json]
"""Number, name and own facts of a subcode or sub-index."""


def _parts(parts: Iterable[_Part]) -> list[list[Any]]:
    """Subcodes or sub-indexes as (first, last, name, facts), those that say the same as one.

    A number of the name that counts on with them stands in braces as it is for the first.
    """
    return [
        [run[0][0], run[-1][0], _counting(run[0][1], run[-1][1]), _without_none(run[0][2])]
        for run in runs(list(parts), _goes_on)
    ]


def _goes_on(first: _Part, other: _Part, step: int) -> bool:
    return other[0] == first[0] + step and other[2] == first[2] and counts_on(first[1], other[1], step)


def _counting(text: str, last: str) -> str:
    pairs = zip(re.split(r"(\d+)", text), re.split(r"(\d+)", last), strict=True)
    return "".join(mine if mine == its else f"{{{mine}}}" for mine, its in pairs)


def _errors(links: Links, kinds: Collection[str | None]) -> Iterator[list[Any]]:
    """Errors of some kinds as (kind, first number, last number, name, address, further facts).

    ``each``: what the addresses of the numbers of a run begin with, where each number has one of its own.
    """
    for error in links.device.errors:
        if error.kind not in kinds:
            continue
        href = links.href(error_id(error.kind, error.number))
        yield [error.kind, error.number, error.last, error.name, href, _facts(links, error)]


def _facts(links: Links, error: ErrorEntry) -> _Json:
    codes = [(piece.text, piece.href) for piece in map(links.code, error.adjustable_in)]
    each = error.count > 1 and len(codes) == error.count
    return _without_none(
        {
            "slot": error.slot,
            "response": error.response,
            "codes": codes,
            "each": error_id(error.kind, error.number).partition("0x")[0] + "0x" if each else None,
        }
    )


def _error_data(links: Links) -> _Json:
    device = links.device
    kinds = dict.fromkeys(error.kind for error in device.errors)
    data: _Json = {
        "kinds": {kind: kind_title(kind) for kind in kinds},
        "digits": {kind: len(error_text(kind, 0)) - 2 for kind in kinds},
    }
    if device.drive and "device" in kinds:
        data |= {
            "mask": device.error_mask,
            "fields": [(name, field.low, field.high) for name, field in device.drive.error_fields],
            "values": {
                "response": {response.value: response.name for response in device.drive.responses},
                "module": {module.value: module.name for module in device.drive.modules},
            },
        }
    return data


def _converter(links: Links, drive: Drive) -> Instruments:
    device = links.device
    first = next((code for code in device.codes if code.slot), device.codes[0])
    data = {
        "base": drive.index_base,
        "slots": [[slot.name, slot.first_code, slot.last_code, slot.code_offset] for slot in device.slots],
        "codes": {
            code.number: [code.name, links.href(code_id(code.number)), code.highest_subcode] for code in device.codes
        },
        "objects": {
            entry.index: [entry.designation, links.href(object_id(entry)), entry.name] for entry in device.objects
        },
    }
    return Instruments(
        kind="codes",
        data=_inline(data),
        example=first.designation,
        rule=f"Index = {drive.index_base} \N{MINUS SIGN} number of the code; the sub-index is the subcode.",
        slots=tuple(_slot(drive, slot) for slot in device.slots),
    )


def _slot(drive: Drive, slot: Slot) -> Fact:
    codes = between(str(CodeRef(slot.first_code)), str(CodeRef(slot.last_code)))
    indexes = between(str(drive.index_base - slot.first_code), str(drive.index_base - slot.last_code))
    return Fact(f"Codes of {slot.name}", f"{codes}, index {indexes}")
