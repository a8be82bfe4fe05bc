"""A run in three dimensions in its MCAP log: frames that move and shapes that lie in them, as Foxglove's 3D panel plays them.

Messages are JSON under Foxglove's schemas `FrameTransforms` and `SceneUpdate` (docs.foxglove.dev, message schemas), on channels of their
own. Shapes are told once, locked to their frames; what moves is told by the frames alone.
"""

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np

from ..types import Floats, Json

WORLD: Final = "world"
"""Frame in which the others stand: x, y level, z up."""
TRANSFORMS: Final = "frames"
"""Channel of the frames."""
SCENE: Final = "scene"
"""Channel of the shapes."""
FOXGLOVE: Final = "foxglove."
"""First part of the names of the schemas; their messages are no table of numbers."""
EVERY: Final = 0.04
"""Least time between two messages of frames [s]: as many as a screen shows of it, for a file half as large again."""
Turn = tuple[float, float, float, float]
"""Quaternion x, y, z, w [-]."""
STILL: Final[Turn] = (0.0, 0.0, 0.0, 1.0)
HOLD: Final = "#8A8F98"
BODY: Final = "#9FADBA"
LIMBS: Final = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#6A3D9A", "#7F6A00")
"""Colours of limbs, in their order."""


@dataclass(frozen=True, slots=True)
class Frame:
    """Where a frame is in another one."""

    name: str
    parent: str
    at: Sequence[float] | Floats
    """Its origin [m], shape (3,)."""
    turn: Turn = STILL


@dataclass(frozen=True, slots=True)
class Shape:
    """A solid that lies still in a frame."""

    kind: Literal["cubes", "spheres", "cylinders"]
    """As Foxglove calls it; a cylinder stands along its z."""
    at: Sequence[float] | Floats
    """Its middle in the frame [m], shape (3,)."""
    size: Sequence[float] | Floats
    """Along its axes [m], shape (3,)."""
    colour: str
    """As "#rrggbb" or "#rrggbbaa"."""
    turn: Turn = STILL


@dataclass(frozen=True, slots=True)
class LoggedScene:
    """A world and a robot in it."""

    shapes: Mapping[str, Sequence[Shape]]
    """Frame -> what lies in it."""
    frames: Callable[[Floats], Sequence[Frame]]
    """Of a sample, in the order of the log's columns."""


def ball(radius: float, colour: str, at: Sequence[float] | Floats = (0.0, 0.0, 0.0)) -> Shape:
    """A sphere about a place in a frame [m], shape (3,)."""
    return Shape("spheres", at, (2 * radius,) * 3, colour)


def rod(start: Floats, end: Floats, radius: float, colour: str) -> Shape:
    """A cylinder between two places in a frame [m], shape (3,) each."""
    way = end - start
    length = float(np.linalg.norm(way))
    turn = np.array((-way[1], way[0], 0.0, length + way[2]))  # half way from z to the direction
    size = float(np.linalg.norm(turn))
    x, y, z, w = turn / size if size > 1e-9 * length else (1.0, 0.0, 0.0, 0.0)
    return Shape("cylinders", 0.5 * (start + end), (2 * radius, 2 * radius, length), colour, (x, y, z, w))


def turn_of(axes: Floats) -> Turn:
    """Quaternion x, y, z, w of axes as columns, shape (3, 3)."""
    # the largest of the four squares is at least a quarter, so that nothing is divided by little (Shepperd, J. Guid. Control 1, 1978)
    diagonal = np.diag(axes)
    squares = 0.25 * np.append(1.0 + 2.0 * diagonal - diagonal.sum(), 1.0 + diagonal.sum())
    k = int(np.argmax(squares))
    big = math.sqrt(squares[k])
    cross = np.array((axes[2, 1] - axes[1, 2], axes[0, 2] - axes[2, 0], axes[1, 0] - axes[0, 1])) / (4.0 * big)
    if k == 3:
        return float(cross[0]), float(cross[1]), float(cross[2]), big
    row = (axes[k] + axes[:, k]) / (4.0 * big)
    row[k] = big
    return float(row[0]), float(row[1]), float(row[2]), float(cross[k])


