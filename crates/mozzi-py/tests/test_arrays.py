"""What is taken for an array, what comes back, and where it is written."""

import decimal
import fractions
import inspect
import threading

import mozzi
import numpy as np
import pytest
from conftest import assert_close, positions, robots, state

def required(method):
    """The names of the arguments that have no default."""
    parameters = inspect.signature(method).parameters.values()
    return tuple(x.name for x in parameters if x.default is x.empty and x.name != "self")


# Every method of a state, with the names of its arguments.
METHODS = {
    name: required(method)
    for name, method in vars(mozzi.Model).items()
    if callable(method) and not name.startswith("_") and {"out", "threads"} <= set(inspect.signature(method).parameters)
}


def taking(argument):
    """The methods that have this argument."""
    return [name for name in METHODS if argument in inspect.signature(getattr(mozzi.Model, name)).parameters]


def arguments(robot, names, random, *leading):
    return [
        positions(robot, random, *leading)
        if name == "theta"
        else random.uniform(-2, 2, (*leading, 6 if name == "w" else robot.n))
        for name in names
    ]


def parts(result):
    return result if isinstance(result, tuple) else (result,)


def test_methods_are_of_states():
    assert len(METHODS) >= 38 and METHODS["inverse_dynamics"] == ("theta", "dtheta", "ddtheta")
    assert set().union(*METHODS.values()) <= {"theta", "dtheta", "ddtheta", "tau", "x", "w"}


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
    for found, expected in zip(parts(call(*(x[0].astype(np.float32) for x in given))), parts(call(*given))):
        assert isinstance(found, float) or found.dtype == np.float32
        if method != "task_space_dynamics":
            assert_close(found, expected[0], np.abs(expected).max(initial=1e-3), tolerance=1e-3)
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


@pytest.mark.parametrize("method", METHODS)
def test_out(method, ur5, random):
    for leading in [(), (4,)]:
        call, given = getattr(ur5, method), arguments(ur5, METHODS[method], random, *leading)
        result = call(*given)
        many = isinstance(result, tuple)
        expected = [np.asarray(x) for x in parts(result)]
        out = (lambda arrays: arrays) if many else (lambda arrays: arrays[0])
        places = [np.full_like(x, np.nan) for x in expected]
        found = call(*given, out=out(places))
        assert all(x is place and np.array_equal(x, same) for x, place, same in zip(parts(found), places, expected, strict=True))
        if expected[0].ndim:
            wide = [np.full((*x.shape[:-1], 2 * x.shape[-1]), np.nan) for x in expected]
            found = parts(call(*given, out=out([x[..., ::2] for x in wide])))
            assert all(np.array_equal(x, y) and np.isnan(z[..., 1::2]).all() for x, y, z in zip(found, expected, wide))
        single = [np.zeros(x.shape, np.float32) for x in expected]
        for x, y in zip(parts(call(*given, out=out(single))), expected):
            assert_close(x, y, tolerance=1e-6)
        name = f"out.{result._fields[0]}" if many else "out"
        with pytest.raises(ValueError, match=rf"^{name} has shape"):
            call(*given, out=out([np.zeros((*x.shape, 2)) for x in expected]))
        with pytest.raises(TypeError, match=f"^{name} is no array"):
            call(*given, out=out([x.tolist() for x in expected]))
        for place in places:
            place.flags.writeable = False
        with pytest.raises(ValueError, match="read-only"):
            call(*given, out=out(places))
        with pytest.raises(TypeError):
            call(*given, out=out([np.zeros(x.shape, int) for x in expected]))


