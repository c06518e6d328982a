#!/usr/bin/env python3
"""The constraint Jacobians of MuJoCo, of the models in oracles/constraints, at configurations that satisfy the constraints.

    python oracles/make_constraints.py

For each model a file of states: `qpos`, and for each equality its name (or number) and the rows `J` of efc_J, in MuJoCo's conventions.
Configurations are found by Newton's method on MuJoCo's own residuals, from random starts.
"""

import json
from pathlib import Path

import mujoco
import numpy as np

FOLDER = Path(__file__).resolve().parent / "constraints"
STATES = 4


def rows(model, data):
    """efc_J and efc_pos, dense; each row's equality."""
    mujoco.mj_fwdPosition(model, data)
    J = np.zeros((data.nefc, model.nv))
    if mujoco.mj_isSparse(model):
        mujoco.mju_sparse2dense(J, data.efc_J, data.efc_J_rownnz, data.efc_J_rowadr, data.efc_J_colind)
    else:
        J[:] = data.efc_J.reshape(data.nefc, model.nv)
    return J, data.efc_pos.copy(), data.efc_id.copy()


def close(model, data, rng):
    """A configuration near qpos0 at which all equalities hold, or None."""
    data.qpos[:] = model.qpos0
    mujoco.mj_integratePos(model, data.qpos, rng.uniform(-0.3, 0.3, model.nv), 1.0)
    for _ in range(100):
        J, residual, _ = rows(model, data)
        if np.abs(residual).max() < 1e-14:
            break
        mujoco.mj_integratePos(model, data.qpos, -np.linalg.pinv(J, rcond=1e-9) @ residual, 1.0)
    return np.abs(residual).max() < 1e-12


def main():
    for path in sorted(FOLDER.glob("*.xml")):
        model = mujoco.MjModel.from_xml_path(str(path))
        model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        data, rng, states = mujoco.MjData(model), np.random.default_rng(22), []
        for _ in range(100 * STATES):
            if len(states) == STATES:
                break
            if not close(model, data, rng):
                continue
            J, _, which = rows(model, data)
            equalities = [
                {"name": model.equality(k).name or f"{'connect weld joint tendon'.split()[model.eq_type[k]]}{k}", "J": J[which == k].tolist()}
                for k in range(model.neq)
                if model.eq_active0[k]
            ]
            states.append({"qpos": data.qpos.tolist(), "equalities": equalities})
        text = json.dumps({"model": path.name, "mujoco": mujoco.__version__, "states": states})
        path.with_suffix(".json").write_text(text + "\n")
        print(f"{path.name}: {len(states)} states, {J.shape[0]} rows, nv {model.nv}")


if __name__ == "__main__":
    main()
