"""Which chains of a model are limbs: a guess from its tree, its lengths and its names, of which every part is told."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise, takewhile
from string import ascii_letters
from typing import Final

import numpy as np

from ....types import Floats
from .tree import Joint, Link, Posture, Tree

SPLIT: Final = 0.5
"""Where the chains behind a fork are this part of the way to it or longer, it is a trunk's; otherwise a hand's or a gripper's [-]."""
SHORT: Final = 0.35
"""A chain shorter than this part of the longest is no limb [-]."""
FEW: Final = 2
"""Joints that a limb has at least; with fewer its end has no place to choose."""
NO_LIMB: Final = re.compile(
    r"head|neck|eye|camera|lidar|laser|antenna|sensor|tail|hokuyo|kinect|realsense|propeller|mast|caster", re.I
)
"""Names of joints that look round, or roll, in place of holding on."""
JAW: Final = re.compile(r"grip|finger|fngr|jaw|claw|thumb|knuckle", re.I)
"""Names of joints that open and close an end."""
WRIST: Final = re.compile(r"yaw|roll|pitch|wrist", re.I)
"""Names of joints that turn it, whatever else they are called."""


@dataclass(frozen=True, slots=True)
class Part:
    """Links that move as one, and the joints between them and the part that carries them."""

    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    """The first one next to the carrier; none of the root."""
    parts: "tuple[Part, ...]" = ()
    """Carried by it."""

    def all_parts(self) -> "Iterator[Part]":
        """Itself and all that it carries."""
        yield self
        for part in self.parts:
            yield from part.all_parts()


@dataclass(frozen=True, slots=True)
class Chain:
    """A chain of parts that may be a limb."""

    parts: tuple[Part, ...]
    """From the trunk to its end."""
    length: float
    """From its first joint along its joints to the farthest of its end [m]."""

    @property
    def joints(self) -> tuple[Joint, ...]:
        """From the trunk to its end."""
        return tuple(joint for part in self.parts for joint in part.joints)

    @property
    def end(self) -> Part:
        """Its last part."""
        return self.parts[-1]


@dataclass(slots=True)
class Found:
    """What was found in a model."""

    base: Link
    limbs: list[Chain] = field(default_factory=list)
    trunk: list[Joint] = field(default_factory=list)
    """Joints that no limb has."""
    told: list[str] = field(default_factory=list)
    """What was taken for no limb, and why."""
    looked: list[str] = field(default_factory=list)
    """Every chain that was looked at, for when none is a limb."""


def find_limbs(tree: Tree) -> Found:
    """Base, limbs and trunk of a model."""
    posture = Posture.of(tree)
    root = _part(tree, tree.links[0], ())
    found = Found(_base(tree, root))
    chains: list[Chain] = []
    _gather(posture, root, chains, found)
    longest = max((chain.length for chain in chains), default=0.0)
    found.looked = [f"{chain.end.links[0].name} ({len(chain.joints)} joints, {chain.length:.2g} m)" for chain in chains]
    for chain in chains:
        _sort_out(chain, longest, found)
    own = {joint.name for chain in found.limbs for joint in chain.joints}
    found.trunk = [joint for joint in tree.joints if joint.name not in own]
    return found


def _part(tree: Tree, link: Link, joints: tuple[Joint, ...]) -> Part:
    """The part that a link belongs to, which lies behind `joints`, with all that it carries."""
    links, todo = [link], [link]
    carried: list[tuple[Link, tuple[Joint, ...]]] = []
    while todo:
        parent = todo.pop()
        for child in (one for one in tree.links if one.parent == parent.name):
            moving = tuple(joint for joint in tree.joints_of(child.name) if joint.held is None)
            if moving:
                carried.append((child, moving))
            else:
                links.append(child)
                todo.append(child)
    return Part(tuple(links), joints, tuple(_part(tree, child, moving) for child, moving in carried))


def _base(tree: Tree, root: Part) -> Link:
    """The root, or where that is a frame without mass, the heaviest link that is fixed to it."""
    return root.links[0] if root.links[0].mass > 0.0 else max(root.links, key=lambda link: link.mass)


def _gather(posture: Posture, trunk: Part, chains: list[Chain], found: Found) -> None:
    """Adds the chains that hang on a part of the trunk; a fork that carries chains as long as the way to it is trunk, too."""
    for first in trunk.parts:
        run = [first]
        while len(run[-1].parts) == 1:
            run.append(run[-1].parts[0])
        fork = run[-1]
        behind = [_reach(posture, part) for part in fork.parts]
        way = _length(posture, run)
        if fork.parts and max(behind) >= SPLIT * way:
            _gather(posture, fork, chains, found)
            continue
        if fork.parts:
            fingers = [joint.name for part in fork.parts for inner in part.all_parts() for joint in inner.joints]
            found.told.append(
                f"{len(fingers)} joints behind {fork.links[0].name} ({', '.join(fingers[:3])}{', ...' if len(fingers) > 3 else ''}): "
                f"short beside the way there, so fingers of an end; they are held"
            )
        run = _without_jaw(run, found) if not fork.parts else run
        chains.append(Chain(tuple(run), _length(posture, run)))


