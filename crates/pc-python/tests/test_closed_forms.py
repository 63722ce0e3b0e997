"""Motions known in closed form, and what they keep."""

import numpy as np
import pytest

import chetaev

SYMMETRIC_TOP = """
[parameters]
I1 = 2.0
I3 = 1.0
[quasi_velocities]
"ω1" = 0.3
"ω2" = 0.4
"ω3" = 2.0
[algebra]
name = "so3"
[lagrangian]
kinetic = "(I1*(ω1^2 + ω2^2) + I3*ω3^2)/2"
"""


@pytest.mark.parametrize("method", ["adams", "bdf", "dop853", "taylor", "auto"])
def test_a_free_symmetric_top_precesses(method: str) -> None:
    # ω1 + i ω2 turns at the rate λ = (I3 − I1)/I1 ω3.
    motion = chetaev.Model.from_text(SYMMETRIC_TOP).system().run(10.0, method=method, rtol=1e-10, atol=1e-13)
    turned = (0.3 + 0.4j) * np.exp(1j * (1.0 - 2.0) / 2.0 * 2.0 * motion.t)
    # Errors of steps of 1e-10 over some hundreds of steps.
    assert np.abs(motion["ω1"] + 1j * motion["ω2"] - turned).max() < 1e-7
    assert motion.ending == "completed"


def test_a_bouncing_ball_comes_back_as_it_should() -> None:
    text = """
    [parameters]
    g = 9.81
    e = 0.5
    [coordinates]
    z = 1.0
    [lagrangian]
    kinetic = "z'^2/2"
    potential = "g*z"
    [events.bounce]
    when = "z"
    direction = "falling"
    reset = { "z'" = "-e*z'" }
    """
    motion = chetaev.Model.from_text(text).system().run(1.0, samples=5)
    fall = np.sqrt(2 / 9.81)
    assert [event.name for event in motion.events] == ["bounce", "bounce"]
    # Zeros are found to 1e-12 of a quadratic.
    assert np.allclose([event.t for event in motion.events], [fall, 2 * fall], rtol=0, atol=1e-9)
    first = motion.events[0]
    assert first.after[1] == pytest.approx(-0.5 * first.before[1], rel=1e-15)


def test_sensitivities_of_an_oscillator() -> None:
    text = """
    [parameters]
    k = 4.0
    [coordinates]
    x = 1.0
    [lagrangian]
    kinetic = "x'^2/2"
    potential = "k*x^2/2"
    """
    motion = chetaev.Model.from_text(text).system().run(3.0, sensitivities=["k"])
    # x = cos(√k t)
    exact = -np.sin(2 * motion.t) * motion.t / 4
    assert np.abs(motion.sensitivity("x", "k") - exact).max() < 1e-6


def test_errors_of_an_oscillator_are_estimated() -> None:
    text = """
    [coordinates]
    x = 1.0
    [lagrangian]
    kinetic = "x'^2/2"
    potential = "x^2/2"
    """
    system = chetaev.Model.from_text(text).system()
    motion = system.run(100.0, rtol=1e-6, estimate=True)
    error = np.abs(motion["x"] - np.cos(motion.t))
    # The companion is known to rounding.
    assert np.abs(motion["error(x)"] - error).max() < 1e-3 * error.max()
    assert "error(energy)" in motion.columns and "error(x)" not in system.run(1.0).columns
    assert motion.statistics["stiff_from"] is None and motion.statistics["changes"] == 0


def test_lyapunov_exponents_of_a_saddle() -> None:
    text = """
    [coordinates]
    x = 0.0
    [lagrangian]
    kinetic = "x'^2/2"
    potential = "-x^2/2"
    """
    found = chetaev.Model.from_text(text).system().lyapunov(2, interval=1.0, intervals=30, transient=10)
    # ẍ = x has ±1.
    assert found.exponents == pytest.approx([1.0, -1.0], abs=1e-6)
    assert found.history.shape == (30, 2)


def test_terminal_events_end_a_motion() -> None:
    system = chetaev.Model.from_text(SYMMETRIC_TOP).system()
    motion = system.run(10.0, events={"across": chetaev.Event("ω1", terminal=True)})
    # The angle of (0.3, 0.4) goes down to −π/2 or up to π/2; the rate is −1.
    assert motion.terminal == "across"
    assert motion.t[-1] == pytest.approx(np.arctan2(0.4, 0.3) + np.pi / 2, abs=1e-7)


def test_dense_output_meets_the_rows() -> None:
    motion = chetaev.Model.from_text(SYMMETRIC_TOP).system().run(5.0)
    assert np.abs(motion.dense(motion.t) - motion.y).max() < 1e-9
    assert motion.dense(1.0).shape == (3,)
    with pytest.raises(ValueError, match="not between|outside|span"):
        motion.dense(6.0)


def test_mass_matrix_brackets_and_energy() -> None:
    system = chetaev.Model.from_text(SYMMETRIC_TOP).system()
    y = system.y0
    assert (system.mass_matrix(0.0, y) == np.diag([2.0, 2.0, 1.0])).all()
    assert system.energy(0.0, y) == pytest.approx((2 * (0.09 + 0.16) + 4.0) / 2, rel=1e-15)
    # By (12), (y_1, y_2) = c_21^m y_m, which is −y_3 on so(3).
    assert system.bracket("I1*ω1", "I1*ω2")(0.0, y) == pytest.approx(-2.0, rel=1e-15)
    # (f, H) is the rate of f where nothing depends on time.
    rate = system.bracket("ω1", "(I1*(ω1^2 + ω2^2) + I3*ω3^2)/2")(0.0, y)
    assert rate == pytest.approx(system(0.0, y)[0], rel=1e-14)


