"""Quantities by their usual names, robots from any file, and the command `mozzi`."""

import subprocess
import sys
import warnings

import mozzi
import numpy as np
import pytest
from conftest import MODELS

THETA = [0, -1.2, 1.5, 0.3, 1.1, 0]


@pytest.mark.parametrize(
    ("name", "method"),
    [
        ("M", "mass_matrix"),
        ("crba", "mass_matrix"),
        ("g", "gravity_forces"),
        ("J_b", "body_jacobian"),
        ("fk", "forward_kinematics"),
        ("mass-matrix", "mass_matrix"),
        ("com", "center_of_mass"),
    ],
)
def test_a_quantity_has_the_names_that_people_know(ur5, name, method):
    assert np.array_equal(ur5.compute(name, THETA), getattr(ur5, method)(THETA))


def test_arguments_are_those_of_the_method(ur5):
    found = ur5.compute("rnea", THETA, dtheta=np.ones(6), ddtheta=np.zeros(6))
    assert np.array_equal(found, ur5.inverse_dynamics(THETA, np.ones(6), np.zeros(6)))
    many = np.zeros((3, 6))
    assert ur5.compute("T", many, frame="forearm_link").shape == (3, 4, 4)
    with pytest.raises(ValueError, match="no quantity `mass_matrx`; the nearest of 57 are `mass_matrix`"):
        ur5.compute("mass_matrx", THETA)


def test_load_takes_names_paths_files_and_json(tmp_path):
    assert mozzi.Model.load("ur5") == mozzi.models.ur5()
    assert mozzi.Model.load("anymal", floating=True) == mozzi.models.anymal(floating=True)
    path = MODELS / "two_link_planar.urdf"
    assert mozzi.Model.load(path) == mozzi.Model.from_urdf(path)
    with path.open() as file:
        assert mozzi.Model.load(file).n == 2
    json = tmp_path / "ur5.json"
    command("convert", "ur5", str(json))
    assert mozzi.Model.load(json).n == 6
    (tmp_path / "broken.json").write_text('{"robot": 1')
    with pytest.raises(ValueError, match="broken.json"):
        mozzi.Model.load(tmp_path / "broken.json")
    with pytest.raises(FileNotFoundError, match="nothing_like_it"):
        mozzi.Model.load("nothing_like_it")


def command(*words, expected=0):
    done = subprocess.run([sys.executable, "-m", "mozzi", *words], capture_output=True, text=True, timeout=120)
    assert done.returncode == expected, done.stderr
    return done.stdout if expected == 0 else done.stderr


def test_the_command_line_is_in_the_package():
    assert "tool0" in command("robots")
    assert "mass_matrix" in command("compute", "ur5", "M")
    assert command("check", "nothing.urdf", expected=1).startswith("error: ")
    assert "tip" in command("compute", "ur5", "M", "--cutoff", "1", expected=2)


def test_sdformat_is_read_by_its_content(tmp_path):
    text = """<sdf version="1.9"><model name="arm"><link name="base"/><link name="rod"><inertial><pose>0 0 0.5 0 0 0</pose>
      <mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.01</izz></inertia></inertial></link>
      <joint name="fixed_base" type="fixed"><parent>world</parent><child>base</child></joint>
      <joint name="swing" type="revolute"><parent>base</parent><child>rod</child><axis><xyz>1 0 0</xyz></axis></joint>
      </model></sdf>"""
    path = tmp_path / "arm.sdf"
    path.write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the base's own inertia
        model = mozzi.Model.load(path)
    assert model.n == 1
    assert np.isclose(model.mass_matrix([0.0])[0, 0], 0.1 + 2 * 0.5**2)


@pytest.mark.parametrize(
    ("guess", "meant"),
    [
        ("rnea", r"`inverse_dynamics\(theta, dtheta, ddtheta\)`"),
        ("M", r"`mass_matrix\(theta\)`"),
        ("nv", "`n` is the number of velocities"),
        ("njoints", "`n` is the number of velocities"),
        ("jacobian", "`body_jacobian"),
        ("jac_site", "`body_jacobian"),
        ("inv_mass_matrix", r"`mass_matrix_inverse\(theta\)`"),
        ("minv", r"`mass_matrix_inverse\(theta\)`"),
        ("torque_limits", "`effort_limits`"),
        ("gravity_compensation", r"`gravity_forces\(theta\)`"),
        ("operational_space", r"`task_space_dynamics\(theta, dtheta, frame"),
        ("manipulability", r"det\(J @ J.T\)"),
        ("from_file", r"`mozzi.Model.load\(path\)`"),
        ("from_xml_path", r"`mozzi.Model.load\(path\)`"),
        ("ik", "`mozzi.InverseKinematics"),
        ("jointnames", "did you mean `joint_names`"),
        ("total_energy", "`kinetic_energy"),
        ("zzz", "no attribute 'zzz'$"),
    ],
)
def test_an_attribute_of_others_names_ours(ur5, guess, meant):
    with pytest.raises(AttributeError, match=meant):
        getattr(ur5, guess)
    assert not hasattr(ur5, "__array__")


def test_names_of_the_module_and_of_a_class_that_is_not_called():
    for guess, meant in (
        ("load", "mozzi.Model.load"),
        ("robots", "mozzi.models"),
        ("rnea", "mozzi.Model.inverse_dynamics"),
        ("aba", "mozzi.Model.forward_dynamics"),
        ("buildModelFromUrdf", "mozzi.Model.from_urdf"),
        ("MjModel", "mozzi.Model.from_mjcf"),
        ("zzz", "'zzz'$"),
    ):
        with pytest.raises(AttributeError, match=meant):
            getattr(mozzi, guess)
    for guess, meant in (
        ("load", r"that is mozzi.Model.load\(path\)"),
        ("iiwa", "the robots are anymal, .*ur5; mozzi.Model.load"),
    ):
        with pytest.raises(AttributeError, match=meant):
            getattr(mozzi.models, guess)
    with pytest.raises(TypeError, match=r"`mozzi.Model.load\(path\)` reads"):
        mozzi.Model("ur5")


@pytest.mark.parametrize("name", ["controllers", "conventions", "models", "modern_robotics", "trajectories"])
def test_modules_list_their_own_names(name):
    module = getattr(mozzi, name)
    assert {name for name in dir(module) if not name.startswith("_")} == set(module.__all__)


def test_the_package_lists_its_own_names():
    own = {name for name in dir(mozzi) if not name.startswith("_")} - {"jax", "torch"}  # if imported
    assert own == {name for name in mozzi.__all__ if not name.startswith("_")}


def test_a_motion_starts_at_rest_and_takes_two_seconds(ur5):
    short = ur5.simulate(THETA, duration=0.0105)
    assert short.theta.shape == (12, 6) and not short.dtheta[0].any()
    assert ur5.simulate(THETA).t[-1] == 2.0
    many = ur5.simulate([THETA, THETA], duration=0.01)
    assert many.theta.shape == (2, 11, 6)
