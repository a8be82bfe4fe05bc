"""Every command in a block of README or docs runs, in the order of its page, each page in a folder of its own."""

import os
import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from told_commands import ROOT, Told, files_of, pages, told_by

HOW = tomllib.loads((Path(__file__).parent / "shorter.toml").read_text())
BLOCKS = {page.relative_to(ROOT).as_posix(): [told for told in told_by(page) if told.block] for page in pages()}
MOST = 600  # [s] for one command: far above what any takes, to end what hangs


def shortened(text: str) -> str:
    for rule in HOW["shorter"]:
        text = re.sub(rule["say"], rule["instead"], text)
    return text


def elsewhere(text: str) -> bool:
    return any(re.search(rule["say"], text) for rule in HOW["elsewhere"])


def code_of(told: Told) -> int:
    return 1 if any(re.search(rule["say"], told.text) for rule in HOW["no"]) else 0


def install(package: Path, target: Path) -> Path:
    """What `pip install` does, into a folder of its own: the machine's packages stay as they are, and nothing is fetched."""
    words = ("install", "-q", "--no-deps", "--no-build-isolation", "--no-index", "--target", str(target / package.name))
    subprocess.run([sys.executable, "-m", "pip", *words, str(package)], check=True, capture_output=True)
    return target / package.name


@pytest.mark.long
@pytest.mark.parametrize("page", [page for page, told in BLOCKS.items() if told])
def test_commands_of_the_page_run(page: str, tmp_path: Path) -> None:
    plain = os.environ | {"NO_COLOR": "1", "COLUMNS": "80"}
    for beside in (ROOT / page).parent.glob("*.md"):  # what a page's commands work on may stand on the page before
        for name, content in files_of(beside).items():
            (tmp_path / name).parent.mkdir(exist_ok=True)
            (tmp_path / name).write_text(content)
    installed = [
        install(package.parent, tmp_path / "installed") for package in sorted(tmp_path.glob("*/pyproject.toml"))
    ]
    if installed:
        plain["PYTHONPATH"] = os.pathsep.join([*map(str, installed), os.environ.get("PYTHONPATH", "")])
    for told in BLOCKS[page]:
        if elsewhere(told.text):
            continue
        words = shortened(told.text)
        done = subprocess.run(
            [sys.executable, "-c", "from clamber.cli import main; main()", *shlex.split(words)],
            cwd=tmp_path, env=plain, capture_output=True, text=True, timeout=MOST, check=False,
        )  # fmt: skip
        assert "Traceback" not in done.stderr, f"{page}:{told.line}: clamber {words}\n{done.stderr[-2000:]}"
        assert done.returncode == code_of(told), f"{page}:{told.line}: clamber {words}\n{done.stderr[-2000:]}"


def test_what_runs_elsewhere_does_run_there() -> None:
    for rule in HOW["elsewhere"]:
        assert (ROOT / rule["test"]).is_file(), rule


@pytest.mark.parametrize("kind", ["shorter", "elsewhere", "no"])
def test_no_rule_is_left_over(kind: str) -> None:
    """A rule that no page needs any more goes."""
    texts = [told.text for page in BLOCKS.values() for told in page]
    for rule in HOW[kind]:
        used = False
        for text in texts:
            used = used or re.search(rule["say"], text) is not None
        assert used, rule
