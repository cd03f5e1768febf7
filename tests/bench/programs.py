"""Programs of the benchmark: written from templates, built below .build/bench, run."""

import shutil
import subprocess
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import jinja2

from generator.emit.base import Output

HERE = Path(__file__).resolve().parent
FOLDER = HERE.parent.parent / ".build" / "bench"
C_FLAGS = ("-std=gnu99", "-O2")
CRATES_OFF = "crates-io cannot be reached"
"""Why phf is left out where cargo cannot get it."""

_TEMPLATES = jinja2.Environment(
    loader=jinja2.FileSystemLoader(HERE / "templates"),
    undefined=jinja2.StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
    keep_trailing_newline=True,
)


def fill(template: str, **view: object) -> str:
    """Text of a template."""
    return _TEMPLATES.get_template(f"{template}.j2").render(**view)


def write(folder: Path, files: Iterable[tuple[str, str]]) -> None:
    """Write files below ``folder``; an unchanged file keeps its time."""
    for path, text in files:
        file = folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            file.write_text(text, encoding="utf-8")


def texts(files: Mapping[str, Output]) -> Iterable[tuple[str, str]]:
    """Texts of the artifacts of a target."""
    return ((path, output.text) for path, output in files.items())


def run(*command: str | Path) -> str:
    """Standard output of a command that has to succeed.

    Raises:
        SystemExit: It failed; what it said is shown.
    """
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"make bench-libs: {' '.join(map(str, command))} failed:\n{done.stderr}{done.stdout}")
    return done.stdout


def compile_c(source: Path, include: Path) -> Path:
    """Program of one C file."""
    program = source.with_suffix("")
    run("cc", *C_FLAGS, f"-I{include}", f"-I{source.parent}", source, "-o", program)
    return program


def fetched(folder: Path) -> bool:
    """Whether cargo has, or gets, what a crate needs."""
    command = ["cargo", "fetch", "--manifest-path", str(folder / "Cargo.toml")]
    return subprocess.run(command, capture_output=True, check=False).returncode == 0


def build_rust(folder: Path) -> Path:
    """Program of a crate."""
    run("cargo", "build", "--release", "--offline", "--quiet", "--manifest-path", folder / "Cargo.toml")
    manifest = tomllib.loads((folder / "Cargo.toml").read_text(encoding="utf-8"))
    return folder / "target" / "release" / str(manifest["package"]["name"])


def missing(tools: Sequence[str]) -> list[str]:
    """Tools that are not on the PATH."""
    return [tool for tool in tools if shutil.which(tool) is None]
