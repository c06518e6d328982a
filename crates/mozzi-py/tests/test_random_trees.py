"""Random trees of hinges, slides, balls and free bodies next to each other, compared with MuJoCo and Pinocchio.

Errors are in ε times the size of the terms, entry by entry. What a library computes for a tree without mimic joints is projected on the joints that
move on their own: θ̇ of all joints is G θ̇.
"""

import mozzi
import numpy as np
import pytest
from conftest import assert_close, load_mjcf
from random_tree import Tree

TREES, STATES = range(24), 5
UNIT = 2.0**-52
pytestmark = pytest.mark.filterwarnings("ignore::mozzi.LoadWarning")  # a free body's pose in the file is where it starts
LIMIT, LIMIT_OF_DERIVATIVES = 30 * UNIT, 1000 * UNIT
# Pinocchio rounds as much, and differently on each processor: that of both.
LIMIT_OF_BOTH = 2 * LIMIT


class Pair:
    """A tree in mozzi, with and without its mimic joints."""

    def __init__(self, tree, folder):
        self.tree = tree
        read = lambda tree: load_mjcf(folder, tree.mjcf()) if tree.is_mjcf else mozzi.Model.from_urdf_string(tree.urdf()).with_gravity(tree.gravity)
        self.robot, self.whole = read(tree), read(tree.without_mimics())
        own, names = list(self.robot.velocity_names), list(self.whole.velocity_names)
        self.G, self.shift = np.zeros((self.whole.n, self.robot.n)), dict.fromkeys(names, 0.0)
        refs = {joint.name: joint.ref for joint in tree.joints()}
        for i, name in enumerate(names):
            ratio, shift, at = 1.0, 0.0, name
            for mimic in (m for m in tree.mimics if m.y == name):
                at, ratio, shift = mimic.x, mimic.ratio, refs[mimic.y] + mimic.offset - mimic.ratio * refs[mimic.x]
            self.G[i, own.index(at)], self.shift[name] = ratio, shift

    def states(self, random):
        for _ in range(STATES):
            theta = self.positions(random)
            dtheta, ddtheta = random.uniform(-3, 3, (2, self.robot.n))
            yield theta, self.positions_of_all(theta), dtheta, ddtheta

    def positions(self, random):
        names, theta = list(self.robot.position_names), random.uniform(-2, 2, self.robot.nq)
        for i in (i for i, name in enumerate(names) if name.endswith(".qw")):
            theta[i : i + 4] = random.normal(size=4)
            theta[i : i + 4] /= np.linalg.norm(theta[i : i + 4])
        return theta

    def positions_of_all(self, theta):
        known, mimics = dict(zip(self.robot.position_names, theta)), {m.y: m for m in self.tree.mimics}
        one = lambda name: mimics[name].ratio * known[mimics[name].x] + self.shift[name] if name in mimics else known[name]
        return np.array([one(name) for name in self.whole.position_names])


class Sizes:
    """Of the terms of a result, entry by entry: sums over the bodies of what each adds, every product by its norm.

    `about` is the point about which the library adds up the inertia of each body, its frame's origin by default.
    """

    def __init__(self, pair, theta, dtheta, ddtheta, about=None):
        robot, n, speed = pair.robot, pair.robot.n, np.abs(dtheta)
        self.M, rates, gravity = np.diag(np.abs(robot.mass_matrix(theta).diagonal())), np.zeros(n), np.zeros(n)
        self.momentum_matrix = np.zeros((6, n))
        for k, body in enumerate(pair.tree.bodies):
            J, p = robot.body_jacobian(theta, body.name), robot.forward_kinematics(theta, body.name)[:3, 3]
            arm = np.linalg.norm(body.center) + (0.0 if about is None else np.linalg.norm(p - about[k]))
            turn = np.linalg.norm(J[:3], axis=0)
            move = np.linalg.norm(J[3:], axis=0) + arm * turn
            inertia, w, v = np.linalg.norm(body.inertia), turn @ speed, move @ speed
            self.M += inertia * np.outer(turn, turn) + body.mass * np.outer(move, move)
            self.momentum_matrix[:3] += inertia * turn + body.mass * arm * move
            self.momentum_matrix[3:] += body.mass * move
            rates += inertia * turn * w * w + 2 * body.mass * move * w * v
            gravity += body.mass * np.linalg.norm(pair.tree.gravity) * move
        for tendon in pair.tree.tendons:
            J = np.abs(pair.G.T @ [tendon.gears.get(name, 0.0) for name in pair.whole.velocity_names])
            self.M += tendon.armature * np.outer(J, J)
        names = list(robot.velocity_names)
        for joint in (joint for joint in pair.tree.joints() if joint.kind == "free" and f"{joint.name}.vx" in names):
            j = names.index(f"{joint.name}.vx")
            self.M[j : j + 3, j : j + 3] += joint.armature  # MuJoCo has the world's axes
            rates[j : j + 3] += joint.armature * np.linalg.norm(dtheta[j - 3 : j]) * np.linalg.norm(dtheta[j : j + 3])
        self.h = rates + gravity
        passive = np.abs(robot.spring_forces(theta)) + np.abs(robot.joint_friction(dtheta))
        self.tau = self.h + self.M @ np.abs(ddtheta) + passive
        self.inverse = np.abs(robot.mass_matrix_inverse(theta))
        self.ddtheta = self.inverse @ self.tau
        self.kinetic, self.momentum = speed @ self.M @ speed, self.momentum_matrix @ speed


