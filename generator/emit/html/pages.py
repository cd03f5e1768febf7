"""Pages of the reference: the first page, the sources, and the pages of a device, which are composed of its entries."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from generator.emit.html.blocks import Fact, Group, Row, Table
from generator.emit.html.codes import code_group
from generator.emit.html.coverage import Coverage, coverage, edition, listed_sources
from generator.emit.html.drive import DriveSection, drive_section
from generator.emit.html.errors import error_group
from generator.emit.html.files import FileSection, file_names, file_sections, has_files
from generator.emit.html.ledger import ledger_groups
from generator.emit.html.links import Links, files_page, ledger_page, main_page, tables_page
from generator.emit.html.objects import object_group
from generator.emit.html.panel import led_group, switch_group
from generator.emit.html.tables import formula_group, table_group
from generator.emit.html.telegrams import example_group, layout_group
from generator.emit.html.text import COVERAGE, NONE, Piece, Prose, joined, manual_id, manual_link, through
from generator.model import Code, CodeRef, Device, DictionaryObject, ErrorEntry, Manual, Model

_OBJECT_KINDS = {"canopen": "CANopen object dictionary", "profidrive": "PROFIdrive parameters"}
_DEVICES = ("Device", "Type", "Bus", "Manual", "Edition", "Codes", "Objects", "Errors", "Errata", "Files")
_MAIN = "Codes, objects, errors"
_TABLES = "LEDs, switches, telegrams, tables"
_LEDGER = "Errata"
_FILES = "Files for bus masters"
_COVERAGE = "Coverage of the manual"
_ERRATA = "What is printed wrong, what is used instead, why, and how sure that is."
_LEDS = (
    "Each row gives a pattern in words, as the spec writes it, and drawn. "
    "Where the manual prints no time, the rhythm of the drawing is free."
)
_FILE_PARTS = (
    ("contents", "What is in them"),
    ("assumed", "What is assumed or left out, and why"),
    ("corrected", "What the manual contradicts"),
    ("import", "How to import them"),
)
_TELEGRAMS = "Offsets count bytes from 0; bit 0 is the least significant."


@dataclass(frozen=True, slots=True)
class Release:
    """What a page says of itself: version and date of the spec, and the manual that it is made from."""

    version: str
    date: str
    origin: str


@dataclass(frozen=True, slots=True)
class NavItem:
    """An entry of the navigation, with those below it; ``count`` is "" where nothing is counted."""

    link: Piece
    count: str = ""
    below: tuple["NavItem", ...] = ()


@dataclass(frozen=True, slots=True)
class Section:
    """Groups of entries below one heading; ``lead`` says what is meant, "" where the title does.

    ``blinks``: it has drawings that move, which a reader can stop.
    """

    id: str
    title: str
    lead: str
    groups: tuple[Group, ...]
    blinks: bool = False


@dataclass(frozen=True, slots=True)
class PageLink:
    """A page of a device; ``href`` is "" for the page that shows the link."""

    text: str
    href: str


@dataclass(frozen=True, slots=True)
class Head:
    """What the pages of a device have in common; ``after`` names the manual."""

    title: str
    subtitle: str
    release: Release
    after: Prose
    pages: tuple[PageLink, ...]


@dataclass(frozen=True, slots=True)
class DevicePage:
    """The page of a device with its codes, objects and errors."""

    head: Head
    facts: tuple[Fact, ...]
    nav: tuple[NavItem, ...]
    sections: tuple[Section, ...]
    drive: DriveSection | None

    @property
    def release(self) -> Release:
        """What the page says of itself."""
        return self.head.release


@dataclass(frozen=True, slots=True)
class SectionsPage:
    """A page of a device that is all sections of entries."""

    head: Head
    nav: tuple[NavItem, ...]
    sections: tuple[Section, ...]

    @property
    def release(self) -> Release:
        """What the page says of itself."""
        return self.head.release


@dataclass(frozen=True, slots=True)
class FilesPage:
    """The page of a device with its files for bus masters."""

    head: Head
    nav: tuple[NavItem, ...]
    sections: tuple[FileSection, ...]

    @property
    def release(self) -> Release:
        """What the page says of itself."""
        return self.head.release


@dataclass(frozen=True, slots=True)
class IndexPage:
    """Everything on the first page."""

    release: Release
    devices: Table
    sources: Table


@dataclass(frozen=True, slots=True)
class CoveragePage:
    """Everything on the page of the sources."""

    release: Release
    coverage: Coverage


def index_page(model: Model) -> IndexPage:
    """The first page: devices and sources."""
    return IndexPage(
        release=_release(model, _manuals(model)),
        devices=Table("devices", _DEVICES, tuple(map(_device_row, model.devices))),
        sources=listed_sources(model),
    )


def coverage_page(model: Model) -> CoveragePage:
    """The page of the sources."""
    return CoveragePage(_release(model, _manuals(model)), coverage(model))


def _manuals(model: Model) -> Iterable[Manual]:
    return {device.manual.id: device.manual for device in model.devices}.values()


def _release(model: Model, manuals: Iterable[Manual]) -> Release:
    origin = "; ".join(f"{manual.title}, edition {manual.edition}" for manual in manuals)
    return Release(model.version, model.date, origin)


def _device_row(device: Device) -> Row:
    counts = (device.codes, device.objects, device.errors)
    return Row(
        (
            (Piece(device.title, main_page(device)), " ", Piece(_TABLES, tables_page(device), "small")),
            device.order_code,
            device.bus,
            (manual_link(device.manual.id),),
            edition(device.manual),
            *(str(len(facts)) for facts in counts),
            (Piece(str(len(device.errata)), ledger_page(device)),),
            (Piece(str(len(file_names(device))), files_page(device)),) if has_files(device) else NONE,
        )
    )


def device_page(model: Model, device: Device) -> DevicePage:
    """The page of a device."""
    links = Links(device, main_page(device))
    codes = Section("codes", "Codes", "", _code_groups(links, device.codes))
    objects = Section("objects", "Objects", "", _object_groups(links, device.objects))
    errors = Section("errors", "Errors", "", _error_groups(links, device.errors))
    return DevicePage(
        head=_head(model, device, "", main_page(device)),
        facts=tuple(_facts(links, device)),
        nav=(
            _nav(codes, len(device.codes)),
            _nav(objects, len(device.objects)),
            _nav(errors, len(device.errors)),
            *([NavItem(Piece("Base drive", "#drive"))] if device.drive else []),
        ),
        sections=(codes, objects, errors),
        drive=drive_section(links, device.drive) if device.drive else None,
    )


def device_ledger_page(model: Model, device: Device) -> SectionsPage:
    """The page of a device with the ledger of its errata."""
    links = Links(device, ledger_page(device))
    errata = Section("errata", "Errata", _ERRATA, ledger_groups(links, device.errata))
    return SectionsPage(
        head=_head(model, device, _LEDGER, ledger_page(device)),
        nav=(_nav(errata, len(device.errata)),),
        sections=(errata,),
    )


def device_files_page(model: Model, device: Device) -> FilesPage:
    """The page of a device with its files for bus masters."""
    sections = file_sections(Links(device, files_page(device)))
    return FilesPage(
        head=_head(model, device, _FILES, files_page(device)),
        nav=tuple(map(_files_nav, sections)),
        sections=sections,
    )


def _files_nav(section: FileSection) -> NavItem:
    parts = tuple(NavItem(Piece(title, f"#{section.id}-{name}")) for name, title in _FILE_PARTS)
    return NavItem(Piece(section.title, f"#{section.id}"), below=parts)


def device_tables_page(model: Model, device: Device) -> SectionsPage:
    """The page of a device with what has a name alone: LEDs, switches, telegrams, tables and formulas."""
    links = Links(device, tables_page(device))
    leds = tuple(group for group in (led_group(links, device.indicators),) if group.entries)
    switches = tuple(group for group in (switch_group(links, device.switches),) if group.entries)
    telegrams = (layout_group(links, device.layouts), example_group(links, device.examples))
    tables = tuple(group for group in (table_group(links, device.tables),) if group.entries)
    formulas = tuple(group for group in (formula_group(links, device.formulas),) if group.entries)
    sections = (
        (Section("leds", "LEDs", _LEDS, leds, blinks=bool(leds)), len(device.indicators)),
        (Section("switches", "DIP switches", "", switches), len(device.switches)),
        (
            Section("telegrams", "Telegrams", _TELEGRAMS, tuple(group for group in telegrams if group.entries)),
            len(device.layouts) + len(device.examples),
        ),
        (Section("tables", "Tables", "", tables), len(device.tables)),
        (Section("formulas", "Formulas", "", formulas), len(device.formulas)),
    )
    return SectionsPage(
        head=_head(model, device, _TABLES, tables_page(device)),
        nav=tuple(_nav(section, count) for section, count in sections),
        sections=tuple(section for section, _ in sections),
    )


def _head(model: Model, device: Device, subtitle: str, page: str) -> Head:
    manual = device.manual
    pages = (
        (_MAIN, main_page(device)),
        (_TABLES, tables_page(device)),
        (_LEDGER, ledger_page(device)),
        *([(_FILES, files_page(device))] if has_files(device) else []),
        (_COVERAGE, f"{COVERAGE}#{manual_id(manual.id)}"),
    )
    return Head(
        title=device.title,
        subtitle=subtitle,
        release=_release(model, [manual]),
        after=(f"{manual.title}, ", manual_link(manual.id), f", edition {edition(manual)}"),
        pages=tuple(PageLink(text, "" if address == page else address) for text, address in pages),
    )


def _nav(section: Section, count: int) -> NavItem:
    parts = [NavItem(Piece(group.title, f"#{group.id}")) for group in section.groups]
    return NavItem(Piece(section.title, f"#{section.id}"), str(count), tuple(parts) if len(parts) > 1 else ())


def _facts(links: Links, device: Device) -> Iterator[Fact]:
    yield Fact("Type", device.order_code)
    yield Fact("Maker", device.manufacturer)
    yield Fact("Fieldbus", device.bus)
    if device.drive:
        yield Fact("Base drive", (Piece(device.drive.title, "#drive"),))
    if device.hardware_version:
        yield Fact("Hardware from", device.hardware_version)
    if device.software_version:
        yield Fact("Software from", device.software_version)
    for slot in device.slots:
        yield Fact(f"Slot {slot.name}", through(str(CodeRef(slot.first_code)), str(CodeRef(slot.last_code))))
    cites = [device.cite]
    can = device.canopen
    if can:
        yield Fact("Bit rates", f"{', '.join(map(str, can.baud_rates))} kbit/s")
        yield Fact("PDO granularity", f"{can.granularity} bit")
        yield Fact("Can be NMT master", "yes" if can.boot_up_master else "no")
        cites.append(can.cite)
    if can and can.node_address is not None:
        yield Fact("Node address in", (links.code(CodeRef(can.node_address)),))
    yield Fact("Sources" if len(cites) > 1 else "Source", joined([links.source(cite) for cite in cites], "; "))


def _code_groups(links: Links, codes: Sequence[Code]) -> tuple[Group, ...]:
    base = [code for code in codes if code.slot is None]
    module = [code for code in codes if code.slot is not None]
    parts = (("codes-base", "Codes of the base drive", base), ("codes-module", "Codes of the module", module))
    return tuple(code_group(links, name, title, found) for name, title, found in parts if found)


def _object_groups(links: Links, objects: Sequence[DictionaryObject]) -> tuple[Group, ...]:
    kinds: dict[str, list[DictionaryObject]] = {}
    for entry in objects:
        kinds.setdefault(entry.kind, []).append(entry)
    return tuple(
        object_group(links, f"objects-{kind}", _OBJECT_KINDS.get(kind, kind), found) for kind, found in kinds.items()
    )


def _error_groups(links: Links, errors: Sequence[ErrorEntry]) -> tuple[Group, ...]:
    kinds: dict[str, list[ErrorEntry]] = {}
    for error in errors:
        kinds.setdefault(error.kind, []).append(error)
    return tuple(error_group(links, f"errors-{kind.replace('_', '-')}", kind, found) for kind, found in kinds.items())
