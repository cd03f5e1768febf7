"""Layouts of telegrams and worked examples."""

from dataclasses import dataclass
from enum import Enum

from generator.model.citation import Cite, Origin, Where
from generator.model.values import BitField, Option

OPEN = "XX"
"""In the bytes and values of an example: left open by the manual."""


class FieldType(Enum):
    """What the bytes of a field are."""

    UINT = "uint"
    INT = "int"
    BYTES = "bytes"
    TEXT = "text"
    GROUP = "group"


@dataclass(frozen=True, slots=True)
class Sizes:
    """Length by the value of an earlier field ``by``, times the value of the earlier field ``times``.

    ``fills``: the length is what that product lacks of a whole multiple of so many bytes.
    """

    by: str
    sizes: tuple[tuple[int, int], ...]
    times: str | None
    fills: int | None = None

    @property
    def longest(self) -> int | None:
        """Most bytes, ``None`` where another field multiplies them."""
        if self.fills is not None:
            return self.fills - 1
        return None if self.times is not None else max((size for _, size in self.sizes), default=0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """A field of a layout.

    ``length``: bytes; a name means the value of that earlier field, ``None`` up to the end of the telegram.  ``sizes``
    takes its place where the length depends on another field.  ``count``: of a group, the earlier field that says how
    often it repeats, ``None`` to the end.  ``bits``: parts of a number.  ``big``: high byte first.  ``errors``: kind of
    the error numbers that it holds.
    """

    name: str
    title: str
    type: FieldType
    length: int | str | None
    sizes: Sizes | None
    count: str | None
    fields: tuple["Field", ...]
    big: bool
    constant: int | None
    values: tuple[Option, ...]
    bits: tuple[BitField, ...]
    bit_values: tuple[tuple[str, tuple[Option, ...]], ...]
    description: str
    where: Where
    errors: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """The fields of a telegram in the order of its bytes.

    ``identifiers``: names of its COB-IDs in the predefined connection set, beside those that services say.
    """

    id: str
    name: str
    protocol: str
    fields: tuple[Field, ...]
    description: str
    origin: Origin
    cite: Cite
    errata: tuple[str, ...]
    where: Where
    identifiers: tuple[str, ...] = ()


Value = int | str | tuple["Values", ...]
"""Value of a field: number, text (bytes as spaced hexadecimal), or the repetitions of a group."""
Values = dict[str, "Value"]
"""Values of a layout by name of the field; parts of a number stand as "field.part"."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Example:
    """A worked telegram.

    ``printed`` and ``data`` are the bytes printed and used, ``None`` where one is left open.  ``identifier``: printed
    COB-ID.  ``sequence``: name of the exchange that it belongs to.
    """

    id: str
    name: str
    layout: str
    direction: str
    sequence: str | None
    node: int | None
    identifier: int | None
    printed: tuple[int | None, ...]
    data: tuple[int | None, ...]
    values: Values
    meaning: str
    cite: Cite
    errata: tuple[str, ...]
    where: Where
