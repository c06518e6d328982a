"""The drift of energy of a double pendulum that nothing drives: mozzi's integrators beside Pinocchio with hand-written ones, and MuJoCo's.

    cargo build --release -p mozzi-cli
    python oracles/energy_drift.py [--mozzi target/release/mozzi] [--time 10]

models/double_pendulum.urdf, let go at (2, 1) rad; the largest |E(t) - E(0)| over the steps, in joules.
"""

import argparse
import json
import pathlib
import subprocess

import mujoco
import numpy as np
import pinocchio as pin

ROOT = pathlib.Path(__file__).resolve().parent.parent
MODEL = ROOT / "models" / "double_pendulum.urdf"
START = [2.0, 1.0]


def by_mozzi(program, method, step, time):
    flags = ["--theta", ",".join(map(str, START)), "--time", str(time), "--method", method]
    flags += ["--tolerance", str(step), "--step", "0.01"] if method == "dopri" else ["--step", str(step)]
    ended = subprocess.run([program, "simulate", "double_pendulum", *flags, "--json"], capture_output=True, check=True, text=True)
    return json.loads(ended.stdout)["largest_drift"]


def by_pinocchio(method, step, time):
    model = pin.buildModelFromUrdf(str(MODEL))
    data = model.createData()
    # positions by their angles: continuous joints are (cos, sin) in Pinocchio
    q, v = pin.integrate(model, pin.neutral(model), np.array(START)), np.zeros(2)
    energy = lambda: pin.computeKineticEnergy(model, data, q, v) + pin.computePotentialEnergy(model, data, q)
    f = lambda q, v: pin.aba(model, data, q, v, np.zeros(2)).copy()
    begin, worst = energy(), 0.0
    for _ in range(round(time / step)):
        if method == "euler":
            a = f(q, v)
            q, v = pin.integrate(model, q, v * step), v + a * step
        elif method == "semi-implicit-euler":
            v = v + f(q, v) * step
            q = pin.integrate(model, q, v * step)
        else:
            k1 = (v, f(q, v))
            k2 = (v + 0.5 * step * k1[1], f(pin.integrate(model, q, 0.5 * step * k1[0]), v + 0.5 * step * k1[1]))
            k3 = (v + 0.5 * step * k2[1], f(pin.integrate(model, q, 0.5 * step * k2[0]), v + 0.5 * step * k2[1]))
            k4 = (v + step * k3[1], f(pin.integrate(model, q, step * k3[0]), v + step * k3[1]))
            mean = [(a + 2 * b + 2 * c + d) / 6 for a, b, c, d in zip(k1, k2, k3, k4)]
            q, v = pin.integrate(model, q, mean[0] * step), v + mean[1] * step
        worst = max(worst, abs(energy() - begin))
    return worst


def by_mujoco(method, step, time):
    # a slender rod has no inertia along itself, which MuJoCo refuses; nothing turns about it
    model = mujoco.MjModel.from_xml_string(MODEL.read_text().replace('izz="0"', 'izz="1e-6"'))
    model.opt.timestep, model.opt.enableflags = step, mujoco.mjtEnableBit.mjENBL_ENERGY
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    model.opt.integrator = getattr(mujoco.mjtIntegrator, "mjINT_" + method)
    data = mujoco.MjData(model)
    data.qpos[:] = START
    mujoco.mj_forward(model, data)
    begin, worst = data.energy.sum(), 0.0
    for _ in range(round(time / step)):
        mujoco.mj_step(model, data)
        mujoco.mj_forward(model, data)
        worst = max(worst, abs(data.energy.sum() - begin))
    return worst


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--mozzi", default=str(ROOT / "target/release/mozzi"))
    parser.add_argument("--time", type=float, default=10.0)
    arguments = parser.parse_args()
    print(f"{'integrator':45} {'step or tolerance':>18} {'largest drift, J':>17}")

    def line(name, step, drift):
        print(f"{name:45} {step:18.0e} {drift:17.1e}", flush=True)

    for step in (1e-2, 1e-3):
        for method in ("euler", "semi-implicit-euler", "rk4", "midpoint"):
            line(f"mozzi, {method}", step, by_mozzi(arguments.mozzi, method, step, arguments.time))
        for method in ("euler", "semi-implicit-euler", "rk4"):
            line(f"Pinocchio, {method} by hand", step, by_pinocchio(method, step, arguments.time))
        for method in ("EULER", "IMPLICIT", "IMPLICITFAST", "RK4"):
            line(f"MuJoCo, {method.lower()}", step, by_mujoco(method, step, arguments.time))
    for tolerance in (1e-6, 1e-9, 1e-12):
        line("mozzi, dopri", tolerance, by_mozzi(arguments.mozzi, "dopri", tolerance, arguments.time))


if __name__ == "__main__":
    main()
