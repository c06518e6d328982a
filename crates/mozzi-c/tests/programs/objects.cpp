// The classes of mozzi.hpp: results and exceptions, models, programs, batches, simulations, inverse kinematics.
#include "mozzi/mozzi.hpp"

extern "C" {
#include "check.h"
}

#include <algorithm>
#include <functional>

namespace {

using Numbers = std::vector<double>;

#if MOZZI_HAS_EXCEPTIONS
mozzi_status thrown(const std::function<void()> &call) {
  try {
    call();
  } catch (const mozzi::Exception &error) {
    CHECK(std::string(error.what()).size() > 5);
    return error.code();
  }
  return MOZZI_OK;
}
#endif

void results() {
  const mozzi::Result<mozzi::Model> none = mozzi::Model::open("no such robot");
  CHECK(!none && none.status().code() == MOZZI_NOT_FOUND && none.message().find("no such robot") != std::string::npos);
  mozzi::Result<mozzi::Model> found = mozzi::Model::open("ur5");
  CHECK(found && found.ok() && found.status().ok() && found->n() == 6 && (*found).nq() == 6);
  const mozzi::Result<mozzi::Model> same = mozzi::Model::open("ur5");
  CHECK(same->n() == 6 && (*same).nq() == 6);
  const mozzi::Model model = std::move(found).value();
  CHECK(model.name() == "ur5" || !model.name().empty());
  mozzi::Workspace workspace(model);
  Numbers theta(6), tau(6);
  theta[2] = NAN;
  const mozzi::Status status = workspace.gravity_forces(theta, tau);
  CHECK(!status.ok() && status.code() == MOZZI_NOT_FINITE);
  CHECK(std::string(status.message()) == "theta[2] is NaN, expected a finite number");
  CHECK(std::string(status.text()).find("NaN") != std::string::npos);
#if MOZZI_HAS_EXCEPTIONS
  CHECK(thrown([&] { status.or_throw(); }) == MOZZI_NOT_FINITE);
  CHECK(thrown([&] { (void)none.value(); }) == MOZZI_NOT_FOUND);
  CHECK(thrown([&] { mozzi::Workspace again(model); }) == MOZZI_OK);
#endif
  std::vector<mozzi::Diagnostic> findings;
  CHECK(!mozzi::Model::parse("arm.urdf", "<robot name='arm'><lnk/></robot>", {}, &findings));
  CHECK(!findings.empty() && findings[0].is_error && findings[0].line == 1 && findings[0].file == "arm.urdf");
  CHECK(!mozzi::Model::load("/no/such/file.urdf"));
  mozzi::LoadOptions options;
  options.floating = true;
  CHECK(mozzi::Model::open("ur5", options).value().is_floating());
}

void models() {
  const mozzi::Model model = mozzi::Model::embedded("ur5").value();
  mozzi::Model copy = model, other = mozzi::Model::embedded("panda").value();
  other = copy;
  copy = std::move(other);
  CHECK(copy.n() == 6 && copy.joint_names().size() == 6 && copy.joint_names()[0] == "shoulder_pan_joint");
  CHECK(model.position_names().size() == 6 && model.velocity_names().size() == 6 && model.frame_names().size() > 6);
  CHECK(model.parameter_names().size() == model.parameters().size() && model.state_names().empty());
  CHECK(model.constraint_row_names().empty() && model.mass() > 10 && model.gravity()[2] == -9.81);
  CHECK(model.limits().lower[0] < model.limits().upper[0] && model.limits().effort.size() == 6);
  CHECK(model.start().theta.size() == 6 && !model.state("none"));
  const mozzi::Frame tip = model.end_effector().value();
  CHECK(!model.frame("none") && model.frame(model.frame_names()[tip.number()]).value().c() == tip.c());

  CHECK(std::fabs(model.with_payload(tip, {2, 0, 0, 0, 0, 0, 0, 0, 0, 0}).value().mass() - model.mass() - 2) < 1e-12);
  CHECK(model.with_locked_joints({{"wrist_3_joint", 0.3}}).value().n() == 5);
  CHECK(!model.with_locked_joints({{"none", 0.3}}));
  const std::array<double, 16> at{{1, 0, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
  const mozzi::Model with_tool = model.with_frame("tool", tip, at).value();
  CHECK(with_tool.with_end_effector(with_tool.frame("tool").value()).value().end_effector().value().number() ==
        with_tool.frame("tool").value().number());
  CHECK(model.with_frame("tool", tip, std::vector<double>(15)).status().code() == MOZZI_WRONG_LENGTH);
  const double *none = nullptr;
  CHECK(model.with_frame("tool", tip, none).status().code() == MOZZI_NULL);
  const float half = std::sqrt(0.5f);  // of a sensor: a quarter of a turn in seven digits
  CHECK(model.with_frame("tool", tip, std::array<double, 16>{{half, -half, 0, 0, half, half, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}));
  CHECK(model.with_gravity({0, 0, -1.62}).value().gravity()[2] == -1.62);
  CHECK(model.with_base(true).value().nq() == 13 && model.with_parameters(model.parameters()).value().n() == 6);
  CHECK(!model.with_parameters(Numbers(3)));
  Numbers heavier = model.parameters();
  std::transform(heavier.begin(), heavier.end(), heavier.begin(), [](double x) { return 1.5 * x; });
  const mozzi::Model heavy = model.with_parameters(heavier).value();
  CHECK(std::fabs(heavy.with_gravity({0, 0, -1}).value().mass() - 1.5 * model.mass()) < 1e-9);
  CHECK(std::fabs(heavy.with_constraints("{\"constraints\": []}").value().mass() - 1.5 * model.mass()) < 1e-9);
  CHECK(model.sub_chain(model.frame("upper_arm_link").value(), model.frame("wrist_2_link").value()).value().n() == 3);
  const Numbers theta{0.3, -1.2, 1.5, 0.3, 1.1, 0.2}, zero(6);
  CHECK(model.with_state("home", theta, zero).value().with_start("home").value().start().theta == theta);
  const mozzi::Model held =
      model.with_constraints(R"({"constraints": [{"name": "c", "kind": "joint", "joint": "wrist_3_joint",
                                 "source": "wrist_2_joint", "polynomial": [0, -1]}]})").value();
  Numbers closed(6);
  held.assemble(theta, closed).or_throw();
  CHECK(std::fabs(closed[5] + closed[4]) < 1e-9 && held.without_constraints().value().constraint_rows() == 0);
  Numbers moved = theta, back(6);
  model.integrate(moved, theta, 0.5).or_throw();
  model.difference(theta, moved, back).or_throw();
  CHECK(std::fabs(back[1] + 0.6) < 1e-14);
  CHECK(model.integrate(moved, Numbers(5), 0.5).code() == MOZZI_WRONG_LENGTH);
}

void programs_and_batches() {
  const mozzi::Model model = mozzi::Model::open("panda").value();
  const mozzi::Frame hand = model.frame("panda_hand").value();
  const std::vector<mozzi::Quantity> quantities{MOZZI_MASS_MATRIX, {MOZZI_FORWARD_KINEMATICS, hand},
                                                {MOZZI_TASK_SPACE_DYNAMICS, mozzi::Task(hand)}};
  const mozzi::Program program = mozzi::Program::compile(model, quantities).value();
  const std::size_t n = model.n();
  mozzi::Workspace fast(program), plain(model);
  CHECK(!program.has_code(MOZZI_REGRESSOR));
  Numbers theta(n, 0.3), M(n * n), N(n * n), T(16), U(16);
  fast.mass_matrix(theta, M).or_throw();
  plain.mass_matrix(theta, N).or_throw();
  CHECK(difference(M.data(), N.data(), n * n) < 1e-13);
  fast.forward_kinematics(theta, hand, T).or_throw();
  plain.forward_kinematics(theta, hand, U).or_throw();
  CHECK(difference(T.data(), U.data(), 16) < 1e-13);
  const mozzi::Batch batch = mozzi::Batch::create(program, 2).value();
  Numbers twice(2 * n, 0.3), both(2 * n * n);
  batch.compute(MOZZI_MASS_MATRIX, 2, {{twice.data(), twice.size()}}, {{both.data(), both.size()}}).or_throw();
  CHECK(difference(both.data() + n * n, N.data(), n * n) < 1e-13);
  CHECK(batch.compute(MOZZI_MASS_MATRIX, 3, {{twice.data(), twice.size()}}, {{both.data(), both.size()}}).code() ==
        MOZZI_WRONG_LENGTH);
}

void motions() {
  const mozzi::Model model = mozzi::Model::open("double_pendulum").value();
  const mozzi::SimulationOptions options(1.0, 100);
  const Numbers theta{0.4, -0.2}, dtheta{0.1, 0.3};
  std::size_t rows = 0;
  double end = 0;
  const auto record = [&](const mozzi_sample &row) {
    ++rows;
    end = row.t;
    return true;
  };
  const auto brake = [](double, const double *, const double *rates, double *tau) { tau[0] -= rates[0]; };
  const mozzi_ending ending = mozzi::simulate(model, options, theta, dtheta, brake, record).value();
  CHECK(rows == 101 && end == 1.0 && ending.complete == 1);
  CHECK(!mozzi::simulate(model, options, Numbers(3), dtheta, brake, record));
  Numbers last(2), both{0.4, -0.2, 0.4, -0.2}, rates{0.1, 0.3, 0.1, 0.3};
  const auto keep = [&](const mozzi_sample &row) { std::copy(row.theta, row.theta + 2, last.begin()); };
  CHECK(mozzi::simulate(model, options, theta, dtheta, nullptr, keep).value().complete == 1);
  CHECK(mozzi::simulate(model, options, theta, dtheta, nullptr, nullptr).ok());
  const mozzi::Batch pair = mozzi::Batch::create(model, 1).value();
  pair.simulate(2, both, rates, Numbers(4), MOZZI_RUNGE_KUTTA_4, 1.0, 100).or_throw();
  CHECK(difference(both.data() + 2, last.data(), 2) < 1e-9);
  CHECK(pair.simulate(3, both, rates, Numbers(4), MOZZI_RUNGE_KUTTA_4, 1.0, 100).code() == MOZZI_WRONG_LENGTH);
#if MOZZI_HAS_EXCEPTIONS
  struct Mine {};
  bool caught = false;
  try {
    (void)mozzi::simulate(model, options, theta, dtheta, [](double, const double *, const double *, double *) { throw Mine(); },
                          record);
  } catch (const Mine &) {
    caught = true;
  }
  CHECK(caught);
#endif
  const mozzi::Model panda = mozzi::Model::open("panda").value();
  const mozzi::Frame hand = panda.frame("panda_hand").value();
  mozzi::Workspace workspace(panda);
  Numbers goal(panda.nq()), guess(panda.nq()), found(panda.nq()), T(16), U(16);
  goal[1] = 0.4, goal[3] = guess[3] = -1.5, goal[5] = guess[5] = 1.2;
  workspace.forward_kinematics(goal, hand, T).or_throw();
  mozzi::InverseKinematics solver = mozzi::InverseKinematics::create(panda, hand).value();
  solver.solve(T, guess, found).or_throw();
  workspace.forward_kinematics(found, hand, U).or_throw();
  CHECK(difference(U.data(), T.data(), 16) < 1e-7);
  solver.solve_position({T[3], T[7], T[11]}, guess, found).or_throw();
  CHECK(solver.solve_position({100, 0, 0}, guess, found).code() == MOZZI_NOT_REACHED);
  workspace.forward_kinematics(found, hand, U).or_throw();
  CHECK(U[3] > 0.8);  // stretched towards it
  CHECK(solver.solve_position(Numbers{T[3], T[7], T[11]}, guess, found).ok());
  CHECK(solver.solve_position(Numbers(4), guess, found).code() == MOZZI_WRONG_LENGTH);
  solver.solve_orientation({T[0], T[1], T[2], T[4], T[5], T[6], T[8], T[9], T[10]}, guess, found).or_throw();
  guess[0] = NAN;
  CHECK(solver.solve(T, guess, found).code() == MOZZI_NOT_FINITE &&
        std::string(mozzi_last_error()).find("guess[0] is NaN") == 0);

  Numbers parameters = model.parameters();
  const std::vector<std::string> names = model.parameter_names();
  const auto friction = std::find_if(names.begin(), names.end(), [](const std::string &name) {
    return name.find(".friction") != std::string::npos;
  });
  parameters[static_cast<std::size_t>(friction - names.begin())] = 0.2;
  const mozzi::Model dry = model.with_parameters(parameters).value();
  CHECK(mozzi::simulate(dry, options, theta, dtheta, brake, record).value().complete == 1);
  mozzi::SimulationOptions smooth(1.0, 100);
  smooth.method = MOZZI_RUNGE_KUTTA_4;
  CHECK(!mozzi::simulate(dry, smooth, theta, dtheta, brake, record));
  smooth.slip_speed = 0.01;
  CHECK(mozzi::simulate(dry, smooth, theta, dtheta, brake, record).ok());
}

}  // namespace

int main() {
  results();
  models();
  programs_and_batches();
  motions();
  return 0;
}
