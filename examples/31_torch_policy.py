"""A small torque policy, trained on 4096 Furuta pendulums by the gradient of their motion (needs torch, matplotlib).

The arm's motor (joint 1) is to catch the rod (joint 2) within 18° of upright and to balance it; no motor turns the rod.
The policy is a network of 32 × 32 units, u = 300 N m tanh(network(2 sin θ, 2 cos θ, 2 θ̇)). The loss is the mean over N
pendulums and T steps of

    1 − cos θ₂ + 0.02 (1 − cos θ₁) + 0.005 s/(1 + 0.05 s) + 0.002 (u/300)²,  s = |θ̇|²

The whole motion is differentiated: every step calls `forward_dynamics`, whose pullback is `forward_dynamics_vjp`. T
grows from 20 to 80 steps while the policy learns: gradients through a long fall explode. The robot is that of Modern
Robotics, exercise 8.4 (see 03_furuta.rs). `--short` trains a few pendulums for a few rounds.
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
PENDULUMS, STEPS, ROUNDS = (32, 40, 15) if SHORT else (4096, 80, 400)
STEP, MOST, TILT = 0.04, 300.0, 0.1 * math.pi

torch.set_num_threads(1)  # the pendulums have the cores; torch's own threads would wait for them
torch.manual_seed(1763)
torch.set_default_dtype(torch.float64)
robot = mozzi.torch.Model(mozzi.models.furuta_pendulum())
policy = torch.nn.Sequential(
    torch.nn.Linear(6, 32), torch.nn.Tanh(), torch.nn.Linear(32, 32), torch.nn.Tanh(), torch.nn.Linear(32, 1)
)


def torque(theta, dtheta):
    u = MOST * torch.tanh(policy(torch.cat([2 * theta.sin(), 2 * theta.cos(), 2 * dtheta], -1)))
    return torch.cat([u, torch.zeros_like(u)], -1)


def starts(count, tilt=TILT):
    """Angles up to `tilt`, slow."""
    return tilt * (2 * torch.rand(count, 2) - 1), 0.1 * torch.randn(count, 2)


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
    height, turn, speed = 1 - theta.cos()[..., 1], 1 - theta.cos()[..., 0], dtheta.square().sum(-1)
    effort = (tau[..., 0] / MOST).square()
    return (height + 0.02 * turn + 0.005 * speed / (1 + 0.05 * speed) + 0.002 * effort).mean()


optimizer = torch.optim.Adam(policy.parameters(), lr=1e-2)
schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimizer, ROUNDS)
losses, passed, began = [], 0, time.perf_counter()
for k in range(ROUNDS):
    steps = min(STEPS, 20 + int(1.5 * STEPS * k / ROUNDS))
    passed += steps
    optimizer.zero_grad()
    now = loss(*motion(*starts(PENDULUMS), steps))
    now.backward()
    if torch.nn.utils.clip_grad_norm_(policy.parameters(), 1.0).isfinite():
        optimizer.step()
    schedule.step()
    losses.append(now.item())
    if k % (ROUNDS // 10 or 1) == 0 or k == ROUNDS - 1:
        print(f"round {k:3}: loss {losses[-1]:.4f}, {time.perf_counter() - began:6.1f} s", flush=True)
seconds = time.perf_counter() - began
each = 1e6 * seconds / (PENDULUMS * passed)
print(f"{PENDULUMS} pendulums, {passed} steps, forward and backward: {seconds:.0f} s, {each:.2f} µs a step")

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

# pendulums that the policy has not seen, for three times the time
with torch.no_grad():
    for tilt in (0.3 * math.pi, TILT):
        theta, dtheta, tau = motion(*starts(64, tilt), 3 * STEPS)
        standing = (theta[-1, :, 1].cos() > math.cos(math.radians(10))).double().mean().item()
        within = f"starts within {math.degrees(tilt):.0f}°"
        print(f"{100 * standing:.0f} % of 64 new {within} stand within 10° after {3 * STEPS * STEP:g} s")
assert SHORT or standing >= 0.9, "the policy balances the pendulums"

t = STEP * torch.arange(1, 3 * STEPS + 1)
figure, axes = plt.subplots(3, 1, figsize=(7, 8), constrained_layout=True)
axes[0].semilogy(losses)
axes[0].set(xlabel="round", ylabel="loss", title=f"a torque policy trained on {PENDULUMS} Furuta pendulums")
axes[1].plot(t, theta[..., 1].rad2deg(), color="#8a8a8a", linewidth=0.4)
axes[1].plot(t, theta[:, 0, 1].rad2deg(), color="#1f5fa8", label="the first")
axes[1].set(xlabel="t (s)", ylabel="θ₂ (°), 0 is upright", title="64 pendulums that it has not seen")
axes[1].legend(loc="lower right")
axes[2].plot(t, tau[:, 0, 0], color="#c0392b")
axes[2].set(xlabel="t (s)", ylabel="τ₁ (N m)", title="the torque on the first")
figure.savefig("torch_policy.svg")
print("drawn in torch_policy.svg")
