"""The shortest and the easiest plan of every board, proved and replayed."""

from pathlib import Path
from typing import Final

from ...types import Json
from ...units import OZ_IN
from ..bevly_1997.printed_plans import H_START, replay_printed
from ..result import Compared, Figure, StudyResult, Table, Value
from .proofs import BOARDS, MODEL, NEVER_HANGS, TOLD, Proof, prove_all

PRINTED: Final[dict[str, tuple[str, str, tuple[str, ...]]]] = {
    "ladder": ("ladder-hand", "Table D.1, by hand, 3 in steps", ()),
    "modified-ladder": ("modified-ladder-ga", "Table 2.3, genetic, ends at 45 of 60 in", ()),
    "h": ("h-ga", "Table 2.4, genetic", H_START),
    "across": ("across-hand", "Table D.3, by hand", ()),
    "circle": ("circle-hand", "Table D.4, by hand", ()),
}
"""Board -> the printed plan, what it is, and what its task needs."""
COARSE: Final = ("step.length=3in", *MODEL[1:])
BARE_H: Final = (
    *COARSE,
    "subgoals=[]",
    'goal={name="upper right",x_min="44.9in",x_max="45.1in",y_min="47.9in",y_max="48.1in"}',
)
"""H in 3 in steps, without sub-goals, its goal within 0.1 in."""
ORDERS: Final = (("length",), ("length", "torque"), ("torque", "length"))


def prove_optima() -> StudyResult:
    """Best plans of the five boards, by length and by torque."""
    items: list[Json] = [{"name": board, "overrides": MODEL, "minimize": order} for board in BOARDS for order in ORDERS]
    items += [{"name": "ladder", "overrides": COARSE}, {"name": "h", "overrides": BARE_H}]
    proofs = prove_all(items)
    *_, ladder, bare = proofs
    rows: list[tuple[Value, ...]] = []
    by_board: dict[str, tuple[Proof, ...]] = {}
    for k, board in enumerate(BOARDS):
        short, gentle, easy = by_board[board] = tuple(proofs[len(ORDERS) * k : len(ORDERS) * (k + 1)])
        file, what, overrides = PRINTED[board]
        printed = replay_printed(file, overrides).verdict
        rows.append(
            (board, short.length, short.stances, *_loads(gentle), easy.length, *_loads(easy), printed.length, what)
        )
    proved = all(proof.feasible and proof.valid for proof in proofs)

    def route(path: Path) -> None:
        from ...viewing.pictures import draw_route

        shown = by_board["h"][1]
        draw_route(shown.load(), shown.replay(), path)

    return StudyResult(
        claim="The shortest plan of every board, proved by exact search and replayed without it; "
        "of the shortest, the one that loads the joints least; and of those that load them least, the shortest.",
        verdict="holds" if proved else "differs",
        compared=(
            *(Compared(f"{row[0]}: shortest plan [actions]", row[1], f"{row[8]} ({row[9]})") for row in rows),
            Compared("ladder, 3 in steps: shortest plan [actions]", ladder.length, "63 (Table D.1, by hand)"),
            Compared("h, 3 in steps, goal within 0.1 in, no sub-goals: shortest plan [actions]", bare.length, "69 (Table D.2, by hand)"),
            Compared("plans that hold when replayed, and meet every goal", sum(bool(proof.valid) for proof in proofs), None),
            Compared("plans", len(proofs)),
        ),
        deviations=(
            *TOLD,
            NEVER_HANGS,
            "Column 'printed' is a plan of the thesis, not a claim that it is shortest; printed plans may hang, and some end elsewhere.",
            "Torque is the largest of any joint and stance, the start included; energy is holding power times an assumed second an action.",
        ),
        table=Table(
            (
                "board", "shortest [actions]", "stances seen", "least torque at that length [oz-in]", "its energy [J]",
                "shortest of least torque [actions]", "least torque [oz-in]", "its energy [J]", "printed plan [actions]", "which",
            ),
            tuple(rows),
        ),
        figures=(Figure("h-route", "H: of the shortest plans the one of least torque.", route),),
    )  # fmt: skip


def _loads(proof: Proof) -> tuple[Value, Value]:
    return (None, None) if proof.torque is None else (proof.torque / OZ_IN, proof.energy)
