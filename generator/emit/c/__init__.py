"""C headers (C99, valid C++17): constants of every device, its records on demand, self-tests.

``include/drivespec/drivespec.h`` holds the types of the records and the facts that devices share, ``<device>.h`` the
constants of a device, ``<device>_tables.h`` its records, ``<device>_telegrams.h`` its codecs, ``<device>_panel.h`` its
DIP switches and LEDs.  ``test/<header>_selftest.c`` prints every constant and every field of every record as
``NAME=value`` and tries the lookups and the worked telegrams.  Beside them stands what makes them a package.
"""

from generator.emit.base import Output, Target
from generator.emit.c.common import common_header
from generator.emit.c.device import device_header
from generator.emit.c.package import package
from generator.emit.c.panel import device_panel, shared_panel
from generator.emit.c.tables import Tables, device_tables
from generator.emit.c.telegrams import Telegrams, device_telegrams, runtime
from generator.emit.c.writer import Header, Names
from generator.emit.environment import license_text
from generator.emit.environment import render as render_template
from generator.model import Model

__all__ = ["TARGET", "render"]

_INCLUDE = "include/drivespec"


def render(model: Model) -> dict[str, Output]:
    """Headers and self-tests of all devices.

    Raises:
        EmitError: Rule "name-collision", when two facts would get one name.
    """
    names = Names()
    common = common_header(model, names)
    files = {
        f"{_INCLUDE}/{common.file}": _ascii("c/drivespec.h.j2", header=common),
        "test/drivespec_selftest.c": _selftest(common, None),
    }
    if any(device.layouts for device in model.devices):
        files[f"{_INCLUDE}/telegram.h"] = _ascii("c/telegram.h.j2", header=runtime(model, names))
    if any(device.switches or device.indicators for device in model.devices):
        files[f"{_INCLUDE}/panel.h"] = _ascii("c/panel.h.j2", header=shared_panel(model, names))
    for device in model.devices:
        header = device_header(model, device, names)
        tables = device_tables(model, device, names)
        files[f"{_INCLUDE}/{header.file}"] = _ascii("c/device.h.j2", header=header)
        files[f"{_INCLUDE}/{tables.file}"] = _ascii("c/tables.h.j2", tables=tables)
        files[f"test/{device.id}_selftest.c"] = _selftest(header, tables)
        if device.switches or device.indicators:
            panel = device_panel(model, device, names)
            files[f"{_INCLUDE}/{panel.file}"] = _ascii("c/device_panel.h.j2", panel=panel)
        if device.layouts:
            files |= _telegrams(device_telegrams(model, device, names))
    parts = package(model)
    for name in ("CMakeLists.txt", "drivespec.pc.in", "README.md"):
        files[name] = _ascii(f"c/{name}.j2", package=parts)
    files["LICENSE"] = Output(license_text())
    return files


def _telegrams(telegrams: Telegrams) -> dict[str, Output]:
    """Codecs of a device with their tests."""
    stem = f"test/{telegrams.device}_telegrams"
    return {
        f"{_INCLUDE}/{telegrams.file}": _ascii("c/telegrams.h.j2", telegrams=telegrams),
        f"{stem}_selftest.c": _ascii("c/telegrams_selftest.c.j2", telegrams=telegrams),
        f"{stem}_driver.c": _ascii("c/telegrams_driver.c.j2", telegrams=telegrams),
        f"{stem}_fuzz.c": _ascii("c/telegrams_fuzz.c.j2", telegrams=telegrams),
    }


def _selftest(header: Header, tables: Tables | None) -> Output:
    constants = tuple(header.constants)
    return _ascii(
        "c/selftest.c.j2",
        header=header,
        tables=tables,
        numbers=[constant.name for constant in constants if not constant.is_text],
        texts=[constant.name for constant in constants if constant.is_text],
    )


def _ascii(template: str, **view: object) -> Output:
    return Output(render_template(template, **view), encoding="ascii")


TARGET = Target("c", render)
