"""Objects of the object dictionary as entries of the reference."""

from collections.abc import Callable, Iterator, Sequence

from generator.emit.html.blocks import Anchor, Entry, Fact, Group, Row, Table
from generator.emit.html.links import Links
from generator.emit.html.lists import counts_on, from_to, runs, shortest_run, value_lists
from generator.emit.html.notes import notes, object_subject
from generator.emit.html.places import object_id
from generator.emit.html.text import (
    NONE,
    Piece,
    Prose,
    hexadecimal,
    noted,
    shown_default,
    shown_origin,
    shown_range,
    through,
)
from generator.model import CodeRef, DictionaryObject, ErrorRef, SubIndex

_INDEX_BITS = 16
_ONE_DIGIT = 9
_OVERVIEW = ("Object", "Name", "Type", "Entries", "Codes")
_SUBINDEXES = ("Sub", "Name", "Data type", "Access", "Default", "Range", "PDO", "Codes")


def object_group(links: Links, name: str, title: str, entries: Sequence[DictionaryObject]) -> Group:
    """Objects below one heading."""
    return Group(
        id=name,
        title=title,
        overview=Table("overview", _OVERVIEW, tuple(_overview_row(links, entry) for entry in entries)),
    )


def _overview_row(links: Links, entry: DictionaryObject) -> Row:
    codes = links.codes_of(entry)
    cells = (entry.name, entry.object_type, str(len(entry.subindexes)))
    covers = f"{entry.index} {hexadecimal(entry.index, _INDEX_BITS)}"
    return Row((links.anchored(_anchor(entry)), *cells, links.codes(codes) or NONE), covers=covers)


def _anchor(entry: DictionaryObject) -> Anchor:
    return Anchor(object_id(entry), entry.designation)


def object_entry(links: Links, entry: DictionaryObject) -> Entry:
    """Entry for an object."""
    origin = shown_origin(entry.origin)
    shortest = shortest_run(any(map(_is_explained, entry.subindexes)))
    rows = tuple(_row(links, entry, run) for run in runs(entry.subindexes, _same_in(links, entry), shortest))
    return Entry(
        kind="object",
        anchors=(_anchor(entry),),
        name=entry.name,
        marks=(origin,) if origin else (),
        lead=links.prose(entry.description),
        facts=tuple(_facts(links, entry)),
        tables=(Table("subindexes", _SUBINDEXES, rows),),
        notes=notes(links, [object_subject(entry)]),
    )


def _facts(links: Links, entry: DictionaryObject) -> Iterator[Fact]:
    yield Fact("Index", noted(hexadecimal(entry.index, _INDEX_BITS), str(entry.index)))
    yield Fact("Object type", entry.object_type)
    whole = links.codes(links.codes_of_whole(entry))
    if whole:
        yield Fact("Codes", whole)
    yield Fact("Source", links.source(entry.cite))


def _same_in(links: Links, entry: DictionaryObject) -> Callable[[SubIndex, SubIndex, int], bool]:
    """Test whether a sub-index says what one ``step`` places before it says; the codes may count on."""

    def codes(sub: SubIndex) -> set[CodeRef]:
        return set(links.codes_of_subindex(entry, sub.number))

    def same(first: SubIndex, other: SubIndex, step: int) -> bool:
        if other.number != first.number + step or _content(first) != _content(other):
            return False
        if not counts_on(first.name, other.name, step):
            return False
        return codes(other) in (codes(first), {_counted(ref, step) for ref in codes(first)})

    return same


def _counted(ref: CodeRef, step: int) -> CodeRef:
    return CodeRef(ref.number, ref.subcode + step) if ref.subcode is not None else ref


def _content(sub: SubIndex) -> tuple[object, ...]:
    return (
        sub.data_type,
        sub.access,
        sub.printed_type,
        sub.printed_access,
        sub.default,
        sub.range,
        sub.options,
        sub.bits,
        sub.fields,
        sub.signature,
        sub.pdo_mapping,
        sub.unused,
        sub.abort,
        sub.description,
        sub.errata,
    )


def _is_explained(sub: SubIndex) -> bool:
    return bool(sub.description or sub.options or sub.bits or sub.fields)


def _row(links: Links, entry: DictionaryObject, run: Sequence[SubIndex]) -> Row:
    first, last = run[0], run[-1]
    ids = [object_id(entry, sub.number) for sub in run]
    codes = links.codes(ref for sub in run for ref in links.codes_of_subindex(entry, sub.number))
    return Row(
        cells=(
            (Piece(through(str(first.number), str(last.number)), f"#{ids[0]}"),),
            from_to(first.name, last.name),
            first.data_type.canopen_name,
            first.access,
            _default(links, first),
            shown_range(first.range, first.data_type, False) or NONE,
            "yes" if first.pdo_mapping else "no",
            codes or NONE,
        ),
        id=ids[0],
        more_ids=tuple(ids[1:]),
        remarks=tuple(_remarks(links, first)),
        lists=value_lists(first.options, first.default, first.bits, first.fields),
    )


def _default(links: Links, sub: SubIndex) -> Prose:
    """Default; numbers of more than a digit in both bases, that of bit-coded values first in hexadecimal."""
    mirrors = [code for code in map(links.code_of, sub.codes) if code is not None]
    in_hex = bool(sub.bits or sub.fields) or any(code.is_bitfield for code in mirrors)
    shown = shown_default(sub.default, sub.data_type, in_hex) or NONE
    if not isinstance(sub.default, int) or abs(sub.default) <= _ONE_DIGIT:
        return shown
    return noted(shown, str(sub.default) if in_hex else hexadecimal(sub.default))


def _remarks(links: Links, sub: SubIndex) -> Iterator[Prose]:
    if sub.description:
        yield links.prose(sub.description)
    if sub.printed_type != sub.data_type:
        yield f"The manual prints the data type {sub.printed_type.canopen_name}."
    if sub.printed_access != sub.access:
        yield f"The manual prints the access {sub.printed_access}."
    if sub.signature is not None:
        yield "Signature to be written: ", Piece(sub.signature, tag="code")
    if sub.abort is not None:
        abort = links.error(ErrorRef("sdo_abort", sub.abort))
        yield "Does not exist on the bus; any access ends with ", abort, "."
    if sub.unused:
        yield "Has no function."
