"""The report that `clamber run --report DIR` writes, whatever robot runs."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...planning.problem.plan import Plan
    from ...trials.run_request import CarriedOut
    from ...viewing.report.pages import Kind


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
            from ...viewing.report.pages import open_report

            open_report(self.folder, kind)

    def of(self, run: "CarriedOut", plan: "Plan | None") -> tuple[Path, ...]:
        """Write that of a run, which may have followed a plan; its page, if there is to be one."""
        if self.folder is None:
            return ()
        from ...viewing.report.run_page import write_run_report

        return (write_run_report(run, plan, self.command, self.folder),)