def test_out_of_several_results(ur5, random):
    for leading in [(), (50,)]:
        theta, dtheta = state(ur5, random, *leading)[:2]
        expected = ur5.energy_regressors(theta, dtheta)
        for kind in (list, tuple, expected._make):
            places = kind(np.full_like(x, np.nan) for x in expected)
            found = ur5.energy_regressors(theta, dtheta, out=places)
            assert type(found) is mozzi.EnergyRegressors and all(x is y for x, y in zip(found, places))
            assert all(np.array_equal(x, y) for x, y in zip(found, expected))
        same = np.zeros_like(expected[0])
        first, second = (f"out.{name}" for name in expected._fields)
        with pytest.raises(ValueError, match=f"^{first} and {second} are the same array, expected one for each$"):
            ur5.energy_regressors(theta, dtheta, out=[same, same])
        names = f"expected 2 arrays: {', '.join(expected._fields)}"
        with pytest.raises(ValueError, match=f"^out has 3 arrays, {names}$"):
            ur5.energy_regressors(theta, dtheta, out=[same, same, same])
        with pytest.raises(TypeError, match=f"^out is a dict, {names}$"):
            ur5.energy_regressors(theta, dtheta, out={})
        table = np.zeros((2, *same.shape))
        ur5.energy_regressors(theta, dtheta, out=table)
        assert np.array_equal(table, np.stack(expected))


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


def check_one_by_one(method, robot, random, one_by_one):
    """Many states with an argument of each, beside one state after the other: `one_by_one(k)` is the robot and its arguments."""
    given = arguments(robot, METHODS[method], random, 5)

    def check(**options):
        many = parts(getattr(robot, method)(*given, **options))
        for k in range(5):
            other, own = one_by_one(k)
            one = parts(getattr(other, method)(*(x[k] for x in given), **own))
            for found, expected in zip(many, one, strict=True):
                size = np.abs(expected).max(initial=1e-3)
                assert_close(found[k], expected, size, tolerance=1e-9 if "forward" in method or "task" in method else 1e-12)

    return check


def test_an_environment_is_its_parts(ur5, random):
    gravity, wrench = random.uniform(-10, 10, (5, 3)), random.uniform(-3, 3, 6)
    parameters = ur5.parameters * 1.1
    world = mozzi.Environment(gravity=gravity, tip_wrench=wrench, parameters=parameters)
    state = random.uniform(-1, 1, (3, 6))
    for method in ("inverse_dynamics", "forward_dynamics"):
        call = getattr(ur5, method)
        expected = call(*state, wrench, gravity=gravity, parameters=parameters)
        assert np.array_equal(call(*state, environment=world), expected)
    # the mass matrix takes what it depends on
    assert np.array_equal(ur5.mass_matrix(state[0], environment=world), ur5.mass_matrix(state[0], parameters=parameters))
    own = ur5.inverse_dynamics(*state)
    assert np.array_equal(ur5.inverse_dynamics(*state, environment=mozzi.Environment()), own)
    assert np.array_equal(ur5.inverse_dynamics(*state, environment=None), own)
    with pytest.raises(TypeError, match="got 'gravity' both by itself and in 'environment'"):
        ur5.inverse_dynamics(*state, gravity=gravity, environment=world)
    with pytest.raises(TypeError, match=r"environment is a dict, expected a mozzi.Environment"):
        ur5.inverse_dynamics(*state, environment={"gravity": gravity})
    with pytest.raises(ValueError, match="gravity has shape"):
        ur5.inverse_dynamics(*state, environment=mozzi.Environment(gravity=[0, 9.81]))


@pytest.mark.parametrize("method", taking("gravity"))
def test_gravity_of_each_state(method, ur5, random):
    gravity = random.uniform(-10, 10, (5, 3))
    check_one_by_one(method, ur5, random, lambda k: (ur5, {"gravity": gravity[k]}))(gravity=gravity)
    check_one_by_one(method, ur5, random, lambda k: (ur5.with_gravity(gravity[k]), {}))(gravity=gravity)
    given = arguments(ur5, METHODS[method], random)
    assert parts(getattr(ur5, method)(*given, gravity=gravity))[0].shape[0] == 5  # of one state


@pytest.mark.parametrize("method", taking("parameters"))
def test_parameters_of_each_state(method, ur5, random):
    loaded = [ur5.with_payload("forearm_link", mass).with_payload("tool0", 2 * mass) for mass in random.uniform(0.1, 3, 5)]
    parameters = np.array([robot.parameters for robot in loaded])
    check_one_by_one(method, ur5, random, lambda k: (loaded[k], {}))(parameters=parameters)
    check_one_by_one(method, ur5, random, lambda k: (ur5, {"parameters": parameters[k]}))(parameters=parameters)
    check_one_by_one(method, ur5, random, lambda k: (loaded[2], {}))(parameters=parameters[2])


