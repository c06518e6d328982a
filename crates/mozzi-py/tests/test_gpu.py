"""Arrays on a GPU: parsing, checks and calls, on arrays of the host that claim to be on one; and without a GPU, the error.

A fake kernel reads and writes addresses of the host by the model itself.
"""

import ctypes

import numpy as np
import pytest

import mozzi
from mozzi import _gpu, _mozzi


class OnGpu:
    """An array of the host with the interface of CUDA's arrays."""

    def __init__(self, array, stream=None):
        self.array = array
        self.__cuda_array_interface__ = {
            "shape": array.shape,
            "typestr": array.dtype.str,
            "data": (array.ctypes.data, False),
            "strides": None if array.flags.c_contiguous else array.strides,
            "version": 3,
            "stream": stream,
        }


class OfDlpack:
    """An array of the host by DLPack alone, on a device of choice."""

    def __init__(self, array, device=(2, 0)):
        self.array, self.device = array, device

    def __dlpack__(self, stream=None):
        return self.array.__dlpack__()

    def __dlpack_device__(self):
        return self.device


class Kernel:
    """`_mozzi.GpuKernel` on the host."""

    launched = []

    def __init__(self, model, quantity, frame, dtype, layout, packed, device, packages):
        assert all(isinstance(folder, str) for folder in packages)
        self.model, self.quantity, self.dtype, self.layout = model, quantity, np.dtype(dtype), layout
        n, nq = model.n, model.nq
        arguments = {"forward_dynamics": 3, "mass_matrix": 1}.get(quantity, 3)
        self.inputs = [("theta", nq), ("dtheta", n), ("tau", n), ("x", n)][:arguments]
        if quantity.endswith("_vjp"):
            self.inputs.append(("x", n))
        self.outputs = [("M", [n, n])] if quantity == "mass_matrix" else [("tau", [n])]
        if quantity.endswith("_vjp"):
            self.outputs = [("d_theta", [n]), ("d_dtheta", [n]), ("d_ddtheta", [n])]

    def at(self, address, states, length):
        number = ctypes.c_float if self.dtype == np.float32 else ctypes.c_double
        flat = np.ctypeslib.as_array(ctypes.cast(address, ctypes.POINTER(number)), (states * length,))
        return flat.reshape(states, length) if self.layout == "rows" else flat.reshape(length, states).T

    def launch(self, inputs, outputs, states, stream):
        Kernel.launched.append((self.quantity, states, stream))
        given = [self.at(x, states, length) for x, (_, length) in zip(inputs, self.inputs)]
        found = getattr(self.model, self.quantity)(*(x.copy() for x in given))
        for address, array in zip(outputs, found if isinstance(found, tuple) else (found,)):
            self.at(address, states, array[0].size)[:] = array.reshape(states, -1)


