"""The notebooks: run, and stored with what they show.

``python tests/notebooks.py`` in an environment with the package and ``tests/requirements.txt`` runs all of them and stores their outputs.
"""

from __future__ import annotations

import base64
import io
import pathlib
from typing import Any

PLACE = pathlib.Path(__file__).parents[1] / "notebooks"
NOTEBOOKS = sorted(PLACE.glob("*.ipynb"))

#: Colours of a picture that is stored.
COLOURS = 128


def executed(path: pathlib.Path) -> Any:
    """A notebook that has just run, in a kernel of its own."""
    import nbclient
    import nbformat

    notebook = nbformat.read(path, as_version=4)
    metadata = notebook.metadata
    # Whether prints that follow each other arrive as one message or two is a matter of the machine's load.
    client = nbclient.NotebookClient(
        notebook,
        timeout=3000,
        startup_timeout=600,
        kernel_name="python3",
        record_timing=False,
        coalesce_streams=True,
    )
    client.execute()
    notebook.metadata = metadata
    return notebook


def outputs(notebook: Any) -> list[Any]:
    """What the cells show."""
    return [output for cell in notebook.cells for output in cell.get("outputs", [])]


def smaller(picture: str) -> str:
    """A picture in few colours."""
    from PIL import Image

    drawn = Image.open(io.BytesIO(base64.b64decode(picture))).convert("RGB")
    written = io.BytesIO()
    drawn.quantize(COLOURS, dither=Image.Dither.NONE).save(written, "PNG", optimize=True)
    return base64.b64encode(written.getvalue()).decode()


def main() -> None:
    import nbformat

    for path in NOTEBOOKS:
        notebook = executed(path)
        for output in outputs(notebook):
            if "image/png" in output.get("data", {}):
                output.data["image/png"] = smaller(output.data["image/png"])
        nbformat.write(notebook, path)
        print(f"{path.name}: {path.stat().st_size} bytes")


if __name__ == "__main__":
    main()
