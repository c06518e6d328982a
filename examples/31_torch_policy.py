"""A small torque policy, trained on 4096 Furuta pendulums by the gradient of their motion (needs torch, matplotlib).

The arm's motor (joint 1) is to swing the rod (joint 2) up and to keep it up; no motor turns the rod. The policy is a
network of 32 × 32 units, u = 100 N m tanh(network(sin θ₁, cos θ₁, sin θ₂, cos θ₂, θ̇/5)). The loss is the mean over N pendulums
and T steps of

    1 − cos θ₂ + 0.05 (1 − cos θ₁) + 0.005 θ̇² + 0.02 (u/100)²

The whole motion is differentiated: every step calls `forward_dynamics`, whose pullback is `forward_dynamics_vjp`. The
robot is that of Modern Robotics, exercise 8.4 (see 03_furuta.rs). `--short` trains a few pendulums for a few rounds.
"""

# mypy: ignore-errors
# pyright: reportMissingImports=false, reportCallIssue=false

import math
import sys
import time

try:
    import matplotlib.pyplot as plt
    import torch

    import mozzi.torch
except ImportError as missing:
    print(f"skipped: {missing}; `pip install torch matplotlib` installs what it needs")
    sys.exit()

SHORT = "--short" in sys.argv
PENDULUMS, STEPS, ROUNDS = (32, 40, 15) if SHORT else (4096, 150, 300)
STEP, MOST = 0.02, 100.0

torch.set_num_threads(1)  # the pendulums have the cores; torch's own threads would wait for them
torch.manual_seed(1763)
torch.set_default_dtype(torch.float64)
robot = mozzi.torch.Model(mozzi.models.furuta_pendulum())
policy = torch.nn.Sequential(
    torch.nn.Linear(6, 32), torch.nn.Tanh(), torch.nn.Linear(32, 32), torch.nn.Tanh(), torch.nn.Linear(32, 1)
)


def torque(theta, dtheta):
    u = MOST * torch.tanh(policy(torch.cat([theta.sin(), theta.cos(), dtheta / 5], -1)))
    return torch.cat([u, torch.zeros_like(u)], -1)


def starts(count):
    """Anywhere, slow."""
    theta = math.pi * (2 * torch.rand(count, 2) - 1)
    return theta, torch.randn(count, 2)


def motion(theta, dtheta, steps):
    """The states and torques by the semi-implicit Euler method."""
    rows = []
    for _ in range(steps):
        tau = torque(theta, dtheta)
        dtheta = dtheta + STEP * robot.forward_dynamics(theta, dtheta, tau)
        theta = theta + STEP * dtheta
        rows.append((theta, dtheta, tau))
    return map(torch.stack, zip(*rows))


def loss(theta, dtheta, tau):
    height, turn = 1 - theta.cos()[..., 1], 1 - theta.cos()[..., 0]
    return (height + 0.05 * turn + 0.005 * dtheta.square().sum(-1) + 0.02 * (tau[..., 0] / MOST).square()).mean()


optimizer = torch.optim.Adam(policy.parameters(), lr=3e-3)
schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimizer, ROUNDS)
losses, began = [], time.perf_counter()
for k in range(ROUNDS):
    optimizer.zero_grad()
    now = loss(*motion(*starts(PENDULUMS), STEPS))
    now.backward()
    torch.nn.utils.clip_grad_norm_(policy.parameters(), 1.0)
    optimizer.step()
    schedule.step()
    losses.append(now.item())
    if k % (ROUNDS // 10 or 1) == 0 or k == ROUNDS - 1:
        print(f"round {k:3}: loss {losses[-1]:.4f}, {time.perf_counter() - began:6.1f} s", flush=True)
seconds = (time.perf_counter() - began) / ROUNDS
each = 1e6 * seconds / (PENDULUMS * STEPS)
print(f"{PENDULUMS} pendulums, {STEPS} steps, forward and backward: {seconds:.2f} s a round, {each:.2f} µs a step")

# the gradient against a difference along itself
some = [x[:16] for x in starts(16)]
direction = torch.autograd.grad(loss(*motion(*some, STEPS)), list(policy.parameters()))
norm, h = math.sqrt(sum(g.square().sum().item() for g in direction)), 1e-6
found = []
with torch.no_grad():
    for sign in (1, -2):
        for weights, g in zip(policy.parameters(), direction):
            weights += sign * h / norm * g
        found.append(loss(*motion(*some, STEPS)).item())
    difference = (found[0] - found[1]) / (2 * h)
print(f"slope of the loss along its gradient: {norm:.6f}, by a difference {difference:.6f}")
assert abs(difference - norm) < 1e-4 * max(1.0, norm)

# pendulums that the policy has not seen, hanging or anywhere, for twice the time
with torch.no_grad():
    theta, dtheta = starts(64)
    theta[0], dtheta[0] = torch.tensor([0.0, math.pi - 0.01]), 0.0
    theta, dtheta, tau = motion(theta, dtheta, 2 * STEPS)
standing = (theta[-1, :, 1].cos() > math.cos(math.radians(10))).double().mean().item()
print(f"{100 * standing:.0f} % of 64 new pendulums stand within 10° after {2 * STEPS * STEP:g} s")
assert SHORT or sum(losses[-10:]) < sum(losses[:10]), "the policy learns"

t = STEP * torch.arange(1, 2 * STEPS + 1)
figure, axes = plt.subplots(3, 1, figsize=(7, 8), constrained_layout=True)
axes[0].semilogy(losses)
axes[0].set(xlabel="round", ylabel="loss", title=f"a torque policy trained on {PENDULUMS} Furuta pendulums")
height = theta.cos()[..., 1]
axes[1].plot(t, height[:, 1:], color="#8a8a8a", linewidth=0.4)
axes[1].plot(t, height[:, 0], color="#1f5fa8", label="from hanging")
axes[1].set(xlabel="t (s)", ylabel="cos θ₂, 1 is upright", title="64 pendulums that it has not seen")
axes[1].legend(loc="lower right")
axes[2].plot(t, tau[:, 0, 0], color="#c0392b")
axes[2].set(xlabel="t (s)", ylabel="τ₁ (N m)", title="the torque from hanging")
figure.savefig("torch_policy.svg")
print("drawn in torch_policy.svg")
