"""Rollouts under tables of torques, and gradients through them."""

import mozzi
import numpy as np
import pytest
from conftest import assert_close, state

METHODS = ["rk4", "semi-implicit-euler", "euler"]


def case(robot, random, *leading, steps=8):
    theta, dtheta, _ = state(robot, random, *leading)
    tau = random.uniform(-1, 1, (*leading, steps, robot.n))
    bars = [random.normal(size=(*leading, steps + 1, robot.n)) for _ in range(2)]
    return theta, 0.3 * dtheta, tau, *bars


@pytest.mark.parametrize("method", [*METHODS, "midpoint"])
def test_states_are_those_of_simulate(robot, method, random):
    theta, dtheta, tau, *_ = case(robot, random)
    tau[:] = tau[0]
    found = robot.rollout(theta, dtheta, tau, 0.01, method=method)
    expected = robot.simulate(theta, dtheta, 0.08, 8, torque=tau[0], method=method)
    assert_close(found.theta, expected.theta, tolerance=1e-12)
    assert_close(found.dtheta, expected.dtheta, tolerance=1e-12)


@pytest.mark.parametrize("method", [*METHODS, "midpoint"])
def test_each_start_by_itself(robot, method, random):
    theta, dtheta, tau, *bars = case(robot, random, 3, 2)
    many = robot.rollout(theta, dtheta, tau, 0.01, method)
    assert many.theta.shape == (3, 2, 9, robot.nq) and many.dtheta.shape == (3, 2, 9, robot.n)
    gradients = robot.rollout_vjp(theta, dtheta, tau, 0.01, *bars, method, parameters=True)
    assert [x.shape for x in gradients[:3]] == [(3, 2, robot.n)] * 2 + [(3, 2, 8, robot.n)]
    assert gradients[3].shape == (3, 2, len(robot.parameters))
    for at in np.ndindex(3, 2):
        own = theta[at], dtheta[at], tau[at], 0.01
        for found, expected in zip(many, robot.rollout(*own, method), strict=True):
            assert_close(found[at], expected, tolerance=1e-11)
        one = robot.rollout_vjp(*own, *(bar[at] for bar in bars), method, parameters=True)
        for found, expected in zip(gradients, one, strict=True):
            assert_close(found[at], expected, tolerance=1e-10)
    without = robot.rollout_vjp(theta, dtheta, tau, 0.01, *bars, method)
    assert len(without) == 3 and all(np.array_equal(a, b) for a, b in zip(without, gradients))


@pytest.mark.parametrize("method", ["rk4", "midpoint"])
def test_gradients_are_slopes_of_the_loss(robot, method, random):
    theta, dtheta, tau, *bars = case(robot, random)
    tau *= 0.1
    base, first = (6, 7) if robot.nq > robot.n else (0, 0)
    bars[0][:, :base] = 0  # of the joints' positions alone: a floating base's are no vector
    by_theta, by_dtheta, by_tau = robot.rollout_vjp(theta, dtheta, tau, 0.01, *bars, method=method)
    here = robot.rollout(theta, dtheta, tau, 0.01, method)
    along = [random.normal(size=x.shape) for x in (by_theta, by_dtheta, by_tau)]
    along[0][:base] = 0

    def loss(e):
        moved = np.concatenate([theta[:first], theta[first:] + e * along[0][base:]])
        there = robot.rollout(moved, dtheta + e * along[1], tau + e * along[2], 0.01, method)
        way = (there.theta - here.theta)[:, first:]
        return np.sum(way * bars[0][:, base:]) + np.sum((there.dtheta - here.dtheta) * bars[1])

    e = 1e-6
    slope = (loss(e) - loss(-e)) / (2 * e)
    found = sum(np.sum(x * y) for x, y in zip(along, (by_theta, by_dtheta, by_tau), strict=True))
    assert abs(slope - found) < 1e-5 * max(1, abs(found))


def test_axes_and_threads(ur5, random):
    theta, dtheta, tau, *bars = case(ur5, random, 150)
    expected = ur5.rollout_vjp(theta, dtheta, tau, 0.01, *bars, parameters=True, threads=1)
    for threads in (None, 2, 3):
        found = ur5.rollout_vjp(theta, dtheta, tau, 0.01, *bars, parameters=True, threads=threads)
        assert all(np.array_equal(a, b) for a, b in zip(found, expected, strict=True))
    # one start under many tables of torques, one table of cotangents
    by_theta, _, by_tau = ur5.rollout_vjp(theta[0], dtheta[0], tau[:4], 0.01, bars[0][0], bars[1][0])
    assert by_theta.shape == (4, 6) and by_tau.shape == (4, 8, 6)
    assert ur5.rollout(np.zeros((0, 6)), np.zeros(6), np.zeros((8, 6)), 0.01).theta.shape == (0, 9, 6)
    none = ur5.rollout_vjp(theta[:2], dtheta[:2], np.zeros((0, 6)), 0.01, bars[0][:2, :1], bars[1][:2, :1])
    assert np.array_equal(none[0], bars[0][:2, 0]) and none[2].shape == (2, 0, 6)
    single = ur5.rollout(theta.astype(np.float32), dtheta, tau, 0.01)
    assert single.theta.dtype == np.float64
    turned = ur5.with_gravity([0, 1, -3]).rollout(theta[0], dtheta[0], tau[0], 0.01)
    assert np.array_equal(ur5.rollout(theta[0], dtheta[0], tau[0], 0.01, gravity=[0, 1, -3]).theta, turned.theta)
    assert_close(ur5.rollout(theta[:2], dtheta[:2], tau[0], 0.01, gravity=[0, 1, -3]).theta[0], turned.theta)


def test_what_is_refused(ur5, random):
    theta, dtheta, tau, *bars = case(ur5, random, 2)
    with pytest.raises(ValueError, match=r"tau has shape \(6,\), expected \(..., N, 6\)"):
        ur5.rollout(theta, dtheta, tau[0, 0], 0.01)
    with pytest.raises(ValueError, match=r"theta_bar has shape \(2, 8, 6\), expected \(..., 9, 6\)"):
        ur5.rollout_vjp(theta, dtheta, tau, 0.01, bars[0][:, 1:], bars[1])
    for step in (0, -1, np.nan):
        for start in (theta, theta[0]):
            with pytest.raises(ValueError, match="the step"):
                ur5.rollout(start, dtheta[0], tau[0], step)
    expected = "'rk4', 'semi-implicit-euler', 'euler' or 'midpoint'"
    for method in ("dopri", "auto", "moreau"):
        with pytest.raises(ValueError, match=f"method is '{method}', expected {expected}"):
            ur5.rollout(theta, dtheta, tau, 0.01, method)
    with pytest.raises(ValueError, match="expected 'rk4'"):
        ur5.rollout(theta, dtheta, tau, 0.01, "heun")
    tau[1, 3, 2] = 1e300
    with pytest.raises(mozzi.DivergedError, match=r"state \[1\]"):
        ur5.rollout(theta, dtheta, tau, 0.01)
    with pytest.raises(mozzi.DivergedError, match=r"state \[1\]"):
        ur5.rollout_vjp(theta, dtheta, tau, 0.01, *bars)
    theta[1, 0] = np.inf
    with pytest.raises(ValueError, match=r"state \[1\]: .*theta"):
        ur5.rollout(theta, dtheta, tau, 0.01)
