"""What the features serde and defmt add to the Rust crate, and the oldest Rust that it promises to build with."""

import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from rust_crate import Cargo, manifest

from generator.model import Model, NodeRelative

BARE_METAL = "thumbv7em-none-eabihf"


PROGRAM = """use drivespec_devices::codec::Repeated;
use drivespec_devices::types::*;
use drivespec_devices::DEVICES;
use serde_json::{from_str, to_string};

#[defmt::global_logger]
struct Printer;

unsafe impl defmt::Logger for Printer {
    fn acquire() {}
    unsafe fn flush() {}
    unsafe fn release() {
        println!();
    }
    unsafe fn write(bytes: &[u8]) {
        for byte in bytes {
            print!("{byte:02x}");
        }
    }
}

defmt::timestamp!("");

/// Every entry reads back from what it is written as, which is its raw value; no other number is read.
macro_rules! selection {
    ($list:ty) => {
        let values: Vec<i64> = <$list>::CHOICES.iter().map(|choice| choice.value).collect();
        assert_eq!(to_string(<$list>::ALL).unwrap(), to_string(&values).unwrap());
        assert_eq!(from_str::<Vec<$list>>(&to_string(<$list>::ALL).unwrap()).unwrap(), <$list>::ALL);
        let other = (0..).find(|value| !values.contains(value)).unwrap();
        let refusal = from_str::<$list>(&other.to_string()).unwrap_err().to_string();
        assert_eq!(refusal, format!("value {other} is not in the selection list"));
    };
}

/// Every variant reads back from what it is written as, which is the word for it.
macro_rules! words {
    ($($words:ty)+) => {
        $(
            for entry in <$words>::ALL {
                assert_eq!(to_string(entry).unwrap(), format!("\\"{}\\"", entry.as_str()));
                assert_eq!(from_str::<$words>(&to_string(entry).unwrap()).unwrap(), *entry);
            }
        )+
    };
}

fn main() {
    words!(DataType Origin Light ObjectKind ObjectType EntryAccess);
    SELECTIONS
    let code = CodeRef { number: 0x1234, subcode: Some(0x56) };
    assert_eq!(from_str::<CodeRef>(&to_string(&code).unwrap()).unwrap(), code);
    println!("{}", to_string(DEVICES).unwrap());
    println!("{}", to_string(&Repeated::<'_, GROUP>::new(&[GROUP::default(); 3])).unwrap());
    defmt::println!("{}", code);
    defmt::println!("{}", DEVICES[0].codes);
    defmt::println!("{}", Repeated::<'_, GROUP>::new(&[GROUP::default(); 3]));
}
"""
DEPENDENCIES = 'defmt = "1"\nserde_json = "1"\n'


def test_serde_and_defmt_write_the_facts(cargo: Cargo, crate: Path, crate_files: dict[str, str], model: Model) -> None:
    """A program writes what the crate holds through both features."""
    enums = []
    for path, text in crate_files.items():
        if path.startswith("src/") and path != "src/macros.rs":
            module = path.removeprefix("src/").removesuffix(".rs").replace("/", "::")
            enums += [
                f"drivespec_devices::{module}::{name}" for name in re.findall(r"^    (\w+): [iu]\d+ {$", text, re.M)
            ]
    assert len(enums) == sum(text.count("\nselection! {") for text in crate_files.values())
    entry = next(
        f"drivespec_devices::{path.removeprefix('src/').removesuffix('.rs').replace('/', '::')}::{found[1]}"
        for path, text in crate_files.items()
        if path.endswith("telegrams.rs") and (found := re.search(r"pub struct (\w+Entry) {", text))
    )
    program = PROGRAM.replace("SELECTIONS", "\n    ".join(f"selection!({name});" for name in enums))
    folder = cargo.locked(
        "features",
        {
            "Cargo.toml": manifest("features", crate, '"std", "serde", "defmt"') + DEPENDENCIES,
            "src/main.rs": program.replace("GROUP", entry),
        },
    )
    devices, group, *logged = cargo.succeed(folder, "run", "--offline", "--quiet").splitlines()
    compare(json.loads(devices), model)
    first, *others = json.loads(group)
    assert isinstance(first, dict)
    assert others == [first, first]
    check_log(logged, model)


