"""Results of several parts, but for those of the quantities. The compiled methods make them by position."""

import importlib
import os
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from ._notebook import Page, of_motion
from ._quantities import Array

if TYPE_CHECKING:
    from ._mozzi import Model


class Engine(NamedTuple):
    """What computes a quantity, at one state and in arrays of states: see ``Model.engine``."""

    one: str
    many: str


class State(NamedTuple):
    """Positions (nq,), velocities (n,) and time, s: see ``Model.state``."""

    theta: Array
    dtheta: Array
    time: float


class Solution(NamedTuple):
    """What inverse kinematics found, of one target or of many: see ``InverseKinematics.solve``."""

    theta: Array
    """Shape (..., nq): the best positions found, rad or m."""
    reached: Any
    """bool, or an array of shape (...)."""
    angle: Any
    """The angle that is left, rad: float, array of shape (...), or None if the goal is a position."""
    distance: Any
    """The distance that is left, m: float, array of shape (...), or None if the goal is an orientation."""
    iterations: Any
    """Of all starts: int, or an array of shape (...)."""
    starts: Any
    """Starts that were needed: int, or an array of shape (...)."""
    reason: Any
    """Why the goal was not reached, '' if it was: str, or an array of shape (...)."""


class Progress(NamedTuple):
    """s, ṡ, 1/s, and s̈, 1/s², of a time scaling: see ``trajectories.Profile.at``."""

    s: Any
    ds: Any
    dds: Any


class PathPoint(NamedTuple):
    """θ (..., nq), θ′ and θ″ (..., n) of a path: see ``trajectories.Path.at``."""

    theta: Array
    slope: Array
    curvature: Array


class Desired(NamedTuple):
    """θ_d (..., nq), θ̇_d and θ̈_d (..., n) of a motion: see ``trajectories.Reference.at``."""

    theta: Array
    dtheta: Array
    ddtheta: Array


class Overload(NamedTuple):
    """A motor whose controller demanded more than its effort limit: see ``controllers.Saturated``."""

    joint: str
    largest: float
    """The largest |τ| that the controller demanded: N m or N."""
    limit: float
    """The joint's effort limit: N m or N."""
    first: float
    """Time of the first demand beyond the limit, s."""
    last: float
    """Time of the last demand beyond the limit, s."""


class TrackingError(NamedTuple):
    """The error e = θ_d ⊖ θ of each joint over a motion: see ``controllers.tracking_error``."""

    rms: Array
    """√(mean of e²), shape (..., n): rad or m."""
    largest: Array
    """max |e|, shape (..., n): rad or m."""

    @property
    def worst(self) -> Any:
        """The largest of all joints: float, or an array of shape (...)."""
        return self.largest.max(-1)

    @property
    def worst_rms(self) -> Any:
        """The largest root of a mean square of all joints: float, or an array of shape (...)."""
        return self.rms.max(-1)


class ClosedForm(NamedTuple):
    """The book's stacked matrices over N bodies, and their results: see ``Model.closed_form``."""

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
    """Columns named by quantity and joint; many motions are concatenated."""
    columns = {f"theta.{name}": motion.theta[..., k].ravel() for k, name in enumerate(motion.position_names)}
    for what in ("dtheta", "ddtheta", "tau"):
        numbers = getattr(motion, what)
        columns |= {f"{what}.{name}": numbers[..., k].ravel() for k, name in enumerate(motion.velocity_names)}
    return columns


class Rollout(NamedTuple):
    """The states of N steps under given torques, from the start on: the starts' axes come first, then N + 1 rows."""

    theta: Array
    """Shape (..., N + 1, nq)."""
    dtheta: Array
    """Shape (..., N + 1, n)."""


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
    contact_forces: Array
    """Shape (..., rows, contacts, 3): the forces that contact points apply to planes, in {s}, N."""
    contact_names: list[str]
    one_sided: "OneSided | None"
    """The worst of all robots; None if they moved together in registers."""

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


class Occurrence(NamedTuple):
    """An event of a simulation: its time, s, the state there, and whether the motion ends there."""

    name: str
    t: float
    theta: Array
    dtheta: Array
    end: bool


