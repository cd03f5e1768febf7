"""Literals, filled lines and the short texts of the documentation."""

from collections.abc import Iterable, Sequence
from decimal import Decimal
from fractions import Fraction

from generator.model import Access, CodeRef, DataType, Default, DictionaryObject, Manual, NodeRelative, Range

WIDTH = 118
"""Longest line that is filled."""

Literal = int | str | tuple["Literal", ...] | None
"""What a row may hold."""


def literal(value: Literal) -> str:
    """Python literal with double quotes where that needs no further escapes.

    >>> literal(("a", 1, None, ("b",)))
    '("a", 1, None, ("b",))'
    """
    if isinstance(value, str):
        text = repr(value)
        return text if '"' in text else f'"{text[1:-1]}"'
    if isinstance(value, tuple):
        return f"({', '.join(map(literal, value))}{',' if len(value) == 1 else ''})"
    return repr(value)


def fill(row: Iterable[Literal], width: int = WIDTH - 8) -> tuple[str, ...]:
    """Elements of a row as literals, each with its comma, filled into lines; a tuple too long for one is opened up."""
    lines: list[str] = []
    plain: list[str] = []
    for element in row:
        text = f"{literal(element)},"
        if isinstance(element, tuple) and len(text) > width:
            lines += [*wrap(plain, width), "(", *(f"    {line}" for line in fill(element, width - 4)), "),"]
            plain = []
        else:
            plain.append(text)
    return (*lines, *wrap(plain, width))


def wrap(words: Iterable[str], width: int) -> tuple[str, ...]:
    """Words joined by blanks into lines of at most ``width`` characters."""
    lines: list[str] = []
    for word in words:
        if lines and len(lines[-1]) + 1 + len(word) <= width:
            lines[-1] += " " + word
        else:
            lines.append(word)
    return tuple(lines)


def doc(*paragraphs: str) -> tuple[str, ...]:
    """Lines of a docstring: the paragraphs that are not empty, the first set off by an empty line."""
    texts = [text.replace("\\", "\\\\").replace('"""', '\\"\\"\\"') for text in paragraphs if text]
    first, *rest = (wrap(text.split(), WIDTH - 8) for text in texts)
    lines = [*first, *([""] if rest else []), *(line for part in rest for line in part)]
    return tuple(lines)


def manual_text(manual: Manual) -> str:
    """Title and edition."""
    return f"{manual.title}, edition {manual.edition}"


def index_text(entry: DictionaryObject) -> str:
    """Index as a literal, of PROFIdrive the decimal parameter number."""
    return f"0x{entry.index:04X}" if entry.kind == "canopen" else str(entry.index)


def access_text(access: Access) -> str:
    """What may be done with a code."""
    ways = [way for way, open_ in (("read", access.read), ("write", access.write)) if open_]
    return " and ".join(ways) or "no access"


def number_text(value: Fraction | int, shape: DataType | None) -> str:
    """Number as text; hexadecimal in the width of ``shape``, otherwise decimal."""
    number = Fraction(value)
    if number.denominator > 1:
        return str(Decimal(number.numerator) / Decimal(number.denominator))
    if shape is None or number < 0:
        return str(number.numerator)
    return f"0x{number.numerator:0{shape.bits // 4}X}"


def range_text(limits: Range, shape: DataType | None) -> str:
    """Range with its unit; ``shape`` as for ``number_text``."""
    return f"{number_text(limits.low, shape)} ... {number_text(limits.high, shape)} {limits.unit}".rstrip()


def default_text(default: Default, shape: DataType | None) -> str:
    """A default; ``shape`` as for ``number_text``."""
    if isinstance(default, NodeRelative):
        return f"$NODEID + 0x{default.base:X}"
    return number_text(default, shape) if isinstance(default, int) else f'"{default}"'


def refs_text(refs: Sequence[CodeRef]) -> str:
    """References to codes; a run of subcodes as the manuals write it.

    >>> refs_text([CodeRef(13613, 1), CodeRef(13613, 2), CodeRef(13613, 3), CodeRef(13614)])
    'C13613/1...3, C13614'
    """
    runs: list[tuple[CodeRef, CodeRef]] = []
    for ref in refs:
        if runs and ref.subcode is not None and runs[-1][1] == CodeRef(ref.number, ref.subcode - 1):
            runs[-1] = (runs[-1][0], ref)
        else:
            runs.append((ref, ref))
    return ", ".join(str(first) if first == last else f"{first}...{last.subcode}" for first, last in runs)
