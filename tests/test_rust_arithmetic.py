"""Arithmetic and look-ups of the Rust crate, against the model."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from math import floor
from pathlib import Path

import pytest
from rust_crate import Cargo, edge_indicators, edge_switches, edge_tables, texts

from generator.emit.rust import TARGET
from generator.emit.rust.syntax import constant_name, type_name
from generator.model import (
    Cite,
    Code,
    CodeRef,
    Device,
    Drive,
    ErrorEntry,
    IndicatorRow,
    Light,
    Model,
    Pattern,
    SwitchGroup,
)
from generator.model.citation import UNNAMED
from generator.naming import safe, snake


@pytest.fixture(scope="module")
def edge(model: Model) -> Model:
    device = next(device for device in model.devices if device.indicators and device.switches)
    changes = {
        "indicators": edge_indicators(device.indicators[0]),
        "switches": edge_switches(device.switches[0]),
        "tables": edge_tables(device.tables[0]),
    }
    return replace(model, devices=(replace(device, id="edge", **changes),))  # type: ignore[arg-type]


def check(cargo: Cargo, name: str, crate: Path, probes: Iterator[tuple[str, str]]) -> None:
    expected = dict(probes)
    assert expected
    assert cargo.probe(name, crate, ["types::*", "*"], list(expected)) == expected


def option(value: object) -> str:
    return "None" if value is None else f"Some({value})"


# Codes.


def test_scaling(cargo: Cargo, crate: Path, model: Model) -> None:
    check(cargo, "scaling", crate, (probe for device in model.devices for probe in scaling_probes(device)))


def scaling_probes(device: Device) -> Iterator[tuple[str, str]]:
    for code in device.codes:
        found = f"{device.id}::codes::TABLE.get({code.number}).unwrap()"
        bounds = limits(code)
        refused = f"Err(OutOfRange {{ limits: {option(bounds)} }})"
        if bounds is None:
            for call in ("to_wire(0.0)", "from_wire(0)", "check(0)"):
                yield f"{found}.{call}", refused
            continue
        low, high = bounds
        least, most = code.data_type.lowest, min(code.data_type.highest, 2**63 - 1)
        factor = code.scaling or 1
        for raw in {low, high, (low + high) // 2}:
            yield f"{found}.check({raw}_i64)", f"Ok({raw})"
            if abs(raw) < 2**53:
                yield f"{found}.from_wire({raw}_i64)", f"Ok({raw / factor!r})"
                yield f"{found}.to_wire({raw / factor!r})", f"Ok({raw})"
        for raw in (low - 1, high + 1):
            if abs(raw) < 2**53:
                outside = f"Err(OutOfRange {{ limits: Some(({least}, {most})) }})"
                yield f"{found}.check({raw}_i64)", refused
                yield f"{found}.to_wire({raw / factor!r})", refused
                yield f"{found}.from_wire({raw}_i64)", f"Ok({raw / factor!r})" if least <= raw <= most else outside
        for near in (low - 0.4, high + 0.4):  # The nearest number would do.
            if abs(near) < 2**40:
                yield f"{found}.to_wire({near / factor!r})", refused
        for value in ("f64::NAN", "f64::INFINITY", "f64::NEG_INFINITY", "1e300"):
            yield f"{found}.to_wire({value})", refused
        middle = (low + high) // 2
        if high - low > 2 and middle < 2**40:
            for part in (Fraction(3, 10), Fraction(7, 10)):
                nearest = floor(middle + part + Fraction(1, 2))
                yield f"{found}.to_wire({float((middle + part) / factor)!r})", f"Ok({nearest})"


def limits(code: Code) -> tuple[int, int] | None:
    if not code.data_type.is_number:
        return None
    low, high = code.data_type.lowest, min(code.data_type.highest, 2**63 - 1)
    if code.range:
        factor = code.scaling or 1
        low, high = max(low, -floor(-code.range.low * factor)), min(high, floor(code.range.high * factor))
    return low, high


def test_index_and_slot(cargo: Cargo, crate: Path, model: Model) -> None:
    check(cargo, "index", crate, (probe for device in model.devices for probe in index_probes(device)))


def index_probes(device: Device) -> Iterator[tuple[str, str]]:
    record = f"{device.id}::DEVICE"
    if device.drive:
        for code in device.codes:
            yield f"{record}.drive.unwrap().index({code.number})", f"Some({code.index})"
            yield f"{record}.drive.unwrap().number({code.index})", f"Some({code.number})"
            yield (
                f"{record}.slot_of({code.number}).map(|slot| slot.name)",
                option(json.dumps(code.slot) if code.slot else None),
            )
            names = [other.number for other in device.codes if other.name == code.name]
            quoted = json.dumps(code.name, ensure_ascii=False)
            yield f"{record}.codes.find({quoted}, None).map(|code| code.number)", f"Some({names[0]})"
            for slot in device.slots:
                inside = (None, slot.name)
                own = [other.number for other in device.codes if other.name == code.name and other.slot in inside]
                yield (
                    f"{record}.codes.find({quoted}, Some({json.dumps(slot.name)})).map(|code| code.number)",
                    option(own[0] if own else None),
                )
        yield f'{record}.codes.find("no such name", None).is_none()', "true"
        yield f"{record}.drive.unwrap().index({device.drive.index_base + 1})", "None"
    for position, slot in enumerate(device.slots):
        for code in device.codes:
            if code.twin_of == code.number and code.slot:
                moved = code.number + slot.code_offset
                yield f"{record}.slots[{position}].number({code.number})", f"Some({moved})"
        yield f"{record}.slots[{position}].number({slot.last_code - slot.code_offset + 1})", "None"
        yield f"{record}.slots[{position}].number(0)", "None"


# Identifiers and error numbers.


def test_identifiers(cargo: Cargo, crate: Path, model: Model) -> None:
    def probes() -> Iterator[tuple[str, str]]:
        assert model.cob_ids
        yield "cob_ids::TABLE.len()", str(len(model.cob_ids))
        for entry in model.cob_ids:
            found = f"cob_ids::{constant_name(snake(entry.name))}"
            for node in (1, 42, 127):
                yield f"{found}.at({node})", f"Some({entry.base if entry.broadcast else entry.base + node})"
                yield f"{found}.node({entry.base + node})", option(None if entry.broadcast else node)
            for node in (0, 128, 255):
                yield f"{found}.at({node})", option(entry.base if entry.broadcast else None)
                yield f"{found}.node({entry.base + node})", "None"
            yield f"({found}.base, {found}.broadcast)", f"({entry.base}, {str(entry.broadcast).lower()})"
            yield f"{found}.objects.len()", str(len(entry.objects))
            yield f"{found}.name", json.dumps(entry.name)
        assert {entry.broadcast for entry in model.cob_ids} == {True, False}
        for node, value in ((0, None), (1, 6), (127, 132), (128, None)):
            yield f"Value::NodeRelative(NodeRelative {{ base: 5 }}).at({node})", option(value)

    check(cargo, "identifiers", crate, probes())


def test_error_numbers(cargo: Cargo, crate: Path, model: Model) -> None:
    def probes() -> Iterator[tuple[str, str]]:
        for device in model.devices:
            if device.drive:
                for error in device.errors:
                    if error.kind == "device":
                        yield from fields(device.drive, error.number)
        for drive in model.drives:
            yield from fields(drive, 0xFFFF_FFFF)

    def fields(drive: Drive, number: int) -> Iterator[tuple[str, str]]:
        made = f"drives::{safe(snake(drive.id), 'rust')}::ErrorNumber({number})"
        for name, field in drive.error_fields:
            value, ones = number >> field.low & (1 << (field.high - field.low + 1)) - 1, field.mask >> field.low
            yield f"{made}.{name}()", str(value)
            yield f"{made}.with_{name}({ones - value}).map(|number| number.0)", f"Some({number ^ field.mask})"
            if ones < 2**32 - 1:
                yield f"{made}.with_{name}({ones + 1})", "None"

    check(cargo, "error-numbers", crate, probes())


def test_codes_that_set_a_response(cargo: Cargo, crate: Path, model: Model) -> None:
    def probes() -> Iterator[tuple[str, str]]:
        for device in model.devices:
            for kind in {error.kind for error in device.errors}:
                found = f"{device.id}::errors::{kind}::TABLE.codes_for"
                errors = [error for error in device.errors if error.kind == kind]
                beyond = 1 + max(error.last for error in errors)
                for number, codes in [(beyond, ()), *(pair for error in errors for pair in codes_by_number(error))]:
                    shown = json.dumps([str(code) for code in codes])
                    for reported in {number, number | reported_bits(device) if kind == "device" else number}:
                        yield f"{found}({reported}).iter().map(|code| code.to_string()).collect::<Vec<_>>()", shown

    expected = dict(probes())
    assert {0, 1, 2} <= {len(json.loads(shown)) for shown in expected.values()}
    check(cargo, "responses", crate, iter(expected.items()))


def codes_by_number(error: ErrorEntry) -> Iterator[tuple[int, tuple[CodeRef, ...]]]:
    numbers = range(error.number, error.last + 1)
    if len(error.adjustable_in) == len(numbers):
        yield from ((number, (code,)) for number, code in zip(numbers, error.adjustable_in, strict=True))
    else:
        yield from ((number, error.adjustable_in) for number in (error.number, error.last))


def reported_bits(device: Device) -> int:
    fields = dict(device.drive.error_fields) if device.drive else {}
    return sum(fields[name].mask for name in ("response", "instance") if name in fields)


def test_messages(cargo: Cargo, crate: Path, model: Model) -> None:
    """What a program prints to a person."""
    codes = [
        (limits(code), f"{device.id}::codes::TABLE.get({code.number}).unwrap()")
        for device in model.devices
        for code in device.codes
    ]
    (low, high), number = next((bounds, found) for bounds, found in codes if bounds)
    text = next(found for bounds, found in codes if bounds is None)
    outside = f"the wire value does not lie within {low} ... {high}"
    probes = {
        f"{number}.check({high + 1}).unwrap_err().to_string()": json.dumps(outside),
        f"{text}.to_wire(0.0).unwrap_err().to_string()": '"the code is a text, not a number"',
        'format!("{:>8}|", Light::Flash)': '"   flash|"',
        "CodeRef { number: 7, subcode: None }.to_string()": '"C00007"',
        "CodeRef { number: 13613, subcode: Some(2) }.to_string()": '"C13613/2"',
        "ObjectRef { index: 0x1A00, subindex: Some(0) }.to_string()": '"I-1A00/0"',
    }
    for cite in (Cite("M", "1.2", 3), Cite("M", "1.2"), Cite("M", UNNAMED, 3), Cite("M", UNNAMED)):
        made = f'manual: "M", chapter: "{cite.chapter}", page: {option(cite.page)}'
        probes[f"Cite {{ {made} }}.to_string()"] = f'"{cite}"'
    check(cargo, "messages", crate, iter(probes.items()))


# Switches, LEDs, tables.


def test_switches(cargo: Cargo, crate: Path, model: Model) -> None:
    check(cargo, "switches", crate, (probe for device in model.devices for probe in switch_probes(device)))


def test_switches_of_the_edge_cases(cargo: Cargo, edge: Model) -> None:
    crate = cargo.locked("edge-arithmetic", texts(TARGET.render(edge)))
    check(cargo, "edge-switches", crate, switch_probes(edge.devices[0]))


def switch_probes(device: Device) -> Iterator[tuple[str, str]]:
    for position, group in enumerate(device.switches):
        found = f"{device.id}::switches::GROUPS[{position}]"
        values: dict[int, list[int]] = {}
        for on in range(1 << len(group.labels)):
            value = set_value(group, on)
            yield f"{found}.value({on})", option(value)
            yield f"{found}.value({on | 1 << len(group.labels)})", "None"
            yield f"{found}.row({on | 1 << len(group.labels)})", "None"
            if value is not None:
                values.setdefault(value, []).append(on)
        for value, masks in values.items():
            known = ", ".join(map(str, masks))
            yield f"[{known}].contains(&{found}.switches({value}).unwrap())", "true"
        unused = next(value for value in range(10_000) if value not in values)
        yield f"{found}.switches({unused})", "None"


def set_value(group: SwitchGroup, on: int) -> int | None:
    """Value of switches that are ON; the mask reads as they are printed."""
    positions = f"{on:0{len(group.labels)}b}"
    if group.weights:
        value = group.sum(positions)
        return value if group.valid is None or group.valid[0] <= value <= group.valid[1] else None
    rows = [
        row.value for row in group.rows if all(a in ("x", b) for a, b in zip(row.positions, positions, strict=True))
    ]
    return int(rows[0]) if rows and rows[0].isdecimal() else None


def test_indicators(cargo: Cargo, crate: Path, model: Model) -> None:
    check(cargo, "indicators", crate, (probe for device in model.devices for probe in indicator_probes(device)))


def indicator_probes(device: Device) -> Iterator[tuple[str, str]]:
    """Each row as it is printed, without its details, and with each LED not looked at."""
    anything = Pattern(Light.ANY)
    for position, table in enumerate(device.indicators):
        found = f"{device.id}::indicators::TABLES[{position}]"
        for row in table.rows:
            printed = row.patterns
            looks = [printed, tuple(Pattern(pattern.light) for pattern in printed), ()]
            looks += [(*printed[:led], anything, *printed[led + 1 :]) for led in range(len(printed))]
            for seen in looks:
                yield from state_probes(found, seen, [other.state for other in table.rows if shows(other, seen)])
        unseen = tuple(Pattern(Light.FLASH, flashes=99) for _ in table.leds)
        yield from state_probes(found, unseen, [])


def shows(row: IndicatorRow, seen: tuple[Pattern, ...]) -> bool:
    return len(row.patterns) == len(seen) and all(map(may_be, row.patterns, seen))


def may_be(one: Pattern, other: Pattern) -> bool:
    either = [{Light.ON_OR_FLICKER, light} for light in (Light.ON, Light.FLICKER)]
    if Light.ANY in (one.light, other.light):
        return True
    details = ((getattr(one, name), getattr(other, name)) for name in ("colour", "period", "flashes", "pause"))
    return (one.light is other.light or {one.light, other.light} in either) and all(
        None in pair or pair[0] == pair[1] for pair in details
    )


def state_probes(found: str, seen: tuple[Pattern, ...], states: Sequence[str]) -> Iterator[tuple[str, str]]:
    given = f"&[{', '.join(map(pattern_text, seen))}]"
    quoted = [json.dumps(state, ensure_ascii=False) for state in states]
    yield f"{found}.states({given}).map(|row| row.state).collect::<Vec<_>>()", f"[{', '.join(quoted)}]"
    yield f"{found}.find({given}).map(|row| row.state)", option(quoted[0] if len(quoted) == 1 else None)


def pattern_text(pattern: Pattern) -> str:
    colour = option(json.dumps(pattern.colour) if pattern.colour else None)
    period, pause = (option(None if time is None else int(1000 * time)) for time in (pattern.period, pattern.pause))
    variant = pattern.light.value.title().replace("_", "")
    return (
        f"Pattern {{ light: Light::{variant}, colour: {colour}, period: {period}, "
        f"flashes: {option(pattern.flashes)}, pause: {pause} }}"
    )


def test_indicators_of_the_edge_cases(cargo: Cargo, edge: Model) -> None:
    off, flicker, anything = Pattern(Light.OFF), Pattern(Light.FLICKER), Pattern(Light.ANY)
    red, green = Pattern(Light.ON, colour="red"), Pattern(Light.ON, colour="green")
    slow, fast = Pattern(Light.BLINK, period=Fraction(1)), Pattern(Light.BLINK, "green", Fraction(1, 8))
    three, two = (Pattern(Light.FLASH, None, None, number, Fraction(5, 4)) for number in (3, 2))
    cases = {
        (red, off): ["red"],
        (green, off): [],
        (red, red): [],
        (Pattern(Light.ON), off): ["red"],
        (slow, flicker): ["slow"],
        (replace(slow, colour="green"), three): ["slow"],
        (fast, three): ["fast"],
        (fast, two): [],
        (fast, anything): ["fast"],
        (fast, Pattern(Light.FLASH)): ["fast"],
        (replace(fast, colour=None), three): ["fast"],
        (Pattern(Light.BLINK), three): ["slow", "fast"],
        (anything, two): ["slow", "dark"],
        (anything, anything): ["red", "slow", "fast", "dark"],
        (off, two): ["dark"],
        (off,): [],
        (off, off, off): [],
    }
    crate = cargo.locked("edge-arithmetic", texts(TARGET.render(edge)))
    found = "edge::indicators::TABLES[0]"
    check(cargo, "edge-indicators", crate, (pair for case in cases.items() for pair in state_probes(found, *case)))


NUMBERS = {
    ("e94aycca", "nmt-commands"): ("dec", "command"),
    ("e94aycca", "guarding-status"): ("value", "status"),
    ("e94aycca", "heartbeat-status"): ("value", "status"),
    ("e94aycen", "gci-data-types"): ("id", "type"),
    ("e94aycpm", "dpv1-formats"): ("value", "format"),
}
"""Tables of numbers: device and table, columns of the numbers and of the names."""


def test_numbers(cargo: Cargo, crate: Path, model: Model, edge: Model) -> None:
    def probes() -> Iterator[tuple[str, str]]:
        for (device_id, table_id), columns in NUMBERS.items():
            device = next(device for device in model.devices if device.id == device_id)
            table = next(table for table in device.tables if table.id == table_id)
            places = [next(n for n, known in enumerate(table.columns) if known.id == column) for column in columns]
            enum = f"{device_id}::numbers::{type_name(table_id)}"
            yield f"{enum}::ALL.len()", str(len(table.rows))
            for row in table.rows:
                number, label = (row[place] for place in places)
                number = number if isinstance(number, int) else int(number, 0)
                yield f"{enum}::from_raw({number}).map(|entry| entry.label())", f"Some({json.dumps(label)})"

    check(cargo, "numbers", crate, probes())
    files = TARGET.render(model)
    enums = sum(text.text.count("selection! {") for path, text in files.items() if path.endswith("/numbers.rs"))
    assert enums == len(NUMBERS)
    text = TARGET.render(edge)["src/edge/numbers.rs"].text
    assert text.count("selection! {") == 2
    assert 'XY = 16, "x y";' in text
    assert "    Hex: u16 {" in text
    assert "    Wide: u32 {" in text
