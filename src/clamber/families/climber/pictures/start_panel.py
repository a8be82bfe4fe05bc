"""The part of the panel that sets a climber's start: where its body is, how it is turned, and which limb is on which peg."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from ....viewing.browser.inputs import by_hand, set_input
from ....viewing.browser.pose_part import Plane, PosePart
from ....viewing.words import length_unit
from ..planning.task import FREE, LimbedTask
from .board_draft import BoardDraft
from .wall_space import in_space, on_wall

if TYPE_CHECKING:
    import viser

NOWHERE: Final = "free"
HANDLE: Final = 0.14
"""Size of the handle at the body [m]."""


class StartPanel:
    """Controls for the start of a task.

    Args:
        server: Whose panel they are in; they are made where its context is.
        draft: What they change.
        depth: How far in front of the wall the handle is [m].
        lock: See `PosePart`.
        changed: Is called once the draft has another start.
    """

    def __init__(
        self,
        server: "viser.ViserServer",
        draft: BoardDraft,
        depth: Callable[[], float],
        lock: AbstractContextManager[Any],
        changed: Callable[[], None],
    ) -> None:
        self._draft, self._changed = draft, changed
        task: LimbedTask = draft.task
        plane = Plane(
            *length_unit(task), (True, False, True), lambda x, y: in_space(np.array((x, y)), depth()), lambda at: on_wall(at)
        )  # fmt: skip
        with server.gui.add_folder("Start"):
            self.limbs = {
                limb: server.gui.add_dropdown(f"{limb} is on", self._options(), initial_value=NOWHERE)
                for limb in task.robot.limb_names
            }
            self.body = PosePart(server, "start", ("body", "turned by"), plane, HANDLE, lock, self._moved)
        for limb, chosen in self.limbs.items():
            chosen.on_update(by_hand(self._taker(limb), lock))
        self.refresh()

    def refresh(self) -> None:
        """Show the draft's start, and offer the pegs that there are."""
        start, options = self._draft.start, self._options()
        for limb, chosen in self.limbs.items():
            held = start.holds.get(limb, FREE)
            name = NOWHERE if held == FREE else str(held)
            shown = options if name in options else (name, *options)  # a peg that is gone
            if tuple(chosen.options) != shown:
                chosen.options = shown
            if chosen.value != name:
                set_input(chosen, name)
        self.body.show(start.x, start.y, start.theta)

    def _options(self) -> tuple[str, ...]:
        return (NOWHERE, *(str(number) for number in sorted(self._draft.pegs)))

    def _moved(self, x: float, y: float, angle: float) -> None:
        self._draft.set_start(x, y, angle)
        self.refresh()
        self._changed()

    def _taker(self, limb: str) -> Callable[[Any], None]:
        def take(_: Any) -> None:
            name = self.limbs[limb].value
            self._draft.hold(limb, FREE if name == NOWHERE else int(name))
            self._changed()

        return take
