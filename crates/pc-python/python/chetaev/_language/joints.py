"""Joints of bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, ClassVar


@dataclass(frozen=True, kw_only=True)
class Joint:
    """How a body moves relative to the one to which it is attached: the base of all joints.

    Parameters
    ----------
    at : sequence of three expressions, optional
        The position of the joint in the axes of the parent, from the origin of the parent; zero by default.
    turns : sequence of pairs, optional
        How the joint is rotated: ``[("z", a), ("x", b)]`` means by a about its z-axis, then by b about its rotated x-axis.
    rotation : sequence of nine expressions, optional
        The same rotation, given as a matrix from the axes of the joint to those of the parent, row by row.
    coordinates, quasi_velocities : sequence of str, optional
        Names that replace those made from the name of the body.
    """

    at: Sequence[Any] | None = None
    turns: Sequence[tuple[str, Any]] | None = None
    rotation: Sequence[Any] | None = None
    coordinates: Sequence[str] | None = None
    quasi_velocities: Sequence[str] | None = None

    #: The name of the kind of joint in a text.
    kind: ClassVar[str]

    def entries(self) -> dict[str, Any]:
        """The entries of ``joint`` in the text of a model."""
        given = {field.name: getattr(self, field.name) for field in fields(self)}
        return {"kind": self.kind, **{key: value for key, value in given.items() if value is not None}}


@dataclass(frozen=True, kw_only=True)
class Fixed(Joint):
    """The body is fixed to its parent."""

    kind = "fixed"


@dataclass(frozen=True, kw_only=True)
class _Single(Joint):
    """A joint with exactly one coordinate x: the base of those that can follow another, and be driven.

    Parameters
    ----------
    follows : str, optional
        The body whose joint it follows: x is ``ratio`` times the coordinate of the other plus ``offset``.
    ratio, offset : expression, optional
        1 and 0 by default.
    armature : expression, optional
        The inertia J of a rotor, with the kinetic energy J x'²/2.
    stiffness, rest : expression, optional
        A spring with the potential energy ``stiffness`` (x - ``rest``)²/2.
    damping : expression, optional
        The coefficient d of the force -d x'.
    friction : expression, optional
        The size F of dry friction, the force -F sign(x').
    stiction : expression, optional
        The force F_s, at least F, up to which friction holds the joint at rest; F by default.
    limits : pair of expressions, optional
        The ends of its way: stops push back with ``stop_stiffness`` s + ``stop_damping`` s' where x is beyond an end by s.
    restitution : expression, optional
        The coefficient e of rigid stops at the ends, in place of ``stop_stiffness``: there x' becomes -e x'.
    stop_stiffness, stop_damping : expression, optional
        No damping by default.
    """

    follows: str | None = None
    ratio: Any = None
    offset: Any = None
    armature: Any = None
    stiffness: Any = None
    rest: Any = None
    damping: Any = None
    friction: Any = None
    stiction: Any = None
    limits: Sequence[Any] | None = None
    restitution: Any = None
    stop_stiffness: Any = None
    stop_damping: Any = None


@dataclass(frozen=True, kw_only=True)
class Revolute(_Single):
    """The body turns about ``axis``: the coordinate ``NAME``.

    Examples
    --------
    >>> from chetaev import Model, Revolute
    >>> arm = Model.builder("arm").coordinate("arm", 0.5).gravity([0, 0, -9.81])
    >>> arm = arm.body("arm", joint=Revolute(axis=[0, 1, 0]), mass=1.0, center=[0, 0, -0.5])
    >>> arm.build().system().names
    ('arm', "arm'")
    """

    kind = "revolute"
    #: The direction of the axis: three numbers, of which only the ratios matter.
    axis: Sequence[Any]


@dataclass(frozen=True, kw_only=True)
class Prismatic(_Single):
    """The body slides along ``axis``: the coordinate ``NAME``."""

    kind = "prismatic"
    axis: Sequence[Any]


@dataclass(frozen=True, kw_only=True)
class Screw(_Single):
    """The body turns by ``NAME`` about ``axis`` and slides along it by ``pitch`` times ``NAME``."""

    kind = "screw"
    axis: Sequence[Any]
    pitch: Any


@dataclass(frozen=True, kw_only=True)
class Cylindrical(Joint):
    """The body slides along ``axis`` and turns about it: ``NAME_z``, ``NAME_φ``."""

    kind = "cylindrical"
    axis: Sequence[Any]


@dataclass(frozen=True, kw_only=True)
class Universal(Joint):
    """The body turns about the first of two ``axes``, then about the second, which is carried along: ``NAME_1``, ``NAME_2``."""

    kind = "universal"
    axes: Sequence[Sequence[Any]]


@dataclass(frozen=True, kw_only=True)
class Planar(Joint):
    """The body slides along the two axes that follow the normal ``axis``, and turns about it: ``NAME_x``, ``NAME_y``, ``NAME_φ``
    for the normal z, ``NAME_z``, ``NAME_x``, ``NAME_φ`` for y."""

    kind = "planar"
    axis: Sequence[Any]


@dataclass(frozen=True, kw_only=True)
class Spherical(Joint):
    """The body turns about a point: a unit quaternion ``NAME_q0`` to ``NAME_q3``, and ``NAME_ω1`` to ``NAME_ω3`` in body axes."""

    kind = "spherical"


@dataclass(frozen=True, kw_only=True)
class Free(Joint):
    """The body moves freely: ``NAME_x`` to ``NAME_z`` and a unit quaternion, ``NAME_v1`` to ``NAME_v3`` and ω in body axes."""

    kind = "free"

