"""What `list`, `show`, `view`, `export`, `study`, `doctor`, `new` and `plant serve` print, and `check` of all but plans."""

from typing import Any, Literal

from pydantic import Field

from .base import Count, Printed


class Entry(Printed):
    """A name, and what it stands for."""

    name: str
    title: str


class Listed(Printed):
    """Names by kind; of one kind alone only that is there."""

    robots: list[Entry] = Field(default=[])
    boards: list[Entry] = Field(default=[])
    grounds: list[Entry] = Field(default=[])
    tasks: list[Entry] = Field(default=[])
    walks: list[Entry] = Field(default=[])
    plans: list[Entry] = Field(default=[])
    planners: list[Entry] = Field(default=[])
    checks: list[Entry] = Field(default=[])
    controllers: list[Entry] = Field(default=[])
    plants: list[Entry] = Field(default=[])
    studies: list[Entry] = Field(default=[])


class Drawn(Printed):
    """A picture that was written."""

    written: str
    """The file."""
    task: str
    steps: Count
    """Actions that it shows."""
    bytes: Count


class Opened(Printed):
    """Printed once the viewer listens."""

    url: str
    title: str


class Saved(Printed):
    """`--save`: a page that was written."""

    written: str
    title: str
    bytes: Count


class Exported(Printed):
    """A file that was written for other programs."""

    written: str
    kind: Literal["robot", "plan", "run"]
    format: str
    """In words."""
    bytes: Count
    notes: list[str]
    """What the reader should know, such as what the format cannot say."""


class Installed(Printed):
    """Clamber itself."""

    version: str
    folder: str


class Python(Printed):
    """The interpreter."""

    version: str
    executable: str


class Machine(Printed):
    """The machine."""

    system: str
    cores: int | None
    memory: int | None
    """[bytes]; null where the system does not tell."""
    memory_free: int | None


class Extension(Printed):
    """What another package adds."""

    kind: str
    name: str
    package: str
    error: str | None


class Kernels(Printed):
    """Compiled kernels."""

    folder: str
    state: Literal["fine", "damaged", "foreign", "unwritable"]
    """foreign: others could have written it; what is not fine is not loaded."""
    problem: str | None
    """Why the folder is not used, so that every command compiles anew."""
    damaged: list[str]
    """Files of it."""
    foreign: list[str]
    """Files of it that others could have written."""
    bounds_checked: bool
    """Whether kernels check every index (CLAMBER_BOUNDSCHECK=1)."""
    compiled: bool
    functions: Count
    bytes: Count
    older_folders: Count
    older_bytes: Count


class Health(Printed):
    """What is installed and what is wrong; exit code 1 where something is."""

    clamber: Installed
    python: Python
    machine: Machine
    required: dict[str, str | None]
    """Package to its version; null: missing."""
    optional: dict[str, dict[str, str | None]]
    """Optional part to its packages."""
    extensions: list[Extension]
    kernels: Kernels
    gl: str | None
    """How a picture can be rendered without a screen."""
    ffmpeg: str | None
    chromium: str | None
    problems: list[str]


class NewBoard(Printed):
    """A board that was written."""

    written: dict[str, str]
    """board, and with --task the task, to the file."""
    name: str
    holds: Count
    width_m: float
    height_m: float
    gap_m: float | None
    """Least distance of two holds."""


class NewRobot(Printed):
    """A robot that was written."""

    written: dict[str, str]
    """robot, to the file."""
    name: str


class NewTask(Printed):
    """A task that was written."""

    written: dict[str, str]
    """task, to the file."""
    name: str
    start: dict[str, Any]
    """The start that was found, as the file has it."""


class PlantTold(Printed):
    """Printed by who has stopped a served robot, or given it back."""

    address: str
    """Of its server."""
    said: str
    """What the server has done."""


class Served(Printed):
    """Printed once the server listens."""

    address: str
    """For `clamber run --plant`."""
    robot: str
    board: str
    real_time: bool
