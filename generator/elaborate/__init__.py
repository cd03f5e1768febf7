"""From loaded files to the model: notations read, runs and slots expanded, references resolved by name."""

from generator.diagnostics import Problems
from generator.elaborate.codes import shared_codes
from generator.elaborate.device import device, drive
from generator.elaborate.manuals import manual, standards
from generator.elaborate.pins import pins
from generator.model import Model
from generator.spec import Spec


def elaborate(spec: Spec, problems: Problems) -> Model:
    """The model of a spec.

    Raises:
        DiagnosticsError: A notation, name or run is wrong; all such problems at once.
    """
    manuals = {m.id: m for m in (manual(file) for file in spec.manuals)}
    common = standards(spec.standards, manuals)
    drives = {name: drive(files["drive"]) for name, files in spec.drives.items()}
    shared = {name: shared_codes(files["codes"].root) for name, files in spec.drives.items() if "codes" in files}
    devices = [device(files, manuals, drives, shared, common) for _, files in sorted(spec.devices.items())]
    problems.stop()
    assert spec.release is not None
    return Model(
        version=str(spec.release.data["version"]),
        date=str(spec.release.data["date"]),
        devices=tuple(d for d in devices if d is not None),
        drives=tuple(drives.values()),
        manuals=tuple(manuals.values()),
        standard_objects=common.objects,
        node_addresses=common.node_addresses,
        cob_ids=common.cob_ids,
        pins=tuple(pins(spec.names)) if spec.names else (),
        cites=tuple(dict.fromkeys(cited for file in spec.files for cited in file.cites)),
    )
