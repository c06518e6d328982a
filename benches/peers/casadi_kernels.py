"""C by CasADi, as the field's code generators write it: one function a robot and quantity, unrolled, every constant folded.

usage: casadi_kernels.py ROBOTS OUT COMPILER [WORD …]

ROBOTS holds what `compare --describe` writes. OUT gets ROBOT.c and robots.inc, for casadi.cpp. The C compiler is called for the time
to a first result alone. The kernels are written here on
CasADi's symbols in 3-vectors, the cheapest form: inverse dynamics by Newton-Euler with classical accelerations, the mass matrix by
composite bodies, forward dynamics by articulated bodies; on short arms also by M = LDLᵀ, and derivatives by CasADi's own.
"""

import pathlib
import subprocess
import sys
import time

import casadi as ca
import numpy as np

MOST_BODIES = 40  # straight code of a longer robot is more than a compiler takes in a minute
SHORT = 8  # joints: beyond, derivatives of straight code explode


def constant(x):
    """With structural zeros, and ones that are exact: what a file's angles leave of them is below 1e-14."""
    x = np.array(x, float)
    for exact in (0.0, 1.0, -1.0):
        x[abs(x - exact) < 1e-14] = exact
    return ca.sparsify(ca.SX(x))


class Body:
    def __init__(self, row):
        self.parent, self.is_revolute = int(row[0]), row[1] != 0
        self.R, self.p = np.reshape(row[2:11], (3, 3)), constant(row[11:14])
        self.mass, c, axis = row[17], np.array(row[18:21]), np.array(row[14:17])
        self.axis, outer = constant(axis), np.outer(axis, axis)
        K = np.cross(np.eye(3), axis)  # [axis]
        # R e^{[axis]q} = by_one + by_cos cos q + by_sin sin q
        self.by_one, self.by_cos, self.by_sin = (constant(self.R @ x) for x in (outer, np.eye(3) - outer, K))
        I = np.reshape(row[21:30], (3, 3)) + self.mass * (c @ c * np.eye(3) - np.outer(c, c))
        self.h, self.I = constant(self.mass * c), constant(I)  # first moment; inertia about the origin

    def placed(self, q):
        """The body's rotation and origin seen from its parent."""
        if not self.is_revolute:
            return constant(self.R), self.p + constant(self.R) @ self.axis * q
        return ca.sparsify(self.by_one + self.by_cos * ca.cos(q) + self.by_sin * ca.sin(q)), self.p


