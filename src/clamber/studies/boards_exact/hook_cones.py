"""Hooks that can only pull: what that costs in length, and the narrowest cone in which a board can still be climbed."""

from dataclasses import asdict
from typing import Final

import numpy as np

from ...families.climber.pictures.charts import draw_cones
from ...jobs import read_result
from ...planning.problem.problems import pose_problem
from ...types import Json
from ..bevly_1997.printed_plans import limbed_task
from ..result import Cells, Compared, Figure, StudyResult, Table
from .proofs import BOARDS, HARD_HOOKS, KEPT, MODEL, NEVER_HANGS, TOLD, Proof, cone, prove, prove_all, run_all

CONES: Final = (90.0, 75.0, 60.0)
"""Half angles of the cone about the grab direction that a hook takes forces in [deg]."""
FINEST: Final = 0.25
"""How close a cone with a plan and one without come [deg]."""
SHOWN: Final = (45.0, 30.0, 25.0, 20.0, 15.0, 12.0)
"""More cones for the curve [deg]."""
MONOTONE: Final = (
    "What a cone allows, a wider one allows, too, so one boundary parts the cones. At most two legs of LIBRA carry, and the "
    "thesis's forces do not look at the cone. Each cut of the wider cone follows from those of the narrower one, so whatever "
    "sides of all elbows bear a stance in the narrower cone bear it in the wider one, and never fewer are left there. Reach, "
    "clearance and hangs don't look at elbows. So a plan in the narrower cone holds in the wider one, action by action. Every "
    "plan at a narrowest cone was replayed in the cone of 90 deg, too.",
)
"""Why bisection is a proof."""


def hooked(degrees: float) -> tuple[str, ...]:
    """The rules with the check `hook` hard and elbows kept."""
    return (*MODEL, KEPT, HARD_HOOKS, cone(degrees))


def bisect_cone(board: str) -> list[tuple[float, Proof]]:
    """Proofs at the cones that bisection tries, down to two neighbours `FINEST` apart, with a plan and without."""
    tried = {CONES[0]: prove(board, hooked(CONES[0]))}
    without, having = 0, round(CONES[0] / FINEST)
    while having - without > 1:
        middle = (having + without) // 2
        proof = tried[middle * FINEST] = prove(board, hooked(middle * FINEST))
        having, without = (middle, without) if proof.feasible else (having, middle)
    return sorted(tried.items())


def bisect_item(item: Json) -> Json:
    """`bisect_cone` in a worker."""
    return {"tried": [(degrees, asdict(proof)) for degrees, proof in bisect_cone(item["board"])]}


def compare_hooks() -> StudyResult:
    """Shortest plans of the five boards, with the check `hook` off and hard."""
    rules = {"hook off, elbows free": MODEL, "hook off": (*MODEL, KEPT)} | {
        f"{degrees:g} deg": hooked(degrees) for degrees in CONES
    }
    items: list[Json] = [{"name": board, "overrides": chosen} for board in BOARDS for chosen in rules.values()]
    proofs = prove_all(items)
    rows: list[Cells] = []
    for k, board in enumerate(BOARDS):
        mine = proofs[len(rules) * k : len(rules) * (k + 1)]
        lengths = [proof.length for proof in mine]
        rows.append((board, *lengths, _cost(lengths[2], lengths[1]), sum(proof.stances for proof in mine)))
    proved = all(proof.feasible and proof.valid for proof in proofs)
    return StudyResult(
        claim="With hooks that can only pull (the check hook is hard, a limb keeps the side of its elbow while it holds) every board "
        "can still be climbed at cones of 90, 75 and 60 deg; this is what that costs in actions.",
        verdict="holds" if proved else "differs",
        compared=tuple(
            Compared(f"{row[0]}: shortest plan, {words} [actions]", value)
            for row in rows
            for words, value in zip(rules, row[1:], strict=False)
        ),
        deviations=(
            *TOLD,
            NEVER_HANGS,
            "A hook takes any force within so many degrees of its grab direction; 90 deg is any pull, however oblique. "
            "The check lets the two carrying legs press or pull along the line between them as they need to; the torques are still "
            "those of the thesis's split.",
            "'hook off' keeps elbows, too, so the difference to it is what pulling alone costs.",
        ),
        table=Table(("board", *rules, "90 deg costs [actions]", "stances seen in all five"), tuple(rows)),
    )


