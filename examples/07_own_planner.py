"""A planner of one's own in thirty lines: keep the stances with the most progress, layer by layer.

It meets a robot only as a `Problem`: arrays of stances in, arrays of children out. So it plans for climbers and for walkers. As an entry
point of a package (own_package/) it is a planner like any other: `clamber plan ladder --planner widest`.
"""

import numpy as np

import clamber


def plan_widest(task, *, seed=0, width=300, longest=200):
    """Plan layer by layer, keeping the `width` stances that have come farthest.

    Args:
        task: What to plan.
        seed: Of the order among equals.
        width: Stances kept of each layer.
        longest: Most actions.
    """
    draw = np.random.default_rng(seed)
    problem = clamber.pose_problem(task, threads=1).problem
    body = problem.features.index("body")  # how far along the goals the body is [m]
    stances, ways, seen, checks = problem.start, [()], set(), 0
    for _ in range(longest):
        children = problem.expand(stances)
        checks += len(children.code)
        made = [(*ways[parent], int(code)) for parent, code in zip(children.parent, children.code, strict=True)]
        for index, way in enumerate(made):
            if problem.is_done(children.stance[index : index + 1]):
                return clamber.answer(task, way, planner="widest", seed=seed, checks=checks)
        features = problem.measured(children.stance)
        stances_kept, ways_kept = [], []
        for index in np.lexsort((draw.random(len(made)), -features[:, body])):
            alike = features[index].round(6).tobytes()  # stances with equal features count as one
            if alike not in seen and len(stances_kept) < width:
                seen.add(alike)
                stances_kept.append(children.stance[index : index + 1])
                ways_kept.append(made[index])
        if not stances_kept:
            break
        stances, ways = np.concatenate(stances_kept), ways_kept
    return clamber.answer(
        task, ways[0], planner="widest", seed=seed, checks=checks, reason=f"none in {longest} actions"
    )


if __name__ == "__main__":
    task = clamber.load_task("ladder", ["rules.max_hangs=0"])
    found, best = plan_widest(task), clamber.plan(task, "exact")
    print(f"widest: {found.status}, {found.length} actions after judging {found.checks}")
    print(f"exact:  {best.status}, {best.length} actions")
    print(f"carried out again: {'OK' if clamber.check(found).ok else 'VIOLATED'}")
