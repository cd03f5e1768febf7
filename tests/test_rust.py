"""The Rust crate: built, linted, documented and run by cargo, and compared with the model fact by fact."""

import json
import random
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import count
from math import ceil, floor
from pathlib import Path

import pytest
from bare import bare
from rust_crate import Cargo, edge_indicators, edge_layouts, edge_switches, edge_tables, manifest, texts

from generator.emit import names
from generator.emit.base import EmitError
from generator.emit.rust import TARGET
from generator.emit.rust.syntax import doc
from generator.emit.switches import remarks
from generator.model import (
    Access,
    Bit,
    BitField,
    Cite,
    Code,
    CodeRef,
    DataType,
    Default,
    Device,
    DictionaryObject,
    Drive,
    ErrorEntry,
    IndicatorRow,
    IndicatorTable,
    Model,
    NodeRelative,
    Option,
    Range,
    SubCode,
    SubIndex,
    SwitchGroup,
)

REPORTED = ("response", "instance")
HOSTILE = (
    "Text [with] <markup> *and* `ticks`, _edges_, ~~strokes~~ and a\\backslash | - 5 + 3 # 1. 2) "
    'https://example.org/a_b longer than one line of the comment, to be wrapped between "words" - or at a dash'
)


@pytest.fixture(scope="module")
def edge(model: Model) -> Model:
    """A model of what the manuals at hand do not have: every kind of value, name and gap."""
    return edge_model(model)


@pytest.fixture(scope="module")
def edge_crate(cargo: Cargo, edge: Model) -> Path:
    return cargo.locked("edge", texts(TARGET.render(edge)))


# What the dump has to print, in its order.


def facts(model: Model) -> Iterator[str]:
    for kind in DataType:
        yield from entry(f"type/{kind.canopen_name}", number=kind.canopen_number, bits=kind.bits, signed=kind.signed)
    for device in model.devices:
        yield from device_facts(device)


def entry(path: str, **values: object) -> Iterator[str]:
    for key, value in values.items():
        if value is not None:
            text = str(value).lower() if isinstance(value, bool) else str(value)
            escaped = text.replace("\\", "\\\\").replace("\n", "\\n")
            yield f"{path}/{key}={escaped}"


def listed(path: str, items: Sequence[object]) -> Iterator[str]:
    for position, item in enumerate(items):
        yield from entry(path, **{str(position): item})


def device_facts(device: Device) -> Iterator[str]:
    path = device.id
    yield from entry(path, title=device.title, manufacturer=device.manufacturer, order_code=device.order_code)
    yield from entry(path, bus=device.bus, hardware_version=device.hardware_version)
    yield from entry(path, software_version=device.software_version)
    manual = device.manual
    yield from entry(f"{path}/manual", id=manual.id, title=manual.title, publisher=manual.publisher)
    yield from entry(f"{path}/manual", edition=manual.edition, date=manual.date, document=manual.document)
    if device.drive:
        yield from drive_facts(f"{path}/drive", device.drive)
    for slot in device.slots:
        values = {key: getattr(slot, key) for key in ("first_code", "last_code", "code_offset", "error_offset")}
        yield from entry(f"{path}/slot/{slot.name}", **values)
    if device.canopen:
        yield from listed(f"{path}/can_open/baud_rate", device.canopen.baud_rates)
        values = {key: getattr(device.canopen, key) for key in ("granularity", "node_address", "boot_up_master")}
        yield from entry(f"{path}/can_open", **values)
    for code in device.codes:
        yield from code_facts(f"{path}/code/{code.number}", code)
    for item in sorted(device.objects, key=lambda item: (item.kind, item.index)):
        yield from object_facts(f"{path}/object/{item.kind}/{item.index}", item)
    for kind in sorted({error.kind for error in device.errors}):
        yield from entry(f"{path}/error/{kind}", mask=mask(device, kind))
        for error in sorted(device.errors, key=lambda error: error.number):
            if error.kind == kind:
                yield from error_facts(f"{path}/error/{kind}/{error.number}", error)
    for table in device.indicators:
        yield from indicator_facts(f"{path}/indicator/{table.id}", table)
    for group in device.switches:
        yield from switch_facts(f"{path}/switch/{group.id}", group)
    for erratum in sorted(device.errata, key=lambda erratum: erratum.id):
        where = f"{path}/erratum/{erratum.id}"
        yield from entry(where, kind=erratum.kind)
        yield from listed(f"{where}/about", erratum.about_text)
        yield from entry(where, printed=erratum.printed_text, used=erratum.used_text)
        for position, place in enumerate(erratum.places):
            values = {key: getattr(place, key) for key in ("location", "page", "manual", "printed")}
            yield from entry(f"{where}/place/{position}", **values)
        yield from entry(where, why=erratum.why, confidence=erratum.confidence, origin=erratum.origin)


