"""Telegram classes of the Python package: they agree with the reference codec on every message, good or bad."""

import importlib
import os
import random
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from generator.codec import CodecError, decode, encode
from generator.emit.base import EmitError
from generator.emit.python import render
from generator.emit.python.telegrams import class_name, field_name
from generator.model import Device, Field, FieldType, Layout, Model, Option, Sizes, Values, Where

PACKAGE = "drivespec_devices"
MESSAGES = 10_000
KINDS = {
    "bytes are left over": "trailing",
    ", but must be ": "constant",
    " is not known where ": "unknown_size",
    " bytes, ": "truncated",
}
"""What the kinds of error are in the words of the reference."""

DEVICES = sorted(
    path.parent.name for path in Path(__file__).resolve().parent.parent.glob("spec/devices/*/telegrams.yaml")
)


@pytest.fixture(scope="module")
def package(generated: Path) -> Iterator[Any]:
    """The package, imported from the generated files."""
    folder = str(generated / "python")
    sys.path.insert(0, folder)
    try:
        yield importlib.import_module(PACKAGE)
    finally:
        sys.path.remove(folder)
        for name in [name for name in sys.modules if name.split(".")[0] == PACKAGE]:
            del sys.modules[name]


def layouts_of(model: Model, device_id: str) -> tuple[Layout, ...]:
    """The layouts of the device."""
    return next(device.layouts for device in model.devices if device.id == device_id)


# Messages: made from random values by the reference, and spoilt in several ways.


def deciding(fields: Sequence[Field]) -> dict[str, list[int]]:
    """Fields that decide on counts and sizes, with values that make sense."""
    found: dict[str, list[int]] = {}
    for field in fields:
        found |= deciding(field.fields)
        if isinstance(field.length, str):
            found[field.length] = list(range(9))
        if field.count is not None:
            found[field.count] = list(range(5))
        if field.sizes is not None:
            found[field.sizes.by] = [value for value, _ in field.sizes.sizes]
            if field.sizes.times is not None:
                found[field.sizes.times] = list(range(4))
    return found


def random_values(fields: Sequence[Field], chance: random.Random, outer: dict[str, int]) -> Values:
    """Values that fit."""
    choices = deciding(fields)
    values: Values = {}
    scope = dict(outer)
    for field in fields:
        if field.type is FieldType.GROUP:
            entries = scope[field.count] if field.count is not None else chance.randrange(4)
            values[field.name] = tuple(random_values(field.fields, chance, scope) for _ in range(entries))
            continue
        if field.constant is not None:
            continue
        length = random_length(field, chance, scope)
        octets = chance.randbytes(length)
        if field.type is FieldType.BYTES:
            values[field.name] = octets.hex(" ").upper()
        elif field.type is FieldType.TEXT:
            values[field.name] = octets.decode("latin-1")
        else:
            number = int.from_bytes(octets, "little", signed=field.type is FieldType.INT)
            number = chance.choice(choices[field.name]) if field.name in choices else number
            values[field.name] = scope[field.name] = number
    return values


def random_length(field: Field, chance: random.Random, scope: dict[str, int]) -> int:
    """Length of a field."""
    if field.sizes is not None:
        times = 1 if field.sizes.times is None else scope[field.sizes.times]
        return dict(field.sizes.sizes)[scope[field.sizes.by]] * times
    if isinstance(field.length, str):
        return scope[field.length]
    return chance.randrange(9) if field.length is None else field.length


def spoilt(message: bytes, chance: random.Random) -> bytes:
    """The message as it is, cut, prolonged, with another byte, or quite another one."""
    way = chance.randrange(8)
    if way < 3:
        return message
    if way == 3:
        return message[: chance.randrange(len(message) + 1)]
    if way == 4:
        return message + chance.randbytes(chance.randrange(1, 4))
    if way < 7 and message:
        place = chance.randrange(len(message))
        return message[:place] + chance.randbytes(1) + message[place + 1 :]
    return chance.randbytes(chance.randrange(2 * len(message) + 3))


def messages(layout: Layout) -> Iterator[bytes]:
    """Messages of one layout, always the same."""
    chance = random.Random(layout.id)
    for _ in range(MESSAGES):
        octets = encode(layout, random_values(layout.fields, chance, {}))
        yield spoilt(bytes(octet for octet in octets if octet is not None), chance)


# What each side says of a message.


def reference(layout: Layout, message: bytes) -> Values | str:
    """Values, or the kind of error."""
    try:
        return decode(layout, message)
    except CodecError as error:
        return next(kind for words, kind in KINDS.items() if words in str(error))


