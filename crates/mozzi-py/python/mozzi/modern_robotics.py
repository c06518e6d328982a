"""Functions of the Modern Robotics package (``modern_robotics`` 1.1.1 on PyPI) by their names, computed by mozzi.

``import mozzi.modern_robotics as mr`` in place of ``import modern_robotics as mr``: names, order of arguments and
results are the package's. Lists are converted at every call. For more than a few calls on one robot,
``mozzi.Model.from_screws`` is faster and has more functions.

Differences for unusual input:

- A screw axis that is not unit: θ is in units of 1/‖ω‖, as in the package. A column of zeros is a joint without
  effect.
- ``NearZero`` is the package's, 10⁻⁶. Exponentials and logarithms do not round at it: rotations by less than 10⁻⁶ rad
  are computed, where the package uses the identity. So results differ by up to 10⁻⁶ there; mozzi's are exact.
- Logarithms near half a turn keep all digits; the package's arc cosine loses up to half of them, or rounds to the
  identity. At half a turn the axis has the package's sign.
- A matrix within 10⁻³ of a rotation (truncated digits) is replaced by the nearest rotation; the package uses it as
  given. Other matrices, or a last row other than 0, 0, 0, 1, are refused by logarithms, adjoints and robots.
- A spatial inertia of an invalid form (not symmetric, or 𝒢 other than [[I, [mc]], [−[mc], m]]) is refused. Negative
  masses and moments are used as given, as in the package.
- Exponentials refuse a matrix that is not [ω] or [V] within 10⁻³, such as a rotation; the package takes three or six of
  its entries.
- Lists longer than θ are truncated, as in the package; shorter ones are refused. ``IKinBody`` and ``IKinSpace`` require
  a guess with one number for each screw.
- A singular mass matrix raises ``numpy.linalg.LinAlgError``, also if rounding hides it from the package's inverse.
- ``TransToRp`` and ``RotInv`` give views of new arrays, integers stay integers where the package keeps them.
- ``IKinBody`` and ``IKinSpace`` take at most 20 steps of Newton's method from the guess, without limits, as in the
  package, and return the last step's θ if they do not converge. ``mozzi.InverseKinematics`` keeps limits, tries other
  starts, and returns the best θ.
- Time scalings continue as polynomials before 0 and after T, as in the package; ``mozzi.trajectories.Profile`` rests
  there.

These arguments have one meaning in all functions. SI units; six-vectors are angular first.

Parameters
----------
R, mat : array_like, shape (3, 3)
    A rotation matrix; ``mat`` is any matrix, (3, 3) or (4, 4).
p : array_like, shape (3,)
    A position, m.
T, M, Xstart, Xend : array_like, shape (4, 4)
    Poses; M is the end effector's at θ = 0.
omg, expc3, V, expc6 : array_like, shapes (3,), (3,), (6,) and (6,)
    ω, ω̂θ, a twist (ω, v), and Sθ.
so3mat, se3mat : array_like, shapes (3, 3) and (4, 4)
    [ω] and [V].
z : float
    Any number.
q, s, h : array_like, shapes (3,) and (3,), and float
    A point on a screw axis, its unit vector, and its pitch.
Slist, Blist : array_like, shape (6, n)
    Screw axes (ω, v), one a column, in the space frame, and in the end effector's.
Mlist, Mtildelist : array_like, shape (n + 1, 4, 4)
    Frames of the links and the end effector, each in the frame before it; the tilde marks the controller's model.
Glist, Gtildelist : array_like, shape (n, 6, 6)
    Spatial inertias of the links.
thetalist, dthetalist, ddthetalist, taulist, thetalist0 : array_like, shape (n,)
    θ, θ̇, θ̈, τ, and a guess of θ: rad or m, and N m or N.
thetalistd, dthetalistd, ddthetalistd, eint : array_like, shape (n,)
    The desired θ, θ̇ and θ̈, and the integral of the error.
thetamat, dthetamat, ddthetamat, taumat, thetamatd, dthetamatd, ddthetamatd : array_like, shape (N, n)
    Rows of θ, θ̇, θ̈ and τ, and of the desired θ, θ̇ and θ̈.
thetastart, thetaend : array_like, shape (n,)
    First and last θ.
g, gtilde : array_like, shape (3,)
    Gravity, m/s².
Ftip, Ftipmat : array_like, shapes (6,) and (N, 6)
    Wrench (m, f) that the end effector applies, in its own frame, and rows of it.
eomg, ev : float
    Tolerances: rad, m.
Tf, t, dt : float
    Duration, time and time step, s.
N, method, intRes : int
    Number of points; 3 for the cubic time scaling, else quintic; Euler steps in one time step.
Kp, Ki, Kd : float
    Gains of the controller.
"""

