"""The census: every fact of the model, one a line, sorted; and the coverage of each manual."""

import json
from collections import Counter
from collections.abc import Iterator

from generator.emit.json import facts
from generator.model import Device, Model


def lines(model: Model) -> Iterator[str]:
    """Facts as ``device/table/entry/key = value``, then counts, then coverage."""
    found = []
    for device in model.devices:
        for path, value in _flatten(facts(model, device), device.id):
            found.append(f"{path} = {json.dumps(value, ensure_ascii=False)}")
    yield from sorted(found)
    yield ""
    for device in model.devices:
        errors = Counter(e.kind for e in device.errors)
        numbers = Counter[str]()
        for error in device.errors:
            numbers[error.kind] += error.count
        yield f"count {device.id} codes {len(device.codes)}"
        for kind, count in sorted(Counter(o.kind for o in device.objects).items()):
            yield f"count {device.id} objects {kind} {count}"
        for kind, count in sorted(errors.items()):
            yield f"count {device.id} errors {kind} {count} entries, {numbers[kind]} numbers"
        yield from _panel_counts(device)
        for kind, count in sorted(Counter(e.kind for e in device.errata).items()):
            yield f"count {device.id} errata {kind} {count}"
        yield f"count {device.id} errata {len(device.errata)}"
    yield ""
    for manual in sorted(model.manuals, key=lambda m: m.id):
        if manual.kind != "manual":
            continue
        for chapter in manual.chapters:
            note = f": {chapter.note}" if chapter.note else ""
            yield f"coverage {manual.id} {chapter.number} {chapter.status or 'pending'} {chapter.title}{note}"


def _panel_counts(device: Device) -> Iterator[str]:
    yield f"count {device.id} indicators {sum(len(table.rows) for table in device.indicators)} rows"
    for group in device.switches:
        yield f"count {device.id} switches {group.id} {len(group.rows)} rows"
    for table in device.tables:
        yield f"count {device.id} table {table.id} {len(table.rows)} rows"
    yield f"count {device.id} formulas {len(device.formulas)}"
    yield f"count {device.id} telegrams {len(device.layouts)} layouts, {len(device.examples)} examples"


_KEYS = ("code", "index", "subindex", "id", "number", "keyword", "bit_rate", "reference")


def _flatten(value: object, path: str) -> Iterator[tuple[str, object]]:
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _flatten(inner, f"{path}/{key}")
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        for position, inner in enumerate(value):
            name = next((inner[key] for key in _KEYS if key in inner), position)
            kind = f"{inner['kind']}." if "number" in inner and "kind" in inner else ""
            yield from _flatten(inner, f"{path}/{kind}{name}")
    else:
        yield path, value
