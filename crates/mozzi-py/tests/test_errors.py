"""What is wrong is named: the thing, its value, what was expected."""

import io
import re
import warnings

import mozzi
import numpy as np
import pytest
from conftest import MODELS

ZERO = [0.0] * 6


def refused(kind, text):
    return pytest.raises(kind, match="^" + re.escape(text))


def test_shapes(ur5):
    panda = mozzi.models.panda()
    joints = "one value per joint of 'panda' (panda_joint1, …)"
    with refused(ValueError, f"theta has shape (6,), expected (..., 8): {joints}"):
        panda.inverse_dynamics(np.zeros(6), np.zeros(8), np.zeros(8))
    with refused(ValueError, f"ddtheta has shape (3, 7), expected (..., 8): {joints}"):
        panda.inverse_dynamics(np.zeros(8), np.zeros(8), np.zeros((3, 7)))
    with refused(ValueError, "theta has shape (), expected (..., 6): one value per joint of 'ur5' (shoulder_pan_joint, …)"):
        ur5.mass_matrix(1.0)
    anymal = mozzi.models.anymal()
    with refused(ValueError, "theta has shape (18,), expected (..., 19): base quaternion (w, x, y, z), base origin, then 12"):
        anymal.mass_matrix(np.zeros(18))
    with refused(ValueError, "tip_wrench has shape (3,), expected (..., 6): (m, f) that the frame applies"):
        ur5.tip_forces(ZERO, np.zeros(3))
    with refused(ValueError, "gravity has shape (1, 2), expected (..., 3): m/s²"):
        ur5.gravity_forces(ZERO, gravity=[[0, 1]])


def test_things_that_are_no_numbers(ur5):
    with refused(TypeError, "theta holds None, expected real numbers"):
        ur5.gravity_forces(None)
    with refused(TypeError, "theta holds None, expected real numbers"):
        ur5.gravity_forces([0.0, 1.0, None, 0.0, 0.0, 0.0])
    with refused(TypeError, "theta has dtype complex128, expected real numbers"):
        ur5.gravity_forces(np.zeros(6, complex))
    with refused(TypeError, "theta has dtype <U1, expected real numbers"):
        ur5.gravity_forces(list("abcdef"))
    with refused(TypeError, "theta is a list, expected an array of numbers:"):
        ur5.gravity_forces([[1.0], [1.0, 2.0]])
    with refused(TypeError, "theta has masked entries, expected real numbers"):
        ur5.gravity_forces(np.ma.array(ZERO, mask=[True] + 5 * [False]))
    with refused(TypeError, "theta is a dict, expected an array of numbers:"):
        ur5.gravity_forces({1: 2})


def test_what_an_argument_raises_comes_through(ur5):
    class Broken:
        def __array__(self, dtype=None, copy=None):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ur5.gravity_forces(Broken())


def test_frames_and_wrenches(ur5):
    with pytest.raises(ValueError, match="tool1.*tool0"):
        ur5.forward_kinematics(ZERO, "tool1")
    with pytest.raises(ValueError, match="hand"):
        ur5.tip_forces(ZERO, applied_wrenches={"hand": ZERO})
    with refused(TypeError, "applied_wrenches is no dict, expected {frame name: wrench (m, f), shape (..., 6)}"):
        ur5.tip_forces(ZERO, applied_wrenches=[ZERO])
    with refused(TypeError, "applied_wrenches has a key that is no str"):
        ur5.tip_forces(ZERO, applied_wrenches={1: ZERO})
    with pytest.raises(ValueError):
        mozzi.models.anymal().forward_kinematics(mozzi.models.anymal().neutral_configuration)  # which of its feet?


def test_threads(ur5):
    for wrong in (0, -1, 1025, 10**30):
        with refused(ValueError, f"threads is {wrong}, expected 1 to 1024, or None for all cores"):
            ur5.gravity_forces(np.zeros((2, 6)), threads=wrong)
    with refused(TypeError, "threads is a str, expected 1 to 1024"):
        ur5.gravity_forces(np.zeros((2, 6)), threads="all")
    with refused(ValueError, "threads is 0, expected 1 to 1024"):
        ur5.gravity_forces(np.zeros(6), threads=0)  # which one state does not need


