"""Pages from templates: every text is escaped, every name that a template uses must be given."""

import math
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ... import __version__
from ...files import write_atomically

if TYPE_CHECKING:
    from jinja2 import Environment

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
