"""Machine code, beside the kernels."""

import copy
import multiprocessing
import pickle

import mozzi
import numpy as np
import pytest
from conftest import assert_close, robots, state, tip

NAMES = [
    "inverse_dynamics", "forward_dynamics", "mass_matrix", "bias_forces", "velocity_product", "gravity_forces",
    "forward_kinematics", "space_jacobian", "body_jacobian", "inverse_dynamics_derivatives",
    "forward_dynamics_derivatives",
]  # fmt: skip
OF_A_FRAME = ("forward_kinematics", "space_jacobian", "body_jacobian")


def arguments(robot, name, random, *leading):
    theta, dtheta, ddtheta = state(robot, random, *leading)
    if name in ("mass_matrix", "gravity_forces"):
        return (theta,)
    if name in OF_A_FRAME:
        return theta, tip(robot)
    return (theta, dtheta) if name in ("bias_forces", "velocity_product") else (theta, dtheta, ddtheta)


def parts(result):
    return result if isinstance(result, tuple) else (result,)


@pytest.mark.parametrize("name", NAMES)
def test_results_are_the_kernels(name, robot, random):
    fast = robot.compile(name, frame=tip(robot))
    for leading in [(), (3, 7)]:
        given = arguments(robot, name, random, *leading)
        for found, expected in zip(parts(getattr(fast, name)(*given)), parts(getattr(robot, name)(*given))):
            assert_close(found, expected, tolerance=1e-8 if "forward_dynamics" in name else 1e-11)
    assert fast == robot and copy.copy(fast) == robot


def test_threads(ur5, random):
    given = state(ur5, random, 1000)
    expected = ur5.inverse_dynamics(*given)
    for fast in (ur5.compile("inverse_dynamics", threads=1), ur5.compile("inverse_dynamics", threads=2)):
        for threads in (None, 1, 2):
            assert_close(fast.inverse_dynamics(*given, threads=threads), expected)
            assert_close(pickle.loads(pickle.dumps(fast)).inverse_dynamics(*given, threads=threads), expected)


def test_what_computes(ur5):
    assert ur5.engine("mass_matrix") == "kernels: nobody asked for machine code"
    fast = ur5.compile("mass_matrix").compile("body_jacobian")
    for name in ("mass_matrix", "body_jacobian"):
        assert fast.engine(name).startswith(("machine code", "kernels: the processor", "kernels: the system"))
    assert fast.engine("body_jacobian", "forearm_link") == "kernels: nobody asked for machine code"
    again = pickle.loads(pickle.dumps(fast))
    assert again == fast and again.engine("mass_matrix") == fast.engine("mass_matrix")
    with pytest.raises(ValueError, match="'mass' of 'ur5' cannot be compiled, expected one of 'inverse_dynamics'"):
        ur5.compile("mass")
    with pytest.raises(ValueError, match="hand"):
        ur5.compile("body_jacobian", frame="hand")


def test_other_surroundings_and_numbers_are_the_kernels(ur5, random):
    fast = ur5.compile("inverse_dynamics", "gravity_forces")
    given = state(ur5, random)
    many = state(ur5, random, 5)
    wrench = random.uniform(-1, 1, 6)
    for x in (given, many):
        assert np.array_equal(fast.inverse_dynamics(*x, wrench), ur5.inverse_dynamics(*x, wrench))
        assert np.array_equal(fast.gravity_forces(x[0], gravity=[1, 2, 3]), ur5.gravity_forces(x[0], gravity=[1, 2, 3]))
        single = [part.astype(np.float32) for part in x]
        assert np.array_equal(fast.inverse_dynamics(*single), ur5.inverse_dynamics(*single))


def test_errors_are_the_kernels():
    singular = mozzi.Model.from_screws(
        [np.eye(4)] * 3, [np.diag([0.1, 0.1, 0.1, 1, 1, 1]), np.zeros((6, 6))], np.eye(6)[:, [2, 2]]
    ).compile("forward_dynamics", "forward_dynamics_derivatives")
    for leading in [(), (2, 3)]:
        for name in ("forward_dynamics", "forward_dynamics_derivatives"):
            with pytest.raises(mozzi.SingularError, match="joint2"):
                getattr(singular, name)(np.zeros((*leading, 2)), np.zeros(2), np.ones(2))
    anymal = mozzi.models.anymal().compile("mass_matrix", "gravity_forces")
    for name in ("mass_matrix", "gravity_forces"):
        for leading in [(), (3,)]:
            with pytest.raises(ValueError, match="quaternion"):
                getattr(anymal, name)(np.zeros((*leading, 19)))


def work(task):
    robot, given = task
    return robot.inverse_dynamics(*given)


def test_forked_processes(ur5, random):
    fast, given = ur5.compile("inverse_dynamics"), state(ur5, random, 500)
    expected = fast.inverse_dynamics(*given)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        for found in pool.map_async(work, [(fast, given)] * 3).get(120):
            assert_close(found, expected)