import importlib
from typing import Any

import numpy as np

from ._mozzi import _modern_robotics as _compiled
from ._names import listed as _listed

__all__ = [
    "AxisAng3", "AxisAng6", "Adjoint", "CartesianTrajectory", "ComputedTorque", "CubicTimeScaling", "DistanceToSE3",
    "DistanceToSO3", "EndEffectorForces", "EulerStep", "FKinBody", "FKinSpace", "ForwardDynamics",
    "ForwardDynamicsTrajectory", "GravityForces", "IKinBody", "IKinSpace", "InverseDynamics",
    "InverseDynamicsTrajectory", "JacobianBody", "JacobianSpace", "JointTrajectory", "MassMatrix", "MatrixExp3",
    "MatrixExp6", "MatrixLog3", "MatrixLog6", "NearZero", "Normalize", "ProjectToSE3", "ProjectToSO3",
    "QuinticTimeScaling", "RotInv", "RpToTrans", "ScrewToAxis", "ScrewTrajectory", "SimulateControl", "TestIfSE3",
    "TestIfSO3", "TransInv", "TransToRp", "VecTose3", "VecToso3", "VelQuadraticForces", "ad", "se3ToVec", "so3ToVec",
]  # fmt: skip

__dir__ = _listed(globals())

_FAR = 1e9  # the distance of what is no rotation at all, as in the package


# Helpers -------------------------------------------------------------------------------------------------------------


def NearZero(z: Any) -> Any:
    """Return True if |z| < 10⁻⁶."""
    return abs(z) < 1e-6


def Normalize(V: Any) -> Any:
    """Return V / ‖V‖."""
    return V / np.linalg.norm(V)


# Chapter 3: rigid-body motions ---------------------------------------------------------------------------------------


def RotInv(R: Any) -> Any:
    """Return R⁻¹ = Rᵀ of a rotation (3, 3)."""
    return np.array(R).T


def VecToso3(omg: Any) -> Any:
    """Return [ω] (3, 3) of ω (3,)."""
    return np.array([[0, -omg[2], omg[1]], [omg[2], 0, -omg[0]], [-omg[1], omg[0], 0]])


def so3ToVec(so3mat: Any) -> Any:
    """Return ω (3,) of [ω] (3, 3)."""
    return np.array([so3mat[2][1], so3mat[0][2], so3mat[1][0]])


def AxisAng3(expc3: Any) -> Any:
    """Return the unit axis and the angle of ω̂θ (3,)."""
    return Normalize(expc3), np.linalg.norm(expc3)


def MatrixExp3(so3mat: Any) -> Any:
    """Return e^[ω] (3, 3) of [ω] (3, 3)."""
    return _compiled.exp3(so3mat)


def MatrixLog3(R: Any) -> Any:
    """Return [ω] (3, 3) with e^[ω] = R and ‖ω‖ ≤ π."""
    return _compiled.log3(R)


