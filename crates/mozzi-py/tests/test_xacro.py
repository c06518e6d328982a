"""Robots from xacro: arguments, packages, and errors at their places in the files that the user wrote."""

import pathlib

import mozzi
import numpy as np
import pytest
from conftest import assert_close

FILES = pathlib.Path(__file__).parents[2] / "mozzi-xacro" / "tests" / "arm"
ROBOT, ROD = ((FILES / name).read_text(encoding="utf-8") for name in ["arm.urdf.xacro", "rod.xacro"])


@pytest.fixture
def arm(tmp_path):
    folder = tmp_path / "elsewhere" / "of_rods"
    folder.mkdir(parents=True)
    (folder / "rod.xacro").write_text(ROD)
    path = tmp_path / "arm.urdf.xacro"
    path.write_text(ROBOT)
    return path, {"rods": folder}


def test_arguments_and_packages(arm):
    path, packages = arm
    robot = mozzi.Model.from_urdf(path, packages=packages)
    assert robot.joint_names == ["rod_pivot"]
    assert_close(robot.mass_matrix([0.0]), [[2 * 0.5**2 / 3]])
    given = {"length": 0.9, "prefix": "left_"}
    longer = mozzi.Model.from_urdf(str(path), xacro_args=given, packages={"rods": str(packages["rods"])})
    assert longer.joint_names == ["left_rod_pivot"]
    assert_close(longer.mass_matrix([0.0]), [[2 * 0.9**2 / 3]])
    assert_close(longer.gravity_forces([np.pi / 2]), [2 * 9.81 * 0.45], tolerance=1e-9)
    text = mozzi.Model.from_urdf_string(ROBOT, name="arm.urdf.xacro", xacro_args=given, packages=packages)
    assert text == longer
    # numbers are given as Python prints them
    assert mozzi.Model.from_urdf(path, xacro_args={"length": np.float64(0.9), "prefix": "left_"}, packages=packages) == longer


def test_errors_have_their_places(arm):
    path, packages = arm
    with pytest.raises(ValueError, match=r"arm\.urdf\.xacro:4:.*rods"):
        mozzi.Model.from_urdf(path)
    with pytest.warns(mozzi.LoadWarning, match="the argument `lenght` is given and not used, expected some of: length, prefix"):
        mozzi.Model.from_urdf(path, xacro_args={"lenght": 1}, packages=packages)
    broken = packages["rods"] / "rod.xacro"
    broken.write_text(ROD.replace('value="${mass}"', 'value="${-mass}"'))
    with pytest.raises(ValueError, match=r"(?s)rod\.xacro:6:.*from .*arm\.urdf\.xacro:6"):
        mozzi.Model.from_urdf(path, packages=packages)
    broken.write_text(ROD.replace("${mass}", "${maß}"))
    with pytest.raises(ValueError, match=r"(?s)rod\.xacro:6:.*maß"):
        mozzi.Model.from_urdf(path, packages=packages)
    with pytest.raises(TypeError, match="a name in xacro_args is 1, expected a str"):
        mozzi.Model.from_urdf(path, xacro_args={1: 1}, packages=packages)
    with pytest.raises(TypeError, match=r'packages\["rods"\] is 1, expected a folder'):
        mozzi.Model.from_urdf(path, packages={"rods": 1})
