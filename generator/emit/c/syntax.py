"""C99 text: integer constants for every width of int, string literals, comments."""

import re
import unicodedata
from fractions import Fraction
from functools import cache

_WIDTHS = (8, 16, 32, 64)
_INT_BITS = 16
"""Width of int that C guarantees; wider constants need a macro of <stdint.h>."""
_LINE = 116
"""Characters of a comment line after its " * "."""
_PLAIN = str.maketrans(
    {
        "\N{MICRO SIGN}": "u",
        "\N{GREEK SMALL LETTER MU}": "u",
        "\N{DEGREE SIGN}": "deg ",
        "\N{GREEK CAPITAL LETTER OMEGA}": "ohm",
        "\N{LATIN SMALL LETTER SHARP S}": "ss",
        "\N{REGISTERED SIGN}": "(R)",
        "\N{TRADE MARK SIGN}": "(TM)",
        "\N{EN DASH}": "-",
        "\N{EM DASH}": "-",
        "\N{MINUS SIGN}": "-",
        "\N{HORIZONTAL ELLIPSIS}": "...",
        "\N{RIGHTWARDS ARROW}": "->",
        "\N{LESS-THAN OR EQUAL TO}": "<=",
        "\N{GREATER-THAN OR EQUAL TO}": ">=",
        "\N{MULTIPLICATION SIGN}": "x",
        "\N{MIDDLE DOT}": "*",
        "\N{LEFT SINGLE QUOTATION MARK}": "'",
        "\N{RIGHT SINGLE QUOTATION MARK}": "'",
        "\N{LEFT DOUBLE QUOTATION MARK}": '"',
        "\N{RIGHT DOUBLE QUOTATION MARK}": '"',
        "\N{DOUBLE LOW-9 QUOTATION MARK}": '"',
        "\N{LEFT-POINTING DOUBLE ANGLE QUOTATION MARK}": '"',
        "\N{RIGHT-POINTING DOUBLE ANGLE QUOTATION MARK}": '"',
    }
)
_UNSAFE = re.compile(r"[\\@]|<(?=[A-Za-z/])")
_CONTROL = re.compile(r"[\x00-\x1f\x7f]")


@cache
def ascii_text(text: str) -> str:
    r"""``text`` in ASCII: known signs by their usual spelling, letters without marks, others as ``\uXXXX``.

    >>> ascii_text("150 µs … größer")
    '150 us ... grosser'
    """
    if text.isascii():
        return text
    plain = unicodedata.normalize("NFKD", text.translate(_PLAIN))
    return "".join(c for c in plain if not unicodedata.combining(c)).encode("ascii", "backslashreplace").decode("ascii")


def integer(value: int, bits: int, *, signed: bool = False, hexadecimal: bool = False) -> str:
    """Integer constant of at least ``bits`` bits, wider where the value needs it; right where int has 16 bits too.

    >>> integer(254, 8), integer(0x181, 32, hexadecimal=True), integer(-5, 16, signed=True)
    ('254u', 'UINT32_C(0x00000181)', '(-5)')
    >>> integer(-(2**31), 32, signed=True), integer(7, 32, signed=True)
    ('(-INT32_C(2147483647) - 1)', 'INT32_C(7)')

    Raises:
        ValueError: The value needs more than 64 bits.
    """
    signed = signed or value < 0
    bits = max(bits, _needed(value, signed))
    if not signed:
        digits = f"0x{value:0{bits // 4}X}" if hexadecimal else str(value)
        return f"{digits}u" if bits <= _INT_BITS else f"UINT{bits}_C({digits})"
    if value >= 0:
        return _magnitude(value, bits)
    if value == -(1 << (bits - 1)):
        return f"(-{_magnitude(-value - 1, bits)} - 1)"
    return f"(-{_magnitude(-value, bits)})"


def _needed(value: int, signed: bool) -> int:
    for bits in _WIDTHS:
        low, high = (-(1 << (bits - 1)), (1 << (bits - 1)) - 1) if signed else (0, (1 << bits) - 1)
        if low <= value <= high:
            return bits
    raise ValueError(f"{value} needs more than {_WIDTHS[-1]} bits")


def _magnitude(value: int, bits: int) -> str:
    return str(value) if bits <= _INT_BITS else f"INT{bits}_C({value})"


def fits_int(value: int) -> bool:
    """Whether every C compiler has the value in an int, and so in an enumeration constant."""
    return -(1 << (_INT_BITS - 1)) < value < 1 << (_INT_BITS - 1)


def string(text: str) -> str:
    r"""String literal of the text in ASCII.

    >>> print(string('say "a\\b"??'))
    "say \"a\\b\"\?\?"
    """
    escaped = ascii_text(text).replace("\\", "\\\\").replace('"', '\\"').replace("??", "\\?\\?")
    return '"' + _CONTROL.sub(lambda match: f"\\{ord(match.group()):03o}", escaped) + '"'


def text_size(text: str) -> int:
    """Bytes of the string literal of the text, with its end."""
    return len(ascii_text(text)) + 1


@cache
def comment(text: str) -> str:
    r"""One line of text for a comment that Doxygen reads: nothing ends the comment, splices lines or is a command.

    >>> comment("µs */ user@host <b> <= ??/")
    'us * / user\\@host \\<b> <= ? ?/'
    """
    line = " ".join(ascii_text(text).split()).replace("*/", "* /").replace("/*", "/ *").replace("??", "? ?")
    line = _UNSAFE.sub(r"\\\g<0>", line)
    return line + "." if line.endswith("\\") else line


def paragraph(text: str) -> tuple[str, ...]:
    """Lines of a block comment, without their " * "."""
    lines, line = [], ""
    for word in comment(text).split(" "):
        if line and len(line) + len(word) >= _LINE:
            lines.append(line)
            line = word
        else:
            line = f"{line} {word}" if line else word
    return (*lines, line)


def decimal(value: Fraction) -> str:
    """Decimal notation, or a quotient where there is none.

    >>> decimal(Fraction(3, 20)), decimal(Fraction(-7)), decimal(Fraction(1, 3))
    ('0.15', '-7', '1/3')
    """
    places = 0
    while (10**places) % value.denominator:
        places += 1
        if places > value.denominator.bit_length():
            return str(value)
    digits = f"{abs(value.numerator) * 10**places // value.denominator:0{places + 1}d}"
    sign = "-" if value < 0 else ""
    return sign + (f"{digits[:-places]}.{digits[-places:]}" if places else digits)
