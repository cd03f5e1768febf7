"""What a check sees: a disagreement, or that a place agrees."""

from dataclasses import dataclass, field

from generator.model import Where
from generator.model.erratum import Subject


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """A printed thing beside what it should be.

    Rules that look at many printed forms of one figure also yield those that agree, so that the ledger cannot claim
    an error where the manual is right.

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

    @property
    def agrees(self) -> bool:
        """Whether the printed thing is as it should be."""
        return self.printed == self.expected
