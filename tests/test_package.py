"""Wheel and sdist: built as a release is, with all that is needed and nothing else, installed into an empty environment."""

import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest

import clamber

ROOT = Path(__file__).parent.parent
VERSION = clamber.__version__


@pytest.fixture(scope="session")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Wheel and sdist, built from a copy: a build leaves folders beside the sources."""
    pytest.importorskip("build", reason="comes with the extra `dev`")
    folder = tmp_path_factory.mktemp("package")
    source = folder / "source"
    leave = shutil.ignore_patterns(
        ".git", ".venv", "out", "build", "dist", "*.egg-info", "__pycache__", ".*_cache", ".hypothesis"
    )
    shutil.copytree(ROOT, source, ignore=leave)
    words = [sys.executable, "-m", "build", "--no-isolation", "--outdir", str(folder / "dist"), str(source)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    return folder / "dist"


@pytest.mark.slow
def test_a_wheel_has_every_module_every_data_file_and_its_types(built: Path) -> None:
    with zipfile.ZipFile(built / f"clamber-{VERSION}-py3-none-any.whl") as wheel:
        names = set(wheel.namelist())
        metadata = wheel.read(f"clamber-{VERSION}.dist-info/METADATA").decode()
        entries = wheel.read(f"clamber-{VERSION}.dist-info/entry_points.txt").decode()
    package = ROOT / "src" / "clamber"
    wanted = {
        path.relative_to(package.parent).as_posix()
        for path in package.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert wanted - names == set(), "these are not in the wheel"
    assert "clamber/py.typed" in names
    ours = {name for name in names if not name.startswith((f"clamber-{VERSION}.dist-info/", "clamber/"))}
    assert ours == set(), "a wheel has the package alone"
    assert f"Version: {VERSION}" in metadata and "License-Expression: Apache-2.0" in metadata
    assert any(name.endswith("licenses/LICENSE") for name in names)
    assert "clamber = clamber.cli:main" in entries


@pytest.mark.slow
def test_an_sdist_has_what_a_wheel_is_built_from(built: Path) -> None:
    with tarfile.open(built / f"clamber-{VERSION}.tar.gz") as sdist:
        names = {Path(name).relative_to(f"clamber-{VERSION}").as_posix() for name in sdist.getnames()}
    assert {"pyproject.toml", "README.md", "LICENSE", "src/clamber/py.typed", "src/clamber/cli/app.py"} <= names


@pytest.mark.slow
def test_it_installs_into_an_empty_environment_and_works_there(built: Path, tmp_path: Path) -> None:
    """What it depends on is lent by this environment, so that nothing is fetched; Clamber itself is the wheel's."""
    venv = tmp_path / "venv"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(venv)], check=True)
    python = venv / "bin" / "python"
    wheel = built / f"clamber-{VERSION}-py3-none-any.whl"
    install = [
        sys.executable,
        "-m",
        "pip",
        "--python",
        str(python),
        "install",
        "-q",
        "--no-index",
        "--no-deps",
        str(wheel),
    ]
    subprocess.run(install, check=True, capture_output=True)
    site = next((venv / "lib").glob("python*/site-packages"))
    (site / "lent.pth").write_text(sysconfig.get_paths()["purelib"] + "\n")
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    environment |= {"CLAMBER_CACHE": str(tmp_path / "cache"), "COLUMNS": "80"}

    def run(*words: str) -> str:
        command = [str(venv / "bin" / "clamber"), *words]
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert run("--version") == f"clamber {VERSION}\n"
    where = subprocess.run(
        [python, "-c", "import clamber; print(clamber.__file__)"], env=environment, capture_output=True, text=True
    )
    assert Path(where.stdout.strip()).is_relative_to(venv)
    assert "libra" in run("list")
    assert "nothing is odd" in run("check", "libra")
    run("new", "robot", "-o", "mine.toml")
    assert "OK" in run("check", "mine.toml")
    assert f'"version": "{VERSION}"' in run("doctor", "--json")


def locked(name: str) -> dict[str, tuple[str, frozenset[str]]]:
    """Package -> version and hashes."""
    packages = (ROOT / name).read_text().replace("\\\n", " ").splitlines()
    lines = [line.split() for line in packages if line and not line.startswith((" ", "#"))]
    return {
        package: (version, frozenset(word for word in words if word.startswith("--hash=")))
        for (package, version), words in ((line[0].split("=="), line[1:]) for line in lines)
    }


def test_what_a_user_installs_is_part_of_what_is_tested() -> None:
    run, tested = locked("requirements-run.txt"), locked("requirements.txt")
    assert run.items() <= tested.items()
    assert all(hashes for _, hashes in run.values())
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    wanted = {re.split("[<>=~]", each)[0] for each in (*project["dependencies"], *extras["view"], *extras["video"])}
    assert wanted <= run.keys()


def test_what_a_release_needs_is_there() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    assert project["project"]["license-files"] == ["LICENSE"] and (ROOT / "LICENSE").is_file()
    assert "## [Unreleased]" in (ROOT / "CHANGELOG.md").read_text()
    assert (ROOT / "CONTRIBUTING.md").is_file()
    citation = (ROOT / "CITATION.cff").read_text()
    assert f"version: {VERSION}" in citation and "license: Apache-2.0" in citation
    extras = set(project["project"]["optional-dependencies"])
    assert {"view", "video", "bench", "ray", "docs", "dev"} <= extras
