"""LEDs, DIP switches, tables and formulas."""

from collections.abc import Sequence

from generator.diagnostics import suggestion
from generator.elaborate.codes import ErrataIndex
from generator.elaborate.common import origin, run, unique
from generator.model import (
    CodeCounts,
    CodeRef,
    Column,
    Delivered,
    Formula,
    FormulaExample,
    IndicatorRow,
    IndicatorTable,
    Led,
    Pattern,
    SwitchBlock,
    SwitchGroup,
    SwitchRow,
    Table,
)
from generator.model.indicator import Light
from generator.model.table import Assignment, Connector
from generator.notation import formula, pattern, references
from generator.tree import Node


def indicators(root: Node, errata: ErrataIndex) -> tuple[IndicatorTable, ...]:
    """LED tables of a device's indicators.yaml."""
    return tuple(_indicator(node, errata) for node in unique(root, "tables"))


def _indicator(node: Node, errata: ErrataIndex) -> IndicatorTable:
    leds = tuple(Led(label, str(led.get("colour")), str(led.get("name", ""))) for label, led in node.children("leds"))
    return IndicatorTable(
        id=str(node.get("id")),
        name=str(node.get("name")),
        leds=leds,
        rows=tuple(_row(row, node, leds) for row in node.items("rows")),
        cite=node.cite(),
        errata=errata.of(f"led:{node.get('id')}"),
        where=node.at("id"),
    )


def _row(row: Node, table: Node, leds: tuple[Led, ...]) -> IndicatorRow:
    patterns = row.child("patterns")
    assert patterns is not None
    labels = [led.label for led in leds]
    for label in patterns.data:
        if label not in labels:
            row.problems.add(
                "name-unknown",
                patterns.at_key(label),
                f"the table has no LED '{label}'",
                hint=f"LEDs of the table: {', '.join(labels)}",
            )
    return IndicatorRow(
        patterns=tuple(patterns.read(label, pattern) or Pattern(Light.ANY) for label in labels),
        state=str(row.get("state")),
        meaning=str(row.get("meaning", "")).strip(),
        origin=origin(row),
        cite=row.cite() if "cite" in row else table.cite(),
        where=row.where,
    )


def switches(root: Node, errata: ErrataIndex) -> tuple[SwitchGroup, ...]:
    """DIP switches of a device's switches.yaml."""
    return tuple(_switch(node, errata) for node in unique(root, "switches"))


def _switch(node: Node, errata: ErrataIndex) -> SwitchGroup:
    labels = node.texts("labels")
    rows = node.child("rows")
    assert rows is not None
    for value, positions in rows.data.items():
        _positions(rows, value, str(positions), len(labels))
    weights = tuple(node.get("weights", ()))
    if weights and len(weights) != len(labels):
        node.problems.add("list-length", node.at("weights"), f"{len(weights)} weights for {len(labels)} switches")
        weights = ()
    return SwitchGroup(
        id=str(node.get("id")),
        name=str(node.get("name")),
        labels=labels,
        weights=weights,
        valid=run(node, "valid"),
        unit=str(node.get("unit", "")),
        sets=_codes(node, "sets"),
        block=_block(node.child("block")),
        delivered=_delivered(node.child("delivered"), len(labels)),
        code_counts=_code_counts(node.child("code_counts"), len(labels)),
        rows=tuple(SwitchRow(value=v, positions=str(p), where=rows.at(v)) for v, p in rows.data.items()),
        notes=tuple(text.strip() for text in node.texts("notes")),
        origin=origin(node),
        cite=node.cite(),
        errata=errata.of(f"switch:{node.get('id')}"),
        where=node.at("id"),
    )


def _positions(node: Node, key: str, positions: str, switches: int) -> str:
    """Positions that stand below a key; noted where they are not one for each switch."""
    if len(positions) != switches:
        node.problems.add(
            "list-length",
            node.at(key),
            f"{len(positions)} positions for {switches} switches",
            hint="give one of 0, 1 and x for each switch",
        )
    return positions


def _codes(node: Node, key: str) -> tuple[CodeRef, ...]:
    return tuple(i for run in node.read(key, references) or () for i in run.items if isinstance(i, CodeRef))


