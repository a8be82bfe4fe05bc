"""The inventory of a limbed climber: every action module a gene can be, and the named filters that make it smaller without loss."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from ....errors import SpecError
from ....planning.problem.arrays import ActionTable
from ....planning.problem.codes import HOLD, MOVE, NEAREST, NONE, RANDOM, RELEASE, Code, pack
from ....planning.problem.problems import Dropped
from .crowding import most_covered
from .task import LimbedTask

DIRECTIONS: Final = ("+x", "-x", "+y", "-y", "+theta", "-theta")
WORDS: Final = {"none": NONE, "move": MOVE, "release": RELEASE, "nearest": NEAREST, "hold": HOLD, "random": RANDOM}
MOST_RANKS: Final = 9
"""N91 to N99 would be the thesis's last number; N9k goes on to any k under its own name."""


@dataclass(frozen=True, slots=True)
class Module:
    """One entry: an action, or a macro of several."""

    name: str
    codes: tuple[int, ...]

    @property
    def code(self) -> Code:
        """The first action."""
        return Code.of(self.codes[0])

    @property
    def kind(self) -> str:
        """Kind of a single action; "macro" for several."""
        return self.code.kind if len(self.codes) == 1 else "macro"


@dataclass(frozen=True, slots=True)
class Inventory:
    """The modules that are left, and what was dropped and why."""

    modules: tuple[Module, ...]
    full_size: int
    dropped: tuple[Dropped, ...] = ()

    def table(self) -> ActionTable:
        """As arrays, for planners."""
        return ActionTable.build([(module.name, module.codes, module.kind == "move") for module in self.modules])


def module_name(task: LimbedTask, code: int) -> str:
    """A module's name: the thesis's number where it has one (3, 200, 193, 106), words otherwise."""
    opened = Code.of(code)
    limb = opened.limb
    short = len(task.robot.limbs) <= 9
    if opened.kind == "none":
        return "0"
    if opened.kind == "move":
        return str(1 + opened.argument)
    if opened.kind == "release":
        return f"{limb + 1}00" if short else f"{task.robot.limb_names[limb]} releases"
    if opened.kind == "nearest" and short and opened.argument < MOST_RANKS:
        return f"{limb + 1}9{opened.argument}"
    if opened.kind == "random" and short:
        return f"{limb + 1}99"
    if opened.kind == "hold":
        number = task.world.holds[opened.argument].number
        if short and number <= 90:
            return f"{limb + 1}{number:02d}"
        return f"{task.robot.limb_names[limb]} to {number}"
    return f"{task.robot.limb_names[limb]} to nearest {opened.argument}"


def full_inventory(task: LimbedTask, ranks: int) -> tuple[Module, ...]:
    """Every module of Table 2.1: no-op, moves, and per limb release, nearest 1 to `ranks`, random, and each hold by number."""
    codes = [pack(NONE)]
    codes += [pack(MOVE, 0, axis) for axis in range(6)]
    for limb in range(len(task.robot.limbs)):
        codes.append(pack(RELEASE, limb))
        codes += [pack(NEAREST, limb, k) for k in range(1, ranks + 1)]
        codes.append(pack(RANDOM, limb))
        codes += [pack(HOLD, limb, index) for index in range(len(task.world.holds))]
    return tuple(Module(module_name(task, code), (code,)) for code in codes)


def most_in_reach(task: LimbedTask) -> tuple[int, ...]:
    """Most holds that each limb can have within reach at once, wherever its port is (upper bounds: exact for isolated limbs)."""
    points = task.world.positions()
    x, y = np.ascontiguousarray(points[np.argsort(points[:, 1], kind="stable")].T)
    reaches = [limb.length - task.rules.reach_offset + 1e-9 for limb in task.robot.limbs]
    most = {reach: int(most_covered(x, y, reach)) for reach in set(reaches)}
    return tuple(most[reach] for reach in reaches)


