"""Work that takes long: the part of the panel that plans and runs, beside the page, one piece at a time; it can be told to stop."""

import threading
import time
import traceback
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, Protocol

from ...errors import ClamberError
from ...family import family_of
from ...kernel_cache import is_compiled
from ...planning.planners import PLANNERS
from ...planning.problem.plan import Plan
from ...planning.progress import ProgressEvent, Routing, progress_text
from ...trials.dynamics import RunEvents, RunRequest
from ...trials.work import dynamics_of
from .. import style
from .inputs import set_input
from .panel_html import message_html
from .solids import colour
from .viewer_content import Planned, Scenes

if TYPE_CHECKING:
    import viser


class StoppedError(Exception):
    """The work was told to stop; raised where it next tells how far it is."""


class Tell(Protocol):
    """Hears how far a piece of work is, and ends it by an error once it is to stop."""

    def __call__(self, words: str, share: float | None = None) -> None:
        """Take words, and a share of the whole where that is known [-].

        Raises:
            StoppedError: If the work is to stop.
        """
        ...


class Labour:
    """One piece of work at a time.

    Args:
        told: Is called with words and the share of the whole, from the work's thread.
    """

    def __init__(self, told: Callable[[str, float | None], None]) -> None:
        self._told, self._stop, self._thread = told, threading.Event(), threading.Thread()
        self._lock = threading.Lock()

    @property
    def busy(self) -> bool:
        """Whether a piece of work is under way."""
        return self._thread.is_alive()

    def begin(self, work: Callable[[Tell], Any], done: Callable[[Any], None], failed: Callable[[str], None]) -> bool:
        """Begin a piece of work; False if another is under way.

        Args:
            work: What is to be done; it is handed what it tells its progress to.
            done: Is called with what it returned.
            failed: Is called in its place with the reason, in words, if the work raised an error or was stopped.
        """
        with self._lock:
            if self.busy:
                return False
            self._stop.clear()
            self._thread = threading.Thread(target=self._do, args=(work, done, failed), name="labour", daemon=True)
            self._thread.start()
            return True

    def stop(self, wait: float = 0.0) -> None:
        """Tell the work to stop, and wait for that for some time at most [s]."""
        self._stop.set()
        if wait > 0.0 and self.busy:
            self._thread.join(timeout=wait)

    def _do(self, work: Callable[[Tell], Any], done: Callable[[Any], None], failed: Callable[[str], None]) -> None:
        began, ended = time.monotonic(), threading.Event()
        last: list[tuple[str, float | None]] = []

        def show() -> None:
            words, share = last[-1]
            self._told(f"{words} ({time.monotonic() - began:.0f} s)", share)

        def tell(words: str, share: float | None = None) -> None:
            if self._stop.is_set():
                raise StoppedError
            last[:] = [(words, share)]
            show()

        def go_on() -> None:
            while not ended.wait(TICK):
                if last:
                    show()

        clock = threading.Thread(target=go_on, name="labour's clock", daemon=True)
        clock.start()
        try:
            try:
                made = work(tell)
            finally:
                ended.set()
                clock.join()  # nothing is told any more once the work has ended
            done(made)
        except StoppedError:
            failed("stopped")
        except ClamberError as error:
            failed(str(error))
        except Exception as error:  # a mistake of ours must not take the page with it
            traceback.print_exc()
            failed(f"a mistake in Clamber: {type(error).__name__}: {error}")


TICK: Final = 1.0
"""Between two times that are told of work that says nothing new [s]."""
PLANNER: Final = "auto"
TOLD: Final = 0.2
"""Between two words of a search's progress [s]."""
CHANGED: Final = "the world was changed meanwhile; what came of it as it was is left out: press again"
SECONDS: Final = 60.0
"""Most time for a search, unless the panel says otherwise [s]."""


def make_plan(task: Any, planner: str, seconds: float, tell: Tell, *, reserves: bool) -> Planned:
    """Plan a task as its family does; `seconds` is the most time for each search [s].

    Raises:
        ClamberError: If the planner cannot work on the task, or the start violates a hard check.
    """
    scenes, listener = family_of(task).scenes, _Listener(tell)
    tell(f"planning: looking for any plan{_unless_compiled(scenes)}")
    if reserves:
        return scenes.plan_with_reserves(task, planner, seconds, listener, tell)
    return scenes.plan(task, planner, seconds, listener)


def carry_out(task: Any, plan: Plan | None, tell: Tell) -> Any:
    """Carry a plan, or work that needs none, out in contact dynamics.

    Raises:
        ClamberError: If something speaks against the plan.
    """
    family = family_of(task)
    dynamics = dynamics_of(family)
    tell(f"making the robot ready{_unless_compiled(family.scenes)}")
    return dynamics.run(task, plan, RunRequest(plan_seconds=SECONDS), RunEvents(step=tell))


def _unless_compiled(scenes: Scenes) -> str:
    """What to add where no such robot has moved on this machine: its kernels are compiled, and nothing is told meanwhile."""
    ready = not scenes.kernel or is_compiled(scenes.kernel)
    return "" if ready else "; kernels are compiled, once, which takes a minute or two"