def drive_facts(path: str, drive: Drive) -> Iterator[str]:
    yield from entry(path, id=drive.id, title=drive.title, manufacturer=drive.manufacturer)
    yield from entry(path, index_base=drive.index_base)
    for name, field in drive.error_fields:
        yield from field_facts(f"{path}/error_field/{name}", [field])
    for word, entries in (("response", drive.responses), ("module", drive.modules), ("command", drive.commands)):
        for value in entries:
            yield from entry(f"{path}/{word}", **{str(value.value): value.name})


def indicator_facts(path: str, table: IndicatorTable) -> Iterator[str]:
    yield from entry(path, name=table.name)
    for position, led in enumerate(table.leds):
        yield from entry(f"{path}/led/{position}", label=led.label, colour=led.colour, name=led.name)
    for position, row in enumerate(table.rows):
        where = f"{path}/row/{position}"
        for number, pattern in enumerate(row.patterns):
            times = [None if time is None else int(time * 1000) for time in (pattern.period, pattern.pause)]
            yield from entry(f"{where}/pattern/{number}", light=pattern.light.value, colour=pattern.colour)
            yield from entry(f"{where}/pattern/{number}", period=times[0], flashes=pattern.flashes, pause=times[1])
        yield from entry(where, state=row.state, meaning=row.meaning)
        yield from source_facts(where, row, ())
    yield from cite_facts(path, table.cite)
    yield from listed(f"{path}/erratum", table.errata)


def switch_facts(path: str, group: SwitchGroup) -> Iterator[str]:
    yield from entry(path, name=group.name)
    yield from listed(f"{path}/label", group.labels)
    yield from listed(f"{path}/weight", group.weights)
    yield from listed(f"{path}/valid", group.valid or ())
    yield from entry(path, unit=group.unit)
    yield from listed(f"{path}/sets", group.sets)
    for position, row in enumerate(group.rows):
        number = int(row.value) if row.value.isdecimal() else None
        on, either = (int("".join("01"[p == of] for p in row.positions), 2) for of in "1x")
        yield from entry(f"{path}/row/{position}", value=row.value, number=number, on=on, either=either)
    yield from listed(f"{path}/note", remarks(group))
    yield from source_facts(path, group, group.errata)


def code_facts(path: str, code: Code) -> Iterator[str]:
    yield from entry(path, slot=code.slot, twin_of=code.twin_of, name=code.name, index=code.index)
    yield from entry(path, type_name=code.type_name, data_type=code.data_type.canopen_name, length=code.length)
    yield from entry(path, read=code.access.read, write=code.access.write)
    yield from listed(f"{path}/condition", code.access.conditions)
    yield from entry(path, scaling=code.scaling)
    yield from range_facts(path, code.range, code.scaling or 1)
    yield from entry(path, default=default_text(code.default))
    yield from option_facts(path, code.options)
    yield from bit_facts(path, code.bits)
    yield from field_facts(path, code.fields)
    for sub in code.subcodes:
        where = f"{path}/subcode/{sub.number}"
        yield from entry(where, name=sub.name, default=default_text(sub.default), follows=default_text(sub.follows))
        yield from option_facts(where, sub.options)
    yield from listed(f"{path}/object", code.objects)
    yield from entry(path, since=code.since, internal=code.internal, shared_by=code.shared_by)
    yield from source_facts(path, code, code.errata)


