//! Centre of mass and momentum as methods.

use crate::linalg::Vec3;
use crate::model::{Error, Model};
use crate::quantities::{self as q, Query};
use crate::spatial::Wrench;
use nalgebra::{DMatrix, DVector};

impl Model<f64> {
    /// The centre of mass of the moving links and a floating base, in {s}.
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::NoMass`] if the moving links have no mass.
    pub fn center_of_mass(&self, theta: &[f64]) -> Result<Vec3, Error> {
        self.point(q::CenterOfMass, &[theta])
    }

    /// ċ of the centre of mass, {s} coordinates.
    ///
    /// # Errors
    /// As [`center_of_mass`](Self::center_of_mass).
    pub fn center_of_mass_velocity(&self, theta: &[f64], dtheta: &[f64]) -> Result<Vec3, Error> {
        self.point(q::CenterOfMassVelocity, &[theta, dtheta])
    }

    /// c̈ of the centre of mass, {s} coordinates.
    ///
    /// # Errors
    /// As [`center_of_mass`](Self::center_of_mass).
    pub fn center_of_mass_acceleration(&self, theta: &[f64], dtheta: &[f64], ddtheta: &[f64]) -> Result<Vec3, Error> {
        self.point(q::CenterOfMassAcceleration, &[theta, dtheta, ddtheta])
    }

    /// The 3 × n Jacobian of the centre of mass: ċ = Jθ̇ in {s} coordinates.
    ///
    /// # Errors
    /// As [`center_of_mass`](Self::center_of_mass).
    pub fn center_of_mass_jacobian(&self, theta: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.matrix(q::CenterOfMassJacobian, &[theta], &self.environment())
    }

    /// The momentum of the moving links and a floating base, (angular, linear) in kg m²/s and kg m/s, about a point of
    /// {s}, in {s} coordinates: see [`momentum`](crate::dynamics::momentum()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn momentum(&self, theta: &[f64], dtheta: &[f64], about: Vec3) -> Result<Wrench, Error> {
        self.wrench(Query::from(q::Momentum).about(about), &[theta, dtheta])
    }

    /// ḣ, the rate of the momentum about a fixed point of {s}; with the present centre of mass as the point, the rate
    /// of the centroidal momentum. See [`momentum_rate`](crate::dynamics::momentum_rate).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn momentum_rate(&self, theta: &[f64], dtheta: &[f64], ddtheta: &[f64], about: Vec3) -> Result<Wrench, Error> {
        self.wrench(Query::from(q::MomentumRate).about(about), &[theta, dtheta, ddtheta])
    }

    /// The 6 × n centroidal momentum matrix A_G, angular rows first: `h_G` = A_G θ̇ is the momentum about the centre of
    /// mass, in {s} axes.
    ///
    /// # Errors
    /// As [`center_of_mass`](Self::center_of_mass).
    pub fn centroidal_momentum_matrix(&self, theta: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.matrix(q::CentroidalMomentumMatrix, &[theta], &self.environment())
    }

    /// Ȧ_G θ̇, the bias term of ḣ_G = A_G θ̈ + Ȧ_G θ̇: see
    /// [`centroidal_momentum_matrix`](Self::centroidal_momentum_matrix).
    ///
    /// # Errors
    /// As [`center_of_mass`](Self::center_of_mass).
    pub fn centroidal_momentum_bias(&self, theta: &[f64], dtheta: &[f64]) -> Result<DVector<f64>, Error> {
        self.vector(q::CentroidalMomentumBias, &[theta, dtheta], &self.environment())
    }

    fn point(&self, query: impl Into<Query<'static>>, inputs: &[&[f64]]) -> Result<Vec3, Error> {
        let found = self.first(query, inputs, &self.environment())?;
        Ok(Vec3(core::array::from_fn(|k| found[k])))
    }

    fn wrench(&self, query: Query, inputs: &[&[f64]]) -> Result<Wrench, Error> {
        let found = self.first(query, inputs, &self.environment())?;
        Ok(Wrench::from_array(core::array::from_fn(|k| found[k])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics as kernel;
    use crate::testing::{floating_mixed_tree, floating_tree, mixed_tree, moving, state, tree, wrench};
    use crate::workspace::Workspace;
    use crate::{Dual, Environment};
    use alloc::vec::Vec;

    fn models() -> impl Iterator<Item = (u64, Model)> {
        [(5, 0), (9, 2), (14, 3)].into_iter().enumerate().flat_map(|(k, (links, mimics))| {
            let seed = 300 + k as u64;
            [tree, floating_tree, mixed_tree, floating_mixed_tree].map(|make| (seed, make(seed, links, mimics)))
        })
    }

    #[track_caller]
    fn close(a: &[f64], b: &[f64], what: &str) {
        let size = b.iter().chain(a).fold(1e-300_f64, |m, x| m.max(x.abs()));
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12 * size), "{what}: {a:?} {b:?}");
    }

    #[test]
    fn the_centre_of_mass_moves_as_its_derivatives_say() {
        for (seed, model) in models() {
            let [theta, dtheta, ddtheta] = state(&model, seed);
            let dual = model.map(Dual::constant);
            let mut workspace = Workspace::new(&dual);
            // by each link's own frame
            let mut sum = Vec3::zero();
            for link in &model.description().links {
                let frame = model.frame(&link.name).expect("a link");
                let moves = model.is_floating() || model.frames[frame.0].slot > 0;
                let at = model.forward_kinematics(&theta, frame).expect("lengths");
                let weight = if moves { link.inertia.mass } else { 0.0 };
                sum += at * link.inertia.center_of_mass() * weight;
            }
            let c = model.center_of_mass(&theta).expect("a mass");
            close(&c.0, &(sum * (1.0 / model.mass())).0, "c");
            // ċ by dual numbers
            let G = kernel::total_inertia(&dual, &moving(&model, &theta, &dtheta), &mut workspace);
            let dc = model.center_of_mass_velocity(&theta, &dtheta).expect("a mass");
            close(&dc.0, &(G.mc.map(|x| x.derivative) * (1.0 / model.mass())).0, "ċ");
            let J = model.center_of_mass_jacobian(&theta).expect("a mass");
            close(&dc.0, (J * DVector::from_column_slice(&dtheta)).as_slice(), "Jθ̇");
            // c̈ and ḣ, with θ̇ moving by θ̈
            let rates: Vec<Dual> =
                dtheta.iter().zip(&ddtheta).map(|(&value, &derivative)| Dual { value, derivative }).collect();
            let h = kernel::momentum(&dual, &moving(&model, &theta, &dtheta), &rates, &mut workspace);
            let dh = h.map(|x| x.derivative);
            let o = Vec3::zero();
            close(&model.momentum_rate(&theta, &dtheta, &ddtheta, o).expect("lengths").to_array(), &dh.to_array(), "ḣ");
            let ddc = model.center_of_mass_acceleration(&theta, &dtheta, &ddtheta).expect("a mass");
            close(&ddc.0, &(dh.f * (1.0 / model.mass())).0, "c̈");
        }
    }

    #[test]
    fn the_centroidal_momentum_is_its_matrix_times_the_velocities() {
        for (seed, model) in models() {
            let [theta, dtheta, ddtheta] = state(&model, seed);
            let c = model.center_of_mass(&theta).expect("a mass");
            let A = model.centroidal_momentum_matrix(&theta).expect("a mass");
            let (rates, accelerations) = (DVector::from_column_slice(&dtheta), DVector::from_column_slice(&ddtheta));
            let h = model.momentum(&theta, &dtheta, c).expect("lengths");
            close((&A * &rates).as_slice(), &h.to_array(), "h = Aθ̇");
            let bias = model.centroidal_momentum_bias(&theta, &dtheta).expect("a mass");
            let dh = model.momentum_rate(&theta, &dtheta, &ddtheta, c).expect("lengths");
            close((&A * &accelerations + bias).as_slice(), &dh.to_array(), "ḣ = Aθ̈ + Ȧθ̇");
            // linear momentum is the mass times the velocity of the centre
            close(&(model.center_of_mass_velocity(&theta, &dtheta).expect("a mass") * model.mass()).0, &h.f.0, "mċ");
        }
    }

    #[test]
    fn what_pushes_a_free_robot_changes_its_momentum() {
        let model = floating_tree(310, 8, 2);
        let [theta, dtheta, _] = state(&model, 1);
        let mut tau = state(&model, 2)[2].clone();
        let tip = model.end_effector().expect("named");
        let environment = Environment { applied: &[(tip, wrench(5))], ..model.environment() };
        tau[..6].copy_from_slice(&[0.3, -1.0, 2.0, 5.0, -3.0, 0.5]);
        let ddtheta = model.forward_dynamics(&theta, &dtheta, &tau, &environment).expect("regular");
        let c = model.center_of_mass(&theta).expect("a mass");
        let dh = model.momentum_rate(&theta, &dtheta, ddtheta.as_slice(), c).expect("lengths");
        // gravity at the centre of mass, plus the base's wrench, minus the wrench that the tip applies, all about the
        // centre
        let seen = |frame, F: Wrench| {
            let T = model.forward_kinematics(&theta, frame).expect("lengths");
            (T.inverse().Ad().transpose() * F).about(c)
        };
        let base = model.frame("link0").expect("the base");
        let driven = Wrench::from_array(*tau.first_chunk().expect("six"));
        let weight = Wrench { m: Vec3::zero(), f: model.gravity() * model.mass() };
        let pushed = weight + seen(base, driven) - seen(tip, wrench(5));
        close(&dh.to_array(), &pushed.to_array(), "ḣ");
    }

    #[test]
    fn nothing_has_no_centre() {
        let empty =
            crate::Description::new("empty").link("base", crate::SpatialInertia::zero()).build().expect("sound");
        let message = empty.center_of_mass(&[]).expect_err("no mass").to_string();
        assert_eq!(message, "the robot's total mass is 0 kg; the centre of mass is undefined");
    }
}
