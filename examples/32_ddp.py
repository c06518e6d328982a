"""Differential dynamic programming on the UR5, with exact second derivatives, and iLQR, which leaves them out.

Each iteration (Mayne 1966; Tassa, Mansard and Todorov 2014) needs the derivatives of every step of the motion. They
come from two calls for all steps at once: ∂θ̈ by `forward_dynamics_derivatives`, and the second derivatives of vᵀθ̈, v the
slope of the cost-to-go, by `jvp` of `forward_dynamics_vjp`, one Hessian-vector product for each of the 18 directions of
(θ, θ̇, τ).

Semi-implicit Euler steps, θ̇' = θ̇ + hθ̈, θ' = θ + hθ̇'. The cost: ½R‖τ − g‖² along the way, g the torque that holds
the start, and the distance from a pose at rest at the end.
"""

import sys
import time

from typing import Any

import mozzi
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

N, H, R = 80, 0.01, 1e-4
END = np.concatenate([np.full(6, 1e3), np.full(6, 1e2)])
ur5 = mozzi.models.ur5()
n = ur5.n
start = np.zeros(2 * n)
start[:n] = [0, -1.2, 1.5, 0.3, 1.1, 0]
goal = np.zeros(2 * n)
goal[:n] = [1.4, -0.6, 0.4, 1.2, -0.8, 0.7]
hold = ur5.gravity_forces(start[:n])


def follow(tau: Array, policy: tuple[Array, Array, Array] | None = None, part: float = 1.0) -> tuple[Array, Array]:
    """The motion under torques, or under their change by a policy: the motion x, a change and gains on δx."""
    found, used = [start], []
    for k in range(N):
        now, u = found[-1], tau[k]
        if policy is not None:
            x, change, gains = policy
            u = u + part * change[k] + gains[k] @ (now - x[k])
        ddtheta = ur5.forward_dynamics(now[:n], now[n:], u)
        dtheta = now[n:] + H * ddtheta
        found.append(np.concatenate([now[:n] + H * dtheta, dtheta]))
        used.append(u)
    return np.array(found), np.array(used)


def cost(x: Array, tau: Array) -> float:
    return float(0.5 * R * np.sum((tau - hold) ** 2) + 0.5 * np.sum(END * (x[-1] - goal) ** 2))


def steps(x: Array, tau: Array) -> tuple[Array, Array]:
    """∂f/∂x and ∂f/∂τ of every step."""
    found = ur5.forward_dynamics_derivatives(x[:-1, :n], x[:-1, n:], tau)
    by_x = np.concatenate([found.d_theta, found.d_dtheta], axis=2)
    A = np.tile(np.eye(2 * n), (N, 1, 1))
    A[:, :n, n:] += H * np.eye(n)
    A[:, :n] += H * H * by_x
    A[:, n:] += H * by_x
    return A, np.concatenate([H * H * found.d_tau, H * found.d_tau], axis=1)


def hessians(x: Array, tau: Array, v: Array) -> Array:
    """The second derivatives of (h² v_θ + h v_θ̇)ᵀθ̈ at each step, 18 × 18."""
    weights = H * H * v[:, :n] + H * v[:, n:]
    unit = np.eye(3 * n).reshape(3, n, 3 * n).transpose(0, 2, 1)[:, None]  # inputs, 1, directions, entries
    inputs: Any = [table[:, None] for table in (x[:-1, :n], x[:-1, n:], tau, weights)]
    _, rates = ur5.jvp("forward_dynamics_vjp", inputs, [*unit, None])
    return np.concatenate([rates.d_theta, rates.d_dtheta, rates.d_tau], axis=2)


