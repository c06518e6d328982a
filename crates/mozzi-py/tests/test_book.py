"""Every quantity a second way: the Modern Robotics package on random chains, differences, and the identities of mechanics."""

import modern_robotics as mr
import mozzi
import numpy as np
import pytest
from conftest import assert_close, state, tip


def pose(random):
    twist = random.uniform(-1, 1, 6)
    return mr.MatrixExp6(mr.VecTose3(twist))


def inertia(random):
    """Of a body seen from a frame that is not its centre of mass's."""
    parts = random.uniform(0.1, 1, 3)
    G = np.diag([*(parts[[1, 2, 0]] + parts[[2, 0, 1]]), *[random.uniform(0.5, 5)] * 3])
    Ad = mr.Adjoint(pose(random))
    return Ad.T @ G @ Ad


def chain(random, n):
    """M_list, G_list, S_list: revolute, prismatic and helical."""
    S = np.zeros((6, n))
    for k in range(n):
        axis = random.normal(size=3)
        axis /= np.linalg.norm(axis)
        if k % 3 == 1:
            S[3:, k] = axis
        else:
            S[:, k] = mr.ScrewToAxis(random.uniform(-1, 1, 3), axis, 0.3 * (k % 3 == 2))
    return np.array([pose(random) for _ in range(n + 1)]), np.array([inertia(random) for _ in range(n)]), S


@pytest.mark.parametrize("n", [1, 2, 3, 6, 9])
def test_chains_as_the_modern_robotics_package(n, random):
    M, G, S = chain(random, n)
    robot = mozzi.Model.from_screws(M, G, S)
    home = np.linalg.multi_dot([*M, np.eye(4)])
    g, F = random.uniform(-10, 10, 3), random.uniform(-3, 3, 6)
    for _ in range(3):
        theta, dtheta, ddtheta = random.uniform(-2, 2, (3, n))
        tau = mr.InverseDynamics(theta, dtheta, ddtheta, g, F, M, G, S)
        size = np.abs(tau).max()
        assert_close(robot.inverse_dynamics(theta, dtheta, ddtheta, F, gravity=g), tau, size)
        assert_close(robot.mass_matrix(theta), mr.MassMatrix(theta, M, G, S))
        assert_close(robot.velocity_product(theta, dtheta), mr.VelQuadraticForces(theta, dtheta, M, G, S), size)
        assert_close(robot.gravity_forces(theta, gravity=g), mr.GravityForces(theta, g, M, G, S), size)
        assert_close(robot.tip_forces(theta, F), mr.EndEffectorForces(theta, F, M, G, S), size)
        condition = np.linalg.cond(mr.MassMatrix(theta, M, G, S))
        found = robot.forward_dynamics(theta, dtheta, tau, F, gravity=g)
        assert_close(found, mr.ForwardDynamics(theta, dtheta, tau, g, F, M, G, S), condition * np.abs(ddtheta).max())
        assert_close(robot.forward_kinematics(theta), mr.FKinSpace(home, S, theta))
        assert_close(robot.space_jacobian(theta), mr.JacobianSpace(S, theta))
        T = mr.FKinSpace(home, S, theta)
        assert_close(robot.body_jacobian(theta), mr.Adjoint(mr.TransInv(T)) @ mr.JacobianSpace(S, theta))


def moved(robot, theta, dtheta, t):
    """θ after the time t at the rate dtheta; a floating base by its body twist."""
    if not robot.is_floating:
        return theta + t * dtheta
    T = mr.RpToTrans(rotation(theta[:4]), theta[4:7]) @ mr.MatrixExp6(mr.VecTose3(t * dtheta[:6]))
    half = t * dtheta[:3] / 2
    angle = np.linalg.norm(half)
    turn = np.array([np.cos(angle), *(np.sinc(angle / np.pi) * half)])
    return np.array([*product(theta[:4], turn), *T[:3, 3], *(theta[7:] + t * dtheta[6:])])


def product(p, q):
    return np.array([p[0] * q[0] - p[1:] @ q[1:], *(p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:]))])


def rotation(quaternion):
    w, v = quaternion[0], quaternion[1:]
    return np.eye(3) + 2 * w * mr.VecToso3(v) + 2 * mr.VecToso3(v) @ mr.VecToso3(v)


def rate(f, robot, theta, dtheta):
    """d/dt by differences: of fourth order, good to 1e-9."""
    h = 1e-3
    at = lambda k: f(moved(robot, theta, dtheta, k * h))
    return (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h)


