"""What the pages of the site say and offer: the first page, overviews, downloads, errata, filters."""

import hashlib
import io
import re
import subprocess
import sys
import zipfile
from dataclasses import replace
from pathlib import Path
from shutil import which
from typing import Any
from xml.etree import ElementTree

import lxml.html
import pytest
from playwright.sync_api import Browser, Locator
from visitor import Visitor

from generator.archive import stored_zip
from generator.cli import main
from generator.emit import html
from generator.emit.canopen import object_dictionaries
from generator.emit.environment import TEMPLATES
from generator.model import CodeRef, Device, Model

LIBRARIES = ("c", "python", "rust")
SHOWN = {"technical-data", "connector", "cable", "bus-length"}


@pytest.fixture(scope="module")
def parsed(site: Path) -> dict[str, Any]:
    """Every page as a tree."""
    return {path.name: lxml.html.fromstring(path.read_bytes()) for path in site.glob("*.html")}


def text(element: Any) -> str:
    return " ".join(element.text_content().split())


def answers(page: Any, question: str) -> dict[str, list[tuple[str, str]]]:
    """Links below a question, by device."""
    (section,) = page.xpath(f'//section[@aria-labelledby="{question}"]')
    return {
        text(row.find("dt")): [(text(a), a.get("href")) for a in row.find("dd").iter("a")]
        for row in section.xpath(".//dl/div")
    }


def target(parsed: dict[str, Any], href: str) -> Any:
    """Element that a link leads to; the page itself without a fragment."""
    path, _, fragment = href.partition("#")
    if not fragment:
        return parsed[path]
    (found,) = parsed[path].xpath("//*[@id=$id]", id=fragment)
    return found


def label(device: Device) -> str:
    return f"{device.order_code} {device.bus}"


# First page


def test_every_device_has_a_card_with_its_counts(model: Model, parsed: dict[str, Any]) -> None:
    cards = {card.find("h3/a").get("href"): card for card in parsed["index.html"].xpath('//article[@class="card"]')}
    assert list(cards) == [f"{device.id}.html" for device in model.devices]
    for device in model.devices:
        found = {a.get("href"): text(a).split()[0] for a in cards[f"{device.id}.html"].xpath(".//ul//a")}
        counts = {
            "codes": device.codes,
            "objects": device.objects,
            "errors": device.errors,
            "leds": device.indicators,
            "switches": device.switches,
            "telegrams": device.layouts,
            "tables": device.tables,
            "errata": device.errata,
        }
        assert found == {f"{device.id}-{part}.html": str(len(facts)) for part, facts in counts.items() if facts}
        assert all(href in parsed for href in found)


def test_an_error_number_is_looked_up_in_the_list_of_its_kind(model: Model, parsed: dict[str, Any]) -> None:
    found = answers(parsed["index.html"], "question-error")
    assert list(found) == [label(device) for device in model.devices if device.errors]
    for device in model.devices:
        kinds = dict.fromkeys(error.kind for error in device.errors)
        assert len(found.get(label(device), [])) == len(kinds)
        for name, href in found.get(label(device), []):
            assert text(target(parsed, href)) == name


def test_an_led_is_looked_up_by_its_label(model: Model, parsed: dict[str, Any]) -> None:
    found = answers(parsed["index.html"], "question-led")
    assert list(found) == [label(device) for device in model.devices if device.indicators]
    for device in (device for device in model.devices if device.indicators):
        labels = [", ".join(led.label for led in table.leds) for table in device.indicators]
        assert [name for name, _ in found[label(device)]] == labels
        for name, href in found[label(device)]:
            assert text(target(parsed, href).xpath(".//a[@class='no']")[0]) == name


def test_a_parameter_is_looked_up_in_the_lists(model: Model, parsed: dict[str, Any]) -> None:
    found = answers(parsed["index.html"], "question-parameter")
    assert list(found) == [label(device) for device in model.devices]
    for device in model.devices:
        parts = [part for part in ("codes", "objects") if getattr(device, part)]
        assert [href for _, href in found[label(device)]] == [f"{device.id}-{part}.html" for part in parts]


