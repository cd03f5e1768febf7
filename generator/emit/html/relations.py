"""What else has to do with a code, object or error: switches, files, places that name it, the same in other devices."""

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from generator.emit.canopen import Entry as BusEntry
from generator.emit.canopen import object_dictionaries
from generator.emit.html.blocks import Entry, Fact
from generator.emit.html.links import Links
from generator.emit.html.places import code_entries, code_id, error_entries, error_id, error_text, named_id, object_id
from generator.emit.html.text import Piece, Prose, joined
from generator.model import Code, CodeRef, Device, DictionaryObject, ErrorEntry

_NAMED = re.compile(r"\b(?:C(\d{5})|I-([0-9A-F]{4}))\b")

_Thing = tuple[str, int]
"""What a text names: ("C", number) of a code or ("I", index) of an object."""


class Relations:
    """What belongs together beyond what an entry says of itself; ``devices`` are all those of the model."""

    def __init__(self, links: Links, devices: Sequence[Links]) -> None:
        """Look through the texts and files of the device of ``links``."""
        self._others = [other for other in devices if other.device is not links.device]
        self._in_files: dict[int, list[BusEntry]] = {}
        for dictionary in object_dictionaries(links.device):
            for entry in dictionary.objects:
                self._in_files.setdefault(entry.index, list(entry.entries))
        self._named: dict[_Thing, dict[str, str]] = defaultdict(dict)
        for anchor, text, texts in _texts(links.device):
            for thing in _things(texts):
                self._named[thing][anchor] = text

    def of_codes(self, codes: Sequence[Code], links: Links, entry: Entry) -> Entry:
        """The entry of a code in its slots with everything else that has to do with it."""
        numbers = {code.number for code in codes}
        related: list[Fact] = []
        switches = [group for group in links.device.switches if any(ref.number in numbers for ref in group.sets)]
        if switches:
            named = [(links.named_thing("switch", group.id, group.name),) for group in switches]
            related.append(Fact("DIP switches", joined(named)))
        related += self._files([code.index for code in codes])
        related += self._places(links, [("C", number) for number in sorted(numbers)], entry)
        base = [code for code in codes if code.slot is None]
        related += self._elsewhere(
            (other, code_id(code.number), code.designation)
            for code in base
            for other in self._others
            if other.device.drive is links.device.drive and other.code_of(CodeRef(code.number)) is not None
        )
        return replace(entry, related=(*entry.related, *related))

    def of_object(self, found: DictionaryObject, links: Links, entry: Entry) -> Entry:
        """The entry of an object with everything else that has to do with it."""
        related: list[Fact] = []
        if found.kind == "canopen":
            related += self._files([found.index])
            related += self._places(links, [("I", found.index)], entry)
        related += self._elsewhere(
            (other, object_id(one), one.designation)
            for other in self._others
            for one in other.device.objects
            if (one.kind, one.index) == (found.kind, found.index)
        )
        return replace(entry, related=(*entry.related, *related))

    def of_errors(self, errors: Sequence[ErrorEntry], links: Links, entry: Entry) -> Entry:
        """The entry of an error in its slots with everything else that has to do with it."""
        twins = [twin for error in errors for twin in links.error_twins(error) if twin not in errors]
        related = [Fact("In the other slot", joined([(links.error(twin.ref),) for twin in twins]))] if twins else []
        numbers = {(error.kind, error.number) for error in errors}
        related += self._elsewhere(
            (other, error_id(one.kind, one.number), other.error(one.ref).text)
            for other in self._others
            for one in other.device.errors
            if (one.kind, one.number) in numbers
        )
        return replace(entry, related=(*entry.related, *related))

    def _files(self, indexes: Sequence[int]) -> Iterator[Fact]:
        """Whether PDOs can carry it by the EDS and XDD files that hold it."""
        entries = [entry for index in indexes for entry in self._in_files.get(index, ())]
        if entries:
            mappable = sum(entry.mappable for entry in entries)
            carried = {0: "PDOs cannot carry it", len(entries): "PDOs can carry it"}
            yield Fact("In EDS and XDD", carried.get(mappable, "PDOs can carry some of its sub-indexes"))

    def _places(self, links: Links, things: Sequence[_Thing], entry: Entry) -> Iterator[Fact]:
        """Places of the device whose text names one of the things, other than its own entry."""
        own = {anchor.id for anchor in entry.anchors}
        found = {anchor: text for thing in things for anchor, text in self._named[thing].items() if anchor not in own}
        parts: list[Prose] = [(Piece(text, links.href(anchor)),) for anchor, text in found.items()]
        if parts:
            yield Fact("Named in", joined(parts, "; "))

    def _elsewhere(self, found: Iterable[tuple[Links, str, str]]) -> Iterator[Fact]:
        """The same in other devices."""
        parts = [(f"{other.device.order_code} ", Piece(text, other.href(anchor))) for other, anchor, text in found]
        if parts:
            yield Fact("In other devices", joined(parts, "; "))


def _things(texts: Iterable[str]) -> Iterator[_Thing]:
    for text in texts:
        for code, index in _NAMED.findall(text):
            yield ("C", int(code)) if code else ("I", int(index, 16))


def _texts(device: Device) -> Iterator[tuple[str, str, Iterable[str]]]:
    """Anchor, short name and texts of everything that can name a code or an object."""
    for table in device.tables:
        cells = [str(cell) for row in table.rows for cell in row]
        yield named_id("table", table.id), table.name, [table.name, *cells, *table.notes]
    for formula in device.formulas:
        yield named_id("formula", formula.id), formula.name, [formula.expression, formula.note]
    for group in device.switches:
        yield named_id("switch", group.id), group.name, [*group.notes, *(row.value for row in group.rows)]
    for lamps in device.indicators:
        yield named_id("led", lamps.id), lamps.name, [row.meaning for row in lamps.rows]
    for layout in device.layouts:
        yield named_id("layout", layout.id), layout.name, [layout.description]
    for errors in error_entries(device, device.errors):
        first, *_ = errors
        numbers = " / ".join(error_text(error.kind, error.number) for error in errors)
        texts = [text for error in errors for text in (*error.causes, *error.remedies, error.description)]
        yield error_id(first.kind, first.number), f"{numbers} {first.name}", texts
    for codes in code_entries(device.codes):
        numbers = " / ".join(code.designation for code in codes)
        texts = [text for code in codes for text in (code.description, *(sub.description for sub in code.subcodes))]
        yield code_id(codes[0].number), f"{numbers} {codes[0].name}", texts
    for found in device.objects:
        parts = [sub.description for sub in found.subindexes]
        yield object_id(found), f"{found.designation} {found.name}", [found.description, *parts]
