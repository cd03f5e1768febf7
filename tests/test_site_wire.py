"""Telegrams in the reference: bytes on the pages of entries, and the instruments that build and decode them."""

import random
import re
import struct
from collections.abc import Callable, Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page
from test_c_telegrams import message, mutated
from visitor import Visitor

from generator.codec import CodecError, decode, encode
from generator.emit.html.places import code_entries, error_id, error_text, object_id, page_of
from generator.model import Code, DataType, Device, Does, Example, Model, NodeRelative, Service, Values
from generator.model.telegram import OPEN, Value
from generator.wire import Call, Octets, build, carries

NODE = 1
"""Default of the node address, for which the pages show identifiers."""
WRITE_COMMANDS = {8: 0x2F, 16: 0x2B, 32: 0x23}


class Strips(HTMLParser):
    """Telegrams of a page: caption and bytes, below the heading of their service."""

    def __init__(self, text: str) -> None:
        """Read the page."""
        super().__init__()
        self.found: list[tuple[str, str, str]] = []
        self._path: list[tuple[str, str]] = []
        self._heading = self._caption = self._bytes = ""
        self._inside = False
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        """Note what the following text is."""
        kind = dict(attributes).get("class") or ""
        self._path.append((tag, kind))
        if (tag, kind) == ("section", "wire"):
            self._inside = True
        if tag == "h3":
            self._heading = ""
        if (tag, kind) == ("div", "telegram"):
            self._caption = self._bytes = ""

    def handle_endtag(self, tag: str) -> None:
        """Take what has ended."""
        while self._path and self._path.pop()[0] != tag:
            pass
        if tag == "ol" and self._inside:
            self.found.append((self._heading.partition(":")[0].strip(), self._caption.strip(), self._bytes.strip()))

    def handle_data(self, data: str) -> None:
        """Collect text."""
        tags = [tag for tag, _ in self._path]
        if "h3" in tags:
            self._heading += data
        elif ("p", "cap") in self._path:
            self._caption += data
        elif "code" in tags and self._inside:
            self._bytes += f" {data}"


def strips(site: Path, page: str) -> list[tuple[str, str, str]]:
    return Strips((site / page).read_text(encoding="utf-8")).found


def requests(site: Path, page: str, service: str) -> list[str]:
    found = strips(site, page)
    return [data for name, caption, data in found if name == service and caption.endswith("to the device")]


def spaced(data: bytes) -> str:
    return data.hex(" ").upper()


def entries(device: Device) -> Iterator[tuple[str, tuple[Code, ...]]]:
    for codes in code_entries(device.codes):
        yield page_of(device, f"c{codes[0].number:05d}"), codes


def first_sub(code: Code) -> int:
    return code.subcodes[0].number if code.subcodes else 0


def the_device(model: Model, name: str) -> Device:
    return next(device for device in model.devices if device.id == name)


def test_codes_are_read_by_sdo(site: Path, model: Model) -> None:
    for page, codes in entries(the_device(model, "e94aycca")):
        expected = [spaced(struct.pack("<BHBI", 0x40, code.index, first_sub(code), 0)) for code in codes]
        assert requests(site, page, "Read by SDO") == expected
        assert {caption.split("identifier ")[1][:5] for _, caption, _ in strips(site, page)} == {"0x601", "0x581"}


def test_defaults_are_written_by_sdo(site: Path, model: Model) -> None:
    written = 0
    for page, codes in entries(the_device(model, "e94aycca")):
        default = codes[0].subcodes[0].default if codes[0].subcodes else codes[0].default
        value = default.at(NODE) if isinstance(default, NodeRelative) else default
        found = requests(site, page, "Write by SDO")
        assert bool(found) == codes[0].access.write
        if isinstance(value, int) and found:
            command = WRITE_COMMANDS[codes[0].data_type.bits]
            expected = [struct.pack("<BHBI", command, code.index, first_sub(code), value) for code in codes]
            assert found == list(map(spaced, expected))
            written += 1
    assert written > 30


def test_codes_are_read_over_profibus_and_ethernet(site: Path, model: Model) -> None:
    for page, codes in entries(the_device(model, "e94aycpm")):
        fits = 0 < codes[0].data_type.bits <= 32
        readable = codes if codes[0].access.read else ()
        drivecom = [struct.pack(">BBHI", 0x01, first_sub(code), code.index, 0) for code in readable]
        assert requests(site, page, "Read by DRIVECOM (DP-V0)") == (list(map(spaced, drivecom)) if fits else [])
        profidrive = [
            struct.pack(">BBBBBBHH", 0, 1, 0, 1, 0x10, min(first_sub(code), 1), code.index, first_sub(code))
            for code in readable
        ]
        assert requests(site, page, "Read by PROFIdrive (DP-V1)") == list(map(spaced, profidrive))
    for page, codes in entries(the_device(model, "e94aycen")):
        expected = [
            struct.pack("<BBBBHHIHHHHII", 1, 0x82, 0, 0, 20, 0, 0, code.number, 0, first_sub(code), 0, 0, 0)
            for code in codes
        ]
        assert requests(site, page, "Read by GCI") == list(map(spaced, expected))


