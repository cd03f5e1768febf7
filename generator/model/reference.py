"""References between facts, in the notations of the manuals."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, order=True)
class CodeRef:
    """Lenze code 0 ... 24575, with the subcode where one is meant: C13372/2."""

    number: int
    subcode: int | None = None

    def __str__(self) -> str:
        return f"C{self.number:05d}" + (f"/{self.subcode}" if self.subcode is not None else "")


@dataclass(frozen=True, slots=True, order=True)
class ObjectRef:
    """Object of the object dictionary, 0x0000 ... 0xFFFF, with the sub-index where one is meant: I-1800/1."""

    index: int
    subindex: int | None = None

    def __str__(self) -> str:
        return f"I-{self.index:04X}" + (f"/{self.subindex}" if self.subindex is not None else "")


@dataclass(frozen=True, slots=True, order=True)
class ErrorRef:
    """Error number of a kind ("device", "emergency", ...): E-0x009d0000."""

    kind: str
    number: int

    def __str__(self) -> str:
        return f"E-0x{self.number:08x}"
