"""Identify a robot from logs of its motion, and find motions that determine it."""

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, NamedTuple

from numpy.typing import NDArray

from ._mozzi import Model, _edited_files, _excite, _identify

Array = NDArray[Any]
_Logs = Mapping[str, Any] | Sequence[Mapping[str, Any]]


class Forces(NamedTuple):
    """Measured and predicted forces of one log, filtered."""

    t: Array
    """Times, s, shape (N,)."""
    measured: Array
    """Shape (N, n): N m or N."""
    predicted: Array
    """Shape (N, n): N m or N."""


class Weighed(NamedTuple):
    """Mass and centre of a payload, from ``only="payload"``."""

    frame: str
    """The frame that carries the payload."""
    mass: float
    """Mass, kg."""
    deviation: float
    """Standard deviation of the mass, kg."""
    center: tuple[float, float, float]
    """Centre of mass in the frame's coordinates, m."""


class Verdict(NamedTuple):
    """Error of the predicted forces, as ``mozzi identify`` prints it first."""

    text: str
    """The verdict in one sentence."""
    predicted: Literal["OtherLog", "HeldOut", "LeftOut", "Fitted"]
    """Which samples were predicted."""
    nrms: float
    """Root mean square over the joints of error divided by force."""
    of_file: float
    """``nrms`` of the robot's file."""
    is_trusted: bool
    """False if the error is above half of the forces."""
    payload: Weighed | None
    """The payload, for ``only="payload"``."""


class Identification:
    """Result of ``mozzi.identify``.

    Attributes
    ----------
    model : Model
        The identified robot, with physically consistent links, friction and armature.
    report : dict
        As ``mozzi identify --json``: "verdict", "parameters", "base_parameters", "fitted", "left_out", "held_out",
        "validations", "residuals", "servos", "findings", "condition".
    forces : list of Forces
        Measured and predicted forces of each log.
    """

    def __init__(self, report: dict[str, Any], html: str, model: Model, forces: list[Forces]) -> None:
        self.report = report
        self.model = model
        self.forces = forces
        self._html = html

    @property
    def verdict(self) -> Verdict:
        """Error of the predicted forces, and whether the result can be trusted."""
        found = dict(self.report["verdict"])
        payload = found.pop("payload")
        if payload is not None:
            payload = Weighed(**{**payload, "center": tuple(payload["center"])})
        return Verdict(**found, payload=payload)

    @property
    def parameters(self) -> dict[str, float]:
        """The identified parameters by name."""
        return {entry["name"]: entry["value"] for entry in self.report["parameters"]}

    @property
    def servos(self) -> dict[str, dict[str, float]]:
        """Law of each joint's position controller: "stiffness", "damping", "delay", "bias" and "nrms".

        Empty unless a log has target positions.
        """
        laws = {}
        for entry in self.report["servos"]:
            law = {name: entry[name] for name in ("delay", "bias", "nrms")}
            law["stiffness"], law["damping"] = entry["stiffness"][0], entry["damping"][0]
            laws[entry["joint"]] = law
        return laws

    @property
    def findings(self) -> list[str]:
        """Findings in the logs and the fit, warnings first."""
        found = sorted(self.report["findings"], key=lambda entry: entry["level"] != "warning")
        return [f"{entry['level']}: {entry['text']}" for entry in found]

    def html(self, path: str | os.PathLike[str]) -> None:
        """Write the report as one HTML file.

        Parameters
        ----------
        path : path
            The file to write.
        """
        Path(path).write_text(self._html, encoding="utf-8")

    def write(
        self, source: str | os.PathLike[str], path: str | os.PathLike[str], *, old_values: bool = False
    ) -> list[str]:
        """Write a copy of the robot's file with the identified numbers; all other text stays.

        Parameters
        ----------
        source : path
            The robot's URDF, MJCF or xacro.
        path : path
            The file to write, or a folder for all files that change: numbers may be in included files, and in the
            YAML files of xacro.
        old_values : bool
            True to keep the old numbers in comments.

        Returns
        -------
        list of str
            The files that were written.

        Raises
        ------
        ValueError
            The file cannot express the robot, a number of xacro is computed, or several files change and ``path`` is
            not a folder.
        """
        text = Path(source).read_text(encoding="utf-8")
        files = _edited_files(str(source), text, self.model, old_values) or [(str(source), text)]
        if Path(path).is_dir():
            targets = [Path(path) / Path(name).name for name, _ in files]
        elif len(files) == 1:
            targets = [Path(path)]
        else:
            raise ValueError(f"numbers of {', '.join(name for name, _ in files)} change, expected a folder as path")
        for target, (name, content) in zip(targets, files):
            if target.exists() and target.samefile(name):
                raise ValueError(f"{target} is the robot's own file, expected another path")
            target.write_text(content, encoding="utf-8")
        return [str(target) for target in targets]

    def __repr__(self) -> str:
        errors = self.report["left_out"] or self.report["fitted"]
        kind = "left out" if self.report["left_out"] else "fitted"
        return f"<mozzi.Identification, {len(self.report['parameters'])} parameters, NRMS {100 * errors['nrms']:.2f} % ({kind})>"


