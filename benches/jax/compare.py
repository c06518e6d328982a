"""Times of `mozzi.jax` on a UR5, next to an empty `jit`, to the package's own calls, and to MJX on the CPU.

    pip install jax mujoco-mjx, and a release wheel of mozzi; then:
    python benches/jax/compare.py > benches/jax/RESULTS.md

Everything is compared with mozzi's result before it is timed, and the runners take turns; each figure is the least
of all rounds.
"""

import platform
import sys
import time
from pathlib import Path

import jax
import jax.numpy as jnp
import mozzi
import mozzi.jax
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from race import race

URDF = Path(__file__).parents[2] / "crates/mozzi-urdf/models/ur5.urdf"
ur5 = mozzi.models.ur5()
random = np.random.default_rng(1763)


def states(count, dtype):
    return [jnp.asarray(random.uniform(-1, 1, (count, 6)), dtype) for _ in range(3)]


def calls(dtype):
    print(
        f"| {jnp.dtype(dtype).name}, µs a call | jit of a + b | package | jit | gradient | in a loop |\n|---|---|---|---|---|---|"
    )
    for name in ("inverse_dynamics", "forward_dynamics"):
        f = lambda *x: getattr(mozzi.jax, name)(ur5, *x)  # noqa: B023, used in this round alone
        for count in (1, 10, 4096):
            x = states(count, dtype)
            as_numpy, method = [np.asarray(a) for a in x], getattr(ur5, name)
            value, add = jax.jit(f), jax.jit(lambda a, b: a + b)
            gradient = jax.jit(jax.grad(lambda *x: (x[1] * f(*x)).sum(), (0, 1, 2)))  # noqa: B023
            turns = 1000 if count < 100 else 10
            loop = jax.jit(lambda a, b, c: jax.lax.fori_loop(0, turns, lambda _, y: f(a, b, y) * 1e-3, c))  # noqa: B023
            assert np.abs(value(*x) - method(*as_numpy)).max() < 1e-4 * np.abs(method(*as_numpy)).max()
            times = race(
                [
                    lambda: add(x[0], x[1]),
                    lambda: method(*as_numpy),
                    lambda: value(*x),
                    lambda: gradient(*x),
                    lambda: loop(*x),
                ]
            )
            times[-1] /= turns
            print(f"| {name}, N = {count} |", " | ".join(f"{1e6 * t:.1f}" for t in times), "|")
    print()


def beside_mjx(count=4096):
    import mujoco
    from mujoco import mjx

    model = mujoco.MjModel.from_xml_string(URDF.read_text())
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    model.opt.gravity[:] = ur5.gravity
    model.dof_damping[:], model.dof_frictionloss[:], model.dof_armature[:] = 0.0, 0.0, 0.0
    on_mjx, data = mjx.put_model(model), mjx.put_data(model, mujoco.MjData(model))
    x = states(count, jnp.float32)
    inverse = jax.vmap(lambda q, v, a: mjx.inverse(on_mjx, data.replace(qpos=q, qvel=v, qacc=a)).qfrc_inverse)
    forward = jax.vmap(lambda q, v, tau: mjx.forward(on_mjx, data.replace(qpos=q, qvel=v, qfrc_applied=tau)).qacc)
    print(
        f"| float32, {count} states, ns a state | MJX {mujoco.__version__} | mozzi.jax | MJX's time over mozzi's |\n|---|---|---|---|"
    )
    for name, theirs in (("inverse_dynamics", inverse), ("forward_dynamics", forward)):
        ours = lambda *x: getattr(mozzi.jax, name)(ur5, *x)  # noqa: B023
        for kind in ("value", "gradient"):
            pair = []
            for f in (theirs, ours):
                g = f if kind == "value" else jax.grad(lambda *x, f=f: (x[1] * f(*x)).sum(), (0, 1, 2))
                pair.append(jax.jit(g))
            found, expected = (np.concatenate(jax.tree.leaves(f(*x)), -1) for f in pair)
            error = np.abs(found - expected).max() / np.abs(expected).max()
            assert error < 1e-3, f"{name}, {kind}: results differ by {error}"
            a, b = race([lambda: pair[0](*x), lambda: pair[1](*x)], rounds=5)  # noqa: B023
            print(f"| {name}, {kind} | {1e9 * a / count:.0f} | {1e9 * b / count:.0f} | **{a / b:.0f}** |", flush=True)


print(
    f"# JAX\n\n`python benches/jax/compare.py`, {time.strftime('%Y-%m-%d')}, {platform.processor() or platform.machine()},"
)
print(
    f"jax {jax.__version__}, mozzi {mozzi.__version__}, a UR5 of {jax.device_count()} CPU device. Least of all rounds.\n"
)
beside_mjx()
print("\nMJX does more than Newton-Euler, and is made for accelerators. Contacts and constraints are off.\n")
calls(jnp.float32)
jax.config.update("jax_enable_x64", True)
calls(jnp.float64)
