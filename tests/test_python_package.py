"""The Python package holds the facts of the model, all of them and no others, and works where users will put it."""

import ast
import dataclasses
import doctest
import importlib
import inspect
import json
import os
import shutil
import statistics
import subprocess
import sys
import textwrap
import timeit
import typing
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import replace
from decimal import Decimal
from enum import IntEnum, IntFlag
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from generator.emit import names
from generator.emit.base import EmitError
from generator.emit.python import render
from generator.emit.python.telegrams import class_name, field_name
from generator.emit.switches import remarks
from generator.model import (
    Access,
    Bit,
    BitField,
    Cite,
    CobId,
    Code,
    CodeRef,
    Column,
    DataType,
    Device,
    DictionaryObject,
    Erratum,
    ErrorEntry,
    Field,
    IndicatorRow,
    IndicatorTable,
    Layout,
    Led,
    Model,
    NodeRelative,
    ObjectRef,
    Option,
    Pattern,
    Range,
    SubCode,
    SubIndex,
    SwitchGroup,
    SwitchRow,
    Table,
)
from generator.naming import pascal, safe

PACKAGE = "drivespec_devices"
VERSIONS = ("3.9", "3.10", "3.11", "3.12", "3.13", "3.14")


@pytest.fixture(scope="module")
def distribution(generated: Path) -> Path:
    """Folder of the distribution."""
    return generated / "python"


@pytest.fixture(scope="module")
def package(distribution: Path) -> Iterator[Any]:
    """The package, imported from the generated files."""
    sys.path.insert(0, str(distribution))
    try:
        yield importlib.import_module(PACKAGE)
    finally:
        sys.path.remove(str(distribution))
        for name in [name for name in sys.modules if name.split(".")[0] == PACKAGE]:
            del sys.modules[name]


@pytest.fixture(scope="module")
def pairs(package: Any, model: Model) -> list[tuple[Any, Device]]:
    """Each device module with the device of the model."""
    return [(package.load(device.id), device) for device in model.devices]


