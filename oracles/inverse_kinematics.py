"""Inverse kinematics at reachable poses: mozzi beside PyPI's pin, modern_robotics and optik-py.

    cargo build --release -p mozzi-cli
    python oracles/inverse_kinematics.py [--poses 10000] [--slow 500] [ROBOT …]

Poses are those of random positions within the joints' limits; each search begins at one guess, the middle of the limits. A pose counts as
reached where Pinocchio's forward kinematics of the answer, limits held, is within 1e-4 rad and 1e-4 m of it. What is slow is asked of the
first poses only. pin has no inverse kinematics of its own: here it is the loop of its documentation (damped, dt = 0.1, at most
1000 iterations). modern_robotics.IKinBody has at most 20 iterations. Neither of the two restarts or knows limits; for both, the share that is reached
with limits left aside stands in brackets. The time of mozzi is that of its command line, a process for all poses, over their number.
"""

import argparse
import csv
import importlib.util
import json
import math
import pathlib
import subprocess
import tempfile
import time

import numpy as np
import pinocchio as pin

ROOT = pathlib.Path(__file__).resolve().parent.parent
ROBOTS = {
    "ur5": "tool0",
    "panda": "panda_hand",
    "anymal": "LF_FOOT",
    "double_pendulum": "tip",
    "furuta_pendulum": "tip",
    "two_link_planar": "tip",
}
ANGLE = DISTANCE = 1e-4


class Robot:
    def __init__(self, name):
        self.name, self.frame = name, ROBOTS[name]
        self.path = str(ROOT / "crates/mozzi-urdf/models" / f"{name}.urdf")
        whole = pin.buildModelFromUrdf(self.path)
        # only the joints that move the frame: the others are no part of the question
        support = [whole.joints[k].shortname() and whole.names[k] for k in whole.supports[whole.frames[whole.getFrameId(self.frame)].parentJoint]]
        locked = [k for k in range(1, whole.njoints) if whole.names[k] not in support]
        self.model = pin.buildReducedModel(whole, locked, pin.neutral(whole))
        self.data = self.model.createData()
        self.id = self.model.getFrameId(self.frame)
        self.names = list(self.model.names)[1:]
        self.continuous = self.model.nq != self.model.nv
        limits = lambda values, none: np.array([x if abs(x) < 1e6 else none for x in values])
        self.low, self.high = (
            (np.full(self.model.nv, -math.pi), np.full(self.model.nv, math.pi))
            if self.continuous
            else (limits(self.model.lowerPositionLimit, -math.pi), limits(self.model.upperPositionLimit, math.pi))
        )

    def q(self, theta):
        """Pinocchio's configuration: a continuous joint is (cos, sin) there."""
        return pin.integrate(self.model, pin.neutral(self.model), np.asarray(theta))

    def pose(self, theta):
        pin.framesForwardKinematics(self.model, self.data, self.q(theta))
        return self.data.oMf[self.id].copy()

    def reached(self, theta, goal):
        error = self.pose(theta).actInv(goal)
        near = np.linalg.norm(pin.log3(error.rotation)) < ANGLE and np.linalg.norm(error.translation) < DISTANCE
        within = self.continuous or bool(np.all(theta >= self.low - 1e-9) and np.all(theta <= self.high + 1e-9))
        return near, near and within


