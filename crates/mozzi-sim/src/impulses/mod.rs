//! One-sided forces within a step of a simulation: their rows, their solution, and what is remembered of them.

mod account;
mod memory;
mod near;
mod position;
mod rebound;
mod rows;

pub use account::OneSidedAccount;
pub(crate) use memory::Memory;
pub(crate) use rows::{Key, System};

use crate::Error;
use crate::contacts::{ContactForce, Contacts, Surface};
use crate::factored_mass::FactoredMass;
use crate::one_sided::{Law, Solver};
use crate::{Friction, Options, Policy};
use alloc::vec::Vec;
use mozzi::linalg::Vec3;
use mozzi::model::{Bounds, Model};
use mozzi::scalar::Scalar;
use nalgebra::{DMatrix, DVector};
use near::Cloud;
use rows::Touching;

/// The residuals that are sought, and that are accepted rather than a long search, relative to the largest of the
/// velocities b, or to `LEAST`, m/s.
const TOLERANCES: [f64; 2] = [1e-12, 1e-6];
const LEAST: f64 = 1e-4;
/// A residual above this is reported as unsolved, m/s.
const UNSOLVED: f64 = 1e-6;
/// Repeated solutions in which the friction of other contacts is taken at the middle of the step.
const SHIFTS: usize = 5;
/// Contacts nearer than this act at least, m: rounding of positions.
const NEAR: f64 = 1e-8;
/// Impulses that change their contact's velocity by a smaller part of the largest are not known to act.
const CARRIES: f64 = 1e-9;
/// A contact that stuck is reported to slide above the first speed, one that slid to stick below the second, m/s.
const SLIDES: f64 = 1e-6;
const STICKS: f64 = 1e-9;

/// The one-sided forces of a robot along a motion.
pub(crate) struct Impulses<'r> {
    pub model: &'r Model,
    pub contacts: &'r Contacts<'r>,
    clouds: Vec<Cloud>,
    /// The limits that act as stops, joint and side.
    stops: Option<(Bounds, Vec<(usize, usize)>)>,
    /// The velocities with dry friction.
    pub dry: Vec<usize>,
    /// Stops that act in the present step though they seemed too far away.
    pub passed: Vec<(usize, usize)>,
    /// Points and planes that do so.
    pub pressed: Vec<(usize, usize)>,
    /// Contacts at most this far act, m.
    reach: f64,
    pub memory: Memory,
    pub account: OneSidedAccount,
    /// The forces on the planes in the last step, by their pairs; during a step, the impulses of its parts.
    pub forces: Vec<ContactForce>,
    /// The blocks of the last step that counts, and their solver.
    last: Option<(Vec<Key>, Solver)>,
    /// That of the last system.
    pub mass: FactoredMass<'r>,
}

/// Impulses of a system.
pub(crate) struct Solved {
    pub p: DVector<f64>,
    /// The velocities of the surroundings before the step, at its end without impulses (none if there are none), and at
    /// its end.
    pub before: DVector<f64>,
    pub free: DVector<f64>,
    pub u: DVector<f64>,
    pub residual: f64,
}

/// Whether a contact slides before and after the step in about the same direction. Its friction is then opposite to the
/// mean of its velocities, which is of second order; only the direction counts, so the mean's law is that of b_t + u_t.
/// The velocity of a contact that sticks is rounding, and has no direction.
fn slides_throughout(
    law: Law,
    first: usize,
    G: &DMatrix<f64>,
    p: &DVector<f64>,
    [before, after]: [&DVector<f64>; 2],
) -> bool {
    let product = |a: &DVector<f64>, b: &DVector<f64>| a[first + 1] * b[first + 1] + a[first + 2] * b[first + 2];
    if !matches!(law, Law::Contact { .. }) || is_inside(law, first, G, p, after) {
        return false;
    }
    let (squares, along) = (product(before, before) * product(after, after), product(before, after));
    p[first] > 0.0 && squares > 1e-32 && along > 0.0 && along * along > 0.25 * squares
}

/// True if p is inside its friction cone, so that the contact sticks; always false for dry friction and stops.
fn is_inside(law: Law, first: usize, G: &DMatrix<f64>, p: &DVector<f64>, u: &DVector<f64>) -> bool {
    let Law::Contact { mu } = law else { return false };
    let g = G[(first + 1, first + 1)].max(f64::MIN_POSITIVE);
    let [x, y] = [1, 2].map(|k| p[first + k] - u[first + k] / g);
    let radius = mu * p[first];
    x * x + y * y < radius * radius
}

/// ‖u_t‖ of a contact.
fn slip(u: &DVector<f64>, first: usize) -> f64 {
    let (x, y) = (u[first + 1], u[first + 2]);
    Scalar::sqrt(x * x + y * y)
}

