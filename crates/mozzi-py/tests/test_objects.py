"""A model as Python's objects are: pickled, copied, compared, shown, sent to other processes."""

import concurrent.futures
import copy
import doctest
import html.parser
import inspect
import multiprocessing
import os
import pickle
import pydoc
import warnings

import mozzi
import numpy as np
import pytest
from conftest import assert_close, robots, state


def test_pickle_copy_and_equality(robot, random):
    theta, dtheta, ddtheta = state(robot, random)
    expected = robot.inverse_dynamics(theta, dtheta, ddtheta)
    for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
        again = pickle.loads(pickle.dumps(robot, protocol))
        assert again == robot and hash(again) == hash(robot) and again is not robot
        assert np.array_equal(again.inverse_dynamics(theta, dtheta, ddtheta), expected)
    assert copy.copy(robot) == copy.deepcopy(robot) == robot
    others = [other for other in robots().values() if other == robot]
    assert len(others) == 1
    assert robot != robot.with_gravity([0, 0, 1]) and robot != 1 and robot is not None


def test_edited_models_pickle(random):
    robot = mozzi.models.panda()
    edited = robot.with_payload("panda_hand", 2.0).with_locked_joints({"panda_joint3": 0.3}).with_gravity([1, 2, 3])
    edited = edited.with_frame("camera", "panda_hand", np.diag([1.0, -1, -1, 1])).with_end_effector("camera")
    again = pickle.loads(pickle.dumps(edited))
    assert again == edited and again.end_effector == "camera" and again.n == robot.n - 1
    theta, dtheta, ddtheta = state(edited, random)
    assert np.array_equal(again.inverse_dynamics(theta, dtheta, ddtheta), edited.inverse_dynamics(theta, dtheta, ddtheta))
    assert edited.mass == pytest.approx(robot.mass + 2.0)


def test_edits(ur5, random):
    theta, dtheta, _ = state(ur5, random)
    G = np.zeros((6, 6))
    G[3:, 3:] = 1.5 * np.eye(3)
    assert_close(ur5.with_payload("tool0", G).mass_matrix(theta), ur5.with_payload("tool0", 1.5).mass_matrix(theta))
    J = ur5.body_jacobian(theta)
    assert_close(ur5.with_payload("tool0", 1.5).mass_matrix(theta), ur5.mass_matrix(theta) + J.T @ G @ J)
    turned = ur5.with_rotor("wrist", {"wrist_1_joint": 1.0, "wrist_2_joint": -2.0}, armature=0.1)
    gears = np.array([0, 0, 0, 1.0, -2.0, 0])
    assert_close(turned.mass_matrix(theta), ur5.mass_matrix(theta) + 0.1 * np.outer(gears, gears))
    free = ur5.with_floating_base()
    assert free.is_floating and (free.n, free.nq) == (12, 13) and free.with_floating_base(False) == ur5
    base = ur5.neutral_configuration
    assert_close(free.mass_matrix([1, 0, 0, 0, 0, 0, 0, *theta])[6:, 6:], ur5.mass_matrix(theta))
    part = ur5.sub_chain("base_link", "forearm_link")
    assert part.n == 3 and part.end_effector == "forearm_link"
    assert_close(part.forward_kinematics(theta[:3]), ur5.forward_kinematics(theta, "forearm_link"))
    assert np.array_equal(base, np.zeros(6))


def test_properties(ur5):
    assert ur5.name == "ur5" and (ur5.n, ur5.nq) == (6, 6) and ur5.joint_names[0] == "shoulder_pan_joint"
    assert "tool0" in ur5.frames and ur5.end_effector == "tool0" and "forearm_link" in ur5.link_names
    assert np.array_equal(ur5.gravity, [0, 0, -9.81]) and not ur5.is_floating
    assert ur5.position_limits.shape == (6, 2) and (ur5.position_limits[:, 0] < ur5.position_limits[:, 1]).all()
    assert ur5.velocity_limits.shape == ur5.effort_limits.shape == (6,) and (ur5.effort_limits > 0).all()
    assert mozzi.models.anymal().end_effector is None
    lists = ur5.screws()
    assert lists.S.shape == (6, 6) and lists.joints == ur5.joint_names and lists.end_effector[0] == "tool0"


