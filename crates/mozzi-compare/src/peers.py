"""What Pinocchio or MuJoCo make of a robot: a question as JSON on standard input, the answer on standard output.

Everything is told as the library has it; comparing and explaining is left to who asks. Six-vectors are angular first.
"""

import sys

sys.path = [folder for folder in sys.path if folder]  # no file of the working folder is taken for a library

import importlib.metadata
import json
import os
import xml.etree.ElementTree as ElementTree

out = os.fdopen(os.dup(1), "w", encoding="utf-8")
os.dup2(2, 1)  # what the libraries print goes to standard error


class Refused(Exception):
    """The library does not load the file."""


def one_line(error):
    return " ".join(str(error).split()) or type(error).__name__


def attempt(load):
    try:
        return load()
    except Exception as error:
        raise Refused(one_line(error))


def numbers(vector):
    flat = vector.ravel() if hasattr(vector, "ravel") else vector  # a column, or of one number a scalar
    return [float(x) if abs(x) < float("inf") else None for x in flat]  # JSON has no word for NaN


def rows(matrix):
    return [numbers(row) for row in matrix]


def rename(joints, known):
    """The asker's names: by name, else by the same axis, else, of balls and free joints, by a like name or as the only one; else their own."""
    names = {joint["name"] for joint in joints}
    missing = [joint for joint in known if joint["name"] not in names]
    wanted = {joint["name"] for joint in known}
    for joint in joints:
        joint["called"] = joint["name"]
        if joint["name"] in wanted:
            continue
        candidates = [candidate for candidate in missing if candidate["nv"] == joint["nv"]]
        if joint["nv"] == 1:
            far = lambda candidate: max(abs(a - b) for a, b in zip(candidate["axis"], joint["axes"][0]))
            candidates = [candidate for candidate in candidates if far(candidate) < 1e-9]
        else:
            like = [candidate for candidate in candidates if candidate["name"].replace(":", "_") == joint["name"]]
            candidates = like or candidates * (len(candidates) == 1)
        if candidates:
            joint["name"] = candidates[0]["name"]
            missing.remove(candidates[0])


# Pinocchio -----------------------------------------------------------------------------------------------------------


def pinocchio_model(pin, question):
    path, text = question["path"], question["text"]
    if question["language"] == "mjcf":
        if not hasattr(pin, "buildModelFromMJCF"):
            raise Refused("this version reads no MJCF")
        model = attempt(lambda: pin.buildModelFromMJCF(path))
        return model[0] if isinstance(model, tuple) else model
    options = {"mimic": True} if question["mimic"] else {}
    if path is None:
        return attempt(lambda: pin.buildModelFromXML(text, **options))
    return attempt(lambda: pin.buildModelFromUrdf(path, **options))


class Pinocchio:
    """The model, its joints flat: one made of several is several."""

    def __init__(self, pin, np, question):
        self.pin, self.np = pin, np
        self.model = pinocchio_model(pin, question)
        self.data = self.model.createData()
        order = [joint["name"] for joint in question["joints"]]
        self.parts = []  # of each moving joint of the model: names, positions, velocities
        for i in range(1, self.model.njoints):
            joint, name = self.model.joints[i], self.model.names[i]
            inner = getattr(joint.extract(), "joints", None) if hasattr(joint, "extract") else None
            if inner is None or joint.shortname() != "JointModelComposite":
                self.parts.append((i, [(name, self.model.nqs[i], self.model.nvs[i])]))
                continue
            first = name.removeprefix("Composite_")
            start = order.index(first) if first in order else None
            names = [first] + [f"{name}_{k}" for k in range(1, len(inner))]
            if start is not None:
                names = (order[start:start + len(inner)] + names)[:len(inner)]
            self.parts.append((i, [(n, part.nq, part.nv) for n, part in zip(names, inner)]))

    def configuration(self, angles):
        q = self.pin.neutral(self.model)
        for i, parts in self.parts:
            at = self.model.idx_qs[i]
            for name, nq, nv in parts:
                own = angles.get(name, [0.0])
                if nv == 1 and nq == 2:
                    q[at], q[at + 1] = self.np.cos(own[0]), self.np.sin(own[0])
                elif len(own) == nq:
                    q[at:at + nq] = own
                at += nq
        return q

    def velocity(self, rates):
        v = self.np.zeros(self.model.nv)
        for i, parts in self.parts:
            at = self.model.idx_vs[i]
            for name, _, nv in parts:
                own = rates.get(name, [])
                if len(own) == nv:
                    v[at:at + nv] = own
                at += nv
        return v

    def joints(self):
        model, data, pin = self.model, self.data, self.pin
        neutral = self.configuration({})
        J = pin.computeJointJacobians(model, data, neutral).reshape(6, -1)  # of one velocity it is a list
        friction = getattr(model, "upperDryFrictionLimit", getattr(model, "friction", self.np.zeros(model.nv)))
        last, result = {0: None}, []
        for i, parts in self.parts:
            parent, at = last[model.parents[i]], model.idx_vs[i]
            for k, (name, nq, nv) in enumerate(parts):
                body = data.oMi[i].act(model.inertias[i]) if k + 1 == len(parts) else None
                span = slice(at, at + nv)
                result.append({
                    "name": name, "nq": int(nq), "nv": int(nv), "parent": parent,
                    "axes": [numbers([*J[3:, c], *J[:3, c]]) for c in range(at, at + nv)],
                    "mass": float(body.mass) if body else 0.0,
                    "center": numbers(body.lever) if body else [0.0] * 3,
                    "inertia": rows(body.inertia) if body else [[0.0] * 3] * 3,
                    "armature": numbers(model.armature[span]), "damping": numbers(model.damping[span]),
                    "friction": numbers(friction[span]),
                })
                parent, at = len(result) - 1, at + nv
            last[i] = parent
        return result

    def state(self, theta, dtheta, ddtheta):
        pin, model, data = self.pin, self.model, self.data
        q, v, a = self.configuration(theta), self.velocity(dtheta), self.velocity(ddtheta)
        M = self.np.triu(self.np.reshape(pin.crba(model, data, q), (model.nv, model.nv)))
        return {
            "M": rows(M + self.np.triu(M, 1).T),
            "g": numbers(pin.computeGeneralizedGravity(model, data, q)),
            "h": numbers(pin.nonLinearEffects(model, data, q, v)),
            "tau": numbers(pin.rnea(model, data, q, v, a)),
            "parts": {},
        }

    def about(self):
        return {"gravity": numbers(self.model.gravity.linear), "couplings": [], "from_geometry": [], "settings": {}}


