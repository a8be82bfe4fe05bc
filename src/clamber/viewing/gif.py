"""Animated GIF: one palette for all frames, and only what changes is stored."""

from io import BytesIO
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from PIL import Image

from ..files import write_atomically
from . import style
from .frames import Frame, make_frames
from .raster import Animated, Pixels, rasterise
from .view import Moment, View

Ints = npt.NDArray[np.int_]
MOST_FRAMES: Final = 640
FRAME_MS: Final = 70
"""Time of one frame [ms]; GIF counts in tens."""
COLOURS: Final = 63
"""Colours of the palette; one more index stands for "as before"."""
AREAS: Final = 16
"""Colours of the palette that are for large areas."""
SAMPLES: Final = 4
"""Frames that the palette is made for."""
DPI: Final = 100
PLACES: Final = np.array((1 << 16, 1 << 8, 1), np.uint32)
"""Of red, green and blue in a colour's number."""


def make_palette(pixels: Pixels) -> Image.Image:
    """A palette of `COLOURS`: those of our style exactly, the largest flat areas', and what passes between them."""
    named = (
        style.PAPER, style.WALL, style.FAINT, style.INK, style.QUIET, style.BODY, style.HOLD, style.GOAL, style.FORCE,
        *style.PARTS, *style.STRIP,
    )  # fmt: skip
    chosen = np.array([[int(colour[k : k + 2], 16) for k in (1, 3, 5)] for colour in named])
    numbers, counts = np.unique(pixels.astype(np.uint32) @ PLACES, return_counts=True)  # of rows would take seconds
    seen = (numbers[np.argsort(-counts), None] // PLACES % 256).astype(int)
    chosen = _add(chosen, seen, len(chosen) + AREAS)
    mixed = Image.fromarray(pixels).quantize(COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    chosen = _add(chosen, np.array(mixed.getpalette() or []).reshape(-1, 3), COLOURS)
    palette = Image.new("P", (1, 1))
    filled = np.concatenate([chosen, np.repeat(chosen[:1], COLOURS - len(chosen), axis=0)])  # no index is left over
    palette.putpalette(filled.ravel().tolist())
    return palette


def _add(chosen: Ints, colours: Ints, most: int) -> Ints:
    """Colours chosen so far and the first others that differ, up to `most`.

    One that is nearly another would win over it now and then, for Pillow looks colours up coarsely.
    """
    for colour in colours:
        if len(chosen) < most and np.abs(chosen - colour).max(axis=1).min() > 8:
            chosen = np.vstack([chosen, colour])
    return chosen


def write_gif(view: View[Any], path: Path, *, most_frames: int = MOST_FRAMES) -> None:
    """Write a plan as an animated GIF that runs for ever."""
    write_gif_frames(view, make_frames(view, most_frames), path)


def write_gif_frames(view: Animated[Moment], frames: list[Frame[Moment]], path: Path) -> None:
    """Write frames as an animated GIF that runs for ever."""
    some = [frames[k] for k in np.linspace(0, len(frames) - 1, SAMPLES).astype(int)]
    palette = make_palette(np.concatenate(list(rasterise(view, some, DPI))))
    colours = (palette.getpalette() or [])[: 3 * COLOURS]
    before: np.ndarray[tuple[int, int], np.dtype[np.uint8]] | None = None
    images: list[Image.Image] = []
    for pixels in rasterise(view, frames, DPI):
        indexed = Image.fromarray(pixels).quantize(palette=palette, dither=Image.Dither.NONE)
        now = np.asarray(indexed)
        shown = now if before is None else np.where(now == before, np.uint8(COLOURS), now)
        image = Image.fromarray(shown.astype(np.uint8), mode="P")
        image.putpalette([*colours, 255, 255, 255])
        images.append(image)
        before = now
    content = BytesIO()
    durations = [10 * round(FRAME_MS * frame.length / 10) for frame in frames]
    images[0].save(
        content, "GIF", save_all=True, append_images=images[1:], duration=durations, loop=0, disposal=1,
        transparency=COLOURS, optimize=False,
    )  # fmt: skip
    write_atomically(path, content.getvalue())
