"""Named tuples of results, except those of the quantities. The compiled methods make them by position."""

import importlib
import os
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from ._notebook import Page, of_motion
from ._quantities import Array

if TYPE_CHECKING:
    from ._mozzi import Model


class Engine(NamedTuple):
    """How a quantity is computed, at one state and in arrays of states: see ``Model.engine``."""

    one: str
    """At one state: 'machine code (...), ... bytes', or 'kernels: ' and the reason."""
    many: str
    """In arrays of states."""


class State(NamedTuple):
    """A state and its time: see ``Model.state``."""

    theta: Array
    """Positions, shape (nq,): rad or m."""
    dtheta: Array
    """Velocities, shape (n,): rad/s or m/s."""
    time: float
    """s."""


class Solution(NamedTuple):
    """Result of inverse kinematics, for one target or for many: see ``InverseKinematics.solve``."""

    theta: Array
    """Shape (..., nq): the best positions found, rad or m."""
    reached: Any
    """bool, or an array of shape (...)."""
    angle: Any
    """Remaining angle, rad: float, array of shape (...), or None if the goal is a position."""
    distance: Any
    """Remaining distance, m: float, array of shape (...), or None if the goal is an orientation."""
    iterations: Any
    """Iterations of all starts: int, or an array of shape (...)."""
    starts: Any
    """Number of starts: int, or an array of shape (...)."""
    reason: Any
    """Why the goal was not reached, '' if it was: str, or an array of shape (...)."""


class Progress(NamedTuple):
    """A time scaling at one time or at many: see ``trajectories.Profile.at``."""

    s: Any
    """s, 0 to 1: float, or an array of shape (...)."""
    ds: Any
    """ṡ, 1/s."""
    dds: Any
    """s̈, 1/s²."""


class PathPoint(NamedTuple):
    """A point of a path, or several: see ``trajectories.Path.at``."""

    theta: Array
    """θ, shape (..., nq): rad or m."""
    slope: Array
    """θ′, the velocity at ṡ = 1, shape (..., n)."""
    curvature: Array
    """θ″, shape (..., n)."""


class Desired(NamedTuple):
    """A desired state and its accelerations: see ``trajectories.Reference.at``."""

    theta: Array
    """θ_d, shape (..., nq): rad or m."""
    dtheta: Array
    """θ̇_d, shape (..., n): rad/s or m/s."""
    ddtheta: Array
    """θ̈_d, shape (..., n): rad/s² or m/s²."""


class Overload(NamedTuple):
    """A motor whose controller demanded more than its effort limit: see ``controllers.Saturated``."""

    joint: str
    """Name of the joint."""
    largest: float
    """The largest |τ| that the controller demanded: N m or N."""
    limit: float
    """The joint's effort limit: N m or N."""
    first: float
    """Time of the first demand beyond the limit, s."""
    last: float
    """Time of the last demand beyond the limit, s."""


class TrackingError(NamedTuple):
    """Tracking error e = θ_d ⊖ θ of each joint over a motion: see ``controllers.tracking_error``."""

    rms: Array
    """√(mean of e²), shape (..., n): rad or m."""
    largest: Array
    """max |e|, shape (..., n): rad or m."""

    @property
    def worst(self) -> Any:
        """Largest ``largest`` of all joints: float, or an array of shape (...)."""
        return self.largest.max(-1, initial=0.0)

    @property
    def worst_rms(self) -> Any:
        """Largest ``rms`` of all joints: float, or an array of shape (...)."""
        return self.rms.max(-1, initial=0.0)


