"""mozzi.identify and mozzi.excite."""

import mozzi
import numpy as np
import pytest


@pytest.fixture(scope="module")
def arm():
    return mozzi.models.double_pendulum()


@pytest.fixture(scope="module")
def log(arm):
    """Sines with the torques of a robot that carries 0.4 kg at its tip, and friction."""
    t = np.arange(0.0, 10.0, 0.01)
    w = np.array([[1.3, 2.1, 3.7], [1.9, 2.9, 4.1]])
    phase = w[:, :, None] * t + np.arange(3)[None, :, None]
    theta = np.sin(phase).sum(1).T
    dtheta = (w[:, :, None] * np.cos(phase)).sum(1).T
    ddtheta = (-(w[:, :, None] ** 2) * np.sin(phase)).sum(1).T
    heavy = arm.with_payload(arm.end_effector, 0.4)
    tau = heavy.inverse_dynamics(theta, dtheta, ddtheta) + 0.3 * np.tanh(dtheta / 0.05) + 0.1 * dtheta
    return {"t": t, "theta": theta, "dtheta": dtheta, "tau": tau}


def test_forces_are_predicted_by_a_robot_that_can_exist(arm, log, tmp_path):
    found = mozzi.identify(arm, log, torque="link", fit=0.7, cutoff=float("inf"))
    held_out = found.report["held_out"]
    assert held_out["nrms"] < 0.02 < np.divide(held_out["robot"], held_out["force"]).min()
    assert found.forces[0].predicted.shape == found.forces[0].measured.shape
    theta = np.random.default_rng(1).uniform(-3, 3, (50, 2))
    assert np.linalg.eigvalsh(found.model.mass_matrix(theta)).min() > 0
    assert found.parameters["joint1.friction"] == pytest.approx(0.3, abs=0.05)
    found.html(tmp_path / "fit.html")
    assert (tmp_path / "fit.html").read_text().startswith("<!doctype html>")
    assert "NRMS" in repr(found)


def test_a_payload_is_weighed(arm, log):
    found = mozzi.identify(arm, log, only="payload")
    assert found.parameters["payload.m"] == pytest.approx(0.4, abs=0.02)


def test_contradictions_are_refused_or_warnings(arm, log):
    swapped = {**log, **{name: log[name][:, ::-1] for name in ("theta", "dtheta", "tau")}}
    with pytest.raises(ValueError, match="columns of joint1 and joint2 seem to be swapped"):
        mozzi.identify(arm, swapped)
    found = mozzi.identify(arm, swapped, trust_log=True)
    assert any("seem to be swapped" in text for text in found.findings)


def test_the_verdict_is_data(arm, log):
    found = mozzi.identify(arm, log)
    assert found.verdict.is_trusted and found.verdict.nrms < 0.05 < found.verdict.of_file
    assert found.verdict.predicted == "LeftOut" and "predicts unseen torques" in found.verdict.text
    assert found.verdict.payload is None
    weighed = mozzi.identify(arm, log, only="payload").verdict.payload
    assert weighed.mass == pytest.approx(0.4, abs=0.02) and weighed.frame == arm.end_effector
    milliseconds = mozzi.identify(arm, {**log, "t": 1000 * log["t"]})
    assert milliseconds.verdict.nrms == pytest.approx(found.verdict.nrms, rel=0.02)


def test_wrong_arguments_are_named(arm, log):
    with pytest.raises(ValueError, match="log 1 has no 'tau'"):
        mozzi.identify(arm, {"t": log["t"], "theta": log["theta"]})
    with pytest.raises(ValueError, match="torque is 'gear'"):
        mozzi.identify(arm, log, torque="gear")
    with pytest.raises(ValueError, match="usable rows"):
        mozzi.identify(arm, {name: table[:10] for name, table in log.items()})
    with pytest.raises(ValueError, match="the prior's weight is -1"):
        mozzi.identify(arm, log, prior=-1)


