"""Telegrams by their layout: bytes to values and values to bytes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from generator.model.telegram import OPEN, Field, FieldType, Layout, Value, Values

_LONGEST = 0xFFFF


class CodecError(Exception):
    """Bytes or values that do not fit a layout; the text says which field and why."""


def decode(layout: Layout, data: Sequence[int | None]) -> Values:
    """Values of every field; a field with an open byte (``None``) has the value ``OPEN``.

    Raises:
        CodecError: Bytes are missing or left over, or a constant has another value.
    """
    values, position = _decode_fields(layout.fields, data, 0, {})
    if position != len(data):
        raise CodecError(f"{len(data) - position} bytes are left over after field '{layout.fields[-1].name}'")
    return values


def encode(layout: Layout, values: Values) -> tuple[int | None, ...]:
    """Bytes of the values; those of an open field are ``None``.

    Raises:
        CodecError: A value is missing, too large, or of another length than an earlier field says.
    """
    return tuple(_encode_fields(layout.fields, values, dict(values)))


@dataclass(frozen=True, slots=True)
class Span:
    """The bytes ``start`` ... ``stop`` - 1 of a telegram: those of one field, ``path`` being its name in the layout.

    ``values`` are those of the fields beside it; ``place`` is its name in the telegram, which counts repetitions.
    """

    path: str
    place: str
    field: Field
    start: int
    stop: int
    values: Values


def spans(layout: Layout, data: Sequence[int | None]) -> tuple[Span, ...]:
    """Every field with the bytes that it takes, in the order of the bytes.

    Raises:
        CodecError: The bytes do not fit the layout.
    """
    return tuple(_spans(layout, layout.fields, data, decode(layout, data), {}, 0, ("", "")))


def _spans(
    layout: Layout,
    fields: Sequence[Field],
    data: Sequence[int | None],
    values: Values,
    outer: Values,
    start: int,
    at: tuple[str, str],
) -> list[Span]:
    """Fields with the bytes that each takes; ``at`` is what stands before their names in layout and telegram."""
    found: list[Span] = []
    scope = {**outer, **values}
    for field in fields:
        path, place = at[0] + field.name, at[1] + field.name
        value = values[field.name]
        if isinstance(value, tuple):
            for number, entry in enumerate(value, 1):
                inner = (f"{path}.", f"{place}[{number}].")
                found += _spans(layout, field.fields, data, entry, scope, start, inner)
                start = found[-1].stop
            continue
        stop = start + _size(layout, field, value, scope, len(data) - start)
        found.append(Span(path, place, field, start, stop, values))
        start = stop
    return found


def _size(layout: Layout, field: Field, value: Value, scope: Values, left: int) -> int:
    """How many bytes a field takes: as many as it encodes to."""
    if value == OPEN and field.length is None and field.sizes is None:
        return left
    return len(encode(replace(layout, fields=(field,)), {**scope, field.name: value}))


def _decode_fields(
    fields: Sequence[Field], data: Sequence[int | None], position: int, outer: Values
) -> tuple[Values, int]:
    values: Values = {}
    for field in fields:
        scope = {**outer, **values}
        if field.type is FieldType.GROUP:
            values[field.name], position = _decode_group(field, data, position, scope)
            continue
        length = _length(field, scope)
        end = len(data) if length is None else position + length
        if end > len(data):
            raise CodecError(f"field '{field.name}' needs {end - position} bytes, {len(data) - position} are left")
        values[field.name] = value = _decode_value(field, data[position:end])
        if field.constant is not None and value not in (field.constant, OPEN):
            raise CodecError(f"field '{field.name}' is {value}, but must be {field.constant}")
        for bits in field.bits:
            part: Value = OPEN if value == OPEN or not isinstance(value, int) else (value & bits.mask) >> bits.low
            values[f"{field.name}.{bits.label}"] = part
        position = end
    return values, position


def _decode_group(
    field: Field, data: Sequence[int | None], position: int, scope: Values
) -> tuple[tuple[Values, ...], int]:
    count = _number(field.count, scope) if field.count is not None else None
    found: list[Values] = []
    while (count is None and position < len(data)) or (count is not None and len(found) < count):
        values, end = _decode_fields(field.fields, data, position, scope)
        if end == position:
            raise CodecError(f"an entry of group '{field.name}' has no bytes")
        found.append(values)
        position = end
    return tuple(found), position


def _decode_value(field: Field, octets: Sequence[int | None]) -> int | str:
    known = [octet for octet in octets if octet is not None]
    if len(known) != len(octets):
        return OPEN
    raw = bytes(known)
    if field.type is FieldType.TEXT:
        return raw.decode("latin-1")
    if field.type is FieldType.BYTES:
        return raw.hex(" ").upper()
    return int.from_bytes(raw, "big" if field.big else "little", signed=field.type is FieldType.INT)


def _encode_fields(fields: Sequence[Field], values: Values, scope: Values) -> list[int | None]:
    data: list[int | None] = []
    for field in fields:
        value = values.get(field.name, field.constant)
        if value is None:
            raise CodecError(f"field '{field.name}' has no value")
        scope[field.name] = value
        if field.type is FieldType.GROUP:
            data.extend(_encode_group(field, value, scope))
            continue
        length = _length(field, scope)
        octets = _encode_value(field, value, length)
        if length is not None and len(octets) != length:
            raise CodecError(f"field '{field.name}' has {len(octets)} bytes, its length is {length}")
        data.extend(octets)
    return data


def _encode_group(field: Field, value: Value, scope: Values) -> list[int | None]:
    if not isinstance(value, tuple):
        raise CodecError(f"group '{field.name}' needs a list")
    if field.count is not None and _number(field.count, scope) != len(value):
        raise CodecError(f"group '{field.name}' has {len(value)} entries, '{field.count}' says another number")
    return [octet for entry in value for octet in _encode_fields(field.fields, entry, {**scope, **entry})]


def _encode_value(field: Field, value: Value, length: int | None) -> list[int | None]:
    if value == OPEN and length is not None:
        return [None] * length
    if isinstance(value, int):
        try:
            raw = value.to_bytes(length or 0, "big" if field.big else "little", signed=field.type is FieldType.INT)
        except OverflowError:
            raise CodecError(f"{value} does not fit the {length} bytes of field '{field.name}'") from None
        return list(raw)
    if not isinstance(value, str):
        raise CodecError(f"field '{field.name}' cannot hold a list")
    try:
        if field.type is FieldType.TEXT:
            return list(value.encode("latin-1"))
        if field.type is FieldType.BYTES:
            return list(bytes.fromhex(value))
    except UnicodeEncodeError:
        raise CodecError(f"field '{field.name}' cannot hold '{value}': it is not ISO 8859-1") from None
    except ValueError:
        raise CodecError(f"field '{field.name}' needs bytes in hexadecimal, not '{value}'") from None
    raise CodecError(f"field '{field.name}' needs a number, not '{value}'")


def _length(field: Field, scope: Values) -> int | None:
    length = _said_length(field, scope)
    if length is not None and not 0 <= length <= _LONGEST:
        raise CodecError(f"field '{field.name}' would have {length} bytes, possible are 0 ... {_LONGEST}")
    return length


def _said_length(field: Field, scope: Values) -> int | None:
    if field.sizes is None:
        return _number(field.length, scope) if isinstance(field.length, str) else field.length
    by = _number(field.sizes.by, scope)
    size = dict(field.sizes.sizes).get(by)
    if size is None:
        raise CodecError(f"the length of field '{field.name}' is not known where '{field.sizes.by}' is {by}")
    size *= _number(field.sizes.times, scope) if field.sizes.times is not None else 1
    return size if field.sizes.fills is None else -size % field.sizes.fills


def _number(name: str, scope: Values) -> int:
    value = scope.get(name)
    if not isinstance(value, int):
        raise CodecError(f"field '{name}' must be known to read what depends on it")
    return value
