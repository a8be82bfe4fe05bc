"""Pivoting on the spot: which frame turns by how much, one after the other, to turn the body and the frames to each other."""

import math

DELTA, Y = 0, 1
SMALL = 1e-9
"""Turns below are none [rad]."""


def pivots(theta: float, aim: float, turn: float, limits: tuple[float, float]) -> tuple[tuple[int, float], ...]:
    """Pivots that turn the Delta-frame by `turn` and bring theta to `aim`: frame and by how much it turns [rad]."""
    low, high = limits
    moves: list[tuple[int, float]] = []
    while abs(turn) > SMALL:
        if low <= theta - turn <= high:
            step = turn
        elif low <= aim + turn <= high:
            moves.append((Y, aim + turn - theta))
            theta, step = aim + turn, turn
        else:  # wind up as far as it goes, then let the Delta-frame follow
            wound = high if turn > 0.0 else low
            moves.append((Y, wound - theta))
            theta = wound
            step = math.copysign(min(abs(turn), high - low), turn)
        moves.append((DELTA, step))
        theta, turn = theta - step, turn - step
    if abs(aim - theta) > SMALL:
        moves.append((Y, aim - theta))
    return tuple(move for move in moves if abs(move[1]) > SMALL)
