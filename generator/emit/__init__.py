"""The targets, one module each; a target never sees YAML or checks."""

from collections.abc import Iterator
from importlib import import_module

from generator.emit.base import Target

NAMES = ("json", "eds", "xdd", "gsd", "c", "python", "rust")
"""Names of the targets: the module in this package, the folder in templates/ and the folder in generated/.

The reference, ``generator.emit.html``, is no target: it is built apart, as a folder to be published."""


def targets() -> Iterator[Target]:
    """Every target, in the order of ``NAMES``."""
    for name in NAMES:
        target = import_module(f"generator.emit.{name}").TARGET
        assert isinstance(target, Target)
        yield target
