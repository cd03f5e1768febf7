"""The C codecs against the reference codec, byte for byte, and against what the reference cannot say."""

import random
import re
import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from test_c import COMPILERS, compile_c, options, run, self_test, write

from generator.codec import CodecError, decode, encode
from generator.model import BitField, Device, Field, FieldType, Layout, Model, Option, Sizes, Values
from generator.naming import safe, snake

MESSAGES = 10_000
SANITIZE = ("-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
DEVICES = ("e94aycca", "e94aycen", "e94aycpm", "servo931")


@pytest.fixture(scope="session")
def c(generated: Path) -> Path:
    """The folder of the target."""
    return generated / "c"


# Messages: well-formed ones of a layout, and what is made of them.


def message(layout: Layout, rng: random.Random) -> bytes:
    """A telegram that decodes, unless it takes a length of which nothing is known."""
    data = bytearray()
    every = list(walk(layout.fields))
    choices = {f.sizes.by: [value for value, _ in f.sizes.sizes] for f in every if f.sizes is not None}
    for f in every:
        for name in (f.length, f.count, f.sizes and f.sizes.times):
            if isinstance(name, str):
                choices[name] = [0, 1, 2, 3, 7]
    _fields(layout.fields, {}, choices, data, rng)
    return bytes(data)


def walk(fields: Sequence[Field]) -> Iterator[Field]:
    """The fields and those inside them."""
    for field in fields:
        yield field
        yield from walk(field.fields)


def _fields(
    fields: Sequence[Field], scope: dict[str, int], choices: dict[str, list[int]], data: bytearray, rng: random.Random
) -> None:
    for field in fields:
        if field.type is FieldType.GROUP:
            for _ in range(scope[field.count] if field.count else rng.randrange(4)):
                _fields(field.fields, dict(scope), choices, data, rng)
            continue
        if field.sizes is not None:
            length = dict(field.sizes.sizes)[scope[field.sizes.by]] * scope.get(field.sizes.times or "", 1)
        elif isinstance(field.length, str):
            length = scope[field.length]
        else:
            length = rng.randrange(9) if field.length is None else field.length
        if field.constant is not None:
            value = field.constant if length else 0
        elif field.name in choices:
            value = rng.choice(choices[field.name])
        else:
            value = rng.choice((0, 1, rng.getrandbits(8 * length), (1 << 8 * length) - 1)) % (1 << 8 * length)
        scope[field.name] = value
        data += (value % (1 << 8 * length)).to_bytes(length, "big" if field.big else "little")


def mutated(data: bytes, rng: random.Random) -> bytes:
    """The message, or one that is cut, prolonged, altered in a byte, or something else."""
    kind = rng.randrange(8)
    if kind == 0:
        return data[: rng.randrange(len(data) + 1)]
    if kind == 1:
        return data + rng.randbytes(rng.randrange(1, 5))
    if kind in (2, 3) and data:
        place = rng.randrange(len(data))
        return data[:place] + rng.randbytes(1) + data[place + 1 :]
    if kind == 4:
        return rng.randbytes(rng.randrange(len(data) + 4))
    return data


# What the driver must print.

ERRORS = (
    (r"are left over", "trailing"),
    (r"needs \d+ bytes", "truncated"),
    (r"but must be", "constant"),
    (r"the length of field .* is not known", "unknown_size"),
)


def expected(device: str, layout: Layout, data: bytes) -> str:
    try:
        values = decode(layout, data)
    except CodecError as error:
        return next(name for pattern, name in ERRORS if re.search(pattern, str(error)))
    again = bytes(octet for octet in encode(layout, values) if octet is not None)
    assert again == data
    return f"ok {shown(snake(device, layout.id), layout.fields, values)}ok {data.hex()} ok {data.hex()}"


def shown(stem: str, fields: Sequence[Field], values: Values) -> str:
    text = ""
    for field in fields:
        value = values[field.name]
        if field.constant is not None:
            continue
        name = safe(field.name, "c")
        if isinstance(value, tuple):
            entries = "".join(f"{shown(f'{stem}_{field.name}', field.fields, entry)}| " for entry in value)
            text += f"{name}=[ {entries}] "
        elif isinstance(value, int):
            text += f"{name}={value} "
        else:
            raw = value.encode("latin-1") if field.type is FieldType.TEXT else bytes.fromhex(value)
            text += f"{name}={raw.hex()} "
    for field in fields:
        if field.constant is None:
            for part in field.bits:
                text += f"{stem}_get_{field.name}_{part.label}={values[f'{field.name}.{part.label}']} "
    return text


def drive(program: Path, lines: Sequence[str]) -> list[str]:
    """What the driver prints for each line; a sanitizer's finding fails."""
    done = subprocess.run([str(program)], input="\n".join(lines) + "\n", capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def agree(device: Device, program: Path, count: int) -> dict[str, int]:
    """Compare driver and reference over messages of every layout; returns how often each status was seen."""
    seen: dict[str, int] = {}
    for layout in device.layouts:
        rng = random.Random(f"{device.id} {layout.id}")
        messages = [mutated(message(layout, rng), rng) for _ in range(count)]
        printed = drive(program, [f"{layout.id} {data.hex()}" for data in messages])
        assert len(printed) == len(messages)
        for data, line in zip(messages, printed, strict=True):
            wanted = expected(device.id, layout, data)
            assert line == wanted, f"{layout.id} {data.hex()}"
            status = wanted.partition(" ")[0]
            seen[status] = seen.get(status, 0) + 1
    return seen


def driver(c: Path, folder: Path, device: str, *options: str) -> Path:
    source = c / "test" / f"{device}_telegrams_driver.c"
    return compile_c(folder, source, "cc", "c99", f"-I{c / 'include'}", *options)


def test_every_device_is_tried(model: Model) -> None:
    assert {device.id for device in model.devices if device.layouts} == set(DEVICES)


@pytest.mark.parametrize("name", DEVICES)
def test_random_messages_agree_with_the_reference(model: Model, c: Path, tmp_path: Path, name: str) -> None:
    device = next(device for device in model.devices if device.id == name)
    seen = agree(device, driver(c, tmp_path, name, *SANITIZE), MESSAGES)
    assert sum(seen.values()) == MESSAGES * len(device.layouts)
    assert {"ok", "truncated", "trailing", "constant"} <= set(seen)
    assert seen["ok"] > MESSAGES


@pytest.mark.parametrize("name", DEVICES)
@pytest.mark.parametrize(("compiler", "standard"), COMPILERS)
def test_worked_telegrams_and_constants(
    model: Model, c: Path, tmp_path: Path, name: str, compiler: str, standard: str
) -> None:
    device = next(device for device in model.devices if device.id == name)
    printed = self_test(c, tmp_path, f"{name}_telegrams", compiler, standard)
    found: dict[str, int] = {}
    for layout in device.layouts:
        found |= constants(snake(device.id, layout.id).upper(), layout.fields)
    assert {key: value for key, value in found.items() if printed.get(key) != value} == {}
    sizes = {key for key in printed if key.endswith(("_SIZE", "_SIZE_MIN"))}
    assert set(printed) - set(found) == sizes


def constants(prefix: str, fields: Sequence[Field]) -> dict[str, int]:
    """The constants of a layout, straight from the model."""
    found: dict[str, int] = {}
    for field in fields:
        name = field.name.upper()
        if field.constant is not None:
            found[f"{prefix}_{name}_VALUE"] = field.constant
        lists = [(name, field.values), *((f"{name}_{part.upper()}", entries) for part, entries in field.bit_values)]
        for label, entries in lists:
            found |= {key: int(value) for key, value in options(f"{prefix}_{label}", entries).items()}
        found |= constants(f"{prefix}_{name}", field.fields)
    return found


def test_every_worked_telegram_is_a_vector(model: Model, c: Path) -> None:
    for device in model.devices:
        text = (c / f"test/{device.id}_telegrams_selftest.c").read_text(encoding="ascii")
        for example in device.examples:
            assert text.count(f'example[] = "{example.id}"') == 1
            given = [octet for octet in example.data if octet is not None]
            data = re.search(rf'example\[\] = "{example.id}";\n    static const uint8_t data\[\] = {{(.*?)}}', text)
            assert data is not None
            octets = [int(octet.strip().rstrip("u"), 16) for octet in data[1].split(",")]
            assert len(octets) == len(example.data)
            assert [o for o, e in zip(octets, example.data, strict=True) if e is not None] == given


def test_a_vector_that_does_not_hold_is_named(model: Model, tmp_path: Path) -> None:
    device = next(device for device in model.devices if device.examples)
    example = next(e for e in device.examples if any(isinstance(v, int) for v in e.values.values()))
    name = next(name for name, value in example.values.items() if isinstance(value, int) and "." not in name)
    wrong = replace(example, values={**example.values, name: int(str(example.values[name])) ^ 1})
    c = write(tmp_path / "c", replace(model, devices=(replace(device, examples=(wrong,)),)))
    source = c / "test" / f"{device.id}_telegrams_selftest.c"
    program = compile_c(tmp_path, source, "cc", "c99", f"-I{c / 'include'}")
    done = subprocess.run([str(program)], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert f"failed {example.id}=telegram.{name} ==" in done.stdout


# Invented layouts with what the real ones happen not to have.


def field(model: Model, name: str, length: int | str | None = 1, kind: FieldType = FieldType.UINT) -> Field:
    sample = model.devices[0].layouts[0].fields[0]
    return replace(sample, name=name, title=name, type=kind, length=length, values=(), bits=(), bit_values=())


def odd_layouts(model: Model) -> tuple[Layout, ...]:
    sample = replace(model.devices[0].layouts[0], errata=())

    def number(name: str, length: int, *, signed: bool = False, big: bool = False) -> Field:
        return replace(field(model, name, length, FieldType.INT if signed else FieldType.UINT), big=big)

    wide = (
        *(number(f"u{n}", n, big=n % 2 == 0) for n in range(1, 9)),
        *(number(f"i{n}", n, signed=True, big=n % 2 == 1) for n in range(1, 9)),
    )
    parts = (
        replace(number("class", 4), bits=(BitField(0, 31, "all"),)),
        replace(number("signed", 2, signed=True), bits=(BitField(4, 15, "high"), BitField(0, 3, "low"))),
        replace(number("huge", 8, big=True), bits=(BitField(1, 62, "middle"), BitField(0, 63, "whole"))),
    )
    constants = (
        replace(number("minus", 3, signed=True), constant=-2),
        replace(number("long", 12, big=True), constant=258),
        replace(number("plus", 8), constant=2**64 - 1),
    )
    element = (
        number("a", 2, big=True),
        replace(field(model, "tail", None, FieldType.BYTES), sizes=Sizes("kind", ((0, 0), (1, 1), (2, 3)), "times")),
    )
    group = replace(field(model, "inner", None, FieldType.GROUP), count="repeat", fields=element)
    outer = replace(
        field(model, "outer", None, FieldType.GROUP),
        fields=(number("times", 1), number("repeat", 1), group),
    )
    return (
        replace(sample, id="widths", fields=wide),
        replace(sample, id="parts", fields=parts),
        replace(sample, id="constants", fields=constants),
        replace(sample, id="nested", fields=(number("kind", 1), outer)),
        replace(sample, id="text", fields=(number("many", 12), field(model, "words", None, FieldType.TEXT))),
        replace(
            sample,
            id="sized",
            fields=(
                replace(number("kind", 1), values=(Option(70000, "Beyond int"),)),
                replace(number("value", 0), length=None, sizes=Sizes("kind", ((0, 0), (1, 1), (3, 3)), None)),
                number("size", 2, big=True),
                field(model, "text", "size", FieldType.TEXT),
            ),
        ),
    )


@pytest.fixture(scope="session")
def odd(model: Model) -> Model:
    """A device of invented layouts."""
    real = model.devices[0]
    bare = replace(real, id="odd", codes=(), objects=(), errors=(), errata=(), examples=(), layouts=odd_layouts(model))
    bare = replace(bare, drive=None, slots=(), canopen=None, tables=(), switches=(), indicators=(), formulas=())
    return replace(model, devices=(bare,))


def test_invented_layouts_agree_with_the_reference(odd: Model, tmp_path: Path) -> None:
    device = replace(odd.devices[0], layouts=tuple(x for x in odd.devices[0].layouts if x.id != "text"))
    program = driver(write(tmp_path / "c", odd), tmp_path, "odd", *SANITIZE)
    seen = agree(device, program, 2_000)
    assert {"ok", "truncated", "trailing", "constant", "unknown_size"} <= set(seen)


ENCODING = r"""
#include <stdio.h>
#include <string.h>
#include "drivespec/odd_telegrams.h"

static int failures = 0;
static void check(bool holds, int line) { if (!holds) { printf("line %d\n", line); failures++; } }
#define CHECK(condition) check((condition), __LINE__)

int main(void)
{
    uint8_t data[64];
    size_t size = 99u;
    odd_widths_t widths;
    memset(&widths, 0, sizeof widths);
    CHECK(odd_widths_encode(&widths, data, sizeof data, &size) == DRIVESPEC_CAPACITY && size == 99u);

    uint8_t room[72];
    CHECK(odd_widths_encode(&widths, room, sizeof room, &size) == DRIVESPEC_OK && size == ODD_WIDTHS_SIZE);
    widths.u3 = UINT32_C(0xFFFFFF);
    widths.i3 = -INT32_C(0x800000);
    widths.i7 = INT64_C(0x7FFFFFFFFFFFFF);
    widths.i8 = INT64_MIN;
    CHECK(odd_widths_encode(&widths, room, sizeof room, &size) == DRIVESPEC_OK);
    odd_widths_t back;
    CHECK(odd_widths_decode(room, size, &back) == DRIVESPEC_OK);
    CHECK(back.u3 == widths.u3 && back.i3 == widths.i3 && back.i7 == widths.i7 && back.i8 == widths.i8);
    widths.u3 = UINT32_C(0x1000000);
    CHECK(odd_widths_encode(&widths, room, sizeof room, &size) == DRIVESPEC_RANGE);
    widths.u3 = 0u;
    widths.i3 = INT32_C(0x800000);
    CHECK(odd_widths_encode(&widths, room, sizeof room, &size) == DRIVESPEC_RANGE);
    widths.i3 = -INT32_C(0x800001);
    CHECK(odd_widths_encode(&widths, room, sizeof room, &size) == DRIVESPEC_RANGE);

    odd_parts_t parts = { 0u, 0, 0u };
    CHECK(odd_parts_set_signed_low(&parts, 16u) == DRIVESPEC_RANGE && parts.signed_ == 0);
    CHECK(odd_parts_set_signed_low(&parts, 15u) == DRIVESPEC_OK && parts.signed_ == 15);
    CHECK(odd_parts_set_signed_high(&parts, 0xFFFu) == DRIVESPEC_OK && parts.signed_ == -1);
    CHECK(odd_parts_get_signed_high(&parts) == 0xFFFu);
    CHECK(odd_parts_set_class_all(&parts, UINT32_MAX) == DRIVESPEC_OK && parts.class_ == UINT32_MAX);
    CHECK(odd_parts_set_huge_middle(&parts, UINT64_MAX) == DRIVESPEC_RANGE && parts.huge == 0u);
    CHECK(odd_parts_set_huge_middle(&parts, UINT64_MAX >> 2) == DRIVESPEC_OK);
    CHECK(parts.huge == UINT64_C(0x7FFFFFFFFFFFFFFE));

    const drivespec_slice first = { (const uint8_t *)"abcdef", 6u }, second = { (const uint8_t *)"ghijkl", 6u };
    odd_nested_outer_inner_t inner[2] = { { 1u, first }, { 2u, second } };
    odd_nested_outer_t outer = { 2u, 2u, { { NULL, 0u }, inner, 2u } };
    odd_nested_t nested = { 2u, { { NULL, 0u }, &outer, 1u } };
    CHECK(odd_nested_encode(&nested, data, sizeof data, &size) == DRIVESPEC_OK && size == 19u);
    CHECK(memcmp(data, "\002\002\002\000\001abcdef\000\002ghijkl", size) == 0);
    for (size_t room_left = 0u; room_left < 19u; room_left++) {
        CHECK(odd_nested_encode(&nested, data, room_left, &size) == DRIVESPEC_CAPACITY);
    }
    outer.repeat = 1u;
    CHECK(odd_nested_encode(&nested, data, sizeof data, &size) == DRIVESPEC_COUNT);
    outer.repeat = 2u;
    inner[1].tail.size = 5u;
    CHECK(odd_nested_encode(&nested, data, sizeof data, &size) == DRIVESPEC_RANGE);
    nested.kind = 9u;
    CHECK(odd_nested_encode(&nested, data, sizeof data, &size) == DRIVESPEC_UNKNOWN_SIZE);
    nested.outer.items = NULL;
    nested.outer.raw.data = data;
    nested.outer.raw.size = 3u;
    CHECK(odd_nested_encode(&nested, data, sizeof data, &size) == DRIVESPEC_COUNT);
    nested.outer.raw.size = 0u;
    CHECK(odd_nested_encode(&nested, data, sizeof data, &size) == DRIVESPEC_COUNT);

    odd_constants_t constants = { 0u };
    CHECK(odd_constants_encode(&constants, data, sizeof data, &size) == DRIVESPEC_OK && size == 23u);
    CHECK(memcmp(data, "\376\377\377\0\0\0\0\0\0\0\0\0\0\001\002\377\377\377\377\377\377\377\377", size) == 0);
    CHECK(odd_constants_decode(data, size, &constants) == DRIVESPEC_OK);
    data[3] = 1u;
    CHECK(odd_constants_decode(data, size, &constants) == DRIVESPEC_CONSTANT);

    odd_text_t text;
    CHECK(odd_text_decode(data, 12u, &text) == DRIVESPEC_OK && text.words.size == 0u && text.many.size == 12u);
    CHECK(odd_text_decode(NULL, 0u, &text) == DRIVESPEC_TRUNCATED);
    text.many.size = 11u;
    CHECK(odd_text_encode(&text, room, sizeof room, &size) == DRIVESPEC_RANGE);
    return failures;
}
"""


@pytest.mark.parametrize(("compiler", "standard"), COMPILERS)
def test_encoding_refuses_what_does_not_fit(odd: Model, tmp_path: Path, compiler: str, standard: str) -> None:
    c = write(tmp_path / "c", odd)
    source = tmp_path / "encoding.c"
    source.write_text(ENCODING)
    options = SANITIZE if not compiler.startswith("clang") else ()
    assert run(compile_c(tmp_path, source, compiler, standard, f"-I{c / 'include'}", *options)) == {}


@pytest.mark.parametrize("name", DEVICES)
def test_the_fuzz_target(c: Path, tmp_path: Path, name: str) -> None:
    """Built with libFuzzer where clang has it, else fed by a main of our own; either way with sanitizers."""
    feeder = tmp_path / "feeder.c"
    feeder.write_text(
        "#include <stdint.h>\n#include <stddef.h>\n#include <stdlib.h>\n"
        "int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);\n"
        "int main(void)\n{\n    uint32_t state = 1u;\n    for (long n = 0; n < 200000; n++) {\n"
        "        uint8_t data[40];\n        size_t size = 0u;\n"
        "        for (; size < sizeof data; size++) {\n            state = state * 1664525u + 1013904223u;\n"
        "            data[size] = (uint8_t)(state >> 24);\n"
        "            if (size > 0u && data[size] > 200u) {\n                data[size] = (uint8_t)(data[size] & 3u);\n"
        "            }\n        }\n        size = (state >> 8) % (sizeof data + 1u);\n"
        "        uint8_t *const exact = (uint8_t *)malloc(size + (size == 0u));\n"
        "        for (size_t i = 0u; i < size; i++) {\n            exact[i] = data[i];\n        }\n"
        "        LLVMFuzzerTestOneInput(exact, size);\n        free(exact);\n    }\n    return 0;\n}\n"
    )
    source = c / "test" / f"{name}_telegrams_fuzz.c"
    program = compile_c(tmp_path, source, "cc", "c99", f"-I{c / 'include'}", *SANITIZE, str(feeder))
    done = subprocess.run([str(program)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_all_headers_on_a_32_bit_machine_without_a_library(model: Model, c: Path, tmp_path: Path) -> None:
    source = tmp_path / "all.c"
    source.write_text(
        "".join(
            f'#include "drivespec/{device.id}_{part}.h"\n'
            for device in model.devices
            for part in ("tables", "telegrams")
        )
    )
    compile_c(tmp_path, source, "cc", "c99", f"-I{c / 'include'}", "-m32", "-ffreestanding", "-c")


def tried_first(layout: Layout, device: Device) -> set[str]:
    """Layouts whose every telegram this one takes, though with a value that it does not list."""
    found = set()
    for other in device.layouts:
        messages = [message(other, random.Random(seed)) for seed in range(50)]
        try:
            decoded = [decode(layout, data) for data in messages]
        except CodecError:
            continue
        for field in layout.fields:
            values = {values[field.name] for values in decoded if not isinstance(values[field.name], tuple)}
            known = {option.value for option in field.values}
            if other.protocol == layout.protocol and known and len(values) == 1 and not values & known:
                found.add(snake(device.id, other.id))
    return found


def test_comments_say_which_telegram_to_try_first(model: Model, c: Path) -> None:
    total = 0
    for device in model.devices:
        if not device.layouts:
            continue
        text = (c / f"include/drivespec/{device.id}_telegrams.h").read_text(encoding="ascii")
        for layout in device.layouts:
            head = text.partition(f"typedef struct {snake(device.id, layout.id)}_t {{")[0].rpartition("/**")[2]
            expected = tried_first(layout, device)
            assert set(re.findall(r"Try (\w+)_decode first", head)) == expected
            total += len(expected)
    assert total