impl Solved {
    /// The solution of a system without rows.
    pub fn none() -> Self {
        let none = || DVector::zeros(0);
        Solved { p: none(), before: none(), free: none(), u: none(), residual: 0.0 }
    }

    /// The energy that the impulses dissipate and that they give to moving planes, from the velocities before and after
    /// the step in the axes of its middle, where p acts.
    pub fn works(&self, system: &System, before: &[f64], after: &[f64]) -> [f64; 2] {
        let twice = system.relative(before) + system.relative(after);
        [-0.5 * self.p.dot(&twice), self.p.dot(&system.w)]
    }

    /// See [`is_inside`].
    pub fn sticks(&self, system: &System, first: usize, law: Law) -> bool {
        is_inside(law, first, &system.G, &self.p, &self.u)
    }
}

impl<'r> Impulses<'r> {
    /// None if nothing one-sided acts and `is_forced` is false.
    pub fn new(
        model: &'r Model,
        contacts: &'r Contacts<'r>,
        options: &Options,
        is_forced: bool,
    ) -> Result<Option<Self>, Error> {
        contacts.check(model)?;
        let is_dry = options.friction == Friction::Coulomb;
        let dry: Vec<usize> = (0..model.n()).filter(|&j| is_dry && model.friction()[j] > 0.0).collect();
        let bounds = Bounds::of(model);
        let stops = (options.joint_limits == Policy::Respect).then(|| {
            let sides = crate::events::stops::sides(&bounds);
            (bounds, sides)
        });
        let has_stops = stops.as_ref().is_some_and(|(_, sides)| !sides.is_empty());
        if dry.is_empty() && contacts.is_empty() && !has_stops && !is_forced {
            return Ok(None);
        }
        let (h, g) = (options.step(), options.gravity.unwrap_or(model.gravity()).norm());
        Ok(Some(Impulses {
            model,
            contacts,
            clouds: Cloud::all(contacts),
            stops,
            dry,
            passed: Vec::new(),
            pressed: Vec::new(),
            reach: (g * h * h).max(NEAR),
            memory: Memory::default(),
            account: OneSidedAccount::default(),
            forces: Vec::new(),
            last: None,
            mass: FactoredMass::new(model),
        }))
    }

    /// θ̇ ← θ̇ − M⁻¹Jᵀp.
    pub fn apply(&self, system: &System, p: &DVector<f64>, dtheta: &mut [f64]) {
        let mut change = system.J.tr_mul(p);
        self.mass.divide(change.as_mut_slice());
        dtheta.iter_mut().zip(change.iter()).for_each(|(rate, x)| *rate -= x);
    }

    /// The impulses of the last step, for a step of h seconds.
    pub fn guess(&self, system: &System, h: f64) -> DVector<f64> {
        let mut p = DVector::zeros(system.w.len());
        for &(key, first, law) in &system.rows {
            if let Ok(known) = self.memory.warm.binary_search_by_key(&key, |(key, _)| *key) {
                (0..law.rows()).for_each(|k| p[first + k] = h * self.memory.warm[known].1[k]);
            }
        }
        p
    }

    /// Solves for the impulses of a step of h seconds, from b (without restitution) and the velocities of the
    /// surroundings u₀ before it.
    /// Contacts that slide throughout have their friction at the middle of the step: those of the last solution, or
    /// more and more of them; one that then does not slide throughout is taken out for good.
    pub fn solve(
        &mut self,
        system: &mut System,
        free: DVector<f64>,
        before: &DVector<f64>,
        guess: &DVector<f64>,
        h: f64,
    ) -> Solved {
        let mut b = free.clone();
        for &(key, first, _) in &system.rows {
            // what opens at first must not be pushed: its mean velocity stays positive
            if let Key::Contact(..) | Key::Stop(..) = key {
                b[first] += before[first].max(0.0);
            }
        }
        for touching in &system.touches {
            let rebound = self.rebound(system, touching, before[touching.first], free[touching.first], h);
            b[touching.first] -= rebound.map_or(0.0, |rebound| rebound.speed);
        }
        let size = b.amax().max(LEAST);
        let tolerances = TOLERANCES.map(|tolerance| tolerance * size);
        let System { rows, shifted, solver, G, .. } = system;
        let (mut p, mut shifts, mut barred) = (guess.clone(), 0, alloc::vec![false; rows.len()]);
        loop {
            let mut of_middle = b.clone();
            for (&(_, first, law), _) in rows.iter().zip(&*shifted).filter(|(_, shifted)| **shifted) {
                law.tangential(first).for_each(|r| of_middle[r] += before[r]);
            }
            let found = solver.solve(&of_middle, &p, tolerances);
            self.account.add(&found);
            let mut u = free.clone();
            u.gemv(1.0, G, &found.p, 1.0);
            let slides: Vec<bool> =
                rows.iter().map(|&(_, first, law)| slides_throughout(law, first, G, &found.p, [before, &u])).collect();
            let mut changes = (0..rows.len()).any(|k| shifted[k] && !slides[k]);
            if changes && shifts == 0 {
                shifted.fill(false); // those of another solution
            } else {
                for k in 0..rows.len() {
                    barred[k] |= shifted[k] && !slides[k];
                    let begins = !shifted[k] && slides[k] && !barred[k] && shifts < SHIFTS;
                    shifted[k] = !barred[k] && (shifted[k] || begins);
                    changes |= begins;
                }
            }
            if !changes {
                return Solved { p: found.p, before: before.clone(), free, u, residual: found.residual };
            }
            (p, shifts) = (found.p, shifts + 1);
        }
    }

