//! A robot from the lists of the Modern Robotics package: home frames M_{i−1,i}, spatial inertias G_i, screw axes S_i.
//!
//! The package's documentation uses an arm of three joints, the first of the UR5. Its first screw axis there is (1, 0,
//! 1, 0, 1, 0): ‖ω‖ = √2, not a unit screw, so that θ_1 is not an angle: θ_1 = 1 is a rotation by √2 rad. mozzi refuses
//! such an axis unless it is explicitly rescaled. With V = kA, A unit, the joint described by V and θ is described by A
//! and kθ, for e^{[V]θ} = e^{[A]kθ}; with rates kθ̇ and kθ̈; and because the power τθ̇ is the same, with the torque
//! τ/k. With K = diag(k, 1, 1):
//!
//! > τ_V(θ, θ̇, θ̈) = K τ_A(Kθ, Kθ̇, Kθ̈),  M_V(θ) = K M_A(Kθ) K,  θ̈_V(θ, θ̇, τ) = K⁻¹ θ̈_A(Kθ, Kθ̇, K⁻¹τ)
//!
//! That gives the published numbers. The intended axis, (0, 0, 1, 0, 0, 0), needs no rescaling: k = 1.

use mozzi::model::{HomeFrames, Screws};
use mozzi::{Description, Environment, Model, SE3, ScrewAxis, SpatialInertia, Twist, Wrench};
use mozzi_examples::{agree, row};
use nalgebra::{DMatrix, DVector};
use serde_json::Value;
use std::error::Error;

/// The numbers of the package, with its own results.
const ORACLE: &str = include_str!("../oracles/modern_robotics.json");

fn main() -> Result<(), Box<dyn Error>> {
    let oracle: Value = serde_json::from_str(ORACLE)?;

    println!("As published, S_1 = (1, 0, 1, 0, 1, 0):");
    let published = &oracle["three_link_published"];
    let S_1 = Twist::from_array(array(&list(&published["Slist"][0])?)?);
    let refusal = ScrewAxis::new(S_1.w.0, S_1.v.0).err().ok_or("‖ω‖ = √2 is refused")?;
    println!("  refused: {refusal}");
    let (axis, k) = ScrewAxis::normalize(S_1)?;
    println!("  rescaled knowingly: k = {k:.6}, A = ({})", row(&axis.twist().to_array()));
    compare(published, axis, k)?;

    println!("\nWith the axis that was meant, S_1 = (0, 0, 1, 0, 0, 0):");
    compare(&oracle["three_link_unit_screws"], ScrewAxis::new([0.0, 0.0, 1.0], [0.0; 3])?, 1.0)
}

/// All results of the package, for the robot whose first joint has the axis A and the magnitude k.
fn compare(example: &Value, A: ScrewAxis, k: f64) -> Result<(), Box<dyn Error>> {
    let numbers = |key: &str| list(&example[key]);
    let K = |key: &str| numbers(key).map(|list| [k * list[0], list[1], list[2]]);
    let scaled = |tau: DVector<f64>| [k * tau[0], tau[1], tau[2]];

    let model = robot(example, A)?;
    let (theta, dtheta, ddtheta) = (K("thetalist")?, K("dthetalist")?, K("ddthetalist")?);
    let tip = [(model.end_effector()?, Wrench::from_array(array(&numbers("Ftip")?)?))];
    let environment = Environment { applied: &tip, ..model.environment() };

    let tau = scaled(model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment)?);
    println!("  τ = [{}] N m", row(&tau));
    agree("InverseDynamics", &tau, &numbers("InverseDynamics")?, 1e-12);
    let K_matrix = DMatrix::from_diagonal(&DVector::from_vec(vec![k, 1.0, 1.0]));
    let M = &K_matrix * model.mass_matrix(&theta)? * &K_matrix;
    agree("MassMatrix", &M, &numbers("MassMatrix")?, 1e-12);
    let c = scaled(model.velocity_product(&theta, &dtheta)?);
    agree("VelQuadraticForces", &c, &numbers("VelQuadraticForces")?, 1e-12);
    agree("GravityForces", &scaled(model.gravity_forces(&theta)?), &numbers("GravityForces")?, 1e-12);
    agree("EndEffectorForces", &scaled(model.tip_forces(&theta, &tip)?), &numbers("EndEffectorForces")?, 1e-12);
    let mut tau = numbers("taulist")?;
    tau[0] /= k;
    let mut ddtheta = model.forward_dynamics(&theta, &dtheta, &tau, &environment)?;
    ddtheta[0] /= k;
    agree("ForwardDynamics", &ddtheta, &numbers("ForwardDynamics")?, 1e-12);
    Ok(())
}

/// The arm of an example, with this first axis.
fn robot(example: &Value, first: ScrewAxis) -> Result<Model, Box<dyn Error>> {
    let items = |key: &str| example[key].as_array().ok_or_else(|| format!("{key} is no list"));
    let (mut M, mut G, mut S) = (Vec::new(), Vec::new(), vec![first]);
    for frame in items("Mlist")? {
        let numbers: [f64; 16] = array(&list(frame)?)?;
        M.push(SE3::from_matrix(std::array::from_fn(|i| std::array::from_fn(|j| numbers[4 * i + j])))?);
    }
    for inertia in items("Glist")? {
        let numbers: [f64; 36] = array(&list(inertia)?)?;
        G.push(SpatialInertia::from_matrix(std::array::from_fn(|i| std::array::from_fn(|j| numbers[6 * i + j])))?);
    }
    for axis in &items("Slist")?[1..] {
        let [a, b, c, x, y, z] = array(&list(axis)?)?;
        S.push(ScrewAxis::new([a, b, c], [x, y, z])?);
    }
    let robot = Description::from_screws("three_link", HomeFrames::Relative(&M), &G, Screws::Space(&S))?;
    Ok(Description { gravity: array(&list(&example["g"])?)?, ..robot }.build()?)
}

/// All numbers of a list, or of a list of lists row by row.
fn list(value: &Value) -> Result<Vec<f64>, Box<dyn Error>> {
    match value.as_array() {
        Some(items) => Ok(items.iter().map(list).collect::<Result<Vec<_>, _>>()?.concat()),
        None => Ok(vec![value.as_f64().ok_or("not a number")?]),
    }
}

fn array<const K: usize>(list: &[f64]) -> Result<[f64; K], Box<dyn Error>> {
    Ok(list.try_into().map_err(|_| format!("{} numbers, expected {K}", list.len()))?)
}