class Rollout:
    """`_mozzi.GpuRollout` on the host."""

    def __init__(self, model, dtype, layout, device, packages):
        self.kernel = Kernel(model, "rollout", None, dtype, layout, False, device, packages)

    def launch(self, state, tau, feedback, tables, step, steps, every, robots, stream):
        Kernel.launched.append(("rollout", robots, stream))
        model, n, nq = self.kernel.model, self.kernel.model.n, self.kernel.model.nq
        theta, dtheta = (self.kernel.at(x, robots, length).copy() for x, length in zip(state, (nq, n)))
        torques = None if tau is None else self.kernel.at(tau, robots, steps * n)
        if feedback is not None:
            gains = Kernel.at(self.kernel, feedback[0], 1, 2 * n * n).reshape(n, 2 * n)
            target = self.kernel.at(feedback[1], robots, nq + n)
        for k in range(steps):
            held = np.zeros((robots, n)) if tau is None else torques[:, k * n : (k + 1) * n].copy()
            if feedback is not None:
                held += np.hstack([differences(model, theta, target[:, :nq]), target[:, nq:] - dtheta]) @ gains.T
            found = model.rollout(theta, dtheta, held[:, None, :], step)
            theta, dtheta = found.theta[:, 1], found.dtheta[:, 1]
            if (k + 1) % every == 0:
                for address, x, length in zip(tables, (theta, dtheta), (nq, n)):
                    row = slice((k + 1) // every * length - length, (k + 1) // every * length)
                    self.kernel.at(address, robots, steps // every * length)[:, row] = x


def differences(model, start, end):
    return np.array([model.difference(*pair) for pair in zip(start, end)])


@pytest.fixture
def ur5():
    return mozzi.models.ur5()


@pytest.fixture
def fake(monkeypatch):
    monkeypatch.setattr(_mozzi, "GpuKernel", Kernel)
    monkeypatch.setattr(_mozzi, "GpuRollout", Rollout)
    Kernel.launched.clear()


def state(n, states=5, dtype=np.float64):
    random = np.random.default_rng(1)
    return [random.uniform(-1, 1, (states, n)).astype(dtype) for _ in range(3)]


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("kind", [OnGpu, OfDlpack])
def test_rows_in_rows_out(ur5, fake, dtype, kind):
    x, tau = state(6, dtype=dtype), np.empty((5, 6), dtype)
    gpu = _gpu.Gpu(ur5)
    out = OnGpu(tau)
    assert gpu.inverse_dynamics(*map(kind, x), out=out) is out
    assert Kernel.launched == [("inverse_dynamics", 5, 0)]
    np.testing.assert_allclose(tau, ur5.inverse_dynamics(*x), rtol=1e-5)


def test_columns_and_streams(ur5, fake):
    x = [np.ascontiguousarray(a.T) for a in state(6)]
    gpu, M = _gpu.Gpu(ur5, "columns"), np.empty((6, 6, 5))
    gpu.mass_matrix(OnGpu(x[0], stream=7), out=OnGpu(M))
    np.testing.assert_allclose(M.transpose(2, 0, 1), ur5.mass_matrix(x[0].T), atol=1e-14)
    gpu.mass_matrix(OnGpu(x[0], stream=7), out=OnGpu(M), stream=9)
    assert [stream for _, _, stream in Kernel.launched] == [7, 9]


def test_several_results_and_leading_axes(ur5, fake):
    x = [a.reshape(1, 5, 6) for a in state(6)]
    out = [OnGpu(np.empty((1, 5, 6))) for _ in range(3)]
    found = _gpu.Gpu(ur5).inverse_dynamics_vjp(*map(OnGpu, [*x, x[0]]), out=out)
    for array, expected in zip(found, ur5.inverse_dynamics_vjp(*x, x[0])):
        np.testing.assert_allclose(array.array, expected, atol=1e-12)


@pytest.mark.parametrize(
    ("arrays", "error", "words"),
    [
        (lambda x: [x[0], OnGpu(x[1]), OnGpu(x[2])], ValueError, "argument 1 is on DLPack's device"),
        (lambda x: [1.0, OnGpu(x[1]), OnGpu(x[2])], TypeError, "argument 1 is a float, expected an array on a GPU"),
        (lambda x: [OnGpu(x[0]), OnGpu(x[1].astype(np.float32)), OnGpu(x[2])], TypeError, "dtheta is float32"),
        (lambda x: [OnGpu(x[0].astype(int)), OnGpu(x[1]), OnGpu(x[2])], TypeError, "argument 1 has numbers of type '<i8'"),
        (lambda x: [OnGpu(x[0][:, :5].copy()), OnGpu(x[1]), OnGpu(x[2])], ValueError, r"theta has shape \(5, 5\)"),
        (lambda x: [OnGpu(x[0]), OnGpu(x[1][:4]), OnGpu(x[2])], ValueError, r"dtheta has shape \(4, 6\), expected \(5, 6\)"),
        (lambda x: [OnGpu(x[0][::2]), OnGpu(x[1]), OnGpu(x[2])], ValueError, "argument 1 is not contiguous"),
        (lambda x: [OnGpu(x[0])], TypeError, r"takes 3 arrays \(theta, dtheta, tau\), found 1"),
        (lambda x: [OnGpu(a) for a in x], TypeError, "results of a OnGpu need out="),
        (lambda x: [], TypeError, "found none"),
    ],
)
def test_wrong_arrays_are_named(ur5, fake, arrays, error, words):
    with pytest.raises(error, match=words):
        _gpu.Gpu(ur5).inverse_dynamics(*arrays(state(6)))
    assert not Kernel.launched


def test_wrong_results_and_names(ur5, fake):
    gpu, x = _gpu.Gpu(ur5), list(map(OnGpu, state(6)))
    with pytest.raises(ValueError, match=r"out \(tau\) has shape \(5, 5\), expected \(5, 6\)"):
        gpu.inverse_dynamics(*x, out=OnGpu(np.empty((5, 5))))
    with pytest.raises(TypeError, match="out has 2 arrays, expected 1"):
        gpu.inverse_dynamics(*x, out=[OnGpu(np.empty((5, 6)))] * 2)
    with pytest.raises(AttributeError, match="'no_such' is no quantity"):
        gpu.no_such(*x)


def on_gpu(gpu, x):
    """Rows as the layout has them."""
    return np.ascontiguousarray(np.moveaxis(x, 0, -1) if gpu.layout == "columns" else x)


@pytest.mark.parametrize("layout", ["rows", "columns"])
def test_rollouts(ur5, fake, layout):
    theta, dtheta, _ = state(6)
    tau = np.random.default_rng(2).uniform(-5, 5, (5, 4, 6))
    gpu = _gpu.Gpu(ur5, layout)
    start, out = [OnGpu(on_gpu(gpu, x)) for x in (theta, dtheta)], [on_gpu(gpu, np.empty((5, 2, 6))) for _ in range(2)]
    found = gpu.rollout(*start, OnGpu(on_gpu(gpu, tau)), step=0.01, every=2, out=list(map(OnGpu, out)), stream=3)
    assert Kernel.launched == [("rollout", 5, 3)]
    for array, table in zip(found, ur5.rollout(theta, dtheta, tau, 0.01)):
        np.testing.assert_allclose(array.array, on_gpu(gpu, table[:, 2::2]), atol=1e-13)


def test_rollouts_with_feedback(ur5, fake):
    theta, dtheta, target = state(6)
    gains = np.hstack([100.0 * np.eye(6), 20.0 * np.eye(6)])
    target = np.hstack([target, np.zeros((5, 6))])
    x, out = list(map(OnGpu, (theta, dtheta))), [np.empty((5, 1, 6)) for _ in range(2)]
    gpu, held = _gpu.Gpu(ur5), (target - np.hstack([theta, dtheta])) @ gains.T
    feedback = {"gains": OnGpu(gains), "target": OnGpu(target)}
    gpu.rollout(*x, step=0.01, steps=1, out=list(map(OnGpu, out)), **feedback)
    for array, table in zip(out, ur5.rollout(theta, dtheta, held[:, None], 0.01)):
        np.testing.assert_allclose(array, table[:, 1:], atol=1e-13)
    for arguments, error, words in [
        ({}, TypeError, "tau or steps, found neither"),
        ({"steps": 3, "every": 2}, ValueError, "every is 2, expected a divisor of the number of steps, 3"),
        ({"steps": 2, "gains": OnGpu(gains)}, TypeError, "gains and target belong together"),
        ({"steps": 2, **feedback, "gains": OnGpu(gains[:, :6].copy())}, ValueError, r"gains has shape \(6, 6\), expected \(6, 12\)"),
        ({"tau": OnGpu(np.zeros((5, 6)))}, ValueError, r"tau has shape \(5, 6\), expected \(\.\.\., K, 6\)"),
        ({"tau": OnGpu(np.zeros((5, 3, 6))), "steps": 2}, ValueError, "tau has shape .* the torques of 3 steps"),
    ]:
        with pytest.raises(error, match=words):
            gpu.rollout(*x, step=0.01, out=list(map(OnGpu, out)), **arguments)


@pytest.mark.parametrize("layout", ["rows", "columns"])
def test_rollouts_of_a_floating_base(fake, layout):
    anymal = mozzi.models.anymal(floating=True)
    n, nq = anymal.n, anymal.nq
    random = np.random.default_rng(4)
    still = [1.0] + [0.0] * (nq - 1)
    theta, desired = ([anymal.integrate(still, x) for x in some] for some in random.uniform(-1, 1, (2, 5, n)))
    theta, desired = np.array(theta), np.array(desired)
    dtheta, target = random.uniform(-1, 1, (5, n)), np.hstack([desired, np.zeros((5, n))])
    gains = np.zeros((n, 2 * n))
    gains[6:, 6:n] = 50.0 * np.eye(n - 6)  # the joints alone
    held = np.hstack([differences(anymal, theta, desired), -dtheta]) @ gains.T
    gpu = _gpu.Gpu(anymal, layout)
    x, out = [OnGpu(on_gpu(gpu, a)) for a in (theta, dtheta)], [on_gpu(gpu, np.empty((5, 1, k))) for k in (nq, n)]
    feedback = {"gains": OnGpu(gains), "target": OnGpu(on_gpu(gpu, target))}
    gpu.rollout(*x, step=0.01, steps=1, out=list(map(OnGpu, out)), **feedback)
    for array, table in zip(out, anymal.rollout(theta, dtheta, held[:, None], 0.01)):
        np.testing.assert_allclose(array, on_gpu(gpu, table[:, 1:]), atol=1e-13)
    with pytest.raises(ValueError, match=r"theta has shape \(5, 18\), expected \(\.\.\., 19\)"):
        _gpu.Gpu(anymal).rollout(OnGpu(dtheta), OnGpu(dtheta), step=0.01, steps=1)


def test_gradients_of_torch(ur5, fake, monkeypatch):
    torch = pytest.importorskip("torch")
    monkeypatch.setattr(_gpu, "view", lambda x, name: _gpu.View(x.data_ptr(), tuple(x.shape), "float64", None))
    x = [torch.tensor(a, requires_grad=True) for a in state(6)]
    w = torch.ones(5, 6, dtype=torch.float64)
    (_gpu.Gpu(ur5).compute("inverse_dynamics", *x, stream=0) * w).sum().backward()
    expected = ur5.inverse_dynamics_vjp(*(a.detach().numpy() for a in x), w.numpy())
    for a, gradient in zip(x, expected):
        np.testing.assert_allclose(a.grad.numpy(), gradient, atol=1e-12)


def test_gradients_by_quaternions(fake, monkeypatch):
    torch = pytest.importorskip("torch")
    import mozzi.torch

    monkeypatch.setattr(_gpu, "view", lambda x, name: _gpu.View(x.data_ptr(), tuple(x.shape), "float64", None))
    anymal = mozzi.models.anymal(floating=True)
    n, nq = anymal.n, anymal.nq
    random = np.random.default_rng(3)
    x = [random.uniform(-1, 1, (4, k)) for k in (nq, n, n)]
    x[0][:, :4] /= np.linalg.norm(x[0][:, :4], axis=1, keepdims=True)
    on_gpu, on_cpu = ([torch.tensor(a, requires_grad=True) for a in x] for _ in range(2))
    w = torch.tensor(random.uniform(-1, 1, (4, n)))
    (_gpu.Gpu(anymal).compute("inverse_dynamics", *on_gpu, stream=0) * w).sum().backward()
    (mozzi.torch.Model(anymal).inverse_dynamics(*on_cpu) * w).sum().backward()
    for a, b in zip(on_gpu, on_cpu):
        np.testing.assert_allclose(a.grad.numpy(), b.grad.numpy(), atol=1e-10)


def test_cuda_tensors_of_mozzi_torch(ur5, fake, monkeypatch):
    torch = pytest.importorskip("torch")
    import mozzi.torch
    from mozzi import _torch_gpu
    from mozzi._torch_operators import value_op

    # the operators' CUDA kernels on the host
    monkeypatch.setattr(_gpu, "view", lambda x, name: _gpu.View(x.data_ptr(), tuple(x.shape), "float64", None))
    monkeypatch.setattr(_gpu, "stream_of", lambda x, views: 0)
    robot = mozzi.torch.Model(ur5)
    key = f"{robot._contents}:inverse_dynamics:"
    x, w = [torch.tensor(a) for a in state(6)], torch.ones(5, 6, dtype=torch.float64)
    np.testing.assert_allclose(_torch_gpu.value(x, key), ur5.inverse_dynamics(*map(np.asarray, x)), atol=1e-12)
    expanded = [x[0], x[1], x[2][:1].expand(5, 6)]
    for found, expected in zip(
        _torch_gpu.pull_back(expanded, w, key, False), ur5.inverse_dynamics_vjp(*map(np.asarray, expanded), w.numpy())
    ):
        np.testing.assert_allclose(found, expected, atol=1e-12)
    with pytest.raises(ValueError, match="parameters are given for inverse_dynamics on cpu"):
        _torch_gpu.value([*x, torch.ones(1)], key)
    with pytest.raises(TypeError, match="mass_matrix has no gradient on a GPU"):
        _torch_gpu.pull_back(x[:1], w, f"{robot._contents}:mass_matrix:", False)
    # and the operator's rule for vmap
    over = torch.func.vmap(lambda theta: value_op([theta, x[1], x[2]], key))(torch.stack([x[0], 2 * x[0]]))
    np.testing.assert_allclose(over[1], ur5.inverse_dynamics(2 * x[0].numpy(), x[1].numpy(), x[2].numpy()), atol=1e-12)
    with pytest.raises(ValueError, match="dtheta is on meta, but theta is on cpu: expected one device"):
        robot.inverse_dynamics(x[0], x[1].to("meta"), x[2])


def test_without_a_gpu_the_error_names_it(ur5):
    with pytest.raises(ValueError, match="layout is 'blocks', expected 'rows' or 'columns'"):
        ur5.to_gpu(layout="blocks")
    try:
        gpu = ur5.to_gpu()
    except RuntimeError as error:
        assert str(error).startswith("no CUDA device: ")
    else:
        assert isinstance(gpu, _gpu.Gpu)
