"""Index and hexadecimal arithmetic over every code and error of the real spec."""

import dataclasses
from collections.abc import Iterator

from hypothesis import given
from hypothesis import strategies as st

from generator.check import codes as code_checks
from generator.check import errors as error_checks
from generator.check.finding import Finding
from generator.check.ledger import settle
from generator.diagnostics import Problems
from generator.model import Code, CodeRef, Device, Erratum, ErrorEntry, ErrorRef, Model
from generator.model.values import DataType


def test_every_index_obeys_the_rule(model: Model) -> None:
    for device in model.devices:
        for code in device.codes:
            assert device.drive is not None
            assert code.index == device.drive.index_base - code.number
            assert 0x2000 <= code.index <= 0x5FFF


def test_codes_of_the_slots_are_twins(model: Model) -> None:
    for device in model.devices:
        numbers = {c.number: c for c in device.codes}
        for slot in device.slots[1:]:
            twins = [c for c in device.codes if c.slot == slot.name]
            assert [c.number - slot.code_offset for c in twins] == [c.twin_of for c in twins]
            for code in twins:
                first = numbers[code.twin_of]
                assert (first.name, first.data_type, first.subcodes) == (code.name, code.data_type, code.subcodes)


def test_the_unchanged_figures_are_accepted(model: Model) -> None:
    for device in model.devices:
        for code in device.codes:
            alone = dataclasses.replace(device, codes=(code,), objects=(), errors=())
            findings = list(code_checks.printed_indexes(model, alone))
            assert not _rejected(alone, code.ref, "code-index", findings), code.printed
        for error in device.errors:
            alone = dataclasses.replace(device, codes=(), objects=(), errors=(error,))
            findings = list(error_checks.numbers(model, alone))
            assert not _rejected(alone, error.ref, "error-number", findings), error.printed


def _digits(number: int, base: int, width: int = 0) -> Iterator[int]:
    """The number with one digit changed, every digit and every other value of it."""
    text = format(number, f"0{width}{'X' if base == 16 else 'd'}")
    alphabet = "0123456789ABCDEF"[:base]
    for place, old in enumerate(text):
        for new in alphabet:
            if new != old:
                yield int(text[:place] + new + text[place + 1 :], base)


def _rejected(device: Device, subject: CodeRef | ErrorRef, rule: str, findings: list[Finding]) -> bool:
    """Whether the check refuses the findings on ``subject``, with the ledger cut to what concerns it."""
    ledger = [e for e in device.errata if e.rule == rule and subject in e.about]
    problems = Problems()
    settle(dataclasses.replace(device, errata=tuple(replace_about(e, subject) for e in ledger)), findings, problems)
    return bool(problems.found)


def replace_about(erratum: Erratum, subject: CodeRef | ErrorRef) -> Erratum:
    """The erratum, concerning ``subject`` alone."""
    return dataclasses.replace(erratum, about=(subject,))


def _mutations(code: Code) -> Iterator[Code]:
    for position, printed in enumerate(code.printed):
        variants = [dataclasses.replace(printed, decimal=n) for n in _digits(printed.decimal, 10)]
        if printed.hexadecimal is not None:
            variants += [dataclasses.replace(printed, hexadecimal=n) for n in _digits(printed.hexadecimal, 16, 4)]
        for variant in variants:
            rest = (*code.printed[:position], variant, *code.printed[position + 1 :])
            yield dataclasses.replace(code, printed=rest)


def test_any_changed_digit_of_a_printed_index_is_found(model: Model) -> None:
    tried = 0
    for device in model.devices:
        for code in device.codes:
            for mutant in _mutations(code):
                alone = dataclasses.replace(device, codes=(mutant,), objects=(), errors=())
                findings = list(code_checks.printed_indexes(model, alone))
                assert _rejected(alone, code.ref, "code-index", findings), mutant.printed
                tried += 1
    assert tried > 10_000


def _error_mutations(error: ErrorEntry) -> Iterator[ErrorEntry]:
    for position, printed in enumerate(error.printed):
        width = 8 if printed.base == 16 else 0
        variants = [dataclasses.replace(printed, first=n) for n in _digits(printed.first, printed.base, width)]
        if printed.last is not None:
            variants += [dataclasses.replace(printed, last=n) for n in _digits(printed.last, printed.base, width)]
        for variant in variants:
            rest = (*error.printed[:position], variant, *error.printed[position + 1 :])
            yield dataclasses.replace(error, printed=rest)


def test_any_changed_digit_of_a_printed_error_number_is_found(model: Model) -> None:
    tried = 0
    for device in model.devices:
        for error in device.errors:
            for mutant in _error_mutations(error):
                alone = dataclasses.replace(device, codes=(), objects=(), errors=(mutant,))
                findings = list(error_checks.numbers(model, alone))
                assert _rejected(alone, error.ref, "error-number", findings), mutant.printed
                tried += 1
    assert tried > 5_000


@given(st.sampled_from(list(DataType)))
def test_limits_of_data_types(kind: DataType) -> None:
    if kind.is_number:
        assert kind.highest - kind.lowest + 1 == 1 << kind.bits
        assert (kind.lowest < 0) == kind.signed
