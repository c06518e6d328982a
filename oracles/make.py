#!/usr/bin/env python3
"""Reference numbers for mozzi's tests, from Pinocchio, MuJoCo and the Modern Robotics package.

    python oracles/make.py --out DIR                      the package's main robots and our own, 100 states each
    python oracles/make.py ur5 models/panda --out DIR     these only (--states N; --list shows the names)
    python oracles/make.py --all --states 10 --out DIR    every URDF of example_robot_data that Pinocchio loads
    python oracles/make.py --committed                    the small files beside this script

Conventions and layout: README.md. Every record is checked against itself before it is written: two algorithms for each
quantity where the library has two, and central differences on the first state of every robot.
"""

import argparse
import importlib.metadata as metadata
import json
import sys
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent
PACKAGE = "example_robot_data"
GRAVITY = [0.0, 0.0, -9.81]

# Short names of the robots of the package that mozzi is tested on.
ROBOTS = {
    "ur5": "ur_description/urdf/ur5_robot.urdf",
    "panda": "panda_description/urdf/panda.urdf",
    "talos_reduced": "talos_data/robots/talos_reduced.urdf",
    "talos_full": "talos_data/robots/talos_full_v2.urdf",
    "anymal": "anymal_b_simple_description/robots/anymal.urdf",
    "hyq": "hyq_description/robots/hyq_no_sensors.urdf",
    "icub": "icub_description/robots/icub.urdf",
    "kinova": "kinova_description/robots/kinova.urdf",
    "tiago": "tiago_description/robots/tiago.urdf",
    "z1": "z1_description/urdf/z1.urdf",
    "xarm7": "xarm_description/urdf/xarm7.urdf",
    "double_pendulum": "double_pendulum_description/urdf/double_pendulum.urdf",
    "double_pendulum_continuous": "double_pendulum_description/urdf/double_pendulum_continuous.urdf",
}
# The folders of our own robots, as they are called in the records.
OWN = {"models": REPOSITORY / "crates/mozzi-urdf/models", "oracles": REPOSITORY / "oracles"}
# Otherwise the tip is the leaf link that the most moving joints carry, the last of them in the file.
TIPS = {"models/panda": "panda_hand_tcp"}


class Failure(Exception):
    """What went wrong, in one line."""


def package_root():
    try:
        root = metadata.distribution("example-robot-data").locate_file("cmeel.prefix/share/example-robot-data/robots")
    except metadata.PackageNotFoundError:
        raise Failure("the package example-robot-data is not installed: pip install -r oracles/requirements.txt")
    if not Path(root).is_dir():
        raise Failure(f"example-robot-data has no folder {root}")
    return Path(root)


def own_models():
    return [f"{folder}/{path.stem}" for folder, place in OWN.items() for path in sorted(place.glob("*.urdf"))]


def is_own(name):
    return name.partition("/")[0] in OWN


def find_urdf(name):
    """The path of a robot's file, and that path as written into the record."""
    if is_own(name):
        folder, _, stem = name.partition("/")
        path = OWN[folder] / f"{stem}.urdf"
        shown = path.relative_to(REPOSITORY).as_posix()
    else:
        shown = ROBOTS.get(name, name if name.endswith(".urdf") else f"{name}.urdf")
        path = package_root() / shown
    if not path.is_file():
        raise Failure(f"no file {path}")
    return path, shown


def angular_first(rows):
    """Pinocchio's and MuJoCo's six rows are linear first."""
    return np.concatenate([rows[3:], rows[:3]])


class Urdf:
    """What Pinocchio does not tell: mimic joints and leaf links, straight from the file."""

    def __init__(self, path):
        try:
            robot = ElementTree.parse(path).getroot()
        except ElementTree.ParseError as error:
            raise Failure(f"not XML: {error}")
        self.kind, self.parent, self.mimic = {}, {}, {}
        for joint in robot.findall("joint"):
            name = joint.get("name")
            self.kind[name] = joint.get("type")
            self.parent[joint.find("child").get("link")] = (joint.find("parent").get("link"), name)
            mimic = joint.find("mimic")
            if mimic is not None and joint.get("type") != "fixed":
                ratio, offset = mimic.get("multiplier") or 1.0, mimic.get("offset") or 0.0
                self.mimic[name] = (mimic.get("joint"), float(ratio), float(offset))
        self.links = [link.get("name") for link in robot.findall("link")]

    def tip(self):
        inner = {parent for parent, _ in self.parent.values()}
        best, most = None, -1
        for link in self.links:
            moving, at = 0, link
            while at in self.parent:
                at, joint = self.parent[at]
                moving += self.kind[joint] != "fixed"
            if link not in inner and moving >= most:
                best, most = link, moving
        return best

    def master(self, joint):
        """The independent joint that drives `joint`, with ratio and offset, through mimics of mimics."""
        ratio, offset, seen = 1.0, 0.0, set()
        while joint in self.mimic:
            if joint in seen:
                raise Failure(f"mimic joints in a circle at {joint}")
            seen.add(joint)
            joint, next_ratio, next_offset = self.mimic[joint]
            ratio, offset = ratio * next_ratio, offset + ratio * next_offset
            if joint not in self.kind:
                raise Failure(f"mimic of the joint {joint}, which is not in the file")
        return joint, ratio, offset


