"""Equations in symbols: forms, and their values."""

import mozzi
import numpy as np
import pytest


def test_the_planar_arm_is_that_of_the_book():
    M = mozzi.models.two_link_planar().derive("mass_matrix", equal="link")
    assert "m₁L₁² + m₂(L₁² + 2L₁L₂ cos θ₂ + L₂²)" in str(M)
    assert M.quantity == "mass_matrix" and M.operations == (4, 14, 1)
    assert M.values == {"m1": 2.0, "m2": 1.0, "L1": 0.5, "L2": 0.4}
    assert M._repr_latex_().startswith("$$") and r"\begin{bmatrix}" in M.latex()
    assert "function" in M.matlab() and "function" in M.julia() and "| $m_{1}$ |" in M.markdown()


@pytest.mark.parametrize("name", ["ur5", "furuta_pendulum", "two_link_planar"])
@pytest.mark.parametrize("cse", [False, True])
def test_python_text_computes_what_the_kernel_computes(name, cse, random):
    robot = getattr(mozzi.models, name)()
    scope = {}
    exec(robot.derive("mass_matrix", cse=cse).python(), scope)
    theta = random.uniform(-2, 2, robot.n)
    expected = robot.mass_matrix(theta)
    assert np.allclose(scope["mass_matrix"](theta), expected, atol=1e-9 * np.abs(expected).max())


def test_sympy_has_the_expressions():
    sympy = pytest.importorskip("sympy")
    arm = mozzi.models.two_link_planar()
    g = arm.derive("gravity_forces", equal="link").sympy()
    assert g.shape == (2, 1)
    names = {str(symbol) for symbol in g.free_symbols}
    assert names == {"m1", "m2", "L1", "L2", "g", "theta1", "theta2"}
    energy = arm.derive("potential_energy", equal="link").sympy()
    theta1 = next(symbol for symbol in energy.free_symbols if str(symbol) == "theta1")
    assert sympy.simplify(sympy.diff(energy, theta1) - g[0]) == 0


def test_inverses_are_those_of_the_kernels(random):
    arm = mozzi.models.two_link_planar()
    theta, dtheta, tau = random.uniform(-2, 2, (3, arm.n))
    scope = {}
    exec(arm.derive("mass_matrix_inverse").python(), scope)
    assert np.allclose(scope["mass_matrix_inverse"](theta), arm.mass_matrix_inverse(theta))
    exec(arm.derive("forward_dynamics", cse=True).python(), scope)
    assert np.allclose(scope["forward_dynamics"](theta, dtheta, tau), arm.forward_dynamics(theta, dtheta, tau))
    task = arm.derive("Lambda", rows=[3, 5], equal="link")
    assert "m₁ + m₂ sin² θ₂" in str(task)
    exec(task.python(), scope)
    expected = arm.task_space_dynamics(theta, dtheta, rows=[3, 5])
    for found, kernel in zip(scope["task_space_dynamics"](theta, dtheta), expected):
        assert np.allclose(found, kernel)


def test_base_parameters_give_the_torques(random):
    arm = mozzi.models.two_link_planar()
    found = arm.derive("base_parameters")
    assert "I₁yy + m₂L₁²" in str(found)
    theta, dtheta, ddtheta = random.uniform(-2, 2, (3, arm.n))
    scope = {}
    exec(found.python(), scope)
    pi_b, Y_b = scope["base_parameters"](theta, dtheta, ddtheta)
    assert np.allclose(Y_b @ pi_b, arm.inverse_dynamics(theta, dtheta, ddtheta))


def test_what_cannot_be_derived_is_refused():
    arm = mozzi.models.two_link_planar()
    with pytest.raises(ValueError, match="divides by pivots"):
        arm.derive("forward_dynamics_derivatives")
    with pytest.raises(ValueError, match="6 velocities is too long"):
        mozzi.models.ur5().derive("forward_dynamics")
    with pytest.raises(ValueError, match="such as vx,vz"):
        arm.derive("Lambda")
    with pytest.raises(ValueError, match="symbols has 'weights'"):
        arm.derive("mass_matrix", symbols="weights")
    with pytest.raises(ValueError, match="equal is 'all'"):
        arm.derive("mass_matrix", equal="all")
    changed = arm.with_payload("tip", np.diag([0.0, 0, 0, 0.3, 0.3, 0.3]))
    assert "m₂_tip" in str(changed.derive("mass_matrix"))


def of_lists(L1, r1=None, alpha=0.0):
    """The planar arm of the book's lists, with frames at the centres of mass; the second link's is turned by alpha."""
    r1, L2, r2 = L1 if r1 is None else r1, 0.8, 0.3
    c, s = np.cos(alpha), np.sin(alpha)
    M1, M2, tip = np.eye(4), np.eye(4), np.eye(4)
    M2[:2, :2], M2[0, 3] = [[c, -s], [s, c]], L1 + r2
    M1[0, 3], tip[0, 3] = r1, L2 - r2
    home = [M1, np.linalg.inv(M1) @ M2, tip]
    screws = np.array([[0, 0, 1, 0, 0, 0], [0, 0, 1, 0, -L1, 0.0]]).T
    inertias = [np.diag([0.1, 0.2, 0.3, 2, 2, 2]), np.diag([0.1, 0.15, 0.2, 1.5, 1.5, 1.5])]
    return mozzi.Model.from_screws(home, inertias, screws).with_gravity([0.0, -9.81, 0.0])


@pytest.mark.parametrize("alpha", [0.0, 0.4])
def test_lengths_of_lists_are_between_axes(alpha, random):
    theta, dtheta, ddtheta = random.uniform(-2, 2, (3, 2))
    arm = of_lists(1.0, 0.4, alpha)
    assert {"L1": 1.0}.items() <= arm.derive("M").values.items()
    for name, state in [("mass_matrix", (theta,)), ("gravity_forces", (theta,)), ("velocity_product", (theta, dtheta)),
                        ("regressor", (theta, dtheta, ddtheta))]:  # fmt: skip
        scope, found = {}, arm.derive(name)
        exec(found.python(), scope)
        for lengths in [(1.0, 0.4), (1.2, 0.4), (1.2, 0.7)]:
            given = {symbol: x for symbol, x in zip(("L1", "r1"), lengths) if symbol in found.values}
            expected = getattr(of_lists(*lengths, alpha), name)(*state)
            assert np.allclose(scope[name](*state, **given), expected, atol=1e-12), (name, lengths)


def test_equal_lengths_of_lists_are_the_textbooks(random):
    arm, theta, scope = of_lists(1.0), random.uniform(-2, 2, 2), {}
    M = arm.derive("M", equal="link")
    assert "m₁L₁²" in str(M) and "joint2 axis x relative to the axis before it" in str(M), str(M)
    exec(M.python(), scope)
    assert np.allclose(scope["mass_matrix"](theta, L1=1.2), of_lists(1.2).mass_matrix(theta), atol=1e-12)
