"""The GSD files: every fact against the model, by readers of others; masters of others reach data exchange."""

import json
import re
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest
from gsd_crate import Crate, CrateGsd
from profibus_slave import Station, run
from pyprofibus.gsd.interp import GsdInterp

from generator.diagnostics import Problems
from generator.emit import gsd as target
from generator.emit.base import EmitError
from generator.load import read as read_yaml
from generator.model import Device, Gsd, Model, Origin
from generator.model.gsd import Consistency, Keyword, Module, Wording
from generator.readers import gsd as reader

STATUS_BYTES = 3
NAMED_MODULES = 32
UNKNOWN_TO_PYPROFIBUS = {"FMS_supp", "Info_Text", *target.ACYCLIC} - {"DPV1_Slave"}
"""Keywords of the station that pyprofibus has no use for."""


@dataclass(frozen=True)
class Case:
    """A GSD file, and the device and language that it stands for."""

    path: Path
    device: Device
    gsd: Gsd
    language: str

    def text(self, wording: Wording | None) -> str:
        """A visible string in the language of the file."""
        return wording.text(self.language) if wording else ""

    def value(self, keyword: Keyword) -> int | str:
        """Value of a keyword in the language of the file."""
        return keyword.value if isinstance(keyword.value, int) else self.text(keyword.value)


@pytest.fixture(scope="module")
def cases(model: Model, generated: Path) -> list[Case]:
    """Every GSD file of the real spec."""
    found = [
        Case(generated / "gsd" / f"{device.gsd.stem}.{suffix}", device, device.gsd, language)
        for device in model.devices
        if device.gsd
        for suffix, language in device.gsd.suffixes
    ]
    assert found
    return found


@pytest.fixture(scope="module")
def crate(root: Path) -> Crate:
    return Crate(root)


# Bytes


def test_files_are_those_that_the_manual_names(cases: list[Case], generated: Path) -> None:
    assert {path.name for path in (generated / "gsd").iterdir()} == {case.path.name for case in cases}
    for case in cases:
        printed = next((t for t in case.device.tables if t.id == "gsd-files"), None)
        if printed:
            assert case.path.name in {row[0] for row in printed.rows}
    assert {"LENZ07A8.GSD", "LENZ07A8.GSE", "LENZ07A8.GSG"} <= {case.path.name for case in cases}


def test_bytes_are_what_every_reader_takes(cases: list[Case]) -> None:
    for case in cases:
        data = case.path.read_bytes()
        text = data.decode("ascii")
        assert data.count(b"\n") == data.count(b"\r\n") == data.count(b"\r")
        lines = text.split("\r\n")
        assert lines[-1] == ""
        assert lines.count("#Profibus_DP") == 1
        assert [line for line in lines if line.startswith("#")] == ["#Profibus_DP"]
        assert all(line.startswith(";") for line in lines[: lines.index("#Profibus_DP")])
        assert not [line for line in lines[:-1] if line != line.strip() or "\t" in line or "\\" in line or not line]
        assert max(map(len, lines)) < 255
        for literal in re.findall(r'"([^"]*)"', "\n".join(line for line in lines if not line.startswith(";"))):
            assert re.fullmatch(r"[ !#-&(-:<-?A-Z\[\]^_a-}]+", literal), literal


def test_the_head_says_where_the_file_comes_from(cases: list[Case], model: Model) -> None:
    for case in cases:
        head = case.path.read_text(encoding="ascii").partition("#Profibus_DP")[0]
        words = " ".join(head.replace(";", " ").split())
        assert words.startswith(case.path.name)
        assert f"Specification {model.version} of {model.date}." in words
        assert f"This is not a file of {case.device.manufacturer}" in words
        assert case.device.manual.id in words
        assert "Do not edit" in words


# Facts, by the reader of this project


def test_own_reader_finds_every_keyword(cases: list[Case]) -> None:
    for case in cases:
        found = reader.read(case.path.read_bytes())
        assert found.problems == ()
        rates = {f"{rate.name}_supp": 1 for rate in case.gsd.bit_rates}
        times = {f"MaxTsdr_{rate.name}": rate.max_tsdr for rate in case.gsd.bit_rates}
        expected = {keyword.name: case.value(keyword) for keyword in case.gsd.keywords} | rates | times
        number, *families = str(expected.pop("Slave_Family")).split("@")
        assert found.value("Slave_Family") == reader.Family(int(number), tuple(families))
        read = {s.name: s.value for s in found.keywords.values() if s.name != "Slave_Family"}
        assert read == expected
        assert found.user_data == reader.UserData(
            case.gsd.number("Max_User_Prm_Data_Len"), ((0, case.gsd.parameters),), ()
        )


