"""Documentation of the constants: what they are, in which unit, where it is printed and what is printed wrong."""

from collections.abc import Callable, Iterable, Iterator, Mapping

from generator.emit.python.text import access_text, default_text, doc, range_text, refs_text
from generator.model import Code, Device, DictionaryObject, ErrorEntry, SubIndex


class Documentation:
    """Docstrings of the facts of one device, line by line."""

    def __init__(self, device: Device) -> None:
        self._ledger = {erratum.id: erratum for erratum in device.errata}

    def code(self, code: Code) -> tuple[str, ...]:
        """Docstring of a code."""
        facts = [code.type_name, access_text(code.access)]
        shape = code.data_type if code.is_bitfield else None
        if code.subcodes:
            facts.append(f"subcodes {code.subcodes[0].number} ... {code.subcodes[-1].number}")
        if code.range is not None:
            facts.append(range_text(code.range, shape))
        if code.scaling not in (None, 1):
            facts.append(f"value on the bus = value * {code.scaling}")
        if code.default is not None:
            facts.append(f"default {default_text(code.default, shape)}")
        if code.since is not None:
            facts.append(f"since {code.since}")
        if code.internal:
            facts.append("device-internal, not to be changed")
        slot = "" if code.slot is None else f" ({code.slot})"
        variables = {"code": code.number, "index": code.index, "number": code.number}
        return doc(
            f"{code.name}{slot}: {', '.join(facts)}.",
            code.description,
            *self._errata(code.errata, variables, _index_show),
            f"{code.cite!s}.",
        )

    def object(self, entry: DictionaryObject) -> tuple[str, ...]:
        """Docstring of an object."""
        variables = {"index": entry.index, "number": entry.index}
        return doc(
            f"{entry.name}: {entry.object_type}.",
            entry.description,
            *self._errata(entry.errata, variables, "0x{:X}".format),
            f"{entry.cite!s}.",
        )

    def subindex(self, entry: DictionaryObject, sub: SubIndex) -> tuple[str, ...]:
        """Docstring of a sub-index."""
        facts = [sub.data_type.canopen_name, sub.access]
        if sub.range is not None:
            facts.append(range_text(sub.range, None))
        if sub.default is not None:
            facts.append(f"default {default_text(sub.default, None)}")
        if sub.signature is not None:
            facts.append(f'write "{sub.signature}"')
        if sub.abort is not None:
            facts.append(f"any access ends with abort code 0x{sub.abort:08X}")
        if sub.unused:
            facts.append("no function")
        variables = {"index": entry.index, "number": sub.number}
        return doc(
            f"{sub.name}: {', '.join(facts)}.",
            sub.description,
            f"Mirrors {refs_text(sub.codes)}." if sub.codes else "",
            *self._errata(sub.errata, variables, "0x{:X}".format),
            f"{entry.cite!s}.",
        )

    def error(self, error: ErrorEntry) -> tuple[str, ...]:
        """Docstring of an error number."""
        run = "" if error.last == error.number else f"; a run to 0x{error.last:08X}"
        response = "" if error.response is None else f"; response: {error.response}"
        codes = f"; set in {refs_text(error.adjustable_in)}" if error.adjustable_in else ""
        variables = {"number": error.number}
        return doc(
            f"{error.name}{run}{response}{codes}.",
            error.description,
            *self._errata(error.errata, variables, "0x{:08X}".format),
            f"{error.cite!s}.",
        )

    def _errata(self, ids: Iterable[str], variables: Mapping[str, int], show: Callable[[int], str]) -> Iterator[str]:
        """What is printed and what is used, for each erratum that concerns a fact."""
        for erratum in (self._ledger[id_] for id_ in ids):
            if erratum.printed is not None:
                place = " ".join(erratum.place)
                printed = _ledger_value(erratum.printed(dict(variables)), erratum.printed_text, show)
                used = _ledger_value(erratum.used(dict(variables)), erratum.used_text, show)
                yield f"Erratum {erratum.id}: {place or 'the manual'} prints {printed}; used is {used}."
            else:
                printed = "; ".join(f'"{place.printed}" ({place.location})' for place in erratum.places)
                yield f'Erratum {erratum.id}: printed is {printed}; used is "{erratum.used_text}".'


def _index_show(index: int) -> str:
    return f"{index} = 0x{index:04X}"


def _ledger_value(value: int | str, text: str, show: Callable[[int], str]) -> str:
    """What the ledger says: a text, or a number with the formula that it comes from."""
    if isinstance(value, str):
        return f'"{value}"'
    return f"{show(value)} ({text})" if any(letter.isalpha() for letter in text) else show(value)
