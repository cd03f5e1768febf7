"""Finding things: search in every notation, by keys alone, and what goes with it: theme, copying, permanent links."""

import gzip
import re
import shutil
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from statistics import median

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Page, expect
from visitor import Visitor

from generator.emit.html.links import Links
from generator.emit.html.places import code_id, erratum_id, error_id, error_text, named_id, object_id
from generator.emit.html.search import search_data
from generator.emit.names import code_name
from generator.model import Device, ErrorEntry, Light, Model

Answer = tuple[str, str, str]
"""Number, name and address of an answer."""

SHOWN = 20
LARGEST_DATA = 150_000
LARGEST_PAGE = 200_000
FRAME_MS = 16

_ASK = """(queries) => {
  const field = document.getElementById("search");
  return queries.map((query) => {
    field.value = query;
    field.dispatchEvent(new InputEvent("input"));
    return [...document.querySelectorAll(".search-answers [role=option]")].map((it) =>
      [it.querySelector("b").textContent, it.querySelector(".name").textContent, it.getAttribute("href")]);
  });
}"""


def ready(page: Page) -> None:
    """Have the data of the search loaded."""
    page.locator("#search").focus()
    page.locator("#search").fill("c")
    page.locator(".search-answers [role=option]").first.wait_for()


def ask(page: Page, queries: Sequence[str]) -> list[list[Answer]]:
    """Answers to each query."""
    return [[(number, name, href) for number, name, href in found] for found in page.evaluate(_ASK, list(queries))]


def hrefs(answers: Iterable[Answer]) -> list[str]:
    return [href for _, _, href in answers]


@pytest.fixture(scope="module")
def start(browser: Browser, site: Path) -> Iterator[Page]:
    """The first page with its search ready, shared by the tests that only ask."""
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    visitor = Visitor(context.new_page(), site)
    page = visitor.open("index.html")
    ready(page)
    yield page
    assert visitor.wrong == []
    context.close()


def places(model: Model) -> list[tuple[Device, Links]]:
    return [(device, Links(device)) for device in model.devices]


def code_places(model: Model) -> dict[tuple[int, int | None], set[str]]:
    """Where each code and subcode stands, in any device."""
    found: dict[tuple[int, int | None], set[str]] = {}
    for device, links in places(model):
        for code in device.codes:
            for sub in (None, *(sub.number for sub in code.subcodes)):
                found.setdefault((code.number, sub), set()).add(links.href(code_id(code.number, sub)))
    return found


def object_places(model: Model) -> dict[tuple[int, int | None], set[str]]:
    """Where each object and sub-index of CANopen stands, in any device."""
    found: dict[tuple[int, int | None], set[str]] = {}
    for device, links in places(model):
        for entry in device.objects:
            if entry.kind == "canopen":
                for sub in (None, *(sub.number for sub in entry.subindexes)):
                    found.setdefault((entry.index, sub), set()).add(links.href(object_id(entry, sub)))
    return found


def error_numbers(model: Model) -> Iterator[tuple[Device, ErrorEntry, int, str]]:
    """Every error number of every run with the address of its place, or of the run where it has none of its own."""
    for device, links in places(model):
        for error in device.errors:
            own = error.count > 1 and len(error.adjustable_in) == error.count
            for number in range(error.number, error.last + 1):
                yield device, error, number, links.href(error_id(error.kind, number if own else error.number))


# Numbers


@pytest.mark.parametrize(
    "notation",
    ["C{0:05d}", "c{0}", "{0}", "C {0:05d}", "0x{1:X}", "{1:X}h", "0X{1:04x}", "{1:04x}", "{1}", "I-{1:04X}"],
)
def test_code_by_its_number_and_index(start: Page, model: Model, notation: str) -> None:
    base = model.drives[0].index_base
    codes = {number: found for (number, sub), found in code_places(model).items() if sub is None}
    queries = [notation.format(number, base - number) for number in codes]
    for query, expected, answers in zip(queries, codes.values(), ask(start, queries), strict=True):
        first = hrefs(answers)[: len(expected)]
        if query.isalnum() and query[0] != "C" and len(query) < 5:
            # A short number is also that of an object or error in the other notation.
            assert expected <= set(hrefs(answers)), query
        else:
            assert set(first) == expected, query


