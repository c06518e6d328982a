"""Controllers against their own formulas in NumPy, in simulations, and with limits."""

import mozzi
import numpy as np
import pytest
from conftest import assert_close
from mozzi.controllers import (
    ComputedTorque,
    Controller,
    Impedance,
    PdGravity,
    Saturated,
    Standing,
    TaskSpace,
    tracking_error,
)
from mozzi.trajectories import Hold, Line, OfJoints, Profile, Timed

START, GOAL = np.array([[0.3, -1.4, 1.6, -0.6, 0.9, 0.5], [1.1, -0.9, 1.0, -0.1, 1.4, -0.3]])
P, D = np.array([600.0, 600, 400, 300, 30, 30]), np.array([20.0, 20, 15, 10, 0.6, 0.6])


@pytest.fixture
def motion(ur5):
    return Timed(Line(ur5, START, GOAL), Profile.quintic(1.2))


@pytest.fixture
def states(random):
    return np.linspace(0.1, 1.1, 5), START + random.uniform(-0.3, 0.3, (5, 6)), random.uniform(-1, 1, (5, 6))


def frame_error(robot, desired, theta, dtheta):
    """X_e, 𝒱_e and the acceleration at which 𝒱̇_e = 0, by the Modern Robotics package."""
    mr = pytest.importorskip("modern_robotics")
    T_bd = np.linalg.inv(robot.forward_kinematics(theta)) @ robot.forward_kinematics(desired.theta)
    Ad, J = mr.Adjoint(T_bd), robot.body_jacobian(desired.theta)
    V_d = Ad @ J @ desired.dtheta
    dV_d = Ad @ (J @ desired.ddtheta + robot.body_jacobian_rate(desired.theta, desired.dtheta) @ desired.dtheta)
    V_e = V_d - robot.body_jacobian(theta) @ dtheta
    return mr.se3ToVec(mr.MatrixLog6(T_bd)), V_e, dV_d + mr.ad(V_e) @ V_d


def test_pd_and_computed_torque_are_their_formulas(ur5, motion, states):
    t, theta, dtheta = states
    desired = motion.at(t)
    e, de = desired.theta - theta, desired.dtheta - dtheta
    control = PdGravity(ur5, motion, p=P, d=D)
    assert isinstance(control, Controller) and control.model == ur5 and control.reference is motion
    assert_close(control(t, theta, dtheta), ur5.gravity_forces(theta) + P * e + D * de)
    assert np.array_equal(control(t[1], theta[1], dtheta[1]), control(t, theta, dtheta)[1])
    found = ComputedTorque(ur5, motion, p=400, d=D)(t, theta, dtheta)
    M, h = ur5.mass_matrix(theta), ur5.inverse_dynamics(theta, dtheta, np.zeros(6))
    assert_close(found, (M @ (desired.ddtheta + D * de + 400 * e)[..., None])[..., 0] + h, tolerance=1e-11)
    # one state at many times, many states at one time
    assert control(t, theta[0], dtheta[0]).shape == control(0.0, theta, dtheta[0]).shape == (5, 6)


def test_task_space_and_impedance_are_their_formulas(ur5, motion, states):
    t, theta, dtheta = states
    K, B = np.array([20.0, 20, 20, 1000, 1000, 1000]), np.array([1.5, 1.5, 1.5, 90, 90, 90])
    task, impedance = TaskSpace(ur5, motion, p=K, d=40.0), Impedance(ur5, motion, "tool0", stiffness=K, damping=B)
    for k in range(5):
        X, V, a = frame_error(ur5, motion.at(t[k]), theta[k], dtheta[k])
        Lambda, eta = ur5.task_space_dynamics(theta[k], dtheta[k])
        J, friction = ur5.body_jacobian(theta[k]), ur5.joint_friction(dtheta[k])
        expected = J.T @ (Lambda @ (a + 40 * V + K * X) + eta) + friction
        assert_close(task(t[k], theta[k], dtheta[k]), expected, tolerance=1e-8)
        expected = J.T @ (Lambda @ a + eta + B * V + K * X) + friction
        assert_close(impedance(t[k], theta[k], dtheta[k]), expected, tolerance=1e-8)


def test_a_redundant_robot_keeps_its_posture():
    panda = mozzi.models.panda().with_locked_joints({"panda_finger_joint1": 0.02})
    posture = np.array([0.3, -0.5, 0.2, -2.0, 0.4, 1.8, 0.7])
    null = np.linalg.svd(panda.body_jacobian(posture, "panda_hand"))[2][-1]
    hold, away = Hold(panda, posture), posture + 1e-3 * null
    # nothing moves the hand, to first order, and the joints go back by -p of the way in the null space
    soft = TaskSpace(panda, hold, "panda_hand", p=0.0, d=0.0, posture_p=[50.0] * 7, posture_d=1.0)
    ddtheta = panda.forward_dynamics(away, np.zeros(7), soft(0.0, away, np.zeros(7)))
    assert_close(null @ ddtheta, -50e-3, tolerance=0.02)
    assert np.linalg.norm(panda.body_jacobian(away, "panda_hand") @ ddtheta) < 1e-4
    default = TaskSpace(panda, hold, "panda_hand", p=0.0, d=0.0)
    stated = TaskSpace(panda, hold, "panda_hand", p=0.0, d=0.0, posture_p=100.0, posture_d=20.0)
    assert np.array_equal(default(0.0, away, null), stated(0.0, away, null))


