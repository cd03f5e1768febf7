"""Names of the last release."""

from collections.abc import Iterator

from generator.model import Pin
from generator.tree import SourceFile


def pins(file: SourceFile) -> Iterator[Pin]:
    """Every name that spec/names.yaml holds."""
    for device, names in file.root.children("devices"):
        for name in names.data:
            yield Pin(str(file.data["version"]), device, name, int(names.data[name]), names.at_key(name))
