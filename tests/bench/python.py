"""What Python pays: the import of each device, and a lookup against a bare ``dict``."""

import statistics
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from types import ModuleType

from bench import programs
from bench.tables import show
from generator.emit.python import render
from generator.model import Device, Model

GOAL = 3.0
"""Milliseconds that a device may take above an empty module."""
_INTERPRETERS = 3
"""Fresh interpreters of a module for each round."""
_LOOKUPS = 20_000
Key = tuple[int] | tuple[int, str]
"""What a lookup is called with."""
_IMPORT = (
    "import sys, time; sys.path.insert(0, sys.argv[1]); start = time.perf_counter(); __import__(sys.argv[2]); "
    "print(time.perf_counter() - start)"
)


def python(model: Model, rounds: int) -> bool:
    """Print the tables; whether each import is within the goal."""
    package = place(model)
    good = _imports(model, package, rounds)
    _lookups(model, package, rounds)
    return good


def place(model: Model) -> Path:
    """Folder of a fresh package, outside of what is generated, where Python may keep its bytecode."""
    folder = programs.FOLDER / "python"
    programs.write(folder, programs.texts(render(model)))
    return folder


def _imports(model: Model, package: Path, rounds: int) -> bool:
    folder = programs.FOLDER / "empty"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "empty_module.py").write_text("", encoding="utf-8")
    modules = {"empty_module": folder, "drivespec_devices": package}
    modules |= {f"drivespec_devices.{device.id}": package for device in model.devices}
    times: dict[str, list[float]] = {name: [] for name in modules}
    for _ in range(rounds * _INTERPRETERS):
        for name, path in modules.items():
            command = [sys.executable, "-I", "-c", _IMPORT, str(path), name]
            times[name].append(float(subprocess.run(command, capture_output=True, text=True, check=True).stdout) * 1e3)
    medians = {name: statistics.median(values) for name, values in times.items()}
    empty = medians["empty_module"]
    print("Python, import in a fresh interpreter")
    show(
        ["module", "ms", "ms over empty"],
        [[name, f"{value:.2f}", f"{value - empty:.2f}"] for name, value in medians.items()],
    )
    return all(value - empty <= GOAL for value in medians.values())


def _lookups(model: Model, package: Path, rounds: int) -> None:
    sys.path.insert(0, str(package))
    rows = []
    for device in model.devices:
        module = import_module(f"drivespec_devices.{device.id}")
        for name, function, keys in _functions(device, module):
            bare = {key[0]: function(*key) for key in keys}
            listed = keys * (_LOOKUPS // len(keys) + 1)
            found, plain = [], []
            for _ in range(rounds):
                found.append(_time(function, listed))
                plain.append(_time(bare.__getitem__, [key[:1] for key in listed]))
            ours, other = statistics.median(found), statistics.median(plain)
            rows.append([f"{device.id}.{name}", f"{ours:.0f}", f"{other:.0f}", f"{ours / other:.1f}"])
    print("Python, lookup by number")
    show(["ns per lookup", "ours", "bare dict", "ours / dict"], rows)


def _functions(device: Device, module: ModuleType) -> list[tuple[str, Callable[..., object], list[Key]]]:
    """Lookups of the module; of the errors those of the first kind."""
    found: list[tuple[str, Callable[..., object], list[Key]]] = []
    if device.codes:
        found.append(("code", module.code, [(code.number,) for code in device.codes]))
    if device.errors:
        kind = device.errors[0].kind
        times = Counter(error.number for error in device.errors if error.kind == kind)
        numbers = [number for number in times if times[number] == 1]
        keys: list[Key] = [(number,) if kind == "device" else (number, kind) for number in numbers]
        found.append((f"error {kind}", module.error, keys))
    return found


def _time(function: Callable[..., object], keys: list[Key]) -> float:
    start = time.perf_counter_ns()
    for key in keys:
        function(*key)
    return (time.perf_counter_ns() - start) / len(keys)
