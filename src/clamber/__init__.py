"""Plan and control robots that climb and walk on several limbs.

What stands in `__all__` is stable: it changes in major versions only, and the changelog says how. Each name is loaded when it is first
asked for, so that `import clamber` is quick. SI units and radians; shapes and frames stand in each docstring.
"""

import sys
import warnings
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from .api.comparing import compare as compare
    from .api.drawing import draw as draw
    from .api.mapping import reach as reach
    from .api.mapping import sweep as sweep
    from .api.opening import load_world as load_world
    from .api.planning import answer as answer
    from .api.planning import check as check
    from .api.planning import explain_infeasibility as explain_infeasibility
    from .api.planning import inspect as inspect
    from .api.planning import load_plan as load_plan
    from .api.planning import plan as plan
    from .api.running import run as run
    from .api.running import trials as trials
    from .api.running import validate as validate
    from .api.viewing import view as view
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
    "explain_infeasibility": "api.planning",
    "inspect": "api.planning",
    "load_board": "families.climber.world.library",
    "load_ground": "families.walker.world.ground",
    "load_plan": "api.planning",
    "load_robot": "tasks.robots",
    "load_task": "tasks.library",
    "load_walk": "families.walker.planning.walks",
    "load_world": "api.opening",
    "plan": "api.planning",
    "pose_problem": "planning.problem.problems",
    "reach": "api.mapping",
    "run": "api.running",
    "sweep": "api.mapping",
    "trials": "api.running",
    "validate": "api.running",
    "view": "api.viewing",
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
    "explain_infeasibility",
    "inspect",
    "load_board",
    "load_ground",
    "load_plan",
    "load_robot",
    "load_task",
    "load_walk",
    "load_world",
    "plan",
    "pose_problem",
    "reach",
    "run",
    "sweep",
    "trials",
    "validate",
    "view",
]


class _Package(ModuleType):
    """What is offered keeps its name where a folder has it, too: `clamber.trials` is the function, whoever imports from the folder."""

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in _PLACES or not isinstance(value, ModuleType):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package

_RENAMED = {"find_openings": "explain_infeasibility"}
"""Old name, read for one release -> name."""


def __getattr__(name: str) -> Any:
    if name in _RENAMED:
        new = _RENAMED[name]
        warnings.warn(f"clamber.{name} is called {new} now", DeprecationWarning, stacklevel=2)
        return getattr(sys.modules[__name__], new)
    place = _PLACES.get(name)
    if place is None:
        raise AttributeError(f"module 'clamber' has no attribute {name!r}")
    found = getattr(import_module(f".{place}", __name__), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
