"""The five boards and the rules that every proof of this study is for."""

from typing import Final

from ...families.climber.statics.checks import DEFAULT_HARD

BOARDS: Final = ("ladder", "modified-ladder", "h", "across", "circle")
MODEL: Final = (
    "step.length=1in",
    "step.angle=15deg",
    "rules.support=strict",
    "rules.max_hangs=0",
    "rules.clearance=6in",
)
"""Steps of 1 in and 15 deg, swings of limbs checked, no hangs, body 6 in off the pegs."""
KEPT: Final = "rules.branch=kept"
"""A limb keeps the side of its elbow while it holds, as a real one does."""
HARD_HOOKS: Final = f"rules.hard=[{', '.join(repr(name) for name in (*DEFAULT_HARD, 'hook'))}]".replace("'", '"')
"""The check `hook` forbids actions, too."""
NEVER_HANGS: Final = (
    "Without hangs all stances lie on one lattice of poses, so they are finitely many and can all be seen."
)
TOLD: Final = (
    "Proofs are for the rules of the task: body moves of 1 in and 15 deg, the swing of a leg checked (strict), no hangs, "
    "body 6 in off the pegs, the thesis's force rule; limbs may pass through each other and through pegs.",
    "LIBRA is the robot file's: the hook of leg 1 mirrors leg 2's, the second link of leg 3 is 15.5 cm; starts are inferred.",
)


def cone(degrees: float) -> str:
    """The rule that end effectors take forces within so many degrees of their grab direction."""
    return f"rules.hook_cone={degrees:g}deg"
