"""Gradients by the adjoint equations against closed forms, forward sensitivities and central differences."""

from collections.abc import Callable

import numpy as np
import pytest

import chetaev

SHARP = {"rtol": 1e-11}
#: Part of the largest derivative by which two ways of differentiating differ.
NEAR = 1e-6

OSCILLATOR = """
[parameters]
m = 2.0
k = 3.0
a = 0.7
[inputs]
u = 0.5
[coordinates]
x = "2*a"
[quasi_velocities]
"x'" = 0.3
[lagrangian]
kinetic = "m*x'^2/2"
potential = "k*x^2/2"
[forces]
x = "u"
[outputs]
swing = "k*x^2"
"""


def differences(value: Callable[[], float], set_to: Callable[[float], None], at: float) -> float:
    step = 1e-4 * max(1.0, abs(at))
    ends = []
    for moved in (at + step, at - step):
        set_to(moved)
        ends.append(value())
    set_to(at)
    return (ends[0] - ends[1]) / (2 * step)


def compare(system: chetaev.System, of: str, t_end: float, value: Callable[[], float], **settings: object) -> None:
    gradient = system.gradient(of, t_end, **SHARP, **settings)
    assert gradient.value == pytest.approx(value(), rel=1e-7)
    found = gradient.by_parameters
    assert found
    expected = {}
    for name in found:
        expected[name] = differences(value, lambda p, name=name: system.parameters.__setitem__(name, p), system.parameters[name])
    size = max(map(abs, expected.values()))
    assert found == pytest.approx(expected, abs=NEAR * max(size, 1e-3))


def test_an_oscillator() -> None:
    system = chetaev.Model.from_text(OSCILLATOR).system(parameters={"u": 0.0})
    t, w = 2.0, np.sqrt(1.5)
    gradient = system.gradient("x", t, **SHARP)
    assert gradient.by_start == pytest.approx({"x": np.cos(w * t), "x'": np.sin(w * t) / w}, abs=1e-8)
    # x = 2a cos ωt + 0.3/ω sin ωt; the start depends on a, and u lifts the middle by u/k.
    by_w = -1.4 * t * np.sin(w * t) + 0.3 * (t * np.cos(w * t) / w - np.sin(w * t) / w**2)
    expected = {"m": -by_w * w / 4, "k": by_w / (2 * w * 2), "a": 2 * np.cos(w * t), "u": (1 - np.cos(w * t)) / 3}
    assert gradient.by_parameters == pytest.approx(expected, abs=1e-8)
    assert list(system.gradient("x", t, by="k").by_parameters) == ["k"]
    energy = system.gradient("m*x'^2/2 + k*x^2/2", t, **SHARP)
    assert energy.by_start == pytest.approx({"x": 3.0 * 1.4, "x'": 2.0 * 0.3}, abs=1e-8)


def test_integrals_and_outputs() -> None:
    system = chetaev.Model.from_text(OSCILLATOR).system()
    times = np.linspace(0.0, 2.0, 2001)

    def area() -> float:
        x = system.run(times=times, verify=False, **SHARP)["x"]
        return float((x[:-1:2] + 4 * x[1::2] + x[2::2]).sum() * 1e-3 / 3)

    assert system.gradient(integral="x", t_end=2.0, **SHARP).value == pytest.approx(area(), rel=1e-9)
    both = system.gradient("swing", 2.0, integral="x", **SHARP)
    parts = [system.gradient("k*x^2", 2.0, **SHARP), system.gradient(integral="x", t_end=2.0, **SHARP)]
    assert both.value == pytest.approx(parts[0].value + parts[1].value, rel=1e-9)
    for name, value in both.by_parameters.items():
        assert value == pytest.approx(sum(part.by_parameters[name] for part in parts), abs=1e-7)
        by_differences = differences(area, lambda p: system.parameters.__setitem__(name, p), system.parameters[name])
        assert parts[1].by_parameters[name] == pytest.approx(by_differences, abs=NEAR)


