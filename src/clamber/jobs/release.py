"""What must be the same wherever the items of one batch run, so that they give the same numbers."""

from .. import __version__
from ..types import Json


def release() -> Json:
    """Clamber's version, and the hash of its kernels with the versions of Python, NumPy and Numba that compile them."""
    from ..compiled import kernel_hash  # loads Numba, which those who name a cluster only don't need

    return {"clamber": __version__, "kernels": kernel_hash()}


def in_words(told: Json) -> str:
    """A release as errors name it."""
    return f"Clamber {told['clamber']} with kernels {told['kernels']}"
