"""<device>_tables.h: the records of one device, and the numbers that its self-test prints of them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby

from generator.emit.c.common import ERROR_KINDS, NO_RESPONSE, drive_prefix
from generator.emit.c.device import DefaultRun, access_flags, code_defaults, device_prefix
from generator.emit.c.prose import provenance
from generator.emit.c.syntax import comment, integer, string, text_size
from generator.emit.c.writer import Names, access, wire_limits
from generator.emit.hashing import perfect_hash
from generator.model import Code, Device, ErrorEntry, Model, NodeRelative, Slot
from generator.naming import snake

_NAMES = (
    "codes",
    "code_text",
    "code_texts",
    "defaults",
    "errors",
    "error_text",
    "error_texts",
    "baud_rates",
    "find_code",
    "find_code_by_index",
    "find_code_by_name",
    "find_default",
    "find_error",
    "find_reported_error",
)
"""Ends of the names of a device's tables and lookups."""

_BYTE = 256
"""Records that a byte tells apart."""


@dataclass(frozen=True, slots=True)
class Text:
    """A text with the end that C gives it."""

    size: str
    literal: str


class Texts:
    """Texts one behind the other; the first is empty, so that no text begins at 0."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._places = {"": 0}
        self._end = 1

    def place(self, text: str) -> str:
        """Where a text begins; the same text is there once."""
        if text not in self._places:
            self._places[text] = self._end
            self._end += text_size(text)
        return integer(self._places[text], 16)

    @property
    def texts(self) -> tuple[Text, ...]:
        """The texts in their order."""
        return tuple(Text(integer(text_size(text), 16), string(text)) for text in self._places)


@dataclass(frozen=True, slots=True)
class ErrorHash:
    """Perfect hash of the error numbers of a kind; its places lead to their records.

    ``stem`` begins the names of its tables.  ``first`` is the first number where there are no gaps, else empty.
    ``long`` are the places of runs that the hash leaves out.
    """

    kind: str
    stem: str
    first: str
    factor: str
    shift: str
    seed_shift: str
    seeds: str
    last_slot: str
    place_type: str
    places: str
    long: str


@dataclass(frozen=True, slots=True)
class SlotView:
    """A module slot: its name as the manual has it, the function for its codes, and how its constants begin."""

    name: str
    function: str
    prefix: str


@dataclass(frozen=True, slots=True)
class Tables:
    """Records of a device, each the text between its braces; ``stem`` and ``prefix`` begin the names."""

    file: str
    guard: str
    device_file: str
    brief: str
    notes: tuple[str, ...]
    stem: str
    prefix: str
    masked: bool
    code_texts: Texts
    codes: tuple[str, ...]
    defaults: tuple[str, ...]
    error_texts: Texts
    errors: tuple[str, ...]
    error_hashes: tuple[ErrorHash, ...]
    index_base: str
    slots: tuple[SlotView, ...]
    baud_rates: str


def device_tables(model: Model, device: Device, names: Names) -> Tables:
    """View of the tables of a device."""
    prefix, stem = device_prefix(device), device_prefix(device).lower()
    for name in _NAMES:
        names.claim(f"{stem}_{name}", device.where)
    errors = sorted_errors(device)
    code_texts, error_texts = Texts(f"{stem}_code_texts"), Texts(f"{stem}_error_texts")
    return Tables(
        file=f"{device.id}_tables.h",
        guard=names.claim(f"DRIVESPEC_{prefix}_TABLES_H", device.where),
        device_file=f"{device.id}.h",
        brief=comment(f"Records of the {device.title}; each file that includes this has its own."),
        notes=provenance(model, [device.manual], [device.manufacturer]),
        stem=stem,
        prefix=prefix,
        masked=bool(device.error_mask),
        code_texts=code_texts,
        codes=tuple(_code(code, code_texts) for code in device.codes),
        defaults=tuple(
            _run(code, run, code_texts) for code in device.codes for run in code_defaults(code) if not run.shared
        ),
        error_texts=error_texts,
        errors=tuple(_error(error, device, error_texts) for error in errors),
        error_hashes=tuple(_hashes(errors, device, names)),
        index_base=f"{drive_prefix(device.drive)}_INDEX_BASE" if device.drive else "",
        slots=tuple(_slot(slot, device, names) for slot in device.slots),
        baud_rates=", ".join(integer(rate, 16) for rate in device.canopen.baud_rates) if device.canopen else "",
    )


def _slot(slot: Slot, device: Device, names: Names) -> SlotView:
    function = names.claim(snake(device.id, "code_in", slot.name), device.where)
    return SlotView(comment(slot.name), function, f"{device_prefix(device)}_{slot.name}")


def _hashes(errors: Sequence[ErrorEntry], device: Device, names: Names) -> Iterator[ErrorHash]:
    """Hashes of the kinds that the device has; ``errors`` are its records, sorted by kind."""
    first = 0
    for kind, group in groupby(errors, key=lambda error: error.kind):
        runs = [(error.number, error.last) for error in group]
        found = perfect_hash(runs)
        stem = f"{device_prefix(device).lower()}_{kind}_error"
        for name in ("seeds", "places", "long"):
            names.claim(f"{stem}_{name}", device.where)
        yield ErrorHash(
            kind=f"DRIVESPEC_ERROR_{kind.upper()}",
            stem=stem,
            first="" if found.first is None else integer(found.first, 32, hexadecimal=True),
            factor=integer(found.factor, 32, hexadecimal=True),
            shift=integer(found.shift, 8),
            seed_shift=integer(found.seed_shift, 8),
            seeds=", ".join(integer(seed, 8) for seed in found.seeds),
            last_slot=integer(len(found.places) - 1, 32),
            place_type="uint8_t" if len(errors) <= _BYTE else "uint16_t",
            places=", ".join(integer(first + place, 16) for place in found.places),
            long=", ".join(integer(first + place, 16) for place in found.long),
        )
        first += len(runs)


def sorted_errors(device: Device) -> list[ErrorEntry]:
    """Errors in the order that the lookup needs."""
    return sorted(device.errors, key=lambda error: (ERROR_KINDS.index(error.kind), error.last, error.number))


def response_value(error: ErrorEntry, device: Device) -> int:
    """Number of the preset response in the drive's list."""
    if device.drive and error.response is not None:
        for response in device.drive.responses:
            if error.response in (response.name, *response.aliases):
                return response.value
    return NO_RESPONSE


