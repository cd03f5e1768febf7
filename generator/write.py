"""The only module that writes artifacts: everything is rendered first, then compared and replaced."""

import contextlib
import errno
import hashlib
import json
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path

MANIFEST = "MANIFEST.json"
"""Name of the list of artifacts with their digests."""


def digest(data: bytes) -> str:
    """SHA-256 of ``data`` in hexadecimal."""
    return hashlib.sha256(data).hexdigest()


def write(folder: Path, files: Mapping[str, bytes], inputs: Mapping[str, str]) -> list[str]:
    """Bring ``folder`` to hold exactly ``files`` and a manifest; return the paths that changed.

    Unchanged files are not touched.  New contents are complete on disk before the first old file is replaced.
    Files that an earlier manifest lists and that are no longer made are removed, others are left alone.

    Args:
        folder: Where the artifacts stand; made when absent.
        files: Contents by path below the folder, with "/" between its parts.
        inputs: Digests of the source files, by name; the manifest keeps them.
    """
    contents = dict(sorted(files.items()))
    contents[MANIFEST] = _manifest(contents, inputs)
    stale = sorted(_listed(folder) - set(contents))
    changed = [path for path, data in contents.items() if _read(folder / path) != data]
    _replace(folder, {path: contents[path] for path in changed})
    for path in stale:
        _remove(folder, path)
    return sorted(set(changed) | set(stale))


def save(folder: Path, files: Mapping[str, bytes]) -> None:
    """Put files into a folder of the user: no manifest, nothing removed; contents are complete before one is replaced.

    Raises:
        OSError: A file cannot be written.
    """
    _replace(folder, files)


def _replace(folder: Path, files: Mapping[str, bytes]) -> None:
    staged: list[tuple[str, Path]] = []
    try:
        for path, data in files.items():
            if (folder / path).is_dir():
                raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(folder / path))
            staged.append((_stage(folder / path, data), folder / path))
        for temporary, final in staged:
            os.replace(temporary, final)
    finally:
        for temporary, _ in staged:
            with contextlib.suppress(FileNotFoundError):
                os.unlink(temporary)


def is_current(folder: Path) -> bool:
    """Whether every file of the manifest is there with its digest."""
    listed = _outputs(folder)
    return bool(listed) and all(
        (data := _read(folder / path)) is not None and digest(data) == value for path, value in listed.items()
    )


def _manifest(contents: Mapping[str, bytes], inputs: Mapping[str, str]) -> bytes:
    document = {
        "note": "Made by drivespec; do not edit. SHA-256 of every source and artifact.",
        "sources": dict(sorted(inputs.items())),
        "artifacts": {path: digest(data) for path, data in contents.items()},
    }
    return (json.dumps(document, indent=1) + "\n").encode("ascii")


def _outputs(folder: Path) -> dict[str, str]:
    try:
        document = json.loads((folder / MANIFEST).read_bytes())
        return {str(path): str(value) for path, value in document["artifacts"].items()}
    except (OSError, ValueError, KeyError, AttributeError, TypeError):
        return {}


def _listed(folder: Path) -> set[str]:
    """Paths of the earlier manifest, those that would lead out of the folder left aside."""
    return {p for p in _outputs(folder) if not p.startswith("/") and ".." not in Path(p).parts}


def _read(path: Path) -> bytes | None:
    try:
        return path.read_bytes()
    except OSError:
        return None


def _stage(final: Path, data: bytes) -> str:
    final.parent.mkdir(parents=True, exist_ok=True)
    descriptor, name = tempfile.mkstemp(prefix=".", suffix=".new", dir=final.parent)
    with os.fdopen(descriptor, "wb") as file:
        file.write(data)
    os.chmod(name, 0o644)
    return name


def _remove(folder: Path, path: str) -> None:
    (folder / path).unlink(missing_ok=True)
    parent = (folder / path).parent
    while parent != folder and not any(parent.iterdir()):
        parent.rmdir()
        parent = parent.parent
