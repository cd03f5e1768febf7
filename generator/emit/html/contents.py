"""Lists of everything, for readers without scripts: their browser finds any number or name on one page."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from generator.emit.html.links import Links
from generator.emit.html.places import page_of
from generator.emit.html.text import Piece
from generator.emit.html.things import KINDS, Part, Spot, Thing, things
from generator.model import Device, Model

PART = "index"
"""Part of the reference of a device that lists everything on it."""

_ITSELF = "device"


@dataclass(frozen=True, slots=True)
class ListedPart:
    """A subcode, a sub-index, or a number of a run; ``name`` is "" where it has none."""

    number: Piece
    name: str


@dataclass(frozen=True, slots=True)
class Listed:
    """A thing with its numbers, their other notations, its name and what it is divided into."""

    numbers: tuple[Piece, ...]
    also: str
    name: str
    parts: tuple[ListedPart, ...]


@dataclass(frozen=True, slots=True)
class Section:
    """Things of one kind."""

    id: str
    title: str
    items: tuple[Listed, ...]


@dataclass(frozen=True, slots=True)
class DeviceLists:
    """What there is of a device, by kind: links to the sections of its list, with how many things each has."""

    title: str
    href: str
    kinds: tuple[tuple[Piece, str], ...]


def sections(model: Model, device: Device) -> tuple[Section, ...]:
    """Everything on a device, by kind."""
    kinds: dict[str, list[Thing]] = {}
    for thing in things(model, Links(device)):
        if thing.kind == _ITSELF:
            continue
        kinds.setdefault(thing.kind, []).append(thing)
    ordered = ((kind, title) for kind, (_, title) in KINDS.items() if kind in kinds)
    return tuple(Section(f"all-{kind}", title, tuple(map(_listed, kinds[kind]))) for kind, title in ordered)


def listed(model: Model) -> tuple[DeviceLists, ...]:
    """Links to the lists of all devices."""
    return tuple(_lists(model, device) for device in model.devices)


def _lists(model: Model, device: Device) -> DeviceLists:
    page = page_of(device, PART)
    found = sections(model, device)
    kinds = tuple((Piece(it.title, f"{page}#{it.id}"), str(len(it.items))) for it in found)
    return DeviceLists(device.title, page if found else page_of(device), kinds)


def _listed(thing: Thing) -> Listed:
    return Listed(
        tuple(Piece(spot.text, spot.href) for spot in thing.spots),
        ", ".join(" = ".join(spot.also) for spot in thing.spots if spot.also),
        thing.name,
        (*_parts(thing.spots[0], thing.parts), *_singles(thing.others)),
    )


def _parts(spot: Spot, parts: Iterable[Part]) -> Iterator[ListedPart]:
    return (ListedPart(Piece(f"/{part.number}", f"{spot.stem}{part.number}"), part.name) for part in parts)


def _singles(spots: Iterable[Spot]) -> Iterator[ListedPart]:
    return (ListedPart(Piece(spot.text, spot.href), " ".join(spot.also)) for spot in spots)