@pytest.mark.parametrize(("device", "identifier"), [("e94aycca", "0x601"), ("servo931", "0x600 + node address")])
def test_objects_are_read_by_sdo(site: Path, model: Model, device: str, identifier: str) -> None:
    for entry in the_device(model, device).objects:
        found = strips(site, page_of(the_device(model, device), object_id(entry)))
        readable = [sub for sub in entry.subindexes if sub.abort is None and not sub.unused] or entry.subindexes
        number = next((sub.number for sub in readable if sub.number > 0), readable[0].number)
        name, caption, data = found[0]
        assert (name, data) == ("Read by SDO", spaced(struct.pack("<BHBI", 0x40, entry.index, number, 0)))
        assert f"identifier {identifier} " in caption


def test_the_signature_is_written_letter_by_letter(site: Path) -> None:
    assert requests(site, "e94aycca-i-1010.html", "Write by SDO") == [f"23 10 10 01 {spaced(b'save')}"]
    read = next(data for _, caption, data in strips(site, "e94aycca-i-1010.html") if "from the device" in caption)
    assert read.endswith("XX XX XX XX")


def test_errors_show_the_telegram_that_tells_of_them(site: Path, model: Model) -> None:
    expected: dict[str, tuple[str, Callable[[int], list[str]]]] = {
        "sdo_abort": ("Error response by SDO", lambda n: ["80 XX XX XX", spaced(struct.pack("<I", n))]),
        "emergency": ("Emergency telegram", lambda n: [spaced(struct.pack("<H", n))]),
        "dpv0": ("Error telegram of DRIVECOM (DP-V0)", lambda n: ["XX XX XX XX", spaced(struct.pack(">I", n))]),
        "dpv1": ("Read error of PROFIdrive (DP-V1)", lambda n: ["XX 81 XX 01 44 01", spaced(struct.pack(">H", n))]),
        "gci": ("Error code in area P0 of a GCI response", lambda n: [spaced(struct.pack("<H", n)), "XX XX"]),
    }
    seen = set()
    for device in model.devices:
        for error in device.errors:
            found = strips(site, page_of(device, error_id(error.kind, error.number))) if error.slot is None else []
            if error.kind not in expected:
                assert not found
                continue
            name, data = expected[error.kind]
            assert (name, True) in [(n, d.startswith(" ".join(data(error.number)))) for n, _, d in found]
            seen.add(error.kind)
    assert seen == expected.keys()


def test_what_a_bus_cannot_carry_is_said(site: Path) -> None:
    text = (site / "e94aycpm-c13865.html").read_text(encoding="utf-8")
    assert re.search(r"Read by DRIVECOM \(DP-V0\)</a></h3>\s*<p>Carries no values of the type OCTET_STRING", text)


def test_read_only_entries_have_no_write(site: Path, model: Model) -> None:
    for device in model.devices:
        for page, codes in entries(device):
            if not codes[0].access.write:
                assert not [name for name, _, _ in strips(site, page) if name.startswith("Write")]


# The codec of the page against the reference


def shared(value: Value) -> Any:
    """A value as both codecs can say it: numbers as text with a mark, since they may be too long for JSON."""
    if isinstance(value, tuple):
        return [{name: shared(inner) for name, inner in entry.items()} for entry in value]
    return None if value == OPEN else f"#{value}" if isinstance(value, int) else value


def shared_values(values: Values) -> Any:
    return {name: shared(value) for name, value in values.items()}


IN_PAGE = """(jobs) => {
    const { codec } = document.getElementById("wire-data");
    const outs = (values) => Object.fromEntries(Object.entries(values).map(([name, value]) => [name, out(value)]));
    const out = (value) => typeof value === "bigint" ? `#${value}` : Array.isArray(value) ? value.map(outs) : value;
    return jobs.map(([layout, bytes]) => {
        try {
            const { values } = codec.decode(codec.data.layouts[layout], bytes);
            const back = codec.encode(codec.data.layouts[layout], values);
            return [outs(values), back];
        } catch (error) {
            return error.message;
        }
    });
}"""


def reference(device: Device, layout: str, data: Octets) -> Any:
    found = next(one for one in device.layouts if one.id == layout)
    try:
        values = decode(found, data)
        return [shared_values(values), list(encode(found, values))]
    except CodecError as error:
        return str(error)


