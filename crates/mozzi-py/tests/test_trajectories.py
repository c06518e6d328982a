"""Trajectories: rates by numerical derivatives, the book's time scalings, limits that hold, frames on their lines."""

import mozzi
import numpy as np
import pytest
from conftest import assert_close
from mozzi.trajectories import (
    Cartesian,
    Hold,
    Line,
    OfJoints,
    Path,
    Profile,
    Recorded,
    Reference,
    Spline,
    Timed,
    poses_between,
)

VIA = np.array(
    [
        [0.0, -1.5, 1.5, 0.0, 0.5, 0.0],
        [0.5, -1.0, 0.8, 0.5, 1.0, 0.7],
        [1.5, -1.2, 1.0, -0.4, 0.2, 1.0],
        [1.0, -0.6, 0.4, 0.0, 0.0, 0.0],
    ]
)
START = np.array([0.0, -1.2, 1.5, 0.3, 1.1, 0.0])


def assert_rates(f, x, tolerance=1e-6):
    """The second and third part of f are the derivatives of the part before, by central differences."""
    e = 1e-6
    before, now, after = f(x - e), f(x), f(x + e)
    for part in (0, 1):
        assert_close((after[part] - before[part]) / (2 * e), now[part + 1], 1 + np.abs(now[part + 1]).max(), tolerance)


def profiles():
    return {
        "linear": Profile.linear(2.0),
        "cubic": Profile.cubic(0.7),
        "quintic": Profile.quintic(3.0),
        "trapezoidal": Profile.trapezoidal(0.5, 2.0),
        "trapezoidal_in": Profile.trapezoidal_in(4.0, 0.25),
    }


@pytest.mark.parametrize("name", profiles())
def test_profiles(name):
    profile = profiles()[name]
    T = profile.duration
    assert_rates(profile.at, np.linspace(0.013 * T, 0.987 * T, 57))
    ends = profile.at([-1.0, 0.0, T, T + 1.0])
    assert_close(ends.s, [0, 0, 1, 1])
    assert_close(ends.ds[[0, 3]], [0, 0])
    one = profile.at(0.3 * T)
    assert isinstance(one.s, float) and one == tuple(x[0, 0] for x in profile.at([[0.3 * T]]))
    slower = profile.in_time(2 * T)
    assert slower.duration == pytest.approx(2 * T) and slower.at(0.6 * T).s == pytest.approx(one.s)
    assert slower != profile and profile == profiles()[name] and "Profile" in repr(profile)


def test_time_scalings_are_the_books():
    x = np.linspace(0, 1, 21)
    assert_close(Profile.cubic(2.0).at(2 * x).s, 3 * x**2 - 2 * x**3)
    assert_close(Profile.quintic(2.0).at(2 * x).s, 10 * x**3 - 15 * x**4 + 6 * x**5)
    assert Profile.trapezoidal(0.5, 2.0).duration == pytest.approx(1 / 0.5 + 0.5 / 2.0)
    assert Profile.trapezoidal_in(4.0, 0.25).at(2.0).ds == pytest.approx(1 / 3)


def test_lines(ur5):
    line = Line(ur5, VIA[0], VIA[1])
    assert isinstance(line, Path) and line.model == ur5
    s = np.array([[0.0, 0.25], [0.5, 1.0]])
    point = line.at(s)
    assert_close(point.theta, VIA[0] + s[..., None] * (VIA[1] - VIA[0]))
    assert_close(point.slope, np.broadcast_to(VIA[1] - VIA[0], (2, 2, 6)))
    assert not point.curvature.any() and point.theta.dtype == np.float64
    # a floating base moves along a screw
    anymal = mozzi.models.anymal()
    start, goal = anymal.neutral_configuration, anymal.neutral_configuration
    goal[:7] = [np.cos(0.4), 0, 0, np.sin(0.4), 1, 2, 3]
    base = anymal.frames[0]
    line = Line(anymal, start, goal)
    T0, T1 = (anymal.forward_kinematics(theta, base) for theta in (start, goal))
    assert_close(anymal.forward_kinematics(line.at(s).theta, base), poses_between(T0, T1, s))


def test_splines(ur5):
    spline = Spline(ur5, VIA)
    assert_rates(spline.at, np.linspace(0.011, 0.989, 83), 1e-5)
    way = np.cumsum(np.r_[0, np.linalg.norm(np.diff(VIA, axis=0), axis=1)])
    assert_close(spline.at(way / way[-1]).theta, VIA)
    assert_close(spline.at([0.0, 1.0]).curvature, np.zeros((2, 6)), 1.0)
    rest = Spline(ur5, VIA, [1.0, 2.0, 2.5, 4.0], ends="at rest")
    assert_close(rest.at([0, 1 / 3, 0.5, 1.0]).theta, VIA)
    assert_close(rest.at([0.0, 1.0]).slope, np.zeros((2, 6)), 1.0)


