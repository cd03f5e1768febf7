"""Navigation in loaded YAML: values with their place, and diagnostics where a notation does not fit."""

from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from generator.diagnostics import Problems
from generator.load import Map, Seq
from generator.model import ANYWHERE, Cite, Cited, Where
from generator.notation import NotationError, citation

T = TypeVar("T")


class Node:
    """A mapping of a file with its way of keys; the schema has vouched for the kinds of its values."""

    __slots__ = ("_at", "data", "file", "path", "problems")

    def __init__(self, data: Map, file: "SourceFile", path: str = "", at: Where | None = None) -> None:
        """Wrap ``data``, which stands at ``at`` (default: the head of the file)."""
        self.data = data
        self.file = file
        self.path = path
        self.problems = file.problems
        self._at = at

    @property
    def where(self) -> Where:
        """Place of the mapping."""
        return self._at or Where(self.file.name, 1, 1, self.path)

    def __contains__(self, key: str) -> bool:
        return key in self.data

    def get(self, key: str, default: Any = None) -> Any:
        """The plain value of a key."""
        return self.data.get(key, default)

    def at(self, key: str, offset: int = 0) -> Where:
        """Place of the value of a key, ``offset`` columns on; of the mapping where the key is absent."""
        if key not in self.data:
            return self.where
        line, column = self.data.values_at[key]
        return Where(self.file.name, line, column + offset, f"{self.path}/{key}")

    def at_key(self, key: str) -> Where:
        """Place of a key itself."""
        line, column = self.data.keys_at[key]
        return Where(self.file.name, line, column, f"{self.path}/{key}")

    def child(self, key: str) -> "Node | None":
        """The mapping below a key."""
        value = self.data.get(key)
        return Node(value, self.file, f"{self.path}/{key}", self.at(key)) if isinstance(value, Map) else None

    def children(self, key: str) -> Iterator[tuple[str, "Node"]]:
        """The mappings of a mapping of mappings below a key."""
        parent = self.child(key)
        if parent is not None:
            for name in parent.data:
                child = parent.child(name)
                if child is not None:
                    yield name, child

    def items(self, key: str) -> Iterator["Node"]:
        """The mappings of the list below a key."""
        value = self.data.get(key)
        if isinstance(value, Seq):
            for i, item in enumerate(value):
                line, column = value.items_at[i]
                path = f"{self.path}/{key}/{i}"
                yield Node(item, self.file, path, Where(self.file.name, line, column, path))

    def texts(self, key: str) -> tuple[str, ...]:
        """The texts of the list below a key."""
        return tuple(str(v) for v in self.data.get(key, ()))

    def read(self, key: str, notation: Callable[[str], T], text: str | None = None) -> T | None:
        """The value of a key in a notation, ``None`` where it is absent or a problem was noted."""
        if key not in self.data:
            return None
        return self.file.read(notation, str(self.data[key]) if text is None else text, self.at(key))

    def cite(self, key: str = "cite") -> Cite:
        """The citation below a key, with the manual of the file's head where it names none."""
        return self.file.cite(str(self.data.get(key, "")), self.at(key))

    def cites(self, key: str) -> tuple[Cite, ...]:
        """The citations of the list below a key."""
        found = []
        for i, text in enumerate(self.data[key]):
            line, column = self.data[key].items_at[i]
            found.append(self.file.cite(str(text), Where(self.file.name, line, column, f"{self.path}/{key}/{i}")))
        return tuple(found)

    def chapter(self, key: str) -> str | None:
        """The chapter below a key, one of the manual of the file's head; ``None`` where it is absent."""
        if key not in self.data:
            return None
        cite = Cite(self.file.manual, str(self.data[key]))
        self.file.cites.append(Cited(cite, self.at(key), page_alone=False))
        return cite.chapter

    def page(self, key: str, manual: str, chapter: str = ANYWHERE) -> int | None:
        """The page below a key, one of a chapter that is named elsewhere; ``None`` where it is absent."""
        if key not in self.data:
            return None
        page = int(self.data[key])
        self.file.cites.append(Cited(Cite(manual, chapter, page), self.at(key), page_alone=True))
        return page


class SourceFile:
    """One loaded file of spec: its name in messages, the manual of its head, and the citations read so far."""

    __slots__ = ("cites", "data", "kind", "manual", "name", "problems", "stem")

    def __init__(self, name: str, kind: str, stem: str, data: Map, problems: Problems) -> None:
        """Wrap ``data``; ``kind`` is the schema it fits, ``stem`` the name that the file or its folder gives it."""
        self.name = name
        self.kind = kind
        self.stem = stem
        self.data = data
        self.problems = problems
        self.manual = str(data.get("manual", ""))
        self.cites: list[Cited] = []

    @property
    def root(self) -> Node:
        """The mapping that the file holds."""
        return Node(self.data, self)

    def read(self, notation: Callable[[str], T], text: str, where: Where) -> T | None:
        """``text`` in a notation, ``None`` where a problem was noted at ``where``."""
        try:
            return notation(text)
        except NotationError as error:
            place = Where(where.file, where.line, where.column + error.column, where.path)
            self.problems.add("notation", place, error.message, hint=f"write it as in '{error.example}'")
            return None

    def cite(self, text: str, where: Where) -> Cite:
        """A citation of this file."""
        parts = self.read(citation, text, where)
        if parts is None:
            return Cite(self.manual, ANYWHERE, None)
        manual, chapter, page = parts
        cite = Cite(manual or self.manual, chapter, page)
        self.cites.append(Cited(cite, where, page_alone=False))
        return cite
