"""The notebooks run from top to bottom, with their asserts, and arrive at the numbers that they are stored with."""

import ast
import re
from pathlib import Path

import pytest

nbclient = pytest.importorskip("nbclient", reason="nbclient is not installed")
import nbformat  # noqa: E402, with nbclient

NOTEBOOKS = sorted((Path(__file__).parents[3] / "examples" / "notebooks").glob("*.ipynb"))


def code_cells(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def result(notebook):
    """The list of numbers that the last cell answers."""
    return ast.literal_eval(code_cells(notebook)[-1].outputs[0].data["text/plain"])


def pictures(cell):
    return sum("image/png" in output.get("data", {}) for output in cell.outputs)


def test_there_are_some():
    assert len(NOTEBOOKS) >= 3


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_runs_to_the_stored_numbers(path, tmp_path, monkeypatch):
    stored, again = nbformat.read(path, 4), nbformat.read(path, 4)
    monkeypatch.setenv("STATES", "20000")  # of the million
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path))
    nbclient.NotebookClient(
        again, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}
    ).execute()
    assert result(again) == pytest.approx(result(stored), rel=1e-4)
    assert len(result(stored)) >= 2 and any("assert " in cell.source for cell in code_cells(stored))
    for before, now in zip(code_cells(stored), code_cells(again), strict=True):
        assert pictures(before) == pictures(now), before.source


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_is_stored_clean(path):
    stored = nbformat.read(path, 4)
    nbformat.validate(stored)
    assert path.stat().st_size < 300_000
    assert [cell.execution_count for cell in code_cells(stored)] == list(range(1, 1 + len(code_cells(stored))))
    assert all(not cell.metadata for cell in stored.cells), "times of the run, or marks of an editor"
    for output in (output for cell in code_cells(stored) for output in cell.outputs):
        assert output.output_type in ("stream", "display_data", "execute_result")
        text = output.text if output.output_type == "stream" else output.data.get("text/plain", "")
        assert not re.search(r"(?<!\w)/\w+/|[A-Z]:\\|\bseconds\b| at 0x", text), f"of this machine: {text}"