class ClosedForm(NamedTuple):
    """The book's stacked matrices over N bodies, and their results: see ``Model.closed_form``."""

    A: Array
    """Screw axes, shape (6N, n)."""
    G: Array
    """Spatial inertias, block diagonal, shape (6N, 6N)."""
    W: Array
    """[Ad_T_ip] in the block of each body i and its parent p, shape (6N, 6N)."""
    L: Array
    """L = (I − W)⁻¹, shape (6N, 6N)."""
    ad_V: Array
    """[ad_V], block diagonal, shape (6N, 6N)."""
    ad_Adtheta: Array
    """[ad_{Aθ̇}], block diagonal, shape (6N, 6N)."""
    V: Array
    """Twists of the bodies, shape (6N,)."""
    V_base: Array
    """Twist of {s} in the blocks of the bodies on the base, shape (6N,)."""
    dV_base: Array
    """Acceleration of {s} with gravity in the blocks of the bodies on the base, shape (6N,)."""
    F_tip: Array
    """Wrenches that the bodies apply to the environment, shape (6N,)."""
    M: Array
    """Mass matrix, shape (n, n)."""
    c: Array
    """Coriolis and centripetal forces, with those of the base's twist, shape (n,)."""
    g: Array
    """Gravity forces, with those of the base's acceleration, shape (n,)."""
    tip_forces: Array
    """Forces JᵀF of the wrenches, shape (n,)."""
    friction: Array
    """Joint friction, shape (n,)."""
    armature: Array
    """Rotor inertias, shape (n, n); part of M."""
    springs: Array
    """Spring forces, shape (n,)."""


class NewtonEuler(NamedTuple):
    """Inverse dynamics with the recursion's results for the N moving links: see ``Model.newton_euler``."""

    twists: Array
    """Twists (ω, v), shape (N, 6)."""
    accelerations: Array
    """Accelerations (ω̇, v̇) with gravity, shape (N, 6)."""
    wrenches: Array
    """Wrenches (m, f) that the joints transmit, shape (N, 6)."""
    base_reaction: Array
    """Wrench (m, f) of the base, shape (6,)."""
    tau: Array
    """τ, shape (n,): N m or N."""


class BaseParameters(NamedTuple):
    """Base parameters π_b = K π: see ``Model.base_parameters``."""

    columns: list[int]
    """Independent columns of the regressor."""
    combination: Array
    """K, shape (base parameters, parameters)."""
    names: list[str]
    """Names such as 'link1.Izz + 0.25 link2.m'."""


class ScrewLists(NamedTuple):
    """The book's lists over the N moving links: see ``Model.screws``."""

    joints: list[str]
    """Names of the joints."""
    links: list[str]
    """Names of the links."""
    parents: list[int]
    """Number of each link's parent among the links, from 1; 0 is the base."""
    M: Array
    """Home frames in the base's frame, shape (N, 4, 4)."""
    M_relative: Array
    """Home frames in the parent's frame, shape (N, 4, 4)."""
    S: Array
    """Screw axes in {s}, shape (6, N)."""
    A: Array
    """Screw axes in the links' frames, shape (6, N)."""
    B: Array
    """Screw axes in the end effector's frame, shape (6, N); empty without an end effector."""
    G: Array
    """Spatial inertias, shape (N, 6, 6)."""
    end_effector: tuple[str, Array] | None
    """Name and home frame of the end effector, or None."""


def _columns(motion: "Trajectory | Trajectories") -> dict[str, Array]:
    """Columns named by quantity and joint; many motions are concatenated."""
    columns = {f"theta.{name}": motion.theta[..., k].ravel() for k, name in enumerate(motion.position_names)}
    for what in ("dtheta", "ddtheta", "tau"):
        numbers = getattr(motion, what)
        columns |= {f"{what}.{name}": numbers[..., k].ravel() for k, name in enumerate(motion.velocity_names)}
    return columns


class Rollout(NamedTuple):
    """The start and the states of N steps, N + 1 rows after the starts' axes: see ``Model.rollout``."""

    theta: Array
    """Shape (..., N + 1, nq): rad or m."""
    dtheta: Array
    """Shape (..., N + 1, n): rad/s or m/s."""


