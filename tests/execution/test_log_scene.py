"""Logs in three dimensions: frames that compose to where the simulated robots truly are, and shapes that lie in known frames."""

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from jsonschema import validate
from mcap.reader import make_reader
from scipy.spatial.transform import Rotation

import clamber
from clamber.execution.log_files import read_log
from clamber.execution.log_scene import rod, turn_of
from clamber.execution.sample_log import columns_of
from clamber.families.climber.execution.climb_scene import climb_scene
from clamber.families.climber.execution.climb_trace import ClimbTrace, TracedClimber
from clamber.families.climber.execution.executable_plan import climbable
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.trials.run_plan import run_plan
from clamber.families.spatial.execution.run_trace import Named
from clamber.families.spatial.execution.space_scene import space_scene
from clamber.families.spatial.robot.kinematics import Posed, link_frames
from clamber.families.walker.execution.walk_trace import LEG_NAMES, TracedWalker, WalkTrace
from clamber.planning.problem.plan import Plan
from clamber.sim.limb_flaws import LimbFlaws
from clamber.types import Floats

RUNG = (106, 301, 205, 300)
"""The first grab of the thesis's gait."""


def messages(path: Path) -> dict[str, list[tuple[float, Any]]]:
    """Topic -> times [s] and messages, each held against the schema that the file has of it."""
    found: dict[str, list[tuple[float, Any]]] = {}
    for schema, channel, message in make_reader(io.BytesIO(path.read_bytes())).iter_messages():
        assert schema is not None and channel.message_encoding == "json" and schema.encoding == "jsonschema"
        data = json.loads(message.data)
        if schema.name.startswith("foxglove."):
            assert schema.name == {"frames": "foxglove.FrameTransforms", "scene": "foxglove.SceneUpdate"}[channel.topic]
            validate(data, json.loads(schema.data))
        found.setdefault(channel.topic, []).append((message.log_time * 1e-9, data))
    return found


def place(frames: list[Any], name: str) -> Floats:
    """Where the origin of a frame is in the world, by going up from it [m]."""
    known, at = {frame["child_frame_id"]: frame for frame in frames}, np.zeros(3)
    while name != "world":
        frame = known[name]
        turn, shift = (np.array(list(frame[part].values())) for part in ("rotation", "translation"))
        at, name = shift + Rotation.from_quat(turn).apply(at), frame["parent_frame_id"]
    return at


def check_shapes(found: dict[str, list[tuple[float, Any]]]) -> None:
    """Shapes are told once, before anything moves, and each lies in a frame that is told ever after."""
    ((time, update),) = found["scene"]
    assert time == found["frames"][0][0] and len(update["entities"]) > 3
    for _, data in found["frames"]:
        told = {"world", *(frame["child_frame_id"] for frame in data["transforms"])}
        assert {entity["frame_id"] for entity in update["entities"]} <= told
    assert all(entity["frame_locked"] for entity in update["entities"])


@pytest.mark.slow
def test_a_climbs_frames_compose_to_the_tips_of_the_simulation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tips: dict[float, Floats] = {}
    before = TracedClimber.sample

    def sample(self: TracedClimber) -> Floats:
        if self.truth is not None:  # as it is before the kernels are compiled
            tips[round(self.time, 6)] = self.truth().tips.copy()
        return before(self)

    monkeypatch.setattr(TracedClimber, "sample", sample)
    task = climbable(clamber.load_task("ladder"))
    plan = Plan.of_codes(task, [thesis_code(task, code) for code in RUNG])
    run = run_plan(task, plan, LimbFlaws(backlash=0.02), log=tmp_path / "climb.mcap", force=True)
    found = messages(tmp_path / "climb.mcap")
    check_shapes(found)
    assert len(found["frames"]) > 20 and len(tips) > 100
    off = []
    for time, data in found["frames"]:
        told = np.array([place(data["transforms"], f"{limb} tip") for limb in task.robot.limb_names])
        off.append(np.linalg.norm(told[:, [0, 2]] - tips[round(time, 6)], axis=1).max())
        assert told[:, 1] == pytest.approx(0.0, abs=1e-12)
    # MuJoCo's sites are where they were before the last step of 1 ms, its joints where they are after it
    assert np.median(off) < 5e-5 and max(off) < 3e-4
    log = read_log(tmp_path / "climb.mcap")  # the samples are still the one table
    assert len(ClimbTrace.from_log(log).time) == len(run.trace.time)
    clamber.draw(run, tmp_path / "again.mcap")
    assert messages(tmp_path / "again.mcap")["frames"] == found["frames"]