def test_words_about_a_model(robot):
    text = repr(robot)
    assert robot.name in text and ("floating" in text) == robot.is_floating

    class Cells(html.parser.HTMLParser):
        rows, cells = 0, []

        def handle_starttag(self, tag, attributes):
            self.rows += tag == "tr"

        def handle_data(self, data):
            self.cells.append(data)

    cells = Cells()
    cells.feed(robot._repr_html_())
    assert cells.rows == 1 + len(robot.joint_names)
    assert set(robot.joint_names) <= set(cells.cells)


def test_html_is_escaped():
    robot = mozzi.Model.from_screws([np.eye(4)] * 2, [np.eye(6)], np.eye(6)[:, [2]], name="<b>&")
    assert "<b>" not in robot._repr_html_() and "&lt;b&gt;&amp;" in robot._repr_html_()


def work(task):
    robot, given = task
    return os.getpid(), robot.inverse_dynamics(*given), robot.gravity_forces(given[0][0])


@pytest.mark.parametrize("start", ["fork", "spawn"])
def test_other_processes(start, ur5, random):
    if start not in multiprocessing.get_all_start_methods():
        pytest.skip(f"no {start} here")
    given = state(ur5, random, 500)
    expected = ur5.inverse_dynamics(*given)  # threads run before the fork
    with concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context(start)) as pool:
        for process, many, one in pool.map(work, [(ur5, given)] * 4, timeout=120):
            assert process != os.getpid() and np.array_equal(many, expected)
            assert_close(one, ur5.gravity_forces(given[0][0]))


def documented(class_=mozzi.Model):
    yield class_.__name__, class_
    for name, member in vars(class_).items():
        if not name.startswith("_"):
            yield name, member


def test_examples_in_the_documentation_of_the_model():
    finder, runner = doctest.DocTestParser(), doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
    for name, member in documented():
        text = inspect.getdoc(member)
        assert text, f"{name} has no documentation"
        runner.run(finder.get_doctest(text, {}, name, None, 0))
    assert runner.tries >= 29 and runner.failures == 0


def test_examples_in_the_documentation_of_motions():
    finder, runner = doctest.DocTestParser(), doctest.DocTestRunner()
    members = list(documented(mozzi.InverseKinematics))
    for module in (mozzi.trajectories, mozzi.controllers):
        members.append((module.__name__, module))
        for name in module.__all__:
            member = getattr(module, name)
            members += documented(member) if inspect.isclass(member) else [(name, member)]
    for name, member in members:
        if name not in ("count", "index"):  # a tuple's own
            text = inspect.getdoc(member)
            assert text, f"{name} has no documentation"
            runner.run(finder.get_doctest(text, {}, name, None, 0))
    assert runner.tries >= 130 and runner.failures == 0


def test_help_shows_signature_and_documentation():
    for name, member in documented():
        if not callable(member) or isinstance(member, staticmethod) or name == "Model":
            continue
        shown = pydoc.plain(pydoc.render_doc(member))
        assert f"{name}(" in shown and inspect.getdoc(member).splitlines()[0] in shown
        assert member.__name__ == name and member.__qualname__ == f"Model.{name}"
        if "threads" in inspect.signature(member).parameters and name not in ("compile", "simulate"):
            assert member.__objclass__ is mozzi.Model and member.__text_signature__.startswith("($self, ")
            assert inspect.signature(getattr(mozzi.models.ur5(), name)).parameters.keys() == (
                inspect.signature(member).parameters.keys() - {"self"}
            )


def test_documentation_has_shapes_units_and_an_example():
    text = inspect.getdoc(mozzi.Model.forward_dynamics)
    for part in (
        "Parameters\n----------\ntheta : array_like, shape (..., nq)\n    θ, positions: rad or m; of a floating base",
        "\ntip_wrench : array_like, shape (..., 6), optional\n    Wrench (m, f)",
        "\nReturns\n-------\nddtheta : numpy.ndarray, shape (..., n)\n    rad/s² or m/s².\n",
        "\nRaises\n------\nSingularError\n    If the mass matrix is singular.",
        ">>> ur5.forward_dynamics([theta] * 5, dtheta, tau).shape\n(5, 6)",
    ):
        assert part in text
    text = inspect.getdoc(mozzi.Model.task_space_dynamics)
    assert "TaskSpaceDynamics\n    A named tuple of arrays:\n\n    - `Lambda`, shape (..., k, k): kg m²" in text