class LimitReached(NamedTuple):
    """A joint that came to a limit, rad or m: when first, s, how far beyond it at most, and how often."""

    joint: str
    limit: float
    first: float
    beyond: float
    times: int


class ReportSize(NamedTuple):
    """The rows of a motion on a page, of all its rows, and the page's bytes."""

    rows: int
    all_rows: int
    bytes: int


class Closing(NamedTuple):
    """The largest violation of the constraints along a simulated motion, rad and m; 0 without constraints."""

    residual: float
    """After the correction of each step."""
    corrected: float
    """Before it: what the method of integration left."""


class ContactEvent(NamedTuple):
    """A contact that begins or ceases to carry or to slide."""

    t: float
    contact: str
    change: str
    """'touches down', 'lifts off', 'sticks' or 'slides'."""


class OneSided(NamedTuple):
    """How well the laws of dry friction, stops and contacts were satisfied: residuals in m/s or rad/s."""

    largest_residual: float
    last_residual: float
    unsolved: int
    """Steps with a residual above 1e-6: their problem may have no solution."""
    halvings: int
    """How often a step was halved, because its iteration did not contract, or a loop did not close."""
    unsettled: int
    """Steps of the shortest length whose iteration did not contract; they count."""


class ConstraintRank(NamedTuple):
    """The rank of the constraints at a position: see ``Model.constraint_rank``."""

    rows: int
    rank: int
    freedom: int
    redundant: list[str]


class Reduction(NamedTuple):
    """A mechanism in its own coordinates: see ``Model.reduce``."""

    independent: list[int]
    N: Array
    bias: Array
    M: Array
    h: Array
    g: Array


class ConstrainedDynamics(NamedTuple):
    """Torques and forces of a motion with constraints: see ``Model.constrained_inverse_dynamics``."""

    ddtheta: Array
    tau: Array
    multipliers: Array
    wrenches: dict[str, Array]


class ConstrainedForwardDynamicsDerivatives(NamedTuple):
    """Derivatives of θ̈ and λ: see ``Model.constrained_forward_dynamics_derivatives``."""

    d_theta: Array
    d_dtheta: Array
    d_tau: Array
    multipliers_d_theta: Array
    multipliers_d_dtheta: Array
    multipliers_d_tau: Array


class Trajectory(NamedTuple):
    """A simulated motion: one row for each recorded time; works in J since the start; what ``until``, ``events`` and ``joint_limits`` found."""

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
    events: list[Occurrence]
    joint_limits: list[LimitReached]
    closing: Closing
    method: str
    """The method that took the steps."""
    contact_names: list[str]
    contact_forces: Array
    """Shape (rows, contacts, 3): the forces that contact points apply to planes, in {s}, N."""
    contact_events: list[ContactEvent]
    one_sided: OneSided | None
    """None for a robot without dry friction and contacts."""
    contacts: list[Any] | None
    """The contact points, as given to ``simulate``."""
    planes: list[Any] | None
    """The planes, as given to ``simulate``: by default the ground."""

    @property
    def energy(self) -> Array:
        """Kinetic and potential, J."""
        return self.kinetic_energy + self.potential_energy

    def to_pandas(self) -> Any:
        """A pandas.DataFrame over t, with the columns theta.<joint>, dtheta.<joint>, ddtheta.<joint>, tau.<joint>."""
        pandas: Any = importlib.import_module("pandas")
        return pandas.DataFrame(_columns(self), index=pandas.Index(self.t, name="t"))

    def page(self) -> Page:
        """The motion as a page with the robot and plots, which a notebook shows; ``Model.report`` has meshes, too."""
        return of_motion(self.model, self)

    def _repr_html_(self) -> str:
        return self.page()._repr_html_()

    def report(
        self,
        path: str | os.PathLike[str],
        *,
        shapes: str | os.PathLike[str] | None = None,
        meshes: Literal["visual", "collision", "none"] = "visual",
        mesh_root: str | os.PathLike[str] | None = None,
        title: str = "simulated",
        rows: int | None = 20_000,
    ) -> ReportSize:
        """The motion, with its contacts, as one HTML file that needs nothing but a browser: see ``Model.report``."""
        return self.model.report(path, self, shapes=shapes, meshes=meshes, mesh_root=mesh_root, title=title, rows=rows)

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