@pytest.mark.parametrize("name", ["e94aycca", "e94aycen", "e94aycpm", "servo931"])
def test_the_codec_of_the_page_is_the_reference(visitor: Visitor, model: Model, name: str) -> None:
    device = the_device(model, name)
    jobs: list[tuple[str, Octets]] = [(example.layout, example.data) for example in device.examples]
    rng = random.Random(name)
    for layout in device.layouts:
        for _ in range(40):
            data = message(layout, rng)
            jobs += [(layout.id, tuple(data)), (layout.id, tuple(mutated(data, rng)))]
    found = visitor.open(f"{name}-telegrams.html").evaluate(IN_PAGE, [[kind, list(octets)] for kind, octets in jobs])
    assert len(found) == len(jobs)
    refused = 0
    for (kind, octets), answer in zip(jobs, found, strict=True):
        expected = reference(device, kind, octets)
        assert answer == expected, (kind, octets)
        refused += isinstance(expected, str)
    assert 0 < refused < len(jobs)


BUILD = """(jobs) => {
    const { codec } = document.getElementById("wire-data");
    return jobs.map(([id, role, call]) => {
        const service = codec.data.services.find((one) => one.id === id);
        for (const key of ["index", "code", "sub"]) call[key] = BigInt(call[key]);
        if (typeof call.value === "string") call.value = BigInt(call.value);
        const { bytes } = codec.build(service, service[role], call);
        const again = codec.recognise(service, service[role], bytes, call);
        return [bytes, again !== null];
    });
}"""


@pytest.mark.parametrize("name", ["e94aycca", "e94aycen", "e94aycpm", "servo931"])
def test_services_of_the_page_build_what_the_reference_builds(visitor: Visitor, model: Model, name: str) -> None:
    device = the_device(model, name)
    layouts = {layout.id: layout for layout in device.layouts}
    rng = random.Random(name)
    jobs, expected = [], []
    spellings = sorted({(code.data_type.canopen_name, code.type_name) for one in model.devices for code in one.codes})
    for service, kind in combinations(device, rng):
        spelled = rng.choice(["", *(name for known, name in spellings if known == kind.canopen_name)])
        value = rng.randint(kind.lowest, kind.highest) if kind.is_number else rng.randbytes(rng.randrange(20))
        call = Call(
            data_type=kind,
            type_name=spelled,
            index=rng.randrange(1 << 16),
            code=rng.randrange(24576),
            subindex=rng.randrange(9),
            value=value,
        )
        shown = {"type": kind.canopen_name, "index": call.index, "code": call.code, "sub": call.subindex}
        shown["spelled"] = spelled
        sent = list(value) if isinstance(value, bytes) else str(value)
        for role, telegram in (("request", service.request), ("answer", service.answer)):
            if telegram is not None:
                jobs.append([service.id, role, {**shown, "value": sent}])
                expected.append([list(build(service, telegram, layouts, call).data), True])
    assert visitor.open(f"{name}-telegrams.html").evaluate(BUILD, jobs) == expected


def combinations(device: Device, rng: random.Random) -> Iterator[tuple[Service, DataType]]:
    for service in device.services:
        if service.does in (Does.READ, Does.WRITE):
            for kind in DataType:
                if carries(service, kind):
                    yield from [(service, kind)] * rng.randint(3, 6)


# The instruments, used as a visitor uses them


def fill(page: Page, **values: str) -> None:
    """Fill in controls of the builder by their names."""
    for name, value in values.items():
        control = page.locator(f"#b-{name.replace('__', '.')}".replace(".", "\\."))
        if control.evaluate("control => control.tagName") == "SELECT":
            control.select_option(value)
        else:
            control.fill(value)


def built(page: Page) -> str:
    return page.locator("#builder .telegram-bytes").inner_text()


def example_of(model: Model, device: str, name: str) -> Example:
    return next(example for example in the_device(model, device).examples if example.id == name)