@pytest.mark.parametrize(
    "notation", ["C{0:05d}/{2}", "c{0}.{2}", "{0}/{2}", "C{0:05d} sub {2}", "0x{1:X}:{2}", "{1}/{2}"]
)
def test_subcode_by_its_number(start: Page, model: Model, notation: str) -> None:
    base = model.drives[0].index_base
    subs = {place: found for place, found in code_places(model).items() if place[1] is not None and place[1] % 7 == 1}
    queries = [notation.format(number, base - number, sub) for number, sub in subs]
    for query, expected, answers in zip(queries, subs.values(), ask(start, queries), strict=True):
        assert set(hrefs(answers)[: len(expected)]) == expected, query


@pytest.mark.parametrize("notation", ["I-{0:04X}", "0x{0:04X}", "{0:04x}h", "{0:04X}", "i{0:04x}", "{0}"])
def test_object_by_its_index(start: Page, model: Model, notation: str) -> None:
    objects = {index: found for (index, sub), found in object_places(model).items() if sub is None}
    queries = [notation.format(index) for index in objects]
    for query, expected, answers in zip(queries, objects.values(), ask(start, queries), strict=True):
        assert set(hrefs(answers)[: len(expected)]) == expected, query


@pytest.mark.parametrize(
    "notation",
    ["I-{0:04X}/{1}", "{0:04X}.{1:02d}", "{0:04X}:{1:02d}", "{0:04X}sub{1}", "0x{0:04X}/{1}", "{0:04X}h/{1}"],
)
def test_subindex_by_its_number(start: Page, model: Model, notation: str) -> None:
    subs = {place: found for place, found in object_places(model).items() if place[1] is not None}
    queries = [notation.format(*place) for place in subs]
    for query, expected, answers in zip(queries, subs.values(), ask(start, queries), strict=True):
        assert set(hrefs(answers)[: len(expected)]) == expected, query


def test_subindex_in_hexadecimal(start: Page, model: Model) -> None:
    (index, sub), expected = next(it for it in object_places(model).items() if it[0][1] is not None and it[0][1] > 9)
    (answers,) = ask(start, [f"{index:04X}sub{sub:X}h"])
    assert expected <= set(hrefs(answers))


def test_missing_subcode_leads_to_the_code(start: Page, model: Model) -> None:
    code = next(code for device in model.devices for code in device.codes if not code.subcodes)
    (answers,) = ask(start, [f"{code.designation}/2"])
    assert answers[0][0] == code.designation


def test_profidrive_parameter(start: Page, model: Model) -> None:
    for device, links in places(model):
        for entry in device.objects:
            if entry.kind == "profidrive":
                for answers in ask(start, [f"PNU {entry.index}", f"pnu{entry.index}", str(entry.index)]):
                    assert answers[0][2] == links.href(object_id(entry))


@pytest.mark.parametrize("notation", ["as the list writes it", "hexadecimal", "decimal"])
def test_error_by_every_number(start: Page, model: Model, notation: str) -> None:
    errors = list(error_numbers(model))
    forms = {"hexadecimal": "0x{:X}", "decimal": "{}"}
    queries = [forms[notation].format(n) if notation in forms else error_text(e.kind, n) for _, e, n, _ in errors]
    for query, (_, error, number, href), answers in zip(queries, errors, ask(start, queries), strict=True):
        # Small numbers are also those of other things.
        best = answers[:4] if number > 0xFFFF else answers
        assert href in hrefs(best), (query, error.ref)


def test_error_as_the_drive_reports_it(start: Page, model: Model) -> None:
    """Response and instance are set at run time and are not part of the number in the list."""
    for device, error, number, href in error_numbers(model):
        if error.kind != "device" or device.drive is None or number not in (error.number, error.last):
            continue
        fields = dict(device.drive.error_fields)
        response = device.drive.responses[-1]
        reported = number | response.value << fields["response"].low | 1 << fields["instance"].low
        for answers in ask(start, [f"0x{reported:08X}", str(reported), str(reported - (1 << 32))]):
            assert answers[0][2] == href, hex(reported)
            assert response.name in answers[0][1]
            assert f"{fields['instance'].label} 1" in answers[0][1]


def test_a_number_of_a_run_is_marked_above_causes_and_remedies(visitor: Visitor, model: Model) -> None:
    _, error, number, href = next(it for it in error_numbers(model) if "#" in it[3] and it[1].causes)
    for size in ({"width": 1440, "height": 900}, {"width": 360, "height": 740}):
        visitor.page.set_viewport_size({"width": size["width"], "height": size["height"]})
        page = visitor.open(href)
        assert page.evaluate("scrollY") == 0
        named = page.locator(f"[id='{href.partition('#')[2]}']")
        expect(named).to_be_in_viewport()
        assert named.inner_text().startswith(f"{error_text(error.kind, number)} = {number}, response set in C")
        assert named.evaluate("(it) => getComputedStyle(it).backgroundColor") != "rgba(0, 0, 0, 0)"
        assert page.locator(".asked:visible").count() == 1
        if size["width"] > 1000:
            for heading in ("Causes", "Remedies"):
                expect(page.locator(".halves .cap", has_text=heading)).to_be_in_viewport()
    page.locator(".items b a").nth(3).click()
    assert page.evaluate("scrollY") == 0
    assert page.locator(".asked:visible").count() == 1


