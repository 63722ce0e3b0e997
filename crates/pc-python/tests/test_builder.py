"""Models put together call by call, of all kinds of expressions."""

import fractions

import numpy as np
import pytest

import chetaev
from chetaev import Expression, cos, d, sin, sqrt, step, symbols

SLEIGH = chetaev.Model.builtin("chaplygin-sleigh")


def pendulum(kinetic: object, potential: object) -> chetaev.Model:
    builder = chetaev.Model.builder("pendulum").parameter("g", 9.81).parameter("l", 2.0).coordinate("θ", 0.5)
    return builder.lagrangian(kinetic=kinetic, potential=potential).build()


def test_texts_expressions_functions_and_sympy_are_one_model() -> None:
    sympy = pytest.importorskip("sympy")
    from sympy.physics.mechanics import dynamicsymbols

    g, l, θ = symbols("g l θ")
    angle = dynamicsymbols("θ")
    of_sympy = sympy.symbols("g l")
    models = [
        pendulum("l^2*θ'^2/2", "-g*l*cos(θ)"),
        pendulum(l**2 * θ.velocity**2 / 2, -g * l * cos(θ)),
        pendulum(lambda l, θ: (l * θ.velocity) ** 2 / 2, lambda g, l, θ: -g * l * cos(θ)),
        pendulum(
            of_sympy[1] ** 2 * angle.diff(dynamicsymbols._t) ** 2 / 2, -of_sympy[0] * of_sympy[1] * sympy.cos(angle)
        ),
    ]
    rates = [model.system()(0.0, np.array([0.7, 0.3])) for model in models]
    for other in rates[1:]:
        assert (other == rates[0]).all()


def test_a_model_with_constraints() -> None:
    builder = chetaev.Model.builder("sleigh").parameter("m", 1).parameter("J", 1.0).parameter("a", "m/2")
    for name in "xyφ":
        builder.coordinate(name)
    builder.quasi_velocity("v", 0.0, "cos(φ)*x' + sin(φ)*y'").quasi_velocity("ω", 1.0, "φ'")
    builder.constraint("blade", "-sin(φ)*x' + cos(φ)*y'")
    builder.lagrangian(
        kinetic="m/2*(x'^2 + y'^2) + m*a*ω*(cos(φ)*y' - sin(φ)*x') + (J + m*a^2)/2*ω^2"
    )
    builder.simulation(t_end=5.0, samples=11, method="bdf")
    system = builder.build().system()
    motion = system.run()
    assert len(motion.t) == 11 and motion.columns[:4] == ("t", "x", "y", "φ")
    # m v' = m a ω² at the start.
    rates = dict(zip(system.names, system(0.0, system.y0)))
    assert rates["v"] == pytest.approx(0.5, rel=1e-14)
    # λ = m a ω' + m v ω, here 0.
    assert system.reactions(0.0, system.y0)["blade"] == pytest.approx(0.0, abs=1e-15)


def test_inputs_events_and_states() -> None:
    builder = chetaev.Model.builder("driven").coordinate("x", 0.0).input("u").input(
        "w", times=[0.0, 1.0], values=[0.0, 2.0]
    )
    builder.lagrangian(kinetic="x'^2/2").force("x", "u + w").state("s", 0.0, "x").output("twice", "2*x")
    builder.event("half", "x - 1/2", direction="rising", terminal=True)
    system = builder.build().system()
    assert builder.build().inputs == ("u", "w")
    system.parameters["u"] = 1.0
    # ẍ = 1 + 2 t, so x = t²/2 + t³/3.
    motion = system.run(1.0)
    assert motion.terminal == "half"
    t = motion.t[-1]
    assert t**2 / 2 + t**3 / 3 == pytest.approx(0.5, abs=1e-9)
    assert motion["s"][-1] == pytest.approx(t**3 / 6 + t**4 / 12, abs=1e-9)
    assert (motion["twice"] == 2 * motion["x"]).all()


def test_operators_keep_their_meaning() -> None:
    x, y = symbols("x, y")
    for made, text in [
        (x - (y - 1), "x - (y - 1)"),
        (x / (y / 2), "x/(y/2)"),
        ((x / y) / 2, "x/y/2"),
        (-(x**2), "-x^2"),
        ((-x) ** 2, "(-x)^2"),
        (x ** (y**2), "x^(y^2)"),
        ((x**y) ** 2, "(x^y)^2"),
        (2 * (x + y) * 3, "2*(x + y)*3"),
        (1 - x, "1 - x"),
        (x * -y, "x*(-y)"),
        (fractions.Fraction(1, 3) * x, "1/3*x"),
        (sqrt(x + 1) + sin(2 * x), "sqrt(x + 1) + sin(2*x)"),
        (d(x) + abs(y), "d(x) + abs(y)"),
        (step(x, 1, y), "step(x, 1, y)"),
        (2**x, "2^x"),
        (1.5e-3 * x, "0.0015*x"),
        (Expression("x + y") * 2, "(x + y)*2"),
    ]:
        assert str(made) == text


