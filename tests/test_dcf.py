"""The command ``dcf``: files that other readers take, settings that are checked, messages for what is wrong."""

import json
import re
import warnings
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import canopen
import dcf as lely
import pytest
from canopen.objectdictionary import ODRecord, ODVariable
from canopen_facts import NODE, Case, all_cases, spoken
from eds_utils.core.file_io.read_eds import read_eds
from hypothesis import given, settings
from hypothesis import strategies as st

from generator import mistakes
from generator.cli import main
from generator.dcf import Request, files
from generator.mistakes import MistakesError
from generator.model import Access, Code, DataType, Model, Option, Range, SubCode
from generator.readers import eds as reader

SETTINGS = {
    "C13351=125 kbps": ((24575 - 13351, 0), 2),
    "C13320/1=0x185": ((24575 - 13320, 1), 0x185),
    "C13374/2...4=7": None,
    "I-1017=100": ((0x1017, 0), 100),
    'I-1029/1=Change to "Stopped"': ((0x1029, 1), 2),
    "I-1801/1=$NODEID + 0x80000280": ((0x1801, 1), 0x80000280 + NODE),
}
"""Settings as typed, and the place and wire value that they mean; the run is three places."""


def _request(*given_settings: str, **arguments: str | None) -> Request:
    typed: dict[str, str | None] = {"device": "e94aycca", "slot": "MXI1", "product": "9400_StateLine"}
    typed |= {"node": str(NODE), "bit_rate": "250"} | arguments
    return Request(settings=given_settings, **typed)  # type: ignore[arg-type]


def _values() -> dict[tuple[int, int], int]:
    return dict(filter(None, SETTINGS.values())) | {(24575 - 13374, sub): 7 for sub in (2, 3, 4)}