def identify(
    model: Model,
    logs: _Logs,
    *,
    torque: Literal["motor", "link"] = "motor",
    only: Literal["payload", "friction"] | None = None,
    payload: str | None = None,
    cutoff: float | None = None,
    acceleration: Literal["differences", "spline"] = "differences",
    prior: float = 0.3,
    robust: bool = False,
    fit: float = 1.0,
    stribeck: float | None = None,
    width: float = 0.05,
    springs: bool = False,
    offsets: bool = True,
    total_mass: tuple[float, float] | None = None,
    lock: Mapping[str, float] | None = None,
    trust_log: bool = False,
    validate: _Logs = (),
) -> Identification:
    """Identify masses, inertias, friction and armature from logs of the robot's motion.

    Parameters
    ----------
    model : Model
        The robot; its own values are the prior for parameters that the data does not determine.
    logs : mapping or sequence of mappings
        Arrays "t" (N,), "theta" (N, nq), "tau" (N, n), and, if they are known, "dtheta", "ddtheta" (N, n) and the
        "target" (N, n) of position controllers. For floating bases also "wrench_FRAME" (N, 6), the measured wrench
        (m, f) that a frame applies to the environment, in the frame's coordinates; "tau" may then have the joints'
        columns alone.
    torque : {'motor', 'link'}
        Side of the gear on which forces are measured; armature is not estimated for 'link'.
    only : {'payload', 'friction'}, optional
        Estimate the payload or the friction alone.
    payload : str, optional
        The frame that carries the payload. Default: the end effector.
    cutoff : float, optional
        Cut-off of the zero-phase filter, Hz; ``inf`` for none. Default: five times the band of the velocities.
    acceleration : {'differences', 'spline'}
        Method that computes accelerations.
    prior : float
        Weight of the robot's own values for parameters that the data does not determine.
    robust : bool
        True to reduce the weight of large residuals.
    fit : float
        Part of each log that is fitted, in tenths; the rest is predicted.
    stribeck : float, optional
        Add Stribeck friction with this velocity, rad/s or m/s.
    width : float
        Width w of Coulomb friction μ tanh(θ̇/w), rad/s or m/s.
    springs, offsets : bool
        True to estimate springs, and constant forces.
    total_mass : (float, float), optional
        The mass of all moving links, kg, and its standard deviation.
    lock : mapping, optional
        Joints that the logs do not contain, with their positions, rad or m.
    trust_log : bool
        True to fit a log that contradicts itself or the robot: signs, units, swapped joints, velocities of another
        motion. The contradictions are then warnings among ``findings``.
    validate : mapping or sequence of mappings
        Further logs, whose forces are predicted, not fitted.

    Returns
    -------
    Identification

    Raises
    ------
    ValueError
        A log is too short, contradicts itself or the robot, or does not excite the robot, or an option is wrong.
    """
    if acceleration not in ("differences", "spline"):
        raise ValueError(f"acceleration is {acceleration!r}, expected 'differences' or 'spline'")
    if total_mass is not None and not (isinstance(total_mass, Sequence) and len(total_mass) == 2):
        raise TypeError(f"total_mass is {total_mass!r}, expected a mass and its standard deviation, kg, or None")
    options = {
        "torque": torque,
        "only": only,
        "payload": payload,
        "cutoff": cutoff,
        "spline": acceleration == "spline",
        "prior": float(prior),
        "robust": robust,
        "fit": float(fit),
        "stribeck": stribeck,
        "width": float(width),
        "springs": springs,
        "offsets": offsets,
        "total_mass": total_mass,
        "lock": list(lock.items()) if lock else None,
        "trust_log": trust_log,
    }
    report, html, found, forces = _identify(model, _listed(logs), _listed(validate), options)
    return Identification(json.loads(report), html, found, [Forces(*one) for one in forces])


