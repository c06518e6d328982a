"""Model.jvp: any quantity along a direction, against matrices of derivatives and, coarsely, differences."""

import inspect

import mozzi
import numpy as np
import pytest
from conftest import assert_close, state, tip
from mozzi import _quantities, _tangent

NAMES = [
    name for name in dir(mozzi.Model) if "threads" in str(getattr(getattr(mozzi.Model, name), "__text_signature__", ""))
]


def quantities(robot):
    """Each quantity's name, with its inputs."""
    for name in NAMES:
        arguments = list(inspect.signature(getattr(mozzi.Model, name)).parameters)[1:]
        inputs = [a for a in arguments if a in ("theta", "dtheta", "ddtheta", "tau", "x", "w")]
        is_singular = name == "task_space_dynamics" and robot.n < 6
        if "out" in arguments and "constraint" not in name and not is_singular:
            yield name, inputs, {"frame": tip(robot)} if "frame" in arguments else {}


def flat(found):
    return np.concatenate([np.asarray(part).reshape(-1) for part in (found if isinstance(found, tuple) else (found,))])


def moved(robot, theta, along, h):
    """θ ⊕ δθ h, to first order."""
    rows = [_tangent.velocity_gradient(np, robot._quaternions, theta, c) for c in np.eye(robot.nq)]
    return theta + h * np.stack(rows) @ along


def test_every_quantity_against_differences(robot, random):
    theta, dtheta, ddtheta = state(robot, random)
    values = {"theta": theta, "dtheta": dtheta, "ddtheta": ddtheta, "tau": ddtheta, "x": random.normal(size=robot.n)}
    values["w"] = random.normal(size=6)
    rates = {name: random.uniform(-1, 1, 6 if name == "w" else robot.n) for name in values}
    names = [name for name, *_ in quantities(robot)]
    assert len(names) > 30
    for name, inputs, subject in quantities(robot):
        value, rate = robot.jvp(name, [values[a] for a in inputs], [rates[a] for a in inputs], **subject)
        assert type(value) is type(rate)

        def at(h):
            given = [moved(robot, theta, rates[a], h) if a == "theta" else values[a] + h * rates[a] for a in inputs]
            return flat(getattr(robot, name)(*given, **subject))

        assert_close(flat(value), at(0.0), tolerance=1e-11)
        h = 1e-6
        difference = (at(h) - at(-h)) / (2 * h)
        size = 1 + np.abs(difference).max() + np.abs(flat(value)).max()
        assert_close(flat(rate), difference, size, tolerance=1e-7)


def test_columns_of_the_derivatives(robot, random):
    x = state(robot, random, 5)
    for name, first in [("inverse_dynamics", 0), ("forward_dynamics", 1)]:
        matrices = getattr(robot, name + "_derivatives")(*x)[first:]
        rates = [random.normal(size=(5, robot.n)) for _ in range(3)]
        expected = sum(np.einsum("...ij,...j->...i", m, u) for m, u in zip(matrices, rates))
        value, found = robot.jvp(name, x, rates)
        assert_close(found, expected)
        assert_close(value, getattr(robot, name)(*x))
        assert_close(
            robot.jvp(name, x, [None, rates[1], None])[1], np.einsum("...ij,...j->...i", matrices[1], rates[1])
        )
        assert not robot.jvp(name, x, [None] * 3)[1].any()


def test_parameters_and_environment(robot, random):
    x = state(robot, random, 3)
    pi, rate = robot.parameters * 1.01, random.normal(size=len(robot.parameters))
    given = {"gravity": [1.0, 2.0, -9.0], "applied_wrenches": {tip(robot): random.normal(size=(3, 6))}}
    value, found = robot.jvp("inverse_dynamics", x, [None] * 3, parameters=pi, parameters_tangent=rate, **given)
    Y = robot.regressor(*x, gravity=given["gravity"])
    assert_close(found, Y @ rate, size=np.abs(Y).max())
    assert_close(value, robot.inverse_dynamics(*x, parameters=pi, **given))
    own = robot.jvp("inverse_dynamics", x, [None] * 3, parameters_tangent=rate, gravity=given["gravity"])[1]
    assert_close(own, Y @ rate, size=np.abs(Y).max())


