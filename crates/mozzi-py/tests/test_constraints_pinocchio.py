"""Robots with constraints beside Pinocchio: mechanisms with closed loops, and walking robots on pinned feet."""

from pathlib import Path

import mozzi
import numpy as np
import pinocchio as pin
import pytest
from conftest import MODELS

SHARED = Path(__file__).resolve().parents[4] / "shared" / "data" / "parallel-robots"
MECHANISMS = ["5bar_linkage", "cassie_like", "digit_like", "robot_delta", "talos_like"]
EPSILON = np.finfo(float).eps


class Beside:
    """A robot of both libraries, with the same constraints between frames."""

    def __init__(self, robot, path, pairs, kind, floating=False):
        free = (pin.JointModelFreeFlyer(),) if floating else ()
        self.robot, self.model = robot, pin.buildModelFromUrdf(str(path), *free)
        self.model.armature[:] = 0.0
        self.data = self.model.createData()
        ids = [self.model.getJointId(joint) for joint in robot.joint_names]
        base = [3, 4, 5, 0, 1, 2] if floating else []
        self.v = np.array(base + [self.model.idx_vs[i] for i in ids])
        self.q = [(self.model.idx_qs[i], self.model.nqs[i]) for i in ids]
        self.models = [self.constraint(a, b, kind) for a, b in pairs]
        self.datas = [model.createData() for model in self.models]

    def constraint(self, a, b, kind):
        """b's frame on a's; a pose instead of a name is one in the world."""

        def place(of):
            if not isinstance(of, str):
                return 0, of
            frame = self.model.frames[self.model.getFrameId(of)]
            return frame.parentJoint, frame.placement

        (joint_a, T_a), (joint_b, T_b) = place(a), place(b)
        contact = pin.ContactType.CONTACT_6D if kind == "weld" else pin.ContactType.CONTACT_3D
        return pin.RigidConstraintModel(contact, self.model, joint_a, T_a, joint_b, T_b, pin.ReferenceFrame.LOCAL)

    def configuration(self, theta):
        q = pin.neutral(self.model)
        if self.robot.is_floating:
            q[:3], q[3:7] = theta[4:7], [*theta[1:4], theta[0]]
        for (at, nq), angle in zip(self.q, theta[self.robot.nq - len(self.q) :]):
            q[at : at + nq] = [np.cos(angle), np.sin(angle)] if nq == 2 else angle
        return q

    def velocity(self, dtheta):
        v = np.zeros(self.model.nv)
        v[self.v] = dtheta
        return v

    def compare(self, theta, dtheta, tau):
        """The errors of θ̈ and Aᵀλ, over ε · cond(A M⁻¹Aᵀ) times the size of the terms."""
        robot = self.robot
        friction = robot.joint_friction(dtheta) + robot.spring_forces(theta)
        found = robot.constrained_forward_dynamics(theta, dtheta, tau + friction)
        A, M = robot.constraint_jacobian(theta), robot.mass_matrix(theta)
        sizes = np.linalg.svd(A @ np.linalg.solve(M, A.T), compute_uv=False)
        cond = sizes[0] / sizes[sizes > 1e-9 * sizes[0]][-1]
        q, v, torque = self.configuration(theta), self.velocity(dtheta), self.velocity(tau)
        pin.initConstraintDynamics(self.model, self.data, self.models, self.datas)
        settings = pin.ProximalSettings(1e-14, 1e-8, 100)
        a = pin.constraintDynamics(self.model, self.data, q, v, torque, self.models, self.datas, settings)
        force = (torque - pin.rnea(self.model, self.data, q, v, a))[self.v]  # Aᵀλ
        ddtheta = a[self.v]
        unit = EPSILON * cond
        free = np.abs(robot.forward_dynamics(theta, dtheta, tau + friction)).max()
        return (
            np.abs(found.ddtheta - ddtheta).max() / (unit * max(np.abs(ddtheta).max(), free)),
            # forces follow from accelerations by M, whose lightest links weigh next to nothing
            np.abs(A.T @ found.multipliers - force).max() / (unit * np.linalg.cond(M) * np.abs(force).max()),
        )


@pytest.mark.parametrize("name", MECHANISMS)
def test_mechanisms_with_loops(name, random):
    folder = SHARED / name
    if not folder.is_dir():
        pytest.skip("no shared data")
    tree = mozzi.Model.from_urdf(str(folder / "robot.urdf"))
    robot = tree.with_constraints(str(folder / "robot.yaml"))
    pairs = [(one["a"]["frame"], one["b"]["frame"]) for one in robot.constraints]
    both = Beside(robot, folder / "robot.urdf", pairs, "weld")
    worst = [0.0, 0.0]
    for _ in range(5):
        theta = robot.assemble(random.uniform(-0.2, 0.2, robot.n))
        rank = robot.constraint_rank(theta)
        assert rank.rows == 6 * len(pairs) and rank.rank + rank.freedom == robot.n
        dtheta = robot.assemble_velocities(theta, random.uniform(-1, 1, robot.n))
        worst = np.maximum(worst, both.compare(theta, dtheta, random.uniform(-5, 5, robot.n)))
    assert max(worst) < 1e3, worst


@pytest.mark.parametrize("kind", ["point", "weld"])
@pytest.mark.parametrize("feet", [1, 2, 3, 4])
def test_anymal_on_pinned_feet(feet, kind, random):
    if kind == "weld" and feet == 4:
        pytest.skip("24 rows for 18 velocities: nothing moves")
    tree = mozzi.models.anymal(floating=True)
    theta = tree.neutral_configuration + np.r_[np.zeros(7), random.uniform(-0.5, 0.5, 12)]
    names = [name for name in tree.frames if name.endswith("FOOT")][:feet]
    assert len(names) == feet
    robot, poses = tree, [tree.forward_kinematics(theta, frame=name) for name in names]
    robot = tree.with_constraints(
        [
            {"name": name, "kind": kind, "a": {"frame": None, "T": T.tolist()}, "b": {"frame": name}}
            for name, T in zip(names, poses)
        ]
    )
    pairs = [(pin.SE3(T), name) for name, T in zip(names, poses)]
    both = Beside(robot, MODELS / "anymal.urdf", pairs, kind, floating=True)
    worst = [0.0, 0.0]
    for _ in range(5):
        dtheta = robot.assemble_velocities(theta, random.uniform(-1, 1, robot.n))
        worst = np.maximum(worst, both.compare(theta, dtheta, random.uniform(-20, 20, robot.n)))
    assert max(worst) < 1e3, worst
