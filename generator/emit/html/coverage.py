"""Sources, and what became of each chapter of theirs."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from generator.emit.html.blocks import Fact, Row, Table
from generator.emit.html.text import COVERAGE, NONE, Piece, Prose, manual_id
from generator.model import Chapter, Device, Manual, Model

_KINDS = {"public": "public document"}
_TRANSCRIBED, _LOST, _PENDING = "transcribed", "lost", "pending"
_STATUSES = {
    _TRANSCRIBED: "transcribed",
    "not-applicable": "without facts of this kind",
    _LOST: "lost in the text dump",
    _PENDING: "not yet",
}
_COUNTS = ("Source", "Kind", "Title", "Chapters", "Transcribed", "Without facts", "Lost", "Not yet")
_CHAPTERS = ("Chapter", "Title", "Page", "State", "Note")
_LOST_CHAPTERS = ("Source", "Chapter", "Title", "Page")
_LISTED = ("Source", "Title", "Publisher", "Edition", "Date", "Chapters")
_WEB = ("https://", "http://")


@dataclass(frozen=True, slots=True)
class Source:
    """A manual, standard or public document with its chapters; ``tally`` sums up what became of them."""

    id: str
    name: str
    title: str
    facts: tuple[Fact, ...]
    tally: str
    chapters: Table


@dataclass(frozen=True, slots=True)
class Coverage:
    """All sources: their counts, what is lost, and each with its chapters."""

    counts: Table
    lost: Table
    sources: tuple[Source, ...]


def coverage(model: Model) -> Coverage:
    """What is known of the sources and their chapters."""
    manuals = sorted(model.manuals, key=_manuals_first)
    lost = (Row(_lost_cells(manual, chapter)) for manual in manuals for chapter in manual.chapters if _is_lost(chapter))
    return Coverage(
        counts=Table("counts", _COUNTS, tuple(map(_counts_row, manuals))),
        lost=Table("lost", _LOST_CHAPTERS, tuple(lost)),
        sources=tuple(_source(model, manual) for manual in manuals),
    )


def listed_sources(model: Model) -> Table:
    """Sources in short, each a link to all that is known of it."""
    rows = tuple(
        Row(
            cells=(
                (Piece(manual.id, f"{COVERAGE}#{manual_id(manual.id)}"),),
                manual.title,
                manual.publisher,
                manual.edition,
                manual.date or NONE,
                _tally(manual) or NONE,
            ),
            id=manual_id(manual.id),
        )
        for manual in sorted(model.manuals, key=_manuals_first)
    )
    return Table("sources", _LISTED, rows)


def edition(manual: Manual) -> str:
    """Edition and date of a manual."""
    return manual.edition + (f", {manual.date}" if manual.date else "")


def _manuals_first(manual: Manual) -> bool:
    return manual.kind != "manual"


def _is_lost(chapter: Chapter) -> bool:
    return chapter.status == _LOST


def _status(chapter: Chapter) -> str:
    return chapter.status or _PENDING


def _counts_row(manual: Manual) -> Row:
    states = [_status(chapter) for chapter in manual.chapters]
    counts = (len(states), *(states.count(state) for state in _STATUSES))
    name = (Piece(manual.id, f"#{manual_id(manual.id)}"),)
    return Row((name, _KINDS.get(manual.kind, manual.kind), manual.title, *map(str, counts)))


def _lost_cells(manual: Manual, chapter: Chapter) -> tuple[Prose, ...]:
    number = (Piece(chapter.number, f"#{_chapter_id(manual, chapter)}"),)
    return (manual.id, number, chapter.title, _page(chapter))


def _chapter_id(manual: Manual, chapter: Chapter) -> str:
    return f"{manual_id(manual.id)}-{chapter.number}"


def _page(chapter: Chapter) -> str:
    return NONE if chapter.page is None else str(chapter.page)


def _source(model: Model, manual: Manual) -> Source:
    rows = tuple(_chapter_row(manual, chapter) for chapter in manual.chapters)
    devices = [device for device in model.devices if device.manual.id == manual.id]
    return Source(
        id=manual_id(manual.id),
        name=manual.id,
        title=manual.title,
        facts=tuple(_facts(manual, devices)),
        tally=_tally(manual),
        chapters=Table("chapters", _CHAPTERS, rows),
    )


def _chapter_row(manual: Manual, chapter: Chapter) -> Row:
    state = _STATUSES.get(_status(chapter), _status(chapter))
    shown = (Piece(state, tag="b"),) if _is_lost(chapter) else state
    cells = (chapter.number, chapter.title, _page(chapter), shown, chapter.note or "")
    return Row(cells, id=_chapter_id(manual, chapter))


def _tally(manual: Manual) -> str:
    """Chapters by state: "71 transcribed, 1 lost in the text dump"."""
    states = [_status(chapter) for chapter in manual.chapters]
    return ", ".join(f"{states.count(state)} {_STATUSES.get(state, state)}" for state in dict.fromkeys(states))


def _facts(manual: Manual, devices: Sequence[Device]) -> Iterator[Fact]:
    yield Fact("Kind", _KINDS.get(manual.kind, manual.kind))
    yield Fact("Publisher", manual.publisher)
    yield Fact("Edition", manual.edition)
    if manual.date:
        yield Fact("Date", manual.date)
    if manual.document:
        yield Fact("Document", manual.document)
    if manual.pages is not None:
        yield Fact("Pages", str(manual.pages))
    if manual.url:
        yield Fact("Address", (Piece(manual.url, manual.url if manual.url.startswith(_WEB) else ""),))
    for device in devices:
        yield Fact("Describes", (Piece(device.title, f"{device.id}.html"),))
