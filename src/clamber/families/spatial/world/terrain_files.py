"""Terrain from files: height maps from PNG, NPY and CSV, meshes from STL, OBJ and PLY, point clouds from CSV, NPY and PLY."""

import io
import math
import warnings
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from ....errors import FileError, how_to_install
from ....files import csv_rows
from ....regular_files import read_bytes
from ....types import Floats
from ....units import UNITS, split_title

Long = npt.NDArray[np.int64]
MOST_BYTES: Final = 64 * 1024 * 1024
"""Largest file that is read [bytes]: what is kept of one is far smaller, and reading takes ten times as much memory."""
MOST_HEIGHTS: Final = 600 * 600
"""Values of a height map: plans keep their worlds, and files of more than 8 MiB are not read."""
MOST_TRIANGLES: Final = 60_000
"""Of a mesh, for the same reason."""
MOST_POINTS: Final = 200_000
"""Of a cloud, for the same reason."""
LEAST_POINTS: Final = 12
WHITE: Final = {"I;16": 65535.0, "I;16B": 65535.0, "I": 65535.0, "L": 255.0}
"""Mode of a picture in shades of grey -> its white."""
HEIGHTS, MESHES, POINTS = (".png", ".npy", ".csv"), (".stl", ".obj", ".ply"), (".csv", ".npy", ".ply")
"""Ends of the names of files of each kind."""


def read_heights(path: Path) -> Floats:
    """Values of a height map, its first row at the far side as in a picture, shape (rows, columns): of a PNG from 0, black, to 1, white.

    Raises:
        FileError: If the file is none, or is too large; the error says what is allowed.
    """
    read = {".png": _png, ".npy": _npy, ".csv": _grid}.get(path.suffix.lower())
    if read is None:
        raise FileError(str(path), "is no height map", f"names end in {', '.join(HEIGHTS)}")
    values = read(path)
    if values.ndim != 2 or min(values.shape) < 2:
        raise FileError(
            str(path), f"has values of shape {values.shape}", "a height map has two rows and columns or more"
        )
    if values.size > MOST_HEIGHTS:
        problem = f"has {values.shape[0]} x {values.shape[1]} values"
        raise FileError(
            str(path), problem, f"at most {MOST_HEIGHTS} are kept, as plans have their worlds with them; resample it"
        )
    bad = np.argwhere(~_are_kept(values))
    if len(bad):
        row, column = bad[0].tolist()
        raise FileError(str(path), f"has no finite value in row {row + 1}, column {column + 1}", "fill the gaps")
    return values


