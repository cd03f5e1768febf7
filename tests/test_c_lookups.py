"""Arithmetic and lookups of the C headers: run over whole domains and compared with the model."""

import random
import re
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from math import floor
from pathlib import Path

import pytest
from test_c import COMPILERS, Values, assert_same, compile_c, run, write

from generator.emit.c.common import ERROR_KINDS
from generator.emit.c.panel import LIGHTS
from generator.emit.hashing import perfect_hash
from generator.model import Code, Device, IndicatorTable, Light, Model, Pattern, SwitchGroup
from generator.naming import screaming, snake


@pytest.fixture(scope="session")
def c(generated: Path) -> Path:
    """The folder of the target."""
    return generated / "c"


def result(folder: Path, c: Path, headers: list[str], body: str, compiler: str = "cc", standard: str = "c99") -> Values:
    """What a program of statements prints."""
    source = folder / "program.c"
    includes = "".join(f'#include "drivespec/{header}"\n' for header in headers)
    source.write_text(f"#include <stdio.h>\n{includes}\nint main(void)\n{{\n{body}    return 0;\n}}\n")
    options = () if compiler.startswith("clang") else ("-fsanitize=undefined", "-fno-sanitize-recover=all")
    return run(compile_c(folder, source, compiler, standard, f"-I{c / 'include'}", *options))


# Errors.


def hits(runs: list[tuple[int, int]], probes: list[int]) -> dict[int, int]:
    """Place of each probe that a run holds, by the hash."""
    found = perfect_hash(runs)
    holds = {probe: found.find(probe) for probe in probes}
    for place in found.long:
        holds |= {probe: place for probe in probes if runs[place][0] <= probe <= runs[place][1]}
    return {probe: place for probe, place in holds.items() if runs[place][0] <= probe <= runs[place][1]}