@pytest.mark.slow
def test_a_walks_frames_compose_to_the_soles_of_the_simulation(tmp_path: Path) -> None:
    walk = clamber.load_walk("slope-walk", ["way.0.distance=0.05m"])
    run = clamber.run(walk, log=tmp_path / "walk.mcap")
    found = messages(tmp_path / "walk.mcap")
    check_shapes(found)
    trace = WalkTrace.from_log(read_log(tmp_path / "walk.mcap"))
    assert trace.true_feet is not None and isinstance(run.trace, WalkTrace)
    for time, data in found["frames"]:
        row = int(np.argmin(abs(trace.time - time)))
        for k, name in enumerate(LEG_NAMES):
            assert place(data["transforms"], f"{name} sole") == pytest.approx(trace.true_feet[row, k], abs=1e-9)
    assert TracedWalker.sample is not None and len(found["frames"]) > 20


def test_without_truth_a_climb_is_shown_as_it_is_believed() -> None:
    task = clamber.load_task("ladder")
    limbs = len(task.robot.limbs)
    row = np.zeros(2 + 3 + 3 + 2 * limbs + 2 * limbs + 2 * limbs)
    row[2:5] = 0.3, 0.4, 0.5 * np.pi
    frames = {frame.name: frame for frame in climb_scene(task, true=False).frames(row)}
    assert tuple(frames["body"].at) == (0.3, 0.0, 0.4)
    up = Rotation.from_quat(frames["body"].turn).apply((1.0, 0.0, 0.0))
    assert up == pytest.approx((0.0, 0.0, 1.0), abs=1e-12)


@pytest.mark.parametrize("name", ["wall-gripper", "stones-quadruped"])
def test_frames_of_a_robot_in_space_compose_to_its_tips(name: str) -> None:
    task: Any = clamber.load_task(name)
    chains, rng = task.robot.chains, np.random.default_rng(1)
    joints = rng.uniform(-1.0, 1.0, chains.lower.shape)
    turn = Rotation.from_rotvec(rng.normal(size=3))
    tips = link_frames(chains, Posed(np.array((0.3, -0.2, 0.5)), turn.as_matrix(), joints)).tips
    x, y, z, w = turn.as_quat()
    told = [joints[limb, k] for limb in range(len(chains.limb_names)) for k in range(int(chains.n_joints[limb]))]
    titles = Named.of(chains).titles(true=False)
    row = np.zeros(sum(map(len, titles.values())))
    row[columns_of(titles)["believed"]] = 0.3, -0.2, 0.5, w, x, y, z
    row[columns_of(titles)["joints"]] = told
    scene = space_scene(task, true=False)
    frames = [
        {
            "parent_frame_id": frame.parent, "child_frame_id": frame.name,
            "translation": dict(enumerate(frame.at)), "rotation": dict(enumerate(frame.turn)),
        }
        for frame in scene.frames(row)
    ]  # fmt: skip
    for limb, tip in zip(chains.limb_names, tips, strict=True):
        assert place(frames, f"{limb} tip") == pytest.approx(tip, abs=1e-9)
    assert set(scene.shapes) == {"world", *(frame["child_frame_id"] for frame in frames)}


@pytest.mark.parametrize("seed", range(20))
def test_turns_are_those_of_their_axes(seed: int) -> None:
    rng = np.random.default_rng(seed)
    turn = Rotation.from_rotvec(rng.normal(size=3) * (np.pi if seed % 2 else 1e-3))
    assert Rotation.from_quat(turn_of(turn.as_matrix())).as_matrix() == pytest.approx(turn.as_matrix(), abs=1e-12)
    start, end = rng.normal(size=(2, 3)) if seed else np.array(((0.0, 0.0, 0.0), (0.0, 0.0, -2.0)))
    made = rod(start, end, 0.1, "#000000")
    half = Rotation.from_quat(made.turn).apply((0.0, 0.0, 0.5 * made.size[2]))
    assert np.array(made.at) + half == pytest.approx(end, abs=1e-9)
