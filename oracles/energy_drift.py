"""The drift of energy of a double pendulum that nothing drives: mozzi's integrators beside Pinocchio with hand-written ones, MuJoCo's and Drake's.

    cargo build --release -p mozzi-cli
    pip install drake  # 100 MB, beside oracles/requirements.txt; without it its rows are left out
    python oracles/energy_drift.py [--mozzi target/release/mozzi] [--time 10]

crates/mozzi-urdf/models/double_pendulum.urdf, let go at (2, 1) rad; the largest |E(t) - E(0)| over the steps, in joules (of mozzi's Dormand-Prince over rows of 10 ms).
"""

import argparse
import importlib.util
import json
import pathlib
import subprocess

import mujoco
import numpy as np
import pinocchio as pin

ROOT = pathlib.Path(__file__).resolve().parent.parent
MODEL = ROOT / "crates/mozzi-urdf/models" / "double_pendulum.urdf"
START = [2.0, 1.0]
# "discrete" is MultibodyPlant's own step; the others are integrators of its continuous equations
DRAKE = ("discrete", "explicit_euler", "semi_explicit_euler", "implicit_euler", "runge_kutta3", "radau3")
ADAPTIVE = ("runge_kutta3", "runge_kutta5")


def by_mozzi(program, method, step, time):
    flags = ["--theta", ",".join(map(str, START)), "--time", str(time), "--method", method]
    flags += ["--tolerance", str(step), "--step", "0.01"] if method == "dopri" else ["--step", str(step)]
    ended = subprocess.run([program, "simulate", "double_pendulum", *flags, "--json"], capture_output=True, check=True, text=True)
    found = json.loads(ended.stdout)
    return found["largest_drift"], found["steps"]


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
    return worst, round(time / step)


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
    return worst, round(time / step)


def by_drake(scheme, step, time, adaptive=False):
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig

    plant = MultibodyPlant(step if scheme == "discrete" else 0.0)
    Parser(plant).AddModels(str(MODEL))
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName("base"))
    plant.Finalize()
    simulator = Simulator(plant)
    if adaptive:
        ApplySimulatorConfig(SimulatorConfig(integration_scheme=scheme, accuracy=step), simulator)
    elif scheme != "discrete":
        ApplySimulatorConfig(SimulatorConfig(integration_scheme=scheme, max_step_size=step, use_error_control=False), simulator)
    context = simulator.get_mutable_context()
    plant.SetPositions(context, START)
    energy = lambda context: plant.CalcKineticEnergy(context) + plant.CalcPotentialEnergy(context)
    energies = [energy(context)]
    simulator.set_monitor(lambda context: energies.append(energy(context)) and None)
    simulator.AdvanceTo(time)
    steps = round(time / step) if scheme == "discrete" else simulator.get_integrator().get_num_steps_taken()
    return max(abs(x - energies[0]) for x in energies), steps


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--mozzi", default=str(ROOT / "target/release/mozzi"))
    parser.add_argument("--time", type=float, default=10.0)
    arguments = parser.parse_args()
    drake = importlib.util.find_spec("pydrake") is not None
    print(f"{'integrator':45} {'step or tolerance':>18} {'largest drift, J':>17} {'steps':>8}")

    def line(name, step, found):
        drift, steps = found
        print(f"{name:45} {step:18.0e} {drift:17.1e} {steps:8}", flush=True)

    for step in (1e-2, 1e-3):
        for method in ("euler", "semi-implicit-euler", "rk4", "midpoint"):
            line(f"mozzi, {method}", step, by_mozzi(arguments.mozzi, method, step, arguments.time))
        for method in ("euler", "semi-implicit-euler", "rk4"):
            line(f"Pinocchio, {method} by hand", step, by_pinocchio(method, step, arguments.time))
        for method in ("EULER", "IMPLICIT", "IMPLICITFAST", "RK4"):
            line(f"MuJoCo, {method.lower()}", step, by_mujoco(method, step, arguments.time))
        for method in DRAKE if drake else ():
            line(f"Drake, {method}", step, by_drake(method, step, arguments.time))
    for tolerance in (1e-6, 1e-9, 1e-12):
        line("mozzi, dopri", tolerance, by_mozzi(arguments.mozzi, "dopri", tolerance, arguments.time))
        for method in ADAPTIVE if drake else ():
            line(f"Drake, {method}", tolerance, by_drake(method, tolerance, arguments.time, adaptive=True))
    if not drake:
        print("Drake's rows are left out: this Python has no pydrake (pip install drake)")


if __name__ == "__main__":
    main()
