"""States a second of frax (JAX), MuJoCo Warp and mozzi in one process, on arrays (N, n) of the device.

    pip install "jax[cuda13]" frax mujoco-warp, and a release wheel of mozzi; then:
    python benches/gpu/peers.py [--states 4096,65536,1048576]

`cargo xtask gpu-bench` runs it and adds the table to benches/GPU.md if `MOZZI_GPU_PYTHON` names this Python. Without a
GPU it runs on the CPU, to test itself. All numbers are f32. Each result is compared with mozzi's on the CPU in f64
before it is timed; the runners take turns, and each figure is the least of all rounds.
"""

import argparse
import contextlib
import importlib.metadata
import importlib.util
import os
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

os.environ.setdefault("XLA_PYTHON_CLIENT_PREALLOCATE", "false")  # Warp needs memory, too

import jax

jax.config.update("jax_default_matmul_precision", "highest")  # else frax multiplies in TF32
import jax.numpy as jnp
import mozzi
import mozzi.jax
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from race import race

MODELS = Path(__file__).parents[2] / "crates/mozzi-urdf/models"
CHECKED = 100
# the quantities, and how many arrays each takes of θ, θ̇, θ̈ or τ, x
INPUTS = {"inverse_dynamics": 3, "forward_dynamics": 3, "mass_matrix": 1, "inverse_dynamics_vjp": 4}


def robots():
    """The text of each, with fixed fingers: every library reads the same."""
    panda = ElementTree.parse(MODELS / "panda.urdf").getroot()
    for joint in panda.findall("joint[@type='prismatic']"):
        joint.set("type", "fixed")
        for child in [child for child in joint if child.tag in ("axis", "limit", "mimic")]:
            joint.remove(child)
    return {"UR5": (MODELS / "ur5.urdf").read_text(), "Panda, 7 joints": ElementTree.tostring(panda, "unicode")}


def of_mozzi(model, _urdf, arrays):
    def tau(*x):
        return mozzi.jax.inverse_dynamics(model, *x)

    functions = {
        "inverse_dynamics": tau,
        "forward_dynamics": lambda *x: mozzi.jax.forward_dynamics(model, *x),
        "mass_matrix": lambda theta: mozzi.jax.mass_matrix(model, theta),
        "inverse_dynamics_vjp": vjp(tau),
    }
    return jitted(functions, arrays)


def of_frax(_model, urdf, arrays):
    import frax

    robot = frax.Robot(str(urdf))
    up = jnp.array([0.0, 0.0, 9.81, 0.0, 0.0, 0.0])

    def tau(theta, dtheta, ddtheta):
        return robot.rnea(theta, dtheta, ddtheta, up, None)

    functions = {
        "inverse_dynamics": tau,
        "forward_dynamics": lambda *x: robot.forward_dynamics(*x, None),
        "mass_matrix": robot.crba,
        "inverse_dynamics_vjp": vjp(tau),
    }
    return jitted({name: jax.vmap(function) for name, function in functions.items()}, arrays)


def vjp(tau):
    return lambda *x: jax.vjp(tau, *x[:3])[1](x[3])


def jitted(functions, arrays):
    def runner(name):
        run, inputs = jax.jit(functions[name]), arrays[: INPUTS[name]]
        return lambda: jax.block_until_ready(run(*inputs))

    return {name: runner(name) for name in functions}


def of_warp(_model, urdf, arrays):
    """The stages that a quantity needs, on a GPU as one CUDA graph. Its data hold everything of a step."""
    import mujoco
    import mujoco_warp
    import warp

    specification = mujoco.MjSpec.from_string(urdf.read_text())
    specification.option.gravity = [0, 0, -9.81]
    compiled = specification.compile()
    count = len(arrays[0])
    model, data = mujoco_warp.put_model(compiled), mujoco_warp.make_data(compiled, nworld=count, nconmax=1, njmax=1)
    theta, dtheta, ddtheta = (np.asarray(x) for x in arrays[:3])
    data.qpos.assign(theta), data.qvel.assign(dtheta)
    n = model.nv

    def position():
        mujoco_warp.kinematics(model, data)
        mujoco_warp.com_pos(model, data)

    def torques():
        position()
        mujoco_warp.com_vel(model, data)
        mujoco_warp.rne(model, data, flg_acc=True)

    def accelerations():
        position()
        mujoco_warp.crb(model, data)
        mujoco_warp.factor_m(model, data)
        mujoco_warp.com_vel(model, data)
        mujoco_warp.rne(model, data)
        data.qfrc_passive.zero_(), data.qfrc_actuator.zero_()
        mujoco_warp.fwd_acceleration(model, data)

    def inertia():
        position()
        mujoco_warp.crb(model, data)

    def runner(stage, prepare, found):
        prepare()
        if not warp.get_device().is_cuda:
            return lambda: (stage(), found())[1]
        stage()  # compiles
        with warp.ScopedCapture() as capture:
            stage()

        def run():
            warp.capture_launch(capture.graph)
            warp.synchronize()
            return found()

        return run

    return {
        "inverse_dynamics": runner(torques, lambda: data.qacc.assign(ddtheta), lambda: data.qfrc_bias),
        "forward_dynamics": runner(accelerations, lambda: data.qfrc_applied.assign(ddtheta), lambda: data.qacc_smooth),
        "mass_matrix": runner(inertia, lambda: None, lambda: Dense(data, n, compiled)),
    }


