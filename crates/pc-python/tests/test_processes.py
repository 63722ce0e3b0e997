"""Pickles, processes, threads, signals and memory."""

import concurrent.futures
import gc
import multiprocessing
import os
import pickle
import signal
import sys
import threading
import time
from collections.abc import Callable

import numpy as np
import pytest
from conftest import regular_states

import chetaev


def test_all_can_be_pickled() -> None:
    model = chetaev.Model.builtin("heavy-top-lagrange")
    assert pickle.loads(pickle.dumps(model)) == model
    system = model.system("canonical", parameters={"mg": 1.5})
    system.start["ω3"] = 2.5
    again = pickle.loads(pickle.dumps(system))
    assert dict(again.parameters) == dict(system.parameters) and (again.y0 == system.y0).all()
    assert (again(0.0, again.y0) == system(0.0, system.y0)).all()
    assert again._saved_equations() == system._saved_equations()
    motion = system.run(1.0, samples=3)
    system.parameters["mg"] = 1.0
    copy = pickle.loads(pickle.dumps(motion))
    assert all((copy[name] == motion[name]).all() for name in motion)
    assert copy.system.parameters["mg"] == 1.5
    assert np.abs(copy.dense(copy.t) - motion.y).max() < 1e-8
    sweep = pickle.loads(pickle.dumps(system.sweep({"mg": [1.0, 2.0]}, t_end=0.5)))
    assert sweep.status == ["completed"] * 2
    equations = model.derive("canonical", parameters={"mg": 2.0})
    for printed in (equations, model.theory(degree=1), model.check(), motion.report()):
        again = pickle.loads(pickle.dumps(printed))
        assert type(again) is type(printed) and str(again) == str(printed)
    assert pickle.loads(pickle.dumps(equations)).latex() == equations.latex()
    bracket = pickle.loads(pickle.dumps(model.system().bracket("γ1", "ω2")))
    assert bracket(0.0, model.system().y0) == model.system().bracket("γ1", "ω2")(0.0, model.system().y0)


def test_equations_of_something_else_are_derived_again() -> None:
    top, ball = (chetaev.Model.builtin(name) for name in ("heavy-top-lagrange", "bouncing-ball"))
    system = top.system()
    for saved in (b"", b"something else", ball.system()._saved_equations(), top.system("canonical")._saved_equations()):
        again = chetaev.System(top, _saved=saved)
        assert again.names == system.names
        assert (again(0.0, again.y0) == system(0.0, system.y0)).all()


def last(system: chetaev.System) -> float:
    return float(system.run(1.0)["γ3"][-1])


@pytest.mark.parametrize("method", ["fork", "spawn"])
@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
def test_processes(method: str) -> None:
    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    expected = last(system)
    with multiprocessing.get_context(method).Pool(2) as pool:
        assert pool.map_async(last, [system] * 4).get(timeout=600) == [expected] * 4


def test_eight_threads_at_once() -> None:
    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    states = regular_states(system, 4000)
    expected = system(0.0, states)

    def work(seed: int) -> bool:
        good = True
        for k in np.random.default_rng(seed).integers(0, 4000, size=200):
            good &= bool((system(0.0, states[:, k]) == expected[:, k]).all())
            if k % 20 == 0:
                good &= bool((system(0.0, states) == expected).all())
        return good and bool(system.run(0.2)["γ3"][-1] == first)

    first = system.run(0.2)["γ3"][-1]
    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        assert all(pool.map(work, range(8)))


def test_other_threads_go_on_while_arrays_are_computed() -> None:
    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    states = regular_states(system, 100_000)
    gate, ran = threading.Lock(), threading.Event()

    def run_once() -> None:
        gate.acquire()
        ran.set()

    gate.acquire()
    thread = threading.Thread(target=run_once)
    thread.start()
    interval = sys.getswitchinterval()
    # From now on a thread lets others run only where it gives the interpreter's lock away by itself.
    sys.setswitchinterval(1e6)
    time.sleep(0.05)  # the thread comes to wait at the gate
    try:
        gate.release()
        assert not any(ran.is_set() for _ in range(100_000))
        assert any(ran.is_set() for _ in range(1000) if system(0.0, states) is not None)
    finally:
        sys.setswitchinterval(interval)
    thread.join()


def interrupted(work: Callable[[], object]) -> None:
    """Sends Ctrl-C to work that would take hours."""
    thread = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    with pytest.raises(KeyboardInterrupt):
        thread.start()
        work()
    thread.join()


def test_ctrl_c_ends_all_work() -> None:
    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    longest = {"t_end": 1e7, "rtol": 1e-12}
    states = regular_states(system, 500_000)
    interrupted(lambda: system.run(samples=2, **longest))
    interrupted(lambda: system.sweep({"mg": np.linspace(0.5, 1.0, 100)}, t_end=1e6))
    interrupted(lambda: system.lyapunov(3, interval=1e5, intervals=100))
    interrupted(lambda: [system.observe(0.0, states) for _ in range(1000)])
    assert system.run(1.0).ending == "completed"


def resident() -> int:
    """Bytes of memory of this process."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="no /proc here")
def test_models_leave_no_memory_behind() -> None:
    text = chetaev.Model.builtin("chaplygin-sleigh").text
    count = int(os.environ.get("CHETAEV_MODELS", "300"))

    def make(times: int) -> None:
        for k in range(times):
            system = chetaev.Model.from_text(text, name=f"sleigh-{k}").system()
            system(0.0, system.y0)
        gc.collect()

    make(count // 3)
    before = resident()
    make(count)
    grown = resident() - before
    # Allocators keep some; a model that stayed would take hundreds of kilobytes.
    assert grown < 8_000_000 + 1000 * count, grown
