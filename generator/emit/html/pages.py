"""Pages of the reference: the first page, and one page a device that is a composition of its entries."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from generator.emit.html.blocks import Fact, Group, Row, Table
from generator.emit.html.codes import code_group
from generator.emit.html.drive import DriveSection, drive_section
from generator.emit.html.errors import error_group
from generator.emit.html.ledger import ledger_groups
from generator.emit.html.links import Links
from generator.emit.html.objects import object_group
from generator.emit.html.text import NONE, Piece, Prose, joined, manual_link, through
from generator.model import Code, CodeRef, Device, DictionaryObject, ErrorEntry, Manual, Model

_OBJECT_KINDS = {"canopen": "CANopen object dictionary", "profidrive": "PROFIdrive parameters"}
_MANUAL_KINDS = {"public": "public document"}
_STATUSES = {"not-applicable": "without facts of this kind", "lost": "lost in the text dump", "pending": "not yet"}
_DEVICES = ("Device", "Type", "Bus", "Manual", "Edition", "Codes", "Objects", "Errors", "Errata")
_CHAPTERS = ("Chapter", "Title", "Page", "State", "Note")
_WEB = ("https://", "http://")


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
    """Groups of entries below one heading; ``lead`` says what is meant, "" where the title does."""

    id: str
    title: str
    lead: str
    groups: tuple[Group, ...]


@dataclass(frozen=True, slots=True)
class DevicePage:
    """Everything on the page of a device."""

    title: str
    release: Release
    after: Prose
    facts: tuple[Fact, ...]
    nav: tuple[NavItem, ...]
    sections: tuple[Section, ...]
    drive: DriveSection | None
    errata: Section


@dataclass(frozen=True, slots=True)
class Source:
    """A manual, standard or public document; ``tally`` sums up what became of its chapters."""

    id: str
    name: str
    title: str
    facts: tuple[Fact, ...]
    tally: str
    chapters: Table


@dataclass(frozen=True, slots=True)
class IndexPage:
    """Everything on the first page."""

    release: Release
    devices: Table
    sources: tuple[Source, ...]


def index_page(model: Model) -> IndexPage:
    """The first page: devices and sources."""
    manuals = {device.manual.id: device.manual for device in model.devices}.values()
    return IndexPage(
        release=_release(model, manuals),
        devices=Table("devices", _DEVICES, tuple(map(_device_row, model.devices))),
        sources=tuple(map(_source, model.manuals)),
    )


def _release(model: Model, manuals: Iterable[Manual]) -> Release:
    origin = "; ".join(f"{manual.title}, edition {manual.edition}" for manual in manuals)
    return Release(model.version, model.date, origin)


def _device_row(device: Device) -> Row:
    counts = (device.codes, device.objects, device.errors, device.errata)
    return Row(
        (
            (Piece(device.title, f"{device.id}.html"),),
            device.order_code,
            device.bus,
            (manual_link(device.manual.id),),
            _edition(device.manual),
            *(str(len(facts)) for facts in counts),
        )
    )


def _edition(manual: Manual) -> str:
    return manual.edition + (f", {manual.date}" if manual.date else "")


def _source(manual: Manual) -> Source:
    states = [_STATUSES.get(chapter.status or NONE, chapter.status or NONE) for chapter in manual.chapters]
    rows = tuple(
        Row((chapter.number, chapter.title, str(chapter.page or NONE), state, chapter.note or ""))
        for chapter, state in zip(manual.chapters, states, strict=True)
    )
    return Source(
        id=f"manual-{manual.id}",
        name=manual.id,
        title=manual.title,
        facts=tuple(_source_facts(manual)),
        tally=", ".join(f"{states.count(state)} {state}" for state in dict.fromkeys(states)),
        chapters=Table("chapters", _CHAPTERS, rows),
    )


def _source_facts(manual: Manual) -> Iterator[Fact]:
    yield Fact("Kind", _MANUAL_KINDS.get(manual.kind, manual.kind))
    yield Fact("Publisher", manual.publisher)
    yield Fact("Edition", manual.edition)
    if manual.date:
        yield Fact("Date", manual.date)
    if manual.document:
        yield Fact("Document", manual.document)
    if manual.pages is not None:
        yield Fact("Pages", str(manual.pages))
    if manual.url:
        yield Fact("Address", (Piece(manual.url, manual.url if manual.url.startswith(_WEB) else ""),))


def device_page(model: Model, device: Device) -> DevicePage:
    """The page of a device."""
    links = Links(device)
    codes = Section("codes", "Codes", "", _code_groups(links, device.codes))
    objects = Section("objects", "Objects", "", _object_groups(links, device.objects))
    errors = Section("errors", "Errors", "", _error_groups(links, device.errors))
    lead = "What is printed wrong, and what is used instead."
    errata = Section("errata", "Errata", lead, ledger_groups(links, device.errata))
    manual = device.manual
    return DevicePage(
        title=device.title,
        release=_release(model, [manual]),
        after=(f"{manual.title}, ", manual_link(manual.id), f", edition {_edition(manual)}"),
        facts=tuple(_facts(links, device)),
        nav=(
            _nav(codes, len(device.codes)),
            _nav(objects, len(device.objects)),
            _nav(errors, len(device.errors)),
            *([NavItem(Piece("Base drive", "#drive"))] if device.drive else []),
            _nav(errata, len(device.errata)),
        ),
        sections=(codes, objects, errors),
        drive=drive_section(links, device.drive) if device.drive else None,
        errata=errata,
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
