"""<device>_telegrams.h: a structure and a codec for each layout; telegram.h: what all codecs share."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from generator.codec import decode, encode
from generator.emit.c.device import device_prefix
from generator.emit.c.prose import cited, errata, provenance
from generator.emit.c.syntax import comment, integer, paragraph, string
from generator.emit.c.writer import Constant, Names, Section, Writer
from generator.model import BitField, DataType, Device, Example, Field, FieldType, Layout, Model, Values, Where
from generator.model.telegram import OPEN
from generator.naming import safe, snake

STATUSES = (
    ("ok", "done"),
    ("truncated", "bytes are missing"),
    ("trailing", "bytes are left over"),
    ("constant", "a field has another value than the only one that it may have"),
    ("unknown_size", "the length depends on a value for which no length is known"),
    ("range", "a value does not fit its bytes, or bytes are not as many as another field says"),
    ("capacity", "the buffer is too small"),
    ("count", "a group is repeated another number of times than its count says"),
)
"""Results of the codecs by their value; part of the interface, so append only."""

_WIDTHS = (8, 16, 32, 64)
_LARGEST = _WIDTHS[-1] // 8
"""Bytes of the widest integer type; wider numbers are borrowed bytes."""

_HERE = Where("telegram.h", 1, 1)


@dataclass(frozen=True, slots=True)
class Status:
    """A result of the codecs: constant, literal, name in lower case, meaning."""

    name: str
    value: str
    text: str
    comment: str


@dataclass(frozen=True, slots=True)
class Runtime:
    """View of telegram.h."""

    file: str
    guard: str
    brief: str
    notes: tuple[str, ...]
    statuses: tuple[Status, ...]


@dataclass(frozen=True, slots=True)
class Case:
    """Values of a switch that lead to one length."""

    values: tuple[str, ...]
    size: str


@dataclass(frozen=True, slots=True)
class SizeTable:
    """Function that tells a length by the value of a field."""

    function: str
    comment: str
    cases: tuple[Case, ...]


@dataclass(frozen=True, slots=True)
class Step:
    """How a field is read and written.

    ``kind``: "number", "constant", "bytes" or "group".  ``length``: expression, "" up to the end; ``table`` and
    ``times`` come before it where the length depends on other fields, ``fills`` where it fills them up.  ``value`` and
    ``negative``: a constant in two's complement.  ``element``: names of a group's elements; ``outers``: what their
    functions get of what is around.
    """

    kind: str
    name: str
    big: str
    member_type: str = ""
    comment: str = ""
    signed: bool = False
    length: str = ""
    table: str = ""
    times: str = ""
    fills: str = ""
    value: str = ""
    negative: str = "false"
    element: str = ""
    outers: str = ""
    count: str = ""


@dataclass(frozen=True, slots=True)
class Accessor:
    """A part of a number: its functions, its type and that of the number, and the type to compute with."""

    get: str
    set: str
    member: str
    member_type: str
    wide: str
    type: str
    mask: str
    shift: str
    width: str
    checked: bool
    label: str
    comment: str


@dataclass(frozen=True, slots=True)
class Codec:
    """Structure and functions of a layout, or of an element of a group where ``whole`` is false.

    ``parameters``: of the structures around an element that it needs, each with a comma behind it; ``levels``: their
    depths, 0 for that of the layout.
    """

    stem: str
    title: str
    lines: tuple[str, ...]
    whole: bool
    steps: tuple[Step, ...]
    tables: tuple[SizeTable, ...]
    accessors: tuple[Accessor, ...]
    parameters: str
    levels: tuple[int, ...]
    sections: tuple[Section, ...]

    @property
    def type(self) -> str:
        """Name of the structure."""
        return f"{self.stem}_t"

    @property
    def members(self) -> tuple[Step, ...]:
        """Fields that the structure holds: all but the constants."""
        return tuple(step for step in self.steps if step.kind != "constant")

    @property
    def groups(self) -> tuple[Step, ...]:
        """Fields that repeat."""
        return tuple(step for step in self.steps if step.kind == "group")

    @property
    def parts(self) -> bool:
        """Whether a field is read from bytes that are not kept."""
        return any(step.kind in ("number", "constant") for step in self.steps)

    @property
    def dynamic(self) -> bool:
        """Whether a length is computed."""
        return any(step.length == "length" for step in self.steps)


@dataclass(frozen=True, slots=True)
class LayoutView:
    """A layout and its codecs: those of its groups, inner ones first, and last its own."""

    id: str
    codecs: tuple[Codec, ...]

    @property
    def codec(self) -> Codec:
        """Its own codec."""
        return self.codecs[-1]


@dataclass(frozen=True, slots=True)
class Vector:
    """A worked telegram: its bytes with open ones filled, and what must hold after decoding."""

    name: str
    comment: str
    stem: str
    octets: str
    checks: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Telegrams:
    """View of the telegrams of a device and of its test programs."""

    file: str
    guard: str
    brief: str
    notes: tuple[str, ...]
    device: str
    layouts: tuple[LayoutView, ...]
    vectors: tuple[Vector, ...]

    @property
    def compares(self) -> bool:
        """Whether a worked telegram has bytes to compare."""
        return any("same(" in check for vector in self.vectors for check in vector.checks)

    @property
    def codecs(self) -> Iterator[Codec]:
        """Codecs of all layouts."""
        for layout in self.layouts:
            yield from layout.codecs

    @property
    def constants(self) -> Iterator[Constant]:
        """Every constant of the header, those of enumerations too."""
        for codec in self.codecs:
            for section in codec.sections:
                yield from section.constants
                for enumeration in section.enumerations:
                    yield from enumeration.constants


def runtime(model: Model, names: Names) -> Runtime:
    """View of telegram.h."""
    statuses = tuple(
        Status(names.claim(f"DRIVESPEC_{word.upper()}", _HERE), str(value), word, comment(text))
        for value, (word, text) in enumerate(STATUSES)
    )
    makers = sorted({device.manufacturer for device in model.devices})
    manuals = [device.manual for device in model.devices if device.layouts]
    guard = names.claim("DRIVESPEC_TELEGRAM_H", _HERE)
    return Runtime("telegram.h", guard, "What the codecs share.", provenance(model, manuals, makers), statuses)


def device_telegrams(model: Model, device: Device, names: Names) -> Telegrams:
    """View of the telegrams of a device.

    Raises:
        EmitError: Rule "name-collision", when two facts would get one name.
    """
    layouts = tuple(LayoutView(layout.id, tuple(_codecs(layout, device, names))) for layout in device.layouts)
    by_id = {layout.id: layout for layout in device.layouts}
    levels = {codec.stem: codec.levels for layout in layouts for codec in layout.codecs}
    return Telegrams(
        file=f"{device.id}_telegrams.h",
        guard=names.claim(f"DRIVESPEC_{device_prefix(device)}_TELEGRAMS_H", device.where),
        brief=comment(f"Telegrams of the {device.title}: structures, decoding and encoding."),
        notes=provenance(model, [device.manual], [device.manufacturer]),
        device=device.id,
        layouts=layouts,
        vectors=tuple(_vector(example, by_id[example.layout], device, levels) for example in device.examples),
    )


def _codecs(layout: Layout, device: Device, names: Names) -> list[Codec]:
    """Codecs of the groups of a layout, inner ones first, and last that of the layout."""
    lines = [layout.description, *_tried_first(layout, device)]
    lines += [f"{layout.protocol}. {cited(layout.cite, layout.origin)}"]
    lines += errata(device, layout.errata, {})
    build = _Builder(names, layout.where)
    stem = snake(device.id, layout.id)
    build.codec(stem, layout.name, lines, layout.fields, ())
    return build.codecs


def _tried_first(layout: Layout, device: Device) -> Iterator[str]:
    """Layouts to try first: this one decodes their telegrams too, though its list of values lacks their constant."""
    for other in device.layouts:
        if other.protocol != layout.protocol or len(other.fields) != len(layout.fields):
            continue
        pairs = list(zip(layout.fields, other.fields, strict=True))
        if any(a.length != b.length or a.constant not in (None, b.constant) for a, b in pairs):
            continue
        for field, special in pairs:
            values = [option.value for option in field.values]
            if values and special.constant is not None and special.constant not in values:
                told = f"{special.title} 0x{special.constant:02X}"
                yield f"Try {snake(device.id, other.id)}_decode first: its telegrams ({told}) decode as these, too."


@dataclass(frozen=True, slots=True)
class _Level:
    """Fields around the ones at hand, and the structure that holds them."""

    stem: str
    fields: tuple[Field, ...]


class _Builder:
    """Makes the codecs of one layout."""

    def __init__(self, names: Names, where: Where) -> None:
        self._names = names
        self._where = where
        self.codecs: list[Codec] = []

    def codec(
        self, stem: str, title: str, lines: Sequence[str], fields: tuple[Field, ...], around: tuple[_Level, ...]
    ) -> set[int]:
        """Add a codec; returns which of the levels around it its lengths and counts come from."""
        levels = (*around, _Level(stem, fields))
        used: set[int] = set()
        tables: list[SizeTable] = []
        steps = [self._step(field, levels, used, tables) for field in fields]
        used.discard(len(around))
        suffixes = ("t", "read", "write", *(("next", "list") if around else ("decode", "encode")))
        for suffix in suffixes:
            self._names.claim(f"{stem}_{suffix}", self._where)
        self.codecs.append(
            Codec(
                stem=stem,
                title=comment(title),
                lines=tuple(line for text in lines if text for line in paragraph(text)),
                whole=not around,
                steps=tuple(steps),
                tables=tuple(tables),
                accessors=tuple(accessor for field in fields for accessor in self._accessors(stem, field)),
                parameters="".join(f"const {around[level].stem}_t *outer{level}, " for level in sorted(used)),
                levels=tuple(sorted(used)),
                sections=self._sections(stem, title, fields),
            )
        )
        return used

    def _step(self, field: Field, levels: tuple[_Level, ...], used: set[int], tables: list[SizeTable]) -> Step:
        name = _member(field)
        big = "true" if field.big else "false"
        text = comment(_described(field))
        if field.type is FieldType.GROUP:
            return self._group(field, levels, used)
        table, times, length = self._length(field, levels, used, tables)
        fills = integer(field.sizes.fills, 16) if field.sizes is not None and field.sizes.fills is not None else ""
        step = partial(Step, name=name, big=big, length=length, table=table, times=times, fills=fills)
        if field.constant is not None:
            value = integer(field.constant % (1 << _WIDTHS[-1]), _WIDTHS[-1], hexadecimal=True)
            negative = "true" if field.constant < 0 else "false"
            return step("constant", value=value, negative=negative)
        width = number_width(field)
        if width is None:
            return step("bytes", member_type="drivespec_slice", comment=text)
        signed = field.type is FieldType.INT
        kind = f"{'' if signed else 'u'}int{width}_t"
        return step("number", member_type=kind, comment=text, signed=signed)

    def _group(self, field: Field, levels: tuple[_Level, ...], used: set[int]) -> Step:
        stem = f"{levels[-1].stem}_{field.name}"
        inner = self.codec(stem, f"Element of {field.title}", [field.description], field.fields, levels)
        used |= inner
        here = len(levels) - 1
        outers = "".join("telegram, " if level == here else f"outer{level}, " for level in sorted(inner))
        count = _reference(field.count, levels, used) if field.count is not None else ""
        text = comment(_described(field))
        return Step("group", _member(field), "", f"{stem}_list", text, element=stem, outers=outers, count=count)

    def _length(
        self, field: Field, levels: tuple[_Level, ...], used: set[int], tables: list[SizeTable]
    ) -> tuple[str, str, str]:
        """Call of the function for the length, factor, and the expression of the length after both."""
        if field.sizes is None:
            if isinstance(field.length, str):
                return "", "", _reference(field.length, levels, used)
            return "", "", integer(field.length, 16) if field.length is not None else ""
        function = self._names.claim(f"{levels[-1].stem}_{field.name}_size", field.where)
        sizes: dict[int, list[int]] = {}
        for value, size in field.sizes.sizes:
            sizes.setdefault(size, []).append(value)
        cases = [Case(tuple(map(_case, values)), integer(size, 16)) for size, values in sizes.items()]
        tables.append(SizeTable(function, comment(f"Bytes of {field.title} by {field.sizes.by}."), tuple(cases)))
        times = _reference(field.sizes.times, levels, used) if field.sizes.times is not None else ""
        return f"{function}({_reference(field.sizes.by, levels, used)}, &length)", times, "length"

    def _accessors(self, stem: str, field: Field) -> Iterator[Accessor]:
        width = number_width(field)
        if width is None or field.constant is not None:
            return
        wide = max(width, 32)
        sign = "" if field.type is FieldType.INT else "u"
        for part in field.bits:
            get = self._names.claim(f"{stem}_get_{field.name}_{part.label}", field.where)
            bits = part.high - part.low + 1
            yield Accessor(
                get=get,
                set=self._names.claim(f"{stem}_set_{field.name}_{part.label}", field.where),
                member=_member(field),
                member_type=f"{sign}int{width}_t",
                wide=f"uint{wide}_t",
                type=f"uint{_width(bits)}_t",
                mask=integer(part.mask, wide, hexadecimal=True),
                shift=integer(part.low, 8),
                width=integer(bits, 8),
                checked=bits < _width(bits),
                label=comment(f"{field.title}, {_bits(part)}: {part.label}"),
                comment=comment(f"Set {field.title}, {_bits(part)}: {part.label}"),
            )

    def _sections(self, stem: str, title: str, fields: Sequence[Field]) -> tuple[Section, ...]:
        """Constants of the fields: the only values, and the selection lists."""
        writer = Writer(self._names, stem.upper(), title, self._where)
        smallest, fixed = _extent(fields)
        writer.number("SIZE" if fixed else "SIZE_MIN", smallest, "bytes" if fixed else "bytes at least")
        for field in fields:
            if field.constant is not None:
                text = f"{field.title}, the only value"
                writer.number(f"{field.name.upper()}_VALUE", field.constant, text, 8, hexadecimal=field.constant >= 0)
        for field in fields:
            selections = [("", "", field.values)]
            selections += [(f"_{part.upper()}", f", part {part}", options) for part, options in field.bit_values]
            for suffix, part, options in selections:
                lists = Writer(self._names, stem.upper(), f"Values of {field.title}{part}", field.where)
                lists.options(f"{field.name.upper()}{suffix}", options, DataType.UNSIGNED32)
                writer.include(lists)
        return (writer.section(f"Values of {title}", []),)


def number_width(field: Field) -> int | None:
    """Bits of the integer type that holds a field, ``None`` where it is no number or may be wider than any."""
    if field.type not in (FieldType.UINT, FieldType.INT):
        return None
    if field.sizes is not None:
        longest = field.sizes.longest
    else:
        longest = field.length if isinstance(field.length, int) else None
    return None if longest is None or longest > _LARGEST else _width(8 * longest)


def _width(bits: int) -> int:
    return next(width for width in _WIDTHS if bits <= width)


def _extent(fields: Sequence[Field]) -> tuple[int, bool]:
    """Least length in bytes, and whether there is no other."""
    least, fixed = 0, True
    for field in fields:
        if isinstance(field.length, int):
            least += field.length
        elif field.sizes is not None and field.sizes.times is None and field.sizes.fills is None:
            sizes = [size for _, size in field.sizes.sizes]
            least += min(sizes)
            fixed = fixed and len(set(sizes)) == 1
        else:
            fixed = False
    return least, fixed


def _member(field: Field) -> str:
    return safe(field.name, "c")


def _described(field: Field) -> str:
    return f"{field.title}. {field.description}" if field.description else f"{field.title}."


def _bits(part: BitField) -> str:
    return f"bit {part.low}" if part.low == part.high else f"bits {part.low} ... {part.high}"


def _case(value: int) -> str:
    return integer(value % (1 << _WIDTHS[-1]), _WIDTHS[-1], hexadecimal=True)


def _reference(name: str, levels: tuple[_Level, ...], used: set[int]) -> str:
    """Expression of an earlier field's value; the level it stands on goes to ``used``."""
    for level in reversed(range(len(levels))):
        for field in levels[level].fields:
            if field.name == name:
                if field.constant is not None:
                    return _case(field.constant)
                used.add(level)
                pointer = "telegram" if level == len(levels) - 1 else f"outer{level}"
                if number_width(field) is None:
                    return f"drivespec_get({pointer}->{_member(field)}, {'true' if field.big else 'false'})"
                return f"(uint64_t){pointer}->{_member(field)}"
    raise ValueError(f"no field '{name}'")


