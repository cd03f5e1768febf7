"""Target json: one document a device for other people's tools, and the schema that describes every key."""

import json
from collections.abc import Mapping, Sequence
from fractions import Fraction

from generator.emit.base import Output, Target
from generator.emit.environment import TEMPLATES
from generator.model import (
    AttributeRow,
    Bit,
    BitField,
    CanOpenFacts,
    Choice,
    Cite,
    CobId,
    Code,
    CodeCounts,
    CodeRef,
    Default,
    Device,
    DictionaryObject,
    Drive,
    DriveCommand,
    DriveModule,
    Erratum,
    ErrorEntry,
    Example,
    Field,
    FieldType,
    Filler,
    Filling,
    Fillings,
    Formula,
    Gsd,
    IndicatorRow,
    IndicatorTable,
    Layout,
    Manual,
    Message,
    Model,
    NodeRelative,
    ObjectRef,
    Option,
    Pattern,
    PrintedIndex,
    Range,
    Response,
    Service,
    Slot,
    SubIndex,
    SwitchGroup,
    Table,
    Values,
)
from generator.model.gsd import Diagnosis, Module, Source, Wording
from generator.model.table import Assignment

Json = Mapping[str, object]


def render(model: Model) -> dict[str, Output]:
    """One file a device and ``schema.json``."""
    files = {f"{device.id}.json": _text(facts(model, device)) for device in model.devices}
    files["schema.json"] = Output((TEMPLATES / "json" / "schema.json").read_text(encoding="utf-8"))
    return files


TARGET = Target("json", render)


def _text(document: Json) -> Output:
    return Output(json.dumps(document, indent=1, ensure_ascii=False) + "\n")


def facts(model: Model, device: Device) -> Json:
    """Everything that is known of a device, as the document that generated/json holds."""
    found = _facts(model, device)
    cited = _cited(found)
    return {**found, "sources": [_document(manual) for manual in model.manuals if manual.id in cited]}


def _facts(model: Model, device: Device) -> Json:
    return {
        "device": device.id,
        "title": device.title,
        "manufacturer": device.manufacturer,
        "order_code": device.order_code,
        "bus": device.bus,
        "manual": _manual(device.manual),
        "version": model.version,
        "date": model.date,
        "hardware_version": device.hardware_version,
        "software_version": device.software_version,
        "cite": _cite(device.cite),
        "slots": [slot.name for slot in device.slots],
        "slot_rules": [_slot(slot) for slot in device.slots],
        "drive": _drive(device.drive) if device.drive else None,
        "canopen": _canopen(device.canopen, model.cob_ids) if device.canopen else None,
        "codes": [_code(code) for code in device.codes],
        "objects": [_object(entry) for entry in device.objects],
        "errors": [_error(error) for error in device.errors],
        "indicators": [_indicator(table, row) for table in device.indicators for row in table.rows],
        "switches": [_switch(group) for group in device.switches],
        "tables": [_table(table) for table in device.tables],
        "formulas": [_formula(formula) for formula in device.formulas],
        "telegrams": _telegrams(device),
        "gsd": _gsd(device.gsd) if device.gsd else None,
        "errata": [_erratum(erratum) for erratum in device.errata],
    }


def _manual(manual: Manual) -> Json:
    return {"id": manual.id, "title": manual.title, "edition": manual.edition, "date": manual.date}


def _document(manual: Manual) -> Json:
    return {
        **_manual(manual),
        "publisher": manual.publisher,
        "document": manual.document,
        "kind": manual.kind,
        "url": manual.url,
    }


def _cited(value: object) -> set[str]:
    """Ids of the manuals that a document cites."""
    if isinstance(value, Mapping):
        own = {text for key, text in value.items() if key == "manual" and isinstance(text, str)}
        return own.union(*map(_cited, value.values()))
    if isinstance(value, list):
        return set().union(*map(_cited, value))
    return set()


def _cite(cite: Cite) -> Json:
    return {"manual": cite.manual, "chapter": cite.chapter, "page": cite.page}


def _slot(slot: Slot) -> Json:
    return {
        "name": slot.name,
        "first_code": slot.first_code,
        "last_code": slot.last_code,
        "code_offset": slot.code_offset,
        "error_offset": slot.error_offset,
    }


