"""Robots in space: any limbed robot in three dimensions, from its own MJCF or URDF file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...family import Family

if TYPE_CHECKING:
    from ...files import Document
    from ...planning.problem.check import Check
    from ...planning.problem.problems import PlanFamily
    from ...tasks.task_format import TaskFormat


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

    def whole_robot(self, document: Document) -> Document:
        """With what statics needs of the model file."""
        from .robot.robot import whole_document

        return whole_document(document)


SPATIAL = Spatial()
