"""Rust as text: literals, expressions broken as rustfmt breaks them, documentation comments, names of types."""

import re
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from generator.naming import safe, words

WIDTH = 120
"""Longest line; the crate's rustfmt.toml says the same."""

_INDENT = 4
_STRING = {ord("\\"): "\\\\", ord('"'): '\\"', ord("\n"): "\\n", ord("\t"): "\\t", ord("\r"): "\\r"}
_MARKDOWN = {ord(character): "\\" + character for character in "\\`*[]<>~|"}
_EDGE_UNDERSCORE = re.compile(r"(?<![A-Za-z0-9])_|_(?![A-Za-z0-9])")
_EMPTY = frozenset({"None", "&[]", "false", '""'})
_LIST_MARK = re.compile(r"[-+#]|[0-9]+[.)]")


@dataclass(frozen=True, slots=True)
class Group:
    """Expression of several items, which get a line each when it is too long for one line; ``flat`` is the one line."""

    opening: str
    items: "tuple[Expression, ...]"
    closing: str
    flat: str


Expression = str | Group


def struct(name: str, fields: Iterable[tuple[str, Expression]]) -> Group:
    """Struct expression."""
    return _group(f"{name} {{", [prefixed(f"{field}: ", value) for field, value in fields], "}", " ")


def shorthand(name: str, fields: Iterable[str]) -> Group:
    """Struct expression of variables that have the names of the fields."""
    return _group(f"{name} {{", list(fields), "}", " ")


def brief(name: str, fields: Iterable[tuple[str, Expression]]) -> Group:
    """Struct expression without the fields that ``EMPTY`` of the type gives: ``None``, empty lists and texts, false."""
    listed = list(fields)
    own = [prefixed(f"{field}: ", value) for field, value in listed if value not in _EMPTY]
    return _group(f"{name} {{", own if len(own) == len(listed) else [*own, f"..{name}::EMPTY"], "}", " ")


def difference(
    name: str, fields: Iterable[tuple[str, Expression]], base: str, base_fields: Mapping[str, Expression]
) -> Group:
    """Struct expression of the fields that differ from ``base_fields``; the constant ``base`` gives the others."""
    own = [prefixed(f"{field}: ", value) for field, value in fields if value != base_fields.get(field)]
    return _group(f"{name} {{", [*own, f"..{base}"], "}", " ")


def array(items: Iterable[Expression]) -> Expression:
    """Reference to an array; a single item stays on the lines of the brackets."""
    listed = list(items)
    if not listed:
        return "&[]"
    return prefixed("&[", listed[0], "]") if len(listed) == 1 else _group("&[", listed, "]", "")


def numbers(values: Iterable[int]) -> str:
    """Lines of the items of an array, as many on a line as fit; for what rustfmt is told to leave alone."""
    indent = " " * _INDENT
    return textwrap.fill(
        " ".join(f"{value}," for value in values), WIDTH, initial_indent=indent, subsequent_indent=indent
    )


def prefixed(before: str, expression: Expression, after: str = "") -> Expression:
    """``expression`` with text around it that stays on its first and last line."""
    if isinstance(expression, str):
        return before + expression + after
    return Group(
        before + expression.opening, expression.items, expression.closing + after, before + expression.flat + after
    )


def some(expression: Expression | None) -> Expression:
    """``Some(...)`` or ``None``."""
    return "None" if expression is None else prefixed("Some(", expression, ")")


def declaration(name: str, kind: str, value: Expression, indent: int = 0, visibility: str = "pub ") -> str:
    """Item of a constant of the type ``kind``; without indent on its first line."""
    return statement(f"{visibility}const {name}: {kind} =", value, indent)


def statement(head: str, value: Expression, indent: int) -> str:
    """``head`` (``let name =`` or empty) with a value, ended; without indent on its first line."""
    before = f"{head} " if head else ""
    flat = value if isinstance(value, str) else value.flat
    if head and len(before) + len(flat) + 1 + indent > WIDTH >= indent + _INDENT + len(flat) + 1:
        return f"{head}\n{' ' * (indent + _INDENT)}{flat};"
    return layout(prefixed(before, value, ";"), indent)


