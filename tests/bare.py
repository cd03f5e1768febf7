"""A device without anything that a device may lack."""

from dataclasses import replace

from generator.model import Device


def bare(device: Device) -> Device:
    """The device with its identity alone, under the id "bare"."""
    return replace(
        device,
        id="bare",
        drive=None,
        hardware_version=None,
        software_version=None,
        slots=(),
        canopen=None,
        gsd=None,
        attributes=None,
        codes=(),
        objects=(),
        errors=(),
        indicators=(),
        switches=(),
        tables=(),
        formulas=(),
        layouts=(),
        services=(),
        examples=(),
        errata=(),
    )
