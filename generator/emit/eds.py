"""EDS files (CiA 306): one for each CANopen device, slot and product.  ``text`` lays out DCF files as well.

The layout is the one that every reader known takes: ASCII, CR LF, one blank line between sections, all keys in
standard spelling and order, no key that a reader could refuse.
"""

import re
import textwrap
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby

from generator import VERSION
from generator.emit.base import EmitError, Output, Target
from generator.emit.canopen import (
    MANUFACTURER_AREA,
    RPDO_PARAMETERS,
    TPDO_PARAMETERS,
    BusObject,
    Configuration,
    Entry,
    ObjectDictionary,
    Remark,
    named_dictionaries,
    number_text,
)
from generator.emit.environment import render as render_template
from generator.model import Cite, DataType, Erratum, Model, NodeRelative, Where
from generator.naming import Scope

_BIT_RATES = (10, 20, 50, 125, 250, 500, 800, 1000)
"""Bit rates in kbit/s that [DeviceInfo] has a key for."""
_ASSUMED = {
    "SimpleBootUpSlave": "1",
    "DynamicChannelsSupported": "0",
    "CompactPDO": "0",
    "GroupMessaging": "0",
    "LSS_Supported": "0",
}
"""Keys of [DeviceInfo] that no manual speaks of."""
_OBJECT_TYPES = {"VAR": "0x7", "ARRAY": "0x8", "RECORD": "0x9"}
_LONGEST_NAME = 241
_COMMENT_WIDTH = 110
_FIGURES = ("index", "standard", "value", "reference")
"""Kinds of errata that change a figure of the file; the others change words."""

_REPLACED = str.maketrans(
    {
        '"': "'",
        ";": ",",
        "#": "no. ",
        "=": ":",
        "\N{LEFT DOUBLE QUOTATION MARK}": "'",
        "\N{RIGHT DOUBLE QUOTATION MARK}": "'",
        "\N{DOUBLE LOW-9 QUOTATION MARK}": "'",
        "\N{LEFT-POINTING DOUBLE ANGLE QUOTATION MARK}": "'",
        "\N{RIGHT-POINTING DOUBLE ANGLE QUOTATION MARK}": "'",
        "\N{RIGHT SINGLE QUOTATION MARK}": "'",
        "\N{EN DASH}": "-",
        "\N{EM DASH}": "-",
        "\N{MINUS SIGN}": "-",
        "\N{BLACK SQUARE}": "/",
        "\N{RIGHTWARDS ARROW}": "->",
        "\N{LEFTWARDS ARROW}": "<-",
        "\N{MULTIPLICATION SIGN}": "x",
        "\N{MICRO SIGN}": "u",
        "\N{GREEK SMALL LETTER MU}": "u",
        "\N{GREEK CAPITAL LETTER OMEGA}": "Ohm",
        "\N{DEGREE SIGN}": " deg",
        "\N{REGISTERED SIGN}": "",
        "\N{TRADE MARK SIGN}": "",
        "\N{LATIN SMALL LETTER SHARP S}": "ss",
    }
)
"""What stands for characters that an EDS cannot hold, or that some reader takes for syntax."""
_NUMBER_LIKE = re.compile(r"[+-]?(0[xX])?[0-9A-Fa-f_]+")
_PLAIN = re.compile(r"[ -!$-:<>-~]+")
"""Printable ASCII without the characters that some reader takes for syntax."""
_WORD = re.compile(r"[A-Za-z0-9]+")


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """Section of an object or a sub-index.

    ``sub_number`` is the number of sub sections of an array or record and "" for a value; ``low``, ``high``,
    ``default`` and ``value`` (what a DCF sets) are "" where the key is left out.
    """

    title: str
    name: str
    object_type: str
    sub_number: str = ""
    data_type: str = ""
    low: str = ""
    high: str = ""
    access: str = ""
    default: str = ""
    value: str = ""
    mapping: str = ""


@dataclass(frozen=True, slots=True)
class ObjectList:
    """A list of supported objects and the text of their sections."""

    title: str
    indexes: tuple[str, ...]
    sections: str


