"""What on a device refers to what, and links between them."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from copy import copy
from itertools import pairwise
from typing import TypeVar

from generator.emit.html.blocks import Anchor
from generator.emit.html.places import COMMANDS, Places, code_id, erratum_id, error_id, error_text, named_id, object_id
from generator.emit.html.text import ELLIPSIS, Piece, Prose, joined, manual_link, place_of, prose
from generator.model import Cite, Code, CodeRef, Device, DictionaryObject, ErrorEntry, ErrorRef, ObjectRef, Slot
from generator.model.erratum import Subject

T = TypeVar("T")

_LONGEST_LIST = 2
_WHOLE = -2
"""Stands for the subcode or sub-index of a reference that names none; far from 0, which would go on from -1."""


class Links:
    """Where the facts of one device stand, and which of them belong together, as seen from one of its pages."""

    def __init__(self, device: Device, page: str = "") -> None:
        """Take in the facts of ``device``; ``page`` is the one on which the links stand."""
        self.device = device
        self._page = page
        self._places = Places(device)
        self._named = {
            named_id(kind, entry.id)
            for kind, entries in (
                ("led", device.indicators),
                ("switch", device.switches),
                ("table", device.tables),
                ("formula", device.formulas),
                ("layout", device.layouts),
                ("telegram", device.examples),
                ("service", device.services),
            )
            for entry in entries
        }
        self._codes = {code.number: code for code in device.codes}
        self._subcodes = {(code.number, sub.number) for code in device.codes for sub in code.subcodes}
        self._objects: dict[int, DictionaryObject] = {}
        for entry in device.objects:
            self._objects.setdefault(entry.index, entry)
        self._errors = {(error.kind, error.number): error for error in device.errors}
        self._errata = {erratum.id for erratum in device.errata}
        self._twins: dict[int, list[Code]] = defaultdict(list)
        for code in device.codes:
            self._twins[code.twin_of].append(code)
        self._mirrored_by: dict[int, set[tuple[int | None, ObjectRef]]] = defaultdict(set)
        self._mirrors: dict[int, set[tuple[int | None, CodeRef]]] = defaultdict(set)
        self._set_in: dict[int, list[ErrorEntry]] = defaultdict(list)
        self._relate()

    def _relate(self) -> None:
        for code in self.device.codes:
            for target in code.objects:
                self._mirrored_by[code.number].add((None, target))
                self._mirrors[target.index].add((target.subindex, code.ref))
        for entry in self.device.objects:
            for sub in entry.subindexes:
                for ref in sub.codes:
                    self._mirrored_by[ref.number].add((ref.subcode, ObjectRef(entry.index, sub.number)))
                    self._mirrors[entry.index].add((sub.number, ref))
        for error in self.device.errors:
            for number in dict.fromkeys(ref.number for ref in error.adjustable_in):
                self._set_in[number].append(error)

    def on(self, page: str) -> "Links":
        """The same links as seen from another page."""
        other = copy(self)
        other._page = page
        return other

    def href(self, anchor: str) -> str:
        """Address of an anchor of this device."""
        page = self._places.page(anchor)
        if page == self._page:
            return f"#{anchor}"
        return page if self._places.is_first(anchor) else f"{page}#{anchor}"

    def anchored(self, anchor: Anchor) -> Prose:
        """The number of an anchor as a link to its place."""
        return (Piece(anchor.text, self.href(anchor.id)),)

    def code_of(self, ref: CodeRef) -> Code | None:
        """Code of a reference, ``None`` where the manual of the device does not describe it."""
        return self._codes.get(ref.number)

    def code(self, ref: CodeRef) -> Piece:
        """Link to a code, to the subcode where it has one of that number."""
        if ref.number not in self._codes:
            drive = self.device.drive
            return Piece(str(ref), self.href(COMMANDS) if drive and drive.command_code == ref.number else "")
        known = (ref.number, ref.subcode) in self._subcodes
        return Piece(str(ref), self.href(code_id(ref.number, ref.subcode if known else None)))

    def object(self, ref: ObjectRef) -> Piece:
        """Link to an object, to the sub-index where it has one of that number."""
        entry = self._objects.get(ref.index)
        if entry is None:
            return Piece(str(ref))
        known = ref.subindex is not None and entry.subindex(ref.subindex) is not None
        text = entry.designation + (f"/{ref.subindex}" if ref.subindex is not None else "")
        return Piece(text, self.href(object_id(entry, ref.subindex if known else None)))

    def error(self, ref: ErrorRef) -> Piece:
        """Link to an error number."""
        text = error_text(ref.kind, ref.number)
        known = (ref.kind, ref.number) in self._errors
        return Piece(text, self.href(error_id(ref.kind, ref.number)) if known else "")

    def erratum(self, name: str) -> Piece:
        """Link to an entry of the ledger."""
        return Piece(name, self.href(erratum_id(name)) if name in self._errata else "")

    def subject(self, subject: Subject) -> Piece:
        """Link to what an erratum concerns."""
        match subject:
            case CodeRef():
                return self.code(subject)
            case ObjectRef():
                return self.object(subject)
            case ErrorRef():
                return self.error(subject)
            case str():
                kind, _, name = subject.partition(":")
                if kind == "device":
                    return Piece(subject, self.href("device") if name == self.device.id else "")
                return self.named_thing(kind, name, subject)

    def named_thing(self, kind: str, name: str, text: str, part: str = "") -> Piece:
        """Link to a thing that has a name alone, or to a part of it; ``kind`` as in ``named_id``."""
        known = named_id(kind, name) in self._named
        return Piece(text, self.href(named_id(kind, name, part)) if known else "")

    def named(self, reference: str) -> Piece:
        """Link to a code or object by its written form, "C13372/2" or "I-1800/1"."""
        name, _, part = reference.partition("/")
        number = int(part) if part else None
        if name.startswith("C"):
            return self.code(CodeRef(int(name[1:]), number))
        return self.object(ObjectRef(int(name[2:], 16), number))

    def source(self, cite: Cite) -> Prose:
        """Citation; another manual than the device's own is a link to what is known of it."""
        return self.page_source(cite.manual, cite.chapter, cite.page)

    def page_source(self, manual: str, chapter: str, page: int | None) -> Prose:
        """Citation by its parts; ``chapter`` is "" where only the page is known."""
        place = place_of(chapter, page)
        if manual == self.device.manual.id:
            return (Piece(f"{manual}, {place}" if place else manual, tag="cite"),)
        return (manual_link(manual), Piece(f", {place}", tag="cite")) if place else (manual_link(manual),)

    def prose(self, text: str) -> Prose:
        """Running text with its references linked."""
        return prose(text, self.named)

    def codes(self, refs: Iterable[CodeRef]) -> Prose:
        """Links to codes in ascending order, runs of codes and of subcodes drawn together."""
        return _listed(sorted(set(refs), key=_code_place), _code_place, self.code)

    def objects(self, refs: Iterable[ObjectRef]) -> Prose:
        """Links to objects, runs of sub-indexes and of the same sub-index of neighbours drawn together."""
        return _listed(sorted(set(refs), key=_object_order), _object_place, self.object)

    def twins(self, code: Code) -> tuple[Code, ...]:
        """The same code in every slot, ascending."""
        return tuple(self._twins[code.twin_of])

    def mirrors_of(self, code: Code) -> tuple[ObjectRef, ...]:
        """Objects that the code mirrors or that mirror it, said on either side."""
        refs = [ref for _, ref in self._mirrored_by[code.number]]
        exact = {ref.index for ref in refs if ref.subindex is not None}
        return tuple(ref for ref in refs if ref.subindex is not None or ref.index not in exact)

    def mirrors_of_subcode(self, code: Code, subcode: int) -> tuple[ObjectRef, ...]:
        """Sub-indexes that mirror the subcode."""
        return tuple(ref for number, ref in self._mirrored_by[code.number] if number == subcode)

    def codes_of(self, entry: DictionaryObject) -> tuple[CodeRef, ...]:
        """Codes that mirror the object or a sub-index of it, said on either side."""
        return _most_exact(ref for _, ref in self._mirrors[entry.index])

    def codes_of_subindex(self, entry: DictionaryObject, subindex: int) -> tuple[CodeRef, ...]:
        """Codes that mirror a sub-index."""
        return _most_exact(ref for number, ref in self._mirrors[entry.index] if number == subindex)

    def codes_of_whole(self, entry: DictionaryObject) -> tuple[CodeRef, ...]:
        """Codes that mirror the object without a word on which of its sub-indexes."""
        placed = {ref.number for number, ref in self._mirrors[entry.index] if number is not None}
        return tuple(ref for _, ref in self._mirrors[entry.index] if ref.number not in placed)

    def errors_set_in(self, code: Code) -> tuple[ErrorEntry, ...]:
        """Errors whose response the code sets."""
        return tuple(self._set_in[code.number])

    def error_twins(self, error: ErrorEntry) -> tuple[ErrorEntry, ...]:
        """The same error in every slot, the first slot first; the error alone where it has no slot."""
        offsets = {slot.name: slot.error_offset for slot in self.device.slots}
        if error.slot is None or error.slot not in offsets:
            return (error,)
        first = error.number - offsets[error.slot]
        twins = [self._errors.get((error.kind, first + slot.error_offset)) for slot in self.device.slots]
        matching = [twin for twin, slot in zip(twins, self.device.slots, strict=True) if _stands_in(twin, slot)]
        return tuple(twin for twin in matching if twin is not None)


