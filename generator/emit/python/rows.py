"""Rows of literals, in the order in which ``catalogue.py.j2`` reads them."""

from collections.abc import Iterable
from fractions import Fraction

from generator.emit.python.enums import Enums, code_fact, subcode_fact, subindex_fact
from generator.emit.python.text import Literal, fill, index_text
from generator.emit.python.views import RowView, TableView
from generator.model import (
    BitField,
    Cite,
    Code,
    Default,
    Device,
    DictionaryObject,
    Drive,
    Erratum,
    ErrorEntry,
    NodeRelative,
    Range,
    SubCode,
    SubIndex,
)

Numbered = tuple[int, str, tuple[Literal, ...]]
"""Number and name of a subcode or sub-index, and the rest of its row."""

Run = tuple[int, int, str, tuple[Literal, ...]]
"""The same for a run: first and last number, the name with "{n}" for the number, and the common rest."""


def dict_table(name: str, key: str, rows: Iterable[RowView]) -> TableView:
    """A table by keys."""
    return TableView(name, f"dict[{key}, tuple[object, ...]]", "{", tuple(rows), "}")


def tuple_table(name: str, rows: Iterable[RowView]) -> TableView:
    """A table without keys."""
    return TableView(name, "tuple[tuple[object, ...], ...]", "(", tuple(rows), ")")


def code_row(code: Code, enums: Enums) -> RowView:
    """Row of a code."""
    fact = code_fact(code)
    row = (
        code.name,
        code.slot,
        code.twin_of,
        code.index,
        code.type_name,
        code.data_type.canopen_name,
        code.length,
        (code.access.read, code.access.write, code.access.conditions),
        code.scaling,
        _range_row(code.range),
        _default_row(code.default),
        cite_row(code.default_cite),
        enums.selection(fact, code.options),
        enums.flags(fact, code.bits),
        _field_rows(code.fields),
        runs(_subcode_row(code, sub, enums) for sub in code.subcodes),
        tuple((ref.index, ref.subindex) for ref in code.objects),
        code.since,
        code.internal,
        code.description,
        code.shared_by,
        code.origin.value,
        cite_row(code.cite),
        code.errata,
    )
    return RowView(f"{code.number}: ", fill(row))


def _subcode_row(code: Code, sub: SubCode, enums: Enums) -> Numbered:
    own = enums.selection(subcode_fact(code, sub), sub.options) if sub.options else None
    return sub.number, sub.name, (_default_row(sub.default), _follows_row(sub.follows), own, sub.description)


def object_row(entry: DictionaryObject, enums: Enums) -> RowView:
    """Row of an object."""
    row = (
        entry.kind,
        entry.name,
        entry.object_type,
        runs(_subindex_row(entry, sub, enums) for sub in entry.subindexes),
        entry.description,
        entry.origin.value,
        cite_row(entry.cite),
        entry.errata,
    )
    return RowView(f"{index_text(entry)}: ", fill(row))


def _subindex_row(entry: DictionaryObject, sub: SubIndex, enums: Enums) -> Numbered:
    fact = subindex_fact(entry, sub)
    row = (
        sub.data_type.canopen_name,
        sub.access,
        sub.printed_type.canopen_name,
        sub.printed_access,
        _default_row(sub.default),
        _range_row(sub.range),
        enums.selection(fact, sub.options),
        enums.flags(fact, sub.bits),
        _field_rows(sub.fields),
        tuple((ref.number, ref.subcode) for ref in sub.codes),
        sub.signature,
        sub.pdo_mapping,
        sub.unused,
        sub.abort,
        sub.description,
        sub.errata,
    )
    return sub.number, sub.name, row


def error_row(error: ErrorEntry) -> RowView:
    """Row of an error number."""
    row = (
        error.kind,
        error.number,
        error.last,
        error.slot,
        error.name,
        error.response,
        error.responses,
        tuple((ref.number, ref.subcode) for ref in error.adjustable_in),
        error.register,
        error.causes,
        error.remedies,
        error.description,
        error.origin.value,
        cite_row(error.cite),
        error.errata,
    )
    return RowView("", fill(row))


def erratum_row(erratum: Erratum) -> RowView:
    """Row of an entry of the ledger."""
    row = (
        erratum.id,
        erratum.kind,
        erratum.about_text,
        erratum.place,
        erratum.printed_text,
        erratum.used_text,
        tuple((place.location, place.page, place.manual, place.printed) for place in erratum.places),
        erratum.why,
        erratum.confidence,
        erratum.origin,
    )
    return RowView("", fill(row))


def device_row(device: Device) -> tuple[Literal, ...]:
    """Row of the device itself."""
    manual, drive, canopen = device.manual, device.drive, device.canopen
    return (
        device.title,
        device.manufacturer,
        device.order_code,
        device.bus,
        device.hardware_version,
        device.software_version,
        (
            manual.id,
            manual.title,
            manual.publisher,
            manual.edition,
            manual.date,
            manual.document,
            manual.kind,
            manual.url,
            manual.pages,
        ),
        cite_row(device.cite),
        None if drive is None else _drive_row(drive),
        tuple((s.name, s.first_code, s.last_code, s.code_offset, s.error_offset) for s in device.slots),
        None
        if canopen is None
        else (
            canopen.baud_rates,
            canopen.granularity,
            canopen.node_address,
            canopen.boot_up_master,
            cite_row(canopen.cite),
        ),
    )


def _drive_row(drive: Drive) -> Literal:
    fields = tuple((field.low, field.high, name) for name, field in drive.error_fields)
    return (drive.id, drive.title, drive.manufacturer, drive.index_base, fields)


def runs(entries: Iterable[Numbered]) -> tuple[Run, ...]:
    """Rows of numbered entries; neighbours that differ by the number in their name alone share a row.

    >>> runs([(1, "Mask 1", (0,)), (2, "Mask 2", (0,)), (3, "Mask 3", (5,))])
    ((1, 2, 'Mask {n}', (0,)), (3, 3, 'Mask 3', (5,)))
    """
    rows: list[Run] = []
    for number, name, rest in entries:
        longer = _extended(rows[-1], number, name, rest) if rows else None
        if longer is None:
            rows.append((number, number, name, rest))
        else:
            rows[-1] = longer
    return tuple(rows)


def _extended(row: Run, number: int, name: str, rest: tuple[Literal, ...]) -> Run | None:
    """``row`` with one more entry, ``None`` where that does not fit to it."""
    first, last, text, common = row
    template = text if last > first else name.replace(str(number), "{n}")
    fits_before = last > first or template.replace("{n}", str(last)) == text
    fits = number == last + 1 and rest == common and template.replace("{n}", str(number)) == name
    return (first, number, template, rest) if fits and fits_before else None


def _bound_row(bound: Fraction) -> Literal:
    return bound.numerator if bound.denominator == 1 else (bound.numerator, bound.denominator)


def _range_row(limits: Range | None) -> Literal:
    return None if limits is None else (_bound_row(limits.low), _bound_row(limits.high), limits.unit)


def _default_row(default: Default | None) -> Literal:
    return (default.base,) if isinstance(default, NodeRelative) else default


def _follows_row(rule: NodeRelative | None) -> Literal:
    return None if rule is None else rule.base


def cite_row(cite: Cite | None) -> Literal:
    """A citation."""
    return None if cite is None else (cite.manual, cite.chapter, cite.page)


def _field_rows(fields: Iterable[BitField]) -> Literal:
    return tuple((field.low, field.high, field.label) for field in fields)
