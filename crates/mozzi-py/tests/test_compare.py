"""mozzi.compare: the libraries asked from Python."""

import importlib.util
import sys

import mozzi
import numpy as np
import pytest
from conftest import MODELS, ORACLES

HAS_BOTH = all(importlib.util.find_spec(name) for name in ("pinocchio", "mujoco"))
both = pytest.mark.skipif(not HAS_BOTH, reason="pin or mujoco is not installed")


@both
@pytest.mark.parametrize("robot", ["ur5", MODELS / "ur5.urdf", mozzi.models.ur5()], ids=["name", "path", "model"])
def test_a_plain_arm_is_the_same_everywhere(robot):
    found = mozzi.compare(robot, states=3)
    assert found.agrees and found.explained and not found.refused
    assert list(found.libraries) == ["Pinocchio", "MuJoCo"]
    for entry in found.libraries.values():
        assert entry["status"] == "agrees"
        assert 0 < entry["comparison"]["errors"]["inverse_dynamics"] < 1e6
    assert "Pinocchio" in str(found) and "agrees" in str(found)
    assert repr(found).endswith("Pinocchio: agrees, MuJoCo: agrees>")
    assert found._repr_html_().startswith("<pre>")


@both
def test_what_differs_is_explained():
    found = mozzi.compare("panda", states=2)
    assert found.explained and not found.agrees
    causes = found.libraries["Pinocchio"]["comparison"]["causes"]
    assert [cause["kind"] for cause in causes] == ["mimic"], causes
    assert "panda_finger_joint2" in str(found)


@both
def test_balls_and_free_joints():
    found = mozzi.compare(ORACLES / "test_joints.xml", states=3)
    assert found.explained, str(found)
    of_mujoco = found.libraries["MuJoCo"]["comparison"]
    assert [cause["kind"] for cause in of_mujoco["causes"]] == ["mimic"], str(found)
    assert max(of_mujoco["errors_explained"].values()) < 100
    assert "a free joint's origin before" in str(found)


@both
def test_a_robot_of_one_velocity(tmp_path):
    path = tmp_path / "pendulum.urdf"
    path.write_text("""<robot name="pendulum"><link name="base"/><link name="rod"><inertial><origin xyz="0 0 -0.2"/><mass value="2"/>
        <inertia ixx="0.03" iyy="0.03" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="swing" type="continuous">
        <parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint></robot>""")
    found = mozzi.compare(path, states=2)
    assert found.agrees, str(found)


@both
@pytest.mark.parametrize("of_json", [False, True])
def test_a_robot_of_lists(tmp_path, of_json):
    screws = np.array([[0, 0, 1, 0, 0, 0], [0, 1, 0, 0, 0, 0.7]]).T
    M = np.eye(4)
    M[0, 3] = 0.5
    robot = mozzi.Model.from_screws([M, M, M], [np.diag([0.1, 0.2, 0.3, 2, 2, 2])] * 2, screws)
    robot.save(tmp_path / "lists.json")
    found = mozzi.compare(tmp_path / "lists.json" if of_json else robot, states=2)
    assert found.agrees, str(found)
    found = mozzi.compare(robot.with_gravity([0.0, -9.81, 0.0]), states=2)
    causes = found.libraries["Pinocchio"]["comparison"]["causes"]
    assert found.explained and [cause["kind"] for cause in causes] == ["gravity"], str(found)


@both
def test_a_file_that_mozzi_refuses(tmp_path):
    text = (MODELS / "ur5.urdf").read_text().replace("8.393", "-8.393")
    (tmp_path / "heavy.urdf").write_text(text)
    found = mozzi.compare(tmp_path / "heavy.urdf")
    assert found.refused and not found.explained
    said = " ".join(str(found).split())  # lines are wrapped
    assert "-8.393" in said and "mozzi refuses it" in said
    assert found.libraries["Pinocchio"]["status"] in ("loaded", "refused")


def test_what_cannot_be_is_named(tmp_path):
    with pytest.raises(ValueError, match="states is 0"):
        mozzi.compare("ur5", states=0)
    with pytest.raises(ValueError, match="seed is -1"):
        mozzi.compare("ur5", seed=-1)
    with pytest.raises(ValueError, match="nowhere"):
        mozzi.compare("nowhere")
    with pytest.raises(ValueError, match="policy is 'kind'"):
        mozzi.compare("ur5", policy="kind")
    with pytest.raises(TypeError):
        mozzi.compare(7)
    with pytest.raises(RuntimeError, match="did not start"):
        mozzi.compare("ur5", python=tmp_path / "python")
    helix = mozzi.Model.from_screws([np.eye(4)] * 2, [np.eye(6)], np.array([[0, 0, 1, 0, 0, 0.1]]).T)
    with pytest.raises(ValueError, match="cannot be given to other libraries"):
        mozzi.compare(helix)


@pytest.mark.skipif(sys.platform == "win32", reason="a shell script")
def test_a_python_without_libraries(tmp_path):
    bare = tmp_path / "python"
    answer = '{"library": "mujoco", "version": null, "attempts": [], "error": {"stage": "import", "message": "no module"}}'
    bare.write_text(f"#!/bin/sh\ncat > /dev/null; echo '{answer}'\n")
    bare.chmod(0o755)
    with pytest.raises(RuntimeError, match="no library to compare with"):
        mozzi.compare("ur5", python=bare)
