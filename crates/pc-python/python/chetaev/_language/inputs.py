"""Inputs as they are given to a system or a run."""

from __future__ import annotations

import numbers
from typing import Any


def course(
    name: str, given: Any
) -> float | tuple[list[float], list[float], str] | tuple[list[float], list[float], list[float], list[float] | None]:
    """What an input is set to, as the native part takes it: a number; times, values and the interpolation between them; or
    times, values, rates, and accelerations or none of them."""
    import numpy as np

    if isinstance(given, (tuple, list)) and _is_curve(given):
        columns = [np.asarray(column, dtype=float) for column in given if column is not None]
        if any(column.ndim != 1 for column in columns):
            raise ValueError(f"the times, values and rates of the input `{name}` are lists of numbers")
        times, values, rates = (column.tolist() for column in columns[:3])
        return times, values, rates, columns[3].tolist() if len(columns) == 4 else None

    if isinstance(given, (tuple, list)) and len(given) in (2, 3):
        times, values = (np.asarray(column, dtype=float) for column in given[:2])
        if times.ndim != 1 or values.ndim != 1:
            raise ValueError(f"the times and the values of the input `{name}` are two lists of numbers")
        return times.tolist(), values.tolist(), str(given[2]) if len(given) == 3 else "linear"
    if isinstance(given, np.ndarray) and given.ndim == 0:
        return float(given)
    if isinstance(given, numbers.Real):
        return float(given)
    raise ValueError(
        f"the input `{name}` is given a number, or a table as (times, values), or with rates as (times, values, rates)"
    )


def _is_curve(given: Any) -> bool:
    """Whether a table has rates: a third or a fourth column."""
    return len(given) == 4 or (len(given) == 3 and not isinstance(given[2], str))
