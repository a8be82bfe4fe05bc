"""Cases of the fuzzer: a command and the files that it reads, all from one number."""

import json
import os
import random
import shutil
import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

import clamber
import fuzz_space
from clamber.cli.app import application, command_of, commands_below
from clamber.planning.genetic.learning import Macro
from clamber.planning.learning import Lesson
from spoiling import CELLS, JUNK, spoil_bytes, spoil_data, spoil_store, spoilt, spoilt_table, toml_file

PACKAGE: Final = Path(clamber.__file__).parent
FEW: Final = ("--evaluations", "5", "--threads", "1", "--no-openings", "--quiet")
SWEEP: Final = (
    *("sweep", "ladder", "--vary", "motor.torque_limit=8Nm..9Nm:2", "--planner", "exact", "--workers", "1"),
    *("--set", "rules.max_hangs=0", "--set", "goal.y_min=15in", "--store", "store.db"),
)

TRIALS: Final = ("trials", "two.json", "-n", "1", "--workers", "1", "--store", "trials.db", "--quiet")
NOWHERE: Final = ("--plant", "tcp://127.0.0.1:1")
"""A plant that nobody serves: a run ends once all that it was given has been read."""


def _words(*lines: str) -> tuple[str, ...]:
    return tuple(word for line in lines for word in line.split())


TASK_KEYS: Final = (
    *_words(
        "start.y step.length step.angle rules.max_hangs rules.hard goal.y_min goal board robot board.rungs motor.torque_limit"
    ),
    *("limbs.right.l1", "board.holds.7.x", "title", "a.b.c", "limbs.0", "", "board.grid", "mass", "."),
)
PLANT_KEYS: Final = (
    *_words(
        "backlash friction damping payload control_rate physics_rate speed_noise model_error encoder_counts delay upright"
    ),
    *("motor_limits", "joint_limits", "colour", ""),
)
LAW_KEYS: Final = _words("kp kd axes forced frame mass weight friction_from scaled feed_gravity admittance_kp x")
NOISE_KEYS: Final = (*_words("friction mass backlash peg usual none delay encoder"), "")
WHOLE: Final = ("0", "-1", "x", "", "1e3", "3", "9" * 20, "nan", "-" + "9" * 20, "٣", "2", "9" * 5000)
REAL: Final = ("0", "-1", "nan", "inf", "-inf", "1e308", "x", "", "0.01", "1e-320", "1e999")
FILES: Final = (
    *_words(
        "x.png x.svg x.csv x.json x.mcap x.toml x.bmp x nowhere/x.png folder folder.json pipe pipe.json two.json log.csv store.db"
    ),
    *_words("/dev/null /dev/stdout /proc/self/mem /dev/zero - link.json circle.json ~nobody/x.toml"),
    *("", "a" * 300 + ".png", "a" * 250 + ".json", "ev\x1b[31mil.svg"),
)
NAMES: Final = (
    *_words("ladder h libra gecko4 hoshino ladder-hand level-walk scct all two.json log.csv nobody x.toml board.csv"),
    *_words("pipe.toml folder.toml /dev/zero ../.."),
    *("", "\x1b[31m", "a" * 300, "a" * 300 + ".toml", "x\ny"),
)
QUICK: Final = tuple(
    line.split()
    for line in (
        "list planners", f"plan ladder {' '.join(FEW)}", "shorten two.json --width 0 --effort 5", "inventory ladder", "check ladder-hand",
        "check libra", "check two.json", "export hoshino -o robot.urdf", "export two.json -o plan.csv",
        "reach ladder --stances 50 --threads 1",
        "limb step -c scct --seconds 0.05", "limb circle -c scct --lap 0.1 --laps 1", "limb open-loop --seconds 0.02",
        "limb push -c scct --from 0.01 --to 0.02 --seconds 0.05", "limb identify log.csv", "new board --random --holds 20 -o board.toml",
        "new robot -o robot.toml", "new task -o task.toml", "new board -o board.toml", "schema plan", "new board --csv board.csv -o b.toml",
    )
)  # fmt: skip
"""Commands that end at once, to which options are added."""
REFUSED: Final = {
    "bench": "nonsense", "study": "nonsense", "calibrate": "--seeds 0", "view": "no-such-task", "plant serve": "--robot nobody",
}  # fmt: skip
"""Commands that would serve or compute for long, and what has them refused; others are given a thing that is not there."""
BRIEF: Final = ("--stances", "50", "--threads", "1")
COMPILED: Final = (
    *(("plan", task, "--planner", "exact", *BRIEF, "--no-openings", "--quiet") for task in ("gap", "patch-walk")),
    *(("reach", task, *BRIEF) for task in ("patch-walk", "patch-gripper")),
    ("follow", "tool.csv", "--dof", "4"),
)
"""Commands whose kernels spoilt files come to: what compiling them takes is not a case's own."""


