//! Quantities that divide, as fractions: by the adjugate of [M Aᵀ; A 0], whose entries are polynomials. Without A it is
//! that of M; with a task's Jacobian for A the lower right block of the inverse is −Λ.

use crate::constrained::{self, Parts};
use crate::error::{DIVIDES, Error, MOST_VELOCITIES};
use crate::fraction::Fraction;
use crate::kernel::{Kernel, check_fault};
use crate::minors::Minors;
use crate::polynomial::Polynomial;
use crate::proof::random_positions;
use crate::symbol::{Symbol, with_table};
use mozzi::quantities::{
    BiasForces, BodyJacobian, BodyJacobianRate, InverseDynamics, MassMatrix, Query, SpaceJacobian, SpaceJacobianRate,
};
use mozzi::random::Random;
use mozzi::{Model, Scalar, TaskFrame};

/// Accelerations of joint forces, by three kernels.
const FORWARD_DYNAMICS: [&str; 3] =
    ["forward_dynamics", "forward_dynamics_by_mass_matrix", "forward_dynamics_by_inverse_dynamics"];

/// True if a quantity that divides is derived as a fraction.
pub fn is_fraction(quantity: &str) -> bool {
    FORWARD_DYNAMICS.contains(&quantity)
        || ["mass_matrix_inverse", "task_space_dynamics", constrained::QUANTITY].contains(&quantity)
}

/// Refuses quantities and robots whose inverses are not derived.
pub(crate) fn check_inverse(quantity: &'static str, velocities: usize) -> Result<(), Error> {
    match (is_fraction(quantity), velocities > MOST_VELOCITIES) {
        (false, _) => Err(Error::NotPolynomial { quantity, what: DIVIDES.into() }),
        (_, true) => Err(Error::InverseTooLong { quantity, velocities }),
        _ => Ok(()),
    }
}

/// A robot in symbols with the file's numbers.
pub(crate) struct Robot<'a> {
    pub model: &'a Model,
    pub symbolic: &'a Model<Symbol>,
    pub are_fractions: bool,
}

impl Robot<'_> {
    /// The first output of a quantity.
    fn output<'q>(&self, query: impl Into<Query<'q>>, inputs: &[Vec<Symbol>]) -> Result<Vec<Symbol>, Error> {
        let query = query.into();
        let found = Kernel::new(&query, self.symbolic, None)?.outputs(inputs).swap_remove(0);
        check_fault(query.name())?;
        Ok(found)
    }

    /// The outputs of a quantity that divides.
    pub fn fractions(&self, query: &Query, inputs: &[Vec<Symbol>]) -> Result<Vec<Fraction>, Error> {
        let (quantity, n) = (query.name(), self.model.n());
        let M = self.output(MassMatrix, &inputs[..1])?;
        match quantity {
            "mass_matrix_inverse" => {
                let mut solved = Solved::new(quantity, n, &M, &[])?;
                let inverse = (0..n * n).map(|k| solved.minors.adjugate(k / n, k % n)).collect();
                Ok(vec![solved.fraction(quantity, inverse, self.are_fractions)?])
            }
            constrained::QUANTITY => Parts::new(self)?.fractions(inputs, self.are_fractions),
            "task_space_dynamics" => self.task(query, inputs, &M),
            _ => {
                let still = vec![Symbol::zero(); n];
                let bias = self.output(InverseDynamics, &[inputs[0].clone(), inputs[1].clone(), still])?;
                let forces: Vec<Symbol> = inputs[2].iter().zip(&bias).map(|(&tau, &h)| tau - h).collect();
                let mut solved = Solved::new(quantity, n, &M, &[])?;
                let entries = (0..n).map(|i| solved.row(i, &forces)).collect();
                Ok(vec![solved.fraction(quantity, entries, self.are_fractions)?])
            }
        }
    }

    /// Λ and η: [M Jᵀ; J 0] (θ̈, −𝓕) = (−h, 𝒱̇ − J̇θ̇).
    fn task(&self, query: &Query, inputs: &[Vec<Symbol>], M: &[Symbol]) -> Result<Vec<Fraction>, Error> {
        let (quantity, n, subject) = (query.name(), self.model.n(), query.subject);
        let Some(frame) = subject.frame else { return Err(Error::Singular { quantity, what: "no frame".into() }) };
        let (J, dJ) = match subject.coordinates {
            TaskFrame::Body => (Query::from(BodyJacobian), Query::from(BodyJacobianRate)),
            TaskFrame::Space => (Query::from(SpaceJacobian), Query::from(SpaceJacobianRate)),
        };
        if let Some(what) = dependent_rows(self.model, query)? {
            return Err(Error::Singular { quantity, what });
        }
        let J = self.output(J.of(frame), &inputs[..1])?;
        let dJ = self.output(dJ.of(frame), inputs)?;
        let rows: Vec<Symbol> = subject.rows.iter().flat_map(|&row| J[row * n..][..n].to_vec()).collect();
        let h = self.output(BiasForces, &[inputs[0].clone(), inputs[1].clone()])?;
        let rate = |&row: &usize| (0..n).fold(Symbol::zero(), |sum, j| sum + dJ[row * n + j] * inputs[1][j]);
        let right: Vec<Symbol> = h.into_iter().chain(subject.rows.iter().map(rate)).collect();
        let mut solved = Solved::new(quantity, n, M, &rows)?;
        let k = subject.rows.len();
        let Lambda = (0..k * k).map(|at| -solved.minors.adjugate(n + at / k, n + at % k)).collect();
        let eta = (0..k).map(|i| solved.row(n + i, &right)).collect();
        let Lambda = solved.fraction(quantity, Lambda, self.are_fractions)?;
        Ok(vec![Lambda, solved.fraction(quantity, eta, self.are_fractions)?])
    }
}

