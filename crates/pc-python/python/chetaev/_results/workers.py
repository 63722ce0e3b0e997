"""The members of a sweep in blocks, by the workers of an executor."""

from __future__ import annotations

import pickle
import warnings
from collections.abc import Callable
from concurrent.futures import Executor, Future
from typing import TYPE_CHECKING, Any

from chetaev._language.errors import ChetaevError

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from chetaev import _native
    from chetaev._protocols import SystemLike

    Floats = npt.NDArray[np.float64]

# Members are integrated so many at a time: blocks of multiples have the same members side by side as one process has.
LANES = 16

# So many blocks keep some hundred workers busy to the end, where none is given.
BLOCKS = 1024
MOST_MEMBERS = 8192

# The system that a worker had last: it is derived once for all blocks.
_known: tuple[bytes, SystemLike] | None = None


def block_size(members: int, wished: int | None) -> int:
    """The number of members in a block."""
    if wished is None:
        wished = min(MOST_MEMBERS, -(-members // BLOCKS))
    return -(-wished // LANES) * LANES


def work(system: bytes, names: list[str], values: Floats, wished: dict[str, Any], all_rows: bool) -> _native._Swept:
    """The motions of a block, in a worker."""
    global _known
    known = _known  # threads of one process may have other systems at the same time
    if known is None or known[0] != system:
        known = _known = (system, pickle.loads(system))
    return known[1]._ensemble(names, values.ravel().tolist(), wished, all_rows, 1, False, None)


def by_workers(
    executor: Executor,
    system: SystemLike,
    names: list[str],
    values: Floats,
    wished: dict[str, Any],
    all_rows: bool,
    size: int,
    called: Callable[[int], Any] | None,
) -> _native._Swept:
    """The motions of all members, in their order. A block that is lost with its worker is done again: by the executor while it takes
    work, and here if it does not."""
    import numpy as np

    bytes_of_system = pickle.dumps(system)
    blocks = [values[place : place + size] for place in range(0, len(values), size)]
    lost: list[Exception] = []

    def submitted(block: Floats) -> Future[_native._Swept] | None:
        """A future, or none from an executor that takes no work any more."""
        try:
            return executor.submit(work, bytes_of_system, names, block, wished, all_rows)
        except RuntimeError as error:
            lost.append(error)
            return None

    def done_by(future: Future[_native._Swept] | None) -> _native._Swept | None:
        """The motions of a block, or none if they are lost."""
        try:
            return future.result() if future is not None else None
        except ChetaevError:
            raise
        except Exception as error:
            lost.append(error)
            return None

    futures: list[Future[_native._Swept] | None] = []
    try:
        for block in blocks:
            futures.append(submitted(block))
        results, done = [], 0
        for place, block in enumerate(blocks):
            result = done_by(futures[place]) or done_by(submitted(block))
            results.append(result or work(bytes_of_system, names, block, wished, all_rows))
            futures[place] = None
            done += len(block)
            if called is not None:
                called(done)
    except BaseException:
        for future in futures:
            if future is not None:
                future.cancel()
        raise
    if lost:
        warnings.warn(f"blocks of members were lost and done again: {lost[0]!r}", RuntimeWarning, stacklevel=4)
    return {
        "status": [status for result in results for status in result["status"]],
        "message": [message for result in results for message in result["message"]],
        "steps": [steps for result in results for steps in result["steps"]],
        "values": np.concatenate([result["values"] for result in results]),
    }

