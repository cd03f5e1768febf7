"""Codes: the parameters of a Lenze drive."""

from dataclasses import dataclass

from generator.model.citation import Cite, Origin, Where
from generator.model.reference import CodeRef, ObjectRef
from generator.model.values import Bit, BitField, DataType, Default, NodeRelative, Option, Range


@dataclass(frozen=True, slots=True)
class Access:
    """Ticked access boxes.

    ``conditions`` names the others ("cinh", "plc_stop", "no_transfer", ...).  Device-internal codes whose boxes are not
    printed are neither readable nor writable.
    """

    read: bool
    write: bool
    conditions: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class PrintedIndex:
    """An index as one place prints it.

    ``place`` names the place ("chapter MXI1", "table MXI2", "chapter base"); ``hexadecimal`` is ``None`` where
    only the decimal form is printed.
    """

    place: str
    decimal: int
    hexadecimal: int | None
    page: int | None
    where: Where


@dataclass(frozen=True, slots=True)
class AttributeRow:
    """Row of the table of attributes, as printed.

    ``structure``: "A" (array) or "E" (single variable).  ``count``: elements.  ``factor``: ``None`` where a
    dash is printed.  ``access``: "R" or "RW", with "CINH".
    ``name``: ``None`` where it is that of the code's own table.
    """

    structure: str
    count: int
    type_name: str
    factor: int | None
    access: str
    name: str | None
    page: int | None
    where: Where


@dataclass(frozen=True, slots=True, kw_only=True)
class SubCode:
    """A subcode, counted from 1; it is addressed by the sub-index of the same number.

    ``name`` is "" where the manual prints none.  ``default`` is what is printed; ``follows`` the rule over the node
    address that it obeys, where there is one.
    """

    number: int
    name: str
    default: Default | None
    follows: NodeRelative | None
    options: tuple[Option, ...]
    description: str
    where: Where


@dataclass(frozen=True, slots=True, kw_only=True)
class Code:
    """A code in one slot.

    ``number``: 0 ... 24575.  ``slot``: name of the module slot, ``None`` for codes of the base drive.
    ``twin_of``: number of the same code in the first slot (its own number there).
    ``index``: canonical index, index base of the drive minus number.
    ``type_name``: the manual's spelling ("BITFIELD_8"); ``data_type``: what travels on the bus.
    ``subcodes``: empty for a single variable (sub-index 0).
    ``default`` is ``None`` where no Lenze setting is printed; subcodes carry their own.
    ``scaling``: wire value = value * scaling.  ``length``: longest string in bytes.
    ``shared_by``: id of the drive whose fact it is, ``None`` where the module's manual alone holds it.
    ``errata``: ids of the ledger entries that concern it.
    """

    number: int
    slot: str | None
    twin_of: int
    name: str
    index: int
    type_name: str
    data_type: DataType
    length: int | None
    access: Access
    scaling: int | None
    range: Range | None
    default: Default | None
    default_cite: Cite | None
    options: tuple[Option, ...]
    bits: tuple[Bit, ...]
    fields: tuple[BitField, ...]
    subcodes: tuple[SubCode, ...]
    objects: tuple[ObjectRef, ...]
    since: str | None
    internal: bool
    description: str
    shared_by: str | None
    origin: Origin
    cite: Cite
    printed_name: str
    printed: tuple[PrintedIndex, ...]
    attributes: AttributeRow | None
    errata: tuple[str, ...]
    where: Where

    @property
    def ref(self) -> CodeRef:
        """Reference to the whole code."""
        return CodeRef(self.number)

    @property
    def designation(self) -> str:
        """The code as the manuals write it, for example "C13350"."""
        return f"C{self.number:05d}"

    @property
    def is_array(self) -> bool:
        """Whether the code has subcodes."""
        return bool(self.subcodes)

    @property
    def highest_subcode(self) -> int:
        """Number of the last subcode; 0 for a single variable."""
        return self.subcodes[-1].number if self.subcodes else 0

    @property
    def is_bitfield(self) -> bool:
        """Whether the manual calls the value bit-coded; such values are shown in hexadecimal."""
        return self.type_name.startswith("BITFIELD")