class Coupling:
    """theta_all = G theta + offset: every joint of the file from the independent ones.

    Mimic joints make a constrained robot out of the free one. Its equations are the free robot's projected by the
    constant G (M = G' M G, tau = G' tau, C = G' C G, J = J G), which holds for the Christoffel C too.
    """

    def __init__(self, urdf, names):
        self.names = [name for name in names if name not in urdf.mimic]
        self.matrix, self.offset = np.zeros((len(names), len(self.names))), np.zeros(len(names))
        for row, name in enumerate(names):
            master, ratio, self.offset[row] = urdf.master(name)
            if master not in self.names:
                raise Failure(f"mimic of {master}, which does not move")
            self.matrix[row, self.names.index(master)] = ratio
        self.followers = [
            {"joint": name, "master": master, "ratio": ratio, "offset": offset}
            for name in names if name in urdf.mimic
            for master, ratio, offset in [urdf.master(name)]
        ]


def random_state(rng, urdf, names):
    prismatic = np.array([urdf.kind[name] == "prismatic" for name in names])
    theta = np.where(prismatic, rng.uniform(-0.5, 0.5, len(names)), rng.uniform(-np.pi, np.pi, len(names)))
    dtheta, ddtheta, tau = rng.standard_normal((3, len(names))) * np.array([[1.0], [2.0], [2.0]])
    return {"theta": theta, "dtheta": dtheta, "ddtheta": ddtheta, "tau": tau}


def regular(M):
    """Whether M, scaled to ones on its diagonal, is positive definite well beyond rounding."""
    diagonal = np.diag(M)
    if diagonal.min() <= 0.0:
        return False
    return np.linalg.eigvalsh(M / np.sqrt(np.outer(diagonal, diagonal)))[0] > 1e-12


def rng_of(name):
    return np.random.default_rng(zlib.crc32(name.encode()))


class Worst:
    """The largest disagreement seen, by name of the check; too large a one is an error."""

    def __init__(self):
        self.seen = {}

    def check(self, name, found, expected, tolerance, scale=None):
        scale = max(1e-30, np.abs(expected).max() if scale is None else scale)
        error = np.abs(np.asarray(found) - np.asarray(expected)).max() / scale
        self.seen[name] = max(self.seen.get(name, 0.0), error)
        if not error <= tolerance:
            raise Failure(f"check failed: {name} is off by {error:.1e}, more than {tolerance:.0e}")


# Pinocchio -----------------------------------------------------------------------------------------------------------

# Derivatives and the regressor are many numbers: of so many states alone, the first ones.
DIFFERENTIATED, REGRESSED = 2, 1