@dataclass(frozen=True, slots=True)
class Option:
    """An option of a command."""

    flag: str
    kind: str
    """Name of its type."""


def commands() -> dict[tuple[str, ...], tuple[int, tuple[Option, ...]]]:
    """Every command: how many words it takes besides options, and its options."""
    told: dict[tuple[str, ...], tuple[int, tuple[Option, ...]]] = {}
    for path, command in commands_below(command_of(application())):
        if path and not hasattr(command, "commands"):
            given: list[Any] = list(command.params)
            options = tuple(
                Option(one.opts[0], "flag" if getattr(one, "is_flag", False) else str(one.type_descriptor.annotation))
                for one in given
                if one.opts[0].startswith("-") and one.name not in ("install_completion", "show_completion")
            )
            told[path] = (sum(not one.opts[0].startswith("-") for one in given), options)
    return told


COMMANDS: Final = commands()


def prepare(folder: Path, run: Callable[..., int]) -> None:
    """Make the files that are to be spoilt.

    Args:
        folder: Where; the working folder.
        run: Runs a command.
    """
    from clamber.execution.log_files import read_log, write_log
    from clamber.families.climber.execution.executable_plan import climbable
    from clamber.families.climber.planning.plans import thesis_code
    from clamber.planning.problem.plan import Plan
    from clamber.tasks import load_task
    from clamber.viewing.browser.app import check_viser

    task: Any = climbable(load_task("ladder"))  # type: ignore[arg-type]
    codes = [thesis_code(task, number) for number in (300, 3)]
    Plan.of_codes(task, codes).save(folder / "two.json")
    run("limb", "record", "-o", "whole.csv", "--quiet")
    lines = (folder / "whole.csv").read_text().splitlines()
    notes = sum(line.startswith("#") for line in lines)
    (folder / "log.csv").write_text("\n".join(lines[: notes + 900]) + "\n")
    write_log(read_log(folder / "log.csv"), folder / "log.mcap")
    (folder / "board.csv").write_text(
        "x [in],y [in]\n" + "".join(f"{18 * (k % 2)},{6 * (k // 2)}\n" for k in range(40))
    )
    (folder / "path.csv").write_text("x [m],y [m],heading [deg]\n" + "".join(f"{0.1 * k},0,{k}\n" for k in range(20)))
    (folder / "tool.csv").write_text(
        "x [mm],y [mm],z [mm]\n" + "".join(f"{700 + k},{k},{300 - k}\n" for k in range(20))
    )
    lesson(codes).save(folder / "macros.json")
    run("plan", "ladder", *FEW, "--checkpoint", "checkpoint.json")
    run(*SWEEP)
    run("run", "two.json", "-o", "climb.mcap", "--quiet")
    run(*TRIALS)
    write_log(_stood().to_log(), folder / "walk.mcap")
    check_viser()
    for words in (*QUICK, *COMPILED):
        run(*words)
    fuzz_space.prepare_space(folder, run)
    for name in ("robot.toml", "task.toml", "board.toml", "b.toml", "robot.urdf", "plan.csv", "whole.csv", "limb.csv"):
        (folder / name).unlink(missing_ok=True)
    for name in ("folder", "folder.json", "folder.toml"):
        (folder / name).mkdir()
    for name in ("pipe", "pipe.json", "pipe.toml"):
        os.mkfifo(folder / name)
    (folder / "link.json").symlink_to("of-link.json")
    (folder / "circle.json").symlink_to("circle.json")


