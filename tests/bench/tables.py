"""Tables of measurements on a terminal."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from statistics import median

OURS = "ours"
GOAL = 1.2
"""Times that ours may take of the best of the other ways."""
Figures = Mapping[str, Mapping[str, float]]
"""Median by way and measurement."""


def medians(printed: str) -> dict[str, dict[str, float]]:
    """Medians of lines "measurement way value"."""
    values: dict[str, dict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
    for line in printed.splitlines():
        measurement, way, value = line.split()
        values[way.strip("_")][measurement].append(float(value))
    return {way: {name: median(found) for name, found in row.items()} for way, row in values.items()}


def show(head: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print rows in columns, the first to the left, the others to the right."""
    widths = [max(len(row[column]) for row in (head, *rows)) for column in range(len(head))]
    for row in (head, *rows):
        cells = [row[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True))]
        print("  " + "  ".join(cells).rstrip())
    print()


def compare(title: str, figures: Figures, measurements: Mapping[str, str]) -> bool:
    """Print what each way took and the ratio of ours to the best other way; whether ours is within the goal.

    The goal is for the first measurement; the others depend on what the compiler makes of the program around it.
    """
    print(title)
    rows = [[way, *(f"{row[name]:.2f}" for name in measurements)] for way, row in figures.items()]
    best = {name: min(row[name] for way, row in figures.items() if way != OURS) for name in measurements}
    ratios = {name: figures[OURS][name] / best[name] for name in measurements}
    rows.append(["ours / best other", *(f"{ratio:.2f}" for ratio in ratios.values())])
    show(["ns per lookup", *measurements.values()], rows)
    return next(iter(ratios.values())) <= GOAL
