"""A family's parameters for its kernels: one record that holds the addresses of arrays, and the arrays kept alive."""

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

AnyArray = npt.NDArray[np.generic]


class Params:
    """The record that kernels are handed (`record`), with an address field `NAME_at` for every array, and `n_NAME` where it has one."""

    def __init__(self, record: npt.NDArray[np.void], **arrays: AnyArray) -> None:
        """Point the record at its arrays.

        Args:
            record: Array of one record, its other fields filled.
            **arrays: C-ordered arrays by name; `work`, if a family has one, is scratch.
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
        own = {"work": np.zeros_like(self._arrays["work"])} if "work" in self._arrays else {}
        return Params(self._record.copy(), **{**self._arrays, **own})

    def with_fields(self, **fields: int) -> "Params":
        """The same parameters with some fields of the record changed, and scratch of their own."""
        other = self.for_thread()
        for name, value in fields.items():
            other.record[name] = value
        return other
