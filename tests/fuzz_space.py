"""Cases of the fuzzer of robots in space: worlds, robots with their models, plans, terrains and logs."""

import json
import random
import tomllib
from pathlib import Path
from typing import Any, Final
from xml.etree import ElementTree

from clamber.families.spatial.family import SPATIAL
from spoiling import CELLS, JUNK, spoil_bytes, spoilt, spoilt_table, toml_file

BRIEF: Final = ("--stances", "50", "--threads", "1", "--no-openings", "--quiet")
PLAN: Final = ("plan", "patch-gripper", "--planner", "exact", "--threads", "1", "--quiet", "-o", "space.json")
HOLDS: Final = "x [m],y [m],z [m],nx,ny,nz\n" + "".join(f"{0.1 * k},{0.1 * (k % 3)},0,0,0,1\n" for k in range(20))


def prepare_space(folder: Path, run: Any) -> None:
    """Make the files in space that are to be spoilt.

    Args:
        folder: Where; the working folder.
        run: Runs a command.
    """
    run(*PLAN)
    (folder / "holds.csv").write_text(HOLDS)
    (folder / "heights.csv").write_text("\n".join(",".join("0.1" for _ in range(6)) for _ in range(8)) + "\n")
    (folder / "points.csv").write_text("x,y,z\n" + "".join(f"{0.1 * (k % 9)},{0.1 * (k // 9)},0\n" for k in range(81)))
    (folder / "mesh.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.1\nf 1 2 3\nf 1 3 4\n")


def world(rng: random.Random, folder: Path) -> list[str]:
    _spoil(rng, folder / "world.toml", rng.choice(sorted((SPATIAL.data / "worlds").glob("*.toml"))))
    task = rng.choice(("patch-gripper", "stones-quadruped", "chimney-hexapod"))
    return rng.choice(
        (["check", "world.toml"], ["check", "world.toml", "--json"], ["check", task, "--set", "world=world.toml"],
         ["plan", "patch-gripper", "--set", "world=world.toml", *BRIEF], ["show", "world.toml", "-o", "x.png"],
         ["new", "task", "--world", "world.toml", "-o", "task.toml"],
         ["run", "space.json", "--set", "world=world.toml", "--law", "no-such-law"])
    )  # fmt: skip


def robot(rng: random.Random, folder: Path) -> list[str]:
    """A robot beside its model, one of them spoilt."""
    source = rng.choice(sorted((SPATIAL.data / "robots").glob("*.xml")))
    model = ElementTree.parse(source)
    (folder / source.name).write_bytes(spoilt_model(rng, model))
    described = source.with_suffix(".toml")
    if rng.random() < 0.3:
        (folder / source.name).write_bytes(source.read_bytes())
        _spoil(rng, folder / described.name, described)
    else:
        (folder / described.name).write_bytes(described.read_bytes())
    return rng.choice(
        (["check", described.name], ["check", described.name, "--json"], ["new", "robot", "--from", source.name, "-o", "robot.toml"],
         ["export", described.name, "-o", "robot.urdf"], ["show", described.name, "-o", "x.png"],
         ["plan", "patch-gripper", "--set", f"robot={described.name}", *BRIEF], ["check", source.name],
         ["new", "world", "wall", "--robot", described.name, "-o", "w.toml"])
    )  # fmt: skip


def plan(rng: random.Random, folder: Path) -> list[str]:
    data = json.loads((folder / "space.json").read_text())
    (folder / "plan.json").write_bytes(spoilt(rng, data, json.dumps))
    return rng.choice(
        (["check", "plan.json"], ["check", "plan.json", "--all"], ["check", "plan.json", "--task", "wall-gripper"],
         ["export", "plan.json", "-o", "x.csv"], ["run", "plan.json", "--law", "no-such-law"], ["trials", "plan.json", "-n", "0"],
         ["trials", "plan.json", "-n", "1", "--noise", f"hold={rng.choice(CELLS)[:200]}", "--set", "nokey=1"],
         ["run", "plan.json", "--set", f"plant.{rng.choice(('delay', 'friction', 'nokey', 'backlash'))}={rng.choice(JUNK)!s:.200}",
          "--law", "no-such-law"])
    )  # fmt: skip


def terrain(rng: random.Random, folder: Path) -> list[str]:
    option, name = rng.choice(
        (("table", "holds.csv"), ("heights", "heights.csv"), ("points", "points.csv"), ("mesh", "mesh.obj"))
    )
    file = folder / name
    text = file.read_text()
    file.write_bytes(spoil_bytes(rng, text.encode()) if option == "mesh" else spoilt_table(rng, text))
    size = ["--size", rng.choice(("4m,2m", "4m,2m", "1e9m,1m", "0m,1m", "4m", "x"))] if option == "heights" else []
    return ["new", "world", f"--{option}", name, *size, *rng.choice(([], ["--spacing", "20cm"])), "-o", "w.toml"]


def spoilt_model(rng: random.Random, model: Any) -> bytes:
    """An MJCF file with one attribute, element or run of bytes changed."""
    elements = list(model.iter())
    kind = rng.randrange(5)
    one = rng.choice(elements)
    if kind == 0:
        return spoil_bytes(rng, ElementTree.tostring(model.getroot()))
    if kind == 1 and len(one):
        one.remove(rng.choice(list(one)))
    elif kind == 2 and len(one):
        one.append(rng.choice(list(one)))
    elif kind == 3:
        one.tag = rng.choice(
            (rng.choice(elements).tag, "nobody", "include", "plugin", "flexcomp", "composite", "hfield")
        )
    else:
        one = rng.choice([each for each in elements if each.attrib])
        name = rng.choice(list(one.attrib))
        value = str(rng.choice((*JUNK, *CELLS, " ".join(["nan"] * 3), "0 0 0", "1e308 1e308 1e308")))
        one.attrib[name] = "".join(letter for letter in value if letter.isprintable())
    return ElementTree.tostring(model.getroot())


def _spoil(rng: random.Random, path: Path, source: Path) -> None:
    path.write_bytes(spoilt(rng, tomllib.loads(source.read_text()), toml_file))


RECIPES: Final = (*(world,) * 2, *(robot,) * 3, *(plan,) * 2, terrain)
