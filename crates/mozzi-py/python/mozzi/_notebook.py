"""Pages in a notebook: a complete HTML page in a frame of its own, without network access."""

import html
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._mozzi import Model
    from ._results import Trajectory

__all__ = ["Page", "of_motion"]


class Page:
    """An HTML page, which a notebook shows in a frame; ``save`` writes it to a file.

    Parameters
    ----------
    text : str
        The page, one complete HTML file.
    height : int
        Height of the frame in pixels; its width is that of the notebook.
    """

    def __init__(self, text: str, height: int = 640) -> None:
        self.text = text
        self.height = height

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the page to a file.

        Parameters
        ----------
        path : path
            The file to write.
        """
        Path(path).write_text(self.text, encoding="utf-8")

    def __repr__(self) -> str:
        return f"<mozzi page of {len(self.text.encode()) / 1e6:.1f} MB: a notebook shows it, save(path) writes it>"

    def _repr_html_(self) -> str:
        source = html.escape(self.text, quote=True)
        return (
            f'<iframe srcdoc="{source}" style="width: 100%; height: {self.height}px; border: 0" '
            'sandbox="allow-scripts allow-downloads" title="a robot, by mozzi"></iframe>'
        )


def of_motion(model: "Model", motion: "Trajectory") -> Page:
    """Return the page of a motion, as ``Model.report`` writes it, without meshes."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "motion.html"
        model.report(path, motion)
        return Page(path.read_text(encoding="utf-8"))