def _drive(drive: Drive) -> Json:
    return {
        "id": drive.id,
        "title": drive.title,
        "manufacturer": drive.manufacturer,
        "index_base": {"value": drive.index_base, "cites": list(map(_cite, drive.index_base_cites))},
        "error_number": {
            "fields": [
                {"name": name, "low": field.low, "high": field.high, "reported": name in drive.reported_fields}
                for name, field in drive.error_fields
            ],
            "origin": drive.error_fields_origin.value,
            "cite": _cite(drive.error_fields_cite),
        },
        "responses": [{**_named(response), "aliases": list(response.aliases)} for response in drive.responses],
        "modules": list(map(_named, drive.modules)),
        "command_code": _command_code(drive),
        "commands": list(map(_named, drive.commands)),
    }


def _command_code(drive: Drive) -> Json | None:
    if drive.command_code is None:
        return None
    return {
        "code": str(CodeRef(drive.command_code)),
        "index": drive.index_base - drive.command_code,
        "cites": list(map(_cite, drive.command_code_cites)),
    }


def _named(entry: Response | DriveModule | DriveCommand) -> Json:
    return {"value": entry.value, "name": entry.name, "origin": entry.origin.value, "cite": _cite(entry.cite)}


def _canopen(canopen: CanOpenFacts, cob_ids: Sequence[CobId]) -> Json:
    return {
        "bit_rates": list(canopen.baud_rates),
        "pdo_granularity": canopen.granularity,
        "node_address_code": canopen.node_address,
        "node_addresses": {"first": canopen.node_addresses[0], "last": canopen.node_addresses[-1]},
        "boot_up_master": canopen.boot_up_master,
        "cite": _cite(canopen.cite),
        "cob_ids": [
            {
                "name": entry.name,
                "title": entry.title,
                "base": entry.base,
                "broadcast": entry.broadcast,
                "objects": [_object_key(ref) for ref in entry.objects],
                "cite": _cite(entry.cite),
            }
            for entry in cob_ids
        ],
    }


def _code(code: Code) -> Json:
    return {
        "code": code.designation,
        "number": code.number,
        "slot": code.slot,
        "twin_of": code.twin_of,
        "name": code.name,
        "data_type": code.type_name,
        "length": code.length,
        "index": code.index,
        "subcodes": code.highest_subcode or 1,
        "subcode_names": {str(s.number): s.name for s in code.subcodes if s.name},
        "subcode_descriptions": {str(s.number): s.description for s in code.subcodes if s.description},
        "access": {"read": code.access.read, "write": code.access.write, "cinh": "cinh" in code.access.conditions},
        "conditions": list(code.access.conditions),
        "scaling_factor": code.scaling,
        "range": _range(code.range),
        "defaults": _defaults(code),
        "follows": {str(s.number): _default(s.follows) for s in code.subcodes if s.follows is not None},
        "options": _options(code.options),
        "subcode_options": {str(s.number): _options(s.options) for s in code.subcodes if s.options},
        "bits": _bits(code.bits),
        "fields": _fields(code.fields),
        "internal": code.internal,
        "since": code.since,
        "objects": [_object_key(ref) for ref in code.objects],
        "shared_by": code.shared_by,
        "origin": code.origin.value,
        "printed": {
            **{p.place: _printed(p) for p in code.printed},
            **({"name": code.printed_name} if code.printed_name != code.name else {}),
            **({"attributes": _attributes(code.attributes)} if code.attributes else {}),
        },
        "description": code.description,
        "cite": _cite(code.cite),
        "default_cite": _cite(code.default_cite) if code.default_cite else None,
        "errata": list(code.errata),
    }


def _defaults(code: Code) -> Json:
    if code.subcodes:
        return {str(s.number): _default(s.default) for s in code.subcodes if s.default is not None}
    return {} if code.default is None else {"0": _default(code.default)}


def _default(value: Default | None) -> int | str | None:
    return f"$NODEID+0x{value.base:X}" if isinstance(value, NodeRelative) else value


def _range(limits: Range | None) -> Json | None:
    if limits is None:
        return None
    return {"min": _number(limits.low), "max": _number(limits.high), "unit": limits.unit or None}


def _number(value: Fraction) -> int | float:
    return value.numerator if value.denominator == 1 else float(value)


def _options(options: Sequence[Option]) -> Json:
    return {str(option.value): option.label for option in options}


