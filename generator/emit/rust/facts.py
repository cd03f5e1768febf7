"""Facts of the model as Rust expressions of the records in module ``types`` of the crate."""

from fractions import Fraction
from math import ceil, floor

from generator.emit.rust.syntax import (
    Expression,
    Group,
    array,
    boolean,
    hexadecimal,
    prefixed,
    some,
    string,
    struct,
    type_name,
)
from generator.emit.switches import remarks
from generator.model import (
    Access,
    Bit,
    BitField,
    CanOpenFacts,
    Cite,
    CobId,
    CodeRef,
    DataType,
    Default,
    Drive,
    Erratum,
    ErratumPlace,
    ErrorEntry,
    IndicatorTable,
    Led,
    Manual,
    NodeRelative,
    ObjectRef,
    Origin,
    Pattern,
    Range,
    Slot,
    SwitchGroup,
    SwitchRow,
)

OBJECT_KINDS = {"canopen": "CanOpen", "profidrive": "Profidrive"}
"""Variants of ``ObjectKind``, in the order of a table of objects."""

OBJECT_TYPES = {"VAR": "Var", "ARRAY": "Array", "RECORD": "Record"}
"""Variants of ``ObjectType``."""

ENTRY_ACCESSES = {"ro": "Ro", "wo": "Wo", "rw": "Rw", "const": "Const", "rwr": "Rwr", "rww": "Rww"}
"""Variants of ``EntryAccess``."""


def text(value: str | None) -> Expression:
    """Optional text."""
    return some(None if value is None else string(value))


def number(value: int | None, digits: int = 0) -> Expression:
    """Optional number, hexadecimal where ``digits`` is not 0."""
    return some(None if value is None else literal(value, digits))


def literal(value: int, digits: int = 0) -> str:
    """Number, hexadecimal where ``digits`` is not 0."""
    return hexadecimal(value, digits) if digits else str(value)


def texts(values: tuple[str, ...]) -> Expression:
    """Reference to an array of texts."""
    return array(map(string, values))


def data_type(value: DataType) -> str:
    """Variant of ``DataType``."""
    return f"DataType::{type_name(value.canopen_name)}"


def integer(value: DataType, signed: bool) -> str:
    """Integer type of the width of a data type of numbers: "u8", "i32", ..."""
    return f"{'i' if signed else 'u'}{value.bits}"


def origin(value: Origin) -> str:
    """Variant of ``Origin``."""
    return f"Origin::{type_name(value.value)}"


def cite(value: Cite) -> Expression:
    """Record ``Cite``."""
    return struct(
        "Cite",
        [("manual", string(value.manual)), ("chapter", string(value.chapter)), ("page", number(value.page))],
    )


def manual(value: Manual) -> Expression:
    """Record ``Manual``."""
    return struct(
        "Manual",
        [
            ("id", string(value.id)),
            ("title", string(value.title)),
            ("publisher", string(value.publisher)),
            ("edition", string(value.edition)),
            ("date", text(value.date)),
            ("document", text(value.document)),
        ],
    )


def wire_range(value: Range | None, scaling: int | None, digits: int) -> Expression:
    """Optional record ``Range``: the wire values, which are integers, between the bounds."""
    if value is None:
        return "None"
    low, high = ceil(value.low * (scaling or 1)), floor(value.high * (scaling or 1))
    bounds = [("low", literal(low, digits)), ("high", literal(high, digits))]
    return some(struct("Range", [*bounds, ("unit", string(value.unit))]))


def node_relative(value: NodeRelative) -> Expression:
    """Record ``NodeRelative``."""
    return struct("NodeRelative", [("base", hexadecimal(value.base, 3))])


def default(value: Default | None, digits: int) -> Expression:
    """Optional ``Value``; numbers are hexadecimal where ``digits`` is not 0."""
    match value:
        case None:
            return "None"
        case int():
            return some(f"Value::Number({literal(value, digits)})")
        case str():
            return some(f"Value::Text({string(value)})")
        case NodeRelative():
            return some(prefixed("Value::NodeRelative(", node_relative(value), ")"))


def bit(value: Bit) -> Group:
    """Record ``Bit``."""
    return struct("Bit", [("number", str(value.number)), ("label", string(value.label))])


def bit_field(value: BitField) -> Group:
    """Record ``BitField``."""
    return struct("BitField", [("low", str(value.low)), ("high", str(value.high)), ("label", string(value.label))])


def access(value: Access) -> Expression:
    """Record ``Access``."""
    return struct(
        "Access",
        [("read", boolean(value.read)), ("write", boolean(value.write)), ("conditions", texts(value.conditions))],
    )


def code_ref(value: CodeRef) -> Expression:
    """Record ``CodeRef``."""
    return struct("CodeRef", [("number", str(value.number)), ("subcode", number(value.subcode))])


def object_ref(value: ObjectRef) -> Expression:
    """Record ``ObjectRef``."""
    return struct("ObjectRef", [("index", hexadecimal(value.index, 4)), ("subindex", number(value.subindex))])


def slot(value: Slot) -> Expression:
    """Record ``Slot``."""
    return struct(
        "Slot",
        [
            ("name", string(value.name)),
            ("first_code", str(value.first_code)),
            ("last_code", str(value.last_code)),
            ("code_offset", str(value.code_offset)),
            ("error_offset", hexadecimal(value.error_offset, 8)),
        ],
    )


