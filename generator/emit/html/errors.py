"""Error numbers as entries of the reference: one entry for the same error in every slot."""

from collections.abc import Iterator, Sequence

from generator.emit.html.blocks import Anchor, Asked, Bullets, Entry, Fact, Group, Item, ItemList, Row, Table
from generator.emit.html.links import Links
from generator.emit.html.notes import error_subject, notes
from generator.emit.html.places import ERROR_KINDS, error_id, error_text
from generator.emit.html.text import ELLIPSIS, NONE, Piece, Prose, joined, shown_origin, through
from generator.model import CodeRef, Drive, ErrorEntry

_VARIANTS = ("Slot", "Number", "Decimal", "Response set in", "Source")
_Variants = Sequence[ErrorEntry]
"""The error of one entry in every slot that it stands for."""


def error_group(links: Links, name: str, kind: str, errors: Sequence[ErrorEntry]) -> Group:
    """Errors of a kind below one heading, those of several slots that differ in number alone drawn together."""
    return Group(
        id=name,
        title=kind_title(kind),
        overview=_overview(links, errors),
    )


def kind_title(kind: str) -> str:
    """Heading of the errors of a kind."""
    return ERROR_KINDS[kind][1] if kind in ERROR_KINDS else kind


def _overview(links: Links, errors: Sequence[ErrorEntry]) -> Table:
    """One row for a number or run; columns that no row needs are left out."""
    with_responses = any(error.response is not None or error.adjustable_in for error in errors)
    with_registers = any(error.register is not None for error in errors)
    with_sources = any(map(_is_plain, errors))
    head = ["Number", "Decimal", "Name"]
    head += ["Response", "Set in"] if with_responses else []
    head += ["Error register"] if with_registers else []
    head += ["Source"] if with_sources else []
    rows = []
    for error in errors:
        cells = [_numbered(links, error), _decimal(error), _overview_name(error)]
        if with_responses:
            cells += [_response(links.device.drive, error.response), links.codes(error.adjustable_in) or NONE]
        if with_registers:
            cells.append(error.register or NONE)
        if with_sources:
            cells.append(links.source(error.cite))
        remarks = (links.prose(error.description),) if error.description and _is_plain(error) else ()
        rows.append(Row(tuple(cells), remarks=remarks, covers=_covers(error)))
    return Table("overview errors", tuple(head), tuple(rows))


def _covers(error: ErrorEntry) -> str:
    """Every number of a run in both notations, and every code that sets a response."""
    run = range(error.number, error.last + 1) if error.count > 1 else ()
    numbers = [f"{error_text(error.kind, number)} {number}" for number in run]
    return " ".join([*numbers, *map(str, error.adjustable_in)])


def _overview_name(error: ErrorEntry) -> Prose:
    mark = shown_origin(error.origin)
    return (error.name, " ", Piece(mark, tag="em")) if mark else error.name


def _decimal(error: ErrorEntry) -> str:
    return str(error.number) if error.count == 1 else f"{error.number} {ELLIPSIS} {error.last}"


def _is_plain(error: ErrorEntry) -> bool:
    """Whether a row of the overview holds all that is known of the error."""
    return not (error.slot or error.causes or error.remedies or error.responses or error.adjustable_in or error.errata)


def error_entry(links: Links, entry: _Variants) -> Entry:
    """Entry for an error in one slot or several."""
    error = entry[0]
    origin = shown_origin(error.origin)
    bullets = (
        Bullets("Causes", _sentences(links, error.causes)),
        Bullets("Remedies", _sentences(links, error.remedies)),
    )
    return Entry(
        kind="error",
        anchors=tuple(_anchor(one, one.number) for one in entry),
        name=shared_name(entry),
        marks=(origin,) if origin else (),
        lead=links.prose(error.description),
        facts=tuple(_facts(links, error)),
        tables=(Table("variants", _VARIANTS, tuple(_variant(links, one) for one in entry)),),
        lists=tuple(found for one in entry for found in _numbers(links, one)),
        bullets=tuple(found for found in bullets if found.items),
        notes=notes(links, map(error_subject, entry)),
        printed=tuple(line for one in entry for line in _printed(one)),
        asked=tuple(found for one in entry for found in _asked(links, one)),
    )


def _sentences(links: Links, texts: Sequence[str]) -> tuple[Prose, ...]:
    return tuple(map(links.prose, texts))


def shared_name(entry: Sequence[ErrorEntry]) -> str:
    """Name that all slots share: "CAN module (MXI1 / MXI2): bus-off"."""
    slots = [error.slot for error in entry if error.slot]
    return entry[0].name.replace(slots[0], " / ".join(slots)) if slots else entry[0].name


def _facts(links: Links, error: ErrorEntry) -> Iterator[Fact]:
    drive = links.device.drive
    preset = _response(drive, error.response)
    yield Fact("Response", preset)
    names = list(dict.fromkeys(_response(drive, name) for name in error.responses))
    if names == [preset]:
        yield Fact("Selectable", "no other")
    elif names:
        yield Fact("Selectable", joined([(Piece(name, tag="b" if name == preset else ""),) for name in names]))
    if error.register is not None:
        yield Fact("Error register", error.register)


def _response(drive: Drive | None, name: str | None) -> str:
    """Response by the name that the drive's list gives it."""
    known = drive.responses if drive else ()
    return next((response.name for response in known if name in (response.name, *response.aliases)), name or NONE)


def _variant(links: Links, error: ErrorEntry) -> Row:
    return Row(
        (
            error.slot or NONE,
            through(error_text(error.kind, error.number), error_text(error.kind, error.last)),
            through(str(error.number), str(error.last)),
            links.codes(error.adjustable_in) or NONE,
            links.source(error.cite),
        )
    )


def _anchor(error: ErrorEntry, number: int) -> Anchor:
    return Anchor(error_id(error.kind, number), error_text(error.kind, number))


def _numbered(links: Links, error: ErrorEntry) -> Prose:
    """The number as a link to its place, with the end of its run."""
    first = links.anchored(_anchor(error, error.number))
    last = error_text(error.kind, error.last)
    return first if error.count == 1 else (*first, f" {ELLIPSIS} {last}")


def has_own_places(error: ErrorEntry) -> bool:
    """Whether each number of a run has a place of its own on the page of the run."""
    return error.count > 1 and len(error.adjustable_in) == error.count


def _numbers(links: Links, error: ErrorEntry) -> Iterator[ItemList]:
    """Every number of a run with the code that sets its response, where each has one of its own."""
    if not has_own_places(error):
        return
    items = [
        Item(Piece(anchor.text, f"#{anchor.id}"), (f"{number} ", links.code(code)))
        for number, anchor, code in _members(error)
    ]
    yield ItemList(f"Number by number, {error.slot}" if error.slot else "Number by number", tuple(items))


def _asked(links: Links, error: ErrorEntry) -> Iterator[Asked]:
    """Every number of a run but the first, which the heading names."""
    if has_own_places(error):
        for number, anchor, code in list(_members(error))[1:]:
            text = (Piece(anchor.text, tag="b"), f" = {number}, response set in ", links.code(code))
            yield Asked(anchor.id, text)


def _members(error: ErrorEntry) -> Iterator[tuple[int, Anchor, CodeRef]]:
    """The numbers of a run, each with its anchor and the code that sets its response."""
    for number, code in zip(range(error.number, error.last + 1), error.adjustable_in, strict=True):
        yield number, _anchor(error, number), code


def _printed(error: ErrorEntry) -> Iterator[str]:
    """What places print otherwise than it is used."""
    return (f"{item.label}: {item.shown}" for item in error_subject(error).printed)
