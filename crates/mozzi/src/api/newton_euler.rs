//! What the recursion of inverse dynamics finds on its way: twists, accelerations, wrenches, reactions.

use crate::dynamics as kernel;
use crate::lie::SE3;
use crate::model::{Environment, Error, Model, Workspace};
use crate::spatial::{Twist, Wrench};
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::DVector;

/// In which frame of each moving link its quantities are expressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyFrame {
    /// The link's own frame, as in the file.
    Link,
    /// The book's frame {i}: at the centre of mass of the link with all that is fixed to it, oriented as the link's.
    CenterOfMass,
}

/// The quantities of the Newton-Euler recursion, for the N moving links, base to tips.
#[derive(Clone, Debug)]
pub struct NewtonEuler {
    /// 𝒱_i.
    pub twists: Vec<Twist>,
    /// 𝒱̇_i, with gravity as an upward acceleration of the base, as in the book: at rest it is −g.
    pub accelerations: Vec<Twist>,
    /// 𝓕_i: the wrench that joint i transmits to link i; its part along the joint is the motor's, the other five are
    /// the bearing's reaction.
    pub wrenches: Vec<Wrench>,
    /// The wrench that the ground applies to the base, in base coordinates, the base's own weight included.
    pub base_reaction: Wrench,
    /// τ.
    pub tau: DVector<f64>,
}

impl Model<f64> {
    /// Inverse dynamics with all that the recursion finds on its way, in the frames asked for.
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
        let (mut workspace, mut tau) = (Workspace::new(self), vec![0.0; self.n()]);
        kernel::inverse_dynamics(self, theta, dtheta, ddtheta, environment, &mut workspace, &mut tau);
        let Workspace { V, dV, F, .. } = workspace;
        let frames: Vec<SE3> = (1..=self.moving_links())
            .map(|slot| match frame {
                BodyFrame::Link => self.link_frame(slot),
                BodyFrame::CenterOfMass => self.body_frame(slot),
            })
            .collect();
        let twists = |list: &[Twist]| list[1..].iter().zip(&frames).map(|(&V, T)| T.inverse().Ad() * V).collect();
        let G = self.base_inertia;
        Ok(NewtonEuler {
            twists: twists(&V),
            accelerations: twists(&dV),
            wrenches: F[1..].iter().zip(&frames).map(|(&F, T)| T.Ad().transpose() * F).collect(),
            base_reaction: F[0] + G * dV[0] - V[0].ad().transpose() * (G * V[0]),
            tau: DVector::from_vec(tau),
        })
    }
}
