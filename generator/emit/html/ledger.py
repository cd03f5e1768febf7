"""The ledger of errata as entries of the reference, slips of the text dump apart."""

from collections.abc import Iterator, Sequence

from generator.emit.html.blocks import Anchor, Entry, Fact, Group, Row, Table
from generator.emit.html.links import Links
from generator.emit.html.notes import is_slip, located
from generator.emit.html.places import erratum_id
from generator.emit.html.text import Prose, joined, noted, plain
from generator.model import CodeRef, Erratum, ObjectRef

SLIPS = "Slips of the text dump"
"""Title of the group of entries in which the manual is right and its text dump is not."""

_KINDS = {
    "index": "Index arithmetic",
    "reference": "References that are wrong or lead nowhere",
    "inconsistency": "Places of the manual that disagree",
    "value": "Values, units, ranges and counts",
    "telegram": "Byte order and telegrams",
    "standard": "Contradictions to standards",
    "text": "Swapped or untranslated text",
    "manuals": "One manual against another",
    "typo": "Slips of typing",
}
_OVERVIEW = ("Entry", "Concerns", "Confidence")
_PLACES = ("Place", "Prints", "Source")


def ledger_groups(links: Links, errata: Sequence[Erratum]) -> tuple[Group, ...]:
    """The ledger by kind, in the order of the ledger; the slips of the dump come last."""
    groups: dict[str, list[Erratum]] = {}
    for erratum in sorted(errata, key=is_slip):
        groups.setdefault(group_id(erratum), []).append(erratum)
    return tuple(_group(links, name, group_title(entries[0]), entries) for name, entries in groups.items())


def group_id(erratum: Erratum) -> str:
    """Anchor of the group that an entry stands in."""
    return f"errata-{'dump' if is_slip(erratum) else erratum.kind}"


def group_title(erratum: Erratum) -> str:
    """Heading of the group that an entry stands in."""
    return SLIPS if is_slip(erratum) else kind_title(erratum)


def kind_title(erratum: Erratum) -> str:
    """What kind of mistake it is, also where only the text dump makes it."""
    return _KINDS.get(erratum.kind, erratum.kind)


def _group(links: Links, name: str, title: str, errata: Sequence[Erratum]) -> Group:
    overview = Table("overview", _OVERVIEW, tuple(_overview_row(links, erratum) for erratum in errata))
    return Group(name, title, overview, tuple(erratum_entry(links, erratum) for erratum in errata))


def _overview_row(links: Links, erratum: Erratum) -> Row:
    cells = (links.anchored(_anchor(erratum)), ", ".join(erratum.about_text), erratum.confidence)
    return Row(cells, covers=covers(erratum))


def covers(erratum: Erratum) -> str:
    """Everything that an entry concerns, one by one."""
    return " ".join(map(str, erratum.about))


def _anchor(erratum: Erratum) -> Anchor:
    return Anchor(erratum_id(erratum.id), erratum.id)


def erratum_entry(links: Links, erratum: Erratum) -> Entry:
    """Entry for an erratum."""
    places = tuple(Row((p.location, p.printed, links.page_source(p.manual, "", p.page))) for p in erratum.places)
    return Entry(
        kind="erratum",
        anchors=(_anchor(erratum),),
        name="",
        marks=(),
        lead=links.prose(erratum.why),
        facts=tuple(_facts(erratum)),
        tables=(Table("places", _PLACES, places),) if places else (),
        related=(Fact("Concerns", concerns(links, erratum)),),
    )


def _facts(erratum: Erratum) -> Iterator[Fact]:
    if erratum.printed_text:
        yield Fact("Printed", noted(erratum.printed_text, located(" ".join(erratum.place), None)))
    yield Fact("Used", erratum.used_text)
    yield Fact("Confidence", erratum.confidence)
    if erratum.rule is not None:
        yield Fact("Check", erratum.rule)
    if is_slip(erratum):
        yield Fact("Kind", kind_title(erratum))


def concerns(links: Links, erratum: Erratum) -> Prose:
    """Links to what the ledger names, after its own words where those are other words."""
    codes = [subject for subject in erratum.about if isinstance(subject, CodeRef)]
    objects = [subject for subject in erratum.about if isinstance(subject, ObjectRef)]
    others = [subject for subject in erratum.about if not isinstance(subject, CodeRef | ObjectRef)]
    parts = [links.codes(codes), links.objects(objects), *((links.subject(s),) for s in dict.fromkeys(others))]
    found = joined([part for part in parts if part])
    named = ", ".join(erratum.about_text)
    if not found:
        return named
    return found if plain(found) == named else (f"{named}: ", *found)
