"""Error number to record, in C and in Rust, against the other ways on the same numbers."""

from pathlib import Path

from bench import programs
from bench.cases import Case, cases, with_large_list
from bench.tables import compare, medians
from bench.ways import direct, two_level
from generator.emit.c import render as render_c
from generator.emit.c.tables import sorted_errors
from generator.emit.rust import render as render_rust
from generator.model import Model

_MEASUREMENTS = {"hits": "hits", "chained": "hits, chained", "mixed": "half misses"}


def lookups(model: Model, rounds: int) -> bool:
    """Print a table for each list of numbers and language; whether all are within the goal."""
    model = with_large_list(model)
    listed = list(cases(model))
    for case in listed:
        folder = programs.FOLDER / case.name
        folder.mkdir(parents=True, exist_ok=True)
        case.write(folder)
    good = [_c(model, listed, rounds), _rust(model, listed, rounds)]
    return all(good)


def _c(model: Model, listed: list[Case], rounds: int) -> bool:
    programs.write(programs.FOLDER / "c", programs.texts(render_c(model)))
    if programs.missing(["gperf"]):
        print("gperf is left out: it is not on the PATH\n")
    good = True
    for case in listed:
        folder = programs.FOLDER / case.name
        device = next(device for device in model.devices if device.id == case.device)
        index = direct(case.numbers, len(case.runs))
        gperf = _gperf(case, folder)
        source = programs.fill(
            "lookups.c",
            case=case,
            kind=f"DRIVESPEC_ERROR_{case.kind.upper()}",
            offset=[error.kind for error in sorted_errors(device)].index(case.kind),
            direct=index,
            hash=two_level(case.numbers),
            gperf=gperf,
            ways=[
                "ours",
                *["direct"] * (index is not None),
                "two_level_hash",
                "switch",
                "bsearch",
                "branchless_search",
                *["gperf"] * bool(gperf),
            ],
        )
        programs.write(folder, [("lookups.c", source)])
        program = programs.compile_c(folder / "lookups.c", programs.FOLDER / "c" / "include")
        figures = medians(programs.run(program, folder, str(rounds)))
        good &= compare(f"C, {case.title}", figures, _MEASUREMENTS)
    return good


def _gperf(case: Case, folder: Path) -> str:
    """Name of the file that gperf made, empty without gperf."""
    if programs.missing(["gperf"]):
        return ""
    keys = [("".join(f"\\{octet:03o}" for octet in n.to_bytes(4, "little")), place) for n, place in case.numbers]
    programs.write(folder, [("numbers.gperf", programs.fill("gperf", keys=keys))])
    made = programs.run("gperf", "--key-positions=1-4", folder / "numbers.gperf")
    programs.write(folder, [("gperf.h", made)])
    return "gperf.h"


def _rust(model: Model, listed: list[Case], rounds: int) -> bool:
    crate, folder = programs.FOLDER / "rust", programs.FOLDER / "lookups"
    programs.write(crate, programs.texts(render_rust(model)))
    lock = (programs.HERE / "Cargo.lock").read_text(encoding="utf-8")
    programs.write(folder, [*_rust_files(listed, True), ("Cargo.lock", lock)])
    if not programs.fetched(folder):
        print(f"phf is left out: {programs.CRATES_OFF}\n")
        (folder / "Cargo.lock").unlink()
        programs.write(folder, _rust_files(listed, False))
    program = programs.build_rust(folder)
    good = True
    for case in listed:
        figures = medians(programs.run(program, case.name, programs.FOLDER / case.name, str(rounds)))
        good &= compare(f"Rust, {case.title}", figures, _MEASUREMENTS)
    return good


def _rust_files(listed: list[Case], phf: bool) -> list[tuple[str, str]]:
    files = [("Cargo.toml", programs.fill("Cargo.toml", name="lookups", phf=phf))]
    entries = []
    for case in listed:
        index = direct(case.numbers, len(case.runs))
        text = programs.fill("case.rs", case=case, direct=index, hash=two_level(case.numbers), phf=phf)
        files.append((f"src/{case.name}.rs", text))
        ways = ["ours", *["direct"] * (index is not None), "two_level_hash", "match_", "binary_search", *["phf"] * phf]
        entries.append({"case": case, "ways": ways})
    return [*files, ("src/main.rs", programs.fill("lookups.rs", entries=entries))]
