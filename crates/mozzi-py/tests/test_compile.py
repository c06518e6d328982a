"""Machine code, beside the kernels."""

import concurrent.futures
import copy
import multiprocessing
import pickle
import threading

import mozzi
import numpy as np
import pytest
from conftest import assert_close, state, tip
from test_arrays import METHODS, arguments, parts, taking

OF_A_FRAME = taking("frame")


def given(robot, name, random, *leading):
    """The state, and for quantities of a frame a tip."""
    options = {"frame": tip(robot)} if name in OF_A_FRAME else {}
    return arguments(robot, METHODS[name], random, *leading), options


@pytest.mark.parametrize("name", METHODS)
def test_results_are_the_kernels(name, robot, random):
    fast = robot.compile(name, frame=tip(robot))
    if name == "task_space_dynamics" and robot.name == "furuta_pendulum":
        return  # two joints: its six rows cannot move independently
    for leading in [(), (3, 7)]:
        state, options = given(robot, name, random, *leading)
        expected = parts(getattr(robot, name)(*state, **options))
        for threads in (None, 1, 2):
            for found, same in zip(parts(getattr(fast, name)(*state, **options, threads=threads)), expected, strict=True):
                divides = "forward_dynamics" in name or name == "task_space_dynamics"
                assert_close(found, same, tolerance=1e-8 if divides else 1e-11)
    assert fast == robot and copy.copy(fast) == robot


def test_threads(ur5, random):
    state_of_many, names = state(ur5, random, 1000), ("inverse_dynamics", "regressor")
    for name in names:
        expected = getattr(ur5, name)(*state_of_many)
        code = getattr(ur5.compile(name), name)(*state_of_many)
        assert_close(code, expected)
        for fast in (ur5.compile(name, threads=1), ur5.compile(name, threads=2)):
            for threads in (None, 1, 2, 3):
                # to the bit: another number of threads is no reason to leave the machine code
                assert np.array_equal(getattr(fast, name)(*state_of_many, threads=threads), code)
                again = pickle.loads(pickle.dumps(fast))
                assert np.array_equal(getattr(again, name)(*state_of_many, threads=threads), code)


CODE = ("machine code", "kernels: the processor", "kernels: the system")


def test_what_computes():
    ur5 = mozzi.models.ur5()
    not_requested = "kernels: machine code was not requested"
    not_yet = "kernels: too few states so far to pay for machine code"
    if ur5.compile("mass_matrix").engine("mass_matrix").many.startswith("machine code"):
        assert ur5.engine("mass_matrix") == (not_requested, not_yet)
        few, many = np.zeros((400, 6)), np.zeros((1000, 6))
        for _ in range(2):
            ur5.mass_matrix(few)
            assert ur5.engine("mass_matrix").many == not_yet
        ur5.mass_matrix(few, threads=1)
        assert ur5.engine("mass_matrix").many.startswith("machine code")
        ur5.regressor(many, many, many)
        assert ur5.engine("regressor").many.startswith("machine code") and ur5.engine("regressor").one == not_requested
    kernels = ur5.kernels_only()
    states = np.random.default_rng(3).uniform(-1, 1, (3000, 6))
    found = kernels.mass_matrix(states)
    assert kernels.engine("mass_matrix") == (not_requested, not_requested) and kernels == ur5
    assert all(np.array_equal(found[k], ur5.mass_matrix(states[k])) for k in range(0, 3000, 100))
    again = pickle.loads(pickle.dumps(kernels))
    assert np.array_equal(again.mass_matrix(states), found)
    assert np.abs(ur5.mass_matrix(states) - found).max() < 1e-12
    fast = ur5.compile("mass_matrix").compile("body_jacobian")
    for name in ("mass_matrix", "body_jacobian"):
        engine = fast.engine(name)
        assert isinstance(engine, mozzi.Engine) and engine.one.startswith(CODE) and engine.many.startswith(CODE)
    assert fast.engine("body_jacobian", "forearm_link").one == not_requested
    again = pickle.loads(pickle.dumps(fast))
    assert again == fast and again.engine("mass_matrix") == fast.engine("mass_matrix")
    for refused in (ur5.compile, ur5.engine):
        with pytest.raises(ValueError, match="there is no quantity `mass`; the nearest of .*mass_matrix"):
            refused("mass")
    with pytest.raises(ValueError, match="hand"):
        ur5.compile("body_jacobian", frame="hand")


