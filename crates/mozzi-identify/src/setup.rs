//! The problem to fit, apart from the data: columns, base parameters, priors and bounds.

use crate::columns::{Columns, Kind};
use crate::compress::{Evidence, Pattern, stacked};
use crate::estimate::consistent::{Bound, Optimum, Problem};
use crate::estimate::least_squares::LeastSquares;
use crate::estimate::pseudo_inertia::Prior;
use crate::{Choice, Error};
use mozzi::{BaseParameters, Model};
use nalgebra::DMatrix;

/// Bounds that the data alone does not know.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Limits {
    /// The mass of all moving links, kg, and its standard deviation.
    pub total_mass: Option<[f64; 2]>,
    /// Unknowns by name, with their lowest and highest values.
    pub between: Vec<(String, [f64; 2])>,
    /// A box in the link's frame that contains its centre of mass, by link: lowest and highest corner, m.
    pub center_of_mass: Vec<(String, [[f64; 3]; 2])>,
}

/// The weight of a payload's prior relative to that of a link: the prior is a guess.
const GUESS: f64 = 0.01;

/// The problem to fit, apart from the data.
#[derive(Clone, Debug)]
pub struct Setup<'m> {
    /// The unknowns.
    pub columns: Columns<'m>,
    /// The columns of each force.
    pub pattern: Pattern,
    /// The combinations that some motion can determine.
    pub base: BaseParameters,
    /// The convex problem.
    pub problem: Problem,
    /// Names of bodies whose prior was massless or too thin, and was changed.
    pub repaired: Vec<String>,
    total_mass: Option<[f64; 2]>,
}

/// Both estimates from the same equations, with the same weights.
#[derive(Clone, Debug)]
pub struct Estimates {
    /// By least squares.
    pub least_squares: LeastSquares,
    /// The physically consistent estimate.
    pub consistent: Optimum,
}

impl<'m> Setup<'m> {
    /// For a robot, a choice of unknowns, the weight γ of the prior, and limits.
    ///
    /// # Errors
    /// [`Error::BadOption`] for a weight that is not positive or a limit of an unknown name; those of
    /// [`Columns::new`].
    pub fn new(model: &'m Model, choice: Choice, gamma: f64, limits: &Limits) -> Result<Self, Error> {
        if !(gamma > 0.0 && gamma.is_finite()) {
            let expected = "a positive number, such as 0.3".to_string();
            return Err(Error::BadOption { option: "the prior's weight", found: gamma.to_string(), expected });
        }
        if let Some([mass, deviation]) = limits.total_mass
            && !(mass > 0.0 && deviation > 0.0 && mass.is_finite() && deviation.is_finite())
        {
            let found = format!("{mass} kg with a deviation of {deviation} kg");
            return Err(Error::BadOption { option: "the total mass", found, expected: "two positive numbers".into() });
        }
        let columns = Columns::new(model, choice)?;
        let (P, n) = (columns.count(), model.n().max(1));
        let names = columns.unknowns.iter().map(|unknown| unknown.name.clone()).collect();
        let base = BaseParameters::of_columns(&stacked(&columns, 2 * P / n + 10)?, names);
        let pattern = Pattern::new(&columns)?;
        let (mut bodies, mut repaired) = (Vec::new(), Vec::new());
        let start = columns.prior();
        for first in columns.bodies() {
            let name = columns.unknowns[first].name.trim_end_matches(".m").to_string();
            let is_payload = matches!(columns.unknowns[first].kind, Kind::Payload(_));
            // of a payload nothing is known: a ball of 1 kg and 5 cm
            let ball = [1.0, 0.0, 0.0, 0.0, 1e-3, 0.0, 0.0, 1e-3, 0.0, 1e-3];
            let prior = Prior::new(if is_payload { &ball } else { &start[first..first + 10] }, &name)?;
            if prior.is_repaired {
                repaired.push(name);
            }
            bodies.push((first, prior, if is_payload { GUESS } else { 1.0 }));
        }
        let bounds = bounds(&columns, limits)?;
        // of either sign where some motion tells them from the links, and no bound is given
        let is_base = |k: usize| base.columns.contains(&k);
        let is_bound = |k: usize| bounds.iter().any(|bound| bound.terms.iter().any(|&(of, _)| of == k));
        let has_place = |k: usize| match columns.unknowns[k].kind {
            Kind::Armature(of) => columns.is_of_joint(of),
            kind => matches!(kind, Kind::Viscous(_)),
        };
        let is_split = |k: &usize| columns.choice.is_apparent() && has_place(*k) && is_base(*k) && !is_bound(*k);
        let (split, positive) =
            (0..P).filter(|&k| columns.unknowns[k].kind.is_positive()).partition::<Vec<_>, _>(is_split);
        let is_apparent = |k: usize| matches!(columns.unknowns[k].kind, Kind::Apparent(_));
        let pinned = (0..P).filter(|&k| is_apparent(k) && !is_base(k)).collect();
        let problem = Problem { bodies, positive, split, pinned, bounds, gamma, start };
        Ok(Setup { columns, pattern, base, problem, repaired, total_mass: limits.total_mass })
    }

