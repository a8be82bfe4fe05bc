"""The folder of a report: made, or taken on if it is one of the same kind; nobody else's files are ever written over."""

import json
from pathlib import Path
from typing import Final

from ...errors import FileError
from ...files import read_text, write_atomically
from ...regular_files import make_folder

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
