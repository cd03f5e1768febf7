"""Fixtures: the model of the real spec, the folders of its artifacts and of its site, and a browser on the site."""

from collections.abc import Iterator
from pathlib import Path
from shutil import which

import pytest
from hypothesis import HealthCheck, settings
from playwright.sync_api import Browser, BrowserContext, sync_playwright
from rust_crate import Cargo, texts
from visitor import FLAGS, Visitor

from generator.emit import rust
from generator.model import Model
from generator.pipeline import compile_model, render, render_site
from generator.write import write

settings.register_profile("long", max_examples=5_000, deadline=None, suppress_health_check=list(HealthCheck))

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="session")
def root() -> Path:
    """The repository."""
    return ROOT


@pytest.fixture(scope="session")
def model() -> Model:
    """The checked model of spec/."""
    return compile_model(ROOT / "spec", "spec")


@pytest.fixture(scope="session")
def generated(model: Model, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Every artifact of the real spec, freshly made outside the repository."""
    folder = tmp_path_factory.mktemp("generated")
    write(folder, render(model), {})
    return folder


@pytest.fixture(scope="session")
def cargo(root: Path) -> Cargo:
    """Runs cargo on copies of the crate."""
    return Cargo(root)


@pytest.fixture(scope="session")
def crate_files(model: Model) -> dict[str, str]:
    """Texts of the Rust crate by path."""
    return texts(rust.TARGET.render(model))


@pytest.fixture(scope="session")
def crate(cargo: Cargo, crate_files: dict[str, str]) -> Path:
    """Folder of the Rust crate, with the versions of its optional dependencies."""
    return cargo.locked("crate", crate_files)


@pytest.fixture(scope="session")
def site(model: Model, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, freshly built outside the repository."""
    folder = tmp_path_factory.mktemp("site")
    write(folder, render_site(model), {})
    return folder


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """Chromium without a window; the tests are left out, and say so, where there is none."""
    path = which("chromium")
    if path is None:
        pytest.skip("left out: no Chromium on this machine (Debian: apt-get install chromium)")
    with sync_playwright() as playwright:
        yield playwright.chromium.launch(executable_path=path, args=list(FLAGS))


@pytest.fixture
def context(browser: Browser) -> Iterator[BrowserContext]:
    """A fresh profile, its storage empty, with the right to use the clipboard."""
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    context.grant_permissions(["clipboard-read", "clipboard-write"])
    yield context
    context.close()


@pytest.fixture
def visitor(context: BrowserContext, site: Path) -> Iterator[Visitor]:
    """A tab; the test fails when its pages report an error or ask for anything outside the folder."""
    found = Visitor(context.new_page(), site)
    yield found
    assert found.wrong == []
