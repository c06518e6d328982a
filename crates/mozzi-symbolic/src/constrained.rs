//! θ̈ and λ of a robot with constraints as fractions, proven by multiplying back: its kernel solves for λ by a proximal
//! iteration, which is exact only up to rounding.

use crate::derivation::Formula;
use crate::error::Error;
use crate::expression::Expression;
use crate::fraction::Fraction;
use crate::inverse::{Robot, Solved};
use crate::kernel::Kernel;
use crate::proof::{at_points, value_at};
use crate::symbol::Symbol;
use mozzi::Scalar;
use mozzi::quantities::{ConstraintBias, ConstraintJacobian, InverseDynamics, MassMatrix, Query};

/// The quantity's name.
pub(crate) const QUANTITY: &str = "constrained_forward_dynamics";

/// M, h, A and Ȧθ̇ at a state, by their kernels: [M Aᵀ; A 0] (θ̈, λ) = (τ − h, −Ȧθ̇).
pub(crate) struct Parts([Kernel; 4]);

impl Parts {
    pub fn new(robot: &Robot) -> Result<Self, Error> {
        let kernel = |query: Query| Kernel::new(&query, robot.symbolic, None);
        let [M, h] = [kernel(Query::from(MassMatrix))?, kernel(Query::from(InverseDynamics))?];
        Ok(Parts([M, h, kernel(Query::from(ConstraintJacobian))?, kernel(Query::from(ConstraintBias))?]))
    }

    /// M, τ − h, A and −Ȧθ̇ for the numbers of the robot.
    fn at(&self, number: &dyn Fn(Symbol) -> Symbol, inputs: &[Vec<Symbol>]) -> Vec<Vec<Symbol>> {
        let still = vec![Symbol::zero(); inputs[1].len()];
        let with_still = [inputs[0].clone(), inputs[1].clone(), still];
        let [M, h, A, bias] = [0, 1, 2, 3].map(|k| {
            let inputs = [&inputs[..1], &with_still, &inputs[..1], &inputs[..2]][k];
            self.0[k].outputs_at(number, inputs).swap_remove(0)
        });
        let forces = inputs[2].iter().zip(h).map(|(&tau, h)| tau - h).collect();
        vec![M, forces, A, bias.into_iter().map(|x| -x).collect()]
    }

    /// θ̈ and λ. Rows of A that are 0 everywhere have λ = 0.
    pub fn fractions(&self, inputs: &[Vec<Symbol>], are_fractions: bool) -> Result<Vec<Fraction>, Error> {
        let n = inputs[1].len();
        let parts = self.at(&|x| x, inputs);
        let [M, forces, A, bias] = &parts[..] else { return Ok(Vec::new()) };
        crate::kernel::check_fault(QUANTITY)?;
        let moves = |row: &&usize| A[**row * n..][..n].iter().any(|x| *x != Symbol::zero());
        let all: Vec<usize> = (0..bias.len()).collect();
        let rows: Vec<usize> = all.iter().filter(moves).copied().collect();
        let moving: Vec<Symbol> = rows.iter().flat_map(|&row| A[row * n..][..n].to_vec()).collect();
        let right: Vec<Symbol> = forces.iter().copied().chain(rows.iter().map(|&row| bias[row])).collect();
        let mut solved = Solved::new(QUANTITY, n, M, &moving)?;
        let accelerations = (0..n).map(|i| solved.row(i, &right)).collect();
        let mut multipliers = vec![Symbol::zero(); bias.len()];
        for (k, &row) in rows.iter().enumerate() {
            multipliers[row] = solved.row(n + k, &right);
        }
        let accelerations = solved.fraction(QUANTITY, accelerations, are_fractions)?;
        Ok(vec![accelerations, solved.fraction(QUANTITY, multipliers, are_fractions)?])
    }

    /// Mθ̈ + Aᵀλ = τ − h and Aθ̈ = −Ȧθ̇, exactly, at random points.
    pub fn prove(&self, inputs: &[Vec<Symbol>], formulas: &[Formula], names: &[Expression]) -> Result<(), Error> {
        let outputs = |number: &dyn Fn(Symbol) -> Symbol, inputs: &[Vec<Symbol>]| self.at(number, inputs);
        at_points(QUANTITY, outputs, inputs, |point, parts| {
            let [M, forces, A, bias] = parts else { return Ok(()) };
            let (n, value) = (forces.len(), value_at(point, names));
            let values = |k: usize| formulas[k].entries.iter().map(&value).collect::<Vec<_>>();
            let below = |k: usize| formulas[k].denominator.as_ref().map_or(Symbol::one(), &value);
            let (ddtheta, lambda, over, under) = (values(0), values(1), below(0), below(1));
            let sum = |terms: &mut dyn Iterator<Item = Symbol>| terms.fold(Symbol::zero(), |sum, x| sum + x);
            let moved = (0..n).map(|i| {
                let inertial = sum(&mut (0..n).map(|j| M[i * n + j] * ddtheta[j]));
                let constrained = sum(&mut (0..lambda.len()).map(|r| A[r * n + i] * lambda[r]));
                inertial * under + constrained * over - forces[i] * over * under
            });
            let held = (0..bias.len()).map(|r| sum(&mut (0..n).map(|j| A[r * n + j] * ddtheta[j])) - bias[r] * over);
            match moved.chain(held).position(|rest| rest != Symbol::zero()) {
                Some(entry) => {
                    let what = "the equations of motion do not hold".into();
                    Err(Error::NotProven { quantity: QUANTITY, entry, what })
                }
                None => Ok(()),
            }
        })
    }
}
