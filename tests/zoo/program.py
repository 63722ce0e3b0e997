"""Accelerations from the program `pc`, which imports a robot and runs it for an instant.

The accelerations are outputs of the model, added to its text; its start is set on the command line.
"""

import pathlib
import re
import subprocess
import time
import tomllib

import numpy as np

from rigid_bodies import State, reduction
from robot import Robot

INSTANT = "1e-12"
"""The time of the run; the first row of its table belongs to the start."""


class Failed(Exception):
    """The program ended with an error, whose text this is."""


def imported(program: str, path: pathlib.Path, floating: bool) -> str:
    """The text of the model."""
    return _run([program, "import", str(path), *(["--floating"] if floating else [])], "")


def check(program: str, model: str) -> float:
    """The seconds that `pc check` takes."""
    begin = time.perf_counter()
    _run([program, "check", "-"], model)
    return time.perf_counter() - begin


def accelerations(program: str, model: str, robot: Robot, state: State) -> np.ndarray:
    """The accelerations of the joints that follow no other, in the order of `rigid_bodies.reduction`."""
    document, names = tomllib.loads(model), _bodies(model)
    free, _ = reduction(robot)
    start, outputs = [], []
    for joint in robot.joints:
        carried = document["bodies"][names[robot.links[joint.child].name]]["joint"]
        coordinates, velocities = _variables(carried, names[robot.links[joint.child].name])
        if "follows" not in carried:
            start += zip(coordinates, state.q[joint.name])
        if joint in free:
            start += zip(velocities, state.v[joint.name])
            outputs += velocities
    arguments = [part for name, value in start for part in ("--set", f"{name}={float(value)!r}")]
    lines = [f'acceleration_of_{k} = "d({name})"' for k, name in enumerate(outputs)]
    text = model + "\n[outputs]\n" + "\n".join(lines) + "\n"
    table = _run([program, "run", "-", "--rows", "2", "--t-end", INSTANT, *arguments], text)
    titles, first = (line.split(",") for line in table.splitlines()[:2])
    row = dict(zip(titles, first))
    return np.array([float(row[f"acceleration_of_{k}"]) for k in range(len(outputs))])


def _run(command: list[str], text: str) -> str:
    done = subprocess.run(command, input=text, capture_output=True, text=True)
    if done.returncode != 0:
        errors = [line for line in done.stderr.splitlines() if not line.startswith("note:")]
        raise Failed(f"pc {command[1]} ends with {done.returncode}: " + "\n".join(errors))
    return done.stdout


def _bodies(model: str) -> dict[str, str]:
    """The name of each link's body: the same, unless a comment below its section says of which link it is."""
    names, body = {}, None
    for line in model.splitlines():
        section = re.fullmatch(r"\[(.*)\]", line)
        renamed = re.fullmatch(r"# the link (.*)", line)
        if section:
            keys = _keys(section[1])
            body = keys[1] if len(keys) == 2 and keys[0] == "bodies" else None
            if body is not None:
                names[body] = body
        elif renamed and body is not None:
            names[renamed[1]] = names.pop(body)
    return names


def _keys(dotted: str) -> list[str]:
    """The parts of the name of a section, by the parser of TOML."""
    keys, table = [], tomllib.loads(f"[{dotted}]")
    while table:
        [(key, table)] = table.items()
        keys.append(key)
    return keys


def _slides(normal: list[float]) -> tuple[str, str]:
    """The axes along which a planar joint slides: the two that follow its normal."""
    axis = next(axis for axis in range(3) if normal[axis])
    return "xyz"[(axis + 1) % 3], "xyz"[(axis + 2) % 3]


def _variables(joint: dict, name: str) -> tuple[list[str], list[str]]:
    """Coordinates and velocities of a joint, in the order of a `State`."""
    match joint["kind"]:
        case "fixed":
            return [], []
        case "free":
            coordinates = [f"{name}_{part}" for part in ("x", "y", "z", "q0", "q1", "q2", "q3")]
            velocities = [f"{name}_{part}" for part in ("v1", "v2", "v3", "ω1", "ω2", "ω3")]
            return joint.get("coordinates", coordinates), joint.get("quasi_velocities", velocities)
        case "planar":
            coordinates = joint.get("coordinates", [f"{name}_{part}" for part in (*_slides(joint["axis"]), "φ")])
        case _:
            coordinates = joint.get("coordinates", [name])
    return coordinates, joint.get("quasi_velocities", [f"{coordinate}'" for coordinate in coordinates])
