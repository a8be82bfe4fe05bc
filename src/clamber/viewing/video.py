"""MP4, through the ffmpeg that the extra `video` brings."""

import tempfile
from pathlib import Path
from typing import Any, Final

from ..files import write_atomically
from .frames import Frame, make_frames
from .output import MissingExtraError
from .raster import Animated, rasterise
from .view import Moment, View

MOST_FRAMES: Final = 6000
RATE: Final = 15
"""Frames per second."""
DPI: Final = 140


def write_mp4(view: View[Any], path: Path, *, most_frames: int = MOST_FRAMES) -> None:
    """Write a plan as H.264 video.

    Raises:
        MissingExtraError: If imageio-ffmpeg is not installed.
    """
    write_mp4_frames(view, make_frames(view, most_frames), path)


def write_mp4_frames(view: Animated[Moment], frames: list[Frame[Moment]], path: Path) -> None:
    """Write frames as H.264 video.

    Raises:
        MissingExtraError: If imageio-ffmpeg is not installed.
    """
    try:
        import imageio_ffmpeg
    except ImportError:
        raise MissingExtraError(f"writing {path.name}", "imageio-ffmpeg", "video") from None
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "plan.mp4"
        writer = None
        for frame, pixels in zip(frames, rasterise(view, frames, DPI), strict=True):
            if writer is None:
                size = pixels.shape[1], pixels.shape[0]
                writer = imageio_ffmpeg.write_frames(
                    str(target),
                    size,
                    fps=RATE,
                    codec="libx264",
                    quality=7,
                    macro_block_size=2,
                    ffmpeg_log_level="error",
                )
                writer.send(None)
            for _ in range(max(1, round(frame.length))):
                writer.send(pixels.tobytes())
        if writer is not None:
            writer.close()
        write_atomically(path, target.read_bytes())
