"""Validation against the JSON Schemas of spec/schema, with every violation at its place."""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator
from referencing import Registry, Resource
from referencing.jsonschema import DRAFT202012

from generator.diagnostics import Problems, suggestion
from generator.load import Map, Seq, read
from generator.model.citation import Where

_TYPES = {
    "object": "a mapping",
    "array": "a list",
    "string": "text",
    "integer": "an integer",
    "boolean": "true or false",
}


class Schemas:
    """The schemas by kind of file ("codes", "device", ...)."""

    def __init__(self, folder: Path, label: str, problems: Problems) -> None:
        """Read ``*.schema.yaml`` of ``folder``; ``label`` is its name in messages."""
        documents: dict[str, Map] = {}
        for path in sorted(folder.glob("*.schema.yaml")):
            data = read(path, f"{label}/{path.name}", problems)
            if data is not None:
                documents[path.name.removesuffix(".schema.yaml")] = data
        registry: Registry[Any] = Registry().with_resources(
            (str(data["$id"]), Resource.from_contents(data, default_specification=DRAFT202012))
            for data in documents.values()
        )
        self._validators = {
            kind: Draft202012Validator(data, registry=registry) for kind, data in documents.items() if "type" in data
        }

    @property
    def kinds(self) -> tuple[str, ...]:
        """Kinds of files that have a schema."""
        return tuple(self._validators)

    def check(self, kind: str, data: Map, name: str, problems: Problems) -> None:
        """Note every violation of ``data``, the content of file ``name``."""
        for error in self._validators[kind].iter_errors(data):
            _report(error, data, name, problems)


def _report(error: Any, data: Map, name: str, problems: Problems) -> None:
    if error.validator in ("oneOf", "anyOf") and error.context:
        deepest = max(len(e.absolute_path) for e in error.context)
        inner = [e for e in error.context if len(e.absolute_path) == deepest]
        if deepest > len(error.absolute_path):
            for sub in inner:
                _report(sub, data, name, problems)
            return
        expected = " or ".join(dict.fromkeys(_expected(e) for e in inner))
        problems.add("schema", _where(error, data, name), f"expected {expected}, found {_found(error.instance)}")
        return
    if error.validator == "additionalProperties" and isinstance(error.instance, Map):
        _report_unknown_keys(error, data, name, problems)
        return
    where = _where(error, data, name)
    if error.validator == "required":
        missing = [key for key in error.validator_value if key not in error.instance]
        for key in missing:
            text = _describe(error.schema, key)
            problems.add("key-missing", where, f"the key '{key}' is missing", hint=f"add '{key}: ...'{text}")
        return
    if error.validator in ("type", "enum", "const"):
        hint = _retype_hint(error)
        problems.add("schema", where, f"expected {_expected(error)}, found {_found(error.instance)}", hint=hint)
        return
    if error.validator == "pattern":
        problems.add(
            "schema",
            where,
            f"{_found(error.instance)} does not have the form {error.validator_value}",
            hint=str(error.schema.get("description", "")),
        )
        return
    problems.add("schema", where, error.message, hint=str(error.schema.get("description", "")))


def _report_unknown_keys(error: Any, data: Map, name: str, problems: Problems) -> None:
    patterns: list[re.Pattern[str]] = [re.compile(p) for p in error.schema.get("patternProperties", {})]
    legal: list[str] = list(error.schema.get("properties", {}))
    path = _path(error)
    for key in error.instance:
        if key in legal or any(p.search(key) for p in patterns):
            continue
        line, column = error.instance.keys_at[key]
        hint = suggestion(str(key), legal, "keys") if legal else f"keys have the form {patterns[0].pattern}"
        problems.add("key-unknown", Where(name, line, column, path), f"'{key}' is not a key here", hint=hint)


def _expected(error: Any) -> str:
    if error.validator == "type":
        kinds: list[str] = [error.validator_value] if isinstance(error.validator_value, str) else error.validator_value
        return " or ".join(_TYPES.get(kind, kind) for kind in kinds)
    if error.validator == "enum":
        return "one of " + ", ".join(str(v) for v in error.validator_value)
    if error.validator == "const":
        return str(error.validator_value)
    if error.validator == "pattern":
        return f"text of the form {error.validator_value}"
    return str(error.message)


def _found(instance: Any) -> str:
    if isinstance(instance, bool):
        return f"the word {str(instance).lower()}"
    if isinstance(instance, int):
        return f"the number {instance}"
    if isinstance(instance, str):
        return f"the text '{instance}'"
    return "a mapping" if isinstance(instance, Mapping) else "a list"


def _retype_hint(error: Any) -> str:
    expected = error.validator_value
    if error.validator == "enum":
        return suggestion(str(error.instance), [str(v) for v in expected], "values")
    if expected == "string" and isinstance(error.instance, int):
        return "put it in quotes to make it text"
    if "integer" in expected and isinstance(error.instance, str):
        return "integers are decimal without leading zeros, or 0x and hexadecimal digits"
    return str(error.schema.get("description", ""))


def _describe(schema: Any, key: str) -> str:
    description = schema.get("properties", {}).get(key, {}).get("description")
    return f" ({description})" if description else ""


def _path(error: Any) -> str:
    return "/" + "/".join(str(p) for p in error.absolute_path)


def _where(error: Any, data: Map, name: str) -> Where:
    line, column = 1, 1
    node: Any = data
    for step in error.absolute_path:
        if isinstance(node, Map):
            line, column = node.values_at.get(str(step), (line, column))
        elif isinstance(node, Seq) and isinstance(step, int):
            line, column = node.items_at[step]
        node = node[step]
    return Where(name, line, column, _path(error))


def described(schema: Any, path: str = "") -> Iterator[tuple[str, bool]]:
    """Every key of a schema document with whether it, or what it refers to, has a description."""
    if isinstance(schema, dict):
        for key, sub in schema.get("properties", {}).items():
            yield f"{path}/{key}", "description" in sub or "$ref" in sub
        for word, sub in schema.items():
            yield from described(sub, f"{path}/{word}")
    elif isinstance(schema, list):
        for i, sub in enumerate(schema):
            yield from described(sub, f"{path}/{i}")
