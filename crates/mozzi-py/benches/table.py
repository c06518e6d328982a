"""One call, many states and the drop-in, each beside its peer, in turn, on the same states, after their results were compared. Of each
the least time is told; what counts is the ratio. The table goes to the file that is named, and to standard output."""

import sys
import time
from pathlib import Path

import modern_robotics as book
import mozzi
import mozzi.modern_robotics as mr
import numpy as np
import pinocchio as pin
from mozzi.conventions import Pinocchio

ROUNDS = 40


def race(*runners, rounds=ROUNDS):
    """The least seconds a call of each: (function, calls in a round)."""
    least = [float("inf")] * len(runners)
    for _ in range(rounds):
        for k, (function, calls) in enumerate(runners):
            start = time.perf_counter()
            for _ in range(calls):
                function()
            least[k] = min(least[k], (time.perf_counter() - start) / calls)
    return least


def same(found, expected, tolerance=1e-9):
    error = np.abs(np.asarray(found) - expected).max() / np.abs(expected).max()
    assert error < tolerance, f"results differ by {error}"


def beside_pinocchio(random):
    robot = mozzi.models.panda()
    fast = robot.compile("inverse_dynamics", "forward_dynamics", "mass_matrix", threads=1)
    model = pin.buildModelFromUrdf(str(Path(__file__).parents[3] / "crates/mozzi-urdf/models/panda.urdf"), mimic=True)
    data, bridge = model.createData(), Pinocchio(robot)
    theta, dtheta, ddtheta = random.uniform(-1, 1, (3, robot.n))
    q, v, a = bridge.configuration(theta), bridge.velocity(dtheta), bridge.acceleration(ddtheta)
    friction = robot.joint_friction(dtheta)
    calls = {
        "inverse_dynamics": ((theta, dtheta, ddtheta), lambda: pin.rnea(model, data, q, v, a)),
        "mass_matrix": ((theta,), lambda: pin.crba(model, data, q)),
    }
    print("| one call, Panda | Pinocchio | mozzi | of Pinocchio's | compiled | of Pinocchio's |")
    print("|---|---|---|---|---|---|")
    for name, (given, theirs) in calls.items():
        ours, compiled = getattr(robot, name), getattr(fast, name)
        if name == "inverse_dynamics":
            same(bridge.force(ours(*given) - friction), theirs())
        same(compiled(*given), ours(*given))
        p, m, c = race((theirs, 2000), (lambda: ours(*given), 2000), (lambda: compiled(*given), 2000))
        print(f"| `{name}` | {p * 1e9:.0f} ns | {m * 1e9:.0f} ns | {m / p:.2f} | {c * 1e9:.0f} ns | {c / p:.2f} |")

    theta, dtheta, ddtheta = random.uniform(-1, 1, (3, 10_000, robot.n))
    states = [bridge.configuration(theta), bridge.velocity(dtheta), bridge.acceleration(ddtheta)]
    columns = [np.asfortranarray(x.T) for x in states]
    pool = pin.ModelPool(model, 1)

    def loop():
        for q, v, a in zip(*states):
            pin.rnea(model, data, q, v, a)

    parallel = lambda: pin.rneaInParallel(1, pool, *columns)
    ours = lambda: robot.inverse_dynamics(theta, dtheta, ddtheta, threads=1)
    compiled = lambda: fast.inverse_dynamics(theta, dtheta, ddtheta)
    same(bridge.force(ours() - robot.joint_friction(dtheta)), np.asarray(parallel()).T)
    same(compiled(), ours())
    a, b, c, d = race((loop, 1), (parallel, 1), (ours, 3), (compiled, 3), rounds=25)
    print()
    print("| 10,000 inverse dynamics, Panda, one thread | ms | `pin.rnea` in a loop takes | `pin.rneaInParallel` takes |")
    print("|---|---|---|---|")
    for name, x in [("loop", a), ("rneaInParallel", b), ("mozzi, one call", c), ("mozzi, compiled", d)]:
        print(f"| {name} | {x * 1e3:.2f} | {a / x:.1f} × | {b / x:.1f} × |")


def beside_the_book(random):
    ur5 = mozzi.models.ur5()
    lists = ur5.screws()
    M, G, S = np.array([*lists.M_relative, np.eye(4)]), lists.G, lists.S
    theta, dtheta, ddtheta = random.uniform(-1, 1, (3, 6))
    g, F = np.array([0, 0, -9.81]), random.uniform(-1, 1, 6)
    T = lists.M[4]
    near = theta + 0.05
    target = book.FKinSpace(M[0], S, theta)
    calls = {
        "InverseDynamics": (theta, dtheta, ddtheta, g, F, M, G, S),
        "MassMatrix": (theta, M, G, S),
        "ForwardDynamics": (theta, dtheta, ddtheta, g, F, M, G, S),
        "VelQuadraticForces": (theta, dtheta, M, G, S),
        "GravityForces": (theta, g, M, G, S),
        "EndEffectorForces": (theta, F, M, G, S),
        "InverseDynamicsTrajectory": (*random.uniform(-1, 1, (3, 20, 6)), g, np.ones((20, 6)), M, G, S),
        "ComputedTorque": (theta, dtheta, ddtheta, g, M, G, S, near, dtheta, ddtheta, 1.3, 1.2, 1.1),
        "FKinSpace": (M[0], S, theta),
        "FKinBody": (M[0], S, theta),
        "JacobianSpace": (S, theta),
        "JacobianBody": (S, theta),
        "IKinSpace": (S, M[0], target, near, 1e-6, 1e-6),
        "MatrixExp6": (book.VecTose3(S[:, 1] * 0.7),),
        "MatrixLog6": (T,),
        "MatrixExp3": (book.VecToso3([0.1, 0.2, 0.3]),),
        "MatrixLog3": (book.MatrixExp3(book.VecToso3([0.1, 0.2, 0.3])),),
        "Adjoint": (T,),
        "ad": (S[:, 1],),
        "TransInv": (T,),
        "ScrewTrajectory": (T, target, 2.0, 20, 5),
    }
    print()
    print("| the Modern Robotics package, UR5 | its own | `mozzi.modern_robotics` | faster |")
    print("|---|---|---|---|")
    for name, given in calls.items():
        ours, theirs = getattr(mr, name), getattr(book, name)
        found, expected = ours(*given), theirs(*given)
        if name == "IKinSpace":
            found, expected = found[0], expected[0]
        same(found, expected, 1e-6 if name in ("IKinSpace", "ForwardDynamics") else 1e-9)
        slow = 3 if race((lambda: theirs(*given), 1), rounds=1)[0] > 1e-3 else 30
        a, b = race((lambda: theirs(*given), slow), (lambda: ours(*given), 10 * slow), rounds=10)
        print(f"| `{name}` | {a * 1e6:.1f} µs | {b * 1e6:.2f} µs | {a / b:.0f} × |")


class Both:
    """Standard output and a file."""

    def __init__(self, path):
        self.file, self.screen = open(path, "w"), sys.stdout

    def write(self, text):
        self.file.write(text)
        self.screen.write(text)

    def flush(self):
        self.file.flush()
        self.screen.flush()


if __name__ == "__main__":
    if len(sys.argv) > 1:
        sys.stdout = Both(sys.argv[1])
    print(f"Python {sys.version.split()[0]}, NumPy {np.__version__}, Pinocchio {pin.__version__}; least of interleaved rounds.\n")
    beside_pinocchio(np.random.default_rng(1763))
    beside_the_book(np.random.default_rng(1763))