def test_states_that_have_no_answer(random):
    singular = mozzi.Model.from_screws(
        [np.eye(4)] * 3, [np.diag([0.1, 0.1, 0.1, 1, 1, 1]), np.zeros((6, 6))], np.eye(6)[:, [2, 2]]
    )
    with pytest.raises(mozzi.SingularError, match="joint2"):
        singular.forward_dynamics([0.0, 0.0], [0.0, 0.0], [1.0, 1.0])
    with pytest.raises(mozzi.SingularError, match=r"^state \[0, 0\]: .*joint2"):
        singular.forward_dynamics(np.zeros((2, 3, 2)), np.zeros(2), np.ones(2))
    ur5 = mozzi.models.ur5()
    theta = np.array([[0.1, -1.2, 1.5, 0.3, 1.1, 0.0], np.zeros(6)])
    with pytest.raises(mozzi.SingularError, match=r"^state \[1\]: "):
        ur5.task_space_dynamics(theta, np.zeros(6))
    assert issubclass(mozzi.SingularError, ArithmeticError)
    fixed = mozzi.Model.from_urdf_string("<robot name='fixed'><link name='base'/></robot>")
    with pytest.raises(mozzi.SingularError):
        fixed.task_space_dynamics([], [])
    anymal = mozzi.models.anymal()
    with pytest.raises(ValueError, match="quaternion"):
        anymal.mass_matrix(np.zeros(19))
    states = np.tile(anymal.neutral_configuration, (3, 1))
    states[2, 0] = 2.0
    with pytest.raises(ValueError, match=r"state \[2\]: .*quaternion"):
        anymal.mass_matrix(states)


def test_files(tmp_path):
    with pytest.raises(FileNotFoundError):
        mozzi.Model.from_urdf(tmp_path / "none.urdf")
    with pytest.raises(IsADirectoryError):
        mozzi.Model.from_urdf(str(tmp_path))
    text = (MODELS / "ur5.urdf").read_text()
    path = tmp_path / "robot.urdf"
    path.write_text(text)
    from_path = mozzi.Model.from_urdf(path)
    assert from_path == mozzi.Model.from_urdf(str(path)) == mozzi.models.ur5()
    assert mozzi.Model.from_urdf(io.StringIO(text)) == mozzi.Model.from_urdf(io.BytesIO(text.encode())) == from_path
    with open(path) as file:
        assert mozzi.Model.from_urdf(file) == from_path
    assert mozzi.Model.from_urdf_string(text) == mozzi.Model.from_urdf_string(text.encode()) == from_path
    with pytest.raises(mozzi.LoadError) as error:
        mozzi.Model.from_urdf_string(text.replace('<mass value="', '<mass value="-', 1))
    assert "robot.urdf" in error.value.diagnostics[0] and "mass" in error.value.diagnostics[0]
    assert isinstance(error.value, ValueError)
    with refused(TypeError, "the text is a "):
        mozzi.Model.from_urdf_string(3)
    with refused(TypeError, "the file is a "):
        mozzi.Model.from_urdf(3)
    with refused(ValueError, "policy is 'nice', expected 'default', 'strict' or 'lenient'"):
        mozzi.Model.from_urdf(path, policy="nice")


def test_a_warning_is_pythons():
    text = (MODELS / "ur5.urdf").read_text().replace("</robot>", "<weather/></robot>")
    with pytest.warns(mozzi.LoadWarning, match="weather"):
        mozzi.Model.from_urdf_string(text)
    with pytest.raises(mozzi.LoadError):
        mozzi.Model.from_urdf_string(text, policy="strict")


def test_what_changes_the_motion_is_the_first_warning():
    inertial = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 3"/>'
    text = f"""<mujoco><worldbody><light/><body name="b"><joint range="9 -9"/>{inertial}<geom size="1" rgba="1 0 0 1"/>
        <body gravcomp="1"><geom size="1"/></body></body></worldbody></mujoco>"""
    with pytest.warns(mozzi.LoadWarning) as found:
        mozzi.Model.from_urdf_string(text)
    assert [warning.category for warning in found] == [mozzi.DynamicsWarning] + 2 * [mozzi.LoadWarning]
    assert "gravity compensation" in str(found[0].message)
    with warnings.catch_warnings():  # looks are no warning
        warnings.simplefilter("error")
        mozzi.Model.from_urdf_string('<mujoco><worldbody><geom size="1" rgba="1 0 0 1"/></worldbody></mujoco>')


