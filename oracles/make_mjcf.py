#!/usr/bin/env python3
"""Reference numbers for models in MJCF, from MuJoCo, in the layout of make.py.

    python oracles/make_mjcf.py --out DIR       every hinge and slide model of gymnasium and dm_control, 100 states each
    python oracles/make_mjcf.py --committed     the models beside this script, 5 states each

Actuators, contacts, limits, springs, damping and friction are switched off; armature stays. Joints that an equality
couples are projected, as make.py does with mimic joints. With --out, `list.txt` says of every model that was found
whether it is compared, and why not.
"""

import argparse
import importlib.metadata as metadata
import importlib.util
from pathlib import Path

import mujoco
import numpy as np

from make import Failure, Worst, plain, regular, rng_of, write

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
    for kind in ("mjJNT_FREE", "mjJNT_BALL"):
        if kind in kinds:
            raise Failure(f"has a {kind[6:].lower()} joint")
    flags = mujoco.mjtDisableBit
    model.opt.disableflags |= int(flags.mjDSBL_CONSTRAINT) | int(flags.mjDSBL_ACTUATION)
    model.opt.disableflags |= int(flags.mjDSBL_SPRING) | int(flags.mjDSBL_DAMPER)
    model.opt.density = model.opt.viscosity = 0.0
    model.body_gravcomp[:] = 0.0
    return model


def coupling(model):
    """The independent joints, and G and offset of qpos = G theta + offset."""
    rows = {}
    for i in range(model.neq):
        if model.eq_type[i] != mujoco.mjtEq.mjEQ_JOINT or not model.eq_active0[i]:
            continue
        y, x, data = model.eq_obj1id[i], model.eq_obj2id[i], model.eq_data[i]
        if x < 0 or np.any(data[2:5]):
            raise Failure("has an equality that is not a straight line")
        rows[y] = (x, data[1], model.qpos0[y] + data[0] - data[1] * model.qpos0[x])
    free = [j for j in range(model.njnt) if j not in rows]
    G, offset = np.zeros((model.njnt, len(free))), np.zeros(model.njnt)
    for j in range(model.njnt):
        at, ratio, shift = j, 1.0, 0.0
        while at in rows:
            at, step, more = rows[at]
            shift, ratio = shift + ratio * more, ratio * step
        G[j, free.index(at)], offset[j] = ratio, shift
    return free, G, offset


def record(name, path, shown, states):
    model = load(path)
    data = mujoco.MjData(model)
    free, G, offset = coupling(model)
    nv, tip = model.nv, model.nbody - 1
    names = [model.joint(j).name or f"joint{j}" for j in free]
    slides = model.jnt_type[free] == mujoco.mjtJoint.mjJNT_SLIDE
    bodies = [model.body(i).name or f"body{i}" for i in range(model.nbody)]
    rng, worst, records = rng_of(f"mjcf {name}"), Worst(), []
    for _ in range(states):
        n = len(free)
        theta = np.where(slides, rng.uniform(-0.5, 0.5, n), rng.uniform(-np.pi, np.pi, n))
        dtheta, ddtheta, tau = rng.standard_normal((3, n)) * np.array([[1.0], [2.0], [2.0]])
        r = {"theta": theta, "dtheta": dtheta, "ddtheta": ddtheta, "tau": tau}
        data.qpos[:], data.qvel[:] = G @ theta + offset, G @ dtheta
        mujoco.mj_forward(model, data)
        M = np.zeros((nv, nv))
        mujoco.mj_fullM(model, data, M)
        r["mass_matrix"], r["bias_forces"] = G.T @ M @ G, G.T @ data.qfrc_bias
        R, p = data.xmat[tip].reshape(3, 3).copy(), data.xpos[tip].copy()
        linear, angular = np.zeros((3, nv)), np.zeros((3, nv))
        mujoco.mj_jacBody(model, data, linear, angular, tip)
        r["pose"] = np.block([[R, p[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]])
        r["poses"] = {
            body: np.block([[data.xmat[i].reshape(3, 3), data.xpos[i][:, None]], [np.zeros((1, 3)), np.ones((1, 1))]])
            for i, body in enumerate(bodies)
        }
        r["space_jacobian"] = np.vstack([angular, linear + np.cross(p, angular, axisb=0, axisc=0)]) @ G
        r["body_jacobian"] = np.vstack([R.T @ angular, R.T @ linear]) @ G
        r["kinetic_energy"] = float(0.5 * data.qvel @ M @ data.qvel)
        data.qacc[:] = G @ ddtheta
        mujoco.mj_inverse(model, data)
        r["inverse_dynamics"] = G.T @ data.qfrc_inverse
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
        "qpos0": np.linalg.pinv(G) @ (model.qpos0 - offset), "states": records,
    }
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
