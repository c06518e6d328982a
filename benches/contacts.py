"""Milliseconds of a step with contacts: mozzi's program beside MuJoCo's mj_step, on the same models, steps of 1 ms.

Usage: contacts.py MOZZI, with mujoco, gymnasium, dm_control and example-robot-data installed. A model falls from its
start, a URDF's robot from a height at which nothing touches, motors off, and lies: the first second is the fall, the
third is lying. mozzi's time is that of whole runs, less that of shorter ones.
"""

import json
import os
import re
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
    robots = os.environ.get("MOZZI_ROBOTS")
    if robots:
        found |= {name: Path(robots) / file for name, (file, _) in URDFS.items()}
    else:
        print("MOZZI_ROBOTS is not set: no URDF is run", file=sys.stderr)
    return found


# of example-robot-data, with the height of the base at the start, m
URDFS = {
    "ANYmal": ("anymal_b_simple_description/robots/anymal.urdf", 0.8),
    "Go2": ("go2_description/urdf/go2.urdf", 0.6),
    "G1, meshes": ("g1_description/urdf/g1_29dof_rev_1_0.urdf", 1.0),
    "Talos, meshes": ("talos_data/robots/talos_reduced.urdf", 1.3),
}


def height(path):
    return next((height for file, height in URDFS.values() if path.as_posix().endswith(file)), None)


def of_urdf(path):
    """A URDF in MuJoCo, with a free base and a floor; what is drawn only is left out."""
    text = re.sub(r"<visual.*?</visual>", "", path.read_text(), flags=re.DOTALL)
    root = Path(os.environ["MOZZI_ROBOTS"])
    assets = {}

    def asset(found):
        name = f"{len(assets)}{Path(found[1]).suffix.lower()}"
        packages = [folder / found[1] for folder in (root, root.parent.parent)]
        assets[name] = next(package for package in packages if package.exists()).read_bytes()
        return f'filename="{name}"'

    text = re.sub(r'filename="package://([^"]*)"', asset, text)
    spec = mujoco.MjSpec.from_string(text, assets=assets)
    # links without a mass of their own
    spec.compiler.boundmass, spec.compiler.boundinertia, spec.compiler.balanceinertia = 1e-9, 1e-9, True
    spec.worldbody.first_body().add_freejoint()
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[1, 1, 1])
    return spec.compile()


def within(low, high):
    """A joint's start: 0, or its limit next to it."""
    return min(max(0.0, low), high)


def by_mujoco(path):
    """Seconds of mj_step in the first and in the third second of the motion."""
    start = height(path)
    model = mujoco.MjModel.from_xml_path(str(path)) if start is None else of_urdf(path)
    model.opt.timestep = 1e-3
    data = mujoco.MjData(model)
    if start is not None:
        data.qpos[2] = start
        for joint in range(1, model.njnt):
            low, high = model.jnt_range[joint] if model.jnt_limited[joint] else (0.0, 0.0)
            data.qpos[model.jnt_qposadr[joint]] = within(low, high)
    seconds = []
    for _ in range(3):
        start = time.process_time()
        for _ in range(1000):
            mujoco.mj_step(model, data)
        seconds.append(time.process_time() - start)
    return seconds[0], seconds[2]


def by_mozzi(program, path):
    """The same, as differences of whole runs; with the largest residual."""

    flags = []
    if height(path) is not None:
        found = subprocess.run([program, "info", str(path), "--floating", "--json"], capture_output=True, text=True)
        robot = json.loads(found.stdout)
        limits = {joint["name"]: joint["limits"]["position"] or (0.0, 0.0) for joint in robot["joints"]}
        start = [within(*limits[name]) for name in robot["independent_joints"]]
        flags = ["--floating", "--theta", ",".join(map(str, [1, 0, 0, 0, 0, 0, height(path), *start]))]

    def run(duration):
        command = [program, "simulate", str(path), "--ground", "--method", "moreau", "--step", "0.001", "--time", str(duration), *flags]
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
