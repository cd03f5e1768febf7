"""Slaves on a bus of pyprofibus that behave as the device does: they refuse what the manual does not allow."""

import gc
from collections import deque
from dataclasses import dataclass, field
from io import StringIO
from pathlib import Path

from pyprofibus.conf import PbConf
from pyprofibus.dp import (
    DpCfgDataElement,
    DpTelegram,
    DpTelegram_ChkCfg_Req,
    DpTelegram_DataExchange_Con,
    DpTelegram_DataExchange_Req,
    DpTelegram_SetPrm_Req,
    DpTelegram_SlaveDiag_Con,
    DpTelegram_SlaveDiag_Req,
)
from pyprofibus.dp_master import DpMaster
from pyprofibus.fdl import FdlTelegram, FdlTelegram_ack, FdlTelegram_FdlStat_Con
from pyprofibus.phy import CpPhy

from generator.model import Gsd

_ROUNDS_PER_STATION = 200
"""Calls of the master's state machine for each station, several times what a start needs."""
_STATIONS = 16
"""Stations on one bus; the master's time limits hold for all of them together."""
_CONFIGURATION = """\
[PROFIBUS]
debug=0
[PHY]
type=dummy_slave
dev=none
baud=12000000
[DP]
master_class=1
master_addr=0
"""
_SLAVE = """\
[SLAVE_{number}]
name=station {number}
addr={number}
gsd={gsd}
sync_mode=0
freeze_mode=0
group_mask=1
watchdog_ms=300
input_size={length}
output_size={length}
diag_period=0
"""


def direction_lengths(configuration: bytes) -> tuple[int, int]:
    """Bytes to and from the master that identifier bytes ask for, by the constants of pyprofibus."""
    inputs = outputs = 0
    octets = deque(configuration)
    while octets:
        head = octets.popleft()
        kind = head & DpCfgDataElement.ID_TYPE_MASK
        if kind == DpCfgDataElement.ID_TYPE_SPEC:
            special = head & DpCfgDataElement.ID_SPEC_MASK
            if special in (DpCfgDataElement.ID_SPEC_OUT, DpCfgDataElement.ID_SPEC_INOUT):
                outputs += _length(octets.popleft(), DpCfgDataElement.LEN_COUNT, DpCfgDataElement.LEN_WORDS)
            if special in (DpCfgDataElement.ID_SPEC_IN, DpCfgDataElement.ID_SPEC_INOUT):
                inputs += _length(octets.popleft(), DpCfgDataElement.LEN_COUNT, DpCfgDataElement.LEN_WORDS)
            continue
        length = _length(head, DpCfgDataElement.ID_LEN_MASK, DpCfgDataElement.ID_LEN_WORDS)
        inputs += length if kind & DpCfgDataElement.ID_TYPE_IN else 0
        outputs += length if kind & DpCfgDataElement.ID_TYPE_OUT else 0
    return inputs, outputs


def _length(octet: int, count: int, words: int) -> int:
    return ((octet & count) + 1) * (2 if octet & words else 1)


@dataclass
class Station:
    """A slave: what it was sent, whether it accepted it, and how many data it exchanged."""

    gsd: Gsd
    parameters: bytes | None = None
    configuration: bytes | None = None
    parameter_fault: bool = False
    configuration_fault: bool = False
    lengths: tuple[int, int] = (0, 0)
    received: list[bytes] = field(default_factory=list)

    @property
    def ready(self) -> bool:
        """Whether it can exchange data."""
        sent = self.parameters is not None and self.configuration is not None
        return sent and not self.parameter_fault and not self.configuration_fault

    def parametrise(self, request: DpTelegram_SetPrm_Req) -> None:
        """Take the parameters: of this ident number, with user parameters as the manual knows them, watchdog on."""
        self.parameters = bytes(request.userPrmData)
        self.configuration = None
        self.parameter_fault = (
            request.identNumber != self.gsd.number("Ident_Number")
            or not 3 <= len(self.parameters) <= self.gsd.number("Max_User_Prm_Data_Len")
            or not request.stationStatus & DpTelegram_SetPrm_Req.STA_WD
        )

    def configure(self, configuration: bytes) -> None:
        """Take the configuration: as many bytes in both directions, and not more than there can be."""
        self.configuration = configuration
        self.lengths = inputs, outputs = direction_lengths(configuration)
        self.configuration_fault = (
            inputs != outputs
            or inputs > self.gsd.number("Max_Input_Len")
            or outputs > self.gsd.number("Max_Output_Len")
        )

    def exchange(self, data: bytes) -> bytes | None:
        """Inputs for the outputs ``data``, their complement; ``None`` for outputs of another length."""
        if not self.ready or len(data) != self.lengths[1]:
            return None
        self.received.append(data)
        return bytes(octet ^ 0xFF for octet in data)


