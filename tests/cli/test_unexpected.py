"""What no command foresaw, what no machine can do, and what no terminal should be told."""

from collections.abc import Callable
from pathlib import Path

import pytest

import clamber as package
from clamber.errors import printable

Clamber = Callable[..., tuple[int, str, str]]
LADDER = Path(package.__file__).parent / "families/climber/data/tasks/ladder.toml"


@pytest.mark.parametrize(
    "error", [KeyError("odd\x1b[31m"), EOFError("no more"), OSError(5, "broken"), RecursionError("deep")]
)
def test_an_unexpected_error_leaves_with_70_and_says_what_to_send(
    clamber: Clamber, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr("clamber.planning.problem.plan_source.open_plan", fail)
    code, out, err = clamber("check", "ladder-hand", "--set", "title=a b")
    assert (code, out) == (70, "")
    first, above, line, *below = err.strip().splitlines()
    assert first.startswith("clamber: unexpected error: ") and type(error).__name__ in first
    assert "Please send what is below the line" in above and set(line) == {"-"}
    assert f"clamber {package.__version__}, Python 3." in below[0]
    assert below[2] == "command: clamber check ladder-hand --set 'title=a b'"
    assert below[3].startswith("Traceback") and "\x1b" not in err


def test_what_needs_more_memory_than_there_is_is_told(clamber: Clamber, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object, **__: object) -> None:
        raise MemoryError

    monkeypatch.setattr("clamber.planning.problem.plan_source.open_plan", fail)
    assert clamber("check", "ladder-hand") == (2, "", "clamber: needs more memory than there is; ask for less\n")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("plan ladder --seed 9223372036854775808", "random numbers take seeds of 63 bits"),
        ("shorten ladder-hand --width 1000000000000", "every stance of a breadth is kept in memory"),
        ("trials ladder -n 1000000000", "a million climbs take"),
        ("plan ladder --islands 1000000", "each is a process and a population"),
        ("limb step --seconds nan", "nan is not a finite number"),
        ("limb circle --lap inf", "inf is not a finite number"),
        ("hold-force --seconds 1000000", "every sample is kept in memory"),
        ("inventory ladder --length 100000000", "more digits than anybody reads"),
    ],
)
def test_numbers_beyond_all_use_are_refused_with_the_reason(clamber: Clamber, words: str, said: str) -> None:
    code, out, err = clamber(*words.split())
    assert (code, out) == (2, "")
    assert said in " ".join(err.replace("│", " ").split()) and words.split()[-2] in err


def test_no_escape_character_reaches_the_terminal(clamber: Clamber, tmp_path: Path) -> None:
    evil = "\x1b]0;owned\x07\x9b31m\u202e"
    task = tmp_path / f"ev{evil}il.toml"
    escaped = "".join(f"\\u{ord(letter):04x}" if not letter.isprintable() else letter for letter in evil)
    text = LADDER.read_text().replace('title = "', f'title = "{escaped}')
    assert escaped in text
    task.write_text(text)
    shown = []
    for words in (("check", str(task)), ("check", str(task), "--json"), ("plan", str(task), "--evaluations", "5"), ("plan", f"x{evil}"),
                  (f"x{evil}",), ("plan", f"--{evil}"), ("plan", "ladder", "--seed", evil), ("check", f"{task}x.toml")):  # fmt: skip
        _, out, err = clamber(*words)
        assert not {letter for letter in out + err if not letter.isprintable()} - {"\n"}, words
        shown.append("\\x1b]0;owned" in out + err or "\\u001b]0;owned" in out + err)
    assert all(shown[3:6]) and any(shown[:3])


def test_what_is_printed_is_readable_otherwise() -> None:
    for text in ("", "plain", "a\tb\nc", "ü ° × 3\u202fm\u00a0x", "日本"):
        assert printable(text) == text
    assert printable("a\x00\x1b\x7f\x9b\u2028\u202e\udc80\rb") == r"a\x00\x1b\x7f\x9b\u2028\u202e\udc80\rb"