def RpToTrans(R: Any, p: Any) -> Any:
    """Return T (4, 4) of a rotation R (3, 3) and a position p (3,)."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, p
    return T


def TransToRp(T: Any) -> Any:
    """Return R (3, 3) and p (3,) of T (4, 4)."""
    T = np.array(T)
    return T[:3, :3], T[:3, 3]


def TransInv(T: Any) -> Any:
    """Return T⁻¹ (4, 4)."""
    R, p = TransToRp(T)
    return RpToTrans(R.T, -R.T @ p)


def VecTose3(V: Any) -> Any:
    """Return [V] (4, 4) of a twist (ω, v) (6,)."""
    a, b, c, x, y, z = V
    return np.array([[0.0, -c, b, x], [c, 0.0, -a, y], [-b, a, 0.0, z], [0.0, 0.0, 0.0, 0.0]])


def se3ToVec(se3mat: Any) -> Any:
    """Return the twist (ω, v) (6,) of [V] (4, 4)."""
    a, b, c, _ = se3mat
    return np.array([c[1], a[2], b[0], a[3], b[3], c[3]])


def Adjoint(T: Any) -> Any:
    """Return [Ad_T] (6, 6) of T (4, 4)."""
    return _compiled.adjoint(T)


def ScrewToAxis(q: Any, s: Any, h: Any) -> Any:
    """Return the screw axis (6,) through the point q along the unit vector s with the pitch h."""
    return np.concatenate([s, np.cross(q, s) + np.dot(h, s)])


def AxisAng6(expc6: Any) -> Any:
    """Return the screw axis (6,) and the angle of Sθ (6,), or the distance if ω = 0."""
    theta = np.linalg.norm(expc6[:3])
    if NearZero(theta):
        theta = np.linalg.norm(expc6[3:])
    return np.array(expc6 / theta), theta


def MatrixExp6(se3mat: Any) -> Any:
    """Return e^[V] (4, 4) of [V] (4, 4)."""
    return _compiled.exp6(se3mat)


def MatrixLog6(T: Any) -> Any:
    """Return [V] (4, 4) with e^[V] = T and ‖ω‖ ≤ π."""
    return _compiled.log6(T)


def ProjectToSO3(mat: Any) -> Any:
    """Return the rotation nearest to a matrix (3, 3), U Vᵀ of its singular value decomposition."""
    U, _, Vh = np.linalg.svd(mat)
    R = U @ Vh
    if np.linalg.det(R) < 0:
        R[:, 2] = -R[:, 2]
    return R


def ProjectToSE3(mat: Any) -> Any:
    """Return the pose with ProjectToSO3 of the upper left part, and the position."""
    mat = np.array(mat)
    return RpToTrans(ProjectToSO3(mat[:3, :3]), mat[:3, 3])


def DistanceToSO3(mat: Any) -> Any:
    """Return ‖AᵀA − I‖ of a matrix A (3, 3), or 10⁹ if det A ≤ 0."""
    mat = np.array(mat)
    return np.linalg.norm(mat.T @ mat - np.eye(3)) if np.linalg.det(mat) > 0 else _FAR


def DistanceToSE3(mat: Any) -> Any:
    """Return DistanceToSO3 of the upper left part A, with the distance of the last row from 0, 0, 0, 1."""
    mat = np.array(mat)
    A = mat[:3, :3]
    if np.linalg.det(A) <= 0:
        return _FAR
    return np.hypot(np.linalg.norm(A.T @ A - np.eye(3)), np.linalg.norm(mat[3] - [0, 0, 0, 1]))


def TestIfSO3(mat: Any) -> Any:
    """Return True if DistanceToSO3 is below 10⁻³."""
    return abs(DistanceToSO3(mat)) < 1e-3


def TestIfSE3(mat: Any) -> Any:
    """Return True if DistanceToSE3 is below 10⁻³."""
    return abs(DistanceToSE3(mat)) < 1e-3


for _name in ("TestIfSO3", "TestIfSE3"):
    setattr(globals()[_name], "__test__", False)  # pytest would take them for tests


# Chapter 4: forward kinematics ---------------------------------------------------------------------------------------


def FKinBody(M: Any, Blist: Any, thetalist: Any) -> Any:
    """Return T (4, 4) of the end effector, from its home M and the screws in its own frame at θ."""
    return _compiled.forward_kinematics(M, Blist, thetalist, True)


def FKinSpace(M: Any, Slist: Any, thetalist: Any) -> Any:
    """Return T (4, 4) of the end effector, from its home M and the screws in the space frame at θ."""
    return _compiled.forward_kinematics(M, Slist, thetalist, False)


# Chapter 5: velocity kinematics --------------------------------------------------------------------------------------


def JacobianBody(Blist: Any, thetalist: Any) -> Any:
    """Return the body Jacobian (6, n) of screws in the end effector's frame at θ."""
    return _compiled.jacobian(Blist, thetalist, True)


def JacobianSpace(Slist: Any, thetalist: Any) -> Any:
    """Return the space Jacobian (6, n) of screws in the space frame at θ."""
    return _compiled.jacobian(Slist, thetalist, False)


# Chapter 6: inverse kinematics ---------------------------------------------------------------------------------------

_STEPS = 20


