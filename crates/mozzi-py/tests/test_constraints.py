"""Constraints that close loops: a four-bar by MJCF, by mozzi's own file and by reduction; the parallel robots of ../shared."""

import copy
import json
import pickle
from pathlib import Path

import mozzi
import numpy as np
import pytest
from conftest import assert_close, load_mjcf

SHARED = Path(__file__).parents[3] / "../shared/data/parallel-robots"

# lengths 0.3, 0.8, 0.6 and 0.9 m; rods of 1 kg/m
FOUR_BAR = """
<mujoco model="four-bar"><compiler angle="radian"/><worldbody>
  <body name="crank"><joint name="crank" axis="0 -1 0"/><geom type="box" size="0.15 0.01 0.01" pos="0.15 0 0" mass="0.3"/>
    <body name="coupler" pos="0.3 0 0"><joint name="coupler" axis="0 -1 0"/>
      <geom type="box" size="0.4 0.01 0.01" pos="0.4 0 0" mass="0.8"/></body></body>
  <body name="rocker" pos="0.9 0 0"><joint name="rocker" axis="0 -1 0"/>
    <geom type="box" size="0.3 0.01 0.01" pos="0.3 0 0" mass="0.6"/></body>
</worldbody>LOOP</mujoco>"""

HINGE = [
    {
        "name": "loop",
        "kind": "hinge",
        "a": {"frame": "coupler", "xyz": [0.8, 0, 0], "rpy": [np.pi / 2, 0, 0]},
        "b": {"frame": "rocker", "xyz": [0.6, 0, 0], "rpy": [np.pi / 2, 0, 0]},
    }
]
GUESS = [1.0, -0.6, 1.6]


@pytest.fixture
def tree(tmp_path):
    return load_mjcf(tmp_path, FOUR_BAR.replace("LOOP", ""))


@pytest.fixture
def four_bar(tree):
    return tree.with_constraints(HINGE)


@pytest.fixture
def state(four_bar):
    theta = four_bar.assemble(GUESS, hold=["crank"])
    return theta, four_bar.assemble_velocities(theta, [1.5, 0, 0], hold=["crank"])


def test_assembly_and_rank(four_bar, state):
    theta, dtheta = state
    assert theta[0] == 1.0 and dtheta[0] == 1.5
    coupler, rocker = theta[0] + theta[1], theta[2]
    end = [0.3 * np.cos(theta[0]) + 0.8 * np.cos(coupler), 0.3 * np.sin(theta[0]) + 0.8 * np.sin(coupler)]
    assert_close(end, [0.9 + 0.6 * np.cos(rocker), 0.6 * np.sin(rocker)])
    rank = four_bar.constraint_rank(theta)
    assert rank[:3] == (5, 2, 1) and rank.redundant == ["loop.wx", "loop.wy", "loop.vz"]
    assert four_bar.constraint_row_names[0] == "loop.wx"
    with pytest.raises(ValueError, match="constraint `loop` cannot be satisfied"):
        four_bar.assemble([1.0, 0.0, 0.0], hold=["crank", "coupler"])


