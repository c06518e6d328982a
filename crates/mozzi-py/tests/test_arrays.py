"""What is taken for an array, what comes back, and where it is written."""

import decimal
import fractions
import threading

import mozzi
import numpy as np
import pytest
from conftest import assert_close, positions, robots, state

# Every method of a state, with the names of its arguments.
METHODS = {
    "inverse_dynamics": ("theta", "dtheta", "ddtheta"),
    "forward_dynamics": ("theta", "dtheta", "tau"),
    "mass_matrix": ("theta",),
    "mass_matrix_rate": ("theta", "dtheta"),
    "coriolis_matrix": ("theta", "dtheta"),
    "velocity_product": ("theta", "dtheta"),
    "gravity_forces": ("theta",),
    "bias_forces": ("theta", "dtheta"),
    "tip_forces": ("theta",),
    "joint_friction": ("dtheta",),
    "kinetic_energy": ("theta", "dtheta"),
    "potential_energy": ("theta",),
    "forward_kinematics": ("theta",),
    "space_jacobian": ("theta",),
    "body_jacobian": ("theta",),
    "space_jacobian_rate": ("theta", "dtheta"),
    "body_jacobian_rate": ("theta", "dtheta"),
    "space_jacobian_derivative": ("theta",),
    "body_jacobian_derivative": ("theta",),
    "task_space_dynamics": ("theta", "dtheta"),
    "inverse_dynamics_derivatives": ("theta", "dtheta", "ddtheta"),
    "forward_dynamics_derivatives": ("theta", "dtheta", "tau"),
    "gravity_forces_derivative": ("theta",),
    "tip_forces_derivative": ("theta",),
    "mass_matrix_product_derivative": ("theta", "x"),
    "center_of_mass": ("theta",),
    "center_of_mass_velocity": ("theta", "dtheta"),
    "center_of_mass_acceleration": ("theta", "dtheta", "ddtheta"),
    "center_of_mass_jacobian": ("theta",),
    "momentum": ("theta", "dtheta"),
    "momentum_rate": ("theta", "dtheta", "ddtheta"),
    "centroidal_momentum_matrix": ("theta",),
    "centroidal_momentum_bias": ("theta", "dtheta"),
    "regressor": ("theta", "dtheta", "ddtheta"),
    "energy_regressors": ("theta", "dtheta"),
    "frame_poses": ("theta",),
}
TAKES_OUT = [name for name in METHODS if name not in ("task_space_dynamics", "energy_regressors") and "dynamics_deriv" not in name]


def arguments(robot, names, random, *leading):
    return [
        positions(robot, random, *leading) if name == "theta" else random.uniform(-2, 2, (*leading, robot.n))
        for name in names
    ]


def parts(result):
    return result if isinstance(result, tuple) else (result,)


@pytest.mark.parametrize("method", METHODS)
def test_leading_axes_are_many_states(method, ur5, random):
    call, given = getattr(ur5, method), arguments(ur5, METHODS[method], random, 3, 5)
    many = parts(call(*given))
    for place in np.ndindex(3, 5):
        one = parts(call(*(table[place] for table in given)))
        for found, expected in zip(many, one):
            assert found.shape == (3, 5, *np.shape(expected))
            assert_close(found[place], expected)


@pytest.mark.parametrize("method", METHODS)
def test_float32_stays_float32(method, ur5, random):
    given = arguments(ur5, METHODS[method], random, 4)
    call = getattr(ur5, method)
    for found, expected in zip(parts(call(*(x.astype(np.float32) for x in given))), parts(call(*given))):
        assert found.dtype == np.float32 and expected.dtype == np.float64
        if method != "task_space_dynamics":  # near a singular state
            assert_close(found, expected, tolerance=1e-3)
    mixed = call(*given[:-1], given[-1].astype(np.float32))
    assert parts(mixed)[0].dtype == (np.float32 if len(given) == 1 else np.float64)


