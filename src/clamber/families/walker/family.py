"""Two-frame walkers: two frames of three legs that slide and turn over each other, an arm, slopes and steps."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...family import Family

if TYPE_CHECKING:
    from ...exports.joint_trajectory import Trajectories
    from ...inspection.finding import Inspection
    from ...planning.openings.relaxations import Relaxation
    from ...planning.problem.plan import Plan
    from ...planning.problem.problems import PlanFamily
    from ...sim.lone_robot import JointBounds
    from ...tasks.task_format import TaskFormat
    from ...trials.run_request import RunRequest
    from ...viewing.pictures import Pictures


class Walker(Family):
    """The two-frame walker."""

    name = "walker"
    title = "two-frame walker"
    data = Path(__file__).parent / "data"

    @property
    def files(self) -> TaskFormat:
        """Robots, grounds and tasks."""
        from .planning.task import FILES

        return FILES

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
    def carry_out(self) -> Callable[[Any, Plan | None, RunRequest], Any]:
        """Runs in contact dynamics."""
        from .trials.carry_out import carry_out_walk

        return carry_out_walk

    def other_work(self, name_or_path: str) -> Any | None:
        """Walks."""
        from .planning import is_walk, load_walk

        return load_walk(name_or_path) if is_walk(name_or_path) else None

    @property
    def model(self) -> Callable[[Any], tuple[Any, Mapping[str, JointBounds]]]:
        """Frames, legs and arm as a MuJoCo model."""
        from .sim.walker_model import lone_walker

        return lone_walker


WALKER = Walker()
