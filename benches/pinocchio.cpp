// Pinocchio behind a small C interface, for benches/src/peer.rs: a robot is given by numbers, so that no loader is
// timed; the states are stored once, and one call runs one algorithm over all of them.

#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <vector>

namespace pin = pinocchio;
using Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

namespace {

struct State {
    VectorXd q, v, a, tau;
};

struct Robot {
    pin::Model model;
    pin::Data data;
    std::vector<State> states;
};

// Twelve numbers: the rotation by rows, then the translation.
pin::SE3 placement(const double* T) {
    return {Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(T), Vector3d(T + 9)};
}

// The joint as Pinocchio's own loader would choose it: a special type where the axis is one of the frame's.
pin::JointModel joint_model(const Vector3d& axis, bool revolute) {
    if (revolute) {
        if (axis == Vector3d::UnitX()) return pin::JointModelRX();
        if (axis == Vector3d::UnitY()) return pin::JointModelRY();
        if (axis == Vector3d::UnitZ()) return pin::JointModelRZ();
        return pin::JointModelRevoluteUnaligned(axis);
    }
    if (axis == Vector3d::UnitX()) return pin::JointModelPX();
    if (axis == Vector3d::UnitY()) return pin::JointModelPY();
    if (axis == Vector3d::UnitZ()) return pin::JointModelPZ();
    return pin::JointModelPrismaticUnaligned(axis);
}

// The order of `Algorithm` in peer.rs.
enum Algorithm { Rnea, AbaWorld, AbaLocal, CrbaWorld, CrbaLocal, Coriolis, NonLinearEffects, RneaDerivatives, AbaDerivatives };

// One evaluation; returns where its result is: a vector, or a matrix by columns.
const double* evaluate(Robot& r, Algorithm algorithm, const State& s) {
    switch (algorithm) {
    case Rnea: return pin::rnea(r.model, r.data, s.q, s.v, s.a).data();
    case AbaWorld: return pin::aba(r.model, r.data, s.q, s.v, s.tau, pin::Convention::WORLD).data();
    case AbaLocal: return pin::aba(r.model, r.data, s.q, s.v, s.tau, pin::Convention::LOCAL).data();
    case CrbaWorld: return pin::crba(r.model, r.data, s.q, pin::Convention::WORLD).data();
    case CrbaLocal: return pin::crba(r.model, r.data, s.q, pin::Convention::LOCAL).data();
    case Coriolis: return pin::computeCoriolisMatrix(r.model, r.data, s.q, s.v).data();
    case NonLinearEffects: return pin::nonLinearEffects(r.model, r.data, s.q, s.v).data();
    case RneaDerivatives:
        pin::computeRNEADerivatives(r.model, r.data, s.q, s.v, s.a);
        return r.data.dtau_dq.data();
    case AbaDerivatives:
        pin::computeABADerivatives(r.model, r.data, s.q, s.v, s.tau);
        return r.data.ddq_dq.data();
    }
    return nullptr;
}

// The matrices that the derivatives of one algorithm are, each by columns; none of the others.
std::vector<MatrixXd> matrices(const pin::Data& data, Algorithm algorithm) {
    MatrixXd M = data.M.selfadjointView<Eigen::Upper>();
    MatrixXd M_inverse = data.Minv.selfadjointView<Eigen::Upper>();
    if (algorithm == RneaDerivatives) return {data.dtau_dq, data.dtau_dv, M};
    if (algorithm == AbaDerivatives) return {data.ddq_dq, data.ddq_dv, M_inverse};
    return {};
}

} // namespace

#define STRING_(x) #x
#define STRING(x) STRING_(x)

extern "C" {

const char* peer_version() {
    return "Pinocchio " PINOCCHIO_VERSION ", " __VERSION__;
}

const char* peer_flags() {
    return STRING(PEER_FLAGS);
}

Robot* peer_robot(const double* gravity, int floating) {
    auto robot = new Robot;
    if (floating) robot->model.addJoint(0, pin::JointModelFreeFlyer(), pin::SE3::Identity(), "base");
    robot->model.gravity.linear() = Vector3d(gravity);
    return robot;
}

void peer_robot_free(Robot* robot) {
    delete robot;
}

// Joints come depth first; joint 0 is the base, or where it is free, joint 1. Returns the new joint's number.
int peer_joint(Robot* robot, int parent, const double* T, const double* axis, int revolute) {
    auto& model = robot->model;
    auto name = "joint" + std::to_string(model.njoints);
    return int(model.addJoint(parent, joint_model(Vector3d(axis), revolute), placement(T), name));
}

// A body fixed to a joint: its frame, mass, mass centre, and inertia about the mass centre by rows.
void peer_body(Robot* robot, int joint, const double* T, double mass, const double* c, const double* I) {
    robot->model.appendBodyToJoint(joint, {mass, Vector3d(c), Matrix3d(I)}, placement(T));
}

// Ends the description: `count` states, each θ, θ̇, θ̈, τ.
void peer_states(Robot* robot, const double* x, int count) {
    auto nq = robot->model.nq, n = robot->model.nv;
    robot->model.armature.setZero();
    robot->data = pin::Data(robot->model);
    auto next = [&](auto length) {
        VectorXd part = Eigen::Map<const VectorXd>(x, length);
        x += length;
        return part;
    };
    for (int k = 0; k < count; ++k) robot->states.push_back({next(nq), next(n), next(n), next(n)});
}

// All states, one after the other.
void peer_run(Robot* robot, int algorithm) {
    for (const auto& state : robot->states) {
        auto result = evaluate(*robot, Algorithm(algorithm), state);
        asm volatile("" ::"r"(result) : "memory");
    }
}

// The result at one state.
void peer_result(Robot* robot, int algorithm, int state, double* out, int length) {
    auto result = evaluate(*robot, Algorithm(algorithm), robot->states[state]);
    auto derivatives = matrices(robot->data, Algorithm(algorithm));
    if (derivatives.empty()) std::copy(result, result + length, out);
    for (const auto& matrix : derivatives) out = std::copy(matrix.data(), matrix.data() + matrix.size(), out);
}
}
