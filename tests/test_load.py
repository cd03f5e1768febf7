"""Strict YAML: what is typed is what is read."""

import mini
import pytest

from generator.diagnostics import Problems
from generator.load import Map, Seq, loads


def read(text: str) -> Map:
    problems = Problems()
    data = loads(text, "x.yaml", problems)
    assert problems.found == []
    assert data is not None
    return data


@pytest.mark.parametrize(
    "token",
    [
        "OFF",
        "on",
        "Yes",
        "no",
        "010",
        "1:30",
        "2.10",
        "1_000",
        "0o17",
        "0b1",
        "2012-06-01",
        "1e3",
        ".inf",
        "+1",
        "Null",
        "C13350",
    ],
)
def test_tokens_that_yaml_1_1_would_change_stay_text(token: str) -> None:
    assert read(f"key: {token}") == {"key": token}


@pytest.mark.parametrize(
    ("token", "value"),
    [
        ("0", 0),
        ("-5", -5),
        ("65535", 65535),
        ("0x2C00", 0x2C00),
        ("0x00ad001f", 0x00AD001F),
        ("true", True),
        ("false", False),
    ],
)
def test_integers_and_truth_values_are_read(token: str, value: object) -> None:
    data = read(f"key: {token}")
    assert data["key"] == value
    assert type(data["key"]) is type(value)


@pytest.mark.parametrize("text", ["'10'", '"0x10"', "'true'"])
def test_quoted_scalars_are_text(text: str) -> None:
    assert read(f"key: {text}")["key"] == text[1:-1]


def test_keys_are_text_as_typed() -> None:
    assert list(read("{010: a, 8: b, 1...8: c, true: d}")) == ["010", "8", "1...8", "true"]


def test_every_node_knows_its_place() -> None:
    data = read("a: 1\nlist:\n  - x\n  - inner: {k: v}\n")
    assert data.keys_at == {"a": (1, 1), "list": (2, 1)}
    assert data.values_at["a"] == (1, 4)
    items = data["list"]
    assert isinstance(items, Seq)
    assert items.items_at == [(3, 5), (4, 5)]
    inner = items[1]["inner"]
    assert inner.keys_at["k"] == (4, 13)
    assert inner.values_at["k"] == (4, 16)


def test_an_alias_bomb_is_refused_without_being_expanded() -> None:
    bomb = "a: &a [x, x, x, x, x, x, x, x, x]\n"
    bomb += "".join(f"{chr(98 + i)}: &{chr(98 + i)} [{', '.join([f'*{chr(97 + i)}'] * 9)}]\n" for i in range(9))
    problems = Problems()
    assert loads(bomb, "x.yaml", problems) is None
    assert {d.rule for d in problems.found} == {"yaml-anchor"}


def test_collection_is_switched_on_again() -> None:
    import gc

    assert gc.isenabled()
    loads("a: [", "x.yaml", Problems())
    assert gc.isenabled()


def test_libyaml_reads(monkeypatch: pytest.MonkeyPatch) -> None:
    """The C parser is in use: PyYAML's own reads about forty times slower."""
    import yaml

    from generator import load

    assert load._PARSER is yaml.CBaseLoader


def test_both_parsers_read_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    import yaml

    from generator import load

    text = (mini.SPEC / "devices" / "mini" / "codes.yaml").read_text(encoding="utf-8")
    fast = read(text)
    monkeypatch.setattr(load, "_PARSER", yaml.BaseLoader)
    slow = read(text)
    assert fast == slow
    assert fast.values_at == slow.values_at
    assert fast["codes"].items_at == slow["codes"].items_at
