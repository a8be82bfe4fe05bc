"""Robots in space are drawn, shown and exported: kinematics against MuJoCo, motions between stances, pictures, the page, contacts."""

import json
from functools import cache
from pathlib import Path
from typing import Any

import mujoco as mj
import numpy as np
import pytest
from PIL import Image

from clamber.errors import SpecError
from clamber.families.spatial.pictures.camera import NAMES, camera_for
from clamber.families.spatial.pictures.moments import SWINGING, Moment
from clamber.families.spatial.pictures.space import body_meshes
from clamber.families.spatial.planning.problem import SpatialProblem
from clamber.families.spatial.planning.task import SpatialTask
from clamber.families.spatial.robot.kinematics import Posed, joint_torques, link_frames, rotation_between
from clamber.families.spatial.robot.robot import SpatialRobot
from clamber.family import family_named
from clamber.inspection.open_file import inspect_file, inspect_task
from clamber.planning.beam import plan_beam
from clamber.planning.problem.plan import Plan
from clamber.planning.problem.problem import Replay
from clamber.tasks import load_task
from clamber.tasks.robots import load_robot, robot_names
from clamber.toml_text import toml_text
from clamber.types import Floats
from clamber.viewing.alone import draw_alone, open_alone
from clamber.viewing.pictures import animate, draw_route, draw_stance, pictures_of
from clamber.viewing.recording import View

TASKS = ("wall-gripper", "stones-quadruped")
ROBOTS = robot_names("spatial")


@cache
def task(name: str) -> SpatialTask:
    loaded: Any = load_task(name, ["goal={ along_min = '0.4 m' }"])
    return loaded  # type: ignore[no-any-return]


@cache
def planned(name: str) -> Plan:
    found = plan_beam(task(name), width=30, threads=1)
    assert found.plan is not None, found.reason
    return found.plan


@cache
def carried_out(name: str) -> Replay:
    return SpatialProblem(task(name), 1, exact=True).replay(planned(name).codes(task(name)))


@cache
def view(name: str) -> View[Moment]:
    return pictures_of(task(name)).view(task(name), carried_out(name))


def turned(rng: np.random.Generator) -> Floats:
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    turn: Floats = q * np.sign(np.diag(r))
    return turn * np.linalg.det(turn)


def random_posture(robot: SpatialRobot, rng: np.random.Generator) -> Posed:
    chains = robot.chains
    return Posed(rng.normal(size=3), turned(rng), rng.uniform(chains.lower, chains.upper))


def posed_in_mujoco(robot: SpatialRobot, at: Posed) -> tuple[Any, Any]:
    """The robot's own model file with the base and the limbs' joints where a posture has them."""
    model = mj.MjModel.from_xml_path(str(robot.model_path))
    data = mj.MjData(model)
    free = int(np.flatnonzero(model.jnt_type == mj.mjtJoint.mjJNT_FREE)[0])
    where = model.jnt_qposadr[free]
    data.qpos[where : where + 3] = at.place
    mj.mju_mat2Quat(data.qpos[where + 3 : where + 7], at.turn.ravel())
    for limb, names in enumerate(robot.chains.joint_names):
        for k, name in enumerate(names):
            data.qpos[model.joint(name).qposadr[0]] = at.q[limb, k]
    mj.mj_kinematics(model, data)
    mj.mj_comPos(model, data)
    return model, data


@pytest.mark.parametrize("name", ROBOTS)
def test_joints_and_tips_are_where_mujoco_has_them(name: str) -> None:
    robot: Any = load_robot(name)
    rng = np.random.default_rng(3)
    for _ in range(5):
        at = random_posture(robot, rng)
        frames = link_frames(robot.chains, at)
        model, data = posed_in_mujoco(robot, at)
        for limb, (names, spec) in enumerate(zip(robot.chains.joint_names, robot.limbs, strict=True)):
            for k, joint in enumerate(names):
                anchor, axis = data.xanchor[model.joint(joint).id], data.xaxis[model.joint(joint).id]
                np.testing.assert_allclose(np.cross(frames.origins[limb, k] - anchor, axis), 0.0, atol=1e-9)
                np.testing.assert_allclose(frames.axes[limb, k, :, 2], axis, atol=1e-9)
            site = mj.mj_name2id(model, mj.mjtObj.mjOBJ_SITE, spec.tip)
            if site >= 0 and not any(spec.offset):
                np.testing.assert_allclose(frames.tips[limb], data.site_xpos[site], atol=1e-9)


