"""The files of a spec folder: which there are, of which kind, read and validated."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from generator.diagnostics import Problems, suggestion
from generator.load import read
from generator.model import Where
from generator.schema import Schemas
from generator.tree import SourceFile

_DEVICE_KINDS = (
    "device",
    "codes",
    "objects",
    "errors",
    "indicators",
    "switches",
    "tables",
    "telegrams",
    "gsd",
    "errata",
)
_DRIVE_KINDS = ("drive", "codes")
_KINDS = ("release", "names", "manual", "standard", *_DRIVE_KINDS, *_DEVICE_KINDS)


@dataclass(slots=True)
class Spec:
    """Loaded files by kind and name."""

    release: SourceFile | None = None
    names: SourceFile | None = None
    manuals: list[SourceFile] = field(default_factory=list)
    standards: list[SourceFile] = field(default_factory=list)
    drives: dict[str, dict[str, SourceFile]] = field(default_factory=dict)
    devices: dict[str, dict[str, SourceFile]] = field(default_factory=dict)

    @property
    def files(self) -> Iterator[SourceFile]:
        """Every file with facts."""
        yield from (*self.manuals, *self.standards)
        for folder in (*self.drives.values(), *self.devices.values()):
            yield from folder.values()


def inputs(folder: Path) -> list[Path]:
    """Every YAML file of a spec folder, schemas included, in order."""
    return sorted(folder.rglob("*.yaml"))


def load(folder: Path, label: str, problems: Problems) -> Spec:
    """Read and validate a spec folder; ``label`` is its name in messages.

    Raises:
        DiagnosticsError: A file cannot be read, is misplaced or does not fit its schema.
    """
    schemas = Schemas(folder / "schema", f"{label}/schema", _KINDS, problems)
    spec = Spec()
    for path in inputs(folder):
        parts = path.relative_to(folder).parts
        if parts[0] == "schema":
            continue
        name = "/".join((label, *parts))
        kind = _kind(parts)
        if kind is None:
            _refuse(parts, name, problems)
            continue
        data = read(path, name, problems)
        if data is not None:
            before = len(problems.found)
            schemas.check(kind, data, name, problems)
            if len(problems.found) == before:
                _file(spec, parts, SourceFile(name, kind, _stem(parts), data, problems))
    _require(spec, label, problems)
    problems.stop()
    return spec


def _kind(parts: tuple[str, ...]) -> str | None:
    stem = parts[-1].removesuffix(".yaml")
    match parts:
        case ("release.yaml",):
            return "release"
        case ("names.yaml",):
            return "names"
        case ("manuals", _):
            return "manual"
        case ("standards", _):
            return "standard"
        case ("drives", _, _) if stem in _DRIVE_KINDS:
            return stem
        case ("devices", _, _) if stem in _DEVICE_KINDS:
            return stem
    return None


def _stem(parts: tuple[str, ...]) -> str:
    return parts[1] if parts[0] in ("drives", "devices") else parts[-1].removesuffix(".yaml")


def _refuse(parts: tuple[str, ...], name: str, problems: Problems) -> None:
    known = {"drives": _DRIVE_KINDS, "devices": _DEVICE_KINDS}.get(parts[0], ())
    hint = (
        suggestion(parts[-1], [f"{kind}.yaml" for kind in known], "files here")
        if known and len(parts) == 3
        else "files stand in spec/, spec/manuals, spec/standards, spec/drives/<drive> or spec/devices/<device>"
    )
    problems.add("file-unknown", Where(name, 1, 1), f"'{parts[-1]}' is of no known kind here", hint=hint)


def _file(spec: Spec, parts: tuple[str, ...], file: SourceFile) -> None:
    match parts[0]:
        case "manuals":
            spec.manuals.append(file)
        case "standards":
            spec.standards.append(file)
        case "drives":
            spec.drives.setdefault(file.stem, {})[file.kind] = file
        case "devices":
            spec.devices.setdefault(file.stem, {})[file.kind] = file
        case "names.yaml":
            spec.names = file
        case _:
            spec.release = file


def _require(spec: Spec, label: str, problems: Problems) -> None:
    if problems.found:
        return
    if spec.release is None:
        problems.add("file-missing", Where(f"{label}/release.yaml", 1, 1), "the release of the spec is missing")
    for kind, folders in (("drive", spec.drives), ("device", spec.devices)):
        for name, files in folders.items():
            if kind not in files:
                where = Where(f"{label}/{kind}s/{name}/{kind}.yaml", 1, 1)
                problems.add("file-missing", where, f"the {kind} '{name}' has no {kind}.yaml")