def run(*arguments: str | Path, cwd: Path | None = None, path: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run a program; ``path`` is where Python finds modules first."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "MYPY"))}
    if path is not None:
        environment |= {"PYTHONPATH": str(path), "MYPYPATH": str(path)}
    environment["PYTHONDONTWRITEBYTECODE"] = "1"
    return subprocess.run(list(map(str, arguments)), cwd=cwd, env=environment, capture_output=True, text=True)


def script(*, python: str | Path = sys.executable, path: Path, code: str, flags: tuple[str, ...] = ()) -> str:
    """Output of a script that finds the package in ``path``; warnings are errors."""
    done = run(python, "-W", "error", *flags, "-c", textwrap.dedent(code), path=path)
    assert done.returncode == 0, done.stderr
    return done.stdout


# Facts: what the package says of each thing, and what it has to say after the model.


def plain_cite(cite: Any) -> Any:
    return None if cite is None else (cite.manual, cite.chapter, cite.page)


def plain_type(data_type: Any) -> Any:
    return data_type.name, data_type.number, data_type.bits, data_type.signed


def model_type(data_type: DataType) -> Any:
    return data_type.canopen_name, data_type.canopen_number, data_type.bits, data_type.signed


def plain_range(limits: Any) -> Any:
    return None if limits is None else (Fraction(limits.low), Fraction(limits.high), limits.unit)


def plain_default(default: Any) -> Any:
    return ("node", default.base) if hasattr(default, "base") else default


def plain_fields(fields: Any) -> Any:
    return [(field.low, field.high, field.label, field.mask) for field in fields]


def plain_refs(refs: Any) -> Any:
    return [str(ref) for ref in refs]


def is_enum(value: Any) -> bool:
    return isinstance(value, type) and issubclass(value, (IntEnum, IntFlag))


def members(enum: Any) -> Any:
    """Values and labels of a selection list."""
    return None if enum is None else [(member.value, member.label) for member in enum]


def bits(enum: Any) -> Any:
    """Values and labels of a bit-coded value."""
    return None if enum is None else [(member.value, enum(member.value).labels) for member in enum]


def model_members(options: tuple[Option, ...]) -> Any:
    return [(option.value, option.label) for option in options] or None


def model_bits(entries: tuple[Bit, ...]) -> Any:
    return [(1 << bit.number, (bit.label,)) for bit in entries] or None


def code_facts(code: Any) -> dict[str, Any]:
    return {
        "number": code.number,
        "designation": code.designation,
        "slot": code.slot,
        "twin_of": code.twin_of,
        "name": code.name,
        "index": code.index,
        "type": (code.type_name, plain_type(code.data_type)),
        "length": code.length,
        "access": (code.access.read, code.access.write, code.access.conditions),
        "scaling": code.scaling,
        "range": plain_range(code.range),
        "default": plain_default(code.default),
        "default_cite": plain_cite(code.default_cite),
        "options": members(code.selection),
        "bits": bits(code.flags),
        "fields": plain_fields(code.fields),
        "subcodes": [
            (
                sub.number,
                sub.name,
                plain_default(sub.default),
                plain_default(sub.follows),
                members(sub.selection),
                sub.description,
            )
            for sub in code.subcodes
        ],
        "objects": plain_refs(code.objects),
        "since": code.since,
        "internal": code.internal,
        "description": code.description,
        "shared_by": code.shared_by,
        "origin": code.origin,
        "cite": plain_cite(code.cite),
        "errata": code.errata,
    }


def model_code_facts(code: Code) -> dict[str, Any]:
    return {
        "number": code.number,
        "designation": code.designation,
        "slot": code.slot,
        "twin_of": code.twin_of,
        "name": code.name,
        "index": code.index,
        "type": (code.type_name, model_type(code.data_type)),
        "length": code.length,
        "access": (code.access.read, code.access.write, code.access.conditions),
        "scaling": code.scaling,
        "range": plain_range(code.range),
        "default": plain_default(code.default),
        "default_cite": plain_cite(code.default_cite),
        "options": model_members(code.options),
        "bits": model_bits(code.bits),
        "fields": plain_fields(code.fields),
        "subcodes": [
            (
                sub.number,
                sub.name,
                plain_default(sub.default),
                plain_default(sub.follows),
                model_members(sub.options),
                sub.description,
            )
            for sub in code.subcodes
        ],
        "objects": plain_refs(code.objects),
        "since": code.since,
        "internal": code.internal,
        "description": code.description,
        "shared_by": code.shared_by,
        "origin": code.origin.value,
        "cite": plain_cite(code.cite),
        "errata": code.errata,
    }


def subindex_facts(sub: Any) -> dict[str, Any]:
    return {
        "number": sub.number,
        "name": sub.name,
        "types": (plain_type(sub.data_type), plain_type(sub.printed_type)),
        "access": (sub.access, sub.printed_access),
        "default": plain_default(sub.default),
        "range": plain_range(sub.range),
        "options": members(sub.selection),
        "bits": bits(sub.flags),
        "fields": plain_fields(sub.fields),
        "codes": plain_refs(sub.codes),
        "signature": sub.signature,
        "marks": (sub.pdo_mapping, sub.unused, sub.abort),
        "description": sub.description,
        "errata": sub.errata,
    }


def model_subindex_facts(sub: SubIndex) -> dict[str, Any]:
    return {
        "number": sub.number,
        "name": sub.name,
        "types": (model_type(sub.data_type), model_type(sub.printed_type)),
        "access": (sub.access, sub.printed_access),
        "default": plain_default(sub.default),
        "range": plain_range(sub.range),
        "options": model_members(sub.options),
        "bits": model_bits(sub.bits),
        "fields": plain_fields(sub.fields),
        "codes": plain_refs(sub.codes),
        "signature": sub.signature,
        "marks": (sub.pdo_mapping, sub.unused, sub.abort),
        "description": sub.description,
        "errata": sub.errata,
    }


def object_facts(entry: Any) -> list[Any]:
    return [entry.kind, entry.index, entry.designation, entry.name, entry.object_type, entry.description,
            plain_cite(entry.cite), entry.errata]  # fmt: skip


def error_facts(error: Any) -> list[Any]:
    return [error.kind, error.number, error.last, error.slot, error.name, error.response, error.responses,
            plain_refs(error.adjustable_in), error.register, error.causes, error.remedies, error.description,
            plain_cite(error.cite), error.errata]  # fmt: skip


def erratum_facts(erratum: Any) -> list[Any]:
    return [erratum.id, erratum.kind, erratum.why, erratum.confidence, erratum.origin,
            [(place.location, place.page, place.manual, place.printed) for place in erratum.places]]  # fmt: skip


def test_records_have_every_field_of_the_model(package: Any) -> None:
    """A field that the model gains has to reach the package, or be left out on purpose."""
    as_printed = {"printed", "printed_name", "printed_names", "printed_adjustable_in", "attributes", "printed_codes",
                  "named_in"}  # fmt: skip
    enums = {"options": "selection_name", "bits": "flags_name"}
    added = {"device", "index"}  # the way back from a record to its module and object
    masks = {"ignored_mask"}  # which bits of a number do not matter
    places = {"where", "about_text", "printed_text", "used_text", "rule"}
    in_notes = {"block", "delivered", "code_counts"}
    drawn = {"assignment"}  # its signals are rows of the table
    of_standards = {"standard"}
    for record, source in (
        (package.Code, Code),
        (package.SubCode, SubCode),
        (package.DictionaryObject, DictionaryObject),
        (package.SubIndex, SubIndex),
        (package.Error, ErrorEntry),
        (package.Erratum, Erratum),
        (package.Cite, Cite),
        (package.Access, Access),
        (package.Range, Range),
        (package.BitField, BitField),
        (package.CodeRef, CodeRef),
        (package.ObjectRef, ObjectRef),
        (package.NodeRelative, NodeRelative),
        (package.CobId, CobId),
        (package.IndicatorTable, IndicatorTable),
        (package.IndicatorRow, IndicatorRow),
        (package.Led, Led),
        (package.Pattern, Pattern),
        (package.SwitchGroup, SwitchGroup),
        (package.SwitchRow, SwitchRow),
        (package.Table, Table),
        (package.Column, Column),
    ):
        fields = {enums.get(field.name, field.name) for field in dataclasses.fields(source)}
        left_out = places | in_notes | drawn | of_standards | (as_printed - set(record.__slots__))
        left_out |= {"title"} if source is CobId else set()  # what its telegrams are for
        assert (set(record.__slots__) - masks) | added == (fields - left_out) | added, source


def test_devices(package: Any, model: Model) -> None:
    """The package lists the devices of the model and says which version it is."""
    assert {device.id: device.title for device in model.devices} == package.DEVICES
    assert (package.__version__, package.SPEC_VERSION, package.SPEC_DATE) == (model.version, model.version, model.date)
    with pytest.raises(LookupError, match="no device 'none'"):
        package.load("none")


def test_data_types(package: Any) -> None:
    """Name, number, width and sign of every data type."""
    assert [plain_type(entry) for entry in package.DATA_TYPES.values()] == [model_type(entry) for entry in DataType]
    assert all(entry.name == name for name, entry in package.DATA_TYPES.items())


def test_type_hints(package: Any) -> None:
    """The annotations of every class and method can be read at run time."""
    values = (getattr(package, name) for name in package.__all__)
    classes: list[Any] = [value for value in values if isinstance(value, type)]
    hints = {each.__name__: typing.get_type_hints(each) for each in classes}
    assert hints["Code"]["default"] == int | str | package.NodeRelative | None
    records = [each for each in classes if hasattr(each, "__dataclass_fields__")]
    assert records and all(set(each.__slots__) <= set(hints[each.__name__]) for each in records)
    for method in (value for each in classes for value in vars(each).values() if inspect.isfunction(value)):
        if not method.__name__.startswith("__"):
            typing.get_type_hints(method)


def test_cob_ids(package: Any, model: Model) -> None:
    """Every identifier; a broadcast is the same for every node, the others follow the node address."""
    assert list(package.COB_IDS) == [entry.name for entry in model.cob_ids]
    for entry in model.cob_ids:
        record = package.COB_IDS[entry.name]
        assert (record.name, record.base, record.broadcast) == (entry.name, entry.base, entry.broadcast)
        assert [(ref.index, ref.subindex) for ref in record.objects] == [(r.index, r.subindex) for r in entry.objects]
        assert plain_cite(record.cite) == plain_cite(entry.cite)
        for node in (1, 5, 127):
            assert record.at(node) == entry.base + (0 if entry.broadcast else node)
        for wrong in (0, 128):
            with pytest.raises(ValueError, match="no node address"):
                record.at(wrong)
    assert {entry.broadcast for entry in model.cob_ids} == {True, False}


def test_codes(pairs: list[tuple[Any, Device]]) -> None:
    """Every code with every fact, and no further code."""
    for module, device in pairs:
        assert [code_facts(code) for code in module.CODES] == [model_code_facts(code) for code in device.codes]


def test_objects(pairs: list[tuple[Any, Device]]) -> None:
    """Every object and sub-index with every fact, and no further ones."""
    for module, device in pairs:
        expected = [[*object_facts(entry), entry.origin.value] for entry in device.objects]
        assert [[*object_facts(entry), entry.origin] for entry in module.OBJECTS] == expected
        for entry, source in zip(module.OBJECTS, device.objects, strict=True):
            wanted = [model_subindex_facts(sub) for sub in source.subindexes]
            assert [subindex_facts(sub) for sub in entry.subindexes] == wanted


def test_errors(pairs: list[tuple[Any, Device]]) -> None:
    """Every error number with every fact, and no further one."""
    for module, device in pairs:
        expected = [[*error_facts(error), error.origin.value] for error in device.errors]
        assert [[*error_facts(error), error.origin] for error in module.ERRORS] == expected


def test_errata(pairs: list[tuple[Any, Device]]) -> None:
    """Every entry of the ledger, under its id."""
    for module, device in pairs:
        assert list(module.ERRATA) == [erratum.id for erratum in device.errata]
        for erratum in device.errata:
            record = module.ERRATA[erratum.id]
            assert erratum_facts(record) == erratum_facts(erratum)
            assert (record.about, record.place, record.printed, record.used) == (
                erratum.about_text, erratum.place, erratum.printed_text, erratum.used_text
            )  # fmt: skip


def test_device_facts(pairs: list[tuple[Any, Device]]) -> None:
    """Device, manual, drive, slots and CANopen properties."""
    for module, device in pairs:
        record = module.DEVICE
        plain = ("id", "title", "manufacturer", "order_code", "bus", "hardware_version", "software_version")
        assert [getattr(record, name) for name in plain] == [getattr(device, name) for name in plain]
        for name in ("id", "title", "publisher", "edition", "date", "document", "kind", "url", "pages"):
            assert getattr(record.manual, name) == getattr(device.manual, name)
        assert plain_cite(record.cite) == plain_cite(device.cite)
        assert (record.canopen is None) == (device.canopen is None)
        if device.canopen is not None:
            for name in ("baud_rates", "granularity", "node_address", "boot_up_master"):
                assert getattr(record.canopen, name) == getattr(device.canopen, name)
            assert plain_cite(record.canopen.cite) == plain_cite(device.canopen.cite)
        slots = ("name", "first_code", "last_code", "code_offset", "error_offset")
        assert [[getattr(slot, name) for name in slots] for slot in record.slots] == [
            [getattr(slot, name) for name in slots] for slot in device.slots
        ]
        assert (record.drive is None) == (device.drive is None)
        if device.drive is not None:
            names_ = ("id", "title", "manufacturer", "index_base")
            assert [getattr(record.drive, n) for n in names_] == [getattr(device.drive, n) for n in names_]
            fields = [(field.low, field.high, name, field.mask) for name, field in device.drive.error_fields]
            assert plain_fields(record.drive.error_fields) == fields
            for enum, entries in (
                ("DriveResponse", device.drive.responses),
                ("DriveModule", device.drive.modules),
                ("DriveCommand", device.drive.commands),
            ):
                expected = [(entry.value, entry.name) for entry in entries] or None
                assert members(getattr(module, enum, None)) == expected


def test_public_names_are_those_of_the_facts(pairs: list[tuple[Any, Device]]) -> None:
    """A constant for each code, object, sub-index and error, the enums that the records name, and nothing else."""
    always = {"CODES", "DEVICE", "ERRATA", "ERRORS", "INDICATORS", "OBJECTS", "SWITCHES", "TABLES", "code",
              "code_by_name", "codes_at", "error", "errors_at", "object_at"}  # fmt: skip
    for module, device in pairs:
        api = set(always)
        constants: dict[str, Any] = {}
        for code in device.codes:
            constants[names.code_name(code).upper()] = code.number
        for entry in device.objects:
            constants[names.object_name(entry).upper()] = entry.index
            for sub in entry.subindexes:
                constants[names.subindex_name(entry, sub).upper()] = (entry.index, sub.number)
        drive_enums = set()
        if device.drive is not None:
            api |= {"code_index", "index_code"}
            api |= {"error_number", "error_parts"} if device.drive.error_fields else set()
            constants["INDEX_BASE"] = device.drive.index_base
            lists = {"DriveResponse": device.drive.responses, "DriveModule": device.drive.modules,
                     "DriveCommand": device.drive.commands}  # fmt: skip
            drive_enums = {name for name, entries in lists.items() if entries}
        telegrams = {name for name, value in telegram_classes(module).items()}
        drive_enums |= telegram_enums(module, device)
        records = [*module.CODES, *(s for c in module.CODES for s in c.subcodes),
                   *(s for o in module.OBJECTS for s in o.subindexes)]  # fmt: skip
        enums = {getattr(record, key, None) for record in records for key in ("selection_name", "flags_name")} - {None}

        values = {name: getattr(module, name) for name in module.__all__}
        assert len(values) == len(module.__all__)
        found_enums = {name for name, value in values.items() if is_enum(value)}
        errors = {name: value for name, value in values.items() if isinstance(value, int) and name not in constants}
        assert found_enums == enums | drive_enums
        assert {name: value for name, value in values.items() if name in constants} == constants
        assert sorted(errors.values()) == sorted(error.number for error in device.errors)
        assert set(values) == api | set(constants) | found_enums | set(errors) | telegrams
        for name, value in errors.items():
            words = [names.error_name(error).upper() for error in device.errors if error.number == value]
            assert any(word in name for word in words)
        assert set(dir(module)) >= set(module.__all__)


def telegram_classes(module: Any) -> dict[str, Any]:
    """Classes of telegrams and of the entries of their groups, by name."""
    values = {name: getattr(module, name) for name in module.__all__}
    return {name: value for name, value in values.items() if isinstance(value, type) and not is_enum(value)}


def telegram_lists(layout: Layout) -> Iterator[tuple[tuple[str, ...], Field, str, tuple[Option, ...]]]:
    """Lists of values in a layout: words of the name, the field, the part of it or "", and the list."""

    def walk(fields: tuple[Field, ...], path: tuple[str, ...]) -> Iterator[Any]:
        for field in fields:
            yield from walk(field.fields, (*path, field.name))
            for part, options in (("", field.values), *field.bit_values):
                if options:
                    yield (*path, field.name), field, part, options

    yield from walk(layout.fields, (layout.id,))


def telegram_enums(module: Any, device: Device) -> set[str]:
    """Enums of the fields of telegrams, each of which has to list what the layout does."""
    found = set()
    for layout in device.layouts:
        for path, field, part, options in telegram_lists(layout):
            owner = telegram_classes(module)[pascal(*path[:-1])]
            doc = next(doc for name, doc in class_docs(owner).items() if name == field.name)
            names_ = doc.rsplit("Its values are listed in ", 1)[1].rstrip(".").split(", ")
            lists = [(name, members(getattr(module, name))) for name in names_]
            (name,) = [name for name, values in lists if values == model_members(options)][:1]
            assert name.endswith(pascal(part)) and pascal(field.name) in name
            found.add(name)
    return found


def class_docs(owner: type) -> dict[str, str]:
    """Documentation of the fields of a class of telegrams."""
    source = ast.parse(Path(sys.modules[owner.__module__].__file__ or "").read_text(encoding="utf-8"))
    (body,) = [node.body for node in source.body if isinstance(node, ast.ClassDef) and node.name == owner.__name__]
    return {
        node.target.id: " ".join(str(after.value.value).split())
        for node, after in pairwise(body)
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name)
        and isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
    }  # fmt: skip


