"""Printed results of models."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from chetaev._protocols import ModelLike


class Check:
    """What can be said about a model before it is run.

    Attributes
    ----------
    text : str
        The results as text for people.
    data : dict
        The results as data for programs.
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
    """Equations of motion in printed form.

    A notebook displays them as formulas; ``print`` shows them as text.
    """

    __slots__ = ("_arguments", "_core", "form", "text")

    def __init__(self, model: ModelLike, form: str, width: int, inline: bool, settings: dict[str, Any]) -> None:
        self._arguments = (model, form, width, inline, settings)
        self._core = model._changed("Model.derive", settings)
        self.form = form
        self.text = self._printed("text")

    def _printed(self, language: str) -> str:
        _, form, width, inline, _ = self._arguments
        return self._core.printed(form, language, width, inline)

    def __reduce__(self) -> tuple[type[Equations], tuple[ModelLike, str, int, bool, dict[str, Any]]]:
        return Equations, self._arguments

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return self.text

    def latex(self) -> str:
        """The equations as LaTeX for a paper, with amsmath.

        Examples
        --------
        >>> print(Model.builtin("euler-top").derive().latex())  # doctest: +ELLIPSIS
        %...
        """
        return self._printed("latex")

    def data(self) -> dict[str, Any]:
        """The equations as data for programs: kinematics, structure coefficients, mass matrix, right-hand sides, operations."""
        found: dict[str, Any] = json.loads(self._printed("json"))
        return found

    def html(self) -> str:
        """The equations in MathML for a browser."""
        _, form, _, inline, _ = self._arguments
        name, plain, parts = self._core.displayed(form, inline)
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
        # Notebooks do not support comments outside formulas.
        return "\n".join(line for line in self.latex().splitlines() if not line.startswith("%"))

    def sympy(self) -> dict[str, Any]:
        """The equations as expressions of SymPy.

        Returns
        -------
        dict
            ``coordinates``, ``quasi_velocities`` and ``parameters`` (lists of symbols), ``velocities`` (ẋ, a column), and, for equations
            in velocities, ``mass_matrix``, ``right_hand_side`` of M η̇ = r and ``energy``; for canonical ones ``momenta``, ``rates`` (ẏ) and
            ``hamiltonian``. Kane's have ``active_forces`` F and ``inertia_forces`` F*, Gibbs–Appell's ``gibbs_function`` S, both
            ``acceleration_terms`` −F* = ∂S/∂η̇; Maggi's have ``lagrange_expressions`` and the sums of these that are ``vanishing``,
            in place of M and r. Names are real symbols; velocities are called ``x'``, accelerations ``x''``.

        Examples
        --------
        >>> equations = Model.builtin("euler-top").derive().sympy()
        >>> equations["mass_matrix"].shape
        (3, 3)
        """
        from chetaev._language.sympy import equations

        return equations(self.data())

    def c(self, name: str = "model", *, jacobian: bool = True) -> dict[str, str]:
        """The equations as C source without dependencies: the texts of files by name."""
        return dict(self._core.source(self.form, "c", name, jacobian))

    def rust(self, name: str = "model", *, jacobian: bool = True) -> dict[str, str]:
        """The equations as Rust source without dependencies: the texts of files by name."""
        return dict(self._core.source(self.form, "rust", name, jacobian))


class Theory:
    """The analysis of a model in printed form."""

    __slots__ = ("_arguments", "_core", "text")

    def __init__(
        self,
        model: ModelLike,
        degree: int,
        functions: Sequence[str],
        canonical: Sequence[tuple[str, str]],
        settings: dict[str, Any],
    ) -> None:
        self._arguments = (model, degree, functions, canonical, settings)
        self._core = model._changed("Model.theory", settings)
        self.text = self._printed("text")

    def _printed(self, language: str) -> str:
        _, degree, functions, canonical, _ = self._arguments
        return self._core.theory(language, degree, functions, canonical)

    def __reduce__(
        self,
    ) -> tuple[
        type[Theory],
        tuple[ModelLike, int, Sequence[str], Sequence[tuple[str, str]], dict[str, Any]],
    ]:
        return Theory, self._arguments

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return self.text

    def latex(self) -> str:
        """For a paper."""
        return self._printed("latex")

    def data(self) -> dict[str, Any]:
        """For programs."""
        found: dict[str, Any] = json.loads(self._printed("json"))
        return found

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.text)}</pre>"


class Page:
    """A page for a browser that loads nothing from elsewhere; a notebook displays it in a frame.

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
