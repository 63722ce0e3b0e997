"""The numbers of the program `pc`, bit by bit."""

import pathlib
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from conftest import KINDS

import chetaev


@pytest.mark.parametrize("name", KINDS)
def test_a_run_is_that_of_the_program(name: str, program: Callable[..., dict[str, Any]]) -> None:
    system = chetaev.Model.builtin(name).system()
    written = program("run", name, "--no-verify", "--samples", "21")
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


def test_a_sweep_is_that_of_the_program(program: Callable[..., dict[str, Any]], tmp_path: pathlib.Path) -> None:
    arguments = ("--random", "mg=normal(1,0.1)", "--random", "ω3=uniform(2,3)", "--samples", "6", "--seed", "5")
    written = program("sweep", "heavy-top-lagrange", "--t-end", "2", *arguments, "-o", str(tmp_path / "sweep.csv"))
    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    laws = {"mg": ("normal", 1.0, 0.1), "ω3": ("uniform", 2.0, 3.0)}
    sweep = system.sweep(random=laws, members=6, seed=5, t_end=2.0)
    assert (sweep["mg"] == written["mg"]).all()
    assert (sweep["ω3(start)"] == written["ω3(start)"]).all()
    # The program has outputs on the way, which do not move the steps.
    assert np.abs(sweep["γ3"] - written["γ3"]).max() < 1e-8
    again = system.sweep(random=laws, members=6, seed=5, t_end=2.0, threads=1)
    assert all((again[name] == sweep[name]).all() for name in sweep)
