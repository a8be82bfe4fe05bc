"""Array aliases, one place for all: float64 and int32 of numpy, shapes in the docstrings that use them."""

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

Floats: TypeAlias = npt.NDArray[np.float64]
"""Any array of float64."""

Complexes: TypeAlias = npt.NDArray[np.complex128]
"""Any array of complex128."""

Ints: TypeAlias = npt.NDArray[np.int32]
"""Any array of int32."""

Records: TypeAlias = npt.NDArray[np.void]
"""Any array of structured records; which fields they have stands where they are used."""

Json: TypeAlias = dict[str, Any]
"""A table of plain data as TOML or JSON holds it: strings, numbers, booleans, lists and tables."""
