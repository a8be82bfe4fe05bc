"""Limbed robots in space: any number of limbs of hinges and slides, from MJCF or URDF files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from ...family import Family

if TYPE_CHECKING:
    from ...family import Import
    from ...files import Document


class Spatial(Family):
    """The limbed robot in space."""

    name = "spatial"
    title = "limbed robot in space"
    data = Path(__file__).parent / "data"

    @property
    def imports(self) -> Mapping[str, Import]:
        """Robots from MJCF and URDF files."""
        from .robot.starter import import_robot

        return {".urdf": import_robot, ".xml": import_robot, ".mjcf": import_robot}

    def whole_robot(self, document: Document) -> Document:
        """A robot's document with the parts of its model."""
        from .robot.robot import whole_document

        return whole_document(document)


SPATIAL = Spatial()
