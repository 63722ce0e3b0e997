"""Values of TOML: strings, numbers, expressions, lists and tables of them."""

from __future__ import annotations

import inspect
import math
import numbers
from collections.abc import Mapping
from typing import Any

from chetaev._language.errors import ChetaevError
from chetaev._language.expressions import Expression, expression
from chetaev._language.joints import Joint


def quoted(text: str) -> str:
    """A string of TOML on one line."""
    shown = []
    for c in text:
        if c in '"\\':
            shown.append("\\" + c)
        elif ord(c) < 32 or 127 <= ord(c) < 160:
            shown.append(f"\\u{ord(c):04X}")
        else:
            shown.append(c)
    return '"' + "".join(shown) + '"'


def number(value: float) -> str:
    """A number of TOML that reads back as the same finite value."""
    if not math.isfinite(value):
        raise ChetaevError(f"{value} is not a finite number")
    return repr(float(value))


def formula(value: Any) -> str:
    """An expression as a TOML value, made from a number, a string, an expression of this package or of SymPy, or a function of names.

    A function is called with expressions for the names of its parameters, which are names of the model.
    """
    # Numbers of SymPy are real numbers of Python too, but may have more digits.
    if hasattr(value, "free_symbols"):
        return quoted(str(expression(value)))
    if isinstance(value, numbers.Real) and not isinstance(value, (bool, numbers.Rational)):
        return number(float(value))
    if callable(value) and not isinstance(value, Expression):
        names = list(inspect.signature(value).parameters)
        value = value(*(Expression(name) for name in names))
    return quoted(str(expression(value)))


#: Entries whose texts are names rather than expressions.
_NAMES = frozenset(("kind", "body", "bodies", "parent", "coordinates", "quasi_velocities", "shape", "motion", "text", "hide"))


def entry(key: str, value: Any) -> str:
    """An entry of a body, a joint, a point, a loop, a contact or a drawing: names, expressions, and lists and tables of them."""
    if isinstance(value, Joint):
        value = value.entries()
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{quoted(name)} = {entry(name, one)}" for name, one in value.items()) + " }"
    if key == "turns":
        return "[" + ", ".join(f"[{quoted(axis)}, {formula(angle)}]" for axis, angle in value) + "]"
    if isinstance(value, (list, tuple)) or getattr(value, "ndim", 0) > 0:
        return "[" + ", ".join(entry(key, one) for one in value) + "]"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, numbers.Rational) and not isinstance(value, bool):
        return number(float(value)) if value == float(value) else formula(value)
    return quoted(str(value)) if key in _NAMES else formula(value)