def test_error_number_that_no_list_has(visitor: Visitor, model: Model) -> None:
    """Its fields are said, and the way leads to the page that takes it apart."""
    device = next(device for device in model.devices if device.drive and device.error_mask)
    assert device.drive is not None
    fields = dict(device.drive.error_fields)
    known = {error.number >> fields["module"].low for error in device.errors if error.kind == "device"}
    module = next(value for value in range(0x39E, 0x3FF) if value not in known)
    response = device.drive.responses[1]
    number = response.value << fields["response"].low | module << fields["module"].low | 5
    page = visitor.open(f"{device.id}.html")
    ready(page)
    for query in (f"0x{number:08x}", str(number)):
        ((text, name, href),) = ask(page, [query])[0]
        assert text == f"0x{number:08x}"
        for said in ("In no list", f"response {response.value}: {response.name}", f"module 0x{module:x}", "error 0x5"):
            assert said in name
    visitor.open(href)
    assert f"0x{number:08X}" in page.locator("#number .result").inner_text()
    assert ask_again(page, model)


def ask_again(page: Page, model: Model) -> bool:
    """Whether a module that the drive names is named too."""
    drive = model.drives[0]
    module = drive.modules[0]
    ready(page)
    number = module.value << dict(drive.error_fields)["module"].low | 0xFFFF
    return f": {module.name}," in ask(page, [f"0x{number:08x}"])[0][0][1]


def test_device_commands(start: Page, model: Model) -> None:
    for device, links in places(model):
        drive = device.drive
        if drive is None or drive.command_code is None:
            continue
        code = f"C{drive.command_code:05d}"
        index = drive.index_base - drive.command_code
        for answers in ask(start, [code, "device commands", str(index), f"0x{index:04X}"]):
            assert links.href("drive-commands") in hrefs(answers[: len(model.devices)])
        for command in drive.commands:
            texts = [f"{code} = {command.value}", f"{code.lower()}={command.value}", command.name]
            for answers in ask(start, texts):
                assert links.href(f"drive-command-{command.value}") in hrefs(answers[:9]), command


def test_words_of_the_trade(start: Page, model: Model) -> None:
    baud, *others = ask(start, ["baud rate", "baudrate", "bitrate", "bit rate"])
    assert baud and all(hrefs(found[:5]) == hrefs(baud[:5]) for found in others)
    (pins,) = ask(start, ["pinout"])
    wanted = {
        links.href(named_id("table", table.id))
        for device, links in places(model)
        for table in device.tables
        if table.assignment
    }
    assert wanted <= set(hrefs(pins))


def test_abort_code_as_bytes(start: Page, model: Model) -> None:
    for _, error, number, href in error_numbers(model):
        if error.kind == "sdo_abort":
            octets = number.to_bytes(4, "big")
            for answers in ask(start, [octets.hex(" "), octets[::-1].hex(" ")]):
                assert href in hrefs(answers[:3]), error.ref


def test_cob_id_is_base_and_node(start: Page, model: Model) -> None:
    for cob_id in model.cob_ids:
        numbers = [cob_id.base] if cob_id.broadcast else [cob_id.base + 1, cob_id.base + 5, cob_id.base + 127]
        for number, answers in zip(numbers, ask(start, [f"0x{n:X}" for n in numbers]), strict=True):
            found = [name for _, name, _ in answers if name.startswith(cob_id.name)]
            assert found, hex(number)
            assert cob_id.broadcast or found[0] == f"{cob_id.name} of node {number - cob_id.base}"


def test_cob_id_leads_to_the_object_that_holds_it(start: Page, model: Model) -> None:
    cob_id = next(it for it in model.cob_ids if it.objects and not it.broadcast)
    (answers,) = ask(start, [f"0x{cob_id.base + 5:X}"])
    ref = cob_id.objects[0]
    assert object_places(model)[ref.index, ref.subindex] <= set(hrefs(answers))


# Words


