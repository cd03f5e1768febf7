"""No user mistake ends in a traceback: damaged specs compile or are refused with diagnostics, nothing else."""

import os
import random
import re
import shutil
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import mini
import pytest

from generator import spec as spec_module
from generator.cli import main
from generator.diagnostics import DiagnosticsError, Problems, SourceText, as_json, as_text
from generator.load import Map, read
from generator.pipeline import compile_model, render_site
from generator.schema import Schemas

SEEDS = range(int(os.environ.get("DRIVESPEC_DAMAGE_SEEDS", "150")))
REAL_SEEDS = range(2 * len(SEEDS))
LONGEST = 20.0
"""Seconds of processor time that a damaged spec may take."""
WORDS = [
    *("-1", "0", "007", "99999999999", "99999999999999999999", "0x0", "true", "OFF", '""', "", "'", "[1]", "{a: 1}"),
    *("C99999", "C13372/9...2", "C13372/1...99999999999", "I-FFFF/255", "I-1000 ... I-FFFF", "P-99999999999"),
    *("0x00000000 ... 0xffffffff", "1...99999999999", "20 ... 10", "0 ... 99999999999999", "1.5 ... 2.5", "..."),
    *("$NODEID + 0x180", "$VALUE 0...31", "$BEHIND x", "code mod 0", "1" + "+1" * 3000, "9" * 5000, "x" * 300),
    *("{n}", "µ", "sav€", "'²'", "'٣'", r'"\x01"', r'"\U0001F600"', r'"a\n"', "ZZ", "XX"),
]
KEYS = [
    *("01", "007", "0x", "-1", "0", "255", "256", "99999999999999999999", "9" * 5000, "1...99999999999", "5...2"),
    *("0...63", "0...64", "²", "€", "a b", "else", "table", "rule", "XX"),
]
KEY = re.compile(r"[A-Za-z0-9_.]+(?=: )")
VALUE = re.compile(r"(?<=: )[^,{}\[\]]+(?=[,}\]]|$)")
ITEM = re.compile(r"(?<=[\[ ])[^,{}\[\]:]+(?=[,\]])")
CELL = re.compile(r"[^,{}\[\]]+, ")


def _replaced(pattern: re.Pattern[str], line: str, word: str, random_: random.Random) -> str:
    """The line with one of the matches of a pattern replaced."""
    found = list(pattern.finditer(line))
    if not found:
        return line
    match = random_.choice(found)
    return line[: match.start()] + word + line[match.end() :]


def damage(text: str, random_: random.Random) -> str:
    """The text with one to three random edits of lines, keys, cells and scalars."""
    lines = text.splitlines()
    for _ in range(random_.randint(1, 3)):
        place = random_.randrange(len(lines))
        line = lines[place]
        match random_.randrange(11):
            case 0:
                del lines[place]
            case 1:
                lines.insert(place, line)
            case 2 | 3:
                lines[place] = _replaced(VALUE, line, random_.choice(WORDS), random_)
            case 4:
                lines[place] = _replaced(re.compile(r"\d"), line, random_.choice("0123456789abcXyz-²€"), random_)
            case 5:
                lines[place] = line[2:] if line.startswith("  ") else "  " + line
            case 6:
                spot = random_.randrange(len(line) + 1)
                lines[place] = line[:spot] + random_.choice("{}[]:,#&*!|>'\"%@`\t\\") + line[spot:]
            case 7:
                lines[place] = _replaced(KEY, line, random_.choice(KEYS), random_)
            case 8:
                lines[place] = _replaced(ITEM, line, random_.choice(WORDS), random_)
            case 9:
                lines[place] = _replaced(CELL, line, "", random_)
            case _:
                other = random_.randrange(len(lines))
                lines[place], lines[other] = lines[other], lines[place]
        if not lines:
            break
    return "\n".join(lines) + "\n"


@contextmanager
def time_limit() -> Iterator[None]:
    """Fail where the block takes more processor time than ``LONGEST``."""

    def stop(*_: object) -> None:
        raise AssertionError(f"still busy after {LONGEST} s")

    signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, LONGEST)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)


@contextmanager
def refused_politely(folder: Path) -> Iterator[None]:
    """Fail where the block ends with anything but diagnostics, which can be shown."""
    try:
        with time_limit():
            yield
    except DiagnosticsError as error:
        assert error.diagnostics
        shown = as_text(error.diagnostics, SourceText(folder))
        assert shown.count(": error[") == len(error.diagnostics)
        assert as_json(error.diagnostics)