def test_dynamics_by_multipliers_and_by_reduction(four_bar, state):
    theta, dtheta = state
    tau = np.array([0.7, 0.0, -0.2])
    ddtheta, multipliers = four_bar.constrained_forward_dynamics(theta, dtheta, tau)
    A = four_bar.constraint_jacobian(theta)
    assert A.shape == (5, 3) and multipliers.shape == (5,)
    assert_close(A @ dtheta, np.zeros(5), size=1.0)
    # the wrench that the rocker applies to the coupler does the work of the multipliers
    assert_close(four_bar.inverse_dynamics(theta, dtheta, ddtheta) + A.T @ multipliers, tau, tolerance=1e-10)
    assert list(four_bar.constraint_wrenches(theta, multipliers)) == ["loop"]
    own = four_bar.reduce(theta, dtheta, ["crank"])
    du = np.linalg.solve(own.M, own.N.T @ tau - own.h)
    assert_close(own.N @ du + own.bias, ddtheta, tolerance=1e-10)
    driven = four_bar.with_constraints([], motors=["crank"])
    assert driven.motors == ["crank"] and four_bar.motors is None
    found = driven.constrained_inverse_dynamics(theta, dtheta, ddtheta)
    assert_close(found.tau, [(own.N.T @ tau)[0], 0, 0], tolerance=1e-9)
    assert_close(four_bar.constrained_inverse_dynamics(theta, dtheta, ddtheta, weights=[1e-12, 1, 1]).tau, found.tau, tolerance=1e-6)
    # derivatives, by differences along the velocities
    slopes = four_bar.constrained_forward_dynamics_derivatives(theta, dtheta, tau)
    for j, e in enumerate(np.eye(3) * 1e-6):
        ahead, behind = (four_bar.constrained_forward_dynamics(theta, dtheta, tau + sign * e)[0] for sign in (1, -1))
        assert_close(slopes.d_tau[:, j], (ahead - behind) / 2e-6, tolerance=1e-6)
    assert slopes.multipliers_d_theta.shape == (5, 3)
    nearest = four_bar.assemble_accelerations(theta, dtheta, ddtheta)
    assert_close(nearest, ddtheta, tolerance=1e-9)


def test_mjcf_is_the_same_mechanism(four_bar, state, tmp_path):
    theta, dtheta = state
    loop = '<equality><connect name="loop" site1="a" site2="b"/></equality>'
    text = FOUR_BAR.replace("LOOP", loop)
    text = text.replace('mass="0.8"/>', 'mass="0.8"/><site name="a" pos="0.8 0 0"/>')
    text = text.replace('mass="0.6"/>', 'mass="0.6"/><site name="b" pos="0.6 0 0"/>')
    other = load_mjcf(tmp_path, text)
    assert other.constraints[0]["kind"] == "point"
    tau = [0.1, 0.0, 0.3]
    mine, theirs = (robot.constrained_forward_dynamics(theta, dtheta, tau)[0] for robot in (four_bar, other))
    assert_close(mine, theirs, tolerance=1e-10)


def test_a_motion_stays_closed(four_bar, state):
    motion = four_bar.simulate(*state, 1.0, 1000, record_every=10)
    assert motion.closing.residual < 1e-13
    assert 0 < motion.closing.corrected < 1e-6
    assert abs(motion.energy - motion.energy[0]).max() < 1e-7
    with pytest.raises(ValueError, match="violates constraint `loop`"):
        four_bar.simulate(GUESS, [0, 0, 0], 1.0, 10)


def test_many_starts_move_as_each_alone(four_bar, state):
    driven = four_bar.with_constraints([], motors=["crank"])
    starts = [driven.assemble([angle, -0.6, 1.6], hold=["crank"]) for angle in (0.9, 1.0, 1.1)]
    rates = [driven.assemble_velocities(theta, [0.5, 0, 0], hold=["crank"]) for theta in starts]
    pushed = lambda t, theta, dtheta: np.concatenate([np.full(theta.shape[:-1] + (1,), np.sin(t)), 0 * theta[..., 1:]], -1)
    for torque in [None, [0.3, 0, 0], "gravity_compensation", pushed]:
        many = driven.simulate(starts, rates, 0.5, 100, torque=torque)
        for k in range(3):
            one = driven.simulate(starts[k], rates[k], 0.5, 100, torque=torque)
            for name in ["theta", "dtheta", "ddtheta", "tau"]:
                assert_close(getattr(many, name)[k], getattr(one, name), tolerance=1e-9)
            assert abs(driven.constraint_residual(many.theta[k])).max() < 1e-13
    with pytest.raises(ValueError, match=r"state \[1\]: the start has a position that violates constraint `loop`"):
        driven.simulate([starts[0], GUESS], rates[:2], 0.1, 10)


