"""Pages in a notebook: a whole HTML page in a frame of its own, which asks the network for nothing."""

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
    """An HTML page. A notebook shows it in a frame; ``save`` writes it to a file."""

    def __init__(self, text: str, height: int = 640) -> None:
        self.text = text
        """The page, one whole HTML file."""
        self.height = height
        """Of the frame, in pixels; its width is that of the notebook."""

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the page to a file."""
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
    """The page of a motion, as ``Model.report`` writes it, without meshes."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "motion.html"
        model.report(path, motion)
        return Page(path.read_text(encoding="utf-8"))
