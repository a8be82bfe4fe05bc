"""Robot and world of a task or a walk: named in its file, put in place of their names, and found there again."""

from collections.abc import Callable, Container, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from ..files import Document
from .overrides import split_override

Read: TypeAlias = Callable[[str, Path | None], Document]
"""A part's document by its name or path; paths are relative to a folder, None: where the user stands."""


@dataclass(frozen=True, slots=True)
class Naming:
    """A file with the names of its parts, as overrides have changed them."""

    document: Document
    here: frozenset[str]
    """Parts that overrides name: a path there starts where the user stands, not at the file."""
    others: list[str]
    """Overrides that are still to apply, to what the parts say."""

    @classmethod
    def of(cls, document: Document, overrides: Sequence[str], parts: Container[str]) -> "Naming":
        """Take the overrides of keys in `parts`.

        Raises:
            SpecError: If an override is none.
        """
        named: list[tuple[str, str]] = []
        names: dict[str, object] = {}
        others: list[str] = []
        for text in overrides:
            key, value = split_override(text)
            if key in parts:
                names[key] = value
                named.append((key, text))
            else:
                others.append(text)
        renamed = Document(document.label, document.data | names, tuple(named), document.folder)
        return cls(renamed, frozenset(names), others)

    def read(self, part: str, read: Read) -> Document:
        """The document of a part."""
        return read(name_of(self.document, part), None if part in self.here else self.document.folder)

    def merged(self, **parts: Document) -> Document:
        """The file's document with its parts in place of their names, and what errors call each."""
        data = self.document.data | {name: part.data for name, part in parts.items()}
        labels = {name: part.label for name, part in parts.items()}
        return Document(self.document.label, data | {"labels": labels}, (), self.document.folder)


def name_of(document: Document, part: str) -> str:
    """The name or path of a part.

    Raises:
        SpecError: If the document has none.
    """
    name = document.data.get(part)
    if not isinstance(name, str) or not name:
        raise document.problem(part, f"must name a {part}, or give the path of its file, in quotes")
    return name


def parts_of(document: Document, world: str) -> dict[str, Document]:
    """The documents of robot and world that a merged document has in place of their names; `world` is the world's key."""
    return {section: document.section(section, _label(document, section)) for section in ("robot", world)}


def _label(document: Document, section: str) -> str:
    labels = document.data.get("labels")
    label = labels.get(section) if isinstance(labels, dict) else None
    return label if isinstance(label, str) else f"{document.label} [{section}]"
