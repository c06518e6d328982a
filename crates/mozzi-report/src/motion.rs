//! A motion, by rows.

use crate::base64::{self, singles};
use crate::error::Error;
use crate::touches::Touches;
use mozzi::{Environment, Model, Wrench};
use mozzi_sim::Trajectory;
use serde_json::{Value, json};

/// The known data of a motion: a row for each time, row-major lists. Fields that are `None` are not shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// A short description.
    pub title: String,
    /// Times in seconds, not decreasing; two rows with the same time are a jump.
    pub t: Vec<f64>,
    /// θ, rows of nq.
    pub theta: Vec<f64>,
    /// θ̇, rows of n; likewise the following fields.
    pub dtheta: Option<Vec<f64>>,
    /// θ̈.
    pub ddtheta: Option<Vec<f64>>,
    /// τ.
    pub tau: Option<Vec<f64>>,
    /// The wrench that the end effector applies to the environment, in its own frame.
    pub tip_wrench: Option<Vec<Wrench>>,
    /// 𝒦, J.
    pub kinetic_energy: Option<Vec<f64>>,
    /// 𝒫, J.
    pub potential_energy: Option<Vec<f64>>,
    /// Energy error of the method, J: [`Trajectory::drift`].
    pub drift: Option<Vec<f64>>,
    /// The contacts of a simulation, with their forces and events.
    pub contacts: Option<Touches>,
}

impl Motion {
    /// The motion of a simulation.
    pub fn simulated(title: impl Into<String>, motion: &Trajectory) -> Self {
        Motion {
            title: title.into(),
            t: motion.t.clone(),
            theta: motion.theta.clone(),
            dtheta: Some(motion.dtheta.clone()),
            ddtheta: Some(motion.ddtheta.clone()),
            tau: Some(motion.tau.clone()),
            tip_wrench: None,
            kinetic_energy: Some(motion.energy.iter().map(|energy| energy.kinetic).collect()),
            potential_energy: Some(motion.energy.iter().map(|energy| energy.potential).collect()),
            drift: Some((0..motion.len()).map(|k| motion.drift(k)).collect()),
            contacts: None,
        }
    }

    /// Every s-th row, and the last: at most `at_most` rows, but at least two. See [`mozzi_sim::stride`].
    pub fn thinned(mut self, at_most: usize) -> Self {
        let rows = self.t.len();
        let stride = mozzi_sim::stride(rows, at_most);
        if stride > 1 {
            let is_kept = |row: usize| row.is_multiple_of(stride) || row + 1 == rows;
            thin(&mut self.t, rows, is_kept);
            thin(&mut self.theta, rows, is_kept);
            let lists = [&mut self.dtheta, &mut self.ddtheta, &mut self.tau];
            let energies = [&mut self.kinetic_energy, &mut self.potential_energy, &mut self.drift];
            lists.into_iter().chain(energies).flatten().for_each(|list| thin(list, rows, is_kept));
            self.tip_wrench.iter_mut().for_each(|list| thin(list, rows, is_kept));
            self.contacts.iter_mut().for_each(|contacts| contacts.thin(rows, is_kept));
        }
        self
    }

    /// Adds the energies of the positions and velocities: 𝒫, and 𝒦 if velocities are known.
    ///
    /// # Errors
    /// [`Error::Motion`] if the rows are not as long as this robot's.
    pub fn with_energies(mut self, model: &Model) -> Result<Self, Error> {
        self.check(model)?;
        let positions = || self.theta.chunks(model.nq().max(1));
        self.potential_energy = Some(positions().map(|theta| model.potential_energy(theta)).collect::<Result<_, _>>()?);
        if let Some(dtheta) = &self.dtheta {
            let rows = positions().zip(dtheta.chunks(model.n().max(1)));
            let kinetic = rows.map(|(theta, dtheta)| model.kinetic_energy(theta, dtheta));
            self.kinetic_energy = Some(kinetic.collect::<Result<_, _>>()?);
        }
        Ok(self)
    }

    pub(crate) fn check(&self, model: &Model) -> Result<(), Error> {
        let rows = self.t.len();
        let goes_on = |k: usize| self.t[k].is_finite() && (k == 0 || self.t[k] >= self.t[k - 1]);
        if let Some(k) = (0..rows).find(|&k| !goes_on(k)) {
            return Err(Error::Time { row: k + 1, t: self.t[k] });
        }
        let (nq, n) = (model.nq(), model.n());
        let columns = [
            ("theta", Some(&self.theta), nq),
            ("dtheta", self.dtheta.as_ref(), n),
            ("ddtheta", self.ddtheta.as_ref(), n),
            ("tau", self.tau.as_ref(), n),
            ("kinetic energy", self.kinetic_energy.as_ref(), 1),
            ("potential energy", self.potential_energy.as_ref(), 1),
            ("drift", self.drift.as_ref(), 1),
        ];
        for (what, values, width) in columns {
            let (expected, found) = (rows * width, values.map_or(rows * width, Vec::len));
            if found != expected || rows == 0 {
                return Err(Error::Motion { what, found, expected, rows, width });
            }
        }
        let wrenches = self.tip_wrench.as_ref().map_or(rows, Vec::len);
        if wrenches != rows {
            return Err(Error::Motion { what: "tip wrench", found: 6 * wrenches, expected: 6 * rows, rows, width: 6 });
        }
        if let Some((width, found)) = self.contacts.as_ref().map(Touches::widths) {
            for (what, found) in ["contact points", "contact forces"].into_iter().zip(found) {
                if found != rows * width {
                    return Err(Error::Motion { what, found, expected: rows * width, rows, width });
                }
            }
        }
        Ok(())
    }

