#!/usr/bin/env python3
"""Reference numbers for models in MJCF, from MuJoCo, in the layout of make.py.

    python oracles/make_mjcf.py --out DIR       every tree of gymnasium and dm_control, 100 states each
    python oracles/make_mjcf.py --committed     the models beside this script, 5 states each

Actuators, contacts, limits, springs, damping and friction are switched off; armature stays. Joints that an equality
couples are projected, as make.py does with mimic joints. A free body's state is written in mozzi's coordinates: the
quaternion (w, x, y, z) and the origin, the twist (w, v) in the body's axes. With --out, `list.txt` says of every model that was found
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


def load(path):
    """The model, without what mozzi leaves out of M and h."""
    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        raise Failure(f"MuJoCo does not load it: {' '.join(str(error).split())[:120]}")
    kinds = {mujoco.mjtJoint(kind).name for kind in model.jnt_type}
    if not kinds:
        raise Failure("nothing moves")
    if "mjJNT_BALL" in kinds:
        raise Failure("has a ball joint")
    if "mjJNT_FREE" in kinds:
        one_free_tree(model)
    flags = mujoco.mjtDisableBit
    model.opt.disableflags |= int(flags.mjDSBL_CONSTRAINT) | int(flags.mjDSBL_ACTUATION)
    model.opt.disableflags |= int(flags.mjDSBL_SPRING) | int(flags.mjDSBL_DAMPER)
    model.opt.density = model.opt.viscosity = 0.0
    model.body_gravcomp[:] = 0.0
    return model


def one_free_tree(model):
    """A free body, on which everything hangs that moves."""
    if np.count_nonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE) > 1:
        raise Failure("has several free bodies")
    body = base(model)
    if any(model.body_rootid[b] != body for b in model.jnt_bodyid):
        raise Failure("moves beside its free body")
    if np.any(model.dof_armature[:6]):
        raise Failure("has an armature on its free joint")


def base(model):
    """The free body, or none. Its joint is the first, since no other joint is in another tree."""
    free = np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)
    return model.jnt_bodyid[free[0]] if len(free) else None


def velocities(R, V, joints):
    """MuJoCo's qvel = Y (w, v, dtheta) of a free body, whose linear velocity is in the world's axes, and Y's rate times that."""
    n, m = joints.shape
    Y, rate = np.zeros((6 + n, 6 + m)), np.zeros(6 + n)
    Y[:3, 3:6], Y[3:6, :3], Y[6:, 6:] = R, np.eye(3), joints
    rate[:3] = R @ np.cross(V[:3], V[3:6])
    return Y, rate


def coupling(model):
    """The independent joints, and G and offset of qpos = G theta + offset; without the free one."""
    rows, first = {}, int(base(model) is not None)
    qpos0 = np.array([model.qpos0[model.jnt_qposadr[j]] for j in range(model.njnt)])
    for i in range(model.neq):
        if model.eq_type[i] != mujoco.mjtEq.mjEQ_JOINT or not model.eq_active0[i]:
            continue
        y, x, data = model.eq_obj1id[i], model.eq_obj2id[i], model.eq_data[i]
        if x < 0 or np.any(data[2:5]):
            raise Failure("has an equality that is not a straight line")
        rows[y] = (x, data[1], qpos0[y] + data[0] - data[1] * qpos0[x])
    free = [j for j in range(first, model.njnt) if j not in rows]
    G, offset = np.zeros((model.njnt - first, len(free))), np.zeros(model.njnt - first)
    for j in range(first, model.njnt):
        at, ratio, shift = j, 1.0, 0.0
        while at in rows:
            at, step, more = rows[at]
            shift, ratio = shift + ratio * more, ratio * step
        G[j - first, free.index(at)], offset[j - first] = ratio, shift
    return free, G, offset


def record(name, path, shown, states):
    model = load(path)
    data = mujoco.MjData(model)
    free, G, offset = coupling(model)
    nv, body = model.nv, base(model)
    inside = [i for i in range(model.nbody) if body is None or model.body_rootid[i] == body]
    tip = inside[-1]
    names = [model.joint(j).name or f"joint{j}" for j in free]
    slides = model.jnt_type[free] == mujoco.mjtJoint.mjJNT_SLIDE
    bodies = {i: model.body(i).name or f"body{i}" for i in inside}
    rng, worst, records = rng_of(f"mjcf {name}"), Worst(), []
    for _ in range(states):
        n = len(free)
        theta = np.where(slides, rng.uniform(-0.5, 0.5, n), rng.uniform(-np.pi, np.pi, n))
        if body is not None:
            quaternion = rng.standard_normal(4)
            theta = np.concatenate([quaternion / np.linalg.norm(quaternion), rng.uniform(-1.0, 1.0, 3), theta])
            n += 6
        dtheta, ddtheta, tau = rng.standard_normal((3, n)) * np.array([[1.0], [2.0], [2.0]])
        r = {"theta": theta, "dtheta": dtheta, "ddtheta": ddtheta, "tau": tau}
        if body is None:
            Y, rate = G, np.zeros(nv)
            data.qpos[:] = G @ theta + offset
        else:
            R = np.zeros(9)
            mujoco.mju_quat2Mat(R, theta[:4])
            Y, rate = velocities(R.reshape(3, 3), dtheta[:6], G)
            data.qpos[:] = np.concatenate([theta[4:7], theta[:4], G @ theta[7:] + offset])
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
        "qpos0": np.linalg.pinv(G) @ (model.qpos0[model.nq - len(offset):] - offset), "states": records,
    }
    if body is not None:
        made["floating"] = True
    return made, worst


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--states", type=int, default=100, help="random states a model (100)")
    parser.add_argument("--out", type=Path, help="folder to write to")
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
    for name, path in packaged():
        verdict = "compared"
        try:
            write(options.out / f"mjcf_{name}.json", record(name, path, str(path), options.states))
        except Failure as failure:
            verdict = str(failure)
        lines.append(f"{path}\t{verdict}")
    (options.out / "list.txt").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
