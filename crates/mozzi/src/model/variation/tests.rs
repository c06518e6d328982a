//! Robots with dual constants, against differences of rebuilt descriptions.

use super::Variation;
use crate::constraints::constraint_jacobian;
use crate::dynamics::{forward_dynamics, inverse_dynamics};
use crate::kinematics::forward_kinematics;
use crate::lie::SE3;
use crate::linalg::Vec3;
use crate::model::Model;
use crate::model::description::{Anchor, Constraint, Description, JointKind};
use crate::scalar::Dual;
use crate::spatial::{ScrewAxis, SpatialInertia, Twist};
use crate::testing::{floating_tree, state, tree, twist, wrench};
use crate::{Environment, Workspace, Wrench};
use alloc::string::ToString;
use alloc::vec;
use alloc::vec::Vec;

/// τ, θ̈, the tip's position and φ, and their derivatives along the changes, from dual constants.
fn by_duals(model: &Model, changes: &[Variation], seed: u64) -> Vec<Dual> {
    let with_parameter_tangent = model.with_parameter_tangent(changes).expect("known names");
    let [theta, dtheta, ddtheta] = state(model, seed).map(|x| Dual::constants(&x));
    let (mut w, tip) = (Workspace::<Dual>::new(&with_parameter_tangent), model.end_effector().expect("named"));
    let applied = [(tip, Wrench::from_array(wrench(seed).to_array().map(Dual::constant)))];
    let environment = Environment { applied: &applied, ..with_parameter_tangent.environment() };
    let (mut tau, mut found) = (ddtheta.clone(), ddtheta.clone());
    inverse_dynamics(&with_parameter_tangent, &theta, &dtheta, &ddtheta, &environment, &mut w, &mut tau);
    forward_dynamics(&with_parameter_tangent, &theta, &dtheta, &ddtheta, &environment, &mut w, &mut found);
    let p = forward_kinematics(&with_parameter_tangent, &theta, tip).p;
    let mut phi = Dual::constants(&vec![0.0; model.constraint_rows()]);
    constraint_jacobian(&with_parameter_tangent, &theta, &dtheta, &mut w, &mut [], &mut [], &mut phi);
    tau.into_iter().chain(found).chain(p.0).chain(phi).collect()
}

fn values(model: &Model, seed: u64) -> Vec<f64> {
    by_duals(model, &[], seed).into_iter().map(|x| x.value).collect()
}

/// Compares with central differences of the rebuilt description.
fn check(model: &Model, change: Variation, what: &str, perturb: impl Fn(&mut Description, f64)) {
    let h = 1e-5;
    let at = |step: f64| {
        let mut robot = model.description().clone();
        perturb(&mut robot, step);
        values(&robot.build().expect("sound"), 7)
    };
    let (plus, minus, found) = (at(h), at(-h), by_duals(model, &[change], 7));
    let n = model.n();
    for part in [0..n, n..2 * n, 2 * n..2 * n + 3, 2 * n + 3..found.len()] {
        let differences: Vec<f64> = part.clone().map(|k| (plus[k] - minus[k]) / (2.0 * h)).collect();
        let size = part.clone().map(|k| found[k].value.abs()).chain(differences.iter().map(|x| x.abs()));
        let size = size.fold(1.0, f64::max);
        for (k, difference) in part.zip(differences) {
            let error = (found[k].derivative - difference).abs() / size;
            assert!(error < 1e-7, "{what}, entry {k}: {} {difference}", found[k].derivative);
        }
    }
}

