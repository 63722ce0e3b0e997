"""What tests of the package share."""

from __future__ import annotations

import csv
import faulthandler
import io
import os
import pathlib
import subprocess
from collections.abc import Callable, Iterator

import numpy as np
import numpy.typing as npt
import pytest

import chetaev

#: Models of different kinds: redundant coordinates, constraints with and without multipliers, momenta, events.
KINDS = [
    "heavy-top-lagrange",
    "heavy-top-quaternion",
    "chaplygin-sleigh",
    "double-pendulum-cartesian",
    "relativistic-particle",
    "bouncing-ball",
    "snakeboard-driven",
]


def regular_states(system: chetaev.System, count: int, size: float = 1e-3) -> npt.NDArray[np.float64]:
    """States near the start."""
    noise = np.random.default_rng(7).normal(size=(len(system.names), count))
    return system.y0[:, None] + size * noise


@pytest.fixture(scope="session")
def terminal(request: pytest.FixtureRequest) -> Iterator[int]:
    """A descriptor of standard error as it is where nothing is captured."""
    with request.config.pluginmanager.getplugin("capturemanager").global_and_fixture_disabled():
        descriptor = os.dup(2)
    yield descriptor
    os.close(descriptor)


@pytest.fixture(autouse=True)
def patience(terminal: int) -> Iterator[None]:
    """Ends everything with a look at all threads where a test hangs, in whatever it hangs."""
    faulthandler.dump_traceback_later(1800, exit=True, file=terminal)
    yield
    faulthandler.cancel_dump_traceback_later()


@pytest.fixture
def program() -> Callable[..., dict[str, npt.NDArray[np.float64]]]:
    """Runs the program `pc`, and gives the columns that it writes."""
    path = os.environ.get("PC_PROGRAM")
    if path is None:
        pytest.skip("PC_PROGRAM does not say where the program is")

    def run(*arguments: str) -> dict[str, npt.NDArray[np.float64]]:
        done = subprocess.run([path, *arguments], capture_output=True, text=True, check=True, timeout=600)
        written = done.stdout
        if "-o" in arguments:
            written = pathlib.Path(arguments[arguments.index("-o") + 1]).read_text(encoding="utf-8")
        header, *rows = csv.reader(io.StringIO(written))
        columns = zip(*rows)

        def numbers(column: tuple[str, ...]) -> npt.NDArray[np.float64]:
            try:
                return np.array([float(entry) for entry in column])
            except ValueError:
                return np.full(len(column), np.nan)

        return {name: numbers(column) for name, column in zip(header, columns)}

    return run
