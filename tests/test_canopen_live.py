"""Masters and slaves made from the EDS files talk to each other on a virtual bus.

python-canopen is the master; the slave is python-durand's, filled by Lely's dcf-tools.  Each reads the EDS for itself,
and what they agree on is compared with the model.
"""

import queue
import struct
import time
import uuid
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import can
import canopen
import pytest
from canopen.emcy import EmcyError
from canopen.sdo.client import SdoClient
from canopen.sdo.exceptions import SdoAbortedError
from canopen_facts import NODE, Case, Fact, all_cases
from canopen_slave import Slave
from durand import DatatypeEnum

from generator.dcf import Request, files
from generator.model import DataType, Device, Example, Model

READ_ONLY = 0x06010002
NO_OBJECT = 0x06020000
WRONG_LENGTH = 0x06070010
NO_SUBINDEX = 0x06090011
TOO_HIGH = 0x06090031
TOO_LOW = 0x06090032
ACTING = {0x1003, 0x1005, 0x1010, 0x1011, 0x1014, 0x1017}
"""Objects that do more than keep a value; writing them has tests of its own."""
TIMEOUT = 10.0
MARK = 0x7FF
"""Identifier that nobody else uses."""
CODES: dict[int, tuple[DatatypeEnum, int | bytes]] = {
    24575 - 61: (DatatypeEnum.INTEGER32, 43),
    24575 - 88: (DatatypeEnum.UNSIGNED32, 0),
    24575 - 99: (DatatypeEnum.VISIBLE_STRING, b"01.00.00.00"),
}
"""Codes of the base drive that the examples speak of and no EDS describes."""


@dataclass
class Bus:
    """A master, a slave, and a listener that keeps every frame."""

    case: Case
    slave: Slave
    network: canopen.Network
    node: canopen.RemoteNode
    frames: "queue.Queue[can.Message]"
    listener: can.Notifier

    def stop(self) -> None:
        """Take everyone off the bus."""
        self.listener.stop()
        self.network.disconnect()
        self.slave.stop()

    def next(self, count: int) -> list[tuple[int, bytes]]:
        """The next frames on the bus."""
        messages = [self.frames.get(timeout=TIMEOUT) for _ in range(count)]
        return [(message.arbitration_id, bytes(message.data)) for message in messages]

    def sent(self) -> list[tuple[int, bytes]]:
        """Frames since the last call: those before a mark that is sent now."""
        self.network.send_message(MARK, b"")
        found: list[tuple[int, bytes]] = []
        while (MARK, b"") not in found:
            found += self.next(1)
        return found[:-1]

    def answer(self, data: bytes) -> tuple[int, bytes]:
        """What the slave sends after a request on the basic parameter channel."""
        request = 0x600 + self.slave.node.node_id
        self.sent()
        self.network.send_message(request, data)
        sent, received = self.next(2)
        assert sent == (request, data)
        return received

    def abort_code(self, index: int, subindex: int, data: bytes | None = None) -> int:
        """Abort code of writing ``data``, or of reading; 0 where the slave does as it is told."""
        try:
            if data is None:
                self.node.sdo.upload(index, subindex)
            else:
                self.node.sdo.download(index, subindex, data)
        except SdoAbortedError as error:
            return error.code
        return 0


@pytest.fixture(scope="module")
def buses(model: Model, generated: Path) -> Iterator[Callable[..., Bus]]:
    """Buses by EDS and node, made once."""
    made: dict[tuple[str, int], Bus] = {}

    def bus(case: Case, node: int = NODE) -> Bus:
        if (case.path.name, node) not in made:
            made[case.path.name, node] = _bus(case, node)
        return made[case.path.name, node]

    yield bus
    with ThreadPoolExecutor(len(made)) as pool:
        list(pool.map(Bus.stop, made.values()))


def _bus(case: Case, node: int) -> Bus:
    channel = str(uuid.uuid4())
    network = canopen.Network()
    network.connect(interface="virtual", channel=channel)
    master = network.add_node(node, str(case.path))
    master.sdo.RESPONSE_TIMEOUT = TIMEOUT
    frames: queue.Queue[can.Message] = queue.Queue()
    listener = can.Notifier(can.Bus(interface="virtual", channel=channel), [frames.put], timeout=0.1)
    return Bus(case, Slave(case.path, node, channel, CODES), network, master, frames, listener)


