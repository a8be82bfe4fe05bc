"""What an import finds, repairs, drops and refuses."""

import json
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from spatial_models import FOUR_JOINTS, LOOP, TWO_ARMS, Case, document_of, robot_of

from clamber.errors import FileError, SpecError
from clamber.families.spatial.inspection import inspect_robot
from clamber.families.spatial.robot.model import read_model
from clamber.families.spatial.robot.parts import Motors
from clamber.families.spatial.robot.robot import build_robot, whole_document
from clamber.families.spatial.robot.starter import import_robot
from clamber.files import Document, read_toml
from clamber.tasks.imported import ImportedRobot
from clamber.tasks.robots import read_robot

Clamber = Callable[..., tuple[int, str, str]]


def imported(folder: Path, text: str, name: str = "model.urdf") -> ImportedRobot:
    (folder / name).write_text(text, encoding="utf-8")
    return import_robot(folder / name, folder / "robot.toml", "robot")


def test_the_command_writes_a_robot_that_loads_and_tells_what_it_found(tmp_path: Path, clamber: Clamber) -> None:
    (tmp_path / TWO_ARMS.file).write_text(TWO_ARMS.text, encoding="utf-8")
    model, target = str(tmp_path / TWO_ARMS.file), tmp_path / "robot.toml"
    code, out, err = clamber("new", "robot", "--from", model, "-o", str(target), "--json")
    assert (code, err) == (0, "")
    told = json.loads(out)
    assert told["name"] == "robot" and told["mass_kg"] == pytest.approx(8.15)
    assert told["limbs"] == [
        {"name": "l2", "joints": ["l1", "l2"], "tip": "lhand"},
        {"name": "r2", "joints": ["r1", "r2"], "tip": "rhand"},
        {"name": "g2", "joints": ["g1", "g2"], "tip": "shin_tip"},
    ]
    assert any("joint lfinger: mimics joint l1; it is held at 0.25" in line for line in told["repaired"])
    assert any("joint r1: no limits in the model" in line for line in told["repaired"])
    assert any("collision mesh" in line and "is missing" in line for line in told["dropped"])
    document = read_robot(str(target))
    robot = build_robot(document)
    assert robot.limb_names == ("l2", "r2", "g2") and robot.model_path == target.parent / TWO_ARMS.file
    assert robot.chains.total_mass == pytest.approx(8.15)
    lines = target.read_text(encoding="utf-8").splitlines()
    for key in ("base", "trunk", "tip", "out", "contact", "nominal", "limits", "radius"):
        stated = [line for line in lines if line.startswith(f"{key} =")]
        assert stated and all("# guess: " in line for line in stated), key
    code, out, _ = clamber("new", "robot", "--from", model, "-o", str(target), "--force")
    assert code == 0 and "limb l2: l1, l2; tip lhand" in out and "repaired: " in out and "dropped: " in out


def test_the_command_refuses_what_does_not_go_together_and_files_of_other_kinds(
    tmp_path: Path, clamber: Clamber
) -> None:
    target = str(tmp_path / "robot.toml")
    code, _, err = clamber("new", "robot", "--from", "arm.sdf", "-o", target)
    assert code == 2 and "arm.sdf" in err and ".urdf, .xml, .mjcf" in err
    assert clamber("new", "robot", "--from", "a.urdf", "--limbs", "3", "-o", target)[0] == 2
    assert clamber("new", "robot", "--from", "a.urdf", "--like", "libra", "-o", target)[0] == 2
    code, _, err = clamber("new", "robot", "--from", str(tmp_path / "none.urdf"), "-o", target)
    assert code == 2 and "none.urdf" in err and not Path(target).exists()


LINK = "<link name='{}'><inertial><mass value='{}'/><inertia ixx='{}' iyy='{}' izz='{}' ixy='0' ixz='0' iyz='0'/></inertial></link>"
JOINT = "<joint name='{}' type='{}'><parent link='{}'/><child link='{}'/><origin xyz='0 0 -0.2'/><axis xyz='0 1 0'/>{}</joint>"
LIMIT = "<limit lower='-1' upper='1' effort='5' velocity='1'/>"


