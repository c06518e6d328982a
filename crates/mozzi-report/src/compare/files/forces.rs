//! M, gravity and torques of both robots at the same states.

use super::number::digits;
use crate::compare::Result;
use crate::compare::state::State;
use crate::compare::terms::Numbers;
use mozzi::random::Random;
use mozzi::{Description, Freedom, Model};

/// The robots at random states, in the first one's order.
pub struct States {
    model: Model,
    states: Vec<State>,
}

/// The difference of an entry of a quantity: the largest, or one that is a far larger part of the joint's own numbers.
#[derive(Clone, Debug, Default)]
pub struct Gap {
    /// The joints of the entry.
    pub joints: Vec<String>,
    /// N m or N.
    pub unit: &'static str,
    pub most: f64,
    /// The largest number of these joints.
    pub scale: f64,
    /// The largest part that a difference is of its joints' numbers.
    pub part: f64,
}

impl Gap {
    /// A torque in N is a force.
    pub fn name(&self, what: &str) -> String {
        if self.unit == "N" { what.replace("torque", "force") } else { what.to_string() }
    }
}

/// Effect of a change on gravity torques, or else on torques, or else on M.
pub fn effect([M, g, tau]: &Gaps) -> Option<String> {
    let counts = |gap: &Gap| gap.part > 1e-12;
    let of = |gap: &Gap, what: &str| {
        let joint = gap.joints.first()?;
        Some(format!("{} of {joint} by up to {} {}", gap.name(what), digits(gap.most), gap.unit))
    };
    if counts(g) {
        return of(g, "gravity torque");
    }
    if counts(tau) {
        return of(tau, "torque");
    }
    counts(M).then(|| format!("M[{}] by up to {}", M.joints.join(", "), digits(M.most)))
}

/// M, g and τ.
pub type Gaps = [Gap; 3];

impl States {
    /// States of the first robot, coupled as it is.
    pub fn random(robot: &Description, freed: &Description, count: usize, seed: u64) -> Result<Self> {
        let model = freed.clone().build()?;
        let mut random = Random(seed);
        let states = (0..count).map(|_| State::random(robot, &model, &mut random)).collect();
        Ok(States { model, states })
    }