def lesson(codes: Sequence[int]) -> Lesson:
    """What a climber might have learned, in the form that is read today."""
    macro = Macro(name="m", codes=tuple(map(int, codes)), gain=0.3, starts=3, tried=12, seen=1, from_start=4)
    return Lesson(task="ladder", robot="libra", plans=1, evaluations=1, macros=(macro,))


def _stood() -> Any:
    """The trace of a walker that stands for two seconds."""
    from clamber.execution.sample_log import width
    from clamber.families.walker.execution.walk_trace import WalkTrace, walk_titles

    table = np.zeros((20, width(walk_titles(true=True))))
    table[:, 0] = 0.1 * np.arange(20)
    step = {"number": 1, "frame": "Y", "way": 0.1, "outcome": "ok", "start": 0.5, "off": None, "reason": ""}
    return WalkTrace.from_table(table, {"walk": "slope-walk", "steps": [step, step | {"number": 2, "start": 1.0}]})


def case(number: int, folder: Path) -> tuple[str, ...]:
    """The words of a case, whose files are written into `folder`, which has the files of `prepare`."""
    rng = random.Random(f"case {number}")
    words = rng.choice(RECIPES)(rng, folder)
    return tuple(word.replace("\0", "") for word in words)  # no shell hands these over


def _shipped(rng: random.Random, kind: str, schema: str) -> dict[str, Any]:
    """Data of a shipped file of a kind."""
    files = sorted(PACKAGE.glob(f"families/*/data/{kind}/*.toml"))
    while (data := tomllib.loads(rng.choice(files).read_text()))["schema"] != schema:
        pass
    return data


def _toml(rng: random.Random, folder: Path, data: dict[str, Any], name: str) -> None:
    (folder / name).write_bytes(spoilt(rng, data, toml_file))


def _robot(rng: random.Random, folder: Path) -> list[str]:
    _toml(rng, folder, _shipped(rng, "robots", "clamber-robot-1"), "robot.toml")
    return rng.choice(
        ["check robot.toml", "check robot.toml --json", "export robot.toml -o robot.urdf", "export robot.toml -o robot.xml",
         "new task --robot robot.toml -o task.toml", "check ladder --set robot=robot.toml", "limb step --robot robot.toml --seconds 0.02",
         "new robot --like robot.toml -o other.toml"]
    ).split()  # fmt: skip


def _board(rng: random.Random, folder: Path) -> list[str]:
    _toml(rng, folder, _shipped(rng, "worlds", "clamber-board-1"), "board.toml")
    return rng.choice(
        ["check board.toml", "check ladder --set board=board.toml", "new task --board board.toml -o task.toml",
         f"plan ladder --set board=board.toml {' '.join(FEW)}", "new board --like board.toml -o other.toml"]
    ).split()  # fmt: skip


def _ground(rng: random.Random, folder: Path) -> list[str]:
    _toml(rng, folder, _shipped(rng, "worlds", "clamber-ground-1"), "ground.toml")
    return rng.choice(
        ["check ground.toml", "check slope-walk --set ground=ground.toml", "check ground.toml --json"]
    ).split()


def _task(rng: random.Random, folder: Path) -> list[str]:
    _toml(rng, folder, _shipped(rng, "tasks", "clamber-task-1"), "task.toml")
    return rng.choice(
        ["check task.toml", f"plan task.toml {' '.join(FEW)}", "inventory task.toml", "new task --like task.toml -o other.toml",
         "plan task.toml --planner exact --stances 50 --seconds 3 --threads 1 --no-openings --quiet",
         "reach task.toml --stances 50 --threads 1 -o x.csv"]
    ).split()  # fmt: skip


def _walk(rng: random.Random, folder: Path) -> list[str]:
    files = sorted((PACKAGE / "families/walker/data/walks").glob("*.toml"))
    _toml(rng, folder, tomllib.loads(rng.choice(files).read_text()), "walk.toml")
    return ["check", "walk.toml"]


