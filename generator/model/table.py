"""Tables and formulas that have no form of their own."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from generator.model.citation import Cite, Origin, Where

NOTHING_PRINTED = "-"
"""Where the manual prints a dash or nothing."""


@dataclass(frozen=True, slots=True)
class Column:
    """A column: stable name, heading, unit of its numbers ("" where none)."""

    id: str
    name: str
    unit: str


@dataclass(frozen=True, slots=True)
class Contact:
    """A contact by its number; ``right`` and ``down`` in half the distance of two contacts."""

    number: int
    right: int
    down: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Connector:
    """A connector as a standard arranges its contacts, ``seen`` from one side.

    ``form``: "pin", "hole" or "spring".  ``outline``: corners of the shell, (right, down) as of the contacts.
    """

    id: str
    name: str
    seen: str
    form: str
    contacts: tuple[Contact, ...]
    outline: tuple[tuple[int, int], ...]
    cite: Cite
    where: Where


@dataclass(frozen=True, slots=True)
class Assignment:
    """What the contacts of a connector carry, by number, as the table of an assignment prints it.

    ``unused``: what it prints, beside a dash, at contacts that carry nothing.
    """

    connector: Connector
    signals: tuple[tuple[int | str, str], ...]
    unused: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """A table as printed; ``kind`` as in ``tables.schema.yaml``; a row has one cell for each column.

    ``assignment``: that of the connector, where its shape is known.
    """

    id: str
    kind: str
    name: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[int | str, ...], ...]
    assignment: Assignment | None
    notes: tuple[str, ...]
    origin: Origin
    cite: Cite
    errata: tuple[str, ...]
    where: Where


@dataclass(frozen=True, slots=True, kw_only=True)
class FormulaExample:
    """A worked example: values of the names, printed result."""

    values: tuple[tuple[str, int], ...]
    result: int
    cite: Cite
    where: Where


@dataclass(frozen=True, slots=True, kw_only=True)
class Formula:
    """A formula; ``evaluate`` maps values of the names to the result in ``unit``."""

    id: str
    name: str
    expression: str
    evaluate: Callable[[Mapping[str, int]], int]
    unit: str
    note: str
    examples: tuple[FormulaExample, ...]
    cite: Cite
    errata: tuple[str, ...]
    where: Where
