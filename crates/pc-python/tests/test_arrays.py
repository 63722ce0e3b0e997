"""Arrays of states against one state after the other."""

import numpy as np
import pytest
from conftest import KINDS, regular_states

import chetaev


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize("order", ["C", "F"])
def test_arrays_are_loops(name: str, order: str) -> None:
    system = chetaev.Model.builtin(name).system()
    n = len(system.names)
    # More than one block of states, and not a whole number of them.
    states = np.asarray(regular_states(system, 151), order=order)
    rates, jacobians, energies = (f(0.25, states) for f in (system, system.jac, system.energy))
    assert rates.shape == (n, 151) and jacobians.shape == (n, n, 151) and energies.shape == (151,)
    for k in range(151):
        assert (rates[:, k] == system(0.25, states[:, k])).all()
        assert (jacobians[:, :, k] == system.jac(0.25, states[:, k])).all()
        assert energies[k] == system.energy(0.25, states[:, k])


def test_each_state_may_have_its_time() -> None:
    text = """
    [coordinates]
    x = 0.0
    [lagrangian]
    kinetic = "x'^2/2"
    [forces]
    x = "cos(t)"
    """
    system = chetaev.Model.from_text(text).system()
    times = np.linspace(0.0, 3.0, 100)
    rates = system(times, np.zeros((2, 100)))
    # The cosines of libm and of machine code differ by rounding.
    assert np.abs(rates[1] - np.cos(times)).max() < 1e-15
    with pytest.raises(ValueError, match="t has 3 numbers instead of 100"):
        system(np.zeros(3), np.zeros((2, 100)))


def test_any_layout_and_type_of_numbers() -> None:
    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    expected = system(0.0, system.y0)
    assert (system(0, list(system.y0)) == expected).all()
    assert (system(np.float64(0.0), tuple(system.y0)) == expected).all()
    wide = np.zeros((6, 5))
    wide[:, 2] = system.y0
    assert (system(0.0, wide[:, 2]) == expected).all()
    strided = np.repeat(system.y0[:, None], 8, axis=1)[:, ::2]
    assert (system(0.0, strided) == expected[:, None]).all()
    single = system.y0.astype(np.float32)
    assert (system(0.0, single) == system(0.0, single.astype(float))).all()
    assert system(0.0, np.zeros((6, 0))).shape == (6, 0)


def test_the_jacobian_is_that_of_differences() -> None:
    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    y, step = system.y0, 1e-6
    moved = y[:, None] + step * np.hstack([np.eye(6), -np.eye(6)])
    rates = system(0.0, moved)
    quotients = (rates[:, :6] - rates[:, 6:]) / (2 * step)
    # The rates are quadratic, so that only rounding is left: 1e-16/1e-6.
    assert np.abs(system.jac(0.0, y) - quotients).max() < 1e-8
    assert ((system.jac(0.0, y) != 0) <= system.jac_sparsity()).all()


def test_states_without_a_value_are_not_numbers() -> None:
    text = """
    [coordinates]
    x = 1.0
    [lagrangian]
    kinetic = "x'^2/2"
    potential = "-log(x)"
    """
    system = chetaev.Model.from_text(text).system()
    states = np.array([[1.0, 0.0, 2.0], [0.0, 0.0, 0.0]])
    rates = system(0.0, states)
    assert np.isnan(rates[:, 1]).all() and np.allclose(rates[1, [0, 2]], [1.0, 0.5])
    with pytest.raises(chetaev.EvaluationError):
        system(0.0, np.array([0.0, 0.0]))
    with pytest.raises(ValueError, match="the state has 3 numbers instead of 2"):
        system(0.0, np.zeros(3))
    with pytest.raises(ValueError, match="3 dimensions"):
        system(0.0, np.zeros((2, 2, 2)))
