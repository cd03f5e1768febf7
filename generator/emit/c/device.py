"""<device>.h: the constants of one device."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from generator.emit.c.prose import cited, errata, listed, provenance, references, runs, sentence
from generator.emit.c.syntax import comment
from generator.emit.c.writer import Header, Names, Section, Writer, run_names
from generator.emit.names import code_name, error_name, object_name
from generator.model import (
    Code,
    DataType,
    Default,
    Device,
    DictionaryObject,
    ErrorEntry,
    Model,
    NodeRelative,
    Option,
    SubCode,
    SubIndex,
    Table,
)
from generator.naming import screaming

_OBJECT_ACCESS = {
    "ro": ("read",),
    "wo": ("write",),
    "rw": ("read", "write"),
    "const": ("read", "const"),
    "rwr": ("read", "write", "pdo_map_tx"),
    "rww": ("read", "write", "pdo_map_rx"),
}


def device_header(model: Model, device: Device, names: Names) -> Header:
    """View of the header of a device."""
    prefix = device_prefix(device)
    guard = names.claim(f"DRIVESPEC_{prefix}_H", device.where)
    sections = [_device(device, prefix, names)]
    sections += [_code(code, device, prefix, names) for code in device.codes]
    sections += [_object(entry, device, prefix, names) for entry in device.objects]
    sections += [_identifiers(table, device, prefix, names) for table in device.tables if identified(table)]
    sections += [_error(error, device, device.error_bits(error.kind), names) for error in device.errors]
    return Header(
        f"{device.id}.h",
        guard,
        comment(f"Constants of the {device.title} ({device.order_code}, {device.bus})."),
        provenance(model, [device.manual], [device.manufacturer]),
        tuple(sections),
    )


def identified(table: Table) -> list[Option]:
    """Rows of a table of data types as a selection: the numbers of its column "id" and the names beside them."""
    if table.kind != "data-type" or [column.id for column in table.columns[:1]] != ["id"]:
        return []
    return [Option(row[0], str(row[1])) for row in table.rows if isinstance(row[0], int)]


def _identifiers(table: Table, device: Device, prefix: str, names: Names) -> Section:
    writer = Writer(names, prefix, table.name, table.where)
    writer.options(screaming(table.id), identified(table), DataType.UNSIGNED32)
    lines = [*table.notes, cited(table.cite, table.origin), *errata(device, table.errata, {})]
    return writer.section(table.name, lines)


def device_prefix(device: Device) -> str:
    """How the names of a device's constants begin."""
    return screaming(device.id)


def _device(device: Device, prefix: str, names: Names) -> Section:
    writer = Writer(names, prefix, device.title, device.where)
    writer.number("CODE_COUNT", len(device.codes), "codes, those of all slots")
    writer.number("OBJECT_COUNT", len(device.objects), "objects")
    writer.number("ERROR_COUNT", len(device.errors), "error numbers and runs of them")
    if device.error_mask:
        part = "part of an error number that finds it in the list"
        writer.number("ERROR_MASK", device.error_mask, part, 32, hexadecimal=True)
    for slot in device.slots:
        writer.number(f"{slot.name}_CODE_FIRST", slot.first_code, f"first code of slot {slot.name}")
        writer.number(f"{slot.name}_CODE_LAST", slot.last_code, f"last code of slot {slot.name}")
        writer.number(f"{slot.name}_CODE_OFFSET", slot.code_offset, "added to a code of the first slot")
        offset, text = slot.error_offset, "added to an error number of the first slot"
        writer.number(f"{slot.name}_ERROR_OFFSET", offset, text, 32, hexadecimal=True)
    lines = [cited(device.cite)]
    if device.canopen:
        facts = device.canopen
        if facts.node_address is not None:
            writer.number("NODE_ADDRESS_CODE", facts.node_address, "code that holds the node address")
        writer.number("PDO_GRANULARITY_BITS", facts.granularity, "granularity of PDO mapping in bits", 8)
        writer.number("BOOT_UP_MASTER", int(facts.boot_up_master), "1 if it can be NMT master", 8)
        writer.number("BAUD_RATE_COUNT", len(facts.baud_rates), "bit rates supported", 8)
        rates = ", ".join(map(str, facts.baud_rates))
        lines.append(f"Bit rates in kbit/s: {rates}. {cited(facts.cite)}")
    return writer.section(f"{device.title}: the device", lines)


