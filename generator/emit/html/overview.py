"""The first page of a device: what it is, how to put it to work, its most wanted tables, and links to the rest."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from generator.emit.html.blocks import Drawing, Fact, Table
from generator.emit.html.downloads import Download, Offered, device_downloads
from generator.emit.html.links import Links
from generator.emit.html.places import named_id, page_of
from generator.emit.html.tables import drawn, printed_table
from generator.emit.html.text import Piece, Prose, joined, through
from generator.emit.html.topics import by_topic, title_of
from generator.emit.html.ways import (
    Figure,
    Way,
    figures,
    to_address,
    to_errors,
    to_files,
    to_leds,
    to_parameters,
    to_pins,
    to_tables,
    to_telegrams,
)
from generator.model import CodeRef, Device
from generator.model import Table as PrintedTable

_SHOWN = {"technical-data", "connector", "cable", "bus-length"}
"""Kinds of tables that are wanted most; they stand on this page as well."""
_STEPS: tuple[tuple[str, Callable[[Links], Sequence[Prose]]], ...] = (
    ("Connect it", to_pins),
    ("Set address and bit rate", to_address),
    ("Give the master its file", to_files),
    ("Read and write parameters", lambda links: [*to_parameters(links), *to_telegrams(links)]),
    ("Watch the LEDs", to_leds),
    ("Look up what it reports", to_errors),
)
"""What there is to do, in that order; steps for which nothing is known are left out."""


_MOST_NAMES = 4
"""More files of a kind are counted, not named."""


@dataclass(frozen=True, slots=True)
class ShownTable:
    """A table with its name, which leads to its place among the others."""

    name: Piece
    source: Prose
    drawing: Drawing | None
    table: Table


@dataclass(frozen=True, slots=True)
class Topic:
    """Tables of one topic; ``others`` are links to those that are not shown here, if any."""

    id: str
    title: str
    tables: tuple[ShownTable, ...]
    others: tuple[Prose, ...]


@dataclass(frozen=True, slots=True)
class Overview:
    """Everything on the page."""

    facts: tuple[Fact, ...]
    figures: tuple[Figure, ...]
    steps: tuple[Way, ...]
    files: tuple[Way, ...]
    files_href: str
    topics: tuple[Topic, ...]
    others: tuple[Way, ...]


def overview(links: Links, offered: Offered) -> Overview:
    """View of the first page of a device."""
    topics = by_topic(links.device.tables)
    shown = {topic for topic, tables in topics.items() if any(table.kind in _SHOWN for table in tables)}
    steps = (Way(title, tuple(way(links))) for title, way in _STEPS)
    return Overview(
        facts=tuple(_facts(links)),
        figures=tuple(figures(links)),
        steps=tuple(step for step in steps if step.places),
        files=tuple(_files(links.device, offered)),
        files_href=page_of(links.device, "files"),
        topics=tuple(_topic(links, topic, tables) for topic, tables in topics.items() if topic in shown),
        others=tuple(
            Way(title_of(topic), tuple(to_tables(links, tables)))
            for topic, tables in topics.items()
            if topic not in shown
        ),
    )


def _files(device: Device, offered: Offered) -> Iterator[Way]:
    """The files of a device by what they are for; where there are several of a kind, how many."""
    page = page_of(device, "files")
    for group in device_downloads(device, offered):
        kinds: dict[str, list[Download]] = {}
        for file in group.files:
            kinds.setdefault(file.name.rpartition(".")[2].upper(), []).append(file)
        places = [place for kind, files in kinds.items() for place in _places(files, kind, f"{page}#{group.id}")]
        yield Way(group.title, tuple(places))


def _places(files: Sequence[Download], kind: str, href: str) -> Iterator[Prose]:
    if len(files) > _MOST_NAMES:
        yield (Piece(f"{len(files)} {kind} files", href),)
    else:
        yield from ((Piece(file.name, file.href),) for file in files)


def _topic(links: Links, topic: str, tables: Sequence[PrintedTable]) -> Topic:
    shown = [table for table in tables if table.kind in _SHOWN]
    others = [table for table in tables if table.kind not in _SHOWN]
    return Topic(
        id=topic,
        title=title_of(topic),
        tables=tuple(_shown(links, table) for table in shown),
        others=tuple(to_tables(links, others)),
    )


def _shown(links: Links, table: PrintedTable) -> ShownTable:
    name = Piece(table.name, links.href(named_id("table", table.id)))
    return ShownTable(name, links.source(table.cite), drawn(links, table), printed_table(links, table, anchored=False))


def _facts(links: Links) -> Iterator[Fact]:
    device = links.device
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
