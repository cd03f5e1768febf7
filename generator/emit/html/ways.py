"""Ways from what a reader wants to do to the places of one device that help; a way is empty where there are none."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from generator.emit.html.errors import kind_title
from generator.emit.html.links import Links
from generator.emit.html.places import errors_group, named_id, page_of
from generator.emit.html.text import Piece, Prose
from generator.emit.html.topics import by_topic
from generator.model import CodeRef, Table

_CONNECTION = ("connector", "cable", "topology")
"""Kinds of tables that are wanted when a device is wired."""

_FIGURES = (
    ("codes", "code", "codes"),
    ("objects", "object", "objects"),
    ("errors", "error", "errors"),
    ("leds", "LED table", "LED tables"),
    ("switches", "DIP switch group", "DIP switch groups"),
    ("telegrams", "telegram", "telegrams"),
    ("tables", "table", "tables"),
    ("errata", "erratum", "errata"),
)

_Way = Sequence[Prose]


@dataclass(frozen=True, slots=True)
class Way:
    """Places that help with one thing."""

    label: str
    places: tuple[Prose, ...]


@dataclass(frozen=True, slots=True)
class Figure:
    """How many there are of a thing, and where they stand."""

    number: str
    noun: str
    href: str


def figures(links: Links) -> Iterator[Figure]:
    """How many entries each part of the reference of a device has."""
    device = links.device
    counts = {
        "codes": len(device.codes),
        "objects": len(device.objects),
        "errors": len(device.errors),
        "leds": len(device.indicators),
        "switches": len(device.switches),
        "telegrams": len(device.layouts),
        "tables": len(device.tables),
        "errata": len(device.errata),
    }
    for part, one, more in _FIGURES:
        if counts[part]:
            yield Figure(str(counts[part]), one if counts[part] == 1 else more, page_of(device, part))


def to_errors(links: Links) -> _Way:
    """Lists of error numbers."""
    device = links.device
    page = page_of(device, "errors")
    kinds = dict.fromkeys(error.kind for error in device.errors)
    return [(Piece(kind_title(kind), f"{page}#{errors_group(kind)}"),) for kind in kinds]


def to_leds(links: Links) -> _Way:
    """LED tables, by the labels of the LEDs."""
    tables = links.device.indicators
    return [
        (Piece(", ".join(led.label for led in table.leds), links.href(named_id("led", table.id))),) for table in tables
    ]


def to_parameters(links: Links) -> _Way:
    """Lists of codes and objects."""
    return _counted(links, "codes", "objects")


def to_telegrams(links: Links) -> _Way:
    """The list of telegrams."""
    return _counted(links, "telegrams")


def _counted(links: Links, *parts: str) -> _Way:
    pages = {page_of(links.device, part) for part in parts}
    return [
        (Piece(f"{figure.number} {figure.noun}", figure.href),) for figure in figures(links) if figure.href in pages
    ]


def to_address(links: Links) -> _Way:
    """DIP switches, the code of the node address, tables on addresses and bit rates."""
    device = links.device
    ways: list[Prose] = [(links.named_thing("switch", group.id, group.name),) for group in device.switches]
    if device.canopen and device.canopen.node_address is not None:
        ref = CodeRef(device.canopen.node_address)
        code = links.code_of(ref)
        ways.append((links.code(ref), f" {code.name}") if code else (links.code(ref),))
    return ways + to_tables(links, by_topic(device.tables).get("address", ()))


def to_pins(links: Links) -> _Way:
    """Pins, cables and what a network may consist of."""
    tables = [table for table in links.device.tables if table.kind in _CONNECTION]
    return to_tables(links, sorted(tables, key=lambda table: _CONNECTION.index(table.kind)))


def to_files(links: Links) -> _Way:
    """Files that a bus master imports."""
    device = links.device
    page = page_of(device, "files")
    found = (("canopen", "EDS and XDD", device.canopen), ("profibus", "GSD", device.gsd))
    return [(Piece(text, f"{page}#{anchor}"),) for anchor, text, facts in found if facts]


def to_tables(links: Links, tables: Sequence[Table]) -> list[Prose]:
    """Tables by their names."""
    return [(links.named_thing("table", table.id, table.name),) for table in tables]
