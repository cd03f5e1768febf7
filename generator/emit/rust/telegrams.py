"""Telegrams of a device: a struct for each layout, and the code that takes it from bytes and puts it into bytes."""

from collections.abc import Iterable, Iterator, Sequence

from generator.emit import names
from generator.emit.base import EmitError
from generator.emit.rust import words
from generator.emit.rust.syntax import (
    constant_name,
    doc,
    hexadecimal,
    markdown,
    shorthand,
    statement,
    string,
    type_name,
)
from generator.emit.rust.views import Constant, Fields, Part, Sizes
from generator.model import BitField, Device, Erratum, Field, FieldType, Layout, Option, Where
from generator.naming import Scope, safe, snake

_WIDTHS = (8, 16, 32, 64)
_NUMBERS = (FieldType.UINT, FieldType.INT)


class Telegrams:
    """The structs of a device, in the order of its layouts, each behind those of its groups."""

    def __init__(self, device: Device) -> None:
        """Settle all names and code.

        Raises:
            EmitError: Two facts want one name, or a field has a form that the crate has no type for.
        """
        self.structs: list[Fields] = []
        self.sizes: list[Sizes] = []
        self._scope = Scope(f"telegrams of {device.id}")
        self._tables: dict[tuple[object, ...], str] = {}
        self._errata = {erratum.id: erratum for erratum in device.errata}
        for entry in device.layouts:
            comment = doc(
                [words.headline(entry.name), markdown(entry.description)],
                words.layout_points(entry, _cases(entry, device.layouts), self._explained(entry)),
            )
            self._add(telegram_name(entry), entry.fields, comment, entry.where, True)

    @property
    def used(self) -> str:
        """What the module imports from module ``codec``, as an import names it."""
        groups = any("Repeated<" in field.type for struct in self.structs for field in struct.fields)
        return ", ".join(
            ["self", "DecodeError", "EncodeError", "Layout", "Reader", *(["Repeated"] if groups else []), "Writer"]
        )

    def _explained(self, entry: Layout) -> list[Erratum]:
        return [self._errata[id] for id in entry.errata if id in self._errata]

    def _add(self, name: str, fields: Sequence[Field], comment: str, where: Where, whole: bool) -> None:
        self._scope.add(name, where)
        for field in fields:
            _check(field, {earlier.name for earlier in fields})
            if field.type is FieldType.GROUP:
                title = [f"Entry of [`{name}::{field_name(field)}`]: {markdown(field.title)}."]
                self._add(entry_name(name, field), field.fields, doc(title), field.where, False)
        known = {field.name: field for field in fields}
        sizes = {field.name: self._size(name, field, known[field.sizes.by]) for field in fields if field.sizes}
        scope = Scope(f"constants and methods of {name}")
        for claimed in ("decode", "encode", "read", "write", "ENCODED_SIZE"):
            scope.add(claimed, where)
        local = {field_name(field) for field in fields}
        reader = _free("reader", local)
        writer = _free("writer", local)
        variables = [field for field in fields if field.constant is None]
        constants = [constant for field in fields for constant in _constants(field)]
        parts = [part for field in fields for part in _parts(field)]
        for constant in constants:
            scope.add(constant.name, where)
        for part in parts:
            scope.add(part.getter, where)
            scope.add(part.setter, where)
        self.structs.append(
            Fields(
                name=name,
                lifetime="<'a>" if any(_borrows(field) for field in fields) else "",
                doc=comment,
                whole=whole,
                size=_fixed_size(fields),
                fields=tuple(
                    Constant(_field_doc(field), field_name(field), field_type(name, field), "") for field in variables
                ),
                constants=tuple(constants),
                parts=tuple(parts),
                reader=reader,
                writer=writer,
                read=tuple(line for field in fields for line in _read(field, reader, sizes.get(field.name, ""), known)),
                write=tuple(
                    line for field in fields for line in _write(field, writer, sizes.get(field.name, ""), known)
                ),
                found=statement("let found =", shorthand("Self", map(field_name, variables)), 8)
                if variables
                else "let found = Self {};",
            )
        )

    def _size(self, struct: str, field: Field, by: Field) -> str:
        """Name of the function of the lengths of ``field``."""
        assert field.sizes is not None
        kind = field_type(struct, by)
        key = (kind, field.sizes.sizes)
        if key not in self._tables:
            self._tables[key] = self._scope.add(f"{snake(_split(struct), field.name)}_size", field.where)
            digits = 2 * by.length if isinstance(by.length, int) else 2
            arms = tuple((hexadecimal(value, digits), size) for value, size in field.sizes.sizes)
            self.sizes.append(Sizes(self._tables[key], kind, arms))
        return self._tables[key]


