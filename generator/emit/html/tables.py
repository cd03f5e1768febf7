"""Other tables and formulas as entries of the reference."""

from collections.abc import Iterator, Sequence

from generator.emit.html.blocks import Anchor, Bullets, Drawing, Entry, Fact, Group, Row, Table
from generator.emit.html.connectors import drawing
from generator.emit.html.links import Links
from generator.emit.html.notes import named_subject, notes
from generator.emit.html.places import named_id
from generator.emit.html.text import NONE, Piece, Prose, shown_origin
from generator.emit.html.topics import by_topic, title_of
from generator.model import Column, Formula
from generator.model import Table as PrintedTable
from generator.model.table import NOTHING_PRINTED

_OVERVIEW = ("Table", "Name", "Of", "Rows")
_FORMULAS = ("Formula", "Name", "Expression")


def table_groups(links: Links, tables: Sequence[PrintedTable]) -> Iterator[Group]:
    """Tables by topic."""
    for topic, found in by_topic(tables).items():
        rows = tuple(Row((links.anchored(_table_anchor(t)), t.name, _kind(t), str(len(t.rows)))) for t in found)
        entries = tuple(table_entry(links, table) for table in found)
        yield Group(f"tables-{topic}", title_of(topic), Table("overview", _OVERVIEW, rows), entries)


def _kind(table: PrintedTable) -> str:
    return table.kind.replace("-", " ")


def _table_anchor(table: PrintedTable) -> Anchor:
    return Anchor(named_id("table", table.id), table.id)


def table_entry(links: Links, table: PrintedTable) -> Entry:
    """Entry for a table."""
    origin = shown_origin(table.origin)
    remarks = Bullets("Notes", tuple(map(links.prose, table.notes)))
    return Entry(
        kind="table",
        anchors=(_table_anchor(table),),
        name=table.name,
        marks=(origin,) if origin else (),
        lead="",
        facts=(Fact("Table of", _kind(table)), Fact("Source", links.source(table.cite))),
        drawing=drawn(links, table),
        tables=(printed_table(links, table),),
        bullets=(remarks,) if remarks.items else (),
        notes=notes(links, [named_subject(table.errata)]),
    )


def drawn(links: Links, table: PrintedTable) -> Drawing | None:
    """The connector that the table assigns, ``None`` where no standard knows its shape."""
    return drawing(links, table.assignment) if table.assignment else None


def printed_table(links: Links, table: PrintedTable, anchored: bool = True) -> Table:
    """The columns and rows of a table; ``anchored``: its rows have their anchors here."""
    ids = (named_id("table", table.id, str(number)) if anchored else "" for number in range(1, len(table.rows) + 1))
    rows = (
        Row(tuple(_cell(links, cell) for cell in cells), id=row) for cells, row in zip(table.rows, ids, strict=True)
    )
    return Table("printed", tuple(map(_heading, table.columns)), tuple(rows))


def _heading(column: Column) -> str:
    return f"{column.name} [{column.unit}]" if column.unit else column.name


def _cell(links: Links, cell: int | str) -> Prose:
    if isinstance(cell, int):
        return str(cell)
    return NONE if cell == NOTHING_PRINTED else links.prose(cell)


def formula_group(links: Links, formulas: Sequence[Formula]) -> Group:
    """Formulas below one heading."""
    rows = tuple(Row((links.anchored(_formula_anchor(f)), f.name, f.expression)) for f in formulas)
    entries = tuple(formula_entry(links, formula) for formula in formulas)
    return Group("formulas-all", "All formulas", Table("overview", _FORMULAS, rows), entries)


def _formula_anchor(formula: Formula) -> Anchor:
    return Anchor(named_id("formula", formula.id), formula.id)


def formula_entry(links: Links, formula: Formula) -> Entry:
    """Entry for a formula."""
    return Entry(
        kind="formula",
        anchors=(_formula_anchor(formula),),
        name=formula.name,
        marks=(),
        lead=links.prose(formula.note),
        facts=tuple(_formula_facts(links, formula)),
        tables=(_examples(links, formula),) if formula.examples else (),
        notes=notes(links, [named_subject(formula.errata)]),
    )


def _formula_facts(links: Links, formula: Formula) -> Iterator[Fact]:
    yield Fact("Expression", (Piece(formula.expression, tag="code"),))
    if formula.unit:
        yield Fact("Unit", formula.unit)
    yield Fact("Source", links.source(formula.cite))


def _examples(links: Links, formula: Formula) -> Table:
    """Worked examples, a column for each name that any of them gives."""
    names = tuple(dict.fromkeys(name for example in formula.examples for name, _ in example.values))
    result = f"Result [{formula.unit}]" if formula.unit else "Result"
    rows = []
    for number, example in enumerate(formula.examples, 1):
        given = {name: str(value) for name, value in example.values}
        cells = (str(number), *(given.get(name, NONE) for name in names), str(example.result))
        row_id = named_id("formula", formula.id, str(number))
        rows.append(Row((*cells, links.source(example.cite)), id=row_id))
    return Table("worked", ("Example", *names, result, "Source"), tuple(rows), "Worked examples")