def by_mozzi(robot, goals, guess, method):
    with tempfile.TemporaryDirectory() as folder:
        table, out = pathlib.Path(folder, "goals.csv"), pathlib.Path(folder, "theta.csv")
        with table.open("w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(["x", "y", "z", "qx", "qy", "qz", "qw"])
            for T in goals:
                writer.writerow([repr(float(x)) for x in pin.SE3ToXYZQUAT(T)])
        program = ROOT / "target/release/mozzi"
        information = subprocess.run([program, "terms", robot.name, "--frame", robot.frame, "--json"], capture_output=True, check=True, text=True)
        joints = json.loads(information.stdout)["joints"]
        start = [guess[robot.names.index(name)] if name in robot.names else 0.0 for name in joints]
        arguments = ["ik", robot.name, "--frame", robot.frame, "--in", table, "--out", out, "--method", method]
        arguments += ["--guess=" + ",".join(repr(float(x)) for x in start), "--angle", "1e-6", "--distance", "1e-6"]
        begin = time.perf_counter()
        ended = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
        seconds = time.perf_counter() - begin
        if not out.exists():
            raise RuntimeError(ended.stderr.strip())
        with out.open() as file:
            rows = list(csv.DictReader(file))
        picked = [joints.index(name) + 1 for name in robot.names]
        return [np.array([float(row[f"theta_{k}"]) for k in picked]) for row in rows], seconds


def by_pin(robot, goals, guess):
    answers, begin = [], time.perf_counter()
    model, data, frame = robot.model, robot.data, robot.id
    for goal in goals:
        q = robot.q(guess)
        for _ in range(1000):
            pin.framesForwardKinematics(model, data, q)
            iMd = data.oMf[frame].actInv(goal)
            error = pin.log(iMd).vector
            if np.linalg.norm(error) < 1e-6:
                break
            J = -pin.Jlog6(iMd.inverse()) @ pin.computeFrameJacobian(model, data, q, frame)
            v = -J.T @ np.linalg.solve(J @ J.T + 1e-12 * np.eye(6), error)
            q = pin.integrate(model, q, v * 0.1)
        answers.append(pin.difference(model, pin.neutral(model), q))
    return answers, time.perf_counter() - begin


def by_modern_robotics(robot, goals, guess):
    import modern_robotics as mr

    home = robot.pose(np.zeros(robot.model.nv))
    q = robot.q(np.zeros(robot.model.nv))
    J = pin.computeFrameJacobian(robot.model, robot.data, q, robot.id)
    body = np.vstack([J[3:], J[:3]])
    answers, begin = [], time.perf_counter()
    for goal in goals:
        theta, _ = mr.IKinBody(body, home.homogeneous, goal.homogeneous, np.array(guess), 1e-6, 1e-6)
        answers.append(theta)
    return answers, time.perf_counter() - begin


def by_optik(robot, goals, guess):
    import optik

    base = robot.model.frames[1].name
    solver = optik.Robot.from_urdf_file(robot.path, base, robot.frame)
    config = optik.SolverConfig(solution_mode="speed", max_time=0.1, tol_f=1e-12)
    answers, begin = [], time.perf_counter()
    for goal in goals:
        found = solver.ik(config, goal.homogeneous, guess)
        answers.append(np.array(found[0]) if found is not None else np.array(guess))
    return answers, time.perf_counter() - begin


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("robots", nargs="*", default=list(ROBOTS))
    parser.add_argument("--poses", type=int, default=10_000)
    parser.add_argument("--slow", type=int, default=500)
    arguments = parser.parse_args()
    peers = [
        ("mozzi, Levenberg-Marquardt", lambda *a: by_mozzi(*a, "levenberg-marquardt"), arguments.poses),
        ("mozzi, Newton", lambda *a: by_mozzi(*a, "newton"), arguments.poses),
        ("pin's loop", by_pin, arguments.slow),
    ]
    if importlib.util.find_spec("modern_robotics"):
        peers.append(("modern_robotics", by_modern_robotics, arguments.slow))
    if importlib.util.find_spec("optik"):
        peers.append(("optik-py", by_optik, arguments.slow))
    print(f"{'robot':16} {'solver':27} {'poses':>6} {'reached, %':>18} {'ms a pose':>10}")
    for name in arguments.robots:
        robot = Robot(name)
        random = np.random.default_rng(1)
        guess = 0.5 * (robot.low + robot.high)
        goals = [robot.pose(random.uniform(robot.low, robot.high)) for _ in range(arguments.poses)]
        for peer, solve, count in peers:
            try:
                answers, seconds = solve(robot, goals[:count], list(guess))
            except KeyboardInterrupt:
                raise
            except BaseException as error:  # a library that panics is no Exception
                print(f"{name:16} {peer:27} {type(error).__name__}: {error}")
                continue
            judged = [robot.reached(theta, goal) for theta, goal in zip(answers, goals)]
            near, within = (100 * sum(x[k] for x in judged) / count for k in (0, 1))
            share = f"{within:.2f}" + ("" if near == within else f" ({near:.2f})")
            print(f"{name:16} {peer:27} {count:6} {share:>18} {1e3 * seconds / count:10.3f}", flush=True)


if __name__ == "__main__":
    main()
