"""The notations: what each grammar accepts, what it makes of it, what it refuses and where."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from generator.model import CodeRef, ErrorRef, Filler, Light, NodeRelative, ObjectRef, Pattern, Range, What
from generator.notation import (
    NotationError,
    NumberRun,
    RefRun,
    attributes,
    citation,
    filler,
    formula,
    node_relative,
    numbers,
    pattern,
    references,
    value_range,
)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("C13350", [RefRun((CodeRef(13350),))]),
        ("C13372/2...4", [RefRun(tuple(CodeRef(13372, k) for k in (2, 3, 4)))]),
        ("C14311 ... C14625", [RefRun((), (CodeRef(14311), CodeRef(14625)))]),
        ("C13367 / C14367", [RefRun((CodeRef(13367),)), RefRun((CodeRef(14367),))]),
        ("C13321/1 / C14321/1", [RefRun((CodeRef(13321, 1),)), RefRun((CodeRef(14321, 1),))]),
        (
            "C1, C2".replace("C1", "C13591/1").replace("C2", "C13592"),
            [RefRun((CodeRef(13591, 1),)), RefRun((CodeRef(13592),))],
        ),
        ("I-1800/1 ... I-1802/1", [RefRun(tuple(ObjectRef(i, 1) for i in (0x1800, 0x1801, 0x1802)))]),
        ("I-1016/1...3", [RefRun(tuple(ObjectRef(0x1016, k) for k in (1, 2, 3)))]),
        ("I-1400 ... I-1403", [RefRun((), (ObjectRef(0x1400), ObjectRef(0x1403)))]),
        ("P-918", [RefRun((ObjectRef(918),))]),
        ("E-0x009d0000", [RefRun((ErrorRef("", 0x009D0000),))]),
        ("table:pins", [RefRun(("table:pins",))]),
    ],
)
def test_references(text: str, expected: list[RefRun]) -> None:
    assert list(references(text)) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("0 ... 65535 ms", Range(Fraction(0), Fraction(65535), "ms")),
        ("0x00 ... 0xFF", Range(Fraction(0), Fraction(255))),
        ("-10.5 ... 100 %", Range(Fraction(-21, 2), Fraction(100), "%")),
        ("0 ... 65535 1/10 ms", Range(Fraction(0), Fraction(65535), "1/10 ms")),
    ],
)
def test_ranges(text: str, expected: Range) -> None:
    assert value_range(text) == expected


@pytest.mark.parametrize(
    ("text", "bases", "expected"),
    [
        ("11264 / 2C00", (10, 16), [NumberRun(11264, None, 10), NumberRun(0x2C00, None, 16)]),
        ("0x009d0000 / 10289152", (16, 10), [NumberRun(0x9D0000, None, 16), NumberRun(10289152, None, 10)]),
        (
            "0x009e0000 ... 0x009e001f / 10354688 ... 10354719",
            (16, 10),
            [NumberRun(0x9E0000, 0x9E001F, 16), NumberRun(10354688, 10354719, 10)],
        ),
        ("0x0604 0041", (16, 10), [NumberRun(0x06040041, None, 16)]),
    ],
)
def test_numbers(text: str, bases: tuple[int, int], expected: list[NumberRun]) -> None:
    assert list(numbers(text, bases)) == expected


def test_other_notations() -> None:
    assert node_relative("$NODEID + 0x180") == NodeRelative(0x180)
    assert node_relative("$NODEID+384") == NodeRelative(384)
    assert citation("13.2 p. 107") == (None, "13.2", 107)
    assert citation("EDS94ARNE-EN-2.3 X p. 201") == ("EDS94ARNE-EN-2.3", "X", 201)
    assert citation("CiA-301-4.02 9.6.3") == ("CiA-301-4.02", "9.6.3", None)
    row = attributes("24264 / 5EC8 | A 8 BITFIELD_8 | 1 | RW CINH")
    assert (row.decimal, row.hexadecimal, row.structure, row.count) == (24264, 0x5EC8, "A", 8)
    assert (row.type_name, row.factor, row.access) == ("BITFIELD_8", 1, "RW CINH")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("off", Pattern(Light.OFF)),
        ("on green", Pattern(Light.ON, "green")),
        ("flicker", Pattern(Light.FLICKER)),
        ("blink 0.2 s", Pattern(Light.BLINK, period=Fraction(1, 5))),
        ("blink red/green 1 s", Pattern(Light.BLINK, "red/green", period=Fraction(1))),
        ("flash 2, 1 s off", Pattern(Light.FLASH, flashes=2, pause=Fraction(1))),
    ],
)
def test_patterns(text: str, expected: Pattern) -> None:
    assert pattern(text) == expected


@pytest.mark.parametrize(
    ("read", "text", "column"),
    [
        (references, "C13350/", 7),
        (references, "13350", 0),
        (references, "I-10", 0),
        (value_range, "0 .. 5", 1),
        (value_range, "0 ...", 5),
        (numbers, "0x 12", 1),
        (node_relative, "NODEID + 1", 0),
        (node_relative, "$NODEID - 1", 7),
        (citation, "p. 7", 0),
        (attributes, "24264 / 5EC8 | B 8 BITFIELD_8 | 1 | RW", 15),
        (pattern, "blink fast", 6),
        (formula, "1 +", 3),
    ],
)
def test_what_is_refused_says_where(read: object, text: str, column: int) -> None:
    assert callable(read)
    with pytest.raises(NotationError) as caught:
        read(text)
    assert caught.value.column == column


@given(st.integers(0, 24575), st.integers(0, 255))
def test_code_references_survive_their_text(number: int, subcode: int) -> None:
    for ref in (CodeRef(number), CodeRef(number, subcode)):
        assert references(str(ref))[0].items == (ref,)


@given(st.integers(0, 0xFFFF), st.integers(0, 255))
def test_object_references_survive_their_text(index: int, subindex: int) -> None:
    for ref in (ObjectRef(index), ObjectRef(index, subindex)):
        assert references(str(ref))[0].items == (ref,)


@given(st.integers(0, 0xFFFFFFFF))
def test_printed_numbers_are_read_in_both_bases(number: int) -> None:
    runs = numbers(f"0x{number:08x} / {number}")
    assert [run.first for run in runs] == [number, number]


@given(st.integers(0, 99999), st.integers(0, 99999), st.integers(0, 99999), st.integers(1, 99999))
def test_formulas_calculate(a: int, b: int, c: int, d: int) -> None:
    values = {"a": a, "b": b, "c": c, "d": d}
    assert formula("(a - b + 150) mod d")(values) == (a - b + 150) % d
    assert formula("a + b * c - 0x10")(values) == a + b * c - 16


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("$INDEX", Filler(What.INDEX)),
        ("$SUBINDEX", Filler(What.SUBINDEX)),
        ("$ERROR 24...31", Filler(What.ERROR, 24, 31)),
        ("$BEHIND res", Filler(What.BEHIND, field="res")),
    ],
)
def test_filler(text: str, expected: Filler) -> None:
    assert filler(text) == expected
    assert str(expected) == text


@pytest.mark.parametrize(("text", "column"), [("$INDEXES", 6), ("$BEHIND", 7), ("$ERROR 24", 9), ("$BEHIND 3", 8)])
def test_filler_refuses(text: str, column: int) -> None:
    with pytest.raises(NotationError) as caught:
        filler(text)
    assert caught.value.column == column