def test_tables_under_other_names_are_refused(arm, log):
    others = {name: table for name, table in log.items() if name != "dtheta"}
    with pytest.raises(ValueError, match="log 1 has 'qd', expected t, theta, dtheta"):
        mozzi.identify(arm, {**others, "qd": log["dtheta"]})
    energy = mozzi.identify(arm, {**log, "energy": np.zeros((len(log["t"]), 3))}, cutoff=5.0)
    assert energy.verdict.nrms == mozzi.identify(arm, log, cutoff=5.0).verdict.nrms


def test_the_verdict_of_a_payload_is_relative_to_the_forces(arm, log):
    verdict = mozzi.identify(arm, log, only="payload").verdict
    assert verdict.of_file < 1 and verdict.nrms < verdict.of_file


def test_a_motion_excites_within_limits(arm):
    found = mozzi.excite(arm, 4.0, harmonics=2, velocity=2.0, acceleration=8.0)
    assert found.condition < found.condition_of_random
    assert np.abs(found.dtheta).max() <= 2.02 and np.abs(found.ddtheta).max() <= 8.1
    assert np.allclose(found.dtheta[[0, -1]], 0, atol=1e-9)
    # the last row is the end, whatever the step
    uneven = mozzi.excite(arm, 4.0, harmonics=2, step=0.3)
    assert uneven.t[-1] == 4.0 and np.allclose(uneven.dtheta[-1], 0, atol=1e-9)


