"""Services of a device: layouts, labels, tables and identifiers found by their names."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from generator.diagnostics import suggestion
from generator.elaborate.codes import ErrataIndex
from generator.elaborate.common import optional_text, origin, unique
from generator.load import Map, Seq
from generator.model import (
    Choice,
    CobId,
    Does,
    Field,
    FieldType,
    Filling,
    Fillings,
    Layout,
    Message,
    Option,
    Service,
    Table,
)
from generator.notation import filler
from generator.tree import Node

_OTHERS = "else"
_TABLE = "table"
_NUMBER_COLUMN = "id"
_TYPE_COLUMN = "type"


class Frame:
    """What the names in services of one device stand for."""

    def __init__(
        self, layouts: Sequence[Layout], tables: Sequence[Table], cob_ids: Sequence[CobId], errata: ErrataIndex
    ) -> None:
        """Take in the device's layouts and tables, the predefined connection set and the ledger."""
        self.layouts = {layout.id: layout for layout in layouts}
        self.types = {table.id: cases for table in tables if (cases := _typed(table))}
        self.identifiers = [cob_id.name for cob_id in cob_ids]
        self.errata = errata


def _typed(table: Table) -> tuple[tuple[str, int], ...]:
    """Numbers by data type of a table that has the columns for both; of any other nothing."""
    columns = [column.id for column in table.columns]
    if not {_NUMBER_COLUMN, _TYPE_COLUMN} <= set(columns):
        return ()
    number, name = columns.index(_NUMBER_COLUMN), columns.index(_TYPE_COLUMN)
    return tuple((str(row[name]), value) for row in table.rows if isinstance(value := row[number], int))


@dataclass(frozen=True, slots=True)
class _Target:
    """What a filling is for: labels of its values; ``literal`` where a text stands for itself.

    ``fields``: of a group, the fields of a repetition.
    """

    labels: Mapping[str, int]
    literal: bool
    fields: tuple[Field, ...] = ()


_LAYOUT = _Target({}, literal=True)


def services(root: Node, frame: Frame) -> tuple[Service, ...]:
    """Services of a device's telegrams.yaml."""
    return tuple(_service(node, frame) for node in unique(root, "services"))


def _service(node: Node, frame: Frame) -> Service:
    return Service(
        id=str(node.get("id")),
        name=str(node.get("name")),
        does=Does(node.get("does")),
        reaches=node.texts("reaches"),
        request=_message(node.child("request"), frame),
        answer=_message(node.child("answer"), frame),
        errors=optional_text(node, "errors"),
        limit=node.get("limit"),
        description=str(node.get("description", "")).strip(),
        origin=origin(node),
        cite=node.cite(),
        errata=frame.errata.of(f"service:{node.get('id')}"),
        where=node.at("id"),
    )


def _message(node: Node | None, frame: Frame) -> Message | None:
    if node is None:
        return None
    identifier = optional_text(node, "identifier")
    if identifier is not None and identifier not in frame.identifiers:
        hint = suggestion(identifier, frame.identifiers, "identifiers")
        node.problems.add("name-unknown", node.at("identifier"), f"there is no identifier '{identifier}'", hint=hint)
    layout = _filling(node, "layout", _LAYOUT, frame)
    assert isinstance(layout, str | Choice)
    names = [layout] if isinstance(layout, str) else [str(name) for _, name in layout.cases]
    for name in names:
        if name not in frame.layouts:
            hint = suggestion(name, list(frame.layouts), "layouts")
            node.problems.add("name-unknown", node.at("layout"), f"there is no layout '{name}'", hint=hint)
    fields = tuple(field for name in names if name in frame.layouts for field in frame.layouts[name].fields)
    values = node.child("values")
    return Message(
        identifier=identifier, layout=layout, values=_fillings(values, fields, frame) if values and fields else ()
    )


def _fillings(node: Node, fields: Sequence[Field], frame: Frame) -> Fillings:
    targets = dict(_targets(fields))
    found: list[tuple[str, Filling]] = []
    for key in node.data:
        if key not in targets:
            hint = suggestion(key, list(targets), "fields")
            node.problems.add("name-unknown", node.at_key(key), f"the layout has no field '{key}'", hint=hint)
            continue
        found.append((key, _filling(node, key, targets[key], frame)))
    return tuple(found)


def _targets(fields: Sequence[Field]) -> list[tuple[str, _Target]]:
    found: list[tuple[str, _Target]] = []
    for field in fields:
        literal = field.type in (FieldType.TEXT, FieldType.BYTES)
        found.append((field.name, _Target(_labels(field.values), literal, field.fields)))
        parts = dict(field.bit_values)
        found += [
            (f"{field.name}.{part.label}", _Target(_labels(parts.get(part.label, ())), literal=False))
            for part in field.bits
        ]
    return found


def _labels(options: Sequence[Option]) -> Mapping[str, int]:
    return {option.label: option.value for option in options}


def _filling(node: Node, key: str, target: _Target, frame: Frame) -> Filling:
    value = node.get(key)
    if isinstance(value, Seq):
        return tuple(_fillings(item, target.fields, frame) for item in node.items(key))
    if isinstance(value, Map):
        child = node.child(key)
        assert child is not None
        return _choice(child, target, frame)
    if isinstance(value, int):
        return value
    text = str(value)
    if text.startswith("$"):
        found = node.read(key, filler)
        return text if found is None else found
    if target.literal:
        return text
    if text not in target.labels:
        hint = suggestion(text, list(target.labels), "labels")
        node.problems.add("name-unknown", node.at(key), f"no value is called '{text}'", hint=hint)
    return target.labels.get(text, 0)


def _choice(node: Node, target: _Target, frame: Frame) -> Choice:
    if _TABLE in node:
        name = str(node.get(_TABLE))
        if name not in frame.types:
            hint = suggestion(name, list(frame.types), "tables of data types")
            node.problems.add("name-unknown", node.at(_TABLE), f"there is no table of data types '{name}'", hint=hint)
        return Choice(frame.types.get(name, ()), None)
    cases = tuple((key, _filling(node, key, target, frame)) for key in node.data if key != _OTHERS)
    return Choice(cases, _filling(node, _OTHERS, target, frame) if _OTHERS in node else None)