def _without_jaw(run: list[Part], found: Found) -> list[Part]:
    """The chain without a last joint that opens and closes its end, or rolls a wheel."""
    names = [" ".join(joint.name + " " + joint.link for joint in part.joints) for part in run]
    if len(run) <= FEW:
        return run
    joint = run[-1].joints[-1].name
    if JAW.search(names[-1]) and not WRIST.search(names[-1]) and not JAW.search(names[0]):
        found.told.append(f"joint {joint}: opens and closes the end of its limb, by its name; it is held")
        return run[:-1]
    if re.search("wheel", names[-1], re.I):
        found.told.append(f"joint {joint}: turns a wheel, by its name; it is held, and the wheel is the limb's end")
        return [*run[:-2], replace(run[-2], links=run[-2].links + run[-1].links)]
    return run


def _sort_out(chain: Chain, longest: float, found: Found) -> None:
    """Takes a chain as a limb, or says why not."""
    joints, end = chain.joints, chain.end.links[0].name
    named = next((joint.name for joint in joints if NO_LIMB.search(joint.name + " " + joint.link)), None)
    told = None
    if len(joints) < FEW:
        told = f"has one joint ({joints[0].name}); a limb has {FEW} or more"
    elif chain.length < SHORT * longest:
        told = f"is short ({chain.length:.2g} m beside {longest:.2g} m of the longest chain)"
    elif named is not None:
        told = f"looks round or rolls, by the name of joint {named}"
    if told is None:
        found.limbs.append(chain)
    else:
        found.told.append(f"chain to {end}: {told}; its joints are held")


def _reach(posture: Posture, part: Part) -> float:
    """Length of the longest chain that begins with a part [m]."""
    below = [_reach(posture, other) for other in part.parts]
    here = _length(posture, [part])
    if not below:
        return here
    anchor = posture.axis(part.joints[0])[0]
    first = [posture.axis(other.joints[0])[0] for other in part.parts]
    return max(float(np.linalg.norm(start - anchor)) + more for start, more in zip(first, below, strict=True))


def _length(posture: Posture, run: list[Part]) -> float:
    """From the first joint of a chain along its joints to the farthest of its end [m]."""
    anchors = [posture.axis(joint)[0] for part in run for joint in part.joints]
    between = sum(float(np.linalg.norm(b - a)) for a, b in pairwise(anchors))
    last = anchors[-1]
    return between + max(float(np.linalg.norm(point - last)) for point in end_points(posture, run[-1]))


def end_points(posture: Posture, part: Part) -> Iterator[Floats]:
    """Places on a part: origins of its links, and its shapes as they are [m]."""
    names = frozenset(link.name for link in part.links)
    for link in part.links:
        yield posture.frame(link).place
    for points, shape in posture.shapes(names):
        middle = points.mean(axis=0)
        for point in points:
            away = point - middle
            far = float(np.linalg.norm(away))
            yield point + (away / far * shape.radius if far > 0.0 else 0.0)


def limb_names(limbs: list[Chain]) -> list[str]:
    """A name of each limb: what its joints' names begin with, where that tells it from the others; else that of its end."""
    found = [_prefix([joint.name for joint in chain.joints]) for chain in limbs]
    ends = [re.sub(r"[_-]?(link|frame)$", "", chain.end.links[0].name, flags=re.I) for chain in limbs]
    chosen = [name if len(name) > 1 and found.count(name) == 1 else end for name, end in zip(found, ends, strict=True)]
    clean = [re.sub(r"[^A-Za-z0-9_-]", "-", name).strip("-_")[:60] for name in chosen]
    clean = [
        name if name[:1].isalpha() else f"limb-{name}" if name else f"limb-{i + 1}" for i, name in enumerate(clean)
    ]
    return [name if clean.count(name) == 1 else f"{name}-{i + 1}" for i, name in enumerate(clean)]


def _prefix(names: list[str]) -> str:
    """What names begin with, up to a whole word."""
    alike = takewhile(lambda letters: len(set(letters)) == 1, zip(*names, strict=False))
    shared = "".join(letters[0] for letters in alike)
    if any(name[len(shared) : len(shared) + 1].isalpha() for name in names):
        shared = shared.rstrip(ascii_letters)
    if len(names) < 2:
        return ""
    bare = _without_signs(shared)
    word = next((word for word in ("joint", "j") if bare.lower().endswith(word)), "")
    return _without_signs(bare[: len(bare) - len(word)])


def _without_signs(name: str) -> str:
    """A name up to its last letter or digit."""
    end = len(name)
    while end and not name[end - 1].isalnum():
        end -= 1
    return name[:end]
