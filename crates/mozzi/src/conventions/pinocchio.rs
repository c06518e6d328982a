//! Pinocchio's convention.

use super::JointOrder;
use super::joint_order::check_length;
use crate::kinematics::Jacobian;
use crate::model::description::{Joint, Link};
use crate::model::{Error, Freedom, Model, Place};
use crate::scalar::{Real, Scalar};
use crate::spatial::SpatialInertia;
use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// Converts states, forces and matrices of a model to and from Pinocchio's order.
///
/// | | mozzi | Pinocchio (a floating base is its `JointModelFreeFlyer`) |
/// |---|---|---|
/// | configuration | (q_w, q_x, q_y, q_z, p, joints) | `q` = (p, q_x, q_y, q_z, q_w, joints) |
/// | velocity | (ω, v, joints), in the base link's coordinates | `v` = (v, ω, joints), in the same |
/// | acceleration | its derivative | `a`, its derivative: the spatial one, in the same |
/// | force | (m, f, joints) | `tau` = (f, m, joints) |
///
/// A ball is its `JointModelSpherical`: (q_x, q_y, q_z, q_w), and the same ω. A free joint inside the robot is like a
/// floating base.
///
/// Joints are in the order of Pinocchio's URDF reader: depth first, siblings alphabetically. A continuous joint has two
/// positions, (cos θ, sin θ). Mimic joints have none, as with `mimic=True`.
///
/// X is a permutation, so round trips are exact except for those two positions. h, c, g and JᵀF convert like a
/// [`force`](Self::force); C, Ṁ, M⁻¹, ∂τ and ∂θ̈ like M.
///
/// ```
/// # use mozzi::{Base, Description, Solid};
/// let drone = Description::new("drone").link("body", Solid::Box([0.3, 0.3, 0.1]).inertia(1.5));
/// let model = drone.build()?.with_base(Base::Floating)?;
/// let pinocchio = mozzi::conventions::Pinocchio::new(&model)?;
/// let q = pinocchio.configuration(&[1.0, 0.0, 0.0, 0.0, 0.1, 0.2, 0.3])?;
/// assert_eq!(q.as_slice(), [0.1, 0.2, 0.3, 0.0, 0.0, 0.0, 1.0]);
/// assert_eq!(pinocchio.velocity(&[0.4, 0.5, 0.6, 1.0, 2.0, 3.0])?.as_slice(), [1.0, 2.0, 3.0, 0.4, 0.5, 0.6]);
/// # Ok::<(), mozzi::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Pinocchio {
    order: JointOrder,
    /// Whether the k-th joint has the positions (cos θ, sin θ).
    is_circle: Vec<bool>,
}

impl Pinocchio {
    /// The order in which Pinocchio reads the robot's URDF. A `revolute` joint without bounds in the file is unlimited
    /// in mozzi but has one position in Pinocchio: for such robots use [`with_joints`](Self::with_joints).
    ///
    /// # Errors
    /// [`Error::BadArgument`] for a planar joint: Pinocchio's velocities of it are along axes that turn with θ.
    pub fn new(model: &Model) -> Result<Self, Error> {
        if let Some(joint) = planar_joints(model).next() {
            return Err(of_a_planar_joint(joint));
        }
        let order = JointOrder::new(model, depth_first_by_the_alphabet(model));
        let joints: Vec<&Joint> = model.joints().collect();
        let is_circle = order.joints().iter().map(|&j| turns_without_limits(joints[j])).collect();
        Ok(Pinocchio { order, is_circle })
    }

