"""Layouts of telegrams and the manual's examples."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from generator.diagnostics import suggestion
from generator.elaborate.codes import ErrataIndex
from generator.elaborate.common import fields, optional_text, options, origin, unique
from generator.model import CobId, Example, Field, FieldType, Layout, Option, Sizes, Values
from generator.model.telegram import OPEN, Value
from generator.tree import Node

_REST = "rest"


def layouts(root: Node, cob_ids: Sequence[CobId], errata: ErrataIndex) -> tuple[Layout, ...]:
    """Layouts of a device's telegrams.yaml; ``cob_ids``: the predefined connection set."""
    names = [cob_id.name for cob_id in cob_ids]
    return tuple(_layout(node, names, errata) for node in unique(root, "layouts"))


def _layout(node: Node, names: Sequence[str], errata: ErrataIndex) -> Layout:
    for name in node.texts("identifiers"):
        if name not in names:
            hint = suggestion(name, names, "identifiers")
            node.problems.add("name-unknown", node.at("identifiers"), f"there is no identifier '{name}'", hint=hint)
    big = node.get("byte_order", "little") == "big"
    return Layout(
        id=str(node.get("id")),
        name=str(node.get("name")),
        protocol=str(node.get("protocol")),
        fields=_fields(node, big, []),
        description=str(node.get("description", "")).strip(),
        origin=origin(node),
        cite=node.cite(),
        errata=errata.of(f"layout:{node.get('id')}"),
        where=node.at("id"),
        identifiers=node.texts("identifiers"),
    )


def _fields(node: Node, big: bool, known: list[str]) -> tuple[Field, ...]:
    known = list(known)
    found: list[Field] = []
    for child in node.items("fields"):
        name = str(child.get("name"))
        if name in known:
            child.problems.add("duplicate", child.at("name"), f"the field '{name}' stands twice")
        found.append(_field(child, name, big, known, {field.name: field.sizes for field in found if field.sizes}))
        known.append(name)
    return tuple(found)


def _field(node: Node, name: str, big: bool, known: list[str], sized: Mapping[str, Sizes]) -> Field:
    """A field; ``known`` are the names before it, ``sized`` those beside it whose length depends on others."""
    order = node.get("byte_order")
    kind = FieldType(node.get("type", "uint"))
    sizes = node.child("sizes")
    length = node.get("length")
    if kind is not FieldType.GROUP and length is None and sizes is None and "fill" not in node:
        node.problems.add("key-absent", node.where, f"the field '{name}' has no length", hint="add 'length: 2'")
    for key, value in (("length", length if length != _REST else None), ("count", node.get("count"))):
        _known_field(node, key, value, known)
    if sizes is not None:
        _known_field(sizes, "by", sizes.get("by"), known)
        _known_field(sizes, "times", sizes.get("times"), known)
    return Field(
        name=name,
        title=str(node.get("title", name)),
        type=kind,
        length=None if length == _REST else length,
        sizes=_sizes(sizes) if sizes is not None else _fill(node.child("fill"), sized),
        count=node.get("count"),
        fields=_fields(node, big, known),
        big=big if order is None else order == "big",
        constant=node.get("constant"),
        values=options(node, "values"),
        bits=fields(node, "bits"),
        bit_values=tuple(_bit_values(node)),
        description=str(node.get("description", "")).strip(),
        where=node.at("name"),
        errors=optional_text(node, "errors"),
    )


def _known_field(node: Node, key: str, name: object, known: list[str]) -> None:
    if isinstance(name, str) and name not in known:
        hint = suggestion(name, known, "earlier fields")
        node.problems.add("name-unknown", node.at(key), f"there is no earlier field '{name}'", hint=hint)


def _sizes(node: Node) -> Sizes:
    table = node.child("sizes")
    assert table is not None
    return Sizes(str(node.get("by")), tuple((int(k, 0), int(v)) for k, v in table.data.items()), node.get("times"))


def _fill(node: Node | None, sized: Mapping[str, Sizes]) -> Sizes | None:
    if node is None:
        return None
    name = str(node.get("of"))
    if name not in sized:
        hint = suggestion(name, list(sized), "fields whose length depends on others")
        node.problems.add("name-unknown", node.at("of"), f"there is no such field '{name}' before it", hint=hint)
        return None
    return replace(sized[name], fills=int(node.get("to")))


def _bit_values(node: Node) -> list[tuple[str, tuple[Option, ...]]]:
    parent = node.child("bit_values")
    if parent is None:
        return []
    parts = [bits.label for bits in fields(node, "bits")]
    for name in parent.data:
        if name not in parts:
            hint = suggestion(name, parts, "parts")
            node.problems.add("name-unknown", parent.at_key(name), f"the field has no part '{name}'", hint=hint)
    return [(name, options(parent, name)) for name in parent.data]


def examples(root: Node, known: Mapping[str, Layout], errata: ErrataIndex) -> tuple[Example, ...]:
    """Worked telegrams of a device's telegrams.yaml."""
    found = []
    for node in unique(root, "examples"):
        name = str(node.get("layout"))
        if name not in known:
            hint = suggestion(name, list(known), "layouts")
            node.problems.add("name-unknown", node.at("layout"), f"there is no layout '{name}'", hint=hint)
            continue
        printed = _octets(str(node.get("bytes")))
        found.append(
            Example(
                id=str(node.get("id")),
                name=str(node.get("name")),
                layout=name,
                direction=str(node.get("direction")),
                sequence=node.get("sequence"),
                node=node.get("node"),
                identifier=node.get("identifier"),
                printed=printed,
                data=_octets(str(node.get("used"))) if "used" in node else printed,
                values=_values(node.get("values")),
                meaning=str(node.get("meaning", "")).strip(),
                cite=node.cite(),
                errata=errata.of(f"telegram:{node.get('id')}"),
                where=node.at("bytes"),
            )
        )
    return tuple(found)


def _octets(text: str) -> tuple[int | None, ...]:
    return tuple(None if "X" in octet or "?" in octet else int(octet, 16) for octet in text.split())


def _values(data: Mapping[str, object]) -> Values:
    return {key: _value(value) for key, value in data.items()}


def _value(value: object) -> Value:
    if isinstance(value, list):
        return tuple(_values(entry) for entry in value)
    return value if isinstance(value, int) else OPEN if value == OPEN else str(value)