@pytest.mark.parametrize("method", METHODS)
def test_strided_and_foreign_arrays(method, ur5, random):
    call, given = getattr(ur5, method), arguments(ur5, METHODS[method], random, 4)
    expected = parts(call(*given))
    frozen = [x.copy() for x in given]
    for x in frozen:
        x.flags.writeable = False
    ways = {
        "Fortran": [np.asfortranarray(x) for x in given],
        "strided": [np.repeat(np.repeat(x, 2, 0), 3, 1)[::2, ::3] for x in given],
        "backwards": [np.ascontiguousarray(x[::-1, ::-1])[::-1, ::-1] for x in given],
        "read-only": frozen,
        "swapped bytes": [x.astype(">f8") for x in given],
        "unaligned": [np.frombuffer(b"\0" + x.tobytes(), np.uint8)[1:].view(x.dtype).reshape(x.shape) for x in given],
        "lists": [x.tolist() for x in given],
        "objects": [x.astype(object) for x in given],
        "long doubles": [x.astype(np.longdouble) for x in given],
    }
    for way, arrays in ways.items():
        for found, same in zip(parts(call(*arrays)), expected):
            assert np.array_equal(found, same), way


@pytest.mark.parametrize("method", TAKES_OUT)
def test_out(method, ur5, random):
    for leading in [(), (4,)]:
        call, given = getattr(ur5, method), arguments(ur5, METHODS[method], random, *leading)
        expected = np.asarray(call(*given))
        place = np.full_like(expected, np.nan)
        assert call(*given, out=place) is place and np.array_equal(place, expected)
        if expected.ndim:
            wide = np.full((*expected.shape[:-1], 2 * expected.shape[-1]), np.nan)
            assert np.array_equal(call(*given, out=wide[..., ::2]), expected) and np.isnan(wide[..., 1::2]).all()
        single = np.zeros(expected.shape, np.float32)
        assert_close(call(*given, out=single), expected, tolerance=1e-6)
        with pytest.raises(ValueError, match=r"out has shape"):
            call(*given, out=np.zeros((*expected.shape, 2)))
        with pytest.raises(TypeError, match="out is no array"):
            call(*given, out=expected.tolist())
        place.flags.writeable = False
        with pytest.raises(ValueError, match="read-only"):
            call(*given, out=place)
        with pytest.raises(TypeError):
            call(*given, out=np.zeros(expected.shape, int))


def test_out_may_be_an_argument(ur5, random):
    for leading in [(), (50,)]:
        theta, dtheta, ddtheta = state(ur5, random, *leading)
        expected = ur5.inverse_dynamics(theta, dtheta, ddtheta)
        assert ur5.inverse_dynamics(theta, dtheta, ddtheta, out=ddtheta) is ddtheta
        assert np.array_equal(ddtheta, expected)
        buffer = np.concatenate([theta.ravel(), np.zeros(6)])
        overlapping = buffer[6:].reshape(theta.shape)
        theta = buffer[: theta.size].reshape(theta.shape)
        expected = ur5.gravity_forces(theta.copy())
        assert np.array_equal(ur5.gravity_forces(theta, out=overlapping), expected)


def test_broadcasting(ur5, random):
    theta, dtheta, ddtheta = state(ur5, random, 4, 1), random.uniform(-1, 1, 6), random.uniform(-1, 1, (3, 6))
    theta = theta[0]
    found = ur5.inverse_dynamics(theta, dtheta, ddtheta)
    assert found.shape == (4, 3, 6)
    for i, k in np.ndindex(4, 3):
        assert_close(found[i, k], ur5.inverse_dynamics(theta[i, 0], dtheta, ddtheta[k]))
    wrenches = random.uniform(-3, 3, (4, 1, 6))
    found = ur5.tip_forces(theta, wrenches)
    assert found.shape == (4, 1, 6)
    assert_close(found[2, 0], ur5.body_jacobian(theta[2, 0]).T @ wrenches[2, 0])
    assert ur5.gravity_forces(np.zeros((0, 6))).shape == (0, 6)
    assert ur5.mass_matrix(np.zeros((2, 0, 6))).shape == (2, 0, 6, 6)
    with pytest.raises(ValueError, match=r"dtheta has leading axes \(3,\), which do not go with \(2,\)"):
        ur5.inverse_dynamics(np.zeros((2, 6)), np.zeros((3, 6)), np.zeros(6))


