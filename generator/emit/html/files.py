"""The files of a device for the tools that set up bus masters: what is in them, assumed and corrected.

Names, figures and statements are those of the targets that write the files.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from generator.emit import eds, gsd, xdd
from generator.emit.canopen import (
    RPDO_PARAMETERS,
    TPDO_PARAMETERS,
    Entry,
    ObjectDictionary,
    object_dictionaries,
)
from generator.emit.html.blocks import Fact, Row, Table
from generator.emit.html.downloads import label_of, language_of, path_of
from generator.emit.html.links import Links
from generator.emit.html.notes import is_slip
from generator.emit.html.text import NONE, Piece, Prose, hexadecimal, joined, noted, shown_origin, through
from generator.model import Device, Erratum, Gsd, NodeRelative, Origin
from generator.model.gsd import Consistency, Module, Source

_FILES_EDS = ("For", "EDS", "XDD", "Vendor number", "Product number", "Revision number")
_CONTENTS_EDS = ("For", "Mandatory", "Optional", "Manufacturer", "RPDOs", "TPDOs", "Values", "Mappable", "By node-ID")
_FILES_GSD = ("File", "Language")
_MODULES = ("Modules", "Count", "Bytes in each direction", "Consistent", "Reason or remark", "Source")
_DIAGNOSIS = ("Bits of the status block", "Texts", "Reason or remark", "Source")
_ORIGIN = ("Keyword", "Value", "Reason or remark", "Source")
_CORRECTED = ("Erratum", "Concerns", "Printed", "Used")
_COUNTED = (
    "Objects of each list, PDOs, values that an SDO can address, those that a PDO can carry, "
    "and defaults that follow the node-ID"
)
_CONSISTENCIES = {Consistency.WORD: "each word", Consistency.WHOLE: "the whole module"}
_UNPRINTED = {
    Origin.ASSUMED: "Assumed",
    Origin.DERIVED: "Derived from what is printed",
    Origin.STANDARD: "From a standard",
    Origin.PUBLIC: "From another public document",
}
"""Captions in the order of the tables: what a reader should doubt most comes first."""
_NUMBER_BITS = 32
_WORD = re.compile(r"[A-Za-z0-9]+")


@dataclass(frozen=True, slots=True, kw_only=True)
class FileSection:
    """The files of one bus: ``sources`` are tables of facts that the manual does not print, by their origin.

    ``guide`` is the chapter of the import guide, ``example`` the file that it names.  ``commands`` write files for
    one node each.
    """

    id: str
    title: str
    lead: str
    files: Table
    facts: tuple[Fact, ...]
    contents: tuple[Table, ...]
    assumed: tuple[Prose, ...]
    sources: tuple[Table, ...]
    corrected: Table
    guide: str
    example: str
    commands: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class _Line:
    """A fact of a GSD file as a row says it."""

    name: str
    value: str
    source: Source


def file_sections(links: Links) -> tuple[FileSection, ...]:
    """Sections for the files of the device.

    Raises:
        EmitError: The files cannot be written.
    """
    dictionaries = object_dictionaries(links.device)
    sections = [_canopen(links, dictionaries)] if dictionaries else []
    if links.device.gsd:
        sections.append(_profibus(links, links.device.gsd))
    return tuple(sections)


def _eds_path(dictionary: ObjectDictionary) -> str:
    return path_of(f"eds/{eds.file_name(dictionary)}")


def _xdd_path(dictionary: ObjectDictionary) -> str:
    return path_of(f"xdd/{xdd.file_name(dictionary)}")


def _gsd_path(name: str) -> str:
    return path_of(f"gsd/{name}")


def _download(path: str) -> Prose:
    return (Piece(path.rpartition("/")[2], path),)


# CANopen


def _canopen(links: Links, dictionaries: Sequence[ObjectDictionary]) -> FileSection:
    return FileSection(
        id="canopen",
        title="EDS and XDD for CANopen masters",
        lead="EDS and XDD of one row say the same; take the row of the slot and of the base drive."
        if len(dictionaries) > 1
        else "EDS and XDD say the same.",
        files=Table("files", _FILES_EDS, tuple(map(_file_row, dictionaries))),
        facts=tuple(_canopen_facts(dictionaries[0])),
        contents=(Table("contents", _CONTENTS_EDS, tuple(map(_contents_row, dictionaries)), _COUNTED),),
        assumed=tuple(links.prose(sentence) for sentence in _statements(dictionaries)),
        sources=(),
        corrected=_corrected(links, _figures(dictionaries)),
        guide="eds",
        example=eds.file_name(dictionaries[0]),
        commands=tuple(map(_command, dictionaries)),
    )


def _file_row(dictionary: ObjectDictionary) -> Row:
    product = dictionary.product
    numbers = (
        ("VendorNumber", product.vendor_number),
        ("ProductNumber", product.product_number),
        ("RevisionNumber", product.revision_number),
    )
    identity = (noted(hexadecimal(n, _NUMBER_BITS), "assumed" if key in product.unknown else "") for key, n in numbers)
    return Row(
        (label_of(dictionary), _download(_eds_path(dictionary)), _download(_xdd_path(dictionary)), *identity),
    )


def _contents_row(dictionary: ObjectDictionary) -> Row:
    entries = [entry for found in dictionary.objects for entry in found.entries]
    counts = (
        *(len(objects) for _, objects in eds.lists(dictionary)),
        len(dictionary.of_standard(RPDO_PARAMETERS)),
        len(dictionary.of_standard(TPDO_PARAMETERS)),
        len(entries),
        sum(entry.mappable for entry in entries),
        sum(map(_follows_node, entries)),
    )
    return Row((label_of(dictionary), *map(str, counts)))


def _follows_node(entry: Entry) -> bool:
    return isinstance(entry.default, NodeRelative)


def _canopen_facts(dictionary: ObjectDictionary) -> Iterator[Fact]:
    yield Fact("Vendor", dictionary.device.manufacturer)
    yield Fact("Order code", dictionary.device.order_code)
    yield Fact("Bit rates", f"{', '.join(map(str, dictionary.facts.baud_rates))} kbit/s")
    yield Fact("PDO granularity", f"{dictionary.facts.granularity} bit")


def _statements(dictionaries: Sequence[ObjectDictionary]) -> Iterator[str]:
    """What is assumed and left out; what not all files say, with those that say it."""
    said: dict[str, list[str]] = {}
    for dictionary in dictionaries:
        for sentence in (*eds.assumed(dictionary), *eds.left_out(dictionary)):
            said.setdefault(sentence, []).append(label_of(dictionary))
    for sentence, labels in said.items():
        yield sentence if len(labels) == len(dictionaries) else f"{'; '.join(labels)}: {sentence}"


def _figures(dictionaries: Iterable[ObjectDictionary]) -> dict[str, tuple[Erratum, list[str]]]:
    """Errata that change a figure of a file, and what each concerns in all files."""
    found: dict[str, tuple[Erratum, list[str]]] = {}
    for dictionary in dictionaries:
        for erratum, concerned in eds.corrected(dictionary):
            _, places = found.setdefault(erratum.id, (erratum, []))
            if concerned not in places:
                places.append(concerned)
    return found


def _command(dictionary: ObjectDictionary) -> str:
    options = [f"--device {dictionary.device.id}"]
    if dictionary.slot:
        options.append(f"--slot {dictionary.slot}")
    if dictionary.product.label:
        options.append(f"--product {'_'.join(_WORD.findall(dictionary.product.label))}")
    return f"python -m generator dcf {' '.join(options)} --node NODE --baud RATE"


# PROFIBUS


def _profibus(links: Links, facts: Gsd) -> FileSection:
    names = gsd.file_names(facts)
    languages = {language for _, language in names}
    return FileSection(
        id="profibus",
        title="GSD for PROFIBUS masters",
        lead="The files differ in the language of their texts alone." if len(languages) > 1 else "",
        files=Table(
            "files",
            _FILES_GSD,
            tuple(Row((_download(_gsd_path(name)), language_of(language))) for name, language in names),
        ),
        facts=tuple(_profibus_facts(links, facts)),
        contents=tuple(
            table for table in (_printed(links, facts), _modules(links, facts), _diagnosis(links, facts)) if table.rows
        ),
        assumed=(),
        sources=tuple(_unprinted(links, facts)),
        corrected=_corrected(links, _concerned(links.device, facts)),
        guide="gsd",
        example=names[0][0],
    )


def _profibus_facts(links: Links, facts: Gsd) -> Iterator[Fact]:
    shown = {keyword.name: gsd.value_text(keyword, "en").strip('"') for keyword in facts.keywords}
    for label, name in (
        ("Vendor", "Vendor_Name"),
        ("Model", "Model_Name"),
        ("Ident number", "Ident_Number"),
        ("Order number", "OrderNumber"),
        ("Hardware", "Hardware_Release"),
        ("Software", "Software_Release"),
    ):
        if name in shown:
            yield Fact(label, shown[name])
    yield Fact("Keywords", str(len(facts.keywords)))
    rates = ", ".join(rate.name for rate in facts.bit_rates)
    yield Fact("Bit rates", joined([rates, links.source(facts.bit_rates_cite)], "; "))
    yield Fact("Modules", str(len(facts.modules)))
    if facts.diagnosis:
        yield Fact("Diagnosis texts", str(sum(len(area.texts) for area in facts.diagnosis.areas)))


def _modules(links: Links, facts: Gsd) -> Table:
    families: dict[str, list[Module]] = {}
    for module in facts.modules:
        families.setdefault(module.family, []).append(module)
    rows = tuple(_family_row(links, family) for family in families.values())
    return Table("kinds", _MODULES, rows, "Modules by kind")


def _family_row(links: Links, modules: Sequence[Module]) -> Row:
    first = modules[0]
    lengths = sorted(module.length for module in modules)
    return Row(
        (
            through(first.name.english, modules[-1].name.english),
            str(len(modules)),
            through(str(lengths[0]), str(lengths[-1])),
            _CONSISTENCIES[first.consistency],
            links.prose(first.source.note) or NONE,
            _source(links, first.source),
        )
    )


def _diagnosis(links: Links, facts: Gsd) -> Table:
    areas = facts.diagnosis.areas if facts.diagnosis else ()
    rows = (
        Row(
            (
                noted(through(str(area.first), str(area.last)), area.id),
                str(len(area.texts)),
                links.prose(area.source.note) or NONE,
                _source(links, area.source),
            )
        )
        for area in areas
    )
    return Table("diagnosis", _DIAGNOSIS, tuple(rows), "Texts for the status block of the diagnosis")


def _lines(facts: Gsd) -> Iterator[_Line]:
    """Everything that a GSD file says by a keyword of the station."""
    for keyword in facts.keywords:
        yield _Line(keyword.name, gsd.value_text(keyword, "en"), keyword.source)
    if facts.bit_rates:
        ends = facts.bit_rates[0].name, facts.bit_rates[-1].name
        times = ", ".join(str(rate.max_tsdr) for rate in facts.bit_rates)
        yield _Line(through(*(f"MaxTsdr_{name}" for name in ends)), times, facts.max_tsdr)
    data = ",".join(f"0x{byte:02X}" for byte in facts.parameters)
    yield _Line("Ext_User_Prm_Data_Const(0)", data, facts.parameters_source)


def _printed(links: Links, facts: Gsd) -> Table:
    return _origin_table(links, facts, Origin.MANUAL, "Keywords that the manual gives")


def _unprinted(links: Links, facts: Gsd) -> Iterator[Table]:
    """One table for each origin of facts other than the manual."""
    tables = (_origin_table(links, facts, origin, caption) for origin, caption in _UNPRINTED.items())
    return (table for table in tables if table.rows)


def _origin_table(links: Links, facts: Gsd, origin: Origin, caption: str) -> Table:
    rows = tuple(_line_row(links, line) for line in _lines(facts) if line.source.origin is origin)
    return Table(origin.value, _ORIGIN, rows, caption)


def _line_row(links: Links, line: _Line) -> Row:
    cite = links.source(line.source.cite) if line.source.cite else NONE
    return Row((line.name, line.value, links.prose(line.source.note) or NONE, cite))


def _source(links: Links, source: Source) -> Prose:
    parts = [links.source(source.cite)] if source.cite else []
    mark = shown_origin(source.origin)
    if mark:
        parts.append((Piece(mark, tag="em"),))
    return joined(parts, " ")


def _concerned(device: Device, facts: Gsd) -> dict[str, tuple[Erratum, list[str]]]:
    """Errata of everything in the file, and what each concerns."""
    sources = [(line.name, line.source) for line in _lines(facts)]
    sources += [(f"modules {module.family}", module.source) for module in facts.modules]
    if facts.diagnosis:
        sources += [(f"diagnosis texts {area.id}", area.source) for area in facts.diagnosis.areas]
    known = {erratum.id: erratum for erratum in device.errata}
    found: dict[str, tuple[Erratum, list[str]]] = {}
    for name, source in sources:
        for erratum in source.errata:
            _, places = found.setdefault(erratum, (known[erratum], []))
            if name not in places:
                places.append(name)
    return found


# Both


def _corrected(links: Links, found: dict[str, tuple[Erratum, list[str]]]) -> Table:
    rows = (
        Row((_erratum(links, erratum), links.prose("; ".join(places)), eds.printed(erratum), erratum.used_text))
        for erratum, places in found.values()
    )
    return Table("corrected", _CORRECTED, tuple(rows))


def _erratum(links: Links, erratum: Erratum) -> Prose:
    link = links.erratum(erratum.id)
    return (link, " ", Piece("slip of the text dump alone", tag="small")) if is_slip(erratum) else (link,)