@pytest.mark.parametrize(
    ("device", "example", "controls"),
    [
        ("e94aycca", "read-c00061-request", {"service": "sdo-read", "code": "C00061"}),
        (
            "e94aycca",
            "write-c00088-request",
            {"service": "sdo-write", "code": "C00088", "type": "UNSIGNED32", "scaling": "10", "value": "10.2"},
        ),
        ("e94aycca", "block-request-1", {"service": "sdo-read-block", "code": "C00099", "type": "VISIBLE_STRING"}),
        ("e94aycca", "sdo2-rx-write", {"service": "sdo-write", "code": "I-1201/1", "value": "0x644"}),
        ("e94aycca", "sdo2-tx-write", {"service": "sdo-write", "code": "1201h/2", "value": "0x5C4"}),
        ("servo931", "read-6093-request", {"service": "sdo-read", "code": "I-6093/1"}),
        ("servo931", "write-6093-request", {"service": "sdo-write", "code": "0x6093/1", "value": "216000"}),
        ("e94aycpm", "drivecom-read-c00061-request", {"service": "drivecom-read", "code": "C00061"}),
        (
            "e94aycpm",
            "drivecom-write-c00105-request",
            {
                "service": "drivecom-write",
                "code": "C00105",
                "type": "UNSIGNED32",
                "scaling": "1000",
                "value": "0.05",
                "service__handshake": "1",
            },
        ),
        ("e94aycpm", "dpv1-read-c00061-request", {"service": "dpv1-read", "code": "C00061"}),
        (
            "e94aycpm",
            "dpv1-write-c00105-request",
            {"service": "dpv1-write", "code": "C00105", "type": "UNSIGNED32", "scaling": "1000", "value": "0.05"},
        ),
        ("e94aycen", "read-c00061-request", {"service": "gci-read", "code": "C00061"}),
        (
            "e94aycen",
            "write-c00105-request",
            {
                "service": "gci-write",
                "code": "C00105",
                "type": "UNSIGNED32",
                "scaling": "1000",
                "value": "0.05",
                "gti": "42",
            },
        ),
    ],
)
def test_the_builder_makes_the_printed_requests(
    visitor: Visitor, model: Model, device: str, example: str, controls: dict[str, str]
) -> None:
    page = visitor.open(f"{device}-telegrams.html")
    printed = example_of(model, device, example)
    if printed.node is not None:
        fill(page, node=str(printed.node))
    fill(page, **controls)
    assert built(page) == spaced(bytes(octet or 0 for octet in printed.data))
    if printed.identifier is not None:
        assert page.locator("#builder .identifier").inner_text() == f"0x{printed.identifier:03X}"
    labelled = " ".join(page.locator("#builder .bytes code").all_inner_texts())
    assert labelled == built(page)
    again = visitor.open(page.url.rpartition("/")[2])
    assert built(again) == labelled


def test_the_builder_checks_what_is_typed(visitor: Visitor) -> None:
    page = visitor.open("e94aycca-telegrams.html")
    wrong = page.locator("#builder .wrong")
    fill(page, service="sdo-write", code="C13351", value="99")
    assert wrong.inner_text() == "The value is not in the selection list."
    page.locator("#b-option").select_option(label="3: 50 kbps")
    assert built(page) == "2F D8 2B 00 03 00 00 00"
    assert wrong.count() == 0
    fill(page, value="256")
    assert "does not fit UNSIGNED8" in wrong.inner_text() and page.locator("#builder .bytes").count() == 0
    fill(page, code="C13350", value="200")
    assert "above the upper limit 127" in wrong.inner_text()
    fill(page, code="C13372/99")
    assert "has no subcode 99" in wrong.inner_text()
    fill(page, code="I-1000", value="1")
    assert "cannot be written" in wrong.inner_text()
    fill(page, code="what")
    assert "Name a code" in wrong.inner_text()
    fill(page, code="I-1010/1", value="save")
    assert built(page).endswith("73 61 76 65") and wrong.count() == 0
    page = visitor.open("e94aycpm-telegrams.html")
    fill(page, service="drivecom-read", code="C13865")
    assert "OCTET_STRING are not carried" in page.locator("#builder .wrong").inner_text()
    fill(page, service="dpv1-read")
    assert built(page) == "00 01 00 01 10 00 29 D6 00 00"
    fill(page, code="PNU 918")
    assert built(page) == "00 01 00 01 10 00 03 96 00 00"
    page.locator("#b-request_reference").press_sequentially("17")  # before the 0 that stands there
    assert built(page) == "AA 01 00 01 10 00 03 96 00 00"


def test_the_builder_shows_at_once_what_its_page_says(browser: Browser, visitor: Visitor, site: Path) -> None:
    context = browser.new_context(java_script_enabled=False)
    still = context.new_page()
    for device in ("e94aycca", "e94aycpm"):
        still.goto(f"{site.as_uri()}/{device}-telegrams.html")
        live = visitor.open(f"{device}-telegrams.html")
        for part in (".controls .known >> nth=0", ".free", ".result"):
            shown = live.locator(f"#builder {part}").text_content() or ""
            assert "".join(shown.split()) == "".join((still.locator(f"#builder {part}").text_content() or "").split())
    context.close()


def test_an_entry_leads_to_the_builder(visitor: Visitor, site: Path) -> None:
    shown = requests(site, "e94aycca-c13351.html", "Write by SDO")[0]
    page = visitor.open("e94aycca-c13351.html")
    page.locator(".other a").last.click()
    page.wait_for_url("**#builder")
    assert built(page) == shown


