"""Checks of codes: index arithmetic, the table of attributes, ranges, defaults, bits, identifiers, mirrors."""

from collections.abc import Iterator

from generator.check.finding import Finding
from generator.model import Code, CodeRef, DataType, Device, Model, NodeRelative, ObjectRef

STRING_CHARACTERS = "characters of ISO 8859-1"
"""What a string on a bus consists of."""


def printed_indexes(model: Model, device: Device) -> Iterator[Finding]:
    """Rule code-index: each printed decimal and hexadecimal index against the canonical one."""
    for code in device.codes:
        for printed in code.printed:
            for form, value in (("decimal", printed.decimal), ("hexadecimal", printed.hexadecimal)):
                if value is not None:
                    yield Finding(
                        rule="code-index",
                        subject=code.ref,
                        place=f"{printed.place} {form}",
                        printed=value,
                        expected=code.index,
                        message=f"{code.designation} has index {code.index} (0x{code.index:X}), not {_as(form, value)}",
                        where=printed.where,
                        variables={"code": code.number, "index": code.index},
                    )


def _as(form: str, value: int) -> str:
    return str(value) if form == "decimal" else f"0x{value:X}"


def names(model: Model, device: Device) -> Iterator[Finding]:
    """Rule code-name: the names that the chapters of the slots and the table of attributes print; capitals aside."""
    for code in device.codes:
        slot = code.slot or "base"
        printed = [(f"chapter {slot}", code.printed_name)]
        if code.attributes and code.attributes.name is not None:
            printed.append((f"table {slot}", code.attributes.name))
        for place, name in printed:
            if name.casefold() != code.name.casefold():
                yield Finding(
                    rule="code-name",
                    subject=code.ref,
                    place=place,
                    printed=name,
                    expected=code.name,
                    message=f"{code.designation} is called '{code.name}', but here '{name}'",
                    where=code.attributes.where if code.attributes else code.where,
                )


def attribute_rows(model: Model, device: Device) -> Iterator[Finding]:
    """Rule code-attributes: the row of the table of attributes against the code's own table."""
    for code in device.codes:
        row = code.attributes
        if row is None:
            continue
        access = ("R" if code.access.read else "") + ("W" if code.access.write else "")
        access += " CINH" if "cinh" in code.access.conditions else ""
        pairs: tuple[tuple[str, int | str, int | str | None], ...] = (
            ("structure", row.structure, "A" if code.is_array else "E"),
            ("count", row.count, code.highest_subcode or 1),
            ("type", row.type_name, code.type_name),
            ("factor", "-" if row.factor is None else row.factor, code.scaling),
            ("access", row.access, access),
        )
        for what, printed, expected in pairs:
            if expected is not None and printed != expected:
                yield Finding(
                    rule="code-attributes",
                    subject=code.ref,
                    place=f"table {code.slot or 'base'} {what}",
                    printed=printed,
                    expected=expected,
                    message=f"the {what} of {code.designation} is {expected} in its own table, but {printed} here",
                    where=row.where,
                )


def ranges(model: Model, device: Device) -> Iterator[Finding]:
    """Rules range-order and range-type: ranges ascend and, scaled, lie inside the data type."""
    for code in device.codes:
        limits = code.range
        if limits is None or not code.data_type.is_number:
            continue
        if limits.low > limits.high:
            yield _value_finding("range-order", code, "range", str(limits.low), str(limits.high), "the range descends")
        factor = code.scaling or 1
        for end, value, bound in (
            ("low", limits.low * factor, code.data_type.lowest),
            ("high", limits.high * factor, code.data_type.highest),
        ):
            if not code.data_type.lowest <= value <= code.data_type.highest:
                message = f"{code.type_name} cannot hold the {end} end {value}"
                yield _value_finding("range-type", code, f"range {end}", str(value), str(bound), message)


def defaults(model: Model, device: Device) -> Iterator[Finding]:
    """Rules default-type and default-range, for the code and each subcode."""
    for code in device.codes:
        for ref, value in _defaults(code):
            if not fits_string(value, code.data_type):
                message = f"{code.type_name} cannot hold the default '{value}'"
                yield _value_finding("default-type", code, "default", str(value), STRING_CHARACTERS, message, ref)
            if not code.data_type.is_number or not isinstance(value, int):
                continue
            if not code.data_type.lowest <= value <= code.data_type.highest:
                message = f"{code.type_name} cannot hold the default {value}"
                yield _value_finding("default-type", code, "default", value, code.data_type.highest, message, ref)
                continue
            options = {option.value for option in code.options}
            if options and value not in options:
                message = f"the default {value} is not in the selection list"
                yield _value_finding("default-range", code, "default", value, min(options), message, ref)
            limits = code.range
            if limits and not limits.low <= value / (code.scaling or 1) <= limits.high:
                message = f"the default {value} lies outside {limits.low} ... {limits.high}"
                yield _value_finding("default-range", code, "default", value, str(limits.low), message, ref)