def test_lists(ur5):
    M, G, S = [np.eye(4)] * 2, [np.eye(6)], np.eye(6)[:, [2]]
    with refused(ValueError, "S_list has shape (6,), expected (6, n): a screw axis (ω, v) in each column"):
        mozzi.Model.from_screws(M, G, S[:, 0])
    with refused(ValueError, "S_list, column 0: "):
        mozzi.Model.from_screws(M, G, 2 * S)
    with refused(ValueError, "M_list has shape (1, 4, 4), expected (n + 1, 4, 4)"):
        mozzi.Model.from_screws(M[:1], G, S)
    with refused(ValueError, "M_list[1]: "):
        mozzi.Model.from_screws([np.eye(4), 2 * np.eye(4)], G, S)
    with refused(ValueError, "G_list has shape (1, 4, 4), expected (n, 6, 6)"):
        mozzi.Model.from_screws(M, [np.eye(4)], S)
    with refused(ValueError, "G_list[0]: "):
        mozzi.Model.from_screws(M, [np.arange(36.0).reshape(6, 6)], S)
    with refused(ValueError, "frames is 'tip', expected 'relative' or 'base'"):
        mozzi.Model.from_screws(M, G, S, frames="tip")


def test_arguments_of_python(ur5):
    with pytest.raises(TypeError, match="missing 2 required positional arguments"):
        ur5.inverse_dynamics(ZERO)
    name = "Model.inverse_dynamics()"
    with refused(TypeError, f"{name} missing 2 required positional arguments: 'dtheta' and 'ddtheta'"):
        ur5.inverse_dynamics(ZERO)
    with refused(TypeError, f"{name} missing 3 required positional arguments: 'theta', 'dtheta', and 'ddtheta'"):
        ur5.inverse_dynamics()
    with refused(TypeError, f"{name} missing 1 required positional argument: 'dtheta'"):
        ur5.inverse_dynamics(ddtheta=ZERO, theta=ZERO)
    with refused(TypeError, f"{name} got an unexpected keyword argument 'wrench'"):
        ur5.inverse_dynamics(ZERO, ZERO, ZERO, wrench=ZERO)
    with refused(TypeError, f"{name} got multiple values for argument 'theta'"):
        ur5.inverse_dynamics(ZERO, ZERO, ZERO, theta=ZERO)
    with refused(TypeError, f"{name} takes from 3 to 4 positional arguments but 5 were given"):
        ur5.inverse_dynamics(*[ZERO] * 5)
    with refused(TypeError, "Model.mass_matrix() takes 1 positional arguments but 20 were given"):
        ur5.mass_matrix(*[ZERO] * 20)
    with pytest.raises(TypeError, match="'mozzi.Model'"):
        mozzi.Model.inverse_dynamics(1, ZERO, ZERO, ZERO)
    with refused(TypeError, "frame is a int, expected a str"):
        ur5.body_jacobian(ZERO, 1)
    for rows, kind in [(3, "int"), ("ab", "str"), ([-1], "list"), ([1.5], "list"), ([True, False], "list")]:
        with refused(TypeError, f"rows is {rows} ({kind}), expected a sequence of row numbers from 0 to 5"):
            ur5.task_space_dynamics(ZERO, ZERO, rows=rows)
    with pytest.raises(ValueError, match=r"rows is \[1, 1\], expected distinct row numbers from 0 to 5"):
        ur5.task_space_dynamics(ZERO, ZERO, rows=[1, 1])
    with refused(ValueError, "coordinates is 'tool', expected 'body' or 'space'"):
        ur5.task_space_dynamics(ZERO, ZERO, coordinates="tool")
    with pytest.raises(TypeError):
        mozzi.Model()
    with pytest.raises(AttributeError):
        ur5.n = 3


