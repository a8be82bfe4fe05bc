"""What stands in the scene: a world, the figures of a plan and of a run in it, and what the panel says of them."""

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from ...types import Floats
from ..recording import Recording
from .curves import Curves
from .inputs import by_hand
from .panel_html import head_html, loads_html, step_margins_html, strip_html
from .solids import Figure, Scenery, World

if TYPE_CHECKING:
    import viser

    from .viewer_content import ViewerContent

WORDS_PERIOD: Final = 0.12
"""Between two texts in play [s]."""
GHOST: Final = 0.3
"""Opacity of a run's plan [-]."""
Shown = Literal["plan", "run", "both"]
STRIPS: Final = {"plan": "Smallest margin of every", "run": "What became of every"}
"""What a strip tells of each of a film's steps."""


class SceneView:
    """A world with a plan, a run of it, or both; it shows one moment at a time.

    Args:
        server: The scene's and the panel's.
        content: World and robot, and what is played of them at first.
    """

    def __init__(self, server: "viser.ViserServer", content: "ViewerContent") -> None:
        self.server, self.scenery = server, content.scenery
        self.world: World = content.scenery.world(server)
        self.films: dict[str, Recording[Any]] = {}
        self._figures: dict[str, Figure] = {}
        self._told = (0.0, -1)
        self.set_film("plan", content.plan_film)
        self.set_film("run", content.run_film)
        self.shown: Shown = "both" if len(self.films) > 1 else "plan"
        self._texts: dict[str, viser.GuiHtmlHandle] = {}
        self._curves: Curves | None = None
        self._block: viser.GuiDropdownHandle[str] | None = None
        self.moved: Callable[[Floats], None] = lambda middle: None
        """Is told where the robot is whenever it has been shown [m]."""

    @property
    def middle(self) -> Floats | None:
        """Where the robot is that is shown [m]; None before it is."""
        figure = self._figures.get(self.main_kind)
        return None if figure is None or not np.isfinite(figure.middle).all() else figure.middle

    def add_head(self) -> None:
        """Make the texts above the controls, where the panel's context is."""
        self._texts["head"] = self.server.gui.add_html("")
        self._texts["strip"] = self.server.gui.add_html("")

    def add_details(self) -> None:
        """Make the texts below them."""
        gui = self.server.gui
        with gui.add_folder("Loads"):
            self._texts["bars"] = gui.add_html("")
        with gui.add_folder("Margins"):
            self._texts["margins"] = gui.add_html("")
        with gui.add_folder("Curves over time", expand_by_default=False):
            self._block = gui.add_dropdown("of", ("",), visible=False)
            self._texts["curves"] = gui.add_html("")
            self._texts["now"] = gui.add_html("")
        self._block.on_update(by_hand(lambda _: self._draw_curves(self.main)))
        self._told = 0.0, -1

    def load(self, film: Recording[Any]) -> None:
        """Draw the curves of a film that is to be shown."""
        titles = tuple(dict.fromkeys(gauges.title for gauges in film.gauges))
        if self._block is not None and titles:
            self._block.options = titles
            self._block.visible = len(titles) > 1
        self._draw_curves(film)

    def _draw_curves(self, film: Recording[Any]) -> None:
        self._curves = None
        if self._block is None:
            return
        titles = [gauges.title for gauges in film.gauges]
        if film.seconds > 0.0 and titles:
            self._curves = Curves(film, titles.index(self._block.value) if self._block.value in titles else 0)
        self._texts["curves"].content = "" if self._curves is None else self._curves.html()
        self._told = 0.0, -1

    def set_film(self, kind: Literal["plan", "run"], film: Recording[Any] | None) -> None:
        """Take a film of a plan or of a run; None takes it away."""
        if film is None:
            self.films.pop(kind, None)
            for name in (kind, f"{kind} ghost"):
                if name in self._figures:
                    self._figures.pop(name).remove()
            return
        self.films[kind] = film

    def set_scenery(self, scenery: Scenery) -> None:
        """Build another world; films go with the old one."""
        with self.server.atomic():
            for kind in ("plan", "run"):
                self.set_film(kind, None)
            self.world.remove()
            self.scenery, self.world = scenery, scenery.world(self.server)

    @property
    def main_kind(self) -> str:
        """Of the film that gives the time: "plan" or "run"."""
        wanted = "plan" if self.shown == "plan" else "run"
        return wanted if wanted in self.films else next(iter(self.films))

    @property
    def main(self) -> Recording[Any]:
        """Film that gives the time."""
        return self.films[self.main_kind]

    def show(self, film: Recording[Any], at: float) -> None:
        """Set the scene to a time of a film, and the panel's texts where they are due."""
        step = film.step_at(at)
        moment = film.at(at)
        kind = "run" if film is self.films.get("run") else "plan"
        ghost, planned = None, None
        if kind == "run" and self.shown == "both" and "plan" in self.films:
            plan = self.films["plan"]
            then = film.planned_time(at, plan)
            ghost = None if then is None else plan.at(then)
            planned = None if then is None else plan.step_at(then)
        with self.server.atomic():
            self._figure(kind).show(moment, film.grades[step])
            for name, figure in self._figures.items():
                figure.hide(not (name == kind or (name == "plan ghost" and ghost is not None)))
            if ghost is not None:
                self._figure("plan ghost").show(ghost)
            self._tell(film, kind, step, moment, planned, at)
        self.moved(self._figures[kind].middle)

    def _figure(self, name: str) -> Figure:
        if name not in self._figures:
            opacity = GHOST if name.endswith("ghost") else 1.0
            self._figures[name] = self.scenery.figure(self.server, f"/{name}", opacity)
        return self._figures[name]

    def _tell(self, film: Recording[Any], kind: str, step: int, moment: Any, planned: int | None, at: float) -> None:
        now, (last, before) = time.perf_counter(), self._told
        if not self._texts or (step == before and now - last < WORDS_PERIOD):
            return
        texts = {
            "head": head_html(film, step, moment),
            "bars": loads_html(film.gauges, film.values(moment)),
            "strip": strip_html(film, step, f"{STRIPS[kind]} {film.noun.lower()}"),
            "margins": step_margins_html(film, step, self.films.get("plan"), planned),
            "now": "" if self._curves is None else self._curves.mark_html(at),
        }
        self._told = now, step
        for name, words in texts.items():
            if name in self._texts and self._texts[name].content != words:
                self._texts[name].content = words
