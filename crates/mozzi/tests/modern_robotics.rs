//! The published examples of the Modern Robotics package (oracles/modern_robotics.json).
#![allow(clippy::unwrap_used)]

use mozzi::model::{HomeFrames, Screws};
use mozzi::{Description, Environment, Mat3, Model, SE3, SO3, ScrewAxis, SpatialInertia, Twist, Vec3, Wrench};
use serde_json::Value;

fn oracle() -> Value {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracles/modern_robotics.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}
fn list(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}
fn rows<const R: usize, const C: usize>(value: &Value) -> [[f64; C]; R] {
    std::array::from_fn(|i| std::array::from_fn(|j| value[i][j].as_f64().unwrap()))
}
fn six(value: &Value) -> [f64; 6] {
    list(value).try_into().unwrap()
}
/// A configuration whose digits may be truncated.
fn pose(value: &Value) -> SE3 {
    let [x, y, z, _]: [[f64; 4]; 4] = rows(value);
    let R = Mat3::from_rows([[x[0], x[1], x[2]], [y[0], y[1], y[2]], [z[0], z[1], z[2]]]);
    SE3::new(SO3::nearest(R).unwrap().0, Vec3([x[3], y[3], z[3]]))
}

#[track_caller]
fn close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    let scale = expected.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= tolerance * scale, "{found:?} {expected:?}");
    }
}

#[test]
fn maps_of_chapter_3_to_5() {
    for map in oracle()["maps"].as_array().unwrap() {
        let (input, output) = (&map["input"], &map["output"]);
        let screws = |key: &str| -> Vec<ScrewAxis> {
            let unit = |V: Twist| ScrewAxis::normalize(V).unwrap();
            input[key].as_array().unwrap().iter().map(|S| unit(Twist::from_array(six(S))).0).collect()
        };
        match map["function"].as_str().unwrap() {
            "MatrixExp3" => {
                let R = SO3::exp(Mat3::from_rows(rows(&input["so3mat"])).vee());
                close(R.matrix().rows().as_flattened(), rows::<3, 3>(output).as_flattened(), 1e-15);
            }
            "MatrixLog3" => {
                let w = SO3::from_matrix(Mat3::from_rows(rows(&input["R"]))).unwrap().log();
                close(Mat3::hat(w).rows().as_flattened(), rows::<3, 3>(output).as_flattened(), 1e-15);
            }
            "MatrixExp6" => {
                let T = SE3::exp(Twist::vee(rows(&input["se3mat"])));
                close(T.to_matrix().as_flattened(), rows::<4, 4>(output).as_flattened(), 1e-15);
            }
            "MatrixLog6" => {
                let V = SE3::from_matrix(rows(&input["T"])).unwrap().log();
                close(V.hat().as_flattened(), rows::<4, 4>(output).as_flattened(), 1e-15);
            }
            "TransInv" => {
                let T = SE3::from_matrix(rows(&input["T"])).unwrap().inverse();
                close(T.to_matrix().as_flattened(), rows::<4, 4>(output).as_flattened(), 0.0);
            }
            "Adjoint" => {
                let Ad = SE3::from_matrix(rows(&input["T"])).unwrap().Ad();
                close(Ad.to_matrix().as_flattened(), rows::<6, 6>(output).as_flattened(), 0.0);
            }
            "ad" => {
                let ad = Twist::from_array(six(&input["V"])).ad();
                close(ad.to_matrix().as_flattened(), rows::<6, 6>(output).as_flattened(), 0.0);
            }
            "ScrewToAxis" => {
                let three = |key: &str| -> [f64; 3] { list(&input[key]).try_into().unwrap() };
                let S = ScrewAxis::from_line(three("s"), three("q"), input["h"].as_f64().unwrap()).unwrap();
                close(&S.twist().to_array(), &list(output), 0.0);
            }
            "FKinBody" | "FKinSpace" => {
                let space = input.get("Slist").is_some();
                let axes = screws(if space { "Slist" } else { "Blist" });
                // the link frames do not affect the tip: all at the base
                let mut home = vec![SE3::identity(); axes.len()];
                home.push(pose(&input["M"]));
                let screws = if space { Screws::Space(&axes) } else { Screws::Body(&axes) };
                let model = chain(HomeFrames::Base(&home), screws, axes.len());
                let T = model.forward_kinematics(&list(&input["thetalist"]), model.end_effector().unwrap()).unwrap();
                close(T.to_matrix().as_flattened(), rows::<4, 4>(output).as_flattened(), 1e-15);
            }
            "JacobianSpace" | "JacobianBody" => {
                let space = input.get("Slist").is_some();
                let axes = screws(if space { "Slist" } else { "Blist" });
                let home = vec![SE3::identity(); axes.len() + 1];
                let screws = if space { Screws::Space(&axes) } else { Screws::Body(&axes) };
                let model = chain(HomeFrames::Base(&home), screws, axes.len());
                let (theta, tip) = (list(&input["thetalist"]), model.end_effector().unwrap());
                let J = if space { model.space_jacobian(&theta, tip) } else { model.body_jacobian(&theta, tip) };
                let expected: [[f64; 4]; 6] = rows(output);
                close(J.unwrap().matrix().transpose().as_slice(), expected.as_flattened(), 1e-15);
            }
            other => panic!("no comparison for {other}"),
        }
    }
}

