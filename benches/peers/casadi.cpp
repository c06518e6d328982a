// What casadi_kernels.py wrote: a C function for each robot and quantity, one state a call.

#include "peer.hpp"
#include <cstring>
#include <utility>

struct Robot {
    std::string name;
    int n;
    std::vector<double> out;
};

#define FUNCTION(robot, function, quantity, how) \
    extern "C" int function(const double**, double**, int*, double*, int);
#include "robots.inc"
#undef FUNCTION

std::string version() {
    return "C that CasADi " CASADI_VERSION " generates for the one robot, of "
           "up to 40 bodies (derivatives of up to 8 velocities), "
           "compiled by " __VERSION__ "; from the model to its first inverse dynamics: " CASADI_FIRST;
}
const char* const CONVENTION = "mozzi";

namespace {

using Function = int(const double**, double**, int*, double*, int);

template <Function function> void run(Robot& r, const State& s) {
    const double* in[] = {s.theta, s.dtheta, s.ddtheta, s.tau};
    double* out[] = {r.out.data()};
    function(in, out, nullptr, nullptr, 0);
    keep(out[0]);
}

template <int matrices> void put(Robot& r, double* out) {
    std::copy_n(r.out.data(), matrices ? matrices * r.n * r.n : r.n, out);
}

Algorithm algorithm(const char* quantity, const char* how, void (*run)(Robot&, const State&)) {
    auto put_matrices = std::strstr(quantity, "derivatives") ? put<3> : std::strstr(quantity, "matrix") ? put<1> : put<0>;
    return {quantity, how, run, put_matrices};
}

const std::vector<std::pair<std::string, Algorithm>> FUNCTIONS = {
#define FUNCTION(robot, function, quantity, how) {#robot, algorithm(quantity, how, run<function>)},
#include "robots.inc"
};

} // namespace

std::vector<Algorithm> algorithms(const Robot& robot) {
    std::vector<Algorithm> list;
    for (const auto& [name, algorithm] : FUNCTIONS)
        if (name == robot.name) list.push_back(algorithm);
    return list;
}

Robot* make_robot(const Description& description) {
    int n = description.velocities();
    Robot robot{description.name, n, std::vector<double>(3 * n * n)};
    return algorithms(robot).empty() ? nullptr : new Robot(robot);
}

void free_robot(Robot* robot) { delete robot; }
