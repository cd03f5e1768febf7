"""What a CANopen master sees of a device: its object dictionary with the module in one slot, for one product.

This is the view that EDS files lay out; files and programs for other tools that need the same objects (device
configurations, device descriptions in XML, simulated slaves) start from it too.  Numbers are wire values.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from math import ceil, floor

from generator.emit.base import EmitError
from generator.model import (
    CanOpenFacts,
    Cite,
    Code,
    DataType,
    Default,
    Device,
    DictionaryObject,
    Model,
    NodeRelative,
    Option,
    Range,
    StandardObject,
    SubIndex,
    Where,
)

IDENTITY = 0x1018
"""Index of the identity object (CiA 301): vendor, product and revision number in sub-indexes 1, 2 and 3."""
COMMUNICATION_AREA = range(0x1000, 0x2000)
"""Objects that CiA 301 defines."""
MANUFACTURER_AREA = range(0x2000, 0x6000)
"""Objects that a manufacturer defines."""
OBJECTS = range(0x1000, 0x10000)
"""Objects that a device can have; below lie the data types."""
RPDO_PARAMETERS, TPDO_PARAMETERS = 0x1400, 0x1800
"""First of the communication parameters of receive and transmit PDOs, one object each."""
_MAPPINGS = (0x1600, 0x1A00)
"""First of the mapping parameters of receive and transmit PDOs, one object each."""

_COUNT_NAME = "Highest sub-index supported"


class Remark(Enum):
    """What was done to an entry beyond what the manual says."""

    COUNT_ASSUMED = "sub-index 0 is not printed"
    DEFAULT_ASSUMED = "no default is printed, but tools would take one that is not allowed"
    LIMITS_CUT = "the printed range is wider than the data type"
    LIMITS_LEFT_OUT = "the default lies outside the printed range"


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """A value that an SDO can address.

    ``low`` and ``high`` are both given or both ``None``.  ``name`` is unique in its object.  ``bit_coded`` values
    are shown in hexadecimal.  ``options`` is the selection list; without limits it holds all values there are.
    The wire value is the value in its unit times ``scaling``.  ``length``: longest string in bytes.
    """

    subindex: int
    name: str
    data_type: DataType
    access: str
    low: int | None
    high: int | None
    default: Default | None
    mappable: bool
    bit_coded: bool
    options: tuple[Option, ...]
    scaling: int
    length: int | None
    remarks: tuple[Remark, ...]
    where: Where


@dataclass(frozen=True, slots=True, kw_only=True)
class BusObject:
    """An object on the bus.

    ``object_type`` is "VAR" (one entry, sub-index 0), "ARRAY" (entries 1 ... n of one type) or "RECORD".
    ``standard``: the objects of the standard that it is one of.  ``designation`` leads back to the manual ("C13350",
    "I-1018").  ``refused`` holds (sub-index, abort code) of entries that the manual lists and the device refuses.
    """

    index: int
    designation: str
    name: str
    object_type: str
    standard: StandardObject | None
    entries: tuple[Entry, ...]
    refused: tuple[tuple[int, int], ...]
    cites: tuple[Cite, ...]
    errata: tuple[str, ...]
    where: Where

    def entry(self, subindex: int) -> Entry | None:
        """The value of that sub-index, ``None`` where the object has none."""
        return next((entry for entry in self.entries if entry.subindex == subindex), None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Product:
    """What the device says it is: ``label`` is "" where the manual names one product alone.

    ``unknown`` names the numbers that the manual does not give; they are 0.
    """

    label: str
    vendor_number: int
    product_number: int
    revision_number: int
    unknown: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class ObjectDictionary:
    """All objects of a device in ascending order, with the module in ``slot`` (``None`` for a device without)."""

    device: Device
    facts: CanOpenFacts
    slot: str | None
    product: Product
    objects: tuple[BusObject, ...]

    def of_standard(self, first: int) -> tuple[BusObject, ...]:
        """Objects of those that the standard defines from the index ``first`` on."""
        return tuple(entry for entry in self.objects if entry.standard and entry.standard.first == first)

    def object(self, index: int) -> BusObject | None:
        """The object of that index, ``None`` where the device has none."""
        return next((entry for entry in self.objects if entry.index == index), None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Configuration:
    """What one device on a bus is set to.

    ``node``: node-ID.  ``bit_rate`` in kbit/s.  ``values``: wire values by (index, sub-index).
    """

    node: int
    bit_rate: int
    values: Mapping[tuple[int, int], int | str]


def at_node(dictionary: ObjectDictionary, node: int) -> ObjectDictionary:
    """The dictionary with numbers in place of the rules over the node-ID."""
    return replace(dictionary, objects=tuple(_object_at_node(entry, node) for entry in dictionary.objects))


def _object_at_node(entry: BusObject, node: int) -> BusObject:
    if not any(isinstance(value.default, NodeRelative) for value in entry.entries):
        return entry
    entries = (
        replace(value, default=value.default.at(node)) if isinstance(value.default, NodeRelative) else value
        for value in entry.entries
    )
    return replace(entry, entries=tuple(entries))


def number_text(entry: Entry, value: int) -> str:
    """A wire value as files show it: hexadecimal with all digits where it is bit-coded, else decimal."""
    return f"0x{value:0{entry.data_type.bits // 4}X}" if entry.bit_coded and value >= 0 else str(value)


def object_dictionaries(device: Device) -> tuple[ObjectDictionary, ...]:
    """One object dictionary for each slot and product; none for a device without CANopen facts.

    Raises:
        EmitError: Two facts share an index, or an index lies outside the object dictionary.
    """
    if device.canopen is None:
        return ()
    nodes = device.canopen.node_addresses
    standard = _standard_objects(device, nodes)
    slots: list[str | None] = [slot.name for slot in device.slots]
    dictionaries = []
    for slot in slots or [None]:
        codes = [_code_object(code, nodes) for code in device.codes_of_slot(slot) if not code.internal]
        objects = _ordered([*standard, *codes])
        dictionaries += [
            ObjectDictionary(
                device=device,
                facts=device.canopen,
                slot=slot,
                product=product,
                objects=tuple(_identified(entry, product) if entry.index == IDENTITY else entry for entry in objects),
            )
            for product in _products(device)
        ]
    return tuple(dictionaries)


def named_dictionaries(
    model: Model, kind: str, name: Callable[[ObjectDictionary], str]
) -> Iterator[tuple[str, ObjectDictionary]]:
    """Every object dictionary with the name of its file; ``kind`` is that of the files.

    Raises:
        EmitError: Two files would share a name on a system that knows no capitals.
    """
    taken: set[str] = set()
    for device in model.devices:
        for dictionary in object_dictionaries(device):
            file = name(dictionary)
            if file.lower() in taken:
                raise EmitError("name-collision", device.where, f"two {kind} files would be called '{file}'")
            taken.add(file.lower())
            yield file, dictionary


def _ordered(entries: Iterable[BusObject]) -> tuple[BusObject, ...]:
    by_index: dict[int, BusObject] = {}
    for entry in entries:
        if not entry.entries:
            continue
        first = by_index.setdefault(entry.index, entry)
        if first is not entry:
            raise EmitError(
                "object-index",
                entry.where,
                f"{entry.designation} has the index 0x{entry.index:04X}, as has {first.designation}",
                "every object of an object dictionary has an index of its own",
                first.where,
            )
        if entry.index not in OBJECTS:
            raise EmitError(
                "object-index",
                entry.where,
                f"{entry.designation} has the index 0x{entry.index:04X}, where no object can be",
                f"objects lie at 0x{OBJECTS[0]:04X} ... 0x{OBJECTS[-1]:04X}",
            )
    return tuple(by_index[index] for index in sorted(by_index))


# Products


def _products(device: Device) -> tuple[Product, ...]:
    identity = next((entry for entry in device.objects if entry.kind == "canopen" and entry.index == IDENTITY), None)
    code = identity.subindex(2) if identity else None
    if code is None or not code.options:
        return (_product(identity, "", None),)
    return tuple(_product(identity, option.label, option.value) for option in code.options)


def _product(identity: DictionaryObject | None, label: str, number: int | None) -> Product:
    numbers = {
        "VendorNumber": _number(identity, 1),
        "ProductNumber": _number(identity, 2) if number is None else number,
        "RevisionNumber": _number(identity, 3),
    }
    return Product(
        label=label,
        vendor_number=numbers["VendorNumber"] or 0,
        product_number=numbers["ProductNumber"] or 0,
        revision_number=numbers["RevisionNumber"] or 0,
        unknown=tuple(name for name, value in numbers.items() if value is None),
    )


def _number(identity: DictionaryObject | None, subindex: int) -> int | None:
    entry = identity.subindex(subindex) if identity else None
    return entry.default if entry and isinstance(entry.default, int) else None


def _identified(identity: BusObject, product: Product) -> BusObject:
    numbers = {1: product.vendor_number, 2: product.product_number, 3: product.revision_number}
    return replace(
        identity,
        entries=tuple(
            replace(entry, default=numbers[entry.subindex]) if entry.subindex in numbers else entry
            for entry in identity.entries
        ),
    )


# Objects of the standard


def _standard_objects(device: Device, nodes: range) -> list[BusObject]:
    objects = [entry for entry in device.objects if entry.kind == "canopen"]
    counts = Counter(entry.name for entry in objects)
    return [
        _standard_object(entry, f"{entry.name} {entry.designation}" if counts[entry.name] > 1 else entry.name, nodes)
        for entry in objects
    ]


def _standard_object(entry: DictionaryObject, name: str, nodes: range) -> BusObject:
    present = [sub for sub in entry.subindexes if sub.abort is None]
    counts = Counter(sub.name for sub in present)
    entries = tuple(
        _standard_entry(sub, f"{sub.name} {sub.number}" if counts[sub.name] > 1 else sub.name, entry, nodes)
        for sub in present
    )
    errata = (*entry.errata, *(erratum for sub in entry.subindexes for erratum in sub.errata))
    return BusObject(
        index=entry.index,
        designation=entry.designation,
        name=name,
        object_type=_object_type(entry.object_type, entries),
        standard=entry.standard,
        entries=entries if entry.object_type == "VAR" else _counted(entries, entry.where),
        refused=tuple((sub.number, sub.abort) for sub in entry.subindexes if sub.abort is not None),
        cites=(entry.cite,),
        errata=tuple(dict.fromkeys(errata)),
        where=entry.where,
    )


def _standard_entry(sub: SubIndex, name: str, entry: DictionaryObject, nodes: range) -> Entry:
    mapping = entry.standard is not None and entry.standard.first in _MAPPINGS
    return _entry(
        subindex=sub.number,
        name=name,
        data_type=sub.data_type,
        access=sub.access,
        limits=sub.range,
        scaling=1,
        default=sub.default,
        mappable=sub.pdo_mapping,
        # Masters map no object without a default, and take no mapping entry without one.
        needs_default=sub.pdo_mapping or mapping,
        # Identifiers, mapping entries and identity numbers all are U32, and read best as eight digits.
        bit_coded=entry.index in COMMUNICATION_AREA and sub.data_type is DataType.UNSIGNED32,
        options=sub.options,
        length=None,
        nodes=nodes,
        where=sub.where,
    )


# Codes


def _code_object(code: Code, nodes: range) -> BusObject:
    mappable = any(condition.startswith("pdo_map") for condition in code.access.conditions)
    values = [
        (sub.number, sub.name or code.name, sub.follows or sub.default, sub.options or code.options, sub.where)
        for sub in code.subcodes
    ]
    entries = tuple(
        _entry(
            subindex=subindex,
            name=f"{code.designation}/{subindex} {name}" if code.is_array else name,
            data_type=code.data_type,
            access=_code_access(code),
            limits=code.range,
            scaling=code.scaling or 1,
            default=default,
            mappable=mappable,
            needs_default=mappable,
            bit_coded=code.is_bitfield,
            options=options,
            length=code.length,
            nodes=nodes,
            where=where,
        )
        for subindex, name, default, options, where in values
        or [(0, code.name, code.default, code.options, code.where)]
    )
    return BusObject(
        index=code.index,
        designation=code.designation,
        name=f"{code.designation} {code.name}",
        object_type=_object_type("ARRAY" if code.is_array else "VAR", entries),
        standard=None,
        entries=_counted(entries, code.where) if code.is_array else entries,
        refused=(),
        cites=tuple(cite for cite in (code.cite, code.default_cite) if cite),
        errata=code.errata,
        where=code.where,
    )


def _code_access(code: Code) -> str:
    if not code.access.write:
        return "ro"
    return "rw" if code.access.read else "wo"


# Entries


def _entry(
    *,
    subindex: int,
    name: str,
    data_type: DataType,
    access: str,
    limits: Range | None,
    scaling: int,
    default: Default | None,
    mappable: bool,
    needs_default: bool,
    bit_coded: bool,
    options: tuple[Option, ...],
    length: int | None,
    nodes: range,
    where: Where,
) -> Entry:
    if default is not None and data_type.is_number == isinstance(default, str):
        raise EmitError("object-value", where, f"{default!r} is no value of the data type {data_type.canopen_name}")
    low, high, remarks = _limits(data_type, limits, scaling, where)
    if default is None and data_type.is_number and (needs_default or _excludes_zero(low, high)):
        default = 0 if low is None or high is None else min(max(0, low), high)
        remarks.append(Remark.DEFAULT_ASSUMED)
    elif low is not None and high is not None and not _inside(default, low, high, nodes):
        low = high = None
        remarks.append(Remark.LIMITS_LEFT_OUT)
    return Entry(
        subindex=subindex,
        name=name,
        data_type=data_type,
        access=access,
        low=low,
        high=high,
        default=default,
        mappable=mappable,
        bit_coded=bit_coded,
        options=options,
        scaling=scaling,
        length=length,
        remarks=tuple(remarks),
        where=where,
    )


def _limits(
    data_type: DataType, limits: Range | None, scaling: int, where: Where
) -> tuple[int | None, int | None, list[Remark]]:
    """Wire values inside the range; bounds between two wire values move inward."""
    if limits is None or not data_type.is_number:
        return None, None, []
    low, high = ceil(limits.low * scaling), floor(limits.high * scaling)
    inside = max(low, data_type.lowest), min(high, data_type.highest)
    if inside[0] > inside[1]:
        raise EmitError("object-value", where, f"no value of {data_type.canopen_name} lies in the range")
    return *inside, [Remark.LIMITS_CUT] if inside != (low, high) else []


def _excludes_zero(low: int | None, high: int | None) -> bool:
    """Whether 0, which tools take for a missing default, is not allowed."""
    return low is not None and high is not None and not low <= 0 <= high


def _inside(default: Default | None, low: int, high: int, nodes: range) -> bool:
    if isinstance(default, NodeRelative):
        return low <= default.at(nodes[0]) and default.at(nodes[-1]) <= high
    return not isinstance(default, int) or low <= default <= high


def _object_type(declared: str, entries: Sequence[Entry]) -> str:
    """Type to declare: an array with gaps or several types is a record, as readers count the elements of arrays."""
    elements = [entry for entry in entries if entry.subindex > 0]
    regular = [entry.subindex for entry in elements] == list(range(1, len(elements) + 1))
    alike = len({entry.data_type for entry in elements}) <= 1
    return declared if declared != "ARRAY" or (regular and alike) else "RECORD"


def _counted(entries: tuple[Entry, ...], where: Where) -> tuple[Entry, ...]:
    """Entries led by sub-index 0, whose default is the highest sub-index unless the manual prints another.

    A sub-index 0 that can be written counts what is in use; that is nothing where no default is printed.
    """
    if not entries:
        return ()
    highest = entries[-1].subindex
    first = entries[0]
    if first.subindex == 0:
        if first.default is None and "w" in first.access:
            first = replace(first, default=0, remarks=(*first.remarks, Remark.DEFAULT_ASSUMED))
        elif first.default is None:
            first = replace(first, default=highest)
        return (first, *entries[1:])
    count = Entry(
        subindex=0,
        name=_COUNT_NAME,
        data_type=DataType.UNSIGNED8,
        access="ro",
        low=None,
        high=None,
        default=highest,
        mappable=False,
        bit_coded=False,
        options=(),
        scaling=1,
        length=None,
        remarks=(Remark.COUNT_ASSUMED,),
        where=where,
    )
    return (count, *entries)
