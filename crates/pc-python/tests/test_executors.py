"""Sweeps whose members are computed by the workers of an executor."""

import concurrent.futures
import os
import signal
import subprocess
import sys
import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import chetaev
from chetaev._results import workers

DRAWN: dict[str, Any] = {"random": {"mg": ("uniform", 0.5, 2.0)}, "members": 100, "seed": 7, "t_end": 1.0}


def system() -> chetaev.System:
    return chetaev.Model.builtin("heavy-top-lagrange").system()


def assert_same(one: chetaev.Sweep, other: chetaev.Sweep) -> None:
    assert list(one) == list(other) and one.status == other.status and one.message == other.message
    assert (one.steps == other.steps).all()
    for name in one:
        assert one[name].tobytes() == other[name].tobytes(), name


@pytest.mark.parametrize("settings", [{}, {"rows": 5}, {"method": "auto"}, {"method": "dop853"}])
def test_processes_give_the_same_bytes(settings: dict[str, Any]) -> None:
    expected = system().sweep(**DRAWN, **settings)
    with concurrent.futures.ProcessPoolExecutor(2) as pool:
        assert_same(system().sweep(**DRAWN, executor=pool, block=20, **settings), expected)
        assert_same(system().sweep(**DRAWN, executor=pool, **settings), expected)


def test_another_thread_may_have_another_system_meanwhile(monkeypatch: pytest.MonkeyPatch) -> None:
    own, other = (chetaev.Model.builtin("heavy-top-lagrange").system(parameters={"I3": i3}) for i3 in (0.6, 1.2))
    expected = own.sweep(**DRAWN)
    work = workers.work

    def interrupted(*arguments: Any) -> Any:
        def at_each_line(frame: Any, event: str, _: Any) -> Any:
            if event == "line":
                workers._known = (b"another", other)  # as by a thread that comes in between
            return at_each_line

        sys.settrace(lambda frame, event, _: at_each_line if frame.f_code is work.__code__ else None)
        try:
            return work(*arguments)
        finally:
            sys.settrace(None)

    monkeypatch.setattr(workers, "work", interrupted)
    monkeypatch.setattr(workers, "_known", None)
    assert_same(own.sweep(**DRAWN, executor=Sequential(lambda _: None), verify=False), expected)


class Sequential(concurrent.futures.Executor):
    """Does tasks at once; `fails` says what becomes of the task with a number."""

    def __init__(self, fails: Callable[[int], BaseException | None]) -> None:
        self.tasks = 0
        self.fails = fails

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> concurrent.futures.Future[Any]:
        future: concurrent.futures.Future[Any] = concurrent.futures.Future()
        error = self.fails(self.tasks)
        self.tasks += 1
        if error is None:
            future.set_result(fn(*args, **kwargs))
        else:
            future.set_exception(error)
        return future


def test_lost_blocks_are_done_again() -> None:
    expected = system().sweep(**DRAWN)
    once = Sequential(lambda task: OSError("a node went down") if task == 2 else None)
    with pytest.warns(RuntimeWarning, match="a node went down"):
        assert_same(system().sweep(**DRAWN, executor=once, block=16), expected)
    assert once.tasks == 7 + 1
    never = Sequential(lambda _: OSError("nobody is there"))
    with pytest.warns(RuntimeWarning, match="nobody is there"):
        assert_same(system().sweep(**DRAWN, executor=never), expected)


def killed_once(path: str) -> None:
    if not Path(path).exists():
        Path(path).touch()
        os.kill(os.getpid(), signal.SIGKILL)


def test_members_of_a_killed_worker_are_done_again(tmp_path: Path) -> None:
    expected = system().sweep(**DRAWN)
    pool = concurrent.futures.ProcessPoolExecutor(2)
    with pytest.warns(RuntimeWarning, match="done again"):
        pool.submit(killed_once, str(tmp_path / "killed"))
        assert_same(system().sweep(**DRAWN, executor=pool, block=16), expected)
    pool.shutdown()


def test_what_is_wrong_is_said_at_once() -> None:
    counted = Sequential(lambda _: None)
    with pytest.raises(chetaev.ChetaevError, match="`nothing`"):
        system().sweep({"nothing": [1.0]}, executor=counted)
    assert counted.tasks == 0
    with pytest.raises(chetaev.ChetaevError, match="give an executor"):
        system().sweep({"mg": [1.0]}, block=3)
    with pytest.raises(chetaev.ChetaevError, match="one thread"):
        system().sweep({"mg": [1.0]}, executor=counted, threads=2)
    with pytest.raises(ValueError, match="at least 1 member"):
        system().sweep({"mg": [1.0]}, executor=counted, block=0)


def test_progress_counts_members() -> None:
    pytest.importorskip("tqdm")
    sweep = system().sweep({"mg": np.linspace(0.5, 2.0, 40)}, t_end=0.1, executor=Sequential(lambda _: None), progress=True)
    assert sweep.members == 40


@pytest.mark.filterwarnings("ignore")
def test_dask_gives_the_same_bytes() -> None:
    distributed = pytest.importorskip("distributed", reason="dask.distributed is not installed")
    expected = system().sweep(**DRAWN)
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        assert_same(system().sweep(**DRAWN, executor=client.get_executor(), block=16), expected)
        killed = system().sweep(**DRAWN, executor=Killing(client), block=16)
        assert_same(killed, expected)


class Killing(concurrent.futures.Executor):
    """Dask's executor, a worker of which is killed as soon as there is work."""

    def __init__(self, client: Any) -> None:
        self.client, self.executor, self.is_first = client, client.get_executor(), True

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Any:
        future = self.executor.submit(fn, *args, **kwargs)
        if self.is_first:
            self.is_first = False
            process = next(iter(self.client.cluster.workers.values())).process.process
            os.kill(process.pid, signal.SIGKILL)
        return future


def test_mpi_gives_the_same_bytes(tmp_path: Path) -> None:
    pytest.importorskip("mpi4py", reason="mpi4py is not installed")
    script = tmp_path / "sweep.py"
    script.write_text(
        textwrap.dedent("""
            import chetaev
            from mpi4py.futures import MPIPoolExecutor

            if __name__ == "__main__":
                system = chetaev.Model.builtin("heavy-top-lagrange").system()
                values = {"mg": [0.5 + 0.01 * k for k in range(100)]}
                expected = system.sweep(values, t_end=1.0)
                with MPIPoolExecutor() as executor:
                    found = system.sweep(values, t_end=1.0, executor=executor, block=16)
                assert all(found[name].tobytes() == expected[name].tobytes() for name in expected)
                print("the same")
        """)
    )
    beside = Path(sys.executable).parent / "mpiexec"
    mpiexec = str(beside) if beside.exists() else "mpiexec"
    command = [mpiexec, "--allow-run-as-root", "--oversubscribe", "-n", "3", sys.executable, "-m"]

    def ended(arguments: list[str]) -> subprocess.CompletedProcess[str]:
        return subprocess.run([*command, *arguments], capture_output=True, text=True, timeout=300)

    try:
        greeting = ended(["mpi4py.bench", "helloworld"])
    except FileNotFoundError:
        pytest.skip("there is no mpiexec")
    if greeting.returncode != 0:
        pytest.skip(f"mpiexec starts no processes here: {greeting.stderr[:200]}")
    found = ended(["mpi4py.futures", str(script)])
    assert found.returncode == 0 and found.stdout.strip().endswith("the same"), found.stderr