def test_loading_by_name(ur5):
    for call, words in [
        (lambda: mozzi.Model.load("UR5"), "`UR5` is neither a file nor one of the embedded robots .* did you mean `ur5`"),
        (lambda: mozzi.Model.load("ur5", policy="strickt"), "policy is 'strickt', expected 'default', 'strict'"),
        (lambda: mozzi.Model.load("ur5", xacro_args={"a": 1}), "xacro_args is given, expected none"),
    ]:
        with pytest.raises((ValueError, FileNotFoundError), match=words):
            call()
    with pytest.raises(FileNotFoundError):
        mozzi.Model.load("nowhere.urdf")
    for name in ["gravity", "position_limits", "velocity_limits", "effort_limits"]:
        with pytest.raises(ValueError, match="read-only"):  # a copy: the change would be lost
            getattr(ur5, name)[0] = 0


def test_counts_and_sizes(ur5):
    with refused(TypeError, "steps is 0.001, expected an int, the number of steps; a time step dt is steps="):
        ur5.simulate(ZERO, ZERO, 1.0, 0.001)
    with refused(ValueError, "steps is -5, expected at least 1"):
        ur5.simulate(ZERO, ZERO, 1.0, -5)
    with refused(ValueError, "record_every is -1, expected at least 1"):
        ur5.simulate(ZERO, ZERO, 1.0, 5, record_every=-1)
    with refused(ValueError, "steps is 1000000000000, expected at most 1e9"):
        ur5.simulate(ZERO, ZERO, 1e9, 10**12)
    with refused(ValueError, "the motion takes 216 GB of memory (1000000001 rows), expected at most 16 GB; record_every"):
        ur5.simulate(ZERO, ZERO, 1e6, 10**9)
    with refused(ValueError, "iterations is -1, expected at least 1"):
        mozzi.InverseKinematics(ur5, iterations=-1)


def test_python_words(ur5):
    eye, I, S = np.eye(4), np.eye(6), np.array([[0, 0, 2, 0, 0, 0.0]]).T
    with refused(ValueError, "S_list, column 0: not a unit screw axis: ‖ω‖ = 2 and ‖v‖ = 0, expected ‖ω‖ = 1, or ω = 0"):
        mozzi.Model.from_screws([eye] * 2, [I], S)
    with refused(ValueError, "M_list[1]: not a configuration: the last row is [1.0, 1.0, 1.0, 1.0]"):
        mozzi.Model.from_screws([eye, np.vstack([eye[:3], np.ones(4)])], [I], S / 2)
    with refused(ValueError, "G_list[0]: not a spatial inertia: entry (0, 0) is NaN, expected a finite number"):
        mozzi.Model.from_screws([eye] * 2, [I * np.nan], S / 2)
    with refused(ValueError, "position: (NaN, 0, 0), expected finite numbers, m"):
        mozzi.InverseKinematics(ur5).solve(ZERO, position=[np.nan, 0, 0])
    with refused(TypeError, "robot is a str, expected a mozzi.Model, and Pinocchio's model after it"):
        mozzi.conventions.Pinocchio("ur5")


def test_payloads_and_gravity_in_short(ur5):
    loaded, G = ur5.with_payload("tool0", 5.0, [0, 0, 0.1]), np.zeros((6, 6))
    G[3:, 3:] = 5.0 * np.eye(3)
    G[:3, :3] = np.diag([0.05, 0.05, 0])
    G[1, 3] = G[3, 1] = 0.5
    G[0, 4] = G[4, 0] = -0.5
    theta = [0.1, -0.7, 0.9, 0.4, 1.1, 0.2]
    assert np.allclose(loaded.mass_matrix(theta), ur5.with_payload("tool0", G).mass_matrix(theta))
    with refused(ValueError, "center_of_mass is given, expected None: a spatial inertia contains"):
        ur5.with_payload("tool0", G, [0, 0, 0.1])
    assert ur5.with_gravity(1.62).gravity.tolist() == [0, 0, -1.62]
    with refused(ValueError, "gravity is -9.81, expected 9.81, which points down, or (0, 0, -9.81)"):
        ur5.with_gravity(-9.81)
