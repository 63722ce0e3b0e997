"""Models, and what is printed of them."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from chetaev import _native
from chetaev._errors import UnknownNameError

if TYPE_CHECKING:
    from chetaev._builder import Builder
    from chetaev._system import System

#: The forms of equations, as ``pc derive --form`` names them.
FORMS = ("poincare", "canonical", "lagrange", "voronets", "reduced", "lie-poisson", "orthonormal", "hamel")


def changes(
    *,
    parameters: Mapping[str, float] | None = None,
    start: Mapping[str, float] | None = None,
    project_start: bool = False,
    hold: Sequence[str] = (),
    project: Sequence[str] = (),
    velocities: Mapping[str, object] | None = None,
    independent: Sequence[str] = (),
    reactions: bool = False,
    limit_memory: int | None = None,
    limit_time: float | None = None,
) -> dict[str, Any]:
    """What a model is changed by before it is derived, as the native part takes it."""
    return {
        "parameters": [(name, float(value)) for name, value in (parameters or {}).items()],
        "start": [(name, float(value)) for name, value in (start or {}).items()],
        "project_start": project_start,
        "hold": list(hold),
        "project": list(project),
        "velocities": [(name, str(value)) for name, value in (velocities or {}).items()],
        "independent": list(independent),
        "reactions": reactions,
        "limit_memory": limit_memory,
        "limit_time": limit_time,
    }


class Model:
    """A mechanical system, written as a text.

    A model never changes. It can be pickled, and is equal to another one of the same text.

    Parameters
    ----------
    text : str or bytes
        The text, as ``docs/model-format.md`` explains it.
    name : str
        What it is called in messages; paths of tables in it are relative to the directory of that name.

    Raises
    ------
    ModelError
        If the text is wrong.
    """

    __slots__ = ("_core", "_text")

    def __init__(self, text: str | bytes, name: str = "<text>") -> None:
        self._text = text if isinstance(text, bytes) else text.encode()
        self._core = _native.ModelCore(name, self._text)

    @classmethod
    def from_text(cls, text: str, name: str = "<text>") -> Model:
        """The model of a text."""
        return cls(text, name)

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Model:
        """The model in a file."""
        with open(path, "rb") as file:
            return cls(file.read(), os.fspath(path))

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

    @staticmethod
    def builder(name: str = "model") -> Builder:
        """A model to be put together call by call."""
        from chetaev._builder import Builder

        return Builder(name)

    @property
    def name(self) -> str:
        """What it is called in messages."""
        return self._core.name

    @property
    def text(self) -> str:
        """The text."""
        return self._core.text

    @property
    def title(self) -> str:
        """The name given in the text, else that of the file."""
        return self._core.title

    @property
    def parameters(self) -> Mapping[str, float]:
        """The parameters, then the inputs, with their values."""
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
        """What the text says of a run; None where it says nothing."""
        return MappingProxyType(self._core.simulation())

    def check(self, **settings: Any) -> Check:
        """What can be said of the model before it is run: rank, closure, constraints, what is conserved, what is stable.

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
        text, data = self._core.changed(changes(**settings)).check()
        return Check(text, json.loads(data))

    def derive(
        self, form: str | None = None, *, width: int = 100, inline: bool = False, **settings: Any
    ) -> Equations:
        """The equations of motion.

        Parameters
        ----------
        form : str, optional
            ``"poincare"``, ``"canonical"``, ``"lagrange"``, ``"voronets"``, ``"reduced"``, ``"lie-poisson"``, ``"orthonormal"`` or
            ``"hamel"``; else that of the text, else Poincaré's.
        width : int
            Columns of a line.
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
        core = self._core.changed(changes(**settings))
        return Equations(core, self._form(form), width, inline)

    def _form(self, form: str | None) -> str:
        return form or self._core.simulation()["form"] or "poincare"

    def theory(self, *, degree: int = 2, functions: Sequence[object] = (), **settings: Any) -> Theory:
        """Brackets, Casimir functions, integrals, steady motions and their stability, Routh's reduction.

        Parameters
        ----------
        degree : int
            The largest degree in the velocities of the integrals sought.
        functions : sequence of expressions
            Functions of the place by which their coefficients may be multiplied.
        **settings
            As for :meth:`system`.
        """
        return Theory(self._core.changed(changes(**settings)), degree, [str(f) for f in functions])

    def system(self, form: str | None = None, **settings: Any) -> System:
        """The equations of motion, compiled.

        Parameters
        ----------
        form : str, optional
            ``"poincare"``, ``"canonical"``, ``"reduced"``, ``"lie-poisson"``, ``"orthonormal"`` or ``"hamel"``; else that of the text,
            else Poincaré's.
        parameters, start : mapping, optional
            Values other than those of the text; they can be set later too.
        project_start : bool
            Whether the start is moved onto the constraints, where ``hold`` names what is not to be moved.
        project : sequence of str
            Integrals, or ``"energy"``, at whose values at the start the motion is kept.
        velocities : mapping, optional
            Quasi-velocities of the form ``"hamel"``, each with its definition.
        independent : sequence of str
            The velocities that are to be independent under constraints.
        reactions : bool
            Whether the reactions of constraints are columns of motions.
        limit_memory, limit_time : optional
            Bytes of expressions, and seconds of one derivation.

        Examples
        --------
        >>> system = Model.builtin("heavy-top-lagrange").system(parameters={"mg": 2.0})
        >>> system.parameters["mg"]
        2.0
        """
        from chetaev._system import System

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


class Check:
    """What can be said of a model before it is run.

    Attributes
    ----------
    text : str
        For people.
    data : dict
        For programs.
    """

    __slots__ = ("data", "text")

    def __init__(self, text: str, data: dict[str, Any]) -> None:
        self.text = text
        self.data = data

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.text)}</pre>"


class Equations:
    """Equations of motion, in print.

    In a notebook they show themselves as formulas. ``print`` shows them as text.
    """

    __slots__ = ("_core", "_inline", "_width", "form", "text")

    def __init__(self, core: _native.ModelCore, form: str, width: int, inline: bool) -> None:
        self._core = core
        self._width = width
        self._inline = inline
        self.form = form
        self.text = self._printed("text")

    def _printed(self, language: str) -> str:
        return self._core.printed(self.form, language, self._width, self._inline)

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return self.text

    def latex(self) -> str:
        """The equations for a paper, with amsmath.

        Examples
        --------
        >>> print(Model.builtin("euler-top").derive().latex())  # doctest: +ELLIPSIS
        %...
        """
        return self._printed("latex")

    def data(self) -> dict[str, Any]:
        """The equations for programs: kinematics, structure coefficients, mass matrix, right-hand sides, operations."""
        found: dict[str, Any] = json.loads(self._printed("json"))
        return found

    def html(self) -> str:
        """The equations for a browser, in MathML."""
        name, plain, parts = self._core.displayed(self.form, self._inline)
        shown = [f"<p><b>{html.escape(name)}</b></p>"]
        if plain is not None:
            shown.append(f"<pre>{html.escape(plain)}</pre>")
        for title, formulas, notes in parts:
            shown.append(f"<p><i>{html.escape(title)}</i></p>")
            if formulas is not None:
                shown.append(f'<div style="overflow-x: auto">{formulas}</div>')
            shown.extend(f"<p>{html.escape(note)}</p>" for note in notes)
        return "\n".join(shown)

    def _repr_html_(self) -> str:
        return self.html()

    def _repr_latex_(self) -> str:
        # Notebooks know no comments outside formulas.
        return "\n".join(line for line in self.latex().splitlines() if not line.startswith("%"))

    def sympy(self) -> dict[str, Any]:
        """The equations as expressions of SymPy.

        Returns
        -------
        dict
            ``coordinates``, ``quasi_velocities`` and ``parameters`` (lists of symbols), ``velocities`` (ẋ, a column), and, for equations
            in velocities, ``mass_matrix``, ``right_hand_side`` of M η̇ = r and ``energy``; for canonical ones ``momenta``, ``rates`` (ẏ) and
            ``hamiltonian``. Names are real symbols; velocities are called ``x'``, accelerations ``x''``.

        Examples
        --------
        >>> equations = Model.builtin("euler-top").derive().sympy()
        >>> equations["mass_matrix"].shape
        (3, 3)
        """
        from chetaev._sympy import equations

        return equations(self.data())

    def c(self, name: str = "model", *, jacobian: bool = True) -> dict[str, str]:
        """The equations as C without dependencies: names of files with their texts."""
        return dict(self._core.source(self.form, "c", name, jacobian))

    def rust(self, name: str = "model", *, jacobian: bool = True) -> dict[str, str]:
        """The equations as Rust without dependencies: names of files with their texts."""
        return dict(self._core.source(self.form, "rust", name, jacobian))


class Theory:
    """The analysis of a model, in print."""

    __slots__ = ("_arguments", "_core", "text")

    def __init__(self, core: _native.ModelCore, degree: int, functions: Sequence[str]) -> None:
        self._core = core
        self._arguments = (degree, functions)
        self.text = core.theory("text", degree, functions)

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return self.text

    def latex(self) -> str:
        """For a paper."""
        return self._core.theory("latex", *self._arguments)

    def data(self) -> dict[str, Any]:
        """For programs."""
        found: dict[str, Any] = json.loads(self._core.theory("json", *self._arguments))
        return found

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.text)}</pre>"


class Page:
    """A page for a browser, without anything from elsewhere; in a notebook it shows itself in a frame.

    Attributes
    ----------
    html : str
        The page.
    """

    __slots__ = ("_height", "html")

    def __init__(self, html: str, height: int = 560) -> None:
        self.html = html
        self._height = height

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the page to a file."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.html)

    def _repr_html_(self) -> str:
        # Scripts of the page run in the frame, and see nothing of the notebook.
        return (
            f'<iframe sandbox="allow-scripts" style="width: 100%; height: {self._height}px; border: 0" '
            f'srcdoc="{html.escape(self.html)}"></iframe>'
        )

    def __repr__(self) -> str:
        return f"<Page of {len(self.html)} characters>"
