"""Telegrams of services: against the manuals' worked examples, against the layouts, and there and back."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from generator.check.telegrams import show
from generator.codec import CodecError, decode, encode
from generator.model import DataType, Device, Does, Model, Service
from generator.wire import Call, Layouts, agree, build, carries, recognise

READ_AND_WRITE = (Does.READ, Does.WRITE)


def device_of(model: Model, name: str) -> Device:
    return next(device for device in model.devices if device.id == name)


def parts(model: Model, device: str, service: str) -> tuple[Service, Layouts]:
    found = device_of(model, device)
    return next(s for s in found.services if s.id == service), {layout.id: layout for layout in found.layouts}


def request(model: Model, device: str, service: str, call: Call) -> str:
    known, layouts = parts(model, device, service)
    assert known.request is not None
    return show(build(known, known.request, layouts, call).data)


def example(model: Model, device: str, name: str) -> str:
    return show(next(e for e in device_of(model, device).examples if e.id == name).data)


C61 = Call(index=24575 - 61, code=61, subindex=0)
C105 = Call(index=24575 - 105, code=105, subindex=0, value=50)


@pytest.mark.parametrize(
    ("device", "service", "printed", "call"),
    [
        ("e94aycca", "sdo-read", "read-c00061-request", C61),
        ("e94aycca", "sdo-write", "write-c00088-request", Call(index=24575 - 88, subindex=0, value=102)),
        ("e94aycca", "sdo-read-block", "block-request-1", Call(index=24575 - 99, subindex=0)),
        ("e94aycca", "sdo-write", "sdo2-rx-write", Call(index=0x1201, subindex=1, value=0x644)),
        ("servo931", "sdo-read", "read-6093-request", Call(index=0x6093, subindex=1)),
        ("servo931", "sdo-write", "write-6093-request", Call(index=0x6093, subindex=1, value=216000)),
        ("e94aycpm", "drivecom-read", "drivecom-read-c00061-request", C61),
        ("e94aycpm", "drivecom-write", "drivecom-write-c00105-request", replace(C105, free={"service.handshake": 1})),
        ("e94aycpm", "dpv1-read", "dpv1-read-c00061-request", replace(C61, free={"request_reference": None})),
        ("e94aycpm", "dpv1-write", "dpv1-write-c00105-request", replace(C105, free={"request_reference": None})),
        ("e94aycen", "gci-read", "read-c00061-request", C61),
        ("e94aycen", "gci-write", "write-c00105-request", replace(C105, free={"gti": 42})),
    ],
)
def test_requests_are_the_printed_ones(model: Model, device: str, service: str, printed: str, call: Call) -> None:
    assert request(model, device, service, call) == example(model, device, printed)


@pytest.mark.parametrize(
    ("device", "service", "printed", "call"),
    [
        ("e94aycca", "sdo-error", "error-06040041", Call(error=0x06040041)),
        ("e94aycca", "emergency", "encoder-wire-breakage", Call(error=0x1000, register=1, free={"message": 0x7B001B})),
        ("e94aycpm", "drivecom-error", "drivecom-abort-confirmation", Call(index=0, subindex=0, error=0, unset=None)),
        ("e94aycpm", "dpv1-read-error", "dpv1-read-c00061-error", Call(free={"request_reference": None})),
        ("e94aycen", "gci-error", "error-code-9002", Call(error=0x9002, unset=None)),
        (
            "e94aycen",
            "gci-read",
            "read-c00200-response",
            Call(
                data_type=DataType.VISIBLE_STRING, index=24375, code=200, subindex=0, value=b"E94AFHB", free={"gti": 1}
            ),
        ),
    ],
)
def test_answers_are_the_printed_ones(model: Model, device: str, service: str, printed: str, call: Call) -> None:
    known, layouts = parts(model, device, service)
    assert known.answer is not None
    data = build(known, known.answer, layouts, call).data
    assert agree(data, next(e.data for e in device_of(model, device).examples if e.id == printed))


def test_length_comes_from_the_data_type(model: Model) -> None:
    found = {
        kind: request(model, "e94aycca", "sdo-write", Call(data_type=kind, index=0x2BD8, subindex=0, value=1))
        for kind in (DataType.UNSIGNED8, DataType.UNSIGNED16, DataType.UNSIGNED32)
    }
    assert [data.split()[0] for data in found.values()] == ["2F", "2B", "23"]
    low = Call(data_type=DataType.INTEGER8, index=0x2BD8, subindex=0, value=-2)
    assert request(model, "e94aycca", "sdo-write", low) == "2F D8 2B 00 FE 00 00 00"


def test_the_spelling_of_the_manual_decides_first(model: Model) -> None:
    for name, number in (("", "05"), ("UNSIGNED_8", "05"), ("BITFIELD_8", "0C")):
        call = Call(data_type=DataType.UNSIGNED8, type_name=name, index=0, code=1, subindex=0, value=1)
        assert request(model, "e94aycen", "gci-write", call).split()[10] == number


def test_a_subcode_is_one_element_of_an_array(model: Model) -> None:
    call = Call(data_type=DataType.UNSIGNED8, index=0x2BD8, subindex=3)
    assert request(model, "e94aycpm", "dpv1-read", call) == "00 01 00 01 10 01 2B D8 00 03"


def test_eight_bytes_and_strings_travel_where_the_bus_has_room(model: Model) -> None:
    call = Call(data_type=DataType.UNSIGNED64, index=0, code=1, subindex=0, value=0x0123456789ABCDEF)
    assert request(model, "e94aycen", "gci-write", call).endswith("EF CD AB 89 67 45 23 01")
    for device, service in (("e94aycca", "sdo-write"), ("e94aycpm", "drivecom-write"), ("e94aycpm", "dpv1-write")):
        assert not carries(parts(model, device, service)[0], DataType.UNSIGNED64)
        with pytest.raises(CodecError, match="not carried"):
            request(model, device, service, call)
    assert carries(parts(model, "e94aycpm", "dpv1-write")[0], DataType.OCTET_STRING)
    long = Call(data_type=DataType.VISIBLE_STRING, index=0, subindex=0, value=bytes(230))
    with pytest.raises(CodecError, match="at most 240"):
        request(model, "e94aycpm", "dpv1-write", long)


def test_values_outside_the_data_type_are_refused(model: Model) -> None:
    for value in (-1, 256):
        with pytest.raises(CodecError, match="does not fit UNSIGNED8"):
            call = Call(data_type=DataType.UNSIGNED8, index=0, subindex=0, value=value)
            request(model, "e94aycca", "sdo-write", call)


@given(data=st.data())
def test_every_telegram_says_what_it_was_built_from(model: Model, data: st.DataObject) -> None:
    device = data.draw(st.sampled_from(model.devices))
    service = data.draw(st.sampled_from([s for s in device.services if s.does in READ_AND_WRITE]))
    message = data.draw(st.sampled_from(service.messages))
    kind = data.draw(st.sampled_from([t for t in DataType if carries(service, t)]))
    values: st.SearchStrategy[int | bytes] = st.binary(max_size=100)
    if kind.is_number:
        values = st.integers(kind.lowest, kind.highest)
    value = data.draw(values)
    call = Call(
        data_type=kind,
        index=data.draw(st.integers(0, 0xFFFF)),
        code=data.draw(st.integers(0, 24575)),
        subindex=data.draw(st.integers(0, 255)),
        value=value,
    )
    layouts = {layout.id: layout for layout in device.layouts}
    telegram = build(service, message, layouts, call)
    decode(telegram.layout, telegram.data)
    found = recognise(service, message, layouts, telegram.data, Call(data_type=kind))
    assert found is not None
    for said, meant in zip(
        (found.index, found.code, found.subindex, found.value),
        (call.index, call.code, call.subindex, call.value),
        strict=True,
    ):
        assert said in (meant, None)


@pytest.mark.parametrize(
    ("octets", "values"),
    [
        # A string of five characters alone, and in front of another value; two bytes; one byte.
        ("01 01 00 01 09 05 30 31 2E 30 30 00", ["30 31 2E 30 30"]),
        ("01 01 00 02 09 05 30 31 2E 30 30 00 06 01 12 34", ["30 31 2E 30 30", "12 34"]),
        ("01 01 00 02 05 02 11 22 06 01 12 34", ["11 22", "12 34"]),
        ("01 01 00 01 05 01 11 00", ["11"]),
    ],
)
def test_profidrive_fills_an_odd_number_of_bytes(model: Model, octets: str, values: list[str]) -> None:
    layout = next(layout for device in model.devices for layout in device.layouts if layout.id == "dpv1-read-response")
    data = tuple(bytes.fromhex(octets))
    found = decode(layout, data)
    groups = found["values"]
    assert isinstance(groups, tuple) and [entry["value"] for entry in groups] == values
    assert encode(layout, found) == data
    with pytest.raises(CodecError):
        decode(layout, data[:-1])
