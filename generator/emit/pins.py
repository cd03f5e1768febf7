"""Public names of the last release: programs that use them must build, and mean the same, with the next one."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from generator.emit import names
from generator.emit.base import EmitError
from generator.model import Bit, BitField, Device, Field, Model, Option
from generator.naming import snake


def public_names(device: Device) -> dict[str, int]:
    """Names of a device with the numbers that they stand for, whatever the language: 0 for a field of a telegram.

    A name within another is behind a dot: ``c13351_can_baud_rate.500_kbps``.
    """
    return dict(_entries(device))


def broken(model: Model) -> Iterator[EmitError]:
    """Pinned names that are gone or mean something else."""
    found = {device.id: public_names(device) for device in model.devices}
    for pin in model.pins:
        number = found.get(pin.device, {}).get(pin.name)
        if number == pin.number:
            continue
        now = "is gone" if number is None else f"stood for {pin.number}, now for {number}"
        yield EmitError(
            "name-pinned",
            pin.where,
            f"'{pin.name}' of release {pin.version} {now}",
            "keep the label; for a release that may break programs, write the names anew: python -m generator pin",
        )


def text(model: Model) -> str:
    """Content of spec/names.yaml for the model."""
    lines = [
        '# Public names of the release, written by "python -m generator pin".',
        f"version: {model.version}",
        "devices:" if model.devices else "devices: {}",
    ]
    for device in model.devices:
        entries = public_names(device)
        lines.append(f"  {device.id}:" if entries else f"  {device.id}: {{}}")
        lines += [f"    {name}: {number}" for name, number in entries.items()]
    return "\n".join(lines) + "\n"


def _entries(device: Device) -> Iterator[tuple[str, int]]:
    for code in device.codes:
        name = names.code_name(code)
        yield name, code.number
        yield from _values(name, code.options, code.bits, code.fields)
        for sub in code.subcodes:
            yield from _values(f"{name}.{sub.number}", sub.options)
    for entry in device.objects:
        yield names.object_name(entry), entry.index
        for part in entry.subindexes:
            name = names.subindex_name(entry, part)
            yield name, part.number
            yield from _values(name, part.options, part.bits, part.fields)
    errors = [(f"error.{error.kind}.{names.error_name(error)}", error.number) for error in device.errors]
    count = Counter(name for name, _ in errors)
    for name, number in errors:
        yield (name if count[name] == 1 else f"{name}_{number:x}"), number
    for layout in device.layouts:
        yield from _fields(f"telegram.{snake(layout.id)}", layout.fields)


def _fields(prefix: str, fields: Iterable[Field]) -> Iterator[tuple[str, int]]:
    for field in fields:
        name = f"{prefix}.{snake(field.name)}"
        yield name, field.constant or 0
        yield from _values(name, field.values, (), field.bits)
        for part, options in field.bit_values:
            yield from _values(f"{name}.{snake(part)}", options)
        yield from _fields(name, field.fields)


def _values(
    prefix: str, options: Sequence[Option], bits: Sequence[Bit] = (), fields: Sequence[BitField] = ()
) -> Iterator[tuple[str, int]]:
    for option, name in zip(options, names.option_names(options), strict=True):
        yield f"{prefix}.{name}", option.value
    for bit, name in zip(bits, names.bit_names(bits), strict=True):
        yield f"{prefix}.bit.{name}", bit.number
    for field, name in zip(fields, names.field_names(fields), strict=True):
        yield f"{prefix}.field.{name}", field.mask