def leg(
    change: str = "", limit: str = LIMIT, mass: float = 1.0, inertia: tuple[float, float, float] = (0.01, 0.01, 0.01)
) -> str:
    """A base, a leg of two joints and a foot."""
    parts = [
        LINK.format("base", 2, 0.02, 0.02, 0.02),
        LINK.format("thigh", mass, *inertia),
        LINK.format("shin", 0.5, 0.005, 0.005, 0.005),
    ]
    joints = [
        JOINT.format("hip", "revolute", "base", "thigh", limit),
        JOINT.format("knee", "revolute", "thigh", "shin", limit),
    ]
    foot = "<link name='foot'/>" + JOINT.format("ankle", "fixed", "shin", "foot", "")
    return f"<robot name='leg'>{''.join(parts)}{''.join(joints)}{foot}{change}</robot>"


KNEE = ("type='revolute'><parent link='thigh'", "type='fixed'><parent link='thigh'")
REFUSED = {
    "no XML": ("<robot", "not valid XML"),
    "no model": ("<sdf/>", r"begins with <sdf>.*<robot>"),
    "xacro": ("<robot xmlns:xacro='x'><xacro:arm/></robot>", "has no <link>.*xacro"),
    "negative mass": (leg(mass=-1.0), "<link name='thigh'> has a mass of -1 kg.*0 or more"),
    "no number": (leg(limit="<limit lower='low' upper='1'/>"), "<limit lower='low'>.*must be a number"),
    "no such parent": (leg("<link name='x'/>" + JOINT.format("y", "fixed", "arm", "x", "")), "<joint name='y'> has no parent link 'arm'"),
    "two parents": (leg(JOINT.format("y", "fixed", "base", "foot", "")), "<link name='foot'> is the child of two joints"),
    "two roots": (leg("<link name='x'/>"), r"2 links without a parent \(base, x\)"),
    "the same link twice": (leg("<link name='foot'/>"), "<link name='foot'> is there twice"),
    "the same joint twice": (
        leg("<link name='x'/>" + JOINT.format("knee", "revolute", "foot", "x", LIMIT)), "<joint name='knee'> is there twice"
    ),
    "no name": (leg("<link/>"), "a <link> has no name"),
    "no limb": (f"<robot name='r'>{LINK.format('base', 1, 1, 1, 1)}</robot>", "no limb: no joint moves.*base.*two joints"),
    "one joint": (leg().replace(*KNEE), r"looked at chains to thigh \(1 joints, "),
    "an empty MJCF": ("<mujoco/>", "no body beside the world"),
    "no MJCF": ("<mujoco><worldbody><body><geom type='cube'/></body></worldbody></mujoco>", "no model that MuJoCo takes.*cube"),
    "not physical": (
        "<mujoco><worldbody><body name='b'><inertial pos='0 0 0' mass='-1' diaginertia='1 1 1'/></body></worldbody></mujoco>",
        "b.*mass",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_no_robot_is_refused_with_file_element_and_what_is_allowed(tmp_path: Path, case: str) -> None:
    text, told = REFUSED[case]
    with pytest.raises(FileError, match=f"(?s)model.urdf.*{told}"):
        imported(tmp_path, text)


def test_rotors_that_a_urdf_cannot_state_are_guessed_by_torques_and_read_as_they_are_stated(tmp_path: Path) -> None:
    found = imported(tmp_path, leg())
    assert "2 joints: no inertia of rotors in the model; guessed by their torques" in found.repaired
    (tmp_path / "robot.toml").write_text(found.text)
    robot = build_robot(read_robot(str(tmp_path / "robot.toml")))
    assert Motors.of(robot).rotor == pytest.approx([0.005, 0.005])  # of 5 N m: less would not lift 3.5 kg by the leg
    assert not any("rotors" in line for line in inspect_robot(robot).odd)

    data = read_robot(str(tmp_path / "robot.toml")).data
    stated = data["limb"][0] | {"rotors": {"knee": "20 g cm^2"}}
    other = build_robot(Document("robot", data | {"limb": [stated]}, folder=tmp_path))
    assert Motors.of(other).rotor == pytest.approx([0.0, 2e-6])
    assert any("hip: no inertia of rotors" in line for line in inspect_robot(other).odd)
    for wrong, said in (("2 kg", "joint knee turns: state"), ("0 kg m^2", "must be more than 0"), ("2 m", "rotors")):
        spoilt = data["limb"][0] | {"rotors": {"knee": wrong}}
        with pytest.raises(SpecError, match=f"rotors.*knee.*{said}|{said}"):
            build_robot(Document("robot", data | {"limb": [spoilt]}, folder=tmp_path))


def test_limits_in_degrees_where_radians_belong_are_odd(tmp_path: Path) -> None:
    found = imported(tmp_path, leg(limit="<limit lower='-90' upper='45' effort='5' velocity='1'/>"))
    (tmp_path / "robot.toml").write_text(found.text)
    odd = inspect_robot(build_robot(read_robot(str(tmp_path / "robot.toml")))).odd
    assert any("hip, knee may turn 21.5 times round; are limits in degrees" in line for line in odd)


def test_torques_of_0_and_limits_that_are_absent_are_guessed_and_marked(tmp_path: Path) -> None:
    found = imported(tmp_path, leg(limit="<limit lower='0' upper='0' effort='0' velocity='0'/>"))
    assert any("joints (hip, knee): its limits are both 0" in line for line in found.repaired)
    assert any("hip, knee: no torque limit in the model, or 0" in line for line in found.repaired)
    assert "torques = { hip = " in found.text and "limits = { hip = " in found.text
    (tmp_path / "robot.toml").write_text(found.text, encoding="utf-8")
    assert (build_robot(read_toml(tmp_path / "robot.toml")).chains.torque[0] > 1.0).all()


@pytest.mark.parametrize(
    ("inertia", "told"),
    [
        ((10.0, 10.0, 10.0), "as if of another unit"),
        ((0.01, 0.01, 0.05), "at most the sum of the others"),
        ((0.01, 0.02, 0.025), ""),
    ],
)
def test_inertias_that_no_body_of_that_size_has_are_repaired_and_told(
    tmp_path: Path, inertia: tuple[float, float, float], told: str
) -> None:
    found = imported(tmp_path, leg(inertia=inertia))
    lines = [line for line in found.repaired if line.startswith("link thigh: ")]
    assert (len(lines) == 1 and told in lines[0]) if told else not lines
    kept = np.array(read_model(tmp_path / "model.urdf").tree.link("thigh").inertia)
    assert np.linalg.eigvalsh(kept).max() <= 0.5
    if not told:
        np.testing.assert_allclose(kept, np.diag(inertia), rtol=1e-9, atol=1e-12)


def test_a_package_path_is_found_above_the_file_and_a_missing_mesh_stops_nothing(tmp_path: Path) -> None:
    mesh = tmp_path / "leg_description" / "meshes" / "foot.stl"
    mesh.parent.mkdir(parents=True)
    corners = [(0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.1, 0.0), (0.0, 0.0, -0.1)]
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
    packed = b"".join(struct.pack("<12fH", 0, 0, 0, *(x for i in face for x in corners[i]), 0) for face in faces)
    mesh.write_bytes(bytes(80) + struct.pack("<I", len(faces)) + packed)
    shape = "<collision><geometry><mesh filename='package://leg_description/meshes/{}'/></geometry></collision>"
    text = leg().replace(
        "<link name='foot'/>", f"<link name='foot'>{shape.format('foot.stl')}{shape.format('gone.stl')}</link>"
    )
    folder = tmp_path / "leg_description" / "urdf"
    folder.mkdir()
    found = imported(folder, text)
    assert [line for line in found.dropped if "gone.stl" in line] and not [
        line for line in found.dropped if "foot.stl" in line
    ]
    assert 'offset = ["0 mm", "0 mm", "-100 mm"]' in found.text
    assert any("link foot: has a shape and states no <inertial>" in line for line in found.repaired)


def test_a_closed_loop_is_cut_and_told(tmp_path: Path) -> None:
    found = imported(tmp_path, LOOP.text, LOOP.file)
    assert [limb.joints for limb in found.limbs] == [("l1", "l2"), ("r1", "r2")]
    assert any(line.startswith("closed loop five-bar: ") for line in found.dropped)


def test_a_waist_that_limbs_share_is_the_trunks_and_is_held(tmp_path: Path) -> None:
    found = imported(tmp_path, FOUR_JOINTS.text, FOUR_JOINTS.file)
    assert [limb.joints for limb in found.limbs] == [("a1", "a2", "a3"), ("b1", "b2", "b3")]
    assert 'trunk = { waist = "0 deg", c1 = "0 deg" }' in found.text
    assert any(line.startswith("chain to leg: has one joint (c1)") for line in found.dropped)


def test_a_robot_is_built_from_what_its_document_holds_where_its_model_is_not(tmp_path: Path) -> None:
    whole = whole_document(document_of(tmp_path, TWO_ARMS))
    stored = json.loads(json.dumps(whole.data))
    (tmp_path / TWO_ARMS.file).unlink()
    again, before = build_robot(Document("stored plan", stored)), build_robot(whole)
    assert again.tree == before.tree and again.model_path is None
    assert again.tree.sha256 == before.tree.sha256 != ""
    for name in ("offset", "rotation", "mass", "centre", "torque", "base_centre"):
        np.testing.assert_array_equal(getattr(again.chains, name), getattr(before.chains, name))


WRONG = {
    "base": ({"base": "chst"}, r"base = 'chst': the model has no such link.*did you mean 'chest'"),
    "trunk": ({"trunk": {"spin": "0 rad"}}, r"trunk.spin.*no such joint.*did you mean 'spine'"),
    "trunk's unit": ({"trunk": {"spine": "1 cm"}}, "trunk.spine.*turns: state an angle"),
    "model": ({"model": 3}, "model = 3: must be the path"),
    "share": ({"torque_share": 1.5}, "torque_share = 1.5"),
    "key": ({"weight": "3 N"}, "weight.*unknown key"),
}
WRONG_LIMB = {
    "tip": ({"tip": "lhnd"}, r"limb.left.tip = 'lhnd'.*no such site or link.*did you mean 'lhand'"),
    "shared": ({"tip": "chest"}, r"limb.left.tip.*no joint is this limb's alone between the base 'pelvis'"),
    "joint": ({"limits": {"r2": ["0 deg", "1 deg"]}}, r"limb.left.limits.r2.*no such joint; there are l1, l2"),
    "order": ({"limits": {"l1": ["2 deg", "1 deg"]}}, r"limb.left.limits.l1.*least position must be below"),
    "unit": ({"limits": {"l2": ["0 deg", "1 deg"]}}, r"limb.left.limits.l2.*joint l2 slides: state a length"),
    "torque": ({"torques": {"l1": "3 N"}}, r"limb.left.torques.l1.*joint l1 turns: state an angle, a torque"),
    "no torque": ({"torques": {"l1": "0 N m"}}, r"limb.left.torques.l1.*more than 0"),
    "count": ({"nominal": ["0 deg"]}, r"limb.left.nominal.*must have 2 positions, of l1, l2"),
    "nominal": ({"nominal": ["80 deg", "0 cm"]}, r"limb.left.nominal.*that of l1 must be -51.57 deg to 63.03 deg"),
    "out": ({"out": [0.0, 0.0, 0.0]}, "limb.left.out.*a direction"),
    "name": ({"name": "right"}, "limb.0.name|limb.1.name"),
    "quantity": ({"limits": {"l1": ["left", "1 deg"]}}, "limb.left.limits.l1.0 = 'left'.*a number and a unit|finite number"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_a_robot_file_that_names_what_the_model_has_not_is_refused(tmp_path: Path, case: str) -> None:
    changed, told = WRONG[case]
    with pytest.raises(SpecError, match=f"(?s)robot.toml: .*{told}"):
        build_robot(document_of(tmp_path, TWO_ARMS, **changed))


@pytest.mark.parametrize("case", WRONG_LIMB)
def test_a_limb_that_the_model_has_not_is_refused(tmp_path: Path, case: str) -> None:
    changed, told = WRONG_LIMB[case]
    limbs = TWO_ARMS.robot["limb"]
    with pytest.raises(SpecError, match=f"(?s)robot.toml: .*{told}"):
        build_robot(document_of(tmp_path, TWO_ARMS, limb=[limbs[0] | changed, *limbs[1:]]))


def test_what_the_model_does_not_state_must_stand_in_the_robot_file(tmp_path: Path) -> None:
    limb = {"name": "leg", "tip": "foot", "contact": "foot"}
    case = Case("leg.urdf", leg(limit="<limit lower='-1' upper='1'/>"), {"base": "base", "limb": [limb]})
    with pytest.raises(SpecError, match=r"limb.leg.torques.hip.*the model states no torque of this joint"):
        robot_of(tmp_path, case)
    case = Case("leg.urdf", leg(limit="<limit effort='3'/>"), case.robot)
    with pytest.raises(SpecError, match=r"limb.leg.limits.hip.*the model has no limits of this joint"):
        robot_of(tmp_path, case)


def test_contacts_are_read_by_name_or_stated_as_tables(tmp_path: Path) -> None:
    limbs = TWO_ARMS.robot["limb"]
    table = {
        "schema": "clamber-contact-1",
        "kind": "gripper",
        "name": "claw",
        "title": "Claw",
        "friction": 0.7,
        "pull": "30 N",
    }
    robot = build_robot(document_of(tmp_path, TWO_ARMS, limb=[limbs[0] | {"contact": table}, *limbs[1:]]))
    assert [contact.kind for contact in robot.contacts] == ["gripper", "gripper", "foot"]
    assert robot.contacts[0].pull == 30.0
    with pytest.raises(SpecError, match=r"limb\.0\.contact = 'fot': no contact is called 'fot'.*did you mean 'foot'"):
        build_robot(document_of(tmp_path, TWO_ARMS, limb=[limbs[0] | {"contact": "fot"}]))
    with pytest.raises(SpecError, match=r"robot.toml \[limb.left.contact\]: pull = '-3 N'"):
        build_robot(document_of(tmp_path, TWO_ARMS, limb=[limbs[0] | {"contact": table | {"pull": "-3 N"}}]))


def test_share_room_payload_and_overrides_count(tmp_path: Path) -> None:
    limbs = TWO_ARMS.robot["limb"]
    limb = limbs[0] | {"torques": {"l1": "20 N m"}, "limits": {"l2": ["-10 cm", "30 cm"]}, "radius": "3 cm"}
    changes = {"torque_share": 0.5, "joint_room": "0.1 rad", "payload": {"mass": "4 kg", "at": ["0 m", "0 m", "1 m"]}}
    plain = robot_of(tmp_path, TWO_ARMS).chains
    chains = build_robot(
        document_of(tmp_path, TWO_ARMS, limb=[limb, *limbs[1:]], half=["1 m", "2 m", "3 m"], **changes)
    ).chains
    np.testing.assert_allclose(chains.torque[0], [10.0, 3.5])
    np.testing.assert_allclose([chains.lower[0], chains.upper[0]], [[-0.8, -0.1], [1.0, 0.3]])
    np.testing.assert_allclose(chains.radius[0], 0.03)
    np.testing.assert_allclose(chains.base_half, [1.0, 2.0, 3.0])
    assert chains.base_mass == pytest.approx(plain.base_mass + 4.0)
    moment = plain.base_mass * plain.base_centre + [0.0, 0.0, 4.0]
    np.testing.assert_allclose(chains.base_centre, moment / chains.base_mass)