def filled(layout: Layout, data: Sequence[int | None]) -> bytes:
    """Bytes of a worked telegram with the open ones filled: constants by their value, others with 0."""
    octets = encode(layout, _without_constants(layout.fields, decode(layout, data)))
    return bytes(octet or 0 for octet in octets)


def _without_constants(fields: Sequence[Field], values: Values) -> Values:
    kept: Values = {}
    for field in fields:
        value = values[field.name]
        if isinstance(value, tuple):
            kept[field.name] = tuple(_without_constants(field.fields, entry) for entry in value)
        elif field.constant is None:
            kept[field.name] = value
    return kept


def _vector(example: Example, layout: Layout, device: Device, levels: Mapping[str, tuple[int, ...]]) -> Vector:
    stem = snake(device.id, layout.id)
    return Vector(
        name=string(example.id),
        comment=comment(f"{example.name}. {cited(example.cite)}"),
        stem=stem,
        octets=", ".join(f"0x{octet:02X}u" for octet in filled(layout, example.data)),
        checks=tuple(_checks(stem, ("telegram",), layout.fields, example.values, levels)),
    )


def _checks(
    stem: str, items: tuple[str, ...], fields: Sequence[Field], values: Values, levels: Mapping[str, tuple[int, ...]]
) -> Iterator[str]:
    """Statements that compare the innermost of the decoded structures ``items`` with the printed values."""
    for field in fields:
        if field.constant is not None:
            continue
        value = values.get(field.name, OPEN)
        if isinstance(value, tuple):
            yield from _group_checks(stem, items, field, value, levels)
        elif value != OPEN:
            yield _field_check(items[-1], field, value)
        for part in field.bits:
            bits = values.get(f"{field.name}.{part.label}", OPEN)
            if isinstance(bits, int):
                yield f"CHECK({stem}_get_{field.name}_{part.label}(&{items[-1]}) == {integer(bits, 32)});"


