"""The HTML reference: valid, closed in itself, and the same facts as the model in both directions."""

import dataclasses
import re
import shlex
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any, cast
from xml.etree.ElementTree import Element

import html5lib
import pytest
from bare import bare

from generator import dcf
from generator.emit import eds, gsd, html, xdd
from generator.emit.base import Output
from generator.emit.canopen import ObjectDictionary, object_dictionaries
from generator.emit.html.links import Links
from generator.model import (
    Access,
    Bit,
    Chapter,
    Choice,
    Code,
    CodeCounts,
    CodeRef,
    Default,
    Delivered,
    Device,
    DictionaryObject,
    Erratum,
    ErrorEntry,
    ErrorRef,
    Example,
    Field,
    FieldType,
    Formula,
    Layout,
    Light,
    Manual,
    Model,
    NodeRelative,
    Option,
    Origin,
    Pattern,
    PrintedIndex,
    PrintedNumber,
    Range,
    Service,
    SubCode,
    SubIndex,
    SwitchRow,
    Values,
)
from generator.model.citation import UNNAMED
from generator.model.gsd import Keyword
from generator.model.table import Table as PrintedTable

HEADINGS = {f"h{level}": level for level in range(1, 7)}
NOTHING = "–"


class Page:
    """A parsed page: its elements by id and their parents."""

    def __init__(self, source: str) -> None:
        """Parse strictly; html5lib raises ``ParseError`` on the first error."""
        parser = html5lib.HTMLParser(strict=True, namespaceHTMLElements=False)
        self.source = source
        self.root: Element = parser.parse(source)
        self.elements = list(self.root.iter())
        self.parents = {child: parent for parent in self.elements for child in parent}
        self.ids = {element.get("id"): element for element in self.elements if element.get("id")}

    def element(self, name: str) -> Element:
        """The element with an id."""
        return cast(Element, self.ids[name])

    def within(self, name: str, tag: str) -> Element:
        """The nearest ``tag`` that the id stands on or in."""
        element = self.element(name)
        while element.tag != tag:
            element = self.parents[element]
        return element


class Book(Page):
    """Several pages of a device read as one; of an id that stands on more than one page the first counts."""

    def __init__(self, pages: Sequence[Page]) -> None:
        """Bind the pages."""
        self.source = "".join(page.source for page in pages)
        self.root = Element("book")
        self.root.extend(page.root for page in pages)
        self.elements = [element for page in pages for element in page.elements]
        self.parents = {child: parent for page in pages for child, parent in page.parents.items()}
        self.ids = {name: element for page in reversed(pages) for name, element in page.ids.items()}


def text(element: Element | None) -> str:
    """Text of an element, its white space reduced."""
    assert element is not None
    return " ".join("".join(element.itertext()).split())


def with_class(element: Element, name: str) -> list[Element]:
    return [found for found in element.iter() if name in (found.get("class") or "").split()]


def facts(entry: Element, kind: str = "facts") -> dict[str, Element]:
    """Definitions of an entry's own list of facts by their label."""
    lists = [child for child in entry if child.tag == "dl" and child.get("class") == kind]
    assert len(lists) <= 1
    return {text(div.find("dt")): cast(Element, div.find("dd")) for found in lists for div in found}


def target(link: Element) -> str:
    """Anchor that a link leads to; of a page that is all about one thing, the anchor of that thing."""
    path, _, fragment = (link.get("href") or "").partition("#")
    return fragment or path.removesuffix(".html").partition("-")[2]


def main_text(element: Element) -> str:
    """Text without the note after it."""
    whole, notes = text(element), element.findall("small")
    return whole.removesuffix(text(notes[-1])).rstrip() if notes else whole


def table(entry: Element, kind: str) -> list[dict[str, Element]]:
    """Rows of the table of a kind as cells by the head of their column."""
    found = [t for t in with_class(entry, kind) if t.tag == "table"]
    assert len(found) <= 1
    if not found:
        return []
    head = [text(cell) for cell in found[0].findall("thead/tr/th")]
    rows = [row for row in found[0].findall("tbody/tr") if row.get("class") != "more"]
    return [dict(zip(head, row, strict=True)) for row in rows]


def below(page: Page, row_id: str) -> Element | None:
    """The row that says more of the row with that id."""
    body = page.parents[page.within(row_id, "tr")]
    rows = list(body)
    after = rows[rows.index(page.within(row_id, "tr")) + 1 :]
    return after[0] if after and after[0].get("class") == "more" else None


def lists(element: Element | None, direct: bool = True) -> dict[str, dict[str, str]]:
    """Titled lists of keys and meanings; ``direct`` leaves out those inside tables."""
    if element is None:
        return {}
    divs = element.findall("div") if direct else list(element.iter("div"))
    found: dict[str, dict[str, str]] = {}
    for div in divs:
        if div.get("class") == "list":
            items = div.findall("ul/li")
            pairs = [(text(item.find("b")), text(item)) for item in items]
            found[text(div.find("p"))] = {key: whole.removeprefix(key).strip() for key, whole in pairs}
    return found


def number(shown: str) -> Fraction:
    return Fraction(int(shown, 16)) if "0x" in shown else Fraction(shown)


def ends(shown: str) -> tuple[str, str]:
    """Both ends of a run; of a single thing the thing twice."""
    first, _, last = shown.partition(" … ")
    return first, last or first


def numbers(shown: str) -> range:
    first, last = ends(shown)
    return range(int(first, 0), int(last, 0) + 1)


def at(label: str, step: int) -> str:
    """Label of the member of a run that stands ``step`` places after the first."""
    return re.sub(r"(\d+) … \d+", lambda match: str(int(match.group(1)) + step), label)


def references(cell: Element) -> set[tuple[int, int | None]]:
    """References in a cell, runs taken apart."""
    found: set[tuple[int, int | None]] = set()
    shown = text(cell)
    for part in [] if shown == NOTHING else shown.split(", "):
        low, high = (_reference(end) for end in ends(part))
        if low[0] == high[0] and low[1] is not None and high[1] is not None:
            found |= {(low[0], sub) for sub in range(low[1], high[1] + 1)}
        else:
            assert low[1] == high[1]
            found |= {(which, low[1]) for which in range(low[0], high[0] + 1)}
    return found


def _reference(shown: str) -> tuple[int, int | None]:
    name, _, part = shown.partition("/")
    value = int(name[1:]) if name.startswith("C") else int(name.removeprefix("I-"), 16)
    return value, int(part) if part else None


def shown_default(value: Default | None, shown: str) -> bool:
    """Whether a text shows a default."""
    if value is None:
        return shown == NOTHING
    if isinstance(value, NodeRelative):
        return shown.startswith("node address + ") and number(shown.rpartition("+ ")[2]) == value.base
    if isinstance(value, str):
        return shown == f"“{value}”"
    return number(shown) == value


def shown_range(bounds: Range | None, shown: str) -> bool:
    """Whether a text shows a range with its unit."""
    if bounds is None:
        return shown == NOTHING
    match = re.fullmatch(r"(\S+) … (\S+)(?: (.+))?", shown)
    assert match, shown
    return (number(match[1]), number(match[2]), match[3] or "") == (bounds.low, bounds.high, bounds.unit)


def options(shown: dict[str, str]) -> dict[int, str]:
    """A selection list by value, the mark of the default taken off."""
    return {int(key, 0): label.removesuffix(" default") for key, label in shown.items()}


def bits(shown: dict[str, str]) -> dict[int, str]:
    """Bits with their labels, runs taken apart."""
    return {bit: at(label, bit - numbers(key)[0]) for key, label in shown.items() for bit in numbers(key)}


def cite_text(fact: Any) -> str:
    chapter = f", ch. {fact.chapter}" if fact.chapter != "X" else ""
    page = f", p. {fact.page}" if fact.page is not None else ""
    return f"{fact.manual}{chapter}{page}"


@pytest.fixture(scope="module")
def outputs(model: Model) -> dict[str, str]:
    return {path: output.text for path, output in html.render(model).items()}


@pytest.fixture(scope="module")
def pages(outputs: dict[str, str]) -> dict[str, Page]:
    """Every page, parsed."""
    return {path: Page(source) for path, source in outputs.items() if path.endswith(".html")}


PARTS = ("codes", "objects", "errors", "leds", "switches", "telegrams", "tables", "drive", "errata", "files", "sheet")


PART_OF = {
    "led": "leds",
    "switch": "switches",
    "table": "tables",
    "formula": "tables",
    "layout": "telegrams",
    "telegram": "telegrams",
}


def book(pages: dict[str, Page], device: Device, *parts: str) -> Book:
    """Some parts of the reference of a device, the pages of their entries before their lists."""
    lists = [f"{device.id}-{part}.html" if part else f"{device.id}.html" for part in parts]
    others = {f"{device.id}-{part}.html" for part in PARTS}
    entries = [path for path in pages if path.startswith(f"{device.id}-") and path not in others]
    return Book([pages[path] for path in (*(entries if "codes" in parts else ()), *lists) if path in pages])


@pytest.fixture(scope="module")
def devices(model: Model, pages: dict[str, Page]) -> list[tuple[Device, Page]]:
    return [(device, book(pages, device, "codes", "objects", "errors", "drive", "")) for device in model.devices]


@pytest.fixture(scope="module")
def panels(model: Model, pages: dict[str, Page]) -> list[tuple[Device, Page]]:
    return [(device, book(pages, device, "leds", "switches", "telegrams", "tables")) for device in model.devices]


@pytest.fixture(scope="module")
def ledgers(model: Model, pages: dict[str, Page]) -> list[tuple[Device, Page]]:
    return [(device, pages[f"{device.id}-errata.html"]) for device in model.devices]


def anchors(device: Device) -> set[str]:
    """Anchors of all codes, objects and errors."""
    codes = {f"c{code.number:05d}" for code in device.codes}
    objects = {object_id(entry) for entry in device.objects}
    return codes | objects | {error_id(error, error.number) for error in device.errors}


def test_every_code_object_and_error_has_a_page(model: Model, pages: dict[str, Page]) -> None:
    for device in model.devices:
        found = [
            name
            for path, page in pages.items()
            if path.startswith(f"{device.id}-") and page.root.findall("body/main/article")
            for name, element in page.ids.items()
            if name in anchors(device) and element.tag in ("article", "a")
        ]
        assert sorted(found) == sorted(anchors(device))
        for path in (f"{device.id}-{name}.html" for name in found if f"{device.id}-{name}.html" in pages):
            assert pages[path].root.find("body/main/article/h1") is not None


