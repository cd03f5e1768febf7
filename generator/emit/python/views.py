"""View objects: every string that the templates lay out."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Head:
    """Head of the files that belong to no device."""

    lines: tuple[str, ...]
    version: str
    date: str


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
class DeviceView:
    """A device module, its stub and its rows."""

    module: str
    rows_module: str
    title: str
    title_literal: str
    manual: str
    head: tuple[str, ...]
    doc: tuple[str, ...]
    has_index_base: bool
    index_base: str
    response_mask: str
    groups: tuple[GroupView, ...]
    enums: tuple[EnumView, ...]
    exported: tuple[str, ...]
    device_row: tuple[str, ...]
    tables: tuple[TableView, ...]


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
