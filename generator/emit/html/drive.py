"""The base drive of a device as a section of its page: how its numbers are made, and what they mean."""

from collections.abc import Iterator
from dataclasses import dataclass

from generator.emit.html.blocks import Fact, Row, Table
from generator.emit.html.links import Links
from generator.emit.html.places import COMMANDS, command_id
from generator.emit.html.text import NONE, Piece, Prose, between, hexadecimal, joined, noted, shown_origin
from generator.model import CodeRef, Drive, DriveCommand, DriveModule, Origin, Response

_MODULE_BITS = 12
_INDEX_BITS = 16
_ERROR_BITS = 32


@dataclass(frozen=True, slots=True)
class TableSection:
    """A heading with a table below it."""

    id: str
    title: str
    table: Table


@dataclass(frozen=True, slots=True)
class DriveSection:
    """What is known of a base drive."""

    title: str
    facts: tuple[Fact, ...]
    parts: tuple[TableSection, ...]


def drive_section(links: Links, drive: Drive) -> DriveSection:
    """Section for a base drive."""
    parts = (
        TableSection("drive-error-number", "Layout of an error number", _layout(links, drive)),
        TableSection("drive-responses", "Responses to an error", _responses(links, drive)),
        TableSection("drive-modules", "Modules in an error number", _modules(links, drive)),
        TableSection(COMMANDS, "Device commands", _commands(links, drive)),
    )
    return DriveSection(drive.title, tuple(_facts(links, drive)), tuple(part for part in parts if part.table.rows))


def _facts(links: Links, drive: Drive) -> Iterator[Fact]:
    yield Fact("Maker", drive.manufacturer)
    yield Fact("Index of a code", noted(f"{drive.index_base} − code number", hexadecimal(drive.index_base)))
    yield Fact("Sources of the rule", joined([links.source(cite) for cite in drive.index_base_cites], "; "))
    if drive.command_code is not None:
        index = drive.index_base - drive.command_code
        code = f"{CodeRef(drive.command_code)}, index {index} = {hexadecimal(index, _INDEX_BITS)}"
        yield Fact("Device commands are written to", code)
        yield Fact("Sources of the code", joined([links.source(cite) for cite in drive.command_code_cites], "; "))


def _layout(links: Links, drive: Drive) -> Table:
    rows = tuple(
        Row(
            (
                name,
                between(str(field.high), str(field.low)),
                hexadecimal(field.mask, _ERROR_BITS),
                _marked(links.source(drive.error_fields_cite), drive.error_fields_origin),
            )
        )
        for name, field in drive.error_fields
    )
    return Table("layout", ("Field", "Bits", "Mask", "Source"), rows)


def _responses(links: Links, drive: Drive) -> Table:
    rows = tuple(Row((str(r.value), r.name, ", ".join(r.aliases) or NONE, _source(links, r))) for r in drive.responses)
    return Table("responses", ("Value", "Response", "Also called", "Source"), rows)


def _modules(links: Links, drive: Drive) -> Table:
    rows = tuple(
        Row((str(m.value), hexadecimal(m.value, _MODULE_BITS), m.name, _source(links, m))) for m in drive.modules
    )
    return Table("modules", ("Value", "Hex", "Module", "Source"), rows)


def _commands(links: Links, drive: Drive) -> Table:
    rows = tuple(
        Row((command_text(drive, c), c.name, _source(links, c)), id=command_id(c.value)) for c in drive.commands
    )
    return Table("commands", ("Value", "Command", "Source"), rows)


def command_text(drive: Drive, command: DriveCommand) -> str:
    """What is written for a command, "C00002 = 92"; the value alone where the code is not known."""
    code = "" if drive.command_code is None else f"{CodeRef(drive.command_code)} = "
    return f"{code}{command.value}"


def _source(links: Links, entry: Response | DriveModule | DriveCommand) -> Prose:
    return _marked(links.source(entry.cite), entry.origin)


def _marked(source: Prose, origin: Origin) -> Prose:
    mark = shown_origin(origin)
    return (*source, " ", Piece(mark, tag="em")) if mark else source