def test_own_reader_finds_every_module(cases: list[Case]) -> None:
    for case in cases:
        found = reader.read(case.path.read_bytes())
        assert len(found.modules) == len(case.gsd.modules)
        for module, fact in zip(found.modules, case.gsd.modules, strict=True):
            assert (module.name, module.reference) == (case.text(fact.name), fact.reference)
            assert {name: s.value for name, s in module.keywords.items()} == (
                {"info_text": case.text(fact.info)} if fact.info else {}
            )
            assert fact.printed in case.text(fact.info)
            parts = [(fact.channel, True)] if fact.channel else []
            parts.append((fact.words, fact.consistency is Consistency.WHOLE))
            assert list(module.identifiers) == [
                reader.Identifier(2 * words, 2 * words, True, whole, b"") for words, whole in parts
            ]
            assert module.f_user_data == reader.UserData(None, (), ())


def test_own_reader_finds_every_text_of_the_diagnosis(cases: list[Case]) -> None:
    for case in cases:
        found = reader.read(case.path.read_bytes())
        facts = case.gsd.diagnosis
        assert facts is not None
        assert [(d.type, d.bits) for d in found.diagnosis] == [(facts.type, {})]
        assert [(a.first, a.last, a.texts) for a in found.diagnosis[0].areas] == [
            (a.first, a.last, {value: case.text(wording) for value, wording in a.texts}) for a in facts.areas
        ]


def test_texts_of_the_diagnosis_fit_the_printed_examples(cases: list[Case]) -> None:
    """Bytes of the manual's examples, taken apart as a master does: bit 0 is the lowest of the status type."""
    for case in cases:
        if case.language != "en":
            continue
        found = reader.read(case.path.read_bytes()).diagnosis[0]
        shown = {}
        for example in (e for e in case.device.examples if e.layout == "diagnosis"):
            octets = [octet or 0 for octet in example.data[7:]]
            assert octets[0] == found.type
            number = int.from_bytes(bytes(octets), "little")
            values = [(number >> a.first & (1 << a.last - a.first + 1) - 1, a.texts) for a in found.areas]
            shown[example.id] = [texts[value] for value, texts in values if value in texts]
        assert shown == {
            "diagnosis-profisafe-address": ["F address differ to F_Dest_Add"],
            "diagnosis-undervoltage": ["Module: Control", "Response: Trouble"],
        }


def test_every_error_module_and_response_has_a_text(cases: list[Case]) -> None:
    for case in cases:
        diagnosis, drive = case.gsd.diagnosis, case.device.drive
        assert diagnosis is not None and drive is not None
        areas = {area.field: dict(area.texts) for area in diagnosis.areas}
        for error in (error for error in case.device.errors if error.kind == "device"):
            assert error.number & 0xFFFF in areas["error"]
            assert error.number >> 16 & 0x3FF in areas["module"]
        for response in drive.responses:
            text = areas["response"].get(response.value)
            assert text is None if response.value == 0 else text is not None and text.english.endswith(response.name)


# Identifier bytes


def _module(words: int, channel: int = 0, consistency: Consistency = Consistency.WHOLE) -> Module:
    source: Any = None
    return Module(
        family="m",
        name=Wording("m", "m"),
        printed="m",
        info=None,
        channel=channel,
        words=words,
        consistency=consistency,
        reference=1,
        source=source,
    )


@pytest.mark.parametrize(
    ("module", "octets"),
    [
        (_module(1), "F0"),
        (_module(4), "F3"),
        (_module(8), "F7"),
        (_module(16), "FF"),
        (_module(17), "C0 D0 D0"),
        (_module(32), "C0 DF DF"),
        (_module(64), "C0 FF FF"),
        (_module(1, consistency=Consistency.WORD), "70"),
        (_module(4, consistency=Consistency.WORD), "73"),
        (_module(16, consistency=Consistency.WORD), "7F"),
        (_module(17, consistency=Consistency.WORD), "C0 50 50"),
        (_module(32, consistency=Consistency.WORD), "C0 5F 5F"),
        (_module(8, channel=4), "F3 F7"),
        (_module(32, channel=4), "F3 C0 DF DF"),
    ],
)
def test_identifier_bytes(module: Module, octets: str) -> None:
    assert target.identifiers(module) == bytes.fromhex(octets)


