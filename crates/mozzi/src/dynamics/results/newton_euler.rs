//! Intermediate results of the Newton-Euler recursion: twists, accelerations, wrenches, reactions.

use crate::dynamics as kernel;
use crate::kinematics::link_twists;
use crate::lie::SE3;
use crate::model::{Base, Environment, Error, Model};
use crate::spatial::{Twist, Wrench};
use crate::workspace::{Recursion, Workspace};
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::DVector;

/// The frame of each moving link in which its quantities are expressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyFrame {
    /// The link's own frame, as in the file.
    Link,
    /// The book's frame {i}: at the centre of mass of the link and all links fixed to it, with the axes of the link's
    /// frame.
    CenterOfMass,
}

/// The quantities of the Newton-Euler recursion, for the N moving links, base to tips.
#[derive(Clone, Debug)]
pub struct NewtonEuler {
    /// 𝒱_i.
    pub twists: Vec<Twist>,
    /// 𝒱̇_i, with gravity as an upward acceleration of the base, as in the book: at rest it is −g.
    pub accelerations: Vec<Twist>,
    /// 𝓕_i: the wrench that joint i transmits to link i. Its component along the joint is the motor's, the other five
    /// are the bearing's reaction.
    pub wrenches: Vec<Wrench>,
    /// The wrench on the base in base coordinates: from the ground, including the base's own weight; for a floating
    /// base, the first six entries of τ.
    pub base_reaction: Wrench,
    /// τ.
    pub tau: DVector<f64>,
}

impl Model<f64> {
    /// Inverse dynamics with the intermediate results of the recursion, in the given kind of frames.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn newton_euler(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        ddtheta: &[f64],
        environment: &Environment,
        frame: BodyFrame,
    ) -> Result<NewtonEuler, Error> {
        self.check_lengths(theta, [("dtheta", dtheta), ("ddtheta", ddtheta)])?;
        self.check_environment(environment)?;
        let (mut workspace, mut tau) = (Workspace::new(self), vec![0.0; self.n()]);
        kernel::inverse_dynamics(self, theta, dtheta, ddtheta, environment, &mut workspace, &mut tau);
        // the kernel uses classical accelerations: convert them back to spatial accelerations relative to {s}
        link_twists(self, theta, dtheta, environment.base_twist, &mut workspace);
        let Workspace { recursion: Recursion { V, mut dV, F, .. }, .. } = workspace;
        for (dV, V) in dV.iter_mut().zip(&V) {
            dV.v -= V.w.cross(V.v);
        }
        let frames: Vec<(usize, SE3)> = (self.moving_slots())
            .map(|slot| match frame {
                BodyFrame::Link => (slot, self.link_frame(slot)),
                BodyFrame::CenterOfMass => (slot, self.body_frame(slot)),
            })
            .collect();
        let twists = |list: &[Twist]| frames.iter().map(|(slot, T)| T.inverse().Ad() * list[*slot]).collect();
        let G = self.base_inertia;
        Ok(NewtonEuler {
            twists: twists(&V),
            accelerations: twists(&dV),
            wrenches: frames.iter().map(|(slot, T)| T.Ad().transpose() * F[*slot]).collect(),
            base_reaction: match self.base() {
                Base::Fixed => F[0] + G * dV[0] - V[0].ad().transpose() * (G * V[0]),
                Base::Floating => F[0],
            },
            tau: DVector::from_vec(tau),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{state, tree, twist, wrench};

    #[test]
    fn the_recursion_equals_the_stacked_equations() {
        for (links, mimics) in [(4, 0), (11, 3)] {
            let model = tree(links as u64, links, mimics);
            let [theta, dtheta, ddtheta] = state(&model, 1);
            let tip = model.end_effector().expect("named");
            let environment = Environment {
                base_twist: twist(1),
                base_acceleration: twist(2),
                applied: &[(tip, wrench(3))],
                ..model.environment()
            };
            let form = model.closed_form(&theta, &dtheta, &environment).expect("lengths");
            let found =
                model.newton_euler(&theta, &dtheta, &ddtheta, &environment, BodyFrame::CenterOfMass).expect("lengths");
            let ddtheta = DVector::from_column_slice(&ddtheta);
            let stacked = |list: Vec<[f64; 6]>| DVector::from_vec(list.concat());
            let close = |a: DVector<f64>, b: &DVector<f64>| assert!((&a - b).amax() < 1e-11 * b.amax());
            close(stacked(found.twists.iter().map(|V| V.to_array()).collect()), &form.V);
            close(stacked(found.accelerations.iter().map(|V| V.to_array()).collect()), &form.accelerations(&ddtheta));
            close(stacked(found.wrenches.iter().map(|F| F.to_array()).collect()), &form.wrenches(&ddtheta));
        }
    }

    #[test]
    fn at_rest_the_base_carries_the_whole_weight() {
        let model = tree(6, 8, 0);
        let [theta, _, _] = state(&model, 6);
        let zero = vec![0.0; model.n()];
        let found = model.newton_euler(&theta, &zero, &zero, &model.environment(), BodyFrame::Link).expect("lengths");
        let mass: f64 = model.description().links.iter().map(|link| link.inertia.mass).sum();
        assert!((found.base_reaction.f + model.gravity() * mass).norm() < 1e-11 * mass * model.gravity().norm());
        // and a link's twist is its frame's body Jacobian times θ̇
        let [theta, dtheta, ddtheta] = state(&model, 7);
        let found =
            model.newton_euler(&theta, &dtheta, &ddtheta, &model.environment(), BodyFrame::Link).expect("lengths");
        for (joint, V) in model.moving_joints().zip(&found.twists) {
            let J = model.body_jacobian(&theta, model.frame(&joint.child).expect("a link")).expect("lengths");
            assert!((&J * &dtheta[..] - *V).norm() < 1e-12 * (1.0 + V.norm()));
        }
    }
}
