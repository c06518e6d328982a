"""The same log in MuJoCo's sysid (PyPI): rollouts of 0.3 s, driven by the measured torques.

    pip install "mujoco[sysid]" scipy
    python mujoco_sysid.py ROBOT.urdf LOG.csv CUTOFF_HZ [--lock JOINT]... [--iterations 20] [--stride 1]

Mass and centre of mass of each body, damping, dry friction and armature of each joint are fitted to the first 70 % of
the log; printed are the root mean square errors of the torques of the last 30 %, by inverse dynamics.
"""

import argparse
import re
import time

import mujoco
import numpy as np
from filtered_log import filtered
from mujoco import sysid


# sysid.InertiaType.Pseudo fails in MuJoCo 4.0.0 ("mass and inertia of moving bodies must be larger than mjMINVAL"),
# also for one body with an <inertial>; moments are scaled with the mass instead
KIND = sysid.InertiaType.MassIpos


def robot(urdf: str, locked: list[str]) -> mujoco.MjSpec:
    """The URDF without shapes, with a motor and sensors on each joint."""
    text = open(urdf, encoding="utf-8").read()
    text = re.sub(r"<!--.*?-->|<(visual|collision)\b.*?</\1>", "", text, flags=re.S)
    for name in locked:
        text = re.sub(rf'(<joint name="{name}" type=)"\w+"', r'\1"fixed"', text)
        text = re.sub(rf'<mimic joint="{name}"[^>]*/>', "", text)
    compiler = '<mujoco><compiler balanceinertia="true" boundmass="1e-6"/></mujoco>'
    text = re.sub(r"(<robot\b[^>]*>)", rf"\1{compiler}", text, count=1)
    spec = mujoco.MjSpec.from_string(text)
    spec.option.timestep = 0.002
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    for joint in spec.joints:
        joint.limited = mujoco.mjtLimited.mjLIMITED_FALSE
        actuator = spec.add_actuator(name=f"motor_{joint.name}", target=joint.name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        actuator.set_to_motor()
    for kind, name in [(mujoco.mjtSensor.mjSENS_JOINTPOS, "pos"), (mujoco.mjtSensor.mjSENS_JOINTVEL, "vel")]:
        for joint in spec.joints:
            of_joint = mujoco.mjtObj.mjOBJ_JOINT
            spec.add_sensor(name=f"{joint.name}_{name}", type=kind, objname=joint.name, objtype=of_joint)
    spec.compile()
    # as MJCF, in which each body has its inertia
    return mujoco.MjSpec.from_string(spec.to_xml())


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("urdf")
    parser.add_argument("log")
    parser.add_argument("cutoff", type=float)
    parser.add_argument("--lock", action="append", default=[])
    parser.add_argument("--iterations", type=int, default=20)
    parser.add_argument("--stride", type=int, default=1, help="use every n-th window")
    given = parser.parse_args()
    spec = robot(given.urdf, given.lock)
    model = spec.compile()
    t, q, dq, ddq, tau = filtered(given.log, given.cutoff)
    split, step = int(0.7 * len(t)), t[1] - t[0]
    joints = [joint.name for joint in spec.joints]

    params = sysid.ParameterDict()
    for k in range(1, model.nbody):
        name = model.body(k).name
        if model.body_mass[k] > 1e-3:
            params.add(sysid.body_inertia_param(spec, model, name, KIND, scale_rot_inertia=True))
    for name in joints:
        for attribute, most in [("damping", 20.0), ("frictionloss", 20.0), ("armature", 5.0)]:
            def modifier(spec, p, name=name, attribute=attribute):
                value = float(p.value[0])
                setattr(spec.joint(name), attribute, [value, 0.0, 0.0] if attribute == "damping" else value)
            params.add(sysid.Parameter(f"{name}_{attribute}", 0.1, 0.0, most, modifier=modifier))

    count = max(2, int(round(0.3 / step)))
    windows = range(0, split - count, given.stride * count)
    states, controls, sensors, names = [], [], [], []
    for first in windows:
        part = slice(first, first + count + 1)
        times = t[part] - t[first]
        fine = np.arange(0, times[-1] + 1e-9, model.opt.timestep)
        fine_tau = np.column_stack([np.interp(fine, times, x) for x in tau[part].T])
        measured = np.column_stack([np.interp(fine, times, x) for x in np.hstack([q[part], dq[part]]).T])
        states.append(sysid.create_initial_state(model, q[first], dq[first], np.zeros(0)))
        controls.append(sysid.TimeSeries(fine, fine_tau))
        sensors.append(sysid.TimeSeries.from_names(fine[1:], measured[1:], model))
        names.append(f"window{first}")
    sequences = sysid.ModelSequences("robot", spec, names, states, controls, sensors)
    residual = sysid.build_residual_fn(models_sequences=[sequences])

    def errors(params):
        fitted = sysid.apply_param_modifiers(params, spec) if params is not None else model
        damping, friction = fitted.dof_damping.copy(), fitted.dof_frictionloss.copy()
        fitted.dof_damping[:], fitted.dof_frictionloss[:] = 0.0, 0.0
        data, residuals = mujoco.MjData(fitted), []
        for k in range(split, len(t)):
            data.qpos[:], data.qvel[:], data.qacc[:] = q[k], dq[k], ddq[k]
            mujoco.mj_inverse(fitted, data)
            force = data.qfrc_inverse + damping * dq[k] + friction * np.tanh(dq[k] / 0.05)
            residuals.append(force - tau[k])
        return np.sqrt(np.mean(np.square(residuals), axis=0))

    show = lambda label, x: print(f"{label:28}", " ".join(f"{e:7.4f}" for e in errors(x)), flush=True)
    print(f"{len(t)} samples, {len(names)} windows, {params.size} parameters", flush=True)
    show("the robot's file", None)
    start = time.perf_counter()
    fitted, _ = sysid.optimize(params, residual, max_iters=given.iterations, verbose=False)
    show("sysid", fitted)
    print(f"{'':28} {time.perf_counter() - start:.1f} s")


main()
