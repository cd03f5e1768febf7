"""Figures and prose as text of a page."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from generator.model import DataType, Default, NodeRelative, Origin, Range
from generator.model.citation import UNNAMED
from generator.model.telegram import OPEN

NONE = "\N{EN DASH}"
"""Stands where the manual says nothing."""

ELLIPSIS = "\N{HORIZONTAL ELLIPSIS}"
"""Stands between the ends of a run or range."""

INDEX = "index.html"
"""First page."""

COVERAGE = "coverage.html"
"""Page of the sources."""

CONTENTS = "contents.html"
"""Page that lists everything, device by device."""

DOWNLOADS = "downloads.html"
"""Page of all files to take away."""

ERRATA = "errata.html"
"""Page of the errata of all manuals."""

NOT_FOUND = "404.html"
"""Page that a host shows for addresses that lead nowhere."""

_NO_BREAK = "\N{NO-BREAK SPACE}"

_ORIGINS = {
    Origin.STANDARD: "from a standard",
    Origin.DERIVED: "derived",
    Origin.ASSUMED: "assumed",
    Origin.PUBLIC: "from a public document",
}
_REFERENCE = re.compile(r"\b(?:C\d{5}(?:/\d+)?|I-[0-9A-F]{4}(?:/\d+)?)\b")


@dataclass(frozen=True, slots=True)
class Piece:
    """A piece of running text that leads somewhere, or that a text-level element sets apart; "" for neither.

    ``css`` holds classes of that element.
    """

    text: str
    href: str = ""
    tag: str = ""
    css: str = ""


Prose = str | tuple[str | Piece, ...]
"""Running text, either plain or in pieces, of which the plain ones are strings."""


def noted(text: str, note: str) -> Prose:
    """Text with a note in a weaker voice after it."""
    return (text, " ", Piece(note, tag="small")) if note else text


def joined(parts: Sequence[Prose], separator: str = ", ") -> tuple[str | Piece, ...]:
    """Parts with a separator between them."""
    pieces: list[str | Piece] = []
    for part in parts:
        if pieces:
            pieces.append(separator)
        pieces += (part,) if isinstance(part, str) else part
    return tuple(pieces)


def between(low: str, high: str) -> str:
    """Both ends of a range, kept on one line."""
    return f"{low}{_NO_BREAK}{ELLIPSIS}{_NO_BREAK}{high}"


def through(first: str, last: str) -> str:
    """Both ends of a run; of a single thing the thing alone."""
    return first if first == last else between(first, last)


def decimal(value: int | Fraction) -> str:
    """Number in decimal notation; a fraction that has no finite one as numerator/denominator.

    >>> decimal(Fraction(-5, 4)), decimal(1000), decimal(Fraction(1, 3))
    ('-1.25', '1000', '1/3')
    """
    if value.denominator == 1:
        return str(value)
    exact = Fraction(value)
    places = 0
    while 10**places % exact.denominator and places < exact.denominator.bit_length():
        places += 1
    if 10**places % exact.denominator:
        return str(exact)
    digits = str(abs(exact.numerator) * 10**places // exact.denominator).rjust(places + 1, "0")
    whole, fraction = digits[: len(digits) - places], digits[len(digits) - places :]
    return ("-" if exact < 0 else "") + whole + ("." + fraction if fraction else "")


def hexadecimal(value: int, bits: int = 8) -> str:
    """Number in hexadecimal, with leading zeros for a width of ``bits``.

    >>> hexadecimal(0x601, 32), hexadecimal(-1, 8)
    ('0x00000601', '-0x01')
    """
    return f"{'-' if value < 0 else ''}0x{abs(value):0{bits // 4}X}"


def octets(data: Sequence[int | None]) -> str:
    """Bytes in hexadecimal, those left open as the manuals mark them.

    >>> octets((0x40, None))
    '40 XX'
    """
    return " ".join(OPEN if octet is None else f"{octet:02X}" for octet in data)


def quoted(text: str) -> str:
    """Text in quotes."""
    return f"\N{LEFT DOUBLE QUOTATION MARK}{text}\N{RIGHT DOUBLE QUOTATION MARK}"


def shown_range(bounds: Range | None, data_type: DataType, in_hex: bool) -> str:
    """Range with its unit; bit-coded values in hexadecimal."""
    if bounds is None:
        return ""
    ends = [
        hexadecimal(int(end), data_type.bits) if in_hex and end.denominator == 1 else decimal(end)
        for end in (bounds.low, bounds.high)
    ]
    return between(*ends) + (f"{_NO_BREAK}{bounds.unit}" if bounds.unit else "")


def shown_default(default: Default | None, data_type: DataType, in_hex: bool) -> str:
    """Default as text: bit-coded values in hexadecimal, strings in quotes, "" where there is none."""
    match default:
        case None:
            return ""
        case NodeRelative(base):
            return f"node address +{_NO_BREAK}{hexadecimal(base, 12)}"
        case int():
            return hexadecimal(default, data_type.bits) if in_hex else decimal(default)
        case str():
            return quoted(default)


def shown_origin(origin: Origin) -> str:
    """Mark of facts that the manual cited does not print; "" for those that it does."""
    return _ORIGINS.get(origin, "")


def place_of(chapter: str, page: int | None) -> str:
    """Place in a manual, "ch. 13.2, p. 114"; ``chapter`` is "" or ``UNNAMED`` where only the page is known."""
    parts = (f"ch. {chapter}" if chapter not in ("", UNNAMED) else "", f"p. {page}" if page is not None else "")
    return ", ".join(part for part in parts if part)


def manual_id(manual: str) -> str:
    """Anchor of a manual on the page of sources and on the first page."""
    return f"manual-{manual}"


def manual_link(manual: str) -> Piece:
    """Link to what the page of sources tells of a manual."""
    return Piece(manual, f"{COVERAGE}#{manual_id(manual)}", "cite")


def plain(text: Prose) -> str:
    """Running text without its links."""
    return text if isinstance(text, str) else "".join(p if isinstance(p, str) else p.text for p in text)


def prose(text: str, resolve: Callable[[str], Piece]) -> Prose:
    """Running text in pieces; ``resolve`` finds where a reference in it leads."""
    pieces: list[str | Piece] = []
    end = 0
    for match in _REFERENCE.finditer(text):
        if match.start() > end:
            pieces.append(text[end : match.start()])
        pieces.append(resolve(match.group()))
        end = match.end()
    if not pieces:
        return text
    return (*pieces, text[end:]) if end < len(text) else tuple(pieces)
