"""The stages in order, with a barrier after each."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from generator.check import check
from generator.diagnostics import Diagnostic, DiagnosticsError, Problems
from generator.elaborate import elaborate
from generator.emit import targets
from generator.emit.base import EmitError
from generator.emit.pins import broken
from generator.model import Model
from generator.offer import SUMS, offer, sums
from generator.spec import load
from generator.write import digest


def compile_model(folder: Path, label: str) -> Model:
    """The checked model of a spec folder; ``label`` is its name in messages.

    Raises:
        DiagnosticsError: All problems of the first stage that had any.
    """
    problems = Problems()
    model = elaborate(load(folder, label, problems), problems)
    check(model, problems)
    return model


def render(model: Model) -> dict[str, bytes]:
    """Every artifact of every target, by path below generated/.

    Raises:
        DiagnosticsError: A target cannot express a fact, one problem of each target that failed; or names of the last
            release are gone.
    """
    files: dict[str, bytes] = {}
    problems = [_diagnostic(error) for error in broken(model)]
    for target in targets():
        try:
            for path, output in target.render(model).items():
                files[f"{target.name}/{path}"] = output.data()
        except EmitError as error:
            problems.append(_diagnostic(error))
    if problems:
        raise DiagnosticsError(problems)
    return files


def render_site(model: Model, url: str = "") -> dict[str, bytes]:
    """The reference as a folder to be published: its pages, and below files/ what they offer.

    With ``url``, the address that the folder will have (ended by "/"), pages name theirs and there is a sitemap.

    Raises:
        DiagnosticsError: A target or the reference cannot express a fact.
    """
    from generator.emit import html  # only the site pays for loading it

    files = offer(model.version, render(model))
    offered = {path: html.Stored(len(data), digest(data)) for path, data in files.items()}
    with reported():
        pages = {path: output.data() for path, output in html.render(model, offered, url).items()}
    return {**pages, **{f"{html.FOLDER}/{path}": data for path, data in {**files, SUMS: sums(files)}.items()}}


@contextmanager
def reported() -> Iterator[None]:
    """Raise a ``DiagnosticsError`` for an ``EmitError`` of the block."""
    try:
        yield
    except EmitError as error:
        raise DiagnosticsError([_diagnostic(error)]) from error


def _diagnostic(error: EmitError) -> Diagnostic:
    return Diagnostic(
        rule=error.rule,
        where=error.where,
        message=error.message,
        hint=error.hint,
        other=("other entry", error.other) if error.other else None,
    )
