"""What the tests share: robots, random states, and when two results are the same."""

from pathlib import Path

import mozzi
import numpy as np
import pytest

MODELS = Path(__file__).parents[2] / "mozzi-urdf/models"
ORACLES = Path(__file__).parents[3] / "oracles"


def robots():
    return {
        "ur5": mozzi.models.ur5(),
        "panda": mozzi.models.panda(),
        "anymal": mozzi.models.anymal(floating=True),
        "furuta_pendulum": mozzi.models.furuta_pendulum(),
    }


@pytest.fixture(params=["ur5", "panda", "anymal", "furuta_pendulum"])
def robot(request):
    return robots()[request.param]


@pytest.fixture
def ur5():
    return mozzi.models.ur5()


@pytest.fixture
def random():
    return np.random.default_rng(1763)


def load_mjcf(folder, text):
    """The robot of this MJCF text, by way of a file in the folder."""
    path = folder / "robot.xml"
    path.write_text(text)
    return mozzi.Model.from_mjcf(path)


def tip(robot):
    """The end effector; of a tree one of its tips."""
    return robot.end_effector or {"panda": "panda_leftfinger", "anymal": "LF_FOOT"}[robot.name]


def positions(robot, random, *leading):
    """Random θ; a floating base's quaternion is a unit one."""
    theta = random.uniform(-2, 2, (*leading, robot.nq))
    if robot.is_floating:
        theta[..., :4] /= np.linalg.norm(theta[..., :4], axis=-1, keepdims=True)
    return theta


def state(robot, random, *leading):
    rates = (random.uniform(-2, 2, (*leading, robot.n)) for _ in range(2))
    return (positions(robot, random, *leading), *rates)


def assert_close(found, expected, size=None, tolerance=1e-12):
    """Within `tolerance` times the size of the terms, of all or of each entry; by default of the largest number expected."""
    found, expected = np.asarray(found), np.asarray(expected)
    assert found.shape == expected.shape
    size = np.abs(expected).max(initial=1e-3) if size is None else size
    off = np.abs(found - expected)
    error = np.divide(off, size, out=np.zeros(np.broadcast_shapes(off.shape, np.shape(size))), where=off != 0.0).max(initial=0.0)
    assert error <= tolerance, f"error {error:.3g} of the size of the terms"
