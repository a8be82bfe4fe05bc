"""Models from MJCF and URDF files, read by MuJoCo, repaired where they can't be used as they are; nothing else here imports MuJoCo."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from ....errors import FileError
from ....files import content_hash
from ....regular_files import read_bytes
from .bodies import is_of_a_body, rotation, shape_points, symmetric
from .model_files import MOST_MODEL, check_named, parse_model
from .notes import Notes, span
from .tree import Joint, Link, Shape, Site, Tree, matrix, vector
from .urdf import JointFacts, Urdf, prepare

NO_MASS: Final = 1e-12
"""MuJoCo takes no moving link of less [kg], so links without mass get this and are read back as massless; also the inertia [kg m^2]."""
BULKY: Final = 4.0
"""An inertia above this many times mass times squared size belongs to something larger than the link [-]."""
SLIGHT: Final = 1e-5
"""The inertia of a link of less than this part of the robot's mass is let be [-]."""
UNSEEN: Final = 0.1
"""A link without a shape counts as at least this part of the robot's size [-]."""


@dataclass(frozen=True, slots=True)
class Model:
    """A model file as read."""

    tree: Tree
    notes: Notes
    spec: Any = field(repr=False)
    """`mujoco.MjSpec` of all that is in the file, with its repairs."""
    home: Mapping[str, float] = field(default_factory=dict)
    """Joint -> position in the model's first keyframe [rad] or [m]; empty where there is none."""
    passive: tuple[str, ...] = ()
    """Joints without an actuator in a model that has actuators."""


def read_model(path: Path) -> Model:
    """The model of an MJCF or URDF file.

    Raises:
        FileError: If it can't be read, or is not physical.
    """
    root = parse_model(path)
    notes = Notes()
    if root.tag == "robot":
        urdf = prepare(root, path, notes)
        spec = _urdf_spec(urdf, path)
        facts, held = urdf.joints, {name: facts.held for name, facts in urdf.joints.items()}
    elif root.tag == "mujoco":
        check_named(root, path)
        spec = _mjcf_spec(path, notes)
        facts, held = {}, _coupled(spec, notes)
    else:
        raise FileError(str(path), f"begins with <{root.tag}>", "a URDF begins with <robot>, an MJCF with <mujoco>")
    compiled = _usable(spec, path, notes)
    if compiled.nbody < 2:
        raise FileError(str(path), "has no body beside the world", "a robot has at least one link")
    reader = _Reader(compiled, notes, facts, held)
    sha256 = content_hash(read_bytes(path, MOST_MODEL))
    tree = reader.tree(root.get("name") or root.get("model") or path.stem, sha256)
    return Model(tree, notes, spec, reader.home(), reader.passive())


def _urdf_spec(urdf: Urdf, path: Path) -> Any:
    """What MuJoCo makes of a prepared URDF."""
    import mujoco as mj

    try:
        spec = mj.MjSpec.from_string(urdf.text, assets=urdf.assets)
    except ValueError as error:
        raise _refused(path, error) from None
    for body in spec.bodies:
        if not body.explicitinertial:  # in a URDF, shapes have no mass
            for geom in body.geoms:
                geom.mass = geom.density = 0.0
    return spec


def _mjcf_spec(path: Path, notes: Notes) -> Any:
    """What MuJoCo makes of an MJCF file, without the files that are missing and with closed loops cut."""
    import mujoco as mj

    try:
        spec = mj.MjSpec.from_file(str(path))
    except ValueError as error:
        raise _refused(path, error) from None

    def gone(file: str, named: str) -> bool:
        return bool(file) and not any((path.parent / place / file).is_file() for place in (named, ""))

    _drop_meshes(spec, {mesh.name for mesh in spec.meshes if gone(mesh.file, spec.meshdir)}, notes, "is missing")
    for material in spec.materials:
        material.textures = [""] * len(material.textures)
    for looks in [*spec.textures, *spec.skins]:  # pictures of any size, which nothing here shows
        spec.delete(looks)
    for equality in list(spec.equalities):
        if equality.type in (mj.mjtEq.mjEQ_CONNECT, mj.mjtEq.mjEQ_WELD):
            named = equality.name or f"{equality.name1} to {equality.name2 or 'world'}"
            notes.drop("closed loop", [named], "limbs are open chains here; its joints are kept as if it were cut")
            spec.delete(equality)
    return spec


def _coupled(spec: Any, notes: Notes) -> dict[str, float | None]:
    """Joints of an MJCF that equations tie to others -> where they stay."""
    import mujoco as mj

    found: dict[str, float | None] = {}
    for equality in [one for one in spec.equalities if one.type == mj.mjtEq.mjEQ_JOINT]:
        found[equality.name1] = float(equality.data[0])
        told = f"follows joint {equality.name2}" if equality.name2 else "is tied to one position"
        notes.repair("joint", [equality.name1], f"{told}; it is held at {found[equality.name1]:.4g}")
    return found