def make_inventory(task: LimbedTask, *, filters: bool = True) -> Inventory:
    """The inventory of a task, with the task filters applied or not.

    The filters, in order: `rules` (what `rules.allowed` leaves out), `no_effect` (the no-op), `rank_clip` (N9k beyond the most holds
    that ever lie in reach is N9k with a smaller k), `named_by_rank` (a free hold in reach always has a rank, so NXX and N99 add
    nothing). None of them loses a reachable stance, except that only NXX can put two limbs on one hold (the check `shared`).

    Raises:
        SpecError: If `rules.allowed` names something that is no action.
    """
    ranks = most_in_reach(task)
    modules = full_inventory(task, max(3, *ranks))
    full_size = len(modules)
    dropped: list[Dropped] = []

    def drop(name: str, reason: str, goes: Callable[[Module], bool]) -> None:
        nonlocal modules
        gone = tuple(module.name for module in modules if goes(module))
        if gone:
            dropped.append(Dropped(name, reason, gone))
            modules = tuple(module for module in modules if not goes(module))

    allowed = _allowed(task, modules)
    drop("rules", "not in 'rules.allowed'", lambda module: module.name not in allowed)
    if filters:
        drop("no_effect", "changes nothing", lambda module: module.kind == "none")
        most = f"no limb ever has more than {max(ranks)} holds in reach"
        drop("rank_clip", most, lambda it: it.kind == "nearest" and it.code.argument > ranks[it.code.limb])
        ranked = {module.code.limb for module in modules if module.kind == "nearest"}
        if task.rules.allowed is None or {"nearest", "grab"} & set(task.rules.allowed):
            why = "every free hold in reach is some N9k"
            drop("named_by_rank", why, lambda it: it.kind in ("hold", "random") and it.code.limb in ranked)
    return Inventory(modules, full_size, tuple(dropped))


def _allowed(task: LimbedTask, modules: tuple[Module, ...]) -> set[str]:
    names = {module.name for module in modules}
    if task.rules.allowed is None:
        return names
    out: set[str] = set()
    for word in task.rules.allowed:
        name = word.lstrip("0") or "0"
        kinds = {"nearest", "hold", "random"} if word == "grab" else {word} if word in WORDS else set()
        found = {module.name for module in modules if module.kind in kinds}
        if word in DIRECTIONS:
            found = {str(1 + DIRECTIONS.index(word))}
        elif name in names:
            found = {name}
        if not found:
            raise SpecError(
                task.name,
                "rules.allowed",
                word,
                f"kinds {', '.join(WORDS)}, grab; {', '.join(DIRECTIONS)}; or a number such as 3, 193, 200",
            )
        out |= found
    return out


def whole_kinds(task: LimbedTask) -> tuple[int, bool]:
    """What exact search may do: which body moves, whether limbs may release and grab; and whether that is all that is allowed.

    Returns:
        Bits 0 to 5 for the moves, 6 for releases, 7 for grabs, 8 for grabs of holds that a limb holds, its own or another's (only NXX
        does that; the filter `named_by_rank` drops it where N9k is allowed); False if `rules.allowed` names some grabs or releases only.
    """
    if task.rules.allowed is None:
        return (1 << 8) - 1, True
    modules = full_inventory(task, 3)
    allowed = _allowed(task, modules)
    bits = sum(1 << axis for axis in range(6) if str(1 + axis) in allowed)
    whole = True
    for bit, kinds in ((6, {"release"}), (7, {"nearest", "hold"})):
        by_kind = [{m.name for m in modules if m.kind == kind} for kind in kinds]
        if any(names <= allowed for names in by_kind):
            bits |= 1 << bit
        elif any(names & allowed for names in by_kind):
            whole = False
    nearest, hold = ({m.name for m in modules if m.kind == kind} for kind in ("nearest", "hold"))
    if hold <= allowed and not nearest & allowed:
        bits |= 1 << 8
    return bits, whole
