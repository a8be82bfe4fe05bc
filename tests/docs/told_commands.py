"""The commands that README and docs tell the reader to type."""

import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
BEGIN = re.compile(r"(?:\.venv/bin/)?clamber(?= |$)")
FILE = re.compile(r"# ([\w./-]+\.\w+)\n")
PLACEHOLDER = re.compile(r"\b[A-Z]{3,}(?:\.\w+)?\b|\.\.\.| N\b|\bS\b")


@dataclass(frozen=True, slots=True)
class Told:
    """One command of a page: `words` are those after `clamber`; without `block` it stands in a sentence, named rather than typed."""

    page: str
    line: int
    words: tuple[str, ...]
    block: bool

    @property
    def text(self) -> str:
        """As on the page, without `clamber`."""
        return shlex.join(self.words)

    @property
    def is_pattern(self) -> bool:
        """Whether a word of it stands for the reader's own, such as TASK."""
        return any(PLACEHOLDER.search(f" {word}") for word in self.words)


def pages() -> list[Path]:
    """README, CONTRIBUTING and every page of the docs."""
    return [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]


def told_by(page: Path) -> Iterator[Told]:
    """Every command of a page, in its order; a line that ends in a backslash goes on."""
    name = page.relative_to(ROOT).as_posix()
    text = page.read_text()
    for number, line in _whole_lines(text):
        stripped = line.strip()
        if BEGIN.match(stripped) and (line.startswith("    ") or stripped == line):
            for words in _split(stripped):
                yield Told(name, number, words, block=True)
        else:
            for inline in re.findall(r"`(clamber [^`]+)`", line):
                for words in _split(inline.replace("\\|", "|")):
                    yield Told(name, number, words, block=False)


def files_of(page: Path) -> dict[str, str]:
    """Name -> content of the whole files that a page shows: blocks whose first line is a comment of their name alone."""
    found = {}
    for block in re.findall(r"^```\w+\n(.*?)^```$", page.read_text(), re.DOTALL | re.MULTILINE):
        named = FILE.match(block)
        if named:
            found[named[1]] = block
    return found


def _whole_lines(text: str) -> Iterator[tuple[int, str]]:
    begun, gathered = 0, ""
    for number, line in enumerate(text.splitlines(), 1):
        if not gathered:
            begun = number
        if line.rstrip().endswith("\\"):
            gathered += line.rstrip()[:-1]
            continue
        yield begun, gathered + line
        gathered = ""


def _split(line: str) -> Iterator[tuple[str, ...]]:
    """The words of each command of a line; `&&` joins commands, `#` begins a comment."""
    words: list[str] = []
    for word in [*shlex.split(line, comments=True), "&&"]:
        if word != "&&":
            words.append(word)
            continue
        if words and BEGIN.fullmatch(words[0]):
            yield tuple(words[1:])
        words = []
