"""A simulated device on a virtual bus: a slave of python-durand that holds what Lely's dcf-tools read from an EDS.

Neither shares code with python-canopen, which the tests use as the master.
"""

import asyncio
import threading
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TypeVar

import can
import dcf
from durand import CANBusNetwork, DatatypeEnum, Node, Record, Variable, set_scheduler
from durand.node import NodeCapabilities
from durand.object_dictionary import ObjectDictionary
from durand.scheduler import AsyncScheduler

T = TypeVar("T")
_TIMEOUT = 10.0
_LOOP = asyncio.new_event_loop()
"""Where all slaves live: python-durand has one scheduler for all of them."""


class _Described(Record):  # type: ignore[misc]
    """An object with the sub-indexes of the file, sub-index 0 among them."""

    def __init__(self, name: str, variables: dict[int, Variable]) -> None:
        super().__init__(name)
        self._variables = variables

    def __getitem__(self, subindex: int) -> Variable:
        return self._variables[subindex]


class Slave:
    """The device, on the bus until ``stop``; ``extra`` are values that no EDS describes, by index."""

    def __init__(self, eds: Path, node: int, channel: str, extra: dict[int, tuple[DatatypeEnum, int | bytes]]) -> None:
        """Put the device on the bus ``channel``; it sends its boot-up message."""
        self._described = dcf.Device.from_dcf(str(eds), {"NODEID": node})
        self._extra = extra
        _start()
        self._bus = can.Bus(interface="virtual", channel=channel)
        self._network = CANBusNetwork(self._bus, _LOOP)
        self.node = self.run(lambda: self._node(node))

    def _node(self, number: int) -> Node:
        count = {
            area: sum(area <= index < area + size for index in self._described)
            for area, size in ((0x1200, 0x80), (0x1400, 0x200), (0x1800, 0x200))
        }
        node = Node(
            self._network,
            number,
            capabilities=NodeCapabilities(sdo_servers=max(1, count[0x1200]), rpdos=count[0x1400], tpdos=count[0x1800]),
        )
        node.object_dictionary = self._dictionary(node.object_dictionary)
        return node

    def _dictionary(self, services: ObjectDictionary) -> ObjectDictionary:
        """What the file describes, with the callbacks of the services but without what they would add."""
        found = ObjectDictionary()
        found.update_callbacks = services.update_callbacks
        found.download_callbacks = services.download_callbacks
        for index, entry in self._described.items():
            variables = {subindex: _variable(entry[subindex]) for subindex in entry}
            found[index] = _Described(entry.name, variables)
        for index, (data_type, value) in self._extra.items():
            found[index] = _Described("", {0: Variable(data_type, "rw", value)})
        return found

    def run(self, action: Callable[[], T]) -> T:
        """Result of the action, which runs in the thread of the devices."""

        async def act() -> T:
            return action()

        return asyncio.run_coroutine_threadsafe(act(), _LOOP).result(_TIMEOUT)

    def value(self, index: int, subindex: int) -> int | bytes:
        """Value that the device holds."""
        found: int | bytes = self.run(lambda: self.node.object_dictionary.read(index, subindex))
        return found

    def set(self, index: int, subindex: int, value: int | bytes) -> None:
        """Let the application of the device change a value."""
        self.run(lambda: self.node.object_dictionary.write(index, subindex, value))

    def state(self) -> int:
        """State of network management as the heartbeat has it: 4 stopped, 5 operational, 127 pre-operational."""
        return self.run(lambda: int(self.node.nmt.state))

    def report(self, code: int, register: int, data: bytes = b"") -> None:
        """Send an emergency telegram."""
        self.run(lambda: self.node.emcy.set(code, register, data))

    def stop(self) -> None:
        """Take the device off the bus."""
        self._network.stop()
        self._bus.shutdown()


@cache
def _start() -> None:
    set_scheduler(AsyncScheduler(_LOOP))
    threading.Thread(target=_LOOP.run_forever, daemon=True).start()


def _variable(entry: dcf.device.SubObject) -> Variable:
    data_type = DatatypeEnum(entry.data_type.index)
    if not entry.data_type.is_basic():
        return Variable(data_type, entry.access_type.name, b"", name=entry.name)
    return Variable(
        data_type,
        entry.access_type.name,
        entry.parse_value(),
        minimum=_limit(entry, "low_limit"),
        maximum=_limit(entry, "high_limit"),
        name=entry.name,
    )


def _limit(entry: dcf.device.SubObject, name: str) -> int | None:
    limit = getattr(entry, name, None)
    return None if limit is None else limit.parse(entry.env)
