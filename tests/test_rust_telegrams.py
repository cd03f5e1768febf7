"""Telegrams of the Rust crate: the same values, bytes and refusals as the reference codec, message by message."""

import random
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace

import pytest
from rust_crate import Cargo, edge_layouts, manifest, texts

from generator.codec import CodecError, decode, encode
from generator.emit.base import EmitError
from generator.emit.rust import TARGET
from generator.emit.rust.syntax import type_name
from generator.model import BitField, Device, Field, FieldType, Layout, Model, Sizes, Values
from generator.naming import safe, snake

MESSAGES = 10_000
REFUSALS = (
    ("left over", "trailing"),
    ("must be", "constant"),
    ("is not known", "unknown_size"),
    (" are left", "truncated"),
)
"""What the reference codec says, and the name of the error everywhere."""


@pytest.fixture(scope="module")
def edge(model: Model) -> Model:
    device = next(device for device in model.devices if device.layouts)
    return replace(model, devices=(replace(device, id="type", layouts=edge_layouts(device.layouts[0]), examples=()),))


# Messages.


def messages(layout: Layout, draw: random.Random) -> Iterator[bytes]:
    """Messages that follow the layout, and such that nearly do."""
    for _ in range(MESSAGES):
        data = bytearray(valid(layout, draw))
        change = draw.randrange(8)
        if change == 0:
            del data[draw.randrange(len(data) + 1) :]
        elif change == 1:
            data += draw.randbytes(draw.randint(1, 9))
        elif change in (2, 3):
            for _ in range(draw.randint(1, 3) if data else 0):
                data[draw.randrange(len(data))] = draw.choice((0, 1, 0x7F, 0x80, 0xFF, draw.randrange(256)))
        elif change == 4:
            data = bytearray(draw.randbytes(draw.randrange(40)))
        yield bytes(data)


def valid(layout: Layout, draw: random.Random) -> bytes:
    values = drawn(layout.fields, draw, {})
    return bytes(octet or 0 for octet in encode(layout, values))


def drawn(fields: Sequence[Field], draw: random.Random, outer: Values) -> Values:
    """Random values that contradict each other nowhere; numbers that others depend on are small."""
    values: Values = {}
    by = {field.sizes.by: field.sizes for field in fields if field.sizes}
    small = {field.sizes.times for field in fields if field.sizes}
    small |= {field.count for field in fields} | {field.length for field in fields if isinstance(field.length, str)}
    for field in fields:
        scope = {**outer, **values}
        if field.constant is not None:
            values[field.name] = field.constant
        elif field.type is FieldType.GROUP:
            count = scope[field.count] if field.count else draw.randrange(4)
            assert isinstance(count, int)
            values[field.name] = tuple(drawn(field.fields, draw, scope) for _ in range(count))
        elif field.name in by:
            values[field.name] = draw.choice(by[field.name].sizes)[0]
        elif field.name in small:
            values[field.name] = draw.randrange(5)
        else:
            values[field.name] = value(field, draw, length(field, draw, scope))
    return values


def length(field: Field, draw: random.Random, scope: Values) -> int:
    if field.sizes:
        times = scope[field.sizes.times] if field.sizes.times else 1
        assert isinstance(times, int)
        return next(size for by, size in field.sizes.sizes if by == scope[field.sizes.by]) * times
    known = scope[field.length] if isinstance(field.length, str) else field.length
    assert known is None or isinstance(known, int)
    return draw.randrange(9) if known is None else known


def value(field: Field, draw: random.Random, length: int) -> int | str:
    raw = bytes(draw.choice((0, 0xFF, draw.randrange(256))) for _ in range(length))
    if field.type is FieldType.TEXT:
        return raw.decode("latin-1")
    if field.type is FieldType.BYTES:
        return raw.hex(" ").upper()
    return int.from_bytes(raw, "little", signed=field.type is FieldType.INT)


# What is said of a message: `name=value` of each field and part, then the bytes that the values encode to; or why not.


def answer(layout: Layout, data: bytes) -> str:
    try:
        values = decode(layout, data)
    except CodecError as error:
        return next(name for words, name in REFUSALS if words in str(error))
    again = bytes(octet or 0 for octet in encode(layout, values))
    return f"{shown(layout.fields, values)}-> {again.hex()}"


