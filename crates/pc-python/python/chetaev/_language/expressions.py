"""Expressions of models, written with the operators and functions of Python.

>>> from chetaev import cos, symbols
>>> m, g, l, θ = symbols("m g l θ")
>>> str(m * g * l * (1 - cos(θ)) + θ.velocity**2 / 2)
"m*g*l*(1 - cos(θ)) + θ'^2/2"
"""

from __future__ import annotations

import math
import numbers
import re
from typing import Any, Union

from chetaev._language.errors import ChetaevError

#: How tightly an expression binds: a sum, a product, a sign, a power, a name.
_SUM, _PRODUCT, _SIGN, _POWER, _ATOM = range(5)

_NAME = re.compile(r"[A-Za-z_α-ωΑ-Ω][A-Za-z0-9_α-ωΑ-Ω]*'?\Z")


class Expression:
    """An expression of a model: its text, put together by the operators of Python.

    Parameters
    ----------
    text : str
        Any expression in the language of models.
    """

    __slots__ = ("_level", "_text")

    def __init__(self, text: str) -> None:
        self._text = text
        self._level = _ATOM if _NAME.match(text) else _SUM

    @classmethod
    def _of(cls, text: str, level: int) -> Expression:
        expression = cls(text)
        expression._level = level
        return expression

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return f"Expression({self._text!r})"

    def __bool__(self) -> bool:
        raise TypeError("an expression is neither true nor false; use step(x, a, b) to choose")

    __hash__ = None  # type: ignore[assignment]  # what is equal is an expression too

    def __eq__(self, other: object) -> bool:
        raise TypeError("expressions cannot be compared; compare their texts with str()")

    @property
    def velocity(self) -> Expression:
        """The velocity of a coordinate, ``x'``."""
        if self._level != _ATOM or not _NAME.match(self._text) or self._text.endswith("'"):
            raise ChetaevError(f"`{self._text}` is not a coordinate: only coordinates have velocities")
        return Expression._of(self._text + "'", _ATOM)

    def _at(self, level: int) -> str:
        return self._text if self._level >= level else f"({self._text})"

    def __add__(self, other: Operand) -> Expression:
        return Expression._of(f"{self._text} + {expression(other)._at(_PRODUCT)}", _SUM)

    def __radd__(self, other: Operand) -> Expression:
        return expression(other) + self

    def __sub__(self, other: Operand) -> Expression:
        return Expression._of(f"{self._text} - {expression(other)._at(_PRODUCT)}", _SUM)

    def __rsub__(self, other: Operand) -> Expression:
        return expression(other) - self

    def __mul__(self, other: Operand) -> Expression:
        return Expression._of(f"{self._at(_PRODUCT)}*{expression(other)._at(_POWER)}", _PRODUCT)

    def __rmul__(self, other: Operand) -> Expression:
        return expression(other) * self

    def __truediv__(self, other: Operand) -> Expression:
        return Expression._of(f"{self._at(_PRODUCT)}/{expression(other)._at(_POWER)}", _PRODUCT)

    def __rtruediv__(self, other: Operand) -> Expression:
        return expression(other) / self

    def __pow__(self, other: Operand) -> Expression:
        return Expression._of(f"{self._at(_ATOM)}^{expression(other)._at(_ATOM)}", _POWER)

    def __rpow__(self, other: Operand) -> Expression:
        return expression(other) ** self

    def __neg__(self) -> Expression:
        return Expression._of(f"-{self._at(_POWER)}", _SIGN)

    def __pos__(self) -> Expression:
        return self

    def __abs__(self) -> Expression:
        return abs_(self)


Operand = Union[Expression, str, float, int]


def expression(value: object) -> Expression:
    """Converts a number, a text or an expression of SymPy to an expression."""
    if isinstance(value, Expression):
        return value
    if isinstance(value, str):
        return Expression(value)
    if hasattr(value, "free_symbols"):
        from chetaev._language.sympy import text_of

        return Expression(text_of(value))
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        return _number(value)
    raise TypeError(f"{value!r} is no expression: use numbers, texts, expressions of chetaev or of SymPy")


def _number(value: Any) -> Expression:
    if isinstance(value, numbers.Rational) and value.denominator != 1:
        return _number(value.numerator) / _number(value.denominator)
    number = float(value)
    if not math.isfinite(number):
        raise ChetaevError(f"{value} is not a finite number")
    if isinstance(value, numbers.Integral):
        text = str(int(value))
    else:
        text = repr(number)
    return Expression._of(text, _SIGN if text.startswith("-") else _ATOM)


def symbols(names: str) -> tuple[Expression, ...]:
    """Names of a model as expressions.

    Parameters
    ----------
    names : str
        Names, separated by spaces or commas.

    Examples
    --------
    >>> x, k = symbols("x k")
    >>> k * x**2 / 2
    Expression('k*x^2/2')
    """
    found = tuple(names.replace(",", " ").split())
    for name in found:
        if not _NAME.match(name):
            raise ChetaevError(f"`{name}` is not a name: it begins with a letter, Latin or Greek, or `_`")
    return tuple(Expression(name) for name in found)


def _call(name: str, *arguments: Operand) -> Expression:
    return Expression._of(f"{name}({', '.join(str(expression(a)) for a in arguments)})", _ATOM)


def sin(x: Operand) -> Expression:
    """The sine."""
    return _call("sin", x)


def cos(x: Operand) -> Expression:
    """The cosine."""
    return _call("cos", x)


def tan(x: Operand) -> Expression:
    """The tangent."""
    return _call("tan", x)


def cot(x: Operand) -> Expression:
    """The cotangent."""
    return _call("cot", x)


def asin(x: Operand) -> Expression:
    """The inverse of the sine."""
    return _call("asin", x)


def acos(x: Operand) -> Expression:
    """The inverse of the cosine."""
    return _call("acos", x)


def atan(x: Operand) -> Expression:
    """The inverse of the tangent."""
    return _call("atan", x)


def atan2(y: Operand, x: Operand) -> Expression:
    """The angle of the point (x, y)."""
    return _call("atan2", y, x)


def sinh(x: Operand) -> Expression:
    """The hyperbolic sine."""
    return _call("sinh", x)


def cosh(x: Operand) -> Expression:
    """The hyperbolic cosine."""
    return _call("cosh", x)


def tanh(x: Operand) -> Expression:
    """The hyperbolic tangent."""
    return _call("tanh", x)


def exp(x: Operand) -> Expression:
    """The exponential."""
    return _call("exp", x)


def log(x: Operand) -> Expression:
    """The natural logarithm."""
    return _call("log", x)


def sqrt(x: Operand) -> Expression:
    """The square root."""
    return _call("sqrt", x)


def abs_(x: Operand) -> Expression:
    """The absolute value; ``abs(x)`` is the same."""
    return _call("abs", x)


def sign(x: Operand) -> Expression:
    """The sign: -1, 0 or 1."""
    return _call("sign", x)


def minimum(a: Operand, b: Operand) -> Expression:
    """The smaller of two expressions."""
    return _call("min", a, b)


def maximum(a: Operand, b: Operand) -> Expression:
    """The larger of two expressions."""
    return _call("max", a, b)


def step(x: Operand, a: Operand, b: Operand) -> Expression:
    """``a`` where x ≥ 0, else ``b``."""
    return _call("step", x, a, b)


def d(x: Operand) -> Expression:
    """The total derivative with respect to time along the motion."""
    return _call("d", x)


#: The constant π.
pi = Expression("pi")

#: Time.
t = Expression("t")
