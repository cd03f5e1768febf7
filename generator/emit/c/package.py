"""What makes the headers a package: CMakeLists.txt, pkg-config file, README with an example that compiles."""

from collections.abc import Iterator
from dataclasses import dataclass

from generator.codec import decode
from generator.emit.c.device import device_prefix
from generator.emit.c.prose import provenance
from generator.emit.c.syntax import ascii_text, integer
from generator.emit.c.telegrams import filled, number_width
from generator.model import Device, Example, Layout, Model
from generator.naming import safe, snake


@dataclass(frozen=True, slots=True)
class Row:
    """A device in the list of the README."""

    title: str
    header: str
    manual: str


@dataclass(frozen=True, slots=True)
class Package:
    """View of the files beside the headers; ``programs`` and ``fuzzers`` are sources in test/ without their ending."""

    version: str
    notes: tuple[str, ...]
    rows: tuple[Row, ...]
    example: tuple[str, ...]
    programs: tuple[str, ...]
    fuzzers: tuple[str, ...]


def package(model: Model) -> Package:
    """View of the package."""
    makers = sorted({device.manufacturer for device in model.devices})
    with_layouts = [device.id for device in model.devices if device.layouts]
    programs = ["drivespec_selftest", *(f"{device.id}_selftest" for device in model.devices)]
    programs += [f"{name}_telegrams_selftest" for name in with_layouts]
    example = next((lines for device in model.devices if (lines := tuple(_example(device)))), ())
    return Package(
        version=model.version,
        notes=provenance(model, [device.manual for device in model.devices], makers),
        rows=tuple(
            Row(ascii_text(device.title), f"drivespec/{device.id}", ascii_text(device.manual.id))
            for device in model.devices
        ),
        example=example,
        programs=tuple(programs),
        fuzzers=tuple(f"{name}_telegrams_fuzz" for name in with_layouts),
    )


def _example(device: Device) -> Iterator[str]:
    """Program that decodes a worked telegram and names a code and an error; nothing where the device has too little."""
    found = _telegram(device)
    errors = [error for error in device.errors if error.kind == "device"]
    if found is None or not device.codes or device.drive is None or not errors or not device.error_mask:
        return
    example, layout, members = found
    octets = ", ".join(f"0x{octet:02X}" for octet in filled(layout, example.data))
    stem = snake(device.id, layout.id)
    code = device.codes[0]
    yield "#include <stdio.h>"
    yield f'#include "drivespec/{device.id}_tables.h"'
    yield f'#include "drivespec/{device.id}_telegrams.h"'
    yield ""
    yield "int main(void)"
    yield "{"
    yield f"    const uint8_t data[] = {{ {octets} }};"
    yield f"    {stem}_t telegram;"
    yield ""
    yield f"    if ({stem}_decode(data, sizeof data, &telegram) == DRIVESPEC_OK) {{"
    for member in members:
        yield f'        printf("{member}: %lu\\n", (unsigned long)telegram.{member});'
    yield "    }"
    found_code = f"{device.id}_find_code({device_prefix(device)}_{code.designation}_NUMBER)"
    found_error = f"{device.id}_find_reported_error({integer(errors[0].number, 32, hexadecimal=True)})"
    yield f'    printf("%s\\n", {device.id}_code_text({found_code}->name));'
    yield f'    printf("%s\\n", {device.id}_error_text({found_error}->name));'
    yield "    return 0;"
    yield "}"


def _telegram(device: Device) -> tuple[Example, Layout, tuple[str, ...]] | None:
    """First worked telegram whose bytes are all printed, with the names of its numbers that no C type cuts."""
    layouts = {layout.id: layout for layout in device.layouts}
    for example in device.examples:
        layout = layouts[example.layout]
        numbers = [field for field in layout.fields if field.constant is None and number_width(field) is not None]
        if None not in example.data and numbers and len(decode(layout, example.data)) > 1:
            return example, layout, tuple(safe(field.name, "c") for field in numbers)
    return None
