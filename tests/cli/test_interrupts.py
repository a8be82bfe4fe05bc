"""Ctrl-C in commands that take long, as a terminal sends it: to a real group of processes that do not ignore it."""

import os
import random
import re
import shlex
import signal
import sqlite3
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import pytest
import typer

from clamber import interrupts
from clamber.cli import main
from clamber.families.climber.execution.climbing import Climbing
from clamber.families.climber.trials.warm_up import warm_up
from clamber.family import family_of
from clamber.tasks import load_task
from clamber.terminal.output import stderr
from clamber.terminal.worker_options import EndsLine, keeping
from clamber.trials.dynamics import RunEvents, RunRequest
from clamber.trials.work import dynamics_of

SCRIPT = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); from clamber.cli import main; main()"
"""A shell that starts a process with "&" has it ignore SIGINT; one in the foreground does not."""
SOON = 2.0
"""How soon after the signal a command has ended [s], on a machine that does nothing else. Where more processes compute than there are
cores, each gets a part of one, and so many times longer it may take: the load of a core, if above 1."""
PYTHON = 0.3
"""Until then Python itself starts, and nothing of ours runs [s]."""
MOMENTS = 10
"""Of each command, drawn between `PYTHON` and `LATEST`, with the command as the seed."""
LATEST = 12.0
ENDED = 0.8
"""One that ends by itself before such a moment, on a fast machine, is interrupted within so much of its time ..."""
SHORTEST = 3.0
"""... which is not below this [s]."""
LONG = (
    "plan gap --set rules.max_hangs=0 --planner genetic --evaluations 100000000 --no-openings",
    "plan circle --planner exact --stances 20000000",
    "plan circle --planner hybrid --stances 20000000",
    "plan circle --planner mcts --checks 1000000000",
    "plan h --to-run",
    "plan wall-gripper --to-run --planner exact",
    "shorten examples/across/plan.json --width 20000",
    "learn circle",
    "run circle",
    "run ladder-hand",
    "run slope-walk",
    "run wall-gripper",
    "trials ladder-hand -n 100",
    "trials wall-gripper -n 100 --workers 1",
    "validate ladder-hand",
    "reach h --hangs",
    "reach wall-gripper",
    "sweep ladder --vary board.spacing=8in..24in:60",
    "study bevly-1997",
    "bench exact seeds",
    "bench boards",
    "bench spatial",
    "bench worlds",
    "bench whole-body",
    "show ladder-hand -o hand.mp4",
    "run gecko-climb",
    "run stones-quadruped -o stones.gif",
    "calibrate --seeds 100",
    "limb tune",
    "limb sweep --vary backlash=0deg..4deg:30",
    "limb step --flaws nominal --trials 400",
    "body push --trials 400",
    "max-setting level-walk --vary payload=10kg..26kg:17",
)
"""At what takes minutes."""
FIRST = (
    "plan circle --planner mcts",
    "plan circle --planner hybrid",
    "plan circle --planner exact --stances 20000000",
    "reach h --hangs",
    "run ladder-hand",
    "run wall-gripper",
    "trials wall-gripper -n 9",
)
"""Before kernels are compiled, of which LLVM works up to 7 s on one."""


@dataclass(frozen=True, slots=True)
class Command:
    """One that runs."""

    process: "subprocess.Popen[str]"
    folder: Path

    @property
    def out(self) -> str:
        return (self.folder / "out").read_text()

    @property
    def err(self) -> str:
        return (self.folder / "err").read_text()

    def wait_for(self, told: str) -> None:
        while re.search(told, self.err) is None:
            assert self.process.poll() is None, self.err
            time.sleep(0.05)

    def interrupt(self, when: str) -> None:
        """Press Ctrl-C: it ends soon with 130, says so, and leaves no process behind."""
        limit = SOON * max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1))
        os.killpg(self.process.pid, signal.SIGINT)
        sent = time.monotonic()
        code = self.process.wait(120)
        took = time.monotonic() - sent
        told = f"interrupted {when}: ended with {code} after {took:.2f} s\n{self.err[-2000:]}"
        assert code == 130 and took < limit, told
        assert "Traceback" not in self.err and "Exception ignored" not in self.err, told
        assert self.err.endswith("clamber: interrupted\n"), told
        while alive(self.process.pid):
            assert time.monotonic() < sent + limit + 5.0, f"processes are left, {told}"
            time.sleep(0.05)


