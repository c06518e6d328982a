"""The compiled part; ``help(mozzi.Model.mass_matrix)`` prints parameters, shapes and an example."""

import os
from collections.abc import Callable, Mapping, Sequence
from types import ModuleType
from typing import Any, Literal, Protocol, overload

from numpy.typing import ArrayLike

from ._environment import Environment
from ._gpu import Gpu
from ._notebook import Page
from ._quantities import *
from ._quantities import Array
from ._results import (
    BaseParameters,
    ClosedForm,
    ConstrainedDynamics,
    ConstrainedForwardDynamicsDerivatives,
    ConstraintRank,
    Desired,
    Engine,
    NewtonEuler,
    Overload,
    PathPoint,
    Progress,
    Reduction,
    ReportSize,
    Rollout,
    ScrewLists,
    Solution,
    State,
    TrackingError,
    Trajectories,
    Trajectory,
)

__version__: str
_embedded_names: list[str]
_modern_robotics: ModuleType

def _command_line(words: list[str]) -> int:
    """Run the command line with these words, the program's name first; return the exit code."""

def _jax_handler() -> object:
    """XLA's handler on the CPU, as a capsule."""

def _jax_gpu_handler(packages: list[str]) -> object:
    """XLA's handler on an NVIDIA GPU, as a capsule; `packages` are folders that may contain NVRTC's wheel."""

def _jax_layout() -> dict[str, int]:
    """Expressions of XLA's header in C, and their values in this library."""

def _identify(
    model: Model, logs: list[Any], validate: list[Any], options: dict[str, Any]
) -> tuple[str, str, Model, list[list[Array]]]:
    """Identify a robot from logs; `mozzi.identify` names the results."""

def _excite(
    model: Model, duration: float, step: float, options: dict[str, Any]
) -> tuple[list[Array], float, float, list[tuple[str, float, float]]]:
    """Find an exciting motion; `mozzi.excite` names the results."""

def _edited_files(name: str, text: str, model: Model, old_values: bool) -> list[tuple[str, str]]:
    """Return the names and texts of the files that hold this robot's numbers, edited."""

def _compare(
    robot: Model | str | os.PathLike[str], states: int, seed: int, python: str | os.PathLike[str], policy: str
) -> tuple[str, str, bool, bool]:
    """Compare a robot with other libraries: text, JSON, and whether all results agree and are explained."""

_Event = str | Callable[[float, Array, Array], float]
_Events = _Event | Sequence[_Event]

class SupportsRead(Protocol):
    def read(self) -> str | bytes: ...

class LoadError(ValueError):
    """A robot's file is invalid."""
    diagnostics: list[str]

class LoadWarning(UserWarning):
    """A robot's file is odd; its values are used as they are."""

class DynamicsWarning(LoadWarning):
    """An element of a robot's file is ignored or replaced, so that the robot may move differently."""

class SingularError(ArithmeticError):
    """The mass matrix, or a task, is singular at a state; the acceleration or the wrench is undefined."""

class DivergedError(ArithmeticError):
    """A simulated state became infinite or NaN."""

class MotionError(ArithmeticError):
    """No motion was found."""

