"""<device>_panel.h: DIP switches and LEDs; panel.h: what the panels of all devices share."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from generator.emit.c.device import device_prefix
from generator.emit.c.prose import cited, errata, provenance, references
from generator.emit.c.syntax import comment, integer, paragraph, string, text_size
from generator.emit.c.writer import Names, Section, Writer
from generator.emit.switches import remarks
from generator.model import Device, IndicatorTable, Light, Manual, Model, Pattern, SwitchGroup, SwitchRow, Where
from generator.naming import snake

LIGHTS = (Light.ANY, Light.OFF, Light.ON, Light.FLICKER, Light.BLINK, Light.FLASH, Light.ON_OR_FLICKER)
"""What an LED does by its value in the records; part of the interface, so append only."""

_EITHER = "x"
_MILLI = 1000
_HERE = Where("panel.h", 1, 1)
_FUNCTIONS = (
    "switch_row",
    "switch_row_at",
    "switch_sum",
    "pattern",
    "number_fits",
    "light_fits",
    "pattern_fits",
    "patterns_fit",
)
"""Ends of the names of the types and functions that the template holds."""


@dataclass(frozen=True, slots=True)
class SharedPanel:
    """View of panel.h; the sizes are those of the longest texts of all devices, so that no row has an address in it."""

    file: str
    guard: str
    brief: str
    notes: tuple[str, ...]
    section: Section
    text_size: str
    colour_size: str


@dataclass(frozen=True, slots=True)
class Group:
    """Switches that set one thing; ``rows`` and ``weights`` are the texts between the braces."""

    name: str
    title: str
    lines: tuple[str, ...]
    section: Section
    count: str
    rows: tuple[str, ...]
    weights: str
    low: str
    high: str


@dataclass(frozen=True, slots=True)
class Indicators:
    """LEDs that are read together; each row is the text between its braces."""

    name: str
    title: str
    lines: tuple[str, ...]
    count: str
    leds: str
    state_size: str
    rows: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Panel:
    """View of the panel of a device."""

    file: str
    guard: str
    brief: str
    notes: tuple[str, ...]
    device: str
    groups: tuple[Group, ...]
    indicators: tuple[Indicators, ...]


def shared_panel(model: Model, names: Names) -> SharedPanel:
    """View of panel.h."""
    guard = names.claim("DRIVESPEC_PANEL_H", _HERE)
    writer = Writer(names, "DRIVESPEC_LIGHT", "What an LED does", _HERE)
    for value, light in enumerate(LIGHTS):
        writer.number(light.value.upper(), value, light.value, 8)
    for function in _FUNCTIONS:
        names.claim(f"drivespec_{function}", _HERE)
    manuals: list[Manual] = [device.manual for device in model.devices if device.switches or device.indicators]
    notes = provenance(model, manuals, sorted({device.manufacturer for device in model.devices}))
    section = writer.section("What an LED does", ["Any: not said, or without meaning."])
    texts = [row.value for device in model.devices for group in device.switches for row in group.rows]
    colours = [
        pattern.colour or ""
        for device in model.devices
        for table in device.indicators
        for row in table.rows
        for pattern in row.patterns
    ]
    brief = "DIP switches and LEDs of all devices."
    return SharedPanel("panel.h", guard, brief, notes, section, _size(texts), _size(colours))


def device_panel(model: Model, device: Device, names: Names) -> Panel:
    """View of the panel of a device.

    Raises:
        EmitError: Rule "name-collision", when two facts would get one name.
    """
    return Panel(
        file=f"{device.id}_panel.h",
        guard=names.claim(f"DRIVESPEC_{device_prefix(device)}_PANEL_H", device.where),
        brief=comment(f"DIP switches and LEDs of the {device.title}."),
        notes=provenance(model, [device.manual], [device.manufacturer]),
        device=device.id,
        groups=tuple(_group(group, device, names) for group in device.switches),
        indicators=tuple(_indicators(table, device, names) for table in device.indicators),
    )


def _group(group: SwitchGroup, device: Device, names: Names) -> Group:
    name = snake(device.id, "switch", group.id)
    for suffix in ("rows", "weights", "row", "value", "position"):
        names.claim(f"{name}_{suffix}", group.where)
    writer = Writer(names, name.upper(), group.name, group.where)
    for bit, label in enumerate(reversed(group.labels)):
        writer.number(label.upper(), 1 << bit, f"switch {label}", 16, hexadecimal=True)
    lines = [f"Unit: {group.unit}." if group.unit else "", *remarks(group)]
    lines += [f"Sets {references(group.sets)}." if group.sets else "", cited(group.cite, group.origin)]
    lines += errata(device, group.errata, {})
    low, high = group.valid or (0, sum(group.weights))
    return Group(
        name=name,
        title=comment(group.name),
        lines=_paragraphs(lines),
        section=writer.section(group.name, ["A switch that is ON is a bit that is set; the last switch is bit 0."]),
        count=integer(len(group.labels), 8),
        rows=tuple(_row(row) for row in group.rows),
        weights=", ".join(integer(weight, 32) for weight in reversed(group.weights)),
        low=integer(low, 32),
        high=integer(high, 32),
    )


def _row(row: SwitchRow) -> str:
    mask = int("".join("0" if sign == _EITHER else "1" for sign in row.positions), 2)
    closed = int("".join("1" if sign == "1" else "0" for sign in row.positions), 2)
    number = int(row.value) if row.value.isdecimal() else 0
    return ", ".join(
        (
            string(row.value),
            integer(number, 32),
            integer(mask, 16, hexadecimal=True),
            integer(closed, 16, hexadecimal=True),
            "true" if row.value.isdecimal() else "false",
        )
    )


def _indicators(table: IndicatorTable, device: Device, names: Names) -> Indicators:
    name = snake(device.id, "led", table.id)
    for suffix in ("row", "rows", "next", "find"):
        names.claim(f"{name}_{suffix}", table.where)
    leds = "; ".join(
        f"{led.label} ({', '.join(text for text in (led.colour, led.name) if text)})" for led in table.leds
    )
    return Indicators(
        name=name,
        title=comment(table.name),
        count=names.claim(f"{name.upper()}_COUNT", table.where),
        lines=_paragraphs([f"LEDs: {leds}.", cited(table.cite), *errata(device, table.errata, {})]),
        leds=integer(len(table.leds), 8),
        state_size=_size([row.state for row in table.rows]),
        rows=tuple(
            f"{string(row.state)}, {{ {', '.join(f'{{ {_pattern(pattern)} }}' for pattern in row.patterns)} }}"
            for row in table.rows
        ),
    )


def _pattern(pattern: Pattern) -> str:
    return ", ".join(
        (
            string(pattern.colour or ""),
            _milliseconds(pattern.period),
            _milliseconds(pattern.pause),
            f"DRIVESPEC_LIGHT_{pattern.light.value.upper()}",
            integer(pattern.flashes or 0, 8),
        )
    )


def _size(texts: Sequence[str]) -> str:
    """Bytes of the longest of texts."""
    return integer(max(map(text_size, ["", *texts])), 16)


def _milliseconds(seconds: Fraction | None) -> str:
    return integer(round((seconds or 0) * _MILLI), 16)


def _paragraphs(texts: Sequence[str]) -> tuple[str, ...]:
    return tuple(line for text in texts if text for line in paragraph(text))
