"""Balls and free bodies beside each other: names, shapes, MuJoCo's numbers, simulation, pickling."""

import pickle

import mozzi
import numpy as np
import pytest
from conftest import assert_close, load_mjcf

ROBOT = """
<mujoco><compiler angle="radian"/><option gravity="0.4 -1 -9.5"/><worldbody>
  <body name="stone" pos="1 0 2"><freejoint name="fall"/><geom type="box" size="0.1 0.2 0.05" pos="0.1 0 0.2" mass="2"/></body>
  <body name="arm" pos="0 0 1"><joint name="shoulder" type="ball" pos="0.1 0 0.2" armature="0.1" damping="0.2"/>
    <geom type="capsule" fromto="0 0 0 0.3 0.1 0.2" size="0.05" mass="1"/>
    <body name="hand" pos="0.3 0 0"><joint name="wrist" axis="0 1 0.2" armature="0.05"/><geom size="0.08" pos="0.1 0.1 0" mass="0.5"/></body>
  </body>
</worldbody></mujoco>"""


@pytest.fixture
def robot(tmp_path):
    return load_mjcf(tmp_path, ROBOT)


def quaternions(random, count):
    q = random.normal(size=(count, 4))
    return q / np.linalg.norm(q, axis=1, keepdims=True)


def states(random, count):
    theta = np.hstack([quaternions(random, count), random.uniform(-1, 1, (count, 3)), quaternions(random, count), random.uniform(-2, 2, (count, 1))])
    return theta, random.uniform(-2, 2, (count, 10)), random.uniform(-5, 5, (count, 10))


def test_names_and_shapes(robot):
    assert (robot.nq, robot.n, robot.joint_names) == (12, 10, ["fall", "shoulder", "wrist"])
    assert list(robot.position_names)[:8] == ["fall.qw", "fall.qx", "fall.qy", "fall.qz", "fall.x", "fall.y", "fall.z", "shoulder.qw"]
    assert list(robot.velocity_names)[5:] == ["fall.vz", "shoulder.wx", "shoulder.wy", "shoulder.wz", "wrist"]
    with pytest.raises(ValueError, match="`fall`, a free joint"):
        robot.screws()
    with pytest.raises(ValueError, match="of `shoulder`"):
        robot.mass_matrix([1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0])


def test_mujoco(robot, random):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(ROBOT)
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    data = mujoco.MjData(model)
    theirs = mozzi.conventions.MuJoCo(robot, model)
    assert np.array_equal(theirs.joints, mozzi.conventions.MuJoCo(robot).joints)
    thetas, dthetas, ddthetas = states(random, 20)
    many = robot.inverse_dynamics(thetas, dthetas, ddthetas)
    for theta, dtheta, ddtheta, batched in zip(thetas, dthetas, ddthetas, many):
        data.qpos[:] = theirs.configuration(theta)
        data.qvel[:] = theirs.velocity(theta, dtheta)
        mujoco.mj_forward(model, data)
        M = np.zeros((10, 10))
        mujoco.mj_fullM(model, data, M)
        assert_close(theirs.mass_matrix(theta, robot.mass_matrix(theta)), M, np.abs(M).max())
        data.qacc[:] = theirs.acceleration(theta, dtheta, ddtheta)
        mujoco.mj_inverse(model, data)
        tau = robot.inverse_dynamics(theta, dtheta, ddtheta)
        assert_close(tau, batched, np.abs(tau).max())
        assert_close(theirs.force(theta, tau), data.qfrc_inverse, np.abs(data.qfrc_inverse).max())
        assert_close(robot.forward_dynamics(theta, dtheta, tau), ddtheta, 1e3 * np.abs(ddtheta).max())


def test_a_motion_stays_on_the_sphere(robot, random):
    theta, dtheta, _ = (table[0] for table in states(random, 1))
    motion = robot.simulate(theta, dtheta, 0.5, 500)
    for quaternion in (motion.theta[:, :4], motion.theta[:, 7:11]):
        assert np.abs(np.linalg.norm(quaternion, axis=1) - 1).max() < 1e-14


def test_pickle(robot, random):
    again = pickle.loads(pickle.dumps(robot))
    theta, dtheta, ddtheta = (table[0] for table in states(random, 1))
    assert np.array_equal(again.inverse_dynamics(theta, dtheta, ddtheta), robot.inverse_dynamics(theta, dtheta, ddtheta))


