"""Services: how a parameter is read and written over a bus, as fillings of the layouts of its telegrams."""

from dataclasses import dataclass
from enum import Enum

from generator.model.citation import Cite, Origin, Where


class Does(Enum):
    """What a service is for."""

    READ = "read"
    WRITE = "write"
    REFUSE = "refuse"
    REPORT = "report"


class What(Enum):
    """What a field of a service holds where the telegram decides."""

    INDEX = "INDEX"
    SUBINDEX = "SUBINDEX"
    ELEMENTS = "ELEMENTS"
    CODE = "CODE"
    VALUE = "VALUE"
    LENGTH = "LENGTH"
    ERROR = "ERROR"
    REGISTER = "REGISTER"
    FREE = "FREE"
    BEHIND = "BEHIND"


@dataclass(frozen=True, slots=True)
class Filler:
    """A field that is filled for each telegram.

    ``INDEX`` and ``CODE``: that of the parameter.  ``SUBINDEX``: its sub-index or subcode, 0 for a single variable;
    ``ELEMENTS``: 1 where there is a sub-index, otherwise 0.  ``VALUE``: the value as it travels, ``LENGTH`` its length
    in bytes.  ``ERROR``: the error number, ``REGISTER`` the value of the error register with it.  ``FREE``: chosen by
    the sender of a request and repeated in the answer.  ``BEHIND``: number of bytes behind the field ``field``.
    ``low`` ... ``high``: only these bits of it.
    """

    what: What
    low: int | None = None
    high: int | None = None
    field: str = ""

    def __str__(self) -> str:
        if self.field:
            return f"${self.what.value} {self.field}"
        return f"${self.what.value}" + (f" {self.low}...{self.high}" if self.low is not None else "")


@dataclass(frozen=True, slots=True)
class Choice:
    """A filling that depends on the value's data type; ``cases`` in the order written.

    A key is the name of a type, of a code ("BITFIELD_8") or of CiA 301 ("UNSIGNED8"), or a length in bytes as text.
    ``otherwise`` is ``None`` where the service carries no other types.
    """

    cases: tuple[tuple[str, "Filling"], ...]
    otherwise: "Filling | None"


Filling = int | str | Filler | Choice | tuple["Fillings", ...]
"""What stands in a field: a number, a text, a filler, a choice, or the repetitions of a group."""
Fillings = tuple[tuple[str, Filling], ...]
"""Fillings by field, in the order written; "field.part" for a part of a number.  What is not named is 0 or empty."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Message:
    """A telegram of a service.

    ``identifier``: name of its identifier in the predefined connection set, ``None`` where the bus has none.
    ``layout``: id of its layout, or a choice among ids.
    """

    identifier: str | None
    layout: str | Choice
    values: Fillings


@dataclass(frozen=True, slots=True, kw_only=True)
class Service:
    """A way to read or write a parameter, to refuse that (``does`` "refuse"), or to report an error.

    ``reaches``: "codes", "objects" or both.  ``errors``: kind of the error numbers in its answer.  ``limit``: most
    bytes of a telegram, ``None`` where the layout alone limits them.
    """

    id: str
    name: str
    does: Does
    reaches: tuple[str, ...]
    request: Message | None
    answer: Message | None
    errors: str | None
    limit: int | None
    description: str
    origin: Origin
    cite: Cite
    errata: tuple[str, ...]
    where: Where

    @property
    def messages(self) -> tuple[Message, ...]:
        """Request and answer, as far as they are known."""
        return tuple(message for message in (self.request, self.answer) if message is not None)
