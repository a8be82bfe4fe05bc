"""One page of docstrings for every folder of the package: made from the folders themselves, so that none is forgotten."""

import re
from pathlib import Path

import clamber

PACKAGE = Path(clamber.__file__).parent
FOLDER = re.compile(r"^\| `(\w+)/` \| (.+?) \| ", re.MULTILINE)
INSIDE = ("cli", "studies")
"""Folders that nobody imports from."""


def write_api_pages(docs: Path) -> None:
    """Write `api/index.md` and a page for each folder of the table in `architecture.md`; untouched where they are as they should be."""
    told = dict(FOLDER.findall((docs / "architecture.md").read_text()))
    pages = {name: says for name, says in told.items() if name not in INSIDE}
    for name, says in pages.items():
        parts = [f"# {name}", f"{says[0].upper()}{says[1:]}."]
        for file in sorted((PACKAGE / name).rglob("*.py")):
            if file.name != "__init__.py":
                module = ".".join(("clamber", *file.relative_to(PACKAGE).with_suffix("").parts))
                parts.append(f"## {module.removeprefix('clamber.')}\n\n```{{automodule}} {module}\n```")
        _write(docs / "api" / f"{name}.md", "\n\n".join(parts) + "\n")
    index = [
        "# Modules",
        "SI units and radians; shapes and frames stand with each argument. What is promised to stay is [the Python API](../python-api.md); "
        "what stands here is how Clamber is made, and may change with a version.",
        "```{toctree}\n" + "\n".join(pages) + "\n```",
    ]
    _write(docs / "api" / "index.md", "\n\n".join(index) + "\n")


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(exist_ok=True)
    if not path.is_file() or path.read_text() != text:
        path.write_text(text)
