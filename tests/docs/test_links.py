"""Where pages and messages send their readers: files of the repository, and installing from a clone."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
MADE = ("api/",)
"""Places that the building of the pages fills."""
LINK = re.compile(r"\]\(([^()\s]+)\)")
PATH = re.compile(r"(?<![^\s=])(?:src|docs|tests|examples|release)/[\w./*-]*(?:\.\w+|/)(?![\w/])")
"""A file with its suffix, or a folder with its slash at the end, as code names it; `*` stands for anything."""
PLACEHOLDER = re.compile(r"\b[A-Z]{3,}\b")
"""Stands for the reader's own name."""


def prose(page: Path) -> str:
    """A page without its blocks of code."""
    return re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)


def named_paths(text: str) -> list[str]:
    """Paths of the repository between backticks, alone or in a command."""
    return [path for code in re.findall(r"`([^`\n]+)`", text) for path in PATH.findall(code)]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_links_to_files_of_the_repository_lead_somewhere(page: Path) -> None:
    links = [
        link for link in LINK.findall(prose(page)) if not re.match(r"[a-z]+:|#", link) and not link.startswith(MADE)
    ]
    assert [link for link in links if not (page.parent / link.partition("#")[0]).exists()] == []


@pytest.mark.parametrize(
    "page", [page for page in PAGES if page.name != "CHANGELOG.md"], ids=lambda page: page.relative_to(ROOT).as_posix()
)
def test_paths_that_a_page_names_are_there(page: Path) -> None:
    """But in the changelog, which names files as they were called then."""
    named = named_paths(prose(page))
    assert [path for path in named if not any(ROOT.glob(PLACEHOLDER.sub("*", path)))] == []


def test_paths_are_found_alone_in_commands_and_with_globs() -> None:
    told = "see `src/clamber/sim/`, `python docs/pages.py -o out/docs/x.png`, `tests/*/test_a.py::test_b`, `examples/five` and tests/b.py"
    assert named_paths(told) == ["src/clamber/sim/", "docs/pages.py", "tests/*/test_a.py"]


@pytest.mark.parametrize("folder", ["docs", "src"])
def test_nobody_is_sent_to_a_package_index_that_clamber_is_not_on(folder: str) -> None:
    sources = [*ROOT.glob("*.md"), *(ROOT / folder).rglob("*.md"), *(ROOT / folder).rglob("*.py")]
    asked = re.compile(r"pip install ['\"]?clamber\[")
    assert [path.name for path in sources if asked.search(path.read_text(encoding="utf-8"))] == []