def _bits(bits: Sequence[Bit]) -> Json:
    return {str(bit.number): bit.label for bit in bits}


def _fields(fields: Sequence[BitField]) -> list[Json]:
    return [{"low": f.low, "high": f.high, "name": f.label} for f in fields]


def _object_key(ref: ObjectRef) -> str:
    return f"{ref.index:04X}" + (f":{ref.subindex:02X}" if ref.subindex is not None else "")


def _printed(printed: PrintedIndex) -> Json:
    return {"decimal": printed.decimal, "hexadecimal": printed.hexadecimal, "page": printed.page}


def _attributes(row: AttributeRow) -> Json:
    return {
        "structure": row.structure,
        "count": row.count,
        "data_type": row.type_name,
        "factor": row.factor,
        "access": row.access,
        "name": row.name,
    }


def _object(entry: DictionaryObject) -> Json:
    return {
        "index": entry.index,
        "name": entry.name,
        "object_type": entry.object_type,
        "kind": entry.kind,
        "description": entry.description,
        "subindexes": [_subindex(sub) for sub in entry.subindexes],
        "origin": entry.origin.value,
        "cite": _cite(entry.cite),
        "errata": list(entry.errata),
    }


def _subindex(sub: SubIndex) -> Json:
    return {
        "subindex": sub.number,
        "name": sub.name,
        "data_type": sub.data_type.canopen_name,
        "access": sub.access,
        "printed": {"data_type": sub.printed_type.canopen_name, "access": sub.printed_access},
        "default": _default(sub.default),
        "min": _number(sub.range.low) if sub.range else None,
        "max": _number(sub.range.high) if sub.range else None,
        "unit": (sub.range.unit or None) if sub.range else None,
        "options": _options(sub.options),
        "bits": _bits(sub.bits),
        "fields": _fields(sub.fields),
        "codes": [str(ref) for ref in sub.codes],
        "printed_codes": {place: list(map(str, refs)) for place, refs in sub.printed_codes},
        "signature": sub.signature,
        "pdo_mapping": sub.pdo_mapping,
        "unused": sub.unused,
        "abort": sub.abort,
        "description": sub.description,
        "errata": list(sub.errata),
    }


def _error(error: ErrorEntry) -> Json:
    return {
        "kind": error.kind,
        "number": error.number,
        "last": error.last if error.count > 1 else None,
        "slot": error.slot,
        "name": error.name,
        "response": error.response,
        "responses": list(error.responses),
        "adjustable_in": [str(ref) for ref in error.adjustable_in],
        "register": error.register,
        "causes": list(error.causes),
        "remedies": list(error.remedies),
        "description": error.description,
        "printed": {p.place: {"first": p.first, "last": p.last, "page": p.page} for p in error.printed},
        "printed_names": {place: name for place, name, _ in error.printed_names},
        "printed_adjustable_in": {place: list(map(str, refs)) for place, refs, _ in error.printed_adjustable_in},
        "origin": error.origin.value,
        "cite": _cite(error.cite),
        "errata": list(error.errata),
    }


def _indicator(table: IndicatorTable, row: IndicatorRow) -> Json:
    return {
        "table": table.id,
        "name": table.name,
        "leds": [
            {"led": led.label, "colour": led.colour, "name": led.name, "pattern": _pattern(pattern)}
            for led, pattern in zip(table.leds, row.patterns, strict=True)
        ],
        "state": row.state,
        "meaning": row.meaning,
        "origin": row.origin.value,
        "cite": _cite(row.cite),
        "errata": list(table.errata),
    }


def _pattern(pattern: Pattern) -> Json:
    return {
        "light": pattern.light.value,
        "colour": pattern.colour,
        "period_s": None if pattern.period is None else _number(pattern.period),
        "flashes": pattern.flashes,
        "pause_s": None if pattern.pause is None else _number(pattern.pause),
    }


def _switch(group: SwitchGroup) -> Json:
    return {
        "id": group.id,
        "name": group.name,
        "switches": list(group.labels),
        "weights": list(group.weights),
        "valid": None if group.valid is None else {"first": group.valid[0], "last": group.valid[1]},
        "unit": group.unit or None,
        "sets": [str(ref) for ref in group.sets],
        "block": {"label": group.block.label, "cite": _cite(group.block.cite)} if group.block else None,
        "delivered": (
            {"positions": group.delivered.positions, "cite": _cite(group.delivered.cite)} if group.delivered else None
        ),
        "code_counts": _code_counts(group.code_counts) if group.code_counts else None,
        "values": {row.value: row.positions for row in group.rows},
        "notes": list(group.notes),
        "origin": group.origin.value,
        "cite": _cite(group.cite),
        "errata": list(group.errata),
    }


