#!/usr/bin/env python3
"""Reference numbers for models in MJCF, from MuJoCo, in the layout of make.py.

    python oracles/make_mjcf.py --out DIR       every tree of gymnasium and dm_control, 100 states each
    python oracles/make_mjcf.py --out DIR --models FOLDER   every model below a folder, such as MuJoCo's Menagerie
    python oracles/make_mjcf.py --committed     the models beside this script, 5 states each

Actuators, contacts, limits, springs, damping and friction are switched off; armature stays. Joints that an equality
couples are projected, as make.py does with mimic joints. States are written in mozzi's coordinates (see Coordinates). With --out, `list.txt` says of every model that was found
whether it is compared, and why not.
"""

import argparse
import importlib.metadata as metadata
import importlib.util
from pathlib import Path

import mujoco
import numpy as np

from make import Failure, Worst, plain, regular, rng_of, write

mujoco.set_mju_user_warning(lambda message: None)  # which would write a file

HERE = Path(__file__).resolve().parent
FREE, BALL, SLIDE, HINGE = (int(getattr(mujoco.mjtJoint, f"mjJNT_{kind}")) for kind in ("FREE", "BALL", "SLIDE", "HINGE"))
POSITIONS, VELOCITIES = {FREE: 7, BALL: 4, SLIDE: 1, HINGE: 1}, {FREE: 6, BALL: 3, SLIDE: 1, HINGE: 1}
FOLDERS = {"gymnasium": "envs/mujoco/assets", "dm_control": "."}


def packaged():
    """Name and path of every model of the packages."""
    for package, folder in FOLDERS.items():
        spec = importlib.util.find_spec(package)
        if spec is None:
            raise Failure(f"the package {package} is not installed: pip install {package}")
        root = Path(spec.origin).parent
        for path in sorted((root / folder).glob("**/*.xml")):
            name = path.relative_to(root / folder).with_suffix("")
            yield f"{package}_{str(name).replace('/', '_')}", path


def below(folder):
    """Name and path of every model below a folder."""
    for path in sorted(folder.glob("**/*.xml")):
        yield str(path.relative_to(folder).with_suffix("")).replace("/", "_"), path


def load(path):
    """The model, without what mozzi leaves out of M and h."""
    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        raise Failure(f"MuJoCo does not load it: {' '.join(str(error).split())[:120]}")
    if not model.njnt:
        raise Failure("nothing moves")
    flags = mujoco.mjtDisableBit
    model.opt.disableflags |= int(flags.mjDSBL_CONSTRAINT) | int(flags.mjDSBL_ACTUATION)
    model.opt.disableflags |= int(flags.mjDSBL_SPRING) | int(flags.mjDSBL_DAMPER)
    model.opt.density = model.opt.viscosity = 0.0
    model.body_gravcomp[:] = 0.0
    return model


def base(model):
    """The body that mozzi makes a floating base: free, without damping and armature, and all that moves hangs on it. Else none."""
    free = np.flatnonzero(model.jnt_type == FREE)
    held = model.dof_damping + model.dof_armature
    if len(free) != 1 or np.any(held[model.jnt_dofadr[free[0]]:][:6]):
        return None
    body = model.jnt_bodyid[free[0]]
    return body if all(model.body_rootid[b] == body for b in model.jnt_bodyid) else None


