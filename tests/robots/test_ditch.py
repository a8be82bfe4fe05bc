"""The widest ditch and the slides that cross it, beside a search over grids that knows the rules and nothing else."""

import math

import numpy as np
import pytest
from scipy.ndimage import label
from scipy.signal import fftconvolve

from clamber.families.walker.robot import WalkerRobot
from clamber.families.walker.robot.ditch import Footing, FootingError, ditch_map
from clamber.families.walker.robot.ditch_plan import cross_ditch
from clamber.families.walker.robot.ditch_slides import fewest_slides, meet, union
from clamber.families.walker.robot.weight import Weight, weight_of
from clamber.tasks.robots import load_robot
from tiers import first_fast

DEG = math.pi / 180.0
MM = 1e-3


def robot() -> WalkerRobot:
    made = load_robot("hoshino")
    assert isinstance(made, WalkerRobot)
    return made


def random_case(seed: int) -> tuple[Footing, float, float]:
    rng = np.random.default_rng(seed)
    made = robot()
    assert made.arm is not None
    footing = Footing.of(
        made,
        weight=weight_of(made, rng.uniform(made.arm.lowest, made.arm.highest), float(rng.choice([0.0, 5.0]))),
        guard=float(rng.choice([0.0, 0.8, 0.9])),
        margin=float(rng.uniform(0, 30)) * MM,
    )
    return footing, rng.uniform(-15, 45) * DEG, rng.uniform(0, math.tau)


def widest_ditch(footing: Footing, theta: float, direction: float, *, aside: bool = True) -> float:
    """The widest ditch for one angle of the frames and one direction [m]."""
    return float(ditch_map(footing, [theta], [direction], aside=aside)[0, 0])


# A search that knows only where feet may stand, what lengths are allowed, and which frame carries


class Search:
    """Frames on a grid along (and, with `aside`, across) the crossing direction; whoever is lifted may slide within its own region."""

    def __init__(self, footing: Footing, theta: float, direction: float, aside: bool, step: float) -> None:
        self.step = step
        along = np.exp(1j * direction)
        n = int(0.45 / step)
        line = step * np.arange(-n, n + 1)
        place = along * (line[:, None] + 1j * (line[None, :] if aside else np.zeros((1, 1))))  # [along, across]
        a, b = footing.frames.delta @ (1, 1j), np.exp(1j * theta) * (footing.frames.y @ (1, 1j))
        lengths = abs(place[..., None] + b - a)
        within = ((lengths >= footing.frames.shortest) & (lengths <= footing.frames.longest)).all(axis=-1)
        if footing.guard > 0.0:
            rho = abs(b - a)[0]  # circles: the same for all
            within &= abs(place) <= footing.guard * rho
        feet = [footing.feet[0] @ (1, 1j), np.exp(1j * theta) * (footing.feet[1] @ (1, 1j))]
        mass = complex(*footing.weight.load) + footing.weight.share[1] * place
        over = []
        for own, centre in ((feet[0], mass), (feet[1], mass - place)):
            inside = np.full(place.shape, math.inf)
            for i in range(3):
                side = own[(i + 1) % 3] - own[i]
                inside = np.minimum(inside, (np.conj(side) * (centre - own[i])).imag / abs(side))
            over.append(inside >= footing.margin)
        both = within & over[0] & over[1]
        self.parts = [label(within & one, np.ones((3, 3)))[0] for one in over]
        self.start = tuple(part[n, n if aside else 0] for part in self.parts) if both[n, n if aside else 0] else None
        self.offsets: dict[tuple[int, int], np.ndarray] = {}
        for pair in set(zip(self.parts[0][both], self.parts[1][both], strict=True)):
            held = both & (self.parts[0] == pair[0]) & (self.parts[1] == pair[1])
            self.offsets[pair] = held.any(axis=1)  # [along]
        self.along = [(one * np.conj(along)).real for one in feet]

    def crosses(self, width: float) -> bool:
        if self.start is None:
            return False
        places = np.arange(-0.8, 1.4, self.step)
        allowed, far = [], []
        for feet in self.along:
            at = places[:, None] + feet
            allowed.append(((at <= 1e-12) | (at >= width - 1e-12)).all(axis=1))
            far.append((at >= width - 1e-12).all(axis=1))
        # [frame][part of its region] -> where it may stand alone, before any slide: well before the ditch
        stands = [{self.start[0]: allowed[0] & (places < -0.3)}, {self.start[1]: allowed[1] & (places < -0.3)}]
        while True:
            before = [{k: v.copy() for k, v in one.items()} for one in stands]
            for (part0, part1), offsets in self.offsets.items():
                for here, there, mine, yours, shift in (
                    (0, 1, part0, part1, offsets), (1, 0, part1, part0, offsets[::-1]),
                ):  # fmt: skip
                    if mine in stands[here]:
                        reached = fftconvolve(stands[here][mine].astype(float), shift.astype(float), "same") > 0.5
                        stands[there][yours] = stands[there].get(yours, np.zeros(len(places), bool)) | (
                            reached & allowed[there]
                        )
            if all(
                one.keys() == two.keys() and all((one[k] == two[k]).all() for k in one)
                for one, two in zip(before, stands, strict=True)
            ):
                return any((v & far[0]).any() for v in stands[0].values()) and any(
                    (v & far[1]).any() for v in stands[1].values()
                )


