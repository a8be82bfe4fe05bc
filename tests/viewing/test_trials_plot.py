"""The picture of many climbs: every format, with and without failures, and what it says."""

import importlib.util
from pathlib import Path
from typing import Any

import pytest

from clamber.families.climber.pictures.charts import draw_trials, trials_figure
from clamber.families.climber.trials.trial_summary import sum_up
from clamber.trials.trial_runs import Trials
from clamber.viewing.output import SuffixError
from tiers import first_fast


def by_hand() -> Any:
    """What the tests of trials make climbs with."""
    path = Path(__file__).parents[1] / "experiments" / "climb" / "climbs_by_hand.py"
    spec = importlib.util.spec_from_file_location("climbs_by_hand", path)
    assert spec is not None and spec.loader is not None
    made = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(made)
    return made


def trials(n: int, failed: int) -> Trials:
    made = by_hand()
    ended = [made.climb(k, done=k >= failed, kind="grab", limb="left") for k in range(n)]
    return Trials(made.setup_of(300), n, ended)


@pytest.mark.parametrize("suffix", first_fast([".png", ".svg", ".pdf"]))
@pytest.mark.parametrize(("n", "failed"), [(30, 4), (3, 0), (1, 1), (0, 0)])
def test_any_number_of_climbs_is_drawn(tmp_path: Path, suffix: str, n: int, failed: int) -> None:
    draw_trials(sum_up(trials(n, failed)), tmp_path / f"trials{suffix}")
    assert (tmp_path / f"trials{suffix}").stat().st_size > 1000


def test_its_title_its_panels_and_its_bars_say_what_was_counted() -> None:
    summary = sum_up(trials(30, 4))
    figure = trials_figure(summary)
    title = figure.get_suptitle()
    assert "26 of 30 climbs succeeded, 86.7 %" in title
    panels = [axes for axes in figure.axes if axes.get_visible()]
    assert len(panels) == len(summary.effects) + 1
    bars = panels[-1].patches
    assert [bar.get_width() for bar in bars] == pytest.approx([4 / 30])
    assert [label.get_text() for label in panels[-1].get_yticklabels()] == ["fell: left grab"]


def test_what_is_no_picture_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SuffixError):
        draw_trials(sum_up(trials(1, 0)), tmp_path / "trials.gif")
