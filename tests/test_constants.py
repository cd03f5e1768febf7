"""The published files against each other: each number of generated/json is that of the C, Python and Rust libraries."""

import importlib
import json
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
import test_c
import test_python_package
import test_rust
from rust_crate import Cargo

from generator.model import (
    Bit,
    BitField,
    CanOpenFacts,
    Code,
    CodeRef,
    Default,
    Device,
    DictionaryObject,
    Drive,
    ErrorEntry,
    Field,
    IndicatorTable,
    Layout,
    Model,
    NodeRelative,
    ObjectRef,
    Option,
    Range,
    Slot,
    SubCode,
    SubIndex,
    SwitchGroup,
)

Json = Mapping[str, Any]


@pytest.fixture(scope="module")
def published(root: Path, model: Model) -> Model:
    """The model with the numbers of drives, codes, errors and the rest as generated/json has them."""
    files = {device.id: document(root, device) for device in model.devices}
    devices = tuple(read(files[device.id], device) for device in model.devices)
    drives = {device.drive.id: device.drive for device in devices if device.drive}
    assert list(drives) == [drive.id for drive in model.drives]
    canopen = next(files[device.id]["canopen"] for device in devices if device.canopen)
    cob_ids = tuple(
        replace(
            like,
            name=entry["name"],
            base=entry["base"],
            broadcast=entry["broadcast"],
            objects=object_refs(entry["objects"]),
        )
        for entry, like in zip(canopen["cob_ids"], model.cob_ids, strict=True)
    )
    nodes = next(device.canopen.node_addresses for device in devices if device.canopen)
    return replace(model, devices=devices, drives=tuple(drives.values()), cob_ids=cob_ids, node_addresses=nodes)


def document(root: Path, device: Device) -> Json:
    found: Json = json.loads((root / "generated" / "json" / f"{device.id}.json").read_text(encoding="utf-8"))
    return found


def drive_of(entry: Json, like: Drive) -> Drive:
    fields = entry["error_number"]["fields"]
    return replace(
        like,
        index_base=entry["index_base"]["value"],
        error_fields=tuple((field["name"], BitField(field["low"], field["high"], field["name"])) for field in fields),
        reported_fields=tuple(field["name"] for field in fields if field["reported"]),
        responses=tuple(
            replace(one, value=response["value"], name=response["name"], aliases=tuple(response["aliases"]))
            for response, one in zip(entry["responses"], like.responses, strict=True)
        ),
        modules=tuple(
            replace(one, value=module["value"], name=module["name"])
            for module, one in zip(entry["modules"], like.modules, strict=True)
        ),
        commands=tuple(
            replace(one, value=command["value"], name=command["name"])
            for command, one in zip(entry["commands"], like.commands, strict=True)
        ),
    )


def canopen_of(entry: Json, like: CanOpenFacts) -> CanOpenFacts:
    return replace(
        like,
        baud_rates=tuple(entry["bit_rates"]),
        granularity=entry["pdo_granularity"],
        node_address=entry["node_address_code"],
        node_addresses=range(entry["node_addresses"]["first"], entry["node_addresses"]["last"] + 1),
        boot_up_master=entry["boot_up_master"],
    )


def slot_of(entry: Json, like: Slot) -> Slot:
    return replace(like, **{key: entry[key] for key in entry})


def read(found: Json, device: Device) -> Device:
    layouts = [layout for group in found["telegrams"] for layout in group["layouts"]]
    assert [slot.name for slot in device.slots] == found["slots"]
    return replace(
        device,
        drive=drive_of(found["drive"], device.drive) if device.drive else None,
        canopen=canopen_of(found["canopen"], device.canopen) if device.canopen else None,
        slots=each(slot_of, found["slot_rules"], device.slots),
        codes=each(code_of, found["codes"], device.codes),
        objects=each(object_of, found["objects"], device.objects),
        errors=each(error_of, found["errors"], device.errors),
        indicators=lights_of(found["indicators"], device.indicators),
        switches=each(switch_of, found["switches"], device.switches),
        tables=tuple(
            replace(table, rows=tuple(map(tuple, entry["rows"])))
            for table, entry in zip(device.tables, found["tables"], strict=True)
        ),
        layouts=layouts_of(layouts, device.layouts),
    )


