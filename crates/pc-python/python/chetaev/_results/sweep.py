"""Many motions of one model."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from chetaev import _native
from chetaev._language.arguments import whole
from chetaev._language.errors import ChetaevError, UnknownNameError
from chetaev._results.workers import block_size, by_workers

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import numpy as np
    import numpy.typing as npt

    from chetaev._protocols import SystemLike

    Floats = npt.NDArray[np.float64]


class Sweep(Mapping[str, "Floats"]):
    """The members of a sweep: arrays by name, one entry, or one row, for each member.

    The name of a varied parameter gives the array of its values; for a varied start value, ``(start)`` is appended to the name. A sweep is
    made by :meth:`System.sweep`.

    Attributes
    ----------
    status : list of str
        ``"completed"``, ``"event"``, ``"failed"``, ``"refused"`` or ``"panicked"``.
    message : list of str
        The event that ended each motion, or why there is no motion.
    steps : array
        The number of steps of each motion.
    """

    def __init__(self, varied: dict[str, Floats], columns: tuple[str, ...], swept: _native._Swept) -> None:
        import numpy as np

        self._varied = varied
        self._columns = ("t", *columns)
        self._values = swept["values"]
        self.status: list[str] = swept["status"]
        self.message: list[str] = swept["message"]
        self.steps: npt.NDArray[np.int64] = np.array(swept["steps"], dtype=np.int64)

    def __getitem__(self, name: str) -> Floats:
        if name in self._varied:
            return self._varied[name]
        if name not in self._columns:
            raise UnknownNameError(f"there is no column `{name}`; there are {', '.join(self)}")
        column: Floats = self._values[:, :, self._columns.index(name)]
        return column[:, 0] if column.shape[1] == 1 else column

    def __iter__(self) -> Iterator[str]:
        yield from self._varied
        yield from self._columns

    def __len__(self) -> int:
        return len(self._varied) + len(self._columns)

    @property
    def members(self) -> int:
        """The number of members."""
        return len(self.status)

    def to_pandas(self) -> Any:
        """A data frame: a row for each member, or for each row of each member."""
        import numpy as np
        import pandas as pd

        rows = self._values.shape[1]
        member = np.repeat(np.arange(self.members), rows)
        frame = {"member": member, "status": np.repeat(np.array(self.status, dtype=object), rows)}
        frame.update({name: np.repeat(values, rows) for name, values in self._varied.items()})
        flat = self._values.reshape(-1, len(self._columns))
        frame.update({name: flat[:, j] for j, name in enumerate(self._columns)})
        return pd.DataFrame(frame)

    def __repr__(self) -> str:
        completed = sum(status == "completed" for status in self.status)
        return f"<Sweep of {self.members} members over {', '.join(self._varied)}: {completed} completed>"


def swept(
    system: SystemLike,
    vary: Mapping[str, npt.ArrayLike] | None,
    random: Mapping[str, tuple[str, float, float]] | None,
    members: int | None,
    seed: int,
    t_end: float | None,
    rows: int | None,
    threads: int | None,
    progress: bool,
    executor: Executor | None,
    block: int | None,
    settings: dict[str, Any],
) -> Sweep:
    """Carries out :meth:`System.sweep`."""
    import numpy as np

    if executor is None and block is not None:
        raise ChetaevError("a block is what one task of an executor computes: give an executor")
    if executor is not None and threads is not None:
        raise ChetaevError("each worker of an executor has one thread; threads are those of this process")
    if block is not None and whole("block", block) < 1:
        raise ValueError("a block has at least 1 member")

    if rows is not None and whole("rows", rows) < 2:
        raise ValueError("rows are at least 2, the start and the end; without them there is the end of each motion")
    if bool(vary) == bool(random):
        raise ChetaevError("give values to vary, or distributions to draw from, and not both")
    if vary:
        if members is not None:
            raise ChetaevError("`members` is the number of what is drawn; what is varied takes all combinations")
        names = tuple(vary)
        grids = np.meshgrid(*(np.asarray(values, dtype=float).ravel() for values in vary.values()), indexing="ij")
        values = np.stack([grid.ravel() for grid in grids], axis=1)
    else:
        assert random is not None
        if members is None:
            raise ChetaevError("say how many members are to be drawn")
        names = tuple(random)
        laws = [(law, float(first), float(second)) for law, first, second in random.values()]
        values = _native.draw(laws, seed, members)
    if len(values) == 0:
        raise ChetaevError("there are no members: give at least one value of each name")
    verify = settings.pop("verify", None)
    wished = system._wished(t_end=t_end, samples=rows or 2, **settings)
    called, bar = None, None
    if progress:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            raise ChetaevError("progress is shown by tqdm, which is not installed") from None
        bar = tqdm(total=len(values), unit="member")
        called = lambda done: bar.update(done - bar.n)  # noqa: E731
    try:
        all_rows = rows is not None

        def here(of: Floats, verify: bool | None, called: Callable[[int], Any] | None) -> _native._Swept:
            return system._ensemble(list(names), of.ravel().tolist(), wished, all_rows, threads, verify, called)

        if executor is None:
            found = here(values, verify, called)
        else:
            if verify is not False:
                here(values[[0, len(values) // 2, -1]], verify, None)
            size = block_size(len(values), block)
            found = by_workers(executor, system, list(names), values, wished, all_rows, size, called)
    finally:
        if bar is not None:
            bar.close()
    parameters = set(system.parameters)
    varied = {name if name in parameters else f"{name}(start)": values[:, j] for j, name in enumerate(names)}
    return Sweep(varied, system.columns, found)
