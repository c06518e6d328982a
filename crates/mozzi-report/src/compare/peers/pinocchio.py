def pinocchio_model(pin, question):
    path, text = question["path"], question["text"]
    if question["language"] == "mjcf":
        if not hasattr(pin, "buildModelFromMJCF"):
            raise Refused("this version reads no MJCF")
        model = attempt(lambda: pin.buildModelFromMJCF(path))
        return model[0] if isinstance(model, tuple) else model
    options = {"mimic": True} if question["mimic"] else {}
    if path is None:
        return attempt(lambda: pin.buildModelFromXML(text, **options))
    return attempt(lambda: pin.buildModelFromUrdf(path, **options))


class Pinocchio:
    """The model, its joints flat: one made of several is several."""

    def __init__(self, pin, np, question):
        self.pin, self.np = pin, np
        self.model = pinocchio_model(pin, question)
        self.data = self.model.createData()
        order = [joint["name"] for joint in question["joints"]]
        self.parts = []  # of each moving joint of the model: names, positions, velocities
        for i in range(1, self.model.njoints):
            joint, name = self.model.joints[i], self.model.names[i]
            inner = getattr(joint.extract(), "joints", None) if hasattr(joint, "extract") else None
            if inner is None or joint.shortname() != "JointModelComposite":
                self.parts.append((i, [(name, self.model.nqs[i], self.model.nvs[i])]))
                continue
            first = name.removeprefix("Composite_")
            start = order.index(first) if first in order else None
            names = [first] + [f"{name}_{k}" for k in range(1, len(inner))]
            if start is not None:
                names = (order[start:start + len(inner)] + names)[:len(inner)]
            self.parts.append((i, [(n, part.nq, part.nv) for n, part in zip(names, inner)]))

    def configuration(self, angles):
        q = self.pin.neutral(self.model)
        for i, parts in self.parts:
            at = self.model.idx_qs[i]
            for name, nq, nv in parts:
                own = angles.get(name, [0.0])
                if nv == 1 and nq == 2:
                    q[at], q[at + 1] = self.np.cos(own[0]), self.np.sin(own[0])
                elif len(own) == nq:
                    q[at:at + nq] = own
                at += nq
        return q

    def velocity(self, rates):
        v = self.np.zeros(self.model.nv)
        for i, parts in self.parts:
            at = self.model.idx_vs[i]
            for name, _, nv in parts:
                own = rates.get(name, [])
                if len(own) == nv:
                    v[at:at + nv] = own
                at += nv
        return v

    def joints(self):
        model, data, pin = self.model, self.data, self.pin
        neutral = self.configuration({})
        J = pin.computeJointJacobians(model, data, neutral).reshape(6, -1)  # of one velocity it is a list
        friction = getattr(model, "upperDryFrictionLimit", getattr(model, "friction", self.np.zeros(model.nv)))
        last, result = {0: None}, []
        for i, parts in self.parts:
            parent, at = last[model.parents[i]], model.idx_vs[i]
            for k, (name, nq, nv) in enumerate(parts):
                body = data.oMi[i].act(model.inertias[i]) if k + 1 == len(parts) else None
                span = slice(at, at + nv)
                result.append({
                    "name": name, "nq": int(nq), "nv": int(nv), "parent": parent,
                    "axes": [numbers([*J[3:, c], *J[:3, c]]) for c in range(at, at + nv)],
                    "mass": float(body.mass) if body else 0.0,
                    "center": numbers(body.lever) if body else [0.0] * 3,
                    "inertia": rows(body.inertia) if body else [[0.0] * 3] * 3,
                    "armature": numbers(model.armature[span]), "damping": numbers(model.damping[span]),
                    "friction": numbers(friction[span]),
                })
                parent, at = len(result) - 1, at + nv
            last[i] = parent
        return result

    def state(self, theta, dtheta, ddtheta):
        pin, model, data = self.pin, self.model, self.data
        q, v, a = self.configuration(theta), self.velocity(dtheta), self.velocity(ddtheta)
        M = self.np.triu(self.np.reshape(pin.crba(model, data, q), (model.nv, model.nv)))
        return {
            "M": rows(M + self.np.triu(M, 1).T),
            "g": numbers(pin.computeGeneralizedGravity(model, data, q)),
            "h": numbers(pin.nonLinearEffects(model, data, q, v)),
            "tau": numbers(pin.rnea(model, data, q, v, a)),
            "parts": {},
        }

    def about(self):
        return {"gravity": numbers(self.model.gravity.linear), "couplings": [], "from_geometry": [], "settings": {}}
