"""`mozzi.jax`: values, derivatives in both modes up to the second order, vmap, scan, and errors."""

import os
import shutil
import subprocess
import sys
from functools import partial

import mozzi
import numpy as np
import pytest
from conftest import assert_close, load_mjcf, positions
from test_joints import ROBOT

jax = pytest.importorskip("jax", reason="JAX is not installed")
jax.config.update("jax_enable_x64", True)
HAS_GPU = jax.default_backend() == "gpu"
jax.config.update("jax_default_device", jax.devices("cpu")[0])
import jax.numpy as jnp  # noqa: E402, with jax
import mozzi.jax as mj  # noqa: E402
from jax.test_util import check_grads  # noqa: E402
from mozzi import _mozzi, _tangent  # noqa: E402

FORWARD, REVERSE = jax.jacfwd, jax.jacrev
ROBOTS = ["ur5", "panda", "anymal", "balls"]  # an arm, a mimic joint, a floating base, a ball and a free joint


@pytest.fixture(params=ROBOTS)
def robot(request, tmp_path):
    if request.param == "balls":
        return load_mjcf(tmp_path, ROBOT)
    return getattr(mozzi.models, request.param)(**({"floating": True} if request.param == "anymal" else {}))


@pytest.fixture
def balls(tmp_path):
    return load_mjcf(tmp_path, ROBOT)


def state(robot, random, *leading):
    """θ, θ̇, θ̈; τ takes the place of the last."""
    theta = positions(robot, random, *leading)
    for q, _, _ in robot._quaternions:
        theta[..., q : q + 4] /= np.linalg.norm(theta[..., q : q + 4], axis=-1, keepdims=True)
    return [theta, *(random.uniform(-2, 2, (*leading, robot.n)) for _ in range(2))]


def frame(robot):
    return robot.end_effector or {"panda": "panda_leftfinger", "anymal": "LF_FOOT"}.get(robot.name, "hand")


def quantities(robot):
    """Each function with its number of arguments and the package's method."""
    of_frame = frame(robot)
    at = lambda name: (
        lambda theta: getattr(mj, name)(robot, theta, of_frame),
        1,
        lambda theta: getattr(robot, name)(theta, of_frame),
    )
    plain = lambda name, count: (lambda *x: getattr(mj, name)(robot, *x), count, getattr(robot, name))
    return {
        "inverse_dynamics": plain("inverse_dynamics", 3),
        "forward_dynamics": plain("forward_dynamics", 3),
        "mass_matrix": plain("mass_matrix", 1),
        "gravity_forces": plain("gravity_forces", 1),
        "velocity_product": plain("velocity_product", 2),
        "bias_forces": plain("bias_forces", 2),
        "forward_kinematics": at("forward_kinematics"),
        "space_jacobian": at("space_jacobian"),
        "body_jacobian": at("body_jacobian"),
    }


@pytest.mark.parametrize("name", quantities(mozzi.models.ur5()))
def test_values_are_the_packages(robot, random, name):
    f, count, method = quantities(robot)[name]
    x = state(robot, random, 5)[:count]
    found = jax.jit(f)(*x)
    assert found.dtype == jnp.float64 and np.array_equal(found, method(*x)), name
    assert np.array_equal(f(*x), found)  # without jit
    assert_close(f(*(a[0] for a in x)), method(*(a[0] for a in x)), np.abs(method(*x)).max())
    assert f(*(a[:0] for a in x)).shape == (0, *found.shape[1:])  # no states
    with jax.enable_x64(False) if hasattr(jax, "enable_x64") else jax.experimental.enable_x64(False):
        single = [a.astype(np.float32) for a in x]
        assert np.array_equal(f(*single), method(*single)) and f(*single).dtype == jnp.float32


