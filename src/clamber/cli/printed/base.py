"""What all of it has in common."""

from typing import Annotated, TypeAlias

from pydantic import BaseModel, ConfigDict, Field


class Printed(BaseModel):
    """An object of which every field is named here, and each is always there unless it says otherwise."""

    model_config = ConfigDict(extra="forbid", use_attribute_docstrings=True, strict=True)


Count: TypeAlias = Annotated[int, Field(ge=0)]
Interval: TypeAlias = Annotated[list[float], Field(min_length=2, max_length=2)]
"""Lower and upper end."""
Pose: TypeAlias = Annotated[list[float], Field(min_length=3, max_length=3)]
"""x [m], y [m], angle [rad]."""
Pair: TypeAlias = Annotated[list[float], Field(min_length=2, max_length=2)]
"""Two numbers that belong together, such as x and y."""