def _code(code: Code, device: Device, prefix: str, names: Names) -> Section:
    writer = Writer(names, f"{prefix}_{code.designation}", f"Selection list of {code.designation}", code.where)
    in_hex = code.is_bitfield
    writer.number("NUMBER", code.number, code.designation)
    writer.number("INDEX", code.index, f"decimal {code.index}", hexadecimal=True)
    writer.number("SUBCODE_COUNT", len(code.subcodes), "0 for a single variable, which is sub-index 0", 8)
    writer.number("SUBCODE_HIGHEST", code.highest_subcode, "highest number of a subcode", 8)
    writer.data_type("", code.data_type, code.type_name, code.length)
    writer.access("", access_flags(code), ", ".join(access_flags(code)))
    if code.scaling is not None:
        writer.number("SCALING", code.scaling, "wire value = value * this")
    writer.limits("", code.range, code.scaling or 1, code.data_type, in_hex)
    for run in code_defaults(code):
        start = "" if run.shared else _sub_prefix(run.first, run.last)
        writer.default(start, run.value, run.follows, code.data_type, in_hex)
    parts = [(sub.number, sub.name) for sub in code.subcodes]
    writer.parts(parts)
    writer.options("OPT", code.options, code.data_type)
    for subcode in code.subcodes:
        writer.options(f"SUB{subcode.number}_OPT", subcode.options, code.data_type)
    writer.bits("", code.bits, code.data_type)
    writer.fields("", code.fields, code.data_type)
    return writer.section(
        f"{code.designation} {code.name}",
        [
            code.description,
            sentence("Subcodes: ", listed(parts)),
            listed([(sub.number, sub.description) for sub in code.subcodes]),
            " ".join(filter(None, _code_facts(code))),
            cited(code.cite, code.origin),
            *errata(device, code.errata, {"code": code.number, "index": code.index}),
        ],
    )


def _code_facts(code: Code) -> Iterator[str]:
    yield f"Full name: {code_name(code)}."
    yield sentence("Slot: ", code.slot)
    yield sentence("Objects: ", ", ".join(map(str, code.objects)))
    yield sentence("From software version ", code.since)
    if code.default_cite:
        yield f"Default: {cited(code.default_cite)}"
    if code.internal:
        yield "Device-internal, not for users."


def access_flags(code: Code) -> tuple[str, ...]:
    """Access flags of a code."""
    return (*["read"] * code.access.read, *["write"] * code.access.write, *code.access.conditions)


@dataclass(frozen=True, slots=True)
class DefaultRun:
    """Default of the subcodes ``first`` ... ``last``; 0 for a single variable.

    ``shared``: it is that of all subcodes.  ``follows``: rule over the node address.
    """

    first: int
    last: int
    value: Default | None
    follows: NodeRelative | None
    shared: bool


def code_defaults(code: Code) -> list[DefaultRun]:
    """Defaults of a code, one where all subcodes share it."""

    def facts(sub: SubCode) -> tuple[Default | None, NodeRelative | None]:
        return code.default if sub.default is None else sub.default, sub.follows

    if len({facts(sub) for sub in code.subcodes}) > 1:
        found = runs(code.subcodes, lambda sub: sub.number, facts)
        ends = [DefaultRun(run[0].number, run[-1].number, *facts(run[0]), False) for run in found]
    elif code.subcodes:
        ends = [DefaultRun(code.subcodes[0].number, code.highest_subcode, *facts(code.subcodes[0]), True)]
    else:
        ends = [DefaultRun(0, 0, code.default, None, True)]
    return [run for run in ends if run.value is not None or run.follows is not None]


def _sub_prefix(first: int, last: int) -> str:
    return f"SUB{first}_" if first == last else f"SUB{first}_TO_{last}_"