def derivatives(robot, G, index, motion, forward, worst):
    """Of the index-th state, at the motion (q, v, a, tau) of all joints, where `forward` accelerations answer tau, or None.

    Columns along Pinocchio's velocities. Of a robot with followers, those of the free robot projected by G.
    """
    pin, model, data, (q, v, a, tau) = robot.pin, robot.model, robot.data, motion
    if index >= DIFFERENTIATED:
        return {}

    def inverse(a):
        dq, dv, _ = pin.computeRNEADerivatives(model, data, q, v, a)
        return G.T @ dq @ G, G.T @ dv @ G

    r = {}
    r["dtau_dq"], r["dtau_dv"] = inverse(a)
    step = 1e-6
    force = lambda t: G.T @ pin.rnea(model, data, pin.integrate(model, q, v * t), v, a)
    found, size = (force(step) - force(-step)) / (2 * step), np.abs(r["dtau_dq"]) @ np.abs(np.linalg.pinv(G) @ v)
    worst.check("differences: dtau_dq", r["dtau_dq"] @ (np.linalg.pinv(G) @ v), found, 1e-6, size.max())
    force = lambda t: G.T @ pin.rnea(model, data, q, v + t * a, a)
    along = np.linalg.pinv(G) @ a
    size = np.abs(r["dtau_dv"]) @ np.abs(along)
    worst.check("differences: dtau_dv", r["dtau_dv"] @ along, (force(step) - force(-step)) / (2 * step), 1e-6, size.max())

    if index < REGRESSED:
        r["regressor"] = G.T @ pin.computeJointTorqueRegressor(model, data, q, v, a)
        parameters = np.concatenate([inertia.toDynamicParameters() for inertia in list(model.inertias)[1:]])
        rotors = G.T @ (model.armature * a)
        size = np.abs(r["regressor"]) @ np.abs(parameters)
        needed = G.T @ pin.rnea(model, data, q, v, a)
        worst.check("regressor parameters = rnea", r["regressor"] @ parameters + rotors, needed, 1e-11, size.max())

    if forward is not None:
        M = np.triu(pin.crba(model, data, q))
        M = G.T @ (M + np.triu(M, 1).T) @ G
        by_q, by_v = inverse(G @ forward)
        if G.shape[0] == G.shape[1]:
            ddq_dq, ddq_dv, Minv = (x.copy() for x in pin.computeABADerivatives(model, data, q, v, G @ tau))
            Minv = np.triu(Minv) + np.triu(Minv, 1).T
        else:
            ddq_dq, ddq_dv, Minv = -np.linalg.solve(M, by_q), -np.linalg.solve(M, by_v), np.linalg.inv(M)
        for name, x, y in (("ddq_dq", ddq_dq, -by_q), ("ddq_dv", ddq_dv, -by_v), ("Minv", Minv, np.eye(len(M)))):
            worst.check(f"M {name}", M @ x, y, 1e-10, (np.abs(M) @ np.abs(x)).max())
        r["ddq_dq"], r["ddq_dv"], r["Minv"] = ddq_dq, ddq_dv, Minv
    return r