def test_second_derivatives_are_symmetric(ur5, random):
    (theta, dtheta, ddtheta), x = state(ur5, random), random.normal(size=6)
    columns = [
        ur5.jvp("inverse_dynamics_vjp", [theta, dtheta, ddtheta, x], [e, None, None, None])[1].d_theta
        for e in np.eye(6)
    ]
    assert_close(np.array(columns), np.array(columns).T)


def test_rows_of_a_task_and_the_point_of_a_momentum(ur5, random):
    theta, dtheta, _ = state(ur5, random)
    along, h = random.normal(size=6), 1e-6
    for name, subject in [
        ("task_space_dynamics", {"rows": [3, 5], "coordinates": "space"}),
        ("momentum", {"about": [0.3, -0.2, 1.0]}),
    ]:
        value, rate = ur5.jvp(name, [theta, dtheta], [along, None], **subject)

        def at(h):
            return flat(getattr(ur5, name)(theta + h * along, dtheta, **subject))

        assert_close(flat(value), at(0.0))
        assert_close(flat(rate), (at(h) - at(-h)) / (2 * h), 1 + np.abs(flat(value)).max(), tolerance=1e-7)


def test_shapes_dtypes_and_errors(ur5, random):
    theta = random.uniform(-1, 1, (4, 1, 6)).astype(np.float32)
    value, rate = ur5.jvp("mass_matrix", [theta], [np.ones((3, 6), np.float32)])
    assert value.shape == rate.shape == (4, 3, 6, 6) and value.dtype == rate.dtype == np.float32
    assert_close(rate, ur5.jvp("mass_matrix", [theta.astype(float)], [np.ones(6)])[1].repeat(3, 1), tolerance=1e-6)
    energy, power = ur5.jvp("potential_energy", [theta[0, 0].astype(float)], [np.ones(6)])
    assert isinstance(energy, float) and isinstance(power, float)
    found = ur5.jvp("inverse_dynamics_vjp", [theta] * 4, [None] * 4)[1]
    assert isinstance(found, _quantities.InverseDynamicsVjp)
    for message, call in [
        ("there is no quantity `momentums`", lambda: ur5.jvp("momentums", [theta], [theta])),
        (
            "inputs has 2 entries, expected 1 for mass_matrix: theta",
            lambda: ur5.jvp("mass_matrix", [theta] * 2, [theta]),
        ),
        ("tangents has 0 entries, expected 1", lambda: ur5.jvp("mass_matrix", [theta], [])),
        (
            r"the tangent of theta has shape \(5,\), expected \(..., 6\)",
            lambda: ur5.jvp("mass_matrix", [theta], [[0.0] * 5]),
        ),
        ("parameters_tangent has shape", lambda: ur5.jvp("mass_matrix", [theta], [None], parameters_tangent=[1.0])),
        ("there is no frame `nowhere`", lambda: ur5.jvp("body_jacobian", [theta], [None], frame="nowhere")),
        ("there is no frame `nowhere`", lambda: ur5.engine("mass_matrix", "nowhere")),
        ("there is no frame `nowhere`", lambda: ur5.compile("mass_matrix", frame="nowhere")),
    ]:
        with pytest.raises(ValueError, match=message):
            call()
    # what the quantity's method does not take
    with pytest.raises(TypeError, match=r"gravity_forces\(\) got an unexpected keyword argument 'base_acceleration'"):
        ur5.jvp("gravity_forces", [theta], [None], base_acceleration=[0.0] * 6)
    with pytest.raises(TypeError, match=r"mass_matrix\(\) got an unexpected keyword argument 'frame'"):
        ur5.jvp("mass_matrix", [theta], [None], frame="tool0")
    with pytest.raises(TypeError, match=r"mass_matrix\(\) got an unexpected keyword argument 'gravity'"):
        ur5.jvp("mass_matrix", [theta], [None], gravity=[0.0, 0.0, 0.0])