def test_address_and_bit_rate_lead_to_switches_codes_and_tables(model: Model, parsed: dict[str, Any]) -> None:
    found = answers(parsed["index.html"], "question-address")
    for device in model.devices:
        ways = [f"{device.id}-switches.html#switch-{group.id}" for group in device.switches]
        if device.canopen and device.canopen.node_address is not None:
            ways.append(f"{device.id}-c{device.canopen.node_address:05d}.html")
        tables = [table for kind in ("address", "baud-rate") for table in device.tables if table.kind == kind]
        ways += [f"{device.id}-tables.html#table-{table.id}" for table in tables]
        assert [href for _, href in found.pop(label(device), [])] == ways
        assert all(target(parsed, href) is not None for href in ways)
    assert found == {}


def test_a_phone_shows_the_search_and_the_first_question_at_once(visitor: Visitor) -> None:
    visitor.page.set_viewport_size({"width": 360, "height": 640})
    page = visitor.open("index.html")
    search, question = page.locator("#home-search").bounding_box(), page.locator("#question-error").bounding_box()
    assert search and question
    assert search["height"] > 0 and question["y"] + question["height"] < 640


# Overview of a device


def test_overviews_show_the_wanted_tables_and_lead_to_the_others(model: Model, parsed: dict[str, Any]) -> None:
    for device in model.devices:
        page = parsed[f"{device.id}.html"]
        shown = {a.get("href"): a.getparent().getparent() for a in page.xpath('//div[@class="shown"]/div/h3/a')}
        hrefs = {table.id: f"{device.id}-tables.html#table-{table.id}" for table in device.tables}
        assert set(shown) == {hrefs[table.id] for table in device.tables if table.kind in SHOWN}
        for table in device.tables:
            assert target(parsed, hrefs[table.id]) is not None
            if table.kind in SHOWN:
                rows = shown[hrefs[table.id]].xpath(".//tbody/tr")
                assert [[text(cell) for cell in row] for row in rows] == [
                    ["–" if cell == "-" else " ".join(str(cell).split()) for cell in row] for row in table.rows
                ]
            else:
                listed = page.xpath('//*[@class="also" or @class="ways"]//a/@href')
                assert listed.count(hrefs[table.id]) == 1


def test_steps_stand_in_the_order_of_the_work_and_lead_somewhere(model: Model, parsed: dict[str, Any]) -> None:
    for device in model.devices:
        steps = parsed[f"{device.id}.html"].xpath('//ol[@class="steps"]/li')
        ways = [[a.get("href") for a in step.iter("a")] for step in steps]
        wired = [table for kind in ("connector", "cable", "topology") for table in device.tables if table.kind == kind]
        errors = dict.fromkeys(error.kind.replace("_", "-") for error in device.errors)
        expected = [
            [f"{device.id}-tables.html#table-{table.id}" for table in wired],
            [href for _, href in answers(parsed["index.html"], "question-address").get(label(device), [])],
            [f"{device.id}-files.html#canopen"] * bool(device.canopen)
            + [f"{device.id}-files.html#profibus"] * bool(device.gsd),
            [f"{device.id}-{part}.html" for part in ("codes", "objects") if getattr(device, part)]
            + [f"{device.id}-telegrams.html"] * bool(device.layouts),
            [f"{device.id}-leds.html#led-{table.id}" for table in device.indicators],
            [f"{device.id}-errors.html#errors-{kind}" for kind in errors],
        ]
        assert ways == [way for way in expected if way]
        assert all(target(parsed, href) is not None for way in ways for href in way)


# Downloads


def downloads(page: Any) -> dict[str, tuple[str, str]]:
    """Size and digest of every file that a page offers, by its address."""
    return {
        item.find("a").get("href"): (text(item.find("span")), text(item.xpath('./p[@class="digest"]/code')[0]))
        for item in page.xpath('//ul[@class="downloads"]/li')
    }


