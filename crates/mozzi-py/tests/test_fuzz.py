"""Whatever is passed, Python's errors answer, and the interpreter lives."""

import warnings

import mozzi
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from test_arrays import METHODS, parts

ROBOTS = {
    "ur5": mozzi.models.ur5(),
    "compiled": mozzi.models.ur5().compile("inverse_dynamics", "mass_matrix", "forward_dynamics"),
    "anymal": mozzi.models.anymal(),
    "fixed": mozzi.Model.from_urdf_string("<robot name='fixed'><link name='base'/></robot>"),
}
FEW = settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))

dtypes = st.sampled_from(["f8", "f4", ">f8", "f2", "i4", "u1", "?", "c16", "O", "U3", "M8[s]", "S2", "V4", "g"])
shapes = st.one_of(
    hnp.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=3),
    st.tuples(st.sampled_from([6, 18, 19, 0])),
    st.tuples(st.integers(0, 3), st.sampled_from([6, 18, 19])),
)


@st.composite
def tables(draw):
    shape, dtype = draw(shapes), draw(dtypes)
    array = np.zeros(shape, dtype)
    if array.dtype.kind == "f" and array.size:
        with np.errstate(over="ignore"):
            array[...] = draw(st.sampled_from([0.0, 1.0, -2.5, np.nan, np.inf, 1e300, 1e-320]))
    way = draw(st.integers(0, 6))
    if way == 1:
        array = np.asfortranarray(array)
    elif way == 2 and array.ndim:
        array = np.repeat(array, 2, -1)[..., ::2]
    elif way == 3:
        array.flags.writeable = False
    elif way == 4 and array.ndim:
        array = array[..., ::-1]
    elif way == 5 and array.ndim:
        array = np.broadcast_to(array, (2, *array.shape))
    elif way == 6:
        return array.tolist()
    return array


anything = st.one_of(
    tables(),
    st.none(),
    st.integers(),
    st.floats(),
    st.text(max_size=3),
    st.binary(max_size=3),
    st.booleans(),
    st.lists(st.one_of(st.floats(), st.none(), st.integers(), st.text(max_size=1)), max_size=7),
    st.recursive(st.floats(), lambda inner: st.lists(inner, max_size=3), max_leaves=6),
    st.dictionaries(st.sampled_from(["tool0", "LF_FOOT", "x"]), tables(), max_size=2),
    st.builds(object),
)
EXPECTED = (TypeError, ValueError, ArithmeticError, OverflowError, MemoryError)


def attempt(function, *arguments, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return function(*arguments, **options)
        except EXPECTED as error:
            assert str(error)


@FEW
@given(st.data())
def test_methods(data):
    robot = ROBOTS[data.draw(st.sampled_from(sorted(ROBOTS)))]
    name = data.draw(st.sampled_from(sorted(METHODS)))
    arguments = [data.draw(st.one_of(tables(), tables(), anything)) for _ in METHODS[name]]
    options = {}
    for option in ("out", "gravity", "tip_wrench", "applied_wrenches", "threads", "frame", "base_twist", "about", "parameters", "rows"):
        if data.draw(st.integers(0, 4)) == 0:
            options[option] = data.draw(anything)
    attempt(getattr(robot, name), *arguments, **options)


@FEW
@given(st.data())
def test_results_into_any_array(data):
    robot = ROBOTS["ur5"]
    name = data.draw(st.sampled_from(sorted(METHODS)))
    leading = data.draw(hnp.array_shapes(min_dims=0, max_dims=2, min_side=0, max_side=3))
    arguments = [np.full((*leading, 6), 0.1) for _ in METHODS[name]]
    results = attempt(getattr(robot, name), *arguments)
    shapes = [np.shape(result) for result in parts(results)]
    memory = np.zeros(sum(int(np.prod(shape)) for shape in shapes) * 3 + 64)
    out = []
    for shape in shapes:
        start = data.draw(st.integers(0, 20))  # perhaps the same memory as the others
        out.append(memory[start : start + int(np.prod(shape))].reshape(shape))
    out = tuple(out) if isinstance(results, tuple) else out[0]
    if data.draw(st.booleans()) and arguments[0].size:
        arguments[0] = memory[: arguments[0].size].reshape(arguments[0].shape)  # perhaps the same memory
    expected = attempt(getattr(robot, name), *(x.copy() for x in arguments))
    found = attempt(getattr(robot, name), *arguments, out=out)
    if expected is not None and found is not None:
        last = parts(found)[-1]
        assert last is parts(out)[-1] and np.array_equal(last, parts(expected)[-1], equal_nan=True)


@FEW
@given(st.data())
def test_everything_else(data):
    robot = ROBOTS[data.draw(st.sampled_from(sorted(ROBOTS)))]
    draw = lambda: data.draw(anything)
    calls = [
        lambda: robot.simulate(draw(), draw(), data.draw(st.floats(0, 1)), data.draw(st.integers(-1, 5)), torque=draw()),
        lambda: mozzi.Model.from_screws(draw(), draw(), draw()),
        lambda: mozzi.Model.from_urdf_string(draw()),
        lambda: robot.with_payload(draw(), draw()),
        lambda: robot.with_frame(draw(), "tool0", draw()),
        lambda: robot.with_gravity(draw()),
        lambda: robot.with_locked_joints(draw()),
        lambda: robot.sub_chain(draw(), draw()),
        lambda: robot.closed_form(draw(), draw(), draw()),
        lambda: robot.newton_euler(draw(), draw(), draw()),
        lambda: robot.task_space_dynamics(draw(), draw(), rows=draw()),
        lambda: robot.compile(draw()),
        lambda: mozzi.Model._from_state(draw(), draw(), draw()),
        lambda: mozzi.conventions.Pinocchio(robot).configuration(draw()),
        lambda: mozzi.conventions.Pinocchio(robot).mass_matrix(draw()),
        lambda: mozzi.conventions.MuJoCo(robot).bias_forces(draw(), draw(), draw(), draw()),
        lambda: mozzi.modern_robotics.MassMatrix(draw(), draw(), draw(), draw()),
        lambda: mozzi.modern_robotics.FKinSpace(draw(), draw(), draw()),
        lambda: mozzi.modern_robotics.MatrixLog6(draw()),
    ]
    attempt(data.draw(st.sampled_from(calls)))


@pytest.mark.parametrize("given", [(), (1,), (1, 2, 3, 4, 5)])
def test_wrong_numbers_of_arguments(given, ur5):
    for name in ("mass_matrix", "kinetic_energy", "gravity_forces"):
        if len(given) != 1:
            with pytest.raises(TypeError):
                getattr(ur5, name)(*given)
