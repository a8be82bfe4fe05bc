"""Plan and control robots that climb and walk on several limbs.

What stands in `__all__` is stable: it changes in major versions only, and the changelog says how. Each name is loaded when it is first
asked for, so that `import clamber` is quick. SI units and radians; shapes and frames stand in each docstring.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from .api.comparing import compare as compare
    from .api.drawing import draw as draw
    from .api.planning import answer as answer
    from .api.planning import check as check
    from .api.planning import explain_infeasibility as explain_infeasibility
    from .api.planning import inspect as inspect
    from .api.planning import load_plan as load_plan
    from .api.planning import plan as plan
    from .api.running import run as run
    from .errors import ClamberError as ClamberError
    from .families.climber.world.library import load_board as load_board
    from .families.walker.planning.walks import load_walk as load_walk
    from .families.walker.world.ground import load_ground as load_ground
    from .planning.problem.plan import Plan as Plan
    from .planning.problem.problems import pose_problem as pose_problem
    from .planning.problem.verdict import OutsideCheck as OutsideCheck
    from .planning.problem.verdict import Verdict as Verdict
    from .planning.result import PlanResult as PlanResult
    from .tasks.library import change_task as change_task
    from .tasks.library import load_task as load_task
    from .tasks.robots import load_robot as load_robot

_PLACES = {
    "ClamberError": "errors",
    "OutsideCheck": "planning.problem.verdict",
    "Plan": "planning.problem.plan",
    "PlanResult": "planning.result",
    "Verdict": "planning.problem.verdict",
    "answer": "api.planning",
    "change_task": "tasks.library",
    "check": "api.planning",
    "compare": "api.comparing",
    "draw": "api.drawing",
    "find_openings": "api.planning",
    "inspect": "api.planning",
    "load_board": "families.climber.world.library",
    "load_ground": "families.walker.world.ground",
    "load_plan": "api.planning",
    "load_robot": "tasks.robots",
    "load_task": "tasks.library",
    "load_walk": "families.walker.planning.walks",
    "plan": "api.planning",
    "pose_problem": "planning.problem.problems",
    "run": "api.running",
}

__all__ = [
    "ClamberError",
    "OutsideCheck",
    "Plan",
    "PlanResult",
    "Verdict",
    "__version__",
    "answer",
    "change_task",
    "check",
    "compare",
    "draw",
    "find_openings",
    "inspect",
    "load_board",
    "load_ground",
    "load_plan",
    "load_robot",
    "load_task",
    "load_walk",
    "plan",
    "pose_problem",
    "run",
]


def __getattr__(name: str) -> Any:
    place = _PLACES.get(name)
    if place is None:
        raise AttributeError(f"module 'clamber' has no attribute {name!r}")
    found = getattr(import_module(f".{place}", __name__), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
