"""The reader of GSD files: what it makes of good and of bad text, with exact places."""

from pathlib import Path

import pytest
from gsd_crate import Crate
from hypothesis import given
from hypothesis import strategies as st

from generator.readers.eds import Problem
from generator.readers.gsd import (
    Area,
    Choice,
    Diagnosis,
    Family,
    Gsd,
    Identifier,
    Labelled,
    Named,
    UserData,
    decode,
    identifiers,
    parse,
    read,
)

HEAD = """\
#Profibus_DP
Vendor_Name="Acme"
Model_Name="Drive"
Revision="1"
Ident_Number=0x1234
Protocol_Ident=0
Station_Type=0
Hardware_Release="1"
Software_Release="1"
"""
"""Nine lines that every file has to have; what follows begins in line 10."""
MODULAR = "Modular_Station=1\nMax_Module=2\nMax_Input_Len=8\nMax_Output_Len=8\n"

RICH = """\
; A file with most of what makers write.
#Profibus_DP
GSD_Revision = 5
Vendor_Name  = "Acme"               ; a comment
Model_Name   = "Drive; with a semicolon"
Revision="1"
Ident_Number=0x1234
Protocol_Ident=0
Station_Type=0
Hardware_Release="1"
Software_Release="1"
9.6_supp=1
12M_supp=1
MaxTsdr_9.6=60
MaxTsdr_12M=800
24V_Pins=0
Slave_Family=1@Acme@Small drives
Modular_Station=1
Max_Module=2
Max_Input_Len=16
Max_Output_Len=16
Max_Data_Len=32
Max_Diag_Data_Len=16
DP_Encoder_profile_version = 1.1

PrmText=1
Text(0)="Off"
Text(1)="On"
EndPrmText
ExtUserPrmData=1 "Mode"
BitArea(0-1) 1 0-2
Prm_Text_Ref=1
EndExtUserPrmData
ExtUserPrmData=2 "Level"
Signed8 -5 -10-10
EndExtUserPrmData
ExtUserPrmData=3 "Choice"
Unsigned8 4 0,4,8
Changeable=0
Visible=0
EndExtUserPrmData
ExtUserPrmData=4 "Flag"
Bit(3) 0 0-1
EndExtUserPrmData

Unit_Diag_Bit(16)="Cable broken"
Unit_Diag_Bit(17)="Fan stands still"
Unit_Diag_Area=24-31
Value(1)="Cold"
Value(2)="Hot"
Unit_Diag_Area_End
Channel_Diag(16)="Short circuit"

Max_User_Prm_Data_Len=8
Ext_User_Prm_Data_Const(0)=0x00, 0x01,\\
                           0x02 , \\
                           3
Ext_User_Prm_Data_Ref(1)=1
Ext_User_Prm_Data_Ref(4)=2

Module="4 words" 0xF3
1
Ext_Module_Prm_Data_Len=2
Ext_User_Prm_Data_Const(0)=0x04,0x81
Ext_User_Prm_Data_Ref(1)=3
Info_Text="Four words"
EndModule
Module="Safe" 0xC0,0x83,0x83
2
F_Ext_Module_Prm_Data_Len=14
F_Ext_User_Prm_Data_Const(0)=0x0E
F_Ext_User_Prm_Data_Ref(4)=4
EndModule
Module="Split" 0x10,0x20
3
Data_Area_Beg
Length=1
Data_Area_End
EndModule

SlotDefinition
Slot(1)="Slot 1" 1 1,3
Slot(2)="Slot 2" 2 1-3
EndSlotDefinition
"""


def _station(more: str) -> Gsd:
    """A file with what has to be in it; ``more`` begins in line 10."""
    return read(HEAD + more)


# Statements


