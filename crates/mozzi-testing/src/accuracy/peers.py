"""Quantities of Pinocchio or MuJoCo at given states: a question as JSON on standard input, the answer on standard output.

Results have mozzi's names, order and conventions: matrices by rows, six-vectors angular first.
"""

import sys

sys.path = [folder for folder in sys.path if folder]  # no file of the working folder is taken for a library

import json
import os
import xml.etree.ElementTree as ElementTree

out = os.fdopen(os.dup(1), "w", encoding="utf-8")
os.dup2(2, 1)  # what the libraries print goes to standard error


def flat(x):
    return [float(value) if abs(value) < float("inf") else None for value in x.ravel()]  # JSON has no word for NaN


class Pinocchio:
    """A free base has the quaternion last and the linear velocity first: both are put in mozzi's order."""

    def __init__(self, question):
        import numpy as np
        import pinocchio as pin

        self.np, self.pin, self.version = np, pin, pin.__version__
        free = [pin.JointModelFreeFlyer()] if question["floating"] else []
        self.model = pin.buildModelFromXML(question["text"], *free)
        self.model.gravity.linear = np.array(question["gravity"])
        self.weightless = self.model.copy()
        self.weightless.gravity.linear = np.zeros(3)
        for model in (self.model, self.weightless):
            model.armature = np.zeros(model.nv)
        self.data = self.model.createData()
        self.frame = self.model.getFrameId(question["frame"])
        joints = [self.model.joints[self.model.getJointId(name)] for name in question["joints"]]
        base, first = (7, [3, 4, 5, 0, 1, 2]) if question["floating"] else (0, [])
        self.base, self.joints = base, joints
        self.order = np.array(first + [joint.idx_v for joint in joints], dtype=int)

    def configuration(self, theta):
        q = self.pin.neutral(self.model)
        if self.base:
            w, x, y, z, *p = theta[:7]
            q[:7] = [*p, x, y, z, w]
        for joint, angle in zip(self.joints, theta[self.base:]):
            q[joint.idx_q:joint.idx_q + joint.nq] = [angle] if joint.nq == 1 else [self.np.cos(angle), self.np.sin(angle)]
        return q

    def rates(self, x):
        v = self.np.zeros(self.model.nv)
        v[self.order] = x
        return v

    def quantities(self, theta, dtheta, ddtheta, tau):
        pin, np, model, data, order = self.pin, self.np, self.model, self.data, self.order
        q, v, a, tau = self.configuration(theta), self.rates(dtheta), self.rates(ddtheta), self.rates(tau)
        angular_first = [3, 4, 5, 0, 1, 2]
        matrix = lambda M: M[np.ix_(order, order)]
        symmetric = lambda M: np.triu(M) + np.triu(M, 1).T
        result = {
            "inverse_dynamics": [pin.rnea(model, data, q, v, a)[order]],
            "bias_forces": [pin.nonLinearEffects(model, data, q, v)[order]],
            "gravity_forces": [pin.computeGeneralizedGravity(model, data, q)[order]],
            "velocity_product": [pin.nonLinearEffects(self.weightless, data, q, v)[order]],
            "mass_matrix": [matrix(symmetric(pin.crba(model, data, q)))],
            "mass_matrix_inverse": [matrix(symmetric(pin.computeMinverse(model, data, q)))],
            "forward_dynamics": [pin.aba(model, data, q, v, tau)[order]],
            "kinetic_energy": [np.array([pin.computeKineticEnergy(model, data, q, v)])],
            "potential_energy": [np.array([pin.computePotentialEnergy(model, data, q)])],
            "center_of_mass": [pin.centerOfMass(model, data, q).copy()] if self.base else None,
        }
        if not self.base:
            # those of a free base are along other directions
            pin.computeRNEADerivatives(model, data, q, v, a)
            inverse = [matrix(data.dtau_dq.copy()), matrix(data.dtau_dv.copy()), matrix(symmetric(data.M))]
            pin.computeABADerivatives(model, data, q, v, tau)
            by = [data.ddq_dq.copy(), data.ddq_dv.copy(), symmetric(data.Minv)]
            forward = [data.ddq[order], *map(matrix, by)]
            for of, derivatives in [("inverse", inverse), ("forward", forward)]:
                result[f"{of}_dynamics_derivatives"] = derivatives
        pin.forwardKinematics(model, data, q, v)
        pin.updateFramePlacements(model, data)
        result["forward_kinematics"] = [data.oMf[self.frame].homogeneous]
        J = pin.computeFrameJacobian(model, data, q, self.frame, pin.LOCAL)
        result["body_jacobian"] = [J[np.ix_(angular_first, order)]]
        return {name: outputs for name, outputs in result.items() if outputs is not None}


class MuJoCo:
    """Of a fixed base alone: a free one has other axes for its velocities."""

    def __init__(self, question):
        import mujoco
        import numpy as np

        if question["floating"]:
            raise ValueError("a free base has other axes for its velocities there")
        self.np, self.mujoco, self.version = np, mujoco, mujoco.__version__
        robot = ElementTree.fromstring(question["text"])
        for link in robot.iter("link"):
            for name in ("visual", "collision"):
                for element in link.findall(name):
                    link.remove(element)
        for joint in robot.iter("joint"):
            for name in ("dynamics", "limit"):
                for element in joint.findall(name):
                    joint.remove(element)
            if joint.get("type") == "revolute":
                joint.set("type", "continuous")
        spec = mujoco.MjSpec.from_string(ElementTree.tostring(robot, encoding="unicode"))
        spec.option.gravity = question["gravity"]
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        joints = [self.model.joint(name) for name in question["joints"]]
        self.qpos = np.array([int(joint.qposadr[0]) for joint in joints])
        self.dof = np.array([int(joint.dofadr[0]) for joint in joints])

    def quantities(self, theta, dtheta, ddtheta, tau):
        np, mujoco, model, data = self.np, self.mujoco, self.model, self.data
        n = model.nv
        data.qpos[self.qpos], data.qvel[:] = theta, 0.0
        mujoco.mj_forward(model, data)
        gravity = data.qfrc_bias.copy()
        data.qvel[self.dof], data.qfrc_applied[self.dof] = dtheta, tau
        mujoco.mj_forward(model, data)
        bias, acceleration = data.qfrc_bias.copy(), data.qacc_smooth.copy()
        M = np.zeros((n, n))
        try:
            mujoco.mj_fullM(model, data, M)
        except TypeError:  # before version 4
            mujoco.mj_fullM(model, M, data.qM)
        data.qacc[self.dof] = ddtheta
        mujoco.mj_inverse(model, data)
        return {
            "inverse_dynamics": [data.qfrc_inverse[self.dof]],
            "bias_forces": [bias[self.dof]],
            "gravity_forces": [gravity[self.dof]],
            "mass_matrix": [M[np.ix_(self.dof, self.dof)]],
            "forward_dynamics": [acceleration[self.dof]],
        }


def main():
    question = json.load(sys.stdin)
    try:
        peer = {"pinocchio": Pinocchio, "mujoco": MuJoCo}[question["library"]](question)
    except Exception as error:
        return {"error": " ".join(str(error).split()) or type(error).__name__}
    quantities = {}
    for theta, rates in question["states"]:
        for name, outputs in peer.quantities(theta, *rates).items():
            quantities.setdefault(name, []).append([flat(output) for output in outputs])
    return {"version": peer.version, "quantities": quantities}


json.dump(main(), out)
out.flush()
