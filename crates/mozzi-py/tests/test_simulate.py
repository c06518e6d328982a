"""Simulation from many starts beside simulation from each."""

import _thread
import pickle
import re
import signal
import threading

import mozzi
import numpy as np
import pytest
from conftest import assert_close, state

COLUMNS = ("t", "theta", "dtheta", "ddtheta", "tau", "kinetic_energy", "potential_energy", "energy")


@pytest.mark.parametrize("method", ["rk4", "semi-implicit-euler", "euler"])
def test_each_start_by_itself(robot, method, random):
    theta, dtheta, _ = state(robot, random, 3, 2)

    def motors(t, theta, dtheta):
        assert theta.shape[:-1] == dtheta.shape[:-1] in ((), (3, 2))
        return (np.arange(robot.n) >= robot.n - len(robot.joint_names)) * (np.cos(9 * t) - dtheta)  # none of a floating base

    constant = motors(0, theta, dtheta)
    for torque in (None, constant[1, 0], constant, "gravity_compensation", motors):
        options = dict(method=method, record_every=4, gravity=[0, 1, -3])
        many = robot.simulate(theta, dtheta, 0.1, 10, torque=torque, **options)
        assert many.theta.shape == (3, 2, 4, robot.nq) and many.energy.shape == (3, 2, 4)
        assert many.t.tolist() == pytest.approx([0, 0.04, 0.08, 0.1], abs=1e-15)
        for place in np.ndindex(3, 2):
            own = torque[place] if isinstance(torque, np.ndarray) and torque.ndim > 1 else torque
            one = robot.simulate(theta[place], dtheta[place], 0.1, 10, torque=own, **options)
            for name in COLUMNS:
                found = getattr(many, name)
                size = max(np.abs(one.dtheta).max(), 1) if name == "ddtheta" else None
                assert_close(found if name == "t" else found[place], getattr(one, name), size, tolerance=1e-11)


def test_axes_and_threads(ur5, random):
    theta, dtheta, tau = state(ur5, random, 530)
    expected = ur5.simulate(theta, dtheta, 0.05, 5, torque=tau, threads=1)
    for threads in (None, 2, 3):
        found = ur5.simulate(theta, dtheta, 0.05, 5, torque=tau, threads=threads)
        assert np.array_equal(found.theta, expected.theta) and np.array_equal(found.ddtheta, expected.ddtheta)
    again = pickle.loads(pickle.dumps(expected))
    assert again.model == ur5 and np.array_equal(again.tau, expected.tau)
    spread = ur5.simulate(theta[:4, None], dtheta[0], 0.05, 5, torque=tau[:3].tolist())
    assert spread.theta.shape == (4, 3, 6, 6)
    assert_close(spread.theta[2, 1], ur5.simulate(theta[2], dtheta[0], 0.05, 5, torque=tau[1]).theta)
    assert ur5.simulate(theta[0], dtheta[0], 0.05, 5, torque=tau[:2]).theta.shape == (2, 6, 6)
    assert ur5.simulate(np.zeros((0, 6)), np.zeros(6), 1, 10).theta.shape == (0, 11, 6)
    assert np.array_equal(ur5.simulate(theta[:2], dtheta[:2], 0, 1).theta[:, 1], theta[:2])
    fixed = mozzi.Model.from_urdf_string("<robot name='fixed'><link name='base'/></robot>")
    still = fixed.simulate(np.zeros((3, 0)), np.zeros(0), 1, 4, record_every=3)
    assert still.theta.shape == (3, 3, 0) and still.t.tolist() == [0, 0.75, 1] and not still.energy.any()


def test_by_machine_code(robot, random):
    theta, dtheta, _ = state(robot, random, 2)
    fast = robot.compile("forward_dynamics")
    for start in [(theta[0], dtheta[0]), (theta, dtheta)]:
        for options in (dict(), dict(gravity=[0, 0, -1.6]), dict(torque="gravity_compensation")):
            found, expected = fast.simulate(*start, 0.05, 5, **options), robot.simulate(*start, 0.05, 5, **options)
            assert_close(found.theta, expected.theta)
            assert_close(found.dtheta, expected.dtheta, tolerance=1e-10)
            assert found.model == robot


