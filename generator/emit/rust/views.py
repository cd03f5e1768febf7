"""What the templates of the crate are filled with: every string is final, documentation comments included."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Variant:
    """Variant of a selection list: literals of its value and its label."""

    doc: str
    name: str
    value: str
    label: str


@dataclass(frozen=True, slots=True)
class Selection:
    """Selection list as an enum with the integer type ``repr``."""

    name: str
    doc: str
    repr: str
    variants: tuple[Variant, ...]


@dataclass(frozen=True, slots=True)
class Constant:
    """Constant with the literal of its value."""

    doc: str
    name: str
    type: str
    value: str


@dataclass(frozen=True, slots=True)
class Part:
    """Group of bits of a field: how it is read, and what the field becomes with it, "" where the field is constant.

    ``limit`` is the largest value where the type holds more, else "".
    """

    getter: str
    setter: str
    doc: str
    label: str
    field: str
    type: str
    read: str
    written: str
    limit: str


@dataclass(frozen=True, slots=True)
class Sizes:
    """Function that tells the length of a field: (value, length) for each value of the type ``type``."""

    name: str
    type: str
    arms: tuple[tuple[str, int], ...]


@dataclass(frozen=True, slots=True)
class Fields:
    """Struct of a telegram or of an entry of a group: its fields as constants and names, and the code of both ways.

    ``size`` is the length in bytes where it is always the same, else "".  ``read`` and ``write`` are statements.
    """

    name: str
    lifetime: str
    doc: str
    whole: bool
    size: str
    fields: tuple[Constant, ...]
    constants: tuple[Constant, ...]
    parts: tuple[Part, ...]
    reader: str
    writer: str
    read: tuple[str, ...]
    write: tuple[str, ...]
    found: str


@dataclass(frozen=True, slots=True)
class Vector:
    """Test of a worked telegram: declarations of its ``size`` bytes and of the values expected."""

    name: str
    doc: str
    data: str
    expected: str
    telegram: str
    size: str


@dataclass(frozen=True, slots=True)
class RandomTest:
    """Test of a layout with random bytes, up to ``size`` of them."""

    name: str
    telegram: str
    size: str


@dataclass(frozen=True, slots=True)
class Masks:
    """Module of the bits of one code or object: masks, and declarations of the records, "" where there are none."""

    name: str
    doc: str
    constants: tuple[Constant, ...]
    bits: str
    fields: str


@dataclass(frozen=True, slots=True)
class Record:
    """Constant that holds a record; ``item`` is the whole declaration."""

    name: str
    doc: str
    item: str


@dataclass(frozen=True, slots=True)
class Error:
    """Constant of an error number; ``last`` is "" for a single one."""

    name: str
    doc: str
    number: str
    last: str


@dataclass(frozen=True, slots=True)
class TypeVariant:
    """Variant of an enum of module ``types`` and the word for it elsewhere."""

    name: str
    text: str
    doc: str


@dataclass(frozen=True, slots=True)
class TypeEnum:
    """Enum of module ``types``; ``all`` is the declaration of the list of its variants."""

    name: str
    doc: str
    variants: tuple[TypeVariant, ...]
    all: str


@dataclass(frozen=True, slots=True)
class DataTypeFigures:
    """Figures of a data type of CiA 301."""

    name: str
    number: str
    bits: int


@dataclass(frozen=True, slots=True)
class Module:
    """Module of a device, which is also a feature of the crate; title and manual as markup."""

    name: str
    title: str
    manual: str
