"""A URDF file made ready for MuJoCo: mesh paths resolved, what MuJoCo has no word for left out, and all of it told."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final
from xml.etree import ElementTree

from ....errors import FileError
from ....regular_files import is_there, read_bytes
from .model_files import MOST_MESH, read_named
from .notes import Notes

MESHES: Final = (".stl", ".obj")
"""Suffixes of mesh files that MuJoCo reads."""
MOVING: Final = ("revolute", "continuous", "prismatic")
STL_HEADER: Final = 84
STL_FACE: Final = 50
"""Bytes of a binary STL file before its faces, and of each of them."""
STL_MOST: Final = 200_000
"""Faces that MuJoCo takes of one STL file."""


@dataclass(frozen=True, slots=True)
class JointFacts:
    """What a URDF says of a joint and MuJoCo does not keep."""

    torque: float | None
    speed: float | None
    limited: bool
    held: float | None = None
    """Position of a joint that follows another, with that one at 0."""


@dataclass(frozen=True, slots=True)
class Urdf:
    """A URDF for MuJoCo, and what it could not be told."""

    text: str
    assets: dict[str, bytes] = field(repr=False)
    """Names of mesh files in the text -> what they hold."""
    joints: dict[str, JointFacts]


def prepare(root: ElementTree.Element, path: Path, notes: Notes) -> Urdf:
    """The file's elements made ready.

    Raises:
        FileError: If a link, a joint or a number is none.
    """
    links = [_name(link, "link", path) for link in root.findall("link")]
    if not links:
        raise FileError(str(path), "has no <link>", "a URDF has links and joints; a xacro file is to be expanded first")
    for doubled in sorted({name for name in links if links.count(name) > 1}):
        raise FileError(str(path), f"<link name='{doubled}'> is there twice", "names of links must differ")
    for element in list(root):
        if element.tag not in ("link", "joint"):
            root.remove(element)
    _check_tree(root, set(links), path)
    joints = _joints(root, path, notes)
    assets = _meshes(root, path, notes)
    massless = [_name(link, "link", path) for link in root.findall("link") if link.find("inertial") is None]
    hollow = [name for name in massless if root.find(f"link[@name='{name}']/collision") is not None]
    notes.repair("link", hollow, "has a shape and states no <inertial>; its mass counts as 0 kg")
    for link in root.findall("link"):
        for visual in link.findall("visual"):
            link.remove(visual)
        _check_mass(link, path)
    return Urdf(ElementTree.tostring(root, encoding="unicode"), assets, joints)


def _check_tree(root: ElementTree.Element, links: set[str], path: Path) -> None:
    """Makes sure that joints name links that there are, and that no link has two parents."""
    children: set[str] = set()
    for joint in root.findall("joint"):
        name = _name(joint, "joint", path)
        for end in ("parent", "child"):
            element = joint.find(end)
            link = None if element is None else element.get("link")
            if link not in links:
                raise FileError(
                    str(path), f"<joint name='{name}'> has no {end} link '{link}'", "name a <link> of the file"
                )
            if end == "child" and link in children:
                raise FileError(str(path), f"<link name='{link}'> is the child of two joints", "links must form a tree")
            if end == "child":
                children.add(str(link))
    roots = sorted(links - children)
    if len(roots) != 1:
        told = f"has {len(roots)} links without a parent ({', '.join(roots[:6])})"
        raise FileError(str(path), told, "links must form one tree")


def _joints(root: ElementTree.Element, path: Path, notes: Notes) -> dict[str, JointFacts]:
    found: dict[str, JointFacts] = {}
    odd: dict[str, list[str]] = {"kind": [], "swapped": [], "unstated": [], "closed": []}
    followers: dict[tuple[str, float], list[str]] = {}
    for joint in root.findall("joint"):
        name, kind = _name(joint, "joint", path), joint.get("type", "fixed")
        if name in found:
            raise FileError(str(path), f"<joint name='{name}'> is there twice", "names of joints must differ")
        if kind not in (*MOVING, "fixed"):
            odd["kind"].append(f"{name} ({kind})")
            joint.set("type", "fixed")
        if kind not in MOVING:
            continue
        limit = joint.find("limit")
        if limit is None:
            limit = ElementTree.SubElement(joint, "limit")
        lower, upper, torque, speed = (_number(limit, key, path) for key in ("lower", "upper", "effort", "velocity"))
        if lower > upper:
            odd["swapped"].append(name)
            lower, upper = upper, lower
        held, limited = None, kind != "continuous" and lower < upper
        if kind != "continuous" and lower == upper:
            odd["closed" if lower else "unstated"].append(name)
            held = lower or None
        for key, value in (("lower", lower if limited else -1.0), ("upper", upper if limited else 1.0)):
            limit.set(key, repr(value))
        if (mimic := joint.find("mimic")) is not None:
            held = _number(mimic, "offset", path)
            followers.setdefault((mimic.get("joint", ""), held), []).append(name)
            joint.remove(mimic)
        found[name] = JointFacts(abs(torque) or None, abs(speed) or None, limited, held)
    notes.drop("joint", odd["kind"], "its kind has no word here; it is held where it is, and a base floats in any case")
    notes.repair("joint", odd["swapped"], "its lower limit was above the upper one; they were exchanged")
    notes.repair(
        "joint", odd["unstated"], "its limits are both 0, as if they were not stated; it counts as one without limits"
    )
    notes.repair("joint", odd["closed"], "its limits leave it a single position; it is held there")
    for (leader, offset), names in followers.items():
        notes.repair("joint", names, f"mimics joint {leader}; it is held at {offset:.4g}, where that one's 0 puts it")
    return found


def _meshes(root: ElementTree.Element, path: Path, notes: Notes) -> dict[str, bytes]:
    """Takes collision meshes in, and those away that can't be read."""
    assets: dict[str, bytes] = {}
    names: dict[tuple[Path, str], str] = {}
    refused: dict[str, list[str]] = {}
    for link in root.findall("link"):
        for collision in link.findall("collision"):
            mesh = collision.find("geometry/mesh")
            if mesh is None:
                continue
            said = mesh.get("filename", "")
            file = next((one for one in mesh_files(said, path.parent) if said and is_there(one)), None)
            if file is not None and not file.is_file():
                read_named(path, f"<mesh filename='{said}'> of link {link.get('name')}", file)
            reason = "is missing" if file is None else _unreadable(file)
            if reason is not None or file is None:
                refused.setdefault(str(reason), []).append(f"{Path(said).name} of link {link.get('name')}")
                link.remove(collision)
                continue
            key = (file, mesh.get("scale", ""))
            if key not in names:
                names[key] = f"mesh-{len(names)}{file.suffix.lower()}"
                assets[names[key]] = read_bytes(file, MOST_MESH)
            mesh.set("filename", names[key])
    for reason, gone in refused.items():
        notes.drop("collision mesh", gone, f"{reason}; masses and joints don't need it, the link's shape is unknown")
    return assets


