"""A model put together call by call: it is written as a text, so that texts alone define its meaning."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Generic, TypeVar

from chetaev._language.arguments import listed, real, whole
from chetaev._language.errors import ChetaevError
from chetaev._language.joints import Joint
from chetaev._language.toml import entry, formula, number, quoted

M = TypeVar("M")

#: The sections, in the order of the text.
_SECTIONS = (
    "model",
    "parameters",
    "inputs",
    "definitions",
    "coordinates",
    "quasi_velocities",
    "states",
    "kinematics",
    "algebra",
    "algebra.brackets",
    "constraints",
    "lagrangian",
    "bodies",
    "points",
    "loops",
    "contacts",
    "gravity",
    "forces",
    "integrals",
    "outputs",
    "drawing",
    "events",
    "simulation",
)


class Builder(Generic[M]):
    """A model that is put together call by call.

    Expressions are texts in the language of models, numbers, expressions of this package, expressions of SymPy, or Python functions
    of names of the model. All methods return the builder, so that calls can be chained.

    Parameters
    ----------
    name : str
        The name of the model.
    model_of : callable
        Makes the model from a text and a name; :meth:`Model.builder` passes it.

    Examples
    --------
    >>> from chetaev import Model, cos
    >>> builder = Model.builder("pendulum")
    >>> builder = builder.parameter("g", 9.81).parameter("l", 2.0).coordinate("θ", 0.5)
    >>> builder = builder.lagrangian(
    ...     kinetic=lambda l, θ: l**2 * θ.velocity**2 / 2,
    ...     potential=lambda g, l, θ: -g * l * cos(θ),
    ... )
    >>> print(builder.text)
    [model]
    "name" = "pendulum"
    <BLANKLINE>
    [parameters]
    "g" = 9.81
    "l" = 2.0
    <BLANKLINE>
    [coordinates]
    "θ" = 0.5
    <BLANKLINE>
    [lagrangian]
    "kinetic" = "l^2*θ'^2/2"
    "potential" = "-g*l*cos(θ)"
    <BLANKLINE>
    >>> builder.build().system().names
    ('θ', "θ'")
    """

    def __init__(self, name: str, model_of: Callable[[str, str], M]) -> None:
        self._name = name
        self._model_of = model_of
        self._entries: dict[str, dict[tuple[str, ...], str]] = {section: {} for section in _SECTIONS}
        self._drawn: list[dict[str, str]] = []
        self._put("model", ("name",), quoted(name))

    def _put(self, section: str, keys: tuple[str, ...], value: str) -> Builder[M]:
        entries = self._entries[section]
        if keys in entries:
            raise ChetaevError(f"[{section}] {'.'.join(keys)} has been given already")
        entries[keys] = value
        return self

    def describe(self, *, description: str | None = None, reference: str | None = None) -> Builder[M]:
        """Says what the model is and where it comes from."""
        for key, value in (("description", description), ("reference", reference)):
            if value is not None:
                self._put("model", (key,), quoted(value))
        return self

    def parameter(self, name: str, value: Any) -> Builder[M]:
        """A parameter: a number, or an expression in parameters before it."""
        return self._put("parameters", (name,), formula(value))

    def input(
        self,
        name: str,
        value: float | None = None,
        *,
        times: Sequence[float] | None = None,
        values: Sequence[float] | None = None,
        rates: Sequence[float] | None = None,
        accelerations: Sequence[float] | None = None,
        interpolation: str | None = None,
    ) -> Builder[M]:
        """An input: a number that is constant until it is set, or a table of times and values. With rates, or with rates
        and accelerations, the table is a smooth function, which may also move positions and constraints."""
        if times is None and values is None:
            return self._put("inputs", (name,), number(0.0 if value is None else value))
        if value is not None or times is None or values is None:
            raise ChetaevError(f"the input `{name}` needs either a value, or times and values")
        columns = {"times": times, "values": values, "rates": rates, "accelerations": accelerations}
        for key, column in columns.items():
            if column is not None:
                listed = ", ".join(number(float(x)) for x in column)
                self._put("inputs", (name, key), f"[{listed}]")
        smooth = "cubic" if accelerations is None else "quintic"
        default = "linear" if rates is None else smooth
        return self._put("inputs", (name, "interpolation"), quoted(interpolation or default))

    def define(self, name: str, value: Any) -> Builder[M]:
        """A name for an expression, which later expressions can use."""
        return self._put("definitions", (name,), formula(value))

    def coordinate(self, name: str, start: Any = 0.0) -> Builder[M]:
        """A coordinate with its start value."""
        return self._put("coordinates", (name,), formula(start))

    def quasi_velocity(self, name: str, start: Any = 0.0, definition: Any = None) -> Builder[M]:
        """A quasi-velocity with its start value, and its definition in terms of velocities (2) if
        it has one."""
        if definition is None:
            return self._put("quasi_velocities", (name,), formula(start))
        self._put("quasi_velocities", (name, "is"), formula(definition))
        return self._put("quasi_velocities", (name, "start"), formula(start))

    def state(self, name: str, start: Any, rate: Any) -> Builder[M]:
        """A first-order state with its rate, such as that of a controller."""
        self._put("states", (name, "start"), formula(start))
        return self._put("states", (name, "rate"), formula(rate))

    def kinematics(self, coordinate: str, velocity: Any) -> Builder[M]:
        """The velocity of a coordinate in terms of quasi-velocities, ẋ = b η + b_0 (3)."""
        return self._put("kinematics", (coordinate,), formula(velocity))

    def algebra(self, name: str | None = None, brackets: Mapping[tuple[str, str], Any] | None = None) -> Builder[M]:
        """The brackets of the operators: either those of a named Lie algebra, or each bracket by itself."""
        if name is not None:
            self._put("algebra", ("name",), quoted(name))
        for (r, s), value in (brackets or {}).items():
            self._put("algebra.brackets", (f"{r},{s}",), formula(value))
        return self

    def constraint(self, name: str, value: Any, kind: str | None = None) -> Builder[M]:
        """A constraint: an expression that vanishes."""
        if kind is None:
            return self._put("constraints", (name,), formula(value))
        self._put("constraints", (name, "expr"), formula(value))
        return self._put("constraints", (name, "kind"), quoted(kind))

    def lagrangian(
        self, lagrangian: Any = None, *, kinetic: Any = None, potential: Any = None, dissipation: Any = None
    ) -> Builder[M]:
        """The Lagrangian, or the kinetic and potential energy; and Rayleigh's dissipation function."""
        given = {"lagrangian": lagrangian, "kinetic": kinetic, "potential": potential, "dissipation": dissipation}
        for key, value in given.items():
            if value is not None:
                self._put("lagrangian", (key,), formula(value))
        return self

    def _table(self, section: str, name: str, entries: Mapping[str, Any]) -> Builder[M]:
        for key, value in entries.items():
            if value is not None:
                self._put(section, (name, key), entry(key, value))
        return self

    def body(
        self,
        name: str,
        *,
        joint: Joint | Mapping[str, Any] | None = None,
        parent: str | None = None,
        **entries: Any,
    ) -> Builder[M]:
        """A rigid body: ``mass``, ``inertia``, ``position``, ``rotation``, … as in ``[bodies.NAME]`` of a text.

        Parameters
        ----------
        joint : Joint or mapping, optional
            How the body moves relative to the one to which it is attached, such as ``Revolute(axis=[0, 0, 1])``; a body without a joint
            has a ``position``.
        parent : str, optional
            The body to which it is attached; by default the world.
        **entries
            ``mass``, ``center``, ``inertia``, ``force``, ``torque``, …
        """
        return self._table("bodies", name, {"parent": parent, "joint": joint, **entries})

    def point(self, name: str, body: str, at: Sequence[Any] | None = None) -> Builder[M]:
        """A point of a body with a joint: ``NAME_x``, ``NAME_y``, ``NAME_z`` are its coordinates, for use in expressions."""
        return self._table("points", name, {"body": body, "at": at})

    def loop(
        self,
        name: str,
        kind: str,
        bodies: Sequence[str],
        at: Sequence[Sequence[Any]],
        *,
        axis: Sequence[Sequence[Any]] | None = None,
        length: Any = None,
    ) -> Builder[M]:
        """A joint between two bodies that are already attached: a ``"point"``, a ``"revolute"`` joint or a ``"rod"``."""
        entries = {"kind": kind, "bodies": listed("bodies", bodies), "at": at, "axis": axis, "length": length}
        return self._table("loops", name, entries)

    def contact(self, name: str, body: str, shape: str, motion: str, **entries: Any) -> Builder[M]:
        """A contact of a body with the ground: a ``"disc"``, a ``"sphere"`` or an ``"ellipsoid"`` that ``"rolls"`` or ``"slides"``.

        Parameters
        ----------
        **entries
            ``radius``, ``axis``, ``semi_axes``, ``at``, ``normal``, ``height``, … as in ``[contacts.NAME]`` of a text.
        """
        return self._table("contacts", name, {"body": body, "shape": shape, "motion": motion, **entries})

    def draw(self, kind: str, **entries: Any) -> Builder[M]:
        """A shape that follows the motion in animations: ``"line"``, ``"disc"``, ``"spring"``, … as in ``[[draw]]`` of a text."""
        # The name of a starting point, `from`, is a keyword of Python.
        entries = {key.rstrip("_"): value for key, value in entries.items()}
        self._drawn.append({key: entry(key, value) for key, value in {"kind": kind, **entries}.items()})
        return self

    def drawing(self, *, hide: bool | Sequence[str] | None = None, up: Sequence[float] | None = None) -> Builder[M]:
        """Bodies and points that animations do not draw by themselves, and the direction that is up, as in ``[drawing]`` of a text."""
        for key, value in (("hide", hide), ("up", up)):
            if value is not None:
                self._put("drawing", (key,), entry(key, value))
        return self

    def gravity(self, acceleration: Sequence[Any]) -> Builder[M]:
        """The acceleration of gravity, for all bodies."""
        text = "[" + ", ".join(formula(entry) for entry in acceleration) + "]"
        return self._put("gravity", ("acceleration",), text)

    def force(self, on: str, value: Any) -> Builder[M]:
        """A generalised force on a quasi-velocity or on a coordinate."""
        return self._put("forces", (on,), formula(value))

    def integral(self, name: str, value: Any) -> Builder[M]:
        """An expression that should stay constant and is monitored along each motion."""
        return self._put("integrals", (name,), formula(value))

    def output(self, name: str, value: Any) -> Builder[M]:
        """An output: one more column of each motion."""
        return self._put("outputs", (name,), formula(value))

    def event(
        self,
        name: str,
        when: Any,
        *,
        direction: str = "both",
        terminal: bool = False,
        reset: Mapping[str, Any] | None = None,
    ) -> Builder[M]:
        """An event: the zero of an expression, which may end the motion or reset the state."""
        self._put("events", (name, "when"), formula(when))
        self._put("events", (name, "direction"), quoted(direction))
        if terminal:
            self._put("events", (name, "terminal"), "true")
        for variable, value in (reset or {}).items():
            self._put("events", (name, "reset", variable), formula(value))
        return self

    def simulation(self, **settings: Any) -> Builder[M]:
        """Default settings of a run: ``t_end``, ``samples``, ``rtol``, ``atol`` (a number, or a mapping of names), ``method``, ``form``,
        ``hamel`` (a mapping of quasi-velocities to their definitions), ``project`` and ``independent`` (names), …
        """
        for key, value in settings.items():
            if key in ("project", "independent"):
                text = "[" + ", ".join(quoted(name) for name in listed(key, value)) + "]"
            elif isinstance(value, Mapping):
                entries = (f"{quoted(name)} = {(formula if key == 'hamel' else number)(one)}" for name, one in value.items())
                text = "{ " + ", ".join(entries) + " }"
            elif key in ("samples", "samples_per_step"):
                text = str(whole(key, value))
            elif isinstance(value, str):
                text = quoted(value)
            else:
                text = number(real(key, value))
            self._put("simulation", (key,), text)
        return self

    @property
    def text(self) -> str:
        """The model as text."""
        sections = []
        for section, entries in self._entries.items():
            if entries:
                lines = [f"{'.'.join(quoted(key) for key in keys)} = {value}" for keys, value in entries.items()]
                sections.append("\n".join([f"[{section}]", *lines]) + "\n")
        for shape in self._drawn:
            lines = [f"{quoted(key)} = {value}" for key, value in shape.items()]
            sections.append("\n".join(["[[draw]]", *lines]) + "\n")
        return "\n".join(sections)

    def build(self) -> M:
        """The model.

        Raises
        ------
        ModelError
            With the position in :attr:`text`.
        """
        return self._model_of(self.text, self._name)
