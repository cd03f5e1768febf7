"""generated/json: valid, closed, described, and the same facts as the model."""

import json
import re
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from generator.check.telegrams import show
from generator.model import Code, Device, ErrorEntry, Model, NodeRelative, SubIndex
from generator.schema import described

CONTRACT = {
    "codes": {"code", "number", "slot", "name", "data_type", "index", "subcodes", "subcode_names", "access"}
    | {"scaling_factor", "range", "defaults", "options", "bits", "internal", "since", "objects", "printed"}
    | {"description", "cite", "errata"},
    "objects": {"index", "name", "object_type", "kind", "subindexes"},
    "errors": {
        "kind",
        "number",
        "last",
        "name",
        "response",
        "responses",
        "adjustable_in",
        "causes",
        "remedies",
        "cite",
    },
    "indicators": {"leds", "state", "meaning", "cite"},
    "switches": {"name", "switches", "values", "cite"},
    "errata": {"id", "kind", "places", "used", "why", "confidence", "origin"},
}
"""Keys that other people's tools rely on."""


@pytest.fixture(scope="module")
def documents(generated: Path) -> dict[str, Any]:
    return {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in (generated / "json").glob("*.json")}


def test_every_document_is_valid(documents: dict[str, Any], model: Model) -> None:
    schema = documents["schema"]
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    assert set(documents) == {"schema", *(device.id for device in model.devices)}
    for device in model.devices:
        assert [error.message for error in validator.iter_errors(documents[device.id])] == []


def test_the_schema_describes_every_key_and_refuses_others(documents: dict[str, Any], model: Model) -> None:
    assert [path for path, ok in described(documents["schema"]) if not ok] == []
    validator = Draft202012Validator(documents["schema"])
    for device in model.devices:
        assert not validator.is_valid({**documents[device.id], "extra": 1})


def test_the_contract_is_kept(documents: dict[str, Any], model: Model) -> None:
    for device in model.devices:
        for table, keys in CONTRACT.items():
            for entry in documents[device.id][table]:
                assert keys <= entry.keys()


def test_codes_are_those_of_the_model(documents: dict[str, Any], model: Model) -> None:
    for device in model.devices:
        entries = documents[device.id]["codes"]
        assert [e["number"] for e in entries] == [c.number for c in device.codes]
        for entry, code in zip(entries, device.codes, strict=True):
            assert (entry["code"], entry["index"], entry["slot"]) == (code.designation, code.index, code.slot)
            assert (entry["name"], entry["data_type"]) == (code.name, code.type_name)
            assert entry["subcodes"] == max(code.highest_subcode, 1)
            assert entry["subcode_names"] == {str(s.number): s.name for s in code.subcodes if s.name}
            assert entry["access"]["read"] == code.access.read
            assert entry["access"]["write"] == code.access.write
            settings = {s.number: s.default for s in code.subcodes} if code.subcodes else {0: code.default}
            assert entry["defaults"] == {str(k): v for k, v in settings.items() if v is not None}
            assert entry["options"] == {str(o.value): o.label for o in code.options}
            assert entry["bits"] == {str(b.number): b.label for b in code.bits}
            limits = entry["range"]
            assert (limits is None) == (code.range is None)
            if code.range is not None:
                assert (limits["min"], limits["max"]) == (code.range.low, code.range.high)
                assert (limits["unit"] or "") == code.range.unit
            assert (entry["cite"]["chapter"], entry["cite"]["page"]) == (code.cite.chapter, code.cite.page)
            for printed in code.printed:
                place = entry["printed"][printed.place]
                assert (place["decimal"], place["hexadecimal"]) == (printed.decimal, printed.hexadecimal)


def test_objects_and_errors_are_those_of_the_model(documents: dict[str, Any], model: Model) -> None:
    for device in model.devices:
        document = documents[device.id]
        assert [(o["kind"], o["index"]) for o in document["objects"]] == [(o.kind, o.index) for o in device.objects]
        for entry, known in zip(document["objects"], device.objects, strict=True):
            for sub, fact in zip(entry["subindexes"], known.subindexes, strict=True):
                assert (sub["subindex"], sub["name"]) == (fact.number, fact.name)
                assert (sub["data_type"], sub["access"]) == (fact.data_type.canopen_name, fact.access)
                expected = (
                    f"$NODEID+0x{fact.default.base:X}" if isinstance(fact.default, NodeRelative) else fact.default
                )
                assert sub["default"] == expected
                assert sub["codes"] == [str(ref) for ref in fact.codes]
        for error, fact_ in zip(document["errors"], device.errors, strict=True):
            assert (error["kind"], error["number"], error["name"]) == (fact_.kind, fact_.number, fact_.name)
            assert error["last"] == (fact_.last if fact_.last != fact_.number else None)
            assert error["adjustable_in"] == [str(ref) for ref in fact_.adjustable_in]


def test_the_rest_is_that_of_the_model(documents: dict[str, Any], model: Model) -> None:
    for device in model.devices:
        document = documents[device.id]
        states = [row.state for table in device.indicators for row in table.rows]
        assert [row["state"] for row in document["indicators"]] == states
        for group, fact in zip(document["switches"], device.switches, strict=True):
            assert group["values"] == {row.value: row.positions for row in fact.rows}
        for table, known in zip(document["tables"], device.tables, strict=True):
            assert [tuple(row) for row in table["rows"]] == list(known.rows)
            assert (table["connector"] is None) == (known.assignment is None)
            if known.assignment is not None:
                assert table["connector"]["signals"] == {str(pin): text for pin, text in known.assignment.signals}
                assert [(c["number"], c["right"], c["down"]) for c in table["connector"]["contacts"]] == [
                    (c.number, c.right, c.down) for c in known.assignment.connector.contacts
                ]
        assert [e["id"] for e in document["errata"]] == [e.id for e in device.errata]
        _compare_telegrams(document["telegrams"], device)


