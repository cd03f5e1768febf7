"""drivespec.h: what all devices share, the base drives and the predefined connection set."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from generator.emit.c.prose import cited, provenance
from generator.emit.c.syntax import comment, integer
from generator.emit.c.writer import ACCESS_FLAGS, Header, Names, Section, Writer
from generator.emit.names import field_names
from generator.model import DataType, Drive, DriveCommand, DriveModule, Manual, Model, Option, Response, Where
from generator.naming import screaming

ERROR_KINDS = ("device", "emergency", "sdo_abort", "dpv0", "dpv1", "gci")
"""Kinds of error numbers by their value in the records; part of the interface, so append only."""

RECORD_FLAGS = ("range", "default", "default_base")
"""What a record can lack, from bit 0 on; part of the interface, so append only."""

NO_RESPONSE = 0xFF
"""Response of an error record where none is printed."""

_HERE = Where("drivespec.h", 1, 1)
"""Place of the constants that are not of spec."""


_FUNCTIONS = (
    "field_get",
    "field_set",
    "at_node",
    "type_limits",
    "limits",
    "in_range",
    "factor",
    "to_wire",
    "from_wire",
    "same_text",
    "find_code",
    "find_name",
    "find_default",
)
"""Ends of the names of the functions that the template holds."""


@dataclass(frozen=True, slots=True)
class ErrorField:
    """Function that takes a field out of an error number; ``prefix`` begins the names of its mask and shift."""

    function: str
    prefix: str
    comment: str


@dataclass(frozen=True, slots=True)
class DriveView:
    """Functions of a base drive; ``stem`` and ``prefix`` begin the names."""

    stem: str
    prefix: str
    fields: tuple[ErrorField, ...]


@dataclass(frozen=True, slots=True)
class TypeView:
    """A data type of numbers and its limits."""

    name: str
    min: str
    max: str


@dataclass(frozen=True, slots=True)
class CommonHeader(Header):
    """View of drivespec.h: the constants and what its functions take from the model."""

    drives: tuple[DriveView, ...]
    types: tuple[TypeView, ...]
    has_nodes: bool


def common_header(model: Model, names: Names) -> CommonHeader:
    """View of drivespec.h."""
    guard = names.claim("DRIVESPEC_DRIVESPEC_H", _HERE)
    sections = [*_interface(names)]
    sections += [section for drive in model.drives for section in _drive(drive, names)]
    if model.cob_ids:
        sections.append(_connection_set(model, names))
    makers = sorted({drive.manufacturer for drive in model.drives})
    notes = provenance(model, _manuals(model), makers)
    for function in _FUNCTIONS:
        names.claim(f"drivespec_{function}", _HERE)
    drives = tuple(_drive_view(drive, names) for drive in model.drives)
    types = tuple(_type_view(data_type) for data_type in DataType if data_type.is_number)
    brief = "Types and facts that several drives share."
    return CommonHeader(
        "drivespec.h", guard, brief, notes, tuple(sections), drives, types, bool(model.cob_ids and model.node_addresses)
    )


def _drive_view(drive: Drive, names: Names) -> DriveView:
    prefix, stem = drive_prefix(drive), drive_prefix(drive).lower()
    names.claim(f"{stem}_index", drive.where)
    names.claim(f"{stem}_code", drive.where)
    bit_fields = [field for _, field in drive.error_fields]
    fields = tuple(
        ErrorField(
            names.claim(f"{stem}_error_{name}", drive.where),
            f"{prefix}_ERROR_{name.upper()}",
            comment(f"{field.label} of an error number."),
        )
        for field, name in zip(bit_fields, field_names(bit_fields), strict=True)
    )
    return DriveView(stem, prefix, fields)


def _type_view(data_type: DataType) -> TypeView:
    highest = min(data_type.highest, (1 << 63) - 1)
    low, high = (integer(value, 64, signed=True) for value in (data_type.lowest, highest))
    return TypeView(f"DRIVESPEC_TYPE_{data_type.canopen_name}", low, high)


def drive_prefix(drive: Drive) -> str:
    """How the names of a base drive's constants begin."""
    return screaming(drive.id)


def _manuals(model: Model) -> list[Manual]:
    """The manuals that the shared facts cite."""
    cites = [cob_id.cite for cob_id in model.cob_ids]
    for drive in model.drives:
        cites += [*drive.index_base_cites, drive.error_fields_cite, *(entry.cite for entry in drive.responses)]
        cites += [*(entry.cite for entry in drive.modules), *(entry.cite for entry in drive.commands)]
    used = {cite.manual for cite in cites}
    return [manual for manual in model.manuals if manual.id in used]