def _stands_in(error: ErrorEntry | None, slot: Slot) -> bool:
    return error is not None and error.slot == slot.name


def _most_exact(refs: Iterable[CodeRef]) -> tuple[CodeRef, ...]:
    """References without those to a whole code of which a subcode is named as well."""
    refs = tuple(refs)
    exact = {ref.number for ref in refs if ref.subcode is not None}
    return tuple(ref for ref in refs if ref.subcode is not None or ref.number not in exact)


def _code_place(ref: CodeRef) -> tuple[int, int]:
    return ref.number, _WHOLE if ref.subcode is None else ref.subcode


def _object_place(ref: ObjectRef) -> tuple[int, int]:
    return ref.index, _WHOLE if ref.subindex is None else ref.subindex


def _object_order(ref: ObjectRef) -> tuple[int, int]:
    """By sub-index first, so that neighbours with the same sub-index stand together."""
    index, subindex = _object_place(ref)
    return subindex, index


def _listed(items: Sequence[T], place: Callable[[T], tuple[int, int]], link: Callable[[T], Piece]) -> Prose:
    """Links in a list, runs of three and more as their ends; a run counts on in one of the numbers of ``place``."""
    runs: list[list[T]] = []
    for item in items:
        if runs and _goes_on([*map(place, runs[-1][-2:]), place(item)]):
            runs[-1].append(item)
        else:
            runs.append([item])
    parts: list[Prose] = []
    for run in runs:
        if len(run) > _LONGEST_LIST:
            parts.append((link(run[0]), f" {ELLIPSIS} ", link(run[-1])))
        else:
            parts += [(link(item),) for item in run]
    return joined(parts)


def _goes_on(places: Sequence[tuple[int, int]]) -> bool:
    """Whether two or three places follow each other by the same step, one in the first or in the second number."""
    steps = {(after[0] - before[0], after[1] - before[1]) for before, after in pairwise(places)}
    return len(steps) == 1 and steps <= {(0, 1), (1, 0)}
