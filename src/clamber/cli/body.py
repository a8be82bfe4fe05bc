"""`clamber body`: controls compared on the body of a climber that two limbs hold."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Final

import typer
from rich.console import Console

from ..terminal.name_completion import names_of
from ..terminal.options import AsJson, FlawsChoice, Output, Quiet, takes_options
from ..terminal.output import check_output, print_json, stderr, stdout, tell_written
from ..terminal.worker_options import EndsLine
from .limb.options import MatchChoice, show_table

if TYPE_CHECKING:
    from ..families.climber.trials.body_bench import BodyEntry, BodyMeasures, BodyRun, PushTrial
    from ..families.climber.trials.body_stand import BodyScenario, BodyStand
    from ..sim.limb_flaws import LimbFlaws


@dataclass(frozen=True, slots=True)
class BodyOptions:
    """Options of every command of the body's bench, as they came."""

    controllers: Annotated[
        list[str] | None,
        typer.Option(
            "--controller",
            "-c",
            metavar="NAME",
            help="A law, leg-by-leg:LAW, coordinated, or climber; scct and jacobian-transpose unless given.",
            autocompletion=names_of(besides=("scct", "jacobian-transpose", "coordinated", "climber")),
        ),
    ] = None
    kp: Annotated[str, typer.Option(metavar="X,Y,THETA", help="Of the body, for scct; Table 4.1's.")] = "100,50,10"
    kd: Annotated[str | None, typer.Option(metavar="X,Y,THETA", help="A tenth of --kp unless given.")] = None
    match: Annotated[MatchChoice, typer.Option(help="Other laws hold the body as stiffly as scct in this sense.")] = (
        MatchChoice.diagonal
    )
    mapping: Annotated[str, typer.Option(metavar="NAME", help="From the body to its tips: thesis or kinematic.")] = (
        "thesis"
    )
    limit: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Of the hooks' pulls: none, thesis, counted, shared, feasible; where they are fixed none, else thesis.",
        ),
    ] = None
    alpha: Annotated[
        float | None,
        typer.Option(
            min=0.0,
            help="Least acceleration of a hook along its grab direction [m/s^2] (thesis, 4.4.2); 0 with the limit thesis, else 0.3.",
        ),
    ] = None
    angle: Annotated[
        str,
        typer.Option(metavar="NAME", help="What tells the body's angle: encoder, line (between two tips), second-tip."),
    ] = "encoder"
    encoder: Annotated[bool, typer.Option(hidden=True)] = True
    fixed: Annotated[
        bool | None, typer.Option("--fixed/--hooked", help="Tips fixed to their pegs, or hooked onto them.")
    ] = None
    below: Annotated[str | None, typer.Option(help="How far the body starts below its pegs, such as 15mm.")] = None
    weight_fed: Annotated[float | None, typer.Option(min=0.0, help="Part of the weight that is fed forward.")] = None
    flaws: Annotated[FlawsChoice, typer.Option(help="How far the plant is from ideal.")] = FlawsChoice.nominal
    settings: Annotated[
        list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="One property of the plant.")
    ] = None
    output: Output = None
    as_json: AsJson = False
    quiet: Quiet = False

    def check(self) -> None:
        """Make sure that the picture can be written before anything runs."""
        check_output(self.output)

    def build_stand(self, *, fixed: bool = False, below: str = "15mm", hanging: bool = False) -> "BodyStand":
        """The robot as it is held; the arguments are what counts where nothing is said."""
        from ..families.climber.trials.body_stand import ladder_stand
        from ..units import read_number

        height = read_number("below", self.below or below, "length")
        return ladder_stand(fixed=fixed if self.fixed is None else self.fixed, below=height, hanging=hanging)

    def build_plant(self) -> "LimbFlaws":
        """The plant's properties."""
        from ..families.climber.trials.body_stand import bench_flaws

        return bench_flaws(self.flaws.value, self.settings or ())

    def build_entries(self, stand: "BodyStand") -> "list[BodyEntry]":
        """The controls to compare."""
        from ..errors import UnknownNameError
        from ..families.climber.execution.body_gains import LIMITS, BodyGains, usual_alpha
        from ..families.climber.trials.body_bench import ANGLES
        from ..families.climber.trials.body_entries import make_entries, read_triple

        kp = read_triple("kp", self.kp)
        kd = (kp[0] / 10, kp[1] / 10, kp[2] / 10) if self.kd is None else read_triple("kd", self.kd)
        fed = (1.0 if stand.fixed else BodyGains().weight_fed) if self.weight_fed is None else self.weight_fed
        limit = self.limit or ("none" if stand.fixed else "thesis")
        angle = self.angle if self.encoder else "line"  # --no-encoder, as it was called before
        for kind, name, known in (
            ("mapping", self.mapping, ("thesis", "kinematic")),
            ("limit", limit, LIMITS),
            ("angle", angle, ANGLES),
        ):
            if name not in known:
                raise UnknownNameError(kind, name, tuple(known))
        alpha = usual_alpha(limit) if self.alpha is None else self.alpha
        reference = BodyGains(kp=kp, kd=kd, mapping=self.mapping, limit=limit, alpha=alpha, weight_fed=fed)
        return make_entries(self.controllers or (), reference, stand, self.match.value, angle=angle)


