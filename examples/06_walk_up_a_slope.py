"""A six-legged walker goes up a slope with its plate level: the same functions as for climbers."""

import math
import sys
from pathlib import Path

import clamber

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
out.mkdir(exist_ok=True)

walk = clamber.load_walk("slope-walk", ["way.0.distance=0.5m"])
run = clamber.run(walk, noise=["usual"], seed=2)

print(f"{'done' if run.done else run.reason}: {len(run.report.steps)} steps in {run.report.seconds:.0f} s")
print(f"the plate was never more than {math.degrees(run.tilt):.2f} deg from level")
print(f"the centre of mass was never less than {1000 * run.margin:.0f} mm inside the standing feet")

clamber.draw(run, out / "slope.png")
