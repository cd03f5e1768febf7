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


def fits(row: str, positions: str) -> bool:
    """Whether two positions, either with "x" where a switch may be ON or OFF, can be the same.

    >>> fits("1x0", "110"), fits("1x0", "011")
    (True, False)
    """
    return all(p == q or "x" in (p, q) for p, q in zip(row, positions, strict=True))


@dataclass(frozen=True, slots=True, kw_only=True)
class SwitchRow:
    """A printed row: ``positions`` holds "1" (ON), "0" (OFF) or "x" (either) for each switch."""

    value: str
    positions: str
    where: Where

    def fits(self, positions: str) -> bool:
        """Whether the row is about ``positions``, "1" or "0" for each switch."""
        return fits(self.positions, positions)


@dataclass(frozen=True, slots=True)
class SwitchBlock:
    """Label of a block of switches on the module, and where the manual says it."""

    label: str
    cite: Cite


@dataclass(frozen=True, slots=True)
class Delivered:
    """How switches stand when the module is delivered: "1" (ON) or "0" (OFF) for each."""

    positions: str
    cite: Cite


@dataclass(frozen=True, slots=True)
class CodeCounts:
    """Positions, each as in a row, in which codes count and the switches do not."""

    positions: tuple[str, ...]
    codes: tuple[CodeRef, ...]
    cite: Cite


@dataclass(frozen=True, slots=True, kw_only=True)
class SwitchGroup:
    """Switches that set one thing.

    ``weights``: of each switch where the value is the sum of those that are ON, else empty.  ``valid``: first and last
    valid value of such a sum.  ``block``, ``delivered``, ``code_counts``: ``None`` where the manual does not say it.
    """

    id: str
    name: str
    labels: tuple[str, ...]
    weights: tuple[int, ...]
    valid: tuple[int, int] | None
    unit: str
    sets: tuple[CodeRef, ...]
    block: SwitchBlock | None
    delivered: Delivered | None
    code_counts: CodeCounts | None
    rows: tuple[SwitchRow, ...]
    notes: tuple[str, ...]
    origin: Origin
    cite: Cite
    errata: tuple[str, ...]
    where: Where

    def sum(self, positions: str) -> int:
        """Sum of the weights of the switches that are ON."""
        return sum(w for w, p in zip(self.weights, positions, strict=True) if p == "1")

    def code_decides(self, positions: str) -> bool:
        """Whether a code counts and not the switches in ``positions``."""
        return self.code_counts is not None and any(fits(row, positions) for row in self.code_counts.positions)
