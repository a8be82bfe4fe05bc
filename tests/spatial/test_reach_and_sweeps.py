"""Maps of what a robot in space can reach, and sweeps over keys of its robot and its world, as commands give them."""

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from PIL import Image

Run = Callable[..., tuple[int, str, str]]
SMALL = (
    "world.patterns.0.along=['-0.24 m','0.24 m']", "world.patterns.0.across=['-0.24 m','0.24 m']", "world.patterns.0.spacing=120mm",
    "world.patterns.0.jitter=0mm", "step.heights=0", "step.angle=180 deg", "step.nearest=2", "step.length=60 mm", "goal.along_min=0.1m",
)  # fmt: skip
"""A wall of 25 holds and a coarse lattice: 4958 stances."""


def said(*overrides: str) -> list[str]:
    return [word for text in overrides for word in ("--set", text)]


@pytest.mark.slow
def test_a_map_is_complete_and_tells_which_limbs_get_to_which_holds(clamber: Run, tmp_path: Path) -> None:
    picture = tmp_path / "map.png"
    code, out, err = clamber("reach", "wall-gripper", *said(*SMALL), "--json", "-o", str(picture), "--layer", "steps")
    assert code == 0, err
    found = json.loads(out)
    assert found["status"] == "complete" and found["goal_reached"]
    assert len(found["holds"]) == 25 and found["never_used"] == []
    limbs = {limb for hold in found["holds"] for limb in hold["limbs"]}
    assert limbs == {"LF", "LH", "RH", "RF"}
    start = min(found["holds"], key=lambda hold: hold["first_step"])
    assert start["first_step"] == 0
    with Image.open(picture) as image:
        assert image.width > 400
    code, told, _ = clamber("reach", "wall-gripper", *said(*SMALL))
    assert code == 0 and "of each limb: LF 1" in told and "along" in told and "[cm]" in told
    shares = [int(re.findall(rf"{place} +(\d+) %", told)[0]) for place in ("hardest place", "middle", "easiest place")]
    assert 0 < shares[0] < shares[1] < shares[2] < 100


@pytest.mark.slow
def test_a_limb_that_a_joint_limit_holds_back_gets_to_fewer_holds(clamber: Run) -> None:
    def used(*more: str) -> int:
        code, out, err = clamber("reach", "wall-gripper", *said(*SMALL, *more), "--json")
        assert code == 0, err
        return sum(len(hold["limbs"]) for hold in json.loads(out)["holds"])

    assert used("robot.joint_room=20 deg") < used()


@pytest.mark.slow
@pytest.mark.parametrize("key", ["robot.torque_share=0.3..0.9:2", "world.patterns.0.spacing=80mm..120mm:2"])
def test_a_sweep_varies_a_key_of_the_robot_or_of_the_world(clamber: Run, tmp_path: Path, key: str) -> None:
    picture = tmp_path / "sweep.png"
    words = ("--planner", "beam", "--vary", key, *said("goal.along_min=0.1m"), "--workers", "1")
    code, out, err = clamber("sweep", "wall-gripper", *words, "-o", str(picture), "--json", "-q")
    assert code == 0, err
    points = json.loads(out)["points"]
    assert [point["status"] for point in points] == ["found", "found"]
    assert picture.stat().st_size > 10_000
