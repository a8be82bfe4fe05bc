"""The body's test stand: a climber that two limbs hold, its hooks on pegs or fixed to them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ....sim.limb_flaws import LimbFlaws
from ....sim.plant_rules import PlantError
from ....tasks.robots import load_robot
from ....types import Floats
from ....units import INCH
from ..execution.body_gains import BodyGains
from ..execution.climber import Climber
from ..execution.postures import postures
from ..robot.robot import LimbedRobot
from ..sim.climber_model import HookShape
from ..sim.climber_plant import ClimberPlant
from ..sim.flaw_texts import named_flaws, read_flaws
from ..world.board import Board
from ..world.library import load_board
from .run_plan import PHYSICS_RATE


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BodyStand:
    """Which limbs hold what, and where the body starts."""

    robot: LimbedRobot
    board: Board
    pose: Floats
    """Of the body at the start, shape (3,) [m], [rad]."""
    holds: Mapping[str, int]
    """Limb -> number of the hold that it carries the body by."""
    elbows: Mapping[str, int] = field(default_factory=dict)
    """Limb -> side of its elbow."""
    rest: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Limb that holds nothing -> its joint angles [rad]."""
    fixed: bool = False
    """Whether the tips are fixed to their holds, so that they can push as well as pull (Bevly 1997, Fig. 4.17)."""
    shape: HookShape = HookShape()  # noqa: RUF009  # frozen
    weight: float = 1.0
    """Of the robot, over what its control believes [-]."""

    def put(self, flaws: LimbFlaws, gains: BodyGains, *, pegs: Floats | None = None) -> tuple[Climber, ClimberPlant]:
        """The climber on its holds, at rest, and the plant that moves it.

        Args:
            flaws: Of the plant.
            gains: Of body and limbs.
            pegs: Where the holds truly are, shape (n_holds, 2) [m]; None: as the board says.
        """
        pinned = self.holds if self.fixed else {}
        robot = replace(self.robot, weight=self.weight * self.robot.weight)
        plant = ClimberPlant(robot, self.board, flaws, pegs=pegs, pinned=pinned, shape=self.shape)
        climber = Climber(self.robot, self.board, plant, gains=gains, backlash=flaws.backlash)
        climber.start(self.pose, self.holds, elbows=self.elbows)
        q = np.array([task.angles for task in climber.body.tasks])
        for i, limb in enumerate(self.robot.limbs):
            if limb.name in self.rest:
                q[i] = self.rest[limb.name]
                climber.body.tasks[i].angles = q[i].copy()
        plant.reset(self.pose, q)
        return climber, plant

    def angles(self, pose: Floats) -> Floats:
        """Joint angles with the body at a pose and all holds held, shape (limbs, 2) [rad].

        Raises:
            PlantError: If a hold is out of reach there.
        """
        q = np.zeros((len(self.robot.limbs), 2))
        places = {hold.number: np.array((hold.x, hold.y)) for hold in self.board.holds}
        for i, limb in enumerate(self.robot.limbs):
            q[i] = self.rest.get(limb.name, (0.0, 0.0))
            if limb.name in self.holds:
                number = self.holds[limb.name]
                found = postures(limb, pose, places[number])
                if not found:
                    raise PlantError("pose", tuple(map(float, pose)), f"limb {limb.name} must reach hold {number}")
                side = self.elbows.get(limb.name, 0)
                found.sort(key=lambda posture: (posture.angles[1] * side < 0.0, -posture.on_top))
                q[i] = found[0].angles
        return q


def ladder_stand(*, fixed: bool = False, below: float = 0.6 * INCH, hanging: bool = False) -> BodyStand:
    """LIBRA between pegs 3 and 4 of the ladder, its third limb folded beneath it.

    Args:
        fixed: Whether the tips are fixed to their pegs.
        below: How far the body's origin is below the two pegs [m].
        hanging: Whether the left limb alone holds, stretched upwards.
    """
    robot, board = load_robot("libra"), load_board("ladder")
    assert isinstance(robot, LimbedRobot)
    pegs = {hold.number: (hold.x, hold.y) for hold in board.holds}
    folded = {"bottom": (0.6, -1.2)}
    if hanging:
        # nearly beneath the peg: straight beneath it the limb is beyond its joints' limits
        pose = np.array((pegs[3][0] + 0.04, pegs[3][1] - 0.25, 0.0))
        rest = folded | {"right": (0.6, -1.2)}
        return BodyStand(robot=robot, board=board, pose=pose, holds={"left": 3}, elbows={"left": 1}, rest=rest)
    pose = np.array(((pegs[3][0] + pegs[4][0]) / 2, pegs[3][1] - below, 0.0))
    return BodyStand(
        robot=robot, board=board, pose=pose, holds={"right": 4, "left": 3}, elbows={"right": -1, "left": 1},
        rest=folded, fixed=fixed,
    )  # fmt: skip


def bench_flaws(name: str, settings: Sequence[str] = ()) -> LimbFlaws:
    """The plant of the body's bench: "ideal" or "nominal", with settings such as "backlash=1deg".

    Raises:
        PlantError: If one of them cannot be.
    """
    return read_flaws(named_flaws(name, ladder_stand().robot).with_changes(physics_rate=PHYSICS_RATE), settings)
