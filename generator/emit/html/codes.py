"""Codes as entries of the reference: one entry for the same code in every slot."""

from collections.abc import Iterator, Sequence
from fractions import Fraction

from generator.emit.html.blocks import Anchor, Entry, Fact, Group, Row, Table
from generator.emit.html.links import Links
from generator.emit.html.lists import counts_on, from_to, runs, shortest_run, value_lists
from generator.emit.html.notes import code_subject, located, notes
from generator.emit.html.places import code_entries, code_id
from generator.emit.html.text import (
    ELLIPSIS,
    NONE,
    Piece,
    Prose,
    between,
    decimal,
    hexadecimal,
    joined,
    noted,
    place_of,
    shown_default,
    shown_origin,
    shown_range,
    through,
)
from generator.model import Code, ObjectRef, SubCode

_CONDITIONS = {
    "cinh": "writing only while the controller is inhibited",
    "plc_stop": "writing only while the PLC is stopped",
    "no_transfer": "left out when parameters are transferred",
    "pdo_map_rx": "can be mapped into RPDOs",
    "pdo_map_tx": "can be mapped into TPDOs",
}
_INDEX_BITS = 16
_OVERVIEW = ("Code", "Name", "Data type", "Range", "Default", "Access")
_VARIANTS = ("Slot", "Code", "Index", "Index hex", "Source")
_Variants = Sequence[Code]
"""The code of one entry in every slot that it stands for."""


def code_group(links: Links, name: str, title: str, codes: Sequence[Code]) -> Group:
    """Codes below one heading, those of several slots that differ in number alone drawn together."""
    return Group(
        id=name,
        title=title,
        overview=Table("overview", _OVERVIEW, tuple(_overview_row(links, entry) for entry in code_entries(codes))),
    )


def _overview_row(links: Links, entry: _Variants) -> Row:
    code = entry[0]
    cells = (code.name, code.type_name, _range(code), _brief_default(code), _access(code))
    numbers = joined([links.anchored(_anchor(one)) for one in entry], " ")
    covers = " ".join(f"{one.index} {hexadecimal(one.index, _INDEX_BITS)}" for one in entry)
    return Row((numbers, *(cell or NONE for cell in cells)), covers=covers)


def _anchor(code: Code) -> Anchor:
    return Anchor(code_id(code.number), code.designation)


def code_entry(links: Links, entry: _Variants) -> Entry:
    """Entry for a code in one slot or several."""
    code = entry[0]
    variants = Table("variants", _VARIANTS, tuple(_variant(links, one) for one in entry))
    return Entry(
        kind="code",
        anchors=tuple(map(_anchor, entry)),
        name=code.name,
        marks=_marks(code),
        lead=links.prose(code.description),
        facts=tuple(_facts(code)),
        tables=(variants, _subcodes(links, entry)) if code.subcodes else (variants,),
        lists=value_lists(code.options, code.default, code.bits, code.fields),
        related=tuple(_related(links, entry)),
        notes=notes(links, map(code_subject, entry)),
        printed=tuple(line for one in entry for line in _printed(one)),
    )


def _marks(code: Code) -> tuple[str, ...]:
    marks = [shown_origin(code.origin)]
    if code.internal:
        marks.append("device-internal, not to be changed")
    return tuple(mark for mark in marks if mark)


def _facts(code: Code) -> Iterator[Fact]:
    yield Fact("Data type", noted(code.type_name, _bus_type(code)))
    yield Fact("Range", noted(_range(code) or NONE, _wire_range(code)))
    yield Fact("Default", noted(_default(code), _default_note(code)))
    yield Fact("Access", noted(_access(code), _conditions(code)))
    scaling = decimal(code.scaling) if code.scaling is not None else NONE
    yield Fact("Scaling", noted(scaling, "" if code.scaling in (None, 1) else "value on the bus = value × scaling"))
    if code.length is not None:
        yield Fact("Longest", f"{code.length} bytes")
    if code.since is not None:
        yield Fact("Since", noted(code.since, "software version"))
    if code.shared_by is not None:
        yield Fact("Shared by", noted(code.shared_by, "a fact of the base drive"))


def _bus_type(code: Code) -> str:
    """What a bit-coded value travels as; for the other types the names say it."""
    return f"{code.data_type.canopen_name} on the bus" if code.is_bitfield else ""


def _range(code: Code) -> str:
    return shown_range(code.range, code.data_type, code.is_bitfield)


def _wire_range(code: Code) -> str:
    if code.range is None or code.scaling in (None, 1):
        return ""
    ends = (decimal(end * code.scaling) for end in (code.range.low, code.range.high))
    return f"on the bus {between(*ends)}"


def _default(code: Code) -> str:
    if code.default is None and any(sub.default is not None for sub in code.subcodes):
        return "see subcodes"
    return shown_default(code.default, code.data_type, code.is_bitfield) or NONE


def _brief_default(code: Code) -> str:
    """Default of a single variable, or the one that all subcodes share."""
    shown = {_subcode_default(code, sub) for sub in code.subcodes} or {
        shown_default(code.default, code.data_type, code.is_bitfield)
    }
    return shown.pop() if len(shown) == 1 else "by subcode"


