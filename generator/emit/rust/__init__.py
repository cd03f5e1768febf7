"""Target "rust": the crate ``drivespec-devices``, facts and telegrams for programs with or without an operating system.

Each device is a module of small modules: codes, selection lists (enums), bit masks, objects, errors, LEDs, switches,
telegrams, errata.  Codes of a second slot are written as their difference to the first; the enums and masks of the
first serve both.
"""

from collections.abc import Mapping, Sequence

from generator.emit.base import Output, Target
from generator.emit.environment import license_text
from generator.emit.environment import render as fill
from generator.emit.rust import facts, words
from generator.emit.rust.device import DeviceFiles
from generator.emit.rust.drive import drive_file, drive_module
from generator.emit.rust.example import example
from generator.emit.rust.notice import notice
from generator.emit.rust.syntax import array, constant_name, declaration, doc, hexadecimal, string, type_name
from generator.emit.rust.views import DataTypeFigures, Module, Record, TypeEnum, TypeVariant
from generator.model import DataType, Light, Model, Origin
from generator.model.citation import UNNAMED
from generator.naming import Scope, safe, snake

_OWN_MODULES = ("cob_ids", "codec", "default", "defmt", "drives", "formats", "macros", "serde", "std", "types")
"""Modules and features that are no devices."""
_ORIGINS = {
    Origin.MANUAL: "Printed in the manual cited.",
    Origin.STANDARD: "Taken from a public standard.",
    Origin.DERIVED: "Calculated from printed facts.",
    Origin.ASSUMED: "Documented nowhere, an assumption.",
    Origin.PUBLIC: "Printed in another public document.",
}
_LIGHTS = {
    Light.ANY: "Not said, or without meaning.",
    Light.OFF: "Off.",
    Light.ON: "On.",
    Light.FLICKER: "Flickering.",
    Light.ON_OR_FLICKER: "Lit or flickering; the manual draws no line between the two.",
    Light.BLINK: "On and off for the same time.",
    Light.FLASH: "Flashes and a pause.",
}
_KINDS = {"canopen": "Object dictionary of CANopen.", "profidrive": "Parameters of PROFIdrive."}
_ACCESSES = {
    "ro": "Reading alone.",
    "wo": "Writing alone.",
    "rw": "Reading and writing.",
    "const": "Reading alone; the value never changes.",
    "rwr": "Reading and writing; TPDOs may map it.",
    "rww": "Reading and writing; RPDOs may map it.",
}


def render(model: Model) -> Mapping[str, Output]:
    """Files of the crate.

    Raises:
        EmitError: Two facts want one name or number, or the codes of a device break the rule of the index.
    """
    modules = _device_modules(model)
    devices = [DeviceFiles(model, device, modules[device.id]) for device in model.devices]
    with_telegrams = [device.module for device in devices if device.device.layouts]
    files = _crate_files(model, [device.module for device in devices], with_telegrams, *example(devices))
    for drive in model.drives:
        files[f"src/drives/{drive_module(drive)}.rs"] = drive_file(model, drive)
    for device in devices:
        files |= device.render()
    return {path: Output(text) for path, text in files.items()}


TARGET = Target("rust", render)


def _device_modules(model: Model) -> dict[str, str]:
    scope = Scope("modules and features of the crate")
    for device in model.devices[:1]:
        for name in _OWN_MODULES:
            scope.add(name, device.where)
    return {device.id: scope.add(safe(snake(device.id), "rust"), device.where) for device in model.devices}