def _listed(logs: _Logs) -> list[Mapping[str, Any]]:
    if isinstance(logs, (str, bytes, os.PathLike)):
        raise TypeError(f"logs is {logs!r}, expected a mapping with t, theta and tau; `mozzi identify` reads files")
    if isinstance(logs, Mapping):
        return [logs]
    table: Any = logs
    if hasattr(table, "columns") and hasattr(table, "to_dict"):  # pandas: a column holds numbers or lists of them
        return [{str(name): table[name].tolist() for name in table.columns}]
    try:
        return list(logs)
    except TypeError:
        raise TypeError(f"logs is {logs!r}, expected a mapping with t, theta and tau, or a sequence of them") from None


class Excitation(NamedTuple):
    """A motion that determines a robot's parameters."""

    t: Array
    """Times, s, shape (N,)."""
    theta: Array
    """Shape (N, n): rad or m."""
    dtheta: Array
    """Shape (N, n): rad/s or m/s."""
    ddtheta: Array
    """Shape (N, n): rad/s² or m/s²."""
    condition: float
    """Condition number of the base regressor with unit columns."""
    condition_of_random: float
    """Condition number of a random motion within equal limits."""
    parameters: dict[str, tuple[float, float]]
    """Base parameters: the robot's value, and the standard deviation that a log of the motion will give."""


def excite(
    model: Model,
    duration: float = 20.0,
    *,
    step: float = 0.01,
    harmonics: int = 5,
    velocity: Any = None,
    acceleration: Any = None,
    torque_limit: Any = None,
    noise: Any = None,
    rate: float = 100.0,
    torque: Literal["motor", "link"] = "motor",
) -> Excitation:
    """Find a motion that determines the robot's parameters, within limits.

    Parameters
    ----------
    model : Model
        A robot on a fixed base whose joints have one axis each.
    duration, step : float
        Duration, and time between two rows, s.
    harmonics : int
        Harmonics of the Fourier series.
    velocity, acceleration, torque_limit : array_like, optional
        Limits, one number or one for each joint: rad/s or m/s, rad/s² or m/s², N m or N. Default: the robot's, 1 rad/s
        or 0.2 m/s if it has no velocity limit, and the acceleration that reaches the velocity limit in 0.3 s, if the
        robot's is not smaller.
    noise : array_like, optional
        Standard deviation of the forces' noise, N m or N. Default: 1 % of the torque limits.
    rate : float
        Independent samples per second of the future log.
    torque : {'motor', 'link'}
        Side of the gear on which forces will be measured.

    Returns
    -------
    Excitation
    """
    options = {
        "velocity": velocity,
        "acceleration": acceleration,
        "torque": torque,
        "noise": noise,
        "harmonics": harmonics,
        "rate": float(rate),
        "torque_limit": torque_limit,
    }
    arrays, condition, of_random, parameters = _excite(model, float(duration), float(step), options)
    values = {name: (value, deviation) for name, value, deviation in parameters}
    t, theta, dtheta, ddtheta = arrays
    return Excitation(t, theta, dtheta, ddtheta, condition, of_random, values)
