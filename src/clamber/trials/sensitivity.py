"""What a failed run had that others had not: each key of the noise by thirds, and whether its rank tells failures from successes."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Annotated, Final, Protocol

import numpy as np

from ..json_form import Count, Jsonable, Key, OrNull, in_json
from .trial_runs import Trial, wilson_interval

LEVEL: Final = 0.05
"""Chance that any key of a campaign is wrongly said to matter [-]."""
VERDICTS: Final = {
    "too few": "too few failures to tell",
    "none": "no sign",
    "high": "fails more at high values",
    "low": "fails more at low values",
    "far": "fails more far from nominal",
    "near": "fails more near nominal",
}
"""Verdict -> in words."""


class DrawnTrial(Trial, Protocol):
    """A run that tells what its seed drew."""

    @property
    def drawn(self) -> dict[str, float]:
        """One number for each key of the noise, in SI; empty where it raised."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Third(Jsonable):
    """A third of the runs, by what one key drew."""

    low: float
    """Least deviation in it, in SI."""
    high: float
    """Largest one."""
    done: Count
    n: Count

    @property
    @in_json()
    def interval(self) -> tuple[float, float]:
        """Of its success, 95 %, Wilson's."""
        return wilson_interval(self.done, self.n)


@dataclass(frozen=True, slots=True, kw_only=True)
class Effect(Jsonable):
    """What one key of the noise did to success."""

    key: str
    thirds: tuple[Third, ...]
    """From low to high deviations."""
    share: OrNull
    """Chance that a failed run drew more than one that was carried out, 0.5 if it makes no difference [-]; NaN without both."""
    p: OrNull
    """Of the clearer of two rank tests (by deviation, and by its size), corrected for all tests of all keys [-]; NaN without both."""
    verdict: Annotated[str, Key(get=VERDICTS.__getitem__, meaning="In words.")]
    """Key of `VERDICTS`."""


def find_effects(keys: Iterable[str], trials: Sequence[DrawnTrial]) -> list[Effect]:
    """The effect of each key that was drawn at all.

    Failed and successful runs are told apart by Mann and Whitney's rank test, once by the deviation and once by its size (a key whose
    both ends are bad shows in the second alone). Holm's correction over all these tests keeps the chance of any wrong verdict at
    `LEVEL`. Where not even a perfect order of so few failures could pass it, the verdict is "too few".

    Args:
        keys: Of the noise, in the order in which they are told.
        trials: Those that drew; trials that raised are left out.
    """
    drew = [trial for trial in trials if trial.drawn]
    keys = [key for key in keys if any(trial.drawn.get(key, 0.0) != 0.0 for trial in drew)]
    failed = np.array([not trial.done for trial in drew], bool)
    bad, good = int(failed.sum()), int((~failed).sum())
    tests: dict[tuple[str, bool], tuple[float, float]] = {}
    for key in keys if bad and good else ():
        from scipy.stats import mannwhitneyu  # takes a second to import, which Ctrl-C would wait for

        values = np.array([trial.drawn[key] for trial in drew])
        for by_size in (False, True) if np.any(values < 0.0) else (False,):
            ranked = np.abs(values) if by_size else values
            told = mannwhitneyu(ranked[failed], ranked[~failed])
            tests[key, by_size] = float(told.statistic) / (bad * good), float(told.pvalue)
    corrected = _holm({test: p for test, (_, p) in tests.items()})
    can_tell = bool(tests) and 2.0 / math.comb(bad + good, bad) * len(tests) <= LEVEL
    effects = []
    for key in keys:
        own = [test for test in tests if test[0] == key]
        clearest = min(own, key=lambda test: corrected[test], default=None)
        p = math.nan if clearest is None else corrected[clearest]
        verdict = "too few"
        if can_tell and clearest is not None:
            more = tests[clearest][0] > 0.5
            words = ("far", "near") if clearest[1] else ("high", "low")
            verdict = "none" if p > LEVEL else words[0] if more else words[1]
        share = tests[key, False][0] if (key, False) in tests else math.nan
        effects.append(Effect(key=key, thirds=_thirds(drew, key), share=share, p=p, verdict=verdict))
    return effects


def _thirds(trials: Sequence[DrawnTrial], key: str) -> tuple[Third, ...]:
    ordered = sorted(trials, key=lambda trial: trial.drawn[key])
    parts = [part for part in np.array_split(np.arange(len(ordered)), 3) if len(part)]
    return tuple(
        Third(
            low=ordered[part[0]].drawn[key],
            high=ordered[part[-1]].drawn[key],
            done=sum(ordered[k].done for k in part),
            n=len(part),
        )
        for part in parts
    )


def _holm(ps: dict[tuple[str, bool], float]) -> dict[tuple[str, bool], float]:
    """Adjusted p values (Holm, Scand. J. Stat. 6, 1979): steps down from the smallest, never falling."""
    adjusted, worst = {}, 0.0
    for k, (test, p) in enumerate(sorted(ps.items(), key=lambda item: item[1])):
        worst = max(worst, min(1.0, (len(ps) - k) * p))
        adjusted[test] = worst
    return adjusted
