"""Everything Clamber raises on purpose, under one base; each error's `args` rebuild it in another process."""

import difflib
import unicodedata
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import ClassVar, Self, dataclass_transform


def printable(text: str) -> str:
    r"""A text whose control characters, but for line breaks and tabs, are written out, as "\x1b", so that no terminal obeys them."""
    return text if text.isprintable() else "".join(map(_printed, text))


def _printed(letter: str) -> str:
    shown = (
        letter.isprintable() or letter in "\n\t" or unicodedata.category(letter) == "Zs"
    )  # a space that does not break
    return letter if shown else letter.encode("unicode_escape", "backslashreplace").decode("ascii")


def near_matches(name: str, known: Iterable[str]) -> list[str]:
    """At most three known names like `name`, best first; empty when none is like it."""
    by_lower = {word.lower(): word for word in known}
    return [by_lower[word] for word in difflib.get_close_matches(name.lower(), by_lower, n=3, cutoff=0.6)]


def describe_choices(name: str, known: Iterable[str], limit: int = 40) -> str:
    """What may stand in place of the unknown `name`: all choices, or the first ones, and the likeliest."""
    words = list(known)
    listed = ", ".join(words[:limit]) + (f", ... ({len(words)} in all)" if len(words) > limit else "")
    near = near_matches(name, words)
    hint = f"; did you mean {' or '.join(repr(word) for word in near)}?" if near else ""
    return f"{listed or '(nothing)'}{hint}"


def how_to_install(extra: str) -> str:
    """The command that installs one of Clamber's extras; it is not on a package index, so from a clone."""
    return f'pip install ".[{extra}]" in a clone of Clamber'


class ClamberError(Exception):
    """Base of every error that Clamber raises for bad input."""


@dataclass_transform(eq_default=False)
class StatedError(ClamberError):
    """An error whose fields are its arguments, and whose text is `says` with them filled in."""

    says: ClassVar[str]

    def __init_subclass__(cls) -> None:
        dataclass(eq=False, repr=False)(cls)

    def __post_init__(self) -> None:
        self.args = tuple(vars(self).values())

    def __str__(self) -> str:
        return self.says.format(**vars(self))


class FileError(StatedError):
    """A file cannot be read or written as what it should be."""

    says = "{path}: {problem}; {allowed}"
    path: str
    problem: str
    allowed: str


class UnitError(StatedError):
    """A value is not a quantity of the dimension asked for."""

    says = "{value!r} {problem}; {allowed}"
    value: object
    problem: str
    allowed: str


class SpecError(ClamberError):
    """A robot, world or task file says something that cannot be used."""

    def __init__(self, file: str, key: str, value: object, allowed: str, others: tuple[str, ...] = ()) -> None:
        super().__init__(file, key, value, allowed, others)
        self.file, self.key, self.value, self.allowed, self.others = file, key, value, allowed, others

    @property
    def headline(self) -> str:
        """The first problem alone, in one line."""
        told = not isinstance(self.value, _Missing) and not _is_table(self.value)
        shown = f" = {_short(self.value)}" if told else ""
        return f"{self.file}: {self.key}{shown}: {self.allowed}"

    def __str__(self) -> str:
        return "\n".join((self.headline, *(f"  also {other}" for other in self.others)))


class UnknownNameError(ClamberError):
    """A robot, board, task or other named thing that does not exist."""

    def __init__(self, kind: str, name: str, known: tuple[str, ...]) -> None:
        super().__init__(kind, name, known)
        self.kind, self.name, self.known = kind, name, known

    def __str__(self) -> str:
        return f"no {self.kind} is called {self.name!r}; there are {describe_choices(self.name, self.known)}"


class UnknownHoldError(ClamberError):
    """A task or plan names a hold that its board does not have."""

    def __init__(self, hold: int, board: str, known: tuple[int, ...]) -> None:
        super().__init__(hold, board, known)
        self.hold, self.board, self.known = hold, board, known

    def __str__(self) -> str:
        near = sorted(self.known, key=lambda number: (abs(number - self.hold), number))[:3]
        listed = ", ".join(str(number) for number in sorted(near))
        return f"board '{self.board}' has no hold {self.hold}: it has {len(self.known)}, such as {listed}"


class _Missing:
    """Stands for a key that is not there; its own class, so that it survives pickling."""

    def __repr__(self) -> str:
        return "(not given)"


MISSING = _Missing()
"""The value of a `SpecError` about a key that the file does not have."""


def _is_table(value: object) -> bool:
    """Whether a value is a table of a file, to be looked at there, and no quantity that is written as one."""
    return isinstance(value, Mapping) and "value" not in value


def _short(value: object, limit: int = 120) -> str:
    text = repr(value)
    return text if len(text) <= limit else text[: limit - 3] + "..."


class PlannerError(StatedError):
    """A planner can't work on a task as it is."""

    says = "the {planner} planner can't take task '{task}': {problem}"
    planner: str
    task: str
    problem: str


class OptionError(StatedError):
    """What an option asks for can't be done: names the option, what is wrong, and what is allowed."""

    says = "{option}: {problem}; {allowed}"
    option: str
    problem: str
    allowed: str

    @classmethod
    def of_value(cls, option: str, value: object, problem: str, allowed: str) -> Self:
        """The error about a value, shown in at most 60 letters."""
        return cls(option, f"{_short(value, 60)} {problem}", allowed)


class StartError(StatedError):
    """The start stance of a task violates a hard check."""

    says = (
        "task '{task}', key 'start': the start stance violates the hard check '{check}' "
        "({meaning}) by {short}; move the body or the holds, or take '{check}' out of 'rules.hard'"
    )
    task: str
    check: str
    margin: float
    meaning: str
    short: str
    """By how much, with its unit."""
