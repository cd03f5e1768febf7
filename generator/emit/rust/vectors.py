"""Tests that the crate brings along: the worked telegrams of a manual, and random bytes through every layout."""

from collections.abc import Sequence

from generator.codec import decode, encode
from generator.emit.environment import render
from generator.emit.rust import words
from generator.emit.rust.syntax import Expression, array, declaration, doc, hexadecimal, prefixed, struct
from generator.emit.rust.telegrams import entry_name, field_name, field_type, telegram_name
from generator.emit.rust.views import RandomTest, Vector
from generator.model import Device, Example, Field, FieldType, Layout, Values
from generator.model.telegram import OPEN, Value
from generator.naming import Scope, safe, snake


def vector_file(device: Device, module: str, title: str, notice: str) -> str:
    """Text of the test program of a device that has layouts.

    Raises:
        EmitError: Two worked telegrams want one name.
    """
    layouts = {layout.id: layout for layout in device.layouts}
    scope = Scope(f"tests of {module}")
    scope.add("random", device.where)
    vectors = [
        _vector(example, layouts[example.layout], scope.add(safe(snake(example.id), "rust"), example.where))
        for example in device.examples
    ]
    groups = any(field.type is FieldType.GROUP for layout in layouts.values() for field in layout.fields)
    return render(
        "rust/vectors.rs.j2",
        notice=notice,
        title=title,
        module=module,
        groups=groups and bool(vectors),
        vectors=vectors,
        random=_random(device),
    )


def fuzz_file(device: Device, module: str, notice: str) -> str:
    """Text of the fuzz target of a device that has layouts."""
    return render("rust/fuzz.rs.j2", notice=notice, module=module, telegrams=_random(device))


def _random(device: Device) -> list[RandomTest]:
    return [
        RandomTest(safe(snake(layout.id), "rust"), telegram_name(layout), str(_size(layout.fields)))
        for layout in device.layouts
    ]


def filled(layout: Layout, data: Sequence[int | None]) -> bytes:
    """Bytes of a worked telegram; those left open are 0, or what the constant of their field says."""
    constants = {field.name for field in layout.fields if field.constant is not None}
    values = {name: value for name, value in decode(layout, data).items() if not (value == OPEN and name in constants)}
    drawn = encode(layout, values)
    return bytes(octet if octet is not None else drawn[place] or 0 for place, octet in enumerate(data))


def _vector(example: Example, layout: Layout, name: str) -> Vector:
    data = filled(layout, example.data)
    telegram = telegram_name(layout)
    expected = _record(telegram, layout.fields, decode(layout, data))
    return Vector(
        name=name,
        doc=doc([words.headline(example.name)], [words.source(example.cite)]),
        data=declaration("DATA", "&[u8]", octets(data), 4, ""),
        expected=declaration("EXPECTED", telegram, expected, 4, ""),
        telegram=telegram,
        size=str(len(data)),
    )


def _record(name: str, fields: Sequence[Field], values: Values) -> Expression:
    own = [field for field in fields if field.constant is None]
    return struct(name, [(field_name(field), _literal(name, field, values[field.name])) for field in own])


def _literal(name: str, field: Field, value: Value) -> Expression:
    if isinstance(value, tuple):
        entries = [_record(entry_name(name, field), field.fields, entry) for entry in value]
        return prefixed("Repeated::new(", array(entries), ")")
    if isinstance(value, int):
        return hexadecimal(value, int(field_type(name, field)[1:]) // 4)
    return octets(value.encode("latin-1") if field.type is FieldType.TEXT else bytes.fromhex(value))


def octets(data: bytes) -> str:
    """Literal of a reference to an array of bytes."""
    text = data.decode("ascii") if data.isalnum() else "".join(f"\\x{octet:02X}" for octet in data)
    return f'b"{text}"'


def _size(fields: Sequence[Field]) -> int:
    """Largest random telegram: a few bytes more than the fields have, many where a length is open."""
    return 4 + sum(field.length if isinstance(field.length, int) else 24 for field in fields)
