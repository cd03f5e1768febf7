"""The small invented device of tests/golden/mini, with edits."""

import shutil
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SPEC = ROOT / "tests" / "golden" / "mini" / "spec"


def copy(folder: Path) -> Path:
    """A copy of the small spec, with the schemas, as ``folder``/spec."""
    spec = folder / "spec"
    shutil.copytree(SPEC, spec)
    shutil.copytree(ROOT / "spec" / "schema", spec / "schema")
    return spec


def apply(script: str, spec: Path) -> None:
    """Apply the edits of a fixture to a spec.

    ``--- path`` begins the edit of a file: lines ``- old`` are replaced by the lines ``+ new`` below them, one after
    the other.  ``+++ path`` writes a file of the lines below (with Python's backslash escapes).  ``xxx path`` removes
    a file, ``ddd path`` puts a folder in its place, ``*** path size`` makes a file of that many bytes.
    """
    path, old, new = spec, "", ""
    lines = [*script.splitlines(), "end"]
    for line in lines:
        word, _, rest = line.partition(" ")
        if old and (word not in ("-", "+") or (new and word == "-")):
            _replace(path, old, new)
            old = new = ""
        match word:
            case "---":
                path = spec / rest
            case "+++":
                path = spec / rest
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(b"")
            case "xxx":
                (spec / rest).unlink()
            case "ddd":
                (spec / rest).mkdir(parents=True)
            case "***":
                name, size = rest.split()
                (spec / name).write_bytes(b"#" * int(size))
            case "-":
                old += rest + "\n"
            case "+" if old:
                new += rest + "\n"
            case ">":
                with path.open("ab") as file:
                    file.write(rest.encode("latin-1").decode("unicode_escape").encode("latin-1") + b"\n")
            case _:
                pass


def _replace(path: Path, old: str, new: str) -> None:
    old, new = old.rstrip("\n"), new.rstrip("\n")
    text = path.read_text(encoding="utf-8")
    if text.count(old) != 1:
        raise AssertionError(f"{path.name} holds {text.count(old)} times:\n{old}")
    path.write_text(text.replace(old, new), encoding="utf-8")