def _crate_files(
    model: Model,
    modules: Sequence[Module],
    with_telegrams: Sequence[Module],
    example_module: str,
    example_lines: Sequence[str],
) -> dict[str, str]:
    manuals = list({device.manual.id: device.manual for device in model.devices}.values())
    head = notice(model, manuals)
    return {
        "Cargo.toml": fill(
            "rust/Cargo.toml.j2",
            notice=notice(model, manuals, "#"),
            version=model.version,
            modules=modules,
            features=", ".join(string(module.name) for module in modules),
        ),
        "fuzz/Cargo.toml": fill(
            "rust/fuzz.toml.j2", notice=notice(model, manuals, "#"), version=model.version, modules=with_telegrams
        ),
        "README.md": fill(
            "rust/README.md.j2", version=model.version, date=model.date, modules=modules, example=example_lines
        ),
        "LICENSE": license_text(),
        "rustfmt.toml": fill("rust/rustfmt.toml.j2", notice=notice(model, manuals, "#")),
        "examples/dump.rs": fill("rust/dump.rs.j2", notice=head),
        "src/lib.rs": fill(
            "rust/lib.rs.j2",
            notice=head,
            modules=modules,
            names=sorted(module.name for module in modules),
            example_module=example_module,
        ),
        "src/cob_ids.rs": _cob_ids(model, head),
        "src/codec.rs": fill("rust/codec.rs.j2", notice=head),
        "src/formats.rs": fill("rust/formats.rs.j2", notice=head),
        "src/macros.rs": fill("rust/macros.rs.j2", notice=head),
        "src/types.rs": _types(head, model.node_addresses),
        "src/drives.rs": fill("rust/drives.rs.j2", notice=head, drives=sorted(map(drive_module, model.drives))),
    }


def _cob_ids(model: Model, head: str) -> str:
    records = []
    for entry in model.cob_ids:
        name = constant_name(snake(entry.name))
        records.append(
            Record(
                name,
                doc([words.headline(entry.name)], [words.source(entry.cite, Origin.STANDARD)]),
                declaration(name, "CobId", facts.cob_id(entry)),
            )
        )
    table = declaration("TABLE", "&[CobId]", array(record.name for record in records))
    return fill("rust/cob_ids.rs.j2", notice=head, records=records, table=table)


def _types(head: str, nodes: range) -> str:
    names = {data_type: type_name(data_type.canopen_name) for data_type in DataType}
    enums = [
        _enum(
            "DataType",
            "Data type of a value on the bus, named as in CiA 301.",
            [(name, t.canopen_name, f"`{t.canopen_name}`.") for t, name in names.items()],
        ),
        _enum(
            "Origin",
            "How a fact came to be known.",
            [(type_name(origin.value), origin.value, text) for origin, text in _ORIGINS.items()],
        ),
        _enum(
            "Light",
            "What an LED does.",
            [(type_name(light.value), light.value, text) for light, text in _LIGHTS.items()],
        ),
        _enum(
            "ObjectKind",
            "List that an object belongs to.",
            [(facts.OBJECT_KINDS[kind], kind, text) for kind, text in _KINDS.items()],
        ),
        _enum(
            "ObjectType",
            "Structure of an object.",
            [(name, text, f"`{text}` of CiA 301.") for text, name in facts.OBJECT_TYPES.items()],
        ),
        _enum(
            "EntryAccess",
            "Access to a sub-index, in the terms of CiA 306.",
            [(facts.ENTRY_ACCESSES[access], access, text) for access, text in _ACCESSES.items()],
        ),
    ]
    return fill(
        "rust/types.rs.j2",
        notice=head,
        enums=enums,
        nodes=nodes or range(1),
        unnamed=UNNAMED,
        data_types=[DataTypeFigures(name, hexadecimal(t.canopen_number, 4), t.bits) for t, name in names.items()],
        signed=" | ".join(f"Self::{name}" for t, name in names.items() if t.signed),
    )


def _enum(name: str, comment: str, variants: Sequence[tuple[str, str, str]]) -> TypeEnum:
    everything = array(f"Self::{variant}" for variant, _, _ in variants)
    return TypeEnum(
        name,
        comment,
        tuple(TypeVariant(*variant) for variant in variants),
        declaration("ALL", "&'static [Self]", everything, 4),
    )