def said_of(site: Path, path: str) -> tuple[str, str]:
    data = (site / path).read_bytes()
    return f"{len(data):,} bytes".replace(",", "\N{NARROW NO-BREAK SPACE}"), hashlib.sha256(data).hexdigest()


def test_all_files_are_offered_with_size_and_digest(site: Path, parsed: dict[str, Any]) -> None:
    files = {path.relative_to(site).as_posix() for path in (site / "files").rglob("*") if path.is_file()}
    found = downloads(parsed["downloads.html"])
    assert set(found) == files - {"files/SHA256SUMS"}
    narrow = {path: (" ".join(size.split()), digest) for path, (size, digest) in found.items()}
    assert narrow == {path: (" ".join(said_of(site, path)[0].split()), said_of(site, path)[1]) for path in found}


def test_every_device_offers_its_files(model: Model, site: Path, parsed: dict[str, Any]) -> None:
    everything = downloads(parsed["downloads.html"])
    for device in model.devices:
        found = downloads(parsed[f"{device.id}-files.html"])
        assert found.items() <= everything.items()
        names = {href.rpartition("/")[2] for href in found}
        assert {f"{device.id}.json", f"{device.id}.h", f"{device.id}_tables.h"} <= names
        assert sum(name.endswith(".zip") for name in names) == len(LIBRARIES)
        suffixes = {name.rpartition(".")[2] for name in names}
        assert ("eds" in suffixes, "xdd" in suffixes) == (device.canopen is not None,) * 2
        assert bool({"GSD", "GSE", "GSG"} & suffixes) == (device.gsd is not None)
        others = [other.id for other in model.devices if other is not device]
        assert not [name for name in names if name.startswith(tuple(others))]


