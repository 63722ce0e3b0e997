"""Names as arguments have them."""

from __future__ import annotations

from collections.abc import Sequence


def names(argument: str, given: str | Sequence[str]) -> list[str]:
    """The names that an argument lists; a text alone is one name."""
    listed = [given] if isinstance(given, str) else list(given)
    for name in listed:
        if not isinstance(name, str):
            raise TypeError(f"{argument} lists names; {name!r} is not a text")
    return listed
