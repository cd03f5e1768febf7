"""Checks of error numbers: printed forms, names, responses and the codes that set them."""

from collections.abc import Iterator
from itertools import pairwise

from generator.check.finding import Finding
from generator.check.objects import missing_code
from generator.diagnostics import Problems
from generator.model import CodeRef, Device, ErrorEntry, Model, Where


def overlaps(device: Device, problems: Problems) -> None:
    """Rule error-overlap: a number stands in one entry of its kind."""
    for one, other in pairwise(sorted(device.errors, key=lambda error: (error.kind, error.number))):
        if one.kind == other.kind and other.number <= one.last:
            problems.add(
                "error-overlap",
                other.where,
                f"{other.ref} stands in two entries of kind {one.kind}",
                hint="leave the number to one of them",
                other=("other entry", one.where),
            )


def numbers(model: Model, device: Device) -> Iterator[Finding]:
    """Rule error-number: every printed form, hexadecimal and decimal, first and last, is the number."""
    for error in device.errors:
        for printed in error.printed:
            last = error.last if error.count > 1 else None
            ends: tuple[tuple[str, int | None, int | None], ...] = (
                ("first", printed.first, error.number),
                ("last", printed.last, last),
            )
            for end, value, expected in ends:
                form = "hexadecimal" if printed.base == 16 else "decimal"
                yield Finding(
                    rule="error-number",
                    subject=error.ref,
                    place=f"{printed.place} {end} {form}",
                    printed="none" if value is None else value,
                    expected="none" if expected is None else expected,
                    message=f"{error.ref}: {printed.place} prints {_show(value, printed.base)} as {end} number",
                    where=printed.where,
                    variables={"number": error.number},
                )


def _show(value: int | None, base: int) -> str:
    if value is None:
        return "nothing"
    return f"0x{value:08x}" if base == 16 else str(value)


def fields(model: Model, device: Device) -> Iterator[Finding]:
    """Rule error-fields: listed numbers leave those fields clear that the drive fills when it reports an error."""
    drive = device.drive
    if drive is None:
        return
    reported = ~drive.error_mask
    for error in (error for error in device.errors if error.kind == "device"):
        if (error.number | error.last) & reported:
            yield Finding(
                rule="error-fields",
                subject=error.ref,
                place="number",
                printed=_show(error.number, 16),
                expected=_show(error.number & drive.error_mask, 16),
                message=f"{error.ref} fills one of the fields {', '.join(drive.reported_fields)}",
                where=error.where,
                hint="the drive fills them when it reports the error: leave them zero",
            )


def names(model: Model, device: Device) -> Iterator[Finding]:
    """Rule error-name: designations of the overview and of the detailed description."""
    for error in device.errors:
        for place, name, where in error.printed_names:
            if name != error.name:
                yield Finding(
                    rule="error-name",
                    subject=error.ref,
                    place=place,
                    printed=name,
                    expected=error.name,
                    message=f"{error.ref} is called '{error.name}', but here '{name}'",
                    where=where,
                )


def responses(model: Model, device: Device) -> Iterator[Finding]:
    """Rule error-response: the preset response can be selected, and is the default of the code that sets it."""
    drive = device.drive
    if drive is None:
        return
    values = {name: r.value for r in drive.responses for name in (r.name, *r.aliases)}
    codes = {c.number: c for c in device.codes}
    for error in device.errors:
        if error.response is None:
            continue
        preset = values[error.response]
        selectable = {values[name] for name in error.responses}
        if selectable and preset not in selectable:
            yield _response(
                error, "responses", error.response, f"the preset response '{error.response}' cannot be selected"
            )
        for ref in error.adjustable_in:
            code = codes.get(ref.number)
            if code is None:
                continue
            sub = next((s for s in code.subcodes if s.number == ref.subcode), None)
            value = sub.default if sub else code.default
            if isinstance(value, int) and value != preset and (sub is None) == (not code.subcodes):
                yield _response(
                    error, f"code {ref}", error.response, f"{ref} has the Lenze setting {value}, not {error.response}"
                )
            listed = {option.value for option in code.options}
            for name in error.responses:
                if listed and values[name] not in listed:
                    yield _response(error, f"selection {ref}", name, f"'{name}' can be selected, but not in {ref}")


def _response(error: ErrorEntry, place: str, printed: str, message: str) -> Finding:
    return Finding(
        rule="error-response",
        subject=error.ref,
        place=place,
        printed=printed,
        expected="none",
        message=f"{error.ref}: {message}",
        where=error.where,
    )


def adjustable_codes(model: Model, device: Device) -> Iterator[Finding]:
    """Rules reference and error-adjustable: the codes exist, and every place names the same."""
    for error in device.errors:
        for ref in error.named_in:
            problem = missing_code(ref, device)
            if problem:
                yield _adjustable("reference", error, "adjustable_in", (ref,), problem, error.where)
        for place, refs, where in error.printed_adjustable_in:
            if refs != error.named_in:
                expected = ", ".join(str(r) for r in error.named_in)
                message = f"{place} names {', '.join(map(str, refs)) or 'none'}, not {expected}"
                yield _adjustable("error-adjustable", error, place, refs, message, where)


def _adjustable(
    rule: str, error: ErrorEntry, place: str, refs: tuple[CodeRef, ...], message: str, where: Where
) -> Finding:
    expected = ", ".join(str(r) for r in error.named_in) if rule == "error-adjustable" else "none"
    return Finding(
        rule=rule,
        subject=error.ref,
        place=place,
        printed=", ".join(str(r) for r in refs) or "none",
        expected=expected,
        message=f"{error.ref}: {message}",
        where=where,
    )
