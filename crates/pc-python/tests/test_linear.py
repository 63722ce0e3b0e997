"""Linearizations, root loci and equilibria against closed forms."""

import numpy as np
import pytest

import chetaev

OSCILLATOR = """
[parameters]
m = 2.0
c = 0.3
k = 5.0
[inputs]
u = 0.0
[coordinates]
x = 0.0
[lagrangian]
kinetic = "m*x'^2/2"
potential = "k*x^2/2"
[forces]
x = "u - c*x'"
[outputs]
twice = "2*x"
"""

PENDULUM = """
[parameters]
g = 9.81
l = 0.5
[coordinates]
"θ" = 0.4
[lagrangian]
kinetic = "l^2*θ'^2/2"
potential = "-g*l*cos(θ)"
[simulation]
t_end = 1.0
"""


def test_an_oscillator_has_its_matrices() -> None:
    linear = chetaev.Model.from_text(OSCILLATOR).linearize()
    assert linear.components == ("x", "x'") and linear.inputs == ("u",) and linear.outputs == ("twice",)
    assert linear.A == pytest.approx(np.array([[0.0, 1.0], [-2.5, -0.15]]), abs=1e-15)
    assert linear.B == pytest.approx(np.array([[0.0], [0.5]]), abs=1e-15)
    assert linear.C == pytest.approx(np.array([[2.0, 0.0]])) and linear.D == pytest.approx(np.array([[0.0]]))
    assert linear.eigenvalues == pytest.approx(np.roots([2.0, 0.3, 5.0]), abs=1e-12)
    second = linear.second_order
    assert second is not None and second["M"] == pytest.approx(2.0) and second["K"] == pytest.approx(5.0)
    assert linear.is_steady and linear.stability is not None and "stable" in linear.stability
    assert "eigenvalues" in str(linear) and repr(linear) == "<Linearization in x, x', inputs u>"


def test_a_linearization_is_a_system_of_scipy() -> None:
    signal = pytest.importorskip("scipy.signal")
    space = chetaev.Model.from_text(OSCILLATOR).linearize().to_scipy()
    assert isinstance(space, signal.StateSpace)
    t, x = signal.impulse(space, T=np.array([0.0, 0.5, 1.0]))
    rate, frequency = 0.075, np.sqrt(2.5 - 0.075**2)
    assert x == pytest.approx(np.exp(-rate * t) * np.sin(frequency * t) / frequency, abs=1e-9)
    whole = chetaev.Model.from_text(PENDULUM).linearize().to_scipy()
    assert whole.C.shape == (2, 2)


def test_eigenvalues_follow_a_parameter() -> None:
    lengths = [0.25, 0.5, 1.0]
    locus = chetaev.Model.from_text(PENDULUM).root_locus("l", lengths)
    assert locus.parameter == "l" and list(locus.values) == lengths and locus.missing == {}
    assert np.abs(locus.branches.imag).max(axis=0) == pytest.approx(np.sqrt(9.81 / np.array(lengths)), rel=1e-9)
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    assert len(locus.plot().axes[0].lines) == 3


def test_a_pendulum_rests_below_and_above() -> None:
    found = chetaev.Model.from_text(PENDULUM).equilibria()
    angles = {round(abs(one.state["θ"]), 9): one for one in found}
    assert set(angles) == {0.0, round(np.pi, 9)} and len(found) == 2
    assert angles[0.0].stability.startswith("stable") and angles[0.0].energy == pytest.approx(-4.905)
    above = angles[round(np.pi, 9)]
    assert above.stability.startswith("unstable")
    assert max(above.eigenvalues.real) == pytest.approx(np.sqrt(9.81 / 0.5))


def test_what_is_not_there_is_said() -> None:
    model = chetaev.Model.from_text(PENDULUM)
    with pytest.raises(ValueError, match="choose one of steady, rest, start"):
        model.linearize("nowhere")
    with pytest.raises(chetaev.ChetaevError, match="no component `φ`"):
        model.linearize(hold=["φ"])
    driven = PENDULUM.replace("-g*l*cos(θ)", "-g*l*cos(θ) + θ*sin(t)")
    with pytest.raises(chetaev.ChetaevError, match="depend on time"):
        chetaev.Model.from_text(driven).linearize()