def shown(fields: Sequence[Field], values: Values) -> str:
    return "".join(show(field, values) for field in fields)


def show(field: Field, values: Values) -> str:
    value = values[field.name]
    if isinstance(value, tuple):
        return f"{field.name}=[{''.join(f'{{{shown(field.fields, entry)}}}' for entry in value)}] "
    if isinstance(value, str):
        raw = value.encode("latin-1") if field.type is FieldType.TEXT else bytes.fromhex(value)
        return f"{field.name}={raw.hex()} "
    parts = "".join(f"{field.name}.{part.label}={values[f'{field.name}.{part.label}']} " for part in field.bits)
    return f"{field.name}={value} {parts}"


# The same in Rust.


def driver(devices: Sequence[Device]) -> str:
    """Program that answers lines `device layout hex` as `answer` does."""
    arms: list[str] = []
    functions: list[str] = []
    for device in devices:
        module = safe(snake(device.id), "rust")
        for layout in device.layouts:
            struct = f"drivespec_devices::{module}::telegrams::{type_name(layout.id)}"
            arms.append(f'"{device.id} {layout.id}" => answer!({struct}, data),')
            functions += shows(struct, layout.fields)
    return PROGRAM.replace("ARMS", "\n        ".join(arms)).replace("SHOWS", "\n".join(functions))


def shows(struct: str, fields: Sequence[Field]) -> Iterator[str]:
    lines = []
    for field in fields:
        name = safe(snake(field.name), "rust")
        if field.type is FieldType.GROUP:
            yield from shows(f"{struct}{type_name(field.name)}Entry", field.fields)
            lines.append(f'text += "{field.name}=[";')
            lines.append(f'for entry in self.{name} {{ text += "{{"; entry.show(text); text += "}}"; }}')
            lines.append('text += "] ";')
        elif field.type in (FieldType.BYTES, FieldType.TEXT):
            lines.append(f'*text += &format!("{field.name}={{}} ", hex(self.{name}));')
        else:
            constant = f"{struct}::{name.upper()}"
            shown = f"self.{name}" if field.constant is None else constant
            lines.append(f'*text += &format!("{field.name}={{}} ", {shown});')
            for part in field.bits:
                method = f"self.{safe(snake(field.name, part.label), 'rust')}()"
                number = f"u8::from({method})" if part.low == part.high else method
                lines.append(f'*text += &format!("{field.name}.{part.label}={{}} ", {number});')
                lines += rebuilt(field, part, number)
    lines = [re.sub(r"^text \+=", "*text +=", line).replace(' text += "', ' *text += "') for line in lines]
    borrows = any(field.type not in (FieldType.UINT, FieldType.INT) for field in fields)
    head = f"impl Show for {struct}{'<' + chr(39) + '_>' if borrows else ''}"
    yield f"{head} {{ fn show(&self, text: &mut String) {{ let _ = &text; {' '.join(lines)} }} }}"


def rebuilt(field: Field, part: BitField, number: str) -> list[str]:
    """Setting a part to what it is changes nothing, setting it to its complement changes its bits alone."""
    if field.constant is not None:
        return []
    name, field_name = safe(snake(field.name, part.label), "rust"), safe(snake(field.name), "rust")
    if part.low == part.high:
        same, other = f"self.with_{snake(name)}({number} == 1)", f"self.with_{snake(name)}({number} == 0)"
    else:
        ones = (1 << (part.high - part.low + 1)) - 1
        same, other = (f"self.with_{snake(name)}({number}{change}).unwrap()" for change in ("", f" ^ {ones}"))
    kind = f"{'i' if field.type is FieldType.INT else 'u'}{8 * int(field.length or 0)}"
    return [
        f"assert_eq!({same}.{field_name}, self.{field_name});",
        f"assert_eq!(({other}.{field_name} ^ self.{field_name}) as u{kind[1:]}, {part.mask});",
    ]


