"""`clamber new`: write files to start from."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from ..family import BUILT_IN, family_named
from ..json_form import Key
from ..tasks.imported import ImportedLimb
from ..terminal.live_line import LiveLine
from ..terminal.name_completion import names_of
from ..terminal.options import BOARD, ROBOT, AsJson, Force, takes_options
from ..terminal.output import check_new, print_json, print_new, stderr
from .commands import read_place

if TYPE_CHECKING:
    from .new_files import NewBoard

new = typer.Typer(help="Write a file to start from: robot, board or task.", no_args_is_help=True)


LIKE: Final = "Start from this one in place of a made-up one."


def _named(kind: str, meaning: str) -> Any:
    """An option for one of these: a shipped one by its name, or a file."""
    return typer.Option(metavar="NAME|FILE", help=meaning, autocompletion=names_of(kind))


@dataclass(frozen=True, slots=True)
class BoardOptions:
    """Options of `clamber new board`, as they came."""

    random: Annotated[bool, typer.Option("--random", help="Holds scattered at random, the same for the same seed.")] = (
        False
    )
    csv: Annotated[Path | None, typer.Option("--csv", metavar="FILE", help="Holds of a table: x, y per line.")] = None
    unit: Annotated[str | None, typer.Option(help="Of that table, such as cm, where its header names none.")] = None
    pixels: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Holds marked in a picture: x, y per line in pixels, y down.")
    ] = None
    scale: Annotated[str | None, typer.Option(help="Size of such a pixel on the wall, such as 3.2mm.")] = None
    origin: Annotated[
        str | None,
        typer.Option(metavar="X,Y", help="Pixel of the board's origin; unless given, left of and below all holds."),
    ] = None
    radius: Annotated[str | None, typer.Option(help="Of holds of a table or a picture, such as 5mm.")] = None
    like: Annotated[str | None, _named("boards", LIKE)] = None
    holds: Annotated[int, typer.Option(help="How many random holds.")] = 100
    density: Annotated[str, typer.Option(help="Holds per m^2, or with a unit, such as '2 holds/ft^2'.")] = "20"
    width: Annotated[str | None, typer.Option(help="Of the wall, such as 3m; as wide as high unless given.")] = None
    least_gap: Annotated[
        str | None,
        typer.Option(help="Least distance of two holds, such as 8cm; half of the mean distance unless given."),
    ] = None
    seed: Annotated[int, typer.Option(min=0, help="Same seed, same board, on any machine.")] = 0
    listed: Annotated[
        bool, typer.Option("--listed", help="List every hold, to edit them, and not how they were scattered.")
    ] = False
    task: Annotated[
        bool, typer.Option("--task", help="Write a task to FILE, to the top of the board, and the board beside it.")
    ] = False
    overrides: Annotated[
        list[str] | None,
        typer.Option(
            "--set", metavar="KEY=VALUE", help="Change one key of that task, such as robot=gecko4 or rules.max_hangs=0."
        ),
    ] = None
    force: Force = False
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="File to write.")] = Path("wall.toml")
    as_json: AsJson = False

    def check(self) -> None:
        """See that they go together."""
        sources = {"--random": self.random, "--csv": self.csv, "--pixels": self.pixels, "--like": self.like}
        given = [name for name, value in sources.items() if value]
        if len(given) > 1:
            raise typer.BadParameter("are different ways to a board; take one", param_hint=", ".join(given))
        for flag, value, way in (
            ("--unit", self.unit, "--csv"),
            ("--scale", self.scale, "--pixels"),
            ("--origin", self.origin, "--pixels"),
        ):
            if value is not None and way not in given:
                raise typer.BadParameter(f"is for {way}", param_hint=flag)
        if self.pixels is not None and self.scale is None:
            raise typer.BadParameter("needs the size of a pixel: --scale 3.2mm", param_hint="--pixels")
        if self.radius is not None and not (self.csv or self.pixels):
            raise typer.BadParameter("is for --csv and --pixels", param_hint="--radius")
        if self.overrides and not self.task:
            raise typer.BadParameter("changes the task; it needs --task", param_hint="--set")

    @property
    def board_file(self) -> Path:
        """Where the board goes: beside its task, if there is one."""
        return self.output.with_name(f"{self.output.stem}-board.toml") if self.task else self.output


@dataclass(frozen=True, slots=True)
class NewRobot:
    """A robot that was written."""

    written: dict[str, str]
    """robot, to the file."""
    name: str
    mass: Annotated[float | None, Key("mass_kg", may_be_missing=True)] = None
    """With `--from` [kg]."""
    limbs: Annotated[tuple[ImportedLimb, ...] | None, Key(may_be_missing=True)] = None
    """With `--from`: limbs that were found."""
    repaired: Annotated[tuple[str, ...] | None, Key(may_be_missing=True)] = None
    """With `--from`: what was changed or guessed, in sentences."""
    dropped: Annotated[tuple[str, ...] | None, Key(may_be_missing=True)] = None
    """With `--from`: what was left out, in sentences."""


@dataclass(frozen=True, slots=True)
class NewTask:
    """A task that was written."""

    written: dict[str, str]
    """task, to the file."""
    name: str
    start: dict[str, Any]
    """The start that was found, as the file has it."""


for _family in BUILT_IN:
    for _kind, _place in family_named(_family).starters.items():
        new.command(_kind)(read_place(_place))


@new.callback()
def _kinds() -> None:
    """Write a file to start from: robot, board or task."""


@new.command("robot")
def robot(
    limbs: Annotated[int | None, typer.Option(min=2, max=8, help="How many limbs; 4 unless given.")] = None,
    like: Annotated[str | None, _named("robots", LIKE)] = None,
    model: Annotated[
        Path | None, typer.Option("--from", metavar="FILE", help="Start from the limbs of this MJCF or URDF model.")
    ] = None,
    force: Force = False,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="File to write.")] = Path("robot.toml"),
    as_json: AsJson = False,
) -> None:
    """Write a robot whose file tells of every key: what it means, its unit, what is allowed."""
    if limbs is not None and (like or model):
        raise typer.BadParameter("is for a made-up robot; take --limbs, --like or --from", param_hint="--limbs")
    if like is not None and model is not None:
        raise typer.BadParameter("are different robots to start from; take one", param_hint="--like, --from")
    check_new(output, force)
    from ..files import write_atomically
    from .starters import imported_robot, robot_starter

    if model is not None:
        with LiveLine(stderr(), quiet=as_json, doing=f"reading {model.name}"):
            found = imported_robot(model, output)
        write_atomically(output, found.text)
        new = NewRobot({"robot": str(output)}, found.name, found.mass, found.limbs, found.repaired, found.dropped)
        lines = [f"robot '{found.name}' of {len(found.limbs)} limbs, {found.mass:.4g} kg"]
        lines += [f"limb {limb.name}: {', '.join(limb.joints)}; tip {limb.tip}" for limb in found.limbs]
        lines += [f"repaired: {line}" for line in found.repaired] + [f"dropped: {line}" for line in found.dropped]
        _tell(new, "\n".join(lines), f"look at each 'guess' in {output}; clamber check {output}", as_json)
        return
    made = robot_starter(output, limbs, like)
    write_atomically(output, made.text)
    told = f"robot '{made.data['name']}'"
    _tell(NewRobot({"robot": str(output)}, made.data["name"]), told, f"clamber check {output}", as_json)


@new.command("board")
@takes_options
def board(*, words: BoardOptions) -> None:
    """Write a board: made up, at random, from a table or a picture; with --task also a task on it that `clamber plan` takes."""
    words.check()
    board_file = words.board_file
    for path in (words.output, board_file):
        check_new(path, words.force)
    from ..files import write_atomically
    from ..toml_text import toml_text
    from .new_files import describe_board, points_data, random_data, task_data
    from .starters import board_starter, board_text

    if words.random:
        data = random_data(words)
    elif words.csv is not None or words.pixels is not None:
        data = points_data(words)
    else:
        data = board_starter(board_file, words.like).data
    text = toml_text(data) if words.random else board_text(data, board_file)
    written = {"board": str(board_file)} | ({"task": str(words.output)} if words.task else {})
    made = describe_board(data, written)
    following = f"clamber check {board_file}"
    if words.task:
        with LiveLine(stderr(), quiet=words.as_json, doing="finding the start"):
            climb = task_data(data, str(board_file), words.output, words.overrides or [])
        comment = "From the lowest stance that the rules allow to the top of the board beside it."
        write_atomically(words.output, toml_text(climb, comment))
        following = f"clamber show {words.output}; clamber plan {words.output} --planner auto"
    write_atomically(board_file, text)
    apart = "" if made.gap_m is None else f", at least {made.gap_m:.4g} m apart"
    _tell(made, f"{made.holds} holds on {made.width_m:.4g} x {made.height_m:.4g} m{apart}", following, words.as_json)


@new.command("task")
def task(
    robot: Annotated[str, _named("robots", "A climber or a robot in space (`clamber list robots`).")] = ROBOT,
    board: Annotated[str, _named("boards", "A board (`clamber list boards`).")] = BOARD,
    world: Annotated[
        str | None, _named("worlds", "In place of a board, of a robot in space (`clamber list worlds`).")
    ] = None,
    like: Annotated[str | None, _named("tasks", "Start from this task; its robot may be any.")] = None,
    overrides: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="Change one key of the task, such as rules.max_hangs=0."),
    ] = None,
    force: Force = False,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="File to write.")] = Path("task.toml"),
    as_json: AsJson = False,
) -> None:
    """Write a task whose file tells of every key: from the lowest stance on a board to its top, or along the guide of a world in space."""
    if world is not None and board != BOARD:
        raise typer.BadParameter("are worlds of different robots; take one", param_hint="--board, --world")
    if like is not None and (overrides or (robot, board, world) != (ROBOT, BOARD, None)):
        raise typer.BadParameter(
            "has a robot, a board and rules of its own: edit them in the file", param_hint="--like"
        )
    check_new(output, force)
    from ..files import write_atomically
    from .starters import task_starter

    with LiveLine(stderr(), quiet=as_json, doing="finding the start"):
        made = task_starter(output, robot, board, like, overrides or [], world)
    write_atomically(output, made.text)
    told = f"task '{made.data['name']}' for robot '{made.data['robot']}'"
    following = f"clamber check {output}; clamber plan {output} --planner auto"
    _tell(NewTask({"task": str(output)}, made.data["name"], made.data["start"]), told, following, as_json)


def _tell(made: "NewBoard | NewRobot | NewTask", told: str, following: str, as_json: bool) -> None:
    if as_json:
        print_json(made)
    else:
        print_new(made.written, told, following)
