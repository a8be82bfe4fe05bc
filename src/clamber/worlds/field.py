"""A field: flat, level ground with patches on which no foot may stand."""

from typing import Final

from pydantic import StrictStr

from ..files import Document, check_schema
from ..specs import Name, build_spec, spec
from ..units import Length, Polygon
from .board import check_polygon

SCHEMA: Final = "clamber-field-1"


@spec
class PatchField:
    """Ground seen from above, in SI units; world frame: x to the right, y up on the page."""

    name: str
    title: str
    patches: tuple[Polygon, ...] = ()
    """Corners of simple polygons on which no foot may stand [m]."""


@spec
class BoxSpec:
    """A patch with sides along the axes."""

    x_min: Length
    """[m]."""
    x_max: Length
    """[m]."""
    y_min: Length
    """[m]."""
    y_max: Length
    """[m]."""

    def corners(self) -> Polygon:
        """Its corners, anticlockwise."""
        return (
            (self.x_min, self.y_min),
            (self.x_max, self.y_min),
            (self.x_max, self.y_max),
            (self.x_min, self.y_max),
        )


@spec
class FieldSpec:
    """What a field file says."""

    name: Name
    title: StrictStr = ""
    source: StrictStr = ""
    """Where the places of the patches come from."""
    boxes: tuple[BoxSpec, ...] = ()
    polygons: tuple[Polygon, ...] = ()


def build_field(document: Document) -> PatchField:
    """A field from its document.

    Raises:
        SpecError: If the document breaks a rule of the format, or a patch encloses nothing.
    """
    check_schema(document, SCHEMA)
    stated = build_spec(FieldSpec, document, without=("schema",))
    for index, box in enumerate(stated.boxes):
        for low, high in (("x_min", "x_max"), ("y_min", "y_max")):
            if not getattr(box, low) < getattr(box, high):
                raise document.problem(f"boxes.{index}.{low}", f"must be less than {high}")
    for index, polygon in enumerate(stated.polygons):
        check_polygon(polygon, document, f"polygons.{index}")
    patches = (*(box.corners() for box in stated.boxes), *stated.polygons)
    return PatchField(name=stated.name, title=stated.title, patches=patches)
