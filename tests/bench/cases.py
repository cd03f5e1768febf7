"""Lists of error numbers to look up: those of the devices, and one of the size that makes the ways differ."""

import random
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import groupby
from pathlib import Path

from generator.model import Device, Model

MODULES = 20
"""Modules of the large list; each has ``IDS`` numbers, built as the drive builds them."""
IDS = 25
KEYS = 1 << 16
"""Numbers of a measurement: more than a branch predictor learns by heart."""
PROBES = 1 << 18
"""Random numbers that all ways have to agree on."""


@dataclass(frozen=True, slots=True)
class Case:
    """Errors of one kind of one device, in the order of their numbers; ``mask`` are the bits that tell which it is."""

    device: str
    kind: str
    mask: int
    runs: tuple[tuple[int, int], ...]

    @property
    def name(self) -> str:
        """Name of its files."""
        return f"{self.device}_{self.kind}"

    @property
    def numbers(self) -> list[tuple[int, int]]:
        """Each number with the place of its record."""
        return [(n, place) for place, (first, last) in enumerate(self.runs) for n in range(first, last + 1)]

    @property
    def title(self) -> str:
        """What a table calls it."""
        return f"{self.device} {self.kind}: {len(self.runs)} records, {len(self.numbers)} numbers"

    def write(self, folder: Path) -> None:
        """The numbers to look up, in files of 32-bit words: ``hits``, ``mixed`` (half of them misses), ``probes``."""
        rng = random.Random(self.name)
        hits = [number for number, _ in self.numbers]
        known = set(hits)
        near = {(n + step) & self.mask for n in hits for step in (1, -1, 1 << 8, 1 << 16)} - known
        far = {rng.getrandbits(32) & self.mask for _ in range(len(hits))} - known
        misses = sorted(near | far)
        pick = [rng.choice(hits) for _ in range(KEYS)]
        mixed = [rng.choice(hits if rng.random() < 0.5 else misses) for _ in range(KEYS)]
        probes = [*hits, *misses, *(rng.getrandbits(32) for _ in range(PROBES))]
        for name, words in (("hits", pick), ("mixed", mixed), ("probes", probes)):
            (folder / name).write_bytes(b"".join(word.to_bytes(4, "little") for word in words))


def with_large_list(model: Model) -> Model:
    """The model and a device with as many error numbers as a whole drive has, clustered by module."""
    like = next(d for d in model.devices if d.drive and any(error.kind == "device" for error in d.errors))
    error = next(error for error in like.errors if error.kind == "device")
    assert like.drive is not None
    fields = dict(like.drive.error_fields)
    first = error.number & fields["module"].mask
    numbers = [first + (module << fields["module"].low) + id for module in range(MODULES) for id in range(IDS)]
    errors = tuple(replace(error, number=n, last=n, name=f"Error {n}", adjustable_in=(), errata=()) for n in numbers)
    large = replace(
        like,
        id="large",
        errors=errors,
        slots=(),
        canopen=None,
        gsd=None,
        attributes=None,
        codes=(),
        objects=(),
        indicators=(),
        switches=(),
        tables=(),
        formulas=(),
        layouts=(),
        examples=(),
        errata=(),
    )
    return replace(model, devices=(*model.devices, large))


def cases(model: Model) -> Iterator[Case]:
    """Every kind of every device that has more than one record, the kinds of a device by name."""
    for device in model.devices:
        errors = sorted(device.errors, key=lambda error: (error.kind, error.number))
        for kind, group in groupby(errors, key=lambda error: error.kind):
            runs = tuple((error.number, error.last) for error in group)
            if len(runs) > 1:
                yield Case(device.id, kind, _mask(device, kind), runs)


def _mask(device: Device, kind: str) -> int:
    return (device.error_mask if kind == "device" else 0) or 0xFFFF_FFFF
