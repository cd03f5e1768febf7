"""What a program pays for the C headers and the Rust crate: nothing for what it does not use."""

import json
import re
import subprocess
from pathlib import Path

import pytest
from rust_crate import Cargo, manifest
from test_c import tool

from generator.emit import names
from generator.emit.rust.syntax import type_name
from generator.model import Code, Device, Layout, Model
from generator.naming import screaming, snake

CODE_AND_CONSTANTS = (".text", ".rodata", ".data.rel.ro")
"""Sections that count; constants with addresses in them go to the last one."""
COMPILERS = ("cc", "clang")
OPTIMISATIONS = ("-O2", "-Os")


def printed(*command: str | Path) -> str:
    """Standard output of a command that has to succeed."""
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def size(program: Path) -> int:
    """Bytes of code and constants."""
    lines = [line.split() for line in printed(tool("size"), "-A", program).splitlines()]
    return sum(int(line[1]) for line in lines if line and line[0].startswith(CODE_AND_CONSTANTS))


def symbols(program: Path) -> set[str]:
    return {line.split()[-1] for line in printed(tool("nm"), program).splitlines()}


def relocated(built: Path) -> set[str]:
    """Sections, other than of code and of what debuggers read, that hold addresses for the linker or loader to fill."""
    sections = re.findall(r"Relocation section '\.rela?(\.[^']+)'", printed(tool("readelf"), "-rW", built))
    return {name for name in sections if not name.startswith((".text", ".eh_frame", ".debug", ".init", ".fini"))}


def used(model: Model) -> list[tuple[Device, tuple[Code, ...], Layout]]:
    """Devices with three codes and a telegram of a fixed form."""
    found = [
        (device, device.codes[:3], layout)
        for device in model.devices
        for layout in device.layouts[:1]
        if len(device.codes) >= 3
    ]
    assert found
    return found


# C.


@pytest.fixture(scope="module")
def include(generated: Path) -> Path:
    return generated / "c" / "include"


def built_c(folder: Path, include: Path, name: str, source: str, *options: str) -> Path:
    """A program, or with ``-c`` an object."""
    file, output = folder / f"{name}.c", folder / f"{name}.out"
    file.write_text(source, encoding="utf-8")
    compiler, *rest = options
    printed(tool(compiler), "-std=c99", *rest, f"-I{include}", file, "-o", output)
    return output


def c_program(device: Device, layout: Layout, constants: list[str], headers: list[str], more: str = "") -> str:
    """Three constants and a decoder between volatile variables."""
    stem = snake(device.id, layout.id)
    return (
        "".join(f'#include "drivespec/{header}"\n' for header in headers)
        + "static volatile uint8_t given[8];\nstatic volatile uint32_t taken;\n"
        + "int main(void)\n{\n"
        + "".join(f"    taken = {constant};\n" for constant in constants)
        + "    uint8_t data[8];\n    for (int i = 0; i < 8; i++) {\n        data[i] = given[i];\n    }\n"
        + f"    {stem}_t telegram;\n    taken = (uint32_t){stem}_decode(data, sizeof data, &telegram);\n"
        + f"    taken = ((const uint8_t *)&telegram)[0];\n{more}    return 0;\n}}\n"
    )


@pytest.mark.parametrize("optimisation", OPTIMISATIONS)
@pytest.mark.parametrize("compiler", COMPILERS)
def test_c_constants_cost_nothing(
    model: Model, include: Path, tmp_path: Path, compiler: str, optimisation: str
) -> None:
    options = (compiler, optimisation)
    for device, codes, layout in used(model):
        telegrams, tables = f"{device.id}_telegrams.h", f"{device.id}_tables.h"
        macros = [f"{screaming(device.id)}_{code.designation}_INDEX" for code in codes]
        numbers = [f"{code.index}u" for code in codes]
        ours = built_c(tmp_path, include, "ours", c_program(device, layout, macros, [tables, telegrams]), *options)
        hand = built_c(tmp_path, include, "hand", c_program(device, layout, numbers, [telegrams]), *options)
        assert size(ours) <= size(hand)
        assert symbols(ours) == symbols(hand)
        lookup = f"    taken = {device.id}_find_code((uint16_t)taken)->index;\n"
        source = c_program(device, layout, macros, [tables, telegrams], lookup)
        more = built_c(tmp_path, include, "more", source, *options)
        assert size(more) > size(ours)
        assert f"{device.id}_codes" in symbols(more) - symbols(ours)
        assert f"{device.id}_errors" not in symbols(more)


