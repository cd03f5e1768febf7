"""The DIP switches and the LED finder of the site, worked as a reader does, against the rows of the model."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Locator, Page
from visitor import Visitor

from generator.emit.html.dip import Case, read
from generator.emit.html.finder import finder
from generator.emit.html.lamps import notation, words
from generator.model import CodeCounts, Device, IndicatorTable, Light, Model, Pattern, SwitchGroup, SwitchRow

OFF = Pattern(Light.OFF)
CLICK = """([group, wanted]) => {
  const bank = document.querySelector(`[data-group="${group}"]`);
  const switches = [...bank.querySelectorAll("[role=switch]")];
  return wanted.map((positions) => {
    switches.forEach((it, place) => {
      if ((it.getAttribute("aria-checked") === "true") !== (positions[place] === "1")) it.click();
    });
    return [bank.querySelector("output").textContent, bank.querySelector("input, select").value];
  });
}"""
"""Clicks the switches of a group into one position after the other: what is told, and the value in the field."""
TYPE = """([group, values]) => {
  const bank = document.querySelector(`[data-group="${group}"]`);
  const field = bank.querySelector("input, select");
  return values.map((value) => {
    field.value = value;
    field.dispatchEvent(new Event("input", { bubbles: true }));
    return [...bank.querySelectorAll("[role=switch]")]
      .map((it) => (it.getAttribute("aria-checked") === "true" ? "1" : "0")).join("");
  });
}"""
CHOOSE = """(choices) => {
  const section = document.querySelector(".finder");
  return choices.map((chosen) => {
    section.querySelector("button").click();
    for (const [led, text] of chosen) {
      const field = [...section.querySelectorAll("fieldset")].find((it) => it.querySelector("b").textContent === led);
      [...field.querySelectorAll("label")].find((it) => it.textContent.trim() === text).querySelector("input").click();
    }
    const rows = [...document.querySelectorAll(".lamps tbody tr")].filter((it) => it.checkVisibility());
    return [rows.map((it) => it.id), section.querySelector("[role=status]").textContent];
  });
}"""
"""Chooses a pattern for each LED that is named: rows that stay, and what is announced."""

LAMPS = """() => [...document.querySelectorAll(".front input")].map((it) => {
  it.click();
  const lamp = it.closest("fieldset").querySelector("legend span");
  return [lamp.className, it.nextElementSibling?.className ?? null];
})"""
"""Chooses every pattern of every LED: the lamp beside the label, and the drawing that was chosen."""


def with_switches(model: Model) -> Iterator[tuple[Device, SwitchGroup]]:
    return ((device, group) for device in model.devices for group in device.switches)


def with_leds(model: Model) -> list[Device]:
    return [device for device in model.devices if device.indicators]


def every(positions: str) -> list[str]:
    """Positions with each "x" as OFF and as ON."""
    return ["".join(signs) for signs in product(*("01" if sign == "x" else sign for sign in positions))]


def told(group: SwitchGroup, row: SwitchRow, positions: str) -> tuple[str, str]:
    """What the page has to say of a printed row, and the value it has to show in the field."""
    counts = group.code_counts
    if counts and positions in counts.positions:
        codes = " / ".join(map(str, counts.codes))
        total = group.sum(positions)
        first, last = group.valid or (total, total)
        assert not first <= total <= last
        return f"{total} is not valid ({first} … {last}): {codes} counts instead of the switches", ""
    return f"{row.value} {group.unit}" if group.unit and row.value.isdigit() else row.value, row.value


def bank(page: Page, group: SwitchGroup) -> Locator:
    return page.get_by_role("group", name=group.name, exact=True)


def positions(page: Page, group: SwitchGroup) -> str:
    """Position of the switches as assistive technology gets to know it."""
    states = bank(page, group).get_by_role("switch").evaluate_all("all => all.map((it) => it.ariaChecked)")
    assert len(states) == len(group.labels)
    return "".join("1" if state == "true" else "0" for state in states)


def plain(text: str | None) -> str:
    return (text or "").replace("\N{NO-BREAK SPACE}", " ").strip()


def test_every_printed_position_shows_its_value(visitor: Visitor, model: Model) -> None:
    for device, group in with_switches(model):
        page = visitor.open(f"{device.id}-switches.html")
        wanted = [(row, one) for row in group.rows for one in every(row.positions)]
        found = page.evaluate(CLICK, [group.id, [one for _, one in wanted]])
        assert [(plain(text), value) for text, value in found] == [told(group, row, one) for row, one in wanted]


def test_switches_work_with_mouse_and_keyboard(visitor: Visitor, model: Model) -> None:
    seen = 0
    for device, group in with_switches(model):
        page = visitor.open(f"{device.id}-switches.html")
        special = [row for row in group.rows if not row.value.isdigit()]
        some = {row.value: row for row in [*special, *group.rows[:: 1 + len(group.rows) // 7], group.rows[-1]]}
        for number, row in enumerate(some.values()):
            wanted = row.positions.replace("x", "1")
            now = positions(page, group)
            for label, old, new in zip(group.labels, now, wanted, strict=True):
                switch = bank(page, group).get_by_role("switch", name=label, exact=True)
                if old != new and number % 2:
                    switch.click()
                elif old != new:
                    switch.press("Space" if number % 4 else "Enter")
            text, value = told(group, row, wanted)
            assert positions(page, group) == wanted
            assert plain(bank(page, group).locator("output").text_content()) == text
            assert bank(page, group).locator("input, select").input_value() == value
            seen += 1
        bank(page, group).get_by_role("button", name="As delivered").click()
        assert group.delivered
        assert positions(page, group) == group.delivered.positions
        assert "#" not in page.url or any(g != group for d, g in with_switches(model) if d == device)
    assert seen > 20


def test_positions_that_no_row_has(visitor: Visitor, model: Model) -> None:
    unknown = 0
    for device, group in with_switches(model):
        page = visitor.open(f"{device.id}-switches.html")
        printed = {one for row in group.rows for one in every(row.positions)}
        others = [one for one in every("x" * len(group.labels)) if one not in printed]
        for one, (text, value) in zip(others, page.evaluate(CLICK, [group.id, others]), strict=True):
            assert value == ""
            if group.code_counts and one in group.code_counts.positions:
                assert f"{group.sum(one)} is not valid" in text
                assert all(str(ref) in text for ref in group.code_counts.codes)
            else:
                assert text == "The manual gives this position no meaning"
                unknown += 1
    assert unknown


def test_a_value_sets_the_switches(visitor: Visitor, model: Model) -> None:
    for device, group in with_switches(model):
        page = visitor.open(f"{device.id}-switches.html")
        counts = group.code_counts.positions if group.code_counts else ()
        rows = [row for row in group.rows if row.positions not in counts]
        found = page.evaluate(TYPE, [group.id, [row.value for row in rows]])
        assert [r.positions for r, one in zip(rows, found, strict=True) if one not in every(r.positions)] == []
        assert group.valid is None or [int(row.value) for row in rows] == list(
            range(group.valid[0], group.valid[1] + 1)
        )


def test_the_example_of_the_manuals_by_keyboard(visitor: Visitor, model: Model) -> None:
    """Chapters 6.2.1 and 6.3.1 compute 16 + 4 + 2 + 1 = 23."""
    for name in ("e94aycca", "e94aycpm"):
        group = next(group for device, group in with_switches(model) if device.id == name and group.weights)
        page = visitor.open(f"{name}-switches.html")
        field = bank(page, group).get_by_role("spinbutton", name="Value")
        field.press_sequentially("23")
        on = [label for label, sign in zip(group.labels, positions(page, group), strict=True) if sign == "1"]
        assert on == ["16", "4", "2", "1"]
        assert plain(bank(page, group).locator("output").text_content()) == "23"
        assert group.valid
        for wrong in (group.valid[0] - 1, group.valid[1] + 1):
            field.fill(str(wrong))
            assert field.get_attribute("aria-invalid") == "true"
            assert bank(page, group).get_by_role("status").filter(has_text="switches stay").count() == 1
            assert group.sum(positions(page, group)) == 23
        field.fill("5")
        assert field.get_attribute("aria-invalid") is None
        assert group.sum(positions(page, group)) == 5


def test_a_choice_sets_the_switches_by_keyboard(visitor: Visitor, model: Model) -> None:
    device, group = next((d, g) for d, g in with_switches(model) if not g.weights and len(g.labels) > 1)
    page = visitor.open(f"{device.id}-switches.html")
    field = bank(page, group).get_by_role("combobox", name="Value")
    assert group.delivered
    printed = next(n for n, row in enumerate(group.rows) if row.positions == group.delivered.positions)
    field.press("ArrowDown")
    assert field.input_value() == group.rows[printed + 1].value
    assert positions(page, group) == group.rows[printed + 1].positions


def test_the_address_keeps_the_switches(visitor: Visitor, model: Model) -> None:
    device = next(device for device in model.devices if len(device.switches) > 1)
    page = visitor.open(f"{device.id}-switches.html")
    wanted = [group.rows[-1].positions for group in device.switches]
    for group, one in zip(device.switches, wanted, strict=True):
        page.evaluate(CLICK, [group.id, [one]])
    address = page.url.rpartition("/")[2]
    assert "#dip=" in address
    page = visitor.open("index.html")
    page = visitor.open(address)
    assert [positions(page, group) for group in device.switches] == wanted
    group = device.switches[0]
    row = group.rows[5]
    page = visitor.open(f"{device.id}-switches.html#switch-{group.id}.{row.value}")
    assert positions(page, group) == row.positions
    assert page.locator("tr:target th").text_content() == row.value
    bank(page, group).locator("output a").click()
    assert page.locator("tr:target th").text_content() == row.value


def test_a_broken_address_changes_nothing(visitor: Visitor, model: Model) -> None:
    for device, group in with_switches(model):
        page = visitor.open(f"{device.id}-switches.html#dip={group.id}:2,__proto__:1,{group.id}x:%00,:::")
        assert group.delivered
        assert positions(page, group) == group.delivered.positions


def observed(pattern: Pattern) -> list[Pattern]:
    """What can be seen where a row shows the pattern; ``None`` of it where nothing is said."""
    either = [replace(pattern, light=Light.ON), replace(pattern, light=Light.FLICKER)]
    return either if pattern.light is Light.ON_OR_FLICKER else [pattern]


def fits(table: IndicatorTable, row: int, chosen: dict[str, Pattern]) -> bool:
    shown = {led.label: observed(p) for led, p in zip(table.leds, table.rows[row].patterns, strict=True)}
    asked = [label for label in shown if label in chosen]
    return bool(asked) and all(chosen[label] in shown[label] for label in asked)


def choices(device: Device) -> Iterator[dict[str, Pattern]]:
    """What there is to see in every row: of all its LEDs, and of each alone."""
    for table in device.indicators:
        for row in table.rows:
            for seen in product(*map(observed, row.patterns)):
                chosen = {led.label: it for led, it in zip(table.leds, seen, strict=True)}
                yield chosen
                yield from ({label: it} for label, it in chosen.items())


def expected(device: Device, chosen: dict[str, Pattern]) -> list[str]:
    return [
        f"led-{table.id}.{number + 1}"
        for table in device.indicators
        for number in range(len(table.rows))
        if fits(table, number, chosen)
    ]


def test_the_finder_leads_to_every_row(visitor: Visitor, model: Model) -> None:
    for device in with_leds(model):
        page = visitor.open(f"{device.id}-leds.html")
        total = sum(len(table.rows) for table in device.indicators)
        wanted = list(choices(device))
        asked = [[(label, words(it)) for label, it in chosen.items()] for chosen in wanted]
        reached = set()
        for chosen, (rows, said) in zip(wanted, page.evaluate(CHOOSE, asked), strict=True):
            assert rows == expected(device, chosen), chosen
            assert said == f"{len(rows)} of {total} rows fit."
            reached.update(rows)
        assert len(reached) == total


def test_the_finder_says_when_nothing_fits(visitor: Visitor, model: Model) -> None:
    together = 0
    for device in with_leds(model):
        page = visitor.open(f"{device.id}-leds.html")
        for table in device.indicators:
            chosen = {led.label: OFF for led in table.leds}
            if expected(device, chosen):
                continue
            rows, said = page.evaluate(CHOOSE, [[(label, words(it)) for label, it in chosen.items()]])[0]
            assert rows == []
            assert said == f"Nothing fits. The manual has no row for {', '.join(f'{label} off' for label in chosen)}."
            together += len(chosen) > 1
        page.get_by_role("button", name="Show all rows").click()
        assert page.locator(".lamps tbody tr:visible").count() == sum(len(t.rows) for t in device.indicators)
    assert together


def test_the_finder_works_with_the_keyboard_and_keeps_its_state(visitor: Visitor, model: Model) -> None:
    device = next(device for device in model.devices if any(len(table.leds) > 1 for table in device.indicators))
    table = next(table for table in device.indicators if len(table.leds) > 1)
    led = table.leds[0]
    page = visitor.open(f"{device.id}-leds.html")
    group = page.get_by_role("group", name=f"{led.label} {led.colour}")
    group.get_by_role("radio", name="don't know").press("ArrowDown")
    assert group.get_by_role("radio", name=words(OFF), exact=True).is_checked()
    rows = page.locator(".lamps tbody tr:visible").evaluate_all("rows => rows.map((row) => row.id)")
    assert rows == expected(device, {led.label: OFF})
    address = page.url.rpartition("/")[2]
    assert "#see=" in address
    visitor.open("index.html")
    page = visitor.open(address)
    assert page.locator(".lamps tbody tr:visible").count() == len(rows)
    hidden = f"led-{table.id}.{len(table.rows)}"
    assert hidden not in rows
    page.evaluate("(id) => { location.hash = id; }", hidden)
    page.locator(f"[id='{hidden}']").wait_for(state="visible")
    link = page.locator(f"[id='{hidden}'] td a", has_text=table.rows[-1].state)
    assert (link.get_attribute("href"), link.text_content()) == (f"#{hidden}", table.rows[-1].state)


def moving(page: Page) -> list[str]:
    return sorted(set(page.evaluate("document.getAnimations().map((it) => it.animationName)")))


def test_drawings_blink_unless_the_reader_wants_none_of_it(browser: Browser, site: Path, model: Model) -> None:
    device = next(device for device in model.devices if any(len(table.leds) > 1 for table in device.indicators))
    for motion in ("no-preference", "reduce"):
        context = browser.new_context(reduced_motion=motion)
        visitor = Visitor(context.new_page(), site)
        page = visitor.open(f"{device.id}-leds.html")
        box = page.get_by_label("Let the drawings blink")
        assert box.is_visible() == bool(moving(page)) == (motion == "no-preference")
        if box.is_visible():
            box.uncheck()
            assert moving(page) == []
        context.close()
        assert visitor.wrong == []


def test_the_lamp_of_an_led_shows_what_was_chosen(visitor: Visitor, model: Model) -> None:
    for device in with_leds(model):
        page = visitor.open(f"{device.id}-leds.html")
        pairs = page.evaluate(LAMPS)
        assert len(pairs) == page.locator(".front input").count()
        for lamp, drawing in pairs:
            assert lamp == drawing or (drawing is None and "unknown" in lamp)


def test_without_scripts_the_tables_say_it_all(browser: Browser, site: Path, model: Model) -> None:
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    for device, group in with_switches(model):
        page.goto(f"{site.as_uri()}/{device.id}-switches.html")
        assert page.locator(f"#switch-{group.id} .positions tbody tr:visible").count() == len(group.rows)
        switches = bank(page, group).get_by_role("switch")
        assert (switches.count(), switches.first.is_visible()) == (len(group.labels), True)
        assert switches.first.is_disabled()
        assert group.delivered
        text = plain(bank(page, group).locator("output").text_content())
        assert "counts instead" in text or text in [told(group, r, r.positions)[0] for r in group.rows]
        assert not bank(page, group).locator(".setting").is_visible()
    for device in with_leds(model):
        page.goto(f"{site.as_uri()}/{device.id}-leds.html")
        assert page.locator(".lamps tbody tr:visible").count() == sum(len(t.rows) for t in device.indicators)
        assert not page.locator(".finder").is_visible()
    context.close()


def test_a_phone_shows_what_the_leds_mean(visitor: Visitor, model: Model) -> None:
    """State and meaning of every row, then its LEDs by their names, all within the screen."""
    visitor.page.set_viewport_size({"width": 360, "height": 740})
    for device in with_leds(model):
        page = visitor.open(f"{device.id}-leds.html")
        for table in device.indicators:
            for number, row in enumerate(table.rows, 1):
                cells = page.locator(f"[id='led-{table.id}.{number}'] > *").all()
                boxes = {}
                for cell in cells:
                    box = cell.bounding_box()
                    assert box is not None and box["x"] >= 0 and box["x"] + box["width"] <= 360
                    boxes[cell.get_attribute("data-head")] = box["y"]
                order = sorted(boxes, key=lambda head: boxes[head])
                assert order[:2] == ["State", "Meaning"]
                assert [str(head).split(" ")[0] for head in order[2 : 2 + len(table.leds)]] == [
                    led.label.split(" ")[0] for led in table.leds
                ]
                assert row.state in cells[len(table.leds)].inner_text()


def test_fits_a_narrow_screen_and_a_finger(browser: Browser, site: Path, model: Model) -> None:
    context = browser.new_context(viewport={"width": 320, "height": 700})
    visitor = Visitor(context.new_page(), site)
    for part in ("switches", "leds"):
        for device in model.devices:
            if not (device.switches if part == "switches" else device.indicators):
                continue
            page = visitor.open(f"{device.id}-{part}.html")
            if part == "leds":
                first = device.indicators[-1].rows[0]
                seen = zip(device.indicators[-1].leds, first.patterns, strict=True)
                page.evaluate(CHOOSE, [[(led.label, words(observed(it)[0])) for led, it in seen]])
                assert page.locator(".answers li:visible").all_text_contents() == [f"{first.state}: {first.meaning}"]
            assert page.evaluate("document.documentElement.scrollWidth") == 320
            targets = page.locator("[role=switch], .setting :is(input, select, button), .front label, .found button")
            boxes = [it.bounding_box() for it in targets.all()]
            assert boxes
            assert all(
                box and box["width"] >= 24 and box["height"] >= 24 and box["x"] + box["width"] <= 320 for box in boxes
            )
    context.close()
    assert visitor.wrong == []


@pytest.fixture
def group(model: Model) -> SwitchGroup:
    """Two switches of weight 2 and 1, no rows, valid 1 ... 2."""
    known = next(group for _, group in with_switches(model) if group.weights)
    return replace(known, labels=("2", "1"), weights=(2, 1), valid=(1, 2), rows=(), code_counts=None)


def test_readings_that_no_device_has(group: SwitchGroup) -> None:
    def cases(found: SwitchGroup) -> list[tuple[Case, str]]:
        return [(it.case, it.value) for it in (read(found, one) for one in ("00", "01", "10", "11"))]

    assert cases(group) == [(Case.INVALID, "0"), (Case.SUM, "1"), (Case.SUM, "2"), (Case.INVALID, "3")]
    assert cases(replace(group, valid=None)) == [(Case.SUM, "0"), (Case.SUM, "1"), (Case.SUM, "2"), (Case.SUM, "3")]
    row = SwitchRow(value="either", positions="x1", where=group.where)
    counts = CodeCounts(("1x",), (), group.cite)
    bare: Any = replace(group, weights=(), rows=(row,), code_counts=counts)
    assert cases(bare) == [(Case.NONE, ""), (Case.WORD, "either"), (Case.CODE, ""), (Case.CODE, "")]
    assert cases(replace(group, code_counts=counts))[2:] == [(Case.CODE, "2"), (Case.CODE_INVALID, "3")]
    assert read(bare, "01").anchor == f"switch-{group.id}.either"


def test_a_row_that_says_nothing_of_an_led_fits_whatever_it_shows(model: Model) -> None:
    table = next(table for device in model.devices for table in device.indicators if len(table.leds) > 1)
    row = replace(table.rows[0], patterns=(Pattern(Light.ANY), *table.rows[0].patterns[1:]))
    found = finder([replace(table, rows=(row, *table.rows[1:]))])
    assert found
    first = found.leds[0]
    assert first.sights[0].text == "off"
    assert found.data[f"led-{table.id}.1"][first.id] == sorted(it.key for it in first.sights)
    assert len({it.key for it in first.sights}) == len(
        {notation(p) for r in table.rows[1:] for p in r.patterns[:1]} | {"off"}
    )
    assert finder([]) is None


# Connectors


SEEN = """() => [...document.querySelectorAll(".connector svg")].map((svg) => {
  const box = (it) => {
    const { left, right, top, bottom } = it.getBoundingClientRect();
    return [left, right, top, bottom];
  };
  const texts = [...svg.querySelectorAll("text")].map((it) => [it.textContent, box(it), !!it.closest("g")]);
  return [svg.closest("[id]").id, box(svg), box(svg.querySelector(".shell")), texts];
})"""
"""Each drawing by the id around it: its box, that of the shell, its texts with their boxes, whether one is a number."""
Box = list[float]
NOTHING = ("-", "Not assigned", "Reserved")
"""What the manuals print at contacts that carry nothing."""


def overlap(a: Box, b: Box) -> bool:
    return a[0] < b[1] - 0.5 and b[0] < a[1] - 0.5 and a[2] < b[3] - 0.5 and b[2] < a[3] - 0.5


@pytest.mark.parametrize("width", [320, 1280])
def test_connectors_show_each_signal_at_its_contact(visitor: Visitor, model: Model, width: int) -> None:
    """Every contact and label is whole, none covers another, and a label is nearest to the contact that carries it."""
    visitor.page.set_viewport_size({"width": width, "height": 900})
    drawn = 0
    for device in model.devices:
        known = {f"table-{table.id}": table.assignment for table in device.tables if table.assignment}
        found = visitor.open(f"{device.id}-tables.html").evaluate(SEEN)
        assert [name for name, *_ in found] == list(known)
        for name, svg, shell, texts in found:
            assignment = known[name]
            assert assignment is not None and svg[1] <= width
            assert all(svg[0] <= b[0] and b[1] <= svg[1] and svg[2] <= b[2] and b[3] <= svg[3] for _, b, _ in texts)
            assert not any(overlap(a[1], b[1]) for place, a in enumerate(texts) for b in texts[:place])
            numbers = {text: box for text, box, inside in texts if inside}
            assert set(numbers) == {str(contact.number) for contact in assignment.connector.contacts}
            labels = [(text, box) for text, box, inside in texts if not inside]
            expected = {str(pin): signal for pin, signal in assignment.signals if signal not in NOTHING}
            assert sorted(text for text, _ in labels) == sorted(expected.values())
            middle = (shell[2] + shell[3]) / 2
            rows = {box[2] for box in numbers.values()}
            for text, box in labels:
                above = box[3] <= shell[2] + 1
                near = [
                    (abs(sum(place[:2]) - sum(box[:2])), pin)
                    for pin, place in numbers.items()
                    if len(rows) == 1 or (place[2] < middle) == above
                ]
                assert expected[min(near)[1]] == text
            drawn += 1
    assert drawn > 1


def test_contacts_stand_as_the_standards_say(visitor: Visitor, model: Model) -> None:
    """Seen onto a Sub-D plug contact 1 is at the upper left, onto a socket at the upper right; RJ45 counts upwards."""
    orders = {
        "9-pin Sub-D plug": [["1", "2", "3", "4", "5"], ["6", "7", "8", "9"]],
        "9-pin Sub-D socket": [["5", "4", "3", "2", "1"], ["9", "8", "7", "6"]],
        "RJ45 socket": [["1", "2", "3", "4", "5", "6", "7", "8"]],
    }
    seen = set()
    for device in model.devices:
        page = visitor.open(f"{device.id}-tables.html")
        for _, _, _, texts in page.evaluate(SEEN):
            rows: dict[float, list[tuple[float, str]]] = {}
            for text, box, inside in texts:
                if inside:
                    rows.setdefault(round(box[2]), []).append((box[0], text))
            orders_seen = [[text for _, text in sorted(rows[top])] for top in sorted(rows)]
            seen |= {name for name, order in orders.items() if order == orders_seen}
            assert orders_seen in orders.values()
        for caption in page.locator(".connector figcaption").all_text_contents():
            assert caption.split(",")[0] in orders and "from a standard" in caption
    assert seen == set(orders)


def test_connectors_stand_on_the_overview_and_on_paper(visitor: Visitor, model: Model) -> None:
    for device in model.devices:
        names = [table.assignment.connector.name for table in device.tables if table.assignment]
        for page in ("", "-sheet"):
            captions = visitor.open(f"{device.id}{page}.html").locator(".connector figcaption").all_text_contents()
            assert [caption.split(",")[0] for caption in captions] == names
