"""The options of `clamber trials`."""

from dataclasses import dataclass
from typing import Annotated

import typer

from ..options import PLAN_SECONDS, CarriedOutIn, NoiseTexts, Overrides, PlannerName, PlanSeconds, Replan


@dataclass(frozen=True, slots=True)
class TrialsWords:
    """Options of `clamber trials`, as they came: what is carried out, and how often."""

    n: Annotated[int, typer.Option("-n", min=1, help="How many climbs.")] = 24
    seed: Annotated[int, typer.Option(min=0, help="Of the first climb; each further one has the next.")] = 0
    noise: NoiseTexts = None
    task: CarriedOutIn = None
    planner: PlannerName = "auto"
    seconds: PlanSeconds = PLAN_SECONDS
    overrides: Overrides = None
    replan: Replan = True
    force: Annotated[bool, typer.Option("--force", help="Carry out a plan that its checks refuse.")] = False
    at_least: Annotated[
        str | None, typer.Option(help="Leave with 0 only if success is at least this with 97.5 % confidence.")
    ] = None
    replay: Annotated[
        int | None, typer.Option(min=0, metavar="SEED", help="Climb this one trial again, for -o a log or a picture.")
    ] = None

    @property
    def seeds(self) -> range:
        """One trial each."""
        return range(self.seed, self.seed + self.n)

    @property
    def least(self) -> float | None:
        """Share of success that is asked for with confidence; None: all are to succeed.

        Raises:
            BadParameter: If it is no share.
        """
        if self.at_least is None:
            return None
        from ...units import parse_quantity

        share = parse_quantity(self.at_least, "ratio")
        if not 0.0 <= share <= 1.0:
            raise typer.BadParameter(f"{self.at_least} must be 0 to 100 %", param_hint="--at-least")
        return share
