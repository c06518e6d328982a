//! Base parameters: the combinations of a model's parameters that its forces depend on, found by rank (Gautier 1991).

use super::regressor;
use crate::model::Model;
use crate::model::integrate;
use crate::random::Random;
use crate::spatial::Rounded;
use crate::workspace::Workspace;
use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// Independence threshold: a column of the stacked regressor depends on the columns before it if the part orthogonal to
/// them is smaller than this, relative to the column's length.
const INDEPENDENT: f64 = 1e-9;

/// The identifiable combinations π_b = K π of a model's parameters π: the smallest set that gives the same forces at
/// every state,
///
/// > Y π = Y_b π_b, Y_b the [`columns`](Self::columns) of Y
///
/// Each is one parameter plus multiples of others that have no separate effect.
#[derive(Clone, Debug)]
pub struct BaseParameters {
    /// The independent columns of the regressor, ascending: those that are not linear combinations of the columns
    /// before them.
    pub columns: Vec<usize>,
    /// K, one row for each base parameter and a column for each parameter.
    pub combination: DMatrix<f64>,
    /// The parameters' names.
    parameters: Vec<String>,
}

impl BaseParameters {
    /// The base parameters of any linear equations W π = b, stacked at as many states as determine their rank: by
    /// Gram-Schmidt without pivoting, so that among columns that cannot be distinguished the first is kept. `names`
    /// belong to the columns.
    ///
    /// Cost O(rows · p²).
    pub fn of_columns(W: &DMatrix<f64>, names: Vec<String>) -> Self {
        let p = W.ncols();
        // W = QR of the independent columns, twice so that Q is orthogonal to rounding
        let (mut Q, mut R, mut columns) = (Vec::<DVector<f64>>::new(), DMatrix::zeros(p, p), Vec::new());
        let largest = W.column_iter().fold(0.0_f64, |m, w| m.max(w.norm()));
        for k in 0..p {
            let (mut rest, size) = (W.column(k).clone_owned(), W.column(k).norm());
            for _ in 0..2 {
                for (i, q) in Q.iter().enumerate() {
                    let along = q.dot(&rest);
                    R[(i, k)] += along;
                    rest.axpy(-along, q, 1.0);
                }
            }
            let left = rest.norm();
            if left > INDEPENDENT * size && size > INDEPENDENT * largest {
                R[(columns.len(), k)] = left;
                Q.push(rest / left);
                columns.push(k);
            }
        }
        // w_k = W_b β with R_b β = Qᵀw_k
        let R = R.rows(0, columns.len());
        let combination =
            R.select_columns(&columns).solve_upper_triangular(&R.clone_owned()).unwrap_or_else(|| R.clone_owned());
        BaseParameters { columns, combination, parameters: names }
    }

    /// The number of base parameters: the rank of the stacked regressor.
    pub fn count(&self) -> usize {
        self.columns.len()
    }

    /// π_b = K π.
    ///
    /// # Panics
    /// When π is not as long as the model's parameters.
    pub fn values(&self, parameters: &[f64]) -> DVector<f64> {
        &self.combination * DVector::from_column_slice(parameters)
    }

    /// Y_b: the columns of a regressor that belong to the base parameters.
    ///
    /// # Panics
    /// When Y has fewer columns than the model parameters.
    pub fn regressor(&self, Y: &DMatrix<f64>) -> DMatrix<f64> {
        Y.select_columns(&self.columns)
    }

    /// Each combination as text: `link1.Izz + 0.25 link2.m`. Coefficients are rounded to six digits; those below 10⁻⁹
    /// are left out.
    pub fn names(&self) -> Vec<String> {
        (0..self.count()).map(|row| self.name(row)).collect()
    }

    /// The parameters that affect no force at any state, for example `link1.m` of a link that turns about a vertical
    /// axis.
    pub fn without_effect(&self) -> impl Iterator<Item = &str> {
        let silent = |k: &usize| self.combination.column(*k).iter().all(|c| c.abs() < INDEPENDENT);
        (0..self.parameters.len()).filter(silent).map(|k| self.parameters[k].as_str())
    }

