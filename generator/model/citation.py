"""Where a fact comes from: the source text (manual, chapter, page) and the line of spec that holds it."""

from dataclasses import dataclass
from enum import Enum


class Origin(Enum):
    """How a fact came to be known."""

    MANUAL = "manual"
    """Printed in the manual that the entry cites."""
    STANDARD = "standard"
    """Taken from a public standard such as CiA 301."""
    DERIVED = "derived"
    """Calculated from printed facts."""
    ASSUMED = "assumed"
    """Documented nowhere; a marked assumption."""
    PUBLIC = "public"
    """Printed in another public document."""


@dataclass(frozen=True, slots=True)
class Where:
    """Place in a source file; line and column count from 1, ``path`` is the way of keys that leads there."""

    file: str
    line: int
    column: int
    path: str = ""


UNNAMED = "X"
"""Chapter of a source that names none, or not on the pages that are at hand."""
ANYWHERE = ""
"""Chapter of a page that is given without one."""


@dataclass(frozen=True, slots=True)
class Cite:
    """Place in a manual: id of the manual, chapter as text, page as printed (``None`` where unknown)."""

    manual: str
    chapter: str
    page: int | None = None

    @property
    def place(self) -> str:
        """Chapter and page as far as they are known: "13.2 p. 114", "p. 201", ""."""
        parts = ("" if self.chapter == UNNAMED else self.chapter, "" if self.page is None else f"p. {self.page}")
        return " ".join(part for part in parts if part)

    def __str__(self) -> str:
        """Manual and place: "EDS94AYCCA-EN-5.0, 13.2 p. 114"."""
        return f"{self.manual}, {self.place}" if self.place else self.manual


@dataclass(frozen=True, slots=True)
class Cited:
    """A citation and where spec writes it; ``page_alone`` where manual and chapter stand elsewhere."""

    cite: Cite
    where: Where
    page_alone: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Chapter:
    """A chapter of a manual and what became of it (``status`` as in ``manual.schema.yaml``)."""

    number: str
    title: str
    page: int | None
    status: str | None
    note: str | None
    where: Where


@dataclass(frozen=True, slots=True, kw_only=True)
class Manual:
    """A source of facts; ``kind`` is "manual", "standard" or "public", ``date`` "yyyy-mm" as printed."""

    id: str
    title: str
    publisher: str
    edition: str
    date: str | None
    document: str | None
    kind: str
    url: str | None
    pages: int | None
    chapters: tuple[Chapter, ...]
    where: Where
