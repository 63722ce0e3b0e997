"""Equations of motion in quasi-velocities: derived, printed, compiled and integrated.

A model is a text with a frame, a Lagrangian and forces. Its Poincaré–Chetaev equations are derived from it:

>>> import chetaev
>>> model = chetaev.Model.from_text('''
... [parameters]
... g = 9.81
... l = 2.0
... [coordinates]
... "θ" = 0.5
... [lagrangian]
... kinetic = "l^2*θ'^2/2"
... potential = "-g*l*cos(θ)"
... ''', name="pendulum")
>>> system = model.system()
>>> system.names
('θ', "θ'")
>>> motion = system.run(10.0)
>>> motion["θ"].shape
(201,)
>>> motion.drift["energy"] < 1e-7
True
"""

from chetaev._language.builder import Builder
from chetaev._language.errors import (
    ChetaevError,
    DisagreementError,
    EvaluationError,
    IntegrationError,
    ModelError,
    UnknownNameError,
)
from chetaev._language.events import Event
from chetaev._language.expressions import (
    Expression,
    abs_,
    acos,
    asin,
    atan,
    atan2,
    cos,
    cosh,
    cot,
    d,
    exp,
    log,
    maximum,
    minimum,
    pi,
    sign,
    sin,
    sinh,
    sqrt,
    step,
    symbols,
    t,
    tan,
    tanh,
)
from chetaev._language.joints import (
    Cylindrical,
    Fixed,
    Free,
    Joint,
    Planar,
    Prismatic,
    Revolute,
    Screw,
    Spherical,
    Universal,
)
from chetaev._results.linear import Equilibria, Equilibrium, Linearization, RootLocus, Trim
from chetaev._model import Model
from chetaev._results.motion import Motion, Occurrence
from chetaev._native import Stepper, __version__
from chetaev._results.printed import Check, Equations, Page, Theory
from chetaev._results.quantities import Bracket, Gradient, Lyapunov, VelocityMap
from chetaev._results.sweep import Sweep
from chetaev._system import System


__all__ = [
    "Bracket",
    "Builder",
    "Check",
    "ChetaevError",
    "Cylindrical",
    "DisagreementError",
    "Equations",
    "Equilibria",
    "Equilibrium",
    "EvaluationError",
    "Event",
    "Expression",
    "Fixed",
    "Free",
    "Gradient",
    "IntegrationError",
    "Joint",
    "Linearization",
    "Lyapunov",
    "Model",
    "ModelError",
    "Motion",
    "Occurrence",
    "Page",
    "Planar",
    "Prismatic",
    "Revolute",
    "RootLocus",
    "Screw",
    "Spherical",
    "Stepper",
    "Sweep",
    "System",
    "Theory",
    "Trim",
    "Universal",
    "UnknownNameError",
    "VelocityMap",
    "__version__",
    "abs_",
    "acos",
    "asin",
    "atan",
    "atan2",
    "cos",
    "cosh",
    "cot",
    "d",
    "exp",
    "log",
    "maximum",
    "minimum",
    "pi",
    "sign",
    "sin",
    "sinh",
    "sqrt",
    "step",
    "symbols",
    "t",
    "tan",
    "tanh",
]
