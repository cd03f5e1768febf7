"""The EDS files: every fact against the model, the form of the bytes against what readers demand."""

import configparser
import importlib
import logging
import os
import re
import subprocess
import sys
import warnings
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import canopen
import dcf
import objdictgen
import pytest
from canopen.objectdictionary import ODArray, ODRecord, ODVariable
from canopen_facts import NODE, Case, Fact, all_cases, named, spoken
from canopen_monitor.parse.eds import load_eds_file
from eds_utils.core.file_io.read_eds import read_eds

from generator.emit import eds
from generator.emit.base import EmitError
from generator.model import (
    Access,
    Code,
    DataType,
    Device,
    DictionaryObject,
    Model,
    NodeRelative,
    Range,
    SubCode,
    SubIndex,
)
from generator.readers import eds as reader


@pytest.fixture(scope="module")
def cases(model: Model, generated: Path) -> list[Case]:
    """Every EDS of the real spec."""
    return all_cases(model, generated)


# Files


def test_there_is_a_file_for_each_slot_and_product(cases: list[Case], generated: Path) -> None:
    names = {path.name for path in (generated / "eds").iterdir()}
    assert names == {case.path.name for case in cases}
    assert {
        "E94AYCCA_MXI1_9400_StateLine.eds",
        "E94AYCCA_MXI2_9400_HighLine_ServoPLC.eds",
        "E94AYCCA_MXI2_9400_regenerative_power_supply_module.eds",
    } <= names


# Facts


def test_own_reader_finds_every_fact_of_the_model(cases: list[Case]) -> None:
    for case in cases:
        found = reader.read(case.path.read_bytes())
        assert found.problems == ()
        values = {(v.index, v.subindex): v for entry in found.objects.values() for v in entry.variables}
        facts = case.facts
        assert values.keys() == facts.keys()
        for place, fact in facts.items():
            value = values[place]
            default = value.default.at(NODE) if isinstance(value.default, reader.NodeRelative) else value.default
            assert named(value.name, fact), (place, value.name)
            read = Fact(fact.name, value.data_type, value.access, value.low, value.high, default, value.mappable)
            assert read == fact, (case.path.name, place)


def test_python_canopen_finds_every_fact_of_the_model(cases: list[Case]) -> None:
    for case in cases:
        dictionary = canopen.import_od(str(case.path), NODE)
        values = {
            (value.index, value.subindex): value
            for entry in dictionary.values()
            for value in ([entry] if isinstance(entry, ODVariable) else entry.values())
        }
        facts = case.facts
        assert values.keys() == facts.keys()
        for place, fact in facts.items():
            value = values[place]
            assert named(value.name, fact), (place, value.name)
            limits = value.min, value.max
            read = Fact(fact.name, value.data_type, value.access_type, *limits, value.default, value.pdo_mappable)
            assert read == fact, (case.path.name, place)


def test_formulas_stay_formulas(cases: list[Case]) -> None:
    for case in cases:
        found = reader.read(case.path.read_bytes())
        formulas = {
            (v.index, v.subindex): v.default.offset
            for entry in found.objects.values()
            for v in entry.variables
            if isinstance(v.default, reader.NodeRelative)
        }
        expected = {
            (entry.index, sub.number): sub.default.base
            for entry in case.device.objects
            for sub in entry.subindexes
            if isinstance(sub.default, NodeRelative) and sub.abort is None
        }
        for code in (code for code in case.device.codes_of_slot(case.slot) if not code.internal):
            for sub in code.subcodes:
                if sub.follows:
                    expected[code.index, sub.number] = sub.follows.base
        assert formulas == expected
        assert formulas


def test_structure_is_that_of_the_model(cases: list[Case]) -> None:
    kinds: dict[type, str] = {ODVariable: "VAR", ODArray: "ARRAY", ODRecord: "RECORD"}
    for case in cases:
        dictionary = canopen.import_od(str(case.path), NODE)
        expected = {entry.index: entry.object_type for entry in case.device.objects if entry.kind == "canopen"}
        names = {entry.index: entry.name for entry in case.device.objects if entry.kind == "canopen"}
        for code in (code for code in case.device.codes_of_slot(case.slot) if not code.internal):
            numbers = [sub.number for sub in code.subcodes]
            whole = numbers == list(range(1, len(numbers) + 1))
            expected[code.index] = ("ARRAY" if whole else "RECORD") if numbers else "VAR"
            names[code.index] = f"{code.designation} {code.name}"
        assert {index: kinds[type(entry)] for index, entry in dictionary.items()} == expected
        assert {index: spoken(entry.name) for index, entry in dictionary.items()} == {
            index: spoken(name) for index, name in names.items()
        }


