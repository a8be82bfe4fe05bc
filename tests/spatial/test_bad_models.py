"""Models and worlds that cannot be used: the error names file and element, and what is allowed; nobody sees a traceback."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from clamber.errors import ClamberError, SpecError
from clamber.families.spatial.family import SPATIAL
from clamber.families.spatial.robot.robot import build_robot, whole_document
from clamber.families.spatial.robot.starter import import_robot
from clamber.files import Document, read_toml

LIMIT = '<limit lower="-1" upper="1" effort="5" velocity="1"/>'


def link(name: str, mass: str = "1", inertia: str = "0.01") -> str:
    terms = " ".join(f'{key}="{inertia}"' for key in ("ixx", "iyy", "izz"))
    return f'<link name="{name}"><inertial><mass value="{mass}"/><inertia {terms} ixy="0" ixz="0" iyz="0"/></inertial></link>'


def joint(name: str, parent: str, child: str, kind: str = "revolute", limit: str = LIMIT, axis: str = "0 1 0") -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="0.1 0 -0.1"/><axis xyz="{axis}"/>{limit}</joint>'
    )


def urdf(*parts: str, links: str | None = None) -> str:
    return f"<robot name='r'>{links or link('base') + link('upper') + link('lower')}{''.join(parts)}</robot>"


HIP, KNEE = joint("hip", "base", "upper"), joint("knee", "upper", "lower")
BAD = {
    "syntax": ("<robot name='r'><link name='base'>", ["model.urdf", "line 1"]),
    "empty": ("", ["model.urdf"]),
    "no text": ("\x00\x01", ["model.urdf"]),
    "no robot": ("<html><body/></html>", ["model.urdf"]),
    "negative mass": (urdf(HIP, KNEE, links=link("base") + link("upper", "-1") + link("lower")), ["model.urdf", "upper", "mass"]),
    "a mass that is no number": (
        urdf(HIP, KNEE, links=link("base") + link("upper", "heavy") + link("lower")), ["model.urdf", "mass", "heavy"]),
    "a mass without end": (urdf(HIP, KNEE, links=link("base") + link("upper", "inf") + link("lower")), ["model.urdf", "upper", "mass"]),
    "an unknown link": (urdf(HIP, joint("knee", "upper", "shin")), ["model.urdf", "knee", "shin"]),
    "no axis": (urdf(joint("hip", "base", "upper", axis="0 0 0"), KNEE), ["model.urdf", "hip", "axis"]),
    "a ring": (urdf(HIP, KNEE, joint("ring", "lower", "base")), ["model.urdf"]),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_a_model_that_cannot_be_read_or_be_is_named_with_file_and_element(name: str, tmp_path: Path) -> None:
    text, words = BAD[name]
    (tmp_path / "model.urdf").write_text(text)
    with pytest.raises(ClamberError) as refused:
        import_robot(tmp_path / "model.urdf", tmp_path / "robot.toml", "robot")
    assert [word for word in words if word not in str(refused.value)] == [], str(refused.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "<mujoco><worldbody><body name='a'><freejoint/><geom type='sphere' size='-0.1'/></body></worldbody></mujoco>",
            "size",
        ),
        ("<mujoco><worldbody><body name='a'><joint type='bend'/></body></worldbody></mujoco>", "bend|type"),
        ("<mujoco><worldbody>", "model.xml"),
    ],
)
def test_an_mjcf_file_that_cannot_be_read_is_named_with_mujocos_words(text: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "model.xml").write_text(text)
    with pytest.raises(ClamberError, match=words) as refused:
        import_robot(tmp_path / "model.xml", tmp_path / "robot.toml", "robot")
    assert "model.xml" in str(refused.value)


@pytest.mark.parametrize(
    ("joints", "looked_at"),
    [
        (
            (joint("hip", "base", "upper", "fixed"), joint("knee", "upper", "lower", "fixed")),
            ("base", "upper", "lower"),
        ),
        ((HIP, joint("tail", "base", "lower")), ("upper", "lower")),
    ],
)
def test_a_robot_without_a_limb_says_which_links_were_looked_at(
    joints: tuple[str, ...], looked_at: tuple[str, ...], tmp_path: Path
) -> None:
    (tmp_path / "model.urdf").write_text(urdf(*joints))
    with pytest.raises(ClamberError) as refused:
        import_robot(tmp_path / "model.urdf", tmp_path / "robot.toml", "robot")
    assert all(name in str(refused.value) for name in ("model.urdf", *looked_at)), str(refused.value)


def test_limits_the_wrong_way_round_are_repaired_and_told(tmp_path: Path) -> None:
    wrong = joint("hip", "base", "upper", limit='<limit lower="1" upper="-1" effort="5" velocity="1"/>')
    (tmp_path / "model.urdf").write_text(urdf(wrong, KNEE))
    found = import_robot(tmp_path / "model.urdf", tmp_path / "robot.toml", "robot")
    assert any("hip" in line and "lower limit was above the upper one" in line for line in found.repaired)


def test_a_robot_file_that_names_what_its_model_has_not_is_told_what_there_is(tmp_path: Path) -> None:
    (tmp_path / "model.urdf").write_text(urdf(HIP, KNEE))
    data = {
        "schema": "clamber-robot-1",
        "family": "spatial",
        "name": "r",
        "title": "R",
        "model": "model.urdf",
        "base": "base",
    }
    limb = {"name": "leg", "tip": "lower", "contact": "foot"}
    for changed, words in (
        ({"base": "bsae"}, "base"),
        ({"limb": [limb | {"tip": "shin"}]}, "lower"),
        ({"limb": [limb | {"limits": {"hipp": ["0 deg", "1 deg"]}}]}, "hip"),
        ({"limb": [limb | {"contact": "claw"}]}, "gripper"),
        ({"model": "other.urdf"}, "other.urdf"),
    ):
        document = Document("robot.toml", {**data, "limb": [limb], **changed}, (), tmp_path)
        with pytest.raises(ClamberError) as refused:
            build_robot(document)
        assert (words in str(refused.value) and "robot.toml" in str(refused.value)) or words == "other.urdf", str(
            refused.value
        )


def test_the_command_ends_with_one_message(
    clamber: Callable[..., tuple[int, str, str]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "model.urdf").write_text(urdf(HIP, KNEE, links=link("base") + link("upper", "-1") + link("lower")))
    for words in (("--from", "model.urdf"), ("--from", "nowhere.urdf"), ("--from", "model.txt")):
        code, out, err = clamber("new", "robot", *words, "-o", "robot.toml")
        *before, message = err.splitlines()
        assert code == 2 and out == "" and message.startswith("clamber: ") and before in ([], [f"reading {words[1]}"])
        assert not (tmp_path / "robot.toml").exists()


def change(kind: str, index: int, key: str, value: object) -> Callable[[dict[str, list[dict[str, object]]]], None]:
    """What sets a key of a part."""
    return lambda parts: parts[kind][index].update({key: value})


@pytest.mark.parametrize(
    ("key", "spoil"),
    [
        ("links.1.parent", change("links", 1, "parent", "LH_tibia")),
        ("links.0.parent", change("links", 0, "parent", "base")),
        ("links.1.parent", change("links", 1, "parent", None)),
        ("links.2.name", change("links", 2, "name", "base")),
        ("links.0.axes", change("links", 0, "axes", [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0]])),
        ("links.0.axes", change("links", 0, "axes", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]])),
        ("joints.1.name", lambda parts: parts["joints"][1].update(name=parts["joints"][0]["name"])),
        ("joints.0.axis", change("joints", 0, "axis", [0.0, 0.0, 0.0])),
        ("joints.0.link", change("joints", 0, "link", "nobody")),
        ("sites.0.link", change("sites", 0, "link", "nobody")),
        ("shapes.0.link", change("shapes", 0, "link", "nobody")),
    ],
)
def test_parts_in_a_plan_that_do_not_fit_together_are_named(
    key: str, spoil: Callable[[dict[str, list[dict[str, object]]]], None]
) -> None:
    whole = whole_document(read_toml(SPATIAL.data / "robots" / "gripper-climber.toml"))
    moved = Document("plan.json robot", json.loads(json.dumps(whole.data)))
    build_robot(moved)
    spoil(moved.data["parts"])
    with pytest.raises(SpecError) as told:
        build_robot(moved)
    assert told.value.key == key
