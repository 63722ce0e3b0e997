"""From expressions of models to expressions of SymPy, and back."""

from __future__ import annotations

import re
from typing import Any

from chetaev._language.errors import ChetaevError

#: Functions of SymPy that models have too, with their names in models.
_FUNCTIONS = {
    "sin": "sin",
    "cos": "cos",
    "tan": "tan",
    "cot": "cot",
    "asin": "asin",
    "acos": "acos",
    "atan": "atan",
    "atan2": "atan2",
    "sinh": "sinh",
    "cosh": "cosh",
    "tanh": "tanh",
    "exp": "exp",
    "log": "log",
    "Abs": "abs",
    "sign": "sign",
    "Min": "min",
    "Max": "max",
}

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
    r"|(?P<name>[A-Za-z_α-ωΑ-Ω][A-Za-z0-9_α-ωΑ-Ω]*'?)"
    r"|(?P<sign>[-+*/^(),]))"
)

_NAME = re.compile(r"[A-Za-z_α-ωΑ-Ω][A-Za-z0-9_α-ωΑ-Ω]*'?\Z")


def text_of(value: Any) -> str:
    """An expression of SymPy in the language of models.

    ``x(t)`` becomes ``x``, and its derivative with respect to ``t`` becomes ``x'``, as ``sympy.physics.mechanics``
    writes coordinates. What has no equivalent in that language is refused.
    """
    import sympy

    return _text(sympy.sympify(value))


def _refused(value: Any, why: str) -> ChetaevError:
    return ChetaevError(f"`{value}` of SymPy cannot stand in a model: {why}")


def _name(value: Any, name: str) -> str:
    if not _NAME.match(name):
        raise _refused(value, f"`{name}` is not a name of a model")
    return name


def _coordinate(value: Any) -> str:
    """The name of x in x(t)."""
    if len(value.args) != 1 or not value.args[0].is_Symbol or value.args[0].name != "t":
        raise _refused(value, "only functions of `t` are coordinates")
    return _name(value, value.func.__name__)


def _text(value: Any) -> str:
    import sympy
    from sympy.core.function import AppliedUndef

    if value.is_Symbol:
        return _name(value, value.name)
    if value is sympy.pi:
        return "pi"
    if value is sympy.E:
        return "exp(1)"
    if value.is_Integer:
        return str(value) if value >= 0 else f"({value})"
    if value.is_Rational:
        return f"({value.p}/{value.q})"
    if value.is_Float:
        number = float(value)
        if sympy.Float(number, precision=value._prec) != value:
            raise _refused(value, "it has more digits than a number of a model")
        return f"({number!r})"
    if value.is_Number or value.is_NumberSymbol or value is sympy.I:
        raise _refused(value, "models have finite real numbers and pi")
    if value.is_Add:
        return "(" + " + ".join(_text(term) for term in value.args) + ")"
    if value.is_Mul:
        return "(" + "*".join(_text(factor) for factor in value.args) + ")"
    if value.is_Pow:
        base, exponent = value.args
        if exponent == sympy.Rational(1, 2):
            return f"sqrt({_text(base)})"
        if base is sympy.E:
            return f"exp({_text(exponent)})"
        return f"({_text(base)}^{_text(exponent)})"
    if isinstance(value, sympy.Derivative):
        inner, *by = value.args
        if isinstance(inner, AppliedUndef) and len(by) == 1 and by[0][0].name == "t" and by[0][1] == 1:
            return _coordinate(inner) + "'"
        raise _refused(value, "only the first derivative of a coordinate by `t` is a velocity")
    if isinstance(value, AppliedUndef):
        return _coordinate(value)
    if isinstance(value, sympy.Piecewise):
        return _step(value)
    name = _FUNCTIONS.get(type(value).__name__)
    if name is None:
        raise _refused(value, f"there is no function `{type(value).__name__}` in models")
    arguments = [_text(argument) for argument in value.args]
    if name in ("min", "max"):
        nested = arguments[0]
        for argument in arguments[1:]:
            nested = f"{name}({nested}, {argument})"
        return nested
    return f"{name}({', '.join(arguments)})"


def _step(value: Any) -> str:
    """The text step(x, a, b) for a choice that depends on whether x ≥ 0 or x < 0."""
    import sympy

    (first, condition), *others = value.args
    if len(others) == 1 and others[0][1] == sympy.true and isinstance(condition, (sympy.Ge, sympy.Lt)):
        at_least = isinstance(condition, sympy.Ge)
        difference = _text(condition.lhs - condition.rhs)
        a, b = (first, others[0][0]) if at_least else (others[0][0], first)
        return f"step({difference}, {_text(a)}, {_text(b)})"
    raise _refused(value, "only a choice between two by `x >= 0` or `x < 0` is a step")


