"""mozzi.torch: values of the package, every kind of derivative by torch's own checks, compiled graphs, clear errors."""

import functools
import subprocess
import sys

import mozzi
import numpy as np
import pytest
from conftest import assert_close, load_mjcf, robots

torch = pytest.importorskip("torch", reason="cargo xtask test --torch installs PyTorch")
import mozzi.torch  # noqa: E402
from torch.autograd import gradcheck, gradgradcheck  # noqa: E402
from torch.func import grad, hessian, jacfwd, jacrev, jvp, vjp, vmap  # noqa: E402

BALL = """<mujoco><worldbody><body name="upper"><joint name="shoulder" type="ball" damping="0.1" armature="0.02"/>
<inertial pos="0.1 0.02 -0.3" mass="2" diaginertia="0.05 0.06 0.01"/><body name="lower" pos="0 0 -0.6">
<joint name="elbow" axis="0 1 0" stiffness="3" springref="20"/><inertial pos="0 0 -0.2" mass="1" diaginertia="0.02 0.02 0.004"/>
<body name="loose" pos="0.2 0 -0.4"><joint name="wrist" type="ball" stiffness="1.5"/>
<inertial pos="0 0.05 -0.1" mass="0.4" diaginertia="0.003 0.004 0.002"/></body></body></body>
<body name="adrift" pos="1 0 0"><freejoint name="free"/><inertial pos="0.1 0 0.2" mass="1.5" diaginertia="0.02 0.03 0.04"/>
</body></worldbody></mujoco>"""

NAMES = ["furuta_pendulum", "ur5", "two_link_adrift", "balls"]
DYNAMICS = ["inverse_dynamics", "forward_dynamics"]
KINEMATICS = ["forward_kinematics", "body_jacobian", "space_jacobian"]


@functools.cache
def _model(name):
    if name == "two_link_adrift":  # a floating base with joints
        locked = dict.fromkeys(mozzi.models.ur5().joint_names[2:], 0.3)
        return mozzi.models.ur5().with_locked_joints(locked).with_floating_base()
    return robots()[name]


@pytest.fixture(scope="module")
def models(tmp_path_factory):
    balls = load_mjcf(tmp_path_factory.mktemp("mjcf"), BALL)
    return lambda name: balls if name == "balls" else _model(name)


def unit_quaternions(model, theta):
    for q, _, _ in model._quaternions:
        theta[..., q : q + 4] /= np.linalg.norm(theta[..., q : q + 4], axis=-1, keepdims=True)
    return theta


def state(model, seed, *leading, dtype=torch.float64, requires_grad=True):
    """θ, θ̇, θ̈ or τ."""
    random = np.random.default_rng(seed)
    theta = unit_quaternions(model, random.uniform(-1, 1, (*leading, model.nq)))
    arrays = [theta, *(random.uniform(-1, 1, (*leading, model.n)) for _ in range(2))]
    return tuple(torch.tensor(a, dtype=dtype, requires_grad=requires_grad) for a in arrays)


def parameters(model, requires_grad=True):
    """π near the model's, so that M stays positive."""
    pi = model.parameters * np.random.default_rng(5).uniform(0.98, 1.02, len(model.parameters))
    return torch.tensor(pi, requires_grad=requires_grad)


def frame(model):
    return model.end_effector or model.link_names[-1]


def calls(model, seed=1, *leading, parametric=True, requires_grad=True):
    """Every function of a robot, with inputs."""
    robot = mozzi.torch.Model(model)
    x = state(model, seed, *leading, requires_grad=requires_grad)
    found = {name: (getattr(robot, name), x) for name in DYNAMICS}
    found["mass_matrix"] = (robot.mass_matrix, x[:1])
    for name in KINEMATICS:
        found[name] = (functools.partial(getattr(robot, name), frame=frame(model)), x[:1])
    if parametric:
        pi = parameters(model, requires_grad)
        for name in [*DYNAMICS, "mass_matrix"]:
            function, x = found[name]
            found[name + " of parameters"] = (lambda *x, f=function: f(*x[:-1], parameters=x[-1]), (*x, pi))
    return found


