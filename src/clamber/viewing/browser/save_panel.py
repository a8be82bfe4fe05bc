"""The part of the panel that writes what was made on the page to files: the edited board, its task, and a plan of it."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Final

from ...errors import ClamberError, FileError, SpecError
from ...regular_files import is_there, write_together
from .. import style
from .inputs import by_hand
from .panel_html import message_html
from .solids import colour

if TYPE_CHECKING:
    import viser

NAME: Final = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,47}")
"""What files may be called; no path, so that a page writes where its viewer was started and nowhere else."""


class SavePanel:
    """A name, a button, and where the files went.

    Args:
        server: Whose panel they are in; they are made where its context is.
        name: What the files are called unless the page says otherwise.
        folder: Where they go.
        files: Gives names of files and their texts for a name; raises `ClamberError` where there is nothing to save.
    """

    def __init__(
        self, server: "viser.ViserServer", name: str, folder: Path, files: Callable[[str], dict[str, str]]
    ) -> None:
        self._folder, self._files = folder.resolve(), files
        self._written: set[Path] = set()
        gui = server.gui
        with gui.add_folder("Save"):
            self._name = gui.add_text("name", name, hint=f"Files go to {self._folder}")
            self._button = gui.add_button("Save", color=colour(style.PARTS[0]))
            self._words = gui.add_html("")
        self._button.on_click(by_hand(lambda _: self.save()))

    def save(self) -> None:
        """Write the files, and tell where they are, or why nothing was written."""
        try:
            paths = self._write(self._name.value.strip())
        except ClamberError as error:
            self._words.content = message_html(str(error), bad=True)
            return
        names = ", ".join(path.name for path in paths)
        self._words.content = message_html(f"written to {self._folder}: {names}", bad=False)

    def _write(self, name: str) -> list[Path]:
        if not NAME.fullmatch(name):
            raise SpecError("save", "name", name, "must be a letter and up to 47 letters, digits, '-' and '_'; no path")
        texts = {self._folder / file: text for file, text in self._files(name).items()}
        for path in texts:
            if is_there(path) and path not in self._written:  # what this page wrote it may write again
                raise FileError(str(path), "is there already", "choose another name")
        write_together(texts)
        self._written.update(texts)
        return list(texts)
