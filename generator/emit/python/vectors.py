"""Test vectors: the worked telegrams of the manuals with the values that the layouts give them."""

from collections.abc import Iterator, Sequence

from generator.codec import decode, encode
from generator.emit.python.telegrams import class_name, field_name
from generator.emit.python.text import WIDTH, literal, wrap
from generator.emit.python.views import DeviceView, VectorView
from generator.model import Device, Example, Field, FieldType, Layout, Values


def vectors_of(view: DeviceView, device: Device) -> Iterator[VectorView]:
    """A vector for each worked telegram of the device."""
    layouts = {layout.id: layout for layout in device.layouts}
    for example in device.examples:
        layout = layouts[example.layout]
        data = filled(example, layout)
        fields = _fields(layout.fields, decode(layout, data))
        yield VectorView(
            id=literal(f"{device.id}-{example.id}"),
            module=literal(view.module),
            name=literal(class_name(layout)),
            data=literal(data.hex(" ").upper()),
            fields=wrap((f"{literal(name)}: {value}," for name, value in fields), WIDTH - 16),
        )


def filled(example: Example, layout: Layout) -> bytes:
    """Bytes of the example; those that the manual leaves open are the constant of their field, or else 0."""
    constants = encode(layout, example.values)
    return bytes(
        next((octet for octet in octets if octet is not None), 0)
        for octets in zip(example.data, constants, strict=True)
    )


def _fields(fields: Sequence[Field], values: Values) -> Iterator[tuple[str, str]]:
    """Names and literals of the fields, constants and parts included."""
    for field in fields:
        value = values[field.name]
        name = field_name(field)
        if isinstance(value, tuple):
            entries = (", ".join(f"{literal(n)}: {v}" for n, v in _fields(field.fields, entry)) for entry in value)
            yield name, f"[{', '.join(f'{{{entry}}}' for entry in entries)}]"
        elif isinstance(value, int):
            yield name, str(value)
        else:
            yield name, f"bytes.fromhex({literal(value)})" if field.type is FieldType.BYTES else literal(value)
