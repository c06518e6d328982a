"""Inverse kinematics: found positions put into forward kinematics, targets in arrays, and what is refused."""

import mozzi
import numpy as np
import pytest
from conftest import assert_close

HOME = np.array([0.0, -1.2, 1.5, 0.3, 1.1, 0.0])


@pytest.fixture
def panda():
    return mozzi.models.panda().with_locked_joints({"panda_finger_joint1": 0.02})


def error(robot, theta, goal, frame=None):
    """(angle, distance) of a pose from its goal, by the matrices alone."""
    T = np.linalg.inv(robot.forward_kinematics(theta, frame)) @ goal
    sine = 0.5 * np.linalg.norm([T[2, 1] - T[1, 2], T[0, 2] - T[2, 0], T[1, 0] - T[0, 1]])
    return np.arctan2(sine, 0.5 * (np.trace(T[:3, :3]) - 1)), np.linalg.norm(T[:3, 3])


def test_rounded_poses_are_reached_and_wrong_ones_refused(ur5):
    solver, goal = mozzi.InverseKinematics(ur5), ur5.forward_kinematics(HOME)
    for rounded in [goal.astype(np.float32), np.round(goal, 4)]:
        np.testing.assert_allclose(solver.solve(HOME + 0.1, pose=rounded).theta, HOME, atol=1e-3)
        assert solver.solve(HOME + 0.1, orientation=rounded[:3, :3]).reached
        tcp = ur5.with_frame("tcp", "tool0", rounded)
        np.testing.assert_allclose(tcp.forward_kinematics(HOME, "tcp"), goal @ goal, atol=1e-3)
    with pytest.raises(ValueError, match=r"pose\[1\]: not a rotation matrix: .* \(expected at most 1e-3\)"):
        solver.solve([HOME, HOME], pose=[goal, goal @ np.diag([1, 1.01, 1, 1])])


@pytest.mark.parametrize("method", ["levenberg-marquardt", "newton"])
def test_a_pose_is_reached(ur5, random, method):
    solver = mozzi.InverseKinematics(ur5, method=method, angle_tolerance=1e-9, distance_tolerance=1e-9)
    assert solver.frame == "tool0" and solver.model == ur5 and "tool0" in repr(solver)
    for _ in range(5):
        goal = ur5.forward_kinematics(HOME + random.uniform(-1, 1, 6))
        found = solver.solve(HOME, pose=goal)
        assert found.reached is True and found.reason == "" and found.iterations >= 1 and found.starts >= 1
        assert max(error(ur5, found.theta, goal)) < 2e-9
        assert max(found.angle, found.distance) < 1e-9


def test_a_position_or_an_orientation_alone(ur5):
    T = ur5.forward_kinematics([0.3, -1.2, 1.4, -0.5, 0.9, 2.0])
    solver = mozzi.InverseKinematics(ur5)
    found = solver.solve(HOME, position=T[:3, 3])
    assert_close(ur5.forward_kinematics(found.theta)[:3, 3], T[:3, 3], tolerance=1e-7)
    assert found.angle is None and found.distance < 1e-8
    found = solver.solve(HOME, orientation=T[:3, :3])
    assert_close(ur5.forward_kinematics(found.theta)[:3, :3], T[:3, :3], tolerance=1e-7)
    assert found.distance is None and found.angle < 1e-8


def test_many_targets_are_one_after_the_other(ur5, random):
    goals = ur5.forward_kinematics(HOME + random.uniform(-1, 1, (3, 4, 6)))
    goals[1, 2, :3, 3] = [2, 0, 0]
    solver = mozzi.InverseKinematics(ur5, starts=5)
    found = solver.solve(HOME, pose=goals)
    assert found.theta.shape == (3, 4, 6) and found.reached.dtype == bool and found.iterations.dtype == np.int64
    assert {x.shape for x in found[1:]} == {(3, 4)}
    assert not found.reached[1, 2] and "did not reach" in found.reason[1, 2]
    for threads in (1, 2, 7):
        again = solver.solve(np.broadcast_to(HOME, (4, 6)), pose=goals, threads=threads)
        assert all(np.array_equal(a, b) for a, b in zip(found, again))
    for place in np.ndindex(3, 4):
        one = solver.solve(HOME, pose=goals[place])
        assert np.array_equal(one.theta, found.theta[place]) and one[1:] == tuple(x[place] for x in found[1:])
    with pytest.raises(mozzi.MotionError, match=r"target \[1, 2\]: frame `tool0` did not reach its goal"):
        solver.solve(HOME, pose=goals, must_reach=True)
    none = solver.solve(HOME, pose=goals[:0])
    assert none.theta.shape == (0, 4, 6) and none.reason.shape == (0, 4)


def test_a_target_out_of_reach_is_reported(ur5):
    found = mozzi.InverseKinematics(ur5, starts=3).solve(HOME, position=[2, 0, 0])
    assert found.reached is False and found.starts == 3 and 1 < found.distance < 2
    assert_close(np.linalg.norm(ur5.forward_kinematics(found.theta)[:3, 3] - [2, 0, 0]), found.distance, tolerance=1e-9)
    assert found.reason.startswith("frame `tool0` did not reach its goal: the best of 3 starts")
    with pytest.raises(mozzi.MotionError, match="did not reach its goal"):
        mozzi.InverseKinematics(ur5, starts=3).solve(HOME, position=[2, 0, 0], must_reach=True)


