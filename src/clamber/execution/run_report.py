"""What is told of a run, of whatever robot: what may become of an action, and how the whole ended."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

Outcome: TypeAlias = Literal[
    "ok", "stalled", "moved", "missed", "no ground", "not supported", "refused", "stuck", "fell", "stopped", "interrupted"
]  # fmt: skip
"""What became of an action. Done: `ok`, or `stalled` (the body stays off its aim), or `moved` (a frame came down elsewhere). Not done:
`missed` a hold, found `no ground`, `not supported`, `refused` before it would break a rule, or the robot is `stuck`. Ended in it: the
robot `fell`, its plant was `stopped`, a user `interrupted` it."""


@dataclass(slots=True, kw_only=True)
class RunReport:
    """How a run went; a kind of robot adds what became of its actions."""

    done: bool = False
    """Whether every action was carried out and the robot came to its goal with that."""
    seconds: float = 0.0
    """Simulated, or on the robot's clock."""
    reason: str = ""
    """Why it ended, where it is not done."""
    pose: tuple[float, ...] = ()
    """Of the body at the end, as believed [m], [rad]; empty if it never stood."""
    true_pose: tuple[float, ...] | None = None
    """As it truly was; None where nobody tells."""
