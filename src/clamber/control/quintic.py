"""From rest to rest by the quintic law: speed and acceleration are 0 at both ends."""


def quintic_share(part: float) -> float:
    """Share of the way done after a part of the time, 6 u^5 - 15 u^4 + 10 u^3; before the start 0, after the end 1 [-]."""
    u = min(1.0, max(0.0, part))
    return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)
