"""Reachable spaces: the compiled flood against a plain one, mirror symmetry, payloads against the judge, printed plans on the map."""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest

import clamber
from clamber.cli import main
from clamber.compiled import kernel
from clamber.errors import PlannerError, UnknownNameError
from clamber.families.climber.planning.arrays import limbed_params
from clamber.families.climber.statics.checks import LIMBED_CHECKS
from clamber.family import Family, families
from clamber.planning.exact.explore import explore
from clamber.planning.problem.check import TICKS
from clamber.planning.problem.codes import pack
from clamber.planning.problem.family_kernels import key
from clamber.planning.problem.loops import replay
from clamber.planning.problem.plan_source import open_replay
from clamber.planning.problem.problem import CompiledProblem
from clamber.planning.problem.problems import normalisation_of, plan_family, pose_problem
from clamber.planning.reach.reach import LAYERS, LayerError, Reach, choose_layer, find_reach, layers_of
from clamber.tasks import Task, load_task
from clamber.viewing.margins import all_limiting
from clamber.viewing.reach_plot import draw_reach

PRINTED = Path(clamber.__file__).parent / "families" / "climber" / "data" / "plans"
NO_HANGS = "rules.max_hangs=0"
NONE = np.array([pack(0)], np.int32)
SMALL = {
    "three rungs": ("ladder", (NO_HANGS, "board.ladder.rungs=3", "goal.y_min=12in", "step.length=6in", "step.angle=45deg")),
    "up and down only": ("modified-ladder", (NO_HANGS, "step.length=3in", 'rules.allowed=["+y","-y","grab","release"]')),
    "kept branches, hook hard": (
        "ladder",
        (
            NO_HANGS, "board.ladder.rungs=3", "goal.y_min=12in", "step.length=6in", "step.angle=90deg",
            'rules.branch="kept"', 'rules.hard=["reach","joint","support","hangs","torque","clearance","hook"]',
        ),
    ),
    "a ring": ("circle", (NO_HANGS, "step.length=6in", "step.angle=90deg")),
    "one hang": ("modified-ladder", ("rules.max_hangs=1", "step.length=12in", 'rules.allowed=["+y","-y","grab","release"]')),
}  # fmt: skip


@kernel
def write_keys(p, stances, words):
    for i in range(stances.shape[0]):
        key(p, stances[i], words[i])


def keys_of(problem: CompiledProblem, stances: np.ndarray) -> np.ndarray:
    words = np.zeros((len(stances), problem.key_words), np.int64)
    write_keys(problem.params.record, stances, words)
    return words


def plain_flood(task: Task) -> tuple[np.ndarray, np.ndarray]:
    """Every reachable stance and its depth, by a dict and `expand`; goals that are met and laps that are counted are wiped out."""
    problem = pose_problem(task, threads=1).problem
    layer, seen, depths, depth = problem.start.copy(), {}, [], 0
    while len(layer):
        layer["stage"] = problem.goals
        layer["laps"] = 0
        fresh = []
        for i, word in enumerate(keys_of(problem, layer)):
            if word.tobytes() not in seen:
                seen[word.tobytes()] = layer[i].copy()
                depths.append(depth)
                fresh.append(i)
        assert len(seen) < 30_000, "the board is not small"
        layer, depth = problem.expand(layer[fresh]).stance if fresh else layer[:0], depth + 1
    return np.array(list(seen.values())), np.array(depths)


@pytest.fixture(scope="module")
def ladder() -> Reach:
    return find_reach(load_task("ladder"), threads=2)


