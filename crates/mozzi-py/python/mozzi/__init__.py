"""Dynamics of open-chain robots, in the screw notation of Lynch and Park, *Modern Robotics*.

Six-vectors are angular first: twists (ω, v), wrenches (m, f). SI units. What the robot applies to the environment is positive.
"""

from . import _quantities, conventions, models, modern_robotics
from ._compare import Comparison, compare
from ._mozzi import DivergedError, LoadError, LoadWarning, Model, SingularError, __version__
from ._quantities import *
from ._results import (
    BaseParameters,
    ClosedForm,
    Engine,
    NewtonEuler,
    ScrewLists,
    Trajectories,
    Trajectory,
)

__all__ = [
    "BaseParameters",
    "ClosedForm",
    "Comparison",
    "DivergedError",
    "Engine",
    "LoadError",
    "LoadWarning",
    "Model",
    "NewtonEuler",
    "ScrewLists",
    "SingularError",
    "Trajectories",
    "Trajectory",
    "__version__",
    "compare",
    "conventions",
    "models",
    "modern_robotics",
]
__all__ += _quantities.__all__
