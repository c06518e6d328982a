"""What Pinocchio and MuJoCo compute of the same robot."""

import html
import json
import os
import sys
from typing import Any, Literal

from ._mozzi import Model, _compare


class Comparison:
    """What was found: printed it is a report for people. Made by ``mozzi.compare``.

    Attributes
    ----------
    agrees : bool
        Did somebody compute, and everybody who did the same?
    explained : bool
        Did somebody compute, and is every difference explained?
    refused : bool
        mozzi refuses the file, and the others were asked whether they load it.
    libraries : dict
        For each library, by its name: its "status" ("agrees", "explained", "unexplained", "refused", "loaded", "not installed" or
        "no answer"), "version", and under "comparison" the errors and their causes, as in ``mozzi compare --json``.
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
    """Compare M, g, h and τ with what Pinocchio and MuJoCo compute of the same file, and say why they differ.

    Each library is asked in a process of its own. A cause counts only if the difference goes where it is accounted for, and comes back
    where it is not.

    Parameters
    ----------
    robot : str, path or Model
        A file of URDF or MJCF, or the name of a robot that mozzi brings along. A ``Model`` is written as URDF for the others, and refused
        where URDF has no words for it.
    states : int
        Random states, within the joints' limits.
    seed : int
        Of the random numbers.
    python : str or path, optional
        The Python that has ``pin`` or ``mujoco``, in place of this one.
    policy : {'default', 'strict', 'lenient'}
        How mozzi reads the file.

    Returns
    -------
    Comparison
        ``print`` it.

    Raises
    ------
    RuntimeError
        Neither library is there.

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
