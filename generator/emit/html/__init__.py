"""The reference as HTML: static pages that need no server and nothing from elsewhere, and read well without a script.

``index.html`` is the first page, ``coverage.html`` says what became of each chapter of the sources.
``<device>.html`` is the overview of a device, ``<device>-codes.html`` and the like are the parts of its reference, and
``<device>-c13350.html`` is the page of one code, object or error.  All pages stand in one folder, so that every link
is the name of a file.
"""

from generator.emit.base import Output
from generator.emit.environment import TEMPLATES
from generator.emit.environment import render as fill
from generator.emit.html.downloads import FOLDER, NO_FILES, Offered, Stored
from generator.emit.html.lamps import animations
from generator.emit.html.pages import pages
from generator.model import Model

__all__ = ["FOLDER", "NO_FILES", "Offered", "Stored", "render"]


def render(model: Model, offered: Offered = NO_FILES) -> dict[str, Output]:
    """Every page, the style sheet and the scripts, by path below the folder of the site.

    Args:
        model: The facts.
        offered: Files that the pages offer, by path below the folder ``files`` beside them.

    Raises:
        EmitError: A file that the pages describe cannot be written.
    """
    outputs = {"style.css": fill("html/style.css.j2", animations=animations(model))}
    for page in pages(model, offered):
        outputs[page.frame.path] = fill(f"html/{page.template}.html.j2", frame=page.frame, page=page.view)
    for script in sorted((TEMPLATES / "html").glob("*.js")):
        outputs[script.name] = script.read_text(encoding="utf-8")
    return {path: Output(text) for path, text in outputs.items()}
