//! What emitted text says of its robot, its functions and their arrays.

use super::Precision;
use super::names::in_comment;
use crate::program::Program;
use crate::quantity::{Arguments, Quantity};
use mozzi::{FrameId, Model};

/// The head of a text.
pub(super) fn robot(model: &Model, open: Arguments, precision: Precision) -> Vec<String> {
    let mut lines = vec![
        format!("The dynamics of the robot `{}` as straight-line code.", in_comment(&model.description().name)),
        format!("Made by mozzi {}; make it anew instead of changing it.", env!("CARGO_PKG_VERSION")),
        String::new(),
    ];
    let numbers = if precision.is_f64() { "64-bit" } else { "32-bit" };
    lines.push(format!(
        "Numbers are {numbers} floats in SI units: m, rad, kg, s, N. Six numbers are angular first: twists (w, v), wrenches (m, f)."
    ));
    lines.push("Arrays must not overlap. A matrix is written by rows, where nothing else is said.".to_string());
    lines.push(
        "Frames: {s} is where the robot is fixed to, or what a floating base is seen from; a link's frame is its file's."
            .to_string(),
    );
    let gravity = match open.gravity {
        true => "an argument".to_string(),
        false => {
            let [x, y, z] = model.gravity().0;
            format!("({x}, {y}, {z}) m/s^2")
        }
    };
    lines.push(format!("In these functions gravity is {gravity}, in {{s}}, which does not move."));
    match open.wrench {
        Some(frame) => lines.push(format!("The frame `{}` applies a wrench, an argument.", frame_name(model, frame))),
        None => lines.push("The robot touches nothing.".to_string()),
    }
    if open.parameters {
        lines.push("Masses, inertias and frictions are an argument; geometry is built in.".to_string());
    }
    lines.push(format!(
        "Of an angle beyond {:?} rad, or NaN, all that depends on it is NaN; nothing else is checked.",
        precision.largest_angle()
    ));
    lines.push(String::new());
    let joints: Vec<_> = model.moving_joints().map(|joint| (joint.name.as_str(), joint.kind.name())).collect();
    if model.is_floating() {
        lines.push(
            "theta[0..6] is the base's pose in {s}: unit quaternion (w, x, y, z), origin (x, y, z) in m.".to_string(),
        );
        lines.push(
            "Entries 0 to 5 of velocities are its twist (w, v) in its own coordinates, rad/s and m/s; of accelerations their rates;"
                .to_string(),
        );
        lines.push("of forces the wrench (m, f) on it in its own coordinates, N m and N.".to_string());
    }
    let (positions, velocities) = (model.nq() - model.joint_names().len(), model.n() - model.joint_names().len());
    for (k, name) in model.joint_names().enumerate() {
        let kind = joints.iter().find(|(known, _)| *known == name).map_or("", |(_, kind)| kind);
        let units = if kind == "prismatic" { "m, m/s, m/s^2, N" } else { "rad, rad/s, rad/s^2, N m" };
        let places = match model.is_floating() {
            true => format!("theta[{}], others [{}]", positions + k, velocities + k),
            false => format!("[{k}]"),
        };
        lines.push(format!("  {places} {}: {kind}; {units}", in_comment(name)));
    }
    lines
}

fn frame_name(model: &Model, frame: FrameId) -> String {
    in_comment(model.frame_name(frame))
}

/// A quantity in words, and how much of it was left.
pub(super) fn quantity(model: &Model, quantity: Quantity, open: Arguments, program: &Program) -> Vec<String> {
    let frame = quantity.frame().map(|frame| frame_name(model, frame)).unwrap_or_default();
    let wrench = if open.wrench.is_some() { " + J^T F" } else { "" };
    let words = match quantity {
        Quantity::InverseDynamics => {
            format!("Forces: tau = M(theta) ddtheta + c(theta, dtheta) + g(theta){wrench} + friction.")
        }
        Quantity::MassMatrix => "Mass matrix M(theta), symmetric.".to_string(),
        Quantity::ForwardDynamics => {
            "Accelerations ddtheta, from M(theta) ddtheta = tau - what inverse_dynamics has beside.".to_string()
        }
        Quantity::BiasForces => format!("h = c(theta, dtheta) + g(theta){wrench}, without friction."),
        Quantity::VelocityProduct => "Coriolis and centrifugal forces c(theta, dtheta).".to_string(),
        Quantity::GravityForces => "Forces g(theta) that hold the robot against gravity.".to_string(),
        Quantity::ForwardKinematics(_) => format!("Pose of the frame `{frame}` in {{s}}: p_s = R p_b + p."),
        Quantity::BodyJacobian(_) => {
            format!("Body Jacobian of the frame `{frame}`: its twist, in its own coordinates, is J dtheta.")
        }
        Quantity::SpaceJacobian(_) => {
            format!("Space Jacobian of the frame `{frame}`: its spatial twist, in {{s}}, is J dtheta.")
        }
        Quantity::InverseDynamicsDerivatives => "Derivatives of inverse_dynamics.".to_string(),
        Quantity::ForwardDynamicsDerivatives => "Accelerations ddtheta and their derivatives.".to_string(),
    };
    let before =
        program.count_before_folding().map(|count| format!("Of {} flops of the recursive algorithm:", count.flops()));
    [words].into_iter().chain(before).collect()
}

/// Shape, meaning and unit of an array.
pub(super) fn array(model: &Model, quantity: Quantity, open: Arguments, name: &str) -> String {
    let (n, nq) = (model.n(), model.nq());
    let free = if model.is_floating() { "base and " } else { "" };
    match name {
        "theta" => format!("{nq}; positions of {free}joints, units above"),
        "dtheta" => format!("{n}; velocities"),
        "ddtheta" => format!("{n}; accelerations"),
        "tau" => format!("{n}; forces"),
        "h" | "c" | "g" => format!("{n}; forces, N m of turning joints, N of sliding ones"),
        "M" => format!("{n} x {n}; kg m^2, kg m, kg"),
        "R" => "3 x 3; orientation of the frame in {s}".to_string(),
        "p" => "3; origin of the frame in {s}, m".to_string(),
        "J" => format!("{n} columns of six, one after the other: (w, v) of each unit velocity"),
        "pivots" => format!(
            "{n}; what was divided by. One that is not positive, or below 1e-8 of the largest: the mass matrix is singular, results mean nothing"
        ),
        "parameters" => format!(
            "{}; of {free}moving links (m, m c, I_xx, I_xy, I_xz, I_yy, I_yz, I_zz) in their frames, kg, kg m, kg m^2; of joints armature, damping, friction",
            model.parameter_count()
        ),
        "gravity" => "3; in {s}, m/s^2".to_string(),
        "wrench" => format!(
            "6; (m, f) that the frame `{}` applies to what it touches, in its own coordinates, N m, N",
            open.wrench.map(|frame| frame_name(model, frame)).unwrap_or_default()
        ),
        "d_tau" => format!("{n} x {n}; d ddtheta_i / d tau_j, the inverse of the mass matrix"),
        _ => {
            let of = if quantity == Quantity::InverseDynamicsDerivatives { "tau" } else { "ddtheta" };
            let by = name.trim_start_matches("by_");
            let base = if model.is_floating() && by == "theta" { "; of the base along its twist" } else { "" };
            format!("{n} x {n}; d {of}_i / d {by}_j{base}")
        }
    }
}
