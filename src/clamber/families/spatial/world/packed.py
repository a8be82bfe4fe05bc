"""Arrays in documents: a terrain's values as text, so that a plan's file has its whole world."""

import base64
import binascii
import math
import zlib
from typing import Annotated, Final

import numpy as np
from pydantic import Field, StrictStr

from ....errors import SpecError
from ....specs import spec
from ....types import Floats

LETTERS: Final = 6_000_000
"""Most of a packed array: files of more than 8 MiB are not read."""
Size = Annotated[int, Field(strict=True, ge=1, le=1_000_000)]


@spec
class Packed:
    """An array of 32-bit floats: little endian, compressed by zlib, in base 64."""

    shape: tuple[Size, Size]
    data: Annotated[str, StrictStr, Field(max_length=LETTERS)]

    @property
    def array(self) -> Floats:
        """Its values.

        Raises:
            SpecError: If the text has not so many values, or some are not finite.
        """
        size = 4 * math.prod(self.shape)
        try:
            reader = zlib.decompressobj()
            raw = reader.decompress(base64.b64decode(self.data, validate=True), size + 1)
        except (binascii.Error, zlib.error):
            raw = b""
        if len(raw) != size:
            raise SpecError("packed array", "data", f"{self.data[:20]}...", f"must have {size} bytes, base 64 of zlib")
        values = np.frombuffer(raw, "<f4").reshape(self.shape).astype(np.float64)
        if not np.isfinite(values).all():
            raise SpecError("packed array", "data", f"{self.data[:20]}...", "must be finite numbers")
        return values


def pack(values: Floats) -> dict[str, object]:
    """An array of two dimensions as a document has it."""
    data = zlib.compress(np.ascontiguousarray(values, "<f4").tobytes(), 6)
    return {"shape": list(values.shape), "data": base64.b64encode(data).decode("ascii")}