def test_rates_by_differences(robot, random):
    frame = tip(robot)
    theta, dtheta, ddtheta = state(robot, random)
    close = lambda found, f: assert_close(found, rate(f, robot, theta, dtheta), tolerance=1e-8)
    close(robot.mass_matrix_rate(theta, dtheta), robot.mass_matrix)
    close(robot.space_jacobian_rate(theta, dtheta, frame), lambda x: robot.space_jacobian(x, frame))
    close(robot.body_jacobian_rate(theta, dtheta, frame), lambda x: robot.body_jacobian(x, frame))
    derivative = np.tensordot(dtheta, robot.body_jacobian_derivative(theta, frame), 1)
    assert_close(derivative, robot.body_jacobian_rate(theta, dtheta, frame))
    derivative = np.tensordot(dtheta, robot.space_jacobian_derivative(theta, frame), 1)
    assert_close(derivative, robot.space_jacobian_rate(theta, dtheta, frame))
    close(robot.center_of_mass_velocity(theta, dtheta), robot.center_of_mass)
    close(robot.momentum_rate(theta, dtheta, 0 * dtheta), lambda x: robot.momentum(x, dtheta))
    close(robot.gravity_forces_derivative(theta) @ dtheta, robot.gravity_forces)
    wrench = random.uniform(-3, 3, 6)
    forces = lambda x: robot.tip_forces(x, applied_wrenches={frame: wrench})
    close(robot.tip_forces_derivative(theta, applied_wrenches={frame: wrench}) @ dtheta, forces)
    close(robot.mass_matrix_product_derivative(theta, ddtheta) @ dtheta, lambda x: robot.mass_matrix(x) @ ddtheta)
    derivatives = robot.inverse_dynamics_derivatives(theta, dtheta, ddtheta)
    close(derivatives.d_theta @ dtheta, lambda x: robot.inverse_dynamics(x, dtheta, ddtheta))
    assert_close(derivatives.d_ddtheta, robot.mass_matrix(theta))
    tau = robot.inverse_dynamics(theta, dtheta, ddtheta)
    forward = robot.forward_dynamics_derivatives(theta, dtheta, tau)
    M = robot.mass_matrix(theta)
    size = np.linalg.cond(M)
    assert_close(forward.ddtheta, ddtheta, size)
    assert_close(M @ forward.d_tau, np.eye(robot.n), size)
    assert_close(M @ forward.d_theta, -derivatives.d_theta, size * np.abs(derivatives.d_theta).max())
    assert_close(M @ forward.d_dtheta, -derivatives.d_dtheta, size * np.abs(derivatives.d_dtheta).max())


def test_identities(robot, random):
    theta, dtheta, ddtheta = state(robot, random)
    M, C = robot.mass_matrix(theta), robot.coriolis_matrix(theta, dtheta)
    c, g = robot.velocity_product(theta, dtheta), robot.gravity_forces(theta)
    tau = robot.inverse_dynamics(theta, dtheta, ddtheta)
    friction = robot.joint_friction(dtheta)
    size = np.abs(tau).max()
    assert_close(C @ dtheta, c)
    assert_close(C + C.T, robot.mass_matrix_rate(theta, dtheta), np.abs(C).max())
    assert_close(robot.bias_forces(theta, dtheta), c + g, size)
    assert_close(M @ ddtheta + c + g + friction, tau, size)
    assert_close(robot.kinetic_energy(theta, dtheta), dtheta @ M @ dtheta / 2)
    assert_close(robot.regressor(theta, dtheta, ddtheta) @ robot.parameters, tau, size)
    assert len(robot.parameter_names) == len(robot.parameters)
    energies = robot.energy_regressors(theta, dtheta)
    assert_close(energies.kinetic @ robot.parameters, robot.kinetic_energy(theta, dtheta))
    assert_close(energies.potential @ robot.parameters, robot.potential_energy(theta))
    h = robot.momentum(theta, dtheta, about=robot.center_of_mass(theta))
    assert_close(robot.centroidal_momentum_matrix(theta) @ dtheta, h)
    total = robot.momentum_rate(theta, dtheta, ddtheta, about=robot.center_of_mass(theta))
    bias = robot.centroidal_momentum_bias(theta, dtheta)
    assert_close(robot.centroidal_momentum_matrix(theta) @ ddtheta + bias, total)
    J = robot.center_of_mass_jacobian(theta)
    assert_close(J @ dtheta, robot.center_of_mass_velocity(theta, dtheta))


