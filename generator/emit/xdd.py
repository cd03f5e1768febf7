"""XDD files (CiA 311, XML device descriptions): one for each CANopen device, slot and product.

They say what the EDS of the same name says; names keep the characters that an EDS cannot hold.
"""

from dataclasses import dataclass

from generator import VERSION
from generator.emit.base import EmitError, Output, Target
from generator.emit.canopen import (
    RPDO_PARAMETERS,
    TPDO_PARAMETERS,
    BusObject,
    Entry,
    ObjectDictionary,
    named_dictionaries,
    number_text,
)
from generator.emit.eds import caption, file_stem, lists, remarks
from generator.emit.environment import render as render_template
from generator.model import DataType, Model, NodeRelative, Where

_BIT_RATES = (10, 20, 50, 100, 125, 250, 500, 800, 1000)
"""Bit rates in kbit/s that the schema allows."""
_OBJECT_TYPES = {"VAR": "7", "ARRAY": "8", "RECORD": "9"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Value:
    """Attributes of an object or sub-object; those that are "" are left out."""

    number: str
    name: str
    object_type: str
    data_type: str = ""
    low: str = ""
    high: str = ""
    access: str = ""
    default: str = ""
    mapping: str = ""
    sub_number: str = ""
    subs: "tuple[Value, ...]" = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Head:
    """What the file says of itself; the date is that of the spec's release."""

    name: str
    creator: str
    date: str
    version: str
    caption: str
    notice: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Identity:
    """What the device says it is; ``versions`` holds (type, text)."""

    vendor_name: str
    vendor_id: str
    product_name: str
    product_id: str
    order_number: str
    versions: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Network:
    """Bit rates and general features."""

    bit_rates: tuple[str, ...]
    granularity: int
    rpdos: int
    tpdos: int
    boot_up_master: str


@dataclass(frozen=True, slots=True)
class ObjectList:
    """All objects in ascending order, and how many of each of the three lists they are."""

    mandatory: int
    optional: int
    manufacturer: int
    objects: tuple[Value, ...]


def render(model: Model) -> dict[str, Output]:
    """XDD files of all CANopen devices by file name.

    Raises:
        EmitError: A text cannot be written in XML, or two files would share a name.
    """
    outputs: dict[str, Output] = {}
    rendered: dict[BusObject, Value] = {}
    for name, dictionary in named_dictionaries(model, "XDD", file_name):
        for entry in dictionary.objects:
            if entry not in rendered:
                rendered[entry] = _object(entry)
        outputs[name] = Output(_text(model, dictionary, name, rendered))
    return outputs


TARGET = Target("xdd", render)


def file_name(dictionary: ObjectDictionary) -> str:
    """Name of the XDD."""
    return f"{file_stem(dictionary)}.xdd"


def _text(model: Model, dictionary: ObjectDictionary, file_name: str, rendered: dict[BusObject, Value]) -> str:
    mandatory, optional, manufacturer = (len(entries) for _, entries in lists(dictionary))
    return render_template(
        "xdd/device.xdd.xml.j2",
        head=_head(model, dictionary, file_name),
        identity=_identity(dictionary),
        network=_network(dictionary),
        remarks=remarks(model, dictionary),
        list=ObjectList(mandatory, optional, manufacturer, tuple(rendered[entry] for entry in dictionary.objects)),
    )


def _head(model: Model, dictionary: ObjectDictionary, file_name: str) -> Head:
    return Head(
        name=file_name,
        creator=f"drivespec {VERSION}",
        date=model.date,
        version=model.version,
        caption=caption(dictionary),
        # Two hyphens would end the comment.
        notice=remarks(model, dictionary)[0].replace("--", "- -"),
    )


def _identity(dictionary: ObjectDictionary) -> Identity:
    device, product = dictionary.device, dictionary.product
    versions = (("SW", device.software_version), ("HW", device.hardware_version))
    return Identity(
        vendor_name=device.manufacturer,
        vendor_id=f"0x{product.vendor_number:08X}",
        product_name=product.label or device.title,
        product_id=f"0x{product.product_number:08X}",
        order_number=device.order_code,
        versions=tuple((kind, version) for kind, version in versions if version),
    )


def _network(dictionary: ObjectDictionary) -> Network:
    facts = dictionary.facts
    bit_rates = tuple(f"{rate} Kbps" for rate in facts.baud_rates if rate in _BIT_RATES)
    if not bit_rates:
        raise EmitError("object-value", dictionary.device.where, "an XDD can name none of the bit rates")
    return Network(
        bit_rates=bit_rates,
        granularity=facts.granularity,
        rpdos=len(dictionary.of_standard(RPDO_PARAMETERS)),
        tpdos=len(dictionary.of_standard(TPDO_PARAMETERS)),
        boot_up_master="true" if facts.boot_up_master else "false",
    )


def _object(entry: BusObject) -> Value:
    number = f"{entry.index:04X}"
    if entry.object_type == "VAR":
        return _value(number, entry.name, entry.entries[0])
    return Value(
        number=number,
        name=_plain(entry.name, entry.where),
        object_type=_OBJECT_TYPES[entry.object_type],
        sub_number=str(len(entry.entries)),
        subs=tuple(_value(f"{value.subindex:02X}", value.name, value) for value in entry.entries),
    )


def _value(number: str, name: str, entry: Entry) -> Value:
    return Value(
        number=number,
        name=_plain(name, entry.where),
        object_type=_OBJECT_TYPES["VAR"],
        data_type=f"{entry.data_type.canopen_number:02X}",
        low="" if entry.low is None else str(entry.low),
        high="" if entry.high is None else str(entry.high),
        access=entry.access,
        default=_default(entry),
        mapping="optional" if entry.mappable else "no",
    )


def _default(entry: Entry) -> str:
    default = entry.default
    if default is None:
        return ""
    if isinstance(default, NodeRelative):
        return f"$NODEID+0x{default.base:X}"
    if isinstance(default, int):
        return number_text(entry, default)
    if entry.data_type is not DataType.VISIBLE_STRING:
        return default.encode("utf-8").hex().upper()
    return _plain(default, entry.where)


def _plain(text: str, where: Where) -> str:
    """``text``, which XML and its attributes keep as it is.

    Raises:
        EmitError: It has a character that XML cannot hold, or a line end.
    """
    if not text.isprintable():
        raise EmitError("object-value", where, f"an XDD cannot hold the text {text!r}")
    return text