@pytest.mark.parametrize("shape", ["screw", "straight"])
def test_a_frame_on_its_line(ur5, shape):
    T0 = ur5.forward_kinematics(START)
    T1 = poses_between(T0, T0, 0.0)
    T1[:3, 3] += [-0.1, 0.3, -0.1]
    T1[:3, :3] = T1[:3, :3] @ np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    path = Cartesian(ur5, START, T1, shape=shape, tolerance=1e-7)
    s = np.linspace(0, 1, 101)
    poses = ur5.forward_kinematics(path.at(s).theta)
    assert_close(poses, poses_between(T0, T1, s, shape=shape), tolerance=5e-7)
    assert path.deviation <= 1e-7 and path.knots >= 9
    if shape == "straight":
        assert_close(poses[:, :3, 3], T0[:3, 3] + s[:, None] * (T1[:3, 3] - T0[:3, 3]), tolerance=5e-7)
    T1[:3, 3] = [3, 0, 0]
    with pytest.raises(mozzi.MotionError, match="at s = .* of the path: .* is in the way: frame `tool0` did not reach its goal"):
        Cartesian(ur5, START, T1, shape=shape)


def test_poses_between_are_the_books_packages(random):
    mr = pytest.importorskip("modern_robotics")
    ends = [mr.MatrixExp6(mr.VecTose3(random.uniform(-1, 1, 6))) for _ in range(2)]
    for shape, theirs in (("screw", mr.ScrewTrajectory), ("straight", mr.CartesianTrajectory)):
        s = Profile.quintic(3.0).at(np.linspace(0, 3, 9)).s
        assert_close(poses_between(*ends, s, shape=shape), theirs(*ends, 3, 9, 5))


def test_timed_paths(ur5):
    motion = Timed(Spline(ur5, VIA), Profile.quintic(2.5))
    assert isinstance(motion, Reference) and motion.duration == 2.5 and motion.model == ur5
    assert motion.profile == Profile.quintic(2.5) and isinstance(motion.path, Spline)
    assert_rates(motion.at, np.linspace(0.021, 2.477, 47), 1e-5)
    after = motion.at([-1.0, 3.0])
    assert_close(after.theta, VIA[[0, -1]], tolerance=1e-15)
    assert not after.dtheta.any() and not after.ddtheta.any()
    assert motion.at(1.0).theta.shape == (6,)


def test_the_fastest_motion_keeps_its_limits_and_uses_them(ur5):
    spline = Spline(ur5, VIA)
    fastest = spline.time_optimal(acceleration=15.0, intervals=300)
    motion = Timed(spline, fastest)
    now = motion.at(np.linspace(0, fastest.duration, 600))
    tau = ur5.inverse_dynamics(*now)
    used = abs(now.dtheta) / ur5.velocity_limits, abs(now.ddtheta) / 15.0, abs(tau) / ur5.effort_limits
    assert all(share.max() < 1.02 for share in used) and max(share.max() for share in used) > 0.98
    for shape in (Profile.cubic(1.0), Profile.quintic(1.0), Profile.trapezoidal_in(1.0, 0.25)):
        slower = spline.stretched(shape, acceleration=15.0)
        assert slower.duration > fastest.duration
    # without limits but of velocity: a line at constant speed but for its ends
    line = Line(ur5, np.zeros(6), [1.0, 0, 0, 0, 0, 0])
    assert line.time_optimal(velocity=2.0, torque=np.inf).duration == pytest.approx(0.5, rel=0.02)
    limit = [np.inf] * 6
    with pytest.raises(mozzi.MotionError, match="nothing limits the speed at s = "):
        line.time_optimal(velocity=limit, torque=limit)
    with pytest.raises(mozzi.MotionError, match="the motor of `shoulder_lift_joint` is too weak at s = 0"):
        line.time_optimal(torque=5.0)
    with pytest.raises(ValueError, match=r"velocity has shape \(2,\), expected \(6,\)"):
        line.time_optimal(velocity=[1.0, 2.0])
    with pytest.raises(ValueError, match="an acceleration limit is -1 of `shoulder_pan_joint`, expected a"):
        line.time_optimal(acceleration=-1.0)


def test_recorded_tables(ur5):
    motion = Timed(Spline(ur5, VIA), Profile.quintic(2.5))
    t = np.linspace(0, 2.5, 40)
    rows = motion.at(t)
    for count in (1, 2, 3):
        table = Recorded(ur5, t, *rows[:count])
        assert table.duration == 2.5
        assert_close(table.at(t).theta, rows.theta, tolerance=1e-14)
        for found, expected in zip(table.at(t)[:count], rows):
            assert_close(found, expected, 1 + np.abs(expected).max(), 1e-10)
        assert_rates(table.at, np.linspace(0.021, 2.477, 47), 1e-4)
    with pytest.raises(ValueError, match="the s of a via point is 0 in row 2, expected numbers that increase"):
        Recorded(ur5, np.zeros(2), rows.theta[:2])
    with pytest.raises(ValueError, match="a list of rates has 3 entries, expected 40"):
        Recorded(ur5, t, rows.theta, rows.dtheta[:3])


