"""Classes of telegrams: the fields of a layout, and the code that reads and writes their bytes."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from math import inf

from generator.emit import names
from generator.emit.base import EmitError
from generator.emit.python.enums import Enums, telegram_fact
from generator.emit.python.text import doc, fill, literal, wrap
from generator.emit.python.views import (
    FieldView,
    PartView,
    SizesView,
    TelegramClassView,
    TelegramsView,
)
from generator.model import Device, Field, FieldType, Layout
from generator.naming import Scope, pascal, safe

_TAKEN = frozenset(("base", "bytes", "classmethod", "decode", "encode", "int", "list", "part", "property", "str"))
"""Names that a class needs for itself."""

_FREE = frozenset(("case", "match", "mro", "name", "type", "value"))
"""Names that only enums and statements reserve."""

_SIZE = re.compile(r"\bsize\b")
_LOCALS = frozenset(("at", "cls", "data", "found", "length", "size"))
"""Names that ``decode`` needs for itself."""

_INDENT = "    "
_WIDTH = 100

Names = dict[str, str]
"""Expression for each field whose value may decide on others."""

SizeTable = Callable[[tuple[tuple[int, int], ...]], str]
"""Gives the constant that holds a table of sizes."""


class Telegrams:
    """Collects the telegram classes of one device; their names and those of their enums stand in the ``scope``."""

    def __init__(self, device: Device, scope: Scope, enums: Enums) -> None:
        self._device = device
        self._scope = scope
        self._enums = enums
        self._sizes: dict[tuple[tuple[int, int], ...], str] = {}

    def build(self) -> TelegramsView:
        """Every class, those of groups before the telegram that they belong to."""
        classes = tuple(view for layout in self._device.layouts for view in self._layout(layout))
        tables = tuple(
            SizesView(name, wrap((f"{by}: {size}," for by, size in sizes), _WIDTH))
            for sizes, name in self._sizes.items()
        )
        fields = [field for layout in self._device.layouts for field in _all_fields(layout.fields)]
        return TelegramsView(
            has_constants=any(field.constant is not None for field in fields),
            has_groups=any(field.type is FieldType.GROUP for field in fields),
            sizes=tables,
            classes=classes,
        )

    def _layout(self, layout: Layout) -> Iterator[TelegramClassView]:
        name = self._scope.add(class_name(layout), layout.where)
        errata = f"Errata: {', '.join(layout.errata)}." if layout.errata else ""
        others = [class_name(other) for other in self._device.layouts if _takes(layout, other)]
        first = f"To be tried after {' and '.join(others)}, whose bytes it takes for its own." if others else ""
        text = doc(f"{layout.name} ({layout.protocol}).", layout.description, first, errata, f"{layout.cite!s}.")
        yield from self._class(name, layout.fields, layout, text, is_telegram=True)

    def _class(
        self, name: str, fields: Sequence[Field], layout: Layout, text: tuple[str, ...], *, is_telegram: bool
    ) -> Iterator[TelegramClassView]:
        for field in fields:
            if field.type is FieldType.GROUP:
                group = self._scope.add(_group_class(name, field), field.where)
                about = doc(f"{field.title}: an entry of the group ``{field_name(field)}``.", field.description)
                yield from self._class(group, field.fields, layout, about, is_telegram=False)
        scope = Scope(f"fields of the telegram class {name}")
        free = [field for field in fields if field.constant is None]
        derived = _derived(fields)
        yield TelegramClassView(
            name=name,
            base="Telegram" if is_telegram else "Fields",
            doc=text,
            slots=fill([field_name(field) for field in free]),
            fields=tuple(self._field(name, field, layout, scope) for field in fields),
            parameters=tuple(_parameter(name, field, derived) for field in free),
            assignments=tuple(
                _assignment(field, derived) for field in sorted(free, key=lambda field: field.name in derived)
            ),
            parts=tuple(part for field in fields for part in _parts(field, scope)),
            decode=tuple(_Decoder(self._table).telegram(name, fields)) if is_telegram else (),
            encode=tuple(_Encoder(self._table).telegram(fields)) if is_telegram else (),
        )

    def _field(self, owner: str, field: Field, layout: Layout, scope: Scope) -> FieldView:
        lists = [(field.name, field.values), *((f"{field.name}.{part}", values) for part, values in field.bit_values)]
        enums = [
            enum
            for path, options in lists
            if (enum := self._enums.selection(telegram_fact(layout, owner, field, path), options)) is not None
        ]
        return FieldView(
            name=scope.add(field_name(field), field.where),
            type="Final" if field.constant is not None else _type(owner, field),
            constant="" if field.constant is None else _number(field.constant),
            doc=doc(
                f"{field.title.removesuffix('.')}.",
                field.description,
                f"Its values are listed in {', '.join(enums)}." if enums else "",
            ),
        )

    def _table(self, sizes: tuple[tuple[int, int], ...]) -> str:
        """Constant that holds a table of sizes."""
        return self._sizes.setdefault(sizes, f"_SIZES_{len(self._sizes) + 1}")


def _takes(layout: Layout, other: Layout) -> bool:
    """Whether the layout, which has no constants, fits telegrams of its protocol that a constant at the start tells."""
    if layout.protocol != other.protocol or any(field.constant is not None for field in layout.fields):
        return False
    (least, most), (other_least, other_most) = _sizes(layout), _sizes(other)
    return other.fields[0].constant is not None and least <= other_most and other_least <= most


def _sizes(layout: Layout) -> tuple[float, float]:
    """Bytes of the shortest and of the longest telegram."""
    lengths = [field.length for field in layout.fields]
    least = sum(length for length in lengths if isinstance(length, int))
    return least, least if all(isinstance(length, int) for length in lengths) else inf


def class_name(layout: Layout) -> str:
    """Name of the class of a layout."""
    return safe(pascal(layout.id), "python", "N")


def field_name(field: Field) -> str:
    """Name of the attribute of a field: its own, unless Python or the class needs that."""
    name = field.name if field.name in _FREE else safe(field.name, "python")
    return f"{name}_" if name in _TAKEN else name


def _group_class(owner: str, field: Field) -> str:
    return f"{owner}{pascal(field.name)}"


def _number(value: int) -> str:
    return f"0x{value:X}" if value > 9 else str(value)


def _type(owner: str, field: Field) -> str:
    if field.type is FieldType.GROUP:
        return f"list[{_group_class(owner, field)}]"
    return {FieldType.BYTES: "bytes", FieldType.TEXT: "str"}.get(field.type, "int")


def _all_fields(fields: Sequence[Field]) -> Iterator[Field]:
    """The fields and those of groups within them."""
    for field in fields:
        yield field
        yield from _all_fields(field.fields)


def _derived(fields: Sequence[Field]) -> dict[str, str]:
    """Counts and lengths by field, each with the field of this class that it tells the length of."""
    found: dict[str, str] = {}
    for field in fields:
        by = field.count if field.type is FieldType.GROUP else field.length
        if isinstance(by, str) and field.sizes is None:
            found.setdefault(by, field_name(field))
    return {name: measured for name, measured in found.items() if any(field.name == name for field in fields)}


def _parameter(owner: str, field: Field, derived: Mapping[str, str]) -> str:
    if field.type is FieldType.GROUP:
        return f"{field_name(field)}: Iterable[{_group_class(owner, field)}]"
    return f"{field_name(field)}: {_type(owner, field)}" + (" | None = None" if field.name in derived else "")


def _assignment(field: Field, derived: Mapping[str, str]) -> str:
    name = field_name(field)
    if field.type is FieldType.GROUP:
        return f"self.{name} = list({name})"
    if field.name in derived:
        return f"self.{name} = len(self.{derived[field.name]}) if {name} is None else {name}"
    return f"self.{name} = {name}"


def _parts(field: Field, scope: Scope) -> Iterator[PartView]:
    values = dict(field.bit_values)
    for bits, name in zip(field.bits, names.field_names(field.bits), strict=True):
        place = f"Bit {bits.low}" if bits.low == bits.high else f"Bits {bits.low} ... {bits.high}"
        meanings = "; ".join(f"{option.value}: {option.label}" for option in values.get(bits.label, ()))
        yield PartView(
            name=scope.add(f"{field.name}_{name}", field.where),
            field=field_name(field),
            low=bits.low,
            mask=f"0x{bits.mask:X}",
            label=f"{field.name}.{bits.label}",
            settable=field.constant is None,
            doc=doc(f"{place} of ``{field_name(field)}``" + (f": {meanings}." if meanings else ".")),
        )


class _Names:
    """Names of local variables of one function, none twice."""

    def __init__(self) -> None:
        self._taken = set(_LOCALS)

    def new(self, field: Field) -> str:
        name = field_name(field)
        while name in self._taken:
            name += "_"
        self._taken.add(name)
        return name


class _Coder:
    """What reading and writing share: where lengths come from."""

    error = ""

    def __init__(self, table: SizeTable) -> None:
        self._names = _Names()
        self._table = table

    def _length(self, field: Field, scope: Names) -> str:
        """Expression for the length of a field that depends on others."""
        if field.sizes is None:
            assert isinstance(field.length, str)
            return self._known(field, field.length, scope)
        by = field.sizes.by
        table, value = self._table(field.sizes.sizes), self._known(field, by, scope)
        size = f"base.sized({table}, {value}, {literal(field.name)}, {literal(by)}, base.{self.error})"
        if field.sizes.times is not None:
            size = f"{size} * {self._known(field, field.sizes.times, scope)}"
        return size if field.sizes.fills is None else f"-{size} % {field.sizes.fills}"

    @staticmethod
    def _known(field: Field, name: str, scope: Names) -> str:
        if name not in scope:
            raise EmitError("telegram-field", field.where, f"the length depends on '{name}', which is no number before")
        return scope[name]

    @staticmethod
    def _remember(field: Field, value: str, scope: Names) -> None:
        scope[field.name] = value
        for bits in field.bits:
            scope[f"{field.name}.{bits.label}"] = f"(({value} & 0x{bits.mask:X}) >> {bits.low})"


class _Decoder(_Coder):
    """Lines of ``decode``.

    The position is ``_base`` (a variable, or nothing at the beginning of a telegram) and ``_offset`` bytes behind it.
    """

    error = "DecodeError"

    def __init__(self, table: SizeTable) -> None:
        super().__init__(table)
        self._base = ""
        self._offset = 0

    def telegram(self, name: str, fields: Sequence[Field]) -> Iterator[str]:
        """Body of the method."""
        values: Names = {}
        lines = list(self._fields(name, fields, values, {}))
        if not (fields and fields[-1].length is None and fields[-1].sizes is None and fields[-1].count is None):
            lines.append(f"if size != {self._place()}:")
            lines.append(f"{_INDENT}raise base.trailing(size - {self._place(inner=True)})")
        yield "data = bytes(memoryview(data))"
        if any(_SIZE.search(line) for line in lines):
            yield "size = len(data)"
        yield from lines
        yield from _call("return cls(", _keywords(values))

    def _place(self, further: int = 0, *, inner: bool = False) -> str:
        offset = self._offset + further
        if not self._base:
            return str(offset)
        text = f"{self._base} + {offset}" if offset else self._base
        return f"({text})" if inner and offset else text

    def _fields(self, owner: str, fields: Sequence[Field], values: Names, outer: Names) -> Iterator[str]:
        """Lines that read the fields; ``values`` gets the variable of each field that is no constant."""
        scope = dict(outer)
        for place, field in enumerate(fields):
            if isinstance(field.length, int) and (place == 0 or _ends_run(fields[place - 1])):
                yield from self._check(_run(fields[place:]))
            if field.type is FieldType.GROUP:
                yield from self._group(owner, field, values, scope)
                continue
            start = self._place()
            if isinstance(field.length, int):
                end = self._place(field.length)
                self._offset += field.length
            elif field.length is None and field.sizes is None:
                end = ""
                self._base, self._offset = "size", 0
            else:
                yield f"length = {self._length(field, scope)}"
                end = f"{start} + length"
                yield f"if length > size - {self._place(inner=True)}:"
                short = f"base.short(size - {self._place(inner=True)}, ({literal(field.name)}, length))"
                yield f"{_INDENT}raise {short}"
            yield from self._value(field, start, end, values, scope)
            if field.sizes is not None or isinstance(field.length, str):
                yield f"at = {end}"
                self._base, self._offset = "at", 0

    def _check(self, run: Sequence[Field]) -> Iterator[str]:
        """Refuse too few bytes for fields of fixed length."""
        total = sum(field.length for field in run if isinstance(field.length, int))
        expected = [f"({literal(field.name)}, {field.length})" for field in run]
        left = f"size - {self._place(inner=True)}" if self._base or self._offset else "size"
        yield f"if {left} < {total}:" if self._base else f"if size < {self._offset + total}:"
        yield from (f"{_INDENT}{line}" for line in _call("raise base.short(", [left, *expected]))

    def _value(self, field: Field, start: str, end: str, values: Names, scope: Names) -> Iterator[str]:
        """Line that reads the value, and the check of a constant."""
        octets = f"data[{start}:{end}]"
        if field.type is FieldType.BYTES:
            value = octets
        elif field.type is FieldType.TEXT:
            value = f'{octets}.decode("latin-1")'
        elif field.length == 1 and field.type is FieldType.UINT:
            value = f"data[{start}]"
        else:
            signed = ", signed=True" if field.type is FieldType.INT else ""
            value = f"int.from_bytes({octets}, {literal('big' if field.big else 'little')}{signed})"
        if field.constant is None:
            variable = values[field_name(field)] = self._names.new(field)
            yield f"{variable} = {value}"
            self._remember(field, variable, scope)
        else:
            yield f"found = {value}"
            yield f"if found != {_number(field.constant)}:"
            yield f"{_INDENT}raise base.constant({literal(field.name)}, found, {_number(field.constant)})"
            self._remember(field, _number(field.constant), scope)

    def _group(self, owner: str, field: Field, values: Names, scope: Names) -> Iterator[str]:
        """Loop over the entries of a group."""
        variable = values[field_name(field)] = self._names.new(field)
        entry = _group_class(owner, field)
        yield f"{variable}: list[{entry}] = []"
        if self._place() != "at":
            yield f"at = {self._place()}"
        if field.count is not None:
            yield f"for _ in range({self._known(field, field.count, scope)}):"
        elif _always_reads(field.fields):
            yield "while at < size:"
        else:
            raise EmitError("telegram-field", field.where, f"an entry of the group '{field.name}' may have no bytes")
        self._base, self._offset = "at", 0
        inner: Names = {}
        lines = list(self._fields(entry, field.fields, inner, scope))
        if self._place() != "at":
            lines.append(f"at = {self._place()}")
        lines += _call(f"{variable}.append({entry}(", _keywords(inner), "))")
        yield from (f"{_INDENT}{line}" for line in lines)
        self._base, self._offset = "at", 0


class _Encoder(_Coder):
    """Lines of ``encode``."""

    error = "EncodeError"

    def telegram(self, fields: Sequence[Field]) -> Iterator[str]:
        """Body of the method."""
        yield "data = bytearray()"
        yield from self._fields("self", fields, {})
        yield "return bytes(data)"

    def _fields(self, owner: str, fields: Sequence[Field], outer: Names) -> Iterator[str]:
        scope = dict(outer)
        for field in fields:
            value = f"{owner}.{field_name(field)}"
            if field.type is FieldType.GROUP:
                yield from self._group(field, value, scope)
                continue
            self._remember(field, value, scope)
            if field.constant is not None and isinstance(field.length, int):
                yield f"data += {_constant(field, field.constant, field.length)}"
                continue
            size: str | int | None = field.length
            if isinstance(field.length, str) or field.sizes is not None:
                yield f"length = {self._length(field, scope)}"
                size = "length"
            name = literal(field.name)
            if field.type in (FieldType.BYTES, FieldType.TEXT):
                function = "octets" if field.type is FieldType.BYTES else "text"
                yield f"data += base.{function}({value}, {size}, {name})"
            else:
                order = literal("big" if field.big else "little")
                yield f"data += base.number({value}, {size}, {order}, {field.type is FieldType.INT}, {name})"

    def _group(self, field: Field, value: str, scope: Names) -> Iterator[str]:
        if field.count is not None:
            yield f"base.counted(len({value}), {self._known(field, field.count, scope)}, {literal(field.name)})"
        entry = self._names.new(field)
        yield f"for {entry} in {value}:"
        yield from (f"{_INDENT}{line}" for line in self._fields(entry, field.fields, scope))


def _constant(field: Field, constant: int, length: int) -> str:
    """Literal of the bytes of a constant."""
    octets = constant.to_bytes(length, "big" if field.big else "little", signed=field.type is FieldType.INT)
    return 'b"' + "".join(f"\\x{octet:02x}" for octet in octets) + '"'


def _ends_run(field: Field) -> bool:
    """Whether the fields after this one need a check of their own: the error of a constant comes before theirs."""
    return not isinstance(field.length, int) or field.constant is not None


def _run(fields: Sequence[Field]) -> list[Field]:
    """The first fields, all of fixed length, up to a constant."""
    run: list[Field] = []
    for field in fields:
        if not isinstance(field.length, int):
            break
        run.append(field)
        if field.constant is not None:
            break
    return run


def _always_reads(fields: Sequence[Field]) -> bool:
    return any(isinstance(field.length, int) and field.length > 0 for field in fields)


def _keywords(values: Names) -> list[str]:
    return [f"{name}={variable}" for name, variable in values.items()]


def _call(start: str, arguments: Sequence[str], end: str = ")") -> Iterator[str]:
    """Call in one line, or with the arguments filled into lines of their own."""
    line = f"{start}{', '.join(arguments)}{end}"
    if len(line) <= _WIDTH:
        yield line
    else:
        yield start
        yield from (f"{_INDENT}{each}" for each in wrap((f"{argument}," for argument in arguments), _WIDTH))
        yield end
