"""The Rust crate in tests: cargo, and layouts of telegrams that no manual at hand has."""

import os
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from generator.emit.base import Output
from generator.model import (
    BitField,
    Column,
    Field,
    FieldType,
    IndicatorRow,
    IndicatorTable,
    Layout,
    Led,
    Light,
    Option,
    Pattern,
    Sizes,
    SwitchGroup,
    SwitchRow,
    Table,
)

WORKER = os.environ.get("PYTEST_XDIST_WORKER", "main")


class Cargo:
    """Runs cargo on copies of crates below .build, so that what was generated stays untouched."""

    def __init__(self, root: Path) -> None:
        self._folder = root / ".build" / "rust" / WORKER
        self._lock = (root / "tests" / "consumers" / "rust-features.lock").read_text(encoding="utf-8")
        self._environment = os.environ | {
            "CARGO_TARGET_DIR": str(root / ".build" / "cargo" / WORKER),
            "CARGO_TERM_COLOR": "never",
            "RUSTDOCFLAGS": "-D warnings",
        }

    def place(self, name: str, files: Mapping[str, str]) -> Path:
        """A folder that holds exactly these files; an unchanged file keeps its time, so that cargo keeps its work."""
        folder = self._folder / name
        for path, text in files.items():
            file = folder / path
            file.parent.mkdir(parents=True, exist_ok=True)
            if not file.exists() or file.read_text(encoding="utf-8") != text:
                file.write_text(text, encoding="utf-8")
        for file in [file for file in folder.rglob("*") if file.is_file()]:
            if str(file.relative_to(folder)) not in files:
                file.unlink()
        return folder

    def locked(self, name: str, files: Mapping[str, str]) -> Path:
        """A folder as of ``place`` whose dependencies are pinned and at hand; those of features count as well."""
        folder = self.place(name, {**files, "Cargo.lock": self._lock})
        if self.run(folder, "fetch", "--offline").returncode != 0:
            self.succeed(folder, "fetch")
        return folder

    def run(self, folder: Path, *arguments: str, given: str | None = None) -> subprocess.CompletedProcess[str]:
        """Cargo; ``given`` is its standard input."""
        cargo = shutil.which("cargo")
        if cargo is None:
            pytest.fail(
                "'cargo' was not found: the tests of the Rust target need Rust 1.65 or newer (https://rustup.rs)"
            )
        return subprocess.run(
            [cargo, *arguments],
            cwd=folder,
            env=self._environment,
            input=given,
            capture_output=True,
            text=True,
            check=False,
        )

    def succeed(self, folder: Path, *arguments: str) -> str:
        """Standard output of cargo, which has to succeed."""
        done = self.run(folder, *arguments)
        assert done.returncode == 0, done.stderr + done.stdout
        return done.stdout

    def feed(self, folder: Path, given: str) -> str:
        """Standard output of the program in ``folder``, optimised, which has to succeed on that input."""
        done = self.run(folder, "run", "--offline", "--quiet", "--release", given=given)
        assert done.returncode == 0, done.stderr
        return done.stdout

    def probe(self, name: str, crate: Path, uses: Sequence[str], expressions: Sequence[str]) -> dict[str, str]:
        """What ``{:?}`` prints of each expression, in a program of that name."""
        lines = "\n".join(f'    println!("{{:?}}", {expression});' for expression in expressions)
        program = (
            "#![allow(unused_imports, unused_parens)]\n"
            + "".join(f"use drivespec_devices::{path};\n" for path in uses)
            + f"\nfn main() {{\n{lines}\n}}\n"
        )
        folder = self.place(name, {"Cargo.toml": manifest(name, crate), "src/main.rs": program})
        printed = self.succeed(folder, "run", "--offline", "--quiet").splitlines()
        return dict(zip(expressions, printed, strict=True))

    def component(self, folder: Path, name: str) -> None:
        """Skip the test where a component of the toolchain is not installed."""
        if self.run(folder, name, "--version").returncode != 0:
            pytest.skip(f"cargo {name} is not installed")


def texts(files: Mapping[str, Output]) -> dict[str, str]:
    return {path: output.text for path, output in files.items()}


def manifest(name: str, crate: Path, features: str = "") -> str:
    return (
        f'[package]\nname = "{name}"\nversion = "0.0.0"\nedition = "2021"\n\n[workspace]\n\n'
        f'[dependencies]\ndrivespec-devices = {{ path = "{crate.as_posix()}", features = [{features}] }}\n'
    )


