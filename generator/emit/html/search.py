"""The data that the search of the reference reads: one script, loaded when it is needed."""

import json
from collections.abc import Iterable, Iterator
from typing import Any

from generator.emit.html.frame import Frame
from generator.emit.html.links import Links
from generator.emit.html.places import page_of
from generator.emit.html.things import COUNT_WORDS, COUNTED, KINDS, LED_MARK, Spot, Thing, things
from generator.emit.html.topics import ALSO
from generator.model import Device, Drive, Model

_EVENT = "search-data"
"""How the script hands over its data without a name that all scripts share."""

_EXEMPLARY = ("code", "canopen", "device-error")
"""Kinds of things of which one is named to whoever finds nothing."""

_NOWHERE = -1
"""Stands for the device of a page that belongs to none."""


def search_data(model: Model, frames: Iterable[Frame]) -> str:
    """The script with everything that can be found.

    A row is (kind, device, name, further words, spots, single numbers of runs, parts).  A spot is (text, address, keys
    as ``Key`` writes them, apart by blanks, address of a part less its number).  A part is (number, name, further
    words); its text and keys are those of the whole with a slash and the number.  Empty ends of lists are left out.

    Args:
        model: For its devices.
        frames: Of all pages.  Those that are not about one entry are found by their titles.
    """
    data = {
        "kinds": [singular for singular, _ in KINDS.values()],
        "devices": [[device.id, device.order_code] for device in model.devices],
        "rows": [*_things(model), *_pages(model, frames)],
        "examples": _examples(model),
        "fields": {drive.id: _fields(drive) for drive in model.drives},
        "reported": [_reported(device) for device in model.devices],
        "leds": sorted({led.label.lower() for device in model.devices for it in device.indicators for led in it.leds}),
        "led": [list(KINDS).index("led"), LED_MARK],
        "counts": sorted(COUNT_WORDS),
        "counted": COUNTED,
        "also": ALSO,
    }
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"))
    return f'"use strict";\nwindow.dispatchEvent(new CustomEvent("{_EVENT}", {{ detail: {text} }}));\n'


def _examples(model: Model) -> list[str]:
    """Numbers that can be looked for: the first of some kinds in all of its notations."""
    shown: dict[str, Spot] = {}
    for device in model.devices:
        for thing in things(model, Links(device)):
            if thing.kind in _EXEMPLARY:
                shown.setdefault(thing.kind, thing.spots[0])
    return [text for spot in shown.values() for text in (spot.text, *spot.also)]


def _things(model: Model) -> Iterator[list[Any]]:
    for number, device in enumerate(model.devices):
        for thing in things(model, Links(device)):
            yield _row(number, thing)


def _row(device: int, thing: Thing) -> list[Any]:
    kind = list(KINDS).index(thing.kind)
    spots, others = ([_spot(spot) for spot in found] for found in (thing.spots, thing.others))
    parts = [_short([part.number, _line(part.name), _line(part.words)]) for part in thing.parts]
    return _short([kind, device, _line(thing.name), _line(thing.words), spots, others, parts])


def _spot(spot: Spot) -> list[Any]:
    return _short([spot.text, spot.href, " ".join(map(str, spot.keys)), spot.stem])


def _short(values: list[Any]) -> list[Any]:
    """Values without the empty ones at the end."""
    while values and values[-1] in ("", []):
        values = values[:-1]
    return values


def _line(text: str) -> str:
    return " ".join(text.split())


def _pages(model: Model, frames: Iterable[Frame]) -> Iterator[list[Any]]:
    """Rows for the pages with a title of their own; the overview of a device is found as the device."""
    overviews = {page_of(device): number for number, device in enumerate(model.devices)}
    for frame in frames:
        if not frame.title or frame.path in overviews:
            continue
        device = overviews[frame.nav.href] if frame.nav else _NOWHERE
        yield _row(device, Thing("page", frame.title, "", (Spot("", frame.path),)))


def _reported(device: Device) -> list[Any]:
    """Mask of the error numbers in the list, the drive that they are made by, the page that takes them apart."""
    if device.drive is None or not device.error_mask:
        return [0]
    return [device.error_mask, device.drive.id, page_of(device, "errors")]


def _fields(drive: Drive) -> list[Any]:
    """Fields of an error number: label, lowest and highest bit, names of values, whether it changes at run time."""
    names = {
        "response": {response.value: response.name for response in drive.responses},
        "module": {module.value: module.name for module in drive.modules},
    }
    return [
        [name, field.low, field.high, names.get(name, {}), int(name in drive.reported_fields)]
        for name, field in drive.error_fields
    ]
