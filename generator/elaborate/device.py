"""Devices and base drives."""

from collections.abc import Mapping

from generator.diagnostics import suggestion
from generator.elaborate import codes as code_table
from generator.elaborate import errata as ledger
from generator.elaborate import errors as error_table
from generator.elaborate import gsd as gsd_file
from generator.elaborate import indicators as panel
from generator.elaborate import objects as object_table
from generator.elaborate import services as service_table
from generator.elaborate import telegrams as telegram_table
from generator.elaborate.common import bounds, is_within, known_manual, optional_text, origin
from generator.elaborate.manuals import Standards, object_run
from generator.model import (
    BitField,
    CanOpenFacts,
    CodeRef,
    Device,
    Drive,
    DriveCommand,
    DriveModule,
    ErrorRef,
    Manual,
    ObjectRef,
    Response,
    Slot,
)
from generator.tree import Node, SourceFile

NO_INDEX_BASE = 0
"""Index base of devices without codes."""
HIGHEST_ERROR_BIT = 31
"""Last bit of an error number."""


def drive(file: SourceFile) -> Drive:
    """A base drive of spec/drives."""
    root = file.root
    _check_folder(root, "drive", file.stem)
    base = root.child("index_base")
    number = root.child("error_number")
    written = root.child("command_code")
    assert base is not None and number is not None
    layout = number.child("fields")
    assert layout is not None
    reported = number.texts("reported")
    for name in reported:
        if name not in layout.data:
            hint = suggestion(name, list(layout.data), "fields")
            number.problems.add("name-unknown", number.at("reported"), f"there is no field '{name}'", hint=hint)
    return Drive(
        id=file.stem,
        title=str(root.get("title")),
        manufacturer=str(root.get("manufacturer")),
        index_base=int(base.get("value")),
        index_base_cites=base.cites("cites"),
        responses=tuple(
            Response(
                value=int(node.get("value")),
                name=str(node.get("name")),
                aliases=node.texts("aliases"),
                origin=origin(node),
                cite=node.cite(),
            )
            for node in root.items("responses")
        ),
        error_fields=tuple(
            (name, BitField(*bounds(run), name))
            for name, run in layout.data.items()
            if is_within(run, HIGHEST_ERROR_BIT, layout, layout.at(name))
        ),
        reported_fields=reported,
        error_fields_origin=origin(number),
        error_fields_cite=number.cite(),
        modules=tuple(
            DriveModule(value=int(n.get("value")), name=str(n.get("name")), origin=origin(n), cite=n.cite())
            for n in root.items("modules")
        ),
        command_code=int(str(written.get("code"))[1:]) if written else None,
        command_code_cites=written.cites("cites") if written else (),
        commands=tuple(
            DriveCommand(value=int(n.get("value")), name=str(n.get("name")), origin=origin(n), cite=n.cite())
            for n in root.items("commands")
        ),
        where=root.where,
    )


def device(
    files: Mapping[str, SourceFile],
    manuals: dict[str, Manual],
    drives: Mapping[str, Drive],
    shared: Mapping[str, Mapping[str, Node]],
    standards: Standards,
) -> Device | None:
    """A device of spec/devices, ``None`` where its manual or drive is unknown."""
    root = files["device"].root
    _check_folder(root, "device", files["device"].stem)
    name = str(root.get("manual"))
    for file in files.values():
        known_manual(file.manual, file.root, "manual", manuals)
    base = _drive(root, drives)
    if name not in manuals or ("drive" in root and base is None):
        return None
    slots = _slots(root)
    if slots is None:
        return None
    attributes = root.cite("attributes") if "attributes" in root else None
    subjects = _subjects(files, slots)
    resolve = ledger.resolver(*subjects)
    entries = ledger.errata(files["errata"].root, manuals, resolve) if "errata" in files else ()
    index = code_table.ErrataIndex({e.id: e.about for e in entries})
    frame = code_table.Frame(
        slots,
        base.index_base if base else NO_INDEX_BASE,
        base.id if base else None,
        shared.get(base.id, {}) if base else {},
        attributes,
    )
    codes = code_table.codes(files["codes"].root, frame, index) if "codes" in files else ()
    known = {CodeRef(c.number, s.number) for c in codes for s in c.subcodes} | {c.ref for c in codes}
    error_frame = error_table.Frame(slots, base, known, index)
    roots = {kind: file.root for kind, file in files.items()}
    layouts = telegram_table.layouts(roots["telegrams"], standards.cob_ids, index) if "telegrams" in roots else ()
    tables = panel.tables(roots["tables"], index, standards.connectors) if "tables" in roots else ()
    service_frame = service_table.Frame(layouts, tables, standards.cob_ids, index)
    version = root.child("version")
    return Device(
        id=files["device"].stem,
        title=str(root.get("title")),
        manufacturer=str(root.get("manufacturer")),
        order_code=str(root.get("order_code")),
        manual=manuals[name],
        bus=str(root.get("bus")),
        drive=base,
        hardware_version=optional_text(version, "hardware") if version else None,
        software_version=optional_text(version, "software") if version else None,
        cite=root.cite(),
        slots=slots,
        canopen=_canopen(root, standards.node_addresses),
        gsd=gsd_file.gsd(roots["gsd"], base, [entry.id for entry in entries], standards.telegrams)
        if "gsd" in roots
        else None,
        attributes=attributes,
        codes=codes,
        objects=object_table.objects(files["objects"].root, object_table.Frame(standards.objects, slots, index))
        if "objects" in files
        else (),
        errors=error_table.errors(files["errors"].root, error_frame) if "errors" in files else (),
        indicators=panel.indicators(roots["indicators"], index) if "indicators" in roots else (),
        switches=panel.switches(roots["switches"], index) if "switches" in roots else (),
        tables=tables,
        formulas=panel.formulas(roots["tables"], index) if "tables" in roots else (),
        layouts=layouts,
        services=service_table.services(roots["telegrams"], service_frame) if "telegrams" in roots else (),
        examples=(
            telegram_table.examples(roots["telegrams"], {layout.id: layout for layout in layouts}, index)
            if "telegrams" in roots
            else ()
        ),
        errata=entries,
        where=root.where,
    )


