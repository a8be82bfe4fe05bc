"""Whether a limbed climber's task is its own mirror image about a vertical line, and which limb and hold lies opposite which."""

import math
from typing import Any, Final

import numpy as np
from scipy.spatial import cKDTree

from ....planning.problem.arrays import Params
from ....planning.problem.check import TICKS
from ....planning.problem.codes import HOLD, MOVE, RELEASE, Code, pack
from ..statics.records import LIMBS

NEAR: Final = 1e-9
"""Lengths and angles that differ by less are the same [m], [rad]."""
LIMB_FIELDS: Final = (
    "l1", "l2", "length", "half1", "half2", "limit1", "limit2", "heat1", "heat2", "c_cone", "s_cone",
    "pull", "strength",
)  # fmt: skip
"""What limbs on opposite sides have in common."""
TURNED: Final = (("c_hook", "s_hook"), ("c_centre1", "s_centre1"), ("c_centre2", "s_centre2"))
"""Cosine and sine of angles that are each other's negative there."""


def with_mirror(params: Params) -> Params:
    """The parameters with the maps that `reflect` reads; the same ones if the task is not its own mirror image."""
    record: Any = params.record
    holds: Any = params.array("holds")
    axis = 0.5 * float(holds["x"].min() + holds["x"].max())
    steps = 2.0 * (axis - float(record["x0"])) / (float(record["tick"]) * TICKS)
    angles = -2.0 * float(record["a0"]) / (float(record["tick_angle"]) * TICKS)
    if record["fences"] or record["circles"] or record["replace"] or not _whole(steps) or not _whole(angles):
        return params
    limb_image, hold_image = _limb_images(params), _hold_images(params, axis)
    if limb_image is None or hold_image is None or not _rules_agree(params, axis, limb_image, hold_image):
        return params
    full = np.arange(LIMBS, dtype=np.int32)
    full[: len(limb_image)] = limb_image
    fields = {"mirrored": 1, "mirror_x": round(steps) * TICKS, "mirror_angle": round(angles) * TICKS}
    return params.extended(fields, limb_image=full, hold_image=hold_image)


def mirrored_code(params: Params, code: int) -> int:
    """The mirror image of an action."""
    opened = Code.of(code)
    if opened.kind == "none":
        return code
    if opened.kind == "move":
        return pack(MOVE, 0, opened.argument ^ 1 if opened.argument // 2 in (0, 2) else opened.argument)
    limbs: Any = params.array("limb_image")
    holds: Any = params.array("hold_image")
    if opened.kind == "release":
        return pack(RELEASE, int(limbs[opened.limb]))
    assert opened.kind == "hold", "exact search names every hold"
    return pack(HOLD, int(limbs[opened.limb]), int(holds[opened.argument]))


def _whole(value: float) -> bool:
    return abs(value - round(value)) < 1e-6


def _limb_images(params: Params) -> Any:
    limbs: Any = params.array("limbs")
    image = np.full(len(limbs), -1, np.int32)
    for i, limb in enumerate(limbs):
        for j, other in enumerate(limbs):
            same = all(math.isclose(limb[name], other[name], rel_tol=0.0, abs_tol=NEAR) for name in LIMB_FIELDS)
            turned = all(abs(limb[c] - other[c]) < NEAR and abs(limb[s] + other[s]) < NEAR for c, s in TURNED)
            port = abs(limb["port_x"] + other["port_x"]) < NEAR and abs(limb["port_y"] - other["port_y"]) < NEAR
            aim = abs(limb["c_port"] + other["c_port"]) < NEAR and abs(limb["s_port"] - other["s_port"]) < NEAR
            if same and turned and port and aim and j not in image:
                image[i] = j
                break
        if image[i] < 0:
            return None
    return image


def _hold_images(params: Params, axis: float) -> Any:
    holds: Any = params.array("holds")
    places = np.stack([holds["x"], holds["y"]], axis=1)
    tree = cKDTree(places)
    distance, image = tree.query(np.stack([2.0 * axis - holds["x"], holds["y"]], axis=1))
    other = holds[image]
    same = [np.abs(holds[name] - other[name]) < NEAR for name in ("radius", "dir_y", "c_cone", "s_cone")]
    same += [np.abs(holds["dir_x"] + other["dir_x"]) < NEAR, (holds["strength"] == other["strength"]), distance < NEAR]
    there_and_back = np.array_equal(image[image], np.arange(len(holds)))
    return image.astype(np.int32) if there_and_back and np.all(same) else None


def _rules_agree(params: Params, axis: float, limb_image: Any, hold_image: Any) -> bool:
    """Whether moves, opposed pairs, limbs that may use a hold, and goals go over into each other."""
    record: Any = params.record
    holds: Any = params.array("holds")
    goals: Any = params.array("goals")
    n = len(limb_image)
    allowed = int(record["allowed"])
    if (allowed & 3) not in (0, 3) or (allowed >> 4 & 3) not in (0, 3):
        return False

    def images(bits: Any) -> Any:
        return sum((bits >> i & 1) << int(limb_image[i]) for i in range(n))

    opposed = [int(record["opposed"][i]) for i in range(n)]
    if any(opposed[int(limb_image[i])] != images(opposed[i]) for i in range(n)):
        return False
    if not np.array_equal(holds["limbs"][hold_image], images(holds["limbs"])):
        return False
    for goal in goals:
        wide = math.isinf(goal["x_min"]) and math.isinf(goal["x_max"])
        level = goal["a_half"] >= math.pi or abs(math.sin(goal["a_mid"])) < NEAR
        if not wide and not abs(2.0 * axis - goal["x_max"] - goal["x_min"]) < NEAR:
            return False
        if not level or goal["n_vertices"] or np.any(goal["hold"][:n] >= 0):
            return False
    return True
