"""Random trees of all joints, as MJCF text, as URDF text and as a `pinocchio.Model`."""

from dataclasses import dataclass, field, replace

import numpy as np


@dataclass
class Joint:
    """A joint of a body; `axis` and `at`, a point on it, are in the body's coordinates."""

    name: str
    kind: str  # hinge, slide, ball or free
    axis: np.ndarray = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    at: np.ndarray = field(default_factory=lambda: np.zeros(3))
    ref: float = 0.0
    armature: float = 0.0
    damping: float = 0.0
    stiffness: float = 0.0
    springref: float = 0.0


@dataclass
class Body:
    """A body at (R, p) of its parent's frame; its inertia is about its center of mass, in its own axes."""

    name: str
    parent: int  # -1: the world
    R: np.ndarray
    p: np.ndarray
    joints: list
    mass: float
    center: np.ndarray
    inertia: np.ndarray


@dataclass
class Mimic:
    """y − ref_y = offset + ratio (x − ref_x), as `<equality><joint>` writes it."""

    y: str
    x: str
    offset: float
    ratio: float


@dataclass
class Tendon:
    """A fixed tendon with an armature, of joints on one path: MuJoCo leaves out what it couples otherwise."""

    armature: float
    gears: dict  # of joints' names


@dataclass
class Tree:
    bodies: list
    mimics: list
    gravity: np.ndarray
    tendons: list = field(default_factory=list)
    is_mjcf: bool = True  # the positions of a free joint are its pose in the world; else from where the file has it

    @staticmethod
    def random(seed, size=7):
        """A third of the trees is a floating base with all that hangs on it; another has free bodies next to a fixed base."""
        random = np.random.default_rng(seed)
        bodies = []
        for k in range(size):
            is_root = k == 0 or (seed % 3 != 1 and random.uniform() < 0.3)
            parent = -1 if is_root else _one_of(random, _path(bodies, k - 1))  # so depth first, as libraries number joints
            is_free = is_root and (seed % 3 == 1 or (seed % 3 == 2 and random.uniform() < 0.6))
            kinds = ["free"] if is_free else _kinds(random, is_root)
            joints = [_joint(random, kind, f"joint{k}{'abc'[i]}", i, seed % 3 == 1) for i, kind in enumerate(kinds)]
            R, p, mass = _rotation(random), random.uniform(-0.5, 0.5, 3), 10.0 ** random.uniform(-3, 3)
            center, inertia = random.uniform(-0.2, 0.2, 3), mass * _inertia_of_one_kilogram(random)
            bodies.append(Body(f"body{k}", parent, R, p, joints, mass, center, inertia))
        tree = Tree(bodies, [], random.uniform(-1, 1, 3) + [0, 0, -9.5])
        tree.mimics = _mimics(random, tree) if seed % 2 else []
        tree.add_springs_and_rotors(np.random.default_rng(seed + 5000), seed % 3 == 1)
        return tree

    def add_springs_and_rotors(self, random, is_floating):
        """Springs of balls, the armature of free bodies that are no base, and a tendon."""
        for joint in self.joints():
            if joint.kind == "ball":
                joint.stiffness = random.choice([0.0, random.uniform(1, 50)])
            if joint.kind == "free" and not is_floating:
                joint.armature = random.choice([0.0, random.uniform(0, 0.5)])
        path = _path(self.bodies, int(random.integers(len(self.bodies))))
        names = [joint.name for k in path for joint in self.bodies[k].joints if joint.kind in ("hinge", "slide")]
        self.tendons = [Tendon(random.uniform(0, 0.5), {name: random.uniform(-3, 3) for name in names[:3]})] if names else []

    @staticmethod
    def with_free_joints_inside(seed, size=6):
        """Hinges, slides and free joints anywhere: what URDF can say. One joint a body."""
        random = np.random.default_rng(seed)
        tree = Tree.random(3 * seed, size)  # on a fixed base
        for k, body in enumerate(tree.bodies):
            kind = "free" if k % 3 == 1 else str(random.choice(["hinge", "slide"]))
            body.joints = [replace(_joint(random, kind, f"joint{k}", k, True), ref=0.0, armature=0.0, at=np.zeros(3))]
        tree.mimics, tree.is_mjcf = [], False
        return tree.without_passive_forces()

    def joints(self):
        return [joint for body in self.bodies for joint in body.joints]

    def without_passive_forces(self):
        """Without what Pinocchio has none of, either: an armature of free joints as a mass, rotors that several joints turn."""
        still = lambda joint: 0.0 if joint.kind == "free" else joint.armature
        slack = lambda joint: replace(joint, damping=0.0, stiffness=0.0, armature=still(joint))
        return replace(self, tendons=[], bodies=[replace(body, joints=[slack(joint) for joint in body.joints]) for body in self.bodies])

    def without_mimics(self):
        return replace(self, mimics=[])

    def mjcf(self):
        equality = "".join(
            f'<joint joint1="{m.y}" joint2="{m.x}" polycoef="{m.offset!r} {m.ratio!r} 0 0 0"/>' for m in self.mimics
        )
        gears = lambda tendon: "".join(f'<joint joint="{name}" coef="{ratio!r}"/>' for name, ratio in tendon.gears.items())
        tendons = "".join(f'<fixed armature="{tendon.armature!r}">{gears(tendon)}</fixed>' for tendon in self.tendons)
        return (
            f'<mujoco><compiler angle="radian"/><option gravity="{_text(self.gravity)}"/>'
            f"<worldbody>{self._mjcf_bodies(-1)}</worldbody><equality>{equality}</equality>"
            f"{tendons and f'<tendon>{tendons}</tendon>'}</mujoco>"
        )

    def _mjcf_bodies(self, parent):
        return "".join(self._mjcf_body(k) for k, body in enumerate(self.bodies) if body.parent == parent)

    def _mjcf_body(self, k):
        body = self.bodies[k]
        I = body.inertia
        full = _text([I[0, 0], I[1, 1], I[2, 2], I[0, 1], I[0, 2], I[1, 2]])
        return (
            f'<body name="{body.name}" pos="{_text(body.p)}" quat="{_text(_quaternion(body.R))}">'
            f'<inertial pos="{_text(body.center)}" mass="{body.mass!r}" fullinertia="{full}"/>'
            f"{''.join(map(_mjcf_joint, body.joints))}{self._mjcf_bodies(k)}</body>"
        )

    def urdf(self):
        """Of one joint a body, which is no ball and has no forces of its own."""
        kinds = {"hinge": "continuous", "slide": "prismatic", "free": "floating"}
        parts = []
        for body in self.bodies:
            (joint,) = body.joints
            moments = " ".join(f'i{"xyz"[i]}{"xyz"[j]}="{_text([body.inertia[i, j]])}"' for i in range(3) for j in range(i, 3))
            parent = "world" if body.parent < 0 else self.bodies[body.parent].name
            limit = '<limit lower="-9" upper="9" effort="9" velocity="9"/>' if joint.kind == "slide" else ""
            parts.append(
                f'<link name="{body.name}"><inertial><origin xyz="{_text(body.center)}"/><mass value="{body.mass!r}"/>'
                f"<inertia {moments}/></inertial></link>"
                f'<joint name="{joint.name}" type="{kinds[joint.kind]}"><parent link="{parent}"/><child link="{body.name}"/>'
                f'<origin xyz="{_text(body.p)}" rpy="{_text(_roll_pitch_yaw(body.R))}"/><axis xyz="{_text(joint.axis)}"/>{limit}</joint>'
            )
        return f'<robot name="tree"><link name="world"/>{"".join(parts)}</robot>'

    def pinocchio(self):
        """A `pinocchio.Model` by its API; its joints' positions are those of the texts."""
        import pinocchio as pin

        model, ends = pin.Model(), []  # of each body, its joint and where its frame is there
        move = lambda R, p: pin.SE3(np.asarray(R, float), np.asarray(p, float))
        for body in self.bodies:
            i, place = (0, pin.SE3.Identity()) if body.parent < 0 else ends[body.parent]
            place = place * move(body.R, body.p)
            for joint in body.joints:
                kind, back = _pinocchio_joint(pin, joint), move(np.eye(3), np.zeros(3))
                if joint.kind == "hinge":
                    back = move(pin.AngleAxis(-joint.ref, joint.axis).toRotationMatrix(), np.zeros(3))
                elif joint.kind == "slide":
                    back = move(np.eye(3), -joint.ref * joint.axis)
                elif joint.kind == "free" and self.is_mjcf:
                    place = pin.SE3.Identity()
                i = model.addJoint(i, kind, place * move(np.eye(3), joint.at) * back, joint.name)
                place = move(np.eye(3), -joint.at)
                model.armature[model.idx_vs[i] : model.idx_vs[i] + model.nvs[i]] = joint.armature
            model.appendBodyToJoint(i, pin.Inertia(body.mass, body.center, body.inertia), place)
            ends.append((i, place))
        model.gravity.linear = self.gravity
        return model