class Trajectories(NamedTuple):
    """Simulated motions from several starts, at equal times: the starts' axes, then one row for each time."""

    t: Array
    """Times, s, shape (rows,)."""
    theta: Array
    """Positions, shape (..., rows, nq): rad or m."""
    dtheta: Array
    """Velocities, shape (..., rows, n): rad/s or m/s."""
    ddtheta: Array
    """Accelerations, shape (..., rows, n): rad/s² or m/s²."""
    tau: Array
    """Torques and forces of the motors, shape (..., rows, n): N m or N."""
    kinetic_energy: Array
    """J, shape (..., rows)."""
    potential_energy: Array
    """J, shape (..., rows); gravity and springs."""
    position_names: list[str]
    """Names of the entries of ``theta``."""
    velocity_names: list[str]
    """Names of the entries of ``dtheta``, ``ddtheta`` and ``tau``."""
    model: "Model"
    """The simulated robot."""
    contact_forces: Array
    """Shape (..., rows, contacts, 3): the forces that contact points apply to planes, in {s}, N."""
    contact_names: list[str]
    """Names of the contacts, the point's and the plane's."""
    one_sided: "OneSided | None"
    """The worst of all robots; None if machine code moved them all."""

    @property
    def energy(self) -> Array:
        """Total energy, kinetic and potential: J, shape (..., rows)."""
        return self.kinetic_energy + self.potential_energy

    def to_pandas(self) -> Any:
        """Return a pandas.DataFrame indexed by the starts' axes and t, with the columns of ``Trajectory.to_pandas``.

        The levels of the index are start and t, or start0, start1, … and t.
        """
        pandas: Any = importlib.import_module("pandas")
        axes = self.kinetic_energy.shape[:-1]
        names = ["start"] if len(axes) == 1 else [f"start{k}" for k in range(len(axes))]
        index = pandas.MultiIndex.from_product([*map(range, axes), self.t], names=[*names, "t"])
        return pandas.DataFrame(_columns(self), index=index)


class Occurrence(NamedTuple):
    """An event of a simulation: see ``Model.simulate``."""

    name: str
    """The condition, or the function's name."""
    t: float
    """Time, s."""
    theta: Array
    """Positions at that time, shape (nq,)."""
    dtheta: Array
    """Velocities at that time, shape (n,)."""
    end: bool
    """True if the event ended the motion."""


class LimitReached(NamedTuple):
    """A joint that reached a position limit during a simulation."""

    joint: str
    """Name of the joint."""
    limit: float
    """The limit, rad or m."""
    first: float
    """Time of the first contact with the limit, s."""
    beyond: float
    """Largest distance beyond the limit, rad or m."""
    times: int
    """How often the joint reached the limit."""


class ReportSize(NamedTuple):
    """Size of a report: see ``Model.report``."""

    rows: int
    """Rows of the motion on the page."""
    all_rows: int
    """Rows of the motion."""
    bytes: int
    """Bytes of the file."""


class Closing(NamedTuple):
    """Largest violation of the constraints along a simulated motion, rad and m; 0 without constraints."""

    residual: float
    """After the correction of each step."""
    corrected: float
    """Before the correction: the error of the integration method."""


class ContactEvent(NamedTuple):
    """A contact that begins or ceases to carry or to slide."""

    t: float
    """Time, s."""
    contact: str
    """Name of the contact."""
    change: str
    """'touches down', 'lifts off', 'sticks' or 'slides'."""


class OneSided(NamedTuple):
    """Residuals of the laws of dry friction, stops and contacts, m/s or rad/s, over a simulated motion."""

    largest_residual: float
    """Largest residual of a step."""
    last_residual: float
    """Residual of the last step."""
    unsolved: int
    """Steps with a residual above 1e-6: their problem may have no solution."""
    halvings: int
    """How often a step was halved, because its iteration did not contract, or a loop did not close."""
    unsettled: int
    """Steps of the shortest length whose iteration did not contract; they count."""


class ConstraintRank(NamedTuple):
    """Rank of the constraints at one position: see ``Model.constraint_rank``."""

    rows: int
    """Number of rows m."""
    rank: int
    """Rank of A(θ)."""
    freedom: int
    """Degrees of freedom, n − rank."""
    redundant: list[str]
    """Names of rows that depend on the others."""


class Reduction(NamedTuple):
    """Dynamics of a mechanism in its d independent velocities u: see ``Model.reduce``."""

    independent: list[int]
    """Indices of u among the velocities."""
    N: Array
    """θ̇ = N u, shape (n, d)."""
    bias: Array
    """θ̈ = N u̇ + bias, shape (n,)."""
    M: Array
    """Mass matrix, shape (d, d)."""
    h: Array
    """h of Nᵀτ = M u̇ + h, shape (d,)."""
    g: Array
    """The part of gravity in h, shape (d,)."""


