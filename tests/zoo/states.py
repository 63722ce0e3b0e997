"""A state for each robot, which is the same on every machine: drawn from the name of the file."""

import random

import numpy as np

from rigid_bodies import State, from_quaternion, led
from robot import Joint, Robot


def of(robot: Robot, name: str) -> State:
    """A state inside the limits of the joints, in numbers of few digits."""
    draw = random.Random(name)
    q, v = {}, {}
    for joint in sorted(
        (joint for joint in robot.joints if joint.mimic is None), key=lambda joint: joint.name
    ):
        q[joint.name], v[joint.name] = _drawn(joint, draw)
    return with_followers(robot, State(q, v))


def direction_of(robot: Robot, name: str, state: State) -> State:
    """A direction in which the state can change: rates of q, along which quaternions keep their length, and of v."""
    draw = random.Random(f"{name}, direction")
    q, v = {}, {}
    for joint in sorted(
        (joint for joint in robot.joints if joint.mimic is None), key=lambda joint: joint.name
    ):
        rates, v[joint.name] = (_uniform(draw, 1.0, len(state.v[joint.name])) for _ in range(2))
        q[joint.name] = _moved(state.q[joint.name], rates)
    by_name = {joint.name: joint for joint in robot.joints}
    for joint in robot.joints:
        if joint.mimic is not None:
            leader, factor, _ = led(joint, by_name)
            q[joint.name], v[joint.name] = factor * q[leader.name], factor * v[leader.name]
    return State(q, v)


def rates_of(q: np.ndarray, along: np.ndarray) -> np.ndarray:
    """The velocities, as in `State.v`, with which q moves along a direction."""
    if len(q) != 7:
        return along
    scalar, vector = q[3], q[4:]
    turning = 2.0 * (scalar * along[4:] - along[3] * vector - np.cross(vector, along[4:]))
    return np.concatenate([from_quaternion(q[3:]).T @ along[:3], turning])


def _moved(q: np.ndarray, rates: np.ndarray) -> np.ndarray:
    """ẋ = R v and q̇ = q ω / 2 of a joint that moves freely; of others, the rates themselves."""
    if len(q) != 7:
        return rates
    scalar, vector, turning = q[3], q[4:], rates[3:]
    turned = np.concatenate([[-vector @ turning], scalar * turning + np.cross(vector, turning)]) / 2.0
    return np.concatenate([from_quaternion(q[3:]) @ rates[:3], turned])


def with_followers(robot: Robot, state: State) -> State:
    """The state with the joints that follow others where these put them."""
    by_name = {joint.name: joint for joint in robot.joints}
    q, v = dict(state.q), dict(state.v)
    for joint in robot.joints:
        if joint.mimic is not None:
            leader, factor, offset = led(joint, by_name)
            q[joint.name] = factor * state.q[leader.name] + offset
            v[joint.name] = factor * state.v[leader.name]
    return State(q, v)


def _drawn(joint: Joint, draw: random.Random) -> tuple[np.ndarray, np.ndarray]:
    match joint.kind:
        case "fixed":
            return np.zeros(0), np.zeros(0)
        case "planar":
            return _uniform(draw, 1.0, 3), _uniform(draw, 1.0, 3)
        case "floating":
            turn = np.array([1.0, 0.0, 0.0, 0.0]) + _uniform(draw, 0.7, 4)
            return np.concatenate([_uniform(draw, 1.0, 3), turn / np.linalg.norm(turn)]), _uniform(
                draw, 1.0, 6
            )
    lower, upper = _range(joint)
    q = lower + (upper - lower) * draw.uniform(0.05, 0.95)
    rate = 1.0 if joint.kind != "prismatic" else (upper - lower) / 2.0
    return np.array([_short(q)]), np.array([_short(draw.uniform(-rate, rate))])


def _range(joint: Joint) -> tuple[float, float]:
    """The limits, at most half a turn or half a metre to each side."""
    most = 0.5 if joint.kind == "prismatic" else np.pi
    lower, upper = joint.limits or (-most, most)
    lower, upper = (max(lower, -most), min(upper, most)) if lower < upper else (-most, most)
    return (lower, upper) if lower < upper else (-most, most)


def _uniform(draw: random.Random, most: float, count: int) -> np.ndarray:
    return np.array([_short(draw.uniform(-most, most)) for _ in range(count)])


def _short(number: float) -> float:
    return float(f"{number:.4g}")