def test_a_table(ur5, random):
    theta, dtheta, _ = state(ur5, random, 3)
    found = ur5.simulate(theta, dtheta, 0.1, 4, record_every=2)
    frame = found.to_pandas()
    assert frame.shape == (9, 24) and frame.index.names == ["start", "t"]
    assert np.array_equal(frame.loc[1, "dtheta.elbow_joint"], found.dtheta[1, :, 2])
    one = ur5.simulate(theta[1], dtheta[1], 0.1, 4, record_every=2).to_pandas()
    assert list(one.columns) == list(frame.columns)
    assert_close(frame.loc[1].to_numpy(), one.to_numpy())


def refused(kind, text):
    return pytest.raises(kind, match="^" + re.escape(text))


def test_wrong_arguments_are_named(ur5):
    many, one = np.zeros((4, 6)), np.zeros(6)
    joints = "one value per joint of 'ur5' (shoulder_pan_joint, …)"
    with refused(ValueError, f"theta has shape (4, 5), expected (..., 6): {joints}"):
        ur5.simulate(np.zeros((4, 5)), one, 1, 10)
    with refused(ValueError, "dtheta has leading axes (3,), which do not go with (4,) of the arguments before it"):
        ur5.simulate(many, np.zeros((3, 6)), 1, 10)
    with refused(ValueError, "tau has leading axes (5,), which do not go with (4,) of the arguments before it"):
        ur5.simulate(many, one, 1, 10, torque=np.zeros((5, 6)))
    for wrong, text in [((1, 0), "steps is 0"), ((-1, 5), "duration is -1")]:
        with refused(ValueError, text):
            ur5.simulate(many, one, *wrong)
    with refused(ValueError, "record_every is 0"):
        ur5.simulate(many, one, 1, 10, record_every=0)
    many[2, 3] = np.nan
    with refused(ValueError, "state [2]: theta is NaN, expected a finite number"):
        ur5.simulate(many, one, 1, 10)
    with refused(ValueError, "state [2]: tau is NaN, expected a finite number"):
        ur5.simulate(one, one, 1, 10, torque=many)
    anymal = mozzi.models.anymal()
    theta = np.tile(anymal.neutral_configuration, (3, 1))
    theta[1, :4] = 0
    with pytest.raises(ValueError, match=r"state \[1\]: .*quaternion"):
        anymal.simulate(theta, np.zeros(18), 1, 10)


def test_functions_of_all_starts(ur5):
    many, one = np.zeros((2, 3, 6)), np.zeros(6)
    with refused(ValueError, "tau has shape (6,), expected (2, 3, 6): the torque's function is called once for all starts"):
        ur5.simulate(many, one, 1, 10, torque=lambda t, theta, dtheta: one)
    with refused(ValueError, "tau has shape (2, 3, 5), expected (..., 6)"):
        ur5.simulate(many, one, 1, 10, torque=lambda t, theta, dtheta: theta[..., :5])
    with refused(TypeError, "tau holds None"):
        ur5.simulate(many, one, 1, 10, torque=lambda t, theta, dtheta: None)

    def lost(t, theta, dtheta):
        return np.where(t > 0.25, np.nan, 0) * theta

    with refused(ValueError, "state [0, 0]: the input's torque is NaN at joint `shoulder_pan_joint`, t = 0.3"):
        ur5.simulate(many, one, 1, 10, torque=lost, method="euler")

    def broken(t, theta, dtheta):
        raise LookupError("no table")

    with refused(LookupError, "no table"):
        ur5.simulate(many, one, 1, 10, torque=broken)


