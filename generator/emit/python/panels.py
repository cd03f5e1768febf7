"""Rows of LEDs, switches and printed tables, in the order in which ``catalogue.py.j2`` reads them."""

from fractions import Fraction

from generator.emit.python.rows import cite_row, tuple_table
from generator.emit.python.text import Literal, fill
from generator.emit.python.views import RowView, TableView
from generator.emit.switches import remarks
from generator.model import Device, IndicatorRow, IndicatorTable, Model, Pattern, SwitchGroup, Table


def panel_tables(device: Device) -> tuple[TableView, ...]:
    """The tables of a device's module of rows."""
    return (
        tuple_table("INDICATORS", map(_indicator, device.indicators)),
        tuple_table("SWITCHES", map(_switch, device.switches)),
        tuple_table("TABLES", map(_table, device.tables)),
    )


def colours(model: Model) -> tuple[str, ...]:
    """Every colour of an LED, sorted; an LED of two has "red/green"."""
    tables = [table for device in model.devices for table in device.indicators]
    found = {led.colour for table in tables for led in table.leds}
    found |= {pattern.colour for table in tables for row in table.rows for pattern in row.patterns if pattern.colour}
    return tuple(sorted(found | {colour for each in found for colour in each.split("/")}))


def _indicator(table: IndicatorTable) -> RowView:
    leds = tuple((led.label, led.colour, led.name) for led in table.leds)
    rows = tuple(_indicator_row(row) for row in table.rows)
    return RowView("", fill((table.id, table.name, leds, rows, cite_row(table.cite), table.errata)))


def _indicator_row(row: IndicatorRow) -> Literal:
    return tuple(map(_pattern, row.patterns)), row.state, row.meaning, row.origin.value, cite_row(row.cite)


def _pattern(pattern: Pattern) -> Literal:
    return pattern.light.value, pattern.colour, _seconds(pattern.period), pattern.flashes, _seconds(pattern.pause)


def _seconds(seconds: Fraction | None) -> Literal:
    return None if seconds is None else (seconds.numerator, seconds.denominator)


def _switch(group: SwitchGroup) -> RowView:
    row = (
        group.id,
        group.name,
        group.labels,
        group.weights,
        group.valid,
        group.unit,
        tuple((ref.number, ref.subcode) for ref in group.sets),
        tuple((int(row.value) if row.value.isdecimal() else row.value, row.positions) for row in group.rows),
        remarks(group),
        group.origin.value,
        cite_row(group.cite),
        group.errata,
    )
    return RowView("", fill(row))


def _table(table: Table) -> RowView:
    row = (
        table.id,
        table.kind,
        table.name,
        tuple((column.id, column.name, column.unit) for column in table.columns),
        table.rows,
        table.notes,
        table.origin.value,
        cite_row(table.cite),
        table.errata,
    )
    return RowView("", fill(row))
