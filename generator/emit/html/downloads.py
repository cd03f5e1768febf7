"""Files to take away, each with what it is, its size and its digest."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from generator.emit import eds, gsd, xdd
from generator.emit.canopen import ObjectDictionary, object_dictionaries
from generator.model import Device, Model

FOLDER = "files"
"""Folder of the files, beside the pages."""

_LANGUAGES = {"en": "English", "de": "German"}
_THIN = "\N{NARROW NO-BREAK SPACE}"
_HEADERS = "c/include/drivespec/"
_HEADER_KINDS = {
    "": "constants",
    "tables": "records and lookups",
    "telegrams": "codecs of the telegrams",
    "panel": "DIP switches and LEDs",
}
_SHARED_HEADERS = {
    "drivespec.h": "types and shared facts, needed by all headers",
    "telegram.h": "needed by the codecs of telegrams",
    "panel.h": "needed by DIP switches and LEDs",
}
_PACKAGES = {
    "drivespec-c-": (
        "C and C++",
        "C99 headers that are valid C++17: constants, lookups, codecs of the telegrams; a CMake package",
        "cmake -S {stem} -B build && cmake --install build",
    ),
    "drivespec-devices-python-": (
        "Python",
        "typed package without dependencies: enums, records, lookups, codecs of the telegrams",
        "pip install ./{name}",
    ),
    "drivespec-devices-rust-": (
        "Rust",
        "crate for programs with or without an operating system (no_std): the same",
        'drivespec-devices = {{ path = "{stem}" }}',
    ),
}
"""Language, contents and use of an archive, by the beginning of its name."""


@dataclass(frozen=True, slots=True)
class Stored:
    """What is known of a file beside its name: bytes, and SHA-256 in hexadecimal."""

    size: int
    digest: str


Offered = Mapping[str, Stored]
"""Files of the site by their path below ``FOLDER``."""

NO_FILES: Offered = {}


@dataclass(frozen=True, slots=True)
class Download:
    """A file; ``use`` is the line that takes it into a project, "" where there is no such line."""

    name: str
    href: str
    what: str
    size: str
    digest: str
    use: str = ""


@dataclass(frozen=True, slots=True)
class DownloadGroup:
    """Files for one purpose."""

    id: str
    title: str
    files: tuple[Download, ...]


def device_downloads(device: Device, offered: Offered, start: str = "") -> tuple[DownloadGroup, ...]:
    """Files of a device in groups; ``start`` begins the ids of the groups."""
    groups = (
        DownloadGroup(f"{start}masters", "For bus masters", tuple(_masters(device, offered))),
        DownloadGroup(f"{start}headers", "C headers, file by file", tuple(_headers(device, offered))),
        DownloadGroup(f"{start}data", "Every fact as data", tuple(_data(device, offered))),
    )
    return tuple(group for group in groups if group.files)


def packages(offered: Offered) -> tuple[DownloadGroup, ...]:
    """The archives of the libraries, which hold every device."""
    found = tuple(
        _download(offered, name, f"{language}: {what}", use.format(name=name, stem=name.removesuffix(".zip")))
        for start, (language, what, use) in _PACKAGES.items()
        for name in offered
        if name.startswith(start)
    )
    return (DownloadGroup("packages", "Libraries with every device", found),) if found else ()


def shared_files(offered: Offered) -> tuple[DownloadGroup, ...]:
    """What the files of several devices need beside them."""
    headers = ((f"{_HEADERS}{name}", what) for name, what in _SHARED_HEADERS.items())
    names = (*headers, ("json/schema.json", "JSON Schema of the data"))
    found = tuple(_download(offered, path, what) for path, what in names if path in offered)
    return (DownloadGroup("shared", "Shared by the devices", found),) if found else ()


def all_downloads(model: Model, offered: Offered) -> tuple[DownloadGroup, ...]:
    """Every file of the site, those of a device after the libraries."""
    groups = [*packages(offered), *shared_files(offered)]
    for device in model.devices:
        files = [file for group in device_downloads(device, offered) for file in group.files]
        if files:
            groups.append(DownloadGroup(device.id, device.title, tuple(files)))
    return tuple(groups)


def label_of(dictionary: ObjectDictionary) -> str:
    """Slot and product of an EDS file, the device where there are neither."""
    parts = (f"slot {dictionary.slot}" if dictionary.slot else "", dictionary.product.label)
    return ", ".join(part for part in parts if part) or dictionary.device.title


def language_of(name: str) -> str:
    """Language of the texts of a GSD file, by the name that the target gives it."""
    return _LANGUAGES.get(name, name)


def path_of(file: str) -> str:
    """Address of a file as seen from the pages."""
    return f"{FOLDER}/{file}"


def _download(offered: Offered, path: str, what: str, use: str = "") -> Download:
    stored = offered[path]
    size = f"{stored.size:,}".replace(",", _THIN)
    return Download(path.rpartition("/")[2], path_of(path), what, f"{size} bytes", stored.digest, use)


def _masters(device: Device, offered: Offered) -> Iterator[Download]:
    dictionaries = object_dictionaries(device)
    for format_name, name_of in (("EDS", eds.file_name), ("XDD", xdd.file_name)):
        for dictionary in dictionaries:
            path = f"{format_name.lower()}/{name_of(dictionary)}"
            if path in offered:
                yield _download(offered, path, f"{format_name}, {label_of(dictionary)}")
    for place, (name, language) in enumerate(gsd.file_names(device.gsd) if device.gsd else ()):
        if f"gsd/{name}" in offered:
            use = (
                "the default file; in doubt, take this one" if place == 0 else "for tools that are set to this language"
            )
            yield _download(offered, f"gsd/{name}", f"GSD, {language_of(language)}, {use}")


def _headers(device: Device, offered: Offered) -> Iterator[Download]:
    for kind, what in _HEADER_KINDS.items():
        path = f"{_HEADERS}{'_'.join(part for part in (device.id, kind) if part)}.h"
        if path in offered:
            yield _download(offered, path, f"C header: {what}")


def _data(device: Device, offered: Offered) -> Iterator[Download]:
    path = f"json/{device.id}.json"
    if path in offered:
        yield _download(offered, path, "JSON: codes, objects, errors, LEDs, switches, telegrams, tables, errata")