# MuJoCo --------------------------------------------------------------------------------------------------------------


def without_geometry(text):
    robot = ElementTree.fromstring(text)
    for link in robot.iter("link"):
        for name in ("visual", "collision"):
            for element in link.findall(name):
                link.remove(element)
    return ElementTree.tostring(robot, encoding="unicode")


def without_fixed_inertia(text):
    """Links that no joint moves do without their inertias, which enter nothing."""
    robot = ElementTree.fromstring(text)
    parents = {}
    for joint in robot.findall("joint"):
        parents[joint.find("child").get("link")] = (joint.find("parent").get("link"), joint.get("type"))
    for link in robot.findall("link"):
        name, seen = link.get("name"), set()
        while name in parents and parents[name][1] == "fixed" and name not in seen:
            seen.add(name)
            name = parents[name][0]
        if name not in parents:
            for element in link.findall("inertial"):
                link.remove(element)
    return ElementTree.tostring(robot, encoding="unicode")


SMALLEST = 1e-9  # kg, kg m2: what massless bodies get, where MuJoCo refuses them


def mujoco_model(mujoco, question, attempts):
    """As it stands; where that is refused, without meshes and with the compiler's remedies, each noted."""
    path, text, is_urdf = question["path"], question["text"], question["language"] == "urdf"
    settings = {}
    while True:
        try:
            spec = mujoco.MjSpec.from_file(path) if text is None else mujoco.MjSpec.from_string(text)
            for name, value in settings.items():
                setattr(spec.compiler, name, value)
            return spec, spec.compile()
        except Exception as error:
            message = one_line(error)
        done = [step["then"] for step in attempts]
        source = lambda: open(path, "rb").read() if text is None else text
        then = None
        if is_urdf and "positive eigenvalues" in message and "fixed" not in done:
            text, then = attempt(lambda: without_fixed_inertia(source())), "fixed"
        elif "A + B" in message and "balance" not in done:
            then, settings["balanceinertia"] = "balance", True
        elif "mjMINVAL" in message and "bound" not in done:
            then, settings["boundmass"], settings["boundinertia"] = "bound", SMALLEST, SMALLEST
        elif is_urdf and "geometry" not in done:
            text, then = attempt(lambda: without_geometry(source())), "geometry"
        if then is None:
            raise Refused(message)
        attempts.append({"message": message, "then": then})


