//! Where constraints hold.

use super::{Call, Drawn, output};
use crate::request::Output;
use mozzi::model::description::ConstraintKind;
use mozzi::{Error, Model};

/// Anchors of every constraint that has some.
pub const CONSTRAINT_ANCHORS: Drawn = Drawn {
    name: "constraint_anchors",
    formula: "the origins of the anchors {a} and {b} of each constraint, in {s}",
    inputs: &["theta"],
    of_frame: false,
    outputs,
    compute,
};

fn outputs(model: &Model) -> Vec<Output> {
    let has_anchors = |kind: &ConstraintKind| matches!(kind, ConstraintKind::Frames { .. });
    let count = model.constraints().iter().filter(|constraint| has_anchors(&constraint.kind)).count();
    vec![output("a", [count, 3], "m"), output("b", [count, 3], "m")]
}

fn compute(call: &Call) -> Result<Vec<f64>, Error> {
    let anchors = call.model.constraint_anchors(call.inputs[0])?;
    let all = |k: usize| anchors.iter().flat_map(move |ends| ends[k].p.0);
    Ok(all(0).chain(all(1)).collect())
}
