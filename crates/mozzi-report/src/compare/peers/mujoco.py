def without_geometry(text):
    robot = ElementTree.fromstring(text)
    for link in robot.iter("link"):
        for name in ("visual", "collision"):
            for element in link.findall(name):
                link.remove(element)
    return ElementTree.tostring(robot, encoding="unicode")


def without_fixed_inertia(text):
    """Links that no joint moves do without their inertias, which enter nothing."""
    robot = ElementTree.fromstring(text)
    parents = {}
    for joint in robot.findall("joint"):
        parents[joint.find("child").get("link")] = (joint.find("parent").get("link"), joint.get("type"))
    for link in robot.findall("link"):
        name, seen = link.get("name"), set()
        while name in parents and parents[name][1] == "fixed" and name not in seen:
            seen.add(name)
            name = parents[name][0]
        if name not in parents:
            for element in link.findall("inertial"):
                link.remove(element)
    return ElementTree.tostring(robot, encoding="unicode")


SMALLEST = 1e-9  # kg, kg m2: what massless bodies get, where MuJoCo refuses them


def mujoco_model(mujoco, question, attempts):
    """As it stands; where that is refused, without meshes and with the compiler's remedies, each noted."""
    path, text, is_urdf = question["path"], question["text"], question["language"] == "urdf"
    settings = {}
    while True:
        try:
            spec = mujoco.MjSpec.from_file(path) if text is None else mujoco.MjSpec.from_string(text)
            for name, value in settings.items():
                setattr(spec.compiler, name, value)
            return spec, spec.compile()
        except Exception as error:
            message = one_line(error)
        done = [step["then"] for step in attempts]
        source = lambda: open(path, "rb").read() if text is None else text
        then = None
        if is_urdf and "positive eigenvalues" in message and "fixed" not in done:
            text, then = attempt(lambda: without_fixed_inertia(source())), "fixed"
        elif "A + B" in message and "balance" not in done:
            then, settings["balanceinertia"] = "balance", True
        elif "mjMINVAL" in message and "bound" not in done:
            then, settings["boundmass"], settings["boundinertia"] = "bound", SMALLEST, SMALLEST
        elif is_urdf and "geometry" not in done:
            text, then = attempt(lambda: without_geometry(source())), "geometry"
        if then is None:
            raise Refused(message)
        attempts.append({"message": message, "then": then})


