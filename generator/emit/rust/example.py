"""The example in the README, also a test of the crate: each kind of lookup on a fact that allows it."""

from collections.abc import Sequence
from itertools import count

from generator.emit import names
from generator.emit.rust.device import DeviceFiles
from generator.emit.rust.syntax import constant_name, hexadecimal, string
from generator.emit.rust.telegrams import telegram_name
from generator.emit.rust.vectors import filled, octets


def example(devices: Sequence[DeviceFiles]) -> tuple[str, list[str]]:
    """Module of the device in the example and its lines; ("", []) where no device has anything to look up.

    The first of the devices with the most kinds of facts is taken.
    """
    kinds = (_codes, _selections, _errors, _telegrams)
    candidates = [(files.module.name, [part for kind in kinds if (part := kind(files))]) for files in devices]
    module, parts = max(candidates, key=lambda candidate: len(candidate[1]), default=("", []))
    lines = [line for part in parts for line in ("", *part)][1:]
    return (module, lines) if lines else ("", [])


def _codes(files: DeviceFiles) -> list[str]:
    if not files.device.codes:
        return []
    code = files.device.codes[0]
    index = hexadecimal(code.index, 4)
    return [
        f"use drivespec_devices::{files.module.name}::codes;",
        "",
        "// A code by its name, by its number and by its index on the bus.",
        f"let code = &codes::{constant_name(names.code_name(code))};",
        f"assert_eq!((code.number, code.index), ({code.number}, {index}));",
        f"assert_eq!(codes::TABLE.get({code.number}), Some(code));",
        f"assert_eq!(codes::TABLE.get_by_index({index}), Some(code));",
    ]


def _selections(files: DeviceFiles) -> list[str]:
    if not files.selections:
        return []
    selection = min(files.selections.values(), key=lambda selection: len(selection.variants))
    variant = selection.variants[-1]
    known = {int(variant.value) for variant in selection.variants}
    unknown = next(value for value in count() if value not in known)
    return [
        f"use drivespec_devices::{files.module.name}::selections::{selection.name};",
        "",
        "// A value that was read; an unknown one is not lost.",
        f"assert_eq!({selection.name}::try_from({variant.value}), Ok({selection.name}::{variant.name}));",
        f"assert_eq!({selection.name}::try_from({unknown}).unwrap_err().raw, {unknown});",
    ]


def _errors(files: DeviceFiles) -> list[str]:
    if not files.error_tables:
        return []
    kind, errors = next(iter(files.error_tables.items()))
    reported = 0xFFFF_FFFF & ~files.error_mask(kind) | errors[0].number
    return [
        f"use drivespec_devices::{files.module.name}::errors::{kind};",
        "",
        "// An error number as the device reports it, with all bits set that do not tell which error it is.",
        f"let error = {kind}::TABLE.get({hexadecimal(reported, 8)}).unwrap();",
        f"assert_eq!(error.name, {string(errors[0].name)});",
    ]


def _telegrams(files: DeviceFiles) -> list[str]:
    if not files.device.examples:
        return []
    example = files.device.examples[0]
    layout = next(layout for layout in files.device.layouts if layout.id == example.layout)
    data, name = filled(layout, example.data), telegram_name(layout)
    return [
        f"use drivespec_devices::{files.module.name}::telegrams::{name};",
        "",
        "// Bytes become values, values become bytes; a telegram that was cut off is refused.",
        f"let telegram = {name}::decode({octets(data)}).unwrap();",
        f"let mut buffer = [0; {len(data)}];",
        f"assert_eq!(telegram.encode(&mut buffer), Ok({len(data)}));",
        f"assert_eq!(&buffer, {octets(data)});",
        f'assert_eq!({name}::decode(&buffer[..1]).unwrap_err().as_str(), "truncated");',
    ]