def test_pinocchio(robot, random):
    pin = pytest.importorskip("pinocchio")
    model, turn = pin.Model(), np.array([0, 1, 0.2]) / np.linalg.norm([0, 1, 0.2])
    at = lambda *p: pin.SE3(np.eye(3), np.array(p, float))
    fall = model.addJoint(0, pin.JointModelFreeFlyer(), at(0, 0, 0), "fall")
    shoulder = model.addJoint(0, pin.JointModelSpherical(), at(0.1, 0, 1.2), "shoulder")
    wrist = model.addJoint(shoulder, pin.JointModelRevoluteUnaligned(*turn), at(0.2, 0, -0.2), "wrist")
    places = [(fall, at(0, 0, 0)), (shoulder, at(-0.1, 0, -0.2)), (wrist, at(0, 0, 0))]
    for (joint, place), body in zip(places, np.reshape(robot.parameters[:30], (3, 10))):
        body[[6, 7]] = body[[7, 6]]  # Pinocchio has I_yy before I_xz
        model.appendBodyToJoint(joint, pin.Inertia.FromDynamicParameters(body), place)
    model.gravity.linear = robot.gravity
    model.armature = np.array([0.0] * 6 + [0.1] * 3 + [0.05])
    data, bridge = model.createData(), mozzi.conventions.Pinocchio(robot, model)
    for theta, dtheta, ddtheta in zip(*states(random, 20)):
        q, v, a = bridge.configuration(theta), bridge.velocity(dtheta), bridge.acceleration(ddtheta)
        assert_close(bridge.from_configuration(q), theta)
        M = pin.crba(model, data, q)
        M = np.triu(M) + np.triu(M, 1).T
        assert_close(bridge.mass_matrix(robot.mass_matrix(theta)), M, np.abs(M).max())
        tau = bridge.force(robot.inverse_dynamics(theta, dtheta, ddtheta) - robot.joint_friction(dtheta))
        assert_close(tau, pin.rnea(model, data, q, v, a), np.abs(tau).max())
        pin.computeRNEADerivatives(model, data, q, v, a)
        d_theta, d_dtheta, _ = robot.inverse_dynamics_derivatives(theta, dtheta, ddtheta)
        damping = np.diag([0.0] * 6 + [0.2] * 3 + [0.0])
        for found, theirs in ((d_theta, data.dtau_dq), (d_dtheta - damping, data.dtau_dv)):
            assert_close(bridge.mass_matrix(found), theirs, 10 * np.abs(theirs).max())


CONE = """
<mujoco><compiler angle="radian"/><worldbody><body name="top">
  <joint name="pivot" type="ball" range="0 0.7"/><geom type="capsule" fromto="0 0 0 0 0 -0.8" size="0.05" mass="2"/>
  <body name="tip" pos="0 0 -0.8"><joint name="slide" type="slide" axis="0 0 1" range="-0.1 0.1" stiffness="300" damping="1"/>
    <geom size="0.05" mass="0.2"/></body>
</body></worldbody></mujoco>"""


def angle(q):
    return 2 * np.arctan2(np.linalg.norm(q[..., 1:], axis=-1), np.abs(q[..., 0]))


def test_the_limit_of_a_ball(tmp_path):
    robot = load_mjcf(tmp_path, CONE)
    start, thrown = [np.cos(0.15), np.sin(0.15), 0, 0, 0], [0.5, 3.5, 0.8, 0]
    options = dict(duration=2.0, steps=10000)
    free = robot.simulate(start, thrown, **options)
    kept = robot.simulate(start, thrown, joint_limits="respect", **options)
    assert free.joint_limits[0].joint == "pivot" and abs(free.joint_limits[0].beyond - (angle(free.theta[:, :4]).max() - 0.7)) < 1e-9
    assert angle(kept.theta[:, :4]).max() <= 0.7 + 1e-11
    (stop,) = [stop for stop in kept.joint_limits if stop.joint == "pivot"]
    assert stop.limit == 0.7 and stop.beyond == 0 and stop.times >= 1
    total = kept.kinetic_energy + kept.potential_energy
    # the body spins fast about its thin axis, and the impact is located to a step
    assert np.diff(total).max() < 5e-3 * kept.kinetic_energy.max()
    assert kept.friction_loss[-1] == pytest.approx(0.08596, rel=2e-2)


def difference(first, second):
    """θ₂ ⊖ θ₁ of a ball and a slide."""
    (w1, *v1), (w2, *v2) = first[:4], second[:4]
    w, v = w1 * w2 + np.dot(v1, v2), w1 * np.array(v2) - w2 * np.array(v1) - np.cross(v1, v2)
    sin = np.linalg.norm(v)
    turn = 2 * np.arctan2(sin, abs(w)) * np.sign(w) * v / sin if sin > 0 else 2 * v
    return np.append(turn, second[4] - first[4])


