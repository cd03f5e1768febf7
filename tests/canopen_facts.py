"""What an object dictionary has to hold, worked out from the model apart from the targets."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from generator.model import Code, DataType, Device, Model, NodeRelative, Option, Range

NODE = 5
"""Node-ID at which formulas are compared."""


@dataclass(frozen=True)
class Fact:
    """What a file has to say of a value; ``name`` is "" where the manual prints none."""

    name: str
    data_type: int | None
    access: str | None
    low: object
    high: object
    default: object
    mappable: bool


@dataclass(frozen=True)
class Case:
    """An EDS, and the device, slot and product that it stands for."""

    path: Path
    device: Device
    slot: str | None
    product: Option | None

    @property
    def xdd(self) -> Path:
        """The XDD beside it."""
        return self.path.parent.parent / "xdd" / f"{self.path.stem}.xdd"

    @property
    def facts(self) -> dict[tuple[int, int], Fact]:
        """Facts by index and sub-index."""
        facts = dict(_object_facts(self.device, self.product))
        for code in self.device.codes_of_slot(self.slot):
            if not code.internal:
                facts.update(_code_facts(code))
        return facts


def _object_facts(device: Device, product: Option | None) -> Iterator[tuple[tuple[int, int], Fact]]:
    for entry in device.objects:
        if entry.kind != "canopen":
            continue
        for sub in entry.subindexes:
            if sub.abort is not None:
                continue
            default = sub.default
            if entry.index == 0x1018 and sub.number == 2 and product:
                default = product.value
            elif default is None and _zero_is_assumed(entry.index, sub.number):
                default = 0
            elif entry.object_type != "VAR" and sub.number == 0 and default is None:
                default = entry.subindexes[-1].number
            name = entry.name if entry.object_type == "VAR" else sub.name
            yield (
                (entry.index, sub.number),
                _fact(name, sub.data_type, sub.access, sub.range, 1, default, sub.pdo_mapping),
            )


def _zero_is_assumed(index: int, subindex: int) -> bool:
    """Identity numbers and mapping entries, which tools demand."""
    return (index == 0x1018 and subindex in (1, 2, 3)) or index & 0xFE00 == 0x1600 or index & 0xFE00 == 0x1A00


def _code_facts(code: Code) -> Iterator[tuple[tuple[int, int], Fact]]:
    access = {(True, True): "rw", (True, False): "ro", (False, True): "wo"}[code.access.read, code.access.write]
    mappable = bool({"pdo_map_rx", "pdo_map_tx"} & set(code.access.conditions))
    rest = (code.data_type, access, code.range, code.scaling or 1)
    if not code.subcodes:
        yield (code.index, 0), _fact(f"{code.designation} {code.name}", *rest, code.default, mappable)
        return
    yield (code.index, 0), Fact("", 0x0005, "ro", None, None, code.subcodes[-1].number, False)
    for sub in code.subcodes:
        name = f"{code.designation}/{sub.number} {sub.name or code.name}"
        yield (code.index, sub.number), _fact(name, *rest, sub.follows or sub.default, mappable)


def _fact(
    name: str,
    data_type: DataType,
    access: str,
    limits: Range | None,
    scaling: int,
    default: int | str | NodeRelative | None,
    mappable: bool,
) -> Fact:
    low = high = None
    if limits and data_type.bits:
        low = max(math.ceil(limits.low * scaling), data_type.lowest)
        high = min(math.floor(limits.high * scaling), data_type.highest)
    if isinstance(default, NodeRelative):
        default = default.base + NODE
    if default is None and data_type.bits:
        if low is not None and low > 0:
            default = low
        elif high is not None and high < 0:
            default = high
        elif mappable:
            default = 0
    return Fact(name, data_type.canopen_number, access, low, high, default, mappable)


def spoken(name: str) -> list[str]:
    """Letters and digits of a name: what has to survive its way into ASCII."""
    return re.findall(r"[A-Za-z0-9]+", name)


def named(found: str, fact: Fact) -> bool:
    """Whether ``found`` is the printed name, perhaps with the number that tells it from equal ones."""
    return spoken(found)[: len(spoken(fact.name))] == spoken(fact.name) if fact.name.isascii() else bool(found)


def all_cases(model: Model, generated: Path) -> list[Case]:
    """Every EDS that the model makes."""
    found = []
    for device in model.devices:
        if device.canopen is None:
            continue
        identity = next((entry for entry in device.objects if entry.index == 0x1018), None)
        code = identity.subindex(2) if identity else None
        slots: list[str | None] = [slot.name for slot in device.slots]
        for slot in slots or [None]:
            for product in (code.options if code else ()) or [None]:
                words = spoken(device.order_code) + spoken(slot or "") + spoken(product.label if product else "")
                found.append(Case(generated / "eds" / f"{'_'.join(words)}.eds", device, slot, product))
    return found