CALLS = [*DYNAMICS, "mass_matrix", *KINEMATICS]
PARAMETRIC = [*(name + " of parameters" for name in [*DYNAMICS, "mass_matrix"])]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("dtype", [torch.float64, torch.float32])
def test_values_are_those_of_the_package(models, name, dtype):
    model = models(name)
    robot, pi = mozzi.torch.Model(model), model.parameters * 1.01
    for leading in [(), (3,), (2, 3)]:
        x = state(model, 2, *leading, dtype=dtype)
        a = [t.detach().numpy() for t in x]
        for quantity in DYNAMICS:
            found, expected = getattr(robot, quantity)(*x), getattr(model, quantity)(*a)
            assert found.dtype == dtype and found.requires_grad
            assert np.array_equal(found.detach().numpy(), expected.astype(found.detach().numpy().dtype))
            given = torch.tensor(pi, dtype=dtype)
            found = getattr(robot, quantity)(*x, parameters=given)
            expected = getattr(model, quantity)(*a, parameters=given.numpy())
            assert_close(found.detach().numpy(), expected, tolerance=1e-12 if dtype == torch.float64 else 1e-5)
        assert np.array_equal(robot.mass_matrix(x[0]).detach().numpy(), model.mass_matrix(a[0]).astype(a[0].dtype))
        for quantity in KINEMATICS:
            found = getattr(robot, quantity)(x[0], frame(model)).detach().numpy()
            assert np.array_equal(found, getattr(model, quantity)(a[0], frame(model)).astype(a[0].dtype))


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("quantity", [*CALLS, *PARAMETRIC])
def test_first_derivatives(models, name, quantity):
    model = models(name)
    function, x = calls(model)[quantity]
    assert gradcheck(function, x, check_forward_ad=True, check_batched_grad=True, check_batched_forward_grad=True)
    function, x = calls(model, 3, 2)[quantity]
    assert gradcheck(function, x, check_forward_ad=True, fast_mode=True)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("quantity", [*CALLS, *PARAMETRIC])
def test_second_derivatives(models, name, quantity):
    function, x = calls(models(name), 4)[quantity]
    assert gradgradcheck(
        function, x, fast_mode=quantity in PARAMETRIC, check_fwd_over_rev=True, check_rev_over_rev=True
    )


@pytest.mark.parametrize("name", ["ur5", "two_link_adrift"])
def test_matrices_of_derivatives_by_torch_are_the_packages(models, name):
    model = models(name)
    robot, (theta, dtheta, ddtheta) = mozzi.torch.Model(model), state(model, 6)
    a = [t.detach().numpy() for t in (theta, dtheta, ddtheta)]
    for function, derivatives in [
        (robot.inverse_dynamics, model.inverse_dynamics_derivatives(*a)),
        (robot.forward_dynamics, model.forward_dynamics_derivatives(*a)[1:]),
    ]:
        for reverse in [jacrev, jacfwd]:
            found = reverse(function, argnums=(0, 1, 2))(theta, dtheta, ddtheta)
            along = found[0].detach().numpy() @ embedding(model, a[0])
            for matrix, expected in zip([along, *(m.detach().numpy() for m in found[1:])], derivatives):
                assert_close(matrix, expected)


def embedding(model, theta):
    """∂θ along the velocities (nq, n): the columns are θ ⊕ e_j ε, by differences of the book's formulas."""
    from mozzi import _tangent

    columns = np.eye(model.nq)
    rows = np.stack([_tangent.velocity_gradient(np, model._quaternions, theta, c) for c in columns])
    inverse = np.stack([_tangent.velocities(np, model._quaternions, theta, c) for c in columns], axis=1)
    assert_close(inverse @ rows, np.eye(model.n))
    return rows


