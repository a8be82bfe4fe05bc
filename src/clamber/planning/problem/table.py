"""The action table: what a gene can be, as arrays (single codes and macros) with a name for each entry."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ...errors import SpecError


@dataclass(frozen=True, slots=True)
class ActionTable:
    """Entries of the inventory. Entry g is `codes[offsets[g]:offsets[g + 1]]`: one code, or a macro of several."""

    names: tuple[str, ...]
    offsets: npt.NDArray[np.int32]
    codes: npt.NDArray[np.int32]
    runs: npt.NDArray[np.uint8]
    """1 where a run of one entry makes sense (body moves): shape (n,)."""

    @classmethod
    def build(cls, entries: Sequence[tuple[str, Sequence[int], bool]]) -> "ActionTable":
        """A table from (name, codes, may run) of each entry; whether a problem has the codes is asked where they meet it.

        Raises:
            SpecError: If a code is no whole number of 32 bits.
        """
        for name, codes, _ in entries:
            if not all(isinstance(code, int | np.integer) and -(2**31) <= code < 2**31 for code in codes):
                raise SpecError("action table", f"actions.{name}", list(codes), "must be whole numbers of 32 bits")
        lengths = [len(codes) for _, codes, _ in entries]
        return cls(
            tuple(name for name, _, _ in entries),
            np.concatenate([[0], np.cumsum(lengths)]).astype(np.int32),
            np.array([code for _, codes, _ in entries for code in codes], np.int32),
            np.array([run for _, _, run in entries], np.uint8),
        )

    def extended(self, entries: Sequence[tuple[str, Sequence[int], bool]]) -> "ActionTable":
        """This table with more entries behind its own."""
        own = [
            (name, self.codes[self.offsets[g] : self.offsets[g + 1]].tolist(), bool(self.runs[g]))
            for g, name in enumerate(self.names)
        ]
        return ActionTable.build([*own, *entries])

    def __len__(self) -> int:
        return len(self.names)

    def spell(self, genes: npt.NDArray[np.int32]) -> npt.NDArray[np.int32]:
        """The codes that a sequence of entries stands for."""
        parts = [self.codes[self.offsets[g] : self.offsets[g + 1]] for g in genes]
        return np.concatenate(parts).astype(np.int32) if parts else np.zeros(0, np.int32)
