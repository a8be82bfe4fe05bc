"""Profiles: every setting of the genetic planner as data, by name."""

from importlib import resources
from pathlib import Path
from typing import Annotated, Final, Literal

from pydantic import Field, StrictBool, StrictStr

from ...errors import UnknownNameError
from ...files import check_schema, read_toml
from ...specs import build_spec, spec

SCHEMA: Final = "clamber-profile-1"
Share = Annotated[float, Field(ge=0.0, le=1.0)]


@spec
class Search:
    """The operators and how strongly each works."""

    population: Annotated[int, Field(strict=True, ge=10, le=1_000_000)]
    replacement: Share
    """Share of every generation that children replace; the others survive."""
    first_length: Annotated[int, Field(strict=True, ge=1, le=10_000)]
    """Most genes of a plan of the first generation."""
    longest: Annotated[int, Field(strict=True, ge=1, le=100_000)]
    """Most actions of a plan."""
    selection: Literal["roulette", "rank"]
    crossover: Literal["tail", "one_point", "two_point"]
    cut_spread: Annotated[float, Field(ge=0.0, le=1000.0)]
    """Spread of cut points about the failure [genes]."""
    mutation: Share
    """Share of children that are mutated."""
    mutation_inserts: StrictBool
    """Whether mutation only inserts a module; else it also replaces and removes."""
    niching: Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
    """Fitness taken off per rank inside a niche (equal goals met, contacts and coarse x); 0 for none."""
    best_prefix: StrictBool
    """Whether a plan counts by its best prefix, and is cut there, rather than at its failure."""
    tail_share: Share
    """Share of children that get a fresh random tail instead of another parent's."""
    tail_length: Annotated[int, Field(strict=True, ge=0, le=10_000)]
    run_length: Annotated[int, Field(strict=True, ge=1, le=1000)]
    """Most repetitions of one body move in fresh genes."""
    patience: Annotated[int, Field(strict=True, ge=0)]
    """Generations without a better plan after which the search starts afresh; 0 for never."""
    configuration_filter: StrictBool
    """Whether a fresh tail starts with a module that is possible there."""
    subgoals: StrictBool
    """Whether the task's sub-goals guide the search; else only its goal counts."""
    learned_macros: StrictBool
    """Whether a repeated sequence of a plan that works becomes a module of its own."""
    polish: Annotated[int, Field(strict=True, ge=0)]
    """Most evaluations spent on shortening the plan after success."""
    beam: Annotated[int, Field(strict=True, ge=0, le=100_000)] = 0
    """Stances kept of each layer of a beam search about the polished plan; 0 for none."""
    windows: Annotated[int, Field(strict=True, ge=0)] = 0
    """Most stances that exact search between and about the stances of the polished plan may see; 0 for none."""


@spec
class Profile:
    """A named set of settings, with the weights of the fitness function (thesis equation 2.1)."""

    name: StrictStr
    title: StrictStr = ""
    search: Search
    weights: dict[StrictStr, Annotated[float, Field(allow_inf_nan=False)]]
    """Feature -> weight; features that a family has and the profile does not name weigh nothing."""


def profile_names() -> tuple[str, ...]:
    """Names of the profiles that come with Clamber."""
    folder = resources.files("clamber.planning.genetic") / "data"
    return tuple(sorted(entry.name.removesuffix(".toml") for entry in folder.iterdir() if entry.name.endswith(".toml")))


def load_profile(name_or_path: str) -> Profile:
    """A profile by name, or from a file.

    Raises:
        UnknownNameError: If it is neither.
        SpecError: If the file breaks a rule of the format.
    """
    path = Path(name_or_path)
    if name_or_path in profile_names():
        path = Path(str(resources.files("clamber.planning.genetic") / "data" / f"{name_or_path}.toml"))
    elif path.suffix != ".toml":
        raise UnknownNameError("profile", name_or_path, profile_names())
    document = read_toml(path)
    check_schema(document, SCHEMA)
    return build_spec(Profile, document, without=("schema",))