class MuJoCo:
    def __init__(self, mujoco, np, question, attempts):
        self.mujoco, self.np = mujoco, np
        if hasattr(mujoco, "set_mju_user_warning"):
            mujoco.set_mju_user_warning(lambda message: None)  # which would write a file
        self.spec, self.model = mujoco_model(mujoco, question, attempts)
        self.data = mujoco.MjData(self.model)
        free = lambda j: self.model.jnt_type[j] == mujoco.mjtJoint.mjJNT_FREE
        unnamed = lambda j: f"{self.model.body(self.model.jnt_bodyid[j]).name}:free" if free(j) else f"joint{j}"
        self.names = [self.model.joint(j).name or unnamed(j) for j in range(self.model.njnt)]
        self.home = dict(zip(question["names"], question["home"] or []))
        sizes = {mujoco.mjtJoint.mjJNT_FREE: (7, 6), mujoco.mjtJoint.mjJNT_BALL: (4, 3)}
        self.sizes = [sizes.get(mujoco.mjtJoint(kind), (1, 1)) for kind in self.model.jnt_type]

    def set(self, values, addresses, target, width):
        for name, at, size in zip(self.names, addresses, self.sizes):
            if len(values.get(name, [])) == size[width]:
                target[at:at + size[width]] = values[name]
            elif size[width] == 1:
                target[at] = 0.0

    def place(self, theta, dtheta):
        self.data.qpos[:] = self.model.qpos0
        for at, (nq, _) in zip(self.model.jnt_qposadr, self.sizes):
            if nq == 7:
                self.data.qpos[at:at + 7] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
        self.data.qvel[:] = 0.0
        self.set(theta, self.model.jnt_qposadr, self.data.qpos, 0)
        self.set(dtheta, self.model.jnt_dofadr, self.data.qvel, 1)
        self.mujoco.mj_forward(self.model, self.data)

    def axes(self, j):
        """In the world, at the present configuration; of a joint of several velocities, none."""
        axis, anchor = self.data.xaxis[j], self.data.xanchor[j]
        kind = self.mujoco.mjtJoint(self.model.jnt_type[j])
        if kind == self.mujoco.mjtJoint.mjJNT_HINGE:
            return [numbers([*axis, *-self.np.cross(axis, anchor)])]
        if kind == self.mujoco.mjtJoint.mjJNT_SLIDE:
            return [numbers([0.0, 0.0, 0.0, *axis])]
        return [[0.0] * 6] * self.sizes[j][1]

    def bodies(self):
        """Mass, centre and inertia of each moving body with all that is welded to it, in the world."""
        np, model, data, result = self.np, self.model, self.data, {}
        for b in range(1, model.nbody):
            mass, first, second = result.setdefault(int(model.body_weldid[b]), [0.0, np.zeros(3), np.zeros((3, 3))])
            R, c, m = data.ximat[b].reshape(3, 3), data.xipos[b], model.body_mass[b]
            about = R @ np.diag(model.body_inertia[b]) @ R.T + m * (c @ c * np.eye(3) - np.outer(c, c))
            result[int(model.body_weldid[b])] = [mass + m, first + m * c, second + about]
        return result

    def armature(self):
        """Of each velocity: the joint's own, and that of the actuators that move the joint."""
        np, model = self.np, self.model
        result = np.array(model.dof_armature, float).reshape(model.nv, -1)[:, 0]
        kinds = [int(self.mujoco.mjtTrn.mjTRN_JOINT), int(self.mujoco.mjtTrn.mjTRN_JOINTINPARENT)]
        for k, more in enumerate(np.ravel(getattr(model, "actuator_armature", []))):
            if int(model.actuator_trntype[k]) in kinds and more:
                j = int(model.actuator_trnid[k][0])
                first = int(model.jnt_dofadr[j])
                result[first : first + self.sizes[j][1]] += more * model.actuator_gear[k][0] ** 2
        return result

    def joints(self):
        np, model = self.np, self.model
        self.place(self.home, {})
        bodies, result = self.bodies(), []
        last = {}  # of each body, its last joint
        flat = lambda values, span: numbers(np.asarray(values).reshape(model.nv, -1)[span, 0])
        armature = self.armature()
        for j in range(model.njnt):
            body, (nq, nv) = int(model.jnt_bodyid[j]), self.sizes[j]
            up, parent = int(model.body_parentid[body]), last.get(body)
            while parent is None and up > 0:
                parent, up = last.get(up), int(model.body_parentid[up])
            is_last = j + 1 == model.njnt or int(model.jnt_bodyid[j + 1]) != body
            mass, first, second = bodies[body] if is_last else (0.0, np.zeros(3), np.zeros((3, 3)))
            c = first / mass if mass else first
            span = slice(int(model.jnt_dofadr[j]), int(model.jnt_dofadr[j]) + nv)
            result.append({
                "name": self.names[j], "nq": nq, "nv": nv, "parent": parent, "axes": self.axes(j),
                "mass": float(mass), "center": numbers(c),
                "inertia": rows(second - mass * (c @ c * np.eye(3) - np.outer(c, c))),
                "armature": flat(armature, span), "damping": flat(model.dof_damping, span),
                "friction": flat(model.dof_frictionloss, span),
            })
            last[body] = len(result) - 1
        return result

    def mass_matrix(self):
        M = self.np.zeros((self.model.nv, self.model.nv))
        try:
            self.mujoco.mj_fullM(self.model, self.data, M)
        except TypeError:  # before version 4
            self.mujoco.mj_fullM(self.model, M, self.data.qM)
        return M

    def state(self, theta, dtheta, ddtheta):
        data, result = self.data, {}
        self.place(theta, {})
        result["g"] = numbers(data.qfrc_bias)
        self.place(theta, dtheta)
        result["M"], result["h"] = rows(self.mass_matrix()), numbers(data.qfrc_bias)
        data.qacc[:] = 0.0
        self.set(ddtheta, self.model.jnt_dofadr, data.qacc, 1)
        self.mujoco.mj_inverse(self.model, data)
        result["tau"] = numbers(data.qfrc_inverse)
        result["parts"] = {name: numbers(getattr(data, f"qfrc_{name}")) for name in ("spring", "gravcomp", "fluid")}
        counts = {"equalities": data.ne, "dry friction": data.nf, "limits": data.nl, "contacts": data.ncon}
        result["constraints"] = [name for name, count in counts.items() if count]
        if result["constraints"]:
            # computed anew: the forces may be so large that taking them off leaves rounding
            before, off = int(self.model.opt.disableflags), int(self.mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
            self.model.opt.disableflags = before | off
            self.mujoco.mj_inverse(self.model, data)
            result["unconstrained"] = numbers(data.qfrc_inverse)
            self.model.opt.disableflags = before
        return result

    def about(self):
        model, mujoco, couplings = self.model, self.mujoco, []
        for i in range(model.neq):
            if model.eq_type[i] != mujoco.mjtEq.mjEQ_JOINT or model.eq_obj2id[i] < 0:
                continue
            names = [self.names[model.eq_obj1id[i]], self.names[model.eq_obj2id[i]]]
            couplings.append({"joint": names[0], "source": names[1]})
        off = int(model.opt.disableflags) & int(mujoco.mjtDisableBit.mjDSBL_GRAVITY)
        compiler = self.spec.compiler
        return {
            "gravity": [0.0] * 3 if off else numbers(model.opt.gravity),
            "couplings": couplings,
            "from_geometry": [b.name for b in self.spec.bodies if len(b.geoms) and not b.explicitinertial],
            "settings": {
                "balanceinertia": bool(compiler.balanceinertia), "settotalmass": float(compiler.settotalmass),
                "boundmass": float(compiler.boundmass), "boundinertia": float(compiler.boundinertia),
                "inertiafromgeom": str(compiler.inertiafromgeom).rsplit("_", 1)[-1].lower(),
            },
        }