def _field_check(item: str, field: Field, value: int | str) -> str:
    member = f"{item}.{_member(field)}"
    if isinstance(value, int):
        width = number_width(field) or _WIDTHS[-1]
        return f"CHECK({member} == {integer(value, width, signed=field.type is FieldType.INT)});"
    raw = value.encode("latin-1") if field.type is FieldType.TEXT else bytes.fromhex(value)
    octets = "".join(f"\\{octet:03o}" for octet in raw)
    return f'CHECK(same({member}, "{octets}", {integer(len(raw), 16)}));'


def _group_checks(
    stem: str,
    items: tuple[str, ...],
    field: Field,
    entries: tuple[Values, ...],
    levels: Mapping[str, tuple[int, ...]],
) -> Iterator[str]:
    member, element = f"{items[-1]}.{_member(field)}", f"{stem}_{field.name}"
    item, cursor = f"item{len(items)}", f"cursor{len(items)}"
    outers = "".join(f"&{items[level]}, " for level in levels[element])
    yield f"CHECK({member}.count == {integer(len(entries), 16)});"
    yield "{"
    yield f"drivespec_cursor {cursor} = {{ {member}.raw, {member}.count }};"
    yield f"{element}_t {item};"
    for entry in entries:
        yield f"CHECK({element}_next({outers}&{cursor}, &{item}));"
        yield "{"
        yield from _checks(element, (*items, item), field.fields, entry, levels)
        yield "}"
    yield "}"
