"""Arguments: what is honoured or refused, and what is said of it in the words of Python."""

import re

import numpy as np
import pytest

import chetaev

TOP = "heavy-top-lagrange"


def top() -> chetaev.System:
    return chetaev.Model.builtin(TOP).system()


def test_settings_that_a_call_does_not_take_are_refused() -> None:
    system = top()
    for call, name in (
        (lambda **s: system.sweep({"mg": [1.0]}, t_end=1.0, **s), "System.sweep"),
        (system.stepper, "System.stepper"),
        (lambda **s: system.lyapunov(interval=1.0, intervals=2, **s), "System.lyapunov"),
    ):
        with pytest.raises(TypeError, match=rf"{name}\(\) takes no sensitivities: they are columns"):
            call(sensitivities=["mg"])
        with pytest.raises(TypeError, match=rf"{name}\(\) takes no 'tol'; it takes method"):
            call(tol=1.0)
        with pytest.raises(TypeError, match="takes no 'times'"):
            call(times=[0.0, 1.0])


@pytest.mark.parametrize("call", ["check", "derive", "theory", "linearize", "equilibria", "system"])
def test_a_wrong_setting_of_a_model_names_the_call(call: str) -> None:
    with pytest.raises(TypeError, match=rf"Model\.{call}\(\) takes no 'parameter'; it takes inputs, parameters"):
        getattr(chetaev.Model.builtin(TOP), call)(parameter={"mg": 1.0})


def test_errors_name_nothing_private() -> None:
    model, system = chetaev.Model.builtin(TOP), top()
    stepper = system.stepper()
    attempts = {
        "rtol is a number, not 'small'": lambda: system.run(1.0, rtol="small"),
        "atol is a number": lambda: system.run(1.0, atol=[1e-9]),
        r"atol\['ω3'\] is a number": lambda: system.run(1.0, atol={"ω3": "x"}),
        "samples is a whole number, not 2.5": lambda: system.run(1.0, samples=2.5),
        "method is a name, not 3": lambda: system.run(1.0, method=3),
        "limit_time is a number": lambda: system.run(1.0, limit_time="1 s"),
        "t_end is a number": lambda: system.run("1"),
        r"parameters\['mg'\] is a number": lambda: system.parameters.update({"mg": "x"}),
        r"start\['ω3'\] is a number": lambda: model.system(start={"ω3": None}),
        "hold lists names, and 3 is none": lambda: model.linearize(hold=[3]),
        "parameters is a mapping": lambda: model.system(parameters=[1.0]),
        "inputs": lambda: stepper.step(0.1, 3.0),
        "dt": lambda: stepper.step("x"),
        "Stepper": lambda: chetaev.Stepper(),
        r"System\.jac": lambda: system.jac(),
        "rows is a whole number": lambda: system.sweep({"mg": [1.0]}, t_end=1.0, rows=2.5),
        r"of a Model, by Model\.system": lambda: chetaev.System("pendulum"),
        "str or bytes": lambda: chetaev.Model(3),
    }
    for message, attempt in attempts.items():
        with pytest.raises(TypeError, match=message) as raised:
            attempt()
        assert not re.search(r"_native|Core|wished|_System|\b_\w", str(raised.value)), raised.value
    for seconds in (-1.0, float("nan")):
        with pytest.raises(ValueError, match="limit_time is .*; give seconds, 0 or more"):
            system.run(1.0, limit_time=seconds)
        with pytest.raises(ValueError, match="limit_time is .*; give seconds, 0 or more"):
            model.system(limit_time=seconds)


def test_one_name_is_one_name() -> None:
    system = top()
    assert list(system.run(1.0, sensitivities="mg")) == list(system.run(1.0, sensitivities=["mg"]))
    pytest.importorskip("matplotlib").use("Agg")
    assert len(system.run(1.0).plot("ω3").axes[0].lines) == 1
    kept = chetaev.Model.builtin(TOP).system(project="energy").run(1.0, rtol=1e-4)
    assert kept.drift["energy"] < 1e-12 < system.run(1.0, rtol=1e-4).drift["energy"]
    with pytest.raises(chetaev.UnknownNameError, match="`energetic` is not an integral"):
        chetaev.Model.builtin(TOP).system(project="energetic")
    furuta = chetaev.Model.builtin("furuta-pendulum")
    assert furuta.linearize(hold="φ'").state == furuta.linearize(hold=["φ'"]).state


def test_drift_is_counted_from_the_start() -> None:
    text = """
    [coordinates]
    x = 1.0
    [lagrangian]
    kinetic = "x'^2/2"
    potential = "x^2/2"
    [forces]
    x = "-0.1*x'"
    """
    system = chetaev.Model.from_text(text).system()
    whole = system.run(times=[0.0, 9.0, 10.0])
    late = system.run(times=[9.0, 10.0])
    assert late.drift["energy"] == whole.drift["energy"] > 0.2
    start = system.run(times=[9.0, 10.0], y0=[2.0, 0.0])
    assert start.drift["energy"] == pytest.approx(2.0 - start["energy"][-1], rel=1e-12)


def test_no_time_is_no_state() -> None:
    motion = top().run(1.0)
    assert motion.dense([]).shape == (6, 0) and motion.dense(np.zeros((2, 3))).shape == (6, 2, 3)


def test_settings_of_a_built_run() -> None:
    def disk() -> chetaev.Builder[chetaev.Model]:
        builder = chetaev.Model.builder("disk").parameter("r", 2.0).coordinate("θ", 0.5).coordinate("x", 0.0)
        return builder.lagrangian(kinetic="θ'^2/2 + x'^2/2", potential="cos(θ)")

    built = disk().simulation(t_end=1, samples=11, atol={"θ": 1e-9, "x": 1}, project="energy").build()
    assert built.simulation["atol"] == {"θ": 1e-9, "x": 1.0} and built.system().run()["t"].shape == (11,)
    hamel = disk().simulation(form="hamel", hamel={"v": "r*θ'", "w": lambda x: x.velocity}, t_end=1.0).build()
    assert hamel.system().names == ("θ", "x", "v", "w")
    with pytest.raises(TypeError, match="samples is a whole number"):
        disk().simulation(samples="many")


def test_what_is_completed_is_public() -> None:
    assert {name for name in dir(chetaev) if not name.startswith("_")} == {
        name for name in chetaev.__all__ if not name.startswith("_")
    }
    system = top()
    native = {name for name in vars(type(system).__mro__[1]) if not name.startswith("_")}
    assert native == {"energy", "jac", "jac_sparsity"}