def narrow_cones() -> StudyResult:
    """Each board's narrowest cone."""
    bisected = run_all(bisect_item, [{"board": board} for board in BOARDS])
    tried = {
        board: {degrees: read_result(Proof, proof) for degrees, proof in told["tried"]}
        for board, told in zip(BOARDS, bisected, strict=True)
    }
    more = [(board, degrees) for board in BOARDS for degrees in (*CONES[1:], *SHOWN) if degrees not in tried[board]]
    for (board, degrees), proof in zip(
        more, prove_all([{"name": board, "overrides": hooked(degrees)} for board, degrees in more]), strict=True
    ):
        tried[board][degrees] = proof
    rows = [_row(board, proofs) for board, proofs in tried.items()]
    ordered = all(
        proofs[wide].feasible or not proofs[narrow].feasible
        for proofs in tried.values()
        for wide in proofs
        for narrow in proofs
        if wide > narrow
    )
    proved = ordered and all(row[4] == "valid" for row in rows)
    return StudyResult(
        claim="The narrowest cone of the hooks in which each board can still be climbed: "
        "a plan there, none in one a quarter of a degree narrower.",
        verdict="holds" if proved else "differs",
        compared=(
            *(Compared(f"{row[0]}: narrowest cone [deg]", row[1]) for row in rows),
            *(Compared(f"{row[0]}: a quarter of a degree narrower", row[6]) for row in rows),
            Compared("cones tried in all", sum(map(len, tried.values()))),
            Compared("no wider cone without a plan where a narrower one has one", "yes" if ordered else "no"),
        ),
        deviations=(*TOLD, NEVER_HANGS, *MONOTONE),
        table=Table(
            (
                "board", "narrowest cone [deg]", "shortest plan there [actions]", "stances seen", "replayed there and at 90 deg",
                "none at [deg]", "why", "it forbids (actions)", "cone [deg]: shortest plan [actions]",
            ),
            tuple(rows),
        ),
        figures=(
            Figure(
                "lengths", "Shortest plan against the cone of the hooks; left of a bar there is no plan.",
                lambda path: draw_cones(
                    {board: {at: proof.length for at, proof in proofs.items()} for board, proofs in tried.items()}, path
                ),
            ),
        ),
    )  # fmt: skip


def _row(board: str, proofs: dict[float, Proof]) -> Cells:
    least = min(degrees for degrees, proof in proofs.items() if proof.feasible)
    below = max(degrees for degrees, proof in proofs.items() if not proof.feasible)
    plan, none = proofs[least], proofs[below]
    valid = plan.valid and holds_at(plan, CONES[0])
    forbids = none.reason.partition("forbidden: ")[2]
    lengths = ", ".join(f"{at:g}: {proof.length or 'none'}" for at, proof in sorted(proofs.items(), reverse=True))
    return (
        board,
        least,
        plan.length,
        plan.stances,
        "valid" if valid else "not valid",
        below,
        none.told,
        forbids or none.reason,
        lengths,
    )


def holds_at(proof: Proof, degrees: float) -> bool:
    """Whether a plan holds and meets every goal with another cone."""
    task = limbed_task(proof.task, (*proof.overrides, cone(degrees)))
    replay = pose_problem(task, threads=1).problem.replay(np.array(proof.codes, np.int32))
    return replay.ok and int(replay.stances["stage"][-1]) == len(task.goals)


def _cost(dearer: int | None, cheaper: int | None) -> int | None:
    return None if dearer is None or cheaper is None else dearer - cheaper