def alive(group: int) -> bool:
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


def interrupted_planner(task: object, seconds: float, **_: object) -> SimpleNamespace:
    """Answers Ctrl-C with the plan that it has, as planners do."""
    with interrupts.Interruptible():
        raise KeyboardInterrupt
    return SimpleNamespace(has_plan=True, plan=None, seconds=seconds)


@contextmanager
def running(words: str, folder: Path, **variables: str) -> Iterator[Command]:
    environment = os.environ | {"COLUMNS": "400"} | variables  # no line is broken
    with (folder / "out").open("w") as out, (folder / "err").open("w") as err:
        process = subprocess.Popen(
            [sys.executable, "-c", SCRIPT, *shlex.split(words)],
            stdin=subprocess.DEVNULL, stdout=out, stderr=err, text=True, env=environment, start_new_session=True,
        )  # fmt: skip
    try:
        yield Command(process, folder)
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


@pytest.mark.long
@pytest.mark.parametrize("words", LONG)
def test_an_interrupt_at_any_moment_ends_it_soon(words: str, tmp_path: Path) -> None:
    drawn, latest, number = random.Random(words), LATEST, 0
    while number < MOMENTS:
        moment = drawn.uniform(PYTHON, latest)
        folder = tmp_path / f"{number} until {latest:.1f} s"
        folder.mkdir()
        with running(words, folder) as command:
            begun = time.monotonic()
            try:
                code = command.process.wait(moment)
            except subprocess.TimeoutExpired:
                command.interrupt(f"after {moment:.2f} s")
                for store in named_stores(command.err):
                    store.unlink()
                number += 1
            else:
                assert code in (0, 1), command.err
                latest = ENDED * (time.monotonic() - begun)
                assert latest > SHORTEST, f"it takes {latest / ENDED:.1f} s: {command.out}"


@pytest.mark.long
@pytest.mark.parametrize("words", FIRST)
def test_an_interrupt_while_kernels_are_compiled_ends_it_soon(words: str, tmp_path: Path) -> None:
    drawn = random.Random(words)
    for number in range(MOMENTS):
        moment, folder = drawn.uniform(PYTHON, LATEST), tmp_path / str(number)
        folder.mkdir()
        with running(words, folder, CLAMBER_CACHE=str(tmp_path / "cache")) as command:
            with pytest.raises(subprocess.TimeoutExpired):
                command.process.wait(moment)
            command.interrupt(f"after {moment:.2f} s")


REGISTERING = """
import os, signal
from types import SimpleNamespace
from numba.core import registry
from numba.core.typing import templates
from clamber import interrupts
from clamber.compiled import kernel

@kernel
def twice(number):
    return 2 * number

signal.signal(signal.SIGINT, signal.default_int_handler)
context = registry.cpu_target.typing_context
context.refresh()
taken = []

def first(context):
    os.kill(os.getpid(), signal.SIGINT)
    taken.append(1)
    return SimpleNamespace(key="first")

def second(context):
    taken.append(2)
    return SimpleNamespace(key="second")

templates.builtin_registry.functions.extend((first, second))
with interrupts.listening():
    try:
        twice(1)
    except KeyboardInterrupt:
        interrupts.answer()
print(twice(2), taken)
"""


@pytest.mark.slow
def test_numba_takes_all_that_is_registered_though_an_interrupt_ends_what_waits_for_it(tmp_path: Path) -> None:
    script = tmp_path / "registering.py"  # Numba reads the source of a kernel
    script.write_text(REGISTERING)
    environment = os.environ | {"CLAMBER_CACHE": str(tmp_path / "cache")}
    ended = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=60, env=environment)
    assert (ended.stdout, ended.returncode) == ("4 [1, 2]\n", 0), ended.stderr


