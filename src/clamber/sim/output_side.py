"""What the joints really do behind their gears and play, from MuJoCo's coordinates, as a kernel."""

from ..compiled import kernel


@kernel
def look_behind_gears(qpos, qvel, stride, states):
    """Fill `states` with true angles and speeds at the output, shape (batch, 2, n).

    Args:
        qpos, qvel: Of the model, shape (batch, at least stride * n).
        stride: 1, or 2 where each joint's play follows it.
        states: Filled.
    """
    for b in range(states.shape[0]):
        for j in range(states.shape[2]):
            at = stride * j
            states[b, 0, j] = qpos[b, at]
            states[b, 1, j] = qvel[b, at]
            if stride == 2:
                states[b, 0, j] += qpos[b, at + 1]
                states[b, 1, j] += qvel[b, at + 1]