def _block(node: Node | None) -> SwitchBlock | None:
    return SwitchBlock(str(node.get("label")), node.cite()) if node else None


def _delivered(node: Node | None, switches: int) -> Delivered | None:
    if node is None:
        return None
    return Delivered(_positions(node, "positions", str(node.get("positions")), switches), node.cite())


def _code_counts(node: Node | None, switches: int) -> CodeCounts | None:
    if node is None:
        return None
    positions = tuple(_positions(node, "positions", text, switches) for text in node.texts("positions"))
    return CodeCounts(positions, _codes(node, "code"), node.cite())


def tables(root: Node, errata: ErrataIndex, connectors: Sequence[Connector]) -> tuple[Table, ...]:
    """Tables of a device's tables.yaml; ``connectors`` are those that standards define."""
    return tuple(_table(node, errata, connectors) for node in unique(root, "tables"))


def _table(node: Node, errata: ErrataIndex, connectors: Sequence[Connector]) -> Table:
    columns = tuple(Column(str(c.get("id")), str(c.get("name")), str(c.get("unit", ""))) for c in node.items("columns"))
    rows = []
    for position, row in enumerate(node.get("rows", ())):
        if len(row) == len(columns):
            rows.append(row)
        else:
            node.problems.add(
                "list-length",
                node.at("rows"),
                f"row {position + 1} has {len(row)} cells for {len(columns)} columns",
                hint="give every column a cell, '-' for an empty one",
            )
    wiring = node.child("connector")
    return Table(
        id=str(node.get("id")),
        kind=str(node.get("kind")),
        name=str(node.get("name")),
        columns=columns,
        rows=tuple(tuple(row) for row in rows),
        assignment=_assignment(wiring, [column.id for column in columns], rows, connectors) if wiring else None,
        notes=tuple(text.strip() for text in node.texts("notes")),
        origin=origin(node),
        cite=node.cite(),
        errata=errata.of(f"table:{node.get('id')}"),
        where=node.at("id"),
    )


def _assignment(
    node: Node, columns: Sequence[str], rows: Sequence[Sequence[int | str]], connectors: Sequence[Connector]
) -> Assignment | None:
    known = {connector.id: connector for connector in connectors}
    named = {"shape": list(known), "pin": columns, "signal": columns}
    for key, legal in named.items():
        name = str(node.get(key))
        if name not in legal:
            what, several = ("connector", "connectors of standards") if key == "shape" else ("column", "columns")
            hint = suggestion(name, list(legal), several)
            node.problems.add("name-unknown", node.at(key), f"there is no {what} '{name}'", hint=hint)
            return None
    pin, signal = (columns.index(str(node.get(key))) for key in ("pin", "signal"))
    signals = tuple((row[pin], str(row[signal])) for row in rows)
    unused = node.texts("unused")
    for text in unused:
        printed = sorted({carried for _, carried in signals})
        if text not in printed:
            hint = suggestion(text, printed, "signals")
            node.problems.add("name-unknown", node.at("unused"), f"no contact carries '{text}'", hint=hint)
    return Assignment(known[str(node.get("shape"))], signals, unused)


def formulas(root: Node, errata: ErrataIndex) -> tuple[Formula, ...]:
    """Formulas of a device's tables.yaml."""
    found = []
    for node in unique(root, "formulas"):
        evaluate = node.read("expression", formula)
        if evaluate is None:
            continue
        found.append(
            Formula(
                id=str(node.get("id")),
                name=str(node.get("name")),
                expression=str(node.get("expression")),
                evaluate=evaluate,
                unit=str(node.get("unit", "")),
                note=str(node.get("note", "")).strip(),
                examples=tuple(
                    FormulaExample(
                        values=tuple(sorted((k, int(v)) for k, v in example.get("values").items())),
                        result=int(example.get("result")),
                        cite=example.cite(),
                        where=example.at("result"),
                    )
                    for example in node.items("examples")
                ),
                cite=node.cite(),
                errata=errata.of(f"formula:{node.get('id')}"),
                where=node.at("id"),
            )
        )
    return tuple(found)
