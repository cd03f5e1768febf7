"""Citations: the chapter exists and the page is one of it."""

from collections.abc import Iterator
from typing import Protocol

from generator.diagnostics import Problems, suggestion
from generator.model import Cite, Gsd, Manual, Model, Where


class Cited(Protocol):
    """Something with a citation."""

    @property
    def cite(self) -> Cite:
        """Where the manual says it."""
        ...


class Placed(Cited, Protocol):
    """Something with a citation and a place in spec."""

    @property
    def where(self) -> Where:
        """Where spec says it."""
        ...


def check(model: Model, problems: Problems) -> None:
    """Note every citation that leads nowhere."""
    manuals = {m.id: m for m in model.manuals}
    for cite, where in dict.fromkeys(_citations(model)):
        manual = manuals.get(cite.manual)
        if manual is None:
            hint = suggestion(cite.manual, list(manuals), "manuals")
            problems.add("citation", where, f"there is no manual '{cite.manual}'", hint=hint)
            continue
        _check_place(cite, manual, where, problems)


def _citations(model: Model) -> Iterator[tuple[Cite, Where]]:
    for drive in model.drives:
        named: list[Cited] = [*drive.responses, *drive.modules, *drive.commands]
        for cite in (
            *drive.index_base_cites,
            *drive.command_code_cites,
            drive.error_fields_cite,
            *(n.cite for n in named),
        ):
            yield cite, drive.where
    standards: list[Placed] = [*model.standard_objects, *model.cob_ids]
    for defined in standards:
        yield defined.cite, defined.where
    for device in model.devices:
        yield device.cite, device.where
        entries: list[Placed] = [*device.codes, *device.objects, *device.errors, *device.indicators, *device.switches]
        entries += [*device.tables, *device.formulas, *device.layouts, *device.examples]
        entries += [row for table in device.indicators for row in table.rows]
        for entry in entries:
            yield entry.cite, entry.where
        for table in device.tables:
            if table.assignment is not None:
                yield table.assignment.connector.cite, table.assignment.connector.where
        for group in device.switches:
            for part in (group.block, group.delivered, group.code_counts):
                if part is not None:
                    yield part.cite, group.where
        for code in device.codes:
            if code.default_cite is not None:
                yield code.default_cite, code.where
        if device.gsd is not None:
            yield from _gsd_citations(device.gsd)


def _gsd_citations(gsd: Gsd) -> Iterator[tuple[Cite, Where]]:
    yield gsd.cite, gsd.where
    yield gsd.telegrams.cite, gsd.telegrams.where
    yield gsd.bit_rates_cite, gsd.max_tsdr.where
    sources = [gsd.max_tsdr, gsd.parameters_source, *(keyword.source for keyword in gsd.keywords)]
    sources += [module.source for module in gsd.modules]
    if gsd.diagnosis is not None:
        yield gsd.diagnosis.cite, gsd.diagnosis.where
        sources += [area.source for area in gsd.diagnosis.areas]
    for source in sources:
        if source.cite is not None:
            yield source.cite, source.where


def _check_place(cite: Cite, manual: Manual, where: Where, problems: Problems) -> None:
    numbers = [c.number for c in manual.chapters]
    if cite.chapter not in numbers:
        hint = suggestion(cite.chapter, numbers, "chapters")
        problems.add("citation", where, f"{manual.id} has no chapter '{cite.chapter}'", hint=hint)
        return
    if cite.page is None:
        return
    first, last = _pages(manual, cite.chapter)
    if (first is not None and cite.page < first) or (last is not None and cite.page > last):
        problems.add(
            "citation",
            where,
            f"page {cite.page} is not a page of chapter {cite.chapter}",
            compared=[("pages of the chapter", f"{first} ... {last}")],
            hint="correct the page or the chapter",
        )


def _pages(manual: Manual, chapter: str) -> tuple[int | None, int | None]:
    """First page of a chapter, and the page on which the next chapter of the same or a higher level begins."""
    position = next(i for i, c in enumerate(manual.chapters) if c.number == chapter)
    level = chapter.count(".")
    for following in manual.chapters[position + 1 :]:
        if following.page is not None and following.number.count(".") <= level:
            return manual.chapters[position].page, following.page
    return manual.chapters[position].page, manual.pages
