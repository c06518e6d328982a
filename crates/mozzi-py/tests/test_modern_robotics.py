"""The drop-in beside the Modern Robotics package itself: its own examples, read from the installed package, and random input."""

import inspect
import re
import sys
import textwrap

import modern_robotics as theirs
import mozzi.modern_robotics as mr
import numpy as np
import pytest
from conftest import assert_close
from test_book import chain, pose

NAMES = [name for name, member in inspect.getmembers(theirs.core, inspect.isfunction)]


def test_all_47_functions_are_there_with_their_arguments():
    assert len(NAMES) == 47 and sorted(NAMES) == sorted(mr.__all__)
    for name in NAMES:
        assert list(inspect.signature(getattr(mr, name)).parameters) == list(
            inspect.signature(getattr(theirs, name)).parameters
        ), name


def example(name):
    """What the docstring gives: the input's program, and the output's text or None."""
    text = inspect.getdoc(getattr(theirs, name))
    program, _, output = re.split(r"Example [Ii]nputs?[^\n]*:\n", text, maxsplit=1)[1].partition("\nOutput:")
    return textwrap.dedent(program), output or None


def run(module, name, monkeypatch):
    """The example's results, computed by this module."""
    program, _ = example(name)
    # fewer steps and no plots of the longest ones; the package's own would take minutes
    program = program.split("# Output using matplotlib")[0].replace("N= 1000", "N= 50").replace("(1000,3 )", "(50,3 )")
    program = program.replace("(1000, 3)", "(50, 3)").replace("dt = 0.01", "dt = 0.05").replace("intRes = 8", "intRes = 2")
    monkeypatch.setitem(sys.modules, "modern_robotics", module)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    given = {"np": np, "mr": module}
    exec(textwrap.dedent(program), given)
    function = getattr(module, name)
    return function(*(given[argument] for argument in inspect.signature(function).parameters))


def numbers(result):
    if isinstance(result, (tuple, list)):
        return np.concatenate([numbers(part) for part in result])
    return np.asarray(result, float).ravel()


def printed(text):
    """The numbers of an output, and half a unit of their last digits."""
    text = re.sub(r"thetalistNext|dthetalistNext|np\.array", "", text.replace("True", "1").replace("False", "0"))
    found = re.findall(r"-?\d+\.?\d*(?:e[-+]?\d+)?", text)
    digits = [re.sub(r"e.*", "", word).partition(".")[2] for word in found]
    powers = [int(word.partition("e")[2] or 0) for word in found]
    return np.array(found, float), np.array([10.0 ** (power - len(d)) for d, power in zip(digits, powers)])


@pytest.mark.parametrize("name", NAMES)
def test_the_example_of_its_documentation(name, monkeypatch):
    found = numbers(run(mr, name, monkeypatch))
    expected = numbers(run(theirs, name, monkeypatch))
    assert_close(found, expected, tolerance=1e-10)
    if example(name)[1]:
        words, unit = printed(example(name)[1])
        assert words.shape == found.shape
        assert (np.abs(found - words) <= 0.51 * unit + (1e-3 if name.startswith("Distance") else 0)).all()


def test_most_examples_print_their_output():
    assert sum(example(name)[1] is not None for name in NAMES) == 44


@pytest.fixture(params=range(5))
def lists(request):
    random = np.random.default_rng(request.param)
    n = request.param + 2
    M, G, S = chain(random, n)
    if request.param % 2:
        S[:, 0] *= 1.7  # not unit
        S[:, 1] *= 0.4
    theta, dtheta, ddtheta = random.uniform(-2, 2, (3, n))
    return {"M": M, "G": G, "S": S, "theta": theta, "dtheta": dtheta, "ddtheta": ddtheta, "random": random, "n": n}


def same(name, *given, tolerance=1e-10, size=None):
    found, expected = (numbers(getattr(module, name)(*given)) for module in (mr, theirs))
    assert_close(found, expected, size, tolerance)


def test_rigid_motions_at_random(random):
    for _ in range(50):
        T, twist = pose(random), random.uniform(-3, 3, 6)
        R, omega = T[:3, :3], twist[:3]
        for name in ("RotInv", "MatrixLog3", "ProjectToSO3", "DistanceToSO3", "TestIfSO3"):
            same(name, R, size=1.0)
        for name in ("TransToRp", "TransInv", "Adjoint", "MatrixLog6", "ProjectToSE3", "DistanceToSE3", "TestIfSE3"):
            same(name, T, size=1.0)
        for name in ("VecToso3", "AxisAng3", "Normalize"):
            same(name, omega)
        for name in ("VecTose3", "AxisAng6", "ad"):
            same(name, twist)
        same("MatrixExp3", theirs.VecToso3(omega))
        same("so3ToVec", theirs.VecToso3(omega))
        same("MatrixExp6", theirs.VecTose3(twist))
        same("se3ToVec", theirs.VecTose3(twist))
        same("RpToTrans", R, omega)
        same("ScrewToAxis", omega, Normalized(twist[3:]), 0.3)
        noisy = T + random.normal(scale=0.1, size=(4, 4))
        same("ProjectToSE3", noisy)
        same("DistanceToSE3", noisy)
        same("DistanceToSO3", noisy[:3, :3])
        same("DistanceToSO3", -R)
        slide = np.array([0, 0, 0, *omega])
        same("AxisAng6", slide)
        same("MatrixExp6", theirs.VecTose3(slide))
    for z in (0.0, 1e-7, -1e-7, 1e-6, 1e-5):
        assert mr.NearZero(z) == theirs.NearZero(z)


