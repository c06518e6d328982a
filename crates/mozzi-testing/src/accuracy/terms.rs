//! The size of the terms, from the formula itself, for quantities that solve with the mass matrix and for its rate.

use crate::accuracy::robot::Robot;
use mozzi::quantities::{
    BiasForces, BodyJacobian, CoriolisMatrix, ForwardDynamics, ForwardDynamicsByInverseDynamics,
    ForwardDynamicsByMassMatrix, ForwardDynamicsDerivatives, MassMatrix, MassMatrixInverse, MassMatrixRate, Quantity,
    Query, TaskSpaceDynamics,
};
use nalgebra::DMatrix;

/// The largest term of each output at a state; None for other quantities.
///
/// X = M⁻¹B, where M's entries are rounded one by one: δX = −M⁻¹ δM X, hence |M⁻¹| |M| |X|. Λ = (J M⁻¹Jᵀ)⁻¹: |Λ| K |Λ|
/// with K = |J| |M⁻¹| |M| |M⁻¹| |J|ᵀ. η = Λ(J u − J̇θ̇), u = M⁻¹h: |Λ| (|J| |M⁻¹| |M| |u| + K |η|). Ṁ = C + Cᵀ: |C| +
/// |C|ᵀ.
pub fn of(robot: &Robot, query: &Query, inputs: &[&[f64]], outputs: &[Vec<f64>]) -> Option<Vec<f64>> {
    let (model, name, n) = (&robot.model, query.declaration().name, robot.model.n());
    let matrix = |rows: usize, x: &[f64]| DMatrix::from_row_slice(rows, x.len() / rows.max(1), x).abs();
    let computed = |of: Query, inputs: &[&[f64]]| model.compute(of, inputs, &model.environment()).ok();
    if name == MassMatrixRate::DECLARATION.name {
        let C = matrix(n, &computed(CoriolisMatrix.into(), &inputs[..2])?[0]);
        return Some(vec![(&C + C.transpose()).max()]);
    }
    let M = matrix(n, &computed(MassMatrix.into(), &inputs[..1])?[0]);
    let inverse = computed(MassMatrixInverse.into(), &inputs[..1])?;
    let (signed, rounding) = (DMatrix::from_row_slice(n, n, &inverse[0]), matrix(n, &inverse[0]) * &M);
    let solves = [
        ForwardDynamics::DECLARATION.name,
        ForwardDynamicsByMassMatrix::DECLARATION.name,
        ForwardDynamicsByInverseDynamics::DECLARATION.name,
        MassMatrixInverse::DECLARATION.name,
        ForwardDynamicsDerivatives::DECLARATION.name,
    ];
    if solves.contains(&name) {
        return Some(outputs.iter().map(|X| (&rounding * matrix(n, X)).max()).collect());
    }
    if name == TaskSpaceDynamics::DECLARATION.name {
        let task = robot.task();
        let J = computed(Query::from(BodyJacobian).of(task.frame), &inputs[..1])?;
        let J = DMatrix::from_fn(task.rows.len(), n, |r, j| J[0][task.rows[r] * n + j].abs());
        let h = computed(BiasForces.into(), &inputs[..2])?;
        let u = (&signed * DMatrix::from_row_slice(n, 1, &h[0])).abs();
        let (Lambda, eta) = (matrix(task.rows.len(), &outputs[0]), matrix(task.rows.len(), &outputs[1]));
        let K = &J * &rounding * signed.abs() * J.transpose();
        return Some(vec![(&Lambda * &K * &Lambda).max(), (&Lambda * (&J * &rounding * u + &K * eta)).max()]);
    }
    None
}
