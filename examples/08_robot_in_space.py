"""A robot in space under an overhang: inspect the task, plan, check the plan, and see what weaker grips would change.

The files in overhang/ are those of `clamber new world overhang` and `clamber new task`; every key is told in them. A robot of your
own comes from its URDF or MJCF file: `clamber new robot --from FILE`.
"""

import sys
from pathlib import Path

import clamber

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
out.mkdir(exist_ok=True)
here = Path(__file__).parent / "overhang"

found = clamber.inspect(here / "climb.toml")
start = {margin.check: margin for margin in found.margins}
print(f"{found.kind} '{found.name}': {len(found.odd)} odd; at the start {start['grip'].margin:.1f} N of grip are left")

task = clamber.load_task(str(here / "climb.toml"))
result = clamber.plan(task, "beam", width=60)
print(f"{result.status}: {result.length} actions")
verdict = clamber.check(result)
least = min(verdict.per_step, key=lambda row: row.margins["grip"])
word = "OK" if verdict.ok else "VIOLATED"
print(f"checked again: {word}; least grip left {least.margins['grip']:.2f} N at step {least.step}")
clamber.draw(result, out / "overhang.png")

# One key changed, without touching a file: the pull-off force of the grippers.
pull = task.document["robot"]["contacts"]["gripper"]["pull"]
print(f"the pull-off force that the contact's file states: {pull['value']} {pull['unit']}")
for newtons in (20, 15, 9):
    try:
        weaker = clamber.change_task(task, [f"robot.contacts.gripper.pull={newtons} N"])
        answer = clamber.plan(weaker, "beam", width=60)
        print(f"{newtons} N: {answer.status}" + (f", {answer.length} actions" if answer.has_plan else ""))
    except clamber.ClamberError as error:
        print(f"{newtons} N: {error}")
