"""Named states: MuJoCo's keyframes and its start, edits, pickling, wrong names."""

import copy
import pickle
from pathlib import Path

import mozzi
import numpy as np
import pytest
from conftest import assert_close

KEYS = Path(__file__).parents[3] / "oracles/test_keys.xml"


@pytest.fixture
def robot():
    return mozzi.Model.from_mjcf(KEYS)


def test_mujoco(robot):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_path(str(KEYS))
    data = mujoco.MjData(model)
    assert list(robot.states) == ["qpos0", "home", "key1", "still"]
    for key, name in enumerate(robot.states, -1):
        mujoco.mj_resetData(model, data) if key < 0 else mujoco.mj_resetDataKeyframe(model, data, key)
        state = robot.state(name)
        assert state.time == data.time
        mujoco.mj_forward(model, data)
        # all but the finger, which mozzi keeps where its coupling takes it
        for body in ("stone", "lid", "arm", "hand"):
            T = robot.forward_kinematics(state.theta, body)
            assert_close(T[:3, 3], data.body(body).xpos, 1.0)
            assert_close(T[:3, :3].ravel(), data.body(body).xmat, 1.0)
            V = np.zeros(6)
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, model.body(body).id, V, 1)
            assert_close(robot.body_jacobian(state.theta, body) @ state.dtheta, V, 1.0)
    assert np.array_equal(robot.start.theta, robot.states["qpos0"].theta)
    assert not np.array_equal(robot.start.theta, robot.neutral_configuration)


def test_states_stay_with_the_robot(robot):
    for again in (pickle.loads(pickle.dumps(robot)), copy.deepcopy(robot), robot.with_gravity([0, 0, 0])):
        assert list(again.states) == list(robot.states)
        for name, state in robot.states.items():
            assert all(np.array_equal(a, b) for a, b in zip(state, again.state(name)))
        assert np.array_equal(again.start.theta, robot.start.theta)
    locked = robot.with_locked_joints({"latch": 0.3})
    at = robot.position_names.index("latch")
    assert np.array_equal(locked.state("home").theta, np.delete(robot.state("home").theta, at))
    assert pickle.loads(pickle.dumps(robot)) == robot != robot.with_start("home")


def test_a_motion_from_a_state(robot):
    theta, dtheta, _ = robot.state("home")
    motion = robot.simulate(theta, dtheta, 0.01, 10)
    assert np.array_equal(motion.theta[0], theta)
    assert np.array_equal(motion.dtheta[0], dtheta)


def test_own_states(ur5):
    assert ur5.states == {}
    assert np.array_equal(ur5.start.theta, np.zeros(6))
    home = ur5.with_state("home", np.arange(6.0), time=2).with_start("home")
    assert np.array_equal(home.start.theta, np.arange(6.0))
    assert (home.start.time, home.start.dtheta.shape) == (2.0, (6,))
    moved = home.with_state("home", np.ones(6), np.ones(6))
    assert list(moved.states) == ["home"]
    assert np.array_equal(moved.start.dtheta, np.ones(6))


def test_wrong_states(ur5):
    home = ur5.with_state("home", np.zeros(6))
    with pytest.raises(ValueError, match="there is no state `hone`; this robot has `home`"):
        home.state("hone")
    with pytest.raises(ValueError, match="there is no state `home`; this robot has none"):
        ur5.with_start("home")
    with pytest.raises(ValueError, match=r"theta has shape \(5,\), expected \(6,\)"):
        ur5.with_state("home", np.zeros(5))
    with pytest.raises(ValueError, match="state `home`: positions: joint `shoulder_pan_joint` has NaN, expected finite"):
        ur5.with_state("home", [np.nan] * 6)
    with pytest.raises(ValueError, match="of length 2"):
        mozzi.models.anymal(floating=True).with_state("home", [2.0] + [0.0] * 18)
