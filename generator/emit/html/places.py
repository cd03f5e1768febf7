"""Anchors, which are made of numbers and outlive names, and the page on which each of them stands."""

import re
from collections.abc import Hashable, Iterable, Iterator
from typing import TypeVar

from generator.model import Code, Device, DictionaryObject, ErrorEntry, SwitchGroup, SwitchRow

T = TypeVar("T")

COMMANDS = "drive-commands"
"""Anchor of the list of device commands."""

ERROR_KINDS = {
    "device": ("Device error", "Device errors"),
    "emergency": ("Emergency code", "Emergency codes"),
    "sdo_abort": ("SDO abort code", "SDO abort codes"),
    "dpv0": ("DP-V0 diagnosis", "PROFIBUS DP-V0 diagnosis"),
    "dpv1": ("DP-V1 error", "PROFIBUS DP-V1 errors"),
    "gci": ("GCI error", "GCI errors"),
}
"""Kinds of errors, singular and plural."""
_ERROR_PREFIXES = {"device": "e", "emergency": "emcy", "sdo_abort": "abort"}
_ERROR_DIGITS = {"emergency": 4, "dpv1": 4, "gci": 4}
_LONG_DIGITS = 8
_NAMED = {
    "led": "leds",
    "switch": "switches",
    "table": "tables",
    "formula": "tables",
    "layout": "telegrams",
    "telegram": "telegrams",
    "service": "telegrams",
    "erratum": "errata",
    "drive": "drive",
}
"""Part of the reference that holds the things of a kind, by the first word of their anchors."""


def code_id(number: int, subcode: int | None = None) -> str:
    """Anchor of a code or subcode: ``c13350``, ``c13350-3``."""
    return f"c{number:05d}" + (f"-{subcode}" if subcode is not None else "")


def object_id(entry: DictionaryObject, subindex: int | None = None) -> str:
    """Anchor of an object or sub-index: ``i-1018``, ``i-1018-2``, ``pnu-918``."""
    name = f"i-{entry.index:04x}" if entry.kind == "canopen" else f"pnu-{entry.index}"
    return name + (f"-{subindex}" if subindex is not None else "")


def error_text(kind: str, number: int) -> str:
    """Error number as its list writes it, with the digits of its kind: ``0x009d0000``, ``0x8130``."""
    return f"0x{number:0{_ERROR_DIGITS.get(kind, _LONG_DIGITS)}x}"


def error_id(kind: str, number: int) -> str:
    """Anchor of an error number: ``e-0x009d0000``; other kinds than the device's carry their own prefix."""
    return f"{_ERROR_PREFIXES.get(kind, kind)}-{error_text(kind, number)}"


def errors_group(kind: str) -> str:
    """Anchor of the errors of a kind among those of a device: ``errors-sdo-abort``."""
    return f"errors-{kind.replace('_', '-')}"


def erratum_id(erratum: str) -> str:
    """Anchor of an entry of the ledger."""
    return f"erratum-{erratum}"


def named_id(kind: str, name: str, part: str = "") -> str:
    """Anchor of a thing that has a name alone, and of a part of it: ``table-sub-d-pins``, ``layout-sdo.command``.

    ``kind`` is as in the ledger: "led", "switch", "table", "formula", "layout", "telegram" or "service".
    """
    return f"{kind}-{name}.{part}" if part else f"{kind}-{name}"


def switch_row_id(group: SwitchGroup, row: SwitchRow) -> str:
    """Anchor of a printed position of switches: ``switch-node-address.23``."""
    return named_id("switch", group.id, re.sub(r"[^a-z0-9]+", "-", row.value.lower()).strip("-"))


def command_id(value: int) -> str:
    """Anchor of a device command: ``drive-command-92``."""
    return f"drive-command-{value}"


def page_of(device: Device, part: str = "") -> str:
    """Page of a device, of a part of its reference ("codes", "errata") or of one entry (the anchor of it)."""
    return f"{device.id}-{part}.html" if part else f"{device.id}.html"


def code_entries(codes: Iterable[Code]) -> Iterator[tuple[Code, ...]]:
    """Codes that one entry describes: those of several slots that differ in number alone."""
    return _together((_code_content(code), code) for code in codes)


def error_entries(device: Device, errors: Iterable[ErrorEntry]) -> Iterator[tuple[ErrorEntry, ...]]:
    """Errors that one entry describes: those of several slots that differ in number alone."""
    offsets = {slot.name: slot.error_offset for slot in device.slots}
    return _together(
        ((error.slot is None, error.number - offsets.get(error.slot or "", 0), *_error_content(error)), error)
        for error in errors
    )


def _together(items: Iterable[tuple[Hashable, T]]) -> Iterator[tuple[T, ...]]:
    groups: dict[Hashable, list[T]] = {}
    for key, item in items:
        groups.setdefault(key, []).append(item)
    return map(tuple, groups.values())


def _code_content(code: Code) -> tuple[Hashable, ...]:
    """What the slots of one entry have in common; a code that differs in any of it gets an entry of its own."""
    subcodes = tuple((s.number, s.name, s.default, s.follows, s.options, s.description) for s in code.subcodes)
    return (
        code.twin_of,
        code.name,
        code.type_name,
        code.data_type,
        code.length,
        code.access,
        code.scaling,
        code.range,
        code.default,
        code.default_cite,
        code.options,
        code.bits,
        code.fields,
        subcodes,
        code.since,
        code.internal,
        code.description,
        code.shared_by,
        code.origin,
    )


def _error_content(error: ErrorEntry) -> tuple[Hashable, ...]:
    """What the slots of one entry have in common; an error that differs in any of it gets an entry of its own."""
    return (
        error.kind,
        error.count,
        error.name.replace(error.slot, "") if error.slot else error.name,
        error.response,
        error.responses,
        error.register,
        error.causes,
        error.remedies,
        error.description,
        error.origin,
    )


class Places:
    """Where the anchors of one device stand."""

    def __init__(self, device: Device) -> None:
        """Note the page of every entry."""
        self._device = device
        self._pages: dict[str, str] = {}
        for codes in code_entries(device.codes):
            self._note(code_id(code.number) for code in codes)
        for entry in device.objects:
            self._note([object_id(entry)])
        for errors in error_entries(device, device.errors):
            self._note(error_id(one.kind, number) for one in errors for number in range(one.number, one.last + 1))
        self._firsts = set(self._pages.values())

    def _note(self, anchors: Iterable[str]) -> None:
        page = ""
        for anchor in anchors:
            page = page or page_of(self._device, anchor)
            self._pages[anchor] = page

    def page(self, anchor: str) -> str:
        """Page of an anchor; that of the device itself for "device"."""
        if anchor in self._pages:
            return self._pages[anchor]
        above = anchor.rpartition("-")[0]
        if above in self._pages:
            return self._pages[above]
        return page_of(self._device, _NAMED.get(anchor.partition("-")[0], ""))

    def is_first(self, anchor: str) -> bool:
        """Whether a page is all about the anchor, so that its address needs no fragment."""
        return page_of(self._device, anchor) in self._firsts
