"""A four-limbed climber and a wall of one's own: inspect both, plan a climb, and see what a longer limb would change.

The files in four_limbs/ are those of `clamber new robot`, `clamber new board` and `clamber new task`; every key is told in them.
"""

import sys
from pathlib import Path

import clamber

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
out.mkdir(exist_ok=True)
here = Path(__file__).parent / "four_limbs"

for name in ("robot.toml", "wall.toml", "climb.toml"):
    found = clamber.inspect(here / name)
    print(f"{found.kind} '{found.name}': {found.title}; {len(found.odd)} odd")
start = {margin.check: margin for margin in found.margins}
print(
    f"at the start {start['torque'].margin:.2f} N m of torque and {1000 * start['reach'].margin:.0f} mm of reach are left"
)

task = clamber.load_task(str(here / "climb.toml"))
result = clamber.plan(task, "greedy")
print(f"{result.status}: {result.length} actions")
clamber.draw(result, out / "four-limbs.png")

# One key changed, without touching a file; the override is checked as the file is.
for length in ("10cm", "14cm", "18cm"):
    changed = clamber.change_task(task, [f"robot.limbs.limb-{limb}.l1={length}" for limb in (1, 2, 3, 4)])
    try:
        answer = clamber.plan(changed, "greedy", max_checks=200_000)
        print(f"l1 = {length}: {answer.status}, {answer.length} actions")
    except clamber.ClamberError as error:
        print(f"l1 = {length}: {error}")
