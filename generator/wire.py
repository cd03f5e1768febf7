"""Telegrams of services: from a parameter and its value to bytes, and back."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from generator.codec import CodecError, decode, encode
from generator.model import (
    Choice,
    DataType,
    Field,
    FieldType,
    Filler,
    Filling,
    Fillings,
    Layout,
    Message,
    Service,
    Values,
    What,
)
from generator.model.telegram import OPEN, Value

Layouts = Mapping[str, Layout]
"""Layouts of a device by id."""
Octets = tuple[int | None, ...]
"""Bytes of a telegram, ``None`` where one is left open."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Call:
    """What a telegram of a service is about; ``None`` leaves the bytes open.

    ``index`` and ``code`` are both given for a code.  ``type_name``: the manual's spelling of the data type, "" where
    there is no other than that of CiA 301.  ``value``: as it travels (value * scaling), the bytes of a string.
    ``length``: of a string whose bytes are not in the telegram.  ``free``: by field, what the sender chooses;
    ``unset`` is taken for those that it does not name.
    """

    data_type: DataType = DataType.UNSIGNED32
    type_name: str = ""
    index: int | None = None
    code: int | None = None
    subindex: int | None = None
    value: int | bytes | None = None
    length: int | None = None
    error: int | None = None
    register: int | None = None
    free: Mapping[str, int | None] = field(default_factory=dict)
    unset: int | None = 0


@dataclass(frozen=True, slots=True)
class Telegram:
    """A telegram and the layout that it is built by."""

    layout: Layout
    data: Octets


def carries(service: Service, data_type: DataType, type_name: str = "") -> bool:
    """Whether telegrams of the service can hold values of a data type."""
    call = Call(data_type=data_type, type_name=type_name)
    try:
        for choice in (found for message in service.messages for found in _choices(message)):
            chosen(choice, call)
    except CodecError:
        return False
    return True


def _choices(message: Message) -> Iterator[Choice]:
    if isinstance(message.layout, Choice):
        yield message.layout
    yield from _choices_in(message.values)


def _choices_in(fillings: Fillings) -> Iterator[Choice]:
    for _, filling in fillings:
        if isinstance(filling, Choice):
            yield filling
        elif isinstance(filling, tuple):
            for entry in filling:
                yield from _choices_in(entry)


def build(service: Service, message: Message, layouts: Layouts, call: Call) -> Telegram:
    """The telegram of one of the service's messages.

    Raises:
        CodecError: The service does not carry the data type, or a number does not fit its field or the type.
    """
    layout = layouts[_layout(message, call)]
    values = _values(message.values, layout.fields, call)
    for name, behind in _counts(message.values):
        place = next((i for i, known in enumerate(layout.fields) if known.name == behind), 0)
        ahead = replace(layout, fields=layout.fields[: place + 1])
        values[name] = len(encode(layout, values)) - len(encode(ahead, values))
    data = encode(layout, values)
    if service.limit is not None and len(data) > service.limit:
        raise CodecError(f"the telegram has {len(data)} bytes, at most {service.limit} can be sent")
    return Telegram(layout, data)


def _layout(message: Message, call: Call) -> str:
    return message.layout if isinstance(message.layout, str) else str(chosen(message.layout, call))


def _counts(fillings: Fillings) -> list[tuple[str, str]]:
    """Fields that count the bytes behind another, with the name of that."""
    return [(name, f.field) for name, f in fillings if isinstance(f, Filler) and f.what is What.BEHIND]


def chosen(filling: Filling, call: Call) -> Filling:
    """What a choice comes to: by the name of the type, by its length, or what is left for the others.

    Raises:
        CodecError: The choice has no case for the data type.
    """
    if not isinstance(filling, Choice):
        return filling
    key = case_of(filling, call)
    if key is not None:
        return chosen(dict(filling.cases)[key], call)
    if filling.otherwise is None:
        raise CodecError(f"values of the type {call.type_name or call.data_type.canopen_name} are not carried")
    return chosen(filling.otherwise, call)


