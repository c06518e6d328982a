#!/usr/bin/env python3
"""Reference numbers for robots whose base is free, from Pinocchio and MuJoCo, each in its own convention.

    python oracles/make_floating.py --out DIR             legged robots and flying arms of example_robot_data, and our own
    python oracles/make_floating.py anymal --out DIR      these only (--states N; --list shows the names)
    python oracles/make_floating.py --committed           the small files in floating/, 3 states each

Nothing is turned into mozzi's order here: the tests do that with `mozzi::conventions`. In every other state the joints have
rotors (armature). Each record is checked against itself before it is written, as in make.py. Layout: README.md.
"""

import argparse
import importlib.metadata as metadata
import sys
from pathlib import Path

import numpy as np

from make import (
    GRAVITY, PACKAGE, Coupling, Failure, Urdf, Worst, derivatives, find_urdf, is_own, random_state, regular, rng_of, write,
)

HERE = Path(__file__).resolve().parent
ROBOTS = {
    "anymal": "anymal_b_simple_description/robots/anymal",
    "anymal_c": "anymal_c_simple_description/urdf/anymal",
    "hyq": "hyq_description/robots/hyq_no_sensors",
    "talos_reduced": "talos_data/robots/talos_reduced",
    "talos_full": "talos_data/robots/talos_full_v2",
    "icub": "icub_description/robots/icub",
    "a1": "a1_description/urdf/a1",
    "b1_z1": "b1_description/urdf/b1-z1",
    "go1": "go1_description/urdf/go1",
    "go2": "go2_description/urdf/go2",
    "g1": "g1_description/urdf/g1_29dof_rev_1_0",
    "g1_with_hands": "g1_description/urdf/g1_29dof_with_hand_rev_1_0",
    "romeo": "romeo_description/urdf/romeo",
    "romeo_small": "romeo_description/urdf/romeo_small",
    "solo": "solo_description/robots/solo",
    "solo12": "solo_description/robots/solo12",
    "bolt": "bolt_description/robots/bolt",
    "laikago": "laikago_description/urdf/laikago",
    "centauro": "centauro_description/urdf/centauro",
    "borinot": "borinot_description/urdf/borinot_flying_arm_2",
    "hextilt": "hextilt_description/urdf/hextilt_flying_arm_5",
}
OWN = ["oracles/floating/test_quadruped", "oracles/test_tree"]


class Robot:
    """A robot's file, the coupling of its joints behind the six velocities of its base, and its random states."""

    def __init__(self, name):
        self.path, self.shown = find_urdf(ROBOTS.get(name, name))
        self.urdf, self.tip = Urdf(self.path), None
        self.tip = self.urdf.tip()

    def couple(self, names):
        """Of all moving joints in the library's order: theta_all = G theta + offset, and the same behind a free base."""
        self.coupling = Coupling(self.urdf, names)
        self.G = np.block([
            [np.eye(6), np.zeros((6, len(self.coupling.names)))],
            [np.zeros((len(names), 6)), self.coupling.matrix],
        ])

    def angles(self, theta):
        return self.coupling.matrix @ theta + self.coupling.offset

    def random(self, rng):
        """Angles of the independent joints, base pose (x y z, w x y z), three vectors of velocities, rotors' inertia."""
        state, six = random_state(rng, self.urdf, self.coupling.names), rng.standard_normal((3, 6)) * [[1.0], [2.0], [2.0]]
        velocities = [np.concatenate([s, state[key]]) for s, key in zip(six, ("dtheta", "ddtheta", "tau"))]
        quaternion = rng.standard_normal(4)
        pose = np.concatenate([rng.uniform(-2, 2, 3), quaternion / np.linalg.norm(quaternion)])
        return state["theta"], pose, *velocities

    def record(self, library, states, rotors):
        name = self.path.stem
        return {
            "robot": name, "urdf": self.shown, "urdf_package": PACKAGE, "library": f"{library} {metadata.version(PIP[library])}",
            "gravity": GRAVITY, "tip_frame": self.tip, "joint_names": self.coupling.names, "mimic": self.coupling.followers,
            "rotors": rotors, "states": states,
        }


PIP = {"pinocchio": "pin", "mujoco": "mujoco"}


def rotors_of(rng, names):
    return rng.uniform(0.01, 0.1, len(names))


# Pinocchio -----------------------------------------------------------------------------------------------------------


