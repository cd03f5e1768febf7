"""Enums of selection lists and of bits, one for each list that differs."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import TypeVar

from generator.emit import names
from generator.emit.python.text import doc, fill, literal
from generator.emit.python.views import EnumView, MemberView, RowView
from generator.model import (
    Bit,
    Code,
    DictionaryObject,
    Drive,
    DriveCommand,
    DriveModule,
    Field,
    Layout,
    Option,
    Response,
    SubCode,
    SubIndex,
    Where,
)
from generator.naming import Scope, pascal, safe

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class EnumFact:
    """The fact that has values or bits; facts of one ``owner`` share their enums, the first gives name and title."""

    owner: tuple[object, ...]
    name: str
    title: str
    where: Where


class Enums:
    """Enums of one device; their names stand in the ``scope`` of its module."""

    def __init__(self, scope: Scope) -> None:
        self._scope = scope
        self._views: dict[str, EnumView] = {}
        self._shared: dict[tuple[object, ...], str] = {}

    @property
    def views(self) -> tuple[EnumView, ...]:
        """Every enum that was asked for, in that order."""
        return tuple(self._views.values())

    def view(self, name: str) -> EnumView:
        """The enum of that name."""
        return self._views[name]

    def rows(self, base: str) -> Iterator[RowView]:
        """Rows of the enums of a base, "Selection" or "Flags"."""
        return (enum.row for enum in self._views.values() if enum.base == base)

    def add_drive(self, drive: Drive) -> None:
        """Enums of what the base drive lists: responses, modules and commands."""
        lists: tuple[tuple[str, str, tuple[Response | DriveModule | DriveCommand, ...]], ...] = (
            ("DriveResponse", "Responses to an error", drive.responses),
            ("DriveModule", "Values of the module field of an error number", drive.modules),
            ("DriveCommand", "Device commands", drive.commands),
        )
        for name, title, entries in lists:
            cites = "; ".join(dict.fromkeys(str(entry.cite) for entry in entries))
            options = tuple(Option(entry.value, entry.name) for entry in entries)
            self.selection(EnumFact((name,), name, f"{title} of the {drive.title}. {cites}.", drive.where), options)

    def selection(self, fact: EnumFact, options: tuple[Option, ...]) -> str | None:
        """Name of the enum of a selection list."""
        return self._enum("Selection", fact, options, _option_members) if options else None

    def flags(self, fact: EnumFact, bits: tuple[Bit, ...]) -> str | None:
        """Name of the enum of bits."""
        flags = replace(fact, name=f"{fact.name}Flags", title=f"Bits of {fact.title}")
        return self._enum("Flags", flags, bits, _bit_members) if bits else None

    def _enum(
        self, base: str, fact: EnumFact, entries: tuple[T, ...], make: Callable[[tuple[T, ...]], Iterable[MemberView]]
    ) -> str:
        """Name of the enum with these entries; facts of one owner with the same entries share the first one's."""
        key = (base, fact.owner, entries)
        if key not in self._shared:
            self._shared[key] = name = self._scope.add(fact.name, fact.where)
            members = tuple(make(entries))
            _check_members(fact, members)
            row = RowView(f"{literal(name)}: ", fill((fact.title, tuple((m.number, m.name, m.label) for m in members))))
            self._views[name] = EnumView(name, base, doc(fact.title), members, row)
        return self._shared[key]


def code_fact(code: Code) -> EnumFact:
    """A code; the one of the first slot names the enum."""
    title = f"{code.name} ({code.designation}). {code.cite!s}."
    return EnumFact(("code", code.twin_of), pascal(names.code_name(code)), title, code.where)


def subcode_fact(code: Code, sub: SubCode) -> EnumFact:
    """A subcode that has values of its own."""
    title = f"{code.name}: {sub.name} ({code.designation}/{sub.number}). {code.cite!s}."
    name = f"{pascal(code.designation)}Sub{sub.number}{pascal(sub.name)}"
    return EnumFact(("code", code.twin_of), name, title, sub.where)


def subindex_fact(entry: DictionaryObject, sub: SubIndex) -> EnumFact:
    """A sub-index."""
    title = f"{sub.name} ({entry.designation}/{sub.number}). {entry.cite!s}."
    name = pascal(names.object_name(entry))
    if len(entry.subindexes) > 1:
        name = f"{pascal(entry.designation.replace('-', ''))}Sub{sub.number}{pascal(sub.name)}"
    return EnumFact(("object", entry.kind, entry.index), name, title, sub.where)


def telegram_fact(layout: Layout, owner: str, field: Field, path: str) -> EnumFact:
    """A field of a telegram, or the part of one that ``path`` names; layouts that list the same share an enum."""
    title = f"{field.title}: {path} ({layout.name}). {layout.cite!s}."
    return EnumFact(("telegram", path), f"{owner}{pascal(path)}", title, field.where)


def _option_members(options: tuple[Option, ...]) -> Iterator[MemberView]:
    for name, option in zip(names.option_names(options), options, strict=True):
        yield MemberView(safe(name.upper(), "python", "N"), option.value, str(option.value), option.label)


def _bit_members(bits: tuple[Bit, ...]) -> Iterator[MemberView]:
    for name, bit in zip(names.bit_names(bits), bits, strict=True):
        value = 1 << bit.number
        yield MemberView(safe(name.upper(), "python", "N"), value, f"0x{value:X}", bit.label)


def _check_members(fact: EnumFact, members: Iterable[MemberView]) -> None:
    """Refuse an enum in which a name or a value stands twice."""
    scope, values = Scope(f"members of {fact.name}"), Scope(f"values of {fact.name}")
    for place, member in enumerate(members):
        scope.add(member.name, at(fact.where, place))
        values.add(member.value, at(fact.where, place))


def at(where: Where, number: int) -> Where:
    """A place of its own for one of several facts that stand on the same line of spec."""
    return replace(where, path=f"{where.path}/{number}")