def test_the_list_of_digests_can_be_checked(site: Path) -> None:
    tool = which("sha256sum")
    assert tool is not None
    done = subprocess.run([tool, "-c", "SHA256SUMS"], cwd=site / "files", capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert len(done.stdout.splitlines()) == sum(path.is_file() for path in (site / "files").rglob("*")) - 1


@pytest.fixture(scope="module")
def unpacked(site: Path, model: Model, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Folders of the archives, by target."""
    folder = tmp_path_factory.mktemp("unpacked")
    found = {}
    for name, target_name in (
        ("drivespec-c", "c"),
        ("drivespec-devices-python", "python"),
        ("drivespec-devices-rust", "rust"),
    ):
        stem = f"{name}-{model.version}"
        with zipfile.ZipFile(site / "files" / f"{stem}.zip") as archive:
            archive.extractall(folder)
        found[target_name] = folder / stem
    return found


def contents(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("library", LIBRARIES)
def test_archives_hold_the_artifacts(unpacked: dict[str, Path], generated: Path, library: str) -> None:
    assert contents(unpacked[library]) == contents(generated / library)


def test_bytes_of_an_archive_depend_on_its_contents_alone() -> None:
    files = {"b/x.h": b"1", "a.txt": b"2"}
    data = stored_zip("stem", files)
    assert data == stored_zip("stem", dict(reversed(files.items())))
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert archive.namelist() == ["stem/a.txt", "stem/b/x.h"]
        for entry in archive.infolist():
            assert (entry.date_time, entry.compress_type) == ((1980, 1, 1, 0, 0, 0), zipfile.ZIP_STORED)
            assert entry.external_attr >> 16 == 0o100644


def test_the_python_archive_installs_offline(site: Path, model: Model, tmp_path: Path) -> None:
    archive = site / "files" / f"drivespec-devices-python-{model.version}.zip"
    options = ["--quiet", "--disable-pip-version-check", "--no-index", "--no-deps", "--no-build-isolation"]
    command = [sys.executable, "-m", "pip", "install", *options, "--target", str(tmp_path), str(archive)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    device = next(device for device in model.devices if device.codes)
    program = f"from drivespec_devices import {device.id} as d; print(d.code({device.codes[0].number}).name)"
    environment = {"PYTHONPATH": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == device.codes[0].name


def test_the_c_headers_compile_from_the_archive_and_one_by_one(
    unpacked: dict[str, Path], site: Path, model: Model, tmp_path: Path
) -> None:
    compiler = which("cc")
    assert compiler is not None
    headers = [path.name for path in (site / "files/c/include/drivespec").glob("*.h")]
    assert f"{model.devices[0].id}.h" in headers
    program = tmp_path / "all.c"
    program.write_text("".join(f"#include <drivespec/{name}>\n" for name in headers), encoding="ascii")
    for folder in (unpacked["c"] / "include", site / "files/c/include"):
        command = [compiler, "-std=c99", "-Wall", "-Werror", "-fsyntax-only", f"-I{folder}", str(program)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr


def test_the_rust_archive_is_a_crate(unpacked: dict[str, Path], tmp_path: Path) -> None:
    cargo = which("cargo")
    assert cargo is not None
    command = [cargo, "check", "--quiet", "--offline", "--lib", "--target-dir", str(tmp_path)]
    done = subprocess.run(command, cwd=unpacked["rust"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


# What belongs to an entry


def related(page: Any) -> dict[str, Any]:
    """What an entry says of related things, by its labels."""
    rows = page.xpath('//article//dl[@class="related"]/div')
    return {text(row.find("dt")): row.find("dd") for row in rows}


def test_entries_lead_to_the_places_that_name_them(model: Model, parsed: dict[str, Any]) -> None:
    found = 0
    for device in model.devices:
        numbers = {code.number: code.twin_of for code in device.codes}
        for table in device.tables:
            words = " ".join([table.name, *(str(cell) for row in table.rows for cell in row), *table.notes])
            for number in {int(name) for name in re.findall(r"\bC(\d{5})\b", words)} & numbers.keys():
                page = next(
                    p for n in (number, numbers[number]) if (p := parsed.get(f"{device.id}-c{n:05d}.html")) is not None
                )
                assert f"{device.id}-tables.html#table-{table.id}" in related(page)["Named in"].xpath(".//a/@href")
                found += 1
    assert found > 50
    for page in parsed.values():
        for value in related(page).values():
            assert all(target(parsed, href) is not None for href in value.xpath(".//a/@href") if href[0] != "#")


def test_entries_lead_to_the_same_in_other_devices(model: Model, parsed: dict[str, Any]) -> None:
    for device in model.devices:
        others = [other for other in model.devices if other is not device]
        for error in device.errors:
            page = parsed.get(f"{device.id}-abort-0x{error.number:08x}.html") if error.kind == "sdo_abort" else None
            same = [
                f"{other.id}-abort-0x{error.number:08x}.html"
                for other in others
                for one in other.errors
                if (one.kind, one.number) == (error.kind, error.number)
            ]
            if page is not None and same:
                assert related(page)["In other devices"].xpath(".//a/@href") == same
        for code in device.codes:
            if code.slot is None:
                found = related(parsed[f"{device.id}-c{code.number:05d}.html"]).get("In other devices")
                links = [] if found is None else found.xpath(".//a/@href")
                assert links == [
                    f"{other.id}-c{code.number:05d}.html"
                    for other in others
                    for one in other.codes
                    if one.number == code.number and other.drive is device.drive
                ]


def test_entries_say_whether_pdos_can_carry_them(model: Model, parsed: dict[str, Any]) -> None:
    said = set()
    for device in model.devices:
        mappable = {
            entry.index: [sub.mappable for sub in entry.entries]
            for dictionary in object_dictionaries(device)
            for entry in dictionary.objects
        }
        entries = [(f"{device.id}-c{code.number:05d}.html", code.index) for code in device.codes]
        entries += [(f"{device.id}-i-{one.index:04x}.html", one.index) for one in device.objects]
        for name, index in entries:
            value = related(parsed[name]).get("In EDS and XDD") if name in parsed else None
            if name in parsed:
                assert (value is None) == (index not in mappable), name
            if value is not None:
                said.add(text(value))
                assert text(value).startswith("PDOs can carry") == any(mappable[index]), name
    assert len(said) > 1


def test_an_error_that_its_twin_does_not_equal_leads_to_it(model: Model) -> None:
    device = model.devices[0]
    first = next(error for error in device.errors if error.slot and error.causes)
    changed = tuple(replace(e, causes=("something else",)) if e is first else e for e in device.errors)
    pages = html.render(replace(model, devices=(replace(device, errors=changed),)))
    page = lxml.html.fromstring(pages[f"{device.id}-e-0x{first.number:08x}.html"].text)
    offsets = {slot.name: slot.error_offset for slot in device.slots}
    numbers = {first.number - offsets[first.slot or ""] + offset for offset in offsets.values()} - {first.number}
    links = related(page)["In the other slot"].xpath(".//a/@href")
    assert links == [f"{device.id}-e-0x{number:08x}.html" for number in numbers]


# Errata and filters


def test_the_page_of_errata_holds_the_ledgers(model: Model, parsed: dict[str, Any]) -> None:
    page = parsed["errata.html"]
    rows = page.xpath('//table[contains(@class, "ledger")]/tbody/tr')
    ledger = [(device, erratum) for device in model.devices for erratum in device.errata]
    assert len(rows) == len(ledger)
    for row, (device, erratum) in zip(rows, ledger, strict=True):
        entry, shown_device, _, statement, concerns, confidence, origin = row
        (link,) = entry.iter("a")
        assert link.get("href") == f"{device.id}-errata.html#erratum-{erratum.id}"
        assert target(parsed, link.get("href")).get("id") == f"erratum-{erratum.id}"
        assert (text(shown_device), text(confidence)) == (device.order_code, erratum.confidence)
        assert text(origin) == ("text dump" if erratum.origin == "dump" else "manual")
        assert text(statement.find("b")) == " ".join(erratum.used_text.split())
        printed = erratum.printed_text or " / ".join(place.printed for place in erratum.places)
        assert text(statement.find("s")) == " ".join(printed.split())
        assert all(target(parsed, a.get("href")) is not None for a in concerns.iter("a"))
        assert concerns.text_content()
    slips = sum(erratum.origin == "dump" for _, erratum in ledger)
    lead = text(page.xpath('//main/p[@class="lead"]')[0])
    assert lead.startswith(f"{len(ledger)} entries: {len(ledger) - slips} ") and f" and {slips} on slips " in lead
    counts = {text(row[0]): int(text(row[-1])) for row in page.xpath('//table[@class="counts"]/tbody/tr')}
    kinds = [text(row[2]) for row in rows]
    assert counts == {kind: kinds.count(kind) for kind in kinds} | {"All": len(ledger)}


def test_counts_of_errata_lead_to_as_many_entries(model: Model, parsed: dict[str, Any]) -> None:
    *rows, totals = parsed["errata.html"].xpath('//table[@class="counts"]/tbody/tr')
    assert [text(cell) for cell in totals] == [
        "All",
        *(str(len(device.errata)) for device in model.devices),
        str(sum(len(device.errata) for device in model.devices)),
    ]
    seen = 0
    for row in rows:
        for link in row.iter("a"):
            section = target(parsed, link.get("href")).getparent()
            assert len(section.xpath("./article")) == int(text(link))
            seen += int(text(link))
    assert seen == int(text(totals[-1]))


def visible(rows: Locator) -> list[str]:
    return [row.locator("th").inner_text() for row in rows.all() if row.is_visible()]


def test_errata_are_filtered_by_column_and_text(visitor: Visitor, model: Model) -> None:
    page = visitor.open("errata.html")
    rows, status = page.locator("table.ledger > tbody > tr"), page.locator(".filter").get_by_role("status")
    whole = sum(len(device.errata) for device in model.devices)
    assert status.inner_text() == f"{whole} of {whole}"
    device = max(model.devices, key=lambda device: len(device.errata))
    doubtful = [erratum.id for erratum in device.errata if erratum.confidence == "low"]
    page.get_by_label("Device", exact=True).select_option(device.order_code)
    page.get_by_label("Confidence").select_option("low")
    assert visible(rows) == doubtful
    assert status.inner_text() == f"{len(doubtful)} of {whole}"
    page.get_by_label("Filter", exact=True).press_sequentially(doubtful[0].upper())
    assert doubtful[0] in visible(rows) and len(visible(rows)) < len(doubtful)
    address = page.url
    assert f"device={device.order_code}" in address and "confidence=low" in address and "q=" in address
    shown = visible(rows)
    page.reload()
    assert visible(rows) == shown
    page.get_by_role("button", name="Show all").click()
    assert len(visible(rows)) == whole
    assert "?" not in page.url
    assert page.get_by_role("button", name="Show all").is_disabled()
    assert page.evaluate("document.activeElement.name") == "q"


def test_lists_are_filtered_over_all_their_tables(visitor: Visitor, model: Model) -> None:
    device = next(device for device in model.devices if len({error.kind for error in device.errors}) > 2)
    page = visitor.open(f"{device.id}-errors.html")
    kinds = page.locator("main > section:not(.instrument)")
    page.get_by_label("List", exact=True).select_option(index=2)
    assert [kind.is_visible() for kind in kinds.all()] == [place == 1 for place in range(kinds.count())]
    page.get_by_label("List", exact=True).select_option("")
    error = next(error for error in device.errors if error.kind != "device" and error.description)
    page.get_by_label("Filter", exact=True).fill(error.description)
    found = page.locator("main tbody tr:not(.more):visible")
    assert found.count() == 1 and found.locator("th").inner_text().lower().startswith(f"0x{error.number:04x}"[:6])
    assert page.locator("main tbody tr.more:visible").count() == 1
    page.get_by_label("Filter", exact=True).fill("no such words anywhere")
    assert page.locator(".filter").get_by_role("status").inner_text().startswith("0 of ")
    assert kinds.first.is_visible()


def test_lists_are_filtered_by_what_their_rows_cover(visitor: Visitor, model: Model) -> None:
    """Numbers within runs, codes that set responses, indexes of codes and objects, all that an erratum concerns."""
    wanted: dict[str, list[tuple[str, str]]] = {}
    for device in model.devices:
        for erratum in device.errata:
            for subject in erratum.about[1:-1][:1]:
                wanted.setdefault("errata.html", []).append((str(subject), erratum.id))
                wanted.setdefault(f"{device.id}-errata.html", []).append((str(subject), erratum.id))
        for error in device.errors:
            if error.count > 2:
                within = error.number + 1
                texts = [f"{within:x}", str(within), *map(str, error.adjustable_in[1:2])]
                wanted.setdefault(f"{device.id}-errors.html", []).extend((t, f"{error.number:x}") for t in texts)
        for code in device.codes[::20]:
            texts = [str(code.index), f"{code.index:X}"]
            wanted.setdefault(f"{device.id}-codes.html", []).extend((t, code.designation) for t in texts)
        for entry in device.objects[::9]:
            wanted.setdefault(f"{device.id}-objects.html", []).append((str(entry.index), entry.designation))
    assert {"errata.html", "e94aycca-errors.html", "e94aycca-codes.html", "e94aycca-errata.html"} <= wanted.keys()
    for name, queries in wanted.items():
        page = visitor.open(name)
        field = page.get_by_label("Filter", exact=True)
        for query, found in queries[:25]:
            field.fill(query)
            shown = page.locator("table.overview > tbody > tr:visible > th").all_inner_texts()
            assert any(found in one for one in shown), (name, query)
        field.fill("no such words anywhere")
        assert page.locator("table.overview > tbody > tr:visible, article:visible").count() == 0


def test_the_errata_of_a_device_are_narrowed_with_their_entries(visitor: Visitor, model: Model) -> None:
    device = max(model.devices, key=lambda device: len(device.errata))
    page = visitor.open(f"{device.id}-errata.html")
    page.get_by_label("Filter", exact=True).fill(device.errata[0].id)
    entries = [entry.get_attribute("id") for entry in page.locator("article:visible").all()]
    assert f"erratum-{device.errata[0].id}" in entries and len(entries) < len(device.errata)
    assert len(entries) == page.locator("table.overview > tbody > tr:visible").count()


def test_an_erratum_beside_a_code_shows_the_place_that_differs(model: Model, parsed: dict[str, Any]) -> None:
    seen = 0
    for device in model.devices:
        for erratum in device.errata:
            codes = [subject for subject in erratum.about if isinstance(subject, CodeRef)]
            differing = [place for place in erratum.places if place.printed != erratum.used_text]
            named = [place for place in differing if re.search(r"C\d{5}|0x|I-", place.location)]
            if not codes or not differing or len(differing) == len(erratum.places) or named:
                continue
            page = parsed.get(f"{device.id}-c{codes[0].number:05d}.html")
            found = [n for n in page.find_class("note") if erratum.id in text(n)] if page is not None else []
            if found:
                assert all(" ".join(place.printed.split()) in text(found[0]) for place in differing), erratum.id
                seen += 1
    assert seen


def test_a_code_names_each_error_once(model: Model, parsed: dict[str, Any]) -> None:
    seen = 0
    for device in model.devices:
        for code in device.codes:
            page = parsed.get(f"{device.id}-c{code.number:05d}.html")
            shown = related(page).get("Sets the response to") if page is not None else None
            if shown is not None:
                links = [a.get("href") for a in shown.iter("a")]
                assert len(links) == len(set(links)), code.designation
                seen += 1
    assert seen


def test_files_of_a_kind_are_told_apart(model: Model, parsed: dict[str, Any]) -> None:
    """Each GSD file says whether to take it."""
    items = parsed["downloads.html"].xpath('//ul[@class="downloads"]/li[contains(a/@href, "/gsd/")]')
    whats = [text(item.find("p")) for item in items]
    assert len(whats) > 2 and len(whats) == len(set(whats))
    assert sum("take this one" in what for what in whats) == 1


def test_a_choice_of_an_address_that_no_list_has_is_no_choice(visitor: Visitor, model: Model) -> None:
    page = visitor.open("errata.html?device=nobody&confidence=high")
    assert page.get_by_label("Device", exact=True).input_value() == ""
    high = sum(erratum.confidence == "high" for device in model.devices for erratum in device.errata)
    assert page.locator(".filter").get_by_role("status").inner_text().startswith(f"{high} of ")


def test_without_scripts_there_is_no_filter_but_every_row(browser: Browser, site: Path, model: Model) -> None:
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(f"{site.as_uri()}/errata.html?device={model.devices[0].order_code}")
    assert not page.locator(".filter").is_visible()
    assert page.locator("table.ledger > tbody > tr:visible").count() == sum(len(d.errata) for d in model.devices)
    context.close()


# Paper


@pytest.fixture(params=[("A4", 210, 297), ("Letter", 215.9, 279.4)], ids=lambda paper: paper[0])
def paper(request: pytest.FixtureRequest) -> tuple[str, int, int]:
    """A size of paper by its name, and width and height of what the margins of the style sheet leave, in pixels."""
    name, width, height = request.param
    style = (TEMPLATES / "html/style.css.j2").read_text(encoding="utf-8")
    top, right, bottom = map(int, re.findall(r"@page { margin: (\d+)mm (\d+)mm (\d+)mm", style)[0])
    return name, int((width - 2 * right) * 96 / 25.4), int((height - top - bottom) * 96 / 25.4)


def test_sheets_fill_their_pages_and_no_more(visitor: Visitor, model: Model, paper: tuple[str, int, int]) -> None:
    name, width, height = paper
    for device in model.devices:
        page = visitor.open(f"{device.id}-sheet.html")
        page.emulate_media(media="print")
        page.set_viewport_size({"width": width, "height": height})
        ends = page.evaluate(
            "[...document.querySelectorAll('table, dl, h2')].map(e => e.getBoundingClientRect().right)"
        )
        assert ends and max(ends) <= width + 1
        filled = page.evaluate("document.documentElement.scrollHeight") / height
        pages = len(re.findall(rb"/Type /Page\b", page.pdf(format=name)))
        assert filled * 0.9 <= pages <= filled * 1.12 + 1, (device.id, pages, filled)


def test_sheets_hold_what_one_looks_up(model: Model, parsed: dict[str, Any], site: Path) -> None:
    style = (site / "style.css").read_text(encoding="utf-8")
    for device in model.devices:
        page = parsed[f"{device.id}-sheet.html"]
        (sheet,) = page.xpath(f'//div[@class="sheet sheet-{device.id}"]')
        words = text(sheet)
        assert all(target(parsed, href) is not None for href in sheet.xpath(".//a/@href"))
        for code in device.codes:
            assert f"{code.index}\N{NO-BREAK SPACE}=" in sheet.text_content() and code.designation in words
        for error in device.errors:
            assert f"0x{error.number:0{8 if error.number > 0xFFFF else 4}x}" in words
            assert all(" ".join(remedy.split()) in words for remedy in error.remedies)
        for lamps in device.indicators:
            assert all(row.state in words for row in lamps.rows)
        for group in device.switches:
            assert group.name in words
        for found in device.objects:
            assert found.designation in words and found.name in words
        assert f"body:has(.sheet-{device.id}) {{ page: sheet-{device.id}; }}" in style
        assert device.manual.id in style.partition(f"@page sheet-{device.id} ")[2].partition("}")[0]


# Publishing


def test_no_address_in_full_without_a_url(site: Path, parsed: dict[str, Any]) -> None:
    assert not (site / "sitemap.xml").exists()
    assert not [name for name, page in parsed.items() if page.xpath('//link[@rel="canonical"]')]


def test_the_sitemap_names_every_page_in_full(model: Model, site: Path) -> None:
    url = "https://example.org/drives/"
    outputs = html.render(model, url=url)
    tree = ElementTree.fromstring(outputs["sitemap.xml"].text)
    places = [place.text or "" for place in tree.findall("{*}url/{*}loc")]
    names = {path for path in outputs if path.endswith(".html")} - {"404.html", "index.html"}
    assert sorted(places) == sorted([url, *(url + name for name in names)])
    for name, canonical in (("index.html", url), *((name, url + name) for name in list(names)[:5])):
        assert f'<link rel="canonical" href="{canonical}">' in outputs[name].text
    assert "canonical" not in outputs["404.html"].text


def test_a_url_must_be_one(capsys: pytest.CaptureFixture[str]) -> None:
    for wrong in ("ftp://example.org/", "example.org", "https://example.org/?a=b"):
        with pytest.raises(SystemExit) as stopped:
            main(["site", "--url", wrong])
        assert stopped.value.code == 2
        assert "is no address like" in capsys.readouterr().err


def test_the_page_of_wrong_addresses_leads_on(model: Model, parsed: dict[str, Any]) -> None:
    links = [a.get("href") for a in parsed["404.html"].xpath("//main//a")]
    assert {f"{device.id}.html" for device in model.devices} <= set(links)
    assert not [href for href in links if "://" in href or href.startswith("/")]
    assert all(target(parsed, href) is not None for href in links)


def test_every_page_leads_to_the_pages_of_the_site(parsed: dict[str, Any], site: Path) -> None:
    for name, page in parsed.items():
        links = page.xpath('//footer/nav[@aria-label="Site"]//a/@href')
        assert {"index.html", "errata.html", "downloads.html", "coverage.html"} <= set(links), name
        assert (site / page.xpath('//link[@rel="icon"]/@href')[0]).is_file()