def named_stores(err: str) -> list[Path]:
    """The files in which an interrupted command says that it has kept what had ended, and that are its own."""
    return [path for path in map(Path, re.findall(r"--store (\S+) --resume", err)) if path.parent.name == "unfinished"]


def results_in(store: Path) -> int:
    with sqlite3.connect(store) as file:
        return int(file.execute("SELECT count(*) FROM items WHERE result IS NOT NULL").fetchone()[0])


@pytest.mark.long
@pytest.mark.parametrize(
    ("words", "first"),
    [
        ("sweep ladder --vary board.spacing=12in..24in:60 --workers 1", r"\n[1-9]\d* of 60 points"),
        ("limb sweep --scenario step --vary kp=1000..5000:21 -c scct --workers 1", r"\n[1-9]\d* of 21 points"),
        ("limb tune scct --workers 1", r"\n[1-9]\d* of 10 searches"),
    ],
)
def test_a_batch_that_is_interrupted_goes_on_where_it_was(words: str, first: str, tmp_path: Path) -> None:
    with running(words, tmp_path) as command:
        command.wait_for(first)
        command.interrupt("after the first item")
        (store,) = named_stores(command.err)
        ended = re.search(r"interrupted after (\d+) of", command.err)
        assert ended is not None and results_in(store) >= int(ended[1]) >= 1
    again = tmp_path / "again"
    again.mkdir()
    try:
        with running(f"{words} --store {store} --resume", again) as command:
            command.wait_for(first)
            command.interrupt("after it went on")
            now = re.search(r"interrupted after (\d+) of", command.err)
            assert now is not None and int(now[1]) > int(ended[1])
    finally:
        store.unlink()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "first", "kept"),
    [
        ("study bevly-1997", r"\n4 of 43", r"[1-9]\d* of 43 results: .*\n"),
        ("trials ladder-hand -n 100 --workers 1", r"\n1 of 100", r"of 1 climbs"),
        ("validate ladder-hand -n 2 --noise peg_error=15mm", r"of 2 climbs; 0 changes", r"of 2 climbs before"),
        ("reach h --hangs", r"\d\d\d\d+ stances", r"incomplete: interrupted"),
        ("plan circle --planner exact --stances 20000000", r"\d\d\d\d+ stances", r"bounded: no plan"),
        ("bench control seeds", r"seeds each", r"us  "),
        ("run ladder-hand -o film.gif", r"frame [1-9]", r"not made, as it was interrupted: film.gif"),
    ],
)
def test_what_there_is_is_told(words: str, first: str, kept: str, tmp_path: Path) -> None:
    with running(words, tmp_path) as command:
        command.wait_for(first)
        command.interrupt("on the way")
        assert re.search(kept, command.out), command.out


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "said"),
    [("run ladder", "nothing has moved"), ("plan ladder --to-run", ""), ("run wall-gripper", "nothing has moved")],
)
def test_an_interrupt_while_a_plan_is_searched_for_ends_the_command(words: str, said: str, tmp_path: Path) -> None:
    with running(words, tmp_path) as command:
        command.wait_for("stances")  # compiling may come first
        command.interrupt("in the search")
        assert command.out == "" and said in command.err