    /// For each row and constraint the wrench in {s} about its origin, (m, f), that anchor {b} applies to {a}. None if
    /// rates or torques are not known, or nothing is constrained.
    fn constraint_wrenches(&self, model: &Model) -> Result<Option<Vec<f64>>, Error> {
        let (Some(dtheta), Some(ddtheta), Some(tau)) = (&self.dtheta, &self.ddtheta, &self.tau) else {
            return Ok(None);
        };
        if model.constraint_rows() == 0 {
            return Ok(None);
        }
        let (nq, n, mut found) = (model.nq(), model.n(), Vec::new());
        for (k, theta) in self.theta.chunks(nq).enumerate() {
            let row = |list: &'_ Vec<f64>| list[k * n..][..n].to_vec();
            let tip = self.tip_wrench.as_ref().map(|list| list[k]).zip(model.end_effector().ok());
            let applied: Vec<_> = tip.map(|(F, frame)| (frame, F)).into_iter().collect();
            let environment = Environment { applied: &applied, ..model.environment() };
            let motion = [theta, &row(dtheta), &row(ddtheta)];
            let lambda = model.constraint_forces(motion, &row(tau), &environment)?;
            let wrenches = model.constraint_wrenches(theta, lambda.as_slice())?;
            for ((_, F), [a, b]) in wrenches.into_iter().zip(model.constraint_anchors(theta)?) {
                let (m, f) = (a.R * F.m, a.R * F.f);
                found.extend(Wrench { m: m + b.p.cross(f), f }.to_array());
            }
        }
        Ok(Some(found))
    }

    pub(crate) fn to_json(&self, model: &Model) -> Result<Value, Error> {
        self.check(model)?;
        let list = |values: &Option<Vec<f64>>| values.as_deref().map(singles);
        let wrenches = self.tip_wrench.as_ref().map(|list| list.iter().flat_map(|F| F.to_array()).collect::<Vec<_>>());
        Ok(json!({
            "title": self.title,
            "t": base64::encode(&self.t.iter().flat_map(|t| t.to_le_bytes()).collect::<Vec<_>>()),
            "theta": singles(&self.theta),
            "dtheta": list(&self.dtheta),
            "ddtheta": list(&self.ddtheta),
            "tau": list(&self.tau),
            "tip_wrench": list(&wrenches),
            "constraint_wrenches": list(&self.constraint_wrenches(model)?),
            "kinetic_energy": list(&self.kinetic_energy),
            "potential_energy": list(&self.potential_energy),
            "drift": list(&self.drift),
            "contacts": self.contacts.as_ref().map(|contacts| contacts.to_json(model)),
        }))
    }
}

/// Selected rows of a table.
pub(crate) fn thin<T>(table: &mut Vec<T>, rows: usize, is_kept: impl Fn(usize) -> bool) {
    let (width, mut entry) = (table.len() / rows.max(1), 0);
    table.retain(|_| {
        entry += 1;
        is_kept((entry - 1) / width)
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi_sim::{Options, Zero};

    #[test]
    fn energies_are_those_of_the_simulation() {
        let model = mozzi_urdf::open("double_pendulum").and_then(mozzi_urdf::Loaded::build).expect("embedded");
        let fall = mozzi_sim::simulate(&model, &[1.0, 0.3], &[0.0; 2], Zero, &Options::new(0.1, 20)).expect("a motion");
        let whole = Motion::simulated("fall", &fall);
        let again = Motion { kinetic_energy: None, potential_energy: None, ..whole.clone() }.with_energies(&model);
        let again = again.expect("energies");
        let apart = |a: &Option<Vec<f64>>, b: &Option<Vec<f64>>| {
            let pairs = a.iter().flatten().zip(b.iter().flatten());
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        assert!(apart(&again.kinetic_energy, &whole.kinetic_energy) < 1e-12);
        assert!(apart(&again.potential_energy, &whole.potential_energy) < 1e-12);
    }

    #[test]
    fn a_thinned_motion_is_that_of_fewer_rows() {
        let model = mozzi_urdf::open("double_pendulum").and_then(mozzi_urdf::Loaded::build).expect("embedded");
        let fall = |record_every| {
            let options = Options { record_every, ..Options::new(0.1, 20) };
            Motion::simulated(
                "fall",
                &mozzi_sim::simulate(&model, &[1.0, 0.3], &[0.0; 2], Zero, &options).expect("a motion"),
            )
        };
        let wrenches = |rows: usize| (0..rows).map(|k| Wrench::from_array([k as f64; 6])).collect();
        let whole = Motion { tip_wrench: Some(wrenches(21)), ..fall(1) };
        assert_eq!(whole.clone().thinned(21), whole);
        let fewer = whole.thinned(5);
        let pushed = [0, 10, 20].map(|k| Wrench::from_array([f64::from(k); 6]));
        assert_eq!(fewer, Motion { tip_wrench: Some(pushed.to_vec()), ..fall(10) });
    }

    #[test]
    fn rows_of_another_robot_are_refused() {
        let model = mozzi_urdf::open("ur5").and_then(mozzi_urdf::Loaded::build).expect("embedded");
        let motion = Motion { t: vec![0.0, 1.0], theta: vec![0.0; 4], ..Motion::default() };
        let message = motion.to_json(&model).expect_err("too short").to_string();
        assert_eq!(message, "the motion has 4 numbers of theta, expected 12: 2 rows of 6");
        let motion = Motion { t: vec![0.0, -1.0], theta: vec![0.0; 12], ..Motion::default() };
        let message = motion.to_json(&model).expect_err("backwards").to_string();
        assert_eq!(message, "the motion's time is -1 s in row 2, expected times that do not decrease");
        assert!(Motion::default().to_json(&model).is_err());
    }
}
