"""How much room a hook takes, with the flare that guides a hold into it. Nobody prints it: the sizes of the hooks that are simulated."""

from typing import Final

HOOK_WIDTH: Final = 0.0287
"""Across, from lip to lip [m]."""
HOOK_AHEAD: Final = 0.0161
"""From the seated hold's centre along the grab direction to the end of the lips [m]."""
HOOK_WAY: Final = 0.042
"""Least distance from a hold at which a hook that opens along its link turns towards it: nearer, its flare knocks the hold [m]."""
