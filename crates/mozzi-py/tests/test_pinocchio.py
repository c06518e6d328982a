"""Every quantity that Pinocchio has, beside it."""

import mozzi
import numpy as np
import pinocchio as pin
import pytest
from beside_pinocchio import Beside
from conftest import MODELS, assert_close, positions, tip

SWAP = [3, 4, 5, 0, 1, 2]  # linear first, as Pinocchio has six-vectors


class Quantities(Beside):
    """With a frame to look at."""

    def __init__(self, name, floating):
        super().__init__(getattr(mozzi.models, name)(floating=floating), MODELS / f"{name}.urdf", mimic=True)
        self.has_mimic = any("Mimic" in joint.shortname() for joint in self.pin.joints)
        self.frame = tip(self.robot)
        self.frame_id = self.pin.getFrameId(self.frame)

    def columns(self, J):
        return J[SWAP][:, self.v]


@pytest.fixture(params=[("ur5", False), ("panda", False), ("anymal", False), ("anymal", True), ("furuta_pendulum", False)])
def both(request):
    return Quantities(*request.param)


def states(both, random, count=5):
    for _ in range(count):
        theta = positions(both.robot, random)
        dtheta, ddtheta = random.uniform(-2, 2, (2, both.robot.n))
        yield theta, dtheta, ddtheta, both.configuration(theta), both.velocity(dtheta), both.velocity(ddtheta)


def friction(both, dtheta):
    return both.robot.joint_friction(dtheta)


def test_dynamics(both, random):
    robot, model, data, v_of = both.robot, both.pin, both.data, both.v
    for theta, dtheta, ddtheta, q, v, a in states(both, random):
        tau = pin.rnea(model, data, q, v, a)[v_of]
        size = np.abs(tau).max()
        assert_close(robot.inverse_dynamics(theta, dtheta, ddtheta) - friction(both, dtheta), tau, size)
        M = pin.crba(model, data, q)
        M = (np.triu(M) + np.triu(M, 1).T)[np.ix_(v_of, v_of)]
        assert_close(robot.mass_matrix(theta), M)
        assert_close(robot.bias_forces(theta, dtheta), pin.nonLinearEffects(model, data, q, v)[v_of], size)
        assert_close(robot.gravity_forces(theta), pin.computeGeneralizedGravity(model, data, q)[v_of], size)
        c = pin.nonLinearEffects(model, data, q, v) - pin.computeGeneralizedGravity(model, data, q)
        assert_close(robot.velocity_product(theta, dtheta), c[v_of], size)
        found = robot.forward_dynamics(theta, dtheta, tau + friction(both, dtheta))
        assert_close(found, ddtheta, np.linalg.cond(M) * np.abs(ddtheta).max())
        if both.has_mimic:  # of which Pinocchio has no energies, and no rates
            continue
        assert_close(robot.kinetic_energy(theta, dtheta), pin.computeKineticEnergy(model, data, q, v))
        change = robot.potential_energy(theta) - robot.potential_energy(robot.neutral_configuration)
        theirs = [pin.computePotentialEnergy(model, data, x) for x in (q, pin.neutral(model))]
        assert_close(change, theirs[0] - theirs[1], np.abs(theirs).max())


def test_wrench_of_the_tip(both, random):
    robot, model, data = both.robot, both.pin, both.data
    wrench = random.uniform(-5, 5, 6)
    joint = model.frames[both.frame_id].parentJoint
    placement = model.frames[both.frame_id].placement
    for theta, dtheta, ddtheta, q, v, a in states(both, random):
        external = [pin.Force.Zero() for _ in range(model.njoints)]
        external[joint] = placement.act(pin.Force(-wrench[3:], -wrench[:3]))
        theirs = pin.rnea(model, data, q, v, a, external)[both.v]
        ours = robot.inverse_dynamics(theta, dtheta, ddtheta, applied_wrenches={both.frame: wrench})
        assert_close(ours - friction(both, dtheta), theirs)
        if robot.end_effector:
            assert np.array_equal(ours, robot.inverse_dynamics(theta, dtheta, ddtheta, wrench))
        J = pin.computeFrameJacobian(model, data, q, both.frame_id, pin.LOCAL)
        assert_close(robot.tip_forces(theta, applied_wrenches={both.frame: wrench}), both.columns(J).T @ wrench)


def test_kinematics(both, random):
    robot, model, data, frame = both.robot, both.pin, both.data, both.frame
    for theta, dtheta, _, q, v, _ in states(both, random):
        pin.framesForwardKinematics(model, data, q)
        T = data.oMf[both.frame_id]
        assert_close(robot.forward_kinematics(theta, frame), T.homogeneous)
        J = both.columns(pin.computeFrameJacobian(model, data, q, both.frame_id, pin.LOCAL))
        assert_close(robot.body_jacobian(theta, frame), J)
        Js = both.columns(pin.computeFrameJacobian(model, data, q, both.frame_id, pin.WORLD))
        assert_close(robot.space_jacobian(theta, frame), Js)
        if both.has_mimic:
            continue
        pin.computeJointJacobiansTimeVariation(model, data, q, v)
        pin.updateFramePlacements(model, data)
        dJ = both.columns(pin.getFrameJacobianTimeVariation(model, data, both.frame_id, pin.LOCAL))
        size = (np.abs(dJ) @ np.abs(dtheta)).max()
        assert_close(robot.body_jacobian_rate(theta, dtheta, frame) @ dtheta, dJ @ dtheta, size)


def test_derivatives(both, random):
    robot, model, data = both.robot, both.pin, both.data
    for theta, dtheta, ddtheta, q, v, a in states(both, random, 3):
        try:
            theirs = pin.computeRNEADerivatives(model, data, q, v, a)
        except RuntimeError:
            pytest.skip("Pinocchio has no derivatives of this robot's joints")
        rows = np.ix_(both.v, both.v)
        ours = robot.inverse_dynamics_derivatives(theta, dtheta, ddtheta)
        assert_close(ours.d_theta, theirs[0][rows])
        assert_close(ours.d_dtheta - np.diag(slope(robot)), theirs[1][rows])


def slope(robot):
    """∂f/∂θ̇ of viscous friction: f is odd and, but for its step at 0, linear."""
    ones = np.ones(robot.n)
    return robot.joint_friction(2 * ones) - robot.joint_friction(ones)


def test_momentum(both, random):
    robot, model, data = both.robot, both.pin, both.data
    for theta, dtheta, ddtheta, q, v, a in states(both, random, 3):
        A = pin.computeCentroidalMap(model, data, q)
        assert_close(robot.centroidal_momentum_matrix(theta), both.columns(A))
        assert_close(robot.center_of_mass(theta), pin.centerOfMass(model, data, q))
        pin.centerOfMass(model, data, q, v, a)
        assert_close(robot.center_of_mass_velocity(theta, dtheta), data.vcom[0])
        assert_close(robot.center_of_mass_acceleration(theta, dtheta, ddtheta), data.acom[0])
        assert_close(robot.center_of_mass_jacobian(theta), pin.jacobianCenterOfMass(model, data, q)[:, both.v])
