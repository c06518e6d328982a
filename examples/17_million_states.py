"""A million inverse dynamics of a Panda in one call, on all cores; and with machine code made for it."""

import time

import mozzi
import numpy as np

panda, random = mozzi.models.panda(), np.random.default_rng(1)
theta, dtheta, ddtheta = random.uniform(-1, 1, (3, 1_000_000, panda.n))
tau = np.empty_like(theta)

for name, robot in [("kernels", panda), ("machine code", panda.compile("inverse_dynamics"))]:
    start = time.perf_counter()
    robot.inverse_dynamics(theta, dtheta, ddtheta, out=tau)
    seconds = time.perf_counter() - start
    print(f"{name}: {len(tau) / seconds / 1e6:.1f} million states a second")
    for k in random.integers(len(tau), size=5):
        assert np.allclose(tau[k], panda.inverse_dynamics(theta[k], dtheta[k], ddtheta[k]), rtol=0, atol=1e-11)
