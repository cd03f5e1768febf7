"""The HTML reference: valid, closed in itself, and the same facts as the model in both directions."""

import dataclasses
import re
from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any, cast
from xml.etree.ElementTree import Element

import html5lib
import pytest

from generator.emit.html import TARGET
from generator.emit.html.links import Links
from generator.model import (
    Access,
    Bit,
    Code,
    CodeRef,
    Default,
    Device,
    DictionaryObject,
    Erratum,
    ErrorEntry,
    ErrorRef,
    Model,
    NodeRelative,
    Option,
    PrintedIndex,
    PrintedNumber,
    Range,
    SubCode,
    SubIndex,
)

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
    page = f", p. {fact.page}" if fact.page is not None else ""
    return f"{fact.manual}, ch. {fact.chapter}{page}"


@pytest.fixture(scope="module")
def outputs(model: Model) -> dict[str, str]:
    return {path: output.text for path, output in TARGET.render(model).items()}


@pytest.fixture(scope="module")
def pages(outputs: dict[str, str]) -> dict[str, Page]:
    return {path: Page(source) for path, source in outputs.items() if path.endswith(".html")}


@pytest.fixture(scope="module")
def devices(model: Model, pages: dict[str, Page]) -> list[tuple[Device, Page]]:
    return [(device, pages[f"{device.id}.html"]) for device in model.devices]


def test_one_page_a_device_and_nothing_else(model: Model, outputs: dict[str, str], generated: Path) -> None:
    assert set(outputs) == {"index.html", "style.css", *(f"{device.id}.html" for device in model.devices)}
    for path, source in outputs.items():
        assert (generated / "html" / path).read_bytes().decode() == source


def test_ids_are_unique(pages: dict[str, Page]) -> None:
    for page in pages.values():
        found = [element.get("id") for element in page.elements if element.get("id") is not None]
        assert len(found) == len(set(found))


def broken_links(pages: dict[str, Page]) -> Iterator[str]:
    for path, page in pages.items():
        for element in page.root.iter("a"):
            href = element.get("href") or ""
            if href.startswith(("https://", "http://")):
                continue
            target, _, fragment = href.partition("#")
            if not href or (target and target not in pages) or (fragment and fragment not in pages[target or path].ids):
                yield f"{path}: {href!r}"


def test_every_link_leads_somewhere(pages: dict[str, Page]) -> None:
    assert not list(broken_links(pages))
    assert sum(1 for page in pages.values() for _ in page.root.iter("a")) > 100


def test_no_request_leaves_the_page(outputs: dict[str, str], pages: dict[str, Page]) -> None:
    for page in pages.values():
        assert [link.get("href") for link in page.root.iter("link")] == ["style.css"]
        loading = {"script", "img", "iframe", "object", "embed", "video", "audio", "source", "base", "form", "svg"}
        assert not loading & {element.tag for element in page.elements}
        attributes = {name for element in page.elements for name in element.attrib}
        assert not {
            name for name in attributes if name in ("src", "srcset", "style", "action") or name.startswith("on")
        }
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


