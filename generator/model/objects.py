"""Objects of the CANopen object dictionary and of PROFIdrive, and what the standards say of them."""

from dataclasses import dataclass

from generator.model.citation import Cite, Origin, Where
from generator.model.reference import CodeRef, ObjectRef
from generator.model.values import Bit, BitField, DataType, Default, Option, Range


@dataclass(frozen=True, slots=True, kw_only=True)
class SubIndex:
    """A sub-index 0 ... 255.

    ``data_type`` and ``access`` are those used; ``printed_type`` and ``printed_access`` those of the manual, which
    differ where the manual contradicts the standard.  ``codes`` are the codes that mirror it, in every slot;
    ``printed_codes`` what each place ("overview", "detail") prints of them.  ``abort``: the abort code that any access
    returns (the entry does not exist on the bus then).  ``signature``: ASCII text that must be written.
    """

    number: int
    name: str
    data_type: DataType
    access: str
    printed_type: DataType
    printed_access: str
    default: Default | None
    range: Range | None
    options: tuple[Option, ...]
    bits: tuple[Bit, ...]
    fields: tuple[BitField, ...]
    codes: tuple[CodeRef, ...]
    printed_codes: tuple[tuple[str, tuple[CodeRef, ...]], ...]
    signature: str | None
    pdo_mapping: bool
    unused: bool
    abort: int | None
    description: str
    errata: tuple[str, ...]
    where: Where


@dataclass(frozen=True, slots=True, kw_only=True)
class DictionaryObject:
    """An object: ``kind`` "canopen" (``index`` 0x0000 ... 0xFFFF) or "profidrive" (``index`` is the PNU).

    ``object_type`` is "VAR", "ARRAY" or "RECORD".  ``standard``: the objects of the standard that it is one of.
    """

    kind: str
    index: int
    name: str
    object_type: str
    standard: "StandardObject | None"
    subindexes: tuple[SubIndex, ...]
    description: str
    origin: Origin
    cite: Cite
    errata: tuple[str, ...]
    where: Where

    @property
    def ref(self) -> ObjectRef:
        """Reference to the whole object."""
        return ObjectRef(self.index)

    @property
    def designation(self) -> str:
        """The object as the manuals write it: "I-1018", "PNU 918"."""
        return f"I-{self.index:04X}" if self.kind == "canopen" else f"PNU {self.index}"

    def subindex(self, number: int) -> SubIndex | None:
        """The sub-index of that number, ``None`` where the object has none."""
        return next((s for s in self.subindexes if s.number == number), None)


@dataclass(frozen=True, slots=True, kw_only=True)
class StandardSubIndex:
    """Sub-indexes ``first`` ... ``last`` as a standard defines them; ``access`` lists what it allows.

    ``default``: what the standard presets, ``None`` where that is up to the device.
    """

    first: int
    last: int
    name: str
    data_type: DataType
    access: tuple[str, ...]
    default: Default | None
    pdo_mapping: bool
    mandatory: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class StandardObject:
    """Objects ``first`` ... ``last`` as a standard defines them.

    ``category``: "mandatory", "optional" or "conditional".
    """

    first: int
    last: int
    name: str
    object_type: str
    category: str
    subindexes: tuple[StandardSubIndex, ...]
    cite: Cite
    where: Where

    def subindex(self, number: int) -> StandardSubIndex | None:
        """What the standard says of that sub-index, ``None`` where it defines none."""
        return next((s for s in self.subindexes if s.first <= number <= s.last), None)


@dataclass(frozen=True, slots=True, kw_only=True)
class CobId:
    """Entry of the predefined connection set: COB-ID = ``base`` + node address, ``base`` alone of a ``broadcast``.

    ``title`` says what its telegrams are for.
    """

    name: str
    title: str
    base: int
    broadcast: bool
    objects: tuple[ObjectRef, ...]
    cite: Cite
    where: Where

    def at(self, node: int) -> int:
        """COB-ID of the node with that address."""
        return self.base if self.broadcast else self.base + node
