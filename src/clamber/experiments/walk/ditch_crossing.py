"""A ditch crossed in contact dynamics: the fewest slides over it, as `clamber ditch` finds them, with room to spare, as a course."""

from dataclasses import replace

from ...control.gait import Limits
from ...errors import SpecError
from ...execution.walk.course import PlannedCourse, PlannedStep
from ...execution.walk.sequencer import Lay
from ...robots.walker.ditch import Footing
from ...robots.walker.ditch_plan import Crossing, cross_ditch
from ...robots.walker.weight import weight_of
from ...tasks.walks import Walk
from ...types import Floats
from .planned import BALANCE, CLEARANCE, GUARD, STROKE


def plan_crossing(walk: Walk) -> Crossing:
    """The slides that cross a walk's ditch, wider by what feet keep from its edges, within less than the mechanism can.

    Args:
        walk: Its way is one ditch.

    Raises:
        SpecError: If it cannot be crossed so; it says why.
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
    found = cross_ditch(
        footing,
        piece.ditch + 2.0 * CLEARANCE,
        before=piece.ahead - CLEARANCE,
        heading=-(piece.along or 0.0),
        theta=start.twist,
    )
    if found.status != "found":
        allowed = (
            f"cannot be crossed with {1e3 * CLEARANCE:.0f} mm between feet and edges, {1e3 * BALANCE:.0f} mm of balance and "
            f"{1e3 * STROKE:.0f} mm of the actuators' strokes kept: {found.reason}"
        )
        raise SpecError(f"walk '{walk.name}'", "way.0.ditch", f"{1e3 * piece.ditch:.6g} mm", allowed)
    return found


def crossing_steps(found: Crossing) -> tuple[PlannedStep, ...]:
    """The slides of a crossing as steps."""
    poses, steps = found.start.copy(), []
    for slide in found.slides:
        steps.append(PlannedStep(slide.frame, slide.way[1:], poses[1 - slide.frame].copy()))
        poses[slide.frame] = slide.way[-1]
    return tuple(steps)


def lay_crossing(walk: Walk) -> Lay:
    """How a walk's ditch is crossed from where the robot stands.

    Raises:
        SpecError: As `plan_crossing`.
    """
    found = plan_crossing(walk)
    steps, start, radius = crossing_steps(found), found.start[0], walk.robot.legs.radius_delta

    def lay(pose: Floats) -> PlannedCourse:
        return PlannedCourse(steps, start, pose, radius=radius)

    return lay
