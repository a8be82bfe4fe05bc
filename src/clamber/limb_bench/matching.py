r"""Making laws comparable: a law's stiffness at the tip, and gains that give two laws the same.

The stiffness is measured from the law itself: K_theta = -d tau / d q at rest on its aim, by central differences of the controller's own
torques, and S = J^-T K_theta J^-1 at the tip. SCCT's is J^-T K' J^-1 K_p, a full matrix even for equal gains, J^T's is K_p: "the same
stiffness" can mean the yy entry, the mean of both, or each diagonal entry, and the choice decides who wins.
"""

from dataclasses import replace
from typing import Final, Literal, TypeAlias

import numpy as np

from ..control.chain import Chain
from ..control.controller import still_aim
from ..control.law_settings import LawError, LawSettings
from ..control.outside_law import controller_of
from ..types import Floats

Match: TypeAlias = Literal["yy", "mean", "diagonal", "none"]
MATCHES: Final[tuple[Match, ...]] = ("yy", "mean", "diagonal", "none")
NUDGE: Final = 1e-6
"""Of a joint [rad]."""
HELD: Final = 200
"""Ticks that a nudge is held before its torques count: a filtered derivative has died away, what is left is the spring."""
LEAST_PART: Final = 1e-6
"""A stiffness smaller than this part of that along the other axis is none."""


def tip_stiffness(chain: Chain, settings: LawSettings, q: Floats) -> Floats:
    """Stiffness of a law at the tip in x and y, at rest on its aim, from its own torques, shape (2, 2) [N/m]."""
    # at rest a derivative term has died away; in the tick after a nudge it has not
    bare = settings.with_changes(feed_gravity=False, feed_friction=0.0, derivative=0.0)
    controller = controller_of(chain, bare, period=0.005)
    aim = still_aim(chain.place(q))
    states = np.zeros((1, 2, chain.n))

    def torques(angles: Floats) -> Floats:
        # A law that remembers its aim in joint angles is first asked at the aim
        controller.reset()
        states[0, 0] = q
        controller.command(aim, states)
        states[0, 0] = angles
        for _ in range(HELD):
            out: Floats = controller.command(aim, states)[0]
        return out.copy()

    joint = np.empty((chain.n, chain.n))
    for j, nudge in enumerate(NUDGE * np.eye(chain.n)):
        joint[:, j] = -(torques(q + nudge) - torques(q - nudge)) / (2 * NUDGE)
    inverse = np.linalg.pinv(chain.jacobian(q)[:2])
    stiffness: Floats = inverse.T @ joint @ inverse
    return stiffness


def match_gains(chain: Chain, settings: LawSettings, reference: LawSettings, q: Floats, how: Match) -> LawSettings:
    """`settings` with kp and kd scaled until its stiffness at `q` is that of `reference` in the sense of `how`.

    kd is scaled as kp is, so the ratio of both stays that of `reference`, whose gains are the starting point.

    "diagonal" goes by the axes of the task frame of `settings`; a law with one gain for all directions, as joint-pd, or with a servo gain
    of its own, is left unmatched by it: its stiffness tells.

    Raises:
        LawError: If either law has no stiffness in that sense, as along a row that carries a force.
    """
    if how == "none":
        return settings
    start = replace(settings, kp=reference.kp, kd=reference.kd)
    turn = settings.task_frame()[:2, :2] if how == "diagonal" else np.eye(2)
    ours, theirs = (turn.T @ tip_stiffness(chain, law, q) @ turn for law in (start, reference))
    for law, stiffness in ((settings, ours), (reference, theirs)):
        if not np.diag(stiffness).min() > LEAST_PART * np.diag(stiffness).max():
            raise LawError(
                law.law,
                "kp",
                "(matched)",
                f"has no stiffness of its own to match by '{how}': state kp and kd, or 'none'",
            )
    if how == "yy":
        factors = np.full(2, theirs[1, 1] / ours[1, 1])
    elif how == "mean":
        factors = np.full(2, np.trace(theirs) / np.trace(ours))
    else:
        factors = np.diag(theirs) / np.diag(ours)

    def scaled(value: float | tuple[float, ...]) -> float | tuple[float, ...]:
        pair = np.broadcast_to(np.asarray(value, dtype=np.float64), 2) * factors
        return float(pair[0]) if pair[0] == pair[1] else tuple(map(float, pair))

    return replace(start, kp=scaled(start.kp), kd=scaled(start.kd))
