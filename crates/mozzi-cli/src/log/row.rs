//! The columns of a motion's row.

use crate::columns;
use crate::recogniser::{ENERGIES, FORCES};
use mozzi::{Model, Vec3};
use mozzi_sim::{Contacts, PlaneMotion, Sample};

/// The columns of a motion's file.
pub struct Row<'m> {
    pub model: &'m Model,
    contacts: Vec<Pair>,
}

/// A contact point and a plane.
struct Pair {
    name: String,
    /// The normal out of the plane, in {s}.
    up: Vec3,
}

/// A part of a row: its name, its columns' names, and whether it is a vector (even with one joint).
pub struct Group {
    pub name: &'static str,
    pub columns: Vec<String>,
    pub is_vector: bool,
}

impl<'m> Row<'m> {
    /// Without forces of contacts.
    pub fn new(model: &'m Model) -> Self {
        Row { model, contacts: Vec::new() }
    }

    /// With f_n and f_t of each contact. Planes that move by a function of time are those of Rust alone.
    pub fn with_forces(self, contacts: &Contacts) -> Self {
        let up = |k: usize| match &contacts.planes[k % contacts.planes.len()].motion {
            PlaneMotion::Fixed(T) | PlaneMotion::Belt(T, _) => T.R * Vec3([0.0, 0.0, 1.0]),
            PlaneMotion::Moving(_) => Vec3([0.0, 0.0, 1.0]),
        };
        Row { contacts: contacts.names().enumerate().map(|(k, name)| Pair { name, up: up(k) }).collect(), ..self }
    }

    /// t, θ, θ̇, θ̈, τ, the energies and works, and the forces of contacts, in the order of [`values`](Self::values).
    pub fn groups(&self) -> Vec<Group> {
        let single = |name: &'static str| Group { name, columns: vec![name.to_string()], is_vector: false };
        let vectors = ["theta", "dtheta", "ddtheta", "tau"];
        let vectors = vectors.map(|name| Group { name, columns: columns::names(self.model, name), is_vector: true });
        let of_contacts = |name: &'static str| Group {
            name,
            columns: self.contacts.iter().map(|pair| format!("{name}_{}", pair.name)).collect(),
            is_vector: true,
        };
        let forces = FORCES.into_iter().filter(|_| !self.contacts.is_empty()).map(of_contacts);
        [single("t")].into_iter().chain(vectors).chain(ENERGIES.map(single)).chain(forces).collect()
    }

    /// All columns.
    pub fn names(&self) -> Vec<String> {
        self.groups().into_iter().flat_map(|group| group.columns).collect()
    }

    /// The numbers of a row, group after group: of a contact f_n = −fᵀn ≥ 0 and f_t = ‖f + f_n n‖, n out of the plane.
    pub fn values<'a>(&'a self, row: &'a Sample) -> impl Iterator<Item = f64> + 'a {
        let energy = &row.energy;
        let energies = [energy.kinetic, energy.potential, energy.motor_work, energy.friction_loss, energy.applied_work];
        let vectors = [row.theta, row.dtheta, row.ddtheta, row.tau].into_iter().flatten().copied();
        let contacts = self.contacts.iter().enumerate();
        let at = row.forces_of(0..self.contacts.len());
        let pairs =
            contacts.map(|(k, pair)| (pair, Vec3([at[3 * k], at[3 * k + 1], at[3 * k + 2]]))).collect::<Vec<_>>();
        let normal = pairs.iter().map(|(pair, f)| -f.dot(pair.up)).collect::<Vec<_>>();
        let across = pairs.into_iter().map(|(pair, f)| (f - pair.up * f.dot(pair.up)).norm());
        let forces = normal.into_iter().chain(across);
        std::iter::once(row.t).chain(vectors).chain(energies).chain(forces)
    }
}