def rotation(w, x, y, z):
    return ca.vertcat(
        ca.horzcat(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        ca.horzcat(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        ca.horzcat(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )


class Robot:
    """Six-vectors are pairs, angular first. The base is body 0: free, or at rest."""

    def __init__(self, path):
        head, *rows = [[float(x) for x in line.split()] for line in path.read_text().splitlines()]
        self.g, self.is_free = constant(head[:3]), head[3] != 0
        self.bodies = [Body(row) for row in rows]
        self.base = 6 if self.is_free else 0
        self.joints = len(self.bodies) - 1
        self.n, self.nq = self.joints + self.base, self.joints + (7 if self.is_free else 0)

    def placements(self, q):
        joints = q[self.nq - self.joints :]
        return [None] + [b.placed(joints[k]) for k, b in enumerate(self.bodies[1:])]

    def gravity(self, q):
        """The base's acceleration that stands for gravity, in its own axes."""
        return -(rotation(*ca.vertsplit(q[:4])).T @ self.g) if self.is_free else -self.g

    def inverse_dynamics(self, q, v, a):
        T, zero, b = self.placements(q), ca.SX(3, 1), self.base
        free = self.is_free
        w = [v[:3] if free else zero]
        alpha = [a[:3] if free else zero]
        acc = [self.gravity(q) + (a[3:6] + ca.cross(v[:3], v[3:6]) if free else zero)]
        for k, body in enumerate(self.bodies[1:]):
            (R, p), i, s, ds, dds = T[k + 1], body.parent, body.axis, v[b + k], a[b + k]
            wi = R.T @ w[i]
            carried = R.T @ (acc[i] + ca.cross(alpha[i], p) + ca.cross(w[i], ca.cross(w[i], p)))
            if body.is_revolute:
                w.append(wi + s * ds)
                alpha.append(R.T @ alpha[i] + s * dds + ca.cross(wi, s * ds))
                acc.append(carried)
            else:
                w.append(wi)
                alpha.append(R.T @ alpha[i])
                acc.append(carried + s * dds + 2 * ca.cross(wi, s * ds))
        f, m = [], []
        for k, body in enumerate(self.bodies):
            wk, h = w[k], body.h
            f.append(body.mass * acc[k] + ca.cross(alpha[k], h) + ca.cross(wk, ca.cross(wk, h)))
            m.append(body.I @ alpha[k] + ca.cross(wk, body.I @ wk) + ca.cross(h, acc[k]))
        tau = [None] * self.joints
        for k in reversed(range(1, len(self.bodies))):
            body, (R, p) = self.bodies[k], T[k]
            tau[k - 1] = ca.dot(body.axis, m[k] if body.is_revolute else f[k])
            if body.parent > 0 or free:
                fp = R @ f[k]
                f[body.parent] += fp
                m[body.parent] += R @ m[k] + ca.cross(p, fp)
        return ca.vertcat(*([m[0], f[0]] if free else []), *tau)

    def mass_matrix(self, q):
        T, b, M = self.placements(q), self.base, ca.SX(self.n, self.n)
        mass = [body.mass for body in self.bodies]
        h, I = [body.h for body in self.bodies], [body.I for body in self.bodies]
        for k in reversed(range(1, len(self.bodies))):
            body, (R, p) = self.bodies[k], T[k]
            s = body.axis
            m, f = (I[k] @ s, ca.cross(s, h[k])) if body.is_revolute else (ca.cross(h[k], s), mass[k] * s)
            i, row = k, b + k - 1
            M[row, row] = ca.dot(s, m if body.is_revolute else f)
            while self.bodies[i].parent > 0 or (self.is_free and i > 0):
                Ri, pi = T[i]
                f = Ri @ f
                m = Ri @ m + ca.cross(pi, f)
                i = self.bodies[i].parent
                if i == 0:
                    M[:3, row], M[row, :3], M[3:6, row], M[row, 3:6] = m, m.T, f, f.T
                    break
                other = self.bodies[i]
                M[row, b + i - 1] = M[b + i - 1, row] = ca.dot(other.axis, m if other.is_revolute else f)
            i = body.parent
            if i > 0 or self.is_free:
                hp, P = R @ h[k], ca.sparsify(ca.skew(p))
                H = ca.sparsify(ca.skew(hp))
                turned = P @ H
                I[i] += R @ I[k] @ R.T - (turned + turned.T) - mass[k] * (P @ P)
                h[i] += hp + mass[k] * p
                mass[i] += mass[k]
        if self.is_free:
            H = ca.skew(h[0])
            M[:3, :3], M[:3, 3:6], M[3:6, :3], M[3:6, 3:6] = I[0], H, H.T, mass[0] * ca.SX.eye(3)
        return ca.densify(M)

    def forward_dynamics(self, q, v, tau):
        """Articulated bodies: (m, f) = [[I, H], [Hᵀ, Q]] (α, a) + bias, with spatial accelerations."""
        T, b, zero, free = self.placements(q), self.base, ca.SX(3, 1), self.is_free
        V = [(v[:3], v[3:6]) if free else (zero, zero)]
        c, inertia, bias = [None], [], []
        for k, body in enumerate(self.bodies):
            if k > 0:
                (R, p), (wi, vi), s = T[k], V[body.parent], body.axis * v[b + k - 1]
                w, u = R.T @ wi, R.T @ (vi + ca.cross(wi, p))
                if body.is_revolute:
                    c.append((ca.cross(w, s), ca.cross(u, s)))
                    V.append((w + s, u))
                else:
                    c.append((zero, ca.cross(w, s)))
                    V.append((w, u + s))
            (w, u), h = V[k], body.h
            turn, push = body.I @ w + ca.cross(h, u), body.mass * u + ca.cross(w, h)  # momentum
            bias.append([ca.cross(w, turn) + ca.cross(u, push), ca.cross(w, push)])
            inertia.append([body.I, ca.sparsify(ca.skew(h)), body.mass * ca.SX.eye(3)])
        U, d, r = {}, {}, {}
        for k in reversed(range(1, len(self.bodies))):
            body, (R, p), (I, H, Q), (m, f) = self.bodies[k], T[k], inertia[k], bias[k]
            s = body.axis
            Um, Uf = (I @ s, H.T @ s) if body.is_revolute else (H @ s, Q @ s)
            U[k], d[k] = (Um, Uf), 1 / ca.dot(s, Um if body.is_revolute else Uf)
            r[k] = tau[b + k - 1] - ca.dot(s, m if body.is_revolute else f)
            if body.parent == 0 and not free:
                continue
            gm, gf = Um * d[k], Uf * d[k]
            I, H, Q = I - gm @ Um.T, H - gm @ Uf.T, Q - gf @ Uf.T
            cm, cf = c[k]
            m, f = m + I @ cm + H @ cf + gm * r[k], f + H.T @ cm + Q @ cf + gf * r[k]
            Q, H, P = R @ Q @ R.T, R @ H @ R.T, ca.sparsify(ca.skew(p))
            cross, up = P @ H.T, P @ Q
            parent, onto = inertia[body.parent], bias[body.parent]
            parent[0] += R @ I @ R.T + cross + cross.T - up @ P
            parent[1] += H + up
            parent[2] += Q
            f = R @ f
            onto[1] += f
            onto[0] += R @ m + ca.cross(p, f)
        g = self.gravity(q)
        if free:
            I, H, Q = inertia[0]
            A = ca.vertcat(ca.horzcat(I, H), ca.horzcat(H.T, Q))
            x = solve(A, ca.vertcat(tau[:3] - bias[0][0], tau[3:6] - bias[0][1]))
            A0, out = (x[:3], x[3:6]), [x[:3], x[3:6] - g]  # θ̈ are the rates of the body twist's numbers
        else:
            A0, out = (zero, g), []
        A = [A0]
        for k in range(1, len(self.bodies)):
            body, (R, p) = self.bodies[k], T[k]
            am, al = A[body.parent]
            am, al = R.T @ am + c[k][0], R.T @ (al + ca.cross(am, p)) + c[k][1]
            dd = d[k] * (r[k] - ca.dot(U[k][0], am) - ca.dot(U[k][1], al))
            out.append(dd)
            A.append((am + body.axis * dd, al) if body.is_revolute else (am, al + body.axis * dd))
        return ca.vertcat(*out)


def solve(M, *sides):
    """M⁻¹ of each right-hand side, by M = LDLᵀ written out."""
    n = M.shape[0]
    L, D = ca.SX.eye(n), []
    for j in range(n):
        D.append(1 / (M[j, j] - sum(L[j, k] ** 2 / D[k] for k in range(j))))
        for i in range(j + 1, n):
            L[i, j] = (M[i, j] - sum(L[i, k] * L[j, k] / D[k] for k in range(j))) * D[j]
    answers = []
    for side in sides:
        x = ca.vertsplit(ca.densify(side))
        for i in range(n):
            x[i] = x[i] - sum(L[i, k] * x[k] for k in range(i))
        x = [x[i] * D[i] for i in range(n)]
        for i in reversed(range(n)):
            x[i] = x[i] - sum(L[k, i] * x[k] for k in range(i + 1, n))
        answers.append(ca.vertcat(*x))
    return answers[0] if len(answers) == 1 else answers


def functions(robot, q, v, a, tau):
    """(mozzi's quantity, what it is called, result): matrices transposed, for CasADi writes columns."""
    inverse, bias = robot.inverse_dynamics(q, v, a), robot.inverse_dynamics(q, v, ca.SX(robot.n, 1))
    M = robot.mass_matrix(q)
    yield "inverse_dynamics", "Newton-Euler", inverse
    yield "forward_dynamics", "articulated bodies", robot.forward_dynamics(q, v, tau)
    yield "mass_matrix", "composite bodies", M
    yield "bias_forces", "Newton-Euler", bias
    if robot.n <= SHORT:
        forward = solve(M, tau - bias)
        yield "forward_dynamics", "LDL", forward
        by_q, by_v = ca.jacobian(inverse, q), ca.jacobian(inverse, v)
        yield "inverse_dynamics_derivatives", "jacobian", ca.horzcat(by_q.T, by_v.T, M)
        here = ca.substitute([by_q, by_v], [a], [forward])
        columns = solve(M, *[side[:, k] for side in here for k in range(robot.n)], *ca.horzsplit(ca.SX.eye(robot.n)))
        blocks = [ca.horzcat(*columns[k * robot.n : (k + 1) * robot.n]) for k in range(3)]
        yield "forward_dynamics_derivatives", "jacobian, LDL", ca.horzcat(-blocks[0].T, -blocks[1].T, blocks[2])


def write(name, robot, out, table):
    inputs = [ca.SX.sym(x, size) for x, size in (("q", robot.nq), ("v", robot.n), ("a", robot.n), ("tau", robot.n))]
    code = ca.CodeGenerator(f"{name}.c", {"casadi_int": "int"})
    for k, (quantity, how, result) in enumerate(functions(robot, *inputs)):
        function = ca.Function(f"{name}_{k}", inputs, [ca.cse(ca.densify(result))])
        code.add(function)
        table.append(f'FUNCTION({name}, {name}_{k}, "{quantity}", "{how}")')
        print(f"{name}: {quantity}, {how}: {function.n_instructions()} instructions", flush=True)
    code.generate(f"{out}/")


def seconds_to_first_result(robot, out, compiler):
    """From the robot's numbers to its first inverse dynamics: expressions, C, machine code, one call."""
    start = time.perf_counter()
    inputs = [ca.SX.sym(x, size) for x, size in (("q", robot.nq), ("v", robot.n), ("a", robot.n))]
    function = ca.Function("first", inputs, [ca.cse(ca.densify(robot.inverse_dynamics(*inputs)))])
    code = ca.CodeGenerator("first.c")
    code.add(function)
    code.generate(f"{out}/")
    library = out / "first.so"
    subprocess.run([*compiler, "-fPIC", "-shared", out / "first.c", "-o", library], check=True)
    ca.external("first", str(library))(*(ca.DM(x.shape[0], 1) + 0.1 for x in inputs))
    seconds = time.perf_counter() - start
    (out / "first.c").unlink()  # no part of what is timed
    return seconds


def main():
    robots, out = map(pathlib.Path, sys.argv[1:3])
    compiler = sys.argv[3:]
    table, first = [], []
    for path in sorted(robots.glob("*.txt")):
        robot = Robot(path)
        if len(robot.bodies) <= MOST_BODIES:
            write(path.stem, robot, out, table)
            first.append(f"{path.stem} {seconds_to_first_result(robot, out, compiler):.2f} s")
    head = [f'#define CASADI_VERSION "{ca.__version__}"', f'#define CASADI_FIRST "{", ".join(first)}"']
    (out / "robots.inc").write_text("\n".join([*head, *table]) + "\n")


main()
