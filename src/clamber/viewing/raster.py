"""Frames as pixels: what stands still is drawn once, and only the robot and the panel's bars again."""

from collections.abc import Iterator
from typing import Protocol, TypeVar

import numpy as np
import numpy.typing as npt
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from .frames import Frame

Pixels = npt.NDArray[np.uint8]
"""RGB, shape (height, width, 3)."""
Moment = TypeVar("Moment")
Shown = TypeVar("Shown", contravariant=True)


class Animated(Protocol[Shown]):
    """A picture of which a part changes from moment to moment."""

    figure: Figure

    @property
    def artists(self) -> list[Artist]:
        """The artists that change, from back to front."""

    def show(self, step: int, at: Shown, /) -> None:
        """Set the picture to a moment of a step."""


def rasterise(view: Animated[Moment], frames: list[Frame[Moment]], dpi: int) -> Iterator[Pixels]:
    """Each frame as pixels; both sides are even, as video formats want them."""
    figure = view.figure
    w, h = figure.get_size_inches()
    figure.set_size_inches(2 * round(w * dpi / 2) / dpi, 2 * round(h * dpi / 2) / dpi)
    figure.set_dpi(dpi)
    canvas = FigureCanvasAgg(figure)
    for artist in view.artists:
        artist.set_animated(True)
    canvas.draw()  # type: ignore[no-untyped-call]
    still = canvas.copy_from_bbox(figure.bbox)  # type: ignore[no-untyped-call]
    for frame in frames:
        canvas.restore_region(still)  # type: ignore[no-untyped-call]
        view.show(frame.step, frame.moment)
        for artist in view.artists:  # again for each frame: a lifted frame passes over a standing one
            figure.draw_artist(artist)
        colours = np.asarray(canvas.buffer_rgba())  # type: ignore[no-untyped-call]
        yield colours[..., :3].copy()
    for artist in view.artists:
        artist.set_animated(False)
