"""Playback: a clock, and the controls that set it: play and pause, speed, a time bar, and the list of steps."""

import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from .. import style
from ..recording import Recording
from .inputs import by_hand, set_input
from .solids import colour

if TYPE_CHECKING:
    import viser

PERIOD: Final = 1.0 / 30.0
"""Between two pictures in play [s]."""
BAR_PERIOD: Final = 0.12
"""Between two moves of the time bar while it plays [s]."""
SPEEDS: Final = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0)
LISTED: Final = 5
"""Steps that the list shows at once."""
SHADES: Final = (style.ALERT, "#D98324", "#8FA9BD", "#6C93B5")
"""Of the list's buttons by the grade of their step: those of the strip, dark enough for white letters."""
Show = Callable[[Recording[Any], float], None]
"""Shows a moment of a film."""


class Playback:
    """Shows a film by its own clock.

    Args:
        server: Whose panel has the controls; they are made where its context is.
        show: Is called with the film and the time whenever either changes, never from two threads at once.
        film: What is played first.
    """

    def __init__(self, server: "viser.ViserServer", show: Show, film: Recording[Any]) -> None:
        self._show, self._lock, self._stopped = show, threading.RLock(), threading.Event()
        self.film, self.time, self.playing = film, 0.0, False
        self._bar_moved = 0.0
        gui = server.gui
        self._play = gui.add_button("Play", color=colour(style.PARTS[0]), hint="Space")
        self._jumps = gui.add_button_group("", ("|◀", "◀ step", "step ▶", "worst"))
        self._bar = gui.add_slider("time [s]", 0.0, 1.0, 0.01, 0.0)
        self._speed = gui.add_dropdown("speed", [f"{speed:g} ×" for speed in SPEEDS], initial_value=f"{film.speed:g} ×")
        self.below = gui.add_folder("Steps")
        with self.below:
            self._list = [gui.add_button(" ", visible=False) for _ in range(LISTED)]
        self._first = 0
        self._play.on_click(lambda _: self.toggle())
        self._jumps.on_click(lambda event: self._jump(event.target.value))
        self._bar.on_update(by_hand(self._bar_dragged))
        for row, button in enumerate(self._list):
            button.on_click(self._jumper(row))
        gui.add_command("Play or pause", hotkey="P").on_trigger(lambda _: self.toggle())
        gui.add_command("One step on", hotkey="N").on_trigger(lambda _: self.jump(self.step + 1))
        gui.add_command("One step back", hotkey="B").on_trigger(lambda _: self.jump(self.step - 1))
        self.load(film)
        self._thread = threading.Thread(target=self._work, name="playback", daemon=True)
        self._thread.start()

    @property
    def step(self) -> int:
        """The step that is shown."""
        return self.film.step_at(self.time)

    def load(self, film: Recording[Any], at: float = 0.0) -> None:
        """Take another film, and stand still at a time of it [s]."""
        with self._lock:
            self.film, self._listed = film, (-1, -1)
            self.play(False)
            self._bar.max = max(film.seconds, 0.01)
            set_input(self._speed, f"{film.speed:g} ×")
            self._play.disabled = self._bar.disabled = film.seconds <= 0.0
            self.seek(at)

    def play(self, on: bool) -> None:
        """Play on, from the start where it is at the end; or stand still."""
        with self._lock:
            if on and self.time >= self.film.seconds - 1e-6:
                self.time = 0.0
            self.playing = on and self.film.seconds > 0.0
            self._play.label = "Pause" if self.playing else "Play"

    def toggle(self) -> None:
        """Play, or pause."""
        self.play(not self.playing)

    def jump(self, step: int) -> None:
        """Show the stance after a step, and stand still."""
        with self._lock:
            step = min(max(step, 0), len(self.film.steps) - 1)
            self.play(False)
            self.seek(self.film.rest(step))

    def still(self) -> threading.RLock:
        """A `with` block in which no moment is shown by the clock: what is shown may change."""
        return self._lock

    def seek(self, time: float) -> None:
        """Show a time [s]; the clock goes on from there if it runs."""
        with self._lock:
            self.time = min(max(time, 0.0), self.film.seconds)
            self._refresh(bar=True)

    def stop(self) -> None:
        """End the clock's thread."""
        self._stopped.set()
        self._thread.join(timeout=2.0)

    def _jumper(self, row: int) -> Callable[[Any], None]:
        return lambda _: self.jump(self._first + row)

    def _jump(self, word: str) -> None:
        worst = self.film.worst
        self.jump(
            {"|◀": 0, "◀ step": self.step - 1, "step ▶": self.step + 1}.get(word, self.step if worst is None else worst)
        )

    def _bar_dragged(self, _: "viser.GuiEvent[Any]") -> None:
        with self._lock:
            self.play(False)
            self.time = min(float(self._bar.value), self.film.seconds)
            self._refresh(bar=False)

    def _work(self) -> None:
        last = time.perf_counter()
        while not self._stopped.wait(PERIOD):
            now = time.perf_counter()
            with self._lock:
                if self.playing:
                    self.time += (now - last) * float(self._speed.value.split()[0])
                    if self.time >= self.film.seconds:
                        self.time = self.film.seconds
                        self.play(False)
                    self._refresh(bar=now - self._bar_moved > BAR_PERIOD or not self.playing)
            last = now

    def _refresh(self, *, bar: bool) -> None:
        if bar:
            self._bar_moved = time.perf_counter()
            set_input(self._bar, round(self.time, 2))
        self._show(self.film, self.time)
        self._list_steps()

    def _list_steps(self) -> None:
        """Show the steps about the one that is under way; nothing is sent unless it changes."""
        step, n = self.step, len(self.film.steps)
        first = min(max(step - LISTED // 2, 0), max(n - LISTED, 0))
        if (first, step) == self._listed:
            return
        self._listed = first, step
        self._first = first
        for row, button in enumerate(self._list):
            k = first + row
            button.visible = k < n
            if k >= n:
                continue
            label = f"{'▸ ' if k == step else ''}{k}  {self.film.steps[k]}"
            shade = colour(style.INK if k == step else SHADES[self.film.grades[k]])
            if button.label != label:
                button.label = label
            if button.color != shade:
                button.color = shade
