"""Codes: slots derived, shared facts merged, runs of subcodes expanded."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from generator.diagnostics import suggestion
from generator.elaborate.common import (
    CODE_TYPES,
    bits,
    default,
    fields,
    fill,
    optional_text,
    options,
    origin,
    runs,
    unique,
)
from generator.model import (
    ANYWHERE,
    Access,
    AttributeRow,
    Cite,
    Code,
    CodeRef,
    ErrorRef,
    ObjectRef,
    PrintedIndex,
    Slot,
    SubCode,
)
from generator.notation import HIGHEST_SUBINDEX, attributes, node_relative, numbers, references, value_range
from generator.tree import Node

_NEEDED = ("name", "type")
BASE = "base"
"""Name under which ``printed`` holds what stands once, outside any slot."""


@dataclass(frozen=True, slots=True)
class Frame:
    """What a code needs to know of its device: slots (the first is the one transcribed), index base, drive.

    ``attributes``: where the table of attributes stands.
    """

    slots: tuple[Slot, ...]
    index_base: int
    drive: str | None
    shared: Mapping[str, Node]
    attributes: Cite | None


class _Merged:
    """A code of a device over the drive's facts of the same code."""

    def __init__(self, own: Node, drive: Node | None) -> None:
        self.own = own
        self.drive = drive

    def of(self, key: str) -> Node:
        """The entry that holds a key: the device's own where it does."""
        return self.own if self.drive is None or key in self.own else self.drive


def shared_codes(root: Node) -> dict[str, Node]:
    """Entries of a drive's codes.yaml by code, for its modules to share."""
    nodes = unique(root, "codes", "code")
    for node in nodes:
        node.cite()  # devices give a citation of their own
    return {str(node.get("code")): node for node in nodes}


def codes(root: Node, frame: Frame, errata: "ErrataIndex") -> tuple[Code, ...]:
    """Codes of a device's codes.yaml in every slot, by number."""
    found = [code for node in unique(root, "codes", "code") for code in _expand(node, frame, errata)]
    return tuple(sorted(found, key=lambda code: code.number))


def _expand(node: Node, frame: Frame, errata: "ErrataIndex") -> Iterator[Code]:
    number = int(str(node.get("code"))[1:])
    entry = _merge(node, frame)
    if entry is None:
        return
    needed = _NEEDED if entry.of("internal").get("internal") else (*_NEEDED, "access")
    missing = [key for key in needed if key not in entry.of(key)]
    if missing:
        node.problems.add(
            "key-absent", node.where, f"the code lacks {', '.join(missing)}", hint=f"add '{missing[0]}: ...'"
        )
        return
    for name, printed in node.children("printed"):
        slot = _slot(name, node, frame)
        if slot is None and name != BASE:
            continue
        own = number + (slot.code_offset if slot else 0)
        if slot and not slot.first_code <= own <= slot.last_code:
            node.problems.add(
                "slot-run",
                node.at("code"),
                f"C{own:05d} is not a code of slot {slot.name}",
                compared=[("codes of the slot", f"C{slot.first_code:05d} ... C{slot.last_code:05d}")],
                hint="write 'base' for a code that belongs to no slot",
            )
            continue
        yield _code(entry, own, number, slot, printed, frame, errata)


def _merge(node: Node, frame: Frame) -> _Merged | None:
    if not node.get("shared", False):
        return _Merged(node, None)
    name = str(node.get("code"))
    if name not in frame.shared:
        hint = suggestion(name, list(frame.shared), "shared codes")
        node.problems.add("shared-unknown", node.at("code"), f"no drive shares a code {name}", hint=hint)
        return None
    drive = frame.shared[name]
    for key, value in node.data.items():
        if key not in ("code", "shared", "cite", "printed") and drive.get(key) == value:
            node.problems.add(
                "shared-same",
                node.at(key),
                f"'{key}' says the same as the drive's entry",
                hint="leave it out",
                other=("drive", drive.at(key)),
            )
    return _Merged(node, drive)


def _slot(name: str, node: Node, frame: Frame) -> Slot | None:
    for slot in frame.slots:
        if slot.name == name:
            return slot
    if name != BASE:
        hint = suggestion(name, [s.name for s in frame.slots] + [BASE], "slots")
        child = node.child("printed")
        assert child is not None
        node.problems.add("name-unknown", child.at_key(name), f"the device has no slot '{name}'", hint=hint)
    return None