@pytest.mark.parametrize(
    ("text", "name", "key", "value"),
    [
        ("GSD_Revision=5", "GSD_Revision", None, 5),
        ("Ident_Number = 0x07a8", "Ident_Number", None, 0x07A8),
        ("Ident_Number = 0X07A8", "Ident_Number", None, 0x07A8),
        ("9.6_supp=1", "9.6_supp", None, 1),
        ("24V_Pins\t=\t2", "24V_Pins", None, 2),
        ('Vendor_Name="Acme; a ""', "", None, None),
        ('Vendor_Name="Acme; a"', "Vendor_Name", None, "Acme; a"),
        ('Vendor_Name=""', "Vendor_Name", None, ""),
        ("User_Prm_Data=0x00,1 , 2", "User_Prm_Data", None, (0, 1, 2)),
        ("User_Prm_Data=0x00,\\\n1 , \\ ; a\n2", "User_Prm_Data", None, (0, 1, 2)),
        ("Slave_Family=1@Acme@TdF@x y ; z", "Slave_Family", None, Family(1, ("Acme", "TdF", "x y"))),
        ("Slave_Family=3", "Slave_Family", None, 3),
        ("Unit_Diag_Area = 24 - 31", "Unit_Diag_Area", None, Area(24, 31)),
        ('Text(-3)="Low"', "Text", -3, "Low"),
        ('X_Value( 0x10 ) = "Hot"', "X_Value", 16, "Hot"),
        ('Unit_Diag_!Bit(3)="Not"', "Unit_Diag_!Bit", 3, "Not"),
        ('Info_Text="one \\\ntwo"', "Info_Text", None, "one two"),
        ('ExtUserPrmData=7 "Mode"', "ExtUserPrmData", None, Named(7, "Mode")),
        ('Module="a" 0xF3;', "Module", None, Labelled("a", (0xF3,))),
        ('Module = "a"0xF3 , 240', "Module", None, Labelled("a", (0xF3, 0xF0))),
        ('Slot(1)="S" 1 2-4', "Slot", 1, Choice("S", 1, Area(2, 4))),
        ('Slot(1)="S" 1 2', "Slot", 1, Choice("S", 1, (2,))),
        ('Slot(1)="S" 1 2,4', "Slot", 1, Choice("S", 1, (2, 4))),
        ("Unsigned8 0", "Unsigned8", None, Choice("", 0, None)),
        ("Unsigned16 10 0-0xFFFF", "Unsigned16", None, Choice("", 10, Area(0, 0xFFFF))),
        ("Signed8 -5 -10--1", "Signed8", None, Choice("", -5, Area(-10, -1))),
        ("BitArea(2-3) 1 0,1,3", "BitArea", Area(2, 3), Choice("", 1, (0, 1, 3))),
        ("EndModule", "EndModule", None, None),
        ("Version=1.08", "Version", None, "1.08"),
        (" 101 ", "", None, 101),
    ],
)
def test_statements(text: str, name: str, key: object, value: object) -> None:
    document = parse(f"#Profibus_DP\n{text}\n")
    if name or value is not None:
        assert document.problems == ()
        (found,) = document.statements
        assert (found.name, found.key, found.value) == (name, key, value)
    else:
        assert document.statements == ()
        assert len(document.problems) == 1


def test_places_count_from_one() -> None:
    document = parse('; head\r\n#Profibus_DP\r\n  A = 1\r\nB(2)= \\\r\n  "x" ; c\r\n\r\n 7\r\nEndModule\r\n')
    assert document.problems == ()
    assert [(s.name, s.line, s.column, s.value_line, s.value_column) for s in document.statements] == [
        ("A", 3, 3, 3, 7),
        ("B", 4, 1, 5, 3),
        ("", 7, 2, 7, 2),
        ("EndModule", 8, 1, 8, 1),
    ]


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_every_line_end_counts_once(end: str) -> None:
    document = parse(end.join(["#Profibus_DP", "A=1", "", "B=2"]))
    assert [(s.name, s.line) for s in document.statements] == [("A", 2), ("B", 4)]


def test_what_stands_around_the_section_does_not_count() -> None:
    document = parse('nothing = "of it\n #PROFIBUS_DP ; from here\nA=1\n#Other\nB=2\n')
    assert document.problems == ()
    assert [s.name for s in document.statements] == ["A"]


def test_a_file_without_head_is_read_all_the_same() -> None:
    document = parse("A=1\nB=2\n")
    assert document.problems == (Problem(1, 1, "the line '#Profibus_DP' is missing"),)
    assert [s.name for s in document.statements] == ["A", "B"]