def _code(code: Code, texts: Texts) -> str:
    shared = [run for run in code_defaults(code) if run.shared]
    default = shared[0] if shared else None
    low, high = wire_limits(code.range, code.scaling or 1) if code.range else (0, 0)
    return ", ".join(
        (
            integer(low, 64, signed=True),
            integer(high, 64, signed=True),
            *_default(default, texts),
            texts.place(code.name),
            integer(code.scaling or 0, 32),
            integer(code.number, 16),
            integer(code.index, 16, hexadecimal=True),
            access(access_flags(code)),
            f"DRIVESPEC_TYPE_{code.data_type.canopen_name}",
            _has(code.range is not None, default),
            integer(len(code.subcodes), 8),
            integer(code.highest_subcode, 8),
        )
    )


def _run(code: Code, run: DefaultRun, texts: Texts) -> str:
    return ", ".join(
        (
            *_default(run, texts),
            integer(code.number, 16),
            _has(False, run),
            integer(run.first, 8),
            integer(run.last, 8),
        )
    )


def _default(run: DefaultRun | None, texts: Texts) -> tuple[str, str, str]:
    """Members ``default_value``, ``default_text`` and ``default_base``."""
    value = run.value if run else None
    base = _base(run)
    return (
        integer(value if isinstance(value, int) else 0, 64, signed=True),
        texts.place(value) if isinstance(value, str) else "0u",
        integer(base.base if base else 0, 32, hexadecimal=True),
    )


def _base(run: DefaultRun | None) -> NodeRelative | None:
    if run is None:
        return None
    return run.value if isinstance(run.value, NodeRelative) else run.follows


def _has(has_range: bool, run: DefaultRun | None) -> str:
    """Flags of what the record holds."""
    flags = [
        *["DRIVESPEC_HAS_RANGE"] * has_range,
        *["DRIVESPEC_HAS_DEFAULT"] * (run is not None and isinstance(run.value, (int, str))),
        *["DRIVESPEC_HAS_DEFAULT_BASE"] * (_base(run) is not None),
    ]
    return " | ".join(flags) or "0u"


def _error(error: ErrorEntry, device: Device, texts: Texts) -> str:
    return ", ".join(
        (
            texts.place(error.name),
            integer(error.number, 32, hexadecimal=True),
            integer(error.last, 32, hexadecimal=True),
            f"DRIVESPEC_ERROR_{error.kind.upper()}",
            integer(response_value(error, device), 8),
        )
    )
