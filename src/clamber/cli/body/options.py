"""What the commands of `clamber body` share: options, and how a comparison is run and told."""

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Annotated

import typer

from ...terminal.name_completion import names_of
from ...terminal.options import AsJson, FlawsChoice, Output, Quiet
from ...terminal.output import announce_compilation, check_writable, print_json, stdout

if TYPE_CHECKING:
    from ...families.climber.trials.body_bench import BodyEntry
    from ...families.climber.trials.body_scenario import BodyScenario
    from ...families.climber.trials.body_stand import BodyStand
    from ...sim.limb_flaws import LimbFlaws


class BodyMatchChoice(StrEnum):
    """In which sense gains are made comparable."""

    yy = "yy"
    mean = "mean"
    diagonal = "diagonal"
    none = "none"


@dataclass(frozen=True, slots=True)
class BodyOptions:
    """Options of every command of the body's bench, as they came."""

    controllers: Annotated[
        list[str] | None,
        typer.Option(
            "--controller", "-c", metavar="NAME",
            help="A law, leg-by-leg:LAW, coordinated, or climber; scct and jacobian-transpose unless given.",
            autocompletion=names_of(besides=("scct", "jacobian-transpose", "coordinated", "climber")),
        ),
    ] = None  # fmt: skip
    kp: Annotated[str, typer.Option(metavar="X,Y,THETA", help="Of the body, for scct; Table 4.1's.")] = "100,50,10"
    kd: Annotated[str | None, typer.Option(metavar="X,Y,THETA", help="A tenth of --kp unless given.")] = None
    match: Annotated[
        BodyMatchChoice, typer.Option(help="Other laws hold the body as stiffly as scct in this sense.")
    ] = BodyMatchChoice.diagonal
    mapping: Annotated[str, typer.Option(metavar="NAME", help="From the body to its tips: thesis or kinematic.")] = (
        "thesis"
    )
    limit: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Of the hooks' pulls: none, thesis, counted, shared, feasible; where they are fixed none, else thesis.",
        ),
    ] = None  # fmt: skip
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
        check_writable(self.output)
        if self.output is not None:
            from ...viewing.output import CANVASES, check_suffix

            check_suffix(self.output, CANVASES)

    def build_stand(self, *, fixed: bool = False, below: str = "15mm", hanging: bool = False) -> "BodyStand":
        """The robot as it is held; the arguments are what counts where nothing is said."""
        from ...families.climber.trials.body_stand import ladder_stand
        from ...units import read_number

        height = read_number("below", self.below or below, "length")
        return ladder_stand(fixed=fixed if self.fixed is None else self.fixed, below=height, hanging=hanging)

    def build_plant(self) -> "LimbFlaws":
        """The plant's properties."""
        from ...families.climber.trials.body_stand import bench_flaws

        return bench_flaws(self.flaws.value, self.settings or ())

    def build_entries(self, stand: "BodyStand") -> "list[BodyEntry]":
        """The controls to be compared."""
        from ...errors import UnknownNameError
        from ...families.climber.execution.body_gains import LIMITS, BodyGains, usual_alpha
        from ...families.climber.trials.body_bench import ANGLES
        from ...families.climber.trials.body_entries import make_entries, read_triple

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


def run_bench(words: BodyOptions, stand: "BodyStand", scenario: "BodyScenario", flaws: "LimbFlaws") -> None:
    """Run the controls one by one, write and print what came out, and leave with 0 if no hook came off, else 1."""
    from ...families.climber.trials.body_bench import run_bodies
    from ...families.climber.trials.body_measures import BodyContest, measure_body
    from .text import print_bodies

    announce_compilation(quiet=words.quiet)
    runs = run_bodies(stand, scenario, words.build_entries(stand), flaws)
    measured = [measure_body(run, scenario) for run in runs]
    if words.output is not None:
        from ...families.climber.pictures.body_plots import draw_bodies

        draw_bodies(runs, scenario, words.output)
    if words.as_json:
        print_json(BodyContest.of(scenario.kind, runs, measured))
    else:
        print_bodies(stdout(), runs, measured, scenario)
        if words.output is not None:
            stdout().print(f"written to {words.output}", soft_wrap=True)
    raise typer.Exit(0 if all(one.unhooked_at is None for one in measured) else 1)