def _defaults(code: Code) -> Iterator[tuple[CodeRef, object]]:
    yield code.ref, code.default
    for sub in code.subcodes:
        yield CodeRef(code.number, sub.number), sub.default


def selections(model: Model, device: Device) -> Iterator[Finding]:
    """Rule selection-type: selection values inside the data type."""
    for code in device.codes:
        for option in (*code.options, *(o for s in code.subcodes for o in s.options)):
            if not code.data_type.lowest <= option.value <= code.data_type.highest:
                message = f"{code.type_name} cannot hold the selection {option.value} ({option.label})"
                yield _value_finding("selection-type", code, "selection", option.value, code.data_type.highest, message)


def bits(model: Model, device: Device) -> Iterator[Finding]:
    """Rule bit-width: bits and fields inside the data type."""
    for code in device.codes:
        numbers = [(bit.number, bit.label) for bit in code.bits] + [(f.high, f.label) for f in code.fields]
        for number, label in numbers:
            if number >= code.data_type.bits:
                message = f"{code.type_name} has no bit {number} ({label})"
                yield _value_finding("bit-width", code, "bits", number, code.data_type.bits - 1, message)


def identifiers(model: Model, device: Device) -> Iterator[Finding]:
    """Rules reference and cob-id: a default that follows the node address is base plus default node address."""
    yield from _unknown_address(device)
    for code in device.codes:
        node = _node_address(device, code.slot)
        for sub in code.subcodes:
            if sub.follows is None or node is None or not isinstance(sub.default, int):
                continue
            expected = sub.follows.at(node)
            if sub.default != expected:
                yield Finding(
                    rule="cob-id",
                    subject=CodeRef(code.number, sub.number),
                    place="default",
                    printed=sub.default,
                    expected=expected,
                    message=f"with node address {node} the identifier is 0x{expected:X}, not 0x{sub.default:X}",
                    where=sub.where,
                )


def _unknown_address(device: Device) -> Iterator[Finding]:
    facts = device.canopen
    if facts is None or facts.node_address is None or any(c.twin_of == facts.node_address for c in device.codes):
        return
    name = str(CodeRef(facts.node_address))
    yield Finding(
        rule="reference",
        subject=f"device:{device.id}",
        place="node_address",
        printed=name,
        expected="a code of the first slot",
        message=f"the device has no code {name} to hold the node address",
        where=facts.where,
    )


def _node_address(device: Device, slot: str | None) -> int | None:
    wanted = device.canopen.node_address if device.canopen else None
    for code in device.codes:
        if code.twin_of == wanted and code.slot == slot and isinstance(code.default, int):
            return code.default
    return None


def mirrors(model: Model, device: Device) -> Iterator[Finding]:
    """Rules reference and mirror: objects that a code mirrors exist, and name it in their turn."""
    known = {o.index: o for o in device.objects}
    for code in device.codes:
        for ref in code.objects:
            entry = known.get(ref.index)
            if entry is None or (ref.subindex is not None and entry.subindex(ref.subindex) is None):
                yield Finding(
                    rule="reference",
                    subject=code.ref,
                    place="objects",
                    printed=str(ref),
                    expected="an object of the device",
                    message=f"{code.designation} mirrors {ref}, which the device does not have",
                    where=code.where,
                )
                continue
            back = {c.number for s in entry.subindexes for c in s.codes if _concerns(ref, s.number)}
            if code.number not in back:
                yield Finding(
                    rule="mirror",
                    subject=code.ref,
                    place=f"objects {ref}",
                    printed=", ".join(f"C{n:05d}" for n in sorted(back)) or "none",
                    expected=code.designation,
                    message=f"{code.designation} says that it mirrors {ref}, but the overview of objects does not",
                    where=code.where,
                )


def _concerns(ref: ObjectRef, subindex: int) -> bool:
    return ref.subindex is None or ref.subindex == subindex


def _value_finding(
    rule: str, code: Code, place: str, printed: int | str, expected: int | str, message: str, ref: CodeRef | None = None
) -> Finding:
    return Finding(
        rule=rule,
        subject=ref or code.ref,
        place=place,
        printed=printed,
        expected=expected,
        message=f"{ref or code.ref}: {message}",
        where=code.where,
    )


def fits_string(value: object, data_type: DataType) -> bool:
    """Whether a default of a string has characters that travel as one byte each."""
    return data_type.is_number or not isinstance(value, str) or all(char <= "\xff" for char in value)


def fits(value: object, data_type: DataType) -> bool:
    """Whether a default can stand in a data type; texts and rules over the node address are looked at elsewhere."""
    if isinstance(value, NodeRelative):
        return 0 <= value.base <= data_type.highest
    return not isinstance(value, int) or data_type.lowest <= value <= data_type.highest
