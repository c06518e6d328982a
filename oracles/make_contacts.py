#!/usr/bin/env python3
"""Reference impulses of contacts with Coulomb friction, by Pinocchio's ADMM solver (pin 4.1).

    python oracles/make_contacts.py > oracles/contacts.json

Each problem has G = J M⁻¹ Jᵀ and b = −J v_free, by rows, with rows (n, t1, t2) of each contact and n into the ground; the
answer has the impulses p and velocities u = G p + b. Pinocchio's order is (t1, t2, n), with the same G, b, p and u. A
problem whose answer does not satisfy the laws to 1e-9 is left out.

- `anymal`: ANYmal on four feet, with Pinocchio's own M and J, at random velocities: sticking, sliding, lifting feet.
- `box`: a box on four and on eight points that does not turn; G has rank 6. (If it turned while it slides, its velocity
  would depend on how its weight is shared, which is not unique.)
- `random`: four contacts, G of full rank.
"""

import json
import sys
from pathlib import Path

import numpy as np
import pinocchio as pin

HERE = Path(__file__).resolve().parent
FEET = ["LF_FOOT", "RF_FOOT", "LH_FOOT", "RH_FOOT"]
POSE = np.array([0, 0.7, -1.0, 0, 0.7, -1.0, 0, -0.7, 1.0, 0, -0.7, 1.0])


def admm(G, b, mu):
    """Impulses by Pinocchio."""
    contacts = len(b) // 3
    order = [3 * k + i for k in range(contacts) for i in (1, 2, 0)]
    model = pin.Model()
    models, datas = pin.StdVec_ConstraintModel(), pin.StdVec_ConstraintData()
    for _ in range(contacts):
        contact = pin.PointContactConstraintModel(model, 0, pin.SE3.Identity())
        contact.setFriction(mu)
        wrapped = pin.ConstraintModel(contact)
        models.append(wrapped)
        datas.append(wrapped.createData())
    solver, settings, result = pin.ADMMConstraintSolver(), pin.ADMMSolverSettings(), pin.ADMMSolverResult()
    settings.absolute_feasibility_tol = settings.absolute_complementarity_tol = 1e-13
    settings.relative_feasibility_tol = settings.relative_complementarity_tol = 1e-13
    settings.max_iterations = 20_000
    operator = pin.DelassusOperatorDense(np.ascontiguousarray(G[np.ix_(order, order)]))
    solver.solve(operator, b[order].copy(), models, datas, settings, result)
    p = np.zeros(len(b))
    p[order] = result.retrieveConstraintImpulses()
    return p


def violation(G, b, mu, p):
    """How far p and u are from Coulomb's law, in velocities."""
    u, worst = G @ p + b, 0.0
    for i in range(0, len(b), 3):
        g = np.trace(G[i : i + 3, i : i + 3]) / 3
        x = p[i : i + 3] - (u[i : i + 3] + [mu * np.hypot(u[i + 1], u[i + 2]), 0, 0]) / g
        n, t = x[0], np.hypot(x[1], x[2])
        if mu * t <= -n:
            y = np.zeros(3)
        elif t <= mu * n:
            y = x
        else:
            s = (n + mu * t) / (1 + mu * mu)
            y = np.array([s, *(mu * s / t * x[1:])])
        worst = max(worst, np.abs(p[i : i + 3] - y).max() * g)
    return worst


def anymal(random, dt=1e-3):
    model = pin.buildModelFromUrdf(str(HERE.parent / "crates/mozzi-urdf/models/anymal.urdf"), pin.JointModelFreeFlyer())
    data = model.createData()
    q = pin.neutral(model)
    for k, leg in enumerate(["LF", "RF", "LH", "RH"]):
        for j, part in enumerate(["HAA", "HFE", "KFE"]):
            q[model.joints[model.getJointId(f"{leg}_{part}")].idx_q] = POSE[3 * k + j]
    v = random.normal(size=model.nv) * 0.3
    v[2] -= 0.5  # it lands
    pin.computeAllTerms(model, data, q, v)
    M = np.triu(data.M) + np.triu(data.M, 1).T
    rows = []
    for foot in FEET:
        J = pin.getFrameJacobian(model, data, model.getFrameId(foot), pin.LOCAL_WORLD_ALIGNED)[:3]
        rows += [-J[2], J[0], J[1]]
    J = np.array(rows)
    free = v - dt * np.linalg.solve(M, data.nle)
    return J @ np.linalg.solve(M, J.T), -J @ free, 0.7


def box(random, points):
    x, y, z, m = 0.15, 0.1, 0.05, 4.0
    corners = [[x, y], [x, -y], [-x, y], [-x, -y], [x, 0], [-x, 0], [0, y], [0, -y]][:points]
    inertia = m / 3 * np.array([y * y + z * z, x * x + z * z, x * x + y * y])
    rows = []
    for px, py in corners:
        J = np.hstack([np.cross(np.eye(3), [px, py, -z]).T, np.eye(3)])
        rows += [-J[2], J[0], J[1]]
    J = np.array(rows)
    free = np.array([0, 0, 0, *(0.15 * random.normal(size=2)), -0.2])
    return J @ np.diag(1 / np.array([*inertia, m, m, m])) @ J.T, -J @ free, 0.5


def any_contacts(random):
    A = random.normal(size=(12, 12))
    return A @ A.T / 12, random.normal(size=12), 0.3


def main():
    random, problems = np.random.default_rng(26), []
    makers = [("anymal", anymal, 6), ("box", lambda r: box(r, 4), 6), ("box", lambda r: box(r, 8), 6), ("random", any_contacts, 6)]
    for name, make, count in makers:
        for _ in range(count):
            G, b, mu = make(random)
            G = (G + G.T) / 2
            p = admm(G, b, mu)
            found = violation(G, b, mu, p)
            print(name, len(b), f"{found:.1e}", file=sys.stderr)
            if found < 1e-9:
                problems.append({"name": name, "mu": mu, "G": G.ravel().tolist(), "b": b.tolist(), "p": p.tolist()})
    json.dump({"pinocchio": pin.__version__, "problems": problems}, sys.stdout)


main()
