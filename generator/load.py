"""Strict YAML: plain data with a span for every node, and nothing that YAML 1.1 would change in silence.

What is read is a subset of YAML 1.2: mappings with text keys, sequences, text, integers (decimal without leading
zeros, or 0x hexadecimal), ``true`` and ``false``.  Every other plain scalar stays the text that was typed: ``OFF``,
``010``, ``1:30``, ``2.10`` and ``2012-06`` are not touched.  Duplicate keys, merge keys, tags, anchors and aliases,
several documents, deep nesting and large files are refused.
"""

import gc
import re
from pathlib import Path
from typing import Any

import yaml

from generator.diagnostics import Problems
from generator.model.citation import Where

MAX_BYTES = 4 * 1024 * 1024
"""Largest file that is read, in bytes."""
MAX_DEPTH = 24
"""Deepest nesting of mappings and sequences."""
MAX_KEY = 250
"""Characters of the longest key."""

_PARSER = getattr(yaml, "CBaseLoader", yaml.BaseLoader)
_PLAIN_INT = re.compile(r"(-?(?:0|[1-9][0-9]*)|-?0x[0-9A-Fa-f]+)\Z")
_CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f\ufffe\uffff]")
_WORDS = {"true": True, "false": False}

Mark = tuple[int, int]
"""Line and column, counted from 1."""


class Map(dict[str, Any]):
    """A mapping that knows where each key and each value stands."""

    __slots__ = ("keys_at", "values_at")

    def __init__(self) -> None:
        """Begin empty."""
        super().__init__()
        self.keys_at: dict[str, Mark] = {}
        self.values_at: dict[str, Mark] = {}


class Seq(list[Any]):
    """A sequence that knows where each item stands."""

    __slots__ = ("items_at",)

    def __init__(self) -> None:
        """Begin empty."""
        super().__init__()
        self.items_at: list[Mark] = []


def read(path: Path, name: str, problems: Problems) -> Map | None:
    """Data of a YAML file, ``None`` where a problem was noted; ``name`` is the file's name in messages."""
    start = Where(name, 1, 1)
    try:
        raw = path.read_bytes()
    except OSError as error:
        problems.add("yaml-file", start, f"cannot be read: {error.strerror}")
        return None
    if len(raw) > MAX_BYTES:
        problems.add(
            "yaml-size",
            start,
            f"{len(raw)} bytes are more than a file may have",
            compared=[("largest", MAX_BYTES)],
            hint="split the file",
        )
        return None
    try:
        text = raw.decode("utf-8")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        problems.add("yaml-encoding", Where(name, line, 1), f"byte 0x{raw[error.start]:02X} is not UTF-8")
        return None
    return loads(text, name, problems)


