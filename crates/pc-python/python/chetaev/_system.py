"""Equations of motion, compiled."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from chetaev import _native
from chetaev._language.arguments import listed, only, real, reals, whole
from chetaev._language.errors import IntegrationError
from chetaev._language.events import Event
from chetaev._language.inputs import course
from chetaev._results.linear import Trim
from chetaev._results.motion import Motion
from chetaev._results.printed import Page
from chetaev._results.quantities import Bracket, Gradient, Lyapunov, VelocityMap
from chetaev._results.sweep import Sweep, swept
from chetaev._results.values import Values

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import numpy as np
    import numpy.typing as npt

    from chetaev._native import Stepper
    from chetaev._protocols import ModelLike

    Floats = npt.NDArray[np.float64]


#: The settings that integrations take in addition to a span of time.
_STEPS = ("method", "rtol", "atol", "max_step", "samples_per_step", "accumulation", "limit_time")


class System(_native.System):
    """The compiled equations ẏ = f(t, y) of a model, with parameters and start values that can be set.

    ``system(t, y)`` is ẏ, and ``system.jac(t, y)`` its Jacobian, as :func:`scipy.integrate.solve_ivp` takes them. If ``y`` is an array
    of n × N numbers, with a state in each column, so are the results, which are computed without holding the interpreter's lock; ``t``
    is then a single number, or N numbers. Any number of threads may use a system at once. It can be pickled, with its
    equations: they are not derived again where it is read by the same version of the package.

    It is made by :meth:`Model.system`.

    Examples
    --------
    >>> system = Model.builtin("heavy-top-lagrange").system()
    >>> system(0.0, system.y0).shape
    (6,)
    >>> from scipy.integrate import solve_ivp
    >>> solution = solve_ivp(system, (0.0, 1.0), system.y0, jac=system.jac, method="Radau", rtol=1e-8)
    >>> motion = system.run(1.0, samples=2)
    >>> bool(abs(solution.y[:, -1] - motion.y[:, -1]).max() < 1e-5)
    True
    """

    _model: ModelLike
    _form: str
    _settings: dict[str, Any]
    _companion: System | None

    def __new__(cls, model: ModelLike, form: str = "poincare", *, _saved: bytes | None = None, **settings: Any) -> System:
        if not hasattr(model, "_changed"):
            raise TypeError(f"a system is made of a Model, by Model.system(), not of {model!r}")
        settings = {**settings}
        for kind in ("parameters", "start"):
            settings[kind] = reals(kind, settings.get(kind) or {})
        settings["inputs"] = dict(settings.get("inputs") or {})
        self = super().__new__(cls, model._changed("Model.system", settings), form, _saved)
        assert isinstance(self, System)
        self._model = model
        self._form = form
        self._settings = settings
        self._companion = None
        return self

    def __reduce__(self) -> tuple[Callable[..., System], tuple[ModelLike, str, dict[str, Any], bytes]]:
        return _restored, (self._model, self._form, self.settings(), self._saved_equations())

    def __repr__(self) -> str:
        return f"<System {self._model.title!r}, {self._form}: {', '.join(self.names)}>"

    @property
    def model(self) -> Any:
        """The :class:`Model`, with the values of its text."""
        return self._model

    @property
    def form(self) -> str:
        """The form of the equations."""
        return self._form

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the components of a state."""
        return tuple(self._state_names)

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the columns of a motion, without ``t``."""
        return tuple(self._column_names)

    @property
    def y0(self) -> Floats:
        """The state at the start."""
        import numpy as np

        return np.array(self._start_state())

    @property
    def t0(self) -> float:
        """The time at the start."""
        return self._t_start

    @property
    def parameters(self) -> Values:
        """The parameters, followed by the inputs, which can be read and set.

        Examples
        --------
        >>> system = Model.builtin("heavy-top-lagrange").system()
        >>> system.parameters["mg"] = 2.0
        >>> system.parameters.update({"I1": 1.5, "I3": 0.75})
        """
        return Values(self, "parameters")

    @property
    def start(self) -> Values:
        """The start values, which can be read and set."""
        return Values(self, "start")

    def settings(self) -> dict[str, Any]:
        """The arguments of :meth:`Model.system`, with the values that have been set since."""
        values = {kind: dict(self._settings[kind]) for kind in ("parameters", "start")}
        return {**self._settings, **values}

    def _set(
        self, *, parameters: Mapping[str, float] | None = None, start: Mapping[str, float] | None = None
    ) -> None:
        parameters, start = reals("parameters", parameters or {}), reals("start", start or {})
        self._update(list(parameters.items()), list(start.items()))
        self._settings["parameters"].update(parameters)
        self._settings["start"].update(start)

    def observe(self, t: npt.ArrayLike, y: npt.ArrayLike) -> dict[str, Any]:
        """All columns of a motion at a state, or at each state of an array.

        Examples
        --------
        >>> system = Model.builtin("heavy-top-lagrange").system()
        >>> sorted(system.observe(0.0, system.y0))[:3]
        ['area', 'energy', 'norm']
        """
        return dict(zip(self._column_names, self._row(t, y)))

    def mass_matrix(self, t: float, y: npt.ArrayLike) -> Floats:
        """The mass matrix M = ∂²L/∂η∂η of the quasi-velocities at a state."""
        import numpy as np

        size, entries = self._mass_entries(float(t), np.asarray(y, dtype=float).tolist())
        return np.array(entries).reshape(size, size)

    def inverse_dynamics(self, t: float, y: npt.ArrayLike, accelerations: npt.ArrayLike) -> Floats:
        """The generalised forces that have to be added to those of the model for these accelerations of the quasi-velocities.

        M η̇ + h - Q, for bodies on joints from body to body (recursive Newton-Euler).

        Examples
        --------
        >>> from chetaev import Model
        >>> system = Model.builtin("furuta-pendulum").system()
        >>> rates = system(0.0, system.y0)
        >>> forces = system.inverse_dynamics(0.0, system.y0, rates[2:])
        >>> bool(abs(forces).max() < 1e-12)
        True
        """
        import numpy as np

        given = np.asarray(accelerations, dtype=float).tolist()
        return np.array(self._inverse_dynamics(float(t), np.asarray(y, dtype=float).tolist(), given, False))

    def bias(self, t: float, y: npt.ArrayLike) -> Floats:
        """The forces that the motion at a state requires for vanishing accelerations: h - Q of M η̇ + h = Q."""
        import numpy as np

        return np.array(self._inverse_dynamics(float(t), np.asarray(y, dtype=float).tolist(), None, False))

    def gravity_compensation(self, t: float, y: npt.ArrayLike) -> Floats:
        """The forces that hold the system at rest where it is, against weight, springs and constant forces."""
        import numpy as np

        return np.array(self._inverse_dynamics(float(t), np.asarray(y, dtype=float).tolist(), None, True))

    def coriolis(self, t: float, y: npt.ArrayLike) -> Floats:
        """The Coriolis matrix C at a state: C η are the terms of M η̇ + h = Q that are quadratic in η.

        Its coefficients are Christoffel's symbols of M, with those of the brackets, so that the rate of M less 2C is skew-symmetric
        where neither M nor the frame depends on time.

        Examples
        --------
        >>> from chetaev import Model
        >>> system = Model.builtin("heavy-top-lagrange").system()
        >>> y = system.y0
        >>> c = system.coriolis(0.0, y)
        >>> bool(abs(c + c.T).max() < 1e-15)  # M is constant
        True
        """
        import numpy as np

        size, entries = self._coriolis_entries(float(t), np.asarray(y, dtype=float).tolist())
        return np.array(entries).reshape((size, size), order="F")

    def centroidal(self, t: float, y: npt.ArrayLike) -> VelocityMap:
        """The momentum of all bodies, and their angular momentum about their common mass centre, along fixed axes.

        Its ``matrix``, 6 × k, is the centroidal momentum matrix.
        """
        import numpy as np

        return VelocityMap._of_columns(*self._centroidal(float(t), np.asarray(y, dtype=float).tolist()))

    def centre_of_mass(self, t: float, y: npt.ArrayLike) -> Floats:
        """The common mass centre of all bodies, along fixed axes."""
        import numpy as np

        return np.array(self._centre_of_mass(float(t), np.asarray(y, dtype=float).tolist())[0])

    def centre_of_mass_jacobian(self, t: float, y: npt.ArrayLike) -> VelocityMap:
        """The velocity of the common mass centre of all bodies, along fixed axes; its ``matrix`` is 3 × k."""
        import numpy as np

        found = self._centre_of_mass(float(t), np.asarray(y, dtype=float).tolist())
        return VelocityMap._of_columns(*found[1])

    def body_jacobian(
        self, t: float, y: npt.ArrayLike, body: str, at: Sequence[float] = (0.0, 0.0, 0.0)
    ) -> VelocityMap:
        """The velocity of a point of a body and the angular velocity of the body, along fixed axes; the ``matrix`` is 6 × k.

        Parameters
        ----------
        t : float
            The time.
        y : array
            The state.
        body : str
            The name of a body, or of a point in ``[points]``.
        at : sequence of 3 floats, optional
            The position of the point from there, along the axes of the body.

        Examples
        --------
        >>> from chetaev import Model
        >>> system = Model.builtin("puma-560").system()
        >>> jacobian = system.body_jacobian(0.0, system.y0, "hand", at=(0.0, 0.0, 0.1))
        >>> jacobian.matrix.shape
        (6, 6)
        """
        import numpy as np

        point = [float(component) for component in at]
        found = self._body_jacobian(float(t), np.asarray(y, dtype=float).tolist(), body, point)
        return VelocityMap._of_columns(*found)

    def reactions(self, t: npt.ArrayLike, y: npt.ArrayLike) -> dict[str, Any]:
        """The reaction of each constraint, by its name.

        The reactions add to the force Q_s the sum, over the constraints, of the reaction times the derivative of the constraint with
        respect to η_s.
        """
        if not self._model.constraints:
            return {}
        system = self
        if not self._settings.get("reactions"):
            if self._companion is None:
                settings = {**self.settings(), "reactions": True}
                self._companion = System(self._model, self._form, **settings)
            system = self._companion
            wanted = (self._settings["parameters"], self._settings["start"])
            if (system._settings["parameters"], system._settings["start"]) != wanted:
                system._set(parameters=wanted[0], start=wanted[1])
        columns = system.observe(t, y)
        return {name: columns[f"λ_{name}"] for name in self._model.constraints if f"λ_{name}" in columns}

    def bracket(self, f: object, g: object) -> Bracket:
        """The Poisson bracket (f, g) (12) of two expressions of the model.

        The momenta are y_s = ∂L/∂η_s. Under nonholonomic constraints the bracket is the almost-Poisson bracket of the independent
        momenta.

        Examples
        --------
        >>> system = Model.builtin("heavy-top-lagrange").system()
        >>> bracket = system.bracket("γ1", "I2*ω2")  # the momentum of ω2
        >>> bracket(0.0, system.y0) == -system.start["γ3"]
        True
        """
        return Bracket(self, str(f), str(g))

    def _watched(self, events: Mapping[str, object]) -> System:
        """The system with events in addition to those of the text."""
        text = self._model.text.rstrip("\n") + "\n\n"
        for name, event in events.items():
            text += (event if isinstance(event, Event) else Event(event)).text(name) + "\n"
        return System(self._model._rewritten(text), self._form, **self.settings())

    def _driven(self, inputs: Mapping[str, Any]) -> dict[str, Any]:
        """The settings with other inputs: values set since the system was made are included, except those of these inputs."""
        settings = self.settings()
        settings["inputs"] = {**settings["inputs"], **inputs}
        for name in inputs:
            settings["parameters"].pop(name, None)
        return settings

    def _wished(
        self,
        *,
        t_end: float | None = None,
        samples: int | None = None,
        times: npt.ArrayLike | None = None,
        method: str | None = None,
        rtol: float | None = None,
        atol: float | Mapping[str, float] | None = None,
        max_step: float | None = None,
        samples_per_step: int | None = None,
        accumulation: float | None = None,
        sensitivities: str | Sequence[str] = (),
        limit_time: float | None = None,
    ) -> dict[str, Any]:
        """The options of an integration, in the form that the native part takes; None stands for the value in the text, or else for the
        default."""
        import numpy as np

        if times is not None and (t_end is not None or samples is not None):
            raise ValueError("give either times, or t_end and samples")
        if times is not None and np.size(times) == 0:
            raise ValueError("there are no times")
        if samples is not None and whole("samples", samples) < 2:
            raise ValueError("a motion has at least 2 samples, its start and its end")
        if method is not None and not isinstance(method, str):
            raise TypeError(f"method is a name, not {method!r}")
        numbers = {"t_end": t_end, "rtol": rtol, "max_step": max_step, "accumulation": accumulation, "limit_time": limit_time}
        return {
            **{name: None if given is None else real(name, given) for name, given in numbers.items()},
            "samples": samples,
            "times": None if times is None else np.atleast_1d(np.asarray(times, dtype=float)).tolist(),
            "method": method,
            "atol": reals("atol", atol) if isinstance(atol, Mapping) else None if atol is None else real("atol", atol),
            "samples_per_step": None if samples_per_step is None else whole("samples_per_step", samples_per_step),
            "sensitivities": listed("sensitivities", sensitivities),
        }

    def run(
        self,
        t_end: float | None = None,
        *,
        samples: int | None = None,
        times: npt.ArrayLike | None = None,
        y0: npt.ArrayLike | None = None,
        method: str | None = None,
        rtol: float | None = None,
        atol: float | Mapping[str, float] | None = None,
        max_step: float | None = None,
        inputs: Mapping[str, Any] | None = None,
        events: Mapping[str, object] | None = None,
        samples_per_step: int | None = None,
        accumulation: float | None = None,
        sensitivities: str | Sequence[str] = (),
        estimate: bool = False,
        limit_time: float | None = None,
        verify: bool | None = None,
    ) -> Motion:
        """Integrates the motion from the start.

        What is not given comes from the text, or else from the defaults of ``pc run``: the numbers equal those of ``pc run`` bit for
        bit. Ctrl-C ends the integration.

        Parameters
        ----------
        t_end : float, optional
            The time at which the motion ends.
        samples : int, optional
            Number of rows, evenly spaced in time, including start and end.
        times : array, optional
            The times of the rows, instead of a number of rows.
        y0 : array, optional
            The state at the start, n numbers in the order of ``names``, instead of that of the system; it has to satisfy the
            constraints.
        method : str, optional
            ``"auto"`` (the default), ``"adams"``, ``"bdf"``, ``"dop853"`` or ``"taylor"``.
        rtol : float, optional
            Relative tolerance for a step.
        atol : float or mapping, optional
            Absolute tolerance for a step: for all components of the state, or for some of them by name. By default it is the tolerance
            in the text, or else min(1e-12, rtol s) for a component of the scale s at the start, where rounding errors permit this.
        max_step : float, optional
            The maximum length of a step.
        inputs : mapping, optional
            The values of inputs for this run alone: numbers, or tables ``(times, values)``, as for :meth:`Model.system`. The equations
            are derived again if an input that had no table is given one.
        events : mapping, optional
            Events in addition to those of the text: names with expressions that vanish, or with an :class:`Event`. The model is
            derived once more.
        samples_per_step, accumulation : optional
            How events are searched for, as in ``[simulation]``.
        sensitivities : sequence of str
            Parameters with respect to which the motion is differentiated; the derivatives are further columns ``∂x/∂p``.
        estimate : bool
            Whether there are columns ``error(x)`` with the estimated global errors of the others: the distance from a second, more
            accurate motion.
        limit_time : float, optional
            Seconds after which the integration ends with an error.
        verify : bool, optional
            Whether the motion is compared with a second derivation at its start and its end; by default the first motion of a system is
            compared, but no motion of a system made with ``verify=False``.

        Returns
        -------
        Motion

        Raises
        ------
        IntegrationError
            If the integration cannot continue, or if the motion has failed to conserve an integral that is proved to be conserved; its
            ``motion`` is the part that was computed.
        DisagreementError
            If the second derivation gives a different motion.

        Examples
        --------
        >>> system = Model.builtin("heavy-top-lagrange").system()
        >>> motion = system.run(5.0, samples=11)
        >>> motion["ω3"].shape
        (11,)
        """
        if events:
            return self._watched(events).run(
                t_end,
                samples=samples,
                times=times,
                y0=y0,
                method=method,
                rtol=rtol,
                atol=atol,
                max_step=max_step,
                inputs=inputs,
                samples_per_step=samples_per_step,
                accumulation=accumulation,
                sensitivities=sensitivities,
                estimate=estimate,
                limit_time=limit_time,
                verify=verify,
            )
        wished = self._wished(
            t_end=t_end,
            samples=samples,
            times=times,
            method=method,
            rtol=rtol,
            atol=atol,
            max_step=max_step,
            samples_per_step=samples_per_step,
            accumulation=accumulation,
            sensitivities=sensitivities,
            limit_time=limit_time,
        )
        if y0 is not None and sensitivities:
            raise ValueError("sensitivities are those of the motion from the start of the system: set `start` instead of y0")
        import numpy as np

        state = None if y0 is None else np.asarray(y0, dtype=float).ravel().tolist()
        given = [(name, course(name, one)) for name, one in (inputs or {}).items()]
        outcome = self._integrate(wished, state, bool(estimate), None if verify is None else bool(verify), given)
        motion = Motion(self, self._driven(inputs or {}), wished, state, outcome)
        if outcome["error"] is not None:
            raise IntegrationError(outcome["error"], motion)
        return motion

    def stepper(self, **settings: Any) -> Stepper:
        """The motion from the start, step by step, under inputs that a controller chooses.

        A step takes some microseconds. Events of the text occur during steps, with their resets. The equations are those of the
        system, which have been compared with the second derivation; steps are not compared again.

        Parameters
        ----------
        **settings
            ``method``, ``rtol``, ``atol``, ``max_step``, ``samples_per_step``, ``accumulation``, ``limit_time`` as for :meth:`run`.

        Examples
        --------
        >>> system = Model.builtin("furuta-pendulum").system()
        >>> stepper = system.stepper(method="dop853")
        >>> for _ in range(100):
        ...     y = stepper.step(0.01, [0.1])
        >>> round(stepper.t, 9)
        1.0
        """
        only("System.stepper", settings, _STEPS)
        return self._stepping(self._wished(t_end=self.t0 + 1.0, **settings))

    def sweep(
        self,
        vary: Mapping[str, npt.ArrayLike] | None = None,
        random: Mapping[str, tuple[str, float, float]] | None = None,
        *,
        members: int | None = None,
        seed: int = 0,
        t_end: float | None = None,
        rows: int | None = None,
        threads: int | None = None,
        progress: bool = False,
        executor: Executor | None = None,
        block: int | None = None,
        **settings: Any,
    ) -> Sweep:
        """Integrates many motions, for varied parameters and start values, on all cores.

        The result does not depend on the number of threads. Ctrl-C ends the sweep.

        Parameters
        ----------
        vary : mapping, optional
            Names with the values that they take, in all combinations, the last name changing fastest.
        random : mapping, optional
            Names with distributions instead: ``("normal", mean, deviation)``, ``("uniform", from, to)`` or
            ``("lognormal", mean, deviation)`` of the logarithm; the numbers are those of ``pc sweep --random`` with the same seed.
        members : int, optional
            How many members are drawn.
        seed : int
            The seed of the random numbers.
        t_end : float, optional
            The time at which the motions end; by default the one in the text.
        rows : int, optional
            Number of rows of each motion, evenly spaced in time; by default only the last row is kept.
        threads : int, optional
            Number of threads; by default as many as there are cores.
        progress : bool
            Whether to show progress, with tqdm where it is installed.
        executor : concurrent.futures.Executor, optional
            What computes blocks of members instead of the threads of this process: a ``ProcessPoolExecutor``, dask's
            ``client.get_executor()``, mpi4py's ``MPIPoolExecutor``, or any other. The result is the same to the last bit; blocks that
            are lost with their worker are done again.
        block : int, optional
            How many members are one task of the executor, rounded up to a multiple of 16; by default a 1024th of all, at most 8192.
        **settings
            ``method``, ``rtol``, ``atol``, ``max_step``, ``samples_per_step``, ``accumulation``, ``limit_time`` as for :meth:`run`. The
            first member, one in the middle and the last are compared with a second derivation unless ``verify=False``.

        Examples
        --------
        >>> system = Model.builtin("heavy-top-lagrange").system()
        >>> sweep = system.sweep({"mg": [0.5, 1.0, 2.0]}, t_end=1.0)
        >>> sweep["ω3"].shape
        (3,)
        """
        only("System.sweep", settings, (*_STEPS, "verify"))
        return swept(self, vary, random, members, seed, t_end, rows, threads, progress, executor, block, settings)

    def trim(self, free: str | Sequence[str] | None = None) -> Trim:
        """A state of rest or steady motion, found by choosing some inputs and components of the state.

        Newton's method finds the free values, beginning at their present ones; everything else stays as it is, so that a velocity set
        at the start is that of the steady motion. All rates vanish except those of cyclic coordinates, on which nothing depends.

        Parameters
        ----------
        free : sequence of str, optional
            The inputs, coordinates, quasi-velocities and first-order states to be chosen; by default all inputs.

        Raises
        ------
        ChetaevError
            If no values are found, or if nothing determines some of them, which the message then names.

        Examples
        --------
        >>> drone = Model.builtin("quadrotor").system(start={"p": 0.0, "q": 0.0, "s": 0.0})
        >>> hover = drone.trim(["f1", "f2", "f3", "f4", "θ", "φ"])
        >>> round(hover.inputs["f1"], 6), round(hover.rates["z"], 6)
        (1.22625, 0.2)
        """
        chosen = self._model.inputs if free is None else listed("free", free)
        if not chosen:
            raise ValueError("name what is free: the model has no inputs")
        return Trim(*self._model_now().trimmed(list(chosen)))

    def lyapunov(
        self, count: int = 1, *, interval: float, intervals: int, transient: int = 0, **settings: Any
    ) -> Lyapunov:
        """The largest Lyapunov exponents of the motion from the start.

        Parameters
        ----------
        count : int
            The number of exponents.
        interval : float
            The time after which tangent vectors are made orthonormal again.
        intervals, transient : int
            The number of intervals that are counted, and the number that are skipped before them.
        **settings
            ``method``, ``rtol``, ``atol``, ``max_step``, … as for :meth:`run`.
        """
        import numpy as np

        only("System.lyapunov", settings, _STEPS)
        end = self.t0 + float(interval) * (intervals + transient)
        wished = self._wished(t_end=end, **settings)
        exponents, history = self._exponents(count, float(interval), (intervals, transient), wished)
        return Lyapunov(np.array(exponents), np.array(history).reshape(-1, count))

    def gradient(
        self,
        of: object | None = None,
        t_end: float | None = None,
        *,
        integral: object | None = None,
        by: str | Sequence[str] | None = None,
        **settings: Any,
    ) -> Gradient:
        """The derivatives of one function of the motion with respect to parameters and the start, by the adjoint equations.

        The motion is integrated forwards and backwards once, whatever the number of parameters; the ``sensitivities`` of :meth:`run`,
        which are derivatives of all columns, take one integration for each parameter. ``rtol`` determines their accuracy.

        Parameters
        ----------
        of : expression, optional
            The function at the end of the motion: an expression of the model, or the name of an output.
        t_end : float, optional
            The time at which the motion ends; by default the one in the text.
        integral : expression, optional
            A function of the state, whose integral over the motion is added.
        by : sequence of str, optional
            Parameters and inputs; by default all those that are numbers and on which no other parameter depends.
        **settings
            ``rtol``, ``atol``, ``max_step``, … as for :meth:`run`; ``method`` is ``"adams"`` or ``"bdf"``.

        Examples
        --------
        >>> system = Model.builtin("heavy-top-lagrange").system()
        >>> gradient = system.gradient("γ3", 2.0, rtol=1e-10)
        >>> motion = system.run(2.0, rtol=1e-10, sensitivities=["mg"])
        >>> bool(abs(gradient.by_parameters["mg"] - motion.sensitivity("γ3", "mg")[-1]) < 1e-7)
        True
        """
        only("System.gradient", settings, _STEPS)
        if of is None and integral is None:
            raise ValueError("name a function at the end of the motion, or one that is integrated")
        if settings.get("method") not in (None, "adams", "bdf"):
            raise ValueError(f"the method of a gradient is `adams` or `bdf`, not `{settings['method']}`")
        known = self._model_now().numbers() if by is None else listed("by", by)
        wished = self._wished(t_end=t_end, sensitivities=known, **settings)
        end, density = (None if term is None else str(term) for term in (of, integral))
        value, start, parameters = self._gradient(end, density, wished)
        return Gradient(value, dict(parameters), dict(start))

    def report(self, motion: Motion | None = None) -> Page:
        """A page with everything that is known about the model, and about a motion if one is given."""
        return Page(self._report_page(None if motion is None else motion._recorded()), height=800)


def _restored(model: ModelLike, form: str, settings: dict[str, Any], saved: bytes) -> System:
    return System(model, form, _saved=saved, **settings)