def mistaken(telegram: Any, layout: Layout, other: Layout) -> bool:
    """Whether the class, which checks no constant, reads the other telegram, which begins with one."""
    if layout.protocol != other.protocol or other.fields[0].constant is None:
        return False
    size = sum(field.length for field in other.fields if isinstance(field.length, int))
    try:
        telegram.decode(bytes(size))
    except ValueError:
        return False
    return all(field.constant is None for field in layout.fields)


def test_telegrams_are_documented(pairs: list[tuple[Any, Device]]) -> None:
    """Each class says which telegram it is and where it is printed, each field what it is."""
    for module, device in pairs:
        for layout in device.layouts:
            telegram = telegram_classes(module)[class_name(layout)]
            page = "" if layout.cite.page is None else f" p. {layout.cite.page}"
            doc = " ".join(telegram.__doc__.split())
            assert doc.startswith(" ".join(layout.name.split()))
            assert doc.endswith(f"{layout.cite.manual}, {layout.cite.chapter}{page}.")
            assert all(erratum in doc for erratum in layout.errata)
            others = [other for other in device.layouts if mistaken(telegram, layout, other)]
            assert ("To be tried after" in doc) == bool(others)
            assert all(class_name(other) in doc for other in others)
            docs = class_docs(telegram)
            for field in layout.fields:
                doc = docs[field_name(field)]
                assert doc.startswith(" ".join(field.title.split())) and " ".join(field.description.split()) in doc


def test_twins_share_their_enums(pairs: list[tuple[Any, Device]]) -> None:
    """A selection list or bit list that is the same in both slots is one enum, named after the first slot."""
    for module, device in pairs:
        shared = 0
        for code in device.codes:
            record, first = module.code(code.number), module.code(code.twin_of)
            assert record.selection is first.selection
            assert record.flags is first.flags
            for name in filter(None, (record.selection_name, record.flags_name)):
                assert name.startswith(f"C{code.twin_of:05d}")
                assert getattr(module, name).__name__ == name
                shared += code.number != code.twin_of
        assert shared or len(device.slots) < 2


def test_code_lookups(pairs: list[tuple[Any, Device]]) -> None:
    """By number and slot, by name, by designation, by index and back."""
    for module, device in pairs:
        numbers = {(code.twin_of, code.slot): code.number for code in device.codes}
        labels = [code.name for code in device.codes if code.twin_of == code.number]
        for code in device.codes:
            assert module.code(code.number).number == code.number
            for slot in device.slots:
                expected = code.number if code.slot is None else numbers[code.twin_of, slot.name]
                assert module.code(code.number, slot.name).number == expected
                assert module.code_by_name(code.designation, slot.name).number == expected
                if labels.count(code.name) == 1:
                    assert module.code_by_name(code.name.upper(), slot.name).number == expected
            assert module.code_by_name(names.code_name(code)).number == code.number
            assert module.code(code.number).address(code.highest_subcode) == (code.index, code.highest_subcode)
            with pytest.raises(LookupError, match="no subcode"):
                module.code(code.number).address(code.highest_subcode + 1)
            if device.drive is not None:
                assert module.code_index(code.number) == code.index
                assert module.index_code(code.index) == code.number
                for slot in device.slots:
                    twin = code.number if code.slot is None else numbers[code.twin_of, slot.name]
                    for number in (code.number, code.twin_of):
                        assert module.code_index(number, slot.name) == device.drive.index_base - twin
                        assert module.code_index(number, slot.name) == module.code(number, slot.name).index
        unknown = max((code.number for code in device.codes), default=0) + 1
        with pytest.raises(LookupError, match=f"no code C{unknown:05d}"):
            module.code(unknown)
        for code in device.codes[:1]:
            with pytest.raises(LookupError, match="no slot 'X9'"):
                module.code(code.number, "X9")
        with pytest.raises(LookupError, match="no code 'nonsense'"):
            module.code_by_name("nonsense")
        if device.drive is not None:
            with pytest.raises(LookupError, match="no slot 'X9'"):
                module.code_index(1, "X9")
            for wrong in (-1, device.drive.index_base + 1):
                for function in (module.code_index, module.index_code):
                    with pytest.raises(ValueError, match=str(wrong)):
                        function(wrong)
            for slot_name in (None, *(slot.name for slot in device.slots)):
                with pytest.raises(TypeError, match="float"):
                    module.code_index(1.5, slot_name)
            with pytest.raises(TypeError, match="float"):
                module.index_code(1.5)


