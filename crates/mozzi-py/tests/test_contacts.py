"""Dry friction that sticks, and contacts with planes."""

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


@pytest.mark.parametrize("method", ["auto", "moreau", "rk4", "euler", "semi-implicit-euler", "dopri", "midpoint"])
def test_dry_friction_holds(method):
    motion = mozzi.Model.from_urdf_string(STUCK).simulate([0.3], [0.0], 1.0, 500, method=method)
    assert np.abs(motion.theta - 0.3).max() < 1e-12
    assert motion.one_sided.unsolved == 0 and motion.one_sided.largest_residual < 1e-10


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


def test_what_is_wrong_is_said():
    cube = mozzi.Model.from_urdf_string(CUBE, floating=True)
    start = [1, 0, 0, 0, 0, 0, 0.05]
    with pytest.raises(TypeError, match="unknown `radios`"):
        cube.simulate(start, np.zeros(6), 1.0, 10, contacts=[{"frame": "cube", "radios": 1}])
    with pytest.raises(ValueError, match="without contacts"):
        cube.simulate(start, np.zeros(6), 1.0, 10, planes=[])
    with pytest.raises(ValueError, match="within its plane"):
        cube.simulate([1, 0, 0, 0, 0, 0, -1], np.zeros(6), 1.0, 10, contacts=["cube"])
