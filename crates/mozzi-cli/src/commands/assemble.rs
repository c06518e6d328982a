//! `mozzi assemble`: positions and velocities that satisfy a robot's constraints.

use crate::failure::{Failure, Result};
use crate::robot::{RobotArguments, Units};
use crate::state::{StartArguments, pasted};
use crate::text::{Page, about, column, rows_of, table};
use crate::{angles, failure, json};
use clap::Args;
use mozzi::quantities::Query;
use mozzi::{ConstraintRank, Error, Model};
use serde_json::{Value, json};

/// Violations up to this size, rad and m, are rounding.
const CLOSED: f64 = 1e-9;

#[derive(Args, Debug)]
pub struct AssembleArguments {
    #[command(flatten)]
    robot: RobotArguments,
    #[command(flatten)]
    start: StartArguments,
    /// Joints that keep their positions and velocities
    #[arg(long, value_name = "JOINT,…", value_delimiter = ',')]
    hold: Vec<String>,
}

pub fn run(arguments: &AssembleArguments) -> Result<String> {
    let model = arguments.robot.load_at(|model| Ok(arguments.start.read(model)?.0))?;
    needs_constraints(&model)?;
    let (guess, rates) = arguments.start.read(&model)?;
    let hold: Vec<&str> = arguments.hold.iter().map(String::as_str).collect();
    let theta = model.assemble(&guess, &hold)?;
    let dtheta = model.assemble_velocities(&theta, &rates, &hold)?;
    let (rank, residual) = (model.constraint_rank(&theta)?, violation(&model, &theta)?);
    if arguments.robot.json {
        return Ok(json::print(&json::of_robot(
            &model,
            json!({
                "theta": json::vector(&theta),
                "dtheta": json::vector(&dtheta),
                "residual": residual,
                "constraints": object(&rank),
            }),
        )));
    }
    let (units, mut page) = (Units::of(&model), Page::default());
    let are_angles = angles::of_positions(&model);
    page.line(summary(&rank)).line(format!("largest violation: {} rad or m", about(residual))).blank();
    let mut columns = vec![
        [vec!["θ".to_string()], model.position_names().map(str::to_string).collect()].concat(),
        [vec![units.input(0)], column(&angles::shown(&theta, &are_angles))].concat(),
        [vec!["guess".to_string()], column(&angles::shown(&guess, &are_angles))].concat(),
    ];
    if model.nq() == model.n() {
        columns.push(
            [vec![format!("θ̇ [{}]", units.input(1))], column(&angles::shown(&dtheta, &angles::of_velocities(&model)))]
                .concat(),
        );
    }
    page.lines(&table(&rows_of(columns), "lrrr"));
    page.blank();
    let [shown, rates] = [angles::shown(&theta, &are_angles), angles::shown(&dtheta, &angles::of_velocities(&model))];
    pasted(&mut page, &[("--theta", &shown), ("--dtheta", &rates)]);
    Ok(page.end())
}

/// Checks that the model has constraints.
pub fn needs_constraints(model: &Model) -> Result<()> {
    match model.constraint_rows() {
        0 => {
            let robot = &model.description().name;
            Err(Failure::wrong(format!("{robot} has no constraints; --constraints FILE adds some")))
        }
        _ => Ok(()),
    }
}

/// Checks that the model has constraints if these quantities are those of constraints.
pub fn check_constraints<'q>(queries: impl IntoIterator<Item = Query<'q>>, model: &Model) -> Result<()> {
    match queries.into_iter().any(|query| query.declaration().is_constrained) {
        true => needs_constraints(model),
        false => Ok(()),
    }
}

/// The largest violation of the constraints, rad and m; infinite where one is undefined.
pub fn violation(model: &Model, theta: &[f64]) -> Result<f64, Error> {
    let phi = model.constraint_errors(theta)?;
    Ok(phi.iter().fold(0.0, |most, x| if x.is_nan() { f64::INFINITY } else { x.abs().max(most) }))
}

/// (θ, θ̇) unchanged if they satisfy the constraints, else the nearest that do, with a note.
pub fn assembled(model: &Model, theta: Vec<f64>, dtheta: Vec<f64>) -> Result<(Vec<f64>, Vec<f64>), Error> {
    if model.constraint_rows() == 0 {
        return Ok((theta, dtheta));
    }
    let open = violation(model, &theta)?;
    let closed = if open > CLOSED { model.assemble(&theta, &[])? } else { theta.clone() };
    if open > CLOSED {
        let far = |k: &usize| (closed[*k] - theta[*k]).abs();
        let most = (0..theta.len()).max_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0);
        let name = model.position_names().nth(most).unwrap_or_default().to_string();
        failure::note(&format!(
            "the start violates the constraints by {}; it was assembled: `{name}` changed most, from {} to {}; `mozzi \
             assemble` holds joints that you choose",
            about(open),
            theta[most],
            closed[most]
        ));
    }
    let rates = model.assemble_velocities(&closed, &dtheta, &[])?;
    let changed = rates.iter().zip(&dtheta).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    if changed > CLOSED {
        failure::note(&format!("the start's velocities were changed by up to {} to satisfy them", about(changed)));
    }
    Ok((closed, rates))
}

/// An error of [`assembled`]; if joint limits are in the way, with the options that avoid them: other named states than
/// the given one, and no limits if they are respected.
pub fn with_other_starts(why: Error, model: &Model, given: Option<&str>, respects: bool) -> Failure {
    const SHOWN: usize = 3;
    if !matches!(why, Error::BadArgument { what: "the closed position", .. }) {
        return why.into();
    }
    let start = model.description().start.as_deref();
    let others = model.state_names().filter(|name| given != Some(*name) && start != Some(*name)).take(SHOWN);
    let others = others.map(|name| format!("`--state {name}`")).collect::<Vec<_>>().join(" or ");
    let elsewhere = (!others.is_empty()).then(|| format!("{others} starts there"));
    let beyond = respects.then(|| "`--joint-limits ignore` starts beyond limits".to_string());
    let ways: Vec<String> = [Some(why.to_string()), elsewhere, beyond].into_iter().flatten().collect();
    Failure::wrong(ways.join("; "))
}

/// "5 rows of rank 2 leave 1 degree of freedom; redundant: …".
pub fn summary(rank: &ConstraintRank) -> String {
    let ConstraintRank { rows, rank, freedom, redundant } = rank;
    let degrees = if *freedom == 1 { "degree" } else { "degrees" };
    let redundant = match redundant.as_slice() {
        [] => String::new(),
        names => format!("; redundant: {}", names.join(", ")),
    };
    format!("constraints: {rows} rows of rank {rank} leave {freedom} {degrees} of freedom{redundant}")
}

pub fn object(rank: &ConstraintRank) -> Value {
    json!({ "rows": rank.rows, "rank": rank.rank, "freedom": rank.freedom, "redundant": rank.redundant })
}
