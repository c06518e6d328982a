//! Directional derivatives of any function of θ.

use crate::model::{Error, Model};
use crate::model::{integrate, seed_direction};
use crate::scalar::Dual;
use alloc::vec::Vec;

impl Model<f64> {
    /// f(θ ⊕ δθ ε) at ε = 0, with its derivative in ε: calls f with the positions as dual numbers with the direction
    /// δθ, and returns its result. δθ has n entries; a floating base moves along the twist δθ₁ … δθ₆ in its own
    /// coordinates. Make dual numbers of other arguments of f with [`Dual::list`] if they vary, and with
    /// [`Dual::constants`] if they do not.
    ///
    /// ```
    /// use mozzi::model::description::{Joint, JointKind};
    /// use mozzi::{Description, Dual, SE3, ScrewAxis, SpatialInertia, Vec3, Workspace};
    /// use mozzi::dynamics::mass_matrix;
    /// // an arm that turns about z, and a slide along it that carries 2 kg: M₁₁ = 2 θ₂²
    /// let turn = JointKind::Screw(ScrewAxis::new([0.0, 0.0, 1.0], [0.0; 3])?);
    /// let slide = JointKind::Screw(ScrewAxis::prismatic([1.0, 0.0, 0.0])?);
    /// let arm = Description::new("arm")
    ///     .link("base", SpatialInertia::zero())
    ///     .link("rail", SpatialInertia::zero())
    ///     .link("bob", SpatialInertia::point_mass(2.0, Vec3([0.0; 3])))
    ///     .joint(Joint::new("turn", "base", "rail", SE3::identity(), turn))
    ///     .joint(Joint::new("slide", "rail", "bob", SE3::identity(), slide))
    ///     .build()?;
    ///
    /// let M = arm.directional_derivative(&[0.4, 0.5], &[0.0, 1.0], |theta| {
    ///     let mut M = Dual::constants(&[0.0; 4]);
    ///     mass_matrix(&arm, theta, &mut Workspace::new(&arm), &mut M);
    ///     M
    /// })?;
    /// assert!((M[0].value - 0.5).abs() < 1e-15 && (M[0].derivative - 2.0).abs() < 1e-15);
    ///
    /// let d2M = arm.second_directional_derivative(&[0.4, 0.5], [&[0.0, 1.0], &[0.0, 1.0]], |theta| {
    ///     let mut M = [Dual::constant(Dual::constant(0.0)); 4];
    ///     mass_matrix(&arm, theta, &mut Workspace::new(&arm), &mut M);
    ///     M[0].derivative.derivative
    /// })?;
    /// assert!((d2M - 4.0).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Cost: one f on dual numbers, two to three times one on plain ones.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn directional_derivative<R>(
        &self,
        theta: &[f64],
        along: &[f64],
        f: impl FnOnce(&[Dual]) -> R,
    ) -> Result<R, Error> {
        self.check_lengths(theta, [("the direction", along)])?;
        Ok(f(&seed_direction(self, theta, along)))
    }

    /// f(θ ⊕ (u ε₁ + v ε₂)) with its derivatives for two directions at ε = 0: for each number x of the result,
    /// `x.value.derivative` is ∂f/∂ε₁, `x.derivative.value` is ∂f/∂ε₂, and `x.derivative.derivative` is ∂²f/∂ε₁∂ε₂. The
    /// last is symmetric in u and v, also for a floating base, whose directions are added before the exponential
    /// (e^{`[u + v]`}). See [`directional_derivative`](Self::directional_derivative).
    ///
    /// Cost: one f on dual numbers of dual numbers.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn second_directional_derivative<R>(
        &self,
        theta: &[f64],
        [u, v]: [&[f64]; 2],
        f: impl FnOnce(&[Dual<Dual>]) -> R,
    ) -> Result<R, Error> {
        self.check_lengths(theta, [("the first direction", u), ("the second direction", v)])?;
        let lift = |x: f64| Dual::constant(Dual::constant(x));
        // u ε₁ + v ε₂
        let along =
            |(&u, &v): (&f64, &f64)| Dual { value: Dual { value: 0.0, derivative: u }, derivative: Dual::constant(v) };
        let along: Vec<_> = u.iter().zip(v).map(along).collect();
        let mut theta: Vec<_> = theta.iter().map(|&x| lift(x)).collect();
        integrate(self, &mut theta, &along, lift(1.0));
        Ok(f(&theta))
    }
}

#[cfg(test)]
mod tests {
    use super::integrate;
    use crate::model::Model;
    use crate::scalar::{Dual, Scalar};
    use crate::testing::{Random, floating_tree, state, tree};
    use crate::workspace::Workspace;
    use crate::{dynamics as kernel, model::Environment};
    use alloc::vec::Vec;

    /// τ at constant rates and accelerations.
    fn tau<S: Scalar + From<f64>>(model: &Model, theta: &[S], rates: &[f64]) -> Vec<S> {
        let rates: Vec<S> = rates.iter().map(|&x| S::from(x)).collect();
        let mut tau = rates.clone();
        let environment = Environment::with_gravity(model.gravity().map(S::from));
        kernel::inverse_dynamics(model, theta, &rates, &rates, &environment, &mut Workspace::new(model), &mut tau);
        tau
    }

    #[test]
    fn first_and_second_derivatives_equal_differences() {
        for model in [tree(3, 6, 1), floating_tree(4, 5, 0)] {
            let [theta, rates, _] = state(&model, 2);
            let mut random = Random(6);
            let (u, v) = (random.vector(model.n(), 1.0), random.vector(model.n(), 1.0));
            let at = |s: f64, t: f64| {
                let along: Vec<f64> = u.iter().zip(&v).map(|(u, v)| s * u + t * v).collect();
                let mut moved = theta.clone();
                integrate(&model, &mut moved, &along, 1.0);
                tau(&model, &moved, &rates)
            };
            let first = model.directional_derivative(&theta, &u, |q| tau(&model, q, &rates)).expect("lengths");
            let second = |u: &[f64], v: &[f64]| -> Vec<Dual<Dual>> {
                model.second_directional_derivative(&theta, [u, v], |q| tau(&model, q, &rates)).expect("lengths")
            };
            let (both, swapped) = (second(&u, &v), second(&v, &u));
            let (h, k) = (1e-5, 1e-3);
            let (plus, minus) = (at(h, 0.0), at(-h, 0.0));
            let (pp, pm, mp, mm) = (at(k, k), at(k, -k), at(-k, k), at(-k, -k));
            let size = first.iter().fold(1.0_f64, |m, x| m.max(x.value.abs()).max(x.derivative.abs()));
            for j in 0..model.n() {
                let difference = (plus[j] - minus[j]) / (2.0 * h);
                assert!((first[j].derivative - difference).abs() < 1e-7 * size);
                assert!((both[j].value.derivative - first[j].derivative).abs() < 1e-12 * size);
                assert!((swapped[j].derivative.value - first[j].derivative).abs() < 1e-12 * size);
                let difference = (pp[j] - pm[j] - mp[j] + mm[j]) / (4.0 * k * k);
                let found = both[j].derivative.derivative;
                assert!((found - difference).abs() < 1e-4 * size.max(found.abs()), "{found} {difference}");
                assert!((found - swapped[j].derivative.derivative).abs() < 1e-11 * size.max(found.abs()));
            }
        }
    }
}
