"""Building: same bytes everywhere, nothing touched without need, nothing lost when it fails."""

import json
import os
import subprocess
import sys
from pathlib import Path

import mini
import pytest

from generator import write
from generator.cli import main

ENVIRONMENTS = [
    {"PYTHONHASHSEED": "0", "LC_ALL": "C.UTF-8", "TZ": "UTC"},
    {"PYTHONHASHSEED": "1", "LC_ALL": "C", "TZ": "UTC+11", "LANG": "tr_TR"},
]


def contents(folder: Path) -> dict[str, bytes]:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name != ".state.json"
    }


def run(root: Path, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "generator", *arguments],
        cwd=root,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


@pytest.mark.parametrize("verb", ["build", "site"])
def test_two_builds_are_byte_identical(verb: str, root: Path, tmp_path: Path) -> None:
    made = []
    for position, environment in enumerate(ENVIRONMENTS):
        folder = tmp_path / f"a{'b' * 40 * position}"
        spec = mini.copy(folder)
        result = run(root, verb, "--spec", str(spec), "--out", str(folder / "out"), **environment)
        assert result.returncode == 0, result.stderr
        made.append(contents(folder / "out"))
    assert made[0] == made[1]
    assert len(made[0]) > 10


def test_committed_artifacts_are_those_of_the_spec(root: Path, generated: Path) -> None:
    fresh = contents(generated)
    committed = {path: data for path, data in contents(root / "generated").items() if not path.startswith("html/")}
    fresh.pop(write.MANIFEST)
    committed.pop(write.MANIFEST)
    assert sorted(fresh) == sorted(committed)
    assert [path for path in fresh if fresh[path] != committed[path]] == []


def test_no_artifact_names_a_machine_or_a_time(generated: Path, site: Path, root: Path) -> None:
    import datetime
    import socket

    words = [
        str(root),
        str(generated),
        str(site),
        socket.gethostname(),
        sys.version.split()[0],
        str(datetime.date.today().year) + "T",
    ]
    for path, data in (*contents(generated).items(), *contents(site).items()):
        for word in words:
            assert len(word) < 4 or word.encode() not in data, f"{path} holds {word}"


def test_unchanged_files_are_left_alone_and_stale_ones_removed(tmp_path: Path) -> None:
    write.write(tmp_path, {"a/x.txt": b"1", "b/y.txt": b"2", "c.txt": b"3"}, {})
    (tmp_path / "mine.txt").write_text("kept")
    before = (tmp_path / "a/x.txt").stat()
    changed = write.write(tmp_path, {"a/x.txt": b"1", "c.txt": b"4"}, {})
    assert changed == ["MANIFEST.json", "b/y.txt", "c.txt"]
    assert (tmp_path / "a/x.txt").stat().st_mtime_ns == before.st_mtime_ns
    assert (tmp_path / "a/x.txt").stat().st_ino == before.st_ino
    assert not (tmp_path / "b").exists()
    assert (tmp_path / "mine.txt").read_text() == "kept"


def test_a_manifest_cannot_remove_files_elsewhere(tmp_path: Path) -> None:
    victim = tmp_path / "victim.txt"
    victim.write_text("kept")
    out = tmp_path / "out"
    out.mkdir()
    (out / write.MANIFEST).write_text(json.dumps({"artifacts": {"../victim.txt": "0", "/etc/passwd": "0"}}))
    write.write(out, {"a.txt": b"1"}, {})
    assert victim.read_text() == "kept"


def test_the_manifest_has_every_digest(generated: Path) -> None:
    listed = json.loads((generated / write.MANIFEST).read_text())["artifacts"]
    files = contents(generated)
    files.pop(write.MANIFEST)
    assert listed == {path: write.digest(data) for path, data in files.items()}


