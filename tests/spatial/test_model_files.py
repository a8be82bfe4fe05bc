"""Files that a model names: pipes, devices and files without an end are refused by name, and reach no reader that would wait for them."""

import os
from pathlib import Path

import pytest

from clamber.errors import ClamberError
from clamber.families.spatial.robot.model_files import MOST_MESH
from clamber.families.spatial.robot.starter import import_robot

PARTS = {
    "mesh": ("", "<mesh name='m' file='{}'/>", "<geom type='mesh' mesh='m'/>", "."),
    "mesh in meshdir": ("<compiler meshdir='parts'/>", "<mesh name='m' file='{}'/>", "<geom type='mesh' mesh='m'/>", "parts"),
    "height field": ("", "<hfield name='g' file='{}' size='1 1 1 1'/>", "", "."),
    "texture": ("", "<texture name='x' type='2d' file='{}'/>", "", "."),
    "cube": ("", "<texture name='x' type='cube' fileright='{}'/>", "", "."),
    "skin": ("", "<skin name='s' file='{}'/>", "", "."),
    "model": ("", "<model name='other' file='{}'/>", "", "."),
    "include": ("<include file='{}'/>", "", "", "."),
    "cloth": ("", "", "<flexcomp name='f' type='mesh' dim='2' file='{}'/>", "."),
}  # fmt: skip


def model(head: str = "", assets: str = "", shape: str = "") -> str:
    leg = (
        "<body name='u' pos='0.1 0 0'><joint name='h' axis='0 1 0'/><geom type='sphere' size='0.05'/>"
        "<body name='l' pos='0.1 0 0'><joint name='k' axis='0 1 0'/><geom type='sphere' size='0.05'/></body></body>"
    )
    body = f"<body name='t'><freejoint/><geom type='sphere' size='0.1'/>{shape}{leg}</body>"
    return f"<mujoco model='r'>{head}<asset>{assets}</asset><worldbody>{body}</worldbody></mujoco>"


def refused(path: Path, folder: Path) -> str:
    with pytest.raises(ClamberError) as error:
        import_robot(path, folder / "robot.toml", "robot")
    return str(error.value)


@pytest.mark.parametrize("kind", ["pipe", "device", "huge"])
@pytest.mark.parametrize("part", PARTS)
def test_an_mjcf_model_names_regular_files_of_a_size_only(part: str, kind: str, tmp_path: Path) -> None:
    head, assets, shape, place = PARTS[part]
    odd = tmp_path / place / "odd.stl"
    odd.parent.mkdir(exist_ok=True)
    if kind == "pipe":
        os.mkfifo(odd)
    elif kind == "device":
        odd.symlink_to("/dev/zero")
    else:
        with odd.open("wb") as file:
            file.truncate(MOST_MESH + 1)
    path = tmp_path / "model.xml"
    path.write_text(model(*(text.format("odd.stl") for text in (head, assets, shape))))
    told = refused(path, tmp_path)
    words = {"pipe": "is a pipe", "device": "is a character device", "huge": f"has {MOST_MESH + 1} bytes"}
    assert all(word in told for word in (str(path), "odd.stl'>", str(odd), words[kind])), told
    assert ("are read" if kind == "huge" else "name a regular file") in told


def test_what_an_included_file_names_is_looked_at_too(tmp_path: Path) -> None:
    (tmp_path / "inner").mkdir()
    os.mkfifo(tmp_path / "inner" / "odd.stl")
    (tmp_path / "inner" / "a.xml").write_text("<mujoco><INCLUDE file='b.xml'/></mujoco>")
    (tmp_path / "inner" / "b.xml").write_text("<mujoco><asset><mesh name='m' file='odd.stl'/></asset></mujoco>")
    path = tmp_path / "model.xml"
    path.write_text(model("<include file='inner/a.xml'/>"))
    told = refused(path, tmp_path)
    assert all(word in told for word in ("b.xml", "<mesh name='m' file='odd.stl'>", "is a pipe")), told


def test_entities_whose_meaning_readers_do_not_share_are_refused(tmp_path: Path) -> None:
    (tmp_path / "model.xml").write_text("<!DOCTYPE mujoco [<!ENTITY x 'y'>]>" + model())
    assert "ENTITY" in refused(tmp_path / "model.xml", tmp_path)


@pytest.mark.parametrize("where", ["inner", "beside"])
def test_relative_includes_of_any_folder_are_read(where: str, tmp_path: Path) -> None:
    home, other = tmp_path / "robot", tmp_path / {"inner": "robot/inner", "beside": "common"}[where]
    home.mkdir()
    other.mkdir(exist_ok=True)
    (other / "more.xml").write_text("<mujoco><default><joint range='-10 20' limited='true'/></default></mujoco>")
    (home / "model.xml").write_text(model(f"<include file='{os.path.relpath(other / 'more.xml', home)}'/>"))
    found = import_robot(home / "model.xml", home / "robot.toml", "robot")
    assert not any("no limits" in line for line in found.repaired), "the included default is not there"


def test_a_urdf_mesh_that_is_a_pipe_is_refused_by_name(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "foot.stl")
    mesh = "<link name='base'><collision><geometry><mesh filename='foot.stl'/></geometry></collision></link>"
    (tmp_path / "model.urdf").write_text(f"<robot name='r'>{mesh}</robot>")
    told = refused(tmp_path / "model.urdf", tmp_path)
    assert all(word in told for word in ("model.urdf", "filename='foot.stl'", "of link base", "is a pipe")), told