def improve(x: Array, tau: Array, second: bool, damping: float) -> tuple[Array, Array, Array] | None:
    """The change of each torque, its feedback, and the gradient by the torques; None if damping is too small."""
    A, B = steps(x, tau)
    slopes = [END * (x[-1] - goal)]  # of the cost by the state: the adjoint, backwards
    for k in reversed(range(N)):
        slopes.append(A[k].T @ slopes[-1])
    slope = np.array(slopes[::-1])
    gradient = R * (tau - hold) + np.einsum("kij,ki->kj", B, slope[1:])
    # DDP takes the second derivatives at the slope of its own cost-to-go; near the optimum it is this one
    S = hessians(x, tau, slope[1:]) if second else np.zeros((N, 3 * n, 3 * n))
    v, V = END * (x[-1] - goal), np.diag(END)
    change, gains = np.empty((N, n)), np.empty((N, n, 2 * n))
    for k in reversed(range(N)):
        Q_x, Q_u = A[k].T @ v, R * (tau[k] - hold) + B[k].T @ v
        Q_xx = A[k].T @ V @ A[k] + S[k, : 2 * n, : 2 * n]
        Q_ux = B[k].T @ V @ A[k] + S[k, 2 * n :, : 2 * n]
        Q_uu = R * np.eye(n) + B[k].T @ V @ B[k] + S[k, 2 * n :, 2 * n :]
        damped = Q_uu + damping * R * np.eye(n)
        if np.linalg.eigvalsh(damped)[0] <= 1e-3 * R:
            return None
        change[k], gains[k] = -np.linalg.solve(damped, Q_u), -np.linalg.solve(damped, Q_ux)
        cross = gains[k].T @ Q_ux
        v = Q_x + gains[k].T @ (Q_uu @ change[k] + Q_u) + Q_ux.T @ change[k]
        V = Q_xx + gains[k].T @ Q_uu @ gains[k] + cross + cross.T
        V = 0.5 * (V + V.T)
    return change, gains, gradient


def solve(second: bool) -> tuple[Array, Array, list[float], list[float], float]:
    """Far from the goal second derivatives are indefinite: DDP begins as iLQR."""
    x, tau = follow(np.tile(hold, (N, 1)))
    costs, damping, began = [cost(x, tau)], 1.0, time.perf_counter()
    slopes: list[float] = []
    while len(costs) < 100 and damping < 1e10:
        is_near = len(slopes) > 0 and slopes[-1] < 1e-2
        found = improve(x, tau, second and is_near, damping)
        if found is None:
            damping = max(10 * damping, 1e-3)
            continue
        change, gains, gradient = found
        slopes.append(float(np.linalg.norm(gradient)))
        if slopes[-1] < 1e-8:
            break
        for part in 0.5 ** np.arange(8):
            tried = follow(tau, (x, change, gains), part)
            if cost(*tried) < costs[-1]:
                x, tau = tried
                costs.append(cost(x, tau))
                damping = damping / 10 if damping > 1e-6 else 0.0
                break
        else:
            if slopes[-1] < 1e-7:
                break  # at rounding
            damping = max(10 * damping, 1e-3)
    return x, tau, costs, slopes, time.perf_counter() - began


found = {name: solve(name == "DDP") for name in ["DDP", "iLQR"]}
for name, (x, tau, costs, slopes, seconds) in found.items():
    print(f"{name}: {len(slopes)} iterations, {seconds / len(slopes) * 1e3:.1f} ms each, cost {costs[-1]:.9f}")
    print("    ‖∂cost/∂τ‖ at the last:", " ".join(f"{slope:.1e}" for slope in slopes[-5:]))
    print(f"    from the goal: {np.abs(x[-1] - goal)[:n].max():.1e} rad, {np.abs(x[-1] - goal)[n:].max():.1e} rad/s")

# the gradient, by differences of the cost along a direction
x, tau = follow(np.tile(hold, (N, 1)))
first = improve(x, tau, False, 1e3)
assert first is not None
gradient = first[2]
along = np.random.default_rng(1).standard_normal(tau.shape)
difference = (cost(*follow(tau + 1e-4 * along)) - cost(*follow(tau - 1e-4 * along))) / 2e-4
assert abs(difference - np.sum(gradient * along)) < 1e-6 * np.linalg.norm(gradient), "the gradient is exact"
of_ddp, steep = found["DDP"][2:4]
of_ilqr, shallow = found["iLQR"][2:4]
assert abs(of_ddp[-1] - of_ilqr[-1]) < 1e-6 * of_ddp[-1], "both find the same motion"
assert min(steep) < 1e-7, "DDP converges"
assert len(steep) < len(shallow), "with second derivatives in fewer iterations"

if len(sys.argv) > 1:  # the name of a picture
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), constrained_layout=True)
    for name, solution in found.items():
        left.semilogy(solution[3], marker=".", label=name)
    left.set(xlabel="iteration", ylabel="‖∂cost/∂τ‖", title="Convergence")
    left.legend()
    right.plot(H * np.arange(N + 1), found["DDP"][0][:, :n])
    right.set(xlabel="t [s]", ylabel="θ [rad]", title="The motion")
    figure.savefig(sys.argv[1])