def test_head_of_the_file(model: Model, cases: list[Case]) -> None:
    version, revision, _ = model.version.split(".")
    year, month, day = model.date.split("-")
    for case in cases:
        found = reader.read(case.path.read_bytes())
        info = found.section("FileInfo")
        assert info is not None
        assert info.get("FileName") == case.path.name
        assert (info.get("FileVersion"), info.get("FileRevision")) == (version, revision)
        assert info.get("EDSVersion") == "4.0"
        assert info.get("CreationDate") == info.get("ModificationDate") == f"{month}-{day}-{year}"
        assert info.get("CreationTime") == info.get("ModificationTime") == "12:00AM"
        assert all(info.get(key) for key in ("Description", "CreatedBy", "ModifiedBy"))

        facts = case.device.canopen
        read = canopen.import_od(str(case.path), NODE).device_information
        assert facts is not None
        assert read.allowed_baudrates == {rate * 1000 for rate in facts.baud_rates}
        assert read.vendor_name == case.device.manufacturer
        assert read.order_code == case.device.order_code
        assert bool(read.simple_boot_up_master) == facts.boot_up_master
        assert read.simple_boot_up_slave
        assert not read.LSS_supported
        assert read.nr_of_RXPDO == sum(0x1400 <= entry.index <= 0x15FF for entry in case.device.objects)
        assert read.nr_of_TXPDO == sum(0x1800 <= entry.index <= 0x19FF for entry in case.device.objects)
        device = found.section("DeviceInfo")
        assert device is not None
        # python-canopen reads the granularity as a truth value.
        assert device.get("Granularity") == str(facts.granularity)
        if case.product:
            assert read.product_name == " ".join(case.product.label.split())
            assert read.product_number == case.product.value
        identity = found.objects[0x1018].variables
        assert (read.vendor_number, read.product_number, read.revision_number) == tuple(
            variable.default for variable in identity[1:4]
        )


def test_comments_tell_where_facts_come_from_and_what_was_assumed(model: Model, cases: list[Case]) -> None:
    for case in cases:
        found = reader.read(case.path.read_bytes())
        text = " ".join(found.comments)
        manual = case.device.manual
        assert " ".join(spoken(manual.title)) in " ".join(spoken(text))
        assert manual.edition in text
        assert "Do not edit" in text
        assert f"not a file of {case.device.manufacturer}" in text
        assert model.version in text
        facts: list[Code | DictionaryObject] = [entry for entry in case.device.objects if entry.kind == "canopen"]
        facts += [code for code in case.device.codes_of_slot(case.slot) if not code.internal]
        for fact in facts:
            place = rf"{re.escape(fact.cite.manual)}, {re.escape(fact.cite.chapter)}: [^:]*\b{fact.designation}\b"
            page = "" if fact.cite.page is None else rf"[^:(]*\(p\. {fact.cite.page}\)"
            assert re.search(place + page, text), fact.designation
        for entry in case.device.objects:
            for sub in entry.subindexes:
                label = entry.designation + (f"/{sub.number}" if entry.object_type != "VAR" else "")
                if sub.abort is not None:
                    assert re.search(rf"0x{sub.abort:08X}: [^:]*\b{re.escape(label)}\b", text), label
                value = found.objects[entry.index].variable(sub.number)
                if sub.number and sub.default is None and value and value.default is not None and entry.index != 0x1018:
                    assert re.search(
                        rf"default {value.section.get('DefaultValue')} of [^:]*\b{re.escape(label)}\b", text
                    ), label


def test_comments_list_the_errata_that_change_a_figure(cases: list[Case]) -> None:
    for case in cases:
        concerned: dict[str, set[str]] = {}
        objects = [entry for entry in case.device.objects if entry.kind == "canopen"]
        codes = [code for code in case.device.codes_of_slot(case.slot) if not code.internal]
        for entry in objects:
            for name in (*entry.errata, *(name for sub in entry.subindexes for name in sub.errata)):
                concerned.setdefault(name, set()).add(entry.designation)
        for code in codes:
            for name in code.errata:
                concerned.setdefault(name, set()).add(code.designation)
        expected = {
            erratum.id: concerned[erratum.id]
            for erratum in case.device.errata
            if erratum.id in concerned and erratum.rule and erratum.kind in ("index", "standard", "value", "reference")
        }
        lines = reader.read(case.path.read_bytes()).comments
        assert len(lines) < 60
        text = " ".join(lines)
        order = sorted([*(entry.designation for entry in objects), *(code.designation for code in codes)])
        found = {
            name: _expanded(runs, order)
            for runs, name in re.findall(r"([CI][-,. CI0-9A-F]+): [^:]*? \(([a-z][-\w]+)\)\.", text)
        }
        assert found == expected