class Coordinates:
    """mozzi's theta and dtheta: of each joint that no equality couples a number, of a ball the quaternion and w, of a free body the quaternion, the origin,
    and the twist (w, v) in the body's axes."""

    def __init__(self, model):
        self.model, rows = model, {}
        qpos0 = [model.qpos0[model.jnt_qposadr[j]] for j in range(model.njnt)]
        for i in range(model.neq):
            if model.eq_type[i] != mujoco.mjtEq.mjEQ_JOINT or not model.eq_active0[i]:
                continue
            y, x, data = model.eq_obj1id[i], model.eq_obj2id[i], model.eq_data[i]
            if x < 0 or np.any(data[2:5]):
                raise Failure("has an equality that is not a straight line")
            rows[y] = (x, data[1], qpos0[y] + data[0] - data[1] * qpos0[x])
        self.joints = [j for j in range(model.njnt) if j not in rows]
        self.q, self.v, self.nq, self.n = {}, {}, 0, 0
        for j in self.joints:
            self.q[j], self.v[j] = self.nq, self.n
            self.nq, self.n = self.nq + POSITIONS[model.jnt_type[j]], self.n + VELOCITIES[model.jnt_type[j]]
        self.followers = []
        for j in rows:
            at, ratio, shift = j, 1.0, 0.0
            while at in rows:
                at, step, more = rows[at]
                shift, ratio = shift + ratio * more, ratio * step
            self.followers.append((j, at, ratio, shift))

    def random(self, rng):
        parts = []
        for j in self.joints:
            kind = self.model.jnt_type[j]
            if kind in (BALL, FREE):
                quaternion = rng.standard_normal(4)
                parts.append(quaternion / np.linalg.norm(quaternion))
            if kind == FREE:
                parts.append(rng.uniform(-1.0, 1.0, 3))
            if kind in (SLIDE, HINGE):
                reach = 0.5 if kind == SLIDE else np.pi
                parts.append(rng.uniform(-reach, reach, 1))
        return np.concatenate(parts)

    def to_mujoco(self, theta, dtheta):
        """qpos, Y of qvel = Y dtheta, and Y's rate times dtheta."""
        model = self.model
        qpos, Y, rate = np.zeros(model.nq), np.zeros((model.nv, self.n)), np.zeros(model.nv)
        for j in self.joints:
            kind, at, dof, q, v = model.jnt_type[j], model.jnt_qposadr[j], model.jnt_dofadr[j], self.q[j], self.v[j]
            if kind == FREE:
                R = np.zeros(9)
                mujoco.mju_quat2Mat(R, theta[q:q + 4])
                R, V = R.reshape(3, 3), dtheta[v:v + 6]
                qpos[at:at + 3], qpos[at + 3:at + 7] = theta[q + 4:q + 7], theta[q:q + 4]
                Y[dof:dof + 3, v + 3:v + 6], Y[dof + 3:dof + 6, v:v + 3] = R, np.eye(3)
                rate[dof:dof + 3] = R @ np.cross(V[:3], V[3:])
            else:
                width, k = POSITIONS[kind], VELOCITIES[kind]
                qpos[at:at + width], Y[dof:dof + k, v:v + k] = theta[q:q + width], np.eye(k)
        for j, source, ratio, shift in self.followers:
            qpos[model.jnt_qposadr[j]] = ratio * theta[self.q[source]] + shift
            Y[model.jnt_dofadr[j], self.v[source]] = ratio
        return qpos, Y, rate


def starts(path, model, data, coordinates, bodies):
    """Poses and body twists (w, v) where MuJoCo starts, and at each key of the file (<size nkey> may add more); joints that an equality
    couples are projected."""
    made = []
    for key in range(-1, len(mujoco.MjSpec.from_file(str(path)).keys)):
        mujoco.mj_resetData(model, data) if key < 0 else mujoco.mj_resetDataKeyframe(model, data, key)
        for j, source, ratio, shift in coordinates.followers:
            data.qpos[model.jnt_qposadr[j]] = ratio * data.qpos[model.jnt_qposadr[source]] + shift
            data.qvel[model.jnt_dofadr[j]] = ratio * data.qvel[model.jnt_dofadr[source]]
        mujoco.mj_forward(model, data)
        poses, twists = {}, {}
        for i, name in bodies.items():
            poses[name] = np.block([[data.xmat[i].reshape(3, 3), data.xpos[i][:, None]], [np.zeros((1, 3)), np.ones((1, 1))]])
            twist = np.zeros(6)
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, i, twist, 1)
            twists[name] = twist
        made.append({"state": None if key < 0 else model.key(key).name or f"key{key}", "time": data.time, "poses": poses, "twists": twists})
    return made


