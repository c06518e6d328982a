"""The bridges, beside the libraries themselves."""

import doctest

import mozzi
import mujoco
import numpy as np
import pinocchio as pin
import pytest
from conftest import MODELS, assert_close, positions, state, tip
from mozzi import conventions


@pytest.mark.parametrize("name, floating", [("ur5", False), ("panda", False), ("anymal", False), ("anymal", True)])
def test_pinocchio(name, floating, random):
    robot = getattr(mozzi.models, name)(floating=floating)
    free = (pin.JointModelFreeFlyer(),) if floating else ()
    model = pin.buildModelFromUrdf(str(MODELS / f"{name}.urdf"), *free, mimic=True)
    data = model.createData()
    for bridge in (conventions.Pinocchio(robot), conventions.Pinocchio(robot, model)):
        theta, dtheta, ddtheta = state(robot, random)
        q, v, a = bridge.configuration(theta), bridge.velocity(dtheta), bridge.acceleration(ddtheta)
        assert len(q) == bridge.nq == model.nq
        tau = robot.inverse_dynamics(theta, dtheta, ddtheta) - robot.joint_friction(dtheta)
        assert_close(bridge.force(tau), pin.rnea(model, data, q, v, a))
        M = np.triu(pin.crba(model, data, q))
        M = M + np.triu(M, 1).T
        assert_close(bridge.mass_matrix(robot.mass_matrix(theta)), M)
        assert_close(bridge.from_mass_matrix(M), robot.mass_matrix(theta))
        frame = tip(robot)
        J = pin.computeFrameJacobian(model, data, q, model.getFrameId(frame), pin.LOCAL)
        assert_close(bridge.jacobian(robot.body_jacobian(theta, frame)), J)
        back = [bridge.from_velocity(v), bridge.from_acceleration(a), bridge.from_force(bridge.force(tau))]
        assert all(np.array_equal(found, expected) for found, expected in zip(back, (dtheta, ddtheta, tau)))
        assert_close(bridge.configuration(bridge.from_configuration(q)), q)
    many = positions(robot, random, 3, 2)
    assert np.array_equal(bridge.configuration(many)[2, 1], bridge.configuration(many[2, 1]))
    wrench = random.uniform(-1, 1, 6)
    frame_id = model.getFrameId(frame)
    joint, placement = model.frames[frame_id].parentJoint, model.frames[frame_id].placement
    forces = [pin.Force.Zero() for _ in range(model.njoints)]
    forces[joint] = placement.act(pin.Force(conventions.external(wrench)))
    tau = robot.inverse_dynamics(theta, dtheta, ddtheta, applied_wrenches={frame: wrench})
    assert_close(bridge.force(tau - robot.joint_friction(dtheta)), pin.rnea(model, data, q, v, a, forces))


@pytest.mark.parametrize("floating", [False, True])
def test_mujoco(floating, random):
    robot = mozzi.models.ur5(floating=floating)
    text = (MODELS / "ur5.urdf").read_text()
    spec = mujoco.MjSpec.from_string(text)
    spec.compiler.fusestatic = False
    if floating:
        spec.bodies[1].add_freejoint()
    model = spec.compile()
    data = mujoco.MjData(model)
    for bridge in (conventions.MuJoCo(robot), conventions.MuJoCo(robot, model)):
        theta, dtheta, ddtheta = state(robot, random)
        data.qpos[:], data.qvel[:] = bridge.configuration(theta), bridge.velocity(theta, dtheta)
        mujoco.mj_forward(model, data)
        M = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, M)
        assert_close(bridge.mass_matrix(theta, robot.mass_matrix(theta)), M, tolerance=1e-10)
        h = robot.bias_forces(theta, dtheta)
        assert_close(bridge.bias_forces(theta, dtheta, robot.mass_matrix(theta), h), data.qfrc_bias, tolerance=1e-10)
        back = bridge.from_bias_forces(data.qpos, data.qvel, robot.mass_matrix(theta), data.qfrc_bias)
        assert_close(back, h, tolerance=1e-10)
        assert_close(bridge.from_mass_matrix(data.qpos, M), robot.mass_matrix(theta), tolerance=1e-10)
        assert_close(bridge.from_configuration(data.qpos), theta)
        assert_close(bridge.from_velocity(data.qpos, data.qvel), dtheta)
        acceleration = bridge.acceleration(theta, dtheta, ddtheta)
        assert_close(bridge.from_acceleration(data.qpos, data.qvel, acceleration), ddtheta)
        assert_close(bridge.from_force(data.qpos, bridge.force(theta, h)), h)


def test_six_vectors():
    six = np.arange(12.0).reshape(2, 6)
    assert conventions.linear_first(six)[1].tolist() == [9, 10, 11, 6, 7, 8]
    assert conventions.external(np.arange(6, dtype=np.uint8)).tolist() == [-3, -4, -5, 0, -1, -2]
    with pytest.raises(TypeError, match="expected real numbers"):
        conventions.linear_first(list("abcdef"))
    assert np.array_equal(conventions.angular_first(conventions.linear_first(six)), six)
    assert np.array_equal(conventions.from_external(conventions.external(six)), six)
    with pytest.raises(ValueError, match=r"the six-vector has shape \(3,\), expected \(..., 6\)"):
        conventions.linear_first([1, 2, 3])