def test_modules_are_those_of_the_manual(cases: list[Case]) -> None:
    """Every selection text that the manual prints, with n from 1 to 32 where it has an n."""
    for case in cases:
        table = next(t for t in case.device.tables if t.id == "process-data-configurations")
        expected = {
            str(row[0]).replace("nW", f"{n}W")
            for row in table.rows
            for n in (range(1, NAMED_MODULES + 1) if "nW" in str(row[0]) else (0,))
        }
        assert {module.printed for module in case.gsd.modules} == expected
        assert len(case.gsd.modules) == len(expected) == 3 * NAMED_MODULES + 1


def test_references_stay_what_projects_know(cases: list[Case]) -> None:
    """Projects of users hold the references; a change is a breaking change."""
    for case in cases:
        runs = {"drivecom-pcd": 100, "pcd-consistent": 200, "pcd": 300}
        for module in case.gsd.modules:
            assert module.reference == (runs[module.family] + module.words if module.family in runs else 401)


# Languages


def _pieces(path: Path) -> Iterator[tuple[str, list[str]]]:
    """Each statement without its visible strings, and the strings."""
    text = path.read_text(encoding="ascii").partition("#Profibus_DP")[2]
    for line in text.splitlines():
        if not line.startswith(";"):
            yield re.sub(r'"[^"]*"', '""', line), re.findall(r'"([^"]*)"', line)


def test_languages_differ_in_visible_strings_only(cases: list[Case]) -> None:
    for gsd in dict.fromkeys(case.gsd for case in cases):
        first, *others = [case for case in cases if case.gsd is gsd]
        pieces = list(_pieces(first.path))
        for other in others:
            assert [bare for bare, _ in _pieces(other.path)] == [bare for bare, _ in pieces]
            pairs = zip(pieces, _pieces(other.path), strict=True)
            differing = {(a[0], b[0]) for (_, a), (_, b) in pairs if a != b}
            expected = set() if first.language == other.language else _translated(gsd)
            assert differing == expected
            assert bool(expected) == (first.language != other.language)


def _translated(gsd: Gsd) -> set[tuple[str, str]]:
    wordings = [keyword.value for keyword in gsd.keywords if isinstance(keyword.value, Wording)]
    wordings += [wording for module in gsd.modules for wording in (module.name, module.info) if wording]
    wordings += [wording for area in gsd.diagnosis.areas for _, wording in area.texts] if gsd.diagnosis else []
    return {(w.english, w.german) for w in wordings if w.english != w.german}


# Provenance


def test_every_line_says_where_it_comes_from(cases: list[Case]) -> None:
    for case in cases:
        lines = case.path.read_text(encoding="ascii").splitlines()
        for keyword in case.gsd.keywords:
            number = next(i for i, line in enumerate(lines) if line.startswith(f"{keyword.name}="))
            place = number
            while lines[place - 1].startswith("; ") and not lines[place - 1].startswith("; ---"):
                place -= 1
            words = " ".join(" ".join(line.strip("; ") for line in lines[place : number + 1]).split())
            source = keyword.source
            assert (source.origin is Origin.ASSUMED) == (source.cite is None)
            mark = f"{source.cite.chapter} p. {source.cite.page}" if source.cite else "assumed"
            assert mark in words, keyword.name
            assert source.note in words
            for name in source.errata:
                erratum = next(e for e in case.device.errata if e.id == name)
                assert f"Erratum {name}: printed" in words
                assert f"used {erratum.used_text}" in words


def test_assumed_is_only_what_the_manual_does_not_say(cases: list[Case]) -> None:
    """A change here belongs into the documentation: users check these keywords first."""
    for case in cases:
        assert {k.name for k in case.gsd.keywords if k.source.origin is Origin.ASSUMED} == {
            "GSD_Revision",
            "Redundancy",
            "Freeze_Mode_supp",
            "Sync_Mode_supp",
            "Fail_Safe",
            "Min_Slave_Intervall",
            "Modul_Offset",
            "C1_Response_Timeout",
            "C2_Response_Timeout",
            "C2_Max_Count_Channels",
            "Max_Initiate_PDU_Length",
        }
        assert case.gsd.max_tsdr.origin is Origin.ASSUMED


def test_nothing_is_made_up_for_functional_safety(cases: list[Case]) -> None:
    for case in cases:
        text = case.path.read_text(encoding="ascii")
        assert not re.search(r"^F_", text, re.MULTILINE | re.IGNORECASE)
        safety = [module for module in case.gsd.modules if "Safety" in module.printed]
        assert [("NOT FOR" in case.text(m.info), "NICHT FUER" in case.text(m.info)) for m in safety] == [
            (case.language == "en", case.language == "de")
        ]


# Other readers


