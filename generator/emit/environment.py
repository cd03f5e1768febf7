"""The one Jinja environment: strict, tidy, escaping by the inner suffix (``page.html.j2`` is HTML)."""

from functools import cache
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

TEMPLATES = Path(__file__).resolve().parent.parent.parent / "templates"
"""Folder of the templates, one folder a target."""


def _escapes(name: str | None) -> bool:
    return name is not None and name.removesuffix(".j2").endswith((".html", ".xml", ".svg"))


@cache
def environment() -> Environment:
    """Environment that every target renders with; templates get view objects and no functions beyond Jinja's own."""
    return Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=_escapes,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        auto_reload=False,
    )


def render(template: str, **view: object) -> str:
    """Text of ``template`` (path below templates/) filled with the view.

    Raises:
        jinja2.UndefinedError: The template names something that the view does not hold.
    """
    return environment().get_template(template).render(**view)


def license_text() -> str:
    """The licence of the project, which every library takes along."""
    return (TEMPLATES.parent / "LICENSE").read_text(encoding="utf-8")
