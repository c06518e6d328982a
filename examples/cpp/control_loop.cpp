// A computed-torque loop at 1 kHz (Modern Robotics, section 11.4.3), τ = M(θ)(θ̈_d + K_d ė + K_p e) + h(θ, θ̇), and its
// worst latencies. The robot is simulated: a step of its forward dynamics takes the place of the drives.
//
//   control_loop [SECONDS]
//
// Run it as root, or with CAP_SYS_NICE and CAP_IPC_LOCK, for a real-time priority and locked memory; without them it
// says so and goes on. docs/cpp.md has a page on PREEMPT_RT.
#include <mozzi/mozzi.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <sched.h>
#include <sys/mman.h>
#include <time.h>

namespace {

constexpr long period = 1'000'000;  // ns
constexpr double h = 1e-3;          // s

long nanoseconds(const timespec &from, const timespec &to) {
  return (to.tv_sec - from.tv_sec) * 1'000'000'000L + (to.tv_nsec - from.tv_nsec);
}

timespec now() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t;
}

void become_real_time() {
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    std::printf("memory is not locked: %s\n", std::strerror(errno));
  }
  sched_param priority{};
  priority.sched_priority = 80;
  if (sched_setscheduler(0, SCHED_FIFO, &priority) != 0) {
    std::printf("no real-time priority: %s\n", std::strerror(errno));
  }
}

}  // namespace

int main(int count, char **arguments) {
  const double seconds = count > 1 ? std::atof(arguments[1]) : 1.0;
  const long cycles = std::lround(seconds / h);

  // everything that allocates, before the loop
  const mozzi::Model arm = mozzi::Model::embedded("ur5").value();
  const mozzi::Program program =
      mozzi::Program::compile(arm, {MOZZI_MASS_MATRIX, MOZZI_BIAS_FORCES, MOZZI_FORWARD_DYNAMICS}).value();
  mozzi::Workspace workspace(program);
  const std::size_t n = arm.n();
  std::vector<double> theta(n), dtheta(n), ddtheta(n), acceleration(n), M(n * n), bias(n), tau(n);
  const double Kp = 400, Kd = 40;
  long worst_wake_up = 0, worst_call = 0, total_call = 0;
  double worst_error = 0;
  mozzi_last_error();  // this thread's memory for texts
  become_real_time();

  timespec next = now();
  for (long cycle = 0; cycle < cycles; ++cycle) {
    next.tv_nsec += period;
    if (next.tv_nsec >= 1'000'000'000L) {
      next.tv_nsec -= 1'000'000'000L;
      ++next.tv_sec;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, nullptr);
    const timespec start = now();
    worst_wake_up = std::max(worst_wake_up, nanoseconds(next, start));

    // the reference: every joint swings by 0.5 rad with 1 Hz, from rest
    const double t = static_cast<double>(cycle) * h, w = 2 * 3.14159265358979;
    const double at = 0.25 * (1 - std::cos(w * t)), rate = 0.25 * w * std::sin(w * t);
    const double rate_of_rate = 0.25 * w * w * std::cos(w * t);
    for (std::size_t j = 0; j < n; ++j) {
      acceleration[j] = rate_of_rate + Kd * (rate - dtheta[j]) + Kp * (at - theta[j]);
      worst_error = std::max(worst_error, std::fabs(at - theta[j]));
    }
    // no allocation, no lock, no exception
    const bool is_fine = workspace.mass_matrix(theta, M).ok() && workspace.bias_forces(theta, dtheta, bias).ok();
    if (!is_fine) {
      std::printf("stopped: %s\n", mozzi_last_error());
      return 1;  // a robot would be brought to rest here
    }
    for (std::size_t i = 0; i < n; ++i) {
      tau[i] = bias[i];
      for (std::size_t j = 0; j < n; ++j) {
        tau[i] += M[i * n + j] * acceleration[j];
      }
    }
    const long call = nanoseconds(start, now());
    worst_call = std::max(worst_call, call);
    total_call += call;

    // the robot, by a semi-implicit step
    if (!workspace.forward_dynamics(theta, dtheta, tau, ddtheta).ok()) {
      std::printf("stopped: %s\n", mozzi_last_error());
      return 1;
    }
    for (std::size_t j = 0; j < n; ++j) {
      dtheta[j] += h * ddtheta[j];
      theta[j] += h * dtheta[j];
    }
  }
  std::printf("%ld cycles at 1 kHz: worst wake-up %.1f us late; control %.2f us on average, %.2f us at worst; "
              "largest error %.2e rad\n",
              cycles, 1e-3 * static_cast<double>(worst_wake_up),
              1e-3 * static_cast<double>(total_call) / static_cast<double>(std::max(cycles, 1L)),
              1e-3 * static_cast<double>(worst_call), worst_error);
  return worst_error < 0.05 ? 0 : 1;
}