def _compare_telegrams(groups: Any, device: Device) -> None:
    examples = {e["id"]: e for group in groups for e in group["examples"]}
    assert set(examples) == {e.id for e in device.examples}
    for example in device.examples:
        octets = examples[example.id]["bytes"]
        assert show(tuple(octets)) == show(example.data)
    services = {s["id"]: s for group in groups for s in group["services"]}
    assert services.keys() == {s.id for s in device.services}
    for service in device.services:
        found = services[service.id]
        assert (found["does"], found["errors"], found["limit"]) == (service.does.value, service.errors, service.limit)
        for message, fact in ((found["request"], service.request), (found["answer"], service.answer)):
            assert (message is None) == (fact is None)
            assert fact is None or list(message["values"]) == [name for name, _ in fact.values]
    layouts = {x["id"]: x for group in groups for x in group["layouts"]}
    for layout in device.layouts:
        offset: int | None = 0
        for field, known in zip(layouts[layout.id]["fields"], layout.fields, strict=True):
            assert field["name"] == known.name
            assert field["offset"] == offset
            offset = offset + known.length if offset is not None and isinstance(known.length, int) else None


def test_every_entry_has_a_citation(model: Model) -> None:
    for device in model.devices:
        cites = [c.cite for c in device.codes] + [o.cite for o in device.objects] + [e.cite for e in device.errors]
        cites += [t.cite for t in device.indicators] + [s.cite for s in device.switches]
        cites += [t.cite for t in device.tables] + [x.cite for x in device.layouts] + [e.cite for e in device.examples]
        cites += [s.cite for s in device.services]
        assert all(cite.manual and cite.chapter for cite in cites)


def test_every_chapter_is_accounted_for(model: Model) -> None:
    for manual in model.manuals:
        if manual.kind == "manual":
            for chapter in manual.chapters:
                assert chapter.status in ("transcribed", "not-applicable", "lost"), (manual.id, chapter.number)
                assert chapter.status == "transcribed" or chapter.note, (manual.id, chapter.number)


def test_what_is_cited_is_a_source(documents: dict[str, Any], model: Model) -> None:
    for device in model.devices:
        text = json.dumps({key: value for key, value in documents[device.id].items() if key != "sources"})
        cited = set(re.findall(r'"manual": "([^"]+)"', text))
        assert {source["id"] for source in documents[device.id]["sources"]} == cited
        assert device.manual.id in cited


def test_drive_and_bus_are_those_of_the_model(documents: dict[str, Any], model: Model) -> None:
    for device in model.devices:
        found = documents[device.id]
        assert (found["drive"] is None, found["canopen"] is None) == (device.drive is None, device.canopen is None)
        assert (found["hardware_version"], found["software_version"]) == (
            device.hardware_version,
            device.software_version,
        )
        if device.drive is not None:
            assert found["drive"]["index_base"]["value"] == device.drive.index_base
            for key, entries in (("responses", device.drive.responses), ("modules", device.drive.modules)):
                assert [(e["value"], e["name"], e["origin"]) for e in found["drive"][key]] == [
                    (entry.value, entry.name, entry.origin.value) for entry in entries
                ]
        if device.canopen is not None:
            assert [(e["name"], e["base"]) for e in found["canopen"]["cob_ids"]] == [
                (entry.name, entry.base) for entry in model.cob_ids
            ]


AS_IN_CODES = {"designation": "code", "type_name": "data_type", "scaling": "scaling_factor", "default": "defaults"}
INSIDE = {
    Code: {"data_type", "access", "subcodes", "printed_name", "attributes"},
    SubIndex: {"number", "range", "printed_type", "printed_access"},
    ErrorEntry: {"named_in"},
}
"""Fields that stand in another key: types and accesses as printed in "printed", ends of a range in "min" and "max"."""


@pytest.mark.parametrize(
    ("kind", "table"), [(Code, "codes"), (SubIndex, "subindexes"), (ErrorEntry, "errors")], ids=lambda it: str(it)
)
def test_every_field_of_the_model_is_published(documents: dict[str, Any], kind: type, table: str) -> None:
    """A field that the model gains reaches the document, or is said to stand in another key."""
    entries = [entry for name, found in documents.items() if name != "schema" for entry in found.get(table, ())]
    if kind is SubIndex:
        found = [entry for name, doc in documents.items() if name != "schema" for entry in doc["objects"]]
        entries = [sub for entry in found for sub in entry["subindexes"]]
    names = {AS_IN_CODES.get(field.name, field.name) if kind is Code else field.name for field in fields(kind)}
    assert entries and names - {"where"} - INSIDE[kind] <= set(entries[0])


def test_what_was_left_out_once(documents: dict[str, Any], model: Model) -> None:
    for device in model.devices:
        for entry, code in zip(documents[device.id]["codes"], device.codes, strict=True):
            assert (entry["length"], entry["twin_of"]) == (code.length, code.twin_of)
            described = {str(sub.number): sub.description for sub in code.subcodes if sub.description}
            assert entry["subcode_descriptions"] == described
        for entry, error in zip(documents[device.id]["errors"], device.errors, strict=True):
            assert entry["register"] == error.register
            assert entry["printed_names"] == {place: name for place, name, _ in error.printed_names}