@dataclass(frozen=True, slots=True, kw_only=True)
class FileInfo:
    """Values of [FileInfo]; version and revision are those of the spec, the date is that of its release.

    ``last_eds`` is "" where the file is no DCF.
    """

    name: str
    last_eds: str
    version: str
    revision: str
    description: str
    date: str
    author: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Commissioning:
    """Values of [DeviceComissioning]; the bit rate in kbit/s."""

    node: int
    name: str
    bit_rate: int


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceInfo:
    """Values of [DeviceInfo]; ``bit_rates`` holds (key, "0" or "1"), ``assumed`` what no manual says."""

    vendor_name: str
    vendor_number: str
    product_name: str
    product_number: str
    revision_number: str
    order_code: str
    bit_rates: tuple[tuple[str, str], ...]
    boot_up_master: str
    granularity: str
    rpdos: int
    tpdos: int
    assumed: dict[str, str]


def render(model: Model) -> dict[str, Output]:
    """EDS files of all CANopen devices by file name.

    Raises:
        EmitError: A name, default or text cannot be written in an EDS, or two files would share a name.
    """
    outputs: dict[str, Output] = {}
    rendered: dict[BusObject, str] = {}
    for name, dictionary in named_dictionaries(model, "EDS", file_name):
        outputs[name] = output(text(model, dictionary, name, rendered))
    return outputs


TARGET = Target("eds", render)


def output(content: str) -> Output:
    """A file as CiA 306 has it: ASCII with CR LF."""
    return Output(content, newline="\r\n", encoding="ascii")


def text(
    model: Model,
    dictionary: ObjectDictionary,
    file_name: str,
    rendered: dict[BusObject, str] | None = None,
    *,
    notes: Iterable[str] = (),
    configuration: Configuration | None = None,
    last_eds: str = "",
) -> str:
    """Text of an EDS, or with ``configuration`` of a DCF.

    Args:
        model: What the version and the date come from.
        dictionary: What the file describes.
        file_name: Name of the file, which stands in it too.
        rendered: Keeps the sections of objects, most of which all files of a device share; not for a DCF.
        notes: What to say in [Comments] beyond what follows from the dictionary.
        configuration: What the device is set to.
        last_eds: Name of the EDS that a DCF was made from.

    Raises:
        EmitError: A name, default or text cannot be written in an EDS.
    """
    _claim_names(dictionary, file_name)
    sections = {} if rendered is None else rendered
    for entry in dictionary.objects:
        if entry not in sections:
            sections[entry] = render_template("eds/object.eds.j2", sections=_sections(entry, configuration))
    return render_template(
        "eds/device.eds.j2",
        file=_file_info(model, dictionary, file_name, last_eds),
        device=_device_info(dictionary),
        commissioning=_commissioning(dictionary, configuration),
        comments=_comments(model, dictionary, notes),
        lists=[
            ObjectList(
                title=title,
                indexes=tuple(f"0x{entry.index:04X}" for entry in entries),
                sections="".join(sections[entry] for entry in entries),
            )
            for title, entries in lists(dictionary)
        ],
    )


def lists(dictionary: ObjectDictionary) -> tuple[tuple[str, list[BusObject]], ...]:
    """The three lists of objects in the order of CiA 306."""
    mandatory, optional, manufacturer = [], [], []
    for entry in dictionary.objects:
        if entry.standard is not None and entry.standard.category == "mandatory":
            mandatory.append(entry)
        elif entry.index in MANUFACTURER_AREA:
            manufacturer.append(entry)
        else:
            optional.append(entry)
    return (("MandatoryObjects", mandatory), ("OptionalObjects", optional), ("ManufacturerObjects", manufacturer))


# Objects


