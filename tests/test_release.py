"""What a release brings along: its bill of materials, and bounds on what may be installed."""

import json
import re
import subprocess
import sys
import tomllib
from importlib import metadata
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
LOCK = (ROOT / "requirements-run.txt").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def make_bill(output: Path, *words: str) -> "subprocess.CompletedProcess[str]":
    command = [sys.executable, str(ROOT / "release" / "bom.py"), "-o", str(output), *words]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.mark.locked
def test_the_bill_of_materials_has_every_locked_package_with_its_licence_and_hashes(tmp_path: Path) -> None:
    for name in ("bom.json", "again.json"):
        done = make_bill(tmp_path / name)
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "bom.json").read_bytes() == (tmp_path / "again.json").read_bytes()
    bill = json.loads((tmp_path / "bom.json").read_text())
    assert (bill["bomFormat"], bill["specVersion"], bill["version"]) == ("CycloneDX", "1.6", 1)
    assert re.fullmatch(r"urn:uuid:[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}", bill["serialNumber"])
    about = bill["metadata"]["component"]
    assert (about["version"], about["licenses"]) == (metadata.version("clamber"), [{"expression": "Apache-2.0"}])
    found = {component["bom-ref"]: component for component in bill["components"]}
    wanted = {
        f"pkg:pypi/{name}@{version}" for name, version in re.findall(r"^([\w.-]+)==([^ ;\\]+)", LOCK, re.MULTILINE)
    }
    assert set(found) == {ref for ref in wanted if "/setuptools@" not in ref}
    hashed = {hash_["content"] for component in found.values() for hash_ in component["hashes"]}
    assert hashed <= set(re.findall(r"sha256:([0-9a-f]{64})", LOCK)) and len(hashed) > 1000
    for component in found.values():
        assert component["licenses"] and component["hashes"], component["name"]
    graph = {entry["ref"]: entry["dependsOn"] for entry in bill["dependencies"]}
    assert set(graph) == {*found, about["bom-ref"]}, "nothing is locked that nobody asks for"
    assert found["pkg:pypi/numpy@" + metadata.version("numpy")]["bom-ref"] in graph[about["bom-ref"]]


@pytest.mark.locked
def test_a_bill_of_what_is_not_installed_is_refused(tmp_path: Path) -> None:
    lock = tmp_path / "lock.txt"
    lock.write_text(LOCK.replace(f"numpy=={metadata.version('numpy')}", "numpy==1.0.0"))
    done = make_bill(tmp_path / "bom.json", "--lock", str(lock))
    assert done.returncode == 1 and "1.0.0: run `make setup` first" in done.stderr
    assert not (tmp_path / "bom.json").exists()


@pytest.mark.parametrize(
    ("imports", "package"),
    [
        (r"^from numba\.core", "numba"),
        (r"^    from websockets\.", "websockets"),
        (r"viser\.infra|viser\._|import viser", "viser"),  # the guard takes the place of what viser calls
    ],
)
def test_packages_whose_private_parts_are_used_are_bounded_above(imports: str, package: str) -> None:
    used = [path for path in (ROOT / "src").rglob("*.py") if re.search(imports, path.read_text("utf-8"), re.MULTILINE)]
    assert used, "then its bound may go"
    asked = [*PROJECT["dependencies"], *PROJECT["optional-dependencies"]["view"]]
    (bounds,) = (one for one in asked if re.match(rf"{package}\b", one))
    assert re.search(r",<\d", bounds), bounds


def test_the_page_on_security_says_how_to_report_and_which_wait() -> None:
    page = (ROOT / "SECURITY.md").read_text(encoding="utf-8")
    report, waits = (
        re.search(rf"^## {title}$(.*?)(?=^## |\Z)", page, re.M | re.S) for title in ("Report", "Which wait")
    )
    assert report is not None and waits is not None
    assert all(
        word in report[1] for word in ("privately", "Report a vulnerability", "CITATION.cff", "clamber --version")
    )
    assert (ROOT / "CITATION.cff").is_file() and waits[1].count("\n- ") >= 5


def test_no_file_of_the_lock_names_an_index() -> None:
    for name in ("requirements.txt", "requirements-run.txt"):
        assert not re.search(r"https?://|--(extra-)?index-url|--find-links", (ROOT / name).read_text("utf-8")), name


def test_a_python_that_is_not_there_is_named_and_fails(tmp_path: Path) -> None:
    words = [sys.executable, str(ROOT / "release" / "versions.py"), "locked", "3.99", "--", "-q"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and "Python 3.99, locked requirements: missing" in done.stdout


def test_the_pythons_that_are_promised_are_those_that_are_tried() -> None:
    (tried,) = re.findall(r"^PYTHONS \?= (.*)$", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE)
    promised = [line.rpartition(" ")[2] for line in PROJECT["classifiers"] if re.search(r":: 3\.\d+$", line)]
    assert tried.split() == promised
    assert PROJECT["requires-python"] == f">={promised[0]}"


def test_the_page_names_the_versions_that_are_allowed_and_those_that_are_locked() -> None:
    page = (ROOT / "docs" / "start.md").read_text(encoding="utf-8")
    locked, lowest = (re.search(rf"\| {row} \| (.*) \|", page) for row in ("all tests, in CI", "lowest allowed"))
    assert locked is not None and lowest is not None
    floors = {name: floor for name, floor in (re.split(">=", each.split(",")[0]) for each in PROJECT["dependencies"])}
    for name in ("numpy", "numba", "scipy", "mujoco", "matplotlib", "pillow"):
        told = re.search(rf"{name} ([\d.]+\d)", lowest[1])
        assert told is not None and told[1].startswith(floors[name]), name
        pinned = re.search(rf"^{name}==([\d.]+)", (ROOT / "requirements.txt").read_text("utf-8"), re.MULTILINE)
        assert pinned is not None and f"{name} {pinned[1]}" in locked[1], name
