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