def _default_note(code: Code) -> str:
    notes = [option.label for option in code.options if option.value == code.default]
    if isinstance(code.default, int) and code.scaling not in (None, 1):
        unit = f" {code.range.unit}" if code.range and code.range.unit else ""
        notes.append(f"= {decimal(Fraction(code.default, code.scaling))}{unit}")
    if code.default_cite is not None:
        notes.append(f"printed in {place_of(code.default_cite.chapter, code.default_cite.page)}")
    return ", ".join(notes)


def _access(code: Code) -> str:
    words = [word for word, ticked in (("read", code.access.read), ("write", code.access.write)) if ticked]
    return "/".join(words) or NONE


def _conditions(code: Code) -> str:
    return "; ".join(_CONDITIONS.get(name, name) for name in code.access.conditions)


def _variant(links: Links, code: Code) -> Row:
    cells = (code.slot or "base drive", code.designation, str(code.index), hexadecimal(code.index, _INDEX_BITS))
    return Row((*cells, links.source(code.cite)))


def _printed(code: Code) -> Iterator[str]:
    """What each place prints of the code."""
    for index in code.printed:
        forms = [str(index.decimal)] + ([f"{index.hexadecimal:04X}h"] if index.hexadecimal is not None else [])
        yield f"{located(index.place, index.page)}: {' / '.join(forms)}"
    if code.printed_name != code.name:
        yield f"{located(f'chapter {code.slot}' if code.slot else 'chapter', None)}: {code.printed_name}"
    row = code.attributes
    if row is not None:
        parts = (f"{row.structure} {row.count} {row.type_name}", f"factor {row.factor}", row.access, row.name)
        place = located(f"row of attributes {code.slot or 'base'}", row.page)
        yield f"{place}: {', '.join(part for part in parts if part)}"


def _subcodes(links: Links, entry: _Variants) -> Table:
    code = entry[0]
    rows = [(sub, _mirrors(links, entry, sub)) for sub in code.subcodes]
    with_names = any(sub.name for sub in code.subcodes)
    with_objects = any(mirrors for _, mirrors in rows)
    head = ("Sub", *(["Holds"] if with_names else []), "Default", *(["Object"] if with_objects else []))
    shortest = shortest_run(any(sub.description or sub.options for sub in code.subcodes))
    found = tuple(_row(links, entry, run, with_names, with_objects) for run in runs(rows, _says_the_same, shortest))
    return Table("subcodes", head, found, "Subcodes")


_Row = tuple[SubCode, tuple[ObjectRef, ...]]
"""A subcode and the sub-indexes that mirror it."""


def _mirrors(links: Links, entry: _Variants, sub: SubCode) -> tuple[ObjectRef, ...]:
    return tuple(sorted({ref for one in entry for ref in links.mirrors_of_subcode(one, sub.number)}, key=str))


def _says_the_same(first: _Row, other: _Row, step: int) -> bool:
    """Whether a row can be drawn together with one ``step`` places before; name and mirrors may count on."""
    one, two = first[0], other[0]
    if two.number != one.number + step:
        return False
    if (one.default, one.follows, one.options, one.description) != (
        two.default,
        two.follows,
        two.options,
        two.description,
    ):
        return False
    if not counts_on(one.name, two.name, step):
        return False
    counted = tuple(ObjectRef(ref.index, ref.subindex + step) if ref.subindex is not None else ref for ref in first[1])
    return other[1] in (first[1], counted)


def _row(links: Links, entry: _Variants, run: Sequence[_Row], with_names: bool, with_objects: bool) -> Row:
    code, first, last = entry[0], run[0][0], run[-1][0]
    ids = [code_id(one.number, sub.number) for sub, _ in run for one in entry]
    number = Piece(through(str(first.number), str(last.number)), f"#{ids[0]}")
    default = noted(_subcode_default(code, first) or NONE, _follows(code, first))
    cells = [(number,), *([from_to(first.name, last.name) or NONE] if with_names else []), default]
    return Row(
        cells=(*cells, _mirrored(links, run)) if with_objects else tuple(cells),
        id=ids[0],
        more_ids=tuple(ids[1:]),
        remarks=(links.prose(first.description),) if first.description else (),
        lists=value_lists(first.options, first.default, (), ()),
    )


def _mirrored(links: Links, run: Sequence[_Row]) -> Prose:
    """Mirrors of a run, each drawn from that of the first subcode to that of the last."""
    pairs = zip(run[0][1], run[-1][1], strict=True)
    parts = [
        (links.object(low), f" {ELLIPSIS} ", links.object(high)) if high != low else (links.object(low),)
        for low, high in pairs
    ]
    return joined(parts) or NONE


def _subcode_default(code: Code, sub: SubCode) -> str:
    return shown_default(sub.default, code.data_type, code.is_bitfield)


def _follows(code: Code, sub: SubCode) -> str:
    """The rule that a default obeys, where it is not the default itself."""
    if sub.follows is None or sub.follows == sub.default:
        return ""
    return f"= {shown_default(sub.follows, code.data_type, code.is_bitfield)}"


def _related(links: Links, entry: _Variants) -> Iterator[Fact]:
    objects = links.objects(ref for one in entry for ref in links.mirrors_of(one))
    if objects:
        yield Fact("Objects", objects)
    errors = dict.fromkeys((links.error(e.ref), f" {e.name}") for one in entry for e in links.errors_set_in(one))
    if errors:
        yield Fact("Sets the response to", joined(tuple(errors), "; "))
    twins = [(links.code(twin.ref),) for twin in links.twins(entry[0]) if twin not in entry]
    if twins:
        yield Fact("In the other slot", joined(twins))