def test_the_error_decays_as_designed(ur5, motion):
    # e(t) = (e₀ + (ė₀ + ωe₀)t) e^{−ωt}
    omega, e0 = 8.0, np.array([0.1, -0.2, 0.1, 0.2, 0.0, -0.1])
    control = ComputedTorque(ur5, motion, p=omega**2, d=2 * omega)
    followed = ur5.simulate(START - e0, np.zeros(6), 1.0, 500, torque=control, record_every=50)
    t = followed.t[:, None]
    expected = (e0 + omega * e0 * t) * np.exp(-omega * t)
    assert_close(motion.at(followed.t).theta - followed.theta, expected, 1.0, 1e-7)
    error = tracking_error(followed, motion)
    assert_close(error.largest, abs(motion.at(followed.t).theta - followed.theta).max(0))
    assert_close(error.rms, np.sqrt(np.mean((motion.at(followed.t).theta - followed.theta) ** 2, 0)))
    assert error.worst == pytest.approx(0.2) and error.worst_rms == error.rms.max()
    # from many starts at once
    many = ur5.simulate(START - e0 * np.array([[0.0], [1.0]]), np.zeros(6), 1.0, 500, torque=control, record_every=50)
    errors = tracking_error(many, motion)
    assert errors.worst.shape == (2,) and errors.worst[0] < 1e-6
    assert_close(errors.largest[1], error.largest, tolerance=1e-9)


def test_limits_of_motors(ur5, motion):
    control = PdGravity(ur5, motion, p=1e4, d=0.0)
    theta, still = START - 0.5, np.zeros(6)
    asked, limits = control(0.0, theta, still), ur5.effort_limits
    assert (abs(asked) > limits).any()
    motors = Saturated(ur5, control)
    assert motors.overloads == [] and motors.model == ur5
    assert np.array_equal(motors(0.25, theta, still), np.clip(asked, -limits, limits))
    motors([0.5, 0.75], [theta, theta], still)
    over = {overload.joint: overload for overload in motors.overloads}
    assert set(over) == {name for name, tau, limit in zip(ur5.joint_names, asked, limits) if abs(tau) > limit}
    first = over["shoulder_pan_joint"]
    assert first.largest == pytest.approx(control(0.75, theta, still)[0]) and first.limit == 150
    assert (first.first, first.last) == (0.25, 0.75)
    report, ignore = Saturated(ur5, control, "report"), Saturated(ur5, control, policy="ignore")
    assert np.array_equal(report(0.0, theta, still), asked) and len(report.overloads) == len(over)
    assert np.array_equal(ignore(0.0, theta, still), asked) and not ignore.overloads


def test_a_floating_base_has_no_motors(ur5):
    free = ur5.with_floating_base()
    control = PdGravity(free, OfJoints(free, Hold(ur5, START)), p=100.0, d=1.0)
    theta = np.r_[1, 0, 0, 0, 0, 0, 0, START + 0.1]
    tau = control(0.0, theta, np.zeros(12))
    assert not tau[:6].any()
    assert_close(tau[6:], free.gravity_forces(theta)[6:] - 10.0)
    with pytest.raises(ValueError, match="a robot under computed torque is on a free base, expected a fixed base"):
        ComputedTorque(free, OfJoints(free, Hold(ur5, START)), p=1.0, d=1.0)


def test_controllers_show_their_gains(ur5, motion):
    stiff = [20, 20, 20, 1000, 1000, 1000]
    computed = ComputedTorque(ur5, motion, p=400.0, d=40.0)
    for made, expected in [
        (PdGravity(ur5, motion, p=P, d=5), "PdGravity of 'ur5': p = (600, 600, 400, 300, 30, 30), d = 5"),
        (computed, "ComputedTorque of 'ur5': p = 400, d = 40"),
        (TaskSpace(ur5, motion, p=100, d=20), "TaskSpace of 'tool0' of 'ur5': p = 100, d = 20"),
        (
            Impedance(ur5, motion, "forearm_link", stiffness=stiff, damping=1.5),
            "Impedance of 'forearm_link' of 'ur5': stiffness = (20, 20, 20, 1000, 1000, 1000), damping = 1.5",
        ),
        (Saturated(ur5, computed), f"Saturated of 'ur5': {computed!r}"),
    ]:
        assert repr(made) == f"<mozzi.controllers.{expected}>"