def test_constraints_are_data(tree, four_bar, tmp_path):
    assert tree.constraints == [] and four_bar.without_constraints() == tree
    again = tree.with_constraints(four_bar.constraints)
    assert again == four_bar and again != tree
    assert pickle.loads(pickle.dumps(four_bar)) == four_bar == copy.deepcopy(four_bar)
    path = tmp_path / "loop.json"
    path.write_text(json.dumps({"constraints": HINGE, "motors": ["crank"]}))
    assert tree.with_constraints(path).motors == tree.with_constraints(str(path)).motors == ["crank"]
    arrays = copy.deepcopy(HINGE)
    arrays[0]["a"]["xyz"] = np.array([0.8, 0, 0])
    assert tree.with_constraints(arrays) == four_bar
    for change, words in [
        ({"kind": "pin"}, r"constraints\[0\].kind is \"pin\""),
        ({"a": {"frame": "copler"}}, "there is no link or frame `copler`"),
        ({"length": 1.0}, "`length` is not an entry"),
        ({"a": {"frame": "rocker"}}, "fixed to each other"),
    ]:
        with pytest.raises(ValueError, match=words):
            tree.with_constraints([HINGE[0] | change])
    with pytest.raises(ValueError, match="hold `crnak`, which does not exist"):
        tree.with_constraints(HINGE, motors=["crnak"])
    with pytest.raises(FileNotFoundError):
        tree.with_constraints(tmp_path / "nothing.json")
    with pytest.raises(ValueError, match="multipliers has shape"):
        four_bar.constraint_wrenches(GUESS, [0.0])


@pytest.mark.parametrize("name", ["5bar_linkage", "cassie_like", "digit_like", "robot_delta", "talos_like"])
@pytest.mark.filterwarnings("ignore::mozzi.LoadWarning")
def test_parallel_robots(name, random):
    if not SHARED.exists():
        pytest.skip("no shared data")
    tree = mozzi.Model.from_urdf(SHARED / name / "robot.urdf")
    robot = tree.with_constraints(SHARED / name / "robot.yaml")
    theta = robot.assemble(np.full(robot.nq, 0.05))
    rank = robot.constraint_rank(theta)
    assert rank.rank + rank.freedom == robot.n and rank.rows == 6 * len(robot.constraints)
    dtheta = robot.assemble_velocities(theta, random.uniform(-1, 1, robot.n))
    ddtheta, multipliers = robot.constrained_forward_dynamics(theta, dtheta, np.zeros(robot.n))
    A = robot.constraint_jacobian(theta)
    left = robot.inverse_dynamics(theta, dtheta, ddtheta) + A.T @ multipliers
    assert abs(left).max() < 1e-6 * (1 + abs(A.T @ multipliers).max())


def test_rollouts_stay_closed_and_have_gradients(four_bar, state):
    (theta, dtheta), random = state, np.random.default_rng(3)
    tau = random.uniform(-1, 1, (5, 3))
    bars = random.normal(size=(2, 6, 3))
    found = four_bar.rollout(theta, dtheta, tau, 0.01)
    assert max(np.abs(four_bar.constraint_residual(x)).max() for x in found.theta) < 1e-12
    along = random.normal(size=tau.shape)
    loss = lambda e: sum((x * bar).sum() for x, bar in zip(four_bar.rollout(theta, dtheta, tau + e * along, 0.01), bars))
    *_, by_tau = four_bar.rollout_vjp(theta, dtheta, tau, 0.01, *bars)
    slope = (8 * (loss(1e-4) - loss(-1e-4)) - (loss(2e-4) - loss(-2e-4))) / 12e-4
    assert abs(slope - (by_tau * along).sum()) < 1e-8 * max(1, abs(slope))
    taus = random.uniform(-1, 1, (3, 5, 3))  # many starts, one by one on all cores
    many = four_bar.rollout(theta, dtheta, taus, 0.01)
    gradients = four_bar.rollout_vjp(theta, dtheta, taus, 0.01, *bars, parameters=True)
    for k, tau in enumerate(taus):
        own = theta, dtheta, tau, 0.01
        assert all(np.array_equal(a[k], b) for a, b in zip(many, four_bar.rollout(*own), strict=True))
        one = four_bar.rollout_vjp(*own, *bars, parameters=True)
        assert all(np.array_equal(a[k], b) for a, b in zip(gradients, one, strict=True))
    with pytest.raises(ValueError, match=r"state \[1\].*constraint"):
        four_bar.rollout([theta, theta + 0.1], dtheta, tau, 0.01)
