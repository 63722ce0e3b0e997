"""A robot as its URDF file describes it: a tree of links, and how each joint moves.

Only what the laws of motion need is read: masses, origins, axes, dampings, dry friction, and which joint follows which.
Limits, dry friction, shapes, transmissions and whatever simulators add are passed over.
"""

import dataclasses
import pathlib
import re
import xml.etree.ElementTree as ElementTree

import numpy as np

VELOCITIES = {"fixed": 0, "revolute": 1, "continuous": 1, "prismatic": 1, "planar": 3, "floating": 6}
"""The number of velocities of a joint of each type."""


@dataclasses.dataclass
class Link:
    """A rigid body: its mass, its mass centre, and its inertia about that centre, in the axes of the link."""

    name: str
    mass: float
    centre: np.ndarray
    inertia: np.ndarray


@dataclasses.dataclass
class Mimic:
    """The joint follows another one: q = multiplier · q_leader + offset."""

    leader: str
    multiplier: float
    offset: float


@dataclasses.dataclass
class Joint:
    """A link (`child`) moves relative to another one (`parent`, an index, or -1 for the world)."""

    name: str
    kind: str
    parent: int
    child: int
    position: np.ndarray
    rotation: np.ndarray
    axis: np.ndarray
    damping: float
    friction: float
    limits: tuple[float, float] | None
    mimic: Mimic | None
    velocities: slice = dataclasses.field(default_factory=lambda: slice(0, 0))


@dataclasses.dataclass
class Robot:
    """Links, and the joints that carry them, each after that of its parent; the first carries the root."""

    name: str
    about: str
    floating: bool
    links: list[Link]
    joints: list[Joint]

    @property
    def size(self) -> int:
        """The number of velocities of all joints, of those that follow others, too."""
        return self.joints[-1].velocities.stop if self.joints else 0


def skew(a: np.ndarray) -> np.ndarray:
    """The matrix of b ↦ a × b."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def about(axis: np.ndarray, angle: float) -> np.ndarray:
    """Rodrigues' formula: 1 + sin φ [a] + (1 − cos φ) [a]², where 1 − cos φ = 2 sin²(φ/2)."""
    cross = skew(axis)
    return np.eye(3) + np.sin(angle) * cross + 2.0 * np.sin(angle / 2.0) ** 2 * cross @ cross


def from_roll_pitch_yaw(angles: np.ndarray) -> np.ndarray:
    """Turns about the fixed axes x, y and z, in this order."""
    roll, pitch, yaw = angles
    x, y, z = np.eye(3)
    return about(z, yaw) @ about(y, pitch) @ about(x, roll)


def read(path: pathlib.Path) -> Robot:
    """The robot in a file, whose first comment ends in `Root: floating.` where its root link moves freely."""
    content = path.read_bytes()
    tree = ElementTree.fromstring(content)
    for element in tree.iter():
        element.tag = element.tag.rpartition("}")[2]  # {namespace}name
    links = [_link(element) for element in tree.findall("link")]
    root, joints = _tree(tree, {link.name: k for k, link in enumerate(links)})
    header = header_of(path)
    floating = "Root: floating." in header
    base = Joint(
        "",
        "floating" if floating else "fixed",
        -1,
        root,
        np.zeros(3),
        np.eye(3),
        np.zeros(3),
        0.0,
        0.0,
        None,
        None,
    )
    ordered = _numbered(base, joints)
    return Robot(tree.get("name", ""), header, floating, links, ordered)


def header_of(path: pathlib.Path) -> str:
    """What the first comment of a file says of it."""
    text = path.read_text(encoding="utf-8-sig")
    return " ".join(re.search(r"<!--(.*?)-->", text, re.DOTALL).group(1).split())


def _vector(element: ElementTree.Element | None, attribute: str, default: str = "0 0 0") -> np.ndarray:
    text = default if element is None else element.get(attribute, default)
    return np.array([float(part) for part in text.split()])


def _link(element: ElementTree.Element) -> Link:
    inertial = element.find("inertial")
    if inertial is None:
        return Link(element.get("name"), 0.0, np.zeros(3), np.zeros((3, 3)))
    origin = inertial.find("origin")
    moments = inertial.find("inertia")
    of = {key: float(moments.get(key, "0")) for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")}
    inertia = np.array(
        [
            [of["ixx"], of["ixy"], of["ixz"]],
            [of["ixy"], of["iyy"], of["iyz"]],
            [of["ixz"], of["iyz"], of["izz"]],
        ]
    )
    turn = from_roll_pitch_yaw(_vector(origin, "rpy"))
    mass = float(inertial.find("mass").get("value"))
    return Link(element.get("name"), mass, _vector(origin, "xyz"), turn @ inertia @ turn.T)


def _joint(element: ElementTree.Element, links: dict[str, int]) -> Joint:
    origin, axis, limit = element.find("origin"), element.find("axis"), element.find("limit")
    dynamics, mimic = element.find("dynamics"), element.find("mimic")
    kind = element.get("type")
    direction = _vector(axis, "xyz", "1 0 0")
    return Joint(
        name=element.get("name"),
        kind=kind,
        parent=links[element.find("parent").get("link")],
        child=links[element.find("child").get("link")],
        position=_vector(origin, "xyz"),
        rotation=from_roll_pitch_yaw(_vector(origin, "rpy")),
        axis=direction / np.linalg.norm(direction) if VELOCITIES[kind] in (1, 3) else direction,
        damping=0.0 if dynamics is None else float(dynamics.get("damping", "0")),
        friction=0.0 if dynamics is None or kind in ("planar", "floating") else float(dynamics.get("friction", "0")),
        limits=None if limit is None else (float(limit.get("lower", "0")), float(limit.get("upper", "0"))),
        mimic=None
        if mimic is None
        else Mimic(mimic.get("joint"), float(mimic.get("multiplier", "1")), float(mimic.get("offset", "0"))),
    )


def _tree(tree: ElementTree.Element, links: dict[str, int]) -> tuple[int, list[Joint]]:
    """The root link, and the joints in the order of the file."""
    joints = [_joint(element, links) for element in tree.findall("joint")]
    carried = {joint.child for joint in joints}
    [root] = [k for k in links.values() if k not in carried]
    return root, joints


def _numbered(base: Joint, joints: list[Joint]) -> list[Joint]:
    """The joints with each after that of its parent, and with the places of their velocities."""
    carried_by: dict[int, list[Joint]] = {}
    for joint in joints:
        carried_by.setdefault(joint.parent, []).append(joint)
    ordered, waiting, count = [], [base], 0
    while waiting:
        joint = waiting.pop()
        joint.velocities = slice(count, count + VELOCITIES[joint.kind])
        count = joint.velocities.stop
        ordered.append(joint)
        waiting += reversed(carried_by.get(joint.child, []))
    return ordered
