// Both plugins against each other, against slopes, and against KDL; wrong input on purpose.
#include <inverse_dynamics_solver/exceptions.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <sstream>

#include "mozzi_ros2/inverse_dynamics_solver.hpp"
#include "mozzi_ros2/kinematics.hpp"

#ifdef HAS_KDL
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <kdl_parser/kdl_parser.hpp>
#endif

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

int failures = 0;

void expect(bool holds, const char *what, double value = 0) {
  if (!holds) {
    std::printf("FAILED: %s (%g)\n", what, value);
    ++failures;
  }
}

void near(const MatrixXd &a, const MatrixXd &b, double tolerance, const char *what) {
  const double error = (a - b).norm() / (1 + b.norm());
  std::printf("  %-52s %.1e\n", what, error);
  expect(a.rows() == b.rows() && a.cols() == b.cols() && error < tolerance, what, error);
}

/// The call fails, and its message has these words.
template <class E>
void refused(const std::function<void()> &call, const std::string &words) {
  try {
    call();
    expect(false, ("not refused: " + words).c_str());
  } catch (const E &error) {
    const bool has = std::string(error.what()).find(words) != std::string::npos;
    expect(has, (words + " is not in: " + error.what()).c_str());
  }
}

class Node : public rclcpp::node_interfaces::NodeParametersInterface {
 public:
  template <class T>
  void set(const std::string &name, T value) {
    values_[name] = rclcpp::Parameter(name, std::move(value));
  }
  bool has_parameter(const std::string &name) const override { return values_.count(name) != 0; }
  bool get_parameter(const std::string &name, rclcpp::Parameter &parameter) const override {
    parameter = values_.at(name);
    return true;
  }

 private:
  std::map<std::string, rclcpp::Parameter> values_;
};

std::string read(const std::string &path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

VectorXd random(Eigen::Index n, std::mt19937 &numbers) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return VectorXd::NullaryExpr(n, [&] { return uniform(numbers); });
}

using Names = std::vector<std::string>;

void dynamics(const std::string &urdf, const std::string &tip, const Names &locked) {
  auto node = std::make_shared<Node>();
  node->set("arm.tip", tip);
  node->set("arm.gravity", std::vector<double>{0.3, -0.2, -9.7});
  node->set("arm.locked_joints", locked);
  mozzi_ros2::InverseDynamicsSolver solver;
  refused<inverse_dynamics_solver::UninitializedException>([&] { solver.getGravityVector(VectorXd(1)); }, "not");
  solver.initialize(node, "arm", urdf);
  mozzi_ros2::Robot robot(urdf, node.get(), "arm");
  const Eigen::Index n = robot.n();
  std::mt19937 numbers(1);
  const VectorXd q = random(n, numbers), dq = random(n, numbers), ddq = random(n, numbers);
  const auto [M, c, g] = solver.getDynamicParameters(q, dq);
  near(M, M.transpose(), 1e-15, "M is symmetric");
  near(solver.getTorques(q, dq, ddq), M * ddq + c + g, 1e-13, "torques against M, C and g");
  const VectorXd still = VectorXd::Zero(n);
  near(solver.getTorques(q, still, still), g, 1e-14, "torques at rest against g");
  expect(solver.getFrictionVector(dq).allFinite(), "friction");
#ifdef HAS_KDL
  KDL::Tree tree;
  KDL::Chain chain;
  expect(kdl_parser::treeFromString(urdf, tree) && tree.getChain(tree.getRootSegment()->first, tip, chain), "KDL reads");
  if (static_cast<Eigen::Index>(chain.getNrOfJoints()) == n) {
    KDL::ChainDynParam kdl(chain, KDL::Vector(0.3, -0.2, -9.7));
    KDL::JntArray kq(chain.getNrOfJoints()), kdq = kq, kc = kq, kg = kq;
    KDL::JntSpaceInertiaMatrix kM(chain.getNrOfJoints());
    kq.data = q;
    kdq.data = dq;
    kdl.JntToMass(kq, kM);
    kdl.JntToCoriolis(kq, kdq, kc);
    kdl.JntToGravity(kq, kg);
    near(M, kM.data, 1e-12, "M against KDL");
    near(c, kc.data, 1e-12, "C q' against KDL");
    near(g, kg.data, 1e-12, "g against KDL");
  }
#endif

  // another order of the joints
  Names order = robot.joints();
  std::shuffle(order.begin(), order.end(), numbers);
  node->set("arm.joints", order);
  mozzi_ros2::InverseDynamicsSolver other;
  other.initialize(node, "arm", urdf);
  Eigen::PermutationMatrix<Eigen::Dynamic> P(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto place = std::find(order.begin(), order.end(), robot.joints()[static_cast<std::size_t>(k)]);
    P.indices()[k] = static_cast<int>(place - order.begin());
  }
  near(other.getInertiaMatrix(P * q), P * M * P.transpose(), 1e-15, "M in another order");
  near(other.getCoriolisVector(P * q, P * dq), P * c, 1e-15, "C q' in another order");
  near(other.getTorques(P * q, P * dq, P * ddq), P * (M * ddq + c + g), 1e-13, "torques in another order");

  refused<std::invalid_argument>([&] { solver.getInertiaMatrix(VectorXd(n + 1)); }, "joint_positions has");
  refused<std::exception>([&] { solver.getInertiaMatrix(VectorXd::Constant(n, NAN)); }, "theta");
  order.pop_back();
  node->set("arm.joints", order);
  using Invalid = inverse_dynamics_solver::InvalidParameterValueException;
  refused<Invalid>([&] { other.initialize(node, "arm", urdf); }, "is not in arm.joints");
  node->set("arm.joints", Names{"elbow"});
  refused<Invalid>([&] { other.initialize(node, "arm", urdf); }, "joints has `elbow`");
  node->set("arm.tip", std::string("nose"));
  refused<Invalid>([&] { other.initialize(node, "arm", urdf); }, "nose");
  node->set("arm.gravity", std::vector<double>{9.81});
  node->set("arm.tip", tip);
  refused<Invalid>([&] { other.initialize(node, "arm", urdf); }, "gravity has 1");
  refused<Invalid>([&] { other.initialize(node, "", "<robot name=\"r\"><link/></robot>"); }, "robot_description:1:");
  refused<Invalid>([&] { other.initialize(node, "", ""); }, "robot_description is not set");
}