def _expanded(runs: str, order: list[str]) -> set[str]:
    names: set[str] = set()
    for part in runs.split(", "):
        first, _, last = part.partition(" ... ")
        names.update(order[order.index(first) : order.index(last or first) + 1])
    return names


# Bytes

HEAD_SECTIONS = [
    "FileInfo",
    "DeviceInfo",
    "DummyUsage",
    "Comments",
    "MandatoryObjects",
    "OptionalObjects",
    "ManufacturerObjects",
]
HEAD_KEYS = {
    "FileInfo": (
        "FileName FileVersion FileRevision EDSVersion Description CreationTime CreationDate CreatedBy "
        "ModificationTime ModificationDate ModifiedBy"
    ),
    "DeviceInfo": (
        "VendorName VendorNumber ProductName ProductNumber RevisionNumber OrderCode BaudRate_10 BaudRate_20 "
        "BaudRate_50 BaudRate_125 BaudRate_250 BaudRate_500 BaudRate_800 BaudRate_1000 SimpleBootUpMaster "
        "SimpleBootUpSlave Granularity DynamicChannelsSupported CompactPDO GroupMessaging NrOfRXPDO NrOfTXPDO "
        "LSS_Supported"
    ),
    "DummyUsage": "Dummy0001 Dummy0002 Dummy0003 Dummy0004 Dummy0005 Dummy0006 Dummy0007",
}
VALUE_KEYS = [
    "ParameterName",
    "ObjectType",
    "DataType",
    "LowLimit",
    "HighLimit",
    "AccessType",
    "DefaultValue",
    "PDOMapping",
]
FORMS = {
    "ParameterName": r"[ !$-:<>-~]{1,241}",
    "ObjectType": r"0x[789]",
    "DataType": r"0x00[0-9A-F]{2}",
    "SubNumber": r"[1-9][0-9]*",
    "LowLimit": r"0|-?[1-9][0-9]*",
    "HighLimit": r"0|-?[1-9][0-9]*",
    "AccessType": r"ro|wo|rw|rwr|rww|const",
    "DefaultValue": r"0|-?[1-9][0-9]*|0x[0-9A-F]{2,8}|\$NODEID\+0x[1-9A-F][0-9A-F]*|0x0",
    "PDOMapping": r"[01]",
}


def _blocks(path: Path) -> list[tuple[str, list[tuple[str, str]]]]:
    """Sections with their keys, split by nothing but blank lines and equals signs."""
    blocks = []
    for block in path.read_bytes().decode("ascii").removesuffix("\r\n").split("\r\n\r\n"):
        title, *lines = block.split("\r\n")
        blocks.append((title[1:-1], [(line.partition("=")[0], line.partition("=")[2]) for line in lines]))
    return blocks


def test_bytes_are_what_every_reader_takes(cases: list[Case]) -> None:
    for case in cases:
        data = case.path.read_bytes()
        assert data.isascii()
        assert data.endswith(b"\r\n")
        assert not data.endswith(b"\r\n\r\n")
        assert not data.startswith(b"\r\n")
        assert data.count(b"\r\n") == data.count(b"\n") == data.count(b"\r")
        assert b"\r\n\r\n\r\n" not in data
        lines = data.decode("ascii").split("\r\n")
        for number, line in enumerate(lines):
            assert len(line) <= 255
            assert line == line.strip()
            assert line.isprintable()
            if line.startswith("["):
                assert re.fullmatch(r"\[\w+\]", line)
                assert number == 0 or lines[number - 1] == ""
            elif line:
                assert re.fullmatch(r"\w+=[^ =;#\"][^=;#\"]*", line), line


