"""The reference as HTML: static pages that need no server and nothing from elsewhere, and read well without a script.

``index.html`` is the first page, ``coverage.html`` says what became of each chapter of the sources.
``<device>.html`` is the overview of a device, ``<device>-codes.html`` and the like are the parts of its reference, and
``<device>-c13350.html`` is the page of one code, object or error.  All pages stand in one folder, so that every link
is the name of a file.
"""

from generator.emit.base import Output
from generator.emit.environment import TEMPLATES
from generator.emit.environment import render as fill
from generator.emit.html.lamps import animations
from generator.emit.html.pages import pages
from generator.emit.html.search import search_data
from generator.model import Model


def render(model: Model) -> dict[str, Output]:
    """Every page, the style sheet and the scripts, by path below the folder of the site.

    Raises:
        EmitError: A file that the pages describe cannot be written.
    """
    outputs = {"style.css": fill("html/style.css.j2", animations=animations(model))}
    site = tuple(pages(model))
    outputs["search-data.js"] = search_data(model, [page.frame for page in site])
    for page in site:
        outputs[page.frame.path] = fill(f"html/{page.template}.html.j2", frame=page.frame, page=page.view)
    for script in sorted((TEMPLATES / "html").glob("*.js")):
        outputs[script.name] = script.read_text(encoding="utf-8")
    return {path: Output(text) for path, text in outputs.items()}
