"""Arguments: names, numbers, and settings that a call does not take."""

from __future__ import annotations

import operator
from collections.abc import Collection, Iterable, Mapping
from typing import Any


def listed(argument: str, given: str | Iterable[str]) -> list[str]:
    """The names that an argument lists; a single text is one name."""
    names = [given] if isinstance(given, str) else list(given)
    for name in names:
        if not isinstance(name, str):
            raise TypeError(f"{argument} lists names, and {name!r} is none")
    return names


def real(argument: str, given: Any) -> float:
    """The number that an argument is."""
    if not isinstance(given, str):
        try:
            return float(given)
        except (TypeError, ValueError):
            pass
    raise TypeError(f"{argument} is a number, not {given!r}")


def whole(argument: str, given: Any) -> int:
    """The whole number that an argument is."""
    try:
        return operator.index(given)
    except TypeError:
        raise TypeError(f"{argument} is a whole number, not {given!r}") from None


def reals(argument: str, given: Mapping[str, Any]) -> dict[str, float]:
    """The numbers of names."""
    if not isinstance(given, Mapping):
        raise TypeError(f"{argument} is a mapping of names to numbers, not {given!r}")
    return {name: real(f"{argument}[{name!r}]", value) for name, value in given.items()}


def only(call: str, settings: Collection[str], known: Collection[str]) -> None:
    """Raises an error that names the call if it is given a setting that it does not take."""
    for name in settings:
        if name == "sensitivities":
            raise TypeError(f"{call}() takes no sensitivities: they are columns of a motion of System.run()")
        if name not in known:
            raise TypeError(f"{call}() takes no {name!r}; it takes {', '.join(known)}")
