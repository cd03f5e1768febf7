"""The modules of one device: codes, selection lists, masks, objects, errors, LEDs, switches, telegrams, errata."""

from collections import Counter
from collections.abc import Iterable, Sequence

from generator.emit import names
from generator.emit.environment import render
from generator.emit.hashing import PerfectHash, perfect_hash
from generator.emit.rust import facts, lists, words
from generator.emit.rust.drive import drive_module
from generator.emit.rust.notice import notice
from generator.emit.rust.numbers import numbered
from generator.emit.rust.syntax import (
    Expression,
    Group,
    array,
    boolean,
    brief,
    constant_name,
    declaration,
    difference,
    doc,
    hexadecimal,
    markdown,
    numbers,
    some,
    string,
    struct,
)
from generator.emit.rust.telegrams import Telegrams
from generator.emit.rust.vectors import fuzz_file, vector_file
from generator.emit.rust.views import Error, Module, Record
from generator.model import Code, Device, DictionaryObject, Erratum, ErrorEntry, Model, SubIndex
from generator.naming import Scope

_DEVICE_ERRORS = "device"


class DeviceFiles:
    """Files of one device; the names of enums and masks are settled first, for records and comments refer to them."""

    def __init__(self, model: Model, device: Device, module: str) -> None:
        """Settle the names; ``module`` is the name of the device's module.

        Raises:
            EmitError: Two facts want one name.
        """
        self.device = device
        self.module = Module(
            module, markdown(device.title), markdown(f"{device.manual.title}, edition {device.manual.edition}")
        )
        self._notice = notice(model, [device.manual])
        found = lists.places(device)
        self.selections = lists.selections(found, Scope(f"selection lists of {module}"))
        self._masks = lists.masks(found, Scope(f"bit masks of {module}"))
        self.error_tables = _error_tables(device)
        self.telegrams = Telegrams(device)

    def render(self) -> dict[str, str]:
        """Files by their path in the crate; a device has no module for what it lacks.

        Raises:
            EmitError: Two facts want one name, or codes break the rule of the index.
        """
        device, folder = self.device, f"src/{self.module.name}"
        files: dict[str, str] = {}
        if device.codes:
            files["codes"] = self._codes()
        if self.selections:
            files["selections"] = self._fill(
                "selections", subject="Selection lists", selections=list(dict.fromkeys(self.selections.values()))
            )
        if self._masks:
            files["bits"] = self._fill("bits", modules=list(dict.fromkeys(self._masks.values())))
        if device.objects:
            files["objects"] = self._objects()
        if device.errors:
            files["errors"] = self._fill("errors", kinds=sorted(self.error_tables))
        if tables_of_numbers := numbered(device):
            files["numbers"] = self._fill(
                "selections", subject="States, commands and data types", selections=tables_of_numbers
            )
        if device.indicators:
            tables = array(map(facts.indicator, device.indicators))
            files["indicators"] = self._fill("indicators", tables=declaration("TABLES", "&[IndicatorTable]", tables))
        if device.switches:
            groups = array(map(facts.switches, device.switches))
            files["switches"] = self._fill("switches", groups=declaration("GROUPS", "&[SwitchGroup]", groups))
        if device.layouts:
            files["telegrams"] = self._fill(
                "telegrams", used=self.telegrams.used, structs=self.telegrams.structs, sizes=self.telegrams.sizes
            )
        if device.errata:
            files["errata"] = self._errata()
        return {
            f"{folder}.rs": self._device(sorted(files)),
            **{f"{folder}/{part}.rs": text for part, text in files.items()},
            **{f"{folder}/errors/{kind}.rs": self._error_kind(kind) for kind in self.error_tables},
            **(self._tests() if device.layouts else {}),
        }

    def error_mask(self, kind: str) -> int:
        """Bits of an error number of that kind that tell which error it is."""
        return (self.device.error_mask if kind == _DEVICE_ERRORS else 0) or 0xFFFF_FFFF

    def _fill(self, template: str, **view: object) -> str:
        return render(f"rust/{template}.rs.j2", notice=self._notice, title=self.module.title, **view)

    def _tests(self) -> dict[str, str]:
        name = self.module.name
        return {
            f"tests/{name}.rs": vector_file(self.device, name, self.module.title, self._notice),
            f"fuzz/fuzz_targets/{name}.rs": fuzz_file(self.device, name, self._notice),
        }

    def _device(self, parts: Sequence[str]) -> str:
        comment = doc([words.headline(self.device.title)], words.device_points(self.device, self.module.manual), "//!")
        return self._fill("device", doc=comment, parts=parts, record=declaration("DEVICE", "Device", self._record()))

    def _record(self) -> Group:
        device = self.device
        return struct(
            "Device",
            [
                ("id", string(device.id)),
                ("title", string(device.title)),
                ("manufacturer", string(device.manufacturer)),
                ("order_code", string(device.order_code)),
                ("manual", facts.manual(device.manual)),
                ("bus", string(device.bus)),
                ("drive", some(f"crate::drives::{drive_module(device.drive)}::DRIVE" if device.drive else None)),
                ("hardware_version", facts.text(device.hardware_version)),
                ("software_version", facts.text(device.software_version)),
                ("slots", array(map(facts.slot, device.slots))),
                ("can_open", some(facts.can_open(device.canopen) if device.canopen else None)),
                ("codes", "codes::TABLE" if device.codes else "CodeTable::EMPTY"),
                ("objects", "objects::TABLE" if device.objects else "ObjectTable::EMPTY"),
                ("errors", array(f"errors::{kind}::TABLE" for kind in self.error_tables)),
                ("indicators", "indicators::TABLES" if device.indicators else "&[]"),
                ("switches", "switches::GROUPS" if device.switches else "&[]"),
                ("errata", "errata::TABLE" if device.errata else "&[]"),
            ],
        )

    def _choices(self, key: lists.Key) -> str:
        selection = self.selections.get(key)
        return f"selections::{selection.name}::CHOICES" if selection else "&[]"

    def _bits(self, key: lists.Key) -> list[tuple[str, Expression]]:
        masks = self._masks.get(key)
        return [
            ("bits", f"bits::{masks.name}::BITS" if masks and masks.bits else "&[]"),
            ("fields", f"bits::{masks.name}::FIELDS" if masks and masks.fields else "&[]"),
        ]

    def _links(self, key: lists.Key) -> str:
        selection, masks = self.selections.get(key), self._masks.get(key)
        links = [
            f"values [`{selection.name}`](super::selections::{selection.name})" if selection else "",
            f"bits [`{masks.name}`](super::bits::{masks.name})" if masks else "",
        ]
        return "; ".join(link for link in links if link)

    def _explained(self, ids: Iterable[str]) -> list[Erratum]:
        wanted = frozenset(ids)
        return [erratum for erratum in self.device.errata if erratum.id in wanted]

    def _codes(self) -> str:
        codes = {code.number: code for code in self.device.codes}
        fields = {number: self._code_fields(code) for number, code in codes.items()}
        scope = Scope(f"codes of {self.module.name}")
        constants = {n: scope.add(constant_name(names.code_name(code)), code.where) for n, code in codes.items()}
        views = []
        for number, code in codes.items():
            name, twin = constants[number], code.twin_of
            record = brief("Code", fields[number])
            if twin != number and twin in codes:
                record = difference("Code", fields[number], constants[twin], dict(fields[twin]))
            views.append(Record(name, self._code_doc(code), declaration(name, "Code", record)))
        return self._fill(
            "codes",
            codes=views,
            entries=_private("ENTRIES", "&[Code]", constants.values()),
            lists=_list_modules(views),
            index_base=hexadecimal(_index_base(self.device.codes), 4),
        )

    def _code_fields(self, code: Code) -> list[tuple[str, Expression]]:
        digits = _digits(code)
        subcodes = array(
            brief(
                "SubCode",
                [
                    ("number", str(sub.number)),
                    ("name", string(sub.name)),
                    ("default", facts.default(sub.default, digits)),
                    ("follows", some(facts.node_relative(sub.follows) if sub.follows else None)),
                    ("choices", self._choices((code.designation, sub.number))),
                ],
            )
            for sub in code.subcodes
        )
        return [
            ("number", str(code.number)),
            ("slot", facts.text(code.slot)),
            ("twin_of", str(code.twin_of)),
            ("name", string(code.name)),
            ("index", hexadecimal(code.index, 4)),
            ("type_name", string(code.type_name)),
            ("data_type", facts.data_type(code.data_type)),
            ("length", facts.number(code.length)),
            ("access", facts.access(code.access)),
            ("scaling", facts.number(code.scaling)),
            ("range", facts.wire_range(code.range, code.scaling, digits)),
            ("default", facts.default(code.default, digits)),
            ("choices", self._choices((code.designation, None))),
            *self._bits((code.designation, None)),
            ("subcodes", subcodes),
            ("objects", array(map(facts.object_ref, code.objects))),
            ("since", facts.text(code.since)),
            ("internal", boolean(code.internal)),
            ("shared_by", facts.text(code.shared_by)),
            ("origin", facts.origin(code.origin)),
            ("cite", facts.cite(code.cite)),
            ("errata", facts.texts(code.errata)),
        ]

    def _code_doc(self, code: Code) -> str:
        digits = _digits(code)
        subcodes = words.runs(
            "Subcode",
            (
                (sub.number, words.subcode_point(code, sub, digits, self._links((code.designation, sub.number))))
                for sub in code.subcodes
            ),
        )
        links = self._links((code.designation, None))
        points = words.code_points(code, digits, links, subcodes, self._explained(code.errata))
        slot = f" in slot {code.slot}" if code.slot else ""
        return doc([words.headline(f"{code.designation}{slot}: {code.name}"), markdown(code.description)], points)

    def _objects(self) -> str:
        scope = Scope(f"objects of {self.module.name}")
        kinds = list(facts.OBJECT_KINDS)
        views = []
        for entry in sorted(self.device.objects, key=lambda entry: (kinds.index(entry.kind), entry.index)):
            name = scope.add(constant_name(names.object_name(entry)), entry.where)
            views.append(Record(name, self._object_doc(entry), declaration(name, "Object", self._object_record(entry))))
        entries = _private("ENTRIES", "&[Object]", (view.name for view in views))
        return self._fill("objects", objects=views, entries=entries, lists=_list_modules(views))

    def _object_record(self, entry: DictionaryObject) -> Group:
        return struct(
            "Object",
            [
                ("kind", f"ObjectKind::{facts.OBJECT_KINDS[entry.kind]}"),
                ("index", hexadecimal(entry.index, 4) if entry.kind == "canopen" else str(entry.index)),
                ("name", string(entry.name)),
                ("object_type", f"ObjectType::{facts.OBJECT_TYPES[entry.object_type]}"),
                ("subindexes", array(self._subindex(entry, sub) for sub in entry.subindexes)),
                ("origin", facts.origin(entry.origin)),
                ("cite", facts.cite(entry.cite)),
                ("errata", facts.texts(entry.errata)),
            ],
        )

    def _subindex(self, entry: DictionaryObject, sub: SubIndex) -> Group:
        return brief(
            "SubIndex",
            [
                ("number", str(sub.number)),
                ("name", string(sub.name)),
                ("data_type", facts.data_type(sub.data_type)),
                ("access", f"EntryAccess::{facts.ENTRY_ACCESSES[sub.access]}"),
                ("default", facts.default(sub.default, 0)),
                ("range", facts.wire_range(sub.range, None, 0)),
                ("choices", self._choices((entry.designation, sub.number))),
                *self._bits((entry.designation, sub.number)),
                ("codes", array(map(facts.code_ref, sub.codes))),
                ("signature", facts.text(sub.signature)),
                ("pdo_mapping", boolean(sub.pdo_mapping)),
                ("unused", boolean(sub.unused)),
                ("abort", facts.number(sub.abort, 8)),
                ("errata", facts.texts(sub.errata)),
            ],
        )

    def _object_doc(self, entry: DictionaryObject) -> str:
        subindexes = words.runs(
            "Sub-index",
            (
                (sub.number, words.subindex_point(sub, self._links((entry.designation, sub.number))))
                for sub in entry.subindexes
            ),
        )
        errata = self._explained([*entry.errata, *(erratum for sub in entry.subindexes for erratum in sub.errata)])
        points = words.object_points(entry, subindexes, errata)
        return doc([words.headline(f"{entry.designation}: {entry.name}"), markdown(entry.description)], points)

    def _error_kind(self, kind: str) -> str:
        errors = self.error_tables[kind]
        digits = self.device.error_bits(kind) // 4
        scope = Scope(f"errors of kind {kind} of {self.module.name}")
        for name in ("TABLE", "ENTRIES", "HELP", "INDEX", "PLACES", "SEEDS"):
            scope.add(name, self.device.where)
        named = list(zip(error_names(errors), errors, strict=True))
        for name, error in named:
            scope.add(name, error.where)
            if error.count > 1:
                scope.add(f"{name}_LAST", error.where)
        index = perfect_hash([(error.number, error.last) for error in errors])
        return self._fill(
            "error_kind",
            kind=kind,
            errors=[self._error(error, name, digits) for name, error in named],
            entries=_private("ENTRIES", "&[ErrorEntry]", (_error_record(error, name) for name, error in named)),
            help=_private("HELP", "&[Help]", map(facts.help_texts, errors)),
            mask=hexadecimal(self.error_mask(kind), 8),
            seeds=numbers(index.seeds) if index.seeds else "",
            places=numbers(index.places),
            index=declaration("INDEX", "ErrorIndex", _index(index), visibility=""),
        )

    def _error(self, error: ErrorEntry, name: str, digits: int) -> Error:
        points = words.error_points(error, digits, self._explained(error.errata))
        return Error(
            name=name,
            doc=doc([words.headline(error.name), markdown(error.description)], points),
            number=hexadecimal(error.number, digits),
            last=hexadecimal(error.last, digits) if error.count > 1 else "",
        )

    def _errata(self) -> str:
        entries = sorted(self.device.errata, key=lambda erratum: erratum.id)
        return self._fill("errata", table=declaration("TABLE", "&[Erratum]", array(map(facts.erratum, entries))))