def _code_counts(found: CodeCounts) -> Json:
    return {
        "positions": list(found.positions),
        "codes": [str(ref) for ref in found.codes],
        "cite": _cite(found.cite),
    }


def _table(table: Table) -> Json:
    return {
        "id": table.id,
        "kind": table.kind,
        "name": table.name,
        "columns": [{"id": c.id, "name": c.name, "unit": c.unit or None} for c in table.columns],
        "rows": [list(row) for row in table.rows],
        "connector": _connector(table.assignment) if table.assignment else None,
        "notes": list(table.notes),
        "origin": table.origin.value,
        "cite": _cite(table.cite),
        "errata": list(table.errata),
    }


def _connector(assignment: Assignment) -> Json:
    connector = assignment.connector
    return {
        "name": connector.name,
        "seen": connector.seen,
        "form": connector.form,
        "contacts": [{"number": c.number, "right": c.right, "down": c.down} for c in connector.contacts],
        "signals": {str(pin): signal for pin, signal in assignment.signals},
        "unused": list(assignment.unused),
        "cite": _cite(connector.cite),
    }


def _formula(formula: Formula) -> Json:
    return {
        "id": formula.id,
        "name": formula.name,
        "expression": formula.expression,
        "unit": formula.unit or None,
        "note": formula.note,
        "examples": [{"values": dict(e.values), "result": e.result, "cite": _cite(e.cite)} for e in formula.examples],
        "cite": _cite(formula.cite),
        "errata": list(formula.errata),
    }


def _telegrams(device: Device) -> list[Json]:
    """Layouts, services and examples of each protocol, protocols in the order of the layouts."""
    protocols = {layout.id: layout.protocol for layout in device.layouts}
    return [
        {
            "protocol": protocol,
            "layouts": [_layout(layout) for layout in device.layouts if layout.protocol == protocol],
            "services": [_service(s) for s in device.services if _protocol(s, protocols) == protocol],
            "examples": [_example(e) for e in device.examples if protocols[e.layout] == protocol],
        }
        for protocol in dict.fromkeys(protocols.values())
    ]


def _layout(layout: Layout) -> Json:
    return {
        "id": layout.id,
        "name": layout.name,
        "protocol": layout.protocol,
        "identifiers": list(layout.identifiers),
        "description": layout.description,
        "fields": _layout_fields(layout.fields, 0),
        "origin": layout.origin.value,
        "cite": _cite(layout.cite),
        "errata": list(layout.errata),
    }


def _layout_fields(fields: Sequence[Field], start: int | None) -> list[Json]:
    """Fields with their offsets, ``None`` behind one of variable length."""
    found: list[Json] = []
    offset = start
    for field in fields:
        found.append(
            {
                "name": field.name,
                "title": field.title,
                "type": field.type.value,
                "offset": offset,
                "length": field.length,
                "length_by": _sizes(field),
                "byte_order": "big" if field.big else "little",
                "constant": field.constant,
                "values": _options(field.values),
                "bits": _fields(field.bits),
                "bit_values": {name: _options(options) for name, options in field.bit_values},
                "errors": field.errors,
                "count": field.count,
                "fields": _layout_fields(field.fields, None),
                "description": field.description,
            }
        )
        fixed = isinstance(field.length, int) and field.type is not FieldType.GROUP
        offset = offset + field.length if offset is not None and fixed and isinstance(field.length, int) else None
    return found


def _sizes(field: Field) -> Json | None:
    if field.sizes is None:
        return None
    return {
        "by": field.sizes.by,
        "sizes": {str(value): size for value, size in field.sizes.sizes},
        "times": field.sizes.times,
        "fills": field.sizes.fills,
    }


def _protocol(service: Service, protocols: Mapping[str, str]) -> str:
    layouts = [telegram.layout for telegram in service.messages]
    names = [layout if isinstance(layout, str) else str(layout.cases[0][1]) for layout in layouts]
    return next((protocols[name] for name in names), "")


