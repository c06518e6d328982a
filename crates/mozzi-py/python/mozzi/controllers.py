"""Controllers: motors that follow a ``trajectories.Reference`` (Modern Robotics, chapter 11).

Each is called as ``controller(t, theta, dtheta)``, at one state or at many, and ``Model.simulate`` takes it as
``torque``. The controller's model may differ from the simulated robot.

==================  ==========================================  ============================
controller          τ                                           error for an exact model
==================  ==========================================  ============================
``PdGravity``       g(θ) + K_p e + K_d ė                        goes to 0 where the reference rests
``ComputedTorque``  M(θ)(θ̈_d + K_d ė + K_p e) + h(θ, θ̇)         ë + K_d ė + K_p e = 0
``TaskSpace``       Jᵀ(Λ(a + K_d 𝒱_e + K_p X_e) + η)            𝒱̇_e + K_d 𝒱_e + K_p X_e = 0
``Impedance``       Jᵀ(Λa + η + B𝒱_e + KX_e)                    Λ𝒱̇_e + B𝒱_e + KX_e = 𝓕
``Standing``        Mθ̈ + h + Jᵀf, f within friction cones        as near to ``ComputedTorque`` as feet allow
==================  ==========================================  ============================

with e = θ_d ⊖ θ, X_e = log(T⁻¹T_d), 𝒱_e = [Ad_{T⁻¹T_d}]𝒱_d − 𝒱, and 𝓕 the wrench that the frame applies to the
environment. ``ComputedTorque``, ``TaskSpace`` and ``Impedance`` add the forces of friction and springs, which h and η
lack, ``PdGravity`` those of springs. ``Saturated`` clamps any of them to the motors' effort limits.

>>> import mozzi
>>> from mozzi.controllers import ComputedTorque, Saturated, tracking_error
>>> from mozzi.trajectories import Line, Profile, Timed
>>> ur5 = mozzi.models.ur5()
>>> start, goal = [0.3, -1.4, 1.6, -0.6, 0.9, 0.5], [1.1, -0.9, 1.0, -0.1, 1.4, -0.3]
>>> motion = Timed(Line(ur5, start, goal), Profile.quintic(1.2))
>>> motors = Saturated(ur5, ComputedTorque(ur5, motion, p=400.0, d=40.0))
>>> loaded = ur5.with_payload("tool0", 2.0)  # a payload that is not in the controller's model
>>> followed = loaded.simulate(start, [0.0] * 6, 1.2, 300, torque=motors)
>>> bool(1e-3 < tracking_error(followed, motion).worst < 0.3)
True
"""

from ._mozzi import ComputedTorque, Controller, Impedance, PdGravity, Saturated, Standing, TaskSpace, tracking_error
from ._results import Overload, TrackingError

__all__ = [
    "ComputedTorque",
    "Controller",
    "Impedance",
    "Overload",
    "PdGravity",
    "Saturated",
    "Standing",
    "TaskSpace",
    "TrackingError",
    "tracking_error",
]