class PinocchioRobot(Robot):
    def __init__(self, name):
        import pinocchio

        super().__init__(name)
        self.pin = pinocchio
        try:
            self.model = pinocchio.buildModelFromUrdf(str(self.path), pinocchio.JointModelFreeFlyer())
        except Exception as error:
            raise Failure(f"Pinocchio does not load it: {' '.join(str(error).split())[:160]}")
        model = self.model
        for vector in (model.damping, model.friction, model.lowerDryFrictionLimit, model.upperDryFrictionLimit):
            vector[:] = 0.0
        model.gravity.linear = np.array(GRAVITY)
        self.couple(list(model.names)[2:])
        self.rows = [self.coupling.names.index(n) if n in self.coupling.names else None for n in list(model.names)[2:]]
        self.frame = model.getFrameId(self.tip, pinocchio.FrameType.BODY)
        self.data = model.createData()

    def q(self, pose, theta, independent=False):
        """Pinocchio's q: (p, x y z w), and the joints, in which a continuous one is (cos, sin)."""
        w = pose[3]
        q = [np.concatenate([pose[:3], pose[4:], [w]])]
        for joint, angle in zip(range(2, self.model.njoints), self.angles(theta)):
            if independent and self.rows[joint - 2] is None:
                continue
            q.append([np.cos(angle), np.sin(angle)] if self.model.nqs[joint] == 2 else [angle])
        return np.concatenate(q)

    def mass_matrix(self, q):
        M = np.triu(self.pin.crba(self.model, self.data, q))
        return self.G.T @ (M + np.triu(M, 1).T) @ self.G

    def kinematics(self, q, v):
        pin, model, data = self.pin, self.model, self.data
        pin.computeJointJacobiansTimeVariation(model, data, q, v)
        pin.updateFramePlacements(model, data)
        r = {"pose": data.oMf[self.frame].homogeneous.copy()}
        for key, frame in (("space_jacobian", pin.WORLD), ("body_jacobian", pin.LOCAL)):
            r[key] = pin.getFrameJacobian(model, data, self.frame, frame) @ self.G
            r[f"{key}_rate"] = pin.getFrameJacobianTimeVariation(model, data, self.frame, frame) @ self.G
        return r

    def evaluate(self, rng, rotors):
        pin, model, data, G = self.pin, self.model, self.data, self.G
        theta, pose, v, a, tau = self.random(rng)
        q, V, A = self.q(pose, theta), G @ v, G @ a
        model.armature[6:] = 0.0 if rotors is None else [0.0 if row is None else rotors[row] for row in self.rows]
        r = {"q": self.q(pose, theta, independent=True), "v": v, "a": a, "tau": tau, "has_rotors": rotors is not None}
        r["M"], r["rnea"] = self.mass_matrix(q), G.T @ pin.rnea(model, data, q, V, A)
        r["nle"] = G.T @ pin.nonLinearEffects(model, data, q, V)
        r["gravity"] = G.T @ pin.computeGeneralizedGravity(model, data, q)
        r["C"] = G.T @ pin.computeCoriolisMatrix(model, data, q, V) @ G
        if regular(r["M"]):
            coupled = bool(self.coupling.followers)
            r["forward_dynamics"] = np.linalg.solve(r["M"], tau - r["nle"]) if coupled else pin.aba(model, data, q, V, tau).copy()
        r.update(self.kinematics(q, V))
        r["force"] = rng.standard_normal(6)  # (f, m), by the robot on the environment
        r["tip_forces"] = r["body_jacobian"].T @ r["force"]
        r["kinetic_energy"] = 0.5 * v @ r["M"] @ v
        r["potential_energy"] = pin.computePotentialEnergy(model, data, q)
        pin.centerOfMass(model, data, q, V, A)
        r["com"], r["vcom"], r["acom"] = data.com[0].copy(), data.vcom[0].copy(), data.acom[0].copy()
        pin.dccrba(model, data, q, V)
        r["Ag"], r["hg"], r["dAg_v"] = data.Ag @ G, data.hg.vector.copy(), data.dAg @ V
        return r, (pose, theta)

    def check(self, r, place, worst, first):
        pin, model, data, G = self.pin, self.model, self.data, self.G
        pose, theta = place
        q, v, a, M = self.q(pose, theta), r["v"], r["a"], r["M"]
        scale = np.abs(M @ a).max() + np.abs(r["nle"]).max()
        worst.check("M a + nle = rnea", M @ a + r["nle"], r["rnea"], 1e-12, scale)
        motion = np.abs(M).max() * (v @ v)
        worst.check("C v = nle - gravity", r["C"] @ v, r["nle"] - r["gravity"], 1e-12, motion + np.abs(r["gravity"]).max())
        if "forward_dynamics" in r:
            force = np.abs(M) @ np.abs(r["forward_dynamics"]) + np.abs(r["nle"])
            worst.check("M aba + nle = tau", M @ r["forward_dynamics"] + r["nle"], r["tau"], 1e-10, force.max())
        if not r["has_rotors"]:
            worst.check("K", pin.computeKineticEnergy(model, data, q, G @ v), r["kinetic_energy"], 1e-12)
        external = [pin.Force.Zero() for _ in range(model.njoints)]
        frame = model.frames[self.frame]
        external[frame.parentJoint] = frame.placement.act(pin.Force(-r["force"][:3], -r["force"][3:]))
        pushed = G.T @ pin.rnea(model, data, q, G @ v, G @ a, external)
        worst.check("wrench as an external force", pushed, r["rnea"] + r["tip_forces"], 1e-12, scale + 10)
        # by other functions: momentum from Ag, its rate from the joints' motion, and both from the centre of mass
        size, mass = np.abs(r["Ag"]).max(), pin.computeTotalMass(model)
        worst.check("Ag v = hg", r["Ag"] @ v, r["hg"], 1e-12, size * np.abs(v).max())
        worst.check("m vcom = hg", mass * r["vcom"], r["hg"][:3], 1e-12, size * np.abs(v).max())
        rate = pin.computeCentroidalMomentumTimeVariation(model, data, q, G @ v, G @ a).vector
        worst.check("Ag a + dAg v = dhg", r["Ag"] @ a + r["dAg_v"], rate, 1e-12, size * (np.abs(a).max() + v @ v))
        worst.check("m acom = dhg", mass * r["acom"], rate[:3], 1e-12, size * (np.abs(a).max() + v @ v))
        if first:
            self.check_differences(r, q, worst)

    def check_differences(self, r, q, worst):
        pin, model, step, V = self.pin, self.model, 1e-5, self.G @ r["v"]
        at = lambda t: pin.integrate(model, q, V * t)
        rate = lambda f: (f(at(step)) - f(at(-step))) / (2 * step)
        for key in ("space_jacobian", "body_jacobian"):
            found = rate(lambda x: self.kinematics(x, V)[key])
            worst.check(f"differences: {key} rate", found, r[f"{key}_rate"], 1e-6, np.abs(r[key]).max())
        centroidal = lambda x: pin.computeCentroidalMap(model, model.createData(), x) @ V
        worst.check("differences: dAg v", rate(centroidal), r["dAg_v"], 1e-6, np.abs(r["Ag"]).max() * (V @ V))
        power = rate(lambda x: pin.computePotentialEnergy(model, self.data, x))
        worst.check("differences: power of gravity", power, r["gravity"] @ r["v"], 1e-6, np.abs(r["gravity"]).max() * 10)
        com = rate(lambda x: pin.centerOfMass(model, model.createData(), x))
        worst.check("differences: vcom", com, r["vcom"], 1e-6, np.abs(r["v"]).max())


