"""Reader of EDS and DCF files (CiA 306), as strict in what it reports as it is tolerant in what it reads.

``parse`` splits a text into sections and keys, ``read`` interprets them.  Nothing that a file holds raises: what is
wrong is collected as problems with line and column, and the rest is read all the same.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache


@dataclass(frozen=True, slots=True, order=True)
class Problem:
    """Something wrong in a file; line and column count from 1."""

    line: int
    column: int
    message: str


@dataclass(frozen=True, slots=True)
class Key:
    """A key with its value as written, and where both begin; of an empty value the column after the ``=``."""

    name: str
    value: str
    line: int
    column: int
    value_column: int


@dataclass(frozen=True, slots=True)
class Section:
    """A section: ``values`` maps each key in lower case to the value as written.

    Line and column are those of the ``[``.
    """

    name: str
    line: int
    column: int
    values: Mapping[str, str]
    _source: Sequence[str] = field(repr=False)

    def get(self, name: str) -> str | None:
        """Value of a key in any spelling of upper and lower case, ``None`` where it is missing."""
        return self.values.get(name.lower())

    def key(self, name: str) -> Key | None:
        """A key with its place, ``None`` where it is missing."""
        return next((key for key in self.keys() if key.name.lower() == name.lower()), None)

    def keys(self) -> Iterator[Key]:
        """All keys in the order of the file, of a repeated key the first."""
        seen = set()
        for number, line in enumerate(self._source[self.line :], self.line + 1):
            written, equals, value = line.partition("=")
            if written.lstrip().startswith("["):
                break
            name = _key_name(written)
            if equals and name and name not in seen:
                seen.add(name)
                yield _key(number, written, value)


@dataclass(frozen=True, slots=True)
class Document:
    """Sections in the order of the file, by name in lower case; of a repeated section the first."""

    sections: Mapping[str, Section]
    problems: tuple[Problem, ...]

    def section(self, name: str) -> Section | None:
        """A section in any spelling of upper and lower case, ``None`` where it is missing."""
        return self.sections.get(name.lower())


@dataclass(frozen=True, slots=True)
class NodeRelative:
    """A formula: ``offset`` + node-ID."""

    offset: int

    def at(self, node: int) -> int:
        """Value for node-ID ``node`` (1 ... 127)."""
        return self.offset + node


Value = int | str | NodeRelative
"""A value by its data type: a number, a formula, or the text as written for strings, times and real numbers."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Variable:
    """A section that describes a value.

    ``data_type`` is the number of the type.  ``None`` stands for a key that is missing or empty;
    ``section`` leads to the places of all of them.
    """

    index: int
    subindex: int
    name: str
    object_type: int
    data_type: int | None
    access: str | None
    low: int | NodeRelative | None
    high: int | NodeRelative | None
    default: Value | None
    mappable: bool
    section: Section


@dataclass(frozen=True, slots=True, kw_only=True)
class Object:
    """An object: a single value with sub-index 0 in ``variables``, or an array or record with one for each section.

    ``compact`` is the value of CompactSubObj, whose sub-indexes have no sections of their own.
    """

    index: int
    name: str
    object_type: int
    sub_number: int | None
    compact: int | None
    variables: tuple[Variable, ...]
    section: Section

    def variable(self, subindex: int) -> Variable | None:
        """The value of a sub-index, ``None`` where no section describes it."""
        return next((variable for variable in self.variables if variable.subindex == subindex), None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Eds:
    """A file: the three lists as written, objects by index, lines of [Comments]."""

    document: Document
    mandatory: tuple[int, ...]
    optional: tuple[int, ...]
    manufacturer: tuple[int, ...]
    objects: Mapping[int, Object]
    comments: tuple[str, ...]
    problems: tuple[Problem, ...]

    def section(self, name: str) -> Section | None:
        """A section in any spelling of upper and lower case, ``None`` where it is missing."""
        return self.document.section(name)


def decode(data: bytes) -> str:
    """Text of a file: ASCII as CiA 306 has it, or the UTF-8 or Windows text that real files hold as well."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("cp1252", errors="replace")


# Lines

_COMMENT = (";", "#")


def parse(text: str) -> Document:
    """Sections and keys of ``text``, with problems of syntax.

    Lines end with CR LF, LF or CR; blank lines and lines that begin with ``;`` or ``#`` are comments.
    """
    source = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    sections: dict[str, Section] = {}
    problems: list[Problem] = []
    names: dict[str, str] = {}
    before: dict[str, str] = {}
    values = before
    for number, line in enumerate(source, 1):
        if not line:
            continue
        written, equals, value = line.partition("=")
        name = names.get(written)
        if name is None:
            name = names[written] = _key_name(written)
        if equals and name:
            if name in values:
                problems.append(_problem(number, line, f"key '{written.strip()}' stands twice in its section"))
            else:
                values[name] = value.strip()
        elif line.lstrip().startswith("["):
            values = {}
            section = _section(number, source, values, problems)
            first = sections.setdefault(section.name.lower(), section)
            if first is not section:
                message = f"section [{_short(section.name)}] stands twice, first in line {first.line}"
                problems.append(_problem(number, line, message))
        elif not line.isspace() and not line.lstrip().startswith(_COMMENT):
            fault = "a value has no key" if equals else f"'{_short(line.strip())}' is no section, key or comment"
            problems.append(_problem(number, line, fault))
    stray = Section("", 0, 1, before, source).keys() if before else ()
    problems += [Problem(key.line, key.column, "a key stands before the first section") for key in stray]
    return Document(sections, tuple(problems))


def _key_name(written: str) -> str:
    """Key in lower case; "" for what is none."""
    name = written.strip().lower()
    return "" if name.startswith(("[", *_COMMENT)) else name


def _key(number: int, written: str, value: str) -> Key:
    shown = value.strip()
    return Key(
        name=written.strip(),
        value=shown,
        line=number,
        column=_indent(written) + 1,
        value_column=len(written) + 2 + (_indent(value) if shown else 0),
    )


def _section(number: int, source: Sequence[str], values: dict[str, str], problems: list[Problem]) -> Section:
    line = source[number - 1]
    column = _indent(line) + 1
    title, bracket, rest = line[column:].partition("]")
    if not bracket:
        problems.append(Problem(number, len(line.rstrip()) + 1, "']' is missing"))
    elif rest.strip() and not rest.lstrip().startswith(_COMMENT):
        problems.append(Problem(number, len(line) - len(rest.lstrip()) + 1, "text stands after the name of a section"))
    elif not title.strip():
        problems.append(Problem(number, column, "a section has no name"))
    return Section(title.strip(), number, column, values, source)


def _problem(number: int, line: str, message: str) -> Problem:
    return Problem(number, _indent(line) + 1, message)


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip())


def _short(text: str) -> str:
    return text if len(text) <= 40 else text[:37] + "..."


# Numbers

_NUMBER = re.compile(r"([+-]?)(?:0[xX]([0-9A-Fa-f]{1,16})|(0[0-7]{0,22})|([1-9][0-9]{0,19}))")
_FORMULA = re.compile(r"\$NODEID(?:\s*\+\s*(?P<after>\w+))?|(?P<before>\w+)\s*\+\s*\$NODEID", re.IGNORECASE)
_INTEGERS = {
    0x0001: (1, False),
    0x0002: (8, True),
    0x0003: (16, True),
    0x0004: (32, True),
    0x0005: (8, False),
    0x0006: (16, False),
    0x0007: (32, False),
    0x0010: (24, True),
    0x0012: (40, True),
    0x0013: (48, True),
    0x0014: (56, True),
    0x0015: (64, True),
    0x0016: (24, False),
    0x0018: (40, False),
    0x0019: (48, False),
    0x001A: (56, False),
    0x001B: (64, False),
}
"""Data types whose values are integers: width in bits, and whether they have a sign."""


@lru_cache(4096)
def number(text: str) -> int | None:
    """The number that CiA 306 writes as ``text``: 0x hexadecimal, 0 octal, else decimal; ``None`` for other text.

    >>> number("0x1F"), number("010"), number("-5"), number("5 ms")
    (31, 8, -5, None)
    """
    match = _NUMBER.fullmatch(text)
    if match is None:
        return None
    sign, hexadecimal, octal, decimal = match.groups()
    digits, base = (hexadecimal, 16) if hexadecimal else (octal, 8) if octal else (decimal, 10)
    value = int(digits, base)
    return -value if sign == "-" else value


def formula(text: str) -> int | NodeRelative | None:
    """A number or a formula over the node-ID in either order; ``None`` for other text.

    >>> formula("$NODEID+0x180"), formula("0x180 + $NodeId"), formula("384")
    (NodeRelative(offset=384), NodeRelative(offset=384), 384)
    """
    match = _FORMULA.fullmatch(text)
    if match is None:
        return number(text)
    offset = number(match["after"] or match["before"] or "0")
    return None if offset is None else NodeRelative(offset)


# Meaning

_SECTION = re.compile(r"([0-9A-F]{4})(?:sub([0-9A-F]{1,2}))?", re.IGNORECASE)
_ACCESS = ("ro", "wo", "rw", "rwr", "rww", "const")
_OBJECT_TYPES = {0x0: "NULL", 0x2: "DOMAIN", 0x5: "DEFTYPE", 0x6: "DEFSTRUCT", 0x7: "VAR", 0x8: "ARRAY", 0x9: "RECORD"}
_VALUE_TYPES = (0x5, 0x7)
_STRUCTURED_TYPES = (0x6, 0x8, 0x9)
_STRUCTURE = 0xFF
"""Sub-index that describes the structure of an object; it is not counted."""
_LISTS = ("MandatoryObjects", "OptionalObjects", "ManufacturerObjects")


def read(source: str | bytes) -> Eds:
    """The file ``source``, with problems of syntax, of values and of what does not fit together."""
    document = parse(decode(source) if isinstance(source, bytes) else source)
    return _Interpreter(document).eds()


class _Interpreter:
    """Reads the sections of one document and collects what is wrong in them."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._problems = list(document.problems)

    def eds(self) -> Eds:
        for name in ("FileInfo", "DeviceInfo"):
            if self._document.section(name) is None:
                self._problems.append(Problem(1, 1, f"section [{name}] is missing"))
        objects = self._objects()
        lists = [self._list(name, objects) for name in _LISTS]
        for index in sorted(objects.keys() - {index for entries in lists for index in entries}):
            self._note(objects[index].section, f"object 0x{index:04X} stands in no list of objects")
        return Eds(
            document=self._document,
            mandatory=lists[0],
            optional=lists[1],
            manufacturer=lists[2],
            objects=objects,
            comments=self._comments(),
            problems=tuple(sorted(self._problems)),
        )

    def _note(self, section: Section, message: str, name: str = "") -> None:
        """Note a problem at the value of the key ``name``, or at the section."""
        key = section.key(name) if name else None
        line, column = (key.line, key.value_column) if key else (section.line, section.column)
        self._problems.append(Problem(line, column, message))

    # Lists and comments

    def _list(self, name: str, objects: Mapping[int, Object]) -> tuple[int, ...]:
        section = self._document.section(name)
        if section is None:
            return ()
        count = self._number(section, "SupportedObjects")
        if count is None and section.get("SupportedObjects") is None:
            self._note(section, f"[{name}] has no SupportedObjects")
        entries = [key for key in section.keys() if key.name.lower() != "supportedobjects"]  # noqa: SIM118
        listed = []
        for place, key in enumerate(entries, 1):
            index = number(key.value)
            if key.name != str(place):
                self._problems.append(Problem(key.line, key.column, f"'{place}' is expected here, not '{key.name}'"))
            if index is None:
                self._problems.append(Problem(key.line, key.value_column, f"'{_short(key.value)}' is no number"))
            elif index not in objects:
                self._problems.append(Problem(key.line, key.value_column, f"object 0x{index:04X} has no section"))
            if index is not None:
                listed.append(index)
        if count is not None and count != len(entries):
            self._note(section, f"[{name}] lists {len(entries)} objects, not {count}", "SupportedObjects")
        return tuple(listed)

    def _comments(self) -> tuple[str, ...]:
        section = self._document.section("Comments")
        if section is None:
            return ()
        lines = []
        for place in range(1, (self._number(section, "Lines") or 0) + 1):
            line = section.get(f"Line{place}")
            if line is None:
                self._note(section, f"Line{place} is missing", "Lines")
                break
            lines.append(line)
        return tuple(lines)

    # Objects

    def _objects(self) -> dict[int, Object]:
        heads: dict[int, Section] = {}
        subs: dict[int, dict[int, Section]] = {}
        for section in self._document.sections.values():
            match = _SECTION.fullmatch(section.name)
            if match is None:
                continue
            index = int(match[1], 16)
            if match[2] is None:
                heads[index] = section
            else:
                subs.setdefault(index, {})[int(match[2], 16)] = section
        for index in subs.keys() - heads.keys():
            for section in subs[index].values():
                self._note(section, f"[{section.name}] stands without [{index:04X}]")
        return {index: self._object(index, heads[index], subs.get(index, {})) for index in sorted(heads)}

    def _object(self, index: int, section: Section, subs: Mapping[int, Section]) -> Object:
        object_type = self._object_type(section)
        compact = self._number(section, "CompactSubObj")
        sub_number = self._number(section, "SubNumber")
        if object_type in _STRUCTURED_TYPES or subs:
            name = self._name(section)
            variables = tuple(
                self._variable(index, subindex, subs[subindex], self._object_type(subs[subindex]))
                for subindex in sorted(subs)
            )
            self._check_count(section, object_type, sub_number, compact, sum(sub != _STRUCTURE for sub in subs))
        else:
            variables = (self._variable(index, 0, section, object_type),)
            name = variables[0].name
        return Object(
            index=index,
            name=name,
            object_type=object_type,
            sub_number=sub_number,
            compact=compact,
            variables=variables,
            section=section,
        )

    def _check_count(
        self, section: Section, object_type: int, sub_number: int | None, compact: int | None, count: int
    ) -> None:
        if object_type not in _STRUCTURED_TYPES:
            self._note(section, f"a {_OBJECT_TYPES[object_type]} has no sub-indexes", "ObjectType")
        elif sub_number is None and not compact:
            self._note(section, f"[{section.name}] has no SubNumber")
        elif sub_number is not None and sub_number != count:
            self._note(section, f"[{section.name}] has {count} sub-indexes, not {sub_number}", "SubNumber")

    def _variable(self, index: int, subindex: int, section: Section, object_type: int) -> Variable:
        data_type = self._number(section, "DataType")
        if not section.get("DataType") and object_type in _VALUE_TYPES:
            self._note(section, f"[{section.name}] has no DataType")
        low = self._limit(section, "LowLimit", data_type)
        high = self._limit(section, "HighLimit", data_type)
        default = self._value(section, "DefaultValue", data_type)
        self._check_order(section, low, high, default)
        return Variable(
            index=index,
            subindex=subindex,
            name=self._name(section),
            object_type=object_type,
            data_type=data_type,
            access=self._access(section, object_type),
            low=low,
            high=high,
            default=default,
            mappable=self._mapping(section),
            section=section,
        )

    def _check_order(
        self, section: Section, low: int | NodeRelative | None, high: int | NodeRelative | None, default: Value | None
    ) -> None:
        if isinstance(low, int) and isinstance(high, int) and low > high:
            self._note(section, f"LowLimit {low} is above HighLimit {high}", "LowLimit")
        elif isinstance(default, int) and isinstance(low, int) and default < low:
            self._note(section, f"DefaultValue {default} is below LowLimit {low}", "DefaultValue")
        elif isinstance(default, int) and isinstance(high, int) and default > high:
            self._note(section, f"DefaultValue {default} is above HighLimit {high}", "DefaultValue")

    # Keys

    def _name(self, section: Section) -> str:
        name = section.get("ParameterName")
        if not name:
            self._note(section, f"[{section.name}] has no ParameterName")
        return name or ""

    def _object_type(self, section: Section) -> int:
        """ObjectType; a missing one stands for VAR."""
        object_type = self._number(section, "ObjectType")
        if object_type is not None and object_type not in _OBJECT_TYPES:
            self._note(section, f"{object_type} is no object type", "ObjectType")
            return 0x7
        return 0x7 if object_type is None else object_type

    def _access(self, section: Section, object_type: int) -> str | None:
        access = section.get("AccessType")
        if not access:
            if object_type in _VALUE_TYPES:
                self._note(section, f"[{section.name}] has no AccessType")
            return None
        if access.lower() not in _ACCESS:
            self._note(section, f"'{_short(access)}' is no access type, those are {', '.join(_ACCESS)}", "AccessType")
            return None
        return access.lower()

    def _mapping(self, section: Section) -> bool:
        mapping = self._number(section, "PDOMapping")
        if mapping not in (None, 0, 1):
            self._note(section, f"PDOMapping is 0 or 1, not {mapping}", "PDOMapping")
        return mapping == 1

    def _number(self, section: Section, name: str) -> int | None:
        text = section.get(name)
        if not text:
            return None
        value = number(text)
        if value is None:
            self._note(section, f"'{_short(text)}' is no number", name)
        return value

    def _limit(self, section: Section, name: str, data_type: int | None) -> int | NodeRelative | None:
        value = self._value(section, name, data_type)
        return None if isinstance(value, str) else value

    def _value(self, section: Section, name: str, data_type: int | None) -> Value | None:
        text = section.get(name)
        if not text:
            return None
        width = _INTEGERS.get(data_type) if data_type is not None else None
        if width is None:
            return text
        value = formula(text)
        if value is None:
            self._note(section, f"'{_short(text)}' is no number", name)
            return None
        return self._fitting(section, name, value, *width)

    def _fitting(
        self, section: Section, name: str, value: int | NodeRelative, bits: int, signed: bool
    ) -> int | NodeRelative | None:
        """``value`` as the type holds it: hexadecimal numbers of signed types are two's complements."""
        highest = (1 << (bits - signed)) - 1
        lowest = -highest - 1 if signed else 0
        least, most = (value.at(1), value.at(127)) if isinstance(value, NodeRelative) else (value, value)
        if signed and isinstance(value, int) and highest < value < 1 << bits and "x" in str(section.get(name)).lower():
            return value - (1 << bits)
        if least < lowest or most > highest:
            self._note(section, f"{section.get(name)} does not fit into {bits} bits", name)
            return None
        return value
