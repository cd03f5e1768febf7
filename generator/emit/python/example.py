"""Sessions for the README: telegrams, error numbers, switches and LEDs of a device, with what Python answers."""

from collections.abc import Iterator

from generator.codec import decode
from generator.emit.python.telegrams import class_name, field_name
from generator.emit.python.text import literal
from generator.emit.python.views import SessionView
from generator.model import Device, ErrorEntry, Example, IndicatorTable, Light, Pattern, SwitchGroup


def sessions(device: Device, module: str) -> tuple[SessionView, ...]:
    """Sessions with what the device has."""
    example = next((example for example in device.examples if _is_plain(device, example)), None)
    error = next((error for error in device.errors if error.kind == "device" and error.count > 1), None)
    group = next((group for group in device.switches if group.weights and group.rows), None)
    table = max(device.indicators, key=lambda table: len(table.leds), default=None)
    found = []
    if example is not None:
        found.append(SessionView(f"A telegram ({example.name}):", tuple(_telegram(device, module, example))))
    if error is not None:
        title = "An error number, whatever its fields for response and instance hold:"
        found.append(SessionView(title, tuple(_error(device, module, error))))
    if group is not None:
        title = f"DIP switches {', '.join(group.labels)} ({group.name}):"
        found.append(SessionView(title, tuple(_switches(module, group))))
    if table is not None:
        found.append(SessionView(f"What LEDs tell ({table.name}):", tuple(_leds(module, table))))
    return tuple(found)


def _is_plain(device: Device, example: Example) -> bool:
    """Whether the telegram has nothing but numbers, all of them known."""
    layout = next(layout for layout in device.layouts if layout.id == example.layout)
    numbers = all(isinstance(value, int) for value in example.values.values())
    return numbers and None not in example.data and all(field.constant is None for field in layout.fields)


def _telegram(device: Device, module: str, example: Example) -> Iterator[str]:
    layout = next(layout for layout in device.layouts if layout.id == example.layout)
    values = decode(layout, example.data)
    name = class_name(layout)
    octets = " ".join(f"{octet:02X}" for octet in example.data if octet is not None)
    first = layout.fields[0]
    yield f">>> telegram = {module}.{name}.decode(bytes.fromhex({literal(octets)}))"
    yield ">>> telegram"
    yield f"{name}({', '.join(f'{field_name(field)}={values[field.name]}' for field in layout.fields)})"
    yield '>>> telegram.encode().hex(" ").upper()'
    yield repr(octets)
    yield f'>>> {module}.{name}.decode(b"")'
    yield "Traceback (most recent call last):"
    yield "    ..."
    yield f"drivespec_devices.DecodeError: field {first.name!r} needs {first.length} bytes, 0 are left"


def _error(device: Device, module: str, error: ErrorEntry) -> Iterator[str]:
    number = error.last
    fields = () if device.drive is None else device.drive.error_fields
    yield f">>> {module}.error(0x{number:08X}).name"
    yield repr(error.name)
    if fields:
        yield f">>> {module}.error_parts(0x{number:08X})"
        yield repr({name: (number & field.mask) >> field.low for name, field in fields})


def _switches(module: str, group: SwitchGroup) -> Iterator[str]:
    row = group.rows[-1]
    value = row.value if row.value.isdecimal() else repr(row.value)
    yield f">>> {module}.SWITCHES[{literal(group.id)}].value({literal(row.positions)})"
    yield value
    yield f">>> {module}.SWITCHES[{literal(group.id)}].positions({value})"
    yield repr(row.positions)


def _leds(module: str, table: IndicatorTable) -> Iterator[str]:
    row = next((row for row in table.rows if all(_is_said(pattern) for pattern in row.patterns)), table.rows[0])
    looks = ", ".join(
        f"{literal(led.label)}: {literal(pattern.light.value)}"
        for led, pattern in zip(table.leds, row.patterns, strict=True)
    )
    states = [
        other.state
        for other in table.rows
        if all(a.light in (Light.ANY, b.light) for a, b in zip(other.patterns, row.patterns, strict=True))
    ]
    yield f">>> [row.state for row in {module}.INDICATORS[{literal(table.id)}].states({{{looks}}})]"
    yield repr(states)


def _is_said(pattern: Pattern) -> bool:
    return pattern.light in (Light.ON, Light.OFF)
