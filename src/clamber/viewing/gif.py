"""Animated GIF: one palette for all frames, and only what changes is stored."""

from io import BytesIO
from pathlib import Path
from typing import Any, Final

import numpy as np
from PIL import Image

from ..files import write_atomically
from . import style
from .frames import make_frames
from .raster import Pixels, rasterise
from .view import View

MOST_FRAMES: Final = 640
FRAME_MS: Final = 70
"""Time of one frame [ms]; GIF counts in tens."""
COLOURS: Final = 63
"""Colours of the palette; one more index stands for "as before"."""
DPI: Final = 100


def make_palette(pixels: Pixels) -> Image.Image:
    """A palette of `COLOURS`: those of our style exactly, and between them what the first frame has most of."""
    named = [
        style.PAPER,
        style.WALL,
        style.FAINT,
        style.INK,
        style.QUIET,
        style.BODY,
        style.HOLD,
        style.GOAL,
        style.FORCE,
    ]
    exact = [int(colour[k : k + 2], 16) for colour in (*named, *style.PARTS, *style.STRIP) for k in (1, 3, 5)]
    room = COLOURS - len(exact) // 3
    mixed = Image.fromarray(pixels).quantize(room, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    ours = np.array(exact).reshape(-1, 3)
    colours = list(exact)
    for colour in np.array((mixed.getpalette() or [])[: 3 * room]).reshape(-1, 3):
        # one that is nearly ours would win over it now and then, for Pillow looks colours up coarsely
        if np.abs(ours - colour).max(axis=1).min() > 8:
            colours += colour.tolist()
    palette = Image.new("P", (1, 1))
    palette.putpalette(colours + exact[:3] * (COLOURS - len(colours) // 3))  # filled up, so that no index is left over
    return palette


def write_gif(view: View[Any], path: Path, *, most_frames: int = MOST_FRAMES) -> None:
    """Write a plan as an animated GIF that runs for ever."""
    frames = make_frames(view, most_frames)
    palette: Image.Image | None = None
    before: np.ndarray[tuple[int, int], np.dtype[np.uint8]] | None = None
    images: list[Image.Image] = []
    for pixels in rasterise(view, frames, DPI):
        if palette is None:
            palette = make_palette(pixels)
        indexed = Image.fromarray(pixels).quantize(palette=palette, dither=Image.Dither.NONE)
        now = np.asarray(indexed)
        shown = now if before is None else np.where(now == before, np.uint8(COLOURS), now)
        image = Image.fromarray(shown.astype(np.uint8), mode="P")
        colours = (palette.getpalette() or [])[: 3 * COLOURS]
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
