"""Rest and steady motion by a choice of inputs, against closed forms."""

import math

import numpy as np
import pytest

import chetaev

THRUSTS = ["f1", "f2", "f3", "f4"]

LIFT = """
[parameters]
m = 2.0
[inputs]
u = 0.0
w = 0.0
[coordinates]
z = 5.0
[quasi_velocities]
"z'" = {speed}
[lagrangian]
kinetic = "m*z'^2/2"
potential = "m*9.81*z"
[forces]
z = "u + w - 0.5*z'"
"""


def test_a_drone_hovers_and_goes_up() -> None:
    drone = chetaev.Model.builtin("quadrotor").system(start={"p": 0.0, "q": 0.0, "s": 0.0})
    drone.start["v_x"] = 0.0
    hover = drone.trim([*THRUSTS, "θ", "φ"])
    assert [hover.inputs[name] for name in THRUSTS] == pytest.approx([0.5 * 9.81 / 4] * 4, rel=1e-12)
    assert hover.state["θ"] == pytest.approx(0.0, abs=1e-12) and hover.state["ψ"] == 0.3
    assert hover.rates == pytest.approx({"x": 0.0, "y": 0.0, "z": 0.2}, abs=1e-15)
    drone.parameters.update(hover.inputs)
    drone.start.update(hover.state)
    motion = drone.run(2.0)
    assert motion["z"] == pytest.approx(1.0 + 0.2 * motion.t, abs=1e-9)
    assert str(hover).startswith("Quadrotor: at rest or in steady motion") and "f1" in repr(hover)


def test_a_velocity_is_held() -> None:
    for speed in (0.0, 3.0):
        lift = chetaev.Model.from_text(LIFT.replace("{speed}", str(speed))).system()
        assert lift.trim("u").inputs["u"] == pytest.approx(2.0 * 9.81 + 0.5 * speed, rel=1e-14)
        assert lift.trim(["u"]).inputs["w"] == 0.0
    assert lift.parameters["u"] == 0.0  # nothing of the system is changed


def test_under_a_constraint() -> None:
    rod = """
    [inputs]
    f = 0.0
    [coordinates]
    x = 0.6
    y = -0.8
    [constraints]
    rod = "x^2 + y^2 - 1"
    [lagrangian]
    kinetic = "(x'^2 + y'^2)/2"
    potential = "9.81*y"
    [forces]
    x = "f"
    """
    system = chetaev.Model.from_text(rod).system()
    assert system.trim().inputs["f"] == pytest.approx(9.81 * 0.6 / 0.8, rel=1e-12)
    system.parameters["f"] = 9.81
    found = system.trim(["x", "y"]).state
    assert (found["x"], found["y"]) == pytest.approx((math.sqrt(0.5), -math.sqrt(0.5)), rel=1e-9)


def test_what_cannot_be_trimmed_is_said() -> None:
    lift = chetaev.Model.from_text(LIFT.replace("{speed}", "0.0")).system()
    with pytest.raises(chetaev.ChetaevError, match="u, w|`u`, `w`"):
        lift.trim()  # only their sum is determined
    with pytest.raises(chetaev.ChetaevError, match="neither a component of the state nor an input here; these are z"):
        lift.trim(["v"])
    still = chetaev.Model.builtin("quadrotor").system()
    with pytest.raises(chetaev.ChetaevError, match="the rates vanish for no values of f1, f2, f3, f4"):
        still.trim()
    with pytest.raises(ValueError, match="name what is free"):
        chetaev.Model.builtin("heavy-top-lagrange").system().trim()
    with pytest.raises(chetaev.ChetaevError, match="depend on time"):
        chetaev.Model.from_text(LIFT.replace("{speed}", "0.0")).system(inputs={"u": ([0, 1], [0, 1])}).trim(["w"])
    assert np.isfinite(lift.y0).all()
