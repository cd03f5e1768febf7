"""LEDs and DIP switches as entries of the reference."""

from collections.abc import Iterator, Sequence

from generator.emit.html.blocks import Anchor, Bullets, Entry, Fact, Group, Row, Table
from generator.emit.html.lamps import lamp
from generator.emit.html.links import Links
from generator.emit.html.notes import named_subject, notes
from generator.emit.html.places import named_id, switch_row_id
from generator.emit.html.text import NONE, Piece, Prose, between, joined, noted, shown_origin
from generator.emit.switches import stand
from generator.model import IndicatorRow, IndicatorTable, Origin, SwitchGroup, SwitchRow

_LED_OVERVIEW = ("LEDs", "Name", "Rows")
_SWITCH_OVERVIEW = ("Switches", "Name", "Positions")
_POSITIONS = {"1": "ON", "0": "off", "x": "either"}
_ROWS_A_COLUMN = 32
"""Longer lists of positions are set in several columns of that height."""


def led_group(links: Links, tables: Sequence[IndicatorTable]) -> Group:
    """LED tables below one heading."""
    rows = tuple(Row((links.anchored(_led_anchor(table)), table.name, str(len(table.rows)))) for table in tables)
    entries = tuple(led_entry(links, table) for table in tables)
    return Group("leds-all", "LED tables", Table("overview", _LED_OVERVIEW, rows), entries)


def _led_anchor(table: IndicatorTable) -> Anchor:
    return Anchor(named_id("led", table.id), ", ".join(led.label for led in table.leds))


def led_entry(links: Links, table: IndicatorTable) -> Entry:
    """Entry for LEDs that are read together."""
    with_sources = any(row.cite != table.cite or row.origin is not Origin.MANUAL for row in table.rows)
    head = (
        *(f"{led.label} ({led.colour})" for led in table.leds),
        "State",
        "Meaning",
        *(["Source"] if with_sources else []),
    )
    rows = tuple(_led_row(links, table, number, row, with_sources) for number, row in enumerate(table.rows, 1))
    return Entry(
        kind="leds",
        anchors=(_led_anchor(table),),
        name=table.name,
        marks=(),
        lead="",
        facts=(
            *(Fact(f"LED {led.label}", noted(led.colour, led.name)) for led in table.leds),
            Fact("Source", links.source(table.cite)),
        ),
        tables=(Table("lamps", head, rows),),
        notes=notes(links, [named_subject(table.errata)]),
    )


def _led_row(links: Links, table: IndicatorTable, number: int, row: IndicatorRow, with_source: bool) -> Row:
    lamps = (lamp(led, pattern) for led, pattern in zip(table.leds, row.patterns, strict=True))
    source = _row_source(links, row) if with_source else ()
    anchor = named_id("led", table.id, str(number))
    state = (Piece(row.state, f"#{anchor}"),)
    cells = (*lamps, state, links.prose(row.meaning) or NONE, *([source] if source else []))
    return Row(cells, id=anchor)


def _row_source(links: Links, row: IndicatorRow) -> Prose:
    mark = shown_origin(row.origin)
    return (*links.source(row.cite), " ", Piece(mark, tag="em")) if mark else links.source(row.cite)


def switch_group(links: Links, groups: Sequence[SwitchGroup]) -> Group:
    """Groups of switches below one heading."""
    rows = tuple(Row((links.anchored(_switch_anchor(group)), group.name, str(len(group.rows)))) for group in groups)
    entries = tuple(switch_entry(links, group) for group in groups)
    return Group("switches-all", "Groups of switches", Table("overview", _SWITCH_OVERVIEW, rows), entries)


def _switch_anchor(group: SwitchGroup) -> Anchor:
    return Anchor(named_id("switch", group.id), group.id)


def switch_entry(links: Links, group: SwitchGroup) -> Entry:
    """Entry for switches that set one thing."""
    origin = shown_origin(group.origin)
    remarks = Bullets("Notes", tuple(map(links.prose, group.notes)))
    return Entry(
        kind="switch",
        anchors=(_switch_anchor(group),),
        name=group.name,
        marks=(origin,) if origin else (),
        lead="",
        facts=tuple(_switch_facts(links, group)),
        tables=(),
        columns=tuple(_positions(links, group)),
        bullets=(remarks,) if remarks.items else (),
        notes=notes(links, [named_subject(group.errata)]),
    )


def _switch_facts(links: Links, group: SwitchGroup) -> Iterator[Fact]:
    yield Fact("Switches", ", ".join(group.labels))
    if group.weights:
        yield Fact("Weights", noted(", ".join(map(str, group.weights)), "value = sum of those that are ON"))
    if group.valid is not None:
        yield Fact("Valid", noted(between(*map(str, group.valid)), group.unit))
    elif group.unit:
        yield Fact("Unit", group.unit)
    if group.sets:
        yield Fact("Held in", links.codes(group.sets))
    if group.block is not None:
        yield Fact("Block", (group.block.label, " ", *links.source(group.block.cite)))
    if group.delivered is not None:
        yield Fact("As delivered", (stand(group, group.delivered.positions), " ", *links.source(group.delivered.cite)))
    if group.code_counts is not None:
        when = " or ".join(stand(group, positions) for positions in group.code_counts.positions)
        codes = joined([(links.code(ref),) for ref in group.code_counts.codes], " / ")
        yield Fact("A code counts", (*codes, f" where the switches are {when} ", *links.source(group.code_counts.cite)))
    special = [row for row in group.rows if not row.value.isdecimal()]
    if special and len(special) < len(group.rows):
        yield Fact("Special positions", joined([_special(links, group, row) for row in special], "; "))
    yield Fact("Source", links.source(group.cite))


def _special(links: Links, group: SwitchGroup, row: SwitchRow) -> Prose:
    meaning = links.prose(row.value)
    pieces = (meaning,) if isinstance(meaning, str) else meaning
    return (*pieces, ": ", Piece(" ".join(map(_position, row.positions)), f"#{switch_row_id(group, row)}"))


def _position(sign: str) -> str:
    return _POSITIONS.get(sign, sign)


def _positions(links: Links, group: SwitchGroup) -> Iterator[Table]:
    """Every printed row, in as many tables as stand side by side."""
    head = (f"Value [{group.unit}]" if group.unit else "Value", *group.labels)
    rows = [_switch_row(links, group, row) for row in group.rows]
    for start in range(0, len(rows), _ROWS_A_COLUMN):
        yield Table("positions", head, tuple(rows[start : start + _ROWS_A_COLUMN]))


def _switch_row(links: Links, group: SwitchGroup, row: SwitchRow) -> Row:
    cells = ((Piece(_position(sign), tag="b"),) if sign == "1" else _position(sign) for sign in row.positions)
    return Row((links.prose(row.value), *cells), id=switch_row_id(group, row))