def object_facts(path: str, item: DictionaryObject) -> Iterator[str]:
    yield from entry(path, name=item.name, object_type=item.object_type)
    for sub in item.subindexes:
        where = f"{path}/subindex/{sub.number}"
        yield from entry(where, name=sub.name, data_type=sub.data_type.canopen_name, access=sub.access)
        yield from entry(where, default=default_text(sub.default))
        yield from range_facts(where, sub.range, 1)
        yield from option_facts(where, sub.options)
        yield from bit_facts(where, sub.bits)
        yield from field_facts(where, sub.fields)
        yield from listed(f"{where}/code", sub.codes)
        yield from entry(where, signature=sub.signature, pdo_mapping=sub.pdo_mapping, unused=sub.unused)
        yield from entry(where, abort=sub.abort)
        yield from listed(f"{where}/erratum", sub.errata)
    yield from source_facts(path, item, item.errata)


def error_facts(path: str, error: ErrorEntry) -> Iterator[str]:
    yield from entry(path, last=error.last, slot=error.slot, name=error.name, response=error.response)
    yield from listed(f"{path}/response", error.responses)
    yield from listed(f"{path}/adjustable_in", error.adjustable_in)
    yield from entry(path, register=error.register)
    yield from listed(f"{path}/cause", error.causes)
    yield from listed(f"{path}/remedy", error.remedies)
    yield from source_facts(path, error, error.errata)


def source_facts(
    path: str,
    fact: Code | DictionaryObject | ErrorEntry | IndicatorRow | SwitchGroup,
    errata: Sequence[str],
) -> Iterator[str]:
    yield from entry(path, origin=fact.origin.value)
    yield from cite_facts(path, fact.cite)
    yield from listed(f"{path}/erratum", errata)


def cite_facts(path: str, cite: Cite) -> Iterator[str]:
    yield from entry(f"{path}/cite", manual=cite.manual, chapter=cite.chapter, page=cite.page)


def range_facts(path: str, value: Range | None, factor: int) -> Iterator[str]:
    if value:
        yield from entry(
            f"{path}/range", low=ceil(value.low * factor), high=floor(value.high * factor), unit=value.unit
        )


def option_facts(path: str, options: Sequence[Option]) -> Iterator[str]:
    for option in options:
        yield from entry(f"{path}/option", **{str(option.value): option.label})


def bit_facts(path: str, bits: Sequence[Bit]) -> Iterator[str]:
    for bit in bits:
        yield from entry(f"{path}/bit", **{str(bit.number): bit.label})


def field_facts(path: str, fields: Sequence[BitField]) -> Iterator[str]:
    for field in fields:
        yield from entry(f"{path}/field", **{f"{field.low}...{field.high}": field.label})


def default_text(value: Default | None) -> str | None:
    match value:
        case NodeRelative():
            return f"node+{value.base}"
        case str():
            return f"'{value}'"
        case _:
            return None if value is None else str(value)


def mask(device: Device, kind: str) -> int:
    reported = 0
    if device.drive and kind == "device":
        for name, field in device.drive.error_fields:
            if name in REPORTED:
                reported |= sum(1 << bit for bit in range(field.low, field.high + 1))
    return 0xFFFF_FFFF - reported


def compare(printed: str, model: Model) -> None:
    """Facts printed and facts of the model are the same, in the same order, and no two share a path."""
    lines, expected = printed.splitlines(), list(facts(model))
    missing = sorted(set(expected) - set(lines))
    surplus = sorted(set(lines) - set(expected))
    assert (missing[:5], surplus[:5]) == ([], [])
    assert lines == expected
    assert len({line.split("=", 1)[0] for line in lines}) == len(lines)


# The real crate.


@pytest.mark.parametrize("features", [(), ("--no-default-features",), ("--all-features",)], ids=" ".join)
def test_no_warnings(cargo: Cargo, crate: Path, features: tuple[str, ...]) -> None:
    cargo.component(crate, "clippy")
    cargo.succeed(crate, "clippy", "--offline", "--all-targets", *features, "--", "-D", "warnings")


def test_each_device_builds_alone(cargo: Cargo, crate: Path, model: Model) -> None:
    for feature in [device.id for device in model.devices]:
        cargo.succeed(crate, "check", "--offline", "--no-default-features", "--features", feature)


def test_documentation(cargo: Cargo, crate: Path) -> None:
    cargo.succeed(crate, "doc", "--offline", "--no-deps", "--all-features")


def test_formatted_as_rustfmt_does(cargo: Cargo, crate: Path) -> None:
    cargo.component(crate, "fmt")
    cargo.succeed(crate, "fmt", "--check")


