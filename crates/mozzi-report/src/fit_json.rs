//! The result of an identification as JSON.

use mozzi_identify::judgement::Judgement;
use mozzi_identify::{Errors, Identification, Verdict};
use serde_json::{Value, json};

/// Parameters, base parameters, errors, residuals and findings, by name.
pub fn fit_json(found: &Identification<'_>, judged: &Judgement, validations: &[(String, Errors)]) -> Value {
    let (setup, estimates) = (&found.setup, &found.estimates);
    let optimum = &estimates.consistent;
    let unknowns: Vec<Value> = setup
        .columns
        .unknowns
        .iter()
        .enumerate()
        .map(|(k, unknown)| {
            let standing = &judged.standings[k];
            json!({
                "name": unknown.name, "unit": setup.columns.unit(k), "before": unknown.prior, "value": optimum.x[k],
                "deviation": standing.deviation, "only": standing.only, "prior_share": optimum.prior_share[k],
                "apparent": optimum.apparent[k],
            })
        })
        .collect();
    let base: Vec<Value> = judged
        .parameters
        .iter()
        .map(|one| {
            json!({
                "name": one.name, "before": one.robot, "least_squares": one.least_squares, "deviation": one.deviation,
                "value": one.consistent, "advice": one.advice,
            })
        })
        .collect();
    let findings: Vec<Value> = found
        .findings
        .iter()
        .chain(&judged.findings)
        .map(|one| json!({ "code": one.code, "level": format!("{:?}", one.level).to_lowercase(), "text": one.text }))
        .collect();
    let residuals: Vec<Value> = judged
        .residuals
        .iter()
        .flatten()
        .map(|one| {
            json!({
                "name": one.name, "force": one.force, "rmse": one.rmse, "peak_hz": one.peak.0, "peak_share": one.peak.1,
                "autocorrelation": one.autocorrelation, "lag": one.lag, "lag_deviation": one.lag_deviation,
            })
        })
        .collect();
    let servos: Vec<Value> = judged
        .servos
        .iter()
        .map(|one| {
            json!({
                "joint": one.joint, "stiffness": one.stiffness, "damping": one.damping, "delay": one.delay,
                "bias": one.bias, "nrms": one.nrms,
            })
        })
        .collect();
    let verdict = Verdict::new(found, validations.iter().map(|(_, errors)| errors));
    let validations: Vec<Value> =
        validations.iter().map(|(file, errors)| json!({ "log": file, "errors": of_errors(errors) })).collect();
    json!({
        "verdict": of_verdict(&verdict),
        "condition": estimates.least_squares.condition,
        "determined": estimates.least_squares.rank,
        "steps": optimum.steps,
        "sigma": estimates.least_squares.sigma,
        "parameters": unknowns,
        "base_parameters": base,
        "fitted": of_errors(&found.fitted),
        "left_out": found.left_out.as_ref().map(of_errors),
        "held_out": found.held_out.as_ref().map(of_errors),
        "validations": validations,
        "servos": servos,
        "residuals": residuals,
        "findings": findings,
    })
}

fn of_verdict(verdict: &Verdict) -> Value {
    let payload = verdict.payload.as_ref().map(|payload| {
        let [mass, deviation] = payload.mass;
        json!({ "frame": payload.frame, "mass": mass, "deviation": deviation, "center": payload.center })
    });
    json!({
        "text": verdict.to_string(), "predicted": format!("{:?}", verdict.predicted), "nrms": verdict.nrms,
        "of_file": verdict.of_file, "is_trusted": verdict.is_trusted, "payload": payload,
    })
}

fn of_errors(errors: &Errors) -> Value {
    json!({
        "force": errors.force, "robot": errors.robot, "friction": errors.friction,
        "least_squares": errors.least_squares, "consistent": errors.consistent,
        "written": errors.written, "nrms_written": errors.normalized(&errors.written),
        "nrms": errors.normalized(&errors.consistent),
    })
}
