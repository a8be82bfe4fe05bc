"""Two-frame walkers: two frames of three legs that slide and turn over each other, an arm, slopes and steps."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from ...family import Family

if TYPE_CHECKING:
    from ...exports.joint_trajectory import Trajectories
    from ...inspection.finding import Inspection
    from ...planning.openings.relaxations import Relaxation
    from ...planning.problem.check import Check
    from ...planning.problem.problems import PlanFamily
    from ...sim.lone_robot import JointBounds
    from ...tasks.task_format import TaskFormat
    from ...trials.dynamics import Dynamics
    from ...viewing.browser.exhibit import Scenes
    from ...viewing.pictures import Pictures


class Walker(Family):
    """The two-frame walker."""

    name = "walker"
    title = "two-frame walker"
    data = Path(__file__).parent / "data"
    commands = MappingProxyType(
        {name: f"clamber.families.walker.cli.{name}:{name}" for name in ("follow", "most", "calibrate", "ditch")}
    )

    @property
    def files(self) -> TaskFormat:
        """Robots, grounds and tasks."""
        from .planning.task import FILES

        return FILES

    @property
    def checks(self) -> tuple[Check, ...]:
        """Of its stances."""
        from .statics.checks import WALKER_CHECKS

        return WALKER_CHECKS

    @property
    def plans(self) -> PlanFamily:
        """Problems, plans and verdicts."""
        from .planning.plans import PLANS

        return PLANS

    @property
    def relaxations(self) -> Callable[[Any], Iterator[Relaxation]]:
        """Rules and limits that can be relaxed."""
        from .planning.relaxations import walker_relaxations

        return walker_relaxations

    @property
    def pictures(self) -> Pictures:
        """Ground and walker."""
        from .pictures.pictures import PICTURES

        return PICTURES

    @property
    def scenes(self) -> Scenes:
        """Ground and walker in three dimensions, with the ground's editor."""
        from .pictures.scenes import SCENES

        return SCENES

    @property
    def trajectories(self) -> Trajectories:
        """Joints over plans and runs."""
        from .trajectories import TRAJECTORIES

        return TRAJECTORIES

    @property
    def inspection(self) -> Inspection:
        """What is told of its files, and what is odd about them."""
        from .inspection import INSPECTION

        return INSPECTION

    @property
    def printed(self) -> Mapping[str, Any]:
        """Runs, trials and crossings."""
        from .printed import PRINTED

        return PRINTED

    @property
    def dynamics(self) -> Dynamics:
        """Runs and trials in contact dynamics."""
        from .dynamics import DYNAMICS

        return DYNAMICS

    def other_work(self, name_or_path: str, overrides: Sequence[str] = ()) -> Any | None:
        """Walks."""
        from .planning import is_walk, load_walk

        return load_walk(name_or_path, overrides) if is_walk(name_or_path) else None

    def other_names(self) -> tuple[str, ...]:
        """Walks."""
        from .planning import walk_names

        return walk_names()

    @property
    def model(self) -> Callable[[Any], tuple[Any, Mapping[str, JointBounds]]]:
        """Frames, legs and arm as a MuJoCo model."""
        from .sim.walker_model import lone_walker

        return lone_walker


WALKER = Walker()
