"""Masses, M and h of robots' files by Drake, at states of named joints: JSON from standard input to standard output."""

import json
import logging
import os
import sys

logging.disable(logging.CRITICAL)
from pydrake.multibody.plant import MultibodyPlant  # first: the parser needs its types
from pydrake.multibody.tree import BodyIndex
from pydrake.multibody.parsing import Parser


def answer(robot):
    plant = MultibodyPlant(0.0)
    parser = Parser(plant)
    parts = os.path.join(os.path.dirname(robot["path"]), "part")
    if os.path.isdir(parts):
        parser.package_map().Add("part", parts)
    parser.AddModels(robot["path"])
    plant.Finalize()
    context = plant.CreateDefaultContext()
    bodies = [plant.get_body(BodyIndex(i)) for i in range(1, plant.num_bodies())]
    masses = sorted(body.default_mass() for body in bodies)
    Ms, hs = [], []
    for state in robot["states"]:
        q, v, rows = plant.GetPositions(context) * 0, plant.GetVelocities(context) * 0, []
        for body in plant.GetFloatingBaseBodies():
            q[plant.get_body(body).floating_positions_start()] = 1
        for (name, instance, part), theta, dtheta in zip(robot["joints"], state["theta"], state["dtheta"]):
            # a joint is in its child's model
            named = [joint for joint in map(plant.get_joint, plant.GetJointIndices()) if joint.name() == name]
            own = [joint for joint in named if plant.GetModelInstanceName(joint.model_instance()) == instance]
            joint = (own if len(named) > 1 else named)[0]
            q[joint.position_start() + part] = theta
            v[joint.velocity_start() + part] = dtheta
            rows.append(joint.velocity_start() + part)
        plant.SetPositions(context, q)
        plant.SetVelocities(context, v)
        M = plant.CalcMassMatrix(context)
        h = plant.CalcBiasTerm(context) - plant.CalcGravityGeneralizedForces(context)
        Ms.append([M[i, j] for i in rows for j in rows])
        hs.append([h[i] for i in rows])
    return {"masses": masses, "M": Ms, "h": hs}


json.dump([answer(robot) for robot in json.load(sys.stdin)], sys.stdout)
