"""Telegrams of services as bytes of which each is labelled: how an entry is read, written or refused on its bus."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import ceil

from generator.codec import CodecError, Span, spans
from generator.emit.html.links import Links
from generator.emit.html.places import error_text, page_of
from generator.emit.html.text import Prose, decimal, hexadecimal, joined, octets, quoted
from generator.model import (
    Choice,
    Code,
    CodeRef,
    DataType,
    Default,
    Device,
    DictionaryObject,
    Does,
    ErrorEntry,
    Filler,
    Filling,
    Fillings,
    Message,
    Model,
    NodeRelative,
    Option,
    Range,
    Service,
    SubIndex,
    What,
)
from generator.model.telegram import OPEN
from generator.wire import Call, Telegram, build, carries, case_of, chosen

BUILDER = "builder"
"""Anchor of the instrument that builds telegrams."""

_BYTE = 8
_ONE_DIGIT = 9
_IDENTIFIER_BITS = 12
_MOST_CHUNKS = 32
"""Requests with more fields than this are long; those that write are folded then."""
_WRITABLE = ("rw", "wo", "rwr", "rww")
_OPEN = "any"
_DEFAULT = "the default"
_AS_ASKED = "as asked"


@dataclass(frozen=True, slots=True)
class Chunk:
    """The bytes of one field of a telegram, what it is called and what it says."""

    octets: str
    name: str
    meaning: str


@dataclass(frozen=True, slots=True)
class Strip:
    """A telegram; ``identifier`` is "" on a bus without."""

    label: Prose
    identifier: str
    chunks: tuple[Chunk, ...]


@dataclass(frozen=True, slots=True)
class Exchange:
    """What one service does for an entry: requests, one for each slot, and the answer to the first of them.

    ``note`` is "" where there is nothing to say; ``folded``: long, and so behind a line that opens.
    """

    title: Prose
    summary: str
    note: Prose
    requests: tuple[Strip, ...]
    answers: tuple[Strip, ...]
    builder: str
    folded: bool


@dataclass(frozen=True, slots=True)
class BusSection:
    """Telegrams of an entry; ``lead`` says what they take for granted."""

    lead: Prose
    exchanges: tuple[Exchange, ...]


@dataclass(frozen=True, slots=True)
class Value:
    """A value to be written, as it travels, with what it is: _DEFAULT, and what it means."""

    raw: int | bytes
    role: str
    meaning: str


@dataclass(frozen=True, slots=True)
class Target:
    """A parameter as a service sees it; ``key`` names it in the address of the builder."""

    label: Prose
    key: str
    call: Call

    @property
    def type_name(self) -> str:
        """Data type as the manual spells it."""
        return self.call.type_name or self.call.data_type.canopen_name

    def fits(self, service: Service) -> bool:
        """Whether the service carries values of its type."""
        return carries(service, self.call.data_type, self.call.type_name)


@dataclass(frozen=True, slots=True)
class Subject:
    """What an entry has on the bus: the same parameter in every slot, with what may be done."""

    reached_as: str
    targets: tuple[Target, ...]
    readable: bool
    writable: bool
    value: Value | None
    part: str


class Bus:
    """The services of a device, and the node that its examples speak to."""

    def __init__(self, model: Model, device: Device) -> None:
        """Take in what the device and the predefined connection set say."""
        self.device = device
        self.layouts = {layout.id: layout for layout in device.layouts}
        self.bases = {cob_id.name: cob_id.base for cob_id in model.cob_ids}
        self.node = self._node()

    def _node(self) -> int | None:
        """Default of the node address, ``None`` where no code holds it."""
        number = self.device.canopen.node_address if self.device.canopen else None
        defaults = [code.default for code in self.device.codes if code.number == number]
        return next((default for default in defaults if isinstance(default, int)), None)

    def protocol(self, service: Service) -> str:
        """Protocol of the telegrams of a service."""
        names = [m.layout if isinstance(m.layout, str) else str(m.layout.cases[0][1]) for m in service.messages]
        return self.layouts[names[0]].protocol

    def identifier(self, message: Message) -> str:
        """Identifier of a telegram: for the node of the examples, or as a rule over the node address."""
        if message.identifier is None:
            return ""
        base = self.bases[message.identifier]
        if self.node is None:
            return f"{hexadecimal(base, _IDENTIFIER_BITS)} + node address"
        return hexadecimal(base + self.node, _IDENTIFIER_BITS)

    def strip(self, service: Service, message: Message, target: Target, call: Call, value: Value | None) -> Strip:
        """A telegram with its bytes labelled.

        Raises:
            CodecError: The service cannot carry it.
        """
        telegram = build(service, message, self.layouts, call)
        asks = message is service.request
        return Strip(target.label, self.identifier(message), tuple(_chunks(message, telegram, call, value, asks)))


def _chunks(message: Message, telegram: Telegram, call: Call, value: Value | None, asks: bool) -> Iterator[Chunk]:
    """Fields of a telegram with their bytes; ``asks``: it is a request."""
    fillings = dict(_flat(message.values, ""))
    for span in spans(telegram.layout, telegram.data):
        if span.start < span.stop:
            data = telegram.data[span.start : span.stop]
            meaning = _meaning(span, fillings, call, value, asks)
            yield Chunk(octets(data), span.field.title, meaning)


def _flat(fillings: Fillings, path: str) -> Iterator[tuple[str, Filling]]:
    for name, filling in fillings:
        if isinstance(filling, tuple):
            for entry in filling:
                yield from _flat(entry, f"{path}{name}.")
        else:
            yield path + name, filling


def _meaning(span: Span, fillings: Mapping[str, Filling], call: Call, value: Value | None, asks: bool) -> str:
    """What the bytes of a field say; "" where their name says enough."""
    found = span.values[span.field.name]
    filling = fillings.get(span.path)
    label = _label(found, span.field.values)
    if label:
        return label
    if isinstance(filling, Choice) and isinstance(chosen(filling, call), int):
        case = case_of(filling, call)
        return case if case is not None and not case.isdecimal() and found else ""
    filler = filling if filling is None else chosen(filling, call)
    if isinstance(filler, Filler):
        return _filled(filler, span, call, value, asks)
    if span.field.bits and isinstance(found, int):
        return ", ".join(_parts(span, fillings))
    return str(found) if filler is not None and found not in (0, "") else ""


def _filled(filler: Filler, span: Span, call: Call, value: Value | None, asks: bool) -> str:
    found = span.values[span.field.name]
    if found == OPEN:
        return _AS_ASKED if filler.what in (What.INDEX, What.SUBINDEX, What.CODE) else _OPEN
    match filler.what:
        case What.CODE:
            return str(CodeRef(found)) if isinstance(found, int) else ""
        case What.FREE:
            return "free to choose" if asks else _AS_ASKED
        case What.VALUE:
            return value.meaning if value is not None and value.raw == call.value and not filler.low else ""
        case What.BEHIND:
            return f"{found} bytes behind {filler.field}"
        case What.ELEMENTS:
            return "no subindex" if found == 0 else ""
        case What.ERROR:
            number = found if isinstance(found, int) else call.error or 0
            return hexadecimal(number, (span.stop - span.start) * _BYTE)
        case What.REGISTER:
            return hexadecimal(found) if isinstance(found, int) else ""
        case _:
            return str(found)


def _parts(span: Span, fillings: Mapping[str, Filling]) -> Iterator[str]:
    """Parts of a number that the service decides, and those that are not 0."""
    labels = dict(span.field.bit_values)
    for part in span.field.bits:
        name = f"{span.field.name}.{part.label}"
        number = span.values[name]
        if name in fillings or number:
            label = _label(number, labels.get(part.label, ()))
            yield label or f"{part.label} {number}"


def _label(found: object, options: Sequence[Option]) -> str:
    return next((option.label for option in options if option.value == found), "")


def code_bus(links: Links, bus: Bus, entry: Sequence[Code]) -> BusSection | None:
    """Telegrams that read and write a code, in the first of its subcodes where it has any."""
    code = entry[0]
    sub = code.subcodes[0] if code.subcodes else None
    subcode = sub.number if sub else 0
    targets = tuple(code_target(one, subcode) for one in entry)
    options = (sub.options if sub else ()) or code.options
    default = sub.default if sub else code.default
    value = _value(default, code.range, options, code.data_type, Fraction(code.scaling or 1), bus.node)
    part = f"subcode {subcode}" if sub else ""
    return _section(links, bus, Subject("codes", targets, code.access.read, code.access.write, value, part))


def code_target(code: Code, subcode: int) -> Target:
    """A code as a service sees it, in one of its subcodes or, with 0, as a single variable."""
    name = str(CodeRef(code.number, subcode or None))
    return Target(
        label=f"{name} ({code.slot})" if code.slot else name,
        key=name,
        call=Call(
            data_type=code.data_type, type_name=code.type_name, index=code.index, code=code.number, subindex=subcode
        ),
    )


def object_target(entry: DictionaryObject, sub: SubIndex) -> Target:
    """A sub-index of an object as a service sees it."""
    return Target(
        label=entry.designation + (f"/{sub.number}" if len(entry.subindexes) > 1 else ""),
        key=f"{entry.designation}/{sub.number}".replace(" ", "-"),
        call=Call(data_type=sub.data_type, index=entry.index, subindex=sub.number),
    )


def object_bus(links: Links, bus: Bus, entry: DictionaryObject) -> BusSection | None:
    """Telegrams that read and write an object, in the first sub-index behind 0 where it has any."""
    known = [sub for sub in entry.subindexes if sub.abort is None and not sub.unused] or list(entry.subindexes)
    sub = next((sub for sub in known if sub.number > 0), known[0])
    target = object_target(entry, sub)
    part = f"sub-index {sub.number}" if len(entry.subindexes) > 1 else ""
    value = _object_value(sub, bus.node)
    return _section(links, bus, Subject("objects", (target,), sub.access != "wo", sub.access in _WRITABLE, value, part))


def _object_value(sub: SubIndex, node: int | None) -> Value | None:
    if sub.signature is not None:
        return Value(sub.signature.encode("ascii"), "the signature", quoted(sub.signature))
    return _value(sub.default, sub.range, sub.options, sub.data_type, Fraction(1), node)


def _value(
    default: Default | None,
    limits: Range | None,
    options: Sequence[Option],
    data_type: DataType,
    scaling: Fraction,
    node: int | None,
) -> Value | None:
    """The value that an example writes: the default, else the least that may be written."""
    if isinstance(default, NodeRelative):
        default = default.at(node) if node is not None else None
    if isinstance(default, str):
        return Value(default.encode("latin-1"), _DEFAULT, quoted(default))
    if not data_type.is_number:
        return None
    unit = f" {limits.unit}" if limits and limits.unit else ""
    if default is not None:
        return Value(default, _DEFAULT, _explained(default, options, scaling, unit))
    if options:
        least = min(option.value for option in options)
        return Value(least, "the least of the selection list", _explained(least, options, scaling, unit))
    if limits is not None:
        least = ceil(limits.low * scaling)
        return Value(least, "the lower limit", _explained(least, options, scaling, unit))
    return Value(0, "for example", "0")


def _explained(raw: int, options: Sequence[Option], scaling: Fraction, unit: str) -> str:
    label = _label(raw, options)
    if label:
        return f"{raw}: {label}"
    if scaling != 1:
        return f"{decimal(Fraction(raw) / scaling)}{unit}, sent as {raw}"
    return f"{raw}{unit}" + (f" = {hexadecimal(raw)}" if raw > _ONE_DIGIT else "")


def _section(links: Links, bus: Bus, subject: Subject) -> BusSection | None:
    """Every service that reaches the subject; ``None`` where there is none or nothing may be done."""
    exchanges: list[Exchange] = []
    target = subject.targets[0]
    for service in bus.device.services:
        if subject.reached_as not in service.reaches:
            continue
        if not (subject.readable if service.does is Does.READ else subject.writable):
            continue
        if target.fits(service):
            exchanges.append(_exchange(links, bus, service, subject))
        elif not _another_carries(bus, service, target):
            note = f"Carries no values of the type {target.type_name}."
            exchanges.append(Exchange(_title(links, service), "", note, (), (), "", folded=False))
    if not exchanges:
        return None
    count = sum(len(strip.chunks) for exchange in exchanges for strip in exchange.requests)
    if count > _MOST_CHUNKS:
        exchanges = [replace(exchange, folded=bool(exchange.summary)) for exchange in exchanges]
    return BusSection(_lead(links, bus, subject), tuple(exchanges))


def _another_carries(bus: Bus, service: Service, target: Target) -> bool:
    return any(
        other.does is service.does and bus.protocol(other) == bus.protocol(service) and target.fits(other)
        for other in bus.device.services
    )


def _title(links: Links, service: Service) -> Prose:
    return (links.named_thing("service", service.id, service.name),)


def _exchange(links: Links, bus: Bus, service: Service, subject: Subject) -> Exchange:
    first, value = subject.targets[0], subject.value
    title = _title(links, service)
    writes = service.does is Does.WRITE
    raw = value.raw if value else None
    note = service.description
    requests: tuple[Strip, ...] = ()
    answers: tuple[Strip, ...] = ()
    summary = ""
    if writes and value is None:
        note = "The manual prints neither default nor limits that could stand here as an example."
    else:
        if writes and value:
            summary = f"{value.role}, {value.meaning}"
        requests = _strips(bus, service, service.request, subject.targets, value, raw if writes else None)
        known = writes or (value is not None and value.role == _DEFAULT)
        answers = _strips(bus, service, service.answer, (first,), value, raw if known else None)
    return Exchange(title, summary, note, requests, answers, _builder(bus.device, service, first, value), folded=False)


def _strips(
    bus: Bus,
    service: Service,
    message: Message | None,
    targets: Sequence[Target],
    value: Value | None,
    raw: int | bytes | None,
) -> tuple[Strip, ...]:
    if message is None:
        return ()
    found = []
    for target in targets:
        try:
            found.append(bus.strip(service, message, target, replace(target.call, value=raw), value))
        except CodecError:
            continue
    return tuple(found)


def _builder(device: Device, service: Service, target: Target, value: Value | None) -> str:
    """Address of the builder, set to the telegram."""
    query = f"service={service.id}&code={target.key}"
    if service.does is Does.WRITE and value is not None and isinstance(value.raw, int):
        query += f"&raw={value.raw}"
    return f"{page_of(device, 'telegrams')}?{query}#{BUILDER}"


def _lead(links: Links, bus: Bus, subject: Subject) -> Prose:
    parts: list[Prose] = []
    can = bus.device.canopen
    if bus.node is not None and can is not None and can.node_address is not None:
        default = (f"for node address {bus.node}, the default of ", links.code(CodeRef(can.node_address)))
        parts.append(default)
    if subject.part:
        parts.append(f"for {subject.part}")
    if not subject.writable:
        parts.append("read-only")
    return (
        "Bytes in hexadecimal, in the order in which they travel",
        *(("; ", *joined(parts, "; ")) if parts else ()),
        ".",
    )


def error_bus(links: Links, bus: Bus, entry: Sequence[ErrorEntry]) -> BusSection | None:
    """Telegrams that carry an error number; ``None`` where none does."""
    found = []
    for service in bus.device.services:
        if service.errors != entry[0].kind or service.answer is None:
            continue
        strips = []
        for error in entry:
            call = Call(error=error.number, register=_register(error), unset=None)
            target = Target(error_text(error.kind, error.number), "", call)
            try:
                strips.append(bus.strip(service, service.answer, target, call, None))
            except CodecError:
                continue
        found.append(Exchange(_title(links, service), "", service.description, (), tuple(strips), "", folded=False))
    if not found:
        return None
    lead = "Bytes in hexadecimal, in the order in which they travel; XX is left open."
    if bus.node is not None:
        lead = f"{lead[:-1]}; the identifier is that of node address {bus.node}."
    return BusSection(lead, tuple(found))


def _register(error: ErrorEntry) -> int | None:
    """Value of the error register, ``None`` where the manual prints several or none."""
    try:
        return int(error.register, 0) if error.register is not None else None
    except ValueError:
        return None