def test_led_by_what_is_seen(start: Page, model: Model) -> None:
    counts = {1: "single", 2: "double", 3: "triple"}
    seen = 0
    for device, links in places(model):
        for table in device.indicators:
            for number, row in enumerate(table.rows, 1):
                for led, pattern in zip(table.leds, row.patterns, strict=True):
                    if pattern.light is Light.FLASH:
                        query = f"{led.colour} {counts[pattern.flashes or 1]} flash"
                        (answers,) = ask(start, [query])
                        assert links.href(named_id("led", table.id, str(number))) in hrefs(answers[:6]), query
                        seen += 1
    assert seen


@pytest.mark.parametrize(
    "query", ["{0} blinking {1}", "{0} blinks {1}", "{0} flashes {1}", "{0} flashes {2} {1}", "{0} {2} blinks {1}"]
)
def test_counted_blinking_is_flashing_of_the_led_beside(start: Page, model: Model, query: str) -> None:
    """Every row in which that LED flashes so often, and none in which another does so."""
    counts = {1: "once", 2: "twice", 3: "3 times"}
    expected: dict[str, set[str]] = {}
    for _, links in places(model):
        for table in links.device.indicators:
            for number, row in enumerate(table.rows, 1):
                for led, pattern in zip(table.leds, row.patterns, strict=True):
                    if pattern.light is Light.FLASH:
                        asked = query.format(led.label, counts[pattern.flashes or 1], pattern.colour or led.colour)
                        found = expected.setdefault(asked, set())
                        found.add(links.href(named_id("led", table.id, str(number))))
    assert any(len(found) > 2 for found in expected.values())
    for asked, answers in zip(expected, ask(start, list(expected)), strict=True):
        assert set(hrefs(answers)) == expected[asked], asked


def test_words_after_an_led_are_those_of_that_led(start: Page, model: Model) -> None:
    for _, links in places(model):
        for table in links.device.indicators:
            for number, row in enumerate(table.rows, 1):
                lights = [pattern.light for pattern in row.patterns]
                if len(table.leds) == 2 and lights == [Light.ON, Light.OFF]:
                    first, second = (led.label for led in table.leds)
                    href = links.href(named_id("led", table.id, str(number)))
                    right, wrong = ask(start, [f"{first} lit {second} off", f"{second} lit {first} off"])
                    assert hrefs(right) == [href]
                    assert href not in hrefs(wrong)
                    return
    raise AssertionError("no table with a row to ask for")


def test_led_words_belong_to_the_colour(start: Page, model: Model) -> None:
    """What answers "red flash" has a red LED that flashes, whatever the others do."""
    right = {
        links.href(named_id("led", table.id, str(number)))
        for device, links in places(model)
        for table in device.indicators
        for number, row in enumerate(table.rows, 1)
        if any(
            (p.colour or led.colour) == "red" and p.light is Light.FLASH
            for led, p in zip(table.leds, row.patterns, strict=True)
        )
    }
    (answers,) = ask(start, ["red flash"])
    assert right
    assert set(hrefs(answers[: len(right)])) == right


def test_code_by_its_name_in_any_order(start: Page, model: Model) -> None:
    for device, links in places(model):
        codes = [code for code in device.codes if code.name and code.twin_of == code.number][::9]
        queries = [" ".join(reversed(code.name.split())) for code in codes]
        for code, answers in zip(codes, ask(start, queries), strict=True):
            names = {name for _, name, _ in answers}
            assert code.name in names or len(answers) == SHOWN, code.ref
            assert links.href(code_id(code.number)) in hrefs(answers) or len(answers) == SHOWN


def test_all_words_must_occur(start: Page) -> None:
    some, more, none = ask(start, ["heartbeat", "heartbeat producer", "heartbeat zzzz"])
    assert some
    assert len(more) < len(some)
    assert {"heartbeat", "producer"} <= set(more[0][1].lower().split())
    assert none == []


def test_other_things_by_their_ids(start: Page, model: Model) -> None:
    for device, links in places(model):
        wanted = [(it.id, links.href(erratum_id(it.id))) for it in device.errata[:3]]
        wanted += [(it.id, links.href(named_id("table", it.id))) for it in device.tables[:3]]
        wanted += [(it.id, links.href(named_id("formula", it.id))) for it in device.formulas[:2]]
        wanted += [(it.id, links.href(named_id("layout", it.id))) for it in device.layouts[:2]]
        wanted += [(it.id, links.href(named_id("telegram", it.id))) for it in device.examples[:2]]
        wanted += [(it.name, links.href(named_id("switch", it.id))) for it in device.switches]
        wanted += [
            (device.order_code, links.href("device")),
            (f"{device.order_code} {device.bus}", links.href("device")),
        ]
        for (query, href), answers in zip(wanted, ask(start, [query for query, _ in wanted]), strict=True):
            assert href in hrefs(answers), query


