"""What the site offers to take away: artifacts, archives of the libraries, and the digests of all of them."""

from collections.abc import Mapping

from generator.archive import stored_zip
from generator.write import digest

SUMS = "SHA256SUMS"
"""Name of the list of digests, in the form that ``sha256sum -c`` reads."""

_SINGLE = ("eds/", "xdd/", "gsd/", "json/", "c/include/")
"""Beginnings of the paths of artifacts that are offered by themselves."""
_ARCHIVES = {"c": "drivespec-c", "python": "drivespec-devices-python", "rust": "drivespec-devices-rust"}
"""Targets of which all files together are offered, with the name of the archive and of the folder in it."""


def offer(version: str, artifacts: Mapping[str, bytes]) -> dict[str, bytes]:
    """Files to take away, by path below the folder that holds them.

    Args:
        version: Version of the spec, part of the names of the archives.
        artifacts: Every artifact of every target, by path below generated/.
    """
    files = {path: data for path, data in artifacts.items() if path.startswith(_SINGLE)}
    for target, name in _ARCHIVES.items():
        stem = f"{name}-{version}"
        start = f"{target}/"
        parts = {path.removeprefix(start): data for path, data in artifacts.items() if path.startswith(start)}
        files[f"{stem}.zip"] = stored_zip(stem, parts)
    return files


def sums(files: Mapping[str, bytes]) -> bytes:
    """Digests of ``files``, one a line, by their paths."""
    return "".join(f"{digest(data)}  {path}\n" for path, data in sorted(files.items())).encode()
