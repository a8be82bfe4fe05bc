"""Ctrl-C in commands that take long, as a terminal sends it: to a real process that does not ignore it."""

import signal
import subprocess
import sys

import pytest

SCRIPT = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); from clamber.cli import main; main()"
"""A shell that starts a process with "&" has it ignore SIGINT; one in the foreground does not."""


@pytest.mark.parametrize(
    ("words", "said"), [(("run", "ladder"), "nothing has moved"), (("plan", "ladder", "--to-run"), "")]
)
def test_an_interrupt_while_a_plan_is_searched_for_ends_the_command(words: tuple[str, ...], said: str) -> None:
    command = [sys.executable, "-c", SCRIPT, *words]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None and process.stderr is not None
        told = process.stderr.readline()
        while "stances" not in told:  # compiling may come first
            assert told, "it ended before it searched"
            told = process.stderr.readline()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
    assert process.returncode == 130
    assert out == "" and said in err and "Traceback" not in err
