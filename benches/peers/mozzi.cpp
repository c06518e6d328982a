// mozzi from C++: mozzi.hpp with Eigen's arguments, through the C interface of the shared library. With -DCOMPILED by
// machine code; with -DPLAIN the functions of mozzi.h on pointers, as C calls them.

#include "peer.hpp"
#include <mozzi/mozzi.hpp>

#include <Eigen/Core>

using Eigen::Map, Eigen::MatrixXd, Eigen::VectorXd;
using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Robot {
    mozzi::Model model;
    mozzi::Workspace workspace;
    int nq, n;
    VectorXd tau, ddtheta, h;
    MatrixXd M, C, A, B, D;
};

std::string version() { return std::string("mozzi ") + mozzi_version() + " from C++, compiled by " __VERSION__; }
const char* const CONVENTION = "mozzi";

namespace {

struct View {
    Map<const VectorXd> theta, dtheta, ddtheta, tau;
    View(const Robot& r, const State& s)
        : theta(s.theta, r.nq), dtheta(s.dtheta, r.n), ddtheta(s.ddtheta, r.n), tau(s.tau, r.n) {}
};

template <typename M> double* put(const M& matrix, double* out) {
    Map<ByRows>(out, matrix.rows(), matrix.cols()) = matrix;
    return out + matrix.size();
}

void done(bool is_ok, const void* result) {
    if (!is_ok) std::abort();
    keep(result);
}
void done(const mozzi::Status& status, const void* result) { done(status.ok(), result); }
void done(mozzi_status status, const void* result) { done(status == MOZZI_OK, result); }

} // namespace

#ifdef PLAIN
namespace {

// Column by column, as Eigen has it.
mozzi_matrix matrix(MatrixXd& m) { return {m.data(), 1, m.rows()}; }

} // namespace

std::vector<Algorithm> algorithms(const Robot&) {
    return {
        {"inverse_dynamics", "mozzi_inverse_dynamics",
         [](Robot& r, const State& s) {
             const auto m = r.model.get();
             const auto w = r.workspace.get();
             done(mozzi_inverse_dynamics(m, w, s.theta, s.dtheta, s.ddtheta, nullptr, r.tau.data()), r.tau.data());
         },
         [](Robot& r, double* out) { put(r.tau, out); }},
        {"forward_dynamics", "mozzi_forward_dynamics",
         [](Robot& r, const State& s) {
             const auto m = r.model.get();
             const auto w = r.workspace.get();
             done(mozzi_forward_dynamics(m, w, s.theta, s.dtheta, s.tau, nullptr, r.ddtheta.data()), r.ddtheta.data());
         },
         [](Robot& r, double* out) { put(r.ddtheta, out); }},
        {"mass_matrix", "mozzi_mass_matrix",
         [](Robot& r, const State& s) {
             done(mozzi_mass_matrix(r.model.get(), r.workspace.get(), s.theta, matrix(r.M)), r.M.data());
         },
         [](Robot& r, double* out) { put(r.M, out); }},
        {"bias_forces", "mozzi_bias_forces",
         [](Robot& r, const State& s) {
             const auto m = r.model.get();
             const auto w = r.workspace.get();
             done(mozzi_bias_forces(m, w, s.theta, s.dtheta, nullptr, r.h.data()), r.h.data());
         },
         [](Robot& r, double* out) { put(r.h, out); }},
    };
}
#else
std::vector<Algorithm> algorithms(const Robot&) {
    return {
        {"inverse_dynamics", "inverse_dynamics",
         [](Robot& r, const State& s) {
             View x(r, s);
             done(r.workspace.inverse_dynamics(x.theta, x.dtheta, x.ddtheta, r.tau), r.tau.data());
         },
         [](Robot& r, double* out) { put(r.tau, out); }},
        {"forward_dynamics", "forward_dynamics",
         [](Robot& r, const State& s) {
             View x(r, s);
             done(r.workspace.forward_dynamics(x.theta, x.dtheta, x.tau, r.ddtheta), r.ddtheta.data());
         },
         [](Robot& r, double* out) { put(r.ddtheta, out); }},
        {"mass_matrix", "mass_matrix",
         [](Robot& r, const State& s) { done(r.workspace.mass_matrix(View(r, s).theta, r.M), r.M.data()); },
         [](Robot& r, double* out) { put(r.M, out); }},
        {"coriolis_matrix", "coriolis_matrix",
         [](Robot& r, const State& s) {
             View x(r, s);
             done(r.workspace.coriolis_matrix(x.theta, x.dtheta, r.C), r.C.data());
         },
         [](Robot& r, double* out) { put(r.C, out); }},
        {"bias_forces", "bias_forces",
         [](Robot& r, const State& s) {
             View x(r, s);
             done(r.workspace.bias_forces(x.theta, x.dtheta, r.h), r.h.data());
         },
         [](Robot& r, double* out) { put(r.h, out); }},
        {"inverse_dynamics_derivatives", "inverse_dynamics_derivatives",
         [](Robot& r, const State& s) {
             View x(r, s);
             done(r.workspace.inverse_dynamics_derivatives(x.theta, x.dtheta, x.ddtheta, r.A, r.B, r.D), r.A.data());
         },
         [](Robot& r, double* out) { put(r.D, put(r.B, put(r.A, out))); }},
        {"forward_dynamics_derivatives", "forward_dynamics_derivatives",
         [](Robot& r, const State& s) {
             View x(r, s);
             done(r.workspace.forward_dynamics_derivatives(x.theta, x.dtheta, x.tau, r.ddtheta, r.A, r.B, r.D), r.A.data());
         },
         [](Robot& r, double* out) { put(r.D, put(r.B, put(r.A, out))); }},
    };
}

#endif

Robot* make_robot(const Description& description) {
    auto read = mozzi::Model::parse("robot.urdf", description.urdf);
    if (!read) return nullptr;
    const auto g = description.gravity;
    auto model = read->with_gravity({g[0], g[1], g[2]}).value().with_base(description.is_floating).value();
    const int n = int(model.n()), nq = int(model.nq());
#ifdef COMPILED
    const auto program = mozzi::Program::compile(
        model, {MOZZI_INVERSE_DYNAMICS, MOZZI_FORWARD_DYNAMICS, MOZZI_MASS_MATRIX, MOZZI_CORIOLIS_MATRIX, MOZZI_BIAS_FORCES,
                MOZZI_INVERSE_DYNAMICS_DERIVATIVES, MOZZI_FORWARD_DYNAMICS_DERIVATIVES}).value();
    mozzi::Workspace workspace(program);
#else
    mozzi::Workspace workspace(model);
#endif
    const VectorXd v = VectorXd::Zero(n);
    const MatrixXd m = MatrixXd::Zero(n, n);
    return new Robot{model, std::move(workspace), nq, n, v, v, v, m, m, m, m, m};
}

void free_robot(Robot* robot) { delete robot; }

// Constraints are in no benchmark from C++.
extern "C" void peer_pin(Loaded* loaded, int, const double*, const double*) { loaded->list.clear(); }