def test_the_builder_by_keys_alone(visitor: Visitor) -> None:
    page = visitor.open("e94aycca-telegrams.html")
    for _ in range(60):
        page.keyboard.press("Tab")
        if page.evaluate("document.activeElement.id") == "b-service":
            break
    page.keyboard.type("Write")
    page.keyboard.press("Tab")
    page.keyboard.type("C13350")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.id") == "b-sub"
    page.keyboard.press("Tab")
    page.keyboard.type("9")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.id") == "b-value"
    page.keyboard.type("12")
    assert built(page) == "2F D9 2B 00 0C 00 00 00"
    assert page.locator("#builder .identifier").inner_text() == "0x609"
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.dataset.copy") == built(page)
    page.keyboard.press("Enter")
    assert page.evaluate("navigator.clipboard.readText()") == built(page)


@pytest.mark.parametrize("name", ["e94aycca", "e94aycen", "e94aycpm", "servo931"])
def test_the_decoder_knows_the_worked_telegrams(visitor: Visitor, model: Model, name: str) -> None:
    device = the_device(model, name)
    page = visitor.open(f"{name}-telegrams.html")
    told = {m.layout for s in device.services for m in s.messages if isinstance(m.layout, str)}
    for example in device.examples:
        text = spaced(bytes(octet or 0 for octet in example.data)) if None not in example.data else None
        shown = text or " ".join("XX" if octet is None else f"{octet:02X}" for octet in example.data)
        page.locator("#d-layout").select_option(example.layout)
        page.locator("#d-bytes").fill(shown)
        assert " ".join(page.locator("#decoder .bytes code").all_inner_texts()) == shown
        page.locator("#d-layout").select_option("")
        if text and example.layout in told:
            page.locator("#d-bytes").fill(text.replace(" ", ""))
            assert page.locator("#decoder dt:text-is('Layout') + dd").inner_text() == example.layout


def test_the_decoder_says_what_a_telegram_means(visitor: Visitor) -> None:
    page = visitor.open("e94aycca-telegrams.html")
    result = page.locator("#decoder .result")

    def decoded(text: str, identifier: str = "") -> str:
        page.locator("#d-bytes").fill(text)
        page.locator("#d-id").fill(identifier)
        return result.inner_text()

    read = decoded("605#40C25F0000000000")
    assert "Read by SDO" in read and "Node address\n5" in read and "C00061" in read
    written = decoded("0x2F 0xD8 0x2B 0x00 0x03 0x00 0x00 0x00", "601")
    assert "Write by SDO, request" in written.replace("\n", "") and "3: 50 kbps" in written
    assert result.locator("a", has_text="C13351").get_attribute("href") == "e94aycca-c13351.html"
    assert "not in the selection list" in decoded("2F D8 2B 00 63 00 00 00")
    assert "is UNSIGNED_8" in decoded("23 D8 2B 00 03 00 00 00")
    other = decoded("2F D8 2B 00 03 00 00 00", "702")
    assert "0x702 = NMT error control" in other and "has 8 bytes like these" in other and "Write by SDO" not in other
    page.locator("#d-layout").select_option("sdo")
    assert "is not one of SDO rx" in result.inner_text()
    page.locator("#d-layout").select_option("")
    assert "cannot be written" in decoded("23 00 10 00 00 00 00 00", "601")
    refused = decoded("581   [8]  80 00 10 00 41 00 04 06")
    assert "Error response by SDO" in refused and "Object not mapped" in refused
    assert result.locator("a", has_text="0x06040041").get_attribute("href") == "e94aycca-abort-0x06040041.html"
    assert "Emergency telegram" in decoded("00 10 01 00 1B 00 7B 00", "85")
    assert "not bytes in hexadecimal" in decoded("4 0 zz")
    page.locator("#d-layout").select_option("sdo")
    assert "needs 2 bytes" in decoded("40 C2")
    address = page.url.rpartition("/")[2]
    shown = result.inner_text()
    visitor.open(address)
    assert page.locator("#decoder .result").inner_text() == shown


def test_the_decoder_reads_strings_and_error_telegrams(visitor: Visitor, model: Model) -> None:
    page = visitor.open("e94aycen-telegrams.html")
    page.locator("#d-bytes").fill(
        spaced(bytes(o or 0 for o in example_of(model, "e94aycen", "read-c00200-response").data))
    )
    assert "E94AFHB" in page.locator("#decoder dt:text-is('Value') + dd").inner_text()
    page = visitor.open("e94aycpm-telegrams.html")
    page.locator("#d-bytes").fill("B0 01 29 C7 06 05 00 11")
    assert "Invalid subindex" in page.locator("#decoder dt:text-is('Error') + dd").inner_text()
    assert "C13880/1" in page.locator("#decoder dt:text-is('Parameter') + dd").inner_text()