def _drop_meshes(spec: Any, names: set[str], notes: Notes, reason: str) -> None:
    """Takes meshes and what is shaped like them out of a model."""
    lost: set[str] = set()
    for geom in [geom for geom in spec.geoms if geom.meshname in names]:
        if not geom.parent.explicitinertial:
            lost.add(geom.parent.name)
        spec.delete(geom)
    for mesh in [mesh for mesh in spec.meshes if mesh.name in names]:
        spec.delete(mesh)
    notes.drop("mesh", sorted(names), f"{reason}; masses and joints don't need it, what it shapes is unknown")
    notes.repair("link", sorted(lost), "its mass was that of a mesh that is not there; it counts without it")


def _usable(spec: Any, path: Path, notes: Notes) -> Any:
    """The compiled model, with inertias such as bodies of that size have."""
    spec.compiler.fusestatic = spec.compiler.discardvisual = False
    spec.compiler.balanceinertia = True
    spec.compiler.boundmass = spec.compiler.boundinertia = NO_MASS
    _mend_inertias(spec, path, notes)
    model = _compiled(spec, path, notes)
    return _compiled(spec, path, notes) if _shrink_inertias(spec, model, notes) else model


def _mend_inertias(spec: Any, path: Path, notes: Notes) -> None:
    """Makes stated inertias such as a body can have."""
    bent: list[str] = []
    for body in spec.bodies:
        if not body.explicitinertial:
            continue
        if not (np.isfinite(body.mass) and body.mass >= 0.0):
            raise FileError(str(path), f"link '{body.name}' has a mass of {body.mass:g} kg", "it must be 0 or more")
        stated = np.diag(body.inertia) if np.isnan(body.fullinertia[0]) else symmetric(body.fullinertia)
        if not np.all(np.isfinite(stated)):
            raise FileError(str(path), f"link '{body.name}' has an inertia that is no number", "it must be finite")
        if not is_of_a_body(stated):
            bent.append(body.name)
            _make_round(body, float(np.abs(np.linalg.eigvalsh(stated)).mean()))
        elif not np.isnan(body.fullinertia[0]) and np.linalg.eigvalsh(stated)[0] <= 0.0:
            body.fullinertia = [*(np.diag(stated) + NO_MASS), *body.fullinertia[3:]]
    told = (
        "no body has such an inertia, for each principal moment is at most the sum of the others; it counts as a ball's"
    )
    notes.repair("link", bent, told)


def _make_round(body: Any, moment: float) -> None:
    """Gives a body a ball's inertia [kg m^2]."""
    body.fullinertia = [np.nan, 0.0, 0.0, 0.0, 0.0, 0.0]
    body.inertia = np.full(3, max(moment, NO_MASS))