def test_slip_of_typing_is_mended_only_where_nothing_is_found(start: Page) -> None:
    right, missing, doubled, swapped = ask(start, ["heartbeat", "hartbeat", "hearttbeat", "haertbeat"])
    assert right == missing == doubled == swapped
    assert "heartbeat" in start.locator(".search-answers .foot").inner_text()


def test_nothing_found_says_what_can_be_searched(start: Page, model: Model) -> None:
    assert ask(start, ["zzzzz"]) == [[]]
    said = start.locator(".search-answers .foot").inner_text()
    assert "zzzzz" in said
    assert model.devices[0].codes[0].designation in said
    assert start.locator("#search").get_attribute("aria-expanded") == "false"


# Order of answers


def test_exact_then_parts_then_beginnings_then_words(start: Page, model: Model) -> None:
    code = next(c for d in model.devices for c in d.codes if len(c.subcodes) in range(2, 9) and c.slot)
    (answers,) = ask(start, [code.designation])
    numbers = [number for number, _, _ in answers]
    count = len(code.subcodes)
    assert numbers[0] == code.designation
    assert numbers[1 : count + 1] == [f"{code.designation}/{sub.number}" for sub in code.subcodes]
    beginning = code.designation[:-1]
    (answers,) = ask(start, [beginning])
    found = {c.designation for d in model.devices for c in d.codes if c.designation.startswith(beginning)}
    assert len(found) in range(2, SHOWN)
    assert {number for number, _, _ in answers[: len(found)]} == found


def test_number_stands_before_the_run_that_holds_it(start: Page, model: Model) -> None:
    _, error, number, href = next(it for it in error_numbers(model) if it[1].count > 1 and it[2] > it[1].number)
    (answers,) = ask(start, [f"0x{number:X}"])
    assert answers[0][0] == error_text(error.kind, number)
    assert answers[0][2] == href


def test_same_number_in_several_devices_is_labelled(start: Page, model: Model) -> None:
    shared = next(place for place, found in object_places(model).items() if len(found) > 1 and place[1] is None)
    ask(start, [f"I-{shared[0]:04X}"])
    count = len(object_places(model)[shared])
    labels = start.locator(".search-answers small").all_inner_texts()[:count]
    assert len(set(labels)) == count
    assert all(any(device.order_code in label for device in model.devices) for label in labels)


def test_device_of_the_page_comes_first(visitor: Visitor, model: Model) -> None:
    index = next(place[0] for place, found in object_places(model).items() if len(found) > 1 and place[1] is None)
    for device in (device for device in model.devices if device.objects and device.objects[0].kind == "canopen"):
        page = visitor.open(f"{device.id}-errors.html")
        ready(page)
        (answers,) = ask(page, [f"0x{index:04X}"])
        assert answers[0][2].startswith(f"{device.id}-")


# Use


def test_data_come_when_they_are_needed(visitor: Visitor, model: Model) -> None:
    device = model.devices[0]
    asked: list[str] = []
    visitor.page.on("request", lambda request: asked.append(request.url.rpartition("/")[2]))
    page = visitor.open(f"{device.id}.html")
    page.wait_for_timeout(100)
    assert "search-data.js" not in asked
    ready(page)
    assert asked.count("search-data.js") == 1


def test_keys_alone(visitor: Visitor, model: Model) -> None:
    code = next(c for d in model.devices for c in d.codes if len(c.subcodes) > 2 and c.slot)
    page = visitor.open(f"{model.devices[0].id}-leds.html")
    page.keyboard.press("/")
    field = page.locator("#search")
    expect(field).to_be_focused()
    expect(field).to_have_value("")
    page.keyboard.type(f"{code.designation}/")
    expect(field).to_have_value(f"{code.designation}/")
    page.keyboard.press("Backspace")
    options = page.locator(".search-answers [role=option]")
    expect(options.first).to_have_attribute("aria-selected", "true")
    expect(field).to_have_attribute("aria-expanded", "true")

    def chosen() -> int:
        name = field.get_attribute("aria-activedescendant")
        assert page.locator(".search-answers [aria-selected=true]").get_attribute("id") == name
        return [option.get_attribute("id") for option in options.all()].index(name)

    assert chosen() == 0
    page.keyboard.press("ArrowDown")
    assert chosen() == 1
    page.keyboard.press("End")
    assert chosen() == options.count() - 1
    page.keyboard.press("ArrowDown")
    assert chosen() == 0
    page.keyboard.press("ArrowUp")
    page.keyboard.press("Home")
    assert chosen() == 0
    page.keyboard.press("Escape")
    expect(page.locator(".search-answers")).to_be_hidden()
    expect(field).to_have_value(code.designation)
    page.keyboard.press("ArrowDown")
    expect(page.locator(".search-answers")).to_be_visible()
    page.keyboard.press("ArrowDown")
    target = options.nth(1).get_attribute("href")
    page.keyboard.press("Enter")
    page.wait_for_url(f"**/{target}")