void kinematics(const std::string &urdf, const std::string &tip, const Names &locked) {
  auto node = std::make_shared<Node>();
  node->set("tip", tip);
  node->set("locked_joints", locked);
  node->set("alpha", 0.0);
  mozzi_ros2::Kinematics plugin;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  expect(!plugin.calculate_link_transform(VectorXd::Zero(6), tip, T), "refused before `initialize`");
  expect(plugin.initialize(urdf, node, ""), "initialize");
  mozzi_ros2::Robot robot(urdf, node.get(), "");
  const Eigen::Index n = robot.n();
  std::mt19937 numbers(2);
  const VectorXd q = random(n, numbers), direction = random(n, numbers);
  Jacobian J = Jacobian::Zero(6, n);
  expect(plugin.calculate_jacobian(q, tip, J), "Jacobian");
  expect(plugin.calculate_link_transform(q, tip, T), "pose");

  // the slope of the pose, by the plugin's own difference of frames
  const auto at = [&](double h) {
    Eigen::Isometry3d there = Eigen::Isometry3d::Identity();
    expect(plugin.calculate_link_transform(q + h * direction, tip, there), "pose");
    const Eigen::Quaterniond R(there.rotation());
    Eigen::Matrix<double, 7, 1> x;
    x << there.translation(), R.x(), R.y(), R.z(), R.w();
    return x;
  };
  Eigen::Matrix<double, 7, 1> before = at(-1e-5), after = at(1e-5);
  Vector6 slope, twist;
  expect(plugin.calculate_frame_difference(before, after, 2e-5, slope), "difference");
  expect(plugin.convert_joint_deltas_to_cartesian_deltas(q, direction, tip, twist), "joint deltas");
  near(J * direction, slope, 1e-8, "Jacobian against the pose's slope");
  near(twist, J * direction, 1e-15, "joint deltas against the Jacobian");

  Eigen::Matrix<double, Eigen::Dynamic, 6> inverse = MatrixXd::Zero(n, 6);
  VectorXd delta = VectorXd::Zero(n);
  expect(plugin.calculate_jacobian_inverse(q, tip, inverse), "inverse");
  near(J * inverse, MatrixXd::Identity(6, 6), 1e-10, "J J+ is the identity");
  expect(plugin.convert_cartesian_deltas_to_joint_deltas(q, twist, tip, delta), "Cartesian deltas");
  near(J * delta, twist, 1e-10, "Cartesian deltas are reached");
#ifdef HAS_KDL
  KDL::Tree tree;
  KDL::Chain chain;
  expect(kdl_parser::treeFromString(urdf, tree) && tree.getChain(tree.getRootSegment()->first, tip, chain), "KDL reads");
  if (static_cast<Eigen::Index>(chain.getNrOfJoints()) == n) {
    KDL::JntArray kq(chain.getNrOfJoints());
    kq.data = q;
    KDL::Jacobian kJ(chain.getNrOfJoints());
    KDL::ChainJntToJacSolver(chain).JntToJac(kq, kJ);
    near(J, kJ.data, 1e-12, "Jacobian against KDL");
    KDL::Frame kT;
    KDL::ChainFkSolverPos_recursive(chain).JntToCart(kq, kT);
    MatrixXd expected(3, 4);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 4; ++j) {
        expected(i, j) = kT(i, j);
      }
    }
    near(T.matrix().topRows(3), expected, 1e-12, "pose against KDL");
  }
#endif

  expect(!plugin.calculate_jacobian(q, "nose", J), "an unknown link is refused");
  expect(!plugin.calculate_jacobian(VectorXd::Zero(n + 1), tip, J), "a long vector is refused");
  Jacobian narrow = Jacobian::Zero(6, n - 1);
  expect(!plugin.calculate_jacobian(q, tip, narrow), "a narrow Jacobian is refused");
  expect(!plugin.calculate_frame_difference(before, after, 0, slope), "dt = 0 is refused");
  before[6] += 1;
  expect(!plugin.calculate_frame_difference(before, after, 1, slope), "a quaternion of another length is refused");
  expect(!plugin.initialize("<robot", node, ""), "a broken URDF is refused");
}

}  // namespace

int main(int, char **arguments) {
  const std::string models = arguments[1];
  std::printf("UR5\n");
  dynamics(read(models + "/ur5.urdf"), "tool0", {});
  kinematics(read(models + "/ur5.urdf"), "tool0", {});
  std::printf("Panda\n");
  dynamics(read(models + "/panda.urdf"), "panda_hand", {});
  kinematics(read(models + "/panda.urdf"), "panda_hand", {});
  std::printf(failures == 0 ? "all passed\n" : "%d failed\n", failures);
  return failures == 0 ? 0 : 1;
}
