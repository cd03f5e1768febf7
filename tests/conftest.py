"""Fixtures: the model of the real spec, and the folder of its artifacts."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from generator.model import Model
from generator.pipeline import compile_model, render
from generator.write import write

settings.register_profile("long", max_examples=5_000, deadline=None, suppress_health_check=list(HealthCheck))

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="session")
def root() -> Path:
    """The repository."""
    return ROOT


@pytest.fixture(scope="session")
def model() -> Model:
    """The checked model of spec/."""
    return compile_model(ROOT / "spec", "spec")


@pytest.fixture(scope="session")
def generated(model: Model, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Every artifact of the real spec, freshly made outside the repository."""
    folder = tmp_path_factory.mktemp("generated")
    write(folder, render(model), {})
    return folder
