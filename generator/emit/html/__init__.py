"""The reference as HTML: static pages that need no server and nothing from elsewhere, and read well without a script.

``index.html`` is the first page, ``coverage.html`` says what became of each chapter of the sources, ``errata.html``
lists the errata of all manuals, ``downloads.html`` every file beside the pages.
``<device>.html`` is the overview of a device, ``<device>-codes.html`` and the like are the parts of its reference, and
``<device>-c13350.html`` is the page of one code, object or error.  All pages stand in one folder, so that every link
is the name of a file.
"""

from dataclasses import replace

from generator.emit.base import Output
from generator.emit.environment import TEMPLATES
from generator.emit.environment import render as fill
from generator.emit.html.downloads import FOLDER, NO_FILES, Offered, Stored
from generator.emit.html.lamps import animations
from generator.emit.html.pages import pages
from generator.emit.html.search import search_data
from generator.emit.html.sheet import running_heads
from generator.emit.html.text import INDEX, NOT_FOUND
from generator.model import Model

__all__ = ["FOLDER", "NO_FILES", "Offered", "Stored", "render"]


_COPIED = {".js", ".svg"}
"""Suffixes of the files beside the templates that go into the site as they are."""


def render(model: Model, offered: Offered = NO_FILES, url: str = "") -> dict[str, Output]:
    """Every page, the style sheet and the scripts, by path below the folder of the site.

    Args:
        model: The facts.
        offered: Files that the pages offer, by path below the folder ``files`` beside them.
        url: Address of the folder, ended by "/", for the links that name it in full; "" where nobody knows it.

    Raises:
        EmitError: A file that the pages describe cannot be written.
    """
    outputs = {"style.css": fill("html/style.css.j2", animations=animations(model), heads=running_heads(model))}
    site = tuple(pages(model, offered))
    outputs["search-data.js"] = search_data(model, [page.frame for page in site])
    for page in site:
        frame = replace(page.frame, canonical=canonical(url, page.frame.path))
        outputs[frame.path] = fill(f"html/{page.template}.html.j2", frame=frame, page=page.view)
    for found in sorted((TEMPLATES / "html").iterdir()):
        if found.suffix in _COPIED:
            outputs[found.name] = found.read_text(encoding="utf-8")
    if url:
        places = [place for path in outputs if (place := canonical(url, path))]
        outputs["sitemap.xml"] = fill("html/sitemap.xml.j2", places=places)
    return {path: Output(text) for path, text in outputs.items()}


def canonical(url: str, path: str) -> str:
    """Full address of a page; "" where that of the folder is not known, and of what is no page to be found."""
    if not url or not path.endswith(".html") or path == NOT_FOUND:
        return ""
    return url if path == INDEX else url + path