def test_sections_and_keys_stand_in_order(cases: list[Case]) -> None:
    for case in cases:
        blocks = _blocks(case.path)
        titles = [title for title, _ in blocks]
        assert len(titles) == len(set(titles))
        assert [title for title in titles if title in HEAD_SECTIONS] == HEAD_SECTIONS
        assert titles[:5] == HEAD_SECTIONS[:5]
        for title, keys in blocks:
            names = [key for key, _ in keys]
            assert len(names) == len(set(names))
            if title in HEAD_KEYS:
                assert names == HEAD_KEYS[title].split()
            elif title == "Comments":
                assert names == ["Lines", *(f"Line{n}" for n in range(1, len(names)))]
                assert dict(keys)["Lines"] == str(len(names) - 1)
            elif title in HEAD_SECTIONS:
                assert names == ["SupportedObjects", *(str(n) for n in range(1, len(names)))]
                assert dict(keys)["SupportedObjects"] == str(len(names) - 1)
            elif "SubNumber" in names:
                assert names == ["ParameterName", "ObjectType", "SubNumber"]
            else:
                assert names == [key for key in VALUE_KEYS if key in names]
                assert set(VALUE_KEYS) - set(names) <= {"LowLimit", "HighLimit", "DefaultValue"}
                assert ("LowLimit" in names) == ("HighLimit" in names)


def test_dummies_are_bits(cases: list[Case]) -> None:
    for case in cases:
        assert {value for _, value in dict(_blocks(case.path))["DummyUsage"]} == {"0"}


def test_objects_follow_the_list_that_names_them(cases: list[Case]) -> None:
    areas = {
        "MandatoryObjects": {0x1000, 0x1001, 0x1018},
        "OptionalObjects": {*range(0x1002, 0x2000), *range(0x6000, 0x10000)} - {0x1018},
        "ManufacturerObjects": set(range(0x2000, 0x6000)),
    }
    for case in cases:
        described: dict[str, list[str]] = {}
        listed: dict[str, list[str]] = {}
        area = head = ""
        previous = -1
        for title, keys in _blocks(case.path):
            if title in areas:
                area = title
                described[area] = []
                listed[area] = [value for key, value in keys if key != "SupportedObjects"]
            elif re.fullmatch(r"[0-9A-F]{4}", title):
                described[area].append(f"0x{title}")
                head, previous = title, -1
            elif match := re.fullmatch(r"([0-9A-F]{4})sub(0|[1-9A-F][0-9A-F]?)", title):
                assert match[1] == head
                assert int(match[2], 16) > previous
                previous = int(match[2], 16)
            else:
                assert title in HEAD_SECTIONS
        assert listed == described
        for name, indexes in listed.items():
            assert indexes == sorted(indexes)
            assert {int(index, 16) for index in indexes} <= areas[name]
        assert listed["MandatoryObjects"] == ["0x1000", "0x1001", "0x1018"]


def test_values_are_written_in_the_form_that_every_reader_takes(cases: list[Case]) -> None:
    for case in cases:
        blocks = dict(_blocks(case.path))
        for title, keys in blocks.items():
            if title in HEAD_SECTIONS:
                continue
            for key, value in keys:
                assert re.fullmatch(FORMS[key], value), (title, key, value)
            name = dict(keys)["ParameterName"]
            assert not re.fullmatch(r"[+-]?(0x)?[0-9A-Fa-f_]+", name)


def test_default_mappings_fit_a_pdo(cases: list[Case]) -> None:
    seen = 0
    for case in cases:
        found = reader.read(case.path.read_bytes())
        for index in (index for index in found.objects if re.fullmatch("1[67AB]..", f"{index:04X}")):
            count, *entries = found.objects[index].variables
            assert all(re.fullmatch("0x[0-9A-F]{8}", str(entry.section.get("DefaultValue"))) for entry in entries)
            mapped = [entry.default for entry in entries if entry.default]
            assert count.default == len(mapped) <= 8
            assert [entry.default for entry in entries][: len(mapped)] == mapped
            bits = 0
            for entry in mapped:
                assert isinstance(entry, int)
                target = found.objects[entry >> 16].variable(entry >> 8 & 0xFF)
                assert target is not None
                assert target.mappable
                assert target.access in (("rw", "rww", "wo") if index < 0x1A00 else ("ro", "rw", "rwr", "const"))
                assert target.data_type is not None
                assert DataType(next(kind for kind in DataType if kind.canopen_number == target.data_type)).bits == (
                    entry & 0xFF
                )
                bits += entry & 0xFF
            assert bits <= 64
            seen += 1
    assert seen


def test_counts_and_arrays_have_no_holes(cases: list[Case]) -> None:
    for case in cases:
        blocks = dict(_blocks(case.path))
        for title, keys in blocks.items():
            head = dict(keys)
            if "SubNumber" not in head:
                continue
            subs = [int(other[7:], 16) for other in blocks if other.startswith(f"{title}sub")]
            count = dict(blocks[f"{title}sub0"])
            assert int(head["SubNumber"]) == len(subs)
            assert count["DataType"] == "0x0005"
            types = {dict(blocks[f"{title}sub{sub:X}"])["DataType"] for sub in subs if sub}
            written = "w" in count["AccessType"]
            if head["ObjectType"] == "0x8":
                assert subs == list(range(len(subs)))
                assert len(types) == 1
            if not written and not re.match("1[6A]", title):
                assert int(count["DefaultValue"], 0) == subs[-1]