@pytest.mark.parametrize("name", ["ur5", "two_link_adrift"])
def test_functional_transforms(models, name):
    model = models(name)
    robot, (theta, dtheta, ddtheta) = mozzi.torch.Model(model), state(model, 7, 4, requires_grad=False)
    power = lambda q, dq, ddq: (robot.inverse_dynamics(q, dq, ddq) * dq).sum()  # noqa: E731
    one = grad(power, argnums=(0, 1, 2))
    together = vmap(one)(theta, dtheta, ddtheta)
    for k in range(4):
        for found, expected in zip(together, one(theta[k], dtheta[k], ddtheta[k])):
            assert_close(found[k].numpy(), expected.numpy())
    # axes anywhere, unbatched arguments, vmap of vmap
    f = robot.inverse_dynamics
    expected = f(theta, dtheta[0].expand(4, -1), ddtheta).numpy()
    assert np.array_equal(vmap(f, in_dims=(0, None, 1))(theta, dtheta[0], ddtheta.T).numpy(), expected)
    grid = vmap(vmap(f, in_dims=(None, 0, None)), in_dims=(0, None, 0))(theta, dtheta, ddtheta)
    assert_close(grid[2, 3].numpy(), f(theta[2], dtheta[3], ddtheta[2]).numpy())
    # forward mode is not zero: equal to reverse mode
    rates = state(model, 8, requires_grad=False)
    x = (theta[0], dtheta[0], ddtheta[0])
    tau, dtau = jvp(f, x, rates)
    assert_close(tau.numpy(), f(*x).numpy())
    _, pull_back = vjp(f, *x)
    w = torch.ones(model.n, dtype=torch.float64)
    assert_close((w @ dtau).item(), sum((g @ u).item() for g, u in zip(pull_back(w), rates)))
    assert abs(dtau).max() > 1e-3
    # second derivatives in three ways
    H = hessian(power)(*x)
    assert_close(H.numpy(), jacrev(jacrev(power))(*x).numpy())
    assert_close(H.numpy(), torch.autograd.functional.hessian(lambda q: power(q, *x[1:]), x[0]).numpy())
    with pytest.raises(NotImplementedError, match="forward over forward"):
        jacfwd(jacfwd(power))(*x)
    with pytest.raises((NotImplementedError, RuntimeError), match="third derivatives of inverse_dynamics"):
        grad(lambda q: hessian(power)(q, *x[1:]).sum())(x[0])


def operators(model):
    """The custom operators with inputs: of one state, of a batch, strided, float32."""
    robot = mozzi.torch.Model(model)
    for leading, dtype in [((), torch.float64), ((3,), torch.float64), ((3,), torch.float32)]:
        x = [*state(model, 9, *leading, dtype=dtype)]
        yield robot._contents + ":inverse_dynamics:", x, torch.ones(*leading, model.n, dtype=dtype)
    x = [t.detach().repeat(1, 2)[:, ::2].requires_grad_() for t in state(model, 9, 3)]
    x = unit(model, x)
    yield robot._contents + ":forward_dynamics:", x, torch.ones(3, model.n, dtype=torch.float64)
    yield robot._contents + ":mass_matrix:", x[:1], torch.ones(3, model.n, model.n, dtype=torch.float64)


def unit(model, x):
    theta = x[0].detach().clone()
    for q, _, _ in model._quaternions:
        theta[:, q : q + 4] /= theta[:, q : q + 4].norm(dim=-1, keepdim=True)
    wide = torch.zeros(*theta.shape[:-1], 2 * theta.shape[-1], dtype=theta.dtype)
    wide[..., ::2] = theta
    return [wide[..., ::2].requires_grad_(), *x[1:]]


@pytest.mark.parametrize("name", ["ur5", "two_link_adrift"])
def test_operators_pass_torchs_check(models, name):
    for key, x, w in operators(models(name)):
        torch.library.opcheck(torch.ops.mozzi.value.default, (x, key))
        torch.library.opcheck(torch.ops.mozzi.vjp.default, ([t.detach() for t in x], w, key, False))


@pytest.mark.parametrize("name", ["ur5", "two_link_adrift"])
def test_compiled_graphs(models, name):
    model = models(name)
    robot = mozzi.torch.Model(model)
    x = state(model, 10, 3)
    pi = parameters(model)

    def loss(theta, dtheta, tau, pi):
        ddtheta = robot.forward_dynamics(theta, dtheta, torch.tanh(tau), parameters=pi)
        return (robot.mass_matrix(theta) @ ddtheta[..., None]).sum() + robot.forward_kinematics(
            theta, frame(model)
        ).sum()

    compiled = torch.compile(loss, fullgraph=True, backend="aot_eager")
    expected = torch.autograd.grad(loss(*x, pi), (*x, pi))
    found = torch.autograd.grad(compiled(*x, pi), (*x, pi))
    assert_close(compiled(*x, pi).item(), loss(*x, pi).item())
    for found, expected in zip(found, expected):
        assert_close(found.numpy(), expected.numpy(), tolerance=1e-11)
    with pytest.raises(Exception, match="theta has shape"):
        torch.compile(robot.mass_matrix, fullgraph=True, backend="aot_eager")(
            torch.zeros(2, model.nq + 1, dtype=torch.float64)
        )


