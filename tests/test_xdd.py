"""The XDD files: valid by a schema of the standard's structure, every fact against the model and against the EDS."""

from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest
from canopen_facts import NODE, Case, Fact, all_cases
from lxml import etree

from generator.emit import xdd
from generator.emit.base import EmitError
from generator.model import DataType, Device, Model
from generator.readers import eds as reader

CO = "{http://www.canopen.org/xml/1.1}"


@pytest.fixture(scope="module")
def cases(model: Model, generated: Path) -> list[Case]:
    """Every device, slot and product of the real spec."""
    return all_cases(model, generated)


@pytest.fixture(scope="module")
def schema() -> etree.XMLSchema:
    """Structure of CiA 311, as far as the files use it."""
    return etree.XMLSchema(file=str(Path(__file__).parent / "schemas" / "xdd.xsd"))


def test_there_is_a_file_beside_every_eds(cases: list[Case], generated: Path) -> None:
    assert {path.name for path in (generated / "xdd").iterdir()} == {case.xdd.name for case in cases}


def test_files_are_valid(cases: list[Case], schema: etree.XMLSchema) -> None:
    for case in cases:
        schema.assertValid(etree.parse(str(case.xdd)))
        assert case.xdd.read_bytes().startswith(b'<?xml version="1.0" encoding="UTF-8"?>\n')
        assert b"\r" not in case.xdd.read_bytes()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("co:vendorName", "vendorName"),
        ("co:CANopenObjectList", "CANopenObjectList"),
        ("PhysicalLayer", "co:PhysicalLayer"),
        ("co:DeviceFunction", "co:DeviceManager"),
        ("co:capabilities", "capabilities"),
        ('index="1000"', 'index="100"'),
        ('index="1001"', 'index="1000"'),
        ('subIndex="01"', 'subIndex="02"'),
        ('dataType="07"', 'dataType="7"'),
        ('accessType="ro"', 'accessType="readOnly"'),
        ('PDOmapping="no"', 'PDOmapping="0"'),
        (" fileVersion=", " version="),
        ('fileCreationDate="', 'fileCreationDate="11-'),
        ('value="500 Kbps"', 'value="500"'),
        ("<ProfileClassID>Device<", "<ProfileClassID>Drive<"),
        ("<ProfileClassID>Device<", "<ProfileClassID>CommunicationNetwork<"),
        ("co:ProfileBody_Device_CANopen", "co:ProfileBody_Device"),
        ("Dummy0007=0", "Dummy0008=0"),
        (' granularity="8"', ""),
    ],
)
def test_the_schema_refuses_faults(cases: list[Case], schema: etree.XMLSchema, old: str, new: str) -> None:
    text = cases[0].xdd.read_text(encoding="utf-8")
    assert old in text
    assert schema.validate(etree.fromstring(text.encode()))
    assert not schema.validate(etree.fromstring(text.replace(old, new).encode()))


def _body(case: Case, kind: str) -> ElementTree.Element:
    root = ElementTree.parse(case.xdd).getroot()
    bodies = [
        body
        for body in root.iter("ProfileBody")
        if body.get("{http://www.w3.org/2001/XMLSchema-instance}type") == f"co:ProfileBody_{kind}_CANopen"
    ]
    assert len(bodies) == 1
    return bodies[0]


def _objects(case: Case) -> list[ElementTree.Element]:
    return _body(case, "CommunicationNetwork").findall(f"ApplicationLayers/{CO}CANopenObjectList/CANopenObject")


def _fact(name: str, found: ElementTree.Element) -> Fact:
    data_type = int(found.attrib["dataType"], 16)
    number = next(kind for kind in DataType if kind.canopen_number == data_type).bits > 0
    default: object = found.get("defaultValue")
    if number and isinstance(default, str):
        value = reader.formula(default)
        default = value.at(NODE) if isinstance(value, reader.NodeRelative) else value
    low, high = (reader.number(found.get(key, "")) for key in ("lowLimit", "highLimit"))
    mappable = {"no": False, "optional": True}[found.attrib["PDOmapping"]]
    return Fact(name, data_type, found.get("accessType"), low, high, default, mappable)


def test_every_fact_of_the_model_is_found(cases: list[Case]) -> None:
    for case in cases:
        facts = case.facts
        seen = set()
        for entry in _objects(case):
            index = int(entry.attrib["index"], 16)
            for found in list(entry) or [entry]:
                place = index, int(found.get("subIndex", "0"), 16)
                fact = facts[place]
                assert found.attrib["name"].startswith(fact.name), place
                assert _fact(fact.name, found) == fact, (case.xdd.name, place)
                seen.add(place)
        assert seen == facts.keys()


def test_it_says_what_the_eds_says(cases: list[Case]) -> None:
    for case in cases:
        eds = reader.read(case.path.read_bytes())
        entries = _objects(case)
        assert [int(entry.attrib["index"], 16) for entry in entries] == sorted(eds.objects)
        for entry in entries:
            other = eds.objects[int(entry.attrib["index"], 16)]
            assert int(entry.attrib["objectType"]) == other.object_type
            assert (int(entry.attrib["subNumber"]) if "subNumber" in entry.attrib else None) == other.sub_number
            for found, value in zip(list(entry) or [entry], other.variables, strict=True):
                assert int(found.get("subIndex", "0"), 16) == value.subindex
                for attribute, key in (("defaultValue", "DefaultValue"), ("lowLimit", "LowLimit")):
                    assert found.get(attribute) == value.section.get(key)
        lists = _body(case, "CommunicationNetwork").find(f"ApplicationLayers/{CO}CANopenObjectList")
        assert lists is not None
        assert [int(lists.attrib[f"{kind}Objects"]) for kind in ("mandatory", "optional", "manufacturer")] == [
            len(eds.mandatory),
            len(eds.optional),
            len(eds.manufacturer),
        ]