class Bus(CpPhy):  # type: ignore[misc]
    """A bus with stations, in place of the hardware of a master."""

    def __init__(self, stations: dict[int, Station]) -> None:
        """Connect ``stations``, by address."""
        super().__init__()
        self._stations = stations
        self._answers: deque[bytes] = deque()
        self.setConfig(baudrate=CpPhy.BAUD_12000000)

    def pollData(self, timeout: float = 0.0) -> bytes | None:  # noqa: D102
        return self._answers.popleft() if self._answers else None

    def sendData(self, telegramData: bytes, srd: bool) -> None:  # noqa: D102
        request = FdlTelegram.fromRawData(bytearray(telegramData))
        station = self._stations.get(request.da)
        if srd and station is not None:
            answer = self._answer(request, station)
            if answer is not None:
                self._answers.append(answer.getRawData())

    def _answer(self, request: FdlTelegram, station: Station) -> FdlTelegram | None:
        ends = {"da": request.sa, "sa": request.da}
        if request.fc & FdlTelegram.FC_REQFUNC_MASK == FdlTelegram.FC_FDL_STAT:
            return FdlTelegram_FdlStat_Con(**ends)
        telegram = DpTelegram.fromFdlTelegram(request, thisIsMaster=False)
        if DpTelegram_SlaveDiag_Req.checkType(telegram):
            return _diagnosis(station, ends)
        if DpTelegram_SetPrm_Req.checkType(telegram):
            station.parametrise(telegram)
            return FdlTelegram_ack()
        if DpTelegram_ChkCfg_Req.checkType(telegram):
            station.configure(bytes(request.du))
            return FdlTelegram_ack()
        if DpTelegram_DataExchange_Req.checkType(telegram):
            inputs = station.exchange(bytes(telegram.du))
            return None if inputs is None else DpTelegram_DataExchange_Con(**ends, du=inputs).toFdlTelegram()
        return None


def _diagnosis(station: Station, ends: dict[str, int]) -> FdlTelegram:
    answer = DpTelegram_SlaveDiag_Con(**ends)
    answer.b0 |= 0 if station.ready else DpTelegram_SlaveDiag_Con.B0_STANORDY
    answer.b0 |= DpTelegram_SlaveDiag_Con.B0_PRMFLT if station.parameter_fault else 0
    answer.b0 |= DpTelegram_SlaveDiag_Con.B0_CFGFLT if station.configuration_fault else 0
    answer.b1 |= DpTelegram_SlaveDiag_Con.B1_ONE
    answer.b1 |= DpTelegram_SlaveDiag_Con.B1_PRMREQ if station.parameters is None else 0
    answer.identNumber = station.gsd.number("Ident_Number")
    return answer.toFdlTelegram()


def run(gsd: Gsd, file: Path, configurations: list[tuple[list[str], int]]) -> list[tuple[Station, bytes | None]]:
    """Start pyprofibus masters from a GSD file, with a slave for each configuration.

    Args:
        gsd: What the slaves hold the master to.
        file: The GSD file that the master is configured from.
        configurations: Names of the modules, and bytes in each direction.

    Returns:
        Each slave, and the inputs that the master last had from it.
    """
    gc.freeze()  # pyprofibus collects garbage several times for each file; keep it away from everything else.
    try:
        return [
            result
            for first in range(0, len(configurations), _STATIONS)
            for result in _start(gsd, file, configurations[first : first + _STATIONS])
        ]
    finally:
        gc.unfreeze()


def _start(gsd: Gsd, file: Path, configurations: list[tuple[list[str], int]]) -> list[tuple[Station, bytes | None]]:
    text = _CONFIGURATION
    for number, (names, length) in enumerate(configurations, 1):
        text += _SLAVE.format(number=number, gsd=file, length=length)
        text += "".join(f"module_{place}={name}\n" for place, name in enumerate(names))
    configuration = PbConf(StringIO(text))
    stations = {number: Station(gsd) for number in range(1, len(configurations) + 1)}
    master = configuration.makeDPM(phy=Bus(stations))
    for slave in configuration.slaveConfs:
        master.addSlave(slave.makeDpSlaveDesc())
    master.initialize()
    inputs = _run(master, stations)
    master.destroy()
    return [(station, inputs.get(number)) for number, station in stations.items()]


def _run(master: DpMaster, stations: dict[int, Station]) -> dict[int, bytes]:
    """Run the master until it has inputs of every station, or long enough to know that it never will."""
    inputs: dict[int, bytes] = {}
    for _ in range(_ROUNDS_PER_STATION * len(stations)):
        slave = master.run()
        if slave is None:
            continue
        slave.setMasterOutData(bytes(range(slave.slaveAddr, slave.slaveAddr + slave.inputSize)))
        data = slave.getMasterInData()
        if data is not None:
            inputs[slave.slaveAddr] = bytes(data)
        if len(inputs) == len(stations):
            break
    return inputs
