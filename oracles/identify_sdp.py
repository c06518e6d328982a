"""Solves the convex problems of identification by cvxpy and Clarabel: the second way for mozzi-identify.

    cargo test -p mozzi-identify semidefinite -- --ignored    # writes the problems
    python oracles/identify_sdp.py                                   # pip install cvxpy clarabel; adds the optima

min |R x - z|^2 + gamma sum (tr W - log det W - 4) + 1e-5 sum (f/s - log(f/s) - 1), with J = C W C^T the pseudo-inertia
of each body and f the positive unknowns.
"""

import json
from pathlib import Path

import cvxpy as cp
import numpy as np

FILE = Path(__file__).with_name("identify_sdp.json")


def inertia(J):
    """(m, mc, I) of a pseudo-inertia."""
    S = J[:3, :3]
    I = np.trace(S) * np.eye(3) - S
    return np.array([J[3, 3], *J[:3, 3], I[0, 0], I[0, 1], I[0, 2], I[1, 1], I[1, 2], I[2, 2]])


def unit(i, j):
    E = np.zeros((4, 4))
    E[i, j] = 1
    return E


def solve(problem):
    P = problem["unknowns"]
    R = np.zeros((P, P + 1))
    for i, row in enumerate(problem["rows"]):
        R[i, i:] = row
    parts, cost, at = {}, 0, 0
    for body in problem["bodies"]:
        C = np.array(body["C"]).reshape(4, 4)
        W = cp.Variable((4, 4), PSD=True)
        # columns: what each entry of W adds to the ten parameters
        T = np.stack([inertia(0.5 * (C @ (unit(i, j) + unit(j, i)) @ C.T)) for i in range(4) for j in range(4)], 1)
        parts[body["first"]] = T @ cp.vec(W, order="C")
        cost += problem["gamma"] * (cp.trace(W) - cp.log_det(W) - 4)
    rest = cp.Variable(P - 10 * len(parts))
    blocks, used, at = [], 0, 0
    place = {}
    while at < P:
        if at in parts:
            blocks.append(parts[at])
            at += 10
        else:
            place[at] = used
            blocks.append(rest[used : used + 1])
            used += 1
            at += 1
    x = cp.hstack(blocks)
    for k, size in zip(problem["positive"], problem["sizes"]):
        f = rest[place[k]] / size
        cost += 1e-5 * (f - cp.log(f) - 1)
    cost += cp.sum_squares(R[:, :P] @ x - R[:, P])
    program = cp.Problem(cp.Minimize(cost))
    program.solve(solver="CLARABEL", tol_gap_abs=1e-10, tol_gap_rel=1e-10, tol_feas=1e-10)
    print(problem["robot"], problem["gamma"], program.status, program.value)
    return {**problem, "optimum": x.value.tolist(), "cost": float(program.value)}


if __name__ == "__main__":
    problems = [solve(problem) for problem in json.loads(FILE.read_text())]
    FILE.write_text(json.dumps(problems) + "\n")
