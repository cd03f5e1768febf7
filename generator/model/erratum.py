"""The ledger of what the manuals print wrong."""

from collections.abc import Callable
from dataclasses import dataclass

from generator.model.citation import Where
from generator.model.reference import CodeRef, ErrorRef, ObjectRef

Subject = CodeRef | ObjectRef | ErrorRef | str
"""What an erratum or a finding concerns; text for things that have a name alone ("table:baud-rates")."""


@dataclass(frozen=True, slots=True)
class ErratumPlace:
    """A place and what stands there."""

    location: str
    page: int | None
    manual: str
    printed: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Erratum:
    """An entry of the ledger.

    With ``rule`` it explains findings of that check: those whose subject is in ``about``, whose place begins with
    ``place``, whose printed value is ``printed`` and whose expected value is ``used``.  ``printed`` and ``used``
    are functions of the variables "code", "index" and "number" where the ledger gives a formula (for a literal
    they return it).  Without ``rule`` it records what a reader found, in ``places``.
    """

    id: str
    kind: str
    rule: str | None
    about: tuple[Subject, ...]
    about_text: tuple[str, ...]
    place: tuple[str, ...]
    printed: Callable[[dict[str, int]], int | str] | None
    printed_text: str
    used: Callable[[dict[str, int]], int | str]
    used_text: str
    places: tuple[ErratumPlace, ...]
    why: str
    confidence: str
    origin: str
    where: Where
