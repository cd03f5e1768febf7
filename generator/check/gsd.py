"""GSD files: what the format demands of texts, lengths, modules and the texts of the diagnosis."""

import re
from collections.abc import Collection, Iterator
from itertools import combinations

from generator.check.finding import Finding
from generator.model import Device, Drive, Gsd, Model, Where
from generator.model.gsd import DiagnosisArea, Wording

_TEXT = re.compile(r"[ !#-&(-:<-?A-Z\[\]^_a-}]+")
"""Printable ASCII without what a reader known takes for syntax: quotes, ; @ ` ~ and the backslash."""
_LONGEST_TEXT = 32
_LONGEST_INFO = 256
_FAMILY = "Slave_Family"
_WIDEST_AREA = 16
_DIAGNOSIS_HINT = "correct the bits of the area or the values of its texts"


def identity(model: Model, device: Device) -> Iterator[Finding]:
    """Rule gsd-ident: the file is named after the ident number."""
    if device.gsd is None:
        return
    number = f"{device.gsd.number('Ident_Number'):04X}"
    if device.gsd.stem[-4:] != number:
        yield _finding(
            "gsd-ident",
            device,
            device.gsd.where,
            "file",
            device.gsd.stem,
            device.gsd.stem[:-4] + number,
            "the last four characters of the file name are not the ident number",
            "correct 'stem' or 'Ident_Number'",
        )


def texts(model: Model, device: Device) -> Iterator[Finding]:
    """Rule gsd-text: visible strings have the characters and the length that the format allows."""
    for place, wording, longest, where in _texts(device.gsd) if device.gsd else ():
        for text in dict.fromkeys((wording.english, wording.german)):
            if not _TEXT.fullmatch(text):
                yield _finding(
                    "gsd-text",
                    device,
                    where,
                    place,
                    text,
                    "plain ASCII",
                    "a visible string has characters that readers of GSD files refuse",
                    "write ae, oe, ue and ss; leave out quotes and ; @ ` ~ \\",
                )
            elif len(text) > longest:
                yield _finding(
                    "gsd-text",
                    device,
                    where,
                    place,
                    f"{text} ({len(text)} characters)",
                    f"at most {longest}",
                    "a visible string is longer than the format allows",
                    "shorten it; what the manual prints can stand in 'info'",
                )


def _texts(gsd: Gsd) -> Iterator[tuple[str, Wording, int, Where]]:
    """Visible strings with their place and their greatest length; of modules that differ in length the longest."""
    for keyword in gsd.keywords:
        if isinstance(keyword.value, Wording) and keyword.name != _FAMILY:
            longest = _LONGEST_INFO if keyword.name == "Info_Text" else _LONGEST_TEXT
            yield f"keyword {keyword.name}", keyword.value, longest, keyword.source.where
    for module in {module.family: module for module in gsd.modules}.values():
        yield f"module {module.family}", module.name, _LONGEST_TEXT, module.source.where
        if module.info:
            yield f"module {module.family} info", module.info, _LONGEST_INFO, module.source.where
    for area in gsd.diagnosis.areas if gsd.diagnosis else ():
        for value, wording in area.texts:
            yield f"diagnosis {area.id} {value}", wording, _LONGEST_TEXT, area.source.where


def lengths(model: Model, device: Device) -> Iterator[Finding]:
    """Rule gsd-length: modules, user parameters and diagnosis keep to the lengths that the keywords give."""
    for place, found, limit, where in _lengths(device.gsd) if device.gsd else ():
        if found > limit:
            yield _finding(
                "gsd-length",
                device,
                where,
                place,
                f"{found} bytes",
                f"at most {limit}",
                "a length lies outside of what the file itself allows",
                "correct the keyword that sets the limit, or what exceeds it",
            )
    gsd = device.gsd
    if gsd and gsd.number("DPV1_Slave") and len(gsd.parameters) < gsd.telegrams.dpv1_parameters:
        yield _finding(
            "gsd-length",
            device,
            gsd.parameters_source.where,
            "user parameters",
            f"{len(gsd.parameters)} bytes",
            f"at least {gsd.telegrams.dpv1_parameters}",
            "a slave with DP-V1 has its status bytes in front of the user parameters",
            "begin 'bytes' with the status bytes",
        )