def _service(service: Service) -> Json:
    return {
        "id": service.id,
        "name": service.name,
        "does": service.does.value,
        "reaches": list(service.reaches),
        "request": message(service.request) if service.request else None,
        "answer": message(service.answer) if service.answer else None,
        "errors": service.errors,
        "limit": service.limit,
        "description": service.description,
        "origin": service.origin.value,
        "cite": _cite(service.cite),
        "errata": list(service.errata),
    }


def message(telegram: Message) -> Json:
    """A telegram of a service, its fillings in the notation of spec."""
    return {
        "identifier": telegram.identifier,
        "layout": _filling(telegram.layout),
        "values": _fillings(telegram.values),
    }


def _fillings(fillings: Fillings) -> Json:
    return {name: _filling(filling) for name, filling in fillings}


def _filling(filling: Filling) -> object:
    match filling:
        case Filler():
            return str(filling)
        case Choice():
            others = {} if filling.otherwise is None else {"else": _filling(filling.otherwise)}
            return {key: _filling(inner) for key, inner in filling.cases} | others
        case tuple():
            return [_fillings(entry) for entry in filling]
        case _:
            return filling


def _example(example: Example) -> Json:
    return {
        "id": example.id,
        "name": example.name,
        "layout": example.layout,
        "direction": example.direction,
        "sequence": example.sequence,
        "node": example.node,
        "identifier": example.identifier,
        "bytes": list(example.data),
        "printed": list(example.printed),
        "values": _values(example.values),
        "meaning": example.meaning,
        "cite": _cite(example.cite),
        "errata": list(example.errata),
    }


def _values(values: Values) -> Json:
    return {k: [_values(v) for v in value] if isinstance(value, tuple) else value for k, value in values.items()}


def _gsd(gsd: Gsd) -> Json:
    return {
        "file": gsd.stem,
        "languages": dict(gsd.suffixes),
        "cite": _cite(gsd.cite),
        "keywords": [
            {"keyword": keyword.name, "value": _wording(keyword.value), **_source(keyword.source)}
            for keyword in gsd.keywords
        ],
        "bit_rates": [{"bit_rate": rate.name, "max_tsdr": rate.max_tsdr} for rate in gsd.bit_rates],
        "bit_rates_cite": _cite(gsd.bit_rates_cite),
        "max_tsdr": _source(gsd.max_tsdr),
        "user_parameters": {"bytes": list(gsd.parameters), **_source(gsd.parameters_source)},
        "modules": [_module(module) for module in gsd.modules],
        "diagnosis": _diagnosis(gsd.diagnosis) if gsd.diagnosis else None,
    }


def _wording(value: int | Wording) -> int | Json:
    return {"en": value.english, "de": value.german} if isinstance(value, Wording) else value


def _source(source: Source) -> Json:
    return {
        "origin": source.origin.value,
        "cite": _cite(source.cite) if source.cite else None,
        "note": source.note or None,
        "errata": list(source.errata),
    }


def _module(module: Module) -> Json:
    return {
        "reference": module.reference,
        "family": module.family,
        "name": _wording(module.name),
        "printed": module.printed,
        "info": _wording(module.info) if module.info else None,
        "channel_words": module.channel,
        "words": module.words,
        "consistency": module.consistency.value,
        **_source(module.source),
    }


def _diagnosis(diagnosis: Diagnosis) -> Json:
    return {
        "status_type": diagnosis.type,
        "cite": _cite(diagnosis.cite),
        "areas": [
            {
                "id": area.id,
                "field": area.field,
                "first_bit": area.first,
                "last_bit": area.last,
                "texts": {str(value): _wording(wording) for value, wording in area.texts},
                **_source(area.source),
            }
            for area in diagnosis.areas
        ],
    }


def _erratum(erratum: Erratum) -> Json:
    places: list[Json] = [
        {"where": p.location, "page": p.page, "manual": p.manual, "printed": p.printed} for p in erratum.places
    ]
    if not places:
        where = " ".join(erratum.place)
        places = [{"where": where, "page": None, "manual": None, "printed": erratum.printed_text}]
    return {
        "id": erratum.id,
        "kind": erratum.kind,
        "rule": erratum.rule,
        "about": list(erratum.about_text),
        "places": places,
        "used": erratum.used_text,
        "why": erratum.why,
        "confidence": erratum.confidence,
        "origin": erratum.origin,
    }
