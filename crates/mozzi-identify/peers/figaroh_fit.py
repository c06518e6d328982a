"""The same log in figaroh (PyPI): base parameters by weighted least squares, and its physical fit.

    pip install figaroh scipy
    python figaroh_fit.py ROBOT.urdf LOG.csv CUTOFF_HZ [--lock JOINT]... [--armature] [--tanh]

Fits the first 70 % of the log, prints the root mean square errors of the torques of the last 30 %, as
`mozzi identify --fit 70 --cutoff CUTOFF_HZ` does. Signals are filtered as in mozzi: Butterworth of order 4,
forwards and backwards, accelerations by central differences.
"""

import argparse
import time
from types import SimpleNamespace

import numpy as np
import pinocchio as pin
from figaroh.identification.physical_fit import PhysicalPolicy, build_problem, solve_direct_effort_fit
from figaroh.tools.regressor import RegressorBuilder, RegressorConfig
from filtered_log import filtered

KEYS = ["m", "mx", "my", "mz", "Ixx", "Ixy", "Iyy", "Ixz", "Iyz", "Izz"]


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("urdf")
    parser.add_argument("log")
    parser.add_argument("cutoff", type=float)
    parser.add_argument("--lock", action="append", default=[])
    parser.add_argument("--armature", action="store_true")
    parser.add_argument("--tanh", action="store_true", help="Coulomb friction as tanh(v/0.05) instead of sign(v)")
    given = parser.parse_args()
    model = pin.buildModelFromUrdf(given.urdf)
    if given.lock:
        locked = [model.getJointId(name) for name in given.lock]
        model = pin.buildReducedModel(model, locked, pin.neutral(model))
    _, q, dq, ddq, tau = filtered(given.log, given.cutoff)
    n = model.nv
    robot = SimpleNamespace(model=model, data=model.createData())
    config = RegressorConfig(has_friction=True, has_actuator_inertia=given.armature, has_joint_offset=True)
    joints = list(model.names)[1:]
    names = [f"{key}_{joint}" for joint in joints for key in KEYS]
    names += [f"{block}_{joint}" for block in config.extra_blocks() for joint in joints]
    start = time.perf_counter()
    W = RegressorBuilder(robot, config).build_basic_regressor(q, dq, ddq, {"act_idxv": list(range(n))})
    N = len(q)
    if given.tanh:
        for j in range(n):
            W[j * N : (j + 1) * N, 11 * n + j] = np.tanh(dq[:, j] / 0.05)
    split = int(0.7 * N)
    Y = W.reshape(n, N, -1)
    fit, test = Y[:, :split], Y[:, split:]
    tau_fit, tau_test = tau[:split].T, tau[split:].T
    prior = np.concatenate(
        [np.concatenate([I.toDynamicParameters() for I in model.inertias[1:]]), np.zeros(len(names) - 10 * n)]
    )

    def errors(theta):
        residual = np.einsum("jkp,p->jk", test, theta) - tau_test
        return np.sqrt(np.mean(residual**2, axis=1))

    rows, forces = fit.reshape(n * split, -1), tau_fit.reshape(-1)
    theta = np.linalg.lstsq(rows, forces, rcond=1e-6)[0]
    deviations = np.std(np.einsum("jkp,p->jk", fit, theta) - tau_fit, axis=1)
    weights = np.repeat(1 / deviations, split)
    problem = build_problem(
        rows, forces, names, joints, prior=prior, row_weight=weights, policy=PhysicalPolicy(prior_weight=1e-6)
    )
    theta = np.zeros(len(names))
    theta[list(problem.base_indices)] = problem.phi_ols
    show = lambda label, x: print(f"{label:28}", " ".join(f"{e:7.4f}" for e in errors(x)))
    print(f"{N} samples, {len(names)} parameters, {len(problem.base_indices)} base parameters")
    show("weighted least squares", theta)
    print(f"{'':28} {time.perf_counter() - start:.2f} s with the regressor")
    for weight in [1e-6, 1e-4, 1e-2, 1.0]:
        start = time.perf_counter()
        policy = PhysicalPolicy(prior_weight=weight)
        problem = build_problem(rows, forces, names, joints, prior=prior, row_weight=weights, policy=policy)
        record = solve_direct_effort_fit(problem)
        seconds = time.perf_counter() - start
        if record.theta is None:
            print(f"physical fit, prior {weight:g}: {record.solver_status}, {seconds:.2f} s")
        else:
            state = "accepted" if record.accepted else "not accepted"
            show(f"physical fit, prior {weight:g}", record.theta)
            print(f"{'':28} {seconds:.2f} s, {state}")


main()