def test_ids_are_unique(pages: dict[str, Page]) -> None:
    for page in pages.values():
        found = [element.get("id") for element in page.elements if element.get("id") is not None]
        assert len(found) == len(set(found))


def broken_links(pages: dict[str, Page]) -> Iterator[str]:
    """Links between pages that lead nowhere; those to other artifacts are left to a test of their own."""
    for path, page in pages.items():
        for element in page.root.iter("a"):
            href = element.get("href") or ""
            if href.startswith(("https://", "http://", "files/")):
                continue
            target, _, fragment = href.partition("#")
            target = target.partition("?")[0]
            if not href or (target and target not in pages) or (fragment and fragment not in pages[target or path].ids):
                yield f"{path}: {href!r}"


def test_every_link_leads_somewhere(pages: dict[str, Page]) -> None:
    assert not list(broken_links(pages))
    assert sum(1 for page in pages.values() for _ in page.root.iter("a")) > 100


def test_no_request_leaves_the_page(outputs: dict[str, str], pages: dict[str, Page]) -> None:
    for page in pages.values():
        assert [link.get("href") for link in page.root.iter("link")] == ["icon.svg", "style.css"]
        scripts = [s.get("src") for s in page.root.iter("script") if s.get("type") != "application/json"]
        assert scripts[0] == "early.js" and set(scripts) <= outputs.keys()
        loading = {"img", "iframe", "object", "embed", "video", "audio", "source", "base", "form"}
        assert not loading & {element.tag for element in page.elements}
        attributes = {name for element in page.elements for name in element.attrib}
        assert not {name for name in attributes if name in ("srcset", "style", "action") or name.startswith("on")}
        policies = [m.get("content") or "" for m in page.root.iter("meta") if m.get("http-equiv")]
        assert len(policies) == 1 and policies[0].startswith("default-src 'none'; style-src 'self'")
    assert "url(" not in outputs["style.css"] and "@import" not in outputs["style.css"]


def test_headings_and_landmarks(pages: dict[str, Page]) -> None:
    for page in pages.values():
        assert page.root.get("lang") == "en"
        levels = [HEADINGS[element.tag] for element in page.elements if element.tag in HEADINGS]
        assert levels[0] == 1 and levels.count(1) == 1
        assert all(after <= before + 1 for before, after in pairwise(levels))
        body = cast(Element, page.root.find("body"))
        tags = [child.tag for child in body]
        assert tags in (["a", "header", "nav", "main", "footer"], ["a", "header", "main", "footer"])
        named = [found.get("aria-label") for found in page.root.iter("nav")]
        assert len(named) == len(set(named)) and all(named)
        assert body[0].get("href") == "#main" and page.element("main").tag == "main"
        for element in page.elements:
            if element.get("aria-labelledby"):
                assert page.element(element.get("aria-labelledby") or "").tag in HEADINGS


def test_tables_have_heads_and_their_own_scroll_container(pages: dict[str, Page]) -> None:
    for page in pages.values():
        for found in page.root.iter("table"):
            assert page.parents[found].get("class") == "scroll"
            width = len(found.findall("thead/tr/th"))
            assert all(cell.get("scope") == "col" for cell in found.findall("thead/tr/th"))
            for row in found.findall("tbody/tr"):
                assert sum(int(cell.get("colspan") or 1) for cell in row) == width
                assert row.get("class") == "more" or (row[0].tag == "th" and row[0].get("scope") == "row")


def test_pages_say_what_they_are_made_from(
    model: Model,
    devices: list[tuple[Device, Page]],
    panels: list[tuple[Device, Page]],
    ledgers: list[tuple[Device, Page]],
    folders: list[tuple[Device, Page]],
) -> None:
    for device, page in (*devices, *panels, *ledgers, *folders):
        manual = device.manual
        footer = text(next(page.root.iter("footer")))
        for shown in (
            manual.title,
            f"edition {manual.edition}",
            model.version,
            model.date,
            "Not a document of the maker",
        ):
            assert shown in footer
        generator = next(m.get("content") or "" for m in page.root.iter("meta") if m.get("name") == "generator")
        assert manual.title in generator and "do not edit" in generator


def code_entry(page: Page, code: Code) -> Element:
    entry = page.within(f"c{code.number:05d}", "article")
    assert "code" in (entry.get("class") or "")
    return entry


