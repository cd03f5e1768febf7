"""What a target is: a pure function from the model to files, and the problems that it can report."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from generator.model import Model, Where


@dataclass(frozen=True, slots=True)
class Output:
    """Text of one artifact, its lines ended by a line feed, and how it is written: line ends and encoding."""

    text: str
    newline: str = "\n"
    encoding: str = "utf-8"

    def data(self) -> bytes:
        """Bytes of the file.

        Raises:
            UnicodeEncodeError: The text has a character that the encoding does not know.
        """
        return self.text.replace("\n", self.newline).encode(self.encoding)


@dataclass(frozen=True, slots=True)
class Target:
    """A kind of artifact: ``render`` maps the model to files by their path below generated/<name>/."""

    name: str
    render: Callable[[Model], Mapping[str, Output]]


class EmitError(Exception):
    """A fact that a target cannot express; becomes a diagnostic at ``where``.

    Attributes:
        rule: Id of the diagnostic rule.
        where: Place of the fact in spec.
        message: What is wrong.
        hint: What to do about it.
        other: A second place that has to do with it.
    """

    def __init__(self, rule: str, where: Where, message: str, hint: str = "", other: Where | None = None) -> None:
        """Keep the parts of the diagnostic."""
        super().__init__(message)
        self.rule = rule
        self.where = where
        self.message = message
        self.hint = hint
        self.other = other