@pytest.mark.parametrize(
    ("data", "name"),
    [
        ("00 81 00 01 44 01 00 03", "Read error of PROFIdrive"),
        ("00 82 00 01 44 01 00 11", "Write error of PROFIdrive"),
        ("05 81 00 01 44 02 00 03 00 01", "response to a read error"),
    ],
)
def test_error_responses_of_profidrive_are_read(visitor: Visitor, model: Model, data: str, name: str) -> None:
    page = visitor.open("e94aycpm-telegrams.html")
    page.locator("#d-bytes").fill(data)
    assert name in page.locator("#decoder .found").inner_text()
    assert " ".join(page.locator("#decoder .bytes code").all_inner_texts()) == data
    number = int(data[-5:].replace(" ", ""), 16)
    if data[15:17] == "01":
        error = next(e for e in the_device(model, "e94aycpm").errors if (e.kind, e.number) == ("dpv1", number))
        assert error.name in page.locator("#decoder dt:text-is('Error') + dd").inner_text()


def test_what_cannot_be_read_leaves_nothing_of_before(visitor: Visitor) -> None:
    """Any exception, here one that is forced, takes the last decoding away and is said."""
    page = visitor.open("e94aycca-telegrams.html")
    page.locator("#d-bytes").fill("605#40C25F0000000000")
    assert page.locator("#decoder .bytes").count() == 1
    page.evaluate("() => { document.getElementById('wire-data').codec.data.layouts.sdo.fields = null; }")
    page.locator("#d-bytes").fill("585#43C25F002B000000")
    assert page.locator("#decoder .result").inner_text() == "The telegram could not be read."
    assert visitor.wrong.pop() and not visitor.wrong


@pytest.mark.parametrize(
    ("device", "line", "name", "said"),
    [
        ("e94aycca", "185#0105", "TPDO1", "0x185 = TPDO1: Process data from the device"),
        ("e94aycca", "205#0F00", "RPDO1", "Process data to the device"),
        ("e94aycca", "605#40181001", "SDO rx", "No telegram of SDO rx has 4 bytes like these."),
        ("e94aycca", "705#00", "Heartbeat telegram", "Boot-up"),
        ("e94aycca", "705#05", "Node guarding response", "Operational"),
        ("e94aycca", "605#7000000000000000", "Read segment request", "toggle bit 1"),
        ("e94aycca", "585#0030312E30302E30", "Read segment response", "Further telegrams follow"),
        ("e94aycca", "605#43C25F002B000000", "Parameter data telegram", "No service of this device sends just these"),
        ("e94aycca", "000#0105", "Network management telegram (NMT)", "Start Remote Node"),
        ("e94aycca", "080#", "SYNC", "Synchronisation"),
        ("servo931", "705#7F", "Heartbeat telegram", "Pre-operational"),
        ("servo931", "305#00", "Process data telegram", "RPDO2"),
    ],
)
def test_the_identifier_decides_what_a_telegram_is(
    visitor: Visitor, device: str, line: str, name: str, said: str
) -> None:
    page = visitor.open(f"{device}-telegrams.html")
    page.locator("#d-bytes").fill(line)
    assert page.locator("#decoder .found").inner_text() == name
    assert said in page.locator("#decoder .result").inner_text()
    nodes = page.locator("#decoder dt:text-is('Node address') + dd").all_inner_texts()
    assert nodes == ([] if line.startswith("0") else ["5"])
    identifier, _, data = line.partition("#")
    assert "".join(page.locator("#decoder .bytes code").all_inner_texts()).replace(" ", "") == data
    page.locator("#d-bytes").fill(spaced(bytes.fromhex(data)))
    page.locator("#d-id").fill(identifier)
    assert page.locator("#decoder .found").count() == bool(data)
    assert not data or page.locator("#decoder .found").inner_text() == name


def test_printed_identifiers_lead_to_the_layouts_of_their_examples(visitor: Visitor, model: Model) -> None:
    seen = 0
    for device in model.devices:
        page = visitor.open(f"{device.id}-telegrams.html")
        for example in device.examples:
            if example.identifier is None or None in example.data:
                continue
            page.locator("#d-bytes").fill(f"{example.identifier:03X}#{bytes(o or 0 for o in example.data).hex()}")
            assert page.locator("#decoder dt:text-is('Layout') + dd").inner_text() == example.layout
            nodes = page.locator("#decoder dt:text-is('Node address') + dd").all_inner_texts()
            assert nodes == ([] if example.node is None else [str(example.node)])
            seen += 1
    assert seen > 15


def test_layouts_without_an_identifier_are_values_alone(visitor: Visitor) -> None:
    page = visitor.open("e94aycca-telegrams.html")
    page.locator("#d-bytes").fill("E8 03 02 05")
    assert "Node guarding entry" in page.locator("#decoder .result").inner_text()
    page.locator("#d-id").fill("7FF")
    shown = page.locator("#decoder .result").inner_text()
    assert "0x7FF is not in the predefined connection set" in shown and "Node guarding entry" not in shown


