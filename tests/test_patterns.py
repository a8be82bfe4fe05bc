"""Every regular expression of the package takes time in proportion to the text, whatever the text is."""

import ast
import re
import signal
from collections.abc import Callable, Iterator
from importlib import import_module
from itertools import product
from pathlib import Path

import pytest

import clamber
from clamber.errors import ClamberError
from clamber.execution.log_files import parse_csv
from clamber.families.climber.world.csv_board import read_points
from clamber.families.walker.planning.walks import read_path
from clamber.files import parse_toml
from clamber.planning.axes import range_axis, values_axis
from clamber.units import split_quantity, split_title

SOURCES = Path(clamber.__file__).parent
LONG = 30_000
"""Letters; what grows with their square takes seconds, with their cube days."""
MOST = 1.0
"""For one text [s]; a hundred times of what it takes."""
PARTS = (
    " ", "a", "1", ".", "-", "[", "(", "]", "#", ":", "=", "e", "_", "/", "'", '"', "\\", "a.", "1.", " a", "[ ", "a b ", "''", '"""',
    '\\"""', "\n", "=..", "holds 1 and ", "numba ", "auth",
)  # fmt: skip


def texts() -> Iterator[str]:
    """Runs of one part, behind a beginning and before an end at which a match may fail."""
    for part, first, last in product(PARTS, ("", "a", "# a", "a=1.."), ("", "\0", "]")):
        yield first + part * (LONG // len(part)) + last


def patterns() -> dict[str, re.Pattern[str]]:
    """Every pattern that a module compiles, or hands to a function of `re`, by where that is."""
    found: dict[str, re.Pattern[str]] = {}
    for path in sorted(SOURCES.rglob("*.py")):
        place = path.relative_to(SOURCES).with_suffix("")
        calls = [
            node
            for node in ast.walk(ast.parse(path.read_text()))
            if isinstance(node, ast.Call)
            and isinstance(node.func, ast.Attribute)
            and ast.unparse(node.func.value) == "re"
        ]
        for call in (call for call in calls if isinstance(call.args[0], ast.Constant)):
            found[f"{place}:{call.lineno}"] = re.compile(_text(call.args[0].value))  # type: ignore[attr-defined]
        if any(ast.unparse(call.func) == "re.compile" for call in calls):
            held = vars(import_module(".".join(("clamber", *place.parts))))
            found |= {f"{place} {name}": _as_text(one) for name, one in held.items() if isinstance(one, re.Pattern)}
        elif any(not isinstance(call.args[0], ast.Constant) for call in calls):
            raise AssertionError(f"{place} makes a pattern while it runs: nobody can look at it")
    return found


def _text(pattern: str | bytes) -> str:
    return pattern if isinstance(pattern, str) else pattern.decode()


def _as_text(pattern: "re.Pattern[str] | re.Pattern[bytes]") -> re.Pattern[str]:
    kept = pattern.flags if isinstance(pattern.pattern, str) else pattern.flags & ~re.ASCII
    return re.compile(_text(pattern.pattern), kept)


PATTERNS = {place: pattern for place, pattern in patterns().items() if not place.startswith("compiled")}
"""But for what `compiled` looks for in the package's own files, which nobody else writes."""


def too_long(use: Callable[[str], object]) -> str:
    """The beginning of a text that takes more than `MOST`; empty where none does."""

    def give_up(*_: object) -> None:
        raise TimeoutError

    before = signal.signal(signal.SIGVTALRM, give_up)  # matching looks at signals on the way
    try:
        for text in texts():
            signal.setitimer(signal.ITIMER_VIRTUAL, MOST)
            try:
                use(text)
            except TimeoutError:
                return text[:12]
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.signal(signal.SIGVTALRM, before)
    return ""


@pytest.mark.slow
@pytest.mark.parametrize("place", PATTERNS)
def test_no_pattern_blows_up(place: str) -> None:
    assert too_long(PATTERNS[place].search) == ""


@pytest.mark.slow
def test_a_pattern_that_blows_up_is_seen() -> None:
    assert too_long(re.compile(r"\s*(.*?)\s*(?:\[\s*([^\]]*?)\s*\])?\s*\Z").search) != ""


READERS: dict[str, Callable[[str, Path], object]] = {
    "quantity": lambda text, _: split_quantity(text),
    "title": lambda text, _: split_title(text),
    "range": lambda text, _: range_axis(f"a.b={text}"),
    "values": lambda text, _: values_axis(f"a.b={text}"),
    "toml": lambda text, _: parse_toml(f"a = 1 {text}"),
    "log": lambda text, _: parse_csv(f"# a{text}: b\n{text}\n{text}", "log"),
    "board": lambda text, path: read_points(path),
    "path": lambda text, path: read_path(path),
}


@pytest.mark.parametrize("name", READERS)
def test_no_reader_of_texts_blows_up(name: str, tmp_path: Path) -> None:
    path = tmp_path / "table.csv"

    def use(text: str) -> None:
        path.write_text(f"x [m{text}],y [m]\n{text},1\n")
        try:
            READERS[name](text, path)
        except (ClamberError, ValueError):
            return

    assert too_long(use) == ""


@pytest.mark.parametrize(
    ("title", "parts"),
    [("angle [deg]", ("angle", "deg")), (" x ( in ) ", ("x", "in")), ("t", ("t", None)), ("a [1] [s]", ("a [1]", "s")), ("[m]", ("", "m")),
     ("a [(m]", ("a", "(m")), ("a []", ("a", None)), ("a ] ]", ("a ] ]", None)), ("a (b [c]", ("a", "b [c")), ("", ("", None))],
)  # fmt: skip
def test_a_title_is_split_into_name_and_unit(title: str, parts: tuple[str, str | None]) -> None:
    assert split_title(title) == parts