def test_escape_empties_the_field_at_last(start: Page) -> None:
    field = start.locator("#search")
    field.fill("heartbeat")
    start.keyboard.press("Escape")
    expect(field).to_have_value("heartbeat")
    start.keyboard.press("Escape")
    expect(field).to_have_value("")


def test_question_mark_shows_the_keys(start: Page) -> None:
    start.locator("#search").fill("")
    start.locator("#search").press("?")
    expect(start.locator("#search")).to_have_value("?")
    expect(start.locator("dialog")).to_have_count(0)
    start.locator("#search").fill("")
    start.locator("#search").blur()
    start.keyboard.press("?")
    expect(start.get_by_role("dialog", name="Keys")).to_be_visible()
    start.keyboard.press("Escape")
    expect(start.locator("dialog[open]")).to_have_count(0)


def test_answer_within_a_frame(start: Page) -> None:
    """The scan takes well under a millisecond, and the whole way from key to layout less than a frame."""
    start.locator("#search").focus()
    spent = start.evaluate(
        """() => {
          const field = document.getElementById("search");
          const queries = ["c", "c1", "c13", "C13350", "0x1400", "heart", "red flash", "can", "06 02 00 00", "zzzz"];
          return queries.map((query) => {
            let [scan, whole] = [Infinity, Infinity];
            for (let turn = 0; turn < 12; turn += 1) {
              const before = performance.now();
              field.value = query;
              field.dispatchEvent(new InputEvent("input"));
              document.querySelector(".search-answers").getBoundingClientRect();
              whole = Math.min(whole, performance.now() - before);
              scan = Math.min(scan, performance.getEntriesByName("search")[0].duration);
            }
            return [scan, whole];
          });
        }"""
    )
    assert median(scan for scan, _ in spent) < 1, spent
    assert median(whole for _, whole in spent) < FRAME_MS, spent


def test_text_of_the_spec_is_never_markup(site: Path, model: Model, browser: Browser, tmp_path: Path) -> None:
    name = """<script>document.title = "x"</script> & 'quoted' "twice" <img src=x>"""
    device = model.devices[0]
    codes = (replace(device.codes[0], name=name), *device.codes[1:])
    hostile = replace(model, devices=(replace(device, codes=codes), *model.devices[1:]))
    for path in (site / "index.html", *site.glob("*.css"), *site.glob("*.js"), *site.glob("*.svg")):
        shutil.copy(path, tmp_path)
    (tmp_path / "search-data.js").write_text(search_data(hostile, []), encoding="utf-8")
    context = browser.new_context()
    visitor = Visitor(context.new_page(), tmp_path)
    page = visitor.open("index.html")
    title = page.title()
    ready(page)
    ((first, *_),) = ask(page, [codes[0].designation])
    assert first[1] == name
    assert page.title() == title
    assert page.locator(".search-answers :is(script, img)").count() == 0
    ask(page, ["<b>zzzz</b>"])
    assert page.locator(".search-answers .foot *").count() == 0
    assert visitor.wrong == []
    context.close()


@pytest.mark.parametrize(("scheme", "width"), [("light", 1280), ("dark", 320)])
def test_open_search_is_accessible(visitor: Visitor, model: Model, scheme: str, width: int) -> None:
    visitor.page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    visitor.page.set_viewport_size({"width": width, "height": 700})
    device = model.devices[0]
    page = visitor.open(f"{device.id}-{code_id(device.slots[0].first_code + 300 + 50)}.html")
    ready(page)
    ask(page, ["red flash"])
    results = Axe().run(page, options={"preload": False})
    assert results.violations_count == 0, results.generate_report()
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


# Theme