class _Listener:
    """Passes a search's progress on, now and then."""

    def __init__(self, tell: Tell) -> None:
        self._tell, self._last = tell, time.monotonic()

    def __call__(self, moment: ProgressEvent) -> None:
        now = time.monotonic()
        if now - self._last < TOLD:
            return
        self._last = now
        self._tell(progress_text(moment), moment.share if isinstance(moment, Routing) else None)


class WorkPanel:
    """Buttons to plan and to run; work that needs no plan is run only.

    Args:
        server: Whose panel they are in; they are made where its context is.
        task: Gives the task, or the other work, as it is now; raises `ClamberError` if there is none.
        scenes: Of its family.
        plans: Whether it is planned before it is run.
        plan: Gives the plan that a run carries out; None where there is none.
        planned: Takes a plan that was found, with its task.
        ran: Takes a run.
    """

    def __init__(
        self,
        server: "viser.ViserServer",
        task: Callable[[], Any],
        scenes: Scenes,
        plans: bool,
        plan: Callable[[], Plan | None],
        planned: Callable[[Any, Plan], None],
        ran: Callable[[Any], None],
    ) -> None:
        self._task, self._scenes, self._plans = task, scenes, plans
        self._plan, self._planned, self._ran = plan, planned, ran
        self.background_task = Labour(self._tell)
        gui = server.gui
        with gui.add_folder("Plan and run" if plans else "Run"):
            self._planner = gui.add_dropdown("planner", list(PLANNERS), initial_value=PLANNER, visible=plans)
            self._seconds = gui.add_number(
                "seconds",
                SECONDS,
                min=1.0,
                max=3600.0,
                step=1.0,
                hint="Most time for each search",
                visible=plans,
            )
            self._reserves = gui.add_checkbox(
                "reserves",
                scenes.keeps_reserves,
                visible=plans and scenes.keeps_reserves,
                hint="Keep something back, so that the plan can be run; planning takes longer",
            )
            self._plan_button = gui.add_button("Plan", color=colour(style.PARTS[2]), visible=plans)
            self._plan_words = gui.add_html("")
            self._run_button = gui.add_button("Run", color=colour(style.PARTS[0]))
            self._run_words = gui.add_html("")
            self._bar = gui.add_progress_bar(0.0, visible=False)
            self._bar_words = gui.add_html("")
            self._stop_button = gui.add_button("Stop", color=colour(style.ALERT), visible=False)
        self._plan_button.on_click(lambda _: self.plan())
        self._run_button.on_click(lambda _: self.run())
        self._stop_button.on_click(lambda _: self.background_task.stop())

    def plan(self) -> None:
        """Plan the present task."""
        task, planner, seconds = self._task, self._planner.value, float(self._seconds.value)
        reserves = self._reserves.value

        def work(tell: Any) -> tuple[Any, Planned]:
            now = task()
            return now, make_plan(now, planner, seconds, tell, reserves=reserves)

        def done(found: tuple[Any, Planned]) -> None:
            now, answer = found
            if self._is_past(now):
                self._say(self._plan_words, CHANGED, bad=True)
                return
            if answer.plan is not None:
                self._planned(now, answer.plan)
            self._say(self._plan_words, answer.words, bad=answer.plan is None)

        self._begin(work, done, self._plan_words)

    def run(self) -> None:
        """Carry the plan out that there is now."""
        plan = self._plan()
        if self._plans and plan is None:
            self._say(self._run_words, "there is no plan to run; press Plan first", bad=True)
            return

        def work(tell: Any) -> tuple[Any, Any]:
            now = self._task()
            return now, carry_out(now, plan, tell)

        def done(found: tuple[Any, Any]) -> None:
            now, run = found
            if self._is_past(now):
                self._say(self._run_words, CHANGED, bad=True)
                return
            self._ran(run)
            self._say(self._run_words, self._scenes.outcome(run), bad=not run.done)

        self._begin(work, done, self._run_words)

    def clear(self) -> None:
        """Forget what came of earlier work."""
        self._say(self._plan_words, "", bad=False)
        self._say(self._run_words, "", bad=False)

    def _is_past(self, task: Any) -> bool:
        """Whether the world was edited while a task of it was worked on."""
        try:
            return bool(self._task().document != task.document)
        except ClamberError:
            return True

    def _begin(self, work: Callable[[Any], Any], done: Callable[[Any], None], words: "viser.GuiHtmlHandle") -> None:
        def ended(found: Any) -> None:
            done(found)
            self._show_work(False)

        def failed(reason: str) -> None:
            self._say(words, reason, bad=True)
            self._show_work(False)

        if self.background_task.busy:
            self._say(words, "other work is under way; stop it first", bad=True)
            return
        self.clear()
        self._show_work(True)
        self.background_task.begin(work, ended, failed)

    def _show_work(self, under_way: bool) -> None:
        for button in (self._plan_button, self._run_button):
            button.disabled = under_way
        self._bar.visible = self._stop_button.visible = self._bar.animated = under_way
        self._bar_words.content = ""

    def _tell(self, words: str, share: float | None) -> None:
        set_input(self._bar, 100.0 if share is None else 100.0 * min(max(share, 0.0), 1.0))
        self._bar_words.content = message_html(words, bad=False)

    @staticmethod
    def _say(where: "viser.GuiHtmlHandle", words: str, *, bad: bool) -> None:
        where.content = message_html(words, bad=bad)
