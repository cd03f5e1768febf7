"""GSD files (ISO 15745-3) of PROFIBUS devices: one for each language.

The layout is the one that every reader known takes: ASCII, CR LF, keywords in standard spelling and order, comments
behind numbers and strings alone, no key of a maker's own.
"""

import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from generator import VERSION
from generator.emit.base import EmitError, Output, Target
from generator.emit.c.syntax import ascii_text
from generator.emit.environment import render as render_template
from generator.model import Cite, Device, Gsd, Model, Origin
from generator.model.gsd import Consistency, Diagnosis, Keyword, Module, Source, Wording

IDENTITY = (
    "GSD_Revision",
    "Vendor_Name",
    "Model_Name",
    "Revision",
    "Ident_Number",
    "Protocol_Ident",
    "Station_Type",
    "FMS_supp",
    "Hardware_Release",
    "Software_Release",
    "OrderNumber",
    "Info_Text",
)
CONNECTOR = ("Redundancy", "Repeater_Ctrl_Sig", "24V_Pins")
STATION = (
    "Freeze_Mode_supp",
    "Sync_Mode_supp",
    "Auto_Baud_supp",
    "Set_Slave_Add_supp",
    "Fail_Safe",
    "Min_Slave_Intervall",
    "Max_Diag_Data_Len",
    "Modul_Offset",
    "Slave_Family",
    "Modular_Station",
    "Max_Module",
    "Max_Input_Len",
    "Max_Output_Len",
    "Max_Data_Len",
)
PARAMETERS = ("Max_User_Prm_Data_Len",)
ACYCLIC = (
    "DPV1_Slave",
    "C1_Read_Write_supp",
    "C1_Max_Data_Len",
    "C1_Response_Timeout",
    "C2_Read_Write_supp",
    "C2_Max_Data_Len",
    "C2_Response_Timeout",
    "C2_Max_Count_Channels",
    "Max_Initiate_PDU_Length",
)
"""Keywords of the station by section, in the order of the file."""

_HEXADECIMAL = ("Ident_Number",)
_UNQUOTED = ("Slave_Family",)
"""Keywords whose value is bare text up to the end of the line, so that no comment can follow."""
_WIDTH = 100
"""Greatest width of a comment line."""

_IN_AND_OUT = 0x30
_WORDS = 0x40
_WHOLE = 0x80
_GENERAL_WORDS = 16
"""Most words that the general form of an identifier byte counts."""
_SPECIAL = 0xC0
"""Special form: a length byte for the outputs and one for the inputs follow."""


@dataclass(frozen=True, slots=True)
class Line:
    """A keyword with the comments above it and the mark behind it, "" where there is none."""

    comments: tuple[str, ...]
    text: str
    mark: str


@dataclass(frozen=True, slots=True)
class Section:
    """Keywords under a heading."""

    title: str
    lines: tuple[Line, ...]


@dataclass(frozen=True, slots=True)
class AreaView:
    """An area of the diagnosis: bits as "24-31", values and texts."""

    comments: tuple[str, ...]
    bits: str
    texts: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class DiagnosisView:
    """Texts for a status type."""

    type: str
    cite: str
    areas: tuple[AreaView, ...]


@dataclass(frozen=True, slots=True)
class ModuleView:
    """A module; ``comments`` stand above the first of a run, ``info`` is "" where there is none."""

    comments: tuple[str, ...]
    name: str
    identifiers: str
    reference: str
    info: str


def render(model: Model) -> dict[str, Output]:
    """GSD files of all PROFIBUS devices by file name.

    Raises:
        EmitError: Two files would share a name.
    """
    outputs: dict[str, Output] = {}
    for device, gsd in ((device, device.gsd) for device in model.devices if device.gsd is not None):
        for name, language in file_names(gsd):
            if name in outputs:
                raise EmitError("name-collision", gsd.where, f"two GSD files would be called '{name}'")
            outputs[name] = _output(model, device, gsd, name, language)
    return outputs


TARGET = Target("gsd", render)


def file_names(gsd: Gsd) -> tuple[tuple[str, str], ...]:
    """Names of the files with the language of each, "en" or "de"."""
    return tuple((f"{gsd.stem}.{suffix}", language) for suffix, language in gsd.suffixes)


def value_text(keyword: Keyword, language: str) -> str:
    """Value of a keyword as the file writes it."""
    value = keyword.value
    if not isinstance(value, Wording):
        return f"0x{value:04X}" if keyword.name in _HEXADECIMAL else str(value)
    text = value.text(language)
    return text if keyword.name in _UNQUOTED else f'"{text}"'


def identifiers(module: Module) -> bytes:
    """The identifier bytes that a master sends for a module."""
    whole = module.consistency is Consistency.WHOLE
    channel = _identifier(module.channel, True) if module.channel else b""
    return channel + _identifier(module.words, whole)


def _identifier(words: int, whole: bool) -> bytes:
    length = _WORDS | (_WHOLE if whole else 0) | (words - 1)
    return bytes([length | _IN_AND_OUT]) if words <= _GENERAL_WORDS else bytes([_SPECIAL, length, length])