def mesh_files(said: str, folder: Path) -> Iterator[Path]:
    """Where a mesh of a URDF may lie: its package is any folder above the file that has its name or holds such a folder."""
    scheme, _, rest = said.rpartition("://")
    if scheme in ("package", "model"):
        package, _, inner = rest.partition("/")
        here = folder.resolve()
        for above in (here, *here.parents):
            if above.name == package:
                yield above / inner
            yield above / package / inner
    else:
        yield folder / rest
    yield folder / Path(rest).name


def _unreadable(file: Path) -> str | None:
    """Why MuJoCo would not read a mesh file, or None."""
    suffix = file.suffix.lower()
    if suffix not in MESHES:
        return f"is no mesh that can be read ({suffix or 'no suffix'}; STL and OBJ can)"
    if file.stat().st_size > MOST_MESH:
        return f"is larger than {MOST_MESH // 2**20} MB"
    if suffix == ".stl":
        header = read_bytes(file, MOST_MESH)[:STL_HEADER]
        faces = int.from_bytes(header[80:], "little")
        if len(header) < STL_HEADER or file.stat().st_size < STL_HEADER + STL_FACE * faces:
            return "is no binary STL file"
        if not 1 <= faces <= STL_MOST:
            return f"has {faces} faces; 1 to {STL_MOST} can be read"
    return None


def _check_mass(link: ElementTree.Element, path: Path) -> None:
    mass = link.find("inertial/mass")
    if mass is not None and (value := _number(mass, "value", path)) < 0.0:
        raise FileError(
            str(path), f"<link name='{link.get('name')}'> has a mass of {value:g} kg", "it must be 0 or more"
        )


def _name(element: ElementTree.Element, kind: str, path: Path) -> str:
    name = element.get("name")
    if not name:
        raise FileError(str(path), f"a <{kind}> has no name", f"every {kind} must have one")
    return name


def _number(element: ElementTree.Element, key: str, path: Path) -> float:
    """A number of an element, 0 where it is not stated."""
    text = element.get(key, "0")
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if math.isnan(value):
        raise FileError(str(path), f"<{element.tag} {key}='{text}'>", "must be a number")
    return value
