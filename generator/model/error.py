"""Error numbers of all kinds."""

from dataclasses import dataclass

from generator.model.citation import Cite, Origin, Where
from generator.model.reference import CodeRef, ErrorRef


@dataclass(frozen=True, slots=True)
class PrintedNumber:
    """A number or run as one place prints it; ``base`` is 16 or 10, ``last`` is ``None`` for one number.

    ``place``: "overview MXI1", "detail MXI2", ...
    """

    place: str
    base: int
    first: int
    last: int | None
    page: int | None
    where: Where


@dataclass(frozen=True, slots=True, kw_only=True)
class ErrorEntry:
    """An error number or a run ``number`` ... ``last`` (``last`` = ``number`` for a single one).

    ``kind``: "device" (32-bit error number), "emergency", "sdo_abort", "dpv0", "dpv1" or "gci".
    ``response``: preset response, by its name in the drive's list.  ``responses``: those that can be selected.
    ``adjustable_in``: codes that set the response: of a run one for each number where there are as many, else those
    of every slot.  ``named_in`` is what the manual names, codes that do not exist included.
    ``printed_names``: (place, name) where a place prints another name.
    """

    kind: str
    number: int
    last: int
    slot: str | None
    name: str
    response: str | None
    responses: tuple[str, ...]
    adjustable_in: tuple[CodeRef, ...]
    named_in: tuple[CodeRef, ...]
    printed_adjustable_in: tuple[tuple[str, tuple[CodeRef, ...], Where], ...]
    register: str | None
    causes: tuple[str, ...]
    remedies: tuple[str, ...]
    description: str
    origin: Origin
    cite: Cite
    printed: tuple[PrintedNumber, ...]
    printed_names: tuple[tuple[str, str, Where], ...]
    errata: tuple[str, ...]
    where: Where

    @property
    def ref(self) -> ErrorRef:
        """Reference to the entry by its first number."""
        return ErrorRef(self.kind, self.number)

    @property
    def count(self) -> int:
        """How many numbers the entry stands for."""
        return self.last - self.number + 1
