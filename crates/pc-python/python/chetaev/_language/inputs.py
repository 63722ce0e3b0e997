"""Inputs as they are given to a system or a run."""

from __future__ import annotations

import numbers
from typing import Any


def course(name: str, given: Any) -> float | tuple[list[float], list[float], str]:
    """What an input is set to, as the native part takes it: a number, or times, values and the interpolation between them."""
    import numpy as np

    if isinstance(given, (tuple, list)) and len(given) in (2, 3):
        times, values = (np.asarray(column, dtype=float) for column in given[:2])
        if times.ndim != 1 or values.ndim != 1:
            raise ValueError(f"the times and the values of the input `{name}` are two lists of numbers")
        return times.tolist(), values.tolist(), str(given[2]) if len(given) == 3 else "linear"
    if isinstance(given, np.ndarray) and given.ndim == 0:
        return float(given)
    if isinstance(given, numbers.Real):
        return float(given)
    raise ValueError(f"the input `{name}` is given a number, or a table as (times, values)")
