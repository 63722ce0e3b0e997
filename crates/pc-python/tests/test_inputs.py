"""Inputs given to a run or a system, against those in the text of a model."""

import pickle

import numpy as np
import pytest

import chetaev

CART = """
[parameters]
m = 2.0
[inputs]
u = 0.5
w = {w}
[coordinates]
x = 1.0
[quasi_velocities]
"x'" = -1.0
[lagrangian]
kinetic = "m*x'^2/2"
potential = "x^2"
[forces]
x = "u + w"
[outputs]
push = "u + w"
[simulation]
t_end = 2.0
"""
TIMES, VALUES = [0.0, 0.5, 1.25, 2.0], [0.0, 1.0, -2.0, 0.5]


def cart(w: str = "0.0") -> chetaev.Model:
    return chetaev.Model.from_text(CART.replace("{w}", w))


def same(one: chetaev.Motion, other: chetaev.Motion) -> bool:
    return list(one) == list(other) and all((one[name] == other[name]).all() for name in one)


@pytest.mark.parametrize("interpolation", ["linear", "cubic", "hold"])
@pytest.mark.parametrize("text", ["0.0", '{ times = [0.0, 9.0], values = [3.0, 4.0] }'])
def test_a_table_is_that_of_a_text(interpolation: str, text: str) -> None:
    written = cart(f'{{ times = {TIMES}, values = {VALUES}, interpolation = "{interpolation}" }}').system().run()
    system = cart(text).system()
    given = system.run(inputs={"w": (TIMES, np.array(VALUES), interpolation)})
    assert same(written, given) and (written.dense([0.3, 1.7]) == given.dense([0.3, 1.7])).all()
    assert same(cart(text).system(inputs={"w": (TIMES, VALUES, interpolation)}).run(), given)
    if interpolation == "linear":
        assert same(system.run(inputs={"w": (TIMES, VALUES)}), given)
    assert same(system.run(), cart(text).system().run())  # the inputs of the next run are its own
    again = pickle.loads(pickle.dumps(given))
    assert (again.dense(1.0) == written.dense(1.0)).all()


@pytest.mark.parametrize("text", ["0.0", '{ times = [0.0, 9.0], values = [3.0, 4.0] }'])
def test_a_number_is_that_of_a_text(text: str) -> None:
    written = cart("1.5").system(parameters={"m": 3.0}).run()
    system = cart(text).system()
    system.parameters["m"] = 3.0
    assert same(written, system.run(inputs={"w": 1.5}))
    system.parameters["u"] = 9.0
    assert same(written, system.run(inputs={"w": 1.5, "u": 0.5}))
    calm = cart(text).system(inputs={"w": 0.0})
    calm.parameters.update({"w": 1.5, "m": 3.0})
    assert same(written, calm.run()) and same(written, pickle.loads(pickle.dumps(calm)).run())
    assert calm.stepper().step(0.1, [0.5, 1.5])[0] < 1.0  # no table is in its way any more


def test_inputs_go_with_events() -> None:
    motion = cart().system().run(inputs={"w": 30.0}, events={"back": chetaev.Event("x - 1", direction="rising")})
    assert [event.name for event in motion.events] == ["back"]


@pytest.mark.parametrize(
    ("inputs", "error", "message"),
    [
        ({"v": 1.0}, chetaev.UnknownNameError, "`v` is not an input of this model; its inputs are u, w"),
        ({"m": 1.0}, chetaev.UnknownNameError, "`m` is not an input"),
        ({"w": ([0.0, 1.0], [0.0])}, ValueError, "the input `w`: a table needs as many values as times"),
        ({"w": ([0.0, 1.0, 1.0], [0.0, 1.0, 2.0])}, ValueError, "must increase: 1 follows 1"),
        ({"w": ([0.0], [0.0])}, ValueError, "at least 2 times"),
        ({"w": ([0.0, 1.0], [0.0, float("nan")])}, ValueError, "not a finite number"),
        ({"w": ([0.0, 1.0], [0.0, 1.0], "spline")}, ValueError, "the interpolation is `spline`; choose one of linear"),
        ({"w": ([1.0, 2.0], [0.0, 1.0])}, chetaev.ModelError, "the motion starts outside"),
        ({"w": float("inf")}, ValueError, "not a finite number"),
        ({"w": "sin(t)"}, ValueError, "a number, or a table"),
        ({"w": [0.0, 1.0]}, ValueError, "two lists of numbers"),
    ],
)
def test_wrong_inputs_are_refused(inputs: dict[str, object], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        cart().system().run(inputs=inputs)


def test_a_run_beyond_a_table_fails_there() -> None:
    with pytest.raises(chetaev.IntegrationError, match="its table goes from 0 to 1") as raised:
        cart().system().run(inputs={"w": ([0.0, 1.0], [0.0, 1.0])})
    assert raised.value.motion is not None and raised.value.motion.t[-1] <= 1.0


def test_a_curve_moves_a_position() -> None:
    """A table with rates, in the text and of a run alone; one without them has no rate to give."""
    times, values, rates = [0.0, 1.0, 2.0], [0.0, 0.5, 0.0], [0.0, 0.3, 0.0]
    text = """
[inputs]
road = {{ times = [0.0, 2.0], values = [0.0, 0.0], {} }}
[coordinates]
x = 1.0
[lagrangian]
kinetic = "(x' + road')^2/2"
potential = "x^2/2"
[simulation]
t_end = 2.0
"""
    model = chetaev.Model.from_text(text.format('interpolation = "cubic"'))
    given = model.system().run(inputs={"road": (times, values, rates)})
    written = text.replace("times = [0.0, 2.0], values = [0.0, 0.0], {}", f"times = {times}, values = {values}, rates = {rates}, {{}}")
    assert same(chetaev.Model.from_text(written.format('interpolation = "cubic"')).system().run(), given)
    still = model.system().run()
    assert abs(still["x"][-1] - np.cos(2.0)) < 1e-7  # the tolerance of a run is 1e-9
    assert abs(given["x"][-1] - still["x"][-1]) > 1e-2
    with pytest.raises(chetaev.ChetaevError, match="the rate of `road` is in use"):
        model.system().run(inputs={"road": (times, values)})
