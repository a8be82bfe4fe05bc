"""The physics of a climb without the climber: the same model, the same steps, the torques and pushes written down beforehand."""

from typing import Any

import numpy as np

from ....types import Floats
from .climber_plant import ClimberPlant


class TapedClimberPlant(ClimberPlant):
    """A climber's plant that writes down what goes into its physics since its reset, and can do it again without anybody else."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self._tape: list[tuple[Floats, Floats, int]] = []
        self._start: tuple[Floats, Floats] | None = None
        self._raw_step, self._step = self._step, self._taped

    @property
    def steps(self) -> int:
        """Physics steps written down."""
        return sum(n for _, _, n in self._tape)

    @property
    def coordinates(self) -> Floats:
        """Of the model now, shape (nq,)."""
        out: Floats = self._qpos.copy()
        return out

    def reset(self, pose: Floats, q: Floats) -> None:
        """As a plant's, with nothing written down."""
        super().reset(pose, q)
        self._tape.clear()
        self._start = np.array(pose, float), np.array(q, float)

    def replay(self) -> None:
        """Start again and step through all that is written down, as fast as MuJoCo goes from Python."""
        assert self._start is not None
        super().reset(*self._start)
        step, model, data, ctrl, pushed = self._raw_step, self.model, self._data, self._ctrl, self._pushed
        for torques, push, n in self._tape:
            ctrl[:] = torques
            pushed[:] = push
            step(model, data, n)

    def _taped(self, model: Any, data: Any, n: int) -> None:
        self._tape.append((self._ctrl.copy(), self._pushed.copy(), n))
        self._raw_step(model, data, n)