class MuJoCo:
    def __init__(self, mujoco, np, question, attempts):
        self.mujoco, self.np = mujoco, np
        if hasattr(mujoco, "set_mju_user_warning"):
            mujoco.set_mju_user_warning(lambda message: None)  # which would write a file
        self.spec, self.model = mujoco_model(mujoco, question, attempts)
        self.data = mujoco.MjData(self.model)
        free = lambda j: self.model.jnt_type[j] == mujoco.mjtJoint.mjJNT_FREE
        unnamed = lambda j: f"{self.model.body(self.model.jnt_bodyid[j]).name}:free" if free(j) else f"joint{j}"
        self.names = [self.model.joint(j).name or unnamed(j) for j in range(self.model.njnt)]
        self.home = dict(zip(question["names"], question["home"] or []))
        sizes = {mujoco.mjtJoint.mjJNT_FREE: (7, 6), mujoco.mjtJoint.mjJNT_BALL: (4, 3)}
        self.sizes = [sizes.get(mujoco.mjtJoint(kind), (1, 1)) for kind in self.model.jnt_type]

    def set(self, values, addresses, target, width):
        for name, at, size in zip(self.names, addresses, self.sizes):
            if len(values.get(name, [])) == size[width]:
                target[at:at + size[width]] = values[name]
            elif size[width] == 1:
                target[at] = 0.0

    def place(self, theta, dtheta):
        self.data.qpos[:] = self.model.qpos0
        for at, (nq, _) in zip(self.model.jnt_qposadr, self.sizes):
            if nq == 7:
                self.data.qpos[at:at + 7] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
        self.data.qvel[:] = 0.0
        self.set(theta, self.model.jnt_qposadr, self.data.qpos, 0)
        self.set(dtheta, self.model.jnt_dofadr, self.data.qvel, 1)
        self.mujoco.mj_forward(self.model, self.data)

    def axes(self, j):
        """In the world, at the present configuration; of a joint of several velocities, none."""
        axis, anchor = self.data.xaxis[j], self.data.xanchor[j]
        kind = self.mujoco.mjtJoint(self.model.jnt_type[j])
        if kind == self.mujoco.mjtJoint.mjJNT_HINGE:
            return [numbers([*axis, *-self.np.cross(axis, anchor)])]
        if kind == self.mujoco.mjtJoint.mjJNT_SLIDE:
            return [numbers([0.0, 0.0, 0.0, *axis])]
        return [[0.0] * 6] * self.sizes[j][1]

    def bodies(self):
        """Mass, centre and inertia of each moving body with all that is welded to it, in the world."""
        np, model, data, result = self.np, self.model, self.data, {}
        for b in range(1, model.nbody):
            mass, first, second = result.setdefault(int(model.body_weldid[b]), [0.0, np.zeros(3), np.zeros((3, 3))])
            R, c, m = data.ximat[b].reshape(3, 3), data.xipos[b], model.body_mass[b]
            about = R @ np.diag(model.body_inertia[b]) @ R.T + m * (c @ c * np.eye(3) - np.outer(c, c))
            result[int(model.body_weldid[b])] = [mass + m, first + m * c, second + about]
        return result

    def armature(self):
        """Of each velocity: the joint's own, and that of the actuators that move the joint."""
        np, model = self.np, self.model
        result = np.array(model.dof_armature, float).reshape(model.nv, -1)[:, 0]
        kinds = [int(self.mujoco.mjtTrn.mjTRN_JOINT), int(self.mujoco.mjtTrn.mjTRN_JOINTINPARENT)]
        for k, more in enumerate(np.ravel(getattr(model, "actuator_armature", []))):
            if int(model.actuator_trntype[k]) in kinds and more:
                j = int(model.actuator_trnid[k][0])
                first = int(model.jnt_dofadr[j])
                result[first : first + self.sizes[j][1]] += more * model.actuator_gear[k][0] ** 2
        return result

    def joints(self):
        np, model = self.np, self.model
        self.place(self.home, {})
        bodies, result = self.bodies(), []
        last = {}  # of each body, its last joint
        flat = lambda values, span: numbers(np.asarray(values).reshape(model.nv, -1)[span, 0])
        armature = self.armature()
        for j in range(model.njnt):
            body, (nq, nv) = int(model.jnt_bodyid[j]), self.sizes[j]
            up, parent = int(model.body_parentid[body]), last.get(body)
            while parent is None and up > 0:
                parent, up = last.get(up), int(model.body_parentid[up])
            is_last = j + 1 == model.njnt or int(model.jnt_bodyid[j + 1]) != body
            mass, first, second = bodies[body] if is_last else (0.0, np.zeros(3), np.zeros((3, 3)))
            c = first / mass if mass else first
            span = slice(int(model.jnt_dofadr[j]), int(model.jnt_dofadr[j]) + nv)
            result.append({
                "name": self.names[j], "nq": nq, "nv": nv, "parent": parent, "axes": self.axes(j),
                "mass": float(mass), "center": numbers(c),
                "inertia": rows(second - mass * (c @ c * np.eye(3) - np.outer(c, c))),
                "armature": flat(armature, span), "damping": flat(model.dof_damping, span),
                "friction": flat(model.dof_frictionloss, span),
            })
            last[body] = len(result) - 1
        return result

    def mass_matrix(self):
        M = self.np.zeros((self.model.nv, self.model.nv))
        try:
            self.mujoco.mj_fullM(self.model, self.data, M)
        except TypeError:  # before version 4
            self.mujoco.mj_fullM(self.model, M, self.data.qM)
        return M

    def state(self, theta, dtheta, ddtheta):
        data, result = self.data, {}
        self.place(theta, {})
        result["g"] = numbers(data.qfrc_bias)
        self.place(theta, dtheta)
        result["M"], result["h"] = rows(self.mass_matrix()), numbers(data.qfrc_bias)
        data.qacc[:] = 0.0
        self.set(ddtheta, self.model.jnt_dofadr, data.qacc, 1)
        self.mujoco.mj_inverse(self.model, data)
        result["tau"] = numbers(data.qfrc_inverse)
        result["parts"] = {name: numbers(getattr(data, f"qfrc_{name}")) for name in ("spring", "gravcomp", "fluid")}
        counts = {"equalities": data.ne, "dry friction": data.nf, "limits": data.nl, "contacts": data.ncon}
        result["constraints"] = [name for name, count in counts.items() if count]
        if result["constraints"]:
            # computed anew: the forces may be so large that taking them off leaves rounding
            before, off = int(self.model.opt.disableflags), int(self.mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
            self.model.opt.disableflags = before | off
            self.mujoco.mj_inverse(self.model, data)
            result["unconstrained"] = numbers(data.qfrc_inverse)
            self.model.opt.disableflags = before
        return result

    def about(self):
        model, mujoco, couplings = self.model, self.mujoco, []
        for i in range(model.neq):
            if model.eq_type[i] != mujoco.mjtEq.mjEQ_JOINT or model.eq_obj2id[i] < 0:
                continue
            names = [self.names[model.eq_obj1id[i]], self.names[model.eq_obj2id[i]]]
            couplings.append({"joint": names[0], "source": names[1]})
        off = int(model.opt.disableflags) & int(mujoco.mjtDisableBit.mjDSBL_GRAVITY)
        compiler = self.spec.compiler
        return {
            "gravity": [0.0] * 3 if off else numbers(model.opt.gravity),
            "couplings": couplings,
            "from_geometry": [b.name for b in self.spec.bodies if len(b.geoms) and not b.explicitinertial],
            "settings": {
                "balanceinertia": bool(compiler.balanceinertia), "settotalmass": float(compiler.settotalmass),
                "boundmass": float(compiler.boundmass), "boundinertia": float(compiler.boundinertia),
                "inertiafromgeom": str(compiler.inertiafromgeom).rsplit("_", 1)[-1].lower(),
            },
        }


def answer(question):
    name = question["library"]
    distribution, module = {"pinocchio": ("pin", "pinocchio"), "mujoco": ("mujoco", "mujoco")}[name]
    result = {"library": name, "version": None, "error": None, "attempts": []}
    try:
        np, library = __import__("numpy"), __import__(module)
    except Exception as error:
        return {**result, "error": {"stage": "import", "message": one_line(error)}}
    try:
        result["version"] = importlib.metadata.version(distribution)
    except importlib.metadata.PackageNotFoundError:
        result["version"] = getattr(library, "__version__", None)
    try:
        if name == "pinocchio":
            robot = Pinocchio(library, np, question)
        else:
            robot = MuJoCo(library, np, question, result["attempts"])
    except Refused as error:
        return {**result, "error": {"stage": "load", "message": str(error)}}
    try:
        result.update(computed(robot, question))
    except Exception as error:
        # a mistake of this script, or what the library raises
        own = isinstance(error, (IndexError, KeyError, TypeError, AttributeError, NameError))
        message = f"{type(error).__name__}: {one_line(error)}"
        fault = "mozzi" if own else "library"
        return {**result, "error": {"stage": "compute", "message": message, "fault": fault}}
    return result


def computed(robot, question):
    joints = [joint for joint in robot.joints() if joint["nv"] > 0]
    base = joints[:1] if question["floating"] and joints and joints[0]["nv"] == 6 else []
    for joint in base:
        joint.update(base=True, called=joint["name"])
    rename(joints[len(base):], question["joints"])
    theirs = {joint["name"]: joint["called"] for joint in joints}
    result = {**robot.about(), "joints": joints, "states": []}
    for state in question["states"]:
        values = [
            {theirs[name]: x for name, x in zip(question["names"], state[key]) if name in theirs}
            for key in ("theta", "dtheta", "ddtheta")
        ]
        result["states"].append(robot.state(*values))
    return result


out.write(json.dumps(answer(json.load(sys.stdin))))
out.flush()