def test_a_backslash_in_a_comment_continues_nothing() -> None:
    document = parse("#Profibus_DP\nA=1 ; x \\\nB=2\n; y \\\nC=3\n")
    assert [(s.name, s.value) for s in document.statements] == [("A", 1), ("B", 2), ("C", 3)]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("A=", Problem(2, 3, "the statement ends too early")),
        ("A = 1,\n", Problem(2, 7, "the statement ends too early")),
        ("A = 1,\\\n  ; x\n", Problem(3, 1, "the statement ends too early")),
        ('A="x', Problem(2, 3, "a text has no closing quote")),
        (' A="x" y', Problem(2, 8, "'y' cannot stand here")),
        ("24V Pins=0", Problem(2, 5, "'Pins' cannot stand here")),
        ("A=0x", Problem(2, 3, "'0x' cannot stand here")),
        ("A=12345678901234567890123", Problem(2, 3, "'12345678901234567890123' cannot stand here")),
        ("A=1,\\\n 2\\\n  ? 3", Problem(4, 3, "'?' cannot stand here")),
        ("=1", Problem(2, 1, "'=' cannot stand here")),
        ("A(1-2=3", Problem(2, 6, "'=' cannot stand here")),
        ("A=1 \\", Problem(2, 5, "'\\' cannot stand here")),
        ("Umlaut=ä", Problem(2, 8, "'ä' cannot stand here")),
    ],
)
def test_faults_of_syntax(text: str, problem: Problem) -> None:
    document = parse(f"#Profibus_DP\n{text}")
    assert document.problems == (problem,)
    assert document.statements == ()


def test_reading_goes_on_after_a_fault() -> None:
    document = parse("#Profibus_DP\nA=\nB=1\n?\nC=2\n")
    assert [s.name for s in document.statements] == ["B", "C"]
    assert [problem.line for problem in document.problems] == [2, 4]


def test_character_sets() -> None:
    assert decode(b'A="\xfc"') == 'A="ü"'
    assert decode(b'\xef\xbb\xbfA="\xc3\xbc"') == 'A="ü"'
    assert decode(b"\xef\xbb\xbf\xff") == "\ufffd"


# Meaning


def test_a_rich_file() -> None:
    gsd = read(RICH.encode())
    assert gsd.problems == ()
    assert gsd.value("model_name") == "Drive; with a semicolon"
    assert gsd.value("SLAVE_FAMILY") == Family(1, ("Acme", "Small drives"))
    assert gsd.value("absent") is None
    assert gsd.prm_texts[1].texts == {0: "Off", 1: "On"}
    assert [
        (p.number, p.name, p.type, p.bits, p.default, p.allowed, p.text, p.changeable, p.visible)
        for p in gsd.parameters.values()
    ] == [
        (1, "Mode", "BitArea", Area(0, 1), 1, Area(0, 2), 1, True, True),
        (2, "Level", "Signed8", None, -5, Area(-10, 10), None, True, True),
        (3, "Choice", "Unsigned8", None, 4, (0, 4, 8), None, False, False),
        (4, "Flag", "Bit", Area(3, 3), 0, Area(0, 1), None, True, True),
    ]
    assert gsd.user_data == UserData(8, ((0, b"\x00\x01\x02\x03"),), ((1, 1), (4, 2)))
    (diagnosis,) = gsd.diagnosis
    assert (diagnosis.type, diagnosis.bits) == (None, {16: "Cable broken", 17: "Fan stands still"})
    assert [(a.first, a.last, a.texts) for a in diagnosis.areas] == [(24, 31, {1: "Cold", 2: "Hot"})]
    assert gsd.channel_errors == {16: "Short circuit"}
    assert [(m.name, m.configuration, m.reference, m.inputs, m.outputs) for m in gsd.modules] == [
        ("4 words", b"\xf3", 1, 8, 8),
        ("Safe", b"\xc0\x83\x83", 2, 4, 4),
        ("Split", b"\x10\x20", 3, 1, 1),
    ]
    first, safe, _ = gsd.modules
    assert first.user_data == UserData(2, ((0, b"\x04\x81"),), ((1, 3),))
    assert first.keywords["info_text"].value == "Four words"
    assert safe.user_data == UserData(None, (), ())
    assert safe.f_user_data == UserData(14, ((0, b"\x0e"),), ((4, 4),))
    assert gsd.module("Safe") is safe
    assert gsd.module("safe") is None
    assert [(s.number, s.name, s.default, s.modules) for s in gsd.slots] == [
        (1, "Slot 1", 1, (1, 3)),
        (2, "Slot 2", 2, Area(1, 3)),
    ]