def _one_of(random, list):
    return list[random.integers(len(list))] if random.uniform() < 0.5 else list[0]


def _path(bodies, k):
    """The body and all that carry it."""
    return [k, *_path(bodies, bodies[k].parent)] if k >= 0 else []


def _inertia_of_one_kilogram(random):
    """With random principal axes."""
    Q, (a, b, c) = _rotation(random), random.uniform(0.002, 0.1, 3)
    inertia = Q @ np.diag([b + c, a + c, a + b]) @ Q.T
    return 0.5 * (inertia + inertia.T)


def _kinds(random, is_root):
    """Of the joints of a body: none, one or several; after a ball only slides, as MuJoCo demands."""
    kinds = []
    for _ in range(random.choice([1, 1, 1, 2, 3] if is_root else [0, 1, 1, 1, 2, 3])):
        kinds.append(str(random.choice(["slide"] if "ball" in kinds else ["hinge", "slide", "ball"])))
    return kinds


def _pinocchio_joint(pin, joint):
    """Aligned axes have joints of their own; such a hinge off the body's origin has the positions (cos θ, sin θ)."""
    if joint.kind in ("free", "ball"):
        return pin.JointModelFreeFlyer() if joint.kind == "free" else pin.JointModelSpherical()
    along = [k for k in range(3) if joint.axis[k] == 1.0]
    if along:
        kind = "P" if joint.kind == "slide" else "RUB" if joint.at.any() else "R"
        return getattr(pin, f"JointModel{kind}{'XYZ'[along[0]]}")()
    if joint.kind == "slide":
        return pin.JointModelPrismaticUnaligned(joint.axis)
    return pin.JointModelRevoluteUnaligned(joint.axis)