def telegram_name(entry: Layout) -> str:
    """Name of the struct of a layout."""
    return type_name(entry.id)


def entry_name(struct: str, field: Field) -> str:
    """Name of the struct of an entry of a group."""
    return f"{struct}{type_name(field.name)}Entry"


def field_name(field: Field) -> str:
    """Name of a field, also of the variable that holds it."""
    return safe(snake(field.name), "rust")


def field_type(struct: str, field: Field) -> str:
    """Type of a field of ``struct``."""
    if field.type is FieldType.GROUP:
        name = entry_name(struct, field)
        return f"Repeated<'a, {name}{_lifetime(field.fields)}>"
    if field.type not in _NUMBERS:
        return "&'a [u8]"
    return f"{'i' if field.type is FieldType.INT else 'u'}{_bits(field)}"


def constants_of_values(field: Field) -> list[tuple[str, Option]]:
    """Names of the constants of the values of a field."""
    own = names.option_names(field.values)
    return [(constant_name(snake(field.name, name)), option) for name, option in zip(own, field.values, strict=True)]


def part_name(field: Field, part: BitField) -> str:
    """Name of the method that reads a group of bits."""
    return safe(snake(field.name, part.label), "rust")


def _split(struct: str) -> str:
    """Name in ``PascalCase`` as words.

    >>> _split("Dpv1ReadResponseValuesEntry")
    'Dpv1 Read Response Values Entry'
    """
    return "".join(f" {letter}" if letter.isupper() else letter for letter in struct).strip()


def _check(field: Field, known: set[str]) -> None:
    """Refuse what the crate has no type for."""
    references = [field.count, field.length, *((field.sizes.by, field.sizes.times) if field.sizes else ())]
    if any(isinstance(name, str) and name not in known for name in references):
        raise EmitError(
            "telegram-field",
            field.where,
            f"field '{field.name}' depends on a field outside of its group",
            "repeat the field in the group",
        )
    if field.type in _NUMBERS:
        longest = _longest(field)
        if longest is None or longest > _WIDTHS[-1] // 8:
            raise EmitError(
                "telegram-field",
                field.where,
                f"field '{field.name}' is a number of more than {_WIDTHS[-1] // 8} bytes or of any length",
                "make it 'bytes'",
            )


def _longest(field: Field) -> int | None:
    if field.sizes:
        return field.sizes.longest
    return field.length if isinstance(field.length, int) else None


def _bits(field: Field) -> int:
    return next(width for width in _WIDTHS if 8 * (_longest(field) or 0) <= width)


def _natural(field: Field) -> bool:
    """Whether the field takes all bytes of its type."""
    return field.sizes is None and isinstance(field.length, int) and 8 * field.length == _bits(field)


def _borrows(field: Field) -> bool:
    return field.type not in _NUMBERS


def _lifetime(fields: Iterable[Field]) -> str:
    return "<'a>" if any(map(_borrows, fields)) else ""


def _fixed_size(fields: Sequence[Field]) -> str:
    lengths = [field.length for field in fields if isinstance(field.length, int)]
    return str(sum(lengths)) if len(lengths) == len(fields) else ""


def _cases(entry: Layout, layouts: Iterable[Layout]) -> list[str]:
    """Markup of the layouts that are ``entry`` with more of its fields constant, and of these constants."""
    size, places, own = _fixed_size(entry.fields), dict(_places(entry.fields)), _constant_places(entry.fields)
    alike = [other for other in layouts if other.protocol == entry.protocol and _fixed_size(other.fields) == size != ""]
    found = []
    for other in alike:
        theirs = _constant_places(other.fields)
        if theirs.items() > own.items() and theirs.keys() <= places.keys():
            more = ", ".join(f"`{place[1]}` 0x{theirs[place]:02X}" for place in theirs if place not in own)
            found.append(f"[`{telegram_name(other)}`] ({more})")
    return found


def _constant_places(fields: Sequence[Field]) -> dict[tuple[int, str], int]:
    return {place: value for place, value in _places(fields) if value is not None}