@pytest.fixture(scope="module")
def cases(model: Model, generated: Path) -> list[Case]:
    """One EDS of each device and slot."""
    found = {(case.device.id, case.slot): case for case in all_cases(model, generated)}
    assert len(found) >= 3
    return list(found.values())


@pytest.fixture(scope="module")
def modules(cases: list[Case]) -> list[Case]:
    """The files of the E94AYCCA, one for each slot."""
    return [case for case in cases if case.device.id == "e94aycca"]


def _numbers(case: Case) -> Iterator[tuple[int, int, Fact, DataType]]:
    for (index, subindex), fact in case.facts.items():
        kind = next(kind for kind in DataType if kind.canopen_number == fact.data_type)
        if kind.is_number:
            yield index, subindex, fact, kind


def _bytes(value: int, kind: DataType) -> bytes:
    return value.to_bytes(kind.bits // 8, "little", signed=value < 0)


# Parameters


def test_identity(buses: Callable[..., Bus], cases: list[Case]) -> None:
    for case in cases:
        bus = buses(case)
        identity = bus.node.sdo[0x1018]
        found = {sub: identity[sub].raw for sub in (1, 2, 3)}
        assert found == {sub: case.facts[0x1018, sub].default for sub in (1, 2, 3)}
        information = bus.node.object_dictionary.device_information
        assert found == {1: information.vendor_number, 2: information.product_number, 3: information.revision_number}


def test_every_value_is_read(buses: Callable[..., Bus], cases: list[Case]) -> None:
    for case in cases:
        bus = buses(case)
        for index, subindex, fact, kind in _numbers(case):
            if fact.access == "wo":
                continue
            data = bus.node.sdo.upload(index, subindex)
            assert data == _bytes(int(str(fact.default or 0)), kind), (hex(index), subindex)
            assert bus.node.sdo.get_variable(index, subindex).raw == (fact.default or 0)


def test_every_writable_number_is_written_and_read_back(buses: Callable[..., Bus], cases: list[Case]) -> None:
    written = 0
    for case in cases:
        bus = buses(case)
        for index, subindex, fact, kind in _numbers(case):
            if fact.access != "rw" or index in ACTING or 0x1200 <= index < 0x2000:
                continue
            variable = bus.node.sdo.get_variable(index, subindex)
            assert variable is not None
            for value in (_lowest(fact, kind), _highest(fact, kind), int(str(fact.default or 0))):
                variable.raw = value
                assert variable.raw == value == bus.slave.value(index, subindex), (hex(index), subindex)
            written += 1
    assert written > 300


def test_values_outside_the_limits_are_refused(buses: Callable[..., Bus], cases: list[Case]) -> None:
    refused = set()
    for case in cases:
        bus = buses(case)
        for index, subindex, fact, kind in _numbers(case):
            if fact.access != "rw":
                continue
            before = bus.slave.value(index, subindex)
            for value, code in ((_highest(fact, kind) + 1, TOO_HIGH), (_lowest(fact, kind) - 1, TOO_LOW)):
                if kind.lowest <= value <= kind.highest:
                    assert bus.abort_code(index, subindex, _bytes(value, kind)) == code, (hex(index), subindex)
                    refused.add((case.path.name, index, code))
            assert bus.slave.value(index, subindex) == before
    assert {code for _, _, code in refused} == {TOO_HIGH, TOO_LOW}
    assert len(refused) > 10


def _lowest(fact: Fact, kind: DataType) -> int:
    return fact.low if isinstance(fact.low, int) else kind.lowest


def _highest(fact: Fact, kind: DataType) -> int:
    return fact.high if isinstance(fact.high, int) else kind.highest


def test_what_can_only_be_read_is_not_written(buses: Callable[..., Bus], cases: list[Case]) -> None:
    for case in cases:
        bus = buses(case)
        for index, subindex, fact, kind in _numbers(case):
            if fact.access in ("ro", "const"):
                assert bus.abort_code(index, subindex, bytes(kind.bits // 8)) == READ_ONLY, (hex(index), subindex)


def test_what_is_not_described_does_not_exist(buses: Callable[..., Bus], cases: list[Case]) -> None:
    for case in cases:
        bus = buses(case)
        indexes = {index for index, _ in case.facts}
        for index in (0x1002, 0x2000, 0x5FFF, 0xFFFF):
            assert index not in indexes
            assert bus.abort_code(index, 0) == NO_OBJECT
        for index in indexes:
            highest = max(subindex for i, subindex in case.facts if i == index)
            assert bus.abort_code(index, highest + 1) == NO_SUBINDEX
            assert bus.abort_code(index, highest + 1, b"\0") == NO_SUBINDEX


def test_refusals_of_the_manual(buses: Callable[..., Bus], cases: list[Case]) -> None:
    refused = 0
    for case in cases:
        for entry in case.device.objects:
            for sub in entry.subindexes:
                if sub.abort is not None:
                    assert buses(case).abort_code(entry.index, sub.number) == sub.abort
                    refused += 1
    assert refused


def test_data_of_the_wrong_length_is_refused(buses: Callable[..., Bus], modules: list[Case]) -> None:
    for case in modules:
        bus = buses(case)
        assert bus.abort_code(0x1006, 0, b"\1\0") == WRONG_LENGTH
        assert bus.abort_code(0x1029, 1, b"\1\0") == WRONG_LENGTH


# Telegrams that the manuals print


def _sequences(device: Device) -> dict[str, list[Example]]:
    """Complete examples of parameter transfers, by the exchange that they belong to."""
    found: dict[str, list[Example]] = {}
    for example in device.examples:
        if example.sequence and example.node and example.layout.startswith("sdo") and None not in example.data:
            found.setdefault(example.sequence, []).append(example)
    return found


def _octets(example: Example) -> bytes:
    return bytes(octet for octet in example.data if octet is not None)


def _preset(bus: Bus, example: Example) -> None:
    """Let the slave hold the value that a printed response carries."""
    command, index, subindex = struct.unpack("<BHB", _octets(example)[:4])
    if example.direction == "from device" and command & 0xE3 == 0x43:
        length = 4 - (command >> 2 & 3)
        bus.slave.set(index, subindex, int.from_bytes(_octets(example)[4 : 4 + length], "little"))


def test_printed_requests_get_the_printed_responses(buses: Callable[..., Bus], cases: list[Case]) -> None:
    played = 0
    for case in {case.device.id: case for case in cases}.values():
        for examples in _sequences(case.device).values():
            (node,) = {example.node for example in examples}
            assert node is not None
            bus = buses(case, node)
            for example in examples:
                _preset(bus, example)
            for example in examples:
                if example.direction == "to device":
                    assert example.identifier in (0x600 + node, None)
                    response = bus.answer(_octets(example))
                    assert response[0] == 0x580 + node
                    assert response[1][0] != 0x80
                else:
                    assert example.identifier == response[0]
                    assert response[1] == _octets(example)
                    played += 1
    assert played >= 6


def test_the_master_sends_what_the_manual_prints(buses: Callable[..., Bus], modules: list[Case]) -> None:
    calls: dict[str, Callable[[canopen.RemoteNode], object]] = {
        "Reading parameters": lambda node: struct.unpack("<i", node.sdo.upload(24575 - 61, 0))[0],
        "Writing parameters": lambda node: node.sdo.download(24575 - 88, 0, struct.pack("<I", 102)),
        "Reading block parameters": lambda node: node.sdo.upload(24575 - 99, 0),
    }
    results = {"Reading parameters": 43, "Writing parameters": None, "Reading block parameters": b"01.00.00.00"}
    sequences = _sequences(modules[-1].device)
    for name, call in calls.items():
        (node,) = {example.node for example in sequences[name]}
        assert node is not None
        bus = buses(modules[-1], node)
        bus.sent()
        assert call(bus.node) == results[name]
        assert bus.sent() == [(example.identifier, _octets(example)) for example in sequences[name]]


def test_second_parameter_channel(buses: Callable[..., Bus], modules: list[Case]) -> None:
    for case in modules:
        examples = _sequences(case.device)["Activating the parameter data channel 2"]
        values = {}
        for example in examples:
            _, index, subindex, value = struct.unpack("<BHBI", _octets(example))
            assert index == 0x1201
            values[subindex] = value
        (node,) = {example.node for example in examples}
        assert node is not None
        bus = buses(case, node)
        channel = bus.node.sdo[0x1201]
        for subindex in (1, 2):
            channel[subindex].raw = 0x80000000
        client = SdoClient(values[1], values[2], bus.node.object_dictionary)
        client.network = bus.network
        client.RESPONSE_TIMEOUT = 0.2
        bus.network.subscribe(values[2], client.on_response)
        with pytest.raises(canopen.SdoCommunicationError):
            client.upload(0x1018, 1)
        for example in examples:
            assert bus.answer(_octets(example))[1][0] == 0x60
        client.RESPONSE_TIMEOUT = TIMEOUT
        assert client.upload(0x1018, 1) == struct.pack("<I", case.facts[0x1018, 1].default)
        bus.network.unsubscribe(values[2], client.on_response)


# Network management


def test_states(buses: Callable[..., Bus], cases: list[Case]) -> None:
    states = {"OPERATIONAL": 5, "STOPPED": 4, "PRE-OPERATIONAL": 127}
    for case in cases:
        bus = buses(case)
        for name, number in states.items():
            bus.node.nmt.state = name
            _wait_for_state(bus, number)
        # A stopped device answers no requests; this one does again.
        assert bus.node.sdo.upload(0x1000, 0) == struct.pack("<I", int(str(case.facts[0x1000, 0].default or 0)))


def test_commands_are_those_of_the_manual(buses: Callable[..., Bus], modules: list[Case]) -> None:
    commands = {"nmt-start": "OPERATIONAL", "nmt-stop": "STOPPED", "nmt-enter-pre-operational": "PRE-OPERATIONAL"}
    for case in modules:
        bus = buses(case)
        for example in case.device.examples:
            if example.id in commands:
                bus.sent()
                bus.node.nmt.state = commands[example.id]
                assert bus.sent()[0] == (0, bytes([example.data[0] or 0, NODE]))
            elif example.id in ("nmt-reset-node", "nmt-reset-communication"):
                bus.sent()
                bus.network.send_message(0, bytes([example.data[0] or 0, NODE]))
                boot_up = next(other for other in case.device.examples if other.id == "heartbeat-boot-up")
                assert bus.next(2)[1] == (0x700 + NODE, _octets(boot_up))


def test_heartbeat(buses: Callable[..., Bus], modules: list[Case]) -> None:
    for case in modules:
        bus = buses(case)
        printed = {
            e.id: _octets(e) for e in case.device.examples if e.id.startswith("heartbeat-") and e.data[0] is not None
        }
        bus.node.sdo[0x1017].raw = 20
        for name in ("OPERATIONAL", "STOPPED", "PRE-OPERATIONAL"):
            bus.node.nmt.state = name
            bus.node.nmt.wait_for_heartbeat(TIMEOUT)
            assert bus.node.nmt.state == name
            bus.sent()
            time.sleep(0.05)
            assert (0x700 + NODE, printed[f"heartbeat-{name.lower()}"]) in bus.sent()
        bus.node.sdo[0x1017].raw = 0
        bus.sent()
        time.sleep(0.1)
        assert bus.sent() == []


def test_emergency(buses: Callable[..., Bus], modules: list[Case]) -> None:
    for case in modules:
        bus = buses(case)
        example = next(e for e in case.device.examples if e.layout == "emergency")
        code, register, data = struct.unpack("<HB5s", _octets(example))
        bus.node.nmt.state = "PRE-OPERATIONAL"
        assert bus.node.sdo[0x1014].raw == 0x80 + NODE
        bus.sent()
        bus.slave.report(code, register, data)
        assert bus.sent() == [(0x80 + NODE, _octets(example))]
        (received,) = _active(bus, 1)
        assert (received.code, received.register, received.data) == (code, register, data)
        assert bus.node.sdo[0x1001].raw == register
        bus.slave.report(0, 0)
        assert _active(bus, 0) == []


# Process data


def test_default_configuration_of_pdos(buses: Callable[..., Bus], cases: list[Case]) -> None:
    for case in cases:
        bus = buses(case)
        bus.node.rpdo.read()
        bus.node.tpdo.read()
        for maps, base, communication in ((bus.node.rpdo, 0x200, 0x1400), (bus.node.tpdo, 0x180, 0x1800)):
            numbers = [
                entry.index - communication for entry in case.device.objects if entry.index & 0xFE00 == communication
            ]
            assert [number + 1 for number in numbers] == list(maps)
            for number in numbers:
                pdo = maps[number + 1]
                assert pdo.cob_id == base + number * 0x100 + NODE
                assert pdo.enabled
                assert pdo.trans_type == (case.facts[communication + number, 2].default or 0)
                mapped = case.facts[communication + 0x200 + number, 0].default
                assert len(pdo.map) == mapped


def test_configuration_of_pdos_is_written(buses: Callable[..., Bus], modules: list[Case]) -> None:
    for case in modules:
        bus = buses(case, NODE + 1)
        bus.node.tpdo.read()
        pdo = bus.node.tpdo[2]
        before = pdo.cob_id, pdo.trans_type
        pdo.clear()
        pdo.add_variable(0x1001)
        pdo.cob_id, pdo.trans_type, pdo.event_timer, pdo.inhibit_time, pdo.enabled = 0x2AA, 1, 250, 30, True
        pdo.save()
        assert [bus.slave.value(0x1801, sub) for sub in (1, 2, 3, 5)] == [0x2AA, 1, 30, 250]
        assert [bus.slave.value(0x1A01, sub) for sub in (0, 1)] == [1, 0x10010008]
        pdo.clear()
        pdo.cob_id, pdo.trans_type = before
        pdo.save()
        assert bus.slave.value(0x1A01, 0) == 0


def test_process_data_travels(buses: Callable[..., Bus], cases: list[Case]) -> None:
    """The drive with default mappings sends its status word and takes a control word."""
    case = next(case for case in cases if (0x6040, 0) in case.facts)
    bus = buses(case, NODE + 1)
    node = bus.node
    node.nmt.state = "PRE-OPERATIONAL"
    node.tpdo.read()
    assert [(entry.index, entry.subindex, entry.length) for entry in node.tpdo[1].map] == [(0x6041, 0, 16)]
    node.rpdo.read()
    node.rpdo[1].clear()
    node.rpdo[1].add_variable(0x6040)
    node.rpdo[1].trans_type = 255
    node.rpdo[1].save()
    node.tpdo[1].trans_type = 255
    node.tpdo[1].save()
    node.nmt.state = "OPERATIONAL"
    _wait_for_state(bus, 5)
    node.rpdo[1]["control word"].raw = 0x000F
    node.rpdo[1].transmit()
    _wait(lambda: bus.slave.value(0x6040, 0) == 0x000F)
    bus.slave.set(0x6041, 0, 0x0237)
    _wait(lambda: node.tpdo[1]["status word"].raw == 0x0237)
    assert (0x180 + NODE + 1, struct.pack("<H", 0x0237)) in bus.sent()
    node.nmt.state = "PRE-OPERATIONAL"


def test_a_master_takes_a_dcf_over_to_the_device(
    model: Model, buses: Callable[..., Bus], modules: list[Case], tmp_path: Path
) -> None:
    case = modules[0]
    assert case.product
    label = "_".join(case.path.stem.split("_")[2:])
    settings = ("I-1029/1=2", "C13382=500", "I-1800/5=40", "I-1016/3=0x00010064", "C13351=125 kbps")
    request = Request(device=case.device.id, slot=case.slot, product=label, node="9", bit_rate="500", settings=settings)
    name, output = list(files(model, request).items())[1]
    (tmp_path / name).write_bytes(output.data())
    bus = buses(case, 9)
    node = canopen.RemoteNode(9, str(tmp_path / name))
    node.associate_network(bus.network)
    node.sdo.RESPONSE_TIMEOUT = TIMEOUT
    node.load_configuration()
    places = {(0x1029, 1): 2, (24575 - 13382, 0): 500, (0x1800, 5): 40, (0x1016, 3): 0x10064, (24575 - 13351, 0): 2}
    assert {place: bus.slave.value(*place) for place in places} == places
    node.remove_network()


def _active(bus: Bus, count: int) -> list[EmcyError]:
    """Errors that the master knows of, once they are so many."""
    _wait(lambda: len(bus.node.emcy.active) == count)
    return list(bus.node.emcy.active)


def _wait_for_state(bus: Bus, number: int) -> None:
    _wait(lambda: bus.slave.state() == number)


def _wait(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + TIMEOUT
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.005)