def test_example_of_the_readme(cargo: Cargo, crate: Path) -> None:
    printed = cargo.succeed(crate, "test", "--offline", "--doc")
    assert "test src/lib.rs" in printed
    assert "test result: ok. 1 passed" in printed


def test_every_fact(cargo: Cargo, crate: Path, model: Model) -> None:
    compare(cargo.succeed(crate, "run", "--offline", "--quiet", "--example", "dump"), model)


def test_names_and_lookups(cargo: Cargo, crate: Path, model: Model) -> None:
    expected = dict(probes(model))
    assert cargo.probe("probe", crate, ["*"], list(expected)) == expected


def test_package(cargo: Cargo, crate: Path, crate_files: dict[str, str]) -> None:
    """What is published holds every file but those for fuzzing, and builds."""
    packed = cargo.succeed(crate, "package", "--offline", "--allow-dirty", "--list").splitlines()
    assert {path for path in crate_files if not path.startswith("fuzz/")} <= set(packed)
    assert not any(path.startswith("fuzz/") for path in packed)
    cargo.succeed(crate, "package", "--offline", "--allow-dirty")


def test_consumer(cargo: Cargo, crate: Path, root: Path) -> None:
    """A program that knows the crate from its documentation alone."""
    home = root / "tests" / "consumers" / "rust"
    program = {path: (home / path).read_text(encoding="utf-8") for path in ("Cargo.toml", "src/main.rs")}
    assert '"../../../generated/rust"' in program["Cargo.toml"]
    program["Cargo.toml"] = program["Cargo.toml"].replace("../../../generated/rust", crate.as_posix())
    folder = cargo.place("busmonitor", program)
    printed = cargo.feed(folder, (home / "log.txt").read_text(encoding="utf-8"))
    assert printed == (home / "expected.txt").read_text(encoding="utf-8")
    cargo.component(folder, "clippy")
    cargo.succeed(folder, "clippy", "--offline", "--", "-D", "warnings")


def test_works_without_std(cargo: Cargo, crate: Path) -> None:
    """A static library with a panic handler of its own: it does not build when anything below it uses std."""
    program = (
        "#![no_std]\n\nuse drivespec_devices::DEVICES;\n\n"
        "#[panic_handler]\nfn panic(_: &core::panic::PanicInfo) -> ! {\n    loop {}\n}\n\n"
        '#[no_mangle]\npub extern "C" fn index(number: u16) -> u16 {\n'
        "    DEVICES.iter().find_map(|device| device.codes.get(number)).map_or(0, |code| code.index)\n}\n"
    )
    settings = '\n[lib]\ncrate-type = ["staticlib"]\n\n[profile.dev]\npanic = "abort"\n'
    bare = cargo.place("bare", {"Cargo.toml": manifest("bare", crate) + settings, "src/lib.rs": program})
    cargo.succeed(bare, "build", "--offline")
    hosted = manifest("hosted", crate, '"std"') + settings
    done = cargo.run(cargo.place("hosted", {"Cargo.toml": hosted, "src/lib.rs": program}), "build", "--offline")
    assert "panic_impl" in done.stderr


def probes(model: Model) -> Iterator[tuple[str, str]]:
    """Expressions and what ``{:?}`` prints of them."""
    for device in model.devices:
        yield from code_probes(device)
        yield from bit_probes(device)
        yield from object_probes(device)
        yield from error_probes(device)


def code_probes(device: Device) -> Iterator[tuple[str, str]]:
    table = f"{device.id}::codes::TABLE"
    codes = {code.number: code for code in device.codes}
    for number, code in codes.items():
        yield f"{device.id}::codes::{names.code_name(code).upper()}.number", str(number)
        yield f"{table}.get({number}).map(|code| code.index)", f"Some({code.index})"
        yield f"{table}.get({number}).unwrap().cite.to_string()", json.dumps(str(code.cite), ensure_ascii=False)
        yield f"{table}.get_by_index({code.index}).map(|code| code.number)", f"Some({number})"
        for neighbour in {number - 1, number + 1} - codes.keys():
            yield f"{table}.get({neighbour}).is_none()", "true"
        for sub in code.subcodes[:1]:
            yield (
                f"{table}.get({number}).unwrap().subcode({sub.number}).unwrap().name",
                json.dumps(sub.name, ensure_ascii=False),
            )
            yield f"{table}.get({number}).unwrap().subcode({code.highest_subcode + 1})", "None"
        if code.options and code.twin_of == number:
            yield from option_probes(f"{device.id}::selections::{pascal(names.code_name(code))}", code.options)
    if codes:
        for index in (0, 0xFFFF):
            yield f"{table}.get_by_index({index}).is_none()", "true"


