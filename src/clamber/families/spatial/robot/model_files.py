"""Files that a model names, looked at before MuJoCo opens them: it opens pipes and devices as well, and reads any size."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Final
from xml.etree import ElementTree

from ....errors import FileError
from ....files import read_text
from ....regular_files import is_there, read_bytes

MOST_MODEL: Final = 8 * 1024 * 1024
"""Largest model file that is read [bytes]."""
MOST_MESH: Final = 64 * 1024 * 1024
"""Largest file of a mesh, or of anything else that a model names, that is read [bytes]."""
FOLDERS: Final = ("assetdir", "meshdir", "texturedir")
"""Attributes of <compiler> that name where files lie."""
MODELS: Final = ("include", "model")
"""Elements whose file is a model, which names files itself."""


def parse_model(path: Path) -> ElementTree.Element:
    """The root element of a model file.

    Raises:
        FileError: If it can't be read or is no XML, or defines entities, which MuJoCo reads in another way.
    """
    text = read_text(path, MOST_MODEL)
    if "<!ENTITY" in text:
        raise FileError(str(path), "defines an <!ENTITY>", "write out what it stands for")
    try:
        return ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise FileError(str(path), f"is not valid XML: {error}", "name a URDF or MJCF file") from None


def read_named(model: Path, element: str, file: Path) -> bytes:
    """The bytes of a mesh, or of something like it, that a model names.

    Args:
        model: The model's file.
        element: What names it, as the model's author would look for it.
        file: Where it lies.

    Raises:
        FileError: If it is no regular file or too large; it names model, element and file.
    """
    try:
        return read_bytes(file, MOST_MESH)
    except FileError as error:
        raise _named(model, element, error) from None


def check_named(root: ElementTree.Element, path: Path) -> None:
    """Make sure that whatever an MJCF model names is a regular file that is not too large, or is not there.

    A file may lie anywhere, from the folder of the model or of the file that includes it. Where MuJoCo would take the first of several
    places, each is looked at.

    Raises:
        FileError: If it isn't; it names the file that names it, the element, and what is allowed.
    """
    parts = dict(_parts(root, path, {path.resolve()}))
    folders = [
        compiler.get(key, "") for part in parts.values() for compiler in _elements(part, "compiler") for key in FOLDERS
    ]
    for part, tree in parts.items():
        bases = {path.parent, part.parent}
        for element in tree.iter():
            if str(element.tag).lower() in MODELS:
                continue
            for said in (value for key, value in element.attrib.items() if key.startswith("file")):
                for file in _places(said, bases, folders):
                    if is_there(file):
                        read_named(part, _shown(element), file)


def _parts(root: ElementTree.Element, path: Path, seen: set[Path]) -> Iterator[tuple[Path, ElementTree.Element]]:
    """A model and every one that it includes or attaches, and theirs, each once: its file and its root."""
    waiting = [(path, root)]
    while waiting:
        part, tree = waiting.pop()
        yield part, tree
        for element in (one for tag in MODELS for one in _elements(tree, tag)):
            for file in _places(element.get("file", ""), {path.parent, part.parent}, []):
                if is_there(file) and file.resolve() not in seen:
                    seen.add(file.resolve())
                    try:
                        waiting.append((file, parse_model(file)))
                    except FileError as error:
                        raise _named(part, _shown(element), error) from None


def _elements(tree: ElementTree.Element, tag: str) -> Iterator[ElementTree.Element]:
    """Elements of a name, in letters of either case, as MuJoCo has them."""
    return (element for element in tree.iter() if str(element.tag).lower() == tag)


def _places(said: str, bases: set[Path], folders: list[str]) -> set[Path]:
    """Where MuJoCo may look for a file: from each base, in each folder or in none, with its path or without."""
    said = said.replace("\\", "/")
    names = {said, said.rpartition("/")[2]} if said else set()
    inner = {"", *(folder.replace("\\", "/") for folder in folders)}
    return {
        Path(os.path.normpath(base / folder / name)) for base in bases for folder in inner for name in names if name
    }


def _shown(element: ElementTree.Element) -> str:
    """An element as it begins in its file."""
    told = [f"{key}='{value}'" for key, value in element.attrib.items() if key == "name" or key.startswith("file")]
    return f"<{' '.join([str(element.tag), *told])}>"


def _named(model: Path, element: str, error: FileError) -> FileError:
    return FileError(str(model), f"{element}: {error.path} {error.problem}", error.allowed)