def test_codes_behind_an_index(pairs: list[tuple[Any, Device]]) -> None:
    """Each index and sub-index leads to the codes that the model names, and neighbours lead nowhere."""
    for module, device in pairs:
        slots = {code.number: code.slot for code in device.codes}
        for code in device.codes:
            assert str(module.codes_at(code.index)[0]) == str(code.ref)
            for subcode in code.subcodes:
                assert str(module.codes_at(code.index, subcode.number)[0]) == f"{code.ref}/{subcode.number}"
            assert module.codes_at(code.index, code.highest_subcode + 1) == ()
        for entry in device.objects:
            for sub in entry.subindexes:
                every = list(dict.fromkeys(map(str, sub.codes)))
                assert plain_refs(module.codes_at(entry.index, sub.number)) == every
                for slot in device.slots:
                    own = {str(ref) for ref in sub.codes if slots.get(ref.number) in (None, slot.name)}
                    assert set(plain_refs(module.codes_at(entry.index, sub.number, slot.name))) == own
            assert module.object_at(entry.index).name == entry.name
            with pytest.raises(LookupError, match="no sub-index 255"):
                module.object_at(entry.index).subindex(255)
        with pytest.raises(LookupError, match="no object 0xffff"):
            module.object_at(0xFFFF)


def test_error_lookups(pairs: list[tuple[Any, Device]]) -> None:
    """Every number of every run, whatever its response field, and no number beside them."""
    alternatives = 0
    for module, device in pairs:
        slots = {code.number: code.slot for code in device.codes}
        known = {(error.kind, number) for error in device.errors for number in range(error.number, error.last + 1)}
        fields = dict(device.drive.error_fields) if device.drive is not None else {}
        for error in device.errors:
            for number in range(error.number, error.last + 1):
                same = [e for e in device.errors if e.kind == error.kind and e.number <= number <= e.last]
                found = module.errors_at(number, error.kind)
                assert sorted(e.name for e in found) == sorted(e.name for e in same)
                if len(same) == 1:
                    assert module.error(number, error.kind) == found[0]
                    codes = error.adjustable_in
                    if len(codes) == error.count:
                        codes = (codes[number - error.number],)
                    alternatives += len(codes) > 1
                    ignored = sum(fields[name].mask for name in ("response", "instance") if name in fields)
                    ignored = ignored if error.kind == "device" else 0
                    for reported in (number, number | ignored):
                        assert reported in found[0]
                        assert plain_refs(found[0].codes_for(reported)) == plain_refs(codes)
                        for slot in device.slots:
                            own = [ref for ref in codes if slots[ref.number] in (None, slot.name)]
                            assert plain_refs(found[0].codes_for(reported, slot.name)) == plain_refs(own)
                    for wrong in (error.number - 1, error.last + 1, number | 1 << 32):
                        assert wrong not in found[0]
                        with pytest.raises(LookupError, match="is not of <Error"):
                            found[0].codes_for(wrong)
                    with pytest.raises(LookupError, match="no slot 'X9'"):
                        found[0].codes_for(number, "X9")
            for number in (error.number - 1, error.last + 1):
                if (error.kind, number) not in known and error.kind != "device":
                    assert module.errors_at(number, error.kind) == ()
        if "response" in fields:
            for error in device.errors:
                if error.kind == "device":
                    assert module.error(error.number | fields["response"].mask) == module.error(error.number)
        if "instance" in fields:
            for error in device.errors:
                if error.kind == "device":
                    assert module.error(error.number | fields["instance"].mask) is module.error(error.number)
        free = max((number for _, number in known), default=0) + 1
        with pytest.raises(LookupError, match=f"no device error {free:#x}") as caught:
            module.error(free)
        kinds = list(dict.fromkeys(error.kind for error in device.errors))
        assert str(caught.value).endswith(", ".join(kinds)) == ("device" not in kinds)
        for function in (module.error, module.errors_at):
            with pytest.raises(LookupError, match=f"no errors of kind 'nonsense'; there are: {', '.join(kinds)}$"):
                function(free, "nonsense")
    assert alternatives


def test_error_numbers_come_apart(pairs: list[tuple[Any, Device]]) -> None:
    """The fields of every error number, each as the model has it, and back."""
    drives = 0
    for module, device in pairs:
        if device.drive is None or not device.drive.error_fields:
            assert not hasattr(module, "error_parts")
            continue
        drives += 1
        fields = dict(device.drive.error_fields)
        numbers = [error.number for error in device.errors if error.kind == "device"]
        for number in (*numbers, 0, 0x447B000F, sum(field.mask for field in fields.values())):
            parts = module.error_parts(number)
            assert parts == {name: (number & field.mask) >> field.low for name, field in fields.items()}
            assert module.error_number(**parts) == number
        for name, field in fields.items():
            top = field.mask >> field.low
            assert module.error_number(**{name: top}) == field.mask
            with pytest.raises(ValueError, match=str(top + 1)):
                module.error_number(**{name: top + 1})
        with pytest.raises(LookupError, match="no field 'nonsense'"):
            module.error_number(nonsense=1)
        for wrong in (-1, 1 << 32):
            with pytest.raises(ValueError, match="is no error number"):
                module.error_parts(wrong)
    assert drives


