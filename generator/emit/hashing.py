"""Perfect hash of runs of 32-bit numbers: a multiplication and one or two small tables find the one place of a number.

Where the numbers allow it the multiplication is a shift or a sum of two shifts, which makes the hash the arithmetic
index of the numbers.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, count, pairwise

_BITS = 32
_WORD = (1 << _BITS) - 1
_GOLDEN = 0x9E3779B1
"""Odd, without a pattern in its bits (2**32 over the golden ratio)."""
_TRIES = 400
"""Factors without a pattern that are tried for each size of the table."""
_ROOM = 2
"""Bits that a table may have above the fewest before seeds are cheaper."""
_PER_BUCKET = 3
_SEEDS = 256
_LONGEST = 256
"""Numbers of a run that the table holds; longer runs are left to a comparison."""


@dataclass(frozen=True, slots=True)
class PerfectHash:
    """Slot of a number: ``number * factor`` above ``shift``, changed by the seed above ``seed_shift`` where seeds are.

    ``places`` holds for each slot the place of the one run that can hold the number, 0 where no run leads.
    ``long`` holds the places of the runs that have to be compared one by one.  ``first`` is the first number where
    there are no gaps: ``places`` then holds the place of each number in order, and all else is 0.
    """

    first: int | None

    factor: int
    shift: int
    seed_shift: int
    seeds: tuple[int, ...]
    places: tuple[int, ...]
    long: tuple[int, ...]

    def find(self, number: int) -> int:
        """Place of the one run in the table that can hold the number."""
        if self.first is not None:
            return self.places[min(number - self.first & _WORD, len(self.places) - 1)]
        scattered = _scatter(number, self.factor)
        seed = self.seeds[scattered >> self.seed_shift] if self.seeds else 0
        return self.places[_slot(scattered, self.shift, seed, len(self.places))]


def perfect_hash(runs: Sequence[tuple[int, int]]) -> PerfectHash:
    """Hash of the first and last numbers of runs, the same each time.

    Raises:
        ValueError: There is no run, one descends, or two overlap.
    """
    ordered = sorted(runs)
    if not runs or any(first > last for first, last in runs):
        raise ValueError("a perfect hash takes ascending runs")
    if any(last >= first for (_, last), (first, _) in pairwise(ordered)):
        raise ValueError("a perfect hash takes distinct numbers")
    long = tuple(place for place, (first, last) in enumerate(runs) if last - first >= _LONGEST)
    keys = [
        (number, place)
        for place, (first, last) in enumerate(runs)
        if place not in long
        for number in range(first, last + 1)
    ]
    return _without_gaps(keys, long) or _arithmetic(keys, long) or _seeded(keys, long)


def _without_gaps(keys: Sequence[tuple[int, int]], long: tuple[int, ...]) -> PerfectHash | None:
    ordered = sorted(keys)
    if long or ordered[-1][0] - ordered[0][0] >= len(ordered):
        return None
    return PerfectHash(ordered[0][0], 0, 0, 0, (), tuple(place for _, place in ordered), ())


def _arithmetic(keys: Sequence[tuple[int, int]], long: tuple[int, ...]) -> PerfectHash | None:
    """Hash without seeds, in the smallest table that there is one for."""
    least = max(1, (len({place for _, place in keys}) - 1).bit_length())
    most = max(1, (len(keys) - 1).bit_length()) + _ROOM
    for bits in range(least, most + 1):
        for factor in _factors():
            shift = _BITS - bits
            slots: dict[int, int] = {}
            if all(slots.setdefault(_scatter(key, factor) >> shift, place) == place for key, place in keys):
                return PerfectHash(None, factor, shift, 0, (), _filled(slots, bits), long)
    return None


def _factors() -> Iterator[int]:
    """Factors that a processor multiplies by cheaply come first."""
    powers = [1 << bit for bit in reversed(range(_BITS))]
    yield from powers
    yield from (one + other for one, other in combinations(powers, 2))
    yield from (_scatter(_GOLDEN, 2 * attempt + 1) for attempt in range(_TRIES))


def _seeded(keys: Sequence[tuple[int, int]], long: tuple[int, ...]) -> PerfectHash:
    bits = max(1, (len(keys) - 1).bit_length())
    seed_bits = max(1, (len(keys) // _PER_BUCKET).bit_length())
    for attempt in count():
        found = _try_seeds(keys, long, _scatter(_GOLDEN, 2 * attempt + 1), bits + attempt // 8, seed_bits)
        if found is not None:
            return found
    raise AssertionError


def _try_seeds(
    keys: Sequence[tuple[int, int]], long: tuple[int, ...], factor: int, bits: int, seed_bits: int
) -> PerfectHash | None:
    # The slot is taken from below the bits that choose the seed, so that a seed parts what shares one.
    seed_shift = _BITS - seed_bits
    shift = max(0, seed_shift - bits)
    size = 1 << bits
    buckets: list[list[tuple[int, int]]] = [[] for _ in range(1 << seed_bits)]
    for key, place in keys:
        scattered = _scatter(key, factor)
        buckets[scattered >> seed_shift].append((scattered, place))
    slots: dict[int, int] = {}
    seeds = [0] * len(buckets)
    for bucket in sorted(range(len(buckets)), key=lambda number: -len(buckets[number])):
        for seed in range(min(size, _SEEDS)):
            taken: dict[int, int] = {}
            for scattered, place in buckets[bucket]:
                slot = _slot(scattered, shift, seed, size)
                if slots.get(slot, place) != place or taken.setdefault(slot, place) != place:
                    break
            else:
                break
        else:
            return None
        seeds[bucket] = seed
        slots |= taken
    return PerfectHash(None, factor, shift, seed_shift, tuple(seeds), _filled(slots, bits), long)


def _filled(slots: dict[int, int], bits: int) -> tuple[int, ...]:
    return tuple(slots.get(slot, 0) for slot in range(1 << bits))


def _slot(scattered: int, shift: int, seed: int, size: int) -> int:
    return (scattered >> shift ^ seed) & (size - 1)


def _scatter(number: int, factor: int) -> int:
    return number * factor & _WORD
