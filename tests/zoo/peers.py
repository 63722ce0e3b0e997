"""The same equations of motion from Pinocchio and MuJoCo, where these are installed.

Both get the tree without followers, damping and dry friction, and planar joints as two that slide and one that
turns. They read origins, axes, masses and inertias by themselves, and give the mass matrix and the forces
of all joints. These are then reduced to the velocities that are free.
"""

import dataclasses
import pathlib
import xml.etree.ElementTree as ElementTree

import numpy as np

from rigid_bodies import GRAVITY, Dynamics, State, from_quaternion, plane, reduction
from robot import Robot
from states import rates_of

try:
    import pinocchio
except ImportError:
    pinocchio = None

try:
    import mujoco
except ImportError:
    mujoco = None

ROOT = "the root"
"""The name that the joint of a floating root has for the peers."""


class Refused(Exception):
    """The peer does not take this robot, for the reason given."""


@dataclasses.dataclass
class Part:
    """A joint of a peer: its name there, its place among all velocities, and its state."""

    name: str
    velocities: slice
    q: np.ndarray
    v: np.ndarray


def by_pinocchio(path: pathlib.Path, robot: Robot, state: State) -> Dynamics:
    """Mass matrix and forces by Pinocchio's `crba` and `nle`."""
    model, q, v, spread = _in_pinocchio(path, robot, state)
    data = model.createData()
    mass = np.triu(pinocchio.crba(model, data, q))
    mass = mass + np.triu(mass, 1).T
    return _reduced(robot, state, mass, pinocchio.nle(model, data, q, v), spread)


def derivative_by_pinocchio(
    path: pathlib.Path, robot: Robot, state: State, direction: State, equations: Dynamics
) -> np.ndarray:
    """How the accelerations change along a direction, by Pinocchio's `computeRNEADerivatives`."""
    model, q, v, spread = _in_pinocchio(path, robot, state)
    _, led = reduction(robot)
    total = spread @ led
    data = model.createData()  # which owns the two matrices
    by_q, by_v, _ = pinocchio.computeRNEADerivatives(model, data, q, v, total @ equations.accelerations())
    along_q, along_v = np.zeros(robot.size), np.zeros(robot.size)
    damping = np.zeros(robot.size)
    for joint in robot.joints:
        along_q[joint.velocities] = rates_of(state.q[joint.name], direction.q[joint.name])
        along_v[joint.velocities] = direction.v[joint.name]
        damping[joint.velocities] = joint.damping * np.asarray(direction.v[joint.name])
    forces = total.T @ (by_q @ spread @ along_q + by_v @ spread @ along_v) + led.T @ damping
    return equations.solved(forces)


def _in_pinocchio(path: pathlib.Path, robot: Robot, state: State):
    """The model, q and v of Pinocchio, and the matrix from the velocities of all joints to v."""
    text = ElementTree.tostring(_bare(path), encoding="unicode")
    try:
        root = (pinocchio.JointModelFreeFlyer(), ROOT) if robot.floating else ()
        model = pinocchio.buildModelFromXML(text, *root)
    except ValueError as error:
        raise Refused(str(error)) from error
    model.gravity.linear = np.array([0.0, 0.0, -GRAVITY])
    q, v = np.zeros(model.nq), np.zeros(model.nv)
    spread = np.zeros((model.nv, robot.size))
    for part in _parts(robot, state):
        joint = model.joints[model.getJointId(part.name)]
        there = slice(joint.idx_v, joint.idx_v + joint.nv)
        q[joint.idx_q : joint.idx_q + joint.nq] = _as_pinocchio(part.q, joint.nq)
        v[there] = part.v
        spread[there, part.velocities] = np.eye(len(part.v))
    return model, q, v, spread