/// A sentence if the rows of a task's Jacobian are dependent in every configuration, with rows that are not.
///
/// # Errors
/// [`mozzi::Error`] if the frame belongs to another model.
pub fn dependent_rows(model: &Model, query: &Query) -> Result<Option<String>, mozzi::Error> {
    const NAMES: [&str; 6] = ["wx", "wy", "wz", "vx", "vy", "vz"];
    let (Some(frame), rows) = (query.subject.frame, query.subject.rows) else { return Ok(None) };
    let J = match query.subject.coordinates {
        TaskFrame::Body => Query::from(BodyJacobian),
        TaskFrame::Space => Query::from(SpaceJacobian),
    };
    let (n, theta) = (model.n(), random_positions(model, &mut Random(5)));
    let J = model.compute(J.of(frame), &[&theta], &model.environment())?.swap_remove(0);
    let independent = |rows: &[usize]| independent(rows, |row| J[row * n..][..n].to_vec());
    if independent(rows).len() == rows.len() {
        return Ok(None);
    }
    let mut better = independent(&[3, 4, 5, 0, 1, 2]);
    better.sort_unstable();
    let list = |rows: &[usize]| rows.iter().map(|&row| NAMES[row]).collect::<Vec<_>>().join(",");
    Ok(Some(format!(
        "the rows {} of J are dependent in every configuration, so J M⁻¹Jᵀ has no inverse. Expected are rows that \
         the robot can move independently, such as {}",
        list(rows),
        list(&better)
    )))
}

/// Those of these rows that do not depend on the ones before.
fn independent(rows: &[usize], row: impl Fn(usize) -> Vec<f64>) -> Vec<usize> {
    let (mut kept, mut units): (Vec<usize>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    for &k in rows {
        let mut rest = row(k);
        let size = dot(&rest, &rest).sqrt();
        for unit in &units {
            let along = dot(&rest, unit);
            rest.iter_mut().zip(unit).for_each(|(x, u)| *x -= along * u);
        }
        let left = dot(&rest, &rest).sqrt();
        if left > 1e-9 * size.max(1e-6) {
            units.push(rest.iter().map(|x| x / left).collect());
            kept.push(k);
        }
    }
    kept
}

/// [M Aᵀ; A 0] with its determinant.
pub(crate) struct Solved {
    minors: Minors,
    /// Whether A has an odd number of rows: then the determinant is negative.
    is_odd: bool,
    denominator: Symbol,
    factors: Vec<Polynomial>,
}

impl Solved {
    pub fn new(quantity: &'static str, n: usize, M: &[Symbol], A: &[Symbol]) -> Result<Self, Error> {
        let mut minors = Minors::saddle(n, M, A);
        let denominator = minors.determinant();
        check_fault(quantity)?;
        if denominator == Symbol::zero() {
            let what = match A.is_empty() {
                true => "the mass matrix is singular in every configuration: a joint moves no inertia",
                false => {
                    "A M⁻¹Aᵀ is singular in every configuration: rows of the constraints are dependent, so λ is not \
                     unique. Expected are constraints without redundant rows"
                }
            };
            return Err(Error::Singular { quantity, what: what.into() });
        }
        // factors of determinants: entries, and the whole
        let mut factors = vec![denominator.polynomial()];
        for p in minors.entries().iter().map(|x| x.polynomial()) {
            if !p.is_zero() && !factors.contains(&p) && !factors.contains(&p.negated()) {
                factors.push(p);
            }
        }
        let is_odd = A.len().checked_div(n).is_some_and(|rows| rows % 2 == 1);
        Ok(Solved { minors, is_odd, denominator, factors })
    }

    /// A row of the adjugate times a vector.
    pub fn row(&mut self, i: usize, vector: &[Symbol]) -> Symbol {
        let mut sum = Symbol::zero();
        for (k, &x) in vector.iter().enumerate().filter(|(_, x)| **x != Symbol::zero()) {
            sum += self.minors.adjugate(i, k) * x;
        }
        sum
    }

    /// Entries over the determinant.
    pub fn fraction(
        &self,
        quantity: &'static str,
        entries: Vec<Symbol>,
        are_fractions: bool,
    ) -> Result<Fraction, Error> {
        check_fault(quantity)?;
        let signed = |x: &Symbol| if self.is_odd { (-*x).polynomial() } else { x.polynomial() };
        let numerators: Vec<Polynomial> = entries.iter().map(signed).collect();
        let fraction = Fraction { numerators, denominator: signed(&self.denominator) };
        Ok(with_table(|table| fraction.reduced(table, &self.factors, are_fractions)))
    }
}