def option_probes(enum: str, options: Sequence[Option]) -> Iterator[tuple[str, str]]:
    for option, name in zip(options, names.option_names(options), strict=True):
        variant = f"{enum}::{pascal(name if name[0].isalpha() else f'n{name}')}"
        yield f"({variant}.raw(), {variant}.label())", f'({option.value}, "{option.label}")'
        yield f"{enum}::try_from({option.value}) == Ok({variant})", "true"
    unknown = next(value for value in count() if all(option.value != value for option in options))
    yield (
        f"{enum}::try_from({unknown}).map_err(|error| (error.raw, error.to_string()))",
        (f'Err(({unknown}, "value {unknown} is not in the selection list"))'),
    )


def bit_probes(device: Device) -> Iterator[tuple[str, str]]:
    for code in device.codes:
        if code.twin_of == code.number:
            module = f"{device.id}::bits::{names.code_name(code)}"
            for bit, name in zip(code.bits, names.bit_names(code.bits), strict=True):
                yield f"{module}::{name.upper()}", str(2**bit.number)
            for field, name in zip(code.fields, names.field_names(code.fields), strict=True):
                name = (name if name[0].isalpha() else f"n{name}").upper()
                ones = 2 ** (field.high + 1) - 2**field.low
                yield f"({module}::{name}_MASK, {module}::{name}_SHIFT)", f"({ones}, {field.low})"
                found, largest = f"{module}::FIELDS[{code.fields.index(field)}]", ones >> field.low
                yield f"{found}.get({ones})", str(largest)
                yield f"{found}.put({ones}, 1)", f"Some({1 << field.low})"
                yield f"({found}.put(0, {largest}), {found}.put(0, {largest + 1}))", f"(Some({ones}), None)"


def object_probes(device: Device) -> Iterator[tuple[str, str]]:
    for item in device.objects:
        kind = {"canopen": "CanOpen", "profidrive": "Profidrive"}[item.kind]
        found = f"{device.id}::objects::TABLE.get(types::ObjectKind::{kind}, {item.index})"
        yield f"{device.id}::objects::{names.object_name(item).upper()}.index", str(item.index)
        yield f"{found}.map(|object| object.index)", f"Some({item.index})"
        last = item.subindexes[-1]
        yield f"{found}.unwrap().subindex({last.number}).map(|entry| entry.number)", f"Some({last.number})"
        if all(other.index != item.index + 1 for other in device.objects):
            yield f"{device.id}::objects::TABLE.get(types::ObjectKind::{kind}, {item.index + 1}).is_none()", "true"


def error_probes(device: Device) -> Iterator[tuple[str, str]]:
    """Each end of each run, and the numbers beside them, plain and with all bits set that the drive fills."""
    for kind in {error.kind: None for error in device.errors}:
        errors = [error for error in device.errors if error.kind == kind]
        found = f"{device.id}::errors::{kind}::TABLE.get"
        for error in errors:
            for number in {error.number - 1, error.number, error.last, error.last + 1}:
                hit = next((other.number for other in errors if other.number <= number <= other.last), None)
                shown = f"Some({hit})" if hit is not None else "None"
                for reported in {number, number | 0xFFFF_FFFF - mask(device, kind)} if 0 <= number < 2**32 else ():
                    yield f"{found}({reported}).map(|error| error.number)", shown


def pascal(name: str) -> str:
    words = "".join(word[:1].upper() + word[1:] if word else "" for word in name.replace("_", " _ ").split(" "))
    return re.sub(r"(?<=[0-9])_(?=[0-9])", "+", words).replace("_", "").replace("+", "_")


# Comments.


