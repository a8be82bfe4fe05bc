"""The part of the panel that saves what is seen: a picture of it, or a video of all that is played."""

import io
import re
import threading
from typing import TYPE_CHECKING, Any, Final

from PIL import Image

from ..animation import RATE, has_ffmpeg, video
from .inputs import by_hand
from .panel_html import message_html
from .playback import Playback

if TYPE_CHECKING:
    import viser

SIZE: Final = (1280, 720)
"""Width and height of what is saved [pixels]."""
MOST: Final = 300
"""Pictures of a video, at most: longer films are shown faster."""
WAIT: Final = 60.0
"""Longest wait for a picture from the page [s]."""


def file_name(title: str) -> str:
    """What files are called of what has a title: its letters and digits."""
    return re.sub(r"[^A-Za-z0-9]+", "-", title).strip("-")[:60].lower() or "clamber"


def encode(pictures: list[Any]) -> tuple[str, bytes]:
    """Suffix and bytes of a video: MP4 with the extra `video`, else GIF. Pictures are (height, width, 3)."""
    if has_ffmpeg():
        return ".mp4", video(pictures)
    content = io.BytesIO()
    images = [Image.fromarray(picture).resize((SIZE[0] // 2, SIZE[1] // 2)) for picture in pictures]
    images[0].save(content, "GIF", save_all=True, append_images=images[1:], duration=1000.0 / RATE, loop=0)
    return ".gif", content.getvalue()


class RecordingPanel:
    """Buttons that save what the page shows on which they are pressed; its own browser draws it and takes the file.

    Args:
        server: Whose panel they are in; they are made where its context is.
        playback: What is played.
        name: What files are called.
    """

    def __init__(self, server: "viser.ViserServer", playback: Playback, name: str) -> None:
        self._playback, self._name, self._busy = playback, name, threading.Lock()
        self._buttons = server.gui.add_button_group(
            "save", ("picture", "video"), hint="Of what is seen, as it is turned now"
        )
        self._words = server.gui.add_html("")
        self._buttons.on_click(by_hand(self._save))

    def _save(self, event: Any) -> None:
        if not self._busy.acquire(blocking=False):
            return
        try:
            (self._save_video if event.target.value == "video" else self._save_picture)(event.client)
        except TimeoutError:
            self._say("the page did not draw in time; is it in sight?", bad=True)
        finally:
            self._busy.release()

    def _save_picture(self, client: Any) -> None:
        content = io.BytesIO()
        Image.fromarray(_drawn(client)).save(content, "PNG")
        self._hand_over(client, ".png", content.getvalue())

    def _save_video(self, client: Any) -> None:
        film, before = self._playback.film, self._playback.time
        times, pictures = film.times(RATE, MOST), []
        self._playback.play(False)
        for k, time in enumerate(times.tolist()):
            self._playback.seek(time)
            pictures.append(_drawn(client))
            if self._playback.film is not film:
                self._say("what is played has changed: no video", bad=True)
                return
            self._say(f"video: picture {k + 1} of {len(times)}", bad=False)
        self._playback.seek(before)
        self._hand_over(client, *encode(pictures))

    def _hand_over(self, client: Any, suffix: str, content: bytes) -> None:
        file = f"{self._name}{suffix}"
        client.send_file_download(file, content, save_immediately=True)
        self._say(f"{file}: {len(content) / 1e6:.1f} MB", bad=False)

    def _say(self, words: str, *, bad: bool) -> None:
        self._words.content = message_html(words, bad=bad)


def _drawn(client: Any) -> Any:
    """What a page sees now, shape (height, width, 3)."""
    return client.get_render(SIZE[1], SIZE[0], timeout=WAIT)[..., :3]
