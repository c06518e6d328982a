"""Springs in the joints, beside MuJoCo and in every way that arrays go."""

import pickle

import mozzi
import numpy as np
import pytest
from conftest import assert_close, load_mjcf

ROBOT = """
<mujoco><compiler angle="radian"/><option gravity="0.4 -1 -9.5"/><worldbody>
  <body name="a" pos="0 0 0.2"><joint name="a" axis="0 1 0.2" stiffness="7" springref="0.5" damping="0.3" armature="0.1"/>
    <geom size="0.1" pos="0.2 0 0.3"/>
    <body name="b" pos="0.1 0 0.4"><joint name="b" type="slide" axis="1 0 1" stiffness="90" springref="-0.2"/>
      <geom size="0.08" pos="0.1 0.1 0"/>
      <body name="c" pos="0 0.1 0.2"><joint name="c" axis="1 0 0.3" ref="0.4"/><geom size="0.07" pos="0.2 0.1 0.1"/>
        <body name="d" pos="0 0 0.3"><joint name="d" axis="0 0 1" springdamper="0.2 0.7" springref="0.3"/>
          <geom type="capsule" fromto="0 0 0 0.2 0.3 0.1" size="0.05"/></body></body></body></body>
</worldbody></mujoco>"""


@pytest.fixture
def robot(tmp_path):
    return load_mjcf(tmp_path, ROBOT)


def test_mujoco(robot, random):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(ROBOT)
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    data = mujoco.MjData(model)
    before = None
    for _ in range(20):
        data.qpos[:], data.qvel[:], data.qacc[:] = random.uniform(-4, 4, (3, 4))
        theta, dtheta, ddtheta = data.qpos.copy(), data.qvel.copy(), data.qacc.copy()
        mujoco.mj_inverse(model, data)
        size = np.abs(data.qfrc_inverse).max()
        assert_close(robot.inverse_dynamics(theta, dtheta, ddtheta), data.qfrc_inverse, size)
        assert_close(robot.spring_forces(theta), -data.qfrc_spring, size)
        assert_close(robot.bias_forces(theta, dtheta), data.qfrc_bias, size)
        data.qfrc_applied[:] = random.uniform(-5, 5, 4)
        mujoco.mj_forward(model, data)
        assert_close(robot.forward_dynamics(theta, dtheta, data.qfrc_applied), data.qacc, tolerance=1e-9)
        energies = np.array([robot.potential_energy(theta), data.energy[0]])
        before = energies if before is None else before
        assert_close(*(energies - before), np.abs(energies).max())


def test_arrays_and_parameters(robot, random):
    theta, dtheta, ddtheta = random.uniform(-2, 2, (3, 50, 4))
    tau = robot.inverse_dynamics(theta, dtheta, ddtheta)
    fast = robot.compile("inverse_dynamics", "inverse_dynamics_derivatives")
    assert_close(fast.inverse_dynamics(theta, dtheta, ddtheta), tau, np.abs(tau).max())
    Y, pi = robot.regressor(theta, dtheta, ddtheta), robot.parameters
    assert_close(Y @ pi, tau, np.abs(tau).max())
    names = robot.parameter_names
    assert pi[names.index("a.stiffness")] == 7 and abs(pi[names.index("a.preload")] - 3.5) < 1e-15
    slack = np.array([0.0 if name.endswith((".stiffness", ".preload")) else x for name, x in zip(names, pi)])
    without = robot.inverse_dynamics(theta, dtheta, ddtheta, parameters=slack)
    assert_close(without + robot.spring_forces(theta), tau, np.abs(tau).max())
    e = 1e-6
    for j, column in enumerate(np.eye(4)):
        ends = [robot.inverse_dynamics(theta[0] + sign * e * column, dtheta[0], ddtheta[0]) for sign in (-1, 1)]
        slope = (ends[1] - ends[0]) / (2 * e)
        found = robot.inverse_dynamics_derivatives(theta[0], dtheta[0], ddtheta[0])[0][:, j]
        assert_close(found, slope, np.abs(slope).max(), tolerance=1e-6)
    assert_close(pickle.loads(pickle.dumps(robot)).spring_forces(theta), robot.spring_forces(theta))


def test_gravity_compensation_holds_the_springs_too(robot, random):
    theta = random.uniform(-1, 1, (3, 4))
    many = robot.simulate(theta, np.zeros((3, 4)), 0.5, 100, torque="gravity_compensation")
    one = robot.simulate(list(theta[0]), [0.0] * 4, 0.5, 100, torque="gravity_compensation")
    assert np.abs(many.theta[:, -1] - theta).max() < 1e-9
    assert np.abs(one.theta[-1] - theta[0]).max() < 1e-9
    assert np.abs(one.tau[0] - (robot.gravity_forces(theta[0]) + robot.spring_forces(theta[0]))).max() < 1e-12
    free = robot.simulate(theta[0], np.zeros(4), 0.5, 4000)
    energy = free.kinetic_energy + free.potential_energy + free.friction_loss
    assert np.ptp(energy) < 1e-6 * np.abs(energy).max()