    /// Contacts that slid and stick at the end of the step move until they stop, after t_s = h|u_t|/(|u_t| − s), with s
    /// their speed at its end under full friction: by ½ t_s u_t, not by ½ h u_t.
    fn note_stopped(&mut self, system: &System, solved: &Solved, h: f64) {
        let mut p = solved.p.clone();
        let mut found = Vec::new();
        for &(key, first, law) in &system.rows {
            let (Key::Contact(point, plane), Law::Contact { mu }) = (key, law) else { continue };
            let speed = slip(&solved.before, first);
            if slip(&solved.u, first) > STICKS {
                self.memory.stopped.remove(&(point, plane)); // since an earlier part of the step
            }
            if speed > 1e-14 && slip(&solved.u, first) < 1e-9 * speed && solved.sticks(system, first, law) {
                found.push((first, (point, plane), speed));
                (1..3).for_each(|k| p[first + k] = -mu * p[first] * solved.before[first + k] / speed);
            }
        }
        if found.is_empty() {
            return;
        }
        let u = &system.G * p + &solved.free;
        for (first, pair, speed) in found {
            let way = [1, 2].map(|k| solved.before[first + k]);
            let end = (u[first + 1] * way[0] + u[first + 2] * way[1]) / speed;
            let rests = if end < 0.0 { h * speed / (speed - end) } else { h };
            self.memory.stopped.insert(pair, way.map(|u| 0.5 * (h - rests) * u));
        }
    }

    /// Adds the impulses of a part of a step, in {s}, from those along the rows.
    fn add_impulses(&mut self, system: &System, p: &DVector<f64>) {
        let planes = self.contacts.planes.len();
        for &Touching { pair: (point, plane), first, axes, .. } in &system.touches {
            let f = axes[0] * p[first] + axes[1] * p[first + 1] + axes[2] * p[first + 2];
            let pair = point * planes + plane;
            match self.forces.binary_search_by_key(&pair, |force| force.pair) {
                Ok(at) => self.forces[at].f += f,
                Err(at) if f != Vec3::zero() => self.forces.insert(at, ContactForce { pair, f }),
                Err(_) => {}
            }
        }
    }

    /// The contact forces of a whole step of h seconds, from the impulses of its parts.
    pub fn end_step(&mut self, h: f64) {
        self.forces.iter_mut().for_each(|force| force.f = force.f * (1.0 / h));
    }

    /// The planes at a time.
    pub fn surfaces(&self, t: f64) -> Vec<Surface> {
        self.contacts.planes.iter().map(|plane| plane.at(t)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{DMatrix, DVector, Law, slides_throughout};

    #[test]
    fn a_contact_slides_on_in_any_direction_of_the_plane() {
        let (law, G, at) =
            (Law::Contact { mu: 0.5 }, DMatrix::identity(3, 3), |x: f64, y: f64| DVector::from_vec(vec![0.0, x, y]));
        let slides = |before, after: DVector<f64>| {
            let p = DVector::from_vec(vec![1.0, 0.0, 0.0]) - &after * (0.5 / after.norm().max(1.0));
            slides_throughout(law, 0, &G, &p, [&before, &after])
        };
        // within 60°
        assert!(slides(at(1.0, 0.0), at(2.0, 0.1)) && slides(at(0.0, 1.0), at(0.1, 2.0)));
        assert!(slides(at(1.0, 0.0), at(1.0, 1.7)) && !slides(at(1.0, 0.0), at(1.0, 1.8)));
        assert!(!slides(at(0.0, 1.0), at(0.0, -1.0)) && !slides(at(0.0, 1.0), at(0.0, 0.0)));
        assert!(!slides(at(1.0, 0.0), at(1e-16, 0.0)), "rounding of a contact that sticks");
        let (lifted, pressed) = (DVector::zeros(3), DVector::from_vec(vec![1.0, 0.0, 0.0]));
        assert!(!slides_throughout(law, 0, &G, &lifted, [&at(1.0, 0.0), &at(1.0, 0.0)]));
        assert!(!slides_throughout(Law::Stop, 0, &G, &pressed, [&at(1.0, 0.0), &at(1.0, 0.0)]));
    }
}