def test_forward_mode_in_a_graph_is_not_silently_zero(ur5):
    robot = mozzi.torch.Model(ur5)
    x, u = state(ur5, 11, requires_grad=False), state(ur5, 12, requires_grad=False)
    expected = jvp(robot.inverse_dynamics, x, u)[1]
    compiled = torch.compile(lambda x, u: jvp(robot.inverse_dynamics, x, u)[1], backend="aot_eager")
    try:
        found = compiled(x, u)
    except Exception as error:
        assert "forward" in str(error)
    else:
        assert_close(found.numpy(), expected.numpy())
    with torch.autograd.forward_ad.dual_level():
        dual = [torch.autograd.forward_ad.make_dual(a, b) for a, b in zip(x, u)]
        found = torch.autograd.forward_ad.unpack_dual(robot.inverse_dynamics(*dual)).tangent
        assert_close(found.numpy(), expected.numpy())
        with pytest.raises(NotImplementedError, match="forward mode"):
            torch.ops.mozzi.value(dual, robot._contents + ":inverse_dynamics:")


def test_exported_programs(ur5):
    class Fall(torch.nn.Module):
        def __init__(self):
            super().__init__()
            self.robot = mozzi.torch.Model(ur5)

        def forward(self, theta, dtheta):
            return self.robot.forward_dynamics(theta, dtheta, torch.zeros_like(dtheta))

    theta, dtheta, _ = state(ur5, 13, 4, requires_grad=False)
    program = torch.export.export(Fall(), (theta, dtheta))
    assert_close(program.module()(theta, dtheta).numpy(), Fall()(theta, dtheta).numpy())
    text = subprocess.run(
        [sys.executable, "-c", "import mozzi, mozzi.torch; print(mozzi.torch.Model(mozzi.models.ur5())._contents)"],
        capture_output=True, text=True, check=True,
    ).stdout.strip()  # fmt: skip
    assert text in str(program.graph), "another process gives the robot the same name"


def test_memory_is_shared_and_strides_are_allowed(ur5):
    robot = mozzi.torch.Model(ur5)
    x = state(ur5, 14, 5, requires_grad=False)
    expected = robot.inverse_dynamics(*x)
    strided = [torch.stack([t, t], dim=-1)[..., 0] for t in x]
    assert not any(t.is_contiguous() for t in strided)
    assert torch.equal(robot.inverse_dynamics(*strided), expected)
    turned = [t.T.contiguous().T.requires_grad_() for t in x]
    robot.inverse_dynamics(*turned).sum().backward()
    for k, gradient in enumerate(grad(lambda *x: robot.inverse_dynamics(*x).sum(), argnums=(0, 1, 2))(*x)):
        assert_close(turned[k].grad.numpy(), gradient.numpy())
    # leading axes are broadcast, and gradients summed over them
    one = x[1][0].clone().requires_grad_()
    robot.inverse_dynamics(x[0], one, x[2]).sum().backward()
    many = x[1][:1].repeat(5, 1).requires_grad_()
    robot.inverse_dynamics(x[0], many, x[2]).sum().backward()
    assert_close(one.grad.numpy(), many.grad.sum(0).numpy())


def test_gradients_in_float32(ur5):
    robot = mozzi.torch.Model(ur5)
    single, double = state(ur5, 15, 3, dtype=torch.float32), state(ur5, 15, 3)
    for x in (single, double):
        robot.forward_dynamics(*x).square().sum().backward()
    for a, b in zip(single, double):
        assert a.grad.dtype == torch.float32
        assert_close(a.grad.numpy(), b.grad.numpy(), tolerance=2e-3)


def test_errors_name_the_argument(ur5):
    robot = mozzi.torch.Model(ur5)
    theta, dtheta, ddtheta = state(ur5, 16, requires_grad=False)
    with pytest.raises(
        TypeError, match=r"theta is torch.bfloat16, expected a tensor of torch.float64 or torch.float32"
    ):
        robot.mass_matrix(theta.bfloat16())
    with pytest.raises(TypeError, match=r"ddtheta is torch.float32, but theta is torch.float64: expected one dtype"):
        robot.inverse_dynamics(theta, dtheta, ddtheta.float())
    with pytest.raises(TypeError, match="dtheta is a ndarray, expected a tensor"):
        robot.inverse_dynamics(theta, dtheta.numpy(), ddtheta)
    with pytest.raises(ValueError, match=r"dtheta has shape \(5,\), expected \(..., 6\): one value per joint of 'ur5'"):
        robot.inverse_dynamics(theta, dtheta[:5], ddtheta)
    with pytest.raises(ValueError, match="theta is on meta, expected cpu"):
        robot.mass_matrix(theta.to("meta"))
    with pytest.raises(ValueError, match="no_such_frame"):
        robot.forward_kinematics(theta, "no_such_frame")
    with pytest.raises(ValueError, match="parameters has shape"):
        robot.inverse_dynamics(theta, dtheta, ddtheta, parameters=theta)


