"""Selection lists, bits and bit fields as short lists, and runs of things that say the same."""

import re
from collections.abc import Callable, Sequence
from typing import TypeVar

from generator.emit.html.blocks import Item, ItemList
from generator.emit.html.text import Piece, hexadecimal, through
from generator.model import Bit, BitField, Default, Option

T = TypeVar("T")

_NUMBER = re.compile(r"(\d+)")
_SHORTEST_RUN = 3
_SHORTEST_PLAIN_RUN = 9
_WIDEST_COUNT = 0xFFFF
"""Greater values are identifiers rather than counts and read better in hexadecimal."""


def value_lists(
    options: Sequence[Option], default: Default | None, bits: Sequence[Bit], fields: Sequence[BitField]
) -> tuple[ItemList, ...]:
    """What the values of a code or sub-index mean, in the lists that are not empty."""
    if not (options or bits or fields):
        return ()
    lists = (
        ItemList("Selection list", tuple(_option(option, option.value == default) for option in options)),
        ItemList("Bits", tuple(_bits(bits))),
        ItemList("Bit fields", tuple(_item(through(str(f.low), str(f.high)), f.label) for f in fields)),
    )
    return tuple(found for found in lists if found.items)


def shortest_run(explained: bool) -> int:
    """How many rows that say the same are drawn together: many plain ones, few where each is ``explained`` below."""
    return _SHORTEST_RUN if explained else _SHORTEST_PLAIN_RUN


def _item(key: str, label: str) -> Item:
    return Item(Piece(key), label)


def _option(option: Option, preset: bool) -> Item:
    key = hexadecimal(option.value) if option.value > _WIDEST_COUNT else str(option.value)
    mark = (" ", Piece("default", tag="i")) if preset else ()
    return Item(Piece(key), (option.label, *mark))


def _bits(bits: Sequence[Bit]) -> list[Item]:
    """Bits by number; three and more whose labels are equal or count on are drawn together."""
    return [
        _item(through(str(run[0].number), str(run[-1].number)), from_to(run[0].label, run[-1].label))
        for run in runs(bits, _bit_goes_on, _SHORTEST_RUN)
    ]


def _bit_goes_on(first: Bit, other: Bit, step: int) -> bool:
    return other.number == first.number + step and counts_on(first.label, other.label, step)


def runs(items: Sequence[T], same: Callable[[T, T, int], bool], shortest: int = 1) -> list[list[T]]:
    """Items in runs; ``same`` compares the first of a run with one that stands so many places after it.

    Runs of less than ``shortest`` items fall apart.
    """
    result: list[list[T]] = []
    for item in items:
        if result and same(result[-1][0], item, len(result[-1])):
            result[-1].append(item)
        else:
            result.append([item])
    return [part for run in result for part in ([run] if len(run) >= shortest else [[item] for item in run])]


def counts_on(text: str, other: str, step: int) -> bool:
    """Whether texts are equal but for numbers that are ``step`` higher in the other.

    >>> counts_on("Mask for byte 1 of TPDO2", "Mask for byte 3 of TPDO2", 2)
    True
    """
    if text == other:
        return True
    ours, theirs = _NUMBER.split(text), _NUMBER.split(other)
    return len(ours) == len(theirs) and all(
        mine == its or (mine.isdecimal() and its.isdecimal() and int(its) == int(mine) + step)
        for mine, its in zip(ours, theirs, strict=True)
    )


def from_to(text: str, last: str) -> str:
    r"""First and last text of a run as one.

    >>> from_to("Mask bit 0", "Mask bit 7").replace("\N{NO-BREAK SPACE}", " ")
    'Mask bit 0 … 7'
    """
    if text == last:
        return text
    parts = zip(_NUMBER.split(text), _NUMBER.split(last), strict=True)
    return "".join(through(mine, its) for mine, its in parts)