@pytest.mark.parametrize("name", ["inverse_dynamics", "forward_dynamics"])
def test_jacobians_are_the_packages(robot, random, name):
    f, count, _ = quantities(robot)[name]
    x = state(robot, random)
    expected = getattr(robot, name + "_derivatives")(*x)[-3:]
    V = _tangent.velocities(np, robot._quaternions, x[0], np.eye(robot.nq))  # row k of the k-th number of θ
    for mode in (FORWARD, REVERSE):
        by_theta, *others = jax.jit(mode(f, (0, 1, 2)))(*x)
        assert_close(by_theta, expected[0] @ V.T, np.abs(expected[0]).max(), 1e-11)
        for found, matrix in zip(others, expected[1:]):
            assert_close(found, matrix, np.abs(matrix).max(), 1e-11)
    # along θ ⊕ δ they are the package's own
    along = jax.jacrev(lambda d: f(mj.integrate(robot, x[0], d), *x[1:]))(np.zeros(robot.n))
    assert_close(along, expected[0], np.abs(expected[0]).max(), 1e-11)


@pytest.mark.parametrize(
    "name",
    ["inverse_dynamics", "forward_dynamics", "mass_matrix", "forward_kinematics", "space_jacobian", "body_jacobian"],
)
def test_first_and_second_derivatives_equal_differences(robot, random, name):
    f, count, _ = quantities(robot)[name]
    x = state(robot, random)[:count]
    size = float(jnp.abs(f(*x)).max())
    check_grads(lambda *x: f(*x) / size, x, order=2, modes=["fwd", "rev"], atol=2e-3, rtol=2e-3, eps=1e-5)


@pytest.mark.parametrize("name", ["inverse_dynamics", "forward_dynamics", "mass_matrix", "forward_kinematics"])
def test_four_ways_to_a_hessian(balls, random, name):
    f, count, _ = quantities(balls)[name]
    theta, *rest = state(balls, random)[:count]
    weight = random.normal(size=f(theta, *rest).shape)
    g = lambda theta: (weight * f(theta, *rest)).sum()
    expected = jax.hessian(g)(theta)
    for outer in (FORWARD, REVERSE):
        for inner in (FORWARD, REVERSE):
            assert_close(jax.jit(outer(inner(g)))(theta), expected, float(jnp.abs(expected).max()), 1e-10)
    assert_close(expected, expected.T, float(jnp.abs(expected).max()), 1e-10)
    with pytest.raises(NotImplementedError, match=f"no third derivatives of {name}"):
        jax.jacfwd(jax.hessian(g))(theta)


def test_a_gradient_is_tangent_to_the_sphere(balls, random):
    theta, dtheta, ddtheta = state(balls, random)
    gradient = jax.grad(lambda theta: (mj.inverse_dynamics(balls, theta, dtheta, ddtheta) ** 2).sum())(theta)
    for q, _, _ in balls._quaternions:
        assert abs(gradient[q : q + 4] @ theta[q : q + 4]) < 1e-12 * np.abs(gradient).max()
    tau = balls.inverse_dynamics(theta, dtheta, ddtheta)
    expected = balls.inverse_dynamics_vjp(theta, dtheta, ddtheta, 2.0 * tau).d_theta
    assert_close(mj.tangent_gradient(balls, theta, gradient), expected)
    assert_close(_tangent.position_gradient(np, balls._quaternions, theta, expected), gradient)


def test_maps_of_the_tangent_are_transposes_and_inverses(balls, random):
    places, (theta, u, _) = balls._quaternions, state(balls, random, 3)
    rates = _tangent.rates(np, places, theta, u)
    assert_close(_tangent.velocities(np, places, theta, rates), u)
    moved = lambda h: _tangent.advance(np, places, theta, h * u)
    assert_close((moved(1e-5) - moved(-1e-5)) / 2e-5, rates, tolerance=1e-9)
    g, p = random.normal(size=u.shape), random.normal(size=theta.shape)
    assert_close(
        (_tangent.position_gradient(np, places, theta, g) * p).sum(),
        (g * _tangent.velocities(np, places, theta, p)).sum(),
    )
    assert_close((_tangent.velocity_gradient(np, places, theta, p) * u).sum(), (p * rates).sum())


