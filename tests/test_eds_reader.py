"""The reader of EDS files: what it makes of good and of bad text, with exact places."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from generator.readers.eds import Eds, NodeRelative, Problem, decode, formula, number, parse, read

HEAD = "[FileInfo]\nFileName=x.eds\n[DeviceInfo]\nVendorName=x\n"
"""Four lines that every file has to have; what follows begins in line 5."""
VALUE = "ParameterName=Speed\nObjectType=0x7\nDataType=0x0003\nAccessType=rw\n"
"""Four lines of a sound section."""


def _listed(*indexes: int) -> str:
    """A list of manufacturer objects; one object makes three lines."""
    lines = [f"{place}=0x{index:04X}" for place, index in enumerate(indexes, 1)]
    return "\n".join(["[ManufacturerObjects]", f"SupportedObjects={len(indexes)}", *lines, ""])


def _variable(keys: str) -> Eds:
    """A file with one value; ``keys`` begin in line 13."""
    return read(f"{HEAD}{_listed(0x2000)}[2000]\n{VALUE}{keys}")


# Lines


def test_places_count_from_one() -> None:
    document = parse("; head\r\n\r\n[FileInfo]\r\nFileName=a.eds\r\n  Key\t=  1 2 \r\nEmpty= \r\n")
    assert document.problems == ()
    section = document.section("fileinfo")
    assert section is not None
    assert (section.name, section.line, section.column) == ("FileInfo", 3, 1)
    assert [(k.name, k.value, k.line, k.column, k.value_column) for k in section.keys()] == [  # noqa: SIM118
        ("FileName", "a.eds", 4, 1, 10),
        ("Key", "1 2", 5, 3, 10),
        ("Empty", "", 6, 1, 7),
    ]
    assert section.get("filename") == "a.eds"
    assert section.get("absent") is None
    assert section.key("absent") is None


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_every_line_end_counts_once(end: str) -> None:
    document = parse(end.join(["[A]", "x=1", "", "[B]", "y=2"]))
    assert [(s.name, s.line, dict(s.values)) for s in document.sections.values()] == [
        ("A", 1, {"x": "1"}),
        ("B", 4, {"y": "2"}),
    ]


def test_comments_and_equals_signs_in_values() -> None:
    document = parse("[A]\n;x=1\n # y=2\nz=a=b;c\n[B] ; [C]\n")
    assert document.problems == ()
    assert [(s.name, dict(s.values)) for s in document.sections.values()] == [("A", {"z": "a=b;c"}), ("B", {})]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("x=1\n[A]\n", Problem(1, 1, "a key stands before the first section")),
        ("[A]\nx=1\n  X = 2\n", Problem(3, 3, "key 'X' stands twice in its section")),
        ("[A]\n[B]\n [a]\n", Problem(3, 2, "section [a] stands twice, first in line 1")),
        ("[A]\n  stray text\n", Problem(2, 3, "'stray text' is no section, key or comment")),
        ("[A]\n =1\n", Problem(2, 2, "a value has no key")),
        ("[A\nx=1\n", Problem(1, 3, "']' is missing")),
        ("[A] x\n", Problem(1, 5, "text stands after the name of a section")),
        ("\n []\n", Problem(2, 2, "a section has no name")),
    ],
)
def test_faults_of_syntax(text: str, problem: Problem) -> None:
    assert parse(text).problems == (problem,)


def test_reading_goes_on_after_a_fault() -> None:
    document = parse("[A\nx=1\nstray\ny=2\nx=3\n")
    assert dict(document.sections["a"].values) == {"x": "1", "y": "2"}
    assert [problem.line for problem in document.problems] == [1, 3, 5]


def test_of_a_repeated_section_the_first_counts() -> None:
    document = parse("[A]\nx=1\n[a]\nx=2\n")
    assert dict(document.sections["a"].values) == {"x": "1"}


@pytest.mark.parametrize(
    ("data", "text"),
    [
        (b"a", "a"),
        (b"\xef\xbb\xbfa", "a"),
        ("ä".encode(), "ä"),
        ("ä".encode("cp1252"), "ä"),
    ],
)
def test_encodings(data: bytes, text: str) -> None:
    assert decode(data) == text


# Numbers


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0", 0),
        ("10", 10),
        ("010", 8),
        ("0x10", 16),
        ("0XfF", 255),
        ("-16", -16),
        ("-0x10", -16),
        ("+5", 5),
        ("08", None),
        ("0x", None),
        ("5 ms", None),
        ("1.5", None),
        ("", None),
        ("\u0665", None),
        ("9" * 30, None),
    ],
)
def test_numbers(text: str, value: int | None) -> None:
    assert number(text) == value


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("$NODEID+0x180", NodeRelative(0x180)),
        ("$nodeid + 384", NodeRelative(384)),
        ("0x180+$NODEID", NodeRelative(0x180)),
        ("$NODEID", NodeRelative(0)),
        ("7", 7),
        ("$NODEID-1", None),
        ("$NODEID+x", None),
        ("$NODE+1", None),
    ],
)
def test_formulas(text: str, value: int | NodeRelative | None) -> None:
    assert formula(text) == value


def test_formula_at_a_node() -> None:
    assert NodeRelative(0x180).at(5) == 0x185


# Objects


def test_value() -> None:
    found = _variable("lowlimit=-5\nHighLimit=5\nDefaultValue=-1\nPDOMapping=1\n")
    assert found.problems == ()
    assert (found.mandatory, found.optional, found.manufacturer) == ((), (), (0x2000,))
    entry = found.objects[0x2000]
    value = entry.variable(0)
    assert value is not None
    assert (entry.name, entry.object_type, entry.sub_number, len(entry.variables)) == ("Speed", 7, None, 1)
    assert (value.data_type, value.access, value.low, value.high) == (3, "rw", -5, 5)
    assert (value.default, value.mappable, value.name) == (-1, True, "Speed")
    assert entry.variable(1) is None


@pytest.mark.parametrize(
    ("data_type", "text", "value"),
    [
        ("0x0003", "0xFFF0", -16),
        ("0x0003", "0x7FFF", 32767),
        ("0x0007", "$NODEID+0x80000000", NodeRelative(0x80000000)),
        ("0x0001", "1", 1),
        ("0x0008", "1.5", "1.5"),
        ("0x0009", "0x10", "0x10"),
        ("0x000F", "AB CD", "AB CD"),
        ("0x0007", "", None),
    ],
)
def test_defaults_by_type(data_type: str, text: str, value: object) -> None:
    section = f"[2000]\nParameterName=x\nDataType={data_type}\nAccessType=rw\nDefaultValue={text}\n"
    found = read(f"{HEAD}{_listed(0x2000)}{section}")
    assert found.problems == ()
    assert found.objects[0x2000].variables[0].default == value


def test_record_with_a_gap_before_its_head() -> None:
    subs = "".join(f"[2000{suffix}]\n{VALUE}" for suffix in ("sub1F", "SUB0", "sub0a"))
    found = read(f"{HEAD}{subs}[2000]\nParameterName=R\nObjectType=0x9\nSubNumber=0x3\n{_listed(0x2000)}")
    assert found.problems == ()
    assert [v.subindex for v in found.objects[0x2000].variables] == [0, 0x0A, 0x1F]


def test_structure_entry_is_not_counted() -> None:
    subs = "".join(f"[2000sub{suffix}]\n{VALUE}" for suffix in ("0", "FF"))
    found = read(f"{HEAD}{_listed(0x2000)}[2000]\nParameterName=R\nObjectType=9\nSubNumber=1\n{subs}")
    assert found.problems == ()


def test_compact_objects_stay_keys() -> None:
    section = "[2000]\nParameterName=A\nObjectType=0x8\nDataType=0x0005\nAccessType=ro\nCompactSubObj=4\n"
    found = read(f"{HEAD}{_listed(0x2000)}{section}[2000Name]\nNrOfEntries=1\n1=First\n")
    assert found.problems == ()
    assert (found.objects[0x2000].compact, found.objects[0x2000].variables) == (4, ())
    names = found.section("2000Name")
    assert names is not None
    assert names.get("1") == "First"


def test_domain_needs_no_data_type() -> None:
    found = read(f"{HEAD}{_listed(0x2000)}[2000]\nParameterName=Program\nObjectType=0x2\n")
    assert found.problems == ()
    assert found.objects[0x2000].variables[0].data_type is None


def test_comment_lines() -> None:
    found = read(f"{HEAD}[Comments]\nLines=2\nLine2=b\nLine1=a\n")
    assert (found.comments, found.problems) == (("a", "b"), ())


@pytest.mark.parametrize(
    ("keys", "problem"),
    [
        ("DefaultValue=1 ms\n", Problem(13, 14, "'1 ms' is no number")),
        ("DefaultValue = 40000\n", Problem(13, 16, "40000 does not fit into 16 bits")),
        ("DefaultValue=$NODEID+32767\n", Problem(13, 14, "$NODEID+32767 does not fit into 16 bits")),
        ("LowLimit=\nHighLimit=0x1FFFF\n", Problem(14, 11, "0x1FFFF does not fit into 16 bits")),
        ("HighLimit=1\nLowLimit=2\n", Problem(14, 10, "LowLimit 2 is above HighLimit 1")),
        ("LowLimit=2\nHighLimit=3\nDefaultValue=1\n", Problem(15, 14, "DefaultValue 1 is below LowLimit 2")),
        ("HighLimit=3\nDefaultValue=4\n", Problem(14, 14, "DefaultValue 4 is above HighLimit 3")),
        ("PDOMapping=2\n", Problem(13, 12, "PDOMapping is 0 or 1, not 2")),
        ("PDOMapping=yes\n", Problem(13, 12, "'yes' is no number")),
    ],
)
def test_faults_of_values(keys: str, problem: Problem) -> None:
    assert _variable(keys).problems == (problem,)


@pytest.mark.parametrize(
    ("section", "problems"),
    [
        ("DataType=0x5\nAccessType=ro\n", [Problem(8, 1, "[2000] has no ParameterName")]),
        ("ParameterName=x\nAccessType=ro\n", [Problem(8, 1, "[2000] has no DataType")]),
        ("ParameterName=x\nDataType=0x5\n", [Problem(8, 1, "[2000] has no AccessType")]),
        (
            "ParameterName=x\nDataType=0x5\nAccessType=r w\n",
            [Problem(11, 12, "'r w' is no access type, those are ro, wo, rw, rwr, rww, const")],
        ),
        ("ParameterName=x\nObjectType=3\nDataType=5\nAccessType=ro\n", [Problem(10, 12, "3 is no object type")]),
        ("ParameterName=x\nObjectType=0x9\n", [Problem(8, 1, "[2000] has no SubNumber")]),
        (
            "ParameterName=x\nObjectType=0x9\nSubNumber=2\n" + f"[2000sub0]\n{VALUE}",
            [Problem(11, 11, "[2000] has 1 sub-indexes, not 2")],
        ),
        ("ParameterName=x\nObjectType=0x7\n" + f"[2000sub1]\n{VALUE}", [Problem(10, 12, "a VAR has no sub-indexes")]),
    ],
)
def test_faults_of_objects(section: str, problems: list[Problem]) -> None:
    assert list(read(f"{HEAD}{_listed(0x2000)}[2000]\n{section}").problems) == problems


def test_sub_index_without_object() -> None:
    found = read(f"{HEAD}[2000sub1]\n{VALUE}")
    assert found.problems == (Problem(5, 1, "[2000sub1] stands without [2000]"),)
    assert found.objects == {}


def test_file_without_head() -> None:
    assert read("").problems == (
        Problem(1, 1, "section [DeviceInfo] is missing"),
        Problem(1, 1, "section [FileInfo] is missing"),
    )


@pytest.mark.parametrize(
    ("lines", "problems"),
    [
        ("", [Problem(5, 1, "[OptionalObjects] has no SupportedObjects")]),
        ("SupportedObjects=one\n", [Problem(6, 18, "'one' is no number")]),
        ("SupportedObjects=1\n", [Problem(6, 18, "[OptionalObjects] lists 0 objects, not 1")]),
        ("SupportedObjects=1\n1=0x1002\n", [Problem(7, 3, "object 0x1002 has no section")]),
        (
            "SupportedObjects=1\n2= 0x1002\n",
            [Problem(7, 1, "'1' is expected here, not '2'"), Problem(7, 4, "object 0x1002 has no section")],
        ),
        ("SupportedObjects=1\n1=here\n", [Problem(7, 3, "'here' is no number")]),
    ],
)
def test_faults_of_lists(lines: str, problems: list[Problem]) -> None:
    assert list(read(f"{HEAD}[OptionalObjects]\n{lines}").problems) == problems


def test_object_in_no_list() -> None:
    assert read(f"{HEAD}[2000]\n{VALUE}").problems == (Problem(5, 1, "object 0x2000 stands in no list of objects"),)


def test_missing_comment_line() -> None:
    found = read(f"{HEAD}[Comments]\nLines=1000000000000000000\nLine1=a\n")
    assert (found.comments, found.problems) == (("a",), (Problem(6, 7, "Line2 is missing"),))


# Anything at all

_PIECES = st.sampled_from(
    [
        "[2000]",
        "[2000sub1]",
        "[Comments]",
        "[MandatoryObjects]",
        "SupportedObjects=",
        "ParameterName=",
        "DataType=0x000",
        "LowLimit=",
        "DefaultValue=$NODEID+",
        "SubNumber=",
        "Lines=",
        "1=",
        "=",
        "]",
        ";",
        "0x",
        "-",
        "9",
        "\r",
        "\n",
        " ",
    ]
)


@given(st.lists(st.one_of(_PIECES, st.text(max_size=3)), max_size=60).map("".join))
def test_no_text_raises_and_every_place_exists(text: str) -> None:
    found = read(text)
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    for problem in found.problems:
        assert 1 <= problem.line <= len(lines)
        assert 1 <= problem.column <= len(lines[problem.line - 1]) + 1
    for section in found.document.sections.values():
        assert lines[section.line - 1][section.column - 1] == "["
        for key in section.keys():  # noqa: SIM118
            line = lines[key.line - 1]
            assert line[key.column - 1 :].startswith(key.name)
            assert line[key.value_column - 1 :].startswith(key.value)


@given(st.binary(max_size=200))
def test_no_bytes_raise(data: bytes) -> None:
    assert isinstance(read(data), Eds)