def test_pyprofibus_finds_every_fact(cases: list[Case], capsys: pytest.CaptureFixture[str]) -> None:
    for case in cases:
        gsd = GsdInterp.fromFile(str(case.path), debug=True)
        ignored = {
            line.split("=")[0]
            for line in re.findall(r"line \d+:\n(.*)\n", capsys.readouterr().out)
            if not re.match(r"\d+$|X_|UnitDiagType|EndUnitDiagType", line)
        }
        assert ignored == UNKNOWN_TO_PYPROFIBUS & {keyword.name for keyword in case.gsd.keywords}
        for keyword in case.gsd.keywords:
            value = case.value(keyword)
            if keyword.name in ignored:
                continue
            expected = str(value).split("@") if keyword.name == "Slave_Family" else value
            assert gsd.getField(keyword.name) == expected, keyword.name
        for rate in case.gsd.bit_rates:
            assert gsd.getField(f"{rate.name}_supp") is True
            bits = float(rate.name.rstrip("M")) * (1e6 if rate.name.endswith("M") else 1e3)
            assert gsd.getMaxTSDR(round(bits)) == rate.max_tsdr
        assert gsd.getIdentNumber() == case.gsd.number("Ident_Number")
        assert (gsd.isModular(), gsd.isDPV1()) == (True, True)
        assert gsd.getUserPrmData() == case.gsd.parameters
        assert gsd.getUserPrmData(b"\xff" * STATUS_BYTES, b"\x80\x01\x02") == b"\x80\x01\x02"
        assert [(m.name, bytes(m.configBytes)) for m in gsd.getField("Module")] == [
            (case.text(module.name), target.identifiers(module)) for module in case.gsd.modules
        ]
        for module in case.gsd.modules:
            assert gsd.findModule(case.text(module.name)).name == case.text(module.name)


def test_crate_gsd_parser_finds_every_fact(cases: list[Case], crate: Crate) -> None:
    read = crate.read(case.path for case in cases)
    for case in cases:
        gsd: CrateGsd = read[case.path]
        assert gsd.error == ""
        values = {keyword.name: str(case.value(keyword)) for keyword in case.gsd.keywords}
        assert {name: values[name] for name in gsd.keywords} == gsd.keywords
        assert len(gsd.keywords) > 15
        assert gsd.rates == {rate.name: rate.max_tsdr for rate in case.gsd.bit_rates}
        assert gsd.user_parameters == case.gsd.parameters
        assert gsd.modules == [
            (m.reference, case.text(m.name), target.identifiers(m), case.text(m.info)) for m in case.gsd.modules
        ]


# Masters


def _alone(case: Case) -> list[tuple[list[Module], int]]:
    return [([module], module.length) for module in case.gsd.modules]


def _behind_safety(case: Case) -> list[tuple[list[Module], int]]:
    """Safety data in the first slot, process data in the second, as far as the lengths allow."""
    safety = next(module for module in case.gsd.modules if module.family == "safety")
    others = [module for module in case.gsd.modules if module is not safety]
    most = case.gsd.number("Max_Input_Len")
    return [([safety, m], safety.length + m.length) for m in others if safety.length + m.length <= most]


@pytest.mark.parametrize(("suffix", "choose"), [("GSD", _alone), ("GSG", _behind_safety)])
def test_pyprofibus_exchanges_data_in_every_configuration(cases: list[Case], suffix: str, choose: Any) -> None:
    case = next(case for case in cases if case.path.name == f"LENZ07A8.{suffix}")
    configurations = choose(case)
    assert len(configurations) > 90
    stations = run(case.gsd, case.path, [([case.text(m.name) for m in mods], size) for mods, size in configurations])
    for (modules, size), (station, inputs) in zip(configurations, stations, strict=True):
        title = " + ".join(module.printed for module in modules)
        assert station.ready, title
        assert station.parameters == case.gsd.parameters
        assert station.configuration == b"".join(target.identifiers(module) for module in modules)
        assert station.lengths == (size, size), title
        assert inputs is not None, title
        assert bytes(octet ^ 0xFF for octet in inputs) == station.received[0]
        assert len(inputs) == size


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("Ident_Number=0x07A8", "Ident_Number=0x07A9", "parameter_fault"),
        ('Module="PCD (32W cons)" 0xC0,0xDF,0xDF', 'Module="PCD (32W cons)" 0xC0,0xDF,0xDE', "configuration_fault"),
        ('Module="PCD (32W cons)" 0xC0,0xDF,0xDF', 'Module="PCD (32W cons)" 0xC0,0xEF,0xEF', "configuration_fault"),
    ],
)
def test_the_slave_refuses_what_is_wrong(cases: list[Case], tmp_path: Path, old: str, new: str, fault: str) -> None:
    case = cases[0]
    text = case.path.read_text(encoding="ascii")
    assert text.count(old) == 1
    file = tmp_path / "x.gsd"
    file.write_text(text.replace(old, new), encoding="ascii")
    ((station, inputs),) = run(case.gsd, file, [(["PCD (32W cons)"], 64)])
    assert getattr(station, fault) is True
    assert inputs is None
    assert station.received == []


