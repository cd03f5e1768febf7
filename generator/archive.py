"""Archives whose bytes depend on their contents alone."""

import io
import zipfile
from collections.abc import Mapping

_MOMENT = (1980, 1, 1, 0, 0, 0)
"""The first that the format can say; an archive carries no time of its own."""
_UNIX = 3
_PLAIN_FILE = 0o100644


def stored_zip(folder: str, files: Mapping[str, bytes]) -> bytes:
    """A zip archive with ``files`` (by path) below ``folder``, in the order of their paths.

    Nothing is compressed, because what a compressor writes depends on its version.
    """
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as archive:
        for path, data in sorted(files.items()):
            entry = zipfile.ZipInfo(f"{folder}/{path}", _MOMENT)
            entry.create_system = _UNIX
            entry.external_attr = _PLAIN_FILE << 16
            archive.writestr(entry, data)
    return buffer.getvalue()