STATUS_BLOCKS = """\
UnitDiagType=129
X_Unit_Diag_Bit(24)="a"
X_Unit_Diag_Area=26-27
X_Value(3)="b"
X_Unit_Diag_Area_End
EndUnitDiagType
UnitDiagType=161
EndUnitDiagType
"""


def test_status_blocks_have_texts_of_their_own() -> None:
    gsd = _station(STATUS_BLOCKS)
    assert gsd.problems == ()
    assert [(d.type, d.bits) for d in gsd.diagnosis] == [(129, {24: "a"}), (161, {})]
    assert gsd.diagnosis[1] == Diagnosis(161, {}, ())
    assert [(a.first, a.last, a.texts) for a in gsd.diagnosis[0].areas] == [(26, 27, {3: "b"})]


@pytest.mark.parametrize(
    ("octets", "expected"),
    [
        ("F3", [(8, 8, True, True, "")]),
        ("70", [(2, 2, True, False, "")]),
        ("1F 27", [(16, 0, False, False, ""), (0, 8, False, False, "")]),
        ("C0 01 7D", [(124, 2, False, False, "")]),
        ("C0 DF DF", [(64, 64, True, True, "")]),
        ("40 C3", [(8, 0, True, True, "")]),
        ("82 00 AA BB", [(0, 1, False, False, "AABB")]),
        ("00", [(0, 0, False, False, "")]),
        ("02 AA BB F0", [(0, 0, False, False, "AABB"), (2, 2, True, True, "")]),
        ("", []),
    ],
)
def test_identifier_bytes(octets: str, expected: list[tuple[int, int, bool, bool, str]]) -> None:
    assert list(identifiers(bytes.fromhex(octets))) == [
        Identifier(inputs, outputs, words, whole, bytes.fromhex(vendor))
        for inputs, outputs, words, whole, vendor in expected
    ]


@pytest.mark.parametrize("octets", ["C0", "C0 01", "40", "83 00 AA BB", "01"])
def test_identifier_bytes_that_end_early(octets: str) -> None:
    with pytest.raises(ValueError, match="ends inside of an identifier"):
        identifiers(bytes.fromhex(octets))