@pytest.mark.parametrize("name", ["ladder", "patch-walk", "wall-gripper"])
def test_what_an_interrupted_planner_has_is_not_carried_out(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("clamber.planning.genetic.planner.plan_genetic", interrupted_planner)
    task = load_task(name)
    dynamics = dynamics_of(family_of(task))
    with pytest.raises(KeyboardInterrupt):
        dynamics.run(
            task, None, RunRequest(planner="genetic"), RunEvents(planned=lambda plan: pytest.fail("it has one"))
        )


IN_CALLBACKS = """
import os, signal
from numba.core.codegen import JITCodeLibrary
signal.signal(signal.SIGINT, signal.default_int_handler)
from clamber.cli import main
asked_for = JITCodeLibrary._object_getbuffer_hook
def interrupted(*module):
    os.write(1, b"in LLVM\\n")
    signal.raise_signal(signal.SIGINT)
    return asked_for(*module)
JITCodeLibrary._object_getbuffer_hook = interrupted
main()
"""
"""LLVM asks for machine code that was loaded from the cache by a call back into Python, in which an exception is lost."""


def test_an_interrupt_while_machine_code_is_loaded_leaves_no_kernel_without_code() -> None:
    words = ["plan", "ladder", "--planner", "exact"]
    ended = subprocess.run([sys.executable, "-c", IN_CALLBACKS, *words], capture_output=True, text=True, check=False)
    assert "in LLVM" in ended.stdout, "every kernel was compiled anew: nothing was loaded"
    assert ended.returncode == 130 and ended.stderr.endswith("clamber: interrupted\n"), ended


@pytest.fixture
def listens() -> Iterator[None]:
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    with interrupts.listening():
        yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.slow
@pytest.mark.usefixtures("listens")
def test_an_interrupt_that_was_lost_comes_again_until_it_is_answered() -> None:
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)
    assert interrupts.asked()
    with pytest.raises(KeyboardInterrupt):
        time.sleep(10.0 * interrupts.AGAIN)
    interrupts.answer()
    time.sleep(2.0 * interrupts.AGAIN)  # nothing comes any more
    assert interrupts.asked()


@pytest.mark.usefixtures("listens")
def test_an_interrupt_that_no_caller_could_be_given_is_not_told_but_comes_again(
    capfd: pytest.CaptureFixture[str],
) -> None:
    class Lost:
        def __del__(self) -> None:  # Python can't raise what is raised here
            signal.raise_signal(signal.SIGINT)

    lost = Lost()
    with pytest.raises(KeyboardInterrupt):
        del lost
        time.sleep(10.0 * interrupts.AGAIN)
    interrupts.answer()
    assert capfd.readouterr().err == ""


@pytest.mark.usefixtures("listens")
def test_parts_of_a_whole_do_not_answer_but_pass_it_on() -> None:
    with pytest.raises(KeyboardInterrupt), interrupts.passed_on():
        try:
            signal.raise_signal(signal.SIGINT)
        except KeyboardInterrupt:
            interrupts.answer()
    with pytest.raises(KeyboardInterrupt):  # nobody has answered
        time.sleep(10.0 * interrupts.AGAIN)
    interrupts.answer()


@pytest.mark.usefixtures("listens")
def test_a_climb_that_only_warms_up_does_not_take_an_interrupt_for_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run answers Ctrl-C with its report: of one action climbed for nothing nobody reads it, and the command went on."""
    monkeypatch.setattr(Climbing, "begin", lambda climbing: signal.raise_signal(signal.SIGINT))
    warm_up.cache_clear()
    with pytest.raises(KeyboardInterrupt):
        warm_up()
    interrupts.answer()


def test_a_contest_ends_with_an_interrupt_that_a_planner_would_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    def contest(**_: object) -> None:
        try:
            raise KeyboardInterrupt
        except KeyboardInterrupt:  # as planners do, which then answer with what they have
            interrupts.answer()
        raise AssertionError("it went on")

    monkeypatch.setattr("clamber.benchmarks.contest.run_contest", contest)
    with pytest.raises(SystemExit) as left:
        main(["bench", "boards"])
    assert left.value.code == 130


@pytest.mark.usefixtures("listens")
def test_a_long_call_answers_and_raises_as_if_it_had_no_thread_of_its_own() -> None:
    assert interrupts.abandonable(lambda: 3) == 3
    with pytest.raises(ZeroDivisionError):
        interrupts.abandonable(lambda: 1 // 0)


@pytest.mark.usefixtures("listens")
def test_a_long_call_is_left_behind_and_ends_by_itself() -> None:
    hold, held = threading.Event(), threading.Event()

    def work() -> None:
        signal.raise_signal(signal.SIGINT)
        hold.wait()
        held.set()

    with pytest.raises(KeyboardInterrupt):
        interrupts.abandonable(work)
    interrupts.answer()
    assert interrupts.left_behind()
    hold.set()
    assert held.wait(10.0)


@pytest.mark.usefixtures("listens")
def test_a_thread_that_waits_for_a_long_call_leaves_it_behind_too() -> None:
    hold, begun = threading.Event(), threading.Event()

    def work() -> None:
        begun.set()
        hold.wait()

    with ThreadPoolExecutor(1) as pool:
        waits = pool.submit(interrupts.abandonable, work)
        assert begun.wait(10.0)
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        interrupts.answer()
        with pytest.raises(KeyboardInterrupt):
            waits.result(10.0)
    hold.set()


AT_A_LINE = """
import itertools, signal, sys, time
from clamber import interrupts

