//! The text of rollouts: many robots, many Runge-Kutta steps in one kernel, a thread for each robot, whose state stays
//! in registers.

use crate::source::Source;
use crate::{Argument, Error, Form, guarded, manifold, order};
use mozzi::Model;
use mozzi::quantities::ForwardDynamics;
use mozzi_engine::{Block, CudaLayout, Language, Precision, emit_programs};

/// Threads of a block.
const THREADS: usize = 128;

impl Source {
    /// The kernel of K steps by the classical Runge-Kutta method, with torques that are held over each step: those of a
    /// table, plus linear feedback G(θ_d ⊖ θ, θ̇_d − θ̇) of the state at the beginning of the step. Quaternions move on
    /// their group, by Munthe-Kaas' method, as on the CPU. Launch it by [`Rollout`](crate::Rollout).
    ///
    /// # Errors
    /// [`Error::Unsupported`] for robots with constraints.
    pub fn rollout(model: &Model, precision: Precision, layout: CudaLayout) -> Result<Source, Error> {
        if model.constraint_rows() > 0 {
            return Err(Error::Unsupported { quantity: "rollout", reason: "the robot has constraints" });
        }
        let (nq, n) = (model.nq(), model.n());
        let program = order::ordered(guarded::program(model, ForwardDynamics.into(), precision, false)?, n);
        let files = emit_programs(&model.description().name, &[program], Language::Cuda, precision)?;
        let mut text: String = files.into_iter().map(|file| file.text).collect();
        let function = text.lines().find_map(|line| {
            let (_, rest) = line.split_once("__forceinline__ void ")?;
            let (name, _) = rest.split_once('(')?;
            name.strip_suffix("_forward_dynamics")
        });
        let robot = function.unwrap_or("robot").to_string();
        let entry = format!("{robot}_rollout_{}", layout.name());
        let own = manifold::text(model.configuration_space()) + &kernel([nq, n], layout);
        let number = if precision == Precision::F64 { "double" } else { "float" };
        text += &own.replace("NUMBER", number).replace("ROBOT", &robot); // the name last: it may be any word
        let array = |name: &str, length: usize| Argument { name: name.to_string(), length };
        Ok(Source {
            text,
            entry,
            inputs: vec![array("theta", nq), array("dtheta", n)],
            outputs: vec![array("theta_table", nq), array("dtheta_table", n)],
            form: Form { precision, layout, is_packed: false },
            block: Block { threads: THREADS, shared_bytes: 0, states: 1 },
            kernels: "-DMOZZI_ONLY_ROWS -DMOZZI_ONLY_COLUMNS", // the function of one state alone
        })
    }
}

/// The kernel's text. An array of robots has rows of `width` numbers; entry k of robot i is at AT(k, width).
fn kernel([nq, n]: [usize; 2], layout: CudaLayout) -> String {
    let at = match layout {
        CudaLayout::Rows => "i * (width) + (k)",
        CudaLayout::Columns => "(k) * count + i",
    };
    TEXT.replace("AT_", at)
        .replace("LAYOUT", layout.name())
        .replace("THREADS", &THREADS.to_string())
        .replace("POSITIONS", &nq.to_string())
        .replace("COUNT", &n.to_string())
}

const TEXT: &str = r#"
// `steps` Runge-Kutta steps of h seconds for `count` robots, a thread each. tau: a row of COUNT numbers for each step
// and robot, or null for zeros. gains: COUNT rows of 2 COUNT numbers for all robots, or null; target: (theta, dtheta)
// of each robot, POSITIONS + COUNT numbers. The states after each `every` steps go to the tables.
#define AT(k, width) (AT_)
extern "C" __global__ void __launch_bounds__(THREADS)
ROBOT_rollout_LAYOUT(const NUMBER *__restrict__ theta, const NUMBER *__restrict__ dtheta, const NUMBER *__restrict__ tau,
    const NUMBER *__restrict__ gains, const NUMBER *__restrict__ target, NUMBER *__restrict__ theta_table,
    NUMBER *__restrict__ dtheta_table, const NUMBER h, const unsigned long long steps, const unsigned long long every,
    const unsigned long long count)
{
    const unsigned long long i = (unsigned long long) blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= count) return;
    NUMBER q[POSITIONS], v[COUNT], u[COUNT], q_start[POSITIONS], v_start[COUNT], k[COUNT], k_sum[COUNT], v_sum[COUNT], a[COUNT];
#pragma unroll
    for (int j = 0; j < POSITIONS; ++j) q[j] = theta[AT(j, POSITIONS)];
#pragma unroll
    for (int j = 0; j < COUNT; ++j) v[j] = dtheta[AT(j, COUNT)];
    const unsigned long long rows = steps / every;
    unsigned long long left = every, row = 0;
#pragma unroll 1
    for (unsigned long long step = 0; step < steps; ++step) {
#pragma unroll
        for (int j = 0; j < COUNT; ++j) u[j] = tau ? tau[AT(step * COUNT + j, steps * COUNT)] : 0;
        if (gains) {
            NUMBER desired[POSITIONS], error[COUNT];
#pragma unroll
            for (int j = 0; j < POSITIONS; ++j) desired[j] = target[AT(j, POSITIONS + COUNT)];
            ROBOT_difference(q, desired, error);
#pragma unroll
            for (int l = 0; l < COUNT; ++l) {
                const NUMBER dq = error[l], dv = target[AT(POSITIONS + l, POSITIONS + COUNT)] - v[l];
#pragma unroll
                for (int j = 0; j < COUNT; ++j) {
                    u[j] += gains[j * 2 * COUNT + l] * dq;
                    u[j] += gains[j * 2 * COUNT + COUNT + l] * dv;
                }
            }
        }
#pragma unroll
        for (int j = 0; j < POSITIONS; ++j) q_start[j] = q[j];
#pragma unroll
        for (int j = 0; j < COUNT; ++j) {
            v_start[j] = v_sum[j] = v[j];
            k[j] = k_sum[j] = 0;
        }
        NUMBER ahead = 0;
#pragma unroll 1
        for (int stage = 0; stage < 4; ++stage) {
            ROBOT_forward_dynamics<false>(q, v, u, a, 1);
            // the rate of q from q_start, along k for the time `ahead`
            ROBOT_rate(k, ahead, v);
            const NUMBER part = stage == 0 || stage == 3 ? h / 6 : h / 3;
            ahead = stage < 2 ? h / 2 : h;
#pragma unroll
            for (int j = 0; j < COUNT; ++j) {
                k[j] = v[j];
                k_sum[j] += part * k[j];
                v_sum[j] += part * a[j];
                v[j] = v_start[j] + ahead * a[j];
            }
#pragma unroll
            for (int j = 0; j < POSITIONS; ++j) q[j] = q_start[j];
            ROBOT_advance(q, k, ahead);
        }
#pragma unroll
        for (int j = 0; j < POSITIONS; ++j) q[j] = q_start[j];
        ROBOT_advance(q, k_sum, 1);
#pragma unroll
        for (int j = 0; j < COUNT; ++j) v[j] = v_sum[j];
        if (--left == 0) {
            left = every;
#pragma unroll
            for (int j = 0; j < POSITIONS; ++j) theta_table[AT(row * POSITIONS + j, rows * POSITIONS)] = q[j];
#pragma unroll
            for (int j = 0; j < COUNT; ++j) dtheta_table[AT(row * COUNT + j, rows * COUNT)] = v[j];
            ++row;
        }
    }
}
"#;
