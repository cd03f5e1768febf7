"""Names that the generated C, Python and Rust give to a code or object, as a program writes them."""

from collections.abc import Iterator, Sequence

from generator.emit.c.device import device_prefix
from generator.emit.html.blocks import Fact
from generator.emit.html.text import Piece, joined
from generator.emit.names import code_name, object_name
from generator.emit.rust.syntax import constant_name
from generator.model import Code, Device, DictionaryObject
from generator.naming import snake


def code_names(device: Device, codes: Sequence[Code]) -> tuple[Fact, ...]:
    """Names of the same code in every slot, by language."""
    return tuple(_facts(device, "codes", [(code.designation, code_name(code)) for code in codes]))


def object_names(device: Device, entry: DictionaryObject) -> tuple[Fact, ...]:
    """Names of an object, by language."""
    return tuple(_facts(device, "objects", [(snake(entry.designation).replace("_", ""), object_name(entry))]))


def _facts(device: Device, module: str, named: Sequence[tuple[str, str]]) -> Iterator[Fact]:
    """Names by language; each thing by its designation and by its name in snake case."""
    package = snake(device.id)
    for language, found in (
        ("C", [f"{device_prefix(device)}_{designation.upper()}_INDEX" for designation, _ in named]),
        ("Python", [f"{package}.{name.upper()}" for _, name in named]),
        ("Rust", [f"{package}::{module}::{constant_name(name)}" for _, name in named]),
    ):
        yield Fact(language, joined([(Piece(name, tag="code"),) for name in found], " "))
