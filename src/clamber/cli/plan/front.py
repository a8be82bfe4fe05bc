"""`clamber plan --pareto`: every plan that no other beats in both of two costs."""

from pathlib import Path

from rich.console import Console

from ...planning.exact.costs import read_costs
from ...planning.exact.front import Front, plan_front
from ...planning.exact.planner import MOST_STANCES
from ...planning.problem.problems import plan_family
from ...tasks import Task
from ...terminal.output import check_output, print_json, stderr, stdout
from ...viewing.text_table import plain_table
from .options import PlanOptions
from .text import ProgressLine


def front(task: Task, costs: str, words: PlanOptions) -> int:
    """Find a front, print it, and draw it or write it to the output (png, svg, pdf; json); returns the exit status."""
    first, second = read_costs("--pareto", costs, least=2, most=2)
    output = words.output
    check_output(output, ".json")
    with ProgressLine(stderr(), quiet=words.quiet) as line:
        found = plan_front(
            task,
            (first, second),
            seconds=words.seconds,
            threads=words.threads,
            max_stances=MOST_STANCES if words.stances is None else words.stances,
            progress=line.update,
        )
    if output is not None and output.suffix.lower() == ".json":
        found.save(output)
    elif output is not None:
        from ...viewing.plan_curves import draw_front

        draw_front(found, output)
    if words.as_json:
        print_json(found)
    else:
        print_front(stdout(), found, output)
    return 0 if found.trades else 1


def print_front(console: Console, found: Front, output: Path | None) -> None:
    """A front as a table, and what is proved of it."""
    status = "infeasible" if found.infeasible else "complete" if found.complete else "incomplete"
    title = f"{status}: {len(found.trades)} plans for '{found.task.name}', {found.costs[0]} against {found.costs[1]}"
    console.print(title, style="bold green" if found.complete and not found.infeasible else "bold red")
    costs = plan_family(found.task).costs(found.task)
    heads = ("actions", *(f"{name} [{cost.unit}]" for name, cost in costs.items()))
    table = plain_table(*heads, right=heads)
    for trade in found.trades:
        numbers = (trade.costs[name] / cost.per_unit for name, cost in costs.items())
        table.add_row(str(trade.length), *(f"{number:.2f}" for number in numbers))
    if found.trades:
        console.print(table)
    console.print(f"proved for: {found.model}; {found.reason}")
    console.print(f"{found.stances} stances, {found.checks} actions judged, {found.seconds:.1f} s")
    if output is not None:
        console.print(f"front: {output}", soft_wrap=True)
