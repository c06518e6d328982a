//! The result as text.

use crate::tables::samples::Row;
use crate::text::{Page, table};
use mozzi::Model;
use mozzi_identify::judgement::Judgement;
use mozzi_identify::{Errors, Identification, Kind, Level, Refinement, Verdict};
use serde_json::{Value, json};

pub fn text(
    verdict: &Verdict,
    found: &Identification<'_>,
    judged: &Judgement,
    validations: &[(String, Errors)],
    logs: &[(String, Vec<Row>)],
    written: &[String],
) -> String {
    let model = found.setup.columns.model;
    let mut page = Page::default();
    verdict.to_string().lines().for_each(|line| {
        page.line(line);
    });
    let warnings = found.findings.iter().chain(&judged.findings).filter(|one| one.level != Level::Note);
    let mut codes: Vec<&str> = warnings.map(|one| one.code).collect();
    codes.dedup();
    if !codes.is_empty() {
        page.line(format!("with warnings: {}", codes.join(", ")));
    }
    let rows: usize = found.samples.iter().map(|samples| samples.count()).sum();
    page.line(format!(
        "{}: {} unknowns, {} of {} base parameters determined, from {rows} samples",
        model.description().name,
        found.setup.columns.count(),
        found.estimates.least_squares.rank,
        found.setup.base.count(),
    ));
    page.line(format!("condition number {:.0}", found.estimates.least_squares.condition));
    if let Some(errors) = &found.left_out {
        errors_table(&mut page, "error of predictions, five blocks of time left out in turn", found, errors);
    }
    if let Some(errors) = &found.held_out {
        errors_table(&mut page, "error on the part that was not fitted", found, errors);
    }
    for (file, errors) in validations {
        errors_table(&mut page, &format!("error on {file}"), found, errors);
    }
    if found.left_out.is_none() && found.held_out.is_none() {
        errors_table(&mut page, "error on the samples that were fitted", found, &found.fitted);
    }
    page.line("Differences below 3 % mean nothing on one trajectory.");
    parameters(&mut page, found);
    logs.iter().for_each(|(file, rows)| column_table(&mut page, file, rows));
    weak(&mut page, judged);
    if !written.is_empty() {
        page.blank().line(format!("{} {} written", written.join(", "), if written.len() == 1 { "is" } else { "are" }));
    }
    page.end()
}

/// Root mean square errors by joint.
fn errors_table(page: &mut Page, title: &str, found: &Identification<'_>, errors: &Errors) {
    let model = found.setup.columns.model;
    let mut rows = vec![
        ["", "force", "as it was", "+ friction", "least squares", "identified", "identified, %"]
            .map(str::to_string)
            .to_vec(),
    ];
    let show = |x: f64| format!("{x:.3}");
    for (j, name) in model.velocity_names().enumerate() {
        let all = [errors.force[j], errors.robot[j], errors.friction[j], errors.least_squares[j], errors.consistent[j]];
        let percent = if errors.force[j] > 0.0 { 100.0 * errors.consistent[j] / errors.force[j] } else { 0.0 };
        rows.push([vec![name.to_string()], all.map(show).to_vec(), vec![format!("{percent:.2}")]].concat());
    }
    let nrms = |x: &[f64]| format!("{:.2} %", 100.0 * errors.normalized(x));
    let of = [&errors.robot, &errors.friction, &errors.least_squares, &errors.consistent];
    rows.push([vec!["NRMS".to_string(), String::new()], of.map(|x| nrms(x)).to_vec(), vec![String::new()]].concat());
    page.title(&format!("{title}, N m or N")).lines(&table(&rows, "lrrrrrr"));
}

/// Masses and joint parameters, before and after.
fn parameters(page: &mut Page, found: &Identification<'_>) {
    let optimum = &found.estimates.consistent;
    let mut rows = vec![["", "before", "identified", "deviation", "from the prior"].map(str::to_string).to_vec()];
    for (k, unknown) in found.setup.columns.unknowns.iter().enumerate() {
        let is_shown = match unknown.kind {
            Kind::Link(k) => k % 10 == 0,
            _ => true,
        };
        if is_shown {
            rows.push(vec![
                unknown.name.clone(),
                format!("{:.4}", unknown.prior),
                format!("{:.4}", optimum.x[k]),
                format!("{:.4}", optimum.deviations[k]),
                format!("{:.0} %", 100.0 * optimum.prior_share[k]),
            ]);
        }
    }
    page.title("parameters; links: their masses").lines(&table(&rows, "lrrrr"));
}

/// What each column is taken for.
fn column_table(page: &mut Page, file: &str, rows: &[Row]) {
    let head = ["column", "meaning", "unit", "joint"].map(str::to_string).to_vec();
    let row = |row: &Row| vec![row.column.clone(), row.meaning.clone(), row.unit.clone(), row.joint.clone()];
    let all: Vec<Vec<String>> = [head].into_iter().chain(rows.iter().map(row)).collect();
    page.title(&format!("columns of {file}")).lines(&table(&all, "llll"));
}

/// The tables of columns alone.
pub fn columns(logs: &[(String, Vec<Row>)]) -> String {
    let mut page = Page::default();
    logs.iter().for_each(|(file, rows)| column_table(&mut page, file, rows));
    page.end()
}

pub fn columns_json(logs: &[(String, Vec<Row>)]) -> Value {
    let row = |row: &Row| json!({ "column": row.column, "meaning": row.meaning, "unit": row.unit, "joint": row.joint });
    let of =
        |(file, rows): &(String, Vec<Row>)| json!({ "log": file, "columns": rows.iter().map(row).collect::<Vec<_>>() });
    json!({ "logs": logs.iter().map(of).collect::<Vec<_>>() })
}

/// What the motion does not determine.
fn weak(page: &mut Page, judged: &Judgement) {
    let weak: Vec<_> = judged.parameters.iter().filter(|parameter| parameter.is_weak()).collect();
    if weak.is_empty() {
        return;
    }
    let mut rows = vec![["", "value", "deviation", "what would help"].map(str::to_string).to_vec()];
    for parameter in weak {
        let name: String = if parameter.name.chars().count() > 60 {
            parameter.name.chars().take(57).chain("…".chars()).collect()
        } else {
            parameter.name.clone()
        };
        rows.push(vec![
            name,
            format!("{:.4}", parameter.least_squares),
            format!("{:.4}", parameter.deviation),
            parameter.advice.clone().unwrap_or_default(),
        ]);
    }
    page.title("base parameters that the motion does not determine").lines(&table(&rows, "lrrl"));
}

/// Errors of rollouts before and after the refinement.
pub fn refinement(model: &Model, refined: &Refinement) -> Vec<String> {
    let line = |(j, name): (usize, &str)| {
        format!(
            "rollouts of {name}: position error {:.2e} before, {:.2e} after; velocity error {:.2e}, {:.2e}",
            refined.before[0][j], refined.after[0][j], refined.before[1][j], refined.after[1][j]
        )
    };
    model.velocity_names().enumerate().map(line).collect()
}