def _plan(rng: random.Random, folder: Path) -> list[str]:
    data = json.loads((folder / "two.json").read_text())
    (folder / "plan.json").write_bytes(spoilt(rng, data, json.dumps))
    return rng.choice(
        ["check plan.json", "check plan.json --all", "export plan.json -o x.csv", "export plan.json -o x.md", "check plan.json --task h",
         "shorten plan.json --width 0 --effort 5", "validate plan.json -n 1 --set nokey=1", "check plan.json --set start.y=6.2in --json"]
    ).split()  # fmt: skip


def _printed_plan(rng: random.Random, folder: Path) -> list[str]:
    files = sorted((PACKAGE / "families/climber/data/plans").glob("*.toml"))
    _toml(rng, folder, tomllib.loads(rng.choice(files).read_text()), "printed.toml")
    return ["check", "printed.toml", *rng.choice(([], ["--all"], ["--json"]))]


def _macros(rng: random.Random, folder: Path) -> list[str]:
    data = json.loads((folder / "macros.json").read_text())
    (folder / "spoilt.json").write_bytes(spoilt(rng, data, json.dumps))
    return ["plan", rng.choice(("ladder", "ladder", "h", "gecko-climb")), *FEW, "--macros", "spoilt.json"]


def _checkpoint(rng: random.Random, folder: Path) -> list[str]:
    path = folder / "checkpoint.json"
    path.write_bytes(spoilt(rng, json.loads(path.read_text()), json.dumps))
    return ["plan", "ladder", *FEW, "--checkpoint", "checkpoint.json"]


def _store(rng: random.Random, folder: Path) -> list[str]:
    spoil_store(rng, folder / "store.db")
    return [*SWEEP, "--resume"]


def _profile(rng: random.Random, folder: Path) -> list[str]:
    files = sorted((PACKAGE / "planning/genetic/data").glob("*.toml"))
    _toml(rng, folder, tomllib.loads(rng.choice(files).read_text()), "profile.toml")
    return ["plan", "ladder", *FEW, "--profile", "profile.toml"]


def _gains(rng: random.Random, folder: Path) -> list[str]:
    _toml(rng, folder, tomllib.loads((PACKAGE / "control/data/recommended.toml").read_text()), "gains.toml")
    return ["limb", "tune", "-c", "nobody", "--save", "gains.toml"]


def _table(rng: random.Random, folder: Path) -> list[str]:
    kind = rng.choice(("board", "path", "tool", "log", "log"))
    (folder / "table.csv").write_bytes(spoilt_table(rng, (folder / f"{kind}.csv").read_text()))
    way = "way=[{path='table.csv'}]"
    return {
        "board": rng.choice(
            [["check", "table.csv"], ["new", "board", "--csv", "table.csv", "--unit", "in", "-o", "b.toml"],
             ["check", "ladder", "--set", "board=table.csv"],
             ["new", "board", "--pixels", "table.csv", "--scale", "1mm/px", "-o", "b.toml"]]
        ),
        "path": ["check", "level-walk", "--set", way],
        "tool": ["follow", "table.csv", "--dof", "4"],
        "log": rng.choice([["limb", "identify", "table.csv"], ["limb", "identify", "table.csv", "--json"],
                           ["export", "table.csv", "-o", "x.csv"]]),
    }[kind]  # fmt: skip


def _recording(rng: random.Random, folder: Path) -> list[str]:
    (folder / "table.mcap").write_bytes(spoil_bytes(rng, (folder / "log.mcap").read_bytes()))
    return rng.choice(
        ["limb identify table.mcap", "export table.mcap -o x.json", "view table.mcap --save page.html"]
    ).split()


