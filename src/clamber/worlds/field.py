"""A field: level ground with patches on which no foot may stand, and with blocks: level parts that are higher or lower."""

from typing import Final

from pydantic import StrictStr

from ..files import Document, check_schema
from ..specs import Name, build_spec, spec
from ..units import Length, Polygon
from .board import check_polygon

SCHEMA: Final = "clamber-field-1"


@spec
class Block:
    """A level part of the ground with sharp edges."""

    corners: Polygon
    """Of a simple polygon [m]."""
    height: float
    """Of its top [m]; negative in a hollow."""


@spec
class PatchField:
    """Ground seen from above, in SI units; world frame: x to the right, y up on the page."""

    name: str
    title: str
    patches: tuple[Polygon, ...] = ()
    """Corners of simple polygons on which no foot may stand [m]."""
    blocks: tuple[Block, ...] = ()
    """Where they overlap, the last one counts."""


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
class BlockSpec(BoxSpec):
    """A block with sides along the axes."""

    height: Length
    """[m]."""


@spec
class FieldSpec:
    """What a field file says."""

    name: Name
    title: StrictStr = ""
    source: StrictStr = ""
    """Where the places of the patches come from."""
    boxes: tuple[BoxSpec, ...] = ()
    polygons: tuple[Polygon, ...] = ()
    blocks: tuple[BlockSpec, ...] = ()
    """Level parts of the ground that are higher or lower; where they overlap, the last one counts."""


def build_field(document: Document) -> PatchField:
    """A field from its document.

    Raises:
        SpecError: If the document breaks a rule of the format, or a patch encloses nothing.
    """
    check_schema(document, SCHEMA)
    stated = build_spec(FieldSpec, document, without=("schema",))
    for key, boxes in (("boxes", stated.boxes), ("blocks", stated.blocks)):
        for index, box in enumerate(boxes):
            for low, high in (("x_min", "x_max"), ("y_min", "y_max")):
                if not getattr(box, low) < getattr(box, high):
                    raise document.problem(f"{key}.{index}.{low}", f"must be less than {high}")
    for index, polygon in enumerate(stated.polygons):
        check_polygon(polygon, document, f"polygons.{index}")
    patches = (*(box.corners() for box in stated.boxes), *stated.polygons)
    blocks = tuple(Block(corners=block.corners(), height=block.height) for block in stated.blocks)
    return PatchField(name=stated.name, title=stated.title, patches=patches, blocks=blocks)