def test_comments_of_codes(crate_files: dict[str, str], model: Model) -> None:
    for device in model.devices:
        explained = {erratum.id: erratum for erratum in device.errata}
        comments = comments_of(crate_files.get(f"src/{device.id}/codes.rs", ""))
        for code in device.codes:
            comment = comments[names.code_name(code).upper()]
            assert comment.startswith(f"{code.designation} in slot {code.slot}: " if code.slot else code.designation)
            expected = [code.name.removesuffix("."), flat(code.description), f"0x{code.index:04X} ({code.index})"]
            expected += [source(code), code.type_name, code.since or ""]
            if code.range:
                expected.append(code.range.unit)
            if isinstance(code.default, int):
                expected.append("Default: ")
            expected += [str(ref) for ref in code.objects]
            for erratum in code.errata:
                expected += [f"Erratum `{erratum}`", f"used {flat(explained[erratum].used_text)}"]
                expected.append(f"printed {flat(explained[erratum].printed_text)}")
            assert [text for text in expected if text not in comment] == []
            for sub in code.subcodes:
                numbered = re.sub(rf"(?<![\w.]){sub.number}(?![\w.])", "*n*", sub.name)
                assert sub.name.removesuffix(".") in comment or numbered.removesuffix(".") in comment


def test_comments_of_objects_and_errors(crate_files: dict[str, str], model: Model) -> None:
    for device in model.devices:
        comments = comments_of(crate_files.get(f"src/{device.id}/objects.rs", ""))
        for item in device.objects:
            comment = comments[names.object_name(item).upper()]
            expected = [item.designation, item.name, flat(item.description), source(item)]
            expected += [f"Erratum `{erratum}`" for sub in item.subindexes for erratum in sub.errata]
            for sub in item.subindexes:
                expected += [f"{sub.data_type.canopen_name} {sub.access}", sub.range.unit if sub.range else ""]
                expected.append(flat(sub.description).removesuffix("."))
            assert [text for text in expected if text not in comment] == []
        for error in device.errors:
            comments = comments_of(crate_files[f"src/{device.id}/errors/{error.kind}.rs"])
            comment = next(text for text in comments.values() if f"{error.number:04X}" in text and error.name in text)
            expected = [flat(error.description), source(error), *map(flat, error.causes), *map(flat, error.remedies)]
            expected += [
                error.response or "",
                error.register or "",
                *(f"Erratum `{erratum}`" for erratum in error.errata),
            ]
            assert [text for text in expected if text not in comment] == []


def comments_of(text: str) -> dict[str, str]:
    """Comments of the constants of a module, without line ends and escapes."""
    comments: dict[str, str] = {}
    lines: list[str] = []
    for line in text.splitlines():
        if line.startswith("///"):
            lines.append(line[3:].strip())
        elif line:
            if found := re.match(r"pub const (\w+):", line):
                comments[found[1]] = re.sub(r"\\(?=[^\w\s])", "", flat(" ".join(lines)))
            lines = []
    return comments


def flat(text: str) -> str:
    return " ".join(text.split())


def source(fact: Code | DictionaryObject | ErrorEntry) -> str:
    page = f" p. {fact.cite.page}" if fact.cite.page is not None else ""
    return f"Source: {fact.cite.manual}, {fact.cite.chapter}{page}"


def test_lines_fit_and_heads_name_the_source(crate_files: dict[str, str], model: Model) -> None:
    for path, text in crate_files.items():
        if path.endswith(".rs"):
            first, second, third, *_ = text.splitlines()
            assert first.startswith(f"// Generated by drivespec {model.version} ({model.date}) ")
            assert first.endswith("do not edit.")
            assert second == "// Not a file of the manufacturer."
            assert any(f"edition {manual.edition} ({manual.id})" in third for manual in model.manuals)
        comments = [line for line in text.splitlines() if line.lstrip().startswith("//") and "](" not in line]
        assert [line for line in comments if len(line) > 120] == []


def test_same_input_same_files(model: Model, crate_files: dict[str, str]) -> None:
    assert texts(TARGET.render(model)) == crate_files
    assert list(TARGET.render(model)) == list(crate_files)


# What the manuals at hand do not have.


def test_every_fact_of_the_edge_cases(cargo: Cargo, edge_crate: Path, edge: Model) -> None:
    compare(cargo.succeed(edge_crate, "run", "--offline", "--quiet", "--example", "dump"), edge)


