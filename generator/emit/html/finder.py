"""From what the LEDs show to what it means: the patterns of each LED, and the rows of the LED tables they lead to."""

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from dataclasses import replace as changed

from generator.emit.html.lamps import lamp_css, notation, words
from generator.emit.html.places import named_id
from generator.model import IndicatorTable, Led, Light, Pattern

_OFF = Pattern(Light.OFF)


@dataclass(frozen=True, slots=True)
class Sight:
    """A pattern to choose: its key in addresses, the words for it, and the classes of its drawing."""

    key: str
    text: str
    css: str


@dataclass(frozen=True, slots=True)
class FinderLed:
    """An LED and all that it can show: its key in addresses, and the classes of its drawing while nothing is chosen."""

    id: str
    label: str
    about: str
    css: str
    sights: tuple[Sight, ...]


@dataclass(frozen=True, slots=True)
class Finder:
    """LEDs of a device in the order of the manual.

    ``data``: for scripts, each row of the tables by its anchor, with the keys of the sights of each LED that fit it.
    """

    leds: tuple[FinderLed, ...]
    data: dict[str, dict[str, list[str]]]


def finder(tables: Sequence[IndicatorTable]) -> Finder | None:
    """The finder over all LED tables of a device, ``None`` where it has none."""
    seen: dict[str, tuple[Led, set[Pattern]]] = {}
    for table in tables:
        for number, led in enumerate(table.leds):
            _, patterns = seen.setdefault(led.label, (led, {_OFF}))
            patterns.update(one for row in table.rows for one in _observed(row.patterns[number]))
    if not seen:
        return None
    leds = tuple(_led(led, sorted(patterns, key=_order)) for led, patterns in seen.values())
    return Finder(leds, dict(_rows(tables, seen)))


def _observed(pattern: Pattern) -> tuple[Pattern, ...]:
    """What a person can see of a pattern: either of two where the manual draws no line between them."""
    match pattern.light:
        case Light.ANY:
            return ()
        case Light.ON_OR_FLICKER:
            return changed(pattern, light=Light.ON), changed(pattern, light=Light.FLICKER)
        case _:
            return (pattern,)


def _order(pattern: Pattern) -> tuple[int, str]:
    return list(Light).index(pattern.light), notation(pattern)


def _led(led: Led, patterns: Iterable[Pattern]) -> FinderLed:
    sights = tuple(Sight(_key(notation(it)), words(it), lamp_css(led, it)) for it in patterns)
    about = f"{led.colour}, {led.name}" if led.name else led.colour
    return FinderLed(_key(led.label), led.label, about, lamp_css(led, Pattern(Light.ANY)), sights)


def _key(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")


def _rows(
    tables: Iterable[IndicatorTable], seen: dict[str, tuple[Led, set[Pattern]]]
) -> Iterator[tuple[str, dict[str, list[str]]]]:
    for table in tables:
        for number, row in enumerate(table.rows, 1):
            fitting = {
                _key(led.label): sorted(_key(notation(it)) for it in seen[led.label][1] if pattern.overlaps(it))
                for led, pattern in zip(table.leds, row.patterns, strict=True)
            }
            yield named_id("led", table.id, str(number)), fitting
