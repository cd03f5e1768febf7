"""Mistakes on the command line: what is wrong with an argument, shown like the diagnostics of the spec."""

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Mistake:
    """One mistake.

    Attributes:
        option: The option as typed, "" for the command as a whole.
        argument: Its argument as typed.
        column: Where in the argument the mistake begins, from 0.
        length: How many characters it has.
        message: What is wrong, one line.
        compared: The values that were compared, (what, value) each.
        hint: What helps.
    """

    option: str
    argument: str
    column: int = 0
    length: int = 0
    message: str
    compared: tuple[tuple[str, str], ...] = ()
    hint: str = ""


class MistakesError(Exception):
    """The command cannot be carried out; ``mistakes`` holds all reasons."""

    def __init__(self, mistakes: Sequence[Mistake]) -> None:
        """Keep the mistakes in the order of the arguments."""
        super().__init__("; ".join(mistake.message for mistake in mistakes))
        self.mistakes = tuple(mistakes)


def as_text(mistakes: Iterable[Mistake]) -> str:
    """Mistakes for people: the message, the argument with a caret, details."""
    return "\n\n".join("\n".join(_lines(mistake)) for mistake in mistakes) + "\n"


def _lines(mistake: Mistake) -> Iterable[str]:
    yield f"command line: error: {mistake.message}"
    if mistake.option:
        before = f"{mistake.option} "
        yield f"      | {before}{mistake.argument}"
        width = mistake.length or len(mistake.argument) - mistake.column
        yield f"      | {' ' * (len(before) + mistake.column)}{'^' * max(width, 1)}"
    for what, value in mistake.compared:
        yield f"  {what}: {value}"
    if mistake.hint:
        yield f"  hint: {mistake.hint}"


def as_json(mistakes: Iterable[Mistake]) -> str:
    """Mistakes for programs: a JSON list of objects."""
    return json.dumps([_object(mistake) for mistake in mistakes], indent=2) + "\n"


def _object(mistake: Mistake) -> dict[str, object]:
    return {
        "option": mistake.option or None,
        "argument": mistake.argument,
        "column": mistake.column,
        "severity": "error",
        "message": mistake.message,
        "compared": dict(mistake.compared),
        "hint": mistake.hint or None,
    }