def test_edge_cases_have_no_warnings(cargo: Cargo, edge_crate: Path) -> None:
    cargo.succeed(edge_crate, "doc", "--offline", "--no-deps")
    cargo.component(edge_crate, "clippy")
    cargo.succeed(edge_crate, "clippy", "--offline", "--all-targets", "--", "-D", "warnings")


def test_edge_cases_are_formatted(cargo: Cargo, edge_crate: Path) -> None:
    cargo.component(edge_crate, "fmt")
    cargo.succeed(edge_crate, "fmt", "--check")


def test_a_model_without_devices_builds(cargo: Cargo, model: Model) -> None:
    empty = cargo.locked("empty", texts(TARGET.render(replace(model, devices=(), drives=()))))
    cargo.succeed(empty, "check", "--offline")


def edge_model(model: Model) -> Model:
    device = next(device for device in model.devices if device.codes and device.objects and device.errors)
    empty = bare(device)
    reserved = replace(
        empty,
        id="type",
        title='Device "type" \\ [x]',
        codes=edge_codes(device.codes[0]),
        objects=edge_objects(device.objects[0]),
        errors=edge_errors(device.errors[0]),
        indicators=edge_indicators(device.indicators[0]),
        switches=edge_switches(device.switches[0]),
        tables=edge_tables(device.tables[0]),
        layouts=edge_layouts(device.layouts[0]),
    )
    alone = replace(
        empty, id="alone", codes=reserved.codes[:1], objects=reserved.objects[:1], errors=reserved.errors[:1]
    )
    return replace(model, devices=(device, empty, reserved, alone))


def edge_codes(like: Code) -> tuple[Code, ...]:
    base = like.index + like.number
    plain = replace(
        like,
        slot=None,
        name="Plain",
        length=None,
        scaling=None,
        range=None,
        default=None,
        default_cite=None,
        options=(),
        bits=(),
        fields=(),
        subcodes=(),
        objects=(),
        errata=(),
        description="",
    )
    codes = [
        plain,
        replace(plain, name="", access=Access(False, False, ("cinh", "plc_stop"))),
        replace(
            plain,
            name="Text",
            type_name="VISIBLE_STRING",
            data_type=DataType.VISIBLE_STRING,
            length=32,
            default='a "text" \\ of\ntwo lines',
            description=HOSTILE,
            since="V3.0",
            internal=True,
        ),
        replace(
            plain,
            name="Signed",
            type_name="INTEGER_16",
            data_type=DataType.INTEGER16,
            scaling=10,
            range=Range(Fraction(-1999, 10), Fraction(1999, 10), "µs"),
            default=-5,
            options=(Option(-5, "self"), Option(-6, "self"), Option(0, "10 %"), Option(7, "7 ns")),
        ),
        replace(plain, name="Thirds", range=Range(Fraction(1, 3), Fraction(10, 3)), default=NodeRelative(0x80)),
        replace(
            plain,
            name="Gaps",
            default_cite=like.cite,
            type_name="BITFIELD_32",
            data_type=DataType.UNSIGNED32,
            bits=(Bit(0, "Störung *"), Bit(31, "Reserved"), Bit(30, "Reserved"), Bit(4, "7 bits")),
            fields=(BitField(0, 31, "All"), BitField(5, 5, "One"), BitField(6, 7, "fn")),
            subcodes=tuple(
                SubCode(
                    number=number,
                    name=name,
                    default=number,
                    follows=NodeRelative(0x180 + number) if number == 3 else None,
                    options=options,
                    description=HOSTILE if number == 3 else "",
                    where=like.where,
                )
                for number, name, options in (
                    (1, "", (Option(1, "On"), Option(0, "Off"))),
                    (3, "Third", (Option(0x8000_0000, "Highest"),)),
                    (7, "Seventh", (Option(1, "On"), Option(0, "Off"))),
                    (255, "Last", ()),
                )
            ),
        ),
        replace(plain, name=HOSTILE[:60], internal=True),
    ]
    numbered = [
        replace(code, number=10 * n + 1, twin_of=10 * n + 1, index=base - 10 * n - 1) for n, code in enumerate(codes)
    ]
    twin = replace(numbered[5], number=99, index=base - 99, slot="MXI2", bits=(Bit(1, "Other"),))
    return (*numbered, twin)


