"""Error numbers: slots derived, runs and the codes that set their responses paired."""

from collections.abc import Iterator, Set
from dataclasses import dataclass

from generator.diagnostics import suggestion
from generator.elaborate.codes import BASE, ErrataIndex
from generator.elaborate.common import fill, optional_text, origin
from generator.model import Cite, CodeRef, Drive, ErrorEntry, ErrorRef, PrintedNumber, Slot, Where
from generator.model.table import NOTHING_PRINTED
from generator.notation import numbers, references
from generator.tree import Node

_LONGEST_RUN = 0x10000
_HIGHEST = 0xFFFFFFFF


@dataclass(frozen=True, slots=True)
class Frame:
    """What an error needs to know of its device: slots, drive, the codes and subcodes that exist, the ledger."""

    slots: tuple[Slot, ...]
    drive: Drive | None
    known: Set[CodeRef]
    errata: ErrataIndex


def errors(root: Node, frame: Frame) -> tuple[ErrorEntry, ...]:
    """Error entries of a device's errors.yaml in every slot, by kind and number."""
    found: dict[tuple[str, int], ErrorEntry] = {}
    for node in root.items("errors"):
        _known_responses(node, frame.drive)
        for entry in _expand(node, frame):
            key = (entry.kind, entry.number)
            if key in found:
                node.problems.add(
                    "duplicate", node.at("number"), f"{entry.ref} is written twice", other=("first", found[key].where)
                )
            found.setdefault(key, entry)
    return tuple(found[key] for key in sorted(found))


def _known_responses(node: Node, drive: Drive | None) -> None:
    if drive is None:
        return
    known = [name for r in drive.responses for name in (r.name, *r.aliases)]
    for key, names in (("response", [node.get("response")]), ("responses", node.texts("responses"))):
        for name in names:
            if name is not None and name not in known:
                hint = suggestion(str(name), known, "responses")
                node.problems.add("name-unknown", node.at(key), f"the drive has no response '{name}'", hint=hint)


def _expand(node: Node, frame: Frame) -> Iterator[ErrorEntry]:
    first, last = number(node)
    printed = dict(node.children("printed"))
    if not printed:
        yield _entry(node, None, first, last, None, frame)
        return
    known = {slot.name: slot for slot in frame.slots}
    for name, place in printed.items():
        if name != BASE and name not in known:
            parent = node.child("printed")
            assert parent is not None
            hint = suggestion(name, [*known, BASE], "slots")
            node.problems.add("name-unknown", parent.at_key(name), f"the device has no slot '{name}'", hint=hint)
            continue
        yield _entry(node, known.get(name), first, last, place, frame)


def number(node: Node) -> tuple[int, int]:
    """First and last number of an error entry; (0, 0) where a problem was noted."""
    value = node.get("number")
    if isinstance(value, int):
        return value, value
    found = node.read("number", numbers)
    if not found:
        return 0, 0
    run = found[0]
    last = run.first if run.last is None else run.last
    if last < run.first:
        node.problems.add(
            "run-order", node.at("number"), "the run does not ascend", hint="write the lower number first"
        )
    elif last - run.first >= _LONGEST_RUN:
        node.problems.add(
            "run-order",
            node.at("number"),
            f"the run has {last - run.first + 1} numbers, more than {_LONGEST_RUN}",
            hint="describe what is printed; a run stands for numbers that can occur",
        )
    else:
        return run.first, last
    return 0, 0


def _entry(node: Node, slot: Slot | None, first: int, last: int, printed: Node | None, frame: Frame) -> ErrorEntry:
    kind = str(node.get("kind"))
    offset = slot.error_offset if slot else 0
    if not 0 <= first + offset <= last + offset <= _HIGHEST:
        node.problems.add(
            "error-number",
            node.at("number"),
            f"{last + offset} is no error number" if first + offset >= 0 else f"{first + offset} is no error number",
            compared=[("highest", _HIGHEST), ("offset of the slot", offset)],
            hint="correct the number or the 'error_offset' of the slot",
        )
    values = {"slot": slot.name} if slot else {}
    name = fill(str(node.get("name")), node, "name", dict(values))
    place = slot.name if slot else BASE
    named = _codes(node, "adjustable_in", slot)
    return ErrorEntry(
        kind=kind,
        number=first + offset,
        last=last + offset,
        slot=slot.name if slot else None,
        name=name,
        response=optional_text(node, "response"),
        responses=node.texts("responses"),
        adjustable_in=tuple(ref for ref in named if ref in frame.known),
        named_in=named,
        printed_adjustable_in=tuple(_printed_codes(printed, place)) if printed else (),
        register=optional_text(node, "register"),
        causes=node.texts("causes"),
        remedies=node.texts("remedies"),
        description=str(node.get("description", "")).strip(),
        origin=origin(node),
        cite=_cite(node, printed),
        printed=tuple(_printed(printed, place)) if printed else (),
        printed_names=tuple(_names(printed, place)) if printed else (),
        errata=frame.errata.of(ErrorRef(kind, first + offset)),
        where=node.at("number"),
    )


def _cite(node: Node, printed: Node | None) -> Cite:
    cite = node.cite()
    page = printed.page("detail_page", cite.manual, cite.chapter) if printed else None
    return Cite(cite.manual, cite.chapter, page) if page is not None else cite


def _codes(node: Node, key: str, slot: Slot | None) -> tuple[CodeRef, ...]:
    offset = slot.code_offset if slot else 0
    found = node.read(key, references) or ()
    refs = (item for run in found for item in run.items if isinstance(item, CodeRef))
    return tuple(CodeRef(ref.number + offset, ref.subcode) for ref in refs)


def _printed(printed: Node, place: str) -> Iterator[PrintedNumber]:
    for key, page in (("overview", printed.page("page", printed.file.manual)), ("detail", printed.get("detail_page"))):
        for run in printed.read(key, numbers) or ():
            yield PrintedNumber(f"{key} {place}", run.base, run.first, run.last, page, printed.at(key))


def _names(printed: Node, place: str) -> Iterator[tuple[str, str, Where]]:
    for key, where in (("name", "overview"), ("detail_name", "detail")):
        if key in printed:
            yield f"{where} {place}", str(printed.get(key)), printed.at(key)


def _printed_codes(printed: Node, place: str) -> Iterator[tuple[str, tuple[CodeRef, ...], Where]]:
    for key, where in (("adjustable_in", "overview"), ("detail_adjustable_in", "detail")):
        if key in printed:
            none = printed.get(key) == NOTHING_PRINTED
            yield f"{where} {place}", () if none else _codes(printed, key, None), printed.at(key)