def test_wrenches_of_each_state(ur5, random):
    theta = positions(ur5, random, 5)
    wrenches = random.uniform(-3, 3, (5, 6))
    many = ur5.tip_forces(theta, applied_wrenches={"tool0": wrenches, "forearm_link": wrenches[0]})
    for k in range(5):
        one = ur5.tip_forces(theta[k], applied_wrenches={"tool0": wrenches[k], "forearm_link": wrenches[0]})
        assert_close(many[k], one)


def test_threads(random):
    for name, robot in robots().items():
        theta, dtheta, ddtheta = state(robot, random, 3001)
        expected = robot.inverse_dynamics(theta, dtheta, ddtheta, threads=1)
        for threads in (None, 2, 3):
            assert np.array_equal(robot.inverse_dynamics(theta, dtheta, ddtheta, threads=threads), expected), name


def test_many_threads_share_a_model(ur5, random):
    theta, dtheta, ddtheta = state(ur5, random, 200)
    expected = ur5.inverse_dynamics(theta, dtheta, ddtheta)
    wrong = []

    def work(number):
        for k in range(number, 200, 8):
            one = ur5.inverse_dynamics(theta[k], dtheta[k], ddtheta[k])
            if not np.allclose(one, expected[k], rtol=1e-12, atol=1e-12):
                wrong.append(k)
            if not np.array_equal(ur5.inverse_dynamics(theta, dtheta, ddtheta, threads=1 + number % 3), expected):
                wrong.append("many")

    workers = [threading.Thread(target=work, args=(number,)) for number in range(8)]
    [worker.start() for worker in workers]
    [worker.join() for worker in workers]
    assert not wrong


def test_numbers_of_other_kinds(ur5):
    expected = ur5.gravity_forces(np.array([0.0, 1, 2, 0, 1, 1]))
    for kind in (np.int8, np.uint16, np.int64, np.float16, np.float32):
        assert_close(ur5.gravity_forces(np.array([0, 1, 2, 0, 1, 1], kind)), expected, tolerance=1e-5)
    assert np.array_equal(ur5.gravity_forces((0, 1, 2, False, True, fractions.Fraction(1))), expected)
    assert np.array_equal(ur5.gravity_forces([0, 1, 2, 0, 1, decimal.Decimal(1)]), expected)
    assert np.array_equal(ur5.gravity_forces(np.ma.array([0.0, 1, 2, 0, 1, 1])), expected)

    class Other:
        def __array__(self, dtype=None, copy=None):
            return np.array([0.0, 1, 2, 0, 1, 1])

    assert np.array_equal(ur5.gravity_forces(Other()), expected)


def test_nan_gives_nan_and_nothing_else(ur5, random):
    theta = positions(ur5, random, 20)
    expected = ur5.gravity_forces(theta)
    theta[7, 1] = np.nan
    found = ur5.gravity_forces(theta)
    assert np.isnan(found[7]).any()
    assert np.array_equal(np.delete(found, 7, 0), np.delete(expected, 7, 0))


def test_memory_is_given_back(ur5, random):
    import tracemalloc

    theta, dtheta, ddtheta = state(ur5, random)
    many = state(ur5, random, 100)
    for _ in range(3):
        ur5.inverse_dynamics(theta, dtheta, ddtheta), ur5.inverse_dynamics(*many), ur5.mass_matrix([0.0] * 6)
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    for _ in range(1000):
        ur5.inverse_dynamics(theta, dtheta, ddtheta), ur5.inverse_dynamics(*many), ur5.mass_matrix([0.0] * 6)
    grown = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    assert grown < 20_000
