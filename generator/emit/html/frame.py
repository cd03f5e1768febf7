"""What every page of the reference has around its contents: title, description, navigation and origin."""

from collections.abc import Iterable
from dataclasses import dataclass

from generator.emit.html.coverage import edition
from generator.emit.html.places import page_of
from generator.emit.html.text import CONTENTS, COVERAGE, DOWNLOADS, ERRATA, INDEX, Piece, Prose, manual_id, manual_link
from generator.model import Device, Manual, Model

_LONGEST_DESCRIPTION = 158
"""Search engines cut longer descriptions."""


_SITE = (
    Piece("All devices", INDEX),
    Piece("All entries", CONTENTS),
    Piece("Errata of all manuals", ERRATA),
    Piece("Downloads", DOWNLOADS),
    Piece("Coverage of the sources", COVERAGE),
)
"""Links at the foot of every page."""


@dataclass(frozen=True, slots=True)
class NavItem:
    """An entry of the navigation; ``count`` is "" where nothing is counted, ``current`` marks the page shown."""

    text: str
    href: str
    count: str = ""
    current: bool = False


@dataclass(frozen=True, slots=True)
class Nav:
    """Navigation within one device; ``after`` names its manual."""

    device: str
    href: str
    items: tuple[NavItem, ...]
    after: Prose


@dataclass(frozen=True, slots=True)
class Frame:
    """What stands around the contents of a page.

    ``path``: its file.  ``title``: heading of the page, "" where its entry brings its own; ``head_title``: what the
    browser shows.  ``crumbs``: the way to it from the first page.  ``before`` and ``after``: neighbours in their list.
    ``scripts``: names of the scripts beyond those of every page.  ``canonical``: full address of the page, "" where
    that is not known.  ``site``: links at its foot.
    """

    path: str
    title: str
    head_title: str
    description: str
    version: str
    date: str
    origin: str
    crumbs: tuple[Piece, ...] = ()
    nav: Nav | None = None
    before: Piece | None = None
    after: Piece | None = None
    scripts: tuple[str, ...] = ()
    canonical: str = ""
    site: tuple[Piece, ...] = _SITE


def origin(manuals: Iterable[Manual]) -> str:
    """Manuals that a page is made from, as its footer names them."""
    return "; ".join(f"{manual.title}, edition {manual.edition}" for manual in manuals)


def manuals(model: Model) -> tuple[Manual, ...]:
    """Manuals of all devices, each once."""
    return tuple({device.manual.id: device.manual for device in model.devices}.values())


def site_frame(model: Model, path: str, title: str, description: str, scripts: tuple[str, ...] = ()) -> Frame:
    """Frame of a page that belongs to no device."""
    return Frame(
        path=path,
        title=title,
        head_title=f"{title} \N{EN DASH} drivespec",
        description=brief(description),
        version=model.version,
        date=model.date,
        origin=origin(manuals(model)),
        scripts=scripts,
    )


def device_frame(
    model: Model,
    device: Device,
    parts: Iterable[NavItem],
    *,
    part: str = "",
    entry: str = "",
    title: str,
    description: str,
    neighbours: tuple[Piece | None, Piece | None] = (None, None),
    scripts: tuple[str, ...] = (),
) -> Frame:
    """Frame of a page of a device.

    Args:
        model: For version and date.
        device: The device.
        parts: Its pages, without mark of the current one.
        part: Part of the reference that the page is or belongs to, "" for the overview.
        entry: Anchor of the entry that the page is all about, "" for other pages.
        title: Heading of the page, or of its entry.
        description: What search engines show; shortened.
        neighbours: Pages before and after it in their list.
        scripts: Scripts beyond those of every page.
    """
    page = page_of(device, part)
    items = tuple(NavItem(it.text, it.href, it.count, it.href == page and not entry) for it in parts)
    crumbs = [Piece(device.order_code, page_of(device))] if part else []
    crumbs += [Piece(it.text, it.href) for it in items if entry and it.href == page]
    return Frame(
        path=page_of(device, entry) if entry else page,
        title="" if entry else title,
        head_title=f"{title} \N{EN DASH} {device.order_code}" if part else title,
        description=brief(description),
        version=model.version,
        date=model.date,
        origin=origin([device.manual]),
        crumbs=tuple(crumbs),
        nav=Nav(device.title, page_of(device), items, _after(device)),
        before=neighbours[0],
        after=neighbours[1],
        scripts=scripts,
    )


def _after(device: Device) -> Prose:
    manual = device.manual
    return f"{manual.title}, ", manual_link(manual.id), f", edition {edition(manual)}"


def coverage_item(device: Device) -> NavItem:
    """Link to what became of the chapters of the manual of a device."""
    return NavItem("Coverage of the manual", f"{COVERAGE}#{manual_id(device.manual.id)}")


def brief(text: str) -> str:
    """Text on one line, shortened between words.

    >>> len(brief("word " * 100)) <= 158
    True
    """
    line = " ".join(text.split())
    if len(line) <= _LONGEST_DESCRIPTION:
        return line
    return line[: _LONGEST_DESCRIPTION - 1].rpartition(" ")[0].rstrip(",;:") + "\N{HORIZONTAL ELLIPSIS}"