def _sections(entry: BusObject, configuration: Configuration | None) -> list[Section]:
    set_to = {
        value.subindex: _written(value, configuration.values[entry.index, value.subindex])
        for value in entry.entries
        if configuration and (entry.index, value.subindex) in configuration.values
    }
    if entry.object_type == "VAR":
        return [_value_section(f"{entry.index:04X}", _object_name(entry), entry.entries[0], set_to.get(0, ""))]
    head = Section(
        title=f"{entry.index:04X}",
        name=_object_name(entry),
        object_type=_OBJECT_TYPES[entry.object_type],
        sub_number=str(len(entry.entries)),
    )
    values = [
        _value_section(
            f"{entry.index:04X}sub{value.subindex:X}", _entry_name(value), value, set_to.get(value.subindex, "")
        )
        for value in entry.entries
    ]
    return [head, *values]


def _value_section(title: str, name: str, entry: Entry, value: str) -> Section:
    return Section(
        title=title,
        name=name,
        object_type=_OBJECT_TYPES["VAR"],
        data_type=f"0x{entry.data_type.canopen_number:04X}",
        low="" if entry.low is None else str(entry.low),
        high="" if entry.high is None else str(entry.high),
        access=entry.access,
        default=_default(entry),
        value=value,
        mapping="1" if entry.mappable else "0",
    )


def _default(entry: Entry) -> str:
    default = entry.default
    if default is None:
        return ""
    if isinstance(default, NodeRelative):
        return f"$NODEID+0x{default.base:X}"
    return _written(entry, default)


def _written(entry: Entry, value: int | str) -> str:
    """A value as the file writes it.

    Raises:
        EmitError: It is a text that an EDS cannot hold.
    """
    if isinstance(value, int):
        return number_text(entry, value)
    if entry.data_type is not DataType.VISIBLE_STRING:
        return value.encode("utf-8").hex().upper()
    if not holds(value):
        raise EmitError("object-value", entry.where, f"an EDS cannot hold the text '{value}'")
    return value


def holds(value: str) -> bool:
    """Whether an EDS can hold the text as a value: printable ASCII without what readers take for syntax."""
    return not value or (_PLAIN.fullmatch(value) is not None and value.strip() == value)


def _object_name(entry: BusObject) -> str:
    return _parameter_name(entry.name, entry.designation, entry.where)


def _entry_name(entry: Entry) -> str:
    return _parameter_name(entry.name, f"Sub-index {entry.subindex}", entry.where)


def _parameter_name(name: str, designation: str, where: Where) -> str:
    """``name`` as ParameterName; ``designation`` goes before a name that readers would take for a number."""
    plain = _plain(name, where)
    if _NUMBER_LIKE.fullmatch(plain):
        plain = f"{designation} {plain}"
    if len(plain) > _LONGEST_NAME:
        raise EmitError("object-value", where, f"a name in an EDS has at most {_LONGEST_NAME} characters")
    return plain


def _claim_names(dictionary: ObjectDictionary, file_name: str) -> None:
    """Names of objects differ in a file, names of sub-indexes in an object: readers look them up by name."""
    objects = Scope(f"objects of {file_name}")
    for entry in dictionary.objects:
        objects.add(_object_name(entry), entry.where)
        values = Scope(f"sub-indexes of {entry.designation} in {file_name}")
        for value in entry.entries:
            values.add(_entry_name(value), value.where)


# Head of the file


def file_stem(dictionary: ObjectDictionary) -> str:
    """Name of the files that describe the dictionary, without its suffix."""
    parts = (dictionary.device.order_code, dictionary.slot or "", dictionary.product.label)
    return "_".join(word for part in parts for word in _WORD.findall(_plain(part, dictionary.device.where)))


def file_name(dictionary: ObjectDictionary) -> str:
    """Name of the EDS."""
    return f"{file_stem(dictionary)}.eds"


def caption(dictionary: ObjectDictionary) -> str:
    """What the dictionary describes, in words."""
    device = dictionary.device
    slot = f" in slot {dictionary.slot}" if dictionary.slot else ""
    product = f", {dictionary.product.label}" if dictionary.product.label else ""
    return f"{device.manufacturer} {device.order_code}{slot}{product}"


