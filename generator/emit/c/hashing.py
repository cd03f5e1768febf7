"""A perfect hash of 32-bit keys: two multiplications and two small tables find the one place of a key."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count

_BITS = 32
_WORD = (1 << _BITS) - 1
GOLDEN = 0x9E3779B1
"""Odd, without a pattern in its bits (2**32 over the golden ratio)."""
_SEEDS = 256
_PER_BUCKET = 3
_EMPTY = -1


@dataclass(frozen=True, slots=True)
class PerfectHash:
    """Bucket of a key: ``key * first`` above ``bucket_shift``; its place by the bucket's seed likewise.

    ``places`` holds for each slot the number of its key; 0 for an empty one, where no key of the table leads.
    """

    first: int
    second: int
    bucket_shift: int
    slot_shift: int
    seeds: tuple[int, ...]
    places: tuple[int, ...]

    def find(self, key: int) -> int:
        """Number of the one key that can be ``key``."""
        seed = self.seeds[_scatter(key, self.first) >> self.bucket_shift]
        return self.places[_scatter(_mixed(key), self.second + 2 * seed) >> self.slot_shift]


def mixed_kind(kind: int, number: int) -> int:
    """Key of a number of a kind."""
    return number ^ _scatter(kind, GOLDEN)


def perfect_hash(keys: Sequence[int]) -> PerfectHash:
    """Hash of distinct keys, the same each time.

    Raises:
        ValueError: A key stands twice, or there is none.
    """
    if not keys or len(set(keys)) != len(keys):
        raise ValueError("a perfect hash takes distinct keys")
    least = max(1, (len(keys) - 1).bit_length())
    bucket_bits = max(1, (len(keys) // _PER_BUCKET).bit_length())
    for attempt in count():
        found = _try(keys, GOLDEN + 2 * attempt, bucket_bits, least + attempt // 4)
        if found is not None:
            return found
    raise AssertionError


def _try(keys: Sequence[int], first: int, bucket_bits: int, slot_bits: int) -> PerfectHash | None:
    second = (first * GOLDEN) & _WORD | 1
    bucket_shift, slot_shift = _BITS - bucket_bits, _BITS - slot_bits
    buckets: list[list[int]] = [[] for _ in range(1 << bucket_bits)]
    for number, key in enumerate(keys):
        buckets[_scatter(key, first) >> bucket_shift].append(number)
    places = [_EMPTY] * (1 << slot_bits)
    seeds = [0] * len(buckets)
    for bucket in sorted(range(len(buckets)), key=lambda number: -len(buckets[number])):
        mixed = [_mixed(keys[number]) for number in buckets[bucket]]
        for seed in range(_SEEDS):
            slots = {_scatter(key, second + 2 * seed) >> slot_shift for key in mixed}
            if len(slots) == len(mixed) and all(places[slot] == _EMPTY for slot in slots):
                break
        else:
            return None
        seeds[bucket] = seed
        for number, key in zip(buckets[bucket], mixed, strict=True):
            places[_scatter(key, second + 2 * seed) >> slot_shift] = number
    return PerfectHash(first, second, bucket_shift, slot_shift, tuple(seeds), tuple(max(place, 0) for place in places))


def _scatter(key: int, factor: int) -> int:
    return key * factor & _WORD


def _mixed(key: int) -> int:
    return key ^ key >> 15