@pytest.mark.parametrize(
    ("more", "problem"),
    [
        # Keywords
        ("Vendor_Name=5", Problem(10, 1, "'Vendor_Name' stands twice, first in line 2")),
        ("GSD_Revision=256", Problem(10, 14, "256 is outside of 0 ... 255")),
        ("Max_Input_Len=x", Problem(10, 15, "'x' cannot stand here")),
        ('GSD_Revision="3"', Problem(10, 14, "'GSD_Revision' is a number")),
        ("OrderNumber=5", Problem(10, 13, "'OrderNumber' is a text")),
        ('OrderNumber=""', Problem(10, 13, "a text is empty")),
        (f'OrderNumber="{"x" * 33}"', Problem(10, 13, "a text has 33 characters, at most 32 are allowed")),
        ("12M_supp=1", Problem(10, 10, "'MaxTsdr_12M' is missing")),
        ("12M_supp=2\nMaxTsdr_12M=800", Problem(10, 10, "2 is outside of 0 ... 1")),
        ("Modular_Station=1\nMax_Module=1\nMax_Input_Len=1", Problem(1, 1, "'Max_Output_Len' is missing")),
        ("Fail_Safe=0\n17", Problem(11, 1, "a number stands outside of a module")),
        # Blocks
        ("EndModule", Problem(10, 1, "'EndModule' ends nothing")),
        (' Module="a" 0xF0', Problem(10, 2, "'Module' has no 'EndModule'")),
        ('PrmText=1\nText(0)="a"\nEndModule\nEndPrmText', Problem(12, 1, "'EndModule' ends nothing")),
        ('PrmText=1\nText(0)="a"\nModule="a" 0xF0\nEndModule', Problem(10, 1, "'PrmText' has no 'EndPrmText'")),
        # User parameters
        ("PrmText=1\nEndPrmText", Problem(10, 1, "PrmText 1 has no text")),
        ('PrmText="x"\nEndPrmText', Problem(10, 9, "'PrmText' has a number")),
        ('PrmText=1\nText(0)="a"\nText(0)="b"\nEndPrmText', Problem(12, 1, "'Text(0)' stands twice")),
        ('PrmText=1\nText(0)="a"\nText=5\nEndPrmText', Problem(12, 6, "'Text' has a number and a text")),
        (
            'PrmText=1\nText(0)="a"\nEndPrmText\nPrmText=1\nText(0)="a"\nEndPrmText',
            Problem(13, 9, "PrmText 1 stands twice"),
        ),
        ("ExtUserPrmData=1\nEndExtUserPrmData", Problem(10, 16, "'ExtUserPrmData' has a number and a name")),
        ('ExtUserPrmData=1 "a"\nEndExtUserPrmData', Problem(10, 1, "ExtUserPrmData 1 has no data type")),
        ('ExtUserPrmData=1 "a"\nUnsigned7 0\nEndExtUserPrmData', Problem(11, 1, "'Unsigned7' is no data type")),
        (
            'ExtUserPrmData=1 "a"\nUnsigned8 256\nEndExtUserPrmData',
            Problem(11, 11, "the default 256 is outside of 0 ... 255"),
        ),
        ('ExtUserPrmData=1 "a"\nBitArea(6-8) 0\nEndExtUserPrmData', Problem(11, 1, "'BitArea' names bits 0 ... 7")),
        ('ExtUserPrmData=1 "a"\nBit 0\nEndExtUserPrmData', Problem(11, 1, "'Bit' names bits 0 ... 7")),
        (
            'ExtUserPrmData=1 "a"\nBitArea(2-3) 4\nEndExtUserPrmData',
            Problem(11, 14, "the default 4 is outside of 0 ... 3"),
        ),
        (
            'ExtUserPrmData=1 "a"\nUnsigned8 3 0-2\nEndExtUserPrmData',
            Problem(11, 11, "the default 3 is not allowed"),
        ),
        (
            'ExtUserPrmData=1 "a"\nUnsigned8 3\nPrm_Text_Ref=9\nEndExtUserPrmData',
            Problem(12, 14, "there is no PrmText 9"),
        ),
        ("Ext_User_Prm_Data_Ref(0)=5", Problem(10, 26, "there is no ExtUserPrmData 5")),
        ("Ext_User_Prm_Data_Ref=5", Problem(10, 23, "'Ext_User_Prm_Data_Ref' has an offset and a number")),
        ("Ext_User_Prm_Data_Const(0)=256", Problem(10, 28, "'Ext_User_Prm_Data_Const' has an offset and bytes")),
        (
            "Max_User_Prm_Data_Len=2\nExt_User_Prm_Data_Const(1)=1,2",
            Problem(11, 28, "the user parameters have 2 bytes, this one ends at 3"),
        ),
        # Diagnosis
        ("Unit_Diag_Area=5\nUnit_Diag_Area_End", Problem(10, 16, "'Unit_Diag_Area' has a first and a last bit")),
        ("Unit_Diag_Area=5-4\nUnit_Diag_Area_End", Problem(10, 16, "'Unit_Diag_Area' has a first and a last bit")),
        ("Unit_Diag_Area=0-99999999\nUnit_Diag_Area_End", Problem(10, 16, "an area has at most 16 bits")),
        ('Unit_Diag_Area=4-5\nValue(4)="a"\nUnit_Diag_Area_End', Problem(11, 1, "4 does not fit into 2 bits")),
        ('UnitDiagType="x"\nEndUnitDiagType', Problem(10, 14, "'UnitDiagType' has a number")),
        # Modules
        ('Module="a"\nEndModule', Problem(10, 8, "'Module' has a name and bytes")),
        ('Module="a" 256\nEndModule', Problem(10, 8, "'Module' has a name and bytes")),
        ('Module="a" 0xC0,1\nEndModule', Problem(10, 8, "the configuration ends inside of an identifier")),
        (
            MODULAR + 'Module="a" 0xD4\nEndModule',
            Problem(14, 8, "the module has 10 bytes, Max_Input_Len is 8"),
        ),
        (
            MODULAR + 'Module="a" 0xF0\n1\nEndModule\nModule="b" 0xF0\n1\nEndModule',
            Problem(17, 1, "the module reference 1 stands twice"),
        ),
        (
            'Module="a" 0xF0\nEndModule\nModule="b" 0xF0\nEndModule',
            Problem(12, 1, "a station that is not modular has one module"),
        ),
        (
            'SlotDefinition\nSlot(1)="a"\nEndSlotDefinition',
            Problem(11, 9, "'Slot' has a number, a name, a default and module references"),
        ),
        (
            'SlotDefinition\nSlot(1)="a" 1 1\nEndSlotDefinition',
            Problem(11, 9, "there is no module with the reference 1"),
        ),
        (
            'Module="a" 0xF0\n1\nEndModule\nSlotDefinition\nSlot(1)="a" 1 2\nEndSlotDefinition',
            Problem(14, 9, "the default 1 is not allowed in the slot"),
        ),
    ],
)
def test_faults_of_meaning(more: str, problem: Problem) -> None:
    assert _station(more + "\n").problems == (problem,)


