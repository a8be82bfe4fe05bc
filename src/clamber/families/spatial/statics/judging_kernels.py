"""Many stances, one after another."""

from ....compiled import kernel
from .stance_kernels import judge


@kernel
def judge_each(robot, tables, stances, before, rules, work):
    """Judge stances (bodies, contacts, what is written, reasons) from one stance before (`stance_kernels.judge`)."""
    bodies, contacts, out, reasons = stances
    for i in range(len(bodies)):
        reasons[i] = judge(robot, tables, bodies[i], contacts[i], before, rules, out[i], work)
