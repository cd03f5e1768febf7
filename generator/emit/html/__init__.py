"""The reference as HTML: static pages that need no script, no server and nothing from elsewhere.

``index.html`` lists the devices and sources, ``<device>.html`` holds codes, objects, errors and errata of a device.
The views of entries know links only through ``Links`` and can stand on pages of another cut as well.
"""

from generator.emit.base import Output, Target
from generator.emit.environment import render as fill
from generator.emit.html.pages import device_page, index_page
from generator.model import Model


def render(model: Model) -> dict[str, Output]:
    """Pages of all devices, the first page and the style sheet."""
    outputs = {
        "index.html": Output(fill("html/index.html.j2", page=index_page(model))),
        "style.css": Output(fill("html/style.css.j2")),
    }
    for device in model.devices:
        outputs[f"{device.id}.html"] = Output(fill("html/device.html.j2", page=device_page(model, device)))
    return outputs


TARGET = Target("html", render)