@pytest.mark.parametrize("seed", TREES)
def test_mujoco(seed, tmp_path):
    mujoco = pytest.importorskip("mujoco")
    random, pair = np.random.default_rng(seed + 1000), Pair(Tree.random(seed), tmp_path)
    robot, whole, G = pair.robot, pair.whole, pair.G
    model = mujoco.MjModel.from_xml_string(pair.tree.mjcf())
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    data, theirs, ground = mujoco.MjData(model), mozzi.conventions.MuJoCo(whole, model), None
    unconstrained = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
    assert (robot.n, robot.is_floating) == (model.nv - len(pair.tree.mimics), seed % 3 == 1)
    for theta, whole_theta, dtheta, ddtheta in pair.states(random):
        whole_dtheta, whole_ddtheta = G @ dtheta, G @ ddtheta
        data.qpos[:] = theirs.configuration(whole_theta)
        data.qvel[:] = theirs.velocity(whole_theta, whole_dtheta)
        model.opt.disableflags &= ~unconstrained
        mujoco.mj_forward(model, data)
        assert np.abs(data.efc_pos[: data.ne]).max(initial=0.0) < 10 * UNIT  # mimic joints are where MuJoCo wants them
        model.opt.disableflags |= unconstrained
        bodies = [model.body(body.name).id for body in pair.tree.bodies]
        size = Sizes(pair, theta, dtheta, ddtheta, data.subtree_com[model.body_rootid[bodies]])  # where MuJoCo has its cinert

        tau = robot.inverse_dynamics(theta, dtheta, ddtheta)
        data.qacc[:] = theirs.acceleration(whole_theta, whole_dtheta, whole_ddtheta)
        mujoco.mj_inverse(model, data)
        assert_close(tau, G.T @ theirs.from_force(data.qpos, data.qfrc_inverse), size.tau, LIMIT)
        assert_close(robot.forward_dynamics(theta, dtheta, tau), ddtheta, size.ddtheta, LIMIT)
        if not pair.tree.mimics:
            data.qfrc_applied[:] = theirs.force(whole_theta, tau)
        mujoco.mj_forward(model, data)
        if not pair.tree.mimics:
            assert_close(ddtheta, theirs.from_acceleration(data.qpos, data.qvel, data.qacc), size.ddtheta, LIMIT)

        M = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, M)
        assert_close(robot.mass_matrix(theta), G.T @ theirs.from_mass_matrix(data.qpos, M) @ G, size.M, LIMIT)
        h = theirs.from_bias_forces(data.qpos, data.qvel, whole.mass_matrix(whole_theta), data.qfrc_bias)
        assert_close(robot.bias_forces(theta, dtheta), G.T @ h, size.h, LIMIT)

        columns = np.array([theirs.velocity(whole_theta, column) for column in G.T]).T
        for body, i in zip(pair.tree.bodies, bodies):
            linear, angular = np.zeros((2, 3, model.nv))
            mujoco.mj_jacBody(model, data, linear, angular, i)
            R = data.xmat[i].reshape(3, 3)
            J = robot.body_jacobian(theta, body.name)
            assert_close(J, np.vstack([R.T @ angular, R.T @ linear]) @ columns, np.maximum(np.abs(J).max(axis=0), 1.0), LIMIT)
            T = robot.forward_kinematics(theta, body.name)
            assert_close(T[:3], np.hstack([R, data.xpos[i][:, None]]), 1.0 + np.abs(T[:3, 3]).max(), LIMIT)

        K = robot.kinetic_energy(theta, dtheta)
        assert_close(K, data.energy[1], size.kinetic, LIMIT)
        potential = np.array([robot.potential_energy(theta), data.energy[0]])
        heights = np.abs(model.body_mass[bodies] @ np.abs(data.xipos[bodies])).sum()
        of_potential = 10 * heights + sum(j.stiffness for j in pair.tree.joints()) * (1 + np.abs(whole_theta).max()) ** 2
        ground = potential if ground is None else ground
        assert_close(*(potential - ground), of_potential, LIMIT)

        mujoco.mj_subtreeVel(model, data)
        center, mass = data.subtree_com[0].copy(), model.body_subtreemass[0]
        assert_close(robot.center_of_mass(theta), center, 1.0 + np.abs(data.xipos).max(), LIMIT)
        momentum = np.hstack([data.subtree_angmom[0], mass * data.subtree_linvel[0]])
        size = Sizes(pair, theta, dtheta, ddtheta, np.tile(center, (len(bodies), 1)))
        assert_close(robot.momentum(theta, dtheta, about=center), momentum, size.momentum, LIMIT)


