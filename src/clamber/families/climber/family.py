"""Climbers: two to eight limbs of two joints each in a plane, holds on a wall."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from ...family import Family

if TYPE_CHECKING:
    from ...exports.joint_trajectory import Trajectories
    from ...inspection.finding import Inspection
    from ...planning.openings.relaxations import Relaxation
    from ...planning.problem.check import Check
    from ...planning.problem.plan_source import OpenedPlan
    from ...planning.problem.problems import PlanFamily
    from ...sim.bench_limb import BenchLimb
    from ...sim.lone_robot import JointBounds
    from ...tasks.task_format import TaskFormat
    from ...trials.dynamics import Dynamics
    from ...viewing.browser.exhibit import Scenes
    from ...viewing.pictures import Pictures


class Climber(Family):
    """The climber of limbs in a plane."""

    name = "limbed"
    title = "limbed climber"
    data = Path(__file__).parent / "data"
    commands = MappingProxyType(
        {
            "rehearse": "clamber.families.climber.cli.rehearse:rehearse",
            "press": "clamber.families.climber.cli.press:press",
        }
    )
    groups = MappingProxyType({"plant": "clamber.families.climber.cli.plant:plant"})

    @property
    def files(self) -> TaskFormat:
        """Robots, boards and tasks."""
        from .planning.task_file import FILES

        return FILES

    @property
    def checks(self) -> tuple[Check, ...]:
        """Of its stances."""
        from .statics.checks import LIMBED_CHECKS

        return LIMBED_CHECKS

    @property
    def plans(self) -> PlanFamily:
        """Problems, plans and verdicts."""
        from .planning.plans import PLANS

        return PLANS

    @property
    def relaxations(self) -> Callable[[Any], Iterator[Relaxation]]:
        """Rules, limits and joints that can be relaxed."""
        from .planning.relaxations import climber_relaxations

        return climber_relaxations

    @property
    def one_hold_more(self) -> Callable[..., Any]:
        """Places for one hold more."""
        from .planning.one_hold_more import find_places

        return find_places

    @property
    def printed_plan(self) -> Callable[[Path, str | None, tuple[str, ...]], OpenedPlan]:
        """Plans in the numbers of the thesis's tables."""
        from .planning.thesis_plan import open_thesis_plan

        return open_thesis_plan

    @property
    def pictures(self) -> Pictures:
        """Wall and climber."""
        from .pictures.pictures import PICTURES

        return PICTURES

    @property
    def scenes(self) -> Scenes:
        """Wall and climber in three dimensions, with the board's editor."""
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
        """Runs, trials, benches and plants."""
        from .printed import PRINTED

        return PRINTED

    @property
    def dynamics(self) -> Dynamics:
        """Runs and trials in contact dynamics."""
        from .dynamics import DYNAMICS

        return DYNAMICS

    @property
    def bench_limb(self) -> Callable[..., BenchLimb]:
        """One limb, with its motors and gears."""
        from .sim.bench_limb import limb_for_bench

        return limb_for_bench

    @property
    def model(self) -> Callable[[Any], tuple[Any, Mapping[str, JointBounds]]]:
        """Body and limbs as MuJoCo models."""
        from .sim.climber_model import lone_climber

        return lone_climber


CLIMBER = Climber()