def test_all_quantities_have_engines(ur5):
    fast = ur5.compile(*METHODS)
    for name in METHODS:
        engine = fast.engine(name)
        assert engine.one.startswith(CODE) and engine.many.startswith(CODE), name


def test_other_environments_and_numbers_are_the_kernels(ur5, random):
    fast = ur5.compile("inverse_dynamics", "gravity_forces")
    one = state(ur5, random)
    many = state(ur5, random, 5)
    wrench = random.uniform(-1, 1, 6)
    for x in (one, many):
        assert np.array_equal(fast.inverse_dynamics(*x, wrench), ur5.inverse_dynamics(*x, wrench))
        assert np.array_equal(fast.gravity_forces(x[0], gravity=[1, 2, 3]), ur5.gravity_forces(x[0], gravity=[1, 2, 3]))
        parameters = ur5.with_payload("tool0", 1.0).parameters
        found = fast.inverse_dynamics(*x, parameters=parameters)
        assert np.array_equal(found, ur5.inverse_dynamics(*x, parameters=parameters))
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
    fast, many = ur5.compile("inverse_dynamics"), state(ur5, random, 500)
    expected = fast.inverse_dynamics(*many)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        for found in pool.map_async(work, [(fast, many)] * 3).get(120):
            assert_close(found, expected)


def forked_result(model, theta, queue):
    queue.put(model.coriolis_matrix(theta, theta))


def test_a_fork_while_another_thread_makes_code():
    context = multiprocessing.get_context("fork")
    theta = np.random.default_rng(4).uniform(-1, 1, (2000, 6))
    expected = mozzi.models.ur5().kernels_only().coriolis_matrix(theta, theta)
    for _ in range(8):
        model = mozzi.models.ur5()  # its code is not made yet
        maker = threading.Thread(target=model.coriolis_matrix, args=(theta, theta))
        queue = context.Queue()
        children = [context.Process(target=forked_result, args=(model, theta, queue)) for _ in range(2)]
        maker.start()
        for child in children:
            child.start()
        for _ in children:
            assert_close(queue.get(timeout=60), expected)  # a child that hangs gives none
        for child in children:
            child.join(60)
            assert child.exitcode == 0
        maker.join()


def random_calls(model, table, expected, count, seed):
    """The largest relative difference from the kernels of calls with parts of a table."""
    random, worst = np.random.default_rng(seed), 0.0
    for _ in range(count):
        states = int(random.integers(1, 40))
        start = int(random.integers(0, len(table[0]) - states))
        found = model.inverse_dynamics(*(x[start : start + states] for x in table))
        worst = max(worst, np.abs(found - expected[start : start + states]).max() / np.abs(expected).max())
    return worst


def in_threads(model, table, expected, seed, queue=None):
    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        parts = [pool.submit(random_calls, model, table, expected, 250, [seed, k]) for k in range(8)]
        worst = max(part.result(120) for part in parts)
    return worst if queue is None else queue.put(worst)


def test_forks_whose_threads_make_code_together(ur5, random):
    table = state(ur5, random, 1000)
    expected = ur5.kernels_only().inverse_dynamics(*table)
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    for round in range(2):
        model = mozzi.models.ur5()  # without code: parent and children make it at once
        children = [context.Process(target=in_threads, args=(model, table, expected, 10 * round + k, queue)) for k in range(4)]
        for child in children:
            child.start()
        assert in_threads(model, table, expected, 100 + round) < 1e-13
        for child in children:
            assert queue.get(timeout=120) < 1e-13
        for child in children:
            child.join(60)
            assert child.exitcode == 0