def _solve(error: Any, jacobian: Any, screws: Any, thetalist0: Any, eomg: Any, ev: Any) -> Any:
    """Newton's method: θ, and True if the remaining error (ω, v) has ‖ω‖ ≤ eomg and ‖v‖ ≤ ev."""
    theta = np.array(thetalist0)
    if theta.shape != np.shape(screws)[1:]:
        raise ValueError(f"thetalist0 has shape {theta.shape}, expected {np.shape(screws)[1:]}: a number for each screw")
    for step in range(_STEPS + 1):
        V = error(theta)
        if np.linalg.norm(V[:3]) <= eomg and np.linalg.norm(V[3:]) <= ev:
            return theta, True
        if step < _STEPS:
            theta = theta + np.linalg.pinv(jacobian(theta)) @ V
    return theta, False


def IKinBody(Blist: Any, M: Any, T: Any, thetalist0: Any, eomg: Any, ev: Any) -> Any:
    """Return θ (n,) that places the end effector at T, and True if the error in its own frame is within eomg, ev."""

    def error(theta: Any) -> Any:
        return se3ToVec(MatrixLog6(TransInv(FKinBody(M, Blist, theta)) @ T))

    return _solve(error, lambda theta: JacobianBody(Blist, theta), Blist, thetalist0, eomg, ev)


def IKinSpace(Slist: Any, M: Any, T: Any, thetalist0: Any, eomg: Any, ev: Any) -> Any:
    """Return θ (n,) that places the end effector at T, and True if the error in the space frame is within eomg, ev."""

    def error(theta: Any) -> Any:
        Tsb = FKinSpace(M, Slist, theta)
        return Adjoint(Tsb) @ se3ToVec(MatrixLog6(TransInv(Tsb) @ T))

    return _solve(error, lambda theta: JacobianSpace(Slist, theta), Slist, thetalist0, eomg, ev)


# Chapter 8: dynamics of open chains ----------------------------------------------------------------------------------


def ad(V: Any) -> Any:
    """Return [ad_V] (6, 6) of a twist (ω, v) (6,)."""
    return _compiled.bracket(V)


def InverseDynamics(
    thetalist: Any, dthetalist: Any, ddthetalist: Any, g: Any, Ftip: Any, Mlist: Any, Glist: Any, Slist: Any,
) -> Any:  # fmt: skip
    """Return τ = Mθ̈ + c + g + JᵀF (n,)."""
    return _compiled.inverse_dynamics(thetalist, dthetalist, ddthetalist, g, Ftip, Mlist, Glist, Slist)


def MassMatrix(thetalist: Any, Mlist: Any, Glist: Any, Slist: Any) -> Any:
    """Return M(θ) (n, n)."""
    return _compiled.mass_matrix(thetalist, Mlist, Glist, Slist)


def VelQuadraticForces(thetalist: Any, dthetalist: Any, Mlist: Any, Glist: Any, Slist: Any) -> Any:
    """Return c(θ, θ̇) (n,), the Coriolis and centripetal forces."""
    return _compiled.inverse_dynamics(thetalist, dthetalist, None, None, None, Mlist, Glist, Slist)


def GravityForces(thetalist: Any, g: Any, Mlist: Any, Glist: Any, Slist: Any) -> Any:
    """Return g(θ) (n,), the forces that hold the robot against gravity."""
    return _compiled.inverse_dynamics(thetalist, None, None, g, None, Mlist, Glist, Slist)


def EndEffectorForces(thetalist: Any, Ftip: Any, Mlist: Any, Glist: Any, Slist: Any) -> Any:
    """Return JᵀF (n,), the forces that make the end effector apply Ftip."""
    return _compiled.inverse_dynamics(thetalist, None, None, None, Ftip, Mlist, Glist, Slist)


def ForwardDynamics(
    thetalist: Any, dthetalist: Any, taulist: Any, g: Any, Ftip: Any, Mlist: Any, Glist: Any, Slist: Any,
) -> Any:  # fmt: skip
    """Return θ̈ (n,) under the joint forces τ."""
    return _compiled.forward_dynamics(thetalist, dthetalist, taulist, g, Ftip, Mlist, Glist, Slist)


def EulerStep(thetalist: Any, dthetalist: Any, ddthetalist: Any, dt: Any) -> Any:
    """Return θ + θ̇ dt and θ̇ + θ̈ dt."""
    return thetalist + dt * np.array(dthetalist), dthetalist + dt * np.array(ddthetalist)


