"""The dynamics of a tree of rigid bodies: Newton–Euler and the composite bodies, by recursion.

A velocity of a body is the six numbers [ω; v] of its turning and of its origin, in its own axes; a force is
[n; f], the moment about that origin and the force. The joint of body i adds S_i q̇_i to what the body has
from its parent p:

    v_i = X_i v_p + S_i q̇_i
    a_i = X_i a_p + S_i q̈_i + Ṡ_i q̇_i + v_i × S_i q̇_i
    f_i = I_i a_i + v_i ×* I_i v_i + Σ X_cᵀ f_c        over the children c
    τ_i = S_iᵀ f_i

(Featherstone, Rigid Body Dynamics Algorithms, 2008, tables 5.1 and 6.2.) Gravity is an acceleration of the
world, upwards. The mass matrix comes from the composite bodies: the inertia of a joint with all that it
carries, handed down the tree.

Where a joint follows another one, the velocities of all joints are u = G q̇ with a constant matrix G, and
what is moved by q̇ has the mass matrix GᵀMG and the forces Gᵀτ.

The state of a robot is given joint by joint: `q` and `v`, the latter with as many numbers as the joint has
velocities.

    turning, sliding   q: angle or length           v: its rate
    planar             q: x, y, φ                   v: their rates
    floating           q: x, y, z, q0, q1, q2, q3   v: of the origin, then ω, both in the axes of the link

A planar joint slides along the two axes of the joint that follow its normal: x and y where that is z.
"""

import dataclasses

import numpy as np

from robot import Joint, Robot, about, skew

GRAVITY = 9.81
"""The acceleration of gravity, along -z of the world."""


@dataclasses.dataclass
class State:
    """Positions and velocities of all joints, by name; the root of a floating robot is the joint "" """

    q: dict[str, np.ndarray]
    v: dict[str, np.ndarray]


@dataclasses.dataclass
class Dynamics:
    """M q̈ + h = 0 in the velocities that are free, in the order of `names`.

    `mass` is M; `bias` is h, the forces that hold q̈ at zero against gravity, dampings, dry friction and the velocities.
    """

    names: list[str]
    mass: np.ndarray
    bias: np.ndarray

    def accelerations(self) -> np.ndarray:
        """The solution q̈."""
        return self.solved(self.bias)

    def solved(self, forces: np.ndarray) -> np.ndarray:
        """−M⁻¹ times forces, by Cholesky's factors of the matrix scaled to a unit diagonal."""
        scale = 1.0 / np.sqrt(np.diag(self.mass))
        lower = np.linalg.cholesky(self.mass * np.outer(scale, scale))
        return -scale * np.linalg.solve(lower.T, np.linalg.solve(lower, scale * forces))


def dynamics(robot: Robot, state: State) -> Dynamics:
    """The equations of motion at a state."""
    tree = Tree(robot, state)
    free, spread = reduction(robot)
    damping = np.concatenate([np.full(_count(joint), joint.damping) for joint in robot.joints])
    velocities = tree.velocities
    friction = np.concatenate([np.full(_count(joint), joint.friction) for joint in robot.joints])
    forces = tree.forces(np.zeros(robot.size)) + damping * velocities + friction * np.sign(velocities)
    names = [joint.name for joint in free for _ in range(_count(joint))]
    return Dynamics(names, spread.T @ tree.mass_matrix() @ spread, spread.T @ forces)


def derivative(robot: Robot, state: State, direction: State, equations: Dynamics) -> np.ndarray:
    """How the accelerations change along a direction of states: δa with M δa + δτ = 0.

    δτ is the change of the forces τ(q, v, a) of Newton–Euler at constant accelerations (Carpentier & Mansard 2018),
    and the imaginary part of their value at the complex state that is ε i away in the direction, divided by ε: exact
    to rounding, since no difference is taken (Squire & Trapp 1998).
    """
    step = 1e-30
    beside = State(*(
        {name: value + 1j * step * np.asarray(along[name]) for name, value in one.items()}
        for one, along in ((state.q, direction.q), (state.v, direction.v))
    ))
    _, spread = reduction(robot)
    tree = Tree(robot, beside)
    damping = np.concatenate([np.full(_count(joint), joint.damping) for joint in robot.joints])
    forces = tree.forces(spread @ equations.accelerations()) + damping * tree.velocities
    return equations.solved(spread.T @ forces.imag / step)