def test_task_space(ur5, random):
    theta, dtheta, _ = state(ur5, random)
    J, dJ = ur5.body_jacobian(theta), ur5.body_jacobian_rate(theta, dtheta)
    inverse = np.linalg.inv(J)
    Lambda = inverse.T @ ur5.mass_matrix(theta) @ inverse
    eta = inverse.T @ ur5.bias_forces(theta, dtheta) - Lambda @ dJ @ dtheta
    found = ur5.task_space_dynamics(theta, dtheta)
    size = np.linalg.cond(J) ** 2 * np.abs(Lambda).max()
    assert_close(found.Lambda, Lambda, size)
    assert_close(found.eta, eta, size)
    some = ur5.task_space_dynamics(theta, dtheta, rows=[3, 4, 5])
    rows = J[3:]
    assert_close(np.linalg.inv(some.Lambda), rows @ np.linalg.inv(ur5.mass_matrix(theta)) @ rows.T)


def test_simulation_keeps_the_energy_and_follows_its_own_equation():
    pendulum = mozzi.models.double_pendulum()
    fall = pendulum.simulate([1.0, 0.5], [0.0, 0.0], 2.0, 2000)
    assert fall.t.shape == (2001,) and fall.t[-1] == 2.0
    assert np.abs(fall.energy - fall.energy[0]).max() < 1e-7
    assert_close(pendulum.forward_dynamics(fall.theta, fall.dtheta, fall.tau), fall.ddtheta)
    held = pendulum.simulate([1.0, 0.5], [0.0, 0.0], 1.0, 100, torque="gravity_compensation")
    assert np.abs(held.theta - [1.0, 0.5]).max() < 1e-12
    calls = []

    def torque(t, theta, dtheta):
        calls.append(t)
        return pendulum.gravity_forces(theta)

    asked = pendulum.simulate([1.0, 0.5], [0.0, 0.0], 1.0, 100, torque=torque)
    assert len(calls) >= 400 and np.abs(asked.theta - held.theta).max() < 1e-12
    constant = pendulum.simulate([0.0, 0.0], [0.0, 0.0], 1.0, 100, torque=[0.3, -0.1])
    assert_close(constant.tau, np.broadcast_to([0.3, -0.1], constant.tau.shape))


def test_what_a_torque_raises_comes_through(ur5):
    def torque(t, theta, dtheta):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        ur5.simulate([0.0] * 6, [0.0] * 6, 1.0, 10, torque=torque)
    with pytest.raises(ValueError, match=r"tau has shape \(5,\)"):
        ur5.simulate([0.0] * 6, [0.0] * 6, 1.0, 10, torque=lambda t, theta, dtheta: [0.0] * 5)


def test_the_lists_make_the_same_robot(ur5, random):
    lists = ur5.screws()
    again = mozzi.Model.from_screws([*lists.M_relative, np.eye(4)], lists.G, lists.S)
    theta, dtheta, ddtheta = state(ur5, random, 3)
    mine = ur5.inverse_dynamics(theta, dtheta, ddtheta) - ur5.joint_friction(dtheta)
    assert_close(again.inverse_dynamics(theta, dtheta, ddtheta), mine)


def test_closed_form_and_recursion(robot, random):
    theta, dtheta, ddtheta = state(robot, random)
    wrench, frame = random.uniform(-3, 3, 6), tip(robot)
    form = robot.closed_form(theta, dtheta, applied_wrenches={frame: wrench})
    size = np.abs(robot.bias_forces(theta, dtheta)).max()
    assert_close(form.M, robot.mass_matrix(theta))
    assert_close(form.c, robot.velocity_product(theta, dtheta), size)
    assert_close(form.g, robot.gravity_forces(theta), size)
    assert_close(form.tip_forces, robot.tip_forces(theta, applied_wrenches={frame: wrench}))
    assert_close(form.L, np.linalg.inv(np.eye(len(form.L)) - form.W))
    assert_close(form.A.T @ form.L.T @ form.G @ form.L @ form.A + form.armature, form.M)
    found = robot.newton_euler(theta, dtheta, ddtheta, applied_wrenches={frame: wrench})
    assert_close(found.tau, robot.inverse_dynamics(theta, dtheta, ddtheta, applied_wrenches={frame: wrench}), size)
    if not robot.is_floating:
        assert_close(found.twists.ravel(), form.V)
    poses = robot.frame_poses(np.stack([theta, theta]))
    assert_close(poses[1, robot.frames.index(frame)], robot.forward_kinematics(theta, frame))
    with pytest.raises(ValueError, match=r"theta has shape \(2, \d+\), expected \(\d+,\): one state"):
        robot.closed_form(np.stack([theta, theta]), dtheta)


def test_base_parameters(ur5, random):
    base = ur5.base_parameters()
    Y = ur5.regressor(*state(ur5, random, 50)).reshape(300, -1)
    assert np.linalg.matrix_rank(Y, 1e-9 * np.linalg.norm(Y)) == len(base.columns) == len(base.names)
    assert_close(Y[:, base.columns] @ base.combination, Y)