def can_open(value: CanOpenFacts) -> Expression:
    """Record ``CanOpen``."""
    return struct(
        "CanOpen",
        [
            ("baud_rates", array(map(str, value.baud_rates))),
            ("granularity", str(value.granularity)),
            ("node_address", number(value.node_address)),
            ("boot_up_master", boolean(value.boot_up_master)),
        ],
    )


def drive(value: Drive, field_names: tuple[str, ...]) -> Expression:
    """Record ``Drive``; ``field_names`` are the constants of the fields of the error number."""
    error_fields = [
        struct("ErrorField", [("name", string(name)), ("bits", field)])
        for (name, _), field in zip(value.error_fields, field_names, strict=True)
    ]
    return struct(
        "Drive",
        [
            ("id", string(value.id)),
            ("title", string(value.title)),
            ("manufacturer", string(value.manufacturer)),
            ("index_base", hexadecimal(value.index_base, 4)),
            ("error_fields", array(error_fields)),
            ("responses", "Response::CHOICES" if value.responses else "&[]"),
            ("modules", "Module::CHOICES" if value.modules else "&[]"),
            ("commands", "Command::CHOICES" if value.commands else "&[]"),
        ],
    )


def help_texts(value: ErrorEntry) -> Expression:
    """Record ``Help``."""
    return struct("Help", [("causes", texts(value.causes)), ("remedies", texts(value.remedies))])


def indicator(value: IndicatorTable) -> Expression:
    """Record ``IndicatorTable``."""
    rows = [
        struct(
            "IndicatorRow",
            [
                ("patterns", array(map(_pattern, row.patterns))),
                ("state", string(row.state)),
                ("meaning", string(row.meaning)),
                ("origin", origin(row.origin)),
                ("cite", cite(row.cite)),
            ],
        )
        for row in value.rows
    ]
    return struct(
        "IndicatorTable",
        [
            ("id", string(value.id)),
            ("name", string(value.name)),
            ("leds", array(map(_led, value.leds))),
            ("rows", array(rows)),
            ("cite", cite(value.cite)),
            ("errata", texts(value.errata)),
        ],
    )


def _led(value: Led) -> Expression:
    return struct(
        "Led", [("label", string(value.label)), ("colour", string(value.colour)), ("name", string(value.name))]
    )


def _pattern(value: Pattern) -> Expression:
    light = f"Light::{type_name(value.light.value)}"
    if value == Pattern(value.light):
        return f"Pattern::of({light})"
    return struct(
        "Pattern",
        [
            ("light", light),
            ("colour", text(value.colour)),
            ("period", number(milliseconds(value.period))),
            ("flashes", number(value.flashes)),
            ("pause", number(milliseconds(value.pause))),
        ],
    )


def milliseconds(value: Fraction | None) -> int | None:
    """Seconds as whole milliseconds."""
    return None if value is None else round(1000 * value)


def switches(value: SwitchGroup) -> Expression:
    """Record ``SwitchGroup``."""
    valid = None if value.valid is None else f"({value.valid[0]}, {value.valid[1]})"
    return struct(
        "SwitchGroup",
        [
            ("id", string(value.id)),
            ("name", string(value.name)),
            ("labels", texts(value.labels)),
            ("weights", array(map(str, value.weights))),
            ("valid", some(valid)),
            ("unit", string(value.unit)),
            ("sets", array(map(code_ref, value.sets))),
            ("rows", array(map(_switch_row, value.rows))),
            ("notes", texts(remarks(value))),
            ("origin", origin(value.origin)),
            ("cite", cite(value.cite)),
            ("errata", texts(value.errata)),
        ],
    )


def _switch_row(value: SwitchRow) -> Expression:
    return struct(
        "SwitchRow",
        [
            ("value", string(value.value)),
            ("number", number(int(value.value) if value.value.isdecimal() else None)),
            ("on", _switch_mask(value, "1")),
            ("either", _switch_mask(value, "x")),
        ],
    )


def _switch_mask(value: SwitchRow, position: str) -> str:
    return "0b" + "".join(str(int(found == position)) for found in value.positions)


def cob_id(value: CobId) -> Expression:
    """Record ``CobId``."""
    return struct(
        "CobId",
        [
            ("name", string(value.name)),
            ("base", hexadecimal(value.base, 3)),
            ("broadcast", boolean(value.broadcast)),
            ("objects", array(map(object_ref, value.objects))),
        ],
    )


def erratum(value: Erratum) -> Expression:
    """Record ``Erratum``."""
    return struct(
        "Erratum",
        [
            ("id", string(value.id)),
            ("kind", string(value.kind)),
            ("about", texts(value.about_text)),
            ("printed", string(value.printed_text)),
            ("used", string(value.used_text)),
            ("places", array(map(_erratum_place, value.places))),
            ("why", string(value.why)),
            ("confidence", string(value.confidence)),
            ("origin", string(value.origin)),
        ],
    )


def _erratum_place(value: ErratumPlace) -> Expression:
    return struct(
        "ErratumPlace",
        [
            ("location", string(value.location)),
            ("page", number(value.page)),
            ("manual", string(value.manual)),
            ("printed", string(value.printed)),
        ],
    )