def record(name, path, shown, states):
    model = load(path)
    data = mujoco.MjData(model)
    coordinates = Coordinates(model)
    nv, body = model.nv, base(model)
    inside = [i for i in range(model.nbody) if body is None or model.body_rootid[i] == body]
    tip = inside[-1]
    bodies = {i: model.body(i).name or f"body{i}" for i in inside}
    unnamed = lambda j: f"{bodies[model.jnt_bodyid[j]]}:free" if model.jnt_type[j] == FREE else f"joint{j}"
    names = [model.joint(j).name or unnamed(j) for j in coordinates.joints if body is None or model.jnt_type[j] != FREE]
    rng, worst, records = rng_of(f"mjcf {name}"), Worst(), []
    first = starts(path, model, data, coordinates, bodies)
    for _ in range(states):
        theta = coordinates.random(rng)
        dtheta, ddtheta, tau = rng.standard_normal((3, coordinates.n)) * np.array([[1.0], [2.0], [2.0]])
        r = {"theta": theta, "dtheta": dtheta, "ddtheta": ddtheta, "tau": tau}
        data.qpos[:], Y, rate = coordinates.to_mujoco(theta, dtheta)
        data.qvel[:] = Y @ dtheta
        mujoco.mj_forward(model, data)
        M = np.zeros((nv, nv))
        mujoco.mj_fullM(model, data, M)
        r["mass_matrix"], r["bias_forces"] = Y.T @ M @ Y, Y.T @ (data.qfrc_bias + M @ rate)
        R, p = data.xmat[tip].reshape(3, 3).copy(), data.xpos[tip].copy()
        linear, angular = np.zeros((3, nv)), np.zeros((3, nv))
        mujoco.mj_jacBody(model, data, linear, angular, tip)
        r["pose"] = np.block([[R, p[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]])
        r["poses"] = {
            name_of: np.block([[data.xmat[i].reshape(3, 3), data.xpos[i][:, None]], [np.zeros((1, 3)), np.ones((1, 1))]])
            for i, name_of in bodies.items()
        }
        r["space_jacobian"] = np.vstack([angular, linear + np.cross(p, angular, axisb=0, axisc=0)]) @ Y
        r["body_jacobian"] = np.vstack([R.T @ angular, R.T @ linear]) @ Y
        r["kinetic_energy"] = float(0.5 * data.qvel @ M @ data.qvel)
        data.qacc[:] = Y @ ddtheta + rate
        mujoco.mj_inverse(model, data)
        r["inverse_dynamics"] = Y.T @ data.qfrc_inverse
        if regular(r["mass_matrix"]):
            r["forward_dynamics"] = np.linalg.solve(r["mass_matrix"], tau - r["bias_forces"])
        scale = np.abs(r["mass_matrix"] @ ddtheta).max() + np.abs(r["bias_forces"]).max()
        terms = r["mass_matrix"] @ ddtheta + r["bias_forces"]
        worst.check("M ddtheta + h = inverse dynamics", terms, r["inverse_dynamics"], 1e-10, scale)
        records.append(r)
    made = {
        "robot": name, "mjcf": shown, "library": f"mujoco {metadata.version('mujoco')}",
        "gravity": model.opt.gravity * (not model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_GRAVITY)),
        "tip_frame": bodies[tip], "joint_names": names, "armature": True,
        "starts": first,
        "states": records,
    }
    if body is not None:
        made["floating"] = True
    return made, worst


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--states", type=int, default=100, help="random states a model (100)")
    parser.add_argument("--out", type=Path, help="folder to write to")
    parser.add_argument("--models", type=Path, help="folder of models, instead of the packages'")
    parser.add_argument("--committed", action="store_true", help="write the small files beside this script")
    options = parser.parse_args()
    if options.committed:
        for path in sorted(HERE.glob("*.xml")):
            write(HERE / f"mjcf_{path.stem}.json", record(path.stem, path, f"oracles/{path.name}", 5))
        return
    if options.out is None:
        parser.error("--out DIR or --committed is needed")
    options.out.mkdir(parents=True, exist_ok=True)
    lines = []
    for name, path in below(options.models) if options.models else packaged():
        verdict = "compared"
        try:
            write(options.out / f"mjcf_{name}.json", record(name, path, str(path), options.states))
        except Failure as failure:
            verdict = str(failure)
        lines.append(f"{path}\t{verdict}")
    (options.out / "list.txt").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