def test_what_is_no_expression_is_refused() -> None:
    sympy = pytest.importorskip("sympy")
    x = sympy.Symbol("x")
    t = sympy.Symbol("t")
    f = sympy.Function("f")
    for value in (
        sympy.gamma(x),
        sympy.Symbol("x_{1}"),
        sympy.I * x,
        sympy.oo,
        f(x),
        f(t).diff(t, 2),
        sympy.Integral(x, x),
        sympy.Float("0.1234567890123456789012345", 25),
    ):
        with pytest.raises(chetaev.ChetaevError, match="SymPy"):
            pendulum(value, "0")
    for wrong in (object(), None, True, float("inf")):
        with pytest.raises((TypeError, chetaev.ChetaevError)):
            chetaev.Model.builder().parameter("p", wrong)
    (y,) = symbols("y")
    with pytest.raises(TypeError, match="neither true nor false"):
        bool(y)
    with pytest.raises(chetaev.ChetaevError, match="not a coordinate"):
        (y + 1).velocity
    with pytest.raises(chetaev.ChetaevError, match="already"):
        chetaev.Model.builder().parameter("p", 1.0).parameter("p", 2.0)


def test_expressions_of_sympy_keep_their_values() -> None:
    sympy = pytest.importorskip("sympy")
    x, y = sympy.symbols("x y", positive=True)
    expressions = [
        sympy.Rational(-7, 3) * x**2 / y,
        sympy.sqrt(x) * y ** sympy.Rational(3, 2),
        sympy.exp(-x) + sympy.log(y) - sympy.pi * sympy.E,
        sympy.atan2(y, x) + sympy.Abs(x - y) + sympy.sign(y - 2),
        sympy.Min(x, y, 1) + sympy.Max(x, y),
        sympy.Piecewise((x, x - y >= 0), (y**2, True)) + sympy.Piecewise((x, x < 1), (y, True)),
        sympy.Float(0.1) * x - sympy.cot(y) + sympy.tanh(x),
    ]
    builder = chetaev.Model.builder("values").coordinate("x", 0.75).coordinate("y", 1.25)
    builder.lagrangian(kinetic="(x'^2 + y'^2)/2")
    for i, expression in enumerate(expressions):
        builder.output(f"f{i}", expression)
    system = builder.build().system()
    seen = system.observe(0.0, system.y0)
    for i, expression in enumerate(expressions):
        # Rounding of some ten operations.
        assert seen[f"f{i}"] == pytest.approx(float(expression.subs({x: 0.75, y: 1.25})), rel=1e-14)


def test_bodies_on_joints_are_those_of_a_text() -> None:
    crank = chetaev.Revolute(axis=[0, 0, 1])
    builder = chetaev.Model.builder("parallelogram")
    for name, start in (("crank", "pi/2"), ("coupler", "-pi/2"), ("rocker", "pi/2")):
        builder = builder.coordinate(name, start)
    builder = builder.quasi_velocity("crank'", 2.0)
    builder = builder.body("crank", joint=crank, mass=1.0, center=[0.5, 0, 0], inertia=[0, 0.08, 0.08])
    builder = builder.body(
        "coupler",
        parent="crank",
        joint={"kind": "revolute", "axis": [0, 0, 1], "at": [1, 0, 0]},
        mass=2.0,
        center=[1, 0, 0],
        inertia=[0, 0.7, 0.7],
    )
    rocker = chetaev.Revolute(axis=[0, 0, 1], at=[2, 0, 0])
    builder = builder.body("rocker", joint=rocker, mass=1.0, center=[0.5, 0, 0], inertia=[0, 0.08, 0.08])
    builder = builder.loop(
        "pin", "revolute", ["coupler", "rocker"], [[2, 0, 0], [1, 0, 0]], axis=[[0, 0, 1], [0, 0, 1]]
    )
    builder = builder.point("middle", "coupler", [1, 0, 0]).output("height", "middle_y")
    builder = builder.draw("line", through=[["middle_x", "middle_y", 0], [1, 0, 0]]).draw("text", at=[0, 1, 0], text="up")
    builder = builder.drawing(hide=["coupler"], up=[0, 1, 0])
    assert '[drawing]\n"hide" = ["coupler"]\n"up" = [0.0, 1.0, 0.0]\n' in builder.text
    system = builder.simulation(t_end=0.5).build().system()
    motion = system.run()
    # The coupler of a parallelogram moves without turning, and each crank turns as it likes: both keep their distance.
    assert motion["height"][0] == pytest.approx(1.0) and motion["crank"] == pytest.approx(motion["rocker"])
    assert motion.drift["energy"] < 1e-8
    assert "<canvas" in motion.animate().html


