"""Models."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

from chetaev import _native
from chetaev._language.arguments import listed, only, real, reals, whole
from chetaev._language.builder import Builder
from chetaev._language.errors import UnknownNameError
from chetaev._language.inputs import course
from chetaev._results.linear import Equilibria, Linearization, RootLocus
from chetaev._results.printed import Check, Equations, Theory
from chetaev._system import System


#: The forms of equations, as ``pc derive --form`` names them.
FORMS = (
    "poincare", "canonical", "lagrange", "voronets", "reduced", "lie-poisson", "orthonormal", "hamel", "maggi", "kane", "gibbs-appell"
)


#: The changes to a model before it is derived: each with its default, and how it is read.
_CHANGES: dict[str, tuple[Any, Callable[[str, Any], Any]]] = {
    "inputs": ({}, lambda _, given: [(name, course(name, one)) for name, one in given.items()]),
    "parameters": ({}, lambda kind, given: list(reals(kind, given).items())),
    "start": ({}, lambda kind, given: list(reals(kind, given).items())),
    "project_start": (False, lambda _, given: bool(given)),
    "hold": ((), listed),
    "project": ((), listed),
    "velocities": ({}, lambda _, given: [(name, str(one)) for name, one in given.items()]),
    "independent": ((), listed),
    "reactions": (False, lambda _, given: bool(given)),
    "limit_memory": (None, lambda name, given: None if given is None else whole(name, given)),
    "limit_time": (None, lambda name, given: None if given is None else real(name, given)),
    "verify": (True, lambda _, given: bool(given)),
}


def changes(call: str, settings: Mapping[str, Any]) -> dict[str, Any]:
    """The changes to a model before it is derived, in the form that the native part takes; an error names the call."""
    only(call, settings, _CHANGES)
    found = {}
    for name, (default, read) in _CHANGES.items():
        given = settings.get(name)
        found[name] = read(name, default if given is None else given)
    return found


def _state(at: str, hold: str | Sequence[str], cyclic: str | None) -> dict[str, Any]:
    return {"at": at, "hold": listed("hold", hold), "cyclic": cyclic}


class Model:
    """A mechanical system, written as a text.

    A model never changes. It can be pickled, and equals another model with the same name and text.

    Parameters
    ----------
    text : str or bytes
        The text, in the format that ``docs/model-format.md`` explains.
    name : str
        The name used in messages; paths of tables in the text are relative to its directory.

    Raises
    ------
    ModelError
        If the text is wrong.
    """

    __slots__ = ("_core", "_text")

    def __init__(self, text: str | bytes, name: str = "<text>") -> None:
        if not isinstance(text, (str, bytes)):
            raise TypeError(f"the text of a model is str or bytes, not {type(text).__name__}; Model.from_file reads a file")
        self._text = text if isinstance(text, bytes) else text.encode()
        self._core = _native.ModelCore(name, self._text)

    @classmethod
    def from_text(cls, text: str, name: str = "<text>") -> Model:
        """The model that a text describes."""
        return cls(text, name)

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Model:
        """The model in a file."""
        with open(path, "rb") as file:
            return cls(file.read(), os.fspath(path))

    @classmethod
    def from_urdf(
        cls, path: str | os.PathLike[str], *, floating: bool = False, fix_massless: bool = False
    ) -> Model:
        """The model of a robot in URDF with macros expanded, in MJCF or in SDF.

        Links become bodies on joints, and meshes of URDF whose files are there are drawn.

        Warnings name what was left out. The text of the model can be written to a file and edited
        further.

        Parameters
        ----------
        path : path
            The file.
        floating : bool
            Whether the root link of a robot in URDF moves freely; otherwise it is fixed.
        fix_massless : bool
            Whether joints that move no mass are fixed; otherwise they are refused.

        Raises
        ------
        ChetaevError
            If something in the file is wrong; the error gives the position in the file.
        """
        with open(path, encoding="utf-8") as file:
            text, left_out = _native.text_of_urdf(os.fspath(path), file.read(), floating, fix_massless)
        for remark in left_out:
            warnings.warn(remark, stacklevel=2)
        return cls(text, os.fspath(path))

    @classmethod
    def builtin(cls, name: str) -> Model:
        """A model that comes with the package.

        Examples
        --------
        >>> Model.builtin("chaplygin-sleigh").title
        'Chaplygin sleigh'
        """
        core = _native.ModelCore.builtin(name)
        if core is None:
            raise UnknownNameError(f"there is no model `{name}`; there are {', '.join(cls.builtin_names())}")
        return cls(core.text, core.name)

    @staticmethod
    def builtin_names() -> tuple[str, ...]:
        """The names of the models that come with the package."""
        return tuple(_native.builtin_names())

    @classmethod
    def builder(cls, name: str = "model") -> Builder[Model]:
        """A builder, which puts a model together call by call."""
        return Builder(name, cls.from_text)

    @property
    def name(self) -> str:
        """The name of the model in messages."""
        return self._core.name

    @property
    def text(self) -> str:
        """The text."""
        return self._core.text

    @property
    def title(self) -> str:
        """The name given in the text, or else the name of the file."""
        return self._core.title

    @property
    def parameters(self) -> Mapping[str, float]:
        """The parameters, followed by the inputs, with their values."""
        return MappingProxyType(dict(self._core.parameters()))

    @property
    def inputs(self) -> tuple[str, ...]:
        """The names of the inputs."""
        return tuple(self._core.inputs())

    @property
    def constraints(self) -> tuple[str, ...]:
        """The names of the constraints."""
        return tuple(self._core.constraints())

    @property
    def start(self) -> Mapping[str, float]:
        """The start values of coordinates, quasi-velocities and first-order states."""
        return MappingProxyType(dict(self._core.start()))

    @property
    def simulation(self) -> Mapping[str, Any]:
        """The settings of a run in the text; None for those that it does not give."""
        return MappingProxyType(self._core.simulation())

    def check(self, **settings: Any) -> Check:
        """What can be said about the model before it is run: rank, closure, constraints, what is conserved and what is stable.

        The equations are compared with a second derivation.

        Parameters
        ----------
        **settings
            As for :meth:`system`.

        Examples
        --------
        >>> check = Model.builtin("heavy-top-lagrange").check()
        >>> check.data["rank"]
        2
        """
        text, data = self._changed("Model.check", settings).check()
        return Check(text, json.loads(data))

    def derive(
        self, form: str | None = None, *, width: int = 100, inline: bool = False, **settings: Any
    ) -> Equations:
        """The equations of motion.

        Parameters
        ----------
        form : str, optional
            ``"poincare"``, ``"canonical"``, ``"lagrange"``, ``"voronets"``, ``"reduced"``, ``"lie-poisson"``, ``"orthonormal"``,
            ``"hamel"``, ``"maggi"``, ``"kane"`` or ``"gibbs-appell"``; by default the form in the text, or else Poincaré's.
        width : int
            The number of characters that fit on a line.
        inline : bool
            Whether definitions of the model are written out.
        **settings
            As for :meth:`system`.

        Examples
        --------
        >>> print(Model.builtin("euler-top").derive())  # doctest: +ELLIPSIS
        Euler's top: Poincaré's equations
        ...
        """
        return Equations(self, self._form(form), width, inline, settings)

    def _rewritten(self, text: str) -> Model:
        """The model of another text, with paths of tables relative to the same file."""
        return Model(text, self.name)

    def _changed(self, call: str, settings: Mapping[str, Any]) -> _native.ModelCore:
        return self._core.changed(changes(call, settings))

    def _form(self, form: str | None) -> str:
        return form or self._core.simulation()["form"] or "poincare"

    def theory(
        self,
        *,
        degree: int = 2,
        functions: object = (),
        canonical: Mapping[str, object] | None = None,
        **settings: Any,
    ) -> Theory:
        """Brackets, Casimir functions, integrals, Hamilton-Jacobi's equation, steady motions and their stability,
        Routh's reduction.

        Parameters
        ----------
        degree : int
            The highest degree in the velocities of the integrals sought.
        functions : sequence of expressions
            Functions of the position by which the coefficients of integrals may be multiplied.
        canonical : mapping of names to expressions, optional
            Functions to be tested as canonical variables: new coordinates, then as many new momenta, as functions of
            coordinates, velocities and momenta ``p_x``.
        **settings
            As for :meth:`system`.
        """
        several = functions if isinstance(functions, (list, tuple)) else [functions]
        proposed = [(name, str(f)) for name, f in (canonical or {}).items()]
        return Theory(self, degree, [str(f) for f in several], proposed, settings)

    def fmu(
        self,
        path: str | os.PathLike[str],
        form: str | None = None,
        *,
        version: int = 3,
        solver: str | None = None,
        step: float | None = None,
        compiled: bool = True,
        **settings: Any,
    ) -> None:
        """Writes a Functional Mock-up Unit for Model Exchange and Co-Simulation, as ``pc emit --fmu`` does.

        Parameters
        ----------
        path : path
            The file to write, whose name becomes that of the model.
        form : str, optional
            ``"poincare"``, ``"reduced"``, ``"orthonormal"``, ``"voronets"`` or ``"hamel"``.
        version : int
            The version of FMI, 2 or 3.
        solver : str, optional
            How the unit integrates on its own: ``"dop853"``, ``"radau5"`` (stiff), or ``"rk4"`` with fixed steps of the length
            ``step``.
        compiled : bool
            Whether the unit contains a binary for this machine besides the sources, which requires a C compiler.
        **settings
            As for :meth:`system`.
        """
        solves = None if solver is None else (solver, step)
        name = os.path.splitext(os.path.basename(os.fspath(path)))[0]
        core = self._changed("Model.fmu", settings)
        for remark in core.write_fmu(os.fspath(path), name, version, form or "poincare", solves, compiled):
            warnings.warn(remark, stacklevel=2)

    def linearize(
        self,
        at: str = "steady",
        *,
        hold: str | Sequence[str] = (),
        cyclic: str | None = None,
        **settings: Any,
    ) -> Linearization:
        """The motions near a state, to first order: matrices, eigenvalues and modes, as in ``pc linearize``.

        Parameters
        ----------
        at : str
            The state: ``"steady"``, the equilibrium or steady motion near the start; ``"rest"``, an equilibrium near it with all
            quasi-velocities 0; or ``"start"``, the start as it is.
        hold : sequence of str
            Components of the state that keep their start values while a steady state is sought.
        cyclic : str, optional
            ``"keep"`` cyclic coordinates that are at rest, or ``"drop"`` all; by default they are kept at
            an equilibrium and dropped for a motion.
        **settings
            As for :meth:`system`.

        Raises
        ------
        ChetaevError
            If there is no such state.

        Examples
        --------
        >>> linear = Model.builtin("furuta-pendulum").linearize(start={"θ": 0.1})
        >>> linear.is_steady
        True
        """
        return Linearization(*self._changed("Model.linearize", settings).linearized(_state(at, hold, cyclic)))

    def root_locus(
        self,
        name: str,
        values: Sequence[float],
        at: str = "steady",
        *,
        hold: str | Sequence[str] = (),
        cyclic: str | None = None,
        **settings: Any,
    ) -> RootLocus:
        """The eigenvalues of :meth:`linearize` for each value of a parameter or start value, followed from one value to the next.

        Examples
        --------
        >>> bicycle = Model.builtin("whipple-bicycle")
        >>> locus = bicycle.root_locus("v0", [0.0, 2.5, 5.0, 7.5], start={"roll": 0.0})
        >>> locus.branches.shape
        (5, 4)
        """
        listed = [float(value) for value in values]
        return RootLocus(*self._changed("Model.root_locus", settings).locus(name, listed, _state(at, hold, cyclic)))

    def equilibria(
        self, box: Mapping[str, tuple[float, float]] | None = None, *, starts: int = 256, **settings: Any
    ) -> Equilibria:
        """The states of rest in a box, by Newton's method from points that fill it evenly; there may be others.

        Parameters
        ----------
        box : mapping, optional
            Lower and upper bounds of coordinates and first-order states; by default a full turn about the start for angles, and
            2 (1 + |start|) on both sides of the start for other variables.
        starts : int
            Number of points from which Newton's method starts.
        **settings
            As for :meth:`system`.

        Examples
        --------
        >>> found = Model.builtin("furuta-pendulum").equilibria()
        >>> sorted(abs(round(one.state["θ"], 6)) for one in found)
        [0.0, 3.141593]
        """
        bounds = [(name, float(low), float(high)) for name, (low, high) in (box or {}).items()]
        return Equilibria(*self._changed("Model.equilibria", settings).equilibria(bounds, starts))

    def system(self, form: str | None = None, **settings: Any) -> System:
        """The equations of motion, compiled.

        Parameters
        ----------
        form : str, optional
            ``"poincare"``, ``"canonical"``, ``"reduced"``, ``"lie-poisson"``, ``"orthonormal"``, ``"voronets"`` or ``"hamel"``;
            by default the form in the text, or else Poincaré's.
        parameters, start : mapping, optional
            Values that replace those of the text; they can also be set later.
        inputs : mapping, optional
            Inputs with the values that replace those of the text: a number, or a table ``(times, values)``, which is interpolated
            linearly, or as a third entry says: ``"linear"``, ``"cubic"`` or ``"hold"``.
        project_start : bool
            Whether the start is moved onto the constraints; ``hold`` names the components that must not be moved.
        project : sequence of str
            Integrals, or ``"energy"``, that the motion is made to keep at their values at the start.
        velocities : mapping, optional
            Quasi-velocities for the form ``"hamel"``, each with its definition.
        independent : sequence of str
            The velocities that are to be independent under constraints.
        reactions : bool
            Whether the reactions of constraints are columns of motions.
        limit_memory, limit_time : optional
            Limits on the memory for expressions, in bytes, and on the time for one derivation, in seconds.
        verify : bool
            Whether the equations are compared with a second derivation, at the start and near it; where the two disagree,
            :class:`DisagreementError` is raised.

        Examples
        --------
        >>> system = Model.builtin("heavy-top-lagrange").system(parameters={"mg": 2.0})
        >>> system.parameters["mg"]
        2.0
        """
        return System(self, self._form(form), **settings)

    def __reduce__(self) -> tuple[type[Model], tuple[bytes, str]]:
        return Model, (self._text, self.name)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Model):
            return NotImplemented
        return (self.name, self._text) == (other.name, other._text)

    def __hash__(self) -> int:
        return hash((self.name, self._text))

    def __repr__(self) -> str:
        return f"<Model {self.title!r}: {', '.join(self._core_names())}>"

    def _core_names(self) -> list[str]:
        return [name for name, _ in self._core.start()]
