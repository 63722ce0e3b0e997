"""The numbers of the program `pc`, bit by bit."""

import pathlib
from collections.abc import Callable
from typing import Any

import pytest
from conftest import KINDS

import chetaev


@pytest.mark.parametrize("name", KINDS)
def test_a_run_is_that_of_the_program(name: str, program: Callable[..., dict[str, Any]]) -> None:
    system = chetaev.Model.builtin(name).system()
    written = program("run", name, "--no-verify", "--rows", "21")
    motion = system.run(samples=21)
    assert tuple(written) == motion.columns
    for column, values in written.items():
        assert (motion[column] == values).all(), column


def test_set_parameters_are_those_of_the_program(program: Callable[..., dict[str, Any]]) -> None:
    written = program("run", "heavy-top-lagrange", "--no-verify", "--set", "mg=1.75", "--method", "bdf")
    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    system.parameters["mg"] = 1.75
    motion = system.run(method="bdf")
    assert all((motion[column] == values).all() for column, values in written.items())


@pytest.mark.parametrize("method", ["dop853", "auto", "adams"])
def test_a_sweep_is_that_of_the_program(
    method: str, program: Callable[..., dict[str, Any]], tmp_path: pathlib.Path
) -> None:
    members = 64 if method == "dop853" else 6
    arguments = ("--random", "mg=normal(1,0.1)", "--random", "ω3=uniform(2,3)", "--members", str(members), "--seed", "5")
    place = ("--method", method, "-o", str(tmp_path / "sweep.csv"))
    written = program("sweep", "heavy-top-lagrange", "--t-end", "2", *arguments, *place)
    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    laws = {"mg": ("normal", 1.0, 0.1), "ω3": ("uniform", 2.0, 3.0)}
    sweep = system.sweep(random=laws, members=members, seed=5, t_end=2.0, method=method)
    # The program has outputs on the way, which move neither the steps nor the end.
    assert all((sweep[name] == written[name]).all() for name in sweep)
    again = system.sweep(random=laws, members=members, seed=5, t_end=2.0, threads=1, method=method)
    assert all((again[name] == sweep[name]).all() for name in sweep)


def test_a_verified_motion_is_the_same() -> None:
    system = chetaev.Model.builtin("chaplygin-sleigh").system()
    first, again, without = system.run(2.0), system.run(2.0, verify=True), system.run(2.0, verify=False)
    for motion in (again, without):
        assert all((motion[name] == first[name]).all() for name in first)
