//! M, g, h and τ at the states, and the difference between two sides.

use crate::compare::Result;
use crate::compare::convention::{Convention, velocity_names};
use crate::compare::question::Question;
use crate::compare::state::State;
use crate::compare::terms::Numbers;
use mozzi::accuracy::{TermSizes, normalized_error};
use mozzi::{Description, Place};
use nalgebra::DVector;

/// The tolerance in ε of the size of the terms. Rounding, including that of files' digits through quaternions and
/// eigenvectors, stays a hundred times below it; a wrong digit in a file is a thousand times above it.
pub const BOUND: f64 = 1e6;

pub const QUANTITIES: [&str; 4] = ["M", "g", "h", "τ"];

/// At all states, in the order of these joints.
#[derive(Clone, Debug)]
pub struct Side {
    pub names: Vec<String>,
    pub states: Vec<Numbers>,
}

/// The largest normalised error of M, g, h and τ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors(pub [f64; 4]);

impl Errors {
    pub fn agree(&self) -> bool {
        self.0.iter().all(|error| *error <= BOUND)
    }

    pub fn worst(&self) -> f64 {
        self.0.iter().fold(0.0, |m: f64, &x| if x > m || x.is_nan() { x } else { m })
    }
}

/// An entry that differs.
#[derive(Clone, Debug)]
pub struct Entry {
    pub quantity: &'static str,
    pub state: usize,
    /// The row's joint; for M also the column's.
    pub joints: Vec<String>,
    pub mozzi: f64,
    pub theirs: f64,
}

impl Side {
    /// mozzi's, in the coordinates of a library.
    pub fn of(robot: &Description, question: &Question, library: &str) -> Result<Self> {
        let model = robot.clone().build()?;
        let (convention, environment) = (Convention::new(library, &model)?, model.environment());
        let base = model.is_floating().then(|| velocity_names("base", 6));
        let joints: Vec<(&str, &Place)> = model.joint_names().zip(model.places()).collect();
        let own = joints.iter().map(|(name, place)| velocity_names(name, place.freedom.velocities()));
        let names = base.into_iter().chain(own).flatten().collect();
        let asked: Vec<(&Place, &Place)> =
            joints.iter().filter_map(|&(name, place)| Some((place, question.place(name)?))).collect();
        let numbers = |state: &State| {
            let mut here = State::home(&model); // a floating base is at rest
            for (place, there) in asked.iter().filter(|(place, there)| place.freedom == there.freedom) {
                here.theta[place.positions()].copy_from_slice(&state.theta[there.positions()]);
                here.dtheta[place.velocities()].copy_from_slice(&state.dtheta[there.velocities()]);
                here.ddtheta[place.velocities()].copy_from_slice(&state.ddtheta[there.velocities()]);
            }
            let State { theta, dtheta, ddtheta } = here;
            let own = Numbers {
                M: model.mass_matrix(&theta)?,
                g: model.gravity_forces(&theta)?,
                h: model.bias_forces(&theta, &dtheta, &environment)?,
                tau: model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment)?,
            };
            convention.numbers(&theta, &dtheta, &own)
        };
        let states = question.states.iter().map(numbers).collect::<Result<_>>()?;
        Ok(Side { names, states })
    }
}

/// Two sides, restricted to the joints that both have.
pub struct Pair<'a> {
    mozzi: &'a Side,
    theirs: &'a Side,
    question: &'a Question,
    /// The indices of the common joints on either side.
    common: Vec<(usize, usize)>,
}

impl<'a> Pair<'a> {
    pub fn new(mozzi: &'a Side, theirs: &'a Side, question: &'a Question) -> Self {
        let place = |(k, name): (usize, &String)| Some((mozzi.names.iter().position(|known| known == name)?, k));
        let mut common: Vec<(usize, usize)> = theirs.names.iter().enumerate().filter_map(place).collect();
        common.sort_unstable(); // "first" is mozzi's first
        Pair { mozzi, theirs, question, common }
    }

    /// Both sides' entries of each quantity at a state, with the size of its terms.
    fn values(&self, state: usize) -> [(Vec<f64>, Vec<f64>, f64); 4] {
        let (mine, theirs) = (&self.mozzi.states[state], &self.theirs.states[state]);
        let vector = |a: &DVector<f64>, b: &DVector<f64>| -> (Vec<f64>, Vec<f64>) {
            self.common.iter().map(|&(i, j)| (a[i], b[j])).unzip()
        };
        let cells = self.common.iter().flat_map(|&(i, j)| self.common.iter().map(move |&(k, l)| ((i, k), (j, l))));
        let M: (Vec<f64>, Vec<f64>) = cells.map(|(a, b)| (mine.M[a], theirs.M[b])).unzip();
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let (g, h, tau) = (vector(&mine.g, &theirs.g), vector(&mine.h, &theirs.h), vector(&mine.tau, &theirs.tau));
        let at = &self.question.states[state];
        let sizes = TermSizes::new(largest(&M.1), largest(&g.1), &at.dtheta, &at.ddtheta);
        [(M.0, M.1, 0.0), (g.0, g.1, 0.0), (h.0, h.1, sizes.bias_forces), (tau.0, tau.1, sizes.inverse_dynamics)]
    }

    pub fn errors(&self) -> Errors {
        let mut worst = [0.0_f64; 4];
        for state in 0..self.mozzi.states.len().min(self.theirs.states.len()) {
            for (k, (mine, theirs, terms)) in self.values(state).iter().enumerate() {
                let error = normalized_error(mine, theirs, *terms);
                worst[k] = if error > worst[k] || error.is_nan() { error } else { worst[k] };
            }
        }
        Errors(worst)
    }

    /// The first entry that differs.
    pub fn first(&self) -> Option<Entry> {
        let n = self.common.len();
        let name = |k: usize| self.mozzi.names[self.common[k].0].clone();
        for state in 0..self.mozzi.states.len().min(self.theirs.states.len()) {
            for (quantity, (mine, theirs, terms)) in self.values(state).iter().enumerate() {
                let scale = theirs.iter().fold(*terms, |m, x| m.max(x.abs()));
                let differs = |k: &usize| !(normalized_error(&[mine[*k]], &[theirs[*k]], scale) <= BOUND);
                if let Some(k) = (0..mine.len()).find(differs) {
                    let joints = if quantity == 0 { vec![name(k / n), name(k % n)] } else { vec![name(k)] };
                    let quantity = QUANTITIES[quantity];
                    return Some(Entry { quantity, state, joints, mozzi: mine[k], theirs: theirs[k] });
                }
            }
        }
        None
    }
}
