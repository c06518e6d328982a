"""A robot of mozzi and of Pinocchio, and their conventions in each other's. The conversions are written out here, apart
from those of mozzi."""

import numpy as np
import pinocchio as pin


class Beside:
    """A robot of both libraries."""

    def __init__(self, robot, path, **options):
        free = (pin.JointModelFreeFlyer(),) if robot.is_floating else ()
        self.robot, self.pin = robot, pin.buildModelFromUrdf(str(path), *free, **options)
        self.pin.armature[:] = 0.0
        self.data = self.pin.createData()
        ids = [self.pin.getJointId(joint) for joint in robot.joint_names]
        base = [3, 4, 5, 0, 1, 2] if robot.is_floating else []
        self.v = np.array(base + [self.pin.idx_vs[i] for i in ids])  # θ̇ = ν[v]
        self.q = [(self.pin.idx_qs[i], self.pin.nqs[i]) for i in ids]

    def configuration(self, theta):
        q = pin.neutral(self.pin)
        if self.robot.is_floating:
            q[:3], q[3:7] = theta[4:7], [*theta[1:4], theta[0]]
        for (at, nq), angle in zip(self.q, theta[self.robot.nq - len(self.q) :]):
            q[at : at + nq] = [np.cos(angle), np.sin(angle)] if nq == 2 else angle
        return q

    def velocity(self, dtheta):
        v = np.zeros(self.pin.nv)
        v[self.v] = dtheta
        return v