    /// At each state; joints in the order of the first robot.
    pub fn numbers(&self, robot: &Description) -> Result<Vec<Numbers>> {
        let model = robot.clone().build()?;
        let environment = model.environment();
        let base = |model: &Model| if model.is_floating() { 6 } else { 0 };
        let places: Vec<_> = model.joint_names().map(str::to_string).zip(model.places().to_vec()).collect();
        // the index here of each of the first robot's velocities
        let mut rows: Vec<usize> = (0..base(&self.model).min(base(&model))).collect();
        for (name, _) in self.model.joint_names().zip(self.model.places()) {
            rows.extend(places.iter().filter(|(known, _)| known == name).flat_map(|(_, place)| place.velocities()));
        }
        let mut all = Vec::new();
        for state in &self.states {
            let mut here = State::home(&model);
            for (name, there) in self.model.joint_names().zip(self.model.places()) {
                let Some((_, place)) = places.iter().find(|(known, _)| known == name) else { continue };
                here.theta[place.positions()].copy_from_slice(&state.theta[there.positions()]);
                here.dtheta[place.velocities()].copy_from_slice(&state.dtheta[there.velocities()]);
                here.ddtheta[place.velocities()].copy_from_slice(&state.ddtheta[there.velocities()]);
            }
            let State { theta, dtheta, ddtheta } = here;
            let M = model.mass_matrix(&theta)?;
            let g = model.gravity_forces(&theta)?;
            let h = model.bias_forces(&theta, &dtheta, &environment)?;
            let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment)?;
            all.push(Numbers {
                M: M.select_rows(&rows).select_columns(&rows),
                g: g.select_rows(&rows),
                h: h.select_rows(&rows),
                tau: tau.select_rows(&rows),
            });
        }
        Ok(all)
    }

    /// The names of the first robot's velocities.
    pub fn names(&self) -> Vec<String> {
        let base = (0..if self.model.is_floating() { 6 } else { 0 }).map(|_| "the base".to_string());
        let own = self.model.joint_names().zip(self.model.places());
        base.chain(own.flat_map(|(name, place)| vec![format!("`{name}`"); place.freedom.velocities()])).collect()
    }

    /// The units of the forces.
    fn units(&self) -> Vec<&'static str> {
        let of = |freedom: Freedom, slides: bool| match freedom {
            Freedom::Free => vec!["N m", "N m", "N m", "N", "N", "N"],
            freedom => vec![if slides { "N" } else { "N m" }; freedom.velocities()],
        };
        let base = if self.model.is_floating() { of(Freedom::Free, false) } else { Vec::new() };
        let own = self.model.joints().zip(self.model.places());
        let own = own.flat_map(|(joint, place)| of(place.freedom, joint.kind.name() == "prismatic"));
        base.into_iter().chain(own).collect()
    }

    /// The largest differences between two robots' numbers.
    pub fn gaps(&self, a: &[Numbers], b: &[Numbers]) -> Gaps {
        let (names, units) = (self.names(), self.units());
        let n = a.iter().chain(b).map(|x| x.g.len()).min().unwrap_or(0).min(names.len());
        // each joint's largest numbers
        let largest = |of: &dyn Fn(&Numbers, usize) -> f64| -> Vec<f64> {
            let most = |i| a.iter().chain(b).map(|x| of(x, i).abs()).fold(0.0, f64::max);
            let own: Vec<f64> = (0..n).map(most).collect();
            let least = LEAST * own.iter().copied().fold(0.0, f64::max);
            own.into_iter().map(|x| x.max(least)).collect()
        };
        let inertia = largest(&|x, i| x.M[(i, i)]);
        let torque = largest(&|x, i| x.tau[i]);
        // gravity that is 0 in both up to rounding is compared with the torques
        let gravity: Vec<f64> = largest(&|x, i| x.g[i]).iter().zip(&torque).map(|(g, tau)| g.max(*tau)).collect();
        let gap = |of: &dyn Fn(&Numbers, usize, usize) -> f64, scale: &dyn Fn(usize, usize) -> f64, pairs: bool| {
            let (mut most, mut worst) = (Gap::default(), Gap::default());
            for (x, y) in a.iter().zip(b) {
                for (i, j) in (0..n).flat_map(|i| (if pairs { 0 } else { i }..=i).map(move |j| (i, j))) {
                    let (gap, scale) = ((of(x, i, j) - of(y, i, j)).abs(), scale(i, j));
                    let part = if gap == 0.0 { 0.0 } else { gap / scale };
                    let joints =
                        || if pairs { vec![names[i].clone(), names[j].clone()] } else { vec![names[i].clone()] };
                    let new = || Gap { joints: joints(), unit: units[i], most: gap, scale, part };
                    if most.joints.is_empty() || !(gap <= most.most) {
                        most = new();
                    }
                    if worst.joints.is_empty() || !(part <= worst.part) {
                        worst = new();
                    }
                }
            }
            let part = worst.part;
            if most.part < 0.1 * part { worst } else { Gap { part, ..most } }
        };
        [
            gap(&|x, i, j| x.M[(i, j)], &|i, j| (inertia[i] * inertia[j]).sqrt(), true),
            gap(&|x, i, _| x.g[i], &|i, _| gravity[i], false),
            gap(&|x, i, _| x.tau[i], &|i, _| torque[i], false),
        ]
    }
}

/// Smaller numbers than this part of the largest are rounding errors of it.
const LEAST: f64 = 1e-5;

/// True if no difference is larger than this part of its joints' largest number.
pub fn agree(gaps: &Gaps, tolerance: f64) -> bool {
    gaps.iter().all(|gap| gap.part <= tolerance)
}

/// As [`agree`], of M and gravity alone.
pub fn agree_at_rest(gaps: &Gaps, tolerance: f64) -> bool {
    gaps[..2].iter().all(|gap| gap.part <= tolerance)
}
