"""Which control law keeps a limb on a circle? The same tip stiffness for all, play in the joints, encoders and delay of the real one."""

import sys
from pathlib import Path

import clamber

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
out.mkdir(exist_ok=True)

laws = ["scct", "jacobian-transpose", "operational-space:feed_acceleration=yes,feed_friction=1"]
result = clamber.compare(laws, "circle", radius=0.05, lap=6.0, flaws="nominal", changes=["backlash=1deg"])

print(result.title(), "on", result.plant_words())
for row in result.rows:
    measures = row.measures[0]
    if measures.unstable_at is not None:
        print(f"  {row.entry.label:20} unstable after {measures.unstable_at:.1f} s")
        continue
    off, lag = measures.true.radial_rms, measures.true.lag
    print(
        f"  {row.entry.label:20} {1000 * off:6.2f} mm off the circle (rms), {lag:.3f} rad behind, {measures.work:.1f} J"
    )

clamber.draw(result, out / "circle.png")
result.save_table(out / "circle.csv")
