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


def test_swapped_joints_are_noticed(arm, log):
    swapped = {name: table if name == "t" else table[:, ::-1].copy() for name, table in log.items()}
    found = mozzi.identify(arm, swapped)
    assert any("swapped" in finding for finding in found.findings)


def test_wrong_arguments_are_named(arm, log):
    with pytest.raises(ValueError, match="log 1 has no 'tau'"):
        mozzi.identify(arm, {"t": log["t"], "theta": log["theta"]})
    with pytest.raises(ValueError, match="torque is 'gear'"):
        mozzi.identify(arm, log, torque="gear")
    with pytest.raises(ValueError, match="usable rows"):
        mozzi.identify(arm, {name: table[:10] for name, table in log.items()})
    with pytest.raises(ValueError, match="the prior's weight is -1"):
        mozzi.identify(arm, log, prior=-1)


def test_a_motion_excites_within_limits(arm):
    found = mozzi.excite(arm, 4.0, harmonics=2, velocity=2.0, acceleration=8.0)
    assert found.condition < found.condition_of_random
    assert np.abs(found.dtheta).max() <= 2.02 and np.abs(found.ddtheta).max() <= 8.1
    assert np.allclose(found.dtheta[[0, -1]], 0, atol=1e-9)