def test_error_numbers_within_telegrams_are_named(visitor: Visitor, model: Model) -> None:
    drive = next(device.drive for device in model.devices if device.id == "e94aycca")
    assert drive is not None
    low = dict(drive.error_fields)["response"].low
    responses = {response.value: response.name for response in drive.responses}
    page = visitor.open("e94aycca-telegrams.html")
    result = page.locator("#decoder .result")
    for response in (0, max(responses)):
        number = 0x009E0005 | response << low
        page.locator("#d-bytes").fill(f"085#001001{0:02X}{struct.pack('<I', number).hex()}")
        assert f"{response}: {responses[response]}" in result.inner_text()
        card = result.locator(".card a").first
        assert card.inner_text() == "0x009e0005"
        assert (card.get_attribute("href") or "").startswith("e94aycca-e-0x009e0000.html")
        assert "heartbeat error" in result.locator(".card").inner_text()
    page.locator("#d-bytes").fill("085#0000000000000000")
    assert result.locator(".card").count() == 0 and result.locator(".bytes").count() == 1
    page = visitor.open("e94aycen-telegrams.html")
    page.locator("#d-bytes").fill("01 82 80 00 14 00 00 00 02 90 00 00 3D 00" + " 00" * 14)
    shown = page.locator("#decoder .result")
    assert "0x9002 No memory available" in shown.locator(".bytes").inner_text() and "36866" not in shown.inner_text()
    assert shown.locator(".card a").first.get_attribute("href") == "e94aycen-gci-0x9002.html"


def test_decoded_error_numbers_have_the_digits_of_their_lists(visitor: Visitor, model: Model, site: Path) -> None:
    device = the_device(model, "e94aycca")
    page = visitor.open("e94aycca-telegrams.html")
    for error in device.errors:
        if error.kind == "sdo_abort":
            page.locator("#d-bytes").fill(f"581#80001000{struct.pack('<I', error.number).hex()}")
            shown = page.locator("#decoder dt:text-is('Error') + dd")
            assert shown.inner_text().startswith(f"0x{error.number:08x} ")
            assert (site / (shown.locator("a").get_attribute("href") or "")).is_file()


def test_the_builder_refuses_node_addresses_that_no_node_can_have(visitor: Visitor) -> None:
    page = visitor.open("e94aycca-telegrams.html")
    wrong = page.locator("#builder .wrong")
    for node in ("0", "128", "200", "-1", "1000", "x"):
        fill(page, node=node)
        assert wrong.inner_text() == f"'{node}' is no node address: they go from 1 to 127."
        assert page.locator("#builder .telegram-bytes").count() == 0
    for node, identifier in (("1", "0x601"), ("127", "0x67F"), ("", "0x600 + node address")):
        fill(page, node=node)
        assert page.locator("#builder .identifier").inner_text() == identifier and wrong.count() == 0


@pytest.mark.parametrize(
    ("typed", "data", "said"),
    [
        ("1400.01", "40 00 14 01", "Read as I-1400; it could also be C01400"),
        ("i1018", "40 18 10 01", ""),
        ("2BD8", "40 D8 2B 00", ""),
        ("2BD8h", "40 D8 2B 00", ""),
        ("1018", "40 18 10 01", "Read as I-1018; it could also be C01018"),
        ("1008", "40 0F 5C 00", "Read as C01008; it could also be index 0x03F0 or index 0x1008."),
        ("24575", "40 FF 5F 00", ""),
        ("13350", "40 D9 2B 00", ""),
        ("C13351 CAN baud rate", "40 D8 2B 00", ""),
    ],
)
def test_the_builder_reads_numbers_as_the_search_does(visitor: Visitor, typed: str, data: str, said: str) -> None:
    page = visitor.open("e94aycca-telegrams.html")
    fill(page, code=typed)
    assert built(page) == f"{data} 00 00 00 00"
    known = page.locator("#b-known").inner_text()
    assert said in known and ("Read as" in known) == bool(said)
    again = visitor.open(page.url.rpartition("/")[2])
    assert built(again) == f"{data} 00 00 00 00"


def test_error_numbers_have_an_end(visitor: Visitor, model: Model) -> None:
    for device in model.devices:
        page = visitor.open(f"{device.id}-errors.html")
        end = 16 ** max(len(error_text(error.kind, 0)) - 2 for error in device.errors)
        for text in ("99999999999", "0x0123456789ABCDEF", str(end), f"0x{end:X}"):
            page.locator("#e-number").fill(text)
            assert f"'{text}' is too long" in page.locator("#number .wrong").inner_text()
            assert page.locator("#number .found").count() == 0
        page.locator("#e-number").fill(str(end - 1))
        assert f"0x{end - 1:X}" in page.locator("#number .found").inner_text()