def _check_folder(root: Node, key: str, folder: str) -> None:
    if root.get(key) != folder:
        root.problems.add(
            "folder-name",
            root.at(key),
            f"the {key} '{root.get(key)}' stands in the folder {folder}",
            hint=f"rename the folder to {root.get(key)}",
        )


def _drive(root: Node, drives: Mapping[str, Drive]) -> Drive | None:
    name = root.get("drive")
    if name is None:
        return None
    if name not in drives:
        hint = suggestion(str(name), list(drives), "drives")
        root.problems.add("name-unknown", root.at("drive"), f"there is no drive '{name}'", hint=hint)
    return drives.get(name)


def _slots(root: Node) -> tuple[Slot, ...] | None:
    """Slots of a device, ``None`` where their runs of codes are wrong: whatever stands in them would be, too."""
    found: list[Slot] = []
    good = True
    for name, node in root.children("slots"):
        first, last = (int(end[1:]) for end in str(node.get("codes")).split(" ... "))
        if last < first:
            good = False
            node.problems.add(
                "run-order", node.at("codes"), "the run does not ascend", hint="write the lower code first"
            )
        for other in found:
            if first <= other.last_code and other.first_code <= last:
                good = False
                node.problems.add(
                    "run-order",
                    node.at("codes"),
                    f"the codes of {name} overlap those of {other.name}",
                    compared=[(f"codes of {other.name}", f"C{other.first_code:05d} ... C{other.last_code:05d}")],
                    hint="a code belongs to one slot",
                )
        found.append(
            Slot(
                name=name,
                first_code=first,
                last_code=last,
                code_offset=int(node.get("code_offset", 0)),
                error_offset=int(node.get("error_offset", 0)),
                chapter=node.chapter("chapter"),
            )
        )
    return tuple(found) if good else None


def _canopen(root: Node, addresses: range) -> CanOpenFacts | None:
    node = root.child("canopen")
    if node is None:
        return None
    if not addresses:
        message = "no standard says which addresses a CANopen node can have"
        root.problems.add("key-missing", node.where, message, hint="add 'node_addresses:' to a file of spec/standards")
    code = node.get("node_address")
    return CanOpenFacts(
        baud_rates=tuple(node.get("baud_rates")),
        granularity=int(node.get("granularity")),
        node_address=int(code[1:]) if code else None,
        node_addresses=addresses,
        boot_up_master=bool(node.get("boot_up_master", False)),
        cite=node.cite(),
        where=node.at("node_address"),
    )


def _subjects(
    files: Mapping[str, SourceFile], slots: tuple[Slot, ...]
) -> tuple[list[CodeRef], list[ObjectRef], list[ErrorRef]]:
    """What the ledger can name: codes and errors in every slot, objects."""
    offsets = {slot.name: slot for slot in slots}
    codes: list[CodeRef] = []
    objects: list[ObjectRef] = []
    errors: list[ErrorRef] = []
    if "codes" in files:
        for node in files["codes"].root.items("codes"):
            for name, _ in node.children("printed"):
                offset = offsets[name].code_offset if name in offsets else 0
                codes.append(CodeRef(int(str(node.get("code"))[1:]) + offset))
    if "objects" in files:
        for node in files["objects"].root.items("objects"):
            first, last = object_run(node)
            objects.extend(ObjectRef(index) for index in range(first, last + 1))
    if "errors" in files:
        for node in files["errors"].root.items("errors"):
            number, _ = error_table.number(node)
            for name in dict(node.children("printed")) or ("",):
                offset = offsets[name].error_offset if name in offsets else 0
                errors.append(ErrorRef(str(node.get("kind")), number + offset))
    return codes, objects, errors
