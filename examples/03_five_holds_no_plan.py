"""Five holds that cannot be climbed: the proof that there is no plan, what stops the robot, and what would open the way."""

from pathlib import Path

import clamber

task = clamber.load_task(str(Path(__file__).parent / "five_holds" / "climb.toml"))
result = clamber.plan(task, "exact", seconds=60.0)

# Exact search sees every stance that can be reached. Only then it says "infeasible", and for which rules that is so.
print(f"{result.status}: {result.reason}")
print(f"proved for: {result.model}")

# Why: limb-1 could take hold 5 only from a body so high that the lower limbs have let go, and three limbs must hold.
# Each opening is the smallest single change that an exact search found to be enough; the others were tried and did not help.
found = clamber.explain_infeasibility(result, seconds=20.0)
for opening in found.openings:
    print(f"it opens with {opening.key}: {opening.before} -> {opening.after}, in {opening.length} actions")
if found.places is not None and found.places.openings:
    best = found.places.openings[0]
    print(f"or with one hold more, {best.after}, in {best.length} actions: --set '{best.overrides[0]}'")
for shut in found.shut:
    print(f"no help: {shut.text} ({'proved' if shut.proved else 'not settled in the time'})")
