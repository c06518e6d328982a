// MuJoCo, from the library and the headers of PyPI's `mujoco`. Contacts, constraints and passive forces are off; beside the function that
// users call, `mj_inverse` or `mj_forward`, stands the smooth part alone.

#include "peer.hpp"
#include <cstdio>
#include <cstring>
#include <mujoco/mujoco.h>

struct Robot {
    mjModel* m;
    mjData* d;
    std::vector<double> vector, matrix; // results that MuJoCo hands out
};

std::string version() { return std::string("MuJoCo ") + mj_versionString() + ", the library of its wheel; its derivatives are differences, and left out"; }
const char* const CONVENTION = "mujoco";

namespace {

void set(double* to, const double* from, int length) { std::memcpy(to, from, length * sizeof(double)); }

void put(const double* from, int length, double* out) { set(out, from, length); }

void position(Robot& r, const State& s) {
    set(r.d->qpos, s.theta, r.m->nq);
    mj_kinematics(r.m, r.d);
    mj_comPos(r.m, r.d);
}

void velocity(Robot& r, const State& s) {
    set(r.d->qvel, s.dtheta, r.m->nv);
    mj_comVel(r.m, r.d);
}

void inverse(Robot& r, const State& s) {
    set(r.d->qpos, s.theta, r.m->nq);
    set(r.d->qvel, s.dtheta, r.m->nv);
    set(r.d->qacc, s.ddtheta, r.m->nv);
    mj_inverse(r.m, r.d);
    keep(r.d->qfrc_inverse);
}

void rne(Robot& r, const State& s) {
    position(r, s);
    velocity(r, s);
    set(r.d->qacc, s.ddtheta, r.m->nv);
    mj_rne(r.m, r.d, 1, r.vector.data());
    keep(r.vector.data());
}

void forward(Robot& r, const State& s) {
    set(r.d->qpos, s.theta, r.m->nq);
    set(r.d->qvel, s.dtheta, r.m->nv);
    set(r.d->qfrc_applied, s.tau, r.m->nv);
    mj_forward(r.m, r.d);
    keep(r.d->qacc);
}

void bias(Robot& r, const State& s) {
    position(r, s);
    velocity(r, s);
    mj_rne(r.m, r.d, 0, r.vector.data());
    keep(r.vector.data());
}

void smooth_forward(Robot& r, const State& s) {
    bias(r, s);
    mj_makeM(r.m, r.d);
    mj_factorM(r.m, r.d);
    for (int i = 0; i < r.m->nv; ++i) r.vector[i] = s.tau[i] - r.vector[i];
    mj_solveM(r.m, r.d, r.vector.data(), r.vector.data(), 1);
    keep(r.vector.data());
}

void mass_matrix(Robot& r, const State& s) {
    position(r, s);
    mj_makeM(r.m, r.d);
    mj_fullM(r.m, r.d, r.matrix.data());
    keep(r.matrix.data());
}

void put_vector(Robot& r, double* out) { put(r.vector.data(), r.m->nv, out); }

mjSpec* spec(const Description& description) {
    auto spec = mj_makeSpec();
    set(spec->option.gravity, description.gravity, 3);
    spec->option.disableflags |= mjDSBL_CONTACT | mjDSBL_CONSTRAINT | mjDSBL_SPRING | mjDSBL_DAMPER | mjDSBL_ACTUATION | mjDSBL_SENSOR;
    std::vector<mjsBody*> bodies;
    for (const auto& body : description.bodies) {
        bool is_base = bodies.empty();
        auto world = mjs_findBody(spec, "world");
        if (is_base && !description.is_floating) {
            bodies.push_back(world);
            continue;
        }
        auto b = mjs_addBody(is_base ? world : bodies[int(body.parent)], nullptr);
        auto joint = mjs_addJoint(b, nullptr);
        joint->type = is_base ? mjJNT_FREE : body.is_revolute != 0 ? mjJNT_HINGE : mjJNT_SLIDE;
        if (!is_base) {
            mju_mat2Quat(b->quat, body.placement);
            set(b->pos, body.placement + 9, 3);
            set(joint->axis, body.axis, 3);
        }
        auto I = body.inertia;
        double full[6] = {I[0], I[4], I[8], I[1], I[2], I[5]};
        b->mass = body.mass;
        b->explicitinertial = 1;
        set(b->ipos, body.center, 3);
        set(b->fullinertia, full, 6);
        bodies.push_back(b);
    }
    return spec;
}

} // namespace

std::vector<Algorithm> algorithms(const Robot&) {
    return {
        {"inverse_dynamics", "mj_inverse", inverse, [](Robot& r, double* out) { put(r.d->qfrc_inverse, r.m->nv, out); }},
        {"inverse_dynamics", "mj_rne", rne, put_vector},
        {"forward_dynamics", "mj_forward", forward, [](Robot& r, double* out) { put(r.d->qacc, r.m->nv, out); }},
        {"forward_dynamics", "mj_solveM", smooth_forward, put_vector},
        {"mass_matrix", "mj_fullM", mass_matrix, [](Robot& r, double* out) { put(r.matrix.data(), r.m->nv * r.m->nv, out); }},
        {"bias_forces", "mj_rne", bias, put_vector},
    };
}

Robot* make_robot(const Description& description) {
    auto robot_spec = spec(description);
    auto m = mj_compile(robot_spec, nullptr);
    if (!m) std::fprintf(stderr, "MuJoCo, %s: %s\n", description.name.c_str(), mjs_getError(robot_spec));
    mj_deleteSpec(robot_spec);
    if (!m) return nullptr;
    return new Robot{m, mj_makeData(m), std::vector<double>(m->nv), std::vector<double>(m->nv * m->nv)};
}

void free_robot(Robot* r) {
    mj_deleteData(r->d);
    mj_deleteModel(r->m);
    delete r;
}