def _code(
    entry: _Merged, number: int, twin: int, slot: Slot | None, printed: Node, frame: Frame, errata: "ErrataIndex"
) -> Code:
    own = entry.own
    type_name = str(entry.of("type").get("type"))
    data_type = CODE_TYPES[type_name]
    access = entry.of("access")
    default_node = entry.of("default")
    place = slot.name if slot else BASE
    name = str(entry.of("name").get("name"))
    cite = own.cite()
    chapter = slot.chapter if slot and slot.chapter else cite.chapter
    page = printed.page("page", cite.manual, chapter)
    if page is not None:
        cite = Cite(cite.manual, chapter, page)
    table = frame.attributes or Cite(cite.manual, ANYWHERE)
    table_page = printed.page("table_page", table.manual, table.chapter)
    return Code(
        number=number,
        slot=slot.name if slot else None,
        twin_of=twin,
        name=name,
        index=frame.index_base - number,
        type_name=type_name,
        data_type=data_type,
        length=entry.of("length").get("length"),
        access=Access(
            "r" in access.get("access", ""), "w" in access.get("access", ""), entry.of("conditions").texts("conditions")
        ),
        scaling=entry.of("scaling").get("scaling"),
        range=entry.of("range").read("range", value_range),
        default=default(default_node, "default", default_node.get("default"), data_type.is_number),
        default_cite=entry.of("default_cite").cite("default_cite")
        if "default_cite" in entry.of("default_cite")
        else None,
        options=options(entry.of("selection"), "selection"),
        bits=bits(entry.of("bits")),
        fields=fields(entry.of("fields")),
        subcodes=tuple(_subcodes(entry.of("subcodes"), data_type.is_number)),
        objects=_objects(entry.of("objects")),
        since=optional_text(entry.of("since"), "since"),
        internal=bool(entry.of("internal").get("internal", False)),
        description=str(entry.of("description").get("description", "")).strip(),
        shared_by=frame.drive if entry.drive is not None else None,
        origin=origin(own),
        cite=cite,
        printed_name=str(printed.get("name", name)),
        printed=tuple(_printed(printed, place, cite.page, table_page)),
        attributes=_attributes(printed, table_page),
        errata=errata.of(CodeRef(number)),
        where=own.at("code"),
    )


def _subcodes(node: Node, is_number: bool) -> Iterator[SubCode]:
    parent = node.child("subcodes")
    if parent is None:
        return
    for key, low, high in runs(parent, HIGHEST_SUBINDEX):
        child = parent.child(key)
        assert child is not None
        for number in range(low, high + 1):
            values = {"n": number, "i": number - low + 1}
            shown = default(child, "default", child.get("default"), is_number)
            yield SubCode(
                number=number,
                name=fill(str(child.get("name", "")), child, "name", values),
                default=shown,
                follows=child.read("follows", node_relative),
                options=options(child, "values"),
                description=fill(str(child.get("description", "")).strip(), child, "description", values),
                where=child.at("default") if "default" in child else parent.at_key(key),
            )


def _objects(node: Node) -> tuple[ObjectRef, ...]:
    found = node.read("objects", references) or ()
    return tuple(item for run in found for item in run.items if isinstance(item, ObjectRef))


def _printed(printed: Node, place: str, page: int | None, table_page: int | None) -> Iterator[PrintedIndex]:
    pair = printed.read("index", lambda text: numbers(text, (10, 16)))
    if pair:
        hexadecimal = pair[1].first if len(pair) > 1 else None
        yield PrintedIndex(f"chapter {place}", pair[0].first, hexadecimal, page, printed.at("index"))
    row = printed.read("table", attributes)
    if row:
        yield PrintedIndex(f"table {place}", row.decimal, row.hexadecimal, table_page, printed.at("table"))


def _attributes(printed: Node, page: int | None) -> AttributeRow | None:
    row = printed.read("table", attributes)
    if row is None:
        return None
    return AttributeRow(
        row.structure,
        row.count,
        row.type_name,
        row.factor,
        row.access,
        optional_text(printed, "table_name"),
        page,
        printed.at("table"),
    )


class ErrataIndex:
    """Ids of ledger entries by what they concern."""

    def __init__(self, entries: Mapping[str, tuple[CodeRef | ObjectRef | ErrorRef | str, ...]]) -> None:
        """Index ``entries``, subjects by erratum id."""
        self._ids: dict[object, list[str]] = {}
        for erratum, subjects in entries.items():
            for subject in subjects:
                self._note(subject, erratum)

    def _note(self, subject: CodeRef | ObjectRef | ErrorRef | str, erratum: str) -> None:
        keys: list[object] = [subject]
        if isinstance(subject, CodeRef) and subject.subcode is not None:
            keys.append(CodeRef(subject.number))
        if isinstance(subject, ObjectRef) and subject.subindex is not None:
            keys.append(ObjectRef(subject.index))
        for key in keys:
            ids = self._ids.setdefault(key, [])
            if erratum not in ids:
                ids.append(erratum)

    def of(self, subject: CodeRef | ObjectRef | ErrorRef | str) -> tuple[str, ...]:
        """Ids of the entries that concern a subject, or a part of it, in the order of the ledger."""
        return tuple(self._ids.get(subject, ()))
