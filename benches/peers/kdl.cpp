// Orocos KDL, from Debian's liborocos-kdl-dev: fixed chains.

#include "peer.hpp"
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfdsolver_recursive_newton_euler.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <kdl/config.h>

struct Robot {
    KDL::Chain chain;
    unsigned n;
    KDL::ChainIdSolver_RNE inverse;
    KDL::ChainFdSolver_RNE forward;
    KDL::ChainDynParam parameters;
    KDL::Wrenches none;
    KDL::JntArray theta, dtheta, x, result;
    KDL::JntSpaceInertiaMatrix M;

    Robot(const KDL::Chain& c, const KDL::Vector& g)
        : chain(c), n(c.getNrOfJoints()), inverse(chain, g), forward(chain, g), parameters(chain, g),
          none(c.getNrOfSegments(), KDL::Wrench::Zero()), theta(n), dtheta(n), x(n), result(n), M(n) {}
};

std::string version() { return "KDL " KDL_VERSION_STRING ", as Debian compiled it; fixed chains alone"; }
const char* const CONVENTION = "mozzi";

namespace {

void set(KDL::JntArray& to, const double* from) { std::copy(from, from + to.rows(), to.data.data()); }

void inverse_dynamics(Robot& r, const State& s) {
    set(r.theta, s.theta);
    set(r.dtheta, s.dtheta);
    set(r.x, s.ddtheta);
    r.inverse.CartToJnt(r.theta, r.dtheta, r.x, r.none, r.result);
    keep(r.result.data.data());
}

void forward_dynamics(Robot& r, const State& s) {
    set(r.theta, s.theta);
    set(r.dtheta, s.dtheta);
    set(r.x, s.tau);
    r.forward.CartToJnt(r.theta, r.dtheta, r.x, r.none, r.result);
    keep(r.result.data.data());
}

void bias_forces(Robot& r, const State& s) {
    set(r.theta, s.theta);
    set(r.dtheta, s.dtheta);
    r.x.data.setZero();
    r.inverse.CartToJnt(r.theta, r.dtheta, r.x, r.none, r.result);
    keep(r.result.data.data());
}

void mass_matrix(Robot& r, const State& s) {
    set(r.theta, s.theta);
    r.parameters.JntToMass(r.theta, r.M);
    keep(r.M.data.data());
}

void put_vector(Robot& r, double* out) { std::copy_n(r.result.data.data(), r.n, out); }

KDL::Segment segment(const Body& body) {
    auto T = body.placement;
    KDL::Frame frame(KDL::Rotation(T[0], T[1], T[2], T[3], T[4], T[5], T[6], T[7], T[8]), KDL::Vector(T[9], T[10], T[11]));
    auto axis = frame.M * KDL::Vector(body.axis[0], body.axis[1], body.axis[2]);
    KDL::Joint joint(frame.p, axis, body.is_revolute != 0 ? KDL::Joint::RotAxis : KDL::Joint::TransAxis);
    auto c = body.center, I = body.inertia;
    KDL::RotationalInertia moments(I[0], I[4], I[8], I[1], I[2], I[5]);
    return KDL::Segment(joint, frame, KDL::RigidBodyInertia(body.mass, KDL::Vector(c[0], c[1], c[2]), moments));
}

} // namespace

std::vector<Algorithm> algorithms(const Robot&) {
    return {
        {"inverse_dynamics", "ChainIdSolver_RNE", inverse_dynamics, put_vector},
        {"forward_dynamics", "ChainFdSolver_RNE", forward_dynamics, put_vector},
        {"mass_matrix", "JntToMass", mass_matrix, [](Robot& r, double* out) { std::copy_n(r.M.data.data(), r.n * r.n, out); }},
        {"bias_forces", "ChainIdSolver_RNE, no acceleration", bias_forces, put_vector},
    };
}

Robot* make_robot(const Description& description) {
    KDL::Chain chain;
    for (int i = 1; i < int(description.bodies.size()); ++i) {
        if (description.is_floating || description.bodies[i].parent != i - 1) return nullptr; // no chain
        chain.addSegment(segment(description.bodies[i]));
    }
    auto g = description.gravity;
    return new Robot(chain, KDL::Vector(g[0], g[1], g[2]));
}

void free_robot(Robot* robot) { delete robot; }
