"""LEDs and DIP switches."""

from dataclasses import dataclass
from enum import Enum
from fractions import Fraction

from generator.model.citation import Cite, Origin, Where
from generator.model.reference import CodeRef


class Light(Enum):
    """What an LED does."""

    ANY = "any"
    """Not said, or without meaning in this row."""
    OFF = "off"
    ON = "on"
    FLICKER = "flicker"
    ON_OR_FLICKER = "on_or_flicker"
    """Lit steadily or flickering; the manual draws no line between the two."""
    BLINK = "blink"
    FLASH = "flash"


@dataclass(frozen=True, slots=True)
class Pattern:
    """A blink pattern.

    ``period``: seconds after which a blinking LED changes; ``flashes`` and ``pause``: number of flashes and seconds of
    darkness after them; ``None`` where the manual prints no time.  ``colour``: of an LED with several, as printed.
    """

    light: Light
    colour: str | None = None
    period: Fraction | None = None
    flashes: int | None = None
    pause: Fraction | None = None

    def overlaps(self, other: "Pattern") -> bool:
        """Whether an observer could take one for the other."""
        lights = {self.light, other.light}
        either = Light.ON_OR_FLICKER in lights and lights <= {Light.ON_OR_FLICKER, Light.ON, Light.FLICKER}
        return Light.ANY in lights or self == other or (either and self.colour == other.colour)


@dataclass(frozen=True, slots=True)
class Led:
    """An LED by its label on the module; ``name`` is what it shows ("" where nothing is printed)."""

    label: str
    colour: str
    name: str


@dataclass(frozen=True, slots=True, kw_only=True)
class IndicatorRow:
    """A row of an LED table: one pattern for each LED of the table, in its order."""

    patterns: tuple[Pattern, ...]
    state: str
    meaning: str
    origin: Origin
    cite: Cite
    where: Where


@dataclass(frozen=True, slots=True, kw_only=True)
class IndicatorTable:
    """LEDs that are read together."""

    id: str
    name: str
    leds: tuple[Led, ...]
    rows: tuple[IndicatorRow, ...]
    cite: Cite
    errata: tuple[str, ...]
    where: Where


@dataclass(frozen=True, slots=True, kw_only=True)
class SwitchRow:
    """A printed row: ``positions`` holds "1" (ON), "0" (OFF) or "x" (either) for each switch."""

    value: str
    positions: str
    where: Where


@dataclass(frozen=True, slots=True, kw_only=True)
class SwitchGroup:
    """Switches that set one thing.

    ``weights``: of each switch where the value is the sum of those that are ON, else empty.  ``valid``: first and last
    valid value of such a sum.
    """

    id: str
    name: str
    labels: tuple[str, ...]
    weights: tuple[int, ...]
    valid: tuple[int, int] | None
    unit: str
    sets: tuple[CodeRef, ...]
    rows: tuple[SwitchRow, ...]
    notes: tuple[str, ...]
    origin: Origin
    cite: Cite
    errata: tuple[str, ...]
    where: Where

    def sum(self, positions: str) -> int:
        """Sum of the weights of the switches that are ON."""
        return sum(w for w, p in zip(self.weights, positions, strict=True) if p == "1")
