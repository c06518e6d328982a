//! One-sided forces within a step of a simulation: their rows, their solution, and what is remembered of them.

mod account;
mod position;
mod rows;

pub use account::OneSidedAccount;
pub(super) use rows::{Choice, Key, System};

use super::contact::{Contacts, Surface};
use super::factored_mass::FactoredMass;
use super::{Friction, Options, Policy};
use crate::kinematics::forward_kinematics;
use crate::lie::SE3;
use crate::linalg::Vec3;
use crate::model::{Bounds, Error, FrameId, Model};
use crate::one_sided::{Law, Problem, solve};
use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// The residual that is sought, relative to 1 + |b|.
const TOLERANCE: f64 = 1e-12;
/// A residual above this is reported as unsolved, m/s.
const UNSOLVED: f64 = 1e-6;
/// Repeated solutions in which the friction of more blocks is taken at the middle of the step.
const SHIFTS: usize = 4;
/// Energy that friction may give by rounding, J.
const GAINS: f64 = 1e-16;
/// Contacts nearer than this act at least, m: rounding of positions.
const NEAR: f64 = 1e-8;

/// The one-sided forces of a robot along a motion.
pub(super) struct Impulses<'r> {
    pub model: &'r Model,
    pub contacts: &'r Contacts<'r>,
    /// The limits that act as stops, joint and side.
    stops: Option<(Bounds, Vec<(usize, usize)>)>,
    /// The velocities with dry friction.
    pub dry: Vec<usize>,
    frames: Vec<FrameId>,
    /// Contacts at most this far act, m.
    pub reach: f64,
    /// Slower impacts do not rebound, m/s.
    pub slowest: f64,
    /// The forces of the last step, in the order of their keys.
    warm: Vec<(Key, [f64; 3])>,
    /// Where sticking contact points touch: in the coordinates of the plane.
    anchors: BTreeMap<(usize, usize), Vec3>,
    /// The contacts and stops that carried in the last step, and whether they stick.
    pub carrying: Vec<(Key, bool)>,
    /// Joints and sides of stops that were struck and not reported yet.
    pub struck: Vec<(usize, usize)>,
    pub account: OneSidedAccount,
    /// The force that each pair of a point and a plane applies to the plane, in {s}: three numbers each, N.
    pub forces: Vec<f64>,
    /// That of the last system.
    pub mass: FactoredMass<'r>,
}

/// Impulses of a system.
pub(super) struct Solved {
    pub p: DVector<f64>,
    pub u: DVector<f64>,
    pub residual: f64,
}

/// Is the friction of a block opposite to the mean of its velocities before and after the step? So it is for what
/// slides throughout (second order instead of first), and for what would gain energy otherwise. Only the direction of
/// u_t counts for sliding friction, so the mean's law is that of b_t + u_t.
fn is_at_middle(law: Law, first: usize, p: &DVector<f64>, before: &DVector<f64>, after: &DVector<f64>) -> bool {
    let rows = law.tangential(first);
    let sum = |f: &dyn Fn(usize) -> f64| rows.clone().map(f).sum::<f64>();
    if sum(&|r| p[r] * (before[r] + after[r])) > GAINS {
        return true;
    }
    let Law::Contact { .. } = law else { return false };
    let squares = sum(&|r| before[r] * before[r]) * sum(&|r| after[r] * after[r]);
    let along = sum(&|r| before[r] * after[r]);
    p[first] > 0.0 && squares > 1e-32 && along > 0.0 && along * along > 0.25 * squares
}

impl Solved {
    /// The energy that the impulses dissipate and that they give to moving planes, from the velocities of the
    /// surroundings before and after the step.
    pub fn works(&self, system: &System, before: &DVector<f64>) -> [f64; 2] {
        [-0.5 * self.p.dot(&(before + &self.u)), self.p.dot(&system.w)]
    }

    /// Is p inside its cone, so that the contact sticks?
    pub fn sticks(&self, system: &System, first: usize, law: Law) -> bool {
        let Law::Contact { mu } = law else { return false };
        let g = system.G[(first + 1, first + 1)].max(f64::MIN_POSITIVE);
        let [x, y] = [1, 2].map(|k| self.p[first + k] - self.u[first + k] / g);
        let radius = mu * self.p[first];
        x * x + y * y < radius * radius
    }
}

