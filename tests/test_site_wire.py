"""Telegrams in the reference: bytes on the pages of entries, and the instruments that build and decode them."""

import re
import struct
from collections.abc import Callable, Iterator
from html.parser import HTMLParser
from pathlib import Path

import pytest

from generator.emit.html.places import code_entries, error_id, object_id, page_of
from generator.model import Code, Device, Model, NodeRelative

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
