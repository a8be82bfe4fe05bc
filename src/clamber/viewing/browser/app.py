"""The viewer's server: its panel, its lights and its camera, from the first picture to its end."""

import contextlib
import socket
import sys
from typing import TYPE_CHECKING, Final

from ...errors import ClamberError
from .. import style
from .climb_scenery import FOV
from .exhibit import Exhibit
from .playback import Playback
from .scenery import Camera
from .solids import colour
from .stage import Stage

if TYPE_CHECKING:
    import viser

LOOPBACK: Final = "127.0.0.1"
WIDTH: Final = 400.0
"""Of the panel [pixels]."""


class MissingViserError(ClamberError):
    """The viewer is asked for without the package that it is made with."""

    def __str__(self) -> str:
        return "the viewer needs the package 'viser', which is not installed; pip install \"clamber[view]\""


class PortError(ClamberError):
    """The viewer cannot listen where it is asked to."""

    def __init__(self, host: str, port: int, why: str) -> None:
        super().__init__(host, port, why)
        self.host, self.port, self.why = host, port, why

    def __str__(self) -> str:
        return f"cannot listen on {self.host}, port {self.port}: {self.why}; name another with --port, or none for any that is free"


def check_viser() -> None:
    """Makes sure that the viewer can be made.

    Raises:
        MissingViserError: If its package is missing.
    """
    try:
        import viser  # noqa: F401
    except ImportError:
        raise MissingViserError from None


def free_port(host: str, port: int) -> int:
    """The port if it is free, or with 0 one that is.

    Raises:
        PortError: If it cannot be listened on.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.socket(family, socket.SOCK_STREAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host, port))
        except (OSError, OverflowError) as error:
            raise PortError(host, port, getattr(error, "strerror", None) or str(error)) from None
        return int(probe.getsockname()[1])


class App:
    """A viewer that is open.

    Args:
        exhibit: What is shown.
        host: Where to listen; only this machine can reach the usual one.
        port: Where to listen; 0: any that is free.

    Raises:
        MissingViserError: If its package is missing.
        PortError: If it cannot listen there.
    """

    def __init__(self, exhibit: Exhibit, host: str = LOOPBACK, port: int = 0) -> None:
        check_viser()
        import viser

        with contextlib.redirect_stdout(sys.stderr):  # it greets, and that is no result of ours
            self.server = viser.ViserServer(host=host, port=free_port(host, port), label="Clamber", verbose=False)
        self.exhibit = exhibit
        server = self.server
        light_scene(server)
        server.gui.configure_theme(show_logo=False, show_share_button=False, brand_color=colour(style.PARTS[0]))
        server.gui.set_panel_label(exhibit.title)
        server.gui.main_panel.dock_right()
        server.gui.main_panel.set_width(WIDTH)
        self.stage = Stage(server, exhibit.scenery)
        self.stage.set_film("plan", exhibit.plan_film)
        self.stage.set_film("run", exhibit.run_film)
        self.stage.shown = "both" if len(self.stage.films) > 1 else "plan"
        tabs = server.gui.add_tab_group()
        with tabs.add_tab("Play", viser.Icon.PLAYER_PLAY):
            self.stage.add_head()
            self.playback = Playback(server, self.stage.show, self.stage.main)
            self.stage.add_details()
        self.playback.seek(0.0)
        aim_camera(server, exhibit.scenery.camera())

    @property
    def url(self) -> str:
        """Where the page is."""
        host = self.server.get_host()
        shown = {"0.0.0.0": LOOPBACK, "::": "[::1]"}.get(host, f"[{host}]" if ":" in host else host)
        return f"http://{shown}:{self.server.get_port()}"

    def close(self) -> None:
        """End the clock and the server."""
        self.playback.stop()
        with contextlib.redirect_stdout(sys.stderr):  # its last words are no result of ours
            self.server.stop()


def aim_camera(server: "viser.ViserServer", at: Camera) -> None:
    """Set where pages look from when they open."""
    camera = server.initial_camera
    camera.position, camera.look_at, camera.fov = tuple(at.position), tuple(at.look_at), FOV
    camera.near, camera.far = 0.01, 200.0


def light_scene(server: "viser.ViserServer") -> None:
    """Set light and background."""
    server.scene.set_up_direction("+z")
    server.scene.configure_default_lights(enabled=True, cast_shadow=True)
    server.scene.configure_environment_map(None)  # plain lights look the same on every machine, and cost less
    server.scene.add_light_hemisphere(
        "/lights/sky", sky_color=(255, 255, 255), ground_color=(190, 190, 200), intensity=1.6
    )