def test_what_depends_on_parameters_takes_them(ur5, random):
    parameters, loaded = ur5.parameters * random.uniform(0.9, 1.1, 90) + 0.01, ur5.with_payload("tool0", 2.0)
    for method in METHODS:
        given = arguments(ur5, METHODS[method], random)
        options = {"tip_wrench": random.uniform(-1, 1, 6)} if method in taking("tip_wrench") else {}
        own = parts(getattr(ur5, method)(*given, **options))
        if method in taking("parameters"):
            found = parts(getattr(ur5, method)(*given, **options, parameters=parameters))
            # without constraints nothing is projected and no impulse acts
            is_same = method in ("constraint_projection", "constraint_impulse")
            assert all(np.allclose(x, y, 1e-6, 1e-9) for x, y in zip(found, own)) == is_same, method
        else:
            assert all(np.array_equal(x, y) for x, y in zip(parts(getattr(loaded, method)(*given, **options)), own)), method


def test_tables_of_each_state_go_together(ur5, random):
    theta, dtheta, ddtheta = state(ur5, random, 5)
    gravity, wrenches = random.uniform(-10, 10, (5, 3)), random.uniform(-3, 3, (5, 6))
    parameters = np.array([ur5.with_payload("tool0", mass).parameters for mass in random.uniform(0.1, 3, 5)])
    options = {"gravity": gravity, "tip_wrench": wrenches, "parameters": parameters}
    twist = {"base_twist": random.uniform(-1, 1, 6), "base_acceleration": random.uniform(-1, 1, 6)}
    many = ur5.inverse_dynamics(theta, dtheta, ddtheta, **options, **twist)
    for k in range(5):
        own = {name: table[k] for name, table in options.items()}
        assert_close(many[k], ur5.inverse_dynamics(theta[k], dtheta[k], ddtheta[k], **own, **twist))
    single = {name: table.astype(np.float32) for name, table in options.items()}
    found = ur5.inverse_dynamics(*(x.astype(np.float32) for x in (theta, dtheta, ddtheta)), **single, **twist)
    assert found.dtype == np.float32
    assert_close(found, many, tolerance=1e-4)
    with pytest.raises(ValueError, match=r"gravity has leading axes \(4,\), which do not go with \(5,\)"):
        ur5.gravity_forces(theta, gravity=gravity[:4])
    with pytest.raises(ValueError, match=r"parameters has shape \(5, 89\), expected \(..., 90\): ten numbers a body"):
        ur5.gravity_forces(theta, parameters=parameters[:, 1:])


def test_threads(random):
    for name, robot in robots().items():
        theta, dtheta, ddtheta = state(robot, random, 3001)
        expected = robot.inverse_dynamics(theta, dtheta, ddtheta, threads=1)
        for threads in (None, 2, 3):
            assert np.array_equal(robot.inverse_dynamics(theta, dtheta, ddtheta, threads=threads), expected), name


@pytest.mark.parametrize("way", ["kernels", "machine code"])
def test_many_threads_share_a_model(random, way):
    ur5 = mozzi.models.ur5()
    ur5 = ur5.kernels_only() if way == "kernels" else ur5.compile("inverse_dynamics")
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


@pytest.mark.parametrize("method", METHODS)
def test_a_robot_without_joints(method):
    fixed = mozzi.Model.from_urdf_string("<robot name='fixed'><link name='base'/></robot>")
    call, count = getattr(fixed, method), len(METHODS[method])
    try:
        one = call(*[[]] * count)
    except (ValueError, ArithmeticError) as error:  # no mass, or no row of a task can move
        with pytest.raises(type(error)):
            call(*[np.zeros((3, 0))] * count)
        return
    for kind in (np.float64, np.float32):
        for found, expected in zip(parts(call(*[np.zeros((3, 0), kind)] * count)), parts(one), strict=True):
            assert found.dtype == kind and found.shape == (3, *np.shape(expected)) and (found == expected).all()
        assert parts(call(*[np.zeros((0, 0), kind)] * count))[0].shape[0] == 0


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