def test_the_slave_refuses_outputs_of_another_length(cases: list[Case]) -> None:
    station = Station(cases[0].gsd, parameters=b"\0\0\0")
    station.configure(b"\xf0")
    assert station.exchange(b"\0\0") == b"\xff\xff"
    assert station.exchange(b"\0\0\0") is None


# JSON


def test_json_holds_the_same_facts(cases: list[Case], generated: Path) -> None:
    for case in cases:
        facts = json.loads((generated / "json" / f"{case.device.id}.json").read_text(encoding="utf-8"))["gsd"]
        assert f"{facts['file']}.{case.path.suffix[1:]}" == case.path.name
        assert facts["languages"][case.path.suffix[1:]] == case.language
        words = {
            k["keyword"]: k["value"][case.language] if isinstance(k["value"], dict) else k["value"]
            for k in facts["keywords"]
        }
        assert words == {keyword.name: case.value(keyword) for keyword in case.gsd.keywords}
        assert [k["origin"] for k in facts["keywords"]] == [k.source.origin.value for k in case.gsd.keywords]
        assert {r["bit_rate"]: r["max_tsdr"] for r in facts["bit_rates"]} == {
            rate.name: rate.max_tsdr for rate in case.gsd.bit_rates
        }
        assert bytes(facts["user_parameters"]["bytes"]) == case.gsd.parameters
        assert [
            (m["reference"], m["name"][case.language], m["printed"], m["channel_words"], m["words"], m["consistency"])
            for m in facts["modules"]
        ] == [
            (m.reference, case.text(m.name), m.printed, m.channel, m.words, m.consistency.value)
            for m in case.gsd.modules
        ]
        areas = case.gsd.diagnosis.areas if case.gsd.diagnosis else ()
        assert [
            (a["first_bit"], a["last_bit"], {int(v): text[case.language] for v, text in a["texts"].items()})
            for a in facts["diagnosis"]["areas"]
        ] == [(a.first, a.last, {value: case.text(wording) for value, wording in a.texts}) for a in areas]


# Rendering


def test_keywords_of_the_schema_are_those_of_the_file(root: Path) -> None:
    problems = Problems()
    schema = read_yaml(root / "spec" / "schema" / "gsd.schema.yaml", "gsd", problems)
    assert schema is not None
    properties = schema["properties"]
    written = (*target.IDENTITY, *target.CONNECTOR, *target.STATION, *target.PARAMETERS, *target.ACYCLIC)
    assert sorted(properties["keywords"]["properties"]) == sorted(written)
    assert [*properties["bit_rates"]["properties"]["rates"]["properties"]] == [r for r in reader.RATES if r != "31.25"]


def test_devices_without_gsd_have_no_file(model: Model) -> None:
    devices = tuple(replace(device, gsd=None) for device in model.devices)
    assert target.render(replace(model, devices=devices)) == {}


def test_a_small_station(model: Model, cases: list[Case]) -> None:
    """No acyclic services, no diagnosis, one language, a module without remarks."""
    gsd = cases[0].gsd
    small = replace(
        gsd,
        suffixes=(("GSD", "de"),),
        keywords=tuple(k for k in gsd.keywords if k.name not in target.ACYCLIC),
        diagnosis=None,
        modules=(replace(gsd.modules[0], channel=0, info=None),),
    )
    device = replace(cases[0].device, gsd=small)
    (output,) = target.render(replace(model, devices=(device,))).values()
    found = reader.read(output.data())
    assert found.problems == ()
    assert found.diagnosis == ()
    assert [(m.configuration, m.keywords) for m in found.modules] == [(b"\xf0", {})]
    assert "DP-V1 ---" not in output.text


def test_two_files_of_one_name_are_refused(model: Model, cases: list[Case]) -> None:
    device = cases[0].device
    twins = replace(model, devices=(device, replace(device, id="twin")))
    with pytest.raises(EmitError, match=r"two GSD files would be called 'LENZ07A8\.GSD'") as caught:
        target.render(twins)
    assert caught.value.rule == "name-collision"


def test_rendering_is_quick(model: Model) -> None:
    target.render(model)
    start = time.perf_counter()
    target.render(model)
    assert time.perf_counter() - start < 0.5
