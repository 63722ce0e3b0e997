"""The notebooks run from top to bottom, and what they assert holds."""

import pathlib

import pytest

PLACE = pathlib.Path(__file__).parents[1] / "notebooks"
NOTEBOOKS = sorted(PLACE.glob("*.ipynb"))


@pytest.mark.filterwarnings("ignore")  # those of the notebooks' machinery
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks(path: pathlib.Path) -> None:
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    notebook = nbformat.read(path, as_version=4)
    assert all(not cell.get("outputs") for cell in notebook.cells), "outputs are not kept in the repository"
    nbclient.NotebookClient(notebook, timeout=3000, startup_timeout=600, kernel_name="python3").execute()
    shown = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert shown and not any(output["output_type"] == "error" for output in shown)


def test_there_are_notebooks() -> None:
    assert len(NOTEBOOKS) == 6
