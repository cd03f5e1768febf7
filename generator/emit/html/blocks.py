"""What pages are composed of: entries, and the facts, tables, lists and notes inside them.

The blocks hold every string ready to be shown; templates only lay them out.
"""

from dataclasses import dataclass

from generator.emit.html.text import Piece, Prose


@dataclass(frozen=True, slots=True)
class Fact:
    """A label and what it labels."""

    label: str
    value: Prose


@dataclass(frozen=True, slots=True)
class Item:
    """A key and its meaning: a value of a selection list, a bit, a number of a run."""

    key: Piece
    meaning: Prose


@dataclass(frozen=True, slots=True)
class Asked:
    """A number of a run as it is named at the top of the page for whoever comes for it; ``id`` is its anchor."""

    id: str
    text: Prose


@dataclass(frozen=True, slots=True)
class ItemList:
    """A titled list of keys and meanings."""

    title: str
    items: tuple[Item, ...]


@dataclass(frozen=True, slots=True)
class Bullets:
    """A titled list of sentences."""

    title: str
    items: tuple[Prose, ...]


@dataclass(frozen=True, slots=True)
class Row:
    """A row of a table, its first cell the row's head.

    ``id`` and ``more_ids`` are anchors; ``remarks`` and ``lists`` stand below the cells; ``covers`` is what a filter
    finds the row by beside its text, such as the numbers of a run.
    """

    cells: tuple[Prose, ...]
    id: str = ""
    more_ids: tuple[str, ...] = ()
    remarks: tuple[Prose, ...] = ()
    lists: tuple[ItemList, ...] = ()
    covers: str = ""


@dataclass(frozen=True, slots=True)
class Table:
    """A table; ``kind`` is its class in the style sheet, ``caption`` "" where a heading says what it is."""

    kind: str
    head: tuple[str, ...]
    rows: tuple[Row, ...]
    caption: str = ""

    @property
    def columns_below(self) -> int:
        """Over how many columns the remarks and lists of a row stretch: all but that of its head."""
        return len(self.head) - 1

    @property
    def stacks(self) -> bool:
        """Whether the cells of a row stand below each other on narrow screens, each with its heading."""
        return self.kind == "lamps"


@dataclass(frozen=True, slots=True)
class Contact:
    """A contact of a drawn connector; ``signal`` is "" for none, ``upright`` a label that stands on its end.

    ``leader``: from the shell to a label that is away from it, in the notation of SVG, "" for none.
    """

    x: str
    y: str
    number: str
    signal: str
    label_y: str
    upright: bool
    leader: str


@dataclass(frozen=True, slots=True)
class Drawing:
    """A connector; ``box`` and ``outline`` in the notations of SVG, ``form`` as in the spec of connectors."""

    title: str
    box: str
    width: str
    outline: str
    form: str
    contacts: tuple[Contact, ...]
    caption: Prose


@dataclass(frozen=True, slots=True)
class Note:
    """A ledger entry beside the fact that it concerns; ``slip`` marks those of the text dump alone."""

    slip: bool
    caption: Prose
    statements: tuple[Prose, ...]


@dataclass(frozen=True, slots=True)
class Anchor:
    """An id, and the number that stands there and links to itself."""

    id: str
    text: str


@dataclass(frozen=True, slots=True)
class Entry:
    """A code, object, error, erratum, table or another thing that is described by itself.

    ``anchors``: its number, in several slots one for each.  ``marks``: short words on where it is from.
    ``asked``: numbers of its runs.  ``columns``: parts of one long table that stand side by side.
    ``related``: facts that lead elsewhere.
    ``printed``: what each place prints, verbatim.
    """

    kind: str
    anchors: tuple[Anchor, ...]
    name: str
    marks: tuple[str, ...]
    lead: Prose
    facts: tuple[Fact, ...]
    tables: tuple[Table, ...]
    drawing: Drawing | None = None
    columns: tuple[Table, ...] = ()
    lists: tuple[ItemList, ...] = ()
    bullets: tuple[Bullets, ...] = ()
    related: tuple[Fact, ...] = ()
    notes: tuple[Note, ...] = ()
    printed: tuple[str, ...] = ()
    asked: tuple[Asked, ...] = ()


@dataclass(frozen=True, slots=True)
class Group:
    """Entries of one kind below one heading, with a table that lists them; none where each has a page of its own."""

    id: str
    title: str
    overview: Table
    entries: tuple[Entry, ...] = ()