COLUMNS: Final = {
    "radial_rms": ("radial rms\nmm", 1e3, 2),
    "behind_rms": ("off aim rms\nmm", 1e3, 2),
    "x_max": ("x max\nmm", 1e3, 1),
    "y_max": ("y max\nmm", 1e3, 1),
    "turn_max": ("turned max\ndeg", math.degrees(1.0), 2),
    "rest": ("rest off\nmm", 1e3, 1),
    "off_max": ("tip off peg\nmm", 1e3, 1),
}
"""Measure -> title, scale and digits."""
TELLING: Final = {
    "circle": ("radial_rms", "behind_rms", "turn_max"),
    "push-up": ("behind_rms", "x_max", "y_max", "turn_max", "rest", "off_max"),
    "push": ("x_max", "y_max", "turn_max", "rest", "off_max"),
}
"""Scenario -> what tells controls apart."""


def run_bench(words: BodyOptions, stand: "BodyStand", scenario: "BodyScenario", flaws: "LimbFlaws") -> None:
    """Run the controls one by one, write and print what came out, and leave with 0 if no hook came off, else 1."""
    from ..families.climber.trials.body_bench import BodyContest, measure_body, run_bodies

    runs = run_bodies(stand, scenario, words.build_entries(stand), flaws)
    measured = [measure_body(run, scenario) for run in runs]
    if words.output is not None:
        from ..families.climber.pictures.body_plots import draw_bodies

        draw_bodies(runs, scenario, words.output)
    if words.as_json:
        print_json(BodyContest.of(scenario.kind, runs, measured))
    else:
        keys = TELLING[scenario.kind]
        titles = ("control", "Kp", *(COLUMNS[key][0] for key in keys), "hooks")
        rows = [_cells(run, one, keys) for run, one in zip(runs, measured, strict=True)]
        show_table(stdout(), titles, rows, ("control", "Kp", "hooks"))
        tell_written(stdout(), words.output)
    raise typer.Exit(0 if all(one.unhooked_at is None for one in measured) else 1)


def _cells(run: "BodyRun", one: "BodyMeasures", keys: Sequence[str]) -> tuple[str, ...]:
    """A control's row: its gains, its measures, whether its hooks stayed on."""
    gains = run.entry.gains
    whole = ", ".join(f"{value:.4g}" for value in gains.kp)
    kp = f"{gains.leg_kp:.4g} a limb" if gains.scheme == "leg-by-leg" else whole
    hooks = "on" if one.unhooked_at is None else f"off at {one.unhooked_at:.2f} s"
    values = ((getattr(one, key), *COLUMNS[key][1:]) for key in keys)
    told = (
        f"{scale * value:.{digits}f}" if value is not None and math.isfinite(value) else "-"
        for value, scale, digits in values
    )
    return (run.entry.label, kp, *told, hooks)


