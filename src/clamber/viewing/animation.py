"""Animations: the frames of plans and runs, as pixels, in GIF and MP4; what stands still is drawn once."""

import importlib.util
import tempfile
from collections.abc import Callable, Iterable, Iterator
from io import BytesIO
from pathlib import Path
from typing import Any, Final, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from ..files import write_atomically
from . import style
from .output import MissingExtraError
from .recording import Frame, Moment

Ints = npt.NDArray[np.int_]
Pixels = npt.NDArray[np.uint8]
"""RGB, shape (height, width, 3)."""
Progress: TypeAlias = Callable[[int, int], None]
"""Told each frame that is drawn, from 1, and how many there are."""
MOST_FRAMES: Final = {".gif": 640, ".mp4": 6000}
GIF_DPI: Final = 100
VIDEO_DPI: Final = 140
FRAME_MS: Final = 70
"""Time of one frame of a GIF [ms]; GIF counts in tens."""
RATE: Final = 15
"""Frames of a video in a second."""
COLOURS: Final = 63
"""Colours of a GIF's palette; one more index stands for "as before"."""
AREAS: Final = 16
"""Colours of the palette that are for large areas."""
SAMPLES: Final = 4
"""Frames the palette is made for."""
PLACES: Final = np.array((1 << 16, 1 << 8, 1), np.uint32)
"""Of red, green and blue in a colour's number."""


def untold(frame: int, of: int) -> None:
    """Progress that nobody is told."""


class Animated(Protocol[Moment]):
    """A picture of which a part changes from moment to moment."""

    figure: Figure

    @property
    def artists(self) -> list[Artist]:
        """The artists that change, from back to front."""

    def show(self, step: int, at: Moment, /) -> None:
        """Set the picture to a moment of a step."""

    def frames(self, most: int) -> list[Frame[Moment]]:
        """What an animation of at most so many frames shows."""


def rasterise(
    picture: Animated[Moment], frames: list[Frame[Moment]], dpi: int, progress: Progress = untold
) -> Iterator[Pixels]:
    """Each frame as pixels; both sides are even, as video formats want them."""
    figure = picture.figure
    w, h = figure.get_size_inches()
    figure.set_size_inches(2 * round(w * dpi / 2) / dpi, 2 * round(h * dpi / 2) / dpi)
    figure.set_dpi(dpi)
    canvas = FigureCanvasAgg(figure)
    for artist in picture.artists:
        artist.set_animated(True)
    canvas.draw()  # type: ignore[no-untyped-call]
    still = canvas.copy_from_bbox(figure.bbox)  # type: ignore[no-untyped-call]
    for number, frame in enumerate(frames, start=1):
        progress(number, len(frames))
        canvas.restore_region(still)  # type: ignore[no-untyped-call]
        picture.show(frame.step, frame.moment)
        for artist in picture.artists:  # again for each frame: a lifted frame passes over a standing one
            figure.draw_artist(artist)
        colours = np.asarray(canvas.buffer_rgba())  # type: ignore[no-untyped-call]
        yield colours[..., :3].copy()
    for artist in picture.artists:
        artist.set_animated(False)


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


def write_gif(
    picture: Animated[Any], path: Path, progress: Progress = untold, *, most: int = MOST_FRAMES[".gif"]
) -> None:
    """Write an animated GIF that runs for ever."""
    frames = picture.frames(most)
    some = [frames[k] for k in np.linspace(0, len(frames) - 1, SAMPLES).astype(int)]
    palette = make_palette(np.concatenate(list(rasterise(picture, some, GIF_DPI))))
    colours = (palette.getpalette() or [])[: 3 * COLOURS]
    before: np.ndarray[tuple[int, int], np.dtype[np.uint8]] | None = None
    images: list[Image.Image] = []
    for pixels in rasterise(picture, frames, GIF_DPI, progress):
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
        content,
        "GIF",
        save_all=True,
        append_images=images[1:],
        duration=durations,
        loop=0,
        disposal=1,
        transparency=COLOURS,
        optimize=False,
    )
    write_atomically(path, content.getvalue())


def write_mp4(picture: Animated[Any], path: Path, progress: Progress = untold) -> None:
    """Write H.264 video, through the ffmpeg that the extra `video` brings.

    Raises:
        MissingExtraError: If imageio-ffmpeg is not installed.
    """
    if not has_ffmpeg():
        raise MissingExtraError(f"writing {path.name}", "imageio-ffmpeg", "video")
    frames = picture.frames(MOST_FRAMES[".mp4"])
    drawn = zip(frames, rasterise(picture, frames, VIDEO_DPI, progress), strict=True)
    write_atomically(path, video(pixels for frame, pixels in drawn for _ in range(max(1, round(frame.length)))))


def has_ffmpeg() -> bool:
    """Whether videos can be made."""
    return importlib.util.find_spec("imageio_ffmpeg") is not None


def video(pictures: Iterable[Pixels]) -> bytes:
    """H.264 video of pictures of one size, `RATE` of them in a second."""
    import imageio_ffmpeg

    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "video.mp4"
        writer = None
        for pixels in pictures:
            if writer is None:
                writer = imageio_ffmpeg.write_frames(
                    str(target),
                    (pixels.shape[1], pixels.shape[0]),
                    fps=RATE,
                    codec="libx264",
                    quality=7,
                    macro_block_size=2,
                    ffmpeg_log_level="error",
                )
                writer.send(None)
            writer.send(pixels.tobytes())
        if writer is not None:
            writer.close()
        return target.read_bytes()


WRITERS: Final[dict[str, Callable[[Animated[Any], Path, Progress], None]]] = {".gif": write_gif, ".mp4": write_mp4}
"""Suffix -> what writes it."""
