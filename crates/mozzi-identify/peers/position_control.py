"""A position-controlled arm of our own: simulated in MuJoCo, identified by mozzi, and simulated again as identified.

    pip install mujoco
    python position_control.py MOZZI [--seconds 20]

The arm that is simulated has other masses than its file, rotors, friction, PD gains and a delay. Printed are the errors of
the gains and of the delay, and the errors of torques on another motion: those that mozzi expects, and those of MuJoCo's
inverse dynamics of the MJCF that `--out` wrote. Exits with 1 if gains or delay are off by 5 %, or if MuJoCo's errors are
above mozzi's by 1 % of the torques.
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import mujoco
import numpy as np

JOINTS = ["shoulder", "elbow", "wrist"]
KP, KD, DELAY = np.array([400.0, 250.0, 80.0]), np.array([30.0, 16.0, 4.0]), 0.014
ARMATURE, DAMPING, FRICTION = [0.6, 0.3, 0.08], [2.0, 1.0, 0.3], [1.5, 0.8, 0.2]
MASSES = [6.0, 3.5, 1.2]
STEP, EVERY = 0.0005, 4


def mjcf(masses, armature, damping, friction) -> str:
    """The arm as XML; three links of a shape whose mass varies."""
    text, end = "", ""
    for k, (joint, length) in enumerate(zip(JOINTS, [0.45, 0.4, 0.2])):
        m = masses[k]
        moments = " ".join(str(m * x) for x in (length**2 / 10, length**2 / 11, 0.004))
        axis = ["0 0 1", "0 1 0", "0 1 0"][k]
        place = ["0 0 0.3", "0.05 0 0.1", "0.4 0 0"][k]
        text += (
            f'<body name="link{k}" pos="{place}"><joint name="{joint}" axis="{axis}" armature="{armature[k]}"'
            f' damping="{damping[k]}" frictionloss="{friction[k]}"/>'
            f'<inertial mass="{m}" pos="{length / 2} 0.01 0.02" diaginertia="{moments}"/>'
        )
        end += "</body>"
    option = f'<option timestep="{STEP}" integrator="implicitfast"/>'
    return f'<mujoco model="arm">{option}<worldbody>{text}{end}</worldbody></mujoco>\n'


def motion(seed: int):
    """Target positions: sines with a corner now and then."""
    random = np.random.default_rng(seed)
    a, w, p = random.uniform(0.15, 0.5, (4, 3)), random.uniform(0.8, 5.0, (4, 3)), random.uniform(0, 6, (4, 3))
    return lambda t: np.sum(a * np.sin(w * t + p) / np.arange(1, 5)[:, None], axis=0)


def simulate(model, target, seconds: float):
    """t, θ, θ̇, θ̈, torques of the motors, targets; every few steps."""
    data, rows = mujoco.MjData(model), []
    data.qpos[:] = target(0.0)
    for k in range(int(seconds / STEP)):
        t = k * STEP
        data.qfrc_applied[:] = KP * (target(t - DELAY) - data.qpos) - KD * data.qvel
        if k % EVERY == 0:
            before = [t, *data.qpos, *data.qvel, *data.qfrc_applied, *target(t)]
        mujoco.mj_step(model, data)
        if k % EVERY == 0:
            rows.append([*before, *data.qacc])
    return np.array(rows)


def write(file: Path, rows) -> None:
    """A driver's log: the time, measured and target positions, velocities, torques with noise."""
    random = np.random.default_rng(1)
    head = ["time"] + [f"{what}_{joint}" for what in ("q", "qd", "tau", "target_q") for joint in JOINTS]
    noise = np.concatenate([[0], np.full(3, 2e-5), np.full(3, 1e-3), np.full(3, 0.05), np.zeros(3)])
    table = rows[:, :13] + noise * random.standard_normal((len(rows), 13))
    np.savetxt(file, table, delimiter=",", header=",".join(head), comments="", fmt="%.7g")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("mozzi")
    parser.add_argument("--seconds", type=float, default=20.0)
    given = parser.parse_args()
    true = mujoco.MjModel.from_xml_string(mjcf(MASSES, ARMATURE, DAMPING, FRICTION))
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        (here / "arm.xml").write_text(mjcf([4.0, 5.0, 1.0], [0.1] * 3, [0.1] * 3, [0.0] * 3))
        write(here / "log.csv", simulate(true, motion(1), given.seconds))
        unseen = simulate(true, motion(2), given.seconds / 2)
        write(here / "unseen.csv", unseen)
        names = ["arm.xml", "log.csv", "--validate", "unseen.csv", "--out", "identified.xml"]
        call = lambda *more: subprocess.run(
            [given.mozzi, "identify", *names, *more], cwd=here, capture_output=True, text=True, check=True
        ).stdout
        found, words = json.loads(call("--json")), call("--write", "mjcf")
        identified = mujoco.MjModel.from_xml_string((here / "identified.xml").read_text())
    # what --write printed, in the arm
    actuators = re.search(r"<actuator>.*</actuator>", words, re.S).group(0)
    whole = mjcf(MASSES, ARMATURE, DAMPING, FRICTION).replace("</mujoco>", actuators + "</mujoco>")
    controlled = mujoco.MjModel.from_xml_string(whole)
    kp, kd = controlled.actuator_gainprm[:, 0], -controlled.actuator_biasprm[:, 2]
    delay = found["servos"][0]["delay"]
    print("kp", kp, "kd", kd, f"delay {delay:.5f} s")
    worst = max(np.max(np.abs(kp / KP - 1)), np.max(np.abs(kd / KD - 1)), abs(delay / DELAY - 1))
    print(f"largest error of a gain or the delay: {100 * worst:.2f} %")
    data, torques = mujoco.MjData(identified), []
    friction = identified.dof_frictionloss
    for row in unseen:
        data.qpos[:], data.qvel[:], data.qacc[:] = row[1:4], row[4:7], row[13:16]
        mujoco.mj_inverse(identified, data)
        torques.append(data.qfrc_inverse.copy())
    measured = unseen[:, 7:10]
    error = np.sqrt(np.mean((np.array(torques) - measured) ** 2, axis=0)) / np.sqrt(np.mean(measured**2, axis=0))
    of_mujoco, of_mozzi = np.sqrt(np.mean(error**2)), found["validations"][0]["errors"]["nrms"]
    print(f"unseen torques: mozzi expects {100 * of_mozzi:.2f} %, MuJoCo with the written MJCF {100 * of_mujoco:.2f} %")
    joints = {name: identified.joint(name) for name in JOINTS}
    print("armature", [round(float(joints[name].armature[0]), 3) for name in JOINTS], "of", ARMATURE)
    print("friction", [round(float(x), 3) for x in friction], "of", FRICTION)
    sys.exit(int(worst > 0.05 or of_mujoco > of_mozzi + 0.01))


main()
