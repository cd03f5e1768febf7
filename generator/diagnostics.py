"""Diagnostics as data, and how they are shown: text with the source line and a caret, or JSON."""

import json
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from generator.model.citation import Where
from generator.rules import RULES

_TOKEN = re.compile(r"\"[^\"]*\"|'[^']*'|[^\s,\]}:]+|\S")


@dataclass(frozen=True, slots=True, kw_only=True)
class Diagnostic:
    """One problem of a run.

    Attributes:
        rule: Id of the rule, one of ``generator.rules.RULES``.
        where: Place in a source file.
        message: What is wrong, one line.
        compared: The values that were compared, (what, value) each.
        hint: What helps: the nearest legal name, the line to add.
        other: A second place that has to do with it, with its role ("first defined").
    """

    rule: str
    where: Where
    message: str
    compared: tuple[tuple[str, str], ...] = ()
    hint: str = ""
    other: tuple[str, Where] | None = None

    def __post_init__(self) -> None:
        if self.rule not in RULES:
            raise ValueError(f"diagnostic rule '{self.rule}' is not registered")

    @property
    def order(self) -> tuple[str, int, int, str, str]:
        """Sort key: by place, then by rule."""
        return (self.where.file, self.where.line, self.where.column, self.rule, self.message)


class DiagnosticsError(Exception):
    """A stage ended with problems; ``diagnostics`` holds all of them."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Keep the problems in the order of their places."""
        super().__init__(f"{len(diagnostics)} problems")
        self.diagnostics = tuple(sorted(dict.fromkeys(diagnostics), key=lambda d: d.order))


@dataclass(slots=True)
class Problems:
    """Collector of one stage; ``stop`` is the barrier at its end."""

    found: list[Diagnostic] = field(default_factory=list)

    def add(
        self,
        rule: str,
        where: Where,
        message: str,
        *,
        compared: Iterable[tuple[str, object]] = (),
        hint: str = "",
        other: tuple[str, Where] | None = None,
    ) -> None:
        """Note one problem."""
        self.found.append(
            Diagnostic(
                rule=rule,
                where=where,
                message=message,
                compared=tuple((what, str(value)) for what, value in compared),
                hint=hint,
                other=other,
            )
        )

    def stop(self) -> None:
        """End the stage.

        Raises:
            DiagnosticsError: There was at least one problem.
        """
        if self.found:
            raise DiagnosticsError(self.found)


def nearest(name: str, candidates: Iterable[str], limit: int = 3) -> list[str]:
    """The candidates that ``name`` may have meant, best first."""
    from difflib import get_close_matches

    return get_close_matches(name, sorted(set(candidates)), n=limit, cutoff=0.6)


def suggestion(name: str, candidates: Sequence[str], what: str) -> str:
    """Hint for an unknown name: the nearest candidates, or all of them where they are few."""
    close = nearest(name, candidates)
    if close:
        return "did you mean " + " or ".join(f"'{c}'" for c in close) + "?"
    if not candidates:
        return f"there are no {what} at all"
    shown = sorted(set(candidates))
    more = f" and {len(shown) - 12} more" if len(shown) > 12 else ""
    return f"known {what}: " + ", ".join(shown[:12]) + more


class SourceText:
    """Lines of the source files, read when a message needs them; paths are relative to ``root``."""

    def __init__(self, root: Path) -> None:
        """Read below ``root``."""
        self._root = root
        self._lines: dict[str, list[str]] = {}

    def line(self, where: Where) -> str | None:
        """Text of the line, ``None`` where the file or line does not exist."""
        if where.file not in self._lines:
            try:
                text = (self._root / where.file).read_text(encoding="utf-8", errors="replace")
            except OSError:
                text = ""
            self._lines[where.file] = text.splitlines()
        lines = self._lines[where.file]
        return lines[where.line - 1] if 0 < where.line <= len(lines) else None


def as_text(diagnostics: Iterable[Diagnostic], sources: SourceText) -> str:
    """Diagnostics for people: ``file:line:column: error[rule]: message``, source line with caret, details."""
    return "\n\n".join("\n".join(_text_lines(d, sources)) for d in diagnostics) + "\n"


def _text_lines(diagnostic: Diagnostic, sources: SourceText) -> Iterable[str]:
    where = diagnostic.where
    yield f"{where.file}:{where.line}:{where.column}: error[{diagnostic.rule}]: {diagnostic.message}"
    line = sources.line(where)
    if line is not None and line.strip():
        gutter = f"{where.line:5} | "
        token = _TOKEN.match(line, where.column - 1)
        width = len(token.group()) if token else 1
        yield gutter + line
        yield " " * (len(gutter) - 2) + "| " + " " * (where.column - 1) + "^" * width
    if where.path:
        yield f"  at {where.path}"
    for what, value in diagnostic.compared:
        yield f"  {what}: {value}"
    if diagnostic.other:
        role, place = diagnostic.other
        yield f"  {role}: {place.file}:{place.line}:{place.column}"
    if diagnostic.hint:
        yield f"  hint: {diagnostic.hint}"


def as_json(diagnostics: Iterable[Diagnostic]) -> str:
    """Diagnostics for programs: a JSON list of objects with file, line, column, rule, message and details."""
    return json.dumps([_json_object(d) for d in diagnostics], indent=2, ensure_ascii=False) + "\n"


def _json_object(diagnostic: Diagnostic) -> dict[str, object]:
    entry: dict[str, object] = {
        "file": diagnostic.where.file,
        "line": diagnostic.where.line,
        "column": diagnostic.where.column,
        "severity": "error",
        "rule": diagnostic.rule,
        "message": diagnostic.message,
        "path": diagnostic.where.path,
        "compared": dict(diagnostic.compared),
        "hint": diagnostic.hint or None,
    }
    if diagnostic.other:
        role, place = diagnostic.other
        entry["other"] = {"role": role, "file": place.file, "line": place.line, "column": place.column}
    return entry