def _object(entry: DictionaryObject, device: Device, prefix: str, names: Names) -> Section:
    designation = entry.designation.replace("-", "").replace(" ", "")
    writer = Writer(names, f"{prefix}_{designation}", f"Selection list of {entry.designation}", entry.where)
    writer.number("INDEX", entry.index, entry.designation, hexadecimal=entry.kind == "canopen")
    writer.number("SUBINDEX_COUNT", len(entry.subindexes), "sub-index 0 among them", 8)
    highest = max((sub.number for sub in entry.subindexes), default=0)
    writer.number("SUBINDEX_HIGHEST", highest, "highest number of a sub-index", 8)
    parts = [(sub.number, sub.name) for sub in entry.subindexes]
    if entry.object_type != "VAR":
        writer.parts(parts)
    mirrors = []
    for run in runs(entry.subindexes, lambda sub: sub.number, _subindex_facts):
        _subindex(run, writer)
        mirrors += [ref for sub in run for ref in sub.codes]
    ids = list(dict.fromkeys([*entry.errata, *(name for sub in entry.subindexes for name in sub.errata)]))
    return writer.section(
        f"{entry.designation} {entry.name}",
        [
            entry.description,
            sentence("Sub-indexes: ", listed(parts)),
            listed([(sub.number, sub.description) for sub in entry.subindexes]),
            sentence("Without function: ", ", ".join(str(sub.number) for sub in entry.subindexes if sub.unused)),
            f"Full name: {object_name(entry)}. {entry.object_type}.",
            sentence("Codes: ", references(sorted(set(mirrors)))),
            cited(entry.cite, entry.origin),
            *errata(device, ids, {"index": entry.index}),
        ],
    )


def _subindex_facts(sub: SubIndex) -> object:
    """What must be equal for sub-indexes to share their constants."""
    return (
        sub.data_type,
        sub.access,
        sub.default,
        sub.range,
        sub.options,
        sub.bits,
        sub.fields,
        sub.signature,
        sub.printed_type,
        sub.printed_access,
        sub.pdo_mapping,
        sub.abort,
    )


def _subindex(run: Sequence[SubIndex], writer: Writer) -> None:
    sub = run[0]
    start = _sub_prefix(sub.number, run[-1].number)
    in_hex = bool(sub.bits or sub.fields)
    writer.data_type(start, sub.data_type, sub.printed_type.canopen_name)
    writer.access(start, (*_OBJECT_ACCESS[sub.access], *["pdo_map"] * sub.pdo_mapping), sub.printed_access)
    writer.limits(start, sub.range, 1, sub.data_type, in_hex)
    writer.default(start, sub.default, None, sub.data_type, in_hex)
    if sub.signature is not None:
        writer.text(f"{start}SIGNATURE", sub.signature, "text to write")
    if sub.abort is not None:
        writer.number(f"{start}ABORT", sub.abort, "abort code of any access", 32, hexadecimal=True)
    writer.options(f"{start}OPT", sub.options, sub.data_type)
    writer.bits(start, sub.bits, sub.data_type)
    writer.fields(start, sub.fields, sub.data_type)


def error_symbols(device: Device, error: ErrorEntry) -> tuple[str, ...]:
    """Names of the constants of an error: one, or those of both ends of a run."""
    name = f"{_error_prefix(device, error, device.error_bits(error.kind))}_{error_name(error).upper()}"
    return (name,) if error.count == 1 else run_names(name)


def _error_prefix(device: Device, error: ErrorEntry, bits: int) -> str:
    word = "ERROR" if error.kind == "device" else error.kind.upper()
    return f"{device_prefix(device)}_{word}_{error.number:0{bits // 4}X}"


def _error(error: ErrorEntry, device: Device, bits: int, names: Names) -> Section:
    writer = Writer(names, _error_prefix(device, error, bits), "", error.where)
    label = error_name(error).upper()
    if error.count == 1:
        writer.number(label, error.number, "error number", bits, hexadecimal=True)
    else:
        writer.run(label, error.number, error.last, bits)
    return writer.section(
        f"0x{error.number:0{bits // 4}X} {error.name}",
        [
            error.description,
            *(f"Cause: {text}" for text in error.causes),
            *(f"Remedy: {text}" for text in error.remedies),
            " ".join(filter(None, _error_facts(error))),
            cited(error.cite, error.origin),
            *errata(device, error.errata, {"number": error.number}),
        ],
    )


def _error_facts(error: ErrorEntry) -> Iterator[str]:
    yield sentence("Preset response: ", error.response)
    yield sentence("Selectable: ", ", ".join(error.responses))
    yield sentence("Adjustable in ", references(error.adjustable_in))
    yield sentence("Error register: ", error.register)