@pytest.mark.parametrize("seed", range(40))
def test_a_straight_crossing_is_as_wide_as_a_search_over_places_says(seed: int) -> None:
    footing, theta, direction = random_case(seed)
    widest = widest_ditch(footing, theta, direction, aside=False)
    search = Search(footing, theta, direction, False, 0.5 * MM)
    assert not search.crosses(widest + 0.1 * MM)
    if widest > 4 * MM:
        assert search.crosses(widest - 4 * MM)


@pytest.mark.parametrize("seed", first_fast(range(100, 130), 10))
def test_a_crossing_is_as_wide_as_a_search_over_places_says(seed: int) -> None:
    footing, theta, direction = random_case(seed)
    widest = widest_ditch(footing, theta, direction)
    search = Search(footing, theta, direction, True, 1.0 * MM)
    assert not search.crosses(widest + 0.1 * MM)
    if widest > 8 * MM:
        assert search.crosses(widest - 8 * MM)


@pytest.mark.parametrize("aside", [False, True])
@pytest.mark.parametrize("guard", [0.0, 0.9])
def test_the_map_repeats_every_sixty_degrees(aside: bool, guard: float) -> None:
    """With the weight in the middle of the frames, as in theirs; an arm to one side counts where balance decides."""
    footing = Footing.of(robot(), guard=guard, weight=Weight(80.0, np.array([0.63, 0.37]), np.zeros(2)))
    widths = ditch_map(footing, np.arange(-17, 48, 2.5) * DEG, np.arange(0, 360, 4) * DEG, aside=aside)
    for k in range(1, 6):
        np.testing.assert_allclose(np.roll(widths, 15 * k, axis=1), widths, atol=1e-9)


def test_within_the_guard_the_arm_at_rest_decides_nothing() -> None:
    thetas, directions = np.arange(-17, 48, 2.5) * DEG, np.arange(0, 360, 4) * DEG
    middle = Footing.of(robot(), weight=Weight(80.0, np.array([0.63, 0.37]), np.zeros(2)))
    np.testing.assert_allclose(
        ditch_map(Footing.of(robot()), thetas, directions), ditch_map(middle, thetas, directions), atol=1e-9
    )


def test_the_straight_map_has_its_known_values() -> None:
    footing = Footing.of(robot())
    assert widest_ditch(footing, 0.0, 0.0, aside=False) / MM == pytest.approx(68.84, abs=0.01)
    assert widest_ditch(footing, 0.0, 30 * DEG, aside=False) / MM == pytest.approx(160.06, abs=0.01)
    assert widest_ditch(footing, 10 * DEG, 35 * DEG, aside=False) / MM == pytest.approx(205.78, abs=0.01)


def test_a_crossing_is_never_wider_than_the_frames_slide_nor_narrower_than_without_sidesteps() -> None:
    footing = Footing.of(robot())
    thetas, directions = np.arange(-17, 48, 3) * DEG, np.arange(0, 60, 3) * DEG
    assert (ditch_map(footing, thetas, directions) >= ditch_map(footing, thetas, directions, aside=False) - 1e-9).all()


def test_outside_the_range_of_angles_no_ditch_is_crossed() -> None:
    assert widest_ditch(Footing.of(robot()), -20 * DEG, 0.5) == 0.0


def test_a_pad_takes_its_width_twice() -> None:
    bare = Footing.of(robot())
    padded = Footing(bare.frames, bare.feet, 5 * MM, bare.weight, bare.guard, bare.margin)
    assert widest_ditch(padded, 0.0, 0.5) == pytest.approx(widest_ditch(bare, 0.0, 0.5) - 10 * MM, abs=1e-9)


