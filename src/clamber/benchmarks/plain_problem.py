"""The plain-Python evaluator of the tests in the place of the kernels, to measure what compiling is worth."""

import importlib
import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from ..families.climber.planning.problem import LimbedProblem
from ..families.climber.planning.task import LimbedTask
from ..planning.problem.arrays import ActionTable
from ..planning.problem.codes import Code
from ..planning.problem.problem import Records

CHECKOUT: Final = Path(__file__).resolve().parents[3]
PACKAGE: Final = "clamber_tests_plain"


def plain_module(checkout: Path = CHECKOUT) -> ModuleType | None:
    """The tests' plain evaluator, loaded by its path; None where there is no checkout around this package."""
    init = checkout / "tests" / "plain" / "__init__.py"
    if not init.is_file():
        return None
    if PACKAGE not in sys.modules:
        spec = importlib.util.spec_from_file_location(PACKAGE, init, submodule_search_locations=[str(init.parent)])
        assert spec is not None and spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.modules[PACKAGE] = module
        spec.loader.exec_module(module)
    return importlib.import_module(f"{PACKAGE}.evaluator")


class PlainProblem(LimbedProblem):
    """A limbed task whose plans the plain evaluator carries out.

    The kernels then carry them out once more for the records (a few hundredths of the time), so searches go the same way with both.
    """

    def __init__(self, task: LimbedTask, actions: ActionTable, module: ModuleType) -> None:
        super().__init__(task, actions, threads=1)
        self.plain: Any = module.PlainEvaluator(task)

    def rollout(
        self, genes: npt.NDArray[np.int32], lengths: npt.NDArray[np.int32], weights: npt.NDArray[np.float64], limit: int
    ) -> Records:
        """Carry out many plans, each up to its goal or its first failure; see `CompiledProblem.rollout`."""
        for row, length in zip(genes, lengths, strict=True):
            self.carry_out(self.actions.spell(row[:length])[:limit])
        return super().rollout(genes, lengths, weights, limit)

    def carry_out(self, codes: npt.NDArray[np.int32]) -> int:
        """Carry out one plan, plainly; the number of actions tried."""
        now = self.plain.start()
        goals = len(self.task.goals)
        for tried, code in enumerate(codes.tolist()):
            if now.stage >= goals:
                return tried
            result = self.plain.step(now, self._action(code))
            if result.reason is not None:
                return tried + 1
            now = result.stance
        return len(codes)

    def _action(self, code: int) -> tuple[Any, ...]:
        opened = Code.of(code)
        if opened.kind == "none":
            return ("none",)
        if opened.kind == "move":
            return ("move", opened.argument // 2, -1 if opened.argument % 2 else 1)
        if opened.kind == "release":
            return ("release", opened.limb)
        if opened.kind == "hold":
            return ("hold", opened.limb, self.task.world.holds[opened.argument].number)
        assert opened.kind == "nearest", "the filtered inventory draws no holds at random"
        return ("nearest", opened.limb, opened.argument)
