"""What section 2.5.2 leaves unsaid about the modified ladder, as two readings."""

from typing import Final

OWN_HALVES: Final = 'rules.keep=[{limb="right",x_min="9in"},{limb="left",x_max="9in"}]'
"""Legs 1 and 2 keep to their own column of pegs."""
HELD_OFFSET: Final = "rules.offset_while_holding=true"
"""The reach offset of 1 in counts while a leg holds, too, not only when it grabs."""
NO_HANGS: Final = "rules.max_hangs=0"
"""A hang turns the body without a module for it."""
OWN: Final = (OWN_HALVES, HELD_OFFSET, NO_HANGS)
"""The reading that fits all claims of the section."""
WORDS: Final = {OWN_HALVES: "own halves", HELD_OFFSET: "offset while holding", NO_HANGS: "no hangs"}


def reading(rules: tuple[str, ...]) -> str:
    """A set of rules in words."""
    return ", ".join(WORDS[rule] for rule in rules if rule in WORDS) or "free"