    fn name(&self, row: usize) -> String {
        let own = self.columns[row];
        let mut text = self.parameters[own].clone();
        for (k, &c) in self.combination.row(row).iter().enumerate() {
            if k != own && c.abs() >= INDEPENDENT {
                let (sign, size) = (if c.is_sign_negative() { '-' } else { '+' }, c.abs());
                let factor =
                    if (size - 1.0).abs() < INDEPENDENT { String::new() } else { format!("{} ", Rounded(size)) };
                text.push_str(&format!(" {sign} {factor}{}", self.parameters[k]));
            }
        }
        text
    }
}

impl Model<f64> {
    /// The base parameters under the model's gravity, {s} at rest: by rank of the regressor, stacked at random states
    /// (always the same ones). Among parameters that cannot be distinguished, the one nearest to the base is kept and
    /// the others are added to it. Joint limits are ignored: these are the combinations that *some* motion can
    /// identify.
    ///
    /// Cost O(p³) for p parameters.
    pub fn base_parameters(&self) -> BaseParameters {
        BaseParameters::of_columns(&stacked_regressor(self), self.parameter_names())
    }
}

/// Regressors at random states, stacked: more rows than parameters.
fn stacked_regressor(model: &Model) -> DMatrix<f64> {
    let (n, p) = (model.n(), model.parameter_count());
    let states = (2 * p).checked_div(n).map_or(0, |enough| enough + 10);
    let mut random = Random(1);
    let (mut workspace, mut Y, mut rows) = (Workspace::new(model), vec![0.0; n * p], Vec::new());
    for _ in 0..states {
        let mut theta = model.neutral_configuration();
        integrate(model, &mut theta, &random.vector(n, 3.0), 1.0);
        let (dtheta, ddtheta) = (random.vector(n, 2.0), random.vector(n, 4.0));
        regressor(model, &theta, &dtheta, &ddtheta, &model.environment(), &mut workspace, &mut Y);
        rows.extend_from_slice(&Y);
    }
    DMatrix::from_row_slice(states * n, p, &rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::description::{Joint, JointKind};
    use crate::testing::{inertia, state};
    use crate::{Description, SE3, ScrewAxis, dynamics::tests};

    /// Two links in the plane of x and y, each turning about z, the second one 0.5 m along x of the first.
    fn planar(gravity: [f64; 3]) -> Model {
        let turn = JointKind::Screw(ScrewAxis::new([0.0, 0.0, 1.0], [0.0; 3]).expect("unit"));
        let robot = Description::new("2R").link("base", inertia(0)).link("link1", inertia(1)).link("link2", inertia(2));
        let robot = robot.joint(Joint::new("joint1", "base", "link1", SE3::identity(), turn));
        let elbow = SE3::translation([0.5, 0.0, 0.0]);
        robot.joint(Joint::new("joint2", "link1", "link2", elbow, turn)).with_gravity(gravity).build().expect("sound")
    }

    #[test]
    fn the_planar_arm_has_the_combinations_derived_by_hand() {
        // By Lagrange, with the elbow at l: 𝒦 = ½ (Izz₁ + l² m₂) θ̇₁² + ½ Izz₂ (θ̇₁ + θ̇₂)² + l θ̇₁(θ̇₁ + θ̇₂)(mcx₂ cos
        // θ₂ − mcy₂ sin θ₂), and 𝒫 holds mcx₁ + l m₂ and mcy₁. Armature 1 acts as Izz₁, and each other joint parameter
        // acts on its own.
        let of_joints = [
            "joint1.damping",
            "joint1.friction",
            "joint1.stiffness",
            "joint1.preload",
            "joint2.armature",
            "joint2.damping",
            "joint2.friction",
            "joint2.stiffness",
            "joint2.preload",
        ];
        let upright = planar([0.0, -9.81, 0.0]).base_parameters();
        let of_links = [
            "link1.mcx + 0.5 link2.m",
            "link1.mcy",
            "link1.Izz + 0.25 link2.m + joint1.armature",
            "link2.mcx",
            "link2.mcy",
            "link2.Izz",
        ];
        assert_eq!(upright.names(), [&of_links[..], &of_joints].concat());
        let lying = planar([0.0, 0.0, -9.81]).base_parameters();
        assert_eq!(lying.names(), [&of_links[2..], &of_joints].concat());
        assert!(lying.without_effect().eq([
            "link1.m",
            "link1.mcx",
            "link1.mcy",
            "link1.mcz",
            "link1.Ixx",
            "link1.Ixy",
            "link1.Ixz",
            "link1.Iyy",
            "link1.Iyz",
            "link2.mcz",
            "link2.Ixx",
            "link2.Ixy",
            "link2.Ixz",
            "link2.Iyy",
            "link2.Iyz",
        ]));
    }

    #[test]
    fn the_ur5_has_its_36_inertial_combinations() {
        // axes of the UR5 (Modern Robotics, section 4.1.1), at the places of its joints; bodies without symmetry
        let joints: [([f64; 3], [f64; 3]); 6] = [
            ([0.0, 0.0, 1.0], [0.0, 0.0, 0.089]),
            ([0.0, 1.0, 0.0], [0.0, 0.136, 0.089]),
            ([0.0, 1.0, 0.0], [0.425, 0.016, 0.089]),
            ([0.0, 1.0, 0.0], [0.817, 0.016, 0.089]),
            ([0.0, 0.0, -1.0], [0.817, 0.109, 0.089]),
            ([0.0, 1.0, 0.0], [0.817, 0.109, -0.006]),
        ];
        let (mut robot, mut at) = (Description::new("UR5").link("0", inertia(0)), [0.0; 3]);
        for (i, (axis, place)) in joints.into_iter().enumerate() {
            let kind = JointKind::Screw(ScrewAxis::new(axis, [0.0; 3]).expect("unit"));
            let origin = SE3::translation(core::array::from_fn(|k| place[k] - at[k]));
            let (parent, child) = (format!("{i}"), format!("{}", i + 1));
            robot = robot.link(child.clone(), inertia(i as u64)).joint(Joint::new(
                format!("joint{child}"),
                parent,
                child,
                origin,
                kind,
            ));
            at = place;
        }
        let base = robot.build().expect("sound").base_parameters();
        assert_eq!(base.columns.iter().filter(|&&k| k < 60).count(), 36);
        // rotors 1 and 2 act as the inertia of their links about the axes, the other four on their own; 12 of friction
        // and 12 of springs
        assert_eq!(base.count(), 36 + 4 + 12 + 12);
        let names = base.names();
        assert!(names.iter().any(|name| name.starts_with("2.Iyy") && name.ends_with("+ joint2.armature")), "{names:?}");
    }

    #[test]
    fn a_free_body_shows_all_of_itself_and_a_bolted_one_nothing() {
        let body = Description::new("body").link("it", inertia(1));
        let free = body.clone().floating().build().expect("sound");
        assert_eq!(free.base_parameters().names(), free.parameter_names());
        assert_eq!(body.build().expect("sound").base_parameters().count(), 0);
    }

    #[test]
    fn they_give_the_same_forces_and_their_number_is_the_rank() {
        for (seed, model) in tests::models().filter(|(_, model)| model.n() < 16) {
            let base = model.base_parameters();
            let singular = stacked_regressor(&model).singular_values();
            let rank = singular.iter().filter(|&&s| s > 1e-10 * singular[0]).count();
            assert_eq!(base.count(), rank, "model {seed}");
            let [theta, dtheta, ddtheta] = state(&model, seed);
            let Y = model.regressor(&theta, &dtheta, &ddtheta, &model.environment()).expect("lengths");
            let (pi, terms) = (DVector::from_vec(model.parameters()), Y.amax());
            let (whole, by_base) = (&Y * &pi, base.regressor(&Y) * base.values(pi.as_slice()));
            let error = (&whole - by_base).amax() / (terms * pi.amax());
            assert!(error < 1e-10, "model {seed}: {error:e}");
        }
    }
}