class Reader:
    """Expressions of models as expressions of SymPy.

    Names are real symbols, velocities are called ``x'`` and accelerations ``x''``.
    """

    def __init__(self) -> None:
        self._known: dict[str, Any] = {}

    def define(self, name: str, text: str) -> None:
        """Makes a name stand for an expression from now on."""
        self._known[name] = self.read(text)

    def symbol(self, name: str) -> Any:
        """The symbol with this name."""
        import sympy

        return self._known.setdefault(name, sympy.Symbol(name, real=True))

    def read(self, text: str) -> Any:
        """The expression of a text."""
        tokens = []
        place = 0
        while text[place:].strip():
            found = _TOKEN.match(text, place)
            if found is None:
                raise ChetaevError(f"`{text[place:]}` cannot be read as an expression")
            tokens.append((str(found.lastgroup), found.group(str(found.lastgroup))))
            place = found.end()
        tokens.append(("end", ""))
        self._tokens = tokens[::-1]
        value = self._sum()
        self._take("")
        return value

    def _next(self) -> str:
        return self._tokens[-1][1]

    def _take(self, expected: str | None = None) -> tuple[str, str]:
        kind, text = self._tokens.pop()
        if expected is not None and text != expected:
            raise ChetaevError(f"`{expected or 'the end'}` was expected in an expression, not `{text}`")
        return kind, text

    def _sum(self) -> Any:
        value = self._product()
        while self._next() in ("+", "-"):
            _, sign = self._take()
            term = self._product()
            value = value + term if sign == "+" else value - term
        return value

    def _product(self) -> Any:
        value = self._signed()
        while self._next() in ("*", "/"):
            _, sign = self._take()
            factor = self._signed()
            value = value * factor if sign == "*" else value / factor
        return value

    def _signed(self) -> Any:
        if self._next() in ("+", "-"):
            _, sign = self._take()
            value = self._signed()
            return -value if sign == "-" else value
        return self._power()

    def _power(self) -> Any:
        base = self._atom()
        if self._next() != "^":
            return base
        self._take("^")
        return base ** self._signed()

    def _atom(self) -> Any:
        import sympy

        kind, text = self._take()
        if kind == "number":
            return sympy.Integer(text) if text.isdigit() else sympy.Float(text)
        if text == "(":
            value = self._sum()
            self._take(")")
            return value
        if kind != "name":
            raise ChetaevError(f"an expression was expected, not `{text}`")
        if self._next() != "(":
            return sympy.pi if text == "pi" else self.symbol(text)
        self._take("(")
        arguments = [self._sum()]
        while self._next() == ",":
            self._take(",")
            arguments.append(self._sum())
        self._take(")")
        return self._call(text, arguments)

    def _call(self, name: str, arguments: list[Any]) -> Any:
        import sympy

        if name == "sqrt":
            return sympy.sqrt(arguments[0])
        if name == "d":
            # An acceleration is written as the derivative of a velocity.
            return self.symbol(f"{arguments[0]}'")
        if name == "step":
            x, a, b = arguments
            return sympy.Piecewise((a, x >= 0), (b, True))
        for ours, theirs in _FUNCTIONS.items():
            if theirs == name:
                return getattr(sympy, ours)(*arguments)
        raise ChetaevError(f"there is no function `{name}` in models")


def equations(data: dict[str, Any]) -> dict[str, Any]:
    """The derived equations, from the JSON for programs."""
    import sympy

    if "kinematics" not in data:
        raise ChetaevError("a large tree of bodies has its equations from body to body, not as expressions")
    reader = Reader()
    for definition in data.get("definitions", []):
        reader.define(definition["name"], definition["value"])

    def column(texts: list[str]) -> Any:
        return sympy.Matrix(len(texts), 1, [reader.read(text) for text in texts])

    found: dict[str, Any] = {
        "coordinates": [reader.symbol(name) for name in data["coordinates"]],
        "quasi_velocities": [reader.symbol(name) for name in data["quasi_velocities"]],
        "parameters": [reader.symbol(name) for name in data["parameters"]],
    }
    if "momenta" not in data:
        b = data["kinematics"]["b"]
        eta = sympy.Matrix(found["quasi_velocities"])
        rows = sympy.Matrix(len(b), len(eta), lambda i, j: reader.read(b[i][j]))
        found["velocities"] = rows * eta + column(data["kinematics"]["b_0"])
        if "mass_matrix" in data:
            mass = data["mass_matrix"]
            found["mass_matrix"] = sympy.Matrix(len(mass), len(mass), lambda i, j: reader.read(mass[i][j]))
            found["right_hand_side"] = column(data["equations"])
        found["energy"] = reader.read(data["energy"])
        for list_of in ("active_forces", "inertia_forces", "acceleration_terms", "vanishing"):
            if list_of in data:
                found[list_of] = column(data[list_of])
        if "gibbs_function" in data:
            found["gibbs_function"] = reader.read(data["gibbs_function"])
        if "lagrange_expressions" in data:
            named = data["lagrange_expressions"].items()
            found["lagrange_expressions"] = {reader.symbol(name): reader.read(text) for name, text in named}
    else:
        found["momenta"] = [reader.symbol(name) for name in data["momenta"]]
        found["velocities"] = column(data["velocities"])
        found["rates"] = column(data["equations"])
        found["hamiltonian"] = reader.read(data["hamiltonian"])
    return found
