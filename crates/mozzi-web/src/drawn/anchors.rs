//! Where constraints hold, and with what forces.

use super::{Call, Drawn, output};
use mozzi::model::description::ConstraintKind;
use mozzi::{Error, Model, Wrench};

/// Anchors of every constraint that has some.
pub const CONSTRAINT_ANCHORS: Drawn = Drawn {
    name: "constraint_anchors",
    formula: "the origins of the anchors {a} and {b} of each constraint, in {s}",
    inputs: &["theta"],
    of_frame: false,
    outputs: |model| vec![output("a", [count(model), 3], "m"), output("b", [count(model), 3], "m")],
    compute,
};

/// The wrenches of these constraints.
pub const CONSTRAINT_WRENCHES: Drawn = Drawn {
    name: "constraint_wrenches",
    formula: "for each constraint with anchors the moment about the origin of {s} and the force that {b} applies to {a}, \
              in {s}",
    inputs: &["theta", "dtheta", "ddtheta", "tau"],
    of_frame: false,
    outputs: |model| vec![output("moment", [count(model), 3], "N m"), output("force", [count(model), 3], "N")],
    compute: wrenches,
};

fn count(model: &Model) -> usize {
    let has_anchors = |kind: &ConstraintKind| matches!(kind, ConstraintKind::Frames { .. });
    model.constraints().iter().filter(|constraint| has_anchors(&constraint.kind)).count()
}

fn compute(call: &Call) -> Result<Vec<f64>, Error> {
    let anchors = call.model.constraint_anchors(call.inputs[0])?;
    let all = |k: usize| anchors.iter().flat_map(move |ends| ends[k].p.0);
    Ok(all(0).chain(all(1)).collect())
}

fn wrenches(call: &Call) -> Result<Vec<f64>, Error> {
    let Call { model, inputs, environment, .. } = call;
    let [theta, dtheta, ddtheta, tau] = inputs else { unreachable!("four inputs") };
    let lambda = model.constraint_forces([theta, dtheta, ddtheta], tau, environment)?;
    let found = model.constraint_wrenches(theta, lambda.as_slice())?;
    let (mut moments, mut forces) = (Vec::new(), Vec::new());
    for ((_, Wrench { m, f }), [a, b]) in found.into_iter().zip(model.constraint_anchors(theta)?) {
        let (m, f) = (a.R * m, a.R * f);
        moments.extend((m + b.p.cross(f)).0);
        forces.extend(f.0);
    }
    Ok([moments, forces].concat())
}
