"""What the GSD file of a PROFIBUS device says."""

from dataclasses import dataclass
from enum import Enum

from generator.model.citation import Cite, Origin, Where


class Consistency(Enum):
    """What a master must not tear apart."""

    WORD = "word"
    """Each word by itself."""
    WHOLE = "whole"
    """All words of the module."""


@dataclass(frozen=True, slots=True)
class Wording:
    """A visible string in English and in German."""

    english: str
    german: str

    def text(self, language: str) -> str:
        """The text in a language, "en" or "de"."""
        return self.german if language == "de" else self.english


@dataclass(frozen=True, slots=True, kw_only=True)
class Source:
    """Where a fact of a GSD file comes from; ``cite`` is ``None`` where it is assumed, ``note`` then says why."""

    origin: Origin
    cite: Cite | None
    note: str
    errata: tuple[str, ...]
    where: Where


@dataclass(frozen=True, slots=True)
class Keyword:
    """A keyword of the station and its value; yes and no are 1 and 0."""

    name: str
    value: int | Wording
    source: Source


@dataclass(frozen=True, slots=True)
class BitRate:
    """A supported bit rate as the format names it ("9.6", "12M") and the longest time to a response in bit times."""

    name: str
    max_tsdr: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Module:
    """A module: ``words`` in each direction, with ``channel`` words of a consistent parameter channel in front.

    ``family`` names the modules that differ by their length alone.
    """

    family: str
    name: Wording
    printed: str
    info: Wording | None
    channel: int
    words: int
    consistency: Consistency
    reference: int
    source: Source

    @property
    def length(self) -> int:
        """Bytes in each direction."""
        return 2 * (self.channel + self.words)


@dataclass(frozen=True, slots=True, kw_only=True)
class DiagnosisArea:
    """Bits ``first`` ... ``last`` of the status block, the status type at bit 0, and the texts of their values.

    ``field``: the field of the drive's error number that they hold, if it is one.
    """

    id: str
    field: str | None
    first: int
    last: int
    texts: tuple[tuple[int, Wording], ...]
    source: Source


@dataclass(frozen=True, slots=True, kw_only=True)
class Diagnosis:
    """Texts for the status block of the diagnosis; ``type`` is its status type."""

    type: int
    cite: Cite
    areas: tuple[DiagnosisArea, ...]
    where: Where


@dataclass(frozen=True, slots=True, kw_only=True)
class DpTelegrams:
    """What the telegrams of PROFIBUS DP hold, in bytes.

    ``lengths``: greatest value of each keyword that counts bytes.  ``identifier``: bytes that one identifier counts.
    ``dpv1_parameters``: user parameters that a device with DP-V1 takes at least.  ``status_type``: bytes of the
    diagnosis in front of the status type, those of every device included.
    """

    lengths: tuple[tuple[str, int], ...]
    identifier: int
    dpv1_parameters: int
    status_type: int
    cite: Cite
    where: Where


@dataclass(frozen=True, slots=True, kw_only=True)
class Gsd:
    """A GSD file: ``suffixes`` are (suffix, language) of its variants, of which the first is the default file.

    ``parameters``: the user parameters that a master sends unless the user changes them.
    """

    stem: str
    suffixes: tuple[tuple[str, str], ...]
    cite: Cite
    keywords: tuple[Keyword, ...]
    bit_rates: tuple[BitRate, ...]
    bit_rates_cite: Cite
    max_tsdr: Source
    telegrams: DpTelegrams
    parameters: bytes
    parameters_source: Source
    modules: tuple[Module, ...]
    diagnosis: Diagnosis | None
    where: Where

    def number(self, name: str) -> int:
        """Value of a keyword that is a number; 0, as in the format, where it is left out."""
        value = next((keyword.value for keyword in self.keywords if keyword.name == name), 0)
        return value if isinstance(value, int) else 0