def test_a_failed_build_leaves_everything_as_it_was(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    spec, out = mini.copy(tmp_path), tmp_path / "out"
    assert main(["build", "--spec", str(spec), "--out", str(out)]) == 0
    before = contents(out)
    stamps = {path: path.stat().st_mtime_ns for path in out.rglob("*") if path.is_file()}
    mini.apply("--- devices/mini/codes.yaml\n-     range: 1 ... 127\n+     range: 1 ... 256\n", spec)
    assert main(["build", "--spec", str(spec), "--out", str(out)]) == 1
    assert "error[range-type]" in capsys.readouterr().err
    assert contents(out) == before
    assert {path: path.stat().st_mtime_ns for path in out.rglob("*") if path.is_file()} == stamps


def test_a_write_that_breaks_off_replaces_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write.write(tmp_path, {"a.txt": b"1", "b.txt": b"2"}, {})
    before = contents(tmp_path)
    real = write._stage

    def breaks(final: Path, data: bytes) -> str:
        if final.name == "b.txt":
            raise OSError("disk full")
        return real(final, data)

    monkeypatch.setattr(write, "_stage", breaks)
    with pytest.raises(OSError, match="disk full"):
        write.write(tmp_path, {"a.txt": b"3", "b.txt": b"4"}, {})
    assert contents(tmp_path) == before


def test_a_damaged_artifact_is_made_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    spec, out = mini.copy(tmp_path), tmp_path / "out"
    arguments = ["build", "--spec", str(spec), "--out", str(out)]
    assert main(arguments) == 0
    assert main(arguments) == 0
    assert "up to date" in capsys.readouterr().out
    victim = out / "json" / "mini.json"
    good = victim.read_bytes()
    victim.write_bytes(b"{}")
    assert main(arguments) == 0
    assert victim.read_bytes() == good


def test_a_run_with_nothing_to_do_imports_nothing_heavy(root: Path, tmp_path: Path) -> None:
    spec, out = mini.copy(tmp_path), tmp_path / "out"
    arguments = ["build", "--spec", str(spec), "--out", str(out)]
    assert main(arguments) == 0
    code = "import sys; from generator.cli import main; main(sys.argv[1:]); print(sorted(sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments], cwd=root, capture_output=True, text=True, timeout=60, check=True
    )
    loaded = done.stdout.splitlines()[-1]
    assert "'generator.write'" in loaded
    for heavy in ("yaml", "jsonschema", "jinja2", "lark"):
        assert f"'{heavy}'" not in loaded


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ("index: 11225 / 2BD9, table", "index: 11235 / 2BD9, table", "codes.yaml:38:21"),
        ("index: 11225 / 2BD9, table", "index: 11225 / 2BE9, table", "codes.yaml:38:21"),
        ("table: 10225 / 27F1", "table: 10225 / 27F2", "codes.yaml:39:51"),
    ],
)
def test_check_points_at_a_changed_digit(old: str, new: str, place: str, root: Path, tmp_path: Path) -> None:
    spec = mini.copy(tmp_path)
    mini.apply(f"--- devices/mini/codes.yaml\n- {old}\n+ {new}\n", spec)
    result = run(root, "check", "--spec", str(spec))
    assert result.returncode == 1
    assert f"{place}: error[code-index]" in result.stderr
    assert "Traceback" not in result.stderr
    found = json.loads(run(root, "check", "--spec", str(spec), "--format", "json").stdout)
    assert {entry["rule"] for entry in found} == {"code-index"}


def test_the_command_line_teaches(root: Path) -> None:
    shown = run(root, "--help").stdout
    for word in ("build", "check", "census", "explain", "Exit status"):
        assert word in shown
    assert "index base" in run(root, "explain", "code-index").stdout
    wrong = run(root, "explain", "code-indx")
    assert wrong.returncode == 2
    assert "did you mean 'code-index'" in wrong.stderr
    assert run(root, "check", "--spec", "nowhere").returncode == 2


def test_census_lists_facts_sorted_and_counts(root: Path, tmp_path: Path) -> None:
    result = run(root, "census", "--spec", str(mini.copy(tmp_path)))
    facts, counts, coverage = result.stdout.split("\n\n")
    lines = facts.splitlines()
    assert lines == sorted(lines)
    assert "mini/codes/C13350/defaults/0 = 1" in lines
    assert "count mini codes 7" in counts.splitlines()
    assert "coverage MINI-EN-1.0 2 transcribed Codes" in coverage.splitlines()