def test_theme_is_switched_and_remembered(visitor: Visitor, model: Model) -> None:
    visitor.page.emulate_media(color_scheme="light")
    page = visitor.open("index.html")
    background = "getComputedStyle(document.body).backgroundColor"
    light = page.evaluate(background)
    button = page.get_by_role("button", name="Theme")
    expect(button).to_have_accessible_name("Theme: system")
    button.click()
    expect(button).to_have_accessible_name("Theme: light")
    button.press("Enter")
    expect(button).to_have_accessible_name("Theme: dark")
    dark = page.evaluate(background)
    assert dark != light
    page = visitor.open(f"{model.devices[0].id}.html")
    expect(page.get_by_role("button", name="Theme")).to_have_accessible_name("Theme: dark")
    assert page.evaluate(background) == dark
    page.get_by_role("button", name="Theme").click()
    page.reload()
    expect(page.get_by_role("button", name="Theme")).to_have_accessible_name("Theme: system")
    assert page.evaluate(background) == light


def test_theme_works_where_storage_is_closed(visitor: Visitor) -> None:
    visitor.page.add_init_script(
        "Object.defineProperty(window, 'localStorage', { get() { throw new Error('closed'); } })"
    )
    page = visitor.open("index.html")
    page.get_by_role("button", name="Theme").click()
    expect(page.get_by_role("button", name="Theme")).to_have_accessible_name("Theme: light")


# Copying and links


def with_parts(model: Model) -> tuple[Device, int]:
    """A device and the number of one of its codes that has subcodes and a twin."""
    for device in model.devices:
        numbers = {code.twin_of for code in device.codes if code.twin_of != code.number}
        for code in device.codes:
            if code.number in numbers and code.subcodes:
                return device, code.number
    raise AssertionError("no code with subcodes in two slots")


def test_number_index_name_and_link_are_copied(visitor: Visitor, model: Model, site: Path) -> None:
    device, number = with_parts(model)
    code = next(code for code in device.codes if code.number == number)
    page = visitor.open(f"{device.id}-{code_id(number)}.html")
    address = f"{site.as_uri()}/{device.id}-{code_id(number)}.html"
    wanted = {
        f"Copy number: {code.designation}": code.designation,
        f"Copy number: {code.index}": str(code.index),
        f"Copy number: 0x{code.index:04X}": f"0x{code.index:04X}",
        f"Copy link: {address}#{code_id(number)}": f"{address}#{code_id(number)}",
        f"Copy link: {address}#{code_id(number, 1)}": f"{address}#{code_id(number, 1)}",
        f"Copy name: {device.id}.{code_name(code).upper()}": f"{device.id}.{code_name(code).upper()}",
    }
    for label, text in wanted.items():
        button = page.get_by_role("button", name=label, exact=True).first
        button.focus()
        expect(button).to_have_css("opacity", "1")
        page.keyboard.press("Enter")
        expect(page.get_by_role("status").filter(has_text=f"Copied: {text}")).to_have_count(1)
        assert page.evaluate("navigator.clipboard.readText()") == text
        box = button.bounding_box()
        assert box is not None
        assert min(box["width"], box["height"]) >= 24, label


def test_copy_buttons_show_on_touch_screens(browser: Browser, site: Path, model: Model) -> None:
    device, number = with_parts(model)
    context = browser.new_context(has_touch=True, is_mobile=True, viewport={"width": 390, "height": 800})
    page = context.new_page()
    page.goto(f"{site.as_uri()}/{device.id}-{code_id(number)}.html")
    for button in page.locator(".variants .copy, .subcodes .copy").all()[:6]:
        expect(button).to_have_css("opacity", "1")
    context.close()


def test_names_in_code_are_those_of_the_generated_code(site: Path, generated: Path, model: Model) -> None:
    for device in model.devices:
        header = (generated / "c/include/drivespec" / f"{device.id}.h").read_text(encoding="utf-8")
        stub = (generated / "python/drivespec_devices" / f"{device.id}.pyi").read_text(encoding="utf-8")
        modules = (generated / "rust/src" / device.id).rglob("*.rs")
        crate = {path.stem: set(re.findall(r"pub const (\w+):", path.read_text(encoding="utf-8"))) for path in modules}
        shown: set[str] = set()
        for path in site.glob(f"{device.id}-*.html"):
            page = path.read_text(encoding="utf-8")
            if 'class="names"' in page:
                shown |= set(re.findall(r"<code>([^<]+)</code>", page.partition('class="names"')[2]))
        constants = {"C": set(re.findall(r"#define (\w+)", header))}
        constants["Python"] = {f"{device.id}.{name}" for name in re.findall(r"^(\w+): Final", stub, re.M)}
        for name in shown:
            if "::" in name:
                assert name.split("::")[-1] in crate[name.split("::")[-2]], name
            else:
                assert name in constants["Python" if "." in name else "C"], name
        # Three names for each code, object and error; a run has two more, for its last number in C and Rust.
        runs = sum(error.count > 1 for error in device.errors)
        assert len(shown) == 3 * (len(device.codes) + len(device.objects) + len(device.errors)) + 2 * runs