def _run_log(rng: random.Random, folder: Path) -> list[str]:
    from clamber.execution.log_files import read_log, write_log

    kind, beside = rng.choice(
        (("climb", ["two.json"]), ("climb", ["ladder"]), ("climb", []), ("walk", ["slope-walk"]), ("walk", []), ("walk", ["ladder"]))
    )  # fmt: skip
    path = folder / "run.mcap"
    if rng.random() < 0.3:
        path.write_bytes(spoil_bytes(rng, (folder / f"{kind}.mcap").read_bytes()))
    else:
        log = read_log(folder / f"{kind}.mcap")
        columns = {name: values.copy() for name, values in log.columns.items()}
        notes: dict[str, Any] = dict(log.notes)
        if rng.random() < 0.5:
            notes = {name: json.loads(text) for name, text in notes.items()}
            spoil_data(rng, notes)
            notes = {str(name): json.dumps(value) for name, value in notes.items()}
        elif rng.random() < 0.3:
            text = rng.choice(list(notes.values()))
            notes[rng.choice(list(notes))] = spoil_bytes(rng, text.encode()).decode("latin-1")
        else:
            name, rows = rng.choice(list(columns)), rng.choice((slice(None), slice(3, 4), slice(0, 1), slice(-1, None)))
            columns[name][rows] = rng.choice((0.0, -1.0, 0.5, 1e9, -1e9, 1e300, -1e300, 1e-320, 2.0**31, 1e5))
        if rng.random() < 0.1:
            del columns[rng.choice(list(columns))]
        if rng.random() < 0.1:
            few = rng.choice((1, 2))
            columns = {name: values[:few] for name, values in columns.items()}
        write_log(replace(log, columns=columns, notes=notes), path)
    return rng.choice(
        (["view", "run.mcap", *beside, "--save", "page.html"], ["view", *beside, "run.mcap", "--save", "page.html", "--json"],
         ["export", "run.mcap", "-o", "x.csv"])
    )  # fmt: skip


def _shown(rng: random.Random, folder: Path) -> list[str]:
    """Pictures and pages of spoilt files."""
    kinds = {"task.toml": _task, "plan.json": _plan, "walk.toml": _walk, "printed.toml": _printed_plan}
    name = rng.choice(list(kinds))
    kinds[name](rng, folder)
    return rng.choice(
        (["show", name, "-o", "x.png"], ["show", name, "-o", "x.svg", "--step", "1"], ["show", name, "-o", "x.png", "--torques"],
         ["view", name, "--save", "page.html"], ["view", "--task", name, "two.json", "--save", "page.html"])
    )  # fmt: skip


def _carried_out(rng: random.Random, folder: Path) -> list[str]:
    """Spoilt files that are to be carried out, where something refuses that before the robot moves."""
    kinds = {"task.toml": _task, "plan.json": _plan, "walk.toml": _walk, "robot.toml": _robot, "board.toml": _board}
    name = rng.choice(list(kinds))
    kinds[name](rng, folder)
    if name in ("robot.toml", "board.toml"):
        changed = ["two.json", "--set", f"{name[:5]}={name}"]
        return rng.choice((["run", *changed, *NOWHERE], ["trials", *changed, "-n", "1", "--fault", "no-such-fault"]))
    return rng.choice(
        (["run", name, "--set", "nokey=1"], ["trials", name, "-n", "1", "--fault", "no-such-fault"],
         ["run", "two.json", "--task", name, *NOWHERE] if name == "task.toml" else ["run", name, *NOWHERE])
    )  # fmt: skip


def _trials_store(rng: random.Random, folder: Path) -> list[str]:
    store = rng.choice(("trials.db", "trials.db", "trials.db", "store.db"))
    spoil_store(rng, folder / store)
    more = rng.choice((["--resume"], ["--resume", "--json"], ["--replay", "0"], ["--resume", "-o", "x.png"]))
    return [word if word != "trials.db" else store for word in TRIALS] + more


def _junk(rng: random.Random) -> str:
    value = rng.choice((*JUNK, *CELLS, *REAL))
    return value if isinstance(value, str) else json.dumps(value)[:2000]


def _override(rng: random.Random, folder: Path) -> list[str]:
    words = rng.choice(
        (
            ["check", "ladder"],
            ["check", "two.json"],
            ["check", "level-walk"],
            ["plan", "ladder", *FEW],
            ["check", "ladder-hand"],
        )
    )
    for _ in range(rng.choice((1, 1, 2))):
        key = rng.choice(TASK_KEYS) if rng.random() < 0.9 else ".".join(["a"] * 3000)
        words = [*words, "--set", f"{key}={_junk(rng)[:100_000]}"]
    return words