def test_a_blow_up_is_named(ur5):
    many, one = np.zeros((2, 3, 6)), np.zeros(6)
    for size in (1e160, 1e300):
        torque = many.copy()
        torque[1, 2, 4] = size
        with pytest.raises(mozzi.DivergedError, match=r"^state \[1, 2\]: the simulation diverged: .* in step \d+, at t = 0"):
            ur5.simulate(many, one, 1, 20, torque=torque)
    stiff = many.copy()
    stiff[0, 1] = 1.0
    with pytest.raises(mozzi.DivergedError, match=r"^state \[0, 1\]: "):
        ur5.simulate(stiff, one, 1, 200, torque=lambda t, theta, dtheta: -1e9 * theta, gravity=[0, 0, 0], method="euler")
    singular = mozzi.Model.from_screws(
        [np.eye(4)] * 3, [np.diag([0.1, 0.1, 0.1, 1, 1, 1]), np.zeros((6, 6))], np.eye(6)[:, [2, 2]]
    )
    with pytest.raises(mozzi.SingularError, match=r"^state \[0\]: .*joint2"):
        singular.simulate(np.zeros((4, 2)), np.zeros(2), 1, 10)


@pytest.mark.parametrize("torque", [None, "gravity_compensation", lambda t, theta, dtheta: -dtheta])
def test_interrupted(ur5, torque):
    # what a shell starts in the background ignores the signal
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    starts = np.zeros((40, 6))
    timer = threading.Timer(0.3, _thread.interrupt_main)  # itself in need of Python's lock
    with pytest.raises(KeyboardInterrupt):
        timer.start()
        ur5.simulate(starts, np.zeros(6), 1e3, 10**7, torque=torque, record_every=10**7)
    timer.join()
    signal.signal(signal.SIGINT, before)


def test_methods_agree():
    robot = mozzi.models.double_pendulum()
    expected = robot.simulate([2.0, 1.0], [0, 0], 1.0, 2000, record_every=200)
    for method, tolerance, error in (("dopri", 1e-10, 1e-7), ("dopri", 1e-6, 1e-3), ("midpoint", None, 1e-4)):
        found = robot.simulate([2.0, 1.0], [0, 0], 1.0, 2000, record_every=200, method=method, tolerance=tolerance)
        assert np.array_equal(found.t, expected.t) or method == "midpoint"
        assert_close(found.t, expected.t)
        assert np.abs(found.theta - expected.theta).max() < error, method
    fast = robot.compile("forward_dynamics").simulate([2.0, 1.0], [0, 0], 1.0, 2000, record_every=200, method="dopri")
    assert np.abs(fast.theta - expected.theta).max() < 1e-6


def test_events():
    robot = mozzi.models.double_pendulum()

    def elbow_high(t, theta, dtheta):
        return theta[1] - 1.2

    start = ([2.0, 1.0], [0.0, 0.0])
    words = robot.simulate(*start, 2.0, 200, method="dopri", events=["joint1 = 0", elbow_high], until="joint2 > 2.5")
    assert {event.name for event in words.events} <= {"joint1 = 0", "elbow_high", "joint2 > 2.5"}
    *before, last = words.events
    assert last.end and last.name == "joint2 > 2.5" and words.t[-1] == last.t < 2
    assert abs(last.theta[1] - 2.5) < 1e-10 and np.array_equal(words.theta[-1], last.theta)
    assert before and not any(event.end for event in before)
    assert all(abs(event.theta[1] - 1.2) < 1e-10 for event in before if event.name == "elbow_high")
    by_function = robot.simulate(*start, 2.0, 200, method="dopri", until=lambda t, theta, dtheta: theta[1] - 2.5)
    assert by_function.events[-1].name == "<lambda>" and abs(by_function.t[-1] - last.t) < 1e-6
    assert robot.simulate(*start, 0.1, 10).events == []

    def broken(t, theta, dtheta):
        raise LookupError("no such thing")

    with pytest.raises(LookupError, match="no such thing"):
        robot.simulate(*start, 1.0, 10, events=broken)
    with refused(ValueError, "`joint9 > 1`: there is no `joint9`, expected one of `joint1`, `joint2`"):
        robot.simulate(*start, 1.0, 10, until="joint9 > 1")
    with refused(TypeError, "events has an entry of type int, expected a function"):
        robot.simulate(*start, 1.0, 10, events=[3])


