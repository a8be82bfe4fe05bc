"""docs/commands.md: the commands, arguments and options that there are."""

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest
import typer

from clamber.cli.app import application, commands_below

DOCS = Path(__file__).resolve().parents[2] / "docs"


@pytest.fixture(scope="module")
def generator() -> ModuleType:
    spec = importlib.util.spec_from_file_location("command_pages", DOCS / "command_pages.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_committed_page_is_the_generated_one(generator: ModuleType) -> None:
    committed = (DOCS / "commands.md").read_text(encoding="utf-8")
    assert committed == generator.command_page(), "renew it with `python docs/command_pages.py`"


def test_every_command_has_a_section_and_no_hidden_one_has(generator: ModuleType) -> None:
    page = generator.command_page()
    for path, command in commands_below(typer.main.get_command(application())):  # type: ignore[arg-type]
        if path and not getattr(command, "commands", None):
            assert (f"\n### clamber {' '.join(path)}\n" in page) is not command.hidden, path


def test_a_page_as_it_should_be_is_not_written_again(generator: ModuleType, tmp_path: Path) -> None:
    generator.write_command_page(tmp_path)
    written = (tmp_path / "commands.md").stat().st_mtime_ns
    generator.write_command_page(tmp_path)
    assert (tmp_path / "commands.md").stat().st_mtime_ns == written