def test_names_are_unique(cases: list[Case]) -> None:
    for case in cases:
        objects: list[str] = []
        subs: dict[str, list[str]] = {}
        for title, keys in _blocks(case.path):
            if re.fullmatch(r"[0-9A-F]{4}", title):
                objects.append(dict(keys)["ParameterName"])
            elif "sub" in title:
                subs.setdefault(title[:4], []).append(dict(keys)["ParameterName"])
        assert len(objects) == len(set(objects))
        assert subs
        assert all(len(names) == len(set(names)) for names in subs.values())


# Other readers


def _lint(path: Path) -> list[str]:
    """What Lely's dcfchk has to say about a file."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        config = dcf.parse_file(str(path))
        sound = dcf.lint(config)
        if sound:
            dcf.Device(config, {"NODEID": NODE})
    return [str(warning.message) for warning in caught] + ([] if sound else ["refused"])


def test_dcfgen_configures_a_master_for_the_file(cases: list[Case], tmp_path: Path) -> None:
    """Lely's dcfgen makes a master of it: it expects the identity of the file and downloads a value to the slave."""
    for case in cases:
        folder = tmp_path / case.path.stem
        folder.mkdir()
        heartbeat = (0x1017, 0) in case.facts
        sdo = "  sdo: [{index: 0x1017, sub_index: 0, value: 200}]\n" if heartbeat else ""
        slave = f"slave:\n  dcf: {case.path}\n  node_id: {NODE}\n{sdo}"
        (folder / "bus.yml").write_text(f"master:\n  node_id: 1\n{slave}")
        command = [str(part) for part in (Path(sys.executable).parent / "dcfgen", "-d", folder, folder / "bus.yml")]
        quiet = {**os.environ, "PYTHONWARNINGS": "ignore:pkg_resources"}
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False, env=quiet)
        assert (done.returncode, done.stderr) == (0, "")
        master = read_master(folder / "master.dcf")
        for index, sub in ((0x1F85, 1), (0x1F86, 2)):
            identity = case.facts[0x1018, sub].default
            if identity:
                assert master[f"{index:X}Value"][str(NODE)] == f"0x{identity:08X}"
        if heartbeat:
            assert b"\x17\x10\x00\x02\x00\x00\x00\xc8\x00" in (folder / "slave.bin").read_bytes()


def read_master(path: Path) -> configparser.ConfigParser:
    parser = configparser.ConfigParser(interpolation=None)
    parser.read(path, encoding="ascii")
    return parser


def test_other_readers_find_nothing_wrong(cases: list[Case], caplog: pytest.LogCaptureFixture) -> None:
    # Its warnings go through a logger of its own that is off by default.
    caplog.set_level(logging.WARNING)
    for case in cases:
        path = str(case.path)
        indexes = {index for index, _ in case.facts}
        assert _lint(case.path) == []
        dictionary, errors = read_eds(path)
        # An empty list is taken for a missing one.
        empty = ["AUTO-FIXED: Section [ManufacturerObjects] was missing"]
        assert errors == ([] if any(0x2000 <= index < 0x6000 for index in indexes) else empty)
        assert set(dictionary.indexes) == indexes
        assert set(objdictgen.Node.LoadFile(path).GetIndexes()) == indexes
        monitor = load_eds_file(path)
        assert {index for index in indexes if monitor[index].parameter_name} == indexes
    assert caplog.messages == []


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("DefaultValue=0x0000003B", "DefaultValue=0x10000003B"),
        ("1=0x1000", "1=0x1002"),
        ("ObjectType=0x9\r\nSubNumber=5", "ObjectType=0x9\r\nSubNumber=6"),
    ],
)
def test_other_readers_would_find_faults(cases: list[Case], tmp_path: Path, old: str, new: str) -> None:
    text = cases[0].path.read_bytes().decode("ascii")
    assert old in text
    spoilt = tmp_path / "spoilt.eds"
    spoilt.write_bytes(text.replace(old, new, 1).encode("ascii"))
    assert _lint(spoilt)


# Devices other than those of the spec