impl<'r> Impulses<'r> {
    /// None if nothing one-sided acts and `is_forced` is false. Stops are included if there is anything else.
    pub fn new(
        model: &'r Model,
        contacts: &'r Contacts<'r>,
        options: &Options,
        is_forced: bool,
    ) -> Result<Option<Self>, Error> {
        contacts.check(model)?;
        let is_dry = options.friction == Friction::Coulomb;
        let dry: Vec<usize> = (0..model.n()).filter(|&j| is_dry && model.friction[j] > 0.0).collect();
        if dry.is_empty() && contacts.is_empty() && !is_forced {
            return Ok(None);
        }
        let bounds = Bounds::of(model);
        let stops = (options.joint_limits == Policy::Respect).then(|| {
            let sides = super::stops::sides(&bounds);
            (bounds, sides)
        });
        let mut frames: Vec<FrameId> = contacts.points.iter().map(|point| point.frame).collect();
        frames.sort_unstable();
        frames.dedup();
        let (h, g) = (options.step(), options.gravity.unwrap_or(model.gravity()).norm());
        Ok(Some(Impulses {
            model,
            contacts,
            stops,
            dry,
            frames,
            reach: (g * h * h).max(NEAR),
            slowest: 0.0,
            warm: Vec::new(),
            anchors: BTreeMap::new(),
            carrying: Vec::new(),
            struck: Vec::new(),
            account: OneSidedAccount::default(),
            forces: vec![0.0; 3 * contacts.pairs()],
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
        let mut p = DVector::zeros(system.laws.iter().map(|law| law.rows()).sum());
        for &(key, first, law) in &system.rows {
            if let Ok(known) = self.warm.binary_search_by_key(&key, |(key, _)| *key) {
                (0..law.rows()).for_each(|k| p[first + k] = h * self.warm[known].1[k]);
            }
        }
        p
    }

    /// Solves for the impulses, from b (without restitution) and the velocities of the surroundings u₀ before the step.
    pub fn solve(
        &mut self,
        system: &mut System,
        mut b: DVector<f64>,
        before: &DVector<f64>,
        guess: &DVector<f64>,
    ) -> Solved {
        let original = b.clone();
        for &(key, first, _) in &system.rows {
            match key {
                Key::Contact(point, _) if before[first] < -self.slowest => {
                    b[first] += self.contacts.points[point].restitution * before[first];
                }
                // what opens at first must not be pushed: its mean velocity stays positive
                Key::Contact(..) | Key::Stop(..) => b[first] += before[first].max(0.0),
                _ => {}
            }
        }
        let tolerance = TOLERANCE * (1.0 + b.amax());
        let G = core::mem::replace(&mut system.G, DMatrix::zeros(0, 0));
        let mut problem = Problem { G, b, laws: core::mem::take(&mut system.laws) };
        let mut found = solve(&problem, guess, tolerance);
        self.account.add(&found);
        let mut shifted = vec![false; system.rows.len()];
        for _ in 0..SHIFTS {
            let u = &problem.G * &found.p + &original;
            let mut changes = false;
            for (row, &(_, first, law)) in system.rows.iter().enumerate() {
                if !shifted[row] && is_at_middle(law, first, &found.p, before, &u) {
                    for r in law.tangential(first) {
                        problem.b[r] += before[r];
                    }
                    (shifted[row], changes) = (true, true);
                }
            }
            if !changes {
                break;
            }
            found = solve(&problem, &found.p, tolerance);
            self.account.add(&found);
        }
        let u = &problem.G * &found.p + original;
        (system.G, system.laws) = (problem.G, problem.laws);
        Solved { p: found.p, u, residual: found.residual }
    }

    /// Remembers the impulses of a step of h seconds that counts.
    pub fn keep(&mut self, system: &System, solved: &Solved, h: f64) {
        self.account.keep(solved.residual, solved.p.len());
        let carried = core::mem::take(&mut self.carrying);
        self.warm.clear();
        self.forces.fill(0.0);
        for &(key, first, law) in &system.rows {
            let mut force = [0.0; 3];
            (0..law.rows()).for_each(|k| force[k] = solved.p[first + k] / h);
            self.warm.push((key, force));
            if force[0] > 0.0 && matches!(key, Key::Contact(..) | Key::Stop(..)) {
                self.carrying.push((key, solved.sticks(system, first, law)));
                if let (Key::Stop(k, side), true) = (key, carried.iter().all(|&(other, _)| other != key)) {
                    self.struck.push((k, side));
                }
            }
        }
        self.warm.sort_unstable_by_key(|(key, _)| *key);
        self.set_forces(system, &(&solved.p / h));
    }

    /// The contact forces in {s}, from those along the rows.
    pub fn set_forces(&mut self, system: &System, force: &DVector<f64>) {
        for &(key, axes) in &system.axes {
            let row = system.rows.iter().find(|(other, ..)| *other == key);
            let (Key::Contact(point, plane), Some(&(_, first, _))) = (key, row) else { continue };
            let total = axes[0] * force[first] + axes[1] * force[first + 1] + axes[2] * force[first + 2];
            let pair = point * self.contacts.planes.len() + plane;
            self.forces[3 * pair..3 * pair + 3].copy_from_slice(&total.0);
        }
    }

    /// The planes at a time.
    pub fn surfaces(&self, t: f64) -> Vec<Surface> {
        self.contacts.planes.iter().map(|plane| plane.at(t)).collect()
    }

    /// The configurations of the frames that carry contact points.
    fn poses(&self, theta: &[f64]) -> Vec<SE3> {
        self.frames.iter().map(|&frame| forward_kinematics(self.model, theta, frame)).collect()
    }

    fn pose_of(&self, poses: &[SE3], frame: FrameId) -> SE3 {
        self.frames.binary_search(&frame).map_or(SE3::identity(), |k| poses[k])
    }
}
