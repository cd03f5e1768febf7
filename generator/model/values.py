"""Data types, ranges, defaults, selection lists and bits."""

from dataclasses import dataclass
from enum import Enum
from fractions import Fraction


class DataType(Enum):
    """Data type of a code or object: (CiA 301 name, CiA 301 type number, width in bits, signed).

    The width is 0 for strings.  BITFIELD_n of the Lenze manuals travels as UNSIGNEDn.
    """

    UNSIGNED8 = ("UNSIGNED8", 0x0005, 8, False)
    UNSIGNED16 = ("UNSIGNED16", 0x0006, 16, False)
    UNSIGNED32 = ("UNSIGNED32", 0x0007, 32, False)
    UNSIGNED64 = ("UNSIGNED64", 0x001B, 64, False)
    INTEGER8 = ("INTEGER8", 0x0002, 8, True)
    INTEGER16 = ("INTEGER16", 0x0003, 16, True)
    INTEGER32 = ("INTEGER32", 0x0004, 32, True)
    VISIBLE_STRING = ("VISIBLE_STRING", 0x0009, 0, False)
    OCTET_STRING = ("OCTET_STRING", 0x000A, 0, False)
    DOMAIN = ("DOMAIN", 0x000F, 0, False)

    @property
    def canopen_name(self) -> str:
        """Name in CiA 301."""
        return self.value[0]

    @property
    def canopen_number(self) -> int:
        """Index of the type's entry in the object dictionary (CiA 301, 9.6.3)."""
        return self.value[1]

    @property
    def bits(self) -> int:
        """Width in bits; 0 for types of variable length."""
        return self.value[2]

    @property
    def signed(self) -> bool:
        """Whether values below zero exist."""
        return self.value[3]

    @property
    def is_number(self) -> bool:
        """Whether the value is an integer."""
        return self.bits > 0

    @property
    def lowest(self) -> int:
        """Smallest value of the width; 0 for strings."""
        return -(1 << (self.bits - 1)) if self.signed else 0

    @property
    def highest(self) -> int:
        """Largest value of the width; 0 for strings."""
        return (1 << (self.bits - self.signed)) - 1 if self.bits else 0


@dataclass(frozen=True, slots=True)
class Range:
    """Setting or display range, both ends included, in ``unit`` ("" where none is printed)."""

    low: Fraction
    high: Fraction
    unit: str = ""


@dataclass(frozen=True, slots=True)
class NodeRelative:
    """A value that follows the node address: ``base`` + node address."""

    base: int

    def at(self, node: int) -> int:
        """Value for node address ``node``."""
        return self.base + node

    def __str__(self) -> str:
        """The value as spec writes it: "$NODEID + 0x180"."""
        return f"$NODEID + 0x{self.base:X}"


Default = int | str | NodeRelative
"""A default: number (of the wire value), text of a string, or a rule over the node address."""


@dataclass(frozen=True, slots=True)
class Option:
    """Entry of a selection list."""

    value: int
    label: str


@dataclass(frozen=True, slots=True)
class Bit:
    """A bit of a bit-coded value, counted from 0."""

    number: int
    label: str


@dataclass(frozen=True, slots=True)
class BitField:
    """Adjacent bits ``low`` ... ``high`` that form one number."""

    low: int
    high: int
    label: str

    @property
    def mask(self) -> int:
        """The bits of the field set, all others clear."""
        return ((1 << (self.high - self.low + 1)) - 1) << self.low
