"""Sources of facts, and what standards define."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from generator.elaborate.common import OBJECT_TYPES, default, known_manual, optional_text, run, runs, unique
from generator.model import Chapter, CobId, Manual, ObjectRef, StandardObject, StandardSubIndex
from generator.model.gsd import DpTelegrams
from generator.model.table import Connector, Contact
from generator.notation import HIGHEST_SUBINDEX, references
from generator.tree import Node, SourceFile


def manual(file: SourceFile) -> Manual:
    """A manual of spec/manuals."""
    root = file.root
    if root.get("id") != file.stem:
        root.problems.add(
            "folder-name",
            root.at("id"),
            f"the manual '{root.get('id')}' stands in {file.stem}.yaml",
            hint=f"rename the file to {root.get('id')}.yaml",
        )
    return Manual(
        id=str(root.get("id")),
        title=str(root.get("title")),
        publisher=str(root.get("publisher")),
        edition=str(root.get("edition")),
        date=optional_text(root, "date"),
        document=optional_text(root, "document"),
        kind=str(root.get("kind")),
        url=optional_text(root, "url"),
        pages=root.get("pages"),
        chapters=tuple(
            Chapter(
                number=str(node.get("chapter")),
                title=str(node.get("title")),
                page=node.get("page"),
                status=node.get("status"),
                note=optional_text(node, "note"),
                where=node.where,
            )
            for node in unique(root, "chapters", "chapter")
        ),
        where=root.where,
    )


NO_ADDRESSES = range(0)
"""Node addresses where no standard gives them."""


@dataclass(frozen=True, slots=True)
class Standards:
    """What the standards define: objects, node addresses, connection set, telegrams of PROFIBUS DP, connectors."""

    objects: tuple[StandardObject, ...]
    node_addresses: range
    cob_ids: tuple[CobId, ...]
    telegrams: tuple[DpTelegrams, ...]
    connectors: tuple[Connector, ...]


def standards(files: Iterable[SourceFile], manuals: Mapping[str, Manual]) -> Standards:
    """What the files of spec/standards define together."""
    files = list(files)
    found = [_standard(file, manuals) for file in files]
    seen: dict[str, Connector] = {}
    for file, one in zip(files, found, strict=True):
        for connector in one.connectors:
            first = seen.setdefault(connector.id, connector)
            if first is not connector:
                message = f"the connector '{connector.id}' is defined twice"
                file.root.problems.add("duplicate", connector.where, message, other=("first", first.where))
    return Standards(
        tuple(entry for one in found for entry in one.objects),
        next((one.node_addresses for one in found if one.node_addresses), NO_ADDRESSES),
        tuple(entry for one in found for entry in one.cob_ids),
        tuple(entry for one in found for entry in one.telegrams),
        tuple(entry for one in found for entry in one.connectors),
    )


def _standard(file: SourceFile, manuals: Mapping[str, Manual]) -> Standards:
    root = file.root
    known_manual(file.manual, root, "manual", manuals)
    objects = tuple(_object(node) for node in root.items("objects"))
    cob_ids = tuple(
        CobId(
            name=str(node.get("name")),
            title=str(node.get("title")),
            base=int(node.get("base")),
            broadcast=bool(node.get("broadcast")),
            objects=tuple(
                i for refs in node.read("objects", references) or () for i in refs.items if isinstance(i, ObjectRef)
            ),
            cite=node.cite(),
            where=node.where,
        )
        for node in root.items("cob_ids")
    )
    telegrams = root.child("profibus_dp")
    connectors = tuple(_connector(node) for node in unique(root, "connectors"))
    return Standards(
        objects,
        _node_addresses(root.child("node_addresses")),
        cob_ids,
        (_telegrams(telegrams),) if telegrams else (),
        connectors,
    )


def _node_addresses(node: Node | None) -> range:
    bounds = run(node, "run") if node else None
    if node is None or bounds is None:
        return NO_ADDRESSES
    node.cite()
    return range(bounds[0], bounds[1] + 1)


def _connector(node: Node) -> Connector:
    return Connector(
        id=str(node.get("id")),
        name=str(node.get("name")),
        seen=str(node.get("seen")),
        form=str(node.get("form")),
        contacts=tuple(Contact(int(number), *place) for number, place in node.get("contacts").items()),
        outline=tuple((right, down) for right, down in node.get("outline")),
        cite=node.cite(),
        where=node.at("id"),
    )


def _telegrams(node: Node) -> DpTelegrams:
    return DpTelegrams(
        lengths=tuple((keyword, int(length)) for keyword, length in node.get("lengths").items()),
        identifier=int(node.get("identifier")),
        dpv1_parameters=int(node.get("dpv1_parameters")),
        status_type=int(node.get("status_type")),
        cite=node.cite(),
        where=node.where,
    )


def _object(node: Node) -> StandardObject:
    first, last = object_run(node)
    subs = node.child("subindexes")
    return StandardObject(
        first=first,
        last=last,
        name=str(node.get("name")),
        object_type=str(node.get("object_type")),
        category=str(node.get("category")),
        subindexes=tuple(_subindexes(subs)) if subs else (),
        cite=node.cite(),
        where=node.where,
    )


def _subindexes(subs: Node) -> list[StandardSubIndex]:
    found = []
    for key, low, high in runs(subs, HIGHEST_SUBINDEX):
        node = subs.child(key)
        assert node is not None
        data_type = OBJECT_TYPES[str(node.get("type"))]
        found.append(
            StandardSubIndex(
                first=low,
                last=high,
                name=str(node.get("name")),
                data_type=data_type,
                access=node.texts("access"),
                default=default(node, "default", node.get("default"), data_type.is_number),
                pdo_mapping=bool(node.get("pdo_mapping", False)),
                mandatory=bool(node.get("mandatory", False)),
            )
        )
    return found


def object_run(node: Node) -> tuple[int, int]:
    """First and last index of an object entry ("I-1000", "I-1400 ... I-1403", "P-918"); (0, 0) for a wrong one."""
    found = node.read("index", references) or ()
    for each in found:
        if each.open_run is not None:
            low, high = each.open_run
            if isinstance(low, ObjectRef) and isinstance(high, ObjectRef) and low.index <= high.index:
                return low.index, high.index
            node.problems.add(
                "run-order", node.at("index"), "the run does not ascend", hint="write the lower index first"
            )
        elif each.items and isinstance(each.items[0], ObjectRef):
            return each.items[0].index, each.items[0].index
    return 0, 0