def _joint(random, kind, name, number, is_floating):
    """Joints of one body have different axes and centers, or M would be singular."""
    if kind == "free":
        # an undamped one, with all on it, is a floating base
        return Joint(name, kind, damping=0.0 if is_floating else random.choice([0.0, random.uniform(0, 3)]))
    axis = random.normal(size=3) if random.uniform() < 0.6 else np.eye(3)[number % 3]
    at = random.uniform(-0.3, 0.3, 3) if number > 0 or random.uniform() < 0.5 else np.zeros(3)
    joint = Joint(name, kind, axis / np.linalg.norm(axis), at)
    joint.armature, joint.damping = (random.choice([0.0, random.uniform(0, 0.5)]) for _ in range(2))
    if kind != "ball":
        joint.ref = random.choice([0.0, random.uniform(-1, 1)])
        joint.stiffness, joint.springref = random.choice([0.0, random.uniform(1, 50)]), random.uniform(-1, 1)
    return joint


def _mimics(random, tree):
    """Of the joints of one axis the last follows the first, and the one before it follows the second."""
    names = [joint.name for joint in tree.joints() if joint.kind in ("hinge", "slide")]
    pairs = list(zip(names[::-1], names))[: len(names) // 3]
    return [Mimic(y, x, random.uniform(-0.5, 0.5), random.uniform(-2, 2)) for y, x in pairs]


def _mjcf_joint(joint):
    if joint.kind == "free":
        armature = f' armature="{float(joint.armature)!r}"' if joint.armature else ""
        return f'<joint name="{joint.name}" type="free" damping="{float(joint.damping)!r}"{armature}/>'
    numbers = {name: getattr(joint, name) for name in ("ref", "armature", "damping", "stiffness", "springref")}
    if joint.kind == "ball":
        numbers = {name: numbers[name] for name in ("armature", "damping", "stiffness")}
    words = "".join(f' {name}="{float(x)!r}"' for name, x in numbers.items())
    return f'<joint name="{joint.name}" type="{joint.kind}" axis="{_text(joint.axis)}" pos="{_text(joint.at)}"{words} frictionloss="0"/>'


def _text(numbers):
    return " ".join(repr(float(x)) for x in numbers)


def _rotation(random):
    Q, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return Q * np.linalg.det(Q)


def _quaternion(R):
    """(w, x, y, z), by the eigenvector of Bar-Itzhack's matrix."""
    K = np.array([
        [R[0, 0] + R[1, 1] + R[2, 2], R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]],
        [0.0, R[0, 0] - R[1, 1] - R[2, 2], R[0, 1] + R[1, 0], R[0, 2] + R[2, 0]],
        [0.0, 0.0, R[1, 1] - R[0, 0] - R[2, 2], R[1, 2] + R[2, 1]],
        [0.0, 0.0, 0.0, R[2, 2] - R[0, 0] - R[1, 1]],
    ])
    return np.linalg.eigh(K, UPLO="U")[1][:, 3]


def _roll_pitch_yaw(R):
    return [np.arctan2(R[2, 1], R[2, 2]), np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0])), np.arctan2(R[1, 0], R[0, 0])]
