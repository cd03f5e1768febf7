"""``python -m bench [lookups] [python] [codecs]``: all of it, or the parts that are named."""

import argparse
from pathlib import Path

from bench.codecs import codecs
from bench.lookups import lookups
from bench.python import python
from generator.pipeline import compile_model

PARTS = {"lookups": lookups, "python": python, "codecs": codecs}


def main() -> int:
    """Measure, print the tables, and tell by the exit code whether the goals are met."""
    parser = argparse.ArgumentParser(prog="bench", description=__doc__)
    parser.add_argument("parts", nargs="*", choices=[*PARTS, []], help="what to measure (all)")
    parser.add_argument("--rounds", type=int, default=15, help="interleaved rounds that a median is of (15)")
    given = parser.parse_args()
    root = Path(__file__).resolve().parent.parent.parent
    model = compile_model(root / "spec", "spec")
    good = [PARTS[part](model, given.rounds) for part in given.parts or PARTS]
    print("all within the goals" if all(good) else "not within the goals")
    return 0 if all(good) else 1


raise SystemExit(main())
