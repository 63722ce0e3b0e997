"""What is refused, and what is said of it."""

import pickle

import pytest

import chetaev

PENDULUM = """[parameters]
g = 9.81
[coordinates]
"θ" = 0.5
[lagrangian]
kinetic = "θ'^2/2"
potential = "-g*cos(φ)"
"""


def test_errors_know_their_place() -> None:
    with pytest.raises(chetaev.ModelError) as raised:
        chetaev.Model.from_text(PENDULUM, name="pendulum.toml").system()
    error = raised.value
    assert (error.line, error.column) == (7, 21)
    assert error.entry == "[lagrangian] potential"
    assert "φ" in error.message and error.help is not None
    assert str(error).startswith("pendulum.toml:7:21: ")
    assert isinstance(error, ValueError)
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.line, again.help) == (str(error), error.line, error.help)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("[coordinates]\nx = ", 2),
        ("[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/\"", 4),
        ("[coordinates]\nx = 1.0\n[lagrangiam]\nkinetic = \"x'^2/2\"", 3),
    ],
)
def test_wrong_texts(text: str, line: int) -> None:
    with pytest.raises(chetaev.ModelError) as raised:
        chetaev.Model.from_text(text).system()
    assert raised.value.line == line


def test_bytes_that_are_no_text() -> None:
    with pytest.raises(chetaev.ModelError, match="UTF-8"):
        chetaev.Model(b"[coordinates]\nx = 1.0 # \xff")


def test_unknown_names_say_which_there_are() -> None:
    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    for attempt in (
        lambda: system.parameters["m"],
        lambda: system.parameters.__setitem__("m", 1.0),
        lambda: system.run(1.0, sensitivities=["m"]),
        lambda: system.sweep({"m": [1.0]}, t_end=1.0),
        lambda: chetaev.Model.builtin("heavy-top-lagrange").system(parameters={"m": 1.0}),
    ):
        with pytest.raises(chetaev.UnknownNameError, match="mg"):
            attempt()
    with pytest.raises(chetaev.UnknownNameError, match="ω3"):
        system.start["ω4"] = 1.0
    with pytest.raises(chetaev.UnknownNameError, match="chaplygin-sleigh"):
        chetaev.Model.builtin("sleigh")
    with pytest.raises(KeyError):
        system.run(1.0)["ω4"]


def test_wrong_arguments_are_named() -> None:
    model = chetaev.Model.builtin("heavy-top-lagrange")
    system = model.system()
    with pytest.raises(ValueError, match="the method is `rk4`; choose one of adams"):
        system.run(1.0, method="rk4")
    with pytest.raises(ValueError, match="the form is `hamilton`; choose one of poincare"):
        model.derive("hamilton")
    with pytest.raises(chetaev.ChetaevError, match="for print"):
        model.system("lagrange")
    with pytest.raises(ValueError, match="is the start"):
        system.run(0.0)
    with pytest.raises(ValueError, match="at least 2"):
        system.run(1.0, samples=1)
    with pytest.raises(ValueError, match="not a finite number"):
        system.parameters["mg"] = float("nan")
    with pytest.raises(ValueError):
        system.run(1.0, rtol=-1.0)


def test_values_are_set_together_or_not_at_all() -> None:
    text = """
    [parameters]
    l = 1.0
    [coordinates]
    x = 0.0
    y = -1.0
    [constraints]
    rod = "x^2 + y^2 - l^2"
    [lagrangian]
    kinetic = "(x'^2 + y'^2)/2"
    potential = "9.81*y"
    """
    system = chetaev.Model.from_text(text).system()
    before = system(0.0, system.y0)
    with pytest.raises(chetaev.ModelError):
        system.parameters["l"] = 2.0  # the start is off the constraint
    assert system.parameters["l"] == 1.0 and (system(0.0, system.y0) == before).all()
    system.start["y"] = -1.0
    # 0 = −g + 2 y λ at y = −1.
    assert system.reactions(0.0, system.y0)["rod"] == pytest.approx(-9.81 / 2, rel=1e-12)


def test_what_was_reached_before_a_failure() -> None:
    # The fall to the centre takes π/(2√2) from rest at 1 under 1/x.
    text = """
    [coordinates]
    x = 1.0
    [lagrangian]
    kinetic = "x'^2/2"
    potential = "-1/x"
    """
    with pytest.raises(chetaev.IntegrationError) as raised:
        chetaev.Model.from_text(text).system().run(2.0)
    motion = raised.value.motion
    assert motion is not None and motion.ending == "failed"
    assert 1.0 < motion.t[-1] < 1.1107207345395917


def test_limits_end_the_work() -> None:
    with pytest.raises(chetaev.ModelError, match="memory|limit"):
        chetaev.Model.builtin("puma-560").system(limit_memory=1 << 16)
