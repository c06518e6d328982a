"""Results of several parts, but for those of the quantities. The compiled methods make them by position."""

import importlib
import os
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from ._quantities import Array

if TYPE_CHECKING:
    from ._mozzi import Model


class Engine(NamedTuple):
    """What computes a quantity, at one state and in arrays of states: see ``Model.engine``."""

    one: str
    many: str


class ClosedForm(NamedTuple):
    """The book's stacked matrices over N bodies, and what they give: see ``Model.closed_form``."""

    A: Array
    G: Array
    W: Array
    L: Array
    ad_V: Array
    ad_Adtheta: Array
    V: Array
    V_base: Array
    dV_base: Array
    F_tip: Array
    M: Array
    c: Array
    g: Array
    tip_forces: Array
    friction: Array
    armature: Array
    springs: Array


class NewtonEuler(NamedTuple):
    """The recursion's twists, accelerations and wrenches (N, 6), the base's reaction (6,), τ (n,): see ``Model.newton_euler``."""

    twists: Array
    accelerations: Array
    wrenches: Array
    base_reaction: Array
    tau: Array


class BaseParameters(NamedTuple):
    """Independent columns of the regressor, K of π_b = K π, and their names: see ``Model.base_parameters``."""

    columns: list[int]
    combination: Array
    names: list[str]


class ScrewLists(NamedTuple):
    """The book's lists, over the moving links: see ``Model.screws``."""

    joints: list[str]
    links: list[str]
    parents: list[int]
    M: Array
    M_relative: Array
    S: Array
    A: Array
    B: Array
    G: Array
    end_effector: tuple[str, Array] | None


def _columns(motion: "Trajectory | Trajectories") -> dict[str, Array]:
    """The numbers of each joint, by what they are and the joint's name; many motions one after the other."""
    columns = {f"theta.{name}": motion.theta[..., k].ravel() for k, name in enumerate(motion.position_names)}
    for what in ("dtheta", "ddtheta", "tau"):
        numbers = getattr(motion, what)
        columns |= {f"{what}.{name}": numbers[..., k].ravel() for k, name in enumerate(motion.velocity_names)}
    return columns


class Trajectories(NamedTuple):
    """Simulated motions from many starts, at the same times: the starts' axes come first, then the rows, one for each time."""

    t: Array
    theta: Array
    dtheta: Array
    ddtheta: Array
    tau: Array
    kinetic_energy: Array
    potential_energy: Array
    position_names: list[str]
    velocity_names: list[str]
    model: "Model"

    @property
    def energy(self) -> Array:
        """Kinetic and potential, J: shape (..., rows)."""
        return self.kinetic_energy + self.potential_energy

    def to_pandas(self) -> Any:
        """A pandas.DataFrame over the starts' axes (start, or start0, start1, …) and t, with the columns of ``Trajectory.to_pandas``."""
        pandas: Any = importlib.import_module("pandas")
        axes = self.kinetic_energy.shape[:-1]
        names = ["start"] if len(axes) == 1 else [f"start{k}" for k in range(len(axes))]
        index = pandas.MultiIndex.from_product([*map(range, axes), self.t], names=[*names, "t"])
        return pandas.DataFrame(_columns(self), index=index)


class Trajectory(NamedTuple):
    """A simulated motion: one row for each recorded time; works in J since the start."""

    t: Array
    theta: Array
    dtheta: Array
    ddtheta: Array
    tau: Array
    kinetic_energy: Array
    potential_energy: Array
    motor_work: Array
    friction_loss: Array
    applied_work: Array
    position_names: list[str]
    velocity_names: list[str]
    model: "Model"

    @property
    def energy(self) -> Array:
        """Kinetic and potential, J."""
        return self.kinetic_energy + self.potential_energy

    def to_pandas(self) -> Any:
        """A pandas.DataFrame over t, with the columns theta.<joint>, dtheta.<joint>, ddtheta.<joint>, tau.<joint>."""
        pandas: Any = importlib.import_module("pandas")
        return pandas.DataFrame(_columns(self), index=pandas.Index(self.t, name="t"))

    def report(
        self,
        path: str | os.PathLike[str],
        *,
        shapes: str | os.PathLike[str] | None = None,
        meshes: Literal["visual", "collision", "none"] = "visual",
        title: str = "simulated",
    ) -> None:
        """The motion as one HTML file that needs nothing but a browser: see ``Model.report``."""
        self.model.report(path, self, shapes=shapes, meshes=meshes, title=title)

    def plot(self) -> Any:
        """A matplotlib figure of θ, θ̇, τ and the energies over t."""
        pyplot: Any = importlib.import_module("matplotlib.pyplot")
        figure, axes = pyplot.subplots(4, 1, sharex=True, layout="constrained", figsize=(7, 9))
        for axis, what, rows, names in zip(
            axes,
            ("θ (rad, m)", "dθ/dt (rad/s, m/s)", "τ (N m, N)"),
            (self.theta, self.dtheta, self.tau),
            (self.position_names, self.velocity_names, self.velocity_names),
            strict=False,
        ):
            for k, name in enumerate(names):
                axis.plot(self.t, rows[:, k], label=name)
            axis.set_ylabel(what)
        axes[0].legend(fontsize="small", ncols=2)
        energies = {"kinetic": self.kinetic_energy, "potential": self.potential_energy, "total": self.energy}
        for name, energy in energies.items():
            axes[3].plot(self.t, energy, label=name)
        axes[3].set_ylabel("energy (J)")
        axes[3].set_xlabel("t (s)")
        axes[3].legend(fontsize="small")
        return figure