def plain(fields: Sequence[Field], telegram: Any) -> Values:
    """Values of a telegram in the form of the reference."""
    values: Values = {}
    for field in fields:
        value = getattr(telegram, field_name(field))
        if field.type is FieldType.GROUP:
            values[field.name] = tuple(plain(field.fields, entry) for entry in value)
        elif field.type is FieldType.BYTES:
            values[field.name] = value.hex(" ").upper()
        else:
            values[field.name] = value
        for bits in field.bits:
            values[f"{field.name}.{bits.label}"] = getattr(telegram, f"{field.name}_{bits.label}")
    return values


def generated_class(package: Any, device_id: str, layout: Layout) -> Any:
    """The class of a layout."""
    return getattr(package.load(device_id), class_name(layout))


@pytest.mark.parametrize("device_id", DEVICES)
def test_agrees_with_the_reference(package: Any, model: Model, device_id: str) -> None:
    """The same values or the same kind of error for every message, and the same bytes again."""
    for layout in layouts_of(model, device_id):
        check_against_reference(package, device_id, layout)


def check_against_reference(package: Any, device_id: str, layout: Layout) -> None:
    """Both sides read and write the messages of a layout, most of which are good and some of each kind bad."""
    telegram_class = generated_class(package, device_id, layout)
    results = {"decoded": 0, "truncated": 0, "trailing": 0, "constant": 0, "unknown_size": 0}
    for message in messages(layout):
        expected = reference(layout, message)
        try:
            telegram = telegram_class.decode(message)
        except package.DecodeError as error:
            assert error.kind == expected, message.hex(" ")
            results[error.kind] += 1
            continue
        values = plain(layout.fields, telegram)
        assert values == expected, message.hex(" ")
        assert telegram.encode() == bytes(octet for octet in encode(layout, values) if octet is not None) == message
        results["decoded"] += 1
    assert results["decoded"] > MESSAGES // 4
    assert results["truncated"] + results["unknown_size"] + results["trailing"] > 0 or layout.id == "pdo"
    has_constant = any(field.constant is not None for field in layout.fields)
    assert (results["constant"] > 0) >= has_constant


def wrong_values(field: Field) -> Iterator[Any]:
    """Values that the field cannot hold."""
    if field.type in (FieldType.UINT, FieldType.INT) and isinstance(field.length, int) and field.constant is None:
        bits = 8 * field.length
        yield 1 << bits
        yield -1 if field.type is FieldType.UINT else -(1 << bits - 1) - 1
    elif field.type is FieldType.BYTES and field.length is None and field.sizes is not None:
        yield b"\0" * 1000
    elif field.type is FieldType.TEXT:
        yield "x" * 1000
        yield "\u20ac" * (field.length if isinstance(field.length, int) else 1)


def test_values_that_do_not_fit_are_refused(package: Any, model: Model) -> None:
    """Numbers, texts and bytes beyond their field, parts beyond their bits; what is no number is a type error."""
    refused = 0
    for device in model.devices:
        for layout in device.layouts:
            message = next(m for m in messages(layout) if not isinstance(reference(layout, m), str))
            telegram = generated_class(package, device.id, layout).decode(message)
            for field in layout.fields:
                for wrong in wrong_values(field):
                    name, right = field_name(field), getattr(telegram, field_name(field))
                    setattr(telegram, name, wrong)
                    with pytest.raises(package.EncodeError) as caught:
                        telegram.encode()
                    assert caught.value.kind in ("range", "unknown_size", "count")
                    assert field.name in str(caught.value)
                    setattr(telegram, name, right)
                    refused += 1
                if field.type in (FieldType.UINT, FieldType.INT) and field.constant is None:
                    right = getattr(telegram, field_name(field))
                    setattr(telegram, field_name(field), "5")
                    with pytest.raises(TypeError):
                        telegram.encode()
                    setattr(telegram, field_name(field), right)
            assert telegram.encode() == message
    assert refused > 100


def test_parts_of_numbers(package: Any, model: Model) -> None:
    """Each part can be set alone, keeps the rest, and refuses what its bits cannot hold."""
    for device in model.devices:
        for layout in device.layouts:
            message = next(m for m in messages(layout) if not isinstance(reference(layout, m), str))
            telegram = generated_class(package, device.id, layout).decode(message)
            for field in layout.fields:
                for bits in field.bits:
                    name = f"{field.name}_{bits.label}"
                    if field.constant is not None:
                        with pytest.raises(AttributeError):
                            setattr(telegram, name, 0)
                        continue
                    before, top = getattr(telegram, field_name(field)), bits.mask >> bits.low
                    for part in (0, top, (before & bits.mask) >> bits.low):
                        setattr(telegram, name, part)
                        assert getattr(telegram, name) == part
                        assert getattr(telegram, field_name(field)) & ~bits.mask == before & ~bits.mask
                    assert getattr(telegram, field_name(field)) == before
                    for wrong in (-1, top + 1):
                        with pytest.raises(package.EncodeError, match=f"{field.name}.{bits.label}") as caught:
                            setattr(telegram, name, wrong)
                        assert caught.value.kind == "range"


