"""The errata of all manuals on one page: how many of each kind, and every one in short."""

from collections.abc import Sequence
from dataclasses import dataclass

from generator.emit import eds
from generator.emit.html.blocks import Fact, Group, Row, Table
from generator.emit.html.filters import Filter, filter_of
from generator.emit.html.ledger import concerns, covers, group_id, group_title
from generator.emit.html.links import Links
from generator.emit.html.notes import is_slip
from generator.emit.html.places import page_of
from generator.emit.html.text import NONE, Piece, Prose, manual_link
from generator.model import Erratum

_HEAD = ("Entry", "Device", "Kind", "Printed and used", "Concerns", "Confidence", "Wrong in")
_FILTERED = ("Device", "Kind", "Confidence", "Wrong in")
_ORIGINS = {"dump": "text dump"}


@dataclass(frozen=True, slots=True)
class ErrataView:
    """Everything on the page; ``total``: how many there are, of which ``contradictions`` and ``slips``."""

    total: str
    contradictions: str
    slips: str
    manuals: tuple[Fact, ...]
    counts: Table
    filter: Filter
    group: Group


def all_errata(devices: Sequence[Links]) -> ErrataView:
    """View of the page; ``devices`` are those of the model, as seen from it."""
    ledger = [(links, erratum) for links in devices for erratum in links.device.errata]
    slips = sum(is_slip(erratum) for _, erratum in ledger)
    group = Group("ledger", "All errata", Table("overview ledger", _HEAD, tuple(_row(*entry) for entry in ledger)))
    return ErrataView(
        total=str(len(ledger)),
        contradictions=str(len(ledger) - slips),
        slips=str(slips),
        manuals=tuple(Fact(one.device.order_code, (manual_link(one.device.manual.id),)) for one in devices),
        counts=_counts(devices),
        filter=filter_of([group], _FILTERED),
        group=group,
    )


def _row(links: Links, erratum: Erratum) -> Row:
    return Row(
        (
            (links.erratum(erratum.id),),
            links.device.order_code,
            group_title(erratum),
            (Piece(eds.printed(erratum), tag="s"), "; used: ", Piece(erratum.used_text, tag="b")),
            concerns(links, erratum),
            erratum.confidence,
            _ORIGINS.get(erratum.origin, erratum.origin),
        ),
        covers=covers(erratum),
    )


def _counts(devices: Sequence[Links]) -> Table:
    """How many there are by kind and device, each number a link to the entries."""
    kinds = dict.fromkeys((is_slip(e), group_id(e), group_title(e)) for links in devices for e in links.device.errata)
    rows = [_counts_row(devices, name, title) for _, name, title in sorted(kinds, key=lambda kind: kind[0])]
    totals = tuple(str(len(links.device.errata)) for links in devices)
    everything = str(sum(len(links.device.errata) for links in devices))
    rows.append(Row(("All", *totals, everything)))
    head = ("Kind", *(links.device.order_code for links in devices), "All")
    return Table("counts", head, tuple(rows))


def _counts_row(devices: Sequence[Links], name: str, title: str) -> Row:
    counts = [sum(group_id(erratum) == name for erratum in links.device.errata) for links in devices]
    cells: list[Prose] = [
        (Piece(str(count), f"{page_of(links.device, 'errata')}#{name}"),) if count else NONE
        for links, count in zip(devices, counts, strict=True)
    ]
    return Row((title, *cells, str(sum(counts))))
