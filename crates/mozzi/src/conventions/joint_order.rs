//! The order of the joints in another library.

use crate::model::{Error, Model, Place};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// The other library's joint order.
#[derive(Clone, Debug)]
pub(super) struct JointOrder {
    /// mozzi's number of the other library's k-th joint, at k.
    joints: Vec<usize>,
    /// mozzi's place of each of these joints, after that of a floating base.
    places: Vec<Place>,
    /// mozzi's number of the other library's k-th velocity, at k: linear first, if a joint has both.
    velocities: Vec<usize>,
}

impl JointOrder {
    /// From mozzi's numbers of the other library's joints.
    pub fn new(model: &Model, joints: Vec<usize>) -> Self {
        let base = model.is_floating().then(|| model.configuration_space().places()[0]);
        let places: Vec<Place> = base.into_iter().chain(joints.iter().map(|&k| model.places()[k])).collect();
        let of_place = |place: &Place| {
            let (j, n) = (place.j, place.freedom.velocities());
            (0..n).map(move |k| if n == 6 { j + (k + 3) % 6 } else { j + k })
        };
        let velocities = places.iter().flat_map(of_place).collect();
        JointOrder { joints, places, velocities }
    }

    /// From joint names: each independent joint once.
    pub fn by_name(model: &Model, names: &[&str]) -> Result<Self, Error> {
        check_length("the list of joint names", names.len(), model.joint_names().len())?;
        let mut is_taken = vec![false; names.len()];
        let number = |name: &&str| {
            let Some(j) = model.joint_names().position(|known| known == *name) else {
                return Err(unknown(model, name));
            };
            if core::mem::replace(&mut is_taken[j], true) {
                let (what, found) = ("a joint name", format!("`{name}`, a second time"));
                return Err(Error::BadArgument { what, found, expected: "each independent joint once" });
            }
            Ok(j)
        };
        Ok(JointOrder::new(model, names.iter().map(number).collect::<Result<_, _>>()?))
    }

    /// mozzi's numbers of the other's joints.
    pub fn joints(&self) -> &[usize] {
        &self.joints
    }

    /// mozzi's place of each of the other's, a floating base's first.
    pub fn places(&self) -> &[Place] {
        &self.places
    }

    /// The length of θ.
    pub fn nq(&self) -> usize {
        self.places.iter().map(|place| place.freedom.positions()).sum()
    }

    /// The length of θ̇, and of the other's velocities.
    pub fn n(&self) -> usize {
        self.velocities.len()
    }

    /// A vector of velocities or forces in the other's order of joints, and linear first if a joint has both.
    pub fn velocities_to(&self, what: &'static str, mine: &[f64]) -> Result<DVector<f64>, Error> {
        check_length(what, mine.len(), self.n())?;
        Ok(DVector::from_fn(self.n(), |k, _| mine[self.velocity(k)]))
    }

    /// The inverse of [`velocities_to`](Self::velocities_to).
    pub fn velocities_from(&self, what: &'static str, theirs: &[f64]) -> Result<DVector<f64>, Error> {
        check_length(what, theirs.len(), self.n())?;
        let mut mine = DVector::zeros(self.n());
        (0..self.n()).for_each(|k| mine[self.velocity(k)] = theirs[k]);
        Ok(mine)
    }

    /// A bilinear form on velocities, such as M, in the other's order.
    pub fn matrix_to(&self, what: &'static str, mine: &DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
        check_square(what, mine, self.n())?;
        Ok(DMatrix::from_fn(self.n(), self.n(), |i, j| mine[(self.velocity(i), self.velocity(j))]))
    }

    /// The inverse of [`matrix_to`](Self::matrix_to).
    pub fn matrix_from(&self, what: &'static str, theirs: &DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
        check_square(what, theirs, self.n())?;
        let mut mine = DMatrix::zeros(self.n(), self.n());
        for i in 0..self.n() {
            (0..self.n()).for_each(|j| mine[(self.velocity(i), self.velocity(j))] = theirs[(i, j)]);
        }
        Ok(mine)
    }

    /// mozzi's number of the other's k-th velocity.
    pub fn velocity(&self, k: usize) -> usize {
        self.velocities[k]
    }
}

pub(super) fn check_square(what: &'static str, matrix: &DMatrix<f64>, n: usize) -> Result<(), Error> {
    let (rows, columns) = matrix.shape();
    check_length(what, rows * columns, n * n)?;
    if rows == n {
        return Ok(());
    }
    Err(Error::BadArgument { what, found: format!("{rows} × {columns}"), expected: "a square matrix" })
}

pub(super) fn check_length(what: &'static str, found: usize, expected: usize) -> Result<(), Error> {
    if found == expected { Ok(()) } else { Err(Error::WrongLength { what, found, expected }) }
}

fn unknown(model: &Model, name: &str) -> Error {
    let joint = model.moving_joints().find(|joint| joint.name == name);
    if let Some(mimic) = joint.and_then(|joint| joint.mimic.as_ref()) {
        let found = format!("`{name}`, which follows `{}`", mimic.joint);
        return Error::BadArgument { what: "a joint name", found, expected: "an independent joint" };
    }
    let known: Vec<String> = model.joint_names().map(ToString::to_string).collect();
    Error::NoSuchJoint { name: name.into(), known }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{floating_tree, tree};

    #[test]
    fn names_are_matched_each_once() {
        let model = floating_tree(2, 4, 1);
        let order = JointOrder::by_name(&model, &["joint3", "joint1", "joint2"]).expect("its joints");
        let mine: Vec<&str> = model.joint_names().collect();
        let theirs: Vec<&str> = order.joints().iter().map(|&j| mine[j]).collect();
        assert_eq!(theirs, ["joint3", "joint1", "joint2"]);
        let refused = |names: &[&str]| JointOrder::by_name(&model, names).expect_err("not its joints").to_string();
        assert_eq!(refused(&["joint1"]), "the list of joint names has 1 entries, expected 3");
        assert!(refused(&["joint1", "joint2", "knee"]).starts_with("there is no joint `knee`; this robot has `joint"));
        assert!(refused(&["joint1", "joint2", "joint1"]).contains("`joint1`, a second time"));
        assert!(refused(&["joint1", "joint2", "joint4"]).contains("`joint4`, which follows `joint"));
    }

    #[test]
    fn a_robot_without_joints_has_an_order() {
        let body = crate::Description::new("body").link("it", crate::testing::inertia(1)).build().expect("sound");
        assert_eq!(JointOrder::new(&body, Vec::new()).n(), 0);
    }

    #[test]
    fn there_and_back_is_the_same_to_the_bit() {
        for model in [tree(2, 4, 0), floating_tree(2, 4, 0)] {
            let order = JointOrder::by_name(&model, &["joint3", "joint1", "joint4", "joint2"]).expect("its joints");
            let list: Vec<f64> = (0..model.n()).map(|k| k as f64 + 0.1).collect();
            let there = order.velocities_to("a", &list).expect("n");
            assert_eq!(order.velocities_from("a", there.as_slice()).expect("n").as_slice(), list);
            let M = DMatrix::from_fn(model.n(), model.n(), |i, j| 10.0 * i as f64 + j as f64);
            assert_eq!(order.matrix_from("M", &order.matrix_to("M", &M).expect("n")).expect("n"), M);
            assert!(order.matrix_to("M", &DMatrix::zeros(1, model.n() * model.n())).is_err());
            assert!(order.velocities_to("a", &list[1..]).is_err());
        }
    }
}
