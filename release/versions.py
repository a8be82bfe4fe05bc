"""Runs tests on several Pythons, each in an environment of its own: with the locked requirements, or the lowest that are allowed."""

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MADE = ROOT / "out" / "versions"
"""Where the environments are; they are kept for the next time."""
FLOOR = re.compile(r"^(?P<name>[A-Za-z0-9._-]+)>=(?P<version>[^,;\s]+)")
RUNS = ("view", "video")
"""Extras of who runs Clamber: their floors are tried, too. The tools of the tests are as locked."""


def find(version: str) -> str | None:
    """A Python of a version such as 3.12: on the path, else among those of pyenv."""
    pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    known = sorted(pyenv.glob(f"{version}.*/bin/python"), reverse=True)
    for name in (shutil.which(f"python{version}"), *map(str, known)):
        if name is None:
            continue
        asked = [name, "-c", "import sys, venv; print('%d.%d' % sys.version_info[:2])"]
        said = subprocess.run(asked, capture_output=True, text=True, check=False)
        if said.stdout.strip() == version:  # a shim may be there without its Python
            return name
    return None


def floors() -> list[str]:
    """The lowest versions that pyproject.toml allows of what Clamber runs with, as "name==version"."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    extras = [one for extra in RUNS for one in project["optional-dependencies"][extra]]
    found = []
    for asked in (*project["dependencies"], *extras):
        match = FLOOR.match(asked)
        if match is None:
            sys.exit(f"pyproject.toml: '{asked}' has no floor; write it as name>=version")
        found.append(f"{match['name']}=={match['version']}")
    return found


def install(python: str, folder: Path, kind: str) -> Path:
    """An environment with Clamber and all that its tests need; the path of its Python.

    Raises:
        CalledProcessError: If something cannot be installed; pip says what.
    """
    inside = folder / "bin" / "python"
    if not inside.exists():
        subprocess.run([python, "-m", "venv", folder], check=True)
    pip = [inside, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    if kind == "locked":
        subprocess.run([*pip, "--require-hashes", "-r", ROOT / "requirements.txt"], check=True)
        subprocess.run([*pip, "--no-deps", "--no-build-isolation", "-e", ROOT], check=True)
    else:
        lowest = folder / "lowest.txt"
        lowest.write_text("".join(f"{floor}\n" for floor in floors()), "utf-8")
        subprocess.run([*pip, "-c", lowest, "-e", f"{ROOT}[dev,bench,{','.join(RUNS)}]"], check=True)
    return inside


def main() -> None:
    """Try each version that is asked for; leaves with 1 if one is missing or its tests fail, and says which."""
    split = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    (kind, *versions), tests = sys.argv[1:split], sys.argv[split + 1 :]
    told: dict[str, str] = {}
    for version in versions:
        python = find(version)
        if python is None:
            told[version] = "missing: there is no such Python on the path, nor among pyenv's"
            continue
        try:
            inside = install(python, MADE / f"{kind}-{version}", kind)
        except subprocess.CalledProcessError:
            told[version] = "failed: what it needs cannot be installed"
            continue
        ended = subprocess.run([inside, "-m", "pytest", "-q", "-p", "no:cacheprovider", *tests], cwd=ROOT, check=False)
        told[version] = "passed" if ended.returncode == 0 else f"failed: pytest left with {ended.returncode}"
    for version, outcome in told.items():
        print(f"Python {version}, {kind} requirements: {outcome}")
    sys.exit(0 if told and all(outcome == "passed" for outcome in told.values()) else 1)


if __name__ == "__main__":
    main()
