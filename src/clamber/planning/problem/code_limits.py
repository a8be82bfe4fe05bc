"""Which codes are actions of a problem, and which of its indices exist: looked at before a kernel, which takes them as they are."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from ...errors import SpecError
from ...types import Ints
from .arrays import ActionTable
from .codes import ARGUMENT_BITS, ARGUMENT_MASK, KINDS, LIMB_BITS, LIMB_MASK


@dataclass(frozen=True)
class CodeLimits:
    """The codes and indices that a problem has."""

    label: str
    """What errors call it, such as "task 'ladder'"."""
    kinds: Mapping[int, tuple[int, int, int]]
    """Kind of action -> number of limbs that have it, least and largest argument; a kind that is not named does not exist."""
    fields: Mapping[str, tuple[int, int, int]]
    """Index in a stance record -> least and largest value, and how many of its elements are used."""

    @property
    def allowed(self) -> str:
        """The codes in words."""
        return "must be the code of an action here: " + ", ".join(
            f"{KINDS[kind]} ({'limb 0' if limbs == 1 else f'limbs 0 to {limbs - 1}'}, "
            f"argument {least if least == most else f'{least} to {most}'})"
            for kind, (limbs, least, most) in sorted(self.kinds.items())
        )

    @cached_property
    def _by_kind(self) -> npt.NDArray[np.int64]:
        """Number of limbs, least and largest argument of every kind, shape (3, kinds)."""
        rows = np.zeros((3, len(KINDS)), np.int64)
        for kind, limits in self.kinds.items():
            rows[:, kind] = limits
        return rows

    def wrong(self, codes: npt.NDArray[np.int64]) -> npt.NDArray[np.bool_]:
        """Which of many codes are no actions."""
        kind = codes >> (ARGUMENT_BITS + LIMB_BITS)
        known = (kind >= 0) & (kind < len(KINDS))
        limbs, least, most = self._by_kind[:, np.where(known, kind, 0)]
        argument = codes & ARGUMENT_MASK
        limb = (codes >> ARGUMENT_BITS) & LIMB_MASK
        wrong: npt.NDArray[np.bool_] = ~known | (limb >= limbs) | (argument < least) | (argument > most)
        return wrong

    def macro(self, codes: Any, key: str, label: str) -> Ints:
        """As `codes`, of a macro, which has one action or more."""
        if not len(codes):
            raise SpecError(label, key, [], "must be one code or more")
        return self.codes(codes, key, label)

    def codes(self, codes: Any, key: str = "codes", label: str | None = None) -> Ints:
        """Packed codes as kernels take them.

        Args:
            codes: Whole numbers, one axis.
            key: What errors call them.
            label: Where they come from, such as a file; None: the problem.

        Raises:
            SpecError: If one is no action of the problem; it names the first.
        """
        taken = whole_numbers(codes, key, label or self.label)
        wrong = self.wrong(taken)
        if wrong.any():
            at = int(np.argmax(wrong))
            raise SpecError(label or self.label, f"{key}.{at}", int(taken[at]), _opened(int(taken[at])) + self.allowed)
        return np.ascontiguousarray(taken, np.int32)

    def table(self, table: ActionTable) -> ActionTable:
        """An action table, each of whose entries is one action or several.

        Raises:
            SpecError: If an entry is empty, or has a code that is no action; it names the entry.
        """
        n = len(table.names)
        offsets = whole_numbers(table.offsets, "actions.offsets", self.label)
        codes = whole_numbers(table.codes, "actions.codes", self.label)
        whole = offsets.shape == (n + 1,) and table.runs.shape == (n,) and offsets[0] == 0 and offsets[-1] == len(codes)
        if not whole or (lengths := np.diff(offsets)).min(initial=0) < 0:
            raise SpecError(self.label, "actions", n, "must be a table made by ActionTable.build")
        if not lengths.all():
            name = table.names[int(np.argmin(lengths))]
            raise SpecError(self.label, f"actions.{name}", [], "must be one code or more")
        wrong = self.wrong(codes)
        if wrong.any():
            at = int(np.argmax(wrong))
            name = table.names[int(np.searchsorted(offsets, at, side="right")) - 1]
            raise SpecError(self.label, f"actions.{name}", int(codes[at]), _opened(int(codes[at])) + self.allowed)
        return table

    def genes(self, genes: Any, lengths: Any, table: ActionTable) -> tuple[Ints, Ints]:
        """Plans as entries of a table, as kernels take them: genes, shape (n, longest), and how many each has, shape (n,).

        Raises:
            SpecError: If a plan is longer than its row, or one of its genes is no entry.
        """
        taken, counts = np.asarray(genes), whole_numbers(lengths, "lengths", self.label)
        if taken.dtype.kind not in "iu" or taken.ndim != 2 or counts.shape != (len(taken),):
            raise SpecError(
                self.label, "genes", list(taken.shape), "must be whole numbers, shape (n, longest), and n lengths"
            )
        if counts.size and (counts.min() < 0 or counts.max() > taken.shape[1]):
            at = int(np.argmax((counts < 0) | (counts > taken.shape[1])))
            raise SpecError(
                self.label, f"lengths.{at}", int(counts[at]), f"must be 0 to {taken.shape[1]}, the genes of a row"
            )
        if taken.size and (taken.min() < 0 or taken.max() >= len(table)):  # what lies behind a plan's end is not read
            wrong = ((taken < 0) | (taken >= len(table))) & (np.arange(taken.shape[1]) < counts[:, None])
            if wrong.any():
                plan, at = (int(place[0]) for place in np.nonzero(wrong))
                allowed = f"must be an entry of the action table, 0 to {len(table) - 1}"
                raise SpecError(self.label, f"genes.{plan}.{at}", int(taken[plan, at]), allowed)
            taken = np.where((taken < 0) | (taken >= len(table)), 0, taken)
        return np.ascontiguousarray(taken, np.int32), np.ascontiguousarray(counts, np.int32)

    def stances(self, stances: npt.NDArray[np.void], dtype: np.dtype[Any]) -> npt.NDArray[np.void]:
        """Stance records whose indices exist.

        Raises:
            SpecError: If they are no records of this family, or an index is out of its range.
        """
        if getattr(stances, "dtype", None) != dtype or stances.ndim != 1:
            raise SpecError(
                self.label, "stances", type(stances).__name__, "must be stances of this task's robot, one axis"
            )
        for field, (least, most, used) in self.fields.items():
            values = stances[field].reshape(len(stances), -1)[:, :used]
            if values.size and (values.min() < least or values.max() > most):
                row, at = (int(place[0]) for place in np.nonzero((values < least) | (values > most)))
                raise SpecError(
                    self.label, f"stances.{row}.{field}", int(values[row, at]), f"must be {least} to {most}"
                )
        return stances


def indices(values: Any, n: int, key: str, label: str) -> Ints:
    """Indices below n, as kernels take them.

    Raises:
        SpecError: If one is not.
    """
    taken = whole_numbers(values, key, label)
    if taken.size and (taken.min() < 0 or taken.max() >= n):
        at = int(np.argmax((taken < 0) | (taken >= n)))
        raise SpecError(label, f"{key}.{at}", int(taken[at]), f"must be 0 to {n - 1}")
    return np.ascontiguousarray(taken, np.int32)


def whole_numbers(values: Any, key: str, label: str) -> npt.NDArray[np.int64]:
    """Whole numbers of 32 bits along one axis.

    Raises:
        SpecError: If they are none.
    """
    limits = np.iinfo(np.int32)
    if not isinstance(values, np.ndarray):
        listed = list(values)
        if not all(isinstance(value, int | np.integer) and not isinstance(value, bool) for value in listed):
            raise SpecError(label, key, listed, "must be whole numbers")
        beyond = (at for at, value in enumerate(listed) if not limits.min <= value <= limits.max)
        taken = np.array(listed, np.int64) if (first := next(beyond, None)) is None else np.array(listed, object)
    else:
        taken = values
        if taken.ndim != 1 or (taken.size and taken.dtype.kind not in "iu"):
            raise SpecError(label, key, taken.tolist(), "must be whole numbers along one axis")
        wrong = (taken < limits.min) | (taken > limits.max)
        first = int(np.argmax(wrong)) if wrong.any() else None
    if first is not None:
        raise SpecError(label, f"{key}.{first}", int(taken[first]), f"must be {limits.min} to {limits.max}")
    return taken.astype(np.int64)


def _opened(code: int) -> str:
    """A code that is no action, opened."""
    kind = code >> (ARGUMENT_BITS + LIMB_BITS)
    limb, argument = (code >> ARGUMENT_BITS) & LIMB_MASK, code & ARGUMENT_MASK
    return f"is kind {kind}, limb {limb}, argument {argument}; " if code >= 0 else ""
