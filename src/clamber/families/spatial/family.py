"""Robots in space: any limbed robot in three dimensions, from its own MJCF or URDF file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...family import Family

if TYPE_CHECKING:
    from ...exports.joint_trajectory import Trajectories
    from ...files import Document
    from ...planning.problem.check import Check
    from ...planning.problem.problems import PlanFamily
    from ...tasks.task_format import TaskFormat
    from ...viewing.browser.exhibit import Scenes
    from ...viewing.pictures import Pictures


class Spatial(Family):
    """The limbed robot in space."""

    name = "spatial"
    title = "robot in space"
    data = Path(__file__).parent / "data"

    @property
    def files(self) -> TaskFormat:
        """Robots, worlds and tasks."""
        from .planning.task import FILES

        return FILES

    @property
    def checks(self) -> tuple[Check, ...]:
        """Of its stances and actions."""
        from .planning.checks import SPATIAL_CHECKS

        return SPATIAL_CHECKS

    @property
    def plans(self) -> PlanFamily:
        """Problems, plans and verdicts."""
        from .planning.plans import PLANS

        return PLANS

    @property
    def pictures(self) -> Pictures:
        """World and robot from a camera in space."""
        from .pictures.pictures import PICTURES

        return PICTURES

    @property
    def scenes(self) -> Scenes:
        """World and robot in the viewer."""
        from .pictures.scenes import SCENES

        return SCENES

    @property
    def trajectories(self) -> Trajectories:
        """Joints and contacts of plans."""
        from .trajectories import TRAJECTORIES

        return TRAJECTORIES

    def whole_robot(self, document: Document) -> Document:
        """With what statics needs of the model file."""
        from .robot.robot import whole_document

        return whole_document(document)


SPATIAL = Spatial()
