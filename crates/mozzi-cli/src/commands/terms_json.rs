//! The quantities of one state as JSON, by the library's names.

use super::terms::Terms;
use crate::json::{dvector, jacobian, matrix, of_robot, pose, rows, vector};
use mozzi::{ClosedForm, TaskFrame};
use nalgebra::DVector;
use serde_json::{Value, json};

pub fn object(terms: &Terms) -> Value {
    let (model, tip) = (terms.model, terms.tip.as_ref());
    let newton_euler = &terms.newton_euler;
    let twists = |list: &[mozzi::Twist]| list.iter().map(|V| vector(&V.to_array())).collect::<Value>();
    of_robot(
        model,
        json!({
            "end_effector": tip.map(|tip| model.frame_name(tip.frame)),
            "gravity": vector(&model.gravity().0),
            "theta": vector(&terms.theta),
            "dtheta": vector(&terms.dtheta),
            "ddtheta": vector(&terms.ddtheta),
            "F_tip": vector(&terms.F_tip.to_array()),
            "forward_kinematics": tip.map(|tip| pose(tip.T_sb)),
            "space_jacobian": tip.map(|tip| jacobian(&tip.J_s)),
            "body_jacobian": tip.map(|tip| jacobian(&tip.J_b)),
            "space_jacobian_rate": tip.map(|tip| jacobian(&tip.dJ_s)),
            "body_jacobian_rate": tip.map(|tip| jacobian(&tip.dJ_b)),
            "V_s": tip.map(|tip| vector(&tip.V_s.to_array())),
            "V_b": tip.map(|tip| vector(&tip.V_b.to_array())),
            "mass_matrix": matrix(&terms.M),
            "mass_matrix_rate": matrix(&terms.dM),
            "coriolis_matrix": matrix(&terms.C),
            "velocity_product": dvector(&terms.c),
            "gravity_forces": dvector(&terms.g),
            "bias_forces": dvector(&terms.h),
            "tip_forces": dvector(&terms.tip_forces),
            "joint_friction": dvector(&terms.friction),
            "inverse_dynamics": dvector(&terms.tau),
            "forward_dynamics": terms.forward_dynamics.as_ref().map(dvector),
            "kinetic_energy": terms.kinetic_energy,
            "potential_energy": terms.potential_energy,
            "task_space_dynamics": terms.task.as_ref().map(|task| json!({
                "coordinates": match terms.task_frame { TaskFrame::Body => "body", TaskFrame::Space => "space" },
                "rows": terms.task_rows,
                "Lambda": matrix(&task.Lambda),
                "eta": dvector(&task.eta),
                "J": matrix(&task.J),
                "dJ_dtheta": dvector(&task.dJ_dtheta),
            })),
            "derivatives": terms.derivatives.object(),
            "newton_euler": {
                "links": model.moving_joints().map(|joint| joint.child.as_str()).collect::<Vec<_>>(),
                "frames": "center_of_mass",
                "twists": twists(&newton_euler.twists),
                "accelerations": twists(&newton_euler.accelerations),
                "wrenches": newton_euler.wrenches.iter().map(|F| vector(&F.to_array())).collect::<Value>(),
                "base_reaction": vector(&newton_euler.base_reaction.to_array()),
            },
            "closed_form": terms.closed_form.as_ref().map(|form| closed_form(form, &terms.ddtheta)),
        }),
    )
}

fn closed_form(form: &ClosedForm, ddtheta: &[f64]) -> Value {
    let ddtheta = DVector::from_column_slice(ddtheta);
    json!({
        "A": matrix(&form.A),
        "G": matrix(&form.G),
        "W": matrix(&form.W),
        "L": matrix(&form.L),
        "ad_V": matrix(&form.ad_V),
        "ad_Adtheta": matrix(&form.ad_Adtheta),
        "V": dvector(&form.V),
        "V_base": dvector(&form.V_base),
        "dV_base": dvector(&form.dV_base),
        "dV": dvector(&form.accelerations(&ddtheta)),
        "F": dvector(&form.wrenches(&ddtheta)),
        "F_tip": dvector(&form.F_tip),
        "mass_matrix": matrix(&form.mass_matrix()),
        "mass_matrix_rate": matrix(&form.mass_matrix_rate()),
        "coriolis_matrix": matrix(&form.coriolis_matrix()),
        "velocity_product": dvector(&form.velocity_product()),
        "gravity_forces": dvector(&form.gravity_forces()),
        "tip_forces": dvector(&form.tip_forces()),
        "inverse_dynamics": dvector(&form.inverse_dynamics(&ddtheta)),
    })
}

/// The lists of the screws, for `mozzi screws`.
pub fn screws(lists: &mozzi::model::ScrewLists) -> Value {
    let axes = |list: &[mozzi::ScrewAxis]| list.iter().map(|A| vector(&A.twist().to_array())).collect::<Value>();
    json!({
        "joints": lists.joints,
        "links": lists.links,
        "parents": lists.parents,
        "M": lists.M.iter().map(|&T| pose(T)).collect::<Value>(),
        "M_relative": lists.M_relative.iter().map(|&T| pose(T)).collect::<Value>(),
        "S": axes(&lists.S),
        "B": lists.end_effector.as_ref().map(|_| axes(&lists.B)),
        "A": axes(&lists.A),
        "G": lists.G.iter().map(|G| rows(G.to_matrix())).collect::<Value>(),
        "end_effector": lists.end_effector.as_ref().map(|(name, T)| json!({ "name": name, "M": pose(*T) })),
    })
}
