//! MuJoCo's convention.

mod followers;
#[cfg(test)]
mod tests;
mod turns;

use super::JointOrder;
use super::joint_order::{check_length, check_square};
use crate::lie::{SE3, SO3};
use crate::linalg::Vec3;
use crate::model::{Error, Freedom, Model, check_unit};
use crate::spatial::Twist;
use alloc::format;
use alloc::vec::Vec;
use followers::{Follower, couplings, with, without};
use nalgebra::{DMatrix, DVector};
use turns::{back, congruent, normalized, seen, turned};

/// Converts states, forces and matrices of a model to and from MuJoCo's coordinates.
///
/// | | mozzi | MuJoCo (a floating base is its `freejoint`), R = `R_sb` |
/// |---|---|---|
/// | configuration | (q_w, q_x, q_y, q_z, p, joints) | `qpos` = (p, q_w, q_x, q_y, q_z, joints) |
/// | velocity | (ω, v, joints), in base link coordinates | `qvel` = (Rv, ω, joints): ṗ in world axes, ω in the body's |
/// | acceleration | its derivative | `qacc` = (R(v̇ + ω × v), ω̇, joints): p̈ in world axes |
/// | force | (m, f, joints) | `qfrc_*` = (Rf, m, joints) |
/// | mass matrix | M | XᵀMX, with θ̇ = X `qvel` |
/// | h | h | Xᵀ(h + Mβ), with θ̈ = X `qacc` + β, β = (0, −ω × v, 0) |
///
/// A ball has the same quaternion and ω in both. A free joint inside the robot is like a floating base; MuJoCo allows
/// them on the world only and has the pose in {s}, mozzi the pose relative to the joint's frame at 0.
///
/// A mimic joint is in MuJoCo a joint that an equality ties to its source joint. [`with_joints`](Self::with_joints)
/// gives it its entries: conversions to MuJoCo fill them, with forces of 0; conversions from MuJoCo add its forces and
/// its inertia to the source joint's, and do not read its motion. M and h cannot be converted to MuJoCo then, as they
/// do not have the parts of each joint.
///
/// MuJoCo normalizes the quaternions of `qpos` before use, and so do conversions from it; one of length 0 is no
/// rotation.
///
/// h does not convert like a [`force`](Self::force): it is the force for θ̈ = 0, `qfrc_bias` the force for `qacc` = 0.
///
/// Results are exact up to the rounding of one rotation; permutations, and everything for a fixed base, are exact to
/// the bit. Conversions to MuJoCo take θ to compute R, conversions from MuJoCo take `qpos`.
#[derive(Clone, Debug)]
pub struct MuJoCo {
    order: JointOrder,
    /// Mimic joints with entries of their own, in MuJoCo's order.
    followers: Vec<Follower>,
    /// For each free joint (and a floating base), its index among the places, and the frame at 0, in {s}, that mozzi's
    /// configuration is relative to; MuJoCo's is relative to {s}.
    homes: Vec<(usize, SE3)>,
}

impl MuJoCo {
    /// Joints in mozzi's own order, which is MuJoCo's for the same file: depth first, siblings in the file's order.
    /// Mimic joints have no entries.
    pub fn new(model: &Model) -> Self {
        MuJoCo::of(model, JointOrder::new(model, (0..model.joint_names().len()).collect()), Vec::new())
    }

    /// Joints in the order of these names from a MuJoCo model, without the free joint of a floating base. Mimic joints
    /// have entries if they are named.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NoSuchJoint`] or [`Error::BadArgument`] unless the names are the independent
    /// joints, each once, and any mimic joints.
    pub fn with_joints(model: &Model, names: &[&str]) -> Result<Self, Error> {
        let (order, followers) = followers::split(model, names)?;
        Ok(MuJoCo::of(model, order, followers))
    }