def grouped(model: Model) -> Iterator[tuple[Device, Layout, Field]]:
    """Groups that have a count."""
    for device in model.devices:
        for layout in device.layouts:
            for field in layout.fields:
                if field.count is not None:
                    yield device, layout, field


def test_counts(package: Any, model: Model) -> None:
    """A count that contradicts its group is refused; one that is not given is that of the group."""
    groups = list(grouped(model))
    assert groups
    for device, layout, group in groups:
        telegram_class = generated_class(package, device.id, layout)
        message = next(
            m
            for m in messages(layout)
            if isinstance(values := reference(layout, m), dict) and len(str(values[group.name])) > 2
        )
        telegram = telegram_class.decode(message)
        getattr(telegram, field_name(group)).pop()
        with pytest.raises(package.EncodeError, match=group.name) as caught:
            telegram.encode()
        assert caught.value.kind == "count"
        telegram = telegram_class.decode(message)
        free = {field_name(f): getattr(telegram, field_name(f)) for f in layout.fields if f.constant is None}
        del free[str(group.count)]
        assert telegram_class(**free) == telegram


def test_what_is_no_bytes_is_a_type_error(package: Any, model: Model) -> None:
    """A number is not taken for a length, nor a text for its characters."""
    for device in model.devices:
        for layout in device.layouts:
            for wrong in (8, "40", None, [64, 0]):
                with pytest.raises(TypeError):
                    generated_class(package, device.id, layout).decode(wrong)


def test_telegrams_compare_and_show_their_values(package: Any, model: Model) -> None:
    """Equality by class and values, a representation that can be read back, constants that cannot be changed."""
    device, layout = next((d, lay) for d in model.devices for lay in d.layouts if lay.fields[0].constant is not None)
    telegram_class = generated_class(package, device.id, layout)
    message = next(m for m in messages(layout) if not isinstance(reference(layout, m), str))
    telegram = telegram_class.decode(message)
    assert eval(repr(telegram), {telegram_class.__name__: telegram_class}) == telegram
    assert telegram != telegram_class.decode(message[:-1] + bytes([message[-1] ^ 1]))
    assert telegram != message
    with pytest.raises(TypeError):
        hash(telegram)
    with pytest.raises(AttributeError):
        setattr(telegram, field_name(layout.fields[0]), 1)
    assert isinstance(telegram, package.Telegram)
    assert issubclass(package.DecodeError, package.TelegramError) and issubclass(package.TelegramError, ValueError)