def _png(path: Path) -> Floats:
    from PIL import Image, UnidentifiedImageError

    content = read_bytes(path, MOST_BYTES)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of bombs: sizes are looked at below, before anything is unpacked
            picture = Image.open(io.BytesIO(content), formats=("PNG",))
        if picture.mode not in WHITE:
            allowed = "save it in shades of grey, of 16 bits or 8, without colour or transparency"
            raise FileError(str(path), f"is a picture of mode {picture.mode}", allowed)
        if picture.width * picture.height > MOST_HEIGHTS:
            return np.zeros((picture.height, picture.width))  # too many, as the caller says
        return np.asarray(picture, np.float64) / WHITE[picture.mode]
    except (UnidentifiedImageError, OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        raise FileError(str(path), f"is no PNG that can be read ({error})", "save it anew") from None


def _npy(path: Path) -> Floats:
    """An array of numbers; objects, which NumPy would unpickle, are refused."""
    content = io.BytesIO(read_bytes(path, MOST_BYTES))
    try:
        values = np.load(content, allow_pickle=False)
        if not isinstance(values, np.ndarray) or values.dtype.kind not in "fiu":
            raise ValueError("it has no plain numbers")
    except (ValueError, OSError, EOFError, SyntaxError) as error:
        raise FileError(
            str(path), f"is no array that can be read ({_line(error)})", "save numbers by numpy.save"
        ) from None
    return values.astype(np.float64)


def _are_kept(values: Floats) -> npt.NDArray[np.bool_]:
    """Which values are finite as the 32-bit floats that they are kept as."""
    kept: npt.NDArray[np.bool_] = np.abs(values) <= np.finfo(np.float32).max
    return kept


def _line(error: Exception) -> str:
    return str(error).split("\n")[0][:160]


def _rows(path: Path) -> list[tuple[int, list[str]]]:
    """Those of a table."""
    try:
        text = read_bytes(path, MOST_BYTES).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise FileError(str(path), f"is not UTF-8 (byte {error.start})", "save it as UTF-8 text") from None
    rows = table_rows(text, str(path))
    if not rows:
        raise FileError(str(path), "is empty", "state a row a line")
    return rows


def table_rows(text: str, name: str) -> list[tuple[int, list[str]]]:
    """Rows of a CSV text with their lines, cells without blanks around them; no empty rows and no comments."""
    return [
        (line, [cell.strip() for cell in row])
        for line, row in csv_rows(text, name)
        if any(cell.strip() for cell in row) and not row[0].lstrip().startswith("#")
    ]


def _numbers(path: Path, line: int, cells: list[str], count: int, most: int) -> list[float]:
    """The first values of a row that has `count` to `most` cells: with more of them, some stand in columns that are not theirs."""
    if not count <= len(cells) <= most:
        raise FileError(f"{path}:{line}", f"has {len(cells)} values", f"every row has {most}, as the first")
    cells = cells[:count]
    wrong = next((cell for cell in cells if not _is_number(cell)), None)
    if wrong is not None:
        raise FileError(f"{path}:{line}", f"has {wrong!r}", "values are numbers without a unit")
    return [float(cell) for cell in cells]


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return "_" not in cell


def _grid(path: Path) -> Floats:
    rows = _rows(path)
    count = len(rows[0][1])
    return np.array([_numbers(path, line, cells, count, count) for line, cells in rows])


def read_points(path: Path) -> tuple[Floats, float | None]:
    """Places of a cloud, shape (n, 3), and the size of their unit where the file names one [m].

    Raises:
        FileError: If the file is none, or is too large; the error says what is allowed.
    """
    suffix, unit = path.suffix.lower(), None
    if suffix == ".csv":
        points, unit = _table(path)
    elif suffix == ".npy":
        points = _npy(path)
    elif suffix == ".ply":
        points = np.asarray(_trimesh(path).vertices, np.float64)
    else:
        raise FileError(str(path), "is no cloud of points", f"names end in {', '.join(POINTS)}")
    if points.ndim != 2 or points.shape[1] != 3:
        raise FileError(str(path), f"has values of shape {points.shape}", "points are rows of x, y, z")
    if not LEAST_POINTS <= len(points) <= MOST_POINTS:
        allowed = f"{LEAST_POINTS} to {MOST_POINTS} are kept, as plans have their worlds with them; thin it out"
        raise FileError(str(path), f"has {len(points)} points", allowed)
    bad = np.flatnonzero(~_are_kept(points).all(axis=1))
    if len(bad):
        raise FileError(str(path), f"point {bad[0] + 1} is not finite", "leave such points out")
    return points, unit


def _table(path: Path) -> tuple[Floats, float | None]:
    """Points of a CSV file with a header, such as `x [mm],y [mm],z [mm]`; without units they count in the terrain's."""
    rows = _rows(path)
    line, header = rows[0]
    titles = [split_title(title) for title in header]
    names = [name.lower() for name, _ in titles]
    if names[:3] != ["x", "y", "z"]:
        raise FileError(
            f"{path}:{line}", f"begins with {', '.join(header[:3])}", "the header is x, y, z, such as 'x [mm]'"
        )
    units = {unit for _, unit in titles[:3]}
    if len(units) > 1 or not units <= {None, "", *UNITS["length"]}:
        raise FileError(
            f"{path}:{line}", "has no unit that x, y and z share", f"units are {', '.join(UNITS['length'])}"
        )
    unit = units.pop()
    points = np.array([_numbers(path, at, cells, 3, len(header)) for at, cells in rows[1:]]).reshape(-1, 3)
    return points, UNITS["length"][unit] if unit else None


def read_mesh(path: Path) -> tuple[Floats, Long]:
    """Vertices, shape (n, 3), and triangles that turn anticlockwise seen from outside, shape (m, 3).

    Raises:
        FileError: If the file is none, is too large, or the extra `terrain` is missing.
    """
    if path.suffix.lower() not in MESHES:
        raise FileError(str(path), "is no mesh", f"names end in {', '.join(MESHES)}")
    mesh = _trimesh(path)
    vertices, faces = (
        np.asarray(mesh.vertices, np.float64),
        np.asarray(getattr(mesh, "faces", ()), np.int64).reshape(-1, 3),
    )
    if not len(faces):
        raise FileError(str(path), "has no triangles", "name a mesh of a surface")
    if len(faces) > MOST_TRIANGLES:
        allowed = f"at most {MOST_TRIANGLES} are kept, as plans have their worlds with them; simplify it"
        raise FileError(str(path), f"has {len(faces)} triangles", allowed)
    bad = np.flatnonzero(~_are_kept(vertices).all(axis=1))
    if len(bad):
        raise FileError(str(path), f"vertex {bad[0] + 1} is not finite", "move it")
    return vertices, faces


def _trimesh(path: Path) -> Any:
    """What trimesh reads of a file, one mesh or cloud."""
    content = read_bytes(path, MOST_BYTES)
    try:
        import trimesh
    except ImportError:
        told = f"install trimesh: {how_to_install('terrain')}"
        raise FileError(str(path), "cannot be read without trimesh", told) from None
    try:
        loaded: Any = trimesh.load(io.BytesIO(content), file_type=path.suffix.lower()[1:], skip_materials=True)
        if isinstance(loaded, trimesh.Scene):
            loaded = loaded.to_mesh()
        if not hasattr(loaded, "vertices") or not math.prod(np.shape(loaded.vertices)):
            raise ValueError("it has no vertices")
    except Exception as error:  # its readers raise what their libraries do, of any class
        problem = f"is no {path.suffix.lower()[1:].upper()} that can be read ({_line(error) or type(error).__name__})"
        raise FileError(str(path), problem, "export it anew") from None
    return loaded
