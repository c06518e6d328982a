"""Dynamics of open-chain robots, in the screw notation of Lynch and Park, *Modern Robotics*.

Six-vectors are angular first: twists (ω, v), wrenches (m, f). SI units. What the robot applies to the environment is positive.
"""

from . import conventions, models, modern_robotics
from ._compare import Comparison, compare
from ._mozzi import DivergedError, LoadError, LoadWarning, Model, SingularError, __version__
from ._results import (
    BaseParameters,
    ClosedForm,
    EnergyRegressors,
    ForwardDynamicsDerivatives,
    InverseDynamicsDerivatives,
    NewtonEuler,
    ScrewLists,
    TaskSpaceDynamics,
    Trajectories,
    Trajectory,
)

__all__ = [
    "BaseParameters",
    "ClosedForm",
    "Comparison",
    "DivergedError",
    "EnergyRegressors",
    "ForwardDynamicsDerivatives",
    "InverseDynamicsDerivatives",
    "LoadError",
    "LoadWarning",
    "Model",
    "NewtonEuler",
    "ScrewLists",
    "SingularError",
    "TaskSpaceDynamics",
    "Trajectories",
    "Trajectory",
    "__version__",
    "compare",
    "conventions",
    "models",
    "modern_robotics",
]
