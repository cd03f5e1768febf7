"""The C headers: compiled as C99 and C++17, run, and compared with the model fact by fact in both directions."""

import re
import shutil
import subprocess
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from math import ceil, floor
from pathlib import Path

import pytest
import yaml

from generator.emit.base import EmitError
from generator.emit.c import render
from generator.emit.c.common import ERROR_KINDS
from generator.emit.c.writer import ACCESS_FLAGS
from generator.model import (
    Access,
    Bit,
    BitField,
    Code,
    DataType,
    Device,
    Erratum,
    ErrorEntry,
    Model,
    NodeRelative,
    Option,
    Range,
    SubCode,
    SubIndex,
)
from generator.naming import screaming

WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror")
COMPILERS = [("cc", "c99"), ("c++", "c++17"), ("clang", "c99"), ("clang++", "c++17")]
SIGNIFICANT = 63

Values = dict[str, int | str]


def tool(name: str) -> str:
    """Path of a program; the tests cannot do without it, unless it is clang, which checks what the others do again."""
    found = shutil.which(name)
    if found is None and name.startswith("clang"):
        pytest.skip("left out: no clang on this machine")
    if found is None:
        pytest.fail(
            f"'{name}' was not found: the tests of the C target need a C and C++ compiler with binutils (gcc, g++)"
        )
    return found


