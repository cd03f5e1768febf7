"""What the documentation comments say of a fact; markup in texts of the spec is escaped."""

import re
from collections.abc import Iterable, Sequence
from decimal import Decimal
from fractions import Fraction

from generator.emit.rust.syntax import markdown, string
from generator.model import (
    Access,
    Cite,
    Code,
    CodeRef,
    Default,
    Device,
    DictionaryObject,
    Erratum,
    ErrorEntry,
    Layout,
    NodeRelative,
    Option,
    Origin,
    Range,
    SubCode,
    SubIndex,
)

_NUMBER = re.compile(r"(?<![\w.])[0-9]+(?![\w.])")
_ORIGINS = {
    Origin.MANUAL: "",
    Origin.STANDARD: ", from the standard",
    Origin.DERIVED: ", derived",
    Origin.ASSUMED: ", assumed",
    Origin.PUBLIC: ", public document",
}


def headline(*parts: str) -> str:
    """Label as the first sentence of a comment."""
    return f"{markdown(' '.join(parts)).removesuffix('.')}."


def source(cite: Cite, origin: Origin = Origin.MANUAL) -> str:
    """Provenance of a fact."""
    return f"Source: {_cite(cite)}{_ORIGINS[origin]}"


def device_points(device: Device, manual: str) -> list[str]:
    """What the head of the module of a device says; ``manual`` is markup already."""
    return [
        f"Manufacturer: {markdown(device.manufacturer)}, order code {markdown(device.order_code)}",
        f"Bus: {markdown(device.bus)}",
        f"Hardware from {markdown(device.hardware_version)}" if device.hardware_version else "",
        f"Software from {markdown(device.software_version)}" if device.software_version else "",
        f"Manual: {manual}",
        source(device.cite),
    ]


def code_points(code: Code, digits: int, links: str, subcodes: Iterable[str], errata: Iterable[Erratum]) -> list[str]:
    """What the comment of a code lists; ``subcodes`` are the points of its subcodes."""
    setting = _default(code.default, code.options, code, digits)
    place = f" ({_cite(code.default_cite)})" if code.default_cite else ""
    return [
        ", ".join(
            filter(None, (f"Index 0x{code.index:04X} ({code.index}), type {code.type_name}", _access(code.access)))
        ),
        f"Range: {_range(code.range, digits)}" if code.range else "",
        f"Scaling factor: {code.scaling}" if code.scaling not in (None, 1) else "",
        f"Length: up to {code.length} bytes" if code.length is not None else "",
        f"Default: {setting}{place}" if setting else "",
        f"{links[:1].upper()}{links[1:]}",
        *subcodes,
        f"Mirrors {', '.join(map(str, code.objects))}" if code.objects else "",
        f"Exists from software {markdown(code.since)}" if code.since else "",
        "Internal to the device, not to be changed" if code.internal else "",
        source(code.cite, code.origin),
        *map(_erratum, errata),
    ]


def runs(label: str, points: Iterable[tuple[int, str]]) -> list[str]:
    """Points of numbered parts; parts that follow each other and differ in their number alone share one, with *n*.

    >>> runs("Subcode", [(1, "mask 1; default 0"), (2, "mask 2; default 0"), (3, "unused")])
    ['Subcodes 1 ... 2: mask *n*; default 0', 'Subcode 3: unused']
    """
    texts = dict(points)
    joined: list[str] = []
    first = pattern = None
    for number, text in texts.items():
        own = _numbered(text, str(number))
        if first is None or pattern != own or number - 1 not in texts:
            first, pattern = number, own
            joined.append(_point(f"{label} {number}", text))
        else:
            joined[-1] = _point(f"{_plural(label)} {first} ... {number}", own)
    return joined


def _point(head: str, text: str) -> str:
    return f"{head}: {text}" if text else head


def _numbered(text: str, number: str) -> str:
    return _NUMBER.sub(lambda found: "*n*" if found[0] == number else found[0], text) if number in text else text


def _plural(label: str) -> str:
    return f"{label}es" if label.endswith("x") else f"{label}s"


def subcode_point(code: Code, sub: SubCode, digits: int, links: str) -> str:
    """What the comment of a code says of a subcode."""
    setting = _default(sub.default, sub.options or code.options, code, digits)
    rule = f", follows {_relative(sub.follows)}" if sub.follows else ""
    parts = [markdown(sub.name), f"default {setting}{rule}" if setting else "", markdown(sub.description), links]
    return _joined(parts)


def object_points(entry: DictionaryObject, subindexes: Iterable[str], errata: Iterable[Erratum]) -> list[str]:
    """What the comment of an object lists; ``subindexes`` are the points of its sub-indexes."""
    return [*subindexes, source(entry.cite, entry.origin), *map(_erratum, errata)]


