"""Every block of Python on the pages that tell of `import clamber` runs as it stands, in a folder of its own."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from told_commands import FILE, ROOT

import clamber

PAGES = ("README", "docs/python-api", "docs/own-robot")
TEN_LINES = 11
"""Of a block, the import and the empty line after it with it."""
LONG = ("clamber.run(", "explain_infeasibility(")
"""What takes more than some seconds."""


def blocks() -> list[Any]:
    found = []
    for page in PAGES:
        text = (ROOT / f"{page}.md").read_text()
        for number, block in enumerate(re.findall(r"```python\n(.*?)```", text, re.DOTALL), start=1):
            if not FILE.match(block):
                slow = [pytest.mark.slow] if any(word in block for word in LONG) else []
                found.append(pytest.param(block, id=f"{Path(page).name}-{number}", marks=slow))
    return found


@pytest.mark.slow
@pytest.mark.parametrize("block", blocks())
def test_a_block_runs(block: str, tmp_path: Path) -> None:
    assert len(block.splitlines()) <= TEN_LINES
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    environment = os.environ | {"PYTHONPATH": str(Path(clamber.__file__).parents[1]), "MPLBACKEND": "agg"}
    done = subprocess.run(
        [sys.executable, "-c", block], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=900, check=False
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stdout


def test_the_page_names_all_that_is_offered() -> None:
    text = (ROOT / "docs" / "python-api.md").read_text()
    told = set(re.findall(r"`(?:clamber\.)?([A-Za-z_]+)`?", text))
    assert set(clamber.__all__) - {"__version__", "Plan"} <= told