def test_the_package_does_not_import_torch():
    code = "import mozzi, sys; assert 'torch' not in sys.modules and 'mozzi.torch' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_copies(ur5):
    import copy
    import pickle

    robot = mozzi.torch.Model(ur5)
    theta = state(ur5, 17)[0]
    for other in [copy.deepcopy(robot), pickle.loads(pickle.dumps(robot))]:
        assert torch.equal(other.mass_matrix(theta), robot.mass_matrix(theta))


def rollouts(model, seed, *leading, steps=4):
    theta, dtheta, _ = state(model, seed, *leading)
    tau = torch.tensor(np.random.default_rng(seed).uniform(-1, 1, (*leading, steps, model.n)), requires_grad=True)
    return theta, dtheta, tau


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("method", ["rk4", "semi-implicit-euler", "euler"])
def test_rollouts_and_their_gradients_are_those_of_steps_in_tensors(models, name, method):
    model = models(name)
    robot = mozzi.torch.Model(model)
    for leading in [(), (3,)]:
        x = rollouts(model, 18, *leading)
        w = [
            torch.tensor(np.random.default_rng(k).normal(size=(*leading, 5, m)))
            for k, m in [(1, model.nq), (2, model.n)]
        ]
        found = robot.rollout(*x, 0.05, method)
        expected = robot.rollout(*x, 0.05, method, by_steps=True)
        for a, b in zip(found, expected):
            assert_close(a.detach().numpy(), b.detach().numpy(), tolerance=1e-11)
        losses = [sum((a * b).sum() for a, b in zip(w, tables)) for tables in (found, expected)]
        for a, b in zip(*(torch.autograd.grad(loss, x) for loss in losses)):
            assert_close(a.numpy(), b.numpy(), tolerance=1e-9)


def test_rollouts_by_torchs_checks(models):
    for name in ["furuta_pendulum", "two_link_adrift"]:
        robot, x = mozzi.torch.Model(models(name)), rollouts(models(name), 19, steps=2)
        assert gradcheck(lambda *x: robot.rollout(*x, 0.1), x)
        pi = parameters(models(name))
        steps = lambda *x: robot.rollout(*x[:3], 0.1, parameters=x[3])  # noqa: E731
        assert gradcheck(steps, (*x, pi), check_forward_ad=True, fast_mode=True)
        assert gradgradcheck(steps, (*x, pi), fast_mode=True)


def test_rollouts_under_transforms(models):
    model = models("furuta_pendulum")
    robot, x = mozzi.torch.Model(model), [t.detach() for t in rollouts(model, 20, 3)]
    loss = lambda *x: robot.rollout(*x, 0.1)[0].square().sum()  # noqa: E731
    together = vmap(grad(loss, argnums=(0, 1, 2)))(*x)
    start = [t.clone().requires_grad_() for t in x]
    compiled = torch.autograd.grad(torch.compile(loss, fullgraph=True, backend="aot_eager")(*start), start)
    for k in range(3):
        for a, b in zip(together, grad(loss, argnums=(0, 1, 2))(*(t[k] for t in x))):
            assert_close(a[k].numpy(), b.numpy(), tolerance=1e-11)
    for a, b in zip(together, compiled):
        assert_close(b.numpy(), a.numpy(), tolerance=1e-11)
    with pytest.raises(NotImplementedError, match="forward mode through a rollout"):
        jvp(loss, tuple(x), tuple(x))
    with pytest.raises((NotImplementedError, RuntimeError), match="second derivatives of a rollout"):
        jacrev(jacrev(loss, argnums=1), argnums=1)(*x)
    single = [t.float().requires_grad_() for t in x]
    found = robot.rollout(*single, 0.1)
    found[0].sum().backward()
    assert found[0].dtype == single[2].grad.dtype == torch.float32
    with pytest.raises(ValueError, match=r"tau has shape \(2,\), expected \(..., N, 2\)"):
        robot.rollout(x[0][0], x[1][0], x[2][0, 0], 0.1)