def texts(folder: Path) -> dict[str, str]:
    return {
        path.relative_to(folder).as_posix(): path.read_text(encoding="utf-8")
        for path in sorted(folder.rglob("*.yaml"))
        if "schema" not in path.parts
    }


@pytest.mark.parametrize("seed", SEEDS)
def test_damaged_specs_are_refused_politely(seed: int, tmp_path: Path) -> None:
    random_ = random.Random(seed)
    originals = texts(mini.SPEC)
    spec = mini.copy(tmp_path)
    name = random_.choice(sorted(originals))
    (spec / name).write_text(damage(originals[name], random_), encoding="utf-8")
    with refused_politely(tmp_path):
        render_site(compile_model(spec, "spec"))


@pytest.mark.parametrize("seed", range(len(SEEDS) // 3))
def test_damaged_schemas_are_refused_politely(seed: int, tmp_path: Path) -> None:
    random_ = random.Random(seed)
    spec = mini.copy(tmp_path)
    path = random_.choice(sorted((spec / "schema").iterdir()))
    path.write_text(damage(path.read_text(encoding="utf-8"), random_), encoding="utf-8")
    with refused_politely(tmp_path):
        compile_model(spec, "spec")


class Remembered:
    """The real spec in a folder of its own; files that are whole are read and validated once."""

    def __init__(self, folder: Path, patch: pytest.MonkeyPatch) -> None:
        self.spec = folder / "spec"
        shutil.copytree(mini.ROOT / "spec", self.spec)
        self.originals = texts(self.spec)
        self.damaged = Path()
        self._read: dict[Path, Map | None] = {}
        self._check = Schemas.check
        self._schemas = Schemas(self.spec / "schema", "spec/schema", spec_module._KINDS, Problems())
        patch.setattr(spec_module, "read", self.read)
        patch.setattr(spec_module, "Schemas", lambda *_: self._schemas)
        patch.setattr(self._schemas, "check", self.check)

    def read(self, path: Path, name: str, problems: Problems) -> Map | None:
        """In the place of ``load.read``."""
        if path == self.damaged:
            return read(path, name, problems)
        if path not in self._read:
            self._read[path] = read(path, name, problems)
        return self._read[path]

    def check(self, kind: str, data: Map, name: str, problems: Problems) -> None:
        """In the place of ``Schemas.check``: the files of the spec itself are valid."""
        if not any(data is whole for whole in self._read.values()):
            self._check(self._schemas, kind, data, name, problems)


@pytest.fixture(scope="module")
def real(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Remembered]:
    with pytest.MonkeyPatch.context() as patch:
        remembered = Remembered(tmp_path_factory.mktemp("real"), patch)
        compile_model(remembered.spec, "spec")
        yield remembered


@pytest.mark.parametrize("seed", REAL_SEEDS)
def test_damages_of_the_real_spec_are_refused_politely(seed: int, real: Remembered) -> None:
    random_ = random.Random(seed)
    name = random_.choice(sorted(real.originals))
    real.damaged = real.spec / name
    real.damaged.write_text(damage(real.originals[name], random_), encoding="utf-8")
    try:
        with refused_politely(real.spec.parent):
            compile_model(real.spec, "spec")
    finally:
        real.damaged.write_text(real.originals[name], encoding="utf-8")


@pytest.mark.parametrize(
    "arguments",
    [
        ["build", "--out", "file"],
        ["site", "--out", "file/below"],
        ["build", "--out", "taken"],
        ["pin"],
    ],
    ids=" ".join,
)
def test_what_cannot_be_written_is_said(
    arguments: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    spec = mini.copy(tmp_path)
    (tmp_path / "file").write_text("mine")
    (tmp_path / "taken" / "c" / "README.md").mkdir(parents=True)
    if arguments == ["pin"]:
        monkeypatch.setattr("generator.cli.save", _refuses)
    before = _contents(tmp_path)
    assert main([*arguments, "--spec", str(spec)]) == 1
    assert re.match(r"error: cannot write \S+: .+; nothing was written\n\Z", capsys.readouterr().err)
    assert _contents(tmp_path) == before


def _refuses(folder: Path, files: dict[str, Any]) -> None:
    raise PermissionError(13, "Permission denied", str(folder / next(iter(files))))


def _contents(folder: Path) -> dict[str, bytes]:
    return {path.as_posix(): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}
