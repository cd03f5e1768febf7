"""Citations: the chapter exists and the page is one of it."""

from collections.abc import Sequence

from generator.diagnostics import Problems, suggestion
from generator.model import ANYWHERE, Chapter, Cited, Manual, Model


def check(model: Model, problems: Problems) -> None:
    """Note every citation that leads nowhere."""
    manuals = {manual.id: manual for manual in model.manuals}
    pages = {manual.id: _pages(manual) for manual in model.manuals}
    for cited in model.cites:
        cite = cited.cite
        known = pages.get(cite.manual, {})
        if cite.chapter in known:
            if cite.page is not None:
                _check_page(cited, known[cite.chapter], problems)
        elif cited.page_alone:
            continue  # what is wrong with manual or chapter is noted where they stand
        elif not cite.manual:
            message = "neither the citation nor the head of the file names a manual"
            problems.add("citation", cited.where, message, hint="write the manual in front of the chapter")
        elif cite.manual not in manuals:
            hint = suggestion(cite.manual, list(manuals), "manuals")
            problems.add("citation", cited.where, f"there is no manual '{cite.manual}'", hint=hint)
        else:
            hint = suggestion(cite.chapter, [chapter for chapter in known if chapter != ANYWHERE], "chapters")
            problems.add("citation", cited.where, f"{cite.manual} has no chapter '{cite.chapter}'", hint=hint)


def _check_page(cited: Cited, pages: tuple[int, int | None], problems: Problems) -> None:
    cite, (first, last) = cited.cite, pages
    if cite.page is None or (first <= cite.page and (last is None or cite.page <= last)):
        return
    whole = cite.manual if cite.chapter == ANYWHERE else f"chapter {cite.chapter}"
    problems.add(
        "citation",
        cited.where,
        f"page {cite.page} is not a page of {whole}",
        compared=[(f"pages of the {'manual' if cite.chapter == ANYWHERE else 'chapter'}", f"{first} ... {last}")],
        hint="correct the page or the chapter",
    )


def _pages(manual: Manual) -> dict[str, tuple[int, int | None]]:
    """First and last page by chapter; the last is the one on which the next chapter of no lower level begins."""
    found: dict[str, tuple[int, int | None]] = {ANYWHERE: (1, manual.pages)}
    for position, chapter in enumerate(manual.chapters):
        found[chapter.number] = (chapter.page or 1, _last(chapter, manual.chapters[position + 1 :], manual.pages))
    return found


def _last(chapter: Chapter, following: Sequence[Chapter], pages: int | None) -> int | None:
    level = chapter.number.count(".")
    return next((c.page for c in following if c.page is not None and c.number.count(".") <= level), pages)
