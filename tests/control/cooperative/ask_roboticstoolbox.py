"""Asks roboticstoolbox for the manipulability of the chain and its gradient, into roboticstoolbox.json beside this file.

Run by hand, in an environment of its own: `pip install roboticstoolbox-python==1.5.0`, then `python ask_roboticstoolbox.py`. It brings
forty packages along (ROS tools, robot descriptions), too many for every developer's environment; its answers do not change.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

SETS: tuple[tuple[int, ...], ...] = ((), (2,), (2, 4, 5), (0, 1, 2, 3, 4, 5))
OUT, UP = 0.05, 0.15


def chain(links: tuple[float, ...], body: tuple[int, ...], pose: np.ndarray) -> Any:
    """The chain with those freedoms of the body that move; the others stay where they are."""
    from roboticstoolbox import ET, Robot

    makers = (ET.tx, ET.ty, ET.tz, ET.Rz, ET.Ry, ET.Rx)
    parts = [make() if k in body else make(pose[k]) for k, make in enumerate(makers)]
    parts += [ET.Rz(), ET.tx(OUT), ET.tz(UP)]
    for length in links:
        parts += [ET.Ry(flip=True), ET.tx(length)]
    whole = parts[0]
    for part in parts[1:]:
        whole = whole * part
    return Robot(whole)


def ask() -> list[dict[str, Any]]:
    """Random configurations, two arms, four sets of freedoms."""
    rng = np.random.default_rng(1995)
    cases = []
    for links in ((0.30, 0.30, 0.15), (0.25, 0.2), (0.2, 0.3, 0.1, 0.15)):
        for body in SETS:
            for _ in range(8):
                pose = rng.uniform(-0.6, 0.6, 6)
                joints = rng.uniform(-2.5, 2.5, len(links) + 1)
                robot = chain(links, body, pose)
                q = np.array([*pose[list(body)], *joints])
                cases.append(
                    {
                        "links": links,
                        "freedoms": [*body, *range(6, 6 + len(joints))],
                        "q": [*pose, *joints],
                        "manipulability": float(robot.manipulability(q, axes="trans")),
                        "gradient": robot.jacobm(q, axes="trans").ravel().tolist(),
                    }
                )
    return cases


if __name__ == "__main__":
    head = json.dumps({"roboticstoolbox": "1.5.0", "out": OUT, "up": UP})
    lines = ",\n".join(json.dumps(case) for case in ask())
    text = f'{head[:-1]}, "cases": [\n{lines}\n]}}\n'
    Path(__file__).with_name("roboticstoolbox.json").write_text(text, encoding="utf-8")
