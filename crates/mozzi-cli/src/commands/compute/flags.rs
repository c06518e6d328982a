//! The flags that have an effect on a quantity.

use crate::inputs::STATE;
use mozzi::quantities::{Declaration, Of, Uses};

/// Their names, without `--`.
pub fn of(declaration: &Declaration) -> Vec<&'static str> {
    let subject: &[&str] = match declaration.of {
        Of::Robot => &[],
        Of::Frame => &["frame"],
        Of::Task => &["frame", "task", "task-frame"],
        Of::Point => &["about"],
    };
    let wrenches: &[&str] = if declaration.uses.has(Uses::WRENCHES) { &["tip-wrench", "wrench"] } else { &[] };
    let gravity: &[&str] = if declaration.uses.has(Uses::GRAVITY) { &["gravity"] } else { &[] };
    let inputs = declaration.inputs.iter().map(|input| input.name);
    let is_of_state = declaration.inputs.iter().any(|input| ["theta", "dtheta"].contains(&input.name));
    let state: &[&str] = if is_of_state { &[STATE] } else { &[] };
    inputs.chain([subject, wrenches, gravity, state].concat()).collect()
}

/// "--theta, --frame"
pub fn text(flags: &[&str]) -> String {
    flags.iter().map(|flag| format!("--{flag}")).collect::<Vec<_>>().join(", ")
}
