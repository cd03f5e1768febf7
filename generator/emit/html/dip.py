"""DIP switches to be set in the reference: drawings of their blocks, and what every position of them means."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import product

from generator.emit.html.links import Links
from generator.emit.html.places import switch_row_id
from generator.emit.html.text import Piece, Prose, between, joined
from generator.emit.switches import stand
from generator.model import SwitchGroup


class Case(Enum):
    """What a position of the switches is; the readings of one case are told in the same sentence."""

    NUMBER = "number"
    """A printed row whose value is a number."""
    WORD = "word"
    """A printed row whose value is none."""
    SUM = "sum"
    """A valid sum without a row."""
    CODE = "code"
    """Left to a code."""
    CODE_INVALID = "code-invalid"
    """Left to a code; the sum is not valid either."""
    INVALID = "invalid"
    """No valid sum."""
    NONE = "none"
    """Nothing is known of it."""


@dataclass(frozen=True, slots=True)
class Reading:
    """What a position of the switches means; ``anchor`` is that of its printed row, "" without one."""

    case: Case
    value: str
    anchor: str


@dataclass(frozen=True, slots=True)
class Switch:
    """A switch: its label, whether it is drawn ON, and the word for that."""

    label: str
    on: bool
    word: str


@dataclass(frozen=True, slots=True)
class Outcome:
    """Sentence on the positions of a case; scripts put the value and the link of a reading into it."""

    case: str
    text: Prose


@dataclass(frozen=True, slots=True)
class Bank:
    """The switches of a group as they are drawn at first.

    ``low`` and ``high``: limits of values that are typed, "" without; ``choices``: values to choose from where they
    are no sums.  ``delivered``: the position of a new module in words, "" where the manual does not say it.
    """

    id: str
    name: str
    label: str
    switches: tuple[Switch, ...]
    reading: Prose
    outcomes: tuple[Outcome, ...]
    limits: str
    low: str
    high: str
    choices: tuple[str, ...]
    delivered: str


@dataclass(frozen=True, slots=True)
class Board:
    """A block of switches; ``data`` holds the first position and every reading of each bank for scripts."""

    id: str
    title: str
    banks: tuple[Bank, ...]
    data: dict[str, object]


def boards(links: Links, groups: Sequence[SwitchGroup]) -> tuple[Board, ...]:
    """Drawings of the blocks of a device; a group of which no block is known stands alone."""
    blocks: dict[tuple[str, str], list[SwitchGroup]] = {}
    for group in groups:
        blocks.setdefault(("block", group.block.label) if group.block else ("group", group.name), []).append(group)
    return tuple(
        Board(
            id=f"board-{number}",
            title=f"Set the switches: {label}",
            banks=tuple(_bank(links, group) for group in found),
            data={group.id: _data(group) for group in found},
        )
        for number, ((_, label), found) in enumerate(blocks.items(), 1)
    )


def read(group: SwitchGroup, positions: str) -> Reading:
    """What the switches mean in ``positions``, "1" or "0" for each."""
    row = next((row for row in group.rows if row.fits(positions)), None)
    total = group.sum(positions) if group.weights else None
    valid = total is not None and (group.valid is None or group.valid[0] <= total <= group.valid[1])
    value = "" if total is None else str(total)
    anchor = switch_row_id(group, row) if row else ""
    if group.code_decides(positions):
        return Reading(Case.CODE if valid or total is None else Case.CODE_INVALID, value, anchor)
    if row:
        return Reading(Case.NUMBER if row.value.isdecimal() else Case.WORD, row.value, anchor)
    if total is None:
        return Reading(Case.NONE, value, anchor)
    return Reading(Case.SUM if valid else Case.INVALID, value, anchor)


def _readings(group: SwitchGroup) -> Iterator[tuple[str, Reading]]:
    for signs in product("01", repeat=len(group.labels)):
        positions = "".join(signs)
        yield positions, read(group, positions)


def _first(group: SwitchGroup) -> str:
    """Position drawn at first: that of a new module, else all OFF."""
    return group.delivered.positions if group.delivered else "0" * len(group.labels)


def _data(group: SwitchGroup) -> dict[str, object]:
    readings = {positions: (it.case.value, it.value, it.anchor) for positions, it in _readings(group)}
    return {"first": _first(group), "readings": readings}


def _bank(links: Links, group: SwitchGroup) -> Bank:
    first = _first(group)
    readings = [it for _, it in _readings(group)]
    chosen = [it.value for it in readings if it.case in (Case.NUMBER, Case.WORD)]
    low, high = map(str, group.valid) if group.valid else ("", "")
    return Bank(
        id=group.id,
        name=group.name,
        label=f"Value [{group.unit}]" if group.unit else "Value",
        switches=tuple(
            Switch(label, sign == "1", "ON" if sign == "1" else "off")
            for label, sign in zip(group.labels, first, strict=True)
        ),
        reading=_sentence(links, group, read(group, first)),
        outcomes=tuple(
            Outcome(case.value, _sentence(links, group, it)) for case, it in {it.case: it for it in readings}.items()
        ),
        limits=_limits(group),
        low=low,
        high=high,
        choices=() if group.weights else tuple(row.value for row in group.rows if row.value in chosen),
        delivered=stand(group, first) if group.delivered else "",
    )


def _limits(group: SwitchGroup) -> str:
    return between(*map(str, group.valid)) if group.valid else ""


def _sentence(links: Links, group: SwitchGroup, reading: Reading) -> Prose:
    figure = Piece(reading.value, tag="b", css="value")
    linked = Piece(reading.value, f"#{reading.anchor}", "b", "value")
    invalid = f" is not valid ({_limits(group)})" if group.valid else " is not valid"
    codes = joined([(links.code(ref),) for ref in (group.code_counts.codes if group.code_counts else ())], " / ")
    match reading.case:
        case Case.NUMBER:
            return (linked, f" {group.unit}") if group.unit else (linked,)
        case Case.WORD:
            return (linked,)
        case Case.SUM:
            return figure, ", the sum of the switches; no row is printed for it"
        case Case.CODE:
            return (*codes, " counts instead of the switches")
        case Case.CODE_INVALID:
            return (figure, f"{invalid}: ", *codes, " counts instead of the switches")
        case Case.INVALID:
            return figure, invalid
        case Case.NONE:
            return "The manual gives this position no meaning"