PROGRAM = """#![allow(unused_parens)]
use std::io::BufRead;

trait Show {
    fn show(&self, text: &mut String);
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

macro_rules! answer {
    ($telegram:ty, $data:expr) => {{
        match <$telegram>::decode($data) {
            Ok(telegram) => {
                let mut text = String::new();
                telegram.show(&mut text);
                let mut buffer = vec![0; $data.len()];
                match telegram.encode(&mut buffer) {
                    Ok(size) => text + "-> " + &hex(&buffer[..size]),
                    Err(error) => error.as_str().to_string(),
                }
            }
            Err(error) => error.as_str().to_string(),
        }
    }};
}

fn answer(layout: &str, data: &[u8]) -> String {
    match layout {
        ARMS
        _ => panic!("{layout}"),
    }
}

SHOWS

fn main() {
    for line in std::io::stdin().lock().lines() {
        let line = line.unwrap();
        let (layout, digits) = line.rsplit_once(' ').unwrap();
        let data: Vec<u8> =
            (0..digits.len()).step_by(2).map(|at| u8::from_str_radix(&digits[at..at + 2], 16).unwrap()).collect();
        println!("{}", answer(layout, &data));
    }
}
"""


@pytest.mark.parametrize("kind", ["real", "edge"])
def test_agrees_with_the_reference(cargo: Cargo, model: Model, edge: Model, kind: str) -> None:
    chosen = model if kind == "real" else edge
    crate = cargo.locked("crate" if kind == "real" else "edge-telegrams", texts(TARGET.render(chosen)))
    folder = cargo.place(
        f"driver-{kind}",
        {"Cargo.toml": manifest(f"driver-{kind}", crate), "src/main.rs": driver(chosen.devices)},
    )
    draw = random.Random(9400)
    lines, expected = [], []
    for device in chosen.devices:
        for layout in device.layouts:
            answers = []
            for data in messages(layout, draw):
                lines.append(f"{device.id} {layout.id} {data.hex()}")
                answers.append(answer(layout, data))
            assert sum("->" in text for text in answers) > MESSAGES // 4
            expected += answers
    printed = cargo.feed(folder, "\n".join(lines) + "\n").splitlines()
    assert len(printed) == len(expected)
    differences = [(line, a, b) for line, a, b in zip(lines, printed, expected, strict=True) if a != b]
    assert differences[:3] == []
    found = Counter(text for text in expected if "->" not in text)
    assert found.keys() == {name for _, name in REFUSALS}


def test_worked_telegrams_and_random_bytes(cargo: Cargo, model: Model) -> None:
    """The crate's own tests: one for each worked telegram, one for each layout."""
    crate = cargo.locked("crate", texts(TARGET.render(model)))
    printed = cargo.succeed(crate, "test", "--offline", "--tests")
    passed = set(re.findall(r"^test (\S+) \.\.\. ok$", printed, re.MULTILINE))
    for device in model.devices:
        expected = {snake(example.id) for example in device.examples}
        expected |= {f"random::{snake(layout.id)}" for layout in device.layouts}
        assert expected <= passed
    total = sum(len(device.examples) + len(device.layouts) for device in model.devices)
    assert len(re.findall(r" \.\.\. ok$", printed, re.MULTILINE)) == total


FEEDER = """/// Feeds a fuzz target with messages of a sequence that is the same in every run.
pub fn inputs() -> impl Iterator<Item = Vec<u8>> {
    let mut state = 1u32;
    let mut next = move || {
        state = state.wrapping_mul(1664525).wrapping_add(1013904223);
        (state >> 24) as u8
    };
    (0..20_000).map(move |_| {
        let length = next() % 41;
        (0..length).map(|_| next()).map(|octet| if octet > 200 { octet & 3 } else { octet }).collect()
    })
}

#[macro_export]
macro_rules! fuzz_target {
    (|$input:ident: &[u8]| $body:block) => {
        #[no_mangle]
        pub extern "C" fn main() -> i32 {
            for data in $crate::inputs() {
                let $input: &[u8] = &data;
                $body
            }
            0
        }
    };
}
"""
"""In place of libfuzzer-sys, which needs nightly Rust."""