def each(reader: Any, entries: Sequence[Json], like: Sequence[Any]) -> tuple[Any, ...]:
    return tuple(reader(entry, one) for entry, one in zip(entries, like, strict=True))


def default_of(value: int | str | None) -> Default | None:
    if isinstance(value, str) and (found := re.fullmatch(r"\$NODEID\+0x([0-9A-F]+)", value)):
        return NodeRelative(int(found[1], 16))
    return value


def range_of(low: float | None, high: float | None, unit: str | None) -> Range | None:
    if low is None or high is None:
        return None
    return Range(Fraction(str(low)), Fraction(str(high)), unit or "")


def options_of(entries: Mapping[str, str]) -> tuple[Option, ...]:
    return tuple(Option(int(value), label) for value, label in entries.items())


def bits_of(entries: Mapping[str, str]) -> tuple[Bit, ...]:
    return tuple(Bit(int(number), label) for number, label in entries.items())


def fields_of(entries: Sequence[Json]) -> tuple[BitField, ...]:
    return tuple(BitField(entry["low"], entry["high"], entry["name"]) for entry in entries)


def code_refs(texts: Sequence[str]) -> tuple[CodeRef, ...]:
    pieces = [text.removeprefix("C").partition("/") for text in texts]
    return tuple(CodeRef(int(number), int(subcode) if subcode else None) for number, _, subcode in pieces)


def object_refs(texts: Sequence[str]) -> tuple[ObjectRef, ...]:
    pieces = [text.partition(":") for text in texts]
    return tuple(ObjectRef(int(index, 16), int(sub, 16) if sub else None) for index, _, sub in pieces)


def code_of(entry: Json, like: Code) -> Code:
    limits = entry["range"] or {"min": None, "max": None, "unit": None}
    return replace(
        like,
        number=entry["number"],
        index=entry["index"],
        scaling=entry["scaling_factor"],
        range=range_of(limits["min"], limits["max"], limits["unit"]),
        default=like.default if like.subcodes else default_of(entry["defaults"].get("0")),
        options=options_of(entry["options"]),
        bits=bits_of(entry["bits"]),
        fields=fields_of(entry["fields"]),
        subcodes=tuple(subcode_of(entry, sub) for sub in like.subcodes),
        objects=object_refs(entry["objects"]),
    )


def subcode_of(entry: Json, like: SubCode) -> SubCode:
    key = str(like.number)
    follows = default_of(entry["follows"].get(key))
    assert follows is None or isinstance(follows, NodeRelative)
    return replace(
        like,
        name=entry["subcode_names"].get(key, ""),
        default=default_of(entry["defaults"].get(key)),
        follows=follows,
        options=options_of(entry["subcode_options"].get(key, {})),
    )


def object_of(entry: Json, like: DictionaryObject) -> DictionaryObject:
    subindexes = each(subindex_of, entry["subindexes"], like.subindexes)
    return replace(like, index=entry["index"], kind=entry["kind"], subindexes=subindexes)


def subindex_of(entry: Json, like: SubIndex) -> SubIndex:
    return replace(
        like,
        number=entry["subindex"],
        access=entry["access"],
        default=default_of(entry["default"]),
        range=range_of(entry["min"], entry["max"], entry["unit"]),
        options=options_of(entry["options"]),
        bits=bits_of(entry["bits"]),
        fields=fields_of(entry["fields"]),
        codes=code_refs(entry["codes"]),
        pdo_mapping=entry["pdo_mapping"],
        unused=entry["unused"],
        abort=entry["abort"],
    )


def error_of(entry: Json, like: ErrorEntry) -> ErrorEntry:
    last = entry["number"] if entry["last"] is None else entry["last"]
    codes = code_refs(entry["adjustable_in"])
    return replace(like, kind=entry["kind"], number=entry["number"], last=last, adjustable_in=codes)


def lights_of(entries: Sequence[Json], like: Sequence[IndicatorTable]) -> tuple[IndicatorTable, ...]:
    rest = iter(entries)
    tables = []
    for table in like:
        rows = []
        for row in table.rows:
            patterns = [led["pattern"] for led in next(rest)["leds"]]
            read = tuple(
                replace(
                    old,
                    period=None if new["period_s"] is None else Fraction(str(new["period_s"])),
                    flashes=new["flashes"],
                    pause=None if new["pause_s"] is None else Fraction(str(new["pause_s"])),
                )
                for new, old in zip(patterns, row.patterns, strict=True)
            )
            rows.append(replace(row, patterns=read))
        tables.append(replace(table, rows=tuple(rows)))
    assert next(rest, None) is None
    return tuple(tables)