def layout(expression: Expression, indent: int = 0, after: int = 0) -> str:
    """Text of ``expression`` that begins at column ``indent``; ``after`` characters follow on its last line."""
    flat = expression if isinstance(expression, str) else expression.flat
    if isinstance(expression, str) or indent + len(flat) + after <= WIDTH:
        return flat
    pad = "\n" + " " * (indent + _INDENT)
    lines = [
        layout(item, indent + _INDENT, 1) + ("" if isinstance(item, str) and item.startswith("..") else ",")
        for item in expression.items
    ]
    return expression.opening + pad + pad.join(lines) + "\n" + " " * indent + expression.closing


def _group(opening: str, items: Sequence[Expression], closing: str, space: str) -> Group:
    inner = ", ".join(item if isinstance(item, str) else item.flat for item in items)
    return Group(opening, tuple(items), closing, f"{opening}{space}{inner}{space}{closing}")


def string(text: str) -> str:
    r"""String literal.

    >>> print(string('the "C" slot'))
    "the \"C\" slot"
    """
    return f'"{text.translate(_STRING)}"'


def boolean(value: bool) -> str:
    """Literal of a truth value."""
    return "true" if value else "false"


def hexadecimal(value: int, digits: int) -> str:
    """Hexadecimal literal of at least ``digits`` digits, in groups of four.

    >>> hexadecimal(0x9D0000, 8), hexadecimal(0x2BC6, 4), hexadecimal(-1, 2)
    ('0x009D_0000', '0x2BC6', '-0x01')
    """
    text = f"{abs(value):0{digits}X}"
    head = len(text) % 4
    groups = [text[:head]] if head else []
    groups += [text[start : start + 4] for start in range(head, len(text), 4)]
    return ("-" if value < 0 else "") + "0x" + "_".join(groups)


def type_name(*parts: str) -> str:
    """Parts as a name in ``PascalCase``; ``_`` keeps figures apart that would run together.

    >>> type_name("c13372", "3", "7 ns"), type_name("10 %"), type_name("self")
    ('C13372_3_7Ns', 'N10Percent', 'Self_')
    """
    name = ""
    for word in (word for part in parts for word in words(part)):
        name += "_" if name[-1:].isdecimal() and word[0].isdecimal() else ""
        name += word[0].upper() + word[1:]
    return safe(name, "rust", "N")


def constant_name(name: str) -> str:
    """Name in snake case as the name of a constant.

    >>> constant_name("c13350_can_node_address"), constant_name("7_ns")
    ('C13350_CAN_NODE_ADDRESS', 'N7_NS')
    """
    return safe(name, "rust").upper()


def markdown(text: str) -> str:
    r"""Text in which nothing is markup for rustdoc; web addresses become links.

    >>> print(markdown("values [0] < 5 of LS_SyncInput"))
    values \[0\] \< 5 of LS_SyncInput
    """
    if "://" in text:
        return " ".join(f"<{word}>" if "://" in word else _plain(word) for word in text.split())
    return _plain(text)


def _plain(text: str) -> str:
    text = text.translate(_MARKDOWN)
    return _EDGE_UNDERSCORE.sub(r"\\_", text) if "_" in text else text


def doc(paragraphs: Iterable[str], points: Iterable[str] = (), mark: str = "///", indent: int = 0) -> str:
    """Documentation comment: paragraphs, then a list of points, wrapped; without indent on its first line."""
    pad = " " * indent
    width = WIDTH - indent - len(mark) - 1
    blocks = ["\n".join(_wrap(text, width, "", "")) for text in paragraphs if text]
    listed = "\n".join("\n".join(_wrap(text, width, "- ", "  ")) for text in points if text)
    if listed:
        blocks.append(listed)
    lines = "\n\n".join(blocks).split("\n")
    return f"\n{pad}".join(f"{mark} {line}" if line else mark for line in lines)


def _wrap(text: str, width: int, first: str, rest: str) -> list[str]:
    head, _, tail = text.partition(" ")
    if _LIST_MARK.fullmatch(head):
        text = f"{head[:-1]}\\{head[-1]} {tail}"
    if len(first) + len(text) <= width and "\n" not in text:
        return [first + text]
    line, *others = text.split()
    line = first + line
    lines: list[str] = []
    for word in others:
        if len(line) + 1 + len(word) <= width:
            line = f"{line} {word}"
        elif _LIST_MARK.fullmatch(word):
            # A word that would begin a list takes the word before it along.
            line, _, last = line.rpartition(" ")
            lines.append(line)
            line = f"{rest}{last} {word}"
        else:
            lines.append(line)
            line = rest + word
    return [*lines, line]
