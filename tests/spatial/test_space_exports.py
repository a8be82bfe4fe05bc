"""Exports of plans of robots in space: joints and contacts as other programs read them, held against MuJoCo's kinematics and the weight."""

import csv
import json
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from clamber.families.spatial.family import SPATIAL
from clamber.families.spatial.planning.task import SpatialTask
from clamber.planning.beam import plan_beam
from clamber.tasks import load_task

assert SPATIAL.data is not None
ROBOTS = SPATIAL.data / "robots"
CASES = {"gripper-climber": "wall-gripper", "quadruped": "stones-quadruped"}


@pytest.fixture(scope="module", params=CASES, ids=list(CASES))
def exported(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[SpatialTask, Path]:
    """A short plan of a robot, saved."""
    task: Any = load_task(CASES[request.param], ["goal={ along_min = '0.12 m' }"])
    found = plan_beam(task, width=20, threads=1)
    assert found.plan is not None, found.reason
    path = tmp_path_factory.mktemp(request.param) / "plan.json"
    found.plan.save(path)
    return task, path


def export(run: Callable[..., tuple[int, str, str]], plan: Path, name: str) -> Path:
    target = plan.with_name(name)
    code, out, err = run("export", str(plan), "-o", str(target))
    assert code == 0, (out, err)
    return target


def tips_of(task: SpatialTask, stance: dict[str, Any]) -> dict[str, Any]:
    """Tips where MuJoCo has them, world frame, by limb."""
    model = mujoco.MjModel.from_xml_path(str(ROBOTS / task.robot.spec.model))
    data = mujoco.MjData(model)
    assert model.jnt_type[0] == mujoco.mjtJoint.mjJNT_FREE
    data.qpos[:3], data.qpos[3:7] = stance["position"], stance["orientation"]
    for name, value in stance["joints"].items():
        data.joint(name).qpos[0] = value
    mujoco.mj_kinematics(model, data)
    return {limb.name: np.array(data.site(limb.tip).xpos) for limb in task.robot.limbs}


def test_the_contacts_of_every_stance_are_where_mujoco_has_the_tips_and_bear_the_weight(
    clamber: Callable[..., tuple[int, str, str]], exported: tuple[SpatialTask, Path]
) -> None:
    task, plan = exported
    said = json.loads(export(clamber, plan, "plan.contacts.json").read_text())
    assert said["schema"] == "clamber-contacts-1" and said["robot"] == task.robot.name
    holds = {hold.number: np.array(hold.at) for hold in task.world.holds}
    for stance in said["stances"]:
        tips = tips_of(task, stance)
        forces = np.zeros(3)
        for limb, contact in stance["contacts"].items():
            assert tips[limb] == pytest.approx(holds[contact["hold"]], abs=2e-4)
            forces += contact["wrench"][:3]
        assert forces == pytest.approx(-said["mass"] * np.array(said["gravity"]), abs=1e-5 * said["mass"] * 9.81)
    for limb in said["limbs"]:
        own = [one for one in said["contacts"] if one["limb"] == limb["name"]]
        assert own[0]["first_stance"] == 0 and own[-1]["last_stance"] == len(said["stances"]) - 1
        for before, after in pairwise(own):
            assert after["first_stance"] == before["last_stance"] + 1 and after["hold"] != before["hold"]
        for one in own:
            middle = said["stances"][one["first_stance"]]["contacts"][limb["name"]]
            assert middle["hold"] == one["hold"] and one["place"] == pytest.approx(list(holds[one["hold"]]))


def test_the_joint_trajectory_is_that_of_the_stances_within_limits(
    clamber: Callable[..., tuple[int, str, str]], exported: tuple[SpatialTask, Path]
) -> None:
    task, plan = exported
    contacts = json.loads(export(clamber, plan, "again.contacts.json").read_text())
    message = json.loads(export(clamber, plan, "plan.trajectory.json").read_text())
    names, points = message["joint_names"], message["points"]
    assert set(names) == {name for limb in task.robot.chains.joint_names for name in limb}
    assert len(points) == len(contacts["stances"])
    chains = task.robot.chains
    bounds = {
        name: (chains.lower[limb, k], chains.upper[limb, k], chains.torque[limb, k])
        for limb, joints in enumerate(chains.joint_names)
        for k, name in enumerate(joints)
    }
    for point, stance in zip(points, contacts["stances"], strict=True):
        for name, position, effort in zip(names, point["positions"], point["effort"], strict=True):
            low, high, most = bounds[name]
            assert position == pytest.approx(stance["joints"][name], abs=1e-12)
            assert low - 1e-9 <= position <= high + 1e-9 and abs(effort) <= most * (1.0 + 1e-9)
    table = export(clamber, plan, "plan.csv").read_text().splitlines()
    rows = list(csv.reader(line for line in table if not line.startswith("#")))
    assert len(rows) == len(points) + 1 and all(any(name in title for title in rows[0]) for name in names)
