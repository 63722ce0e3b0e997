"""Motions near a state, and states of rest."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]
    Complexes = npt.NDArray[np.complex128]


def _matrix(rows: list[list[float]], shape: tuple[int, int]) -> Floats:
    import numpy as np

    return np.array(rows, dtype=float).reshape(shape)


def _complex(pairs: list[list[float]]) -> Complexes:
    import numpy as np

    return np.array([complex(re, im) for re, im in pairs], dtype=complex)


class Linearization:
    """The motions near a state, to first order: δẏ = A δy + B δu, δh = C δy + D δu.

    The derivatives are exact. It is made by :meth:`Model.linearize`; printing it shows the page of
    ``pc linearize``.

    Attributes
    ----------
    state : dict
        The state, by the names of its components.
    components : tuple of str
        The names of y: n independent components of the states that satisfy the constraints.
    inputs, outputs : tuple of str
        The names of u and h.
    A, B, C, D : array
        The matrices.
    eigenvalues : array
        The eigenvalues of A, in descending order of their real parts.
    modes : list
        The eigenvector of each eigenvalue, an array of n complex numbers, or None if it is not determined.
    is_steady : bool
        Whether the state is an equilibrium or a steady motion.
    stability : str or None
        The verdict of ``pc check`` on the state; None if it is not steady.
    second_order : dict or None
        ``coordinates`` and the matrices ``M``, ``G``, ``K``, ``F`` of M q̈ + G q̇ + K q = F u, where they are defined.
    data : dict
        All results, as ``pc linearize --format json`` writes them.

    Examples
    --------
    >>> linear = Model.builtin("cart-pole").linearize()
    >>> linear.A.shape, linear.B.shape
    ((4, 4), (4, 1))
    >>> bool(linear.eigenvalues.real.max() < 0)
    True
    """

    def __init__(self, text: str, data: str) -> None:
        self._text = text
        found: dict[str, Any] = json.loads(data)
        self.data = found
        self.state: dict[str, float] = found["state"]
        self.components: tuple[str, ...] = tuple(found["components"])
        self.inputs: tuple[str, ...] = tuple(found["inputs"])
        self.outputs: tuple[str, ...] = tuple(found["outputs"])
        n, m, p = len(self.components), len(self.inputs), len(self.outputs)
        self.A = _matrix(found["A"], (n, n))
        self.B = _matrix(found["B"], (n, m))
        self.C = _matrix(found["C"], (p, n))
        self.D = _matrix(found["D"], (p, m))
        self.eigenvalues = _complex(found["eigenvalues"])
        self.modes = [None if mode is None else _complex(mode) for mode in found["modes"]]
        self.is_steady: bool = found["steady"]
        self.stability: str | None = found["stability"]
        second = found["second_order"]
        if second is not None:
            q = len(second["coordinates"])
            matrices = {name: _matrix(second[name], (q, m if name == "F" else q)) for name in "MGKF"}
            second = {"coordinates": tuple(second["coordinates"]), **matrices}
        self.second_order: dict[str, Any] | None = second

    def to_scipy(self) -> Any:
        """A :class:`scipy.signal.StateSpace`; if the model has no outputs, all components are outputs."""
        import numpy as np
        from scipy.signal import StateSpace

        if self.outputs:
            return StateSpace(self.A, self.B, self.C, self.D)
        return StateSpace(self.A, self.B, np.eye(len(self.components)), np.zeros(self.B.shape))

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        inputs = f", inputs {', '.join(self.inputs)}" if self.inputs else ""
        return f"<Linearization in {', '.join(self.components)}{inputs}>"


class RootLocus:
    """The eigenvalues as functions of a parameter, made by :meth:`Model.root_locus`.

    Attributes
    ----------
    parameter : str
        The name of the quantity that is varied.
    values : array
        The values of this quantity.
    branches : array
        The eigenvalues: a row for each branch, which is followed from value to value; NaN where there is no eigenvalue.
    missing : dict
        The values for which there is no linearization, with the reason for each.
    """

    def __init__(self, text: str, data: str) -> None:
        import numpy as np

        self._text = text
        found: dict[str, Any] = json.loads(data)
        self.parameter: str = found["parameter"]
        self.values: Floats = np.array(found["values"], dtype=float)
        parts = [
            np.array([branch["real"], branch["imaginary"]], dtype=float) for branch in found["branches"]
        ]
        self.branches: Complexes = np.array([real + 1j * imaginary for real, imaginary in parts])
        self.missing: dict[float, str] = {entry["value"]: entry["reason"] for entry in found["missing"]}

    def plot(self, *, ax: Any = None) -> Any:
        """Draws the branches in the complex plane with matplotlib; returns the figure."""
        if ax is None:
            import matplotlib.pyplot as plt

            _, ax = plt.subplots()
        for branch in self.branches:
            ax.plot(branch.real, branch.imag, ".-", linewidth=0.8, markersize=3.0)
        ax.axvline(0.0, color="0.7", linewidth=0.8)
        ax.set_xlabel("Re λ")
        ax.set_ylabel("Im λ")
        ax.set_title(f"{self.parameter} = {self.values[0]:g} to {self.values[-1]:g}")
        return ax.figure

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return f"<RootLocus of {len(self.branches)} eigenvalues over {len(self.values)} values of {self.parameter}>"


class Trim:
    """A state and inputs at rest or in steady motion, made by :meth:`System.trim`.

    Attributes
    ----------
    state : dict
        The state, by the names of its components.
    inputs : dict
        The inputs.
    rates : dict
        The cyclic coordinates with their rates, which are constant: all zero at rest.
    residual : float
        The norm of the rates that should vanish.
    """

    def __init__(self, text: str, data: str) -> None:
        self._text = text
        found: dict[str, Any] = json.loads(data)
        self.state: dict[str, float] = found["state"]
        self.inputs: dict[str, float] = found["inputs"]
        self.rates: dict[str, float] = found["rates"]
        self.residual: float = found["residual"]

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        values = ", ".join(f"{name} = {value:g}" for name, value in {**self.inputs, **self.state}.items())
        return f"<Trim {values}>"


class Equilibrium(NamedTuple):
    """A state of rest."""

    #: The state, by the names of its components.
    state: Mapping[str, float]
    #: The energy.
    energy: float
    #: The eigenvalues of the motions near this state.
    eigenvalues: Complexes
    #: The stability of the state, in words.
    stability: str
    #: The dimension of the family of equilibria to which the state belongs; 0 if the state is isolated.
    family: int
    #: How many equilibria of the family were found.
    members: int


class Equilibria(Sequence[Equilibrium]):
    """The states of rest that were found, made by :meth:`Model.equilibria`; there may be others.

    Attributes
    ----------
    anywhere : tuple of str
        Coordinates on which nothing depends.
    box : dict
        The bounds within which they were sought.
    """

    def __init__(self, text: str, data: str) -> None:
        self._text = text
        found: dict[str, Any] = json.loads(data)
        self._list = [
            Equilibrium(
                one["state"],
                one["energy"],
                _complex(one["eigenvalues"]),
                one["verdict"],
                one["family"],
                one["members"],
            )
            for one in found["equilibria"]
        ]
        self.anywhere: tuple[str, ...] = tuple(found["anywhere"])
        self.box: dict[str, tuple[float, float]] = {name: (low, high) for name, (low, high) in found["box"].items()}

    def __len__(self) -> int:
        return len(self._list)

    def __getitem__(self, place: Any) -> Any:
        return self._list[place]

    def __iter__(self) -> Iterator[Equilibrium]:
        return iter(self._list)

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return f"<Equilibria: {len(self)} found>"