class ConstrainedDynamics(NamedTuple):
    """Torques and constraint forces of a motion: see ``Model.constrained_inverse_dynamics``."""

    ddtheta: Array
    """θ̈, shape (n,): rad/s² or m/s²."""
    tau: Array
    """τ, shape (n,): N m or N."""
    multipliers: Array
    """λ, shape (m,)."""
    wrenches: dict[str, Array]
    """Wrench (m, f) of each constraint, shape (6,): see ``Model.constraint_wrenches``."""


class ConstrainedForwardDynamicsDerivatives(NamedTuple):
    """Derivatives of θ̈ and λ: see ``Model.constrained_forward_dynamics_derivatives``."""

    d_theta: Array
    """∂θ̈/∂θ along the velocities, shape (n, n)."""
    d_dtheta: Array
    """∂θ̈/∂θ̇, shape (n, n)."""
    d_tau: Array
    """∂θ̈/∂τ, shape (n, n)."""
    multipliers_d_theta: Array
    """∂λ/∂θ along the velocities, shape (m, n)."""
    multipliers_d_dtheta: Array
    """∂λ/∂θ̇, shape (m, n)."""
    multipliers_d_tau: Array
    """∂λ/∂τ, shape (m, n)."""


class Trajectory(NamedTuple):
    """A simulated motion, one row for each recorded time: see ``Model.simulate``."""

    t: Array
    """Times, s, shape (rows,)."""
    theta: Array
    """Positions, shape (rows, nq): rad or m."""
    dtheta: Array
    """Velocities, shape (rows, n): rad/s or m/s."""
    ddtheta: Array
    """Accelerations, shape (rows, n): rad/s² or m/s²."""
    tau: Array
    """Torques and forces of the motors, shape (rows, n): N m or N."""
    kinetic_energy: Array
    """J, shape (rows,)."""
    potential_energy: Array
    """J, shape (rows,); gravity and springs."""
    motor_work: Array
    """Work of the motors since the start, J, shape (rows,)."""
    friction_loss: Array
    """Energy lost to friction since the start, J, shape (rows,)."""
    applied_work: Array
    """Work of applied wrenches since the start, J, shape (rows,)."""
    position_names: list[str]
    """Names of the entries of ``theta``."""
    velocity_names: list[str]
    """Names of the entries of ``dtheta``, ``ddtheta`` and ``tau``."""
    model: "Model"
    """The simulated robot."""
    events: list[Occurrence]
    """Occurrences of ``until`` and ``events``."""
    joint_limits: list[LimitReached]
    """Position limits that joints reached."""
    closing: Closing
    """Violation of the constraints."""
    method: str
    """The integration method."""
    contact_names: list[str]
    """Names of the contacts, the point's and the plane's."""
    contact_forces: Array
    """Shape (rows, contacts, 3): the forces that contact points apply to planes, in {s}, N."""
    contact_events: list[ContactEvent]
    """Contacts that begin or cease to carry or to slide."""
    one_sided: OneSided | None
    """None for a robot without dry friction and contacts."""
    contacts: list[Any] | None
    """The contact points, as given to ``simulate``."""
    planes: list[Any] | None
    """The planes, as given to ``simulate``: by default the ground."""

    @property
    def energy(self) -> Array:
        """Total energy, kinetic and potential: J, shape (rows,)."""
        return self.kinetic_energy + self.potential_energy

    def to_pandas(self) -> Any:
        """Return a pandas.DataFrame indexed by t, with the columns theta.<joint>, dtheta, ddtheta and tau likewise."""
        pandas: Any = importlib.import_module("pandas")
        return pandas.DataFrame(_columns(self), index=pandas.Index(self.t, name="t"))

    def page(self) -> Page:
        """Return a page with the robot and plots, which a notebook shows; ``Model.report`` also has meshes."""
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
        """Write the motion, with its contacts, as one HTML file that needs nothing but a browser.

        Parameters
        ----------
        path : path
            The file to write.
        shapes, meshes, mesh_root, title, rows
            As in ``Model.report``.

        Returns
        -------
        ReportSize
        """
        return self.model.report(path, self, shapes=shapes, meshes=meshes, mesh_root=mesh_root, title=title, rows=rows)

    def plot(self) -> Any:
        """Return a matplotlib figure of θ, θ̇, τ and the energies over t."""
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