# Plans


@pytest.mark.parametrize("seed", first_fast(range(25), 8))
def test_every_slide_of_a_crossing_holds_and_it_ends_behind_the_ditch(seed: int) -> None:
    rng = np.random.default_rng(seed)
    footing = Footing.of(robot(), margin=float(rng.choice([0.0, 20.0])) * MM)
    width = rng.uniform(20, 204) * MM
    found = cross_ditch(
        footing, width, before=0.4, heading=rng.uniform(-math.pi, math.pi), theta=rng.uniform(-15, 40) * DEG,
        aside=bool(seed % 2),
    )  # fmt: skip
    assert found.status == "found", found.reason
    margins = found.replay()
    assert min(one.least for one in margins) >= -1e-9
    assert (footing.feet_at(found.end())[:, :, 0] >= width - 1e-9).all()
    poses = found.start.copy()
    for k, slide in enumerate(found.slides):
        np.testing.assert_allclose(slide.way[0], poses[slide.frame], atol=1e-12)
        poses[slide.frame] = slide.way[-1]
        if k >= found.pivots:  # all turning comes first
            assert np.ptp(slide.way[:, 2]) < 1e-12


@pytest.mark.slow
def test_no_row_of_slides_is_shorter() -> None:
    """Beside a breadth-first search over places of 2 mm."""
    rng = np.random.default_rng(5)
    step, slack = 6.0 * MM, 1e-9  # the slack is for rounding: places of the grid touch limits exactly
    for _ in range(15):
        feet = np.sort(rng.integers(-40, 40, (2, 3)), axis=1)
        width, start = int(rng.integers(4, 20)), np.full(2, -60 - int(rng.integers(0, 10)))
        low, high = -int(rng.integers(5, 16)), int(rng.integers(5, 20))
        row = fewest_slides(
            feet * step, width * step - slack, 0.0, start * step, (low * step - slack, high * step + slack)
        )
        assert (None if row is None else len(row)) == _breadth_first(feet, width, start, low, high)


def _breadth_first(feet: np.ndarray, width: int, start: np.ndarray, low: int, high: int) -> int | None:
    """The slides that it takes from `start` to both frames behind the ditch; all in steps of the grid."""
    allowed = [lambda x, f=f: all(x + one <= 0 or x + one >= width for one in f) for f in feet]
    now, seen = {(int(start[0]), int(start[1]), first) for first in (0, 1)}, set()
    for count in range(100):
        if any(x + feet[0].min() >= width and y + feet[1].min() >= width for x, y, _ in now):
            return count
        after = set()
        for x, y, frame in now:
            for offset in range(low, high + 1):
                there = (y - offset, y, 1) if frame == 0 else (x, x + offset, 0)
                place = there[frame]
                if allowed[frame](place) and place >= start[0] - 83 and there not in seen:
                    seen.add(there)
                    after.add(there)
        now = after
        if not now:
            return None
    return None


def test_where_no_way_leads_over_the_reason_is_told() -> None:
    footing = Footing.of(robot())
    wide = cross_ditch(footing, 0.25, before=0.4)
    assert (wide.status, wide.slides) == ("impossible", ())
    assert "the widest ditch that it crosses at any angle of a grid of 1 deg is 210.2" in wide.reason
    assert "a foot stands in the ditch at the start" in cross_ditch(footing, 0.1, before=0.1).reason
    assert "cannot lie on each other" in cross_ditch(footing, 0.1, before=0.4, theta=1.0).reason
    assert "it cannot pivot where it stands" in cross_ditch(footing, 0.2, before=0.2065).reason


@pytest.mark.parametrize(("what", "value"), [("margin", math.nan), ("margin", -1.0), ("guard", 1.1)])
def test_footing_names_what_means_nothing(what: str, value: float) -> None:
    with pytest.raises(FootingError, match=f"{what} = .*: must be (finite and 0 or more|from 0 to 1)"):
        Footing.of(robot(), **{what: value})
    with pytest.raises(FootingError, match=r"width = -0\.1"):
        cross_ditch(Footing.of(robot()), -0.1, before=0.4)


def test_intervals_are_sets() -> None:
    assert union([(1.0, 2.0), (0.0, 1.0), (3.0, 2.5), (4.0, 5.0)]) == ((0.0, 2.0), (4.0, 5.0))
    assert meet(((0.0, 2.0), (4.0, 5.0)), ((1.0, 4.0),)) == ((1.0, 2.0), (4.0, 4.0))
