"""The named rules over the model, and the ledger that explains what they find."""

from collections.abc import Callable, Iterator

from generator.check import citations, codes, errors, gsd, objects, telegrams
from generator.check.finding import Finding
from generator.check.ledger import settle
from generator.diagnostics import Problems
from generator.model import Device, Model

RULES: tuple[Callable[[Model, Device], Iterator[Finding]], ...] = (
    codes.printed_indexes,
    codes.names,
    codes.attribute_rows,
    codes.ranges,
    codes.defaults,
    codes.selections,
    codes.bits,
    codes.identifiers,
    codes.mirrors,
    objects.values,
    objects.standard,
    objects.mandatory,
    objects.code_references,
    objects.mirrors,
    errors.numbers,
    errors.fields,
    errors.names,
    errors.responses,
    errors.adjustable_codes,
    telegrams.examples,
    telegrams.identifiers,
    telegrams.services,
    telegrams.messages,
    telegrams.formulas,
    telegrams.assignments,
    telegrams.switches,
    telegrams.patterns,
    gsd.identity,
    gsd.texts,
    gsd.lengths,
    gsd.modules,
    gsd.diagnosis,
)
"""Every check: a function from a device to the disagreements that it sees."""


def check(model: Model, problems: Problems) -> None:
    """Check every device and the sources.

    Raises:
        DiagnosticsError: A disagreement that no erratum explains, or an erratum that explains none.
    """
    citations.check(model, problems)
    for device in model.devices:
        errors.overlaps(device, problems)
        settle(device, [finding for rule in RULES for finding in rule(model, device)], problems)
    problems.stop()


__all__ = ["Finding", "check"]
