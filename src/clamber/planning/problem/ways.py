"""How far it is from every place of a wall to each goal: the coarse map that leads a route."""

from dataclasses import dataclass

from ...types import Floats


@dataclass(frozen=True, slots=True)
class WayFields:
    """Steps of the body that are left, at least roughly, over a grid of places."""

    frame: Floats
    """Lower left place and grain [m], shape (3,)."""
    fields: Floats
    """Steps to each goal from every place, shape (goals, rows, columns)."""
    hold_fields: Floats
    """The same at every hold, shape (goals, holds)."""
    after: Floats
    """Steps from each goal through all later ones, shape (goals,)."""
