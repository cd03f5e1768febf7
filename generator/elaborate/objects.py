"""Objects: runs expanded, types and accesses of the standard taken where the standard defines them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from generator.elaborate.codes import ErrataIndex
from generator.elaborate.common import OBJECT_TYPES, bits, default, fields, fill, options, origin, runs
from generator.elaborate.manuals import object_run
from generator.model import (
    Cite,
    CodeRef,
    DataType,
    DictionaryObject,
    ObjectRef,
    Range,
    Slot,
    StandardObject,
    StandardSubIndex,
    SubIndex,
)
from generator.notation import HIGHEST_SUBINDEX, references, value_range
from generator.tree import Node

PROFIDRIVE = "P-"
_LONGEST_RUN = 512


@dataclass(frozen=True, slots=True)
class Frame:
    """What an object needs to know: the standard, the slots of the device, the ledger."""

    standard: Sequence[StandardObject]
    slots: Sequence[Slot]
    errata: ErrataIndex


def objects(root: Node, frame: Frame) -> tuple[DictionaryObject, ...]:
    """Objects of a device's objects.yaml, by index."""
    found: dict[tuple[str, int], DictionaryObject] = {}
    for node in root.items("objects"):
        for entry in _expand(node, frame):
            key = (entry.kind, entry.index)
            if key in found:
                node.problems.add(
                    "duplicate",
                    node.at("index"),
                    f"{entry.designation} is written twice",
                    other=("first", found[key].where),
                )
            found.setdefault(key, entry)
    return tuple(found[key] for key in sorted(found))


def _expand(node: Node, frame: Frame) -> Iterator[DictionaryObject]:
    first, last = object_run(node)
    count = last - first + 1
    if count > _LONGEST_RUN:
        node.problems.add(
            "run-order",
            node.at("index"),
            f"the run has {count} objects, more than {_LONGEST_RUN}",
            hint="list the objects that the manual describes",
        )
        return
    for index in range(first, last + 1):
        place = index - first
        kind = "profidrive" if str(node.get("index")).startswith(PROFIDRIVE) else "canopen"
        defined = frame.standard if kind == "canopen" else ()
        known = next((s for s in defined if s.first <= index <= s.last), None)
        object_type = known.object_type if known else node.get("object_type")
        if object_type is None:
            node.problems.add(
                "standard-unknown",
                node.at("index"),
                f"{node.get('index')} is not an object of the standard",
                hint="say its type: 'object_type: VAR'",
            )
            object_type = "VAR"
        yield DictionaryObject(
            kind=kind,
            index=index,
            name=fill(str(node.get("name")), node, "name", {"n": place + 1}),
            object_type=str(object_type),
            standard=known,
            subindexes=tuple(_subindexes(node, ObjectRef(index), place, count, known, frame)),
            description=str(node.get("description", "")).strip(),
            origin=origin(node),
            cite=_cite(node, place, count),
            errata=frame.errata.of(ObjectRef(index)),
            where=node.at("index"),
        )


def _cite(node: Node, place: int, count: int) -> Cite:
    cites = node.get("cite")
    if isinstance(cites, str):
        return node.cite()
    return node.cites("cite")[place if _fits(node, "cite", cites, count) else 0]


def _fits(node: Node, key: str, values: Sequence[object], count: int) -> bool:
    if len(values) == count:
        return True
    problem = f"'{key}' lists {len(values)} items for {count} objects"
    if not any(d.where == node.at(key) and d.message == problem for d in node.problems.found):
        node.problems.add("list-length", node.at(key), problem, hint="give one item for each object of the run")
    return False


def _subindexes(
    node: Node, ref: ObjectRef, place: int, count: int, known: StandardObject | None, frame: Frame
) -> Iterator[SubIndex]:
    parent = node.child("subindexes")
    assert parent is not None
    for key, low, high in runs(parent, HIGHEST_SUBINDEX):
        child = parent.child(key)
        assert child is not None
        for number in range(low, high + 1):
            yield _subindex(child, ObjectRef(ref.index, number), place, count, known, frame)


def _subindex(
    node: Node, ref: ObjectRef, place: int, count: int, known: StandardObject | None, frame: Frame
) -> SubIndex:
    assert ref.subindex is not None
    values = {"n": place + 1, "k": ref.subindex}
    printed_type = OBJECT_TYPES[str(node.get("type"))]
    printed_access = str(node.get("access"))
    norm = known.subindex(ref.subindex) if known else None
    overview, detail = _codes(node, "codes", values), _codes(node, "detail_codes", values)
    mirrors = _codes(node, "mirrors", values) if "mirrors" in node else overview
    value = node.get("default")
    if isinstance(value, list):
        value = value[place] if _fits(node, "default", value, count) else None
    return SubIndex(
        number=ref.subindex,
        name=fill(str(node.get("name")), node, "name", values),
        data_type=norm.data_type if norm else printed_type,
        access=_access(norm, printed_access),
        printed_type=printed_type,
        printed_access=printed_access,
        default=default(node, "default", value, printed_type.is_number),
        range=_range(node, norm.data_type if norm else printed_type),
        options=options(node, "selection"),
        bits=bits(node),
        fields=fields(node),
        codes=tuple(dict.fromkeys(twin for ref in mirrors for twin in twins(ref, frame.slots))),
        printed_codes=(("overview", overview), ("detail", detail)) if detail else (("overview", overview),),
        signature=node.get("signature"),
        pdo_mapping=bool(node.get("pdo_mapping", norm.pdo_mapping if norm else False)),
        unused=bool(node.get("unused", False)),
        abort=node.get("abort"),
        description=str(node.get("description", "")).strip(),
        errata=frame.errata.of(ref),
        where=node.where,
    )


def twins(ref: CodeRef, slots: Sequence[Slot]) -> tuple[CodeRef, ...]:
    """The code that ``ref`` names in every slot; a code of no slot is its own only twin."""
    for slot in slots:
        if slot.first_code <= ref.number <= slot.last_code:
            first = ref.number - slot.code_offset
            return tuple(CodeRef(first + other.code_offset, ref.subcode) for other in slots)
    return (ref,)


def _access(norm: StandardSubIndex | None, printed: str) -> str:
    return printed if norm is None or printed in norm.access else norm.access[0]


def _range(node: Node, data_type: DataType) -> Range | None:
    return node.read("range", value_range) if data_type.is_number else None


def _codes(node: Node, key: str, values: dict[str, int]) -> tuple[CodeRef, ...]:
    if key not in node:
        return ()
    text = fill(str(node.get(key)), node, key, dict(values))
    found = node.read(key, references, text) or ()
    return tuple(item for run in found for item in run.items if isinstance(item, CodeRef))