def test_error_numbers_are_taken_apart(visitor: Visitor, model: Model, site: Path) -> None:
    for device in model.devices:
        errors = [error for error in device.errors if error.kind == "device"]
        if not errors or device.drive is None:
            continue
        page = visitor.open(f"{device.id}-errors.html")
        result = page.locator("#number .result")
        bits = dict(device.drive.error_fields)["response"]
        names = {response.value: response.name for response in device.drive.responses}
        for nth, error in enumerate(errors[::3]):
            response = nth % len(names)
            for number in {error.number, error.last}:
                reported = number | response << bits.low
                page.locator("#e-number").fill(str(reported) if nth % 2 else f"0x{reported:08X}")
                shown = result.inner_text()
                assert f"{response}: {names[response]}" in shown and error.name in shown
                target = result.locator(".card a").first.get_attribute("href") or ""
                path, _, fragment = target.partition("#")
                text = (site / path).read_text(encoding="utf-8")
                assert f"0x{number:08x}" in text
                assert not fragment or f'id="{fragment}"' in text
                codes = error.adjustable_in
                if len(codes) == error.count:
                    assert str(codes[number - error.number]) in shown


def test_other_error_numbers_are_looked_up(visitor: Visitor, model: Model) -> None:
    for device in model.devices:
        page = visitor.open(f"{device.id}-errors.html")
        for kind in sorted({error.kind for error in device.errors} - {"device"}):
            error = next(error for error in device.errors if error.kind == kind)
            page.locator("#e-number").fill(f"{error.number:x}h")
            assert error.name in page.locator("#number .result").inner_text()
    page.locator("#e-number").fill("06040041")
    assert "0x06040041" in page.locator("#number .result").inner_text()
    page.locator("#e-number").fill("nothing")
    assert page.locator("#number .wrong").is_visible()


def test_codes_and_indexes_convert(visitor: Visitor, model: Model) -> None:
    for device in model.devices:
        if device.drive is None or not device.codes:
            continue
        page = visitor.open(f"{device.id}-codes.html")
        jobs = [
            job
            for code in device.codes
            for job in (["code", code.designation], ["index", str(code.index)], ["hex", f"{code.index:04X}h"])
        ]
        script = "jobs => jobs.map(([name, text]) => document.getElementById('wire-data').convert(name, text).texts)"
        found = page.evaluate(script, jobs)
        expected = [
            {"code": code.designation, "index": str(code.index), "hex": f"0x{code.index:04X}"} for code in device.codes
        ]
        assert found[0::3] == found[1::3] == found[2::3] == expected


def test_the_converter_shows_the_other_slot(visitor: Visitor) -> None:
    page = visitor.open("e94aycca-codes.html")
    page.locator("#c-code").fill("13372/2")
    assert (page.locator("#c-index").input_value(), page.locator("#c-hex").input_value()) == ("11203/2", "0x2BC3/2")
    shown = page.locator("#converter .result")
    assert "C14372/2" in shown.inner_text() and "MXI1" in shown.inner_text()
    page.locator("#c-hex").fill("0x2BD9")
    assert page.locator("#c-code").input_value() == "C13350"
    assert shown.locator("a").first.get_attribute("href") == "e94aycca-c13350.html"
    again = visitor.open(page.url.rpartition("/")[2])
    assert again.locator("#c-index").input_value() == "11225"
    page.locator("#c-index").fill("30000")
    assert page.locator("#converter .wrong").is_visible()


def test_the_converter_knows_objects_and_other_notations(visitor: Visitor) -> None:
    page = visitor.open("e94aycca-codes.html")
    shown = page.locator("#converter .result")
    page.locator("#c-hex").fill("1018")
    assert "I-1018 Identity object" in shown.inner_text() and "not in this manual" not in shown.inner_text()
    assert shown.locator("a").first.get_attribute("href") == "e94aycca-i-1018.html"
    again = visitor.open(page.url.rpartition("/")[2])
    assert "I-1018" in shown.inner_text() and again.locator("#c-index").input_value() == "4120"
    page.locator("#c-code").fill("1018")
    assert "C01018, not in this manual" in shown.inner_text() and "Could also be\nI-1018" in shown.inner_text()
    page.locator("#c-code").fill("2BD8")
    assert shown.locator("a").first.get_attribute("href") == "e94aycca-c13351.html"
    page.locator("#c-hex").fill("13350")
    assert "Could also be\nC13350" in shown.inner_text() and page.locator("#converter .wrong").is_visible()


def test_without_scripts_there_are_no_controls(browser: Browser, site: Path) -> None:
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    for part in ("telegrams", "errors", "codes"):
        page.goto(f"{site.as_uri()}/e94aycca-{part}.html")
        assert page.locator(".instrument").count() and not page.locator(".instrument").first.is_visible()
    page.goto(f"{site.as_uri()}/e94aycca-c13350.html")
    assert page.locator(".wire .bytes").first.is_visible()
    context.close()