def case_of(choice: Choice, call: Call) -> str | None:
    """The case for a data type: by its name, by that of CiA 301 or by its length; ``None`` where there is none."""
    cases = {key.replace("_", ""): key for key, _ in choice.cases}
    names = (call.type_name, call.data_type.canopen_name, str(call.data_type.bits // 8))
    return next((found for name in names if (found := cases.get(name.replace("_", "")))), None)


def _values(fillings: Fillings, fields: Sequence[Field], call: Call) -> Values:
    given = dict(fillings)
    values: Values = {}
    for target in fields:
        parts = [(part, given[name]) for part in target.bits if (name := f"{target.name}.{part.label}") in given]
        if target.name in given:
            values[target.name] = _value(chosen(given[target.name], call), target, target.name, call)
        elif parts:
            numbers = [_value(chosen(f, call), target, f"{target.name}.{p.label}", call) for p, f in parts]
            known = [number for number in numbers if isinstance(number, int)]
            if len(known) < len(numbers):
                values[target.name] = OPEN
            else:
                values[target.name] = sum(n << part.low for n, (part, _) in zip(known, parts, strict=True))
        elif target.constant is None:
            values[target.name] = "" if target.type in (FieldType.TEXT, FieldType.BYTES) else 0
    return values


def _value(filling: Filling, target: Field, name: str, call: Call) -> Value:
    match filling:
        case int() | str():
            return filling
        case Filler():
            return _filled(filling, target, name, call)
        case tuple():
            return tuple(_values(entry, target.fields, call) for entry in filling)
        case Choice():
            raise CodecError(f"field '{name}' is not decided")


def _filled(filler: Filler, target: Field, name: str, call: Call) -> Value:
    match filler.what:
        case What.INDEX:
            number = call.index
        case What.CODE:
            number = call.code
        case What.SUBINDEX:
            number = call.subindex
        case What.ELEMENTS:
            number = None if call.subindex is None else min(call.subindex, 1)
        case What.ERROR:
            number = call.error
        case What.REGISTER:
            number = call.register
        case What.FREE:
            number = call.free.get(name, call.unset)
        case What.LENGTH:
            number = len(call.value) if isinstance(call.value, bytes) else call.data_type.bits // 8 or call.length
        case What.BEHIND:
            number = 0
        case What.VALUE:
            if isinstance(call.value, bytes):
                return _text(call.value, target)
            number = None if call.value is None else _raw(call.value, call.data_type)
    if number is None:
        return OPEN
    if filler.low is None or filler.high is None:
        return number
    return (number >> filler.low) & ((1 << (filler.high - filler.low + 1)) - 1)


def _text(value: bytes, target: Field) -> Value:
    """Bytes for a field: as they are, or in a number in the order of its bytes."""
    if target.type is FieldType.TEXT:
        return value.decode("latin-1")
    if target.type is FieldType.BYTES:
        return value.hex(" ").upper()
    return int.from_bytes(value, "big" if target.big else "little")


def _raw(value: int, data_type: DataType) -> int:
    """The value without its sign, in as many bits as its type has."""
    if not data_type.is_number:
        raise CodecError(f"{value} is a number, {data_type.canopen_name} needs bytes")
    if not data_type.lowest <= value <= data_type.highest:
        raise CodecError(f"{value} does not fit {data_type.canopen_name}")
    return value & ((1 << data_type.bits) - 1)


def recognise(service: Service, message: Message, layouts: Layouts, data: Octets, like: Call) -> Call | None:
    """What a telegram is about if it is this message, with values of the data type of ``like``; otherwise ``None``."""
    call = bind(message, layouts, data, like)
    if call is None:
        return None
    try:
        built = build(service, message, layouts, call).data
    except CodecError:
        return None
    return call if agree(built, data) else None


def agree(data: Octets, other: Octets) -> bool:
    """Whether telegrams are equal where both are known."""
    return len(data) == len(other) and all(a == b or None in (a, b) for a, b in zip(data, other, strict=True))


def bind(message: Message, layouts: Layouts, data: Octets, like: Call) -> Call | None:
    """What the fields of a telegram say, whether or not the others are those of the message.

    ``None`` where the data type is not carried or the bytes do not fit the layout.
    """
    try:
        layout = layouts[_layout(message, like)]
        found: dict[What, int | bytes] = {}
        free: dict[str, int | None] = {}
        _read(message.values, layout.fields, decode(layout, data), like, found, free)
    except CodecError:
        return None
    value = found.get(What.VALUE)
    if isinstance(value, int) and like.data_type.signed and value > like.data_type.highest:
        value -= 1 << like.data_type.bits
    return replace(
        like,
        index=_number(found, What.INDEX),
        code=_number(found, What.CODE),
        subindex=_number(found, What.SUBINDEX),
        error=_number(found, What.ERROR),
        register=_number(found, What.REGISTER),
        value=value,
        length=_number(found, What.LENGTH),
        free=free,
    )


def _number(found: Mapping[What, int | bytes], what: What) -> int | None:
    value = found.get(what)
    return value if isinstance(value, int) else None


def _read(
    fillings: Fillings,
    fields: Sequence[Field],
    values: Values,
    like: Call,
    found: dict[What, int | bytes],
    free: dict[str, int | None],
) -> None:
    targets = {target.name: target for target in fields}
    for name, filling in fillings:
        decided = chosen(filling, like)
        value = values.get(name, OPEN)
        target = targets.get(name.partition(".")[0])
        if isinstance(decided, tuple) and isinstance(value, tuple) and target is not None:
            for inner, entry in zip(decided, value, strict=False):
                _read(inner, target.fields, entry, like, found, free)
        elif isinstance(decided, Filler) and target is not None:
            # Only a value can be a text; what else stands in bytes is a number.
            counts = like.data_type.is_number or decided.what is not What.VALUE
            known = None if value == OPEN or isinstance(value, tuple) else _bytes_or_number(value, target, counts)
            if decided.what is What.FREE:
                free[name] = known if isinstance(known, int) else None
            elif isinstance(known, int) and decided.low is not None:
                before = found.get(decided.what, 0)
                found[decided.what] = (before if isinstance(before, int) else 0) | known << decided.low
            elif known is not None:
                found[decided.what] = known


def _bytes_or_number(value: int | str, target: Field, counts: bool) -> int | bytes:
    if isinstance(value, int):
        return value
    raw = value.encode("latin-1") if target.type is FieldType.TEXT else bytes.fromhex(value)
    return int.from_bytes(raw, "big" if target.big else "little") if counts else raw
