"""Public names of facts, the same in every language: a target only applies its own case to them.

A name begins with the manual's own designation (C13350, I1018), so that it leads back to the manual, and goes on
with the words of the label.
"""

from collections import Counter
from collections.abc import Sequence

from generator.model import Bit, BitField, Code, DictionaryObject, ErrorEntry, Option, SubIndex
from generator.naming import snake


def code_name(code: Code) -> str:
    """Name of a code in snake case, for example ``c13350_can_node_address``."""
    return snake(code.designation, code.name)


def object_name(entry: DictionaryObject) -> str:
    """Name of an object in snake case: ``i1018_identity_object``, ``pnu918_node_address``."""
    return snake(entry.designation.replace("-", "").replace(" ", ""), entry.name)


def subindex_name(entry: DictionaryObject, sub: SubIndex) -> str:
    """Name of a sub-index in snake case: ``i1018_1_vendor_id``."""
    return snake(entry.designation.replace("-", "").replace(" ", ""), str(sub.number), sub.name)


def error_name(error: ErrorEntry) -> str:
    """Name of an error in snake case, after its designation."""
    return snake(error.name)


def option_names(options: Sequence[Option]) -> tuple[str, ...]:
    """Names of a selection list in snake case; a label that stands more than once gets its value appended."""
    return _distinct([(option.label, option.value) for option in options])


def bit_names(bits: Sequence[Bit]) -> tuple[str, ...]:
    """Names of bits in snake case; a label that stands more than once gets its bit number appended."""
    return _distinct([(bit.label, bit.number) for bit in bits])


def field_names(fields: Sequence[BitField]) -> tuple[str, ...]:
    """Names of bit fields in snake case; a label that stands more than once gets its lowest bit appended."""
    return _distinct([(field.label, field.low) for field in fields])


def _distinct(entries: Sequence[tuple[str, int]]) -> tuple[str, ...]:
    names = [snake(label) for label, _ in entries]
    counts = Counter(names)
    return tuple(
        f"{name}_{'minus_' if number < 0 else ''}{abs(number)}" if counts[name] > 1 or not name else name
        for name, (_, number) in zip(names, entries, strict=True)
    )