def reduction(robot: Robot) -> tuple[list[Joint], np.ndarray]:
    """The joints that follow no other, and G, from their velocities to those of all joints."""
    by_name = {joint.name: joint for joint in robot.joints}
    free = [joint for joint in robot.joints if joint.mimic is None and _count(joint) > 0]
    place, count = {}, 0
    for joint in free:
        place[joint.name] = count
        count += _count(joint)
    spread = np.zeros((robot.size, count))
    for joint in robot.joints:
        if joint.mimic is None:
            for k in range(_count(joint)):
                spread[joint.velocities.start + k, place[joint.name] + k] = 1.0
        else:
            leader, factor, _ = led(joint, by_name)
            spread[joint.velocities.start, place[leader.name]] = factor
    return free, spread


def led(joint: Joint, by_name: dict[str, Joint]) -> tuple[Joint, float, float]:
    """The leader at the end of a chain of followers, with q = factor · q_leader + offset."""
    factor, offset = 1.0, 0.0
    while joint.mimic is not None:
        offset += factor * joint.mimic.offset
        factor *= joint.mimic.multiplier
        joint = by_name[joint.mimic.leader]
    return joint, factor, offset


class Tree:
    """The robot at a state: how each body stands and moves relative to its parent."""

    def __init__(self, robot: Robot, state: State) -> None:
        self.robot = robot
        self.velocities = np.concatenate([state.v.get(joint.name, np.zeros(0)) for joint in robot.joints])
        self.from_parent, self.subspace, self.subspace_rate = [], [], []
        for joint in robot.joints:
            q, v = state.q.get(joint.name), state.v.get(joint.name)
            turn, shift, subspace, rate = _motion(joint, q, v)
            self.from_parent.append(
                _transform(joint.rotation @ turn, joint.position + joint.rotation @ shift)
            )
            self.subspace.append(subspace)
            self.subspace_rate.append(rate)
        carrier = {joint.child: k for k, joint in enumerate(robot.joints)}
        self.parent = [carrier.get(joint.parent, -1) for joint in robot.joints]
        self.inertia = [_inertia(robot.links[joint.child]) for joint in robot.joints]

    def forces(self, accelerations: np.ndarray) -> np.ndarray:
        """The forces of the joints under which they have these accelerations: Newton–Euler."""
        upwards = np.array([0.0, 0.0, 0.0, 0.0, 0.0, GRAVITY])
        velocity, acceleration, force = [], [], []
        for k, joint in enumerate(self.robot.joints):
            u, du = self.velocities[joint.velocities], accelerations[joint.velocities]
            by_joint = self.subspace[k] @ u
            p, x = self.parent[k], self.from_parent[k]
            v = by_joint + (x @ velocity[p] if p >= 0 else 0.0)
            a = x @ (acceleration[p] if p >= 0 else upwards)
            a = a + self.subspace[k] @ du + self.subspace_rate[k] @ u + _cross_motion(v) @ by_joint
            velocity.append(v)
            acceleration.append(a)
            force.append(self.inertia[k] @ a - _cross_motion(v).T @ (self.inertia[k] @ v))
        result = np.zeros_like(force[0], shape=self.robot.size)
        for k in reversed(range(len(force))):
            result[self.robot.joints[k].velocities] = self.subspace[k].T @ force[k]
            if self.parent[k] >= 0:
                force[self.parent[k]] = force[self.parent[k]] + self.from_parent[k].T @ force[k]
        return result

    def mass_matrix(self) -> np.ndarray:
        """The matrix M of the kinetic energy u·M u/2 of all joints: the composite bodies."""
        composite = [inertia.copy() for inertia in self.inertia]
        mass = np.zeros((self.robot.size, self.robot.size))
        for k in reversed(range(len(composite))):
            here = self.robot.joints[k].velocities
            force = composite[k] @ self.subspace[k]
            mass[here, here] = self.subspace[k].T @ force
            x, p = self.from_parent[k], self.parent[k]
            if p >= 0:
                composite[p] += x.T @ composite[k] @ x
            while p >= 0:
                force = x.T @ force
                there = self.robot.joints[p].velocities
                mass[there, here] = self.subspace[p].T @ force
                mass[here, there] = mass[there, here].T
                x, p = self.from_parent[p], self.parent[p]
        return mass


