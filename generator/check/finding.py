"""A disagreement that a check sees."""

from dataclasses import dataclass, field

from generator.model import Where
from generator.model.erratum import Subject


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """A printed thing that is not what it should be.

    ``place`` says where it is printed, in words ("MXI2 index decimal"); ``printed`` and ``expected`` are compared
    with what the ledger says; ``variables`` are those that its formulas may use.
    """

    rule: str
    subject: Subject
    place: str
    printed: int | str
    expected: int | str
    message: str
    where: Where
    hint: str = ""
    variables: dict[str, int] = field(default_factory=dict)
