"""The ledger: every disagreement is explained by one entry, and every entry explains one."""

import re
from collections.abc import Iterable, Sequence

from generator.check.finding import Finding
from generator.diagnostics import Problems
from generator.model import CodeRef, Device, Erratum, ObjectRef
from generator.model.erratum import Subject

ELLIPSIS = "..."
"""In the texts of a ledger entry: whatever stands there, the same in what is printed and what is used."""


def settle(device: Device, findings: Sequence[Finding], problems: Problems) -> None:
    """Note findings without an erratum and errata without a finding."""
    explained: dict[tuple[str, Subject], int] = {}
    by_rule: dict[str, list[Erratum]] = {}
    for erratum in device.errata:
        if erratum.rule is not None:
            by_rule.setdefault(erratum.rule, []).append(erratum)
    for finding in findings:
        _settle_one(finding, by_rule.get(finding.rule, []), explained, problems)
    for erratum in device.errata:
        _check_entry(device, erratum, explained, problems)


def _settle_one(
    finding: Finding, candidates: Sequence[Erratum], explained: dict[tuple[str, Subject], int], problems: Problems
) -> None:
    matching = [e for e in candidates if finding.subject in e.about and _is_prefix(e.place, finding.place)]
    if finding.agrees:
        _refuse_claims(finding, matching, problems)
        return
    for erratum in matching:
        _check_formula(erratum, finding, problems)
    fitting = [e for e in matching if _fits(e, finding)]
    for erratum in fitting:
        key = (erratum.id, finding.subject)
        explained[key] = explained.get(key, 0) + 1
    if len(fitting) > 1:
        problems.add(
            "erratum-ambiguous",
            fitting[1].where,
            f"'{fitting[0].id}' and '{fitting[1].id}' both explain the {finding.place} of {finding.subject}",
            hint="narrow one of them by 'place' or 'about'",
            other=("other entry", fitting[0].where),
        )
    if fitting:
        return
    hint = finding.hint or "correct the transcription, or explain the manual's error in errata.yaml"
    if matching:
        said = matching[0]
        hint = f"erratum '{said.id}' covers the place, but says: printed {said.printed_text}, used {said.used_text}"
    problems.add(
        finding.rule,
        finding.where,
        finding.message,
        compared=[("place", finding.place), ("printed", _show(finding.printed)), ("expected", _show(finding.expected))],
        hint=hint,
    )


def _refuse_claims(finding: Finding, matching: Sequence[Erratum], problems: Problems) -> None:
    for erratum in matching:
        problems.add(
            "erratum-unused",
            erratum.where,
            f"erratum '{erratum.id}' claims an error in the {finding.place} of {finding.subject}, which is right",
            compared=[("printed", _show(finding.printed)), ("expected", _show(finding.expected))],
            hint="narrow 'place' or 'about', or correct the transcription",
            other=("printed", finding.where),
        )


def _check_formula(erratum: Erratum, finding: Finding, problems: Problems) -> None:
    for value in (erratum.printed, erratum.used):
        try:
            if value is not None:
                value(finding.variables)
        except KeyError as error:
            known = ", ".join(finding.variables) or "no variable"
            problems.add(
                "erratum-formula",
                erratum.where,
                f"erratum '{erratum.id}' uses {error}, which findings of rule '{finding.rule}' do not have",
                hint=f"{known} can stand here",
            )
            return
        except ZeroDivisionError:
            problems.add(
                "erratum-formula",
                erratum.where,
                f"a formula of erratum '{erratum.id}' divides by 0",
                hint="behind 'mod' stands a number other than 0",
            )
            return


def _is_prefix(place: tuple[str, ...], full: str) -> bool:
    return tuple(full.split())[: len(place)] == place


def _fits(erratum: Erratum, finding: Finding) -> bool:
    try:
        printed = erratum.printed(finding.variables) if erratum.printed is not None else finding.printed
        used = erratum.used(finding.variables)
    except (KeyError, ZeroDivisionError):
        return False
    if isinstance(printed, str) and isinstance(used, str) and ELLIPSIS in printed + used:
        return _fits_pattern(printed, used, finding)
    return printed == finding.printed and used == finding.expected


def _fits_pattern(printed: str, used: str, finding: Finding) -> bool:
    """Whether both texts have their pattern, and what the ellipses stand for is the same in both."""
    found = [
        re.fullmatch("(.*)".join(re.escape(part) for part in pattern.split(ELLIPSIS)), str(value))
        for pattern, value in ((printed, finding.printed), (used, finding.expected))
    ]
    if found[0] is None or found[1] is None:
        return False
    return all(a == b for a, b in zip(found[0].groups(), found[1].groups(), strict=False))


def _show(value: int | str) -> str:
    return f"{value} (0x{value:X})" if isinstance(value, int) and value >= 0 else str(value)


def _check_entry(
    device: Device, erratum: Erratum, explained: dict[tuple[str, Subject], int], problems: Problems
) -> None:
    known = _subjects(device)
    for subject in erratum.about:
        if _whole(subject) not in known:
            problems.add(
                "reference",
                erratum.where,
                f"erratum '{erratum.id}' concerns {subject}, which the device does not have",
                hint="name a code, object or error, or a thing such as table:<id>, telegram:<id>, device:<id>",
            )
    if not erratum.about:
        problems.add("reference", erratum.where, f"erratum '{erratum.id}' concerns nothing that the device has")
    if erratum.rule is None:
        if not erratum.places:
            problems.add(
                "erratum-unused",
                erratum.where,
                f"erratum '{erratum.id}' names neither a rule nor the places that disagree",
                hint="add 'rule:' or 'places:'",
            )
        return
    idle = [subject for subject in erratum.about if (erratum.id, subject) not in explained]
    if idle:
        shown = ", ".join(str(s) for s in idle[:5]) + (f" and {len(idle) - 5} more" if len(idle) > 5 else "")
        problems.add(
            "erratum-unused",
            erratum.where,
            f"erratum '{erratum.id}' explains no disagreement of rule '{erratum.rule}' at {shown}",
            compared=[
                ("place", " ".join(erratum.place)),
                ("printed", erratum.printed_text),
                ("used", erratum.used_text),
            ],
            hint="remove it, or narrow 'about' to what really disagrees",
        )


def _whole(subject: Subject) -> Subject:
    if isinstance(subject, CodeRef):
        return CodeRef(subject.number)
    return ObjectRef(subject.index) if isinstance(subject, ObjectRef) else subject


def _subjects(device: Device) -> set[Subject]:
    named: list[tuple[str, Iterable[str]]] = [
        ("led", (t.id for t in device.indicators)),
        ("switch", (s.id for s in device.switches)),
        ("table", (t.id for t in device.tables)),
        ("formula", (f.id for f in device.formulas)),
        ("layout", (x.id for x in device.layouts)),
        ("telegram", (e.id for e in device.examples)),
        ("service", (s.id for s in device.services)),
    ]
    things = {f"{kind}:{name}" for kind, names in named for name in names} | {f"device:{device.id}"}
    return {c.ref for c in device.codes} | {o.ref for o in device.objects} | {e.ref for e in device.errors} | things