class _Robot:
    """The lists' robot for many states; its θ is k times the package's."""

    def __init__(self, n: Any, g: Any, Mlist: Any, Glist: Any, Slist: Any) -> None:
        model, self.k = _compiled.model_of_lists(n, Mlist, Glist, Slist)
        self.model = model.with_gravity(g)

    def inverse_dynamics(self, theta: Any, dtheta: Any, ddtheta: Any, wrench: Any = None) -> Any:
        k = self.k
        return k * self.model.inverse_dynamics(k * theta, k * dtheta, k * ddtheta, wrench)

    def steps(self, theta: Any, dtheta: Any, tau: Any, wrench: Any, dt: Any, count: Any) -> Any:
        """Euler's method."""
        k, wrench = self.k, wrench if np.any(wrench) else None
        for _ in range(count):
            ddtheta = self.model.forward_dynamics(k * theta, k * dtheta, tau / k, wrench) / k
            theta, dtheta = theta + dt * dtheta, dtheta + dt * ddtheta
        return theta, dtheta


def InverseDynamicsTrajectory(
    thetamat: Any, dthetamat: Any, ddthetamat: Any, g: Any, Ftipmat: Any, Mlist: Any, Glist: Any, Slist: Any,
) -> Any:  # fmt: skip
    """Return τ (N, n) of a motion, from rows of θ, θ̇, θ̈ and the end effector's wrench."""
    thetamat, dthetamat, ddthetamat = (np.asarray(x, float) for x in (thetamat, dthetamat, ddthetamat))
    robot = _Robot(thetamat.shape[1], g, Mlist, Glist, Slist)
    return robot.inverse_dynamics(thetamat, dthetamat, ddthetamat, np.asarray(Ftipmat, float))


def ForwardDynamicsTrajectory(
    thetalist: Any, dthetalist: Any, taumat: Any, g: Any, Ftipmat: Any, Mlist: Any, Glist: Any, Slist: Any, dt: Any,
    intRes: Any,
) -> Any:  # fmt: skip
    """Return θ and θ̇ (N, n) from a start, under rows of τ and Ftip, each constant over dt."""
    taumat, Ftipmat = np.asarray(taumat, float), np.asarray(Ftipmat, float)
    thetamat, dthetamat = np.empty_like(taumat), np.empty_like(taumat)
    theta, dtheta = np.array(thetalist, float), np.array(dthetalist, float)
    thetamat[0], dthetamat[0] = theta, dtheta
    robot = _Robot(taumat.shape[1], g, Mlist, Glist, Slist)
    for i in range(len(taumat) - 1):
        theta, dtheta = robot.steps(theta, dtheta, taumat[i], Ftipmat[i], dt / intRes, intRes)
        thetamat[i + 1], dthetamat[i + 1] = theta, dtheta
    return thetamat, dthetamat


# Chapter 9: trajectory generation ------------------------------------------------------------------------------------


def CubicTimeScaling(Tf: Any, t: Any) -> Any:
    """Return s(t) = 3(t/T)² − 2(t/T)³."""
    return _compiled.time_scaling(t / Tf, 3)


def QuinticTimeScaling(Tf: Any, t: Any) -> Any:
    """Return s(t) = 10(t/T)³ − 15(t/T)⁴ + 6(t/T)⁵."""
    return _compiled.time_scaling(t / Tf, 5)


def _scaling(Tf: Any, N: Any, method: Any) -> Any:
    """Return s at N times from 0 to T: 3 is cubic, all else quintic, as in the package."""
    t = Tf / (N - 1.0) * np.arange(N)
    return (CubicTimeScaling if method == 3 else QuinticTimeScaling)(Tf, t)


def JointTrajectory(thetastart: Any, thetaend: Any, Tf: Any, N: Any, method: Any) -> Any:
    """Return θ (N, n) on the straight line from θ_start to θ_end in T seconds."""
    s = _scaling(Tf, int(N), method)[:, None]
    return s * np.array(thetaend) + (1 - s) * np.array(thetastart)


def ScrewTrajectory(Xstart: Any, Xend: Any, Tf: Any, N: Any, method: Any) -> Any:
    """Return N poses (4, 4) on the screw motion from X_start to X_end."""
    way = MatrixLog6(TransInv(Xstart) @ Xend)
    return [np.array(Xstart) @ MatrixExp6(way * s) for s in _scaling(Tf, int(N), method)]


