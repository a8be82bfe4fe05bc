"""A ditch crossed in contact dynamics: the fewest slides over it, as `clamber ditch` finds them, with room to spare, as a course."""

from dataclasses import replace

from ....types import Floats
from ..control.gait import Limits
from ..execution.course import PlannedCourse, PlannedStep
from ..execution.walker import RefusedError
from ..execution.walking import Lay
from ..planning import Walk
from ..robot.ditch import Footing
from ..robot.ditch_plan import Crossing, cross_ditch
from ..robot.weight import weight_of
from .planned import BALANCE, CLEARANCE, GUARD, STROKE


def plan_crossing(walk: Walk) -> Crossing:
    """The slides that cross a walk's ditch, wider by what feet keep from its edges, within less than the mechanism can; or why none do.

    Args:
        walk: Its way is one ditch.
    """
    piece, robot, start = walk.way[0], walk.robot, walk.start
    assert piece.ditch is not None and piece.ahead is not None
    mechanism = replace(
        robot.mechanism,
        shortest=robot.mechanism.shortest + STROKE,
        stroke=robot.mechanism.stroke - 2.0 * STROKE,
        guard=min(robot.mechanism.guard, Limits().guard - GUARD),
    )
    weight = weight_of(robot, walk.arm if robot.arm is not None else None, walk.payload)
    footing = Footing.of(replace(robot, mechanism=mechanism), weight=weight, margin=BALANCE)
    return cross_ditch(
        footing,
        piece.ditch + 2.0 * CLEARANCE,
        before=piece.ahead - CLEARANCE,
        heading=-(piece.along or 0.0),
        theta=start.twist,
    )


def crossing_steps(found: Crossing) -> tuple[PlannedStep, ...]:
    """The slides of a crossing as steps."""
    poses, steps = found.start.copy(), []
    for slide in found.slides:
        steps.append(PlannedStep(slide.frame, slide.way[1:], poses[1 - slide.frame].copy()))
        poses[slide.frame] = slide.way[-1]
    return tuple(steps)


def lay_crossing(walk: Walk) -> Lay:
    """How a walk's ditch is crossed from where the robot stands; it is refused, with the reason, where it cannot be."""

    def lay(pose: Floats) -> PlannedCourse:
        found = plan_crossing(walk)
        if found.status != "found":
            raise RefusedError(
                f"the ditch cannot be crossed with {1e3 * CLEARANCE:.0f} mm kept between feet and edges, {1e3 * BALANCE:.0f} mm of "
                f"balance and {1e3 * STROKE:.0f} mm of the actuators' strokes: {found.reason}"
            )
        return PlannedCourse(crossing_steps(found), found.start[0], pose, radius=walk.robot.legs.radius_delta)

    return lay
