"""Pictures of any robot's plan: each family says how its own are drawn."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from matplotlib.axes import Axes

from ..actions.plan import Plan
from ..actions.plan_families import plan_family
from ..actions.problem import Replay
from ..errors import UnknownNameError
from ..tasks import Task
from .animation import animate_limbed
from .route import draw_limbed_route
from .stance import draw_limbed_stance


@dataclass(frozen=True, slots=True)
class Pictures:
    """How one family of robots is drawn."""

    stance: Callable[[Any, Replay, int, str | Path | Axes], None]
    route: Callable[[Any, Replay, str | Path], None]
    animate: Callable[[Any, Replay, str | Path], None]


FAMILIES: Final[dict[str, Pictures]] = {
    "limbed": Pictures(draw_limbed_stance, draw_limbed_route, animate_limbed),
}
"""Family of the robot -> how its climbs are drawn."""


def _family(task: Task) -> Pictures:
    name = task.document["robot"]["family"]
    if name not in FAMILIES:
        raise UnknownNameError("robot family with pictures", name, tuple(FAMILIES))
    return FAMILIES[name]


def _carried_out(task: Task, climb: Replay | Plan) -> Replay:
    if isinstance(climb, Replay):
        return climb
    return plan_family(task).problem(task).replay(climb.codes(task), go_on=True)


def draw_stance(task: Task, climb: Replay | Plan, step: int, target: str | Path | Axes) -> None:
    """Draw the stance after a step, with its forces, torques and nearest limit.

    Args:
        task: The task.
        climb: A plan, or its replay.
        step: Number of the action, from 1; 0 is the start.
        target: A file (.png, .svg, .pdf), or axes, which get the wall alone.

    Raises:
        ClamberError: If there is no such step, or the file's suffix or place will not do.
    """
    _family(task).stance(task, _carried_out(task, climb), step, target)


def draw_route(task: Task, climb: Replay | Plan, path: str | Path) -> None:
    """Draw a whole plan as one still picture (.png, .svg, .pdf).

    Raises:
        ClamberError: If the file's suffix or place will not do.
    """
    _family(task).route(task, _carried_out(task, climb), path)


def animate(task: Task, climb: Replay | Plan, path: str | Path) -> None:
    """Write a plan as an animation (.gif, .html, .mp4).

    Raises:
        ClamberError: If the file's suffix or place will not do, or .mp4 lacks its extra.
    """
    _family(task).animate(task, _carried_out(task, climb), path)