def _places(fields: Sequence[Field]) -> Iterator[tuple[tuple[int, str], int | None]]:
    """First byte, name and constant of each field of a layout without open lengths."""
    place = 0
    for field in fields:
        yield (place, field.name), field.constant
        place += field.length if isinstance(field.length, int) else 0


def _free(name: str, taken: set[str]) -> str:
    return f"{name}_" if name in taken else name


def _field_doc(field: Field) -> str:
    latin = "Characters of Latin-1." if field.type is FieldType.TEXT else ""
    return doc([words.headline(field.title), markdown(field.description), latin], indent=4)


def _literal(value: int, field: Field) -> str:
    return hexadecimal(value, _bits(field) // 4)


def _constants(field: Field) -> list[Constant]:
    """Constant of a field with one value, else those of its values, and those of the values of its bits."""
    found: list[Constant] = []
    name = field_name(field)
    if field.type not in _NUMBERS:
        return found
    kind = field_type("", field)
    if field.constant is not None:
        comment = doc([words.headline(field.title), markdown(field.description)], indent=4)
        found.append(Constant(comment, constant_name(name), kind, _literal(field.constant, field)))
    else:
        for constant, option in constants_of_values(field):
            comment = doc([f"Value of `{name}`: {words.headline(option.label)}"], indent=4)
            found.append(Constant(comment, constant, kind, _literal(option.value, field)))
    labels = {part.label: part for part in field.bits}
    for label, options in field.bit_values:
        part = labels[label]
        for own, option in zip(names.option_names(options), options, strict=True):
            comment = doc([f"Value of `{part_name(field, part)}`: {words.headline(option.label)}"], indent=4)
            constant = constant_name(snake(field.name, label, own))
            found.append(Constant(comment, constant, _part_type(part), _part_literal(part, option.value)))
    return found


def _part_type(part: BitField) -> str:
    width = part.high - part.low + 1
    return "bool" if width == 1 else f"u{next(known for known in _WIDTHS if width <= known)}"


def _part_literal(part: BitField, value: int) -> str:
    return ("false", "true")[value] if _part_type(part) == "bool" else str(value)


def _parts(field: Field) -> list[Part]:
    return [_part(field, part) for part in field.bits]


def _part(field: Field, part: BitField) -> Part:
    bits, kind = _bits(field), _part_type(part)
    mask, own = hexadecimal(part.mask, bits // 4), f"u{bits}"
    signed = field.type is FieldType.INT
    value = f"Self::{constant_name(field_name(field))}" if field.constant is not None else f"self.{field_name(field)}"
    plain = f"({value} as {own})" if signed else value
    whole = part.low == 0 and part.high == bits - 1
    masked = plain if whole else f"{plain} & {mask}"
    shifted = masked if part.low == 0 else f"({masked}) >> {part.low}"
    cast = "" if kind == own else f" as {kind}"
    inner = f"({shifted}){cast}" if cast and shifted != plain else f"{shifted}{cast}"
    raised = "value" if kind == own else f"(value as {own})"
    raised = raised if part.low == 0 else f"({raised} << {part.low})"
    written = raised.removeprefix("(").removesuffix(")") if whole else f"({plain} & !{mask}) | {raised}"
    limit = 1 << (part.high - part.low + 1)
    name = snake(field.name, part.label)
    return Part(
        getter=part_name(field, part),
        setter=f"with_{name}",
        doc=f"`{markdown(part.label)}` of `{field_name(field)}`, "
        + (f"bit {part.low}." if part.low == part.high else f"bits {part.low} ... {part.high}."),
        label=string(f"{field.name}.{part.label}"),
        field=field_name(field),
        type=kind,
        read=f"{masked} != 0" if kind == "bool" else inner,
        written="" if field.constant is not None else f"({written}) as i{bits}" if signed else written,
        limit="" if kind == "bool" or f"u{limit.bit_length() - 1}" == kind else hexadecimal(limit - 1, 2),
    )


def _value(field: Field, receiver: str) -> str:
    """Expression of the value of a field that others depend on; ``receiver`` is "self." or ""."""
    if field.constant is not None:
        return f"Self::{constant_name(field_name(field))}"
    return f"{receiver}{field_name(field)}"


def _length(field: Field, known: dict[str, Field], receiver: str) -> str:
    """Argument that tells the number of bytes of a field, or of the values in it where each has a length by itself."""
    if field.sizes and field.sizes.fills is not None:
        return "1"
    name = field.sizes.times if field.sizes else field.length
    if isinstance(name, str):
        return f"codec::length({_value(known[name], receiver)})"
    return "1" if field.sizes else str(name)


def _size_of(field: Field, size: str, known: dict[str, Field], receiver: str) -> tuple[str, list[str]]:
    """Variable that holds the length of one value by another field, and the statement that looks it up."""
    if field.sizes is None:
        return "", []
    variable = _free("size", {field_name(other) for other in known.values()})
    lines = [f"let {variable} = {size}({_value(known[field.sizes.by], receiver)});"]
    if field.sizes.fills is not None:
        times = "1" if field.sizes.times is None else f"codec::length({_value(known[field.sizes.times], receiver)})"
        lines.append(f"let {variable} = codec::missing({variable}, {times}, {field.sizes.fills});")
    return variable, lines


def _read(field: Field, reader: str, size: str, known: dict[str, Field]) -> list[str]:
    name, label = field_name(field), string(field.name)
    if field.type is FieldType.GROUP:
        taken = f"group(codec::length({_value(known[field.count], '')}))" if field.count else "groups()"
        return [f"let {name} = {reader}.{taken}?;"]
    if field.type not in _NUMBERS and field.sizes is None and field.length is None:
        return [f"let {name} = {reader}.rest();"]
    variable, lines = _size_of(field, size, known, "")
    length = _length(field, known, "")
    way = f"sized({label}, {variable}, {length})" if field.sizes else f"slice({label}, {length})"
    taken = f"{reader}.{way}?"
    if field.type in _NUMBERS:
        taken = _number_from(field, reader, label, taken)
    if field.constant is None:
        return [*lines, f"let {name} = {taken};"]
    return [
        *lines,
        f"if {taken} != Self::{constant_name(name)} {{",
        f"    return Err(DecodeError::Constant({label}));",
        "}",
    ]


def _number_from(field: Field, reader: str, label: str, octets: str) -> str:
    kind, order = field_type("", field), "big" if field.big else "little"
    if _natural(field):
        return f"{kind}::from_{'be' if field.big else 'le'}_bytes({reader}.array({label})?)"
    sign = "_signed" if field.type is FieldType.INT else ""
    number = f"codec::{order}{sign}({octets})"
    return number if kind[1:] == str(_WIDTHS[-1]) else f"{number} as {kind}"


def _write(field: Field, writer: str, size: str, known: dict[str, Field]) -> list[str]:
    label, value = string(field.name), _value(field, "self.")
    if field.type is FieldType.GROUP:
        counted = (
            [
                f"if {value}.len() != codec::length({_value(known[field.count], 'self.')}) {{",
                f"    return Err(EncodeError::Count({label}));",
                "}",
            ]
            if field.count
            else []
        )
        return [*counted, f"for entry in {value} {{", f"    {writer}.group(&entry)?;", "}"]
    if field.type in _NUMBERS and _natural(field):
        return [f"{writer}.bytes(&{value}.to_{'be' if field.big else 'le'}_bytes())?;"]
    if field.type not in _NUMBERS and field.sizes is None and field.length is None:
        return [f"{writer}.bytes({value})?;"]
    variable, lines = _size_of(field, size, known, "self.")
    if field.type in _NUMBERS:
        return [*lines, *_write_number(field, writer, label, value, variable)]
    length = _length(field, known, "self.")
    way = f"sized({label}, {value}, {variable}, {length})" if field.sizes else f"slice({label}, {value}, {length})"
    return [*lines, f"{writer}.{way}?;"]


def _write_number(field: Field, writer: str, label: str, value: str, variable: str) -> list[str]:
    order, length = "big" if field.big else "little", str(field.length)
    lines: list[str] = []
    if field.sizes:
        length = variable
        lines.append(f"let {length} = {variable}.ok_or(EncodeError::UnknownSize({label}))?;")
    wide = value if _bits(field) == _WIDTHS[-1] else f"u64::from({value})"
    if field.type is FieldType.INT:
        wide = value if _bits(field) == _WIDTHS[-1] else f"i64::from({value})"
        wide = f"codec::unsigned({label}, {wide}, {length})?"
    return [*lines, f"{writer}.{order}({label}, {wide}, {length})?;"]