def _digits(code: Code) -> int:
    """Hexadecimal digits of the code's values, 0 where they are written as decimal numbers."""
    return code.data_type.bits // 4 if code.is_bitfield else 0


def _index(index: PerfectHash) -> Expression:
    return struct(
        "ErrorIndex",
        (
            ("first", "None" if index.first is None else some(hexadecimal(index.first, 8))),
            ("factor", hexadecimal(index.factor, 8)),
            ("shift", str(index.shift)),
            ("seed_shift", str(index.seed_shift)),
            ("seeds", "SEEDS" if index.seeds else "&[]"),
            ("places", "PLACES"),
            ("long", array(map(str, index.long))),
        ),
    )


def _private(name: str, kind: str, items: Iterable[Expression]) -> str:
    return declaration(name, kind, array(items), visibility="")


def _error_record(error: ErrorEntry, name: str) -> Expression:
    return brief(
        "ErrorEntry",
        [
            ("number", name),
            ("last", f"{name}_LAST" if error.count > 1 else name),
            ("slot", facts.text(error.slot)),
            ("name", string(error.name)),
            ("response", facts.text(error.response)),
            ("responses", facts.texts(error.responses)),
            ("adjustable_in", array(map(facts.code_ref, error.adjustable_in))),
            ("register", facts.text(error.register)),
            ("origin", facts.origin(error.origin)),
            ("cite", facts.cite(error.cite)),
            ("errata", facts.texts(error.errata)),
        ],
    )


def _list_modules(records: Sequence[Record]) -> str:
    """Modules of lists that the records refer to, as an import names them: "", "bits" or "{bits, selections}"."""
    used = [name for name in ("bits", "selections") if any(f"{name}::" in record.item for record in records)]
    return f"{{{', '.join(used)}}}" if len(used) > 1 else "".join(used)


def _index_base(codes: Sequence[Code]) -> int:
    base = codes[0].index + codes[0].number
    assert all(code.index + code.number == base for code in codes)
    return base


def _error_tables(device: Device) -> dict[str, list[ErrorEntry]]:
    tables: dict[str, list[ErrorEntry]] = {}
    for error in sorted(device.errors, key=lambda error: (error.kind, error.number)):
        tables.setdefault(error.kind, []).append(error)
    return tables


def error_names(errors: Sequence[ErrorEntry]) -> list[str]:
    """Names of constants; the number is appended to a designation that stands more than once."""
    plain = [names.error_name(error) for error in errors]
    counts = Counter(plain)
    return [
        constant_name(f"{name}_{error.number:x}" if counts[name] > 1 or not name else name)
        for name, error in zip(plain, errors, strict=True)
    ]