def test_joint_limits():
    panda = mozzi.models.panda()
    theta = np.array([0, -0.5, 0, -2, 0, 1.6, 0.8, 0.02])
    options = dict(method="dopri", tolerance=1e-8)
    reported, ignored = (
        panda.simulate(theta, np.zeros(8), 1.0, 100, joint_limits=how, **options) for how in ("report", "ignore")
    )
    assert ignored.joint_limits == [] and np.array_equal(reported.theta, ignored.theta)
    first = reported.joint_limits[0]
    assert first.joint in panda.joint_names and first.beyond > 0 and 0 < first.first < 1
    with pytest.raises(ValueError, match=f"`{first.joint}` reaches its limit .* `moreau`"):
        panda.simulate(theta, np.zeros(8), 1.0, 100, joint_limits="respect", **options)
    respected = panda.simulate(theta, np.zeros(8), 0.5, 500, joint_limits="respect")
    assert respected.joint_limits and all(limit.beyond == 0 for limit in respected.joint_limits)


def test_many_starts_one_by_one(ur5, random):
    theta, dtheta, tau = state(ur5, random, 3)
    dampened = [dict(slip_speed=0.1), dict(method="midpoint"), dict(method="dopri"), dict(joint_limits="respect")]
    for options in dampened:
        many = ur5.simulate(theta, dtheta, 0.05, 10, torque=tau, record_every=3, **options)
        for k in range(3):
            one = ur5.simulate(theta[k], dtheta[k], 0.05, 10, torque=tau[k], record_every=3, **options)
            assert np.array_equal(many.theta[k], one.theta) and np.array_equal(many.ddtheta[k], one.ddtheta)
            assert np.abs(many.t - one.t).max() < 1e-15 and np.array_equal(many.energy[k], one.energy)
    with pytest.raises(TypeError, match="torque is a function, expected an array"):
        ur5.simulate(theta, dtheta, 0.05, 10, method="midpoint", torque=lambda t, theta, dtheta: -dtheta)


def test_what_takes_one_start(ur5):
    many, one = np.zeros((2, 6)), np.zeros(6)
    with refused(ValueError, "until or events is given, expected None of many starts"):
        ur5.simulate(many, one, 1, 10, until="elbow_joint > 1")
    with refused(ValueError, "joint_limits is 'obey', expected 'ignore', 'report' or 'respect'"):
        ur5.simulate(one, one, 1, 10, joint_limits="obey")
    with refused(ValueError, "tolerance is 0.001 and method 'rk4', expected 'dopri' or no tolerance"):
        ur5.simulate(one, one, 1, 10, method="rk4", tolerance=1e-3)
    with refused(ValueError, "tolerance is 0, expected a positive, finite number"):
        ur5.simulate(one, one, 1, 10, method="dopri", tolerance=0)


def test_a_bool_counts_where_it_becomes_true():
    pendulum = mozzi.models.double_pendulum()

    def run(until):
        return pendulum.simulate([-0.5, 0.0], None, 2.0, 2000, until=until)

    zero = run(lambda t, theta, dtheta: theta[0] - 0.1)
    for condition in [lambda t, theta, dtheta: theta[0] > 0.1, lambda t, theta, dtheta: bool(theta[0] > 0.1)]:
        np.testing.assert_allclose(run(condition).t[-1], zero.t[-1], rtol=1e-9)
    assert run(lambda t, theta, dtheta: t >= 0.5).t[-1] == pytest.approx(0.5)
    with pytest.raises(ValueError, match="the function of until is True at the start, expected False"):
        run(lambda t, theta, dtheta: theta[0] < 0.1)
    with pytest.raises(TypeError, match="the function of until answered None, expected a number or a bool"):
        run(lambda t, theta, dtheta: None)
    with pytest.raises(ValueError, match="the function of until answered nan at t = 0.5"):
        run(lambda t, theta, dtheta: np.nan if t > 0.5 else 1.0)


def test_torques_of_each_step_are_a_rollouts(ur5):
    with pytest.raises(ValueError, match=r"torque has shape \(50, 6\), expected \(6,\), constant, .* `rollout`"):
        ur5.simulate(np.zeros(6), None, 0.1, 50, torque=np.ones((50, 6)))
    assert ur5.simulate(np.zeros((50, 6)), None, 0.1, 50, torque=np.ones((50, 6))).theta.shape == (50, 51, 6)
    with pytest.raises(ValueError, match="steps is 1000000000000, expected at most 1e9"):
        ur5.simulate(np.zeros((3, 6)), None, 1.0, 10**12)
