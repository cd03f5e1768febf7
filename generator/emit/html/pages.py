"""Pages of the reference, composed of entries: the first page, the sources, and those of each device."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeVar

from generator.emit.html.blocks import Entry, Fact, Group
from generator.emit.html.codenames import ErrorNames, code_names, object_names
from generator.emit.html.codes import code_entry, code_group
from generator.emit.html.contents import PART, DeviceLists, Section, listed, sections
from generator.emit.html.coverage import Coverage, coverage
from generator.emit.html.dip import Board, boards
from generator.emit.html.downloads import (
    DownloadGroup,
    Offered,
    all_downloads,
    device_downloads,
    packages,
)
from generator.emit.html.drive import DriveSection, drive_section
from generator.emit.html.errata import all_errata
from generator.emit.html.errors import error_entry, error_group
from generator.emit.html.files import FileSection, file_sections
from generator.emit.html.filters import SCRIPT as FILTER
from generator.emit.html.filters import Filter, filter_of
from generator.emit.html.finder import Finder, finder
from generator.emit.html.frame import Frame, NavItem, coverage_item, device_frame, site_frame
from generator.emit.html.home import home, not_found
from generator.emit.html.instruments import SCRIPT as WIRE
from generator.emit.html.instruments import Instruments, instruments
from generator.emit.html.ledger import ledger_groups
from generator.emit.html.links import Links
from generator.emit.html.objects import object_entry, object_group
from generator.emit.html.overview import overview
from generator.emit.html.panel import led_group, switch_group
from generator.emit.html.places import code_entries, code_id, error_entries, error_id, errors_group, object_id, page_of
from generator.emit.html.relations import Relations
from generator.emit.html.services import service_group
from generator.emit.html.sheet import PART as SHEET
from generator.emit.html.sheet import has_sheet, sheet
from generator.emit.html.tables import formula_group, table_groups
from generator.emit.html.telegrams import example_group, layout_group
from generator.emit.html.text import CONTENTS, COVERAGE, DOWNLOADS, ERRATA, INDEX, NONE, NOT_FOUND, Piece, plain
from generator.emit.html.wire import Bus, BusSection, code_bus, error_bus, object_bus
from generator.model import Code, Device, DictionaryObject, ErrorEntry, Model

T = TypeVar("T")
_Builder = Callable[[Links], Entry]
"""Makes an entry with its links as seen from a page."""

_OBJECT_KINDS = {"canopen": "CANopen object dictionary", "profidrive": "PROFIdrive parameters"}
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
    "files": "Downloads",
    SHEET: "Sheet to print",
}
"""Parts of the reference of a device in the order of its navigation."""
_LEADS = {
    "leds": "Each row gives a pattern in words, as the spec writes it, and drawn. "
    "Where the manual prints no time, the rhythm of the drawing is free.",
    "telegrams": "Offsets count bytes from 0; bit 0 is the least significant.",
    "errata": "What is printed wrong, what is used instead, why, and how sure that is.",
}
_FILTERED = {
    "codes": ("Data type", "Access"),
    "objects": ("Type",),
    "errors": ("Response",),
    "errata": ("Confidence",),
}
"""Parts that are filtered, with the columns by which that can be done."""
_PAGE_BY_PAGE = ("codes", "objects", "errors")
"""Parts whose entries have a page of their own each."""
_SCRIPTS = {"leds": ("panel.js",), "switches": ("panel.js",), "telegrams": (WIRE,), "errors": (WIRE,), "codes": (WIRE,)}
"""Scripts of the instruments of a part."""


@dataclass(frozen=True, slots=True)
class Page:
    """A page: its frame, the template that lays it out, and what it shows."""

    frame: Frame
    template: str
    view: object


@dataclass(frozen=True, slots=True)
class PartView:
    """Groups of entries; ``lead`` is "" where the title says enough.

    ``blinks``: it has drawings that move.  ``boards``, ``finder`` and ``instruments`` stand above the groups.
    """

    lead: str
    groups: tuple[Group, ...]
    blinks: bool
    filter: Filter | None
    boards: tuple[Board, ...] = ()
    finder: Finder | None = None
    instruments: Instruments | None = None


@dataclass(frozen=True, slots=True)
class EntryView:
    """The page of one entry, with its telegrams where it has any; ``names``: what generated code calls it."""

    entry: Entry
    bus: BusSection | None
    names: tuple[Fact, ...]


@dataclass(frozen=True, slots=True)
class FilesView:
    """Files of a device: where to get them, and what is in those for bus masters."""

    downloads: tuple[DownloadGroup, ...]
    sections: tuple[FileSection, ...]


@dataclass(frozen=True, slots=True)
class DriveView:
    """What is known of the base drive of a device."""

    drive: DriveSection


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


def pages(model: Model, offered: Offered) -> Iterator[Page]:
    """Every page of the reference; ``offered`` are the files beside it."""
    devices = [Links(device) for device in model.devices]
    yield _index(model, devices)
    yield _coverage(model)
    yield _errata(model, devices)
    yield _downloads(model, offered)
    yield _not_found(model, devices)
    yield _contents(model)
    for links in devices:
        yield from _device_pages(model, links, Relations(links, devices), offered)


def _index(model: Model, devices: Sequence[Links]) -> Page:
    title = "Drive communication modules, transcribed"
    names = ", ".join(device.title for device in model.devices)
    frame = site_frame(model, INDEX, title, f"Codes, objects, errors, LEDs, switches and telegrams of {names}.")
    return Page(frame, "index", home(model, [links.on(frame.path) for links in devices]))


def _errata(model: Model, devices: Sequence[Links]) -> Page:
    description = "What the manuals print wrong, what is used instead and how sure that is, by manual and by kind."
    frame = site_frame(model, ERRATA, "Errata of all manuals", description, scripts=(FILTER,))
    return Page(frame, "errata", all_errata([links.on(frame.path) for links in devices]))


def _downloads(model: Model, offered: Offered) -> Page:
    description = "EDS, XDD, GSD and JSON files, C, Python and Rust libraries, with sizes and SHA-256 digests."
    frame = site_frame(model, DOWNLOADS, "Downloads", description)
    return Page(frame, "downloads", FilesView(all_downloads(model, offered), ()))


def _not_found(model: Model, devices: Sequence[Links]) -> Page:
    frame = site_frame(
        model, NOT_FOUND, "There is no such page", "The address leads nowhere; ways to what you look for."
    )
    return Page(frame, "404", not_found([links.on(frame.path) for links in devices]))


def _coverage(model: Model) -> Page:
    title = "Coverage of the sources"
    frame = site_frame(model, COVERAGE, title, "What became of every chapter of every manual, and what is lost.")
    return Page(frame, "coverage", CoverageView(coverage(model)))


def _contents(model: Model) -> Page:
    title = "All entries"
    frame = site_frame(model, CONTENTS, title, "Lists of every code, object, error and other entry of all devices.")
    return Page(frame, "contents", ContentsView(listed(model)))


def _device_pages(model: Model, links: Links, relations: Relations, offered: Offered) -> Iterator[Page]:
    device = links.device
    files = FilesView(
        (*device_downloads(device, offered), *packages(offered)), file_sections(links.on(page_of(device, "files")))
    )
    parts = {part: groups for part in _TITLES if (groups := _groups(links.on(page_of(device, part)), part))}
    counts = {
        "codes": len(device.codes),
        "objects": len(device.objects),
        "errors": len(device.errors),
        "errata": len(device.errata),
    }
    known = {"", *parts}
    known |= {"drive"} if device.drive else set()
    known |= {"files"} if files.downloads or files.sections else set()
    known |= {SHEET} if has_sheet(device) else set()
    nav = [
        NavItem(title, page_of(device, part), str(counts.get(part, "")))
        for part, title in _TITLES.items()
        if part in known
    ]
    nav.append(coverage_item(device))
    brief = f"{device.title} ({device.order_code}): codes, objects, errors, LEDs, switches and telegrams."
    frame = device_frame(model, device, nav, title=device.title, description=brief)
    yield Page(frame, "device", overview(links.on(page_of(device)), offered))
    everything = sections(model, device)
    if everything:
        description = f"Every number and name of the {device.title} on one page."
        frame = device_frame(model, device, nav, part=PART, title="All entries", description=description)
        yield Page(frame, "everything", EverythingView(everything))
    for part, groups in parts.items():
        title = _TITLES[part]
        names = ", ".join(dict.fromkeys(group.title for group in groups))
        found = filter_of(groups, _FILTERED[part]) if part in _FILTERED else None
        frame = device_frame(
            model,
            device,
            nav,
            part=part,
            title=title,
            description=f"{title} of the {device.title}: {names}.",
            scripts=(*_SCRIPTS.get(part, ()), *((FILTER,) if found else ())),
        )
        yield Page(frame, "part", _part_view(model, links.on(frame.path), part, groups, found))
        if part in _PAGE_BY_PAGE:
            yield from _entry_pages(model, links, relations, nav, part)
    if device.drive:
        frame = device_frame(
            model, device, nav, part="drive", title=device.drive.title, description=f"{device.drive.title}: {brief}"
        )
        yield Page(frame, "drive", DriveView(drive_section(links.on(frame.path), device.drive)))
    if "files" in known:
        description = (
            f"Downloads for the {device.title}: files for bus masters, libraries and data, and what is in them."
        )
        frame = device_frame(model, device, nav, part="files", title=_TITLES["files"], description=description)
        yield Page(frame, "files", files)
    if SHEET in known:
        description = (
            f"The {device.title} on paper: switches, LEDs, errors with remedies, codes with index and default."
        )
        frame = device_frame(model, device, nav, part=SHEET, title=f"{device.title} on paper", description=description)
        yield Page(frame, "sheet", sheet(links.on(frame.path)))


def _part_view(model: Model, links: Links, part: str, groups: tuple[Group, ...], filtered: Filter | None) -> PartView:
    device = links.device
    return PartView(
        _LEADS.get(part, ""),
        groups,
        blinks=part == "leds",
        filter=filtered,
        boards=boards(links, device.switches) if part == "switches" else (),
        finder=finder(device.indicators) if part == "leds" else None,
        instruments=instruments(model, links, part),
    )


def _entry_pages(model: Model, links: Links, relations: Relations, nav: Sequence[NavItem], part: str) -> Iterator[Page]:
    """A page for every entry of a part, each with its neighbours in the list."""
    device = links.device
    bus = Bus(model, device)
    built = [(found, found.entry(links.on(found.path))) for found in _entries(device, relations, part)]
    pieces = [Piece(_named(entry), found.path) for found, entry in built]
    around = zip([None, *pieces], [*pieces[1:], None], strict=False)
    for (found, entry), piece, neighbours in zip(built, pieces, around, strict=True):
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
        yield Page(frame, "entry", EntryView(entry, found.telegrams(links.on(found.path), bus), found.names))


@dataclass(frozen=True, slots=True)
class _Entry:
    """An entry to come: path of its page, what builds it and its telegrams, and what generated code calls it."""

    path: str
    entry: _Builder
    telegrams: Callable[[Links, Bus], BusSection | None]
    names: tuple[Fact, ...]


def _entries(device: Device, relations: Relations, part: str) -> Iterator[_Entry]:
    """Every entry of a part."""
    match part:
        case "codes":
            for codes in code_entries(device.codes):
                path = page_of(device, code_id(codes[0].number))
                names = code_names(device, codes)
                yield _Entry(
                    path, _related(code_entry, relations.of_codes, codes), partial(code_bus, entry=codes), names
                )
        case "objects":
            for found in device.objects:
                path = page_of(device, object_id(found))
                names = object_names(device, found)
                yield _Entry(
                    path, _related(object_entry, relations.of_object, found), partial(object_bus, entry=found), names
                )
        case "errors":
            error_names = ErrorNames(device)
            for errors in error_entries(device, device.errors):
                path = page_of(device, error_id(errors[0].kind, errors[0].number))
                names = error_names.of(errors)
                yield _Entry(
                    path, _related(error_entry, relations.of_errors, errors), partial(error_bus, entry=errors), names
                )


def _related(build: Callable[[Links, T], Entry], add: Callable[[T, Links, Entry], Entry], thing: T) -> _Builder:
    """Builder of an entry with all that has to do with it."""
    return lambda links: add(thing, links, build(links, thing))


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
            groups = [
                layout_group(links, device.layouts),
                service_group(links, device.services),
                example_group(links, device.examples),
            ]
        case "tables":
            groups = [*table_groups(links, device.tables), formula_group(links, device.formulas)]
        case "errata":
            return ledger_groups(links, device.errata)
        case _:
            return ()
    return tuple(group for group in groups if group.entries)


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
    return tuple(error_group(links, errors_group(kind), kind, found) for kind, found in kinds.items())
