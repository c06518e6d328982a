//! The quantities: how a batch is asked for each, and how the model.

use mozzi::{Environment, FrameId, Model};
use mozzi_batch::{Batch, BatchEnvironment};

pub type OfBatch<T> =
    fn(&Batch<T>, FrameId, &[&[T]; 3], &BatchEnvironment<T>, &mut [Vec<T>]) -> Result<(), mozzi_batch::Error>;
pub type AtOne = fn(&Model, FrameId, [&[f64]; 3], &Environment) -> Vec<Vec<f64>>;

/// Name, outputs' numbers a state, the batch's method, the model's.
macro_rules! quantities {
    ($T:ty) => {{
        fn rows(M: mozzi::nalgebra::DMatrix<f64>) -> Vec<f64> {
            M.transpose().as_slice().to_vec()
        }
        fn task(frame: FrameId) -> mozzi::Task<'static> {
            mozzi::Task { frame, coordinates: mozzi::TaskFrame::Space, rows: &[4] }
        }
        let all: Vec<(&str, fn(usize) -> Vec<usize>, $crate::quantities::OfBatch<$T>, $crate::quantities::AtOne)> = vec![
            (
                "inverse_dynamics",
                |n| vec![n],
                |b, _, [q, v, a], s, o| b.inverse_dynamics(q, v, a, s, &mut o[0]),
                |m, _, [q, v, a], e| vec![m.inverse_dynamics(q, v, a, e).unwrap().as_slice().to_vec()],
            ),
            (
                "forward_dynamics",
                |n| vec![n],
                |b, _, [q, v, a], s, o| b.forward_dynamics(q, v, a, s, &mut o[0]),
                |m, _, [q, v, a], e| vec![m.forward_dynamics(q, v, a, e).unwrap().as_slice().to_vec()],
            ),
            (
                "mass_matrix",
                |n| vec![n * n],
                |b, _, [q, ..], _, o| b.mass_matrix(q, &mut o[0]),
                |m, _, [q, ..], _| vec![rows(m.mass_matrix(q).unwrap())],
            ),
            (
                "mass_matrix_rate",
                |n| vec![n * n],
                |b, _, [q, v, _], _, o| b.mass_matrix_rate(q, v, &mut o[0]),
                |m, _, [q, v, _], _| vec![rows(m.mass_matrix_rate(q, v).unwrap())],
            ),
            (
                "coriolis_matrix",
                |n| vec![n * n],
                |b, _, [q, v, _], _, o| b.coriolis_matrix(q, v, &mut o[0]),
                |m, _, [q, v, _], _| vec![rows(m.coriolis_matrix(q, v).unwrap())],
            ),
            (
                "velocity_product",
                |n| vec![n],
                |b, _, [q, v, _], _, o| b.velocity_product(q, v, &mut o[0]),
                |m, _, [q, v, _], _| vec![m.velocity_product(q, v).unwrap().as_slice().to_vec()],
            ),
            (
                "gravity_forces",
                |n| vec![n],
                |b, _, [q, ..], s, o| b.gravity_forces(q, s, &mut o[0]),
                |m, _, [q, ..], _| vec![m.gravity_forces(q).unwrap().as_slice().to_vec()],
            ),
            (
                "bias_forces",
                |n| vec![n],
                |b, _, [q, v, _], s, o| b.bias_forces(q, v, s, &mut o[0]),
                |m, _, [q, v, _], e| vec![m.bias_forces(q, v, e).unwrap().as_slice().to_vec()],
            ),
            (
                "tip_forces",
                |n| vec![n],
                |b, _, [q, ..], s, o| b.tip_forces(q, s, &mut o[0]),
                |m, _, [q, ..], e| vec![m.tip_forces(q, e.applied).unwrap().as_slice().to_vec()],
            ),
            (
                "kinetic_energy",
                |_| vec![1],
                |b, _, [q, v, _], s, o| b.kinetic_energy(q, v, s, &mut o[0]),
                |m, _, [q, v, _], _| vec![vec![m.kinetic_energy(q, v).unwrap()]],
            ),
            (
                "potential_energy",
                |_| vec![1],
                |b, _, [q, ..], s, o| b.potential_energy(q, s, &mut o[0]),
                |m, _, [q, ..], _| vec![vec![m.potential_energy(q).unwrap()]],
            ),
            (
                "forward_kinematics",
                |_| vec![16],
                |b, f, [q, ..], _, o| b.forward_kinematics(f, q, &mut o[0]),
                |m, f, [q, ..], _| vec![m.forward_kinematics(q, f).unwrap().to_matrix().as_flattened().to_vec()],
            ),
            (
                "space_jacobian",
                |n| vec![6 * n],
                |b, f, [q, ..], _, o| b.space_jacobian(f, q, &mut o[0]),
                |m, f, [q, ..], _| vec![rows(m.space_jacobian(q, f).unwrap().matrix())],
            ),
            (
                "body_jacobian",
                |n| vec![6 * n],
                |b, f, [q, ..], _, o| b.body_jacobian(f, q, &mut o[0]),
                |m, f, [q, ..], _| vec![rows(m.body_jacobian(q, f).unwrap().matrix())],
            ),
            (
                "space_jacobian_rate",
                |n| vec![6 * n],
                |b, f, [q, v, _], _, o| b.space_jacobian_rate(f, q, v, &mut o[0]),
                |m, f, [q, v, _], _| vec![rows(m.space_jacobian_rate(q, v, f).unwrap().matrix())],
            ),
            (
                "body_jacobian_rate",
                |n| vec![6 * n],
                |b, f, [q, v, _], _, o| b.body_jacobian_rate(f, q, v, &mut o[0]),
                |m, f, [q, v, _], _| vec![rows(m.body_jacobian_rate(q, v, f).unwrap().matrix())],
            ),
            (
                "task_space_dynamics",
                |_| vec![1, 1],
                |b, f, [q, v, _], s, o| {
                    let [Lambda, eta] = o else { unreachable!() };
                    b.task_space_dynamics(task(f), q, v, s, Lambda, eta)
                },
                |m, f, [q, v, _], e| {
                    let found = m.task_space_dynamics(q, v, task(f), e).unwrap();
                    vec![rows(found.Lambda), found.eta.as_slice().to_vec()]
                },
            ),
            (
                "inverse_dynamics_derivatives",
                |n| vec![n * n; 3],
                |b, _, [q, v, a], s, o| {
                    let [x, y, z] = o else { unreachable!() };
                    b.inverse_dynamics_derivatives(q, v, a, s, x, y, z)
                },
                |m, _, [q, v, a], e| {
                    let d = m.inverse_dynamics_derivatives(q, v, a, e).unwrap();
                    vec![rows(d.d_theta), rows(d.d_dtheta), rows(d.d_ddtheta)]
                },
            ),
            (
                "forward_dynamics_derivatives",
                |n| vec![n, n * n, n * n, n * n],
                |b, _, [q, v, a], s, o| {
                    let [w, x, y, z] = o else { unreachable!() };
                    b.forward_dynamics_derivatives(q, v, a, s, w, x, y, z)
                },
                |m, _, [q, v, a], e| {
                    let d = m.forward_dynamics_derivatives(q, v, a, e).unwrap();
                    vec![d.ddtheta.as_slice().to_vec(), rows(d.d_theta), rows(d.d_dtheta), rows(d.d_tau)]
                },
            ),
        ];
        all
    }};
}
