"""The C package as others use it: README, CMake, pkg-config, a project of its own."""

import os
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest
from test_c import COMPILERS, compile_c, tool

from generator.model import Model


@pytest.fixture(scope="session")
def c(generated: Path) -> Path:
    """The folder of the target."""
    return generated / "c"


def done(*command: object, **environment: str) -> str:
    """Output of a command that must succeed."""
    finished = subprocess.run(
        [str(part) for part in command],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, **environment},
    )
    assert finished.returncode == 0, finished.stdout + finished.stderr
    return finished.stdout + finished.stderr


@pytest.fixture(scope="session")
def installed(c: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the package is installed, after its own tests ran."""
    if shutil.which("cmake") is None:
        pytest.fail("install CMake (cmake is not on the PATH)")
    folder = tmp_path_factory.mktemp("c-package")
    build, prefix = folder / "build", folder / "prefix"
    done("cmake", "-S", c, "-B", build, f"-DCMAKE_INSTALL_PREFIX={prefix}")
    done("cmake", "--build", build)
    listing = done("ctest", "--test-dir", build)
    assert "100% tests passed" in listing
    done("cmake", "--install", build)
    return prefix


def test_the_package_holds_every_header(c: Path, installed: Path) -> None:
    headers = {path.name for path in (c / "include/drivespec").iterdir()}
    assert {path.name for path in (installed / "include/drivespec").iterdir()} == headers
    assert any(name.endswith("_telegrams.h") for name in headers)
    assert (installed / "share/licenses/drivespec/LICENSE").read_bytes() == (c / "LICENSE").read_bytes()


def test_every_self_test_is_registered(c: Path) -> None:
    listed = set(re.findall(r"^ {12}(\w+)$", (c / "CMakeLists.txt").read_text(encoding="ascii"), re.MULTILINE))
    assert listed == {path.stem for path in (c / "test").iterdir() if not path.stem.endswith("_driver")}


def test_a_project_that_finds_the_package(root: Path, installed: Path, tmp_path: Path) -> None:
    source = root / "tests/consumers/c"
    done("cmake", "-S", source, "-B", tmp_path, f"-DCMAKE_PREFIX_PATH={installed}")
    done("cmake", "--build", tmp_path)
    assert done(tmp_path / "consumer").splitlines() == ["C00061", "43 C2 5F 00 2B 00 00 00", "truncated", "node 5"]
    assert done(tmp_path / "consumer_cpp").splitlines() == ["66: 1234", "65: 56"]


def test_another_version_is_not_taken(model: Model, root: Path, installed: Path, tmp_path: Path) -> None:
    major, minor, _ = (int(part) for part in model.version.split("."))
    project = tmp_path / "project"
    project.mkdir()
    for wanted, found in ((f"{major}.{minor}", True), (f"{major}.{minor + 1}", False), (f"{major + 1}.0", False)):
        (project / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.14)\nproject(p LANGUAGES NONE)\n"
            f'find_package(drivespec {wanted} QUIET)\nmessage(STATUS "found=${{drivespec_FOUND}}")\n'
        )
        said = done("cmake", "-S", project, "-B", tmp_path / f"build{wanted}", f"-DCMAKE_PREFIX_PATH={installed}")
        assert re.search(r"found=(\d)", said.replace("found=TRUE", "found=1").replace("found=FALSE", "found=0"))
        assert ("found=1" in said or "found=TRUE" in said) is found, wanted


def test_pkg_config(model: Model, root: Path, installed: Path, tmp_path: Path) -> None:
    if shutil.which("pkg-config") is None:
        pytest.fail("install pkg-config (it is not on the PATH)")
    search = {"PKG_CONFIG_PATH": str(installed / "share/pkgconfig")}
    assert done("pkg-config", "--modversion", "drivespec", **search).strip() == model.version
    flags = shlex.split(done("pkg-config", "--cflags", "drivespec", **search))
    done(tool("cc"), *flags, root / "tests/consumers/c/main.c", "-o", tmp_path / "program")
    assert done(tmp_path / "program").startswith("C00061")


@pytest.mark.parametrize(("compiler", "standard"), COMPILERS)
def test_the_example_of_the_readme(model: Model, c: Path, tmp_path: Path, compiler: str, standard: str) -> None:
    blocks = re.findall(r"```c\n(.*?)```", (c / "README.md").read_text(encoding="ascii"), re.DOTALL)
    assert len(blocks) == 1
    source = tmp_path / "readme.c"
    source.write_text(blocks[0])
    printed = done(compile_c(tmp_path, source, compiler, standard, f"-I{c / 'include'}")).splitlines()
    device = next(device for device in model.devices if f'"drivespec/{device.id}_tables.h"' in blocks[0])
    octets = tuple(int(octet, 16) for octet in re.findall(r"0x([0-9A-F]{2})[, ]", blocks[0].partition(";")[0]))
    example = next(example for example in device.examples if example.data == octets)
    values = [f"{name}: {value}" for name, value in example.values.items() if "." not in name]
    error = next(error for error in device.errors if error.kind == "device")
    assert printed == [*values, device.codes[0].name, error.name]


def test_fuzz_targets_without_libfuzzer_are_left_out_with_a_word(c: Path, tmp_path: Path) -> None:
    if shutil.which("cmake") is None:
        pytest.fail("install CMake (cmake is not on the PATH)")
    said = done("cmake", "-S", c, "-B", tmp_path, "-DDRIVESPEC_FUZZ=ON", "-DCMAKE_C_COMPILER=cc")
    found = "DRIVESPEC_HAS_LIBFUZZER - Success" in said
    assert found or "no fuzz targets" in said