def test_vmap(robot, random):
    theta, dtheta, tau = state(robot, random, 4, 3)
    f = lambda *x: mj.forward_dynamics(robot, *x)
    expected = robot.forward_dynamics(theta, dtheta, tau)
    twice = jax.jit(jax.vmap(jax.vmap(f)))
    assert_close(twice(theta, dtheta, tau), expected)
    assert str(jax.make_jaxpr(jax.vmap(jax.vmap(f)))(theta, dtheta, tau)).count("mozzi_quantity") == 1  # one call
    middle = jax.vmap(f, in_axes=(1, 1, 1), out_axes=1)(theta, dtheta, tau)
    assert_close(middle, expected)
    some = jax.vmap(f, in_axes=(0, None, 0))(theta[:, 0], dtheta[0, 0], tau[:, 0])
    assert_close(some, robot.forward_dynamics(theta[:, 0], dtheta[0, 0], tau[:, 0]))
    one = jax.vmap(jax.grad(lambda *x: f(*x).sum(), (0, 2)), in_axes=(None, None, 0))(theta[0, 0], dtheta[0, 0], tau[0])
    many = jax.grad(lambda *x: f(*x).sum(), (0, 2))(np.broadcast_to(theta[0, 0], theta[0].shape), dtheta[0, 0], tau[0])
    for found, wanted in zip(one, many):
        assert_close(found, wanted)


def test_leading_axes_are_broadcast(ur5, random):
    theta, dtheta, ddtheta = state(ur5, random, 4, 1)[0], *state(ur5, random, 3)[1:]
    f = lambda *x: mj.inverse_dynamics(ur5, *x)
    assert np.array_equal(f(theta, dtheta, ddtheta), ur5.inverse_dynamics(theta, dtheta, ddtheta))
    gradient = jax.grad(lambda *x: f(*x).sum(), 1)(theta, dtheta, ddtheta)
    alone = [jax.grad(lambda d: f(theta[:, 0], d, a).sum())(d) for d, a in zip(dtheta, ddtheta)]
    assert_close(gradient, alone)
    assert_close(f(list(theta[0, 0]), [0.0] * 6, [0] * 6), ur5.gravity_forces(theta[0, 0]))


@pytest.mark.parametrize("name", ["inverse_dynamics", "forward_dynamics", "mass_matrix", "bias_forces"])
def test_parameters(robot, random, name):
    f = lambda pi, *x: getattr(mj, name)(robot, *x, parameters=pi)
    count = quantities(robot)[name][1]
    x, own = state(robot, random, 3)[:count], robot.parameters
    scale = 1.0 + 0.1 * random.uniform(size=(3, len(own)))
    method = getattr(robot, name)
    assert_close(f(scale * own, *x), method(*x, parameters=scale * own))
    assert_close(f(own, *x), method(*x), np.abs(method(*x)).max(), 1e-10)
    one = [a[0] for a in x]
    J = jax.jacrev(f)(own, *one)
    assert_close(J, jax.jacfwd(f)(own, *one), np.abs(J).max(), 1e-10)
    if name == "inverse_dynamics":
        Y = robot.regressor(*one)
        assert_close(J, Y, np.abs(Y).max(), 1e-11)
    size = float(jnp.abs(f(own, *one)).max())
    # along a direction in which the robot stays a robot
    g = lambda s, *x: f(own * (1.0 + 0.1 * s * scale[0]), *x) / size
    check_grads(g, (0.0, *one), order=2, modes=["fwd", "rev"], atol=2e-3, rtol=2e-3, eps=1e-5)


def test_scan_and_fori_loop(ur5, random):
    theta, dtheta, _ = state(ur5, random)
    body = lambda carry, tau: (
        (carry[0] + 0.01 * carry[1], carry[1] + 0.01 * mj.forward_dynamics(ur5, *carry, tau)),
        carry[1],
    )
    taus = random.uniform(-1, 1, (20, 6))
    (found, _), _ = jax.jit(lambda *x: jax.lax.scan(body, x[:2], x[2]))(theta, dtheta, taus)
    q, v = theta, dtheta
    for tau in taus:
        q, v = q + 0.01 * v, v + 0.01 * ur5.forward_dynamics(q, v, tau)
    assert_close(found, q)
    looped = jax.jit(lambda x: jax.lax.fori_loop(0, 5, lambda k, x: x + mj.gravity_forces(ur5, x), x))(theta)
    for _ in range(5):
        theta = theta + ur5.gravity_forces(theta)
    assert_close(looped, theta, tolerance=1e-9)


