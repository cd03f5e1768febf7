"""One page for each device that is made for paper: what one needs at the machine, without the reasons and sources."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from generator.emit.html.blocks import Drawing, Fact, Row, Table
from generator.emit.html.codes import code_group
from generator.emit.html.coverage import edition
from generator.emit.html.errors import error_entry, kind_title
from generator.emit.html.lamps import words
from generator.emit.html.links import Links
from generator.emit.html.objects import object_entry
from generator.emit.html.panel import switch_entry
from generator.emit.html.places import code_entries, error_entries, error_id, error_text, page_of
from generator.emit.html.tables import drawn, printed_table
from generator.emit.html.text import NONE, Piece, Prose, hexadecimal, joined, noted, plain, through
from generator.model import Code, Device, ErrorEntry, IndicatorTable, Model, SwitchGroup

PART = "sheet"
"""The page among those of a device."""

_CODES = ("Code", "Index", "Name", "Range", "Default", "Access")
_OBJECTS = ("Object", "Name", "Type", "Access", "Default")
_SHOWN_CELLS = len(_OBJECTS)
"""Of a row on a sub-index: sub-index, name, data type, access and default; the rest is on the page of the object."""
_INDEX_BITS = 16
_PLAIN = " .,;-"
"""What stands for itself in a string of CSS, beside letters and digits."""
_MOST_OPTIONS = 16
"""Selection lists that are longer are left to the page of the code."""


@dataclass(frozen=True, slots=True)
class Part:
    """A table with what there is to know before it; ``title`` is "" where it goes on below the heading before."""

    id: str
    title: str
    facts: tuple[Fact, ...]
    tables: tuple[Table, ...]
    drawing: Drawing | None = None


@dataclass(frozen=True, slots=True)
class Sheet:
    """Everything on the page; ``name`` chooses its running head."""

    name: str
    facts: tuple[Fact, ...]
    parts: tuple[Part, ...]


@dataclass(frozen=True, slots=True)
class RunningHead:
    """What stands at the top of every sheet of a device, as a string of CSS."""

    name: str
    text: str


def sheet(links: Links) -> Sheet:
    """View of the page."""
    device = links.device
    facts = [Fact("Type", device.order_code), Fact("Fieldbus", device.bus)]
    facts += [Fact("Hardware from", device.hardware_version)] if device.hardware_version else []
    facts += [Fact("Software from", device.software_version)] if device.software_version else []
    facts.append(Fact("Manual", f"{device.manual.id}, {edition(device.manual)}"))
    return Sheet(_name(device), tuple(facts), tuple(_parts(links)))


def has_sheet(device: Device) -> bool:
    """Whether there is anything to print."""
    return bool(device.codes or device.objects or device.errors or device.indicators or device.switches)


def running_heads(model: Model) -> tuple[RunningHead, ...]:
    """Running heads of all sheets."""
    return tuple(
        RunningHead(_name(device), _css(f"{device.title}, {device.manual.id}; drivespec {model.version}, {model.date}"))
        for device in model.devices
    )


def _name(device: Device) -> str:
    return f"sheet-{device.id}"


def _css(text: str) -> str:
    """String of CSS."""
    escaped = "".join(one if one.isalnum() or one in _PLAIN else f"\\{ord(one):x} " for one in text)
    return f'"{escaped}"'


def _parts(links: Links) -> Iterator[Part]:
    device = links.device
    for table in device.tables:
        if table.assignment is not None:
            pins = printed_table(links, table, anchored=False)
            yield Part(f"connector-{table.id}", table.name, (), (pins,), drawn(links, table))
    for group in device.switches:
        yield _switches(links, group)
    for lamps in device.indicators:
        yield _leds(links, lamps)
    kinds = dict.fromkeys(error.kind for error in device.errors)
    for kind in kinds:
        errors = [error for error in device.errors if error.kind == kind]
        yield Part(f"errors-{kind}", kind_title(kind), (), (_errors(links, errors),))
    if device.codes:
        yield Part("codes", "Codes", (), (_codes(links),))
    if device.objects:
        yield Part("objects", "Objects", (), (_objects(links),))


def _switches(links: Links, group: SwitchGroup) -> Part:
    """Switches; where weights say it all, without the positions of every value."""
    entry = switch_entry(links, group)
    tables = () if group.weights else entry.columns
    page = page_of(links.device, "switches")
    facts = tuple(Fact(fact.label, _seen_from_here(fact.value, page)) for fact in entry.facts if fact.label != "Source")
    return Part(f"switch-{group.id}", f"DIP switches: {group.name}", facts, tuple(map(_without_ids, tables)))


def _seen_from_here(text: Prose, page: str) -> Prose:
    """Text of another page, its links within that page led there."""
    if isinstance(text, str):
        return text
    return tuple(
        replace(piece, href=page + piece.href) if isinstance(piece, Piece) and piece.href.startswith("#") else piece
        for piece in text
    )


def _without_ids(table: Table) -> Table:
    return Table(table.kind, table.head, tuple(Row(row.cells) for row in table.rows), table.caption)


def _leds(links: Links, table: IndicatorTable) -> Part:
    head = (*(f"{led.label} ({led.colour})" for led in table.leds), "State", "Meaning")
    rows = tuple(Row((*map(words, row.patterns), row.state, links.prose(row.meaning) or NONE)) for row in table.rows)
    labels = ", ".join(led.label for led in table.leds)
    return Part(f"led-{table.id}", f"LEDs {labels}", (), (Table("lamps", head, rows),))


def _errors(links: Links, errors: Sequence[ErrorEntry]) -> Table:
    """Numbers with what to do; columns that no row needs are left out."""
    found = list(error_entries(links.device, errors))
    entries = [error_entry(links, group) for group in found]
    titles = list(dict.fromkeys(bullets.title for entry in entries for bullets in entry.bullets))
    with_response = any(error.response is not None for error in errors)
    rows = []
    for group, entry in zip(found, entries, strict=True):
        bullets = {item.title: item.items for item in entry.bullets}
        response = next((fact.value for fact in entry.facts if fact.label == "Response"), NONE)
        cells: list[Prose] = [_numbers(links, group), _titled(entry.name, entry.lead)]
        cells += [response] if with_response else []
        cells += [joined(bullets.get(title, ()), " ") or NONE for title in titles]
        rows.append(Row(tuple(cells)))
    return Table("fixes", ("Number", "Error", *(["Response"] if with_response else []), *titles), tuple(rows))


def _numbers(links: Links, errors: Sequence[ErrorEntry]) -> Prose:
    """Numbers of all slots, of runs the ends."""
    return joined(
        [
            (Piece(through(*ends), links.href(error_id(error.kind, error.number))),)
            for error in errors
            for ends in [(error_text(error.kind, error.number), error_text(error.kind, error.last))]
        ],
        " ",
    )


def _titled(name: str, lead: Prose) -> Prose:
    return noted(name, plain(lead))


def _codes(links: Links) -> Table:
    codes = links.device.codes
    rows = code_group(links, "", "", codes).overview.rows
    return Table("settings", _CODES, tuple(map(_code, code_entries(codes), rows)))


def _code(codes: Sequence[Code], row: Row) -> Row:
    numbers, name, _, bounds, default, access = row.cells
    pairs = ((str(code.index), hexadecimal(code.index, _INDEX_BITS)) for code in codes)
    indexes = " ".join("\N{NO-BREAK SPACE}=\N{NO-BREAK SPACE}".join(pair) for pair in pairs)
    options = codes[0].options
    listed = (
        "; ".join(f"{option.value} = {option.label}" for option in options) if len(options) <= _MOST_OPTIONS else ""
    )
    return Row((numbers, indexes, noted(plain(name), listed), bounds, default, access))


def _objects(links: Links) -> Table:
    rows: list[Row] = []
    for found in links.device.objects:
        entry = object_entry(links, found)
        number = links.anchored(entry.anchors[0])
        values = [row.cells[:_SHOWN_CELLS] for row in entry.tables[0].rows]
        if found.object_type == "VAR" and len(values) == 1:
            rows.append(Row((number, found.name, *values[0][2:])))
            continue
        rows.append(Row((number, (Piece(found.name, tag="b"),), found.object_type, "", "")))
        rows += [Row((f"/{plain(sub)}", *others)) for sub, *others in values]
    return Table("entries", _OBJECTS, tuple(rows))