def edge_layouts(like: Layout) -> tuple[Layout, ...]:
    """Layouts with every form of a field; those that refer to others come after them."""
    plain = replace(
        like.fields[0],
        constant=None,
        values=(),
        bits=(),
        bit_values=(),
        description="",
        big=False,
        title="Title [with] <markup> *and* `ticks`",
    )

    def field(name: str, kind: str = "uint", length: int | str | None = 1, **changes: object) -> Field:
        return replace(plain, name=name, type=FieldType(kind), length=length, **changes)  # type: ignore[arg-type]

    table = Sizes("size", ((0, 0), (1, 1), (2, 3), (9, 8)), None)
    scaled = Sizes("type", ((0, 0), (-1, 2), (3, 3)), "length")
    layouts = {
        "odd": (
            field("three", length=3),
            field("five", length=5, big=True, constant=0x0102030405),
            field("seven", length=7, big=True),
            field("below", "int", 3),
            field("far", "int", 6, big=True),
            field("whole", "int", 8),
        ),
        "bits": (
            field("word", "int", 2, bits=(BitField(0, 0, "type"), BitField(1, 9, "Run"), BitField(15, 15, "top"))),
            field(
                "all",
                length=4,
                big=True,
                bits=(BitField(0, 31, "all"),),
                values=(Option(1, "On"), Option(0, "Off"), Option(5, "On")),
                bit_values=(("all", (Option(3, "10 %"),)),),
            ),
            field("fixed", constant=0x81, bits=(BitField(0, 6, "low"), BitField(7, 7, "high"))),
        ),
        "locals": (
            field("size"),
            field("reader", length=None, sizes=table),
            field("writer", "bytes", None, sizes=table),
            field("length", length=2, big=True),
            field("data", "text", "size"),
            field("buffer", length=None, sizes=table, constant=0),
            field("found", "bytes", None),
        ),
        "signed": (
            field("type", "int"),
            field("length"),
            field("value", "bytes", None, sizes=scaled),
            field("number", "int", None, sizes=replace(scaled, times=None), big=True),
        ),
        "groups": (
            field("count", constant=2),
            field("pairs", "group", None, count="count", fields=(field("one"), field("two", "text", "one"))),
            field(
                "rest",
                "group",
                None,
                fields=(field("nested"), field("inner", "group", None, count="nested", fields=(field("x", length=2),))),
            ),
        ),
        "constants": (field("fixed", constant=7),),
        "empty-end": (field("text", "text", None),),
    }
    return tuple(
        replace(like, id=id, name=f"Name of {id}", fields=fields, description="", errata=())
        for id, fields in layouts.items()
    )


def edge_indicators(like: IndicatorTable) -> tuple[IndicatorTable, ...]:
    """LEDs of several colours, and a row that one LED decides alone."""

    def row(state: str, *patterns: Pattern) -> IndicatorRow:
        return replace(like.rows[0], patterns=patterns, state=state, meaning="")

    rows = (
        row("red", Pattern(Light.ON, colour="red"), Pattern(Light.OFF)),
        row("slow", Pattern(Light.BLINK, period=Fraction(1)), Pattern(Light.ANY)),
        row("fast", Pattern(Light.BLINK, "green", Fraction(1, 8)), Pattern(Light.FLASH, None, None, 3, Fraction(5, 4))),
        row("dark", Pattern(Light.OFF), Pattern(Light.ANY)),
    )
    return (replace(like, id="edge", leds=(Led("A", "red/green", ""), Led("B", "green", "Second")), rows=rows),)


def edge_switches(like: SwitchGroup) -> tuple[SwitchGroup, ...]:
    """Positions by table with switches that do not matter, and sums of weights that are no powers of two."""

    def rows(**positions: str) -> tuple[SwitchRow, ...]:
        return tuple(
            replace(like.rows[0], value=value.removeprefix("n"), positions=found) for value, found in positions.items()
        )

    table = replace(like, id="table", labels=("1", "2", "3"), weights=(), valid=None, sets=(), notes=(), unit="V")
    return (
        replace(table, rows=rows(n7="1x0", n12="011", off="0x0")),
        replace(table, id="sum", weights=(10, 3, 1), rows=()),
        replace(table, id="valid", weights=(4, 2, 1), valid=(2, 5), rows=()),
    )


def edge_tables(like: Table) -> tuple[Table, ...]:
    """Tables with numbers of states, and tables without: quantities, doubles, no names, negative numbers."""

    def table(id: str, columns: str, *rows: tuple[int | str, ...], unit: str = "") -> Table:
        own = tuple(Column(name, name, unit if name == "n" else "") for name in columns.split())
        return replace(like, id=id, kind="nmt-state", columns=own, rows=rows, errata=())

    return (
        table("hex", "a n b", ("-", "0x10", "x y"), ("-", "0x0100", "10 %")),
        table("wide", "a n", ("one", 70000), ("two", 0)),
        table("quantity", "a n", ("one", 1), ("two", 2), unit="mm"),
        table("doubles", "a n", ("one", 1), ("two", 1)),
        table("negative", "a n", ("one", 1), ("two", -1)),
        table("nameless", "a n", ("-", 1), ("two", 2)),
        replace(table("other", "a n", ("one", 1), ("two", 2)), kind="other"),
    )
