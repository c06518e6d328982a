// The C interface of a peer: what benches/src/compare/peer.rs calls. A peer includes this, defines `Robot` and the five
// functions and names below, and gets the rest from here. A robot is given by numbers, fixed links merged into what carries them, so that no
// loader is timed; the states are stored once, and one call runs one algorithm over all of them.

#pragma once
#include <algorithm>
#include <string>
#include <vector>

// A moving body and the joint before it, as 30 numbers; the first body is the base, whose joint means nothing.
struct Body {
    double parent;        // among the bodies
    double is_revolute;   // else prismatic
    double placement[12]; // the joint's frame seen from the parent's: rotation by rows, translation
    double axis[3];       // in the joint's frame, through its origin
    double mass;
    double center[3];     // of mass, in the body's frame
    double inertia[9];    // about the centre of mass, by rows
};

struct Description {
    std::string name, urdf;
    const double* gravity;
    bool is_floating;
    std::vector<Body> bodies;
    int positions() const { return joints() + (is_floating ? 7 : 0); }
    int velocities() const { return joints() + (is_floating ? 6 : 0); }
    int joints() const { return int(bodies.size()) - 1; }
};

// One state in the peer's own convention.
struct State {
    const double *theta, *dtheta, *ddtheta, *tau;
};

struct Robot; // the peer's

struct Algorithm {
    const char* quantity;             // mozzi's name of it
    const char* name;                 // the peer's name of it
    void (*run)(Robot&, const State&); // what is timed
    void (*write)(Robot&, double*);    // its result, matrices by rows; not timed
};

// What the peer defines.
std::string version();
extern const char* const CONVENTION; // of a free base: mozzi, pinocchio or mujoco
Robot* make_robot(const Description&); // none if it cannot hold such a robot
std::vector<Algorithm> algorithms(const Robot&);
void free_robot(Robot*);

#define STRING_(...) #__VA_ARGS__
#define STRING(...) STRING_(__VA_ARGS__)

struct Loaded {
    Robot* robot;
    Description description;
    std::vector<Algorithm> list;
    std::vector<double> numbers;
    std::vector<State> states;
};

extern "C" {

const char* peer_version() {
    static const auto text = version();
    return text.c_str();
}
const char* peer_convention() { return CONVENTION; }
const char* peer_flags() { return STRING(PEER_FLAGS); }

Loaded* peer_robot(const char* name, const char* urdf, const double* gravity, int is_floating, const Body* bodies, int count) {
    Description description{name, urdf, gravity, is_floating != 0, {bodies, bodies + count}};
    auto robot = make_robot(description);
    return robot ? new Loaded{robot, description, algorithms(*robot), {}, {}} : nullptr;
}

const char* peer_quantity(Loaded* loaded, int k) { return k < int(loaded->list.size()) ? loaded->list[k].quantity : nullptr; }
const char* peer_algorithm(Loaded* loaded, int k) { return loaded->list[k].name; }

void peer_free(Loaded* loaded) {
    free_robot(loaded->robot);
    delete loaded;
}

// `count` states, each θ, θ̇, θ̈, τ.
void peer_states(Loaded* loaded, const double* x, int count) {
    int nq = loaded->description.positions(), n = loaded->description.velocities(), size = nq + 3 * n;
    loaded->numbers.assign(x, x + count * size);
    for (int k = 0; k < count; ++k) {
        auto s = loaded->numbers.data() + k * size;
        loaded->states.push_back({s, s + nq, s + nq + n, s + nq + 2 * n});
    }
}

// All states, one after the other.
void peer_run(Loaded* loaded, int algorithm) {
    auto run = loaded->list[algorithm].run;
    for (const auto& state : loaded->states) run(*loaded->robot, state);
}

// A robot on a bolted base, its motors braking by -brake θ̇, for `steps` steps of h seconds from (θ, θ̇) in place, by an algorithm of forward
// dynamics and what a user writes around it: Euler's method, or Runge and Kutta's where `is_runge_kutta`.
void peer_simulate(Loaded* loaded, int algorithm, int is_runge_kutta, int steps, double h, double brake, double* theta, double* dtheta) {
    const auto& a = loaded->list[algorithm];
    int n = loaded->description.velocities();
    std::vector<double> tau(n), zeros(n), q(n), v(n), sum_v(n), sum_a(n), acceleration(n);
    auto accelerate = [&](const double* theta, const double* dtheta) {
        for (int i = 0; i < n; ++i) tau[i] = -brake * dtheta[i];
        a.run(*loaded->robot, {theta, dtheta, zeros.data(), tau.data()});
        a.write(*loaded->robot, acceleration.data());
    };
    for (int k = 0; k < steps; ++k) {
        accelerate(theta, dtheta);
        if (!is_runge_kutta) {
            for (int i = 0; i < n; ++i) {
                theta[i] += h * dtheta[i];
                dtheta[i] += h * acceleration[i];
            }
            continue;
        }
        std::copy_n(dtheta, n, v.begin());
        std::copy_n(dtheta, n, sum_v.begin());
        sum_a = acceleration;
        for (int stage = 1; stage < 4; ++stage) {
            double step = stage < 3 ? h / 2 : h, weight = stage < 3 ? 2 : 1;
            for (int i = 0; i < n; ++i) {
                q[i] = theta[i] + step * v[i];
                v[i] = dtheta[i] + step * acceleration[i];
            }
            accelerate(q.data(), v.data());
            for (int i = 0; i < n; ++i) {
                sum_v[i] += weight * v[i];
                sum_a[i] += weight * acceleration[i];
            }
        }
        for (int i = 0; i < n; ++i) {
            theta[i] += h / 6 * sum_v[i];
            dtheta[i] += h / 6 * sum_a[i];
        }
    }
}

void peer_result(Loaded* loaded, int algorithm, int state, double* out) {
    loaded->list[algorithm].run(*loaded->robot, loaded->states[state]);
    loaded->list[algorithm].write(*loaded->robot, out);
}
}

// What was computed is looked at.
inline void keep(const void* result) { asm volatile("" ::"r"(result) : "memory"); }
