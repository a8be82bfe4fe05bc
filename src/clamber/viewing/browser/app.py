"""The viewer's server: its panel, its lights and its camera, from the first picture to its end."""

import contextlib
import io
import math
import socket
import time
from dataclasses import replace
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from ...errors import ClamberError, StatedError, how_to_install
from ...family import family_of
from ...planning.problem.plan import Plan
from ...tasks.task_format import task_files
from .. import style
from ..scene import join
from .camera_panel import CameraPanel, RecordingPanel, file_name
from .inputs import by_hand, readable, set_input
from .own_pages import Guard, UnguardedError, check_guarded, guarded
from .playback import Playback
from .save_panel import SavePanel
from .scene_view import SceneView
from .solids import FOV, Camera, colour
from .viewer_content import Editor, ViewerContent, exhibit_of
from .work_panel import WorkPanel

if TYPE_CHECKING:
    import viser

LOOPBACK: Final = "127.0.0.1"
SHOWN: Final = ("plan", "run", "both")
WIDTH: Final = 360.0
"""Of the panel [pixels]."""


class MissingViserError(ClamberError):
    """The viewer is asked for without the package that it is made with."""

    def __str__(self) -> str:
        return f"the viewer needs the package 'viser', which is not installed: {how_to_install('view')}"


class PortError(StatedError):
    """The viewer cannot listen where it is asked to."""

    says = "cannot listen on {host}, port {port}: {why}; name another with --port, or none for any that is free"
    host: str
    port: int
    why: str


def check_viser() -> None:
    """Makes sure that the viewer can be made.

    Raises:
        MissingViserError: If its package is missing.
    """
    try:
        import viser  # noqa: F401
    except ImportError:
        raise MissingViserError from None


