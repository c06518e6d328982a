"""Robot dynamics in the screw notation of Lynch and Park, *Modern Robotics*.

Six-vectors are angular first: twists (ω, v), wrenches (m, f). SI units. Forces of the robot on the environment are
positive.
"""

from typing import TYPE_CHECKING

from . import _quantities, controllers, conventions, models, modern_robotics, trajectories
from ._compare import Comparison, compare
from ._environment import Environment
from ._identify import Excitation, Forces, Identification, Verdict, Weighed, excite, identify
from ._mozzi import (
    Derivation,
    DivergedError,
    DynamicsWarning,
    InverseKinematics,
    LoadError,
    LoadWarning,
    Model,
    MotionError,
    SingularError,
    __version__,
)
from ._names import listed as _listed
from ._names import missing as _missing
from ._notebook import Page
from ._quantities import *
from ._results import (
    BaseParameters,
    ClosedForm,
    Closing,
    ConstrainedDynamics,
    ConstrainedForwardDynamicsDerivatives,
    ConstraintRank,
    Engine,
    LimitReached,
    NewtonEuler,
    Occurrence,
    Reduction,
    ReportSize,
    Rollout,
    ScrewLists,
    Solution,
    State,
    Trajectories,
    Trajectory,
)

__all__ = [
    "BaseParameters",
    "ClosedForm",
    "Closing",
    "Comparison",
    "ConstrainedDynamics",
    "ConstrainedForwardDynamicsDerivatives",
    "ConstraintRank",
    "Derivation",
    "DivergedError",
    "DynamicsWarning",
    "Engine",
    "Environment",
    "Excitation",
    "Forces",
    "Identification",
    "InverseKinematics",
    "LimitReached",
    "LoadError",
    "LoadWarning",
    "Model",
    "MotionError",
    "NewtonEuler",
    "Occurrence",
    "Page",
    "Reduction",
    "ReportSize",
    "Rollout",
    "ScrewLists",
    "SingularError",
    "Solution",
    "State",
    "Trajectories",
    "Trajectory",
    "Verdict",
    "Weighed",
    "__version__",
    "compare",
    "controllers",
    "conventions",
    "excite",
    "identify",
    "models",
    "modern_robotics",
    "trajectories",
]
__all__ += _quantities.__all__

if not TYPE_CHECKING:  # for which every name would exist
    _MEANT = {
        "load": "mozzi.Model.load(path)",
        "load_model": "mozzi.Model.load(path)",
        "open": "mozzi.Model.load(path)",
        "buildModelFromUrdf": "mozzi.Model.from_urdf(path)",
        "buildModelFromXML": "mozzi.Model.from_urdf_string(text)",
        "buildModelFromMJCF": "mozzi.Model.from_mjcf(path)",
        "MjModel": "mozzi.Model.from_mjcf(path)",
        "robots": "mozzi.models: ur5(), panda(), …, or mozzi.Model.load(name)",
        "simulate": "mozzi.Model.simulate(theta, dtheta, duration, steps)",
        "ik": "mozzi.InverseKinematics(model, frame)",
        "inverse_kinematics": "mozzi.InverseKinematics(model, frame)",
        "rnea": "mozzi.Model.inverse_dynamics(theta, dtheta, ddtheta)",
        "inverse_dynamics": "mozzi.Model.inverse_dynamics(theta, dtheta, ddtheta)",
        "aba": "mozzi.Model.forward_dynamics(theta, dtheta, tau)",
        "forward_dynamics": "mozzi.Model.forward_dynamics(theta, dtheta, tau)",
        "crba": "mozzi.Model.mass_matrix(theta)",
        "mass_matrix": "mozzi.Model.mass_matrix(theta)",
        "fk": "mozzi.Model.forward_kinematics(theta, frame)",
        "forward_kinematics": "mozzi.Model.forward_kinematics(theta, frame)",
    }

    def __getattr__(name: str) -> object:
        """The name that was meant, for one that does not exist."""
        raise _missing("mozzi", name, _MEANT)

    __dir__ = _listed(globals())