class Model:
    """A robot; its methods compute one quantity each."""
    @staticmethod
    def _embedded(name: str, floating: bool) -> Model: ...
    def _jax_handle(self) -> int:
        """Registers the robot for XLA; the returned number depends only on its content."""
    def _jax_shapes(
        self, quantity: str, frame: str | None
    ) -> tuple[str, list[tuple[str, list[int]]], list[tuple[str, list[int]]]]:
        """Name of the quantity's frame, empty if it has none, and names and shapes of its inputs and outputs."""
    @property
    def _quaternions(self) -> list[tuple[int, int, bool]]:
        """For each quaternion in θ: its index in θ, its joint's index in θ̇, and whether a position follows it."""
    def __copy__(self) -> Model: ...
    def __deepcopy__(self, _memo: Any, /) -> Model: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def _repr_html_(self) -> str: ...
    def closed_form(
        self, theta: ArrayLike, dtheta: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        gravity: ArrayLike | None = None, applied_wrenches: Mapping[str, ArrayLike] | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None
    ) -> ClosedForm:
        """Compute the book's stacked matrices at one state (Modern Robotics, section 8.4)."""
    def newton_euler(
        self, theta: ArrayLike, dtheta: ArrayLike, ddtheta: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        frame: Literal["center_of_mass", "link"] = "center_of_mass", gravity: ArrayLike | None = None,
        applied_wrenches: Mapping[str, ArrayLike] | None = None, base_twist: ArrayLike | None = None,
        base_acceleration: ArrayLike | None = None
    ) -> NewtonEuler:
        """Compute inverse dynamics at one state with the recursion's twists, accelerations and wrenches."""
    def base_parameters(self) -> BaseParameters:
        """Compute the base parameters π_b = K π, the combinations that determine the joint forces."""
    def derive(
        self, quantity: str, *, frame: str | None = None, symbols: str | None = None,
        equal: Literal["none", "link", "robot"] = "none", collect: Literal["shortest", "velocities"] = "shortest",
        cse: bool = False, rows: Sequence[int] | None = None, coordinates: Literal["body", "space"] = "body",
        urdf: str | None = None
    ) -> Derivation:
        """Derive a quantity in symbols: the equations as a textbook writes them."""
    # A list of numbers is one start. An array's axes are not in its type: it gives Trajectory, or Trajectories for
    # several starts.
    @overload
    def simulate(
        self, theta: Sequence[float], dtheta: Sequence[float] | None = None, duration: float = 2.0,
        steps: int | None = None, *,
        torque: (
            Callable[[float, Array, Array], ArrayLike] | Sequence[float] | Literal["gravity_compensation"] | None
        ) = None,
        method: Literal["auto", "moreau", "rk4", "semi-implicit-euler", "euler", "dopri", "midpoint"] = "auto",
        tolerance: float | None = None, record_every: int = 1, until: _Events | None = None,
        events: _Events | None = None, joint_limits: Literal["report", "ignore", "respect"] = "report",
        gravity: ArrayLike | None = None, slip_speed: float | None = None,
        contacts: Sequence[str | Mapping[str, Any]] | None = None, planes: Sequence[Mapping[str, Any]] | None = None,
        sticking: bool = True, threads: int | None = None
    ) -> Trajectory:
        """Simulate the motion from (θ(0), θ̇(0)) over `duration` seconds, in `steps` equal steps."""
    @overload
    def simulate(
        self, theta: ArrayLike, dtheta: ArrayLike | None = None, duration: float = 2.0, steps: int | None = None, *,
        torque: Callable[[float, Array, Array], ArrayLike] | ArrayLike | Literal["gravity_compensation"] | None = None,
        method: Literal["auto", "moreau", "rk4", "semi-implicit-euler", "euler", "dopri", "midpoint"] = "auto",
        tolerance: float | None = None, record_every: int = 1, until: _Events | None = None,
        events: _Events | None = None, joint_limits: Literal["report", "ignore", "respect"] = "report",
        gravity: ArrayLike | None = None, slip_speed: float | None = None,
        contacts: Sequence[str | Mapping[str, Any]] | None = None, planes: Sequence[Mapping[str, Any]] | None = None,
        sticking: bool = True, threads: int | None = None
    ) -> Any:
        """Simulate the motion from (θ(0), θ̇(0)) over `duration` seconds, in `steps` equal steps."""
    def rollout(
        self, theta: ArrayLike, dtheta: ArrayLike, tau: ArrayLike, step: float,
        method: Literal["rk4", "semi-implicit-euler", "euler", "midpoint"] = "rk4", *, gravity: ArrayLike | None = None,
        threads: int | None = None
    ) -> Rollout:
        """Compute the states of N steps under torques that are constant over each step."""
    def rollout_vjp(
        self, theta: ArrayLike, dtheta: ArrayLike, tau: ArrayLike, step: float, theta_bar: ArrayLike,
        dtheta_bar: ArrayLike, method: Literal["rk4", "semi-implicit-euler", "euler", "midpoint"] = "rk4",
        parameters: bool = False, *, gravity: ArrayLike | None = None, threads: int | None = None
    ) -> tuple[Array, ...]:
        """Compute the vector-Jacobian product of `rollout`, the gradient of a loss L of its states."""
    def report(
        self, path: str | os.PathLike[str], trajectory: Trajectory | None = None, *,
        shapes: str | os.PathLike[str] | None = None, meshes: Literal["visual", "collision", "none"] = "visual",
        mesh_root: str | os.PathLike[str] | None = None, title: str = "simulated", rows: int | None = ...
    ) -> ReportSize:
        """Write the robot, and a motion of it, as one HTML file that needs nothing but a browser."""
    @staticmethod
    def load(
        name_or_path: str | os.PathLike[str] | SupportsRead, *,
        policy: Literal["default", "strict", "lenient"] = "default", floating: bool = False,
        xacro_args: Mapping[str, Any] | None = None, packages: Mapping[str, str | os.PathLike[str]] | None = None
    ) -> Model:
        """Load a robot from a file of any format, or an embedded robot by its name."""
    def compute(self, quantity: str, *args: Any, **kwargs: Any) -> Any:
        """Compute a quantity by any of its names: `compute("M", theta)` is `mass_matrix(theta)`."""
    @staticmethod
    def from_urdf(
        path_or_file: str | os.PathLike[str] | SupportsRead, *,
        policy: Literal["default", "strict", "lenient"] = "default", floating: bool = False,
        xacro_args: Mapping[str, Any] | None = None, packages: Mapping[str, str | os.PathLike[str]] | None = None
    ) -> Model:
        """Load a robot from a URDF, xacro, MJCF or SDFormat file; the format is detected from the root element."""
    @staticmethod
    def from_mjcf(
        path_or_file: str | os.PathLike[str] | SupportsRead, *,
        policy: Literal["default", "strict", "lenient"] = "default", floating: bool = False
    ) -> Model:
        """Alias of `from_urdf` without xacro; the format is detected from the root element."""
    @staticmethod
    def from_urdf_string(
        text: str | bytes, *, name: str = "robot.urdf", policy: Literal["default", "strict", "lenient"] = "default",
        floating: bool = False, xacro_args: Mapping[str, Any] | None = None,
        packages: Mapping[str, str | os.PathLike[str]] | None = None
    ) -> Model:
        """Load a robot from the text of a URDF, xacro, MJCF or SDFormat file."""
    @staticmethod
    def from_screws(
        M_list: ArrayLike, G_list: ArrayLike, S_list: ArrayLike, *, name: str = "robot",
        frames: Literal["relative", "base"] = "relative", axes: Literal["space", "body", "link"] = "space"
    ) -> Model:
        """Make a serial chain from the book's lists: home frames, spatial inertias and screw axes."""
    def compile(self, *quantities: str, frame: str | None = None, threads: int | None = None) -> Model:
        """Return an equal robot that computes these quantities by machine code, at one state and at many."""
    def kernels_only(self) -> Model:
        """Return an equal robot that never uses machine code."""
    def engine(self, quantity: str, frame: str | None = None) -> Engine:
        """Report how a quantity is computed in the robot's own environment, as decided by the calls so far."""
    def screws(self) -> ScrewLists:
        """Return the book's lists of this robot: home frames, screw axes and spatial inertias of its N moving links."""
    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the robot to a file: URDF, MJCF (.xml), SDFormat (.sdf) or mozzi's JSON, by the ending of its name."""
    def with_payload(self, frame: str, inertia: ArrayLike, center_of_mass: ArrayLike | None = None) -> Model:
        """Return a copy with a payload fixed to a frame."""
    def with_frame(self, name: str, on: str, T: ArrayLike) -> Model:
        """Return a copy with an additional frame at a pose relative to an existing one."""
    def with_end_effector(self, frame: str) -> Model:
        """Return a copy with this frame as its end effector, the default of all `frame` arguments."""
    def with_gravity(self, gravity: ArrayLike) -> Model:
        """Return a copy with another gravity."""
    def with_floating_base(self, floating: bool = True) -> Model:
        """Return a copy with a floating or a fixed base."""
    def with_locked_joints(self, positions: Mapping[str, float]) -> Model:
        """Return a copy in which joints are fixed at given positions."""
    def with_rotor(self, name: str, gears: Mapping[str, float], armature: float = 0.0) -> Model:
        """Return a copy with a further rotor that several joints turn together, as in coupled wrists."""
    def to_gpu(self, *, layout: Literal["rows", "columns"] = "rows", device: int = 0) -> Gpu:
        """Return the robot on an NVIDIA GPU, whose methods compute quantities of arrays in the GPU's memory."""
    def play(
        self, *, shapes: str | os.PathLike[str] | None = None,
        meshes: Literal["visual", "collision", "none"] = "visual", mesh_root: str | os.PathLike[str] | None = None
    ) -> Page:
        """Make an interactive page of the robot: drag it, push it, let it fall, edit it, and watch every quantity."""
    def state(self, name: str) -> State:
        """Return the state of this name."""
    def integrate(self, theta: ArrayLike, dtheta: ArrayLike, h: float = 1.0) -> Array:
        """Compute θ ⊕ h θ̇, the positions after h seconds at constant velocities."""
    def difference(self, theta0: ArrayLike, theta1: ArrayLike) -> Array:
        """Compute θ₁ ⊖ θ₀, the constant velocities from θ₀ to θ₁ in one second; the inverse of `integrate`."""
    def with_state(self, name: str, theta: ArrayLike, dtheta: ArrayLike | None = None, *, time: float = 0.0) -> Model:
        """Return a copy with a named state; it replaces a state of this name."""
    def with_start(self, name: str) -> Model:
        """Return a copy whose initial state is this one of its states."""
    def sub_chain(self, start: str, end: str) -> Model:
        """Return the chain between two frames as a robot of its own."""
    def with_constraints(
        self, constraints: str | os.PathLike[str] | Sequence[Mapping[str, Any]], *, motors: Sequence[str] | None = None
    ) -> Model:
        """Return a copy with further constraints, which close loops, pin frames or couple joints."""
    def without_constraints(self) -> Model:
        """Return the tree alone: without constraints, every joint with a motor."""
    def assemble(self, guess: ArrayLike, *, hold: Sequence[str] | None = None) -> Array:
        """Find positions near a guess that satisfy the constraints."""
    def assemble_velocities(self, theta: ArrayLike, guess: ArrayLike, *, hold: Sequence[str] | None = None) -> Array:
        """Find the velocities nearest to a guess that satisfy the constraints, A(θ)θ̇ = 0."""
    def assemble_accelerations(
        self, theta: ArrayLike, dtheta: ArrayLike, guess: ArrayLike, *, hold: Sequence[str] | None = None
    ) -> Array:
        """Find the accelerations nearest to a guess that satisfy the constraints, A(θ)θ̈ + Ȧ(θ, θ̇)θ̇ = 0."""
    def constraint_rank(self, theta: ArrayLike) -> ConstraintRank:
        """Compute the rank of the constraints at θ."""
    def constraint_wrenches(self, theta: ArrayLike, multipliers: ArrayLike) -> dict[str, Array]:
        """Compute the wrenches of the constraints between frames, from the multipliers."""
    def reduce(
        self, theta: ArrayLike, dtheta: ArrayLike, independent: Sequence[str], tip_wrench: ArrayLike | None = None, *,
        gravity: ArrayLike | None = None, applied_wrenches: Mapping[str, ArrayLike] | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None
    ) -> Reduction:
        """Reduce the mechanism's dynamics to the velocities u of independent joints."""
    def constrained_inverse_dynamics(
        self, theta: ArrayLike, dtheta: ArrayLike, ddtheta: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        weights: ArrayLike | None = None, gravity: ArrayLike | None = None,
        applied_wrenches: Mapping[str, ArrayLike] | None = None, base_twist: ArrayLike | None = None,
        base_acceleration: ArrayLike | None = None
    ) -> ConstrainedDynamics:
        """Compute the motors' torques and the multipliers λ of a motion that satisfies the constraints."""
    def constrained_forward_dynamics_derivatives(
        self, theta: ArrayLike, dtheta: ArrayLike, tau: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        gravity: ArrayLike | None = None, applied_wrenches: Mapping[str, ArrayLike] | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None
    ) -> ConstrainedForwardDynamicsDerivatives:
        """Compute the derivatives of θ̈ and λ of `constrained_forward_dynamics` at one state."""
    def jvp(
        self, quantity: str, inputs: Sequence[ArrayLike], tangents: Sequence[ArrayLike | None], *,
        frame: str | None = None, coordinates: Literal["body", "space"] | None = None,
        rows: Sequence[int] | None = None, about: ArrayLike | None = None, tip_wrench: ArrayLike | None = None,
        gravity: ArrayLike | None = None, applied_wrenches: Mapping[str, ArrayLike] | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None,
        parameters: ArrayLike | None = None, parameters_tangent: ArrayLike | None = None, threads: int | None = None
    ) -> tuple[Any, Any]:
        """Compute a quantity and its derivative along a direction, exactly and without a step size."""
    # The quantities: from here on written by `cargo xtask docs`.
    def inverse_dynamics(
        self, theta: ArrayLike, dtheta: ArrayLike, ddtheta: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        gravity: ArrayLike | None = None, applied_wrenches: Mapping[str, ArrayLike] | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Array | None = None,
        threads: int | None = None
    ) -> Array:
        """τ = M(θ)θ̈ + c(θ, θ̇) + g(θ) + JᵀF + f(θ, θ̇), the joint forces of a motion."""
    def forward_dynamics(
        self, theta: ArrayLike, dtheta: ArrayLike, tau: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        gravity: ArrayLike | None = None, applied_wrenches: Mapping[str, ArrayLike] | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Array | None = None,
        threads: int | None = None
    ) -> Array:
        """θ̈ = M⁻¹(τ − c − g − JᵀF − f), the accelerations that joint forces produce."""
    def forward_dynamics_by_mass_matrix(
        self, theta: ArrayLike, dtheta: ArrayLike, tau: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        gravity: ArrayLike | None = None, applied_wrenches: Mapping[str, ArrayLike] | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Array | None = None,
        threads: int | None = None
    ) -> Array:
        """θ̈ = M⁻¹(τ − c − g − JᵀF − f), by composite bodies and the factors of M along the tree."""
    def forward_dynamics_by_inverse_dynamics(
        self, theta: ArrayLike, dtheta: ArrayLike, tau: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        gravity: ArrayLike | None = None, applied_wrenches: Mapping[str, ArrayLike] | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Array | None = None,
        threads: int | None = None
    ) -> Array:
        """θ̈ = M⁻¹(τ − c − g − JᵀF − f), M and h by calls of inverse dynamics."""
    def mass_matrix(
        self, theta: ArrayLike, *, parameters: ArrayLike | None = None, environment: Environment | None = None,
        out: Array | None = None, threads: int | None = None
    ) -> Array:
        """M(θ), symmetric, with the rotors' inertia on its diagonal."""
    def mass_matrix_inverse(
        self, theta: ArrayLike, *, parameters: ArrayLike | None = None, environment: Environment | None = None,
        out: Array | None = None, threads: int | None = None
    ) -> Array:
        """M(θ)⁻¹, the accelerations that a unit of each joint force produces."""
    def mass_matrix_rate(
        self, theta: ArrayLike, dtheta: ArrayLike, *, parameters: ArrayLike | None = None,
        environment: Environment | None = None, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """Ṁ(θ, θ̇) = C + Cᵀ."""
    def coriolis_matrix(
        self, theta: ArrayLike, dtheta: ArrayLike, *, parameters: ArrayLike | None = None,
        environment: Environment | None = None, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """C(θ, θ̇) of the Christoffel symbols: c = Cθ̇, and Ṁ − 2C is skew-symmetric."""
    def velocity_product(
        self, theta: ArrayLike, dtheta: ArrayLike, *, parameters: ArrayLike | None = None,
        environment: Environment | None = None, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """c(θ, θ̇) = Cθ̇, the Coriolis and centripetal forces."""
    def gravity_forces(
        self, theta: ArrayLike, *, gravity: ArrayLike | None = None, parameters: ArrayLike | None = None,
        environment: Environment | None = None, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """g(θ), the joint forces that hold the robot against gravity."""
    def bias_forces(
        self, theta: ArrayLike, dtheta: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        gravity: ArrayLike | None = None, applied_wrenches: Mapping[str, ArrayLike] | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Array | None = None,
        threads: int | None = None
    ) -> Array:
        """h(θ, θ̇) = c + g, with JᵀF and the base's terms where they are given; without friction and springs."""
    def tip_forces(
        self, theta: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        applied_wrenches: Mapping[str, ArrayLike] | None = None, environment: Environment | None = None,
        out: Array | None = None, threads: int | None = None
    ) -> Array:
        """JᵀF of the wrenches that frames apply to the environment."""
    def joint_friction(
        self, dtheta: ArrayLike, *, parameters: ArrayLike | None = None, environment: Environment | None = None,
        out: Array | None = None, threads: int | None = None
    ) -> Array:
        """f(θ̇) = dθ̇ + μ sgn θ̇ of each joint, with sgn 0 = 0."""
    def spring_forces(
        self, theta: ArrayLike, *, parameters: ArrayLike | None = None, environment: Environment | None = None,
        out: Array | None = None, threads: int | None = None
    ) -> Array:
        """f_s(θ) = k(θ − θ₀) of each joint, θ not wrapped; kφ of a ball, φ its rotation vector."""
    def kinetic_energy(
        self, theta: ArrayLike, dtheta: ArrayLike, *, base_twist: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Array | None = None,
        threads: int | None = None
    ) -> Any:
        """½θ̇ᵀMθ̇, of all that moves."""
    def potential_energy(
        self, theta: ArrayLike, *, gravity: ArrayLike | None = None, parameters: ArrayLike | None = None,
        environment: Environment | None = None, out: Array | None = None, threads: int | None = None
    ) -> Any:
        """−Σ m gᵀp + Σ ½k(θ − θ₀)², p seen from the origin of {s}."""
    def forward_kinematics(
        self, theta: ArrayLike, frame: str | None = None, *, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """T_sb(θ), the configuration of a frame {b} seen from {s}."""
    def frame_poses(self, theta: ArrayLike, *, out: Array | None = None, threads: int | None = None) -> Array:
        """T_sb(θ) of all frames, in the order of the model's list."""
    def space_jacobian(
        self, theta: ArrayLike, frame: str | None = None, *, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """J_s(θ) of a frame: its twist in {s} is J_sθ̇, (ω, v)."""
    def body_jacobian(
        self, theta: ArrayLike, frame: str | None = None, *, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """J_b(θ) of a frame: its twist in its own coordinates is J_bθ̇, (ω, v)."""
    def space_jacobian_rate(
        self, theta: ArrayLike, dtheta: ArrayLike, frame: str | None = None, *, out: Array | None = None,
        threads: int | None = None
    ) -> Array:
        """dJ_s/dt of a frame."""
    def body_jacobian_rate(
        self, theta: ArrayLike, dtheta: ArrayLike, frame: str | None = None, *, out: Array | None = None,
        threads: int | None = None
    ) -> Array:
        """dJ_b/dt of a frame."""
    def space_jacobian_derivative(
        self, theta: ArrayLike, frame: str | None = None, *, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """∂J_s/∂θ_j of a frame for each velocity j."""
    def body_jacobian_derivative(
        self, theta: ArrayLike, frame: str | None = None, *, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """∂J_b/∂θ_j of a frame for each velocity j."""
    def frame_acceleration(
        self, theta: ArrayLike, dtheta: ArrayLike, ddtheta: ArrayLike, frame: str | None = None, *,
        out: Array | None = None, threads: int | None = None
    ) -> Array:
        """the classical acceleration of a frame, angular and of its origin, in its own coordinates."""
    def task_space_dynamics(
        self, theta: ArrayLike, dtheta: ArrayLike, frame: str | None = None, tip_wrench: ArrayLike | None = None, *,
        coordinates: Literal["body", "space"] = "body", rows: Sequence[int] | None = None,
        gravity: ArrayLike | None = None, applied_wrenches: Mapping[str, ArrayLike] | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Sequence[Array] | None = None,
        threads: int | None = None
    ) -> TaskSpaceDynamics:
        """Λ and η of 𝓕 = Λ(θ)𝒱̇ + η(θ, 𝒱), the dynamics as the rows of a frame's twist show them."""
    def constrained_forward_dynamics(
        self, theta: ArrayLike, dtheta: ArrayLike, tau: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        gravity: ArrayLike | None = None, applied_wrenches: Mapping[str, ArrayLike] | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Sequence[Array] | None = None,
        threads: int | None = None
    ) -> ConstrainedForwardDynamics:
        """θ̈ and λ of τ = Mθ̈ + c + g + JᵀF + f + Aᵀλ with Aθ̈ + Ȧθ̇ = 0."""
    def constraint_jacobian(self, theta: ArrayLike, *, out: Array | None = None, threads: int | None = None) -> Array:
        """A(θ) of the constraints A(θ)θ̇ = 0."""
    def constraint_bias(
        self, theta: ArrayLike, dtheta: ArrayLike, *, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """Ȧ(θ, θ̇)θ̇ of the constraints: Aθ̈ + Ȧθ̇ = 0."""
    def constraint_residual(self, theta: ArrayLike, *, out: Array | None = None, threads: int | None = None) -> Array:
        """φ(θ), by how much the positions violate the constraints."""
    def constraint_projection(
        self, theta: ArrayLike, *, parameters: ArrayLike | None = None, environment: Environment | None = None,
        out: Array | None = None, threads: int | None = None
    ) -> Array:
        """P(θ) = 1 − Aᵀ(A M⁻¹Aᵀ)⁻¹A M⁻¹: Pτ = P(Mθ̈ + h)."""
    def constraint_impulse(
        self, theta: ArrayLike, dtheta: ArrayLike, *, parameters: ArrayLike | None = None,
        environment: Environment | None = None, out: Sequence[Array] | None = None, threads: int | None = None
    ) -> ConstraintImpulse:
        """θ̇⁺ and Λ of M(θ̇⁺ − θ̇) = −AᵀΛ with Aθ̇⁺ = 0: the velocities after the constraints have begun to act."""
    def inverse_dynamics_derivatives(
        self, theta: ArrayLike, dtheta: ArrayLike, ddtheta: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        gravity: ArrayLike | None = None, applied_wrenches: Mapping[str, ArrayLike] | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Sequence[Array] | None = None,
        threads: int | None = None
    ) -> InverseDynamicsDerivatives:
        """∂τ/∂θ, ∂τ/∂θ̇ and ∂τ/∂θ̈ = M, row i of τ_i; by θ along the velocities."""
    def forward_dynamics_derivatives(
        self, theta: ArrayLike, dtheta: ArrayLike, tau: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        gravity: ArrayLike | None = None, applied_wrenches: Mapping[str, ArrayLike] | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Sequence[Array] | None = None,
        threads: int | None = None
    ) -> ForwardDynamicsDerivatives:
        """θ̈, ∂θ̈/∂θ, ∂θ̈/∂θ̇ and ∂θ̈/∂τ = M⁻¹, row i of θ̈_i; by θ along the velocities."""
    def inverse_dynamics_vjp(
        self, theta: ArrayLike, dtheta: ArrayLike, ddtheta: ArrayLike, x: ArrayLike,
        tip_wrench: ArrayLike | None = None, *, gravity: ArrayLike | None = None,
        applied_wrenches: Mapping[str, ArrayLike] | None = None, base_twist: ArrayLike | None = None,
        base_acceleration: ArrayLike | None = None, parameters: ArrayLike | None = None,
        environment: Environment | None = None, out: Sequence[Array] | None = None, threads: int | None = None
    ) -> InverseDynamicsVjp:
        """xᵀ∂τ/∂θ, xᵀ∂τ/∂θ̇ and xᵀ∂τ/∂θ̈ = Mx, the gradient of xᵀτ; by θ along the velocities."""
    def forward_dynamics_vjp(
        self, theta: ArrayLike, dtheta: ArrayLike, tau: ArrayLike, x: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        gravity: ArrayLike | None = None, applied_wrenches: Mapping[str, ArrayLike] | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Sequence[Array] | None = None,
        threads: int | None = None
    ) -> ForwardDynamicsVjp:
        """xᵀ∂θ̈/∂θ, xᵀ∂θ̈/∂θ̇ and xᵀ∂θ̈/∂τ = M⁻¹x, the gradient of xᵀθ̈; by θ along the velocities."""
    def inverse_dynamics_parameter_vjp(
        self, theta: ArrayLike, dtheta: ArrayLike, ddtheta: ArrayLike, x: ArrayLike,
        tip_wrench: ArrayLike | None = None, *, gravity: ArrayLike | None = None,
        applied_wrenches: Mapping[str, ArrayLike] | None = None, base_twist: ArrayLike | None = None,
        base_acceleration: ArrayLike | None = None, parameters: ArrayLike | None = None,
        environment: Environment | None = None, out: Sequence[Array] | None = None, threads: int | None = None
    ) -> InverseDynamicsParameterVjp:
        """xᵀ∂τ/∂π = xᵀY, and xᵀ∂τ by the joints' placements and axes and by gravity: the gradient of xᵀτ by the
        robot."""
    def forward_dynamics_parameter_vjp(
        self, theta: ArrayLike, dtheta: ArrayLike, tau: ArrayLike, x: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        gravity: ArrayLike | None = None, applied_wrenches: Mapping[str, ArrayLike] | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Sequence[Array] | None = None,
        threads: int | None = None
    ) -> ForwardDynamicsParameterVjp:
        """xᵀ∂θ̈/∂π, and xᵀ∂θ̈ by the joints' placements and axes and by gravity: the gradient of xᵀθ̈ by the robot."""
    def mass_matrix_product_vjp(
        self, theta: ArrayLike, ddtheta: ArrayLike, x: ArrayLike, *, parameters: ArrayLike | None = None,
        environment: Environment | None = None, out: Sequence[Array] | None = None, threads: int | None = None
    ) -> MassMatrixProductVjp:
        """xᵀ∂(M(θ)θ̈)/∂θ along the velocities, and Mx: the gradient of xᵀMθ̈."""
    def energy_gradients(
        self, theta: ArrayLike, dtheta: ArrayLike, *, gravity: ArrayLike | None = None,
        base_twist: ArrayLike | None = None, parameters: ArrayLike | None = None,
        environment: Environment | None = None, out: Sequence[Array] | None = None, threads: int | None = None
    ) -> EnergyGradients:
        """∂𝒦/∂θ, ∂𝒦/∂θ̇ and ∂𝒫/∂θ of the kinetic and potential energy; by θ along the velocities."""
    def frame_twist_vjp(
        self, theta: ArrayLike, dtheta: ArrayLike, w: ArrayLike, frame: str | None = None, *,
        out: Sequence[Array] | None = None, threads: int | None = None
    ) -> FrameTwistVjp:
        """wᵀ∂𝒱_b/∂θ along the velocities, and J_bᵀw: the gradient of wᵀ𝒱_b, the twist of a frame in its own
        coordinates."""
    def frame_acceleration_vjp(
        self, theta: ArrayLike, dtheta: ArrayLike, ddtheta: ArrayLike, w: ArrayLike, frame: str | None = None, *,
        out: Sequence[Array] | None = None, threads: int | None = None
    ) -> FrameAccelerationVjp:
        """wᵀ∂a_b/∂θ along the velocities, wᵀ∂a_b/∂θ̇ and J_bᵀw: the gradient of wᵀa_b, a_b the acceleration of a
        frame."""
    def momentum_vjp(
        self, theta: ArrayLike, dtheta: ArrayLike, w: ArrayLike, *, about: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Sequence[Array] | None = None,
        threads: int | None = None
    ) -> MomentumVjp:
        """wᵀ∂h/∂θ along the velocities, and wᵀ∂h/∂θ̇: the gradient of wᵀh, h the momentum about a point of {s}."""
    def momentum_rate_vjp(
        self, theta: ArrayLike, dtheta: ArrayLike, ddtheta: ArrayLike, w: ArrayLike, *, about: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Sequence[Array] | None = None,
        threads: int | None = None
    ) -> MomentumRateVjp:
        """wᵀ∂ḣ/∂θ along the velocities, wᵀ∂ḣ/∂θ̇ and wᵀ∂ḣ/∂θ̈: the gradient of wᵀḣ, ḣ the rate of the momentum."""
    def gravity_forces_derivative(
        self, theta: ArrayLike, *, gravity: ArrayLike | None = None, parameters: ArrayLike | None = None,
        environment: Environment | None = None, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """∂g/∂θ."""
    def tip_forces_derivative(
        self, theta: ArrayLike, tip_wrench: ArrayLike | None = None, *,
        applied_wrenches: Mapping[str, ArrayLike] | None = None, environment: Environment | None = None,
        out: Array | None = None, threads: int | None = None
    ) -> Array:
        """∂(JᵀF)/∂θ of the wrenches that frames apply to the environment."""
    def mass_matrix_product_derivative(
        self, theta: ArrayLike, x: ArrayLike, *, parameters: ArrayLike | None = None,
        environment: Environment | None = None, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """∂(M(θ)x)/∂θ for a constant x."""
    def center_of_mass(
        self, theta: ArrayLike, *, parameters: ArrayLike | None = None, environment: Environment | None = None,
        out: Array | None = None, threads: int | None = None
    ) -> Array:
        """c, the centre of mass of all that moves, in {s}."""
    def center_of_mass_velocity(
        self, theta: ArrayLike, dtheta: ArrayLike, *, parameters: ArrayLike | None = None,
        environment: Environment | None = None, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """ċ of the centre of mass, in the axes of {s}."""
    def center_of_mass_acceleration(
        self, theta: ArrayLike, dtheta: ArrayLike, ddtheta: ArrayLike, *, parameters: ArrayLike | None = None,
        environment: Environment | None = None, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """c̈ of the centre of mass, in the axes of {s}."""
    def center_of_mass_jacobian(
        self, theta: ArrayLike, *, parameters: ArrayLike | None = None, environment: Environment | None = None,
        out: Array | None = None, threads: int | None = None
    ) -> Array:
        """J of the centre of mass: ċ = Jθ̇, in the axes of {s}."""
    def momentum(
        self, theta: ArrayLike, dtheta: ArrayLike, *, about: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Array | None = None,
        threads: int | None = None
    ) -> Array:
        """h, the momentum (angular, linear) of all that moves, about a point of {s}, in the axes of {s}."""
    def momentum_rate(
        self, theta: ArrayLike, dtheta: ArrayLike, ddtheta: ArrayLike, *, about: ArrayLike | None = None,
        parameters: ArrayLike | None = None, environment: Environment | None = None, out: Array | None = None,
        threads: int | None = None
    ) -> Array:
        """ḣ of the momentum about a fixed point of {s}, along a motion."""
    def centroidal_momentum_matrix(
        self, theta: ArrayLike, *, parameters: ArrayLike | None = None, environment: Environment | None = None,
        out: Array | None = None, threads: int | None = None
    ) -> Array:
        """A_G(θ), angular rows first: h_G = A_Gθ̇ is the momentum about the centre of mass."""
    def centroidal_momentum_bias(
        self, theta: ArrayLike, dtheta: ArrayLike, *, parameters: ArrayLike | None = None,
        environment: Environment | None = None, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """Ȧ_Gθ̇, of ḣ_G = A_Gθ̈ + Ȧ_Gθ̇."""
    def regressor(
        self, theta: ArrayLike, dtheta: ArrayLike, ddtheta: ArrayLike, *, gravity: ArrayLike | None = None,
        base_twist: ArrayLike | None = None, base_acceleration: ArrayLike | None = None,
        environment: Environment | None = None, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """Y(θ, θ̇, θ̈): τ = Yπ + JᵀF, with π the robot's parameters."""
    def energy_regressors(
        self, theta: ArrayLike, dtheta: ArrayLike, *, gravity: ArrayLike | None = None,
        base_twist: ArrayLike | None = None, environment: Environment | None = None, out: Sequence[Array] | None = None,
        threads: int | None = None
    ) -> EnergyRegressors:
        """the rows that give the kinetic and the potential energy of the parameters π."""
    # End of the quantities.
    @property
    def constraints(self) -> list[dict[str, Any]]:
        """Constraints in the form of `with_constraints`; anchors have a matrix `T` (4, 4) in their frame."""
    @property
    def motors(self) -> list[str] | None:
        """Names of the joints that have motors, for `constrained_inverse_dynamics`; None for all."""
    @property
    def constraint_row_names(self) -> list[str]:
        """Names of the constraints' rows: those of A and of the multipliers."""
    @property
    def states(self) -> dict[str, State]:
        """The states that the robot's file names, such as MuJoCo's keyframes: `{name: State}`, in its order."""
    @property
    def start(self) -> State:
        """The initial state, a `State`: the one that the file names, such as MuJoCo's `qpos0`, else rest at 0."""
    @property
    def neutral_configuration(self) -> Array:
        """Positions with all joints at 0 and a floating base at {s}, shape (nq,)."""
    @property
    def frames(self) -> list[str]:
        """Names of all frames: the links, and the frames that were added."""
    @property
    def name(self) -> str:
        """The robot's name."""
    @property
    def joint_names(self) -> list[str]:
        """Names of the independent joints, in the order of θ."""
    @property
    def position_names(self) -> list[str]:
        """Names of the nq positions: a joint's own name; `joint.qw` and so on for quaternions."""
    @property
    def velocity_names(self) -> list[str]:
        """Names of the n velocities and forces: a joint's own name; `joint.wx` and so on for balls."""
    @property
    def position_limits(self) -> Array:
        """Lowest and highest position of each joint, shape (joints, 2), rad or m; infinite without a limit."""
    @property
    def parameter_names(self) -> list[str]:
        """Names of `parameters`."""
    @property
    def nq(self) -> int:
        """Number of positions: n, plus one for each quaternion, of a floating base, a ball or a free joint."""
    @property
    def parameters(self) -> Array:
        """A copy of the inertial parameters π: ten numbers a body, five a joint; see `regressor`."""
    @property
    def link_names(self) -> list[str]:
        """Names of the links, in the order of the file."""
    @property
    def n(self) -> int:
        """Number of velocities: one of each independent joint, three of a ball, six of a free joint and a floating
        base."""
    @property
    def velocity_limits(self) -> Array:
        """Maximum speed of each joint, shape (joints,), rad/s or m/s; infinite without a limit."""
    @property
    def gravity(self) -> Array:
        """Gravity in {s}, shape (3,), m/s²."""
    @property
    def is_floating(self) -> bool:
        """True if the base is floating."""
    @property
    def end_effector(self) -> str | None:
        """Name of the end effector; None if there is no obvious one."""
    @property
    def mass(self) -> float:
        """Total mass of the moving links, kg."""
    @property
    def effort_limits(self) -> Array:
        """Maximum torque or force of each joint, shape (joints,), N m or N; infinite without a limit."""

class GpuKernel:
    """A quantity's kernel on a device."""
    def __init__(
        self, model: Model, quantity: str, frame: str | None, dtype: str, layout: str, packed: bool, device: int,
        packages: list[str]
    ) -> None: ...
    @property
    def inputs(self) -> list[tuple[str, int]]:
        """Names and lengths of the inputs."""
    @property
    def outputs(self) -> list[tuple[str, list[int]]]:
        """Names and shapes of the outputs."""
    def launch(self, inputs: list[int], outputs: list[int], states: int, stream: int) -> None:
        """Launches the kernel on arrays at these addresses, whose lengths `mozzi._gpu` has checked."""

class GpuRollout:
    """Steps of many robots on a device."""
    def __init__(self, model: Model, dtype: str, layout: str, device: int, packages: list[str]) -> None: ...
    def launch(
        self, state: list[int], tau: int | None, feedback: list[int] | None, tables: list[int], step: float, steps: int,
        every: int, robots: int, stream: int
    ) -> None:
        """Launches the steps on arrays at these addresses, whose lengths `mozzi._gpu` has checked."""

class InverseKinematics:
    """Inverse kinematics: joint positions θ that place a frame at a desired pose, position or orientation."""
    def __init__(
        self, model: Model, frame: str | None = None, *,
        method: Literal["levenberg-marquardt", "newton"] = "levenberg-marquardt", angle_tolerance: float = 1e-8,
        distance_tolerance: float = 1e-8, iterations: int = 60, starts: int = 200, seed: int = 0, length: float = 1.0,
        limits: bool = True
    ) -> None: ...
    def solve(
        self, guess: ArrayLike, *, pose: ArrayLike | None = None, position: ArrayLike | None = None,
        orientation: ArrayLike | None = None, near: ArrayLike | None = None,
        minimize: Callable[[Array], tuple[float, ArrayLike]] | None = None, must_reach: bool = False,
        threads: int | None = None
    ) -> Solution:
        """Find joint positions that reach a goal, for one target or for many."""
    @property
    def model(self) -> Model:
        """The robot."""
    @property
    def frame(self) -> str:
        """The frame to be placed."""

class Profile:
    """A time scaling s(t) of a path, from s = 0 at t = 0 to s = 1 at the end (Modern Robotics, section 9.2.2)."""
    @staticmethod
    def linear(duration: float) -> Profile:
        """Make s = t/T, which starts and stops at once; for paths with s in proportion to time."""
    @staticmethod
    def cubic(duration: float) -> Profile:
        """Make s = 3(t/T)² − 2(t/T)³, at rest at both ends."""
    @staticmethod
    def quintic(duration: float) -> Profile:
        """Make s = 10(t/T)³ − 15(t/T)⁴ + 6(t/T)⁵, at rest and with s̈ = 0 at both ends."""
    @staticmethod
    def trapezoidal(speed: float, acceleration: float) -> Profile:
        """Make a profile of constant acceleration, constant speed and constant deceleration."""
    @staticmethod
    def trapezoidal_in(duration: float, part: float) -> Profile:
        """Make a trapezoidal profile of this duration."""
    def in_time(self, duration: float) -> Profile:
        """Return the profile scaled to another duration: ṡ scales with the ratio of the durations, s̈ with its
        square."""
    def at(self, t: ArrayLike) -> Progress:
        """Evaluate s, ṡ and s̈ at one time or at many."""
    def __eq__(self, other: object, /) -> bool: ...
    @property
    def duration(self) -> float:
        """Duration T, s."""

class Path:
    """A path of a robot's joint positions, θ(s) for s from 0 to 1: a `Line`, a `Spline` or a `Cartesian`."""
    def at(self, s: ArrayLike) -> PathPoint:
        """Evaluate θ, θ′ and θ″ at one place of the path or at many."""
    def time_optimal(
        self, *, velocity: ArrayLike | None = None, acceleration: ArrayLike | None = None,
        torque: ArrayLike | None = None, intervals: int = 200
    ) -> Profile:
        """Find the fastest profile through this path under limits, at rest at both ends (Pham and Pham 2018)."""
    def stretched(
        self, profile: Profile, *, velocity: ArrayLike | None = None, acceleration: ArrayLike | None = None,
        torque: ArrayLike | None = None, samples: int = 600
    ) -> Profile:
        """Scale a profile to the shortest duration that keeps the limits of `time_optimal`."""
    @property
    def model(self) -> Model:
        """The robot that moves along the path."""

class Line(Path):
    """Straight line of the joints from θ₀ to θ₁, θ₀ ⊕ s(θ₁ ⊖ θ₀); a floating base moves along a screw."""
    def __init__(self, model: Model, start: ArrayLike, goal: ArrayLike) -> None: ...

class Spline(Path):
    """Cubic spline of the joints through via points."""
    def __init__(
        self, model: Model, points: ArrayLike, s: ArrayLike | None = None, *,
        ends: Literal["natural", "at rest"] = "natural"
    ) -> None: ...

class Cartesian(Path):
    """Path of the joints along a frame's path to a goal pose: a spline through solutions of inverse kinematics."""
    def __init__(
        self, model: Model, start: ArrayLike, goal: ArrayLike, frame: str | None = None, *,
        shape: Literal["screw", "straight"] = "screw", tolerance: float = 1e-6
    ) -> None: ...
    @property
    def deviation(self) -> float:
        """Largest deviation of the frame from its path, rad and m, evaluated halfway between the spline's points."""
    @property
    def knots(self) -> int:
        """Number of solutions of inverse kinematics that the spline interpolates."""

def poses_between(
    start: ArrayLike, goal: ArrayLike, s: ArrayLike, *, shape: Literal["screw", "straight"] = "screw"
) -> Array:
    """Interpolate between two poses of a frame (Modern Robotics, section 9.2.1)."""

class Reference:
    """A desired motion of a robot, θ_d, θ̇_d and θ̈_d over time, which a controller follows."""
    def at(self, t: ArrayLike) -> Desired:
        """Evaluate θ_d, θ̇_d and θ̈_d at one time or at many."""
    @property
    def duration(self) -> float:
        """Duration, s; the motion begins at 0."""
    @property
    def model(self) -> Model:
        """The robot that moves."""

class Timed(Reference):
    """A path with a profile: θ̇ = θ′ṡ, θ̈ = θ″ṡ² + θ′s̈."""
    def __init__(self, path: Path, profile: Profile) -> None: ...
    @property
    def path(self) -> Path:
        """The path, θ(s)."""
    @property
    def profile(self) -> Profile:
        """The profile, s(t)."""

class Recorded(Reference):
    """A motion from a table of times, of any robot."""
    def __init__(
        self, model: Model, t: ArrayLike, theta: ArrayLike, dtheta: ArrayLike | None = None,
        ddtheta: ArrayLike | None = None
    ) -> None: ...

class Hold(Reference):
    """Constant positions, at rest."""
    def __init__(self, model: Model, theta: ArrayLike) -> None: ...

class OfJoints(Reference):
    """A motion of the joints of a robot with a floating base."""
    def __init__(self, model: Model, joints: Reference, pose: ArrayLike | None = None) -> None: ...

class Controller:
    """A controller: the motors' τ that make a robot follow a reference (Modern Robotics, chapter 11)."""
    def __call__(self, t: ArrayLike, theta: ArrayLike, dtheta: ArrayLike) -> Array:
        """Compute the motors' τ at one state or at many."""
    @property
    def model(self) -> Model:
        """The controller's model of the robot."""
    @property
    def reference(self) -> Reference:
        """The reference that the controller follows."""

class PdGravity(Controller):
    """PD control with gravity compensation, τ = g(θ) + k(θ − θ₀) + K_p e + K_d ė (Modern Robotics, section 11.4.2)."""
    def __init__(self, model: Model, reference: Reference, *, p: ArrayLike, d: ArrayLike) -> None: ...

class ComputedTorque(Controller):
    """Computed torque, τ = M(θ)(θ̈_d + K_d ė + K_p e) + h(θ, θ̇) + f(θ, θ̇) (Modern Robotics 11.37)."""
    def __init__(self, model: Model, reference: Reference, *, p: ArrayLike, d: ArrayLike) -> None: ...

class TaskSpace(Controller):
    """Task-space control of a frame, τ = Jᵀ(Λ(a + K_d 𝒱_e + K_p X_e) + η) (Modern Robotics, section 11.4.3)."""
    def __init__(
        self, model: Model, reference: Reference, frame: str | None = None, *, p: ArrayLike, d: ArrayLike,
        posture_p: ArrayLike | None = None, posture_d: ArrayLike | None = None
    ) -> None: ...

class Impedance(Controller):
    """Impedance control of a frame, τ = Jᵀ(Λa + η + B𝒱_e + KX_e) (Modern Robotics, section 11.7; Hogan 1985)."""
    def __init__(
        self, model: Model, reference: Reference, frame: str | None = None, *, stiffness: ArrayLike, damping: ArrayLike,
        posture_p: ArrayLike | None = None, posture_d: ArrayLike | None = None
    ) -> None: ...

class Standing(Controller):
    """Standing on feet, with contact forces within their friction cones (Kuindersma et al. 2016)."""
    def __init__(
        self, model: Model, reference: Reference, feet: Sequence[str | Mapping[str, Any]], *, p: ArrayLike, d: ArrayLike
    ) -> None: ...

class Saturated:
    """Motors with effort limits, which a controller or any function of (t, θ, θ̇) drives."""
    def __init__(
        self, model: Model, torque: Callable[[float, Array, Array], ArrayLike],
        policy: Literal["ignore", "report", "respect"] = "respect"
    ) -> None: ...
    def __call__(self, t: ArrayLike, theta: ArrayLike, dtheta: ArrayLike) -> Array:
        """Compute the motors' τ within the limits, at one state or at many."""
    @property
    def overloads(self) -> list[Overload]:
        """Joints whose demanded torque exceeded the limit since construction: a list of `Overload`."""
    @property
    def model(self) -> Model:
        """The robot whose effort limits are used."""

def tracking_error(motion: Trajectory | Trajectories, reference: Reference) -> TrackingError:
    """Compute the tracking error e = θ_d ⊖ θ of each joint over a simulated motion, or over many."""

class Pinocchio:
    """Conversions to and from Pinocchio, made by `conventions.Pinocchio`."""
    def __init__(self, model: Model, joints: tuple[list[str], list[int]] | None) -> None: ...
    def mass_matrix(self, M: ArrayLike) -> Array:
        """Convert a mass matrix, shape (..., n, n), to Pinocchio's."""
    def from_mass_matrix(self, M: ArrayLike) -> Array:
        """Convert Pinocchio's mass matrix to mozzi's, shape (..., n, n)."""
    def jacobian(self, J: ArrayLike) -> Array:
        """Convert a Jacobian, shape (..., 6, n), angular rows first, to Pinocchio's, linear rows first."""
    def configuration(self, theta: ArrayLike) -> Array:
        """Convert positions θ, shape (..., nq), to Pinocchio's q."""
    def from_configuration(self, q: ArrayLike) -> Array:
        """Convert Pinocchio's q to positions θ, shape (..., nq)."""
    def velocity(self, dtheta: ArrayLike) -> Array:
        """Convert velocities θ̇, shape (..., n), to Pinocchio's v."""
    def from_velocity(self, v: ArrayLike) -> Array:
        """Convert Pinocchio's v to velocities θ̇, shape (..., n)."""
    def acceleration(self, ddtheta: ArrayLike) -> Array:
        """Convert accelerations θ̈, shape (..., n), to Pinocchio's a."""
    def from_acceleration(self, a: ArrayLike) -> Array:
        """Convert Pinocchio's a to accelerations θ̈, shape (..., n)."""
    def force(self, tau: ArrayLike) -> Array:
        """Convert forces τ, shape (..., n), to Pinocchio's tau."""
    def from_force(self, tau: ArrayLike) -> Array:
        """Convert Pinocchio's tau to forces τ, shape (..., n)."""
    @property
    def nq(self) -> int:
        """Number of entries of Pinocchio's q."""
    @property
    def joints(self) -> list[int]:
        """Index of mozzi's joint for each of Pinocchio's joints."""

class MuJoCo:
    """Conversions to and from MuJoCo, made by `conventions.MuJoCo`."""
    def __init__(self, model: Model, joints: list[str] | None) -> None: ...
    def configuration(self, theta: ArrayLike) -> Array:
        """Convert positions θ, shape (..., nq), to MuJoCo's qpos."""
    def from_configuration(self, qpos: ArrayLike) -> Array:
        """Convert MuJoCo's qpos to positions θ, shape (..., nq)."""
    def velocity(self, theta: ArrayLike, dtheta: ArrayLike) -> Array:
        """Convert velocities θ̇, shape (..., n), at θ to MuJoCo's qvel."""
    def from_velocity(self, qpos: ArrayLike, qvel: ArrayLike) -> Array:
        """Convert MuJoCo's qvel to velocities θ̇, shape (..., n)."""
    def acceleration(self, theta: ArrayLike, dtheta: ArrayLike, ddtheta: ArrayLike) -> Array:
        """Convert accelerations θ̈, shape (..., n), at θ and θ̇ to MuJoCo's qacc."""
    def from_acceleration(self, qpos: ArrayLike, qvel: ArrayLike, qacc: ArrayLike) -> Array:
        """Convert MuJoCo's qacc to accelerations θ̈, shape (..., n)."""
    def force(self, theta: ArrayLike, tau: ArrayLike) -> Array:
        """Convert forces τ, shape (..., n), at θ to MuJoCo's qfrc; for h see `bias_forces`."""
    def from_force(self, qpos: ArrayLike, qfrc: ArrayLike) -> Array:
        """Convert MuJoCo's qfrc to forces τ, shape (..., n)."""
    def bias_forces(self, theta: ArrayLike, dtheta: ArrayLike, M: ArrayLike, h: ArrayLike) -> Array:
        """Convert h, shape (..., n), at θ and θ̇ to MuJoCo's qfrc_bias, with mozzi's M."""
    def from_bias_forces(self, qpos: ArrayLike, qvel: ArrayLike, M: ArrayLike, qfrc_bias: ArrayLike) -> Array:
        """Convert MuJoCo's qfrc_bias to h, shape (..., n), with mozzi's M."""
    def mass_matrix(self, theta: ArrayLike, M: ArrayLike) -> Array:
        """Convert a mass matrix, shape (..., n, n), at θ to MuJoCo's."""
    def from_mass_matrix(self, qpos: ArrayLike, M: ArrayLike) -> Array:
        """Convert MuJoCo's mass matrix to mozzi's, shape (..., n, n)."""
    @property
    def joints(self) -> list[int]:
        """Index of mozzi's joint for each of MuJoCo's joints, without mimic joints."""

class Derivation:
    """A quantity of a robot in symbols, compared with its kernel: text by ``print``, a formula in notebooks."""
    @property
    def quantity(self) -> str:
        """Name of the quantity."""
    @property
    def values(self) -> dict[str, float]:
        """Numbers of the file by the names of the symbols that occur: `{symbol: value}`."""
    @property
    def operations(self) -> tuple[int, int, int]:
        """Number of additions, of products, and of different sines and cosines in the printed equations."""
    def _repr_latex_(self) -> str: ...
    def latex(self) -> str:
        """Return the equations as LaTeX with amsmath."""
    def markdown(self) -> str:
        """Return the equations as Markdown with LaTeX formulas and a table of the symbols."""
    def python(self) -> str:
        """Return the text of a Python function of NumPy arrays."""
    def matlab(self) -> str:
        """Return the text of a MATLAB function."""
    def julia(self) -> str:
        """Return the text of a Julia function."""
    def sympy(self) -> Any:
        """Return the equations as SymPy's expression or matrix, with exact numbers. Needs SymPy."""