def test_trajectories_of_a_ball(tmp_path, random):
    robot = load_mjcf(tmp_path, CONE)
    points = np.hstack([quaternions(random, 5), random.uniform(-0.1, 0.1, (5, 1))])
    s, e = [0, 0.2, 0.5, 0.6, 1], 1e-5
    for path in (mozzi.trajectories.Spline(robot, points, s), mozzi.trajectories.Line(robot, points[0], points[4])):
        for end, point in ((0, points[0]), (1, points[4])):
            assert_close(difference(point, path.at(end).theta), np.zeros(4), 1, 1e-13)
        motion = mozzi.trajectories.Timed(path, mozzi.trajectories.Profile.quintic(2.0))
        for t in np.linspace(0.11, 1.93, 13):
            before, now, after = (motion.at(x) for x in (t - e, t, t + e))
            moved = difference(before.theta, after.theta) / (2 * e)
            assert_close(moved, now.dtheta, 1 + np.abs(moved).max(), 1e-6)
            rate = (after.dtheta - before.dtheta) / (2 * e)
            assert_close(rate, now.ddtheta, 1 + np.abs(rate).max(), 1e-6)
    spline = mozzi.trajectories.Spline(robot, points, s)
    for place, point in zip(s, points):
        assert_close(difference(point, spline.at(place).theta), np.zeros(4), 1, 1e-13)
    fastest = spline.time_optimal(velocity=3.0, acceleration=30.0, torque=np.inf)
    motion = mozzi.trajectories.Timed(spline, fastest).at(np.linspace(0, fastest.duration, 400))
    assert 0.99 < np.abs(motion.dtheta).max() / 3.0 < 1.001 or 0.99 < np.abs(motion.ddtheta).max() / 30.0 < 1.001
    # the motion's own rows, as a table
    t = np.linspace(0, 2, 41)
    rows = mozzi.trajectories.Timed(spline, mozzi.trajectories.Profile.quintic(2.0)).at(t)
    table = mozzi.trajectories.Recorded(robot, t, rows.theta, rows.dtheta, rows.ddtheta)
    for time, theta in zip(t, rows.theta):
        assert_close(difference(theta, table.at(time).theta), np.zeros(4), 1, 1e-12)


def test_inverse_kinematics_within_a_cone(tmp_path, random):
    robot = load_mjcf(tmp_path, CONE)
    guess = [1, 0, 0, 0, 0]
    for _ in range(10):
        axis = random.normal(size=3)
        half = random.uniform(0, 0.35)
        theta = np.concatenate([[np.cos(half)], np.sin(half) * axis / np.linalg.norm(axis), random.uniform(-0.1, 0.1, 1)])
        goal = robot.forward_kinematics(theta, frame="tip")
        found = mozzi.InverseKinematics(robot, "tip").solve(guess, pose=goal)
        assert_close(robot.forward_kinematics(found.theta, frame="tip"), goal, 1, 1e-7)
        assert angle(found.theta[:4]) <= 0.7 + 1e-15
    beyond = robot.forward_kinematics([np.cos(0.5), np.sin(0.5), 0, 0, 0], frame="tip")
    with pytest.raises(mozzi.MotionError, match="`pivot`"):
        mozzi.InverseKinematics(robot, "tip", starts=3).solve(guess, pose=beyond, must_reach=True)


def test_positions_after_velocities_and_back(robot, random):
    thetas, dthetas, _ = states(random, 5)
    for theta, dtheta in zip(thetas, dthetas):
        later = robot.integrate(theta, dtheta, 0.5)
        assert_close(robot.difference(theta, later), 0.5 * dtheta, 5.0)
        assert_close(robot.integrate(theta, robot.difference(theta, later)), later, 5.0)
        for quaternion in later[:4], later[7:11]:
            assert abs(np.linalg.norm(quaternion) - 1) < 1e-15
    later = robot.integrate(thetas, dthetas, 0.5)
    assert (later == [robot.integrate(*pair, 0.5) for pair in zip(thetas, dthetas)]).all()
    assert robot.difference(thetas[0], later.reshape(1, 5, -1)).shape == (1, 5, robot.n)
    assert robot.integrate(thetas[:0], dthetas[:0]).shape == (0, robot.nq)
    with pytest.raises(ValueError, match="leading axes"):
        robot.difference(thetas[:2], later[:3])
    with pytest.raises(ValueError, match="dtheta has shape"):
        robot.integrate(thetas[0], [0, 1])
    with pytest.raises(ValueError, match="theta1 has shape"):
        robot.difference(thetas[0], [0])
    with pytest.raises(ValueError, match="a unit quaternion"):
        robot.integrate(2 * thetas[0], dthetas[0])


def test_limits_of_a_mimic_joint_are_those_of_its_source():
    link = '<link name="{}"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    joint = (
        '<joint name="{0}" type="revolute"><parent link="{1}"/><child link="{2}"/><axis xyz="0 1 0"/>'
        '<limit lower="-{3}" upper="{3}" effort="1" velocity="1"/>{4}</joint>'
    )
    parts = [*map(link.format, "abc"), joint.format("a_b", "a", "b", 1, "")]
    parts.append(joint.format("b_c", "b", "c", 0.2, '<mimic joint="a_b" multiplier="2"/>'))
    robot = mozzi.Model.from_urdf_string(f'<robot name="r">{"".join(parts)}</robot>')
    assert robot.position_limits.tolist() == [[-0.1, 0.1]]
