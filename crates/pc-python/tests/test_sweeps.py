"""Sweeps: shapes, members that fail, progress."""

import numpy as np
import pytest

import chetaev

ROD = """
[parameters]
l = 1.0
g = 9.81
[coordinates]
x = 0.0
y = -1.0
[constraints]
rod = "x^2 + y^2 - l^2"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "g*y"
[simulation]
t_end = 1.0
"""


def test_all_combinations_in_order() -> None:
    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    # By dop853 sixteen members go side by side, with other last digits than one alone.
    sweep = system.sweep({"mg": [0.5, 1.0], "ω3": [2.0, 3.0, 4.0]}, t_end=1.0, rows=5, method="adams")
    assert list(sweep["mg"]) == [0.5] * 3 + [1.0] * 3
    assert list(sweep["ω3(start)"]) == [2.0, 3.0, 4.0] * 2
    assert sweep["γ3"].shape == (6, 5) and (sweep["ω3"][:, 0] == sweep["ω3(start)"]).all()
    assert sweep.members == 6 and (sweep.steps > 0).all()
    for k in range(6):
        system.parameters["mg"], system.start["ω3"] = sweep["mg"][k], sweep["ω3(start)"][k]
        assert (system.run(1.0, samples=5, method="adams")["γ3"] == sweep["γ3"][k]).all()


def test_members_that_are_refused_say_why() -> None:
    sweep = chetaev.Model.from_text(ROD).system().sweep({"l": [1.0, 2.0]})
    assert sweep.status == ["completed", "refused"]
    assert sweep.message[0] == "" and "rod" in sweep.message[1]
    assert np.isnan(sweep["y"][1]) and sweep["y"][0] == pytest.approx(-1.0, abs=1e-9)


def test_frames_and_progress(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("tqdm")
    pytest.importorskip("pandas")
    sweep = chetaev.Model.from_text(ROD).system().sweep({"g": np.linspace(1.0, 10.0, 4)}, rows=3, progress=True)
    assert "4/4" in capsys.readouterr().err
    frame = sweep.to_pandas()
    assert frame.shape[0] == 12 and list(frame["member"][:4]) == [0, 0, 0, 1]
    assert list(frame.columns[:3]) == ["member", "status", "g"]


def test_wrong_sweeps_are_refused() -> None:
    system = chetaev.Model.from_text(ROD).system()
    for arguments, message in (
        ({}, "not both"),
        ({"vary": {"g": [1.0]}, "random": {"g": ("normal", 1, 1)}}, "not both"),
        ({"vary": {"g": [1.0]}, "members": 3}, "drawn"),
        ({"random": {"g": ("normal", 1, 1)}}, "how many"),
    ):
        with pytest.raises(chetaev.ChetaevError, match=message):
            system.sweep(**arguments)
    for nothing in ({"vary": {"g": []}}, {"random": {"g": ("normal", 1, 1)}, "members": 0}):
        with pytest.raises(chetaev.ChetaevError, match="no members"):
            system.sweep(**nothing)
    with pytest.raises(ValueError, match="choose one of normal"):
        system.sweep(random={"g": ("cauchy", 0, 1)}, members=2)
    with pytest.raises(ValueError, match="not a valid distribution"):
        system.sweep(random={"g": ("uniform", 2, 1)}, members=2)


def test_a_sweep_that_runs_out_of_time_says_so() -> None:
    system = chetaev.Model.builtin("heavy-top-lagrange").system()
    with pytest.raises(chetaev.IntegrationError, match="of 3 members"):
        system.sweep({"mg": [1.0, 2.0, 3.0]}, t_end=1e6, limit_time=0.05, verify=False)
