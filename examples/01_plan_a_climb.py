"""Plan a climb, prove that no plan is shorter, and look at how close each check comes to its limit."""

import sys
from pathlib import Path

import clamber

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
out.mkdir(exist_ok=True)

# LIBRA, a robot of three limbs with hooks, on a ladder of pegs; no hanging on one limb, so that exact search can prove its plan.
task = clamber.load_task("ladder", ["rules.max_hangs=0"])
result = clamber.plan(task, "exact")
print(f"{result.status}: {result.length} actions; {result.reason}")

# A plan proves itself: it is carried out again, without whoever planned it, and every check of every step is judged.
verdict = clamber.check(result)
print(f"{'OK' if verdict.ok else 'VIOLATED'}, goal {'reached' if verdict.reached else 'not reached'}")
for check, (margin, step) in verdict.tightest().items():
    unit = next(each.unit for each in verdict.checks if each.name == check)
    kind = "hard" if check in verdict.hard else "reports"
    print(f"  {check:12} {margin:+9.4f} {unit:4} at step {step:2} ({kind})")

result.plan.save(out / "ladder.json")
clamber.draw(result, out / "ladder.png")
print(f"written to {out}: ladder.json, ladder.png")