def interrupting(line):
    lines = itertools.count(1)
    def trace(frame, event, argument):
        if event == "line" and next(lines) == line:
            signal.raise_signal(signal.SIGINT)
        return trace
    return trace

signal.signal(signal.SIGINT, signal.default_int_handler)
for line in itertools.count(1):
    with interrupts.listening():
        sys.settrace(interrupting(line))
        try:
            interrupts.abandonable(lambda: time.sleep(0.01))
        except KeyboardInterrupt:
            interrupts.answer()
        else:
            break
        finally:
            sys.settrace(None)
print(line)
"""


def test_an_interrupt_at_any_line_of_a_wait_for_a_long_call_ends_it() -> None:
    """`threading.Event` locks whoever is interrupted while it holds the own lock of the event; so would the start of a `Thread`."""
    ended = subprocess.run([sys.executable, "-c", AT_A_LINE], capture_output=True, text=True, timeout=60, check=False)
    assert ended.returncode == 0 and int(ended.stdout) > 10, ended.stderr


COMPILED_LATE = """
import signal
from clamber import interrupts
from clamber.compiled import kernel

@kernel
def twice(number):
    return 2 * number

@kernel
def thrice(number):
    return 3 * number

signal.signal(signal.SIGINT, signal.default_int_handler)
with interrupts.listening():
    print(twice(1))
    try:
        signal.raise_signal(signal.SIGINT)
    except KeyboardInterrupt:
        interrupts.answer()
    print(twice(2))
    try:
        thrice(1)
    except KeyboardInterrupt:
        print("not compiled")
"""


@pytest.mark.slow
def test_after_an_interrupt_kernels_are_used_and_none_is_compiled(tmp_path: Path) -> None:
    script = tmp_path / "late.py"
    script.write_text(COMPILED_LATE)
    environment = os.environ | {"CLAMBER_CACHE": str(tmp_path / "cache")}
    ended = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=60, env=environment)
    assert (ended.stdout, ended.returncode) == ("2\n4\nnot compiled\n", 0), ended.stderr


@pytest.mark.parametrize("ended", [0, 2])
def test_a_batch_has_a_file_of_its_own_that_stays_where_something_in_it_would_be_lost(
    ended: int, capfd: pytest.CaptureFixture[str]
) -> None:
    with keeping(None, EndsLine(stderr(), "points", quiet=False)) as whole:
        assert whole.store is not None
        whole.store.touch()
    assert not whole.store.exists()
    with pytest.raises(typer.Exit) as left, keeping(None, EndsLine(stderr(), "points", quiet=True)) as batch:
        assert batch.store is not None
        batch.store.touch()
        for each in range(ended):
            batch.line.update(each + 1, 5)
        raise KeyboardInterrupt
    told = " ".join(capfd.readouterr().err.split())
    assert left.value.exit_code == 130
    assert batch.store.exists() is (ended > 0)
    if ended:
        assert (
            f"interrupted after 2 of 5 points; they are kept, and this goes on with them: --store {batch.store}" in told
        )
        batch.store.unlink()
    else:
        assert "interrupted before any of the points had ended" in told


def test_an_interrupt_after_all_is_told_changes_nothing() -> None:
    late = "import atexit, os, signal; atexit.register(os.kill, os.getpid(), signal.SIGINT); from clamber.cli import main; main()"
    ended = subprocess.run([sys.executable, "-c", late, "list", "robots"], capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (0, "") and "libra" in ended.stdout
