"""The crate gsd-parser as an independent reader of GSD files; tests/consumers/gsd-parser prints what it reads."""

import json
import os
import shutil
import subprocess
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import pytest


@dataclass
class CrateGsd:
    """A file as the crate reads it: keywords of the station, MaxTsdr by bit rate, modules."""

    keywords: dict[str, str] = field(default_factory=dict)
    rates: dict[str, int] = field(default_factory=dict)
    user_parameters: bytes = b""
    modules: list[tuple[int | None, str, bytes, str]] = field(default_factory=list)
    error: str = ""


class Crate:
    """The program, built below .build by its own lock file."""

    def __init__(self, root: Path) -> None:
        self._folder = root / "tests" / "consumers" / "gsd-parser"
        self._environment = os.environ | {"CARGO_TARGET_DIR": str(root / ".build" / "gsd-parser")}

    def _run(self, *arguments: str) -> str:
        cargo = shutil.which("cargo")
        if cargo is None:
            pytest.fail("'cargo' was not found: the tests of the GSD files need Rust (https://rustup.rs)")
        done = subprocess.run(
            [cargo, *arguments], cwd=self._folder, env=self._environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr + done.stdout
        return done.stdout

    def read(self, files: Iterable[Path]) -> dict[Path, CrateGsd]:
        """What the crate makes of each file."""
        paths = list(files)
        found: dict[Path, CrateGsd] = {}
        current = CrateGsd()
        for line in self._run("run", "--quiet", "--locked", "--", *map(str, paths)).splitlines():
            match line.split("\t"):
                case ["file", name]:
                    current = found[Path(name)] = CrateGsd()
                case ["error", message]:
                    current.error = message
                case ["rate", name, time]:
                    current.rates[name] = int(time)
                case ["user_parameters", data]:
                    current.user_parameters = bytes.fromhex(data)
                case ["module", reference, name, configuration, info]:
                    number = int(reference) if reference else None
                    current.modules.append((number, name, bytes.fromhex(configuration), info))
                case [name, value]:
                    current.keywords[name] = value
        assert list(found) == paths
        return found

    def sample(self) -> Path:
        """The sample file that the crate tests itself with."""
        metadata = json.loads(self._run("metadata", "--format-version", "1", "--locked"))
        manifest = next(p["manifest_path"] for p in metadata["packages"] if p["name"] == "gsd-parser")
        return Path(manifest).parent / "tests" / "data" / "mock.gsd"
