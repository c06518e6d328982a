// Every quantity by its method, with containers and with Eigen's types, against the library itself; and what the types
// of arguments accept.
#include "mozzi/mozzi.hpp"

extern "C" {
#include "state.h"
}

#include <memory>

#ifdef WITH_EIGEN
#include <Eigen/Core>
#endif
#if __cplusplus >= 202002L
#include <span>
#endif

#include "methods.inc"

namespace {

using Numbers = std::vector<double>;

template <class V, class M>
struct Call {
  mozzi::Workspace &workspace;
  mozzi::Frame frame;
  const mozzi::Task &task;
  const mozzi::Point &about;
  const mozzi::Environment &environment;
  V in[4];
  double number[4];
  V vector[4];
  M matrix[4];
  Numbers tensor[4];
};

void resize(Numbers &x, std::size_t rows, std::size_t columns) { x.assign(rows * columns, -1e300); }
double at(const Numbers &x, std::size_t row, std::size_t column, std::size_t columns) {
  return x[row * columns + column];
}
#ifdef WITH_EIGEN
template <class T>
void resize(Eigen::PlainObjectBase<T> &x, std::size_t rows, std::size_t columns) {
  x.setConstant(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns), -1e300);
}
template <class T>
double at(const Eigen::PlainObjectBase<T> &x, std::size_t row, std::size_t column, std::size_t) {
  return x(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
}
#endif

template <class V, class M>
void all(const robot &robot, mozzi::Workspace &workspace) {
  const mozzi::Frame frame = workspace.model().frame(mozzi_model_frame_name(robot.model, MOZZI_FRAME_NUMBER(robot.frame))).value();
  const mozzi::Task task = robot.task.row_count == 1
                               ? mozzi::Task(frame, mozzi::Coordinates::space, {robot.rows[0]})
                               : mozzi::Task(frame, mozzi::Coordinates::space, {robot.rows[0], robot.rows[1], robot.rows[2]});
  CHECK(task.rows() == robot.task.row_count);
  const mozzi::Point about(robot.about[0], robot.about[1], robot.about[2]);
  mozzi::Environment environment = workspace.model().environment();
  std::copy(robot.environment.gravity, robot.environment.gravity + 3, environment.gravity);
  std::copy(robot.environment.base_twist, robot.environment.base_twist + 6, environment.base_twist);
  std::copy(robot.environment.base_acceleration, robot.environment.base_acceleration + 6, environment.base_acceleration);
  environment.apply(frame, {1, 2, 3, 4, 5, 6});
  std::array<double, 6> F;
  std::copy(robot.wrench.F, robot.wrench.F + 6, F.begin());
  environment.apply(frame, F);  // replaces the first
  const mozzi::Environment copy = environment;
  environment = workspace.model().environment();
  for (std::size_t q = 0; q < robot.count; ++q) {
    const arguments &a = robot.quantities[q];
    Call<V, M> call{workspace, frame, task, about, copy, {}, {}, {}, {}, {}};
    for (std::size_t k = 0; k < a.input_count; ++k) {
      resize(call.in[k], a.in_length[k], 1);
      std::copy(a.in[k], a.in[k] + a.in_length[k], call.in[k].data());
    }
    for (std::size_t k = 0; k < a.output_count; ++k) {
      resize(call.vector[k], a.out_length[k], 1);
      resize(call.matrix[k], a.sizes[k][0], a.sizes[k][1]);
      resize(call.tensor[k], a.out_length[k], 1);
    }
    method(a.quantity, call).or_throw();
    for (std::size_t k = 0; k < a.output_count; ++k) {
      Numbers found(a.out_length[k]);
      for (std::size_t i = 0; i < found.size(); ++i) {
        const std::size_t columns = a.sizes[k][1];
        found[i] = a.axes[k] == 0   ? call.number[k]
                   : a.axes[k] == 1 ? call.vector[k][static_cast<int>(i)]
                   : a.axes[k] == 2 ? at(call.matrix[k], i / columns, i % columns, columns)
                                    : call.tensor[k][i];
      }
      CHECK(difference(found.data(), a.expected[k], found.size()) < 1e-10);
    }
  }
}

// what may be an argument
void accepted(const robot &robot, mozzi::Workspace &workspace) {
  const std::size_t n = workspace.model().n(), nq = workspace.model().nq();
  const arguments &a = robot.quantities[MOZZI_MASS_MATRIX];
  const double *theta = a.in[0];
  const Numbers list(theta, theta + nq);
  Numbers M(n * n), g(n), expected(a.expected[0], a.expected[0] + n * n);
  double *const pointer = M.data();
  CHECK(workspace.mass_matrix(theta, pointer).ok() && M == M);
  CHECK(difference(M.data(), expected.data(), n * n) < 1e-10);
  CHECK(workspace.mass_matrix(mozzi::Input(theta, nq), mozzi::Matrix(M.data(), n, n, 1, static_cast<std::ptrdiff_t>(n))).ok());
  CHECK(difference(M.data(), expected.data(), n * n) < 1e-10);
#if __cplusplus >= 202002L
  CHECK(workspace.mass_matrix(std::span<const double>(list), std::span<double>(M)).ok());
  CHECK(workspace.gravity_forces(std::span<const double>(list), std::span<double>(g)).ok());
#endif
  // wrong lengths
  CHECK(workspace.mass_matrix(mozzi::Input(theta, nq - 1), M).code() == MOZZI_WRONG_LENGTH);
  CHECK(std::string(mozzi_last_error()).find("theta has ") == 0);
  Numbers small(n * n - 1);
  CHECK(workspace.mass_matrix(list, small).code() == MOZZI_WRONG_LENGTH);
  CHECK(std::string(mozzi_last_error()).find("M has ") == 0);
  CHECK(workspace.gravity_forces(list, small).code() == (n * n - 1 == n ? MOZZI_OK : MOZZI_WRONG_LENGTH));
  static_assert(noexcept(workspace.gravity_forces(list, g)), "calls do not throw");
  static_assert(noexcept(workspace.mass_matrix(theta, pointer)), "calls do not throw");
  if (nq == 2) {
    const double two[2] = {theta[0], theta[1]};
    const std::array<double, 2> array{{theta[0], theta[1]}};
    double tau[2], three[3];
    CHECK(workspace.gravity_forces(two, tau).ok());
    CHECK(workspace.gravity_forces(array, tau).ok());
    CHECK(workspace.gravity_forces(two, three).code() == MOZZI_WRONG_LENGTH);
  }
#ifdef WITH_EIGEN
  using Eigen::Index;
  const Index N = static_cast<Index>(n), NQ = static_cast<Index>(nq);
  const Eigen::Map<const Eigen::VectorXd> map(theta, NQ);
  Eigen::MatrixXd big = Eigen::MatrixXd::Constant(N + 3, N + 3, 7.0);
  const auto same = [&](const auto &found) {
    for (Index i = 0; i < N; ++i) {
      for (Index j = 0; j < N; ++j) {
        CHECK(std::fabs(found(i, j) - expected[static_cast<std::size_t>(i * N + j)]) < 1e-9);
      }
    }
  };
  CHECK(workspace.mass_matrix(map, big.block(1, 2, N, N)).ok());  // a block, by columns
  same(big.block(1, 2, N, N));
  CHECK(big.row(0).isConstant(7.0) && big.col(0).isConstant(7.0) && big.row(N + 1).isConstant(7.0));
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows(N + 1, N + 2);
  rows.setConstant(7.0);
  CHECK(workspace.mass_matrix(map, rows.topRightCorner(N, N)).ok());  // a block, by rows
  same(rows.topRightCorner(N, N));
  CHECK(rows.row(N).isConstant(7.0) && rows.col(0).isConstant(7.0));
  CHECK(workspace.mass_matrix(map, big.transpose().block(0, 0, N, N)).ok());
  same(big.transpose().block(0, 0, N, N));
  Eigen::VectorXd twice(2 * N);
  CHECK(workspace.gravity_forces(map, twice.tail(N)).ok());
  Eigen::Ref<Eigen::VectorXd> ref(twice.head(N));
  CHECK(workspace.gravity_forces(map, ref).ok());
  CHECK(twice.head(N).isApprox(twice.tail(N), 1e-15) || twice.isZero());
  CHECK(workspace.gravity_forces(map, twice).code() == MOZZI_WRONG_LENGTH);
  CHECK(workspace.mass_matrix(map, big).code() == MOZZI_WRONG_LENGTH);
  if (n > 1) {
    // a row of a matrix by columns has gaps
    CHECK(workspace.gravity_forces(map, big.row(0).head(N)).code() == MOZZI_WRONG_LENGTH);
    CHECK(workspace.gravity_forces(map, rows.row(0).head(N)).ok());
  }
  if (n == 2) {
    const Eigen::Vector2d fixed(theta[0], theta[1]);
    Eigen::Matrix2d fixed_M;
    Eigen::Vector2d tau;
    CHECK(workspace.mass_matrix(fixed, fixed_M).ok());
    same(fixed_M);
    CHECK(workspace.gravity_forces(fixed, tau).ok());
    CHECK(tau.isApprox(twice.head(N), 1e-15));
  }
#endif
}

}  // namespace

int main(int count, char **arguments) {
  CHECK(count == 2);
  const std::unique_ptr<FILE, int (*)(FILE *)> file(std::fopen(arguments[1], "r"), std::fclose);
  CHECK(file != nullptr);
  robot robot{};
  while (next_robot(file.get(), &robot) != 0) {

    mozzi::Model own = mozzi::Model::from(robot.model);
    mozzi::Workspace workspace(own);
    all<Numbers, Numbers>(robot, workspace);
#ifdef WITH_EIGEN
    all<Eigen::VectorXd, Eigen::MatrixXd>(robot, workspace);
    all<Eigen::VectorXd, Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(robot, workspace);
#endif
    accepted(robot, workspace);
    free_robot(&robot);
  }
  return 0;
}