@pytest.mark.parametrize("name", SMALL)
def test_the_flood_sees_what_a_plain_one_sees(name: str) -> None:
    task = load_task(*SMALL[name])
    stances, depths = plain_flood(task)
    reach = find_reach(task, hangs=True, threads=2)
    assert reach.status == "complete"
    assert (reach.stances, reach.steps) == (len(stances), depths.max())
    lattice = np.stack([stances["ix"], stances["iy"], stances["ia"]], axis=1)
    turns = round(math.tau / task.step.angle)
    lattice = np.floor_divide(lattice + TICKS // 2, TICKS) % np.array([1 << 40, 1 << 40, turns])
    lattice[:, :2] -= (lattice[:, :2] > 1 << 39) * (1 << 40)
    assert np.array_equal(np.unique(lattice, axis=0), reach.poses.lattice)
    family = plan_family(task)
    places = {tuple(at): k for k, at in enumerate(reach.places.lattice.tolist())}
    where = np.array([places[tuple(at)] for at in lattice[:, :2].tolist()])
    torques = np.array([family.torque(stance) for stance in stances])
    powers = np.array([family.power(stance) for stance in stances])
    for k in range(len(reach.places)):
        here = where == k
        assert reach.places.columns["stances"][k] == here.sum()
        assert reach.places.columns["first_step"][k] == depths[here].min()
        assert reach.places.columns["angles"][k] == len(np.unique(lattice[here, 2]))
        assert reach.places.floats("least_torque_Nm")[k] == pytest.approx(torques[here].min(), abs=1e-9)
        assert reach.places.floats("most_torque_Nm")[k] == pytest.approx(torques[here].max(), abs=1e-9)
        assert reach.places.floats("least_power_W")[k] == pytest.approx(powers[here].min(), abs=1e-9)
    for h, hold in enumerate(reach.holds):
        on = stances["hold"][:, : len(task.robot.limbs)] == h
        assert hold.stances == on.sum()
        first = {name: depths[on[:, i]].min() for i, name in enumerate(task.robot.limb_names) if on[:, i].any()}
        assert hold.limbs == first


def test_laps_and_goals_multiply_no_stances() -> None:
    board, overrides = SMALL["a ring"]
    plain = find_reach(load_task(board, (*overrides, "subgoals=[]", 'goal={y_min="-90in"}')))
    ring = find_reach(load_task(board, overrides))
    assert plain.stances == ring.stances
    assert plain.goals[-1].stances == plain.stances and plain.goals[-1].first_step == 0


def test_an_exact_search_that_proves_infeasibility_sees_as_many_stances() -> None:
    task = load_task("modified-ladder", (*SMALL["up and down only"][1], "goal.y_min=60in"))
    seen = explore(pose_problem(task).problem, most_stances=100_000)
    reach = find_reach(task)
    assert seen.exhausted and seen.stances == reach.stances and not reach.goal_reached
    assert reach.checks == seen.checks
    assert set(reach.never_used) >= {21, 22}, "the top is out of reach"


@pytest.mark.slow
def test_a_goal_is_first_met_after_as_many_actions_as_the_shortest_plan_has(ladder: Reach) -> None:
    assert ladder.goal_reached and ladder.goals[-1].first_step == 30
    assert ladder.without_hangs and "at most 0 hangs" in ladder.model


def test_the_map_of_a_symmetric_ladder_is_symmetric(ladder: Reach) -> None:
    robot = ladder.task.robot
    right, left, bottom = robot.limbs
    assert (right.port_x, right.port_y, right.end.angle) == (-left.port_x, left.port_y, -left.end.angle)
    assert (right.shoulder.lower, right.shoulder.upper) == (-left.shoulder.upper, -left.shoulder.lower)
    assert bottom.port_x == 0.0
    middle = float(np.mean([hold.x for hold in ladder.task.world.holds]))
    assert ladder.task.start.x == pytest.approx(middle)
    rows = {tuple(at): k for k, at in enumerate(ladder.poses.lattice.tolist())}
    turns = round(math.tau / ladder.task.step.angle)
    mirrored = np.array([rows[-x, y, -a % turns] for x, y, a in ladder.poses.lattice.tolist()])
    assert np.array_equal(ladder.poses.columns["stances"], ladder.poses.columns["stances"][mirrored])
    for column in ("least_torque_Nm", "most_torque_Nm", "most_payload_N", "least_power_W", "margin"):
        values = ladder.poses.floats(column)
        np.testing.assert_allclose(values, values[mirrored], rtol=1e-9, atol=1e-9)


HOOK_HARD = 'rules.hard=["reach","joint","support","hangs","torque","clearance","hook"]'


@pytest.mark.parametrize(
    ("overrides", "precision"),
    [
        ((), 1e-6),
        (('rules.force_rule="min_torque"',), 1e-6),
        (('rules.force_rule="min_norm"', 'rules.limb_in_use="carries"'), 1e-6),
        (("rules.max_power=30W",), 1e-6),
        ((HOOK_HARD, 'rules.hook_cone="60deg"'), 1.1e-3),
    ],
)
def test_the_payload_is_where_the_judge_begins_to_say_no(overrides: tuple[str, ...], precision: float) -> None:
    """Of a robot that is made heavier in its file, some stance of a pose holds a little less, and none a little more."""
    small = (NO_HANGS, "board.ladder.rungs=3", "goal.y_min=12in", "step.length=6in", "step.angle=90deg", *overrides)
    task = load_task("ladder", small)
    stances, _ = plain_flood(task)
    lattice = np.stack([stances["ix"], stances["iy"], stances["ia"]], axis=1) // TICKS
    reach = find_reach(task)
    payloads, weight = reach.poses.floats("most_payload_N"), task.robot.weight
    assert np.ptp(payloads) > weight, "poses differ"
    for k in range(0, len(payloads), max(1, len(payloads) // 12)):
        here = stances[np.all(lattice == reach.poses.lattice[k], axis=1)]
        if payloads[k] < 100.0 * weight:
            assert any(holds_with(small, (weight + payloads[k]) * (1.0 - precision), here))
            assert not any(holds_with(small, (weight + payloads[k]) * (1.0 + precision), here))


def holds_with(overrides: tuple[str, ...], weight: float, stances: np.ndarray) -> list[bool]:
    """Whether stances hold for a robot of another weight, by the problem of that robot."""
    params = limbed_params(load_task("ladder", (*overrides, f"robot.weight={weight:.12g}N")), every_check=False)
    after, margins, reasons = np.zeros(2, stances.dtype), np.zeros((1, len(LIMBED_CHECKS))), np.zeros(1, np.int32)
    found = []
    for i in range(len(stances)):
        replay(params.record, stances[i : i + 1], NONE, True, after, margins, reasons)
        found.append(bool(reasons[0] < 0))
    return found


def test_a_hook_that_only_pulls_carries_less_than_the_motors_do() -> None:
    small = SMALL["three rungs"]
    motors = find_reach(load_task(*small))
    hooks = find_reach(load_task(small[0], (*small[1], HOOK_HARD, 'rules.hook_cone="60deg"')))
    strong = dict(zip(map(tuple, motors.poses.lattice.tolist()), motors.poses.floats("most_payload_N"), strict=True))
    least = [
        (payload, strong[tuple(at)])
        for at, payload in zip(hooks.poses.lattice.tolist(), hooks.poses.floats("most_payload_N"), strict=True)
    ]
    assert all(payload <= 1.001 * most for payload, most in least)
    assert any(payload < 0.9 * most for payload, most in least)


def test_margins_are_shares_of_the_same_yardsticks_as_in_pictures() -> None:
    task = load_task(*SMALL["three rungs"])
    stances, _ = plain_flood(task)
    reach, problem = find_reach(task), pose_problem(task, threads=1).problem
    normalisation = normalisation_of(task)
    best: dict[tuple[int, int], float] = {}
    for stance in stances:
        (limiting,) = all_limiting(normalisation, problem.rebind(problem.actions, np.array([stance])).replay(NONE))
        at = (int(stance["ix"]) // TICKS, int(stance["iy"]) // TICKS)
        assert limiting is not None
        best[at] = max(best.get(at, -1.0), limiting.share)
    found = dict(zip(map(tuple, reach.places.lattice.tolist()), reach.places.floats("margin"), strict=True))
    assert found.keys() == best.keys()
    assert all(found[at] == pytest.approx(best[at], abs=1e-12) for at in best)
    assert set(reach.places.columns["margin_check"]) <= set(task.rules.hard)


def test_every_pose_of_a_printed_plan_without_hangs_is_on_the_map(ladder: Reach) -> None:
    task, printed = open_replay(str(PRINTED / "ladder-hand.toml"), None, ())
    assert printed.ok and task.step == ladder.task.step
    free = np.flatnonzero(np.diff(printed.stances["hangs"], prepend=0) > 0)
    stances = printed.stances[: free[0]] if len(free) else printed.stances
    assert len(stances) > 20
    poses = set(map(tuple, ladder.poses.lattice.tolist()))
    for stance in stances:
        assert (int(stance["ix"]) // TICKS, int(stance["iy"]) // TICKS, int(stance["ia"]) // TICKS) in poses


def test_the_answer_does_not_depend_on_threads() -> None:
    task = load_task(*SMALL["three rungs"])
    for most in (1_000_000, 1_000):
        first, second = ({**find_reach(task, threads=n, max_stances=most).to_json(), "seconds": 0} for n in (1, 3))
        assert first == second


def test_what_was_seen_is_told_when_memory_time_or_patience_end() -> None:
    task = load_task("ladder")
    short = find_reach(task, max_stances=5_000)
    assert (short.status, short.stances) == ("incomplete", 5_000) and "memory" in short.reason
    assert short.places.columns["stances"].sum() == 5_000 and short.closed_by == {} and short.never_used == ()
    assert find_reach(task, seconds=0.0).reason.startswith("out of time")

    def interrupt(*_: int) -> None:
        raise KeyboardInterrupt

    stopped = find_reach(task, progress=interrupt)
    assert stopped.status == "incomplete" and stopped.reason.startswith("interrupted")
    assert stopped.places.columns["stances"].sum() == stopped.stances > 1


@pytest.mark.slow
def test_a_walker_has_a_map_of_margins_and_steps_alone() -> None:
    task = load_task("patch-walk", ("step.length=80mm", "step.angle=30deg"))
    reach = find_reach(task, max_stances=20_000)
    assert reach.status == "incomplete" and reach.holds == () and not reach.without_hangs
    assert set(reach.places.columns) == {"x_m", "y_m", "angles", "stances", "first_step", "margin", "margin_check"}
    with pytest.raises(LayerError, match=r"layer 'force': .*'walker' has no joint torques; allowed are margin, steps"):
        choose_layer(task, "force")


@pytest.mark.parametrize("family", families(), ids=lambda family: str(family.name))
def test_every_family_has_burdens_and_a_world_to_draw(family: Family) -> None:
    assert family.plans.stance_costs is not None and family.pictures is not None


def test_a_map_has_the_layers_that_its_family_has_burdens_for() -> None:
    assert layers_of(load_task("ladder")) == tuple(LAYERS) and layers_of(load_task("patch-walk")) == ("margin", "steps")
    with pytest.raises(UnknownNameError, match=r"no layer is called 'forc'.*did you mean 'force'"):
        choose_layer(load_task("ladder"), "forc")
    with pytest.raises(PlannerError, match=r"rules\.allowed"):
        find_reach(load_task("ladder", ('rules.allowed=["3","191"]',)))


@pytest.mark.parametrize("layer", LAYERS)
def test_every_layer_is_drawn(layer: str, tmp_path: Path) -> None:
    reach = find_reach(load_task(*SMALL["up and down only"]))
    draw_reach(reach, layer, tmp_path / "map.svg")
    drawn = (tmp_path / "map.svg").read_text()
    draw_reach(reach, layer, tmp_path / "map.svg")
    assert drawn == (tmp_path / "map.svg").read_text()


def words_of(name: str) -> list[str]:
    board, overrides = SMALL[name]
    return [board, *(word for text in overrides for word in ("--set", text))]


@pytest.mark.parametrize("name", ["map.png", "map.csv"])
def test_the_command_prints_json_and_writes_a_file(
    name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as left:
        main(["reach", *words_of("up and down only"), "--layer", "power", "--json", "-o", str(tmp_path / name)])
    told = json.loads(capfd.readouterr().out)
    assert left.value.code == 0 and told["status"] == "complete" and not told["goal_reached"]
    assert len(told["places"]["x_m"]) == len(told["places"]["least_power_W"]) > 1
    if name.endswith("png"):
        assert (tmp_path / name).read_bytes().startswith(b"\x89PNG")
    else:
        rows = list(csv.DictReader((tmp_path / name).open()))
        assert len(rows) == told["poses"] and "theta_rad" in rows[0]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["ladder", "--layer", "forc"], "no layer is called 'forc'"),
        (["patch-walk", "--layer", "power"], "has no joint torques"),
        (["ladder", "-o", "/nowhere/map.png"], "the folder /nowhere does not exist"),
        (["ladder", "-o", "map.txt"], "no picture can be written as '.txt'; allowed are .csv, .png, .svg, .pdf"),
    ],
)
def test_bad_input_is_named_before_any_work(words: list[str], message: str, capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as left:
        main(["reach", *words])
    assert left.value.code == 2
    assert message in capfd.readouterr().err


@pytest.mark.long
@pytest.mark.parametrize("board", ["ladder", "modified-ladder", "h", "across", "circle"])
def test_the_five_boards_are_seen_to_the_end(board: str) -> None:
    reach = find_reach(load_task(board, ("step.length=1in", "step.angle=15deg")))
    assert reach.status == "complete" and reach.goal_reached and reach.stances > 100_000