    /// The order of a Pinocchio model: the names of its joints (`model.names`, without the universe and the free
    /// flyer), and their numbers of positions (`model.nqs`, likewise).
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NoSuchJoint`] or [`Error::BadArgument`] unless the names are the independent
    /// joints, each once, with 1 or 2 positions, 4 for a ball, 7 for a free joint; as by [`new`](Self::new).
    pub fn with_joints(model: &Model, names: &[&str], nqs: &[usize]) -> Result<Self, Error> {
        if let Some(joint) = planar_joints(model).find(|joint| names.contains(joint)) {
            return Err(of_a_planar_joint(joint));
        }
        let order = JointOrder::by_name(model, names)?;
        check_length("the list of joints' numbers of positions", nqs.len(), names.len())?;
        for ((k, &nq), &joint) in nqs.iter().enumerate().zip(order.joints()) {
            let (expected, fits) = match model.places()[joint].freedom {
                Freedom::One => ("1 or 2", [1, 2].contains(&nq)),
                Freedom::Ball => ("4 of a ball", nq == 4),
                Freedom::Free => ("7 of a free joint", nq == 7),
            };
            if !fits {
                let found = alloc::format!("{nq} of `{}`", names[k]);
                return Err(Error::BadArgument { what: "a joint's number of positions", found, expected });
            }
        }
        Ok(Pinocchio { order, is_circle: nqs.iter().map(|&nq| nq == 2).collect() })
    }

    /// mozzi's joint index of each of Pinocchio's joints.
    pub fn joints(&self) -> &[usize] {
        self.order.joints()
    }

    /// mozzi's places in Pinocchio's order, a floating base's first, and which of them have the positions (cos θ, sin
    /// θ).
    fn places(&self) -> impl Iterator<Item = (&Place, bool)> {
        let base = self.order.places().len() - self.is_circle.len();
        self.order.places().iter().zip(core::iter::repeat_n(false, base).chain(self.is_circle.iter().copied()))
    }

    /// Pinocchio's `nq`: a continuous joint has two positions.
    pub fn nq(&self) -> usize {
        self.order.nq() + self.is_circle.iter().filter(|&&is_circle| is_circle).count()
    }

    /// `q` from θ.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn configuration(&self, theta: &[f64]) -> Result<DVector<f64>, Error> {
        check_length("theta", theta.len(), self.order.nq())?;
        let mut q = Vec::with_capacity(self.nq());
        for (place, is_circle) in self.places() {
            match (place.freedom, &theta[place.positions()]) {
                (Freedom::Free, &[w, x, y, z, px, py, pz]) => q.extend([px, py, pz, x, y, z, w]),
                (Freedom::Ball, &[w, x, y, z]) => q.extend([x, y, z, w]),
                (_, angle) if is_circle => {
                    let (sin, cos) = Scalar::sin_cos(angle[0]);
                    q.extend([cos, sin]);
                }
                (_, mine) => q.extend(mine),
            }
        }
        Ok(DVector::from_vec(q))
    }

    /// θ from `q`; a continuous joint's in (−π, π].
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn from_configuration(&self, q: &[f64]) -> Result<DVector<f64>, Error> {
        check_length("q", q.len(), self.nq())?;
        let (mut theta, mut rest) = (vec![0.0; self.order.nq()], q);
        for (place, is_circle) in self.places() {
            let (theirs, others) = rest.split_at(place.freedom.positions() + usize::from(is_circle));
            rest = others;
            let mine = &mut theta[place.positions()];
            match (place.freedom, theirs) {
                (Freedom::Free, &[px, py, pz, x, y, z, w]) => mine.copy_from_slice(&[w, x, y, z, px, py, pz]),
                (Freedom::Ball, &[x, y, z, w]) => mine.copy_from_slice(&[w, x, y, z]),
                (_, &[cos, sin]) => mine[0] = Real::atan2(sin, cos),
                (_, theirs) => mine.copy_from_slice(theirs),
            }
        }
        Ok(DVector::from_vec(theta))
    }

    /// `v` from θ̇.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn velocity(&self, dtheta: &[f64]) -> Result<DVector<f64>, Error> {
        self.order.velocities_to("dtheta", dtheta)
    }

    /// θ̇ from `v`.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn from_velocity(&self, v: &[f64]) -> Result<DVector<f64>, Error> {
        self.order.velocities_from("v", v)
    }

    /// `a` from θ̈: both are the derivatives of their velocities' entries.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn acceleration(&self, ddtheta: &[f64]) -> Result<DVector<f64>, Error> {
        self.order.velocities_to("ddtheta", ddtheta)
    }

    /// θ̈ from `a`.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn from_acceleration(&self, a: &[f64]) -> Result<DVector<f64>, Error> {
        self.order.velocities_from("a", a)
    }

    /// `tau` from τ; likewise `nle` from h, and every other force.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn force(&self, tau: &[f64]) -> Result<DVector<f64>, Error> {
        self.order.velocities_to("tau", tau)
    }

    /// τ from `tau`.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn from_force(&self, tau: &[f64]) -> Result<DVector<f64>, Error> {
        self.order.velocities_from("tau", tau)
    }

    /// `M` from M; likewise C and Ṁ.
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::BadArgument`] for a matrix that is not square.
    pub fn mass_matrix(&self, M: &DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
        self.order.matrix_to("M", M)
    }

    /// M from `M`.
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::BadArgument`] for a matrix that is not square.
    pub fn from_mass_matrix(&self, M: &DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
        self.order.matrix_from("M", M)
    }

    /// `J`, 6 × n, linear rows first, from J: a body Jacobian (`LOCAL`) or a space Jacobian (`WORLD`), or one's rate.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn jacobian(&self, J: &Jacobian) -> Result<DMatrix<f64>, Error> {
        check_length("J", J.0.len(), self.order.n())?;
        Ok(DMatrix::from_fn(6, self.order.n(), |i, k| J.0[self.order.velocity(k)].to_linear_first()[i]))
    }

    /// A body's `toDynamicParameters()`, (m, mc, I_xx, I_xy, I_yy, I_xz, I_yz, I_zz), from its ten of
    /// [`Model::parameters`], (m, mc, I_xx, I_xy, I_xz, I_yy, I_yz, I_zz); or a body's ten columns of a row of
    /// `computeJointTorqueRegressor` from those of [`Model::regressor`]. It is its own inverse.
    pub fn body_parameters(mut parameters: [f64; 10]) -> [f64; 10] {
        parameters.swap(6, 7); // I_xz and I_yy
        parameters
    }
}

/// True for a revolute joint without position limits.
fn turns_without_limits(joint: &Joint) -> bool {
    joint.limits.position.is_none() && joint.kind.name() == "revolute"
}

/// The names of planar joints of a URDF, series of `j.x`, `j.y` and `j.theta` with links without mass, of which
/// something moves.
fn planar_joints(model: &Model) -> impl Iterator<Item = &str> {
    let robot = model.description();
    let is_part = |name: &str| {
        let is_empty = |link: &Link| link.name == name && link.inertia == SpatialInertia::zero();
        robot.joints.iter().any(|joint| joint.name == name && joint.child == name) && robot.links.iter().any(is_empty)
    };
    robot.joints.iter().filter_map(move |joint| {
        let name = joint.name.strip_suffix(".theta")?;
        let [x, y] = ["x", "y"].map(|way| alloc::format!("{name}.{way}"));
        let moves = [&x, &y, &joint.name].iter().any(|part| model.joint_names().any(|known| known == part.as_str()));
        (moves && joint.parent == y && is_part(&x) && is_part(&y)).then_some(name)
    })
}

fn of_a_planar_joint(name: &str) -> Error {
    Error::BadArgument {
        what: "a joint for Pinocchio",
        found: alloc::format!("the planar joint `{name}`, whose velocities are along axes that turn there, not here"),
        expected: "joints of which both have the same velocities",
    }
}

/// The numbers of the independent joints: depth first, siblings (also fixed ones) by their names' bytes.
fn depth_first_by_the_alphabet(model: &Model) -> Vec<usize> {
    let robot = model.description();
    let number: BTreeMap<&str, usize> = model.joint_names().enumerate().map(|(j, name)| (name, j)).collect();
    let mut carried: BTreeMap<&str, Vec<&Joint>> = BTreeMap::new();
    for joint in &robot.joints {
        carried.entry(&joint.parent).or_default().push(joint);
    }
    // last first: the stack reverses them
    carried.values_mut().for_each(|siblings| siblings.sort_unstable_by(|a, b| b.name.cmp(&a.name)));
    let on = |link: &str| carried.get(link).cloned().unwrap_or_default();
    let (mut stack, mut numbers) = (on(&robot.links[model.structure.base].name), Vec::new());
    while let Some(joint) = stack.pop() {
        numbers.extend(number.get(joint.name.as_str()));
        stack.extend(on(&joint.child));
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::description::{JointKind, Limits};
    use crate::model::{Base, Description};
    use crate::spatial::ScrewAxis;
    use crate::testing::{Random, floating_tree, inertia, state, tree};
    use alloc::format;

    /// On the base `b` and `a`, in this order; on `b` a weld with `b2`, then `b1`; `a` turns without limits.
    fn siblings(base: Base) -> Model {
        let mut robot = Description::new("siblings").link("root", inertia(1));
        for (name, parent) in [("b", "root"), ("weld", "b"), ("b2", "weld"), ("b1", "b"), ("a", "root")] {
            let axis = ScrewAxis::new([0.0, 0.0, 1.0], [0.0; 3]).expect("unit");
            let kind = if name == "weld" { JointKind::Fixed } else { JointKind::Screw(axis) };
            let mut joint = Joint::new(name, parent, name, crate::SE3::translation([0.1, 0.2, 0.3]), kind);
            joint.limits = Limits { position: (name != "a").then_some([-1.0, 1.0]), ..Limits::default() };
            robot = robot.link(name, inertia(2)).joint(joint);
        }
        robot.base = base;
        robot.build().expect("a sound robot")
    }

    #[test]
    fn siblings_stand_by_the_alphabet_and_circles_have_two_positions() {
        let model = siblings(Base::Floating);
        assert!(model.joint_names().eq(["b", "b2", "b1", "a"]));
        let pinocchio = Pinocchio::new(&model).expect("no planar joint");
        assert_eq!((pinocchio.joints(), pinocchio.nq()), (&[3, 0, 2, 1][..], 12)); // a, b, b1, weld's b2
        let theta = [0.5, 0.1, -0.7, 0.5, 1.0, 2.0, 3.0, 10.0, 20.0, 30.0, 2.0];
        let q = pinocchio.configuration(&theta).expect("nq");
        let (sin, cos) = 2.0_f64.sin_cos();
        let expected = [1.0, 2.0, 3.0, 0.1, -0.7, 0.5, 0.5, cos, sin, 10.0, 30.0, 20.0];
        assert!(q.iter().zip(expected).all(|(a, b)| (a - b).abs() <= f64::EPSILON), "{q}");
        let back = pinocchio.from_configuration(q.as_slice()).expect("nq");
        assert_eq!(back.as_slice()[..10], theta[..10]);
        assert!((back[10] - 2.0).abs() <= 2.0 * f64::EPSILON);
        let named = Pinocchio::with_joints(&model, &["a", "b", "b1", "b2"], &[1; 4]).expect("its joints");
        assert_eq!((named.joints(), named.nq()), (pinocchio.joints(), 11));
        let q = named.configuration(&theta).expect("nq");
        assert_eq!(named.from_configuration(q.as_slice()).expect("nq").as_slice(), theta);
        assert!(Pinocchio::with_joints(&model, &["a", "b", "b1", "b2"], &[1, 1, 3, 1]).is_err());
        assert!(Pinocchio::with_joints(&model, &["a", "b", "b1", "b2"], &[1; 3]).is_err());
    }

    #[test]
    fn power_energy_and_the_equation_of_motion_are_the_same() {
        for model in [siblings(Base::Fixed), siblings(Base::Floating), tree(4, 7, 2), floating_tree(4, 7, 2)] {
            let (pinocchio, n) = (Pinocchio::new(&model).expect("no planar joint"), model.n());
            let [theta, dtheta, ddtheta] = state(&model, 5);
            let tau = Random(6).vector(n, 3.0);
            let (v, a) = (pinocchio.velocity(&dtheta).expect("n"), pinocchio.acceleration(&ddtheta).expect("n"));
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let power = pinocchio.force(&tau).expect("n").dot(&v) - dot(&tau, &dtheta);
            assert!(power.abs() < 1e-13, "{power}");
            let M = pinocchio.mass_matrix(&model.mass_matrix(&theta).expect("M")).expect("n");
            let K = model.kinetic_energy(&theta, &dtheta).expect("K");
            assert!((0.5 * v.dot(&(&M * &v)) - K).abs() < 1e-13 * K);
            let environment = model.environment();
            let h = pinocchio.force(model.bias_forces(&theta, &dtheta, &environment).expect("h").as_slice());
            let needed = model.forward_dynamics(&theta, &dtheta, &tau, &environment).expect("θ̈");
            let friction = model.joint_friction(&dtheta).expect("f") + model.spring_forces(&theta).expect("f");
            let friction = pinocchio.force(friction.as_slice()).expect("n");
            let found = &M * pinocchio.acceleration(needed.as_slice()).expect("n") + h.expect("n") + friction;
            let error = (found - pinocchio.force(&tau).expect("n")).amax();
            assert!(error < 1e-12 * M.amax() * (needed.amax() + dtheta.len() as f64), "{error}");
            // round trip, to the bit
            assert_eq!(pinocchio.from_velocity(v.as_slice()).expect("n").as_slice(), dtheta);
            assert_eq!(pinocchio.from_acceleration(a.as_slice()).expect("n").as_slice(), ddtheta);
            let back = pinocchio.from_force(pinocchio.force(&tau).expect("n").as_slice()).expect("n");
            assert_eq!(back.as_slice(), tau);
            assert_eq!(pinocchio.from_mass_matrix(&M).expect("n"), model.mass_matrix(&theta).expect("M"));
        }
    }

    #[test]
    fn a_jacobian_gives_the_same_twist() {
        let model = floating_tree(3, 6, 1);
        let pinocchio = Pinocchio::new(&model).expect("no planar joint");
        let [theta, dtheta, _] = state(&model, 7);
        let J = model.body_jacobian(&theta, model.end_effector().expect("its tip")).expect("J");
        let V = &J * dtheta.as_slice();
        let theirs = pinocchio.jacobian(&J).expect("n") * pinocchio.velocity(&dtheta).expect("n");
        let error = theirs.iter().zip(V.to_linear_first()).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(error < 1e-13, "{error}");
    }

    #[test]
    fn wrong_lengths_are_errors_that_say_so() {
        let pinocchio = Pinocchio::new(&siblings(Base::Floating)).expect("no planar joint");
        let said = |answer: Result<DVector<f64>, Error>| format!("{}", answer.expect_err("too short"));
        assert_eq!(said(pinocchio.configuration(&[0.0; 10])), "theta has 10 entries, expected 11");
        assert_eq!(said(pinocchio.from_configuration(&[0.0; 11])), "q has 11 entries, expected 12");
        assert_eq!(said(pinocchio.from_velocity(&[0.0; 4])), "v has 4 entries, expected 10");
        assert!(pinocchio.mass_matrix(&DMatrix::zeros(4, 4)).is_err());
        assert!(pinocchio.jacobian(&Jacobian(Vec::new())).is_err());
    }
}
