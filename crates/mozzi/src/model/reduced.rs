//! Models with fewer nonzero constants and the same dynamics, for recordings.

use super::{Model, Motion};
use crate::linalg::{Sym3, Vec3};
use crate::spatial::SpatialInertia;
use alloc::vec::Vec;

/// A number of this size is a rounding error of 0 relative to 1, as a few products with cos(π/2) = 6 · 10⁻¹⁷ leave.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

impl Model<f64> {
    /// A model with the same τ, M, θ̈, energies, kinematics and derivatives up to rounding, whose programs need fewer
    /// operations. [`base_reaction`](crate::NewtonEuler::base_reaction) and the links' own parameters differ.
    ///
    /// - Inertial parameters that do not depend on the joint angle are moved to the parent (or the base): the mass,
    ///   placed on the joint's axis, the first moment along it, and I_yy about all axes perpendicular to it. (m c_x, m
    ///   c_y), I_xx − I_yy, I_xy, I_xz, I_yz and I_zz remain (Khalil and Dombre 2002, section 9.4).
    /// - Numbers within 8ε of 0 (or of ±1 in rotations), relative to the numbers they were computed from, are rounded
    ///   to that value.
    ///
    /// Cost O(N).
    pub fn reduced(&self) -> Self {
        let mut model = self.clone();
        let own = |G: &SpatialInertia| (largest(G.mc), G.I.trace().abs());
        let mut sizes: Vec<_> =
            core::iter::once(&self.base_inertia).chain(self.links.iter().map(|link| &link.G)).map(own).collect();
        for i in (1..=model.links.len()).rev() {
            let link = &mut model.links[i - 1];
            let (parent, R) = (link.parent, link.M.R.matrix());
            link.M.R.0 = R.map(|x| if (x.abs() - 1.0).abs() <= ROUNDING { x.signum() } else { clean(x, 1.0) });
            let p = link.M.p;
            link.M.p = p.map(|x| clean(x, largest(p)));
            if link.motion == Motion::Screw && link.screw.b == 0.0 {
                let G = link.G;
                let ([.., z], J) = (G.mc.0, G.I.yy);
                let axial = SpatialInertia { mass: G.mass, mc: Vec3([0.0, 0.0, z]), I: Sym3::diagonal(J, J, 0.0) };
                link.G = G - axial;
                let given = axial.congruence(link.M.Ad());
                let (size, (mc, I)) = (&mut sizes[parent], own(&given));
                *size = (size.0 + mc, size.1 + I);
                match parent.checked_sub(1) {
                    None => model.base_inertia += given,
                    Some(parent) => model.links[parent].G += given,
                }
            }
        }
        let inertias = core::iter::once(&mut model.base_inertia).chain(model.links.iter_mut().map(|link| &mut link.G));
        for (G, (mc, I)) in inertias.zip(sizes) {
            (G.mc, G.I) = (G.mc.map(|x| clean(x, mc)), G.I.map(|x| clean(x, I)));
        }
        model
    }
}

fn largest(v: Vec3) -> f64 {
    v.0.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// 0 if x is a rounding error relative to numbers of this size, else x.
fn clean(x: f64, size: f64) -> f64 {
    if x.abs() <= ROUNDING * size { 0.0 } else { x }
}

#[cfg(test)]
mod tests {
    use crate::accuracy::normalized_error;
    use crate::testing::{floating_tree, state, tree, wrench};
    use crate::{Environment, Model};

    #[test]
    fn the_dynamics_are_the_same() {
        for model in [tree(3, 9, 0), tree(5, 9, 3), floating_tree(2, 8, 1)] {
            let reduced = model.reduced();
            let [theta, dtheta, ddtheta] = state(&model, 6);
            let applied = [(model.end_effector().expect("named"), wrench(2))];
            let derivatives = |model: &Model, environment: &Environment| {
                let state: [&[f64]; 3] = [&theta, &dtheta, &ddtheta];
                model
                    .compute(crate::quantities::InverseDynamicsDerivatives, &state, environment)
                    .expect("lengths")
                    .remove(0)
            };
            let of = |model: &Model| {
                let environment = Environment { applied: &applied, ..model.environment() };
                [
                    model
                        .inverse_dynamics(&theta, &dtheta, &ddtheta, &environment)
                        .expect("lengths")
                        .as_slice()
                        .to_vec(),
                    model.mass_matrix(&theta).expect("lengths").as_slice().to_vec(),
                    derivatives(model, &environment),
                ]
            };
            for (found, reference) in of(&reduced).iter().zip(&of(&model)) {
                let error = normalized_error(found, reference, 0.0);
                assert!(error < 100.0, "{error}");
            }
            let tau = &of(&model)[0];
            let environment = Environment { applied: &applied, ..model.environment() };
            let again = reduced.forward_dynamics(&theta, &dtheta, tau, &environment).expect("regular");
            assert!(normalized_error(again.as_slice(), &ddtheta, 0.0) < 1e6, "{again} {ddtheta:?}");
            let energy = |model: &Model| model.kinetic_energy(&theta, &dtheta).expect("lengths");
            assert!((energy(&reduced) / energy(&model) - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn a_link_that_turns_keeps_seven_numbers() {
        let model = tree(3, 9, 0);
        for (link, reduced) in model.links.iter().zip(&model.reduced().links) {
            let G = reduced.G;
            let is_zero = [G.mass, G.mc.0[2], G.I.yy].map(|x| x == 0.0);
            assert_eq!(is_zero, [link.screw.b == 0.0; 3], "children give theirs, but not to one that has given all");
        }
    }
}
