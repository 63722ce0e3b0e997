"""Values of a system as mappings."""

from __future__ import annotations

from collections.abc import Iterator, MutableMapping
from typing import TYPE_CHECKING, Any, Literal

from chetaev._language.errors import UnknownNameError

if TYPE_CHECKING:
    from chetaev._protocols import SystemLike


class Values(MutableMapping[str, float]):
    """Parameters or start values of a system, which can be read and set.

    :meth:`update` sets several at once: all of them, or none if they contradict each other.
    """

    __slots__ = ("_kind", "_system")

    def __init__(self, system: SystemLike, kind: Literal["parameters", "start"]) -> None:
        self._system = system
        self._kind = kind

    def _now(self) -> dict[str, float]:
        model = self._system._model_now()
        return dict(model.parameters() if self._kind == "parameters" else model.start())

    def __getitem__(self, name: str) -> float:
        values = self._now()
        if name not in values:
            raise UnknownNameError(f"there is no `{name}`; there are {', '.join(values)}")
        return values[name]

    def __setitem__(self, name: str, value: float) -> None:
        self._system._set(**{self._kind: {name: value}})

    def __delitem__(self, name: str) -> None:
        raise TypeError("values of a system can be set, not deleted")

    def update(self, *others: Any, **named: float) -> None:
        """Sets several values at once."""
        values: dict[str, float] = dict(*others, **named)
        self._system._set(**{self._kind: values})

    def __iter__(self) -> Iterator[str]:
        return iter(self._now())

    def __len__(self) -> int:
        return len(self._now())

    def __repr__(self) -> str:
        return repr(self._now())