@pytest.fixture(scope="module")
def made(model: Model, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Both files, by suffix."""
    folder = tmp_path_factory.mktemp("dcf")
    found = {}
    for name, output in files(model, _request(*SETTINGS)).items():
        path = folder / name
        path.write_bytes(output.data())
        found[path.suffix] = path
    assert list(found) == [".eds", ".dcf"]
    return found


@pytest.fixture(scope="module")
def case(model: Model, generated: Path) -> Case:
    """The EDS that the files come from."""
    return next(case for case in all_cases(model, generated) if case.path.name == "E94AYCCA_MXI1_9400_StateLine.eds")


# Files


def _variables(path: Path) -> dict[tuple[int, int], reader.Variable]:
    found = reader.read(path.read_bytes())
    assert found.problems == ()
    return {(v.index, v.subindex): v for entry in found.objects.values() for v in entry.variables}


def test_defaults_are_those_of_the_model_at_the_node(case: Case, made: dict[str, Path]) -> None:
    for path in made.values():
        variables = _variables(path)
        assert variables.keys() == case.facts.keys()
        assert b"$" not in path.read_bytes()
        for place, fact in case.facts.items():
            assert variables[place].default == fact.default, place


def test_only_the_settings_are_values_of_parameters(made: dict[str, Path]) -> None:
    written = {
        suffix: {place: text for place, v in _variables(path).items() if (text := v.section.get("ParameterValue"))}
        for suffix, path in made.items()
    }
    assert written[".eds"] == {}
    assert {place: reader.number(text) for place, text in written[".dcf"].items()} == _values()


def test_everything_else_is_the_eds_of_the_build(case: Case, made: dict[str, Path]) -> None:
    before = case.path.read_text(encoding="ascii").splitlines()
    for suffix, path in made.items():
        text = path.read_text(encoding="ascii")
        after = text.replace(f"{path.stem}{suffix}", case.path.name).splitlines()
        added = [line for line in after if line not in before and not re.match(r"Line\w*=", line)]
        removed = [line for line in before if line not in after and not re.match(r"Line\w*=", line)]
        assert all("$NODEID" in line for line in removed)
        kinds = {line.partition("=")[0] for line in added}
        commissioning = {"[DeviceComissioning]", "LastEDS", "ParameterValue", "NodeID", "NodeName", "Baudrate"}
        commissioning |= {"NetNumber", "NetworkName", "CANopenManager", "LSS_SerialNumber"}
        assert kinds == {"DefaultValue"} | (commissioning if suffix == ".dcf" else set())


def test_python_canopen_takes_the_configuration(case: Case, made: dict[str, Path]) -> None:
    dictionary = canopen.import_od(str(made[".dcf"]))
    assert (dictionary.node_id, dictionary.bitrate) == (NODE, 250_000)
    values = {
        (value.index, value.subindex): value.value
        for entry in dictionary.values()
        for value in ([entry] if isinstance(entry, ODVariable) else entry.values())
        if value.value is not None
    }
    assert values == _values()
    defaults = {place: fact.default for place, fact in case.facts.items()}
    plain = canopen.import_od(str(made[".eds"]))
    assert {
        (value.index, value.subindex): value.default
        for entry in plain.values()
        for value in ([entry] if isinstance(entry, ODVariable) else entry.values())
    } == defaults


def test_lely_takes_the_configuration(case: Case, made: dict[str, Path]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        device = lely.Device.from_dcf(str(made[".dcf"]), {})
        lely.Device.from_dcf(str(made[".eds"]), {})
    assert device.env["NODEID"] == NODE
    for (index, subindex), fact in case.facts.items():
        if fact.data_type == DataType.VISIBLE_STRING.canopen_number:
            continue
        value = device[index][subindex].parse_value()
        assert value == _values().get((index, subindex), fact.default or 0), (hex(index), subindex)


def test_eds_utils_finds_nothing_but_what_it_does_not_know(made: dict[str, Path]) -> None:
    assert read_eds(str(made[".eds"]))[1] == []
    dictionary, errors = read_eds(str(made[".dcf"]))
    # It knows no values of parameters, though it writes DCF files itself.
    sections = [f"{i:04X}" + (f"sub{sub:X}" if sub else "") for i, sub in sorted(_values())]
    assert sorted(errors) == sorted(f'AUTO-FIXED: Unknown entry "ParameterValue" in [{name}]' for name in sections)
    assert dictionary.device_commissioning.node_id == NODE
    assert dictionary.device_commissioning.baud_rate == 250
    assert dictionary.file_info.last_eds == made[".eds"].name


def test_comments_say_what_was_set(made: dict[str, Path]) -> None:
    text = " ".join(reader.read(made[".dcf"].read_bytes()).comments)
    assert f"For node-ID {NODE} alone" in text
    assert "The bit rate is 250 kbit/s" in text
    for setting in ("C13351 to 2", "C13320/1 to 0x00000185", "I-1017 to 100", "C13374/4 to 7"):
        assert setting in text


def test_order_of_settings_does_not_matter(model: Model, made: dict[str, Path]) -> None:
    turned = files(model, _request(*reversed(SETTINGS)))
    assert {name: output.data() for name, output in turned.items()} == {
        path.name: path.read_bytes() for path in made.values()
    }


def test_every_slot_and_product_can_be_configured(model: Model, generated: Path, tmp_path: Path) -> None:
    for found in all_cases(model, generated):
        label = "_".join(spoken(found.product.label)) if found.product else None
        assert found.device.canopen
        bit_rate = str(found.device.canopen.baud_rates[0])
        request = Request(
            device=found.device.id, slot=found.slot, product=label, node="127", bit_rate=bit_rate, settings=()
        )
        outputs = files(model, request)
        assert {Path(name).stem for name in outputs} == {f"{found.path.stem}_node127"}
        for name, output in outputs.items():
            assert reader.read(output.data()).problems == ()
            (tmp_path / name).write_bytes(output.data())
        identity = canopen.import_od(str(tmp_path / f"{found.path.stem}_node127.dcf"))[0x1018]
        assert isinstance(identity, ODRecord)
        assert identity[2].default == (found.product.value if found.product else 0)


# Mistakes


@pytest.mark.parametrize(
    ("setting", "message", "detail"),
    [
        ("C13351=7", "7 is not in the selection list of C13351", "0 (500 kbps), 1 (250 kbps)"),
        ("C13351=123 kbps", "'123 kbps' is no value of C13351", "did you mean '125 kbps'"),
        ("C13351=Reserved", "'Reserved' stands more than once in the selection list of C13351", "8, 9"),
        ("I-1029/1=3", "the value lies outside the range of I-1029/1", "0 ... 2"),
        ("I-1017=65536", "the value lies outside the range of I-1017", "0 ... 65535"),
        ("I-1017=0x1FFFF", "the value lies outside the range of I-1017", "131071"),
        ("C01121=249", "the value lies outside the range of C01121", "250 ... 20000"),
        ("I-1017=-1", "the value lies outside the range of I-1017", "-1"),
        ("I-1017=1.5", "1.5 lies between two values of I-1017", "step: 1"),
        ("I-1017=ten", "'ten' is no value of I-1017", "numbers are written"),
        ("I-1018/1=5", "I-1018/1 can only be read", "access: ro"),
        ("C13320/0=5", "C13320/0 can only be read", "access: ro"),
        ("C13345=1", "C13345 can only be read", "access: ro"),
        ("C13320=5", "C13320 has sub-indexes 0 ... 4; name one of them", "C13320/4"),
        ("C13320/5=5", "there is no C13320/5", "0, 1, 2, 3, 4"),
        ("I-1017/1=5", "there is no I-1017/1", "sub-indexes: 0"),
        ("I-1800/4=1", "the device refuses any access to I-1800/4 with abort code 0x06090011", ""),
        ("C1335=1", "E94AYCCA has no code C01335", "did you mean 'C13"),
        ("C14351=1", "C14351 is a code of slot MXI2, not of MXI1", "in slot MXI1 it is C13351"),
        ("I-1234=1", "E94AYCCA has no I-1234", "did you mean 'I-12"),
        ("P-4119=1", "'P-4119' names no single code or object", "write it like"),
        ("E-0x009d0000=1", "'E-0x009d0000' names no single code or object", "write it like"),
        ("C13311 ... C13314=1", "'C13311 ... C13314' names no single code or object", "write it like"),
        ("13351=1", "'13351' names no code or object", "write it like"),
        ("=1", "'=1' is not NAME=VALUE", "write it like"),
        ("C13351", "'C13351' is not NAME=VALUE", "write it like"),
        ("C13351=", "'C13351=' is not NAME=VALUE", "write it like"),
        ("C13350=6", "C13350 is the node address", f"--node: {NODE}"),
    ],
)
def test_wrong_settings(model: Model, setting: str, message: str, detail: str) -> None:
    with pytest.raises(MistakesError) as caught:
        files(model, _request(setting))
    (mistake,) = caught.value.mistakes
    assert (mistake.option, mistake.argument, mistake.message) == ("--set", setting, message)
    assert detail in mistakes.as_text([mistake])


@pytest.mark.parametrize("digits", ["C13350=" + "9" * 5000, "C13320/" + "9" * 5000 + "=1", "I-1017=0x" + "F" * 900])
def test_long_numbers(model: Model, digits: str) -> None:
    with pytest.raises(MistakesError):
        files(model, _request(digits))
    with pytest.raises(MistakesError):
        files(model, _request(node="9" * 5000))


_PIECES = st.sampled_from(
    ["C13351", "C13320", "I-1800", "I-1029", "/", "1", "=", " ", "...", "0x", "-", ".", "$NODEID", "+"]
)


@settings(max_examples=60, deadline=None)
@given(st.one_of(st.text(max_size=20), st.lists(_PIECES, max_size=8).map("".join)))
def test_any_setting_is_taken_or_refused(model: Model, argument: str) -> None:
    try:
        made = files(model, _request(argument))
    except MistakesError as error:
        assert mistakes.as_text(error.mistakes).endswith("\n")
    else:
        assert all(reader.read(output.data()).problems == () for output in made.values())


def test_a_setting_that_stands_twice(model: Model) -> None:
    for twice in (["I-1017=5", "I-1017/0=5"], ["C13381=5", f"I-{24575 - 13381:04X}=6"]):
        with pytest.raises(MistakesError, match="is set twice"):
            files(model, _request(*twice))


def test_the_node_address_may_be_repeated(model: Model) -> None:
    dcf = list(files(model, _request(f"C13350={NODE}")).values())[1]
    assert f"ParameterValue={NODE}\n" in dcf.text


@pytest.mark.parametrize(
    ("arguments", "message", "detail"),
    [
        ({"device": "e94ayca"}, "'e94ayca' is not among the CANopen devices", "did you mean 'e94aycca'?"),
        ({"device": "e94aycen"}, "'e94aycen' is not among the CANopen devices", "e94aycca"),
        ({"slot": "MXI3"}, "'MXI3' is not among the slots of e94aycca", "'MXI1'"),
        ({"slot": None}, "--slot is missing, as there are several slots of e94aycca", "MXI1, MXI2"),
        (
            {"device": "servo931", "slot": "MXI1", "product": None},
            "there are no slots of servo931",
            "leave --slot out",
        ),
        ({"product": "9400"}, "'9400' is not among the products of e94aycca", "9400_StateLine"),
        ({"product": None}, "--product is missing, as there are several products of e94aycca", "9400_StateLine"),
        ({"node": "0"}, "'0' is no node-ID", "1 ... 127"),
        ({"node": "128"}, "'128' is no node-ID", "1 ... 127"),
        ({"node": "five"}, "'five' is no node-ID", "1 ... 127"),
        ({"bit_rate": "333"}, "E94AYCCA has no bit rate of '333' kbit/s", "500, 800, 1000"),
    ],
)
def test_wrong_arguments(model: Model, arguments: dict[str, str | None], message: str, detail: str) -> None:
    with pytest.raises(MistakesError) as caught:
        files(model, _request(**arguments))
    (mistake,) = caught.value.mistakes
    assert mistake.message == message
    assert detail in mistakes.as_text([mistake])


def test_all_mistakes_are_shown_with_their_places(model: Model) -> None:
    with pytest.raises(MistakesError) as caught:
        files(model, _request("C13351=77", "I-1017=70000", node="200"))
    assert mistakes.as_text(caught.value.mistakes[1:]) == (
        "command line: error: 77 is not in the selection list of C13351\n"
        "      | --set C13351=77\n"
        "      |              ^^\n"
        "  list: 0 (500 kbps), 1 (250 kbps), 2 (125 kbps), 3 (50 kbps), 4 (1 Mbps), 5 (20 kbps), 6 (10 kbps), "
        "8 (Reserved), 9 (Reserved), 10 (Reserved), 11 (Reserved), 12 (Reserved), 13 (Reserved), 14 (800 kbps), "
        "15 (Reserved), 255 (Automatic detection)\n"
        "\n"
        "command line: error: the value lies outside the range of I-1017\n"
        "      | --set I-1017=70000\n"
        "      |              ^^^^^\n"
        "  value: 70000\n"
        "  range: 0 ... 65535\n"
    )


# Values of other kinds than the spec has


@pytest.fixture
def varied(model: Model) -> Model:
    """A model of one device with no slot, one product and codes to be varied."""
    device = next(device for device in model.devices if device.id == "e94aycca")
    objects = tuple(entry for entry in device.objects if entry.index in (0x1000, 0x1001))
    plain = replace(
        device.codes[0],
        slot=None,
        access=Access(read=True, write=True),
        default=None,
        default_cite=None,
        range=None,
        options=(),
        subcodes=(),
        internal=False,
        errata=(),
        printed=(),
        attributes=None,
    )

    def code(number: int, data_type: DataType, **changes: Any) -> Code:
        return replace(
            plain, number=number, index=24575 - number, name=f"Sample {number}", data_type=data_type, **changes
        )

    half = Range(Fraction(-5, 2), Fraction(5, 2), "A")
    sub = SubCode(
        number=2,
        name="",
        default=None,
        follows=None,
        options=(Option(3, "Three"),),
        description="",
        where=plain.where,
    )
    codes = (
        code(100, DataType.INTEGER16, scaling=100, range=half),
        code(101, DataType.VISIBLE_STRING, length=8),
        code(102, DataType.UNSIGNED8, internal=True),
        code(103, DataType.UNSIGNED8, access=Access(read=False, write=True)),
        code(104, DataType.DOMAIN),
        code(105, DataType.UNSIGNED8, options=(Option(1, "One"),), subcodes=(replace(sub, number=1, options=()), sub)),
        code(106, DataType.UNSIGNED8, options=(Option(1, "One"),), range=Range(Fraction(0), Fraction(9))),
    )
    return replace(
        model, devices=(replace(device, order_code="X1", slots=(), codes=codes, objects=objects, errata=()),)
    )


def _alone(model: Model, *settings: str) -> dict[str, str]:
    """ParameterValue by section."""
    request = _request(*settings, device=None, slot=None, product=None)
    (dcf,) = (output for name, output in files(model, request).items() if name == f"X1_node{NODE}.dcf")
    found = reader.read(dcf.data())
    assert found.problems == ()
    return {s.name: value for s in found.document.sections.values() if (value := s.get("ParameterValue"))}


@pytest.mark.parametrize(
    ("setting", "written"),
    [
        ("C00100=1.25", "125"),
        ("C00100=-2.5", "-250"),
        ("C00100=2", "200"),
        ("C00100=0x7D", "125"),
        ("C00101=MXI1 50%", "MXI1 50%"),
        ("C00103=5", "5"),
        ("C00105/1=one", "1"),
        ("C00105/2=Three", "3"),
        ("C00106=one", "1"),
        ("C00106=9", "9"),
    ],
)
def test_kinds_of_values(varied: Model, setting: str, written: str) -> None:
    assert list(_alone(varied, setting).values()) == [written]


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("C00100=1.255", r"1\.255 lies between two values of C00100"),
        ("C00100=2.51", "outside the range of C00100"),
        ("C00101=a;b", "a DCF cannot hold the text 'a;b'"),
        ("C00101=123456789", "the text is too long for C00101"),
        ("C00102=1", "C00102 is internal to the drive"),
        ("C00104=1", "type DOMAIN, which no DCF sets"),
        ("C00105/1=Three", "'Three' is no value of C00105/1"),
        ("C00105/2=1", "1 is not in the selection list of C00105/2"),
        ("C00106=10", "outside the range of C00106"),
    ],
)
def test_values_that_do_not_fit(varied: Model, setting: str, message: str) -> None:
    with pytest.raises(MistakesError, match=message):
        _alone(varied, setting)


def test_limits_are_shown_in_the_unit_of_the_code(varied: Model) -> None:
    with pytest.raises(MistakesError) as caught:
        _alone(varied, "C00100=3")
    assert caught.value.mistakes[0].compared == (("value", "3"), ("range", "-2.5 ... 2.5"))


# Command line


def _run(model: Model, monkeypatch: pytest.MonkeyPatch, root: Path, *arguments: str) -> int:
    monkeypatch.setattr("generator.pipeline.compile_model", lambda *_: model)
    return main(["dcf", "--spec", str(root / "spec"), "--device", "e94aycca", "--slot", "MXI1", *arguments])


def test_command_writes_two_files(
    model: Model, monkeypatch: pytest.MonkeyPatch, root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "deep" / "folder"
    arguments = [
        "--product",
        "9400_StateLine",
        "--node",
        "5",
        "--baud",
        "250",
        "--set",
        "I-1017=100",
        "--out",
        str(out),
    ]
    assert _run(model, monkeypatch, root, *arguments) == 0
    names = ["E94AYCCA_MXI1_9400_StateLine_node5.eds", "E94AYCCA_MXI1_9400_StateLine_node5.dcf"]
    assert sorted(path.name for path in out.iterdir()) == sorted(names)
    assert capsys.readouterr().out == "".join(f"{out / name}\n" for name in names)
    assert b"ParameterValue=100\r\n" in (out / names[1]).read_bytes()
    assert b"Baudrate=250\r\n" in (out / names[1]).read_bytes()


def test_command_writes_nothing_after_a_mistake(
    model: Model, monkeypatch: pytest.MonkeyPatch, root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    arguments = [
        "--product",
        "9400_StateLine",
        "--node",
        "5",
        "--baud",
        "250",
        "--set",
        "I-1017=100000",
        "--out",
        str(out),
    ]
    assert _run(model, monkeypatch, root, *arguments) == 2
    assert not out.exists()
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.endswith("  range: 0 ... 65535\n\nnothing was written\n")
    assert _run(model, monkeypatch, root, *arguments, "--format", "json") == 2
    (mistake,) = json.loads(capsys.readouterr().out)
    assert (mistake["option"], mistake["argument"], mistake["column"]) == ("--set", "I-1017=100000", 7)


def test_command_reports_a_folder_that_cannot_be_written(
    model: Model, monkeypatch: pytest.MonkeyPatch, root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("kept")
    arguments = ["--product", "9400_StateLine", "--node", "5", "--baud", "250", "--out", str(tmp_path / "file")]
    assert _run(model, monkeypatch, root, *arguments) == 1
    assert "nothing was written" in capsys.readouterr().err
    assert (tmp_path / "file").read_text() == "kept"


def test_command_reports_what_an_eds_cannot_hold(
    model: Model, monkeypatch: pytest.MonkeyPatch, root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    devices = tuple(replace(device, manufacturer="温度") for device in model.devices)
    arguments = ["--product", "9400_StateLine", "--node", "5", "--baud", "250", "--out", str(tmp_path)]
    assert _run(replace(model, devices=devices), monkeypatch, root, *arguments) == 1
    assert "error[not-ascii]" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_command_needs_a_node_and_a_bit_rate(
    model: Model, monkeypatch: pytest.MonkeyPatch, root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as caught:
        _run(model, monkeypatch, root)
    assert caught.value.code == 2
    assert "--node, --baud" in capsys.readouterr().err
