"""Files in and out: TOML with named errors, content hashes, schema versions, shipped data by name.

Whatever is read or written passes `regular_files`, which takes regular files only.
"""

import csv
import hashlib
import io
import json
import math
import os
import re
import sys
import tomllib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from .errors import MISSING, ClamberError, FileError, OptionError, SpecError, UnknownNameError, describe_choices
from .regular_files import is_file, is_folder, read_bytes, user_path
from .regular_files import write_atomically as write_atomically
from .types import Json

MOST_TEXT: Final = 8 * 1024 * 1024
"""Largest TOML, JSON or CSV file that is read [bytes], which is a board of 140 000 holds; its lists may take fifty times as much memory."""
MOST_PARTS: Final = 32
"""Parts of a dotted TOML key; parsing takes time and memory by the square of them, 1.7 GB for a key of 40 kB."""
_ONCE: Final = "+" if sys.version_info >= (3, 11, 5) else ""
"""Makes a repetition possessive, which takes less memory where it never has to be tried again; broken before Python 3.11.5."""
_KEPT_WHOLE: Final = re.compile(
    rf"""\"{{3}}(?:[^"\\]|\\.?|"(?!""))*{_ONCE}(?:"{{3,5}}|\Z)|'{{3}}(?:[^']|'(?!''))*{_ONCE}(?:'{{3,5}}|\Z)"""
    rf"""|"(?:[^"\\\n]|\\.?)*{_ONCE}"?|'[^'\n]*'?|(?P<comment>\#[^\n]*)""",
    re.DOTALL,
)
"""Strings and comments of TOML, open ones too: a dot in them parts no key."""
_LONG_KEY: Final = re.compile(rf"(?<![\w-])(?:[\w-]+[ \t]*\.[ \t]*){{{MOST_PARTS}}}")


@dataclass(frozen=True, slots=True)
class Document:
    """A table as read, with what an error about it has to name."""

    label: str
    """What errors call it: the file's path."""
    data: Json
    overrides: tuple[tuple[str, str], ...] = ()
    """Dotted key -> text of the override that set it; errors name the override in place of the file."""
    folder: Path | None = None
    """Where relative paths inside it start."""

    def section(self, key: str, label: str) -> "Document":
        """The table under `key` as a document of its own, called `label`."""
        inner = tuple((k[len(key) + 1 :], text) for k, text in self.overrides if k.startswith(key + "."))
        table = self.data.get(key)
        if not isinstance(table, dict):
            raise self.problem(key, "must be a table")
        return Document(label, table, inner, self.folder)

    def value_at(self, key: str) -> Any:
        """What stands under a dotted key, or `MISSING`; lists are entered by name, hold number or index."""
        here: Any = self.data
        for word in key.split("."):
            if isinstance(here, dict):
                here = here.get(word, MISSING)
            elif isinstance(here, list):
                index = element_index(here, word)
                here = MISSING if index is None else here[index]
            else:
                return MISSING
        return here

    def label_of(self, key: str) -> str:
        """The file, the override that set this key or one around it, or both where it set only a part of it."""
        for path, text in reversed(self.overrides):
            if key == path or key.startswith(path + "."):
                return f"--set {text}"
        inside = [text for path, text in self.overrides if path.startswith(key + ".")]
        return f"{self.label} with --set {inside[-1]}" if inside else self.label

    def problem(self, key: str, allowed: str, others: tuple[str, ...] = ()) -> SpecError:
        """An error about the value under a dotted key."""
        return SpecError(self.label_of(key), key, self.value_at(key), allowed, others)


def element_names(elements: list[Any]) -> list[str]:
    """How overrides and errors call the elements of a list: by name, by hold number, else by index from 0."""
    for field in ("name", "number"):
        if elements and all(isinstance(e, dict) and isinstance(e.get(field), str | int) for e in elements):
            names = [str(e[field]) for e in elements]
            if len(set(names)) == len(names):
                return names
    return [str(i) for i in range(len(elements))]


def element_index(elements: list[Any], word: str) -> int | None:
    """The place of the element called `word`, or None."""
    names = element_names(elements)
    if word in names:
        return names.index(word)
    # An index counts only where elements are not numbered themselves, so that holds.7 is hold 7.
    numbered = all(isinstance(e, dict) and "number" in e and "name" not in e for e in elements)
    return int(word) if word.isdecimal() and int(word) < len(elements) and not numbered else None