    /// Fits both estimates. `stop` ends the second one early, with the best so far.
    ///
    /// # Errors
    /// Those of [`LeastSquares::new`] and [`Problem::solve`].
    pub fn fit(&self, evidence: &Evidence, stop: &dyn Fn() -> bool) -> Result<Estimates, Error> {
        let least_squares = LeastSquares::new(evidence, &self.base)?;
        let mut data = evidence.weighted(&least_squares.sigma);
        if let Some([mass, deviation]) = self.total_mass {
            let P = self.columns.count();
            let mut row = DMatrix::zeros(1, P + 1);
            // the data's cost is that of one independent sample
            let deviation = deviation * (evidence.samples() as f64 * evidence.independent).max(1.0).sqrt();
            self.problem.bodies.iter().for_each(|(first, ..)| row[(0, *first)] = 1.0 / deviation);
            row[(0, P)] = mass / deviation;
            data.push(row, 0);
        }
        let mut consistent = self.problem.solve(&data, stop)?;
        let independent = (evidence.samples() as f64 * evidence.independent).max(1.0).sqrt();
        consistent.deviations.iter_mut().for_each(|d| *d /= independent);
        self.split(evidence, &mut consistent);
        Ok(Estimates { least_squares, consistent })
    }
}

impl Setup<'_> {
    /// The row of an unknown's base parameter, if no others are in it: the motion can determine the unknown by itself.
    pub fn alone(&self, k: usize) -> Option<usize> {
        /// Smaller factors in a combination are rounding.
        const THERE: f64 = 1e-9;
        let row = self.base.columns.iter().position(|&column| column == k)?;
        let parts = self.base.combination.row(row).iter().filter(|x| x.abs() > THERE).count();
        (parts == 1).then_some(row)
    }

    /// Leaves the positive part of armature and damping to the robot. Where damping is negative, the robot's Coulomb
    /// friction is the best without it: μ + d ⟨θ̇ c⟩/⟨c²⟩ with c = tanh(θ̇/w).
    fn split(&self, evidence: &Evidence, optimum: &mut Optimum) {
        let columns = &self.columns;
        for k in (0..columns.count()).filter(|&k| matches!(columns.unknowns[k].kind, Kind::Apparent(_))) {
            optimum.apparent[k] = std::mem::take(&mut optimum.x[k]);
        }
        for &k in self.problem.split.iter().filter(|&&k| optimum.x[k] < 0.0).collect::<Vec<_>>() {
            let d = std::mem::take(&mut optimum.x[k]);
            optimum.apparent[k] = d;
            let Kind::Viscous(of) = columns.unknowns[k].kind else { continue };
            let Some(c) = columns.index(Kind::Coulomb(of + 1)) else { continue };
            let row = columns.row_of(of);
            let place = |k: usize| self.pattern.0[row].iter().position(|&column| column == k);
            let (Some(v), Some(w)) = (place(k), place(c)) else { continue };
            let R = &evidence.forces[row].R;
            let square = R.column(w).norm_squared();
            if square > 0.0 {
                let mu = (optimum.x[c] + d * R.column(v).dot(&R.column(w)) / square).max(0.0);
                optimum.apparent[c] = optimum.x[c] - mu;
                optimum.x[c] = mu;
            }
        }
    }
}

fn bounds(columns: &Columns<'_>, limits: &Limits) -> Result<Vec<Bound>, Error> {
    let find = |name: &str| {
        let known = columns.unknowns.iter().position(|unknown| unknown.name == name);
        known.ok_or_else(|| Error::BadOption {
            option: "a limit",
            found: format!("of `{name}`"),
            expected: "the name of an estimated parameter, such as `link.m`".into(),
        })
    };
    let mut all = Vec::new();
    for (name, [low, high]) in &limits.between {
        if !(low < high) {
            return Err(Error::BadOption {
                option: "a limit",
                found: format!("{low} to {high} of `{name}`"),
                expected: "a lower number first".into(),
            });
        }
        let (k, scale) = (find(name)?, (high - low).min(1e6));
        if low.is_finite() {
            all.push(Bound { name: format!("{name} > {low}"), terms: vec![(k, 1.0)], least: *low, scale });
        }
        if high.is_finite() {
            all.push(Bound { name: format!("{name} < {high}"), terms: vec![(k, -1.0)], least: -*high, scale });
        }
    }
    for (link, [low, high]) in &limits.center_of_mass {
        let m = find(&format!("{link}.m"))?;
        for axis in 0..3 {
            let (mc, scale) = (m + 1 + axis, columns.unknowns[m].prior.max(0.1) * (high[axis] - low[axis]));
            let name = format!("the centre of mass of {link} in its box");
            all.push(Bound { name: name.clone(), terms: vec![(mc, 1.0), (m, -low[axis])], least: 0.0, scale });
            all.push(Bound { name, terms: vec![(m, high[axis]), (mc, -1.0)], least: 0.0, scale });
        }
    }
    Ok(all)
}

/// Constraint forces Aᵀλ are not in a log, and the equations do not have them.
pub(crate) fn without_constraints(model: &Model) -> Result<(), Error> {
    match model.constraint_rows() {
        0 => Ok(()),
        rows => Err(Error::BadOption {
            option: "the robot",
            found: format!("with {rows} constraint rows, whose forces Aᵀλ are not in a log"),
            expected: "a robot without constraints; mimic joints are possible".into(),
        }),
    }
}