def _file_info(model: Model, dictionary: ObjectDictionary, file_name: str, last_eds: str) -> FileInfo:
    version, revision, *_ = model.version.split(".")
    year, month, day = model.date.split("-")
    return FileInfo(
        name=file_name,
        last_eds=last_eds,
        version=version,
        revision=revision,
        description=_plain(caption(dictionary), dictionary.device.where),
        date=f"{month}-{day}-{year}",
        author=f"drivespec {VERSION}",
    )


def _commissioning(dictionary: ObjectDictionary, configuration: Configuration | None) -> Commissioning | None:
    if configuration is None:
        return None
    name = _plain(dictionary.device.order_code, dictionary.device.where)
    return Commissioning(node=configuration.node, name=name, bit_rate=configuration.bit_rate)


def _device_info(dictionary: ObjectDictionary) -> DeviceInfo:
    device, product = dictionary.device, dictionary.product
    facts = dictionary.facts
    return DeviceInfo(
        vendor_name=_plain(device.manufacturer, device.where),
        vendor_number=f"0x{product.vendor_number:08X}",
        product_name=_plain(product.label or device.title, device.where),
        product_number=f"0x{product.product_number:08X}",
        revision_number=f"0x{product.revision_number:08X}",
        order_code=_plain(device.order_code, device.where),
        bit_rates=tuple((f"BaudRate_{rate}", "1" if rate in facts.baud_rates else "0") for rate in _BIT_RATES),
        boot_up_master="1" if facts.boot_up_master else "0",
        granularity=str(facts.granularity),
        rpdos=len(dictionary.of_standard(RPDO_PARAMETERS)),
        tpdos=len(dictionary.of_standard(TPDO_PARAMETERS)),
        assumed=_ASSUMED,
    )


# Comments


def _comments(model: Model, dictionary: ObjectDictionary, notes: Iterable[str]) -> list[str]:
    where = dictionary.device.where
    texts = [*notes, *remarks(model, dictionary)]
    return [line for text in texts for line in textwrap.wrap(_plain(text, where), _COMMENT_WIDTH)]


def remarks(model: Model, dictionary: ObjectDictionary) -> list[str]:
    """Where the facts come from, what was assumed, left out and corrected: what every file says of itself."""
    return [
        *_origin(model, dictionary),
        *assumed(dictionary),
        *left_out(dictionary),
        *_errata(dictionary),
        *_sources(dictionary),
    ]


def _origin(model: Model, dictionary: ObjectDictionary) -> Iterator[str]:
    device, manual = dictionary.device, dictionary.device.manual
    document = f", {manual.document}" if manual.document else ""
    yield f"Generated by drivespec {VERSION} from {manual.title}, {manual.edition}{document}. Do not edit."
    yield f"Specification {model.version} of {model.date}."
    yield f"This is not a file of {device.manufacturer}; its facts are those of the manual and the standards it names."


def assumed(dictionary: ObjectDictionary) -> Iterator[str]:
    """What the file says and the manual does not, a sentence for each reason."""
    if dictionary.product.unknown:
        yield f"Assumed, as the manual gives no figure: 0 as {', '.join(dictionary.product.unknown)}."
    yield f"Assumed, as the manual says nothing: {', '.join(f'{key} {value}' for key, value in _ASSUMED.items())}."
    if _remarked(dictionary, Remark.COUNT_ASSUMED):
        yield "Assumed where none is printed: sub-index 0, read-only, holds the number of the last sub-index."
    defaults: dict[str, list[str]] = {}
    for label, entry in _remarked(dictionary, Remark.DEFAULT_ASSUMED):
        defaults.setdefault(_default(entry), []).append(label)
    for default, labels in defaults.items():
        yield f"Assumed, as none is printed and tools need one: default {default} of {', '.join(labels)}."