def test_an_empty_file_lacks_what_it_must_have() -> None:
    messages = [problem.message for problem in read("").problems]
    assert "the line '#Profibus_DP' is missing" in messages
    assert "'Ident_Number' is missing" in messages


TOKENS = (
    "#Profibus_DP", "\n", " ", "=", '"', ";", "\\", ",", "-", "(", ")", "@", "0x", "1", "99999999999", "4-5", '"a"',
    "Module", "EndModule", "PrmText", "Text(0)", "EndPrmText", "ExtUserPrmData", "Bit(0) 1 0-1", "Unsigned8 0 0-9",
    "EndExtUserPrmData", "UnitDiagType", "X_Unit_Diag_Area", "X_Value(1)", "X_Unit_Diag_Area_End", "EndUnitDiagType",
    "SlotDefinition", "Slot(1)", "EndSlotDefinition", "Ext_User_Prm_Data_Const(0)", "0xC0", "Max_Module", "12M_supp",
    "Modular_Station", "Data_Area_Beg", "ä", "\r",
)  # fmt: skip


@given(st.lists(st.sampled_from(TOKENS), max_size=40).map("".join) | st.text(max_size=80) | st.binary(max_size=80))
def test_nothing_that_a_file_holds_raises(source: str | bytes) -> None:
    gsd = read(source)
    lines = len((decode(source) if isinstance(source, bytes) else source).splitlines()) + 1
    assert all(1 <= problem.line <= lines + 1 and problem.column >= 1 for problem in gsd.problems)


@given(st.data())
def test_damaged_files_keep_their_sound_lines(data: st.DataObject) -> None:
    lines = RICH.splitlines()
    number = data.draw(
        st.sampled_from([i for i, line in enumerate(lines) if i > 1 and "=" in line and "\\" not in line])
    )
    damaged = [*lines[:number], "?" + lines[number], *lines[number + 1 :]]
    whole, found = parse(RICH), parse("\n".join(damaged))
    assert [problem.line for problem in found.problems] == [number + 1]
    kept = [s for s in whole.statements if s.line != number + 1]
    assert [(s.name, s.key, s.value, s.line) for s in found.statements] == [
        (s.name, s.key, s.value, s.line) for s in kept
    ]


# Another reader


def test_the_crate_gsd_parser_reads_the_same(root: Path, tmp_path: Path) -> None:
    crate = Crate(root)
    sample = tmp_path / "sample.gsd"
    sample.write_bytes(crate.sample().read_bytes())
    rich = tmp_path / "rich.gsd"
    rich.write_text(RICH.replace("0x02 , \\", "0x02, \\"), encoding="ascii")
    for path, other in crate.read([sample, rich]).items():
        own = read(path.read_bytes())
        assert own.problems == ()
        assert other.error == ""
        numbers = {name: own.value(name) or 0 for name in other.keywords}
        assert {name: str(value) for name, value in numbers.items()} == other.keywords
        assert {rate: own.value(f"MaxTsdr_{rate}") for rate in other.rates} == other.rates
        assert [
            (
                m.reference,
                m.name,
                m.configuration,
                str(m.keywords["info_text"].value) if "info_text" in m.keywords else "",
            )
            for m in own.modules
        ] == other.modules
        assert other.modules