@pytest.mark.parametrize(
    ("name", "of", "t_end"),
    [
        ("heavy-top-lagrange", "γ3 + ω1^2", 2.0),
        ("heavy-top-quaternion", "ω1", 1.0),
        ("chaplygin-sleigh", "X", 2.0),
        ("furuta-pendulum", "θ", 1.0),
        ("double-pendulum-cartesian", "x2", 0.5),
        ("bouncing-ball", "y", 1.5),
    ],
)
def test_models_agree_with_forward_sensitivities(name: str, of: str, t_end: float) -> None:
    system = chetaev.Model.builtin(name).system()
    known = [name for name in system.model.parameters if name in system.gradient(system.names[0], t_end).by_parameters]
    column = of if of in system.columns else None
    by = known[:3]
    gradient = system.gradient(of, t_end, by=by, **SHARP)
    if column is not None:
        motion = system.run(t_end, samples=2, sensitivities=by, **SHARP)
        expected = {name: motion.sensitivity(column, name)[-1] for name in by}
        size = max(1.0, *map(abs, expected.values()))
        assert gradient.by_parameters == pytest.approx(expected, abs=NEAR * size)
    else:
        motion = system.run(t_end, samples=2, sensitivities=by, **SHARP)
        for name in by:
            slope = motion.sensitivity("γ3", name)[-1] + 2 * motion["ω1"][-1] * motion.sensitivity("ω1", name)[-1]
            assert gradient.by_parameters[name] == pytest.approx(slope, abs=NEAR)


def test_under_a_table() -> None:
    pulse = ([0.0, 0.5, 1.0, 9.0], [0.0, 2.0, -1.0, 0.0])
    system = chetaev.Model.from_text(OSCILLATOR).system(inputs={"u": pulse})
    compare(system, "x + u*x'", 2.0, lambda: _end(system), by=["m", "k", "a"])
    with pytest.raises(chetaev.ChetaevError, match="function of time"):
        system.gradient("x", 2.0, by=["u"])


def _end(system: chetaev.System) -> float:
    motion = system.run(2.0, samples=2, verify=False, **SHARP)
    return float(motion["x"][-1] + np.interp(2.0, [1.0, 9.0], [-1.0, 0.0]) * motion["x'"][-1])


def test_many_parameters_cost_as_one() -> None:
    text = "[parameters]\n" + "".join(f"k{i} = {1 + i / 10}\n" for i in range(12)) + "[coordinates]\nx = 0.5\n[lagrangian]\n"
    text += "kinetic = \"x'^2/2\"\npotential = \"" + " + ".join(f"k{i}*x^{2 + i}/10" for i in range(12)) + '"\n'
    system = chetaev.Model.from_text(text).system()
    gradient = system.gradient("x", 3.0, **SHARP)
    motion = system.run(3.0, samples=2, sensitivities=list(gradient.by_parameters), **SHARP)
    expected = {name: motion.sensitivity("x", name)[-1] for name in gradient.by_parameters}
    assert len(expected) == 12 and gradient.by_parameters == pytest.approx(expected, abs=1e-8)


def test_what_is_wrong_is_said() -> None:
    system = chetaev.Model.from_text(OSCILLATOR).system()
    with pytest.raises(ValueError, match="name a function"):
        system.gradient(t_end=1.0)
    with pytest.raises(ValueError, match="`adams` or `bdf`, not `taylor`"):
        system.gradient("x", 1.0, method="taylor")
    with pytest.raises(chetaev.ModelError, match="`z` is not declared"):
        system.gradient("z", 1.0)
    with pytest.raises(chetaev.UnknownNameError, match="m, k, a, u"):
        system.gradient("x", 1.0, by=["z"])
    with pytest.raises(chetaev.ChetaevError, match="use the form poincare"):
        chetaev.Model.from_text(OSCILLATOR).system("canonical").gradient("x", 1.0)
    with pytest.raises(TypeError, match=r"System.gradient\(\) takes no 'samples'"):
        system.gradient("x", 1.0, samples=3)
