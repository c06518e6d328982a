"""Milliseconds of a step with contacts: mozzi's program beside MuJoCo's mj_step, on the same models, steps of 1 ms.

Usage: contacts.py MOZZI, with mujoco, gymnasium and dm_control installed. A model falls from its start, motors off, and
lies: the first second is the fall, the third is lying. mozzi's time is that of whole runs, less that of shorter ones.
"""

import subprocess
import sys
import time
from pathlib import Path

import dm_control
import gymnasium
import mujoco

REPEATS = 3


def models():
    suite = Path(dm_control.__file__).parent / "suite"
    assets = Path(gymnasium.__file__).parent / "envs" / "mujoco" / "assets"
    found = {f"gymnasium {name}": assets / f"{name}.xml" for name in ("humanoid", "ant")}
    found |= {f"dm_control {name}": suite / f"{name}.xml" for name in ("humanoid", "quadruped", "dog")}
    return found


def by_mujoco(path):
    """Seconds of mj_step in the first and in the third second of the motion."""
    model = mujoco.MjModel.from_xml_path(str(path))
    model.opt.timestep = 1e-3
    data = mujoco.MjData(model)
    seconds = []
    for _ in range(3):
        start = time.process_time()
        for _ in range(1000):
            mujoco.mj_step(model, data)
        seconds.append(time.process_time() - start)
    return seconds[0], seconds[2]


def by_mozzi(program, path):
    """The same, as differences of whole runs; with the largest residual."""

    def run(duration):
        command = [program, "simulate", str(path), "--ground", "--method", "moreau", "--step", "0.001", "--time", str(duration)]
        best = float("inf")
        for _ in range(REPEATS):
            start = time.perf_counter()
            found = subprocess.run(command, capture_output=True, text=True)
            best = min(best, time.perf_counter() - start)
        if found.returncode:
            raise RuntimeError(found.stderr.strip().splitlines()[-1])
        return best, found.stdout

    none, first, second, third = (run(duration) for duration in (1e-3, 1, 2, 3))
    solved = next((line for line in third[1].splitlines() if line.startswith("dry friction, stops, contacts")), "")
    return first[0] - none[0], third[0] - second[0], solved


def main():
    program = sys.argv[1]
    print("| model | fall: mozzi | MuJoCo | ratio | lying: mozzi | MuJoCo | ratio |")
    print("|---|---|---|---|---|---|---|")
    for name, path in models().items():
        try:
            mozzi, mujocos = by_mozzi(program, path), by_mujoco(path)
        except Exception as error:  # a model that one of them refuses
            print(f"| {name} | not run | | | | | |")
            print(f"{name}: {error}", file=sys.stderr)
            continue
        cells = [f"{mozzi[k]:.3f} ms | {mujocos[k]:.3f} ms | {mozzi[k] / mujocos[k]:.1f}" for k in (0, 1)]
        print(f"| {name} | {' | '.join(cells)} |", flush=True)
        print(f"{name}: {mozzi[2]}", file=sys.stderr)


if __name__ == "__main__":
    main()