def switch_of(entry: Json, like: SwitchGroup) -> SwitchGroup:
    valid = entry["valid"]
    rows = zip(entry["values"].items(), like.rows, strict=True)
    return replace(
        like,
        weights=tuple(entry["weights"]),
        valid=valid and (valid["first"], valid["last"]),
        sets=code_refs(entry["sets"]),
        rows=tuple(replace(row, value=value, positions=positions) for (value, positions), row in rows),
    )


def layouts_of(entries: Sequence[Json], like: Sequence[Layout]) -> tuple[Layout, ...]:
    by_id = {entry["id"]: entry for entry in entries}
    assert len(by_id) == len(entries) == len(like)
    return tuple(replace(old, fields=each(field_of, by_id[old.id]["fields"], old.fields)) for old in like)


def field_of(entry: Json, like: Field) -> Field:
    sizes = like.sizes and replace(
        like.sizes, sizes=tuple((int(value), size) for value, size in entry["length_by"]["sizes"].items())
    )
    return replace(
        like,
        length=entry["length"],
        sizes=sizes,
        constant=entry["constant"],
        values=options_of(entry["values"]),
        bits=fields_of(entry["bits"]),
        bit_values=tuple((name, options_of(values)) for name, values in entry["bit_values"].items()),
        fields=each(field_of, entry["fields"], like.fields),
    )


def test_json_holds_the_model(published: Model, model: Model) -> None:
    """So what other tests compare with the model, the telegrams among it, is compared with generated/json."""
    for found, device in zip(published.devices, model.devices, strict=True):
        for part in ("codes", "objects", "errors", "indicators", "switches", "tables", "layouts"):
            pairs = zip(getattr(found, part), getattr(device, part), strict=True)
            assert [(a, b) for a, b in pairs if a != b][:1] == []


def test_constants_of_c(root: Path, published: Model, tmp_path: Path) -> None:
    printed = test_c.self_test(root / "generated" / "c", tmp_path, "drivespec")
    test_c.assert_same(printed, test_c.expected_common(published))
    for device in published.devices:
        printed = test_c.self_test(root / "generated" / "c", tmp_path, device.id)
        test_c.assert_same(printed, test_c.expected_device(device) | test_c.expected_records(device))


def test_constants_of_rust(root: Path, published: Model) -> None:
    cargo, home = Cargo(root), root / "generated" / "rust"
    files = {
        str(file.relative_to(home)): file.read_text(encoding="utf-8") for file in home.rglob("*") if file.is_file()
    }
    crate = cargo.locked("published", {path: text for path, text in files.items() if path != "Cargo.lock"})
    test_rust.compare(cargo.succeed(crate, "run", "--offline", "--quiet", "--example", "dump"), published)
    expected = dict(test_rust.probes(published))
    assert cargo.probe("probe", crate, ["*"], list(expected)) == expected


@pytest.fixture
def package(root: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """The published package; another copy of it that is loaded comes back afterwards."""
    name = test_python_package.PACKAGE
    before = {loaded: module for loaded, module in sys.modules.items() if loaded.split(".")[0] == name}
    monkeypatch.syspath_prepend(str(root / "generated" / "python"))
    for loaded in before:
        del sys.modules[loaded]
    yield importlib.import_module(name)
    for loaded in [loaded for loaded in sys.modules if loaded.split(".")[0] == name]:
        del sys.modules[loaded]
    sys.modules.update(before)


def test_constants_of_python(root: Path, package: Any, published: Model) -> None:
    pairs = [(package.load(device.id), device) for device in published.devices]
    assert all(str(root / "generated") in module.__file__ for module, _ in pairs)
    for check in (
        test_python_package.test_codes,
        test_python_package.test_objects,
        test_python_package.test_errors,
        test_python_package.test_device_facts,
        test_python_package.test_switches,
        test_python_package.test_tables,
        test_python_package.test_public_names_are_those_of_the_facts,
    ):
        check(pairs)
    test_python_package.test_indicators(pairs, package)
    test_python_package.test_cob_ids(package, published)