def subindex_point(sub: SubIndex, links: str) -> str:
    """What the comment of an object says of a sub-index."""
    used = f"{sub.data_type.canopen_name} {sub.access}"
    printed = f"{sub.printed_type.canopen_name} {sub.printed_access}"
    setting = _default(sub.default, sub.options, None, 0)
    parts = [
        markdown(sub.name),
        used if used == printed else f"{used} (printed: {printed})",
        f"range {_range(sub.range, 0)}" if sub.range else "",
        f"default {setting}" if setting else "",
        f"write {markdown(string(sub.signature))}" if sub.signature else "",
        f"mirrored by {', '.join(map(str, sub.codes))}" if sub.codes else "",
        "without function" if sub.unused else "",
        f"any access returns abort code 0x{sub.abort:08X}" if sub.abort is not None else "",
        markdown(sub.description),
        links,
    ]
    return _joined(parts)


def error_points(error: ErrorEntry, digits: int, errata: Iterable[Erratum]) -> list[str]:
    """What the comment of an error number lists."""
    run = f" ... 0x{error.last:0{digits}X}" if error.count > 1 else ""
    return [
        f"Number 0x{error.number:0{digits}X}{run}",
        f"Response: {markdown(error.response)}" if error.response else "",
        f"Responses to choose from: {markdown(', '.join(error.responses))}" if error.responses else "",
        f"Response set in {_code_refs(error.adjustable_in)}" if error.adjustable_in else "",
        f"Error register: {markdown(error.register)}" if error.register else "",
        *(f"Cause: {markdown(text)}" for text in error.causes),
        *(f"Remedy: {markdown(text)}" for text in error.remedies),
        source(error.cite, error.origin),
        *map(_erratum, errata),
    ]


def layout_points(layout: Layout, cases: Sequence[str], errata: Iterable[Erratum]) -> list[str]:
    """What the comment of a telegram lists; ``cases`` are the layouts, as markup, whose bytes it decodes as well."""
    return [
        f"Protocol: {markdown(layout.protocol)}",
        f"Decodes these as well, which are to be tried first: {', '.join(cases)}" if cases else "",
        source(layout.cite, layout.origin),
        *map(_erratum, errata),
    ]


def _joined(parts: Sequence[str]) -> str:
    return "; ".join(part.removesuffix(".") for part in parts if part)


def _cite(cite: Cite) -> str:
    return markdown(str(cite))


def _code_refs(refs: Sequence[CodeRef]) -> str:
    """References, subcodes that follow each other as a run: C13613/1 ... 32."""
    spans: list[tuple[CodeRef, CodeRef]] = []
    for ref in refs:
        if spans and ref.subcode and spans[-1][1] == CodeRef(ref.number, ref.subcode - 1):
            spans[-1] = (spans[-1][0], ref)
        else:
            spans.append((ref, ref))
    return ", ".join(str(first) if first == last else f"{first} ... {last.subcode}" for first, last in spans)


def _access(access: Access) -> str:
    rights = [word for word, granted in (("read", access.read), ("write", access.write)) if granted]
    return " and ".join(rights) + "".join(f", {markdown(condition)}" for condition in access.conditions)


def _number(value: int, digits: int) -> str:
    return f"0x{value:0{digits}X}" if digits and value >= 0 else str(value)


def _decimal(value: Fraction) -> str:
    quotient = Decimal(value.numerator) / Decimal(value.denominator)
    return f"{quotient:f}" if Fraction(quotient) == value else str(value)


def _range(value: Range, digits: int) -> str:
    low, high = (
        _number(bound.numerator, digits) if bound.denominator == 1 else _decimal(bound)
        for bound in (value.low, value.high)
    )
    return f"{low} ... {high} {markdown(value.unit)}".rstrip()


def _relative(rule: NodeRelative) -> str:
    return f"0x{rule.base:X} + node address"


def _default(value: Default | None, options: Sequence[Option], code: Code | None, digits: int) -> str:
    match value:
        case None:
            return ""
        case str():
            return markdown(string(value))
        case NodeRelative():
            return _relative(value)
        case int():
            return _setting(value, options, code, digits)


def _setting(value: int, options: Sequence[Option], code: Code | None, digits: int) -> str:
    number = _number(value, digits)
    label = next((option.label for option in options if option.value == value), None)
    if label is not None:
        return f"{number} ({markdown(label)})"
    if code is None or code.range is None or digits:
        return number
    physical = f"{_decimal(Fraction(value, code.scaling or 1))} {markdown(code.range.unit)}".rstrip()
    return physical if code.scaling in (None, 1) else f"{physical} ({number} on the wire)"


def _erratum(erratum: Erratum) -> str:
    places = "; ".join(f"{place.location}: {place.printed}" for place in erratum.places)
    printed = markdown(erratum.printed_text or places)
    return f"Erratum `{erratum.id}`: printed {printed}, used {markdown(erratum.used_text)}"
