"""The examples of the README do what they say."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from generator import cli

BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def blocks(root: Path, language: str) -> list[str]:
    return [text for word, text in BLOCK.findall((root / "README.md").read_text(encoding="utf-8")) if word == language]


@pytest.fixture(scope="module")
def place(generated: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder that looks like the repository after ``make``."""
    folder = tmp_path_factory.mktemp("readme")
    (folder / "generated").symlink_to(generated)
    return folder


def test_python_examples(root: Path, place: Path) -> None:
    examples = blocks(root, "python")
    assert len(examples) == 3
    for text in examples:
        subprocess.run([sys.executable, "-c", text], cwd=place, check=True, timeout=60)


def test_c_example(root: Path, place: Path) -> None:
    compiler = shutil.which("cc")
    assert compiler, "install a C compiler (cc is not on the PATH)"
    (text,) = blocks(root, "c")
    (place / "example.c").write_text(text)
    command = [compiler, "-std=c99", "-Wall", "-Werror", "-Igenerated/c/include", "example.c", "-o", "example"]
    subprocess.run(command, cwd=place, check=True, timeout=60)
    shown = subprocess.run([place / "example"], capture_output=True, text=True, check=True, timeout=60)
    assert shown.stdout == "11225 0\n"


def test_rust_example(root: Path, place: Path) -> None:
    cargo = shutil.which("cargo")
    assert cargo, "install Rust (cargo is not on the PATH)"
    (text,) = blocks(root, "rust")
    crate = place / "crate"
    (crate / "src").mkdir(parents=True)
    (crate / "src" / "main.rs").write_text(text)
    shutil.copytree(place / "generated" / "rust", place / "rust")
    dependency = '[dependencies]\ndrivespec-devices = { path = "../rust" }\n'
    (crate / "Cargo.toml").write_text(f'[package]\nname = "example"\nversion = "0.1.0"\nedition = "2021"\n{dependency}')
    shown = subprocess.run(
        [cargo, "run", "--quiet", "--offline"], cwd=crate, capture_output=True, text=True, timeout=300, check=False
    )
    assert shown.stdout == "13350 0x2BD9\n", shown.stderr


def test_every_link_leads_somewhere(root: Path) -> None:
    text = (root / "README.md").read_text(encoding="utf-8")
    named = set(re.findall(r"`((?:spec|generated)/[\w./-]*)`", text)) | {"LICENSE", "requirements.txt"}
    for path in named:
        assert (root / path).exists(), path


def test_every_command_exists(root: Path) -> None:
    text = (root / "README.md").read_text(encoding="utf-8")
    makefile = (root / "Makefile").read_text(encoding="utf-8")
    for target in set(re.findall(r"`?make ([a-z-]+)", text)):
        assert re.search(rf"^{target}:", makefile, re.MULTILINE), target
    parser = cli._parser()
    for verb in set(re.findall(r"python -m generator (\w+)", text)):
        with pytest.raises(SystemExit) as caught:
            parser.parse_args([verb, "--help"])
        assert caught.value.code == 0