class PinocchioRobot:
    def __init__(self, name):
        import pinocchio

        self.pin, self.name = pinocchio, name
        self.path, self.shown = find_urdf(name)
        self.urdf = Urdf(self.path)
        self.model = self.load(mimic=False)
        if self.model.nv == 0:
            raise Failure("no moving joint")
        self.weightless = self.model.copy()
        self.weightless.gravity.setZero()
        self.data = self.model.createData()
        names = list(self.model.names)[1:]
        if any(self.model.nvs[i] != 1 for i in range(1, self.model.njoints)):
            raise Failure("a joint with more than one degree of freedom")
        self.coupling = Coupling(self.urdf, names)
        self.names = self.coupling.names
        self.tip = TIPS.get(name) or self.urdf.tip()
        if not self.model.existFrame(self.tip):
            raise Failure(f"no frame {self.tip}")
        self.frame = self.model.getFrameId(self.tip, pinocchio.FrameType.BODY)
        # Pinocchio's own mimic joints, where it can load them, are a second opinion on M and h.
        self.native, self.trap = None, None
        if self.urdf.mimic:
            try:
                self.native = self.load(mimic=True)
            except Exception as error:
                self.trap = str(error).strip()

    def load(self, mimic):
        try:
            model = self.pin.buildModelFromUrdf(str(self.path), mimic=mimic)
        except Exception as error:
            raise Failure(f"Pinocchio does not load it: {' '.join(str(error).split())[:160]}") if not mimic else error
        for vector in (model.armature, model.damping, model.friction, model.rotorInertia,
                       model.lowerDryFrictionLimit, model.upperDryFrictionLimit):
            vector[:] = 0.0
        model.gravity.linear = np.array(GRAVITY)
        return model

    def configuration(self, model, angles):
        """One number a joint -> Pinocchio's q, in which a continuous joint is (cos, sin)."""
        q = np.zeros(model.nq)
        for i in range(1, model.njoints):
            if model.names[i] not in angles:
                continue
            at, angle = model.idx_qs[i], angles[model.names[i]]
            if model.nqs[i] == 2:
                q[at], q[at + 1] = np.cos(angle), np.sin(angle)
            elif model.nqs[i] == 1:
                q[at] = angle
        return q

    def all_angles(self, theta):
        return dict(zip(list(self.model.names)[1:], self.coupling.matrix @ theta + self.coupling.offset))

    def kinematics(self, theta, dtheta):
        pin, G = self.pin, self.coupling.matrix
        q = self.configuration(self.model, self.all_angles(theta))
        pin.computeJointJacobiansTimeVariation(self.model, self.data, q, G @ dtheta)
        pin.updateFramePlacements(self.model, self.data)
        result = {"pose": self.data.oMf[self.frame].homogeneous.copy()}
        for key, frame in (("space_jacobian", pin.WORLD), ("body_jacobian", pin.LOCAL)):
            J = pin.getFrameJacobian(self.model, self.data, self.frame, frame)
            dJ = pin.getFrameJacobianTimeVariation(self.model, self.data, self.frame, frame)
            result[key], result[f"{key}_rate"] = angular_first(J) @ G, angular_first(dJ) @ G
        return result

    def mass_matrix(self, theta):
        q = self.configuration(self.model, self.all_angles(theta))
        M = np.triu(self.pin.crba(self.model, self.data, q))
        M = M + np.triu(M, 1).T
        return self.coupling.matrix.T @ M @ self.coupling.matrix

    def evaluate(self, state, F_tip):
        pin, model, data, G = self.pin, self.model, self.data, self.coupling.matrix
        theta, dtheta, ddtheta, tau = (state[key] for key in ("theta", "dtheta", "ddtheta", "tau"))
        q, v, a = self.configuration(model, self.all_angles(theta)), G @ dtheta, G @ ddtheta
        r = dict(state)
        r["inverse_dynamics"] = G.T @ pin.rnea(model, data, q, v, a)
        r["mass_matrix"] = self.mass_matrix(theta)
        r["velocity_product"] = G.T @ pin.rnea(self.weightless, self.weightless.createData(), q, v, 0 * v)
        r["gravity_forces"] = G.T @ pin.computeGeneralizedGravity(model, data, q)
        r["bias_forces"] = G.T @ pin.nonLinearEffects(model, data, q, v)
        if not regular(r["mass_matrix"]):
            pass  # massless links leave M singular: the accelerations do not exist
        elif self.urdf.mimic:
            r["forward_dynamics"] = np.linalg.solve(r["mass_matrix"], tau - r["bias_forces"])
        else:
            r["forward_dynamics"] = pin.aba(model, data, q, v, tau).copy()
        C = G.T @ pin.computeCoriolisMatrix(model, data, q, v) @ G
        r["coriolis_matrix"], r["mass_matrix_rate"] = C, C + C.T
        r.update(self.kinematics(theta, dtheta))
        r["F_tip"] = F_tip
        r["tip_forces"] = r["body_jacobian"].T @ F_tip
        r["inverse_dynamics_with_tip"] = r["inverse_dynamics"] + r["tip_forces"]
        r["kinetic_energy"] = pin.computeKineticEnergy(model, data, q, v)
        r["potential_energy"] = pin.computePotentialEnergy(model, data, q)
        return r

    def derivatives(self, r, index, worst):
        G = self.coupling.matrix
        motion = self.configuration(self.model, self.all_angles(r["theta"])), G @ r["dtheta"], G @ r["ddtheta"], r["tau"]
        return derivatives(self, G, index, motion, r.get("forward_dynamics"), worst)

    def check(self, r, worst, first):
        pin, G = self.pin, self.coupling.matrix
        M, dtheta, theta = r["mass_matrix"], r["dtheta"], r["theta"]
        terms = M @ r["ddtheta"] + r["bias_forces"]
        scale = np.abs(M @ r["ddtheta"]).max() + np.abs(r["bias_forces"]).max() + np.abs(r["gravity_forces"]).max()
        worst.check("M ddtheta + h = inverse dynamics", terms, r["inverse_dynamics"], 1e-12, scale)
        worst.check("c + g = h", r["velocity_product"] + r["gravity_forces"], r["bias_forces"], 1e-12, scale)
        motion = np.abs(r["velocity_product"]).max() + np.abs(M).max() * (dtheta @ dtheta)
        worst.check("C dtheta = c", r["coriolis_matrix"] @ dtheta, r["velocity_product"], 1e-12, motion)
        worst.check("K = dtheta' M dtheta / 2", 0.5 * dtheta @ M @ dtheta, r["kinetic_energy"], 1e-12)
        if "forward_dynamics" in r:
            back = M @ r["forward_dynamics"] + r["bias_forces"]
            force = np.abs(M) @ np.abs(r["forward_dynamics"]) + np.abs(r["bias_forces"])
            worst.check("M forward dynamics + h = tau", back, r["tau"], 1e-10, force.max())
        # a wrench applied to the environment is, for Pinocchio, its opposite applied to the last link
        q = self.configuration(self.model, self.all_angles(theta))
        joint = self.model.frames[self.frame].parentJoint
        placement = self.model.frames[self.frame].placement
        external = [pin.Force.Zero() for _ in range(self.model.njoints)]
        external[joint] = placement.act(pin.Force(-r["F_tip"][3:], -r["F_tip"][:3]))
        tau = G.T @ pin.rnea(self.model, self.data, q, G @ dtheta, G @ r["ddtheta"], external)
        worst.check("tip wrench as an external force", tau, r["inverse_dynamics_with_tip"], 1e-12, scale + 10)
        if self.native:
            self.check_native(r, worst)
        if first:
            self.check_differences(r, worst)

    def check_native(self, r, worst):
        """Pinocchio's own mimic joints: M, h and inverse dynamics must be ours."""
        pin, model = self.pin, self.native
        data, order = model.createData(), [self.names.index(n) for n, k in zip(model.names, model.nvs) if k == 1]
        q = self.configuration(model, dict(zip(self.names, r["theta"])))
        v, a = r["dtheta"][order], r["ddtheta"][order]
        M = np.triu(pin.crba(model, data, q))
        M = M + np.triu(M, 1).T
        worst.check("mimic=True: M", M, r["mass_matrix"][np.ix_(order, order)], 1e-12)
        worst.check("mimic=True: h", pin.nonLinearEffects(model, data, q, v), r["bias_forces"][order], 1e-11)
        worst.check("mimic=True: inverse dynamics", pin.rnea(model, data, q, v, a), r["inverse_dynamics"][order], 1e-11)

    def check_differences(self, r, worst):
        theta, dtheta, step = r["theta"], r["dtheta"], 1e-5
        rate = lambda f: (f(theta + step * dtheta) - f(theta - step * dtheta)) / (2 * step)
        pose = lambda x: self.kinematics(x, dtheta)["pose"]
        T, dT = r["pose"], rate(pose)
        vee = lambda m: np.array([m[2, 1], m[0, 2], m[1, 0], *m[:3, 3]])
        inverse = np.linalg.inv(T)
        worst.check("differences: space Jacobian", vee(dT @ inverse), r["space_jacobian"] @ dtheta, 1e-7)
        worst.check("differences: body Jacobian", vee(inverse @ dT), r["body_jacobian"] @ dtheta, 1e-7)
        for key in ("space_jacobian", "body_jacobian"):
            found = rate(lambda x: self.kinematics(x, dtheta)[key])
            worst.check(f"differences: {key} rate", found, r[f"{key}_rate"], 1e-6, np.abs(r[key]).max())
        worst.check("differences: mass matrix rate", rate(self.mass_matrix), r["mass_matrix_rate"], 1e-6,
                    np.abs(r["mass_matrix"]).max())
        angles = lambda x: self.configuration(self.model, self.all_angles(x))
        power = rate(lambda x: self.pin.computePotentialEnergy(self.model, self.data, angles(x)))
        worst.check("differences: power of gravity", power, r["gravity_forces"] @ dtheta, 1e-6,
                    np.abs(r["gravity_forces"]).max() + 1e-3)


