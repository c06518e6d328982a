"""Every program of the comparison on the logs at hand: figaroh, MuJoCo's sysid and mozzi, with the same filter and split.

    pip install figaroh "mujoco[sysid]" scipy example-robot-data
    python all.py MOZZI LOGS [--robots FOLDER] [--sysid]

MOZZI is the program, LOGS the folder of panda.csv and ur10.csv. Printed are root mean square errors of torques by joint,
N m, on the last 30 % after a fit to the first 70 %. A program that is not installed is named and left out.
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
CASES = [
    ("Panda", "panda.csv", "panda_description/urdf/panda.urdf", "4", ["panda_finger_joint1", "panda_finger_joint2"], "fer_joint"),
    ("UR10", "ur10.csv", "ur_description/urdf/ur10_robot.urdf", "10", [], None),
]


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("mozzi")
    parser.add_argument("logs", type=Path)
    parser.add_argument("--robots", default=os.environ.get("MOZZI_ROBOTS", ""), help="folder of example-robot-data")
    parser.add_argument("--sysid", action="store_true", help="also MuJoCo's sysid, which takes minutes")
    given = parser.parse_args()
    for name, log, urdf, cutoff, locks, prefix in CASES:
        robot, log = str(Path(given.robots) / urdf), str(given.logs / log)
        print(f"\n{name}", flush=True)
        for torque in ("motor", "link"):
            fixed = [f"--lock={lock}=0" for lock in locks[:1]]
            if prefix:  # the log's names of the robot's joints
                fixed += ["--order", ",".join(f"{prefix}{k}" for k in range(1, 8))]
            options = [robot, log, "--fit", "70", "--cutoff", cutoff, "--torque", torque, "--json", *fixed]
            done = subprocess.run([given.mozzi, "identify", *options], capture_output=True, text=True)
            if done.returncode:
                sys.exit(done.stderr)
            errors = json.loads(done.stdout)["held_out"]
            for kind in ("least_squares", "consistent", "written"):
                print(f"{'mozzi ' + torque + ', ' + kind:34}", " ".join(f"{e:7.4f}" for e in errors[kind]), flush=True)
        lock = [word for joint in locks for word in ("--lock", joint)]
        scripts = [["figaroh_fit.py"], ["figaroh_fit.py", "--armature", "--tanh"]]
        scripts += [["mujoco_sysid.py", "--stride", "3"]] if given.sysid else []
        for script, *more in scripts:
            print(f"{script} {' '.join(more)}", flush=True)
            call = [sys.executable, str(HERE / script), robot, log, cutoff, *lock, *more]
            done = subprocess.run(call, capture_output=True, text=True)
            print(done.stdout if done.returncode == 0 else f"  failed: {done.stderr.strip().splitlines()[-1]}", flush=True)


main()
