"""The constants of the C headers: views that hold every string, and the writer that makes them of facts."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from generator.emit.base import EmitError
from generator.emit.c.prose import Part, named
from generator.emit.c.syntax import comment, decimal, fits_int, integer, paragraph, string
from generator.emit.names import bit_names, field_names, option_names
from generator.model import Bit, BitField, DataType, Default, NodeRelative, Option, Range, Where
from generator.naming import Scope

SIGNIFICANT = 63
"""Characters of a name that every C99 compiler tells apart."""

ACCESS_FLAGS = (
    "read",
    "write",
    "const",
    "pdo_map",
    "pdo_map_rx",
    "pdo_map_tx",
    "cinh",
    "plc_stop",
    "no_transfer",
    "com",
    "mot",
)
"""What the access of a code or sub-index can say, from bit 0 on; part of the interface, so append only."""


@dataclass(frozen=True, slots=True)
class Constant:
    """A name and its literal; ``is_text`` for string literals."""

    name: str
    value: str
    comment: str
    is_text: bool = False


@dataclass(frozen=True, slots=True)
class Enumeration:
    """A selection list as a type; every int holds its values."""

    name: str
    comment: str
    constants: tuple[Constant, ...]


@dataclass(frozen=True, slots=True)
class Section:
    """What a header says of one fact: a member group of Doxygen, its prose, its constants."""

    title: str
    lines: tuple[str, ...]
    constants: tuple[Constant, ...]
    enumerations: tuple[Enumeration, ...]


@dataclass(frozen=True, slots=True)
class Header:
    """A header file; ``brief`` and ``notes`` stand in its head."""

    file: str
    guard: str
    brief: str
    notes: tuple[str, ...]
    sections: tuple[Section, ...]

    @property
    def constants(self) -> Iterator[Constant]:
        """Every constant of the header, those of enumerations too."""
        for section in self.sections:
            yield from section.constants
            for enumeration in section.enumerations:
                yield from enumeration.constants


class Names:
    """Names of all headers together, since one translation unit may include them all."""

    def __init__(self) -> None:
        """Begin without a name."""
        self._scope = Scope("names of the C headers")
        self._claimed: set[str] = set()

    def claim(self, name: str, where: Where) -> str:
        """Claim a name, by the characters that are significant, for one fact alone.

        Raises:
            EmitError: Rule "name-collision"; the twins of two slots, which stand at one place, collide as well.
        """
        key = name[:SIGNIFICANT]
        self._scope.add(key, where)
        if key in self._claimed:
            raise EmitError("name-collision", where, f"'{key}' would stand twice among the names of the C headers")
        self._claimed.add(key)
        return name


class Writer:
    """Constants of one fact after another, each under a name that begins with ``prefix``."""

    def __init__(self, names: Names, prefix: str, title: str, where: Where) -> None:
        """Begin a section; ``title`` describes its types, ``where`` is the fact's place in spec."""
        self._names = names
        self._prefix = prefix
        self._title = title
        self._where = where
        self._constants: list[Constant] = []
        self._enumerations: list[Enumeration] = []

    def section(self, title: str, prose: Iterable[str]) -> Section:
        """What was written, under a title and its prose ("" is left out)."""
        lines = tuple(line for text in prose if text for line in paragraph(text))
        return Section(comment(title), lines, tuple(self._constants), tuple(self._enumerations))

    def include(self, other: "Writer") -> None:
        """Write what another writer wrote."""
        self._constants += other._constants
        self._enumerations += other._enumerations

    def number(self, suffix: str, value: int, text: str, bits: int = 16, *, hexadecimal: bool = False) -> None:
        """Write a number of at least ``bits`` bits."""
        self._add(suffix, integer(value, bits, hexadecimal=hexadecimal), text)

    def run(self, suffix: str, first: int, last: int, bits: int) -> None:
        """Write the ends of a run of numbers."""
        ends = ((first, "first number"), (last, "last number"))
        for name, (value, text) in zip(run_names(f"{self._prefix}_{suffix}"), ends, strict=True):
            self._add_named(name, integer(value, bits, hexadecimal=True), text)

    def text(self, suffix: str, value: str, text: str) -> None:
        """Write a string literal."""
        self._add(suffix, string(value), text, is_text=True)

    def data_type(self, prefix: str, data_type: DataType, printed: str, length: int | None = None) -> None:
        """Write the data type, with its printed name, and the bytes it takes as far as they are known."""
        self._add(f"{prefix}TYPE", f"DRIVESPEC_TYPE_{data_type.canopen_name}", f"printed: {printed}")
        size = data_type.bits // 8 or length
        if size:
            self.number(f"{prefix}SIZE_BYTES", size, "bytes on the bus")

    def access(self, prefix: str, flags: Iterable[str], printed: str) -> None:
        """Write the access flags, with what is printed."""
        self._add(f"{prefix}ACCESS", access(flags), f"printed: {printed}")

    def limits(self, prefix: str, bounds: Range | None, scaling: int, data_type: DataType, in_hex: bool) -> None:
        """Write the smallest and the largest wire value of a range."""
        if bounds is None:
            return
        low, high = wire_limits(bounds, scaling)
        for suffix, value, printed, text in (("MIN", low, bounds.low, "least"), ("MAX", high, bounds.high, "largest")):
            unit = f" {bounds.unit}" if bounds.unit else ""
            shown = f" ({decimal(printed)}{unit})" if unit or printed != value else ""
            self._add(f"{prefix}{suffix}", typed(value, data_type, in_hex), f"{text} wire value{shown}")

    def default(
        self, prefix: str, value: Default | None, follows: NodeRelative | None, data_type: DataType, in_hex: bool
    ) -> None:
        """Write a default and, where it follows the node address, what is added to that."""
        if isinstance(value, NodeRelative):
            follows = value
        elif isinstance(value, str):
            self.text(f"{prefix}DEFAULT", value, "default")
        elif value is not None:
            self._add(f"{prefix}DEFAULT", typed(value, data_type, in_hex), "default")
        if follows is not None:
            literal = integer(follows.base, data_type.bits, hexadecimal=True)
            self._add(f"{prefix}DEFAULT_BASE", literal, "default less the node address")

    def options(
        self, prefix: str, options: Sequence[Option], data_type: DataType, cites: Mapping[int, str] | None = None
    ) -> None:
        """Write a selection list: a type named ``prefix``, or plain constants where an int may be too narrow.

        ``cites`` says of values where they are printed, if that is not said of the whole list.
        """
        if not options:
            return
        texts = [f"{option.label}; {cites[option.value]}" if cites else option.label for option in options]
        start = f"{self._prefix}_{prefix}"
        names = [
            _fit(start, _number_word(option.value), name)
            for option, name in zip(options, option_names(options), strict=True)
        ]
        if all(fits_int(option.value) for option in options):
            constants = tuple(
                self._constant(name, str(option.value), text)
                for option, name, text in zip(options, names, texts, strict=True)
            )
            tag = self._names.claim(start.lower(), self._where)
            self._enumerations.append(Enumeration(tag, comment(self._title), constants))
        else:
            for option, name, text in zip(options, names, texts, strict=True):
                self._add_named(name, typed(option.value, data_type), text)

    def bits(self, prefix: str, bits: Sequence[Bit], data_type: DataType) -> None:
        """Write a mask for each label; bits of the same label share one."""
        masks: dict[str, int] = {}
        for bit in bits:
            masks[bit.label] = masks.get(bit.label, 0) | 1 << bit.number
        lowest = [Bit((mask & -mask).bit_length() - 1, label) for label, mask in masks.items()]
        for bit, name in zip(lowest, bit_names(lowest), strict=True):
            mask = integer(masks[bit.label], data_type.bits, hexadecimal=True)
            self._add_named(_fit(f"{self._prefix}_{prefix}BIT", str(bit.number), name), mask, bit.label)

    def fields(self, prefix: str, fields: Sequence[BitField], data_type: DataType) -> None:
        """Write mask and shift of each bit field."""
        for field, name in zip(fields, field_names(fields), strict=True):
            start, number = f"{self._prefix}_{prefix}FIELD", str(field.low)
            mask = integer(field.mask, data_type.bits, hexadecimal=True)
            self._add_named(_fit(start, number, name, "_MASK"), mask, f"{field.label}, mask")
            self._add_named(_fit(start, number, name, "_SHIFT"), integer(field.low, 8), f"{field.label}, lowest bit")

    def parts(self, parts: Sequence[Part]) -> None:
        """Write the numbers of the subcodes or sub-indexes whose names say more than their numbers."""
        options = named(parts)
        for option, name in zip(options, option_names(options), strict=True):
            label = _fit(f"{self._prefix}_SUB", str(option.value), name)
            self._add_named(label, integer(option.value, 8), option.label)

    def _add(self, suffix: str, value: str, text: str, *, is_text: bool = False) -> None:
        self._add_named(f"{self._prefix}_{suffix}", value, text, is_text=is_text)

    def _add_named(self, name: str, value: str, text: str, *, is_text: bool = False) -> None:
        self._constants.append(self._constant(name, value, text, is_text=is_text))

    def _constant(self, name: str, value: str, text: str, *, is_text: bool = False) -> Constant:
        return Constant(self._names.claim(name, self._where), value, comment(text), is_text)