def test_values_and_numbers_on_the_bus(pairs: list[tuple[Any, Device]], package: Any) -> None:
    """Value times scaling, rounded, within range and type; what lies outside is refused before it is rounded."""
    scaled = 0
    for module, device in pairs:
        for code in device.codes:
            record, scaling = module.code(code.number), code.scaling or 1
            if not code.data_type.is_number:
                for function in (record.to_wire, record.from_wire):
                    with pytest.raises(ValueError, match="holds no number"):
                        function(1)
                continue
            lowest, highest = code.data_type.lowest, code.data_type.highest
            limits = code.range or Range(Fraction(lowest, scaling), Fraction(highest, scaling))
            for bound, step in ((limits.low, -1), (limits.high, 1)):
                wire = bound * scaling
                inside = code.data_type.lowest <= wire <= code.data_type.highest and wire.denominator == 1
                if inside:
                    assert record.to_wire(bound) == wire
                    assert record.from_wire(record.to_wire(bound)) == bound
                with pytest.raises(ValueError, match=r"outside|not fit"):
                    record.to_wire(bound + step)
                if code.range is not None:
                    with pytest.raises(ValueError, match="outside"):
                        record.to_wire(bound + Fraction(step, 10 * scaling))
            for raw in (code.data_type.lowest - 1, code.data_type.highest + 1):
                with pytest.raises(ValueError, match="does not fit"):
                    record.from_wire(raw)
            if limits.low == limits.high:
                continue
            for factor in (factor for factor in (1, 10, 1000) if factor <= highest):
                finer = replace(record, scaling=factor, range=None)
                assert finer.from_wire(factor) == 1 and finer.from_wire(1) == Fraction(1, factor)
                for raw in (code.data_type.highest, code.data_type.highest // 3, 102):
                    value = finer.from_wire(min(raw, code.data_type.highest))
                    assert finer.to_wire(value) == min(raw, code.data_type.highest)
                    assert finer.to_wire(Decimal(value.numerator) / value.denominator) == finer.to_wire(value)
                for tenths, nearest in ((14, 1), (15, 2), (16, 2), (25, 3), (4, 0)):
                    value = Fraction(tenths, 10 * factor)
                    assert finer.to_wire(value) == finer.to_wire(float(value)) == nearest
                    if lowest < 0:
                        assert finer.to_wire(-value) == finer.to_wire(-float(value)) == -nearest
                with pytest.raises(ValueError, match="not fit"):
                    finer.to_wire(Fraction(10 * highest + 4, 10 * factor))
                assert finer.to_wire(Fraction(10 * highest - 4, 10 * factor)) == highest
                scaled += 1
            assert replace(record, scaling=10, range=None).to_wire(10.2) == 102
            for nothing in (float("nan"), float("inf"), Decimal("nan"), Decimal("inf")):
                with pytest.raises(ValueError, match=r"(?i)nan|inf"):
                    record.to_wire(nothing)
            for other in ("x", "1000", True, None, b"1"):
                with pytest.raises(TypeError, match=r"no number|Rational"):
                    record.to_wire(other)
            for fraction in ("1000", 1.5, Fraction(1, 2)):
                with pytest.raises(TypeError, match="integer"):
                    record.from_wire(fraction)
    for wrong in (0, 128):
        with pytest.raises(ValueError, match="no node address"):
            package.NodeRelative(0x180).at(wrong)
    assert [package.NodeRelative(0x180).at(node) for node in (1, 127)] == [0x181, 0x1FF]
    assert scaled


def test_switches(pairs: list[tuple[Any, Device]]) -> None:
    """Every fact of every group; every row and every sum of weights there and back; nothing else is accepted."""
    for module, device in pairs:
        assert list(module.SWITCHES) == [group.id for group in device.switches]
        for group in device.switches:
            record = module.SWITCHES[group.id]
            names_ = ("id", "name", "labels", "weights", "valid", "unit", "errata")
            assert [getattr(record, n) for n in names_] == [getattr(group, n) for n in names_]
            assert record.notes == remarks(group)
            assert (plain_cite(record.cite), record.origin) == (plain_cite(group.cite), group.origin.value)
            assert plain_refs(record.sets) == plain_refs(group.sets)
            assert [(str(row.value), row.positions) for row in record.rows] == [
                (r.value, r.positions) for r in group.rows
            ]
            printed = {row.positions: row.value for row in record.rows}
            for place in range(1 << len(group.labels)):
                positions = f"{place:0{len(group.labels)}b}"
                rows = [v for p, v in printed.items() if all(a in ("x", b) for a, b in zip(p, positions, strict=True))]
                total = group.sum(positions) if group.weights else 0
                valid = group.valid is not None and group.valid[0] <= total <= group.valid[1]
                if rows or valid:
                    value = record.value(positions)
                    assert value == (rows[0] if rows else total)
                    back = record.positions(value)
                    assert all(a in ("x", b) for a, b in zip(back, positions, strict=True)) or len(rows) > 1
                else:
                    with pytest.raises(LookupError, match="set nothing valid"):
                        record.value(positions)
            for wrong in ("", "2" * len(group.labels), "0" * (len(group.labels) + 1)):
                with pytest.raises(ValueError, match="are not the positions"):
                    record.value(wrong)
            for nothing in (-1, 10**6, "nonsense"):
                with pytest.raises(LookupError, match="no positions"):
                    record.positions(nothing)


def test_switches_by_their_weights(pairs: list[tuple[Any, Device]]) -> None:
    """Where no row is printed the weights alone decide, from the first valid value to the last."""
    sums = 0
    for module, device in pairs:
        for group in (group for group in device.switches if group.weights and group.valid):
            assert group.valid is not None
            record = replace(module.SWITCHES[group.id], rows=())
            for place in range(1 << len(group.labels)):
                positions = f"{place:0{len(group.labels)}b}"
                total = group.sum(positions)
                if group.valid[0] <= total <= group.valid[1]:
                    assert record.value(positions) == total and record.positions(total) == positions
                    sums += 1
                else:
                    with pytest.raises(LookupError, match="set nothing valid"):
                        record.value(positions)
                    with pytest.raises(LookupError, match="no positions"):
                        record.positions(total)
    assert sums


def test_patterns_fit_where_both_say_the_same(package: Any) -> None:
    """What one of two patterns leaves out may be anything; what both say has to be equal."""
    of = package.Pattern.of
    alike = [("flash 2", "flash 2, 1 s off"), ("blink", "blink 0.2 s"), ("on", "on green"), ("any", "flash 3")]
    alike += [("flash", "flash 2, 1 s off"), ("flash red", "flash 3"), ("on_or_flicker", "flicker")]
    unlike = [("flash 2", "flash 3, 1 s off"), ("blink 1 s", "blink 0.2 s"), ("on red", "on green"), ("on", "off")]
    unlike += [("flash", "blink"), ("on_or_flicker", "blink")]
    for pairs_, expected in ((alike, True), (unlike, False)):
        for first, second in pairs_:
            assert of(first).fits(of(second)) is of(second).fits(of(first)) is expected


def test_indicators(pairs: list[tuple[Any, Device]], package: Any) -> None:
    """Every fact of every table of LEDs; what a row shows leads to the rows that an observer could mean."""
    unknown = 0
    for module, device in pairs:
        assert list(module.INDICATORS) == [table.id for table in device.indicators]
        for table in device.indicators:
            record = module.INDICATORS[table.id]
            assert (record.id, record.name, record.errata) == (table.id, table.name, table.errata)
            assert plain_cite(record.cite) == plain_cite(table.cite)
            assert [(x.label, x.colour, x.name) for x in record.leds] == [
                (x.label, x.colour, x.name) for x in table.leds
            ]
            assert [row_facts(row) for row in record.rows] == [
                [*row_facts(row)[:-2], row.origin.value, plain_cite(row.cite)] for row in table.rows
            ]
            for row in record.rows:
                seen = {led.label: pattern for led, pattern in zip(record.leds, row.patterns, strict=True)}
                texts = {label: str(pattern) for label, pattern in seen.items()}
                for pattern in row.patterns:
                    assert package.Pattern.of(str(pattern)) == pattern
                assert row in record.states(seen) and record.states(seen) == record.states(texts)
                alike = [other for other in record.rows if all(map(package.Pattern.fits, other.patterns, row.patterns))]
                assert list(record.states(seen)) == alike
            assert record.states({}) == record.rows
            assert record.states({led.label: "flash 9" for led in record.leds}) == ()
            with pytest.raises(LookupError, match="no LED 'nonsense'"):
                record.states({"nonsense": "on"})
            for led in record.leds:
                assert record.states({led.label: f"on {led.colour}"}) == record.states({led.label: "on"})
                assert record.states({led.label: f"blink {led.colour}"}) == record.states({led.label: "blink"})
                for colour in {other.colour for table in device.indicators for other in table.leds} - {led.colour}:
                    assert record.states({led.label: f"on {colour}"}) == ()
                for light in ("blink", "flash"):
                    place = record.leds.index(led)
                    fitting = [row for row in record.rows if row.patterns[place].light in (light, "any")]
                    assert list(record.states({led.label: light})) == fitting
                    unknown += len(fitting) > 1
            for wrong in ("", "glow", "on 3", "on two", "flash 1.5", "flash two", "flash 0", "flash -1", "flash 1/2",
                          "blink 1 2", "blink 1/0 s", "blink -1 s", "blink nan s", "blink 2", "blink red green",
                          "blink 1 s, 1 s off", "on, 1 s off", "flash 1 s", "flash 2, 1/0 s off"):  # fmt: skip
                with pytest.raises(ValueError, match=f"^{wrong!r} is no pattern"):
                    record.states({record.leds[0].label: wrong})
    assert unknown


def row_facts(row: Any) -> list[Any]:
    """Facts of a row of an LED table."""
    patterns = [
        (getattr(p.light, "value", p.light), p.colour, p.period, p.flashes, p.pause) for p in row.patterns
    ]  # fmt: skip
    return [patterns, row.state, row.meaning, row.origin, plain_cite(row.cite)]


def test_tables(pairs: list[tuple[Any, Device]]) -> None:
    """Every cell of every printed table, by its place, its column and its row."""
    for module, device in pairs:
        assert list(module.TABLES) == [table.id for table in device.tables]
        for table in device.tables:
            record = module.TABLES[table.id]
            names_ = ("id", "kind", "name", "rows", "notes", "errata")
            assert [getattr(record, n) for n in names_] == [getattr(table, n) for n in names_]
            assert (plain_cite(record.cite), record.origin) == (plain_cite(table.cite), table.origin.value)
            assert [(c.id, c.name, c.unit) for c in record.columns] == [(c.id, c.name, c.unit) for c in table.columns]
            ids = [column.id for column in table.columns]
            for place, column in enumerate(ids):
                assert record.column(column) == tuple(row[place] for row in table.rows)
                for row in table.rows:
                    assert dict(zip(ids, row, strict=True)) in record.find(column, row[place])
                    assert all(found[column] == row[place] for found in record.find(column, row[place]))
            with pytest.raises(LookupError, match="no column 'nonsense'"):
                record.column("nonsense")


def best_time(action: Callable[[], object], count: int = 20000) -> float:
    """Seconds for one call, best of several runs."""
    return min(timeit.repeat(action, number=count, repeat=7)) / count


def test_lookup_speed(pairs: list[tuple[Any, Device]]) -> None:
    """A look-up that was done before costs no more than three times a function around a dict."""
    module, device = pairs[0]
    number = next(error.number for error in device.errors if error.count > 1) + 1
    error, code = module.error, module.code
    plain = {number: error(number)}
    code(device.codes[0].number)

    def alternative() -> Any:
        return around(number)

    def around(key: int) -> Any:
        return plain[key]

    assert best_time(lambda: error(number)) < 3 * best_time(alternative)
    assert best_time(lambda: code(device.codes[0].number)) < 4 * best_time(alternative)


def test_raw_values_survive(pairs: list[tuple[Any, Device]]) -> None:
    """A value outside its enum stays the number it is; no bit is lost; the type tells which of the two it is."""
    for module, device in pairs:
        for code in device.codes:
            record = module.code(code.number)
            values = {option.value for option in code.options}
            for raw in (*values, *range(300), code.data_type.highest):
                typed = record.typed(raw)
                assert typed == raw
                assert isinstance(typed, IntEnum) == (raw in values)
                assert isinstance(typed, IntFlag) == (bool(code.bits) and raw not in values)
            for sub in code.subcodes:
                for option in sub.options:
                    assert record.typed(option.value, sub.number).label == option.label
        enums: list[Any] = [value for value in (getattr(module, name) for name in module.__all__) if is_enum(value)]
        for enum in enums:
            if issubclass(enum, IntFlag):
                assert enum.of(0x1_0000_0001).labels[-1] == "bit 32"
                assert str(enum.of(5)) == "5" == f"{enum.of(5)}"
                with pytest.raises(ValueError, match="-1 is negative"):
                    enum.of(-1)
            else:
                first = next(iter(enum))
                assert str(first) == str(first.value) == f"{first}"
                assert repr(first) == f"<{enum.__name__}.{first.name}: {first.value} {first.label!r}>"


def test_representations_name_the_fact(pairs: list[tuple[Any, Device]]) -> None:
    """What a person sees at the prompt: designation, name, and what matters most of it."""
    for module, device in pairs:
        for code in device.codes:
            text = repr(module.code(code.number))
            assert code.designation in text and repr(code.name) in text and (code.slot or "") in text
            assert code.range is None or (f" {code.range.unit}" in text if code.range.unit else " ... " in text)
        for entry in device.objects:
            assert entry.designation in repr(module.object_at(entry.index))
        for error, record in zip(device.errors, module.ERRORS, strict=True):
            assert f"{error.number:#x}" in repr(record) and error.name in repr(record)


def stub_docs(distribution: Path, device: Device) -> dict[str, str]:
    """Documentation of each name in the stub of a device, as editors show it."""
    body = ast.parse((distribution / PACKAGE / f"{device.id}.pyi").read_text(encoding="utf-8")).body
    docs: dict[str, str] = {}
    for statement, after in zip(body, [*body[1:], None], strict=True):
        if isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name):
            if statement.target.id == "__all__":
                continue
            assert isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
            docs[statement.target.id] = " ".join(str(after.value.value).split())
        elif isinstance(statement, ast.ImportFrom) and (statement.module or "").endswith("_telegrams"):
            docs |= dict.fromkeys((alias.asname or "" for alias in statement.names), "documented in its own module")
        elif isinstance(statement, (ast.ClassDef, ast.FunctionDef)):
            docs[statement.name] = " ".join((ast.get_docstring(statement) or "").split())
    return docs


