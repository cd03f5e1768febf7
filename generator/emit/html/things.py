"""Everything that a reader can look for on a device, with its numbers in canonical form and where it stands."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from generator.emit.html.drive import command_text
from generator.emit.html.errors import has_own_places, shared_name
from generator.emit.html.lamps import words
from generator.emit.html.links import Links
from generator.emit.html.places import (
    COMMANDS,
    ERROR_KINDS,
    code_entries,
    code_id,
    command_id,
    erratum_id,
    error_entries,
    error_id,
    error_text,
    named_id,
    object_id,
)
from generator.emit.html.text import ELLIPSIS, hexadecimal
from generator.model import (
    BitField,
    Code,
    CodeRef,
    DictionaryObject,
    ErrorEntry,
    Example,
    Field,
    IndicatorTable,
    Led,
    Light,
    Model,
    Option,
    Pattern,
)

KINDS = {
    "device": ("Device", "Devices"),
    "page": ("Page", "Pages"),
    "code": ("Code", "Codes"),
    "canopen": ("Object", "Objects"),
    "profidrive": ("PROFIdrive parameter", "PROFIdrive parameters"),
    **{f"{kind}-error" if kind == "device" else kind: titles for kind, titles in ERROR_KINDS.items()},
    "cob_id": ("COB-ID", "COB-IDs"),
    "led": ("LED", "LEDs"),
    "switch": ("DIP switches", "DIP switches"),
    "command": ("Device command", "Device commands"),
    "telegram": ("Telegram", "Worked telegrams"),
    "layout": ("Telegram layout", "Telegram layouts"),
    "table": ("Table", "Tables"),
    "formula": ("Formula", "Formulas"),
    "erratum": ("Erratum", "Errata"),
}
"""Kinds of things, singular and plural, those that readers look for most first."""

_INDEX_BITS = 16
_COB_ID_BITS = 12
_DEVICE_ERROR = "device"
_FORMS = {
    Light.OFF: ("off", "dark"),
    Light.ON: ("on", "lit", "steady"),
    Light.FLICKER: ("flicker", "flickers", "flickering"),
    Light.ON_OR_FLICKER: ("on", "lit", "flicker", "flickers", "flickering"),
    Light.BLINK: ("blink", "blinks", "blinking"),
    Light.FLASH: ("flash", "flashes", "flashing"),
}
"""What people call a light, beside the words of the reference."""
_SAID = ("connector", "terminal")
"""Kinds of tables that are looked for by their kind."""
_COUNTS = {
    1: ("single", "once", "one time"),
    2: ("double", "twice", "two times"),
    3: ("triple", "three times"),
    4: ("quadruple", "four times"),
}
COUNT_WORDS = frozenset(word for said in _COUNTS.values() for word in " ".join(said).split())
"""Words that say how often a light comes."""
COUNTED = dict(zip(_FORMS[Light.BLINK], _FORMS[Light.FLASH], strict=True))
"""What people call blinking, and what the reference calls it where somebody counts it."""
LED_MARK = "|"
"""Stands before what is said of each LED of a row, which begins with its label."""


@dataclass(frozen=True, slots=True)
class Key:
    """A number by which something is found.

    ``space``: what is numbered: "c" codes, "i" indexes, "p" PROFIdrive parameters, "d" error numbers of the device,
    "e" all others, "b" COB-IDs.  ``last``: end of a run.  ``node``: address of the node that the first number of the
    run belongs to.
    """

    space: str
    number: int
    last: int | None = None
    node: int | None = None

    def __str__(self) -> str:
        """Canonical form, all numbers decimal: ``c13350``, ``e25-100``, ``b385-511@1``."""
        text = f"{self.space}{self.number}"
        text += f"-{self.last}" if self.last is not None else ""
        return text + (f"@{self.node}" if self.node is not None else "")


@dataclass(frozen=True, slots=True)
class Spot:
    """A number as it is written, where it leads, and how it can be looked up.

    ``also``: its other notations.  ``stem``: address of a part of it, less the number of the part at its end; "" where
    there are none.
    """

    text: str
    href: str
    keys: tuple[Key, ...] = ()
    also: tuple[str, ...] = ()
    stem: str = ""


@dataclass(frozen=True, slots=True)
class Part:
    """A subcode or sub-index; ``name`` is "" where it has none."""

    number: int
    name: str
    words: str


@dataclass(frozen=True, slots=True)
class Thing:
    """Something that has a name.

    ``kind``: one of ``KINDS``.  ``words``: what else is looked for.  ``spots``: its numbers, in several slots one for
    each.  ``others``: single numbers of its runs.  ``parts``: what each of its numbers is divided into.
    """

    kind: str
    name: str
    words: str
    spots: tuple[Spot, ...]
    others: tuple[Spot, ...] = ()
    parts: tuple[Part, ...] = ()


def things(model: Model, links: Links) -> Iterator[Thing]:
    """Everything on the device of ``links``, in the order of ``KINDS``."""
    device = links.device
    title = Spot(device.order_code, links.href("device"))
    yield Thing("device", device.title, f"{device.id} {device.bus} {device.manufacturer}", (title,))
    for codes in code_entries(device.codes):
        yield _code(links, codes)
    for entry in device.objects:
        yield _object(links, entry)
    for errors in error_entries(device, device.errors):
        yield _error(links, errors)
    if any(entry.kind == "canopen" for entry in device.objects):
        yield from _cob_ids(links, model)
    for table in device.indicators:
        yield from _led_rows(links, table)
    yield from _commands(links)
    yield from _named(links)


def _code(links: Links, entry: Sequence[Code]) -> Thing:
    code = entry[0]
    return Thing(
        "code",
        code.name,
        _labels(code.options, code.fields),
        tuple(_code_spot(links, one) for one in entry),
        parts=tuple(Part(sub.number, sub.name, _labels(sub.options)) for sub in code.subcodes),
    )


def _code_spot(links: Links, code: Code) -> Spot:
    keys = (Key("c", code.number), Key("i", code.index))
    also = (hexadecimal(code.index, _INDEX_BITS), str(code.index))
    stem = links.href(code_id(code.number, 0)).removesuffix("0") if code.subcodes else ""
    return Spot(code.designation, links.href(code_id(code.number)), keys, also, stem)


def _labels(options: Iterable[Option], fields: Iterable[BitField] = ()) -> str:
    return " ".join([option.label for option in options] + [field.label for field in fields])


def _object(links: Links, entry: DictionaryObject) -> Thing:
    canopen = entry.kind == "canopen"
    spot = Spot(
        entry.designation,
        links.href(object_id(entry)),
        (Key("i" if canopen else "p", entry.index),),
        (hexadecimal(entry.index, _INDEX_BITS), str(entry.index)) if canopen else (),
        links.href(object_id(entry, 0)).removesuffix("0"),
    )
    parts = tuple(
        Part(sub.number, sub.name if sub.name != entry.name else "", _labels(sub.options, sub.fields))
        for sub in entry.subindexes
    )
    return Thing(entry.kind, entry.name, "", (spot,), parts=parts)


def _error(links: Links, entry: Sequence[ErrorEntry]) -> Thing:
    error = entry[0]
    space = "d" if error.kind == _DEVICE_ERROR else "e"
    others = tuple(
        _error_spot(links, one.kind, number, Key(space, number))
        for one in entry
        if has_own_places(one)
        for number in range(one.number, one.last + 1)
    )
    spots = tuple(
        _error_spot(links, one.kind, one.number, Key(space, one.number, last=one.last if one.count > 1 else None))
        for one in entry
    )
    kind = "device-error" if error.kind == _DEVICE_ERROR else error.kind
    return Thing(kind, shared_name(entry), error.register or "", spots, others)


def _error_spot(links: Links, kind: str, number: int, key: Key) -> Spot:
    text, also = error_text(kind, number), str(number)
    if key.last is not None:
        text, also = f"{text} {ELLIPSIS} {error_text(kind, key.last)}", f"{also} {ELLIPSIS} {key.last}"
    return Spot(text, links.href(error_id(kind, number)), (key,), (also,))


def _cob_ids(links: Links, model: Model) -> Iterator[Thing]:
    """Identifiers of the predefined connection set, each where the object that holds it, or a table, describes it."""
    known = {entry.index: entry for entry in links.device.objects}
    table = next((table for table in links.device.tables if table.kind == "cob-id"), None)
    for entry in model.cob_ids:
        held_in = [ref for ref in entry.objects if ref.index in known]
        if held_in:
            href = links.object(held_in[0]).href
        else:
            href = links.href(named_id("table", table.id) if table else "device")
        text = hexadecimal(entry.base, _COB_ID_BITS)
        keys = [Key("b", entry.base)]
        if not entry.broadcast and model.node_addresses:
            text += " + node"
            nodes = model.node_addresses
            keys.append(Key("b", entry.base + nodes[0], last=entry.base + nodes[-1], node=nodes[0]))
        words = f"COB-ID identifier {' '.join(links.object(ref).text for ref in held_in)}"
        yield Thing("cob_id", entry.name, words, (Spot(text, href, tuple(keys), (str(entry.base),)),))


def _led_rows(links: Links, table: IndicatorTable) -> Iterator[Thing]:
    for number, row in enumerate(table.rows, 1):
        pairs = [pair for pair in zip(table.leds, row.patterns, strict=True) if pair[1].light is not Light.ANY]
        seen = ", ".join(f"{led.label} {words(pattern)}" for led, pattern in pairs)
        called = "".join(f" {LED_MARK} {_called(led, pattern)}" for led, pattern in pairs)
        spot = Spot(", ".join(led.label for led, _ in pairs), links.href(named_id("led", table.id, str(number))))
        yield Thing("led", f"{seen}: {row.state}", f"LED {row.meaning}{called}", (spot,))


def _called(led: Led, pattern: Pattern) -> str:
    """What people call a pattern, colour first: "BE flashes twice red double flash red flash twice"."""
    colour = pattern.colour or led.colour
    forms = [f"{colour} {form}" for form in _FORMS[pattern.light]]
    if pattern.light is Light.FLASH:
        count = pattern.flashes or 1
        single, *others = _COUNTS.get(count, ("",))
        forms = [f"{colour} {single} {_FORMS[Light.FLASH][0]}", *forms]
        forms += [*others, f"{count} times"]
    return " ".join([f"{led.label} {words(pattern)} {led.name}", *forms])


def _commands(links: Links) -> Iterator[Thing]:
    """The list of device commands by the code that they are written to, and each by what is written."""
    drive = links.device.drive
    if drive is None or not drive.commands:
        return
    if drive.command_code is not None:
        code = CodeRef(drive.command_code)
        index = drive.index_base - code.number
        keys = (Key("c", code.number), Key("i", index))
        spot = Spot(str(code), links.href(COMMANDS), keys, (hexadecimal(index, _INDEX_BITS), str(index)))
        yield Thing("command", KINDS["command"][1], "", (spot,))
    for command in drive.commands:
        spot = Spot(command_text(drive, command), links.href(command_id(command.value)))
        yield Thing("command", command.name, "", (spot,))


def _named(links: Links) -> Iterator[Thing]:
    """Things that have a name alone."""
    device = links.device
    for group in device.switches:
        values = " ".join(row.value for row in group.rows if not row.value.isdecimal())
        switch_words = f"DIP switch {' '.join(group.labels)} {group.unit} {values}"
        yield _thing(links, "switch", group.id, group.name, switch_words)
    for example in device.examples:
        yield _thing(links, "telegram", example.id, example.name, _octets(example))
    for layout in device.layouts:
        fields = " ".join(_titles(layout.fields))
        yield _thing(links, "layout", layout.id, layout.name, f"{layout.protocol} {fields}")
    for table in device.tables:
        rows = " ".join(str(row[0]) for row in table.rows)
        yield _thing(links, "table", table.id, table.name, f"{rows} {table.kind}" if table.kind in _SAID else rows)
    for formula in device.formulas:
        yield _thing(links, "formula", formula.id, formula.name, formula.expression)
    for erratum in device.errata:
        spot = Spot(erratum.id, links.href(erratum_id(erratum.id)))
        name = ", ".join(erratum.about_text) or erratum.printed_text
        yield Thing("erratum", name, f"{erratum.kind} {erratum.printed_text} {erratum.used_text}", (spot,))


def _thing(links: Links, kind: str, identity: str, name: str, words: str) -> Thing:
    return Thing(kind, name, words, (Spot(identity, links.href(named_id(kind, identity))),))


def _octets(example: Example) -> str:
    return " ".join(f"{octet:02X}" for octet in example.data if octet is not None)


def _titles(fields: Iterable[Field]) -> Iterator[str]:
    for field in fields:
        yield field.title
        yield from _titles(field.fields)