def _law(rng: random.Random, folder: Path) -> list[str]:
    law = rng.choice(("scct", "joint-pd", "hybrid", "operational-space", "nobody"))
    said = ",".join(f"{rng.choice(LAW_KEYS)}={_junk(rng)[:1000]}" for _ in range(rng.choice((1, 2))))
    return ["limb", "step", "--seconds", "0.02", "-c", f"{law}:{said}"]


def _plant(rng: random.Random, folder: Path) -> list[str]:
    value = rng.choice(("1000000000", "1e9Hz", "1MHz", "2deg", "30%", "yes", "400Hz", _junk(rng)[:1000]))
    return ["limb", "step", "--seconds", "0.02", "-c", "scct", "--set", f"{rng.choice(PLANT_KEYS)}={value}"]


def _noise(rng: random.Random, folder: Path) -> list[str]:
    return [
        "trials",
        "two.json",
        "-n",
        "1",
        "--noise",
        f"{rng.choice(NOISE_KEYS)}={_junk(rng)[:1000]}",
        "--set",
        "nokey=1",
    ]


def _quick_with_options(rng: random.Random, folder: Path) -> list[str]:
    words = list(rng.choice(QUICK))
    path = tuple(words[:2]) if tuple(words[:2]) in COMMANDS else tuple(words[:1])
    return [*words, *_options(rng, COMMANDS[path][1])]


def _refused_with_options(rng: random.Random, folder: Path) -> list[str]:
    path = rng.choice(sorted(COMMANDS))
    count, options = COMMANDS[path]
    things = (
        [rng.choice(NAMES) for _ in range(count)]
        if rng.random() < 0.2 and path not in SLOW
        else ["no-such-thing"] * count
    )
    refused = REFUSED.get(" ".join(path), " ".join(things) if count else "--no-such-option").split()
    return [*path, *refused, *_options(rng, options)]


SLOW: Final = frozenset(
    {("run",), ("trials",), ("validate",), ("study",), ("bench",), ("learn",), ("max-setting",),
     ("view",), ("show",), ("sweep",), ("plan",),
     ("shorten",),
     ("limb", "portrait"), ("limb", "tune"), ("limb", "sweep"), ("plant", "serve"), ("follow",), ("reach",)}
)  # fmt: skip
"""Commands that may take long with a thing that is there."""


def _options(rng: random.Random, options: tuple[Option, ...]) -> list[str]:
    words = []
    for option in rng.sample(options, min(len(options), rng.choice((1, 1, 2, 3)))):
        if option.flag in ("--help", "--ray", "--seconds", "--evaluations", "--trials") and rng.random() < 0.9:
            continue
        if option.kind == "flag":
            words.append(option.flag)
            continue
        values = (
            WHOLE
            if "int" in option.kind
            else REAL
            if "float" in option.kind
            else FILES
            if "Path" in option.kind
            else None
        )
        words += [option.flag, rng.choice(values) if values else rng.choice((_junk(rng)[:5000], rng.choice(NAMES)))]
    return words


RECIPES: Final = (
    *(_robot,) * 3, *(_board,) * 3, _ground, *(_task,) * 3, _walk, *(_plan,) * 2, _printed_plan, _macros, _checkpoint, _store, _profile,
    _gains,
    *(_table,) * 3, _recording, *(_override,) * 2, _law, _plant, _noise, *(_quick_with_options,) * 3, *(_refused_with_options,) * 4,
    *(_run_log,) * 2, *(_shown,) * 2, _carried_out, _trials_store, *fuzz_space.RECIPES,
)  # fmt: skip


def copy_files(source: Path, folder: Path) -> None:
    """The files of `prepare` in another folder, pipes and links as such."""
    for path in source.iterdir():
        if path.is_symlink():
            (folder / path.name).symlink_to(os.readlink(path))
        elif path.is_dir():
            (folder / path.name).mkdir()
        elif path.is_file():
            shutil.copyfile(path, folder / path.name)
        else:
            os.mkfifo(folder / path.name)