def compare(found: list[dict[str, Any]], model: Model) -> None:
    assert [device["id"] for device in found] == [device.id for device in model.devices]
    for device, written in zip(model.devices, found, strict=True):
        assert written["manual"]["edition"] == device.manual.edition
        codes = {code["number"]: code for code in written["codes"]}
        assert list(codes) == sorted(code.number for code in device.codes)
        for code in device.codes:
            record = codes[code.number]
            assert (record["index"], record["name"], record["data_type"]) == (
                code.index,
                code.name,
                code.data_type.canopen_name,
            )
            assert {choice["value"]: choice["label"] for choice in record["choices"]} == {
                option.value: option.label for option in code.options
            }
            default = code.default
            assert record["default"] == ({"base": default.base} if isinstance(default, NodeRelative) else default)
        assert len(written["objects"]) == len(device.objects)
        tables = {table["kind"]: table for table in written["errors"]}
        assert {
            (kind, entry["number"], entry["name"], *help["causes"])
            for kind, table in tables.items()
            for entry, help in zip(table["entries"], table["help"], strict=True)
        } == {(error.kind, error.number, error.name, *error.causes) for error in device.errors}


def check_log(logged: list[str], model: Model) -> None:
    """The encoding of defmt needs its own reader; the numbers and texts in it do not."""
    reference, table, group = map(bytes.fromhex, logged)
    assert b"\x34\x12" in reference
    for code in model.devices[0].codes:
        assert code.number.to_bytes(2, "little") in table
        assert code.name.encode() in table
    ends = {group.count(group[start : start + 2]) for start in range(2, len(group) - 1)}
    assert 3 in ends


def test_no_warnings_with_one_feature(cargo: Cargo, crate: Path) -> None:
    cargo.component(crate, "clippy")
    for feature in ("serde", "defmt"):
        cargo.succeed(
            crate, "clippy", "--offline", "--no-default-features", "--features", feature, "--", "-D", "warnings"
        )


def test_builds_for_a_microcontroller(cargo: Cargo, crate: Path) -> None:
    rustup = shutil.which("rustup")
    targets = subprocess.run(
        [rustup, "target", "list", "--installed"], capture_output=True, text=True, check=True
    ).stdout.split() if rustup else []  # fmt: skip
    if BARE_METAL not in targets:
        pytest.skip(f"left out: the target is not installed (rustup target add {BARE_METAL})")
    cargo.succeed(crate, "check", "--offline", "--target", BARE_METAL, "--features", "serde,defmt")


def test_builds_with_the_oldest_rust(cargo: Cargo, crate: Path, crate_files: dict[str, str]) -> None:
    """Without features, for each of which its own dependency decides."""
    found = re.search(r'^rust-version = "([\d.]+)"$', crate_files["Cargo.toml"], re.M)
    assert found
    rustup = shutil.which("rustup")
    installed = (
        subprocess.run([rustup, "toolchain", "list"], capture_output=True, text=True, check=True).stdout
        if rustup
        else ""
    )
    toolchain = re.search(rf"^{re.escape(found[1])}\b\S*", installed, re.M)
    if toolchain is None:
        pytest.skip(f"left out: Rust {found[1]} is not installed (rustup toolchain install {found[1]})")
    folder = cargo.place(
        "oldest", {"Cargo.toml": manifest("oldest", crate, '"std"'), "src/main.rs": crate_files["examples/dump.rs"]}
    )
    printed = cargo.succeed(folder, f"+{toolchain[0]}", "run", "--offline", "--quiet")
    assert printed == cargo.succeed(crate, "run", "--offline", "--quiet", "--example", "dump")


def test_says_which_dependencies_it_has(cargo: Cargo, crate: Path) -> None:
    """None by default."""
    assert len(cargo.succeed(crate, "tree", "--offline", "--edges", "normal").splitlines()) == 1
    (package,) = json.loads(cargo.succeed(crate, "metadata", "--offline", "--no-deps", "--format-version", "1"))[
        "packages"
    ]
    assert {dependency["name"]: dependency["optional"] for dependency in package["dependencies"]} == {
        "defmt": True,
        "serde": True,
    }