def _output(model: Model, device: Device, gsd: Gsd, name: str, language: str) -> Output:
    file = _File(device, gsd, language)
    text = render_template(
        "gsd/device.gsd.j2",
        head=file.head(model, name),
        before=file.before(),
        diagnosis=file.diagnosis(gsd.diagnosis) if gsd.diagnosis else None,
        after=file.after(),
        modules=file.modules(),
    )
    return Output(text, newline="\r\n", encoding="ascii")


class _File:
    """The views of one file."""

    def __init__(self, device: Device, gsd: Gsd, language: str) -> None:
        self._device = device
        self._gsd = gsd
        self._language = language
        self._keywords = {keyword.name: keyword for keyword in gsd.keywords}
        self._errata = {erratum.id: erratum for erratum in device.errata}

    def head(self, model: Model, name: str) -> list[str]:
        """Where the file comes from; a blank stands in front of each text."""
        manual = self._device.manual
        texts = (
            f"Generated by drivespec {VERSION} from {manual.title}, {manual.edition}. Do not edit.",
            f"Specification {model.version} of {model.date}.",
            f"This is not a file of {self._device.manufacturer}; its facts are those of the manual. What the manual "
            "does not say is assumed, and marked so.",
            f"Citations without the name of a document are of {manual.id}.",
        )
        return [f" {line}" for line in (name, *(line for text in texts for line in _wrapped(text)))]

    def before(self) -> list[Section]:
        """Sections in front of the texts of the diagnosis."""
        rates, cite, times = self._gsd.bit_rates, self._cite(self._gsd.bit_rates_cite), self._gsd.max_tsdr
        bit_rates = [Line((), f"{rate.name}_supp=1", cite) for rate in rates]
        max_tsdr = [
            Line(
                tuple(self._remarks(times)) if rate is rates[0] else (),
                f"MaxTsdr_{rate.name}={rate.max_tsdr}",
                self._origin(times),
            )
            for rate in rates
        ]
        return [
            Section("Identity", self._lines(IDENTITY)),
            Section("Bit rates", (*bit_rates, *max_tsdr)),
            Section("Bus connector", self._lines(CONNECTOR)),
            Section("Station", self._lines(STATION)),
        ]

    def after(self) -> list[Section]:
        """Sections behind the texts of the diagnosis."""
        data = ",".join(f"0x{byte:02X}" for byte in self._gsd.parameters)
        constant = self._line(f"Ext_User_Prm_Data_Const(0)={data}", self._gsd.parameters_source)
        sections = [
            Section("User parameters", (*self._lines(PARAMETERS), constant)),
            Section("DP-V1", self._lines(ACYCLIC)),
        ]
        return [section for section in sections if section.lines]

    def diagnosis(self, diagnosis: Diagnosis) -> DiagnosisView:
        """Texts for the status block."""
        return DiagnosisView(
            type=str(diagnosis.type),
            cite=self._cite(diagnosis.cite),
            areas=tuple(
                AreaView(
                    comments=(f"{area.id}: {self._origin(area.source)}", *self._remarks(area.source)),
                    bits=f"{area.first}-{area.last}",
                    texts=tuple((str(value), wording.text(self._language)) for value, wording in area.texts),
                )
                for area in diagnosis.areas
            ),
        )

    def modules(self) -> Iterator[ModuleView]:
        """All modules."""
        families = set()
        for module in self._gsd.modules:
            first = module.family not in families
            families.add(module.family)
            comments = (f"{module.family}: {self._origin(module.source)}", *self._remarks(module.source))
            yield ModuleView(
                comments=comments if first else (),
                name=module.name.text(self._language),
                identifiers=",".join(f"0x{byte:02X}" for byte in identifiers(module)),
                reference=str(module.reference),
                info=module.info.text(self._language) if module.info else "",
            )

    def _lines(self, names: Sequence[str]) -> tuple[Line, ...]:
        return tuple(self._keyword(self._keywords[name]) for name in names if name in self._keywords)

    def _keyword(self, keyword: Keyword) -> Line:
        line = self._line(f"{keyword.name}={value_text(keyword, self._language)}", keyword.source)
        return Line((line.mark, *line.comments), line.text, "") if keyword.name in _UNQUOTED else line

    def _line(self, text: str, source: Source) -> Line:
        return Line(tuple(self._remarks(source)), text, self._origin(source))

    def _remarks(self, source: Source) -> Iterator[str]:
        """The note and the errata, as comment lines."""
        if source.note:
            yield from _wrapped(source.note)
        for name in source.errata:
            erratum = self._errata[name]
            printed = erratum.printed_text or " / ".join(place.printed for place in erratum.places)
            yield from _wrapped(f"Erratum {name}: printed {printed}; used {erratum.used_text}")

    def _origin(self, source: Source) -> str:
        """Citation and origin: "4.1 p. 15", "4.3 p. 19, derived", "assumed"."""
        parts = [self._cite(source.cite)] if source.cite else []
        if source.origin is not Origin.MANUAL:
            parts.append(source.origin.value)
        return ", ".join(parts)

    def _cite(self, cite: Cite) -> str:
        return cite.place if cite.manual == self._device.manual.id else str(cite)


def _wrapped(text: str) -> list[str]:
    return textwrap.wrap(ascii_text(text), _WIDTH)
