"""The time of MuJoCo's mj_step of a standing ANYmal: see contact_speed.rs."""

import time
from pathlib import Path

import mujoco
import numpy as np

POSE = [0, 0.7, -1.0, 0, 0.7, -1.0, 0, -0.7, 1.0, 0, -0.7, 1.0]
LEGS = [f"{leg}_{joint}" for leg in ("LF", "RF", "LH", "RH") for joint in ("HAA", "HFE", "KFE")]

urdf = Path(__file__).resolve().parents[3] / "crates/mozzi-urdf/models/anymal.urdf"
text = urdf.read_text().replace("<robot ", "<robot ", 1)
start = text.index(">", text.index("<robot")) + 1
text = text[:start] + '<mujoco><compiler discardvisual="true" fusestatic="false"/></mujoco>' + text[start:]
spec = mujoco.MjSpec.from_string(text)
spec.option.timestep = 1e-3
spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[10, 10, 0.1], friction=[0.7, 0.005, 0.0001])
base = spec.worldbody.first_body()
base.add_freejoint()
for foot in ("LF_FOOT", "RF_FOOT", "LH_FOOT", "RH_FOOT"):
    spec.body(foot).add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.001, 0, 0], friction=[0.7, 0.005, 0.0001], mass=0)
for name, angle in zip(LEGS, POSE):
    joint = spec.joint(name)
    joint.damping = [10, 0, 0] if np.ndim(joint.damping) else 10
    joint.stiffness = [400, 0, 0] if np.ndim(joint.stiffness) else 400
    joint.springref = angle
for exclude_a in ():
    pass
model = spec.compile()
model.geom_contype[:] = 1
model.geom_conaffinity[:] = 1
data = mujoco.MjData(model)
for name, angle in zip(LEGS, POSE):
    data.qpos[model.joint(name).qposadr] = angle
mujoco.mj_forward(model, data)
feet = [data.body(f"{leg}_FOOT").xpos[2] for leg in ("LF", "RF", "LH", "RH")]
data.qpos[2] -= min(feet) - 0.001
mujoco.mj_step(model, data, nstep=2000)
best = float("inf")
for _ in range(5):
    clock = time.perf_counter()
    mujoco.mj_step(model, data, nstep=2000)
    best = min(best, (time.perf_counter() - clock) / 2000 * 1e6)
print(f"MuJoCo {mujoco.__version__}: {best:.1f} µs a step of 1 ms (best of 5 times 2000 steps), {data.ncon} contacts, z {data.qpos[2]:.3f} m")
