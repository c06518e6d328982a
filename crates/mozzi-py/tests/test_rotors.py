"""Rotors that several joints turn, the armature of a free body and springs of balls, beside MuJoCo and in every way that arrays go."""

import pickle

import mozzi
import numpy as np
import pytest
from conftest import assert_close, load_mjcf

ROBOT = """
<mujoco><compiler angle="radian"/><option gravity="0.4 -1 -9.5"/><worldbody>
  <body name="stone" pos="1 0 2"><joint name="fall" type="free" armature="0.3"/>
    <geom type="box" size="0.1 0.2 0.05" pos="0.1 0 0.2" mass="2"/></body>
  <body name="arm" pos="0 0 1"><joint name="shoulder" type="ball" pos="0.1 0 0.2" stiffness="5" armature="0.1"/>
    <geom type="capsule" fromto="0 0 0 0.3 0.1 0.2" size="0.05" mass="1"/>
    <body name="left" pos="0.3 0 0"><joint name="left" axis="0 1 0.2"/><geom size="0.08" pos="0.1 0.1 0" mass="0.5"/>
      <body name="right" pos="0 0.3 0"><joint name="right" axis="1 0 0.2"/><geom size="0.06" pos="0.1 0.1 0.1" mass="0.7"/></body>
    </body></body></worldbody>
  <tendon><fixed name="differential" armature="0.1"><joint joint="left" coef="2"/><joint joint="right" coef="-3"/></fixed></tendon>
  <actuator><motor tendon="differential" gear="5" armature="0.01"/><motor joint="left" gear="4" armature="0.02"/></actuator>
</mujoco>"""


@pytest.fixture
def robot(tmp_path):
    return load_mjcf(tmp_path, ROBOT)


def states(random, count):
    def quaternions():
        q = random.normal(size=(count, 4))
        return q / np.linalg.norm(q, axis=1, keepdims=True)

    theta = np.hstack([quaternions(), random.uniform(-1, 1, (count, 3)), quaternions(), random.uniform(-2, 2, (count, 2))])
    return theta, random.uniform(-2, 2, (count, 11)), random.uniform(-5, 5, (count, 11))


def test_mujoco(robot, random):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(ROBOT)
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    data = mujoco.MjData(model)
    theirs = mozzi.conventions.MuJoCo(robot, model)
    before = None
    for theta, dtheta, ddtheta in zip(*states(random, 20)):
        data.qpos[:] = theirs.configuration(theta)
        data.qvel[:] = theirs.velocity(theta, dtheta)
        mujoco.mj_forward(model, data)
        M = np.zeros((11, 11))
        mujoco.mj_fullM(model, data, M)
        assert_close(theirs.mass_matrix(theta, robot.mass_matrix(theta)), M, np.abs(M).max())
        assert_close(robot.spring_forces(theta)[6:9], -data.qfrc_spring[6:9], 10)
        energies = np.array([[robot.potential_energy(theta), robot.kinetic_energy(theta, dtheta)], data.energy])
        before = energies[:, 0] if before is None else before
        assert_close(*(energies[:, 0] - before), np.abs(energies).max())
        assert_close(*energies[:, 1], np.abs(energies).max())
        data.qacc[:] = theirs.acceleration(theta, dtheta, ddtheta)
        mujoco.mj_inverse(model, data)
        tau = robot.inverse_dynamics(theta, dtheta, ddtheta)
        assert_close(theirs.force(theta, tau), data.qfrc_inverse, np.abs(data.qfrc_inverse).max())
        assert_close(robot.forward_dynamics(theta, dtheta, tau), ddtheta, 1e3 * np.abs(ddtheta).max())


def test_arrays_and_parameters(robot, random):
    theta, dtheta, ddtheta = states(random, 50)
    tau = robot.inverse_dynamics(theta, dtheta, ddtheta)
    fast = robot.compile("inverse_dynamics", "forward_dynamics", "inverse_dynamics_derivatives")
    assert_close(fast.inverse_dynamics(theta, dtheta, ddtheta), tau, np.abs(tau).max())
    assert_close(fast.forward_dynamics(theta, dtheta, tau), ddtheta, 1e3 * np.abs(ddtheta).max())
    assert_close(robot.forward_dynamics(theta, dtheta, tau), ddtheta, 1e3 * np.abs(ddtheta).max())
    names, pi = robot.parameter_names, robot.parameters
    assert names[-1] == "differential.armature" and abs(pi[-1] - (0.1 + 25 * 0.01)) < 1e-15
    assert abs(pi[names.index("left.armature")] - 16 * 0.02) < 1e-15 and pi[names.index("shoulder.stiffness")] == 5
    assert_close(robot.regressor(theta, dtheta, ddtheta) @ pi, tau, np.abs(tau).max())
    light = pi.copy()
    light[-1] = 0
    rotor = np.zeros(11)
    rotor[-2:] = 2, -3
    without = robot.inverse_dynamics(theta, dtheta, ddtheta, parameters=light)
    assert_close(without + 0.35 * np.outer(ddtheta @ rotor, rotor), tau, np.abs(tau).max())
    again = pickle.loads(pickle.dumps(robot))
    assert np.array_equal(again.inverse_dynamics(theta, dtheta, ddtheta), tau)


def turned(q, w):
    """The quaternion q with a small turn w on the right, in the axes of what is turned."""
    (s, v), half = (q[0], q[1:]), np.asarray(w) / 2
    return np.array([s - v @ half, *(v + s * half + np.cross(v, half))])


def moved(theta, V):
    """theta along a small motion V of the stone (twist), the ball and the two hinges."""
    s, v = theta[0], theta[1:4]
    R = np.array([e + 2 * np.cross(v, s * e + np.cross(v, e)) for e in np.eye(3)])  # its rows are the body's axes
    return np.hstack([turned(theta[:4], V[:3]), theta[4:7] + V[3:6] @ R, turned(theta[7:11], V[6:9]), theta[11:] + V[9:]])


def test_derivatives(robot, random):
    (theta,), (dtheta,), (ddtheta,) = states(random, 1)
    by_theta, by_dtheta, M = robot.inverse_dynamics_derivatives(theta, dtheta, ddtheta)
    assert_close(M, robot.mass_matrix(theta), np.abs(M).max())
    e = 1e-6
    for j, column in enumerate(np.eye(11)):
        ends = [moved(theta, sign * e * column) for sign in (-1, 1)]
        slope = np.subtract(*(robot.inverse_dynamics(end, dtheta, ddtheta) for end in ends[::-1])) / (2 * e)
        assert_close(by_theta[:, j], slope, np.abs(by_theta).max(), tolerance=1e-8)
        ends = [robot.inverse_dynamics(theta, dtheta + sign * e * column, ddtheta) for sign in (1, -1)]
        assert_close(by_dtheta[:, j], np.subtract(*ends) / (2 * e), np.abs(by_dtheta).max(), tolerance=1e-8)


def test_energy_stays(robot, random):
    (theta,), (dtheta,), _ = states(random, 1)
    motion = robot.simulate(theta, dtheta, 0.5, 4000, method="rk4")
    energy = motion.kinetic_energy + motion.potential_energy
    assert np.ptp(energy) < 1e-8 * np.abs(energy).max()
