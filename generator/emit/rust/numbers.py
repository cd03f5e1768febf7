"""Numbers that the manual lists in tables of their own: states, commands, data types."""

from generator.emit.rust import lists, words
from generator.emit.rust.syntax import doc, string, type_name
from generator.emit.rust.views import Selection, Variant
from generator.model import Device, Option, Table
from generator.naming import Scope

_KINDS = frozenset({"data-type", "nmt-command", "nmt-state"})


def numbered(device: Device) -> list[Selection]:
    """An enum for each table of such a kind that gives each of its names a number.

    Raises:
        EmitError: Two tables or rows want one name.
    """
    scope = Scope(f"numbers of {device.id}")
    return [
        _selection(scope.add(type_name(table.id), table.where), table, options)
        for table in device.tables
        if table.kind in _KINDS and (options := table_options(table))
    ]


def table_options(table: Table) -> tuple[Option, ...]:
    """Rows as a selection list, () where no column holds a number for each row or no other one a name.

    The numbers stand in the first column of distinct numbers without a unit, the names in the first of distinct texts.
    """
    cells = list(zip(*table.rows, strict=True))
    read = [[_number(cell) for cell in column] for column in cells]
    values = [
        [number for number in numbers if number is not None]
        for column, numbers in zip(table.columns, read, strict=True)
        if not column.unit and None not in numbers and len(set(numbers)) == len(numbers)
    ]
    labels = [
        [str(cell) for cell in column]
        for column, numbers in zip(cells, read, strict=True)
        if numbers == [None] * len(column) and "-" not in column and len(set(column)) == len(column)
    ]
    return tuple(map(Option, values[0], labels[0])) if values and labels else ()


def _number(cell: int | str) -> int | None:
    if isinstance(cell, int):
        return cell if cell >= 0 else None
    return int(cell, 16) if cell.startswith("0x") else None


def _selection(name: str, table: Table, options: tuple[Option, ...]) -> Selection:
    width = next(width for width in (8, 16, 32) if max(option.value for option in options) < 1 << width)
    variants = zip(lists.variants(options, name, table.where), options, strict=True)
    return Selection(
        name,
        doc([words.headline(table.name)], [words.source(table.cite, table.origin)], indent=4),
        f"u{width}",
        tuple(
            Variant(
                doc([words.headline(f"{option.value}: {option.label}")], indent=8),
                variant,
                str(option.value),
                string(option.label),
            )
            for variant, option in variants
        ),
    )