def pinocchio_record(name, states, absolute):
    robot = PinocchioRobot(name)
    if robot.trap:
        print(f"{name}: no second opinion from Pinocchio's mimic=True: {robot.trap}")
    rng, worst, records = rng_of(name), Worst(), []
    for index in range(states):
        state = random_state(rng, robot.urdf, robot.names)
        records.append(robot.evaluate(state, rng.standard_normal(6)))
        robot.check(records[-1], worst, index == 0)
        records[-1].update(robot.derivatives(records[-1], index, worst))
    record = {
        "robot": Path(name).name if is_own(name) else name,
        "urdf": robot.shown,
        "urdf_package": None if is_own(name) else PACKAGE,
        "library": f"pinocchio {metadata.version('pin')}",
        "gravity": GRAVITY,
        "tip_frame": robot.tip,
        "joint_names": robot.names,
        "mimic": robot.coupling.followers,
        "bodies": list(robot.model.names)[1:],
        "states": records,
    }
    if absolute:
        record["urdf_path"] = str(robot.path)
    return record, worst


# MuJoCo --------------------------------------------------------------------------------------------------------------


def mujoco_record(name, states):
    """M, h, accelerations, Jacobians and energies by MuJoCo; mimic joints by the projection of `Coupling`."""
    import mujoco

    path, shown = find_urdf(name)
    urdf = Urdf(path)
    options = '<mujoco><compiler balanceinertia="false" fusestatic="false" discardvisual="true"/></mujoco></robot>'
    model = mujoco.MjModel.from_xml_string(path.read_text().replace("</robot>", options))
    for vector in (model.dof_damping, model.dof_armature, model.dof_frictionloss):
        vector[:] = 0.0
    model.opt.gravity[:] = GRAVITY
    flags = mujoco.mjtDisableBit
    model.opt.disableflags |= int(flags.mjDSBL_CONSTRAINT) | int(flags.mjDSBL_ACTUATION)
    data = mujoco.MjData(model)
    names = [model.joint(i).name for i in range(model.njnt)]
    coupling = Coupling(urdf, names)
    G, tip = coupling.matrix, TIPS.get(name) or urdf.tip()
    rng, worst, records = rng_of(f"mujoco {name}"), Worst(), []
    body, nv, other = model.body(tip).id, model.nv, PinocchioRobot(name)
    for _ in range(states):
        r = random_state(rng, urdf, coupling.names)
        data.qpos[:], data.qvel[:] = G @ r["theta"] + coupling.offset, G @ r["dtheta"]
        mujoco.mj_forward(model, data)
        M = np.zeros((nv, nv))
        mujoco.mj_fullM(model, data, M)
        r["mass_matrix"], r["bias_forces"] = G.T @ M @ G, G.T @ data.qfrc_bias
        # mj_jacBody: its linear rows are the velocity of the body's origin, in the world's axes
        R, p = data.xmat[body].reshape(3, 3).copy(), data.xpos[body].copy()
        linear, angular = np.zeros((3, nv)), np.zeros((3, nv))
        mujoco.mj_jacBody(model, data, linear, angular, body)
        r["pose"] = np.block([[R, p[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]])
        r["space_jacobian"] = np.vstack([angular, linear + np.cross(p, angular, axisb=0, axisc=0)]) @ G
        r["body_jacobian"] = np.vstack([R.T @ angular, R.T @ linear]) @ G
        mujoco.mj_energyVel(model, data)
        r["kinetic_energy"] = float(data.energy[1])
        data.qacc[:] = G @ r["ddtheta"]
        mujoco.mj_inverse(model, data)
        r["inverse_dynamics"] = G.T @ data.qfrc_inverse
        if urdf.mimic:
            r["forward_dynamics"] = np.linalg.solve(r["mass_matrix"], r["tau"] - r["bias_forces"])
        else:
            data.qfrc_applied[:] = r["tau"]
            mujoco.mj_forward(model, data)
            r["forward_dynamics"] = data.qacc.copy()
            data.qfrc_applied[:] = 0.0
        scale = np.abs(r["mass_matrix"] @ r["ddtheta"]).max() + np.abs(r["bias_forces"]).max()
        worst.check("M ddtheta + h = inverse dynamics", r["mass_matrix"] @ r["ddtheta"] + r["bias_forces"],
                    r["inverse_dynamics"], 1e-11, scale)
        worst.check("K", 0.5 * r["dtheta"] @ r["mass_matrix"] @ r["dtheta"], r["kinetic_energy"], 1e-11)
        compare_with_pinocchio(other, coupling.names, r, worst)
        records.append(r)
    record = {
        "robot": Path(name).name, "urdf": shown, "urdf_package": None,
        "library": f"mujoco {metadata.version('mujoco')}", "gravity": GRAVITY, "tip_frame": tip,
        "joint_names": coupling.names, "mimic": coupling.followers, "states": records,
    }
    return record, worst


def compare_with_pinocchio(robot, names, r, worst):
    order = [names.index(joint) for joint in robot.names]
    state = {key: r[key][order] for key in ("theta", "dtheta", "ddtheta", "tau")}
    other = robot.evaluate(state, np.zeros(6))
    for key in r.keys() - state.keys():
        value = r[key]
        if key == "mass_matrix":
            value = value[np.ix_(order, order)]
        elif key.endswith("jacobian"):
            value = value[:, order]
        elif key not in ("pose", "kinetic_energy"):
            value = value[order]
        worst.check(f"Pinocchio: {key}", value, other[key], 1e-9)


# Modern Robotics -----------------------------------------------------------------------------------------------------


def modern_robotics_record():
    """The worked examples of the package's documentation, computed again in full precision."""
    import modern_robotics as mr

    a = np.array
    pose = a([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 3], [0, 0, 0, 1]], float)
    shift = lambda *p: np.block([[np.eye(3), a(p, float)[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]])
    M12 = a([[0, 0, 1, 0.28], [0, 1, 0, 0.13585], [-1, 0, 0, 0], [0, 0, 0, 1]], float)
    Mlist = a([shift(0, 0, 0.089159), M12, shift(0, -0.1197, 0.395), shift(0, 0, 0.14225)])
    Glist = a([np.diag([0.010267, 0.010267, 0.00666, 3.7, 3.7, 3.7]),
               np.diag([0.22689, 0.22689, 0.0151074, 8.393, 8.393, 8.393]),
               np.diag([0.0494433, 0.0494433, 0.004095, 2.275, 2.275, 2.275])])
    published = a([[1, 0, 1, 0, 1, 0], [0, 1, 0, -0.089, 0, 0], [0, 1, 0, -0.089, 0, 0.425]], float)
    unit = a([[0, 0, 1, 0, 0, 0], [0, 1, 0, -0.089, 0, 0], [0, 1, 0, -0.089, 0, 0.425]], float)
    rows = a([[0, 0, 1, 0, 0.2, 0.2], [1, 0, 0, 2, 0, 3], [0, 1, 0, 0, 2, 1], [1, 0, 0, 0.2, 0.3, 0.4]])
    angles = a([0.2, 1.1, 0.1, 1.2])
    home = a([[-1, 0, 0, 0], [0, 1, 0, 6], [0, 0, -1, 2], [0, 0, 0, 1]], float)
    Blist = a([[0, 0, -1, 2, 0, 0], [0, 0, 0, 0, 1, 0], [0, 0, 1, 0, 0, 0.1]], float)
    Slist = a([[0, 0, 1, 4, 0, 0], [0, 0, 0, 0, 1, 0], [0, 0, -1, -6, 0, -0.1]], float)
    turn = a([np.pi / 2, 3, np.pi])
    R, omega = a([[0, 0, 1], [1, 0, 0], [0, 1, 0]], float), a([1.0, 2.0, 3.0])
    V = a([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    screw = a([1.57079632, 0, 0, 0, 2.35619449, 2.35619449])

    maps = [
        ("MatrixExp3", {"so3mat": mr.VecToso3(omega)}, mr.MatrixExp3(mr.VecToso3(omega))),
        ("MatrixLog3", {"R": R}, mr.MatrixLog3(R)),
        ("MatrixExp6", {"se3mat": mr.VecTose3(screw)}, mr.MatrixExp6(mr.VecTose3(screw))),
        ("MatrixLog6", {"T": pose}, mr.MatrixLog6(pose)),
        ("TransInv", {"T": pose}, mr.TransInv(pose)),
        ("Adjoint", {"T": pose}, mr.Adjoint(pose)),
        ("ad", {"V": V}, mr.ad(V)),
        ("ScrewToAxis", {"q": [3.0, 0.0, 0.0], "s": [0.0, 0.0, 1.0], "h": 2.0},
         mr.ScrewToAxis(a([3, 0, 0]), a([0, 0, 1]), 2)),
        ("FKinBody", {"M": home, "Blist": Blist, "thetalist": turn}, mr.FKinBody(home, Blist.T, turn)),
        ("FKinSpace", {"M": home, "Slist": Slist, "thetalist": turn}, mr.FKinSpace(home, Slist.T, turn)),
        ("JacobianBody", {"Blist": rows, "thetalist": angles}, mr.JacobianBody(rows.T, angles)),
        ("JacobianSpace", {"Slist": rows, "thetalist": angles}, mr.JacobianSpace(rows.T, angles)),
    ]

    theta, dtheta, ddtheta, tau = a([0.1] * 3), a([0.1, 0.2, 0.3]), a([2, 1.5, 1]), a([0.5, 0.6, 0.7])
    g, Ftip = a([0, 0, -9.8]), np.ones(6)

    def dynamics(Slist):
        rest = (Mlist, Glist, Slist.T)
        return {
            "Mlist": Mlist, "Glist": Glist, "Slist": Slist, "g": g, "Ftip": Ftip,
            "thetalist": theta, "dthetalist": dtheta, "ddthetalist": ddtheta, "taulist": tau,
            "InverseDynamics": mr.InverseDynamics(theta, dtheta, ddtheta, g, Ftip, *rest),
            "MassMatrix": mr.MassMatrix(theta, *rest),
            "VelQuadraticForces": mr.VelQuadraticForces(theta, dtheta, *rest),
            "GravityForces": mr.GravityForces(theta, g, *rest),
            "EndEffectorForces": mr.EndEffectorForces(theta, Ftip, *rest),
            "ForwardDynamics": mr.ForwardDynamics(theta, dtheta, tau, g, Ftip, *rest),
        }

    first, second = dynamics(published), dynamics(unit)
    # the digits that the package prints
    worst = Worst()
    worst.check("InverseDynamics, printed", first["InverseDynamics"], [74.69616155, -33.06766016, -3.23057314], 1e-9)
    worst.check("ForwardDynamics, printed", first["ForwardDynamics"], [-0.97392907, 25.58466784, -32.91499212], 1e-9)
    worst.check("EndEffectorForces, printed", first["EndEffectorForces"], [1.40954608, 1.85771497, 1.392409], 1e-8)
    record = {
        "library": f"modern_robotics {metadata.version('modern_robotics')}",
        "maps": [{"function": name, "input": given, "output": result} for name, given, result in maps],
        "three_link_published": first,
        "three_link_unit_screws": second,
    }
    return record, worst


# Writing -------------------------------------------------------------------------------------------------------------


def plain(value):
    """NumPy -> lists and floats; json writes floats with all their digits."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, np.ndarray):
        return value.tolist()
    return float(value) if isinstance(value, np.floating) else value


def write(path, made):
    record, worst = made
    record = plain(record)
    states = record.pop("states", None)
    dump = lambda value: json.dumps(value, separators=(", ", ": ") if states is None else (",", ":"), allow_nan=False)
    missing = sum("forward_dynamics" not in state for state in states or [])
    if missing:
        print(f"{path.name}: {missing} states without forward_dynamics, since M is singular there")
    lines = [f"{json.dumps(key)}: {dump(value)}" for key, value in record.items()]
    if states is not None:
        lines.append('"states": [\n' + ",\n".join(dump(state) for state in states) + "\n]")
    path.write_text("{\n" + ",\n".join(lines) + "\n}\n")
    check, error = max(worst.seen.items(), key=lambda item: item[1] * (not item[0].startswith("differences")))
    print(f"{path.name}: {path.stat().st_size / 1024:.0f} kB; worst check {error:.1e} ({check})")


def committed():
    for name in own_models():
        write(HERE / f"pinocchio_{Path(name).name}.json", pinocchio_record(name, 5, absolute=False))
    for name in ("models/ur5", "models/panda", "oracles/test_tree"):
        write(HERE / f"mujoco_{Path(name).name}.json", mujoco_record(name, 5))
    write(HERE / "modern_robotics.json", modern_robotics_record())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robots", nargs="*", help="a name of --list, or a path inside the package")
    parser.add_argument("--all", action="store_true", help="every URDF of the package that loads")
    parser.add_argument("--states", type=int, default=100, help="random states a robot (100)")
    parser.add_argument("--out", type=Path, help="folder to write to")
    parser.add_argument("--committed", action="store_true", help="write the small files beside this script")
    parser.add_argument("--list", action="store_true", help="print the names and files, and stop")
    options = parser.parse_args()
    if options.list:
        for name in [*ROBOTS, *own_models()]:
            print(f"{name:28} {find_urdf(name)[1]}")
        return
    if options.committed:
        return committed()
    if options.out is None:
        parser.error("--out DIR or --committed is needed")
    options.out.mkdir(parents=True, exist_ok=True)
    names = options.robots or [*ROBOTS, *own_models()]
    if options.all:
        root = package_root()
        names = sorted(str(path.relative_to(root).with_suffix("")) for path in root.glob("**/*.urdf"))
    for name in names:
        try:
            made = pinocchio_record(name, options.states, absolute=True)
        except Failure as failure:
            if not options.all:
                raise Failure(f"{name}: {failure}")
            print(f"skipped {name}: {failure}")
            continue
        write(options.out / f"pinocchio_{name.replace('/', '_')}.json", made)


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(f"error: {failure}")