#[test]
fn duals_equal_differences_of_the_description() {
    let [a, b] = [1, 2].map(|k| Anchor::frame(["tool2", "link5"][k - 1]).at(SE3::exp(twist(k as u64))));
    let tied = tree(3, 7, 0).with_constraints(vec![Constraint::weld("tie", a, b)]).expect("two links");
    for model in [tied, tree(5, 8, 2), floating_tree(2, 6, 0)] {
        let places = model.description().clone();
        let link = |name: &str| places.links.iter().position(|link| link.name == name).expect("a link");
        for name in ["link0", "link2", "tool2", "link5"] {
            let i = link(name);
            let G = places.links[i].inertia;
            let (c, I_c) = (G.center_of_mass(), G.about_center_of_mass());
            check(&model, Variation::Mass { link: name }, name, |robot, h| {
                robot.links[i].inertia = SpatialInertia::new(G.mass + h, c, I_c);
            });
            let rate = Vec3([0.3, -0.2, 0.5]);
            check(&model, Variation::CenterOfMass { link: name, rate }, name, |robot, h| {
                robot.links[i].inertia = SpatialInertia::new(G.mass, c + rate * h, I_c);
            });
            let rate = crate::testing::inertia(9);
            check(&model, Variation::Inertia { link: name, rate }, name, |robot, h| {
                robot.links[i].inertia += rate * h;
            });
        }
        let motion = twist(4);
        for (i, joint) in places.joints.iter().enumerate() {
            let name = joint.name.as_str();
            check(&model, Variation::Placement { joint: name, motion }, name, |robot, h| {
                robot.joints[i].origin = joint.origin * SE3::exp(motion * h);
            });
            let JointKind::Screw(A) = joint.kind else { continue };
            let set = |robot: &mut Description, V: Twist| {
                robot.joints[i].kind = JointKind::Screw(ScrewAxis::normalize(V).expect("a screw").0);
            };
            check(&model, Variation::Axis { joint: name, motion }, name, |robot, h| {
                set(robot, SE3::exp(motion * h).Ad() * A.twist());
            });
            if !A.is_prismatic() {
                check(&model, Variation::Pitch { joint: name }, name, |robot, h| {
                    set(robot, Twist { v: A.twist().v + A.twist().w * h, ..A.twist() });
                });
            }
        }
    }
}

#[test]
fn changes_add_up_and_parameters_are_the_regressors_columns() {
    for model in [tree(3, 7, 2), floating_tree(2, 6, 1)] {
        let [theta, dtheta, ddtheta] = state(&model, 7);
        let Y = model.regressor(&theta, &dtheta, &ddtheta, &model.environment()).expect("lengths");
        let p = model.parameter_count();
        for k in 0..p {
            let mut unit = vec![0.0; p];
            unit[k] = 1.0;
            let found = by_duals(&model, &[Variation::Parameters(&unit)], 7);
            for (j, y) in Y.column(k).iter().enumerate() {
                assert!((found[j].derivative - y).abs() < 1e-12 * Y.amax(), "{k}: {} {y}", found[j].derivative);
            }
        }
        let (a, b) = (Variation::Mass { link: "link2" }, Variation::Axis { joint: "joint3", motion: twist(1) });
        let (one, other, both) = (by_duals(&model, &[a], 7), by_duals(&model, &[b], 7), by_duals(&model, &[a, b], 7));
        for ((a, b), both) in one.iter().zip(&other).zip(&both) {
            let sum = a.derivative + b.derivative;
            assert!((sum - both.derivative).abs() <= 1e-9 * (1.0 + sum.abs()), "{sum} {both:?}");
        }
    }
}

#[test]
fn what_cannot_vary_is_refused() {
    let model = tree(1, 5, 0);
    let fails = |change: Variation| model.with_parameter_tangent(&[change]).expect_err("refused").to_string();
    assert!(fails(Variation::Mass { link: "tip" }).contains("there is no frame `tip`"));
    assert!(fails(Variation::Axis { joint: "weld2", motion: twist(1) }).contains("`weld2`, which is fixed"));
    assert!(fails(Variation::Pitch { joint: "joint4" }).contains("`joint4`, which is prismatic"));
    assert!(fails(Variation::Placement { joint: "x", motion: twist(1) }).contains("there is no joint `x`"));
    assert!(fails(Variation::Parameters(&[0.0])).contains("has 1 entries, expected 75"));
}
