"""No user mistake ends in a traceback: damaged specs compile or are refused with diagnostics, nothing else."""

import os
import random
import re
from pathlib import Path

import mini
import pytest

from generator.diagnostics import DiagnosticsError, SourceText, as_json, as_text
from generator.pipeline import compile_model, render

SEEDS = range(int(os.environ.get("DRIVESPEC_DAMAGE_SEEDS", "150")))
WORDS = [
    "-1",
    "0",
    "99999999999",
    "0x0",
    "",
    "OFF",
    "[1]",
    "{a: 1}",
    "C99999",
    "I-FFFF/255",
    "x" * 300,
    "...",
    "{n}",
    "µ",
    "'",
]


def damage(text: str, random_: random.Random) -> str:
    """The text with one to three random edits of lines, keys and scalars."""
    lines = text.splitlines()
    for _ in range(random_.randint(1, 3)):
        place = random_.randrange(len(lines))
        line = lines[place]
        match random_.randrange(7):
            case 0:
                del lines[place]
            case 1:
                lines.insert(place, line)
            case 2:
                lines[place] = re.sub(r": .*", f": {random_.choice(WORDS)}", line, count=1)
            case 3:
                digits = [m.start() for m in re.finditer(r"\d", line)] or [0]
                spot = random_.choice(digits)
                lines[place] = line[:spot] + random_.choice("0123456789abcXyz-") + line[spot + 1 :]
            case 4:
                lines[place] = line[2:] if line.startswith("  ") else "  " + line
            case 5:
                spot = random_.randrange(len(line) + 1)
                lines[place] = line[:spot] + random_.choice("{}[]:,#&*!|>'\"%@`\t\\") + line[spot:]
            case _:
                other = random_.randrange(len(lines))
                lines[place], lines[other] = lines[other], lines[place]
        if not lines:
            break
    return "\n".join(lines) + "\n"


@pytest.fixture(scope="module")
def originals() -> dict[str, str]:
    return {
        path.relative_to(mini.SPEC).as_posix(): path.read_text(encoding="utf-8")
        for path in sorted(mini.SPEC.rglob("*.yaml"))
    }


@pytest.mark.parametrize("seed", SEEDS)
def test_damaged_specs_are_refused_politely(seed: int, originals: dict[str, str], tmp_path: Path) -> None:
    random_ = random.Random(seed)
    spec = mini.copy(tmp_path)
    name = random_.choice(sorted(originals))
    (spec / name).write_text(damage(originals[name], random_), encoding="utf-8")
    try:
        render(compile_model(spec, "spec"))
    except DiagnosticsError as error:
        assert error.diagnostics
        shown = as_text(error.diagnostics, SourceText(tmp_path))
        assert shown.count(": error[") == len(error.diagnostics)
        assert as_json(error.diagnostics)