def test_what_is_wrong_is_named(ur5, motion):
    control = ComputedTorque(ur5, motion, p=1.0, d=1.0)
    pendulum = mozzi.models.double_pendulum()
    for call, error, words in [
        (lambda: control(0.0, [0.0], [0.0] * 6), ValueError, r"theta has shape \(1,\), expected \(..., 6\)"),
        (lambda: control(0.0, np.zeros((2, 6)), np.zeros((3, 6))), ValueError, "dtheta has leading axes"),
        (lambda: PdGravity(ur5, motion, p=-1.0, d=1.0), ValueError, "K_p is .*expected finite numbers"),
        (lambda: PdGravity(ur5, motion, p=[1.0], d=1.0), ValueError, r"p has shape \(1,\), expected \(6,\)"),
        (lambda: TaskSpace(ur5, motion, "nose", p=1.0, d=1.0), ValueError, "there is no frame `nose`"),
        (lambda: TaskSpace(ur5, motion, p=[1.0], d=1.0), ValueError, r"p has shape \(1,\), expected \(6,\)"),
        (lambda: PdGravity(ur5, Hold(pendulum, [0, 0]), p=1, d=1), ValueError, "the reference's robot is one with 2 positions"),
        (lambda: Saturated(ur5, control, "clip"), ValueError, "policy is 'clip', expected 'respect', 'rep"),
        (lambda: Saturated(ur5, 3), TypeError, "torque is a int, expected a function"),
        (lambda: Saturated(ur5, lambda *_: [1.0])(0, START, START), ValueError, r"tau has shape \(1,\), expected"),
        (lambda: TaskSpace(ur5, motion, p=1, d=1)(0.0, np.zeros(6), np.zeros(6)), mozzi.SingularError, "singular"),
    ]:
        with pytest.raises(error, match=words):
            call()
    fall = pendulum.simulate([0.1, 0.0], [0.0, 0.0], 0.1, 10)
    with pytest.raises(ValueError, match="the reference's robot is one with 6 positions, and the robot has 2"):
        tracking_error(fall, motion)
    for other, kind in [(np.zeros((3, 6)), "ndarray"), (motion.at(0.0), "Desired")]:
        with pytest.raises(TypeError, match=f"motion is a {kind}, expected the Trajectory or Trajectories"):
            tracking_error(other, motion)


def test_joints_in_another_order_are_refused(tmp_path):
    link = '<link name="{0}"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    joint = '<joint name="{0}" type="continuous"><parent link="base"/><child link="of_{0}"/><axis xyz="0 1 0"/></joint>'
    models = []
    for order in ("ab", "ba"):
        parts = [*(link.format(f"of_{k}") for k in order), *(joint.format(k) for k in order)]
        path = tmp_path / f"{order}.urdf"
        path.write_text(f'<robot name="{order}"><link name="base"/>{"".join(parts)}</robot>')
        models.append(mozzi.Model.load(path))
    one, other = models
    control = PdGravity(other, Hold(other, [0, 0]), p=1, d=1)
    words = "robot is one with `b` where the robot has `a`, expected the same joints in the same order"
    for call in [
        lambda: one.simulate([0, 0], [0, 0], 0.1, torque=control),
        lambda: Saturated(one, control),
        lambda: PdGravity(one, Hold(other, [0, 0]), p=1, d=1),
        lambda: tracking_error(one.simulate([0, 0], [0, 0], 0.1), Hold(other, [0, 0])),
    ]:
        with pytest.raises(ValueError, match=words):
            call()


def test_standing_on_feet():
    anymal, feet = mozzi.models.anymal(), ["LF_FOOT", "RF_FOOT", "LH_FOOT", "RH_FOOT"]
    pose = anymal.neutral_configuration
    pose[7:] = [0.0, 0.7, -1.0] * 2 + [0.0, -0.7, 1.0] * 2
    pose[6] -= min(anymal.forward_kinematics(pose, frame=foot)[2, 3] for foot in feet)
    control = Standing(anymal, Hold(anymal, pose), feet, p=144.0, d=24.0)
    tau = control(0.0, pose, np.zeros(anymal.n))
    assert tau.shape == (anymal.n,) and not tau[:6].any() and tau[6:].any()
    held = anymal.simulate(pose, None, 0.3, 150, torque=control, contacts=feet)
    assert abs(held.theta - pose).max() < 1e-3
    carried = held.contact_forces[-1, :, 2].sum()
    assert carried == pytest.approx(-9.81 * anymal.mass_matrix(pose)[3, 3], rel=1e-3)
    assert repr(control).startswith("<mozzi.controllers.Standing of 'anymal")
    for wrong, words in [([], "feet"), (["LF_FOT"], "LF_FOT"), ([{"frame": "LF_FOOT", "mu": 1}], "unknown `mu`")]:
        with pytest.raises((ValueError, KeyError, TypeError), match=words):
            Standing(anymal, Hold(anymal, pose), wrong, p=144.0, d=24.0)
