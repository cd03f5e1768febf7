"""View objects: every string that the templates lay out."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Head:
    """Head of the files that belong to no device."""

    lines: tuple[str, ...]
    version: str
    date: str


@dataclass(frozen=True, slots=True)
class ExportView:
    """Names of a module that the package offers."""

    module: str
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class TypeView:
    """A data type."""

    name: str
    number: str
    bits: int
    signed: bool


@dataclass(frozen=True, slots=True)
class ConstantView:
    """A constant with its documentation, line by line."""

    name: str
    value: str
    doc: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class GroupView:
    """Constants that belong together."""

    title: str
    constants: tuple[ConstantView, ...]


@dataclass(frozen=True, slots=True)
class RowView:
    """A row of literals: ``key`` with its colon or "", and the elements filled into lines."""

    key: str
    lines: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class MemberView:
    """A member of an enum."""

    name: str
    number: int
    value: str
    label: str


@dataclass(frozen=True, slots=True)
class EnumView:
    """An enum; ``base`` is "Selection" or "Flags"."""

    name: str
    base: str
    doc: tuple[str, ...]
    members: tuple[MemberView, ...]
    row: RowView


@dataclass(frozen=True, slots=True)
class TableView:
    """A table of rows; ``open`` and ``close`` are its brackets."""

    name: str
    type: str
    open: str
    rows: tuple[RowView, ...]
    close: str


@dataclass(frozen=True, slots=True)
class SizesView:
    """A table of sizes by the value of a field, filled into lines."""

    name: str
    lines: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class FieldView:
    """A field of a telegram; ``constant`` is "" where its value is free."""

    name: str
    type: str
    constant: str
    doc: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class PartView:
    """Bits of a field of a telegram; ``label`` names them in errors."""

    name: str
    field: str
    low: int
    mask: str
    label: str
    settable: bool
    doc: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class TelegramClassView:
    """A class of a telegram (``base`` "Telegram") or of an entry of its groups ("Fields", without code)."""

    name: str
    base: str
    doc: tuple[str, ...]
    slots: tuple[str, ...]
    fields: tuple[FieldView, ...]
    parameters: tuple[str, ...]
    assignments: tuple[str, ...]
    parts: tuple[PartView, ...]
    decode: tuple[str, ...]
    encode: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class VectorView:
    """A worked telegram: its bytes as hexadecimal text, and its fields as lines of a dict of literals."""

    id: str
    module: str
    name: str
    data: str
    fields: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class TelegramsView:
    """The telegrams of a device; whether any has constants, or groups that repeat."""

    has_constants: bool
    has_groups: bool
    sizes: tuple[SizesView, ...]
    classes: tuple[TelegramClassView, ...]


@dataclass(frozen=True, slots=True)
class DeviceView:
    """A device module, its stub and its rows."""

    module: str
    rows_module: str
    telegrams_module: str
    tables_module: str
    title: str
    title_literal: str
    manual: str
    head: tuple[str, ...]
    doc: tuple[str, ...]
    has_index_base: bool
    index_base: str
    ignored_mask: str
    has_error_fields: bool
    error_kinds: str
    groups: tuple[GroupView, ...]
    enums: tuple[EnumView, ...]
    enum_bases: str
    telegrams: TelegramsView
    telegram_names: tuple[str, ...]
    exported: tuple[str, ...]
    device_row: tuple[str, ...]
    tables: tuple[TableView, ...]
    panels: tuple[TableView, ...]


@dataclass(frozen=True, slots=True)
class SessionView:
    """A session with its title; lines with and without prompt."""

    title: str
    lines: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ExampleView:
    """The session that the README shows."""

    module: str
    constant: str
    number: int
    name: str
    address: str
    cite: str
    enum: str
    value: int
    member: str
    unknown: int
    sessions: tuple[SessionView, ...]
