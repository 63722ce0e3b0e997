"""What calls from Python cost: python benches/speed.py [LIBPC]

With the path of libpc, arrays are compared with its kernel, which is called once for all states. Variants are run one after
the other in turns; the minimum and the median of each are shown, and the ratio of the minima.
"""

import ctypes
import os
import signal
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import chetaev

STATES = 1_000_000
ROUNDS = 15


def clock(work: Callable[[], object]) -> float:
    """Of the processor: others may use it too."""
    began = time.process_time()
    work()
    return time.process_time() - began


def compare(variants: dict[str, Callable[[], object]], per: int, unit: str) -> None:
    times: dict[str, list[float]] = {name: [] for name in variants}
    for _ in range(ROUNDS):
        for name, work in variants.items():
            times[name].append(clock(work) / per)
    first = min(next(iter(times.values())))
    for name, found in times.items():
        best, middle = min(found), statistics.median(found)
        print(f"  {name:34} {best * 1e9:9.1f} {middle * 1e9:9.1f} ns {unit}   {best / first:5.2f}")


def kernel(path: str, states: np.ndarray) -> Callable[[np.ndarray], object]:
    """pc_kernel_rhs_many of libpc on the same model."""
    pc = ctypes.CDLL(path)
    model, system, made = ctypes.c_void_p(), ctypes.c_void_p(), ctypes.c_void_p()
    assert pc.pc_model_builtin(b"heavy-top-lagrange", ctypes.byref(model), None) == 0
    assert pc.pc_system_new(model, None, ctypes.byref(system), None) == 0
    assert pc.pc_kernel_new(system, ctypes.byref(made), None) == 0
    numbers = ctypes.POINTER(ctypes.c_double)
    call = pc.pc_kernel_rhs_many
    call.argtypes = [ctypes.c_double, numbers, ctypes.c_size_t, numbers, ctypes.c_void_p]
    given = states.ctypes.data_as(numbers)
    return lambda rates: call(0.0, given, len(states), rates.ctypes.data_as(numbers), made)


def seconds_after_ctrl_c(work: Callable[[], object]) -> float:
    """How long work goes on after Ctrl-C."""
    sent = []

    def send() -> None:
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.3, send)
    timer.start()
    try:
        work()
    except KeyboardInterrupt:
        return time.perf_counter() - sent[0]
    raise RuntimeError("the work has ended by itself")


def interruptions(system: chetaev.System, states: np.ndarray) -> None:
    """Ctrl-C in all that takes long."""
    works: dict[str, Callable[[], object]] = {
        "run": lambda: system.run(1e7, samples=2, rtol=1e-12),
        "sweep": lambda: system.sweep({"mg": np.linspace(0.5, 1.0, 100)}, t_end=1e6),
        "lyapunov": lambda: system.lyapunov(3, interval=1e5, intervals=100),
        "system(t, states)": lambda: [system(0.0, states) for _ in range(1000)],
        "system.jac(t, states)": lambda: [system.jac(0.0, states) for _ in range(1000)],
        "system.observe(t, states)": lambda: [system.observe(0.0, states) for _ in range(1000)],
    }
    for name, work in works.items():
        print(f"  {name:34} {max(seconds_after_ctrl_c(work) for _ in range(5)):9.3f} s, the worst of 5")


def main() -> None:
    code = "import time; a = time.perf_counter(); import chetaev; print(time.perf_counter() - a)"
    imports = [
        float(subprocess.run([sys.executable, "-c", code], capture_output=True, check=True).stdout) for _ in range(7)
    ]
    print(f"import chetaev: {min(imports):.3f} s")

    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    y = system.y0
    calls = range(20_000)
    print("one heavy top, from Python")
    compare(
        {
            "system(t, y)": lambda: [system(0.0, y) for _ in calls],
            "system.jac(t, y)": lambda: [system.jac(0.0, y) for _ in calls],
            "y.copy(), to compare with": lambda: [y.copy() for _ in calls],
        },
        len(calls),
        "a call",
    )

    rng = np.random.default_rng(1)
    rows = y + 0.1 * rng.normal(size=(STATES, y.size))
    across = np.ascontiguousarray(rows.T)
    print(f"{STATES} heavy tops in an array")
    variants: dict[str, Callable[[], object]] = {}
    if len(sys.argv) > 1:
        run, rates = kernel(sys.argv[1], rows), np.empty_like(rows)
        # The package makes a new array each time, whose pages the system has to give.
        variants["pc_kernel_rhs_many, new memory"] = lambda: run(np.empty_like(rows))
        variants["pc_kernel_rhs_many, the same memory"] = lambda: run(rates)
    variants["system(t, states), states in rows"] = lambda: system(0.0, rows.T)
    variants["system(t, states), across"] = lambda: system(0.0, across)
    compare(variants, STATES, "a state")
    if len(sys.argv) > 1:
        assert (system(0.0, rows.T) == rates.T).all()

    print("the same on threads")
    for threads in (1, 2, 4, 8):
        pieces = np.array_split(rows, threads)
        with ThreadPoolExecutor(threads) as pool:
            work = lambda: list(pool.map(lambda piece: system(0.0, piece.T), pieces))  # noqa: E731
            times = []
            for _ in range(5):
                began = time.perf_counter()
                work()
                times.append(time.perf_counter() - began)
            best = min(times)
        print(f"  {threads} {best / STATES * 1e9:9.1f} ns a state")

    print("work goes on after Ctrl-C for")
    interruptions(system, rows.T)


if __name__ == "__main__":
    main()
