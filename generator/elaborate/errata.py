"""The ledger: subjects resolved, formulas compiled."""

from collections.abc import Callable, Iterable, Sequence

from generator.diagnostics import suggestion
from generator.elaborate.common import known_manual, unique
from generator.model import CodeRef, Erratum, ErratumPlace, ErrorRef, Manual, ObjectRef
from generator.model.erratum import Subject
from generator.notation import RefRun, formula, references
from generator.rules import RULES
from generator.tree import Node

Resolver = Callable[[RefRun], Iterable[Subject]]
"""Gives every subject of a run; runs of codes hold the codes that exist."""


def errata(root: Node, manuals: dict[str, Manual], resolve: Resolver) -> tuple[Erratum, ...]:
    """Entries of a device's errata.yaml, in the order of the file."""
    return tuple(_erratum(node, str(node.get("id")), manuals, resolve) for node in unique(root, "errata"))


def _erratum(node: Node, name: str, manuals: dict[str, Manual], resolve: Resolver) -> Erratum:
    rule = node.get("rule")
    if rule is not None and rule not in RULES:
        hint = suggestion(str(rule), list(RULES), "rules")
        node.problems.add("name-unknown", node.at("rule"), f"there is no rule '{rule}'", hint=hint)
    about = node.get("about")
    texts = (about,) if isinstance(about, str) else tuple(about)
    runs = [run for text in texts for run in node.read("about", references, text) or ()]
    return Erratum(
        id=name,
        kind=str(node.get("kind")),
        rule=rule,
        about=tuple(subject for run in runs for subject in resolve(run)),
        about_text=texts,
        place=tuple(str(node.get("place", "")).split()),
        printed=_value(node, "printed") if "printed" in node else None,
        printed_text=str(node.get("printed", "")),
        used=_value(node, "used"),
        used_text=str(node.get("used")),
        places=tuple(_place(place, manuals, node.file.manual) for place in node.items("places")),
        why=str(node.get("why")).strip(),
        confidence=str(node.get("confidence")),
        origin=str(node.get("origin")),
        where=node.at("id"),
    )


def _place(node: Node, manuals: dict[str, Manual], manual: str) -> ErratumPlace:
    name = str(node.get("manual", manual))
    if "manual" in node:
        known_manual(name, node, "manual", manuals)
    return ErratumPlace(str(node.get("where")), node.page("page", name), name, str(node.get("printed")))


_VARIABLES = ("code", "index", "number")


def _value(node: Node, key: str) -> Callable[[dict[str, int]], int | str]:
    """A literal, or a formula where the text names a variable of what the rule finds."""
    value = node.get(key)
    words = str(value).replace("(", " ").replace(")", " ").split()
    if "rule" not in node or isinstance(value, int) or not _is_formula(words):
        return lambda _: value
    compiled = node.read(key, formula)
    if compiled is None:
        return lambda _: value
    return lambda variables: compiled(variables)


def _is_formula(words: list[str]) -> bool:
    signs = (*_VARIABLES, "+", "-", "*", "mod")
    return any(w in _VARIABLES for w in words) and all(w in signs or w.isdecimal() or w.startswith("0x") for w in words)


def resolver(codes: Iterable[CodeRef], objects: Iterable[ObjectRef], errors: Iterable[ErrorRef]) -> Resolver:
    """Resolver over the codes, objects and errors that a device has."""
    known_errors = sorted(errors)
    by_type: dict[type, Sequence[CodeRef | ObjectRef | ErrorRef]] = {
        CodeRef: sorted(codes),
        ObjectRef: sorted(objects),
        ErrorRef: known_errors,
    }
    kinds = {error.number: error for error in known_errors}

    def named(item: Subject) -> Subject:
        return kinds.get(item.number, item) if isinstance(item, ErrorRef) else item

    def resolve(run: RefRun) -> Iterable[Subject]:
        if run.open_run is None:
            return [named(item) for item in run.items]
        first, last = run.open_run
        low, high = _number(first), _number(last)
        return [item for item in by_type[type(first)] if low <= _number(item) <= high]

    return resolve


def _number(ref: CodeRef | ObjectRef | ErrorRef) -> int:
    return ref.index if isinstance(ref, ObjectRef) else ref.number
