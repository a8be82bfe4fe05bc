"""Arrays that a problem is made of: parameters for its kernels, its action table, the cost-to-go map, children of stances."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ...errors import SpecError
from ...types import Floats

AnyArray = npt.NDArray[np.generic]


def with_room(old: Any, capacity: int) -> Any:
    """A longer array that begins like another, shape (capacity, ...)."""
    new = np.zeros((capacity, *old.shape[1:]), old.dtype)
    new[: len(old)] = old
    return new


class Params:
    """The record that kernels are handed (`record`), with an address field `NAME_at` for every array, and `n_NAME` where it has one."""

    def __init__(self, record: npt.NDArray[np.void], **arrays: AnyArray) -> None:
        """Point the record at its arrays.

        Args:
            record: Array of one record, its other fields filled.
            **arrays: C-ordered arrays by name; those whose names begin with `work` are scratch.
        """
        self._record = record
        self._arrays = {name: np.ascontiguousarray(array) for name, array in arrays.items()}
        for name, array in self._arrays.items():
            record[f"{name}_at"] = array.ctypes.data
            if f"n_{name}" in (record.dtype.names or ()):
                record[f"n_{name}"] = len(array)

    @property
    def record(self) -> np.void:
        """What kernels take; valid as long as this object lives."""
        row: np.void = self._record[0]
        return row

    def array(self, name: str) -> AnyArray:
        """One of the arrays."""
        return self._arrays[name]

    def extended(self, fields: Mapping[str, float], **arrays: AnyArray) -> "Params":
        """The same parameters with some fields of the record set, and further arrays."""
        record = self._record.copy()
        for name, value in fields.items():
            record[name] = value
        return Params(record, **{**self._arrays, **arrays})

    def for_thread(self) -> "Params":
        """The same parameters with scratch of their own."""
        own = {name: array.copy() for name, array in self._arrays.items() if name.startswith("work")}
        return Params(self._record.copy(), **{**self._arrays, **own})

    def with_fields(self, **fields: int) -> "Params":
        """The same parameters with some fields of the record changed, and scratch of their own."""
        other = self.for_thread()
        for name, value in fields.items():
            other.record[name] = value
        return other


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


@dataclass(frozen=True, slots=True)
class CostToGoMap:
    """Steps of the body that are left, at least roughly, over a grid of places."""

    frame: Floats
    """Lower left place and grain [m], shape (3,)."""
    fields: Floats
    """Steps to each goal from every place, shape (goals, rows, columns)."""
    hold_fields: Floats
    """The same at every hold, shape (goals, holds)."""
    after: Floats
    """Steps from each goal through all later ones, shape (goals,)."""


@dataclass(frozen=True, slots=True)
class Children:
    """Every valid child of a batch of stances: index of the parent, code of the action, stance."""

    parent: npt.NDArray[np.int32]
    code: npt.NDArray[np.int32]
    stance: npt.NDArray[np.void]


@dataclass(frozen=True, slots=True)
class ScoredChildren:
    """Every valid child of a batch of stances, in slots by parent: the first `count` of each row are filled."""

    count: npt.NDArray[np.int32]
    """Children of each parent, shape (n,)."""
    code: npt.NDArray[np.int32]
    """Actions, shape (n, slots)."""
    score: npt.NDArray[np.float64]
    """Weighted features less the toll, shape (n, slots)."""
    cell: npt.NDArray[np.int64]
    """Niches, shape (n, slots)."""
    done: npt.NDArray[np.uint8]
    """Whether every goal is met, shape (n, slots)."""
    keys: npt.NDArray[np.int64]
    """Shape (n, slots, words)."""
