"""The tables of the other ways: an index by arithmetic, and a two-level hash with a displacement for each bucket."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count

_WORD = 0xFFFF_FFFF
_GOLDEN = 0x9E37_79B1
_LARGEST = 4096
"""Places of an arithmetic index; numbers that need more are too far apart for it."""


@dataclass(frozen=True, slots=True)
class Direct:
    """Pages of ``1 << shift`` numbers from page ``first`` on: where each begins in ``places``, and how many it has.

    ``places`` holds the places of records, ``none`` where there is none.
    """

    shift: int
    first: int
    pages: tuple[tuple[int, int], ...]
    places: tuple[int, ...]
    none: int

    @property
    def mask(self) -> int:
        """Bits of a number within its page."""
        return (1 << self.shift) - 1


def direct(numbers: Sequence[tuple[int, int]], records: int) -> Direct | None:
    """The smallest arithmetic index, ``None`` where the numbers are too far apart."""
    best: Direct | None = None
    for shift in range(1, 33):
        first, last = numbers[0][0] >> shift, numbers[-1][0] >> shift
        if last - first >= _LARGEST:
            continue
        rows: list[dict[int, int]] = [{} for _ in range(last - first + 1)]
        for number, place in numbers:
            rows[(number >> shift) - first][number & ((1 << shift) - 1)] = place
        if sum(max(row, default=-1) + 1 for row in rows) > _LARGEST:
            continue
        pages: list[tuple[int, int]] = []
        places: list[int] = []
        for row in rows:
            size = max(row, default=-1) + 1
            pages.append((len(places), size))
            places += [row.get(low, records) for low in range(size)]
        found = Direct(shift, first, tuple(pages), tuple(places), records)
        if best is None or _weight(found) < _weight(best):
            best = found
    return best


def _weight(index: Direct) -> int:
    return 2 * len(index.pages) + len(index.places)


@dataclass(frozen=True, slots=True)
class TwoLevel:
    """``displacements[n * first >> bucket_shift] + (n * second >> slot_shift)`` is the slot of a number."""

    first: int
    second: int
    bucket_shift: int
    slot_shift: int
    displacements: tuple[int, ...]
    places: tuple[int, ...]

    @property
    def mask(self) -> int:
        """Bits of a slot."""
        return len(self.places) - 1


def two_level(numbers: Sequence[tuple[int, int]]) -> TwoLevel:
    """Hash and displace: about two numbers a bucket, a table that is at least half full."""
    bits = max(1, (len(numbers) - 1).bit_length())
    for attempt in count():
        first = _GOLDEN * (2 * attempt + 1) & _WORD
        second = first * _GOLDEN & _WORD | 1
        found = _displace(numbers, first, second, max(1, bits - 1), bits + attempt // 16)
        if found is not None:
            return found
    raise AssertionError


def _displace(
    numbers: Sequence[tuple[int, int]], first: int, second: int, bucket_bits: int, slot_bits: int
) -> TwoLevel | None:
    size = 1 << slot_bits
    bucket_shift, slot_shift = 32 - bucket_bits, 32 - slot_bits
    buckets: list[list[tuple[int, int]]] = [[] for _ in range(1 << bucket_bits)]
    for number, place in numbers:
        buckets[(number * first & _WORD) >> bucket_shift].append(((number * second & _WORD) >> slot_shift, place))
    taken: dict[int, int] = {}
    displacements = [0] * len(buckets)
    for bucket in sorted(range(len(buckets)), key=lambda at: -len(buckets[at])):
        for displacement in range(size):
            slots = {(base + displacement) % size: place for base, place in buckets[bucket]}
            if len(slots) == len(buckets[bucket]) and not slots.keys() & taken.keys():
                break
        else:
            return None
        displacements[bucket] = displacement
        taken |= slots
    places = tuple(taken.get(slot, 0) for slot in range(size))
    return TwoLevel(first, second, bucket_shift, slot_shift, tuple(displacements), places)
