"""Names that the generated C, Python and Rust give to a code, object or error, as a program writes them."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby

from generator.emit.c.device import device_prefix, error_symbols
from generator.emit.html.blocks import Fact
from generator.emit.html.text import Piece, joined
from generator.emit.names import code_name, object_name
from generator.emit.python.device import error_names as python_error_names
from generator.emit.rust.device import error_names as rust_error_names
from generator.emit.rust.syntax import constant_name
from generator.model import Code, Device, DictionaryObject, ErrorEntry
from generator.naming import snake


def code_names(device: Device, codes: Sequence[Code]) -> tuple[Fact, ...]:
    """Names of the same code in every slot, by language."""
    return tuple(_facts(device, "codes", [(code.designation, code_name(code)) for code in codes]))


def object_names(device: Device, entry: DictionaryObject) -> tuple[Fact, ...]:
    """Names of an object, by language."""
    return tuple(_facts(device, "objects", [(snake(entry.designation).replace("_", ""), object_name(entry))]))


class ErrorNames:
    """Names of the errors of a device; those of a list depend on each other."""

    def __init__(self, device: Device) -> None:
        """Settle the names of all errors."""
        package = snake(device.id)
        names: dict[str, dict[tuple[str, int], list[str]]] = {"C": {}, "Python": {}, "Rust": {}}
        for error, name in zip(device.errors, python_error_names(device.errors), strict=True):
            key = error.kind, error.number
            names["C"][key] = list(error_symbols(device, error))
            names["Python"][key] = [f"{package}.{name}"]
        for kind, errors in groupby(device.errors, key=lambda error: error.kind):
            of_kind = list(errors)
            for error, name in zip(of_kind, rust_error_names(of_kind), strict=True):
                path = f"{package}::errors::{kind}::{name}"
                names["Rust"][kind, error.number] = [path] if error.count == 1 else [path, f"{path}_LAST"]
        self._names = names

    def of(self, entry: Sequence[ErrorEntry]) -> tuple[Fact, ...]:
        """Names of the same error in every slot, by language; C and Rust name both ends of a run."""
        return tuple(
            _names(language, (name for error in entry for name in found[error.kind, error.number]))
            for language, found in self._names.items()
        )


def _facts(device: Device, module: str, named: Sequence[tuple[str, str]]) -> Iterator[Fact]:
    """Names by language; each thing by its designation and by its name in snake case."""
    package = snake(device.id)
    yield _names("C", (f"{device_prefix(device)}_{designation.upper()}_INDEX" for designation, _ in named))
    yield _names("Python", (f"{package}.{name.upper()}" for _, name in named))
    yield _names("Rust", (f"{package}::{module}::{constant_name(name)}" for _, name in named))


def _names(language: str, names: Iterable[str]) -> Fact:
    return Fact(language, joined([(Piece(name, tag="code"),) for name in names], " "))
