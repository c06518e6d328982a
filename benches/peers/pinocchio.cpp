// Pinocchio, from the headers of PyPI's `pin`.

#include "peer.hpp"
#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/constrained-dynamics.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>

namespace pin = pinocchio;
using Eigen::Map, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;
using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Robot {
    pin::Model model;
    pin::Data data;
    std::vector<pin::RigidConstraintModel> pins;
    std::vector<pin::RigidConstraintData> pins_data;
};

std::string version() { return "Pinocchio " PINOCCHIO_VERSION ", compiled by " __VERSION__; }
const char* const CONVENTION = "pinocchio";

namespace {

pin::SE3 placement(const double* T) {
    return {Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(T), Vector3d(T + 9)};
}

// The joint as Pinocchio's own loader would choose it: a special type where the axis is one of the frame's.
pin::JointModel joint_model(const Vector3d& axis, bool is_revolute) {
    if (is_revolute) {
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

// The state as Pinocchio's functions take it: copies of a few numbers, into memory that is there, as a controller would have it.
struct View {
    Map<const VectorXd> q, v, a, tau;
    View(const Robot& r, const State& s)
        : q(s.theta, r.model.nq), v(s.dtheta, r.model.nv), a(s.ddtheta, r.model.nv), tau(s.tau, r.model.nv) {}
};

template <typename M> double* put(const M& matrix, double* out) {
    Map<ByRows>(out, matrix.rows(), matrix.cols()) = matrix;
    return out + matrix.size();
}

void mass_matrix(Robot& r, double* out) {
    put(MatrixXd(r.data.M.selfadjointView<Eigen::Upper>()), out); // the other triangle is left as it was
}

template <pin::Convention convention> void aba(Robot& r, const State& s) {
    View x(r, s);
    keep(pin::aba(r.model, r.data, x.q, x.v, x.tau, convention).data());
}

template <pin::Convention convention> void crba(Robot& r, const State& s) {
    keep(pin::crba(r.model, r.data, View(r, s).q, convention).data());
}

void rnea(Robot& r, const State& s) {
    View x(r, s);
    keep(pin::rnea(r.model, r.data, x.q, x.v, x.a).data());
}

void non_linear_effects(Robot& r, const State& s) {
    View x(r, s);
    keep(pin::nonLinearEffects(r.model, r.data, x.q, x.v).data());
}

void coriolis(Robot& r, const State& s) {
    View x(r, s);
    keep(pin::computeCoriolisMatrix(r.model, r.data, x.q, x.v).data());
}

void rnea_derivatives(Robot& r, const State& s) {
    View x(r, s);
    pin::computeRNEADerivatives(r.model, r.data, x.q, x.v, x.a);
    keep(r.data.dtau_dq.data());
}

void aba_derivatives(Robot& r, const State& s) {
    View x(r, s);
    pin::computeABADerivatives(r.model, r.data, x.q, x.v, x.tau);
    keep(r.data.ddq_dq.data());
}

void constraint_dynamics(Robot& r, const State& s) {
    View x(r, s);
    keep(pin::constraintDynamics(r.model, r.data, x.q, x.v, x.tau, r.pins, r.pins_data).data());
}

} // namespace

std::vector<Algorithm> algorithms(const Robot& robot) {
    if (!robot.pins.empty())
        return {{"constrained_forward_dynamics", "constraintDynamics", constraint_dynamics,
                 [](Robot& r, double* out) { put(r.data.ddq, out); }}};
    return {
        {"inverse_dynamics", "rnea", rnea, [](Robot& r, double* out) { put(r.data.tau, out); }},
        {"forward_dynamics", "aba, WORLD", aba<pin::Convention::WORLD>, [](Robot& r, double* out) { put(r.data.ddq, out); }},
        {"forward_dynamics", "aba, LOCAL", aba<pin::Convention::LOCAL>, [](Robot& r, double* out) { put(r.data.ddq, out); }},
        {"mass_matrix", "crba, WORLD", crba<pin::Convention::WORLD>, mass_matrix},
        {"mass_matrix", "crba, LOCAL", crba<pin::Convention::LOCAL>, mass_matrix},
        {"coriolis_matrix", "computeCoriolisMatrix", coriolis, [](Robot& r, double* out) { put(r.data.C, out); }},
        {"bias_forces", "nonLinearEffects", non_linear_effects, [](Robot& r, double* out) { put(r.data.nle, out); }},
        {"inverse_dynamics_derivatives", "computeRNEADerivatives", rnea_derivatives,
         [](Robot& r, double* out) { mass_matrix(r, put(r.data.dtau_dv, put(r.data.dtau_dq, out))); }},
        {"forward_dynamics_derivatives", "computeABADerivatives", aba_derivatives,
         [](Robot& r, double* out) {
             out = put(r.data.ddq_dv, put(r.data.ddq_dq, out));
             put(MatrixXd(r.data.Minv.selfadjointView<Eigen::Upper>()), out);
         }},
    };
}

Robot* make_robot(const Description& description) {
    pin::Model model;
    model.gravity.linear() = Vector3d(description.gravity);
    std::vector<pin::JointIndex> joints;
    for (const auto& body : description.bodies) {
        auto name = "joint" + std::to_string(model.njoints);
        pin::JointIndex joint = 0; // the ground
        if (!joints.empty())
            joint = model.addJoint(joints[int(body.parent)], joint_model(Vector3d(body.axis), body.is_revolute != 0),
                                   placement(body.placement), name);
        else if (description.is_floating)
            joint = model.addJoint(0, pin::JointModelFreeFlyer(), pin::SE3::Identity(), name);
        joints.push_back(joint);
        model.appendBodyToJoint(joint, {body.mass, Vector3d(body.center), Matrix3d(body.inertia)}, pin::SE3::Identity());
    }
    model.armature.setZero();
    return new Robot{model, pin::Data(model), {}, {}};
}

void free_robot(Robot* robot) { delete robot; }

// Pins a point of a body (3 numbers, in the body's frame) to the place in the world where it is at some state.
extern "C" void peer_pin(Loaded* loaded, int body, const double* point, const double* place) {
    auto& r = *loaded->robot;
    pin::JointIndex joint = body + (loaded->description.is_floating ? 1 : 0);
    r.pins.emplace_back(pin::CONTACT_3D, r.model, joint, pin::SE3(Matrix3d::Identity(), Vector3d(point)), 0,
                        pin::SE3(Matrix3d::Identity(), Vector3d(place)), pin::LOCAL);
    r.pins_data.clear();
    for (const auto& pin : r.pins) r.pins_data.emplace_back(pin);
    pin::initConstraintDynamics(r.model, r.data, r.pins, r.pins_data);
    loaded->list = algorithms(r);
}