@pytest.fixture
def base(model: Model) -> Device:
    """A device to be varied: one slotless product with the mandatory objects and no code."""
    device = next(device for device in model.devices if device.canopen)
    objects = tuple(entry for entry in device.objects if entry.index in (0x1000, 0x1001, 0x1018))
    identity = objects[-1]
    subs = tuple(replace(sub, options=(), default=7) if sub.number == 2 else sub for sub in identity.subindexes)
    return replace(
        device, order_code="X1", slots=(), codes=(), objects=(*objects[:-1], replace(identity, subindexes=subs))
    )


@pytest.fixture
def code(model: Model) -> Code:
    """A code to be varied: a plain number without anything that is optional."""
    device = next(device for device in model.devices if device.canopen)
    return replace(
        device.codes[0],
        slot=None,
        name="Speed",
        number=100,
        index=0x5F9B,
        type_name="INTEGER_16",
        data_type=DataType.INTEGER16,
        access=Access(read=True, write=True),
        scaling=None,
        range=None,
        default=None,
        subcodes=(),
        internal=False,
        errata=(),
    )


def _sub(code: Code, number: int, name: str = "", default: Any = None) -> SubCode:
    return SubCode(
        number=number, name=name, default=default, follows=None, options=(), description="", where=code.where
    )


def _one(model: Model, device: Device) -> reader.Eds:
    (output,) = eds.render(replace(model, devices=(device,))).values()
    found = reader.read(output.data())
    assert found.problems == ()
    return found


def _value(model: Model, device: Device, code: Code) -> reader.Variable:
    return _one(model, replace(device, codes=(code,))).objects[code.index].variables[-1]


def test_device_without_canopen_facts_has_no_file(model: Model, base: Device) -> None:
    assert eds.render(replace(model, devices=(replace(base, canopen=None),))) == {}


def test_device_without_slots_and_products_has_one_file(model: Model, base: Device) -> None:
    outputs = eds.render(replace(model, devices=(base,)))
    assert list(outputs) == ["X1.eds"]
    found = reader.read(outputs["X1.eds"].data())
    assert found.manufacturer == ()
    assert found.objects[0x1018].variables[2].default == 7


def test_two_devices_of_one_order_code_are_refused(model: Model, base: Device) -> None:
    with pytest.raises(EmitError, match=r"two EDS files would be called 'x1\.eds'") as caught:
        eds.render(replace(model, devices=(base, replace(base, id="other", order_code="x1"))))
    assert caught.value.rule == "name-collision"


def test_device_without_identity_says_so(model: Model, base: Device) -> None:
    found = _one(model, replace(base, objects=base.objects[:2]))
    assert found.mandatory == (0x1000, 0x1001)
    assert "0 as VendorNumber, ProductNumber, RevisionNumber" in " ".join(found.comments)


def test_bit_rate_without_a_key_isnamed(model: Model, base: Device) -> None:
    assert base.canopen
    found = _one(model, replace(base, canopen=replace(base.canopen, baud_rates=(100, 125))))
    section = found.section("DeviceInfo")
    assert section is not None
    assert {rate for rate in (10, 20, 50, 125, 250, 500, 800, 1000) if section.get(f"BaudRate_{rate}") == "1"} == {125}
    assert "bit rates of 100 kbit/s" in " ".join(found.comments)


def test_internal_codes_stay_inside(model: Model, base: Device, code: Code) -> None:
    found = _one(model, replace(base, codes=(replace(code, internal=True),)))
    assert code.index not in found.objects


@pytest.mark.parametrize(
    ("limits", "scaling", "expected"),
    [
        (Range(Fraction(-10), Fraction(10)), None, (-10, 10)),
        (Range(Fraction(-1, 2), Fraction(5, 2)), 100, (-50, 250)),
        (Range(Fraction(-5, 2), Fraction(5, 2)), 1, (-2, 2)),
        (Range(Fraction(-40000), Fraction(40000)), None, (-32768, 32767)),
    ],
)
def test_limits_are_wire_values(
    model: Model, base: Device, code: Code, limits: Range, scaling: int | None, expected: tuple[int, int]
) -> None:
    value = _value(model, base, replace(code, range=limits, scaling=scaling))
    assert (value.low, value.high) == expected
    assert value.default is None


