"""Tables as a terminal shows them."""

from typing import Any

from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderResult
from rich.table import Table
from rich.text import Text


class PlainTable(Table):
    """A table without lines that breaks no number: where it is too wide its columns move together, and its heads break."""

    def add_row(self, *cells: Any, **style: Any) -> None:
        """See `Table`."""
        super().add_row(*cells, **style)
        for column, cell in zip(self.columns, cells, strict=False):
            if column.justify == "right":
                column.min_width = max(column.min_width or 0, cell_len(str(cell)))

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """See `Table`."""
        room = options.max_width
        self.collapse_padding = self.__rich_measure__(console, options.update_width(10 * room)).maximum > room
        yield from super().__rich_console__(console, options)


def plain_table(*columns: str, right: tuple[str, ...] = ()) -> Table:
    """A table without lines; the columns in `right` hold numbers."""
    table = PlainTable(box=None, pad_edge=False, header_style="bold")
    for column in columns:
        table.add_column(Text(column), justify="right" if column in right else "left", overflow="fold")
    return table