    fn of(model: &Model, order: JointOrder, followers: Vec<Follower>) -> Self {
        let free = order.places().iter().enumerate().filter(|(_, place)| place.freedom == Freedom::Free);
        let on_base = model.homes_on_base();
        let homes = free.map(|(k, place)| (k, on_base.get(&place.j).copied().unwrap_or(SE3::identity()))).collect();
        MuJoCo { order, followers, homes }
    }

    /// mozzi's joint index of each of MuJoCo's joints, without mimic joints.
    pub fn joints(&self) -> &[usize] {
        self.order.joints()
    }

    /// `qpos` from θ.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn configuration(&self, theta: &[f64]) -> Result<DVector<f64>, Error> {
        check_length("theta", theta.len(), self.order.nq())?;
        let mut qpos = Vec::with_capacity(theta.len());
        for (k, place) in self.order.places().iter().enumerate() {
            let mine = &theta[place.positions()];
            match (place.freedom, mine) {
                (Freedom::Free, &[w, x, y, z, px, py, pz]) => {
                    let [w, x, y, z, px, py, pz] = seen([w, x, y, z, px, py, pz], self.home(k));
                    qpos.extend([px, py, pz, w, x, y, z]);
                }
                _ => qpos.extend(mine),
            }
        }
        let value = |follower: &Follower| follower.ratio * theta[follower.theta] + follower.offset;
        Ok(with(&self.followers, |follower| follower.q, value, DVector::from_vec(qpos)))
    }

    /// θ from `qpos`, whose quaternions may have any length.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn from_configuration(&self, qpos: &[f64]) -> Result<DVector<f64>, Error> {
        check_length("qpos", qpos.len(), self.order.nq() + self.followers.len())?;
        let qpos = without(&self.followers, |follower| follower.q, qpos);
        let (mut theta, mut rest) = (DVector::zeros(self.order.nq()), qpos.as_slice());
        for (k, place) in self.order.places().iter().enumerate() {
            let (theirs, others) = rest.split_at(place.freedom.positions());
            rest = others;
            let mine = &mut theta.as_mut_slice()[place.positions()];
            match (place.freedom, theirs) {
                (Freedom::Free, &[px, py, pz, w, x, y, z]) => {
                    let [w, x, y, z] = normalized([w, x, y, z]);
                    mine.copy_from_slice(&seen([w, x, y, z, px, py, pz], self.home(k).map(SE3::inverse)));
                }
                (Freedom::Ball, &[w, x, y, z]) => mine.copy_from_slice(&normalized([w, x, y, z])),
                _ => mine.copy_from_slice(theirs),
            }
        }
        Ok(theta)
    }

    /// `qvel` from θ̇: (Rv, ω, joints).
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::BadArgument`] for an invalid quaternion.
    pub fn velocity(&self, theta: &[f64], dtheta: &[f64]) -> Result<DVector<f64>, Error> {
        let R = self.orientations(theta)?;
        let qvel = turned(self.order.velocities_to("dtheta", dtheta)?, R);
        Ok(self.with_rates(dtheta, qvel))
    }

    /// θ̇ from `qvel`.
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::BadArgument`] for an invalid quaternion.
    pub fn from_velocity(&self, qpos: &[f64], qvel: &[f64]) -> Result<DVector<f64>, Error> {
        self.turned_back(qpos, "qvel", &self.without_rates("qvel", qvel)?)
    }

    /// `qacc` from θ̈: (R(v̇ + ω × v), ω̇, joints).
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::BadArgument`] for an invalid quaternion.
    pub fn acceleration(&self, theta: &[f64], dtheta: &[f64], ddtheta: &[f64]) -> Result<DVector<f64>, Error> {
        let (R, beta) = (self.orientations(theta)?, self.spin(dtheta)?);
        check_length("ddtheta", ddtheta.len(), self.order.n())?;
        let relative = DVector::from_column_slice(ddtheta) - beta;
        let qacc = turned(self.order.velocities_to("ddtheta", relative.as_slice())?, R);
        Ok(self.with_rates(ddtheta, qacc))
    }

    /// θ̈ from `qacc`.
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::BadArgument`] for an invalid quaternion.
    pub fn from_acceleration(&self, qpos: &[f64], qvel: &[f64], qacc: &[f64]) -> Result<DVector<f64>, Error> {
        let dtheta = self.from_velocity(qpos, qvel)?;
        let qacc = self.without_rates("qacc", qacc)?;
        Ok(self.turned_back(qpos, "qacc", &qacc)? + self.spin(dtheta.as_slice())?)
    }

    /// `qfrc_*` from τ: (Rf, m, joints). For h see [`bias_forces`](Self::bias_forces).
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::BadArgument`] for an invalid quaternion.
    pub fn force(&self, theta: &[f64], tau: &[f64]) -> Result<DVector<f64>, Error> {
        let R = self.orientations(theta)?;
        let qfrc = turned(self.order.velocities_to("tau", tau)?, R);
        Ok(with(&self.followers, |follower| follower.v, |_| 0.0, qfrc))
    }

    /// τ from `qfrc_*`.
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::BadArgument`] for an invalid quaternion.
    pub fn from_force(&self, qpos: &[f64], qfrc: &[f64]) -> Result<DVector<f64>, Error> {
        self.turned_back(qpos, "qfrc", &self.gathered("qfrc", qfrc)?)
    }

    /// `mj_fullM`'s matrix from M: XᵀMX.
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::BadArgument`] for a matrix that is not square or an invalid quaternion.
    pub fn mass_matrix(&self, theta: &[f64], M: &DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
        self.check_independent("M")?;
        let R = self.orientations(theta)?;
        Ok(congruent(self.order.matrix_to("M", M)?, R))
    }

    /// M from `mj_fullM`'s matrix.
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::BadArgument`] for a matrix that is not square or an invalid quaternion.
    pub fn from_mass_matrix(&self, qpos: &[f64], M: &DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
        let R = self.orientations(self.from_configuration(qpos)?.as_slice())?;
        check_square("M", M, self.order.n() + self.followers.len())?;
        let M = if self.followers.is_empty() {
            M.clone()
        } else {
            let G = couplings(&self.followers, &self.order);
            G.transpose() * M * G
        };
        self.order.matrix_from("M", &congruent(M, back(R)))
    }

    /// `qfrc_bias` from h and M, both mozzi's: Xᵀ(h + Mβ), β = (0, −ω × v, 0).
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::BadArgument`] for a matrix that is not square or an invalid quaternion.
    pub fn bias_forces(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        M: &DMatrix<f64>,
        h: &[f64],
    ) -> Result<DVector<f64>, Error> {
        self.check_independent("h")?;
        check_square("M", M, self.order.n())?;
        check_length("h", h.len(), self.order.n())?;
        if self.homes.is_empty() {
            return self.order.velocities_to("h", h);
        }
        self.force(theta, (DVector::from_column_slice(h) + M * self.spin(dtheta)?).as_slice())
    }

    /// h from `qfrc_bias` and M, where M is mozzi's: X⁻ᵀ`qfrc_bias` − Mβ.
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::BadArgument`] for a matrix that is not square or an invalid quaternion.
    pub fn from_bias_forces(
        &self,
        qpos: &[f64],
        qvel: &[f64],
        M: &DMatrix<f64>,
        qfrc_bias: &[f64],
    ) -> Result<DVector<f64>, Error> {
        check_square("M", M, self.order.n())?;
        let h = self.turned_back(qpos, "qfrc_bias", &self.gathered("qfrc_bias", qfrc_bias)?)?;
        if self.homes.is_empty() {
            return Ok(h);
        }
        Ok(h - M * self.spin(self.from_velocity(qpos, qvel)?.as_slice())?)
    }

    /// The frame from `homes` for this place; `None` if mozzi and MuJoCo use the same frame.
    fn home(&self, k: usize) -> Option<SE3> {
        let found = self.homes.binary_search_by_key(&k, |(place, _)| *place).ok()?;
        Some(self.homes[found].1).filter(|home| *home != SE3::identity())
    }

    /// For each free joint, the index of its linear velocity in `qvel`, and the rotation from its axes to MuJoCo's.
    fn orientations(&self, theta: &[f64]) -> Result<Vec<(usize, SO3)>, Error> {
        check_length("theta", theta.len(), self.order.nq())?;
        let (mut turns, mut at) = (Vec::new(), 0);
        for (k, place) in self.order.places().iter().enumerate() {
            if let (Freedom::Free, &[w, x, y, z, ..]) = (place.freedom, &theta[place.positions()]) {
                check_unit([w, x, y, z])?;
                let R = SO3::from_quaternion(w, Vec3([x, y, z]));
                turns.push((at, self.home(k).map_or(R, |home| home.R * R)));
            }
            at += place.freedom.velocities();
        }
        Ok(turns)
    }

    /// β = Ẋ `qvel`: −ω × v in the rows of v, because the body's axes rotate.
    fn spin(&self, dtheta: &[f64]) -> Result<DVector<f64>, Error> {
        check_length("dtheta", dtheta.len(), self.order.n())?;
        let mut beta = DVector::zeros(self.order.n());
        for place in self.order.places().iter().filter(|place| place.freedom == Freedom::Free) {
            let V = Twist::from_array(core::array::from_fn(|k| dtheta[place.j + k]));
            let turning = V.v.cross(V.w);
            (0..3).for_each(|i| beta[place.j + 3 + i] = turning.0[i]);
        }
        Ok(beta)
    }

    /// A list of velocities or accelerations with the mimic joints'.
    fn with_rates(&self, mine: &[f64], list: DVector<f64>) -> DVector<f64> {
        with(&self.followers, |follower| follower.v, |follower| follower.ratio * mine[follower.dtheta], list)
    }

    /// A list of velocities or accelerations without the mimic joints'.
    fn without_rates(&self, what: &'static str, theirs: &[f64]) -> Result<Vec<f64>, Error> {
        check_length(what, theirs.len(), self.order.n() + self.followers.len())?;
        Ok(without(&self.followers, |follower| follower.v, theirs))
    }

    /// Forces, with those of mimic joints in their source joints: of equal power.
    fn gathered(&self, what: &'static str, theirs: &[f64]) -> Result<Vec<f64>, Error> {
        let mut forces = self.without_rates(what, theirs)?;
        for follower in &self.followers {
            for (k, force) in forces.iter_mut().enumerate() {
                if self.order.velocity(k) == follower.dtheta {
                    *force += follower.ratio * theirs[follower.v];
                }
            }
        }
        Ok(forces)
    }

    /// M and h of the robot do not have the parts of mimic joints, which MuJoCo has.
    fn check_independent(&self, what: &'static str) -> Result<(), Error> {
        let Some(Follower { name, .. }) = self.followers.first() else { return Ok(()) };
        let found = format!("that of a robot with the mimic joint `{name}`");
        let expected = "one without, since MuJoCo's has a row for it, too: convert MuJoCo's to mozzi's instead";
        Err(Error::BadArgument { what, found, expected })
    }

    /// X `theirs`; X⁻ᵀ is the same matrix: a rotation and a permutation.
    fn turned_back(&self, qpos: &[f64], what: &'static str, theirs: &[f64]) -> Result<DVector<f64>, Error> {
        let R = self.orientations(self.from_configuration(qpos)?.as_slice())?;
        check_length(what, theirs.len(), self.order.n())?;
        let turned = turned(DVector::from_column_slice(theirs), back(R));
        self.order.velocities_from(what, turned.as_slice())
    }
}