def test_the_fuzz_targets(cargo: Cargo, model: Model) -> None:
    files = texts(TARGET.render(model))
    crate = cargo.locked("crate", files)
    feeder = cargo.place(
        "libfuzzer-sys",
        {
            "Cargo.toml": '[package]\nname = "libfuzzer-sys"\nversion = "0.0.0"\nedition = "2021"\n',
            "src/lib.rs": FEEDER,
        },
    )
    fuzz = {path.removeprefix("fuzz/"): text for path, text in files.items() if path.startswith("fuzz/")}
    fuzz["Cargo.toml"] = fuzz["Cargo.toml"].replace('path = ".."', f'path = "{crate.as_posix()}"')
    pinned = re.compile(r'^libfuzzer-sys = "=[\d.]+"$', re.MULTILINE)
    fuzz["Cargo.toml"] = pinned.sub(f'libfuzzer-sys = {{ path = "{feeder.as_posix()}" }}', fuzz["Cargo.toml"])
    folder = cargo.place("fuzz", fuzz)
    cargo.component(folder, "fmt")
    cargo.succeed(folder, "fmt", "--check")
    devices = [device for device in model.devices if device.layouts]
    assert len(fuzz) == 1 + len(devices)
    for device in devices:
        cargo.succeed(folder, "run", "--offline", "--quiet", "--bin", safe(snake(device.id), "rust"))


ENCODING = {
    "Odd { three: 0x00FF_FFFF, seven: 1, below: -1, far: 1 << 47, ..Odd::default() }": 'Err(Range("far"))',
    "Odd { three: 0x0100_0000, ..Odd::default() }": 'Err(Range("three"))',
    "Odd { seven: 1 << 56, ..Odd::default() }": 'Err(Range("seven"))',
    "Odd { below: 0x0080_0000, ..Odd::default() }": 'Err(Range("below"))',
    "Odd { below: -0x0080_0001, ..Odd::default() }": 'Err(Range("below"))',
    "Odd { below: -0x0080_0000, far: -1 << 47, ..Odd::default() }": "Ok(32)",
    "Locals { size: 3, ..Locals::default() }": 'Err(UnknownSize("reader"))',
    "Locals { size: 1, reader: 256, ..Locals::default() }": 'Err(Range("reader"))',
    'Locals { size: 1, writer: b"xy", data: b"x", ..Locals::default() }': 'Err(Range("writer"))',
    'Locals { size: 1, writer: b"x", data: b"xy", ..Locals::default() }': 'Err(Range("data"))',
    'Locals { size: 1, writer: b"x", data: b"x", found: b"xyz", ..Locals::default() }': "Ok(10)",
    'Signed { type_: -1, length: 2, value: b"xyzw", number: -0x8000 }': "Ok(8)",
    'Signed { type_: -1, length: 2, value: b"xyzw", number: -0x8001 }': 'Err(Range("number"))',
    "Signed { type_: 0, number: 1, ..Signed::default() }": 'Err(Range("number"))',
    "Signed { type_: 1, ..Signed::default() }": 'Err(UnknownSize("value"))',
    "Groups::default()": 'Err(Count("pairs"))',
    'Groups { pairs: Repeated::new(&[GroupsPairsEntry { one: 1, two: b"x" }; 2]), ..Groups::default() }': "Ok(5)",
    'Groups { pairs: Repeated::new(&[GroupsPairsEntry { one: 2, two: b"x" }; 2]), ..Groups::default() }': (
        'Err(Range("two"))'
    ),
    'Groups { pairs: Repeated::new(&[GroupsPairsEntry { one: 9, two: b"123456789" }; 2]), ..Groups::default() }': (
        "Ok(21)"
    ),
    "EmptyEnd { text: &[0; 65] }": "Err(Capacity)",
    "EmptyEnd { text: &[0; 64] }": "Ok(64)",
    "Constants {}": "Ok(1)",
}
"""Values and what encoding them into 64 bytes gives."""

