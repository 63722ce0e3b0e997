"""What results know about the models, systems and motions from which they come."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from chetaev import _native

    Floats = npt.NDArray[np.float64]


class ModelLike(Protocol):
    """A :class:`Model`."""

    @property
    def name(self) -> str: ...

    @property
    def text(self) -> str: ...

    @property
    def title(self) -> str: ...

    @property
    def inputs(self) -> tuple[str, ...]: ...

    @property
    def constraints(self) -> tuple[str, ...]: ...

    def system(self, form: str | None = None, **settings: Any) -> Any: ...

    def _changed(self, call: str, settings: Mapping[str, Any]) -> _native.ModelCore: ...

    def _rewritten(self, text: str) -> ModelLike: ...


class SystemLike(Protocol):
    """A :class:`System`."""

    @property
    def model(self) -> ModelLike: ...

    @property
    def form(self) -> str: ...

    @property
    def columns(self) -> tuple[str, ...]: ...

    @property
    def parameters(self) -> Mapping[str, float]: ...

    def settings(self) -> dict[str, Any]: ...

    def _start_state(self) -> list[float]: ...

    def _model_now(self) -> _native.ModelCore: ...

    def _poisson_bracket(self, f: str, g: str) -> _native.Function: ...

    def _ensemble(
        self,
        names: Sequence[str],
        values: Sequence[float],
        wished: dict[str, Any],
        all_rows: bool,
        threads: int | None,
        verify: bool | None,
        progress: Any,
    ) -> _native._Swept: ...

    @property
    def _wished(self) -> Callable[..., dict[str, Any]]: ...

    def _set(
        self, *, parameters: Mapping[str, float] | None = None, start: Mapping[str, float] | None = None
    ) -> None: ...


class MotionLike(Protocol):
    """A :class:`Motion`."""

    t: Floats
    y: Floats
    columns: tuple[str, ...]

    def __getitem__(self, name: str) -> Floats: ...

    def __iter__(self) -> Iterator[str]: ...