@pytest.mark.parametrize(
    ("limits", "default", "found"),
    [
        ((5, 9), None, (5, 9, 5)),
        ((-9, -5), None, (-9, -5, -5)),
        ((5, 9), 6, (5, 9, 6)),
        ((5, 9), 4, (None, None, 4)),
        ((0, 200), NodeRelative(50), (0, 200, reader.NodeRelative(50))),
        ((0, 150), NodeRelative(50), (None, None, reader.NodeRelative(50))),
    ],
)
def test_default_lies_inside_the_limits(
    model: Model, base: Device, code: Code, limits: tuple[int, int], default: Any, found: tuple[Any, Any, Any]
) -> None:
    bounded = replace(code, range=Range(Fraction(limits[0]), Fraction(limits[1])), default=default)
    value = _value(model, base, bounded)
    assert (value.low, value.high, value.default) == found
    comments = " ".join(_one(model, replace(base, codes=(bounded,))).comments)
    assert ("default " + str(value.default) + " of C00100" in comments) == (default is None)
    assert ("limits of C00100" in comments) == (found[0] is None)


def test_range_beside_the_type_is_refused(model: Model, base: Device, code: Code) -> None:
    with pytest.raises(EmitError, match="no value of INTEGER16") as caught:
        _value(model, base, replace(code, range=Range(Fraction(40000), Fraction(50000))))
    assert caught.value.rule == "object-value"


def test_text_as_default_of_a_number_is_refused(model: Model, base: Device, code: Code) -> None:
    with pytest.raises(EmitError, match="'off' is no value of the data type INTEGER16"):
        _value(model, base, replace(code, default="off"))


def test_negative_default_is_decimal(model: Model, base: Device, code: Code) -> None:
    value = _value(model, base, replace(code, default=-16))
    assert value.section.get("DefaultValue") == "-16"


def test_bit_coded_default_is_hexadecimal(model: Model, base: Device, code: Code) -> None:
    bits = replace(code, type_name="BITFIELD_16", data_type=DataType.UNSIGNED16, default=0x1A)
    assert _value(model, base, bits).section.get("DefaultValue") == "0x001A"


@pytest.mark.parametrize(("access", "expected"), [((True, False), "ro"), ((False, True), "wo"), ((True, True), "rw")])
def test_access_of_a_code(model: Model, base: Device, code: Code, access: tuple[bool, bool], expected: str) -> None:
    assert _value(model, base, replace(code, access=Access(*access))).access == expected


def test_mappable_code_has_a_default(model: Model, base: Device, code: Code) -> None:
    value = _value(model, base, replace(code, access=Access(read=True, write=False, conditions=("pdo_map_tx",))))
    assert (value.mappable, value.default) == (True, 0)


def test_strings(model: Model, base: Device, code: Code) -> None:
    text = replace(code, data_type=DataType.VISIBLE_STRING, type_name="VISIBLE_STRING")
    assert _value(model, base, text).default is None
    assert _value(model, base, replace(text, default="MXI1 50%")).default == "MXI1 50%"
    assert _value(model, base, replace(text, range=Range(Fraction(0), Fraction(9)))).low is None
    octets = replace(text, data_type=DataType.OCTET_STRING, default="AB")
    assert _value(model, base, octets).default == "4142"
    for unfit in ("a;b", ' "quoted"', "ends ", "50 µs"):
        with pytest.raises(EmitError, match="cannot hold the text"):
            _value(model, base, replace(text, default=unfit))


def test_subcodes_with_a_gap_are_a_record(model: Model, base: Device, code: Code) -> None:
    gap = replace(code, subcodes=(_sub(code, 1), _sub(code, 0x1F, "Last", 3)))
    whole = replace(code, number=101, index=0x5F9A, subcodes=(_sub(code, 1), _sub(code, 2, "Second")))
    found = _one(model, replace(base, codes=(gap, whole)))
    record, array = found.objects[gap.index], found.objects[whole.index]
    assert (record.object_type, record.sub_number, record.variables[0].default) == (0x9, 3, 0x1F)
    assert (array.object_type, array.sub_number, array.variables[0].default) == (0x8, 3, 2)
    assert [v.name for v in record.variables[1:]] == ["C00100/1 Speed", "C00100/31 Last"]
    assert record.variables[2].section.name == "5F9Bsub1F"
    assert "Assumed where none is printed: sub-index 0" in " ".join(found.comments)
    assert "sub-index 0" not in " ".join(_one(model, base).comments)


def _object(base: Device, index: int, object_type: str, *subs: SubIndex, name: str = "Sample") -> DictionaryObject:
    return replace(
        base.objects[0], index=index, name=name, object_type=object_type, standard=None, subindexes=subs, errata=()
    )


