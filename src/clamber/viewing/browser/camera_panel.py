"""The part of the panel that moves the camera, and saves what it sees: as a picture, or a video of all that is played."""

import io
import re
import threading
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from PIL import Image

from ...types import Floats
from ..animation import RATE, has_ffmpeg, video
from .inputs import by_hand
from .panel_html import message_html
from .playback import Playback
from .scene_view import SceneView
from .solids import Camera

if TYPE_CHECKING:
    import viser

VIEWS: Final = ("front", "side", "top")
HOME: Final = "home"
FOLLOW: Final = "follow"


def preset(name: str, home: Camera) -> Camera:
    """Where to look from.

    Args:
        name: One of `VIEWS`, or "home". The front is that side of the world, along an axis, from which the viewer looks at first.
        home: Where the viewer looks from at first; the others are as far away, and look at the same place.
    """
    if name == HOME:
        return home
    x, y, _ = home.position - home.look_at
    front = np.array((np.sign(x), 0.0, 0.0) if abs(x) > abs(y) else (0.0, np.sign(y) or -1.0, 0.0))
    way = {"front": front, "side": np.array((-front[1], front[0], 0.0)), "top": 1e-3 * front + (0.0, 0.0, 1.0)}[name]
    away = float(np.linalg.norm(home.position - home.look_at))
    return Camera(
        home.look_at + away * way / np.linalg.norm(way), home.look_at
    )  # from a thousandth aside, up has a direction


class CameraPanel:
    """Buttons that set the camera of the page on which they are pressed, and a box that lets all cameras follow the robot.

    Args:
        server: Whose panel they are in; they are made where its context is.
        stage: Shows the robot.
    """

    def __init__(self, server: "viser.ViserServer", stage: SceneView) -> None:
        self._server, self._stage = server, stage
        self._views = server.gui.add_button_group("view", (HOME, *VIEWS))
        self._follow = server.gui.add_checkbox(
            FOLLOW, False, hint="The camera stays beside the robot, as you have turned it"
        )
        self._views.on_click(by_hand(lambda event: self._look(event.client, event.target.value)))
        stage.moved = self.follow

    def _look(self, client: Any, name: str) -> None:
        at = preset(name, self._stage.scenery.camera())
        middle = self._stage.middle
        shift = np.zeros(3) if not self._follow.value or middle is None else middle - at.look_at
        _aim(client, at.position + shift, at.look_at + shift)

    def follow(self, middle: Floats) -> None:
        """Keep every camera beside the robot [m], as far away and turned as whoever looks has it."""
        if not self._follow.value:
            return
        for client in self._server.get_clients().values():
            camera = client.camera
            if np.isfinite(middle).all() and camera.update_timestamp != 0.0:  # it has told where it is
                _aim(client, middle + camera.position - camera.look_at, middle)


def _aim(client: Any, position: Floats, look_at: Floats) -> None:
    with client.atomic():
        client.camera.position = tuple(position)
        client.camera.look_at = tuple(look_at)


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