def _compiled(spec: Any, path: Path, notes: Notes) -> Any:
    """The compiled model; meshes that MuJoCo refuses are left out."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # such as of masses that only this module makes nearly nothing
        for _ in range(len(spec.meshes) + 1):
            try:
                return spec.compile()
            except ValueError as error:
                named = {mesh.name for mesh in spec.meshes if f"'{mesh.name}'" in str(error)}
                if not named and not ("mesh" in str(error).lower() and spec.meshes):
                    raise _refused(path, error) from None
                reason = str(error).splitlines()[0].removeprefix("Error: ")
                _drop_meshes(spec, named or {mesh.name for mesh in spec.meshes}, notes, f"can't be used ({reason})")
    raise AssertionError("a model without meshes has no mesh to refuse")


def _refused(path: Path, error: Exception) -> FileError:
    told = " ".join(line.removeprefix("Error: ") for line in str(error).splitlines() if line.strip())
    return FileError(str(path), f"is no model that MuJoCo takes: {told}", "correct that element")


def _shrink_inertias(spec: Any, model: Any, notes: Notes) -> bool:
    """Replaces inertias that are far too large for their link's size by a ball's of that size; whether there were any."""
    import mujoco as mj

    data = mj.MjData(model)
    mj.mj_kinematics(model, data)
    large: dict[str, float] = {}
    for body in range(1, model.nbody):
        mass, most, size = (
            float(model.body_mass[body]),
            float(model.body_inertia[body].max()),
            float(_size(model, data, body)),
        )
        if mass > SLIGHT * model.body_mass.sum() and most > BULKY * mass * size * size:
            large[model.body(body).name] = most / (mass * size * size)
            _make_round(spec.body(model.body(body).name), 0.4 * mass * size * size)
    told = f"its inertia is {span(large)} times mass times squared size, as if of another unit; it counts as a ball's of that size"
    notes.repair("link", list(large), told)
    return bool(large)


def _size(model: Any, data: Any, body: int) -> float:
    """Largest distance of a link's shapes and joints from its centre of mass [m]; without shapes also a part of the robot's size."""
    centre = data.xipos[body]
    moved = model.jnt_bodyid
    joints = [joint for joint in range(model.njnt) if body in (moved[joint], model.body_parentid[moved[joint]])]
    geoms = range(model.body_geomadr[body], model.body_geomadr[body] + model.body_geomnum[body])
    sizes = [float(np.linalg.norm(data.geom_xpos[geom] - centre) + model.geom_rbound[geom]) for geom in geoms]
    sizes += [float(np.linalg.norm(data.xanchor[joint] - centre)) for joint in joints]
    return max(sizes) if len(geoms) else max([*sizes, UNSEEN * model.stat.extent])


class _Reader:
    """Takes the robot out of a compiled model, with every hinge and slide at 0."""

    def __init__(
        self, model: Any, notes: Notes, facts: Mapping[str, JointFacts], held: Mapping[str, float | None]
    ) -> None:
        import mujoco as mj

        self.mj, self.model, self.notes, self.facts, self.held = mj, model, notes, facts, held
        self.data = mj.MjData(model)
        self.names = {body: model.body(body).name or f"body-{body}" for body in self._bodies()}
        of_one_axis = (int(mj.mjtJoint.mjJNT_HINGE), int(mj.mjtJoint.mjJNT_SLIDE))
        mine = [joint for joint in range(model.njnt) if int(model.jnt_bodyid[joint]) in self.names]
        self.joints = {
            joint: model.joint(joint).name or f"joint-{joint}" for joint in mine if model.jnt_type[joint] in of_one_axis
        }
        for joint in self.joints:
            self.data.qpos[model.jnt_qposadr[joint]] = 0.0
        mj.mj_kinematics(model, self.data)
        free = int(mj.mjtJoint.mjJNT_FREE)
        others = [joint for joint in mine if joint not in self.joints and model.jnt_type[joint] != free]
        unnamed = [name for joint, name in self.joints.items() if not model.joint(joint).name]
        balls = [model.joint(joint).name or self.names[int(model.jnt_bodyid[joint])] for joint in others]
        notes.drop("joint", balls, "a ball joint has no motor of one axis; it is held where it is")
        notes.repair("joint", unnamed, "has no name in the model; it got this one")

    def _bodies(self) -> list[int]:
        """The bodies of the tree with the most joints, or the most bodies; other things in the model are told."""
        model = self.model
        trees: dict[int, list[int]] = {}
        for body in range(1, model.nbody):
            trees.setdefault(int(model.body_rootid[body]), []).append(body)
        best = max(trees, key=lambda root: (sum(model.body_jntnum[body] for body in trees[root]), len(trees[root])))
        others = [model.body(root).name or f"body-{root}" for root in trees if root != best]
        self.notes.drop("body", others, "stands in the model beside the robot")
        return trees[best]

    def tree(self, name: str, sha256: str) -> Tree:
        """The robot."""
        model = self.model
        sites = [
            site for site in map(model.site, range(model.nsite)) if site.name and int(site.bodyid[0]) in self.names
        ]
        return Tree(
            name=name,
            links=tuple(self._link(body) for body in self.names),
            joints=tuple(self._joint(joint, name) for joint, name in self.joints.items()),
            sites=tuple(
                Site(
                    name=site.name,
                    link=self.names[int(site.bodyid[0])],
                    place=vector(site.pos),
                    axes=matrix(rotation(site.quat)),
                )
                for site in sites
            ),
            shapes=tuple(self._shape(geom) for body in self.names for geom in self._solid(body)),
            sha256=sha256,
        )

    def home(self) -> dict[str, float]:
        """Positions in the first keyframe."""
        if not self.model.nkey:
            return {}
        return {
            name: float(self.model.key_qpos[0][self.model.jnt_qposadr[joint]]) for joint, name in self.joints.items()
        }

    def passive(self) -> tuple[str, ...]:
        """Joints that no actuator moves, in a model that has actuators."""
        moved = {joint for actuator in range(self.model.nu) for joint in self._moved_by(actuator)}
        return tuple(name for joint, name in self.joints.items() if self.model.nu and joint not in moved)

    def _moved_by(self, actuator: int) -> list[int]:
        """Joints that an actuator moves by itself, or by a tendon of joints."""
        model, kind, target = (
            self.model,
            self.mj.mjtTrn(self.model.actuator_trntype[actuator]),
            self.model.actuator_trnid[actuator, 0],
        )
        if kind in (self.mj.mjtTrn.mjTRN_JOINT, self.mj.mjtTrn.mjTRN_JOINTINPARENT):
            return [int(target)]
        if kind != self.mj.mjtTrn.mjTRN_TENDON:
            return []
        wraps = range(model.tendon_adr[target], model.tendon_adr[target] + model.tendon_num[target])
        return [
            int(model.wrap_objid[wrap]) for wrap in wraps if model.wrap_type[wrap] == int(self.mj.mjtWrap.mjWRAP_JOINT)
        ]

    def _link(self, body: int) -> Link:
        model = self.model
        mass, turned = float(model.body_mass[body]), rotation(model.body_iquat[body])
        stated = Link(
            name=self.names[body],
            parent=self.names.get(int(model.body_parentid[body])),
            place=vector(self.data.xpos[body]),
            axes=matrix(self.data.xmat[body].reshape(3, 3)),
            mass=0.0,
        )
        if mass < 2 * NO_MASS:
            return stated
        inertia = matrix(turned @ np.diag(model.body_inertia[body]) @ turned.T)
        return replace(stated, mass=mass, centre=vector(model.body_ipos[body]), inertia=inertia)

    def _joint(self, joint: int, name: str) -> Joint:
        model = self.model
        limited = bool(model.jnt_limited[joint])
        facts = self.facts.get(name) or JointFacts(torque=self._torque(joint), speed=None, limited=limited)
        lower, upper = (float(bound) for bound in model.jnt_range[joint])
        at = model.jnt_dofadr[joint]
        return Joint(
            name=name,
            link=self.names[int(model.jnt_bodyid[joint])],
            kind="slide" if model.jnt_type[joint] == int(self.mj.mjtJoint.mjJNT_SLIDE) else "hinge",
            axis=vector(self.data.xaxis[joint]),
            anchor=vector(self.data.xanchor[joint]),
            limits=(lower, upper) if facts.limited else None,
            torque=facts.torque,
            speed=facts.speed,
            rotor=float(model.dof_armature[at]),
            friction=float(model.dof_frictionloss[at]),
            damping=float(model.dof_damping[at].flat[0]),
            held=self.held.get(name),
        )

    def _torque(self, joint: int) -> float | None:
        """Largest torque [N m] or force [N] that joint and actuators let a motor give, or None."""
        model = self.model
        known = [float(np.abs(model.jnt_actfrcrange[joint]).min())] if model.jnt_actfrclimited[joint] else []
        for actuator in range(model.nu):
            at_joint = model.actuator_trntype[actuator] == int(self.mj.mjtTrn.mjTRN_JOINT)
            if not at_joint or model.actuator_trnid[actuator, 0] != joint:
                continue
            gear = abs(float(model.actuator_gear[actuator, 0]))
            if model.actuator_forcelimited[actuator]:
                known.append(gear * float(np.abs(model.actuator_forcerange[actuator]).min()))
            elif model.actuator_ctrllimited[actuator] and model.actuator_biastype[actuator] == int(
                self.mj.mjtBias.mjBIAS_NONE
            ):
                most = float(np.abs(model.actuator_ctrlrange[actuator]).min())
                known.append(gear * abs(float(model.actuator_gainprm[actuator, 0])) * most)
        return min(known, default=0.0) or None

    def _solid(self, body: int) -> list[int]:
        """Shapes of a link that can touch; all where it has none of those."""
        model = self.model
        mine = list(range(model.body_geomadr[body], model.body_geomadr[body] + model.body_geomnum[body]))
        return [geom for geom in mine if model.geom_contype[geom] or model.geom_conaffinity[geom]] or mine

    def _shape(self, geom: int) -> Shape:
        model = self.model
        kind = self.mj.mjtGeom(model.geom_type[geom]).name.removeprefix("mjGEOM_").lower()
        vertices = np.zeros((0, 3))
        if kind == "mesh":
            mesh = model.geom_dataid[geom]
            start = model.mesh_vertadr[mesh]
            vertices = model.mesh_vert[start : start + model.mesh_vertnum[mesh]].astype(float)
        points, radius = shape_points(kind, model.geom_size[geom], model.geom_aabb[geom], vertices)
        placed = model.geom_pos[geom] + points @ rotation(model.geom_quat[geom]).T
        return Shape(
            link=self.names[int(model.geom_bodyid[geom])],
            points=tuple(vector(point) for point in placed),
            radius=radius,
            thickness=float(model.geom_aabb[geom, 3:].min()),
        )
