"""The schemas of spec: closed, described, and the one list of legal keys."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from generator.diagnostics import Problems
from generator.load import read
from generator.schema import described

FOLDER = Path(__file__).resolve().parent.parent / "spec" / "schema"


@pytest.fixture(params=sorted(FOLDER.glob("*.yaml")), ids=lambda path: path.stem)
def schema(request: pytest.FixtureRequest) -> Any:
    problems = Problems()
    data = read(request.param, request.param.name, problems)
    assert problems.found == []
    return data


def test_schemas_are_schemas(schema: Any) -> None:
    Draft202012Validator.check_schema(schema)
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"


def test_every_key_is_described(schema: Any) -> None:
    assert [path for path, ok in described(schema) if not ok] == []


def _objects(schema: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(schema, dict):
        if schema.get("type") == "object":
            yield path, schema
        for key, value in schema.items():
            yield from _objects(value, f"{path}/{key}")
    elif isinstance(schema, list):
        for i, value in enumerate(schema):
            yield from _objects(value, f"{path}/{i}")


def test_every_mapping_is_closed(schema: Any) -> None:
    """Names of slots, columns and values of an example are data; every other mapping lists its keys."""
    free = [path for path, part in _objects(schema) if "additionalProperties" not in part]
    assert [path for path in free if not path.endswith("/examples/items/properties/values")] == []
