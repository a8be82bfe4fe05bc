"""The report that `clamber run --report DIR` writes, whatever robot runs."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...families.climber.trials.run_plan import ClimbRun
    from ...families.walker.trials.run_walk import WalkRun
    from ...planning.problem.plan import Plan
    from ...viewing.report.folder import Kind


@dataclass(frozen=True, slots=True)
class RunReport:
    """A report that was asked for, or none."""

    folder: Path | None
    command: str
    """What repeats the run."""

    def open(self, kind: "Kind") -> None:
        """Make its folder before anything runs.

        Raises:
            FileError: If it cannot be made, or holds something else.
        """
        if self.folder is not None:
            from ...viewing.report.folder import open_report

            open_report(self.folder, kind)

    def of_climb(self, run: "ClimbRun") -> tuple[Path, ...]:
        """Write that of a climb; its page, if there is to be one."""
        if self.folder is None:
            return ()
        from ...families.climber.pictures.report import write_climb_report

        return (write_climb_report(run, self.command, self.folder),)

    def of_walk(self, run: "WalkRun", plan: "Plan | None") -> tuple[Path, ...]:
        """Write that of a walk, which may have followed a plan; its page, if there is to be one."""
        if self.folder is None:
            return ()
        from ...families.walker.pictures.report import write_walk_report

        return (write_walk_report(run, plan, self.command, self.folder),)
