"""Blink patterns of LEDs in words, in the notation of the spec, and as drawings that the style sheet moves."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from generator.emit.html.text import NONE, Piece, Prose, decimal
from generator.model import Led, Light, Model, Pattern

_UNTIMED_PERIOD = Fraction(1, 2)
_UNTIMED_PAUSE = Fraction(1)
_FLASH = Fraction(1, 5)
_FLICKER = (Fraction(1, 20), Fraction(1, 10), Fraction(1, 10), Fraction(1, 20), Fraction(1, 20), Fraction(3, 20))
"""Rhythms of the drawing, in seconds, where the manual prints none."""

_COUNTS = {1: "once", 2: "twice"}
_ONE_WORD = re.compile(r"[a-z]+")


@dataclass(frozen=True, slots=True)
class Frame:
    """A moment of a drawing at which the light changes: per cent of the whole as text, and whether it is lit after."""

    at: str
    lit: bool


@dataclass(frozen=True, slots=True)
class Animation:
    """Movement of a drawing by its name in the style sheet; ``seconds`` is how long it takes, as text."""

    name: str
    seconds: str
    frames: tuple[Frame, ...]


def lamp(led: Led, pattern: Pattern) -> Prose:
    """What an LED does: a drawing, the words for it, and the pattern as data."""
    if pattern.light is Light.ANY:
        return NONE
    drawing = Piece("", tag="span", css=lamp_css(led, pattern))
    return drawing, " ", words(pattern), " ", Piece(notation(pattern), tag="code")


def lamp_css(led: Led, pattern: Pattern) -> str:
    """Classes of the drawing of an LED."""
    return " ".join(["led", *_colour_class(led, pattern), _light_class(pattern)])


def words(pattern: Pattern) -> str:
    """The pattern as a sentence would say it.

    >>> words(Pattern(Light.FLASH, flashes=2, pause=Fraction(1)))
    'flashes twice, then 1 s dark'
    """
    colour = f" {pattern.colour}" if pattern.colour else ""
    match pattern.light:
        case Light.ANY:
            return "any"
        case Light.OFF:
            return "off"
        case Light.ON:
            return f"lit{colour}"
        case Light.FLICKER:
            return f"flickers{colour}"
        case Light.ON_OR_FLICKER:
            return f"lit or flickers{colour}"
        case Light.BLINK:
            return f"blinks{colour}" + (f", changes every {decimal(pattern.period)} s" if pattern.period else "")
        case Light.FLASH:
            count = pattern.flashes or 1
            flashes = f"flashes{colour} {_COUNTS.get(count, f'{count} times')}"
            return flashes + (f", then {decimal(pattern.pause)} s dark" if pattern.pause else "")


def notation(pattern: Pattern) -> str:
    """The pattern as the spec writes it.

    >>> notation(Pattern(Light.BLINK, "red", Fraction(1, 5)))
    'blink red 0.2 s'
    """
    parts = [pattern.light.value.replace("_", " "), *([pattern.colour] if pattern.colour else [])]
    if pattern.period is not None:
        parts += [decimal(pattern.period), "s"]
    if pattern.flashes is not None:
        parts.append(str(pattern.flashes))
    return " ".join(parts) + (f", {decimal(pattern.pause)} s off" if pattern.pause is not None else "")


def _colour_class(led: Led, pattern: Pattern) -> list[str]:
    colour = pattern.colour or led.colour
    return [colour] if _ONE_WORD.fullmatch(colour) else []


def _light_class(pattern: Pattern) -> str:
    """Class of the drawing: the light alone, or with it what the animation depends on."""
    match pattern.light:
        case Light.ANY:
            return "unknown"
        case Light.OFF:
            return "off"
        case Light.FLICKER:
            return "flicker"
        case Light.BLINK:
            return f"blink-{_milliseconds(pattern.period or _UNTIMED_PERIOD)}"
        case Light.FLASH:
            return f"flash-{pattern.flashes or 1}-{_milliseconds(pattern.pause or _UNTIMED_PAUSE)}"
        case _:
            return "on"


def _milliseconds(seconds: Fraction) -> int:
    return round(seconds * 1000)


def animations(model: Model) -> tuple[Animation, ...]:
    """Every movement that the drawings of a model need, by name."""
    patterns = (
        pattern
        for device in model.devices
        for table in device.indicators
        for row in table.rows
        for pattern in row.patterns
    )
    moving = {_light_class(pattern): _rhythm(pattern) for pattern in patterns}
    return tuple(_animation(name, rhythm) for name, rhythm in sorted(moving.items()) if rhythm)


def _rhythm(pattern: Pattern) -> tuple[Fraction, ...]:
    """Seconds lit, dark, lit, dark, ...; nothing where the light does not change."""
    match pattern.light:
        case Light.FLICKER:
            return _FLICKER
        case Light.BLINK:
            return (pattern.period or _UNTIMED_PERIOD,) * 2
        case Light.FLASH:
            flashes = (_FLASH,) * (2 * (pattern.flashes or 1) - 1)
            return (*flashes, pattern.pause or _UNTIMED_PAUSE)
        case _:
            return ()


def _animation(name: str, rhythm: Iterable[Fraction]) -> Animation:
    parts = tuple(rhythm)
    whole = sum(parts, Fraction(0))
    starts = [sum(parts[:position], Fraction(0)) for position in range(len(parts))]
    frames = tuple(
        Frame(decimal(Fraction(round(start / whole * 10000), 100)), position % 2 == 0)
        for position, start in enumerate(starts)
    )
    return Animation(name, decimal(whole), frames)