def read_text(path: Path, most: int = MOST_TEXT) -> str:
    """The text of a regular UTF-8 file of at most `most` bytes.

    Raises:
        FileError: If it is missing, no regular file, too large, or not UTF-8.
    """
    try:
        return read_bytes(path, most).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise FileError(str(path), f"is not UTF-8 (byte {error.start})", "save it as UTF-8 text") from None


def csv_rows(text: str, name: str) -> Iterator[tuple[int, list[str]]]:
    """The rows of a table, each with the number of its line, from 1; a carriage return alone ends a line, too.

    Args:
        text: Of the file.
        name: Of the file, as errors call it.

    Raises:
        FileError: If a row is no CSV, or a cell has more letters than `csv` takes, 131 072; the error gives the line.
    """
    reader = csv.reader(io.StringIO(text, newline=None), skipinitialspace=True)
    try:
        for row in reader:
            yield reader.line_num, row
    except csv.Error as error:
        allowed = f"a cell has at most {csv.field_size_limit()} letters"
        raise FileError(f"{name}:{reader.line_num}", f"is not valid CSV ({error})", allowed) from None


def parse_toml(text: str) -> Json:
    """The table of a TOML text.

    Raises:
        ValueError: If it is none, has a number of thousands of digits, is nested too deeply, or has a key of more than `MOST_PARTS` parts.
    """
    if text.count(".") > MOST_PARTS:
        plain = _KEPT_WHOLE.sub(lambda match: "" if match["comment"] else "s", text)
        if (long := _LONG_KEY.search(plain)) is not None:
            raise ValueError(f"a key has more than {MOST_PARTS} parts: {long[0][:40]}...")
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise ValueError("it is nested too deeply") from None


_TO_ROBOT: Final = "`clamber new robot --from {path} -o {stem}.toml` makes a robot file of it"
_TO_WORLD: Final = "`clamber new world --mesh {path} -o {stem}.toml` makes a world in space of it"
_TO_MESH: Final = "`clamber new world --mesh` makes a world in space of an STL, OBJ or PLY file, so convert it first"
_TO_TOML: Final = "Clamber reads TOML: `clamber new robot`, `new board` and `new task` write files to start from"
OTHER_FILES: Final = {
    ".urdf": ("a URDF robot model", _TO_ROBOT),
    ".mjcf": ("a MuJoCo model (MJCF)", _TO_ROBOT),
    ".xml": ("a robot model (MJCF or URDF)", _TO_ROBOT),
    ".xacro": ("a xacro macro file", "`xacro {path} -o {stem}.urdf` makes a URDF of it, which `clamber new robot --from` takes"),
    ".sdf": ("an SDF model", "Clamber reads URDF and MJCF (`clamber new robot --from`), so convert it first"),
    **dict.fromkeys((".stl", ".obj", ".ply"), ("a mesh", _TO_WORLD)),
    **dict.fromkeys((".dae", ".glb", ".gltf", ".step", ".stp"), ("a mesh", _TO_MESH)),
    **dict.fromkeys((".yaml", ".yml"), ("YAML", _TO_TOML)),
    ".mcap": ("a log of a run", "`clamber view {path}` plays it, `clamber export {path}` writes it for other programs"),
}  # fmt: skip
"""Suffix of files that no task, plan, robot or world is read from -> what they are, and what to do with them."""


def other_file(name_or_path: str | Path) -> FileError | None:
    """The error about a folder, or about a file of another program by its suffix, with what to do with it; None: it is neither."""
    text = str(name_or_path)
    path = user_path(text)
    if is_folder(path):
        found = sorted(one.name for one in path.glob("*.toml"))
        words = f"name a file in it, such as {', '.join(found[:5])}" if found else "it has no TOML files; name a file"
        return FileError(text, "is a folder", words)
    if (kind := OTHER_FILES.get(path.suffix.lower())) is None or not is_file(path):
        return None
    return FileError(text, f"is {kind[0]}", kind[1].format(path=text, stem=path.stem))


