"""Forces on feet from the contacts that a physics step has left. A kernel."""

from ..compiled import kernel


@kernel
def add_forces(starts, pairs, frames, rows, foot_of, forces):
    """Add up what each foot feels.

    Args:
        starts: Of each contact's rows among the constraints, negative for contacts without any, shape (n,).
        pairs: Geoms of each contact, shape (n, 2).
        frames: Normal, then two directions across it, row by row, shape (n, 9).
        rows: Forces of all constraints; of a contact the one along its normal, then two across it [N].
        foot_of: Foot of each geom, negative for others.
        forces: Changed, world frame, shape (6, 3) [N].
    """
    for n in range(starts.shape[0]):
        if starts[n] < 0:
            continue
        for side in range(2):
            foot = foot_of[pairs[n, side]]
            if foot >= 0:
                for i in range(3):
                    for j in range(3):
                        # what a contact's rows say is on its second geom
                        forces[foot, j] += (2.0 * side - 1.0) * rows[starts[n] + i] * frames[n, 3 * i + j]
