"""What the ledger of errata says beside an entry: what is printed where, and what is used instead."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from generator.emit.html.blocks import Note
from generator.emit.html.links import Links
from generator.emit.html.text import Piece, Prose, through
from generator.model import Code, CodeRef, DictionaryObject, Erratum, ErratumPlace, ErrorEntry, SubIndex

_ANYTHING = "..."
_PLACE_WORDS = {"chapter": "own table", "table": "table of attributes", "detail": "detailed description", "base": ""}


@dataclass(frozen=True, slots=True)
class Printed:
    """A thing as one place prints it, and what is used.

    ``rule`` is the check that compares them and ``place`` the place in its words; ``label`` is the place for readers.
    ``values`` is what is printed in the forms that a ledger entry may give.
    """

    rule: str
    place: str
    label: str
    shown: str
    used: str
    values: tuple[int | str, ...]


@dataclass(frozen=True, slots=True)
class Subject:
    """One fact: ids of the errata that concern it, what is printed otherwise, the variables of ledger formulas.

    ``name`` is what the ledger calls it in the places that it lists, "" where it goes by no designation.
    """

    errata: tuple[str, ...]
    printed: tuple[Printed, ...]
    variables: Mapping[str, int]
    name: str = ""


def named_subject(errata: tuple[str, ...]) -> Subject:
    """A fact that has a name alone, such as a table: only the ledger itself tells what is printed of it."""
    return Subject(errata, (), {})


def code_subject(code: Code) -> Subject:
    """What is printed of a code otherwise than it is used: indexes and names."""
    return Subject(code.errata, tuple(_code_printed(code)), {"code": code.number, "index": code.index}, str(code.ref))


def _code_printed(code: Code) -> Iterator[Printed]:
    for row in code.printed:
        for value, form, style in ((row.decimal, "decimal", "{}"), (row.hexadecimal, "hexadecimal", "{:04X}h")):
            if value is not None and value != code.index:
                label, place = located(row.place, row.page), f"{row.place} {form}"
                yield Printed("code-index", place, label, style.format(value), style.format(code.index), (value,))
    for kind, page, name in (
        ("chapter", code.cite.page, code.printed_name),
        ("table", code.attributes.page if code.attributes else None, code.attributes.name if code.attributes else None),
    ):
        if name is not None and name != code.name:
            place = f"{kind} {code.slot or 'base'}"
            yield Printed("code-name", place, located(place, page), name, code.name, (name,))


def error_subject(error: ErrorEntry) -> Subject:
    """What is printed of an error otherwise than it is used: numbers, names and the codes that set the response."""
    return Subject(error.errata, tuple(_error_printed(error)), {"number": error.number})


def _error_printed(error: ErrorEntry) -> Iterator[Printed]:
    last = error.last if error.count > 1 else None
    for entry in error.printed:
        if (entry.first, entry.last) != (error.number, last):
            label = located(entry.place, entry.page)
            shown = _number_run(entry.first, entry.last, entry.base)
            used = _number_run(error.number, last, entry.base)
            ends = (entry.first, "none" if entry.last is None else entry.last)
            yield Printed("error-number", entry.place, label, shown, used, ends)
    for place, name, _ in error.printed_names:
        if name != error.name:
            yield Printed("error-name", place, located(place, None), name, error.name, (name,))
    for place, codes, _ in error.printed_adjustable_in:
        if codes != error.named_in:
            values = (", ".join(map(str, codes)),)
            used = code_run(error.named_in) or "none"
            yield Printed("error-adjustable", place, located(place, None), code_run(codes), used, values)


def object_subject(entry: DictionaryObject) -> Subject:
    """What is printed of the sub-indexes of an object otherwise than it is used: data types and accesses."""
    names = (*entry.errata, *(name for sub in entry.subindexes for name in sub.errata))
    printed = tuple(item for sub in entry.subindexes for item in _subindex_printed(sub))
    return Subject(tuple(dict.fromkeys(names)), printed, {"index": entry.index}, entry.designation)


def _subindex_printed(sub: SubIndex) -> Iterator[Printed]:
    for rule, place, printed, used in (
        ("standard-type", "type", sub.printed_type.canopen_name, sub.data_type.canopen_name),
        ("standard-access", "access", sub.printed_access, sub.access),
    ):
        if printed != used:
            yield Printed(rule, place, f"sub-index {sub.number}, {place},", printed, used, (printed,))


def _number_run(first: int, last: int | None, base: int) -> str:
    ends = [f"0x{end:08x}" if base == 16 else str(end) for end in (first, first if last is None else last)]
    return through(*ends)


def code_run(codes: Sequence[CodeRef]) -> str:
    """Codes as text; three and more subcodes in a row as first and last."""
    in_a_row = len(codes) > 2 and all(
        a.subcode is not None and b == CodeRef(a.number, a.subcode + 1) for a, b in pairwise(codes)
    )
    if in_a_row:
        return through(str(codes[0]), str(codes[-1]))
    return ", ".join(map(str, codes))


def notes(links: Links, subjects: Iterable[Subject]) -> tuple[Note, ...]:
    """Ledger entries that concern any of the subjects (the slots of one entry), in the order of the ledger."""
    subjects = tuple(subjects)
    names = {name for subject in subjects for name in subject.errata}
    concerning = [erratum for erratum in links.device.errata if erratum.id in names] if names else []
    return tuple(_note(links, erratum, [s for s in subjects if erratum.id in s.errata]) for erratum in concerning)


def _note(links: Links, erratum: Erratum, subjects: Sequence[Subject]) -> Note:
    explained: dict[str, list[Printed]] = {}
    for subject in subjects:
        for item in subject.printed:
            if _explains(erratum, item, subject.variables):
                explained.setdefault(item.label, []).append(item)
    slip = is_slip(erratum)
    kind = "Slip of the text dump " if slip else "Erratum "
    return Note(
        slip=slip,
        caption=(kind, links.erratum(erratum.id), f" says why; confidence {erratum.confidence}"),
        statements=tuple(map(_together, explained.values())) or tuple(_recorded(erratum, subjects)),
    )


def _together(items: Sequence[Printed]) -> Prose:
    """The forms that one place prints as one statement."""
    return _statement(items[0].label, " / ".join(item.shown for item in items), " / ".join(item.used for item in items))


def _statement(place: str, printed: str, used: str) -> Prose:
    """What a place prints and what is used; ``place`` is "" where the ledger names none."""
    opening = f"{place} prints " if place else "Printed: "
    return opening, Piece(printed, tag="s"), "; used: ", Piece(used, tag="b")


def is_slip(erratum: Erratum) -> bool:
    """Whether only the text dump of the manual is wrong, not the manual."""
    return erratum.origin == "dump"


def _explains(erratum: Erratum, item: Printed, variables: Mapping[str, int]) -> bool:
    place = item.place.split()
    if erratum.rule != item.rule or any(ours != its for ours, its in zip(erratum.place, place, strict=False)):
        return False
    if erratum.printed is None:
        return True
    said = erratum.printed(dict(variables))
    if isinstance(said, str) and _ANYTHING in said:
        pattern = ".*".join(map(re.escape, said.split(_ANYTHING)))
        return any(re.fullmatch(pattern, str(value)) for value in item.values)
    return said in item.values


def _recorded(erratum: Erratum, subjects: Sequence[Subject]) -> list[Prose]:
    """What the ledger itself says was printed."""
    if erratum.places:
        used = " / ".join(dict.fromkeys(_used(erratum, s) for s in subjects))
        places = [
            (f"{place.location}{_page(place.page)} prints ", Piece(place.printed, tag="s"))
            for place in _telling_places(erratum, subjects)
        ]
        return [*places, ("Used: ", Piece(used, tag="b"))]
    place = located(" ".join(erratum.place), None)
    pairs = [(_printed(erratum, s), _used(erratum, s)) for s in subjects]
    return [_statement(place, printed, used) for printed, used in dict.fromkeys(pairs)]


def _telling_places(erratum: Erratum, subjects: Sequence[Subject]) -> Sequence[ErratumPlace]:
    """The places that name one of the subjects or nothing else, those alone that differ from what is used.

    Where no place does so, all that the ledger lists.
    """
    ours = {subject.name for subject in subjects}
    others = {str(subject).removeprefix("E-") for subject in erratum.about} - ours if all(ours) else set()
    own = [place for place in erratum.places if not any(_names(place, name) for name in others)]
    own += [place for place in erratum.places if place not in own and any(_names(place, s.name) for s in subjects)]
    differing = [place for place in own if place.printed != erratum.used_text]
    return sorted(differing, key=erratum.places.index) or own or erratum.places


def _names(place: ErratumPlace, name: str) -> bool:
    return bool(name) and name in place.location


def _printed(erratum: Erratum, subject: Subject) -> str:
    if erratum.printed is None or not subject.variables:
        return erratum.printed_text
    return str(erratum.printed(dict(subject.variables)))


def _used(erratum: Erratum, subject: Subject) -> str:
    return str(erratum.used(dict(subject.variables))) if subject.variables else erratum.used_text


def located(place: str, page: int | None) -> str:
    """Place in the words of a check as a reader would say it, with its page: "own table MXI2, p. 128"."""
    words = (_PLACE_WORDS.get(word, word) for word in place.split())
    return " ".join(word for word in words if word) + _page(page)


def _page(page: int | None) -> str:
    return f", p. {page}" if page is not None else ""
