"""Compare a robot's dynamics with Pinocchio and MuJoCo."""

import html
import json
import os
import sys
from typing import Any, Literal

from ._mozzi import Model, _compare


class Comparison:
    """Result of ``mozzi.compare``; ``print`` shows it as a report.

    Attributes
    ----------
    agrees : bool
        True if at least one library computed results, and all of them agree.
    explained : bool
        True if at least one library computed results, and every difference is explained.
    refused : bool
        True if mozzi refuses the file; the report then shows whether the other libraries load it.
    model : str
        Name of the robot.
    libraries : dict
        For each library, by its name: its "status" ("agrees", "explained", "unexplained", "refused", "loaded",
        "not installed" or "no answer"), "version", and under "comparison" the errors and their causes, as in
        ``mozzi compare --json``.
    """

    def __init__(self, text: str, report: dict[str, Any], agrees: bool, explained: bool) -> None:
        self._text = text
        self.agrees = agrees
        self.explained = explained
        self.refused: bool = report["refused"]
        self.model: str = report["model"]
        self.libraries: dict[str, dict[str, Any]] = {entry["library"]: entry for entry in report["libraries"]}

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        found = ", ".join(f"{name}: {entry['status']}" for name, entry in self.libraries.items())
        return f"<mozzi.Comparison of '{self.model}', {found}>"

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self._text)}</pre>"


def compare(
    robot: Model | str | os.PathLike[str],
    *,
    states: int = 10,
    seed: int = 1,
    python: str | os.PathLike[str] | None = None,
    policy: Literal["default", "strict", "lenient"] = "default",
) -> Comparison:
    """Compare M, g, h and τ with Pinocchio and MuJoCo on the same file, and explain differences.

    Each library runs in a process of its own. A cause is reported only if the difference vanishes with it and returns
    without it.

    Parameters
    ----------
    robot : str, path or Model
        A file of URDF, MJCF or mozzi's JSON, or the name of an embedded robot. A ``Model``, or that of JSON, is
        written as URDF for the other libraries, and refused if URDF cannot express it.
    states : int
        Number of random states within the joints' limits.
    seed : int
        Seed of the random states.
    python : str or path, optional
        Python interpreter with ``pin`` or ``mujoco``. Default: this one.
    policy : {'default', 'strict', 'lenient'}
        How mozzi reads the file.

    Returns
    -------
    Comparison
        ``print`` shows the report.

    Raises
    ------
    RuntimeError
        Neither library is installed.

    Examples
    --------
    >>> import mozzi
    >>> found = mozzi.compare("ur5")  # doctest: +SKIP
    >>> found.agrees, found.libraries["Pinocchio"]["status"]  # doctest: +SKIP
    (True, 'agrees')
    """
    if states < 1:
        raise ValueError(f"states is {states}, expected at least 1")
    if seed < 0:
        raise ValueError(f"seed is {seed}, expected at least 0")
    if python is None and not sys.executable:
        raise ValueError("python is None, and this interpreter does not know its own program: name one that has pin or mujoco")
    text, report, agrees, explained = _compare(robot, states, seed, python or sys.executable, policy)
    return Comparison(text, json.loads(report), agrees, explained)
