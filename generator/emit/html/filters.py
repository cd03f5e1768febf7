"""Filters of long tables: text, and a choice for each column that has few different values."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from generator.emit.html.blocks import Group, Table
from generator.emit.html.text import plain

SCRIPT = "filter.js"
"""Script that makes the controls work; without it they are not shown."""


@dataclass(frozen=True, slots=True)
class Choice:
    """A choice among the values of a column; ``column`` is its heading, "" where it is among the tables of the page."""

    name: str
    label: str
    column: str
    options: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Filter:
    """Controls over all overviews of a page; ``status`` says how many rows they have."""

    choices: tuple[Choice, ...]
    status: str


def filter_of(groups: Sequence[Group], columns: Iterable[str]) -> Filter:
    """Filter over the overviews of ``groups``; columns in which all rows say the same are left out."""
    tables = [group.overview for group in groups]
    titles = tuple(group.title for group in groups)
    choices = [Choice("list", "List", "", titles)]
    choices += [Choice(column.lower().replace(" ", "-"), column, column, _values(tables, column)) for column in columns]
    total = sum(len(table.rows) for table in tables)
    return Filter(tuple(choice for choice in choices if choice.options[1:]), f"{total} of {total}")


def _values(tables: Sequence[Table], column: str) -> tuple[str, ...]:
    """Values of a column in the order of the alphabet."""
    found: set[str] = set()
    for table in tables:
        if column in table.head:
            place = table.head.index(column)
            found |= {plain(row.cells[place]) for row in table.rows}
    return tuple(sorted(found, key=str.casefold))