@pytest.mark.parametrize("name", ROBOTS)
def test_torques_hold_the_weight_of_the_links_as_mujoco_weighs_them(name: str) -> None:
    """Without contacts they are MuJoCo's bias forces at rest; a force on a tip adds its Jacobian's share."""
    robot: Any = load_robot(name)
    rng = np.random.default_rng(4)
    at = random_posture(robot, rng)
    model, data = posed_in_mujoco(robot, at)
    model.opt.gravity[:] = gravity = rng.normal(size=3) * 5.0
    mj.mj_forward(model, data)
    frames = link_frames(robot.chains, at)
    limbs = len(robot.chains.limb_names)
    wrenches = rng.normal(size=(limbs, 6))
    bare = joint_torques(robot.chains, frames, np.zeros((limbs, 6)), gravity)
    loaded = joint_torques(robot.chains, frames, wrenches, gravity)
    for limb, names in enumerate(robot.chains.joint_names):
        end = model.body(model.joint(names[-1]).bodyid[0]).id
        along, about = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        mj.mj_jac(model, data, along, about, frames.tips[limb], end)
        for k, joint in enumerate(names):
            dof = model.joint(joint).dofadr[0]
            assert bare[limb, k] == pytest.approx(data.qfrc_bias[dof], abs=1e-9)
            pushed = along[:, dof] @ wrenches[limb, :3] + about[:, dof] @ wrenches[limb, 3:]
            assert bare[limb, k] - loaded[limb, k] == pytest.approx(pushed, abs=1e-9)


@pytest.mark.parametrize("name", ROBOTS)
def test_shapes_in_the_viewer_move_with_the_links(name: str) -> None:
    """Their middles are those of MuJoCo's geoms, whatever the posture."""
    robot: Any = load_robot(name)
    alone = type("Alone", (), {"robot": robot})()
    at = random_posture(robot, np.random.default_rng(5))
    frames = link_frames(robot.chains, at)
    model, data = posed_in_mujoco(robot, at)
    geoms = data.geom_xpos
    meshes = body_meshes(alone)
    assert (-1, -1) in meshes
    for (limb, k), (vertices, faces) in meshes.items():
        turn, place = (at.turn, at.place) if limb < 0 else (frames.axes[limb, k], frames.origins[limb, k])
        there = place + vertices @ turn.T
        low, high = there.min(axis=0) - 1e-6, there.max(axis=0) + 1e-6
        assert faces.max() < len(vertices)
        inside = ((geoms >= low) & (geoms <= high)).all(axis=1)
        own = model.geom_bodyid == (1 if limb < 0 else model.joint(robot.chains.joint_names[limb][k]).bodyid[0])
        assert (inside & own).any()


@pytest.mark.parametrize("name", TASKS)
def test_tips_stay_on_their_holds_while_the_body_moves_and_swing_along_the_lifted_path(name: str) -> None:
    moments, world = view(name), task(name).world
    most = lifted = 0.0
    for step in range(1, len(moments.steps)):
        (part,) = moments.motion(step)
        before, after = moments.settled(step - 1), moments.settled(step)
        for share in (0.13, 0.5, 0.77, 0.999):
            at = part.at(share, share)
            for limb, hold in enumerate(at.holds):
                if hold != SWINGING:
                    most = max(most, float(np.linalg.norm(at.tips[limb] - world.holds[hold].at)))
                    continue
                ends = np.array([world.holds[one.holds[limb]].at for one in (before, after)])
                lifted = max(lifted, float(np.linalg.norm(at.tips[limb] - ends, axis=1).min()))
        np.testing.assert_allclose(part.at(0.0, 0.0).tips, before.tips, atol=1e-3)
        np.testing.assert_allclose(part.at(0.9999, 0.9999).tips, after.tips, atol=1e-3)
    assert most < 1e-3
    assert lifted > 0.5 * task(name).rules.lift


