"""The part of the panel that moves the camera: views from the front, the side and the top, and one that follows the robot."""

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ...types import Floats
from .inputs import by_hand
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