def CartesianTrajectory(Xstart: Any, Xend: Any, Tf: Any, N: Any, method: Any) -> Any:
    """Return N poses (4, 4) from X_start to X_end, the origin on a straight line, the orientation about one axis."""
    (Rstart, pstart), (Rend, pend) = TransToRp(Xstart), TransToRp(Xend)
    turn = MatrixLog3(Rstart.T @ Rend)
    return [
        RpToTrans(Rstart @ MatrixExp3(turn * s), s * pend + (1 - s) * pstart) for s in _scaling(Tf, int(N), method)
    ]


# Chapter 11: robot control -------------------------------------------------------------------------------------------


def ComputedTorque(
    thetalist: Any, dthetalist: Any, eint: Any, g: Any, Mlist: Any, Glist: Any, Slist: Any, thetalistd: Any,
    dthetalistd: Any, ddthetalistd: Any, Kp: Any, Ki: Any, Kd: Any,
) -> Any:  # fmt: skip
    """Return τ = M(θ)(K_p e + K_i (∫e + e) + K_d ė) + τ(θ, θ̇, θ̈_d) (n,), the feedback linearizing controller."""
    robot = _Robot(len(thetalist), g, Mlist, Glist, Slist)
    return _computed_torque(robot, thetalist, dthetalist, eint, thetalistd, dthetalistd, ddthetalistd, Kp, Ki, Kd)


def _computed_torque(
    robot: Any, theta: Any, dtheta: Any, eint: Any, theta_d: Any, dtheta_d: Any, ddtheta_d: Any, Kp: Any, Ki: Any,
    Kd: Any,
) -> Any:  # fmt: skip
    theta, dtheta, ddtheta_d = np.asarray(theta, float), np.asarray(dtheta, float), np.asarray(ddtheta_d, float)
    e = np.subtract(theta_d, theta)
    feedback = Kp * e + Ki * (np.array(eint) + e) + Kd * np.subtract(dtheta_d, dtheta)
    return robot.inverse_dynamics(theta, dtheta, ddtheta_d + feedback)


def SimulateControl(
    thetalist: Any, dthetalist: Any, g: Any, Ftipmat: Any, Mlist: Any, Glist: Any, Slist: Any, thetamatd: Any,
    dthetamatd: Any, ddthetamatd: Any, gtilde: Any, Mtildelist: Any, Gtildelist: Any, Kp: Any, Ki: Any, Kd: Any,
    dt: Any, intRes: Any,
) -> Any:  # fmt: skip
    """Return τ and θ (N, n) of a robot that ComputedTorque drives along a motion.

    The controller's model is gtilde, Mtildelist and Gtildelist. If matplotlib is installed, the desired and the actual
    angles are plotted.
    """
    thetamatd, dthetamatd, ddthetamatd = (np.asarray(x, float) for x in (thetamatd, dthetamatd, ddthetamatd))
    Ftipmat, n = np.asarray(Ftipmat, float), thetamatd.shape[1]
    actual, believed = _Robot(n, g, Mlist, Glist, Slist), _Robot(n, gtilde, Mtildelist, Gtildelist, Slist)
    theta, dtheta, eint = np.array(thetalist, float), np.array(dthetalist, float), np.zeros(n)
    taumat, thetamat = np.empty_like(thetamatd), np.empty_like(thetamatd)
    for i, wanted in enumerate(zip(thetamatd, dthetamatd, ddthetamatd)):
        tau = _computed_torque(believed, theta, dtheta, eint, *wanted, Kp, Ki, Kd)
        theta, dtheta = actual.steps(theta, dtheta, tau, Ftipmat[i], dt / intRes, intRes)
        taumat[i], thetamat[i] = tau, theta
        eint = eint + dt * (wanted[0] - theta)
    _plot(thetamat, thetamatd, dt)
    return taumat, thetamat


def _plot(actual: Any, wanted: Any, dt: Any) -> None:
    try:
        plot: Any = importlib.import_module("matplotlib.pyplot")
    except ImportError:
        print("nothing is plotted: matplotlib is not installed")
        return
    t = np.linspace(0, len(actual) * dt, len(actual))
    for joint, (is_at, should_be) in enumerate(zip(actual.T, wanted.T), 1):
        (line,) = plot.plot(t, is_at, "-", label=f"actual θ{joint}")
        plot.plot(t, should_be, ".", color=line.get_color(), label=f"wanted θ{joint}")
    plot.legend(loc="upper left")
    plot.xlabel("time, s")
    plot.ylabel("joint angles")
    plot.title("Actual and wanted joint angles")
    plot.show()
