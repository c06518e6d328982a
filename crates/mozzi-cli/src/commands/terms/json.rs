//! The quantities of one state as JSON, by the library's names.

use super::values::Terms;
use crate::json::{dvector, matrix, nested, of_robot, vector};
use crate::task;
use mozzi::ClosedForm;
use mozzi::quantities::{BodyJacobian, LIST, Query, SpaceJacobian};
use nalgebra::DVector;
use serde_json::{Map, Value, json};

pub fn object(terms: &Terms) -> Value {
    let (model, newton_euler) = (terms.model, &terms.newton_euler);
    let twists = |list: &[mozzi::Twist]| list.iter().map(|V| vector(&V.to_array())).collect::<Value>();
    let mut object = of_robot(
        model,
        json!({
            "end_effector": terms.tip.map(|tip| model.frame_name(tip)),
            "gravity": vector(&model.gravity().0),
            "theta": vector(&terms.theta),
            "dtheta": vector(&terms.dtheta),
            "ddtheta": vector(&terms.ddtheta),
            "F_tip": vector(&terms.F_tip.to_array()),
            "V_s": terms.twist(SpaceJacobian).as_ref().map(dvector),
            "V_b": terms.twist(BodyJacobian).as_ref().map(dvector),
        }),
    );
    for (query, outputs) in (0..LIST.len()).map(Query::at).zip(&terms.found) {
        object[query.name()] = outputs.as_ref().map_or(Value::Null, |outputs| named(terms, query, outputs));
    }
    object["task_space_dynamics"] = json!(terms.task.as_ref().map(|task| json!({
        "coordinates": task::name(terms.task_frame),
        "rows": terms.task_rows,
        "Lambda": matrix(&task.Lambda),
        "eta": dvector(&task.eta),
        "J": matrix(&task.J),
        "dJ_dtheta": dvector(&task.dJ_dtheta),
    })));
    object["newton_euler"] = json!({
        "links": model.moving_joints().map(|joint| joint.child.as_str()).collect::<Vec<_>>(),
        "frames": "center_of_mass",
        "twists": twists(&newton_euler.twists),
        "accelerations": twists(&newton_euler.accelerations),
        "wrenches": newton_euler.wrenches.iter().map(|F| vector(&F.to_array())).collect::<Value>(),
        "base_reaction": vector(&newton_euler.base_reaction.to_array()),
    });
    object["closed_form"] = json!(terms.closed_form.as_ref().map(|form| closed_form(form, &terms.ddtheta)));
    object
}

/// One output alone, several by their names.
fn named(terms: &Terms, query: Query, outputs: &[Vec<f64>]) -> Value {
    let declared = query.declaration().outputs.iter().zip(query.shapes(terms.model)).zip(outputs);
    let mut outputs = declared.map(|((output, shape), values)| (output.name.to_string(), nested(&shape, values)));
    match query.declaration().outputs.len() {
        1 => outputs.next().map_or(Value::Null, |(_, value)| value),
        _ => outputs.collect::<Map<_, _>>().into(),
    }
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
