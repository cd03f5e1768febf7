"""Pages of the reference, composed of entries: the first page, the sources, and those of each device."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from generator.emit.html.blocks import Entry, Fact, Group, Row, Table
from generator.emit.html.codenames import code_names, object_names
from generator.emit.html.codes import code_entry, code_group
from generator.emit.html.contents import PART, DeviceLists, Section, overview, sections
from generator.emit.html.coverage import Coverage, coverage, edition, listed_sources
from generator.emit.html.drive import DriveSection, drive_section
from generator.emit.html.errors import error_entry, error_group
from generator.emit.html.files import FileSection, file_names, file_sections, has_files
from generator.emit.html.frame import Frame, NavItem, coverage_item, device_frame, site_frame
from generator.emit.html.ledger import ledger_groups
from generator.emit.html.links import Links
from generator.emit.html.objects import object_entry, object_group
from generator.emit.html.panel import led_group, switch_group
from generator.emit.html.places import code_entries, code_id, error_entries, error_id, object_id, page_of
from generator.emit.html.tables import formula_group, table_group
from generator.emit.html.telegrams import example_group, layout_group
from generator.emit.html.text import COVERAGE, NONE, Piece, joined, manual_link, plain, through
from generator.model import Code, CodeRef, Device, DictionaryObject, ErrorEntry, Model

_OBJECT_KINDS = {"canopen": "CANopen object dictionary", "profidrive": "PROFIdrive parameters"}
_DEVICES = ("Device", "Type", "Bus", "Manual", "Edition", "Codes", "Objects", "Errors", "Errata", "Files")
_TITLES = {
    "": "Overview",
    "codes": "Codes",
    "objects": "Objects",
    "errors": "Errors",
    "leds": "LEDs",
    "switches": "DIP switches",
    "telegrams": "Telegrams",
    "tables": "Tables",
    "drive": "Base drive",
    "errata": "Errata",
    "files": "Files for bus masters",
}
"""Parts of the reference of a device in the order of its navigation."""
_LEADS = {
    "leds": "Each row gives a pattern in words, as the spec writes it, and drawn. "
    "Where the manual prints no time, the rhythm of the drawing is free.",
    "telegrams": "Offsets count bytes from 0; bit 0 is the least significant.",
    "errata": "What is printed wrong, what is used instead, why, and how sure that is.",
}
_WITH_PAGES = ("codes", "objects", "errors")
"""Parts whose entries have a page of their own each."""


@dataclass(frozen=True, slots=True)
class Page:
    """A page: its frame, the template that lays it out, and what it shows."""

    frame: Frame
    template: str
    view: object


@dataclass(frozen=True, slots=True)
class PartView:
    """Groups of entries; ``lead`` is "" where the title says enough.  ``blinks``: it has drawings that move."""

    lead: str
    groups: tuple[Group, ...]
    blinks: bool


@dataclass(frozen=True, slots=True)
class DeviceView:
    """The overview of a device."""

    facts: tuple[Fact, ...]


@dataclass(frozen=True, slots=True)
class EntryView:
    """The page of one entry; ``names``: what generated code calls it."""

    entry: Entry
    names: tuple[Fact, ...]


@dataclass(frozen=True, slots=True)
class FilesView:
    """Files of a device for bus masters."""

    sections: tuple[FileSection, ...]


@dataclass(frozen=True, slots=True)
class DriveView:
    """What is known of the base drive of a device."""

    drive: DriveSection


@dataclass(frozen=True, slots=True)
class IndexView:
    """Everything on the first page."""

    devices: Table
    sources: Table


@dataclass(frozen=True, slots=True)
class ContentsView:
    """Where everything is listed, device by device."""

    devices: tuple[DeviceLists, ...]


@dataclass(frozen=True, slots=True)
class EverythingView:
    """Everything on a device."""

    sections: tuple[Section, ...]


@dataclass(frozen=True, slots=True)
class CoverageView:
    """Everything on the page of the sources."""

    coverage: Coverage


def pages(model: Model) -> Iterator[Page]:
    """Every page of the reference."""
    yield _index(model)
    yield _coverage(model)
    yield _contents(model)
    for device in model.devices:
        yield from _device_pages(model, device)


def _index(model: Model) -> Page:
    title = "Drive communication modules, transcribed"
    names = ", ".join(device.title for device in model.devices)
    frame = site_frame(model, "index.html", title, f"Codes, objects, errors, LEDs, switches and telegrams of {names}.")
    view = IndexView(Table("devices", _DEVICES, tuple(map(_device_row, model.devices))), listed_sources(model))
    return Page(frame, "index", view)


def _coverage(model: Model) -> Page:
    title = "Coverage of the sources"
    frame = site_frame(model, COVERAGE, title, "What became of every chapter of every manual, and what is lost.")
    return Page(frame, "coverage", CoverageView(coverage(model)))


def _contents(model: Model) -> Page:
    title = "All entries"
    frame = site_frame(
        model, "contents.html", title, "Lists of every code, object, error and other entry of all devices."
    )
    return Page(frame, "contents", ContentsView(overview(model)))


def _device_row(device: Device) -> Row:
    facts = {"codes": device.codes, "objects": device.objects, "errors": device.errors, "errata": device.errata}
    return Row(
        (
            (Piece(device.title, page_of(device)),),
            device.order_code,
            device.bus,
            (manual_link(device.manual.id),),
            edition(device.manual),
            *((Piece(str(len(found)), page_of(device, part)),) if found else NONE for part, found in facts.items()),
            (Piece(str(len(file_names(device))), page_of(device, "files")),) if has_files(device) else NONE,
        )
    )


def _device_pages(model: Model, device: Device) -> Iterator[Page]:
    links = Links(device)
    parts = {part: groups for part in _TITLES if (groups := _groups(links.on(page_of(device, part)), part))}
    counts = {
        "codes": len(device.codes),
        "objects": len(device.objects),
        "errors": len(device.errors),
        "errata": len(device.errata),
    }
    known = {"", *parts, *(["drive"] if device.drive else []), *(["files"] if has_files(device) else [])}
    nav = [
        NavItem(title, page_of(device, part), str(counts.get(part, "")))
        for part, title in _TITLES.items()
        if part in known
    ]
    nav.append(coverage_item(device))
    overview = f"{device.title} ({device.order_code}): codes, objects, errors, LEDs, switches and telegrams."
    frame = device_frame(model, device, nav, title=device.title, description=overview)
    yield Page(frame, "device", DeviceView(tuple(_facts(links.on(page_of(device)), device))))
    everything = sections(model, device)
    if everything:
        description = f"Every number and name of the {device.title} on one page."
        frame = device_frame(model, device, nav, part=PART, title="All entries", description=description)
        yield Page(frame, "everything", EverythingView(everything))
    for part, groups in parts.items():
        title = _TITLES[part]
        names = ", ".join(dict.fromkeys(group.title for group in groups))
        frame = device_frame(
            model, device, nav, part=part, title=title, description=f"{title} of the {device.title}: {names}."
        )
        yield Page(frame, "part", PartView(_LEADS.get(part, ""), groups, blinks=part == "leds"))
        if part in _WITH_PAGES:
            yield from _entry_pages(model, links, nav, part)
    if device.drive:
        frame = device_frame(
            model, device, nav, part="drive", title=device.drive.title, description=f"{device.drive.title}: {overview}"
        )
        yield Page(frame, "drive", DriveView(drive_section(links.on(frame.path), device.drive)))
    if has_files(device):
        description = f"EDS, XDD and GSD files of the {device.title}: contents, assumptions, corrections and import."
        frame = device_frame(model, device, nav, part="files", title=_TITLES["files"], description=description)
        yield Page(frame, "files", FilesView(file_sections(links.on(frame.path))))


def _entry_pages(model: Model, links: Links, nav: Sequence[NavItem], part: str) -> Iterator[Page]:
    """A page for every entry of a part, each with its neighbours in the list."""
    device = links.device
    entries = [(path, entry(links.on(path)), names) for path, entry, names in _entries(device, part)]
    pieces = [Piece(_named(entry), path) for path, entry, _ in entries]
    around = zip([None, *pieces], [*pieces[1:], None], strict=False)
    for (_, entry, names), piece, neighbours in zip(entries, pieces, around, strict=True):
        frame = device_frame(
            model,
            device,
            nav,
            part=part,
            entry=entry.anchors[0].id,
            title=piece.text,
            description=_described(device, entry, piece.text),
            neighbours=neighbours,
        )
        yield Page(frame, "entry", EntryView(entry, names))


def _entries(device: Device, part: str) -> Iterator[tuple[str, Callable[[Links], Entry], tuple[Fact, ...]]]:
    """Path and builder of the page of every entry of a part, and what generated code calls the entry."""
    match part:
        case "codes":
            for codes in code_entries(device.codes):
                path = page_of(device, code_id(codes[0].number))
                yield path, partial(code_entry, entry=codes), code_names(device, codes)
        case "objects":
            for found in device.objects:
                path = page_of(device, object_id(found))
                yield path, partial(object_entry, entry=found), object_names(device, found)
        case "errors":
            for errors in error_entries(device, device.errors):
                name = error_id(errors[0].kind, errors[0].number)
                yield page_of(device, name), partial(error_entry, entry=errors), ()


def _named(entry: Entry) -> str:
    """Numbers and name of an entry on one line."""
    numbers = " / ".join(anchor.text for anchor in entry.anchors)
    return f"{numbers} {entry.name}" if entry.name else numbers


def _described(device: Device, entry: Entry, name: str) -> str:
    facts = ", ".join(f"{fact.label.lower()} {plain(fact.value)}" for fact in entry.facts if fact.value != NONE)
    return " ".join(part for part in (f"{device.order_code}, {name}.", plain(entry.lead), facts) if part)


def _groups(links: Links, part: str) -> tuple[Group, ...]:
    """Groups of a part; those without anything in them are left out."""
    device = links.device
    match part:
        case "codes":
            return _code_groups(links, device.codes)
        case "objects":
            return _object_groups(links, device.objects)
        case "errors":
            return _error_groups(links, device.errors)
        case "leds":
            groups = [led_group(links, device.indicators)]
        case "switches":
            groups = [switch_group(links, device.switches)]
        case "telegrams":
            groups = [layout_group(links, device.layouts), example_group(links, device.examples)]
        case "tables":
            groups = [table_group(links, device.tables), formula_group(links, device.formulas)]
        case "errata":
            return ledger_groups(links, device.errata)
        case _:
            return ()
    return tuple(group for group in groups if group.entries)


def _facts(links: Links, device: Device) -> Iterator[Fact]:
    yield Fact("Type", device.order_code)
    yield Fact("Maker", device.manufacturer)
    yield Fact("Fieldbus", device.bus)
    if device.drive:
        yield Fact("Base drive", (Piece(device.drive.title, page_of(device, "drive")),))
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
