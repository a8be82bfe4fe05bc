"""Carry a plan out in contact dynamics, where pegs are not where the map says: what became of every action."""

import sys
from pathlib import Path

import clamber

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
out.mkdir(exist_ok=True)

# A plan printed in a thesis of 1997, on pegs that are up to 3 mm off; the controller knows the map only.
plan = clamber.load_plan("ladder-hand")
run = clamber.run(plan, noise=["peg_error=3mm"], seed=1)

x, y, theta = run.report.pose
print(f"{'done' if run.done else run.reason} after {run.report.seconds:.0f} s, body at ({x:.3f}, {y:.3f}) m")
for action in run.report.actions[:8]:
    print(
        f"  {action.first:3} {action.title:24} {action.outcome:8} {action.seconds:5.1f} s, body off by {1000 * action.off:.1f} mm"
    )
print(
    f"  ... {len(run.report.actions)} in all; {sum(action.tries > 1 for action in run.report.actions)} needed another try"
)

clamber.draw(run, out / "climb.png")
