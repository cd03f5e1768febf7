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
