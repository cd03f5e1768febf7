"""Services as entries of the reference: what stands in each field of their telegrams."""

from collections.abc import Iterator, Sequence

from generator.emit.html.blocks import Anchor, Entry, Fact, Group, Row, Table
from generator.emit.html.links import Links
from generator.emit.html.notes import named_subject, notes
from generator.emit.html.places import named_id
from generator.emit.html.text import NONE, Piece, Prose, hexadecimal, joined, shown_origin, through
from generator.model import (
    Choice,
    Does,
    Field,
    Filler,
    Filling,
    Fillings,
    Message,
    Option,
    Service,
    What,
)

_OVERVIEW = ("Service", "Name", "What it does", "Layout of the request", "Layout of the answer")
_FIELDS = ("Field", "Request", "Answer")
_DOES = {
    Does.READ: "reads a parameter",
    Does.WRITE: "writes a parameter",
    Does.REFUSE: "refuses a request",
    Does.REPORT: "reports an error",
}
_FILLERS = {
    What.INDEX: "index",
    What.SUBINDEX: "sub-index or subcode, 0 without",
    What.ELEMENTS: "1 with a sub-index, 0 without",
    What.CODE: "number of the code",
    What.VALUE: "value",
    What.LENGTH: "length of the value in bytes",
    What.ERROR: "error number",
    What.REGISTER: "error register",
    What.FREE: "free to choose; the answer repeats it",
    What.BEHIND: "number of bytes behind",
}
_ONE_DIGIT = 9


def service_group(links: Links, services: Sequence[Service]) -> Group:
    """Services below one heading."""
    rows = tuple(_row(links, service) for service in services)
    entries = tuple(service_entry(links, service) for service in services)
    return Group("telegrams-services", "Services", Table("overview", _OVERVIEW, rows), entries)


def _anchor(service: Service) -> Anchor:
    return Anchor(named_id("service", service.id), service.id)


def _row(links: Links, service: Service) -> Row:
    layouts = (_layouts(links, message) for message in (service.request, service.answer))
    return Row((links.anchored(_anchor(service)), service.name, _DOES[service.does], *layouts))


def _layouts(links: Links, message: Message | None) -> Prose:
    if message is None:
        return NONE
    names = layout_names(message)
    return joined([(links.named_thing("layout", name, name),) for name in names])


def layout_names(message: Message) -> tuple[str, ...]:
    """Ids of the layouts that a message may have."""
    if isinstance(message.layout, Choice):
        return tuple(str(name) for _, name in message.layout.cases)
    return (message.layout,)


def service_entry(links: Links, service: Service) -> Entry:
    """Entry for a service."""
    origin = shown_origin(service.origin)
    return Entry(
        kind="service",
        anchors=(_anchor(service),),
        name=service.name,
        marks=(origin,) if origin else (),
        lead=links.prose(service.description),
        facts=tuple(_facts(links, service)),
        tables=(Table("fillings", _FIELDS, tuple(_field_rows(links, service))),),
        notes=notes(links, [named_subject(service.errata)]),
    )


def _facts(links: Links, service: Service) -> Iterator[Fact]:
    reached = f": {' and '.join(service.reaches)}" if service.reaches else ""
    yield Fact("What it does", _DOES[service.does] + reached)
    for label, message in (("Request", service.request), ("Answer", service.answer)):
        if message is not None:
            yield Fact(label, _telegram(links, message))
    if service.limit is not None:
        yield Fact("Longest telegram", f"{service.limit} bytes")
    yield Fact("Source", links.source(service.cite))


def _telegram(links: Links, message: Message) -> Prose:
    """Identifier and layout of a telegram, the layout by the length of the value where that decides."""
    parts: list[Prose] = [f"{message.identifier} + node address"] if message.identifier else []
    if isinstance(message.layout, Choice):
        parts += [
            (f"{_case(key)}: ", links.named_thing("layout", str(name), str(name))) for key, name in message.layout.cases
        ]
    else:
        parts.append((links.named_thing("layout", message.layout, message.layout),))
    return joined(parts)


def _field_rows(links: Links, service: Service) -> Iterator[Row]:
    """Every field that the service fills, those of groups with their path."""
    columns = [dict(_said(links, message)) for message in (service.request, service.answer) if message is not None]
    if service.request is None:
        columns.insert(0, {})
    elif service.answer is None:
        columns.append({})
    for name in dict.fromkeys(name for column in columns for name in column):
        yield Row(((Piece(name, tag="code"),), *(column.get(name, NONE) for column in columns)))


def _said(links: Links, message: Message) -> Iterator[tuple[str, str]]:
    layouts = {layout.id: layout for layout in links.device.layouts}
    fields = [field for name in layout_names(message) for field in layouts[name].fields]
    yield from _said_in(message.values, fields, "")


def _said_in(fillings: Fillings, fields: Sequence[Field], path: str) -> Iterator[tuple[str, str]]:
    known = {field.name: field for field in fields}
    for name, filling in fillings:
        whole, _, part = name.partition(".")
        field = known[whole]
        if isinstance(filling, tuple):
            for entry in filling:
                yield from _said_in(entry, field.fields, f"{path}{name}.")
        else:
            options = dict(field.bit_values).get(part, ()) if part else field.values
            yield path + name, _filling(filling, options)


def _filling(filling: Filling, options: Sequence[Option]) -> str:
    match filling:
        case Filler():
            bits = f"bits {through(str(filling.low), str(filling.high))} of the " if filling.high is not None else ""
            return f"{bits}{_FILLERS[filling.what]}" + (f" {filling.field}" if filling.field else "")
        case Choice():
            cases = [f"{_case(key)}: {_filling(inner, options)}" for key, inner in filling.cases]
            others = [] if filling.otherwise is None else [f"others: {_filling(filling.otherwise, options)}"]
            return "; ".join(cases + others)
        case int():
            shown = str(filling) if 0 <= filling <= _ONE_DIGIT else hexadecimal(filling)
            label = next((option.label for option in options if option.value == filling), "")
            return f"{shown} {label}".strip()
        case _:
            return "empty" if filling == "" else str(filling)


def _case(key: str) -> str:
    if not key.isdecimal():
        return key
    return "1 byte" if key == "1" else f"{key} bytes"