def pinocchio_record(name, count):
    robot, rng, worst, states = PinocchioRobot(name), rng_of(f"floating {name}"), Worst(), []
    rotors = rotors_of(rng, robot.coupling.names)
    for index in range(count):
        r, place = robot.evaluate(rng, rotors if index % 2 else None)
        robot.check(r, place, worst, index == 0)
        motion = robot.q(place[0], place[1]), robot.G @ r["v"], robot.G @ r["a"], r["tau"]
        r.update(derivatives(robot, robot.G, index, motion, r.get("forward_dynamics"), worst))
        states.append(r)
    record = robot.record("pinocchio", states, rotors)
    record["bodies"] = list(robot.model.names)[2:]  # behind the base
    record["nqs"] = [int(nq) for nq, row in zip(list(robot.model.nqs)[2:], robot.rows) if row is not None]
    return finish(record, robot, name), worst


# MuJoCo --------------------------------------------------------------------------------------------------------------


class MuJoCoRobot(Robot):
    """The same file read by MuJoCo, with a `freejoint` added to its root body."""

    def __init__(self, name):
        import mujoco

        super().__init__(name)
        self.mj = mujoco
        options = '<mujoco><compiler balanceinertia="false" fusestatic="false" discardvisual="true"/></mujoco></robot>'
        spec = mujoco.MjSpec.from_string(self.path.read_text().replace("</robot>", options))
        self.base = spec.worldbody.first_body().name
        spec.worldbody.first_body().add_freejoint()
        self.model = model = spec.compile()
        model.dof_damping[:] = model.dof_frictionloss[:] = model.dof_armature[:] = 0.0
        model.opt.gravity[:] = GRAVITY
        flags = mujoco.mjtDisableBit
        model.opt.disableflags |= int(flags.mjDSBL_CONSTRAINT) | int(flags.mjDSBL_ACTUATION)
        self.data = mujoco.MjData(model)
        self.couple([model.joint(i).name for i in range(1, model.njnt)])

    def evaluate(self, rng, rotors, worst):
        mj, model, data, G = self.mj, self.model, self.data, self.G
        theta, pose, qvel, qacc, tau = self.random(rng)
        model.dof_armature[6:] = 0.0
        for name, inertia in zip(self.coupling.names, [] if rotors is None else rotors):
            model.dof_armature[model.joint(name).dofadr[0]] = inertia
        data.qpos[:], data.qvel[:] = np.concatenate([pose, self.angles(theta)]), G @ qvel
        data.qfrc_applied[:] = 0.0
        mj.mj_forward(model, data)
        mj.mj_energyPos(model, data)
        mj.mj_energyVel(model, data)
        mj.mj_subtreeVel(model, data)
        M, base, tip = np.zeros((model.nv, model.nv)), model.body(self.base).id, model.body(self.tip).id
        mj.mj_fullM(model, data, M)
        r = {"qpos": np.concatenate([pose, theta]), "qvel": qvel, "qacc": qacc, "qfrc_applied": tau,
             "has_rotors": rotors is not None, "M": G.T @ M @ G, "qfrc_bias": G.T @ data.qfrc_bias}
        r["potential_energy"], r["kinetic_energy"] = data.energy.tolist()
        for key in ("subtree_com", "subtree_linvel", "subtree_angmom"):
            r[key] = getattr(data, key)[base].copy()
        R, p, six = data.xmat[tip].reshape(3, 3).copy(), data.xpos[tip].copy(), np.zeros(6)
        r["pose"] = np.block([[R, p[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]])
        mj.mj_objectVelocity(model, data, mj.mjtObj.mjOBJ_XBODY, tip, six, 1)
        r["tip_velocity"] = six.copy()  # (w, v) in the body's axes
        data.qacc[:] = G @ qacc
        mj.mj_inverse(model, data)
        r["qfrc_inverse"] = G.T @ data.qfrc_inverse
        if self.coupling.followers:
            r["forward_dynamics"] = np.linalg.solve(r["M"], tau - r["qfrc_bias"])
        else:
            data.qfrc_applied[:] = tau
            mj.mj_forward(model, data)
            r["forward_dynamics"] = data.qacc.copy()
        scale = np.abs(r["M"] @ qacc).max() + np.abs(r["qfrc_bias"]).max()
        worst.check("M qacc + bias = inverse", r["M"] @ qacc + r["qfrc_bias"], r["qfrc_inverse"], 1e-11, scale)
        force = np.abs(r["M"]) @ np.abs(r["forward_dynamics"]) + np.abs(r["qfrc_bias"])
        worst.check("M forward + bias = applied", r["M"] @ r["forward_dynamics"] + r["qfrc_bias"], tau, 1e-10, force.max())
        worst.check("K", 0.5 * qvel @ r["M"] @ qvel, r["kinetic_energy"], 1e-11)
        return r


def mujoco_record(name, count):
    robot, rng, worst = MuJoCoRobot(name), rng_of(f"floating mujoco {name}"), Worst()
    rotors = rotors_of(rng, robot.coupling.names)
    states = [robot.evaluate(rng, rotors if index % 2 else None, worst) for index in range(count)]
    return finish(robot.record("mujoco", states, rotors), robot, name), worst


def finish(record, robot, name):
    if is_own(name):
        record["urdf_package"] = None
    else:
        record["urdf_path"] = str(robot.path)
    return record


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robots", nargs="*", help="a name of --list, or a path inside the package")
    parser.add_argument("--states", type=int, default=100, help="random states a robot (100)")
    parser.add_argument("--out", type=Path, help="folder to write to")
    parser.add_argument("--committed", action="store_true", help="write the small files in floating/")
    parser.add_argument("--list", action="store_true", help="print the names and files, and stop")
    options = parser.parse_args()
    if options.list:
        for name in [*ROBOTS, *OWN]:
            print(f"{name:32} {find_urdf(ROBOTS.get(name, name))[1]}")
        return
    folder = HERE / "floating" if options.committed else options.out
    if folder is None:
        parser.error("--out DIR or --committed is needed")
    folder.mkdir(parents=True, exist_ok=True)
    count = 3 if options.committed else options.states
    for name in OWN if options.committed else options.robots or [*ROBOTS, *OWN]:
        libraries = {"pinocchio": pinocchio_record, "mujoco": mujoco_record}
        for library, make in libraries.items():
            if library == "pinocchio" or is_own(name):
                write(folder / f"{library}_{Path(name).name if is_own(name) else name}.json", make(name, count))


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(f"error: {failure}")
