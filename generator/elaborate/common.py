"""What several tables share: data types, options, bits, runs of keys, placeholders, defaults."""

import re
from collections.abc import Iterator, Mapping

from generator.diagnostics import suggestion
from generator.model import Bit, BitField, DataType, Default, Manual, Option, Origin, Where
from generator.notation import HIGHEST_BIT, node_relative, value_range
from generator.tree import Node

CODE_TYPES = {
    "BITFIELD_8": DataType.UNSIGNED8,
    "BITFIELD_16": DataType.UNSIGNED16,
    "BITFIELD_32": DataType.UNSIGNED32,
    "INTEGER_8": DataType.INTEGER8,
    "INTEGER_16": DataType.INTEGER16,
    "INTEGER_32": DataType.INTEGER32,
    "UNSIGNED_8": DataType.UNSIGNED8,
    "UNSIGNED_16": DataType.UNSIGNED16,
    "UNSIGNED_32": DataType.UNSIGNED32,
    "UNSIGNED_64": DataType.UNSIGNED64,
    "VISIBLE_STRING": DataType.VISIBLE_STRING,
    "OCTET_STRING": DataType.OCTET_STRING,
}
"""Data types of codes as the table of attributes spells them."""

OBJECT_TYPES = {
    "U8": DataType.UNSIGNED8,
    "U16": DataType.UNSIGNED16,
    "U32": DataType.UNSIGNED32,
    "I8": DataType.INTEGER8,
    "I16": DataType.INTEGER16,
    "I32": DataType.INTEGER32,
    "STRING": DataType.VISIBLE_STRING,
    "OCTETS": DataType.OCTET_STRING,
    "DOMAIN": DataType.DOMAIN,
}
"""Data types of objects as the manuals abbreviate them."""

_PLACEHOLDER = re.compile(r"\{([a-z]+)(\+1)?\}")
_BRACES = re.compile(r"\{[^}]*\}?|\}")


def unique(root: Node, key: str, by: str = "id") -> list[Node]:
    """The entries below a key, which differ ``by`` a key of theirs; one that stands twice is noted."""
    seen: dict[str, Node] = {}
    for node in root.items(key):
        name = str(node.get(by))
        if name in seen:
            first = seen[name].at(by)
            node.problems.add("duplicate", node.at(by), f"'{name}' is written twice", other=("first", first))
        seen.setdefault(name, node)
    return list(seen.values())


def fill(text: str, node: Node, key: str, values: Mapping[str, int | str]) -> str:
    """``text`` with its placeholders filled; an unknown one is noted at the value of ``key``."""
    if "{" not in text and "}" not in text:
        return text

    def one(match: re.Match[str]) -> str:
        inner = _PLACEHOLDER.fullmatch(match.group())
        value = values.get(inner.group(1)) if inner else None
        if value is None or inner is None:
            legal = " and ".join("{" + name + "}" for name in values) or "no placeholder"
            node.problems.add(
                "placeholder", node.at(key), f"'{match.group()}' means nothing here", hint=f"{legal} can stand here"
            )
            return match.group()
        return str(value + 1) if inner.group(2) and isinstance(value, int) else str(value)

    return _BRACES.sub(one, text)


def optional_text(node: Node, key: str) -> str | None:
    """Text of a key, ``None`` where it is absent."""
    value = node.get(key)
    return None if value is None else str(value)


def origin(node: Node) -> Origin:
    """Origin of an entry; printed in the manual where nothing else is said."""
    return Origin(node.get("origin", "manual"))


def bounds(run: str) -> tuple[int, int]:
    """First and last of a number or a run ("1...8")."""
    first, _, last = run.partition("...")
    return int(first), int(last or first)


def is_within(run: str, highest: int, node: Node, where: Where) -> bool:
    """Whether a run ascends and ends at ``highest``; noted at ``where`` if not."""
    low, high = bounds(run)
    if low <= high <= highest:
        return True
    node.problems.add(
        "run-order",
        where,
        f"'{run}' does not ascend" if high < low else f"'{run}' goes beyond {highest}, the last possible number",
        hint="write the lower number first" if high < low else f"end at {highest} or before",
    )
    return False


def runs(node: Node, highest: int) -> Iterator[tuple[str, int, int]]:
    """Keys of a mapping that are numbers or runs ("1...8"), each with first and last; order and limit are checked."""
    previous = -1
    for key in node.data:
        if not is_within(key, highest, node, node.at_key(key)):
            continue
        low, high = bounds(key)
        if low <= previous:
            node.problems.add(
                "run-order",
                node.at_key(key),
                f"'{key}' does not follow what stands above it",
                compared=[("last number above", previous)],
                hint="runs ascend and do not overlap",
            )
        previous = max(high, previous)
        yield key, low, high


def run(node: Node, key: str) -> tuple[int, int] | None:
    """First and last of the run of numbers below a key ("1 ... 8"); ``None`` where it is absent."""
    found = node.read(key, value_range)
    if found is None:
        return None
    if found.high < found.low:
        node.problems.add("run-order", node.at(key), f"'{node.get(key)}' goes down", hint="runs ascend")
    return int(found.low), int(found.high)


def options(node: Node, key: str) -> tuple[Option, ...]:
    """The selection list below a key, in the order printed."""
    child = node.child(key)
    if child is None:
        return ()
    return tuple(Option(int(value, 0), str(label)) for value, label in child.data.items())


def bits(node: Node, key: str = "bits") -> tuple[Bit, ...]:
    """The bits below a key, runs expanded."""
    child = node.child(key)
    if child is None:
        return ()
    return tuple(
        Bit(number, fill(str(child.data[run]), child, run, {"n": number, "i": number - low + 1}))
        for run, low, high in runs(child, HIGHEST_BIT)
        for number in range(low, high + 1)
    )


def fields(node: Node, key: str = "fields") -> tuple[BitField, ...]:
    """The bit fields below a key."""
    child = node.child(key)
    if child is None:
        return ()
    return tuple(BitField(low, high, str(child.data[run])) for run, low, high in runs(child, HIGHEST_BIT))


def default(node: Node, key: str, value: object, is_number: bool) -> Default | None:
    """A default: number, text, or a rule over the node address."""
    if value is None or isinstance(value, bool):
        return None
    if isinstance(value, int) or not is_number:
        return value if isinstance(value, int) and is_number else str(value)
    text = str(value)
    if text.startswith("$"):
        return node.read(key, node_relative, text)
    node.problems.add(
        "notation", node.at(key), f"'{text}' is not a number", hint="write an integer or '$NODEID + 0x180'"
    )
    return None


def known_manual(name: str, node: Node, key: str, manuals: Mapping[str, Manual]) -> None:
    """Note a manual that has no file in spec/manuals."""
    if name not in manuals:
        node.problems.add(
            "name-unknown",
            node.at(key),
            f"there is no manual '{name}'",
            hint=suggestion(name, list(manuals), "manuals"),
        )