def test_limits_are_kept_unless_told_otherwise(panda, random):
    low, high = panda.position_limits.T
    goals = panda.forward_kinematics(random.uniform(low, high, (20, 7)), "panda_hand")
    found = mozzi.InverseKinematics(panda, "panda_hand").solve(0.5 * (low + high), pose=goals)
    assert found.reached.all() and (found.theta >= low).all() and (found.theta <= high).all()
    beyond = high + 0.4
    goal = panda.forward_kinematics(beyond, "panda_hand")
    free = mozzi.InverseKinematics(panda, "panda_hand", limits=False, starts=1).solve(beyond - 0.01, pose=goal)
    assert free.reached and (free.theta > high).any()


def test_secondary_goals(panda):
    start, posture = np.array([[0.1, 0.2, 0.1, -1.0, 0.0, 1.0, 0.0], [1.0, -0.5, -0.8, -2.0, 0.4, 1.8, 0.7]])
    goal = panda.forward_kinematics([0.5, -0.3, -0.4, -1.7, 0.1, 1.5, 1.0], "panda_hand")
    solver = mozzi.InverseKinematics(panda, "panda_hand")
    first, near = solver.solve(start, pose=goal), solver.solve(start, pose=goal, near=posture)
    assert near.reached and np.linalg.norm(near.theta - posture) < 0.9 * np.linalg.norm(first.theta - posture)
    # the gradient has nothing left along the one direction that leaves the hand where it is
    null = np.linalg.svd(panda.body_jacobian(near.theta, "panda_hand"))[2][-1]
    assert abs(null @ (near.theta - posture)) < 1e-6
    same = solver.solve(start, pose=goal, minimize=lambda q: (0.5 * np.sum((q - posture) ** 2), q - posture))
    assert_close(same.theta, near.theta, tolerance=1e-6)


def test_errors_of_a_function_are_its_own(panda):
    solver, goal = mozzi.InverseKinematics(panda, "panda_hand"), panda.forward_kinematics([0.1] * 7, "panda_hand")

    def broken(theta):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        solver.solve([0.0] * 7, pose=goal, minimize=broken)
    with pytest.raises(ValueError, match="minimize answered 1.0, expected H, a float, and its gradient"):
        solver.solve([0.0] * 7, pose=goal, minimize=lambda theta: 1.0)
    with pytest.raises(ValueError, match=r"the gradient of minimize has shape \(3,\), expected \(7,\)"):
        solver.solve([0.0] * 7, pose=goal, minimize=lambda theta: (1.0, [0.0] * 3))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({}, "the goal is given by nothing, expected one of pose, position and orientation"),
        ({"pose": np.eye(4), "position": [0, 0, 0]}, "the goal is given by pose and position, expected one"),
        ({"pose": np.eye(3)}, r"pose has shape \(3, 3\), expected \(..., 4, 4\)"),
        ({"position": [0.1]}, r"position has shape \(1,\), expected \(..., 3\): m"),
        ({"orientation": [np.eye(3), 2 * np.eye(3)]}, r"orientation\[1\]: "),
        ({"position": [0, 0, np.nan]}, "position: .*NaN.*, expected finite numbers"),
        ({"position": [0, 0, 0], "near": [0.0]}, r"near has shape \(1,\), expected \(..., 6\): one value per joint"),
        ({"position": [0, 0, 0], "near": HOME, "minimize": len}, "near and minimize are both given"),
    ],
)
def test_wrong_goals_are_named(ur5, given, words):
    with pytest.raises(ValueError, match=words):
        mozzi.InverseKinematics(ur5).solve(HOME, **given)


def test_wrong_options_are_named(ur5):
    for options, words in [
        ({"method": "simplex"}, "method is 'simplex', expected 'levenberg-marquardt' or 'newton'"),
        ({"angle_tolerance": 0.0}, "the tolerance of the angle is 0, expected a positive, finite number"),
        ({"starts": 0}, "starts is 0, expected at least 1"),
        ({"frame": "gripper"}, "there is no frame `gripper`"),
    ]:
        with pytest.raises(ValueError, match=words):
            mozzi.InverseKinematics(ur5, **options)
    with pytest.raises(ValueError, match=r"guess has shape \(3,\), expected \(..., 6\)"):
        mozzi.InverseKinematics(ur5).solve([0, 0, 0], position=[0, 0, 0])


def test_goals_beyond_all_reach_cost_few_starts(ur5):
    far = mozzi.InverseKinematics(ur5).solve(HOME, position=[9.0, 0.0, 0.0])
    assert not far.reached and far.starts == 20 and far.distance < 8.3 and "20 starts" in far.reason
    near = mozzi.InverseKinematics(ur5).solve(HOME, position=[0.0, 0.0, 0.0])
    assert not near.reached and near.starts == 200
