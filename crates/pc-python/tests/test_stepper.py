"""Motions step by step under inputs, and from other starts."""

import numpy as np
import pytest

import chetaev

CART = """
[parameters]
m = 2.0
[inputs]
u = 0.0
w = 0.0
[coordinates]
x = 1.0
[quasi_velocities]
"x'" = -1.0
[lagrangian]
kinetic = "m*x'^2/2"
[forces]
x = "u + w"
[events]
wall = { when = "x - 100", direction = "rising", terminal = true }
floor = { when = "x", direction = "falling", reset = { "x'" = "-0.5*x'" } }
[simulation]
t_end = 1.0
"""


def test_a_cart_goes_by_its_inputs() -> None:
    stepper = chetaev.Model.from_text(CART).system().stepper()
    dt, x, v = 0.125, 1.0, -1.0
    for k in range(40):
        force = 3.0 + np.sin(k)
        y = stepper.step(dt, [force, 1.0])
        a = (force + 1.0) / 2.0
        x, v = x + v * dt + a * dt**2 / 2, v + a * dt
        assert y == pytest.approx([x, v], rel=1e-8)
    assert stepper.t == 40 * dt and (stepper.y == y).all()
    # Inputs stay as they are.
    assert stepper.step(dt)[1] == pytest.approx(v + a * dt, rel=1e-8)


def test_events_occur_in_steps() -> None:
    stepper = chetaev.Model.from_text(CART).system().stepper(rtol=1e-11)
    y = stepper.step(1.5)
    assert y == pytest.approx([0.25, 0.5], abs=1e-9)
    while stepper.terminal is None:
        stepper.step(1.0, [50.0, 0.0])
    assert stepper.terminal == "wall" and stepper.y[0] == pytest.approx(100.0)
    stopped = stepper.t
    assert stepper.step(1.0)[0] == pytest.approx(100.0) and stepper.t == stopped
    stepper.restart()
    assert stepper.t == 0.0 and list(stepper.y) == [1.0, -1.0] and stepper.terminal is None
    stepper.restart([2.0, 3.0], 5.0)
    assert stepper.t == 5.0 and list(stepper.y) == [2.0, 3.0]
    assert len(stepper.row()) == len(chetaev.Model.from_text(CART).system().columns)


def test_what_is_wrong_is_said() -> None:
    stepper = chetaev.Model.from_text(CART).system().stepper()
    with pytest.raises(ValueError, match="inputs has 1 numbers instead of 2"):
        stepper.step(0.1, [1.0])
    with pytest.raises(ValueError, match="not a finite number"):
        stepper.step(0.1, [1.0, float("nan")])
    with pytest.raises(ValueError, match="the state has 3 numbers instead of 2"):
        stepper.restart([1.0, 2.0, 3.0])
    table = CART.replace("u = 0.0", "u = { times = [0.0, 1.0], values = [0.0, 1.0] }")
    with pytest.raises(chetaev.ChetaevError, match="follows a table"):
        chetaev.Model.from_text(table).system().stepper()


def test_a_run_from_another_state_is_that_of_another_start() -> None:
    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    start = system.y0 + [0.0, 0.0, 0.0, 0.1, -0.2, 0.3]
    motion = system.run(2.0, samples=11, y0=start)
    assert (motion.y[:, 0] == start).all() and (motion.dense(0.0) == start).all()
    system.start.update({"ω1": start[3], "ω2": start[4], "ω3": start[5]})
    assert (system.run(2.0, samples=11).y == motion.y).all()
    with pytest.raises(ValueError, match="numbers instead of"):
        system.run(2.0, y0=[1.0])


ROD = """
[coordinates]
x = 0.0
y = -1.0
[constraints]
rod = "x^2 + y^2 - 1"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "9.81*y"
[simulation]
t_end = 1.0
"""


def test_a_state_off_the_constraints_is_refused() -> None:
    system = chetaev.Model.from_text(ROD).system()
    aside = [np.sin(0.3), -np.cos(0.3), 0.0, 0.0]
    assert system.run(y0=aside).drift["energy"] < 1e-8
    stepper = system.stepper()
    stepper.restart(aside)
    assert stepper.step(0.5)[1] < 0.0
    for wrong in ([0.1, -1.0, 0.0, 0.0], [0.0, -1.0, 1.0, 0.5], [float("nan"), -1.0, 0.0, 0.0]):
        with pytest.raises((ValueError, chetaev.EvaluationError), match="off the constraints|not a finite number"):
            system.run(y0=wrong)
        with pytest.raises((ValueError, chetaev.EvaluationError), match="off the constraints|not a finite number"):
            stepper.restart(wrong)


def test_a_step_of_no_length_sets_inputs() -> None:
    stepper = chetaev.Model.from_text(CART).system().stepper()
    assert list(stepper.step(0.0, [8.0, 0.0])) == [1.0, -1.0]
    assert stepper.step(0.5)[1] == pytest.approx(1.0, abs=1e-8)