def test_standard_array_of_two_types_is_a_record(model: Model, base: Device) -> None:
    sub = base.objects[0].subindexes[0]
    mixed = _object(
        base,
        0x6000,
        "ARRAY",
        replace(sub, number=1, name="One", data_type=DataType.UNSIGNED8),
        replace(sub, number=2, name="Two", data_type=DataType.UNSIGNED16),
    )
    found = _one(model, replace(base, objects=(*base.objects, mixed)))
    assert found.optional == (0x6000,)
    entry = found.objects[0x6000]
    assert (entry.object_type, entry.variables[0].default) == (0x9, 2)


def test_object_that_only_refuses_does_not_exist(model: Model, base: Device) -> None:
    sub = base.objects[0].subindexes[0]
    refused = _object(base, 0x2000, "VAR", replace(sub, abort=0x06020000))
    assert 0x2000 not in _one(model, replace(base, objects=(*base.objects, refused))).objects


def test_object_of_another_bus_stays_out(model: Model, base: Device) -> None:
    sub = base.objects[0].subindexes[0]
    other = replace(_object(base, 0x0396, "VAR", sub), kind="profidrive")
    assert len(_one(model, replace(base, objects=(*base.objects, other))).objects) == 3


def test_index_that_two_facts_claim_is_refused(model: Model, base: Device, code: Code) -> None:
    twin = replace(code, number=200, where=base.where)
    with pytest.raises(EmitError, match="C00200 has the index 0x5F9B, as has C00100") as caught:
        eds.render(replace(model, devices=(replace(base, codes=(code, twin)),)))
    assert (caught.value.rule, caught.value.other) == ("object-index", code.where)


def test_index_outside_the_dictionary_is_refused(model: Model, base: Device, code: Code) -> None:
    with pytest.raises(EmitError, match="has the index 0x0FFF, where no object can be"):
        _value(model, base, replace(code, index=0x0FFF))


def test_equal_names_are_told_apart(model: Model, base: Device) -> None:
    sub = base.objects[0].subindexes[0]
    subs = [replace(sub, number=number, name="Entry") for number in (1, 2)]
    objects = [_object(base, index, "ARRAY", *subs) for index in (0x2000, 0x2001)]
    found = _one(model, replace(base, objects=(*base.objects, *objects)))
    assert [found.objects[index].name for index in (0x2000, 0x2001)] == ["Sample I-2000", "Sample I-2001"]
    assert [v.name for v in found.objects[0x2000].variables[1:]] == ["Entry 1", "Entry 2"]


def test_names_that_become_equal_in_ascii_are_refused(model: Model, base: Device) -> None:
    sub = base.objects[0].subindexes[0]
    first = _object(base, 0x2000, "VAR", sub, name="Time 1 µs")
    second = replace(_object(base, 0x2001, "VAR", sub, name="Time 1 us"), where=base.where)
    with pytest.raises(EmitError, match="'Time 1 us' would stand twice") as caught:
        eds.render(replace(model, devices=(replace(base, objects=(*base.objects, first, second)),)))
    assert caught.value.rule == "name-collision"


@pytest.mark.parametrize(
    ("printed", "written"),
    [
        ("Überwachung – 50 %", "Uberwachung - 50 %"),
        ('State "a"; see #5 = b', "State 'a', see no. 5 : b"),
        ("4 µs → 5 °C", "4 us -> 5 degC"),
        ("Face", "I-2000 Face"),
        ("0x12", "I-2000 0x12"),
    ],
)
def test_names_become_ascii(model: Model, base: Device, printed: str, written: str) -> None:
    entry = _object(base, 0x2000, "VAR", base.objects[0].subindexes[0], name=printed)
    assert _one(model, replace(base, objects=(*base.objects, entry))).objects[0x2000].name == written


def test_name_that_ascii_cannot_hold_is_refused(model: Model, base: Device) -> None:
    entry = _object(base, 0x2000, "VAR", base.objects[0].subindexes[0], name="温度")
    with pytest.raises(EmitError, match="has a character that an EDS cannot hold") as caught:
        eds.render(replace(model, devices=(replace(base, objects=(*base.objects, entry)),)))
    assert caught.value.rule == "not-ascii"


def test_name_that_is_too_long_is_refused(model: Model, base: Device) -> None:
    entry = _object(base, 0x2000, "VAR", base.objects[0].subindexes[0], name="x" * 242)
    with pytest.raises(EmitError, match="at most 241 characters"):
        eds.render(replace(model, devices=(replace(base, objects=(*base.objects, entry)),)))


def test_refusals_have_registered_rules() -> None:
    rules = importlib.import_module("generator.rules").RULES
    assert {"name-collision", "not-ascii", "object-index", "object-value"} <= rules.keys()