def test_perfect_hashes_find_each_number_and_no_other() -> None:
    rng = random.Random(1)
    for size in (1, 2, 3, 17, 300):
        sparse = [(number, number) for number in rng.sample(range(2**32), size)]
        clustered = [(key, key) for key in (number // 25 << 16 | number % 25 for number in range(size))]
        runs = [(number << 20, (number << 20) + rng.choice((0, 31, 255, 256, 2**19))) for number in range(size)]
        dense = [(3 * number + 7, 3 * number + 9) for number in range(size)]
        for keys in (sparse, clustered, runs, dense):
            probes = [*(end for run in keys for end in run), *rng.sample(range(2**32), 1000)]
            expected = {p: at for p in probes for at, (first, last) in enumerate(keys) if first <= p <= last}
            assert hits(keys, probes) == expected


def test_numbers_without_gaps_are_their_index() -> None:
    found = perfect_hash([(7, 9), (10, 10), (11, 12)])
    assert (found.first, found.places) == (7, (0, 0, 0, 1, 2, 2))


def test_perfect_hashes_of_numbers_without_a_pattern_have_seeds() -> None:
    """The tables that are searched otherwise would grow with the square of the numbers."""
    keys = [(number, number) for number in random.Random(1).sample(range(2**32), 500)]
    found = perfect_hash(keys)
    assert found.seeds
    assert max(found.seeds) < 256
    assert len(found.seeds) + len(found.places) <= 4 * len(keys)


@pytest.mark.parametrize("runs", [[], [(1, 1), (2, 2), (1, 1)], [(1, 5), (5, 6)], [(2, 1)]])
def test_perfect_hashes_take_distinct_runs(runs: list[tuple[int, int]]) -> None:
    with pytest.raises(ValueError, match=r"distinct|ascending"):
        perfect_hash(runs)


def sparse_errors(device: Device) -> Device:
    """The device with errors whose numbers have no pattern, of two kinds, and with runs that no table holds."""
    rng = random.Random(2)
    like = next(error for error in device.errors if error.kind == "device")
    numbers = sorted(rng.sample(range(2**26), 400))
    singles = [
        replace(like, number=number, last=number, kind=kind, name=f"{kind} {number}")
        for kind in ("device", "gci")
        for number in numbers
    ]
    runs = [
        replace(like, number=first << 26, last=(first << 26) + 2**20, kind="gci", name=f"Run {first}")
        for first in (1, 2, 63)
    ]
    return replace(device, errors=(*singles, *runs))


def test_lookup_of_numbers_without_a_pattern_and_of_long_runs(model: Model, tmp_path: Path) -> None:
    device = sparse_errors(next(d for d in model.devices if any(e.kind == "device" for e in d.errors)))
    c = write(tmp_path / "c", replace(model, devices=(device,)))
    kinds = {kind: at for at, kind in enumerate(ERROR_KINDS)}
    rows, expected = [], {}
    for error in device.errors:
        for number in (error.number - 1, error.number, error.last, error.last + 1):
            key = f"{kinds[error.kind]} {number % 2**32}"
            if key not in expected:
                others = [e.name for e in device.errors if e.kind == error.kind and e.number <= number <= e.last]
                expected[key] = others[0] if others else "-"
                rows.append(f"{{ {kinds[error.kind]}u, UINT32_C({number % 2**32}) }}")
    body = (
        f"    const char *texts = (const char *)&{device.id}_error_texts;\n"
        f"    static const uint32_t asked[][2] = {{ {', '.join(rows)} }};\n"
        "    for (size_t i = 0u; i < sizeof asked / sizeof asked[0]; i++) {\n"
        f"        const drivespec_error *e = {device.id}_find_error((uint8_t)asked[i][0], asked[i][1]);\n"
        '        printf("%u %lu=", (unsigned)asked[i][0], (unsigned long)asked[i][1]);\n'
        '        printf("%s\\n", e != NULL ? texts + e->name : "-");\n'
        "    }\n"
    )
    assert_same(result(tmp_path, c, [f"{device.id}_tables.h"], body), dict(expected))


def test_reported_errors_whatever_their_response_and_instance(model: Model, c: Path, tmp_path: Path) -> None:
    tried = 0
    for device in model.devices:
        numbers = [n for e in device.errors if e.kind == "device" for n in (e.number, e.last)]
        if not numbers or device.drive is None:
            continue
        used = 0
        for number in numbers:
            used |= number
        free = sum(field.mask for _, field in device.drive.error_fields if not field.mask & used)
        drive = device.drive.id
        body, expected = "", {}
        for number in numbers:
            for other in (0, free, free & 0x5A5A5A5A):
                reported = number | other
                body += (
                    f'    printf("{reported}=%lu\\n", '
                    f"(unsigned long){device.id}_find_reported_error(UINT32_C({reported}))->first);\n"
                )
                expected[str(reported)] = next(e.number for e in device.errors if e.number <= number <= e.last)
                tried += 1
            for label, field in device.drive.error_fields:
                function = f"{snake(drive)}_error_{snake(label)}"
                body += f'    printf("{function} {number}=%lu\\n", (unsigned long){function}(UINT32_C({number})));\n'
                expected[f"{function} {number}"] = number >> field.low & 2 ** (field.high - field.low + 1) - 1
        body = "".join(dict.fromkeys(body.splitlines(keepends=True)))
        assert_same(result(tmp_path, c, [f"{device.id}_tables.h"], body), dict(expected))
    assert tried


# COB-IDs.


def test_cob_ids_of_each_node_and_of_no_other(model: Model, c: Path, tmp_path: Path) -> None:
    body, expected = "    uint32_t value = 0u;\n", {}
    for entry in model.cob_ids:
        if entry.broadcast:
            continue
        macro = f"DRIVESPEC_COB_ID_{screaming(entry.name)}_BASE"
        body += (
            "    for (uint32_t node = 0u; node <= 600u; node++) {\n"
            "        value = 9u;\n"
            f"        const int done = (int)drivespec_at_node({macro}, node, &value);\n"
            f'        printf("{entry.name} %lu=%d %lu\\n", (unsigned long)node, done, (unsigned long)value);\n'
            "    }\n"
        )
        for node in range(601):
            legal = node in model.node_addresses
            expected[f"{entry.name} {node}"] = f"1 {entry.base + node}" if legal else "0 9"
    assert expected
    assert_same(result(tmp_path, c, ["drivespec.h"], body), dict(expected))


def test_comments_tell_broadcasts_from_bases(model: Model, c: Path) -> None:
    text = (c / "include/drivespec/drivespec.h").read_text(encoding="ascii")
    for entry in model.cob_ids:
        comment = re.search(rf"DRIVESPEC_COB_ID_{screaming(entry.name)}(_BASE)? .*///< (.*)", text)
        assert comment
        assert ("broadcast: the whole COB-ID" in comment[2]) == entry.broadcast
        assert ("less the node address" in comment[2]) != entry.broadcast


# Codes.


def test_numbers_and_indexes_that_are_none(model: Model, c: Path, tmp_path: Path) -> None:
    """They give 0, which no code has for a number or an index; nothing wraps around."""
    assert all(code.number and code.index for device in model.devices for code in device.codes)
    body = ""
    expected: dict[str, int | str] = {}
    for drive in model.drives:
        for function in (f"{snake(drive.id)}_index", f"{snake(drive.id)}_code"):
            body += (
                "    for (uint32_t n = 0u; n <= 0xFFFFu; n++) {\n"
                f'        printf("{function} %lu=%u\\n", (unsigned long)n, (unsigned){function}((uint16_t)n));\n'
                "    }\n"
            )
            expected |= {f"{function} {n}": max(drive.index_base - n, 0) for n in range(2**16)}
    assert expected
    assert_same(result(tmp_path, c, ["drivespec.h"], body), dict(expected))


def test_index_and_slot_of_each_code(model: Model, c: Path, tmp_path: Path) -> None:
    for device in model.devices:
        if not device.codes:
            continue
        assert device.drive is not None
        drive, stem = snake(device.drive.id), device.id
        body = (
            "    for (uint32_t n = 0u; n <= 0xFFFFu; n++) {\n"
            f"        const drivespec_code *const code = {stem}_find_code_by_index((uint16_t)n);\n"
            "        if (code != NULL) {\n"
            '            printf("index %lu=%u\\n", (unsigned long)n, (unsigned)code->number);\n'
            f'            printf("code %lu=%u\\n", (unsigned long)n, (unsigned){drive}_code((uint16_t)n));\n'
            f'            printf("back %u=%u\\n", (unsigned)code->number, (unsigned){drive}_index(code->number));\n'
        )
        expected: Values = {}
        for slot in device.slots:
            function = snake(device.id, "code_in", slot.name)
            body += f'            printf("{function} %u=%u\\n", (unsigned)code->number, '
            body += f"(unsigned){function}(code->number));\n"
            twins = {(code.twin_of, code.slot): code.number for code in device.codes}
            expected |= {
                f"{function} {code.number}": twins[code.twin_of, code.slot and slot.name] for code in device.codes
            }
        body += "        }\n    }\n"
        for code in device.codes:
            expected |= {f"index {code.index}": code.number, f"code {code.index}": code.number}
            expected[f"back {code.number}"] = code.index
        assert_same(result(tmp_path, c, [f"{stem}_tables.h"], body), expected)


def test_codes_by_name_through_all_slots(model: Model, c: Path, tmp_path: Path) -> None:
    for device in model.devices:
        if not device.codes:
            continue
        body = (
            f"    for (size_t i = 0u; i < {screaming(device.id)}_CODE_COUNT; i++) {{\n"
            f"        const char *const name = {device.id}_code_text({device.id}_codes[i].name);\n"
            "        const drivespec_code *code = NULL;\n"
            '        printf("%u=", (unsigned)i);\n'
            f"        while ((code = {device.id}_find_code_by_name(name, code)) != NULL) {{\n"
            '            printf("%u;", (unsigned)code->number);\n'
            "        }\n"
            '        printf("\\n");\n'
            "    }\n"
            f'    printf("none=%d\\n", (int)({device.id}_find_code_by_name("", NULL) == NULL));\n'
        )
        expected: Values = {
            str(place): "".join(f"{other.number};" for other in device.codes if other.name == code.name)
            for place, code in enumerate(device.codes)
        }
        assert_same(result(tmp_path, c, [f"{device.id}_tables.h"], body), expected | {"none": 1})


def bounds(code: Code) -> tuple[Fraction, Fraction] | None:
    """Range of a code in its unit."""
    held = holds(code)
    if code.range is not None:
        return code.range.low, code.range.high
    return held and (Fraction(held[0], code.scaling or 1), Fraction(held[1], code.scaling or 1))


def holds(code: Code) -> tuple[int, int] | None:
    """Least and largest wire value of the data type, as far as 64 bits with sign hold it."""
    kind = code.data_type
    return (kind.lowest, min(kind.highest, 2**63 - 1)) if kind.is_number else None


def nearest(value: Fraction) -> int:
    """Nearest whole number, halves away from 0."""
    return int(abs(value) + Fraction(1, 2)) * (-1 if value < 0 else 1)


def test_values_to_wire_values(model: Model, c: Path, tmp_path: Path) -> None:
    """The range is that of the value, not of the wire value that it would be rounded to."""
    rounded_into_range = 0
    for device in model.devices:
        body, expected = "    int64_t wire = 0;\n", {}
        for code in device.codes:
            limits, factor = bounds(code), code.scaling or 1
            ends = [0, 1] if limits is None else [floor(end * factor) for end in (*limits, sum(limits) / 2)]
            steps = (-1, -0.6, -0.4, 0, 0.4, 0.5 if factor == 1 else 0.6, 1)
            for value in sorted({(end + step) / factor for end in ends for step in steps if abs(end) < 2**40}):
                inside = limits is not None and float(limits[0]) <= value <= float(limits[1])
                wire = nearest(Fraction(value) * factor)
                if limits is not None and not inside:
                    rounded_into_range += limits[0] <= Fraction(wire, factor) <= limits[1]
                key = f"{code.number} {value!r}"
                body += f'    wire = 99;\n    printf("{key}=%d ", '
                body += f"(int)drivespec_to_wire({device.id}_find_code({code.number}u), {value!r}, &wire));\n"
                body += '    printf("%lld\\n", (long long)wire);\n'
                expected[key] = f"{int(inside)} {wire if inside else 99}"
        if device.codes:
            assert_same(result(tmp_path, c, [f"{device.id}_tables.h"], body), dict(expected))
    assert rounded_into_range


def test_wire_values_to_values(model: Model, c: Path, tmp_path: Path) -> None:
    """A drive may hold a value outside of the range of its setting; only what the data type cannot hold is refused."""
    outside = 0
    for device in model.devices:
        body, expected = "    double value = 0.0;\n", {}
        for code in device.codes:
            limits, held, factor = bounds(code), holds(code), code.scaling or 1
            ends = [*(floor(end * factor) for end in limits or ()), *(held or ()), 0]
            for wire in sorted({end + step for end in ends for step in (-1, 0, 1)}):
                if abs(wire) > 2**40:
                    continue
                fits = held is not None and held[0] <= wire <= held[1]
                outside += fits and limits is not None and not limits[0] <= Fraction(wire, factor) <= limits[1]
                key = f"{code.number} {wire}"
                body += "    value = 0.3125;\n"
                body += f'    printf("{key}=%d ", (int)drivespec_from_wire({device.id}_find_code({code.number}u), '
                body += f'INT64_C({wire}), &value));\n    printf("%.17g\\n", value);\n'
                expected[key] = f"{int(fits)} {wire / factor if fits else 0.3125:.17g}"
        if device.codes:
            assert_same(result(tmp_path, c, [f"{device.id}_tables.h"], body), dict(expected))
    assert outside


def test_values_beside_their_limits_and_between_wire_values(model: Model, c: Path, tmp_path: Path) -> None:
    device = next(d for d in model.devices if d.codes)
    cases = [
        # Least and largest wire value, scaling, value, wire value: 0.29 * 100 is less than 29 in double.
        (29, 57, 100, "0.29", 29),
        (29, 57, 100, "0.57", 57),
        (29, 57, 100, "0.2899999", None),
        (29, 57, 100, "0.5700001", None),
        (250, 1000, 0, "249.6", None),
        (250, 1000, 0, "250.4", 250),
        (250, 1000, 0, "1000.4", None),
        # Where adding a half is not exact.
        (-(2**60), 2**60, 1, "0.49999999999999994", 0),
        (-(2**60), 2**60, 1, "4503599627370497.0", 2**52 + 1),
        (-(2**60), 2**60, 1, "-4503599627370497.0", -(2**52) - 1),
        (-(2**60), 2**60, 1, "-0.5", -1),
    ]
    body = (
        f"    drivespec_code code = {device.id}_codes[0];\n    int64_t wire = 0;\n    code.has = DRIVESPEC_HAS_RANGE;\n"
    )
    expected: Values = {}
    for low, high, scaling, value, wire in cases:
        body += f"    code.min = INT64_C({low});\n    code.max = INT64_C({high});\n    code.scaling = {scaling}u;\n"
        body += f'    wire = 9;\n    printf("{low} {value}=%d ", (int)drivespec_to_wire(&code, {value}, &wire));\n'
        body += '    printf("%lld\\n", (long long)wire);\n'
        expected[f"{low} {value}"] = "0 9" if wire is None else f"1 {wire}"
    for wire in (249, 250, 1000, 1001):
        body += "    code.min = 250;\n    code.max = 1000;\n"
        body += f'    printf("{wire}=%d\\n", (int)drivespec_in_range(&code, {wire}));\n'
        expected[str(wire)] = int(250 <= wire <= 1000)
    assert_same(result(tmp_path, c, [f"{device.id}_tables.h"], body), expected)


def test_values_that_no_wire_value_is_near_to(model: Model, c: Path, tmp_path: Path) -> None:
    device = next(d for d in model.devices if any(code.range for code in d.codes))
    code = next(code for code in device.codes if code.range)
    record = f"{device.id}_find_code({code.number}u)"
    body = "    int64_t wire = 7;\n    double zero = 0.0;\n"
    for name, text in (("nan", "zero / zero"), ("inf", "1.0e300 * 1.0e300"), ("minus", "-1.0e300")):
        body += f'    printf("{name}=%d\\n", (int)drivespec_to_wire({record}, {text}, &wire));\n'
    body += '    printf("wire=%lld\\n", (long long)wire);\n'
    body = body.replace("1.0e300 * 1.0e300", "1.0e300")
    assert result(tmp_path, c, [f"{device.id}_tables.h"], body) == {
        "nan": 0,
        "inf": 0,
        "minus": 0,
        "wire": 7,
    }


# The panel.


def switch_value(group: SwitchGroup, positions: str) -> int | None:
    if group.weights:
        low, high = group.valid or (0, sum(group.weights))
        total = group.sum(positions)
        return total if low <= total <= high else None
    text = switch_text(group, positions)
    return int(text) if text is not None and text.isdigit() else None


def switch_text(group: SwitchGroup, positions: str) -> str | None:
    fitting = [
        row.value for row in group.rows if all(a in ("x", b) for a, b in zip(row.positions, positions, strict=True))
    ]
    return fitting[0] if fitting else None


def switch_program(device: Device) -> tuple[str, Values]:
    body = ""
    expected: Values = {}
    for group in device.switches:
        name, count = snake(device.id, "switch", group.id), len(group.labels)
        body += (
            f"    for (uint32_t at = 0u; at < {2 ** (count + 1)}u; at++) {{\n"
            "        uint32_t value = 0u, back = 0u;\n"
            f"        const drivespec_switch_row *const row = {name}_row(at);\n"
            f'        printf("{name} row %lu=%s\\n", (unsigned long)at, row != NULL ? row->text : "-");\n'
            f"        if ({name}_value(at, &value)) {{\n"
            f'            printf("{name} value %lu=%lu\\n", (unsigned long)at, (unsigned long)value);\n'
            f"            if ({name}_position(value, &back)) {{\n"
            f'                printf("{name} back %lu=%lu\\n", (unsigned long)at, (unsigned long)back);\n'
            "            }\n"
            "        }\n"
            "    }\n"
            "    {\n"
            "        uint32_t kept = 42u;\n"
            f'        printf("{name} absurd=%d\\n", (int){name}_position(UINT32_C(4000000000), &kept) + (int)kept);\n'
            "    }\n"
        )
        expected[f"{name} absurd"] = 42
        least: dict[int, int] = {}
        for at in range(2 ** (count + 1)):
            positions = f"{at:0{count}b}"
            if len(positions) > count:
                expected[f"{name} row {at}"] = "-"
                continue
            text = switch_text(group, positions)
            expected[f"{name} row {at}"] = "-" if text is None else int(text) if text.isdigit() else text
            value = switch_value(group, positions)
            if value is not None:
                expected[f"{name} value {at}"] = value
                expected[f"{name} back {at}"] = least.setdefault(value, at)
        for bit, label in enumerate(reversed(group.labels)):
            macro = f"{name.upper()}_{screaming(label)}"
            body += f'    printf("{macro}=%lu\\n", (unsigned long){macro});\n'
            expected[macro] = 2**bit
    return body, expected


def literal(pattern: Pattern) -> str:
    period, pause = (int(1000 * (seconds or 0)) for seconds in (pattern.period, pattern.pause))
    return (
        f'{{ "{pattern.colour or ""}", {period}u, {pause}u, {LIGHTS.index(pattern.light)}u, {pattern.flashes or 0}u }}'
    )


def agree(printed: Pattern, seen: Pattern) -> bool:
    """Whether two patterns may be one: nothing that both tell is different."""
    if Light.ANY in (printed.light, seen.light):
        return True
    meant = [{Light.ON, Light.FLICKER} if it.light is Light.ON_OR_FLICKER else {it.light} for it in (printed, seen)]
    told = [(getattr(printed, key), getattr(seen, key)) for key in ("colour", "period", "flashes", "pause")]
    return bool(meant[0] & meant[1]) and all(not a or not b or a == b for a, b in told)


def fitting_rows(table: IndicatorTable, seen: tuple[Pattern, ...]) -> list[int]:
    """Places of the rows that fit."""
    pairs = [zip(row.patterns, seen, strict=True) for row in table.rows]
    return [place for place, row in enumerate(pairs) if all(agree(*pair) for pair in row)]


def sights(table: IndicatorTable) -> Iterator[tuple[Pattern, ...]]:
    """What may be seen of LEDs: what is printed, less of it, and what is printed nowhere."""
    for row in table.rows:
        yield row.patterns
        yield tuple(replace(pattern, period=None) for pattern in row.patterns)
        yield tuple(replace(pattern, flashes=None, pause=None) for pattern in row.patterns)
        for colour in dict.fromkeys([None, *(pattern.colour for one in table.rows for pattern in one.patterns)]):
            yield tuple(replace(pattern, colour=colour) for pattern in row.patterns)
        yield tuple(replace(pattern, period=Fraction(7), flashes=7, pause=Fraction(7)) for pattern in row.patterns)
        for place in range(len(table.leds)):
            yield (*row.patterns[:place], Pattern(Light.ANY), *row.patterns[place + 1 :])
    for light in Light:
        yield (Pattern(light),) * len(table.leds)


def led_program(device: Device) -> tuple[str, Values]:
    body = ""
    expected: Values = {}
    for table in device.indicators:
        name = snake(device.id, "led", table.id)
        body += f'    printf("{name} leds=%u\\n", (unsigned){name.upper()}_COUNT);\n'
        expected[f"{name} leds"] = len(table.leds)
        for place, seen in enumerate(dict.fromkeys(sights(table))):
            fitting = [
                at
                for at, row in enumerate(table.rows)
                if all(agree(*pair) for pair in zip(row.patterns, seen, strict=True))
            ]
            body += (
                "    {\n"
                f"        const drivespec_pattern seen[] = {{ {', '.join(map(literal, seen))} }};\n"
                f"        const {name}_row *row = {name}_find(seen);\n"
                f'        printf("{name} {place}=%d:", row != NULL ? (int)(row - {name}_rows) : -1);\n'
                "        row = NULL;\n"
                f"        while ((row = {name}_next(seen, row)) != NULL) {{\n"
                f'            printf(" %d", (int)(row - {name}_rows));\n'
                "        }\n"
                '        printf("\\n");\n'
                "    }\n"
            )
            alone = fitting[0] if len(fitting) == 1 else -1
            expected[f"{name} {place}"] = "".join([f"{alone}:", *(f" {at}" for at in fitting)])
    return body, expected


@pytest.mark.parametrize(("compiler", "standard"), COMPILERS)
def test_switches_and_leds(model: Model, c: Path, tmp_path: Path, compiler: str, standard: str) -> None:
    devices = [device for device in model.devices if device.switches or device.indicators]
    assert any(device.switches for device in devices)
    for device in devices:
        switches, settings = switch_program(device)
        leds, states = led_program(device)
        printed = result(tmp_path, c, [f"{device.id}_panel.h"], switches + leds, compiler, standard)
        assert_same(printed, settings | states)


def test_led_patterns_that_fit_no_row_one_and_several(model: Model) -> None:
    """The tables of the manuals have all three, so that the test above tells them apart."""
    found = {str(value) for device in model.devices for value in led_program(device)[1].values()}
    assert "-1:" in found
    assert any(value.startswith("-1: ") for value in found)
    assert any(value.startswith("0: 0") for value in found)


def test_leds_of_several_colours(model: Model, tmp_path: Path) -> None:
    device, table = next((d, t) for d in model.devices for t in d.indicators if len(t.rows) > 1)
    rows = [
        replace(row, patterns=tuple(replace(pattern, colour=colour) for pattern in row.patterns))
        for row in table.rows
        for colour in ("red", "green", None)
    ]
    coloured = replace(device, indicators=(replace(table, rows=tuple(rows)),))
    body, expected = led_program(coloured)
    c = write(tmp_path / "c", replace(model, devices=(coloured,)))
    assert_same(result(tmp_path, c, [f"{device.id}_panel.h"], body), expected)


def test_leds_are_asked_for_all_at_once(model: Model, c: Path) -> None:
    """The prototype holds how many patterns are read."""
    for device in model.devices:
        for table in device.indicators:
            name = snake(device.id, "led", table.id)
            text = (c / f"include/drivespec/{device.id}_panel.h").read_text(encoding="ascii")
            for function in ("next", "find"):
                assert f"{name}_{function}(const drivespec_pattern seen[{name.upper()}_COUNT]" in text
