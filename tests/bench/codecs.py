"""Nanoseconds that a telegram takes to decode and to encode, of every layout in each language."""

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from statistics import median

from bench import programs
from bench.python import place
from bench.tables import medians, show
from generator.codec import CodecError, encode
from generator.emit.c import render as render_c
from generator.emit.python.telegrams import class_name
from generator.emit.python.vectors import filled
from generator.emit.rust import render as render_rust
from generator.emit.rust.syntax import type_name
from generator.model import Device, Field, FieldType, Layout, Model
from generator.model.telegram import Value
from generator.naming import snake

_REPEATS = 20_000
"""Telegrams of a measurement in C and Rust."""
_PYTHON_REPEATS = 2_000


@dataclass(frozen=True, slots=True)
class Task:
    """A layout with telegrams: the worked ones of the manual, or (``worked`` false) one of zeros and constants."""

    device: str
    layout: str
    telegrams: tuple[bytes, ...]
    worked: bool
    stem: str
    rust: str
    python: str

    @property
    def name(self) -> str:
        """What the programs print it as."""
        return f"{self.device}/{self.layout}"


def codecs(model: Model, rounds: int) -> bool:
    """Print the table; there is no goal for these."""
    tasks = [task for device in model.devices for layout in device.layouts if (task := _task(device, layout))]
    sys.path.insert(0, str(place(model)))
    c, rust = _c(model, tasks, rounds), _rust(model, tasks, rounds)
    rows = []
    for task in tasks:
        name = task.name if task.worked else f"{task.name} (zeros)"
        python = _python(task, rounds)
        figures = [*(c[task.name][way] for way in _WAYS), *(rust[task.name][way] for way in _WAYS), *python]
        rows.append([name, str(max(map(len, task.telegrams))), *(f"{value:.1f}" for value in figures)])
    print("Telegrams")
    head = ["ns per telegram", "bytes", "C dec", "C enc", "Rust dec", "Rust enc", "Python dec", "Python enc"]
    show(head, rows)
    return True


_WAYS = ("decode", "encode")


def _task(device: Device, layout: Layout) -> Task | None:
    worked = [filled(example, layout) for example in device.examples if example.layout == layout.id]
    telegrams = worked or _zeros(layout)
    if not telegrams:
        print(f"{device.id}/{layout.id} is left out: no worked telegram, and zeros do not fit it\n")
        return None
    stem = snake(device.id, layout.id)
    return Task(device.id, layout.id, tuple(telegrams), bool(worked), stem, type_name(layout.id), class_name(layout))


def _zeros(layout: Layout) -> list[bytes]:
    try:
        octets = encode(layout, {field.name: _zero(field) for field in layout.fields})
    except CodecError:
        return []
    return [bytes(octet or 0 for octet in octets)]


def _zero(field: Field) -> Value:
    if field.type is FieldType.GROUP:
        return ()
    return (field.constant or 0) if field.type in (FieldType.UINT, FieldType.INT) else ""


def _c(model: Model, tasks: Sequence[Task], rounds: int) -> dict[str, dict[str, float]]:
    programs.write(programs.FOLDER / "c", programs.texts(render_c(model)))
    folder = programs.FOLDER / "codecs"
    devices = sorted({task.device for task in tasks})
    programs.write(folder, [("codecs.c", programs.fill("codecs.c", tasks=tasks, devices=devices, repeats=_REPEATS))])
    program = programs.compile_c(folder / "codecs.c", programs.FOLDER / "c" / "include")
    return medians(programs.run(program, str(rounds)))


def _rust(model: Model, tasks: Sequence[Task], rounds: int) -> dict[str, dict[str, float]]:
    programs.write(programs.FOLDER / "rust", programs.texts(render_rust(model)))
    folder = programs.FOLDER / "codecs-rust"
    text = programs.fill("codecs.rs", tasks=tasks, repeats=_REPEATS)
    manifest = programs.fill("Cargo.toml", name="codecs", phf=False)
    programs.write(folder, [("Cargo.toml", manifest), ("src/main.rs", text)])
    programs.fetched(folder)  # what the crate can do without is not needed, but cargo wants to know of it
    return medians(programs.run(programs.build_rust(folder), str(rounds)))


def _python(task: Task, rounds: int) -> list[float]:
    layout = getattr(import_module(f"drivespec_devices.{task.device}"), task.python)
    decoded = [layout.decode(telegram) for telegram in task.telegrams]
    decodes: Callable[[], object] = lambda: [layout.decode(telegram) for telegram in task.telegrams]  # noqa: E731
    encodes: Callable[[], object] = lambda: [telegram.encode() for telegram in decoded]  # noqa: E731
    count = len(task.telegrams)
    return [median(_time(work, count) for _ in range(rounds)) for work in (decodes, encodes)]


def _time(work: Callable[[], object], count: int) -> float:
    repeats = _PYTHON_REPEATS // count + 1
    start = time.perf_counter_ns()
    for _ in range(repeats):
        work()
    return (time.perf_counter_ns() - start) / (repeats * count)