def test_contacts_are_those_of_a_text() -> None:
    builder = chetaev.Model.builder("slope").gravity([0, 0, -9.81]).coordinate("ball_z", "0.1/cos(0.3)")
    builder = builder.body("ball", joint=chetaev.Planar(axis=[0, 1, 0]), mass=2.0, inertia=[0, 0.008, 0])
    builder = builder.contact(
        "slope", "ball", "sphere", "rolls", radius=0.1, normal=["sin(0.3)", 0, "cos(0.3)"], keeps=True
    )
    assert "keeps = true" in builder.text or '"keeps" = true' in builder.text
    motion = builder.simulation(t_end=1.0).build().system().run()
    # The slides of the joint are along z and x. It accelerates at (5/7) g sin s along the slope, and the ball weighs m g cos s on it.
    along = 5 / 14 * 9.81 * np.sin(0.3)
    assert motion["ball_x"][-1] == pytest.approx(along * np.cos(0.3), rel=1e-9)
    assert motion["N_slope"] == pytest.approx(2 * 9.81 * np.cos(0.3), rel=1e-9)


def test_every_joint_is_written() -> None:
    joints = [
        chetaev.Fixed(),
        chetaev.Revolute(axis=[0, 0, 1], turns=[("z", 0.1), ("x", "pi/4")]),
        chetaev.Prismatic(axis=[1, 0, 0], coordinates=["s"]),
        chetaev.Screw(axis=[0, 0, 1], pitch=0.1),
        chetaev.Cylindrical(axis=[0, 0, 1]),
        chetaev.Universal(axes=[[1, 0, 0], [0, 1, 0]]),
        chetaev.Planar(axis=[0, 0, 1]),
        chetaev.Spherical(at=[0, 0, 1]),
        chetaev.Free(),
    ]
    assert "1.0, 0.0" in chetaev.Model.builder("n").body("b", joint=chetaev.Revolute(axis=np.array([0, 1, 0])), mass=1).text
    degrees = [0, 1, 1, 1, 2, 2, 3, 3, 6]
    for joint, count in zip(joints, degrees):
        builder = chetaev.Model.builder("one").gravity([0, 0, -1]).body("last", joint=chetaev.Prismatic(axis=[0, 1, 0]), mass=1)
        builder = builder.body("b", parent="last", joint=joint, mass=1.0, inertia=[1, 1, 1], center=[0.1, 0, 0])
        names = builder.build().system().names
        velocities = [name for name in names if name.endswith("'") or "_ω" in name or "_v" in name]
        assert len(velocities) == 1 + count, (joint, names)
    geared = chetaev.Model.builder("geared").body("last", joint=chetaev.Prismatic(axis=[0, 1, 0], stiffness=40.0, rest=0.1), mass=1)
    follower = chetaev.Screw(axis=[0, 0, 1], pitch=0.1, follows="last", ratio=-2.0, offset=0.3, armature=0.1, damping=0.2)
    geared = geared.body("b", joint=follower, mass=1.0, inertia=[1, 1, 1]).simulation(t_end=0.5).build().system()
    motion = geared.run()
    assert geared.names == ("last", "last'")
    assert motion["b"] == pytest.approx(-2.0 * motion["last"] + 0.3)
    # (1 + 4 (1 + 0.1 + 0.1²)) x'' = -40 (x - 0.1) - 4 0.2 x', from rest at x = 0.
    mass, rate = 1 + 4 * (1.1 + 0.01), 0.8
    shift, turn = rate / (2 * mass), (40 / mass - (rate / (2 * mass)) ** 2) ** 0.5
    end = 0.1 - 0.1 * np.exp(-0.5 * shift) * (np.cos(0.5 * turn) + shift / turn * np.sin(0.5 * turn))
    assert motion["last"][-1] == pytest.approx(end, rel=1e-8)
    assert "s" in chetaev.Model.builder("two").body("b", joint=joints[2], mass=1.0).build().system().names
