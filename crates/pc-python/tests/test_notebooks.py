"""The notebooks run from top to bottom, what they assert holds, and what is stored is what they show."""

import pathlib
import re

import pytest
from notebooks import NOTEBOOKS, executed, outputs

#: Bytes that a notebook may have.
LARGEST = 300_000


def kinds(notebook: object) -> list[tuple[str, list[str]]]:
    return [(output["output_type"], sorted(output.get("data", {}))) for output in outputs(notebook)]


@pytest.mark.filterwarnings("ignore")  # those of the notebooks' machinery
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks(path: pathlib.Path) -> None:
    nbformat = pytest.importorskip("nbformat")
    pytest.importorskip("nbclient")
    stored, run = nbformat.read(path, as_version=4), executed(path)
    shown = outputs(run)
    assert shown and not any(output["output_type"] == "error" for output in shown)
    assert kinds(run) == kinds(stored), "run `python tests/notebooks.py`, which stores what the notebooks show"
    for before, now in zip(outputs(stored), shown):
        # Numbers of times, and last digits, are those of a machine.
        assert before.get("data", {}).get("text/latex") == now.get("data", {}).get("text/latex")


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_what_is_stored_is_small_and_of_no_machine(path: pathlib.Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert len(text.encode()) < LARGEST
    assert not re.search(r"/(home|root|tmp|work|Users|usr|opt|private)/|[A-Z]:\\\\|0x[0-9a-f]{6}|ipykernel_|Warning", text)


def test_there_are_notebooks() -> None:
    assert len(NOTEBOOKS) == 6
