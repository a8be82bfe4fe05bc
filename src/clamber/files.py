"""Files in and out: TOML with named errors, atomic writes, content hashes, schema versions, shipped data by name."""

import hashlib
import json
import os
import tempfile
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from .errors import MISSING, FileError, SpecError, UnknownNameError, describe_choices
from .types import Json

MAX_BYTES: Final = 16 * 1024 * 1024
"""Largest file that is read as text [bytes]."""


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


def read_text(path: Path) -> str:
    """The text of a UTF-8 file of at most `MAX_BYTES`.

    Raises:
        FileError: If it is missing, a folder, too large, or not UTF-8.
    """
    name = str(path)
    try:
        if path.is_dir():
            raise FileError(name, "is a folder", "name a file")
        if (size := path.stat().st_size) > MAX_BYTES:
            raise FileError(name, f"has {size} bytes", f"at most {MAX_BYTES} are read")
        return path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise FileError(name, "does not exist", f"files beside it: {_beside(path)}") from None
    except UnicodeDecodeError as error:
        raise FileError(name, f"is not UTF-8 (byte {error.start})", "save it as UTF-8 text") from None
    except (OSError, ValueError) as error:
        raise FileError(name, f"cannot be read ({error})", "name a readable file") from None


def _beside(path: Path) -> str:
    try:
        names = sorted(p.name for p in path.parent.iterdir() if p.suffix == path.suffix)
    except OSError:
        return f"none, for the folder {path.parent} cannot be read"
    return describe_choices(path.name, names, limit=10)


def read_toml(path: Path, label: str | None = None) -> Document:
    """A TOML file as a document.

    Raises:
        FileError: If it cannot be read or is no TOML; the error gives the line.
    """
    text = read_text(path)
    try:
        data = tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # ValueError also for a whole number of thousands of digits
        raise FileError(str(path), f"is not valid TOML: {error}", "see https://toml.io") from None
    return Document(label or str(path), data, (), path.parent)


def check_schema(document: Document, schema: str) -> None:
    """Makes sure that the file says which schema it follows, and that it is `schema`.

    Raises:
        SpecError: If it names another, or none.
    """
    if document.data.get("schema") != schema:
        raise document.problem("schema", f'the file must say schema = "{schema}"')


def write_atomically(path: Path, content: str | bytes) -> None:
    """Writes beside the target and renames, so that a reader or a crash never sees half a file.

    Raises:
        FileError: If the folder is missing or cannot be written.
    """
    raw = content.encode("utf-8") if isinstance(content, str) else content
    temporary = ""
    try:
        handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        with os.fdopen(handle, "wb") as stream:
            stream.write(raw)
            stream.flush()
            os.fsync(stream.fileno())
        os.chmod(temporary, 0o666 & ~_umask())
        os.replace(temporary, path)
    except OSError as error:
        if temporary:
            Path(temporary).unlink(missing_ok=True)
        raise FileError(
            str(path), f"cannot be written ({error.strerror})", "name a file in a writable folder"
        ) from None


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def content_hash(content: object) -> str:
    """SHA-256 in hex of bytes, of text (UTF-8), or of plain data as JSON with sorted keys and no blanks."""
    if isinstance(content, bytes):
        return hashlib.sha256(content).hexdigest()
    text = content if isinstance(content, str) else json.dumps(content, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def data_names(folder: Path) -> tuple[str, ...]:
    """Names of the TOML files shipped in a data folder, sorted."""
    return tuple(sorted(path.stem for path in folder.glob("*.toml")))


def is_path(name_or_path: str) -> bool:
    """Whether a text is meant as a path rather than as the name of shipped data."""
    return "/" in name_or_path or os.sep in name_or_path or Path(name_or_path).suffix in {".toml", ".csv"}


def find_data(kind: str, name_or_path: str, data: Path, folder: Path | None = None) -> tuple[Path, str]:
    """Path and label of shipped data by name, or of a user's file by path (relative to `folder`).

    Raises:
        UnknownNameError: If it looks like a name and nothing shipped has it.
    """
    if is_path(name_or_path):
        path = Path(name_or_path).expanduser()
        return (path if path.is_absolute() or folder is None else folder / path), name_or_path
    names = data_names(data)
    if name_or_path not in names:
        raise UnknownNameError(kind, name_or_path, names)
    return data / f"{name_or_path}.toml", f"{data.parent.name}/data/{name_or_path}.toml"
