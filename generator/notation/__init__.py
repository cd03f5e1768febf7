"""The compact notations of the manuals, one Lark grammar each, read into plain values.

Every function raises ``NotationError`` with the column (from 0) where the text stops making sense.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedInput, UnexpectedToken

from generator.model import CodeRef, ErrorRef, Filler, Light, NodeRelative, ObjectRef, Pattern, Range, What

_FOLDER = Path(__file__).resolve().parent


class NotationError(Exception):
    """A text that is not of the notation; ``column`` counts from 0, ``example`` shows a text that is."""

    def __init__(self, message: str, column: int, example: str) -> None:
        """Keep the parts."""
        super().__init__(message)
        self.message = message
        self.column = column
        self.example = example


HIGHEST_SUBINDEX = 255
"""Last subcode of a code and last sub-index of an object: a byte."""
HIGHEST_BIT = 63
"""Last bit that a number can have."""
_HIGHEST_INDEX = 0xFFFF
_LONGEST = 250
"""Characters that a text in a notation can have; keeps formulas and numbers small."""

_EXAMPLES = {
    "references": "C13372/2...10",
    "range": "0 ... 65535 ms",
    "numbers": "0x009e0000 ... 0x009e001f",
    "node": "$NODEID + 0x180",
    "citation": "13.2 p. 107",
    "attributes": "24264 / 5EC8 | A 8 BITFIELD_8 | 1 | RW",
    "formula": "25575 - code",
    "pattern": "blink 0.2 s",
    "filler": "$ERROR 24...31",
}


@cache
def _parser(name: str) -> Lark:
    return Lark.open(str(_FOLDER / f"{name}.lark"), parser="lalr", maybe_placeholders=True)


@lru_cache(maxsize=4096)
def _parse(name: str, text: str) -> Tree[Token]:
    if len(text) > _LONGEST:
        raise NotationError(f"the text has {len(text)} characters, more than {_LONGEST}", 0, _EXAMPLES[name])
    try:
        return _parser(name).parse(text)
    except UnexpectedInput as error:
        at_end = isinstance(error, UnexpectedToken) and error.token.type == "$END"
        column = error.column - 1 if not at_end and isinstance(error.column, int) and error.column > 0 else len(text)
        message = f"'{text}' is not written as in '{_EXAMPLES[name]}'"
        raise NotationError(message, min(column, len(text)), _EXAMPLES[name]) from None


def _integer(token: str) -> int:
    return int(token, 16) if token.startswith("0x") else int(token)


@dataclass(frozen=True, slots=True)
class RefRun:
    """References that belong together: a single one, or every one of a run.

    ``open_run`` is (first, last) where a run names its ends alone ("C14311 ... C14625"); which codes, objects or
    errors lie between them is for the reader to say.
    """

    items: tuple[CodeRef | ObjectRef | ErrorRef | str, ...]
    open_run: tuple[CodeRef, CodeRef] | tuple[ObjectRef, ObjectRef] | tuple[ErrorRef, ErrorRef] | None = None


def references(text: str) -> tuple[RefRun, ...]:
    """References in the order written.

    A run of subcodes is expanded ("C13372/2...10"); so is a run of objects with sub-index ("I-1800/1 ... I-1803/1");
    a run of codes is left open, for codes have gaps.
    """
    return tuple(_reference(child) for child in _parse("references", text).children if isinstance(child, Tree))


def _reference(tree: Tree[Token]) -> RefRun:
    children: list[Any] = tree.children
    tokens = [token for token in children if token is None or token.type != "DOTS"]
    match tree.data:
        case "code":
            number = int(tokens[0][1:])
            if tokens[1] is None:
                return RefRun((CodeRef(number),))
            return RefRun(tuple(CodeRef(number, k) for k in _run(_part, tokens[1], tokens[2] or tokens[1])))
        case "code_run":
            ends = [CodeRef(int(tokens[i][1:]), _optional(tokens[i + 1])) for i in (0, 2)]
            return RefRun((), (ends[0], ends[1]))
        case "object":
            index = _object_index(tokens[0])
            if tokens[1] is None:
                return RefRun((ObjectRef(index),))
            return RefRun(tuple(ObjectRef(index, k) for k in _run(_part, tokens[1], tokens[2] or tokens[1])))
        case "object_run":
            sub = _optional(tokens[1])
            if sub is None:
                return RefRun((), (ObjectRef(_object_index(tokens[0])), ObjectRef(_object_index(tokens[2]))))
            return RefRun(tuple(ObjectRef(i, sub) for i in _run(_object_index, tokens[0], tokens[2])))
        case "error":
            return RefRun((ErrorRef("", int(tokens[0][4:], 16)),))
        case "error_run":
            lowest, highest = (ErrorRef("", int(token[4:], 16)) for token in tokens)
            return RefRun((), (lowest, highest))
        case _:
            return RefRun((str(tokens[0]),))


def _run(read: Callable[[Token], int], first: Token, last: Token) -> range:
    """Every number of a run, whose ends are read by ``read``."""
    low, high = read(first), read(last)
    if high < low:
        raise NotationError(f"the run from {first} to {last} does not ascend", _column(last), _EXAMPLES["references"])
    return range(low, high + 1)


def _limited(token: Token, number: int, highest: int) -> int:
    if number > highest:
        raise NotationError(f"{token} is above {highest}, the last possible", _column(token), _EXAMPLES["references"])
    return number


def _part(token: Token) -> int:
    return _limited(token, int(token), HIGHEST_SUBINDEX)


def _optional(token: Token | None) -> int | None:
    return None if token is None else _part(token)


def _object_index(token: Token) -> int:
    return _limited(token, int(token[2:], 16 if token.startswith("I-") else 10), _HIGHEST_INDEX)


def _column(token: Token) -> int:
    return token.column - 1 if token.column else 0


def value_range(text: str) -> Range:
    """A range with its unit; both ends exact."""
    tree = _parse("range", text)
    low, high = (_fraction(str(t.children[0])) for t in tree.children if isinstance(t, Tree))
    unit = tree.children[-1]
    return Range(low, high, str(unit).strip() if isinstance(unit, Token) and unit.type == "UNIT" else "")


def _fraction(text: str) -> Fraction:
    return Fraction(int(text, 16)) if text.startswith("0x") else Fraction(text)


@dataclass(frozen=True, slots=True)
class NumberRun:
    """A printed number, or the first and last of a run, read in base 16 or 10."""

    first: int
    last: int | None
    base: int


def numbers(text: str, bases: tuple[int, int] = (16, 10)) -> tuple[NumberRun, ...]:
    """One printed form or two, parted by a slash; digits without 0x are read in the base of their place.

    >>> numbers("11264 / 2C00", (10, 16))
    (NumberRun(first=11264, last=None, base=10), NumberRun(first=11264, last=None, base=16))
    """
    runs = [c for c in _parse("numbers", text).children if isinstance(c, Tree)]
    return tuple(_number_run(text, run, base) for run, base in zip(runs, bases, strict=False))


def _number_run(text: str, run: Tree[Token], base: int) -> NumberRun:
    values = []
    for number in run.children:
        if not isinstance(number, Tree):
            continue
        token = number.children[0]
        assert isinstance(token, Token)
        digits = str(token).replace(" ", "")
        actual = 16 if digits.startswith("0x") else base
        try:
            values.append((int(digits, actual), actual))
        except ValueError:
            raise NotationError(f"'{digits}' is not a decimal number", _column(token), text) from None
    return NumberRun(values[0][0], values[1][0] if len(values) > 1 else None, values[0][1])


def node_relative(text: str) -> NodeRelative:
    """A value that follows the node address."""
    token = _parse("node", text).children[-1]
    return NodeRelative(_integer(str(token)))


def citation(text: str) -> tuple[str | None, str, int | None]:
    """Manual (``None`` where the file's own is meant), chapter, page."""
    manual, chapter, _, page = _parse("citation", text).children
    return (
        str(manual).strip() if manual is not None else None,
        str(chapter),
        int(str(page)) if page is not None else None,
    )


@dataclass(frozen=True, slots=True)
class Attributes:
    """A row of the table of attributes."""

    decimal: int
    hexadecimal: int
    structure: str
    count: int
    type_name: str
    factor: int | None
    access: str


def attributes(text: str) -> Attributes:
    """A row of the table of attributes."""
    found: dict[str, list[str]] = {}
    for token in _parse("attributes", text).children:
        if isinstance(token, Token):
            found.setdefault(token.type, []).append(str(token))
    decimal, hexadecimal = found["INDEX"]
    if not decimal.isdecimal():
        raise NotationError(f"'{decimal}' is not a decimal number", 0, _EXAMPLES["attributes"])
    count, *factor = found["INT"]
    return Attributes(
        decimal=int(decimal),
        hexadecimal=int(hexadecimal, 16),
        structure=found["STRUCTURE"][0],
        count=int(count),
        type_name=found["TYPE"][0],
        factor=int(factor[0]) if factor else None,
        access=found["ACCESS"][0],
    )


Formula = Callable[[Mapping[str, int]], int]
"""Value of a formula for given values of its variables; ``KeyError`` names a variable that is missing."""


def formula(text: str) -> Formula:
    """A formula over whole numbers; ``mod`` is never negative for a positive divisor."""
    return _compile(_parse("formula", text))


_OPERATIONS: Mapping[str, Callable[[int, int], int]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "mod": lambda a, b: a % b,
}


def _compile(tree: Any) -> Formula:
    if tree.data == "number":
        constant = _integer(str(tree.children[0]))
        return lambda _: constant
    if tree.data == "variable":
        name = str(tree.children[0])
        return lambda values: values[name]
    operation = _OPERATIONS[str(tree.data)]
    left, right = (_compile(child) for child in tree.children)
    return lambda values: operation(left(values), right(values))


def pattern(text: str) -> Pattern:
    """A blink pattern."""
    tree = _parse("pattern", text)
    parts = {t.type: str(t) for t in tree.children if isinstance(t, Token)}
    seconds = Fraction(parts["NUMBER"]) if "NUMBER" in parts else None
    light = Light(str(tree.data))
    return Pattern(
        light,
        colour=parts.get("COLOUR"),
        period=seconds if light is Light.BLINK else None,
        flashes=int(parts["COUNT"]) if "COUNT" in parts else None,
        pause=seconds if light is Light.FLASH else None,
    )


def filler(text: str) -> Filler:
    """What a service puts into a field.

    >>> filler("$ERROR 24...31").high
    31
    """
    parts: dict[str, list[str]] = {}
    for token in _parse("filler", text).children:
        if isinstance(token, Token):
            parts.setdefault(token.type, []).append(str(token))
    if "FIELD" in parts:
        return Filler(What.BEHIND, field=parts["FIELD"][0])
    low, high = map(int, parts["INT"]) if "INT" in parts else (None, None)
    if low is not None and high is not None and not low <= high <= HIGHEST_BIT:
        message = f"bits ascend and end at {HIGHEST_BIT} or before, not {low} ... {high}"
        raise NotationError(message, text.index(str(low)), _EXAMPLES["filler"])
    return Filler(What(parts["WHAT"][0]), low, high)
