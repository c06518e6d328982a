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
    """π with a point mass m at c in the last link's frame: (m, mc, −m[c]²) more; −m[c]² is I_xx, I_xy, …."""
    m, (x, y, z) = payload[0], payload[1:]
    I = jnp.stack([y * y + z * z, -x * y, -x * z, x * x + z * z, -y * z, x * x + y * y])
    return own.at[first : first + 10].add(m * jnp.concatenate([jnp.stack([jnp.ones(()), x, y, z]), I]))


# a motion that shakes the payload, and torques measured with noise of 0.05 N m
random = np.random.default_rng(1763)
theta, dtheta, ddtheta = (scale * random.uniform(-1, 1, (200, 6)) for scale in (3.0, 2.0, 10.0))
true = jnp.array([1.8, 0.03, -0.05, 0.12])
clean = mozzi.jax.inverse_dynamics(ur5, theta, dtheta, ddtheta, parameters=with_payload(true))
measured = clean + 0.05 * random.normal(size=clean.shape)


def errors(payload: jax.Array) -> jax.Array:
    tau = mozzi.jax.inverse_dynamics(ur5, theta, dtheta, ddtheta, parameters=with_payload(payload))
    return (tau - measured).ravel()


def loss(payload: jax.Array) -> jax.Array:
    return 0.5 * (errors(payload) ** 2).sum()


# Levenberg and Marquardt's method: the gradient in reverse mode, by wᵀY; the Jacobian along four directions, forward
value_and_gradient, jacobian = jax.jit(jax.value_and_grad(loss)), jax.jit(jax.jacfwd(errors))
payload, damping = jnp.array([1.0, 0.0, 0.0, 0.05]), 1e-3
value, gradient = value_and_gradient(payload)
for iteration in range(50):
    print(
        f"{iteration:2}: loss {float(value):10.4f}  m = {float(payload[0]):.4f} kg, c =", np.round(payload[1:], 4), "m"
    )
    J = jacobian(payload)
    H = J.T @ J
    step = jnp.linalg.solve(H + damping * jnp.diag(jnp.diag(H)), gradient)
    lower, next_gradient = value_and_gradient(payload - step)
    if lower < value:
        payload, value, gradient, damping = payload - step, lower, next_gradient, damping / 10.0
    else:
        damping *= 10.0
    if float(jnp.abs(step).max()) < 1e-9:
        break

# noise of 0.05 N m in 1200 torques leaves a few grams and tenths of a millimetre
assert abs(float(payload[0] - true[0])) < 0.01 and float(jnp.abs(payload[1:] - true[1:]).max()) < 1e-3
assert float(loss(payload)) < 1.05 * float(loss(true))
