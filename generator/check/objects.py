"""Checks of objects: values, the standard, the codes that mirror them."""

from collections.abc import Iterator

from generator.check.codes import STRING_CHARACTERS, fits, fits_string
from generator.check.finding import Finding
from generator.model import CodeRef, Device, DictionaryObject, Model, ObjectRef, SubIndex


def _subs(device: Device) -> Iterator[tuple[DictionaryObject, SubIndex, ObjectRef]]:
    for entry in device.objects:
        for sub in entry.subindexes:
            yield entry, sub, ObjectRef(entry.index, sub.number)


def values(model: Model, device: Device) -> Iterator[Finding]:
    """Rules range-order, range-type, default-type, default-range, selection-type and bit-width of sub-indexes."""
    for _, sub, ref in _subs(device):
        kind = sub.data_type
        if not fits_string(sub.default, kind):
            message = f"{kind.canopen_name} cannot hold the default '{sub.default}'"
            yield _finding("default-type", ref, sub, "default", str(sub.default), STRING_CHARACTERS, message)
        if not kind.is_number:
            continue
        if sub.range is not None:
            low, high = sub.range.low, sub.range.high
            if low > high:
                yield _finding("range-order", ref, sub, "range", str(low), str(high), "the range descends")
            if not kind.lowest <= low <= high <= kind.highest:
                message = f"{kind.canopen_name} cannot hold {low} ... {high}"
                yield _finding(
                    "range-type", ref, sub, "range", f"{low} ... {high}", f"{kind.lowest} ... {kind.highest}", message
                )
            if isinstance(sub.default, int) and not low <= sub.default <= high:
                message = f"the default {sub.default} lies outside {low} ... {high}"
                yield _finding("default-range", ref, sub, "default", sub.default, f"{low} ... {high}", message)
        if not fits(sub.default, kind):
            yield _finding(
                "default-type",
                ref,
                sub,
                "default",
                str(sub.default),
                kind.highest,
                f"{kind.canopen_name} cannot hold the default",
            )
        for option in sub.options:
            if not kind.lowest <= option.value <= kind.highest:
                message = f"{kind.canopen_name} cannot hold the selection {option.value}"
                yield _finding("selection-type", ref, sub, "selection", option.value, kind.highest, message)
        for bit in [b.number for b in sub.bits] + [f.high for f in sub.fields]:
            if bit >= kind.bits:
                yield _finding(
                    "bit-width", ref, sub, "bits", bit, kind.bits - 1, f"{kind.canopen_name} has no bit {bit}"
                )


def standard(model: Model, device: Device) -> Iterator[Finding]:
    """Rules standard-object, standard-type, standard-access and standard-default against CiA 301."""
    for entry, sub, ref in _subs(device):
        norm = entry.standard
        if norm is None:
            continue
        defined = norm.subindex(sub.number)
        if defined is None:
            yield _finding(
                "standard-object",
                ref,
                sub,
                "subindex",
                sub.number,
                "none",
                f"the standard gives {norm.name} no such sub-index",
            )
            continue
        if sub.printed_type != defined.data_type:
            message = (
                f"the standard defines {defined.data_type.canopen_name}, printed is {sub.printed_type.canopen_name}"
            )
            yield _finding(
                "standard-type",
                ref,
                sub,
                "type",
                sub.printed_type.canopen_name,
                defined.data_type.canopen_name,
                message,
            )
        if sub.printed_access not in defined.access:
            message = f"the standard allows {' or '.join(defined.access)}, printed is {sub.printed_access}"
            yield _finding("standard-access", ref, sub, "access", sub.printed_access, defined.access[0], message)
        if None not in (sub.default, defined.default) and sub.default != defined.default:
            message = f"the standard presets {defined.default}, printed is {sub.default}"
            yield _finding("standard-default", ref, sub, "default", str(sub.default), str(defined.default), message)


