"""Quantities of a system besides its rates."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from chetaev._protocols import SystemLike

    Floats = npt.NDArray[np.float64]


class VelocityMap(NamedTuple):
    """A velocity or momentum w of m components as a function of the quasi-velocities η: w = matrix @ η + rest.

    Its rate is matrix @ η̇ + rate.
    """

    #: The matrix, m × k: the Jacobian of a velocity, or the centroidal momentum matrix.
    matrix: Floats
    #: w for η = 0, which vanishes where nothing depends on time.
    rest: Floats
    #: The rate of w for η̇ = 0, such as J̇ η where w = J η.
    rate: Floats

    @classmethod
    def _of_columns(cls, rows: int, columns: list[float]) -> VelocityMap:
        import numpy as np

        all_columns = np.array(columns).reshape(-1, rows).T
        return cls(all_columns[:, :-2], all_columns[:, -2], all_columns[:, -1])


class Lyapunov(NamedTuple):
    """Lyapunov exponents of a motion."""

    #: The largest exponents, in 1/time.
    exponents: Floats
    #: The mean exponents after each interval: a row for each interval.
    history: Floats


class Gradient(NamedTuple):
    """A function of a motion with its derivatives."""

    #: Its value.
    value: float
    #: The derivatives with respect to parameters and inputs, by their names.
    by_parameters: dict[str, float]
    #: The derivatives with respect to the components of the state at the start, by their names, each with the others
    #: held fixed.
    by_start: dict[str, float]


class Bracket:
    """The Poisson bracket (f, g) (12) of two functions of the state, as a function of time and state."""

    __slots__ = ("_function", "_arguments")

    def __init__(self, system: SystemLike, f: str, g: str) -> None:
        self._arguments = (system, f, g)
        self._function = system._poisson_bracket(f, g)

    def __call__(self, t: float, y: npt.ArrayLike) -> float:
        import numpy as np

        return self._function.at(float(t), np.asarray(y, dtype=float).tolist())

    def __reduce__(self) -> tuple[type[Bracket], tuple[SystemLike, str, str]]:
        return Bracket, self._arguments

    def __repr__(self) -> str:
        return f"<Bracket ({self._arguments[1]}, {self._arguments[2]})>"
