"""A robot in space as its statics see it: a floating base and limbs that are serial chains of hinges and slides."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ....types import Floats, Ints

Bools = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True, kw_only=True)
class Chains:
    """Base and limbs, padded to the longest limb; frames and places are of the base frame or of the frame before, as each says.

    Frame k of a limb has joint k's axis as its z and moves with link k, the body behind that joint. Joints that no limb has of its
    own (a trunk, a head, fingers) are held, and their links belong to the base or to the link that carries them.
    """

    name: str
    limb_names: tuple[str, ...]
    joint_names: tuple[tuple[str, ...], ...]
    """Of each limb, from the base to the tip."""
    n_joints: Ints
    """Shape (limbs,)."""
    offset: Floats
    """Origin of frame k in frame k - 1 [m], frame -1 being the base; of [limb, n_joints] the tip in the last frame; shape
    (limbs, most + 1, 3)."""
    rotation: Floats
    """Axes of frame k in frame k - 1 with joint k at 0, as columns; of [limb, n_joints] those of the end effector, whose z points out of
    it, towards what it touches; shape (limbs, most + 1, 3, 3)."""
    sliding: Ints
    """1 for a slide, 0 for a hinge, shape (limbs, most)."""
    lower: Floats
    """Least joint positions [rad] or [m], shape (limbs, most)."""
    upper: Floats
    """Largest joint positions [rad] or [m], shape (limbs, most)."""
    torque: Floats
    """Largest torque or force of each motor that may be used [N m] or [N], shape (limbs, most)."""
    speed: Floats
    """Largest joint speed [rad/s] or [m/s], infinite where nothing states one, shape (limbs, most)."""
    nominal: Floats
    """Posture that searches of postures begin at [rad] or [m], shape (limbs, most)."""
    mass: Floats
    """Of each link with all that is fixed to it [kg], shape (limbs, most)."""
    centre: Floats
    """Centre of mass of each link in its frame [m], shape (limbs, most, 3)."""
    radius: Floats
    """Of the capsule from each joint's frame to the next that stands for a link's body [m], shape (limbs, most)."""
    base_mass: float
    """With the trunk and the payload [kg]."""
    base_centre: Floats
    """Centre of that mass, base frame [m], shape (3,)."""
    base_half: Floats
    """Half extents of the box about the base frame's origin that stands for the base's body [m], shape (3,)."""
    stretch: float = 1.0
    """Part of their full length that limbs have in a stance at most [-]."""
    limb_room: float = 0.0
    """That links of different limbs keep from each other [m]."""

    @property
    def total_mass(self) -> float:
        """Of the whole robot [kg]."""
        return self.base_mass + float(self.mass.sum())

    @property
    def used(self) -> Bools:
        """Where tables have a joint, in place of padding, shape (limbs, most); what they have there is joint by joint, limb after limb."""
        return np.arange(self.lower.shape[1]) < self.n_joints[:, None]

    @property
    def longest_limb(self) -> float:
        """Length of the longest limb when stretched, slides not run out [m]."""
        return float(np.linalg.norm(self.offset[:, 1:], axis=2).sum(axis=1).max())