def test_rollouts_with_constraints_are_refused():
    rod = {"name": "rod", "kind": "distance", "length": 0.6, "a": {"frame": None, "xyz": [0.9, 0, 0]}, "b": {"frame": "tip"}}
    arm = mozzi.models.two_link_planar().with_constraints([rod])
    with pytest.raises(ValueError, match="do not keep constraints, and the robot has 1: Model.rollout does"):
        mozzi.jax.rollout(arm, np.zeros(2), np.zeros(2), np.zeros((5, 2)), 0.01)



@pytest.mark.parametrize("method", ["rk4", "euler", "semi-implicit-euler"])
def test_rollout(robot, random, method):
    theta, dtheta, _ = state(robot, random)
    tau = random.uniform(-1, 1, robot.n)
    taus = np.broadcast_to(tau, (10, robot.n))
    found = mj.rollout(robot, theta, dtheta, taus, 0.01, method)
    expected = robot.simulate(theta, dtheta, 0.1, 10, torque=tau, method=method, joint_limits="ignore")
    assert_close(found.theta, expected.theta, tolerance=1e-9)
    assert_close(found.dtheta, expected.dtheta, tolerance=1e-9)
    compiled = mj._steps._cache_size()
    mj.rollout(robot, theta, dtheta, 2 * taus, 0.02, method)
    assert mj._steps._cache_size() == compiled  # a second call compiles nothing
    batch = mj.rollout(robot, np.stack([theta, theta]), dtheta, taus, 0.01, method)
    assert batch.theta.shape == (2, 11, robot.nq)
    assert_close(batch.dtheta[1], found.dtheta, tolerance=1e-9)
    # the parameters' leading axes are those of the result, too, and their type is no other
    several = np.tile(robot.parameters, (2, 1))
    of_each = mj.rollout(robot, theta.astype(np.float32), dtheta, taus, 0.01, method, parameters=several)
    assert of_each.theta.shape == (2, 11, robot.nq)
    assert_close(of_each.dtheta[1], found.dtheta, tolerance=1e-4)
    loss = lambda theta, dtheta, tau: (mj.rollout(robot, theta, dtheta, tau, 0.01, method).theta[-1] ** 2).sum()
    if robot.n < 12 and method == "rk4":
        check_grads(
            jax.jit(loss), (theta, dtheta, taus[:3]), order=1, modes=["fwd", "rev"], atol=1e-3, rtol=1e-3, eps=1e-5
        )


def test_robots_are_constants_by_content(ur5):
    again = mozzi.models.ur5()
    assert ur5._jax_handle() == again._jax_handle() != mozzi.models.panda()._jax_handle()
    code = "import mozzi; print(mozzi.models.ur5()._jax_handle())"
    other = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert int(other.stdout) == ur5._jax_handle()
    f = jax.jit(mj.gravity_forces, static_argnums=0)
    f(ur5, np.ones(6))
    f(again, np.ones(6))
    assert f._cache_size() == 1
    del again
    assert_close(f(ur5, np.ones(6)), ur5.gravity_forces(np.ones(6)))


def test_errors_name_the_argument(ur5, random):
    theta = np.zeros(6)
    for given, error, text in [
        ((np.zeros(7), theta, theta), ValueError, r"theta has shape \(7,\), expected \(..., 6\)"),
        ((np.zeros((5, 12)), theta, theta), ValueError, r"theta has shape \(5, 12\), expected \(..., 6\)"),
        ((theta, 0.0, theta), ValueError, r"dtheta has shape \(\), expected \(..., 6\)"),
        (
            (np.zeros((2, 6)), np.zeros((3, 6)), theta),
            ValueError,
            r"dtheta has leading axes \(3,\), which do not go with \(2,\)",
        ),
        ((theta.astype(np.float16),) * 3, TypeError, "float16, expected float32 or float64"),
    ]:
        with pytest.raises(error, match=text):
            mj.inverse_dynamics(ur5, *given)
    with pytest.raises(ValueError, match=r"parameters has shape \(3,\), expected \(..., 90\)"):
        mj.mass_matrix(ur5, theta, parameters=np.zeros(3))
    with pytest.raises(ValueError, match="there is no frame `nowhere`"):
        mj.forward_kinematics(ur5, theta, "nowhere")
    with pytest.raises(TypeError, match="model is a str, expected a mozzi.Model"):
        mj.mass_matrix("ur5", theta)
    with pytest.raises(ValueError, match="threads is 0"):
        mj.mass_matrix(ur5, theta, threads=0)
    with pytest.raises(ValueError, match="method is 'rk5', expected 'rk4'"):
        mj.rollout(ur5, theta, theta, np.zeros((3, 6)), 0.1, "rk5")
    with pytest.raises(ValueError, match=r"tau has shape \(6,\), expected \(..., N, 6\)"):
        mj.rollout(ur5, theta, theta, theta, 0.1)
    # found when it runs: text of the library, with the state's index
    anymal = mozzi.models.anymal(floating=True)
    configuration = state(anymal, random, 2)[0]
    configuration[1, :4] *= 1.1
    with pytest.raises(Exception, match=r"state \[1\].*unit quaternion"):
        mj.gravity_forces(anymal, configuration).block_until_ready()
    with pytest.raises(Exception, match=r"state \[1\].*unit quaternion"):
        jax.jvp(lambda theta: mj.gravity_forces(anymal, theta), (configuration,), (configuration,))[
            1
        ].block_until_ready()