def unknown_name(kind: str, name: str, known: tuple[str, ...]) -> ClamberError:
    """The error about a name that nothing of a kind has, or about the file or the folder that it is in truth."""
    if (other := other_file(name)) is not None:
        return other
    if Path(name).suffix.lower() in OTHER_FILES:
        return FileError(name, "does not exist", f"or name one of these: {describe_choices(name, known)}")
    return UnknownNameError(kind, name, known)


def read_toml(path: Path, label: str | None = None) -> Document:
    """A TOML file as a document.

    Raises:
        FileError: If it cannot be read or is no TOML; the error gives the line, or what to do with a file of another program.
    """
    if (other := other_file(path)) is not None:
        raise other
    text = read_text(path)
    try:
        data = parse_toml(text)
    except ValueError as error:
        raise FileError(str(path), f"is not valid TOML: {error}", "see https://toml.io") from None
    return Document(label or str(path), data, (), path.parent)


def csv_text(rows: Iterable[Iterable[Any]]) -> str:
    """Rows as CSV; None is an empty field."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def parse_json(text: str | bytes) -> Any:
    """Plain data from JSON text whose numbers are all finite.

    Raises:
        ValueError: If it is none, or nested too deep.
    """
    try:
        return json.loads(text, parse_constant=_no_number, parse_float=_finite)
    except RecursionError:
        raise ValueError("it is nested too deep") from None


def _no_number(word: str) -> float:
    raise ValueError(f"{word} is no JSON number")


def _finite(word: str) -> float:
    if math.isinf(value := float(word)):
        raise ValueError(f"{word[:40]} is larger than any number")
    return value


def check_schema(document: Document, schema: str) -> None:
    """Makes sure that the file says which schema it follows, and that it is `schema`.

    Raises:
        SpecError: If it names another, or none.
    """
    if document.data.get("schema") != schema:
        stated = document.data.get("schema")
        kind, stated_kind = (str(one).removeprefix("clamber-").rpartition("-")[0] for one in (schema, stated))
        shown = (
            f"; `clamber show {document.label}` draws a {stated_kind}"
            if stated_kind in ("robot", "board", "ground")
            else ""
        )
        raise document.problem(
            "schema", f'the file must say schema = "{schema}"{f": it must be a {kind}{shown}" if shown else ""}'
        )


def content_hash(content: object) -> str:
    """SHA-256 in hex of bytes, of text (UTF-8), or of plain data as JSON with sorted keys and no blanks."""
    if isinstance(content, bytes):
        return hashlib.sha256(content).hexdigest()
    text = content if isinstance(content, str) else json.dumps(content, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def data_names(folder: Path) -> tuple[str, ...]:
    """Names of the TOML files shipped in a data folder, sorted."""
    return tuple(sorted(path.stem for path in folder.glob("*.toml")))


def as_text(given: Any, option: str = "name_or_path") -> str:
    """The text of a name or a path.

    Raises:
        OptionError: If it is neither.
    """
    if not isinstance(given, str | Path):
        raise OptionError.of_value(option, given, "is no name or path", "give the text, or a `Path`, of one")
    return str(given)


def is_path(name_or_path: str) -> bool:
    """Whether a text is meant as a path rather than as the name of shipped data."""
    return "/" in name_or_path or os.sep in name_or_path or Path(name_or_path).suffix in {".toml", ".csv"}


def find_data(kind: str, name_or_path: str, folders: Sequence[Path], folder: Path | None = None) -> tuple[Path, str]:
    """Path and label of shipped data by name, or of a user's file by path (relative to `folder`).

    Args:
        kind: Of data, for errors, such as "robot".
        name_or_path: A name, or what `is_path` takes for a path.
        folders: Where shipped data of this kind lies.
        folder: Where the user's relative paths start; None: where the user stands.

    Raises:
        UnknownNameError: If it looks like a name and nothing shipped has it.
    """
    name_or_path = as_text(name_or_path)
    if is_path(name_or_path):
        path = user_path(name_or_path)
        return (path if path.is_absolute() or folder is None else folder / path), name_or_path
    for data in folders:
        if name_or_path in data_names(data):
            return data / f"{name_or_path}.toml", f"{data.name}/{name_or_path}.toml"
    raise unknown_name(kind, name_or_path, tuple(sorted(name for data in folders for name in data_names(data))))