def test_documentation_tells_source_unit_and_errata(distribution: Path, model: Model) -> None:
    """Every constant says where its fact is printed, in which unit, and what is printed wrong."""
    for device in model.devices:
        docs = stub_docs(distribution, device)
        ledger = {erratum.id: erratum for erratum in device.errata}
        facts: list[tuple[str, str, Cite, tuple[str, ...], Range | None]] = [
            (names.code_name(code), code.name, code.cite, code.errata, code.range) for code in device.codes
        ]
        for entry in device.objects:
            facts.append((names.object_name(entry), entry.name, entry.cite, entry.errata, None))
            for sub in entry.subindexes:
                facts.append((names.subindex_name(entry, sub), sub.name, entry.cite, sub.errata, sub.range))
        for name, title, cite, errata, limits in facts:
            doc = docs[name.upper()]
            page = "" if cite.page is None else f" p. {cite.page}"
            assert doc.startswith(" ".join(title.split()))
            assert doc.endswith(f"{cite.manual}, {cite.chapter}{page}.")
            assert limits is None or limits.unit in doc
            for erratum in errata:
                assert f"Erratum {erratum}: " in doc
                used = ledger[erratum].used_text
                assert used in doc or used.isdigit()
        assert all(docs.values())
        assert set(docs) == set(stub_all(distribution, device))


def test_enums_have_the_documentation_of_their_stubs(distribution: Path, pairs: list[tuple[Any, Device]]) -> None:
    """``help`` at the prompt tells what editors show: what the list belongs to and where it is printed."""
    for module, device in pairs:
        docs = stub_docs(distribution, device)
        for name in filter(lambda name: is_enum(getattr(module, name)), module.__all__):
            assert getattr(module, name).__doc__ == docs[name]
        for code, record in zip(device.codes, module.CODES, strict=True):
            for enum in (record.selection, record.flags):
                assert enum is None or (f"(C{code.twin_of:05d})" in enum.__doc__ and code.name in enum.__doc__)


def stub_all(distribution: Path, device: Device) -> list[str]:
    """``__all__`` of the stub."""
    tree = ast.parse((distribution / PACKAGE / f"{device.id}.pyi").read_text(encoding="utf-8"))
    (value,) = [
        statement.value
        for statement in tree.body
        if isinstance(statement, ast.AnnAssign) and ast.unparse(statement.target) == "__all__" and statement.value
    ]
    return list(ast.literal_eval(value))


def test_an_index_erratum_says_both_figures(distribution: Path, model: Model) -> None:
    """Where an index is printed wrong, the documentation has the printed and the used figure."""
    seen = 0
    for device in model.devices:
        docs = stub_docs(distribution, device)
        for code in device.codes:
            for erratum in (e for e in device.errata if e.id in code.errata and e.kind == "index"):
                values = {"code": code.number, "index": code.index, "number": code.number}
                printed = erratum.printed(values) if erratum.printed is not None else None
                if isinstance(printed, int):
                    doc = docs[names.code_name(code).upper()]
                    assert f"prints {printed} = 0x{printed:04X}" in doc
                    assert f"used is {code.index} = 0x{code.index:04X}" in doc
                    seen += 1
    assert seen


# Types: what checkers and editors see is what runs.


def test_stubs_match_the_modules(distribution: Path, tmp_path: Path) -> None:
    """Names, values and signatures in the stubs are those at run time, in both directions."""
    done = run(sys.executable, "-m", "mypy.stubtest", PACKAGE, cwd=tmp_path, path=distribution)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture(scope="module")
