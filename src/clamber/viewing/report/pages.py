"""The folder of a report, and its pages from templates: every text is escaped; nobody else's files are ever written over."""

import json
import math
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ... import __version__
from ...errors import FileError
from ...files import read_text, write_atomically
from ...regular_files import make_folder

if TYPE_CHECKING:
    from jinja2 import Environment

MARK: Final = "report.json"
"""Says that a folder is a report."""
SCHEMA: Final = "clamber-report-1"


def open_report(folder: Path, kind: str) -> None:
    """Make a report's folder, or make sure that there is one of this kind.

    Raises:
        FileError: If it cannot be made, or holds something else.
    """
    name = str(folder)
    try:
        make_folder(folder)
        mark = folder / MARK
        if not mark.is_file() and any(folder.iterdir()):
            raise FileError(
                name, "holds files and is no report", "name a new folder, an empty one, or an earlier report"
            )
    except OSError as error:
        raise FileError(name, f"cannot be read ({error.strerror})", "name a folder where you may write") from None
    if mark.is_file() and (there := _kind_of(mark)) != kind:
        raise FileError(name, f"is a report of the kind '{there}'", f"one of '{kind}' needs a folder of its own")
    write_atomically(mark, json.dumps({"schema": SCHEMA, "kind": kind}) + "\n")


def _kind_of(mark: Path) -> str:
    try:
        data = json.loads(read_text(mark))
    except (ValueError, RecursionError):
        data = None
    if not isinstance(data, dict) or data.get("schema") != SCHEMA or not isinstance(data.get("kind"), str):
        raise FileError(str(mark), f'does not say schema = "{SCHEMA}" and a kind', "name another folder for the report")
    return str(data["kind"])


TEMPLATES: Final = Path(__file__).parent / "templates"
STYLE: Final = "style.css"


def shown(value: object) -> str:
    """A value as a table has it: numbers to six figures, nothing for None."""
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.6g}" if math.isfinite(value) else "none"
    return str(value)


@cache
def _environment() -> "Environment":
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    made = Environment(
        loader=FileSystemLoader(TEMPLATES), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )  # fmt: skip
    made.filters["shown"] = shown
    made.tests["number"] = lambda value: isinstance(value, int | float)
    return made


def write_page(path: Path, template: str, **names: Any) -> None:
    """Write a page.

    Args:
        path: Of the page.
        template: Name of its template, without suffix.
        names: What the template uses, besides the version.

    Raises:
        FileError: If the folder is missing or cannot be written.
    """
    page = _environment().get_template(f"{template}.html").render(version=__version__, **names)
    write_atomically(path, page)


def write_style(folder: Path) -> None:
    """Write what all pages of a report look like beside them."""
    write_atomically(folder / STYLE, (TEMPLATES / STYLE).read_text(encoding="utf-8"))