@pytest.mark.parametrize("tree", [Tree.random(seed) for seed in TREES] + [Tree.with_free_joints_inside(seed) for seed in range(6)])
def test_pinocchio(tree, tmp_path):
    pin = pytest.importorskip("pinocchio")
    tree = tree.without_passive_forces()
    random, pair = np.random.default_rng(len(tree.mjcf())), Pair(tree, tmp_path)
    robot, whole, G, model = pair.robot, pair.whole, pair.G, tree.pinocchio()
    data, bridge = model.createData(), mozzi.conventions.Pinocchio(whole, model)
    rigid = model.copy()  # computeKineticEnergy of Pinocchio 4.1 leaves out the armature of JointModelRevoluteUnaligned
    rigid.armature = np.zeros(model.nv)
    upper = lambda M: np.triu(M) + np.triu(M, 1).T
    forces = lambda tau: G.T @ bridge.from_force(tau)
    matrix = lambda M: G.T @ bridge.from_mass_matrix(M) @ G
    for theta, whole_theta, dtheta, ddtheta in pair.states(random):
        size, world = Sizes(pair, theta, dtheta, ddtheta), Sizes(pair, theta, dtheta, ddtheta, np.zeros((len(tree.bodies), 3)))
        q, v, a = bridge.configuration(whole_theta), bridge.velocity(G @ dtheta), bridge.acceleration(G @ ddtheta)
        tau = robot.inverse_dynamics(theta, dtheta, ddtheta)
        assert_close(robot.mass_matrix(theta), matrix(upper(pin.crba(model, data, q))), size.M, LIMIT_OF_BOTH)
        assert_close(tau, forces(pin.rnea(model, data, q, v, a)), size.tau, LIMIT_OF_BOTH)
        assert_close(robot.bias_forces(theta, dtheta), forces(pin.nonLinearEffects(model, data, q, v)), size.h, LIMIT_OF_BOTH)
        C = pin.computeCoriolisMatrix(model, data, q, v)
        assert_close(robot.velocity_product(theta, dtheta), forces(C @ v), size.h, LIMIT_OF_BOTH)

        pin.computeRNEADerivatives(model, data, q, v, a)
        d_theta, d_dtheta, d_ddtheta = robot.inverse_dynamics_derivatives(theta, dtheta, ddtheta)
        row = lambda D: np.abs(D).max(axis=1, keepdims=True)
        assert_close(d_theta, matrix(data.dtau_dq), row(d_theta) + size.tau[:, None], LIMIT_OF_DERIVATIVES)
        assert_close(d_dtheta, matrix(data.dtau_dv), row(d_dtheta) + size.h[:, None], LIMIT_OF_DERIVATIVES)
        assert_close(d_ddtheta, matrix(upper(data.M)), world.M, LIMIT_OF_BOTH)  # by inertias about the world's origin
        products = robot.inverse_dynamics_vjp(theta, dtheta, ddtheta, ddtheta)
        terms = (row(d_theta) + size.tau[:, None], row(d_dtheta) + size.h[:, None], row(size.M))
        for found, D, term in zip(products, (data.dtau_dq, data.dtau_dv, upper(data.M)), terms):
            assert_close(found, ddtheta @ matrix(D), np.abs(ddtheta) @ term, LIMIT_OF_DERIVATIVES)

        if not tree.mimics:
            whole_tau = bridge.force(tau)
            assert_close(ddtheta, bridge.from_acceleration(pin.aba(model, data, q, v, whole_tau)), size.ddtheta, LIMIT_OF_BOTH)
            pin.computeABADerivatives(model, data, q, v, whole_tau)
            by = robot.forward_dynamics_derivatives(theta, dtheta, tau)[1:]
            terms = (row(d_theta) + size.tau[:, None], row(d_dtheta) + size.h[:, None], np.eye(robot.n))
            for found, expected, term in zip(by, (data.ddq_dq, data.ddq_dv, upper(data.Minv)), terms):
                assert_close(found, matrix(expected), size.inverse @ (term + size.M @ np.abs(found)), LIMIT_OF_DERIVATIVES)

        pin.ccrba(model, data, q, v)
        columns = np.array([bridge.velocity(column) for column in G.T]).T
        A = mozzi.conventions.angular_first((data.Ag @ columns).T).T
        assert_close(robot.centroidal_momentum_matrix(theta), A, world.momentum_matrix, LIMIT_OF_BOTH)
        center = robot.center_of_mass(theta)
        assert_close(center, data.com[0], 1.0 + max(np.abs(M.translation).max() for M in data.oMi), LIMIT_OF_BOTH)
        momentum = mozzi.conventions.angular_first(data.hg.vector)
        assert_close(robot.momentum(theta, dtheta, about=center), momentum, world.momentum, LIMIT_OF_BOTH)
        K = pin.computeKineticEnergy(rigid, rigid.createData(), q, v) + 0.5 * model.armature @ v**2
        assert_close(robot.kinetic_energy(theta, dtheta), K, size.kinetic, LIMIT_OF_BOTH)
