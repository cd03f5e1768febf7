"""The reference as HTML: static pages that need no script, no server and nothing from elsewhere.

``index.html`` lists devices and sources, ``coverage.html`` says what became of each chapter of the sources.
``<device>.html`` holds codes, objects and errors of a device, ``<device>-tables.html`` its LEDs, switches, telegrams,
tables and formulas, ``<device>-errata.html`` the ledger of what is printed wrong, ``<device>-files.html`` what stands
in its files for bus masters.  The views of entries know only through ``Links`` on which page a fact stands.
"""

from generator.emit.base import Output, Target
from generator.emit.environment import render as fill
from generator.emit.html.files import has_files
from generator.emit.html.lamps import animations
from generator.emit.html.links import files_page, ledger_page, main_page, tables_page
from generator.emit.html.pages import (
    coverage_page,
    device_files_page,
    device_ledger_page,
    device_page,
    device_tables_page,
    index_page,
)
from generator.emit.html.text import COVERAGE
from generator.model import Model


def render(model: Model) -> dict[str, Output]:
    """Pages of all devices, the first page, the page of the sources and the style sheet."""
    outputs = {
        "index.html": fill("html/index.html.j2", page=index_page(model)),
        COVERAGE: fill("html/coverage.html.j2", page=coverage_page(model)),
        "style.css": fill("html/style.css.j2", animations=animations(model)),
    }
    for device in model.devices:
        outputs[main_page(device)] = fill("html/device.html.j2", page=device_page(model, device))
        outputs[tables_page(device)] = fill("html/sections.html.j2", page=device_tables_page(model, device))
        outputs[ledger_page(device)] = fill("html/sections.html.j2", page=device_ledger_page(model, device))
        if has_files(device):
            outputs[files_page(device)] = fill("html/files.html.j2", page=device_files_page(model, device))
    return {path: Output(text) for path, text in outputs.items()}


TARGET = Target("html", render)