def test_the_handler_checks_what_xla_does_not(ur5):
    from mozzi import _jax

    of = _jax.quantity(ur5, "gravity_forces", None, False, None)
    for changed, x, text in [
        ({"model": 5}, np.zeros(6), "no robot in this process has the hash"),
        ({"name": "nothing"}, np.zeros(6), "nothing"),
        ({}, np.zeros((5, 12)), r"theta has shape \(5, 12\), expected \(..., 6\)"),
        ({}, np.zeros(6, np.int64), "XLA's type"),
    ]:
        with pytest.raises(Exception, match=text):
            _jax.evaluate(jnp.asarray(x), of=of._replace(**changed), along=(), wanted=0)[0].block_until_ready()


def test_threads_do_not_change_results(robot, random):
    theta, dtheta, tau = state(robot, random, 40)
    f = lambda threads: lambda d: mj.forward_dynamics(robot, theta, d, tau, threads=threads)
    values = [jax.jvp(f(threads), (dtheta,), (tau,)) for threads in (None, 1, 2)]
    for value, derivative in values:
        assert np.array_equal(value, values[0][0]) and np.array_equal(derivative, values[0][1])


def test_structs_are_those_of_the_header(tmp_path):
    compiler = shutil.which("c++") or pytest.skip(
        "there is no C++ compiler"
    )  # C does not know the types of old headers
    try:
        from jax.ffi import include_dir
    except ImportError:
        from jax.extend.ffi import include_dir
    layout = _mozzi._jax_layout()
    lines = "".join(f'  printf("%zu\\n", (size_t)({expression}));\n' for expression in layout)
    source = tmp_path / "layout.cpp"
    renamed = "#if XLA_FFI_API_MINOR >= 4\n#define XLA_FFI_Extension_Base XLA_FFI_InternalExtension\n#endif\n"
    head = f'#include <stdio.h>\n#include "xla/ffi/api/c_api.h"\n{renamed}'
    source.write_text(f"{head}int main(void) {{\n{lines}}}\n")
    program = tmp_path / "layout"
    subprocess.run([compiler, f"-I{include_dir()}", str(source), "-o", str(program)], check=True, timeout=60)
    found = subprocess.run([str(program)], capture_output=True, text=True, check=True, timeout=60).stdout.split()
    assert dict(zip(layout, map(int, found))) == layout


def on_cuda(function, *x):
    """The program for a GPU, which need not be there."""
    return jax.jit(function).trace(*x).lower(lowering_platforms=("cuda",)).as_text()