def loads(text: str, name: str, problems: Problems) -> Map | None:
    """Data of a YAML text, ``None`` where a problem was noted."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        return _Reader(text, name, problems).document()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = Where(name, mark.line + 1, mark.column + 1) if mark else Where(name, 1, 1)
        context = f" ({error.context})" if error.context else ""
        problems.add("yaml-syntax", place, f"{error.problem or 'not YAML'}{context}")
    except yaml.reader.ReaderError as error:
        position = error.position if isinstance(error.position, int) else 0
        line = text.count("\n", 0, position) + 1
        problems.add("yaml-encoding", Where(name, line, 1), "a control character cannot stand in YAML")
    finally:
        if enabled:
            gc.enable()
    return None


class _Reader:
    """One pass over libyaml's events."""

    def __init__(self, text: str, name: str, problems: Problems) -> None:
        self._next = _PARSER(text).get_event
        self._name = name
        self._problems = problems
        self._start = len(problems.found)

    def document(self) -> Map | None:
        """The only document of the stream, which must be a mapping."""
        self._next()
        event = self._next()
        if isinstance(event, yaml.StreamEndEvent):
            self._refuse("yaml-syntax", (1, 1), "the file is empty", "every file holds one mapping")
            return None
        event = self._next()
        value = self._node(event, 0)
        self._next()
        event = self._next()
        if not isinstance(event, yaml.StreamEndEvent):
            self._refuse("yaml-syntax", _mark(event), "a second document begins here", "one file, one document")
        if not isinstance(value, Map):
            self._refuse("yaml-syntax", (1, 1), "the file is not a mapping", "begin with 'key: value'")
        if len(self._problems.found) > self._start:
            return None
        return value if isinstance(value, Map) else None

    def _node(self, event: Any, depth: int) -> Any:
        kind = type(event)
        if kind is yaml.AliasEvent:
            self._refuse("yaml-anchor", _mark(event), "aliases are not allowed", "write the value out")
            return ""
        if event.anchor is not None:
            self._refuse("yaml-anchor", _mark(event), "anchors are not allowed", "write the value out")
        if event.tag is not None and event.tag != "!":
            self._refuse("yaml-tag", _mark(event), f"the tag '{event.tag}' is not allowed", "leave it out")
        if kind is yaml.ScalarEvent:
            return self._scalar(event)
        if depth >= MAX_DEPTH:
            self._refuse("yaml-depth", _mark(event), f"nested deeper than {MAX_DEPTH}", "flatten the structure")
            self._skip()
            return Map()
        return self._map(depth) if kind is yaml.MappingStartEvent else self._seq(depth)

    def _map(self, depth: int) -> Map:
        result = Map()
        read_next = self._next
        while True:
            event = read_next()
            if type(event) is yaml.MappingEndEvent:
                return result
            mark = _mark(event)
            key = self._key(event, depth)
            value_event = read_next()
            value = self._node(value_event, depth + 1)
            if key is None:
                continue
            if key in result:
                first = Where(self._name, *result.keys_at[key])
                self._problems.add(
                    "yaml-duplicate",
                    Where(self._name, *mark),
                    f"the key '{key}' stands twice in one mapping",
                    hint="keep one of them",
                    other=("first", first),
                )
                continue
            result[key] = value
            result.keys_at[key] = mark
            result.values_at[key] = _mark(value_event)

    def _key(self, event: Any, depth: int) -> str | None:
        if type(event) is not yaml.ScalarEvent or event.anchor is not None or event.tag is not None:
            self._refuse("yaml-key", _mark(event), "a key must be plain text")
            if type(event) in (yaml.MappingStartEvent, yaml.SequenceStartEvent):
                self._skip()
            return None
        if event.value == "<<" and event.implicit[0]:
            self._refuse("yaml-merge", _mark(event), "merge keys are not allowed", "write the keys out")
            return None
        if len(event.value) > MAX_KEY or _CONTROL.search(event.value):
            self._refuse("yaml-key", _mark(event), f"a key is one line of at most {MAX_KEY} characters")
            return None
        return str(event.value)

    def _seq(self, depth: int) -> Seq:
        result = Seq()
        while True:
            event = self._next()
            if type(event) is yaml.SequenceEndEvent:
                return result
            result.append(self._node(event, depth + 1))
            result.items_at.append(_mark(event))

    def _scalar(self, event: Any) -> Any:
        text = event.value
        if not event.implicit[0]:
            if _CONTROL.search(text.replace("\n", "")):
                self._refuse("yaml-encoding", _mark(event), "a control character cannot stand in a text")
            return text
        if _PLAIN_INT.match(text):
            if len(text) > 20:
                self._refuse("yaml-number", _mark(event), f"'{text}' has too many digits", "quote it if it is text")
                return 0
            return int(text, 16) if "x" in text else int(text)
        if text in _WORDS:
            return _WORDS[text]
        if text in ("", "~", "null"):
            self._refuse("yaml-null", _mark(event), "the value is empty", "give a value or leave the key out")
            return ""
        return text

    def _skip(self) -> None:
        """Read to the end of the collection that has just begun."""
        depth = 1
        while depth:
            kind = type(self._next())
            if kind in (yaml.MappingStartEvent, yaml.SequenceStartEvent):
                depth += 1
            elif kind in (yaml.MappingEndEvent, yaml.SequenceEndEvent):
                depth -= 1

    def _refuse(self, rule: str, mark: Mark, message: str, hint: str = "") -> None:
        self._problems.add(rule, Where(self._name, *mark), message, hint=hint)


def _mark(event: Any) -> Mark:
    mark = event.start_mark
    return (mark.line + 1, mark.column + 1)
