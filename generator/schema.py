"""Validation against the JSON Schemas of spec/schema, with every violation at its place."""

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator
from referencing import Registry, Resource
from referencing.jsonschema import DRAFT202012

from generator.diagnostics import Problems, suggestion
from generator.load import Map, Mark, Seq, read
from generator.model.citation import Where

_TYPES = {
    "object": "a mapping",
    "array": "a list",
    "string": "text",
    "integer": "an integer",
    "boolean": "true or false",
}


_SHARED = "common"
"""Kind of the schema that the others refer to; no file has it."""

_SUFFIX = ".schema.yaml"


class Schemas:
    """The schemas by kind of file ("codes", "device", ...)."""

    def __init__(self, folder: Path, label: str, kinds: Iterable[str], problems: Problems) -> None:
        """Read the schemas of ``kinds`` and those that they refer to; ``label`` is the folder's name in messages.

        Raises:
            DiagnosticsError: A schema is missing or is none.
        """
        names = {kind: f"{label}/{kind}{_SUFFIX}" for kind in sorted({*kinds, _SHARED})}
        documents: dict[str, Map] = {}
        for kind, name in names.items():
            path = folder / f"{kind}{_SUFFIX}"
            if not path.exists():
                problems.add("file-missing", Where(name, 1, 1), f"the schema of {kind} is missing")
            elif (data := read(path, name, problems)) is not None:
                documents[f"{_PREFIX}{kind}"] = data
        problems.stop()
        for kind, name in names.items():
            _SchemaReader(documents, f"{_PREFIX}{kind}", name, problems).check()
        problems.stop()
        registry: Registry[Any] = Registry().with_resources(
            (id_, Resource.from_contents(data, default_specification=DRAFT202012)) for id_, data in documents.items()
        )
        self._names = names
        self._validators = {
            kind: Draft202012Validator(documents[f"{_PREFIX}{kind}"], registry=registry) for kind in names
        }

    def check(self, kind: str, data: Map, name: str, problems: Problems) -> None:
        """Note every violation of ``data``, the content of file ``name``."""
        try:
            for error in self._validators[kind].iter_errors(data):
                _report(error, data, name, problems)
        except RecursionError:
            where = Where(self._names[kind], 1, 1)
            problems.add("schema-file", where, "a reference that the schema follows leads back to itself")


_PREFIX = "drivespec:"
_TEXT, _COUNT = (str,), (int,)
_PLAIN: dict[str, tuple[type, ...]] = {
    "$schema": _TEXT,
    "$id": _TEXT,
    "$ref": _TEXT,
    "title": _TEXT,
    "description": _TEXT,
    "type": (str, Seq),
    "pattern": _TEXT,
    "enum": (Seq,),
    "required": (Seq,),
    "const": (str, int, Map, Seq),
    **dict.fromkeys(("minimum", "maximum", "minLength", "maxLength", "minItems", "maxItems", "minProperties"), _COUNT),
}
"""Words of a schema that hold no schema, with the kinds of their values."""
_SCHEMAS = ("items", "propertyNames", "additionalProperties", "if", "then", "else")
_SCHEMAS_BY_NAME = ("properties", "patternProperties", "$defs")
_SCHEMAS_IN_LISTS = ("oneOf", "anyOf", "allOf")
_WORDS = (*_PLAIN, *_SCHEMAS, *_SCHEMAS_BY_NAME, *_SCHEMAS_IN_LISTS)


class _SchemaReader:
    """Looks at one schema: words that exist, values of their kinds, patterns and references that hold.

    Those words of JSON Schema are known that spec uses; that is faster than its metaschema, and finds unknown words.
    """

    def __init__(self, documents: Mapping[str, Map], id_: str, name: str, problems: Problems) -> None:
        self._documents = documents
        self._id = id_
        self._name = name
        self._problems = problems

    def check(self) -> None:
        """Note every problem."""
        data = self._documents[self._id]
        if data.get("$id") != self._id:
            where = Where(self._name, *data.values_at.get("$id", (1, 1)))
            self._note(where, f"the $id is {data.get('$id', 'missing')}", f"write '$id: {self._id}'")
        self._schema(data, (1, 1), "")

    def _schema(self, schema: Any, mark: Mark, path: str) -> None:
        if not isinstance(schema, Map):
            self._note(Where(self._name, *mark, path), "a schema is a mapping", "write '{type: ...}'")
            return
        for word, value in schema.items():
            at, below = schema.values_at[word], f"{path}/{word}"
            if word in _SCHEMAS:
                if word != "additionalProperties" or not isinstance(value, bool):
                    self._schema(value, at, below)
            elif word in _SCHEMAS_BY_NAME and isinstance(value, Map):
                for name, sub in value.items():
                    if word == "patternProperties":
                        self._pattern(name, Where(self._name, *value.keys_at[name], below))
                    self._schema(sub, value.values_at[name], f"{below}/{name}")
            elif word in _SCHEMAS_IN_LISTS and isinstance(value, Seq):
                for place, sub in enumerate(value):
                    self._schema(sub, value.items_at[place], f"{below}/{place}")
            else:
                at = at if word in _WORDS else schema.keys_at[word]
                self._plain(word, value, Where(self._name, *at, below))

    def _plain(self, word: str, value: Any, where: Where) -> None:
        fits = isinstance(value, _PLAIN.get(word, ())) and (word == "const" or not isinstance(value, bool))
        if word not in _WORDS:
            self._note(where, f"'{word}' is no word of a schema", suggestion(word, _WORDS, "words"))
        elif not fits:
            self._note(where, f"{_found(value)} cannot stand behind '{word}'")
        elif word == "type":
            for name in [value] if isinstance(value, str) else value:
                if name not in _TYPES:
                    self._note(where, f"there is no type '{name}'", suggestion(str(name), list(_TYPES), "types"))
        elif word == "required" and not all(isinstance(name, str) for name in value):
            self._note(where, "'required' lists names")
        elif word == "pattern":
            self._pattern(value, where)
        elif word == "$ref":
            self._reference(value, where)

    def _pattern(self, text: str, where: Where) -> None:
        try:
            re.compile(text)
        except (re.error, OverflowError) as error:
            self._note(where, f"'{text}' is no pattern: {error}")

    def _reference(self, text: str, where: Where) -> None:
        document, _, pointer = text.partition("#")
        found: Any = self._documents.get(document or self._id)
        for step in pointer.split("/")[1:]:
            found = found.get(step) if isinstance(found, Map) else None
        if not isinstance(found, Map):
            self._note(
                where, f"'{text}' leads nowhere", "references are '#/$defs/name' or 'drivespec:common#/$defs/name'"
            )

    def _note(self, where: Where, message: str, hint: str = "") -> None:
        self._problems.add("schema-file", where, message, hint=hint)


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
