"""GSD files: runs of modules expanded, placeholders filled, bits of error number fields placed."""

from collections.abc import Iterator, Mapping, Sequence

from generator.diagnostics import suggestion
from generator.elaborate.common import fill, origin, run, unique
from generator.load import Map
from generator.model import Drive, Gsd
from generator.model.gsd import (
    BitRate,
    Consistency,
    Diagnosis,
    DiagnosisArea,
    DpTelegrams,
    Keyword,
    Module,
    Source,
    Wording,
)
from generator.notation import value_range
from generator.tree import Node


def gsd(root: Node, drive: Drive | None, errata: Sequence[str], telegrams: Sequence[DpTelegrams]) -> Gsd | None:
    """The GSD file of a device's gsd.yaml, ``None`` where no standard says what the ``telegrams`` hold.

    ``errata`` are the ids of the device's ledger.
    """
    if not telegrams:
        message = "no standard says what the telegrams of PROFIBUS DP hold"
        root.problems.add("key-missing", root.where, message, hint="add 'profibus_dp:' to a file of spec/standards")
        return None
    reader = _Reader(drive, errata)
    file, rates, parameters = (_child(root, key) for key in ("file", "bit_rates", "user_parameters"))
    diagnosis = root.child("diagnosis")
    return Gsd(
        stem=str(file.get("stem")),
        suffixes=tuple((suffix, str(language)) for suffix, language in file.get("suffixes").items()),
        cite=file.cite(),
        keywords=tuple(reader.keyword(name, node) for name, node in root.children("keywords")),
        bit_rates=tuple(BitRate(name, int(times)) for name, times in rates.get("rates").items()),
        bit_rates_cite=rates.cite(),
        max_tsdr=reader.source(_child(rates, "max_tsdr")),
        telegrams=telegrams[0],
        parameters=bytes(parameters.get("bytes")),
        parameters_source=reader.source(parameters),
        modules=tuple(module for node in unique(root, "modules") for module in reader.modules(node)),
        diagnosis=reader.diagnosis(diagnosis) if diagnosis else None,
        where=file.at("stem"),
    )


def _child(node: Node, key: str) -> Node:
    child = node.child(key)
    assert child is not None
    return child


class _Reader:
    """Reads the entries of one file."""

    def __init__(self, drive: Drive | None, errata: Sequence[str]) -> None:
        self._drive = drive
        self._errata = errata

    def keyword(self, name: str, node: Node) -> Keyword:
        value = node.get("value")
        return Keyword(name, value if isinstance(value, int) else _wording(node, "value", {}), self.source(node))

    def source(self, node: Node) -> Source:
        names = node.texts("errata")
        for name in names:
            if name not in self._errata:
                hint = suggestion(name, self._errata, "errata")
                node.problems.add("name-unknown", node.at("errata"), f"there is no erratum '{name}'", hint=hint)
        return Source(
            origin=origin(node),
            cite=node.cite() if "cite" in node else None,
            note=str(node.get("note", "")).strip(),
            errata=names,
            where=node.where,
        )

    def modules(self, node: Node) -> Iterator[Module]:
        """The modules of an entry, one for each number of words."""
        low, high = _words(node)
        channel = int(node.get("channel", 0))
        source = self.source(node)
        for words in range(low, high + 1):
            values = {"n": words}
            printed = fill(str(node.get("printed")), node, "printed", values)
            yield Module(
                family=str(node.get("id")),
                name=_wording(node, "name", values),
                printed=printed,
                info=_wording(node, "info", {**values, "channel": channel, "printed": printed})
                if "info" in node
                else None,
                channel=channel,
                words=words,
                consistency=Consistency(node.get("consistency")),
                reference=int(node.get("reference")) + words - low,
                source=source,
            )

    def diagnosis(self, node: Node) -> Diagnosis:
        start = node.get("error_number")
        return Diagnosis(
            type=int(node.get("type")),
            cite=node.cite(),
            areas=tuple(self._area(area, start) for area in unique(node, "areas")),
            where=node.where,
        )

    def _area(self, node: Node, start: int | None) -> DiagnosisArea:
        field = node.get("field")
        first, last = self._bits(node, field, start)
        texts = _child(node, "texts")
        return DiagnosisArea(
            id=str(node.get("id")),
            field=field,
            first=first,
            last=last,
            texts=tuple((int(value, 0), _wording(texts, value, {})) for value in texts.data),
            source=self.source(node),
        )

    def _bits(self, node: Node, field: str | None, start: int | None) -> tuple[int, int]:
        """Bits of an area: those that it names, or those of its field."""
        if field is None:
            bits = node.read("bits", value_range)
            if bits is None:
                node.problems.add("key-missing", node.where, "an area names its bits or the field that they hold")
                return 0, 0
            return int(bits.low), int(bits.high)
        fields = dict(self._drive.error_fields) if self._drive else {}
        if start is None or field not in fields:
            missing = "the diagnosis" if start is None else "the drive"
            hint = (
                "add 'error_number:' to the diagnosis" if start is None else suggestion(field, list(fields), "fields")
            )
            message = f"{missing} does not say where the field '{field}' stands"
            node.problems.add("name-unknown", node.at("field"), message, hint=hint)
            return 0, 0
        return start + fields[field].low, start + fields[field].high


def _words(node: Node) -> tuple[int, int]:
    words = node.get("words")
    if isinstance(words, int):
        return words, words
    return run(node, "words") or (0, 0)


def _wording(node: Node, key: str, values: Mapping[str, int | str]) -> Wording:
    """The text of a key in both languages."""
    value = node.get(key)
    if not isinstance(value, Map):
        text = fill(str(value), node, key, values)
        return Wording(text, text)
    words = _child(node, key)
    return Wording(*(fill(str(words.get(language)), words, language, values) for language in ("en", "de")))
