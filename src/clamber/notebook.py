"""How answers look where Python shows them: one line in a console, a picture in a notebook."""

import base64
import tempfile
from html import escape
from pathlib import Path
from typing import Any

from .errors import ClamberError


class OneLine:
    """Base of dataclasses without a `repr` of their own (`repr=False`; specs see to that): what they are, in one line."""

    __slots__ = ()

    def told(self) -> str:
        """What stands in the line behind the type."""
        named: Any = self
        return f"{named.name!r}: {named.title}" if named.title else repr(named.name)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.told()}>"


class Pictured(OneLine):
    """Base of what `clamber.draw` draws, so that a notebook shows it; with a line alone where there is no picture of its kind."""

    __slots__ = ()

    def _repr_html_(self) -> str:
        from . import draw

        words = escape(self.told())
        with tempfile.TemporaryDirectory() as folder:
            try:
                data = base64.b64encode(draw(self, Path(folder) / "shown.png").read_bytes()).decode("ascii")
            except ClamberError:
                return f"<p>{words}</p>"
        return f'<img alt="{words}" src="data:image/png;base64,{data}"><p>{words}</p>'