@pytest.mark.hypothesis
@pytest.mark.parametrize("device_id", DEVICES)
def test_any_bytes(package: Any, model: Model, device_id: str) -> None:
    """Whatever arrives is either read and written back as it was, or refused with a decode error."""
    samples = [
        (generated_class(package, device_id, layout), data)
        for layout in layouts_of(model, device_id)
        for data in [message for message in messages(layout) if not isinstance(reference(layout, message), str)][:50]
    ]

    @settings(
        max_examples=10 * settings().max_examples,
        derandomize=settings.get_current_profile_name() != "long",
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(st.sampled_from(samples), st.integers(0, 40), st.integers(0, 4), st.binary(max_size=300))
    def check(sample: tuple[Any, bytes], start: int, length: int, inserted: bytes) -> None:
        telegram_class, good = sample
        data = good[:start] + inserted + good[start + length :]
        try:
            telegram = telegram_class.decode(data)
        except package.DecodeError:
            return
        assert telegram.encode() == data

    check()


def test_generated_vectors(generated: Path, model: Model) -> None:
    """The tests that come with the package hold every worked telegram and pass."""
    environment = {"PATH": os.environ["PATH"], "PYTHONPATH": str(generated / "python"), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(generated / "python" / "tests")]
    done = subprocess.run(command, cwd=generated, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    count = sum(len(device.examples) for device in model.devices)
    assert f"{count} passed" in done.stdout


# Layouts unlike the real ones.


def field(name: str, **other: Any) -> Field:
    """A field of one byte, but for ``other``."""
    plain_field = Field(
        name=name,
        title=name.title(),
        type=FieldType.UINT,
        length=1,
        sizes=None,
        count=None,
        fields=(),
        big=False,
        constant=None,
        values=(),
        bits=(),
        bit_values=(),
        description="",
        where=Where("odd.yaml", 1, 1, "/layouts/0"),
    )
    return replace(plain_field, **other)


def odd_layout(base: Layout) -> Layout:
    """Names that Python needs, groups in groups and to the end, sizes by an outer field, signed numbers."""
    inner = (
        field("length", values=(Option(1, "One"),)),
        field("text", type=FieldType.TEXT, length="length"),
        field("deep", type=FieldType.GROUP, length=None, count="count",
              fields=(field("data", type=FieldType.INT, length=3, big=True),
                      field("raw", type=FieldType.BYTES, length=None, sizes=Sizes("class", ((0, 0), (7, 2)), None)))),
    )  # fmt: skip
    fields = (
        field("class"),
        field("count"),
        field("bytes", type=FieldType.BYTES, length=2),
        field("decode", type=FieldType.INT, length=2, constant=-2),
        field("group", type=FieldType.GROUP, length=None, fields=inner),
    )
    return replace(base, id="odd", name="Odd", fields=fields, errata=())


def test_odd_layouts(model: Model, tmp_path: Path) -> None:
    """Agrees with the reference on a layout that uses everything."""
    device = replace(model.devices[0], id="odd", layouts=(odd_layout(model.devices[0].layouts[0]),), examples=())
    for name, output in render(replace(model, devices=(device,))).items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(output.data())
    code = f"""
import sys
from {PACKAGE} import DecodeError, odd
for line in sys.stdin:
    data = bytes.fromhex(line)
    try:
        telegram = odd.Odd.decode(data)
        print(telegram.encode().hex(), [
            (e.text, [(d.data, d.raw) for d in e.deep]) for e in telegram.group
        ])
    except DecodeError as error:
        print(error.kind)
"""
    layout = device.layouts[0]
    chance = random.Random(0)
    lines = []
    for _ in range(2000):
        octets = encode(layout, random_values(layout.fields, chance, {"class": 7}))
        lines.append(spoilt(bytes(octet for octet in octets if octet is not None), chance).hex())
    done = subprocess.run([sys.executable, "-c", code], input="\n".join(lines), text=True,
                          capture_output=True, env={"PYTHONPATH": str(tmp_path)})  # fmt: skip
    assert done.returncode == 0, done.stderr
    answers = done.stdout.splitlines()
    assert len(answers) == len(lines)
    for line, answer in zip(lines, answers, strict=True):
        expected = reference(layout, bytes.fromhex(line))
        if isinstance(expected, str):
            assert answer == expected
        else:
            assert answer.split(" ", 1)[0] == line
            groups: Any = expected["group"]
            plain_groups = [
                (e["text"], [(d["data"], bytes.fromhex(d["raw"])) for d in e["deep"]]) for e in groups
            ]  # fmt: skip
            assert answer.split(" ", 1)[1] == repr(plain_groups)
    assert sum(" " in answer for answer in answers) > 500
    check = [sys.executable, "-m", "mypy", "--strict", "-p", PACKAGE, "--cache-dir", str(tmp_path / "cache")]
    done = subprocess.run(check, cwd=tmp_path, capture_output=True, text=True, env={"PATH": os.environ["PATH"]})
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ((field("data", type=FieldType.BYTES, length="nothing"),), "depends on 'nothing'"),
        ((field("all", type=FieldType.GROUP, length=None, fields=(field("x", type=FieldType.BYTES, length=0),)),),
         "may have no bytes"),
        ((field("a"), field("a")), "would stand twice"),
    ],
)  # fmt: skip
def test_layouts_that_cannot_be(model: Model, fields: tuple[Field, ...], message: str) -> None:
    """A length from nowhere, a loop without end, and two fields of one name are refused when generating."""
    layout = replace(model.devices[0].layouts[0], fields=fields)
    device = replace(model.devices[0], layouts=(layout,), examples=())
    with pytest.raises(EmitError, match=message):
        render(replace(model, devices=(device,)))


def best_time(action: Callable[[], object], count: int = 2000) -> float:
    """Seconds for one call, best of several runs."""
    runs = []
    for _ in range(5):
        start = time.perf_counter()
        for _ in range(count):
            action()
        runs.append(time.perf_counter() - start)
    return min(runs) / count


def test_speed(package: Any, model: Model) -> None:
    """Reading is at least three times as fast as interpreting the layout."""
    device = model.devices[0]
    for layout in device.layouts[:4]:
        telegram_class = generated_class(package, device.id, layout)
        message = next(m for m in messages(layout) if not isinstance(reference(layout, m), str))
        ours = best_time(lambda m=message, c=telegram_class: c.decode(m))  # type: ignore[misc]
        theirs = best_time(lambda m=message, x=layout: decode(x, m))  # type: ignore[misc]
        assert ours * 3 < theirs