def typed(value: int, data_type: DataType, in_hex: bool = False) -> str:
    """Literal of a wire value."""
    return integer(value, data_type.bits, signed=data_type.signed, hexadecimal=in_hex)


def access(flags: Iterable[str]) -> str:
    """Access flags as an expression.

    >>> access(("write", "read"))
    '(DRIVESPEC_ACCESS_READ | DRIVESPEC_ACCESS_WRITE)'

    Raises:
        ValueError: A flag that the interface does not have.
    """
    numbers = sorted(ACCESS_FLAGS.index(flag) for flag in flags)
    names = [f"DRIVESPEC_ACCESS_{ACCESS_FLAGS[number].upper()}" for number in numbers]
    return f"({' | '.join(names)})" if len(names) > 1 else "".join(names) or "0u"


def wire_limits(bounds: Range, scaling: int) -> tuple[int, int]:
    """Smallest and largest whole wire value inside a range."""
    return math.ceil(bounds.low * scaling), math.floor(bounds.high * scaling)


def _fit(prefix: str, number: str, name: str, suffix: str = "") -> str:
    """``prefix_NAME``; where that is too long ``prefix_number_NAME``, cut after a word."""
    label = name.strip("_").upper()
    whole = f"{prefix}_{label}{suffix}"
    if len(whole) <= SIGNIFICANT:
        return whole
    return _cut(f"{prefix}_{number}_{label}", suffix)


def run_names(name: str) -> tuple[str, str]:
    """Names of the ends of a run, cut so that both are told apart."""
    return _cut(name, "_FIRST"), _cut(name, "_LAST")


def _cut(name: str, suffix: str) -> str:
    """``name`` and ``suffix``, the name cut after a word so that both together are significant."""
    room = SIGNIFICANT - len(suffix)
    return (name if len(name) <= room else name[: room + 1].rpartition("_")[0]) + suffix


def _number_word(value: int) -> str:
    return f"MINUS_{-value}" if value < 0 else str(value)
