"""Dry friction that sticks, and contacts with planes."""

import base64
import json
import pickle

import numpy as np
import pytest

import mozzi

STUCK = """<robot name="stuck"><link name="base"/>
  <link name="arm"><inertial><origin xyz="0.5 0 0"/><mass value="1"/>
    <inertia ixx="0.001" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="hinge" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
    <dynamics damping="0" friction="8"/></joint></robot>"""

CUBE = """<robot name="cube"><link name="cube"><inertial><mass value="2"/>
  <inertia ixx="0.003" iyy="0.003" izz="0.003" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""


@pytest.mark.parametrize("method", ["auto", "moreau"])
def test_dry_friction_holds(method):
    motion = mozzi.Model.from_urdf_string(STUCK).simulate([0.3], [0.0], 1.0, 500, method=method)
    assert np.abs(motion.theta - 0.3).max() < 1e-12
    assert motion.one_sided.unsolved == 0 and motion.one_sided.largest_residual < 1e-10


@pytest.mark.parametrize("method", ["rk4", "euler", "semi-implicit-euler", "dopri", "midpoint"])
def test_smooth_methods_refuse_dry_friction_and_contacts(method):
    arm, cube = mozzi.Model.from_urdf_string(STUCK), mozzi.Model.from_urdf_string(CUBE, floating=True)
    with pytest.raises(ValueError, match="dry friction of `hinge`.*`moreau`"):
        arm.simulate([0.3], [0.0], 1.0, 500, method=method)
    assert len(arm.simulate([0.3], [0.0], 0.1, 100, method=method, slip_speed=0.1).t) == 101
    with pytest.raises(ValueError, match="contact points.*`moreau`"):
        cube.simulate([1, 0, 0, 0, 0, 0, 1], np.zeros(6), 0.1, 10, method=method, contacts=["cube"])


def test_a_cube_falls_and_slides():
    cube = mozzi.Model.from_urdf_string(CUBE, floating=True)
    corners = [{"frame": "cube", "at": (x, y, -0.05), "friction": 0.2} for x in (-0.05, 0.05) for y in (-0.05, 0.05)]
    start = [1, 0, 0, 0, 0, 0, 0.05]
    motion = cube.simulate(start, [0, 0, 0, 1.0, 0, 0], 1.0, 1000, contacts=corners)
    assert motion.method == "Moreau-Jean"
    assert motion.contact_forces.shape == (1001, 4, 3)
    # ½v²/(μg), then rest
    assert abs(motion.theta[-1, 4] - 0.5 / (0.2 * 9.81)) < 1e-6
    assert abs(motion.contact_forces[-1, :, 2].sum() + 2 * 9.81) < 1e-6
    assert {event.change for event in motion.contact_events} >= {"touches down", "sticks"}
    belt = [{"name": "belt", "velocity": (0.5, 0, 0)}]
    motion = cube.simulate(start, np.zeros(6), 1.0, 1000, contacts=corners, planes=belt)
    assert abs(motion.dtheta[-1, 3] - 0.5) < 1e-9


@pytest.mark.parametrize("method", ["auto", "moreau"])
def test_many_starts_stick_each_as_alone(method):
    arm = mozzi.Model.from_urdf_string(STUCK)
    theta, dtheta = np.linspace(-1, 1, 7)[:, None], np.array([0.0])
    options = dict(method=method, record_every=10, torque=[2.0])
    many = arm.simulate(theta, dtheta, 0.5, 100, **options)
    for k, start in enumerate(theta):
        one = arm.simulate(start, dtheta, 0.5, 100, **options)
        for name in ("theta", "dtheta", "ddtheta", "tau", "energy"):
            assert np.array_equal(getattr(many, name)[k], getattr(one, name)), name
    assert many.one_sided.unsolved == 0
    # m g l and τ are at most 4.905 + 2 N m, friction holds 8
    assert np.abs(many.theta - theta[:, None]).max() < 1e-12
    # together in registers: μ sgn θ̇, which is 0 at rest
    creeps = arm.simulate(theta, dtheta, 0.5, 100, sticking=False, torque=[2.0], record_every=10)
    assert creeps.one_sided is None and np.abs(creeps.theta - theta[:, None]).max() > 1e-4
    motors = lambda t, theta, dtheta: 2.0 - dtheta
    assert arm.simulate(theta, dtheta, 0.1, 10, torque=motors, sticking=False).theta.shape == (7, 11, 1)
    with pytest.raises(TypeError, match="sticking=False"):
        arm.simulate(theta, dtheta, 0.1, 10, torque=motors)
    with pytest.raises(ValueError, match="sticking is False, expected True of one start"):
        arm.simulate(theta[0], dtheta, 0.1, 10, sticking=False)
    with pytest.raises(ValueError, match="sticking is False, expected True of robots that move one by one"):
        arm.simulate(theta, dtheta, 0.1, 10, sticking=False, method="moreau")


def test_many_cubes_fall():
    cube = mozzi.Model.from_urdf_string(CUBE, floating=True)
    corners = [{"frame": "cube", "at": (x, y, -0.05), "friction": 0.2} for x in (-0.05, 0.05) for y in (-0.05, 0.05)]
    starts = np.array([[1, 0, 0, 0, 0, 0, 0.05 + 0.01 * k] for k in range(4)])
    options = dict(contacts=(corner for corner in corners), record_every=10)
    many = cube.simulate(starts, np.zeros(6), 0.3, 300, **options)
    assert many.contact_forces.shape == (4, 31, 4, 3) and many.contact_names == ["cube"] * 4
    for k, start in enumerate(starts):
        one = cube.simulate(start, np.zeros(6), 0.3, 300, contacts=corners, record_every=10)
        assert np.array_equal(many.theta[k], one.theta) and np.array_equal(many.contact_forces[k], one.contact_forces)
    with pytest.raises(ValueError, match=r"state \[2\]: the start is contact point `cube`"):
        cube.simulate([*starts[:2], [1, 0, 0, 0, 0, 0, -1]], np.zeros(6), 0.3, 300, contacts=corners)


def test_the_page_of_a_motion_has_its_contacts(tmp_path):
    cube = mozzi.Model.from_urdf_string(CUBE, floating=True)
    corners = [{"frame": "cube", "at": (x, 0.05, -0.05), "name": f"corner {x}"} for x in (-0.05, 0.05)]
    motion = cube.simulate([1, 0, 0, 0, 0, 0, 0.05], np.zeros(6), 0.05, 50, contacts=iter(corners))
    assert motion.contacts == corners and motion.planes is None
    for moved in (motion, pickle.loads(pickle.dumps(motion))):
        moved.report(tmp_path / "cube.html")
        page = (tmp_path / "cube.html").read_text(encoding="utf-8")
        data = json.loads(page.split('id="data">')[1].split("</script>")[0])
        contacts = data["motion"]["contacts"]
        assert [pair["name"] for pair in contacts["pairs"]] == ["corner -0.05", "corner 0.05"]
        assert contacts["planes"][0]["name"] == "ground" and contacts["events"][0]["change"] == "touches down"
        forces = np.frombuffer(base64.b64decode(contacts["forces"]), "<f4").reshape(51, 2, 3)
        assert np.abs(forces - motion.contact_forces).max() < 1e-4
    free = cube.simulate([1, 0, 0, 0, 0, 0, 0.05], np.zeros(6), 0.05, 50)
    free.report(tmp_path / "free.html")
    assert '"contacts":null' in (tmp_path / "free.html").read_text(encoding="utf-8")


def test_what_is_wrong_is_said():
    cube = mozzi.Model.from_urdf_string(CUBE, floating=True)
    start = [1, 0, 0, 0, 0, 0, 0.05]
    with pytest.raises(TypeError, match="unknown `radios`"):
        cube.simulate(start, np.zeros(6), 1.0, 10, contacts=[{"frame": "cube", "radios": 1}])
    with pytest.raises(ValueError, match="without contacts"):
        cube.simulate(start, np.zeros(6), 1.0, 10, planes=[])
    with pytest.raises(ValueError, match="within its plane"):
        cube.simulate([1, 0, 0, 0, 0, 0, -1], np.zeros(6), 1.0, 10, contacts=["cube"])


def test_one_contact_and_one_plane_need_no_list():
    cube = mozzi.Model.from_urdf_string(CUBE, floating=True)
    start = [1, 0, 0, 0, 0, 0, 0.1]

    def fall(contacts, planes=None):
        return cube.simulate(start, None, 0.3, 300, contacts=contacts, planes=planes).theta

    listed = fall(["cube"], [{"pose": [1, 0, 0, 0, 0, 0, 0]}])
    assert (fall("cube", {"pose": [1, 0, 0, 0, 0, 0, 0]}) == listed).all()
    with pytest.raises(TypeError, match="contacts is True, expected a list of names or dictionaries"):
        fall(True)
