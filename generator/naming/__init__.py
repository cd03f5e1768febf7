"""Names for generated code: words, cases, reserved words and collisions.

A label of the manual becomes words (ASCII letters and digits), the words become an identifier of a case, reserved
identifiers get a trailing underscore, and every output scope refuses a name that two facts would share.
"""

import re
import unicodedata
from functools import cache
from pathlib import Path

from generator.emit.base import EmitError
from generator.model import Where

_TRANSLATE = str.maketrans({"µ": "u", "μ": "u", "®": " ", "%": " percent ", "→": " to ", "&": " and ", "°": " deg "})
_WORD = re.compile(r"[A-Za-z0-9]+")
_RESERVED = Path(__file__).resolve().parent / "reserved"


@cache
def words(text: str) -> tuple[str, ...]:
    """Words of a label in lower case.

    >>> words("CAN TPDO1 mask byte x")
    ('can', 'tpdo1', 'mask', 'byte', 'x')
    >>> words("Resp. to CAN bus OFF (150 µs)")
    ('resp', 'to', 'can', 'bus', 'off', '150', 'us')
    """
    plain = unicodedata.normalize("NFKD", text.translate(_TRANSLATE)).encode("ascii", "ignore").decode("ascii")
    return tuple(word.lower() for word in _WORD.findall(plain))


@cache
def reserved(language: str) -> frozenset[str]:
    """Reserved words of a language ("c", "python", "rust"), from the data file of that name."""
    return frozenset((_RESERVED / f"{language}.txt").read_text(encoding="ascii").split())


def snake(*parts: str) -> str:
    """Parts as ``snake_case``.

    >>> snake("C13350", "CAN node address")
    'c13350_can_node_address'
    """
    return "_".join(word for part in parts for word in words(part))


def screaming(*parts: str) -> str:
    """Parts as ``SCREAMING_SNAKE_CASE``."""
    return snake(*parts).upper()


def pascal(*parts: str) -> str:
    """Parts as ``PascalCase``.

    >>> pascal("CAN heartbeat status")
    'CanHeartbeatStatus'
    """
    return "".join(word[0].upper() + word[1:] for part in parts for word in words(part))


def safe(name: str, language: str, leading: str = "n") -> str:
    """``name``, or a legal neighbour of it: ``leading`` goes before a digit, ``_`` after a reserved word.

    >>> safe("off", "c"), safe("class", "python"), safe("10_kbps", "rust", "rate_")
    ('off', 'class_', 'rate_10_kbps')
    """
    if not name or name[0].isdecimal():
        name = leading + name
    return name + "_" if name in reserved(language) else name


class Scope:
    """Names of one output scope; two facts must not share a name after encoding.

    Raises:
        EmitError: By ``add``, rule "name-collision", when a second fact claims a name.
    """

    def __init__(self, title: str) -> None:
        """Begin a scope; ``title`` names it in messages ("constants of e94aycca.h")."""
        self._title = title
        self._names: dict[str, Where] = {}
        self._count = 0

    def add(self, name: str, where: Where) -> str:
        """Claim ``name`` for the fact at ``where`` and return it."""
        first = self._names.setdefault(name, where)
        if len(self._names) == self._count:
            raise EmitError(
                "name-collision",
                where,
                f"'{name}' would stand twice among the {self._title}",
                "give the two entries names that differ in more than case and punctuation",
                first,
            )
        self._count += 1
        return name
