"""`clamber hold-force`: hold a force against a wall with one limb while the body moves."""

from typing import Annotated

import typer

from ....errors import SpecError
from ....terminal.name_completion import names_of
from ....terminal.options import BOARD, ROBOT, AsJson, Flaws, FlawsChoice, Output, Settings
from ....terminal.output import check_output, print_json, stdout
from ....viewing.text_table import plain_table


def hold_force(
    robot: Annotated[
        str,
        typer.Option(help="LIBRA with hooks or grippers, or a file of one like it.", autocompletion=names_of("robots")),
    ] = ROBOT,
    force: Annotated[str, typer.Option(help="On the wall.")] = "20N",
    way: Annotated[str, typer.Option(metavar="X,Y", help="Of the body while the force is held.")] = "0,5cm",
    seconds: Annotated[float, typer.Option(min=0.1, help="That the way takes.")] = 2.0,
    flaws: Flaws = FlawsChoice.nominal,
    settings: Settings = None,
    output: Output = None,
    as_json: AsJson = False,
) -> None:
    """Hold on with two limbs, press a wall with the third, and move the body: how well the force is held.

    The file of `-o` is a picture of force and body over time (.png, .svg, .pdf).
    """
    check_output(output)
    from ....sim.flaw_texts import named_flaws, read_flaws
    from ....tasks.robots import load_robot
    from ....units import parse_quantity, read_point
    from ..pictures.body_plots import draw_press
    from ..robot.robot import LimbedRobot
    from ..trials.hold_force import run_press
    from ..trials.run_plan import PHYSICS_RATE
    from ..world.library import load_board

    chosen = load_robot(robot)
    if not isinstance(chosen, LimbedRobot) or not {"right", "left", "bottom"} <= set(chosen.limb_names):
        raise SpecError(f"robot '{chosen.name}'", "limbs", chosen.name, "must be a LIBRA: limbs right, left and bottom")
    wanted = parse_quantity(force, "force")
    if not wanted > 0.0:
        raise SpecError("--force", "force", force, "must be more than 0 N")
    plant = read_flaws(named_flaws(flaws.value, chosen).with_changes(physics_rate=PHYSICS_RATE), settings or ())
    result = run_press(
        chosen, load_board(BOARD), plant, force=wanted, way=read_point("way", way, "length"), seconds=seconds
    )
    if output is not None:
        draw_press(result, output)
    if as_json:
        print_json(result)
    else:
        table = plain_table("", "", right=("",))
        table.add_row("force wanted", f"{wanted:.3g} N")
        table.add_row("least and most", f"{result.force.min():.1f} to {result.force.max():.1f} N")
        table.add_row("farthest off, every tick", f"{100 * result.ripple:.1f} %")
        table.add_row("farthest off, mean over 20 ms", f"{100 * result.steady_ripple:.1f} %")
        table.add_row("root mean square", f"{100 * result.spread:.1f} %")
        table.add_row("time within 10 %", f"{100 * result.within:.1f} %")
        x, y = (round(1e3 * float(part), 1) + 0.0 for part in result.way)  # never "-0.0"
        table.add_row("body went", f"{x:.1f}, {y:.1f} mm")
        stdout().print(table)
        if result.reason:
            stdout().print(f"fell: {result.reason}")
    raise typer.Exit(1 if result.reason else 0)
