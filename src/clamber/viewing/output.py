"""Where pictures go: formats by suffix, errors that name them, files written whole."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from PIL import Image

from ..errors import ClamberError, StatedError, describe_choices, how_to_install
from ..files import write_atomically
from .style import styled

CANVASES = {".png": FigureCanvasAgg, ".svg": FigureCanvasSVG, ".pdf": FigureCanvasPdf}
"""Suffix of a still picture -> the canvas that writes it."""
DPI = 150
"""Dots per inch of still pictures."""


class SuffixError(StatedError):
    """A picture's file name says no format that can be written."""

    path: str
    allowed: tuple[str, ...]

    def __str__(self) -> str:
        suffix = Path(self.path).suffix
        shown = f"no picture can be written as '{suffix}'" if suffix else "the name has no suffix that says the format"
        return f"{self.path}: {shown}; allowed are {describe_choices(suffix, self.allowed)}"


class MissingExtraError(ClamberError):
    """A picture needs a package that is installed only with an extra."""

    def __init__(self, what: str, package: str, extra: str) -> None:
        super().__init__(what, package, extra)
        self.what, self.package, self.extra = what, package, extra

    def __str__(self) -> str:
        return (
            f"{self.what} needs the package '{self.package}', which is not installed; "
            f"{how_to_install(self.extra)}, or write .gif or .html"
        )


class StepError(StatedError):
    """A step is asked for that the replay does not have."""

    says = "step = {step}: the plan has no such step; allowed are 0 (the start) to {steps}"
    step: int
    steps: int


def check_suffix(path: str | Path, allowed: Iterable[str]) -> str:
    """The suffix of a file name, in lower case.

    Raises:
        SuffixError: If it is none of `allowed`.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in tuple(allowed):
        raise SuffixError(str(path), tuple(allowed))
    return suffix


@contextmanager
def drawing(path: str | Path, size: tuple[float, float]) -> Iterator[Figure]:
    """A `with` block that fills a figure of some size [in] in Clamber's style, which is written at its end.

    Raises:
        SuffixError: If the file's suffix names no format for still pictures; before anything is drawn.
        FileError: If the file cannot be written.
    """
    check_suffix(path, CANVASES)
    with styled():
        figure = Figure(figsize=size, layout="constrained")
        yield figure
        save_figure(figure, path)


def save_figure(figure: Figure, path: str | Path, dpi: int = DPI, colours: int | None = None) -> Path:
    """Write a figure by its suffix.

    Args:
        figure: What is drawn.
        path: A file (.png, .svg, .pdf).
        dpi: Dots per inch of a .png.
        colours: Of a .png, at most: a third of the bytes; None: as many as there are.

    Raises:
        SuffixError: If the suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    suffix = check_suffix(path, CANVASES)
    content = BytesIO()
    metadata = {".png": {"Software": "Clamber"}, ".svg": {"Date": None}, ".pdf": {"CreationDate": None}}[suffix]
    CANVASES[suffix](figure).print_figure(content, format=suffix[1:], dpi=dpi, metadata=metadata)
    written = content.getvalue()
    write_atomically(Path(path), written if colours is None or suffix != ".png" else _indexed(written, colours))
    return Path(path)


def _indexed(picture: bytes, colours: int) -> bytes:
    """The picture with a palette."""
    out = BytesIO()
    with Image.open(BytesIO(picture)) as full:
        indexed = full.convert("RGB").quantize(colours, dither=Image.Dither.NONE)
    indexed.save(out, "png", optimize=True)
    return out.getvalue()