@pytest.mark.parametrize("position", ["-fno-pie", "-fpie", "-fPIC"])
@pytest.mark.parametrize("compiler", COMPILERS)
def test_c_tables_hold_no_addresses(model: Model, include: Path, tmp_path: Path, compiler: str, position: str) -> None:
    options = (compiler, "-O2", "-c", position)
    everything, lookups = "", ""
    for device in model.devices:
        headers = sorted(include.glob(f"drivespec/{device.id}_*.h"))
        everything += "".join(f'#include "drivespec/{header.name}"\n' for header in headers)
        for header in headers:
            for name in re.findall(r"^} (\w+) = \{$|^static const .*?(\w+)\[.*= ?\{", header.read_text(), re.MULTILINE):
                table = name[0] or name[1]
                lookups += f"const uint8_t *at_{table}(unsigned i) {{ return (const uint8_t *)&{table} + i; }}\n"
    for table in ("codes", "errors", "code_texts", "defaults", "baud_rates"):
        assert f"_{table}(" in lookups
    ours = built_c(tmp_path, include, "tables", everything + lookups, *options)
    assert relocated(ours) == set()
    pointers = 'static const char *const names[] = { "a", "b" };\nconst char *name(int i) { return names[i]; }\n'
    assert relocated(built_c(tmp_path, include, "pointers", pointers, *options))


# Rust.


def built_rust(cargo: Cargo, crate: Path, name: str, program: str, *flags: str) -> Path:
    """A release program; all have names of one length, for names are part of a program."""
    assert len(name) == len("ours")
    folder = cargo.place(name, {"Cargo.toml": manifest(name, crate), "src/main.rs": program})
    settings = ["--config", f"build.rustflags={json.dumps(flags)}"] if flags else []
    messages = cargo.succeed(folder, "build", "--offline", "--release", "--message-format=json", *settings)
    found = [json.loads(line).get("executable") for line in messages.splitlines()]
    return Path(next(path for path in found if path))


def rust_program(device: Device, layout: Layout, constants: list[str], more: str = "") -> str:
    """Three constants and a decoder between black boxes."""
    return (
        "#![allow(unused_imports)]\n"
        f"use drivespec_devices::{device.id}::{{codes, telegrams::{type_name(layout.id)}}};\n"
        "use std::hint::black_box;\n\nfn main() {\n"
        + "".join(f"    black_box({constant});\n" for constant in constants)
        + f"    black_box({type_name(layout.id)}::decode(&black_box([0u8; 8])).is_ok());\n{more}}}\n"
    )


def test_rust_constants_cost_nothing(model: Model, cargo: Cargo, crate: Path) -> None:
    for device, codes, layout in used(model):
        constants = [f"codes::{names.code_name(code).upper()}.index" for code in codes]
        numbers = [f"{code.index}u16" for code in codes]
        lookup = "    black_box(codes::TABLE.get(black_box(1)).map(|code| code.name));\n"
        ours = built_rust(cargo, crate, "ours", rust_program(device, layout, constants))
        hand = built_rust(cargo, crate, "hand", rust_program(device, layout, numbers))
        more = built_rust(cargo, crate, "more", rust_program(device, layout, constants, lookup))
        assert size(ours) <= size(hand)
        assert size(more) > size(ours)
        name = codes[0].name.encode()
        assert name in more.read_bytes()
        assert name not in ours.read_bytes()
        assert device.errors[0].name.encode() not in more.read_bytes()


def test_rust_tables_hold_no_addresses_to_fill_where_the_place_is_fixed(
    model: Model, cargo: Cargo, crate: Path
) -> None:
    """As on a microcontroller; a program that is loaded anywhere has its ``&str`` filled by the loader."""
    device, _, layout = used(model)[0]
    lookup = "    black_box(codes::TABLE.get(black_box(1)).map(|code| code.name));\n"
    program = rust_program(device, layout, [], lookup)
    fixed = built_rust(cargo, crate, "firm", program, "-Crelocation-model=static", "-Ctarget-feature=+crt-static")
    loose = built_rust(cargo, crate, "more", program)
    assert "_RELATIV" in printed(tool("readelf"), "-rW", loose)
    assert "_RELATIV" not in printed(tool("readelf"), "-rW", fixed)
