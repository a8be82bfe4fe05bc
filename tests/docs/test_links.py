"""Where pages and messages send their readers: files of the repository, and installing from a clone."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
MADE = ("api/",)
"""Places that the building of the pages fills."""
LINK = re.compile(r"\]\(([^()\s]+)\)")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_links_to_files_of_the_repository_lead_somewhere(page: Path) -> None:
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    links = [link for link in LINK.findall(text) if not re.match(r"[a-z]+:|#", link) and not link.startswith(MADE)]
    assert [link for link in links if not (page.parent / link.partition("#")[0]).exists()] == []


@pytest.mark.parametrize("folder", ["docs", "src"])
def test_nobody_is_sent_to_a_package_index_that_clamber_is_not_on(folder: str) -> None:
    sources = [*ROOT.glob("*.md"), *(ROOT / folder).rglob("*.md"), *(ROOT / folder).rglob("*.py")]
    asked = re.compile(r"pip install ['\"]?clamber\[")
    assert [path.name for path in sources if asked.search(path.read_text(encoding="utf-8"))] == []
