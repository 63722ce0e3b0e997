"""The notebooks run from top to bottom, what they assert holds, and what is stored is what they show."""

import pathlib
import re

import pytest
from notebooks import NOTEBOOKS, executed, outputs

#: Bytes that a notebook may have.
LARGEST = 150_000

#: Numbers with a fraction. Their last digits are those of a machine, and of the versions of other packages.
NUMBER = re.compile(r"-?\d+\.\d+(?:e[+-]?\d+)?")
RELATIVE, ABSOLUTE = 1e-3, 1e-6


def kinds(notebook: object) -> list[tuple[str, list[str]]]:
    return [(output["output_type"], sorted(output.get("data", {}))) for output in outputs(notebook)]


def shown_as_text(output: object) -> str:
    return output.get("text", output.get("data", {}).get("text/plain", ""))


def assert_same_text(before: str, now: str) -> None:
    """Compares words letter by letter, without the spaces that numbers of other lengths move, and numbers nearly."""
    words = [" ".join(NUMBER.sub("#", text).split()) for text in (before, now)]
    assert words[0] == words[1]
    numbers = [[float(number) for number in NUMBER.findall(text)] for text in (before, now)]
    assert numbers[0] == pytest.approx(numbers[1], rel=RELATIVE, abs=ABSOLUTE)


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
        assert before.get("data", {}).get("text/latex") == now.get("data", {}).get("text/latex")
        assert_same_text(shown_as_text(before), shown_as_text(now))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_what_is_stored_is_small_and_of_no_machine(path: pathlib.Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert len(text.encode()) < LARGEST
    assert not re.search(r"/(home|root|tmp|work|Users|usr|opt|private)/|[A-Z]:\\\\|0x[0-9a-f]{6}|ipykernel_|Warning", text)
    assert "perf_counter" not in text, "times are those of a machine"


def test_there_are_notebooks() -> None:
    assert len(NOTEBOOKS) == 6
