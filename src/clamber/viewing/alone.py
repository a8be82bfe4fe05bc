"""A robot or a world by itself, without a task: one picture with its facts, or the viewer's page."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import Any, Final

from matplotlib.axes import Axes

from ..family import Family, NotOfFamilyError, families
from ..inspection.finding import Finding
from ..inspection.open_file import family_of_thing, file_kinds, inspect_file, inspect_thing
from ..tasks.robots import build_robot, family_in, read_robot
from ..types import Json
from . import style
from .output import CANVASES, check_suffix, save_figure
from .panel import LINE
from .scene import Bounds
from .style import styled
from .view import Layout, is_wide

WRAPPED: Final = 38
"""Letters of a line of facts."""
WORD: Final = 1.3
"""Where values of facts begin, right of their names [in]."""


@dataclass(frozen=True, slots=True, eq=False)
class Alone:
    """A robot or a world, ready to be drawn."""

    task: Any
    """Stands in for a task: robot and world, nothing to plan."""
    bounds: Bounds
    """The part of the world shown."""
    draw: Callable[[Axes], None]
    """Draws it on axes of world metres, and sets them up."""
    at: Any = None
    """The robot's moment; None: a world without a robot is shown."""


DrawsAlone = Callable[[Any, Json], Alone]
"""Takes a robot or a world, and its document."""


@dataclass(frozen=True, slots=True)
class ShownAlone:
    """A robot or a world that was opened, with what is known of it."""

    alone: Alone
    finding: Finding


def shown_alone(kind: str) -> bool:
    """Whether a kind of file is a robot or a family's world: what is shown without a task."""
    return kind == "robot" or any(family.files.world_key == kind for family in families())


def open_alone(name_or_path: str, kind: str) -> ShownAlone:
    """A robot or a world by its name or file, for pictures and for the viewer.

    Args:
        name_or_path: Its name or file.
        kind: What it is (`inspection.open_file.kind_of`), one that `shown_alone` takes.

    Raises:
        ClamberError: If it breaks a rule of its format.
        NotOfFamilyError: If its family draws none.
    """
    if kind == "robot":
        document = read_robot(name_or_path)
        family, thing = family_in(document), build_robot(document)
    else:
        family = next(family for family in families() if family.files.world_key == kind)
        document, thing = family.files.read_world(name_or_path, None), file_kinds()[kind].load(name_or_path)
    return ShownAlone(_alone(family, kind, thing, document.data), inspect_file(name_or_path, kind))


def alone_of(thing: Any) -> ShownAlone | None:
    """A robot or a world as Python has it, in SI units; None: it is neither.

    Raises:
        NotOfFamilyError: If its family draws none.
    """
    finding = inspect_thing(thing)
    family = family_of_thing(thing)
    if finding is None or family is None or not shown_alone(finding.kind):
        return None
    return ShownAlone(_alone(family, finding.kind, thing, {"family": family.name}), finding)


def _alone(family: Family, kind: str, thing: Any, document: Json) -> Alone:
    draws = family.pictures.robot_alone if kind == "robot" else family.pictures.world_alone
    if draws is None:
        raise NotOfFamilyError(family.title, f"picture of a {kind} alone")
    return draws(thing, document)


def draw_alone(shown: ShownAlone, path: str | Path) -> None:
    """Draw a robot or a world with its facts beside it (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    check_suffix(path, CANVASES)
    finding, bounds = shown.finding, shown.alone.bounds
    rows = [(name, wrap(words, WRAPPED) or [""]) for name, words in finding.facts.items()]
    height = LINE * sum(len(lines) + 0.35 for _, lines in rows)
    with styled():
        layout = Layout(bounds, height if is_wide(bounds) else height + 0.3)
        title = f"{finding.kind.capitalize()} '{finding.name}'"
        figure, world, panel, _ = layout.figure(title, finding.title)
        shown.alone.draw(world)
        y = layout.panel[1]
        for name, lines in rows:
            panel.text(0.0, y, name, fontsize=8, va="top", color=style.QUIET)
            for line in lines:
                panel.text(WORD, y, line, fontsize=8, va="top")
                y -= LINE
            y -= 0.35 * LINE
        layout.fix_panel(panel)
        save_figure(figure, path)
