"""Public models of robots: the right number of limbs, and kinematics and weights as Pinocchio has them."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import chain_kinematics as ours
import numpy as np
import pinocchio as pin
import pytest

from clamber.families.spatial.robot.robot import build_robot
from clamber.files import read_toml

DOCS = Path(__file__).resolve().parents[2] / "docs"
LIMBS = {
    # four legs
    "a1.urdf": 4, "anymal_b_simple_description/robots/anymal.urdf": 4, "anymal_c_simple": 4, "b1_description/urdf/b1.": 4, "go1_desc": 4,
    "go2_desc": 4, "hyq_desc": 4, "laikago": 4, "quadruped_desc": 4, "solo.urdf": 4, "solo12": 4, "a2/a2.xml": 4, "aliengo": 4,
    "b2/": 4, "go1/": 4, "go2/": 4, "hyqreal1.xml": 4, "hyqreal2.xml": 4, "hyqreal2.urdf": 4, "mini_cheetah.urdf": 4,
    "mini_cheetah.xml": 4, "pegasus.xml": 4, "spot.xml": 4,
    # four legs and an arm; and two arms
    "anymal-kinova": 5, "b1-z1": 5, "spot_arm": 5, "centauro": 6,
    # two legs
    "bolt": 2, "lowerBodyOnly": 2,
    # two legs, two arms
    "g1_29dof_rev": 4, "g1_29dof_with_hand": 4, "human.urdf": 4, "icub.urdf": 4, "romeo.urdf": 4, "romeo_small": 4,
    "simple_humanoid.urdf": 4, "talos_full_v2.urdf": 4, "talos_reduced.urdf": 4,
    # two arms on a pedestal or on wheels; one arm
    "alex_sake": 2, "baxter": 2, "pr2": 2, "tiago_dual": 2, "tiago_pro": 2, "tiago_no_hand": 1, "ur5_robot": 1, "panda.urdf": 1,
    "xarm7": 1, "so100": 1,
}  # fmt: skip
"""Part of a model's name -> limbs that the robot has, as anybody can see."""


def robot_pages() -> ModuleType:
    spec = importlib.util.spec_from_file_location("robot_pages", DOCS / "robot_pages.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # for its dataclasses
    spec.loader.exec_module(module)
    return module


PAGES = robot_pages()
MODELS: dict[str, Path] = PAGES.models()
installed = pytest.mark.skipif(not MODELS, reason="needs the extra `models`")


def test_the_page_has_the_limbs_of_every_model_of_the_table() -> None:
    page = (DOCS / "robots.md").read_text(encoding="utf-8").splitlines()
    for part, limbs in LIMBS.items():
        rows = [line for line in page if line.startswith("| ") and part in line]
        assert rows, part
        cell = rows[0].split("|")[2]
        assert sum(int(word.split(" x ")[0]) for word in cell.split("+")) == limbs, rows[0]


@installed
@pytest.mark.long
@pytest.mark.parametrize("name", MODELS)
def test_public_models_are_imported_with_their_limbs_or_refused_with_a_reason(name: str) -> None:
    row = PAGES.row_of(name, MODELS[name])
    known = [limbs for part, limbs in LIMBS.items() if part in name]
    assert (row.found is None) == bool(row.error)
    if known:
        assert row.found is not None and len(row.found.limbs) == known[0]


@installed
@pytest.mark.long
@pytest.mark.parametrize("name", [name for name in MODELS if name.endswith(".urdf")])
def test_public_models_have_the_tips_and_weights_that_pinocchio_has(name: str, tmp_path: Path) -> None:
    found = PAGES.import_model(MODELS[name], tmp_path / "robot.toml")
    if found is None:
        return
    robot = build_robot(read_toml(tmp_path / "robot.toml"))
    chains, random = robot.chains, np.random.default_rng(1)
    model = pin.buildModelFromUrdf(str(MODELS[name]), pin.JointModelFreeFlyer())
    data, q = model.createData(), pin.neutral(model)
    held = {name: reading.value for name, reading in robot.spec.trunk.items()}
    for _ in range(3):
        positions = ours.random_positions(chains, random)
        moved = {
            joint: value
            for names, values in zip(chains.joint_names, positions, strict=True)
            for joint, value in zip(names, values, strict=True)
        }
        for joint, value in (held | moved).items():
            at = model.joints[model.getJointId(joint)]
            q[at.idx_q : at.idx_q + at.nq] = value if at.nq == 1 else (np.cos(value), np.sin(value))
        pin.framesForwardKinematics(model, data, q)
        base = data.oMf[model.getFrameId(robot.spec.base, pin.BODY)]
        gravity = np.array([1.0, -2.0, -9.0])
        model.gravity.linear = base.rotation @ gravity
        torques = pin.computeGeneralizedGravity(model, data, q)
        scale = float(np.abs(torques[6:]).max())
        for limb, of_limb in enumerate(positions):
            frame = data.oMf[model.getFrameId(robot.limbs[limb].tip, pin.BODY)]
            place = base.actInv(frame.act(np.array(robot.limbs[limb].offset)))
            np.testing.assert_allclose(ours.tip(chains, limb, of_limb)[0], place, rtol=0, atol=1e-9)
            columns = [model.joints[model.getJointId(joint)].idx_v for joint in chains.joint_names[limb]]
            theirs = torques[columns]
            np.testing.assert_allclose(
                ours.gravity_torques(chains, limb, of_limb, gravity), theirs, rtol=0, atol=1e-9 * scale
            )