def test_head_of_the_file(model: Model, cases: list[Case]) -> None:
    for case in cases:
        device, network = _body(case, "Device"), _body(case, "CommunicationNetwork")
        for body in (device, network):
            assert body.attrib["fileName"] == case.xdd.name
            assert body.attrib["fileCreationDate"] == body.attrib["fileModificationDate"] == model.date
            assert body.attrib["fileVersion"] == model.version
        identity = device.find(f"{CO}DeviceIdentity")
        assert identity is not None
        numbers = {sub: case.facts[0x1018, sub].default for sub in (1, 2)}
        texts = {child.tag.removeprefix(CO): child.text for child in identity}
        assert texts["vendorName"] == case.device.manufacturer
        assert texts["orderNumber"] == case.device.order_code
        assert texts["productName"] == (case.product.label if case.product else case.device.title)
        assert {1: int(texts["vendorID"] or "", 16), 2: int(texts["productID"] or "", 16)} == numbers
        versions = {child.attrib["versionType"]: child.text for child in identity.findall(f"{CO}version")}
        printed = {"SW": case.device.software_version, "HW": case.device.hardware_version}
        assert versions == {kind: version for kind, version in printed.items() if version}
        facts = case.device.canopen
        assert facts is not None
        rates = [rate.attrib["value"] for rate in network.iter("supportedBaudRate")]
        assert rates == [f"{rate} Kbps" for rate in facts.baud_rates]
        (features,) = network.iter("CANopenGeneralFeatures")
        (master,) = network.iter("CANopenMasterFeatures")
        assert int(features.attrib["granularity"]) == facts.granularity
        assert int(features.attrib["nrOfRxPDO"]) == sum(0x1400 <= o.index <= 0x15FF for o in case.device.objects)
        assert int(features.attrib["nrOfTxPDO"]) == sum(0x1800 <= o.index <= 0x19FF for o in case.device.objects)
        assert master.attrib["bootUpMaster"] == str(facts.boot_up_master).lower()


def test_it_says_where_its_facts_come_from(model: Model, cases: list[Case]) -> None:
    for case in cases:
        text = " ".join(label.text or "" for label in _body(case, "Device").iter("label"))
        assert case.device.manual.title in text
        assert "Do not edit" in text
        assert f"not a file of {case.device.manufacturer}" in text
        assert model.version in text
        comment = etree.parse(str(case.xdd)).getroot().getprevious()
        assert comment is not None
        assert "Generated by drivespec" in str(comment.text)


# Devices other than those of the spec


@pytest.fixture
def base(model: Model) -> Device:
    """A device to be varied: no slot, one product and no code."""
    device = next(device for device in model.devices if device.canopen)
    objects = (
        replace(entry, subindexes=tuple(replace(sub, options=()) for sub in entry.subindexes))
        for entry in device.objects
    )
    return replace(device, order_code="X1", slots=(), codes=(), objects=tuple(objects), errata=())


def _only(model: Model, device: Device) -> str:
    (output,) = xdd.render(replace(model, devices=(device,))).values()
    return output.text


def _renamed(base: Device, name: str) -> Device:
    first, *others = base.objects
    return replace(base, objects=(replace(first, name=name), *others))


def test_names_keep_their_characters(model: Model, base: Device, schema: etree.XMLSchema) -> None:
    name = "\N{GREEK CAPITAL LETTER OMEGA} < 5 & \"x\" 'y' 温度"
    document = etree.fromstring(_only(model, _renamed(base, name)).encode())
    schema.assertValid(document)
    assert document.find(".//CANopenObject").get("name") == name


def test_a_name_that_xml_cannot_hold_is_refused(model: Model, base: Device) -> None:
    with pytest.raises(EmitError, match="an XDD cannot hold the text") as caught:
        _only(model, _renamed(base, "line\nend"))
    assert caught.value.rule == "object-value"


def test_bit_rates_that_the_format_does_not_know_are_left_out(model: Model, base: Device) -> None:
    assert base.canopen
    some = _only(model, replace(base, canopen=replace(base.canopen, baud_rates=(33, 100))))
    assert some.count("<supportedBaudRate ") == 1
    assert 'value="100 Kbps"' in some
    with pytest.raises(EmitError, match="none of the bit rates"):
        _only(model, replace(base, canopen=replace(base.canopen, baud_rates=(33,))))


def test_two_devices_of_one_order_code_are_refused(model: Model, base: Device) -> None:
    with pytest.raises(EmitError, match="two XDD files would be called"):
        xdd.render(replace(model, devices=(base, replace(base, id="other", order_code="x1"))))


def test_device_without_canopen_facts_has_no_file(model: Model, base: Device) -> None:
    assert xdd.render(replace(model, devices=(replace(base, canopen=None),))) == {}