def _lengths(gsd: Gsd) -> Iterator[tuple[str, int, int, Where]]:
    """Lengths in bytes with their place and limit; of modules that differ in length the longest."""
    limits = dict(gsd.telegrams.lengths)
    for keyword in gsd.keywords:
        if keyword.name in limits and isinstance(keyword.value, int):
            yield f"keyword {keyword.name}", keyword.value, limits[keyword.name], keyword.source.where
    directions = gsd.number("Max_Input_Len"), gsd.number("Max_Output_Len")
    for module in {module.family: module for module in gsd.modules}.values():
        place, where = f"module {module.family}", module.source.where
        yield place, module.length, min(directions), where
        yield f"{place} words", 2 * module.words, gsd.telegrams.identifier, where
        yield f"{place} both ways", 2 * module.length, gsd.number("Max_Data_Len"), where
    yield (
        "user parameters",
        len(gsd.parameters),
        gsd.number("Max_User_Prm_Data_Len"),
        gsd.parameters_source.where,
    )
    for area in gsd.diagnosis.areas if gsd.diagnosis else ():
        end = gsd.telegrams.status_type + area.last // 8 + 1
        yield f"diagnosis {area.id}", end, gsd.number("Max_Diag_Data_Len"), area.source.where


def modules(model: Model, device: Device) -> Iterator[Finding]:
    """Rule gsd-module: names, in upper and lower case alike, and references stand for one module each."""
    seen: dict[tuple[str, str], str] = {}
    for module in device.gsd.modules if device.gsd else ():
        title = f"{module.family} {module.words}"
        labels = (
            ("reference", str(module.reference)),
            ("English name", module.name.english.lower()),
            ("German name", module.name.german.lower()),
        )
        for label in labels:
            first = seen.setdefault(label, title)
            if first != title:
                yield _finding(
                    "gsd-module",
                    device,
                    module.source.where,
                    f"module {title}",
                    f"{label[0]} '{label[1]}'",
                    f"another than that of {first}",
                    "two modules share a name or a reference",
                    "masters find modules by both: make them distinct",
                )


def diagnosis(model: Model, device: Device) -> Iterator[Finding]:
    """Rule gsd-diagnosis: areas have bits of their own, values fit them and are those of the facts behind them."""
    areas = device.gsd.diagnosis.areas if device.gsd and device.gsd.diagnosis else ()
    for a, b in combinations(areas, 2):
        if a.first <= b.last and b.first <= a.last:
            yield _area_finding(
                device, b, f"{b.first} ... {b.last}", f"bits that {a.id} does not have", "areas overlap"
            )
    for area in areas:
        width = area.last - area.first + 1
        if not 0 < width <= _WIDEST_AREA:
            yield _area_finding(
                device, area, f"{width} bits", f"1 ... {_WIDEST_AREA}", "an area has no or too many bits"
            )
        elif len(dict(area.texts)) < len(area.texts):
            yield _area_finding(device, area, "one value twice", "each value once", "a value has two texts")
        elif wide := [value for value, _ in area.texts if value >= 1 << width]:
            yield _area_finding(
                device, area, _values(wide), f"{width} bits", "values do not fit the bits of their area"
            )
        elif area.field is not None and device.drive is not None:
            said, known = {value for value, _ in area.texts}, _known(area.field, device, device.drive)
            if said != known:
                yield _area_finding(
                    device,
                    area,
                    _values(said - known) or "none",
                    _values(known - said) or "none",
                    f"the values with a text are not those of the field '{area.field}', without 0",
                )


def _known(field: str, device: Device, drive: Drive) -> set[int]:
    """Values other than 0 that a field of the error number can have."""
    if field == "response":
        values = {response.value for response in drive.responses}
    elif field == "module":
        values = {module.value for module in drive.modules}
    else:
        bits = dict(drive.error_fields)[field]
        mask = (1 << bits.high + 1) - 1
        numbers = (n for e in device.errors if e.kind == "device" for n in range(e.number, e.last + 1))
        values = {(number & mask) >> bits.low for number in numbers}
    return values - {0}


def _values(values: Collection[int]) -> str:
    return ", ".join(f"0x{value:X}" for value in sorted(values))


def _area_finding(device: Device, area: DiagnosisArea, printed: str, expected: str, message: str) -> Finding:
    return _finding(
        "gsd-diagnosis", device, area.source.where, f"diagnosis {area.id}", printed, expected, message, _DIAGNOSIS_HINT
    )


def _finding(
    rule: str, device: Device, where: Where, place: str, printed: str, expected: str, message: str, hint: str = ""
) -> Finding:
    return Finding(
        rule=rule,
        subject=f"device:{device.id}",
        place=place,
        printed=printed,
        expected=expected,
        message=message,
        where=where,
        hint=hint,
    )
