"""The module of a base drive: responses, parts, commands, fields of the error number."""

from collections.abc import Sequence

from generator.emit.environment import render
from generator.emit.rust import facts, lists, words
from generator.emit.rust.notice import notice
from generator.emit.rust.syntax import constant_name, declaration, doc, markdown, string
from generator.emit.rust.views import Record, Selection, Variant
from generator.model import Drive, DriveCommand, DriveModule, Model, Option, Response
from generator.naming import Scope, safe, snake

_Entry = Response | DriveModule | DriveCommand


def drive_module(drive: Drive) -> str:
    """Name of the module of a drive."""
    return safe(snake(drive.id), "rust")


def drive_file(model: Model, drive: Drive) -> str:
    """Text of the module.

    Raises:
        EmitError: Two facts want one name.
    """
    entries: list[_Entry] = [*drive.responses, *drive.modules, *drive.commands]
    cites = [*drive.index_base_cites, drive.error_fields_cite, *(entry.cite for entry in entries)]
    cited = {cite.manual for cite in cites}
    selections = [
        _selection(
            "Response", "Response to an error, in error numbers and in selection lists.", drive, drive.responses
        ),
        _selection("Module", "Part of the drive that an error number names.", drive, drive.modules),
        _selection("Command", "Device command.", drive, drive.commands),
    ]
    scope = Scope(f"constants of {drive_module(drive)}")
    field_names = tuple(scope.add(constant_name(snake("error", name)), drive.where) for name, _ in drive.error_fields)
    return render(
        "rust/drive.rs.j2",
        notice=notice(model, [manual for manual in model.manuals if manual.id in cited]),
        title=markdown(drive.title),
        selections=[selection for selection in selections if selection.variants],
        fields=[
            Record(
                constant,
                doc(
                    [f"Field {markdown(name)} of an error number, bits {field.low} ... {field.high}."],
                    [words.source(drive.error_fields_cite, drive.error_fields_origin)],
                ),
                declaration(constant, "BitField", facts.bit_field(field)),
            )
            for constant, (name, field) in zip(field_names, drive.error_fields, strict=True)
        ],
        accessors=[
            (safe(snake(name), "rust"), f"with_{snake(name)}", constant)
            for constant, (name, _) in zip(field_names, drive.error_fields, strict=True)
        ],
        record=declaration("DRIVE", "Drive", facts.drive(drive, field_names)),
    )


def _selection(name: str, comment: str, drive: Drive, entries: Sequence[_Entry]) -> Selection:
    variants = lists.variants([Option(entry.value, entry.name) for entry in entries], name, drive.where)
    return Selection(
        name,
        doc([comment], indent=4),
        "u32",
        tuple(
            Variant(_variant_doc(entry), variant, str(entry.value), string(entry.name))
            for variant, entry in zip(variants, entries, strict=True)
        ),
    )


def _variant_doc(entry: _Entry) -> str:
    aliases = ", ".join(entry.aliases) if isinstance(entry, Response) else ""
    also = f"Also called: {markdown(aliases)}" if aliases else ""
    return doc([f"{entry.value}: {markdown(entry.name)}."], [also, words.source(entry.cite, entry.origin)], indent=8)
