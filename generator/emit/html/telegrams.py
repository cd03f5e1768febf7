"""Layouts of telegrams and worked examples as entries of the reference."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from generator.codec import CodecError, Span, spans
from generator.emit.html.blocks import Anchor, Entry, Fact, Group, Item, ItemList, Row, Table
from generator.emit.html.links import Links
from generator.emit.html.notes import named_subject, notes
from generator.emit.html.places import named_id
from generator.emit.html.text import NONE, Piece, Prose, hexadecimal, joined, noted, octets, shown_origin, through
from generator.model import BitField, Example, Field, FieldType, Layout, Option
from generator.model.telegram import OPEN, Value

_LAYOUT_OVERVIEW = ("Layout", "Name", "Protocol", "Examples")
_FIELDS = ("Offset", "Field", "Title", "Length", "Type", "Constant")
_EXAMPLE_OVERVIEW = ("Telegram", "Name", "Direction", "Bytes used")
_TYPES = {
    FieldType.UINT: "unsigned",
    FieldType.INT: "signed",
    FieldType.BYTES: "bytes",
    FieldType.TEXT: "text",
    FieldType.GROUP: "group",
}
_NUMBERS = (FieldType.UINT, FieldType.INT)
_ONE_DIGIT = 9
_IDENTIFIER_BITS = 12
_Octets = Sequence[int | None]


def layout_group(links: Links, layouts: Sequence[Layout]) -> Group:
    """Layouts below one heading."""
    rows = tuple(_layout_row(links, layout) for layout in layouts)
    entries = tuple(layout_entry(links, layout) for layout in layouts)
    return Group("telegrams-layouts", "Layouts", Table("overview", _LAYOUT_OVERVIEW, rows), entries)


def _layout_row(links: Links, layout: Layout) -> Row:
    count = str(len(_examples(links, layout)))
    return Row((links.anchored(_layout_anchor(layout)), layout.name, layout.protocol, count))


def _layout_anchor(layout: Layout) -> Anchor:
    return Anchor(named_id("layout", layout.id), layout.id)


def _examples(links: Links, layout: Layout) -> list[Example]:
    return [example for example in links.device.examples if example.layout == layout.id]


def layout_entry(links: Links, layout: Layout) -> Entry:
    """Entry for a layout."""
    origin = shown_origin(layout.origin)
    examples = [(_example_link(links, example),) for example in _examples(links, layout)]
    return Entry(
        kind="layout",
        anchors=(_layout_anchor(layout),),
        name=layout.name,
        marks=(origin,) if origin else (),
        lead=links.prose(layout.description),
        facts=tuple(_layout_facts(links, layout)),
        tables=(Table("fields", _FIELDS, tuple(_field_rows(links, layout, layout.fields, ""))),),
        related=(Fact("Worked examples", joined(examples)),) if examples else (),
        notes=notes(links, [named_subject(layout.errata)]),
    )


def _layout_facts(links: Links, layout: Layout) -> Iterator[Fact]:
    yield Fact("Protocol", layout.protocol)
    if layout.identifiers:
        yield Fact("Identifier of", ", ".join(layout.identifiers))
    yield Fact("Source", links.source(layout.cite))


def _field_rows(links: Links, layout: Layout, fields: Sequence[Field], path: str) -> Iterator[Row]:
    """Fields in the order of the bytes; those of a group follow it, their offsets counted from its beginning."""
    offset: int | None = 0
    before = ""
    for field in fields:
        name = path + field.name
        shown = f"after {before}" if offset is None else f"+{offset}" if path else str(offset)
        yield Row(
            (shown, name, field.title, _length(field), _type(field), _constant(field)),
            id=named_id("layout", layout.id, name),
            remarks=(links.prose(field.description),) if field.description else (),
            lists=tuple(_value_lists(field)),
        )
        yield from _field_rows(links, layout, field.fields, f"{name}.")
        fixed = field.length if field.sizes is None and field.type is not FieldType.GROUP else None
        offset = offset + fixed if offset is not None and isinstance(fixed, int) else None
        before = field.name


def _length(field: Field) -> str:
    if field.type is FieldType.GROUP:
        return f"repeats {field.count} times" if field.count is not None else "repeats to the end"
    if field.sizes is not None and field.sizes.fills is not None:
        return f"up to a multiple of {field.sizes.fills}"
    if field.sizes is not None:
        times = f", times {field.sizes.times}" if field.sizes.times is not None else ""
        return f"by {field.sizes.by}{times}"
    if field.length is None:
        return "the rest"
    return str(field.length)


def _type(field: Field) -> str:
    if field.type not in _NUMBERS or field.length == 1:
        return _TYPES[field.type]
    return f"{_TYPES[field.type]}, {'high' if field.big else 'low'} byte first"


def _constant(field: Field) -> Prose:
    return NONE if field.constant is None else _number(field.constant)


def _number(value: int) -> Prose:
    """A number in both bases, of a single digit in one."""
    return str(value) if 0 <= value <= _ONE_DIGIT else noted(hexadecimal(value), str(value))


def _value_lists(field: Field) -> Iterator[ItemList]:
    if field.sizes is not None:
        yield ItemList(
            f"Length in bytes by {field.sizes.by}",
            tuple(Item(Piece(hexadecimal(value)), str(size)) for value, size in field.sizes.sizes),
        )
    if field.values:
        yield ItemList("Values", tuple(map(_option, field.values)))
    if field.bits:
        yield ItemList("Bits", tuple(Item(Piece(_run(part)), part.label) for part in field.bits))
    for name, options in field.bit_values:
        yield ItemList(f"Values of {name}", tuple(Item(Piece(str(o.value)), o.label) for o in options))


def _option(option: Option) -> Item:
    key = str(option.value) if 0 <= option.value <= _ONE_DIGIT else hexadecimal(option.value)
    return Item(Piece(key), option.label)


def _run(part: BitField) -> str:
    return through(str(part.low), str(part.high))


def example_group(links: Links, examples: Sequence[Example]) -> Group:
    """Worked examples below one heading."""
    rows = tuple(Row((links.anchored(_anchor(e)), e.name, e.direction, (_octets(e.data),))) for e in examples)
    entries = tuple(example_entry(links, example) for example in examples)
    return Group("telegrams-examples", "Worked examples", Table("overview telegrams", _EXAMPLE_OVERVIEW, rows), entries)


def _anchor(example: Example) -> Anchor:
    return Anchor(named_id("telegram", example.id), example.id)


def _example_link(links: Links, example: Example) -> Piece:
    return links.named_thing("telegram", example.id, example.id)


def _octets(data: _Octets) -> Piece:
    return Piece(octets(data) or NONE, tag="code")


def example_entry(links: Links, example: Example) -> Entry:
    """Entry for a worked example."""
    layout = next((layout for layout in links.device.layouts if layout.id == example.layout), None)
    decoded = (_decoded(links, layout, example),) if layout else ()
    return Entry(
        kind="telegram",
        anchors=(_anchor(example),),
        name=example.name,
        marks=(),
        lead=links.prose(example.meaning),
        facts=tuple(_facts(links, example)),
        tables=decoded,
        related=tuple(_exchange(links, example)),
        notes=notes(links, [named_subject(example.errata)]),
    )


def _facts(links: Links, example: Example) -> Iterator[Fact]:
    yield Fact("Direction", example.direction)
    yield Fact("Layout", (links.named_thing("layout", example.layout, example.layout),))
    if example.identifier is not None:
        shown = hexadecimal(example.identifier, _IDENTIFIER_BITS)
        yield Fact("Identifier", noted(shown, str(example.identifier)))
    if example.node is not None:
        yield Fact("Node address", str(example.node))
    if example.printed == example.data:
        yield Fact("Bytes", (_octets(example.data), " ", Piece("as printed", tag="small")))
    else:
        yield Fact("Bytes printed", (_octets(example.printed),))
        yield Fact("Bytes used", (_octets(example.data),))
    yield Fact("Source", links.source(example.cite))


def _exchange(links: Links, example: Example) -> Iterator[Fact]:
    """The exchange that a telegram belongs to, with links to its others."""
    if example.sequence is None:
        return
    all_of_it = [other for other in links.device.examples if other.sequence == example.sequence]
    parts: list[Prose] = [
        (Piece(other.id, tag="b") if other is example else _example_link(links, other),) for other in all_of_it
    ]
    yield Fact("Exchange", (f"{example.sequence}: ", *joined(parts, " \N{RIGHTWARDS ARROW} ")))


def _decoded(links: Links, layout: Layout, example: Example) -> Table:
    """Every field with its bytes, its value and what that means; what is printed beside what is used."""
    differs = example.printed != example.data
    head = ("Offset", "Field", "Bytes used" if differs else "Bytes", *(["Bytes printed"] if differs else []))
    try:
        found = spans(layout, example.data)
    except CodecError:
        rows = [_said_row(name, value, len(head)) for name, value in example.values.items()]
    else:
        rows = [_span_row(links, layout, example, span) for span in found]
    return Table("decoded", (*head, "Value", "Meaning"), tuple(rows))


def _said_row(name: str, value: Value, width: int) -> Row:
    """Row of a field whose bytes cannot be told, because the telegram does not follow the layout."""
    return Row((NONE, name, *[NONE] * (width - 2), _value(value), NONE))


def _span_row(links: Links, layout: Layout, example: Example, span: Span) -> Row:
    used, printed = (data[span.start : span.stop] for data in (example.data, example.printed))
    name = links.named_thing("layout", layout.id, span.place, span.path)
    cells: list[Prose] = [through(str(span.start), str(span.stop - 1)) if used else NONE, (name,), (_octets(used),)]
    if example.printed != example.data:
        cells.append((replace(_octets(printed), css="" if printed == used else "differs"),))
    if not used:
        return Row((*cells, NONE, "without bytes here"))
    value = span.values[span.field.name]
    lists = ItemList("Bits", tuple(_parts(span)))
    meaning = _meaning(value, span.field.values) or ("constant" if span.field.constant is not None else NONE)
    return Row((*cells, _value(value), meaning), lists=(lists,) if lists.items else ())


def _value(value: Value) -> Prose:
    match value:
        case int():
            return _number(value)
        case str():
            return "open" if value == OPEN else value or NONE
        case tuple():
            return f"{len(value)} entries"


def _meaning(value: Value, options: Sequence[Option]) -> str:
    return next((option.label for option in options if option.value == value), "")


def _parts(span: Span) -> Iterator[Item]:
    """Parts of a number with their values and what these mean."""
    options = dict(span.field.bit_values)
    for part in span.field.bits:
        value = span.values[f"{span.field.name}.{part.label}"]
        meaning = _meaning(value, options.get(part.label, ()))
        shown = "open" if value == OPEN else str(value)
        yield Item(Piece(_run(part)), noted(f"{part.label} = {shown}", meaning))