def _interface(names: Names) -> Iterator[Section]:
    types = Writer(names, "DRIVESPEC_TYPE", "Data type", _HERE)
    for data_type in DataType:
        types.number(data_type.canopen_name, data_type.canopen_number, data_type.canopen_name, 16, hexadecimal=True)
    yield types.section("Data types", ["Numbered as in CiA 301."])
    yield _flags("DRIVESPEC_ACCESS", "Access flag", ACCESS_FLAGS, names).section("Access flags", [])
    yield _flags("DRIVESPEC_HAS", "Record has", RECORD_FLAGS, names).section("What a record has", [])
    kinds = Writer(names, "DRIVESPEC_ERROR", "Kind of error number", _HERE)
    for value, kind in enumerate(ERROR_KINDS):
        kinds.number(kind.upper(), value, kind, 8)
    yield kinds.section("Kinds of error numbers", [])
    responses = Writer(names, "DRIVESPEC_RESPONSE", "Response of an error record", _HERE)
    responses.number("NOT_PRINTED", NO_RESPONSE, "none is printed", 8)
    yield responses.section("Responses", ["The responses of a drive stand with the drive."])


def _flags(prefix: str, title: str, flags: Sequence[str], names: Names) -> Writer:
    writer = Writer(names, prefix, title, _HERE)
    for bit, flag in enumerate(flags):
        writer.number(flag.upper(), 1 << bit, flag, 16, hexadecimal=True)
    return writer


def _drive(drive: Drive, names: Names) -> Iterator[Section]:
    prefix = drive_prefix(drive)
    base = Writer(names, prefix, drive.title, drive.where)
    base.number("INDEX_BASE", drive.index_base, "index of a code = this less the number of the code")
    yield base.section(f"{drive.title}: index of codes", map(cited, drive.index_base_cites))
    layout = Writer(names, f"{prefix}_ERROR", f"{drive.title}, error number", drive.where)
    bit_fields = [field for _, field in drive.error_fields]
    for field, name in zip(bit_fields, field_names(bit_fields), strict=True):
        layout.number(f"{name.upper()}_MASK", field.mask, f"{field.label}, mask", 32, hexadecimal=True)
        layout.number(f"{name.upper()}_SHIFT", field.low, f"{field.label}, lowest bit", 8)
    cite = cited(drive.error_fields_cite, drive.error_fields_origin)
    yield layout.section(f"{drive.title}: error number", [cite])
    for word, title, entries in (
        ("RESPONSE", "responses to errors", drive.responses),
        ("MODULE", "module field of error numbers", drive.modules),
        ("COMMAND", "device commands", drive.commands),
    ):
        yield _values(drive, word, title, entries, names)


def _values(
    drive: Drive, word: str, title: str, entries: Sequence[Response | DriveModule | DriveCommand], names: Names
) -> Section:
    writer = Writer(names, drive_prefix(drive), f"{drive.title}, {title}", drive.where)
    cites = {entry.value: cited(entry.cite, entry.origin) for entry in entries}
    writer.options(word, [Option(entry.value, entry.name) for entry in entries], DataType.UNSIGNED32, cites)
    return writer.section(f"{drive.title}: {title}", [])


def _connection_set(model: Model, names: Names) -> Section:
    writer = Writer(names, "DRIVESPEC", "COB-ID", _HERE)
    for entry in model.cob_ids:
        name = f"COB_ID_{screaming(entry.name)}"
        objects = f" ({', '.join(map(str, entry.objects))})" if entry.objects else ""
        if entry.broadcast:
            writer.number(name, entry.base, f"{entry.name}{objects}, broadcast: the whole COB-ID", hexadecimal=True)
        else:
            text = f"{entry.name}{objects}, COB-ID less the node address"
            writer.number(f"{name}_BASE", entry.base, text, hexadecimal=True)
    if model.node_addresses:
        writer.number("NODE_MIN", model.node_addresses[0], "lowest node address", 8)
        writer.number("NODE_MAX", model.node_addresses[-1], "highest node address", 8)
    cites = dict.fromkeys(cited(entry.cite) for entry in model.cob_ids)
    return writer.section("Predefined connection set", ["A base takes the node address: drivespec_at_node.", *cites])
