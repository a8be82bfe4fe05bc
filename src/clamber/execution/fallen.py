"""A fall, of whatever robot: how a run ends that neither a plan nor a user is to blame for."""


class FallenError(Exception):
    """The robot has fallen; the run ends with this reason. Never a user's mistake."""
