"""Inverse kinematics (Modern Robotics, chapter 6): joint positions that place the hand at a pose. See the Rust twin."""

import mozzi
import mozzi.modern_robotics as mr
import numpy as np
from shared.agreement import agree, row

ur5 = mozzi.models.ur5()
goal, guess = ur5.forward_kinematics([0.3, -1.2, 1.4, -0.5, 0.9, 2.0]), np.array([0.0, -1.0, 1.0, 0.0, 0.5, 1.5])

# θ ← θ + J_b⁻¹ log(T⁻¹T_d), six by six
print(f"UR5, the book's Newton-Raphson by hand, from θ = [{row(guess)}]:")
theta = guess
for iteration in range(20):
    e = mr.se3ToVec(mr.MatrixLog6(np.linalg.inv(ur5.forward_kinematics(theta)) @ goal))
    print(f"  iteration {iteration}: {np.linalg.norm(e[:3]):.1e} rad, {np.linalg.norm(e[3:]):.1e} m")
    if np.linalg.norm(e) < 1e-12:
        break
    theta = theta + np.linalg.solve(ur5.body_jacobian(theta), e)
solver = mozzi.InverseKinematics(ur5)
found = solver.solve(guess, pose=goal)
print(f"by the library: {found.iterations} iterations, {found.angle:.2e} rad and {found.distance:.2e} m away")
agree("θ, by hand and by the library", found.theta, theta, 1e-7)

# from anywhere, within the limits
far = solver.solve([3.0, 2.0, -2.5, 1.0, -3.0, 0.0], pose=goal)
print(f"from afar: θ = [{row(far.theta)}], {far.starts} starts")
agree("the pose there and the goal", ur5.forward_kinematics(far.theta), goal, 1e-7)

# out of reach: a reason that says how near it came
away = np.eye(4)
away[0, 3] = 2.0
missed = solver.solve(guess, pose=away)
print("2 m away:", missed.reason)
assert not missed.reached and 1.0 < missed.distance < 2.0

# seven joints, six rows: a line of solutions
panda = mozzi.models.panda().with_locked_joints({"panda_finger_joint1": 0.02})
start, posture = np.array([0.1, 0.2, 0.1, -1.0, 0.0, 1.0, 0.0]), np.array([0.3, -0.5, 0.2, -2.0, 0.4, 1.8, 0.7])
goal = panda.forward_kinematics([0.5, -0.3, -0.4, -1.7, 0.1, 1.5, 1.0], "panda_hand")
solver = mozzi.InverseKinematics(panda, "panda_hand")
first, nearest = solver.solve(start, pose=goal), solver.solve(start, pose=goal, near=posture)
print(f"\nPanda, the hand at a pose; how far the joints are from the posture [{row(posture)}]:")
print(f"  the first solution [{row(first.theta)}]: {np.linalg.norm(first.theta - posture):.4f} rad")
print(f"  the nearest        [{row(nearest.theta)}]: {np.linalg.norm(nearest.theta - posture):.4f} rad")
assert np.linalg.norm(nearest.theta - posture) < np.linalg.norm(first.theta - posture)

# a thousand targets at once, on all cores
targets = np.stack(np.meshgrid(np.linspace(0.3, 0.6, 10), np.linspace(-0.4, 0.4, 10), np.linspace(0.1, 0.6, 10)), -1)
many = solver.solve(posture, position=targets)
print(f"\n{many.reached.sum()} of {many.reached.size} points reached")
assert many.reached.all()
assert np.allclose(panda.forward_kinematics(many.theta, "panda_hand")[..., :3, 3], targets, rtol=0, atol=1e-7)
