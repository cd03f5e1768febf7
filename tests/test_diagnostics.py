"""Every diagnostic: a fixture edits the small spec and holds the whole text that must come out."""

from pathlib import Path

import mini
import pytest

from generator.diagnostics import DiagnosticsError, SourceText, as_json, as_text
from generator.pipeline import compile_model, render
from generator.rules import RULES

FIXTURES = Path(__file__).resolve().parent / "errors"
EXPECTED = "=== expected\n"


def outcome(script: str, folder: Path) -> tuple[str, set[str]]:
    """Text of the diagnostics, and the rules that they name, after the edits of ``script``."""
    mini.apply(script, mini.copy(folder))
    try:
        render(compile_model(folder / "spec", "spec"))
    except DiagnosticsError as error:
        return as_text(error.diagnostics, SourceText(folder)), {d.rule for d in error.diagnostics}
    return "", set()


@pytest.mark.parametrize("path", sorted(FIXTURES.glob("*.txt")), ids=lambda path: path.stem)
def test_diagnostic_has_the_expected_text(path: Path, tmp_path: Path) -> None:
    script, _, expected = path.read_text(encoding="utf-8").partition(EXPECTED)
    text, rules = outcome(script, tmp_path)
    assert text == expected
    assert path.stem.split(".")[0] in rules


def test_every_rule_has_a_fixture() -> None:
    covered = {path.stem.split(".")[0] for path in FIXTURES.glob("*.txt")}
    assert set(RULES) - covered == set()
    assert covered - set(RULES) == set()


def test_the_small_spec_itself_is_good(tmp_path: Path) -> None:
    assert outcome("", tmp_path) == ("", set())


def test_json_form_holds_the_same_facts(tmp_path: Path) -> None:
    import json

    mini.apply("--- devices/mini/codes.yaml\n-     name: Node address\n+     nane: Node address\n", mini.copy(tmp_path))
    with pytest.raises(DiagnosticsError) as caught:
        compile_model(tmp_path / "spec", "spec")
    entries = json.loads(as_json(caught.value.diagnostics))
    assert [(e["file"], e["line"], e["column"], e["rule"]) for e in entries] == [
        (d.where.file, d.where.line, d.where.column, d.rule) for d in caught.value.diagnostics
    ]
    assert "did you mean 'name'" in entries[0]["hint"]
