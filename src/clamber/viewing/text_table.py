"""Tables as a terminal shows them."""

from typing import Any

from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderResult
from rich.table import Table
from rich.text import Text


class PlainTable(Table):
    """A table without lines that breaks no number: where it is too wide its columns move together, and its heads break at spaces."""

    def add_row(self, *cells: Any, **style: Any) -> None:
        """See `Table`."""
        super().add_row(*cells, **style)
        for column, cell in zip(self.columns, cells, strict=False):
            if column.justify == "right":
                column.min_width = max(column.min_width or 0, cell_len(str(cell)))

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """See `Table`."""
        room = options.max_width
        for column in self.columns:
            column.width = None
        self.collapse_padding = self.__rich_measure__(console, options.update_width(10 * room)).maximum > room
        if self.collapse_padding:
            self._break_at_spaces(room - len(self.columns) + 1)
        yield from super().__rich_console__(console, options)

    def _break_at_spaces(self, room: int) -> None:
        """Give each column the width of its longest word and a share of what is left, where all words have room."""
        cells = [[str(cell) for cell in (column.header, *column.cells)] for column in self.columns]
        whole = [max(map(cell_len, texts)) for texts in cells]
        least = [
            max(column.min_width or 0, *(cell_len(word) for text in texts for word in text.split()), 0)
            for column, texts in zip(self.columns, cells, strict=True)
        ]
        left, wanted = room - sum(least), sum(whole) - sum(least)
        if left < 0 or wanted <= 0:
            return
        for column, word, most in zip(self.columns, least, whole, strict=True):
            column.width = word + min(left, wanted) * (most - word) // wanted


def plain_table(*columns: str, right: tuple[str, ...] = ()) -> Table:
    """A table without lines; the columns in `right` hold numbers."""
    table = PlainTable(box=None, pad_edge=False, header_style="bold")
    for column in columns:
        table.add_column(Text(column), justify="right" if column in right else "left", overflow="fold")
    return table