def test_programs_for_a_gpu():
    ur5 = mozzi.models.ur5()
    theta = jnp.zeros((3, 6), jnp.float32)
    text = on_cuda(lambda q: mj.inverse_dynamics(ur5, q, q, q), theta)
    assert text.count("@mozzi_quantity_gpu(") == 1 and 'quantity = "inverse_dynamics"' in text
    text = on_cuda(jax.grad(lambda q: mj.forward_dynamics(ur5, q, q, q).sum()), theta)
    assert 'quantity = "forward_dynamics_vjp"' in text and "@mozzi_quantity(" not in text
    # a quaternion's gradient has four numbers, from three of the kernel
    anymal = mozzi.models.anymal(floating=True)
    q, v = jnp.ones((2, anymal.nq)), jnp.ones((2, anymal.n))
    text = on_cuda(jax.grad(lambda q: mj.inverse_dynamics(anymal, q, v, v).sum()), q)
    assert 'quantity = "inverse_dynamics_vjp"' in text and text.count("stablehlo.custom_call") == 1
    for function, words in [
        (jax.jacfwd(lambda q: mj.inverse_dynamics(ur5, q, q, q).sum()), "of first order, in reverse mode"),
        (lambda q: mj.mass_matrix(ur5, q, parameters=jnp.asarray(ur5.parameters, q.dtype)), "of given parameters on a GPU"),
    ]:
        with pytest.raises(NotImplementedError, match=words):
            on_cuda(function, theta)
    with pytest.raises(TypeError, match="mass_matrix has no gradient on a GPU"):
        on_cuda(jax.grad(lambda q: mj.mass_matrix(ur5, q).sum()), theta)


@pytest.mark.skipif(not HAS_GPU, reason="JAX has no GPU")
@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_arrays_on_a_gpu(robot, dtype):
    n, random = robot.n, np.random.default_rng(1)
    epsilon = float(jnp.finfo(dtype).eps)
    *host, w_host = [
        a.astype(dtype).astype("float64") for a in (*state(robot, random, 100), random.uniform(-1, 1, (100, n)))
    ]
    *x, w = jax.device_put([jnp.asarray(a, dtype) for a in (*host, w_host)], jax.devices("gpu")[0])

    def check(found, expected, what):
        found, expected = (np.asarray(a, np.float64).reshape(100, -1) for a in (found, expected))
        error = np.abs(found - expected).max(1) / np.abs(expected).max(1)
        assert error.max() < 2000 * epsilon, f"{what}: {error.max() / epsilon} eps"

    for name in ("inverse_dynamics", "forward_dynamics"):
        function = partial(getattr(mj, name), robot)
        expected = getattr(robot, name)(*host)
        assert jax.jit(function)(*x).device.platform == "gpu"
        check(jax.jit(function)(*x), expected, name)
        check(jax.jit(jax.vmap(function))(*x), expected, name)
        gradients = jax.jit(jax.grad(lambda *x: (function(*x) * w).sum(), (0, 1, 2)))(*x)
        products = getattr(robot, f"{name}_vjp")(*host, w_host)
        for k in (1, 2):
            check(gradients[k], products[k], f"{name}, gradient {k}")
        reference = jax.grad(lambda *x: (function(*x) * w_host).sum())(*map(jnp.asarray, host))
        check(gradients[0], reference, f"{name}, gradient 0")
    check(jax.jit(partial(mj.mass_matrix, robot))(x[0]), robot.mass_matrix(host[0]), "mass matrix")


def test_names_are_those_of_robots():
    assert {name for name in dir(mj) if not name.startswith("_")} == set(mj.__all__)
    for guess, meant in [
        ("coriolis_matrix", "mozzi.Model.coriolis_matrix computes it in NumPy.*mozzi.jax has Rollout, bias_forces, "),
        ("rnea", "that is mozzi.jax.inverse_dynamics"),
        ("name", "'name': mozzi.jax has"),
        ("__wrapped__", "'__wrapped__'$"),
    ]:
        with pytest.raises(AttributeError, match=meant):
            getattr(mj, guess)


@pytest.mark.parametrize(
    ("broken", "expected"),
    [
        ("ModuleNotFoundError(name='jax')", "mozzi.jax needs JAX, which is not installed: pip install jax"),
        ("ImportError('no jaxlib of this version')", "no jaxlib of this version"),
    ],
)
def test_the_package_does_not_import_jax(tmp_path, broken, expected):
    code = (
        "import sys, mozzi; assert 'jax' not in sys.modules\ntry: import mozzi.jax\nexcept ImportError as e: print(e)"
    )
    (tmp_path / "jax.py").write_text(f"raise {broken}")
    path = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    found = subprocess.run(
        [sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True, timeout=60
    )
    assert found.stdout.strip() == expected, found.stderr
