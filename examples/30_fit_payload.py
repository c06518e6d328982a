"""A payload from measured torques, by gradient: its mass and its place on the tool, in JAX. Needs `pip install jax`."""

import sys

import mozzi
import numpy as np

try:
    import jax
    import jax.numpy as jnp
    import mozzi.jax
except ImportError as error:
    print("skipped:", error)
    sys.exit()

jax.config.update("jax_enable_x64", True)  # type: ignore[no-untyped-call]
ur5 = mozzi.models.ur5()
first = list(ur5.parameter_names).index("wrist_3_link.m")
own = jnp.asarray(ur5.parameters)


def with_payload(payload: jax.Array) -> jax.Array:
    """π with a point mass m at c in the last link's frame: (m, mc, −m[c]²) more, which is I_xx, I_xy, I_xz, I_yy, I_yz, I_zz."""
    m, (x, y, z) = payload[0], payload[1:]
    I = jnp.stack([y * y + z * z, -x * y, -x * z, x * x + z * z, -y * z, x * x + y * y])
    return own.at[first : first + 10].add(m * jnp.concatenate([jnp.stack([jnp.ones(()), x, y, z]), I]))


# a motion that shakes the payload, and torques measured with noise of 0.05 N m
random = np.random.default_rng(1763)
theta, dtheta, ddtheta = (scale * random.uniform(-1, 1, (200, 6)) for scale in (3.0, 2.0, 10.0))
true = jnp.array([1.8, 0.03, -0.05, 0.12])
clean = mozzi.jax.inverse_dynamics(ur5, theta, dtheta, ddtheta, parameters=with_payload(true))
measured = clean + 0.05 * random.normal(size=clean.shape)


def loss(payload: jax.Array) -> jax.Array:
    tau = mozzi.jax.inverse_dynamics(ur5, theta, dtheta, ddtheta, parameters=with_payload(payload))
    return ((tau - measured) ** 2).sum()


# Newton's method with JAX's derivatives: ∂τ/∂π = Y, and π is not linear in the place of the mass
value_and_gradient, hessian = jax.jit(jax.value_and_grad(loss)), jax.jit(jax.hessian(loss))
payload = jnp.array([1.0, 0.0, 0.0, 0.05])
for iteration in range(20):
    value, gradient = value_and_gradient(payload)
    print(f"{iteration:2}: squares {float(value):10.4f}  m = {float(payload[0]):.4f} kg, c =", np.round(payload[1:], 4), "m")
    H = hessian(payload)
    smallest = jnp.linalg.eigvalsh(H)[0]
    step = jnp.linalg.solve(H + jnp.maximum(0.0, 1e-3 - smallest) * jnp.eye(4), gradient)
    payload = payload - step
    if float(jnp.abs(step).max()) < 1e-9:
        break

# noise of 0.05 N m in 1200 torques leaves a few grams and tenths of a millimetre
assert abs(float(payload[0] - true[0])) < 0.01 and float(jnp.abs(payload[1:] - true[1:]).max()) < 1e-3
assert float(loss(payload)) < 1.05 * float(loss(true))