def test_documentation_names_every_argument():
    for name, member in documented():
        if not callable(member) or name in ("Model", "load", "screws") or name.startswith(("from_", "with_", "sub_")):
            continue
        text = inspect.getdoc(member)
        for argument in inspect.signature(member).parameters:
            assert argument == "self" or argument in text, f"{name}: {argument}"
        assert "Returns" in text, name


@pytest.mark.parametrize("ending", ["urdf", "xml", "sdf", "json"])
def test_an_edited_robot_is_saved(tmp_path, ending):
    robot = mozzi.models.ur5().with_payload("tool0", 2.0).with_locked_joints({"wrist_3_joint": 0.3})
    file = tmp_path / f"robot.{ending}"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mozzi.LoadWarning)  # SDFormat and MJCF have other names
        robot.save(file)
        again = mozzi.Model.load(file)
    theta = [0.1, -0.7, 0.9, 0.4, 1.1]
    assert np.allclose(again.mass_matrix(theta), robot.mass_matrix(theta), rtol=1e-9)


def test_a_robot_is_not_saved_as_another(tmp_path):
    ur5 = mozzi.models.ur5()
    with pytest.raises(ValueError, match="ends in `.usd`, expected .urdf, .xml"):
        ur5.save(tmp_path / "robot.usd")
    with pytest.raises(FileNotFoundError, match="nowhere"):
        ur5.save(tmp_path / "nowhere" / "robot.urdf")
    with pytest.raises(FileNotFoundError, match="nowhere"):
        ur5.report(tmp_path / "nowhere" / "page.html")
    with pytest.raises(ValueError, match="json can express all of it"):
        ur5.with_gravity([1.0, 0.0, -9.0]).save(tmp_path / "robot.urdf")
    assert not list(tmp_path.iterdir())


def test_axes_that_miss_their_frames_are_saved(tmp_path):
    arm = mozzi.Model.from_screws([np.eye(4)] * 2, [np.eye(6)], np.array([[0, 0, 1, 0, -0.5, 0]]).T)
    with pytest.warns(mozzi.LoadWarning, match="cannot express the choice of the end effector, `end_effector`"):
        arm.save(tmp_path / "arm.urdf")
    again = mozzi.Model.load(tmp_path / "arm.urdf")
    assert np.allclose(again.mass_matrix([0.3]), arm.mass_matrix([0.3]))
    assert np.allclose(again.forward_kinematics([0.3], "end_effector"), arm.forward_kinematics([0.3]))


def test_both_masses_are_shown(ur5):
    moving = ur5.mass
    assert repr(ur5) == f"<mozzi.Model 'ur5': 6 joints, 8 links, 20.9939 kg, {moving} kg moving>"
    assert f"6 joints, 20.9939 kg, {moving} kg moving</caption>" in ur5._repr_html_()
    assert repr(mozzi.models.two_link_planar()).endswith(", 3 kg>")


def test_saving_tells_what_mujoco_refuses(tmp_path):
    with pytest.warns(mozzi.LoadWarning, match="f.xml: MuJoCo refuses moving bodies whose mass or a moment is below"):
        mozzi.models.furuta_pendulum().save(tmp_path / "f.xml")


@pytest.mark.parametrize("last", ["hinge", "ball"])
def test_joints_of_one_body_are_saved_as_such(tmp_path, last):
    text = f"""<mujoco><worldbody><body name="a"><joint name="x" axis="1 0 0"/><joint name="y" type="slide"/>
    <joint name="z" type="{last}"/><geom type="box" size=".1 .2 .3"/></body></worldbody></mujoco>"""
    robot, file = mozzi.Model.from_urdf_string(text, name="a.xml"), tmp_path / "a.xml"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        robot.save(file)
        again = mozzi.Model.load(file)
    assert file.read_text().count("<body") == 1
    assert again.joint_names == robot.joint_names and again.frames == robot.frames
    theta = robot.neutral_configuration
    assert np.allclose(again.mass_matrix(theta), robot.mass_matrix(theta), rtol=1e-12, atol=1e-15)


def test_a_payload_that_cannot_be_is_a_warning(ur5):
    with pytest.warns(mozzi.LoadWarning, match="inertia: .* 1, 1 and 5 kg m², break the triangle inequality"):
        ur5.with_payload("tool0", np.diag([1, 1, 5, 1, 1, 1.0]))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ur5.with_payload("tool0", np.diag([1, 1, 2, 1, 1, 1.0]))
        ur5.with_payload("tool0", 2.0).with_payload("tool0", -2.0)