def Normalized(v):
    return v / np.linalg.norm(v)


def test_half_turns_have_the_packages_sign(random):
    for axis in [*np.eye(3), [0, 0.6, -0.8], [0.6, -0.8, 0], [-0.6, 0, -0.8]]:
        R = 2 * np.outer(axis, axis) - np.eye(3)
        T = theirs.RpToTrans(R, [1, 2, 3])
        assert_close(mr.MatrixExp3(mr.MatrixLog3(R)), R)
        assert_close(mr.MatrixExp6(mr.MatrixLog6(T)), T)
        if theirs.MatrixLog3(R).any():  # by rounding the package may find no turn at all
            same("MatrixLog3", R, tolerance=1e-7)
            same("MatrixLog6", T, tolerance=1e-7)
    compared = 0
    for axis in random.normal(size=(200, 3)):  # R has rounding, and is not symmetric
        R = theirs.MatrixExp3(theirs.VecToso3(np.pi * axis / np.linalg.norm(axis)))
        T = theirs.RpToTrans(R, [1, 2, 3])
        assert_close(mr.MatrixExp6(mr.MatrixLog6(T)), T)
        if (np.trace(R) - 1) / 2 <= -1:  # else the package's axis is rounding
            compared += 1
            same("MatrixLog3", R, tolerance=1e-7)
            with np.errstate(invalid="ignore"):
                is_number = np.isfinite(theirs.MatrixLog6(T)).all()  # an arc cosine of less than -1 is none
            if is_number:
                same("MatrixLog6", T, tolerance=1e-7)
                same("ScrewTrajectory", np.eye(4), T, 1, 3, 3, tolerance=1e-7)
    assert compared > 50


def test_rotations_below_near_zero_are_computed():
    tiny = theirs.VecToso3([3e-7, 0, 4e-7])
    assert np.array_equal(theirs.MatrixExp3(tiny), np.eye(3))
    assert_close(mr.MatrixExp3(tiny), np.eye(3) + tiny)
    assert_close(mr.MatrixLog3(mr.MatrixExp3(tiny)), tiny, 1e-4)


def test_chains_at_random(lists):
    M, S, theta, random = lists["M"], lists["S"], lists["theta"], lists["random"]
    home = M[0]
    same("FKinSpace", home, S, theta)
    same("FKinBody", home, S, theta)
    same("JacobianSpace", S, theta)
    same("JacobianBody", S, theta)
    same("FKinSpace", home.tolist(), S.tolist(), theta.tolist())
    target = theirs.FKinSpace(home, S, theta + random.uniform(-0.1, 0.1, len(theta)))
    same("IKinSpace", S, home, target, theta, 1e-6, 1e-6, tolerance=1e-5)
    target = theirs.FKinBody(home, S, theta + random.uniform(-0.1, 0.1, len(theta)))
    same("IKinBody", S, home, target, theta, 1e-6, 1e-6, tolerance=1e-5)


def test_dynamics_at_random(lists):
    M, G, S, theta, dtheta, ddtheta, random, n = lists.values()
    g, F = random.uniform(-10, 10, 3), random.uniform(-3, 3, 6)
    tau = theirs.InverseDynamics(theta, dtheta, ddtheta, g, F, M, G, S)
    size = np.abs(tau).max()
    same("InverseDynamics", theta, dtheta, ddtheta, g, F, M, G, S)
    same("InverseDynamics", *(x.tolist() for x in (theta, dtheta, ddtheta, g, F)), list(M), list(G), S.tolist())
    same("MassMatrix", theta, M, G, S)
    same("VelQuadraticForces", theta, dtheta, M, G, S, size=size)
    same("GravityForces", theta, g, M, G, S, size=size)
    same("EndEffectorForces", theta, F, M, G, S, size=size)
    condition = np.linalg.cond(theirs.MassMatrix(theta, M, G, S))
    same("ForwardDynamics", theta, dtheta, tau, g, F, M, G, S, size=condition * np.abs(ddtheta).max(), tolerance=1e-12)
    same("ComputedTorque", theta, dtheta, ddtheta, g, M, G, S, 2 * theta, dtheta, ddtheta, 1.3, 1.2, 1.1)
    same("EulerStep", theta, dtheta, ddtheta, 0.1)
    motion = random.uniform(-1, 1, (3, 6, n))
    wrenches = random.uniform(-1, 1, (6, 6))
    same("InverseDynamicsTrajectory", *motion, g, wrenches, M, G, S)
    given = (theta, dtheta, motion[0], g, wrenches, M, G, S, 1e-4, 2)
    same("ForwardDynamicsTrajectory", *given, size=condition)


