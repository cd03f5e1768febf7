"""Public names of a release, which programs use."""

from dataclasses import dataclass

from generator.model.citation import Where


@dataclass(frozen=True, slots=True)
class Pin:
    """A name of ``device`` in the release ``version``, and the number that it stands for."""

    version: str
    device: str
    name: str
    number: int
    where: Where