def print_trials(console: Console, label: str, trials: "Sequence[PushTrial]") -> None:
    """Print what pushes came to."""
    off = [trial for trial in trials if trial.measures.unhooked_at is not None]
    stayed = [trial.measures for trial in trials if trial.measures.unhooked_at is None]
    console.print(f"{label}: hooks stayed on in {len(stayed)} of {len(trials)} pushes")
    if stayed:
        most = max(one.x_max for one in stayed)
        mean = sum(one.x_max for one in stayed) / len(stayed)
        console.print(f"  moved along the push by {1e3 * mean:.1f} mm in the mean, {1e3 * most:.1f} mm at most")
    if off:
        console.print(f"  came off: seeds {', '.join(str(trial.seed) for trial in off[:20])}")


body = typer.Typer(help="Compare controls of a climber's body that two limbs hold.", no_args_is_help=True)


@body.command("circle")
@takes_options
def circle(
    radius: Annotated[str, typer.Option(help="Such as 5cm.")] = "5cm",
    lap: Annotated[float, typer.Option(help="Time of one lap, in seconds.")] = 6.0,
    laps: Annotated[int, typer.Option(min=1, help="The last one is measured.")] = 2,
    *,
    words: BodyOptions,
) -> None:
    """Let the body's aim run round a circle, the tips fixed to their pegs unless --hooked (thesis, Fig. 4.17)."""
    words.check()
    from ..families.climber.trials.body_stand import circle as round_circle
    from ..units import read_number

    flaws = words.build_plant()
    size = read_number("radius", radius, "length")
    stand = words.build_stand(fixed=True, below=f"{size} m")
    run_bench(words, stand, round_circle(stand.pose, flaws.period, radius=size, lap=lap, laps=laps), flaws)


@body.command("push-up")
@takes_options
def push_up(
    height: Annotated[str, typer.Option(help="Such as 7.5cm.")] = "7.5cm",
    seconds: Annotated[float, typer.Option(help="In so many seconds.")] = 0.5,
    *,
    words: BodyOptions,
) -> None:
    """Push the body up on its hooks (thesis, Fig. 4.18)."""
    words.check()
    from ..families.climber.trials.body_stand import push_up as up
    from ..units import read_number

    flaws = words.build_plant()
    stand = words.build_stand()
    way = read_number("height", height, "length")
    run_bench(words, stand, up(stand.pose, flaws.period, height=way, seconds=seconds), flaws)


@body.command("push")
@takes_options
def push(
    force: Annotated[str, typer.Option(metavar="FX,FY", help="At the body's centre.")] = "60N,0N",
    seconds: Annotated[float, typer.Option(help="How long it acts, as half a sine, in seconds.")] = 0.5,
    hanging: Annotated[bool, typer.Option("--hanging", help="One limb holds alone.")] = False,
    trials: Annotated[
        int, typer.Option(min=1, help="More than one: from either side, friction, weight, height and force drawn.")
    ] = 1,
    seed: Annotated[int, typer.Option(min=0, help="Of the first trial.")] = 0,
    *,
    words: BodyOptions,
) -> None:
    """Push the body and let it go: how far it yields, and whether the hooks stay on (thesis, Fig. 4.19)."""
    words.check()
    from ..families.climber.trials.body_bench import push_trials
    from ..families.climber.trials.body_stand import push as pushed
    from ..units import read_point

    flaws = words.build_plant()
    stand = words.build_stand(hanging=hanging)
    size = read_point("force", force, "force")
    if trials == 1:
        run_bench(words, stand, pushed(stand.pose, flaws.period, force=size, seconds=seconds), flaws)
    told = {}
    for entry in words.build_entries(stand):
        with EndsLine(stderr(), f"pushes, {entry.label}", quiet=words.quiet) as line:
            told[entry.label] = push_trials(
                stand, entry, flaws, force=size, seconds=seconds, trials=trials, seed=seed, progress=line.update
            )
    if words.as_json:
        print_json(told)
    else:
        for label, trial in told.items():
            print_trials(stdout(), label, trial)
    stayed = all(one.measures.unhooked_at is None for trial in told.values() for one in trial)
    raise typer.Exit(0 if stayed else 1)