def test_positions_to_hold_and_floating_bases(ur5):
    held = Hold(ur5, START).at([[0.0], [9.0]])
    assert_close(held.theta, np.broadcast_to(START, (2, 1, 6)))
    assert not held.dtheta.any() and held.ddtheta.shape == (2, 1, 6)
    free = ur5.with_floating_base()
    motion = OfJoints(free, Timed(Line(ur5, VIA[0], VIA[1]), Profile.cubic(2.0)), pose=[1, 0, 0, 0, 0, 0, 2])
    now = motion.at(1.0)
    assert motion.duration == 2.0 and now.theta.shape == (13,) and now.dtheta.shape == (12,)
    assert_close(now.theta[:7], [1, 0, 0, 0, 0, 0, 2])
    assert_close(now.theta[7:], 0.5 * (VIA[0] + VIA[1]))
    with pytest.raises(ValueError, match="'ur5' has a fixed base, expected a floating one"):
        OfJoints(ur5, Hold(ur5, START))
    with pytest.raises(ValueError, match=r"the motion of the joints has shape \(2,\), expected \(6,\)"):
        OfJoints(free, Hold(mozzi.models.double_pendulum(), [0, 0]))


def test_paths_and_references_show_what_they_are(ur5):
    pendulum, anymal = mozzi.models.double_pendulum(), mozzi.models.anymal()
    name = pendulum.name
    line = Line(pendulum, [0.0, 0.5], [1.0, -2.0])
    fall = pendulum.simulate([1.0, 0.0], [0.0, 0.0], 1.5, 10)
    goal = ur5.forward_kinematics(START)
    goal[:3, 3] += [-0.1, 0.1, -0.1]
    for made, expected in [
        (line, f"<mozzi.trajectories.Line of '{name}' from (0, 0.5) to (1, -2)>"),
        (Spline(ur5, VIA), f"<mozzi.trajectories.Spline of 'ur5' through {len(VIA)} points>"),
        (Timed(line, Profile.cubic(2.5)), f"<mozzi.trajectories.Timed of '{name}': a Line in 2.5 s>"),
        (Recorded(pendulum, fall.t, fall.theta), f"<mozzi.trajectories.Recorded of '{name}': 1.5 s>"),
        (Hold(pendulum, [0.5, 1.0]), f"<mozzi.trajectories.Hold of '{name}' at (0.5, 1)>"),
        (
            Hold(anymal, anymal.neutral_configuration),
            "<mozzi.trajectories.Hold of 'anymal' at (1, 0, 0, 0, 0, 0, 0, 0, …)>",
        ),
        (
            OfJoints(ur5.with_floating_base(), Timed(Line(ur5, VIA[0], VIA[1]), Profile.cubic(1.0))),
            "<mozzi.trajectories.OfJoints of 'ur5': 1 s>",
        ),
    ]:
        assert repr(made) == expected
    path = Cartesian(ur5, START, goal)
    assert repr(path) == f"<mozzi.trajectories.Cartesian of 'ur5' through {path.knots} solutions of inverse kinematics>"


def test_wrong_arguments_are_named(ur5):
    line, profile = Line(ur5, VIA[0], VIA[1]), Profile.cubic(1.0)
    for call, words in [
        (lambda: line.at(1.5), "s is 1.5, expected numbers from 0 to 1"),
        (lambda: line.at([[0.5, -1.0]]), r"s\[0, 1\] is -1, expected numbers from 0 to 1"),
        (lambda: profile.at([0.0, np.nan]), r"t\[1\] is NaN, expected finite numbers of seconds"),
        (lambda: Profile.cubic(0.0), "the duration is 0, expected a positive, finite number of seconds"),
        (lambda: Line(ur5, VIA[0], [0.0]), r"goal has shape \(1,\), expected \(6,\)"),
        (lambda: Line(ur5, VIA[0], VIA[0] * np.nan).at(0.5), "the end of a line is .*NaN.*, expected finite numbers"),
        (lambda: Hold(ur5, np.full(6, np.inf)), r"theta\[0\] is inf, expected a finite number"),
        (lambda: line.time_optimal(intervals=10**12), "the number of intervals is 1000000000000, expected 2 to"),
        (lambda: line.stretched(profile, samples=10**13), "the number of samples is 10000000000000, expected 2 to"),
        (lambda: Spline(ur5, VIA, ends="loose"), "ends is 'loose', expected 'natural' or 'at rest'"),
        (lambda: Spline(ur5, VIA[:1]), "the number of via points is 1, expected at least 2"),
        (lambda: Cartesian(ur5, START, np.eye(4), shape="arc"), "shape is 'arc', expected 'screw' or 'straight'"),
        (lambda: Cartesian(ur5, START, 2 * np.eye(4)), "goal: "),
    ]:
        with pytest.raises(ValueError, match=words):
            call()