def left_out(dictionary: ObjectDictionary) -> Iterator[str]:
    """What the manual says and the file does not, a sentence for each reason."""
    rates = [str(rate) for rate in dictionary.facts.baud_rates if rate not in _BIT_RATES]
    if rates:
        yield f"Left out, as DeviceInfo has no key for them: bit rates of {', '.join(rates)} kbit/s."
    refused: dict[int, list[str]] = {}
    for entry in dictionary.objects:
        for subindex, abort in entry.refused:
            refused.setdefault(abort, []).append(f"{entry.designation}/{subindex}")
    for abort, labels in refused.items():
        yield f"Left out, as the device refuses any access with abort code 0x{abort:08X}: {', '.join(labels)}."
    cut = [label for label, _ in _remarked(dictionary, Remark.LIMITS_CUT)]
    if cut:
        yield f"Limits are those of the data type, as the printed range is wider: {', '.join(cut)}."
    outside = [label for label, _ in _remarked(dictionary, Remark.LIMITS_LEFT_OUT)]
    if outside:
        yield f"Left out, as the printed default lies outside of them: limits of {', '.join(outside)}."


def _remarked(dictionary: ObjectDictionary, remark: Remark) -> list[tuple[str, Entry]]:
    """Entries with the remark, each with its designation."""
    return [
        (entry.designation if entry.object_type == "VAR" else f"{entry.designation}/{value.subindex}", value)
        for entry in dictionary.objects
        for value in entry.entries
        if remark in value.remarks
    ]


def _errata(dictionary: ObjectDictionary) -> Iterator[str]:
    found = corrected(dictionary)
    if found:
        yield "Figures that the manual prints otherwise. The reasons, and all other errata, stand in the reference."
    for erratum, concerned in found:
        yield f"{concerned}: {erratum.used_text}, printed {printed(erratum)} ({erratum.id})."


def corrected(dictionary: ObjectDictionary) -> list[tuple[Erratum, str]]:
    """Errata that change a figure, each with the designations of the objects that it concerns."""
    concerned: dict[str, list[str]] = {}
    designations = sorted(entry.designation for entry in dictionary.objects)
    for entry in sorted(dictionary.objects, key=lambda entry: entry.designation):
        for name in entry.errata:
            concerned.setdefault(name, []).append(entry.designation)
    found = (e for e in dictionary.device.errata if e.id in concerned and e.rule and e.kind in _FIGURES)
    return [(erratum, _runs(concerned[erratum.id], designations)) for erratum in found]


def printed(erratum: Erratum) -> str:
    """What an erratum says is printed, in words or as each place has it."""
    return erratum.printed_text or " / ".join(place.printed for place in erratum.places)


def _runs(some: Sequence[str], all_of: Sequence[str]) -> str:
    """``some`` of the designations, three and more that follow each other as "first ... last"."""
    places = sorted(all_of.index(designation) for designation in some)
    parts: list[str] = []
    for _, run in groupby(enumerate(places), lambda pair: pair[1] - pair[0]):
        names = [all_of[place] for _, place in run]
        parts += names if len(names) < 3 else [f"{names[0]} ... {names[-1]}"]
    return ", ".join(parts)


def _sources(dictionary: ObjectDictionary) -> Iterator[str]:
    """Where the facts of each object are printed, one text for each chapter."""
    chapters: dict[tuple[str, str], dict[int | None, list[str]]] = {}
    for entry in sorted(dictionary.objects, key=lambda entry: entry.designation):
        for cite in entry.cites:
            pages = chapters.setdefault((cite.manual, cite.chapter), {})
            pages.setdefault(cite.page, []).append(entry.designation)
    for (manual, chapter), pages in chapters.items():
        places = (
            " ".join(designations) + ("" if page is None else f" (p. {page})")
            for page, designations in sorted(pages.items(), key=lambda item: item[0] or 0)
        )
        yield f"{Cite(manual, chapter)}: {', '.join(places)}."


# Text


def _plain(text: str, where: Where) -> str:
    """``text`` in printable ASCII without the characters that readers of EDS files take for syntax.

    Raises:
        EmitError: A character has no counterpart in ASCII.
    """
    if _PLAIN.fullmatch(text):
        return text
    letters = unicodedata.normalize("NFKD", text.translate(_REPLACED))
    plain = " ".join("".join(letter for letter in letters if not unicodedata.combining(letter)).split())
    if plain and not _PLAIN.fullmatch(plain):
        raise EmitError("not-ascii", where, f"'{text}' has a character that an EDS cannot hold")
    return plain
