"""Writes dynamics.json: for each robot a state, and what rigid_bodies.py finds there.

    python tests/zoo/record.py

Pinocchio has to be installed: numbers with which it disagrees are not written. README.md describes the
entries.
"""

import json
import pathlib
import sys

import numpy as np

import peers
import rigid_bodies
import robot as robots
import states

HERE = pathlib.Path(__file__).parent
FILE = HERE / "dynamics.json"
WHOLE = 8
"""The number of velocities up to which the mass matrix is written as a whole."""
TOLERANCE = 1e-10
"""Relative to the largest number of its kind, as in compare.py."""


def main() -> int:
    """Writes; the exit code."""
    if peers.pinocchio is None:
        print("Pinocchio is not installed: pip install pin")
        return 1
    entries = []
    for path in sorted(HERE.glob("*.urdf")):
        if "Expected: refused" not in robots.header_of(path):
            entries.append(f"{json.dumps(path.stem)}: {_written(_entry(path))}")
    FILE.write_text("{\n" + ",\n".join(entries) + "\n}\n", encoding="utf-8")
    return 0


def of(name: str, robot: robots.Robot, state: rigid_bodies.State, equations: rigid_bodies.Dynamics) -> dict:
    """The entry of a robot."""
    free, _ = rigid_bodies.reduction(robot)
    accelerations, diagonal = equations.accelerations(), np.diag(equations.mass)
    direction = states.direction_of(robot, name, state)
    derivative = rigid_bodies.derivative(robot, state, direction, equations)
    joints, first = [], 0
    for joint in free:
        here = slice(first, first + len(state.v[joint.name]))
        first = here.stop
        joints.append(
            {
                "name": joint.name,
                "kind": joint.kind,
                "q": state.q[joint.name].tolist(),
                "v": state.v[joint.name].tolist(),
                "acceleration": accelerations[here].tolist(),
                "bias": equations.bias[here].tolist(),
                "mass": diagonal[here].tolist(),
                "along": [direction.q[joint.name].tolist(), direction.v[joint.name].tolist()],
                "derivative": derivative[here].tolist(),
            }
        )
    followers = [joint.name for joint in robot.joints if joint.mimic is not None]
    entry = {"floating": robot.floating, "joints": joints}
    if followers:
        entry["followers"] = {name: [state.q[name][0], state.v[name][0]] for name in followers}
    if len(diagonal) <= WHOLE:
        entry["mass_matrix"] = [equations.mass[k, : k + 1].tolist() for k in range(len(diagonal))]
    return entry


def _entry(path: pathlib.Path) -> dict:
    robot = robots.read(path)
    state = states.of(robot, path.stem)
    equations, other = rigid_bodies.dynamics(robot, state), peers.by_pinocchio(path, robot, state)
    for what, one, two in (
        ("accelerations", equations.accelerations(), other.accelerations()),
        ("bias", equations.bias, other.bias),
        ("mass matrix", equations.mass, other.mass),
        ("derivative", *_derivatives(path, robot, state, equations)),
    ):
        if np.abs(one - two).max() > TOLERANCE * np.abs(one).max():
            sys.exit(f"{path.name}: Pinocchio disagrees in the {what}")
    return of(path.stem, robot, state, equations)


def _derivatives(
    path: pathlib.Path, robot: robots.Robot, state: rigid_bodies.State, equations: rigid_bodies.Dynamics
) -> tuple[np.ndarray, np.ndarray]:
    direction = states.direction_of(robot, path.stem, state)
    return (
        rigid_bodies.derivative(robot, state, direction, equations),
        peers.derivative_by_pinocchio(path, robot, state, direction, equations),
    )


def _written(entry: dict) -> str:
    """JSON with a line for each joint."""
    lines = [f'"floating": {json.dumps(entry["floating"])}']
    joints = ",\n".join("    " + json.dumps(joint, ensure_ascii=False) for joint in entry["joints"])
    lines.append(f'"joints": [\n{joints}\n  ]')
    for key in ("followers", "mass_matrix"):
        if key in entry:
            lines.append(f'"{key}": {json.dumps(entry[key], ensure_ascii=False)}')
    return "{\n  " + ",\n  ".join(lines) + "\n}"


if __name__ == "__main__":
    sys.exit(main())