def test_bridges_show_their_sizes():
    anymal = mozzi.models.anymal(floating=True)
    bridge = conventions.Pinocchio(anymal)
    assert repr(bridge) == f"<mozzi.conventions.Pinocchio: 12 joints, q has {bridge.nq} entries>"
    assert repr(conventions.MuJoCo(anymal)) == "<mozzi.conventions.MuJoCo: 12 joints>"


@pytest.mark.filterwarnings("ignore::mozzi.LoadWarning")
def test_mimic_joints_have_their_places_in_mujoco(tmp_path, random):
    robot = mozzi.models.panda()
    robot.save(tmp_path / "panda.xml")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "panda.xml"))
    data = mujoco.MjData(model)
    theta, dtheta, ddtheta = state(robot, random)
    for bridge in (conventions.MuJoCo(robot), conventions.MuJoCo(robot, model)):
        data.qpos[:], data.qvel[:] = bridge.configuration(theta), bridge.velocity(theta, dtheta)
        finger = [model.joint(f"panda_finger_joint{k}").qposadr[0] for k in (1, 2)]
        assert data.qpos[finger[0]] == data.qpos[finger[1]] == theta[-1]
        mujoco.mj_forward(model, data)
        M = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, M)
        mine, h = robot.mass_matrix(theta), robot.bias_forces(theta, dtheta)
        assert_close(bridge.from_mass_matrix(data.qpos, M), mine, tolerance=1e-10)
        assert_close(bridge.from_bias_forces(data.qpos, data.qvel, mine, data.qfrc_bias), h, tolerance=1e-10)
        assert_close(bridge.from_configuration(data.qpos), theta)
        assert_close(bridge.from_velocity(data.qpos, data.qvel), dtheta)
        acceleration = bridge.acceleration(theta, dtheta, ddtheta)
        assert_close(bridge.from_acceleration(data.qpos, data.qvel, acceleration), ddtheta)
        assert_close(bridge.from_force(data.qpos, bridge.force(theta, h)), h)
        with pytest.raises(ValueError, match="M is that of a robot with the mimic joint `panda_finger_joint2`"):
            bridge.mass_matrix(theta, mine)


def test_joints_without_names():
    text = """<mujoco><worldbody><body><freejoint/><geom size=".1"/></body><body name="a"><joint name="joint3"/>
    <joint type="slide" axis="1 0 0"/><geom size=".1"/><body pos=".3 0 0"><joint axis="0 1 0"/><geom size=".1"/></body>
    </body></worldbody></mujoco>"""
    robot = mozzi.Model.from_urdf_string(text, name="a.xml")
    bridge = conventions.MuJoCo(robot, mujoco.MjModel.from_xml_string(text))
    assert robot.joint_names == ["body1:free", "joint3", "joint2", "joint3'"]
    assert bridge.joints == [0, 1, 2, 3]


def test_quaternions_of_mujoco_are_normalized(random):
    robot = mozzi.models.anymal(floating=True)
    bridge = conventions.MuJoCo(robot)
    theta, dtheta, _ = state(robot, random)
    qpos = bridge.configuration(theta)
    noisy = qpos.copy()
    noisy[3:7] *= 1.3
    assert_close(bridge.from_configuration(noisy), theta)
    assert np.array_equal(bridge.from_configuration(qpos), theta)
    assert_close(bridge.from_velocity(noisy, dtheta), bridge.from_velocity(qpos, dtheta))


def test_errors(ur5):
    bridge = conventions.Pinocchio(ur5)
    with pytest.raises(ValueError, match="theta has 5 entries, expected 6"):
        bridge.configuration(np.zeros(5))
    with pytest.raises(ValueError, match="M"):
        bridge.mass_matrix(np.zeros((6, 5)))
    with pytest.raises(ValueError, match="theta has shape"):
        bridge.configuration(0.0)
    free = conventions.MuJoCo(mozzi.models.anymal())
    with pytest.raises(ValueError, match="quaternion"):
        free.velocity(np.zeros(19), np.zeros(18))


def test_examples_of_the_documentation():
    assert doctest.testmod(conventions).failed == 0


def test_no_states_give_no_states_of_the_others_shape():
    panda, anymal = mozzi.models.panda(), mozzi.models.anymal(floating=True)
    pinocchio, theirs = conventions.Pinocchio(anymal), conventions.MuJoCo(anymal)
    n, nq = anymal.n, anymal.nq
    circles = conventions.Pinocchio(mozzi.models.furuta_pendulum())
    assert circles.configuration(np.zeros((0, 2))).shape == (0, circles.nq)
    assert pinocchio.mass_matrix(np.zeros((2, 0, n, n))).shape == (2, 0, n, n)
    assert conventions.MuJoCo(panda).configuration(np.zeros((0, 8))).shape == (0, 9)
    bias = theirs.from_bias_forces(np.zeros((0, nq)), np.zeros((0, n)), np.zeros((0, n, n)), np.zeros((0, n)))
    assert bias.shape == (0, n)
    with pytest.raises(ValueError, match="q has 99 entries, expected 19"):
        pinocchio.from_configuration(np.zeros((0, 99)))