def check_port(host: str, port: int) -> None:
    """Makes sure that a port is free, or with 0 that there is one.

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


def guarded_server(host: str, guard: Guard) -> "viser.ViserServer":
    """A server of pages that answers who has its token, and pages of its own.

    Args:
        host: Where it listens.
        guard: Knows the port, or learns it where it is 0, and the token.

    Raises:
        PortError: If another program has taken the port; viser would go on to the next, of which the guard knows nothing.
        UnguardedError: If it would answer others; it is stopped.
    """
    import viser

    with contextlib.redirect_stdout(io.StringIO()):  # it greets; who opens it says where it is
        with guarded(guard):
            server = viser.ViserServer(host=host, port=guard.port, label="Clamber", verbose=False)
        port = server.get_port()
        if guard.port not in (0, port):
            server.stop()
            raise PortError(host, guard.port, "another program has just taken it")
        guard.port = port
        try:
            check_guarded(host, port, guard)
        except UnguardedError:
            server.stop()
            raise
    return server


class App:
    """A viewer that is open.

    Args:
        exhibit: What is shown.
        host: Where to listen; only this machine can reach the usual one.
        port: Where to listen; 0: any that is free.
        folder: Where the page may save what was made on it; only where no other machine can reach the page.

    Raises:
        MissingViserError: If its package is missing.
        PortError: If it cannot listen there.
        UnguardedError: If its server would answer anybody.
    """

    def __init__(self, exhibit: ViewerContent, host: str = LOOPBACK, port: int = 0, folder: Path = Path()) -> None:
        check_viser()
        import viser

        check_port(host, port)
        self.guard = Guard(port) if host == LOOPBACK else Guard(port, names=None)
        self.guard.title = f"{exhibit.title} - Clamber"
        self.server = guarded_server(host, self.guard)
        self.exhibit = exhibit
        server = self.server
        light_scene(server)
        server.gui.configure_theme(show_logo=False, show_share_button=False, brand_color=colour(style.PARTS[0]))
        server.gui.set_panel_label(exhibit.title)
        server.gui.main_panel.dock_right()
        server.gui.main_panel.set_width(WIDTH)
        self.stage = SceneView(server, exhibit)
        tabs = server.gui.add_tab_group()
        with tabs.add_tab("Play", viser.Icon.PLAYER_PLAY):
            self._shown = server.gui.add_dropdown("show", SHOWN, initial_value="both", visible=False)
            self.stage.add_head()
            self.playback = Playback(server, self.stage.show, self.stage.main)
            with server.gui.add_folder("Camera"):
                self.camera = CameraPanel(server, self.stage)
                self.recording = RecordingPanel(server, self.playback, file_name(exhibit.title))
            self.stage.add_details()
        self._shown.on_update(by_hand(lambda _: self.choose(self._shown.value)))
        self.work: WorkPanel | None = None
        self.editor: Editor | None = None
        self.saving: SavePanel | None = None
        if exhibit.task is not None:
            scenes = family_of(exhibit.task).scenes
            with tabs.add_tab(scenes.tab, viser.Icon.EDIT):
                self.editor = scenes.editor(server, exhibit.task, self.stage, self.show_task)
                self.work = WorkPanel(
                    server, self.editor.task, scenes, exhibit.planned, lambda: self.exhibit.plan, self.show_task, self.show_run
                )  # fmt: skip
                if host == LOOPBACK:  # nobody else is to write files on this machine
                    self.saving = SavePanel(server, f"{exhibit.task.name}-edited", folder, self.files)
        self.choose("both")
        aim_camera(server, exhibit.scenery.camera())

    def choose(self, shown: str) -> None:
        """Show the plan, the run, or both, as far as they are there."""
        stage = self.stage
        stage.shown = "plan" if shown == "plan" else "run" if shown == "run" else "both"
        self._shown.visible = len(stage.films) > 1 and self.exhibit.planned
        set_input(self._shown, stage.shown)
        stage.load(stage.main)
        self.playback.load(stage.main)

    def show_task(self, task: Any, plan: Plan | None = None) -> None:
        """Show a task, or other work, with a plan, or its start.

        Raises:
            ClamberError: If its start violates a hard check.
        """
        exhibit = exhibit_of(task, plan)
        # what was shown stays in sight, so that the world does not jump while it is edited
        seen = join(self.stage.scenery.bounds, exhibit.scenery.bounds)
        exhibit.scenery = replace(exhibit.scenery, bounds=seen)
        self.exhibit = exhibit
        with self.playback.still():
            self.stage.set_scenery(exhibit.scenery)
            self.stage.set_film("plan", exhibit.plan_film)
            self.choose("plan")

    def show_run(self, run: Any) -> None:
        """Play a run with its plan."""
        self.exhibit.run_film = family_of(self.exhibit.task).scenes.run_film(self.exhibit, run)
        with self.playback.still():
            self.stage.set_film("run", self.exhibit.run_film)
            self.choose("both")
        self.playback.play(True)

    def files(self, name: str) -> dict[str, str]:
        """Names of files and their texts, of what was made on the page: the task as it was edited, and the plan that is shown.

        Raises:
            ClamberError: If what was edited makes no task.
        """
        assert self.editor is not None  # without it nothing is saved
        plan = self.exhibit.plan
        made = task_files(readable(self.editor.task().document), name)
        return made if plan is None else made | {f"{name}-plan.json": plan.text()}

    @property
    def url(self) -> str:
        """What opens the page: where it is, with the token."""
        return f"{self.place}/?token={self.guard.token}"

    @property
    def place(self) -> str:
        """Where the page is."""
        host = self.server.get_host()
        shown = {"0.0.0.0": LOOPBACK, "::": "[::1]"}.get(host, f"[{host}]" if ":" in host else host)
        return f"http://{shown}:{self.server.get_port()}"

    def __enter__(self) -> "App":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<App {self.exhibit.title!r} at {self.url}>"

    def _repr_html_(self) -> str:
        url = escape(self.url)
        return f'<a href="{url}" target="_blank">{escape(self.exhibit.title)}: open the viewer</a>'

    def wait(self, seconds: float | None = None) -> None:
        """Leave the page open for so long [s], or until Ctrl-C."""
        ends = math.inf if seconds is None else time.monotonic() + seconds
        with contextlib.suppress(KeyboardInterrupt):  # the usual end
            while (left := ends - time.monotonic()) > 0.0:
                time.sleep(min(0.2, left))

    def close(self) -> None:
        """End the work, the clock and the server."""
        if self.work is not None:
            self.work.background_task.stop(wait=1.0)
        self.playback.stop()
        with contextlib.redirect_stdout(io.StringIO()):  # its last words
            self.server.stop()


def aim_camera(server: "viser.ViserServer", at: Camera) -> None:
    """Set where pages look from when they open."""
    camera = server.initial_camera
    camera.position, camera.look_at, camera.fov = tuple(at.position), tuple(at.look_at), FOV
    camera.near, camera.far = 0.01, 200.0


def light_scene(server: "viser.ViserServer") -> None:
    """Set light and background: the sun comes over the viewer's left shoulder, and shadows are soft."""
    scene = server.scene
    scene.set_up_direction("+z")
    scene.configure_default_lights(enabled=False)
    scene.configure_environment_map(None)  # plain lights look the same on every machine, and cost less
    white = (255, 255, 255)
    scene.add_light_hemisphere("/lights/sky", sky_color=white, ground_color=(170, 170, 180), intensity=1.5)
    scene.add_light_directional("/lights/sun", color=white, intensity=2.0, cast_shadow=True, position=(-2.0, -5.0, 4.0))
