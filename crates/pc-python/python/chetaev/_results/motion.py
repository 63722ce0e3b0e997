"""Motions, as arrays by name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from chetaev import _native
from chetaev._language.arguments import listed
from chetaev._language.errors import ChetaevError, UnknownNameError
from chetaev._results.printed import Page

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from chetaev._protocols import SystemLike

    Floats = npt.NDArray[np.float64]


class Occurrence(NamedTuple):
    """An event that occurred."""

    #: The name of the event.
    name: str
    #: The time of the event.
    t: float
    #: The state before and after its reset.
    before: Floats
    after: Floats


class Motion(Mapping[str, "Floats"]):
    """A motion: arrays by the names of coordinates, quasi-velocities, first-order states, integrals and outputs.

    It is made by :meth:`System.run`, and can be pickled.

    Attributes
    ----------
    t : array
        The times of the rows, N of them.
    y : array
        The states, n × N, as in results of :func:`scipy.integrate.solve_ivp`.
    columns : tuple of str
        The names, ``t`` first.
    events : list of Occurrence
        The events that occurred, in order.
    ending : str
        ``"completed"``, ``"event"`` or ``"failed"``.
    terminal : str or None
        The name of the event that ended the motion.
    drift : dict
        The largest deviation of each integral, including the energy, from its value at the start.
    residuals : dict
        The largest residual of each constraint that is kept by projection.
    statistics : dict
        Steps, evaluations, …; for ``"auto"`` also ``stiff_from``, the time at which stiffness was first detected, or None,
        ``implicit_steps`` and ``changes``, how often the method was switched.

    Examples
    --------
    >>> motion = Model.builtin("heavy-top-lagrange").system().run(5.0, samples=3)
    >>> motion.t
    array([0. , 2.5, 5. ])
    >>> list(motion)[:3]
    ['t', 'γ1', 'γ2']
    """

    def __init__(
        self,
        system: SystemLike,
        settings: dict[str, Any],
        wished: dict[str, Any],
        start: list[float] | None,
        outcome: _native._Outcome,
    ) -> None:
        self._origin = (system.model, system.form, settings)
        self._system: Any = None
        self._kinds = {kind: tuple(names) for kind, names in outcome["kinds"].items()}
        self._keeps_energy = outcome["keeps_energy"]
        self._conserved_at_start = outcome["conserved_at_start"]
        self._wished = wished
        self._start = start
        self.t: Floats = outcome["t"]
        self.y: Floats = outcome["states"].T
        self._values = outcome["values"]
        self.columns: tuple[str, ...] = ("t", *outcome["columns"])
        self.events: list[Occurrence] = [Occurrence(*event) for event in outcome["events"]]
        self.ending: str = outcome["ending"]
        self.terminal: str | None = outcome["event"]
        self.residuals: dict[str, float] = outcome["residuals"]
        self.statistics: dict[str, Any] = outcome["statistics"]
        self._dense: _native.DenseCore | None = None

    @property
    def system(self) -> Any:
        """The :class:`System` with the values that it had for this motion, derived once more on the first request."""
        if self._system is None:
            model, form, settings = self._origin
            self._system = model.system(form, **settings)
        return self._system

    def __getitem__(self, name: str) -> Floats:
        if name == "t":
            return self.t
        try:
            place = self.columns.index(name)
        except ValueError:
            raise UnknownNameError(f"there is no column `{name}`; there are {', '.join(self.columns)}") from None
        column: Floats = self._values[:, place - 1]
        return column

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.columns)

    def __repr__(self) -> str:
        span = f"t = {self.t[0]:g} to {self.t[-1]:g}" if len(self.t) else "no row"
        return f"<Motion {self._origin[0].title!r}: {len(self.t)} rows, {span}, {self.ending}>"

    def __getstate__(self) -> dict[str, Any]:
        # The dense motion is integrated again when it is needed.
        return {**self.__dict__, "_dense": None, "_system": None}

    @property
    def drift(self) -> dict[str, float]:
        """The largest deviation of each integral, including the energy, from its value at the start."""
        if len(self.t) == 0:
            return {}
        starts = zip(self._kinds["conserved"], self._conserved_at_start)
        return {name: float(abs(self[name] - start).max()) for name, start in starts}

    def dense(self, t: npt.ArrayLike) -> Floats:
        """The state at any time of the motion: n numbers, or n × N for N times.

        On the first call the motion is integrated once more, and the polynomials of all steps are kept. Between steps, states
        violate constraints by the error of a step.

        Examples
        --------
        >>> motion = Model.builtin("heavy-top-lagrange").system().run(5.0)
        >>> motion.dense(1.234).shape
        (6,)
        """
        import numpy as np

        if self._dense is None:
            end = float(self.t[-1])
            start = self.system._start_state() if self._start is None else self._start
            self._dense = self.system._dense(end, start, {**self._wished, "t_end": end, "times": None})
        times = np.asarray(t, dtype=float)
        states = self._dense.at(times.ravel().tolist())
        return states[:, 0] if times.ndim == 0 else states.reshape(states.shape[0], *times.shape)

    def sensitivity(self, name: str, parameter: str) -> Floats:
        """The column ∂(column)/∂(parameter), if it was requested from :meth:`System.run`."""
        return self[f"∂{name}/∂{parameter}"]

    def to_pandas(self) -> Any:
        """A data frame with the times as index."""
        import pandas as pd

        index = pd.Index(self.t, name="t")
        return pd.DataFrame(self._values, index=index, columns=list(self.columns[1:]))

    def plot(self, names: str | Sequence[str] | None = None, *, ax: Any = None) -> Any:
        """Draws columns over time with matplotlib.

        Parameters
        ----------
        names : sequence of str, optional
            The columns, on common axes; by default all of them, grouped by kind and scale as in ``pc run --plot``, with events and the
            drift of integrals.
        ax : optional
            The axes to draw on; if they are given, all columns are drawn on them.

        Returns
        -------
        The figure.
        """
        import matplotlib.pyplot as plt

        if names is not None or ax is not None:
            chosen = self.columns[1:] if names is None else listed("names", names)
            if ax is None:
                _, ax = plt.subplots()
            for name in chosen:
                ax.plot(self.t, self[name], label=name)
            ax.set_xlabel("t")
            ax.legend(loc="best")
            return ax.figure
        panels = _native.panels_of(self._origin[0].title, self._recorded())
        figure, axes = plt.subplots(len(panels), 1, sharex=True, squeeze=False, figsize=(7.0, 2.2 * len(panels)))
        for axis, (title, scale, events, curves) in zip(axes[:, 0], panels):
            for name, times, values in curves:
                # Small values of different sizes are drawn as decimal logarithms.
                shown = [10.0**value for value in values] if scale == "decades" else values
                axis.plot(times, shown, label=name, linewidth=1.0)
            if scale == "decades":
                axis.set_yscale("log")
            for time in events:
                axis.axvline(time, color="0.8", linewidth=0.8, zorder=0)
            axis.set_title(title, fontsize="medium", loc="left")
            axis.legend(loc="upper right", fontsize="small")
        axes[-1, 0].set_xlabel("t")
        figure.tight_layout()
        return figure

    def _recorded(self) -> dict[str, Any]:
        """The motion in the form that the native part takes."""
        recorded: dict[str, Any] = {"t": self.t.tolist(), "events": [event.t for event in self.events]}
        recorded["keeps_energy"] = self._keeps_energy
        for kind, names in self._kinds.items():
            recorded[kind] = [(name, self[name].tolist()) for name in names]
        remark = None
        if self.ending == "event":
            remark = f"The event {self.terminal} ended the motion."
        elif self.ending != "completed":
            remark = f"The motion {self.ending}; what was reached is shown."
        return {**recorded, "remark": remark}

    def animate(self) -> Page:
        """An animation of the motion for a browser or a notebook, if the model can be drawn.

        Raises
        ------
        ChetaevError
            If the text contains nothing to be drawn.
        """
        page = self.system._animation_page(self._recorded())
        if page is None:
            raise ChetaevError(
                f"there is nothing to be drawn of {self.system.model.title}: add [[draw]] or bodies to its text"
            )
        return Page(page)

    def report(self) -> Page:
        """A page with everything that is known about the model and this motion."""
        page: Page = self.system.report(self)
        return page