def by_mujoco(path: pathlib.Path, robot: Robot, state: State) -> Dynamics:
    """Mass matrix and forces by MuJoCo, which has the velocity of a free body along fixed axes: R v."""
    tree = _bare(path)
    for joint in tree.findall("joint"):
        for limit in joint.findall("limit"):
            joint.remove(limit)
    options = ElementTree.SubElement(tree, "mujoco")
    ElementTree.SubElement(
        options, "compiler", fusestatic="false", discardvisual="true", balanceinertia="false"
    )
    try:
        design = mujoco.MjSpec.from_string(ElementTree.tostring(tree, encoding="unicode"))
        if robot.floating:
            design.body(robot.links[robot.joints[0].child].name).add_freejoint(name=ROOT)
        model = design.compile()
    except ValueError as error:
        raise Refused(" ".join(str(error).split())) from error
    model.opt.gravity[:] = (0.0, 0.0, -GRAVITY)
    data = mujoco.MjData(model)
    spread, rest = np.zeros((model.nv, robot.size)), np.zeros(model.nv)
    for part in _parts(robot, state):
        joint = model.joint(part.name)
        there = slice(joint.dofadr[0], joint.dofadr[0] + len(part.v))
        turn = np.eye(len(part.v))
        if len(part.v) == 6:
            turn[:3, :3] = from_quaternion(part.q[3:])
            rest[there][:3] = turn[:3, :3] @ np.cross(part.v[3:], part.v[:3])
        data.qpos[joint.qposadr[0] : joint.qposadr[0] + len(part.q)] = part.q
        data.qvel[there] = turn @ part.v
        spread[there, part.velocities] = turn
    mujoco.mj_forward(model, data)
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    return _reduced(robot, state, mass, data.qfrc_bias + mass @ rest, spread)


def _parts(robot: Robot, state: State) -> list[Part]:
    parts = []
    for joint in robot.joints:
        q, v, first = state.q[joint.name], state.v[joint.name], joint.velocities.start
        if joint.kind == "planar":
            for k in range(3):
                parts.append(
                    Part(_third(joint.name, k), slice(first + k, first + k + 1), q[k : k + 1], v[k : k + 1])
                )
        elif len(v) > 0:
            parts.append(Part(joint.name or ROOT, joint.velocities, q, v))
    return parts


def _as_pinocchio(q: np.ndarray, count: int) -> np.ndarray:
    """Quaternions have their scalar last, angles that turn endlessly are cosine and sine."""
    if len(q) == 7:
        return np.concatenate([q[:3], q[4:], q[3:4]])
    return np.array([np.cos(q[0]), np.sin(q[0])]) if count == 2 else q


def _reduced(
    robot: Robot, state: State, mass: np.ndarray, forces: np.ndarray, spread: np.ndarray
) -> Dynamics:
    """From the velocities of the peer to those of the joints that are free; damping and dry friction are added."""
    free, led = reduction(robot)
    damping = np.zeros(robot.size)
    for joint in robot.joints:
        velocity = np.asarray(state.v[joint.name])
        damping[joint.velocities] = joint.damping * velocity + joint.friction * np.sign(velocity)
    names = [joint.name for joint in free for _ in state.v[joint.name]]
    total = spread @ led
    return Dynamics(names, total.T @ mass @ total, total.T @ forces + led.T @ damping)


def _bare(path: pathlib.Path) -> ElementTree.Element:
    """The file without name spaces, shapes, followers, dampings, and tags of other programs."""
    tree = ElementTree.fromstring(path.read_bytes())
    for element in tree.iter():
        element.tag = element.tag.rpartition("}")[2]
    for element in list(tree):
        if element.tag not in ("link", "joint"):
            tree.remove(element)
            continue
        for part in list(element):
            if part.tag not in ("inertial", "origin", "parent", "child", "axis", "limit"):
                element.remove(part)
        if element.get("type") == "planar":
            _split(tree, element)
    return tree


def _split(tree: ElementTree.Element, planar: ElementTree.Element) -> None:
    """Puts two joints that slide, with links without mass, before a planar joint, which then only turns."""
    name, axis = planar.get("name"), planar.find("axis")
    normal = np.array([float(part) for part in axis.get("xyz").split()])
    along = plane(normal)
    parent = planar.find("parent").get("link")
    origin = planar.find("origin")
    for k in range(2):
        slide = ElementTree.SubElement(tree, "joint", name=_third(name, k), type="prismatic")
        if k == 0 and origin is not None:
            slide.append(origin)
            planar.remove(origin)
        ElementTree.SubElement(tree, "link", name=_third(name, k))
        ElementTree.SubElement(slide, "parent", link=parent)
        ElementTree.SubElement(slide, "child", link=_third(name, k))
        ElementTree.SubElement(slide, "axis", xyz=" ".join(str(part) for part in along[:, k]))
        ElementTree.SubElement(slide, "limit", lower="-9", upper="9", effort="9", velocity="9")
        parent = _third(name, k)
    planar.set("name", _third(name, 2))
    planar.set("type", "continuous")
    planar.find("parent").set("link", parent)


def _third(name: str, k: int) -> str:
    return f"{name}, part {k + 1}"
