"""A whole walk does not hang on how the model is made: struts for tendons, shorter steps; and its drift on a slope is the ground's give."""

import numpy as np
import pytest

from clamber.execution.sequencer import Sequencer
from clamber.families.walker.execution.settings import WalkSettings
from clamber.families.walker.execution.true_walk import TracedPlant, TrueWalk
from clamber.families.walker.execution.walk_trace import TracedWalker
from clamber.families.walker.execution.walker import Walker
from clamber.families.walker.execution.walking import Walking
from clamber.families.walker.planning import Walk, load_walk
from clamber.families.walker.sim import walker_model
from clamber.families.walker.sim.walker_flaws import WalkerFlaws
from clamber.families.walker.sim.walker_plant import WalkerSim
from clamber.families.walker.trials.run_walk import own_way


def true_walk(walk: Walk, *, rate: float = 500.0, struts: bool = False) -> TrueWalk:
    plant = TracedPlant(WalkerSim(walk.robot, walk.ground, WalkerFlaws(physics_rate=rate), struts=struts))
    walker = TracedWalker(walk.robot, plant, settings=WalkSettings())
    sequencer = Sequencer(Walking(walker, own_way(walk)))
    walker.start(walk.start_pose(), walk.start_place(), walk.start_legs(), np.array(walk.arm))
    report = sequencer.run()
    assert report.done, report.reason
    return plant.trace()


@pytest.mark.slow
@pytest.mark.parametrize("uphill", [0.0, 90.0])
def test_struts_and_shorter_steps_walk_alike(uphill: float) -> None:
    walk = load_walk("slope-walk", ["way.0.distance=25cm", f"ground.uphill={uphill}deg"])
    usual = true_walk(walk)
    for other in (true_walk(walk, struts=True), true_walk(walk, rate=1000.0)):
        np.testing.assert_allclose(other.pose[-1, :3], usual.pose[-1, :3], atol=0.2e-3)
        np.testing.assert_allclose(other.pose[-1, 3:], usual.pose[-1, 3:], atol=np.radians(0.03))


@pytest.mark.long
def test_a_walk_up_a_slope_goes_too_far_as_feet_sink_in_along_its_normal(monkeypatch: pytest.MonkeyPatch) -> None:
    """A robot that takes its feet for rigid drifts: half the ground's time constant is a third of its give, and of the drift."""
    walk = load_walk("slope-walk", ["way.0.distance=50cm"])
    drifts, gives = [], []
    reckoned = true_walk(walk, rate=1000.0).pose[-1, 0] - 0.5
    monkeypatch.setattr(Walker, "_settle_in", lambda walker, share: None)
    for solref in ((0.01, 1.0), (0.005, 1.0)):
        monkeypatch.setattr(walker_model, "SOLREF", solref)
        true = true_walk(walk, rate=1000.0)
        drifts.append(true.pose[-1, 0] - 0.5)
        standing = true.feet[50]
        gives.append((walk.ground.heights(standing[..., :2]) - standing[..., 2]).mean())
    assert drifts[0] > 2e-3
    assert abs(reckoned) < 0.5 * drifts[0]
    assert drifts[1] / drifts[0] == pytest.approx(gives[1] / gives[0], abs=0.1)