def programs(distribution: Path, model: Model, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A consumer that says which types it expects, of enums and records built at run time too, and one of mistakes."""
    device = next(d for d in model.devices if any(c.options and not c.subcodes for c in d.codes))
    code = next(c for c in device.codes if c.options and not c.subcodes)
    flags = next(c for c in device.codes if c.bits)
    enum = f"d.{enum_name(device, code.number, distribution, 'selection_name')}"
    flag = f"d.{enum_name(device, flags.number, distribution, 'flags_name')}"
    member = safe(names.option_names(code.options)[0], "python").upper()
    consumer = f"""
        from typing_extensions import Literal, assert_type
        from {PACKAGE} import COB_IDS, Code, CodeRef, Device, Error, Flags, Selection, {device.id} as d

        code = d.code(d.{names.code_name(code).upper()}, slot=None)
        assert_type(code, Code)
        assert_type(code.index, int)
        assert_type(d.DEVICE, Device)
        assert_type(d.ERRORS[0], Error)
        assert_type(d.error(d.ERRORS[0].number, {device.errors[0].kind!r}).codes_for(1, slot=None), tuple[CodeRef, ...])
        assert_type(COB_IDS["SYNC"].at(1), int)
        assert_type({enum}.{member}, Literal[{enum}.{member}])
        assert_type({enum}({code.options[0].value}).label, str)
        assert_type({flag}.of(3), {flag})
        assert_type({flag}.of(3) | {flag}.of(4), {flag})
        selection: type[Selection] = {enum}
        bits: type[Flags] = {flag}
        number: int = {enum}.of(1)
        for entry in {enum}:
            assert_type(entry, {enum})
            value: int = entry.value
        constant: Literal[{code.number}] = d.{names.code_name(code).upper()}
        if code.range is not None:
            inside: bool = 5 in code.range
        assert_type([c.name for c in d.CODES], list[str])
    """
    mistakes = f"""
        from {PACKAGE} import {device.id} as d
        d.code("C00001")
        d.code(1).number = 2
        d.code(1).nonsense
        d.NONSENSE
        {enum}.NONSENSE
        text: str = {enum}.of(1)
        d.error(1, "nonsense")
    """
    folder = tmp_path_factory.mktemp("programs")
    (folder / "consumer.py").write_text(textwrap.dedent(consumer), encoding="utf-8")
    (folder / "mistakes.py").write_text(textwrap.dedent(mistakes), encoding="utf-8")
    return folder


def test_mypy(distribution: Path, programs: Path, tmp_path: Path) -> None:
    """The package passes ``mypy --strict``; a consumer gets precise types, and its mistakes are found."""
    mypy = (sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path / "cache")
    done = run(*mypy, "-p", PACKAGE, "-m", "consumer", cwd=programs, path=distribution)
    assert done.returncode == 0, done.stdout + done.stderr
    done = run(*mypy, "mistakes.py", cwd=programs, path=distribution)
    codes = [line.rsplit("[", 1)[1].rstrip("]") for line in done.stdout.splitlines() if ": error:" in line]
    assert codes == ["arg-type", "misc", "attr-defined", "attr-defined", "attr-defined", "assignment",
                     "arg-type"], done.stdout  # fmt: skip


def test_pyright(distribution: Path, programs: Path, tmp_path: Path) -> None:
    """The same in the strict mode of pyright, which is what editors complete names with."""
    shutil.copytree(distribution / PACKAGE, tmp_path / PACKAGE)
    for program in programs.iterdir():
        shutil.copy(program, tmp_path)

    def check(*names: str) -> list[str]:
        settings = {"include": names, "typeCheckingMode": "strict", "pythonVersion": VERSIONS[0]}
        (tmp_path / "pyrightconfig.json").write_text(json.dumps(settings), encoding="utf-8")
        done = run(sys.executable, "-m", "pyright", "--outputjson", "--pythonpath", sys.executable, cwd=tmp_path)
        found = json.loads(done.stdout)
        assert found["summary"]["filesAnalyzed"] >= len(names), done.stderr
        return [f"{entry['rule']}: {entry['message']}" for entry in found["generalDiagnostics"]]

    assert check(PACKAGE, "consumer.py") == []
    rules = [message.split(":")[0] for message in check("mistakes.py")]
    wanted = ["reportArgumentType", "reportAttributeAccessIssue", "reportAttributeAccessIssue"]
    assert [rule for rule in rules if rule in {*wanted, "reportAssignmentType"}] == [
        *wanted,
        "reportAttributeAccessIssue",
        "reportAttributeAccessIssue",
        "reportAssignmentType",
        "reportArgumentType",
    ]


def enum_name(device: Device, number: int, distribution: Path, key: str) -> str:
    """Name of an enum of a code."""
    code = f"from {PACKAGE} import {device.id} as d\nprint(d.code({number}).{key})"
    return script(path=distribution, code=code).strip()


# Packaging: what users do with it.


def smoke(device: Device) -> str:
    """A script that uses everything of a device once and prints how much there was."""
    return f"""
        import copy, pickle
        import {PACKAGE}
        from {PACKAGE} import {device.id} as d
        values = [getattr(d, name) for name in d.__all__]
        for value in (d.DEVICE, *d.CODES, *d.OBJECTS, *d.ERRORS, *d.ERRATA.values()):
            assert pickle.loads(pickle.dumps(value)) == value == copy.deepcopy(value)
            assert hash(copy.copy(value)) == hash(value)
        for enum in values:
            if isinstance(enum, type) and not hasattr(enum, "decode"):
                for member in getattr(enum, "__members__", {{}}).values():
                    assert pickle.loads(pickle.dumps(member)) is member
        print(len(values), len(d.CODES), len(d.OBJECTS), len(d.ERRORS), len({PACKAGE}.__all__))
    """


@pytest.mark.parametrize("version", VERSIONS)
def test_every_python_version(version: str, distribution: Path, model: Model) -> None:
    """Runs without a warning under the version."""
    device = model.devices[0]
    python = shutil.which(f"python{version}") or ""
    if not python or run(python, "--version").returncode != 0:
        pytest.skip(f"left out: no Python {version} on this machine")
    assert script(python=python, path=distribution, code=smoke(device)) == script(path=distribution, code=smoke(device))


@pytest.mark.parametrize("version", VERSIONS)
def test_syntax_of_every_python_version(version: str, distribution: Path) -> None:
    """Reads as the syntax of the version, as far as this Python knows it."""
    feature = (3, min(int(version.split(".")[1]), sys.version_info[1]))
    sources = sorted((distribution / PACKAGE).glob("*.py*"))
    assert sources
    for source in sources:
        ast.parse(source.read_text(encoding="utf-8"), feature_version=feature)


@pytest.fixture(scope="module")
def wheel(distribution: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, built without network."""
    folder = tmp_path_factory.mktemp("wheel")
    shutil.copytree(distribution, folder / "source")
    pip = (sys.executable, "-m", "pip", "--disable-pip-version-check")
    build = ("wheel", "--no-deps", "--no-index", "--no-build-isolation", "--wheel-dir", folder, folder / "source")
    done = run(*pip, *build)
    assert done.returncode == 0, done.stdout + done.stderr
    (path,) = folder.glob("*.whl")
    return path


def test_wheel_holds_every_file(wheel: Path, distribution: Path, model: Model) -> None:
    """Modules, stubs and the mark of a typed package; version and Python version as declared."""
    with zipfile.ZipFile(wheel) as archive:
        entries = set(archive.namelist())
        metadata = archive.read(next(name for name in entries if name.endswith("METADATA"))).decode()
    files = {f"{PACKAGE}/{path.name}" for path in (distribution / PACKAGE).iterdir() if path.is_file()}
    assert {entry for entry in entries if entry.startswith(f"{PACKAGE}/")} == files
    assert {f"{PACKAGE}/py.typed", *(f"{PACKAGE}/{device.id}.pyi" for device in model.devices)} <= files
    assert wheel.name == f"drivespec_devices-{model.version}-py3-none-any.whl"
    assert f"\nVersion: {model.version}\n" in metadata and "\nRequires-Python: >=3.9\n" in metadata
    assert "Requires-Dist" not in metadata
    assert any(entry.endswith(".dist-info/licenses/LICENSE") for entry in entries)


def test_installed_wheel_works(wheel: Path, distribution: Path, model: Model, tmp_path: Path) -> None:
    """Installed into an empty folder, and imported from the wheel itself as a zip file."""
    pip = (sys.executable, "-m", "pip", "--disable-pip-version-check", "install", "--quiet")
    done = run(*pip, "--no-deps", "--no-index", "--target", tmp_path / "site", wheel)
    assert done.returncode == 0, done.stdout + done.stderr
    device = model.devices[0]
    expected = script(path=distribution, code=smoke(device))
    for place in (tmp_path / "site", wheel):
        assert script(path=place, code=smoke(device), flags=("-S",)) == expected
        where = script(path=place, code=f"import {PACKAGE}\nprint({PACKAGE}.__file__)", flags=("-S",))
        assert where.startswith(str(place))


def test_consumer(wheel: Path, root: Path, tmp_path: Path) -> None:
    """A program of somebody else: installed, checked by mypy and run, it says what it has to."""
    pip = (sys.executable, "-m", "pip", "--disable-pip-version-check", "install", "--quiet")
    done = run(*pip, "--no-deps", "--no-index", "--target", tmp_path / "site", wheel)
    assert done.returncode == 0, done.stdout + done.stderr
    folder = shutil.copytree(root / "tests" / "consumers" / "python", tmp_path / "consumer")
    mypy = (sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path / "cache", "busmonitor")
    done = run(*mypy, cwd=folder, path=tmp_path / "site")
    assert done.returncode == 0, done.stdout + done.stderr
    program = [sys.executable, "-W", "error", "-S", "busmonitor"]
    with (folder / "log.txt").open(encoding="utf-8") as log:
        environment = {"PYTHONPATH": str(tmp_path / "site"), "PYTHONIOENCODING": "utf-8"}
        said = subprocess.run(program, cwd=folder, stdin=log, capture_output=True, encoding="utf-8", env=environment)
    assert said.returncode == 0, said.stderr
    assert said.stdout == (folder / "expected.txt").read_text(encoding="utf-8")


# Cost.


def test_importing_a_device_imports_nothing_else(distribution: Path, model: Model) -> None:
    """Neither other devices nor any module of the standard library."""
    for device in model.devices:
        code = f"""
            import sys
            before = set(sys.modules)
            from {PACKAGE} import {device.id}
            print(sorted(set(sys.modules) - before))
        """
        loaded = script(path=distribution, code=code, flags=("-S",))
        assert loaded.strip() == str([PACKAGE, f"{PACKAGE}.{device.id}"])


def test_import_time(distribution: Path, model: Model, tmp_path: Path) -> None:
    """Median over fresh interpreters: at most 3 ms above an empty module, and far less than the enums would cost."""
    device = model.devices[0].id
    site = tmp_path / "site"
    shutil.copytree(distribution / PACKAGE, site / PACKAGE)
    (site / "empty.py").write_text("", encoding="utf-8")
    code = f"""
        import sys, time
        sys.path.insert(0, {str(site)!r})
        import {PACKAGE}
        start = time.perf_counter()
        import empty
        middle = time.perf_counter()
        from {PACKAGE} import {device} as d
        end = time.perf_counter()
        enums = [value for value in (getattr(d, name) for name in d.__all__) if isinstance(value, type)]
        print(middle - start, end - middle, time.perf_counter() - end)
    """
    (tmp_path / "probe.py").write_text(textwrap.dedent(code), encoding="utf-8")
    command = [sys.executable, "-I", str(tmp_path / "probe.py")]
    probes = [subprocess.run(command, capture_output=True, text=True, check=True).stdout.split() for _ in range(10)][1:]
    empty, cost, everything = (statistics.median(float(probe[i]) for probe in probes) for i in range(3))
    assert cost - empty <= 0.003
    assert cost <= 30 * empty
    assert cost * 5 <= everything, "building everything ought to cost far more, or laziness is for nothing"


def test_readme(package: Any, distribution: Path) -> None:
    """The session in the README runs as shown."""
    failed, tried = doctest.testfile(str(distribution / "README.md"), module_relative=False)
    assert tried >= 5 and failed == 0


# Devices unlike the real ones.


def odd_device(base: Device) -> Device:
    """A device with everything that the real ones lack: fractions, negative values, texts, differing twins."""
    where, cite = base.where, Cite(base.manual.id, "1", None)
    first = next(code for code in base.codes if code.slot is not None and code.twin_of == code.number)
    current = Range(Fraction(1, 10), Fraction(5, 2), "A")
    plain = replace(
        first,
        slot=None,
        options=(),
        bits=(),
        fields=(),
        subcodes=(),
        objects=(),
        range=None,
        default=None,
        errata=(),
        cite=cite,
        scaling=None,
        description='Ends in a backslash \\ and """quotes"""',
    )
    twins = [replace(first, bits=(), subcodes=(), errata=(), number=n, twin_of=1, slot=s, index=9000 - n)
             for n, s in ((1, "A"), (2, "B"))]  # fmt: skip
    texts = {1: "Byte 1 {n}", 2: "Byte 2 {n}", 4: "Byte 4", 5: "Byte 5", 6: "Last", 8: "Byte 8",
             9: "Byte 9", 10: "Byte 10", 12: "Byte 12"}  # fmt: skip
    subcodes = tuple(
        SubCode(number=n, name=name, default=n // 9, follows=None, options=(), description="", where=where)
        for n, name in texts.items()
    )
    codes = (
        replace(twins[0], options=(Option(-1, "Minus"), Option(1, "Same"), Option(2, "Same"))),
        replace(twins[1], options=(Option(-1, "Minus"), Option(3, "True"))),
        replace(plain, number=3, twin_of=3, index=8997, name="class", subcodes=subcodes, range=current),
        replace(plain, number=4, twin_of=4, index=8996, name='Text "x"', type_name="VISIBLE_STRING", length=8,
                data_type=DataType.VISIBLE_STRING, default="äöü \\ \" '", access=Access(False, False, ("cinh",))),
        replace(plain, number=5, twin_of=5, index=8995, name="Both", options=(Option(9, "Nine"),),
                bits=(Bit(0, "Low"),), fields=(BitField(4, 7, "High"),), default=-5, data_type=DataType.INTEGER16),
    )  # fmt: skip
    return replace(base, id="odd", drive=None, canopen=None, codes=codes, objects=(), errors=(), errata=(), where=where)


def written(model: Model, folder: Path) -> Path:
    """Folder with the package of the model."""
    for name, output in render(model).items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(output.data())
    return folder


def test_odd_devices(model: Model, tmp_path: Path) -> None:
    """Fractions, negative values, texts with quotes, and devices that have nothing."""
    base = model.devices[0]
    bare = replace(base, id="bare", drive=None, canopen=None, slots=(), codes=(), objects=(), errors=(), errata=())
    folder = written(replace(model, devices=(bare, odd_device(base))), tmp_path)
    code = f"""
        import json
        from fractions import Fraction
        from {PACKAGE} import DEVICES, bare, odd
        current = odd.code(3).range
        print(json.dumps({{
            "devices": list(DEVICES),
            "bare": [list(bare.CODES), list(bare.OBJECTS), list(bare.ERRORS), len(bare.ERRATA),
                     hasattr(bare, "INDEX_BASE"), list(bare.codes_at(1)), list(bare.errors_at(1)), bare.DEVICE.drive],
            "twins": [[m.name, m.value, m.label] for n in (1, 2) for m in odd.code(n).selection],
            "range": [str(current), type(current.low).__name__, Fraction(3, 2) in current, 3 in current],
            "text": [odd.code(4).default, odd.code(4).data_type.name, str(odd.code(4).access), odd.code(4).length],
            "both": [repr(odd.code(5).typed(raw)) for raw in (9, 1, -5)],
            "field": [odd.code(5).fields[0].get(0x1234), odd.code(5).fields[0].put(0x1234, 0xF)],
            "name": odd.C00003_CLASS,
            "subcodes": [[sub.number, sub.name, sub.default] for sub in odd.code(3).subcodes],
            "about": odd.code(3).description,
        }}))
    """
    found = json.loads(script(path=folder, code=code))
    assert found == {
        "devices": ["bare", "odd"],
        "bare": [[], [], [], 0, False, [], [], None],
        "twins": [["MINUS", -1, "Minus"], ["SAME_1", 1, "Same"], ["SAME_2", 2, "Same"], ["MINUS", -1, "Minus"],
                  ["TRUE", 3, "True"]],
        "range": ["1/10 ... 5/2 A", "Fraction", True, False],
        "text": ["äöü \\ \" '", "VISIBLE_STRING", ", cinh", 8],
        "both": ["<C00005Both.NINE: 9 'Nine'>", "<C00005BothFlags 0x1: Low>", "-5"],
        "field": [3, 0x12F4],
        "name": 3,
        "subcodes": [[1, "Byte 1 {n}", 0], [2, "Byte 2 {n}", 0], [4, "Byte 4", 0], [5, "Byte 5", 0], [6, "Last", 0],
                     [8, "Byte 8", 0], [9, "Byte 9", 1], [10, "Byte 10", 1], [12, "Byte 12", 1]],
        "about": 'Ends in a backslash \\ and """quotes"""',
    }  # fmt: skip
    done = run(sys.executable, "-m", "mypy.stubtest", PACKAGE, cwd=folder, path=folder)
    assert done.returncode == 0, done.stdout + done.stderr


def test_node_relative_default(model: Model, tmp_path: Path) -> None:
    """A default that follows the node address is a rule, not a number."""
    base = odd_device(model.devices[0])
    codes = (*base.codes[:2], replace(base.codes[2], default=NodeRelative(0x180)))
    folder = written(replace(model, devices=(replace(base, codes=codes),)), tmp_path)
    code = f"from {PACKAGE} import odd\nprint(odd.code(3).default, odd.code(3).default.at(5) - 0x180)"
    assert script(path=folder, code=code).split() == ["$NODEID+0x180", "5"]


def collided(device: Device, case: str) -> Device:
    """The device with two facts that would share a name."""
    elsewhere = replace(device.where, line=device.where.line + 1)
    if case == "object":
        entry: DictionaryObject = device.objects[0]
        return replace(device, objects=(entry, replace(entry, name="another", where=elsewhere)))
    if case == "error":
        error: ErrorEntry = device.errors[0]
        return replace(device, errors=(error, replace(error, where=elsewhere)))
    if case == "code":
        return replace(device, codes=(device.codes[0], replace(device.codes[0], name="another", where=elsewhere)))
    options = {
        "value": (Option(1, "One"), Option(1, "Two")),
        "member": (Option(1, "A"), Option(2, "A"), Option(3, "A 1")),
    }
    return replace(device, codes=(replace(device.codes[0], options=options[case]),))


@pytest.mark.parametrize("case", ["object", "error", "code", "value", "member"])
def test_collisions_are_refused(case: str, model: Model) -> None:
    """No fact is lost because another one has its name or number."""
    with pytest.raises(EmitError, match="would stand twice") as caught:
        render(replace(model, devices=(collided(model.devices[0], case),)))
    assert caught.value.rule == "name-collision"


def test_two_renders_are_equal(model: Model) -> None:
    """Nothing but the model decides what comes out."""
    first, second = render(model), render(model)
    assert list(first) == list(second)
    assert [output.data() for output in first.values()] == [output.data() for output in second.values()]
