"""Kernels on an NVIDIA GPU, by PyTorch's and CuPy's arrays, against the CPU. Skipped where PyTorch has no GPU."""

import numpy as np
import pytest

import mozzi
from conftest import load_mjcf, robots, state

torch = pytest.importorskip("torch", reason="cargo xtask test --torch installs PyTorch")
if not torch.cuda.is_available():
    pytest.skip("PyTorch has no GPU", allow_module_level=True)

LAYOUTS = ["rows", "columns"]
DTYPES = [torch.float32, torch.float64]
# the quantities, and how many arrays each takes of θ, θ̇, θ̈ or τ, x
INPUTS = {
    "inverse_dynamics": 3,
    "forward_dynamics": 3,
    "mass_matrix": 1,
    "inverse_dynamics_derivatives": 3,
    "inverse_dynamics_vjp": 4,
    "forward_dynamics_vjp": 4,
}


def on_card(x, layout="rows", dtype=torch.float64):
    x = torch.as_tensor(x, dtype=dtype, device="cuda")
    return x if layout == "rows" else x.movedim(0, -1).contiguous()


def by_rows(x, layout="rows"):
    x = x.detach().cpu().numpy().astype(np.float64)
    return x if layout == "rows" else np.moveaxis(x, -1, 0)


def rounded(x, dtype):
    return x.astype(np.float32).astype(np.float64) if dtype == torch.float32 else x


def check(found, expected, dtype, what=""):
    """Every state, relative to its largest entry."""
    found, expected = (np.reshape(x, (len(x), -1)) for x in (found, expected))
    error = np.abs(found - expected).max(1) / np.abs(expected).max(1)
    assert error.max() < 2000 * torch.finfo(dtype).eps, f"{what}: {error.max() / torch.finfo(dtype).eps} eps"


def tuple_of(x):
    return x if isinstance(x, tuple) else (x,)


@pytest.mark.parametrize("dtype", DTYPES)
@pytest.mark.parametrize("layout", LAYOUTS)
def test_quantities(robot, random, layout, dtype):
    gpu = robot.to_gpu(layout=layout)
    x = [rounded(a, dtype) for a in (*state(robot, random, 1000), random.uniform(-1, 1, (1000, robot.n)))]
    for quantity, count in INPUTS.items():
        found = getattr(gpu, quantity)(*(on_card(a, layout, dtype) for a in x[:count]))
        for a, expected in zip(tuple_of(found), tuple_of(getattr(robot, quantity)(*x[:count])), strict=True):
            check(by_rows(a, layout), expected, dtype, quantity)


def test_a_packed_matrix(robot, random):
    theta = state(robot, random, 100)[0]
    found = robot.to_gpu().mass_matrix(on_card(theta), packed=True)
    lower = np.tril_indices(robot.n)
    check(by_rows(found), robot.mass_matrix(theta)[:, lower[0], lower[1]], torch.float64)


def limbs(count, length):
    """A floating base with limbs of hinges: so long a program that a thread takes it in parts, for several states."""
    random = np.random.default_rng(7)

    def limb(name, k):
        if k == length:
            return ""
        x, y = (" ".join(map(str, random.uniform(-0.5, 0.5, 3))) for _ in range(2))
        inner = f'<joint axis="{"xyz"[k % 3] == "x":d} {"xyz"[k % 3] == "y":d} {"xyz"[k % 3] == "z":d}"/>'
        inner += f'<inertial pos="{y}" mass="1" diaginertia="0.02 0.03 0.04"/>{limb(name, k + 1)}'
        return f'<body name="{name}{k}" pos="{x}">{inner}</body>'

    all_limbs = "".join(limb(f"limb{k}_", 0) for k in range(count))
    base = f'<body name="base"><freejoint/><inertial pos="0 0 0" mass="5" diaginertia="1 1 1"/>{all_limbs}</body>'
    return f"<mujoco><worldbody>{base}</worldbody></mujoco>"