MJCF = """<mujoco model="pendulum">
  <default><joint damping="0.2"/></default>
  <worldbody>
    <body name="rod1">
      <inertial pos="0 0 -0.25" mass="1" diaginertia="0.02 0.02 0.001"/>
      <joint name="joint1" axis="0 -1 0"/>
      <body name="rod2" pos="0 0 -0.5">
        <inertial pos="0 0 -0.25" mass="1" diaginertia="0.02 0.02 0.001"/>
        <joint name="joint2" axis="0 -1 0"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""


def test_mjcf_is_written_as_mjcf(log, tmp_path):
    source, target = tmp_path / "arm.xml", tmp_path / "identified.xml"
    source.write_text(MJCF)
    found = mozzi.identify(mozzi.Model.from_mjcf(source), log, torque="link")
    assert found.write(source, target, old_values=True) == [str(target)]
    text = target.read_text()
    assert '<default><joint damping="0.2"/></default>' in text and "<!-- before: mass 1.0" in text
    again = mozzi.Model.from_mjcf(target)
    theta = np.random.default_rng(2).uniform(-3, 3, (20, 2))
    assert np.allclose(again.mass_matrix(theta), found.model.mass_matrix(theta), rtol=1e-9)
    with pytest.raises(ValueError, match="the robot's own file"):
        found.write(source, source)


def test_a_floating_base_is_identified_by_its_contact_wrench():
    robot = mozzi.models.ur5().with_floating_base()  # its base has mass: a link without it has no prior
    t = np.arange(0.0, 5.0, 0.005)
    j = np.arange(robot.n)
    a, w, p = 0.6 + 0.05 * j, 2.0 + 0.37 * j, 0.9 * j
    dtheta = a * np.cos(w * t[:, None] + p)
    ddtheta = -a * w * np.sin(w * t[:, None] + p)
    # positions are not those of the velocities, which a log is refused for; nothing is differentiated
    quaternion = np.column_stack([np.ones_like(t), *(0.6 * np.sin((1.1 + 0.4 * k) * t + k) for k in range(3))])
    quaternion /= np.linalg.norm(quaternion, axis=1, keepdims=True)
    theta = np.hstack([quaternion, np.sin(np.outer(t, 1.7 + 0.3 * np.arange(robot.nq - 4)))])
    # the robot of the log carries 0.5 kg at its tip, where it is held
    heavy = robot.with_payload("tool0", 0.5)
    tau = heavy.inverse_dynamics(theta, dtheta, ddtheta)
    J = robot.body_jacobian(theta, frame="tool0")
    F = np.linalg.solve(np.swapaxes(J[:, :, :6], 1, 2), -tau[:, :6, None])[:, :, 0]
    tau = tau + np.einsum("kij,ki->kj", J, F)
    assert np.abs(tau[:, :6]).max() < 1e-9
    log = {"t": t, "theta": theta, "dtheta": dtheta, "ddtheta": ddtheta, "tau": tau[:, 6:], "wrench_tool0": F}
    with pytest.raises(ValueError, match="the velocity of shoulder_pan_joint is not the derivative"):
        mozzi.identify(robot, log, torque="link", cutoff=float("inf"))
    found = mozzi.identify(robot, log, torque="link", cutoff=float("inf"), trust_log=True)
    masses = sum(value for name, value in found.parameters.items() if name.endswith(".m"))
    assert masses == pytest.approx(robot.mass + 0.5, rel=0.01)
    with pytest.raises(ValueError, match="wrench_toe|toe"):
        mozzi.identify(robot, {**log, "wrench_toe": F})


def test_noise_on_a_floating_robot_is_no_mistake():
    """Its rows of positions are longer than those of velocities."""
    robot = mozzi.models.anymal()
    random, rows = np.random.default_rng(0), 399

    def torque(t, theta, dtheta):
        return np.r_[np.zeros(6), 20 * np.sin(3 * t + np.arange(12)) - dtheta[6:]]

    run = robot.simulate(robot.neutral_configuration, None, rows / 100, rows, torque=torque)
    tau = run.tau.copy()
    tau[:, 6:] += random.normal(0, 3, tau[:, 6:].shape)
    found = mozzi.identify(robot, {"t": run.t, "theta": run.theta, "dtheta": run.dtheta, "tau": tau})
    codes = {finding["code"] for finding in found.report["findings"]}
    assert not codes & {"sign", "unit", "swapped_joints", "offset", "wrench"}, found.findings


def test_position_controllers():
    """Targets that are made from the torques of a PD law, logged five rows before they act."""
    robot = mozzi.models.double_pendulum()
    motion = mozzi.excite(robot, 5.0, harmonics=3, velocity=3.0, acceleration=10.0)
    tau = robot.inverse_dynamics(motion.theta, motion.dtheta, motion.ddtheta)
    kp, kd, late = np.array([120.0, 40.0]), np.array([9.0, 3.0]), 5
    target = motion.theta + (tau + kd * motion.dtheta) / kp
    rows = slice(0, -late)
    log = {"t": motion.t[rows], "theta": motion.theta[rows], "dtheta": motion.dtheta[rows], "tau": tau[rows]}
    found = mozzi.identify(robot, {**log, "target": target[late:]})
    delay = late * (motion.t[1] - motion.t[0])
    for law, gains in zip(found.servos.values(), zip(kp, kd)):
        np.testing.assert_allclose([law["stiffness"], law["damping"]], gains, rtol=0.05)
        np.testing.assert_allclose(law["delay"], delay, rtol=0.05)
    assert len(found.servos) == 2
    assert mozzi.identify(robot, log).servos == {}


def test_wrong_options_are_named(ur5):
    log = {"t": np.arange(50.0), "theta": np.zeros((50, 6)), "tau": np.zeros((50, 6))}
    for wrong, words in [
        ({"acceleration": "Spline"}, "acceleration is 'Spline', expected 'differences' or 'spline'"),
        ({"total_mass": 20}, "total_mass is 20, expected a mass and its standard deviation"),
        ({"total_mass": (-1, 0.1)}, "the total mass is -1 kg with a deviation of 0.1 kg, expected two positive numbers"),
        ({"fit": 2.0}, "fit is 2, expected a part of the log"),
        ({"fit": 0.72}, "fit is 0.72, expected a part of the log: 0.1, 0.2"),
        ({"payload": "tool0"}, 'payload is .tool0., which only="payload" estimates'),
    ]:
        with pytest.raises((TypeError, ValueError), match=words):
            mozzi.identify(ur5, log, **wrong)
    for logs, words in [("log.csv", "logs is 'log.csv', expected a mapping"), (None, "logs is None, expected a mapping")]:
        with pytest.raises(TypeError, match=words):
            mozzi.identify(ur5, logs)
    with pytest.raises(ValueError, match="step is 5 and duration 2, expected a number of seconds from"):
        mozzi.excite(ur5, 2.0, step=5)
