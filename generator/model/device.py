"""Devices, base drives and the whole model."""

from dataclasses import dataclass

from generator.model.citation import Cite, Cited, Manual, Origin, Where
from generator.model.code import Code
from generator.model.erratum import Erratum
from generator.model.error import ErrorEntry
from generator.model.gsd import Gsd
from generator.model.indicator import IndicatorTable, SwitchGroup
from generator.model.objects import CobId, DictionaryObject, StandardObject
from generator.model.pin import Pin
from generator.model.service import Service
from generator.model.table import Formula, Table
from generator.model.telegram import Example, Layout
from generator.model.values import BitField


@dataclass(frozen=True, slots=True, kw_only=True)
class Slot:
    """A module slot: run of its codes and what is added to the numbers of the first slot.

    ``chapter``: where the manual describes the codes of this slot, ``None`` where the entries cite it themselves.
    """

    name: str
    first_code: int
    last_code: int
    code_offset: int
    error_offset: int
    chapter: str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Response:
    """A response to an error; ``value`` stands in the response field of an error number and in selection lists."""

    value: int
    name: str
    aliases: tuple[str, ...]
    origin: Origin
    cite: Cite


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveModule:
    """A value of the module field of an error number."""

    value: int
    name: str
    origin: Origin
    cite: Cite


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveCommand:
    """A device command: the value that is written to the code of commands."""

    value: int
    name: str
    origin: Origin
    cite: Cite


@dataclass(frozen=True, slots=True, kw_only=True)
class Drive:
    """A base drive: ``index_base`` - code number = index of a code.

    ``error_fields``: bits of an error number by name; ``reported_fields``: those that the drive fills when it reports
    the error, so that they do not tell which error it is.  ``command_code``: number of the code that commands are
    written to.
    """

    id: str
    title: str
    manufacturer: str
    index_base: int
    index_base_cites: tuple[Cite, ...]
    responses: tuple[Response, ...]
    error_fields: tuple[tuple[str, BitField], ...]
    reported_fields: tuple[str, ...]
    error_fields_origin: Origin
    error_fields_cite: Cite
    modules: tuple[DriveModule, ...]
    command_code: int | None
    command_code_cites: tuple[Cite, ...]
    commands: tuple[DriveCommand, ...]
    where: Where

    @property
    def error_mask(self) -> int:
        """Bits of an error number that tell which error it is."""
        return sum(field.mask for name, field in self.error_fields if name not in self.reported_fields)


@dataclass(frozen=True, slots=True, kw_only=True)
class CanOpenFacts:
    """What [DeviceInfo] of an EDS needs and no object says.

    ``baud_rates`` in kbit/s, ``granularity`` of PDO mapping in bits, ``node_address``: number of its code,
    ``node_addresses``: those that the standard allows.
    """

    baud_rates: tuple[int, ...]
    granularity: int
    node_address: int | None
    node_addresses: range
    boot_up_master: bool
    cite: Cite
    where: Where


@dataclass(frozen=True, slots=True, kw_only=True)
class Device:
    """A device with everything that its manual says, both slots expanded.

    ``attributes``: where the table of attributes stands.  ``codes`` ascend by number, ``objects`` by index; ``errors``
    stand in the order of kind and number.
    """

    id: str
    title: str
    manufacturer: str
    order_code: str
    manual: Manual
    bus: str
    drive: Drive | None
    hardware_version: str | None
    software_version: str | None
    cite: Cite
    slots: tuple[Slot, ...]
    canopen: CanOpenFacts | None
    gsd: Gsd | None
    attributes: Cite | None
    codes: tuple[Code, ...]
    objects: tuple[DictionaryObject, ...]
    errors: tuple[ErrorEntry, ...]
    indicators: tuple[IndicatorTable, ...]
    switches: tuple[SwitchGroup, ...]
    tables: tuple[Table, ...]
    formulas: tuple[Formula, ...]
    layouts: tuple[Layout, ...]
    services: tuple[Service, ...]
    examples: tuple[Example, ...]
    errata: tuple[Erratum, ...]
    where: Where

    @property
    def error_mask(self) -> int:
        """Bits by which a reported error number finds its entry among those of kind "device", 0 where there is none."""
        listed = any(error.kind == "device" for error in self.errors)
        return self.drive.error_mask if self.drive and listed else 0

    def error_bits(self, kind: str) -> int:
        """Bits of the error numbers of a kind, 16 or 32: as many as the largest of the list needs."""
        largest = max((error.last for error in self.errors if error.kind == kind), default=0)
        return 16 if largest < 1 << 16 else 32

    def codes_of_slot(self, slot: str | None) -> tuple[Code, ...]:
        """Codes that a master sees with the module in ``slot``: those of the base drive and of the slot."""
        return tuple(c for c in self.codes if c.slot is None or c.slot == slot)


@dataclass(frozen=True, slots=True, kw_only=True)
class Model:
    """Everything: ``date`` ("yyyy-mm-dd") is that of the ``version`` of the spec, the only one that artifacts carry.

    ``node_addresses``: those that a node on a CANopen bus can have.  ``cites``: every citation that was read.
    """

    version: str
    date: str
    devices: tuple[Device, ...]
    drives: tuple[Drive, ...]
    manuals: tuple[Manual, ...]
    standard_objects: tuple[StandardObject, ...]
    node_addresses: range
    cob_ids: tuple[CobId, ...]
    pins: tuple[Pin, ...]
    cites: tuple[Cited, ...]
