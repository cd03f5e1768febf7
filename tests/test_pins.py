"""Names of a release: written by ``pin``, and missed when they are gone or mean something else."""

import shutil
from collections import Counter
from pathlib import Path

import mini
import pytest

from generator.cli import main
from generator.diagnostics import DiagnosticsError
from generator.emit.pins import public_names
from generator.model import Model
from generator.pipeline import compile_model, render


def problems(spec: Path) -> list[str]:
    try:
        render(compile_model(spec, "spec"))
    except DiagnosticsError as error:
        assert {found.rule for found in error.diagnostics} == {"name-pinned"}
        return [found.message for found in error.diagnostics]
    return []


@pytest.fixture
def pinned(tmp_path: Path) -> Path:
    """The small spec with its names pinned."""
    spec = mini.copy(tmp_path)
    assert main(["pin", "--spec", str(spec)]) == 0
    return spec


def test_what_is_pinned_is_there(pinned: Path) -> None:
    assert problems(pinned) == []
    before = (pinned / "names.yaml").read_bytes()
    assert main(["pin", "--spec", str(pinned)]) == 0
    assert (pinned / "names.yaml").read_bytes() == before


def test_new_names_are_welcome(pinned: Path) -> None:
    path = pinned / "names.yaml"
    lines = path.read_text(encoding="ascii").splitlines(keepends=True)
    path.write_text("".join(lines[:-1]), encoding="ascii")
    assert problems(pinned) == []


def test_a_new_label_and_a_new_number_are_told(pinned: Path) -> None:
    selection = "--- devices/mini/objects.yaml\n- selection: {0x1001: Small, 0x1002: Large / XL}\n"
    mini.apply(selection + "+ selection: {0x1001: Tiny, 0x1003: Large / XL}\n", pinned)
    gone, moved = problems(pinned)
    assert gone.endswith(".small' of release 1.2.3 is gone")
    assert moved.endswith(".large_xl' of release 1.2.3 stood for 4098, now for 4099")
    assert main(["pin", "--spec", str(pinned)]) == 0
    assert problems(pinned) == []


def test_every_kind_of_name_is_pinned(model: Model) -> None:
    for device in model.devices:
        found = public_names(device)
        numbers = Counter(found.values())
        for code in device.codes:
            assert numbers[code.number]
            assert set(Counter(option.value for option in code.options)) <= set(numbers)
        assert sum(name.startswith("error.") for name in found) == len(device.errors)
        assert all(
            numbers[error.number] and numbers[entry.index] for error in device.errors for entry in device.objects
        )
        assert not device.layouts or any(name.startswith("telegram.") for name in found)


def test_the_real_names_can_be_pinned(root: Path, model: Model, tmp_path: Path) -> None:
    """Names of the real devices are legal keys that read back as they are."""
    spec = tmp_path / "spec"
    shutil.copytree(root / "spec", spec)
    assert main(["pin", "--spec", str(spec)]) == 0
    found = compile_model(spec, "spec").pins
    for device in model.devices:
        assert {pin.name: pin.number for pin in found if pin.device == device.id} == public_names(device)
    assert {pin.version for pin in found} == {model.version}