class SceneWriter:
    """Writes a scene into an MCAP file, beside the samples.

    Args:
        writer: Of the file, before its first message.
        scene: What is told.
    """

    def __init__(self, writer: Any, scene: LoggedScene) -> None:
        self._writer, self._scene = writer, scene
        self._channels = {
            topic: writer.register_channel(
                topic, "json", writer.register_schema(f"{FOXGLOVE}{name}", "jsonschema", json.dumps(schema).encode())
            )
            for topic, name, schema in ((TRANSFORMS, "FrameTransforms", _FRAMES), (SCENE, "SceneUpdate", _UPDATE))
        }
        self._next, self._told = -math.inf, 0

    def add(self, row: Floats, stamp: int) -> None:
        """Take a sample, shape (columns,), of a time [ns]; with the first one the shapes are told."""
        time = stamp * 1e-9
        if time < self._next:
            return
        when = {"sec": stamp // 10**9, "nsec": stamp % 10**9}
        if self._told == 0:
            entities = [_entity(frame, shapes, when) for frame, shapes in self._scene.shapes.items()]
            self._send(SCENE, {"deletions": [], "entities": entities}, stamp)
        frames = [
            {
                "timestamp": when, "parent_frame_id": frame.parent, "child_frame_id": frame.name,
                "translation": _vector(frame.at), "rotation": _vector(frame.turn),
            }
            for frame in self._scene.frames(row)
        ]  # fmt: skip
        self._send(TRANSFORMS, {"transforms": frames}, stamp)
        self._next = time + EVERY - 1e-9

    def _send(self, topic: str, message: Json, stamp: int) -> None:
        self._writer.add_message(self._channels[topic], stamp, json.dumps(message).encode(), stamp, self._told)
        self._told += 1


def _vector(values: Sequence[float] | Floats) -> Json:
    return {name: float(value) for name, value in zip("xyzw", values, strict=False)}


def _entity(frame: str, shapes: Sequence[Shape], when: Json) -> Json:
    made: Json = {
        "timestamp": when, "frame_id": frame, "id": frame, "lifetime": {"sec": 0, "nsec": 0}, "frame_locked": True,
        "metadata": [], "arrows": [], "cubes": [], "spheres": [], "cylinders": [], "lines": [], "triangles": [], "texts": [],
        "models": [],
    }  # fmt: skip
    for shape in shapes:
        red, green, blue, *alpha = (int(shape.colour[k : k + 2], 16) / 255.0 for k in range(1, len(shape.colour), 2))
        ends = {"bottom_scale": 1.0, "top_scale": 1.0} if shape.kind == "cylinders" else {}
        made[shape.kind].append(
            {
                "pose": {"position": _vector(shape.at), "orientation": _vector(shape.turn)},
                "size": _vector(shape.size),
                "color": {"r": red, "g": green, "b": blue, "a": alpha[0] if alpha else 1.0},
                **ends,
            }
        )
    return made


def _object(**fields: Json) -> Json:
    return {"type": "object", "properties": fields}


def _list(of: Json) -> Json:
    return {"type": "array", "items": of}


_NUMBER: Final[Json] = {"type": "number"}
_TEXT: Final[Json] = {"type": "string"}
_TIME: Final = _object(sec={"type": "integer"}, nsec={"type": "integer"})
_PLACE: Final = _object(x=_NUMBER, y=_NUMBER, z=_NUMBER)
_TURN: Final = _object(x=_NUMBER, y=_NUMBER, z=_NUMBER, w=_NUMBER)
_SOLID: Final[Json] = {
    "pose": _object(position=_PLACE, orientation=_TURN),
    "size": _PLACE,
    "color": _object(r=_NUMBER, g=_NUMBER, b=_NUMBER, a=_NUMBER),
}
_FRAMES: Final = {"title": "foxglove.FrameTransforms"} | _object(
    transforms=_list(
        _object(timestamp=_TIME, parent_frame_id=_TEXT, child_frame_id=_TEXT, translation=_PLACE, rotation=_TURN)
    )
)
_UPDATE: Final = {"title": "foxglove.SceneUpdate"} | _object(
    deletions=_list(_object(timestamp=_TIME, type={"type": "integer"}, id=_TEXT)),
    entities=_list(
        _object(
            timestamp=_TIME, frame_id=_TEXT, id=_TEXT, lifetime=_TIME, frame_locked={"type": "boolean"},
            metadata=_list(_object(key=_TEXT, value=_TEXT)), cubes=_list(_object(**_SOLID)), spheres=_list(_object(**_SOLID)),
            cylinders=_list(_object(**_SOLID, bottom_scale=_NUMBER, top_scale=_NUMBER)),
            **{name: _list(_object()) for name in ("arrows", "lines", "triangles", "texts", "models")},
        )
    ),
)  # fmt: skip