class Dense:
    """MuJoCo's inertia as full matrices, for the comparison alone."""

    def __init__(self, data, n, model):
        self.data, self.n, self.model = data, n, model

    def __array__(self, dtype=None, copy=None):
        import mujoco

        packed = self.data.M.numpy().reshape(self.data.nworld, -1)[:CHECKED]
        if packed.shape[1] == self.n * self.n:
            return packed.reshape(-1, self.n, self.n)
        full, all_rows = np.zeros((self.n, self.n)), []
        for row in packed[:, : self.model.nM]:
            mujoco.mju_sym2dense(
                full, row.astype(np.float64), self.model.M_rownnz, self.model.M_rowadr, self.model.M_colind
            )
            all_rows.append(full.copy())
        return np.stack(all_rows)


# the libraries: module, and its runners
PEERS = {"mozzi.jax": ("mozzi", of_mozzi), "frax": ("frax", of_frax), "MuJoCo Warp": ("mujoco_warp", of_warp)}


def expected(model, name, rows):
    rows = [np.asarray(x[:CHECKED], np.float64) for x in rows]
    found = getattr(model, name)(*rows)
    return np.concatenate(found, 1) if name == "inverse_dynamics_vjp" else found


def error(found, reference):
    """The largest, relative to a state's largest entry, in ε of f32."""
    if isinstance(found, tuple):
        found = np.concatenate([np.asarray(x) for x in found], 1)
    else:
        found = found.numpy() if hasattr(found, "numpy") else np.asarray(found)
    found, reference = (np.asarray(x)[:CHECKED].reshape(CHECKED, -1) for x in (found, reference))
    size = np.abs(reference).max(1)
    return (np.abs(found - reference).max(1) / size).max() / np.finfo(np.float32).eps


def of_each(what, libraries, function):
    """The function of each library's value, without those that fail, as with too little memory."""
    found = {}
    for name, x in libraries.items():
        try:
            found[name] = function(x)
        except Exception as failure:
            print(f"{name}, {what}: {type(failure).__name__}: {failure}", file=sys.stderr)
    return found


def main(page):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--states", default="4096,65536,1048576", help="states in an array, several by commas")
    counts = [int(count) for count in parser.parse_args().states.split(",")]
    if min(counts) < CHECKED:
        parser.error(f"--states: at least {CHECKED}, the number of states that are checked")
    there = {name: peer for name, peer in PEERS.items() if importlib.util.find_spec(peer[0])}
    versions = ", ".join(f"{name} {importlib.metadata.version(module)}" for name, (module, _) in there.items())
    device = jax.devices()[0]
    print(f"\n## Beside other libraries\n\nWritten by benches/gpu/peers.py on {device.device_kind}, JAX {jax.__version__}: {versions}.", file=page)
    print("f32, arrays (N, n) of the device, 10⁹ states a second, the least time of all rounds, a call's launch and the wait for it", file=page)
    print("included; in brackets the error in ε. MuJoCo Warp runs the stages that the quantity needs, as one CUDA graph.", file=page)
    random = np.random.default_rng(1763)
    with tempfile.TemporaryDirectory() as folder:
        for robot, text in robots().items():
            model = mozzi.Model.from_urdf_string(text)
            print(f"\n### {robot}\n\n| quantity | states |", " | ".join(there), "|\n|---|---|" + "---|" * len(there), file=page)
            urdf = Path(folder) / "robot.urdf"
            urdf.write_text(text)
            for count in counts:
                arrays = [jnp.asarray(random.uniform(-1, 1, (count, model.n)), jnp.float32) for _ in range(4)]
                made = of_each(f"{robot}, {count} states", there, lambda peer: peer[1](model, urdf, arrays))
                for quantity, inputs in INPUTS.items():
                    runners = {name: runs[quantity] for name, runs in made.items() if quantity in runs}
                    reference = expected(model, quantity, arrays[:inputs])
                    errors = of_each(f"{robot}, {quantity}", runners, lambda run: error(run(), reference))
                    racing = [runners[name] for name in errors]
                    seconds = dict(zip(errors, race(racing, rounds=7, seconds=0.05)))
                    cells = [
                        f"{count / seconds[name] / 1e9:.4f} ({errors[name]:.1f})" if name in errors else ""
                        for name in there
                    ]
                    print(f"| {quantity.replace('_', ' ')} | {count} |", " | ".join(cells), "|", file=page, flush=True)


if __name__ == "__main__":
    page = sys.stdout
    with contextlib.redirect_stdout(sys.stderr):  # Warp says what it loads
        main(page)
