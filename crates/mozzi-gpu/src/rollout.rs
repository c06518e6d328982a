//! The text of rollouts: many robots, many Runge-Kutta steps in one kernel, a thread for each robot, whose state stays
//! in registers.

use crate::source::Source;
use crate::{Argument, Error, Form, guarded, order};
use mozzi::Model;
use mozzi::quantities::ForwardDynamics;
use mozzi_codegen::{Block, CudaLayout, Language, Precision, emit_programs};

/// Threads of a block.
const THREADS: usize = 128;

impl Source {
    /// The kernel of K steps by the classical Runge-Kutta method, with torques that are held over each step: those of a
    /// table, plus linear feedback G(x_d − x) of the state x = (θ, θ̇) at the beginning of the step. Launch it by
    /// [`Rollout`](crate::Rollout).
    ///
    /// # Errors
    /// [`Error::Unsupported`] for robots with a floating base, ball or free joints, whose θ is no vector, and for
    /// robots with constraints.
    pub fn rollout(model: &Model, precision: Precision, layout: CudaLayout) -> Result<Source, Error> {
        let unsupported = |reason| Err(Error::Unsupported { quantity: "rollout", reason });
        if model.nq() != model.n() || model.is_floating() {
            return unsupported("the robot has a floating base, a ball or a free joint");
        }
        if model.constraint_rows() > 0 {
            return unsupported("the robot has constraints");
        }
        let n = model.n();
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
        text += &kernel(&robot, &entry, n, precision, layout);
        let state = |name: &str| Argument { name: name.to_string(), length: n };
        Ok(Source {
            text,
            entry,
            inputs: vec![state("theta"), state("dtheta")],
            outputs: vec![state("theta_table"), state("dtheta_table")],
            form: Form { precision, layout, is_packed: false },
            block: Block { threads: THREADS, shared_bytes: 0 },
            kernels: "-DMOZZI_ONLY_ROWS -DMOZZI_ONLY_COLUMNS", // the function of one state alone
        })
    }
}

/// The kernel's text. An array of robots has rows of `width` numbers; entry k of robot i is at AT(k, width).
fn kernel(robot: &str, entry: &str, n: usize, precision: Precision, layout: CudaLayout) -> String {
    let at = match layout {
        CudaLayout::Rows => "i * (width) + (k)",
        CudaLayout::Columns => "(k) * count + i",
    };
    TEXT.replace("AT_", at)
        .replace("NUMBER", if precision == Precision::F64 { "double" } else { "float" })
        .replace("FUNCTION", &format!("{robot}_forward_dynamics"))
        .replace("ENTRY", entry)
        .replace("THREADS", &THREADS.to_string())
        .replace("COUNT", &n.to_string())
}

const TEXT: &str = r#"
// `steps` Runge-Kutta steps of h seconds for `count` robots, a thread each. tau: a row of COUNT numbers for each step
// and robot, or null for zeros. gains: COUNT rows of 2 COUNT numbers for all robots, or null; target: (theta, dtheta)
// of each robot, 2 COUNT numbers. The states after each `every` steps go to the tables.
#define AT(k, width) (AT_)
extern "C" __global__ void __launch_bounds__(THREADS)
ENTRY(const NUMBER *__restrict__ theta, const NUMBER *__restrict__ dtheta, const NUMBER *__restrict__ tau,
    const NUMBER *__restrict__ gains, const NUMBER *__restrict__ target, NUMBER *__restrict__ theta_table,
    NUMBER *__restrict__ dtheta_table, const NUMBER h, const unsigned long long steps, const unsigned long long every,
    const unsigned long long count)
{
    const unsigned long long i = (unsigned long long) blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= count) return;
    NUMBER q[COUNT], v[COUNT], u[COUNT], q_start[COUNT], v_start[COUNT], q_sum[COUNT], v_sum[COUNT], a[COUNT];
#pragma unroll
    for (int j = 0; j < COUNT; ++j) {
        q[j] = theta[AT(j, COUNT)];
        v[j] = dtheta[AT(j, COUNT)];
    }
    const unsigned long long rows = steps / every;
    unsigned long long left = every, row = 0;
#pragma unroll 1
    for (unsigned long long step = 0; step < steps; ++step) {
#pragma unroll
        for (int j = 0; j < COUNT; ++j) u[j] = tau ? tau[AT(step * COUNT + j, steps * COUNT)] : 0;
        if (gains) {
#pragma unroll
            for (int k = 0; k < COUNT; ++k) {
                const NUMBER dq = target[AT(k, 2 * COUNT)] - q[k], dv = target[AT(COUNT + k, 2 * COUNT)] - v[k];
#pragma unroll
                for (int j = 0; j < COUNT; ++j) {
                    u[j] += gains[j * 2 * COUNT + k] * dq;
                    u[j] += gains[j * 2 * COUNT + COUNT + k] * dv;
                }
            }
        }
#pragma unroll
        for (int j = 0; j < COUNT; ++j) {
            q_start[j] = q_sum[j] = q[j];
            v_start[j] = v_sum[j] = v[j];
        }
#pragma unroll 1
        for (int stage = 0; stage < 4; ++stage) {
            FUNCTION<false>(q, v, u, a, 1);
            const NUMBER part = stage == 0 || stage == 3 ? h / 6 : h / 3, ahead = stage < 2 ? h / 2 : h;
#pragma unroll
            for (int j = 0; j < COUNT; ++j) {
                q_sum[j] += part * v[j];
                v_sum[j] += part * a[j];
                q[j] = q_start[j] + ahead * v[j];
                v[j] = v_start[j] + ahead * a[j];
            }
        }
#pragma unroll
        for (int j = 0; j < COUNT; ++j) {
            q[j] = q_sum[j];
            v[j] = v_sum[j];
        }
        if (--left == 0) {
            left = every;
#pragma unroll
            for (int j = 0; j < COUNT; ++j) {
                theta_table[AT(row * COUNT + j, rows * COUNT)] = q[j];
                dtheta_table[AT(row * COUNT + j, rows * COUNT)] = v[j];
            }
            ++row;
        }
    }
}
"#;
