"""Robots in space: any limbed robot in three dimensions, from its own MJCF or URDF file."""

from __future__ import annotations

from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from ...family import Family

if TYPE_CHECKING:
    from ...files import Document


class Spatial(Family):
    """The limbed robot in space."""

    name = "spatial"
    title = "robot in space"
    data = Path(__file__).parent / "data"
    starters = MappingProxyType({"world": "clamber.families.spatial.cli.new_world:world"})
    parts = MappingProxyType(
        {
            "checks": "clamber.families.spatial.planning.checks:SPATIAL_CHECKS",
            "files": "clamber.families.spatial.planning.task:FILES",
            "plans": "clamber.families.spatial.planning.plans:PLANS",
            "relaxations": "clamber.families.spatial.planning.relaxations:spatial_relaxations",
            "one_hold_more": "clamber.families.spatial.planning.one_hold_more:find_places",
            "pictures": "clamber.families.spatial.pictures.pictures:PICTURES",
            "scenes": "clamber.families.spatial.pictures.scenes:SCENES",
            "dynamics": "clamber.families.spatial.dynamics:DYNAMICS",
            "printed": "clamber.families.spatial.printed:PRINTED",
            "trajectories": "clamber.families.spatial.trajectories:TRAJECTORIES",
            "inspection": "clamber.families.spatial.inspection:INSPECTION",
            "imports": "clamber.families.spatial.robot.starter:IMPORTS",
            "first_task": "clamber.families.spatial.planning.first_task:first_task",
        }
    )

    def whole_robot(self, document: Document) -> Document:
        """With what statics needs of the model file and of the contacts."""
        from .robot.robot import whole_document

        return whole_document(document)


SPATIAL = Spatial()
