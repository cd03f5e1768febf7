"""Drawings of connectors: the contacts where a standard puts them, with what the manual says they carry."""

from collections.abc import Iterator
from dataclasses import dataclass

from generator.emit.html.blocks import Contact, Drawing
from generator.emit.html.links import Links
from generator.emit.html.text import Piece, shown_origin
from generator.model import Origin
from generator.model.table import NOTHING_PRINTED, Assignment

_LETTER = 7.8
"""Width of a letter of the labels, for the most are capitals."""
_GAP = 12
"""Between neighbouring labels, and between a label and the shell."""
_NEAREST = 17
"""Half of the distance of two contacts at which their numbers can still be told apart."""
_LINE = 14
"""Height of a label."""
_EDGE = 1
"""Half of the line around the shell."""


@dataclass(frozen=True, slots=True)
class _Scale:
    """How far apart things are drawn from left to right; ``upright``: the labels stand on their ends."""

    half_pitch: float
    upright: bool
    longest: float


def drawing(links: Links, assignment: Assignment) -> Drawing:
    """The connector of an assignment as seen from the side that its standard names."""
    connector = assignment.connector
    scale = _scale(assignment)
    corners = [(right * scale.half_pitch, down * _NEAREST) for right, down in connector.outline]
    left, right = min(x for x, _ in corners), max(x for x, _ in corners)
    top, bottom = min(y for _, y in corners), max(y for _, y in corners)
    room = _GAP + (scale.longest if scale.upright else 2 * _LINE)
    below = room if len(_rows(assignment)) > 1 else _EDGE
    box = (left - _EDGE, top - room, right - left + 2 * _EDGE, bottom - top + room + below)
    mark = shown_origin(Origin.STANDARD)
    return Drawing(
        title=f"{connector.name}: the contacts and what they carry, as in the table",
        box=" ".join(map(_text, box)),
        width=_text(box[2]),
        outline=" ".join(f"{_text(x)},{_text(y)}" for x, y in corners),
        form=connector.form,
        contacts=tuple(_contacts(assignment, scale, top, bottom)),
        caption=(
            f"{connector.name}, seen {connector.seen}. How it sits on the device is not printed. Contacts: ",
            *links.source(connector.cite),
            " ",
            Piece(mark, tag="em"),
        ),
    )


def _scale(assignment: Assignment) -> _Scale:
    """The labels of one row stand on their ends; of two rows they lie, by turns near the shell and far from it."""
    longest = max(map(len, _carried(assignment).values()), default=0) * _LETTER
    if len(_rows(assignment)) == 1:
        return _Scale(_NEAREST, True, longest)
    return _Scale(max(_NEAREST, (longest + _GAP) / 4), False, longest)


def _carried(assignment: Assignment) -> dict[str, str]:
    """What the contacts that carry something carry, by number."""
    nothing = (NOTHING_PRINTED, *assignment.unused)
    return {str(pin): signal for pin, signal in assignment.signals if signal not in nothing}


def _rows(assignment: Assignment) -> list[int]:
    return sorted({contact.down for contact in assignment.connector.contacts})


def _contacts(assignment: Assignment, scale: _Scale, top: float, bottom: float) -> Iterator[Contact]:
    signals = _carried(assignment)
    upper, *lower = _rows(assignment)
    for down in (upper, *lower):
        row = [contact for contact in assignment.connector.contacts if contact.down == down]
        for place, contact in enumerate(sorted(row, key=lambda contact: contact.right)):
            away = 0 if scale.upright else _LINE * (place % 2)
            if down == upper:
                edge, label = top, top - _GAP / 2 - away
                end = label + _GAP / 4
            else:
                edge, label = bottom, bottom + _LINE + away
                end = label - _LINE + _GAP / 4
            yield Contact(
                x=_text(contact.right * scale.half_pitch),
                y=_text(down * _NEAREST),
                number=str(contact.number),
                signal=signals.get(str(contact.number), ""),
                label_y=_text(label),
                upright=scale.upright,
                leader=f"{_text(edge)}V{_text(end)}" if away else "",
            )


def _text(value: float) -> str:
    return f"{value:.1f}".removesuffix(".0")