def test_ways_at_random(random):
    for method in (3, 5):
        same("JointTrajectory", random.uniform(-1, 1, 4), random.uniform(-1, 1, 4), 3.0, 7, method)
        ends = pose(random), pose(random)
        same("ScrewTrajectory", *ends, 3.0, 7, method)
        same("CartesianTrajectory", *ends, 3.0, 7, method)
    for name in ("CubicTimeScaling", "QuinticTimeScaling"):
        same(name, 2.0, 0.6)
        same(name, 2, 1)
        same(name, 2.0, 2.6)  # after the end
        same(name, 2.0, -0.3)
        assert np.isnan(getattr(mr, name)(2.0, np.nan))
        with pytest.raises(ZeroDivisionError):
            getattr(mr, name)(0.0, 1.0)


def test_input_that_the_package_takes_as_it_is(lists):
    M, G, S, theta, dtheta, ddtheta, random, n = lists.values()
    short = theta[:-1]
    same("MassMatrix", short, M, G, S)  # lists longer than θ
    still = np.c_[S[:, :-1], np.zeros(6)]
    same("MassMatrix", theta, M, G, still)
    same("InverseDynamics", theta, dtheta, ddtheta, [0, 0, -9.8], np.ones(6), M, G, still)
    same("GravityForces", theta, [0, 0, -9.8], M, -np.array(G), S)  # a body that cannot exist
    with pytest.raises(np.linalg.LinAlgError):
        mr.ForwardDynamics(theta, dtheta, ddtheta, [0, 0, -9.8], np.ones(6), M, G, still)


def test_errors_name_the_list(lists):
    M, G, S, theta, *_ = lists.values()
    with pytest.raises(ValueError, match=f"Mlist has {len(M) - 1} matrices, expected {len(M)} for this many joints"):
        mr.MassMatrix(theta, M[:-1], G, S)
    with pytest.raises(ValueError, match="Glist has 1 matrices"):
        mr.MassMatrix(theta, list(M), [G[0]], S)
    with pytest.raises(ValueError, match=r"Slist has shape \(6,\)"):
        mr.MassMatrix(theta, M, G, S[:, 0])
    with pytest.raises(ValueError, match=r"Glist\[0\]: "):
        mr.MassMatrix(theta, M, np.ones_like(G), S)
    with pytest.raises(ValueError, match=r"Glist\[0\] has shape \(3, 3\), expected \(6, 6\)"):
        mr.MassMatrix(theta, list(M), [np.eye(3)] * len(G), S)
    with pytest.raises(ValueError, match=r"Mlist\[1\]: .*rotation"):
        mr.MassMatrix(theta, [M[0], np.diag([2.0, 1, 1, 1]), *M[2:]], G, S)
    with pytest.raises(ValueError, match=r"Mlist\[0\]: .*the last row is"):
        mr.MassMatrix(theta, np.ones_like(M), G, S)
    with pytest.raises(ValueError, match="rotation"):
        mr.MatrixLog3(2 * np.eye(3))
    with pytest.raises(ValueError, match="last row"):
        mr.Adjoint(np.ones((4, 4)))
    with pytest.raises(ValueError, match=r"Glist\[0\]: .*NaN"):
        mr.MassMatrix(theta, M, G * np.nan, S)
    M = M.copy()
    M[1, 0, 3] = np.inf
    with pytest.raises(ValueError, match="the list of home frames is not finite in number 2, expected finite numbers"):
        mr.MassMatrix(theta, M, G, S)


def test_exponentials_refuse_other_matrices():
    turned = mr.MatrixExp3(mr.VecToso3([0.1, 0.2, 0.3]))
    for matrix, what in [(turned, "entry (0, 0) is 0.9"), (np.ones((3, 3)), "entry (0, 0) is 1, expected 0"),
                         (np.abs(mr.VecToso3([0.1, 0.2, 0.3])), "entries (0, 1) and (1, 0) are 0.3 and 0.3")]:  # fmt: skip
        with pytest.raises(ValueError, match="so3mat: " + re.escape(what)):
            mr.MatrixExp3(matrix)
    with pytest.raises(ValueError, match="se3mat: entry"):
        mr.MatrixExp6(np.ones((4, 4)))
    last = mr.VecTose3([0.1, 0.2, 0.3, 1, 2, 3])
    last[3, 3] = 1.0
    with pytest.raises(ValueError, match="se3mat: the last row has 1, expected zeros"):
        mr.MatrixExp6(last)
    rounded = np.round(mr.VecToso3([0.1234567, 0.2, 0.3]), 4)
    assert np.allclose(mr.MatrixExp3(rounded), mr.MatrixExp3(mr.VecToso3([0.1235, 0.2, 0.3])))


def test_a_guess_has_a_number_for_each_screw():
    S = np.array([[0, 0, 1, 0, 0, 0], [0, 0, 1, 0, -1.0, 0]]).T
    for solve in (mr.IKinSpace, mr.IKinBody):
        with pytest.raises(ValueError, match=re.escape("thetalist0 has shape (1,), expected (2,)")):
            solve(S, np.eye(4), np.eye(4), [0.1], 1e-3, 1e-3)
