"""A family of another package is drawn and shown by what it says of its look alone."""

from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes

from clamber import family
from clamber.family import Family, NotOfFamilyError
from clamber.planning.problem.check import Check
from clamber.planning.problem.problem import Replay
from clamber.types import Floats
from clamber.viewing import style
from clamber.viewing.browser.app import App
from clamber.viewing.browser.page import write_page
from clamber.viewing.browser.solids import Camera, Figure, Scenery, Sticks, World, colour
from clamber.viewing.browser.viewer_content import Scenes, exhibit_of
from clamber.viewing.output import SuffixError
from clamber.viewing.panel import Gauges
from clamber.viewing.pictures import Pictures, animate, check_run_suffix, draw_run, draw_stance
from clamber.viewing.recording import Part, PlanView
from clamber.viewing.scene import Bounds
from clamber.viewing.view import Picture

BOUNDS = (-0.5, 3.5, -0.5, 0.5)
REACH = Gauges(
    title="Reach", names=("shuttle",), colours=(style.PARTS[0],), low=np.zeros(1), high=np.full(1, 4.0), limits=(),
    calm=(0.0, 1.0), unit=("m", 1.0, 1), group=1,
)  # fmt: skip


@dataclass(frozen=True)
class Ride:
    """A shuttle on a rail; each action takes it a metre on."""

    length: int
    name: str = "ride"
    title: str = "Along the rail"
    step = SimpleNamespace(length=0.01)

    @property
    def document(self) -> Any:
        return {"robot": {"family": "shuttle"}, "length": self.length}

    def replay(self) -> Replay:
        places = np.zeros(self.length + 1, [("x", np.float64)])
        places["x"] = np.arange(self.length + 1)
        return Replay(places, np.full((self.length, 1), 0.5), np.full(self.length, -1, np.int32))


class RideView(PlanView[float]):
    rows = ("Place",)

    def __init__(self, task: Ride, replay: Replay) -> None:
        self.places = replay.stances["x"]
        super().__init__(task, replay, BOUNDS, REACH)

    def settled(self, step: int) -> float:
        return float(self.places[step])

    def motion(self, step: int) -> list[Part[float]]:
        start = self.settled(step - 1)
        return [Part("move", lambda share, way: start + share)]

    def action(self, step: int) -> str:
        return f"to rung {step}"

    def values(self, at: float) -> tuple[Floats, ...]:
        return (np.array([at]),)

    def lines(self, step: int, at: float) -> tuple[str, ...]:
        return (f"{at:.1f} m",)

    def draw(self, picture: Picture[float]) -> "Dot":
        picture.wall.set(xlim=BOUNDS[:2], ylim=BOUNDS[2:])
        return Dot(picture.wall)


class Dot:
    def __init__(self, axes: Axes) -> None:
        self.artists: list[Any] = axes.plot([], [], marker="o")

    def update(self, at: float) -> None:
        self.artists[0].set_data([at], [0.0])


class Shuttle(Figure):
    def __init__(self, server: Any, name: str, opacity: float = 1.0) -> None:
        super().__init__(server, name, opacity)
        self.body = self.balls("body", [colour(style.BODY)], [0.2])

    def show(self, at: float, grade: int = 3) -> None:
        self.body.put(np.array([(at, 0.0, 0.0)]))


class Rail:
    def __init__(self, server: Any) -> None:
        self.rail = Sticks(server, "/rail", np.array([colour(style.HOLD)], np.uint8), np.array([0.05]))
        self.rail.put(np.array([[(0.0, 0.0, -0.2), (3.0, 0.0, -0.2)]]))

    def remove(self) -> None:
        self.rail.node.remove()


class RailScenery(Scenery):
    def world(self, server: Any) -> World:
        return Rail(server)

    def figure(self, server: Any, name: str, opacity: float = 1.0) -> Figure:
        return Shuttle(server, name, opacity)

    def camera(self) -> Camera:
        return Camera(np.array((1.5, -6.0, 1.0)), np.array((1.5, 0.0, 0.0)))


class RideScenes(Scenes):
    def scenery(self, task: Ride, bounds: Bounds) -> Scenery:
        return RailScenery(bounds)


def no_points(task: Ride) -> Floats:
    return np.zeros((1, 2))


class Shuttles(Family):
    name, title = "shuttle", "shuttle on a rail"
    plans = SimpleNamespace(
        checks=(Check("end", "m", "to the end of the rail"),),
        hard=lambda task: ("end",),
        sizes=lambda task: {"end": 1.0},
    )
    pictures = Pictures(RideView, lambda *_: None, lambda *_: None, no_points, lambda *_: None)  # type: ignore[assignment,arg-type]
    scenes = RideScenes()


@pytest.fixture(params=[Shuttles()])
def task(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Ride:
    """A task of a family that was added by its name."""
    known = family.family_named
    monkeypatch.setattr(family, "family_named", lambda name: request.param if name == "shuttle" else known(name))
    return Ride(3)


@pytest.mark.slow
def test_its_plan_is_saved_as_a_page_and_as_pictures(task: Any, tmp_path: Path) -> None:
    exhibit = exhibit_of(task, task.replay())
    assert exhibit.main.steps == ("start", "to rung 1", "to rung 2", "to rung 3")
    size = write_page(exhibit, tmp_path / "page.html")
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert len(page.encode()) == size and "Along the rail" in page and "to rung 3" in page
    for name in ("ride.gif", "ride.html"):
        animate(task, task.replay(), tmp_path / name)
    draw_stance(task, task.replay(), 2, tmp_path / "stance.png")
    assert (tmp_path / "stance.png").read_bytes().startswith(b"\x89PNG")


def test_its_viewer_offers_no_editor_and_says_what_it_cannot_do(task: Any, tmp_path: Path) -> None:
    app = App(exhibit_of(task, task.replay()))
    try:
        app.playback.jump(2)
        assert "Step 2 of 3: to rung 2" in app.stage._texts["head"].content
        assert app.editor is not None and app.editor.task() is task and app.work is not None
        assert not app.work._reserves.visible
    finally:
        app.close()
    ran = SimpleNamespace(work=task, done=True, reason="", trace=None)
    with pytest.raises(NotOfFamilyError, match="a shuttle on a rail has no pictures of runs"):
        draw_run(ran, tmp_path / "run.png")
    with pytest.raises(SuffixError):
        check_run_suffix("run.txt")
