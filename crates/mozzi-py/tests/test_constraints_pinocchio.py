"""Robots with constraints beside Pinocchio: mechanisms with closed loops, and walking robots on pinned feet."""

import importlib.metadata
from pathlib import Path

import mozzi
import numpy as np
import pinocchio as pin
import pytest
from beside_pinocchio import Beside
from conftest import MODELS

SHARED = Path(__file__).resolve().parents[4] / "shared" / "data" / "parallel-robots"
MECHANISMS = ["5bar_linkage", "cassie_like", "digit_like", "robot_delta", "talos_like"]
EPSILON = np.finfo(float).eps


class Constrained(Beside):
    """With the same constraints between frames."""

    def __init__(self, robot, path, pairs, kind):
        super().__init__(robot, path)
        self.models = [self.constraint(a, b, kind) for a, b in pairs]
        self.datas = [model.createData() for model in self.models]

    def constraint(self, a, b, kind):
        """b's frame on a's; a pose instead of a name is one in the world."""

        def place(of):
            if not isinstance(of, str):
                return 0, of
            frame = self.pin.frames[self.pin.getFrameId(of)]
            return frame.parentJoint, frame.placement

        (joint_a, T_a), (joint_b, T_b) = place(a), place(b)
        contact = pin.ContactType.CONTACT_6D if kind == "weld" else pin.ContactType.CONTACT_3D
        return pin.RigidConstraintModel(contact, self.pin, joint_a, T_a, joint_b, T_b, pin.ReferenceFrame.LOCAL)

    def compare(self, theta, dtheta, tau):
        """The errors of θ̈ and Aᵀλ, over ε · cond(A M⁻¹Aᵀ) times the size of the terms."""
        robot = self.robot
        friction = robot.joint_friction(dtheta) + robot.spring_forces(theta)
        found = robot.constrained_forward_dynamics(theta, dtheta, tau + friction)
        A, M = robot.constraint_jacobian(theta), robot.mass_matrix(theta)
        sizes = np.linalg.svd(A @ np.linalg.solve(M, A.T), compute_uv=False)
        cond = sizes[0] / sizes[sizes > 1e-9 * sizes[0]][-1]
        q, v, torque = self.configuration(theta), self.velocity(dtheta), self.velocity(tau)
        pin.initConstraintDynamics(self.pin, self.data, self.models, self.datas)
        settings = pin.ProximalSettings(1e-14, 1e-8, 100)
        a = pin.constraintDynamics(self.pin, self.data, q, v, torque, self.models, self.datas, settings)
        force = (torque - pin.rnea(self.pin, self.data, q, v, a))[self.v]  # Aᵀλ
        ddtheta = a[self.v]
        unit = EPSILON * cond
        free = np.abs(robot.forward_dynamics(theta, dtheta, tau + friction)).max()
        return (
            np.abs(found.ddtheta - ddtheta).max() / (unit * max(np.abs(ddtheta).max(), free)),
            # forces follow from accelerations by M, whose lightest links weigh next to nothing
            np.abs(A.T @ found.multipliers - force).max() / (unit * np.linalg.cond(M) * np.abs(force).max()),
        )


@pytest.mark.filterwarnings("ignore::mozzi.LoadWarning")
@pytest.mark.parametrize("name", MECHANISMS)
def test_mechanisms_with_loops(name, random):
    folder = SHARED / name
    if not folder.is_dir():
        pytest.skip("no shared data")
    tree = mozzi.Model.from_urdf(str(folder / "robot.urdf"))
    robot = tree.with_constraints(str(folder / "robot.yaml"))
    pairs = [(one["a"]["frame"], one["b"]["frame"]) for one in robot.constraints]
    both = Constrained(robot, folder / "robot.urdf", pairs, "weld")
    worst = [0.0, 0.0]
    for _ in range(5):
        theta = robot.assemble(random.uniform(-0.2, 0.2, robot.n))
        rank = robot.constraint_rank(theta)
        assert rank.rows == 6 * len(pairs) and rank.rank + rank.freedom == robot.n
        dtheta = robot.assemble_velocities(theta, random.uniform(-1, 1, robot.n))
        worst = np.maximum(worst, both.compare(theta, dtheta, random.uniform(-5, 5, robot.n)))
    assert max(worst) < 1e3, worst


def talos():
    """Of example-robot-data, a package without a Python module."""
    name = "talos_data/robots/talos_reduced.urdf"
    files = importlib.metadata.files("example-robot-data") or []
    return next(file.locate() for file in files if str(file).endswith(name))


# feet and hands, pinned one after the other
WALKERS = {
    "anymal": (lambda: MODELS / "anymal.urdf", ["LF_FOOT", "LH_FOOT", "RF_FOOT", "RH_FOOT"]),
    "talos": (talos, ["left_sole_link", "right_sole_link", "gripper_left_base_link", "gripper_right_base_link"]),
}


@pytest.mark.filterwarnings("ignore::mozzi.LoadWarning")
@pytest.mark.parametrize("kind", ["point", "weld"])
@pytest.mark.parametrize("feet", [1, 2, 3, 4])
@pytest.mark.parametrize("name", WALKERS)
def test_walkers_on_pinned_feet(name, feet, kind, random):
    path, frames = WALKERS[name]
    path, frames = path(), frames[:feet]
    tree = mozzi.Model.from_urdf(path, floating=True)
    theta = tree.neutral_configuration + np.r_[np.zeros(7), random.uniform(-0.5, 0.5, tree.nq - 7)]
    poses = [tree.forward_kinematics(theta, frame=frame) for frame in frames]
    anchors = [{"name": frame, "kind": kind, "a": {"frame": None, "T": T.tolist()}, "b": {"frame": frame}} for frame, T in zip(frames, poses)]
    robot = tree.with_constraints(anchors)
    if robot.constraint_rank(theta).freedom == 0:
        pytest.skip("nothing moves")
    both = Constrained(robot, path, [(pin.SE3(T), frame) for frame, T in zip(frames, poses)], kind)
    worst = [0.0, 0.0]
    for _ in range(5):
        dtheta = robot.assemble_velocities(theta, random.uniform(-1, 1, robot.n))
        worst = np.maximum(worst, both.compare(theta, dtheta, random.uniform(-20, 20, robot.n)))
    print(name, feet, kind, worst)
    assert max(worst) < 1e3, worst