def _count(joint: Joint) -> int:
    return joint.velocities.stop - joint.velocities.start


def _motion(
    joint: Joint, q: np.ndarray, v: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """How the joint turns and shifts its child, S, and the rate of S in the axes of the child."""
    still, zero, axis = np.eye(3), np.zeros(3), joint.axis
    match joint.kind:
        case "fixed":
            return still, zero, np.zeros((6, 0)), np.zeros((6, 0))
        case "revolute" | "continuous":
            return about(axis, q[0]), zero, _column(axis, zero), np.zeros((6, 1))
        case "prismatic":
            return still, axis * q[0], _column(zero, axis), np.zeros((6, 1))
        case "planar":
            along = plane(axis)
            turn = about(axis, q[2])
            slides = turn.T @ along
            subspace = np.block([[np.zeros((3, 2)), axis[:, None]], [slides, np.zeros((3, 1))]])
            rate = np.block([[np.zeros((3, 3))], [-v[2] * skew(axis) @ slides, np.zeros((3, 1))]])
            return turn, along @ q[:2], subspace, rate
        case "floating":
            subspace = np.block([[np.zeros((3, 3)), np.eye(3)], [np.eye(3), np.zeros((3, 3))]])
            return from_quaternion(q[3:]), q[:3], subspace, np.zeros((6, 6))
    raise ValueError(f"the joint {joint.name} has an unknown type {joint.kind}")


def plane(normal: np.ndarray) -> np.ndarray:
    """The two axes that follow a normal along x, y or z, as columns."""
    [which] = np.flatnonzero(normal)
    return np.eye(3)[:, [(which + 1) % 3, (which + 2) % 3]]


def from_quaternion(q: np.ndarray) -> np.ndarray:
    """The rotation of a unit quaternion, scalar first: 1 + 2 q0 [e] + 2 [e]²."""
    cross = skew(q[1:])
    return np.eye(3) + 2.0 * q[0] * cross + 2.0 * cross @ cross


def _column(turning: np.ndarray, sliding: np.ndarray) -> np.ndarray:
    return np.concatenate([turning, sliding])[:, None]


def _transform(rotation: np.ndarray, position: np.ndarray) -> np.ndarray:
    """X: velocities in the axes of the parent, at its origin, to those of the child, at its own."""
    to_child = rotation.T
    return np.block([[to_child, np.zeros((3, 3))], [-to_child @ skew(position), to_child]])


def _cross_motion(v: np.ndarray) -> np.ndarray:
    """The matrix of v × of velocities; that of forces, ×*, is minus its transpose."""
    turning, sliding = skew(v[:3]), skew(v[3:])
    return np.block([[turning, np.zeros((3, 3))], [sliding, turning]])


def _inertia(link) -> np.ndarray:
    """The inertia of a link about its origin, which takes [ω; v] to momenta."""
    c, m = skew(link.centre), link.mass
    return np.block([[link.inertia + m * c @ c.T, m * c], [m * c.T, m * np.eye(3)]])