def test_pages_say_what_they_are_made_from(model: Model, devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        manual = device.manual
        footer = text(page.root.find("body/footer"))
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
            heading = cast(Element, entry.find("h4"))
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
            found[(row["Number"][0].get("href") or "").removeprefix("#")] = row
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
                    assert place.tag == "li"
                    assert text(place) == f"0x{error.number + step:08x} {error.number + step} {ref}"


def test_codes_name_the_errors_whose_response_they_set(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
        entries = {code.number: code_entry(page, code) for code in device.codes}
        for code in device.codes:
            together = {number for number, entry in entries.items() if entry is entries[code.number]}
            expected = {
                f"#{error_id(error, error.number)}"
                for error in device.errors
                if together & {ref.number for ref in error.adjustable_in}
            }
            shown = facts(entries[code.number], "related").get("Sets the response to")
            assert {a.get("href") for a in shown.iter("a")} == expected if shown is not None else not expected


def test_errata_ledger(devices: list[tuple[Device, Page]]) -> None:
    for device, page in devices:
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
            expected.setdefault(article, set()).update(f"#erratum-{name}" for name in names)
            notes = with_class(page.element(article), "note")
            pages_of[article] = {cast(Element, note.find("p/a")).get("href") or "" for note in notes}
        assert pages_of == expected
        slips = {f"#erratum-{erratum.id}" for erratum in device.errata if erratum.origin == "dump"}
        for note in with_class(page.root, "note"):
            link = cast(Element, note.find("p/a")).get("href")
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
            assert "drive" not in page.ids
            continue
        section = page.parents[page.element("drive")]
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
        commands = [(int(text(r["Value"])), text(r["Command"])) for r in table(section, "commands")]
        assert commands == [(c.value, c.name) for c in drive.commands]


def test_first_page_lists_devices_and_sources(model: Model, pages: dict[str, Page]) -> None:
    page = pages["index.html"]
    rows = [tuple(map(text, row.values())) for row in table(page.root, "devices")]
    assert rows == [
        (
            d.title,
            d.order_code,
            d.bus,
            d.manual.id,
            ", ".join(filter(None, (d.manual.edition, d.manual.date))),
            *(str(len(things)) for things in (d.codes, d.objects, d.errors, d.errata)),
        )
        for d in model.devices
    ]
    assert {f.get("id") for f in with_class(page.root, "source")} == {f"manual-{manual.id}" for manual in model.manuals}
    for manual in model.manuals:
        entry = page.element(f"manual-{manual.id}")
        assert text(with_class(entry, "name")[0]) == manual.title
        shown = facts(entry)
        assert text(shown["Publisher"]) == manual.publisher and text(shown["Edition"]) == manual.edition
        chapters = [(text(r["Chapter"]), text(r["Title"])) for r in table(entry, "chapters")]
        assert chapters == [(chapter.number, chapter.title) for chapter in manual.chapters]


POISON = "<script>alert('1')</script>&amp;\"'"
KEPT = {
    Device: {"id"},
    DictionaryObject: {"kind"},
    ErrorEntry: {"kind"},
    ErrorRef: {"kind"},
    Erratum: {"kind", "origin", "rule", "place"},
    PrintedIndex: {"place"},
    PrintedNumber: {"place"},
}


def poisoned(value: Any, owner: type = object, name: str = "") -> Any:
    """A model whose every text ends in characters that HTML escapes; words that code compares are kept."""
    if isinstance(value, str):
        return value if value in ("", "none") or name in KEPT.get(owner, ()) else value + POISON
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
    cut = dataclasses.replace(device, codes=codes, objects=device.objects[::6], errors=device.errors[::3])
    return dataclasses.replace(model, devices=(cut,))


def test_text_of_the_model_is_escaped(model: Model) -> None:
    clean = excerpt(model)
    dirty = poisoned(clean)
    before, after = ({p: o.text for p, o in TARGET.render(m).items()} for m in (clean, dirty))
    assert before.keys() == after.keys()
    for path in (path for path in after if path.endswith(".html")):
        assert "<script" not in after[path] and "&amp;amp;" in after[path]
        assert [e.tag for e in Page(after[path]).elements] == [e.tag for e in Page(before[path]).elements]
    page = Page(after[f"{clean.devices[0].id}.html"])
    whole = text(page.root.find("body"))
    code, error, erratum = clean.devices[0].codes[-1], clean.devices[0].errors[-1], clean.devices[0].errata[0]
    for fact in (code.name, code.cite.chapter, error.name, erratum.used_text, clean.devices[0].title):
        assert fact + POISON in whole


def test_links_hold_in_an_excerpt(model: Model) -> None:
    files = TARGET.render(excerpt(model))
    assert not list(broken_links({path: Page(o.text) for path, o in files.items() if path.endswith(".html")}))


def test_a_device_may_lack_everything(model: Model) -> None:
    bare = dataclasses.replace(
        model.devices[0],
        id="bare",
        slots=(),
        codes=(),
        objects=(),
        errors=(),
        errata=(),
        drive=None,
        canopen=None,
        hardware_version=None,
        software_version=None,
    )
    files = TARGET.render(dataclasses.replace(excerpt(model), devices=(*excerpt(model).devices, bare)))
    pages = {path: Page(output.text) for path, output in files.items() if path.endswith(".html")}
    assert not list(broken_links(pages))
    assert len(table(pages["index.html"].root, "devices")) == 2
    for name in ("codes", "objects", "errors", "errata"):
        assert "There are none." in text(pages["bare.html"].parents[pages["bare.html"].element(name)])


Change = Callable[[Code], Code]


def page_with(model: Model, change: Change, slot: str | None = None) -> tuple[Page, Code]:
    """Page of the first device with its first code of a slot changed, and that code."""
    device = model.devices[0]
    old = next(code for code in device.codes if slot is None or code.slot == slot)
    new = change(old)
    keep = [code for code in device.codes if code.twin_of == old.twin_of and code is not old]
    codes = tuple(sorted((new, *keep), key=lambda code: code.number))
    changed = dataclasses.replace(device, codes=codes, objects=(), errors=(), errata=())
    files = TARGET.render(dataclasses.replace(model, devices=(changed,)))
    return Page(files[f"{device.id}.html"].text), new


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
    assert "device-internal" in text(entry.find("h4"))


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
    page = Page(TARGET.render(dataclasses.replace(model, devices=(changed,)))[f"{device.id}.html"].text)
    assert text(facts(page.element(object_id(entry)))["Codes"]) == code.designation
    assert text(facts(code_entry(page, code), "related")["Objects"]) == entry.designation


def test_only_references_in_a_row_are_drawn_together(model: Model) -> None:
    links = Links(model.devices[0])
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
    page = Page(TARGET.render(dataclasses.replace(model, devices=(other,)))[f"{device.id}.html"].text)
    assert page.element("pnu-918").tag == "article" and page.element("pnu-918-0").tag == "tr"
    assert page.element("emcy-0x8130").tag == "tr" and page.element("abort-0x06090011").tag == "tr"
    rows = error_rows(page)
    assert text(rows["emcy-0x8130"]["Error register"]) == "0x11"
    assert text(rows["emcy-0x8130"]["Source"]) == cite_text(emergency.cite)
    assert "Said of it." in text(below(page, "abort-0x06090011"))


def luminance(colour: str) -> float:
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    dark, light = sorted((luminance(one), luminance(other)))
    return (light + 0.05) / (dark + 0.05)


def test_contrast_in_both_schemes(outputs: dict[str, str]) -> None:
    css = outputs["style.css"]
    blocks = [dict(re.findall(r"--([a-z-]+): (#[0-9a-f]{6});", block)) for block in re.findall(r":root \{[^}]*\}", css)]
    schemes = [colours for colours in blocks if "page" in colours]
    assert len(schemes) == 2
    for colours in schemes:
        for ground in ("page", "panel", "target"):
            for ink in ("text", "soft", "link", "warn"):
                assert contrast(colours[ink], colours[ground]) >= 4.5, (ink, ground)
        assert contrast(colours["text"], colours["mark"]) >= 4.5
        assert contrast(colours["focus"], colours["page"]) >= 3
