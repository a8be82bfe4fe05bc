"""What commands have compiled ahead: only what is missing, only where it can be handed over, and no longer than the command runs."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path

import pytest

from clamber import kernel_cache
from clamber.cli import main
from clamber.family import families
from clamber.kernel_cache import Use
from clamber.terminal.compile_ahead import compile_ahead

USES = (Use("module:one", "first"), Use("module:two", "second"))


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[str]:
    """What is begun, and "over" when that ends, with a folder for kernels in which "first" is compiled."""
    said: list[str] = []

    @contextmanager
    def begin(names: Sequence[str]) -> Iterator[None]:
        said.extend(names)
        yield
        said.append("over")

    monkeypatch.setattr("clamber.jobs.ahead.ahead", begin)
    monkeypatch.setattr(kernel_cache, "cache_folder", lambda: tmp_path)
    monkeypatch.setattr(kernel_cache, "is_compiled", lambda name: name == "first")
    return said


def test_what_is_missing_is_begun_and_ends_with_the_command(told: list[str]) -> None:
    compile_ahead(*USES)
    assert told == ["module:two"]
    with pytest.raises(SystemExit):
        main(["check", "no-such-thing"])
    assert told == ["module:two", "over"]


def test_where_all_is_compiled_nothing_is_begun(told: list[str]) -> None:
    compile_ahead(USES[0])
    assert told == []


def test_where_nobody_could_find_it_nothing_is_begun(
    told: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(kernel_cache, "cache_folder", lambda: tmp_path / "missing")
    compile_ahead(*USES)
    assert told == []


@pytest.mark.parametrize(
    "use", [use for family in families() if family.dynamics is not None for use in family.dynamics.compiled]
)
def test_a_use_leaves_the_kernel_that_tells_of_it(use: Use) -> None:
    module, _, name = use.function.partition(":")
    getattr(import_module(module), name)()
    assert list(kernel_cache.cache_folder().glob(f"*.{use.kernel}-*.nbc"))