def mandatory(model: Model, device: Device) -> Iterator[Finding]:
    """Rule standard-mandatory: what CiA 301 demands of every device, and of every object that is there."""
    if device.bus != "CANopen":
        return
    known = {o.index: o for o in device.objects}
    for norm in model.standard_objects:
        if norm.category == "mandatory" and norm.first not in known:
            yield Finding(
                rule="standard-mandatory",
                subject=ObjectRef(norm.first),
                place="object",
                printed="absent",
                expected="present",
                message=f"the standard makes {ObjectRef(norm.first)} ({norm.name}) mandatory",
                where=device.where,
                hint="add it to objects.yaml, with 'origin: standard' where the manual does not print it",
            )
        for entry in device.objects:
            if entry.standard is not norm:
                continue
            for defined in norm.subindexes:
                if defined.mandatory and entry.subindex(defined.first) is None:
                    yield Finding(
                        rule="standard-mandatory",
                        subject=entry.ref,
                        place=f"subindex {defined.first}",
                        printed="absent",
                        expected="present",
                        message=f"the standard makes sub-index {defined.first} of {entry.designation} mandatory",
                        where=entry.where,
                    )


def code_references(model: Model, device: Device) -> Iterator[Finding]:
    """Rules reference and slot-twin: codes and abort codes exist; of a code of a slot its twins are named, too."""
    codes = {c.number: c for c in device.codes}
    aborts = {error.number for error in device.errors if error.kind == "sdo_abort"}
    for _, sub, ref in _subs(device):
        if sub.abort is not None and sub.abort not in aborts:
            abort, message = f"0x{sub.abort:08X}", "the device lists no such abort code"
            yield _finding("reference", ref, sub, "abort", abort, "an abort code of the device", message)
        for place, refs in sub.printed_codes:
            for code in refs:
                yield from _unknown_code(ref, sub, place, code, device)
            named = [codes[r.number] for r in refs if r.number in codes]
            slots = {s.name for s in device.slots}
            for twin in dict.fromkeys(c.twin_of for c in named if c.slot is not None):
                present = [c for c in named if c.twin_of == twin]
                missing = slots - {c.slot for c in present if c.slot}
                if missing or len(present) > len(slots):
                    printed = " / ".join(c.designation for c in present)
                    expected = " / ".join(c.designation for c in device.codes if c.twin_of == twin)
                    yield _finding(
                        "slot-twin",
                        ref,
                        sub,
                        f"{place} codes",
                        printed,
                        expected,
                        f"the {place} names {printed} for the slots",
                    )


def _unknown_code(ref: ObjectRef, sub: SubIndex, place: str, code: CodeRef, device: Device) -> Iterator[Finding]:
    problem = missing_code(code, device)
    if problem:
        yield _finding("reference", ref, sub, f"{place} codes", str(code), "a code of the device", problem)


def missing_code(ref: CodeRef, device: Device) -> str:
    """What is wrong with a reference to a code, "" where the code and its subcode exist."""
    code = next((c for c in device.codes if c.number == ref.number), None)
    if code is None:
        return f"the device has no code {CodeRef(ref.number)}"
    if ref.subcode is not None and not any(s.number == ref.subcode for s in code.subcodes):
        return f"{code.designation} has no subcode {ref.subcode}"
    return ""


def mirrors(model: Model, device: Device) -> Iterator[Finding]:
    """Rule mirror: a code that the overview relates to an object says so in its own table."""
    codes = {c.number: c for c in device.codes}
    for entry, sub, ref in _subs(device):
        for number in dict.fromkeys(c.number for c in sub.codes):
            code = codes.get(number)
            if code is None or any(o.index == entry.index and o.subindex in (None, sub.number) for o in code.objects):
                continue
            yield _finding(
                "mirror",
                ref,
                sub,
                f"overview {code.designation}",
                code.designation,
                "none",
                f"the overview relates {ref} to {code.designation}, whose own table does not say so",
            )


def _finding(
    rule: str, ref: ObjectRef, sub: SubIndex, place: str, printed: int | str, expected: int | str, message: str
) -> Finding:
    return Finding(
        rule=rule,
        subject=ref,
        place=place,
        printed=printed,
        expected=expected,
        message=f"{ref}: {message}",
        where=sub.where,
    )
