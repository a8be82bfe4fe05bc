"""Actions as numbers: what a gene, a macro and a stored plan are made of.

A code packs kind, limb and argument into 31 bits. The numbers of the thesis (106, 391, 3) are its way of printing it.
"""

from dataclasses import dataclass

from ...compiled import inlined

NONE, MOVE, RELEASE, NEAREST, HOLD, RANDOM = 0, 1, 2, 3, 4, 5
KINDS = ("none", "move", "release", "nearest", "hold", "random")
ARGUMENT_BITS = 23
LIMB_BITS = 4
ARGUMENT_MASK = (1 << ARGUMENT_BITS) - 1
LIMB_MASK = (1 << LIMB_BITS) - 1


def pack(kind: int, limb: int = 0, argument: int = 0) -> int:
    """The code of an action: kind, limb index, and axis (0..5: +x -x +y -y +theta -theta), rank k, or index of the hold."""
    return (kind << (ARGUMENT_BITS + LIMB_BITS)) | (limb << ARGUMENT_BITS) | argument


pack_code = inlined(pack)
"""`pack` for kernels."""


@inlined
def unpack(code):
    """Kind, limb and argument of a code."""
    return code >> (ARGUMENT_BITS + LIMB_BITS), (code >> ARGUMENT_BITS) & LIMB_MASK, code & ARGUMENT_MASK


@dataclass(frozen=True, slots=True)
class Code:
    """An action's code, opened for people."""

    kind: str
    limb: int
    argument: int

    @classmethod
    def of(cls, code: int) -> "Code":
        """Open a packed code."""
        return cls(
            KINDS[code >> (ARGUMENT_BITS + LIMB_BITS)], (code >> ARGUMENT_BITS) & LIMB_MASK, code & ARGUMENT_MASK
        )

    def packed(self) -> int:
        """The code again."""
        return pack(KINDS.index(self.kind), self.limb, self.argument)