fn chain(frames: HomeFrames, screws: Screws, n: usize) -> Model {
    let massless = vec![SpatialInertia::zero(); n];
    Description::from_screws("chain", frames, &massless, screws).unwrap().build().unwrap()
}

/// The three-link example of chapter 8. A screw of size k is deliberately rescaled: its joint's θ by k, its τ by 1/k.
#[test]
fn dynamics_of_chapter_8() {
    for (name, refused) in [("three_link_published", true), ("three_link_unit_screws", false)] {
        let example = &oracle()[name];
        let items = |key: &str| example[key].as_array().unwrap().to_vec();
        let frames: Vec<SE3> = items("Mlist").iter().map(pose).collect();
        let inertias: Vec<_> = items("Glist").iter().map(|G| SpatialInertia::from_matrix(rows(G)).unwrap()).collect();
        let twists: Vec<Twist> = items("Slist").iter().map(|S| Twist::from_array(six(S))).collect();
        let unit = twists.iter().all(|S| ScrewAxis::new(S.w.0, S.v.0).is_ok());
        assert_eq!(unit, !refused);
        let (axes, sizes): (Vec<ScrewAxis>, Vec<f64>) =
            twists.iter().map(|&S| ScrewAxis::normalize(S).unwrap()).unzip();
        let mut robot =
            Description::from_screws(name, HomeFrames::Relative(&frames), &inertias, Screws::Space(&axes)).unwrap();
        robot.gravity = list(&example["g"]).try_into().unwrap();
        let model = robot.build().unwrap();

        let up = |key: &str| list(&example[key]).iter().zip(&sizes).map(|(x, k)| x * k).collect::<Vec<f64>>();
        let back = |tau: nalgebra::DVector<f64>| tau.iter().zip(&sizes).map(|(x, k)| x * k).collect::<Vec<f64>>();
        let (theta, dtheta, ddtheta) = (up("thetalist"), up("dthetalist"), up("ddthetalist"));
        let tip = [(model.end_effector().unwrap(), Wrench::from_array(six(&example["Ftip"])))];
        let environment = Environment { applied: &tip, ..model.environment() };
        let check = |key: &str, found: &[f64]| close(found, &list(&example[key]), 1e-13);
        check("InverseDynamics", &back(model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment).unwrap()));
        check("VelQuadraticForces", &back(model.velocity_product(&theta, &dtheta).unwrap()));
        check("GravityForces", &back(model.gravity_forces(&theta).unwrap()));
        check("EndEffectorForces", &back(model.tip_forces(&theta, &tip).unwrap()));
        let tau: Vec<f64> = list(&example["taulist"]).iter().zip(&sizes).map(|(x, k)| x / k).collect();
        let found = model.forward_dynamics(&theta, &dtheta, &tau, &environment).unwrap();
        let found: Vec<f64> = found.iter().zip(&sizes).map(|(x, k)| x / k).collect();
        check("ForwardDynamics", &found);
        let M = model.mass_matrix(&theta).unwrap();
        let scaled: Vec<f64> = (0..9).map(|e| M[(e / 3, e % 3)] * sizes[e / 3] * sizes[e % 3]).collect();
        close(&scaled, rows::<3, 3>(&example["MassMatrix"]).as_flattened(), 1e-13);
    }
}
