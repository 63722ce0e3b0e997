"""Integrators of SciPy on our systems."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import chetaev


@pytest.mark.parametrize("name", ["heavy-top-lagrange", "chaplygin-sleigh", "turning-hoop", "damped-oscillator"])
@pytest.mark.parametrize("method", ["DOP853", "Radau", "BDF", "LSODA"])
def test_solve_ivp_gives_the_numbers_of_run(name: str, method: str) -> None:
    system = chetaev.Model.builtin(name).system()
    motion = system.run(3.0, samples=4, rtol=1e-11, atol=1e-13)
    jac = {} if method == "DOP853" else {"jac": system.jac}
    solution = solve_ivp(
        system, (0.0, 3.0), system.y0, method=method, t_eval=motion.t, rtol=1e-9, atol=1e-11, **jac
    )
    assert solution.success
    # SciPy's error of a step is 1e-9, and there are some hundreds; those of BDF come to more.
    assert np.abs(solution.y - motion.y).max() < (1e-4 if method == "BDF" else 1e-6)


def test_vectorized_evaluations() -> None:
    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    one = solve_ivp(system, (0.0, 2.0), system.y0, method="Radau", vectorized=True, rtol=1e-8)
    other = solve_ivp(system, (0.0, 2.0), system.y0, method="Radau", jac=system.jac, rtol=1e-8)
    assert np.abs(one.y[:, -1] - other.y[:, -1]).max() < 1e-6


def test_parameters_are_fitted_to_data() -> None:
    from scipy.optimize import least_squares

    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    system.parameters["mg"] = 1.3
    measured = system.run(2.0, samples=21)["γ3"].copy()

    def residuals(p: np.ndarray) -> np.ndarray:
        system.parameters["mg"] = float(p[0])
        return system.run(2.0, samples=21)["γ3"] - measured

    found = least_squares(residuals, [1.0])
    assert found.x[0] == pytest.approx(1.3, abs=1e-6)