def test_codes_have_their_figures(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        for code in device.codes:
            entry = code_entry(page, code)
            heading = cast(Element, entry.find("h1"))
            assert text(with_class(heading, "name")[0]) == code.name
            assert f"c{code.number:05d}" in {entry.get("id"), *(a.get("id") for a in heading.iter("a"))}
            shown = facts(entry)
            assert main_text(shown["Data type"]) == code.type_name
            assert text(shown["Data type"]).endswith(f"{code.data_type.canopen_name} on the bus") == code.is_bitfield
            assert shown_range(code.range, main_text(shown["Range"]))
            words = [w for w, ticked in (("read", code.access.read), ("write", code.access.write)) if ticked]
            assert main_text(shown["Access"]) == ("/".join(words) or NOTHING)
            assert main_text(shown["Scaling"]) == (NOTHING if code.scaling is None else str(code.scaling))
            if code.default is None and any(sub.default is not None for sub in code.subcodes):
                assert main_text(shown["Default"]) == "see subcodes"
            else:
                assert shown_default(code.default, main_text(shown["Default"]))
            if code.default_cite is not None:
                assert f"ch. {code.default_cite.chapter}, p. {code.default_cite.page}" in text(shown["Default"])
            assert text(shown["Since"]).startswith(code.since) if code.since else "Since" not in shown
            assert ("Shared by" in shown) == (code.shared_by is not None)
            lead = [text(p) for p in entry.findall("p") if p.get("class") == "lead"]
            assert lead == ([" ".join(code.description.split())] if code.description else [])


def test_codes_of_both_slots_stand_with_number_index_and_citation(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        seen: dict[str, tuple[str, str, int, int, str]] = {}
        entries = [found for found in with_class(page.root, "code") if found.tag == "article"]
        for entry in entries:
            for row in table(entry, "variants"):
                cells = {name: text(cell) for name, cell in row.items()}
                name = text(with_class(entry, "name")[0])
                figures = (int(cells["Index"]), int(cells["Index hex"], 16))
                seen[cells["Code"]] = (cells["Slot"], name, *figures, cells["Source"])
        assert seen == {
            code.designation: (code.slot or "base drive", code.name, code.index, code.index, cite_text(code.cite))
            for code in device.codes
        }
        overviews = [found for found in with_class(page.root, "overview") if found.tag == "table"]
        listed = {link for t in overviews for a in t.iter("a") if re.fullmatch(r"C\d{5}", link := text(a))}
        assert listed >= {code.designation for code in device.codes}


def test_twins_share_an_entry_or_link_to_each_other(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        for code in device.codes:
            entry = code_entry(page, code)
            for twin in device.codes:
                if twin.twin_of == code.twin_of and code_entry(page, twin) is not entry:
                    assert twin.designation in text(facts(entry, "related")["In the other slot"])


def test_subcodes(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        seen: dict[tuple[str, int], tuple[str, str, dict[int, str]]] = {}
        for code in device.codes:
            for row in table(code_entry(page, code), "subcodes"):
                run = numbers(text(row["Sub"]))
                more = below(page, f"c{code.number:05d}-{run[0]}")
                labels = options(lists(more, direct=False).get("Selection list", {}))
                for sub in run:
                    assert page.within(f"c{code.number:05d}-{sub}", "th" if sub != run[0] else "tr") is not None
                    name = at(text(row["Holds"]), sub - run[0]) if "Holds" in row else NOTHING
                    seen[code.designation, sub] = (name, main_text(row["Default"]), labels)
        expected = {(code.designation, sub.number): (code, sub) for code in device.codes for sub in code.subcodes}
        assert seen.keys() == expected.keys()
        anchors = {name for name in page.ids if name and re.fullmatch(r"c\d{5}-\d+", name)}
        assert anchors == {f"c{code.number:05d}-{sub.number}" for code, sub in expected.values()}
        for key, (_, wanted) in expected.items():
            name, default, labels = seen[key]
            assert name == (wanted.name or NOTHING)
            assert shown_default(wanted.default, default), (key, default)
            assert labels == {option.value: option.label for option in wanted.options}


def test_rules_over_the_node_address(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        for code in device.codes:
            for sub in code.subcodes:
                if sub.follows is not None:
                    row = text(page.within(f"c{code.number:05d}-{sub.number}", "tr"))
                    assert f"node address + 0x{sub.follows.base:03X}" in row


def test_values_of_codes(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        for code in device.codes:
            shown = lists(code_entry(page, code))
            labels = shown.get("Selection list", {})
            assert options(labels) == {option.value: option.label for option in code.options}
            marked = [int(key, 0) for key, label in labels.items() if label.endswith(" default")]
            assert marked == [option.value for option in code.options if option.value == code.default]
            assert bits(shown.get("Bits", {})) == {bit.number: bit.label for bit in code.bits}
            assert [(*map(int, ends(k)), label) for k, label in shown.get("Bit fields", {}).items()] == [
                (field.low, field.high, field.label) for field in code.fields
            ]


def mirrors(device: Device) -> set[tuple[tuple[int, int | None], tuple[int, int | None]]]:
    """Pairs of code and object that either side relates."""
    from_codes = {((c.number, None), (o.index, o.subindex)) for c in device.codes for o in c.objects}
    from_objects = {
        ((ref.number, ref.subcode), (entry.index, sub.number))
        for entry in device.objects
        for sub in entry.subindexes
        for ref in sub.codes
    }
    return from_codes | from_objects


def exact(refs: set[tuple[int, int | None]]) -> set[tuple[int, int | None]]:
    """References without wholes of which a part is named as well."""
    parts = {which for which, part in refs if part is not None}
    return {(which, part) for which, part in refs if part is not None or which not in parts}


def test_codes_and_objects_lead_to_each_other(devices: list[tuple[Device, Page]]) -> None:
    assert any(mirrors(device) for device, _ in devices)
    for device, page in devices:
        pairs = mirrors(device)
        entries = {code.number: code_entry(page, code) for code in device.codes}
        for code in device.codes:
            together = {number for number, entry in entries.items() if entry is entries[code.number]}
            related = facts(entries[code.number], "related")
            shown = references(related["Objects"]) if "Objects" in related else set()
            assert shown == exact({o for c, o in pairs if c[0] in together})
        for entry in device.objects:
            overview = {ref for c, o in pairs if o[0] == entry.index for ref in [c]}
            shown_rows: set[tuple[int, int | None]] = set()
            article = page.element(object_id(entry))
            for row in table(article, "subindexes"):
                run = numbers(text(row["Sub"]))
                expected = {c for c, o in pairs if o[0] == entry.index and o[1] in run}
                assert references(row["Codes"]) == exact(expected)
                shown_rows |= references(row["Codes"])
            whole = references(facts(article)["Codes"]) if "Codes" in facts(article) else set()
            assert {number for number, _ in whole | shown_rows} == {number for number, _ in overview}


def test_objects_have_their_figures(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        articles = {f.get("id") for f in with_class(page.root, "object") if f.tag == "article"}
        assert articles == {object_id(entry) for entry in device.objects}
        seen = set()
        for entry in device.objects:
            article = page.element(object_id(entry))
            shown = facts(article)
            assert int(main_text(shown["Index"]), 16) == entry.index
            assert text(shown["Index"]).endswith(str(entry.index))
            assert text(shown["Object type"]) == entry.object_type
            assert text(shown["Source"]) == cite_text(entry.cite)
            assert text(with_class(article, "name")[0]) == entry.name
            for row in table(article, "subindexes"):
                run = numbers(text(row["Sub"]))
                for sub_number in run:
                    sub = entry.subindex(sub_number)
                    assert sub is not None
                    seen.add(f"{object_id(entry)}-{sub_number}")
                    check_subindex(sub, row, at(text(row["Name"]), sub_number - run[0]))
                first = entry.subindex(run[0])
                assert first is not None
                check_subindex_values(first, below(page, f"{object_id(entry)}-{run[0]}"))
        anchors = {name for name in page.ids if name and re.fullmatch(r"(i-[0-9a-f]{4}|pnu-\d+)-\d+", name)}
        assert seen == anchors
        assert anchors == {f"{object_id(e)}-{sub.number}" for e in device.objects for sub in e.subindexes}


def object_id(entry: DictionaryObject) -> str:
    return f"i-{entry.index:04x}" if entry.kind == "canopen" else f"pnu-{entry.index}"


def check_subindex(sub: SubIndex, row: dict[str, Element], name: str) -> None:
    assert name == sub.name
    assert text(row["Data type"]) == sub.data_type.canopen_name
    assert text(row["Access"]) == sub.access
    assert shown_default(sub.default, main_text(row["Default"]))
    notes = [text(note) for note in row["Default"].findall("small")]
    assert all(number(note) == sub.default for note in notes)
    assert shown_range(sub.range, text(row["Range"]))
    assert text(row["PDO"]) == ("yes" if sub.pdo_mapping else "no")


def check_subindex_values(sub: SubIndex, more: Element | None) -> None:
    said = text(more) if more is not None else ""
    assert " ".join(sub.description.split()) in said
    assert sub.signature is None or sub.signature in said
    assert sub.abort is None or f"0x{sub.abort:08x}" in said
    assert ("Has no function." in said) == sub.unused
    assert (sub.printed_type == sub.data_type) or f"prints the data type {sub.printed_type.canopen_name}." in said
    assert (sub.printed_access == sub.access) or f"prints the access {sub.printed_access}." in said
    shown = lists(more, direct=False)
    assert options(shown.get("Selection list", {})) == {option.value: option.label for option in sub.options}
    assert bits(shown.get("Bits", {})) == {bit.number: bit.label for bit in sub.bits}
    assert [(*map(int, ends(k)), label) for k, label in shown.get("Bit fields", {}).items()] == [
        (field.low, field.high, field.label) for field in sub.fields
    ]


def error_id(error: ErrorEntry, number: int) -> str:
    if error.kind == "device":
        return f"e-0x{number:08x}"
    prefix = {"emergency": "emcy", "sdo_abort": "abort"}.get(error.kind, error.kind)
    digits = {"emergency": 4, "dpv1": 4, "gci": 4}.get(error.kind, 8)
    return f"{prefix}-0x{number:0{digits}x}"


def canonical(device: Device, response: str | None) -> str:
    known = device.drive.responses if device.drive else ()
    names = [r.name for r in known if response in (r.name, *r.aliases)]
    return names[0] if names else response or NOTHING


def error_rows(page: Page) -> dict[str, dict[str, Element]]:
    """Rows of the overviews of errors by the anchor that they lead to."""
    found = {}
    for overview in with_class(page.root, "errors"):
        for row in table(page.parents[overview], "errors"):
            found[target(row["Number"][0])] = row
    return found


def test_errors_have_their_figures(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        rows = error_rows(page)
        assert rows.keys() == {error_id(error, error.number) for error in device.errors}
        for error in device.errors:
            row = rows[error_id(error, error.number)]
            last = error.last if error.count > 1 else error.number
            assert numbers(text(row["Number"])) == range(error.number, last + 1)
            assert numbers(text(row["Decimal"])) == range(error.number, last + 1)
            assert text(row["Name"]).startswith(error.name)
            if "Response" in row:
                assert text(row["Response"]) == canonical(device, error.response)
                assert references(row["Set in"]) == {(ref.number, ref.subcode) for ref in error.adjustable_in}
            assert ("Error register" not in row) or text(row["Error register"]) == (error.register or NOTHING)


def test_errors_have_causes_remedies_and_citation(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        for error in device.errors:
            place = page.ids[error_id(error, error.number)]
            if place.tag == "tr":
                assert not (error.causes or error.remedies or error.adjustable_in or error.errata)
                assert text(error_rows(page)[error_id(error, error.number)]["Source"]) == cite_text(error.cite)
                continue
            entry = page.within(error_id(error, error.number), "article")
            shown = facts(entry)
            assert text(shown["Response"]) == canonical(device, error.response)
            selectable = [canonical(device, name) for name in error.responses]
            if selectable == [canonical(device, error.response)]:
                assert text(shown["Selectable"]) == "no other"
            else:
                assert selectable == (text(shown["Selectable"]).split(", ") if "Selectable" in shown else [])
            bullets = {text(div.find("p")): [text(li) for li in div.iter("li")] for div in entry.findall("div/div")}
            assert bullets.get("Causes", []) == list(error.causes)
            assert bullets.get("Remedies", []) == list(error.remedies)
            variants = [{k: text(v) for k, v in row.items()} for row in table(entry, "variants")]
            row = next(v for v in variants if numbers(v["Number"])[0] == error.number)
            assert numbers(row["Number"])[-1] == error.last and numbers(row["Decimal"])[-1] == error.last
            assert row["Slot"] == (error.slot or NOTHING) and row["Source"] == cite_text(error.cite)


def test_every_number_of_a_run_has_its_anchor_and_code(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        for error in device.errors:
            if error.count == 1 or len(error.adjustable_in) != error.count:
                continue
            for step, ref in enumerate(error.adjustable_in):
                place = page.ids[error_id(error, error.number + step)]
                if step:
                    number = error.number + step
                    assert (place.tag, place.get("class")) == ("p", "asked")
                    assert text(place) == f"0x{number:08x} = {number}, response set in {ref}"
                    keys = [a for a in page.root.iter("a") if a.get("href") == f"#{place.get('id')}"]
                    assert [text(key) for key in keys] == [f"0x{number:08x}"]


def test_codes_name_the_errors_whose_response_they_set(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        entries = {code.number: code_entry(page, code) for code in device.codes}
        for code in device.codes:
            together = {number for number, entry in entries.items() if entry is entries[code.number]}
            expected = {
                error_id(error, error.number)
                for error in device.errors
                if together & {ref.number for ref in error.adjustable_in}
            }
            shown = facts(entries[code.number], "related").get("Sets the response to")
            assert {target(a) for a in shown.iter("a")} == expected if shown is not None else not expected


def test_errata_ledger(ledgers: list[tuple[Device, Page]]) -> None:
    for device, page in ledgers:
        articles = {f.get("id") for f in with_class(page.root, "erratum") if f.tag == "article"}
        assert articles == {f"erratum-{erratum.id}" for erratum in device.errata}
        for erratum in device.errata:
            entry = page.element(f"erratum-{erratum.id}")
            shown = facts(entry)
            assert (
                main_text(shown["Printed"]) == erratum.printed_text if erratum.printed_text else "Printed" not in shown
            )
            assert text(shown["Used"]) == erratum.used_text
            assert text(shown["Confidence"]) == erratum.confidence
            assert text(shown["Check"]) == erratum.rule if erratum.rule else "Check" not in shown
            group = "dump" if erratum.origin == "dump" else erratum.kind
            assert page.parents[entry].get("aria-labelledby") == f"errata-{group}"
            assert ("Kind" in shown) == (erratum.origin == "dump")
            assert text(entry.find("p")) == " ".join(erratum.why.split())
            rows = [tuple(map(text, row.values())) for row in table(entry, "places")]
            assert rows == [
                (p.location, p.printed, p.manual + (f", p. {p.page}" if p.page is not None else ""))
                for p in erratum.places
            ]
            concerned = text(facts(entry, "related")["Concerns"])
            named = ", ".join(erratum.about_text)
            assert concerned.startswith(named)
            check_concerns(erratum, concerned.removeprefix(f"{named}: "))


def check_concerns(erratum: Erratum, listed: str) -> None:
    codes = {(s.number, s.subcode) for s in erratum.about if isinstance(s, CodeRef)}
    shown = [part for part in listed.split(", ") if part.startswith("C")]
    cell = Element("td")
    cell.text = ", ".join(shown) or NOTHING
    assert references(cell) == codes


def test_entries_show_their_errata(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        pages_of: dict[str, set[str]] = {}
        places: list[tuple[tuple[str, ...], str]] = [(c.errata, f"c{c.number:05d}") for c in device.codes]
        places += [(error.errata, error_id(error, error.number)) for error in device.errors]
        for entry in device.objects:
            inner = tuple(name for sub in entry.subindexes for name in sub.errata)
            places.append((entry.errata + inner, object_id(entry)))
        expected: dict[str, set[str]] = {}
        for names, place in places:
            if page.ids[place].tag == "tr":
                assert not names
                continue
            article = page.within(place, "article").get("id") or ""
            expected.setdefault(article, set()).update(f"{device.id}-errata.html#erratum-{name}" for name in names)
            notes = with_class(page.element(article), "note")
            pages_of[article] = {cast(Element, note.find("p/a")).get("href") or "" for note in notes}
        assert pages_of == expected


def test_slips_of_the_dump_are_told_apart(
    devices: list[tuple[Device, Page]], panels: list[tuple[Device, Page]]
) -> None:
    for device, page in (*devices, *panels):
        slips = {e.id for e in device.errata if e.origin == "dump"}
        for note in with_class(page.root, "note"):
            link = (cast(Element, note.find("p/a")).get("href") or "").partition("#erratum-")[2]
            assert (link in slips) == ("slip" in (note.get("class") or "")) == text(note).startswith("Slip")


def test_wrong_indexes_stand_beside_the_right_ones(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        for code in device.codes:
            notes = " ".join(map(text, with_class(code_entry(page, code), "note")))
            for printed in code.printed:
                if code.index != printed.decimal == printed.hexadecimal:
                    shown = f"{printed.decimal} / {printed.hexadecimal:04X}h; used: {code.index} / {code.index:04X}h"
                    assert shown in notes
                elif printed.hexadecimal not in (None, code.index):
                    assert f"{printed.hexadecimal:04X}h; used: {code.index:04X}h" in notes


def test_what_is_printed_stands_verbatim(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        for code in device.codes:
            lines = [text(li) for li in code_entry(page, code).findall("details/ul/li")]
            for printed in code.printed:
                figures = f"{printed.decimal}" + (f" / {printed.hexadecimal:04X}h" if printed.hexadecimal else "")
                assert any(line.endswith(f"p. {printed.page}: {figures}") for line in lines)
            row = code.attributes
            if row is not None:
                shown = f"{row.structure} {row.count} {row.type_name}, factor {row.factor}, {row.access}"
                assert any(shown in line for line in lines)


def test_base_drive(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        drive = device.drive
        if drive is None:
            assert "drive-error-number" not in page.ids
            continue
        section = page.within("drive-error-number", "main")
        assert text(facts(section)["Index of a code"]).startswith(f"{drive.index_base} − code number")
        layout = {text(r["Field"]): (text(r["Bits"]), int(text(r["Mask"]), 16)) for r in table(section, "layout")}
        assert layout == {name: (f"{f.high} … {f.low}", f.mask) for name, f in drive.error_fields}
        responses = [tuple(map(text, row.values())) for row in table(section, "responses")]
        expected = [(str(r.value), r.name, ", ".join(r.aliases) or NOTHING) for r in drive.responses]
        assert [row[:3] for row in responses] == expected
        assert all(row[3].startswith(cite_text(r.cite)) for row, r in zip(responses, drive.responses, strict=True))
        modules = [
            (int(text(r["Value"])), int(text(r["Hex"]), 16), text(r["Module"])) for r in table(section, "modules")
        ]
        assert modules == [(m.value, m.value, m.name) for m in drive.modules]
        commands = [(text(r["Value"]), text(r["Command"])) for r in table(section, "commands")]
        assert drive.command_code is not None
        assert commands == [(f"{CodeRef(drive.command_code)} = {c.value}", c.name) for c in drive.commands]
        written = text(facts(section)["Device commands are written to"])
        index = drive.index_base - drive.command_code
        assert written == f"{CodeRef(drive.command_code)}, index {index} = 0x{index:04X}"


def test_first_page_lists_devices_and_sources(model: Model, pages: dict[str, Page]) -> None:
    page = pages["index.html"]
    cards = with_class(page.root, "card")
    assert [cast(Element, card.find("h3/a")).get("href") for card in cards] == [f"{d.id}.html" for d in model.devices]
    for device, card in zip(model.devices, cards, strict=True):
        figures = {a.get("href") or "": text(a.find("b")) for a in card.iter("a") if a.find("b") is not None}
        for part in ("codes", "objects", "errors", "errata"):
            count = len(getattr(device, part))
            assert figures.get(f"{device.id}-{part}.html", "0") == str(count)
        assert device.title in text(card) and device.order_code in text(card) and device.bus in text(card)
    sources = {text(row["Source"]): row for row in table(page.root, "sources")}
    assert sources.keys() == {manual.id for manual in model.manuals}
    for manual in model.manuals:
        row = sources[manual.id]
        shown = tuple(text(row[name]) for name in ("Title", "Publisher", "Edition", "Date"))
        assert shown == (manual.title, manual.publisher, manual.edition, manual.date or NOTHING)
        assert cast(Element, row["Source"].find("a")).get("href") == f"coverage.html#manual-{manual.id}"
        assert page.element(f"manual-{manual.id}").tag == "tr"


STATES = {
    "transcribed": "transcribed",
    "not-applicable": "without facts of this kind",
    "lost": "lost in the text dump",
    "pending": "not yet",
    None: "not yet",
}


def test_coverage_has_every_source_and_chapter(model: Model, pages: dict[str, Page]) -> None:
    page = pages["coverage.html"]
    assert {f.get("id") for f in with_class(page.root, "source")} == {f"manual-{m.id}" for m in model.manuals}
    assert sum(len(manual.chapters) for manual in model.manuals) > 100
    for manual in model.manuals:
        entry = page.element(f"manual-{manual.id}")
        assert text(with_class(entry, "name")[0]) == manual.title
        said = {name: text(value) for name, value in facts(entry).items() if name != "Describes"}
        optional = {"Date": manual.date, "Document": manual.document, "Pages": manual.pages, "Address": manual.url}
        assert said == {
            "Kind": "public document" if manual.kind == "public" else manual.kind,
            "Publisher": manual.publisher,
            "Edition": manual.edition,
            **{name: str(value) for name, value in optional.items() if value},
        }
        chapters = [tuple(map(text, row.values())) for row in table(entry, "chapters")]
        assert chapters == [
            (c.number, c.title, str(c.page or NOTHING), STATES[c.status], " ".join((c.note or "").split()))
            for c in manual.chapters
        ]
        assert all(page.element(f"manual-{manual.id}-{c.number}").tag == "tr" for c in manual.chapters)


def test_coverage_counts_chapters_and_lists_what_is_lost(model: Model, pages: dict[str, Page]) -> None:
    page = pages["coverage.html"]
    counts = {
        text(row["Source"]): [text(cell) for cell in list(row.values())[3:]] for row in table(page.root, "counts")
    }
    assert counts == {
        manual.id: [
            str(len(manual.chapters)),
            *(str(sum(STATES[c.status] == state for c in manual.chapters)) for state in dict.fromkeys(STATES.values())),
        ]
        for manual in model.manuals
    }
    lost = {(text(r["Source"]), text(r["Chapter"]), text(r["Title"])) for r in table(page.root, "lost")}
    assert lost == {(m.id, c.number, c.title) for m in model.manuals for c in m.chapters if c.status == "lost"}
    assert lost


def test_pages_of_a_device_lead_to_each_other(model: Model, pages: dict[str, Page]) -> None:
    for device in model.devices:
        own = [path for part in ("", *PARTS) if (path := f"{device.id}{part and '-'}{part}.html") in pages]
        assert len(own) > 5
        for path, page in pages.items():
            if path in own or path.startswith(f"{device.id}-"):
                listed = list(cast(Element, page.root.find("body/nav/ul")).iter("a"))
                assert [a.get("href") for a in listed] == [*own, f"coverage.html#manual-{device.manual.id}"]
                assert [a.get("href") for a in listed if a.get("aria-current")] == [path] * (path in own)


def named(device: Device) -> dict[str, Any]:
    """Everything that has a name alone, by its anchor."""
    kinds = (
        ("led", device.indicators),
        ("switch", device.switches),
        ("table", device.tables),
        ("formula", device.formulas),
        ("layout", device.layouts),
        ("telegram", device.examples),
        ("service", device.services),
    )
    return {f"{kind}-{entry.id}": entry for kind, entries in kinds for entry in cast(tuple[Any, ...], entries)}


def test_named_things_have_entries_citations_and_errata(panels: list[tuple[Device, Page]]) -> None:
    for device, page in panels:
        entries = {found.get("id") or "": found for found in with_class(page.root, "entry")}
        assert entries.keys() == named(device).keys()
        for anchor, thing in named(device).items():
            entry = entries[anchor]
            assert text(with_class(entry, "name")[0]) == thing.name
            assert text(facts(entry)["Source"]) == cite_text(thing.cite)
            notes = {cast(Element, note.find("p/a")).get("href") for note in with_class(entry, "note")}
            assert notes == {f"{device.id}-errata.html#erratum-{name}" for name in thing.errata}
            origin = getattr(thing, "origin", Origin.MANUAL)
            assert [text(em) for em in cast(Element, entry.find("h3")).iter("em")] == MARKS[origin]
        overviews = [found for found in with_class(page.root, "overview") if found.tag == "table"]
        rows = [row for found in overviews for row in found.findall("tbody/tr")]
        listed = {(row[0][0].get("href") or "")[1:]: (text(row[1]), text(row[-1])) for row in rows}
        assert listed == {anchor: (thing.name, brief(device, thing)) for anchor, thing in named(device).items()}


def brief(device: Device, thing: Any) -> str:
    """Last cell of the overview: bytes, expression, layouts, or a count of rows or examples."""
    match thing:
        case Example():
            return " ".join("XX" if octet is None else f"{octet:02X}" for octet in thing.data)
        case Formula():
            return thing.expression
        case Layout():
            return str(sum(example.layout == thing.id for example in device.examples))
        case Service():
            return answer_layouts(thing)
        case _:
            return str(len(thing.rows))


def answer_layouts(service: Service) -> str:
    if service.answer is None:
        return NOTHING
    layout = service.answer.layout
    return ", ".join(str(name) for _, name in layout.cases) if isinstance(layout, Choice) else layout


MARKS = {
    Origin.MANUAL: [],
    Origin.STANDARD: ["from a standard"],
    Origin.DERIVED: ["derived"],
    Origin.ASSUMED: ["assumed"],
    Origin.PUBLIC: ["from a public document"],
}


def test_errata_lead_to_named_things_and_back(
    ledgers: list[tuple[Device, Page]], panels: list[tuple[Device, Page]]
) -> None:
    seen = 0
    for (device, ledger), (_, panel) in zip(ledgers, panels, strict=True):
        for erratum in device.errata:
            links = {a.get("href") for a in facts(ledger.element(f"erratum-{erratum.id}"), "related")["Concerns"]}
            for subject in {subject for subject in erratum.about if isinstance(subject, str)}:
                kind, _, name = subject.partition(":")
                if kind == "device":
                    assert f"{device.id}.html#device" in links
                    continue
                assert f"{device.id}-{PART_OF[kind]}.html#{kind}-{name}" in links
                back = [
                    a.get("href")
                    for note in with_class(panel.element(f"{kind}-{name}"), "note")
                    for a in note.iter("a")
                ]
                assert f"{device.id}-errata.html#erratum-{erratum.id}" in back
                seen += 1
    assert seen > 10


def seconds(value: Fraction | None) -> str:
    return "" if value is None else f"{float(value):g} s"


def in_words(pattern: Pattern) -> str:
    """What a reader sees of a pattern: its words and its notation."""
    colour = f" {pattern.colour}" if pattern.colour else ""
    times = {1: "once", 2: "twice"}.get(pattern.flashes or 0, f"{pattern.flashes} times")
    period, pause = seconds(pattern.period), seconds(pattern.pause)
    return {
        Light.ANY: NOTHING,
        Light.OFF: "off off",
        Light.ON: f"lit{colour} on{colour}",
        Light.FLICKER: f"flickers{colour} flicker{colour}",
        Light.ON_OR_FLICKER: f"lit or flickers{colour} on or flicker{colour}",
        Light.BLINK: f"blinks{colour}"
        + (f", changes every {period} blink{colour} {period}" if period else f" blink{colour}"),
        Light.FLASH: f"flashes{colour} {times}"
        + (f", then {pause} dark" if pause else "")
        + f" flash{colour} {pattern.flashes}"
        + (f", {pause} off" if pause else ""),
    }[pattern.light]


def test_leds(panels: list[tuple[Device, Page]], outputs: dict[str, str]) -> None:
    assert any(device.indicators for device, _ in panels)
    for device, page in panels:
        for indicator in device.indicators:
            entry = page.element(f"led-{indicator.id}")
            for led in indicator.leds:
                assert text(facts(entry)[f"LED {led.label}"]) == " ".join(filter(None, (led.colour, led.name)))
            rows = table(entry, "lamps")
            assert len(rows) == len(indicator.rows)
            for number, (row, shown) in enumerate(zip(indicator.rows, rows, strict=True), 1):
                assert list(shown)[: len(indicator.leds)] == [f"{led.label} ({led.colour})" for led in indicator.leds]
                cells = list(shown.values())[: len(indicator.leds)]
                assert [text(cell) for cell in cells] == [in_words(pattern) for pattern in row.patterns]
                assert (text(shown["State"]), text(shown["Meaning"])) == (row.state, row.meaning or NOTHING)
                assert page.element(f"led-{indicator.id}.{number}").tag == "tr"
                for led, pattern, cell in zip(indicator.leds, row.patterns, cells, strict=True):
                    check_drawing(led.colour, pattern, cell, outputs["style.css"])


def check_drawing(colour: str, pattern: Pattern, cell: Element, css: str) -> None:
    """The drawing has the LED's colour and moves in the times of the pattern."""
    drawings = with_class(cell, "led")
    assert len(drawings) == (pattern.light is not Light.ANY)
    for drawing in drawings:
        *_, shown, light = (drawing.get("class") or "").split()
        assert shown == (pattern.colour or colour)
        found = re.search(rf"@keyframes {light} \{{(.*?)\n\}}", css, re.DOTALL)
        assert (found is None) == (pattern.light in (Light.ON, Light.OFF, Light.ON_OR_FLICKER))
        if found is None:
            assert light == ("off" if pattern.light is Light.OFF else "on")
            continue
        whole = re.search(rf"\.{light} \{{ animation: {light} ([0-9.]+)s step-end infinite; \}}", css)
        assert whole
        frames = [
            (Fraction(at), lit != "transparent")
            for at, lit in re.findall(r"([0-9.]+)% \{ background: ([^;]+);", found[1])
        ]
        assert frames[0] == (Fraction(0), True)
        assert all(a[1] != b[1] and a[0] < b[0] for a, b in pairwise(frames))
        rests = [b[0] - a[0] for a, b in pairwise([*frames, (Fraction(100), True)])]
        times = [Fraction(whole[1]) * rest / 100 for rest in rests]
        if pattern.period is not None:
            assert times == [pattern.period] * 2
        if pattern.flashes is not None:
            assert len(times) == 2 * pattern.flashes
        if pattern.pause is not None:
            assert abs(times[-1] - pattern.pause) < Fraction(1, 1000)


def test_drawings_move_only_where_readers_want_it(outputs: dict[str, str], panels: list[tuple[Device, Page]]) -> None:
    css = outputs["style.css"]
    wanted = css[css.index("@media (prefers-reduced-motion: no-preference)") :]
    assert css.count("animation:") == wanted[: wanted.index("\n}\n")].count("animation:") > 0
    assert all("main:has(#blink:checked)" in line for line in css.splitlines() if "animation:" in line)
    for device, page in panels:
        assert ("blink" in page.ids) == bool(device.indicators)


def test_switches(panels: list[tuple[Device, Page]]) -> None:
    assert any(device.switches for device, _ in panels)
    signs = {"1": "ON", "0": "off", "x": "either"}
    for device, page in panels:
        for group in device.switches:
            entry = page.element(f"switch-{group.id}")
            shown = facts(entry)
            assert text(shown["Switches"]) == ", ".join(group.labels)
            assert ("Weights" in shown) == bool(group.weights)
            assert not group.weights or main_text(shown["Weights"]) == ", ".join(map(str, group.weights))
            if group.valid:
                assert tuple(map(int, ends(main_text(shown["Valid"])))) == group.valid
            assert references(shown["Held in"]) == {(r.number, r.subcode) for r in group.sets} if group.sets else True
            unit = f" [{group.unit}]" if group.unit else ""
            seen = []
            for positions in with_class(entry, "positions"):
                assert [text(th) for th in positions.findall("thead/tr/th")] == [f"Value{unit}", *group.labels]
                seen += [tuple(map(text, row)) for row in positions.findall("tbody/tr")]
            assert seen == [(row.value, *(signs[position] for position in row.positions)) for row in group.rows]
            assert [text(li) for li in entry.findall("div/div/ul/li")] == [" ".join(n.split()) for n in group.notes]
            for row in group.rows:
                if row.value.isdigit():
                    assert text(page.element(f"switch-{group.id}.{row.value}")[0]) == row.value
            special = [row for row in group.rows if not row.value.isdigit()]
            if 0 < len(special) < len(group.rows):
                for row in special:
                    said = f"{row.value}: {' '.join(signs[position] for position in row.positions)}"
                    assert said in text(shown["Special positions"])


def test_tables_have_every_printed_cell(panels: list[tuple[Device, Page]]) -> None:
    assert sum(len(t.rows) for device, _ in panels for t in device.tables) > 100
    for device, page in panels:
        for printed in device.tables:
            entry = page.element(f"table-{printed.id}")
            found = with_class(entry, "printed")[0]
            head = [f"{c.name} [{c.unit}]" if c.unit else c.name for c in printed.columns]
            assert [text(th) for th in found.findall("thead/tr/th")] == [" ".join(name.split()) for name in head]
            rows = [[text(cell) for cell in row] for row in found.findall("tbody/tr")]
            expected = [
                [NOTHING if cell == "-" else " ".join(str(cell).split()) for cell in row] for row in printed.rows
            ]
            assert rows == expected
            assert [row.get("id") for row in found.findall("tbody/tr")] == [
                f"table-{printed.id}.{number}" for number in range(1, len(printed.rows) + 1)
            ]
            assert [text(li) for li in entry.findall("div/div/ul/li")] == [" ".join(n.split()) for n in printed.notes]
            assert text(facts(entry)["Table of"]) == printed.kind.replace("-", " ")


def test_formulas_with_their_worked_examples(panels: list[tuple[Device, Page]]) -> None:
    assert any(formula.examples for device, _ in panels for formula in device.formulas)
    for device, page in panels:
        for formula in device.formulas:
            entry = page.element(f"formula-{formula.id}")
            shown = facts(entry)
            assert text(shown["Expression"]) == formula.expression
            assert text(shown["Unit"]) == formula.unit if formula.unit else "Unit" not in shown
            assert (" ".join(formula.note.split()) or None) == (text(entry.find("p")) if formula.note else None)
            rows = table(entry, "worked")
            assert len(rows) == len(formula.examples)
            for row, example in zip(rows, formula.examples, strict=True):
                cells = {name: text(cell) for name, cell in row.items()}
                source, result = (
                    cells.pop("Source"),
                    cells.pop(f"Result [{formula.unit}]" if formula.unit else "Result"),
                )
                del cells["Example"]
                values = {name: int(value) for name, value in cells.items() if value != NOTHING}
                assert values == dict(example.values) and source == cite_text(example.cite)
                assert int(result) == example.result == formula.evaluate(values)


def fields_of(fields: tuple[Field, ...], path: str = "") -> Iterator[tuple[str, Field]]:
    """Fields and those of their groups by name."""
    for field in fields:
        yield path + field.name, field
        yield from fields_of(field.fields, f"{path}{field.name}.")


def test_layouts(panels: list[tuple[Device, Page]]) -> None:
    assert any(device.layouts for device, _ in panels)
    for device, page in panels:
        for layout in device.layouts:
            entry = page.element(f"layout-{layout.id}")
            assert text(facts(entry)["Protocol"]) == layout.protocol
            rows = {text(row["Field"]): row for row in table(entry, "fields")}
            fields = dict(fields_of(layout.fields))
            assert list(rows) == list(fields)
            for name, field in fields.items():
                row = rows[name]
                assert page.element(f"layout-{layout.id}.{name}") is page.parents[row["Field"]]
                assert text(row["Title"]) == field.title
                assert text(row["Length"]) == shown_length(field)
                many = field.length != 1 and field.type in (FieldType.UINT, FieldType.INT)
                assert (text(row["Type"]).partition(", ")[2] != "") == many
                assert ("high byte first" in text(row["Type"])) == (many and field.big)
                if field.constant is None:
                    assert text(row["Constant"]) == NOTHING
                else:
                    assert int(main_text(row["Constant"]), 0) == field.constant
                check_field_values(field, below(page, f"layout-{layout.id}.{name}"))
            named_in = facts(entry, "related").get("Worked examples")
            examples = [e.id for e in device.examples if e.layout == layout.id]
            assert (text(named_in).split(", ") if named_in is not None else []) == examples


def shown_length(field: Field) -> str:
    if field.type is FieldType.GROUP:
        return f"repeats {field.count} times" if field.count else "repeats to the end"
    if field.sizes and field.sizes.fills:
        return f"up to a multiple of {field.sizes.fills}"
    if field.sizes:
        return f"by {field.sizes.by}" + (f", times {field.sizes.times}" if field.sizes.times else "")
    return "the rest" if field.length is None else str(field.length)


def check_field_values(field: Field, more: Element | None) -> None:
    assert " ".join(field.description.split()) in (text(more) if more is not None else "")
    shown = lists(more, direct=False)
    assert options(shown.pop("Values", {})) == {option.value: option.label for option in field.values}
    parts = [(*map(int, ends(key)), label) for key, label in shown.pop("Bits", {}).items()]
    assert parts == [(part.low, part.high, part.label) for part in field.bits]
    for name, meanings in field.bit_values:
        assert options(shown.pop(f"Values of {name}")) == {option.value: option.label for option in meanings}
    if field.sizes:
        sizes = shown.pop(f"Length in bytes by {field.sizes.by}")
        assert {int(key, 0): int(size) for key, size in sizes.items()} == dict(field.sizes.sizes)
    assert not shown


def test_offsets_of_fields_follow_from_the_lengths_before(panels: list[tuple[Device, Page]]) -> None:
    for device, page in panels:
        for layout in device.layouts:
            rows = {
                text(row["Field"]): text(row["Offset"]) for row in table(page.element(f"layout-{layout.id}"), "fields")
            }
            before: list[Field] = []
            for field in layout.fields:
                fixed = [f.length for f in before if isinstance(f.length, int) and f.type is not FieldType.GROUP]
                if len(fixed) == len(before):
                    assert rows[field.name] == str(sum(fixed))
                else:
                    assert rows[field.name] == f"after {before[-1].name}"
                before.append(field)


def octets(shown: str) -> list[int | None]:
    return [None if octet == "XX" else int(octet, 16) for octet in shown.split() if octet != NOTHING]


def flat(values: Values, path: str = "") -> dict[str, int | str]:
    """Values by name, those in groups with the number of the repetition."""
    found: dict[str, int | str] = {}
    for name, value in values.items():
        if isinstance(value, tuple):
            for number, inner in enumerate(value, 1):
                found |= flat(inner, f"{path}{name}[{number}].")
        else:
            found[path + name] = value
    return found


def shown_value(cell: Element) -> int | str:
    """Value of a field; numbers of more than a digit stand in hexadecimal with the decimal form behind."""
    shown = main_text(cell)
    notes = [text(note) for note in cell.findall("small")]
    if notes:
        assert int(shown, 16) == int(notes[0])
    if re.fullmatch(r"-?\d+|-?0x[0-9A-F]+", shown):
        return int(shown, 0)
    return {"open": "XX", NOTHING: ""}.get(shown, shown)


def test_telegrams_byte_by_byte_and_field_by_field(panels: list[tuple[Device, Page]]) -> None:
    assert sum(len(device.examples) for device, _ in panels) > 20
    for device, page in panels:
        layouts = {layout.id: dict(fields_of(layout.fields)) for layout in device.layouts}
        for example in device.examples:
            entry = page.element(f"telegram-{example.id}")
            shown = facts(entry)
            same = example.printed == example.data
            printed, used = ("Bytes", "Bytes") if same else ("Bytes printed", "Bytes used")
            assert octets(text(shown[printed].find("code"))) == list(example.printed)
            assert octets(text(shown[used].find("code"))) == list(example.data)
            assert text(shown["Direction"]) == example.direction and text(shown["Layout"]) == example.layout
            assert ("Identifier" in shown) == (example.identifier is not None)
            if example.identifier is not None:
                assert int(main_text(shown["Identifier"]), 16) == example.identifier
            assert ("Node address" in shown) == (example.node is not None)
            assert example.node is None or int(text(shown["Node address"])) == example.node
            assert [text(p) for p in entry.findall("p")] == (
                [" ".join(example.meaning.split())] if example.meaning else []
            )
            rows = table(entry, "decoded")
            assert [octet for row in rows for octet in octets(text(row[used]))] == list(example.data)
            values: dict[str, int | str] = {}
            position = 0
            for row in rows:
                data = octets(text(row[used]))
                if data:
                    assert ends(text(row["Offset"])) == (str(position), str(position + len(data) - 1))
                if not same:
                    assert octets(text(row[printed])) == list(example.printed[position : position + len(data)])
                position += len(data)
                name = text(row["Field"])
                field = layouts[example.layout][re.sub(r"\[\d+\]", "", name)]
                values[name] = value = (
                    text(row["Value"]) if field.type is FieldType.BYTES and data else shown_value(row["Value"])
                )
                meanings = [option.label for option in field.values if option.value == value]
                expected = meanings[0] if meanings else "constant" if field.constant is not None else NOTHING
                if not data:
                    expected = "without bytes here"
                assert text(row["Meaning"]) == expected
                values |= check_parts(page, row["Field"], name, field)
            said = flat(example.values)
            assert said.keys() <= values.keys()
            assert not {name: said[name] for name in said if said[name] not in ("XX", values[name])}
            assert {name for name in values if "." not in name.rpartition("]")[2].lstrip(".")} == set(
                flat_names(example, layouts)
            )


def flat_names(example: Example, layouts: dict[str, dict[str, Field]]) -> Iterator[str]:
    """Fields that have a value of their own or a constant."""
    fields = layouts[example.layout]
    for name, field in fields.items():
        group = name.rpartition(".")[0]
        if field.type is FieldType.GROUP:
            continue
        if not group:
            yield name
        else:
            entries = example.values[group]
            assert isinstance(entries, tuple)
            yield from (f"{group}[{number}].{field.name}" for number in range(1, len(entries) + 1))


def check_parts(page: Page, cell: Element, name: str, field: Field) -> dict[str, int | str]:
    """Parts of the number of a decoded row with their values and meanings."""
    if not field.bits:
        return {}
    row = page.parents[cell]
    body = list(page.parents[row])
    shown = lists(body[body.index(row) + 1], direct=False)["Bits"]
    found: dict[str, int | str] = {}
    meanings = dict(field.bit_values)
    for part, (key, said) in zip(field.bits, shown.items(), strict=True):
        assert tuple(map(int, ends(key))) == (part.low, part.high)
        match = re.fullmatch(rf"{part.label} = (open|\d+)(?: (.+))?", said)
        assert match
        value = "XX" if match[1] == "open" else int(match[1])
        labels = [option.label for option in meanings.get(part.label, ()) if option.value == value]
        assert ([match[2]] if match[2] else []) == labels[:1]
        found[f"{name}.{part.label}"] = value
    return found


def test_telegrams_of_one_exchange_lead_to_each_other(panels: list[tuple[Device, Page]]) -> None:
    for device, page in panels:
        for example in device.examples:
            related = facts(page.element(f"telegram-{example.id}"), "related")
            if example.sequence is None:
                assert "Exchange" not in related
                continue
            others = [other.id for other in device.examples if other.sequence == example.sequence]
            assert text(related["Exchange"]) == f"{example.sequence}: {' → '.join(others)}"
            links = {a.get("href") for a in related["Exchange"].iter("a")}
            assert links == {f"#telegram-{name}" for name in others if name != example.id}


@pytest.fixture(scope="module")
def folders(model: Model, pages: dict[str, Page]) -> list[tuple[Device, Page]]:
    return [(device, pages[f"{device.id}-files.html"]) for device in model.devices if device.canopen or device.gsd]


def linked_files(device: Device) -> list[str]:
    """Addresses of the files of a device by the functions that name them."""
    canopen = [
        f"files/{kind}/{name}"
        for found in object_dictionaries(device)
        for kind, name in (("eds", eds.file_name(found)), ("xdd", xdd.file_name(found)))
    ]
    return canopen + ([f"files/gsd/{name}" for name, _ in gsd.file_names(device.gsd)] if device.gsd else [])


def part(page: Page, name: str) -> Element:
    """The section below the heading with that id."""
    section: Element = page.parents[page.element(name)]
    return section


def test_every_file_for_bus_masters_is_linked_and_exists(
    model: Model, pages: dict[str, Page], folders: list[tuple[Device, Page]], generated: Path
) -> None:
    shown = [a.get("href") or "" for page in pages.values() for a in page.root.iter("a")]
    outward = [href for href in shown if href.startswith("files/")]
    made = {f"files/{kind}/{path.name}" for kind in ("eds", "xdd", "gsd") for path in (generated / kind).iterdir()}
    assert set(outward) == made and len(outward) == len(made) > 10
    for device, page in folders:
        links = [a for a in page.root.iter("a") if (a.get("href") or "").startswith("files/")]
        assert [a.get("href") for a in links] == linked_files(device)
        assert all((a.get("href") or "").endswith(f"/{text(a)}") for a in links)
        notes = text(part(page, "canopen-import")) if device.canopen else ""
        assert not notes or eds.file_name(object_dictionaries(device)[0]) in notes


def dictionaries(folders: list[tuple[Device, Page]]) -> Iterator[tuple[tuple[ObjectDictionary, ...], Page]]:
    found = [(object_dictionaries(device), page) for device, page in folders if device.canopen]
    assert found
    yield from found


def test_canopen_files_have_their_identity_and_counts(folders: list[tuple[Device, Page]], generated: Path) -> None:
    for all_of, page in dictionaries(folders):
        identities = table(part(page, "canopen"), "files")
        counts = table(part(page, "canopen-contents"), "contents")
        for one, identity, count in zip(all_of, identities, counts, strict=True):
            label = text(identity["For"])
            assert label == text(count["For"])
            assert all(name in label for name in (one.slot or "", one.product.label))
            source = (generated / "eds" / text(identity["EDS"])).read_text("ascii")
            for key, column in (
                ("VendorNumber", "Vendor"),
                ("ProductNumber", "Product"),
                ("RevisionNumber", "Revision"),
            ):
                shown = identity[f"{column} number"]
                assert f"\n{key}={main_text(shown)}\n" in source
                assert text(shown).endswith("assumed") == (key in one.product.unknown)
            lists_of = re.findall(r"Objects\]\nSupportedObjects=(\d+)", source)
            assert [text(count[name]) for name in ("Mandatory", "Optional", "Manufacturer")] == lists_of
            assert f"\nNrOfRXPDO={text(count['RPDOs'])}\nNrOfTXPDO={text(count['TPDOs'])}\n" in source
            assert int(text(count["Values"])) == len(re.findall("^AccessType=", source, re.M))
            assert int(text(count["Mappable"])) == len(re.findall("^PDOMapping=1$", source, re.M))
            assert int(text(count["By node-ID"])) == len(re.findall(r"^DefaultValue=\$NODEID", source, re.M))


def test_canopen_files_say_what_is_assumed_and_corrected(folders: list[tuple[Device, Page]]) -> None:
    for all_of, page in dictionaries(folders):
        said = [text(item) for item in part(page, "canopen-assumed").iter("li")]
        assert len(said) == len(set(said))
        rows = table(part(page, "canopen-corrected"), "corrected")
        by_id = {text(row["Erratum"].find("a")): row for row in rows}
        assert len(by_id) == len(rows)
        for one in all_of:
            for sentence in (*eds.assumed(one), *eds.left_out(one)):
                assert any(shown.endswith(sentence) for shown in said)
            for erratum, concerned in eds.corrected(one):
                row = by_id[erratum.id]
                assert concerned in text(row["Concerns"]).split("; ")
                assert text(row["Used"]) == erratum.used_text
                assert text(row["Printed"]) == eds.printed(erratum)
                link = cast(Element, row["Erratum"].find("a"))
                assert link.get("href") == f"{one.device.id}-errata.html#erratum-{erratum.id}"
                notes = [text(note) for note in row["Erratum"].findall("small")]
                assert notes == (["slip of the text dump alone"] if erratum.origin == "dump" else [])
        assert by_id.keys() == {erratum.id for one in all_of for erratum, _ in eds.corrected(one)}


def test_commands_write_the_dcf_of_each_file(model: Model, folders: list[tuple[Device, Page]]) -> None:
    for all_of, page in dictionaries(folders):
        shown = [text(item) for lst in with_class(page.root, "commands") for item in lst]
        for one, command in zip(all_of, shown, strict=True):
            words = shlex.split(command)
            assert words[:4] == ["python", "-m", "generator", "dcf"]
            options = dict(zip(words[4::2], words[5::2], strict=True))
            assert options.pop("--node") == "NODE" and options.pop("--baud") == "RATE"
            request = dcf.Request(
                device=options.pop("--device"),
                slot=options.pop("--slot", None),
                product=options.pop("--product", None),
                node="7",
                bit_rate=str(one.facts.baud_rates[0]),
                settings=(),
            )
            assert not options
            assert f"{eds.file_stem(one)}_node7.dcf" in dcf.files(model, request)


GSD_TABLES = {origin: origin.value for origin in Origin}


def test_profibus_files_say_where_each_keyword_is_from(folders: list[tuple[Device, Page]]) -> None:
    found = [(device, device.gsd, page) for device, page in folders if device.gsd]
    assert found
    for device, facts_of, page in found:
        for keyword in facts_of.keywords:
            printed = keyword.source.origin is Origin.MANUAL
            where = part(page, "profibus-contents" if printed else "profibus-assumed")
            rows = {text(row["Keyword"]): row for row in table(where, GSD_TABLES[keyword.source.origin])}
            row = rows[keyword.name]
            assert text(row["Value"]) == gsd.value_text(keyword, "en")
            assert text(row["Reason or remark"]) == (" ".join(keyword.source.note.split()) or NOTHING)
            cite = keyword.source.cite
            assert text(row["Source"]) == (cite_text(cite) if cite else NOTHING)
        section = text(part(page, "profibus"))
        others = [facts_of.max_tsdr, facts_of.parameters_source, *(module.source for module in facts_of.modules)]
        others += [area.source for area in facts_of.diagnosis.areas] if facts_of.diagnosis else []
        assert all(" ".join(source.note.split()) in section for source in others)
        assert ", ".join(str(rate.max_tsdr) for rate in facts_of.bit_rates) in section
        sources = [keyword.source for keyword in facts_of.keywords] + others
        rows_of = table(part(page, "profibus-corrected"), "corrected")
        assert {text(row["Erratum"].find("a")) for row in rows_of} == {e for s in sources for e in s.errata}
        assert rows_of
        errata = {erratum.id: erratum for erratum in device.errata}
        for row in rows_of:
            erratum = errata[text(row["Erratum"].find("a"))]
            assert (text(row["Printed"]), text(row["Used"])) == (eds.printed(erratum), erratum.used_text)


def test_profibus_files_have_their_identity_and_counts(folders: list[tuple[Device, Page]]) -> None:
    for _, facts_of, page in ((device, device.gsd, page) for device, page in folders if device.gsd):
        contents = part(page, "profibus-contents")
        shown = facts(contents)
        assert int(text(shown["Ident number"]), 16) == facts_of.number("Ident_Number")
        assert text(shown["Keywords"]) == str(len(facts_of.keywords))
        assert text(shown["Modules"]) == str(len(facts_of.modules))
        assert text(shown["Bit rates"]).startswith(", ".join(rate.name for rate in facts_of.bit_rates) + ";")
        families = [
            m for n, m in enumerate(facts_of.modules) if m.family not in {x.family for x in facts_of.modules[:n]}
        ]
        for family, row in zip(families, table(contents, "kinds"), strict=True):
            members = [module for module in facts_of.modules if module.family == family.family]
            assert text(row["Count"]) == str(len(members))
            low, high = ends(text(row["Bytes in each direction"]))
            assert {int(low), int(high)} == {f(m.length for m in members) for f in (min, max)}
            assert text(row["Modules"]).startswith(members[0].name.english)
        if facts_of.diagnosis:
            areas = [(f"{a.first} … {a.last} {a.id}", str(len(a.texts))) for a in facts_of.diagnosis.areas]
            rows = table(contents, "diagnosis")
            assert [(text(r["Bits of the status block"]), text(r["Texts"])) for r in rows] == areas
            assert text(shown["Diagnosis texts"]) == str(sum(int(count) for _, count in areas))


def test_the_largest_page_stays_light(outputs: dict[str, str]) -> None:
    assert max(len(source.encode()) for source in outputs.values()) <= 200_000


POISON = "<script>alert('1')</script>&amp;\"'"
KEPT = {
    Chapter: {"status"},
    Choice: {"cases"},
    Device: {"id"},
    DictionaryObject: {"kind", "object_type"},
    ErrorEntry: {"kind"},
    ErrorRef: {"kind"},
    Erratum: {"kind", "origin", "rule", "place"},
    PrintedIndex: {"place"},
    PrintedNumber: {"place"},
    Keyword: {"name"},
    Manual: {"kind"},
    Service: {"errors", "reaches"},
    SubIndex: {"access", "printed_access"},
    SwitchRow: {"positions", "value"},
    Delivered: {"positions"},
    CodeCounts: {"positions"},
    PrintedTable: {"kind"},
}


def poisoned(value: Any, owner: type = object, name: str = "") -> Any:
    """A model whose every text ends in characters that HTML escapes; words that code compares are kept."""
    if isinstance(value, str):
        kept = value in ("", "none", UNNAMED) or value.startswith("device:") or name in KEPT.get(owner, ())
        return value if kept else value + POISON
    if callable(value) and owner is Erratum:
        return lambda variables: poisoned(value(variables), owner, name)
    if isinstance(value, tuple):
        return tuple(poisoned(item, owner, name) for item in value)
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        names = [field.name for field in dataclasses.fields(value)]
        return dataclasses.replace(value, **{n: poisoned(getattr(value, n), type(value), n) for n in names})
    return value


def excerpt(model: Model) -> Model:
    """A model of one device with some facts of every sort."""
    device = model.devices[0]
    codes = tuple(code for code in device.codes if code.twin_of in {c.twin_of for c in device.codes[::9]})
    cut = dataclasses.replace(
        device,
        codes=codes,
        objects=device.objects[::6],
        errors=device.errors[::3],
        tables=device.tables[::6],
        examples=device.examples[::5],
        errata=device.errata[::4],
    )
    manuals = tuple(dataclasses.replace(manual, chapters=manual.chapters[:6]) for manual in model.manuals)
    return dataclasses.replace(model, devices=(cut,), manuals=manuals)


def test_text_of_the_model_is_escaped(model: Model) -> None:
    clean = excerpt(model)
    dirty = poisoned(clean)
    before, after = ({p: o.text for p, o in html.render(m).items()} for m in (clean, dirty))
    assert before.keys() == after.keys()
    dirty_pages: dict[str, Page] = {}
    for path in (path for path in after if path.endswith(".html")):
        assert "<script>" not in after[path] and "&amp;amp;" in after[path]
        dirty_pages[path] = page = Page(after[path])
        assert [e.tag for e in page.elements] == [e.tag for e in Page(before[path]).elements]
    device = clean.devices[0]
    code, error, erratum = device.codes[-1], device.errors[-1], device.errata[0]
    light, group, table_, example = device.indicators[-1], device.switches[-1], device.tables[0], device.examples[0]
    expected = {
        f"{device.id}.html": (device.title,),
        f"{device.id}-codes.html": (code.name,),
        f"{device.id}-c{code.twin_of:05d}.html": (code.name, code.cite.chapter),
        f"{device.id}-errors.html": (error.name,),
        f"{device.id}-errata.html": (erratum.used_text, erratum.confidence, erratum.about_text[0]),
        f"{device.id}-leds.html": (light.rows[-1].state, light.leds[-1].name),
        f"{device.id}-switches.html": (group.labels[0], group.unit),
        f"{device.id}-tables.html": (
            *(table_.columns[0].name, str(table_.rows[0][0]), device.formulas[0].expression),
            device.formulas[0].examples[0].values[0][0],
        ),
        f"{device.id}-telegrams.html": (example.name, example.direction, device.layouts[0].fields[0].title),
        "coverage.html": (clean.manuals[0].title, clean.manuals[0].chapters[0].title),
        "index.html": (device.order_code, clean.manuals[0].publisher),
    }
    for path, found in expected.items():
        whole = text(dirty_pages[path].root.find("body"))
        assert not [fact for fact in found if fact + POISON not in whole]


def test_text_of_gsd_files_is_escaped(model: Model) -> None:
    found = next(device for device in model.devices if device.gsd)
    cut = dataclasses.replace(found, codes=(), objects=(), errors=(), tables=(), indicators=())
    cut = dataclasses.replace(cut, layouts=(), services=(), examples=())
    clean = dataclasses.replace(model, devices=(cut,))
    path = f"{found.id}-files.html"
    before, after = (Page(html.render(each)[path].text) for each in (clean, poisoned(clean)))
    assert "<script>" not in after.source
    assert [element.tag for element in after.elements] == [element.tag for element in before.elements]
    section = text(part(after, "profibus"))
    notes = [keyword.source.note for keyword in cut.gsd.keywords if keyword.source.note] if cut.gsd else []
    assert notes and all(note + POISON in section for note in notes)


def test_links_hold_in_an_excerpt(model: Model) -> None:
    files = html.render(excerpt(model))
    assert not list(broken_links({path: Page(o.text) for path, o in files.items() if path.endswith(".html")}))


def test_a_device_may_lack_everything(model: Model) -> None:
    files = html.render(dataclasses.replace(excerpt(model), devices=(*excerpt(model).devices, bare(model.devices[0]))))
    pages = {path: Page(output.text) for path, output in files.items() if path.endswith(".html")}
    assert not list(broken_links(pages))
    assert len(with_class(pages["index.html"].root, "card")) == 2
    assert [path for path in pages if path.startswith("bare")] == ["bare.html"]


def everything(files: Mapping[str, Output], device: Device) -> Book:
    """All entries of a device and their lists."""
    found = {path: Page(output.text) for path, output in files.items() if path.startswith(device.id)}
    return book(found, device, "codes", "objects", "errors")


Change = Callable[[Code], Code]


def page_with(model: Model, change: Change, slot: str | None = None) -> tuple[Page, Code]:
    """Page of the first device with its first code of a slot changed, and that code."""
    device = model.devices[0]
    old = next(code for code in device.codes if slot is None or code.slot == slot)
    new = change(old)
    keep = [code for code in device.codes if code.twin_of == old.twin_of and code is not old]
    codes = tuple(sorted((new, *keep), key=lambda code: code.number))
    changed = dataclasses.replace(device, codes=codes, objects=(), errors=(), errata=())
    files = html.render(dataclasses.replace(model, devices=(changed,)))
    return everything(files, device), new


def test_scaled_values_below_zero(model: Model) -> None:
    page, code = page_with(
        model,
        lambda old: dataclasses.replace(
            old,
            type_name="INTEGER_16",
            scaling=100,
            range=Range(Fraction(-5, 4), Fraction(9999, 100), "V"),
            default=-125,
            subcodes=(),
            options=(),
        ),
    )
    shown = facts(code_entry(page, code))
    assert main_text(shown["Range"]) == "-1.25 … 99.99 V"
    assert text(shown["Range"]).endswith("on the bus -125 … 9999")
    assert text(shown["Default"]).startswith("-125 = -1.25 V")
    assert text(shown["Scaling"]) == "100 value on the bus = value × scaling"


def test_codes_may_lack_default_range_and_scaling(model: Model) -> None:
    page, code = page_with(
        model,
        lambda old: dataclasses.replace(
            old, range=None, default=None, default_cite=None, scaling=None, subcodes=(), access=Access(False, False)
        ),
    )
    shown = facts(code_entry(page, code))
    assert [main_text(shown[name]) for name in ("Range", "Default", "Scaling", "Access")] == [NOTHING] * 4


def test_strings_and_marks(model: Model) -> None:
    page, code = page_with(
        model,
        lambda old: dataclasses.replace(old, default="a b", length=12, internal=True, subcodes=(), bits=(), fields=()),
    )
    entry = code_entry(page, code)
    assert main_text(facts(entry)["Default"]) == "“a b”"
    assert text(facts(entry)["Longest"]) == "12 bytes"
    assert "device-internal" in text(entry.find("h1"))


def test_gaps_and_single_subcodes_are_not_drawn_together(model: Model) -> None:
    def change(old: Code) -> Code:
        kept = (*range(1, 13), 20, 22)
        subs = [
            SubCode(number=n, name="", default=0, follows=None, options=(), description="", where=old.where)
            for n in kept
        ]
        return dataclasses.replace(old, subcodes=tuple(subs), default=None)

    page, code = page_with(model, change)
    rows = [text(row["Sub"]) for row in table(code_entry(page, code), "subcodes")]
    assert rows == ["1 … 12", "20", "22"]


def test_bits_are_drawn_together_only_where_their_labels_count_on(model: Model) -> None:
    labels = ["a", "a", "a", "b 1", "b 2", "b 3", "b 5", "c", "c", "d 7", "e 8 x", "e 9 x", "e 10 y"]
    wanted = (*(Bit(number, label) for number, label in enumerate(labels)), Bit(14, "e 11 y"))
    page, code = page_with(model, lambda old: dataclasses.replace(old, bits=wanted))
    shown = lists(code_entry(page, code))["Bits"]
    assert bits(shown) == {bit.number: bit.label for bit in wanted}
    assert list(shown)[:2] == ["0 … 2", "3 … 5"] and len(shown) == 10


def test_a_code_that_names_a_whole_object_stands_there(model: Model) -> None:
    device = next(device for device in model.devices if device.codes and device.objects)
    entry = dataclasses.replace(
        device.objects[0], subindexes=tuple(dataclasses.replace(s, codes=()) for s in device.objects[0].subindexes)
    )
    code = dataclasses.replace(device.codes[0], objects=(entry.ref,))
    changed = dataclasses.replace(device, codes=(code,), objects=(entry,), errors=(), errata=())
    page = everything(html.render(dataclasses.replace(model, devices=(changed,))), device)
    assert text(facts(page.element(object_id(entry)))["Codes"]) == code.designation
    assert text(facts(code_entry(page, code), "related")["Objects"]) == entry.designation


def test_only_references_in_a_row_are_drawn_together(model: Model) -> None:
    links = Links(model.devices[0], "")
    odd = [CodeRef(1, 1), CodeRef(1, 3), CodeRef(1, 5), CodeRef(2, 5), CodeRef(3)]
    row = [CodeRef(7, 1), CodeRef(7, 2), CodeRef(7, 3), CodeRef(9), CodeRef(10), CodeRef(11)]
    shown = "".join(piece if isinstance(piece, str) else piece.text for piece in links.codes([*row, *odd]))
    parts = ["C00001/1", "C00001/3", "C00001/5", "C00002/5", "C00003", "C00007/1 … C00007/3", "C00009 … C00011"]
    assert shown == ", ".join(parts)


def test_twins_that_differ_have_entries_of_their_own(model: Model) -> None:
    slot = model.devices[0].slots[0].name
    page, code = page_with(model, lambda old: dataclasses.replace(old, options=(Option(1, "one"),)), slot)
    twin = next(c for c in model.devices[0].codes if c.twin_of == code.twin_of and c.number != code.number)
    assert code_entry(page, code) is not code_entry(page, twin)
    assert twin.designation in text(facts(code_entry(page, code), "related")["In the other slot"])
    assert code.designation in text(facts(code_entry(page, twin), "related")["In the other slot"])


def test_other_kinds_of_objects_and_errors(model: Model) -> None:
    device = model.devices[0]
    pnu = dataclasses.replace(device.objects[0], kind="profidrive", index=918)
    base = dataclasses.replace(
        device.errors[0], slot=None, response=None, responses=(), adjustable_in=(), named_in=(), causes=(), remedies=()
    )
    plain = dataclasses.replace(base, errata=(), printed=(), printed_names=(), description="Said of it.")
    emergency = dataclasses.replace(plain, kind="emergency", number=0x8130, last=0x8130, register="0x11")
    abort = dataclasses.replace(plain, kind="sdo_abort", number=0x06090011, last=0x06090011)
    other = dataclasses.replace(
        device, codes=(), objects=(pnu,), errors=(emergency, abort), errata=(), slots=(), drive=None
    )
    page = everything(html.render(dataclasses.replace(model, devices=(other,))), device)
    assert page.element("pnu-918").tag == "article" and page.element("pnu-918-0").tag == "tr"
    assert page.element("emcy-0x8130").tag == "article" and page.element("abort-0x06090011").tag == "article"
    rows = error_rows(page)
    assert text(rows["emcy-0x8130"]["Error register"]) == "0x11"
    assert text(rows["emcy-0x8130"]["Source"]) == cite_text(emergency.cite)
    assert "Said of it." in text(page.element("abort-0x06090011"))


def luminance(colour: str) -> float:
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    dark, light = sorted((luminance(one), luminance(other)))
    return (light + 0.05) / (dark + 0.05)


def test_contrast_in_both_schemes(outputs: dict[str, str]) -> None:
    css = outputs["style.css"]
    blocks = [
        dict(re.findall(r"--([a-z-]+): (#[0-9a-f]{6});", block)) for block in re.findall(r":root\S* \{[^}]*\}", css)
    ]
    schemes = [colours for colours in blocks if "page" in colours]
    light, dark, chosen_dark = schemes
    assert dark == chosen_dark != light
    for colours in (light, dark):
        for ground in ("page", "panel", "target"):
            for ink in ("text", "soft", "link", "warn"):
                assert contrast(colours[ink], colours[ground]) >= 4.5, (ink, ground)
        assert contrast(colours["text"], colours["mark"]) >= 4.5
        assert contrast(colours["focus"], colours["page"]) >= 3