@pytest.mark.parametrize("count", [1, 1000, 300_001])
def test_a_long_program_in_parts(tmp_path, random, count):
    robot = load_mjcf(tmp_path, limbs(4, 9))
    x = [rounded(a, torch.float32) for a in (*state(robot, random, 97), random.uniform(-1, 1, (97, robot.n)))]
    on_gpu = [on_card(a, "columns", torch.float32).repeat(1, count // 97 + 1)[:, :count].contiguous() for a in x]
    found = robot.to_gpu(layout="columns").inverse_dynamics_vjp(*on_gpu)
    for a, expected in zip(found, robot.inverse_dynamics_vjp(*x), strict=True):
        a = by_rows(a, "columns")
        for first in {0, count // 97 // 2 * 97, (count - 1) // 97 * 97}:
            part = a[first : first + 97]
            check(part, expected[: len(part)], torch.float32, f"from {first}")


def test_streams_and_graphs(ur5, random):
    gpu, x = ur5.to_gpu(), [on_card(a) for a in state(ur5, random, 1000)]
    tau = torch.empty(1000, 6, dtype=torch.float64, device="cuda")
    stream = torch.cuda.Stream()
    stream.wait_stream(torch.cuda.current_stream())
    with torch.cuda.stream(stream):
        gpu.inverse_dynamics(*x, out=tau)
    stream.synchronize()
    check(by_rows(tau), ur5.inverse_dynamics(*map(by_rows, x)), torch.float64)
    graph = torch.cuda.CUDAGraph()
    with torch.cuda.graph(graph):
        gpu.inverse_dynamics(*x, out=tau)
    for a in x:
        a.neg_()
    tau.zero_()
    graph.replay()
    check(by_rows(tau), ur5.inverse_dynamics(*map(by_rows, x)), torch.float64)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("quantity", ["inverse_dynamics", "forward_dynamics"])
def test_gradients(robot, random, quantity, layout):
    """By `to_gpu` and by `mozzi.torch`; the reference is `mozzi.torch` on the CPU."""
    import mozzi.torch

    model, gpu = mozzi.torch.Model(robot), robot.to_gpu(layout=layout)
    x, w = state(robot, random, 50), torch.as_tensor(random.uniform(-1, 1, (50, robot.n)))

    def leaves(tensors):
        return [a.requires_grad_() for a in tensors]

    on_cpu = leaves([torch.tensor(a) for a in x])
    (getattr(model, quantity)(*on_cpu) * w).sum().backward()
    by_gpu = leaves([on_card(a, layout) for a in x])
    (getattr(gpu, quantity)(*by_gpu) * on_card(w, layout)).sum().backward()
    of_torch = leaves([on_card(a) for a in x])
    (getattr(model, quantity)(*of_torch) * w.cuda()).sum().backward()
    for expected, a, b in zip(on_cpu, by_gpu, of_torch):
        check(by_rows(a.grad, layout), expected.grad.numpy(), torch.float64)
        check(by_rows(b.grad), expected.grad.numpy(), torch.float64)


def test_transformations_of_torch(ur5, random):
    import mozzi.torch

    model = mozzi.torch.Model(ur5)
    x = [on_card(a) for a in state(ur5, random, 4, 5)]
    expected = ur5.inverse_dynamics(*(a.cpu().numpy() for a in x))
    compiled = torch.compile(lambda *x: 2 * model.inverse_dynamics(*x), backend="aot_eager", fullgraph=True)
    np.testing.assert_allclose(compiled(*x).cpu() / 2, expected, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(torch.func.vmap(model.inverse_dynamics)(*x).cpu(), expected, rtol=1e-9, atol=1e-9)
    gradient = torch.func.grad(lambda theta: model.inverse_dynamics(theta, *x[1:]).sum())(x[0])
    product = ur5.inverse_dynamics_vjp(*(a.cpu().numpy() for a in x), np.ones((4, 5, 6)))[0]
    np.testing.assert_allclose(gradient.cpu(), product, rtol=1e-9, atol=1e-9)
    each = torch.func.vmap(torch.func.grad(lambda *x: model.forward_dynamics(*x).sum(), argnums=(0, 2)))
    products = ur5.forward_dynamics_vjp(*(a.cpu().numpy() for a in x), np.ones((4, 5, 6)))
    for a, expected_a in zip(each(*(a[0] for a in x)), (products[0][0], products[2][0])):
        np.testing.assert_allclose(a.cpu(), expected_a, rtol=1e-8, atol=1e-8)
    with pytest.raises(NotImplementedError, match="on cuda:0: derivatives there are of first order, in reverse mode"):
        torch.func.jvp(lambda theta: model.inverse_dynamics(theta, *x[1:]), (x[0],), (x[0],))
    with torch.no_grad():  # of a tensor that could have one
        theta = x[0].clone().requires_grad_()
        np.testing.assert_allclose(ur5.to_gpu().inverse_dynamics(theta, *x[1:]).cpu(), expected, rtol=1e-9, atol=1e-9)
    broadcast = model.inverse_dynamics(x[0], x[1][0, 0], x[2][0])
    found = ur5.inverse_dynamics(*(a.cpu().numpy() for a in torch.broadcast_tensors(x[0], x[1][0, 0], x[2][0])))
    np.testing.assert_allclose(broadcast.cpu(), found, rtol=1e-9, atol=1e-9)
    with pytest.raises(ValueError, match="dtheta is on cpu, but theta is on cuda:0: expected one device"):
        model.inverse_dynamics(x[0], x[1].cpu(), x[2])


@pytest.mark.parametrize("name", ["ur5", "anymal"])
@pytest.mark.parametrize("dtype", DTYPES)
@pytest.mark.parametrize("layout", LAYOUTS)
def test_rollouts(random, name, layout, dtype):
    robot, count, steps = robots()[name], 200, 12
    n, nq, step = robot.n, robot.nq, 0.005
    theta, dtheta, _ = (rounded(a, dtype) for a in state(robot, random, count))
    tau = rounded(random.uniform(-5, 5, (count, steps, n)), dtype)
    gpu = robot.to_gpu(layout=layout)
    x = [on_card(a, layout, dtype) for a in (theta, dtheta)]
    found = gpu.rollout(*x, on_card(tau, layout, dtype), step=step, every=4)
    for a, table in zip(found, robot.rollout(theta, dtheta, tau, step)):
        check(by_rows(a, layout), table[:, 4::4], dtype, "torques of a table")

    # and towards desired states
    desired = rounded(state(robot, random, count)[0], dtype)
    gains = rounded(random.uniform(-0.5, 0.5, (n, 2 * n)), dtype)
    feedback = {
        "gains": on_card(gains, dtype=dtype),
        "target": on_card(np.hstack([desired, np.zeros((count, n))]), layout, dtype),
    }
    for _ in range(2):
        difference = np.array([robot.difference(*pair) for pair in zip(theta, desired)])
        held = np.hstack([difference, -dtheta]) @ gains.T
        path = robot.rollout(theta, dtheta, held[:, None], step)
        theta, dtheta = path.theta[:, 1], path.dtheta[:, 1]
    found = gpu.rollout(*x, step=step, steps=2, every=2, **feedback)
    for a, expected in zip(found, (theta, dtheta)):
        check(by_rows(a, layout), expected[:, None], dtype, "feedback")


def test_arrays_of_cupy(ur5, random):
    cupy = pytest.importorskip("cupy")
    x = state(ur5, random, 100)
    tau = ur5.to_gpu().inverse_dynamics(*map(cupy.asarray, x))
    assert isinstance(tau, cupy.ndarray)
    check(tau.get(), ur5.inverse_dynamics(*x), torch.float64)


def test_arrays_of_dlpack(ur5, random):
    jax = pytest.importorskip("jax")
    try:
        device = jax.devices("gpu")[0]
    except RuntimeError:
        pytest.skip("JAX has no GPU")
    x = [jax.device_put(a.astype("float32"), device) for a in state(ur5, random, 100)]
    jax.block_until_ready(x)
    tau = torch.empty(100, 6, device="cuda")
    ur5.to_gpu().inverse_dynamics(*x, out=tau)
    check(by_rows(tau), ur5.inverse_dynamics(*(np.asarray(a, np.float64) for a in x)), torch.float32)


def test_what_is_wrong_is_named(ur5, random):
    gpu, x = ur5.to_gpu(), [on_card(a) for a in state(ur5, random, 10)]
    with pytest.raises(TypeError, match="dtheta is float32, the first array is float64"):
        gpu.inverse_dynamics(x[0], x[1].float(), x[2])
    with pytest.raises(ValueError, match="argument 1 is not contiguous"):
        gpu.inverse_dynamics(x[0].T.contiguous().T, *x[1:])
    with pytest.raises((TypeError, ValueError), match="expected a CUDA device|expected an array on a GPU"):
        gpu.inverse_dynamics(x[0].cpu(), *x[1:])
    with pytest.raises(ValueError, match=r"expected \(\.\.\., 6\)"):
        gpu.inverse_dynamics(*(a[:, :5].contiguous() for a in x))
    far = x[0].clone()
    far[3, 2] = 1e9  # beyond what an angle may be
    assert torch.isnan(gpu.inverse_dynamics(far, *x[1:])).any(1).nonzero().flatten().tolist() == [3]
