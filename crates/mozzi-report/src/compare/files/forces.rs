//! M, gravity and torques of both robots at the same states.

use crate::compare::Result;
use crate::compare::state::State;
use crate::compare::terms::Numbers;
use mozzi::random::Random;
use mozzi::{Description, Model};

/// The robots at random states, in the first one's order.
pub struct States {
    model: Model,
    states: Vec<State>,
}

/// The largest difference of an entry, and the size of that quantity.
#[derive(Clone, Debug, Default)]
pub struct Gap {
    /// The joints of the entry.
    pub joints: Vec<String>,
    pub most: f64,
    pub scale: f64,
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

    /// The unit of a joint's force.
    pub fn unit(&self, joint: &str) -> &'static str {
        let slides = |name: &str| {
            self.model.joints().any(|one| format!("`{}`", one.name) == name && one.kind.name() == "prismatic")
        };
        if slides(joint) { "N" } else { "N m" }
    }

    /// The largest differences between two robots' numbers.
    pub fn gaps(&self, a: &[Numbers], b: &[Numbers]) -> Gaps {
        let names = self.names();
        let mut gaps = Gaps::default();
        let add = |gap: &mut Gap, joints: &[usize], x: f64, y: f64| {
            gap.scale = gap.scale.max(x.abs()).max(y.abs());
            if !((x - y).abs() <= gap.most) {
                gap.most = (x - y).abs();
                gap.joints = joints.iter().filter_map(|&k| names.get(k).cloned()).collect();
            }
        };
        for (x, y) in a.iter().zip(b) {
            let n = x.g.len().min(y.g.len());
            for i in 0..n {
                for j in 0..=i {
                    add(&mut gaps[0], &[i, j], x.M[(i, j)], y.M[(i, j)]);
                }
                add(&mut gaps[1], &[i], x.g[i], y.g[i]);
                add(&mut gaps[2], &[i], x.tau[i], y.tau[i]);
            }
        }
        gaps
    }
}

/// True if no difference is larger than this part of the quantity's largest number.
pub fn agree(gaps: &Gaps, tolerance: f64) -> bool {
    agree_at_rest(gaps, tolerance) && within(&gaps[2], tolerance, 0.0)
}

/// As [`agree`], of M and gravity alone.
pub fn agree_at_rest(gaps: &Gaps, tolerance: f64) -> bool {
    // gravity that is 0 in both up to rounding is compared with the torques
    within(&gaps[0], tolerance, 0.0) && within(&gaps[1], tolerance, gaps[2].scale)
}

fn within(gap: &Gap, tolerance: f64, scale: f64) -> bool {
    gap.most <= tolerance * gap.scale.max(scale)
}