def edge_objects(like: DictionaryObject) -> tuple[DictionaryObject, ...]:
    plain = replace(
        like.subindexes[0],
        default=None,
        range=None,
        options=(),
        bits=(),
        fields=(),
        codes=(),
        signature=None,
        errata=(),
        description="",
    )
    subindexes: list[SubIndex] = [
        replace(plain, name=f"Entry {access}", access=access, printed_access="rw")
        for access in ("ro", "wo", "rw", "const", "rwr", "rww")
    ]
    shared = (BitField(0, 3, "Low"),)
    subindexes += [
        replace(plain, fields=shared, signature='"x"', pdo_mapping=True, unused=True, abort=0x0602_0000),
        replace(plain, fields=shared, codes=(CodeRef(1), CodeRef(51, 1)), default=NodeRelative(0x580)),
        replace(plain, data_type=DataType.INTEGER8, options=(Option(-128, "Least"), Option(127, "Most"))),
        replace(plain, data_type=DataType.DOMAIN, default="\t"),
    ]
    numbered = tuple(replace(sub, number=3 * n) for n, sub in enumerate(subindexes))
    item = replace(like, index=918, object_type="RECORD", subindexes=numbered, errata=(), description=HOSTILE)
    return (item, replace(item, kind="profidrive", name="Node address"), replace(item, index=65535, name=""))


def edge_errors(like: ErrorEntry) -> tuple[ErrorEntry, ...]:
    plain = replace(like, slot=None, errata=(), response=None, responses=(), adjustable_in=(), causes=(), remedies=())
    run = (CodeRef(21, 1), CodeRef(21, 2), CodeRef(21, 3), CodeRef(21, 7), CodeRef(31))
    long = ((0, 300), (7 << 24, 9 << 24))
    sparse = [(number, number) for number in random.Random(3).sample(range(1 << 16, 7 << 24), 120)]
    return (
        *(replace(plain, kind="gci", number=one, last=other, name=f"Error {one}") for one, other in (*long, *sparse)),
        replace(plain, kind="device", number=0xFFFF_FFFF, last=0xFFFF_FFFF, name="Last"),
        replace(plain, kind="emergency", number=0, last=0, name="7 up"),
        replace(plain, kind="emergency", number=1, last=3, name="Again", adjustable_in=run, causes=(HOSTILE,)),
        replace(plain, kind="emergency", number=4, last=4, name="Again", remedies=(HOSTILE, "\\n"), register="xx"),
        replace(plain, kind="sdo_abort", number=0x0503_0000, last=0x0503_0000, name="Toggle bit", response="Fault"),
    )


def test_wraps_comments_without_making_lists() -> None:
    text = doc(["- " + "word " * 22 + "- 12345 1. word"], [HOSTILE], indent=4)
    assert text.splitlines()[0].startswith("/// \\- word")
    for line in text.splitlines()[1:]:
        assert re.match(r"    ///( (?![-+#] )(?!\d+[.)] )|$| - Text)", line)


@pytest.mark.parametrize("labels", [("Off", "off!"), ("Mask", "MASK")], ids=["punctuation", "case"])
def test_a_label_that_stands_twice_gets_its_number(model: Model, labels: tuple[str, str]) -> None:
    device = edge_model(model).devices[2]
    options = (Option(1, labels[0]), Option(2, labels[1]))
    files = texts(
        TARGET.render(replace(model, devices=(replace(device, codes=(replace(device.codes[0], options=options),)),)))
    )
    name = labels[0].capitalize()
    assert f'        {name}1 = 1, "{labels[0]}";' in files["src/type_/selections.rs"]
    assert f'        {name}2 = 2, "{labels[1]}";' in files["src/type_/selections.rs"]


def test_refuses_names_that_cannot_be_told_apart(model: Model) -> None:
    device = edge_model(model).devices[2]
    options = (Option(1, "Off"), Option(2, "off"), Option(3, "off 1"))
    code = replace(device.codes[0], options=options)
    with pytest.raises(EmitError) as caught:
        TARGET.render(replace(model, devices=(replace(device, codes=(code,)),)))
    assert caught.value.rule == "name-collision"
    assert "'Off1'" in caught.value.message