def test_permanent_link_of_the_second_slot_is_in_view_and_marked(visitor: Visitor, model: Model) -> None:
    device, number = with_parts(model)
    twin = next(code.number for code in device.codes if code.twin_of == number and code.number != number)
    visitor.page.set_viewport_size({"width": 800, "height": 400})
    for anchor in (code_id(twin), code_id(number, 2)):
        page = visitor.open(f"{device.id}-{code_id(number)}.html#{anchor}")
        target = page.locator(f"[id='{anchor}']")
        expect(target).to_be_in_viewport()
        plain = page.evaluate("getComputedStyle(document.querySelector('h1')).backgroundColor")
        assert target.evaluate("(it) => getComputedStyle(it).backgroundColor") != plain


def test_controls_shift_nothing(visitor: Visitor, model: Model) -> None:
    device, number = with_parts(model)
    for width in (320, 1280):
        visitor.page.set_viewport_size({"width": width, "height": 800})
        page = visitor.open(f"{device.id}-{code_id(number)}.html")
        boxes = """() => ['.tools', '.lead', '.facts', 'main'].map(
          (it) => document.querySelector(it)?.getBoundingClientRect().top)"""
        live = page.evaluate(boxes)
        assert page.locator(".copies .copy").count() > 1
        page.evaluate("document.querySelectorAll('#tools > *, .copy').forEach((it) => it.remove())")
        assert page.evaluate(boxes) == live


# Without scripts


def test_without_scripts_everything_is_listed(browser: Browser, site: Path, model: Model) -> None:
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(f"{site.as_uri()}/{model.devices[0].id}-codes.html")
    page.get_by_role("banner").get_by_role("link", name="All entries").click()
    page.wait_for_url("**/contents.html")
    for device in model.devices:
        assert page.locator(f"main h2 a[href='{device.id}-index.html']").count() == 1
    context.close()


def test_lists_are_complete(site: Path, model: Model) -> None:
    for device, links in places(model):
        text = (site / f"{device.id}-index.html").read_text(encoding="utf-8")
        listed = set(re.findall(r'href="([^"]+)"', text))
        wanted = {links.href(code_id(code.number)) for code in device.codes}
        firsts = {links.href(code_id(code.number)).partition("#")[0]: code for code in reversed(device.codes)}
        wanted |= {links.href(code_id(c.number, sub.number)) for c in firsts.values() for sub in c.subcodes}
        wanted |= {links.href(object_id(entry)) for entry in device.objects}
        wanted |= {links.href(object_id(entry, sub.number)) for entry in device.objects for sub in entry.subindexes}
        wanted |= {href for owner, _, _, href in error_numbers(model) if owner is device}
        wanted |= {links.href(erratum_id(erratum.id)) for erratum in device.errata}
        for table in device.indicators:
            wanted |= {links.href(named_id("led", table.id, str(n))) for n in range(1, len(table.rows) + 1)}
        for kind, found in (
            ("switch", device.switches),
            ("table", device.tables),
            ("formula", device.formulas),
            ("layout", device.layouts),
            ("telegram", device.examples),
        ):
            wanted |= {links.href(named_id(kind, it.id)) for it in found}
        assert wanted <= listed, sorted(wanted - listed)[:5]
        assert len(text.encode()) < LARGEST_PAGE


def test_all_answers_lead_somewhere(start: Page, site: Path) -> None:
    """Every address in the data is a file with the anchor, addresses of parts included."""
    data = (site / "search-data.js").read_text(encoding="utf-8")
    ids: dict[str, set[str]] = {}
    addresses = set(re.findall(r'"([\w.-]+\.html(?:#[^"]*)?)"', data))
    assert addresses
    for address in addresses:
        name, _, anchor = address.partition("#")
        if name not in ids:
            ids[name] = set(re.findall(r'id="([^"]+)"', (site / name).read_text(encoding="utf-8")))
        assert not anchor or anchor in ids[name] or any(it.startswith(anchor) for it in ids[name] if anchor[-1] == "-")


def test_data_stay_small(site: Path) -> None:
    assert len(gzip.compress((site / "search-data.js").read_bytes())) < LARGEST_DATA