def compile_c(folder: Path, source: Path, compiler: str, standard: str, *options: str) -> Path:
    """Compile a file against the generated headers with all warnings as errors; returns what was built."""
    output = folder / f"{source.stem}.{compiler.replace('+', 'x')}.out"
    language = "c++" if standard.startswith("c++") else "c"
    command = [tool(compiler), f"-std={standard}", *WARNINGS, *options, "-x", language, str(source), "-o", str(output)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return output


def run(program: Path) -> Values:
    """What a self-test prints; numbers as integers."""
    done = subprocess.run([str(program)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{program.name} found a lookup that fails"
    pairs = [line.split("=", 1) for line in done.stdout.splitlines()]
    assert len({name for name, _ in pairs}) == len(pairs)
    return {name: int(value) if re.fullmatch(r"-?\d+", value) else value for name, value in pairs}


def self_test(c: Path, folder: Path, name: str, compiler: str = "cc", standard: str = "c99") -> Values:
    source = c / "test" / f"{name}_selftest.c"
    return run(compile_c(folder, source, compiler, standard, f"-I{c / 'include'}"))


def write(c: Path, model: Model) -> Path:
    """The headers of a model, below ``c``."""
    for path, output in render(model).items():
        file = c / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(output.data())
    return c


# What the headers must hold, straight from the model.


def fits(name: str, prefix: str, number: object, suffix: str = "") -> str:
    """The rule for long names: the number goes before the label, whole words are dropped at the end."""
    if len(f"{prefix}_{name}{suffix}") <= SIGNIFICANT:
        return f"{prefix}_{name}{suffix}"
    words = f"{prefix}_{number}_{name}".split("_")
    while len("_".join(words)) + len(suffix) > SIGNIFICANT:
        words.pop()
    return "_".join(words) + suffix


def labels(entries: Sequence[tuple[int, str]]) -> list[tuple[int, str]]:
    """Number and label in capitals; a label that stands twice, or has no word, has the number after it."""
    capitals = [(number, screaming(label)) for number, label in entries]
    count = Counter(label for _, label in capitals)
    sign = {True: "MINUS_", False: ""}
    return [
        (n, label if label and count[label] == 1 else f"{label}_{sign[n < 0]}{abs(n)}".lstrip("_"))
        for n, label in capitals
    ]


def options(prefix: str, entries: Sequence[Option]) -> Values:
    sign = {True: "MINUS_", False: ""}
    named = labels([(option.value, option.label) for option in entries])
    return {fits(label, prefix, f"{sign[value < 0]}{abs(value)}"): value for value, label in named}


def bits(prefix: str, entries: Sequence[Bit], fields: Sequence[BitField]) -> Values:
    found: Values = {}
    masks: dict[str, int] = {}
    for bit in entries:
        masks[bit.label] = masks.get(bit.label, 0) + 2**bit.number
    lowest = [(len(bin(mask)) - len(bin(mask).rstrip("0")), label) for label, mask in masks.items()]
    for (number, label), mask in zip(labels(lowest), masks.values(), strict=True):
        found[fits(label, f"{prefix}BIT", number)] = mask
    for (low, label), field in zip(labels([(field.low, field.label) for field in fields]), fields, strict=True):
        found[fits(label, f"{prefix}FIELD", low, "_MASK")] = sum(2**n for n in range(low, field.high + 1))
        found[fits(label, f"{prefix}FIELD", low, "_SHIFT")] = low
    return found


def flags(names: Sequence[str]) -> int:
    return sum(2 ** ACCESS_FLAGS.index(name) for name in set(names))


def code_flags(code: Code) -> int:
    ticked = {"read": code.access.read, "write": code.access.write}
    return flags([*(name for name, value in ticked.items() if value), *code.access.conditions])


def object_flags(sub: SubIndex) -> int:
    words = {"rwr": ["read", "write", "pdo_map_tx"], "rww": ["read", "write", "pdo_map_rx"], "const": ["read", "const"]}
    plain = [{"r": "read", "w": "write"}[letter] for letter in sub.access if letter in "rw"]
    return flags(words.get(sub.access, plain) + ["pdo_map"] * sub.pdo_mapping)


def wire(bounds: Range, scaling: int | None) -> tuple[int, int]:
    factor = scaling or 1
    return ceil(bounds.low * factor), floor(bounds.high * factor)


def default_of(prefix: str, value: object, follows: NodeRelative | None) -> Values:
    base = value if isinstance(value, NodeRelative) else follows
    found: Values = {f"{prefix}DEFAULT": value} if isinstance(value, (int, str)) else {}
    return found | ({f"{prefix}DEFAULT_BASE": base.base} if base else {})


def preset(code: Code) -> dict[int, tuple[object, NodeRelative | None]]:
    """Default and rule of each subcode, 0 for a single variable."""
    if not code.subcodes:
        return {0: (code.default, None)}
    return {s.number: (code.default if s.default is None else s.default, s.follows) for s in code.subcodes}


def run_of(numbers: Mapping[int, object], start: int) -> int:
    """Last number of the run of equal facts that ``start`` begins."""
    last = start
    while last + 1 in numbers and numbers[last + 1] == numbers[start]:
        last += 1
    return last


def runs_of(facts: Mapping[int, object]) -> Iterator[tuple[int, int]]:
    done = -1
    for number in facts:
        if number > done:
            done = run_of(facts, number)
            yield number, done


def sub_name(first: int, last: int) -> str:
    return f"SUB{first}_" if first == last else f"SUB{first}_TO_{last}_"


def part_names(prefix: str, entries: Sequence[tuple[int, str]]) -> Values:
    """Names of subcodes that are no numbered series; two names are of a series if only their own numbers differ."""

    @cache
    def shapes(number: int, name: str) -> frozenset[str]:
        pieces = re.split(rf"(?<!\d){number}(?!\d)", name)
        holes = range(len(pieces) - 1)
        filled = [[("#" if i == hole else str(number)) for i in holes] for hole in holes] + [["#"] * len(holes)]
        texts = ["".join(a + b for a, b in zip(pieces, [*fill, ""], strict=True)) for fill in filled]
        return frozenset([name, *texts])

    alone = [
        (number, name)
        for number, name in entries
        if name and not any(shapes(number, name) & shapes(*other) for other in entries if other[0] != number)
    ]
    return {fits(label, f"{prefix}_SUB", number): number for number, label in labels(alone)}


def expected_code(code: Code, device: str) -> Values:
    prefix = f"{device}_C{code.number:05d}"
    found: Values = {
        f"{prefix}_NUMBER": code.number,
        f"{prefix}_INDEX": code.index,
        f"{prefix}_SUBCODE_COUNT": len(code.subcodes),
        f"{prefix}_SUBCODE_HIGHEST": max([sub.number for sub in code.subcodes], default=0),
        f"{prefix}_TYPE": code.data_type.canopen_number,
        f"{prefix}_ACCESS": code_flags(code),
    }
    size = code.data_type.bits // 8 or code.length
    if size is not None:
        found[f"{prefix}_SIZE_BYTES"] = size
    if code.scaling is not None:
        found[f"{prefix}_SCALING"] = code.scaling
    if code.range is not None:
        found[f"{prefix}_MIN"], found[f"{prefix}_MAX"] = wire(code.range, code.scaling)
    defaults = preset(code)
    if len(set(defaults.values())) == 1:
        found |= default_of(f"{prefix}_", *next(iter(defaults.values())))
    else:
        for first, last in runs_of(defaults):
            found |= default_of(f"{prefix}_{sub_name(first, last)}", *defaults[first])
    found |= part_names(prefix, [(sub.number, sub.name) for sub in code.subcodes])
    found |= options(f"{prefix}_OPT", code.options)
    for sub in code.subcodes:
        found |= options(f"{prefix}_SUB{sub.number}_OPT", sub.options)
    return found | bits(f"{prefix}_", code.bits, code.fields)


def expected_objects(device: Device, name: str) -> Values:
    found: Values = {}
    for entry in device.objects:
        prefix = f"{name}_{'I' if entry.kind == 'canopen' else 'PNU'}"
        prefix += f"{entry.index:04X}" if entry.kind == "canopen" else f"{entry.index}"
        found[f"{prefix}_INDEX"] = entry.index
        found[f"{prefix}_SUBINDEX_COUNT"] = len(entry.subindexes)
        found[f"{prefix}_SUBINDEX_HIGHEST"] = max([sub.number for sub in entry.subindexes], default=0)
        if entry.object_type != "VAR":
            found |= part_names(prefix, [(sub.number, sub.name) for sub in entry.subindexes])
        by_number = {sub.number: sub for sub in entry.subindexes}
        blank = replace(next(iter(by_number.values())), errata=(), codes=(), printed_codes=()) if by_number else None
        facts = {
            number: blank
            and replace(
                sub,
                number=0,
                name="",
                description="",
                unused=False,
                where=blank.where,
                errata=(),
                codes=(),
                printed_codes=(),
            )
            for number, sub in by_number.items()
        }
        for first, last in runs_of(facts):
            found |= expected_subindex(by_number[first], f"{prefix}_{sub_name(first, last)}")
    return found


def expected_subindex(sub: SubIndex, prefix: str) -> Values:
    found: Values = {
        f"{prefix}TYPE": sub.data_type.canopen_number,
        f"{prefix}ACCESS": object_flags(sub),
    }
    if sub.data_type.bits:
        found[f"{prefix}SIZE_BYTES"] = sub.data_type.bits // 8
    if sub.range is not None:
        found[f"{prefix}MIN"], found[f"{prefix}MAX"] = wire(sub.range, 1)
    found |= default_of(prefix, sub.default, None)
    if sub.signature is not None:
        found[f"{prefix}SIGNATURE"] = sub.signature
    if sub.abort is not None:
        found[f"{prefix}ABORT"] = sub.abort
    return found | options(f"{prefix}OPT", sub.options) | bits(prefix, sub.bits, sub.fields)


def error_digits(error: ErrorEntry, device: Device) -> int:
    known = {"device": 8, "sdo_abort": 8, "emergency": 4}
    highest = max(e.last for e in device.errors if e.kind == error.kind)
    return known.get(error.kind, 4 if highest < 2**16 else 8)


def expected_errors(device: Device, name: str) -> Values:
    found: Values = {}
    for error in device.errors:
        kind = "ERROR" if error.kind == "device" else screaming(error.kind)
        prefix = f"{name}_{kind}_{error.number:0{error_digits(error, device)}X}_{screaming(error.name)}"
        if error.last == error.number:
            found[prefix] = error.number
            continue
        for suffix, value in (("_FIRST", error.number), ("_LAST", error.last)):
            words = prefix.split("_")
            while len("_".join(words)) + len(suffix) > SIGNIFICANT:
                words.pop()
            found["_".join(words) + suffix] = value
    return found


def expected_device(device: Device) -> Values:
    name = screaming(device.id)
    found: Values = {
        f"{name}_CODE_COUNT": len(device.codes),
        f"{name}_OBJECT_COUNT": len(device.objects),
        f"{name}_ERROR_COUNT": len(device.errors),
    }
    for slot in device.slots:
        found[f"{name}_{slot.name}_CODE_FIRST"] = slot.first_code
        found[f"{name}_{slot.name}_CODE_LAST"] = slot.last_code
        found[f"{name}_{slot.name}_CODE_OFFSET"] = slot.code_offset
        found[f"{name}_{slot.name}_ERROR_OFFSET"] = slot.error_offset
    if device.canopen:
        if device.canopen.node_address is not None:
            found[f"{name}_NODE_ADDRESS_CODE"] = device.canopen.node_address
        found[f"{name}_PDO_GRANULARITY_BITS"] = device.canopen.granularity
        found[f"{name}_BOOT_UP_MASTER"] = int(device.canopen.boot_up_master)
        found[f"{name}_BAUD_RATE_COUNT"] = len(device.canopen.baud_rates)
    used = {n for e in device.errors if e.kind == "device" for number in (e.number, e.last) for n in set_bits(number)}
    if device.drive and used:
        fields = [range(field.low, field.high + 1) for _, field in device.drive.error_fields]
        found[f"{name}_ERROR_MASK"] = sum(2**n for run in fields if used & set(run) for n in run)
    for code in device.codes:
        found |= expected_code(code, name)
    for table in device.tables:
        if table.kind == "data-type" and table.columns[0].id == "id":
            entries = [Option(int(row[0]), str(row[1])) for row in table.rows]
            found |= options(f"{name}_{screaming(table.id)}", entries)
    return found | expected_objects(device, name) | expected_errors(device, name)


def set_bits(number: int) -> list[int]:
    return [n for n in range(number.bit_length()) if number >> n & 1]


def expected_records(device: Device) -> Values:
    found: Values = {}
    for code in device.codes:
        found |= expected_record(code)
    for error in device.errors:
        key = f"errors[{ERROR_KINDS.index(error.kind)}/{error.number}]"
        responses = device.drive.responses if device.drive else ()
        numbers = [r.value for r in responses if error.response == r.name or error.response in r.aliases]
        found[f"{key}.last"] = error.last
        found[f"{key}.response"] = numbers[0] if numbers else 255
        found[f"{key}.name"] = error.name
    for place, rate in enumerate(device.canopen.baud_rates if device.canopen else ()):
        found[f"baud_rates[{place}]"] = rate
    return found


def expected_record(code: Code) -> Values:
    key = f"codes[{code.number}]"
    defaults = preset(code)
    shared = next(iter(defaults.values())) if len(set(defaults.values())) == 1 else (None, None)
    low, high = wire(code.range, code.scaling) if code.range else (0, 0)
    found: Values = {
        f"{key}.index": code.index,
        f"{key}.subcode_count": len(code.subcodes),
        f"{key}.subcode_highest": max(defaults),
        f"{key}.type": code.data_type.canopen_number,
        f"{key}.access": code_flags(code),
        f"{key}.scaling": code.scaling or 0,
        f"{key}.min": low,
        f"{key}.max": high,
        f"{key}.name": code.name,
        f"{key}.has": (code.range is not None) + default_record("", *shared)[1],
    }
    found |= default_record(key, *shared)[0]
    if len(set(defaults.values())) > 1:
        for first, last in runs_of(defaults):
            part = f"defaults[{code.number}/{first}]"
            record, has = default_record(part, *defaults[first])
            if has:
                found |= {**record, f"{part}.has": has, f"{part}.last": last}
    return found


def default_record(key: str, value: object, follows: NodeRelative | None) -> tuple[Values, int]:
    base = value if isinstance(value, NodeRelative) else follows
    record: Values = {
        f"{key}.default_value": value if isinstance(value, int) else 0,
        f"{key}.default_text": value if isinstance(value, str) else "",
        f"{key}.default_base": base.base if base else 0,
    }
    return record, 2 * isinstance(value, (int, str)) + 4 * (base is not None)


def expected_common(model: Model) -> Values:
    found: Values = {f"DRIVESPEC_TYPE_{data_type.canopen_name}": data_type.canopen_number for data_type in DataType}
    found |= {f"DRIVESPEC_ACCESS_{screaming(flag)}": 2**bit for bit, flag in enumerate(ACCESS_FLAGS)}
    found |= {f"DRIVESPEC_ERROR_{screaming(kind)}": value for value, kind in enumerate(ERROR_KINDS)}
    found |= {"DRIVESPEC_HAS_RANGE": 1, "DRIVESPEC_HAS_DEFAULT": 2, "DRIVESPEC_HAS_DEFAULT_BASE": 4}
    found |= {"DRIVESPEC_RESPONSE_NOT_PRINTED": 255}
    for entry in model.cob_ids:
        found[f"DRIVESPEC_COB_ID_{screaming(entry.name)}{'' if entry.broadcast else '_BASE'}"] = entry.base
    if model.cob_ids:
        found |= {"DRIVESPEC_NODE_MIN": model.node_addresses[0], "DRIVESPEC_NODE_MAX": model.node_addresses[-1]}
    for drive in model.drives:
        name = screaming(drive.id)
        found[f"{name}_INDEX_BASE"] = drive.index_base
        for title, field in drive.error_fields:
            found[f"{name}_ERROR_{screaming(title)}_MASK"] = sum(2**n for n in range(field.low, field.high + 1))
            found[f"{name}_ERROR_{screaming(title)}_SHIFT"] = field.low
        for word, entries in (("RESPONSE", drive.responses), ("MODULE", drive.modules), ("COMMAND", drive.commands)):
            found |= options(f"{name}_{word}", [Option(entry.value, entry.name) for entry in entries])
    return found


def assert_same(printed: Values, expected: Values) -> None:
    """Compare fact by fact; the message names the facts."""
    assert {k: v for k, v in expected.items() if k not in printed} == {}, "missing in the header"
    assert {k: v for k, v in printed.items() if k not in expected} == {}, "not in the model"
    assert {k: (printed[k], v) for k, v in expected.items() if printed[k] != v} == {}, "header and model differ"


# The real model.


@pytest.fixture(scope="session")
def c(generated: Path) -> Path:
    """The folder of the target."""
    return generated / "c"


@pytest.mark.parametrize(("compiler", "standard"), COMPILERS)
def test_every_fact_of_the_devices(model: Model, c: Path, tmp_path: Path, compiler: str, standard: str) -> None:
    for device in model.devices:
        printed = self_test(c, tmp_path, device.id, compiler, standard)
        assert_same(printed, expected_device(device) | expected_records(device))


@pytest.mark.parametrize(("compiler", "standard"), COMPILERS)
def test_every_fact_that_devices_share(model: Model, c: Path, tmp_path: Path, compiler: str, standard: str) -> None:
    assert_same(self_test(c, tmp_path, "drivespec", compiler, standard), expected_common(model))


def defined(header: str, c: Path) -> set[str]:
    """Every macro and enumerator that a header brings, after the preprocessor."""
    command = [tool("cc"), "-std=c99", "-E", "-dD", f"-I{c / 'include'}", "-x", "c", "-"]
    text = subprocess.run(command, input=f'#include "drivespec/{header}"\n', capture_output=True, text=True, check=True)
    names, ours = set(), False
    for line in text.stdout.splitlines():
        if marker := re.match(r'# \d+ "([^"]*)"', line):
            ours = marker[1].endswith(f"drivespec/{header}")
        elif ours and (name := re.match(r"#define (\w+) .|    ([A-Z]\w+) = ", line)):
            names.add(name[1] or name[2])
    return names


def test_the_self_test_leaves_no_constant_out(model: Model, c: Path) -> None:
    for device in model.devices:
        assert defined(f"{device.id}.h", c) == set(expected_device(device))
        assert defined(f"{device.id}_tables.h", c) == set()
    assert defined("drivespec.h", c) == set(expected_common(model))


@pytest.mark.parametrize(
    ("header", "level"), [("", "-O0"), ("", "-O2"), ("_tables", "-O2"), ("_telegrams", "-O2"), ("_panel", "-O2")]
)
def test_a_header_costs_nothing_until_it_is_used(
    model: Model, c: Path, tmp_path: Path, header: str, level: str
) -> None:
    source = tmp_path / "unused.c"
    headers = [f"drivespec/{device.id}{header}.h" for device in model.devices]
    present = [name for name in headers if (c / "include" / name).exists()]
    assert len(present) > 1
    source.write_text("".join(f'#include "{name}"\n' for name in present))
    built = compile_c(tmp_path, source, "cc", "c99", level, f"-I{c / 'include'}", "-c")
    listing = subprocess.run([tool("size"), "-A", str(built)], capture_output=True, text=True, check=True).stdout
    sizes = dict(re.findall(r"^(\.\w+)\S*\s+(\d+)", listing, re.MULTILINE))
    assert ".text" in sizes
    assert {name: size for name, size in sizes.items() if name in (".text", ".rodata", ".data", ".bss")} == {
        name: "0" for name in sizes if name in (".text", ".rodata", ".data", ".bss")
    }
    assert subprocess.run([tool("nm"), str(built)], capture_output=True, text=True, check=True).stdout == ""


@pytest.mark.parametrize(("compiler", "standard"), COMPILERS[:2])
def test_all_headers_together_in_two_files_of_a_program(
    model: Model, c: Path, tmp_path: Path, compiler: str, standard: str
) -> None:
    includes = "".join(
        f'#include "drivespec/{device.id}_{part}.h"\n' for device in model.devices for part in ("tables", "telegrams")
    )
    other = tmp_path / "other.c"
    other.write_text(f"{includes}int other(void);\nint other(void) {{ return 0; }}\n")
    source = tmp_path / "both.c"
    source.write_text(f"{includes}int other(void);\nint main(void) {{ return other(); }}\n")
    assert run(compile_c(tmp_path, source, compiler, standard, f"-I{c / 'include'}", str(other))) == {}


def right_for_16_bits(literal: str) -> bool:
    """Whether a literal has its value in standard C whatever the width of int: no digits beyond their type."""
    if literal.startswith(('"', "DRIVESPEC_", "(DRIVESPEC_")):
        return True
    if match := re.fullmatch(r"(0x[0-9A-F]+|\d+)u", literal):
        return int(match[1], 0) <= 0xFFFF
    if match := re.fullmatch(r"UINT(\d+)_C\((0x[0-9A-F]+|\d+)\)", literal):
        return int(match[2], 0).bit_length() <= int(match[1])
    if match := re.fullmatch(r"\(-INT(\d+)_C\((\d+)\)(?: - 1)?\)|INT(\d+)_C\((\d+)\)", literal):
        return int(match[2] or match[4]).bit_length() < int(match[1] or match[3])
    match = re.fullmatch(r"\(-(\d+)(?: - 1)?\)|(-?\d+)", literal)
    return match is not None and abs(int(match[1] or match[2])) < 2**15


def test_literals_are_right_where_int_has_16_bits(model: Model, odd: Model) -> None:
    for source in (model, odd):
        files = render(source)
        for device in source.devices:
            text = files[f"include/drivespec/{device.id}.h"].text
            macros = re.findall(r"^#define (\w+) (.+?) ///<", text, re.MULTILINE)
            enumerators = re.findall(r"^ {4}(\w+) = (-?\d+),? ///<", text, re.MULTILINE)
            assert len(macros) + len(enumerators) == len(expected_device(device))
            assert [pair for pair in macros + enumerators if not right_for_16_bits(pair[1])] == []


def test_names_are_legal_and_stay_apart(model: Model) -> None:
    names: list[tuple[str, str]] = []
    for path, output in render(model).items():
        if path.endswith(".h"):
            text = output.data().decode("ascii")
            names += re.findall(r"^#define (\w+)|^ {4}([A-Z]\w+) = ", text, re.MULTILINE)
    flat = [define or enumerator for define, enumerator in names]
    assert [name for name in flat if not re.fullmatch(r"[A-Z][A-Z0-9]*(_[A-Z0-9]+)*", name)] == []
    assert [name for name, count in Counter(name[:SIGNIFICANT].lower() for name in flat).items() if count > 1] == []


def block(text: str, title: str) -> str:
    """The comment above the constants of a fact, on one line."""
    found = re.search(rf"@name {re.escape(title)}(?:\n|[ ].*?\n)(.*?)@\{{", text, re.DOTALL)
    assert found, f"no comment on {title}"
    return " ".join(found[1].replace("\n *", " ").split())


def test_comments_say_where_facts_come_from(model: Model, c: Path) -> None:
    for device in model.devices:
        text = (c / f"include/drivespec/{device.id}.h").read_text(encoding="ascii")
        facts = [(code.designation, code.cite, code.errata) for code in device.codes]
        facts += [(entry.designation, entry.cite, entry.errata) for entry in device.objects]
        facts += [
            (f"0x{error.number:0{error_digits(error, device)}X} {error.name}", error.cite, error.errata)
            for error in device.errors
        ]
        for title, cite, errata in facts:
            comment = block(text, title)
            page = f" p. {cite.page}" if cite.page is not None else ""
            assert f"{cite.manual}, {cite.chapter}{page}" in comment, title
            for name in errata:
                assert f"Erratum {name}: printed" in comment, title
                assert "used: " in comment.partition(f"Erratum {name}: ")[2], title


def test_comments_say_what_no_record_holds(model: Model, c: Path) -> None:
    """Causes, remedies and the codes that set a response, which the README sends the reader to the comments for."""
    seen = set()
    for device in model.devices:
        text = (c / f"include/drivespec/{device.id}.h").read_text(encoding="ascii")
        for error in device.errors:
            comment = block(text, f"0x{error.number:0{error_digits(error, device)}X} {error.name}")
            facts = [("Cause: ", error.causes), ("Remedy: ", error.remedies)]
            facts += [("Adjustable in ", tuple(str(ref) for ref in error.adjustable_in[:1]))]
            for label, texts in facts:
                plain = [f"{label}{said}".translate(dict.fromkeys(map(ord, "»«"), '"')) for said in texts]
                assert [said for said in plain if said not in comment] == [], error.name
                seen |= {label for _ in texts}
    assert len(seen) == 3


def test_the_head_names_source_and_version(model: Model, c: Path) -> None:
    for device in model.devices:
        for suffix in (".h", "_tables.h"):
            head = " ".join(
                (c / f"include/drivespec/{device.id}{suffix}").read_text(encoding="ascii")[:1200].split(" *")
            )
            words = " ".join(head.split())
            assert f"[{device.manual.id}]; do not edit." in words
            assert f"Specification {model.version} of {model.date}." in words
            assert f"not a file of {device.manufacturer}" in words


def test_the_interface_knows_every_word_of_the_schema(root: Path) -> None:
    codes = yaml.safe_load((root / "spec/schema/codes.schema.yaml").read_text(encoding="utf-8"))
    conditions = codes["$defs"]["entry"]["properties"]["conditions"]["items"]["enum"]
    assert set(conditions) <= set(ACCESS_FLAGS)
    common = yaml.safe_load((root / "spec/schema/common.schema.yaml").read_text(encoding="utf-8"))
    assert set(common["$defs"]["error_kind"]["enum"]) == set(ERROR_KINDS)


PROBES = """
#include <stdio.h>
{includes}
static const uint32_t probes[] = {{{probes}}};
int main(void)
{{
    for (uint32_t n = 0u; n <= 0xFFFFu; n++) {{
        if ({stem}_find_code((uint16_t)n) != NULL) {{
            printf("code %lu=1\\n", (unsigned long)n);
        }}
        for (unsigned s = 0u; s <= 0xFFu; s++) {{
            const drivespec_default *const found = {stem}_find_default((uint16_t)n, (uint8_t)s);
            if (found != NULL) {{
                printf("default %lu/%u=%lld\\n", (unsigned long)n, s, (long long)found->default_value);
            }}
        }}
    }}
    for (size_t i = 0u; i < sizeof probes / sizeof probes[0]; i++) {{
        for (unsigned kind = 0u; kind <= 0xFFu; kind++) {{
            const drivespec_error *const found = {stem}_find_error((uint8_t)kind, probes[i]);
            if (found != NULL) {{
                printf("error %u/%lu=%lu\\n", kind, (unsigned long)probes[i], (unsigned long)found->first);
            }}
        }}
    }}
    printf("get=%lu\\n", (unsigned long)drivespec_field_get(UINT32_C(0x447B000F), UINT32_C(0xE0000000), 29u));
    printf("set=%lu\\n", (unsigned long)drivespec_field_set(UINT32_C(0x447B000F), UINT32_C(0xE0000000), 29u, 9u));
    return 0;
}}
"""


def test_lookups_find_what_is_there_and_nothing_else(model: Model, c: Path, tmp_path: Path) -> None:
    devices = [d for d in model.devices if any(len(set(preset(code).values())) > 1 for code in d.codes) and d.errors]
    assert devices
    for device in devices:
        numbers = sorted({n + step for e in device.errors for n in (e.number, e.last) for step in (-1, 0, 1)} - {-1})
        source = tmp_path / f"{device.id}.c"
        source.write_text(
            PROBES.format(
                includes=f'#include "drivespec/{device.id}_tables.h"',
                stem=device.id,
                probes=", ".join(f"UINT32_C({number})" for number in numbers),
            )
        )
        expected: Values = {f"code {code.number}": 1 for code in device.codes}
        for code in device.codes:
            defaults = preset(code)
            if len(set(defaults.values())) > 1:
                for number, (value, rule) in defaults.items():
                    if value is not None or rule is not None:
                        expected[f"default {code.number}/{number}"] = value if isinstance(value, int) else 0
        for error in device.errors:
            kind = ERROR_KINDS.index(error.kind)
            inside = [n for n in numbers if error.number <= n <= error.last]
            expected |= {f"error {kind}/{number}": error.number for number in inside}
        expected |= {"get": 2, "set": 0x247B000F}
        assert_same(run(compile_c(tmp_path, source, "cc", "c99", "-O1", f"-I{c / 'include'}")), expected)


# An invented device with what the real ones happen not to have.


def subcode(model: Model, number: int, name: str, default: int | str | NodeRelative | None) -> SubCode:
    sample = next(sub for code in model.devices[0].codes for sub in code.subcodes)
    return replace(sample, number=number, name=name, default=default, follows=None, options=(), description="")


def odd_codes(model: Model) -> tuple[Code, ...]:
    plain = replace(
        next(code for code in model.devices[0].codes if not code.subcodes),
        slot=None,
        options=(),
        bits=(),
        fields=(),
        range=None,
        default=None,
        default_cite=None,
        scaling=None,
        length=None,
        errata=(),
        objects=(),
    )
    word = replace(plain, data_type=DataType.INTEGER32, type_name="INTEGER_32", scaling=100)
    return (
        replace(plain, number=1, index=9, name="Nothing printed", access=Access(False, False)),
        replace(
            word,
            number=2,
            name='Signed; "quoted" \\ ends */ with ??/',
            range=Range(Fraction(-(2**31), 100), Fraction(2**31 - 1, 100), "rpm"),
            default=-(2**31),
            access=Access(True, True, ("cinh", "no_transfer")),
        ),
        replace(
            plain,
            number=3,
            name="Größe in µm",
            data_type=DataType.INTEGER16,
            range=Range(Fraction(-1, 3), Fraction(7, 3)),
            default=-32768,
            options=(Option(-1, "None"), Option(-2, "None"), Option(5, "Wide " * 20)),
        ),
        replace(
            plain,
            number=4,
            name="Wide list",
            data_type=DataType.UNSIGNED32,
            options=(Option(0, "-"), Option(40000, "Above int"), Option(2**32 - 1, "All")),
        ),
        replace(
            plain,
            number=5,
            name="Text",
            data_type=DataType.VISIBLE_STRING,
            type_name="VISIBLE_STRING",
            length=32,
            default='a "b" \\ ??/ c',
        ),
        replace(
            plain,
            number=6,
            name="Gaps",
            subcodes=tuple(
                subcode(model, number, name, default)
                for number, name, default in (
                    (1, "Alpha", 7),
                    (2, "Beta", 7),
                    (5, "Gamma", 7),
                    (6, "", None),
                    (9, "Node", NodeRelative(0x180)),
                )
            ),
        ),
        replace(plain, number=7, name="Same", subcodes=tuple(subcode(model, n, f"Entry {n}", 3) for n in (1, 2, 4))),
        replace(plain, number=8, name="No default", subcodes=tuple(subcode(model, n, "", None) for n in (1, 2))),
        replace(
            plain,
            number=9,
            name="Bits",
            data_type=DataType.UNSIGNED32,
            type_name="BITFIELD_32",
            range=Range(Fraction(0), Fraction(2**32 - 1)),
            default=2**31,
            bits=(Bit(0, "Reserved"), Bit(31, "Reserved"), Bit(4, "Very long label of a bit, so long that it is cut")),
            fields=(BitField(8, 15, "Mode"), BitField(16, 17, "Mode")),
        ),
    )


@pytest.fixture(scope="session")
def odd(model: Model) -> Model:
    """The real model with devices that have little, and one that has what is rare."""
    real = model.devices[0]
    bare = replace(real, drive=None, slots=(), canopen=None, codes=(), objects=(), errors=(), errata=())
    bare = replace(bare, layouts=(), examples=(), switches=(), indicators=(), tables=(), formulas=())
    errors = tuple(replace(error, errata=()) for error in real.errors)
    runs = tuple(replace(error, kind="dpv1", number=n, last=n + 2) for n, error in zip((0, 8), errors, strict=False))
    return replace(
        model,
        drives=(),
        cob_ids=(),
        devices=(
            replace(bare, id="bare"),
            replace(bare, id="odd", codes=odd_codes(model), errors=runs),
            replace(bare, id="slotted", slots=real.slots, errors=errors),
        ),
    )


@pytest.mark.parametrize(("compiler", "standard"), COMPILERS)
def test_rare_facts(odd: Model, tmp_path: Path, compiler: str, standard: str) -> None:
    c = write(tmp_path / "c", odd)
    assert_same(self_test(c, tmp_path, "drivespec", compiler, standard), expected_common(odd))
    for device in odd.devices:
        expected = {
            name: value.replace("Größe in µm", "Grosse in um") if isinstance(value, str) else value
            for name, value in (expected_device(device) | expected_records(device)).items()
        }
        assert_same(self_test(c, tmp_path, device.id, compiler, standard), expected)
        assert defined(f"{device.id}.h", c) == set(expected_device(device))


def test_wire_limits_are_the_whole_values_inside_the_range(odd: Model, tmp_path: Path) -> None:
    printed = self_test(write(tmp_path / "c", odd), tmp_path, "odd")
    assert (printed["ODD_C00002_MIN"], printed["ODD_C00002_MAX"]) == (-(2**31), 2**31 - 1)
    assert (printed["ODD_C00003_MIN"], printed["ODD_C00003_MAX"]) == (0, 2)


def test_two_facts_of_one_name_are_refused(model: Model) -> None:
    device = model.devices[0]
    error = device.errors[0]
    for second in (
        error,
        replace(error, where=device.where),
        replace(error, name=error.name.upper(), where=device.where),
    ):
        twice = replace(model, devices=(replace(device, errors=(error, second)),))
        with pytest.raises(EmitError, match="would stand twice") as caught:
            render(twice)
        assert caught.value.rule == "name-collision"
        assert caught.value.where == second.where


def test_an_erratum_shows_what_is_printed_and_what_is_used(model: Model, tmp_path: Path) -> None:
    device = model.devices[0]
    code = device.codes[0]
    entry = Erratum(
        id="invented",
        kind="index",
        rule="code-index",
        about=(code.ref,),
        about_text=(str(code.ref),),
        place=("base", "index"),
        printed=lambda _: 4711,
        printed_text="4711",
        used=lambda variables: 24575 - variables["code"],
        used_text="24575 - code",
        places=(),
        why="It is invented.",
        confidence="high",
        origin="manual",
        where=code.where,
    )
    wrong = replace(model, devices=(replace(device, codes=(replace(code, errata=("invented",)),), errata=(entry,)),))
    bare = replace(wrong.devices[0], objects=(), errors=(), tables=(), switches=(), indicators=())
    stripped = replace(wrong, devices=(replace(bare, layouts=(), examples=()),))
    text = (write(tmp_path, stripped) / f"include/drivespec/{device.id}.h").read_text(encoding="ascii")
    used = 24575 - code.number
    assert f"Erratum invented: printed (base index): 4711; used: {used} (24575 - code)." in block(
        text, code.designation
    )


def test_a_missing_compiler_fails_and_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(pytest.fail.Exception, match="'cc' was not found"):
        compile_c(tmp_path, tmp_path / "nothing.c", "cc", "c99")


def test_rendering_again_gives_the_same_bytes(model: Model) -> None:
    assert {path: out.data() for path, out in render(model).items()} == {
        path: out.data() for path, out in render(model).items()
    }