@pytest.mark.parametrize("name", TASKS)
def test_forces_that_are_drawn_carry_the_weight_in_stances_and_while_limbs_swing(name: str) -> None:
    moments, chains = view(name), task(name).robot.chains
    weight = chains.total_mass * np.array(task(name).world.gravity)
    for step in range(1, len(moments.steps)):
        (part,) = moments.motion(step)
        for at in (part.at(0.5, 0.5), moments.settled(step)):
            np.testing.assert_allclose(at.wrenches[:, :3].sum(axis=0), -weight, atol=1e-6 * np.linalg.norm(weight))
            assert not at.wrenches[[hold == SWINGING for hold in at.holds]].any()


def test_a_rotation_halfway_is_half_the_turn() -> None:
    rng = np.random.default_rng(6)
    before, after = turned(rng), turned(rng)
    half = rotation_between(before, after, 0.5)
    np.testing.assert_allclose(half @ before.T @ half, after, atol=1e-12)
    opposite = before @ np.diag([1.0, -1.0, -1.0])
    quarter = rotation_between(before, opposite, 0.5)
    np.testing.assert_allclose(quarter @ before.T @ quarter, opposite, atol=1e-9)


@pytest.mark.parametrize("name", TASKS)
def test_cameras_see_surfaces_from_outside_and_the_robot_inside_the_picture(name: str) -> None:
    for asked in (None, *NAMES, "30,-20"):
        camera = camera_for(task(name), asked)
        np.testing.assert_allclose(camera.axes @ camera.axes.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(camera.axes) == pytest.approx(1.0)
        facing = task(name).world.normals @ camera.axes[2]
        if asked in (None, "front", "left", "right", "iso"):
            assert (facing > 0.0).mean() > 0.9
    x0, x1, y0, y1 = view(name).bounds
    flat = camera_for(task(name), None).flat(np.concatenate([view(name).settled(k).tips for k in (0, -1)]))
    assert (flat > (x0, y0)).all() and (flat < (x1, y1)).all()


@pytest.mark.parametrize("asked", ["below", "10", "10,95", "a,b", "1,2,3"])
def test_a_camera_that_is_none_is_told_what_is_one(asked: str) -> None:
    with pytest.raises(SpecError, match=r"front, left, right, above, iso.*AZIMUTH,ELEVATION"):
        pictures_of(task("wall-gripper"), asked).view(task("wall-gripper"), carried_out("wall-gripper"))


@pytest.mark.slow
@pytest.mark.parametrize("name", TASKS)
def test_stances_plans_and_motions_are_drawn(name: str, tmp_path: Path) -> None:
    replay = carried_out(name)
    few = Replay(replay.stances[:4], replay.margins[:3], replay.reasons[:3])
    draw_stance(task(name), replay, 3, tmp_path / "stance.png")
    draw_stance(task(name), replay, 3, tmp_path / "left.png", "left")
    draw_route(task(name), replay, tmp_path / "plan.png")
    animate(task(name), few, tmp_path / "plan.gif")
    assert (tmp_path / "stance.png").read_bytes() != (tmp_path / "left.png").read_bytes()
    with Image.open(tmp_path / "plan.gif") as gif:
        assert getattr(gif, "n_frames", 1) > 10
    for drawn in ("stance", "plan"):
        with Image.open(tmp_path / f"{drawn}.png") as image:
            colours = {colour for _, colour in image.convert("RGB").getcolors(1 << 24) or ()}
        assert {(0, 114, 178), (34, 48, 60)} <= colours or len(colours) > 200


@pytest.mark.parametrize("name", TASKS)
def test_contacts_and_joints_are_exported_and_tell_the_plan(clamber: Any, name: str, tmp_path: Path) -> None:
    planned(name).save(tmp_path / "plan.json")
    code, out, _ = clamber("export", str(tmp_path / "plan.json"), "-o", str(tmp_path / "plan.contacts.json"))
    assert code == 0 and "contact sequence" in out
    made = json.loads((tmp_path / "plan.contacts.json").read_text())
    replay, chains = carried_out(name), task(name).robot.chains
    assert len(made["stances"]) == len(replay.stances)
    for limb, limb_name in enumerate(chains.limb_names):
        on = [None] * len(replay.stances)
        for contact in (one for one in made["contacts"] if one["limb"] == limb_name):
            for stance in range(contact["first_stance"], contact["last_stance"] + 1):
                assert on[stance] is None
                on[stance] = contact["hold"] - 1
        assert on == replay.stances["hold"][:, limb].tolist()
    for stance, record in zip(made["stances"], replay.stances, strict=True):
        w, x, y, z = stance["orientation"]
        turn = np.zeros(9)
        mj.mju_quat2Mat(turn, np.array((w, x, y, z)))
        np.testing.assert_allclose(turn, record["turn"], atol=1e-9)
    joints = family_named("spatial").trajectories.plan(task(name), replay)
    assert joints.names == tuple(joint for limb in chains.joint_names for joint in limb)
    told = made["stances"][-1]["joints"]
    assert joints.positions[-1].tolist() == [told[joint] for joint in joints.names]


@pytest.mark.parametrize("name", [*ROBOTS, "bumpy-wall", "steel-corners", "handrails"])
def test_robots_and_worlds_are_drawn_alone_and_have_nothing_odd_that_stops_them(name: str, tmp_path: Path) -> None:
    shown = open_alone(name, "robot" if name in ROBOTS else "world")
    draw_alone(shown, tmp_path / "alone.png")
    assert (tmp_path / "alone.png").stat().st_size > 10_000
    assert shown.finding.facts["limbs" if name in ROBOTS else "holds"]
    assert not any("inside a solid" in odd or "normal" in odd for odd in shown.finding.odd)


def test_what_is_odd_about_a_world_is_named(tmp_path: Path) -> None:
    holds = [{"number": k + 1, "at": [f"{0.1 * k} m", "0 m", "0 m"], "normal": [0.0, 0.0, 1.0]} for k in range(6)]
    holds[2]["at"] = ["0.2 m", "0 m", "-0.1 m"]
    holds[3]["normal"] = [0.0, 0.0, -1.0]
    holds[5]["at"] = ["50 m", "0 m", "0 m"]
    plane = {"kind": "plane", "at": ["0 m", "0 m", "0 m"], "normal": [0.0, 0.0, 1.0]}
    guide = [{"at": ["0 m", "0 m", "0 m"], "normal": [0.0, 0.0, 1.0]}, {"at": ["1 m", "0 m", "-1 m"]}]
    said = {"schema": "clamber-world-1", "name": "odd", "holds": holds, "solids": [plane], "guide": guide}
    (tmp_path / "odd.toml").write_text(toml_text(said))
    odd = inspect_file(str(tmp_path / "odd.toml")).odd
    assert [
        word
        for word in ("hold 6 far", "hold 3 inside", "hold 4 with a normal", "guide runs")
        if not any(word in one for one in odd)
    ] == []


def test_what_is_odd_about_a_task_is_named() -> None:
    odd = inspect_task(load_task("wall-gripper", ["goal={ along_min = '9 m' }", "rules.hard=['reach']"])).odd
    for words in ("'equilibrium' only reports", "no hold is within a limb's reach of the goal"):
        assert any(words in one for one in odd)