def test_coriolis_matrix_of_a_double_pendulum() -> None:
    # Rods as points of mass 1 at lengths 1 and 2, in absolute angles: M_12 = 2 cos(α − β).
    text = """
    [coordinates]
    "α" = 0.3
    "β" = -0.8
    [quasi_velocities]
    "α'" = 0.7
    "β'" = -1.1
    [lagrangian]
    kinetic = "α'^2 + 2*β'^2 + 2*cos(α - β)*α'*β'"
    potential = "-9.81*(2*cos(α) + 2*cos(β))"
    """
    system = chetaev.Model.from_text(text).system()
    y = system.y0
    h = 2 * np.sin(1.1)
    c = system.coriolis(0.0, y)
    assert c == pytest.approx(np.array([[0.0, -1.1 * h], [-0.7 * h, 0.0]]), rel=1e-14)
    assert c @ y[2:] + system.gravity_compensation(0.0, y) == pytest.approx(system.bias(0.0, y), rel=1e-13)


def test_momentum_and_jacobians_of_two_bodies() -> None:
    # A cart with a pendulum of length l = 2: v = (x' + l φ' cos φ, 0, l φ' sin φ) of the bob.
    text = """
    [coordinates]
    x = 0.4
    "φ" = 0.6
    [quasi_velocities]
    "x'" = 1.5
    "φ'" = -0.5
    [gravity]
    acceleration = [0, 0, -9.81]
    [bodies.cart]
    mass = 3
    position = ["x", 0, 0]
    [bodies.bob]
    mass = 1
    position = ["x + 2*sin(φ)", 0, "-2*cos(φ)"]
    """
    for form in ("poincare", "canonical", "orthonormal"):
        system = chetaev.Model.from_text(text).system(form)
        y = system.y0
        columns = system.observe(0.0, y)
        speed = np.array([1.5 - np.cos(0.6), 0.0, -np.sin(0.6)])
        eta = [1.5, -0.5] if form == "canonical" else y[2:]
        bob = system.body_jacobian(0.0, y, "bob")
        assert bob.matrix.shape == (6, 2)
        assert bob.matrix @ eta + bob.rest == pytest.approx(np.concatenate([speed, np.zeros(3)]), abs=1e-14)
        momentum = system.centroidal(0.0, y)
        assert (momentum.matrix @ eta)[:3] == pytest.approx(3 * np.array([1.5, 0, 0]) + speed, abs=1e-14)
        centre = system.centre_of_mass(0.0, y)
        assert centre == pytest.approx([0.4 + 0.5 * np.sin(0.6), 0.0, -0.5 * np.cos(0.6)], abs=1e-15)
        moving = system.centre_of_mass_jacobian(0.0, y)
        assert 4 * moving.matrix == pytest.approx(momentum.matrix[:3], abs=1e-14)
        # The weight is all that acts along x and on the mass centre from outside, except the force on the cart along z.
        if form != "canonical":
            assert (moving.matrix @ system(0.0, y)[2:] + moving.rate)[0] == pytest.approx(0.0, abs=1e-14)
        assert columns["x"] == 0.4
    with pytest.raises(chetaev.ModelError, match="no body and no point has the name `bb`"):
        system.body_jacobian(0.0, system.y0, "bb")


def test_canonical_equations_give_the_same_motion() -> None:
    model = chetaev.Model.from_text(SYMMETRIC_TOP)
    momenta = model.system("canonical")
    assert np.allclose(momenta.y0, [0.6, 0.8, 2.0], rtol=1e-15)
    assert (momenta.mass_matrix(0.0, momenta.y0) == np.diag([2.0, 2.0, 1.0])).all()
    one, other = momenta.run(5.0), model.system().run(5.0)
    assert np.abs(one["ω1"] - other["ω1"]).max() < 1e-7


def test_a_small_component_has_a_tolerance_of_its_own() -> None:
    # A charge q = a cos 2t beside an angle φ = cos t.
    text = """
[coordinates]
q = 1e-15
"φ" = 1
[lagrangian]
kinetic = "(q'^2 + φ'^2)/2"
potential = "2*q^2 + φ^2/2"
"""
    system = chetaev.Model.from_text(text).system()
    motion = system.run(5.0, samples=11, atol={"q": 1e-25, "q'": 1e-25})
    # Tolerances of 1e-9 over three periods.
    assert np.allclose(motion["q"] / 1e-15, np.cos(2 * motion.t), rtol=0, atol=1e-7)
    by_text = chetaev.Model.from_text(text + '[simulation]\natol = { q = 1e-25, "q\'" = 1e-25 }\n').system()
    assert (by_text.run(5.0, samples=11)["q"] == motion["q"]).all()
    with pytest.raises(chetaev.ChetaevError, match="`p` has no start value"):
        system.run(5.0, atol={"p": 1e-9})
