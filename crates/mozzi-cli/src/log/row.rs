//! The columns of a motion's row.

use crate::columns;
use crate::recogniser::ENERGIES;
use mozzi::Model;
use mozzi_sim::Sample;

/// A part of a row: its name, its columns' names, and whether it is a vector (even with one joint).
pub struct Group {
    pub name: &'static str,
    pub columns: Vec<String>,
    pub is_vector: bool,
}

/// t, θ, θ̇, θ̈, τ, the energies and works, in the order of [`values`].
pub fn groups(model: &Model) -> Vec<Group> {
    let single = |name: &'static str| Group { name, columns: vec![name.to_string()], is_vector: false };
    let vectors = ["theta", "dtheta", "ddtheta", "tau"];
    let vectors = vectors.map(|name| Group { name, columns: columns::names(model, name), is_vector: true });
    [single("t")].into_iter().chain(vectors).chain(ENERGIES.map(single)).collect()
}

/// All columns.
pub fn names(model: &Model) -> Vec<String> {
    groups(model).into_iter().flat_map(|group| group.columns).collect()
}

/// The numbers of a row, group after group.
pub fn values<'a>(row: &'a Sample) -> impl Iterator<Item = f64> + 'a {
    let energy = &row.energy;
    let energies = [energy.kinetic, energy.potential, energy.motor_work, energy.friction_loss, energy.applied_work];
    let vectors = [row.theta, row.dtheta, row.ddtheta, row.tau].into_iter().flatten().copied();
    std::iter::once(row.t).chain(vectors).chain(energies)
}