PROBES = {
    "Groups::decode(&[2, 0, 1, 65, 1, 1, 2]).unwrap().pairs.len()": "2",
    "Groups::decode(&[2, 0, 1, 65, 1, 1, 2]).unwrap().rest.iter().next().unwrap().inner.iter().next()": (
        "Some(GroupsRestEntryInnerEntry { x: 513 })"
    ),
    "Groups::decode(&[2, 0, 0]).unwrap().rest.is_empty()": "true",
    "Groups::decode(&[2, 0, 0]).unwrap() == Groups::decode(&[2, 0, 0, 0]).unwrap()": "false",
    "Groups::decode(&[2, 0, 0]).unwrap().pairs.iter().size_hint()": "(2, Some(2))",
    "Bits::default().with_word_run(0x1FF).unwrap().word": "1022",
    "Bits::default().with_word_run(0x200)": 'Err(Range("word.Run"))',
    "Bits::default().with_word_top(true).word": "-32768",
    "Bits { word: -32768, all: 0 }.word_top()": "true",
    "Bits::default().with_all_all(u32::MAX).unwrap().all": "4294967295",
    "(Bits::ALL_ON_1, Bits::ALL_OFF, Bits::ALL_ON_5, Bits::ALL_ALL_10_PERCENT, Bits::FIXED)": "(1, 0, 5, 3, 129)",
    "(Bits::ENCODED_SIZE, Bits::default().fixed_high(), Bits::default().fixed_low())": "(7, true, 1)",
    "Constants::decode(&[8]).unwrap_err().to_string()": '"field `fixed` has another value than it must"',
    "Constants::decode(&[7, 7]).unwrap_err().to_string()": '"1 bytes are left over"',
    "Constants::decode(&[]).unwrap_err().to_string()": '"the telegram ends before field `fixed` does"',
    "Signed::decode(&[1, 0]).unwrap_err().to_string()": '"the length of field `value` is not known"',
}


def test_refuses_contradictory_values(cargo: Cargo, edge: Model) -> None:
    crate = cargo.locked("edge-telegrams", texts(TARGET.render(edge)))
    probes = {f"({value}).encode(&mut [0; 64])": result for value, result in ENCODING.items()} | PROBES
    assert cargo.probe("refusals", crate, ["codec::*", "type_::telegrams::*"], list(probes)) == probes


def test_comments(model: Model) -> None:
    files = texts(TARGET.render(model))
    for device in model.devices:
        text = files.get(f"src/{device.id}/telegrams.rs", "")
        for layout in device.layouts:
            block = re.search(rf"((?:///.*\n)+)(?:#\[.*\n)+(pub struct {type_name(layout.id)}\b[^}}]*)", text)
            assert block, layout.id
            comment, body = (
                re.sub(r"\\(?=[^\w\s])", "", " ".join(part.replace("///", "").split())) for part in block.groups()
            )
            page = f" p. {layout.cite.page}" if layout.cite.page is not None else ""
            expected = [layout.name, " ".join(layout.description.split()), layout.protocol]
            expected += [f"Source: {layout.cite.manual}, {layout.cite.chapter}{page}", *layout.errata]
            assert [words for words in expected if words not in comment] == []
            own = [field for field in layout.fields if field.constant is None]
            told = [" ".join(words.split()) for field in own for words in (field.title, field.description)]
            assert [words for words in told if words not in body] == []


def test_comments_say_what_to_try_first(model: Model, edge: Model) -> None:
    """An abort of SDO is eight bytes as any other message; what has another constant as well is no case of a layout."""

    def cases(model: Model) -> set[tuple[str, str]]:
        found = set()
        for path, text in texts(TARGET.render(model)).items():
            for told, struct in re.findall(r"tried first: (.*)\n(?:///.*\n|#\[.*\n)*pub struct (\w+)", text):
                found.add((path.removeprefix("src/").removesuffix("/telegrams.rs"), f"{struct}: {told}"))
        return found

    told = "Sdo: [`SdoError`] (`command` 0x80)"
    assert cases(model) == {("e94aycca", told), ("servo931", told)}
    assert cases(edge) == set()


def test_refuses_what_has_no_type(model: Model) -> None:
    device = next(device for device in model.devices if device.layouts)
    layout = device.layouts[0]
    byte = next(field for field in layout.fields if field.length == 1)
    inner = replace(byte, name="inner", type=FieldType.BYTES, length=byte.name, bits=(), values=(), bit_values=())
    group = replace(inner, name="group", type=FieldType.GROUP, length=None, fields=(inner,))
    times = replace(byte, name="n", length=None, sizes=Sizes(byte.name, ((1, 1),), byte.name))
    for fields in ((byte, group), (replace(byte, length=9),), (byte, times)):
        changed = replace(device, layouts=(replace(layout, fields=fields),), examples=())
        with pytest.raises(EmitError) as caught:
            TARGET.render(replace(model, devices=(changed,)))
        assert caught.value.rule == "telegram-field"
